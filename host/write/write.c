/* write.c - names of walls and columns of heat for all writers. SPDX-License-Identifier: MIT */
#include "write/write.h"

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
