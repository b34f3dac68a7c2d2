/* test_heat.c - net powers against closed forms, paths followed one by one, published conductivities, and themselves
 * under every setting that must not matter; patches against the places they stand for. SPDX-License-Identifier: MIT */
#include "base/elementary.h"
#include "base/random.h"
#include "row/beam.h"
#include "scene/walls.h"
#include "fibrad_heat.h"
#include "heat/wall_patch.h"
#include "sample/direction.h"
#include "sample/tables.h"
#include "scenes.h"
#include "suite.h"

#define PI 3.14159265358979323846

/* Walls by slot: 0 to 5 are planes across the axes, x low, x high, y low, y high, z low, z high; 6 is a cylinder. */
struct walls {
    uint32_t planes;    /* sum of 1 << slot */
    uint32_t open;      /* of openings likewise */
    double at[6];       /* where plane k stands on its axis */
    double cylinder[3]; /* x and y of its axis, and its radius; radius 0: none */
};

/* A bed, what is about it, and what came out. */
struct problem {
    struct bed bed;
    struct walls walls;
    double wall_temperature[FIBRAD_WALLS], wall_emissivity[FIBRAD_WALLS], wall_power[FIBRAD_WALLS]; /* by slot */
    uint32_t bodies, slot[FIBRAD_WALLS]; /* the bodies of the scene are these walls */
    fibrad_heat_config config;
    fibrad_heat_sources sources;
    double *temperature, *emissivity;
    fibrad_scene *scene;
    fibrad_heat *heat;
    fibrad_heat_result result;
    bool backwards; /* tasks and parts from the last to the first */
    bool turned;    /* so are bodies */
    int isa;
};

static struct problem problem_of(struct bed bed, double temperature, double emissivity) {
    struct problem p = {.bed = bed};
    p.temperature = malloc(bed.n * sizeof(double));
    p.emissivity = malloc(bed.n * sizeof(double));
    p.result.power = malloc(bed.n * sizeof(double));
    for (uint32_t i = 0; i < bed.n; i++) p.temperature[i] = temperature, p.emissivity[i] = emissivity;
    fibrad_heat_sources_init(&p.sources);
    ck_assert(isnan(p.sources.surroundings) && p.sources.sigma == FIBRAD_STEFAN_BOLTZMANN);
    p.sources.sigma = 1, p.sources.surroundings = 0;
    p.sources.temperature = p.temperature;
    p.sources.emissivity = p.emissivity;
    for (int k = 0; k < FIBRAD_WALLS; k++) p.wall_emissivity[k] = 1;
    return p;
}

static void free_heat(struct problem *p) {
    free(p->scene);
    free(p->heat);
}

static void free_problem(struct problem *p) {
    free_heat(p);
    free(p->temperature);
    free(p->emissivity);
    free(p->result.power);
    bed_free(&p->bed);
}

static uint32_t mirrored(const struct problem *p, uint32_t k, uint32_t n) { return p->backwards ? n - 1 - k : k; }

/* The scene of the bed within its walls. */
static void build_scene(struct problem *p) {
    const struct walls *walls = &p->walls;
    fibrad_body body[FIBRAD_WALLS];
    fibrad_plane opening[6];
    uint32_t openings = 0;
    p->bodies = 0;
    for (int slot = 0; slot < 6; slot++)
        if (walls->open >> slot & 1) opening[openings++] = (fibrad_plane){slot / 2, slot % 2, walls->at[slot]};
    for (uint32_t k = 0; k < FIBRAD_WALLS; k++) {
        const uint32_t slot = p->turned ? FIBRAD_WALLS - 1 - k : k;
        if (slot == FIBRAD_CYLINDER ? !(walls->cylinder[2] > 0) : (walls->planes >> slot & 1) == 0) continue;
        body[p->bodies] = slot == FIBRAD_CYLINDER
                              ? cylinder_at(walls->cylinder[0], walls->cylinder[1], walls->cylinder[2])
                              : plane_at((int)slot / 2, slot % 2, walls->at[slot]);
        p->slot[p->bodies++] = slot;
    }
    p->scene = scene_with(
        &p->bed, &(fibrad_scene_config){
                     .isa = p->isa, .body = body, .bodies = p->bodies, .opening = opening, .openings = openings});
}

static void trace_beams(struct problem *p) {
    fibrad_work work = work_growing();
    const uint32_t tasks = fibrad_heat_tasks(p->heat);
    for (uint32_t k = 0; k < tasks; k++)
        ck_assert_int_eq(fibrad_heat_trace(p->heat, &work, mirrored(p, k, tasks)), FIBRAD_OK);
    work_free(&work);
}

static void trace(struct problem *p) {
    build_scene(p);
    const size_t size = fibrad_heat_size(&p->config, p->scene);
    ck_assert_uint_gt(size, 0);
    void *block = block_of(size);
    ck_assert_int_eq(fibrad_heat_init(&p->heat, block, size, &p->config, p->scene), FIBRAD_OK);
    ck_assert_ptr_eq(p->heat, block);
    trace_beams(p);
}

static void solve(struct problem *p) {
    const uint32_t parts = p->config.parts ? p->config.parts : 8;
    double temperature[FIBRAD_WALLS], emissivity[FIBRAD_WALLS], power[FIBRAD_WALLS];
    for (uint32_t b = 0; b < p->bodies; b++)
        temperature[b] = p->wall_temperature[p->slot[b]], emissivity[b] = p->wall_emissivity[p->slot[b]];
    p->sources.body_temperature = temperature, p->sources.body_emissivity = emissivity;
    p->result.body_power = power;
    ck_assert_uint_eq(fibrad_heat_parts(p->heat), parts);
    ck_assert_int_eq(fibrad_heat_begin(p->heat, &p->sources), FIBRAD_OK);
    for (int solved = 0; !solved;) {
        for (uint32_t k = 0; k < parts; k++)
            ck_assert_int_eq(fibrad_heat_sweep(p->heat, mirrored(p, k, parts)), FIBRAD_OK);
        ck_assert_int_eq(fibrad_heat_step(p->heat, &solved), FIBRAD_OK);
    }
    ck_assert_int_eq(fibrad_heat_read(p->heat, &p->result), FIBRAD_OK);
    memset(p->wall_power, 0, sizeof p->wall_power);
    for (uint32_t b = 0; b < p->bodies; b++) p->wall_power[p->slot[b]] = power[b];
    p->sources.body_temperature = p->sources.body_emissivity = NULL;
    p->result.body_power = NULL;
}

static void trace_and_solve(struct problem *p) {
    trace(p);
    solve(p);
}

static double emission(double t) { return t * t * t * t; }

static double sphere_area(const struct bed *bed, uint32_t i) { return 4 * PI * bed->r[i] * bed->r[i]; }

/* All walls of a box, the planes at -half and half. */
static struct walls box_of(double half) {
    return (struct walls){.planes = 63, .at = {-half, half, -half, half, -half, half}};
}

/* The box that holds an open bed. */
static struct walls box_about(const struct bed *bed) {
    struct walls walls = {.planes = 63};
    const double *const coordinate[3] = {bed->x, bed->y, bed->z};
    for (int axis = 0; axis < 3; axis++) {
        walls.at[2 * axis] = INFINITY, walls.at[2 * axis + 1] = -INFINITY;
        for (uint32_t i = 0; i < bed->n; i++) {
            walls.at[2 * axis] = fmin(walls.at[2 * axis], coordinate[axis][i] - bed->r[i]);
            walls.at[2 * axis + 1] = fmax(walls.at[2 * axis + 1], coordinate[axis][i] + bed->r[i]);
        }
    }
    return walls;
}

static double sum_of_powers(const struct problem *p, double *largest) {
    double sum = p->result.surroundings_power;
    *largest = fabs(sum);
    for (int k = 0; k < FIBRAD_WALLS; k++) {
        sum += p->wall_power[k];
        worst_of(largest, fabs(p->wall_power[k]));
    }
    for (uint32_t i = 0; i < p->bed.n; i++) {
        sum += p->result.power[i];
        worst_of(largest, fabs(p->result.power[i]));
    }
    return sum;
}

static void assert_near(double value, double truth, double tolerance) {
    ck_assert_msg(fabs(value - truth) <= tolerance * fabs(truth), "%.9g instead of %.9g, off by %.3g", value, truth,
                  value / truth - 1);
}

/* ---- closed forms ---- */

static void assert_still(struct problem *p) {
    for (uint32_t i = 0; i < p->bed.n; i++) {
        const double black = sphere_area(&p->bed, i) * emission(p->temperature[i]);
        ck_assert_double_le(fabs(p->result.power[i]), 1e-10 * fmax(p->emissivity[i], .1) * black);
    }
    for (int k = 0; k < FIBRAD_WALLS; k++)
        ck_assert_double_le(fabs(p->wall_power[k]), 1e-10 * emission(p->temperature[0]));
}

START_TEST(nothing_flows_in_a_closed_box_at_one_temperature) {
    struct problem p = problem_of(packing(60, .6, 1.2, .5, 3, false), 3, .5);
    p.walls = box_about(&p.bed);
    for (uint32_t i = 0; i < p.bed.n; i++) p.emissivity[i] = (double)(i % 11) / 10;
    for (int k = 0; k < FIBRAD_WALLS; k++) p.wall_temperature[k] = 3, p.wall_emissivity[k] = .2 * k;
    p.config.directions = 40;
    trace_and_solve(&p);
    assert_still(&p);

    /* also from a solution in which much flowed */
    p.temperature[7] = 5, p.wall_temperature[3] = 1;
    solve(&p);
    ck_assert_double_gt(fabs(p.result.power[7]), 1);
    p.temperature[7] = 3, p.wall_temperature[3] = 3;
    solve(&p);
    assert_still(&p);
    free_problem(&p);
}
END_TEST

START_TEST(nothing_flows_in_a_periodic_bed_at_one_temperature) {
    struct problem p = problem_of(packing(100, 1, 1, .55, 5, true), 2, .3);
    p.config.directions = 40;
    trace_and_solve(&p);
    assert_still(&p);
    free_problem(&p);
}
END_TEST

START_TEST(a_grey_sphere_in_black_surroundings) {
    for (int walls = 0; walls < 2; walls++) {
        struct problem p = problem_of(bed_of(1, (const double[][4]){{.1, .2, .3, 1}}), 2, .3);
        if (walls) p.walls = box_of(20);
        for (int k = 0; k < FIBRAD_WALLS; k++) p.wall_temperature[k] = 1;
        p.sources.surroundings = walls ? 0 : 1;
        trace_and_solve(&p);
        assert_near(p.result.power[0], .3 * 4 * PI * (1 - 16), 1e-3);
        free_problem(&p);
    }
}
END_TEST

/* As between a sphere and a concentric one of the area of the box, whose walls are lit evenly enough. */
START_TEST(a_grey_sphere_in_a_large_grey_box) {
    struct problem p = problem_of(bed_of(1, (const double[][4]){{.1, .2, .3, 1}}), 2, .3);
    p.walls = box_of(20);
    for (int k = 0; k < FIBRAD_WALLS; k++) p.wall_temperature[k] = 1, p.wall_emissivity[k] = .05;
    trace_and_solve(&p);
    assert_near(p.result.power[0], 4 * PI * (1 - 16) / (1 / .3 + 4 * PI / 9600 * (1 / .05 - 1)), 1e-3);
    free_problem(&p);
}
END_TEST

START_TEST(two_parallel_grey_walls) {
    struct problem p = problem_of(bed_of(1, (const double[][4]){{.2, .3, .5, 1e-4}}), 1, .5);
    p.walls = (struct walls){.planes = 48, .at = {0, 0, 0, 0, 0, 1}};
    p.bed.period[0] = p.bed.period[1] = 2;
    p.wall_temperature[4] = 3, p.wall_emissivity[4] = .3;
    p.wall_temperature[5] = 2, p.wall_emissivity[5] = .6;
    trace_and_solve(&p);
    assert_near(p.wall_power[5], 4 * (81 - 16) / (1 / .3 + 1 / .6 - 1), 1e-3);
    ck_assert_double_eq(p.result.surroundings_power, 0);
    free_problem(&p);
}
END_TEST

/* Half of the 10,752 beams meet the plane, but for 6. Estimates are made of one sample each: they hold on the mean. */
START_TEST(a_black_sphere_touches_a_black_plane) {
    struct problem p = problem_of(bed_of(1, (const double[][4]){{0, 0, 0, 1}}), 2, 1);
    double estimate[FIBRAD_WALLS], errors = 0, estimates = 0;
    p.result.body_error = estimate;
    for (uint32_t wall = 0; wall < 6; wall++) {
        p.walls = (struct walls){.planes = 1u << wall};
        p.walls.at[wall] = wall % 2 ? 1 : -1;
        trace_and_solve(&p);
        const double error = p.wall_power[wall] / (16 * 2 * PI) - 1;
        ck_assert_double_le(fabs(error), 1.2e-3);
        assert_near(p.result.surroundings_power, 16 * 2 * PI, 1.2e-3);
        errors += error * error / 6, estimates += pow(estimate[0] / (16 * 2 * PI), 2) / 6;
        free_heat(&p);
    }
    ck_assert_double_le(sqrt(errors), 1e-3);
    ck_assert(errors < 4 * estimates && estimates < 4 * errors);
    p.scene = NULL, p.heat = NULL;
    free_problem(&p);
}
END_TEST

/* Between endless plates without a period, and in a tube with one, light goes to and fro: a mote sees the
 * radiosities of plates that have only each other, and in a tube that of a black body. */
START_TEST(a_mote_between_endless_walls) {
    struct problem p = problem_of(bed_of(1, (const double[][4]){{0, 0, 0, .01}}), 2, .5);
    p.walls = (struct walls){.planes = 48, .at = {0, 0, 0, 0, -.5, .5}};
    p.wall_temperature[4] = 3, p.wall_emissivity[4] = .8;
    p.wall_temperature[5] = 1, p.wall_emissivity[5] = .5;
    p.sources.surroundings = 1.5;
    trace_and_solve(&p);
    const double low = (.8 * 81 + .2 * .5 * 1) / (1 - .2 * .5), high = .5 * 1 + .5 * low;
    assert_near(p.result.power[0], .5 * 4e-4 * PI * ((low + high) / 2 - 16), 1e-3);
    double largest;
    ck_assert_double_le(fabs(sum_of_powers(&p, &largest)), 1e-12 * largest);
    free_heat(&p);
    p.walls = (struct walls){.cylinder = {0, 0, .5}};
    p.bed.period[2] = 1;
    p.wall_temperature[FIBRAD_CYLINDER] = 3, p.wall_emissivity[FIBRAD_CYLINDER] = .1;
    trace_and_solve(&p);
    assert_near(p.result.power[0], .5 * 4e-4 * PI * (81 - 16), 1e-2);
    free_problem(&p);
}
END_TEST

/* Plates with a period, as in closed form, whatever the mote is. */
/* A pair without end has the powers of an area, which is told: those of infinite parallel plates. */
START_TEST(a_pair_of_endless_plates) {
    double area[FIBRAD_WALLS];
    struct problem p = problem_of(bed_of(2, (const double[][4]){{0, 0, 0, 1e-3}, {.3, .1, 0, 1e-3}}), 2, 1e-3);
    p.walls = (struct walls){.planes = 48, .at = {0, 0, 0, 0, -.5, .5}};
    p.wall_temperature[4] = 3, p.wall_temperature[5] = 1;
    p.result.body_area = area;
    for (int grey = 0; grey < 2; grey++) {
        if (grey) p.wall_emissivity[4] = .8, p.wall_emissivity[5] = .3;
        trace_and_solve(&p);
        const double q = (81 - 1) / (1 / p.wall_emissivity[4] + 1 / p.wall_emissivity[5] - 1);
        ck_assert_double_eq_tol(area[0], .904 * .704,
                                1e-12); /* centres, and the largest size of the bed on either side */
        assert_near(p.wall_power[4], -q * area[0], 2e-3);
        assert_near(p.wall_power[5], q * area[1], 2e-3);
        free_heat(&p);
    }
    p.scene = NULL, p.heat = NULL;
    free_problem(&p);
}
END_TEST

START_TEST(a_mote_between_periodic_plates) {
    struct problem p = problem_of(bed_of(1, (const double[][4]){{0, 0, 0, .01}}), 2, .5);
    p.bed.period[0] = p.bed.period[1] = 1;
    p.walls = (struct walls){.planes = 48, .at = {0, 0, 0, 0, -.5, .5}};
    p.wall_temperature[4] = 3, p.wall_emissivity[4] = .8;
    p.wall_temperature[5] = 1, p.wall_emissivity[5] = .5;
    trace_and_solve(&p);
    assert_near(p.wall_power[5], (81 - 1) / (1 / .8 + 1 / .5 - 1), 1e-3);
    assert_near(p.wall_power[4], -p.wall_power[5], 1e-3);
    free_problem(&p);
}
END_TEST

/* A plane without end reflects what comes from the surroundings, and from the sphere. With two equal spheres in each
 * other's mirror, and nothing from beyond, a perfect mirror is not what a diffuse wall is; but a sphere between two
 * white walls without end at its own temperature must neither gain nor lose, whatever the walls' temperature. */
START_TEST(white_walls_take_nothing) {
    struct problem p = problem_of(bed_of(1, (const double[][4]){{0, 0, 0, 1}}), 2, .4);
    p.walls = (struct walls){.planes = 48, .at = {0, 0, 0, 0, -1.5, 1.5}};
    p.wall_emissivity[4] = p.wall_emissivity[5] = 0;
    p.wall_temperature[4] = 7, p.sources.surroundings = 2;
    trace_and_solve(&p);
    ck_assert_double_le(fabs(p.result.power[0]), 1e-10);
    p.sources.surroundings = 0;
    solve(&p);
    ck_assert(p.wall_power[4] == 0 && p.wall_power[5] == 0);
    assert_near(p.result.surroundings_power, -p.result.power[0], 1e-12);
    ck_assert_double_lt(-p.result.power[0], .4 * 16 * 4 * PI);     /* less than alone, */
    ck_assert_double_gt(-p.result.power[0], .4 * 16 * 4 * PI / 2); /* yet half as much at least */
    free_problem(&p);
}
END_TEST

START_TEST(view_factors_between_the_walls_of_a_cube) {
    struct problem p = problem_of(bed_of(1, (const double[][4]){{0, 0, 0, 1e-4}}), 0, 1);
    p.walls = box_of(.5);
    p.wall_temperature[4] = 1;
    trace_and_solve(&p);
    assert_near(p.wall_power[5], 0.1998249, 5e-3);
    for (int k = 0; k < 4; k++) assert_near(p.wall_power[k], 0.2000438, 5e-3);
    free_problem(&p);
}
END_TEST

/* More beams, more rays: what walls exchange, without many spheres, would otherwise stay as it is. */
START_TEST(walls_exchange_better_with_more_beams) {
    struct problem p = problem_of(bed_of(1, (const double[][4]){{0, 0, 0, 1e-4}}), 0, 1);
    p.walls = box_of(.5);
    p.wall_temperature[4] = 1;
    p.config.directions = 4000;
    trace_and_solve(&p);
    double square = 0;
    for (int k = 0; k < 6; k++) {
        const double truth = k == 5 ? 0.1998249 : 0.2000438, error = p.wall_power[k] / truth - 1;
        if (k != 4) square += error * error / 5;
    }
    ck_assert_msg(sqrt(square) < 7e-4, "off by %g", sqrt(square));
    free_problem(&p);
}
END_TEST

/* Each wall has an estimate of its own error, above which it is seldom by more than a factor of two. */
START_TEST(walls_know_their_errors) {
    double error[6], ratio = 0;
    uint32_t low = 0;
    for (uint32_t hot = 0; hot < 6; hot++) {
        struct problem p = problem_of(bed_of(1, (const double[][4]){{0, 0, 0, 1e-4}}), 0, 1);
        p.walls = box_of(.5);
        p.wall_temperature[hot] = 1;
        p.result.body_error = error;
        trace_and_solve(&p);
        for (uint32_t k = 0; k < 6; k++) {
            const double truth = k == hot ? -1 : k == (hot ^ 1) ? 0.1998249 : 0.2000438;
            low += fabs(p.wall_power[k] - truth) > 2 * error[k];
            ratio += error[k] / 36 / 1e-3;
        }
        free_problem(&p);
    }
    ck_assert_uint_le(low, 6); /* of 36, which are not independent */
    ck_assert_double_lt(ratio, 1);
    ck_assert_double_gt(ratio, .05);
}
END_TEST

START_TEST(view_factors_between_the_walls_of_a_cylinder) {
    struct problem p = problem_of(bed_of(1, (const double[][4]){{0, 0, 0, 1e-4}}), 0, 1);
    p.walls = (struct walls){.planes = 48, .at = {0, 0, 0, 0, -1, 1}, .cylinder = {0, 0, 1}};
    p.wall_temperature[4] = 1;
    trace_and_solve(&p);
    const double x = 2 + 4, lids = .5 * (x - sqrt(x * x - 4)); /* coaxial discs of radius 1, distance 2 */
    assert_near(p.wall_power[5], PI * lids, 5e-3);
    assert_near(p.wall_power[6], PI * (1 - lids), 5e-3);
    free_problem(&p);
}
END_TEST

/* Where a box of some planes would be endless, the others. */
static uint32_t openings_of(uint32_t planes) {
    const int axes = ((planes & 3) > 0) + ((planes & 12) > 0) + ((planes & 48) > 0);
    return axes > 1 ? 63 & ~planes : 0;
}

/* Walls without spheres: a box anywhere, and walls without end, whose patches must lie on the inner side of the others
 * although there is no bed to tell where. */
START_TEST(walls_alone) {
    struct problem p = problem_of(bed_of(0, NULL), 0, 1);
    p.walls = (struct walls){.planes = 63, .at = {49, 50, -20, -19, 7, 8}};
    p.wall_temperature[4] = 1;
    trace_and_solve(&p);
    assert_near(p.wall_power[5], 0.1998249, 5e-3);
    for (int k = 0; k < 4; k++) assert_near(p.wall_power[k], 0.2000438, 5e-3);
    free_heat(&p);
    for (uint32_t planes = 1; planes < 63; planes++) {
        double largest;
        p.walls = (struct walls){.planes = planes, .at = {-300, -200, 100, 250, -220, 4}};
        p.walls.open = openings_of(planes);
        for (int k = 0; k < FIBRAD_WALLS; k++) p.wall_temperature[k] = 1 + .1 * k, p.wall_emissivity[k] = .5;
        p.sources.surroundings = .5, p.config.directions = 8;
        trace_and_solve(&p);
        ck_assert(isfinite(p.result.surroundings_power));
        ck_assert_double_le(fabs(sum_of_powers(&p, &largest)), 1e-12 * largest);
        for (uint32_t k = 0; k < 6; k++) {
            ck_assert(isfinite(p.wall_power[k]));
            if ((planes >> k & 1) == 0) ck_assert_double_eq(p.wall_power[k], 0);
        }
        free_heat(&p);
    }
    p.scene = NULL, p.heat = NULL;
    free_problem(&p);
}
END_TEST

START_TEST(two_black_spheres_in_contact) {
    struct problem p = problem_of(bed_of(2, (const double[][4]){{0, 0, 0, 1}, {1.2, 1.6, 0, 1}}), 1, 1);
    p.temperature[1] = 0;
    trace_and_solve(&p);
    assert_near(p.result.power[1], 4 * PI * 0.0755868184216124, 1e-2);
    free_problem(&p);
}
END_TEST

/* ---- paths ---- */

static void diffuse(const double n[3], double u, double v, double w[3]) {
    double a[3] = {0, 0, 0}, b[3], sine, cosine;
    const int least = fabs(n[0]) < .6 ? 0 : 1;
    a[least] = 1;
    const double along = n[least];
    for (int k = 0; k < 3; k++) a[k] -= along * n[k];
    const double size = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    for (int k = 0; k < 3; k++) a[k] /= size;
    for (int k = 0; k < 3; k++) b[k] = n[(k + 1) % 3] * a[(k + 2) % 3] - n[(k + 2) % 3] * a[(k + 1) % 3];
    fibrad_sincos_turn(v, &sine, &cosine);
    for (int k = 0; k < 3; k++) w[k] = sqrt(u) * (cosine * a[k] + sine * b[k]) + sqrt(1 - u) * n[k];
}

/* The first thing a ray meets from `o` on along w, by trying all: sphere k, or n + wall; UINT32_MAX: nothing. The new
 * place and normal. */
static uint32_t first_met(const struct problem *p, uint32_t from, double o[3], const double w[3], double normal[3]) {
    const struct bed *bed = &p->bed;
    const double *cylinder = p->walls.cylinder;
    uint32_t met = UINT32_MAX;
    double nearest = INFINITY;
    for (uint32_t j = 0; j < bed->n; j++) {
        const double c[3] = {bed->x[j] - o[0], bed->y[j] - o[1], bed->z[j] - o[2]};
        const double depth = c[0] * w[0] + c[1] * w[1] + c[2] * w[2];
        const double root = bed->r[j] * bed->r[j] - (c[0] * c[0] + c[1] * c[1] + c[2] * c[2]) + depth * depth;
        if (j == from || depth <= 0 || root <= 0 || depth - sqrt(root) >= nearest) continue;
        nearest = depth - sqrt(root), met = j;
    }
    for (uint32_t k = 0; k < 6 && met >= bed->n; k++) {
        const double t = (p->walls.at[k] - o[k / 2]) / w[k / 2];
        if (((p->walls.planes | p->walls.open) >> k & 1) == 0 || (w[k / 2] > 0) != (k % 2 == 1) || t >= nearest)
            continue;
        nearest = t, met = bed->n + k;
    }
    if (met >= bed->n && cylinder[2] > 0) {
        const double x = o[0] - cylinder[0], y = o[1] - cylinder[1], across = w[0] * w[0] + w[1] * w[1];
        const double along = x * w[0] + y * w[1], inside = cylinder[2] * cylinder[2] - (x * x + y * y);
        const double t = (sqrt(fmax(0, along * along + across * inside)) - along) / across;
        if (t < nearest) nearest = t, met = bed->n + FIBRAD_CYLINDER;
    }
    if (met == UINT32_MAX) return met;
    for (int a = 0; a < 3; a++) o[a] += nearest * w[a], normal[a] = 0;
    if (met == bed->n + FIBRAD_CYLINDER) {
        normal[0] = (cylinder[0] - o[0]) / cylinder[2], normal[1] = (cylinder[1] - o[1]) / cylinder[2];
    } else if (met >= bed->n) {
        normal[(met - bed->n) / 2] = (met - bed->n) % 2 ? -1 : 1;
    } else {
        normal[0] = (o[0] - bed->x[met]) / bed->r[met], normal[1] = (o[1] - bed->y[met]) / bed->r[met];
        normal[2] = (o[2] - bed->z[met]) / bed->r[met];
    }
    return met;
}

/* Net power of sphere i: what it absorbs of the emission that paths backwards from it come from. */
static double power_by_paths(const struct problem *p, uint32_t i, uint32_t paths) {
    double sum = 0;
    for (uint32_t k = 0; k < paths; k++) {
        fibrad_random random = fibrad_random_start(i, k);
        double n[3], o[3], w[3], sine, cosine;
        const double z = 2 * fibrad_random_next(&random) - 1;
        fibrad_sincos_turn(fibrad_random_next(&random), &sine, &cosine);
        n[0] = sqrt(1 - z * z) * cosine, n[1] = sqrt(1 - z * z) * sine, n[2] = z;
        o[0] = p->bed.x[i] + p->bed.r[i] * n[0], o[1] = p->bed.y[i] + p->bed.r[i] * n[1];
        o[2] = p->bed.z[i] + p->bed.r[i] * n[2];
        for (uint32_t at = i;;) {
            const double u = fibrad_random_next(&random), v = fibrad_random_next(&random);
            diffuse(n, u, v, w);
            at = first_met(p, at, o, w, n);
            const uint32_t wall = at - p->bed.n;
            const double eps = at < p->bed.n ? p->emissivity[at] : p->wall_emissivity[wall];
            if (fibrad_random_next(&random) >= eps) continue;
            sum += emission(at < p->bed.n ? p->temperature[at] : p->wall_temperature[wall]);
            break;
        }
    }
    return p->emissivity[i] * sphere_area(&p->bed, i) * (sum / paths - emission(p->temperature[i]));
}

START_TEST(powers_are_those_of_paths) {
    static const struct {
        double low, high, spheres, walls, bar;
    } cases[] = {{1, 1, .3, .5, .01}, {.5, 1.5, .3, .4, .015}, {1, 1, .8, .9, .015}};
    struct problem p = problem_of(packing(24, cases[_i].low, cases[_i].high, .55, 11, false), 1, cases[_i].spheres);
    p.walls = box_about(&p.bed);
    for (uint32_t i = 0; i < p.bed.n; i++) p.temperature[i] = 1 + .5 * bed_make_random(4, i);
    for (int k = 0; k < FIBRAD_WALLS; k++) p.wall_temperature[k] = .8 + .2 * k, p.wall_emissivity[k] = cases[_i].walls;
    trace_and_solve(&p);
    double difference = 0, size = 0;
    for (uint32_t i = 0; i < p.bed.n; i++) {
        const double truth = power_by_paths(&p, i, 40000);
        difference += (p.result.power[i] - truth) * (p.result.power[i] - truth), size += truth * truth;
    }
    ck_assert_msg(sqrt(difference / size) < cases[_i].bar, "off by %g", sqrt(difference / size));
    free_problem(&p);
}
END_TEST

/* Box and cylinder of grey walls, open above, or above and on one side, against paths that end in the surroundings. */
START_TEST(powers_in_open_containers_are_those_of_paths) {
    struct problem p = problem_of(packing(24, .5, 1.5, .55, 11, false), 1, .4);
    p.walls = box_about(&p.bed);
    p.walls.open = _i == 1 ? 34 : 32, p.walls.planes = 63 & ~p.walls.open;
    if (_i == 2) {
        const double *at = p.walls.at;
        p.walls.planes = 16;
        p.walls.cylinder[0] = (at[0] + at[1]) / 2, p.walls.cylinder[1] = (at[2] + at[3]) / 2;
        p.walls.cylinder[2] = hypot(at[1] - at[0], at[3] - at[2]) / 2;
    }
    for (uint32_t i = 0; i < p.bed.n; i++) p.temperature[i] = 1 + .5 * bed_make_random(4, i);
    p.sources.surroundings = .7;
    for (int k = 0; k < FIBRAD_WALLS; k++) {
        const bool open = p.walls.open >> k & 1; /* of the paths alone */
        p.wall_temperature[k] = open ? .7 : .8 + .2 * k, p.wall_emissivity[k] = open ? 1 : .3;
    }
    trace_and_solve(&p);
    double difference = 0, size = 0;
    for (uint32_t i = 0; i < p.bed.n; i++) {
        const double truth = power_by_paths(&p, i, 20000);
        difference += (p.result.power[i] - truth) * (p.result.power[i] - truth), size += truth * truth;
    }
    ck_assert_msg(sqrt(difference / size) < .015, "off by %g", sqrt(difference / size));
    free_problem(&p);
}
END_TEST

/* What it is about: an opening is a black plane at the temperature of the surroundings, whose power is theirs. To the
 * bit, but that powers of several openings are added: those of spheres and other walls, their errors, temperatures that
 * are found, one opening or several, with plates that face them without end, insulated walls, one radiosity each. */
START_TEST(an_opening_is_a_black_plane_as_hot_as_the_surroundings) {
    static const struct {
        uint32_t planes, open;
        double radius;
    } cases[] = {{31, 32, 0}, {29, 34, 0}, {16, 32, 3}, {0, 48, 3}, {16, 32, 0}, {0, 48, 0}, {0, 2, 0}, {4, 59, 0}};
    for (uint32_t k = 0; k < 2 * sizeof cases / sizeof *cases; k++) {
        const uint32_t open = cases[k / 2].open;
        struct problem p[2];
        double power[2][30], error[2][30], temperature[2][30], found[2][30];
        for (int closed = 0; closed < 2; closed++) {
            struct problem *q = &p[closed];
            *q = problem_of(packing(30, .3, .8, .3, 5, false), 1, .4);
            for (uint32_t i = 0; i < 30; i++) power[closed][i] = i % 2 ? .1 * i : NAN, found[closed][i] = 0;
            for (uint32_t i = 0; i < 30; i++) q->temperature[i] = i % 2 ? NAN : 1 + bed_make_random(3, i);
            q->sources.power = power[closed];
            q->walls = box_about(&q->bed);
            const double *at = q->walls.at;
            q->walls.planes = cases[k / 2].planes | (closed ? open : 0), q->walls.open = closed ? 0 : open;
            q->walls.cylinder[0] = (at[0] + at[1]) / 2, q->walls.cylinder[1] = (at[2] + at[3]) / 2;
            q->walls.cylinder[2] = cases[k / 2].radius > 0 ? hypot(at[1] - at[0], at[3] - at[2]) / 2 : 0;
            q->sources.surroundings = .8, q->sources.uniform = k % 2;
            for (int w = 0; w < FIBRAD_WALLS; w++) {
                const bool lid = open >> w & 1;
                q->wall_temperature[w] = lid ? .8 : 1 + .1 * w, q->wall_emissivity[w] = lid ? 1 : .3;
            }
            q->config.directions = 24;
            q->result.power_error = error[closed], q->result.temperature = temperature[closed];
            q->result.temperature_error = found[closed];
            trace_and_solve(q);
        }
        ck_assert_mem_eq(p[0].result.power, p[1].result.power, 30 * sizeof(double));
        ck_assert_mem_eq(error[0], error[1], sizeof error[0]);
        ck_assert_mem_eq(temperature[0], temperature[1], sizeof temperature[0]);
        ck_assert_mem_eq(found[0], found[1], sizeof found[0]);
        double lids = p[1].result.surroundings_power;
        for (int w = 0; w < FIBRAD_WALLS; w++) {
            if (open >> w & 1)
                lids += p[1].wall_power[w];
            else
                ck_assert_double_eq(p[0].wall_power[w], p[1].wall_power[w]);
        }
        ck_assert_double_eq_tol(p[0].result.surroundings_power, lids, 1e-12 * fabs(lids));
        free_problem(&p[0]), free_problem(&p[1]);
    }
}
END_TEST

/* Four pairs of a hot and a cold sphere in a cylinder whose wall reflects most, each pair a quarter of a turn from the
 * next: what the wall throws from one to the other depends on where it is lit. */
START_TEST(powers_beside_the_wall_of_a_cylinder) {
    struct bed bed = bed_of(0, NULL);
    double power[2] = {0, 0}, truth[2] = {0, 0};
    for (int k = 0; k < 8; k++) {
        const double turn = (k / 2 + .3) * (PI / 2);
        add_sphere(&bed, .3 + 2.2 * cos(turn), 2.2 * sin(turn) - .2, k % 2 ? .6 : -.4, .4);
    }
    struct problem p = problem_of(bed, 0, 1);
    p.walls = (struct walls){.planes = 48, .at = {0, 0, 0, 0, -1, 1.2}, .cylinder = {.3, -.2, 3}};
    p.wall_emissivity[FIBRAD_CYLINDER] = .1;
    for (uint32_t i = 0; i < 8; i += 2) p.temperature[i] = 1;
    p.config.directions = 1000; /* few spheres, far apart */
    trace_and_solve(&p);
    for (uint32_t i = 0; i < 8; i++)
        power[i % 2] += p.result.power[i] / 4, truth[i % 2] += power_by_paths(&p, i, 200000) / 4;
    for (int k = 0; k < 2; k++) assert_near(power[k], truth[k], .01);
    for (uint32_t i = 0; i < 8; i++) assert_near(p.result.power[i], power[i % 2], .004);
    free_problem(&p);
}
END_TEST

/* ---- patches ---- */

/* Origin and direction of the beam of one point of window k of sphere i, and the normal there. */
static void beam(const struct problem *p, uint32_t i, uint32_t k, uint32_t point, double o[3], double w[3],
                 double normal[3]) {
    const fibrad_heat_config *config = &p->heat->config;
    const double centre[3] = {p->bed.x[i], p->bed.y[i], p->bed.z[i]};
    double frame[9];
    fibrad_disc_points set;
    ck_assert_int_eq(fibrad_disc_points_get(config->points, &set), FIBRAD_OK);
    fibrad_beam_frame(k, config->directions, config->points, frame);
    const double x = set.x[point], y = set.y[point], up = sqrt(fmax(0, 1 - (x * x + y * y)));
    for (int a = 0; a < 3; a++) {
        w[a] = frame[6 + a];
        normal[a] = x * frame[a] + y * frame[3 + a] + up * w[a];
        o[a] = centre[a] + p->bed.r[i] * normal[a];
    }
}

static double cosine_of(const double a[3], const double b[3]) {
    const double squares = (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]) * (b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
    return (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) / sqrt(squares);
}

/* Strands of the row of `place` to a body: the patches that each leaves and meets, and its beams. */
struct strands {
    uint32_t count, sum, from[10752], to[10752], beams[10752];
    double share;
};

static void strands_to(const fibrad_heat *heat, uint32_t place, uint32_t body, struct strands *s) {
    const unsigned char *at = heat->pencils.pool + heat->pencils.row[place].begin,
                        *end = at + heat->pencils.row[place].bytes;
    s->count = s->sum = 0;
    for (; at < end; at += fibrad_heat_pencil_bytes(fibrad_heat_pencil_at(at))) {
        const fibrad_heat_pencil *pencil = fibrad_heat_pencil_at(at);
        const fibrad_heat_bundle *bundle = fibrad_heat_bundles(pencil);
        const uint8_t *strand = fibrad_heat_strands(pencil);
        if (pencil->body != body) continue;
        s->share = (double)pencil->share;
        uint32_t of_bundle = 0;
        for (uint32_t k = 0; k < pencil->strands; k++) {
            const uint32_t n = s->count++;
            s->from[n] = 4u * bundle->from + strand[k] / 32 % 4, s->to[n] = 4u * bundle->to + strand[k] / 8 % 4;
            s->beams[n] = strand[k] % 8 + 1u;
            s->sum += s->beams[n], of_bundle += s->beams[n];
            if (strand[k] < FIBRAD_HEAT_LAST && k + 1 < pencil->strands) continue;
            ck_assert_uint_eq(bundle++->count, of_bundle);
            of_bundle = 0;
        }
    }
}

/* A small sphere all but touches a large one, or a wall. The truth is from paths followed one by one by another
 * program, to .02 % and less; before fours of patches were divided powers of the small one were 6.5, 2.9, 1.6 and 7.7 %
 * off. */
struct spot_case {
    double spheres[2][4], temperature[2], emissivity[2], truth[2], noise[2];
    uint32_t n;
};
static const struct spot_case spot_cases[] = {
    {{{0, 0, 0, .3}, {.315015, 0, 0, .015}}, {600, 1300}, {.1, .6}, {-768.40269, -252.945}, {.18, .025}, 2},
    {{{0, 0, 0, .3}, {.1512072, .189009, .2016096, .015}},
     {600, 1300},
     {.3, .3},
     {-2319.8835, -131.88096},
     {0.43, 0.0096},
     2},
    {{{0, 0, 0, .3}, {.14688288, .1836036, .19584384, .006}},
     {600, 1300},
     {.8, .8},
     {-6215.6311, -56.486352},
     {1, 0.0027},
     2},
    {{{.43, .56, .01001, .01}}, {1000}, {.6}, {-36.747829}, {.0066}, 1}};

START_TEST(a_small_sphere_and_the_spot_under_it) {
    const struct spot_case *c = &spot_cases[_i];
    struct problem p = problem_of(bed_of(c->n, c->spheres), 0, 0);
    double largest, error[2];
    for (uint32_t i = 0; i < c->n; i++) p.temperature[i] = c->temperature[i], p.emissivity[i] = c->emissivity[i];
    p.sources.sigma = FIBRAD_STEFAN_BOLTZMANN, p.sources.surroundings = 300;
    p.result.power_error = error;
    if (c->n == 1) {
        p.walls = (struct walls){.planes = 63, .at = {0, 1, 0, 1, 0, 1}};
        for (int k = 0; k < FIBRAD_WALLS; k++) p.wall_temperature[k] = 500, p.wall_emissivity[k] = .1;
    }
    trace_and_solve(&p);
    ck_assert_uint_gt(p.heat->division.fours, 0);
    ck_assert_double_le(fabs(sum_of_powers(&p, &largest)), 1e-12 * largest);
    for (uint32_t i = 0; i < c->n; i++) {
        const double off = fabs(p.result.power[i] - c->truth[i]) - 2 * c->noise[i];
        ck_assert_double_le(off, 5e-3 * fabs(c->truth[i]));
        ck_assert_double_le(off, 2 * error[i] + 1e-3 * fabs(c->truth[i]));
    }
    free_problem(&p);
}
END_TEST

/* The same after a move from apart, and back: fine patches come and go. */
START_TEST(fine_patches_come_and_go_with_a_move) {
    static const double near[2][4] = {{0, 0, 0, .3}, {.315015, 0, 0, .015}},
                        far[2][4] = {{0, 0, 0, .3}, {1, 0, 0, .015}};
    struct problem p = problem_of(bed_of(2, near), 1, .3), q = problem_of(bed_of(2, far), 1, .3);
    p.temperature[1] = q.temperature[1] = 2;
    p.sources.tolerance = q.sources.tolerance = 1e-9;
    trace_and_solve(&p), trace_and_solve(&q);
    ck_assert_uint_eq(q.heat->division.fours, 0);
    const double power[2] = {p.result.power[1], q.result.power[1]};
    ck_assert_int_eq(fibrad_heat_move(p.heat, q.scene), FIBRAD_OK);
    trace_beams(&p), solve(&p);
    assert_near(p.result.power[1], power[1], 1e-8);
    ck_assert_int_eq(fibrad_heat_move(p.heat, p.scene), FIBRAD_OK);
    trace_beams(&p), solve(&p);
    assert_near(p.result.power[1], power[0], 1e-8);
    ck_assert_int_eq(fibrad_heat_move(q.heat, p.scene), FIBRAD_E_SIZE);
    free_problem(&p), free_problem(&q);
}
END_TEST

/* Parts have as many spheres as each other, to one, and near each other: in a bed of a thousand few pencils, of which
 * links are kept, go from part to part. More parts than spheres leave some empty. */
START_TEST(parts_are_compact_and_even) {
    for (uint32_t parts = 1; parts <= 64; parts *= 8) {
        struct problem p = problem_of(packing(1000, .5, 10, .5, 3, false), 1, 1);
        p.config.directions = 8, p.config.parts = parts;
        trace(&p);
        const fibrad_heat *heat = p.heat;
        uint32_t count[64] = {0}, seen[1000] = {0}, pencils = 0;
        for (uint32_t k = 0; k < p.bed.n; k++) {
            count[heat->part[k]]++, seen[heat->sequence[k]]++;
        }
        for (uint32_t k = 0; k < heat->rows; k++) {
            const unsigned char *at = heat->pencils.pool + heat->pencils.row[k].begin,
                                *end = at + heat->pencils.row[k].bytes;
            for (; at < end; at += fibrad_heat_pencil_bytes(fibrad_heat_pencil_at(at))) pencils++;
        }
        for (uint32_t k = 0; k < p.bed.n; k++) ck_assert_uint_eq(seen[k], 1);
        for (uint32_t k = 0; k < parts; k++) ck_assert(count[k] == p.bed.n / parts || count[k] == p.bed.n / parts + 1);
        ck_assert_uint_le(heat->pencils.links, parts == 1 ? 0 : parts == 8 ? pencils / 2 : pencils);
        free_problem(&p);
    }
}
END_TEST

/* Beams leave and meet a sphere at the patch that is there: the places that they leave are about as many in each patch;
 * all of a patch, and those that they meet, lie within 20 degrees of their mean. Those kept are some of those followed,
 * and stand for all; bundles have as many as their strands. */
START_TEST(a_patch_of_a_sphere_is_one_place) {
    struct problem p = problem_of(packing(12, .5, 1.5, .5, 7, false), 1, 1);
    trace(&p);
    const fibrad_heat *heat = p.heat;
    const uint32_t points = heat->config.points;
    double mean[96][3] = {{0}}, o[3], w[3], n[3], leaving = 1;
    uint32_t beams[96] = {0}, kept = 0, missed = 0;
    ck_assert_uint_eq(heat->config.patches, 96);
    for (uint32_t b = 0; b < heat->beams; b++) {
        beam(&p, 0, b / points, b % points, o, w, n);
        for (int a = 0; a < 3; a++) mean[heat->leave[b]][a] += n[a];
        beams[heat->leave[b]]++;
    }
    for (int k = 0; k < 96; k++) assert_near(beams[k], heat->beams / 96., .3);
    for (uint32_t place = 0; place < p.bed.n; place++) {
        static struct strands strands[13];
        static uint32_t met[13][10752];
        uint32_t followed[13] = {0};
        memset(met, 0, sizeof met);
        for (uint32_t body = 0; body < 12; body++) strands_to(heat, place, body, &strands[body]);
        strands_to(heat, place, fibrad_heat_other(heat, fibrad_heat_open(heat)), &strands[12]);
        for (uint32_t b = 0; b < heat->beams; b++) {
            const uint32_t i = p.scene->order[place];
            beam(&p, i, b / points, b % points, o, w, n);
            least_of(&leaving, cosine_of(mean[heat->leave[b]], n));
            const uint32_t j = first_met(&p, i, o, w, n), body = j == UINT32_MAX ? 12 : p.scene->place[j];
            const struct strands *s = &strands[body];
            followed[body]++;
            for (uint32_t k = 0; k < s->count; k++)
                if (s->from[k] == heat->leave[b] && (body == 12 || cosine_of(mean[s->to[k]], n) > cos(PI / 9)))
                    met[body][k]++;
        }
        for (uint32_t body = 0; body <= 12; body++) {
            const struct strands *s = &strands[body];
            for (uint32_t k = 0; k < s->count; k++) missed += met[body][k] < s->beams[k];
            kept += s->sum;
            if (s->count > 0) ck_assert_double_eq_tol(s->share * s->sum, followed[body], 3);
        }
    }
    ck_assert_uint_gt(kept, p.bed.n * heat->beams / 4);
    ck_assert_uint_le(missed, 5); /* that graze a sphere: the kernel's points are floats */
    ck_assert_double_gt(leaving, cos(PI / 9));
    free_problem(&p);
}
END_TEST

/* The same of a cylinder's wall, and of rays that go there. Patches are even on the square that leans on its corners,
 * which makes them 2/pi to 4/pi of their mean as wide on the cylinder. */
START_TEST(a_patch_of_a_cylinder_is_one_place) {
    enum { TURNS = 2048, UPS = 128 };
    struct problem p = problem_of(bed_of(1, (const double[][4]){{.3, -.2, .4, 1e-4}}), 1, 1);
    p.walls = (struct walls){.planes = 48, .at = {0, 0, 0, 0, -.5, 1.5}, .cylinder = {.3, -.2, 1}};
    p.config.directions = 8;
    trace(&p);
    const fibrad_heat *heat = p.heat;
    const uint32_t body = fibrad_heat_body(heat, FIBRAD_CYLINDER), first = heat->first[body];
    const uint32_t patches = heat->first[body + 1] - first, *squares = heat->wall[FIBRAD_CYLINDER].squares;
    double(*mean)[4] = calloc(patches, sizeof *mean), turning = 1, rising = 0;
    uint32_t missed = 0;
    for (int round = 0; round < 2; round++)
        for (uint32_t k = 0; k < TURNS * UPS; k++) {
            const double turn = 2 * PI * (k / UPS + .5) / TURNS, up = (k % UPS + .5) / UPS;
            const double around[3] = {cos(turn), sin(turn), 0}, at[3] = {.3 + around[0], around[1] - .2, 2 * up - .5};
            const uint32_t patch = fibrad_heat_wall_patch(heat, FIBRAD_CYLINDER, at) - first;
            if (patch >= patches) ck_abort_msg("patch %u of %u", patch, patches);
            double *m = mean[patch];
            if (round == 0) {
                m[0] += around[0], m[1] += around[1], m[2] += up, m[3]++;
                continue;
            }
            least_of(&turning, cosine_of((double[]){m[0], m[1], 0}, around));
            worst_of(&rising, fabs(up - m[2] / m[3]));
            const double o[3] = {.3 - .4 * cos(k), .4 * sin(k) - .2, .5 + .9 * sin(3. * k)};
            double w[3] = {at[0] - o[0], at[1] - o[1], at[2] - o[2]};
            const double length = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
            for (int a = 0; a < 3; a++) w[a] /= length;
            missed += fibrad_heat_leaves(heat, o, w) != first + patch;
        }
    for (uint32_t k = 0; k < patches; k++) {
        ck_assert_double_gt(mean[k][3] / (TURNS * UPS) * patches, .8 * 2 / PI);
        ck_assert_double_lt(mean[k][3] / (TURNS * UPS) * patches, 1.2 * 4 / PI);
    }
    ck_assert_double_gt(turning, cos(1.05 * 4 / squares[0]));
    ck_assert_double_lt(rising, .5 / squares[1]);
    ck_assert_uint_eq(missed, 0);
    free(mean);
    free_problem(&p);
}
END_TEST

/* ---- conduction ---- */

/* k_rad/(4 sigma T^3 d) of a periodic bed along z, from the powers at emissions 2 + cos kz, k such that `waves` waves
 * fit into the box. */
static double conduction(struct problem *p, int waves) {
    const struct bed *bed = &p->bed;
    const double k = 2 * PI * waves / bed->period[2], volume = bed->period[0] * bed->period[1] * bed->period[2];
    for (uint32_t i = 0; i < bed->n; i++) p->temperature[i] = sqrt(sqrt(2 + cos(k * bed->z[i])));
    solve(p);
    double sum = 0;
    for (uint32_t i = 0; i < bed->n; i++) sum -= p->result.power[i] * cos(k * bed->z[i]);
    return sum * 2 / (volume * 2 * bed->r[0] * k * k);
}

/* In an even gradient: what waves have less of it than that is a resistance that rises with the square of k. */
static double even_conduction(struct problem *p, double eps) {
    for (uint32_t i = 0; i < p->bed.n; i++) p->emissivity[i] = eps;
    return 3 / (4 / conduction(p, 1) - 1 / conduction(p, 2));
}

/* The lattice of scenes.h, 2 x 2 cells wide and `cells` long. */
static struct bed column(char kind, int cells) {
    static const double basis[4][3] = {{0, 0, 0}, {0, .5, .5}, {.5, 0, .5}, {.5, .5, 0}}, centre[3] = {.5, .5, .5};
    const double side = kind == 'p' ? 2 : kind == 'i' ? 4 / sqrt(3) : 2 * sqrt(2);
    const int sites = kind == 'p' ? 1 : kind == 'i' ? 2 : 4;
    struct bed bed;
    bed_init(&bed);
    for (int cell = 0; cell < 4 * cells; cell++)
        for (int s = 0; s < sites; s++) {
            const double *b = kind == 'i' && s == 1 ? centre : basis[s];
            add_sphere(&bed, (cell % 2 + b[0]) * side, (cell / 2 % 2 + b[1]) * side, (cell / 4 + b[2]) * side, 1);
        }
    bed.period[0] = bed.period[1] = 2 * side, bed.period[2] = cells * side;
    return bed;
}

/* Along the channels of the simple cubic lattice light goes so far that a value hangs on the length of the bed; at low
 * emissivity programs differ by 5 %. */
START_TEST(conduction_of_lattices) {
    static const struct {
        char kind;
        int cells;
        double known[5], bar;
    } lattices[] = {{'p', 24, {.354, .527, .715, .929, 1.187}, .04},
                    {'i', 16, {.196, .336, .498, .688, .916}, .02},
                    {'f', 12, {.162, .299, .458, .646, .875}, .02}};
    struct problem p = problem_of(column(lattices[_i].kind, lattices[_i].cells), 1, 1);
    trace(&p);
    for (int k = 0; k < 5; k++) assert_near(even_conduction(&p, .2 * (k + 1)), lattices[_i].known[k], lattices[_i].bar);
    free_problem(&p);
}
END_TEST

/* A small random bed conducts a few per cent more or less than a large one, but alike at all emissivities. */
START_TEST(conduction_of_a_random_bed) {
    static const double known[][2] = {{.2, .276}, {.4, .433}, {.6, .610}, {.8, .815}};
    struct bed one = packing(120, 1, 1, .586, 2, true), bed;
    bed_init(&bed);
    ck_assert_int_eq(bed_make_copies(&bed, &one, (uint32_t[]){1, 1, 3}), 0);
    bed_free(&one);
    struct problem p = problem_of(bed, 1, 1);
    trace(&p);
    const double black = even_conduction(&p, 1);
    assert_near(black, 1.061, .05);
    for (size_t k = 0; k < 4; k++) assert_near(even_conduction(&p, known[k][0]) / black, known[k][1] / 1.061, .02);
    /* one radiosity per sphere conducts as if all were black */
    p.sources.uniform = 1;
    assert_near(even_conduction(&p, .2), black, .03);
    free_problem(&p);
}
END_TEST

/* ---- balances ---- */

START_TEST(powers_add_up_to_zero) {
    struct problem p = problem_of(packing(150, .4, 1.6, .5, 9, false), 1, .5);
    for (uint32_t i = 0; i < p.bed.n; i++)
        p.temperature[i] = 300 + 700 * bed_make_random(1, i), p.emissivity[i] = bed_make_random(2, i);
    p.walls = box_about(&p.bed);
    p.walls.planes = (uint32_t)_i; /* some of the walls, one or two of them without end */
    p.walls.open = openings_of(p.walls.planes);
    p.config.directions = 30;
    for (int k = 0; k < FIBRAD_WALLS; k++) p.wall_temperature[k] = 400 + 100 * k, p.wall_emissivity[k] = .15 * k;
    p.sources.surroundings = 350;
    p.sources.sigma = FIBRAD_STEFAN_BOLTZMANN;
    trace(&p);
    for (int uniform = 0; uniform < 2; uniform++) {
        double largest;
        p.sources.uniform = uniform;
        solve(&p);
        ck_assert_double_le(fabs(sum_of_powers(&p, &largest)), 1e-12 * largest);
    }
    free_problem(&p);
}
END_TEST

/* ---- what must not matter ---- */

static void assert_same_bits(const struct problem *p, const struct problem *q) {
    ck_assert_int_eq(memcmp(p->result.power, q->result.power, p->bed.n * sizeof(double)), 0);
    ck_assert_int_eq(memcmp(p->wall_power, q->wall_power, sizeof p->wall_power), 0);
    ck_assert_int_eq(memcmp(&p->result.surroundings_power, &q->result.surroundings_power, sizeof(double)), 0);
    ck_assert_int_eq(memcmp(&p->result.error_beams, &q->result.error_beams, sizeof(double)), 0);
}

static struct problem small_problem(int isa, bool backwards, bool turned) {
    struct problem p = problem_of(packing(80, .3, 1, .5, 21, false), 1, .4);
    for (uint32_t i = 0; i < p.bed.n; i++) p.temperature[i] = 1 + bed_make_random(3, i);
    p.isa = isa, p.backwards = backwards, p.turned = turned;
    p.walls = box_about(&p.bed);
    p.walls.planes = 31, p.walls.open = 32;
    for (int k = 0; k < FIBRAD_WALLS; k++) p.wall_temperature[k] = 1, p.wall_emissivity[k] = .7;
    p.config = (fibrad_heat_config){.directions = 24, .points = 128, .parts = 5};
    trace_and_solve(&p);
    return p;
}

START_TEST(the_order_of_the_work_changes_no_bit) {
    struct problem p = small_problem(FIBRAD_ISA_BEST, false, false), q = small_problem(FIBRAD_ISA_BEST, true, false);
    assert_same_bits(&p, &q);
    free_problem(&p);
    free_problem(&q);
}
END_TEST

/* Walls listed from the last to the first are the same walls. */
START_TEST(the_order_of_bodies_changes_but_roundings) {
    struct problem p = small_problem(FIBRAD_ISA_BEST, false, false), q = small_problem(FIBRAD_ISA_BEST, false, true);
    double largest;
    (void)sum_of_powers(&p, &largest);
    ck_assert_uint_eq(p.bodies, 5);
    ck_assert_uint_eq(p.slot[0], q.slot[4]);
    for (uint32_t i = 0; i < p.bed.n; i++)
        ck_assert_double_eq_tol(p.result.power[i], q.result.power[i], 1e-12 * largest);
    for (int k = 0; k < FIBRAD_WALLS; k++) ck_assert_double_eq_tol(p.wall_power[k], q.wall_power[k], 1e-12 * largest);
    ck_assert_double_eq_tol(p.result.surroundings_power, q.result.surroundings_power, 1e-12 * largest);
    free_problem(&p);
    free_problem(&q);
}
END_TEST

START_TEST(instruction_sets_change_no_bit) {
    struct problem p = small_problem(FIBRAD_ISA_SCALAR, false, false);
    int isa[ISAS_MOST];
    for (int k = isas_there(isa); k-- > 1;) {
        struct problem q = small_problem(isa[k], false, false);
        assert_same_bits(&p, &q);
        free_problem(&q);
    }
    free_problem(&p);
}
END_TEST

START_TEST(an_earlier_solution_saves_sweeps_and_changes_little) {
    struct problem p = problem_of(packing(100, 1, 1, .55, 5, true), 1, .3);
    p.config.directions = 40, p.sources.tolerance = 1e-6;
    for (uint32_t i = 0; i < p.bed.n; i++) p.temperature[i] = 1 + bed_make_random(3, i);
    trace_and_solve(&p);
    for (uint32_t i = 0; i < p.bed.n; i++) p.temperature[i] *= 1 + 1e-4 * bed_make_random(6, i);
    solve(&p);
    const uint32_t warm = p.result.sweeps;
    double *power = malloc(p.bed.n * sizeof *power), largest = 0;
    memcpy(power, p.result.power, p.bed.n * sizeof *power);
    free_heat(&p);
    trace_and_solve(&p);
    ck_assert_uint_lt(warm, p.result.sweeps * 3 / 4);
    for (uint32_t i = 0; i < p.bed.n; i++) worst_of(&largest, fabs(p.result.power[i]));
    for (uint32_t i = 0; i < p.bed.n; i++) ck_assert_double_eq_tol(power[i], p.result.power[i], 1e-5 * largest);
    free(power);
    free_problem(&p);
}
END_TEST

/* A periodic bed as a whole, by a third of the box: the same bed, but its spheres come in another order along the
 * cells. What is carried over goes with the spheres, so that next to nothing is left to do. */
START_TEST(an_earlier_solution_goes_with_the_spheres) {
    struct problem p = problem_of(packing(100, 1, 1, .55, 5, true), 1, .3);
    p.config.directions = 40, p.sources.tolerance = 1e-6;
    for (uint32_t i = 0; i < p.bed.n; i++) p.temperature[i] = 1 + bed_make_random(3, i);
    trace_and_solve(&p);
    const uint32_t cold = p.result.sweeps;
    fibrad_scene *const before = p.scene;
    double power[100], largest = 0;
    memcpy(power, p.result.power, sizeof power);
    for (uint32_t i = 0; i < p.bed.n; i++) {
        p.bed.x[i] = fmod(p.bed.x[i] + p.bed.period[0] / 3, p.bed.period[0]);
        p.bed.z[i] = fmod(p.bed.z[i] + p.bed.period[2] / 3, p.bed.period[2]);
        worst_of(&largest, fabs(power[i]));
    }
    build_scene(&p);
    uint32_t others = 0;
    for (uint32_t k = 0; k < p.bed.n; k++) others += fibrad_scene_sphere(before, k) != fibrad_scene_sphere(p.scene, k);
    ck_assert_uint_gt(others, 50);
    ck_assert_int_eq(fibrad_heat_move(p.heat, p.scene), FIBRAD_OK);
    trace_beams(&p);
    solve(&p);
    for (uint32_t i = 0; i < p.bed.n; i++) ck_assert_double_eq_tol(power[i], p.result.power[i], 1e-5 * largest);
    ck_assert_uint_lt(p.result.sweeps, cold / 2);
    free(before);
    free_problem(&p);
}
END_TEST

START_TEST(the_error_is_as_estimated) {
    double truth[100], each[100], *power = NULL;
    for (int k = 0; k < 3; k++) {
        static const fibrad_heat_config configs[] = {
            {.directions = 600, .patches = 384}, {.directions = 72, .patches = 96}, {.directions = 144, .patches = 24}};
        struct problem p = problem_of(packing(100, 1, 1, .55, 5, true), 1, .4);
        for (uint32_t i = 0; i < p.bed.n; i++) p.temperature[i] = 1 + bed_make_random(3, i);
        p.config = configs[k];
        p.result.power_error = each;
        trace_and_solve(&p);
        power = p.result.power;
        double square = 0, squares = 0;
        uint32_t low = 0;
        for (uint32_t i = 0; i < p.bed.n; i++) squares += each[i] * each[i] / p.bed.n;
        assert_near(hypot(p.result.error_patches, p.result.error_beams), sqrt(squares), 1e-12);
        for (uint32_t i = 0; i < p.bed.n && k > 0; i++) low += fabs(power[i] - truth[i]) > 2 * each[i];
        ck_assert_uint_le(low, 5);
        for (uint32_t i = 0; i < p.bed.n; i++) square += (power[i] - truth[i]) * (power[i] - truth[i]) / p.bed.n;
        if (k == 0) memcpy(truth, power, sizeof truth);
        if (k > 0) {
            const double estimate = hypot(p.result.error_patches, p.result.error_beams);
            ck_assert_msg(sqrt(square) < 3 * estimate && sqrt(square) > estimate / 5, "%g, estimated %g", sqrt(square),
                          estimate);
        }
        free_problem(&p);
    }
}
END_TEST

/* ---- one radiosity per sphere ---- */

/* Powers from view factors, each sphere of one radiosity, by going round until nothing changes. */
static void radiosities_by_hand(const struct problem *p, const fibrad_factors *m, double *power) {
    const double e0 = emission(p->sources.surroundings);
    double *radiosity = calloc(m->n, sizeof *radiosity), change = 1;
    for (int round = 0; round < 500 && !(change < 1e-14); round++) {
        change = 0;
        for (uint32_t i = 0; i < m->n; i++) {
            const double eps = p->emissivity[i];
            double incident = e0;
            for (uint64_t k = m->start[i]; k < m->start[i + 1]; k++) incident += m->f[k] * (radiosity[m->col[k]] - e0);
            const double next = eps * emission(p->temperature[i]) + (1 - eps) * incident;
            worst_of(&change, fabs(next - radiosity[i]));
            radiosity[i] = next;
            power[i] = (incident - next) * sphere_area(&p->bed, i);
        }
    }
    ck_assert_double_lt(change, 1e-14);
    free(radiosity);
}

START_TEST(one_radiosity_per_sphere) {
    struct problem p = problem_of(packing(80, .6, 1, .5, 8, false), 1, 1);
    for (uint32_t i = 0; i < p.bed.n; i++) p.temperature[i] = 1 + bed_make_random(3, i);
    p.sources.surroundings = .5, p.sources.uniform = 1, p.config.directions = 400;
    trace(&p);
    struct matrix m = matrix_by_beams(p.scene, &(fibrad_beam_rule){.directions = 400}, false);
    double *power = malloc(p.bed.n * sizeof *power);
    for (int grey = 0; grey < 2; grey++) {
        double sum, size = 0, difference = 0;
        for (uint32_t i = 0; i < p.bed.n; i++) p.emissivity[i] = grey ? .1 + .9 * bed_make_random(5, i) : 1;
        radiosities_by_hand(&p, &m.factors, power);
        solve(&p);
        sum = p.result.surroundings_power;
        for (uint32_t i = 0; i < p.bed.n; i++) {
            sum += p.result.power[i], size += power[i] * power[i];
            difference += (power[i] - p.result.power[i]) * (power[i] - p.result.power[i]);
        }
        ck_assert_double_le(fabs(sum), 1e-12 * sqrt(size));
        ck_assert_double_le(sqrt(difference / size), 5e-3); /* other quadrature, the same equations */
    }
    p.sources.surroundings = -1;
    ck_assert_int_eq(fibrad_heat_begin(p.heat, &p.sources), FIBRAD_E_ARGUMENT);
    matrix_free(&m);
    free(power);
    free_problem(&p);
}
END_TEST

/* ---- spheres that reflect all ---- */

/* Every third sphere reflects all. */
static struct problem reflecting(bool uniform) {
    struct problem p = problem_of(packing(60, .6, 1.2, .5, 8, false), 1, .6);
    for (uint32_t i = 0; i < p.bed.n; i++) {
        p.temperature[i] = 1 + bed_make_random(3, i);
        if (i % 3 == 0) p.emissivity[i] = 0, p.temperature[i] *= 20;
    }
    p.sources.surroundings = .5, p.sources.uniform = uniform;
    return p;
}

static void assert_adiabatic(const struct problem *p) {
    double largest;
    const double sum = sum_of_powers(p, &largest);
    ck_assert_double_le(fabs(sum), 1e-12 * fmax(largest, 1));
    for (uint32_t i = 0; i < p->bed.n; i++)
        if (p->emissivity[i] == 0) ck_assert_double_eq(p->result.power[i], 0);
    ck_assert(p->result.residual <= 1e-3 && p->result.error_patches >= 0 && p->result.error_beams >= 0);
}

/* Root mean square difference of powers, over their root mean square. */
static double difference_of_powers(const double *a, const double *b, uint32_t n) {
    double difference = 0, size = 0;
    for (uint32_t i = 0; i < n; i++) difference += (a[i] - b[i]) * (a[i] - b[i]), size += b[i] * b[i];
    return sqrt(difference / size);
}

/* Reflectors gain nothing, whatever their temperature, which changes no bit; all the same as at emissivity 1e-6. The
 * others' powers are those of paths, or of one radiosity each, that of a reflector being what arrives. */
START_TEST(reflectors_gain_nothing) {
    const bool uniform = _i == 1;
    struct problem p = reflecting(uniform);
    double *truth = calloc(p.bed.n, sizeof *truth), *first = calloc(p.bed.n, sizeof *first);
    p.config.directions = uniform ? 400 : 168;
    if (!uniform) p.walls = box_about(&p.bed);
    for (int k = 0; k < FIBRAD_WALLS; k++) p.wall_temperature[k] = .8 + .2 * k, p.wall_emissivity[k] = .3 * (k % 3);
    trace_and_solve(&p);
    assert_adiabatic(&p);
    if (uniform) {
        struct matrix m = matrix_by_beams(p.scene, &(fibrad_beam_rule){.directions = 400}, false);
        radiosities_by_hand(&p, &m.factors, truth);
        matrix_free(&m);
    } else {
        for (uint32_t i = 0; i < p.bed.n; i++) truth[i] = power_by_paths(&p, i, 20000);
    }
    ck_assert_double_lt(difference_of_powers(p.result.power, truth, p.bed.n), uniform ? 5e-3 : .015);

    memcpy(first, p.result.power, p.bed.n * sizeof *first);
    free_heat(&p);
    for (uint32_t i = 0; i < p.bed.n; i += 3) p.temperature[i] = i % 2 ? 0 : 1e3;
    trace_and_solve(&p);
    ck_assert_mem_eq(first, p.result.power, p.bed.n * sizeof *first);

    p.sources.tolerance = 1e-10;
    solve(&p);
    assert_adiabatic(&p);
    memcpy(first, p.result.power, p.bed.n * sizeof *first);
    for (uint32_t i = 0; i < p.bed.n; i += 3) p.temperature[i] = 1, p.emissivity[i] = 1e-6;
    solve(&p);
    ck_assert_double_lt(difference_of_powers(p.result.power, first, p.bed.n), 1e-5);
    ck_assert_double_gt(difference_of_powers(p.result.power, first, p.bed.n), 1e-9);
    free(truth), free(first);
    free_problem(&p);
}
END_TEST

/* A bed that reflects all, in the open and between walls that do so, too: nothing flows, and no time is lost; also
 * after a solution in which much flowed. */
START_TEST(all_reflect) {
    struct problem p = reflecting(_i % 2 == 1);
    if (_i / 2 == 1) p.walls = box_about(&p.bed);
    for (int k = 0; k < FIBRAD_WALLS; k++) p.wall_temperature[k] = 3, p.wall_emissivity[k] = 0;
    p.config.directions = 30;
    trace_and_solve(&p);
    assert_adiabatic(&p);
    double largest;
    (void)sum_of_powers(&p, &largest);
    ck_assert_double_gt(largest, 1);
    for (int warm = 1; warm >= 0; warm--) {
        for (uint32_t i = 0; i < p.bed.n; i++) p.emissivity[i] = 0;
        solve(&p);
        assert_adiabatic(&p);
        (void)sum_of_powers(&p, &largest);
        ck_assert_double_le(largest, warm ? 1e-9 : 0);
        ck_assert_uint_le(p.result.sweeps, warm ? 300 : 4);
        free_heat(&p);
        trace(&p);
    }
    free_problem(&p);
}
END_TEST

/* Two spheres that see each other and the surroundings: two equations, with the view factor that black ones have. */
START_TEST(two_radiosities) {
    static const double t[] = {1.8, .6}, eps[] = {.3, .8};
    struct problem p = problem_of(bed_of(2, (const double[][4]){{0, 0, 0, 1}, {0, 1.2, 1.6, .5}}), 1, 1);
    double area[2], f[2], exact;
    p.sources.uniform = 1, p.sources.tolerance = 1e-12;
    trace(&p);
    for (int i = 0; i < 2; i++) { /* areas and factors as beams have them */
        p.temperature[i] = 1, p.temperature[1 - i] = 0;
        solve(&p);
        area[i] = -p.result.power[i], f[i] = p.result.power[1 - i] / area[i];
        ck_assert_int_eq(fibrad_pair_exact(p.bed.r[i], p.bed.r[1 - i], .5, &exact), FIBRAD_OK);
        assert_near(area[i], sphere_area(&p.bed, (uint32_t)i), 2e-3);
        assert_near(f[i], exact, .02);
    }
    for (int i = 0; i < 2; i++) p.temperature[i] = t[i], p.emissivity[i] = eps[i];
    for (p.sources.surroundings = 0; p.sources.surroundings < 4; p.sources.surroundings += 1) {
        const double e0 = emission(p.sources.surroundings);
        double e[2];
        for (int i = 0; i < 2; i++) e[i] = eps[i] * emission(t[i]) + (1 - eps[i]) * (1 - f[i]) * e0;
        /* J_0 = e_0 + (1 - eps_0) f_0 J_1, and the same the other way round */
        const double a = (1 - eps[0]) * f[0], b = (1 - eps[1]) * f[1];
        const double j[] = {(e[0] + a * e[1]) / (1 - a * b), (e[1] + b * e[0]) / (1 - a * b)};
        solve(&p);
        for (int i = 0; i < 2; i++)
            assert_near(p.result.power[i], area[i] * (f[i] * j[1 - i] + (1 - f[i]) * e0 - j[i]), 1e-9);
        assert_near(p.result.surroundings_power, -p.result.power[0] - p.result.power[1], 1e-9);
    }
    free_problem(&p);
}
END_TEST

/* ---- arguments ---- */

START_TEST(arguments_are_checked) {
    struct problem p = problem_of(bed_of(2, (const double[][4]){{0, 0, 0, 1}, {3, 0, 0, 1}}), 1, .5);
    p.config = (fibrad_heat_config){.directions = 8};
    trace(&p);
    static const fibrad_heat_config bad[] = {{.directions = 7}, {.directions = 65537}, {.points = 65},  {.patches = 25},
                                             {.parts = 1025},   {.cutoff = -1},        {.cutoff = NAN}, {.cutoff = 5}};
    const size_t size = fibrad_heat_size(&p.config, p.scene);
    unsigned char *block = block_of(size + 128);
    fibrad_heat *heat = NULL;
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        ck_assert_uint_eq(fibrad_heat_size(&bad[k], p.scene), 0);
        ck_assert_int_eq(fibrad_heat_init(&heat, block, size, &bad[k], p.scene),
                         bad[k].cutoff > 0 ? FIBRAD_E_UNSUPPORTED : FIBRAD_E_ARGUMENT);
    }
    ck_assert_uint_eq(fibrad_heat_size(&p.config, NULL), 0);
    ck_assert_uint_gt(fibrad_heat_size(NULL, p.scene), size);
    ck_assert_uint_eq(fibrad_heat_tasks(NULL), 0);
    ck_assert_uint_eq(fibrad_heat_parts(NULL), 0);

    memset(block, 0x5a, size + 128);
    ck_assert_int_eq(fibrad_heat_init(&heat, block, size - 1, &p.config, p.scene), FIBRAD_E_SIZE);
    ck_assert_int_eq(fibrad_heat_init(&heat, NULL, size, &p.config, p.scene), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_heat_init(NULL, block, size, &p.config, p.scene), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_heat_init(&heat, block, size, &p.config, NULL), FIBRAD_E_ARGUMENT);
    for (size_t k = 0; k < size + 128; k++) ck_assert_int_eq(block[k], 0x5a);
    fibrad_work work = work_growing();
    solve(&p);
    double power[2];
    memcpy(power, p.result.power, sizeof power);
    fibrad_heat *const first = p.heat;
    for (size_t shift = 0; shift < 64; shift += 9) { /* any alignment, the same bits */
        memset(block, 0x5a, size + 128);
        ck_assert_int_eq(fibrad_heat_init(&heat, block + shift, size, &p.config, p.scene), FIBRAD_OK);
        ck_assert_int_eq(fibrad_heat_trace(NULL, &work, 0), FIBRAD_E_ARGUMENT);
        ck_assert_int_eq(fibrad_heat_trace(heat, &work, 2), FIBRAD_E_ARGUMENT);
        ck_assert_int_eq(fibrad_heat_trace(heat, NULL, 0), FIBRAD_E_ARGUMENT);
        for (uint32_t i = 0; i < 2; i++) ck_assert_int_eq(fibrad_heat_trace(heat, &work, i), FIBRAD_OK);
        ck_assert_int_eq(fibrad_heat_read(heat, &p.result), FIBRAD_E_STATE); /* unsolved */
        p.heat = heat;
        solve(&p);
        ck_assert_mem_eq(power, p.result.power, sizeof power);
        ck_assert_int_eq(fibrad_heat_read(heat, NULL), FIBRAD_E_ARGUMENT);
        ck_assert_int_eq(fibrad_heat_read(heat, &(fibrad_heat_result){0}), FIBRAD_E_ARGUMENT);
        ck_assert_int_eq(fibrad_heat_read(NULL, &p.result), FIBRAD_E_ARGUMENT);
        for (size_t k = 0; k < shift; k++) ck_assert_int_eq(block[k], 0x5a);
        for (size_t k = shift + size; k < size + 128; k++) ck_assert_int_eq(block[k], 0x5a);
    }

    const struct problem fine = p;
    p.temperature[1] = -1;
    ck_assert_int_eq(fibrad_heat_begin(heat, &p.sources), FIBRAD_E_ARGUMENT);
    p.temperature[1] = NAN;
    ck_assert_int_eq(fibrad_heat_begin(heat, &p.sources), FIBRAD_E_ARGUMENT);
    p.temperature[1] = 1, p.emissivity[0] = 1.5;
    ck_assert_int_eq(fibrad_heat_begin(heat, &p.sources), FIBRAD_E_ARGUMENT);
    p.emissivity[0] = .5, p.sources.sigma = 0;
    ck_assert_int_eq(fibrad_heat_begin(heat, &p.sources), FIBRAD_E_ARGUMENT);
    p.sources = fine.sources, p.sources.tolerance = 1;
    ck_assert_int_eq(fibrad_heat_begin(heat, &p.sources), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_heat_begin(heat, NULL), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_heat_begin(NULL, &fine.sources), FIBRAD_E_ARGUMENT);
    p.sources = fine.sources;
    solve(&p);
    ck_assert_double_eq_tol(p.result.power[0], power[0], 1e-3 * fabs(power[0])); /* warm */
    work_free(&work);
    free(block);
    p.heat = first;
    free_problem(&p);
}
END_TEST

/* Hardly any room in a bed: the call says so, and what it asks for is enough. */
START_TEST(work_memory_may_be_too_small) {
    struct problem p = problem_of(packing(100, 1, 1, .55, 5, true), 1, 1);
    p.config.directions = 8;
    trace(&p);
    ck_assert_int_eq(fibrad_heat_move(p.heat, p.scene), FIBRAD_OK);
    size_t size = 64;
    void *block = block_of(size);
    fibrad_work work = work_fixed(block, size);
    int status = fibrad_heat_trace(p.heat, &work, 0);
    ck_assert_int_eq(status, FIBRAD_E_WORK);
    for (int tries = 0; tries < 20 && status == FIBRAD_E_WORK; tries++) {
        ck_assert_uint_gt(work.memory.needed, size);
        size = work.memory.needed;
        free(block);
        block = block_of(size);
        work = work_fixed(block, size);
        status = fibrad_heat_trace(p.heat, &work, 0);
    }
    ck_assert_int_eq(status, FIBRAD_OK);
    free(block);
    free_problem(&p);
}
END_TEST

/* Bytes of the pool up to the last link. */
static size_t pool_end(const fibrad_heat *heat) {
    return (size_t)((const unsigned char *)(heat->pencils.link + heat->pencils.links) - heat->pencils.pool);
}

/* Traces all spheres again, until there is no room. */
static int trace_again(struct problem *p) {
    fibrad_work work = work_growing();
    int status = fibrad_heat_move(p->heat, p->scene);
    for (uint32_t task = 0; task < p->bed.n && status == FIBRAD_OK; task++)
        status = fibrad_heat_trace(p->heat, &work, task);
    work_free(&work);
    return status;
}

/* Links begin on a boundary behind the pencils: room for both without the gap is too small, and nothing is written
 * behind it; room up to the last link, in whole alignments, suffices. */
START_TEST(nothing_is_written_behind_the_room_for_beams) {
    for (uint32_t directions = 8; directions < 12; directions++) {
        struct problem p = problem_of(packing(30, 1, 1, .55, 5, true), 1, .5);
        p.config.directions = directions;
        trace_and_solve(&p);
        const size_t all = p.heat->pencils.room, end = pool_end(p.heat);
        const size_t sum = p.heat->pencils.used + p.heat->pencils.links * sizeof(fibrad_heat_link);
        ck_assert_uint_lt(sum, end);
        for (int last = 0; last <= 2; last++) {
            p.heat->pencils.room = last == 0 ? sum : last == 1 ? end - 1 : (end + 63) / 64 * 64;
            memset(p.heat->pencils.pool + p.heat->pencils.room, 0x5a, all - p.heat->pencils.room);
            ck_assert_int_eq(trace_again(&p), last < 2 ? FIBRAD_E_SIZE : FIBRAD_OK);
            if (last == 2) solve(&p);
            for (size_t k = p.heat->pencils.room; k < all; k++) ck_assert_uint_eq(p.heat->pencils.pool[k], 0x5a);
        }
        free_problem(&p);
    }
}
END_TEST

/* The room for beams is what the block has: too little of it is told by the tasks that find none; more than enough
 * changes no bit. */
START_TEST(the_room_for_beams_may_be_too_small) {
    struct problem p = problem_of(packing(100, 1, 1, .55, 5, true), 1, .5);
    double power[2][100];
    p.temperature[0] = 2, p.config.directions = 24;
    build_scene(&p);
    const size_t size = fibrad_heat_size(&p.config, p.scene);
    for (size_t times = 1; times <= 2; times++) {
        ck_assert_int_eq(fibrad_heat_init(&p.heat, block_of(times * size), times * size, &p.config, p.scene),
                         FIBRAD_OK);
        trace_beams(&p);
        solve(&p);
        memcpy(power[times - 1], p.result.power, sizeof power[0]);
        ck_assert_uint_le(pool_end(p.heat), p.heat->pencils.room);
        if (times == 1) free(p.heat);
    }
    ck_assert_mem_eq(power[0], power[1], sizeof power[0]);

    p.heat->pencils.room = pool_end(p.heat) - 1000;
    ck_assert_int_eq(trace_again(&p), FIBRAD_E_SIZE);
    ck_assert_int_eq(fibrad_heat_begin(p.heat, &p.sources), FIBRAD_E_STATE);
    free_problem(&p);
}
END_TEST

int main(void) {
    Suite *suite = suite_create("heat");
    TCase *closed = suite_case(suite, "closed forms"), *paths = suite_case(suite, "paths");
    tcase_add_test(closed, nothing_flows_in_a_closed_box_at_one_temperature);
    tcase_add_test(closed, nothing_flows_in_a_periodic_bed_at_one_temperature);
    tcase_add_test(closed, a_grey_sphere_in_black_surroundings);
    tcase_add_test(closed, a_grey_sphere_in_a_large_grey_box);
    tcase_add_test(closed, two_parallel_grey_walls);
    tcase_add_test(closed, a_black_sphere_touches_a_black_plane);
    tcase_add_test(closed, a_mote_between_endless_walls);
    tcase_add_test(closed, a_pair_of_endless_plates);
    tcase_add_test(closed, a_mote_between_periodic_plates);
    tcase_add_test(closed, white_walls_take_nothing);
    tcase_add_test(closed, view_factors_between_the_walls_of_a_cube);
    tcase_add_test(closed, walls_exchange_better_with_more_beams);
    tcase_add_test(closed, walls_know_their_errors);
    tcase_add_test(closed, view_factors_between_the_walls_of_a_cylinder);
    tcase_add_test(closed, walls_alone);
    tcase_add_test(closed, two_black_spheres_in_contact);
    tcase_add_test(closed, one_radiosity_per_sphere);
    tcase_add_test(closed, two_radiosities);
    tcase_add_loop_test(closed, reflectors_gain_nothing, 0, 2);
    tcase_add_loop_test(closed, all_reflect, 0, 4);
    tcase_add_loop_test(paths, powers_are_those_of_paths, 0, 3);
    tcase_add_loop_test(paths, powers_in_open_containers_are_those_of_paths, 0, 3);
    tcase_add_test(paths, powers_beside_the_wall_of_a_cylinder);
    TCase *patches = suite_case(suite, "patches");
    tcase_add_test(patches, parts_are_compact_and_even);
    tcase_add_loop_test(patches, a_small_sphere_and_the_spot_under_it, 0, sizeof spot_cases / sizeof *spot_cases);
    tcase_add_test(patches, fine_patches_come_and_go_with_a_move);
    tcase_add_test(patches, a_patch_of_a_sphere_is_one_place);
    tcase_add_test(patches, a_patch_of_a_cylinder_is_one_place);
    TCase *conducting = suite_case(suite, "conduction");
    tcase_add_loop_test(conducting, conduction_of_lattices, 0, 3);
    tcase_add_test(conducting, conduction_of_a_random_bed);
    TCase *bits = suite_case(suite, "bits");
    tcase_add_loop_test(bits, powers_add_up_to_zero, 0, 64);
    tcase_add_test(bits, an_opening_is_a_black_plane_as_hot_as_the_surroundings);
    tcase_add_test(bits, the_order_of_the_work_changes_no_bit);
    tcase_add_test(bits, the_order_of_bodies_changes_but_roundings);
    tcase_add_test(bits, instruction_sets_change_no_bit);
    tcase_add_test(bits, an_earlier_solution_saves_sweeps_and_changes_little);
    tcase_add_test(bits, an_earlier_solution_goes_with_the_spheres);
    tcase_add_test(bits, the_error_is_as_estimated);
    TCase *arguments = suite_case(suite, "arguments");
    tcase_add_test(arguments, arguments_are_checked);
    tcase_add_test(arguments, work_memory_may_be_too_small);
    tcase_add_test(arguments, the_room_for_beams_may_be_too_small);
    tcase_add_test(arguments, nothing_is_written_behind_the_room_for_beams);
    return suite_run(suite);
}
