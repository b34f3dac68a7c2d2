/* heat_powers.h - net radiative powers of a whole bed, by OpenMP. SPDX-License-Identifier: MIT */
#ifndef HEAT_POWERS_H
#define HEAT_POWERS_H

#include <stdbool.h>
#include <stdint.h>

#include "bed/bed.h"
#include "fibrad.h"

struct heat_options {
    const char *file;            /* the bed's name in messages */
    fibrad_heat_config config;   /* without `parts` */
    fibrad_heat_sources sources; /* SI units */
    fibrad_walls walls;
    double error;  /* wanted of the powers, over their root mean square; 0: config as it is, else where to begin */
    int threads;   /* 0: as OpenMP has it, which is all cores */
    bool progress; /* show the bar even if standard error is no terminal */
};

struct heat_report {
    fibrad_heat_result heat;   /* power [n], to be freed */
    fibrad_heat_config config; /* as used in the end */
    fibrad_scene_facts facts;
    int threads;
    double seconds;              /* computing, without reading and writing */
    double mean_square, largest; /* of the spheres: root mean square [W]; of all: largest [W] */
    double balance;              /* sum of all powers over the largest */
    double error_estimate;       /* of the powers, over their root mean square */
};

/* Solves. The powers depend on the bed and the options, not on threads and schedule. Free the report also after an
 * error. Status 0; STATUS_INPUT if the kernel refuses the bed, naming the line; STATUS_MEMORY; that of a signal. */
int run_heat(const struct bed *bed, const struct heat_options *options, struct heat_report *report);

void heat_report_free(struct heat_report *report);

#endif
