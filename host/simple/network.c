/* network.c - radiation by exchange factors, as a network of conductances. SPDX-License-Identifier: MIT
 *
 * A_i e_i D_ij is a conductance between spheres i and j, or sphere i and a wall, for E = sigma T^4. L is the matrix of
 * conductances, H the diagonal matrix of the holds, and E* the reference emission. The system (H + L) (E - E*) = r,
 * with r the power that is missing at E*, is symmetric and positive definite. Conjugate gradients with the diagonal as
 * preconditioner solve it. Only products with L are divided over the threads, row by row. So threads change no bit. */
#include "simple/network.h"

#include <math.h>
#include <stdlib.h>

enum { ROWS = 128, ITERATIONS_MAX = 2000 };

struct fibrad_network {
    fibrad_bed_matrix *factors;
    double *weight;                                              /* [n] A e */
    double *diagonal;                                            /* [n] of L */
    double *outside;                                             /* [n] conductance to walls and surroundings */
    double *emission, *storage, *residual, *direction, *product; /* [n] each, of the present solution */
};

enum { ARRAYS = 8 };

int fibrad_network_new(fibrad_network **network, fibrad_bed_matrix *factors, const double *emissivity,
                       const double *area) {
    const fibrad_factors *d = &factors->matrix;
    const size_t n = d->n;
    fibrad_network *w = calloc(1, sizeof *w);
    double *block = calloc(ARRAYS * n + 1, sizeof *block);
    if (!w || !block) {
        free(w);
        free(block);
        return FIBRAD_E_MEMORY;
    }
    double **const arrays[ARRAYS] = {&w->weight,  &w->diagonal, &w->outside,   &w->emission,
                                     &w->storage, &w->residual, &w->direction, &w->product};
    for (size_t k = 0; k < ARRAYS; ++k) *arrays[k] = block + k * n;
    w->factors = factors;
    for (size_t i = 0; i < n; ++i) {
        w->weight[i] = area[i] * emissivity[i];
        double within = 0, outside = d->escaped[i];
        for (uint64_t k = d->start[i]; k < d->start[i + 1]; ++k)
            if (d->col[k] != i) within += d->f[k];
        for (uint32_t b = 0; b < d->walls; ++b) outside += d->wall[i * d->walls + b];
        w->outside[i] = w->weight[i] * outside;
        w->diagonal[i] = w->weight[i] * (within + outside);
    }
    *network = w;
    return FIBRAD_OK;
}

void fibrad_network_free(fibrad_network *w) {
    if (!w) return;
    fibrad_bed_matrix_free(w->factors);
    free(w->weight);
    free(w);
}

/* A task: some rows of product = (L + H) direction. */
static int multiply_rows(void *network, int thread, uint32_t task) {
    fibrad_network *w = network;
    const fibrad_factors *d = &w->factors->matrix;
    const uint32_t first = task * ROWS, end = d->n - first > ROWS ? first + ROWS : d->n;
    (void)thread;
    for (uint32_t i = first; i < end; ++i) {
        const double own = w->direction[i];
        double sum = 0;
        for (uint64_t k = d->start[i]; k < d->start[i + 1]; ++k) sum += d->f[k] * (own - w->direction[d->col[k]]);
        w->product[i] = w->weight[i] * sum + (w->outside[i] + w->storage[i]) * own;
    }
    return FIBRAD_OK;
}

static int multiply(fibrad_network *w, fibrad_team *team) {
    return fibrad_team_run(team, NULL, (w->factors->matrix.n + ROWS - 1) / ROWS, 1, multiply_rows, w, NULL);
}

static double emission_at(const fibrad_heat_sources *s, double t) { return s->sigma * (t * t) * (t * t); }

/* Power that sphere i absorbs from walls and surroundings. */
static double received_outside(const fibrad_network *w, const fibrad_heat_sources *s, uint32_t i) {
    const fibrad_factors *d = &w->factors->matrix;
    double sum = d->escaped[i] * emission_at(s, s->surroundings);
    for (uint32_t b = 0; b < d->walls; ++b)
        sum += d->wall[(size_t)i * d->walls + b] * emission_at(s, s->wall_temperature[b]);
    return w->weight[i] * sum;
}

/* Sets the initial emissions and the residual, which is the power missing there. Where the temperature is given, the
 * residual is 0. */
static int begin(fibrad_network *w, fibrad_team *team, const fibrad_heat_sources *s) {
    const uint32_t n = w->factors->matrix.n;
    for (uint32_t i = 0; i < n; ++i) {
        w->storage[i] = 0;
        w->emission[i] = emission_at(s, isnan(s->temperature[i]) ? s->reference[i] : s->temperature[i]);
        w->direction[i] = w->emission[i];
    }
    const int status = multiply(w, team);
    for (uint32_t i = 0; i < n; ++i) {
        const bool unknown = isnan(s->temperature[i]);
        w->storage[i] = unknown ? s->storage[i] : 0;
        w->residual[i] = unknown ? s->power[i] + received_outside(w, s, i) - w->product[i] : 0;
    }
    return status;
}

/* Finds the next search direction: the preconditioned residual plus `keep` times the last direction. Returns residual
 * times preconditioned residual. *missing: 1 if a sphere misses more power than both `allowed` and rounding error. */
static double next_direction(fibrad_network *w, const fibrad_heat_sources *s, const double *allowed, double last,
                             int *missing) {
    const double rounding = 1e-14;
    const uint32_t n = w->factors->matrix.n;
    double product = 0;
    *missing = 0;
    for (uint32_t i = 0; i < n; ++i) {
        if (!isnan(s->temperature[i])) continue;
        const double size = w->storage[i] + w->diagonal[i], off = fabs(w->residual[i]);
        product += w->residual[i] * (w->residual[i] / size);
        if (off > allowed[i] && off > rounding * size * w->emission[i]) *missing = 1;
    }
    const double keep = last > 0 ? product / last : 0;
    for (uint32_t i = 0; i < n; ++i)
        w->direction[i] = isnan(s->temperature[i]) ? w->residual[i] / (w->storage[i] + w->diagonal[i]) +
                                                         (keep > 0 ? keep * w->direction[i] : 0)
                                                   : 0;
    return product;
}

/* Moves the emissions along the search direction to the least error. */
static void move_emissions(fibrad_network *w, const fibrad_heat_sources *s, double product) {
    const uint32_t n = w->factors->matrix.n;
    double curvature = 0;
    for (uint32_t i = 0; i < n; ++i) curvature += w->direction[i] * w->product[i];
    const double length = product / curvature;
    for (uint32_t i = 0; i < n; ++i) {
        if (!isnan(s->temperature[i])) continue;
        w->emission[i] += length * w->direction[i];
        w->residual[i] -= length * w->product[i];
    }
}

/* Finds the powers. `product` is L times the emissions. */
static void read_powers(const fibrad_network *w, const fibrad_heat_sources *s, fibrad_heat_result *result) {
    const fibrad_factors *d = &w->factors->matrix;
    result->surroundings_power = 0, result->surroundings_error = NAN;
    for (uint32_t b = 0; b < d->walls; ++b) result->wall_power[b] = 0;
    for (uint32_t i = 0; i < d->n; ++i) {
        result->power[i] = received_outside(w, s, i) - w->product[i];
        for (uint32_t b = 0; b < d->walls; ++b)
            result->wall_power[b] += w->weight[i] * d->wall[(size_t)i * d->walls + b] *
                                     (w->emission[i] - emission_at(s, s->wall_temperature[b]));
        result->surroundings_power += w->weight[i] * d->escaped[i] * (w->emission[i] - emission_at(s, s->surroundings));
    }
}

/* Finds the temperatures. FIBRAD_E_UNSOLVABLE: an emission is below 0, and the temperature is NaN. */
static int find_temperatures(const fibrad_network *w, const fibrad_heat_sources *s, fibrad_heat_result *result) {
    int status = FIBRAD_OK;
    for (uint32_t i = 0; i < w->factors->matrix.n; ++i) {
        const double t = isnan(s->temperature[i]) ? sqrt(sqrt(w->emission[i] / s->sigma)) : s->temperature[i];
        if (isnan(t)) status = FIBRAD_E_UNSOLVABLE;
        if (result->temperature) result->temperature[i] = t;
    }
    return status;
}

int fibrad_network_solve(fibrad_network *w, fibrad_team *team, const fibrad_heat_sources *s, const double *allowed,
                         fibrad_heat_result *result) {
    int missing, status = begin(w, team, s);
    double product = next_direction(w, s, allowed, 0, &missing);
    for (result->sweeps = 1; !status && missing && result->sweeps < ITERATIONS_MAX; ++result->sweeps) {
        status = multiply(w, team);
        move_emissions(w, s, product);
        product = next_direction(w, s, allowed, product, &missing);
    }
    for (uint32_t i = 0; i < w->factors->matrix.n; ++i) w->storage[i] = 0, w->direction[i] = w->emission[i];
    if (!status) status = multiply(w, team);
    if (status) return status;
    read_powers(w, s, result);
    status = find_temperatures(w, s, result);
    return missing ? FIBRAD_E_UNSOLVABLE : status;
}
