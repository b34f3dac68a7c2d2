/* centre.h - rows in the middle of a random bed and their true values, for methods to be measured by.
 * SPDX-License-Identifier: MIT
 *
 * Bed: radii 0.8-1.2, solid fraction 0.55, open; rows: the spheres nearest to its centre. Truth: beams with exact
 * areas, as in docs/accuracy.md, where they stand against an adaptive reference. */
#ifndef CENTRE_H
#define CENTRE_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bed/packing.h"
#include "bench.h"
#include "cli/message.h"
#include "compute/rows.h"

struct centre {
    struct bed bed;
    fibrad_scene *scene;
    fibrad_work *work;
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

/* A row by one of the kernel's methods, spread over all n columns. Returns its status. */
static inline int centre_row(const struct centre *centre, const struct row_method *method, uint32_t i, double *full) {
    static uint32_t col[4096];
    static double f[4096];
    fibrad_row row = {.col = col, .f = f, .capacity = 4096};
    const int status = method->row(centre->scene, centre->work, i, method->rule, &row);
    if (status) return message(STATUS_INPUT, "row %u: %s", i, fibrad_status_text(status));
    memset(full, 0, centre->bed.n * sizeof *full);
    for (uint32_t k = 0; k < row.length; ++k) full[col[k]] = f[k];
    return STATUS_OK;
}

/* Makes bed, scene and truth; the program ends without freeing them. */
static inline int centre_make(struct centre *centre, uint32_t spheres, uint32_t rows, uint32_t directions) {
    const fibrad_work_config work_config = {.near = 4096, .discs = 512, .entries = 4096};
    const fibrad_scene_config scene_config = {.spheres = spheres};
    const size_t scene_size = fibrad_scene_size(&scene_config), work_size = fibrad_work_size(&work_config);
    struct bed *bed = &centre->bed;
    bed_init(bed, false, 0);
    int status = bed_make_packing(bed, spheres, 0.8, 1.2, 0.55, 1);
    if (status) return status;
    void *scene_block = run_block(scene_size), *work_block = run_block(work_size);
    centre->rows = rows;
    centre->sphere = calloc(rows, sizeof *centre->sphere);
    centre->truth = calloc((size_t)rows * spheres, sizeof *centre->truth);
    if (!scene_block || !work_block || !centre->sphere || !centre->truth) return message_memory();
    centre_find(centre, bed->period[0]);
    const fibrad_spheres views = {bed->x, bed->y, bed->z, bed->r, bed->n};
    if (fibrad_scene_init(&centre->scene, scene_block, scene_size, &scene_config, &views, NULL) ||
        fibrad_work_init(&centre->work, work_block, work_size, &work_config))
        return message(STATUS_INPUT, "the random bed is refused");
    const fibrad_beam_rule fine = {.directions = directions};
    const struct row_method beam = method_beam(&fine);
    for (uint32_t k = 0; k < rows && !status; ++k)
        status = centre_row(centre, &beam, centre->sphere[k], centre->truth + (size_t)k * spheres);
    return status;
}

/* Adds up squares of a row's errors, and how many entries the row truly has. */
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

/* One line: method, setting, microseconds a row, error per entry (root mean square) and of a row (Euclidean). */
static inline void centre_print(const char *method, const char *kind, uint32_t setting, double seconds,
                                const struct centre_error *sum) {
    printf("%s,%s,%u,%.1f,%.3g,%.3g\n", method, kind, setting, 1e6 * seconds / (double)sum->rows,
           sqrt(sum->square / (double)sum->entries), sqrt(sum->square / (double)sum->rows));
    fflush(stdout);
}

#define CENTRE_COLUMNS "method,kind,setting,us_per_row,rms_per_entry,euclidean"

#endif
