/* furnace_run.c - the methods for a box with a participating medium, by OpenMP. SPDX-License-Identifier: MIT */
#include "papers/furnace/furnace.h"

#include <inttypes.h>
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/message.h"

enum { FURNACE_BATCH = 4096, FURNACE_SWEEPS_MAX = 100000 };

static size_t furnace_cells(const struct furnace_run *run) {
    return (size_t)run->config.cells[0] * run->config.cells[1] * run->config.cells[2];
}

/* Returns the exit status for a status of the kernel. After an error prints `context` and the text of the status. */
static int furnace_status(int status, const char *context) {
    if (!status) return STATUS_OK;
    return message(STATUS_INPUT, "furnace: %s: %s", context, fibrad_status_text(status));
}

static int furnace_make(struct furnace_run *run) {
    size_t size = fibrad_furnace_size(&run->config);
    if (size == 0) return furnace_status(FIBRAD_E_ARGUMENT, "size, cells, medium or walls");
    run->block = malloc(size);
    if (run->block == NULL) return message_memory();
    int status = fibrad_furnace_init(&run->furnace, run->block, size, &run->config);
    fibrad_furnace_fields(run->furnace, &run->at);
    return furnace_status(status, "initialisation");
}

/* Empties tally t, and allocates the tally the first time. */
static int furnace_clear_tally(struct furnace_run *run, int t) {
    size_t size = fibrad_furnace_tally_size(run->furnace);
    if (run->tally_blocks[t] == NULL) run->tally_blocks[t] = malloc(size);
    if (run->tally_blocks[t] == NULL) return message_memory();
    return furnace_status(fibrad_furnace_tally_init(&run->tallies[t], run->tally_blocks[t], size, run->furnace),
                          "tally");
}

static int furnace_clear_tallies(struct furnace_run *run) {
    size_t count = (size_t)run->threads + 1;
    if (run->tallies == NULL) run->tallies = calloc(count, sizeof(fibrad_furnace_tally *));
    if (run->tally_blocks == NULL) run->tally_blocks = calloc(count, sizeof(void *));
    if (run->tallies == NULL || run->tally_blocks == NULL) return message_memory();
    int status = STATUS_OK;
    for (int t = 0; t <= run->threads && !status; t++) status = furnace_clear_tally(run, t);
    return status;
}

/* Sets the last tally to the sum of the tallies of all threads. */
static int furnace_add_tallies(struct furnace_run *run) {
    int status = furnace_clear_tally(run, run->threads);
    for (int t = 0; t < run->threads && !status; t++)
        status = furnace_status(fibrad_furnace_tally_add(run->tallies[run->threads], run->tallies[t]), "tallies");
    return status;
}

/* Plans and traces bundles. The last tally then has all bundles since the last restart. */
static int furnace_trace_plan(struct furnace_run *run, fibrad_furnace_physics physics, uint64_t bundles, bool restart) {
    uint64_t planned = 0;
    int stop = restart ? furnace_clear_tallies(run) : STATUS_OK, failed = FIBRAD_OK;
    if (!stop)
        stop = furnace_status(fibrad_furnace_emit(run->furnace, physics, bundles, restart, &planned),
                              "plan of bundles, E may change too much for so few");
    if (stop) return stop;
    uint64_t done = 0;
    run->bundles += planned;
    (void)progress_stage(&run->progress, "bundles", 0, planned);
#pragma omp parallel for schedule(dynamic) num_threads(run->threads)
    for (uint64_t first = 0; first < planned; first += FURNACE_BATCH) {
        int status = interrupt_status();
        uint64_t count = planned - first < FURNACE_BATCH ? planned - first : FURNACE_BATCH;
        if (status) {
#pragma omp atomic write
            stop = status;
            continue;
        }
        status = fibrad_furnace_trace(run->furnace, run->tallies[omp_get_thread_num()], first, count);
        if (status) {
#pragma omp atomic write
            failed = status;
        }
        uint64_t traced;
#pragma omp atomic capture
        traced = done += count;
        if (omp_get_thread_num() == 0 && traced < planned)
            (void)progress_stage(&run->progress, "bundles", traced, planned);
    }
    (void)progress_stage(&run->progress, "bundles", planned, planned);
    if (!stop) stop = furnace_status(failed, "bundles");
    return stop ? stop : furnace_add_tallies(run);
}

static int furnace_solve_lines(struct furnace_run *run, const struct furnace_options *options) {
    /* This is far below any noise. The powers of the walls then balance the source to 1e-7. */
    double tolerance = 1e-9 * run->at.e[0];
    fibrad_furnace_report report = {0};
    run->sweeps = 0;
    do {
        int status = fibrad_furnace_solve(run->furnace, options->scatter, tolerance, 100, &report);
        if (status) return furnace_status(status, "heat-flux equations, more bundles may be needed");
        run->sweeps += report.sweeps;
        if (interrupt_status()) return interrupt_status();
    } while (report.change > tolerance && run->sweeps < FURNACE_SWEEPS_MAX);
    if (report.change <= tolerance) return STATUS_OK;
    return message(STATUS_INPUT, "no convergence after %d sweeps: is the medium too thick for the cells?",
                   FURNACE_SWEEPS_MAX);
}

/* The largest change of T since `before` [K]. Updates `before`. */
static double furnace_largest_change(const struct furnace_run *run, double *before) {
    double largest = 0;
    for (size_t k = 0; k < furnace_cells(run); k++) {
        double t = fibrad_furnace_temperature(run->at.e[k]);
        largest = fmax(largest, fabs(t - before[k]));
        before[k] = t;
    }
    return largest;
}

/* Estimates Theta, fluxes and the transverse term from the sum of the tallies. */
static int furnace_estimate(struct furnace_run *run, const struct furnace_options *options, bool transverse) {
    int status = fibrad_furnace_estimate(run->furnace, run->tallies[run->threads], options->estimator, transverse,
                                         options->scatter);
    return furnace_status(status, "estimate");
}

/* Solves the heat-flux equations with measured coefficients. Each iteration traces bundles for the present E, estimates
 * the coefficients from all bundles so far, and solves for a new E. With the transverse term, the equations correct
 * errors of E that extend over many cells in full. They correct only about half of an error that differs from cell to
 * cell: in a thin cell the derivative of the six fluxes with respect to E is 6 a/Theta, that of the emission is 4 a.
 * The other half is added from the balance of the cell. So convergence is four times as fast. */
static int furnace_iterate(struct furnace_run *run, const struct furnace_options *options, double *before,
                           double *local) {
    const fibrad_furnace_config *c = &run->config;
    bool transverse = options->method == FURNACE_MCHF_X;
    double in_source = options->scatter == FIBRAD_SCATTER_EXACT ? c->absorption + c->scattering : c->absorption;
    double unseen = transverse ? 1 - c->absorption / (2 * in_source) : 0;
    furnace_largest_change(run, before);
    do {
        uint64_t earlier = run->bundles;
        int status = furnace_trace_plan(run, FIBRAD_FURNACE_ATTENUATED, options->bundles, run->outers == 0);
        if (status) return status;
        status = furnace_estimate(run, options, transverse);
        if (status) return status;
        for (size_t k = 0; k < furnace_cells(run); k++) /* would balance a cell if no other cell changed [W/m2] */
            local[k] = (c->source - run->at.divergence[k]) / (4 * c->absorption);
        status = furnace_solve_lines(run, options);
        if (status) return status;
        run->change = furnace_largest_change(run, before);
        run->outers++;
        if (!options->quiet)
            fprintf(stderr,
                    "outer iteration %" PRIu32 ": %" PRIu64 " bundles, %" PRIu32 " sweeps, largest change %.3g K\n",
                    run->outers, run->bundles - earlier, run->sweeps, run->change);
        if (run->change <= options->tolerance) return STATUS_OK;
        for (size_t k = 0; k < furnace_cells(run); k++) run->at.e[k] += unseen * local[k];
    } while (run->outers < options->outer_max);
    return message(STATUS_INPUT,
                   "T still changes by %.3g K after %" PRIu32 " outer iterations: more bundles are needed", run->change,
                   run->outers);
}

static double furnace_first_theta(const struct furnace_options *options) {
    if (options->method == FURNACE_HFM) return 1;
    if (options->theta > 0) return options->theta;
    return options->estimator == FIBRAD_THETA_PAPER ? 0.75 : 2.0 / 3; /* of isotropic radiation */
}

static int furnace_heat_flux(struct furnace_run *run, const struct furnace_options *options) {
    int status = furnace_status(fibrad_furnace_theta(run->furnace, furnace_first_theta(options)), "Theta");
    if (!status) status = furnace_solve_lines(run, options);
    if (status || options->method == FURNACE_HFM || options->theta > 0) return status;
    double *before = calloc(2 * furnace_cells(run), sizeof *before);
    status = before != NULL ? furnace_iterate(run, options, before, before + furnace_cells(run)) : message_memory();
    free(before);
    return status;
}

static int furnace_monte_carlo(struct furnace_run *run, const struct furnace_options *options) {
    int status = furnace_trace_plan(run, FIBRAD_FURNACE_EQUILIBRIUM, options->bundles, true);
    if (status) return status;
    status = furnace_status(fibrad_furnace_equilibrium(run->furnace, run->tallies[run->threads]), "equilibrium");
    if (status || !options->measure) return status;
    status = furnace_trace_plan(run, FIBRAD_FURNACE_ATTENUATED, options->bundles, true);
    if (status) return status;
    return furnace_estimate(run, options, false);
}

int furnace_run(const fibrad_furnace_config *config, const struct furnace_options *options, struct furnace_run *run) {
    double begun = progress_clock();
    *run = (struct furnace_run){.config = *config, .threads = options->threads, .progress.quiet = options->quiet};
    if (run->threads == 0) run->threads = omp_get_max_threads();
    int status = furnace_make(run);
    if (status) return status;
    status = options->method == FURNACE_MC ? furnace_monte_carlo(run, options) : furnace_heat_flux(run, options);
    run->seconds = progress_clock() - begun;
    for (size_t k = 0; k < furnace_cells(run) && !status; k++) run->cold |= !(run->at.e[k] > 0);
    return status;
}

void furnace_free(struct furnace_run *run) {
    for (int t = 0; run->tally_blocks != NULL && t <= run->threads; t++) free(run->tally_blocks[t]);
    free(run->tally_blocks);
    free(run->tallies);
    free(run->block);
    *run = (struct furnace_run){0};
}
