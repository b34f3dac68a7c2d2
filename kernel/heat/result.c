/* result.c - hands out powers, temperatures, and fluxes of triangles. SPDX-License-Identifier: MIT */
#include "heat/errors.h"
#include "patches/subdivision.h"
#include "scene/walls.h"

/* Writes a value that is wanted. */
static void put_wanted(double *values, uint32_t k, double value) {
    if (values != NULL) values[k] = value;
}

/* The difference of a temperature from the mean of its surface, and the error of this difference. */
typedef struct measured {
    double value, error;
} measured;

/* The temperature of the hottest or the coldest place of a sphere minus the mean of its surface. */
static measured extreme_of(const fibrad_heat *heat, uint32_t b, bool hottest) {
    const fibrad_heat_span *span = &heat->solution.span[b];
    const double t = heat->sources.temperature[b], slope = 4 * heat->sources.sigma * t * t * t, sign = hottest ? 1 : -1;
    const double value = hottest ? span->largest : span->least, patch = hottest ? span->high : span->low;
    const double spot = hottest ? span->hottest_spot : span->coldest_spot;
    const bool open = hottest ? span->open_high : span->open_low;
    measured extreme = {0, 0};
    if (fibrad_heat_conducts(heat, b))
        extreme = (measured){value / slope, fibrad_heat_place_error(heat, b, value, patch, open) / slope};
    if (sign * spot > sign * extreme.value)
        extreme = (measured){spot, fibrad_max(extreme.error, FIBRAD_HEAT_SPOT_ERROR * (sign * spot))};
    return extreme;
}

/* With a source of q per volume that is uniform inside, the centre of a sphere is q r^2/(6 k) hotter than the mean of
 * its surface. Returns by how much it is colder, over the power that the sphere gains. */
static double slope_inside(const fibrad_heat *heat, uint32_t b) {
    return 1 / (8 * FIBRAD_PI * heat->scene->r[b] * heat->sources.conductivity[b]);
}

/* The temperature of a surface. An insulated wall has the one at which a black wall would emit what it sends back. */
static double temperature_of(const fibrad_heat *heat, uint32_t b) {
    return fibrad_heat_is_insulated(heat, b)
               ? fibrad_heat_temperature(heat, fibrad_heat_mean(heat, b, heat->solution.radiosity))
               : heat->sources.temperature[b];
}

/* Hands out temperatures. The source inside a sphere takes up its net power and the light that it absorbs. */
static void read_temperatures(const fibrad_heat *heat, const fibrad_heat_result *result) {
    for (uint32_t b = 0; b < heat->spheres; b++) {
        const uint32_t i = heat->order[b];
        const double mean = temperature_of(heat, b);
        const double gained = heat->solution.power[b] + fibrad_heat_conducted(heat, b) + fibrad_heat_absorbed(heat, b);
        put_wanted(result->temperature, i, mean);
        put_wanted(result->least_temperature, i, mean + extreme_of(heat, b, false).value);
        put_wanted(result->largest_temperature, i, mean + extreme_of(heat, b, true).value);
        put_wanted(result->centre_temperature, i, mean - slope_inside(heat, b) * gained);
    }
    for (uint32_t k = 0; k < heat->given_walls; k++)
        put_wanted(result->wall_temperature, k, temperature_of(heat, fibrad_heat_body(heat, heat->slot[k])));
}

/* Whether all temperatures that were to be found exist. */
static bool all_found(const fibrad_heat *heat) {
    bool found = !(heat->sources.sides && heat->sources.below);
    for (uint32_t b = 0; b < heat->bodies; b++)
        found = found && (!fibrad_heat_is_free(heat, b) || heat->sources.temperature[b] >= 0);
    return found;
}

/* The result for the power of a slot. If the slot is an opening or empty: that of the surroundings. */
static double *power_of_slot(const fibrad_heat *heat, uint32_t slot, fibrad_heat_result *result) {
    for (uint32_t b = 0; b < heat->given_walls; b++)
        if (heat->slot[b] == slot) return &result->wall_power[b];
    return &result->surroundings_power;
}

/* A net flow, and the area for which its rays stand. */
typedef struct patch_flow {
    double net, area;
} patch_flow;

/* The flow from the patches of the wall that faces wall k to where wall k goes on beyond its patches. */
static patch_flow flow_of_facing(const fibrad_heat *heat, uint32_t k) {
    const uint32_t facing = fibrad_heat_facing(heat, k), a = heat->first[fibrad_heat_beyond(heat, k)];
    patch_flow flow = {0, 0};
    if (facing == FIBRAD_WALLS) return flow;
    const uint32_t body = fibrad_heat_body(heat, facing);
    for (uint32_t n = 0; n < heat->rays; n++) {
        const fibrad_heat_ray ray = heat->ray[n];
        if (ray.to != a || ray.from < heat->first[body] || ray.from >= heat->first[body + 1]) continue;
        flow.net +=
            fibrad_heat_ray_area(heat, &ray) * (heat->solution.radiosity[ray.from] - heat->solution.radiosity[a]);
        flow.area += ray.area;
    }
    return flow;
}

/* Shares out the power that arrives beyond the patches of wall k. Wall k gets what it absorbs, and what it faces gets
 * the rest. The flow between the patches of the facing wall and this place is left out of that: for both walls together
 * such flows add up to about 0, so each wall gets half of them. The powers of a pair are then those of its patches. */
static void read_beyond(const fibrad_heat *heat, uint32_t k, fibrad_heat_result *result) {
    const uint32_t beyond = fibrad_heat_beyond(heat, k), a = heat->first[beyond];
    if (a == heat->first[beyond + 1]) return;
    const patch_flow pair = flow_of_facing(heat, k);
    const double less = heat->solution.radiosity[a] - heat->sources.wall_emission[k],
                 net = heat->solution.net[a] - pair.net;
    const double taken = fibrad_heat_taken_beyond(heat, k) * (net + (heat->solution.area[a] - pair.area) * less);
    *power_of_slot(heat, k, result) += taken + pair.net / 2;
    *power_of_slot(heat, fibrad_heat_facing(heat, k), result) += heat->solution.power[beyond] - taken - pair.net / 2;
}

/* Hands out the net powers of spheres, walls and gas, and what contacts conduct. */
static void read_net_powers(const fibrad_heat *heat, fibrad_heat_result *result) {
    const fibrad_contacts *c = &heat->contacts;
    for (uint32_t b = 0; b < heat->spheres; b++) {
        const double conducted = fibrad_heat_conducted(heat, b), convected = fibrad_heat_convected(heat, b);
        result->power[heat->order[b]] = heat->solution.power[b] + conducted;
        put_wanted(result->conducted, heat->order[b], conducted - convected);
        put_wanted(result->convected, heat->order[b], convected);
    }
    for (uint32_t k = 0; k < heat->given_walls; k++) {
        const uint32_t slot = heat->slot[k], b = fibrad_heat_body(heat, slot);
        const double conducted = fibrad_heat_conducted(heat, b), convected = fibrad_heat_convected(heat, b);
        result->wall_power[k] = heat->solution.power[b] + conducted;
        put_wanted(result->wall_conducted, k, conducted - convected);
        put_wanted(result->wall_convected, k, convected);
        if (result->wall_absorbed != NULL) result->wall_absorbed[k] = fibrad_heat_absorbs(heat, b);
        put_wanted(result->wall_area, k,
                   slot < FIBRAD_MESHES ? fibrad_heat_wall_area(heat, slot) : fibrad_scene_wall_area(heat->scene, k));
    }
    for (uint32_t k = 0; k < c->count && result->contact_flow != NULL; k++)
        result->contact_flow[k] =
            c->conductance[k] * (c->temperature[c->node[c->first[k]]] -
                                 fibrad_heat_at_contact(heat, k, c->temperature[c->node[c->second[k]]])) +
            (heat->spots.entering != NULL ? heat->spots.offset[k] : 0);
    result->surroundings_power = heat->solution.power[heat->bodies - 1];
    for (uint32_t k = 0; k < FIBRAD_WALLS; k++) {
        if (heat->openings >> k & 1) result->surroundings_power += heat->solution.power[fibrad_heat_body(heat, k)];
        read_beyond(heat, k, result);
    }
    result->gas_power = 0;
    for (uint32_t b = 0; b < heat->bodies; b++) result->gas_power -= fibrad_heat_convected(heat, b);
}

/* The error of what the gas gains, the smaller of two: what all temperatures at films err by and, by the balance of all
 * powers, what the other powers that are not given err by. outside: error of the power of the surroundings. */
static double gas_error_of(const fibrad_heat *heat, const fibrad_heat_errors *errors, double outside) {
    double most = 0, others = outside * outside;
    if (!heat->contacts.joins) return 0;
    for (uint32_t b = 0; b < heat->bodies; b++) {
        most += heat->contacts.film[b] * heat->contacts.error[b];
        if (!fibrad_heat_is_free(heat, b)) others += fibrad_heat_radiated_error(heat, errors, b);
    }
    return fibrad_min(most, fibrad_sqrt(others));
}

/* Hands out all estimated errors. */
static void read_errors(const fibrad_heat *heat, fibrad_heat_result *result) {
    fibrad_heat_errors errors;
    fibrad_heat_find_errors(heat, &errors);
    for (uint32_t b = 0; b < heat->spheres; b++) {
        const uint32_t i = heat->order[b];
        const double mean = fibrad_heat_temperature_error(heat, &errors, b, temperature_of(heat, b));
        const double worst = fibrad_max(extreme_of(heat, b, false).error, extreme_of(heat, b, true).error);
        const double inside = slope_inside(heat, b) * fibrad_sqrt(fibrad_heat_radiated_error(heat, &errors, b));
        put_wanted(result->power_error, i, fibrad_heat_power_error(heat, &errors, b));
        put_wanted(result->temperature_error, i, mean);
        put_wanted(result->surface_error, i, fibrad_sqrt(mean * mean + worst * worst));
        put_wanted(result->centre_error, i, fibrad_sqrt(mean * mean + inside * inside));
    }
    for (uint32_t k = 0; k < heat->given_walls; k++) {
        const uint32_t b = fibrad_heat_body(heat, heat->slot[k]);
        put_wanted(result->wall_error, k, fibrad_heat_power_error(heat, &errors, b));
        put_wanted(result->wall_temperature_error, k,
                   fibrad_heat_temperature_error(heat, &errors, b, temperature_of(heat, b)));
    }
    for (uint32_t k = 0; k < heat->contacts.count; k++)
        put_wanted(result->contact_error, k, fibrad_heat_flow_error(heat, k));
    result->surroundings_error = fibrad_heat_surroundings_error(heat, &errors);
    result->gas_error = gas_error_of(heat, &errors, result->surroundings_error);
    fibrad_heat_mean_errors(heat, &errors, &result->error_patches, &result->error_beams);
}

int fibrad_heat_read(const fibrad_heat *heat, fibrad_heat_result *result) {
    if (heat == NULL || result == NULL || (heat->spheres > 0 && result->power == NULL)) return FIBRAD_E_ARGUMENT;
    if (heat->given_walls > 0 && result->wall_power == NULL) return FIBRAD_E_ARGUMENT;
    if (heat->solution.phase != FIBRAD_HEAT_DONE || !fibrad_heat_scene_kept(heat)) return FIBRAD_E_STATE;
    const bool inside =
        result->least_temperature != NULL || result->largest_temperature != NULL || result->surface_error != NULL;
    if (heat->sources.conducts && heat->solution.steps && inside)
        fibrad_heat_find_extremes(heat, 0, heat->spheres, heat->near);
    read_net_powers(heat, result);
    read_temperatures(heat, result);
    if (!heat->sources.asked.no_errors) read_errors(heat, result);
    result->sweeps = heat->solution.sweeps;
    result->residual = heat->solution.scale > 0 ? fibrad_sqrt(heat->solution.slope / heat->solution.scale) : 0;
    return all_found(heat) ? FIBRAD_OK : FIBRAD_E_UNSOLVABLE;
}

/* Sums over the patches of a side: areas, flows, areas times radiosities. */
typedef struct side_sum {
    double area, flow, radiosity;
} side_sum;

/* flow[patches]: net flows, or light that is absorbed. */
static side_sum sum_of_side(const fibrad_heat *heat, const fibrad_mesh_cut *cut, const double *flow) {
    const uint32_t begin = fibrad_heat_first_meshed(heat) + cut->patch;
    side_sum sum = {0, 0, 0};
    if (cut->patch == UINT32_MAX) return sum;
    for (uint32_t a = begin; a < begin + (UINT32_C(1) << cut->halvings); a++)
        sum.area += heat->solution.area[a], sum.flow += flow[a],
            sum.radiosity += heat->solution.area[a] * heat->solution.radiosity[a];
    return sum;
}

static bool is_within_walls(const fibrad_scene *scene, uint32_t triangle) {
    bool inside = true;
    double corner[3][3];
    fibrad_mesh_corners(&scene->mesh, triangle, corner);
    for (int k = 0; k < 3 && scene->container.walls; k++)
        inside = inside && fibrad_walls_hold(&scene->container, corner[k]);
    return inside;
}

/* A power of a mesh per area minus the flow of its patches per area: from extrapolation, residuals, and areas by beams.
 * Areas are those of triangles whose patches are met. If a plane or the cylinder cuts the mesh, areas are those from
 * beams. */
static double flux_beyond_patches(const fibrad_heat *heat, uint32_t m, const double *flow, double power) {
    const fibrad_mesh *mesh = &heat->scene->mesh;
    const uint32_t b = fibrad_heat_body(heat, FIBRAD_MESHES + m);
    double area = 0, gained = 0;
    bool whole = true;
    for (uint32_t k = mesh->first[m]; k < mesh->first[m + 1]; k++) {
        const uint32_t triangle = fibrad_side_triangle(mesh->side[k]);
        const side_sum sum = sum_of_side(heat, fibrad_mesh_cut_of(mesh, heat->cut, mesh->side[k]), flow);
        const double own = fibrad_mesh_triangle_area(mesh, triangle);
        whole = whole && is_within_walls(heat->scene, triangle);
        if (sum.area > 0) area += own, gained += own * (sum.flow / sum.area);
    }
    if (!whole) area = fibrad_heat_sum(heat, b, heat->solution.area), gained = fibrad_heat_sum(heat, b, flow);
    return area > 0 ? (power - gained) / area : 0;
}

/* The light that the sides of a mesh have absorbed, by patch. NULL: none, or they give it off again. */
static const double *light_of_mesh(const fibrad_heat *heat, uint32_t m) {
    return fibrad_heat_is_insulated(heat, fibrad_heat_body(heat, FIBRAD_MESHES + m)) ? NULL : heat->sources.absorbed;
}

void fibrad_heat_beyond_patches(const fibrad_heat *heat, uint32_t m, double beyond[2]) {
    const uint32_t b = fibrad_heat_body(heat, FIBRAD_MESHES + m);
    const double *light = light_of_mesh(heat, m);
    beyond[0] = flux_beyond_patches(heat, m, heat->solution.net, heat->solution.power[b]);
    beyond[1] = light != NULL ? flux_beyond_patches(heat, m, light, fibrad_heat_absorbed(heat, b)) : 0;
}

/* The net power of a side per area. beyond: what patches lack of the powers of its mesh: of net powers, and of light.
 */
static double flux_of_side(const fibrad_heat *heat, uint32_t m, const fibrad_mesh_cut *cut, const side_sum *net,
                           const double beyond[2]) {
    const double *light = light_of_mesh(heat, m);
    if (!(net->area > 0)) return __builtin_nan("");
    const bool emits = heat->sources.emissivity[fibrad_heat_body(heat, FIBRAD_MESHES + m)] > 0;
    return (emits ? net->flow / net->area + beyond[0] : 0) +
           (light != NULL ? sum_of_side(heat, cut, light).flow / net->area + beyond[1] : 0);
}

static double temperature_of_side(const fibrad_heat *heat, uint32_t b, const fibrad_mesh_cut *cut,
                                  const side_sum *sum) {
    if (fibrad_heat_is_insulated(heat, b))
        return sum->area > 0 ? fibrad_heat_temperature(heat, sum->radiosity / sum->area) : __builtin_nan("");
    const double *excess = fibrad_heat_excess(heat, b);
    if (excess == NULL) return heat->sources.temperature[b];
    const uint32_t a = fibrad_heat_first_meshed(heat) + cut->patch - heat->first[b];
    const double t = fibrad_heat_temperature(heat, heat->sources.emission[b] + excess[a]);
    return t >= 0 || (heat->sources.sides && heat->sources.below) ? t : 0;
}

int fibrad_heat_read_sides(const fibrad_heat *heat, double *flux, double *temperature) {
    double beyond[FIBRAD_WALLS_MAX][2];
    if (heat == NULL) return FIBRAD_E_ARGUMENT;
    if (heat->solution.phase != FIBRAD_HEAT_DONE || !fibrad_heat_scene_kept(heat)) return FIBRAD_E_STATE;
    const fibrad_mesh *mesh = &heat->scene->mesh;
    for (uint32_t m = 0; m < heat->meshes; m++) fibrad_heat_beyond_patches(heat, m, beyond[m]);
    for (uint32_t s = 0; s < 2 * heat->triangles; s++) {
        const fibrad_mesh_cut *cut = fibrad_mesh_cut_of(mesh, heat->cut, s);
        const uint32_t to = (uint32_t)(cut - heat->cut);
        double q = __builtin_nan(""), t = q;
        if (cut->patch != UINT32_MAX) {
            const uint32_t m = fibrad_side_mesh(mesh, s), b = fibrad_heat_body(heat, FIBRAD_MESHES + m);
            const side_sum sum = sum_of_side(heat, cut, heat->solution.net);
            q = flux_of_side(heat, m, cut, &sum, beyond[m]);
            t = temperature_of_side(heat, b, cut, &sum);
        }
        put_wanted(flux, to, q);
        put_wanted(temperature, to, t);
    }
    return FIBRAD_OK;
}
