/* heat_given.h - what is given of each sphere and wall: its temperature or its power. SPDX-License-Identifier: MIT */
#ifndef HEAT_GIVEN_H
#define HEAT_GIVEN_H

#include "frames/bed_options.h"

/* Arguments of the options. Begin with zeroes. */
struct given_options {
    struct quantity temperature, power;
    const char *ambient; /* NULL: not given */
    double zero;         /* [K] 0 of the unit of temperature */
    /* Temperatures change with time. Then those of the options are initial ones. Each sphere has a temperature and may
     * have a power too. The temperatures of walls and surroundings may be tables over time, @TABLE. */
    bool timed;
    struct curve ambient_curve; /* n = 0: --ambient is a number */
    double surroundings;        /* [K] their temperature, of a table that at 0 s; NaN: not given */
};

/* Temperatures of walls from tables, in the unit of the options: over time, or of each triangle. n = 0: the wall has
 * none. */
struct wall_tables {
    struct curve curve[WALLS_MAX], column[WALLS_MAX];
};

/* Temperatures and powers of one bed. NaN: not given. */
struct given {
    double *temperature; /* [spheres] [K] */
    double *power;       /* [spheres] [W] */
    double wall_temperature[WALLS_MAX], wall_power[WALLS_MAX];
    unsigned char insulated[WALLS_MAX];
    struct wall_tables tables;
    double *side_temperature; /* [2 triangles] [K] as in fibrad_heat_sources; NULL: no side has one of its own */
};

/* Takes the argument of --power into a quantity. Status 0 or STATUS_USAGE. */
int given_power_option(const char *text, void *power);

/* Checks the options when all have been read, asks `bed` for the columns they name, and finds options->surroundings.
 * The caller frees options->ambient_curve. Status 0, STATUS_USAGE, or as curve_read. */
int given_check(struct given_options *options, struct bed_options *bed);

/* Finds the temperatures and powers of a bed and its walls. Call given_free also after an error. Status 0, STATUS_USAGE
 * naming a wall, STATUS_MEMORY, or STATUS_INPUT naming the line of a sphere that has both a temperature and a power, or
 * neither. */
int given_values(const struct given_options *options, const struct bed *bed, const char *file,
                 const struct walls *walls, struct given *given);
void given_free(struct given *given);

/* Refuses spheres and walls of emissivity 0 that have a power. Status 0, STATUS_USAGE naming a wall, or STATUS_INPUT
 * naming the line of a sphere. */
int given_reflectors(const struct given *given, const double *emissivity, const struct walls *walls,
                     const double *wall_emissivity, const struct bed *bed, const char *file);

/* Points `sources` to the arrays of a bed of n spheres. Divides powers by the unit of area of the library [m2]. */
void given_heat_sources(struct given *given, uint32_t n, double square_metres, fibrad_heat_sources *sources);

#endif
