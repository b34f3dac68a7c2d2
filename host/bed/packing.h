/* packing.h - beds made to measure: random ones and lattices. SPDX-License-Identifier: MIT */
#ifndef PACKING_H
#define PACKING_H

#include "bed/bed.h"

/* Number `count` of the random sequence `seed`, uniform in [0, 1). */
double bed_make_random(uint64_t seed, uint64_t count);

/* Fills an empty bed with n spheres that do not overlap, in a cube with periodic faces: centres at random, then pushed
 * apart. Radii uniform in [low, high]; fraction of solid up to about 0.6. bed->period is the side of the cube.
 * Status 0; STATUS_INPUT if the spheres cannot be pushed apart; STATUS_MEMORY; that of a signal. */
int bed_make_packing(struct bed *bed, uint32_t n, double low, double high, double fraction, uint64_t seed);

/* The same with unit spheres, where it may be too dense to push them apart: what overlaps after so many sweeps stays,
 * by 5 % of a radius at the most after 1000 at 0.64. Status 0 or STATUS_MEMORY; that of a signal. */
int bed_make_jammed(struct bed *bed, uint32_t n, double fraction, uint32_t sweeps, uint64_t seed);

/* The same with spheres of two sizes, `large` ones of radius `ratio`, which come first, and as much volume of radius 1.
 */
int bed_make_two_sizes(struct bed *bed, uint32_t large, double ratio, double fraction, uint64_t seed);

/* Fills an empty bed with copies[axis] copies of a periodic bed side by side along each axis: large beds at once, since
 * pushing apart takes more than linear time. The copies of one sphere follow each other, so that neighbours in space
 * are as far apart in memory as in a bed made at random. Status 0 or STATUS_MEMORY. */
int bed_make_copies(struct bed *to, const struct bed *from, const uint32_t copies[3]);

/* Fills an empty bed with the sites of a face-centred cubic lattice, at distance 2 from their neighbours, that lie
 * within `distance` of the first sphere, which stands at the origin and has radius 1. The others' radii are uniform in
 * [low, 1]. Status 0 or STATUS_MEMORY. */
int bed_make_fcc(struct bed *bed, double low, double distance, uint64_t seed);

#endif
