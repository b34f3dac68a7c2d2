/* reproduce_grey.c - grey spheres of one emissivity, on one thread. SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>

#include "bed/bed_scene.h"
#include "cli/message.h"
#include "cli/progress.h"
#include "reproduce/reproduce.h"

#define PI 3.14159265358979323846

static fibrad_run one_thread(struct progress *bar) {
    return (fibrad_run){.threads = 1, .progress = progress_stage, .context = bar};
}

static double *constant(uint32_t n, double value) {
    double *e = malloc(n * sizeof *e);
    for (uint32_t i = 0; e && i < n; ++i) e[i] = value;
    return e;
}

int grey_conduction(const struct bed *bed, double emissivity, double conductivity, uint32_t paths, double *factor) {
    const fibrad_scene_config box = bed_scene(bed, NULL);
    const fibrad_spheres spheres = bed_spheres(bed);
    const bool conducts = conductivity < INFINITY;
    struct progress bar = {0};
    fibrad_run run = one_thread(&bar);
    double *e = constant(bed->n, emissivity), *k = constant(bed->n, conductivity), square = 0;
    fibrad_displacement *moved = calloc(bed->n, sizeof *moved);
    int status = e && k && moved ? STATUS_OK : message_memory();
    const fibrad_displacement_rule rule = {.emissivity = e, .conductivity = conducts ? k : NULL, .paths = paths};
    if (!status) {
        status = fibrad_displacements(&box, &spheres, &rule, NULL, &run, moved, NULL);
        progress_stop(&bar);
        status = bed_status(bed, "bed", status, &run.fault);
    }
    for (uint32_t i = 0; i < bed->n && !status; ++i)
        for (int axis = 0; axis < 3; ++axis) square += moved[i].square[axis] / 3;
    const double per_area = conducts ? 1 : emissivity; /* a walk counts flights, a path emissions */
    *factor = 4 * PI * per_area * square / (2 * bed->period[0] * bed->period[1] * bed->period[2] * 2);
    free(moved);
    free(k);
    free(e);
    return status;
}

int grey_factors(const struct bed *bed, const fibrad_scene_config *scene, const fibrad_exchange_rule *rule,
                 double emissivity, const fibrad_bed_rule *options, fibrad_bed_matrix **factors) {
    const fibrad_spheres spheres = bed_spheres(bed);
    struct progress bar = {0};
    fibrad_run run = one_thread(&bar);
    double *e = constant(bed->n, emissivity);
    fibrad_exchange_rule filled = *rule;
    filled.emissivity = e;
    int status = e ? STATUS_OK : message_memory();
    if (!status) {
        status = fibrad_exchange_factors(scene, &spheres, &filled, options, &run, factors);
        progress_stop(&bar);
        status = bed_status(bed, "bed", status, &run.fault);
    }
    free(e);
    return status;
}
