/* packing.h - makes random beds and lattices. SPDX-License-Identifier: MIT */
#ifndef PACKING_H
#define PACKING_H

#include "bed/bed.h"

/* Number `count` of the random sequence `seed`, uniform in [0, 1). */
double bed_make_random(uint64_t seed, uint64_t count);

/* Fills an empty bed with n spheres that do not overlap, in a periodic cube of side bed->period. Radii are uniform from
 * low to high. Centres are put at random and pushed apart, up to a solid fraction of about 0.6. Status 0, STATUS_INPUT
 * if the spheres cannot be pushed apart, STATUS_MEMORY, or that of a signal. */
int bed_make_packing(struct bed *bed, uint32_t n, double low, double high, double fraction, uint64_t seed);

/* As bed_make_packing, with unit spheres that may be too dense to be pushed apart. Spheres may still overlap after the
 * sweeps: by at most 5 % of a radius after 1000 sweeps at fraction 0.64. Status 0, STATUS_MEMORY, or that of a signal.
 */
int bed_make_jammed(struct bed *bed, uint32_t n, double fraction, uint32_t sweeps, uint64_t seed);

/* As bed_make_packing, with spheres of two sizes: `large` spheres of radius `ratio`, which come first, and spheres of
 * radius 1 with the same volume in all. */
int bed_make_two_sizes(struct bed *bed, uint32_t large, double ratio, double fraction, uint64_t seed);

/* Fills an empty bed with the sites of a face-centred cubic lattice within `distance` of the origin. Neighbours are at
 * distance 2. The first sphere stands at the origin and has radius 1. The other radii are uniform from low to 1. Status
 * 0 or STATUS_MEMORY. */
int bed_make_fcc(struct bed *bed, double low, double distance, uint64_t seed);

#endif
