/* contacts.c - heat that contacts and gas conduct between particles that are divided over ranks, and to walls.
 * SPDX-License-Identifier: MIT
 *
 * A rank finds contacts among its own particles and those of other ranks that may touch them. All are sorted by id
 * before. So both ranks that know of a contact find the same conductance, to the bit. Contacts are sorted, too. So each
 * particle adds up its flows in one order, whoever owns which particle. */
#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "simple/contact_list.h"
#include "couple/insitu.h"

#define PARTS_MOST 100 /* of a step of heat */

/* The indices of both ends in the list of particles; a wall has that of the wall plus the number of particles. */
struct conductor {
    uint32_t first, second;
    double distance, conductance;
};

static int by_id(const void *a, const void *b) {
    const fibrad_particle *x = a, *y = b;
    return x->id < y->id ? -1 : x->id > y->id;
}

static int by_ends(const void *a, const void *b) {
    const struct conductor *x = a, *y = b;
    if (x->first != y->first) return x->first < y->first ? -1 : 1;
    if (x->second != y->second) return x->second < y->second ? -1 : 1;
    return x->distance < y->distance ? -1 : x->distance > y->distance;
}

/* The conductivity of the gas at a temperature: linear between rows, and constant beyond them. */
static double gas_at(const fibrad_insitu_contacts *c, double temperature) {
    const double *t = c->gas_temperature, *k = c->gas_conductivity;
    uint32_t row = 0;
    while (row < c->gas_rows && t[row] < temperature) ++row;
    if (row == 0 || row == c->gas_rows) return c->gas_rows == 0 ? c->gas : k[row > 0 ? row - 1 : 0];
    return k[row] - (t[row] - temperature) / (t[row] - t[row - 1]) * (k[row] - k[row - 1]);
}

static bool gas_valid(const fibrad_insitu_contacts *c) {
    bool valid = c->gas >= 0 && (c->gas_rows == 0 || (c->gas_temperature && c->gas_conductivity));
    for (uint32_t k = 0; k < c->gas_rows && valid; ++k)
        valid = c->gas_conductivity[k] >= 0 && c->gas_conductivity[k] < INFINITY &&
                (k == 0 || c->gas_temperature[k] > c->gas_temperature[k - 1]);
    return valid;
}

static int check_conduction(fibrad_insitu *s, const fibrad_insitu_contacts *contacts, const fibrad_insitu_bed *bed,
                            const fibrad_insitu_state *state) {
    if (!contacts || (bed->n && !contacts->conductivity) || state->n != bed->n || bed->walls != s->set.walls ||
        (bed->n && memcmp(state->id, bed->id, bed->n * sizeof *bed->id) != 0) ||
        !(contacts->scale >= 0 && gas_valid(contacts) && contacts->gas_least >= 0 && contacts->wall >= 0))
        return FIBRAD_E_ARGUMENT;
    if (bed->clump) return fibrad_refuse(s->message, FIBRAD_E_UNSUPPORTED, "contacts of clumps do not conduct here");
    if (bed->conductivity)
        return fibrad_refuse(s->message, FIBRAD_E_UNSUPPORTED,
                             "contacts need particles of one temperature each, not particles that conduct inside");
    for (size_t i = 0; i < bed->n; ++i)
        if (!(contacts->conductivity[i] > 0 && isfinite(contacts->conductivity[i])))
            return fibrad_refuse(s->message, FIBRAD_E_ARGUMENT,
                                 "particle %" PRIu64 ": its conductivity at contacts must be above 0, not %g",
                                 bed->id[i], contacts->conductivity[i]);
    return FIBRAD_OK;
}

/* Gathers the particles of this rank that take part, and those of other ranks that may touch them, sorted by id. The
 * first `own` of b->s->order are the indices in the bed of those of this rank. */
static int gather_particles(fibrad_insitu_build *b, const fibrad_insitu_contacts *contacts,
                            const fibrad_insitu_state *state, double gas_reach) {
    double largest = 0;
    int status = fibrad_agree(b->s->comm, fibrad_block_fit(&b->s->order, b->own, sizeof(uint32_t)), NULL);
    if (status) return status;
    fibrad_particle *own = b->to->particle.at;
    uint32_t *order = b->s->order.at;
    for (uint32_t i = 0, k = 0; k < b->own; ++i) {
        if (own[k].id != b->bed->id[i]) continue; /* left out */
        own[k].conductivity = contacts->conductivity[i], own[k].temperature = state->temperature[i];
        largest = fmax(largest, own[k].radius);
        order[k++] = i;
    }
    MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, b->s->comm);
    status = fibrad_halo(b->s->comm, b->period, (2 + gas_reach) * largest, true, &b->to->particle, b->own, &b->s->sent,
                         &b->halo);
    if (!status) qsort(b->to->particle.at, b->own + b->halo, sizeof(fibrad_particle), by_id);
    return status;
}

/* Finds the conductances of all contacts of the gathered particles. *conductor: [*count], in order; to be freed. */
static int find_conductors(const fibrad_insitu_build *b, const fibrad_insitu_contacts *contacts,
                           const fibrad_insitu_state *state, double gas_reach, struct conductor **conductor,
                           uint32_t *count) {
    fibrad_contact_rule rule = {.spots = contacts->hertz ? FIBRAD_SPOTS_HERTZ : FIBRAD_SPOTS_LENS};
    rule.scale = contacts->scale, rule.gas_reach = gas_reach, rule.gas_least = contacts->gas_least,
    rule.wall = contacts->wall;
    const fibrad_scene_config config = {.wall = b->bed->wall,
                                        .walls = b->bed->walls,
                                        .triangles = b->bed->triangles,
                                        .period = {b->period[0], b->period[1], b->period[2]}};
    const fibrad_particle *p = b->to->particle.at;
    const fibrad_spheres spheres = fibrad_particle_spheres(p, b->own + b->halo, NULL, NULL);
    fibrad_contact_list *list;
    int status = fibrad_contacts_find(&config, &spheres, &rule, &list);
    if (status) return status;
    double *solid = malloc((spheres.n + 2 * (size_t)list->n + 1) * sizeof *solid);
    double *gas = solid + spheres.n, *conductance = gas + list->n;
    struct conductor *c = *conductor = malloc(((size_t)list->n + 1) * sizeof *c);
    status = solid && c ? FIBRAD_OK : FIBRAD_E_MEMORY;
    for (uint32_t i = 0; i < spheres.n && !status; ++i) solid[i] = p[i].conductivity;
    for (uint32_t k = 0; k < list->n && !status; ++k) {
        const uint32_t j = list->second[k];
        const double other = j < spheres.n ? p[j].temperature : state->wall_temperature[j - spheres.n];
        gas[k] = gas_at(contacts, (p[list->first[k]].temperature + other) / 2);
    }
    if (!status) status = fibrad_contacts_conduct(list, &rule, solid, gas, conductance);
    for (uint32_t k = 0; k < list->n && !status; ++k)
        c[k] = (struct conductor){list->first[k], list->second[k], list->distance[k], conductance[k]};
    *count = list->n;
    if (!status) qsort(c, *count, sizeof *c, by_ends);
    free(list);
    free(solid);
    return status;
}

/* Adds up what particles of this rank gain, and what walls gain from them. */
static void add_flows(const fibrad_insitu_build *b, const fibrad_insitu_state *state, const struct conductor *conductor,
                      uint32_t count, double *power, double *conductance, fibrad_insitu_conducted *sum) {
    const uint32_t rank = (uint32_t)b->s->rank, particles = (uint32_t)(b->own + b->halo), *order = b->s->order.at;
    const fibrad_particle *p = b->to->particle.at;
    for (uint32_t k = 0; k < count; ++k) {
        const struct conductor *c = &conductor[k];
        const fibrad_particle *first = &p[c->first], *second = c->second < particles ? &p[c->second] : NULL;
        const uint32_t wall = c->second - particles;
        const double other = second ? second->temperature : state->wall_temperature[wall];
        const double flow = c->conductance * (other - first->temperature);
        if (first->owner.rank == rank) {
            power[order[first->owner.index]] += flow, conductance[order[first->owner.index]] += c->conductance;
            sum->contacts += 1;
            if (!second) sum->wall[wall] -= flow, sum->particles += flow, sum->conductance[wall] += c->conductance;
        }
        if (second && second->owner.rank == rank)
            power[order[second->owner.index]] -= flow, conductance[order[second->owner.index]] += c->conductance;
    }
}

/* Conducts in equal parts of a step of heat, as many as explicit steps need, and makes powers those of the mean over
 * the parts. The first part is in `power` already. */
static int add_parts(fibrad_insitu_build *b, const fibrad_insitu_contacts *contacts, const fibrad_insitu_state *state,
                     const struct conductor *conductor, uint32_t count, double *power, double *conductance,
                     fibrad_insitu_conducted *sum) {
    const size_t all = b->own + b->halo, n = b->bed->n;
    const uint32_t rank = (uint32_t)b->s->rank, *order = b->s->order.at;
    fibrad_particle *p = b->to->particle.at;
    double most = 0;
    for (size_t i = 0; i < n && contacts->capacity; ++i)
        most = fmax(most, 2 * conductance[i] * contacts->seconds / contacts->capacity[i]);
    MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_DOUBLE, MPI_MAX, b->s->comm);
    const double parts = fmax(1, fmin(PARTS_MOST, ceil(2 * most)));
    sum->parts = parts;
    if (parts == 1) return FIBRAD_OK;
    fibrad_link *link = NULL;
    int status = fibrad_block_fit(&b->s->sent, b->halo, sizeof(fibrad_place));
    if (!status) status = fibrad_block_fit(&b->s->value, all, sizeof(double));
    status = fibrad_agree(b->s->comm, status, NULL);
    if (status) return status;
    fibrad_place *place = b->s->sent.at;
    double *t = b->s->value.at, *sums = (double *)sum;
    for (uint32_t k = 0, used = 0; k < all; ++k)
        if (p[k].owner.rank != rank) place[used] = p[k].owner, p[k].owner.index = (uint32_t)b->own + used++;
    status = fibrad_link_to(&link, b->s->comm, b->own, place, b->halo);
    for (int part = 1; part < (int)parts && !status; ++part) {
        for (size_t i = 0; i < b->own; ++i)
            t[i] = state->temperature[order[i]] +
                   power[order[i]] * contacts->seconds / (parts * contacts->capacity[order[i]]);
        fibrad_link_forward(link, t, 1);
        for (size_t k = 0; k < all; ++k) p[k].temperature = t[p[k].owner.index];
        add_flows(b, state, conductor, count, power, conductance, sum);
    }
    for (size_t i = 0; i < n; ++i) power[i] /= parts, conductance[i] /= parts * parts;
    for (size_t k = 0; k < sizeof *sum / sizeof *sums; ++k) sums[k] /= parts;
    sum->parts = parts;
    fibrad_link_free(link);
    return status;
}

int fibrad_insitu_conduct(fibrad_insitu *s, const fibrad_insitu_contacts *contacts, const fibrad_insitu_bed *bed,
                          const fibrad_insitu_state *state, double *power, double *conductance,
                          fibrad_insitu_conducted *conducted) {
    if (!s) return FIBRAD_E_ARGUMENT;
    fibrad_insitu_build b = {.s = s, .to = &s->next, .bed = bed};
    struct conductor *conductor = NULL;
    fibrad_insitu_conducted sum = {0};
    uint32_t count = 0;
    s->message[0] = 0;
    int status = fibrad_insitu_check(&b);
    const double begun = MPI_Wtime();
    if (!status) status = fibrad_insitu_check_state(s, state, power);
    if (!status) status = conductance || !bed->n ? check_conduction(s, contacts, bed, state) : FIBRAD_E_ARGUMENT;
    status = fibrad_agree(s->comm, status, s->message);
    const double gas_reach = !status && (contacts->gas > 0 || contacts->gas_rows > 0) ? FIBRAD_GAS_REACH_DEFAULT : 0;
    if (!status) status = gather_particles(&b, contacts, state, gas_reach);
    if (!status) {
        status = find_conductors(&b, contacts, state, gas_reach, &conductor, &count);
        status = fibrad_agree(s->comm, status, s->message);
    }
    if (!status) {
        for (size_t i = 0; i < bed->n; ++i) power[i] = conductance[i] = 0;
        add_flows(&b, state, conductor, count, power, conductance, &sum);
        status = add_parts(&b, contacts, state, conductor, count, power, conductance, &sum);
    }
    if (!status) {
        const double parts = sum.parts;
        MPI_Allreduce(MPI_IN_PLACE, &sum, sizeof sum / sizeof(double), MPI_DOUBLE, MPI_SUM, s->comm);
        sum.parts = parts;
        if (conducted) *conducted = sum;
        s->seconds_powers += MPI_Wtime() - begun;
    } else if (!s->message[0]) {
        fibrad_refuse(s->message, status, "%s", fibrad_status_text(status));
    }
    free(conductor);
    return status;
}
