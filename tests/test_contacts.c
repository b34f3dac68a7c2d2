/* test_contacts.c - contacts and radiation in one balance, against closed forms and against a Newton solution with
 * exchange factors. SPDX-License-Identifier: MIT */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_linalg.h>

#include "simple/contact_list.h"
#include "host_owned.h"
#include "scenes.h"
#include "meshes.h"
#include "suite.h"

#define SIGMA FIBRAD_STEFAN_BOLTZMANN

enum { MOST = 80, WALLS = 6, CONTACTS = 400 };

/* A bed, its walls, contacts and results. */
struct joint {
    struct bed bed;
    fibrad_wall wall[WALLS];
    fibrad_scene_config scene;
    fibrad_heat_config config;
    fibrad_heat_sources sources;
    fibrad_heat_result result;
    double temperature[MOST], emissivity[MOST], power[MOST], storage[MOST], reference[MOST];
    double wall_temperature[WALLS], wall_emissivity[WALLS], wall_power[WALLS];
    uint32_t first[CONTACTS], second[CONTACTS];
    double conductance[CONTACTS];
    double q[MOST], t[MOST], t_error[MOST], q_error[MOST], conducted[MOST], flow[CONTACTS];
    double wall_q[WALLS], wall_t[WALLS], wall_conducted[WALLS];
    int status;
    fibrad_fault fault;
};

/* The one in use; some tests have more. */
static struct joint joint;
static void forget(void) { bed_free(&joint.bed); }
FIXTURE(NULL, forget)

/* Spheres of unknown temperature without powers, in black surroundings of 300 K. */
static void begin(struct joint *j, struct bed bed, double emissivity) {
    *j = (struct joint){.bed = bed};
    ck_assert_uint_le(bed.n, MOST);
    for (int axis = 0; axis < 3; axis++) j->scene.period[axis] = bed.period[axis];
    for (uint32_t i = 0; i < bed.n; i++) {
        j->temperature[i] = j->reference[i] = NAN;
        j->emissivity[i] = emissivity;
    }
    fibrad_heat_sources_init(&j->sources);
    j->sources.temperature = j->temperature, j->sources.emissivity = j->emissivity, j->sources.power = j->power;
    j->sources.wall_temperature = j->wall_temperature, j->sources.wall_emissivity = j->wall_emissivity;
    j->sources.wall_power = j->wall_power;
    j->sources.contact_first = j->first, j->sources.contact_second = j->second;
    j->sources.conductance = j->conductance;
    j->sources.surroundings = 300;
    j->scene.wall = j->wall;
    j->result = (fibrad_heat_result){.power = j->q, .wall_power = j->wall_q, .temperature = j->t};
    j->result.wall_temperature = j->wall_t, j->result.power_error = j->q_error;
    j->result.temperature_error = j->t_error, j->result.conducted = j->conducted;
    j->result.wall_conducted = j->wall_conducted, j->result.contact_flow = j->flow;
}

/* Adds a wall and returns the number by which contacts call it. */
static uint32_t add_wall(struct joint *j, int axis, int upper, double at, double temperature, double emissivity) {
    const uint32_t k = j->scene.walls++;
    j->wall[k] = plane_at(axis, upper, at);
    j->wall_temperature[k] = temperature, j->wall_emissivity[k] = emissivity, j->wall_power[k] = NAN;
    return j->bed.n + k;
}

static void add_box(struct joint *j, double half, double temperature, double emissivity) {
    for (int side = 0; side < 6; side++)
        add_wall(j, side / 2, side % 2, side % 2 ? half : -half, temperature, emissivity);
}

static void join(struct joint *j, uint32_t first, uint32_t second, double conductance) {
    const uint32_t k = j->sources.contacts++;
    ck_assert_uint_lt(k, CONTACTS);
    j->first[k] = first, j->second[k] = second, j->conductance[k] = conductance;
}

static void solve(struct joint *j) {
    const fibrad_spheres spheres = spheres_of(&j->bed);
    OWNED_MADE *radiation;
    assert_ok(made_with(&radiation, &j->scene, &spheres, &j->config, NULL));
    j->status = fibrad_bed_solve(radiation, &j->sources, NULL, &j->result);
    fibrad_bed_describe(radiation, NULL, &j->fault);
}

/* All powers add up to zero, and so do all flows through contacts. What a sphere of unknown temperature gains is what
 * it gives off from inside. */
static void assert_balanced(const struct joint *j) {
    double sum = j->result.surroundings_power, conducted = 0, largest = fabs(sum), flows = 0, emitted = 0;
    assert_ok(j->status);
    for (uint32_t i = 0; i < j->bed.n; i++)
        emitted += j->emissivity[i] * 4 * PI * j->bed.r[i] * j->bed.r[i] * SIGMA * pow(j->t[i], 4);
    for (uint32_t i = 0; i < j->bed.n; i++) {
        sum += j->q[i], conducted += j->conducted[i];
        worst_of(&largest, fabs(j->q[i])), worst_of(&largest, fabs(j->conducted[i]));
    }
    for (uint32_t k = 0; k < j->scene.walls; k++) {
        sum += j->wall_q[k], conducted += j->wall_conducted[k];
        worst_of(&largest, fabs(j->wall_q[k]));
    }
    for (uint32_t k = 0; k < j->sources.contacts; k++) flows += fabs(j->flow[k]);
    ck_assert_double_le(fabs(sum), 1e-11 * largest + 1e-14 * emitted);
    ck_assert_double_le(fabs(conducted), 1e-12 * flows);
    for (uint32_t i = 0; i < j->bed.n; i++)
        if (isnan(j->temperature[i]))
            ck_assert_double_le(fabs(j->q[i] + j->power[i]), 1e-9 * (largest + flows) + 1e-14 * emitted);
}

/* A row of spheres of emissivity 0 between two plates conducts like a wire. */
LOOP_TEST(a_chain_between_plates, 3) {
    static const uint32_t numbers[] = {1, 7, 60};
    struct joint *j = &joint;
    const uint32_t n = numbers[_i];
    struct bed row = bed_empty();
    for (uint32_t i = 0; i < n; i++) add_sphere(&row, 0, 0, 2. * i, 1);
    begin(j, row, 0);
    j->config = (fibrad_heat_config){.directions = 36, .patches = 24, .wall_rays = 1000}; /* nothing is emitted */
    const uint32_t low = add_wall(j, 2, 0, -1, 1200, 0), high = add_wall(j, 2, 1, 2. * n - 1, 400, 0);
    join(j, low, 0, .5);
    for (uint32_t i = 1; i < n; i++) join(j, i - 1, i, .25 + .01 * i);
    join(j, n - 1, high, 2);
    solve(j);
    assert_balanced(j);
    double resistance = 0, at = 1200;
    for (uint32_t k = 0; k <= n; k++) resistance += 1 / j->conductance[k];
    const double flow = 800 / resistance;
    for (uint32_t i = 0; i < n; i++) {
        at -= flow / j->conductance[i];
        ck_assert_double_le(fabs(j->t[i] - at), 1e-10 * at);
    }
    for (uint32_t k = 0; k <= n; k++) ck_assert_double_le(fabs(j->flow[k] - flow), 1e-10 * flow);
    ck_assert_double_le(fabs(j->wall_q[0] + flow), 1e-10 * flow);
    ck_assert_double_le(fabs(j->wall_q[1] - flow), 1e-10 * flow);
}

/* The temperature at which P + e A sigma (Tb^4 - T^4) + H (Tc - T) = 0, by bisection. */
static double one_balance(double power, double area, double around, double h, double contact) {
    double low = 0, high = 1e5;
    for (int k = 0; k < 200; k++) {
        const double t = (low + high) / 2;
        if (power + area * SIGMA * (pow(around, 4) - pow(t, 4)) + h * (contact - t) > 0)
            low = t;
        else
            high = t;
    }
    return low;
}

/* A sphere in a black box touches a wall. It may be a source or a sink, nearly all emissivities lead to one limit, and
 * on the way temperatures below zero may come up. */
LOOP_TEST(one_sphere_in_a_black_room, by_night(36, 18)) {
    static const double emissivities[] = {0, 1e-9, .3, .8, 1 - 1e-12, 1}, powers[] = {0, 4e4, -1800},
                        conductances[] = {2, 60};
    struct joint *j = &joint;
    const double e = emissivities[_i % 6], p = powers[_i / 6 % 3], h = conductances[_i / 18];
    const double power = p < 0 ? -.9 * (h * 900 + e * 4 * PI * SIGMA * pow(900, 4)) : p;
    begin(j, BED({0, 0, 0, 1}), e);
    add_box(j, 1.3, 900, 1);
    j->power[0] = power;
    join(j, 0, 1 + 2, h);
    solve(j);
    assert_balanced(j);
    const double t = one_balance(power, e * 4 * PI, 900, h, 900);
    ck_assert_double_le(fabs(j->t[0] - t), 2e-4 * t);
    ck_assert_double_le(fabs(j->conducted[0] - h * (900 - j->t[0])), 1e-12 * h * 900);
}

/* Nearly black is black. */
TEST(emissivities_next_to_one) {
    static struct joint j[3];
    for (int k = 0; k < 3; k++) {
        begin(&j[k], packing(40, .6, 1, .45, 11, false), k == 0 ? 1 : k == 1 ? 1 - 1e-12 : 1 - 1e-7);
        for (uint32_t i = 0; i < 40; i++) j[k].power[i] = i % 3 == 0 ? 3e4 : 0;
        j[k].temperature[7] = 500, j[k].power[7] = 0;
        for (uint32_t i = 0; i + 1 < 40; i++) join(&j[k], i, i + 1, 20. + i);
        j[k].sources.tolerance = 1e-9;
        solve(&j[k]);
        assert_balanced(&j[k]);
    }
    for (uint32_t i = 0; i < 40; i++)
        for (int k = 1; k < 3; k++) ck_assert_double_le(fabs(j[k].t[i] / j[0].t[i] - 1), k == 1 ? 1e-8 : 1e-6);
    for (int k = 0; k < 3; k++) bed_free(&j[k].bed);
}

/* The temperature of an end of a contact in the Newton solution. */
static double end_temperature(const struct joint *j, const double *t, uint32_t end) {
    return end < j->bed.n ? t[end] : j->wall_temperature[end - j->bed.n];
}

/* Temperatures by Newton's method with exchange factors. t: first guess, and out. q: radiative powers, out. */
static void by_newton(const struct joint *j, const fibrad_bed_matrix *d, double *t, double *q) {
    const uint32_t n = j->bed.n;
    static double matrix[MOST * MOST], left[MOST];
    gsl_matrix_view a = gsl_matrix_view_array(matrix, n, n);
    gsl_vector_view step = gsl_vector_view_array(left, n);
    for (int round = 0; round < 60; round++) {
        memset(matrix, 0, sizeof matrix);
        for (uint32_t i = 0; i < n; i++) {
            const double emits = 4 * PI * j->bed.r[i] * j->bed.r[i] * j->emissivity[i] * SIGMA, own = pow(t[i], 4);
            q[i] = emits * d->matrix.escaped[i] * (pow(j->sources.surroundings, 4) - own);
            matrix[i * n + i] += emits * d->matrix.escaped[i] * 4 * pow(t[i], 3);
            for (uint64_t k = d->matrix.start[i]; k < d->matrix.start[i + 1]; k++) {
                const uint32_t o = d->matrix.col[k];
                const double area = emits * d->matrix.f[k];
                q[i] += area * (pow(t[o], 4) - own);
                matrix[i * n + i] += area * 4 * pow(t[i], 3), matrix[i * n + o] -= area * 4 * pow(t[o], 3);
            }
            for (uint32_t b = 0; b < j->scene.walls; b++) {
                const double area = emits * d->matrix.wall[i * j->scene.walls + b];
                q[i] += area * (pow(j->wall_temperature[b], 4) - own);
                matrix[i * n + i] += area * 4 * pow(t[i], 3);
            }
            left[i] = q[i] + j->power[i];
        }
        for (uint32_t k = 0; k < j->sources.contacts; k++) {
            const uint32_t ends[2] = {j->first[k], j->second[k]};
            for (int side = 0; side < 2; side++) {
                const uint32_t i = ends[side], o = ends[1 - side];
                if (i >= n) continue;
                left[i] += j->conductance[k] * (end_temperature(j, t, o) - t[i]);
                matrix[i * n + i] += j->conductance[k];
                if (o < n) matrix[i * n + o] -= j->conductance[k];
            }
        }
        for (uint32_t i = 0; i < n; i++) {
            if (isnan(j->temperature[i])) continue;
            for (uint32_t o = 0; o < n; o++) matrix[i * n + o] = i == o;
            left[i] = 0;
        }
        ck_assert_int_eq(gsl_linalg_HH_svx(&a.matrix, &step.vector), 0);
        double change = 0;
        for (uint32_t i = 0; i < n; i++) {
            const double next = fmax(t[i] + left[i], t[i] / 2);
            worst_of(&change, fabs(next / t[i] - 1)), t[i] = next;
        }
        if (change < 1e-13) return;
    }
    ck_abort_msg("Newton's method does not end");
}

/* Root mean squares over spheres. */
struct compared {
    double powers, difference;     /* of radiative powers [W] */
    double temperature, estimated; /* of errors of temperatures that were found [K] */
    uint32_t beyond;               /* temperatures off by more than both errors */
};

static struct compared compare(const struct joint *j, const double *t, const double *q) {
    struct compared c = {0, 0, 0, 0, 0};
    const double n = j->bed.n;
    for (uint32_t i = 0; i < j->bed.n; i++) {
        const double radiated = j->q[i] - j->conducted[i], off = j->t[i] - t[i];
        c.powers += q[i] * q[i] / n, c.difference += (radiated - q[i]) * (radiated - q[i]) / n;
        if (!isnan(j->temperature[i])) continue;
        c.temperature += off * off / n, c.estimated += j->t_error[i] * j->t_error[i] / n;
        c.beyond += fabs(off) > 2 * j->t_error[i] + 1e-3 * t[i] / 4;
    }
    return (struct compared){sqrt(c.powers), sqrt(c.difference), sqrt(c.temperature), sqrt(c.estimated), c.beyond};
}

/* Unequal spheres of all emissivities in rooms: a random network, powers, sinks and given temperatures. With 60 spheres
 * and rows right to .001 the difference was 0.2 to 0.4 %; here it is at most that and the noise of the rows. */
LOOP_TEST(spheres_in_a_room, 2) {
    struct joint *j = &joint;
    const uint32_t n = 16;
    const uint64_t seed = 100 + (uint64_t)_i;
    begin(j, packing(n, .5, 1, .3, seed, false), 0);
    double half = 0;
    for (uint32_t i = 0; i < n; i++) {
        const double at[3] = {j->bed.x[i], j->bed.y[i], j->bed.z[i]}, u = bed_make_random(seed, 1000 + i);
        for (int k = 0; k < 3; k++) half = fmax(half, fabs(at[k]) + j->bed.r[i]);
        j->emissivity[i] = i % 10 == 0 ? 0 : i % 10 == 1 ? 1 : .1 + .85 * u;
        j->power[i] = i % 3 == 0 ? 2e5 * u : i % 7 == 0 ? -1e4 * u : 0;
        if (i % 11 == 5) j->temperature[i] = 400 + 1200 * u, j->power[i] = 0;
    }
    for (int side = 0; side < 6; side++)
        add_wall(j, side / 2, side % 2, side % 2 ? half : -half, 500 + 150 * side, .3 + .1 * side);
    const double usual = _i ? 300 : 30;
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t k = 0; k < 3; k++) {
            const uint32_t other = (uint32_t)((n + 6) * bed_make_random(seed, 5000 + 3 * i + k));
            if (other != i) join(j, i, other, usual * exp(4 * bed_make_random(seed, 9000 + 3 * i + k) - 2));
        }
    solve(j);
    assert_balanced(j);

    double t[MOST], q[MOST];
    OWNED_FACTORS *d;
    const fibrad_spheres spheres = spheres_of(&j->bed);
    const fibrad_exchange_rule rule = {
        .emissivity = j->emissivity, .wall_emissivity = j->wall_emissivity, .tolerance = 1e-3};
    assert_ok(exchange_of(&j->scene, &spheres, &rule, NULL, NULL, &d));
    for (uint32_t i = 0; i < n; i++) t[i] = isnan(j->temperature[i]) ? 1000 : j->temperature[i];
    by_newton(j, d, t, q);
    const struct compared c = compare(j, t, q);
    ck_assert_double_le(c.difference, 6e-3 * c.powers);
    ck_assert_double_le(c.temperature, 1.5 * c.estimated);
    ck_assert_uint_le(c.beyond, 1);
}

/* Contacts of no conductance change nothing beyond the tolerance of the search. */
TEST(contacts_that_conduct_nothing) {
    static struct joint j[2];
    for (int k = 0; k < 2; k++) {
        begin(&j[k], packing(30, .6, 1, .45, 5, false), .4);
        for (uint32_t i = 0; i < 30; i++) j[k].power[i] = 1e3 * i;
        for (uint32_t i = 0; k == 1 && i + 1 < 30; i++) join(&j[k], i, i + 1, 0);
        solve(&j[k]);
        assert_ok(j[k].status);
    }
    for (uint32_t i = 0; i < 30; i++) {
        ck_assert_double_le(fabs(j[0].t[i] - j[1].t[i]), 1e-5 * j[0].t[i]);
        ck_assert_double_eq(j[0].q[i], j[1].q[i]);
    }
    for (int k = 0; k < 2; k++) bed_free(&j[k].bed);
}

/* The order of contacts, that of their ends and their number do not matter. */
TEST(contacts_in_any_order) {
    static struct joint j[2];
    for (int k = 0; k < 2; k++) {
        begin(&j[k], packing(30, .6, 1, .45, 5, false), .4);
        for (uint32_t i = 0; i < 30; i++) j[k].power[i] = 1e3 * i;
        for (uint32_t i = 0; i + 1 < 30; i++) {
            const uint32_t at = k == 0 ? i : 28 - i;
            join(&j[k], k == 0 ? at : at + 1, k == 0 ? at + 1 : at, k == 0 ? 30 : 10);
            if (k == 1) join(&j[k], at, at + 1, 20);
        }
        j[k].sources.tolerance = 1e-10;
        solve(&j[k]);
        assert_balanced(&j[k]);
    }
    for (uint32_t i = 0; i < 30; i++) ck_assert_double_le(fabs(j[0].t[i] - j[1].t[i]), 1e-8 * j[0].t[i]);
    for (int k = 0; k < 2; k++) bed_free(&j[k].bed);
}

/* What is refused, and where. */
LOOP_TEST(contacts_at_fault, 6) {
    struct joint *j = &joint;
    static unsigned char insulated[WALLS];
    begin(j, BED({0, 0, 0, 1}, {0, 0, 2, 1}, {0, 0, 4, 1}), .5);
    const uint32_t wall = add_wall(j, 2, 0, -1, 400, .5);
    join(j, 0, 1, 1), join(j, 1, 2, 1), join(j, wall, 0, 1);
    int status = FIBRAD_E_ARGUMENT, why = FIBRAD_WHY_CONTACT;
    uint32_t sphere = 1;
    if (_i == 0) j->second[1] = 4;
    if (_i == 1) j->conductance[1] = -1, why = FIBRAD_WHY_CONDUCTANCE;
    if (_i == 2) j->conductance[1] = NAN, why = FIBRAD_WHY_CONDUCTANCE;
    if (_i == 3) insulated[0] = 1, j->sources.insulated = insulated, why = FIBRAD_WHY_TOUCHED, sphere = 3;
    if (_i == 4) j->sources.conductance = NULL, why = FIBRAD_WHY_MISSING, sphere = 3;
    if (_i == 5) {
        j->emissivity[1] = j->emissivity[2] = 0, j->conductance[0] = 0;
        status = FIBRAD_E_UNSOLVABLE, why = FIBRAD_WHY_ALONE;
    }
    solve(j);
    insulated[0] = 0;
    ck_assert_int_eq(j->status, status);
    ck_assert_int_eq(j->fault.why, why);
    ck_assert_uint_eq(j->fault.first, sphere);
    if (_i == 3) ck_assert_uint_eq(j->fault.wall, 1);
}

/* A closed bed without any given temperature has no level, which contacts need. */
TEST(contacts_need_a_temperature) {
    struct joint *j = &joint;
    begin(j, BED({0, 0, 0, 1}, {0, 0, 2.2, 1}), .5);
    add_box(j, 3.3, NAN, .5);
    for (int side = 0; side < 6; side++) j->wall_power[side] = 0;
    j->power[0] = 10, j->power[1] = -10;
    solve(j);
    assert_ok(j->status);
    join(j, 0, 1, 1);
    solve(j);
    ck_assert_int_eq(j->status, FIBRAD_E_UNSOLVABLE);
}

/* Two spheres that reflect all and exchange heat through their contact. */
TEST(a_pair_in_time) {
    OWNED_BED bed = BED({0, 0, 0, 1}, {0, 0, 2, 1});
    const fibrad_spheres spheres = spheres_of(&bed);
    const double emissivity[2] = {0, 0}, capacity[2] = {300, 100}, h = 2.5;
    const uint32_t first = 0, second = 1;
    OWNED_MADE *t;
    assert_ok(made_with(&t, NULL, &spheres, NULL, NULL));
    fibrad_heat_sources sources;
    fibrad_heat_sources_init(&sources);
    sources.emissivity = emissivity, sources.surroundings = 300;
    sources.contact_first = &first, sources.contact_second = &second, sources.conductance = &h, sources.contacts = 1;
    double at[2] = {1000, 400};
    const double mean = (300 * 1000 + 100 * 400) / 400., rate = h * (1 / 300. + 1 / 100.);
    for (int k = 1; k <= 5; k++) {
        fibrad_span span = {at, capacity, .duration = 12};
        assert_ok(fibrad_bed_advance(t, &sources, &span));
        const double apart = 600 * exp(-rate * 12 * k);
        ck_assert_double_le(fabs(at[0] - (mean + apart / 4)), 1e-4 * at[0]);
        ck_assert_double_le(fabs(at[1] - (mean - 3 * apart / 4)), 1e-4 * at[1]);
        ck_assert_double_le(fabs(300 * at[0] + 100 * at[1] - 400 * mean), 1e-9 * 400 * mean);
    }
}

/* ---- spots and gas ---------------------------------------------------------------------------------------------- */

static fibrad_contact_list *found_in(const struct bed *bed, const fibrad_scene_config *scene,
                                     const fibrad_contact_rule *rule) {
    const fibrad_spheres spheres = spheres_of(bed);
    fibrad_contact_list *list;
    assert_ok(fibrad_contacts_find(scene, &spheres, rule, &list));
    return list;
}

/* Mistakes in a bed of two spheres and two triangles. What no scene can have is refused before contacts are looked for,
 * and spheres without a scene are checked as well. */
LOOP_TEST(contacts_of_no_bed, 19) {
    const int what = _i;
    double at[2][3] = {{0, 0, 1}, {0, 0, 2.9}}, r[2] = {1, 1};
    double v[4][3] = {{-3, -3, 0}, {9, -3, 0}, {9, 9, 0}, {-3, 9, 0}};
    uint32_t corner[2][3] = {{0, 1, 2}, {0, 2, 3}}, front[2] = {0, 0};
    struct fibrad_triangles t = {&v[0][0], &v[0][1], &v[0][2], 3, 4, &corner[0][0], front, NULL, 2, {0}};
    fibrad_wall wall = {.kind = FIBRAD_WALL_MESH};
    fibrad_scene_config config = {.wall = &wall, .walls = 1, .triangles = &t};
    const fibrad_spheres s = {&at[0][0], &at[0][1], &at[0][2], r, 2, .stride = 3};
    const fibrad_contact_rule rule = {.spots = FIBRAD_SPOTS_HERTZ, .gas_reach = .65};
    const double extremes[] = {1e-300, 1e-3, -5, NAN};
    if (what == 1) corner[0][2] = 100000000;
    if (what == 2) front[0] = 7;
    if (what == 3) v[1][0] = NAN;
    if (what == 4) t.corner = NULL;
    if (what == 5) config.wall = NULL;
    if (what == 6) t.vertices = 0;
    if (what == 7) wall.kind = 9;
    if (what == 8) config.walls = 5000, config.triangles = NULL;
    if (what == 9) v[1][0] = 1e300, v[2][0] = 1e300;
    if (what == 10) wall = (fibrad_wall){.kind = FIBRAD_WALL_PLANE, .plane.axis = 5};
    if (what == 11) wall = (fibrad_wall){.kind = FIBRAD_WALL_CYLINDER, .cylinder = {.along = 7, .radius = 5}};
    const bool of_spheres = what >= 12; /* the others are not looked at without a scene */
    if (what >= 12 && what < 14) r[1] = what == 12 ? -1 : 1e-300;
    if (what == 14) r[0] = NAN;
    if (what == 15) at[1][2] = NAN;
    if (what == 16) at[1][2] = 1e300;
    for (int k = 0; k < (what > 16 ? 2 : 1); k++) {
        if (what > 16) config.period[what - 17] = extremes[2 * (what - 17) + k];
        fibrad_bed *bed;
        fibrad_contact_list *list;
        const int status = fibrad_bed_new(&bed, &config, &s, NULL);
        if (what == 0) {
            const fibrad_contact_list *of_bed;
            assert_ok(status);
            assert_ok(fibrad_bed_contacts(bed, &rule, &of_bed));
            ck_assert_uint_eq(of_bed->n, 2);
            fibrad_bed_free(bed);
            continue;
        }
        ck_assert_int_lt(status, 0);
        ck_assert_ptr_null(bed);
        if (of_spheres) ck_assert_int_lt(fibrad_contacts_find(&config, &s, &rule, &list), 0);
    }
}

TEST(spots_of_a_pair_and_a_wall) {
    OWNED_BED bed = BED({0, 0, 0.98, 1}, {0, 0, 2.46, .5});
    const fibrad_wall floor = plane_at(2, 0, 0);
    const fibrad_scene_config scene = {.wall = &floor, .walls = 1};
    const double solid[2] = {30, 10};
    for (int spots = FIBRAD_SPOTS_LENS; spots <= FIBRAD_SPOTS_HERTZ; spots++) {
        const fibrad_contact_rule rule = {.spots = spots, .scale = .5};
        OWNED fibrad_contact_list *list = found_in(&bed, &scene, &rule);
        double h[2];
        ck_assert_uint_eq(list->n, 2);
        assert_ok(fibrad_contacts_conduct(list, &rule, solid, NULL, h));
        const double x = (1.48 * 1.48 + 1 - .25) / 2.96, lens = sqrt(1 - x * x), hertz = sqrt(.5 / 1.5 * .02);
        const double wall = spots == FIBRAD_SPOTS_LENS ? sqrt(1 - .98 * .98) : sqrt(.02);
        ck_assert_double_le(fabs(h[0] - 2 * 15 * .5 * (spots == FIBRAD_SPOTS_LENS ? lens : hertz)), 1e-9 * h[0]);
        ck_assert_double_le(fabs(h[1] - 4 * 30 * .5 * wall), 1e-9 * h[1]);
    }
}

/* A box of triangles has the contacts of a box of planes: of six meshes, and of one mesh whose corners touch a sphere
 * two or three times. */
LOOP_TEST(contacts_with_triangles, 2) {
    OWNED_BED bed = strewn(400, 3);
    const fibrad_contact_rule rule = {.spots = FIBRAD_SPOTS_LENS, .gas_reach = .5};
    const double low[3] = {0, 0, 0}, high[3] = {1, 1, 1};
    OWNED struct mesh *mesh = mesh_new();
    mesh_box(mesh, low, high, 0);
    fibrad_wall planes[6];
    for (int side = 0; side < 6; side++) planes[side] = plane_at(side / 2, side % 2, side % 2);
    for (uint32_t t = 0; t < mesh->triangles.n && _i == 1; t++) mesh->front[t] = 0;
    const fibrad_scene_config box = {.wall = planes, .walls = 6},
                              meshes = {.wall = mesh->wall, .walls = _i ? 1 : 6, .triangles = &mesh->triangles};
    fibrad_contact_list *list[2] = {found_in(&bed, &box, &rule), found_in(&bed, &meshes, &rule)};
    double sum[2] = {0, 0}, square[2] = {0, 0};
    uint32_t at_walls = 0;
    for (int k = 0; k < 2; k++)
        for (uint32_t c = 0; c < list[k]->n; c++) {
            sum[k] += list[k]->distance[c], square[k] += list[k]->distance[c] * list[k]->distance[c];
            at_walls += k == 1 && list[k]->second[c] >= bed.n;
        }
    ck_assert_uint_eq(list[0]->n, list[1]->n);
    ck_assert_uint_gt(at_walls, 50);
    assert_near(sum[1], sum[0], 1e-12);
    assert_near(square[1], square[0], 1e-12);
    for (int k = 0; k < 2; k++) free(list[k]);
}

/* Contacts of a periodic bed of all sizes, against all pairs and images. A sphere far away, for which there are too
 * many cells for a table, changes none. */
TEST(contacts_of_many_sizes) {
    OWNED_BED bed = strewn(400, 3);
    const fibrad_contact_rule rule = {.spots = FIBRAD_SPOTS_LENS, .gas_reach = .5};
    const fibrad_scene_config scene = {.period = {1, 1, 0}};
    OWNED fibrad_contact_list *list = found_in(&bed, &scene, &rule);
    uint32_t pairs = 0;
    double sum = 0, distances = 0;
    for (uint32_t i = 0; i < bed.n; i++)
        for (uint32_t j = 0; j < i; j++)
            for (int image = 0; image < 9; image++) {
                const double x = bed.x[i] - bed.x[j] + image % 3 - 1, y = bed.y[i] - bed.y[j] + image / 3 - 1,
                             z = bed.z[i] - bed.z[j], d = sqrt(x * x + y * y + z * z);
                if (d < bed.r[i] + bed.r[j] + .5 * fmin(bed.r[i], bed.r[j])) pairs++, sum += d;
            }
    for (uint32_t k = 0; k < list->n; k++) distances += list->distance[k];
    ck_assert_uint_gt(pairs, 30);
    ck_assert_uint_eq(list->n, pairs);
    assert_near(distances, sum, 1e-12);
    add_sphere(&bed, .5, .5, 1e5, .01);
    OWNED fibrad_contact_list *same = found_in(&bed, &scene, &rule);
    ck_assert_uint_eq(same->n, list->n);
    ck_assert_mem_eq(same->first, list->first, list->n * sizeof *list->first);
    ck_assert_mem_eq(same->second, list->second, list->n * sizeof *list->second);
    ck_assert_mem_eq(same->distance, list->distance, list->n * sizeof *list->distance);
}

/* A line through a sphere, a gap and another sphere or a wall. */
struct gas_lines {
    double d, r_i, r_j, k_i, k_j, k_gas, jump, least;
};

static double gas_line(double r, void *lines) {
    const struct gas_lines *g = lines;
    const double l_i = sqrt(g->r_i * g->r_i - r * r), l_j = isinf(g->r_j) ? 0 : sqrt(g->r_j * g->r_j - r * r);
    const double gap = g->d - l_i - l_j;
    return 2 * PI * r / (l_i / g->k_i + l_j / g->k_j + fmax(gap + g->jump, g->least) / g->k_gas);
}

/* What gas conducts, against adaptive quadrature over the radius of lines. */
LOOP_TEST(gas_between_surfaces, 10) {
    static const struct {
        double d, r_i, r_j, jump;
        int alone;
    } cases[] = {{2.001, 1, 1, 0, 0},        {2.3, 1, 1, 0, 0},         {1.55, 1, .5, 0, 0},
                 {3.02, .5, 2.5, 1e-3, 0},   {1.01, 1, INFINITY, 0, 0}, {2.0001, 1, 1, 0, 1},
                 {1.4, 1, INFINITY, .01, 1}, {1.99, 1, 1, 0, 0},        {1.98, 1, 1, 1e-4, 0},
                 {.99, 1, INFINITY, 0, 1}};
    const double k_i = 30, k_j = 4, k_gas = .2, least = 1e-6, reach = .5;
    const bool wall = isinf(cases[_i].r_j), alone = cases[_i].alone;
    const double d = cases[_i].d, small = fmin(cases[_i].r_i, cases[_i].r_j),
                 large = fmax(cases[_i].r_i, cases[_i].r_j);
    OWNED_BED bed = bed_empty();
    add_sphere(&bed, 0, 0, d, cases[_i].r_i);
    if (!wall) add_sphere(&bed, 0, 0, 0, cases[_i].r_j);
    const fibrad_wall floor = plane_at(2, 0, 0);
    const fibrad_scene_config scene = {.wall = &floor, .walls = wall};
    const fibrad_contact_rule rule = {
        .gas_reach = reach, .gas_jump = cases[_i].jump, .gas_least = least, .gas_alone = alone};
    OWNED fibrad_contact_list *list = found_in(&bed, &scene, &rule);
    const double solid[2] = {k_i, k_j};
    double h;
    ck_assert_uint_eq(list->n, 1);
    assert_ok(fibrad_contacts_conduct(list, &rule, solid, &k_gas, &h));

    struct gas_lines lines = {d,     cases[_i].r_i,  cases[_i].r_j, alone ? INFINITY : k_i, alone ? INFINITY : k_j,
                              k_gas, cases[_i].jump, least};
    const double lens = (1 + reach) * small, plane = wall ? d : (d * d + lens * lens - large * large) / (2 * d);
    const double end = sqrt(fmin(lens * lens - plane * plane, small * small));
    const double cut = wall ? d : (d * d + small * small - large * large) / (2 * d);
    const double begin_at = small > cut ? sqrt(fmax(0, small * small - cut * cut)) : 0;
    const double touching = d < cases[_i].r_i + (wall ? 0 : cases[_i].r_j) ? begin_at : 0;
    gsl_integration_workspace *space = gsl_integration_workspace_alloc(4000);
    gsl_function f = {gas_line, &lines};
    double truth, error;
    ck_assert_int_eq(gsl_integration_qags(&f, touching, end * (1 - 1e-13), 0, 1e-11, 4000, space, &truth, &error), 0);
    gsl_integration_workspace_free(space);
    ck_assert_double_le(fabs(h / truth - 1), 1e-9);
}
