/* test_heat_errors.c - stated errors of powers against closed forms, over random scenes. SPDX-License-Identifier: MIT
 */
#include "host_owned.h"
#include "rectangles.h"
#include "scenes.h"
#include "suite.h"
#include "meshes.h"

enum { MOST = 20 };

/* A few spheres and walls, all black, and their results. sigma is 1. */
struct given {
    struct bed bed;
    fibrad_wall wall[MOST];
    fibrad_plane opening;
    fibrad_scene_config scene;
    fibrad_heat_config config;
    double temperature[MOST], emissivity[MOST], wall_temperature[MOST], wall_emissivity[MOST], surroundings;
    double power[MOST], error[MOST], wall_power[MOST], wall_error[MOST];
    fibrad_heat_result result;
};

static void solve(struct given *g) {
    const fibrad_spheres spheres = spheres_of(&g->bed);
    fibrad_heat_sources sources;
    OWNED_MADE *radiation = NULL;
    fibrad_run run = {.threads = 1};
    fibrad_heat_sources_init(&sources);
    for (int k = 0; k < MOST; k++) g->emissivity[k] = g->wall_emissivity[k] = 1;
    sources.sigma = 1, sources.surroundings = g->surroundings;
    sources.temperature = g->temperature, sources.emissivity = g->emissivity;
    sources.wall_temperature = g->wall_temperature, sources.wall_emissivity = g->wall_emissivity;
    g->result = (fibrad_heat_result){.power = g->power, .power_error = g->error, .surroundings_error = NAN};
    g->result.wall_power = g->wall_power, g->result.wall_error = g->wall_error;
    g->scene.wall = g->wall, g->scene.opening = &g->opening;
    assert_ok(made_with(&radiation, &g->scene, &spheres, &g->config, &run));
    assert_ok(fibrad_bed_solve(radiation, &sources, NULL, &g->result));
    bed_free(&g->bed);
}

static double drawn(uint64_t seed, uint64_t number, double low, double high) {
    return low + (high - low) * bed_make_random(seed, number);
}

static double fourth(double t) { return t * t * t * t; }

/* How the estimates of some scenes compare with true errors: the squares of both, and the number of scenes whose error
 * is above 2.5 times the estimate. */
struct honesty {
    double errors, estimates;
    int scenes, beyond;
};

static void judge(struct honesty *honesty, double error, double estimate, double size) {
    ck_assert(estimate > 0 && estimate < .1 * size);
    honesty->errors += pow(error / size, 2), honesty->estimates += pow(estimate / size, 2);
    honesty->scenes++, honesty->beyond += fabs(error) > 2.5 * estimate;
}

static void expect_honest(const struct honesty *honesty) {
    ck_assert_msg(20 * honesty->beyond <= honesty->scenes, "%d of %d", honesty->beyond, honesty->scenes);
    ck_assert_msg(honesty->estimates < 16 * honesty->errors, "%g, true %g", sqrt(honesty->estimates),
                  sqrt(honesty->errors));
}

static double distance(const double a[4], const double b[4]) {
    return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

/* Whether sphere c comes between a and b, or near to that. */
static bool hides(const double a[4], const double b[4], const double c[4]) {
    double along = 0, at[4];
    for (int k = 0; k < 3; k++) along += (b[k] - a[k]) * (c[k] - a[k]);
    along = fmin(1, fmax(0, along / pow(distance(a, b), 2)));
    for (int k = 0; k < 3; k++) at[k] = a[k] + along * (b[k] - a[k]);
    return distance(at, c) <= fmax(a[3], b[3]) + c[3];
}

/* Makes spheres in a cube. None hides a part of another from a third, and none touches another. */
static struct bed apart(uint64_t seed, uint32_t spheres, double size) {
    double at[MOST][4];
    for (uint32_t n = 0, tried = 0; n < spheres; tried += 4) {
        double *last = at[n];
        bool fits = true;
        for (uint32_t k = 0; k < 4; k++)
            last[k] = k < 3 ? drawn(seed, tried + k, 0, size) : drawn(seed, tried + k, .4, 1);
        for (uint32_t i = 0; i < n && fits; i++) {
            fits = distance(at[i], last) > at[i][3] + last[3];
            for (uint32_t j = 0; j < n && fits; j++)
                fits = j == i || !(hides(at[i], at[j], last) || hides(at[i], last, at[j]));
        }
        n += fits;
    }
    return bed_of(spheres, (const double(*)[4])at);
}

/* The exact area times view factor from a sphere to another one that nothing hides. */
static double exact_exchange(const struct bed *bed, uint32_t i, uint32_t j) {
    const double a[] = {bed->x[i], bed->y[i], bed->z[i], bed->r[i]}, b[] = {bed->x[j], bed->y[j], bed->z[j], bed->r[j]};
    double view;
    ck_assert_int_eq(fibrad_pair_exact(a[3], b[3], distance(a, b) - a[3] - b[3], &view), 0);
    return 4 * PI * a[3] * a[3] * view;
}

/* Black spheres stand in the open. */
TEST(spheres_and_their_surroundings) {
    struct honesty honesty = {0};
    for (uint64_t seed = 1; seed <= 60; seed++) {
        struct given g = {.bed = apart(seed, 6, 9)};
        double power = 0;
        for (uint32_t i = 0; i < g.bed.n; i++) {
            double open = 4 * PI * g.bed.r[i] * g.bed.r[i];
            for (uint32_t j = 0; j < g.bed.n; j++) open -= j == i ? 0 : exact_exchange(&g.bed, i, j);
            g.temperature[i] = drawn(seed, 1000 + i, .3, 1);
            power += open * fourth(g.temperature[i]);
        }
        solve(&g);
        judge(&honesty, g.result.surroundings_power - power, g.result.surroundings_error, power);
    }
    expect_honest(&honesty);
}

/* Checks beds of black spheres in the open. They are so far apart that one meets another by a direction or two, or by
 * none. */
static void expect_honest_powers(uint64_t beds, uint32_t spheres, double size) {
    struct honesty honesty = {0}, of_surroundings = {0};
    for (uint64_t seed = 1; seed <= beds; seed++) {
        struct given g = {.bed = apart(seed, spheres, size)};
        double power[MOST], area[MOST], lost = 0, areas = 0;
        for (uint32_t i = 0; i < spheres; i++) g.temperature[i] = drawn(seed, 1000 + i, .3, 1);
        for (uint32_t i = 0; i < spheres; i++) {
            area[i] = 4 * PI * g.bed.r[i] * g.bed.r[i], power[i] = -area[i] * fourth(g.temperature[i]);
            for (uint32_t j = 0; j < spheres; j++)
                power[i] += j == i ? 0 : exact_exchange(&g.bed, i, j) * fourth(g.temperature[j]);
        }
        solve(&g);
        for (uint32_t i = 0; i < spheres; i++) {
            judge(&honesty, g.power[i] - power[i], g.error[i], area[i]);
            lost -= power[i], areas += area[i];
        }
        judge(&of_surroundings, g.result.surroundings_power - lost, g.result.surroundings_error, areas);
    }
    expect_honest(&honesty);
    expect_honest(&of_surroundings);
}

TEST(two_spheres_alone) { expect_honest_powers(300, 2, 9); }

TEST(spheres_far_apart) { expect_honest_powers(20, 20, 30); }

/* Black boxes without a lid have next to nothing inside. Rays of walls tell what the opening gets. */
TEST(a_box_and_its_opening) {
    struct honesty honesty = {0};
    for (uint64_t seed = 1; seed <= 30; seed++) {
        const double size[3] = {drawn(seed, 0, .5, 1.5), drawn(seed, 1, .5, 1.5), drawn(seed, 2, .5, 1.5)};
        struct given g = {.bed = BED({.2, .25, .3, 1e-4}), .opening = {2, 1, size[2]}};
        g.surroundings = drawn(seed, 3, 0, .6), g.scene.walls = 5, g.scene.openings = 1;
        double power = 0, sent = 0;
        for (uint32_t k = 0; k < 5; k++) {
            const uint32_t a = k / 2, b = 1 - a; /* the axis across the wall, and the other axis of the opening */
            const double factor = k == 4 ? opposite(size[0], size[1], size[2]) : adjacent(size[b], size[2], size[a]);
            const double area = k == 4 ? size[0] * size[1] : size[b] * size[2];
            g.wall[k] = plane_at((int)a, k % 2, k % 2 ? size[a] : 0);
            g.wall_temperature[k] = drawn(seed, 4 + k, .6, 1);
            power += area * factor * (fourth(g.wall_temperature[k]) - fourth(g.surroundings));
            sent += area * factor * fourth(g.wall_temperature[k]);
        }
        solve(&g);
        judge(&honesty, g.result.surroundings_power - power, g.result.surroundings_error, sent);
    }
    expect_honest(&honesty);
}

/* Makes a prism of `sides` about the z axis, of triangles that are seen from within. It is open at the top. */
static struct mesh *cup_of(uint32_t sides, double radius, double height) {
    struct mesh *mesh = mesh_new();
    const uint32_t middle = mesh_vertex(mesh, 0, 0, 0);
    for (uint32_t k = 0; k < sides; k++) {
        const double turn = 2 * PI * k / sides;
        for (int up = 0; up < 2; up++) mesh_vertex(mesh, radius * cos(turn), radius * sin(turn), up * height);
    }
    for (uint32_t k = 0; k < sides; k++) {
        const uint32_t a = 1 + 2 * k, b = 1 + 2 * ((k + 1) % sides);
        mesh_quad(mesh, (const uint32_t[]){a, a + 1, b + 1, b}, 0, FIBRAD_NO_WALL);
        mesh_triangle(mesh, middle, a, b, 0, FIBRAD_NO_WALL);
    }
    return mesh;
}

/* Black cups of triangles have one temperature, which is also that of a small sphere inside. All that leaves goes
 * through the lid. Rays of the cup alone tell how much. They are even on each triangle, so that more triangles help. */
TEST(a_cup_of_triangles) {
    struct honesty honesty = {0}, of_cup = {0};
    for (uint64_t seed = 1; seed <= by_night(10, 4); seed++) {
        const double radius = drawn(seed, 0, .5, 1.5), height = drawn(seed, 1, .5, 2.5);
        const uint32_t sides = (uint32_t)drawn(seed, 2, 4, 44);
        struct given g = {.bed = BED({.1 * radius, .1 * radius, height / 2, radius / 50})};
        OWNED struct mesh *mesh = cup_of(sides, radius, height);
        const double power = sides * .5 * radius * radius * sin(2 * PI / sides);
        g.temperature[0] = g.wall_temperature[0] = 1, g.config.wall_rays = 1 << 20;
        g.wall[0].kind = FIBRAD_WALL_MESH, g.scene.walls = 1, g.scene.triangles = &mesh->triangles;
        solve(&g);
        judge(&honesty, g.result.surroundings_power - power, g.result.surroundings_error, power);
        judge(&of_cup, g.wall_power[0] + g.power[0] + power, g.wall_error[0], power);
    }
    expect_honest(&honesty);
    expect_honest(&of_cup);
    ck_assert_msg(honesty.errors / honesty.scenes < pow(5.5e-4, 2), "off by %g", sqrt(honesty.errors / honesty.scenes));
}

/* If nothing reaches the surroundings, they have no power and no error. */
TEST(no_surroundings) {
    struct given g = {.bed = BED({0, 0, 0, .5}), .temperature = {1}};
    g.scene.walls = 6;
    for (uint32_t k = 0; k < 6; k++) g.wall[k] = plane_at((int)k / 2, k % 2, k % 2 ? 1 : -1);
    solve(&g);
    ck_assert(g.result.surroundings_power == 0 && g.result.surroundings_error == 0);
    ck_assert(g.error[0] > 0 && g.wall_error[0] > 0);
}
