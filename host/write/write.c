/* write.c - names of walls and columns of heat for all writers. SPDX-License-Identifier: MIT */
#include "write/write.h"

#include <math.h>
#include <string.h>

const char *contents_wall(const struct contents *what, uint32_t k, char name[WALL_NAME]) {
    if (what->walls->wall[k].kind) return wall_name(what->walls, k);
    snprintf(name, WALL_NAME, "wall_%u", k + 1);
    return name;
}

void heat_columns(const struct contents *what, struct heat_column column[HEAT_COLUMNS]) {
    const fibrad_heat_result *r = what->result;
    const fibrad_light_result *light = what->light;
    const struct heat_column all[HEAT_COLUMNS] = {{"T_K", r->temperature, NULL},
                                                  {"q_W", r->power, NULL},
                                                  {"q_error_W", r->power_error, NULL},
                                                  {"T_error_K", r->temperature_error, NULL},
                                                  {"T_min_K", r->least_temperature, NULL},
                                                  {"T_max_K", r->largest_temperature, NULL},
                                                  {"T_surface_error_K", r->surface_error, NULL},
                                                  {"T_centre_K", r->centre_temperature, NULL},
                                                  {"T_centre_error_K", r->centre_error, NULL},
                                                  {"absorbed_first_W", light ? light->absorbed_first : NULL, NULL},
                                                  {"absorbed_W", light ? light->absorbed : NULL, NULL},
                                                  {"q_radiation_W", r->conducted ? r->power : NULL, r->conducted},
                                                  {"q_conduction_W", r->conducted, NULL}};
    memcpy(column, all, sizeof all);
}

const char *heat_outside(const struct contents *what, int64_t k, char own[WALL_NAME], double value[HEAT_COLUMNS]) {
    const fibrad_heat_result *r = what->result;
    const fibrad_light_result *light = what->light;
    const bool out = k < 0;
    const double kelvins = out ? what->sources->surroundings : r->wall_temperature[k],
                 power = out ? r->surroundings_power : r->wall_power[k],
                 error = out ? r->surroundings_error : r->wall_error[k],
                 conducted = out || !r->conducted ? 0 : r->wall_conducted[k],
                 first = !light ? 0
                         : out  ? light->transmitted
                                : light->wall_absorbed_first[k],
                 absorbed = !light ? 0
                            : out  ? light->transmitted + light->reflected
                                   : light->wall_absorbed[k];
    const double all[HEAT_COLUMNS] = {kelvins,  power, error,    out ? 0 : r->wall_temperature_error[k],
                                      NAN,      NAN,   NAN,      NAN,
                                      NAN,      first, absorbed, power - conducted,
                                      conducted};
    memcpy(value, all, sizeof all);
    if (out) return isnan(kelvins) ? NULL : "surroundings";
    return contents_wall(what, (uint32_t)k, own);
}
