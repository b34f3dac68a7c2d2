/* warnings.h - what a bed and the options say that contradicts itself: one warning each a run, with the likely remedy.
 * SPDX-License-Identifier: MIT
 *
 * A warning changes neither results nor status. It goes to standard error and into the JSON of the summary. */
#ifndef WARNINGS_H
#define WARNINGS_H

#include <stdbool.h>
#include <stdint.h>

#include "bed/bed.h"
#include "bed/property_option.h"
#include "bed/wall_option.h"
#include "fibrad.h"

/* What was said in a run. Zeroed to begin with, but for the name. */
struct warned {
    const char *file; /* in hand, in messages */
    unsigned kinds;   /* bits: warnings that are out */
    int64_t frames;   /* that came before; of the last one: */
    int64_t timestep; /* -1: it has none */
    bool ids;         /* spheres have them */
};

/* The next frame: timesteps go up, spheres go by the same names. */
void warn_frame(struct warned *warned, const struct bed *bed);

/* Lengths of --periodic, which the bed does not have yet, are those of the file's box. */
void warn_periods(struct warned *warned, const struct bed *bed, const double period[3]);

/* Radii are taken as metres since nobody has named their unit. */
void warn_unit(struct warned *warned, const struct bed *bed);

/* Overlaps are common in DEM. Large ones are not, and make factors mean little. */
void warn_overlap(struct warned *warned, const struct bed *bed, const fibrad_scene_facts *facts);

/* Walls stand about the spheres: planes and cylinders do not cut them, meshes are of the bed's size and place, and a
 * box that ends within spheres is none of walls. */
void warn_walls(struct warned *warned, const struct bed *bed, const struct walls *walls);

/* Temperatures [bed->n] are kelvins. `zero` is 0 of the unit they were given in. NaN: not given. */
void warn_temperatures(struct warned *warned, const struct bed *bed, const struct quantity *given, double zero,
                       const double *kelvins);

/* Heat capacities and densities [bed->n] are those of solids in J/(kg K) and kg/m3. */
void warn_matter(struct warned *warned, const struct bed *bed, const double *capacity, const double *density);

/* Rows of walls agree with those of spheres, and closing changes these by no more than their errors. */
void warn_rows(struct warned *warned, const struct bed *bed, const fibrad_factors *matrix);

#endif
