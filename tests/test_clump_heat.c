/* test_clump_heat.c - heat of clumps, bodies of spheres within one another: closed forms, own rays on the union, and an
 * own Newton solution. SPDX-License-Identifier: MIT */
#include "base/random.h"
#include "host_owned.h"
#include "meshes.h"
#include "program.h"
#include "scenes.h"

FIXTURE(make_folder, remove_folder)

#define PI    3.14159265358979323846
#define SIGMA FIBRAD_STEFAN_BOLTZMANN

static double fourth(double t) { return t * t * t * t; }

enum { SPHERES_MOST = 12 };

/* Spheres, some of them in clumps, within a box of six planes at -half and half, or in black surroundings. */
struct lumps {
    double at[SPHERES_MOST][3], r[SPHERES_MOST], t[SPHERES_MOST], e[SPHERES_MOST], power[SPHERES_MOST];
    double film[SPHERES_MOST], gas[SPHERES_MOST], storage[SPHERES_MOST];
    uint32_t clump[SPHERES_MOST], n;
    double period[3], half, around; /* half: 0: no box */
    fibrad_wall wall[6];
    double wall_t[6], wall_e[6];
    fibrad_heat_config config;
};

struct solved {
    double power[SPHERES_MOST], error[SPHERES_MOST], t[SPHERES_MOST], t_error[SPHERES_MOST], wall[6], wall_error[6];
    double conducted[SPHERES_MOST], convected[SPHERES_MOST];
    fibrad_heat_result result;
};

static fibrad_spheres spheres_of_lumps(const struct lumps *l) {
    return (fibrad_spheres){&l->at[0][0], &l->at[0][1], &l->at[0][2], l->r, l->n, .stride = 3, .clump = l->clump};
}

static fibrad_scene_config config_of_lumps(struct lumps *l) {
    fibrad_scene_config config = {.period = {l->period[0], l->period[1], l->period[2]}, .wall = l->wall};
    for (int k = 0; k < 6 && l->half > 0; k++)
        if (l->period[k / 2] == 0) l->wall[config.walls++] = plane_at(k / 2, k % 2, k % 2 ? l->half : -l->half);
    return config;
}

static fibrad_heat_sources sources_of_lumps(const struct lumps *l) {
    fibrad_heat_sources s;
    fibrad_heat_sources_init(&s);
    s.surroundings = l->around, s.temperature = l->t, s.emissivity = l->e, s.power = l->power, s.film = l->film;
    s.tolerance = 1e-10, s.gas = l->gas, s.wall_temperature = l->wall_t, s.wall_emissivity = l->wall_e;
    return s;
}

static int solve_status(struct lumps *l, const fibrad_heat_sources *more, struct solved *to) {
    OWNED_MADE *made = NULL;
    const fibrad_spheres spheres = spheres_of_lumps(l);
    const fibrad_scene_config config = config_of_lumps(l);
    fibrad_heat_sources sources = sources_of_lumps(l);
    if (more) {
        sources.contacts = more->contacts, sources.conductance = more->conductance;
        sources.contact_first = more->contact_first, sources.contact_second = more->contact_second;
        sources.conductivity = more->conductivity;
    }
    *to = (struct solved){.result = {.power = to->power,
                                     .power_error = to->error,
                                     .temperature = to->t,
                                     .temperature_error = to->t_error,
                                     .wall_power = to->wall,
                                     .wall_error = to->wall_error,
                                     .conducted = to->conducted,
                                     .convected = to->convected}};
    assert_ok(made_with(&made, &config, &spheres, &l->config, NULL));
    return fibrad_bed_solve(made, &sources, NULL, &to->result);
}

static void solve(struct lumps *l, struct solved *to) {
    assert_ok(solve_status(l, NULL, to));
    double sum = to->result.surroundings_power + to->result.gas_power, all = fabs(sum);
    for (int k = 0; k < 6; k++) sum += to->wall[k], all += fabs(to->wall[k]);
    for (uint32_t i = 0; i < l->n; i++) sum += to->power[i], all += fabs(to->power[i]);
    ck_assert_double_le(fabs(sum), 1e-12 * all);
}

/* Power of a clump, and the root of the sum of squares of the errors. */
static double of_clump(const struct lumps *l, uint32_t clump, const double *value, bool squares) {
    double sum = 0;
    for (uint32_t i = 0; i < l->n; i++)
        if (l->clump[i] == clump) sum += squares ? value[i] * value[i] : value[i];
    return squares ? sqrt(sum) : sum;
}

/* Two unit spheres, their centres d apart. */
static struct lumps dumbbell(double d, double e) {
    struct lumps l = {.at = {{-d / 2, 0, 0}, {d / 2, 0, 0}}, .n = 2, .around = 300};
    for (int i = 0; i < 2; i++) l.r[i] = 1, l.clump[i] = 7, l.e[i] = e, l.t[i] = 900, l.power[i] = NAN;
    return l;
}

/* Four unequal spheres with centres inside one another. */
static struct lumps four(double e) {
    struct lumps l = {.at = {{0, 0, 0}, {.7, .1, 0}, {.2, .6, .3}, {-.4, -.2, .5}}, .r = {1, .8, .7, .6}, .n = 4};
    for (int i = 0; i < 4; i++) l.clump[i] = 3, l.e[i] = e, l.t[i] = 400, l.power[i] = NAN;
    return l;
}

/* A black dumbbell: its area, and by the mean shadow what it does not see of itself. */
TEST(black_dumbbells) {
    const double d[] = {1.8, 1.5, 1, .8, .5}, self[] = {.0548635, .0327582, .0107708, .0058347, .0015750};
    for (int k = 0; k < 5; k++) {
        struct lumps l = dumbbell(d[k], 1);
        struct solved s;
        solve(&l, &s);
        const double exact = 2 * PI * (2 + d[k]) * (1 - self[k]) * SIGMA * (fourth(300) - fourth(900));
        const double power = of_clump(&l, 7, s.power, false), error = of_clump(&l, 7, s.error, true);
        ck_assert_double_lt(fabs(power / exact - 1), 2e-3);
        ck_assert_double_lt(fabs(power - exact), 2 * error);
    }
}

/* ---- own rays on the union ----------------------------------------------------------------------------------------
 */

/* The first surface that a ray meets: sphere j, or n + a plane; UINT32_MAX: none. */
static uint32_t first_met(const struct lumps *l, uint32_t from, double o[3], const double w[3], double n[3]) {
    uint32_t met = UINT32_MAX;
    double nearest = INFINITY;
    for (uint32_t j = 0; j < l->n; j++) {
        double c[3], b = 0, square = 0;
        for (int k = 0; k < 3; k++) c[k] = l->at[j][k] - o[k], b += c[k] * w[k], square += c[k] * c[k];
        const double root = l->r[j] * l->r[j] - square + b * b;
        if (j == from || root <= 0 || !(b - sqrt(root) > -1e-12) || b - sqrt(root) >= nearest) continue;
        nearest = b - sqrt(root), met = j;
    }
    for (uint32_t k = 0; k < 6 && l->half > 0; k++) {
        const double t = ((k % 2 ? l->half : -l->half) - o[k / 2]) / w[k / 2];
        if ((w[k / 2] > 0) == (k % 2 == 1) && t < nearest) nearest = t, met = l->n + k;
    }
    if (met == UINT32_MAX) return met;
    for (int k = 0; k < 3; k++) o[k] += nearest * w[k];
    for (int k = 0; k < 3; k++) n[k] = met < l->n ? (o[k] - l->at[met][k]) / l->r[met] : 0;
    if (met >= l->n) n[(met - l->n) / 2] = (met - l->n) % 2 ? -1 : 1;
    return met;
}

static void any_direction(fibrad_random *random, double n[3]) {
    const double z = 2 * fibrad_random_next(random) - 1, turn = 2 * PI * fibrad_random_next(random);
    n[0] = sqrt(1 - z * z) * cos(turn), n[1] = sqrt(1 - z * z) * sin(turn), n[2] = z;
}

static void diffuse(fibrad_random *random, const double n[3], double w[3]) {
    double length = 0;
    any_direction(random, w);
    for (int k = 0; k < 3; k++) w[k] += n[k], length += w[k] * w[k];
    for (int k = 0; k < 3; k++) w[k] /= sqrt(length);
}

/* Net power of sphere i, all of whose temperatures are given, by paths that are followed backwards. Points inside other
 * members of its clump have none. */
static double power_by_paths(const struct lumps *l, uint32_t i, uint32_t paths) {
    double sum = 0;
    for (uint32_t k = 0; k < paths; k++) {
        fibrad_random random = fibrad_random_start(i, k);
        double n[3], o[3], w[3];
        bool inside = false;
        any_direction(&random, n);
        for (int a = 0; a < 3; a++) o[a] = l->at[i][a] + l->r[i] * n[a];
        for (uint32_t j = 0; j < l->n; j++) {
            double square = 0;
            for (int a = 0; a < 3; a++) square += (l->at[j][a] - o[a]) * (l->at[j][a] - o[a]);
            inside = inside || (j != i && square < l->r[j] * l->r[j]);
        }
        for (uint32_t at = i; !inside;) {
            diffuse(&random, n, w);
            at = first_met(l, at, o, w, n);
            const double e = at == UINT32_MAX ? 1 : at < l->n ? l->e[at] : l->wall_e[at - l->n];
            const double t = at == UINT32_MAX ? l->around : at < l->n ? l->t[at] : l->wall_t[at - l->n];
            if (fibrad_random_next(&random) >= e) continue;
            sum += fourth(t) - fourth(l->t[i]);
            break;
        }
    }
    return l->e[i] * 4 * PI * l->r[i] * l->r[i] * SIGMA * sum / paths;
}

/* Grey clumps in a grey room with a hot floor, against rays. */
static void assert_by_rays(struct lumps *l, uint32_t clump) {
    struct solved s;
    double exact = 0;
    l->half = 2.5;
    for (uint32_t i = 0; i < l->n; i++) l->t[i] = 400;
    for (int k = 0; k < 6; k++) l->wall_t[k] = k == 4 ? 1300 : 900, l->wall_e[k] = .6;
    solve(l, &s);
    for (uint32_t i = 0; i < l->n; i++) {
        const double own = power_by_paths(l, i, 1000000);
        if (l->clump[i] == clump) exact += own;
    }
    const double power = of_clump(l, clump, s.power, false), error = of_clump(l, clump, s.error, true);
    ck_assert_double_lt(fabs(power / exact - 1), 5e-3);
    ck_assert_double_lt(fabs(power - exact), 2 * error + 2e-3 * fabs(exact));
}

LOOP_TEST(grey_clumps_in_a_room, 4) {
    struct lumps l = _i / 2 ? four(_i % 2 ? .3 : .8) : dumbbell(.8, _i % 2 ? .3 : .8);
    assert_by_rays(&l, l.clump[0]);
}

/* ---- one temperature a clump --------------------------------------------------------------------------------------
 */

/* A dumbbell and a clump of four beside each other in a room, with members of different emissivities. */
static struct lumps two_clumps(void) {
    struct lumps l = dumbbell(.8, .6), other = four(.7);
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) l.at[2 + i][k] = other.at[i][k] - (k == 2 ? .2 : 0);
        l.at[2 + i][1] += 1.6, l.r[2 + i] = other.r[i] * .8, l.clump[2 + i] = 3, l.e[2 + i] = .3 + .2 * i;
        for (int k = 0; k < 3; k++) l.at[2 + i][k] *= k == 1 ? 1 : .8;
    }
    for (int i = 0; i < 2; i++) l.at[i][1] = -1.2, l.e[i] = .4 + .4 * i;
    l.n = 6, l.half = 3, l.around = 300;
    for (int k = 0; k < 6; k++) l.wall_t[k] = 400 + 100 * k, l.wall_e[k] = .7;
    return l;
}

static void set_clump(struct lumps *l, uint32_t clump, double t, double power) {
    for (uint32_t i = 0; i < l->n; i++)
        if (l->clump[i] == clump) l->t[i] = t, l->power[i] = isnan(t) ? power : NAN, power = 0;
}

/* If all is at one temperature nothing flows, to the bit. */
TEST(equal_temperatures) {
    struct lumps l = two_clumps();
    struct solved s;
    l.around = 700;
    set_clump(&l, 7, 700, 0), set_clump(&l, 3, 700, 0);
    for (int k = 0; k < 6; k++) l.wall_t[k] = 700;
    solve(&l, &s);
    for (uint32_t i = 0; i < l.n; i++) ck_assert_double_eq(s.power[i], 0);
    for (int k = 0; k < 6; k++) ck_assert_double_eq(s.wall[k], 0);
}

/* Powers of both clumps at given temperatures. */
static void radiated(struct lumps l, double t7, double t3, double power[2]) {
    struct solved s;
    memset(l.film, 0, sizeof l.film);
    set_clump(&l, 7, t7, 0), set_clump(&l, 3, t3, 0);
    solve(&l, &s);
    power[0] = of_clump(&l, 7, s.power, false), power[1] = of_clump(&l, 3, s.power, false);
}

/* Two clumps that give off powers, with films and contacts: radiation is linear in T^4, so that powers at three pairs
 * of temperatures and Newton's method tell both temperatures. */
TEST(contacts_and_films) {
    const uint32_t first[] = {0, 4, 1, 0, 2}, second[] = {2, 1, 6 + 4, 1, 5};
    const double conductance[] = {3, 5, 2, 1e9, 1e9}; /* the last two are within clumps */
    fibrad_heat_sources more = {
        .contact_first = first, .contact_second = second, .conductance = conductance, .contacts = 5};
    struct lumps l = two_clumps();
    struct solved s;
    double base[2], by[2][2], t[2] = {700, 700}, film[2] = {0, 0}, warmed[2] = {0, 0};
    l.config.directions = 60;
    radiated(l, 600, 600, base), radiated(l, 700, 600, by[0]), radiated(l, 600, 700, by[1]);
    for (int a = 0; a < 2; a++)
        for (int b = 0; b < 2; b++) by[a][b] = (by[a][b] - base[b]) / (fourth(700) - fourth(600));
    set_clump(&l, 7, NAN, 40000), set_clump(&l, 3, NAN, -9000);
    for (uint32_t i = 0; i < l.n; i++) {
        l.film[i] = 2 + i, l.gas[i] = 500 + 20 * i;
        film[l.clump[i] == 3] += l.film[i], warmed[l.clump[i] == 3] += l.film[i] * l.gas[i];
    }
    for (int step = 0; step < 60; step++) {
        double missing[2], slope[2][2];
        for (int b = 0; b < 2; b++) {
            const double wall = b == 0 ? 2 : 0;
            missing[b] = (b == 0 ? 40000 : -9000) + base[b] + warmed[b] - film[b] * t[b] + 8 * (t[1 - b] - t[b]) +
                         wall * (l.wall_t[4] - t[b]);
            for (int a = 0; a < 2; a++) {
                missing[b] += by[a][b] * (fourth(t[a]) - fourth(600));
                slope[b][a] = 4 * by[a][b] * t[a] * t[a] * t[a] + (a == b ? -film[b] - 8 - wall : 8);
            }
        }
        const double det = slope[0][0] * slope[1][1] - slope[0][1] * slope[1][0];
        t[0] -= (missing[0] * slope[1][1] - missing[1] * slope[0][1]) / det;
        t[1] -= (missing[1] * slope[0][0] - missing[0] * slope[1][0]) / det;
    }
    assert_ok(solve_status(&l, &more, &s));
    double sum = s.result.surroundings_power + s.result.gas_power, gas = 0;
    for (uint32_t i = 0; i < l.n; i++) {
        const double own = t[l.clump[i] == 3];
        ck_assert_double_eq_tol(s.t[i], own, 1e-3); /* extrapolation to small patches comes before conduction */
        ck_assert_double_eq(s.t[i], s.t[l.clump[i] == 3 ? 2 : 0]);
        assert_near(s.convected[i], l.film[i] * (l.gas[i] - s.t[i]), 1e-12);
        gas += s.convected[i], sum += s.power[i];
    }
    assert_near(s.conducted[0], 3 * (s.t[2] - s.t[0]), 1e-9);
    assert_near(s.conducted[2], 3 * (s.t[0] - s.t[2]), 1e-9);
    assert_near(-s.result.gas_power, gas, 1e-12);
    assert_near(of_clump(&l, 7, s.power, false), -40000, 1e-10);
    assert_near(of_clump(&l, 3, s.power, false), 9000, 1e-10);
    for (int k = 0; k < 6; k++) sum += s.wall[k];
    ck_assert_double_le(fabs(sum), 1e-8);
}

/* Without contacts and films: a clump of unknown temperature finds that of its surroundings. */
TEST(found_temperatures) {
    struct lumps l = dumbbell(1, .3);
    struct solved s;
    set_clump(&l, 7, NAN, 1000), l.e[1] = 0;
    solve(&l, &s);
    ck_assert_double_eq(s.t[0], s.t[1]);
    ck_assert_double_eq(s.power[1], 0);
    set_clump(&l, 7, NAN, 0), l.e[1] = .9;
    solve(&l, &s);
    ck_assert_double_eq_tol(s.t[0], 300, 1e-9);
    l = two_clumps();
    set_clump(&l, 7, NAN, 5000), set_clump(&l, 3, NAN, 0);
    solve(&l, &s);
    assert_near(of_clump(&l, 7, s.power, false), -5000, 1e-10);
    ck_assert_double_le(fabs(of_clump(&l, 3, s.power, false)), 1e-9);
    for (uint32_t i = 0; i < l.n; i++) ck_assert_double_eq(s.t[i], s.t[l.clump[i] == 3 ? 2 : 0]);
}

TEST(refused) {
    struct lumps l = dumbbell(1, .5);
    struct solved s;
    l.t[1] = 901;
    ck_assert_int_eq(solve_status(&l, NULL, &s), FIBRAD_E_ARGUMENT);
    l.t[1] = NAN, l.power[1] = 0;
    ck_assert_int_eq(solve_status(&l, NULL, &s), FIBRAD_E_ARGUMENT);
    l.t[1] = 900, l.power[1] = NAN;
    const double conductivity[] = {INFINITY, 3}, absorptivity[] = {1, 1};
    const fibrad_light light = {.direction = {0, 0, -1}, .flux = 1};
    fibrad_light_result absorbed = {.absorbed = s.power, .absorbed_first = s.error};
    OWNED_MADE *made = NULL;
    const fibrad_spheres spheres = spheres_of_lumps(&l);
    fibrad_fault fault;
    assert_ok(fibrad_bed_new(&made, NULL, &spheres, NULL));
    ck_assert_int_eq(fibrad_bed_shine(made, &(fibrad_light_sources){&light, 1, absorptivity, NULL, 0}, &absorbed),
                     FIBRAD_E_UNSUPPORTED);
    fibrad_bed_describe(made, NULL, &fault);
    ck_assert_int_eq(fault.why, FIBRAD_WHY_CLUMP_LIGHT);
    ck_assert_int_eq(solve_status(&l, &(fibrad_heat_sources){.conductivity = conductivity}, &s), FIBRAD_E_ARGUMENT);
    assert_ok(solve_status(&l, NULL, &s));
}

/* ---- clumps and all else ------------------------------------------------------------------------------------------
 */

/* A clump is the same across a period and within it. */
TEST(across_a_period) {
    struct solved s[2];
    double power[2], error = 0;
    for (int k = 0; k < 2; k++) {
        struct lumps l = two_clumps();
        for (uint32_t i = 0; i < l.n; i++) l.at[i][0] += 2.6 * k, l.at[i][0] -= l.at[i][0] > 3 ? 6 : 0;
        l.period[0] = 6;
        set_clump(&l, 3, 1500, 0);
        for (int w = 0; w < 4; w++) l.wall_t[w] = 600 + 100 * w;
        solve(&l, &s[k]);
        power[k] = of_clump(&l, 3, s[k].power, false), error = hypot(error, of_clump(&l, 3, s[k].error, true));
    }
    ck_assert_double_le(fabs(power[1] - power[0]), 2 * error);
}

/* Walls of triangles and planes at the same places. */
TEST(beside_meshes) {
    struct lumps l = two_clumps();
    struct solved s, of_mesh;
    OWNED struct mesh *mesh = mesh_new();
    const double low[3] = {-3, -3, -3}, high[3] = {3, 3, 3};
    OWNED_MADE *made = NULL;
    set_clump(&l, 7, 1200, 0), set_clump(&l, 3, 500, 0);
    solve(&l, &s);
    mesh_box(mesh, low, high, 0);
    const fibrad_scene_config config = {.wall = mesh->wall, .walls = 6, .triangles = &mesh->triangles};
    const fibrad_spheres spheres = spheres_of_lumps(&l);
    fibrad_heat_sources sources = sources_of_lumps(&l);
    sources.film = sources.gas = sources.power = NULL;
    of_mesh =
        (struct solved){.result = {.power = of_mesh.power, .power_error = of_mesh.error, .wall_power = of_mesh.wall}};
    assert_ok(made_with(&made, &config, &spheres, NULL, NULL));
    assert_ok(fibrad_bed_solve(made, &sources, NULL, &of_mesh.result));
    double sum = 0, all = 0;
    for (uint32_t clump = 3; clump <= 7; clump += 4) {
        const double change = of_clump(&l, clump, s.power, false) - of_clump(&l, clump, of_mesh.power, false);
        const double error = hypot(of_clump(&l, clump, s.error, true), of_clump(&l, clump, of_mesh.error, true));
        ck_assert_double_le(fabs(change), 2 * error);
    }
    for (uint32_t i = 0; i < l.n; i++) sum += of_mesh.power[i], all += fabs(of_mesh.power[i]);
    for (int k = 0; k < 6; k++) sum += of_mesh.wall[k], all += fabs(of_mesh.wall[k]);
    ck_assert_double_le(fabs(sum), 1e-12 * all);
}

/* A small sphere beside a clump, whose patches are divided there. */
TEST(small_beside_large) {
    struct lumps l = four(.4);
    struct solved s;
    for (int i = 0; i < 4; i++) l.t[i] = 1300;
    l.at[4][0] = -1.12, l.r[4] = .1, l.e[4] = .3, l.t[4] = 400, l.power[4] = NAN, l.n = 5, l.around = 300;
    solve(&l, &s);
    double exact = 0;
    for (uint32_t i = 0; i < 4; i++) exact += power_by_paths(&l, i, 400000);
    const double small = power_by_paths(&l, 4, 400000);
    ck_assert_double_le(fabs(s.power[4] - small), 2 * s.error[4] + 3e-3 * small);
    ck_assert_double_le(fabs(of_clump(&l, 3, s.power, false) - exact),
                        2 * of_clump(&l, 3, s.error, true) + 2e-3 * fabs(exact));
}

/* A sphere that conducts touches a clump. */
TEST(beside_a_conductor) {
    struct lumps l = dumbbell(.8, .6);
    struct solved s;
    const uint32_t first = 2, second = 1;
    const double conductance = 300, conductivity[] = {INFINITY, INFINITY, 5000};
    l.at[2][0] = 2.4, l.r[2] = 1, l.e[2] = .6, l.t[2] = NAN, l.power[2] = 0, l.n = 3;
    l.film[0] = 10, l.gas[0] = 400;
    set_clump(&l, 7, NAN, 60000);
    assert_ok(solve_status(&l,
                           &(fibrad_heat_sources){.contact_first = &first,
                                                  .contact_second = &second,
                                                  .conductance = &conductance,
                                                  .contacts = 1,
                                                  .conductivity = conductivity},
                           &s));
    const double sum = s.power[0] + s.power[1] + s.power[2] + s.result.surroundings_power + s.result.gas_power;
    ck_assert_double_le(fabs(sum), 1e-12 * 60000);
    assert_near(of_clump(&l, 7, s.power, false), -60000, 1e-10);
    ck_assert_double_le(fabs(s.power[2]), 1e-8);
    ck_assert(s.conducted[2] > 0 && s.t[2] < s.t[0] && s.t[2] > 300);
    assert_near(s.conducted[2], -s.conducted[1], 1e-9);
}

/* A clump that reflects all, in two slices of a stream: linear balances. */
TEST(in_a_stream) {
    struct lumps l = dumbbell(1, 0);
    OWNED_MADE *made = NULL;
    const fibrad_spheres spheres = spheres_of_lumps(&l);
    struct solved s = {.result = {.power = s.power, .temperature = s.t, .convected = s.convected}};
    fibrad_heat_sources sources = sources_of_lumps(&l);
    const uint32_t slice[] = {1, 0};
    const double at = 300, capacity = 7, film[] = {3, 5}, power = 2000;
    double gas[2 * FIBRAD_STREAM_ROWS] = {0};
    const fibrad_stream stream = {
        .slice = slice, .at = &at, .capacity = &capacity, .slices = 2, .points = 1, .inlet = 350, .gas = gas};
    sources.stream = &stream, sources.film = film, sources.gas = NULL;
    set_clump(&l, 7, NAN, power);
    assert_ok(made_with(&made, NULL, &spheres, NULL, NULL));
    assert_ok(fibrad_bed_solve(made, &sources, NULL, &s.result));
    /* T - T_gas falls by 1 + film/capacity from slice to slice; all heat leaves with the gas */
    const double first = 1 / (1 + film[1] / capacity), second = first / (1 + film[0] / capacity);
    const double over = power / (film[1] * first + film[0] * second);
    for (int i = 0; i < 2; i++) assert_near(s.t[i], 350 + over, 1e-9);
    assert_near(gas[1], 350 + power / capacity, 1e-9);
    assert_near(s.convected[0], -film[0] * over * second, 1e-9);
    assert_near(s.convected[1], -film[1] * over * first, 1e-9);
}

/* A sphere that lies within a clump has no surface, and changes nothing. */
TEST(covered) {
    struct lumps l = dumbbell(1, .5);
    struct solved s[2];
    solve(&l, &s[0]);
    l.n = 3, l.r[2] = .4, l.at[2][0] = .1, l.clump[2] = 7, l.e[2] = .2, l.t[2] = 900, l.power[2] = NAN;
    solve(&l, &s[1]);
    ck_assert_double_eq(s[1].power[2], 0);
    assert_near(of_clump(&l, 7, s[1].power, false), of_clump(&l, 7, s[0].power, false), 2e-3);
    set_clump(&l, 7, NAN, 100), l.power[2] = 20, l.film[2] = 3, l.gas[2] = 400;
    solve(&l, &s[1]);
    assert_near(s[1].power[0] + s[1].power[1] + s[1].power[2], -120, 1e-10);
    assert_near(s[1].power[2], 3 * (400 - s[1].t[2]), 1e-12);
}

/* A black clump cools to cold surroundings: T^-3 grows evenly. A clump beside another one with a film: own steps. */
TEST(cooling) {
    struct lumps l = dumbbell(1, 1);
    OWNED_MADE *made = NULL;
    const fibrad_spheres spheres = spheres_of_lumps(&l);
    fibrad_heat_sources sources;
    double t[2] = {900, 900}, powers[2], area[2], volume[2], power = 0;
    const double capacity[2] = {4e6, 1e6};
    fibrad_span span = {.temperature = t, .capacity = capacity, .duration = 2000, .tolerance = 1e-6, .power = powers};
    assert_ok(made_with(&made, NULL, &spheres, NULL, NULL));
    assert_ok(fibrad_bed_surfaces(made, area, volume));
    assert_near(area[0] + area[1], 6 * PI, 1e-12);
    assert_near(volume[0] + volume[1], 9. / 4 * PI, 1e-12);
    l.around = 0;
    sources = sources_of_lumps(&l);
    sources.film = sources.gas = NULL, sources.power = NULL;
    struct solved s = {.result = {.power = s.power, .temperature = s.t}};
    assert_ok(fibrad_bed_solve(made, &(fibrad_heat_sources){.temperature = l.t, .emissivity = l.e, .sigma = SIGMA},
                               NULL, &s.result));
    for (int i = 0; i < 2; i++) power -= s.power[i];
    assert_ok(fibrad_bed_advance(made, &sources, &span));
    const double exact = pow(pow(900, -3) + 3 * power / fourth(900) * 2000 / 5e6, -1. / 3);
    ck_assert_double_eq(t[0], t[1]);
    ck_assert_double_eq_tol(t[0], exact, 2e-3);
    assert_near(span.surroundings_energy, 5e6 * (900 - t[0]), 1e-10);
    t[1] += 1;
    ck_assert_int_eq(fibrad_bed_advance(made, &sources, &span), FIBRAD_E_ARGUMENT);
}

/* A clump that melts at one temperature: it stays there until all of it has melted. One that is held stays. */
TEST(melting) {
    struct lumps l = dumbbell(1, 0);
    OWNED_MADE *made = NULL;
    const fibrad_spheres spheres = spheres_of_lumps(&l);
    const double at = 300, c = 500, film[] = {30, 10}, gas[] = {1000, 1000}, power[] = {100, 0};
    const fibrad_store store = {
        .temperature = &at, .capacity = &c, .rows = 1, .melting = 600, .latent = 2e5, .width = 0};
    double t[] = {600, 600}, melted[] = {0, 0}, mass[] = {3, 1};
    fibrad_heat_sources sources = sources_of_lumps(&l);
    fibrad_span span = {.temperature = t, .capacity = mass, .duration = 20, .store = &store, .stores = 1};
    span.melted = melted;
    sources.film = film, sources.gas = gas, sources.power = power;
    assert_ok(made_with(&made, NULL, &spheres, NULL, NULL));
    assert_ok(fibrad_bed_advance(made, &sources, &span));
    for (int i = 0; i < 2; i++) {
        ck_assert_double_eq_tol(t[i], 600, 1e-9);
        assert_near(melted[i], 20 * (40 * 400 + 100) / (4 * 2e5), 1e-9);
    }
    mass[0] = INFINITY;
    ck_assert_int_eq(fibrad_bed_advance(made, &sources, &span), FIBRAD_E_ARGUMENT);
    mass[1] = INFINITY, t[0] = t[1] = 700, melted[0] = melted[1] = NAN;
    assert_ok(fibrad_bed_advance(made, &sources, &span));
    for (int i = 0; i < 2; i++) ck_assert_double_eq(t[i], 700);
}

/* The volume of a clump: a lens counted once; points. */
TEST(volumes) {
    struct lumps l = four(1);
    OWNED_MADE *made = NULL;
    const fibrad_spheres spheres = spheres_of_lumps(&l);
    fibrad_random random = fibrad_random_start(3, 4);
    double volume[4], inside = 0;
    const double points = 1e6;
    assert_ok(fibrad_bed_new(&made, NULL, &spheres, NULL));
    assert_ok(fibrad_bed_surfaces(made, NULL, volume));
    for (double k = 0; k < points; k++) {
        bool in = false;
        double p[3];
        for (int a = 0; a < 3; a++) p[a] = 3 * fibrad_random_next(&random) - 1.5;
        for (int i = 0; i < 4; i++) {
            double square = 0;
            for (int a = 0; a < 3; a++) square += (p[a] - l.at[i][a]) * (p[a] - l.at[i][a]);
            in = in || square < l.r[i] * l.r[i];
        }
        inside += in;
    }
    const double part = inside / points, error = 27 * sqrt(part * (1 - part) / points);
    ck_assert_double_eq_tol(volume[0] + volume[1] + volume[2] + volume[3], 27 * part, 3 * error);
}

/* ---- the program --------------------------------------------------------------------------------------------------
 */

/* Number k of line i of a .csv, both from 0. */
static double column(const char *file, int i, int k) {
    char *at = read_file(file);
    for (int line = 0; line <= i; ++line) ck_assert_ptr_nonnull(at = strchr(at, '\n') + 1);
    for (int c = 0; c < k; ++c) ck_assert_ptr_nonnull(at = strchr(at, ',') + 1);
    return strtod(at, NULL);
}

#define DUMBBELL                                                                                                       \
    "heat", write_file("bed.csv", "x,y,z,r,body,T\n-0.5,0,0,1,12,900\n0.5,0,0,1,12,900\n0,3,0,1,0,700\n"),             \
        "--length-unit", "m", "--clump", "body", "--ambient", "300"

TEST(a_line_a_clump) {
    const char *q = in_folder("q.csv"), *members = in_folder("members.csv"), *vtp = in_folder("q.vtp");
    SUCCEED(DUMBBELL, "--emissivity", "0.8", "--temperature", "T", "-o", q, "-o", vtp);
    assert_begins(read_file(q), "i,T_K,q_W,q_error_W,T_error_K,area_m2,body\n12,900,");
    assert_near(column(q, 0, 5), 6 * PI, 1e-12);
    assert_near(column(q, 1, 5), 4 * PI, 1e-12);
    ck_assert_double_le(fabs(column(q, 0, 2) + column(q, 1, 2) + column(q, 2, 2)), 1e-9);
    assert_has(read_file(vtp), "NumberOfPoints=\"3\"");
    SUCCEED(DUMBBELL, "--emissivity", "0.8", "--temperature", "T", "--members", "-o", members);
    assert_near(column(members, 0, 2) + column(members, 1, 2), column(q, 0, 2), 1e-14);
    assert_near(column(members, 0, 5), 3 * PI, 1e-12);
    SUCCEED(DUMBBELL, "--emissivity", "0", "--temperature", "T", "--until", "1000", "--heat-capacity", "800",
            "--density", "2500", "--convection", "20", "--gas-temperature", "400", "-o", q);
    const double rate = 20 * 6 * PI / (800 * 2500 * 2.25 * PI);
    ck_assert_double_eq_tol(column(q, 0, 2), 400 + 500 * exp(-rate * 1000), .05);
    ck_assert_double_lt(fabs(value_of("balance_of_stored")), 1e-12);
}

TEST(words) {
    const char *bad = write_file("bad.csv", "x,y,z,r,body,T\n0,0,0,1,3,900\n0.5,0,0,1,3,901\n");
#define BLACK "--length-unit", "m", "--ambient", "300", "--emissivity", "1", "--temperature", "T"
#define REFUSE(place, reason, ...)                                                                                     \
    do {                                                                                                               \
        FAIL_WITH(status, __VA_ARGS__);                                                                                \
        expect_message(place, reason);                                                                                 \
    } while (0)
    int status = 3;
    REFUSE(formatted("%s:3", bad), "sphere 1: the members of clump 3 have different temperatures or stores", "heat",
           bad, BLACK, "--clump", "body");
    status = 2;
    REFUSE("--members", "needs --clump", "heat", bad, BLACK, "--members");
    REFUSE("--clump", "leave out --solid-conductivity", "heat", bad, BLACK, "--clump", "body", "--solid-conductivity",
           "3");
    REFUSE("--clump", "light on clumps is not computed", "heat", bad, BLACK, "--clump", "body", "--irradiate",
           "0,0,-1:1000");
}

/* 2,000 settled clumps of three: no powers at equal temperatures. */
TEST(settled_clumps) {
    SUCCEED("heat", "tests/data/clumps2000.dump", "--clump", "id_multisphere", "--length-unit", "m", "--emissivity",
            "0.6", "--temperature", "800", "--ambient", "800", "--directions", "24", "--patches", "24");
    ck_assert_double_eq(value_of("power_largest_W"), 0);
    ck_assert_double_eq(value_of("clumps"), 2000);
}

/* A bed that has moved is that of a new one. */
TEST(moved) {
    struct lumps l = two_clumps();
    OWNED_MADE *made = NULL;
    struct solved now, s = {.result = {.power = s.power, .temperature = s.t}};
    fibrad_spheres spheres = spheres_of_lumps(&l);
    const fibrad_heat_sources sources = {
        .temperature = l.t, .emissivity = l.e, .power = l.power, .sigma = SIGMA, .tolerance = 1e-10};
    l.half = 0;
    set_clump(&l, 7, NAN, 3000), set_clump(&l, 3, 1000, 0);
    assert_ok(fibrad_bed_new(&made, NULL, &spheres, NULL));
    assert_ok(fibrad_bed_solve(made, &sources, NULL, &s.result));
    for (uint32_t i = 0; i < l.n; i++) l.at[i][1] *= l.clump[i] == 3 ? 1 : 1.3;
    assert_ok(fibrad_bed_move(made, NULL, &spheres));
    assert_ok(fibrad_bed_solve(made, &sources, NULL, &s.result));
    l.around = 0;
    solve(&l, &now);
    for (uint32_t i = 0; i < l.n; i++) assert_near(s.power[i], now.power[i], 1e-7), assert_near(s.t[i], now.t[i], 1e-8);
    spheres.clump = NULL, spheres.n = l.n;
    ck_assert_int_ne(fibrad_bed_move(made, NULL, &spheres), FIBRAD_OK);
}
