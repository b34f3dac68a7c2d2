/* heat_given.h - what is given of each sphere and wall: its temperature or its power. SPDX-License-Identifier: MIT */
#ifndef HEAT_GIVEN_H
#define HEAT_GIVEN_H

#include "frames/bed_options.h"

/* Rows of tables of options, without braces; KEY_* are the command's. */
#define OPTION_TEMPERATURE                                                                                             \
    "temperature", "T",                                                                                                \
        "temperature of all spheres, or TYPE:T,..., or a column of the file, blank or nan for spheres of --power"
#define OPTION_POWER                                                                                                   \
    "power", "W",                                                                                                      \
        "power that spheres of unknown temperature give off from inside, a number, TYPE:W,..., or a column of the "    \
        "file, blank or nan for spheres of --temperature [W]"
#define OPTION_AMBIENT                                                                                                 \
    "ambient", "T", "temperature of the black surroundings; needed unless walls and periods close the bed"
#define OPTION_WALL_TEMPERATURE                                                                                        \
    "wall-temperature", "LIST",                                                                                        \
        "temperatures of walls, zmin=1200,zmax=insulated,300 for example; a number without a name is for all others; " \
        "NAME=triangles:FILE is a column of numbers, one for each triangle of the mesh"
#define OPTION_WALL_POWER                                                                                              \
    "wall-power", "LIST", "powers that walls of unknown temperature give off, zmin=500 for example [W]"

/* What the options say. Begin with zeroes. */
struct given_options {
    struct quantity temperature, power;
    const char *ambient, *wall_temperature, *wall_power; /* NULL: not given */
    double zero;                                         /* 0 of the unit of temperature [K] */
    bool timed; /* temperatures are those to begin with: all spheres have one, and may have a power; @TABLE of
                 * seconds may stand for those of walls and surroundings */
    struct curve ambient_curve; /* n = 0: a number */
};

/* What follows for one bed; NaN where it is not given. */
struct given {
    double *temperature; /* [spheres] [K] */
    double *power;       /* [spheres] [W] */
    double wall_temperature[WALLS_MAX], wall_power[WALLS_MAX];
    unsigned char insulated[WALLS_MAX];
    struct wall_tables tables; /* of temperatures of walls, in their unit */
    double *side_temperature;  /* [2 triangles] [K] as in fibrad_heat_sources; NULL: none is given */
};

/* Takes the arguments of --temperature and --power. Status 0 or STATUS_USAGE. */
int given_temperature_option(const char *text, struct given_options *options);
int given_power_option(const char *text, struct given_options *options);

/* Checks the options, once all are read, and finds their columns. Status 0 or STATUS_USAGE. */
int given_check(struct given_options *options, struct bed_options *bed);

/* The temperature of the surroundings [K], of a table that at 0 s, NaN if it was not given. Its table is to be freed.
 * Status 0, STATUS_USAGE, or as curve_read. */
int given_ambient(struct given_options *options, double *ambient);

/* What is given of a bed and its walls; arrays are to be freed by given_free also after an error. Status 0,
 * STATUS_USAGE naming a wall, STATUS_INPUT naming the line of a sphere, of which neither or both are given, or
 * STATUS_MEMORY. */
int given_values(const struct given_options *options, const struct bed *bed, const char *file,
                 const struct walls *walls, struct given *given);
void given_free(struct given *given);

/* Refuses spheres and walls that reflect all and have a power. Status 0, STATUS_INPUT naming the line, STATUS_USAGE. */
int given_reflectors(const struct given *given, const double *emissivity, const struct walls *walls,
                     const double *wall_emissivity, const struct bed *bed, const char *file);

/* Puts it into sources for a bed of n spheres whose unit of length has so many metres; powers are no longer watts. */
void given_heat_sources(struct given *given, uint32_t n, double metres, fibrad_heat_sources *sources);

#endif
