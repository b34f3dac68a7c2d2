/* bench_error.c - error of beam rows against the number of directions, on a random bed. SPDX-License-Identifier: MIT
 *
 * CSV on standard output. Bed: 1000 spheres, radii 0.8-1.2, solid fraction 0.55, open; rows: those at least 4 away from
 * its faces. Truth: exact areas with 40000 directions. `averaged`: the error of (V_ij + V_ji)/2A_i instead of V_ij/A_i.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bed/packing.h"
#include "fibrad.h"
#include "cli/message.h"
#include "compute/rows.h"

static int ascending(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static int rows_of(const struct bed *bed, fibrad_beam_rule rule, bool raw, const bool *wanted, struct result *result) {
    struct run_options options = {.file = "random bed", .method = method_beam(&rule), .raw = raw, .wanted = wanted};
    return run_rows(bed, &options, result);
}

int main(void) {
    static const uint32_t directions[] = {50, 100, 200, 400, 800, 1600, 6400};
    struct bed bed;
    bed_init(&bed, false, 0);
    int status = bed_make_packing(&bed, 1000, 0.8, 1.2, 0.55, 1);
    if (status) return status;
    double edge = bed.period[0];
    memset(bed.period, 0, sizeof bed.period);
    double *error = calloc(bed.n, sizeof *error);
    bool *wanted = calloc(bed.n, sizeof *wanted);
    if (!error || !wanted) return message_memory();
    for (uint32_t i = 0; i < bed.n; i++)
        wanted[i] =
            fmin(fmin(fmin(bed.x[i], bed.y[i]), bed.z[i]), edge - fmax(fmax(bed.x[i], bed.y[i]), bed.z[i])) >= 4;
    struct result truth;
    status = rows_of(&bed, (fibrad_beam_rule){.directions = 40000}, true, wanted, &truth);
    if (status) return status;
    printf("# fibrad %s; random bed of 1000, radii 0.8-1.2, solid fraction 0.55; truth n = 40000\n", fibrad_version());
    printf("directions,points,averaged,rows,median,mean,largest,seconds\n");
    for (size_t d = 0; d < sizeof directions / sizeof *directions; d++)
        for (uint32_t points = 0; points <= 256; points = points ? 2 * points : 64)
            for (int raw = 1; raw >= 0; raw--) {
                struct result result;
                status = rows_of(&bed, (fibrad_beam_rule){.directions = directions[d], .points = points}, raw, NULL,
                                 &result);
                if (status) return status;
                uint32_t rows = 0;
                double sum = 0;
                for (uint32_t i = 0; i < bed.n; i++) {
                    if (!wanted[i]) continue;
                    sum += error[rows++] = rows_distance(&result.rows, &truth.rows, i);
                }
                qsort(error, rows, sizeof *error, ascending);
                printf("%u,%u,%d,%u,%.3g,%.3g,%.3g,%.3f\n", directions[d], points, !raw, rows, error[rows / 2],
                       sum / rows, error[rows - 1], result.seconds);
                fflush(stdout);
                result_free(&result);
            }
    result_free(&truth);
    free(error);
    free(wanted);
    bed_free(&bed);
    return 0;
}
