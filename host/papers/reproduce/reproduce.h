/* reproduce.h - functions that all experiments of `fibrad reproduce` share.
 * SPDX-License-Identifier: MIT */
#ifndef REPRODUCE_H
#define REPRODUCE_H

#include <stdio.h>

#include "bed/bed.h"
#include "cli/output.h"
#include "fibrad_surface.h"
#include "simple/fibrad_host.h"

/* The run of `fibrad reproduce`, and the current experiment. */
struct reproduce {
    struct output comparison; /* comparison.csv, if files are written */
    const char *experiment;   /* name of the current experiment, at the beginning of each line */
    FILE *data;               /* of the current experiment as CSV, the header line first */
};

/* The source of a number that ours is compared with: the paper, or an independent calculation by its method. */
#define SOURCE_PAPER "paper"
#define SOURCE_CHECK "check"

/* Writes a line with the published number and ours, to standard output and to comparison.csv. theirs NAN: nothing was
 * published. If the unit is "%", the difference is in points, else in per cent. what: format of the text that says what
 * is compared. */
void reproduce_compare(struct reproduce *reproduce, const char *source, const char *unit, double theirs, double ours,
                       const char *what, ...) __attribute__((format(printf, 6, 7)));

/* An experiment: writes its data and compares numbers. Returns a status. */
typedef int experiment(struct reproduce *reproduce);

experiment reproduce_fig3, reproduce_fig4, reproduce_third_sphere, reproduce_fig10, reproduce_table1,
    reproduce_pebble_pair, reproduce_pebble_rays, reproduce_pebble_bed, reproduce_conductivity, reproduce_correlations;

/* Correlations for the radiative exchange factor F_E = k/(4 sigma T^3 d) of a bed without gas, whose spheres have one
 * temperature each. emissivity above 0, at most 1; porosity: the volume between spheres over that of the bed. */
double correlation_zehner_bauer_schluender(double emissivity, double porosity);
double correlation_kunii_smith(double emissivity, double porosity);

/* ---- rows of a bed, one thread ---- */

/* A bed, its scene, and memory for one row. Begin with ROWS_NONE. */
struct rows {
    struct bed bed;
    fibrad_scene *scene;
    void *block; /* of the scene */
    fibrad_work work;
    uint32_t n;
    uint32_t *col; /* [n] */
    double *f;     /* [n] */
};

#define ROWS_NONE                                                                                                      \
    (struct rows) { .bed = bed_empty() }

/* Makes the scene of rows->bed; periodic: with its periods. Close it also after an error. Returns a status. */
int rows_open(struct rows *rows, bool periodic);
void rows_close(struct rows *rows);

/* How rows are computed: one of them is set. */
struct row_rule {
    const fibrad_beam_rule *beam;
    const fibrad_surface_rule *surface;
    const fibrad_cast_rule *cast;
};

/* Computes row i by the rule of `method`. rows->col and rows->f get the entries, *row the other results. Returns a
 * status. */
int rows_row(struct rows *rows, const struct row_rule *method, uint32_t i, fibrad_row *row);

#endif
