/* bench_window.c - time of a window of beams in a large bed, in every instruction set, with areas and with points.
 * SPDX-License-Identifier: MIT
 *
 *     bench_window [quick | SPHERES]
 *
 * The bench writes CSV to standard output. Times are processor times of one thread: the least of several rounds, in
 * which all take turns. The bed is a periodic random bed of equal spheres (20,000), solid fraction 0.58. Rows of
 * spheres spread over all of the bed are set up anew and have 100 directions. One column has microseconds per window,
 * with its share of setting up and writing out the row. Another column has the time of setting up and writing out
 * alone, in microseconds per row. It follows from the difference to rows of 400 directions. */
#include "bed/packing.h"
#include "bench_bed.h"

enum { FEW = 100, MANY = 400, CAPACITY = 4096, ROUNDS = 5, CASES = 16 };

struct window_case {
    int isa;
    uint32_t points;
    const fibrad_scene *scene;
    double few, many; /* least seconds of a round */
};

/* Seconds of `rows` rows spread over the bed. */
static double seconds(const struct window_case *c, fibrad_work *work, uint32_t n, uint32_t rows, uint32_t directions) {
    static uint32_t col[CAPACITY];
    static double f[CAPACITY];
    fibrad_row row = {.col = col, .f = f, .capacity = CAPACITY};
    const fibrad_beam_rule rule = {.directions = directions, .points = c->points};
    const double begun = bench_thread_seconds();
    for (uint32_t k = 0; k < rows; ++k)
        bench_check("row", fibrad_beam_row(c->scene, work, (uint32_t)((uint64_t)k * n / rows), &rule, &row));
    return bench_thread_seconds() - begun;
}

int main(int argc, char **argv) {
    const bool quick = argc == 2 && strcmp(argv[1], "quick") == 0;
    const uint32_t n = quick ? 500 : argc == 2 ? (uint32_t)atol(argv[1]) : 20000, rows = quick ? 5 : 500;
    static const uint32_t points[] = {0, 64, 128, 256};
    bench_preamble("bench_window: rows of a periodic random bed, solid fraction 0.58", 1);
    struct bed bed = bed_empty();
    const int status = bed_make_packing(&bed, n, 1, 1, 0.58, 1);
    if (status) return status;
    fibrad_work work = BENCH_GROWING;

    struct window_case cases[CASES];
    int count = 0;
    for (int isa = FIBRAD_ISA_SCALAR; isa <= (int)fibrad_isa_best(); ++isa) {
        void *block; /* kept until the end */
        const fibrad_scene *scene = bench_scene(&bed, isa, &block);
        for (int k = 0; k < 4 && scene; ++k)
            cases[count++] = (struct window_case){isa, points[k], scene, INFINITY, INFINITY};
    }
    for (int round = 0; round < (quick ? 1 : ROUNDS); ++round)
        for (int k = 0; k < count; ++k) {
            cases[k].few = fmin(cases[k].few, seconds(&cases[k], &work, n, rows, FEW));
            cases[k].many = fmin(cases[k].many, seconds(&cases[k], &work, n, rows, MANY));
        }
    puts("isa,points,us_per_window,row_set_up_us");
    for (int k = 0; k < count; ++k)
        printf("%s,%u,%.3f,%.1f\n", fibrad_isa_name(cases[k].isa), cases[k].points, 1e6 * cases[k].few / (rows * FEW),
               1e6 * (cases[k].few - (cases[k].many - cases[k].few) / (MANY - FEW) * FEW) / rows);
    return 0;
}
