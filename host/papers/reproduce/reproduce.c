/* reproduce.c - what experiments compare. SPDX-License-Identifier: MIT */
#include "papers/reproduce/reproduce.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

void reproduce_compare(struct reproduce *reproduce, const char *source, const char *unit, double theirs, double ours,
                       const char *what, ...) {
    char text[80];
    va_list arguments;
    va_start(arguments, what);
    vsnprintf(text, sizeof text, what, arguments);
    va_end(arguments);
    const bool points = strcmp(unit, "%") == 0;
    const double difference = points ? ours - theirs : 100 * (ours / theirs - 1);
    if (isnan(theirs))
        printf("%-12s %-70s %-5s %12s %12.6g %-3s\n", reproduce->experiment, text, "", "", ours, unit);
    else
        printf("%-12s %-70s %-5s %12.6g %12.6g %-3s %+8.2f %s\n", reproduce->experiment, text, source, theirs, ours,
               unit, difference, points ? "points" : "%");
    fprintf(reproduce->comparison.file, "%s,\"%s\",%s,%s,", reproduce->experiment, text, isnan(theirs) ? "" : source,
            unit);
    if (isnan(theirs))
        fprintf(reproduce->comparison.file, ",%.6g,\n", ours);
    else
        fprintf(reproduce->comparison.file, "%.6g,%.6g,%.3f\n", theirs, ours, difference);
}
