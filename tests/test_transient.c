/* test_transient.c - temperatures in time, against closed forms, quadrature and each other.
 * SPDX-License-Identifier: MIT */
#include "host_owned.h"
#include "scenes.h"
#include "suite.h"

#define SIGMA FIBRAD_STEFAN_BOLTZMANN

static fibrad_heat_sources sources_about(const double *emissivity, double surroundings) {
    fibrad_heat_sources sources;
    fibrad_heat_sources_init(&sources);
    sources.emissivity = emissivity;
    sources.surroundings = surroundings;
    return sources;
}

/* A bed with these beams, NULL: the defaults. */
static fibrad_bed *made_of(const struct bed *bed, const fibrad_scene_config *scene, const fibrad_heat_config *beams) {
    const fibrad_spheres spheres = spheres_of(bed);
    fibrad_bed *made;
    assert_ok(made_with(&made, scene, &spheres, beams, NULL));
    return made;
}

/* A law that changes nothing, so that patches serve alone. */
static void keep_surfaces(void *context, const double *temperature, const double *wall_temperature, double *emissivity,
                          double *wall_emissivity) {
    (void)context, (void)temperature, (void)wall_temperature, (void)emissivity, (void)wall_emissivity;
}

static fibrad_law by_patches = {.follow = keep_surfaces};

/* The time in which a wall of loss factor a = A e sigma/C goes from T0 to T in black surroundings at Ts. */
static double time_between(double a, double from, double to, double ts) {
    const double turn = 2 * (atan(to / ts) - atan(from / ts));
    return (log(fabs((to + ts) / (to - ts))) - log(fabs((from + ts) / (from - ts))) + turn) / (4 * a * ts * ts * ts);
}

/* Finds the temperature after a time, by bisection. */
static double temperature_after(double a, double from, double ts, double time) {
    double low = fmin(from, ts), high = fmax(from, ts);
    for (int k = 0; k < 200; k++) {
        const double middle = (low + high) / 2;
        const bool later = time_between(a, from, middle, ts) > time;
        if (later == (from > ts))
            low = middle;
        else
            high = middle;
    }
    return (low + high) / 2;
}

/* One sphere in black surroundings cools or heats with automatic steps, in spans of any length. */
TEST(one_sphere_cools) {
    static const double begin[] = {1500, 300, 310}, around[] = {300, 1500, 300};
    const double r = .01, eps = .7, capacity = 25;
    OWNED_BED bed = BED({0, 0, 0, r});
    OWNED_MADE *t = made_of(&bed, NULL, NULL);
    const double a = 4 * PI * r * r * eps * SIGMA / capacity;
    for (int k = 0; k < 3; k++) {
        const fibrad_heat_sources sources = sources_about(&eps, around[k]);
        const double unit = 1 / (a * pow(fmax(begin[k], around[k]), 3));
        double temperature = begin[k], time = 0;
        for (int part = 0; part < 10; part++) {
            fibrad_span span = {&temperature, &capacity, .duration = unit * pow(10, part / 4. - 1)};
            assert_ok(fibrad_bed_advance(t, &sources, &span));
            time += span.duration;
            const double expected = temperature_after(a, begin[k], around[k], time);
            ck_assert_double_le(fabs(temperature - expected), 1e-4 * expected);
            ck_assert_uint_lt(span.steps, 120);
        }
    }
}

/* Errors at steps of h, h/2 and h/4 are in proportion to 16, 4 and 1. */
TEST(second_order) {
    const double r = .01, eps = .7, capacity = 25, a = 4 * PI * r * r * eps * SIGMA / capacity;
    OWNED_BED bed = BED({0, 0, 0, r});
    OWNED_MADE *t = made_of(&bed, NULL, NULL);
    const fibrad_heat_sources sources = sources_about(&eps, 300);
    const double duration = .5 / (a * pow(1200, 3)), expected = temperature_after(a, 1200, 300, duration);
    double error[4];
    for (int k = 0; k < 4; k++) {
        double temperature = 1200;
        fibrad_span span = {&temperature, &capacity, .duration = duration, .step = duration / (16 << k),
                            .tolerance = 1e-9};
        assert_ok(fibrad_bed_advance(t, &sources, &span));
        ck_assert_uint_eq(span.steps, 16u << k);
        error[k] = fabs(temperature - expected);
    }
    for (int k = 0; k < 3; k++) ck_assert_double_eq_tol(error[k] / error[k + 1], 4, .3);
    ck_assert_double_lt(error[3], 1e-2);
}

/* The emissivity T/2000. Counts its calls. */
static void proportional(void *calls, const double *temperature, const double *wall_temperature, double *emissivity,
                         double *wall_emissivity) {
    (void)wall_temperature;
    (void)wall_emissivity;
    emissivity[0] = temperature[0] / 2000;
    ++*(int *)calls;
}

/* The emissivity T/2000 belongs to surroundings at 0 K: 1/T^4 grows by 4 A sigma/(2000 C) a second. Steps are
 * automatic, or show the second order. */
TEST(emissivity_follows) {
    const double r = .01, capacity = 25, first = .6, rate = 4 * PI * r * r * SIGMA / (2000 * capacity);
    const double duration = 2 / (4 * rate * pow(1200, 4)), expected = pow(pow(1200, -4) + 4 * rate * duration, -.25);
    OWNED_BED bed = BED({0, 0, 0, r});
    OWNED_MADE *t = made_of(&bed, NULL, NULL);
    const fibrad_heat_sources sources = sources_about(&first, 0);
    double error[3];
    int calls = 0;
    fibrad_law law = {.follow = proportional, .context = &calls};
    for (int k = 0; k < 4; k++) {
        double temperature = 1200;
        fibrad_span span = {&temperature,
                            &capacity,
                            .duration = duration,
                            .step = k < 3 ? duration / (32 << k) : 0,
                            .tolerance = k < 3 ? 1e-11 : 0,
                            .law = &law};
        assert_ok(fibrad_bed_advance(t, &sources, &span));
        ck_assert_int_gt(calls, 0);
        ck_assert_double_le(fabs(capacity * (1200 - temperature) - span.surroundings_energy), 1e-12 * capacity * 1200);
        if (k < 3) error[k] = fabs(temperature - expected);
        if (k == 3) ck_assert_double_le(fabs(temperature - expected), 1e-4 * expected);
    }
    for (int k = 0; k < 2; k++) ck_assert_double_eq_tol(error[k] / error[k + 1], 4, .6);
}

/* A bed on a hot floor, under a roof, and periodic sideways. */
enum { N = 60 };
struct furnace {
    struct bed bed;
    fibrad_wall wall[2];
    fibrad_scene_config scene;
    double temperature[N], emissivity[N], capacity[N], power[N], wall_heat[2], wall_emissivity[2];
    fibrad_heat_sources sources;
};

static void furnace_free(struct furnace *f) { bed_free(&f->bed); }

static void furnace_init(struct furnace *f) {
    f->bed = packing(N, .8, 1.2, .5, 3, true);
    f->bed.period[2] = 0;
    double low = INFINITY, high = -INFINITY;
    for (int i = 0; i < N; i++) {
        low = fmin(low, f->bed.z[i] - f->bed.r[i]), high = fmax(high, f->bed.z[i] + f->bed.r[i]);
        f->temperature[i] = 600 + 10 * i, f->emissivity[i] = .3 + .01 * i;
        f->capacity[i] = 1e5 * pow(f->bed.r[i], 3);
        f->power[i] = i % 7 == 0 ? 2e4 : 0;
    }
    f->wall[0] = plane_at(2, 0, low), f->wall[1] = plane_at(2, 1, high + 1);
    f->scene = (fibrad_scene_config){.period = {f->bed.period[0], f->bed.period[1], 0}, .wall = f->wall, .walls = 2};
    f->wall_heat[0] = 1200, f->wall_heat[1] = 500, f->wall_emissivity[0] = .8, f->wall_emissivity[1] = .4;
    f->sources = sources_about(f->emissivity, 300);
    f->sources.power = f->power;
    f->sources.wall_temperature = f->wall_heat, f->sources.wall_emissivity = f->wall_emissivity;
}

/* What spheres lose, less their powers, is what walls and surroundings get. This holds by factors and by patches, at
 * loose and at tight tolerances, with long and with short steps. */
TEST(energy_is_kept) {
    OWNED_BY(furnace_free) struct furnace f;
    furnace_init(&f);
    for (int patches = 0; patches < 2; patches++) {
        OWNED_MADE *t = made_of(&f.bed, &f.scene, &(fibrad_heat_config){.directions = 16, .patches = 24});
        for (int k = 0; k < 3; k++) {
            double temperature[N], energy[2], balance = 0, exchanged = 0;
            memcpy(temperature, f.temperature, sizeof temperature);
            fibrad_span span = {temperature, f.capacity, .duration = k == 2 ? 400 : 20, .wall_energy = energy};
            span.law = patches ? &by_patches : NULL;
            span.tolerance = k == 0 ? 1e-2 : 1e-3, span.step = k == 2 ? 200 : 0;
            f.sources.tolerance = 1e-2;
            assert_ok(fibrad_bed_advance(t, &f.sources, &span));
            for (int i = 0; i < N; i++) {
                const double change = f.capacity[i] * (temperature[i] - f.temperature[i]);
                balance += change - span.duration * f.power[i];
                exchanged += fabs(change);
            }
            balance += energy[0] + energy[1] + span.surroundings_energy;
            ck_assert_double_lt(fabs(balance), 1e-12 * exchanged);
        }
    }
}

/* The slopes for Runge and Kutta's explicit scheme, from the factors themselves. */
static void slopes(const struct furnace *f, const fibrad_factors *d, double time, double duration, const double *t,
                   double *slope) {
    const double floor = SIGMA * pow(f->wall_heat[0] + (800 - f->wall_heat[0]) * time / duration, 4);
    const double roof = SIGMA * pow(f->wall_heat[1], 4), sky = SIGMA * pow(300, 4);
    double emits[N];
    for (int i = 0; i < N; i++) emits[i] = SIGMA * pow(t[i], 4);
    for (int i = 0; i < N; i++) {
        const double own = emits[i];
        double sum = d->escaped[i] * (sky - own) + d->wall[2 * i] * (floor - own) + d->wall[2 * i + 1] * (roof - own);
        for (uint64_t k = d->start[i]; k < d->start[i + 1]; k++) sum += d->f[k] * (emits[d->col[k]] - own);
        slope[i] = (f->power[i] + 4 * PI * f->bed.r[i] * f->bed.r[i] * f->emissivity[i] * sum) / f->capacity[i];
    }
}

static void runge_kutta(const struct furnace *f, const fibrad_factors *d, double duration, int steps, double *t) {
    const double h = duration / steps;
    double k[4][N], at[N];
    for (int step = 0; step < steps; step++) {
        for (int stage = 0; stage < 4; stage++) {
            const double share = stage == 0 ? 0 : stage == 3 ? 1 : .5;
            for (int i = 0; i < N; i++) at[i] = t[i] + (stage > 0 ? share * h * k[stage - 1][i] : 0);
            slopes(f, d, (step + share) * h, duration, at, k[stage]);
        }
        for (int i = 0; i < N; i++) t[i] += h / 6 * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]);
    }
}

/* Powers are given, and a wall cools while the spheres do. The powers at the end belong to the temperatures. Factors
 * err by some percent of the differences that they carry. */
TEST(bed_against_runge_kutta) {
    OWNED_BY(furnace_free) struct furnace f;
    furnace_init(&f);
    const fibrad_exchange_rule rule = {
        .emissivity = f.emissivity, .wall_emissivity = f.wall_emissivity, .tolerance = .002};
    const fibrad_spheres spheres = spheres_of(&f.bed);
    const double end[2] = {800, f.wall_heat[1]}, duration = 30;
    OWNED_FACTORS *factors = NULL;
    assert_ok(exchange_of(&f.scene, &spheres, &rule, NULL, NULL, &factors));
    double expected[N], temperature[N], power[N], last[N];
    memcpy(expected, f.temperature, sizeof expected);
    memcpy(temperature, f.temperature, sizeof temperature);
    runge_kutta(&f, &factors->matrix, duration, 1000, expected);
    OWNED_MADE *t = made_of(&f.bed, &f.scene, NULL);
    fibrad_span span = {temperature, f.capacity, duration, .wall_temperature = end, .power = power};
    assert_ok(fibrad_bed_advance(t, &f.sources, &span));
    ck_assert_uint_gt(span.corrections, 0);
    fibrad_heat_sources now = f.sources;
    now.temperature = temperature, now.wall_temperature = end, now.power = NULL;
    assert_ok(fibrad_bed_solve(t, &now, NULL, &(fibrad_heat_result){.power = last, .wall_power = (double[2]){0}}));
    double square = 0, off = 0;
    for (int i = 0; i < N; i++) {
        ck_assert_double_le(fabs(temperature[i] - expected[i]), 6e-3 * expected[i]);
        square += last[i] * last[i], off += (power[i] - last[i]) * (power[i] - last[i]);
    }
    ck_assert_double_lt(off, .02 * .02 * square);
}

/* A mote between two large spheres follows them at once. The steps are those of the large spheres. */
TEST(motes_are_no_limit) {
    enum { MOTE = 2 };
    static const double place[][4] = {{0, 0, 0, 1}, {3, 0, 0, 1}, {1.5, 0, 0, 1e-3}, {1.5, .1, 0, 1e-2}};
    const double emissivity[] = {.8, .6, .5, .5};
    uint64_t steps[2] = {0, 0};
    for (uint32_t n = 2; n <= 4; n += 2) {
        OWNED_BED bed = bed_of(n, place);
        OWNED_MADE *t = made_of(&bed, NULL, &(fibrad_heat_config){.directions = 2000});
        double temperature[] = {1200, 900, 300, 300}, capacity[4], power[4] = {0};
        for (uint32_t i = 0; i < n; i++) capacity[i] = 3e6 * 4 / 3 * PI * pow(bed.r[i], 3);
        const fibrad_heat_sources sources = sources_about(emissivity, 400);
        fibrad_span span = {temperature, capacity, .duration = 1e5, .power = power};
        assert_ok(fibrad_bed_advance(t, &sources, &span));
        for (int k = 0; k < 5; k++) { /* the motes are warm, and follow the slow change of the others */
            assert_ok(fibrad_bed_advance(t, &sources, &span));
            steps[n == 4] += span.steps + span.refused;
            const double emitted = 4 * PI * 1e-6 * .5 * SIGMA * pow(temperature[MOTE], 4);
            if (n == 4) ck_assert_double_lt(fabs(power[MOTE]), 2e-3 * emitted);
        }
    }
    ck_assert_uint_le(steps[1], steps[0] + 2);
}

/* A sphere that reflects all light has its power and nothing else. If power is drawn from it, it becomes as cold as
 * possible. */
TEST(powers_alone) {
    OWNED_BED bed = BED({0, 0, 0, 1}, {3, 0, 0, 1});
    const double capacity[] = {2, 4}, power[] = {10, -20}, emissivity[] = {0, 0};
    double temperature[] = {300, 300};
    fibrad_heat_sources sources = sources_about(emissivity, 1000);
    sources.power = power;
    OWNED_MADE *t = made_of(&bed, NULL, NULL);
    fibrad_span span = {temperature, capacity, .duration = 20};
    assert_ok(fibrad_bed_advance(t, &sources, &span));
    ck_assert_double_eq_tol(temperature[0], 400, 1e-9);
    ck_assert_double_eq_tol(temperature[1], 200, 1e-9);
    span.duration = 50;
    ck_assert_int_eq(fibrad_bed_advance(t, &sources, &span), FIBRAD_E_UNSOLVABLE);
    ck_assert_double_eq_tol(temperature[0], 400, 1e-9);
}

/* Patches give what corrected factors give, with a move in between. */
TEST(patches_as_factors) {
    OWNED_BY(furnace_free) struct furnace f;
    furnace_init(&f);
    double temperature[2][N];
    for (int patches = 0; patches < 2; patches++) {
        OWNED_MADE *t = made_of(&f.bed, &f.scene, NULL);
        memcpy(temperature[patches], f.temperature, sizeof f.temperature);
        for (int k = 0; k < 2; k++) {
            fibrad_span span = {temperature[patches], f.capacity, .duration = 20, .tolerance = 1e-3};
            span.law = patches ? &by_patches : NULL;
            assert_ok(fibrad_bed_advance(t, &f.sources, &span));
            ck_assert((span.corrections > 0) == !patches);
            for (int i = 0; i < N; i++) f.bed.z[i] += k == 0 ? .5 : -.5;
            const fibrad_spheres spheres = spheres_of(&f.bed);
            assert_ok(fibrad_bed_move(t, &f.scene, &spheres));
        }
    }
    for (int i = 0; i < N; i++) ck_assert_double_eq_tol(temperature[0][i], temperature[1][i], 1);
}

/* Two steps at the same positions go by patches. Further ones go by factors, in the same span or in the next. */
TEST(factors_come_with_the_third_step) {
    OWNED_BY(furnace_free) struct furnace f;
    furnace_init(&f);
    OWNED_MADE *t = made_of(&f.bed, &f.scene, &(fibrad_heat_config){.directions = 16, .patches = 24});
    const fibrad_spheres spheres = spheres_of(&f.bed);
    for (int moved = 0; moved < 2; moved++) {
        for (int k = 0; k < 4; k++) {
            double temperature[N];
            memcpy(temperature, f.temperature, sizeof temperature);
            fibrad_span span = {temperature, f.capacity, .duration = 1, .step = 1};
            assert_ok(fibrad_bed_advance(t, &f.sources, &span));
            ck_assert_int_eq(span.corrections > 0, k == 2);
        }
        assert_ok(fibrad_bed_move(t, &f.scene, &spheres));
    }
}

enum { STACK = 18 };

/* Temperatures of spheres in a grey room after some time. residual: of the solutions. */
static void warm_stack(double residual, double temperature[STACK], fibrad_span *span) {
    const fibrad_heat_config config = {.directions = 12, .patches = 24, .wall_rays = 2000};
    double emissivity[STACK], capacity[STACK], wall_temperature[6], wall_emissivity[6];
    OWNED_BED bed = bed_empty();
    for (int i = 0; i < STACK; i++) {
        add_sphere(&bed, 2.3 * (i % 3), 2.3 * (i / 3 % 3), 2.3 * (i / 9), .9);
        emissivity[i] = .3 + .03 * i, capacity[i] = 2 + i, temperature[i] = 400 + 50 * i;
    }
    fibrad_wall wall[6];
    for (int k = 0; k < 6; k++) {
        wall[k] = plane_at(k / 2, k % 2, k % 2 ? k < 4 ? 5.9 : 3.6 : -1.3);
        wall_temperature[k] = 300 + 200 * k, wall_emissivity[k] = .2 + .1 * k;
    }
    const fibrad_scene_config scene = {.wall = wall, .walls = 6};
    const fibrad_spheres spheres = spheres_of(&bed);
    OWNED_MADE *t;
    assert_ok(made_with(&t, &scene, &spheres, &config, &(fibrad_run){.threads = 1}));
    fibrad_heat_sources sources = sources_about(emissivity, 300);
    sources.wall_temperature = wall_temperature, sources.wall_emissivity = wall_emissivity;
    sources.tolerance = residual;
    *span = (fibrad_span){.temperature = temperature, .capacity = capacity, .duration = .005, .law = &by_patches};
    assert_ok(fibrad_bed_advance(t, &sources, span));
}

/* Residuals of the solutions are so small that they refuse no step. */
TEST(residuals_refuse_no_step) {
    double found[STACK], right[STACK];
    fibrad_span rough, exact;
    warm_stack(0, found, &rough), warm_stack(1e-8, right, &exact);
    ck_assert_msg(rough.refused <= exact.refused + 1, "%d of %d steps", (int)rough.refused, (int)rough.steps);
    ck_assert_uint_lt(rough.sweeps, exact.sweeps);
    for (int i = 0; i < STACK; i++) ck_assert_double_eq_tol(found[i] / right[i], 1, 1e-4);
}

/* Any number of threads gives the same bits. */
TEST(threads_change_nothing) {
    OWNED_BY(furnace_free) struct furnace f;
    furnace_init(&f);
    const fibrad_spheres spheres = spheres_of(&f.bed);
    double first[N];
    for (int threads = 1; threads < 5; threads += 3) {
        fibrad_run run = {.threads = threads};
        OWNED_MADE *t = NULL;
        double temperature[N];
        memcpy(temperature, f.temperature, sizeof temperature);
        fibrad_span span = {temperature, f.capacity, .duration = 20};
        assert_ok(made_with(&t, &f.scene, &spheres, NULL, &run));
        assert_ok(fibrad_bed_advance(t, &f.sources, &span));
        if (threads == 1) memcpy(first, temperature, sizeof first);
        ck_assert_mem_eq(first, temperature, sizeof first);
    }
}

TEST(what_is_refused) {
    OWNED_BY(furnace_free) struct furnace f;
    furnace_init(&f);
    const fibrad_spheres spheres = spheres_of(&f.bed), fewer = {f.bed.x, f.bed.y, f.bed.z, f.bed.r, N - 1, .id = NULL};
    fibrad_bed *t;
    fibrad_fault fault;
    const fibrad_span good = {f.temperature, f.capacity, .duration = 1e-3};
    fibrad_span span = good;
    t = made_of(&f.bed, &f.scene, NULL);
    assert_invalid(fibrad_bed_move(t, &f.scene, &fewer));
    assert_invalid(fibrad_bed_move(t, NULL, &spheres));
    static const double bad[] = {0, -1, NAN, INFINITY};
    for (int k = 0; k < 4; k++) {
        double kept = f.capacity[7];
        f.capacity[7] = k < 3 ? bad[k] : 1e301; /* infinite: held */
        assert_invalid(fibrad_bed_advance(t, &f.sources, &span));
        fibrad_bed_describe(t, NULL, &fault);
        ck_assert_uint_eq(fault.first, 7);
        f.capacity[7] = kept, kept = f.temperature[5], f.temperature[5] = bad[k];
        assert_invalid(fibrad_bed_advance(t, &f.sources, &span));
        fibrad_bed_describe(t, NULL, &fault);
        ck_assert_uint_eq(fault.first, 5);
        f.temperature[5] = kept, span.duration = bad[k];
        assert_invalid(fibrad_bed_advance(t, &f.sources, &span));
        span = good;
    }
    f.sources.surroundings = NAN;
    assert_invalid(fibrad_bed_advance(t, &f.sources, &span));
    f.sources.surroundings = 300;
    assert_ok(fibrad_bed_advance(t, &f.sources, &span));
    fibrad_bed_free(t);
    fibrad_bed_free(NULL);
}
