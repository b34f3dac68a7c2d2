/* test_surface.c - the surface method against a plain sum, with each skip on and off. SPDX-License-Identifier: MIT */
#include "fibrad_surface.h"
#include "scenes.h"
#include "suite.h"
#include "surface/surface_lanes.h"
#include "surface_plain.h"

#define MOST 16 /* obstacles */

static const uint32_t fibonacci[] = {8, 13, 21, 34, 55, 89, 144, 233, 377, 610, 987};
static const double gaps[] = {0, .01, .02, .05, .1, .5, 1, 2, 4, 6, 8};
enum { GAPS = sizeof gaps / sizeof *gaps };

/* ---- scenes ---- */

static uint64_t state;
static double uniform(double low, double high) { /* splitmix64 */
    uint64_t z = state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return low + (high - low) * (double)((z ^ z >> 31) >> 11) * 0x1p-53;
}

typedef struct scene {
    double r1, r2, gap, x[MOST], y[MOST], z[MOST], r[MOST];
    fibrad_spheres obstacles;
} scene;

/* Makes obstacles between, beside and behind two spheres. In some scenes one obstacle hides all. Some scenes have
 * overlaps. */
static void make_scene(scene *s, uint32_t k) {
    state = k;
    s->r1 = uniform(.5, 2);
    s->r2 = s->r1 * pow(4, uniform(-1, 1));
    s->gap = k % 3 == 0 ? 0 : s->r1 * uniform(0, 5);
    const double d = s->r1 + s->r2 + s->gap, allowed = k % 5 == 0 ? .05 : 0;
    s->obstacles = (fibrad_spheres){.x = s->x, .y = s->y, .z = s->z, .r = s->r};
    for (int tries = 0; tries < 400 && s->obstacles.n < MOST; tries++) {
        const double r = s->r1 * pow(3, uniform(-1, 1)), x = uniform(-2, 2) * s->r1, y = uniform(-2, 2) * s->r1;
        const double z = uniform(-2, d + 2), rho2 = x * x + y * y;
        if (sqrt(rho2 + z * z) < r + s->r1 * (1 - allowed) ||
            sqrt(rho2 + (z - d) * (z - d)) < r + s->r2 * (1 - allowed))
            continue;
        const uint32_t n = s->obstacles.n++;
        s->x[n] = x, s->y[n] = y, s->z[n] = z, s->r[n] = r;
    }
}

static double scratch[FIBRAD_SURFACE_SCRATCH(MOST)];

static double factor(const scene *s, uint32_t nodes, uint32_t flags, int isa, fibrad_surface_facts *facts) {
    const fibrad_surface_rule rule = {.nodes = nodes, .flags = flags, .isa = isa};
    double f12 = NAN;
    assert_ok(fibrad_surface_pair(s->r1, s->r2, s->gap, &s->obstacles, &rule, scratch, &f12, facts));
    return f12;
}

/* ---- tests ---- */

/* docs/validation.md: largest relative error over the gaps, in per cent. */
TEST(errors_are_those_published) {
    static const double radius[] = {.1, .3, .7, 1};
    static const struct {
        uint32_t nodes;
        double error[4];
    } table[] = {{34, {-21.78, -16.18, -15.97, -10.05}}, {55, {-2.17, -1.50, -4.62, -4.76}},
                 {89, {12.96, .47, -4.79, -5.40}},       {144, {13.45, -2.82, -3.59, -3.94}},
                 {233, {6.50, -2.21, -1.69, -1.66}},     {610, {-.27, -.05, -.15, -.13}}};
    for (size_t t = 0; t < sizeof table / sizeof *table; t++)
        for (int p = 0; p < 4; p++) {
            double worst = 0;
            for (int g = 0; g < GAPS; g++) {
                double f12, exact;
                const fibrad_surface_rule rule = {.nodes = table[t].nodes, .flags = FIBRAD_SURFACE_NO_CORRECTION};
                assert_ok(fibrad_surface_pair(1, radius[p], gaps[g], NULL, &rule, NULL, &f12, NULL));
                assert_ok(fibrad_pair_exact(1, radius[p], gaps[g], &exact));
                ck_assert_double_finite(f12 / exact);
                if (fabs(f12 / exact - 1) > fabs(worst)) worst = f12 / exact - 1;
            }
            ck_assert_double_eq_tol(100 * worst, table[t].error[p], .01);
        }
}

TEST(equals_plain_sum) {
    for (uint32_t k = 0; k < 150; k++) {
        scene s;
        make_scene(&s, k);
        const uint32_t nodes = fibonacci[k % 6];
        double unblocked, raw, exact;
        surface_plain(s.r1, s.r2, s.gap, &s.obstacles, nodes, &unblocked, &raw);
        fibrad_pair_exact(s.r1, s.r2, s.gap, &exact);
        const uint32_t plain_flags = FIBRAD_SURFACE_NO_CORRECTION;
        ck_assert_double_eq_tol(factor(&s, nodes, plain_flags, FIBRAD_ISA_BEST, NULL), raw, 1e-12 * unblocked);
        ck_assert_double_eq_tol(factor(&s, nodes, 0, FIBRAD_ISA_BEST, NULL), raw / unblocked * exact, 1e-12 * exact);
    }
}

TEST(skips_change_nothing) {
    static const uint32_t skip[] = {FIBRAD_SURFACE_NO_HORIZON, FIBRAD_SURFACE_NO_REGION, FIBRAD_SURFACE_NO_EXACT,
                                    FIBRAD_SURFACE_NO_HIDDEN};
    uint32_t hidden = 0, clear = 0, fewer_tests = 0, partly = 0;
    for (uint32_t k = 0; k < 600; k++) {
        scene s;
        make_scene(&s, k);
        if (k % 4 == 0) s.obstacles.n = s.obstacles.n > 1 ? 1 : s.obstacles.n;
        for (uint32_t raw = 0; raw < 2; raw++) {
            fibrad_surface_facts with, without;
            const double f = factor(&s, 55, raw, FIBRAD_ISA_SCALAR, &with);
            for (int c = 0; c < 4; c++) {
                const double g = factor(&s, 55, raw | skip[c], FIBRAD_ISA_SCALAR, &without);
                ck_assert_msg(memcmp(&f, &g, sizeof f) == 0, "scene %u skip %d: %.17g %.17g", k, c, f, g);
                if (c == 1) fewer_tests += with.tests < without.tests;
            }
            const double g = factor(&s, 55, raw | 2 | 4 | 8 | 16, FIBRAD_ISA_SCALAR, &without);
            ck_assert(memcmp(&f, &g, sizeof f) == 0);
            hidden += f == 0 && with.rays == 0;
            clear += f > 0 && with.rays == 0;
            partly += f > 0 && with.blocked < with.unblocked;
        }
    }
    /* each skip was used */
    ck_assert_uint_ge(hidden, 20);
    ck_assert_uint_gt(clear, 20);
    ck_assert_uint_gt(fewer_tests, 200);
    ck_assert_uint_gt(partly, 200);
}

/* The third sphere touches both spheres. After the correction the error at 55 nodes against 987 is a third of the raw
 * error. */
TEST(correction_divides_the_error_behind_a_third_sphere) {
    static const struct {
        double radius, raw, corrected;
    } table[] = {{.1, 1.8, 1.81}, {.3, 1.6, .7}, {.7, 4.84, 1.3}, {1, 5.15, 1.5}};
    for (int t = 0; t < 4; t++) {
        const double r = table[t].radius;
        double raw = 0, corrected = 0;
        for (int g = 0; g < GAPS; g++) {
            const double d = 1 + r + gaps[g], to1 = 1 + r, to2 = 2 * r, z = (to1 * to1 - to2 * to2 + d * d) / (2 * d);
            if (z >= to1) continue;
            scene s = {.r1 = 1, .r2 = r, .gap = gaps[g], .x = {sqrt(to1 * to1 - z * z)}, .z = {z}, .r = {r}};
            s.obstacles = (fibrad_spheres){.x = s.x, .y = s.y, .z = s.z, .r = s.r, .n = 1};
            const double truth = factor(&s, 987, FIBRAD_SURFACE_NO_CORRECTION, FIBRAD_ISA_BEST, NULL);
            worst_of(&raw, fabs(factor(&s, 55, FIBRAD_SURFACE_NO_CORRECTION, FIBRAD_ISA_BEST, NULL) / truth - 1));
            worst_of(&corrected, fabs(factor(&s, 55, 0, FIBRAD_ISA_BEST, NULL) / truth - 1));
        }
        ck_assert_double_le(100 * raw, table[t].raw);
        ck_assert_double_le(100 * corrected, table[t].corrected);
    }
}

TEST(scales_with_the_unit) {
    scene s;
    make_scene(&s, 7);
    const double f = factor(&s, 55, 0, FIBRAD_ISA_BEST, NULL);
    static const double units[] = {1e-140, 1e-3, 1e140};
    for (int u = 0; u < 3; u++) {
        scene t = s;
        t.obstacles = (fibrad_spheres){.x = t.x, .y = t.y, .z = t.z, .r = t.r, .n = s.obstacles.n};
        t.r1 *= units[u], t.r2 *= units[u], t.gap *= units[u];
        for (uint32_t k = 0; k < t.obstacles.n; k++)
            t.x[k] *= units[u], t.y[k] *= units[u], t.z[k] *= units[u], t.r[k] *= units[u];
        assert_near(factor(&t, 55, 0, FIBRAD_ISA_BEST, NULL), f, 1e-12);
    }
}

/* Scratch memory begins on any boundary of a double and has no more than the stated size. Obstacles have any stride. */
TEST(scratch_and_strides_change_no_bit) {
    static double room[8 + FIBRAD_SURFACE_SCRATCH(MOST) + 8], at[MOST][3], r[5 * MOST];
    for (uint32_t k = 0; k < 200; k++) {
        scene s;
        make_scene(&s, k);
        const fibrad_surface_rule rule = {.nodes = 34};
        const double f = factor(&s, 34, 0, FIBRAD_ISA_BEST, NULL);
        const size_t from = k % 8, end = from + FIBRAD_SURFACE_SCRATCH(s.obstacles.n);
        double g = NAN, h = NAN;
        memset(room, 0xa5, sizeof room);
        const double guard = room[0];
        assert_ok(fibrad_surface_pair(s.r1, s.r2, s.gap, &s.obstacles, &rule, room + from, &g, NULL));
        ck_assert(memcmp(&f, &g, sizeof f) == 0);
        for (size_t d = 0; d < sizeof room / sizeof *room; d++)
            if (d < from || d >= end) ck_assert(memcmp(&room[d], &guard, sizeof guard) == 0);
        for (uint32_t o = 0; o < s.obstacles.n; o++) {
            at[o][0] = s.x[o], at[o][1] = s.y[o], at[o][2] = s.z[o];
            r[5 * o] = s.r[o];
        }
        const fibrad_spheres strided = {&at[0][0], &at[0][1], &at[0][2], r, s.obstacles.n, .stride = 3, .stride_r = 5};
        assert_ok(fibrad_surface_pair(s.r1, s.r2, s.gap, &strided, &rule, scratch, &h, NULL));
        ck_assert(memcmp(&f, &h, sizeof f) == 0);
    }
}

TEST(refuses_what_is_wrong) {
    double f12 = 42, x = 0, y = 5, z = 0, r = 1;
    fibrad_spheres o = {.x = &x, .y = &y, .z = &z, .r = &r, .n = 1};
    const fibrad_surface_rule good = {0}, many = {.nodes = 56}, flags = {.flags = 32}, isa = {.isa = 9};
    assert_invalid(fibrad_surface_pair(1, 1, 0, NULL, &good, NULL, NULL, NULL));
    assert_invalid(fibrad_surface_pair(1, 1, 0, &o, &good, NULL, &f12, NULL));
    ck_assert_int_eq(fibrad_surface_pair(1, 1, 0, NULL, &many, NULL, &f12, NULL), FIBRAD_E_TABLE);
    assert_invalid(fibrad_surface_pair(1, 1, 0, NULL, &flags, NULL, &f12, NULL));
    assert_invalid(fibrad_surface_pair(1, 1, 0, NULL, &isa, NULL, &f12, NULL));
    assert_invalid(fibrad_surface_pair(0, 1, 0, NULL, &good, NULL, &f12, NULL));
    assert_invalid(fibrad_surface_pair(1, 1, 1e71, NULL, &good, NULL, &f12, NULL));
    assert_invalid(fibrad_surface_pair(1, 1e71, 0, NULL, &good, NULL, &f12, NULL));
    assert_invalid(fibrad_surface_pair(1, NAN, 0, NULL, &good, NULL, &f12, NULL));
    r = 0;
    assert_invalid(fibrad_surface_pair(1, 1, 0, &o, &good, scratch, &f12, NULL));
    r = 1, y = INFINITY;
    assert_invalid(fibrad_surface_pair(1, 1, 0, &o, &good, scratch, &f12, NULL));
    ck_assert(f12 == 42);
}
