/* bench_beam.c - run time against error of every method, rows in a random bed, one thread. SPDX-License-Identifier: MIT
 *
 *     bench_beam [quick]
 *
 * The bench writes CSV to standard output. centre.h makes the bed and the true rows. Times are processor times, the
 * least of three rounds. `whole` computes the matrix of the bed along lines. */
#include "centre.h"

static void bench(struct centre *centre, const struct bench_method *method, const char *kind, uint32_t setting) {
    double *full = bench_array(centre->bed.n, sizeof *full), best = INFINITY;
    struct centre_error sum = {0};
    for (int round = 0; round < 3; ++round) {
        double seconds = 0;
        sum = (struct centre_error){0};
        for (uint32_t k = 0; k < centre->rows; ++k) {
            const double begun = bench_thread_seconds();
            centre_row(centre, method, centre->sphere[k], full);
            seconds += bench_thread_seconds() - begun;
            centre_add_error(centre, k, full, &sum);
        }
        best = fmin(best, seconds);
    }
    centre_print(method->name, kind, setting, best, &sum);
    free(full);
}

/* The matrix. The time is that of the whole bed over its spheres, the errors are those of the rows in the middle. */
static void bench_whole(struct centre *centre, uint32_t lines) {
    const fibrad_beam_rule rule = {.directions = lines};
    double *full = bench_array(centre->bed.n, sizeof *full), best = INFINITY;
    struct centre_error sum = {0};
    for (int round = 0; round < 3; ++round) {
        const double begun = bench_thread_seconds();
        fibrad_bed_matrix *factors = bench_factors(&centre->bed, &(fibrad_bed_rule){.beam = &rule}, 1);
        best = fmin(best, bench_thread_seconds() - begun);
        sum = (struct centre_error){0};
        for (uint32_t k = 0; k < centre->rows; ++k) {
            centre_spread(centre, bench_matrix_entries(&factors->matrix, centre->sphere[k]), full);
            centre_add_error(centre, k, full, &sum);
        }
        fibrad_bed_matrix_free(factors);
    }
    centre_print("whole", "lines", lines, best * centre->rows / centre->bed.n, &sum);
    free(full);
}

int main(int argc, char **argv) {
    static const uint32_t directions[] = {34, 55, 100, 200, 400, 800, 1600, 3200, 6400};
    static const uint32_t lines[] = {16, 23, 32, 45, 55, 100, 181, 233, 362, 724, 1024};
    static const uint32_t rays[] = {1000, 10000, 100000, 1000000}, nodes[] = {21, 34, 55, 89, 144};
    const bool quick = argc > 1 && strcmp(argv[1], "quick") == 0;
    const size_t most = quick ? 2 : 100; /* settings of each method */
    struct centre centre;
    const int status = centre_make(&centre, quick ? 200 : 1000, quick ? 2 : 10, quick ? 2000 : 40000);
    if (status) return status;
    bench_preamble("bench_beam: rows in the middle of an open random bed of 1,000 (quick: 200)", 1);
    puts(CENTRE_COLUMNS);
    for (size_t d = 0; d < sizeof lines / sizeof *lines && d < most; ++d) bench_whole(&centre, lines[d]);
    for (uint32_t points = 0; points <= 256; points = points ? 2 * points : 64)
        for (size_t d = 0; d < sizeof directions / sizeof *directions && d < most; ++d) {
            const fibrad_beam_rule rule = {.directions = directions[d], .points = points};
            char kind[20] = "areas";
            if (points) snprintf(kind, sizeof kind, "points %u", points);
            bench(&centre, &(struct bench_method){.name = "beam", .beam = &rule}, kind, directions[d]);
        }
    for (int random = 0; random <= 1; ++random)
        for (size_t r = 0; r < sizeof rays / sizeof *rays && r < most; ++r) {
            const fibrad_cast_rule rule = {.rays = rays[r], .random = random};
            bench(&centre, &(struct bench_method){.name = random ? "mc" : "cast", .cast = &rule}, "rays", rays[r]);
        }
    for (size_t k = 0; k < sizeof nodes / sizeof *nodes && k < most; ++k) {
        const fibrad_surface_rule rule = {.nodes = nodes[k]};
        bench(&centre, &(struct bench_method){.name = "surface", .surface = &rule}, "nodes", nodes[k]);
    }
    return 0;
}
