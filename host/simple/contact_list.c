/* contact_list.c - contacts that have been found, the spots at which they touch, and what they conduct.
 * SPDX-License-Identifier: MIT */
#include "simple/contact_list.h"

#include <math.h>
#include <stdlib.h>

int fibrad_contact_add(struct contact_block *block, const struct contact_found *contact) {
    if (block->n == block->capacity) {
        if (block->capacity > UINT32_MAX / 2) return FIBRAD_E_UNSUPPORTED;
        const uint32_t capacity = block->capacity ? 2 * block->capacity : 1024;
        struct contact_found *larger = realloc(block->contact, capacity * sizeof *larger);
        if (!larger) return FIBRAD_E_MEMORY;
        block->contact = larger, block->capacity = capacity;
    }
    block->contact[block->n++] = *contact;
    return FIBRAD_OK;
}

/* The radius of the spot. 0: the ends do not touch. */
static double spot_of(const struct contact_found *c, const fibrad_contact_rule *rule) {
    const double scale = rule->scale > 0 ? rule->scale : 1, r = c->radius, d = c->distance;
    /* of the first centre from the plane in which both surfaces cut each other */
    const double plane = isinf(c->other) ? d : (d * d + r * r - c->other * c->other) / (2 * d);
    const double overlap = (isinf(c->other) ? r : r + c->other) - d;
    if (rule->spots == FIBRAD_SPOTS_NONE || !(overlap > 0)) return 0;
    const double mean = isinf(c->other) ? r : r * c->other / (r + c->other);
    const double square = rule->spots == FIBRAD_SPOTS_LENS ? r * r - plane * plane : mean * overlap;
    return square > 0 ? scale * sqrt(square) : 0;
}

int fibrad_contact_list_of(struct contact_block *block, const fibrad_contact_rule *rule, int status,
                           fibrad_contact_list **list) {
    const uint32_t n = block->n;
    fibrad_contact_list *made = NULL;
    if (!status) made = malloc(sizeof *made + n * (4 * sizeof(double) + 2 * sizeof(uint32_t)));
    if (!status && !made) status = FIBRAD_E_MEMORY;
    if (!status) {
        double *number = (double *)(void *)(made + 1);
        uint32_t *end = (uint32_t *)(void *)(number + 4 * (size_t)n);
        *made =
            (fibrad_contact_list){n, end, end + n, number, number + n, number + 2 * (size_t)n, number + 3 * (size_t)n};
        for (uint32_t k = 0; k < n; ++k) {
            const struct contact_found *c = &block->contact[k];
            end[k] = c->first, end[n + k] = c->second;
            number[k] = c->distance, number[n + k] = c->radius, number[2 * (size_t)n + k] = c->other;
            number[3 * (size_t)n + k] = spot_of(c, rule);
        }
        *list = made;
    }
    free(block->contact);
    return status;
}

/* A pair with gas between its surfaces. The radius of `small` is at most that of `large`, which may be infinite. */
struct gas_pair {
    double distance, small, large;
    double k_small, k_large, k_gas; /* conductivities; infinite: no resistance */
    double jump, least;
};

/* What a ring of lines conducts for each length du by which its gap u is wider than that of the ring within. Let l_i
 * and l_j be the lengths of a line within the spheres, and c = l_i + l_j = distance - u. Then l_i - l_j = (R_i^2 -
 * R_j^2)/c, and 2 pi r dr = 2 pi l_i l_j/c du. */
static inline double ring_of(const struct gas_pair *p, double u) {
    const double c = p->distance - u, gap = larger_of(u + p->jump, p->least);
    const double less = p->small * p->small - p->large * p->large;
    const double l_small = (c + less / c) / 2, l_large = (c - less / c) / 2;
    return 2 * M_PI * l_small * l_large / c / (l_small / p->k_small + l_large / p->k_large + gap / p->k_gas);
}

/* The same between a sphere and a wall. */
static inline double ring_at_wall(const struct gas_pair *p, double u) {
    const double c = p->distance - u, gap = larger_of(u + p->jump, p->least);
    return 2 * M_PI * c / (c / p->k_small + gap / p->k_gas);
}

/* The integral of ring_of over a stretch of gaps, by Gauss's rule of eight points. */
static double stretch_of(const struct gas_pair *p, double from, double to) {
    static const double x[8] = {-.18343464249564980494, .18343464249564980494,  -.52553240991632898582,
                                .52553240991632898582,  -.79666647741362673959, .79666647741362673959,
                                -.96028985649753623168, .96028985649753623168},
                        w[4] = {.36268378337836198297, .31370664587788728734, .22238103445337447054,
                                .10122853629037625915};
    const double middle = (from + to) / 2, half = (to - from) / 2;
    double sum = 0, ring[8];
    if (isinf(p->large))
        for (int k = 0; k < 8; ++k) ring[k] = ring_at_wall(p, middle + half * x[k]);
    else
        for (int k = 0; k < 8; ++k) ring[k] = ring_of(p, middle + half * x[k]);
    for (int k = 0; k < 4; ++k) sum += w[k] * (ring[2 * k] + ring[2 * k + 1]);
    return half * sum;
}

/* The widest gap of a line that conducts. The gas about the small sphere ends at the distance `lens` from its centre.
 * The last line ends where the large surface leaves this gas, or where it touches the small sphere. */
static double widest_gap(const struct gas_pair *p, double lens) {
    const double d = p->distance, r = p->small;
    const double plane = isinf(p->large) ? d : (d * d + lens * lens - p->large * p->large) / (2 * d);
    const double square = smaller_of(lens * lens - plane * plane, r * r);
    if (!(square > 0)) return 0;
    const double beyond = isinf(p->large) ? 0 : sqrt(p->large * p->large - square);
    return d - sqrt(r * r - square) - beyond;
}

/* What the gas conducts. The denominator is least at narrow gaps, so stretches are as long as gaps are wide. */
static double gas_conductance(const struct gas_pair *p, double reach) {
    const double narrow = larger_of(0, p->distance - p->small - (isinf(p->large) ? 0 : p->large));
    const double wide = widest_gap(p, p->small * (1 + reach)), level = larger_of(0, p->least - p->jump);
    double sum = 0, from = narrow;
    while (from < wide) {
        double to = 2 * from + larger_of(p->jump, p->least);
        if (from < level && to > level) to = level;
        if (to > wide) to = wide;
        sum += stretch_of(p, from, to);
        from = to;
    }
    return sum;
}

#define LEAST_GAP 1e-7 /* of the smaller radius, if rule->gas_least is 0 */

/* The gas of contact k. */
static struct gas_pair gas_of(const fibrad_contact_list *list, const fibrad_contact_rule *rule, const double *solid,
                              const double *gas, uint32_t k) {
    const bool swap = list->other[k] < list->radius[k], wall = isinf(list->other[k]);
    const double first = rule->gas_alone ? INFINITY : solid[list->first[k]],
                 second = rule->gas_alone || wall ? INFINITY : solid[list->second[k]];
    const double small = swap ? list->other[k] : list->radius[k];
    return (struct gas_pair){list->distance[k],
                             small,
                             swap ? list->radius[k] : list->other[k],
                             swap ? second : first,
                             swap ? first : second,
                             gas[k],
                             rule->gas_jump,
                             rule->gas_least > 0 ? rule->gas_least : LEAST_GAP * small};
}

/* What the spot of contact k conducts. */
static double spot_conductance(const fibrad_contact_list *list, const fibrad_contact_rule *rule, const double *solid,
                               uint32_t k) {
    const double first = solid[list->first[k]];
    if (isinf(list->other[k]) && rule->wall == 0) return 4 * first * list->spot[k];
    return 4 * list->spot[k] / (1 / first + 1 / (isinf(list->other[k]) ? rule->wall : solid[list->second[k]]));
}

int fibrad_contacts_conduct(const fibrad_contact_list *list, const fibrad_contact_rule *rule, const double *solid,
                            const double *gas, double *conductance) {
    if (!list || !rule || !(rule->wall >= 0) || (list->n > 0 && (!solid || !conductance))) return FIBRAD_E_ARGUMENT;
    for (uint32_t k = 0; k < list->n; ++k) {
        const double first = solid[list->first[k]], second = isinf(list->other[k]) ? 1 : solid[list->second[k]];
        if (!(first > 0 && second > 0) || (gas && !(gas[k] >= 0))) return FIBRAD_E_ARGUMENT;
        conductance[k] = list->spot[k] > 0 ? spot_conductance(list, rule, solid, k) : 0;
        if (!gas || !(rule->gas_reach > 0) || gas[k] == 0) continue;
        const struct gas_pair pair = gas_of(list, rule, solid, gas, k);
        conductance[k] += gas_conductance(&pair, rule->gas_reach);
    }
    return FIBRAD_OK;
}
