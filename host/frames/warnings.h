/* warnings.h - warnings about beds and options that contradict each other. SPDX-License-Identifier: MIT
 *
 * Each kind of warning is printed once in a run and names the likely remedy. A warning changes neither results nor
 * status. It goes to standard error and into the JSON of the summary. */
#ifndef WARNINGS_H
#define WARNINGS_H

#include "bed/property_option.h"
#include "simple/fibrad_host.h"

/* Warnings of a run so far. Begin with zeroes. */
struct warned {
    const char *file; /* name of the current file, for messages */
    uint64_t kinds;   /* bits: kinds of warnings that have been printed */
    int64_t frames;   /* frames so far */
    int64_t timestep; /* of the last frame; -1: it has none */
    bool ids;         /* spheres of the last frame have ids */
};

/* Warns if timesteps go down from frame to frame, or if some frames have ids and others do not. */
void warn_frame(struct warned *warned, const struct bed *bed);

/* Warns if the lengths of --periodic are not those of the file's box. Call it before bed->period is replaced. */
void warn_periods(struct warned *warned, const struct bed *bed, const double period[3]);

/* Warns if radii without a unit are too large for metres. */
void warn_unit(struct warned *warned, const struct bed *bed);

/* Warns of spheres that are no larger than wavelengths of the hottest radiation [K]. */
void warn_waves(struct warned *warned, const struct bed *bed, double hottest);

/* Warns of what the library finds in its bed, its sources and its factors. kelvins: temperatures are given in kelvins.
 */
void warn_made(struct warned *warned, const struct bed *bed, const struct walls *walls, const fibrad_bed *made,
               bool kelvins);

/* Warns if the file's box ends within spheres, so that the box cannot be made of walls. */
void warn_box(struct warned *warned, const struct walls *walls);

/* Warns if the name of a column of temperatures in kelvins says degrees Celsius. */
void warn_celsius(struct warned *warned, const char *column);

/* Says that an insulated wall in contact has one temperature. */
void warn_joined(struct warned *warned, const char *wall);

/* Warns if the hottest temperature that was found [K] is above that of all solids. */
void warn_hot(struct warned *warned, double hottest);

/* Warns of a temperature of the surroundings in a closed bed. */
void warn_closed(struct warned *warned);

/* Warns if heat capacities [J/(kg K)] or densities [kg/m3], both [bed->n], are not those of solids. */
void warn_matter(struct warned *warned, const struct bed *bed, const double *capacity, const double *density);

/* Warns if spheres lie beyond the ends of the tables of an option, where values do not change. */
enum warned_table { EMISSIVITY_TABLE, SOLID_TABLE, CONTACT_TABLE, GAS_TABLE };
void warn_table(struct warned *warned, enum warned_table table, const struct table_excess *excess);

/* Warns if a table over times does not reach from 0 to `until` [s]. what: whose table. */
void warn_times(struct warned *warned, const char *what, const struct curve *curve, double until);

/* Warns of the first sphere that lies wholly beyond a closed mesh with a wall on one side only: such a sphere is there
 * by mistake. Spheres that a mesh cuts are normal. made: the bed in the library. file: its name. */
void warn_beyond(const fibrad_bed *made, const struct bed *bed, const struct walls *walls, const char *file);

#endif
