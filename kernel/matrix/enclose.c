/* enclose.c - rows of bodies: made reciprocal among themselves and closed together with those of spheres.
 * SPDX-License-Identifier: MIT
 *
 * What bodies and spheres exchange is known from the rows of spheres, what bodies exchange from paths, which know their
 * total besides. First the shares among bodies are brought to a total between both, by their errors; then all rows are
 * brought to 1 together, X_pq u_p u_q, bodies being rows as spheres are. docs/heat.md. */
#include "base/constants.h"
#include "matrix/matrix.h"

#define CLOSED_TO   1e-14
#define OWN_STEPS   2000 /* of bodies alone, which cost nothing: two discs that see little else converge slowly */
#define JOINT_STEPS 200

/* A body as a row: 4 pi length^2 is its area times its emissivity; 0: it has none, being unbounded or a reflector. */
static double *between(const fibrad_matrix *m, uint32_t b, uint32_t c) { return &m->between[b * m->bodies + c]; }

/* A_i e_i over A_b e_b. */
static double over_body(const fibrad_matrix *m, uint32_t i, uint32_t b) {
    const double ratio = m->r[i] / m->length[b];
    return ratio * ratio;
}

/* The mean of both ways between bodies, weighted by the paths per area. */
static void join_ways(fibrad_matrix *m) {
    for (uint32_t b = 0; b < m->bodies; b++)
        for (uint32_t c = 0; c < b; c++) {
            if (m->length[b] == 0 || m->length[c] == 0) continue;
            const double larger = fibrad_max(m->length[b], m->length[c]);
            double a_b = m->length[b] / larger, a_c = m->length[c] / larger;
            a_b *= a_b, a_c *= a_c;
            const double sum = (*between(m, b, c) + *between(m, c, b)) / (a_b + a_c);
            *between(m, b, c) = a_c * sum, *between(m, c, b) = a_b * sum;
        }
}

/* What a body sends to other bodies and the surroundings. */
static double rest_of(const fibrad_matrix *m, uint32_t b) {
    double rest = m->body_escaped[b];
    for (uint32_t c = 0; c < m->bodies; c++) rest += *between(m, b, c);
    return rest;
}

/* What a body should send to others than spheres: between what the paths say and what the rows of spheres leave over,
 * whose variance is about that of their entries by share. */
static double rest_wanted(fibrad_matrix *m, uint32_t b) {
    const double rest = rest_of(m, b), error = m->body_error[b];
    double spheres = 0, variance = 0;
    for (uint32_t i = 0; i < m->result.n; i++) {
        const double share = m->body[(size_t)i * m->bodies + b] * over_body(m, i, b), own = m->row[i]->error;
        spheres += share;
        variance += share * over_body(m, i, b) * own * own;
    }
    m->correction = fibrad_max(m->correction, fibrad_abs(spheres + rest - 1));
    const double all = variance + error * error;
    const double wanted = all > 0 ? rest + error * error / all * (1 - spheres - rest) : rest;
    return fibrad_max(wanted, 0.5 * rest);
}

/* Brings what bodies send to each other and the surroundings to `wanted`. */
static void scale_bodies(fibrad_matrix *m, const double wanted[]) {
    double v[FIBRAD_WALLS], next[FIBRAD_WALLS], worst = 1;
    for (uint32_t b = 0; b < m->bodies; b++) v[b] = next[b] = 1;
    for (int step = 0; step < OWN_STEPS && worst > CLOSED_TO; step++) {
        worst = 0;
        for (uint32_t b = 0; b < m->bodies; b++) {
            if (m->length[b] == 0) continue;
            double sum = m->body_escaped[b];
            for (uint32_t c = 0; c < m->bodies; c++) sum += *between(m, b, c) * v[c];
            worst = fibrad_max(worst, fibrad_abs(wanted[b] - v[b] * sum));
            next[b] = sum > 0 ? fibrad_sqrt(v[b] * wanted[b] / sum) : 1;
        }
        fibrad_copy(v, next, sizeof v);
    }
    for (uint32_t b = 0; b < m->bodies; b++) {
        for (uint32_t c = 0; c < m->bodies; c++) *between(m, b, c) *= v[b] * v[c];
        m->body_escaped[b] *= v[b];
    }
}

/* One step towards sums of 1 from factors u of spheres and v of bodies to the next ones; returns the worst sum's
 * distance from 1. */
static double closing_step(const fibrad_matrix *m, const double *u, const double v[], double *u_next, double v_next[]) {
    const fibrad_sparse *rows = &m->result;
    double worst = 0, of_body[FIBRAD_WALLS] = {0};
    for (uint32_t i = 0; i < rows->n; i++) {
        const double *body = m->body + (size_t)i * m->bodies;
        double sum = m->escaped[i] + m->beyond[i];
        u_next[i] = 1;
        if (m->r[i] == 0) continue;
        for (uint64_t k = rows->start[i]; k < rows->start[i + 1]; k++) sum += rows->f[k] * u[rows->col[k]];
        for (uint32_t b = 0; b < m->bodies; b++) {
            sum += body[b] * v[b];
            if (m->length[b] > 0) of_body[b] += body[b] * over_body(m, i, b) * u[i];
        }
        worst = fibrad_max(worst, fibrad_abs(1 - u[i] * sum));
        u_next[i] = fibrad_sqrt(u[i] / sum);
    }
    for (uint32_t b = 0; b < m->bodies; b++) {
        double sum = of_body[b] + m->body_escaped[b];
        v_next[b] = 1;
        if (m->length[b] == 0) continue;
        for (uint32_t c = 0; c < m->bodies; c++) sum += *between(m, b, c) * v[c];
        worst = fibrad_max(worst, fibrad_abs(1 - v[b] * sum));
        v_next[b] = sum > 0 ? fibrad_sqrt(v[b] / sum) : 1;
    }
    return worst;
}

/* Brings all sums to 1. */
static void close_all(fibrad_matrix *m) {
    const fibrad_sparse *rows = &m->result;
    double *u = m->scratch, *u_next = u + rows->n, v[FIBRAD_WALLS], v_next[FIBRAD_WALLS];
    for (uint32_t i = 0; i < rows->n; i++) u[i] = 1;
    for (uint32_t b = 0; b < m->bodies; b++) v[b] = 1;
    for (int step = 0; step < JOINT_STEPS && closing_step(m, u, v, u_next, v_next) > CLOSED_TO; step++) {
        fibrad_copy(u, u_next, rows->n * sizeof *u);
        fibrad_copy(v, v_next, sizeof v);
    }
    for (uint32_t i = 0; i < rows->n; i++) {
        for (uint64_t k = rows->start[i]; k < rows->start[i + 1]; k++) rows->f[k] *= u[i] * u[rows->col[k]];
        for (uint32_t b = 0; b < m->bodies; b++) m->body[(size_t)i * m->bodies + b] *= u[i] * v[b];
        m->escaped[i] *= u[i], m->beyond[i] *= u[i];
    }
    for (uint32_t b = 0; b < m->bodies; b++) {
        for (uint32_t c = 0; c < m->bodies; c++) *between(m, b, c) *= v[b] * v[c];
        m->body_escaped[b] *= v[b];
    }
}

void fibrad_matrix_take_bodies(fibrad_matrix *m, const fibrad_scene *scene, const fibrad_matrix_rule *rule) {
    for (uint32_t b = 0; b < m->bodies; b++) {
        const double area = scene->wall_area[scene->slot[b]];
        const double emitting = area * (rule->body_emissivity != NULL ? rule->body_emissivity[b] : 1);
        const bool unbounded = !fibrad_finite(area);
        m->length[b] = unbounded ? 0 : fibrad_sqrt(emitting / (4 * FIBRAD_PI));
        for (uint32_t c = 0; c < m->bodies; c++)
            *between(m, b, c) = unbounded ? __builtin_nan("") : rule->body_row[b].body[c];
        m->body_escaped[b] = unbounded ? __builtin_nan("") : rule->body_row[b].escaped;
        m->body_error[b] = unbounded ? __builtin_nan("") : rule->body_row[b].error;
    }
}

void fibrad_matrix_enclose(fibrad_matrix *m) {
    double before[FIBRAD_WALLS][FIBRAD_WALLS + 1] = {{0}}, wanted[FIBRAD_WALLS] = {0}, most = 0;
    for (uint32_t b = 0; b < m->bodies; b++) most = fibrad_max(most, m->length[b]);
    if (most == 0) return;
    for (uint32_t b = 0; b < m->bodies; b++) {
        for (uint32_t c = 0; c < m->bodies; c++) before[b][c] = *between(m, b, c);
        before[b][m->bodies] = m->body_escaped[b];
    }
    join_ways(m);
    for (uint32_t b = 0; b < m->bodies; b++)
        if (m->length[b] > 0) wanted[b] = rest_wanted(m, b);
    scale_bodies(m, wanted);
    close_all(m);
    for (uint32_t b = 0; b < m->bodies; b++) { /* by how much that has changed a row is an error, too */
        double square = 0, difference = before[b][m->bodies] - m->body_escaped[b];
        square += difference * difference;
        for (uint32_t c = 0; c < m->bodies; c++) {
            difference = before[b][c] - *between(m, b, c);
            square += difference * difference;
        }
        m->body_error[b] = fibrad_max(m->body_error[b], fibrad_sqrt(square));
    }
}
