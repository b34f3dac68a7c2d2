/* write.c - names of walls and columns of heat for all writers. SPDX-License-Identifier: MIT */
#include "write/write.h"

#include <math.h>
#include <string.h>

const char *contents_wall(const struct contents *what, uint32_t k, char name[WALL_NAME]) {
    if (what->walls->wall[k].kind) return wall_name(what->walls, k);
    snprintf(name, WALL_NAME, "wall_%u", k + 1);
    return name;
}

struct contents contents_table(const struct contents *what) {
    struct contents table = *what;
    if (what->bodies)
        table.bed = what->bodies, table.result = what->of_bodies, table.area = what->area_of_bodies,
        table.melted = what->melted_of_bodies;
    return table;
}

void heat_columns(const struct contents *what, struct heat_column column[HEAT_COLUMNS]) {
    const fibrad_heat_result *r = what->result;
    const fibrad_light_result *light = what->light;
    const double *parts = r->conducted || r->convected ? r->power : NULL;
    const struct heat_column all[HEAT_COLUMNS] = {
        {"T_K", r->temperature, NULL, NULL},
        {"q_W", r->power, NULL, NULL},
        {"q_error_W", r->power_error, NULL, NULL},
        {"T_error_K", r->temperature_error, NULL, NULL},
        {"T_min_K", r->least_temperature, NULL, NULL},
        {"T_max_K", r->largest_temperature, NULL, NULL},
        {"T_surface_error_K", r->surface_error, NULL, NULL},
        {"T_centre_K", r->centre_temperature, NULL, NULL},
        {"T_centre_error_K", r->centre_error, NULL, NULL},
        {"absorbed_first_W", light ? light->absorbed_first : NULL, NULL, NULL},
        {"absorbed_W", light ? light->absorbed : NULL, NULL, NULL},
        {"q_radiation_W", parts, r->conducted, r->convected},
        {"q_conduction_W", r->conducted, NULL, NULL},
        {"q_convection_W", r->convected, NULL, NULL},
        {"melted", what->melted, NULL, NULL},
        {"area_m2", what->area, NULL, NULL}};
    memcpy(column, all, sizeof all);
}

const char *heat_outside(const struct contents *what, int64_t k, char own[WALL_NAME], double value[HEAT_COLUMNS]) {
    const fibrad_heat_result *r = what->result;
    const fibrad_light_result *light = what->light;
    for (int c = 0; c < HEAT_COLUMNS; ++c)
        value[c] = (c >= HEAT_INSIDE && c < HEAT_LIGHT) || c >= HEAT_MELTED ? NAN : 0;
    if (k == what->walls->count) {
        const fibrad_stream *stream = what->sources->stream;
        value[HEAT_TEMPERATURE] = stream ? stream->gas[stream->slices - 1] : NAN, value[HEAT_TEMPERATURE_ERROR] = NAN;
        value[HEAT_POWER] = value[HEAT_PARTS + 2] = r->gas_power, value[HEAT_POWER_ERROR] = r->gas_error;
        return r->convected ? "gas" : NULL;
    }
    if (k < 0) {
        value[HEAT_TEMPERATURE] = what->sources->surroundings;
        value[HEAT_POWER] = value[HEAT_PARTS] = r->surroundings_power, value[HEAT_POWER_ERROR] = r->surroundings_error;
        if (light)
            value[HEAT_LIGHT] = light->transmitted, value[HEAT_LIGHT + 1] = light->transmitted + light->reflected;
        return isnan(value[HEAT_TEMPERATURE]) ? NULL : "surroundings";
    }
    if (what->area) value[HEAT_AREA] = r->wall_area[k];
    value[HEAT_TEMPERATURE] = r->wall_temperature[k], value[HEAT_TEMPERATURE_ERROR] = r->wall_temperature_error[k];
    value[HEAT_POWER] = r->wall_power[k], value[HEAT_POWER_ERROR] = r->wall_error[k];
    if (light) value[HEAT_LIGHT] = light->wall_absorbed_first[k], value[HEAT_LIGHT + 1] = light->wall_absorbed[k];
    if (r->conducted) value[HEAT_PARTS + 1] = r->wall_conducted[k];
    if (r->convected) value[HEAT_PARTS + 2] = r->wall_convected[k];
    value[HEAT_PARTS] = r->wall_power[k] - value[HEAT_PARTS + 1] - value[HEAT_PARTS + 2];
    return contents_wall(what, (uint32_t)k, own);
}
