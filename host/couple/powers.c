/* powers.c - net radiative powers, from rows that stay on the home ranks of particles. SPDX-License-Identifier: MIT */
#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "couple/insitu.h"

/* Whether a temperature is valid. zero: 0 is valid. */
static int temperature_valid(double t, int zero) { return (zero ? t >= 0 : t > 0) && t <= FIBRAD_TEMPERATURE_MAX; }

static double sigma_of(const fibrad_insitu_state *state) {
    return state->sigma == 0 ? FIBRAD_STEFAN_BOLTZMANN : state->sigma;
}

int fibrad_insitu_check_state(fibrad_insitu *s, const fibrad_insitu_state *state, const double *power) {
    const int walls = (int)s->set.walls;
    if (!s->ready) return fibrad_refuse(s->message, FIBRAD_E_STATE, "there are no rows yet, which powers need");
    if (!state || (state->n && !(state->id && state->temperature && power)) || (walls && !state->wall_temperature) ||
        state->n > FIBRAD_SPHERES_MAX)
        return FIBRAD_E_ARGUMENT;
    if (!(sigma_of(state) > 0 && sigma_of(state) <= FIBRAD_SIGMA_MAX))
        return fibrad_refuse(s->message, FIBRAD_E_ARGUMENT, "sigma is not above 0");
    if (!temperature_valid(state->surroundings, 1))
        return fibrad_refuse(s->message, FIBRAD_E_ARGUMENT, "the temperature of the surroundings is not valid");
    for (int k = 0; k < walls; ++k)
        if (!temperature_valid(state->wall_temperature[k], 1))
            return fibrad_refuse(s->message, FIBRAD_E_ARGUMENT, "wall %d: its temperature is not valid", k + 1);
    for (size_t i = 0; i < state->n; ++i)
        if (!temperature_valid(state->temperature[i], 0))
            return fibrad_refuse(s->message, FIBRAD_E_ARGUMENT,
                                 "particle %" PRIu64 ": its temperature %g is not above 0", state->id[i],
                                 state->temperature[i]);
    return FIBRAD_OK;
}

/* Links present owners to home ranks anew, if owners have changed on some rank. */
static int follow_particles(fibrad_insitu *s, const fibrad_insitu_state *state) {
    fibrad_insitu_set *set = &s->set;
    const size_t n = state->n, all = n + set->own;
    /* number of particles; of ranks with other particles than before; sum of the hashes of ids */
    uint64_t culprit, sum[3] = {n, n != set->now_n, fibrad_hash_ids(state->id, n)};
    if (n && !sum[1]) sum[1] = memcmp(set->now.at, state->id, n * sizeof *state->id) != 0;
    MPI_Allreduce(MPI_IN_PLACE, sum, 3, MPI_UINT64_T, MPI_SUM, s->comm);
    if (!sum[1]) return FIBRAD_OK;
    if (sum[0] != set->all)
        return fibrad_refuse(s->message, FIBRAD_E_STATE,
                             "there are %" PRIu64 " particles, but rows of %" PRIu64 "; make new rows", sum[0],
                             set->all);
    if (sum[2] != set->hash)
        return fibrad_refuse(s->message, FIBRAD_E_STATE, "particles have come and others gone; make new rows");
    fibrad_link *link;
    uint64_t *id = malloc((all + 1) * sizeof *id);
    int status = id ? fibrad_block_fit(&s->value, all, sizeof(double)) : FIBRAD_E_MEMORY;
    status = fibrad_agree(s->comm, status, s->message);
    if (!status) {
        if (n) memcpy(id, state->id, n * sizeof *id);
        const uint64_t *home = set->id.at;
        memcpy(id + n, home, set->own * sizeof *id);
        status = fibrad_link_find(&link, s->comm, id, n, all, true, &culprit);
        if (status == FIBRAD_E_ARGUMENT)
            status = fibrad_refuse(s->message, FIBRAD_E_STATE,
                                   "particle %" PRIu64 " has a row, but no rank or two ranks own it; make new rows",
                                   culprit);
    }
    if (status) {
        free(id);
        return status;
    }
    fibrad_link_free(set->present);
    set->present = link;
    fibrad_block_free(&set->now);
    set->now = (fibrad_block){id, (all + 1) * sizeof *id};
    set->now_n = n;
    return FIBRAD_OK;
}

static double fourth(double t) { return t * t * t * t; }

/* Finds the powers that follow from the emissions of particles at home: of these particles (set->power), and adds those
 * of walls and surroundings by the rows of this rank. */
static int flow_home(fibrad_insitu *s, fibrad_flow *flow) {
    fibrad_insitu_set *set = &s->set;
    int status = FIBRAD_OK;
    fibrad_link_forward(set->seen, set->emission.at, 1);
    memset(flow->power, 0, set->columns * sizeof *flow->power);
    for (int t = 0; t < s->config.threads && !status; ++t)
        status = fibrad_rows_flow(&set->rows[t], (uint32_t)set->columns, set->walls, flow);
    fibrad_link_reverse(set->seen, flow->power, 1);
    return status;
}

/* The sum of products over the particles of all ranks. */
static double inner_product(const fibrad_insitu *s, const double *a, const double *b) {
    double sum = 0;
    for (size_t i = 0; i < s->set.own; ++i) sum += a[i] * b[i];
    MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, s->comm);
    return sum;
}

#define NODES_RESIDUAL 1e-10 /* of the node values, relative */
#define NODES_STEPS    500

/* Finds node values N from the emissions E of particles that conduct, in set->emission. The particles' powers are
 * q = q(E) + L (E - N), L being positive, and N = E - S q with the diagonal S = root^2. With q = y/root
 *
 *     (1 - root L root) y = root q(E),
 *
 * which conjugate gradients solve. Source: docs/methods.md section 27. */
static int solve_nodes(fibrad_insitu *s, const fibrad_flow *known) {
    fibrad_insitu_set *set = &s->set;
    const double *root = set->root.at, none[FIBRAD_WALLS_MAX] = {0};
    double *emission = set->emission.at, *power = set->power.at, unused[FIBRAD_WALLS_MAX] = {0};
    double *y = s->solver.at, *r = y + set->own, *p = r + set->own, *given = p + set->own;
    fibrad_flow at_given = *known, change;
    at_given.wall_power = unused;
    change = at_given;
    change.wall_emission = none, change.surroundings_emission = 0;
    for (size_t i = 0; i < set->own; ++i) given[i] = emission[i];
    int status = flow_home(s, &at_given);
    for (size_t i = 0; i < set->own; ++i) y[i] = 0, r[i] = p[i] = root[i] * power[i];
    double square = inner_product(s, r, r);
    const double enough = NODES_RESIDUAL * NODES_RESIDUAL * square;
    for (int step = 0; square > enough && step < NODES_STEPS; ++step) {
        for (size_t i = 0; i < set->own; ++i) emission[i] = root[i] * p[i];
        const int done = flow_home(s, &change);
        if (done) status = done;
        for (size_t i = 0; i < set->own; ++i) power[i] = p[i] + root[i] * power[i];
        const double along = inner_product(s, p, power), length = square / along;
        if (!(along > 0)) return FIBRAD_E_UNSOLVABLE;
        for (size_t i = 0; i < set->own; ++i) y[i] += length * p[i], r[i] -= length * power[i];
        const double before = square;
        square = inner_product(s, r, r);
        for (size_t i = 0; i < set->own; ++i) p[i] = r[i] + square / before * p[i];
    }
    for (size_t i = 0; i < set->own; ++i) emission[i] = given[i] - root[i] * y[i];
    if (!(square <= enough)) status = FIBRAD_E_UNSOLVABLE;
    return status;
}

/* Adds what walls exchange with each other and with the surroundings. */
static void add_walls(const fibrad_insitu_set *set, fibrad_insitu_totals *totals) {
    const double *emission = set->wall_emission;
    for (uint32_t a = 0; a < set->walls; ++a) {
        const double escapes = set->wall_exchange.surroundings[a] * (emission[a] - set->surroundings_emission);
        totals->surroundings += escapes;
        totals->wall[a] -= escapes;
        for (uint32_t b = 0; b < set->walls; ++b)
            totals->wall[a] += set->wall_exchange.wall[a][b] * (emission[b] - emission[a]);
    }
}

int fibrad_insitu_powers(fibrad_insitu *s, const fibrad_insitu_state *state, double *power,
                         fibrad_insitu_totals *totals) {
    if (!s) return FIBRAD_E_ARGUMENT;
    s->message[0] = 0;
    int status = fibrad_agree(s->comm, fibrad_insitu_check_state(s, state, power), s->message);
    const double begun = MPI_Wtime();
    if (!status) status = follow_particles(s, state);
    if (status) {
        if (!s->message[0]) fibrad_refuse(s->message, status, "%s", fibrad_status_text(status));
        return status;
    }
    fibrad_insitu_set *set = &s->set;
    const size_t n = state->n;
    const double sigma = sigma_of(state);
    double *value = s->value.at, *home = value + n, *emission = set->emission.at;
    double of_wall[FIBRAD_WALLS_MAX] = {0}, sum[FIBRAD_WALLS_MAX + 4] = {0};
    for (uint32_t k = 0; k < set->walls; ++k) set->wall_emission[k] = sigma * fourth(state->wall_temperature[k]);
    set->surroundings_emission = sigma * fourth(state->surroundings);
    if (n) memcpy(value, state->temperature, n * sizeof *value);
    fibrad_link_forward(set->present, value, 1);
    for (size_t i = 0; i < set->own; ++i) emission[i] = sigma * fourth(home[i]);

    fibrad_flow flow = {.weight = set->weight.at, .emission = emission, .wall_emission = set->wall_emission};
    flow.surroundings_emission = set->surroundings_emission, flow.power = set->power.at, flow.wall_power = of_wall;
    flow.made = set->changed ? set->made.at : NULL;
    if (set->conducts) {
        status = fibrad_agree(s->comm, solve_nodes(s, &flow), NULL);
        if (status == FIBRAD_E_UNSOLVABLE)
            return fibrad_refuse(s->message, status,
                                 "the rows are too inaccurate for particles that conduct so little: take more paths");
    }
    if (!status) status = flow_home(s, &flow);
    for (size_t i = 0; i < set->own; ++i) sum[0] += flow.power[i], sum[3] += flow.power[i] * flow.power[i];
    sum[1] = flow.surroundings_power;
    sum[2] = status != FIBRAD_OK;
    memcpy(sum + 4, of_wall, sizeof of_wall);
    memcpy(home, flow.power, set->own * sizeof *home);
    memset(value, 0, n * sizeof *value);
    fibrad_link_reverse(set->present, value, 1);
    MPI_Allreduce(MPI_IN_PLACE, sum, FIBRAD_WALLS_MAX + 4, MPI_DOUBLE, MPI_SUM, s->comm);
    if (sum[2] > 0) return fibrad_refuse(s->message, FIBRAD_E_ARGUMENT, "%s", fibrad_status_text(FIBRAD_E_ARGUMENT));
    if (n) memcpy(power, value, n * sizeof *power);
    if (totals) {
        *totals = (fibrad_insitu_totals){.particles = sum[0], .surroundings = sum[1]};
        memcpy(totals->wall, sum + 4, sizeof totals->wall);
        add_walls(set, totals);
    }
    set->flows = 1;
    fibrad_unknown_tell(s, sqrt(sum[3] / (double)set->facts.particles));
    s->seconds_powers += MPI_Wtime() - begun;
    return FIBRAD_OK;
}

/* Adds the squared errors that the noise of one row gives the powers of its particle and of those in it. The row's
 * error is the root of the sum of the squared errors of all factors f. Paths end by chance: a factor of the part g of
 * all ends gets the square g (1 - g), and two factors correlate by -g h, since rows add up to 1. A path leaves at a
 * particle what this absorbs, and the rest of what it carries at its end. So particles count by the emissivity. */
static void add_squares(const fibrad_insitu_set *set, const fibrad_row *row, double *square) {
    const fibrad_particle *p = (const fibrad_particle *)set->particle.at + row->sphere;
    const double *emission = set->emission.at, *made = set->made.at, own = emission[row->sphere];
    double ends = row->escaped, rest = row->escaped * row->escaped, mean = 0, squares = 0;
    for (uint32_t k = 0; k < row->length; ++k) ends += p->node * row->f[k], rest += pow(p->node * row->f[k], 2);
    for (uint32_t k = 0; k < set->walls; ++k) ends += row->wall[k], rest += row->wall[k] * row->wall[k];
    if (!(rest < ends * ends)) return;
    const double error = fibrad_row_weight(row, fibrad_particle_weight(p)) * row->error;
    const double noise = error * error / (1 - rest / (ends * ends));
    for (uint32_t k = 0; k < row->length; ++k) {
        const double g = p->node * row->f[k] / ends, half = made[row->col[k]] == made[row->sphere] ? 0.5 : 1;
        const double gain = half * (emission[row->col[k]] - own);
        mean += g * gain, squares += g * gain * gain;
        square[row->col[k]] += noise * g * (1 - g) * gain * gain;
    }
    for (uint32_t k = 0; k <= set->walls; ++k) {
        const double g = (k < set->walls ? row->wall[k] : row->escaped) / ends;
        const double gain = (k < set->walls ? set->wall_emission[k] : set->surroundings_emission) - own;
        mean += g * gain, squares += g * gain * gain;
    }
    square[row->sphere] += noise * fmax(0, squares - mean * mean);
}

int fibrad_insitu_errors(fibrad_insitu *s, double (*error)[2]) {
    if (!s) return FIBRAD_E_ARGUMENT;
    fibrad_insitu_set *set = &s->set;
    const size_t n = set->now_n;
    fibrad_row row;
    s->message[0] = 0;
    int status = FIBRAD_OK;
    if (!s->ready || !set->flows)
        status = fibrad_refuse(s->message, FIBRAD_E_STATE, "there are no powers yet, of which this would tell");
    if (!status && n && !error) status = FIBRAD_E_ARGUMENT;
    if (!status) status = fibrad_block_fit(&s->value, 2 * (n + set->own) + set->columns, sizeof(double));
    status = fibrad_agree(s->comm, status, s->message);
    if (status) return status;
    double(*value)[2] = s->value.at, (*home)[2] = value + n;
    const double *unknown = set->unknown.at;
    double *square = home[set->own];
    memset(value, 0, n * sizeof *value);
    memset(square, 0, set->columns * sizeof *square);
    for (int t = 0; t < s->config.threads; ++t)
        for (size_t at = 0; fibrad_rows_read(&set->rows[t], &at, &row);)
            home[row.sphere][0] = unknown[row.sphere], add_squares(set, &row, square);
    fibrad_link_reverse(set->seen, square, 1);
    const fibrad_particle *p = set->particle.at; /* a sphere that conducts gains e/n times as much as its node alone */
    for (size_t i = 0; i < set->own; ++i)
        home[i][1] = p[i].node > 0 ? p[i].emissivity / p[i].node * sqrt(square[i]) : 0;
    fibrad_link_reverse(set->present, value[0], 2);
    if (n) memcpy(error, value, n * sizeof *value);
    return FIBRAD_OK;
}
