/* furnace_shoot.c - the heat-flux equations by Runge-Kutta and secant shooting. SPDX-License-Identifier: MIT
 *
 * Between its two walls a line obeys dy+/dx = J - (beta + chi+) y+/Theta+ and dy-/dx = (beta + chi-) y-/Theta- - J,
 * where y = Theta q. J and chi are constant in a cell, Theta is linear between its faces. */
#include "boxes/furnace_shoot.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <gsl/gsl_roots.h>
#include <math.h>
#include <stdlib.h>

#include "cli/interrupt.h"
#include "cli/message.h"

enum { SWEEPS_MAX = 10000, SHOTS_MAX = 20 };

/* One line; `cell` and `face` are its first. */
struct line {
    const struct furnace_run *run;
    const double *source; /* J of all cells */
    gsl_odeiv2_step *step;
    double beta, width; /* of a cell */
    double eps[2], own[2];
    int axis;
    size_t cells, stride, cell, face;
    size_t at; /* the cell the integration is in */
};

static int slope(double x, const double y[], double dydx[], void *parameters) {
    const struct line *l = parameters;
    size_t cell = l->cell + l->at * l->stride, face = l->face + l->at * l->stride;
    double part = x / l->width - (double)l->at;
    for (int g = 0; g < 2; g++) {
        const double *theta = l->run->at.theta[l->axis][g];
        double here = (1 - part) * theta[face] + part * theta[face + l->stride];
        double loss = (l->beta + l->run->at.transverse[l->axis][g][cell]) * y[g] / here;
        dydx[g] = g ? loss - l->source[cell] : l->source[cell] - loss;
    }
    return GSL_SUCCESS;
}

/* Integrates from q-(0) = arriving, writes the fluxes of the line, and returns by how much q- misses the second wall.
 */
static double shoot(double arriving, void *parameters) {
    struct line *l = parameters;
    double **theta = (double **)l->run->at.theta[l->axis], **flux = (double **)l->run->at.flux[l->axis];
    gsl_odeiv2_system system = {slope, NULL, 2, l};
    double error[2], y[2];
    size_t face = l->face;
    flux[0][face] = l->own[0] + (1 - l->eps[0]) * arriving;
    flux[1][face] = arriving;
    for (int g = 0; g < 2; g++) y[g] = theta[g][face] * flux[g][face];
    for (l->at = 0; l->at < l->cells; l->at++) {
        gsl_odeiv2_step_reset(l->step); /* Theta has a kink at the face */
        gsl_odeiv2_step_apply(l->step, (double)l->at * l->width, l->width, y, error, NULL, NULL, &system);
        face += l->stride;
        for (int g = 0; g < 2; g++) flux[g][face] = y[g] / theta[g][face];
    }
    return flux[1][face] - (l->own[1] + (1 - l->eps[1]) * flux[0][face]);
}

/* The secant solver asks for a slope to begin with; the miss is affine in the start, so any interval serves. */
static void shoot_slope(double arriving, void *parameters, double *miss, double *derivative) {
    struct line *l = parameters;
    double interval = l->run->at.e[l->cell];
    double there = shoot(arriving + interval, l);
    *miss = shoot(arriving, l);
    *derivative = (there - *miss) / interval;
}

static double slope_only(double arriving, void *parameters) {
    double miss, derivative;
    shoot_slope(arriving, parameters, &miss, &derivative);
    return derivative;
}

static int solve_line(struct line *l, gsl_root_fdfsolver *secant) {
    gsl_function_fdf function = {shoot, slope_only, shoot_slope, l};
    double scale = l->run->at.e[l->cell];
    gsl_root_fdfsolver_set(secant, &function, l->run->at.flux[l->axis][1][l->face]);
    for (int shots = 0; shots < SHOTS_MAX; shots++) {
        if (gsl_root_fdfsolver_iterate(secant) != GSL_SUCCESS) return STATUS_INPUT;
        double miss = shoot(gsl_root_fdfsolver_root(secant), l);
        if (fabs(miss) <= 1e-11 * scale) return STATUS_OK;
    }
    return STATUS_INPUT;
}

/* All lines along one axis. */
static int solve_axis(struct furnace_run *run, int axis, const double *source) {
    const fibrad_furnace_config *c = &run->config;
    struct line line = {.run = run,
                        .source = source,
                        .beta = c->absorption + c->scattering,
                        .width = c->size[axis] / c->cells[axis],
                        .axis = axis,
                        .cells = c->cells[axis],
                        .stride = axis == 0   ? 1
                                  : axis == 1 ? c->cells[0]
                                              : (size_t)c->cells[0] * c->cells[1]};
    for (int side = 0; side < 2; side++) {
        line.eps[side] = c->wall_emissivity[2 * axis + side];
        line.own[side] = line.eps[side] * FIBRAD_STEFAN_BOLTZMANN * pow(c->wall_temperature[2 * axis + side], 4);
    }
    size_t lines = (size_t)c->cells[0] * c->cells[1] * c->cells[2] / line.cells;
    int trouble = STATUS_OK;
#pragma omp parallel num_threads(run->threads) firstprivate(line)
    {
        line.step = gsl_odeiv2_step_alloc(gsl_odeiv2_step_rk4, 2);
        gsl_root_fdfsolver *secant = gsl_root_fdfsolver_alloc(gsl_root_fdfsolver_secant);
        int status = line.step == NULL || secant == NULL ? message_memory() : STATUS_OK;
#pragma omp for
        for (size_t k = 0; k < lines; k++) {
            size_t low = k % line.stride, high = k / line.stride;
            line.cell = low + high * line.stride * line.cells;
            line.face = low + high * line.stride * (line.cells + 1);
            if (status == STATUS_OK) status = solve_line(&line, secant);
        }
        if (status) {
#pragma omp atomic write
            trouble = status;
        }
        if (secant != NULL) gsl_root_fdfsolver_free(secant);
        if (line.step != NULL) gsl_odeiv2_step_free(line.step);
    }
    return trouble;
}

/* Change of E in cell (i, j, k) per heat that is missing, the fluxes that enter being held. */
static double response(const struct furnace_run *run, const size_t i[3], double own) {
    const fibrad_furnace_config *c = &run->config;
    double sum = 0;
    size_t cell = i[0] + c->cells[0] * (i[1] + c->cells[1] * i[2]);
    for (int a = 0; a < 3; a++) {
        size_t n[3] = {c->cells[0], c->cells[1], c->cells[2]}, out[3] = {i[0], i[1], i[2]};
        n[a]++;
        for (int g = 0; g < 2; g++) {
            out[a] = i[a] + (g ? 0 : 1);
            double loss = c->absorption + c->scattering + run->at.transverse[a][g][cell];
            double theta = run->at.theta[a][g][out[0] + n[0] * (out[1] + n[1] * out[2])];
            sum += own / (theta + loss * c->size[a] / c->cells[a] / 2);
        }
    }
    return 1 / sum;
}

/* Corrects E of every cell; returns the largest change. */
static double correct(struct furnace_run *run, double own) {
    const fibrad_furnace_config *c = &run->config;
    double largest = 0;
    size_t cell = 0, i[3];
    for (i[2] = 0; i[2] < c->cells[2]; i[2]++) {
        for (i[1] = 0; i[1] < c->cells[1]; i[1]++) {
            for (i[0] = 0; i[0] < c->cells[0]; i[0]++, cell++) {
                double change = (c->source - run->at.divergence[cell]) * response(run, i, own);
                run->at.e[cell] += change;
                largest = fmax(largest, fabs(change));
            }
        }
    }
    return largest;
}

int furnace_shoot(struct furnace_run *run, fibrad_furnace_scatter scatter, double tolerance) {
    const fibrad_furnace_config *c = &run->config;
    size_t cells = (size_t)c->cells[0] * c->cells[1] * c->cells[2];
    double *source = calloc(cells, sizeof *source), ka = c->absorption, ks = c->scattering, change = HUGE_VAL;
    int status = source != NULL ? STATUS_OK : message_memory();
    gsl_error_handler_t *handler = gsl_set_error_handler_off();
    bool exact = scatter == FIBRAD_SCATTER_EXACT;
    for (run->sweeps = 0; !status && change > tolerance && run->sweeps < SWEEPS_MAX; run->sweeps++) {
        for (size_t k = 0; k < cells; k++) {
            double e = run->at.e[k];
            source[k] = ka * e + ks * (exact ? e - c->source / (4 * ka) : run->at.six_flux[k] / 6);
        }
        for (int a = 0; a < 3 && !status; a++) status = solve_axis(run, a, source);
        fibrad_furnace_balance(run->furnace);
        change = correct(run, exact ? ka + ks : ka);
        if (!status) status = interrupt_status();
    }
    gsl_set_error_handler(handler);
    free(source);
    if (status == STATUS_INPUT || (!status && !(change <= tolerance)))
        return message(STATUS_INPUT, "shooting does not converge: is the medium too thick for it?");
    return status;
}
