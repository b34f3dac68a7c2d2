/* solution.h - surfaces in a solution, and what the files of the solution share. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_HEAT_SOLUTION_H
#define FIBRAD_HEAT_SOLUTION_H

#include "patches/problem.h"

/* Whether a body is an insulated wall. */
static inline bool fibrad_heat_is_insulated(const fibrad_heat *heat, uint32_t body) {
    return body >= heat->spheres && heat->sources.insulated[body - heat->spheres];
}

/* Whether a body is a wall that sends back all that arrives: it is insulated, or its emissivity is 0. */
static inline bool fibrad_heat_reflects(const fibrad_heat *heat, uint32_t body) {
    return body >= heat->spheres && heat->sources.emissivity[body] == 0;
}

/* Whether the surface of a body has more than one temperature. */
static inline bool fibrad_heat_conducts(const fibrad_heat *heat, uint32_t body) {
    return body < heat->spheres && heat->sources.unevenness[body] > 0;
}

/* Whether heat enters surfaces at places, as light or through contacts. */
static inline bool fibrad_heat_is_entered(const fibrad_heat *heat) {
    return heat->sources.absorbed != NULL || heat->spots.entering != NULL;
}

/* The light that a body has absorbed. */
static inline double fibrad_heat_absorbed(const fibrad_heat *heat, uint32_t body) {
    return heat->sources.absorbed != NULL ? fibrad_heat_sum(heat, body, heat->sources.absorbed) : 0;
}

/* A patch that sends back all that arrives has few links to others. Too much of what arrives by a link goes back by it:
 * 1/k of it if k links are spread at random. So exchange areas of such links are taken to be larger, by the share of
 * the link in the area of the patch. Rays are spread more evenly than random ones. Beams of one direction are parallel,
 * so that several of them connect the same two surfaces. The two factors are measured in cubes, cups and mono2000 with
 * insulated walls: docs/methods.md section 19. */
#define FIBRAD_HEAT_RAYS_RETURN  .7
#define FIBRAD_HEAT_BEAMS_RETURN 1.5
static inline double fibrad_heat_enlarged(double area, double factor, double back_from, double back_to) {
    return area * (1 + factor * area * (back_from + back_to));
}

/* The same for a ray of walls. */
static inline double fibrad_heat_ray_area(const fibrad_heat *heat, const fibrad_heat_ray *ray) {
    const double *back = heat->solution.back;
    const uint32_t others = fibrad_heat_others(heat);
    return fibrad_heat_enlarged(ray->area, FIBRAD_HEAT_RAYS_RETURN, back[ray->from - others],
                                ray->to < others ? 0 : back[ray->to - others]);
}

/* The power that a body absorbs at its patches. Radiosities are differences from that of the surroundings. */
static inline double fibrad_heat_absorbs(const fibrad_heat *heat, uint32_t body) {
    const double t = heat->sources.surroundings, black = heat->sources.sigma * (t * t) * (t * t);
    double arrives = 0;
    for (uint32_t a = heat->first[body]; a < heat->first[body + 1]; a++)
        arrives += heat->solution.area[a] * (heat->solution.radiosity[a] + black) + heat->solution.net[a];
    return heat->sources.emissivity[body] * arrives;
}

/* Whether a body in contact or in a clump has an emission that is an unknown beside its radiosities. */
static inline bool fibrad_heat_is_joined(const fibrad_heat *heat, uint32_t body) {
    return heat->contacts.joins && heat->contacts.kind[body] >= FIBRAD_CONTACT_FREE;
}

/* Sums values of nodes, one of each body, at the leaders of clumps: [bodies]. */
static inline void fibrad_heat_sum_clumps(const fibrad_heat *heat, double *value) {
    for (uint32_t b = 0; b < heat->spheres && heat->clumps.some; b++)
        if (fibrad_heat_follows(heat, b)) value[heat->clumps.leader[b]] += value[b], value[b] = 0;
}

/* Gives the members of clumps the values of their leaders. */
static inline void fibrad_heat_follow_leaders(const fibrad_heat *heat, double *value) {
    for (uint32_t b = 0; b < heat->spheres && heat->clumps.some; b++)
        if (fibrad_heat_follows(heat, b)) value[b] = value[heat->clumps.leader[b]];
}

/* The temperature of the second end of contact k: its contact_temperature, or else that of its node. */
static inline double fibrad_heat_at_contact(const fibrad_heat *heat, uint32_t k, double of_node) {
    const double *own = heat->sources.asked.contact_temperature;
    return own != NULL && own[k] == own[k] ? own[k] : of_node;
}

/* What a body gains through contacts and its film. */
static inline double fibrad_heat_conducted(const fibrad_heat *heat, uint32_t body) {
    return heat->contacts.joins ? heat->contacts.gain[body] : 0;
}

/* The part of it that comes from the gas. */
static inline double fibrad_heat_convected(const fibrad_heat *heat, uint32_t body) {
    return heat->contacts.joins && heat->film[body] > 0
               ? heat->film[body] * (heat->gas[body] - heat->contacts.temperature[body])
               : 0;
}

/* h R/k of the film of a sphere that conducts: h is the film over the area of the surface. */
static inline double fibrad_heat_biot(const fibrad_heat *heat, uint32_t sphere) {
    const double film = heat->contacts.joins ? heat->film[sphere] : 0;
    return film > 0 ? film / (4 * FIBRAD_PI * heat->scene->r[sphere] * heat->sources.conductivity[sphere]) : 0;
}

/* The temperature of an emission, which is relative to that of the surroundings. NaN: the temperature would be below
 * zero. */
static inline double fibrad_heat_temperature(const fibrad_heat *heat, double emission) {
    const double t0 = heat->sources.surroundings, power = emission / heat->sources.sigma + (t0 * t0) * (t0 * t0);
    return power >= 0 ? fibrad_sqrt(fibrad_sqrt(power)) : __builtin_nan("");
}

/* ---- sphere_conduction.c: patterns of spheres that conduct ------------------------------------------------------- */

/* The fraction of the light on a patch that leaves from the same patch. It is reflected there, or
 * it is emitted because the patch is hotter than the rest of the body. */
double fibrad_heat_sent_back(const fibrad_heat *heat, uint32_t body);

/* g of the shortest waves on a sphere that conducts. */
double fibrad_heat_largest_gain(const fibrad_heat *heat, uint32_t body);

/* Finds the unevenness of all spheres from their emissions. Returns the largest relative change. If the change is not
 * above `least`, the unevenness stays. */
double fibrad_heat_find_unevenness(fibrad_heat *heat, double least);

/* Sends, from the patches of a sphere, what one preconditioned iteration would change of the pattern of J, plus
 * `shift`. Returns the product of the residual and the change without `shift`. The function overwrites
 * heat->solution.gathered of the sphere. */
double fibrad_heat_pattern_residual(fibrad_heat *heat, uint32_t sphere, double shift);

/* The sum over the patches of a sphere of A p g p, p being the search direction without its mean. */
double fibrad_heat_pattern_curvature(const fibrad_heat *heat, uint32_t sphere);

/* The power that enters a sphere at a patch: absorbed light, and heat of contacts. */
double fibrad_heat_entering(const fibrad_heat *heat, uint32_t patch);

/* Adds to the net flows of a sphere what stands for the pattern of light that its patches have absorbed. Returns the
 * sum over the patches of residual times change of a J that is even. */
double fibrad_heat_add_absorbed(fibrad_heat *heat, uint32_t sphere);

/* Adds `share` times what stands for that pattern. -1 takes it off again. */
void fibrad_heat_stand_for_absorbed(fibrad_heat *heat, uint32_t sphere, double share);

/* Finds heat->solution.span of all spheres. The function overwrites heat->solution.gathered, source and direction. */
void fibrad_heat_find_spans(fibrad_heat *heat);

/* ---- extremes.c: hottest and coldest places, in rings ------------------------------------------------------------ */

/* Makes heat->rings and heat->normal. */
void fibrad_heat_make_rings(fibrad_heat *heat);

/* What a sphere has in rings about an axis: areas, and means of irradiation, J and the power that enters. A ring
 * without patches, which is near the axis, has the means of the next ring. sign: -1: the axis is turned over. smooth:
 * the smooth part of the irradiation is that of patches without size. */
typedef struct fibrad_heat_ringed {
    double area[FIBRAD_RINGS], arriving[FIBRAD_RINGS], sent[FIBRAD_RINGS], absorbed[FIBRAD_RINGS];
} fibrad_heat_ringed;
void fibrad_heat_look_in_rings(const fibrad_heat *heat, uint32_t sphere, const double axis[3], double sign, bool smooth,
                               fibrad_heat_ringed *mean);

/* The mean over patch `a` of a sphere of what the cosine to an axis exceeds `cosine` by; 0 where it does not. */
double fibrad_heat_within_cap(const fibrad_heat *heat, uint32_t sphere, uint32_t a, const double axis[3],
                              double cosine);

/* Finds the hottest and the coldest places of the spheres from `begin` to `end` - 1 in heat->sequence. The solution has
 * ended, and no direction was set since. */
void fibrad_heat_find_extremes(const fibrad_heat *heat, uint32_t begin, uint32_t end, fibrad_rings_work *work);

/* ---- contact_spots.c: contacts at their places ------------------------------------------------------------------- */

/* Finds what contacts conduct at their places, with the present radiosities and emissions. Returns the largest change
 * of a flow over the largest flow. */
double fibrad_heat_find_spots(fibrad_heat *heat);

/* Lets the flows that were found enter the spheres. */
void fibrad_heat_place_flows(fibrad_heat *heat);

/* Adds to `to` what bodies gain because contacts have other temperatures than their walls. */
void fibrad_heat_add_places(const fibrad_heat *heat, double *to);

/* Adds to `to` what bodies gain through contacts if the means of all surfaces are equal. */
void fibrad_heat_add_offsets(const fibrad_heat *heat, double *to);

/* ---- sides.c: sides of triangles that have films or powers --------------------------------------------------------
 */

/* What sources give for a side. Where they give nothing, `film` and `power` are 0, temperatures NaN. */
typedef struct fibrad_heat_side {
    double temperature, film, gas, power;
    bool found; /* the temperature is to be found */
} fibrad_heat_side;
static inline fibrad_heat_side fibrad_heat_side_of(const fibrad_heat *heat, const fibrad_heat_sources *s,
                                                   uint32_t side) {
    const uint64_t k = fibrad_side_given(&heat->scene->mesh, side);
    const double nan = __builtin_nan(""), power = s->side_power != NULL ? s->side_power[k] : nan;
    const double film = s->side_film != NULL ? s->side_film[k] : 0;
    return (fibrad_heat_side){s->side_temperature != NULL ? s->side_temperature[k] : nan, film,
                              s->side_gas != NULL ? s->side_gas[k] : nan, power == power ? power : 0,
                              film != 0 || power == power};
}

/* Finds how emissions of sides follow the radiation that arrives. Overwrites heat->solution.source. */
void fibrad_heat_find_sides(fibrad_heat *heat);

/* Sends what one Jacobi iteration would change on a mesh with such sides. Returns the product of the residual and this
 * change. */
double fibrad_heat_sides_residual(fibrad_heat *heat, uint32_t body);

/* The product of x, a matrix and y. emits: the matrix is that of the system without the net flows; else it is the
 * inverse of the preconditioner. */
double fibrad_heat_sides_product(const fibrad_heat *heat, uint32_t body, const double *x, const double *y, bool emits);

/* Takes over the emissions of sides at the end of the finer level. Returns whether both levels must be searched again.
 * Overwrites heat->solution.source. */
bool fibrad_heat_finish_sides(fibrad_heat *heat);

/* ---- result.c ---------------------------------------------------------------------------------------------------- */

/* What the fluxes of a mesh have besides the flows of their patches per area: from extrapolation, residuals, and areas
 * by beams; in [0] of net powers, in [1] of light. */
void fibrad_heat_beyond_patches(const fibrad_heat *heat, uint32_t mesh, double beyond[2]);

/* ---- solve.c ----------------------------------------------------------------------------------------------------- */

/* Prepares the first sweep of a solution. */
void fibrad_heat_start(fibrad_heat *heat);

#endif
