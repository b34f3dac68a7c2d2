/* stream.c - gas that flows through slices and exchanges heat with the nodes in them. SPDX-License-Identifier: MIT
 *
 * Slice k takes in gas of slice k - 1 and mixes. With the heat content H(T), whose slope is the capacity,
 *
 *     H(T_k) - H(T_k-1) = sum over the slice of film (T_node - T_k).
 *
 * Each slice depends on those before it, so all follow in one pass. Source: docs/methods.md section 28. */
#include "contact/contact.h"

#include "base/port.h"

#define SLICE_MAX   60u   /* Newton steps of one slice */
#define SLICE_FOUND 4e-16 /* relative change of a temperature that ends them */

enum { GAS, FILMS, SUMS }; /* rows of fibrad_stream.gas */

static double *row_of(const fibrad_stream *s, uint32_t row) { return s->gas + (size_t)row * s->slices; }

/* The capacity at a temperature, and the heat content above the first point. */
typedef struct stream_heat {
    double capacity, content;
} stream_heat;

static stream_heat heat_of_gas(const fibrad_stream *s, double t) {
    double content = 0, from = s->at[0], capacity = s->capacity[0];
    if (t <= from) return (stream_heat){capacity, capacity * (t - from)};
    for (uint32_t k = 1; k < s->points && from < t; k++) {
        const double to = fibrad_min(t, s->at[k]), slope = (s->capacity[k] - capacity) / (s->at[k] - from);
        const double next = to < s->at[k] ? capacity + slope * (to - from) : s->capacity[k];
        content += (to - from) * (capacity + next) / 2;
        from = to, capacity = next;
    }
    return (stream_heat){capacity, content + capacity * (t - from)};
}

/* The node of a film. */
static uint32_t node_of(const fibrad_contacts *c, uint32_t b) {
    return c->leader != NULL && c->leader[b] != UINT32_MAX ? c->leader[b] : b;
}

/* Gives films the gas of their slices. The film of a clump has the mean of those of its members. */
static void take_gas(fibrad_contacts *c, const double *gas) {
    for (uint32_t b = 0; b < c->nodes; b++)
        if (c->slice[b] != UINT32_MAX) c->own_gas[b] = gas[c->slice[b]];
    for (uint32_t b = 0; b < c->nodes && c->leader != NULL; b++)
        if (c->slice[b] != UINT32_MAX) c->gas[node_of(c, b)] = 0;
    for (uint32_t b = 0; b < c->nodes && c->leader != NULL; b++)
        if (c->slice[b] != UINT32_MAX) c->gas[node_of(c, b)] += c->own_film[b] / c->film[node_of(c, b)] * c->own_gas[b];
}

/* Adds up film times value of nodes by slice. */
static void sum_films(const fibrad_contacts *c, const double *value, double *sum) {
    fibrad_zero(sum, c->stream->slices * sizeof *sum);
    for (uint32_t b = 0; b < c->nodes; b++)
        if (c->slice[b] != UINT32_MAX)
            sum[c->slice[b]] += value != NULL ? c->own_film[b] * value[node_of(c, b)] : c->own_film[b];
}

void fibrad_stream_find(fibrad_contacts *c) {
    const fibrad_stream *s = c->stream;
    double *gas = row_of(s, GAS), *films = row_of(s, FILMS), *sums = row_of(s, SUMS), t = s->inlet;
    sum_films(c, NULL, films);
    sum_films(c, c->temperature, sums);
    for (uint32_t k = 0; k < s->slices; k++) {
        const double enters = heat_of_gas(s, t).content + sums[k];
        for (uint32_t step = 0; step < SLICE_MAX; step++) {
            const stream_heat now = heat_of_gas(s, t);
            const double change = (enters - now.content - films[k] * t) / (now.capacity + films[k]);
            t += change;
            if (fibrad_abs(change) <= SLICE_FOUND * fibrad_abs(t)) break;
        }
        gas[k] = t;
    }
    take_gas(c, gas);
}

void fibrad_stream_respond(const fibrad_contacts *c, const double *x, double *product) {
    const fibrad_stream *s = c->stream;
    const double *gas = row_of(s, GAS), *films = row_of(s, FILMS);
    double *change = row_of(s, SUMS), enters = 0;
    sum_films(c, x, change);
    for (uint32_t k = 0; k < s->slices; k++) {
        const double capacity = heat_of_gas(s, gas[k]).capacity;
        change[k] = (enters + change[k]) / (capacity + films[k]);
        enters = capacity * change[k];
    }
    for (uint32_t b = 0; b < c->nodes; b++)
        if (c->slice[b] != UINT32_MAX) product[node_of(c, b)] -= c->own_film[b] * change[c->slice[b]];
}
