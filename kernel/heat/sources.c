/* sources.c - checks the sources of a solution, and sets the first radiosities. SPDX-License-Identifier: MIT */
#include "heat/solution.h"

#define HEAT_TOLERANCE  1e-3
#define FREE_TOLERANCE  1e-5  /* if temperatures are unknown: errors over long distances exceed their residuals */
#define FEW_TOLERANCE   1e-12 /* of few spheres, which may exchange little of what they emit: this takes no time */
#define FEW_SPHERES     16u
#define HEAT_SWEEPS_MAX 1000u
#define STORAGE_MAX     1e60

void fibrad_heat_sources_init(fibrad_heat_sources *sources) {
    if (sources == NULL) return;
    *sources = (fibrad_heat_sources){.surroundings = __builtin_nan(""), .sigma = FIBRAD_STEFAN_BOLTZMANN};
}

/* Whether there are contacts or films. */
static bool conducts_between(const fibrad_heat_sources *s) {
    return s->contacts > 0 || s->film != NULL || s->wall_film != NULL;
}

/* Contacts pass on what is small beside the flows that they carry, so their balances do not close that far. */
static double default_tolerance(const fibrad_heat *heat, const fibrad_heat_sources *s, bool unknown) {
    if (heat->spheres <= FEW_SPHERES && !conducts_between(s)) return FEW_TOLERANCE;
    return unknown ? FREE_TOLERANCE : HEAT_TOLERANCE;
}

static bool is_share(double x) { return x >= 0 && x <= 1; }

/* Within these bounds squares of emissions, and their products with areas, stay within the range of doubles. */
static bool is_temperature(double t) { return t >= 0 && t <= FIBRAD_TEMPERATURE_MAX; }
static bool is_sigma(double sigma) { return sigma >= FIBRAD_SIGMA_MIN && sigma <= FIBRAD_SIGMA_MAX; }

/* What the sources give for one body. */
typedef struct radiator {
    double temperature, emissivity, power, storage, reference; /* NaN: not given */
} radiator;

static double or_else(const double *value, uint32_t i, double otherwise) {
    return value != NULL ? value[i] : otherwise;
}

static radiator of_sphere(const fibrad_heat_sources *s, uint32_t i) {
    return (radiator){s->temperature[i], s->emissivity[i], or_else(s->power, i, __builtin_nan("")),
                      or_else(s->storage, i, 0), or_else(s->reference, i, __builtin_nan(""))};
}

/* A wall that is insulated reflects all, like one of emissivity 0. */
static radiator of_body(const fibrad_heat_sources *s, uint32_t b) {
    const bool insulated = s->insulated != NULL && s->insulated[b] != 0;
    return (radiator){insulated ? __builtin_nan("") : s->wall_temperature[b], insulated ? 0 : s->wall_emissivity[b],
                      insulated ? 0 : or_else(s->wall_power, b, __builtin_nan("")), 0, __builtin_nan("")};
}

/* A sphere or a wall by the caller's number. */
static radiator of_end(const fibrad_heat *heat, const fibrad_heat_sources *s, uint32_t end) {
    return end < heat->spheres ? of_sphere(s, end) : of_body(s, end - heat->spheres);
}

/* An opening is as black and as hot as the surroundings. */
static radiator of_opening(const fibrad_heat_sources *s) {
    return (radiator){s->surroundings, 1, __builtin_nan(""), 0, __builtin_nan("")};
}

static bool is_given(double temperature) { return temperature == temperature; }

/* The reason why a body is not valid. FIBRAD_WHY_UNSAID: it is valid. touches: it has contacts. */
static int source_why(const radiator *s, bool touches) {
    if (!is_share(s->emissivity)) return FIBRAD_WHY_EMISSIVITY;
    if (is_given(s->temperature)) {
        if (!is_temperature(s->temperature)) return FIBRAD_WHY_TEMPERATURE;
        return is_given(s->power) && s->power != 0 ? FIBRAD_WHY_BOTH : FIBRAD_WHY_UNSAID;
    }
    if (is_given(s->reference) ? !is_temperature(s->reference) : s->storage != 0) return FIBRAD_WHY_STORAGE;
    if (!is_given(s->power)) return FIBRAD_WHY_NEITHER;
    if (!(fibrad_abs(s->power) <= FIBRAD_POWER_MAX)) return FIBRAD_WHY_POWER;
    if (!(s->storage >= 0 && s->storage <= STORAGE_MAX)) return FIBRAD_WHY_STORAGE;
    return s->emissivity > 0 || s->power == 0 || touches ? FIBRAD_WHY_UNSAID : FIBRAD_WHY_REFLECTS;
}

/* The temperature of a side of a mesh. A side without a temperature of its own has that of the mesh. */
static double side_temperature(const fibrad_heat *heat, const fibrad_heat_sources *s, uint32_t side, double of_body) {
    const double own = fibrad_heat_side_of(heat, s, side).temperature;
    return is_given(own) ? own : of_body;
}

/* Whether something is said of sides of meshes. */
static bool says_sides(const fibrad_heat_sources *s) {
    return s->side_temperature != NULL || s->side_film != NULL || s->side_power != NULL;
}

/* Whether what is given of the sides of a wall is valid. Only a mesh whose temperature is given may have any of it. */
static bool sides_valid(const fibrad_heat *heat, const fibrad_heat_sources *s, uint32_t b) {
    const fibrad_mesh *mesh = &heat->scene->mesh;
    bool valid = true;
    if (heat->slot[b] < FIBRAD_MESHES || !says_sides(s)) return true;
    const uint32_t m = heat->slot[b] - FIBRAD_MESHES;
    const radiator body = of_body(s, b);
    for (uint32_t k = mesh->first[m]; k < mesh->first[m + 1]; k++) {
        const fibrad_heat_side side = fibrad_heat_side_of(heat, s, mesh->side[k]);
        const bool given = is_given(side.temperature);
        valid =
            valid && (!given || (is_temperature(side.temperature) && !side.found)) &&
            (!(given || side.found) || is_given(body.temperature)) && (!side.found || body.emissivity > 0) &&
            (side.film == 0 || (side.film > 0 && side.film <= FIBRAD_CONDUCTANCE_MAX && is_temperature(side.gas))) &&
            fibrad_abs(side.power) <= FIBRAD_POWER_MAX;
    }
    return valid;
}

/* Whether a wall is endless and of unknown temperature. What it gives off would have no bound. */
static bool is_endless_unknown(const fibrad_heat *heat, const fibrad_heat_sources *s, uint32_t b) {
    const radiator source = of_body(s, b);
    const uint32_t slot = heat->slot[b];
    return slot < FIBRAD_WALLS && heat->wall[slot].unbounded && source.emissivity > 0 && !is_given(source.temperature);
}

/* The film of a sphere or a wall, by the caller's number, and the temperature of its gas. */
typedef struct film_data {
    double conductance, gas;
} film_data;

static film_data film_of(const fibrad_heat *heat, const fibrad_heat_sources *s, uint32_t end) {
    const bool sphere = end < heat->spheres;
    const uint32_t k = sphere ? end : end - heat->spheres;
    const double *film = sphere ? s->film : s->wall_film, *gas = sphere ? s->gas : s->wall_gas;
    if (film == NULL || film[k] == 0) return (film_data){0, 0};
    if (sphere && s->stream != NULL) return (film_data){film[k], s->stream->inlet};
    return (film_data){film[k], gas != NULL ? gas[k] : __builtin_nan("")};
}

/* Whether an end of a contact, by the caller's number, is a wall of given temperature that is not insulated. */
static bool may_have_places(const fibrad_heat *heat, const fibrad_heat_sources *s, uint32_t end) {
    if (end < heat->spheres) return false;
    const uint32_t b = end - heat->spheres;
    return is_given(s->wall_temperature[b]) && (s->insulated == NULL || s->insulated[b] == 0);
}

/* The reason why a contact is not valid. */
static int contact_why(const fibrad_heat *heat, const fibrad_heat_sources *s, uint32_t k) {
    const uint32_t ends = heat->spheres + heat->given_walls;
    if (s->contact_first[k] >= ends || s->contact_second[k] >= ends) return FIBRAD_WHY_CONTACT;
    const double place = or_else(s->contact_temperature, k, __builtin_nan(""));
    if (is_given(place) && !is_temperature(place)) return FIBRAD_WHY_TEMPERATURE;
    if (is_given(place) && !may_have_places(heat, s, s->contact_second[k])) return FIBRAD_WHY_CONTACT;
    return s->conductance[k] >= 0 && s->conductance[k] <= FIBRAD_CONDUCTANCE_MAX ? FIBRAD_WHY_UNSAID
                                                                                 : FIBRAD_WHY_CONDUCTANCE;
}

/* Names the end of a contact in a fault: a sphere or a wall. */
static void name_end(const fibrad_heat *heat, uint32_t end, fibrad_fault *fault) {
    if (end < heat->spheres)
        fault->first = fault->second = end;
    else if (end < heat->spheres + heat->given_walls)
        fault->wall = end - heat->spheres + 1;
}

/* Checks the films of the sources, and marks what has one. */
static void check_films(const fibrad_heat *heat, const fibrad_heat_sources *s, fibrad_fault *fault) {
    fibrad_contacts *c = heat->checked;
    for (uint32_t k = 0; k < heat->spheres + heat->given_walls && fault->why == FIBRAD_WHY_UNSAID; k++) {
        const film_data film = film_of(heat, s, k);
        if (film.conductance == 0) continue;
        if (!(film.conductance > 0 && film.conductance <= FIBRAD_CONDUCTANCE_MAX && is_temperature(film.gas))) {
            fault->why = FIBRAD_WHY_FILM;
            name_end(heat, k, fault);
        }
        c->kind[c->node[k]] = FIBRAD_CONTACT_GIVEN;
    }
}

/* The reason why a stream is not valid. A slice that does not exist is the fault of a sphere. */
static int stream_why(const fibrad_heat *heat, const fibrad_stream *stream, fibrad_fault *fault) {
    if (stream->slice == NULL || stream->at == NULL || stream->capacity == NULL || stream->gas == NULL)
        return FIBRAD_WHY_MISSING;
    bool valid = is_temperature(stream->inlet) && stream->slices > 0 && stream->points > 0;
    for (uint32_t k = 0; k < stream->points && valid; k++)
        valid = is_temperature(stream->at[k]) && (k == 0 || stream->at[k] > stream->at[k - 1]) &&
                stream->capacity[k] > 0 && stream->capacity[k] <= FIBRAD_CONDUCTANCE_MAX;
    for (uint32_t i = 0; i < heat->spheres && valid; i++) {
        valid = stream->slice[i] < stream->slices;
        if (!valid) fault->first = fault->second = i;
    }
    return valid ? FIBRAD_WHY_UNSAID : FIBRAD_WHY_STREAM;
}

/* Checks contacts and films of the sources, and keeps them in heat->checked. A clump is joined by its node. */
static void check_contacts(const fibrad_heat *heat, const fibrad_heat_sources *s, fibrad_fault *fault) {
    fibrad_contacts *c = heat->checked;
    c->count = 0;
    c->joins = fault->why == FIBRAD_WHY_UNSAID && (conducts_between(s) || heat->clumps.some);
    if (!c->joins) return;
    if (s->contacts > 0 && (s->contact_first == NULL || s->contact_second == NULL || s->conductance == NULL)) {
        fault->why = FIBRAD_WHY_MISSING;
        return;
    }
    for (uint32_t k = 0; k < s->contacts; k++) {
        fault->why = contact_why(heat, s, k);
        if (fault->why == FIBRAD_WHY_UNSAID) continue;
        name_end(heat, s->contact_first[k], fault);
        return;
    }
    c->first = s->contact_first, c->second = s->contact_second, c->conductance = s->conductance, c->count = s->contacts;
    c->sigma = s->sigma, c->zero = s->surroundings;
    for (uint32_t b = 0; b < heat->spheres; b++)
        c->node[heat->order[b]] = fibrad_heat_is_member(heat, b) ? heat->clumps.leader[b] : b;
    for (uint32_t k = 0; k < heat->given_walls; k++) c->node[heat->spheres + k] = fibrad_heat_body(heat, heat->slot[k]);
    fibrad_contact_mark(c);
    for (uint32_t b = 0; b < heat->spheres; b++)
        if (fibrad_heat_is_member(heat, b)) c->kind[b] = FIBRAD_CONTACT_GIVEN;
    check_films(heat, s, fault);
    if (s->stream != NULL && fault->why == FIBRAD_WHY_UNSAID) fault->why = stream_why(heat, s->stream, fault);
}

/* Whether a sphere or a wall, by the caller's number, has contacts. */
static bool touches(const fibrad_heat *heat, uint32_t end) {
    return heat->checked->joins && heat->checked->kind[heat->checked->node[end]] != FIBRAD_CONTACT_NONE;
}

/* Whether a wall has one temperature, given or to be found. */
static bool has_one_temperature(const fibrad_heat *heat, const fibrad_heat_sources *s, uint32_t b) {
    const fibrad_mesh *mesh = &heat->scene->mesh;
    bool one = s->insulated == NULL || s->insulated[b] == 0;
    if (heat->slot[b] < FIBRAD_MESHES || !says_sides(s)) return one;
    const uint32_t m = heat->slot[b] - FIBRAD_MESHES;
    for (uint32_t k = mesh->first[m]; k < mesh->first[m + 1]; k++) {
        const fibrad_heat_side side = fibrad_heat_side_of(heat, s, mesh->side[k]);
        one = one && !is_given(side.temperature) && !side.found;
    }
    return one;
}

/* Whether all contacts of a wall have temperatures of their own, and the wall has no film. */
static bool has_places(const fibrad_heat *heat, const fibrad_heat_sources *s, uint32_t b) {
    const fibrad_contacts *c = heat->checked;
    bool all = may_have_places(heat, s, heat->spheres + b) && film_of(heat, s, heat->spheres + b).conductance == 0;
    for (uint32_t k = 0; k < c->count && all; k++)
        if (c->first[k] == heat->spheres + b || c->second[k] == heat->spheres + b)
            all = c->conductance[k] == 0 || (c->second[k] == heat->spheres + b && s->contact_temperature != NULL &&
                                             is_given(s->contact_temperature[k]));
    return all;
}

/* The reason why a wall is not valid. */
static int wall_why(const fibrad_heat *heat, const fibrad_heat_sources *s, uint32_t b) {
    const radiator source = of_body(s, b);
    const bool touched = touches(heat, heat->spheres + b);
    const int why = source_why(&source, touched);
    if (why != FIBRAD_WHY_UNSAID) return why;
    if (!sides_valid(heat, s, b)) return FIBRAD_WHY_SIDE;
    if (touched && !has_one_temperature(heat, s, b) && !has_places(heat, s, b)) return FIBRAD_WHY_TOUCHED;
    return is_endless_unknown(heat, s, b) ? FIBRAD_WHY_ENDLESS : FIBRAD_WHY_UNSAID;
}

static bool light_valid(const fibrad_heat *heat, const double *light) {
    bool valid = true;
    for (uint32_t a = 0; a < heat->patches && light != NULL && valid; a++)
        valid = light[a] >= 0 && light[a] <= FIBRAD_POWER_MAX;
    return valid;
}

/* The reason why the sources as a whole are not valid. */
static int sources_why(const fibrad_heat *heat, const fibrad_heat_sources *s) {
    if (heat->spheres > 0 && (s->temperature == NULL || s->emissivity == NULL)) return FIBRAD_WHY_MISSING;
    if (heat->given_walls > 0 && (s->wall_temperature == NULL || s->wall_emissivity == NULL)) return FIBRAD_WHY_MISSING;
    if (!is_temperature(s->surroundings)) return FIBRAD_WHY_SURROUNDINGS;
    if (!is_sigma(s->sigma)) return FIBRAD_WHY_SIGMA;
    if (!light_valid(heat, s->light) || !light_valid(heat, s->absorbed)) return FIBRAD_WHY_LIGHT;
    return s->tolerance >= 0 && s->tolerance < 1 ? FIBRAD_WHY_UNSAID : FIBRAD_WHY_TOLERANCE;
}

/* Finds what exchanges heat. A given temperature, or `storage`, anchors its component. All that radiate belong to one
 * component. A component that neither radiates nor is anchored has no temperature: then the fault names a sphere. */
static void check_components(const fibrad_heat *heat, const fibrad_heat_sources *s, fibrad_fault *fault) {
    const uint32_t all = heat->bodies, ends = heat->spheres + heat->given_walls;
    fibrad_contacts *c = heat->checked;
    fibrad_contact_parts parts = heat->joined;
    for (uint32_t b = 0; b <= all; b++) parts.root[b] = b, parts.anchored[b] = 0;
    for (uint32_t k = 0; k < c->count; k++)
        if (c->conductance[k] > 0) fibrad_contact_join(&parts, c->node[c->first[k]], c->node[c->second[k]]);
    for (uint32_t k = 0; k < ends; k++)
        if (of_end(heat, s, k).emissivity > 0) fibrad_contact_join(&parts, c->node[k], all);
    for (uint32_t k = 0; k < ends; k++) {
        const radiator source = of_end(heat, s, k);
        if (touches(heat, k) &&
            (is_given(source.temperature) || source.storage > 0 || film_of(heat, s, k).conductance > 0))
            parts.anchored[fibrad_contact_root(&parts, c->node[k])] = 1;
    }
    const uint32_t radiating = fibrad_contact_root(&parts, all);
    c->anchored = parts.anchored[radiating];
    for (uint32_t k = 0; k < heat->spheres; k++) {
        const uint32_t root = fibrad_contact_root(&parts, c->node[k]);
        if (!touches(heat, k) || root == radiating || parts.anchored[root]) continue;
        fault->why = FIBRAD_WHY_ALONE, fault->first = fault->second = k;
        return;
    }
}

/* The reason why the caller's sphere i is not valid. A clump has one temperature. */
static int sphere_why(const fibrad_heat *heat, const fibrad_heat_sources *s, uint32_t i) {
    const radiator source = of_sphere(s, i);
    const double conductivity = or_else(s->conductivity, i, __builtin_inf());
    const uint32_t b = heat->scene->place[i];
    const int why = source_why(&source, touches(heat, i));
    if (why != FIBRAD_WHY_UNSAID) return why;
    if (!(conductivity > 0)) return FIBRAD_WHY_CONDUCTIVITY;
    if (!fibrad_heat_is_member(heat, b)) return FIBRAD_WHY_UNSAID;
    if (fibrad_finite(conductivity)) return FIBRAD_WHY_CLUMP_SOLID;
    const double leader = s->temperature[heat->order[heat->clumps.leader[b]]], own = source.temperature;
    return is_given(own) != is_given(leader) || (is_given(own) && own != leader) ? FIBRAD_WHY_CLUMP_HEAT
                                                                                 : FIBRAD_WHY_UNSAID;
}

int fibrad_heat_check(const fibrad_heat *heat, const fibrad_heat_sources *s, fibrad_fault *fault) {
    if (heat == NULL || s == NULL) return FIBRAD_E_ARGUMENT;
    fibrad_fault found = {heat->spheres, heat->spheres, UINT32_MAX, 0, sources_why(heat, s)};
    check_contacts(heat, s, &found);
    for (uint32_t i = 0; i < heat->spheres && found.why == FIBRAD_WHY_UNSAID; i++) {
        found.why = sphere_why(heat, s, i);
        if (found.why != FIBRAD_WHY_UNSAID) found.first = found.second = i;
    }
    for (uint32_t b = 0; b < heat->given_walls && found.why == FIBRAD_WHY_UNSAID; b++) {
        found.why = wall_why(heat, s, b);
        if (found.why != FIBRAD_WHY_UNSAID) found.wall = b + 1;
    }
    if (found.why == FIBRAD_WHY_UNSAID && heat->checked->joins) check_components(heat, s, &found);
    if (fault != NULL) *fault = found;
    if (found.why == FIBRAD_WHY_UNSAID) return FIBRAD_OK;
    return found.why == FIBRAD_WHY_ENDLESS ? FIBRAD_E_UNSUPPORTED
           : found.why == FIBRAD_WHY_ALONE ? FIBRAD_E_UNSOLVABLE
                                           : FIBRAD_E_ARGUMENT;
}

/* sigma (T^4 - T0^4), T0 being the temperature of the surroundings. All emissions and radiosities are such differences.
 */
static double emission_of(const fibrad_heat_sources *s, double t) {
    const double t0 = s->surroundings;
    return s->sigma * (t * t + t0 * t0) * (t + t0) * (t - t0);
}

/* The temperature at which a mesh would emit as much as its sides do at their own temperatures. */
static double mean_temperature(const fibrad_heat *heat, const fibrad_heat_sources *s, uint32_t m, double of_body) {
    const fibrad_mesh *mesh = &heat->scene->mesh;
    double sum = 0, area = 0;
    for (uint32_t k = mesh->first[m]; k < mesh->first[m + 1]; k++) {
        const double t = side_temperature(heat, s, mesh->side[k], of_body);
        const double own = fibrad_mesh_triangle_area(mesh, fibrad_side_triangle(mesh->side[k]));
        sum += own * (t * t) * (t * t), area += own;
    }
    return area > 0 ? fibrad_sqrt(fibrad_sqrt(sum / area)) : of_body;
}

/* Finds the excess of each patch of a mesh: its emission minus that of the mesh at the temperature `mean`. A patch of
 * several sides has their mean. */
static void find_excess(fibrad_heat *heat, const fibrad_heat_sources *s, uint32_t m, double of_body, double mean) {
    const fibrad_mesh *mesh = &heat->scene->mesh;
    const uint32_t *first = heat->first + fibrad_heat_body(heat, FIBRAD_MESHES + m);
    double *excess = heat->sources.excess + (first[0] - fibrad_heat_first_meshed(heat)), *area = heat->solution.source;
    fibrad_zero(excess, (first[1] - first[0]) * sizeof *excess);
    fibrad_zero(area, (first[1] - first[0]) * sizeof *area);
    for (uint32_t k = mesh->first[m]; k < mesh->first[m + 1]; k++) {
        const fibrad_mesh_cut cut = *fibrad_mesh_cut_of(mesh, heat->cut, mesh->side[k]);
        if (cut.patch == UINT32_MAX) continue;
        const double own = fibrad_mesh_triangle_area(mesh, fibrad_side_triangle(mesh->side[k]));
        const double more = emission_of(s, side_temperature(heat, s, mesh->side[k], of_body)) - emission_of(s, mean);
        const uint32_t from = fibrad_heat_first_meshed(heat) + cut.patch - first[0];
        for (uint32_t a = from; a < from + (UINT32_C(1) << cut.halvings); a++) excess[a] += own * more, area[a] += own;
    }
    for (uint32_t a = 0; a < first[1] - first[0]; a++) excess[a] = area[a] > 0 ? excess[a] / area[a] : 0;
}

/* Widens a range of emissions by the emission of a body, if it emits and its temperature or reference is given. */
static void widen_range(double range[2], const fibrad_heat_sources *s, const radiator *source) {
    const double t = is_given(source->temperature) ? source->temperature : source->reference;
    if (source->emissivity == 0 || !is_given(t)) return;
    const double emission = emission_of(s, t);
    range[0] = fibrad_min(range[0], emission), range[1] = fibrad_max(range[1], emission);
}

/* The middle of the range of emissions. Radiosities of surfaces that reflect all begin here. So nothing flows if all
 * that emit have the same emission. 0: no surface emits. */
static double middle_emission(const fibrad_heat *heat, const fibrad_heat_sources *s) {
    double range[2] = {__builtin_inf(), -__builtin_inf()};
    for (uint32_t i = 0; i < heat->spheres; i++) {
        const radiator source = of_sphere(s, i);
        widen_range(range, s, &source);
    }
    const radiator opening = of_opening(s);
    if (heat->openings != 0) widen_range(range, s, &opening);
    for (uint32_t b = 0; b < heat->given_walls; b++) {
        const radiator source = of_body(s, b);
        widen_range(range, s, &source);
        if (heat->slot[b] < FIBRAD_MESHES || s->side_temperature == NULL) continue;
        const uint32_t *first = heat->scene->mesh.first + (heat->slot[b] - FIBRAD_MESHES);
        for (uint32_t k = first[0]; k < first[1]; k++) {
            radiator side = source;
            side.temperature = side_temperature(heat, s, heat->scene->mesh.side[k], source.temperature);
            widen_range(range, s, &side);
        }
    }
    return range[0] <= range[1] ? range[0] + 0.5 * (range[1] - range[0]) : 0;
}

/* Whether a body has contacts, or is in a clump, in the solution that begins. */
static bool in_contact(const fibrad_heat *heat, uint32_t b) {
    return heat->contacts.joins && heat->contacts.kind[b] != FIBRAD_CONTACT_NONE;
}

/* The emission of a body if it is given. Otherwise the emission with which the search begins: that of its reference, of
 * the last solution, or `middle`. */
static double first_emission(const fibrad_heat *heat, const fibrad_heat_sources *s, double middle, uint32_t b,
                             const radiator *source) {
    if (source->emissivity == 0 && !in_contact(heat, b)) return middle;
    if (is_given(source->temperature)) return emission_of(s, source->temperature);
    if (is_given(source->reference)) return emission_of(s, source->reference);
    return heat->solution.warm ? heat->sources.emission[b] + emission_of(s, heat->sources.surroundings) : middle;
}

/* Sets emissivity and emission of a body. The radiosities of an earlier solution are shifted by the change of emission.
 * Their detail is taken off, since the coarser level comes first. */
static void set_emission(fibrad_heat *heat, uint32_t b, double eps, double emission) {
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++)
        if (heat->solution.warm && (eps < 1 || fibrad_heat_conducts(heat, b)))
            heat->solution.radiosity[a] += emission - heat->sources.emission[b] - heat->solution.detail[a];
        else
            heat->solution.radiosity[a] = emission, heat->solution.detail[a] = 0;
    heat->sources.emissivity[b] = eps, heat->sources.emission[b] = emission;
    heat->sources.given_power[b] = 0, heat->sources.storage[b] = -1;
}

static void set_body(fibrad_heat *heat, const fibrad_heat_sources *s, double middle, uint32_t b,
                     const radiator *source) {
    const bool dark = source->emissivity == 0, touching = in_contact(heat, b);
    const bool follows = fibrad_heat_follows(heat, b);
    const double emission =
        follows ? heat->sources.emission[heat->clumps.leader[b]] : first_emission(heat, s, middle, b, source);
    if (dark && touching) heat->sources.emission[b] = middle; /* its radiosities do not follow its own emission */
    set_emission(heat, b, source->emissivity, dark ? middle : emission);
    heat->sources.emission[b] = emission;
    heat->sources.temperature[b] = dark && !touching ? __builtin_nan("") : source->temperature;
    if ((dark && !touching) || is_given(source->temperature)) return;
    heat->sources.storage[b] = source->storage;
    heat->sources.given_power[b] =
        source->power + (source->storage > 0 ? source->storage * emission_of(s, source->reference) : 0);
    if (touching) heat->contacts.kind[b] = follows ? FIBRAD_CONTACT_FOLLOWS : FIBRAD_CONTACT_FREE;
}

/* Adds `times` emissivity times excess to the radiosities of a mesh. */
static void shift_radiosities(fibrad_heat *heat, uint32_t b, double times) {
    const double *excess = fibrad_heat_excess(heat, b);
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1] && excess != NULL; a++)
        heat->solution.radiosity[a] += times * heat->sources.emissivity[b] * excess[a - heat->first[b]];
}

static void set_mesh(fibrad_heat *heat, const fibrad_heat_sources *s, double middle, uint32_t m, radiator source) {
    const uint32_t b = fibrad_heat_body(heat, FIBRAD_MESHES + m);
    const double own = source.temperature;
    if (heat->solution.warm) shift_radiosities(heat, b, -1);
    const bool kept = heat->solution.warm && heat->sources.has_sides[m] && is_given(heat->sources.temperature[b]);
    const fibrad_mesh *mesh = &heat->scene->mesh;
    bool *has = &heat->sources.has_sides[m];
    *has = false, heat->sources.of_others[m] = own;
    for (uint32_t k = mesh->first[m]; k < mesh->first[m + 1] && is_given(own) && says_sides(s); k++)
        *has = *has || fibrad_heat_side_of(heat, s, mesh->side[k]).found;
    heat->sources.sides = heat->sources.sides || *has;
    heat->sources.has_excess[m] = *has || (s->side_temperature != NULL && is_given(own) && source.emissivity > 0);
    if (*has && kept) {
        source.temperature = heat->sources.temperature[b];
    } else if (heat->sources.has_excess[m]) {
        source.temperature = mean_temperature(heat, s, m, own);
        find_excess(heat, s, m, own, source.temperature);
        heat->sources.beyond[m] = heat->solution.coarse[b] = 0;
    }
    set_body(heat, s, middle, b, &source);
    shift_radiosities(heat, b, 1);
}

/* The radiosity of an endless wall beyond its patches. There it receives what the surroundings send, or the wall that
 * it faces. What the patches send is nothing beside that. So the part beyond the patches is like a black body of this
 * radiosity. */
static double radiosity_beyond(const fibrad_heat *heat, uint32_t k) {
    const uint32_t facing = fibrad_heat_facing(heat, k);
    const double taken = fibrad_heat_taken_beyond(heat, k),
                 other = facing < FIBRAD_WALLS ? heat->sources.wall_emission[facing] : 0;
    return taken * heat->sources.wall_emission[k] + (1 - taken) * other;
}

static void set_walls(fibrad_heat *heat, const fibrad_heat_sources *s, double middle) {
    static const radiator absent = {0, 0, 0, 0, 0};
    radiator source[FIBRAD_SLOTS];
    for (uint32_t k = 0; k < FIBRAD_SLOTS; k++)
        source[k] = fibrad_is_opening(&heat->scene->container, k) ? of_opening(s) : absent;
    fibrad_zero(heat->sources.insulated, sizeof heat->sources.insulated);
    for (uint32_t b = 0; b < heat->given_walls; b++) {
        source[heat->slot[b]] = of_body(s, b);
        heat->sources.insulated[fibrad_heat_body(heat, heat->slot[b]) - heat->spheres] =
            s->insulated != NULL && s->insulated[b] != 0;
    }
    for (uint32_t k = 0; k < FIBRAD_WALLS; k++) {
        const bool emits = source[k].emissivity > 0 && is_given(source[k].temperature);
        heat->sources.wall_emission[k] = emits ? emission_of(s, source[k].temperature) : 0;
        set_body(heat, s, middle, fibrad_heat_body(heat, k), &source[k]);
    }
    for (uint32_t k = 0; k < FIBRAD_WALLS; k++)
        set_emission(heat, fibrad_heat_beyond(heat, k), 1, radiosity_beyond(heat, k));
    for (uint32_t m = 0; m < heat->meshes; m++) set_mesh(heat, s, middle, m, source[FIBRAD_MESHES + m]);
    set_emission(heat, heat->bodies - 1, 1, 0);
}

/* Sets the conductivities of spheres, and their unevenness at the emissions with which the search begins. */
static void set_conduction(fibrad_heat *heat, const fibrad_heat_sources *s) {
    bool found = false;
    for (uint32_t b = 0; b < heat->spheres; b++) {
        heat->sources.conductivity[b] = or_else(s->conductivity, heat->order[b], __builtin_inf());
        found = found || heat->sources.storage[b] >= 0;
    }
    fibrad_heat_find_unevenness(heat, -1);
    heat->sources.first_tolerance = (heat->sources.conducts || s->stream != NULL) && found && !heat->solution.warm
                                        ? FIBRAD_HEAT_FIRST_TOLERANCE
                                        : 0;
}

/* Lets the films of spheres end in the gas of a stream. */
static void begin_stream(fibrad_heat *heat, const fibrad_stream *stream) {
    fibrad_contacts *c = &heat->contacts;
    c->stream = stream;
    if (stream == NULL) return;
    for (uint32_t k = 0; k < stream->slices; k++)
        if (!(stream->gas[k] > 0)) stream->gas[k] = stream->inlet;
    for (uint32_t b = 0; b < heat->bodies; b++)
        c->slice[b] = b < heat->spheres && heat->film[b] > 0 ? stream->slice[heat->order[b]] : UINT32_MAX;
    for (uint32_t b = 0; b < heat->spheres; b++)
        if (c->slice[b] != UINT32_MAX) heat->gas[b] = stream->gas[c->slice[b]];
}

/* Puts the films of the members of a clump together, at the mean temperature of their gas. */
static void join_films(fibrad_heat *heat) {
    fibrad_contacts *c = &heat->contacts;
    for (uint32_t b = 0; b < heat->bodies; b++) {
        const double film = heat->film[b];
        const uint32_t node = fibrad_heat_follows(heat, b) ? heat->clumps.leader[b] : b;
        c->film[b] = 0, c->gas[b] = heat->gas[b];
        if (!(film > 0)) continue;
        if (c->film[node] > 0)
            c->gas[node] += film / (c->film[node] + film) * (heat->gas[b] - c->gas[node]);
        else
            c->gas[node] = heat->gas[b];
        c->film[node] += film;
    }
}

/* Takes over the contacts and films that were checked. */
static void begin_contacts(fibrad_heat *heat, const fibrad_heat_sources *s) {
    fibrad_contacts *c = &heat->contacts, *checked = heat->checked;
    c->count = checked->count, c->joins = checked->joins;
    if (!c->joins) return;
    c->first = checked->first, c->second = checked->second, c->conductance = checked->conductance;
    c->sigma = checked->sigma, c->zero = checked->zero, c->anchored = checked->anchored;
    fibrad_copy(c->node, checked->node, (heat->spheres + heat->given_walls) * sizeof *c->node);
    fibrad_copy(c->kind, checked->kind, heat->bodies);
    for (uint32_t b = 0; b < heat->spheres; b++) heat->end[heat->order[b]] = b;
    for (uint32_t k = 0; k < heat->given_walls; k++)
        heat->end[heat->spheres + k] = fibrad_heat_body(heat, heat->slot[k]);
    fibrad_zero(heat->film, heat->bodies * sizeof *heat->film);
    for (uint32_t k = 0; k < heat->spheres + heat->given_walls; k++) {
        const film_data film = film_of(heat, s, k);
        heat->film[heat->end[k]] = film.conductance, heat->gas[heat->end[k]] = film.gas;
    }
    begin_stream(heat, s->stream);
    c->own_film = heat->film, c->own_gas = heat->gas, c->leader = heat->clumps.some ? heat->clumps.leader : NULL;
    if (heat->scene->clump != NULL) join_films(heat);
}

/* Divides the memory for contacts at their places. It is used if a sphere conducts and has contacts. */
static void begin_spots(fibrad_heat *heat, const fibrad_heat_sources *s) {
    const uint32_t n = heat->contacts.count;
    double *at = s->contact_places;
    heat->spots = (fibrad_heat_spots){0};
    if (n == 0 || at == NULL || !heat->sources.conducts) return;
    heat->spots = (fibrad_heat_spots){
        s->conductance, at, at + n, at + 2 * (size_t)n, at + 3 * (size_t)n, at + 4 * (size_t)n, at + 5 * (size_t)n};
    fibrad_copy(at, s->conductance, n * sizeof *at);
    fibrad_zero(at + n, (4 * (size_t)n + heat->patches) * sizeof *at);
    heat->contacts.conductance = at;
    heat->sources.first_tolerance = FIBRAD_HEAT_FIRST_TOLERANCE;
    fibrad_heat_make_rings(heat);
}

int fibrad_heat_begin(fibrad_heat *heat, const fibrad_heat_sources *sources) {
    const int status = fibrad_heat_check(heat, sources, NULL);
    if (status != FIBRAD_OK) return status;
    if (!fibrad_heat_scene_kept(heat)) return FIBRAD_E_STATE;
    for (uint32_t task = 0; task < fibrad_heat_tasks(heat); task++)
        if (!heat->traced[task]) return FIBRAD_E_STATE;
    const double middle = middle_emission(heat, sources);
    begin_contacts(heat, sources);
    /* Thermal radiation does not begin with the radiosities of light, nor light with those of thermal radiation. */
    if ((sources->light != NULL) != (heat->sources.light != NULL)) heat->solution.warm = false;
    for (uint32_t b = 0; b < heat->spheres; b++) {
        const radiator source = of_sphere(sources, heat->order[b]);
        set_body(heat, sources, middle, b, &source);
    }
    heat->sources.asked = *sources;
    heat->sources.sides = heat->sources.passed = false;
    set_walls(heat, sources, middle);
    bool unknown = heat->sources.sides;
    for (uint32_t b = 0; b < heat->bodies; b++) unknown = unknown || heat->sources.storage[b] == 0;
    heat->sources.light = sources->light, heat->sources.absorbed = sources->absorbed;
    heat->sources.sigma = sources->sigma, heat->sources.surroundings = sources->surroundings;
    heat->solution.group = FIBRAD_HEAT_FOUR;
    heat->sources.tolerance = sources->tolerance > 0 ? sources->tolerance : default_tolerance(heat, sources, unknown);
    heat->sources.settled = heat->sources.tolerance;
    if (unknown)
        heat->sources.settled =
            fibrad_max(heat->sources.tolerance,
                       fibrad_min(HEAT_TOLERANCE, HEAT_TOLERANCE / FREE_TOLERANCE * heat->sources.tolerance));
    heat->sources.limit = sources->sweeps_max > 0 ? sources->sweeps_max : HEAT_SWEEPS_MAX;
    fibrad_zero(heat->solution.span, heat->spheres * sizeof *heat->solution.span);
    set_conduction(heat, sources);
    begin_spots(heat, sources);
    heat->contacts.sigma = sources->sigma, heat->contacts.zero = sources->surroundings;
    heat->solution.sweeps = 0;
    heat->contacts.afresh = !heat->solution.warm;
    heat->solution.warm = false;
    fibrad_zero(heat->swept, heat->config.parts);
    fibrad_heat_start(heat);
    return FIBRAD_OK;
}
