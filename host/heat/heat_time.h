/* heat_time.h - temperatures of one bed in time. SPDX-License-Identifier: MIT */
#ifndef HEAT_TIME_H
#define HEAT_TIME_H

#include "heat/heat_run.h"

#define SECONDS_MAX 1e15

/* Rows of a table of options, without the outermost braces, for a request with a field `time`. */
#define OPTIONS_TIME(request)                                                                                          \
    {0, "until", "S", "follow the temperatures up to S seconds, from those given [powers at one time]",                \
     TO_NUMBER(request, time.until, 1 / SECONDS_MAX, SECONDS_MAX)},                                                    \
        {0, "heat-capacity", "C",                                                                                      \
         "specific heat of the spheres, a number, TYPE:C,..., or a column of the file [J/(kg K)]",                     \
         TO_FUNCTION(capacity_option, request, time.capacity)},                                                        \
        {0, "density", "RHO", "density of the spheres, a number, TYPE:RHO,..., or a column of the file [kg/m3]",       \
         TO_FUNCTION(density_option, request, time.density)},                                                          \
        {0, "step", "S", "longest step in seconds, or auto for steps with errors of 1e-4 [auto]",                      \
         TO_FUNCTION(step_option, request, time.step)},                                                                \
        {0, "times", "LIST", "times of output in seconds, 0,10,60 for example [the end]",                              \
         TO_TEXT(request, time.times)},                                                                                \
    {                                                                                                                  \
        0, "every", "S", "output every S seconds, from 0 on",                                                          \
            TO_NUMBER(request, time.every, 1 / SECONDS_MAX, SECONDS_MAX)                                               \
    }
/* Arguments of the options. Begin with zeroes. */
struct time_options {
    double until, step, every; /* [s] 0: not given, automatic, not given */
    struct quantity capacity, density;
    const char *times;
};

/* Functions of the rows above. */
option_take capacity_option, density_option, step_option;

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
