/* write.h - results of a bed to files, one frame at a time, and what is said of them. SPDX-License-Identifier: MIT */
#ifndef WRITE_H
#define WRITE_H

#include <stdbool.h>
#include <stdio.h>

#include "bed/bed.h"
#include "bed/conduction.h"
#include "bed/wall_option.h"
#include "text/report.h"
#include "simple/fibrad_host.h"

/* A further array of a .npz; one of a name that it has anyway takes its place. */
struct array {
    const char *name, *type; /* "x.npy"; kind and bytes as NumPy has them: "f8" */
    const void *data;
    uint64_t length, columns; /* columns 0: one dimension */
};

enum { ARRAYS_MAX = 24 };

/* The results of one frame: a matrix, or heat, or conduction; what belongs to the others is 0. */
struct contents {
    const struct bed *bed;
    const struct walls *walls; /* NULL: neither walls nor surroundings are written. A body of kind 0: only that there is
                                  one is known */
    const char *file;          /* the bed's, a column where several files go into one output; NULL: there is one */
    bool series;               /* several frames may go into one output: columns frame and timestep */
    const double *time;        /* [s] a column where several times go into one output; NULL: there is one */

    const fibrad_bed_factors *factors;
    const unsigned char *wanted;      /* [n] not 0: this row was computed; NULL: all were */
    const fibrad_exchange_rule *grey; /* NULL: view factors; else exchange factors by this rule */
    const struct array *array;        /* [arrays] that a .npz has besides its own, at most ARRAYS_MAX */
    size_t arrays;

    const struct side_arrays *of_sides; /* what is known of the triangles of meshes; NULL: where they are */

    const fibrad_heat_sources *sources; /* kelvins; surroundings NaN: there are none, the geometry is closed */
    const fibrad_heat_result *result;   /* watts, kelvins; has all arrays */

    const struct conduction *conduction;
};

/* Writes one frame; first: the file is empty yet. A failing file is noticed by the caller. Status 0, STATUS_MEMORY or
 * that of a signal. */
typedef int write_function(FILE *file, const struct contents *what, bool first);

write_function write_csv, write_mtx, write_npz, write_vtp, write_json;
write_function write_conduction_csv, write_conduction_json;
write_function write_mesh_vtp; /* has walls with meshes */
write_function write_heat_csv, write_heat_vtp, write_heat_json, write_heat_dump;

/* What a body is called: "zmin" and the like, "wall_1" and the like if its place is not known. */
enum { BODY_NAME = MESH_NAME };
const char *contents_body(const struct contents *what, uint32_t k, char name[BODY_NAME]);

/* What the rows that were computed have in common. */
struct summary {
    double row_sum_min, row_sum_max, escaped_mean, beyond_mean;
    double closure_max; /* largest |row sum + escaped + beyond + walls - 1| */
    double error_max, error_rms;
    double wall_error_max; /* of the rows that walls have */
    double wall_mean[WALLS_MAX];
};

/* The sum over the spheres that row i sees. */
double summary_row(const fibrad_factors *matrix, uint32_t i);

void summary_make(struct summary *summary, const struct contents *what);

/* Reports it, with the entries of the matrix, its reciprocity, and the area of each wall that has an end; closure is
 * that of the raw rows and of those written. */
void summary_report(const struct summary *summary, const struct contents *what, struct report *report);

#endif
