/* test_clump_heat.c - heat of clumps, bodies of spheres within one another: closed forms, own rays on the union, and an
 * own Newton solution. SPDX-License-Identifier: MIT */
#include "base/random.h"
#include "host_owned.h"
#include "scenes.h"
#include "suite.h"

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
    s.gas = l->gas, s.wall_temperature = l->wall_t, s.wall_emissivity = l->wall_e;
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
    *to = (struct solved){.result = {.power = to->power, .power_error = to->error, .temperature = to->t,
                                     .temperature_error = to->t_error, .wall_power = to->wall,
                                     .wall_error = to->wall_error, .conducted = to->conducted,
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
    for (int i = 0; i < 4; i++) l.clump[i] = 3, l.e[i] = e, l.t[i] = 800, l.power[i] = NAN;
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
        if (getenv("SHOW")) printf("d %.1f %.6f %.6f rel %.2e est %.2e sweeps %u\n", d[k], power, exact, power / exact - 1, error / fabs(exact), s.result.sweeps);
        ck_assert_double_lt(fabs(power / exact - 1), 2e-3);
        ck_assert_double_lt(fabs(power - exact), 2 * error);
    }
}

/* ---- own rays on the union ---------------------------------------------------------------------------------------- */

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
    for (int k = 0; k < 6; k++) l->wall_t[k] = k == 4 ? 1300 : 500, l->wall_e[k] = .6;
    solve(l, &s);
    for (uint32_t i = 0; i < l->n; i++) {
        const double own = power_by_paths(l, i, 600000);
        if (getenv("SHOW")) printf("member %u power %.2f rays %.2f error %.2f\n", i, s.power[i], own, s.error[i]);
        if (l->clump[i] == clump) exact += own;
    }
    const double power = of_clump(l, clump, s.power, false), error = of_clump(l, clump, s.error, true);
    if (getenv("SHOW")) printf("power %.2f rays %.2f rel %.2e est %.2e\n", power, exact, power / exact - 1, error / fabs(exact));
    ck_assert_double_lt(fabs(power / exact - 1), 5e-3);
    ck_assert_double_lt(fabs(power - exact), 2 * error + 2e-3 * fabs(exact));
}

LOOP_TEST(grey_clumps_in_a_room, 4) {
    struct lumps l = _i / 2 ? four(_i % 2 ? .3 : .8) : dumbbell(.8, _i % 2 ? .3 : .8);
    assert_by_rays(&l, l.clump[0]);
}
