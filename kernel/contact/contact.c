/* contact.c - heat conducted between nodes: flows, and temperatures that follow from supplies.
 * SPDX-License-Identifier: MIT */
#include "contact/contact.h"

#include "base/port.h"

#define WARM_TOLERANCE 1e-7   /* of a linear system, relative */
#define WARM_MAX       20000u /* steps of its search */
#define NEWTON_MAX     60u
#define HALVINGS_MAX   40u
#define LEAST          1e-2 /* contacts->least over the highest temperature */
#define ROUNDED        1e-9 /* changes of T below this, relative, may be rounding errors */

double fibrad_contact_emission(const fibrad_contacts *c, double t) {
    const double square = t * t, zero = c->zero;
    if (t < 0) return -c->sigma * (square * square + (zero * zero) * (zero * zero));
    return c->sigma * (square + zero * zero) * (t + zero) * (t - zero);
}

double fibrad_contact_temperature(const fibrad_contacts *c, double emission) {
    const double zero = c->zero, power = emission / c->sigma + (zero * zero) * (zero * zero);
    const double t = fibrad_sqrt(fibrad_sqrt(fibrad_abs(power)));
    return power < 0 ? -t : t;
}

void fibrad_contact_mark(fibrad_contacts *c) {
    fibrad_zero(c->kind, c->nodes);
    for (uint32_t k = 0; k < c->count; k++)
        if (c->conductance[k] > 0 && c->node[c->first[k]] != c->node[c->second[k]])
            c->kind[c->node[c->first[k]]] = c->kind[c->node[c->second[k]]] = FIBRAD_CONTACT_GIVEN;
}

/* Ways to the roots are halved, so that they stay short. */
uint32_t fibrad_contact_root(fibrad_contact_parts *p, uint32_t node) {
    while (p->root[node] != node) node = p->root[node] = p->root[p->root[node]];
    return node;
}

void fibrad_contact_join(fibrad_contact_parts *p, uint32_t a, uint32_t b) {
    p->root[fibrad_contact_root(p, a)] = fibrad_contact_root(p, b);
}

/* The two nodes of contact k. */
typedef struct contact_ends {
    uint32_t i, j;
} contact_ends;

static contact_ends nodes_of(const fibrad_contacts *c, uint32_t k) {
    return (contact_ends){c->node[c->first[k]], c->node[c->second[k]]};
}

void fibrad_contact_gains(const fibrad_contacts *c, const double *temperature, double *to) {
    for (uint32_t k = 0; k < c->count; k++) {
        const contact_ends e = nodes_of(c, k);
        if (!(c->conductance[k] > 0)) continue;
        const double flow = c->conductance[k] * (temperature[e.j] - temperature[e.i]);
        to[e.i] += flow, to[e.j] -= flow;
    }
    for (uint32_t b = 0; b < c->nodes; b++)
        if (c->film[b] > 0) to[b] += c->film[b] * (c->gas[b] - temperature[b]);
}

/* The exchange area between emissions of a conductance. Near 0 K it would have no bound. */
static double exchange_area(const fibrad_contacts *c, double conductance, double of_i, double of_j) {
    const double a = fibrad_max(fibrad_abs(of_i), c->least), b = fibrad_max(fibrad_abs(of_j), c->least);
    return conductance / (c->sigma * (a * a + b * b) * (a + b));
}

/* What a contact conducts per difference of the unknowns: emissions, or temperatures. */
static double weight_of(const fibrad_contacts *c, bool kelvins, uint32_t k, contact_ends e) {
    return kelvins ? c->conductance[k] : exchange_area(c, c->conductance[k], c->temperature[e.i], c->temperature[e.j]);
}

/* The same of the film of a node. */
static double film_weight(const fibrad_contacts *c, bool kelvins, uint32_t node) {
    const double film = c->film[node];
    return kelvins || film == 0 ? film : exchange_area(c, film, c->temperature[node], c->gas[node]);
}

static double if_free(const fibrad_contacts *c, const double *value, uint32_t node) {
    return c->kind[node] == FIBRAD_CONTACT_FREE ? value[node] : 0;
}

double fibrad_contact_product(const fibrad_contacts *c, const double *a, const double *b) {
    double sum = 0;
    for (uint32_t k = 0; k < c->count; k++) {
        const contact_ends e = nodes_of(c, k);
        const double of_a = if_free(c, a, e.j) - if_free(c, a, e.i), of_b = if_free(c, b, e.j) - if_free(c, b, e.i);
        if (of_a != 0 && of_b != 0) sum += weight_of(c, false, k, e) * of_a * of_b;
    }
    for (uint32_t node = 0; node < c->nodes; node++)
        if (c->film[node] > 0) sum += film_weight(c, false, node) * if_free(c, a, node) * if_free(c, b, node);
    return sum;
}

/* What a free node gives off by radiation and storage per unit of its unknown. */
static double own_weight(const fibrad_contacts *c, bool kelvins, uint32_t node) {
    const double t = fibrad_max(fibrad_abs(c->temperature[node]), c->least);
    return kelvins ? 4 * c->sigma * t * t * t * c->stiff[node] : c->stiff[node];
}

/* contacts->product = the matrix of the network times x on free nodes. x is 0 on all others. */
static void multiply_contacts(fibrad_contacts *c, bool kelvins, const double *x) {
    for (uint32_t b = 0; b < c->nodes; b++)
        c->product[b] =
            c->kind[b] == FIBRAD_CONTACT_FREE ? (own_weight(c, kelvins, b) + film_weight(c, kelvins, b)) * x[b] : 0;
    for (uint32_t k = 0; k < c->count; k++) {
        const contact_ends e = nodes_of(c, k);
        if (!(c->conductance[k] > 0)) continue;
        const double flow = weight_of(c, kelvins, k, e) * (x[e.i] - x[e.j]);
        c->product[e.i] += flow, c->product[e.j] -= flow;
    }
}

static void find_diagonal(fibrad_contacts *c, bool kelvins) {
    for (uint32_t b = 0; b < c->nodes; b++) c->diagonal[b] = own_weight(c, kelvins, b) + film_weight(c, kelvins, b);
    for (uint32_t k = 0; k < c->count; k++) {
        const contact_ends e = nodes_of(c, k);
        const double weight = e.i != e.j ? weight_of(c, kelvins, k, e) : 0;
        c->diagonal[e.i] += weight, c->diagonal[e.j] += weight;
    }
}

/* One step of conjugate gradients along contacts->search. slope: the product of residual and preconditioned residual.
 * Returns this product after the step. Overwrites contacts->load by the residual. */
static double step_network(fibrad_contacts *c, bool kelvins, double slope) {
    double curvature = 0, next = 0;
    multiply_contacts(c, kelvins, c->search);
    for (uint32_t b = 0; b < c->nodes; b++) curvature += c->search[b] * if_free(c, c->product, b);
    if (!(curvature > 0)) return 0;
    const double length = slope / curvature;
    for (uint32_t b = 0; b < c->nodes; b++) {
        if (c->kind[b] != FIBRAD_CONTACT_FREE) continue;
        c->warming[b] += length * c->search[b];
        c->load[b] -= length * c->product[b];
        next += c->load[b] * c->load[b] / c->diagonal[b];
    }
    for (uint32_t b = 0; b < c->nodes; b++)
        if (c->kind[b] == FIBRAD_CONTACT_FREE) c->search[b] = c->load[b] / c->diagonal[b] + next / slope * c->search[b];
    return next;
}

/* Solves the linear system of the network for contacts->warming. */
static void solve_network(fibrad_contacts *c, bool kelvins) {
    double slope = 0;
    find_diagonal(c, kelvins);
    for (uint32_t b = 0; b < c->nodes; b++) {
        c->warming[b] = c->search[b] = 0;
        if (c->kind[b] != FIBRAD_CONTACT_FREE) continue;
        c->search[b] = c->load[b] / c->diagonal[b];
        slope += c->load[b] * c->search[b];
    }
    const double enough = WARM_TOLERANCE * WARM_TOLERANCE * slope;
    for (uint32_t k = 0; k < WARM_MAX && slope > enough; k++) slope = step_network(c, kelvins, slope);
}

static double product_on_free(const fibrad_contacts *c, const double *a, const double *b) {
    double sum = 0;
    for (uint32_t k = 0; k < c->nodes; k++)
        if (c->kind[k] == FIBRAD_CONTACT_FREE) sum += a[k] * b[k];
    return sum;
}

/* contacts->product = the matrix of the network with gas that follows, times x, over the diagonal. */
static void multiply_streaming(fibrad_contacts *c, const double *x) {
    multiply_contacts(c, true, x);
    fibrad_stream_respond(c, x, c->product);
    for (uint32_t b = 0; b < c->nodes; b++)
        if (c->kind[b] == FIBRAD_CONTACT_FREE) c->product[b] /= c->diagonal[b];
}

/* Solves the linear system of the network with gas that follows for contacts->warming, by stabilised biconjugate
 * gradients: H. A. van der Vorst, SIAM J. Sci. Stat. Comput. 13 (1992) 631. Overwrites contacts->load. */
static void solve_streaming(fibrad_contacts *c) {
    double *r = c->load, *p = c->search, *v = c->sent, last = 1, length = 1, share = 1;
    find_diagonal(c, true);
    for (uint32_t b = 0; b < c->nodes; b++) {
        c->warming[b] = p[b] = v[b] = 0;
        r[b] = c->shadow[b] = c->kind[b] == FIBRAD_CONTACT_FREE ? r[b] / c->diagonal[b] : 0;
    }
    const double enough = WARM_TOLERANCE * WARM_TOLERANCE * product_on_free(c, r, r);
    for (uint32_t k = 0; k < WARM_MAX && product_on_free(c, r, r) > enough; k++) {
        const double now = product_on_free(c, c->shadow, r), keep = now / last * (length / share);
        for (uint32_t b = 0; b < c->nodes; b++)
            p[b] = c->kind[b] == FIBRAD_CONTACT_FREE ? r[b] + keep * (p[b] - share * v[b]) : 0;
        multiply_streaming(c, p);
        fibrad_copy(v, c->product, c->nodes * sizeof *v);
        length = now / product_on_free(c, c->shadow, v), last = now;
        if (!(fibrad_abs(length) > 0 && length == length)) return;
        for (uint32_t b = 0; b < c->nodes; b++) r[b] = c->kind[b] == FIBRAD_CONTACT_FREE ? r[b] - length * v[b] : 0;
        multiply_streaming(c, r);
        const double square = product_on_free(c, c->product, c->product);
        share = square > 0 ? product_on_free(c, c->product, r) / square : 0;
        for (uint32_t b = 0; b < c->nodes; b++) {
            if (c->kind[b] != FIBRAD_CONTACT_FREE) continue;
            c->warming[b] += length * p[b] + share * r[b];
            r[b] -= share * c->product[b];
        }
        if (!(share > 0 || share < 0)) return;
    }
}

/* contacts->load = what is missing in the balance of each free node at contacts->temperature. */
static void find_missing(fibrad_contacts *c) {
    if (c->streaming) fibrad_stream_find(c);
    fibrad_zero(c->load, c->nodes * sizeof *c->load);
    fibrad_contact_gains(c, c->temperature, c->load);
    for (uint32_t b = 0; b < c->nodes; b++)
        if (c->kind[b] == FIBRAD_CONTACT_FREE)
            c->load[b] += c->supply[b] - c->stiff[b] * fibrad_contact_emission(c, c->temperature[b]);
}

/* The largest of the magnitudes of values on free nodes, or on all nodes that have contacts. */
static double largest_on(const fibrad_contacts *c, fibrad_contact_kind least, const double *value) {
    double largest = 0;
    for (uint32_t b = 0; b < c->nodes; b++)
        if (c->kind[b] >= least && c->kind[b] <= FIBRAD_CONTACT_FREE)
            largest = fibrad_max(largest, fibrad_abs(value[b]));
    return largest;
}

/* Sets the temperature below which slopes do not grow. */
static void find_least(fibrad_contacts *c) {
    const double highest = largest_on(c, FIBRAD_CONTACT_GIVEN, c->temperature);
    c->least = highest > 0 ? LEAST * highest : 1;
}

void fibrad_contact_warm(fibrad_contacts *c) {
    find_least(c);
    solve_network(c, false);
}

/* Shortens steps towards higher temperatures, where emission grows faster than its slope tells: by as much as is right
 * for a node that gains or loses heat by radiation alone. */
static void shorten_steps(fibrad_contacts *c) {
    for (uint32_t b = 0; b < c->nodes; b++) {
        const double t = fibrad_max(c->temperature[b], c->least), step = c->warming[b];
        if (c->kind[b] != FIBRAD_CONTACT_FREE || !(step > 0)) continue;
        const double eased = t * (fibrad_sqrt(fibrad_sqrt(1 + 4 * step / t)) - 1);
        c->warming[b] += own_weight(c, true, b) / c->diagonal[b] * (eased - step);
    }
}

/* Moves the temperatures by the step in contacts->warming, or by a part of it. The balances are the gradient of a
 * convex function. A step is too long if it ends where this function rises as steeply as it fell at the beginning.
 * missing: the product of the first balances and the step. */
static void move_temperatures(fibrad_contacts *c, double missing) {
    double length = 1;
    for (uint32_t b = 0; b < c->nodes; b++)
        if (c->kind[b] == FIBRAD_CONTACT_FREE) c->temperature[b] += c->warming[b];
    for (uint32_t k = 0; k < HALVINGS_MAX; k++, length /= 2) {
        find_missing(c);
        if (!(product_on_free(c, c->load, c->warming) < -missing / 2)) return;
        for (uint32_t b = 0; b < c->nodes; b++)
            if (c->kind[b] == FIBRAD_CONTACT_FREE) c->temperature[b] -= length / 2 * c->warming[b];
    }
}

void fibrad_contact_find(fibrad_contacts *c, double tolerance) {
    double last = __builtin_inf();
    find_least(c);
    find_missing(c);
    for (uint32_t k = 0; k < NEWTON_MAX; k++) {
        fibrad_copy(c->gain, c->load, c->nodes * sizeof *c->load);
        if (c->streaming)
            solve_streaming(c);
        else
            solve_network(c, true);
        shorten_steps(c);
        move_temperatures(c, fibrad_max(0, product_on_free(c, c->gain, c->warming)));
        find_least(c);
        const double highest = largest_on(c, FIBRAD_CONTACT_GIVEN, c->temperature),
                     change = largest_on(c, FIBRAD_CONTACT_FREE, c->warming);
        if (change <= tolerance * highest || (change <= ROUNDED * highest && change > last / 2)) return;
        last = change;
    }
}
