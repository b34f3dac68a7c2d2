/* solid_option.h - the conductivity of the solid that spheres are made of. SPDX-License-Identifier: MIT
 *
 * What counts for radiation is the relative conductivity k* = k_s/(4 d sigma T^3). k_s is the conductivity of the solid
 * [W/(m K)], d the diameter of the sphere, T its mean temperature. A sphere of infinite k* has one temperature. */
#ifndef SOLID_OPTION_H
#define SOLID_OPTION_H

#include "frames/bed_options.h"

#define SOLID_UNIT  "W/(m K)"
#define SOLID_NEEDS "--solid-conductivity needs" /* for bed_options_metres */

/* Bounds of k_s, in that unit. Infinite: one temperature. */
#define SOLID_CONDUCTIVITY_MIN 1e-6
#define SOLID_CONDUCTIVITY_MAX INFINITY

/* Tables of conductivities over temperatures. */
extern const struct curve_axes solid_axes;

/* A row of a table of options, without braces. */
#define OPTION_SOLID_CONDUCTIVITY(request, field)                                                                      \
    0, "solid-conductivity", "K",                                                                                      \
        "thermal conductivity of the solid [W/(m K)]; a number, or @TABLE of temperatures [K] and "                    \
        "conductivities, or TYPE:K,TYPE:@TABLE,..., or a column of the file; inf or a blank there: one "               \
        "temperature [infinite]",                                                                                      \
        TO_FUNCTION(solid_option, request, field)

/* Takes the argument of --solid-conductivity into a quantity. Status as table_option. */
int solid_option(const char *text, void *solid);

/* Finds k_s of all spheres, *conductivity [n]. A table gives one of its values, a blank in a column
 * infinity. Free *conductivity also after an error.
 * Status as quantity_values. */
int solid_values(const struct bed_options *options, const struct bed *bed, const struct quantity *solid,
                 double **conductivity);

/* Finds k* of all spheres, relative [n], at their temperatures [n] [K]: infinite at 0 K, NaN where the temperature is
 * NaN. Warns where temperatures are beyond the ends of tables. The unit of length must be known. Status as
 * solid_values, or STATUS_INPUT naming the line of a sphere whose k* is below FIBRAD_RELATIVE_CONDUCTIVITY_MIN. */
int solid_relative(struct bed_options *options, const struct bed *bed, const struct quantity *solid,
                   const double *temperature, double *relative);

/* Reports --solid-conductivity and the mean k* of the spheres, and the least and the largest one if they differ. */
void solid_report(const struct quantity *solid, const struct k_star *all, struct report *report);

#endif
