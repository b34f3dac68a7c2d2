/* masks_lanes.h - points of a window as bits, in lanes. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_MASK_MASKS_LANES_H
#define FIBRAD_MASK_MASKS_LANES_H

#include "base/lanes/laned.h"
#include "window/discs.h"
#include "mask/masks.h"

/* Opens window k: `chords` chords of `words` words. Chords and points lie a little differently in each window. */
void LANED(fibrad_masks_open)(fibrad_masks *masks, uint32_t chords, uint32_t words, uint32_t k);

/* Hides points inside discs from front to back: order[from] to the last disc not deeper than `depth`. The floats of
 * `disc` count. disc->hidden_points[k]: out: how many points disc k hides, for every disc used. Returns the position in
 * the order of the first disc that was not used. It ends early when no point is open. */
uint32_t LANED(fibrad_masks_discs)(fibrad_masks *masks, const fibrad_discs *disc, uint32_t from, float depth);

/* Which points of a set are open. bits [count/64]: out. x, y [count]. Returns their number. */
uint32_t LANED(fibrad_masks_at)(const fibrad_masks *masks, uint32_t count, const float *x, const float *y,
                                uint64_t *bits);

#endif
