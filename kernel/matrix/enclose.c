/* enclose.c - rows of walls: made reciprocal among themselves, and closed together with the rows of spheres.
 * SPDX-License-Identifier: MIT
 *
 * The rows of spheres tell what walls and spheres exchange. Paths tell what walls exchange with each other, and also
 * the total of each wall. First the shares among walls are brought to a total between both, weighted by their
 * errors. Then all rows are brought to 1 together, X_pq u_p u_q, where walls are rows as spheres are.
 * docs/methods.md section 16. */
#include "base/linear.h"
#include "matrix/matrix.h"

#define CLOSED_TO     1e-14
#define CLOSED_ENOUGH 1e-9 /* otherwise the sums contradict reciprocity, and no factors u bring them to 1 */
#define OWN_STEPS     60   /* limit of Newton's steps; about five suffice unless sums contradict each other */
#define JOINT_STEPS   200

/* The factor from one wall to another. */
static double *between(const fibrad_matrix *m, uint32_t b, uint32_t c) { return &m->between[b * m->walls + c]; }

/* A_i e_i over A_b e_b. */
static double over_wall(const fibrad_matrix *m, uint32_t i, uint32_t b) {
    const double ratio = m->r[i] / m->length[b];
    return ratio * ratio;
}

/* The mean of both directions between walls, weighted by the paths per area. The square of a row's error is divided
 * among its entries by their share. Entries to spheres come from elsewhere. */
static void join_ways(fibrad_matrix *m) {
    double square[FIBRAD_WALLS_MAX];
    for (uint32_t b = 0; b < m->walls; b++)
        square[b] = m->wall_error[b] * m->wall_error[b] * (m->wall_escaped[b] + *between(m, b, b));
    for (uint32_t b = 0; b < m->walls; b++)
        for (uint32_t c = 0; c < b; c++) {
            if (m->length[b] == 0 || m->length[c] == 0) continue;
            const double larger = fibrad_max(m->length[b], m->length[c]);
            double a_b = m->length[b] / larger, a_c = m->length[c] / larger;
            a_b *= a_b, a_c *= a_c;
            const double sum = (*between(m, b, c) + *between(m, c, b)) / (a_b + a_c);
            const double both = (*between(m, b, c) * m->wall_error[b] * m->wall_error[b] +
                                 *between(m, c, b) * m->wall_error[c] * m->wall_error[c]) /
                                ((a_b + a_c) * (a_b + a_c));
            square[b] += a_c * a_c * both, square[c] += a_b * a_b * both;
            *between(m, b, c) = a_c * sum, *between(m, c, b) = a_b * sum;
        }
    for (uint32_t b = 0; b < m->walls; b++)
        if (m->length[b] > 0) m->wall_error[b] = fibrad_sqrt(square[b]);
}

/* What a wall sends to other walls and the surroundings. */
static double rest_of(const fibrad_matrix *m, uint32_t b) {
    double rest = m->wall_escaped[b];
    for (uint32_t c = 0; c < m->walls; c++) rest += *between(m, b, c);
    return rest;
}

/* What a wall should send to all but spheres. This is a mean of what the paths tell and of what the rows of spheres
 * leave. The variance of the latter is about that of their entries, by share. */
static double rest_wanted(fibrad_matrix *m, uint32_t b) {
    const double rest = rest_of(m, b), error = m->wall_error[b];
    double spheres = 0, variance = 0;
    for (uint32_t i = 0; i < m->result.n; i++) {
        const double share = m->wall[(size_t)i * m->walls + b] * over_wall(m, i, b), own = m->error[i];
        spheres += share;
        variance += share * over_wall(m, i, b) * own * own;
    }
    m->correction = fibrad_max(m->correction, fibrad_abs(spheres + rest - 1));
    const double all = variance + error * error;
    const double wanted = all > 0 ? rest + error * error / all * (1 - spheres - rest) : rest;
    return fibrad_max(wanted, 0.5 * rest);
}

/* Finds v with v_b (fixed_b + sum over c of D_bc v_c) = wanted_b. In the logarithms of v this is the minimum of a
 * convex function. Newton's method finds it. Simple iterations would never end if two walls see little but each
 * other. Returns the largest error of the last step. */
static double balance_walls(const fibrad_matrix *m, const double fixed[], const double wanted[], double v[]) {
    const uint32_t wide = m->walls + 1;
    double worst = 0;
    for (int step = 0; step < OWN_STEPS; step++) {
        worst = 0;
        fibrad_zero(m->newton, m->walls * wide * sizeof *m->newton);
        for (uint32_t b = 0; b < m->walls; b++) {
            double *row = m->newton + b * wide;
            row[b] = 1;
            if (m->length[b] == 0) continue;
            double sum = v[b] * fixed[b];
            for (uint32_t c = 0; c < m->walls; c++) {
                const double part = v[b] * *between(m, b, c) * v[c];
                sum += part;
                row[c] = m->length[c] > 0 ? part : 0;
            }
            row[b] += sum;
            row[m->walls] = wanted[b] - sum;
            worst = fibrad_max(worst, fibrad_abs(row[m->walls]));
        }
        if (worst <= CLOSED_TO / 8) return worst;
        fibrad_solve_linear(m->walls, wide, m->newton);
        for (uint32_t b = 0; b < m->walls; b++) {
            const double x = m->newton[b * wide + m->walls];
            v[b] = x > 0 ? v[b] * (1 + fibrad_min(x, 1)) : v[b] / (1 - x);
        }
    }
    return worst;
}

static void scale_walls(fibrad_matrix *m, const double v[]) {
    for (uint32_t b = 0; b < m->walls; b++) {
        for (uint32_t c = 0; c < m->walls; c++) *between(m, b, c) *= v[b] * v[c];
        m->wall_escaped[b] *= v[b];
    }
}

/* What walls send to spheres that are scaled by u, and to the surroundings. */
static void sum_outside(const fibrad_matrix *m, const double *u, double outside[]) {
    for (uint32_t b = 0; b < m->walls; b++) outside[b] = m->wall_escaped[b];
    for (uint32_t i = 0; i < m->result.n; i++)
        for (uint32_t b = 0; b < m->walls; b++)
            if (m->length[b] > 0) outside[b] += m->wall[(size_t)i * m->walls + b] * over_wall(m, i, b) * u[i];
}

/* One step of the spheres towards sums of 1. v: scales of the walls. Returns the largest error. */
static double closing_step(fibrad_matrix *m, const double v[]) {
    for (uint32_t i = 0; i < m->result.n; i++) {
        m->scratch[i] = m->escaped[i] + m->beyond[i];
        for (uint32_t b = 0; b < m->walls; b++) m->scratch[i] += m->wall[(size_t)i * m->walls + b] * v[b];
    }
    return fibrad_matrix_step(m, true);
}

/* Brings all sums to 1. Returns the largest error in the end. If it is above CLOSED_ENOUGH, nothing has changed. */
static double close_all(fibrad_matrix *m) {
    const fibrad_sparse *rows = &m->result;
    double *u = m->scratch + rows->n, v[FIBRAD_WALLS_MAX] = {0}, one[FIBRAD_WALLS_MAX] = {0},
           outside[FIBRAD_WALLS_MAX] = {0};
    for (uint32_t i = 0; i < 2 * rows->n; i++) u[i] = 1;
    for (uint32_t b = 0; b < m->walls; b++) v[b] = one[b] = 1;
    double worst = 0;
    for (int step = 0; step < JOINT_STEPS; step++) {
        sum_outside(m, u, outside);
        worst = balance_walls(m, outside, one, v);
        worst = fibrad_max(worst, closing_step(m, v));
        if (worst <= CLOSED_TO) break;
        fibrad_matrix_advance(m);
    }
    if (!(worst <= CLOSED_ENOUGH)) return worst;
    for (uint32_t i = 0; i < rows->n; i++) {
        for (uint64_t k = rows->start[i]; k < rows->start[i + 1]; k++) rows->f[k] *= u[i] * u[rows->col[k]];
        for (uint32_t b = 0; b < m->walls; b++) m->wall[(size_t)i * m->walls + b] *= u[i] * v[b];
        m->escaped[i] *= u[i], m->beyond[i] *= u[i];
    }
    scale_walls(m, v);
    return worst;
}

void fibrad_matrix_take_walls(fibrad_matrix *m, const fibrad_scene *scene, const fibrad_matrix_rule *rule) {
    for (uint32_t b = 0; b < m->walls; b++) {
        const double area = scene->wall_area[scene->slot[b]];
        const double emitting = area * (rule->wall_emissivity != NULL ? rule->wall_emissivity[b] : 1);
        const bool unbounded = !fibrad_finite(area);
        m->length[b] = unbounded ? 0 : fibrad_sqrt(emitting / (4 * FIBRAD_PI));
        for (uint32_t c = 0; c < m->walls; c++)
            *between(m, b, c) = unbounded ? __builtin_nan("") : fibrad_max(0, rule->wall_row[b].wall[c]);
        m->wall_escaped[b] = unbounded ? __builtin_nan("") : rule->wall_row[b].escaped;
        m->wall_error[b] = unbounded ? __builtin_nan("") : rule->wall_row[b].error;
    }
}

/* Keeps the shares among walls and to the surroundings as the paths tell them. */
static void leave_walls_open(fibrad_matrix *m) {
    for (uint32_t b = 0; b < m->walls; b++) {
        const double *before = m->before + b * (m->walls + 1);
        for (uint32_t c = 0; c < m->walls; c++) *between(m, b, c) = before[c];
        m->wall_escaped[b] = before[m->walls];
    }
    m->wall_closure = m->correction;
}

void fibrad_matrix_enclose(fibrad_matrix *m) {
    const uint32_t wide = m->walls + 1;
    double *before = m->before, wanted[FIBRAD_WALLS_MAX] = {0}, v[FIBRAD_WALLS_MAX], most = 0;
    for (uint32_t b = 0; b < m->walls; b++) most = fibrad_max(most, m->length[b]);
    if (most == 0) return;
    join_ways(m);
    for (uint32_t b = 0; b < m->walls; b++) {
        for (uint32_t c = 0; c < m->walls; c++) before[b * wide + c] = *between(m, b, c);
        before[b * wide + m->walls] = m->wall_escaped[b];
    }
    for (uint32_t b = 0; b < m->walls; b++)
        if (m->length[b] > 0) wanted[b] = rest_wanted(m, b);
    for (uint32_t b = 0; b < m->walls; b++) v[b] = 1;
    balance_walls(m, m->wall_escaped, wanted, v);
    scale_walls(m, v);
    m->wall_closure = close_all(m);
    if (!(m->wall_closure <= CLOSED_ENOUGH)) leave_walls_open(m);
    for (uint32_t b = 0; b < m->walls; b++) { /* the change of a row by this is an error, too */
        double square = 0, difference = before[b * wide + m->walls] - m->wall_escaped[b];
        square += difference * difference;
        for (uint32_t c = 0; c < m->walls; c++) {
            difference = before[b * wide + c] - *between(m, b, c);
            square += difference * difference;
        }
        m->wall_error[b] = fibrad_max(m->wall_error[b], fibrad_sqrt(square));
    }
}
