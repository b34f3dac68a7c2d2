/* furnace_run.c - the methods for a box with a participating medium, by OpenMP. SPDX-License-Identifier: MIT */
#include "boxes/furnace_run.h"

#include <inttypes.h>
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "boxes/furnace_shoot.h"
#include "cli/interrupt.h"
#include "cli/message.h"
#include "cli/progress.h"
#include "compute/rows.h"

enum { BATCH = 4096, SWEEPS_MAX = 100000 };

static size_t cell_count(const struct furnace_run *run) {
    return (size_t)run->config.cells[0] * run->config.cells[1] * run->config.cells[2];
}

static int make_furnace(struct furnace_run *run) {
    size_t size = fibrad_furnace_size(&run->config);
    run->block = size > 0 ? run_block(size) : NULL;
    if (run->block == NULL) return message_memory();
    fibrad_furnace_init(&run->furnace, run->block, size, &run->config);
    fibrad_furnace_fields(run->furnace, &run->at);
    return STATUS_OK;
}

/* Empty tallies; makes them if there are none yet. */
static int clear_tallies(struct furnace_run *run) {
    size_t count = (size_t)run->threads + 1, size = fibrad_furnace_tally_size(run->furnace);
    if (run->tallies == NULL) run->tallies = calloc(count, sizeof(fibrad_furnace_tally *));
    if (run->tally_blocks == NULL) run->tally_blocks = calloc(count, sizeof(void *));
    if (run->tallies == NULL || run->tally_blocks == NULL) return message_memory();
    for (size_t t = 0; t < count; t++) {
        if (run->tally_blocks[t] == NULL) run->tally_blocks[t] = run_block(size);
        if (run->tally_blocks[t] == NULL) return message_memory();
        fibrad_furnace_tally_init(&run->tallies[t], run->tally_blocks[t], size, run->furnace);
    }
    return STATUS_OK;
}

/* Plans and traces bundles; the last tally then holds all that were traced since the tallies were cleared. */
static int trace(struct furnace_run *run, fibrad_furnace_physics physics, uint64_t bundles, bool restart) {
    uint64_t planned;
    int stop = restart ? clear_tallies(run) : STATUS_OK;
    if (stop) return stop;
    fibrad_furnace_emit(run->furnace, physics, bundles, restart, &planned);
    run->bundles += planned;
#pragma omp parallel for schedule(dynamic) num_threads(run->threads)
    for (uint64_t first = 0; first < planned; first += BATCH) {
        int status = interrupt_status();
        uint64_t count = planned - first < BATCH ? planned - first : BATCH;
        if (status == STATUS_OK) {
            fibrad_furnace_trace(run->furnace, run->tallies[omp_get_thread_num()], first, count);
        } else {
#pragma omp atomic write
            stop = status;
        }
    }
    fibrad_furnace_tally *sum = run->tallies[run->threads];
    fibrad_furnace_tally_init(&sum, run->tally_blocks[run->threads], fibrad_furnace_tally_size(run->furnace),
                              run->furnace);
    for (int t = 0; t < run->threads; t++) fibrad_furnace_tally_add(sum, run->tallies[t]);
    return stop;
}

static int solve(struct furnace_run *run, const struct furnace_options *options) {
    /* Far below any noise: the powers of the walls then balance the source to 1e-7. */
    double tolerance = 1e-9 * run->at.e[0], change;
    run->sweeps = 0;
    if (options->shooting) return furnace_shoot(run, options->scatter, tolerance);
    fibrad_furnace_report report = {0};
    do {
        fibrad_furnace_solve(run->furnace, options->scatter, tolerance, 100, &report);
        run->sweeps += report.sweeps;
        change = report.change;
        if (interrupt_status()) return interrupt_status();
    } while (change > tolerance && run->sweeps < SWEEPS_MAX);
    if (change <= tolerance) return STATUS_OK;
    return message(STATUS_INPUT, "no convergence after %d sweeps: is the medium too thick for the cells?", SWEEPS_MAX);
}

/* Largest change of T against the temperatures in `before`, which are brought up to date. */
static double largest_change(const struct furnace_run *run, double *before) {
    double largest = 0;
    for (size_t k = 0; k < cell_count(run); k++) {
        double t = fibrad_furnace_temperature(run->at.e[k]);
        largest = fmax(largest, fabs(t - before[k]));
        before[k] = t;
    }
    return largest;
}

/* What the heat the bundles found missing in each cell would change E by, were all else to stay [W/m2]. */
static void local_change(const struct furnace_run *run, double *local) {
    const fibrad_furnace_config *c = &run->config;
    for (size_t k = 0; k < cell_count(run); k++) local[k] = (c->source - run->at.divergence[k]) / (4 * c->absorption);
}

/* Heat fluxes with measured coefficients: bundles for the E found last, coefficients from all bundles so far, E anew.
 * With the transverse term the heat-flux equations are right about errors that extend over many cells; of those that
 * differ from cell to cell they see about half, the six fluxes of a thin cell answering to E as 6 a E/Theta, its
 * emission as 4 a E only. The other half is added from the balance of the cell, and convergence is four times as fast.
 */
static int iterate(struct furnace_run *run, const struct furnace_options *options, double *before, double *local) {
    const fibrad_furnace_config *c = &run->config;
    bool transverse = options->method == FURNACE_MCHF_X;
    double in_source = options->scatter == FIBRAD_SCATTER_EXACT ? c->absorption + c->scattering : c->absorption;
    double unseen = transverse ? 1 - c->absorption / (2 * in_source) : 0;
    largest_change(run, before);
    do {
        uint64_t earlier = run->bundles;
        int status = trace(run, FIBRAD_FURNACE_ATTENUATED, options->bundles, run->outers == 0);
        if (status) return status;
        fibrad_furnace_estimate(run->furnace, run->tallies[run->threads], options->estimator, transverse,
                                options->scatter);
        local_change(run, local);
        status = solve(run, options);
        if (status) return status;
        run->change = largest_change(run, before);
        run->outers++;
        if (!options->quiet)
            fprintf(stderr,
                    "outer iteration %" PRIu32 ": %" PRIu64 " bundles, %" PRIu32 " sweeps, largest change %.3g K\n",
                    run->outers, run->bundles - earlier, run->sweeps, run->change);
        if (run->change <= options->tolerance) return STATUS_OK;
        for (size_t k = 0; k < cell_count(run); k++) run->at.e[k] += unseen * local[k];
    } while (run->outers < options->outer_max);
    return message(STATUS_INPUT,
                   "T still changes by %.3g K after %" PRIu32 " outer iterations: more bundles are needed", run->change,
                   run->outers);
}

static double first_theta(const struct furnace_options *options) {
    if (options->method == FURNACE_HFM) return 1;
    if (options->theta > 0) return options->theta;
    return options->estimator == FIBRAD_THETA_PAPER ? 0.75 : 2.0 / 3; /* of isotropic radiation */
}

static int heat_flux(struct furnace_run *run, const struct furnace_options *options) {
    fibrad_furnace_theta(run->furnace, first_theta(options));
    int status = solve(run, options);
    if (status || options->method == FURNACE_HFM || options->theta > 0) return status;
    double *before = calloc(2 * cell_count(run), sizeof *before);
    status = before != NULL ? iterate(run, options, before, before + cell_count(run)) : message_memory();
    free(before);
    return status;
}

static int monte_carlo(struct furnace_run *run, const struct furnace_options *options) {
    int status = trace(run, FIBRAD_FURNACE_EQUILIBRIUM, options->bundles, true);
    if (status) return status;
    fibrad_furnace_equilibrium(run->furnace, run->tallies[run->threads]);
    if (!options->measure) return STATUS_OK;
    status = trace(run, FIBRAD_FURNACE_ATTENUATED, options->bundles, true);
    if (status) return status;
    fibrad_furnace_estimate(run->furnace, run->tallies[run->threads], options->estimator, 0, options->scatter);
    return STATUS_OK;
}

int furnace_run(const fibrad_furnace_config *config, const struct furnace_options *options, struct furnace_run *run) {
    double begun = progress_clock();
    *run = (struct furnace_run){.config = *config, .threads = options->threads};
    if (run->threads == 0) run->threads = omp_get_max_threads();
    int status = make_furnace(run);
    if (status) return status;
    status = options->method == FURNACE_MC ? monte_carlo(run, options) : heat_flux(run, options);
    run->seconds = progress_clock() - begun;
    for (size_t k = 0; k < cell_count(run) && !status; k++)
        if (!(run->at.e[k] > 0))
            status = message(STATUS_INPUT, "no T > 0 in some cells: more bundles are needed, or a weaker sink");
    return status;
}

void furnace_free(struct furnace_run *run) {
    for (int t = 0; run->tally_blocks != NULL && t <= run->threads; t++) free(run->tally_blocks[t]);
    free(run->tally_blocks);
    free(run->tallies);
    free(run->block);
    *run = (struct furnace_run){0};
}
