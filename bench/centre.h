/* centre.h - rows in the middle of a random bed and their true values, to measure methods by.
 * SPDX-License-Identifier: MIT
 *
 * The bed has radii 0.8-1.2, the solid fraction 0.55, and is open. The rows are those of the spheres nearest to its
 * centre. The true rows are by beams with exact areas. docs/accuracy.md compares such rows with an adaptive
 * reference. */
#ifndef CENTRE_H
#define CENTRE_H

#include <math.h>

#include "bed/packing.h"
#include "bench_bed.h"

struct centre {
    struct bed bed;
    fibrad_scene *scene;
    fibrad_work work;
    fibrad_row row;         /* with room for n entries */
    uint32_t rows, *sphere; /* [rows] */
    double *truth;          /* [rows][n] */
};

static inline double centre_distance(const struct bed *bed, double edge, uint32_t i) {
    return hypot(hypot(bed->x[i] - edge / 2, bed->y[i] - edge / 2), bed->z[i] - edge / 2);
}

static inline void centre_find(struct centre *centre, double edge) {
    for (uint32_t k = 0; k < centre->rows; ++k) {
        double least = k ? centre_distance(&centre->bed, edge, centre->sphere[k - 1]) : -1, best = INFINITY;
        for (uint32_t i = 0; i < centre->bed.n; ++i) {
            const double d = centre_distance(&centre->bed, edge, i);
            if (d > least && d < best) best = d, centre->sphere[k] = i;
        }
    }
}

/* Writes the entries of a row to an array of all n columns. */
static inline void centre_spread(const struct centre *centre, struct bench_entries row, double *full) {
    memset(full, 0, centre->bed.n * sizeof *full);
    for (uint32_t k = 0; k < row.length; ++k) full[row.col[k]] = row.f[k];
}

/* Computes a row by one of the kernel's methods, as an array of all n columns. */
static inline void centre_row(struct centre *centre, const struct bench_method *method, uint32_t i, double *full) {
    bench_row(centre->scene, &centre->work, method, i, &centre->row);
    centre_spread(centre, bench_row_entries(&centre->row), full);
}

/* Makes bed, scene and true rows. The program ends without freeing them. Status as bed_make_packing. */
static inline int centre_make(struct centre *centre, uint32_t spheres, uint32_t rows, uint32_t directions) {
    struct bed *bed = &centre->bed;
    void *block;
    *centre = (struct centre){.work = BENCH_GROWING, .rows = rows};
    *bed = bed_empty();
    const int status = bed_make_packing(bed, spheres, 0.8, 1.2, 0.55, 1);
    if (status) return status;
    centre->row = bench_arrays(spheres);
    centre->sphere = bench_array(rows, sizeof *centre->sphere);
    centre->truth = bench_array((size_t)rows * spheres, sizeof *centre->truth);
    centre_find(centre, bed->period[0]);
    memset(bed->period, 0, sizeof bed->period);
    centre->scene = bench_scene(bed, FIBRAD_ISA_BEST, &block);
    const fibrad_beam_rule fine = {.directions = directions};
    const struct bench_method beam = {.name = "beam", .beam = &fine};
    for (uint32_t k = 0; k < rows; ++k)
        centre_row(centre, &beam, centre->sphere[k], centre->truth + (size_t)k * spheres);
    return 0;
}

/* Adds up squares of a row's errors, and counts the entries that the true row has. */
struct centre_error {
    double square;
    uint64_t entries, rows;
};

static inline void centre_add_error(const struct centre *centre, uint32_t k, const double *full,
                                    struct centre_error *sum) {
    const double *truth = centre->truth + (size_t)k * centre->bed.n;
    for (uint32_t j = 0; j < centre->bed.n; ++j) {
        sum->square += (full[j] - truth[j]) * (full[j] - truth[j]);
        sum->entries += truth[j] > 0;
    }
    sum->rows++;
}

/* Prints a line: method, setting, microseconds a row, error of an entry (root mean square) and of a row (Euclidean). */
static inline void centre_print(const char *method, const char *kind, uint32_t setting, double seconds,
                                const struct centre_error *sum) {
    printf("%s,%s,%u,%.1f,%.3g,%.3g\n", method, kind, setting, 1e6 * seconds / (double)sum->rows,
           sqrt(sum->square / (double)sum->entries), sqrt(sum->square / (double)sum->rows));
    fflush(stdout);
}

#define CENTRE_COLUMNS "method,kind,setting,us_per_row,rms_per_entry,euclidean"

#endif
