/* test_heat_mesh.c - net powers among triangles: against planes in their place, against closed forms, and against
 * themselves under settings that must not matter. SPDX-License-Identifier: MIT */
#include "heat_runs.h"
#include "mesh/mesh.h"
#include "scene/scene.h"
#include "meshes.h"
#include "suite.h"

#define MOST 16 /* walls */

/* Adds a parallelogram, cut into cells of two triangles. From where it is seen, a to b goes counter-clockwise. */
static void add_sheet(struct mesh *mesh, const double origin[3], const double a[3], const double b[3], uint32_t cells,
                      uint32_t front, uint32_t back) {
    const uint32_t first = mesh->triangles.vertices, wide = cells + 1;
    for (uint32_t k = 0; k < wide * wide; k++) {
        const double i = (double)(k % wide) / cells, j = (double)(k / wide) / cells;
        mesh_vertex(mesh, origin[0] + a[0] * i + b[0] * j, origin[1] + a[1] * i + b[1] * j,
                    origin[2] + a[2] * i + b[2] * j);
    }
    for (uint32_t k = 0; k < cells * cells; k++) {
        const uint32_t v = first + k / cells * wide + k % cells;
        mesh_quad(mesh, (const uint32_t[]){v, v + 1, v + wide + 1, v + wide}, front, back);
    }
}

/* Adds the six faces of a box seen from within, as walls 0 to 5 or all as wall 0. */
static void add_box(struct mesh *mesh, double low, double high, uint32_t cells, bool one) {
    const double size = high - low;
    for (uint32_t axis = 0; axis < 3; axis++)
        for (uint32_t upper = 0; upper < 2; upper++) {
            double origin[3] = {low, low, low}, a[3] = {0}, b[3] = {0};
            if (upper) origin[axis] = high;
            a[(axis + 1 + upper) % 3] = size, b[(axis + 2 - upper) % 3] = size;
            add_sheet(mesh, origin, a, b, cells, one ? 0 : 2 * axis + upper, FIBRAD_NO_WALL);
        }
}

/* A bed, the walls about it, and the results. */
struct problem {
    struct bed bed;
    struct mesh *mesh;
    fibrad_wall wall[MOST];
    uint32_t walls;
    fibrad_plane opening;
    uint32_t openings;
    double temperature[64], emissivity[64], wall_temperature[MOST], wall_emissivity[MOST], wall_power[MOST];
    double power[64], q[MOST], error[64], q_error[MOST], found[MOST], absorbed[MOST];
    unsigned char insulated[MOST];
    fibrad_heat_config config;
    fibrad_heat_sources sources;
    fibrad_scene *scene;
    fibrad_heat *heat;
    fibrad_heat_result result;
    uint32_t seen; /* a triangle whose back was seen */
    bool backwards;
    int isa;
};

static struct problem *problem_of(struct bed bed, double temperature, double emissivity) {
    struct problem *p = calloc(1, sizeof *p);
    ck_assert_ptr_nonnull(p);
    ck_assert_uint_le(bed.n, 64);
    p->bed = bed;
    p->mesh = mesh_new();
    for (uint32_t i = 0; i < bed.n; i++) p->temperature[i] = temperature, p->emissivity[i] = emissivity;
    for (int b = 0; b < MOST; b++)
        p->wall[b].kind = FIBRAD_WALL_MESH, p->wall_emissivity[b] = 1, p->wall_power[b] = NAN;
    fibrad_heat_sources_init(&p->sources);
    p->sources.sigma = 1, p->sources.surroundings = 0;
    p->sources.temperature = p->temperature, p->sources.emissivity = p->emissivity;
    p->sources.wall_temperature = p->wall_temperature, p->sources.wall_emissivity = p->wall_emissivity;
    p->sources.wall_power = p->wall_power, p->sources.insulated = p->insulated;
    p->result.power = p->power, p->result.wall_power = p->q;
    p->result.power_error = p->error, p->result.wall_error = p->q_error;
    p->result.wall_temperature = p->found, p->result.wall_absorbed = p->absorbed;
    return p;
}

static void free_heat(struct problem *p) {
    free(p->scene);
    free(p->heat);
    p->scene = NULL, p->heat = NULL;
}

static void end_problem(struct problem **owned) {
    struct problem *p = *owned;
    free_heat(p);
    bed_free(&p->bed);
    free(p->mesh);
    free(p);
}

/* Before a problem that ends with its block. */
#define ENDED OWNED_BY(end_problem)

static fibrad_scene *build_scene(const struct problem *p) {
    return scene_with(&p->bed, &(fibrad_scene_config){.isa = p->isa,
                                                      .wall = p->wall,
                                                      .walls = p->walls,
                                                      .opening = &p->opening,
                                                      .openings = p->openings,
                                                      .triangles = &p->mesh->triangles});
}

static int trace_beams(struct problem *p) {
    OWNED_WORK work = work_growing();
    const int status = heat_trace(p->heat, &work, p->backwards);
    p->seen = work.triangle;
    return status;
}

static int trace(struct problem *p) {
    p->scene = build_scene(p);
    const size_t size = fibrad_heat_size(&p->config, p->scene);
    ck_assert_uint_gt(size, 0);
    assert_ok(fibrad_heat_init(&p->heat, block_of(size), size, &p->config, p->scene));
    return trace_beams(p);
}

static void solve(struct problem *p) { heat_solve(p->heat, &p->sources, &p->result, p->backwards); }

static void trace_and_solve(struct problem *p) {
    assert_ok(trace(p));
    solve(p);
}

/* The sum of all powers, over the largest one. */
static double imbalance(const struct problem *p) {
    double sum = p->result.surroundings_power, largest = fabs(sum);
    for (uint32_t b = 0; b < p->walls; b++) sum += p->q[b], worst_of(&largest, fabs(p->q[b]));
    for (uint32_t i = 0; i < p->bed.n; i++) sum += p->power[i], worst_of(&largest, fabs(p->power[i]));
    return fabs(sum) / largest;
}

static void make_planes(struct problem *p, double low, double high) {
    p->walls = 6;
    for (int k = 0; k < 6; k++) p->wall[k] = plane_at(k / 2, k % 2, k % 2 ? high : low);
}

static void make_box(struct problem *p, double low, double high, uint32_t cells) {
    p->walls = 6;
    add_box(p->mesh, low, high, cells, false);
}

/* Makes thirty unequal spheres that do not touch. They lie within the unit cube, .03 from its sides. */
static struct bed thirty_spheres(void) {
    struct bed bed = bed_empty();
    for (uint64_t at = 0; bed.n < 30; at += 4) {
        const double r = bed.n < 5 ? .18 : .05 + .05 * bed_make_random(4, at);
        double c[3];
        bool fits = true;
        for (uint64_t axis = 0; axis < 3; axis++) c[axis] = .03 + r + (.94 - 2 * r) * bed_make_random(4, at + 1 + axis);
        for (uint32_t j = 0; j < bed.n && fits; j++)
            fits = hypot(hypot(c[0] - bed.x[j], c[1] - bed.y[j]), c[2] - bed.z[j]) > r + bed.r[j];
        if (fits) add_sphere(&bed, c[0], c[1], c[2], r);
    }
    return bed;
}

/* Gives them and the walls about them many temperatures and emissivities. */
static struct problem *thirty(void) {
    struct problem *p = problem_of(thirty_spheres(), 1, .5);
    for (uint32_t i = 0; i < 30; i++)
        p->temperature[i] = 1 + bed_make_random(5, i), p->emissivity[i] = .2 + .7 * bed_make_random(6, i);
    for (int b = 0; b < 6; b++) p->wall_temperature[b] = .5 + .4 * ((b * 5) % 6), p->wall_emissivity[b] = .3 + .1 * b;
    return p;
}

/* ---- against other walls, and closed forms ---- */

TEST(a_box_of_twelve_triangles_is_a_box_of_planes) {
    ENDED struct problem *planes = thirty();
    planes->config = (fibrad_heat_config){.directions = 700, .patches = 384, .wall_rays = 300000};
    make_planes(planes, 0, 1);
    trace_and_solve(planes);
    for (uint32_t cells = 1; cells <= 12; cells += 11) {
        ENDED struct problem *mesh = thirty();
        mesh->config = planes->config;
        make_box(mesh, 0, 1, cells);
        trace_and_solve(mesh);
        const double spheres = difference_of(mesh->power, planes->power, 30),
                     walls = difference_of(mesh->q, planes->q, 6);
        ck_assert_double_le(spheres, 3e-3);
        ck_assert_double_le(walls, 3e-3);
        ck_assert_double_le(imbalance(mesh), 1e-12);
        ck_assert(mesh->result.surroundings_power == 0);
    }
}

/* A cup is made from five planes and an opening, or from five sheets of triangles without a lid. Some walls are hot,
 * others are insulated. */
TEST(a_cup_of_triangles_is_one_of_planes_and_an_opening) {
    struct problem *p[2] = {thirty(), thirty()};
    for (int k = 0; k < 2; k++) {
        p[k]->config = (fibrad_heat_config){.directions = 2000, .wall_rays = 1000000};
        if (k == 0) make_planes(p[k], 0, 1), p[k]->opening = (fibrad_plane){2, 1, 1}, p[k]->openings = 1;
        if (k == 1) make_box(p[k], 0, 1, 1), p[k]->mesh->triangles.n -= 2; /* its lid */
        p[k]->walls = 5, p[k]->bed.n = 8;
        p[k]->sources.surroundings = .8;
        for (int b = 0; b < 5; b++) p[k]->wall_temperature[b] = 2.5, p[k]->wall_emissivity[b] = .6;
        assert_ok(trace(p[k]));
    }
    for (int insulated = 0; insulated < 2; insulated++) {
        for (int k = 0; k < 2; k++) {
            for (int b = 0; b < 4; b++) p[k]->insulated[b] = (unsigned char)insulated;
            solve(p[k]);
            ck_assert_double_le(imbalance(p[k]), 1e-12);
        }
        ck_assert_double_gt(p[0]->result.surroundings_power, 5);
        assert_near(p[0]->result.surroundings_power, p[1]->result.surroundings_power, 2e-3);
        for (int b = 0; b < 5; b++) assert_near(p[0]->q[b], p[1]->q[b], 2e-3);
        ck_assert_double_le(difference_of(p[0]->power, p[1]->power, 8), 2e-3);
    }
    end_problem(&p[0]), end_problem(&p[1]);
}

TEST(a_grey_sphere_in_a_black_cube) {
    for (uint32_t cells = 1; cells <= 16; cells *= 4) {
        ENDED struct problem *p = problem_of(BED({.1, .2, .3, 1}), 2, .5);
        p->walls = 1, p->wall_temperature[0] = 1;
        add_box(p->mesh, -2, 2, cells, true);
        trace_and_solve(p);
        assert_near(p->power[0], .5 * 4 * PI * (1 - 16), 2e-3);
        assert_near(p->q[0], -p->power[0], 1e-12);
    }
}

/* The power between a sphere and the walls of a large box, which are lit evenly enough, is that between concentric
 * spheres. */
TEST(a_grey_sphere_in_a_large_grey_cube) {
    ENDED struct problem *p = problem_of(BED({.1, .2, .3, 1}), 2, .3);
    p->walls = 1, p->wall_temperature[0] = 1, p->wall_emissivity[0] = .05;
    add_box(p->mesh, -20, 20, 1, true);
    trace_and_solve(p);
    assert_near(p->power[0], 4 * PI * (1 - 16) / (1 / .3 + 4 * PI / 9600 * (1 / .05 - 1)), 2e-3);
}

TEST(nothing_flows_at_one_temperature) {
    ENDED struct problem *p = thirty();
    make_box(p, 0, 1, 3);
    for (uint32_t i = 0; i < 30; i++) p->temperature[i] = 3;
    for (int b = 0; b < 6; b++) p->wall_temperature[b] = 3, p->wall_emissivity[b] = .2 * b;
    trace_and_solve(p);
    for (uint32_t i = 0; i < 30; i++) ck_assert_double_le(fabs(p->power[i]), 1e-10);
    for (int b = 0; b < 6; b++) ck_assert_double_le(fabs(p->q[b]), 1e-9);
    p->temperature[7] = 5, p->wall_temperature[3] = 1;
    solve(p);
    ck_assert_double_gt(fabs(p->power[7]), 1);
    ck_assert_double_le(imbalance(p), 1e-12);
}

/* Makes two endless plates, of which the upper one consists of triangles or is a plane. Between them may be a shield: a
 * sheet that has two sides and gives off nothing. */
static struct problem *plates(bool planes, uint32_t cells, bool shield) {
    struct problem *p = problem_of(BED({.2, .3, .5, 1e-4}), 1, .5);
    const double low[3] = {0, 0, 0}, middle[3] = {0, 0, 1. / 3}, high[3] = {0, 0, 1}, a[3] = {2, 0, 0},
                 b[3] = {0, 2, 0};
    p->bed.period[0] = p->bed.period[1] = 2;
    p->walls = 2 + shield;
    add_sheet(p->mesh, low, a, b, cells, 0, FIBRAD_NO_WALL);
    if (planes)
        p->wall[1] = plane_at(2, 1, 1);
    else
        add_sheet(p->mesh, high, b, a, cells, 1, FIBRAD_NO_WALL);
    if (shield) add_sheet(p->mesh, middle, a, b, cells, 2, 2);
    p->wall_temperature[0] = 3, p->wall_emissivity[0] = .3;
    p->wall_temperature[1] = 2, p->wall_emissivity[1] = .6;
    p->wall_temperature[2] = NAN, p->wall_power[2] = 0, p->wall_emissivity[2] = .2;
    return p;
}

TEST(two_plates_and_a_shield) {
    for (int planes = 0; planes < 2; planes++)
        for (uint32_t cells = 1; cells <= 5; cells += 4) {
            ENDED struct problem *plain = plates(planes == 1, cells, false), *p = plates(planes == 1, cells, true);
            trace_and_solve(plain);
            assert_near(plain->q[1], 4 * (81 - 16) / (1 / .3 + 1 / .6 - 1), 1e-3);
            ck_assert_double_le(plain->result.surroundings_power,
                                2e-4 * plain->q[1]); /* this escapes beyond where rays are followed */
            trace_and_solve(p);
            const double below = 1 / .3 + 1 / .2 - 1, above = 1 / .6 + 1 / .2 - 1;
            assert_near(p->q[1], 4 * (81 - 16) / (below + above), 2e-3);
            assert_near(pow(p->found[2], 4), 81 - (81 - 16) * below / (below + above), 1e-3);
            ck_assert_double_le(fabs(p->q[2]), 1e-12);
            ck_assert_double_le(imbalance(p), 1e-12);
        }
}

/* The patches of an insulated sheet, which is one wall, have temperatures of their own: they send back what they
 * get. */
TEST(an_insulated_sheet_lets_nothing_through) {
    ENDED struct problem *p = plates(false, 2, true);
    p->insulated[2] = 1;
    trace_and_solve(p);
    ck_assert_double_le(fabs(p->q[0]), 1e-4 * 4 * (81 - 16));
    ck_assert_double_le(fabs(p->q[1]), 1e-4 * 4 * (81 - 16));
    ck_assert(p->q[2] == 0);
    assert_near(pow(p->found[2], 4), (81 + 16) / 2., 1e-3);
}

/* A black sphere sees a square as its centre does, if no tangent plane cuts the square. */
TEST(a_black_sphere_sees_a_plate) {
    const double distance[] = {1.5, 4, 25};
    for (int k = 0; k < 3; k++) {
        const double d = distance[k], origin[3] = {d, -d, -d}, a[3] = {0, 0, 2 * d}, b[3] = {0, 2 * d, 0};
        ENDED struct problem *p = problem_of(BED({0, 0, 0, 1}), 2, 1);
        p->walls = 1, p->config.directions = 700;
        add_sheet(p->mesh, origin, a, b, 1, 0, 0);
        trace_and_solve(p);
        assert_near(p->q[0], 16 * 4 * PI / 6, 5e-3); /* a side of a cube */
        assert_near(p->result.surroundings_power, 16 * 4 * PI * 5 / 6, 1e-3);
    }
}

/* ---- small meshes: closed forms of black spheres that are seen whole ---- */

/* A small square, tilted about z, that faces the sphere at the origin. */
struct small_plate {
    double distance, half, turn;
};

static void add_plate(struct problem *p, const struct small_plate *plate, uint32_t cells, uint32_t front,
                      uint32_t back) {
    const double c = cos(plate->turn), s = sin(plate->turn), h = plate->half;
    add_sheet(p->mesh, (const double[]){plate->distance + s * h, -c * h, -h}, (const double[]){0, 0, 2 * h},
              (const double[]){-2 * s * h, 2 * c * h, 0}, cells, front, back);
}

/* What the front of a plate sees of a sphere: the mean of cos r^2/d^2 over the plate. */
static double seen_of(const struct small_plate *plate, const double centre[3], double r) {
    const double c = cos(plate->turn), s = sin(plate->turn);
    const int n = 60;
    double sum = 0;
    for (int k = 0; k < n * n; k++) {
        const double a = ((k % n * 2 + 1.) / n - 1) * plate->half, b = ((k / n * 2 + 1.) / n - 1) * plate->half;
        const double d[3] = {plate->distance - s * b - centre[0], c * b - centre[1], a - centre[2]};
        const double square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        sum += (c * d[0] + s * d[1]) / sqrt(square) * r * r / square;
    }
    return sum / (n * n);
}

static const struct small_plate small_plates[] = {{5, .05, 0},      {5, .01, 0},      {20, .5, 0},     {1.5, .02, .3},
                                                  {4.15, .223, .5}, {11.8, .31, -.6}, {2.6, .25, -.2}, {27, .06, .7}};
#define PLATES (int)(sizeof small_plates / sizeof *small_plates)

/* The power is right within two estimates, and the estimate is some percent at most. */
static void assert_known(double found, double error, double right) {
    ck_assert_double_le(fabs(found - right), 2 * error);
    ck_assert_double_le(error, .06 * fabs(right));
}

LOOP_TEST(a_small_plate_gets_what_it_sees_of_a_sphere, PLATES) {
    const struct small_plate *plate = &small_plates[_i];
    const double area = 4 * plate->half * plate->half, right = seen_of(plate, (const double[3]){0}, 1) * area;
    for (uint32_t cells = 1; cells <= 10; cells += 9) {
        ENDED struct problem *p = problem_of(BED({0, 0, 0, 1}), 2, 1);
        p->walls = 1;
        add_plate(p, plate, cells, 0, FIBRAD_NO_WALL);
        trace_and_solve(p);
        assert_known(p->q[0], p->q_error[0], 16 * right);
        assert_near(p->power[0], -16 * 4 * PI, 1e-6); /* beams that miss the plate make up for those that meet it */
        ck_assert_double_le(imbalance(p), 1e-12);
        p->temperature[0] = 0, p->wall_temperature[0] = 2;
        solve(p);
        assert_near(p->q[0], -16 * area, 1e-4);
        ck_assert_double_le(fabs(p->power[0] - 16 * right), 2 * p->error[0]);
    }
}

/* Grey plates with two sides: alone, and in a large black room where most rays of walls are those of the room. */
LOOP_TEST(a_small_grey_plate_gets_what_it_sees, PLATES) {
    const struct small_plate *plate = &small_plates[_i];
    const double area = 4 * plate->half * plate->half, sees = seen_of(plate, (const double[3]){0}, 1);
    for (int room = 0; room < 2; room++) {
        ENDED struct problem *p = problem_of(BED({0, 0, 0, 1}), 2, 1);
        if (room) make_planes(p, -30, 30);
        const uint32_t w = p->walls++;
        add_plate(p, plate, 1, w, w);
        p->wall_emissivity[w] = .4, p->wall_temperature[w] = 1.5;
        trace_and_solve(p);
        const double right = .4 * area * (16 * sees - 2 * pow(1.5, 4));
        ck_assert_double_le(fabs(p->q[w] - right), 2 * p->q_error[w] + 1e-9);
        ck_assert_double_le(p->q_error[w], .06 * .4 * area * 16 * fmax(sees, .03));
        ck_assert_double_le(imbalance(p), 1e-12);
    }
}

LOOP_TEST(a_small_insulated_plate_is_as_hot_as_what_it_sees, PLATES) {
    const struct small_plate *plate = &small_plates[_i];
    ENDED struct problem *p = problem_of(BED({0, 0, 0, 1}), 2, 1);
    double error[MOST];
    p->walls = 1, p->insulated[0] = 1, p->result.wall_temperature_error = error;
    add_plate(p, plate, 1, 0, FIBRAD_NO_WALL);
    trace_and_solve(p);
    const double right = 2 * pow(seen_of(plate, (const double[3]){0}, 1), .25);
    ck_assert_double_le(fabs(p->found[0] - right), 2 * error[0]);
    ck_assert_double_le(error[0], .02 * right);
}

/* Spheres of all sizes, none before another one. What a plate gets of each is seen when this sphere alone is hot. A
 * hot plate gives each sphere the same. */
TEST(small_plates_and_spheres_of_many_sizes) {
    const double sphere[5][4] = {
        {0, 0, 0, 1}, {0, 2.5, 0, .02}, {3, 0, 1.5, .2}, {-1, -3, .5, 1.6}, {4, -.6, -.5, .001}};
    const struct small_plate plate = {5, .03, 0};
    const double area = 4 * plate.half * plate.half;
    ENDED struct problem *p = problem_of(bed_of(5, sphere), 0, 1);
    p->walls = 1;
    add_plate(p, &plate, 1, 0, FIBRAD_NO_WALL);
    assert_ok(trace(p));
    for (int i = 0; i < 5; i++) {
        for (int k = 0; k < 5; k++) p->temperature[k] = k == i ? 2 : 0;
        solve(p);
        const double right = 16 * area * seen_of(&plate, sphere[i], sphere[i][3]);
        ck_assert_double_le(fabs(p->q[0] - right), 2 * p->q_error[0] + 1e-9);
        if (right > 1e-3 * 16 * area) ck_assert_double_le(fabs(p->q[0] - right), .05 * right);
    }
}

/* The rays of a small mesh count in the same order, whatever thread followed them. */
TEST(threads_change_no_bit_of_small_meshes) {
    ENDED struct problem *p = thirty(), *other = thirty();
    struct problem *both[2] = {p, other};
    for (int k = 0; k < 2; k++) {
        both[k]->walls = 1, both[k]->backwards = k == 1, both[k]->wall_temperature[0] = 3;
        add_plate(both[k], &(struct small_plate){1.3, .02, 0}, 2, 0, 0);
        trace_and_solve(both[k]);
    }
    ck_assert(p->q[0] == other->q[0] && p->q_error[0] == other->q_error[0]);
    ck_assert_mem_eq(p->power, other->power, 30 * sizeof *p->power);
    ck_assert_double_le(imbalance(p), 1e-12);
}

/* ---- more of other walls ---- */

/* A sheet of two sides, which sticks out of a box of planes, divides the box into two halves. Each half has the powers
 * that it has alone. The planes are black, as their patches do not end at the sheet. */
TEST(a_shelf_between_planes) {
    ENDED struct problem *both = thirty(), *half = thirty();
    const double origin[3] = {-.4, -.3, .5}, a[3] = {2, 0, 0}, b[3] = {0, 2, 0};
    make_planes(both, 0, 1), make_planes(half, 0, 1);
    both->walls = 8, half->wall[5].plane.at = .5;
    both->config = half->config = (fibrad_heat_config){.directions = 700, .patches = 384, .wall_rays = 300000};
    add_sheet(both->mesh, origin, a, b, 2, 6, 7);
    for (uint32_t i = 0; i < 30; i++) {
        both->bed.z[i] = .5 * both->bed.z[i] + (i < 8 ? .5 : 0), both->bed.r[i] *= .5; /* the first 8 lie above it */
        if (i < 8) continue;
        const uint32_t to = i - 8; /* the others lie below it, alone in `half` */
        half->bed.x[to] = both->bed.x[i], half->bed.y[to] = both->bed.y[i], half->bed.z[to] = both->bed.z[i];
        half->bed.r[to] = both->bed.r[i];
        half->temperature[to] = both->temperature[i], half->emissivity[to] = both->emissivity[i];
    }
    half->bed.n = 22;
    both->wall_temperature[7] = half->wall_temperature[5] = 2.2;
    both->wall_emissivity[7] = half->wall_emissivity[5] = .4;
    both->wall_temperature[6] = 1;
    for (int k = 0; k < 5; k++) both->wall_emissivity[k] = half->wall_emissivity[k] = 1;
    trace_and_solve(both), trace_and_solve(half);
    ck_assert_double_le(difference_of(both->power + 8, half->power, 22), 3e-3);
    assert_near(both->q[4], half->q[4], 5e-3); /* the floor */
    assert_near(both->q[7], half->q[5], 5e-3); /* the back of the sheet, and the ceiling that replaces it */
    ck_assert(both->result.surroundings_power == 0);
    ck_assert_double_le(imbalance(both), 1e-12);
}

/* ---- spheres cut by triangles ---- */

TEST(spheres_that_triangles_cut) {
    const double deep = .02;
    ENDED struct problem *cut = problem_of(BED({-1, -1, -1, 1}, {1, -1, -1, 1}, {-1, 1, -1, 1}, {1, 1, -1, 1},
                                               {-1, -1, 1, 1}, {1, -1, 1, 1}, {-1, 1, 1, 1}, {1, 1, 1, 1}),
                                           2, .6);
    for (uint32_t i = 0; i < 8; i++) cut->temperature[i] = 1 + .2 * i;
    for (int b = 0; b < 6; b++) cut->wall_temperature[b] = 1 + .1 * b, cut->wall_emissivity[b] = .7;
    cut->config.directions = 1000, cut->config.patches = 384;
    make_box(cut, -2 + deep, 2 - deep, 1);
    trace_and_solve(cut);
    double power[8], q[6];
    memcpy(power, cut->power, sizeof power), memcpy(q, cut->q, sizeof q);
    ck_assert(cut->result.surroundings_power == 0);
    ck_assert_double_le(imbalance(cut), 1e-12);
    free_heat(cut);
    free(cut->mesh), cut->mesh = mesh_new();
    make_box(cut, -2, 2, 1); /* triangles cut nothing here: nearly the same */
    trace_and_solve(cut);
    ck_assert_double_le(difference_of(power, cut->power, 8), .05);
    ck_assert_double_le(difference_of(q, cut->q, 6), .05);
    for (uint32_t i = 0; i < 8; i++) cut->temperature[i] = 2;
    for (int b = 0; b < 6; b++) cut->wall_temperature[b] = 2;
    solve(cut);
    for (uint32_t i = 0; i < 8; i++) ck_assert_double_le(fabs(cut->power[i]), 1e-8);
}

/* ---- what must not matter ---- */

TEST(threads_and_instruction_sets_change_no_bit) {
    const struct isas isas = isas_there();
    double power[30], q[6];
    for (int k = 0; k < isas.count; k++) {
        ENDED struct problem *p = thirty();
        p->isa = isas.set[k], p->backwards = k % 2 == 1;
        p->config = (fibrad_heat_config){.directions = 100, .patches = 96, .wall_rays = 20000};
        make_box(p, .02, .98, 4);
        trace_and_solve(p);
        if (k == 0) memcpy(power, p->power, sizeof power), memcpy(q, p->q, sizeof q);
        ck_assert_mem_eq(p->power, power, sizeof power);
        ck_assert_mem_eq(p->q, q, sizeof q);
    }
}

static const double tilt[9] = {4. / 9, -1. / 9, 8. / 9, 4. / 9, 8. / 9, -1. / 9, -7. / 9, 4. / 9, 4. / 9};

static void turn_all(struct problem *p, const double turn[9]) {
    mesh_turn(p->mesh, turn);
    for (uint32_t i = 0; i < p->bed.n; i++) {
        double at[3] = {p->bed.x[i], p->bed.y[i], p->bed.z[i]};
        turn_point(turn, at);
        p->bed.x[i] = at[0], p->bed.y[i] = at[1], p->bed.z[i] = at[2];
    }
}

TEST(a_tilted_box_is_the_same) {
    ENDED struct problem *p = thirty(), *turned = thirty();
    p->config = turned->config = (fibrad_heat_config){.directions = 700, .patches = 384, .wall_rays = 300000};
    make_box(p, 0, 1, 2), make_box(turned, 0, 1, 2);
    turn_all(turned, tilt);
    trace_and_solve(p), trace_and_solve(turned);
    ck_assert_double_le(difference_of(turned->power, p->power, 30), 3e-3);
    ck_assert_double_le(difference_of(turned->q, p->q, 6), 3e-3);
}

/* A mesh moves. The next solution begins where the last one ended, whatever the order of its triangles. */
TEST(a_mesh_moves) {
    ENDED struct problem *p = thirty();
    make_box(p, 0, 1, 9);
    trace_and_solve(p);
    const uint32_t cold = p->result.sweeps;
    double power[30];
    memcpy(power, p->power, sizeof power);
    turn_all(p, tilt);
    OWNED fibrad_scene *next = build_scene(p);
    assert_ok(fibrad_heat_move(p->heat, next));
    assert_ok(trace_beams(p));
    solve(p);
    ck_assert_uint_lt(p->result.sweeps, cold);
    ck_assert_double_le(difference_of(p->power, power, 30), 2e-2);
    ck_assert_double_le(imbalance(p), 1e-12);

    p->mesh->front[3] ^= 1; /* another wall */
    OWNED fibrad_scene *other = build_scene(p);
    assert_invalid(fibrad_heat_move(p->heat, other));
    p->mesh->front[3] ^= 1, p->mesh->triangles.n--; /* a triangle less */
    free(other), other = build_scene(p);
    assert_invalid(fibrad_heat_move(p->heat, other));
}

TEST(estimates_of_errors_are_honest) {
    ENDED struct problem *truth = thirty();
    uint32_t beyond = 0;
    double errors[2] = {0}, estimates[2] = {0};
    truth->config = (fibrad_heat_config){.directions = 2000, .patches = 384, .wall_rays = 300000};
    make_planes(truth, 0, 1);
    trace_and_solve(truth);
    for (uint32_t cells = 1; cells <= 16; cells *= 4) {
        ENDED struct problem *p = thirty();
        make_box(p, 0, 1, cells);
        trace_and_solve(p);
        for (uint32_t k = 0; k < 36; k++) {
            const double error = k < 30 ? p->power[k] - truth->power[k] : p->q[k - 30] - truth->q[k - 30];
            const double estimate = k < 30 ? p->error[k] : p->q_error[k - 30];
            beyond += fabs(error) > 2 * estimate;
            errors[k >= 30] += error * error, estimates[k >= 30] += estimate * estimate;
        }
    }
    ck_assert_uint_le(beyond, 15);
    for (int kind = 0; kind < 2; kind++) {
        ck_assert_double_ge(sqrt(estimates[kind] / errors[kind]), .6);
        ck_assert_double_le(sqrt(estimates[kind] / errors[kind]), 4);
    }
}

/* Fluxes through triangles add up to the powers of their walls. A plate that faces a hot sphere is lit most where the
 * sphere is nearest. If the plate is insulated, it is hottest there. */
TEST(fluxes_through_triangles) {
    enum { CELLS = 16, PIECES = 2 * CELLS * CELLS };
    const double origin[3] = {-3, -3, 1.5}, a[3] = {6, 0, 0}, b[3] = {0, 6, 0};
    ENDED struct problem *p = problem_of(BED({0, 0, 0, 1}), 2, .8);
    double flux[2 * PIECES], temperature[2 * PIECES], sum = 0;
    p->walls = 1, p->wall_temperature[0] = 1, p->wall_emissivity[0] = .7, p->config.directions = 700;
    add_sheet(p->mesh, origin, b, a, CELLS, 0, FIBRAD_NO_WALL); /* its front is below */
    assert_invalid(fibrad_heat_read_sides(NULL, flux, temperature));
    assert_ok(trace(p));
    ck_assert_int_eq(fibrad_heat_read_sides(p->heat, flux, temperature), FIBRAD_E_STATE);
    solve(p);
    assert_ok(fibrad_heat_read_sides(p->heat, flux, temperature));
    const uint32_t middle = PIECES / 2 + CELLS;
    for (uint32_t t = 0; t < PIECES; t++) {
        sum += flux[2 * t] * 36 / PIECES;
        ck_assert(isnan(flux[2 * t + 1]) && isnan(temperature[2 * t + 1]) && temperature[2 * t] == 1);
    }
    assert_near(sum, p->q[0], 1e-12);
    /* above the centre, a black sphere of radius 1 fills (1/1.5)^2 of the view */
    assert_near(flux[2 * middle], .7 * (.8 * 16 / 2.25 - 1), .1);
    ck_assert_double_lt(flux[0], .3 * flux[2 * middle]);

    p->insulated[0] = 1;
    solve(p);
    assert_ok(fibrad_heat_read_sides(p->heat, flux, temperature));
    ck_assert(flux[2 * middle] == 0);
    ck_assert_double_gt(temperature[2 * middle], 1.3 * temperature[0]);
}

/* ---- temperatures of triangles ---- */

static double area_of_triangle(const struct mesh *mesh, uint32_t t) {
    const double *a = mesh->at[mesh->corner[t][0]], *b = mesh->at[mesh->corner[t][1]],
                 *c = mesh->at[mesh->corner[t][2]];
    const double u[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, v[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    return .5 * hypot(hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2]), u[0] * v[1] - u[1] * v[0]);
}

/* The sum over the sides of a wall of what they gain, from fluxes [2 triangles]. */
static double gain_of_wall(const struct problem *p, const double *flux, uint32_t wall) {
    const struct mesh *mesh = p->mesh;
    double sum = 0;
    for (uint32_t t = 0; t < mesh->triangles.n; t++) {
        const double area = area_of_triangle(mesh, t);
        if (mesh->front[t] == wall && !isnan(flux[2 * t])) sum += area * flux[2 * t];
        if (mesh->back[t] == wall && !isnan(flux[2 * t + 1])) sum += area * flux[2 * t + 1];
    }
    return sum;
}

/* A box whose faces have temperatures of their own gives what a box gives whose faces are walls. The fluxes of faces
 * are the powers of these walls, whether triangles are cut into patches or share them. The next solution begins with
 * this one. */
TEST(faces_with_temperatures_of_their_own) {
    static double side[2 * 12 * 144], flux[2 * 12 * 144], found[2 * 12 * 144];
    for (uint32_t cells = 1; cells <= 12; cells += 11) {
        ENDED struct problem *walls = thirty(), *one = thirty();
        walls->config = one->config = (fibrad_heat_config){.directions = 400, .patches = 96, .wall_rays = 200000};
        make_box(walls, 0, 1, cells);
        one->walls = 1, one->wall_temperature[0] = 1.7, one->wall_emissivity[0] = .6;
        add_box(one->mesh, 0, 1, cells, true);
        for (int b = 0; b < 6; b++) walls->wall_emissivity[b] = .6;
        const uint32_t n = one->mesh->triangles.n;
        for (uint32_t t = 0; t < n; t++)
            side[2 * t] = walls->wall_temperature[walls->mesh->front[t]], side[2 * t + 1] = NAN;
        one->sources.side_temperature = side;
        trace_and_solve(walls), trace_and_solve(one);
        ck_assert_double_le(difference_of(one->power, walls->power, 30), 1e-3);
        assert_ok(fibrad_heat_read_sides(one->heat, flux, found));
        assert_near(gain_of_wall(one, flux, 0), one->q[0], 1e-11);
        double gain[6] = {0}, mean = 0;
        for (uint32_t t = 0; t < n; t++) {
            gain[walls->mesh->front[t]] += flux[2 * t] * area_of_triangle(one->mesh, t);
            mean += pow(side[2 * t], 4) / n;
            if (cells == 1) assert_near(found[2 * t], side[2 * t], 1e-12);
        }
        ck_assert_double_le(difference_of(gain, walls->q, 6), 5e-3);
        assert_near(pow(one->found[0], 4), mean, 1e-9);
        ck_assert_double_le(imbalance(one), 1e-12);
        assert_ok(fibrad_heat_read_sides(walls->heat, flux, NULL));
        for (uint32_t b = 0; b < 6; b++) assert_near(gain_of_wall(walls, flux, b), walls->q[b], 1e-11);

        const uint32_t cold = one->result.sweeps;
        double power[30];
        memcpy(power, one->power, sizeof power);
        for (uint32_t t = 0; t < n; t++) side[2 * t] *= 1.05;
        solve(one);
        ck_assert_double_gt(difference_of(one->power, power, 30), 2e-2);
        for (uint32_t t = 0; t < n; t++) side[2 * t] /= 1.05;
        solve(one);
        ck_assert_uint_lt(one->result.sweeps, cold);
        ck_assert_double_le(difference_of(one->power, power, 30), 1e-3);
        one->sources.side_temperature = NULL;
        solve(one); /* all at 1.7 again */
        memcpy(power, one->power, sizeof power);
        for (uint32_t t = 0; t < n; t++) side[2 * t] = t % 3 == 0 ? NAN : 1.7;
        one->sources.side_temperature = side;
        solve(one);
        ck_assert_double_le(difference_of(one->power, power, 30), 1e-3);
    }
}

/* What a place at the height 1 receives from a black square at the height 0 with the temperatures T(x, y). */
static double received_at(double x, double y, double temperature(double x, double y)) {
    enum { STEPS = 200 };
    double sum = 0;
    for (uint32_t k = 0; k < STEPS * STEPS; k++) {
        const double u = (k % STEPS + .5) / STEPS, v = (k / STEPS + .5) / STEPS;
        const double square = (x - u) * (x - u) + (y - v) * (y - v) + 1;
        sum += pow(temperature(u, v), 4) / (PI * square * square * STEPS * STEPS);
    }
    return sum;
}

/* Solves for the temperatures of the lower square. Compares fluxes and power of the upper one, which is at 0, with sums
 * over the lower one. */
enum { CELLS = 10, PIECES = 2 * CELLS * CELLS };
static void check_squares(struct problem *p, double temperature(double x, double y), double flux_error,
                          double power_error) {
    double side[4 * PIECES], flux[4 * PIECES], due[PIECES], got[PIECES], all = 0;
    for (uint32_t t = 0; t < 2 * PIECES; t++) {
        double x = 0, y = 0;
        for (int k = 0; k < 3; k++)
            x += p->mesh->at[p->mesh->corner[t][k]][0] / 3, y += p->mesh->at[p->mesh->corner[t][k]][1] / 3;
        side[2 * t] = t < PIECES ? temperature(x, y) : NAN, side[2 * t + 1] = NAN;
        if (t >= PIECES) all += due[t - PIECES] = received_at(x, y, temperature);
    }
    p->sources.side_temperature = side;
    solve(p);
    assert_ok(fibrad_heat_read_sides(p->heat, flux, NULL));
    for (uint32_t t = 0; t < PIECES; t++) got[t] = flux[2 * (PIECES + t)];
    const double error = difference_of(got, due, PIECES);
    ck_assert_msg(error <= flux_error, "off by %.3g", error);
    assert_near(p->q[1], all / PIECES, power_error);
    for (uint32_t wall = 0; wall < 2; wall++) assert_near(gain_of_wall(p, flux, wall), p->q[wall], 1e-11);
}

static double linear(double x, double y) { return 1 + x + .5 * y; }

/* One hot cell of ten by ten. */
static double spot(double x, double y) { return x > .3 && x < .4 && y > .6 && y < .7 ? 3 : 0; }

/* Two black squares of 200 triangles each face each other at a distance of 1. */
TEST(squares_with_fields_of_temperature) {
    const double low[3] = {0, 0, 0}, high[3] = {0, 0, 1}, a[3] = {1, 0, 0}, b[3] = {0, 1, 0};
    ENDED struct problem *p = problem_of(BED({-5, -5, .5, 1e-3}), 0, 1);
    p->walls = 2, p->config.wall_rays = 1u << 21;
    add_sheet(p->mesh, low, a, b, CELLS, 0, FIBRAD_NO_WALL);
    add_sheet(p->mesh, high, b, a, CELLS, 1, FIBRAD_NO_WALL);
    assert_ok(trace(p));
    check_squares(p, linear, 3e-2, 4e-3); /* T is not constant on triangles */
    check_squares(p, spot, .3, 3e-2);
}

TEST(temperatures_of_triangles_that_are_refused) {
    ENDED struct problem *p = problem_of(BED({.5, .5, .5, .2}), 2, .8);
    double side[24];
    p->walls = 1, p->wall_temperature[0] = 1;
    add_box(p->mesh, 0, 1, 1, true);
    for (int k = 0; k < 24; k++) side[k] = NAN;
    side[6] = 2, side[7] = -1; /* the latter belongs to no wall */
    p->sources.side_temperature = side;
    trace_and_solve(p);
    const double wrong[] = {-1, 1e21, INFINITY};
    for (int k = 0; k < 3; k++) {
        side[8] = wrong[k];
        assert_invalid(fibrad_heat_begin(p->heat, &p->sources));
    }
    side[8] = 3;
    assert_ok(fibrad_heat_begin(p->heat, &p->sources));
    p->insulated[0] = 1;
    assert_invalid(fibrad_heat_begin(p->heat, &p->sources));
    p->insulated[0] = 0, p->wall_temperature[0] = NAN, p->wall_power[0] = 1;
    assert_invalid(fibrad_heat_begin(p->heat, &p->sources));
}

/* ---- patches ---- */

TEST(patches_have_the_area_of_the_mesh) {
    enum { POINTS = 50000 };
    ENDED struct problem *p = thirty();
    const double origin[3] = {-3, 0, 5}, a[3] = {7, 0, 0}, b[3] = {.1, .2, 0};
    make_box(p, 0, 1, 20);
    add_sheet(p->mesh, origin, a, b, 1, 0, 0); /* large slivers of two sides lie beside the small triangles */
    p->scene = build_scene(p);
    const fibrad_mesh *mesh = &p->scene->mesh;
    const uint32_t sides = 2 * mesh->triangles;
    OWNED fibrad_mesh_cut *cut = calloc(sides, sizeof *cut);
    ck_assert_ptr_nonnull(cut);
    for (double area = 1e-3; area < 10; area *= 3) {
        const uint32_t n = fibrad_mesh_cut_sides(mesh, 0, area, 5, cut);
        ck_assert_uint_eq(fibrad_mesh_cut_sides(mesh, 0, area, 5, NULL), n);
        double *own = calloc(n, sizeof *own), sum = 0;
        OWNED uint32_t *points = calloc(n, sizeof *points);
        for (uint32_t k = mesh->first[0]; k < mesh->first[1]; k++) {
            const fibrad_mesh_cut *c = fibrad_mesh_cut_of(mesh, cut, mesh->side[k]);
            const double whole = mesh->area[k] - (k > mesh->first[0] ? mesh->area[k - 1] : 0);
            for (uint32_t part = 0; part < 1u << c->halvings; part++) {
                ck_assert(c->patch >= 5 && c->patch + part < 5 + n);
                own[c->patch + part - 5] += whole / (1u << c->halvings);
            }
        }
        for (uint32_t k = 0; k < n; k++) {
            ck_assert_double_gt(own[k], 0);
            ck_assert_double_le(own[k], 2 * area);
            sum += own[k];
        }
        assert_near(sum, fibrad_mesh_area(mesh, 0), 1e-12);
        ck_assert_double_le(n, 4 * sum / area + 8);
        for (uint32_t k = 0; k < POINTS; k++) { /* each patch gets its part of evenly spread points */
            const double share[2] = {(k + .5) / POINTS, fmod(k * .6180339887498949, 1)};
            double at[3];
            const uint32_t side = fibrad_mesh_point(mesh, 0, share, at);
            const uint32_t patch = fibrad_mesh_patch_at(mesh, cut, side, at) - 5;
            ck_assert_uint_lt(patch, n);
            points[patch]++;
        }
        for (uint32_t k = 0; k < n; k++) {
            const double due = POINTS * own[k] / sum;
            ck_assert_double_le(fabs(points[k] - due), 5 * sqrt(due) + 3);
        }
        free(own);
    }
}

/* ---- soups ---- */

/* Triangles lie at random. Some have no area, some are slivers, some occur twice, some cut spheres and each other. */
TEST(soups_have_finite_powers_that_add_up) {
    for (uint64_t seed = 0; seed < 8; seed++) {
        ENDED struct problem *p = problem_of(thirty_spheres(), 1, .5);
        for (int axis = 0; axis < 3; axis++) p->bed.period[axis] = seed == 7 && axis == 1;
        p->walls = 3;
        const uint32_t pieces = 1 + (uint32_t)(60 * bed_make_random(seed, 0));
        const double size = seed % 3 == 0 ? 2 : .2;
        for (uint32_t t = 0; t < pieces; t++) {
            uint32_t v[3];
            double at[3], to[3];
            for (uint64_t k = 0; k < 3; k++) at[k] = bed_make_random(seed, 100 * (t + 1) + k);
            for (uint64_t c = 0; c < 3; c++) {
                for (uint64_t k = 0; k < 3; k++)
                    to[k] = at[k] + size * (bed_make_random(seed, 100 * (t + 1) + 10 * (c + 1) + k) - .5) *
                                        (t % 5 == 1 && k > 0 ? 1e-9 : 1);
                v[c] = mesh_vertex(p->mesh, to[0], to[1], to[2]);
            }
            if (t % 7 == 3) v[2] = v[1];
            mesh_triangle(p->mesh, v[0], v[1], v[2], t % 3, (t + 1) % 3);
            if (t % 11 == 5) mesh_triangle(p->mesh, v[0], v[1], v[2], t % 3, (t + 1) % 3);
        }
        for (uint32_t i = 0; i < 30; i++) p->temperature[i] = 1 + bed_make_random(5, i);
        for (int b = 0; b < 3; b++) p->wall_temperature[b] = 1 + b, p->wall_emissivity[b] = .3 * (b + 1);
        p->insulated[2] = seed % 2 == 0;
        p->config = (fibrad_heat_config){.directions = 30, .patches = 24, .wall_rays = 20000};
        trace_and_solve(p);
        for (uint32_t i = 0; i < 30; i++) ck_assert(isfinite(p->power[i]) && isfinite(p->error[i]));
        for (int b = 0; b < 3; b++) ck_assert(isfinite(p->q[b]) && isfinite(p->q_error[b]));
        ck_assert_double_le(imbalance(p), 1e-11);
    }
}

/* ---- what is refused ---- */

TEST(a_back_that_is_seen_is_named) {
    ENDED struct problem *p = thirty();
    const double origin[3] = {-1, -1, .5}, a[3] = {3, 0, 0}, b[3] = {0, 3, 0};
    make_planes(p, 0, 1);
    p->walls = 7, p->config = (fibrad_heat_config){.directions = 100, .patches = 96, .wall_rays = 20000};
    add_sheet(p->mesh, origin, a, b, 1, 6, FIBRAD_NO_WALL); /* a shelf goes through the bed */
    ck_assert_int_eq(trace(p), FIBRAD_E_BACK);
    ck_assert_uint_lt(p->seen, 2);
    free_heat(p);
    p->mesh->back[0] = p->mesh->back[1] = 6;
    trace_and_solve(p); /* the part of it beyond the planes plays no part */
    ck_assert_double_le(imbalance(p), 1e-12);
    ck_assert(p->result.surroundings_power == 0);
}
