/* heat_options.h - what the commands `heat` and `couple` share. SPDX-License-Identifier: MIT */
#ifndef HEAT_OPTIONS_H
#define HEAT_OPTIONS_H

#include "command/commands.h"
#include "heat/heat.h"

/* The options of `fibrad heat`, for a request that begins with a struct heat, and paragraphs of its help. */
extern const struct option heat_options[];
extern const char *const heat_more[];

/* Keys of --wall that have a meaning. */
#define HEAT_WALL_KEYS (WALL_HEAT | WALL_EMISSIVITY | WALL_ABSORPTIVITY | WALL_CONVECTION | WALL_GAS | WALL_CAPACITY)

/* Checks the options when all have been read. Free them also after an error. Status 0, STATUS_USAGE, or as curve_read.
 */
int heat_check(struct heat *heat, const char *command);
void heat_free(struct heat *heat);

#endif
