/* heat_march.h - temperatures of one bed in time. SPDX-License-Identifier: MIT */
#ifndef HEAT_MARCH_H
#define HEAT_MARCH_H

#include "heat/heat_run.h"

/* Rows of a table of options, without the outermost braces. */
enum { KEY_UNTIL = KEY_OWN + 100, KEY_CAPACITY, KEY_DENSITY, KEY_STEP, KEY_TIMES, KEY_EVERY };
#define OPTIONS_MARCH                                                                                                  \
    {KEY_UNTIL, "until", "S", "follow the temperatures up to S seconds, from those given [powers at one time]"},       \
        {KEY_CAPACITY, "heat-capacity", "C",                                                                           \
         "specific heat of the spheres, a number, TYPE:C,..., or a column of the file [J/(kg K)]"},                    \
        {KEY_DENSITY, "density", "RHO",                                                                                \
         "density of the spheres, a number, TYPE:RHO,..., or a column of the file [kg/m3]"},                           \
        {KEY_STEP, "step", "S", "longest step in seconds, or auto for steps with errors of 1e-4 [auto]"},              \
        {KEY_TIMES, "times", "LIST", "times of output in seconds, 0,10,60 for example [the end]"}, {                   \
        KEY_EVERY, "every", "S", "output every S seconds, from 0 on"                                                   \
    }

/* What the options say. Begin with zeroes. */
struct march_options {
    double until, step, every; /* [s]; 0: not given, automatic, not given */
    struct quantity capacity, density;
    const char *times;
};

/* Takes the argument of one of the options. Status 0 or STATUS_USAGE. */
int march_option(int key, const char *text, struct march_options *march);

/* Checks the options, once all are read, and finds columns. Without --until: whether an option that needs it is there.
 * Status 0 or STATUS_USAGE. */
int march_check(struct march_options *march, struct bed_options *bed);

/* Advances the temperatures in problem->sources, which are in watts for the bed's unit of length, writes them at the
 * times asked for, draws the picture (NULL: none) and reports. report: metres and arrays as of heat_run. Status 0,
 * STATUS_USAGE, STATUS_INPUT naming the line of a sphere, or as bed_options_status. */
int heat_march(struct bed_options *asked, const struct march_options *march, const struct heat_problem *problem,
               const struct bed *bed, struct heat_report *report, const struct output *picture);

#endif
