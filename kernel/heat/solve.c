/* solve.c - finds radiosities by conjugate gradients, one sweep over all beams a step. SPDX-License-Identifier: MIT
 *
 * Let K be the exchange areas between patches, A = K 1 the areas of the patches and rho = 1 - eps. The radiosities J
 * solve
 *
 *     (A/rho - K) J = A eps/rho E.
 *
 * This system is symmetric and positive definite. A sweep forms the net flows N J = K J - A J beam by beam. Each beam
 * gives to one end what it takes from the other. So the net flows add up to zero whatever J is, and they are zero where
 * all J are equal. The residual times rho/A is eps (E - J) + rho N J/A. One Jacobi iteration would change J by this.
 * Patches with rho = 0 have J = E and are left out of the search.
 *
 * There are two levels. On the coarser level all patches of a group have the same J: the residuals of a group are
 * replaced by their mean. The finer level begins with the solution of the coarser one.
 *
 * Patches of a mesh may have emissions of their own. On the coarser level the J of such a patch differs from that of
 * its group by a constant: eps times the difference between the emissions of the patch and of the mesh. The system for
 * the rest of J is the same.
 *
 * Light from outside is part of the net flow of a patch. So is light that an insulated wall has absorbed. It never
 * changes.
 *
 * A body of unknown temperature gives off S - h E. Let q be its net power and <J> the mean of J over its surface. From
 * q = A eps/rho (<J> - E) = h E - S follows
 *
 *     E = (rho S + A eps <J>)/D,    D = rho h + A eps.
 *
 * This leaves a system of J alone, which is symmetric as before. Its residuals have two parts. Neither part divides by
 * eps or rho. One is their mean r = eps (S - h <J>)/D + q/A. It changes J by r/(1 + eps h/D). The other part is what
 * differs from the mean. It is treated as on other bodies. A black body has J = E everywhere.
 *
 * On a sphere that conducts the mean of J is treated as above. sphere_conduction.c treats the rest.
 *
 * Contacts. A body of unknown temperature in contact with others is *joined*: its E is an unknown beside its J, since E
 * follows from the neighbours as well. With the flows H of contacts
 *
 *     (A/rho - K) J - A eps/rho E = 0,    S - h E + A eps/rho (<J> - E) + sum of H (T_other - T) = 0.
 *
 * Let b be what is missing in the balance of a body with the radiation that now arrives, S - h E + eps (A <J> + N J - A
 * E) + sum of H (T_other - T). The preconditioner changes E by x: to the emissions that balance this radiation
 * (contact/contact.h). Then it changes J as on a body of the given emission E + x. No part divides by eps or rho. T is
 * not linear in E. So the search is one of conjugate gradients with exchange areas g of contacts that change from step
 * to step, and each direction is made conjugate to the last one with the present g.
 *
 * The members of a clump are joined: they have one node, that of their leader. It has the sum of their balances, and
 * their emissions follow it.
 *
 * A stream of gas makes the system one that is not symmetric. During a search its temperatures are given. Where a
 * search would end they are found anew, with the radiation that now arrives, until they no longer change. */
#include "patches/pencils.h"
#include "heat/sweep.h"

/* A body of unknown temperature: its area, the means of J and of N J per area, and D. */
typedef struct free_body {
    double area, radiosity, net, divisor;
} free_body;

/* Whether the unknown emission of a body follows from its own radiosities. */
static bool follows_radiosity(const fibrad_heat *heat, uint32_t b) {
    return fibrad_heat_is_free(heat, b) && !fibrad_heat_is_joined(heat, b);
}

static free_body free_body_of(const fibrad_heat *heat, uint32_t b) {
    const double eps = heat->sources.emissivity[b], area = fibrad_heat_sum(heat, b, heat->solution.area);
    return (free_body){area, fibrad_heat_mean(heat, b, heat->solution.radiosity),
                       area > 0 ? fibrad_heat_sum(heat, b, heat->solution.net) / area : 0,
                       (1 - eps) * heat->sources.storage[b] + area * eps};
}

/* eps (S - h E)/D: the mean residual of a body of unknown temperature if <J> and all that it receives are E. */
static double mean_residual_at(const fibrad_heat *heat, uint32_t b, const free_body *body, double emission) {
    return heat->sources.emissivity[b] * (heat->sources.given_power[b] - heat->sources.storage[b] * emission) /
           body->divisor;
}

/* 1 + eps h/D */
static double stiffness(const fibrad_heat *heat, uint32_t b, const free_body *body) {
    return 1 + heat->sources.emissivity[b] * heat->sources.storage[b] / body->divisor;
}

/* The end of the group of patches that begins at a, at most `end`. */
static uint32_t end_of_group(uint32_t a, uint32_t end, uint32_t group) { return end - a > group ? a + group : end; }

static uint32_t group_end(const fibrad_heat *heat, uint32_t a, uint32_t end) {
    return end_of_group(a, end, heat->solution.group);
}

/* Sends the mean residual of each group of patches of a body, plus `shift`. On entry heat->solution.source has
 * residuals times areas. Returns `slope` plus the product of residuals and changes. */
static double send_groups(fibrad_heat *heat, uint32_t b, double shift, double slope) {
    const double rho = 1 - heat->sources.emissivity[b];
    for (uint32_t a = heat->first[b], next; a < heat->first[b + 1]; a = next) {
        double sum = 0, area = 0;
        next = group_end(heat, a, heat->first[b + 1]);
        for (uint32_t k = a; k < next; k++) sum += heat->solution.source[k], area += heat->solution.area[k];
        const double change = rho > 0 && area > 0 ? sum / area : 0;
        for (uint32_t k = a; k < next; k++) heat->solution.source[k] = shift + change;
        if (rho > 0) slope += area * change * change / rho;
    }
    return slope;
}

/* Sends what one Jacobi iteration would change on a body of given temperature. Returns the product of the residual and
 * this change. */
static double given_residual(fibrad_heat *heat, uint32_t b) {
    const double eps = heat->sources.emissivity[b], *excess = fibrad_heat_excess(heat, b);
    const uint32_t begin = heat->first[b];
    for (uint32_t a = begin; a < heat->first[b + 1]; a++) {
        const double emission =
            excess != NULL ? heat->sources.emission[b] + excess[a - begin] : heat->sources.emission[b];
        heat->solution.source[a] =
            heat->solution.area[a] * eps * (emission - heat->solution.radiosity[a]) + (1 - eps) * heat->solution.net[a];
    }
    return send_groups(heat, b, 0, 0);
}

/* The mean residual of a body of unknown temperature, and how much it changes the mean of J. Returns their product
 * times the area. */
static double mean_change(const fibrad_heat *heat, uint32_t b, const free_body *body, double *shift) {
    const double mean = mean_residual_at(heat, b, body, body->radiosity) + body->net;
    *shift = mean / stiffness(heat, b, body);
    return body->area * mean * *shift;
}

/* What given_residual does, for a body of unknown temperature. */
static double free_residual(fibrad_heat *heat, uint32_t b) {
    const double eps = heat->sources.emissivity[b], rho = 1 - eps;
    const free_body body = free_body_of(heat, b);
    double shift;
    if (!(body.area > 0)) return 0;
    const double slope = mean_change(heat, b, &body, &shift);
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++)
        heat->solution.source[a] =
            heat->solution.area[a] * (eps * (body.radiosity - heat->solution.radiosity[a]) - rho * body.net) +
            rho * heat->solution.net[a];
    return send_groups(heat, b, shift, slope);
}

/* Whether a sphere that conducts reflects next to nothing. The mean of its J is then set to its emission. In a search
 * for this mean rounding errors of J would count 1/rho times. */
#define NEXT_TO_NOTHING 1e-9
static bool has_black_mean(const fibrad_heat *heat, uint32_t b) {
    return !follows_radiosity(heat, b) && 1 - heat->sources.emissivity[b] < NEXT_TO_NOTHING;
}

/* What given_residual does, for a sphere that conducts. */
static double conducting_residual(fibrad_heat *heat, uint32_t b) {
    const double eps = heat->sources.emissivity[b];
    const free_body body = free_body_of(heat, b);
    double shift = 0, slope = 0;
    if (!(body.area > 0)) return 0;
    if (follows_radiosity(heat, b)) {
        slope = mean_change(heat, b, &body, &shift);
    } else if (!has_black_mean(heat, b)) {
        shift = eps * (heat->sources.emission[b] - body.radiosity) + (1 - eps) * body.net;
        slope = body.area * shift * shift / (1 - eps);
    }
    return slope + fibrad_heat_pattern_residual(heat, b, shift);
}

/* The same for a joined body, whose change of emission has been found. */
static double joined_residual(fibrad_heat *heat, uint32_t b) {
    const double warming = heat->contacts.warming[b], more = heat->sources.emissivity[b] * warming;
    const double slope = fibrad_heat_conducts(heat, b) ? conducting_residual(heat, b) : given_residual(heat, b);
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++)
        heat->solution.source[a] = heat->solution.source[a] + more;
    return slope + heat->contacts.missing[b] * warming;
}

/* The power that a body would absorb of what arrives. */
static double absorbable(const fibrad_heat *heat, uint32_t b) {
    const free_body body = free_body_of(heat, b);
    return heat->sources.emissivity[b] * body.area * (body.radiosity + body.net);
}

/* What a joined body gives off per unit of its emission. */
static double stiffness_of_joined(const fibrad_heat *heat, uint32_t b) {
    return heat->sources.storage[b] + heat->sources.emissivity[b] * fibrad_heat_sum(heat, b, heat->solution.area);
}

/* A clump has the balance of all its members. */
static void sum_balances(fibrad_heat *heat) {
    fibrad_heat_sum_clumps(heat, heat->contacts.stiff);
    fibrad_heat_sum_clumps(heat, heat->contacts.supply);
}

/* The tolerance of temperatures that balance the radiation of one step: a Newton step that changes none by more is the
 * last one. */
#define BALANCED_ROUGHLY 1e-3

/* Sets up the balances of joined bodies with the radiation that now arrives. */
static void set_arriving(fibrad_heat *heat) {
    fibrad_contacts *c = &heat->contacts;
    fibrad_zero(c->supply, heat->bodies * sizeof *c->supply);
    fibrad_heat_add_offsets(heat, c->supply);
    for (uint32_t b = 0; b < heat->bodies; b++) {
        c->temperature[b] = fibrad_contact_temperature(c, heat->sources.emission[b]);
        if (!fibrad_heat_is_joined(heat, b)) continue;
        c->stiff[b] = stiffness_of_joined(heat, b);
        c->supply[b] += heat->sources.given_power[b] + absorbable(heat, b);
    }
    sum_balances(heat);
}

/* Finds the changes of the emissions of joined bodies: to those that balance the radiation which now arrives.
 * contacts.missing keeps what is missing in their balances. */
static void warm_joined(fibrad_heat *heat) {
    fibrad_contacts *c = &heat->contacts;
    if (!c->joins) return;
    set_arriving(heat);
    for (uint32_t b = 0; b < heat->bodies; b++)
        c->missing[b] = fibrad_heat_is_joined(heat, b) ? c->supply[b] - c->stiff[b] * heat->sources.emission[b] : 0;
    fibrad_contact_gains(c, c->temperature, c->missing);
    fibrad_contact_find(c, BALANCED_ROUGHLY);
    fibrad_heat_follow_leaders(heat, c->temperature);
    for (uint32_t b = 0; b < heat->bodies; b++)
        c->warming[b] = fibrad_heat_is_joined(heat, b)
                            ? fibrad_contact_emission(c, c->temperature[b]) - heat->sources.emission[b]
                            : 0;
}

/* Sends the changes of all patches. Returns the product of residuals and changes. */
static double find_residual(fibrad_heat *heat) {
    double slope = 0;
    warm_joined(heat);
    for (uint32_t b = 0; b < heat->bodies; b++)
        slope += fibrad_heat_is_joined(heat, b)     ? joined_residual(heat, b)
                 : fibrad_heat_conducts(heat, b)    ? conducting_residual(heat, b)
                 : fibrad_heat_is_free(heat, b)     ? free_residual(heat, b)
                 : fibrad_heat_finds_sides(heat, b) ? fibrad_heat_sides_residual(heat, b)
                                                    : given_residual(heat, b);
    return fibrad_max(0, slope); /* of joined bodies it may be below 0 by rounding */
}

/* Finds the emissions of the bodies of unknown temperature. */
static void find_emissions(fibrad_heat *heat) {
    for (uint32_t b = 0; b < heat->bodies; b++) {
        if (!follows_radiosity(heat, b)) continue;
        const free_body body = free_body_of(heat, b);
        const double eps = heat->sources.emissivity[b];
        if (body.area > 0)
            heat->sources.emission[b] =
                ((1 - eps) * heat->sources.given_power[b] + body.area * eps * body.radiosity) / body.divisor;
    }
}

/* Emissivity times area of a body. 0: the sources give its power. */
static double emitting(const fibrad_heat *heat, uint32_t body) {
    return heat->sources.storage[body] != 0
               ? heat->sources.emissivity[body] * fibrad_heat_sum(heat, body, heat->solution.area)
               : 0;
}

/* Finds the net powers of the bodies. The power of a body that reflects all is 0, and the power of some bodies is
 * given. Their net flows differ from that by residuals. The differences are shared out among the other bodies, by
 * emissivity times area. */
static void find_powers(const fibrad_heat *heat, double *power) {
    double left = 0, weights = 0;
    for (uint32_t b = 0; b < heat->bodies; b++) {
        power[b] = fibrad_heat_sum(heat, b, heat->solution.net);
        if (fibrad_heat_is_joined(heat, b)) {
            const double gained = absorbable(heat, b) - heat->sources.emissivity[b] *
                                                            fibrad_heat_sum(heat, b, heat->solution.area) *
                                                            heat->sources.emission[b];
            left += power[b] - gained, power[b] = gained;
            continue;
        }
        if (heat->sources.emissivity[b] == 0) left += power[b], power[b] = 0;
        if (heat->sources.storage[b] == 0)
            left += power[b] + heat->sources.given_power[b], power[b] = -heat->sources.given_power[b];
    }
    for (uint32_t b = 0; b < heat->bodies && left != 0; b++) weights += emitting(heat, b);
    for (uint32_t b = 0; b < heat->bodies && weights > 0; b++) power[b] += left * (emitting(heat, b) / weights);
}

/* Relative rounding errors of a sum of squares: of emissions, and of radiosities. */
#define ROUNDING      1e-28
#define ROUNDING_OF_J 1e-29

/* Unevenness depends on temperatures. If temperatures of spheres that conduct are unknown, unevenness and temperatures
 * are found in turn. The first temperatures are found to the tolerance FIBRAD_HEAT_FIRST_TOLERANCE, later ones to
 * WITHIN times the last change of unevenness. A relative change of unevenness below SETTLED no longer matters. */
#define WITHIN  .03
#define SETTLED 1e-3

/* The sum over the patches of a mesh of emissivity times area times the square of the difference between the emissions
 * of patch and mesh. */
static double excess_squares(const fibrad_heat *heat, uint32_t b) {
    const double *excess = fibrad_heat_excess(heat, b);
    double sum = 0;
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1] && excess != NULL; a++)
        sum += heat->sources.emissivity[b] * heat->solution.area[a] * excess[a - heat->first[b]] *
               excess[a - heat->first[b]];
    return sum;
}

/* Light that arrives at a patch of body b: from outside, or what an insulated wall sends out again. */
static double light_on(const fibrad_heat *heat, uint32_t b, uint32_t patch) {
    const bool again = heat->sources.absorbed != NULL && fibrad_heat_is_insulated(heat, b);
    return (heat->sources.light != NULL ? heat->sources.light[patch] : 0) + (again ? heat->sources.absorbed[patch] : 0);
}

/* The sum over the patches of a body of the square of light per area times area and reflectivity. */
static double light_squares(const fibrad_heat *heat, uint32_t b) {
    double sum = 0;
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++)
        if (heat->solution.area[a] > 0)
            sum += (1 - heat->sources.emissivity[b]) * light_on(heat, b, a) * light_on(heat, b, a) /
                   heat->solution.area[a];
    return sum;
}

/* What drives joined bodies if all that radiates and all of them have one emission: powers, and given temperatures. */
static double scale_of_contacts(fibrad_heat *heat, double emission) {
    fibrad_contacts *c = &heat->contacts;
    double sum = 0;
    if (!c->joins) return 0;
    for (uint32_t b = 0; b < heat->bodies; b++) {
        const bool joined = fibrad_heat_is_joined(heat, b);
        c->temperature[b] = fibrad_contact_temperature(c, joined ? emission : heat->sources.emission[b]);
        c->stiff[b] = joined ? stiffness_of_joined(heat, b) : 0;
        c->missing[b] = joined ? heat->sources.given_power[b] - heat->sources.storage[b] * emission : 0;
    }
    fibrad_heat_add_places(heat, c->missing);
    fibrad_heat_sum_clumps(heat, c->stiff);
    fibrad_heat_sum_clumps(heat, c->missing);
    fibrad_contact_gains(c, c->temperature, c->missing);
    fibrad_copy(c->load, c->missing, heat->bodies * sizeof *c->load);
    fibrad_contact_warm(c);
    for (uint32_t b = 0; b < heat->bodies; b++)
        if (fibrad_heat_is_joined(heat, b)) sum += c->missing[b] * c->warming[b];
    return sum;
}

/* Finds the scale with which residuals are compared. It has three parts: how much emissions differ from their mean,
 * powers that are given off, and light from outside. The limit of rounding follows from the emissions themselves. */
static void find_scale(fibrad_heat *heat) {
    double weights = 0, sum = 0, largest = 0;
    for (uint32_t b = 0; b < heat->bodies; b++) {
        const double area = emitting(heat, b), emission = heat->sources.emission[b];
        weights += area, sum += area * emission, largest += area * emission * emission + excess_squares(heat, b);
    }
    heat->solution.scale = 0;
    const double mean = weights > 0 ? sum / weights : 0;
    for (uint32_t b = 0; b < heat->bodies; b++) {
        const double difference = heat->sources.emission[b] - mean;
        heat->solution.scale += light_squares(heat, b);
        const free_body body = follows_radiosity(heat, b) ? free_body_of(heat, b) : (free_body){0};
        if (body.area > 0) {
            const double residual = mean_residual_at(heat, b, &body, mean);
            heat->solution.scale += body.area * residual * residual / stiffness(heat, b, &body);
        } else if (!fibrad_heat_is_joined(heat, b)) {
            heat->solution.scale += emitting(heat, b) * difference * difference + excess_squares(heat, b);
        }
    }
    heat->solution.scale += scale_of_contacts(heat, mean);
    heat->solution.smallest = ROUNDING * fibrad_max(largest, heat->solution.scale);
}

/* Adds the light that spheres which conduct have absorbed to their net flows and to the scale. */
static void heat_by_light(fibrad_heat *heat) {
    for (uint32_t b = 0; b < heat->spheres && fibrad_heat_is_entered(heat); b++)
        if (fibrad_heat_conducts(heat, b)) heat->solution.scale += fibrad_heat_add_absorbed(heat, b);
}

/* Whether there are temperatures that lead to the given powers. This is so if a temperature or a `storage` is given.
 * Otherwise the powers and the light must add up to zero. Contacts and sides with powers need the level of
 * temperatures: then one must be given, unless nothing of unknown temperature radiates. */
#define BALANCED 1e-9
static bool solvable(fibrad_heat *heat) {
    double sum = 0, sizes = 0;
    const bool sides = heat->sources.sides && heat->solution.group == 1;
    bool held = (heat->contacts.joins && heat->contacts.anchored) || (sides && heat->sources.held), radiates = sides;
    for (uint32_t b = 0; b < heat->bodies; b++) {
        held = held || (emitting(heat, b) > 0 && !fibrad_heat_finds_sides(heat, b));
        radiates = radiates || (fibrad_heat_is_free(heat, b) && heat->sources.emissivity[b] > 0);
        if (heat->sources.storage[b] == 0)
            sum += heat->sources.given_power[b], sizes += fibrad_abs(heat->sources.given_power[b]);
        double light = 0;
        for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++) light += light_on(heat, b, a);
        sum += light, sizes += light;
    }
    heat->sources.free_level = !held;
    if (heat->contacts.joins || sides) return held || !radiates;
    return held || fibrad_abs(sum) <= BALANCED * sizes;
}

/* Shifts the radiosities of each black sphere that conducts, so that their mean is its emission. */
static void shift_black(fibrad_heat *heat) {
    for (uint32_t b = 0; b < heat->spheres && heat->sources.conducts; b++) {
        if (!fibrad_heat_conducts(heat, b) || !has_black_mean(heat, b)) continue;
        const double more = heat->sources.emission[b] - fibrad_heat_mean(heat, b, heat->solution.radiosity);
        for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++) heat->solution.radiosity[a] += more;
    }
}

/* Sets `back` of all patches, whose groups have one J. */
static void find_back(fibrad_heat *heat) {
    heat->solution.sends_back = false;
    for (uint32_t b = heat->spheres; b < heat->bodies; b++) {
        const bool all = fibrad_heat_reflects(heat, b);
        double *back = heat->solution.back - fibrad_heat_others(heat);
        heat->solution.sends_back = heat->solution.sends_back || (all && heat->first[b] < heat->first[b + 1]);
        for (uint32_t a = heat->first[b], next; a < heat->first[b + 1]; a = next) {
            double area = 0;
            next = group_end(heat, a, heat->first[b + 1]);
            for (uint32_t k = a; k < next; k++) area += heat->solution.area[k];
            for (uint32_t k = a; k < next; k++) back[k] = all && area > 0 ? 1 / area : 0;
        }
    }
}

/* Has the next sweep form the net flows of the radiosities. */
static void send_radiosities(fibrad_heat *heat) {
    shift_black(heat);
    find_back(heat);
    for (uint32_t a = 0; a < heat->patches; a++) heat->solution.source[a] = heat->solution.radiosity[a];
    heat->solution.phase = FIBRAD_HEAT_FIRST;
}

/* Has the next sweep form what tells the error. Patches of a four send their mean. */
static void send_means(fibrad_heat *heat) {
    for (uint32_t b = 0; b < heat->bodies; b++)
        for (uint32_t a = heat->first[b], next; a < heat->first[b + 1]; a = next) {
            double sum = 0;
            next = end_of_group(a, heat->first[b + 1], FIBRAD_HEAT_FOUR);
            for (uint32_t k = a; k < next; k++) sum += heat->solution.radiosity[k];
            for (uint32_t k = a; k < next; k++) heat->solution.source[k] = sum / (next - a);
        }
    heat->solution.phase = FIBRAD_HEAT_CHECK;
}

/* Finds the temperatures of joined bodies, and of the gas of a stream with them. */
static void find_streaming(fibrad_contacts *c, double tolerance) {
    c->streaming = c->stream != NULL;
    fibrad_contact_find(c, tolerance);
    c->streaming = false;
}

/* Finds the emissions of joined bodies with which a search begins: those that balance contacts, powers, and as much
 * radiation as if all that a body sees had its emission of now. */
static void guess_joined(fibrad_heat *heat) {
    fibrad_contacts *c = &heat->contacts;
    if (!c->joins || !c->afresh) return;
    for (uint32_t b = 0; b < heat->bodies; b++) {
        c->temperature[b] = fibrad_contact_temperature(c, heat->sources.emission[b]);
        c->stiff[b] = stiffness_of_joined(heat, b);
        c->supply[b] =
            heat->sources.given_power[b] + (c->stiff[b] - heat->sources.storage[b]) * heat->sources.emission[b];
    }
    fibrad_heat_add_places(heat, c->supply);
    sum_balances(heat);
    find_streaming(c, BALANCED_ROUGHLY);
    fibrad_heat_follow_leaders(heat, c->temperature);
    for (uint32_t b = 0; b < heat->bodies; b++) {
        if (!fibrad_heat_is_joined(heat, b)) continue;
        const double more = fibrad_contact_emission(c, c->temperature[b]) - heat->sources.emission[b];
        heat->sources.emission[b] += more;
        for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++)
            heat->solution.radiosity[a] += heat->sources.emissivity[b] * more;
    }
}

/* Has the first sweep of a search form the net flows. A search for temperatures of sides begins on the finer level. */
static void send_first(fibrad_heat *heat) {
    guess_joined(heat);
    if (heat->sources.sides) heat->solution.group = 1;
    for (uint32_t a = 0; a < heat->patches && heat->sources.sides; a++)
        heat->solution.radiosity[a] += heat->solution.detail[a];
    send_radiosities(heat);
}

void fibrad_heat_start(fibrad_heat *heat) {
    if (heat->solution.areas)
        send_first(heat);
    else {
        fibrad_heat_link_pencils(heat);
        fibrad_heat_link_rays(heat);
        heat->solution.phase = FIBRAD_HEAT_AREA;
    }
}

/* If the sources do not fix the level of emissions: shifts all, so that their mean is that of the surroundings. */
static void fix_level(fibrad_heat *heat) {
    double sum = 0, weights = 0;
    for (uint32_t b = 0; b < heat->bodies; b++) {
        const double area = heat->sources.emissivity[b] * fibrad_heat_sum(heat, b, heat->solution.area);
        sum += area * heat->sources.emission[b], weights += area;
    }
    const double mean = weights > 0 ? sum / weights : 0;
    for (uint32_t b = 0; b < heat->bodies; b++) heat->sources.emission[b] -= mean;
    for (uint32_t a = 0; a < heat->patches; a++) heat->solution.radiosity[a] -= mean;
}

#define FOUND 1e-15 /* the tolerance of temperatures at the end, relative */

/* An emission, extrapolated to patches without size. */
static double extrapolated_emission(const fibrad_heat *heat, uint32_t b) {
    return heat->sources.emission[b] +
           FIBRAD_HEAT_EXTRAPOLATION * (heat->sources.emission[b] - heat->solution.coarse_emission[b]);
}

/* Sets up the balances of joined bodies with the radiation that arrives, extrapolated. `more` arrives besides, by
 * emissivity times area. area: the sum of these. */
static void set_balances(fibrad_heat *heat, double more, double area) {
    fibrad_contacts *c = &heat->contacts;
    fibrad_zero(c->supply, heat->bodies * sizeof *c->supply);
    fibrad_heat_add_offsets(heat, c->supply);
    for (uint32_t b = 0; b < heat->bodies; b++) {
        const double emission = extrapolated_emission(heat, b), storage = heat->sources.storage[b];
        c->temperature[b] =
            fibrad_contact_temperature(c, fibrad_heat_is_free(heat, b) ? emission : heat->sources.emission[b]);
        if (!fibrad_heat_is_joined(heat, b)) continue;
        c->stiff[b] = stiffness_of_joined(heat, b);
        const double emits = c->stiff[b] - storage;
        c->supply[b] += heat->sources.given_power[b] + heat->solution.power[b] + emits * emission;
        if (more != 0) c->supply[b] += more * (emits / area);
    }
    c->more = more != 0 ? more / area : 0;
    sum_balances(heat);
}

/* What a joined body gains by radiation at the temperature that was found. */
static double radiated_by_joined(const fibrad_heat *heat, uint32_t b) {
    const fibrad_contacts *c = &heat->contacts;
    const double emits = stiffness_of_joined(heat, b) - heat->sources.storage[b];
    if (fibrad_heat_is_member(heat, b))
        return heat->solution.power[b] +
               emits * (extrapolated_emission(heat, b) + c->more - fibrad_contact_emission(c, c->temperature[b]));
    return c->supply[b] - c->gain[b] - heat->sources.given_power[b] -
           emits * fibrad_contact_emission(c, c->temperature[b]);
}

/* Finds the temperatures that balance powers, radiation and contacts to rounding. Returns how much less joined bodies
 * then gain by radiation. */
static double balance_joined(fibrad_heat *heat, double more, double area) {
    fibrad_contacts *c = &heat->contacts;
    double left = 0;
    set_balances(heat, more, area);
    find_streaming(c, FOUND);
    fibrad_heat_follow_leaders(heat, c->temperature);
    fibrad_zero(c->gain, heat->bodies * sizeof *c->gain);
    fibrad_heat_add_offsets(heat, c->gain);
    for (uint32_t b = 0; b < heat->bodies; b++)
        if (fibrad_heat_is_joined(heat, b)) left += heat->solution.power[b] - radiated_by_joined(heat, b);
    return left;
}

/* If no other body takes what is left, the level of the temperatures is not quite right: finds how much more joined
 * bodies must receive, so that all powers by radiation add up to 0. missed: what they add up to before that. In the
 * level the problem is nearly linear. */
#define LEVEL_STEPS 12
static void find_level(fibrad_heat *heat, double left, double missed, double area, double powers) {
    double more = left - missed, last = 0, before = left - missed;
    for (int step = 0; step < LEVEL_STEPS && fibrad_abs(before) > FOUND * powers; step++) {
        const double now = balance_joined(heat, more, area) - missed, slope = (now - before) / (more - last);
        if (!(slope < 0)) return;
        last = more, before = now, more -= now / slope;
    }
}

/* Finds the temperatures of joined bodies, and what contacts conduct. What joined bodies then gain less by radiation
 * goes to the others that emit, by emissivity times area. */
static void finish_contacts(fibrad_heat *heat) {
    fibrad_contacts *c = &heat->contacts;
    double weights = 0, joined = 0, powers = 0, missed = 0;
    const double left = balance_joined(heat, 0, 0);
    for (uint32_t b = 0; b < heat->bodies; b++) {
        if (!fibrad_heat_is_joined(heat, b)) weights += emitting(heat, b);
        if (fibrad_heat_is_joined(heat, b)) joined += stiffness_of_joined(heat, b) - heat->sources.storage[b];
        missed += heat->solution.power[b];
        powers += fibrad_abs(heat->solution.power[b]) + fibrad_abs(heat->sources.given_power[b]);
    }
    if (weights == 0 && joined > 0) find_level(heat, left, missed, joined, powers);
    for (uint32_t b = 0; b < heat->bodies; b++) {
        if (fibrad_heat_is_joined(heat, b)) {
            const double t = c->temperature[b];
            heat->solution.power[b] = radiated_by_joined(heat, b);
            heat->sources.temperature[b] = t >= 0 ? t : __builtin_nan("");
        } else if (weights > 0) {
            heat->solution.power[b] += left * (emitting(heat, b) / weights);
        }
    }
    fibrad_contacts own = *c;
    own.node = heat->end, own.film = heat->film, own.gas = heat->gas;
    fibrad_contact_gains(&own, c->temperature, c->gain);
}

/* Goes from the finer level to the coarser one, which begins with the means of fours, less the detail of an earlier
 * solution. `detail` keeps the radiosities of the finer level. */
static void coarsen_patches(fibrad_heat *heat) {
    double *fine = heat->solution.radiosity, *detail = heat->solution.detail, *own = heat->solution.source;
    for (uint32_t b = 0; b < heat->bodies; b++) {
        const double eps = heat->sources.emissivity[b], *excess = fibrad_heat_excess(heat, b);
        for (uint32_t a = heat->first[b], next; a < heat->first[b + 1]; a = next) {
            double sum = 0;
            next = end_of_group(a, heat->first[b + 1], FIBRAD_HEAT_FOUR);
            for (uint32_t k = a; k < next; k++) {
                own[k] = excess != NULL ? eps * excess[k - heat->first[b]] : 0;
                sum += fine[k] - detail[k] - own[k], detail[k] = fine[k];
            }
            const double mean = excess != NULL && eps == 1 ? heat->sources.emission[b] : sum / (next - a);
            for (uint32_t k = a; k < next; k++) fine[k] = mean + own[k];
        }
    }
    heat->solution.group = FIBRAD_HEAT_FOUR;
    send_radiosities(heat);
}

/* Finds the powers of the finer level and extrapolates them to patches without size. If radiosities were smooth, the
 * error would fall with the area of patches, and a third of the difference between both levels would be right. Near
 * contacts they are not quite smooth. FIBRAD_HEAT_EXTRAPOLATION is right for settled beds:
 * docs/methods.md section 18. */
static void finish_powers(fibrad_heat *heat) {
    find_powers(heat, heat->solution.power);
    find_emissions(heat);
    if (heat->sources.free_level) fix_level(heat);
    heat->solution.steps = heat->sources.asked.no_errors;
    for (uint32_t b = 0; b < heat->bodies; b++)
        heat->solution.steps = heat->solution.steps || heat->sources.storage[b] > 0;
    if (heat->sources.conducts) {
        fibrad_heat_find_spans(heat);
        fibrad_heat_make_rings(heat);
        for (uint32_t b = 0; b < heat->spheres && fibrad_heat_is_entered(heat); b++)
            if (fibrad_heat_conducts(heat, b)) fibrad_heat_stand_for_absorbed(heat, b, -1);
    }
    for (uint32_t b = 0; b < heat->bodies; b++) {
        heat->solution.power[b] += FIBRAD_HEAT_EXTRAPOLATION * (heat->solution.power[b] - heat->solution.coarse[b]);
        if (fibrad_heat_is_free(heat, b))
            heat->sources.temperature[b] = fibrad_heat_temperature(heat, extrapolated_emission(heat, b));
    }
    if (heat->contacts.joins && (heat->sources.passed || !heat->sources.sides)) finish_contacts(heat);
    if (fibrad_heat_finish_sides(heat)) {
        coarsen_patches(heat);
        return;
    }
    for (uint32_t a = 0; a < heat->patches && !heat->sources.sides; a++)
        heat->solution.detail[a] += heat->solution.radiosity[a];
    heat->solution.phase = FIBRAD_HEAT_DONE;
    if (!heat->sources.asked.no_errors) send_means(heat);
}

/* The residual of all patches is mostly that of the spheres. What single walls gain may be much less right, above all
 * dim walls, which gain little of what arrives. So a search also ends only when each wall's gain, and those of all
 * spheres together, are settled: within the tolerance, relative to the gain or to GAIN_LEAST of what is absorbed. Below
 * GAINS_ROUGHLY the residual alone suffices. */
#define GAIN_LEAST    .05
#define GAINS_ROUGHLY 1e-6
#define RATIO_MOST    .9 /* of residuals in one step, when it tells how much the steps to come will change */

/* A change of radiosity times this is a change of power: of the net power, or of what is absorbed if the net power is
 * given. */
static double power_of_radiosity(const fibrad_heat *heat, uint32_t b) {
    return fibrad_heat_is_free(heat, b) ? heat->sources.emissivity[b] : 1;
}

/* Finds how much the last step has changed the power of each body, and all that surfaces send out. product: N times the
 * search direction. */
static void find_drifts(fibrad_heat *heat, double length, const double *product) {
    heat->solution.sent_drift = 0;
    for (uint32_t b = 0; b < heat->bodies; b++) {
        const bool known = !fibrad_heat_is_free(heat, b) && heat->sources.emissivity[b] > 0;
        double sent = 0;
        for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++)
            sent += heat->solution.area[a] * heat->solution.direction[a];
        heat->solution.sent_drift += length * sent;
        heat->solution.drift[b] =
            length * (known ? fibrad_heat_sum(heat, b, product) : power_of_radiosity(heat, b) * sent);
    }
}

/* Finds about how much the steps to come would change the power of each body, and all that surfaces send out. One
 * measure is what the next iteration of Jacobi would change, which find_residual has sent. The other one is the change
 * of the last step, with the ratio of residuals for each further step. */
static void find_left(fibrad_heat *heat) {
    const double ratio = fibrad_min(heat->solution.ratio, RATIO_MOST), rest = ratio / (1 - ratio);
    double all = 0;
    for (uint32_t b = 0; b < heat->bodies; b++) {
        double next = 0;
        for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++)
            next += heat->solution.area[a] * heat->solution.source[a];
        all += next;
        heat->solution.left[b] =
            fibrad_max(fibrad_abs(next) * power_of_radiosity(heat, b), fibrad_abs(heat->solution.drift[b]) * rest);
    }
    heat->solution.sent_left = fibrad_max(fibrad_abs(all), fibrad_abs(heat->solution.sent_drift) * rest);
}

/* Whether the powers that bodies of given temperature gain are settled. */
static bool gains_settled(fibrad_heat *heat) {
    double left = 0, gains = 0;
    bool settled = true;
    find_left(heat);
    for (uint32_t b = 0; b < heat->bodies; b++) {
        if (fibrad_heat_is_free(heat, b) || heat->sources.emissivity[b] == 0) continue;
        const double gain = fibrad_max(fibrad_abs(fibrad_heat_sum(heat, b, heat->solution.net)),
                                       GAIN_LEAST * fibrad_heat_absorbs(heat, b));
        if (b < heat->spheres)
            left += heat->solution.left[b] * heat->solution.left[b], gains += gain * gain;
        else
            settled = settled && heat->solution.left[b] <= heat->sources.settled * gain;
    }
    return settled && left <= heat->sources.settled * heat->sources.settled * gains;
}

/* What rounding errors of the J of a body may add to the product of residuals and changes: J errs by about 1e-16 of
 * itself, and the body absorbs g times what differs in its J. */
static double rounding_of(const fibrad_heat *heat, uint32_t b) {
    const double eps = heat->sources.emissivity[b];
    const bool conducts = fibrad_heat_conducts(heat, b), free_mean = conducts && follows_radiosity(heat, b);
    const double of_pattern = conducts ? fibrad_heat_largest_gain(heat, b) : 0;
    const double of_mean = eps == 1 || free_mean || (conducts && has_black_mean(heat, b)) ? 0 : eps / (1 - eps);
    double sum = 0;
    if (fibrad_heat_finds_sides(heat, b))
        return ROUNDING_OF_J *
               fibrad_heat_sides_product(heat, b, heat->solution.radiosity, heat->solution.radiosity, true);
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++)
        sum += heat->solution.area[a] * heat->solution.radiosity[a] * heat->solution.radiosity[a];
    return ROUNDING_OF_J * fibrad_max(of_pattern, of_mean) * sum;
}

/* Whether what is left of the residual may be rounding errors of radiosities. */
static bool is_rounded(const fibrad_heat *heat) {
    double rounding = 0;
    for (uint32_t b = 0; b < heat->bodies; b++) rounding += rounding_of(heat, b);
    return heat->solution.slope <= rounding;
}

/* Whether the radiosities of the present level are good enough. */
static bool level_solved(fibrad_heat *heat) {
    const double tolerance = fibrad_max(heat->sources.first_tolerance, heat->sources.tolerance);
    if (heat->solution.slope <= heat->solution.smallest) return true;
    if (heat->solution.slope > tolerance * tolerance * heat->solution.scale) return is_rounded(heat);
    return tolerance > heat->sources.tolerance || tolerance < GAINS_ROUGHLY || gains_settled(heat);
}

/* Adds what the residual of this level leaves of each extrapolated power. */
static void note_unsettled(fibrad_heat *heat) {
    const bool coarse = heat->solution.group == FIBRAD_HEAT_FOUR;
    const double part = coarse ? FIBRAD_HEAT_EXTRAPOLATION : 1 + FIBRAD_HEAT_EXTRAPOLATION;
    find_left(heat);
    if (coarse) {
        fibrad_zero(heat->solution.unsettled, heat->bodies * sizeof *heat->solution.unsettled);
        heat->solution.sent_unsettled = 0;
    }
    for (uint32_t b = 0; b < heat->bodies; b++) heat->solution.unsettled[b] += part * heat->solution.left[b];
    heat->solution.sent_unsettled += part * heat->solution.sent_left;
}

/* Whether the unevenness of spheres has changed so much that it was replaced. */
static bool replaces_unevenness(fibrad_heat *heat) {
    if (!heat->sources.conducts) return false;
    find_emissions(heat);
    const double change = fibrad_heat_find_unevenness(heat, SETTLED);
    heat->sources.first_tolerance = change > SETTLED ? fibrad_min(FIBRAD_HEAT_FIRST_TOLERANCE, WITHIN * change) : 0;
    return change > SETTLED;
}

/* Whether the flows of contacts at their places have changed so much that they were replaced. */
static bool replaces_flows(fibrad_heat *heat) {
    if (heat->spots.entering == NULL) return false;
    find_emissions(heat);
    const double change = fibrad_heat_find_spots(heat);
    const double rough = change > SETTLED ? fibrad_min(FIBRAD_HEAT_FIRST_TOLERANCE, WITHIN * change) : 0;
    heat->sources.first_tolerance = fibrad_max(heat->sources.first_tolerance, rough);
    if (change > SETTLED) fibrad_heat_place_flows(heat);
    return change > SETTLED;
}

/* Whether the temperatures of the gas of a stream have changed so much that the search goes on with new ones. */
#define GAS_SETTLED 1e-5 /* over the range of temperatures */
static bool replaces_gas(fibrad_heat *heat) {
    fibrad_contacts *c = &heat->contacts;
    if (c->stream == NULL) return false;
    const uint32_t slices = c->stream->slices;
    const double *gas = c->stream->gas;
    double *last = c->stream->gas + (FIBRAD_STREAM_ROWS - 1) * (size_t)slices, change = 0;
    double least = c->stream->inlet, most = c->stream->inlet;
    fibrad_copy(last, gas, slices * sizeof *last);
    set_arriving(heat);
    find_streaming(c, FOUND);
    for (uint32_t k = 0; k < slices; k++) {
        change = fibrad_max(change, fibrad_abs(gas[k] - last[k]));
        least = fibrad_min(least, gas[k]), most = fibrad_max(most, gas[k]);
    }
    for (uint32_t b = 0; b < heat->bodies; b++)
        if (c->film[b] > 0) least = fibrad_min(least, c->temperature[b]), most = fibrad_max(most, c->temperature[b]);
    const double rough = change > GAS_SETTLED * (most - least)
                             ? fibrad_min(FIBRAD_HEAT_FIRST_TOLERANCE, WITHIN * change / (most - least))
                             : 0;
    heat->sources.first_tolerance = fibrad_max(heat->sources.first_tolerance, rough);
    return rough > 0;
}

/* Whether the emissions of sides do not yet balance what arrives, so that the search goes on with new slopes. */
static bool replaces_sides(fibrad_heat *heat, bool coarse) {
    if (coarse || !heat->sources.sides) return false;
    fibrad_heat_find_sides(heat);
    heat->solution.slope = find_residual(heat);
    if (level_solved(heat)) return false;
    heat->sources.first_tolerance =
        fibrad_min(FIBRAD_HEAT_FIRST_TOLERANCE, WITHIN * fibrad_sqrt(heat->solution.slope / heat->solution.scale));
    return true;
}

/* Whether what a search takes as given was replaced. */
static bool replaces_given(fibrad_heat *heat, bool coarse) {
    const bool uneven = coarse && replaces_unevenness(heat);
    const bool streaming = replaces_gas(heat);
    return replaces_flows(heat) || uneven || streaming;
}

/* Sets and sends the next search direction: the change that was sent, plus `keep` times the last direction. */
static void turn_direction(fibrad_heat *heat, double keep) {
    for (uint32_t a = 0; a < heat->patches; a++) {
        heat->solution.direction[a] = heat->solution.source[a] + (keep != 0 ? keep * heat->solution.direction[a] : 0);
        heat->solution.source[a] = heat->solution.direction[a];
    }
    for (uint32_t b = 0; b < heat->bodies && heat->contacts.joins; b++)
        heat->contacts.direction[b] = heat->contacts.warming[b] + (keep != 0 ? keep * heat->contacts.direction[b] : 0);
}

/* Goes from the coarser level to the finer one. The detail of an earlier solution is added to the radiosities. Until
 * finish_powers, `detail` has minus the radiosities of the coarser level. With sides whose temperatures are found it
 * has the detail, and the finer level goes on where it was. */
static void refine_patches(fibrad_heat *heat) {
    find_powers(heat, heat->solution.coarse);
    find_emissions(heat);
    if (heat->sources.free_level) fix_level(heat);
    fibrad_copy(heat->solution.coarse_emission, heat->sources.emission, heat->bodies * sizeof *heat->sources.emission);
    heat->solution.group = 1;
    for (uint32_t a = 0; a < heat->patches; a++) {
        const double coarse = heat->solution.radiosity[a];
        heat->solution.radiosity[a] = heat->solution.detail[a] + (heat->sources.sides ? 0 : coarse);
        heat->solution.detail[a] = heat->sources.sides ? heat->solution.radiosity[a] - coarse : -coarse;
    }
    send_radiosities(heat);
}

/* Goes to the finer level, or to the end. */
static void leave_level(fibrad_heat *heat) {
    note_unsettled(heat);
    if (heat->solution.group == FIBRAD_HEAT_FOUR)
        refine_patches(heat);
    else
        finish_powers(heat);
}

/* The part of a body of given temperature in the product of values z on all patches with the matrix times the search
 * direction p. product: N p. */
static double given_product(const fibrad_heat *heat, uint32_t b, const double *z, const double *product) {
    double sum = 0;
    if (fibrad_heat_finds_sides(heat, b)) {
        for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++) sum += z[a] * product[a];
        return fibrad_heat_sides_product(heat, b, z, heat->solution.direction, true) - sum;
    }
    if (heat->sources.emissivity[b] == 1) return 0;
    const double share = heat->sources.emissivity[b] / (1 - heat->sources.emissivity[b]);
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++) {
        const double p = heat->solution.direction[a];
        sum += z[a] * (heat->solution.area[a] * p * share - product[a]);
    }
    return sum;
}

/* The same for a body of unknown temperature. The mean of p counts by eps h/D, the rest as above. */
static double free_product(const fibrad_heat *heat, uint32_t b, const double *z, const double *product) {
    const double eps = heat->sources.emissivity[b], mean = fibrad_heat_mean(heat, b, heat->solution.direction);
    const double share = eps < 1 ? eps / (1 - eps) : 0, z_mean = fibrad_heat_mean(heat, b, z);
    const free_body body = free_body_of(heat, b);
    if (!(body.area > 0)) return 0;
    double sum = body.area * z_mean * mean * (stiffness(heat, b, &body) - 1);
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++) {
        const double p = heat->solution.direction[a], rest = p - mean;
        sum += share * heat->solution.area[a] * (z[a] - z_mean) * rest - z[a] * product[a];
    }
    return sum;
}

/* The same for a joined body. warmed: z of its emission. The part of contacts is not in it. */
static double joined_product(const fibrad_heat *heat, uint32_t b, const double *z, double warmed,
                             const double *product) {
    const double eps = heat->sources.emissivity[b], share = eps < 1 ? eps / (1 - eps) : 0;
    const double warming = heat->contacts.direction[b];
    double sum = heat->sources.storage[b] * warmed * warming;
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++)
        sum += share * heat->solution.area[a] * (z[a] - warmed) * (heat->solution.direction[a] - warming) -
               z[a] * product[a];
    return sum;
}

/* The part of a sphere that conducts in the product of the search direction with the matrix times itself. */
static double conducting_curvature(const fibrad_heat *heat, uint32_t b, const double *product) {
    const double eps = heat->sources.emissivity[b], mean = fibrad_heat_mean(heat, b, heat->solution.direction);
    const free_body body = free_body_of(heat, b);
    if (!(body.area > 0)) return 0;
    const double warming = fibrad_heat_is_joined(heat, b) ? heat->contacts.direction[b] : 0;
    const double share = follows_radiosity(heat, b) ? stiffness(heat, b, &body) - 1
                         : has_black_mean(heat, b)  ? 0
                                                    : eps / (1 - eps);
    double sum = share * body.area * (mean - warming) * (mean - warming) + fibrad_heat_pattern_curvature(heat, b);
    if (fibrad_heat_is_joined(heat, b)) sum += heat->sources.storage[b] * warming * warming;
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++) sum -= heat->solution.direction[a] * product[a];
    return sum;
}

/* The product of z, and of `warmed` for the emissions of joined bodies, with the matrix times the search direction.
 * With spheres that conduct, z must be the search direction. */
static double product_with_direction(const fibrad_heat *heat, const double *z, const double *warmed,
                                     const double *product) {
    double sum = 0;
    for (uint32_t b = 0; b < heat->bodies; b++)
        sum += fibrad_heat_conducts(heat, b)    ? conducting_curvature(heat, b, product)
               : fibrad_heat_is_joined(heat, b) ? joined_product(heat, b, z, warmed[b], product)
               : fibrad_heat_is_free(heat, b)   ? free_product(heat, b, z, product)
                                                : given_product(heat, b, z, product);
    if (heat->contacts.joins) sum += fibrad_contact_product(&heat->contacts, warmed, heat->contacts.direction);
    return sum;
}

/* Moves the radiosities along the search direction to where the error is least. product: N times the direction. */
static void advance_radiosities(fibrad_heat *heat, const double *product) {
    const double curvature = product_with_direction(heat, heat->solution.direction, heat->contacts.direction, product);
    heat->solution.curvature = curvature;
    if (!(curvature > 0)) return;
    const double length = heat->solution.along / curvature;
    find_drifts(heat, length, product);
    for (uint32_t a = 0; a < heat->patches; a++) {
        heat->solution.radiosity[a] += length * heat->solution.direction[a];
        heat->solution.net[a] += length * product[a];
    }
    for (uint32_t b = 0; b < heat->bodies && heat->contacts.joins; b++)
        if (fibrad_heat_is_joined(heat, b)) heat->sources.emission[b] += length * heat->contacts.direction[b];
}

/* The product of the residual with the last direction. In a linear problem it is 0. What the preconditioner makes of
 * the residual is in heat->solution.source. */
static double along_last(const fibrad_heat *heat) {
    const double *z = heat->solution.source, *p = heat->solution.direction;
    double sum = 0;
    for (uint32_t b = 0; b < heat->bodies; b++) {
        const double eps = heat->sources.emissivity[b], rho = 1 - eps;
        double shift = 0, shifted = 0; /* what z and p have from a change of E, or of the mean of J */
        if (fibrad_heat_is_joined(heat, b)) {
            shift = eps * heat->contacts.warming[b], shifted = eps * heat->contacts.direction[b];
            sum += heat->contacts.missing[b] * heat->contacts.direction[b];
        } else if (fibrad_heat_is_free(heat, b)) {
            const free_body body = free_body_of(heat, b);
            if (!(body.area > 0)) continue;
            shift = fibrad_heat_mean(heat, b, z), shifted = fibrad_heat_mean(heat, b, p);
            sum += body.area * stiffness(heat, b, &body) * shift * shifted;
        } else if (fibrad_heat_finds_sides(heat, b)) {
            sum += fibrad_heat_sides_product(heat, b, z, p, false);
            continue;
        }
        for (uint32_t a = heat->first[b]; a < heat->first[b + 1] && rho > 0; a++)
            sum += heat->solution.area[a] / rho * (z[a] - shift) * (p[a] - shifted);
    }
    return sum;
}

/* How much of the last direction the next one keeps: as much as makes both conjugate. In a linear problem this is the
 * ratio of slopes. Contacts bend, so it differs from that. If it differs much, the last step was of no use for the next
 * one, and nothing is kept. Sets the slope along the direction. */
#define KEPT_MOST 4.0
static double kept_of_direction(fibrad_heat *heat, double ratio, const double *product) {
    if (!heat->contacts.joins || heat->sources.conducts) return ratio;
    if (!(heat->solution.curvature > 0)) return 0;
    const double overlap = product_with_direction(heat, heat->solution.source, heat->contacts.warming, product);
    const double keep = -overlap / heat->solution.curvature, along = heat->solution.slope + keep * along_last(heat);
    if (!(keep > 0 && keep < KEPT_MOST * ratio && along > 0)) return 0;
    heat->solution.along = along;
    return keep;
}

/* Decides what comes after a sweep: the next step of the search, the finer level, or the end. If the unevenness of
 * spheres changes, the search begins anew where it is. The net flows do not depend on unevenness, unless spheres have
 * absorbed light. If it no longer changes, the search goes on to the smaller tolerance. */
static void search_on(fibrad_heat *heat, bool restart, const double *product) {
    const double last = heat->solution.slope;
    heat->solution.slope = find_residual(heat);
    if (restart) heat->solution.smallest = fibrad_max(heat->solution.smallest, ROUNDING * heat->solution.slope);
    if (restart && heat->sources.sides && !heat->sources.passed)
        heat->solution.scale = fibrad_max(heat->solution.scale, heat->solution.slope);
    if (restart) fibrad_zero(heat->solution.drift, heat->bodies * sizeof *heat->solution.drift);
    heat->solution.ratio =
        restart || heat->solution.slope == 0 ? 0 : fibrad_sqrt(fibrad_min(1, heat->solution.slope / last));
    while (level_solved(heat)) {
        const bool coarse = heat->solution.group == FIBRAD_HEAT_FOUR;
        const bool rough = heat->sources.first_tolerance > heat->sources.tolerance;
        heat->sources.first_tolerance = 0;
        const bool balances = replaces_sides(heat, coarse), replaced = replaces_given(heat, coarse);
        if (!balances && !replaced && !(coarse && rough)) {
            leave_level(heat);
            return;
        }
        if (replaced && fibrad_heat_is_entered(heat)) {
            send_radiosities(heat);
            return;
        }
        restart = restart || balances || replaced;
        heat->solution.slope = find_residual(heat);
    }
    heat->solution.along = heat->solution.slope;
    turn_direction(heat, restart ? 0 : kept_of_direction(heat, heat->solution.slope / last, product));
    heat->solution.phase = FIBRAD_HEAT_STEPS;
}

/* Does what the sweep was made for. Errors: FIBRAD_E_UNSOLVABLE, FIBRAD_E_UNSETTLED. */
static int end_sweep(fibrad_heat *heat) {
    const double *sum = fibrad_heat_gathered(heat);
    if (heat->solution.phase == FIBRAD_HEAT_CHECK) {
        for (uint32_t b = 0; b < heat->bodies; b++) heat->samples.halves[b] = fibrad_heat_sum(heat, b, sum);
        heat->solution.phase = FIBRAD_HEAT_DONE;
        return FIBRAD_OK;
    }
    if (heat->solution.sweeps++ >= heat->sources.limit) return FIBRAD_E_UNSETTLED;
    switch (heat->solution.phase) {
    case FIBRAD_HEAT_AREA:
        fibrad_copy(heat->solution.area, sum, heat->patches * sizeof *sum);
        heat->solution.areas = true;
        send_first(heat);
        return FIBRAD_OK;
    case FIBRAD_HEAT_FIRST:
        for (uint32_t b = 0; b < heat->bodies; b++)
            for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++)
                heat->solution.net[a] = sum[a] + light_on(heat, b, a);
        if (heat->solution.group == 1 && heat->sources.sides) {
            fibrad_heat_find_sides(heat);
            if (!heat->sources.passed) heat->sources.first_tolerance = FIBRAD_HEAT_FIRST_TOLERANCE;
        }
        if (!solvable(heat)) return FIBRAD_E_UNSOLVABLE;
        find_scale(heat);
        heat_by_light(heat);
        search_on(heat, true, NULL);
        return FIBRAD_OK;
    default:
        advance_radiosities(heat, sum);
        search_on(heat, false, sum);
        return FIBRAD_OK;
    }
}

int fibrad_heat_step(fibrad_heat *heat, int *solved) {
    if (heat == NULL || solved == NULL) return FIBRAD_E_ARGUMENT;
    if (heat->solution.phase == FIBRAD_HEAT_IDLE || heat->solution.phase == FIBRAD_HEAT_DONE) return FIBRAD_E_STATE;
    if (!fibrad_heat_scene_kept(heat)) return FIBRAD_E_STATE;
    for (uint32_t part = 0; part < heat->config.parts; part++)
        if (!heat->swept[part]) return FIBRAD_E_STATE;
    const int status = end_sweep(heat);
    if (status != FIBRAD_OK) {
        heat->solution.phase = FIBRAD_HEAT_IDLE;
        return status;
    }
    fibrad_zero(heat->swept, heat->config.parts);
    *solved = heat->solution.warm = heat->solution.phase == FIBRAD_HEAT_DONE;
    return FIBRAD_OK;
}
