/* reproduce_grey.c - grey spheres of one emissivity, on one thread. SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>

#include "bed/bed_scene.h"
#include "cli/message.h"
#include "cli/progress.h"
#include "conductivity/conductivity.h"
#include "papers/reproduce/reproduce.h"

static fibrad_run one_thread(struct progress *bar) {
    return (fibrad_run){.threads = 1, .progress = progress_stage, .context = bar};
}

static double *constant(uint32_t n, double value) {
    double *e = malloc(n * sizeof *e);
    for (uint32_t i = 0; e && i < n; ++i) e[i] = value;
    return e;
}

int grey_conduction(const struct bed *bed, double emissivity, double conductivity, uint32_t paths, double *factor) {
    struct progress bar = {0};
    fibrad_run run = one_thread(&bar);
    struct conduction result;
    double *e = constant(bed->n, emissivity), *k = constant(bed->n, conductivity);
    unsigned char *emits = calloc(bed->n, 1);
    const struct conduction_rule rule = {
        .emissivity = e, .conductivity = conductivity < INFINITY ? k : NULL, .axis = -1, .paths = paths};
    int status = e && k && emits ? STATUS_OK : message_memory();
    if (!status) status = conduction_emitters(bed, NULL, -1, CONDUCTION_MARGIN, "bed", emits, &result);
    if (!status) {
        status = conduction_follow(bed, emits, &rule, &run, &result);
        progress_stop(&bar);
        status = bed_status(bed, "bed", status, &run.fault);
    }
    *factor = status ? NAN : (result.factor[0] + result.factor[1] + result.factor[2]) / 3;
    free(emits);
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
    fibrad_bed_rule grey = *options;
    filled.emissivity = e, grey.exchange = &filled;
    int status = e ? STATUS_OK : message_memory();
    if (!status) {
        status = fibrad_view_factors(scene, &spheres, &grey, &run, factors);
        progress_stop(&bar);
        status = bed_status(bed, "bed", status, &run.fault);
    }
    free(e);
    return status;
}
