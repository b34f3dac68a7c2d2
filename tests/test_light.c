/* test_light.c - light from outside: what spheres and walls meet first. SPDX-License-Identifier: MIT */
#include "lit.h"
#include "plain_light.h"
#include "suite.h"

TEST(a_lone_sphere_takes_its_shadow) {
    const double one[][4] = {{.3, -.2, .7, 1.7}};
    OWNED_BED bed = bed_of(1, one);
    for (uint64_t k = 0; k < 40; k++) {
        double d[3];
        for (uint64_t a = 0; a < 3; a++) d[a] = k < 3 ? (double)(a == k) : bed_make_random(5, 3 * k + a) - .5;
        const fibrad_light light = along(d[0], d[1], d[2]);
        OWNED_LIT lit = light_up(&bed, &(fibrad_scene_config){0}, &light);
        const double size = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        const double box = 4 * 1.7 * 1.7 * (fabs(d[0]) + fabs(d[1]) + fabs(d[2])) / size;
        ck_assert_int_eq(lit.status, 0);
        ck_assert_double_eq_tol(lit.power[0], PI * 1.7 * 1.7, 1e-12);
        ck_assert_double_eq_tol(sum_of(&lit.ends), box, 1e-12);
    }
}

/* Three layers of touching unit spheres. */
static struct bed layers(double x, double y, bool hexagonal) {
    struct bed bed = bed_empty();
    for (int k = 0; k < (hexagonal ? 1 : 3); k++)
        for (int i = 0; i < 4; i++)
            for (int j = 0; j < 4; j++)
                add_sphere(&bed, 2 * i + (hexagonal ? j % 2 : 0), (hexagonal ? sqrt(3) : 2) * j, 2 * k, 1);
    bed.period[0] = x, bed.period[1] = y, bed.period[2] = 0;
    return bed;
}

TEST(a_simple_cubic_bed_is_lit_in_its_first_layer) {
    OWNED_BED bed = layers(8, 8, false);
    const fibrad_wall floor_wall = plane_at(2, 0, -1);
    for (int walled = 0; walled < 2; walled++) {
        const fibrad_scene_config config = {.period = {8, 8, 0}, .wall = &floor_wall, .walls = (uint32_t)walled};
        const fibrad_light light = along(0, 0, -1);
        OWNED_LIT lit = light_up(&bed, &config, &light);
        for (uint32_t i = 0; i < bed.n; i++) ck_assert_double_eq_tol(lit.power[i], bed.z[i] > 3 ? PI : 0, 1e-9);
        ck_assert_double_eq_tol(lit.ends.spheres / 64, PI / 4, 1e-9);
        ck_assert_double_eq_tol((walled ? lit.ends.wall[0] : lit.ends.through) / 64, 1 - PI / 4, 1e-9);
        ck_assert_double_eq_tol(sum_of(&lit.ends), 64, 1e-12);
    }
}

TEST(a_hexagonal_layer_takes_nine_tenths) {
    OWNED_BED bed = layers(8, 4 * sqrt(3), true);
    const fibrad_scene_config config = {.period = {8, 4 * sqrt(3), 0}};
    const fibrad_light light = along(0, 0, -1);
    OWNED_LIT lit = light_up(&bed, &config, &light);
    ck_assert_double_eq_tol(lit.ends.spheres / sum_of(&lit.empty), PI / sqrt(12), 1e-9);
}

/* A bed, its walls in both forms, and a light. */
struct course {
    struct bed bed;
    fibrad_scene_config config;
    fibrad_wall wall[6];
    fibrad_plane opening[6];
    struct plain_bed plain;
    double d[3];
};

static void add_wall(struct course *c, int axis, int upper, double at) {
    c->wall[c->config.walls++] = plane_at(axis, upper, at);
    *(upper ? &c->plain.high[axis] : &c->plain.low[axis]) = at;
}

static void add_opening(struct course *c, int axis, int upper, double at) {
    c->opening[c->config.openings++] = (fibrad_plane){axis, upper, at};
    *(upper ? &c->plain.high[axis] : &c->plain.low[axis]) = at;
    c->plain.open[2 * axis + upper] = true;
}

static void begin_course(struct course *c, struct bed bed, double x, double y, double z) {
    const double size = sqrt(x * x + y * y + z * z);
    *c = (struct course){.bed = bed, .d = {x / size, y / size, z / size}};
    c->plain = plain_bed_of(&c->bed);
    for (int a = 0; a < 3; a++) c->config.period[a] = bed.period[a];
    c->config.wall = c->wall, c->config.opening = c->opening;
}

/* Compares with plain rays. `rays` of them are spread over a rectangle across the light about the place `middle`; those
 * count that begin where light enters. */
static void compare(struct course *c, const fibrad_light *light, const double middle[3], double reach, int rays) {
    struct lit lit = light_up(&c->bed, &c->config, light);
    double *count = calloc(c->bed.n, sizeof *count), ends[PLAIN_ENDS] = {0}, all = 0;
    double u[3], v[3];
    const int least = fabs(c->d[2]) < .8 ? 2 : 0;
    double size = 0, worst = 0;
    uint64_t state = 7;
    ck_assert_int_eq(lit.status, 0);
    for (int a = 0; a < 3; a++) u[a] = (a == least) - c->d[least] * c->d[a], size += u[a] * u[a];
    for (int a = 0; a < 3; a++) u[a] /= sqrt(size);
    for (int a = 0; a < 3; a++) v[a] = c->d[(a + 1) % 3] * u[(a + 2) % 3] - c->d[(a + 2) % 3] * u[(a + 1) % 3];
    const double each = 4 * reach * reach / rays / rays;
    for (int k = 0; k < rays; k++)
        for (int m = 0; m < rays; m++) {
            const double s = reach * (2 * (k + plain_random(&state)) / rays - 1),
                         t = reach * (2 * (m + plain_random(&state)) / rays - 1);
            double at[3];
            for (int a = 0; a < 3; a++) at[a] = middle[a] + s * u[a] + t * v[a];
            if (light->shape == FIBRAD_LIGHT_DISC && s * s + t * t > light->radius * light->radius) continue;
            if (!plain_enter(&c->plain, at, c->d)) continue;
            const struct plain_end end = plain_trace(&c->plain, at, c->d);
            all += each;
            if (end.sphere >= 0)
                count[end.sphere] += each;
            else
                ends[end.side] += each;
        }
    for (uint32_t i = 0; i < c->bed.n; i++) worst = fmax(worst, fabs(count[i] - lit.power[i]));
    ck_assert_double_le(worst, 60 * each);
    ck_assert_double_eq_tol(sum_of(&lit.empty), all, 200 * each);
    ck_assert_double_eq_tol(lit.ends.through, ends[PLAIN_OUTSIDE], 200 * each);
    for (uint32_t b = 0; b < c->config.walls; b++) {
        const fibrad_plane *plane = &c->wall[b].plane;
        const int side = c->wall[b].kind == FIBRAD_WALL_CYLINDER ? PLAIN_CYLINDER : 2 * plane->axis + plane->upper;
        ck_assert_double_eq_tol(lit.ends.wall[b], ends[side], 200 * each);
    }
    assert_near(sum_of(&lit.ends), sum_of(&lit.empty), 1e-12);
    free(count), free(lit.power);
    plain_free(&c->plain);
    bed_free(&c->bed);
}

/* The extent of a bed. */
static void extent_of(const struct bed *bed, double low[3], double high[3], double middle[3]) {
    for (int a = 0; a < 3; a++) {
        const double *x = a == 0 ? bed->x : a == 1 ? bed->y : bed->z;
        low[a] = INFINITY, high[a] = -INFINITY;
        for (uint32_t i = 0; i < bed->n; i++)
            low[a] = fmin(low[a], x[i] - bed->r[i]), high[a] = fmax(high[a], x[i] + bed->r[i]);
        middle[a] = .5 * (low[a] + high[a]);
    }
}

enum { RAYS = 400 };

TEST(a_box_with_an_open_top_as_by_rays) {
    static const double d[][3] = {{.5, .3, -.8}, {-.2, .1, -1}, {0, 0, -1}, {0, -.4, -1}};
    for (int k = 0; k < 4; k++) {
        struct course c;
        struct bed bed = packing(20, .4, .8, .3, 3, false);
        double low[3], high[3], middle[3];
        extent_of(&bed, low, high, middle);
        begin_course(&c, bed, d[k][0], d[k][1], d[k][2]);
        for (int side = 0; side < 5; side++)
            add_wall(&c, side / 2, side % 2, side % 2 ? high[side / 2] + .3 : low[side / 2] - .2);
        add_opening(&c, 2, 1, high[2] + .5);
        const fibrad_light light = along(d[k][0], d[k][1], d[k][2]);
        compare(&c, &light, middle, 6, RAYS);
    }
}

TEST(a_corner_that_is_open_on_three_sides_as_by_rays) {
    struct course c;
    struct bed bed = packing(20, .4, .8, .3, 4, false);
    double low[3], high[3], middle[3];
    extent_of(&bed, low, high, middle);
    begin_course(&c, bed, .6, -.5, -.7);
    add_wall(&c, 0, 1, high[0]), add_wall(&c, 1, 0, low[1]), add_wall(&c, 2, 0, low[2]);
    add_opening(&c, 0, 0, low[0]), add_opening(&c, 1, 1, high[1]), add_opening(&c, 2, 1, high[2]);
    const fibrad_light light = along(.6, -.5, -.7);
    compare(&c, &light, middle, 6, RAYS);
}

/* The same in a bed that is turned by an exchange of the axes, light and all. */
static void compare_turned(const struct course *c, const fibrad_light *light) {
    struct lit lit = light_up(&c->bed, &c->config, light);
    ck_assert_int_eq(lit.status, 0);
    for (int turn = 1; turn < 3; turn++) {
        struct course other = *c;
        fibrad_light aslant = *light;
        OWNED_BED bed = packing(20, .4, .8, .3, 5, false);
        turn_bed(&bed, turn);
        for (uint32_t b = 0; b < c->config.walls; b++) other.wall[b] = turned_wall(c->wall[b], turn);
        other.opening[0].axis = (c->opening[0].axis + turn) % 3;
        other.config.wall = other.wall, other.config.opening = other.opening;
        turned_point(light->direction, turn, aslant.direction);
        struct lit same = light_up(&bed, &other.config, &aslant);
        ck_assert_int_eq(same.status, 0);
        for (uint32_t i = 0; i < bed.n; i++) ck_assert_double_eq_tol(same.power[i], lit.power[i], 1e-9);
        for (uint32_t b = 0; b < c->config.walls; b++)
            ck_assert_double_eq_tol(same.ends.wall[b], lit.ends.wall[b], 1e-9);
        free(same.power);
    }
    free(lit.power);
}

TEST(a_cup_as_by_rays) {
    static const double d[][3] = {{.5, .3, -.8}, {0, .1, -1}, {0, 0, -1}};
    for (int k = 0; k < 3; k++) {
        struct course c;
        struct bed bed = packing(20, .4, .8, .3, 5, false);
        double low[3], high[3], middle[3], round = 0;
        extent_of(&bed, low, high, middle);
        for (uint32_t i = 0; i < bed.n; i++)
            round = fmax(round, hypot(bed.x[i] - middle[0], bed.y[i] - middle[1]) + bed.r[i]);
        begin_course(&c, bed, d[k][0], d[k][1], d[k][2]);
        add_wall(&c, 2, 0, low[2]);
        add_opening(&c, 2, 1, high[2] + .5);
        c.wall[c.config.walls++] =
            (fibrad_wall){.kind = FIBRAD_WALL_CYLINDER, .cylinder = {middle[0], middle[1], round, 2}};
        c.plain.axis[0] = middle[0], c.plain.axis[1] = middle[1], c.plain.round = round;
        const fibrad_light light = along(d[k][0], d[k][1], d[k][2]);
        compare_turned(&c, &light);
        compare(&c, &light, middle, 6, RAYS);
    }
}

TEST(a_disc_of_light_as_by_rays) {
    for (int k = 0; k < 4; k++) {
        struct course c;
        struct bed bed = packing(20, .4, .8, .3, 6, k >= 2);
        double low[3], high[3], middle[3];
        extent_of(&bed, low, high, middle);
        if (k >= 2) bed.period[2] = 0;
        if (k == 3) bed.period[1] = 0;
        begin_course(&c, bed, .7, -.6, -.5);
        add_wall(&c, 2, 0, low[2]);
        fibrad_light light = along(.7, -.6, -.5);
        light.shape = FIBRAD_LIGHT_DISC, light.radius = k == 0 ? .2 : 1.1;
        for (int a = 0; a < 3; a++) light.centre[a] = middle[a] - 8 * c.d[a] + .1;
        compare(&c, &light, light.centre, light.radius, RAYS);
    }
}
