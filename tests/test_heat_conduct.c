/* test_heat_conduct.c - spheres that conduct, against closed forms and against themselves.
 * SPDX-License-Identifier: MIT */
#include "patches/subdivision.h"
#include "fibrad_light.h"
#include "heat_problem.h"

/* Results for the inside of spheres, for beds of up to MOST spheres. */
enum { MOST = 64 };
static double least[MOST], largest[MOST], centre[MOST], surface_error[MOST], found[MOST];
static double conductivity[MOST], power[MOST];

/* Makes all spheres of a problem conduct: k* at temperature t, sigma being 1. */
static void conduct(struct problem *p, double k_star, double t) {
    ck_assert_uint_le(p->bed.n, MOST);
    for (uint32_t i = 0; i < p->bed.n; i++) conductivity[i] = k_star * 8 * p->bed.r[i] * t * t * t;
    p->sources.conductivity = conductivity;
    p->result.temperature = found;
    p->result.least_temperature = least, p->result.largest_temperature = largest;
    p->result.centre_temperature = centre, p->result.surface_error = surface_error;
}

/* Asks for the temperatures of all spheres, each of which gives off this power. */
static void find_temperatures(struct problem *p, double each) {
    for (uint32_t i = 0; i < p->bed.n; i++) p->temperature[i] = NAN, power[i] = each;
    p->sources.power = power;
}

static struct problem one_sphere(double r, double temperature, double emissivity) {
    return problem_of(BED({0, 0, 0, r}), temperature, emissivity);
}

/* Legendre polynomials of degrees 0 to 40 at x. */
enum { DEGREES = 40 };
static void legendre(double x, double value[DEGREES + 1]) {
    value[0] = 1, value[1] = x;
    for (int l = 1; l < DEGREES; l++) value[l + 1] = ((2 * l + 1) * x * value[l] - l * value[l - 1]) / (l + 1);
}

/* The mean over an own patch of a sphere of Legendre's polynomials of the cosine to an axis. */
static void patch_means(const struct problem *p, uint32_t patch, int axis, double mean[DEGREES + 1]) {
    const fibrad_heat_four four = {.own = patch / 4};
    double sum = 0;
    memset(mean, 0, (DEGREES + 1) * sizeof *mean);
    for (int k = 0; k < 64; k++) {
        double at[3], normal[3], value[DEGREES + 1];
        const double w = fibrad_heat_fine_point(p->heat, &four, .5 * (patch >> 1 & 1) + (k / 8 + .5) / 16,
                                                .5 * (patch & 1) + (k % 8 + .5) / 16, at, normal);
        legendre(normal[axis], value);
        sum += w;
        for (int l = 0; l <= DEGREES; l++) mean[l] += w * value[l];
    }
    for (int l = 0; l <= DEGREES; l++) mean[l] /= sum;
}

/* The part of degree 1 of sphere 0's radiosity along an axis. */
static double slope_along(const struct problem *p, int axis) {
    double sum = 0, squares = 0;
    for (uint32_t a = p->heat->first[0]; a < p->heat->first[0] + p->heat->config.patches; a++) {
        double mean[DEGREES + 1];
        patch_means(p, a - p->heat->first[0], axis, mean);
        sum += p->heat->solution.area[a] * mean[1] * p->heat->solution.radiosity[a];
        squares += p->heat->solution.area[a] * mean[1] * mean[1];
    }
    return sum / squares;
}

/* Between black plates irradiation is of degrees 0 and 1 alone: half of E1 + E2, and half of E1 - E2 times the
 * cosine. */
static const double plates_k[] = {.01, .3, 1, 100}, plates_e[] = {1, 1, .5, .9};
LOOP_TEST(a_sphere_between_black_plates, 4) {
    OWNED_PROBLEM p = one_sphere(.5, NAN, plates_e[_i]);
    const double a = plates_e[_i] / (2 * plates_k[_i]), hot = 1.0005, cold = .9995;
    const double half = (emission(hot) - emission(cold)) / 2, truth = a / (a + 1) * half;
    p.walls = (struct walls){.planes = 48, .at = {0, 0, 0, 0, -1, 1}};
    p.wall_temperature[4] = hot, p.wall_temperature[5] = cold;
    p.sources.surroundings = 1, p.sources.tolerance = 1e-8;
    p.config.directions = 2000;
    conduct(&p, plates_k[_i], 1);
    find_temperatures(&p, 0);
    trace_and_solve(&p);
    /* the sphere sends back the irradiation less w = E/(a/e) */
    const double sent = half - truth / (a / plates_e[_i]);
    assert_near(-slope_along(&p, 2) * (truth / sent), truth, 1e-3);
    ck_assert_double_le(fabs(slope_along(&p, 0)), 1e-2 * sent);
    assert_near(largest[0] - found[0], truth / 4, .03);
    assert_near(found[0] - least[0], truth / 4, .03);
    ck_assert_double_le(fabs(largest[0] - found[0] - truth / 4), 2 * surface_error[0]);
    assert_near(found[0], 1, 1e-6);
    ck_assert_double_eq(centre[0], found[0]);
}

/* The light at the place at cosine mu of a unit sphere from a black sphere of emission 1. This sphere has a radius, and
 * its centre lies at a distance on the axis. The light is a sum over rays to its disc as seen from the place, as far as
 * they are above the horizon. */
static double lit(double mu, double radius, double distance) {
    const double x = -sqrt(1 - mu * mu), z = distance - mu, s = sqrt(x * x + z * z), sine = radius / s;
    const double along = (x * sqrt(1 - mu * mu) + z * mu) / s, across = sqrt(fmax(0, 1 - along * along));
    double sum = 0;
    for (int k = 0; k < 100; k++)
        for (int m = 0; m < 100; m++) {
            const double t = sine * sqrt((k + .5) / 100), turn = 2 * PI * (m + .5) / 100;
            sum += fmax(0, sqrt(1 - t * t) * along + t * across * cos(turn)) / sqrt(1 - t * t);
        }
    return sine * sine * sum / 10000;
}

/* Finds the coefficients of Legendre's polynomials in the light that arrives. */
static void expand(double radius, double distance, double coefficient[DEGREES + 1]) {
    enum { POINTS = 2000 };
    memset(coefficient, 0, (DEGREES + 1) * sizeof *coefficient);
    for (int k = 0; k < POINTS; k++) {
        const double mu = -1 + (2 * k + 1.0) / POINTS, h = lit(mu, radius, distance);
        double value[DEGREES + 1];
        legendre(mu, value);
        for (int l = 0; l <= DEGREES; l++) coefficient[l] += (l + .5) * h * value[l] * 2 / POINTS;
    }
}

/* A hot sphere lights one side of a cold one. What the cold one sends out from patch to patch is the series. */
static const double half_k[] = {.01, .1, 1, 10}, half_e[] = {1, .7, 1, .3};
LOOP_TEST(one_side_lit, 4) {
    const double k = half_k[_i], e = half_e[_i], radius = 3, distance = 6;
    OWNED_PROBLEM p = problem_of(BED({0, 0, 0, 1}, {0, 0, distance, radius}), 1, 1);
    double h[DEGREES + 1], squares = 0, errors = 0;
    p.emissivity[0] = e, p.temperature[0] = NAN;
    p.sources.power = (const double[]){0, NAN}, p.sources.tolerance = 1e-7;
    p.config.directions = 10000, p.config.points = 256;
    conduct(&p, k, 1);
    conductivity[1] = INFINITY;
    trace_and_solve(&p);
    const double k_star = k / (found[0] * found[0] * found[0]);
    expand(radius, distance, h);
    for (uint32_t a = 0; a < p.heat->config.patches; a++) {
        double value[DEGREES + 1], sent = h[0];
        patch_means(&p, a, 2, value);
        for (int l = 1; l <= DEGREES; l++) sent += h[l] * value[l] * (1 - 1 / (1 / e + 1 / (2 * k_star * l)));
        const double area = p.heat->solution.area[a], error = p.heat->solution.radiosity[a] - sent;
        errors += area * error * error, squares += area * sent * sent;
    }
    ck_assert_double_le(sqrt(errors / squares), 1e-2);
    assert_near(emission(found[0]), h[0], 3e-3);
}

/* Two spheres that nearly touch: the hottest place of the colder one, sphere 0, faces sphere 1. The numbers are from
 * rings of both spheres with Legendre series to degree 6000, to .1 %. */
static const struct nearly_touching {
    double radius, distance, emissivity[2], k_star[2], temperature[2], largest, around;
} nearly_touching[] = {
    {1, 2.001, {.8, .8}, {.01, .01}, {.7, 1.5}, 10.4173, .3},
    {1. / 3, 1 + 1.01 / 3, {.8, .8}, {1, 1}, {.7, 1.5}, .95252, .3},
    {.05, 1.0505, {.3, .3}, {.013, .013}, {.7, 1.5}, 1.37645, .3},
    {.05, 1.055, {.8, .8}, {.1, 1}, {.7, 1.5}, 1.08245, .3},
    {.2, 1.22, {.5, 1}, {.1, .03}, {.7, 1.5}, 1.74539, .3},
    {.5, 1.505, {1, .5}, {.03, .3}, {.7, 1.5}, 3.01366, .3},
    {.2, 1.202, {.8, 1}, {.132266, 1.3e7}, {1, 1.2}, 1.14268, 0},
};
/* The hottest place of the hotter sphere, which is a twentieth of the other, faces it as well. */
TEST(the_small_sphere_beside_a_large_one) {
    OWNED_PROBLEM p = problem_of(BED({0, 0, 0, 1}, {.2 * 1.0505, .3 * 1.0505, -.9327379053 * 1.0505, .05}), .7, .3);
    p.temperature[1] = 1.5, p.sources.surroundings = .3;
    conduct(&p, 1, 1);
    for (int i = 0; i < 2; i++)
        conductivity[i] = .013 * 8 * p.bed.r[i] * p.temperature[i] * p.temperature[i] * p.temperature[i];
    trace_and_solve(&p);
    assert_near(largest[1] - 1.5, 1.68910 - 1.5, .03);
}

LOOP_TEST(the_hottest_place_faces_a_neighbour, 7) {
    const struct nearly_touching *t = &nearly_touching[_i];
    static const double axis[3] = {.36, .48, -.8};
    const double d = t->distance;
    OWNED_PROBLEM p = problem_of(BED({0, 0, 0, 1}, {d * axis[0], d * axis[1], d * axis[2], t->radius}), 1, 1);
    conduct(&p, 1, 1);
    for (int i = 0; i < 2; i++) {
        const double at = p.temperature[i] = t->temperature[i];
        p.emissivity[i] = t->emissivity[i];
        conductivity[i] = t->k_star[i] * 8 * p.bed.r[i] * at * at * at;
    }
    p.sources.surroundings = t->around;
    trace_and_solve(&p);
    const double error = largest[0] - t->largest;
    ck_assert_double_le(fabs(error), .03 * (t->largest - t->temperature[0]));
    ck_assert_double_le(fabs(error), 2 * surface_error[0]);
    ck_assert_double_le(surface_error[0], .08 * (t->largest - t->temperature[0]));
}

/* The light on all patches: parallel light down z, of flux 1. */
static double *shine_down(const struct problem *p) {
    const fibrad_light light = {.direction = {0, 0, -1}, .flux = 1};
    OWNED_WORK work = work_growing();
    double *hits = calloc(fibrad_heat_patches(p->heat), sizeof *hits);
    for (uint32_t task = 0; task < fibrad_heat_shine_tasks(p->heat); task++) {
        fibrad_light_ends kept;
        assert_ok(fibrad_heat_shine(p->heat, &work, &light, task, hits, &kept, NULL));
    }
    return hits;
}

/* A sphere that absorbs parallel light and gives it off to nothing. In degree l its emission is u c/(1 + e u), with u
 * = 1/(2 k* l) and c of what it absorbs, which is the cosine on the lit half. */
LOOP_TEST(parallel_light_from_one_side, 4) {
    enum { POINTS = 20000 };
    const double k = half_k[_i], e = half_e[_i], t = pow(1 / (4 * e), .25);
    OWNED_PROBLEM p = one_sphere(.7, NAN, e);
    double emitted[DEGREES + 1] = {0}, value[DEGREES + 1], squares = 0, errors = 0, top = 0, bottom = 0;
    for (int n = 0; n < POINTS; n++) {
        legendre((n + .5) / POINTS, value);
        for (int l = 0; l <= DEGREES; l++) emitted[l] += (l + .5) * (n + .5) / POINTS * value[l] / POINTS;
    }
    emitted[0] /= e;
    for (int l = 1; l <= DEGREES; l++) emitted[l] /= 2 * k * l + e;
    p.config.directions = 20000, p.config.points = 256;
    conduct(&p, k, t);
    find_temperatures(&p, PI * .49);
    trace(&p);
    OWNED double *hits = shine_down(&p);
    p.sources.absorbed = hits, p.sources.tolerance = 1e-8;
    solve(&p);
    for (uint32_t a = 0; a < p.heat->config.patches; a++) {
        double truth = emitted[0];
        patch_means(&p, a, 2, value);
        for (int l = 1; l <= DEGREES; l++) truth += emitted[l] * value[l];
        const double area = p.heat->solution.area[a], error = p.heat->solution.radiosity[a] / e - truth;
        errors += area * error * error, squares += area * truth * truth;
    }
    for (int l = 1; l <= DEGREES; l++) top += emitted[l], bottom += emitted[l] * (l % 2 ? -1 : 1);
    ck_assert_double_le(sqrt(errors / squares), 1e-2);
    assert_near(found[0], t, 1e-3);
    ck_assert_double_le(fabs(largest[0] - found[0] - top / (4 * t * t * t)), fmax(.02 * t, 2 * surface_error[0]));
    ck_assert_double_le(fabs(least[0] - found[0] - bottom / (4 * t * t * t)), fmax(.02 * t, 2 * surface_error[0]));
    ck_assert_double_eq_tol(centre[0], found[0], 1e-9 * t); /* the light is absorbed on the surface */
}

TEST(an_even_source_in_black_surroundings) {
    const double q = 2.5, k = .3, e = .6;
    OWNED_PROBLEM p = one_sphere(2, NAN, e);
    conductivity[0] = k, p.sources.conductivity = conductivity, p.sources.surroundings = 1;
    p.result.temperature = found, p.result.centre_temperature = centre;
    p.result.least_temperature = least, p.result.largest_temperature = largest;
    find_temperatures(&p, q * 4. / 3 * PI * 8);
    trace_and_solve(&p);
    const double t = pow(1 + q * 2 / (3 * e), .25);
    assert_near(found[0], t, 1e-4);
    assert_near(centre[0] - found[0], q * 4 / (6 * k), 1e-12);
    assert_near(least[0], t, 1e-4);
    assert_near(largest[0], t, 1e-4);
}

/* Makes a bed in a box. Some spheres have temperatures, the others have powers. */
static struct problem mixed_bed(double high) {
    struct problem p = problem_of(packing(40, .5, high, .5, 11, false), 2, .7);
    static const double emissivity[] = {1, .8, 1 - 1e-12, .3, 0};
    p.walls = box_about(&p.bed);
    for (int k = 0; k < FIBRAD_WALLS; k++) p.wall_temperature[k] = 1 + .2 * k, p.wall_emissivity[k] = .5 + .1 * k;
    conduct(&p, 1, 1.5);
    for (uint32_t i = 0; i < p.bed.n; i++) {
        p.emissivity[i] = emissivity[i % 5], power[i] = NAN;
        if (i % 3 == 1) p.temperature[i] = NAN, power[i] = p.emissivity[i] > 0 ? .5 * (i % 4) : 0;
        conductivity[i] *= i % 7 == 0 ? .01 : i % 7 == 1 ? 1e3 : 1;
        if (i % 11 == 10) conductivity[i] = INFINITY;
    }
    p.sources.power = power;
    p.config.directions = 60;
    return p;
}

static const double unlike[] = {1, 5};
LOOP_TEST(powers_add_up_to_zero, 2) {
    double largest_power;
    OWNED_PROBLEM p = mixed_bed(unlike[_i]);
    trace_and_solve(&p);
    const double sum = sum_of_powers(&p, &largest_power);
    ck_assert_double_le(fabs(sum), 1e-12 * largest_power);
    for (uint32_t i = 0; i < p.bed.n; i++) {
        if (p.emissivity[i] == 0) {
            ck_assert(p.result.power[i] == 0 && isnan(found[i]) && isnan(least[i]) && isnan(centre[i]));
            continue;
        }
        if (!isnan(p.temperature[i])) ck_assert_double_eq(found[i], p.temperature[i]);
        if (isnan(p.temperature[i])) ck_assert_double_eq(p.result.power[i], -power[i]);
        if (isinf(conductivity[i])) ck_assert(least[i] == found[i] && largest[i] == found[i] && centre[i] == found[i]);
        if (isfinite(conductivity[i])) ck_assert(least[i] < found[i] && found[i] < largest[i]);
    }
}

LOOP_TEST(nothing_flows_at_one_temperature, 2) {
    OWNED_PROBLEM p = mixed_bed(unlike[_i]);
    for (int k = 0; k < FIBRAD_WALLS; k++) p.wall_temperature[k] = 2;
    for (uint32_t i = 0; i < p.bed.n; i++) power[i] = isnan(p.temperature[i]) ? 0 : NAN;
    p.sources.tolerance = 1e-12;
    trace_and_solve(&p);
    for (uint32_t i = 0; i < p.bed.n; i++) {
        ck_assert_double_le(fabs(p.result.power[i]), 1e-9 * 16 * sphere_area(&p.bed, i));
        if (p.emissivity[i] > 0) ck_assert_double_le(largest[i] - least[i], 1e-7);
    }
}

/* Temperatures that were found are given to the next solution. It finds the powers from which they were found. */
TEST(temperatures_and_powers_belong_together) {
    OWNED_PROBLEM p = mixed_bed(1);
    double given[MOST], low[MOST];
    p.sources.tolerance = 1e-7;
    trace_and_solve(&p);
    double scale = 0;
    for (uint32_t i = 0; i < p.bed.n; i++) scale += p.result.power[i] * p.result.power[i] / p.bed.n;
    memcpy(given, power, sizeof given), memcpy(low, least, sizeof low);
    for (uint32_t i = 0; i < p.bed.n; i++)
        if (isnan(p.temperature[i]) && p.emissivity[i] > 0) p.temperature[i] = found[i], power[i] = NAN;
    solve(&p);
    for (uint32_t i = 0; i < p.bed.n; i++) {
        if (isnan(given[i]) || p.emissivity[i] == 0) continue;
        ck_assert_double_le(fabs(p.result.power[i] + given[i]), .02 * sqrt(scale));
        ck_assert_double_le(fabs(least[i] - low[i]), .02 * (found[i] - low[i]));
    }
}

/* Powers of a bed whose spheres have given temperatures and some k* and emissivity. */
static void powers_of(double k_star, double emissivity, double out[MOST]) {
    OWNED_PROBLEM p = problem_of(packing(40, .8, 1, .5, 4, true), 1, emissivity);
    for (uint32_t i = 0; i < p.bed.n; i++) p.temperature[i] = 1 + .2 * bed_make_random(5, i);
    p.config.directions = 60, p.sources.tolerance = 1e-9;
    if (k_star > 0) conduct(&p, k_star, 1.1);
    p.result.temperature = NULL;
    trace_and_solve(&p);
    memcpy(out, p.result.power, p.bed.n * sizeof *out);
}

TEST(what_conducts_well_is_as_before) {
    double before[MOST] = {0}, now[MOST] = {0};
    for (int black = 0; black < 2; black++) {
        powers_of(0, black ? 1 : .6, before);
        powers_of(INFINITY, black ? 1 : .6, now);
        ck_assert_mem_eq(before, now, 40 * sizeof *now);
        powers_of(1e6, black ? 1 : .6, now);
        ck_assert_double_le(difference_of(now, before, 40), 1e-5);
        powers_of(1, black ? 1 : .6, now);
        ck_assert_double_gt(difference_of(now, before, 40), 1e-2);
    }
}

TEST(nearly_black_is_as_black) {
    double black[MOST] = {0}, nearly[MOST] = {0};
    powers_of(.3, 1, black);
    powers_of(.3, 1 - 1e-12, nearly);
    ck_assert_double_le(difference_of(nearly, black, 40), 1e-7);
}

/* A sphere that conducts well and is black, or nearly so, beside one that conducts badly: powers are those for a sphere
 * of one temperature, and the search takes few sweeps. */
LOOP_TEST(good_conductors_beside_bad_ones, 60) {
    const double nearly[] = {0, 0, 1e-8}, apart = (_i % 5) * .02 * (1 + .37 * (_i / 5)), k = .0529 * (1 + _i % 7);
    OWNED_PROBLEM p = problem_of(BED({0, 0, 0, .5}, {0, 0, .8 + 1e-4 + apart, .3}), .9, .6);
    double isothermal[2];
    p.temperature[1] = 1.1, p.emissivity[1] = 1 - nearly[_i % 3], p.sources.surroundings = .3;
    if (_i % 4 == 0) p.emissivity[0] = 1 - 1e-8;
    p.sources.sweeps_max = 60;
    conduct(&p, 1, 1);
    conductivity[0] = k, conductivity[1] = INFINITY;
    trace_and_solve(&p);
    memcpy(isothermal, p.result.power, sizeof isothermal);
    for (double high = 1e5; high < 1e12; high *= 30) {
        conductivity[1] = high;
        solve(&p);
        for (int i = 0; i < 2; i++) assert_near(p.result.power[i], isothermal[i], 1e-4);
    }
}

/* The end of a search that has not converged. */
TEST(a_search_that_ends_too_early) {
    OWNED_PROBLEM p = problem_of(BED({0, 0, 0, .5}, {0, 0, 1.1, .5}), .9, .6);
    int solved = 0, status = FIBRAD_OK, sweeps = 0;
    p.temperature[1] = 1.1, p.sources.surroundings = .3;
    trace(&p);
    p.sources.sweeps_max = 3;
    assert_ok(fibrad_heat_begin(p.heat, &p.sources));
    for (; status == FIBRAD_OK && !solved; sweeps++) {
        heat_sweep(p.heat, false);
        status = fibrad_heat_step(p.heat, &solved);
    }
    ck_assert_int_eq(status, FIBRAD_E_UNSETTLED);
    ck_assert(!solved && sweeps == 4);
    ck_assert_int_eq(fibrad_heat_read(p.heat, &p.result), FIBRAD_E_STATE);
    p.sources.sweeps_max = 0;
    solve(&p);
}

LOOP_TEST(neither_the_order_of_the_work_nor_no_errors_change_bits, 2) {
    OWNED_PROBLEM p = mixed_bed(1), q = mixed_bed(1);
    q.backwards = true, q.isa = FIBRAD_ISA_SCALAR;
    q.sources.no_errors = (uint32_t)_i, q.result.error_beams = NAN;
    trace_and_solve(&p);
    double low[MOST];
    memcpy(low, least, sizeof low);
    trace_and_solve(&q);
    ck_assert_mem_eq(p.result.power, q.result.power, p.bed.n * sizeof *power);
    for (uint32_t i = 0; i < p.bed.n; i++) ck_assert(low[i] == least[i] || (isnan(low[i]) && isnan(least[i])));
    ck_assert_int_eq(isnan(q.result.error_beams) != 0, _i);
}

/* The conductivity of a simple cubic lattice of touching spheres, over 4 sigma T^3 d. It comes from rays and harmonics
 * to degrees 9 and 13: docs/validation.md. */
static const double lattice_k[] = {.01, .1, .1, 1, 1, 10}, lattice_e[] = {1, 1, .6, 1, .6, 1},
                    lattice_f[] = {.2376, .3591, .3430, .8006, .5979, 1.1350};
LOOP_TEST(a_simple_cubic_lattice, 6) {
    enum { LAYERS = 24 };
    double spheres[LAYERS][4], x[2] = {0, 0}, xy[2] = {0, 0};
    for (int i = 0; i < LAYERS; i++) spheres[i][0] = spheres[i][1] = 0, spheres[i][2] = i + .5, spheres[i][3] = .5;
    OWNED_PROBLEM p = problem_of(bed_of(LAYERS, (const double(*)[4])spheres), NAN, lattice_e[_i]);
    p.bed.period[0] = p.bed.period[1] = 1;
    p.walls = (struct walls){.planes = 48, .at = {0, 0, 0, 0, 0, LAYERS}};
    p.wall_temperature[4] = 1.0005, p.wall_temperature[5] = .9995, p.sources.surroundings = 1;
    p.config.directions = 2000;
    conduct(&p, lattice_k[_i], 1);
    find_temperatures(&p, 0);
    trace_and_solve(&p);
    for (uint32_t i = LAYERS / 4; i < 3 * LAYERS / 4; i++) {
        const double z = p.bed.z[i] - LAYERS / 2.;
        x[0] += z, x[1] += z * z, xy[0] += emission(found[i]), xy[1] += z * emission(found[i]);
    }
    const double n = LAYERS / 2., slope = (n * xy[1] - x[0] * xy[0]) / (n * x[1] - x[0] * x[0]);
    assert_near(p.wall_power[5] / -slope, lattice_f[_i], lattice_k[_i] < .1 ? .02 : .01);
}

/* Light changes no sum of powers. If it is even on each sphere, or if spheres do not conduct, it changes nothing. */
TEST(light_adds_up_and_even_light_changes_nothing) {
    OWNED_PROBLEM p = mixed_bed(1), q = mixed_bed(1);
    double largest_power;
    trace(&p), solve(&p);
    OWNED double *light = calloc(fibrad_heat_patches(p.heat), sizeof *light);
    for (uint32_t a = 0; a < p.heat->first[p.bed.n]; a++) light[a] = 2 * p.heat->solution.area[a];
    trace(&q), q.sources.absorbed = light, solve(&q);
    for (uint32_t i = 0; i < p.bed.n; i++)
        ck_assert_double_le(fabs(p.result.power[i] - q.result.power[i]), 1e-9 * fabs(p.result.power[i]));
    for (uint32_t a = 0; a < p.heat->first[p.bed.n]; a++) light[a] *= a % 7;
    solve(&q);
    const double sum = sum_of_powers(&q, &largest_power);
    ck_assert_double_le(fabs(sum), 1e-12 * largest_power);
    for (uint32_t i = 0; i < p.bed.n; i++) conductivity[i] = INFINITY;
    solve(&p), solve(&p), solve(&q), q.sources.absorbed = NULL, solve(&q);
    for (uint32_t i = 0; i < p.bed.n; i++)
        ck_assert_double_le(fabs(p.result.power[i] - q.result.power[i]), 1e-3 * largest_power);
    light[0] = -1, q.sources.absorbed = light;
    assert_invalid(fibrad_heat_check(q.heat, &q.sources, NULL));
}

TEST(conductivities_are_above_zero) {
    static const double wrong[] = {0, -1, -INFINITY, NAN};
    OWNED_PROBLEM p = one_sphere(1, 1, .5);
    fibrad_fault fault;
    conduct(&p, 1, 1);
    trace_and_solve(&p);
    for (int k = 0; k < 4; k++) {
        conductivity[0] = wrong[k];
        assert_invalid(fibrad_heat_check(p.heat, &p.sources, &fault));
        ck_assert_int_eq(fault.why, FIBRAD_WHY_CONDUCTIVITY);
        ck_assert_uint_eq(fault.first, 0);
        assert_invalid(fibrad_heat_begin(p.heat, &p.sources));
    }
}
