/* bench_instructions.c - instructions of a window of the beam method, in every instruction set.
 * SPDX-License-Identifier: MIT
 *
 *     bench_instructions [quick | SPHERES]
 *
 * CSV on standard output: the bed of bench_window, periodic, of equal spheres (20,000), solid fraction 0.58; 200 rows
 * of spheres spread over all of it, 100 directions each; instructions a window, the row's setting up and writing out
 * shared among them. The library is built by bench/count_cc.sh and counts its own instructions (`make bench-counted`):
 * the figures depend on sources, compiler and flags alone, so that the smallest difference of two versions shows. Not
 * counted are the C library's copying, and the no-operations that align loops, 0.5 % of what the processor executes. */
#include "bed_make.h"
#include "bench.h"
#include "message.h"
#include "run_omp.h"

enum { DIRECTIONS = 100, CAPACITY = 4096 };

/* What objects of bench/count_cc.sh have executed; the second word is theirs. */
uint64_t instructions_counted[2];

/* All that is asked of the library: instructions of `rows` rows spread over the bed; 0 if something fails. */
static uint64_t count(const struct bed *bed, int isa, uint32_t points, uint32_t rows) {
    static uint32_t col[CAPACITY];
    static double f[CAPACITY];
    fibrad_scene_config config = {.spheres = bed->n, .isa = isa};
    for (int axis = 0; axis < 3; ++axis) config.period[axis] = bed->period[axis];
    const fibrad_spheres spheres = {bed->x, bed->y, bed->z, bed->r, bed->n};
    const fibrad_beam_rule rule = {.directions = DIRECTIONS, .points = points};
    fibrad_row row = {.col = col, .f = f, .capacity = CAPACITY};
    const size_t size = fibrad_scene_size(&config), work_size = fibrad_work_size(NULL);
    void *block = run_block(size), *work_block = run_block(work_size);
    fibrad_scene *scene = NULL;
    fibrad_work *work = NULL;
    bool failed = !block || !work_block || fibrad_scene_init(&scene, block, size, &config, &spheres, NULL) ||
                  fibrad_work_init(&work, work_block, work_size, NULL);
    const uint64_t begun = instructions_counted[0];
    for (uint32_t k = 0; k < rows && !failed; ++k)
        failed = fibrad_beam_row(scene, work, (uint32_t)((uint64_t)k * bed->n / rows), &rule, &row) != FIBRAD_OK;
    const uint64_t ended = instructions_counted[0];
    free(block);
    free(work_block);
    return failed ? 0 : ended - begun;
}

int main(int argc, char **argv) {
    const bool quick = argc == 2 && strcmp(argv[1], "quick") == 0;
    const uint32_t n = quick ? 500 : argc == 2 ? (uint32_t)atol(argv[1]) : 20000, rows = quick ? 5 : 200;
    static const uint32_t points[] = {0, 64, 128, 256};
    bench_preamble("bench_instructions: rows of a periodic random bed, solid fraction 0.58", 1);
    struct bed bed;
    bed_init(&bed, false, 0);
    const int status = bed_make_packing(&bed, n, 1, 1, 0.58, 1);
    if (status) return status;
    printf("# spheres: %u, rows: %u, directions: %d\nisa,points,instructions_per_window\n", n, rows, DIRECTIONS);
    for (int isa = FIBRAD_ISA_SCALAR; isa <= (int)fibrad_isa_best(); ++isa)
        for (int k = 0; k < 4; ++k) {
            const uint64_t counted = count(&bed, isa, points[k], rows);
            if (counted == 0) return message(STATUS_INPUT, "a row fails, or the library does not count");
            printf("%s,%u,%.1f\n", fibrad_isa_name(isa), points[k], (double)counted / (rows * DIRECTIONS));
        }
    bed_free(&bed);
    return 0;
}
