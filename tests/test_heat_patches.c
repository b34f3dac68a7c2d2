/* test_heat_patches.c - patches, compared with the places for which they stand. SPDX-License-Identifier: MIT */
#include "heat_problem.h"
#include "pair/free_pair.h"

/* Finds the origin and the direction of the beam of one point of window k of sphere i, and the normal there. */
static void beam(const struct problem *p, uint32_t i, uint32_t k, uint32_t point, double o[3], double w[3],
                 double normal[3]) {
    const fibrad_heat_config *config = &p->heat->config;
    const double centre[3] = {p->bed.x[i], p->bed.y[i], p->bed.z[i]};
    double frame[9];
    fibrad_disc_points set;
    assert_ok(fibrad_disc_points_get(config->points, &set));
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

/* The strands from the row of `place` to a body: the patches that each leaves and meets, and the number of its
 * beams. */
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
        s->share = (double)pencil->weight;
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

/* A small sphere nearly touches a large one or a wall. The true powers come from paths that another program followed
 * one by one, to .02 % and less. Before fours of patches were divided, the powers of the small sphere were 6.5, 2.9,
 * 1.6 and 7.7 % off. */
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

LOOP_TEST(a_small_sphere_and_the_spot_under_it, sizeof spot_cases / sizeof *spot_cases) {
    const struct spot_case *c = &spot_cases[_i];
    OWNED_PROBLEM p = problem_of(bed_of(c->n, c->spheres), 0, 0);
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
}

/* After the spheres have moved apart and together again, the powers are those of new problems: fine patches go and
 * come. */
TEST(fine_patches_come_and_go_with_a_move) {
    static const double near[2][4] = {{0, 0, 0, .3}, {.315015, 0, 0, .015}},
                        far[2][4] = {{0, 0, 0, .3}, {1, 0, 0, .015}};
    OWNED_PROBLEM p = problem_of(bed_of(2, near), 1, .3), q = problem_of(bed_of(2, far), 1, .3);
    p.temperature[1] = q.temperature[1] = 2;
    p.sources.tolerance = q.sources.tolerance = 1e-9;
    trace_and_solve(&p), trace_and_solve(&q);
    ck_assert_uint_eq(q.heat->division.fours, 0);
    const double power[2] = {p.result.power[1], q.result.power[1]};
    assert_ok(fibrad_heat_move(p.heat, q.scene));
    trace_beams(&p), solve(&p);
    assert_near(p.result.power[1], power[1], 1e-8);
    assert_ok(fibrad_heat_move(p.heat, p.scene));
    trace_beams(&p), solve(&p);
    assert_near(p.result.power[1], power[0], 1e-8);
    ck_assert_int_eq(fibrad_heat_move(q.heat, p.scene), FIBRAD_E_SIZE);
}

/* The parts have equal numbers of spheres, to one, and the spheres of a part are near each other. In a bed of a
 * thousand, few pencils go from part to part, and links to these are kept. If there are more parts than spheres, some
 * are empty. */
TEST(parts_are_compact_and_even) {
    for (uint32_t parts = 1; parts <= 64; parts *= 8) {
        OWNED_PROBLEM p = problem_of(packing(1000, .5, 10, .5, 3, false), 1, 1);
        p.config.directions = 8, p.config.parts = parts;
        trace(&p);
        const fibrad_heat *heat = p.heat;
        uint32_t count[64] = {0}, seen[1000] = {0}, pencils = 0;
        for (uint32_t k = 0; k < p.bed.n; k++) count[heat->part[k]]++, seen[heat->sequence[k]]++;
        for (uint32_t k = 0; k < heat->rows; k++) {
            const unsigned char *at = heat->pencils.pool + heat->pencils.row[k].begin,
                                *end = at + heat->pencils.row[k].bytes;
            for (; at < end; at += fibrad_heat_pencil_bytes(fibrad_heat_pencil_at(at))) pencils++;
        }
        for (uint32_t k = 0; k < p.bed.n; k++) ck_assert_uint_eq(seen[k], 1);
        for (uint32_t k = 0; k < parts; k++) ck_assert(count[k] == p.bed.n / parts || count[k] == p.bed.n / parts + 1);
        ck_assert_uint_le(heat->pencils.links, parts == 1 ? 0 : parts == 8 ? pencils / 2 : pencils);
    }
}

/* What the beams of a row should stand for: to the sphere of a free pair its exact factor, to others as many beams as
 * were followed. The surroundings, the last, get the rest. */
static void beams_expected(const fibrad_heat *heat, uint32_t place, const uint32_t followed[13], double expected[13]) {
    double f;
    expected[12] = heat->beams;
    for (uint32_t body = 0; body < 12; body++) {
        expected[body] = followed[body];
        if (body != place && fibrad_free_pair(heat->scene, place, body, &f)) expected[body] = f * heat->beams;
        expected[12] -= expected[body];
    }
}

/* Beams leave and meet a sphere at the patch that is there. About equal numbers leave each patch. The places of a patch
 * that beams leave or meet lie within 20 degrees of their mean. The beams that are kept are some of those followed, and
 * stand for all, or for the exact factor of a free pair. Bundles have as many beams as their strands. */
TEST(a_patch_of_a_sphere_is_one_place) {
    OWNED_PROBLEM p = problem_of(packing(12, .5, 1.5, .5, 7, false), 1, 1);
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
        double stands_for[13];
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
        beams_expected(heat, place, followed, stands_for);
        for (uint32_t body = 0; body <= 12; body++) {
            const struct strands *s = &strands[body];
            for (uint32_t k = 0; k < s->count; k++) missed += met[body][k] < s->beams[k];
            kept += s->sum;
            if (s->count > 0) ck_assert_double_eq_tol(s->share * s->sum, stands_for[body], 3);
        }
    }
    ck_assert_uint_gt(kept, p.bed.n * heat->beams / 4);
    ck_assert_uint_le(missed, 5); /* these graze a sphere: the kernel's points are floats */
    ck_assert_double_gt(leaving, cos(PI / 9));
}

/* The same holds for the wall of a cylinder and the rays that go there. Patches are even on the square that stands on a
 * corner. On the cylinder this makes them 2/pi to 4/pi of their mean width. */
TEST(a_patch_of_a_cylinder_is_one_place) {
    enum { TURNS = 2048, UPS = 128 };
    OWNED_PROBLEM p = problem_of(BED({.3, -.2, .4, 1e-4}), 1, 1);
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
            const uint32_t patch = fibrad_heat_wall_patch(heat, FIBRAD_CYLINDER, at, true) - first;
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
            missed += fibrad_heat_ends(heat, o, w, FIBRAD_NO_SIDE, 0) != first + patch;
        }
    for (uint32_t k = 0; k < patches; k++) {
        ck_assert_double_gt(mean[k][3] / (TURNS * UPS) * patches, .8 * 2 / PI);
        ck_assert_double_lt(mean[k][3] / (TURNS * UPS) * patches, 1.2 * 4 / PI);
    }
    ck_assert_double_gt(turning, cos(1.05 * 4 / squares[0]));
    ck_assert_double_lt(rising, .5 / squares[1]);
    ck_assert_uint_eq(missed, 0);
    free(mean);
}
