/* heat_options.h - what the commands `heat` and `couple` share. SPDX-License-Identifier: MIT */
#ifndef HEAT_OPTIONS_H
#define HEAT_OPTIONS_H

#include "command/commands.h"
#include "heat/heat.h"

/* The options of `fibrad heat`, for structs that begin with a struct heat; and the paragraphs of its help. Both end
 * with NULL. */
extern const struct option heat_options[];
extern const char *const heat_more[];

/* Keys of --wall that have a meaning for `heat` and `couple`. */
#define HEAT_WALL_KEYS (WALL_HEAT | WALL_EMISSIVITY | WALL_ABSORPTIVITY | WALL_CONVECTION | WALL_GAS | WALL_CAPACITY)

/* Checks the options when all have been read. command: its name, for messages. Call heat_free also after an error.
 * Status 0, STATUS_USAGE, or as curve_read. */
int heat_check(struct heat *heat, const char *command);
void heat_free(struct heat *heat);

#endif
