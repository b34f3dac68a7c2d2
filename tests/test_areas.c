/* test_areas.c - visible areas in one window against exact slicing: at random, and in every degenerate arrangement we
 * could think of. SPDX-License-Identifier: MIT */
#include <stdio.h>

#define FIBRAD_ISA_SUFFIX _scalar
#include "bed/areas_lanes.h"
#include "reference.h"
#include "scenes.h"
#include "suite.h"

#define MOST 400

struct window {
    uint32_t n;
    double u[MOST], v[MOST], r[MOST];
};

static void put(struct window *w, double u, double v, double r) {
    ck_assert_uint_lt(w->n, MOST);
    w->u[w->n] = u, w->v[w->n] = v, w->r[w->n++] = r;
}

/* The largest difference from slicing; checks closure and signs on the way. */
static double worst_of(const struct window *w) {
    fibrad_arena arena = {0};
    fibrad_areas areas;
    fibrad_areas_layout(&areas, &arena, MOST);
    size_t size = arena.used;
    void *block = block_of(size);
    memset(block, 0, size);
    arena = (fibrad_arena){block, 0, size};
    fibrad_areas_layout(&areas, &arena, MOST);

    double mine[MOST] = {0}, expected[MOST], rest_expected, total = 0, worst = 0;
    fibrad_areas_begin_scalar(&areas);
    bool open = true;
    for (uint32_t k = 0; k < w->n && open; k++) open = fibrad_areas_disc_scalar(&areas, k, w->u[k], w->v[k], w->r[k]);
    double rest = fibrad_areas_end_scalar(&areas);
    ck_assert(!areas.overflow);
    for (uint32_t c = 1; c < areas.circles; c++) mine[areas.whose[c]] = areas.area[c];
    ck_assert_int_eq(reference_window(w->n, w->u, w->v, w->r, expected, &rest_expected), REFERENCE_OK);
    for (uint32_t k = 0; k < w->n; k++) {
        ck_assert_double_gt(mine[k], -1e-12);
        worst = fmax(worst, fabs(mine[k] - expected[k]));
        total += mine[k];
    }
    ck_assert_double_eq_tol(total + rest, 3.14159265358979323846, 1e-12);
    worst = fmax(worst, fabs(rest - rest_expected));
    free(block);
    return worst;
}

static double random_in(double low, double high) {
    static uint64_t count;
    return low + (high - low) * bed_make_random(77, count++);
}

START_TEST(random_windows) {
    double worst = 0;
    for (int round = 0; round < 3000; round++) {
        struct window w = {0};
        uint32_t n = 1 + (uint32_t)random_in(0, 16);
        double scale = pow(10, random_in(-1, 1));
        for (uint32_t k = 0; k < n; k++) {
            double r = scale * random_in(.1, 1), d = (1 + r) * sqrt(random_in(0, 1)), t = random_in(0, 6.2831853);
            put(&w, d * cos(t), d * sin(t), r);
        }
        worst = fmax(worst, worst_of(&w));
    }
    printf("random windows: %.2g\n", worst);
    ck_assert_double_lt(worst, 1e-12);
}
END_TEST

START_TEST(hundreds_of_discs) {
    double worst = 0;
    for (int round = 0; round < 10; round++) {
        struct window w = {0};
        for (uint32_t k = 0; k < MOST - 1; k++) put(&w, random_in(-1, 1), random_in(-1, 1), random_in(.01, .12));
        worst = fmax(worst, worst_of(&w));
    }
    printf("hundreds of discs: %.2g\n", worst);
    ck_assert_double_lt(worst, 1e-12);
}
END_TEST

/* Discs 1e-6 to 1e6 times as large as the window, their edges across it. */
START_TEST(large_and_small_discs) {
    for (int power = -6; power <= 6; power++) {
        double worst = 0;
        for (int round = 0; round < 200; round++) {
            struct window w = {0};
            double r = pow(10, power);
            for (uint32_t k = 0; k < 6; k++) {
                double d = power <= 0 ? random_in(0, 1) : r + random_in(-1, 1), t = random_in(0, 6.2831853);
                put(&w, d * cos(t), d * sin(t), r * (power <= 0 ? random_in(.5, 1) : 1));
            }
            worst = fmax(worst, worst_of(&w));
        }
        printf("radius 1e%+d: %.2g\n", power, worst);
        ck_assert_double_lt(worst, 1e-14 * fmax(100, 10 * pow(10, power)));
    }
}
END_TEST

/* What lattices do: circles that are tangent, identical, concentric, or meet in one point, exactly and almost. */
START_TEST(degenerate_windows) {
    static const double nudges[] = {0, 0x1p-52, -0x1p-52, 1e-15, -1e-15, 1e-12, -1e-12, 1e-9, -1e-9, 1e-6, -1e-6};
    double worst = 0;
    for (size_t a = 0; a < sizeof nudges / sizeof *nudges; a++)
        for (size_t b = 0; b < sizeof nudges / sizeof *nudges; b++) {
            double e = nudges[a], f = nudges[b], h = sqrt(3) / 2;
            struct window sets[] = {
                {.n = 2, .u = {e, f}, .v = {0, 0}, .r = {1, 1}},                         /* equal to the window */
                {.n = 3, .u = {.5, .5 + e, .5}, .v = {0, f, 0}, .r = {.5, .5, .5}},      /* identical, tangent inside */
                {.n = 3, .u = {.5, -.5 + e, 0}, .v = {0, f, .3}, .r = {.5, .5, .6}},     /* tangent to each other */
                {.n = 3, .u = {2 + e, -2, 0}, .v = {0, f, .5}, .r = {1, 1, .5}},         /* tangent outside */
                {.n = 3, .u = {0, e, 0}, .v = {0, f, 0}, .r = {.3, .6, .9}},             /* concentric */
                {.n = 3, .u = {0, e, f}, .v = {0, 0, 0}, .r = {.9, .6, 1.2}},            /* concentric, hidden */
                {.n = 3, .u = {1, -.5, -.5}, .v = {0, h + e, -h + f}, .r = {1, 1, 1}},   /* all through the centre */
                {.n = 4, .u = {1, 0, -1, 0}, .v = {0, 1, e, -1 + f}, .r = {1, 1, 1, 1}}, /* four through it */
                {.n = 4, .u = {1, 0, -1, 0}, .v = {0, 1, e, -1 + f}, .r = {h, h, h, h}},
                {.n = 6, .u = {1, .5, -.5, -1, -.5, .5}, .v = {0, h, h, e, -h, -h + f}, .r = {1, 1, 1, 1, 1, 1}},
                {.n = 7,
                 .u = {2, 1, -1, -2, -1, 1, 0},
                 .v = {0, 2 * h, 2 * h, e, -2 * h, -2 * h, f},
                 .r = {1, 1, 1, 1, 1, 1, 1}}, /* six around one */
                {.n = 4,
                 .u = {.5, 1, .25, .75 + e},
                 .v = {0, 0, f, 0},
                 .r = {.5, 1, .25, .75}}, /* tangent at one point */
                {.n = 4, .u = {1, .5, .75 + e, .25}, .v = {0, 0, f, 0}, .r = {1, .5, .75, .25}},
                {.n = 2, .u = {3 + e, -3}, .v = {0, f}, .r = {4, 4}}, /* tangent to the window within */
                {.n = 2, .u = {3 + e, 3}, .v = {0, f}, .r = {3, 3}},  /* its edge through the centre */
                {.n = 3, .u = {.7 + e, .7, -.7}, .v = {.7, -.7 + f, 0}, .r = {.7, .7, .7}},
            };
            for (size_t s = 0; s < sizeof sets / sizeof *sets; s++) {
                double error = worst_of(&sets[s]);
                if (error > worst) worst = error;
                ck_assert_msg(error < 1e-11, "set %zu, nudges %g %g: %g", s, e, f, error);
            }
        }
    printf("degenerate windows: %.2g\n", worst);
}
END_TEST

/* Perfect lattices seen along symmetry axes and next to them. */
START_TEST(lattices_along_their_axes) {
    static const double axes[][3] = {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 1, 2}, {0, 1, 2}, {1, 2, 3}};
    double worst = 0;
    for (int kind = 0; kind < 3; kind++)
        for (size_t a = 0; a < sizeof axes / sizeof *axes; a++)
            for (int step = 0; step < 40; step++) {
                double tilt = step == 0 ? 0 : ldexp(1, -53 + step), w[3] = {axes[a][0] + tilt, axes[a][1], axes[a][2]};
                double length = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
                for (int axis = 0; axis < 3; axis++) w[axis] /= length;
                double e[3] = {w[2], 0, -w[0]}, side = sqrt(e[0] * e[0] + e[2] * e[2]);
                e[0] /= side, e[2] /= side;
                double g[3] = {w[1] * e[2] - w[2] * e[1], w[2] * e[0] - w[0] * e[2], w[0] * e[1] - w[1] * e[0]};
                struct bed bed = lattice("pif"[kind], 9);
                struct window window = {0};
                double depth[MOST];
                for (uint32_t i = 1; i < bed.n; i++) {
                    double d = w[0] * bed.x[i] + w[1] * bed.y[i] + w[2] * bed.z[i];
                    double u = e[0] * bed.x[i] + e[1] * bed.y[i] + e[2] * bed.z[i];
                    double v = g[0] * bed.x[i] + g[1] * bed.y[i] + g[2] * bed.z[i];
                    if (!(d > 0 && u * u + v * v < 4)) continue;
                    uint32_t to = window.n;
                    put(&window, u, v, 1);
                    for (; to > 0 && depth[to - 1] > d; to--) {
                        depth[to] = depth[to - 1];
                        window.u[to] = window.u[to - 1], window.v[to] = window.v[to - 1];
                    }
                    depth[to] = d, window.u[to] = u, window.v[to] = v;
                }
                worst = fmax(worst, worst_of(&window));
                bed_free(&bed);
            }
    printf("lattices along their axes: %.2g\n", worst);
    ck_assert_double_lt(worst, 1e-11);
}
END_TEST

int main(void) {
    Suite *suite = suite_create("areas");
    TCase *tcase = suite_case(suite, "areas");
    tcase_add_test(tcase, random_windows);
    tcase_add_test(tcase, hundreds_of_discs);
    tcase_add_test(tcase, large_and_small_discs);
    tcase_add_test(tcase, degenerate_windows);
    tcase_add_test(tcase, lattices_along_their_axes);
    return suite_run(suite);
}
