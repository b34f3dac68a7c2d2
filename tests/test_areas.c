/* test_areas.c - visible areas in one window against exact slicing: at random, and in every degenerate arrangement that
 * we could think of. SPDX-License-Identifier: MIT */
#include <stdio.h>

#define FIBRAD_ISA_SUFFIX _scalar
#include "base/dispatch.h"
#include "window/arrangement_lanes.h"
#include "window/clip_lanes.h"
#include "window/dense_lanes.h"
#include "papers/pair/reference.h"
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

typedef void begin_function(fibrad_areas *areas);
typedef bool disc_function(fibrad_areas *areas, uint32_t whose, double x, double y, double r);
typedef uint32_t discs_function(fibrad_areas *areas, uint32_t first, const uint32_t *which, uint32_t count,
                                const double *x, const double *y, const double *r);
typedef double end_function(fibrad_areas *areas);
typedef bool resolve_function(fibrad_areas *areas, uint32_t circles);

FIBRAD_DECLARE_VERSIONS(begin_function, fibrad_areas_begin);
FIBRAD_DECLARE_VERSIONS(discs_function, fibrad_areas_discs);
FIBRAD_DECLARE_VERSIONS(end_function, fibrad_areas_end);
FIBRAD_DECLARE_VERSIONS(resolve_function, fibrad_dense_resolve);

struct method {
    begin_function *begin;
    disc_function *disc;
    end_function *end;
};

static int isa = FIBRAD_ISA_SCALAR; /* of clipping */

static void begin(fibrad_areas *areas) { FIBRAD_VERSION_OF(fibrad_areas_begin, isa)(areas); }

/* Hands over one disc, as a list of one element. */
static bool add_disc(fibrad_areas *areas, uint32_t whose, double x, double y, double r) {
    FIBRAD_VERSION_OF(fibrad_areas_discs, isa)(areas, whose, &(uint32_t){0}, 1, &x, &y, &r);
    return areas->open;
}

static double end(fibrad_areas *areas) { return FIBRAD_VERSION_OF(fibrad_areas_end, isa)(areas); }

/* Begins a window in which clipping works from the first disc on as it does in windows with many discs. */
static void begin_dense(fibrad_areas *areas) {
    begin(areas);
    ck_assert(FIBRAD_VERSION_OF(fibrad_dense_resolve, isa)(areas, 1));
}

static const struct method both = {begin, add_disc, end}, dense = {begin_dense, add_disc, end};
static const struct method arrangement = {fibrad_arrangement_begin_scalar, fibrad_arrangement_disc_scalar,
                                          fibrad_arrangement_end_scalar};

static uint32_t windows, fallbacks;

/* Makes an object with room for windows of MOST discs. */
static fibrad_areas areas_make(void) {
    fibrad_arena arena = {0};
    fibrad_areas areas = {0};
    fibrad_areas_layout(&areas, &arena, MOST);
    size_t size = arena.used;
    void *block = block_of(size);
    memset(block, 0, size);
    arena = (fibrad_arena){block, 0, size};
    fibrad_areas_layout(&areas, &arena, MOST);
    return areas;
}

static void areas_free(fibrad_areas *areas) { free(areas->x); } /* the first array begins the block */

#define OWNED_AREAS OWNED_BY(areas_free) fibrad_areas

/* Finds the visible areas by one method, and after them the area that is still open. Checks closure and signs. */
static void measure(const struct method *method, fibrad_areas *areas, const struct window *w, double area[MOST + 1]) {
    method->begin(areas);
    bool open = true;
    for (uint32_t k = 0; k <= w->n; k++) area[k] = 0;
    for (uint32_t k = 0; k < w->n && open; k++) open = method->disc(areas, k, w->u[k], w->v[k], w->r[k]);
    area[w->n] = method->end(areas);
    ck_assert(!areas->overflow);
    for (uint32_t c = 1; c < areas->circles; c++) area[areas->whose[c]] = areas->area[c];
    double total = 0;
    for (uint32_t k = 0; k <= w->n; k++) {
        ck_assert_double_gt(area[k],
                            -1e-8); /* three circles tangent in one point, an ulp beside it: docs/accuracy.md */
        total += area[k];
    }
    ck_assert_double_eq_tol(total, 3.14159265358979323846, 1e-12);
}

static double difference(uint32_t n, const double *a, const double *b) {
    double worst = 0;
    for (uint32_t k = 0; k < n; k++) worst_of(&worst, fabs(a[k] - b[k]));
    return worst;
}

/* The largest difference between any method and slicing. */
static double error_of(const struct window *w) {
    fibrad_areas areas = areas_make();
    double mine[MOST + 1], robust[MOST + 1], many[MOST + 1], expected[MOST + 1], rest;
    measure(&both, &areas, w, mine);
    windows++, fallbacks += areas.fallbacks;
    measure(&arrangement, &areas, w, robust);
    measure(&dense, &areas, w, many);
    ck_assert_int_eq(reference_window(w->n, w->u, w->v, w->r, expected, &rest), REFERENCE_OK);
    expected[w->n] = rest;
    areas_free(&areas);
    double worst = difference(w->n + 1, mine, expected);
    worst_of(&worst, difference(w->n + 1, robust, expected));
    worst_of(&worst, difference(w->n + 1, many, expected));
    return worst;
}

/* The part of the windows so far that clipping has left to arrangements. */
static double fallbacks_part(void) {
    double part = (double)fallbacks / windows;
    windows = fallbacks = 0;
    return part;
}

static double random_in(double low, double high) {
    static uint64_t count;
    return low + (high - low) * bed_make_random(77, count++);
}

TEST(random_windows_have_the_areas_of_slices) {
    double worst = 0;
    for (int round = 0; round < 3000; round++) {
        struct window w = {0};
        uint32_t n = 1 + (uint32_t)random_in(0, 16);
        double scale = pow(10, random_in(-1, 1));
        for (uint32_t k = 0; k < n; k++) {
            double r = scale * random_in(.1, 1), d = (1 + r) * sqrt(random_in(0, 1)), t = random_in(0, 6.2831853);
            put(&w, d * cos(t), d * sin(t), r);
        }
        worst_of(&worst, error_of(&w));
    }
    printf("random windows: %.2g\n", worst);
    ck_assert_double_lt(worst, 1e-12);
    ck_assert_double_eq(fallbacks_part(), 0);
}

TEST(hundreds_of_discs_have_the_areas_of_slices) {
    double worst = 0;
    for (int round = 0; round < 10; round++) {
        struct window w = {0};
        for (uint32_t k = 0; k < MOST - 1; k++) {
            double u = random_in(-1, 1), v = random_in(-1, 1);
            put(&w, u, v, random_in(.01, .12));
        }
        worst_of(&worst, error_of(&w));
    }
    printf("hundreds of discs: %.2g\n", worst);
    ck_assert_double_lt(worst, 1e-12);
    ck_assert_double_eq(fallbacks_part(), 0);
}

/* The discs are 1e-6 to 1e6 times as large as the window, and their edges cross it. */
TEST(discs_of_all_sizes_have_the_areas_of_slices) {
    for (int power = -6; power <= 6; power++) {
        double worst = 0;
        for (int round = 0; round < 200; round++) {
            struct window w = {0};
            double r = pow(10, power);
            for (uint32_t k = 0; k < 6; k++) {
                double d = power <= 0 ? random_in(0, 1) : r + random_in(-1, 1), t = random_in(0, 6.2831853);
                put(&w, d * cos(t), d * sin(t), r * (power <= 0 ? random_in(.5, 1) : 1));
            }
            worst_of(&worst, error_of(&w));
        }
        double part = fallbacks_part();
        printf("radius 1e%+d: %.2g, left to arrangements %.3g\n", power, worst, part);
        ck_assert_double_eq(part, power > 3);
        ck_assert_double_lt(worst, 1e-14 * fmax(100, 10 * pow(10, power)));
    }
}

/* Lattices have such windows: circles that are tangent, identical, concentric, or meet in one point, exactly and
 * almost. */
TEST(degenerate_windows_have_the_areas_of_slices) {
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
                {.n = 3, .u = {1, -.5, -.5}, .v = {0, h + e, -h + f}, .r = {1, 1, 1}},   /* all cross the centre */
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
                {.n = 2, .u = {3 + e, 3}, .v = {0, f}, .r = {3, 3}},  /* the edge passes through the centre */
                {.n = 3, .u = {.7 + e, .7, -.7}, .v = {.7, -.7 + f, 0}, .r = {.7, .7, .7}},
            };
            for (size_t s = 0; s < sizeof sets / sizeof *sets; s++) {
                double error = error_of(&sets[s]);
                worst_of(&worst, error);
                ck_assert_msg(error < 1e-11, "set %zu, nudges %g %g: %g", s, e, f, error);
            }
        }
    printf("degenerate windows: %.2g, left to arrangements %.3g\n", worst, fallbacks_part());
}

/* Perfect lattices seen along symmetry axes and next to them. */
TEST(lattices_are_right_along_their_axes) {
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
                OWNED_BED bed = lattice("pif"[kind], 9);
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
                worst_of(&worst, error_of(&window));
            }
    printf("lattices along their axes: %.2g, left to arrangements %.3g\n", worst, fallbacks_part());
    ck_assert_double_lt(worst, 1e-11);
}

/* Both methods are compared on windows whose circles meet in multiples of 1/4 ... 1/8 of a radius, or beside such
 * points by as much as decides between the methods. */
TEST(clipping_agrees_with_the_arrangement) {
    OWNED_AREAS areas = areas_make();
    double worst = 0, clipped[MOST + 1], robust[MOST + 1], many[MOST + 1];
    uint32_t left[2] = {0, 0}; /* windows left to arrangements, by ordinary clipping and by clipping for many discs */
    const int rounds = 20000;
    for (int round = 0; round < rounds; round++) {
        struct window w = {0};
        uint32_t n = 1 + (uint32_t)random_in(0, 16);
        double grid = floor(random_in(3, 9)), nudge = pow(10, random_in(-17, -5)), turn = random_in(0, 1) < .3 ? 1 : 0;
        for (uint32_t k = 0; k < n; k++) {
            double u = floor(random_in(-2, 2) * grid) / grid, v = floor(random_in(-2, 2) * grid) / grid;
            double r = ceil(random_in(0, 1.5) * grid) / grid, du = nudge * random_in(-1, 1),
                   dv = nudge * random_in(-1, 1);
            put(&w, u + du, v * (1 - turn * .13397459621556135) + dv, r);
        }
        areas.fallbacks = 0;
        measure(&both, &areas, &w, clipped);
        left[0] += areas.fallbacks, areas.fallbacks = 0;
        measure(&dense, &areas, &w, many);
        left[1] += areas.fallbacks;
        measure(&arrangement, &areas, &w, robust);
        worst_of(&worst, difference(n + 1, clipped, robust));
        worst_of(&worst, difference(n + 1, many, robust));
    }
    const double part[2] = {(double)left[0] / rounds, (double)left[1] / rounds};
    printf("clipping against arrangements: %.2g, left to arrangements %.3g, %.3g\n", worst, part[0], part[1]);
    ck_assert_double_lt(worst, 1e-12);
    for (int way = 0; way < 2; way++) ck_assert(part[way] > .05 && part[way] < .5); /* all have been tried */
}

/* The window has many small discs, then large ones and a degenerate one. So the arrangement begins in memory that dense
 * clipping has filled. The lanes beyond its last arc must not look up what is no circle. */
TEST(the_arrangement_begins_where_dense_clipping_ends) {
    OWNED_AREAS areas = areas_make();
    const struct isas isas = isas_there();
    double first[MOST + 1], other[MOST + 1];
    for (int round = 0; round < 200; round++) {
        struct window w = {0};
        for (uint32_t k = 0; k < 356; k++) {
            const double r = k % 60 == 59 ? random_in(2, 9) : random_in(.002, .01), t = random_in(0, 6.2831853);
            const double d = r > 1 ? r + random_in(.8, 1) : .97 * sqrt(random_in(0, 1));
            put(&w, d * cos(t), d * sin(t), r);
        }
        put(&w, .5, 0, .5); /* tangent to the window */
        measure(&dense, &areas, &w, first);
        for (int s = 1; s < isas.count; s++) {
            isa = isas.set[s];
            measure(&dense, &areas, &w, other);
            ck_assert_mem_eq(first, other, (w.n + 1) * sizeof *first);
        }
        isa = FIBRAD_ISA_SCALAR;
    }
    ck_assert_uint_gt(areas.fallbacks, 100); /* as often as no disc hides the point of contact before */
}

/* Arrangements treat the windows that clipping must not decide, and these are counted. Ordinary windows are left to
 * clipping. */
TEST(clipping_leaves_close_decisions_to_the_arrangement) {
    const struct window degenerate[] = {
        {.n = 1, .u = {0}, .v = {0}, .r = {1}},                                            /* equal to the window */
        {.n = 2, .u = {.5, .5}, .v = {.1, .1}, .r = {.4, .4}},                             /* identical */
        {.n = 1, .u = {.5}, .v = {0}, .r = {.5}},                                          /* tangent within */
        {.n = 1, .u = {2 - 1e-12}, .v = {0}, .r = {1}},                                    /* tangent without */
        {.n = 2, .u = {-.3, .3}, .v = {0, 0}, .r = {.3, .3}},                              /* tangent to each other */
        {.n = 3, .u = {.5, -.5, 0}, .v = {0, 0, .75901699437494742}, .r = {.75, .75, .2}}, /* three through a point */
        {.n = 1, .u = {2000}, .v = {0}, .r = {2000}},                                      /* too large */
        /* the last disc covers the others and the tip of the opening between two of them, which is 4e-11 wide there */
        {.n = 4, .u = {0, -.499999, .499999, 0}, .v = {-.55, 0, 0, 1e-3 + 1e-8 - .2}, .r = {.55, .5, .5, .2}},
    };
    for (size_t d = 0; d < sizeof degenerate / sizeof *degenerate; d++) {
        ck_assert_double_lt(error_of(&degenerate[d]), 1e-11);
        ck_assert_msg(fallbacks_part() == 1, "window %zu was not degenerate", d);
    }
    const struct window plain[] = {
        {.n = 0},
        {.n = 1, .u = {3}, .v = {0}, .r = {1}},                            /* beside the window */
        {.n = 1, .u = {.1}, .v = {0}, .r = {1.2}},                         /* covers it */
        {.n = 3, .u = {.1, .1, .1}, .v = {.2, .2, .2}, .r = {.1, .3, .2}}, /* concentric */
        {.n = 2, .u = {.6, 0}, .v = {.1, 0}, .r = {.9, .05}},              /* an island */
        {.n = 3, .u = {.5, -.5, 0}, .v = {0, 0, .1}, .r = {.3, .3, .95}},  /* around two others */
        {.n = 2, .u = {.3, 0}, .v = {0, .9}, .r = {.01, .99}},
        {.n = 3, .u = {0, 0, 0}, .v = {1.2, -1.2, 0}, .r = {1.1, 1.15, .7}}, /* it cuts two openings in four */
    };
    for (size_t p = 0; p < sizeof plain / sizeof *plain; p++) {
        ck_assert_double_lt(error_of(&plain[p]), 1e-14);
        ck_assert_msg(fallbacks_part() == 0, "window %zu was degenerate", p);
    }
}

/* The open area of a window of random discs, each with a depth of its own, after the direction of the window has turned
 * by (du, dv). */
static double open_turned(fibrad_areas *areas, const struct method *method, const struct window *w, const double *depth,
                          double du, double dv) {
    method->begin(areas);
    bool open = true;
    for (uint32_t k = 0; k < w->n && open; k++)
        open = method->disc(areas, k, w->u[k] - depth[k] * du, w->v[k] - depth[k] * dv, w->r[k]);
    return open ? method->end(areas) : 0;
}

/* The slope of the open area is its derivative. */
TEST(the_slope_is_the_derivative_of_the_open_area) {
    OWNED_AREAS areas = areas_make();
    uint32_t there = 0;
    for (uint64_t seed = 0; seed < 300; seed++) {
        const struct method *const methods[] = {&both, &arrangement, &dense}, *method = methods[seed % 3];
        struct window w = {0};
        double depth[8], slope[2];
        for (uint64_t k = 0; k < 2 + seed % 6; k++) {
            const double r = .2 + .8 * bed_make_random(seed, 4 * k),
                         place = .3 + 1.2 * bed_make_random(seed, 4 * k + 1);
            const double turn = 6.28 * bed_make_random(seed, 4 * k + 2);
            depth[k] = 1 + (double)k + bed_make_random(seed, 4 * k + 3);
            put(&w, place * cos(turn), place * sin(turn), r);
        }
        const double h = 1e-6, open = open_turned(&areas, method, &w, depth, 0, 0);
        if (open == 0) continue;
        if (method == &arrangement) areas.degenerate = true; /* the caller of both methods would set this */
        fibrad_areas_slope(&areas, depth, slope);
        for (int axis = 0; axis < 2; axis++) {
            const double u = axis == 0 ? h : 0, v = axis == 1 ? h : 0;
            const double after = open_turned(&areas, method, &w, depth, u, v);
            const double before = open_turned(&areas, method, &w, depth, -u, -v);
            ck_assert_double_eq_tol(slope[axis], (after - before) / (2 * h), 1e-4 * (1 + fabs(slope[axis])));
            there += fabs(slope[axis]) > .1;
        }
    }
    ck_assert_uint_gt(there, 300);
}
