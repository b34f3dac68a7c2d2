/* bench_error.c - error of beam rows against the number of directions, on a random bed. SPDX-License-Identifier: MIT
 *
 *     bench_error [quick]
 *
 * The bench writes CSV to standard output. The bed has 1000 spheres, radii 0.8-1.2, solid fraction 0.55, and is open.
 * The rows are those of spheres at least 4 away from its faces. The true rows have exact areas and 40000 directions.
 * `averaged` is the error of (V_ij + V_ji)/2A_i instead of V_ij/A_i. */
#include "bed/packing.h"
#include "bench_bed.h"

static int ascending(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static fibrad_bed_matrix *rows_of(const struct bed *bed, uint32_t directions, uint32_t points, int raw,
                                  const unsigned char *wanted) {
    const fibrad_beam_rule rule = {.directions = directions, .points = points};
    const fibrad_bed_rule options = {.beam = &rule, .raw = raw, .wanted = wanted};
    return bench_factors(bed, &options, 0);
}

int main(int argc, char **argv) {
    static const uint32_t directions[] = {50, 100, 200, 400, 800, 1600, 6400};
    const bool quick = argc > 1 && strcmp(argv[1], "quick") == 0;
    const uint32_t fine = quick ? 4000 : 40000;
    struct bed bed = bed_empty();
    const int status = bed_make_packing(&bed, 1000, 0.8, 1.2, 0.55, 1);
    if (status) return status;
    const double edge = bed.period[0];
    memset(bed.period, 0, sizeof bed.period);
    double *error = bench_array(bed.n, sizeof *error);
    unsigned char *wanted = bench_array(bed.n, 1);
    for (uint32_t i = 0; i < bed.n; i++)
        wanted[i] =
            fmin(fmin(fmin(bed.x[i], bed.y[i]), bed.z[i]), edge - fmax(fmax(bed.x[i], bed.y[i]), bed.z[i])) >= 4;
    fibrad_bed_matrix *truth = rows_of(&bed, fine, 0, 1, wanted);
    printf("# fibrad %s; random bed of 1000, radii 0.8-1.2, solid fraction 0.55; truth n = %u\n", fibrad_version(),
           fine);
    printf("directions,points,averaged,rows,median,mean,largest,seconds\n");
    for (size_t d = 0; d < (quick ? 1 : sizeof directions / sizeof *directions); d++)
        for (uint32_t points = 0; points <= 256; points = points ? 2 * points : 64)
            for (int raw = 1; raw >= 0; raw--) {
                fibrad_bed_matrix *factors = rows_of(&bed, directions[d], points, raw, NULL);
                uint32_t rows = 0;
                double sum = 0;
                for (uint32_t i = 0; i < bed.n; i++) {
                    if (!wanted[i]) continue;
                    sum += error[rows++] = bench_distance(bench_matrix_entries(&factors->matrix, i),
                                                          bench_matrix_entries(&truth->matrix, i));
                }
                qsort(error, rows, sizeof *error, ascending);
                printf("%u,%u,%d,%u,%.3g,%.3g,%.3g,%.3f\n", directions[d], points, !raw, rows, error[rows / 2],
                       sum / rows, error[rows - 1], factors->seconds);
                fflush(stdout);
                fibrad_bed_matrix_free(factors);
            }
    fibrad_bed_matrix_free(truth);
    free(error);
    free(wanted);
    bed_free(&bed);
    return 0;
}
