/* property_option.h - emissivities and temperatures of spheres and walls, from options and columns of the file.
 * SPDX-License-Identifier: MIT */
#ifndef PROPERTY_OPTION_H
#define PROPERTY_OPTION_H

#include <stdbool.h>

#include "bed/bed.h"
#include "bed/wall_option.h"
#include "fibrad.h"

/* The hottest there may be [K]. */
#define TEMPERATURE_MAX 1e9

/* Rows of a table of options, without braces. */
#define OPTION_EMISSIVITY                                                                                              \
    KEY_EMISSIVITY, "emissivity", "E|COLUMN", "of all spheres, above 0 up to 1, or the file's column of that name"
#define OPTION_WALL_EMISSIVITY                                                                                         \
    KEY_WALL_EMISSIVITY, "wall-emissivity", "LIST",                                                                    \
        "emissivities of the walls in the order given, 0 to 1; the last one is that of all further [1]"

/* What an option says of the spheres: a number for all of them, or the name of a column. */
struct quantity {
    bool given;
    double value;
    const char *column; /* NULL: value */
    size_t place;       /* of the column in bed->extra */
};

/* Take the argument of --emissivity (above 0 up to 1) and --temperature. Status 0 or STATUS_USAGE. */
int emissivity_option(const char *text, struct quantity *emissivity);
int temperature_option(const char *text, struct quantity *temperature);

/* The values of all spheres [n], to be freed also after an error; `file` is the bed's name in messages. Status 0,
 * STATUS_INPUT naming the line of one that is out of range, or STATUS_MEMORY. */
int emissivity_of(const struct quantity *quantity, const struct bed *bed, const char *file, double **emissivity);
int temperature_of(const struct quantity *quantity, const struct bed *bed, const char *file, double **temperature);

/* Spread the list of --wall-emissivity or --wall-temperature over so many walls. NULL: it was not given, and walls are
 * black, or as hot as the surroundings. Status 0 or STATUS_USAGE. */
int emissivity_walls(const char *text, uint32_t walls, double emissivity[WALLS_MAX]);
int temperature_walls(const char *text, uint32_t walls, double surroundings, double temperature[WALLS_MAX]);

#endif
