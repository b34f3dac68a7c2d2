/* write.h - the results of a bed, their writers, and their summary. SPDX-License-Identifier: MIT */
#ifndef WRITE_H
#define WRITE_H

#include <stdio.h>

#include "conductivity/conductivity.h"
#include "text/report.h"

/* A further array of a .npz. It replaces an array of the same name that every .npz has. */
struct array {
    const char *name, *type; /* "x.npy"; kind and bytes as NumPy has them: "f8" */
    const void *data;
    uint64_t length, columns; /* columns 0: one dimension */
};

enum { ARRAYS_MAX = 24 };

/* The results of one frame: a matrix, heat or conduction. Fields of the others are 0. */
struct contents {
    const struct bed *bed;
    const struct walls *walls; /* NULL: neither walls nor surroundings are written. kind 0: nothing is known of the
                                * wall, only that there is one */
    const char *file;          /* for a column of the names of several files; NULL: one file */
    bool first;                /* nothing is in the file so far */
    bool series;               /* with columns frame and timestep, for several frames */
    const double *time;        /* [s] for a column of several times; NULL: one time */

    const fibrad_bed_matrix *factors;
    const unsigned char *wanted;      /* [n] not 0: this row was computed; NULL: all rows */
    const fibrad_exchange_rule *grey; /* NULL: view factors; else exchange factors by this rule */
    const struct array *array;        /* [arrays] further arrays of a .npz */
    size_t arrays;

    const struct side_arrays *of_sides; /* values of the triangles of meshes; NULL: none */

    const fibrad_heat_sources *sources;  /* [K]; surroundings NaN: the bed is closed */
    const fibrad_light_result *light;    /* [W], light from outside that is absorbed; NULL: there is no light */
    const fibrad_heat_result *result;    /* [W], [K]; arrays of insides are all set or all NULL, other arrays are set */
    const double *melted;                /* [n] fractions; NULL: nothing melts */
    const double *area;                  /* [n] [m2] exposed; NULL: there are no clumps */
    const struct bed *bodies;            /* what has lines in .csv and .json; NULL: spheres have */
    const fibrad_heat_result *of_bodies; /* the same of bodies */
    const double *area_of_bodies, *melted_of_bodies;

    const struct conduction *conduction;
};

/* Writes one frame. The caller checks the file for errors. Status 0, STATUS_MEMORY or that of
 * a signal. */
typedef int write_function(FILE *file, const struct contents *what);

write_function write_csv, write_mtx, write_npz, write_vtp, write_json;
write_function write_conduction_csv, write_conduction_json;
write_function write_mesh_vtp; /* for walls with meshes */
write_function write_heat_csv, write_heat_vtp, write_heat_json, write_heat_dump;

/* The name of a wall in outputs: "zmin" for example, or "wall_1" for the first one if walls are not known. */
enum { WALL_NAME = MESH_NAME };
const char *contents_wall(const struct contents *what, uint32_t k, char name[WALL_NAME]);

/* A column of the heat of spheres: a value, less two others. */
struct heat_column {
    const char *name;
    const double *value, *less, *less_too; /* [n]; value NULL: there is no such column; others NULL: count as 0 */
};

/* Columns from HEAT_INSIDE on belong to spheres that conduct, those from HEAT_LIGHT on to light from outside, those
 * from HEAT_PARTS on are parts of the power. Then come the fraction that has melted, and areas beside clumps. */
enum {
    HEAT_TEMPERATURE,
    HEAT_POWER,
    HEAT_POWER_ERROR,
    HEAT_TEMPERATURE_ERROR,
    HEAT_INSIDE,
    HEAT_LIGHT = 9,
    HEAT_PARTS = 11,
    HEAT_MELTED = 14,
    HEAT_AREA,
    HEAT_COLUMNS
};

/* The contents of .csv and .json: with clumps as bodies if what->bodies is set. */
struct contents contents_table(const struct contents *what);

void heat_columns(const struct contents *what, struct heat_column column[HEAT_COLUMNS]);

/* The same of wall k, of the surroundings (k = -1) or of the gas of films (k = number of walls), whose insides are NaN.
 * The gas of a stream has the temperature at its outlet. Their light is what leaves at first and in all. Returns the
 * name; NULL: there are no surroundings, or no gas. */
const char *heat_outside(const struct contents *what, int64_t k, char own[WALL_NAME], double value[HEAT_COLUMNS]);

/* The value of sphere i. */
static inline double heat_value(const struct heat_column *column, uint32_t i) {
    return column->value[i] - (column->less ? column->less[i] : 0) - (column->less_too ? column->less_too[i] : 0);
}

/* Extremes, means and errors of the rows that were computed. */
struct summary {
    double row_sum_min, row_sum_max, escaped_mean, beyond_mean;
    double closure_max; /* largest |row sum + escaped + beyond + walls - 1| */
    double error_max, error_rms;
    double wall_error_max;       /* largest error of a row of a wall */
    double wall_mean[WALLS_MAX]; /* mean factor to each wall */
};

/* The sum of the factors from sphere i to all spheres. */
double summary_row(const fibrad_factors *matrix, uint32_t i);

void summary_make(struct summary *summary, const struct contents *what);

/* Reports a summary, with the number of entries, the reciprocity and the areas of finite walls. The closure is the
 * larger one of the raw rows' and the written rows'. */
void summary_report(const struct summary *summary, const struct contents *what, struct report *report);

#endif
