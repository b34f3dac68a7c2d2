/* masks.h - the points of a window as bits of words. SPDX-License-Identifier: MIT
 *
 * The window is the unit disc about the origin. Parallel chords cut the square about it. Each chord has points at equal
 * steps, 32 to a word. A disc hides on each chord the points between two ends, so a few operations on whole words take
 * the place of a test for each point. Counts are whole numbers, which no order of terms and no instruction set changes.
 * Source: L. Carpenter, "The A-buffer, an antialiased hidden surface method", SIGGRAPH 1984.
 * docs/methods.md section 12.
 */
#ifndef FIBRAD_MASK_MASKS_H
#define FIBRAD_MASK_MASKS_H

#include "base/arena.h"
#include "base/random.h"

#define FIBRAD_MASK_WORDS_MAX  4u   /* words of a chord */
#define FIBRAD_MASK_CHORDS_MAX 256u /* chords of a window */

typedef struct fibrad_masks {
    uint32_t chords, words; /* a multiple of 16, and the number of words of each chord */
    float y_first, y_step;  /* height of the first chord, and the step to the next one */
    float x_zero, x_scale;  /* the point at x is number x_zero + x_scale x of its chord, rounded */
    uint32_t points;        /* points in the disc */
    uint32_t open;          /* those that no disc has hidden */
    uint32_t regions;       /* discs that have hidden points, in all windows of a row */
    _Alignas(FIBRAD_ALIGNMENT) uint32_t word[FIBRAD_MASK_WORDS_MAX * FIBRAD_MASK_CHORDS_MAX]; /* [words][chords] */
} fibrad_masks;

/* Where chords and points of window k lie. */
static inline void fibrad_masks_place(fibrad_masks *masks, uint32_t chords, uint32_t words, uint32_t k) {
    const double up = fibrad_fraction(k * fibrad_quasirandom_step(4, 0)) - 0.5;
    const double aside = fibrad_fraction(k * fibrad_quasirandom_step(4, 1)) - 0.5;
    masks->chords = chords, masks->words = words;
    masks->y_step = 2 / (float)chords;
    masks->y_first = masks->y_step * (float)(0.5 + up) - 1;
    masks->x_scale = 16 * (float)words;
    masks->x_zero = masks->x_scale + (float)aside;
}

/* The version of fibrad_masks_open that all builds have. */
void fibrad_masks_open_scalar(fibrad_masks *masks, uint32_t chords, uint32_t words, uint32_t k);

#endif
