/* bench_areas.c - exact visible areas alone: both methods in every instruction set of this machine, one thread.
 * SPDX-License-Identifier: MIT
 *
 *     bench_areas [quick]
 *
 * The bench writes CSV to standard output. `microseconds` is processor time per window: the least of several rounds, in
 * which all methods take turns. The next column is the part of the windows that clipping left to the arrangement. The
 * last column is the time of the scalar arrangement, which is the reference, over this time. The windows are those of a
 * periodic random bed of equal spheres, solid fraction 0.6, with their discs sorted. */
#include <math.h>

#include "window/areas.h"
#include "bed/packing.h"
#include "bench.h"

enum { DISCS = 64, METHODS = 8 };

struct window {
    uint32_t n;
    double depth[DISCS], u[DISCS], v[DISCS], r[DISCS];
};

typedef void begin_function(fibrad_areas *areas);
typedef bool disc_function(fibrad_areas *areas, uint32_t whose, double x, double y, double r);
typedef uint32_t discs_function(fibrad_areas *areas, uint32_t first, const uint32_t *which, uint32_t count,
                                const double *x, const double *y, const double *r);
typedef double end_function(fibrad_areas *areas);

struct method {
    const char *name, *isa;
    begin_function *begin;
    disc_function *disc;
    end_function *end;
    double best, fallbacks;
};

static void add(struct method *method, const char *name, const char *isa, begin_function *begin, disc_function *disc,
                end_function *end) {
    *method = (struct method){name, isa, begin, disc, end, INFINITY, 0};
}

/* The two methods of an instruction set. Clipping takes all discs in one call. */
#define DECLARE(isa)                                                                                                   \
    begin_function fibrad_areas_begin_##isa, fibrad_arrangement_begin_##isa;                                           \
    disc_function fibrad_arrangement_disc_##isa;                                                                       \
    discs_function fibrad_areas_discs_##isa;                                                                           \
    end_function fibrad_areas_end_##isa, fibrad_arrangement_end_##isa;                                                 \
    static bool fibrad_areas_disc_##isa(fibrad_areas *areas, uint32_t whose, double x, double y, double r) {           \
        fibrad_areas_discs_##isa(areas, whose, &(uint32_t){0}, 1, &x, &y, &r);                                         \
        return areas->open;                                                                                            \
    }
#define METHOD(by, isa)                                                                                                \
    add(&methods[n++], #by, #isa, fibrad_##by##_begin_##isa, fibrad_##by##_disc_##isa, fibrad_##by##_end_##isa)

DECLARE(scalar)
#ifdef FIBRAD_WITH_SSE2
DECLARE(sse2)
#endif
#ifdef FIBRAD_WITH_AVX2
DECLARE(avx2)
#endif
#ifdef FIBRAD_WITH_AVX512
DECLARE(avx512)
#endif

/* The instruction sets of this machine. The scalar arrangement comes first. */
static int methods_list(struct method methods[METHODS]) {
    int n = 0;
    METHOD(arrangement, scalar);
    METHOD(areas, scalar);
#ifdef FIBRAD_WITH_SSE2
    if (fibrad_isa_best() >= FIBRAD_ISA_SSE2) METHOD(arrangement, sse2), METHOD(areas, sse2);
#endif
#ifdef FIBRAD_WITH_AVX2
    if (fibrad_isa_best() >= FIBRAD_ISA_AVX2) METHOD(arrangement, avx2), METHOD(areas, avx2);
#endif
#ifdef FIBRAD_WITH_AVX512
    if (fibrad_isa_best() >= FIBRAD_ISA_AVX512) METHOD(arrangement, avx512), METHOD(areas, avx512);
#endif
    return n;
}

/* The nearest discs before the window of sphere i in direction k of n. The window has the radius 1. */
static void look(struct window *window, const struct bed *bed, uint32_t i, uint32_t k, uint32_t n) {
    double w[3] = {0};
    fibrad_direction(k, n, w);
    const double side = hypot(w[0], w[1]), e[3] = {-w[1] / side, w[0] / side, 0};
    const double g[3] = {-w[2] * e[1], w[2] * e[0], side};
    window->n = 0;
    for (uint32_t j = 0; j < bed->n; ++j) {
        double c[3] = {bed->x[j] - bed->x[i], bed->y[j] - bed->y[i], bed->z[j] - bed->z[i]};
        for (int axis = 0; axis < 3; ++axis) c[axis] -= bed->period[axis] * round(c[axis] / bed->period[axis]);
        const double depth = w[0] * c[0] + w[1] * c[1] + w[2] * c[2];
        const double u = e[0] * c[0] + e[1] * c[1], v = g[0] * c[0] + g[1] * c[1] + g[2] * c[2];
        if (!(depth > 0 && u * u + v * v < 4)) continue;
        uint32_t to = window->n < DISCS ? window->n++ : DISCS - 1;
        if (to == DISCS - 1 && depth > window->depth[to]) continue;
        for (; to > 0 && window->depth[to - 1] > depth; --to) {
            window->depth[to] = window->depth[to - 1];
            window->u[to] = window->u[to - 1], window->v[to] = window->v[to - 1];
        }
        window->depth[to] = depth, window->u[to] = u, window->v[to] = v, window->r[window->n - 1] = 1;
    }
}

static void measure(struct method *method, fibrad_areas *areas, const struct window *windows, uint32_t n) {
    const double begun = bench_thread_seconds();
    areas->fallbacks = 0;
    for (uint32_t w = 0; w < n; ++w) {
        bool open = true;
        method->begin(areas);
        for (uint32_t k = 0; k < windows[w].n && open; ++k)
            open = method->disc(areas, k, windows[w].u[k], windows[w].v[k], windows[w].r[k]);
        method->end(areas);
    }
    method->best = fmin(method->best, bench_thread_seconds() - begun);
    method->fallbacks = (double)areas->fallbacks / n;
}

int main(int argc, char **argv) {
    const bool quick = argc > 1 && strcmp(argv[1], "quick") == 0;
    const uint32_t rows = quick ? 10 : 400, directions = 50;
    struct bed bed = bed_empty();
    int status = bed_make_packing(&bed, quick ? 200 : 2000, 1, 1, 0.6, 1);
    if (status) return status;

    fibrad_arena arena = {0};
    fibrad_areas areas = {0};
    fibrad_areas_layout(&areas, &arena, DISCS);
    const size_t size = fibrad_arena_total(&arena);
    void *block = bench_array(size, 1);
    struct window *windows = bench_array(rows * directions, sizeof *windows);
    bench_check("areas", fibrad_arena_open(&arena, block, size, size));
    fibrad_areas_layout(&areas, &arena, DISCS);
    for (uint32_t k = 0; k < rows * directions; ++k)
        look(&windows[k], &bed, k / directions * (bed.n / rows), k % directions, directions);

    struct method methods[METHODS];
    const int n = methods_list(methods);
    for (int round = 0; round < (quick ? 1 : 10); ++round)
        for (int m = 0; m < n; ++m) measure(&methods[m], &areas, windows, rows * directions);
    bench_preamble("bench_areas: windows of a periodic random bed of equal spheres, solid fraction 0.6", 1);
    puts("method,isa,microseconds,left to the arrangement,scalar arrangement / this");
    for (int m = 0; m < n; ++m)
        printf("%s,%s,%.3f,%g,%.2f\n", methods[m].name, methods[m].isa, 1e6 * methods[m].best / (rows * directions),
               methods[m].fallbacks, methods[0].best / methods[m].best);
    free(windows);
    free(block);
    bed_free(&bed);
    return 0;
}
