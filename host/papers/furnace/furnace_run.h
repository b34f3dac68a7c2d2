/* furnace_run.h - the methods for a box with a participating medium, by OpenMP. SPDX-License-Identifier: MIT */
#ifndef FURNACE_RUN_H
#define FURNACE_RUN_H

#include <stdbool.h>
#include <stdint.h>

#include "cli/progress.h"
#include "fibrad_furnace.h"

enum furnace_method {
    FURNACE_HFM,    /* heat fluxes, Theta = 1 */
    FURNACE_MCHF,   /* heat fluxes, Theta constant or measured by Monte Carlo */
    FURNACE_MCHF_X, /* as FURNACE_MCHF, and the transverse term is measured, too */
    FURNACE_MC      /* Monte Carlo in radiative equilibrium */
};

struct furnace_options {
    enum furnace_method method;
    double theta; /* FURNACE_MCHF: a constant above 0 to 1; 0: measured */
    fibrad_furnace_estimator estimator;
    fibrad_furnace_scatter scatter;
    bool measure;       /* FURNACE_MC: measure Theta afterwards */
    bool quiet;         /* print no outer iterations and no bar on standard error */
    uint64_t bundles;   /* approximate number in the first plan; later plans have as many as the changes of E need */
    int threads;        /* 0: all cores */
    double tolerance;   /* outer iterations end when no cell changes by more than this [K] */
    uint32_t outer_max; /* largest number of outer iterations */
};

struct furnace_run {
    fibrad_furnace_config config;
    fibrad_furnace *furnace;
    fibrad_furnace_arrays at;
    fibrad_furnace_tally **tallies; /* [threads + 1] one per thread, and their sum */
    void *block, **tally_blocks;
    int threads;
    uint32_t outers;  /* outer iterations: bundles, then a solution of the heat-flux equations */
    uint32_t sweeps;  /* of the last solution */
    double change;    /* largest change of T in the last outer iteration [K] */
    uint64_t bundles; /* bundles traced */
    double seconds;   /* time of computing [s] */
    bool cold;        /* some cell has no T > 0: more bundles are needed, or a weaker sink */
    struct progress progress;
};

/* Computes a box. Results do not depend on the number of threads. Free the run also after an error. Status 0,
 * STATUS_INPUT if there is no convergence, STATUS_MEMORY, or that of a signal. */
int furnace_run(const fibrad_furnace_config *config, const struct furnace_options *options, struct furnace_run *run);

void furnace_free(struct furnace_run *run);

#endif
