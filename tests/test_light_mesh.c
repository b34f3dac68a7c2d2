/* test_light_mesh.c - light among triangles: shadows on spheres. SPDX-License-Identifier: MIT */
#include "lit.h"
#include "meshes.h"
#include "plain_light.h"
#include "suite.h"

static fibrad_scene_config config_of(const struct mesh *mesh) {
    return (fibrad_scene_config){.wall = mesh->wall, .walls = 1, .triangles = &mesh->triangles};
}

/* Two axes across a direction. */
static void axes_across(const double d[3], double u[3], double v[3]) {
    const double some[3] = {fabs(d[0]) < .7, fabs(d[0]) >= .7, 0};
    plain_cross(d, some, u);
    const double size = sqrt(plain_product(u, u));
    for (int a = 0; a < 3; a++) u[a] /= size;
    plain_cross(d, u, v);
}

static void unit_direction(uint64_t seed, double d[3]) {
    for (uint64_t a = 0; a < 3; a++) d[a] = bed_make_random(seed, a) - .5;
    const double size = sqrt(plain_product(d, d));
    for (int a = 0; a < 3; a++) d[a] /= size;
}

/* Adds a vertex at u and v across a direction, and at a depth towards the light. */
static uint32_t vertex_across(struct mesh *mesh, const double d[3], double u, double v, double depth) {
    double x[3], y[3], at[3];
    axes_across(d, x, y);
    for (int a = 0; a < 3; a++) at[a] = u * x[a] + v * y[a] - depth * d[a];
    return mesh_vertex(mesh, at[0], at[1], at[2]);
}

/* A tilted triangle whose edge is seen at a distance h from the middle of a unit sphere leaves a segment of the disc.
 */
TEST(a_tilted_triangle_shades_a_segment) {
    const double one[][4] = {{0, 0, 0, 1}};
    OWNED_BED bed = bed_of(1, one);
    for (int k = 0; k < 40; k++) {
        double d[3];
        OWNED struct mesh *mesh = mesh_new();
        unit_direction((uint64_t)k, d);
        const double h = .05 * (k - 20), sign = k % 3 ? 1 : -1, behind = k % 5 ? 1 : -1;
        mesh_triangle(mesh, vertex_across(mesh, d, h, -9 * sign, behind * 20),
                      vertex_across(mesh, d, 30, 0, behind * (40 + k)), vertex_across(mesh, d, h, 9 * sign, behind * 4),
                      0, 0);
        const fibrad_scene_config config = config_of(mesh);
        const fibrad_light light = along(d[0], d[1], d[2]);
        OWNED_LIT lit = light_up(&bed, &config, &light);
        const double open = PI - (acos(h) - h * sqrt(1 - h * h));
        ck_assert_int_eq(lit.status, 0);
        ck_assert_double_eq_tol(lit.power[0], behind > 0 ? open : PI, 1e-12);
        ck_assert_double_eq_tol(sum_of(&lit.ends), sum_of(&lit.empty), 1e-9);
    }
}

/* Adds the even or the odd squares of a board across a direction, which is `side` squares wide and tilted. */
static void add_board(struct mesh *mesh, const double d[3], int side, int odd) {
    const double edge = 2.4 / side;
    for (int i = 0; i < side; i++)
        for (int j = 0; j < side; j++) {
            uint32_t corner[4];
            for (int c = 0; c < 4 && (i + j) % 2 == odd; c++) {
                const double u = edge * (i + (c == 1 || c == 2)) - 1.2, v = edge * (j + c / 2) - 1.2;
                corner[c] = vertex_across(mesh, d, u, v, 3 + .3 * u - .1 * v);
            }
            if ((i + j) % 2 == odd) mesh_quad(mesh, corner, 0, 0);
        }
}

/* The even squares of a board leave what the odd ones hide. Fine boards leave hundreds of polygons. All squares
 * together leave nothing. Other spheres hide parts, too. */
TEST(a_board_and_its_complement_hide_all) {
    const double some[][4] = {{0, 0, 0, 1}, {1.2, .4, .9, .5}, {-.3, .2, 1.4, .35}};
    OWNED_BED bed = bed_of(3, some);
    for (int k = 0; k < 6; k++) {
        double d[3] = {0, 0, -1}, sum[3] = {0}, all[3];
        const int side = k < 4 ? 2 + 3 * k : 40;
        if (k % 2) unit_direction(4 + (uint64_t)k, d);
        for (int part = -1; part < 3; part++) {
            OWNED struct mesh *mesh = mesh_new();
            for (int odd = 0; odd < 2; odd++)
                if (part == odd || part == 2) add_board(mesh, d, side, odd);
            fibrad_scene_config config = config_of(mesh);
            if (part < 0) config = (fibrad_scene_config){0};
            const fibrad_light light = along(d[0], d[1], d[2]);
            OWNED_LIT lit = light_up(&bed, &config, &light);
            ck_assert_int_eq(lit.status, 0);
            for (int i = 0; i < 3; i++) {
                if (part < 0) all[i] = lit.power[i];
                if (part == 0 || part == 1) sum[i] += lit.power[i];
            }
            printf("part %d: %.15g\n", part, lit.power[0]);
            if (part == 2) ck_assert_double_eq_tol(lit.power[0], 0, 1e-10);
        }
        printf("board %d: %.15g %.15g\n", k, sum[0], all[0]);
        ck_assert_double_eq_tol(sum[0], all[0], 1e-10);
    }
}

/* Whether a triangle keeps clear of all spheres, by many points on it. */
static bool is_clear(const struct bed *bed, double corner[3][3]) {
    enum { POINTS = 30 };
    bool clear = true;
    for (uint32_t i = 0; i < bed->n && clear; i++)
        for (int k = 0; k < POINTS * POINTS && clear; k++) {
            const double a = (k / POINTS) / (POINTS - 1.), b = (1 - a) * (k % POINTS) / (POINTS - 1.);
            const double centre[3] = {bed->x[i], bed->y[i], bed->z[i]};
            double square = 0;
            for (int c = 0; c < 3; c++)
                square += pow(a * corner[0][c] + b * corner[1][c] + (1 - a - b) * corner[2][c] - centre[c], 2);
            clear = square > pow(bed->r[i] + .05, 2);
        }
    return clear;
}

/* Adds triangles at random places that cut no sphere. */
static void add_triangles(struct mesh *mesh, const struct bed *bed, int count, double size, uint64_t seed) {
    for (uint64_t k = 0; mesh->triangles.n < (uint32_t)count; k++) {
        double corner[3][3];
        for (uint64_t a = 0; a < 3; a++)
            for (uint64_t c = 0; c < 3; c++)
                corner[c][a] = size * (bed_make_random(seed, 12 * k + a) - .2) +
                               3 * bed_make_random(seed, 12 * k + 3 * c + a + 3) - 1.5;
        if (!is_clear(bed, corner)) continue;
        uint32_t v[3];
        for (int c = 0; c < 3; c++) v[c] = mesh_vertex(mesh, corner[c][0], corner[c][1], corner[c][2]);
        mesh_triangle(mesh, v[0], v[1], v[2], 0, 0);
    }
}

/* The lit area of a sphere, by `rays` squared rays over a square about it. */
static double area_by_rays(const struct plain_bed *plain, uint32_t i, const double d[3], int rays) {
    const struct bed *bed = plain->bed;
    double u[3], v[3];
    int count = 0;
    axes_across(d, u, v);
    for (int k = 0; k < rays * rays; k++) {
        const double x = 2 * (k / rays + .5) / rays - 1, y = 2 * (k % rays + .5) / rays - 1;
        double at[3] = {bed->x[i], bed->y[i], bed->z[i]};
        for (int a = 0; a < 3; a++) at[a] += bed->r[i] * (x * u[a] + y * v[a]) - 100 * d[a];
        count += plain_trace(plain, at, d).sphere == (int64_t)i;
    }
    return 4 * bed->r[i] * bed->r[i] * count / rays / rays;
}

/* All instruction sets give the same bits. */
static void check_bits(const struct bed *bed, fibrad_scene_config config, const fibrad_light *light,
                       const double *power) {
    const struct isas isas = isas_there();
    for (int k = 0; k < isas.count; k++) {
        config.isa = isas.set[k];
        OWNED_LIT lit = light_up(bed, &config, light);
        ck_assert_int_eq(lit.status, 0);
        ck_assert_mem_eq(lit.power, power, bed->n * sizeof *power);
    }
}

TEST(triangles_at_random_as_by_plain_rays) {
    double worst = 0, shaded = 0;
    for (uint64_t seed = 1; seed < by_night(5, 4); seed++) {
        OWNED_BED bed = packing(30, .3, 1, .2, seed, false);
        OWNED struct mesh *mesh = mesh_new();
        double d[3];
        unit_direction(seed, d);
        add_triangles(mesh, &bed, 60, 10, seed);
        const fibrad_scene_config config = config_of(mesh);
        const fibrad_light light = along(d[0], d[1], d[2]);
        OWNED_LIT lit = light_up(&bed, &config, &light);
        OWNED_BY(plain_free) struct plain_bed plain = plain_bed_of(&bed);
        ck_assert_int_eq(lit.status, 0);
        for (uint32_t i = 0; i < bed.n; i++) {
            plain.triangles = NULL;
            shaded += area_by_rays(&plain, i, d, 50);
            plain.triangles = &mesh->triangles;
            const double area = area_by_rays(&plain, i, d, 150), r = bed.r[i];
            shaded -= lit.power[i];
            worst = fmax(worst, fabs(lit.power[i] - area) / (PI * r * r));
        }
        check_bits(&bed, config, &light, lit.power);
    }
    printf("triangles at random: %.4f of a disc, %.1f hidden\n", worst, shaded);
    ck_assert_double_lt(worst, .003);
    ck_assert_double_gt(shaded, 10);
}

/* Above a bed that is periodic along x and y, one plate covers a half of each period and another one the other half.
 * The light is slanted. Together the plates hide what the bed takes without them. */
TEST(plates_of_half_a_period_hide_all) {
    OWNED_BED bed = packing(60, .4, .6, .4, 3, true);
    const double side = bed.period[0], top = bed.period[2];
    bed.period[2] = 0;
    fibrad_scene_config config = {.period = {side, side, 0}};
    const fibrad_light light = along(.9, .5, -1);
    OWNED_LIT all = light_up(&bed, &config, &light);
    double sum[60] = {0};
    for (int half = 0; half < 2; half++) {
        OWNED struct mesh *mesh = mesh_new();
        uint32_t corner[4];
        for (int c = 0; c < 4; c++)
            corner[c] =
                mesh_vertex(mesh, side * (.3 + .5 * half + (c == 1 || c == 2 ? .5 : 0)), side * (c / 2) - .1, top + 2);
        mesh_quad(mesh, corner, 0, 0);
        config = config_of(mesh);
        config.period[0] = config.period[1] = side;
        OWNED_LIT lit = light_up(&bed, &config, &light);
        ck_assert_int_eq(lit.status, 0);
        ck_assert_double_lt(lit.ends.spheres, .8 * all.ends.spheres);
        for (uint32_t i = 0; i < bed.n; i++) sum[i] += lit.power[i];
    }
    for (uint32_t i = 0; i < bed.n; i++) ck_assert_double_eq_tol(sum[i], all.power[i], 1e-11);
}

/* Of a triangle that rises above the rim of a box, only the part below the rim throws a shadow: light enters at the
 * rim. The shadow is that of a triangle that ends at the rim. */
TEST(triangles_outside_throw_no_shadow) {
    const double one[][4] = {{0, 0, 0, 1}};
    OWNED_BED bed = bed_of(1, one);
    const fibrad_plane top = {2, 1, 2};
    double area[3];
    for (int k = 0; k < 3; k++) {
        OWNED struct mesh *mesh = mesh_new();
        const double high = k == 1 ? 2 : 6; /* of a plate through (1, 0, 1) and (2, 0, 2), or of one above the rim */
        const double low = k == 2 ? 2.5 : 1.1;
        uint32_t corner[4];
        for (int c = 0; c < 4; c++) {
            const double z = c == 1 || c == 2 ? high : low;
            corner[c] = mesh_vertex(mesh, z, c / 2 ? 5 : -5, z);
        }
        mesh_quad(mesh, corner, 0, 0);
        fibrad_scene_config config = config_of(mesh);
        config.opening = &top, config.openings = 1;
        const fibrad_light light = along(-.5, .1, -1);
        OWNED_LIT lit = light_up(&bed, &config, &light);
        ck_assert_int_eq(lit.status, 0);
        area[k] = lit.power[0];
    }
    ck_assert_double_eq_tol(area[0], area[1], 1e-12);
    ck_assert_double_lt(area[0], 3);
    ck_assert_double_eq_tol(area[2], PI, 1e-12);
}

/* A floor of triangles that cuts a sphere does not hide it from above, and hides all of it from below. */
TEST(a_floor_that_cuts_a_sphere) {
    const double one[][4] = {{0, 0, 0, 1}};
    OWNED_BED bed = bed_of(1, one);
    OWNED struct mesh *mesh = mesh_new();
    uint32_t corner[4];
    for (int c = 0; c < 4; c++) corner[c] = mesh_vertex(mesh, c == 1 || c == 2 ? 5 : -5, c / 2 ? 5 : -5, -.97);
    mesh_quad(mesh, corner, 0, 0);
    const fibrad_scene_config config = config_of(mesh);
    for (int up = 0; up < 2; up++) {
        const fibrad_light light = along(.1, .2, up ? 1 : -1);
        OWNED_LIT lit = light_up(&bed, &config, &light);
        ck_assert_int_eq(lit.status, 0);
        ck_assert_double_eq_tol(lit.power[0], up ? 0 : PI, 1e-12);
    }
}
