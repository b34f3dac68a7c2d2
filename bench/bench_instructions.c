/* bench_instructions.c - instructions of a window of the beam method, in every instruction set.
 * SPDX-License-Identifier: MIT
 *
 *     bench_instructions [quick | SPHERES]
 *
 * The bench writes CSV to standard output. The bed is that of bench_window: periodic, of equal spheres (20,000), solid
 * fraction 0.58. 200 rows of spheres spread over all of the bed are computed with 100 directions each, or along 100
 * lines if points are masks. The instructions of a window contain its share of setting up and writing out the row.
 * `points` of a line is the number of points, 0 for exact areas, or the number of chords of masks.
 *
 * The library is built by bench/count_cc.sh and counts its own instructions (`make bench-counted`). The figures depend
 * on sources, compiler and flags alone. So they show the smallest difference between two versions. Two things are not
 * counted: copies by the C library, and the no-operations that align loops. The latter are 0.5 % of what the processor
 * executes. */
#include "bed/packing.h"
#include "bench_bed.h"

enum { DIRECTIONS = 100, CAPACITY = 4096 };

/* The number of instructions that objects of bench/count_cc.sh have executed. These objects need the second word. */
uint64_t instructions_counted[2];

/* Instructions of `rows` rows spread over the bed; 0: nothing is counted. */
static uint64_t count(const fibrad_scene *scene, uint32_t n, uint32_t points, uint32_t chords, uint32_t rows) {
    const size_t size = fibrad_line_set_size(DIRECTIONS);
    void *block = bench_array(1, size);
    fibrad_line_set *lines;
    bench_check("lines", fibrad_line_set_init(&lines, block, size, DIRECTIONS));
    const fibrad_beam_rule rule = chords ? (fibrad_beam_rule){.lines = lines, .chords = chords}
                                         : (fibrad_beam_rule){.directions = DIRECTIONS, .points = points};
    fibrad_work work = BENCH_GROWING;
    fibrad_row row = bench_arrays(CAPACITY);
    bench_check("row", fibrad_beam_row(scene, &work, 0, &rule, &row)); /* work memory grows */
    const uint64_t begun = instructions_counted[0];
    for (uint32_t k = 0; k < rows; ++k)
        bench_check("row", fibrad_beam_row(scene, &work, (uint32_t)((uint64_t)k * n / rows), &rule, &row));
    const uint64_t ended = instructions_counted[0];
    free(work.memory.block);
    free(row.col);
    free(row.f);
    free(block);
    return ended - begun;
}

int main(int argc, char **argv) {
    const bool quick = argc == 2 && strcmp(argv[1], "quick") == 0;
    const uint32_t n = quick ? 500 : argc == 2 ? (uint32_t)atol(argv[1]) : 20000, rows = quick ? 5 : 200;
    static const uint32_t points[] = {0, 64, 128, 256, 0, 0, 0}, chords[] = {0, 0, 0, 0, 16, 32, 64};
    bench_preamble("bench_instructions: rows of a periodic random bed, solid fraction 0.58", 1);
    struct bed bed = bed_empty();
    const int status = bed_make_packing(&bed, n, 1, 1, 0.58, 1);
    if (status) return status;
    printf("# spheres: %u, rows: %u, directions: %d\nisa,points,instructions_per_window\n", n, rows, DIRECTIONS);
    for (int isa = FIBRAD_ISA_SCALAR; isa <= (int)fibrad_isa_best(); ++isa) {
        void *block;
        const fibrad_scene *scene = bench_scene(&bed, isa, &block);
        for (int k = 0; k < 7 && scene; ++k) {
            const uint64_t counted = count(scene, n, points[k], chords[k], rows);
            if (counted == 0) return fprintf(stderr, "bench_instructions: the library does not count\n"), 1;
            printf("%s,%u%s,%.1f\n", fibrad_isa_name(isa), points[k] + chords[k], chords[k] ? " chords" : "",
                   (double)counted / (rows * DIRECTIONS));
        }
        free(block);
    }
    bed_free(&bed);
    return 0;
}
