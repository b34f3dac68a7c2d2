/* heat_bed.c - the heat problem of one bed, from options and columns, and what is written of it.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "heat/heat.h"

/* Allocates the arrays of the result, those of spheres in one block. The last INSIDE are of spheres that conduct. */
static int make_arrays(struct heat *h) {
    enum { ARRAYS = 9, INSIDE = 5 };
    fibrad_heat_result *r = &h->result;
    double **const of_spheres[ARRAYS] = {&r->power,         &r->temperature_error,   &r->power_error,
                                         &r->temperature,   &r->least_temperature,   &r->centre_temperature,
                                         &r->surface_error, &r->largest_temperature, &r->centre_error};
    double *block = calloc(ARRAYS * (size_t)h->bed->n + 1, sizeof *block);
    for (size_t k = 0; block && k < (h->solid.given ? ARRAYS : ARRAYS - INSIDE); ++k)
        *of_spheres[k] = block + k * h->bed->n;
    r->wall_power = h->of_walls[0], r->wall_temperature = h->of_walls[1];
    r->wall_error = h->of_walls[2], r->wall_temperature_error = h->of_walls[3];
    r->wall_absorbed = h->of_walls[4], r->wall_area = h->of_walls[5];
    return block ? STATUS_OK : message_memory();
}

/* Allocates the arrays of triangles. */
static int make_triangles(struct heat *h) {
    static const struct side_quantity quantity[TRIANGLE_QUANTITIES] = {
        {.name = {"flux_W_m2", "flux_front_W_m2", "flux_back_W_m2"}, .join = sum_of_sides},
        {.name = {"temperature_K", "temperature_front_K", "temperature_back_K"}, .join = mean_of_sides}};
    if (!h->options.wall_vtp) return STATUS_OK;
    return side_arrays_begin(&h->triangles, &h->walls.meshes->triangles, quantity, TRIANGLE_QUANTITIES);
}

/* Finds the conductivities of the solid, and allocates room for them in the unit of the library. In time powers are in
 * watts, and sigma has the square of the unit of length. */
static int find_conductivities(struct heat *h) {
    const uint32_t n = h->bed->n;
    if (!h->solid.given) return STATUS_OK;
    const int status = solid_values(&h->options, h->bed, &h->solid, &h->conductivity);
    if (status) return status;
    h->sources.conductivity = h->conductivity_scaled = calloc(n, sizeof *h->conductivity_scaled);
    h->per_watt = h->given.timed ? h->bed->metres : 1 / h->bed->metres;
    for (uint32_t i = 0; i < n && h->conductivity_scaled; ++i)
        h->conductivity_scaled[i] = h->conductivity[i] * h->per_watt;
    return h->conductivity_scaled ? STATUS_OK : message_memory();
}

/* Warns of temperatures. If none is given within a closed bed, that of the surroundings is the level. */
static void warn_levels(struct heat *h) {
    struct warned *warned = &h->options.warned;
    double hottest = -1;
    const char *column = bed_options_column(&h->options, &h->given.temperature);
    if (column && h->given.zero == 0) warn_celsius(warned, column);
    for (uint32_t i = 0; i < h->bed->n; ++i) hottest = fmax(hottest, h->values.temperature[i]);
    for (uint32_t k = 0; k < h->walls.count; ++k) hottest = fmax(hottest, h->values.wall_temperature[k]);
    warn_waves(warned, h->bed, fmax(hottest, h->given.surroundings)); /* not a number where none is given */
    if (h->given.ambient && hottest >= 0 && walls_closed(&h->walls, h->bed)) warn_closed(warned);
}

/* Reads what is given of spheres and walls, and makes sure of the unit of length. */
static int read_values(struct heat *h, struct bed *bed) {
    const char *needed = h->solid.given                 ? SOLID_NEEDS
                         : contacts_given(&h->contacts) ? CONTACTS_NEED
                         : film_given(h)                ? "--convection needs"
                         : h->coupled                   ? "fibrad couple needs"
                                                        : NULL;
    struct walls opened;
    int status = bed_options_walls(&h->options, bed, &h->walls);
    if (!status) status = given_values(&h->given, bed, h->options.name, &h->walls, &h->values);
    if (!status && !h->given.ambient && !walls_closed(&h->walls, bed))
        status =
            message(STATUS_USAGE, "--ambient is missing: the bed is open, and the surroundings need a temperature");
    for (uint32_t k = 0; k < h->walls.count && !status; ++k) h->wall_emissivity[k] = h->walls.said[k].emissivity;
    if (!status)
        status = quantity_values(&h->emissivities, bed, h->options.name, "emissivity", 0, 0, 1, &h->emissivity);
    opened = h->walls;
    if (!status) status = face_begin(h, &opened);
    if (!status) status = light_begin(h);
    if (!status && !h->given.timed && !contacts_given(&h->contacts) && !film_given(h)) /* joined: by the library */
        status = given_reflectors(&h->values, h->emissivity, &h->walls, h->wall_emissivity, bed, h->options.name);
    if (!status) status = bed_options_metres(&h->options, bed, needed);
    if (!status) status = bed_options_make(&h->options, bed, &opened, &h->made);
    return status ? status : clumps_begin(h);
}

/* An insulated wall in contact has one temperature, and the power 0. */
static void join_insulated(struct heat *h) {
    const fibrad_heat_sources *s = &h->sources;
    for (uint32_t c = 0; c < 2 * s->contacts; ++c) {
        const uint32_t end = (c % 2 ? s->contact_second : s->contact_first)[c / 2], k = end - h->bed->n;
        if (end < h->bed->n || !h->values.insulated[k] || wall_endless(&h->walls, h->bed, &h->walls.wall[k])) continue;
        h->values.insulated[k] = 0, h->values.wall_temperature[k] = NAN, h->values.wall_power[k] = 0;
        warn_joined(&h->options.warned, wall_name(&h->walls, k));
    }
}

int heat_find_places(struct heat *h, const bool *more) {
    const struct given *given = &h->values;
    bool own[WALLS_MAX] = {false}, any = false;
    for (uint32_t k = 0; k < h->walls.count; ++k)
        own[k] = given->column[k].n > 0 || (more && more[k]), any = any || own[k];
    if (h->touching.n == 0 || !any) return STATUS_OK;
    const int status = contacts_find_places(&h->touching, h->bed, &h->walls, own);
    if (!status) contacts_place(&h->touching, h->bed->n, given->side_temperature, given->wall_temperature);
    h->sources.contact_temperature = h->touching.temperature;
    return status;
}

int heat_begin(struct heat *h, struct bed *bed) {
    fibrad_heat_sources *sources = &h->sources;
    memset(&h->bed, 0, sizeof *h - offsetof(struct heat, bed));
    h->bed = bed;
    fibrad_heat_sources_init(sources);
    int status = read_values(h, bed);
    if (status) return status;
    warn_levels(h);
    status = make_arrays(h);
    if (!status) status = profile_begin(h);
    if (!status) status = find_conductivities(h);
    if (!status) status = make_triangles(h);
    if (status) return status;
    const double unit = h->given.timed ? 1 : bed->metres * bed->metres; /* areas of the library are in the bed's unit */
    given_heat_sources(&h->values, bed->n, unit, sources);
    sources->surroundings = h->given.surroundings;
    sources->emissivity = h->emissivity, sources->wall_emissivity = h->wall_emissivity;
    status =
        contacts_begin(&h->touching, &h->contacts, &h->options, bed, h->made, &h->walls, &h->solid, 1 / unit, sources);
    contacts_result(&h->touching, &h->result);
    if (!status) join_insulated(h);
    if (!status) status = heat_find_places(h, NULL);
    if (!status) status = film_begin(h, 1 / unit);
    return status;
}

bool heat_insulates(const struct heat *h) {
    bool any = false;
    for (uint32_t k = 0; k < h->walls.count; ++k) any |= h->sources.insulated[k];
    return any;
}

void heat_end(struct heat *h) {
    fibrad_bed_free(h->made);
    free(h->emissivity);
    light_free(&h->lit);
    contacts_free(&h->touching);
    film_free(&h->films);
    clumps_free(&h->clumps);
    given_free(&h->values);
    free(h->conductivity);
    free(h->conductivity_scaled);
    free(h->result.power);
    side_arrays_free(&h->triangles);
}

void heat_follow(void *heat, const double *temperature, const double *wall_temperature, double *emissivity,
                 double *wall_emissivity) {
    struct heat *h = heat;
    (void)wall_emissivity;
    quantity_follow(&h->emissivities, h->bed, temperature, emissivity);
    if (h->conductivity) quantity_follow(&h->solid, h->bed, temperature, h->conductivity);
    for (uint32_t i = 0; i < h->bed->n && h->conductivity; ++i)
        h->conductivity_scaled[i] = h->conductivity[i] * h->per_watt;
    contacts_follow(&h->touching, h->bed, temperature, wall_temperature);
}

void heat_excess_of(struct heat *h, const double *temperature, const double *wall_temperature,
                    struct table_excess excess[TABLES]) {
    quantity_excess(&h->emissivities, h->bed, temperature, &excess[0]);
    quantity_excess(&h->solid, h->bed, temperature, &excess[1]);
    contacts_excess(&h->touching, h->bed, temperature, wall_temperature, &excess[2]);
}

void heat_warn_excess(struct heat *h, const struct table_excess excess[TABLES]) {
    warn_table(&h->options.warned, EMISSIVITY_TABLE, &excess[0]);
    warn_table(&h->options.warned, SOLID_TABLE, &excess[1]);
    contacts_warn(&h->options.warned, &excess[2]);
}

int heat_write(struct heat *h, const struct bed *bed, struct contents *what) {
    what->walls = &h->walls, what->result = &h->result;
    if (!what->sources) what->sources = &h->sources;
    what->light = h->lit.options ? &h->lit.result : NULL;
    what->of_sides = &h->triangles;
    int status = clumps_result(h, bed, what);
    if (!status) status = bed_options_write(&h->options, bed, what);
    if (!status) status = profile_write(h, what);
    return status ? status : contacts_write(&h->touching, bed, &h->walls);
}
