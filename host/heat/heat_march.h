/* heat_march.h - temperatures of one bed in time. SPDX-License-Identifier: MIT */
#ifndef HEAT_MARCH_H
#define HEAT_MARCH_H

#include "heat/heat_run.h"

/* Rows of a table of options, without the outermost braces. */
enum { KEY_UNTIL = KEY_OWN + 100, KEY_CAPACITY, KEY_DENSITY, KEY_STEP, KEY_TIMES, KEY_EVERY };
#define OPTIONS_MARCH                                                                                                  \
    {KEY_UNTIL, "until", "S", "temperatures in time, from those given, up to S seconds [powers at one time]"},         \
        {KEY_CAPACITY, "heat-capacity", "C", "of the spheres' matter; number, TYPE:C,... or column [J/(kg K)]"},       \
        {KEY_DENSITY, "density", "RHO", "of it; number, TYPE:RHO,... or column [kg/m3]"},                              \
        {KEY_STEP, "step", "S", "auto, or of S seconds at most [auto: errors of 1e-4]"},                               \
        {KEY_TIMES, "times", "LIST", "of output: 0,10,60 seconds [the end]"}, {                                        \
        KEY_EVERY, "every", "S", "output from 0 on, every S seconds"                                                   \
    }

/* A temperature that follows a table of time; its name is that of the wall. */
struct march_table {
    char name[16];
    struct curve curve; /* [s], unit of temperature */
};

/* What the options say. Begin with zeroes. */
struct march_options {
    double until, step, every; /* [s]; 0: not given, automatic, not given */
    struct quantity capacity, density;
    const char *times;
    char *walls, *ambient; /* the options with the tables' first values in their place; NULL: without tables */
    struct march_table table[WALLS_MAX + 1];
    size_t tables;
    double zero; /* 0 of the unit of temperature [K] */
};

/* Takes the argument of one of the options. Status 0 or STATUS_USAGE. */
int march_option(int key, const char *text, struct march_options *march);

/* Reads the tables named in *walls and *ambient, options' arguments (NULL: not given), which then have numbers in their
 * place, and finds columns. Without --until: whether an option that needs it is there. Status 0, STATUS_USAGE, or as
 * curve_read. */
int march_check(struct march_options *march, struct bed_options *bed, const char **walls, const char **ambient);
void march_free(struct march_options *march);

/* Advances the temperatures in problem->sources, which are in watts for the bed's unit of length, writes them at the
 * times asked for, draws the picture (NULL: none) and reports. result: arrays as of heat_run. Status 0, STATUS_USAGE,
 * STATUS_INPUT naming the line of a sphere, or as bed_options_status. */
int heat_march(struct bed_options *asked, const struct march_options *march, const struct heat_problem *problem,
               const struct bed *bed, double metres, fibrad_heat_result *result, const struct output *picture);

#endif
