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

static int check_state(fibrad_insitu *s, const fibrad_insitu_state *state, const double *power) {
    const int bodies = (int)s->set.bodies;
    if (!s->ready) return fibrad_refuse(s->message, FIBRAD_E_STATE, "there are no rows yet, which powers need");
    if (!state || (state->n && !(state->id && state->temperature && power)) || (bodies && !state->body_temperature) ||
        state->n > FIBRAD_SPHERES_MAX)
        return FIBRAD_E_ARGUMENT;
    if (!(sigma_of(state) > 0 && sigma_of(state) <= FIBRAD_SIGMA_MAX))
        return fibrad_refuse(s->message, FIBRAD_E_ARGUMENT, "sigma is not above 0");
    if (!temperature_valid(state->surroundings, 1))
        return fibrad_refuse(s->message, FIBRAD_E_ARGUMENT, "the temperature of the surroundings is not valid");
    for (int k = 0; k < bodies; ++k)
        if (!temperature_valid(state->body_temperature[k], 1))
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
        status = fibrad_link_new(&link, s->comm, id, n, all, &culprit);
        if (status == FIBRAD_E_ARGUMENT)
            status =
                fibrad_refuse(s->message, FIBRAD_E_STATE,
                              "particle %" PRIu64 " has a row, but no owner or two owners; make new rows", culprit);
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

/* Finds the powers by the rows of this rank: of columns (set->power), walls and surroundings. */
static int flow_at_home(fibrad_insitu *s, const fibrad_insitu_state *state, fibrad_flow *flow) {
    fibrad_insitu_set *set = &s->set;
    int status = FIBRAD_OK;
    memset(flow->power, 0, set->columns * sizeof *flow->power);
    flow->surroundings_emission = sigma_of(state) * fourth(state->surroundings);
    for (int t = 0; t < s->config.threads && !status; ++t)
        status = fibrad_rows_flow(&set->rows[t], (uint32_t)set->columns, set->bodies, flow);
    return status;
}

int fibrad_insitu_powers(fibrad_insitu *s, const fibrad_insitu_state *state, double *power,
                         fibrad_insitu_totals *totals) {
    if (!s) return FIBRAD_E_ARGUMENT;
    s->message[0] = 0;
    int status = fibrad_agree(s->comm, check_state(s, state, power), s->message);
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
    double wall[2][FIBRAD_BODIES_MAX] = {{0}}, sum[FIBRAD_BODIES_MAX + 3] = {0};
    for (uint32_t k = 0; k < set->bodies; ++k) wall[0][k] = sigma * fourth(state->body_temperature[k]);
    if (n) memcpy(value, state->temperature, n * sizeof *value);
    fibrad_link_forward(set->present, value, 1);
    for (size_t i = 0; i < set->own; ++i) emission[i] = sigma * fourth(home[i]);
    fibrad_link_forward(set->seen, emission, 1);

    fibrad_flow flow = {.weight = set->weight.at,
                        .emission = emission,
                        .body_emission = wall[0],
                        .power = set->power.at,
                        .body_power = wall[1]};
    status = flow_at_home(s, state, &flow);
    fibrad_link_reverse(set->seen, flow.power, 1);
    for (size_t i = 0; i < set->own; ++i) sum[0] += flow.power[i];
    sum[1] = flow.surroundings_power;
    sum[2] = status != FIBRAD_OK;
    memcpy(sum + 3, wall[1], sizeof wall[1]);
    memcpy(home, flow.power, set->own * sizeof *home);
    memset(value, 0, n * sizeof *value);
    fibrad_link_reverse(set->present, value, 1);
    MPI_Allreduce(MPI_IN_PLACE, sum, FIBRAD_BODIES_MAX + 3, MPI_DOUBLE, MPI_SUM, s->comm);
    if (sum[2] > 0) return fibrad_refuse(s->message, FIBRAD_E_ARGUMENT, "%s", fibrad_status_text(FIBRAD_E_ARGUMENT));
    if (n) memcpy(power, value, n * sizeof *power);
    if (totals) {
        *totals = (fibrad_insitu_totals){.particles = sum[0], .surroundings = sum[1]};
        memcpy(totals->body, sum + 3, sizeof totals->body);
    }
    s->seconds_powers += MPI_Wtime() - begun;
    return FIBRAD_OK;
}
