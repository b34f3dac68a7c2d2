/* heat_time.h - temperatures of one bed in time. SPDX-License-Identifier: MIT */
#ifndef HEAT_TIME_H
#define HEAT_TIME_H

#include "heat/heat_run.h"

/* Rows of a table of options, without the outermost braces. */
enum { KEY_UNTIL = KEY_OWN + 100, KEY_CAPACITY, KEY_DENSITY, KEY_STEP, KEY_TIMES, KEY_EVERY };
#define OPTIONS_TIME                                                                                                   \
    {KEY_UNTIL, "until", "S", "follow the temperatures up to S seconds, from those given [powers at one time]"},       \
        {KEY_CAPACITY, "heat-capacity", "C",                                                                           \
         "specific heat of the spheres, a number, TYPE:C,..., or a column of the file [J/(kg K)]"},                    \
        {KEY_DENSITY, "density", "RHO",                                                                                \
         "density of the spheres, a number, TYPE:RHO,..., or a column of the file [kg/m3]"},                           \
        {KEY_STEP, "step", "S", "longest step in seconds, or auto for steps with errors of 1e-4 [auto]"},              \
        {KEY_TIMES, "times", "LIST", "times of output in seconds, 0,10,60 for example [the end]"}, {                   \
        KEY_EVERY, "every", "S", "output every S seconds, from 0 on"                                                   \
    }

/* Arguments of the options. Begin with zeroes. */
struct time_options {
    double until, step, every; /* [s] 0: not given, automatic, not given */
    struct quantity capacity, density;
    const char *times;
};

/* Reads the argument of one of the options. Status 0 or STATUS_USAGE. */
int time_option(int key, const char *text, struct time_options *time);

/* Checks the options when all have been read, and asks `bed` for the columns they name. Without --until the other
 * options are refused. Status 0 or STATUS_USAGE. */
int time_check(struct time_options *time, struct bed_options *bed);

/* Advances the temperatures of problem->sources in time, writes them at the times of output, draws the picture (NULL:
 * none) and prints the summary. Powers in problem->sources are in watts. The caller sets report->metres and the arrays
 * of `report`, as for heat_run. Status 0, STATUS_USAGE, STATUS_INPUT naming the line of a sphere, or as
 * bed_options_status. */
int heat_in_time(struct bed_options *options, const struct time_options *time, const struct heat_problem *problem,
                 const struct bed *bed, struct heat_report *report, const struct output *picture);

#endif
