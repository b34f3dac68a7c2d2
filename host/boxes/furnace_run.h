/* furnace_run.h - the methods for a box with a participating medium, by OpenMP. SPDX-License-Identifier: MIT */
#ifndef FURNACE_RUN_H
#define FURNACE_RUN_H

#include <stdbool.h>
#include <stdint.h>

#include "cli/progress.h"
#include "fibrad_furnace.h"

enum furnace_method {
    FURNACE_HFM,    /* heat fluxes, Theta = 1 */
    FURNACE_MCHF,   /* heat fluxes, Theta a constant or measured by Monte Carlo */
    FURNACE_MCHF_X, /* with the transverse term besides */
    FURNACE_MC      /* Monte Carlo in radiative equilibrium */
};

struct furnace_options {
    enum furnace_method method;
    double theta; /* FURNACE_MCHF: a constant, (0, 1]; 0: measured */
    fibrad_furnace_estimator estimator;
    fibrad_furnace_scatter scatter;
    bool measure;       /* FURNACE_MC: measure Theta afterwards */
    bool quiet;         /* neither report the outer iterations on standard error nor show a bar */
    bool progress;      /* show a bar also where standard error is no terminal */
    uint64_t bundles;   /* of the first plan, about; further ones add what changes of E need */
    int threads;        /* 0: all cores */
    double tolerance;   /* K: outer iterations end when no cell changes by more */
    uint32_t outer_max; /* outer iterations at most */
};

struct furnace_run {
    fibrad_furnace_config config;
    fibrad_furnace *furnace;
    fibrad_furnace_arrays at;
    fibrad_furnace_tally **tallies; /* [threads + 1], the last for the sum of all */
    void *block, **tally_blocks;
    int threads;
    uint32_t outers;  /* Monte Carlo runs, each followed by a solution of the heat-flux equations */
    uint32_t sweeps;  /* of the last such solution */
    double change;    /* of T in the last outer iteration, largest of all cells [K] */
    uint64_t bundles; /* traced */
    double seconds;
    struct progress progress; /* of bundles */
};

/* Computes a box. Results do not depend on the number of threads. Free the run also after an error. Status 0,
 * STATUS_INPUT if there is no convergence, STATUS_MEMORY, or that of a signal. */
int furnace_run(const fibrad_furnace_config *config, const struct furnace_options *options, struct furnace_run *run);

void furnace_free(struct furnace_run *run);

#endif
