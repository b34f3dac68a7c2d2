/* line_set.h - the inside of a set of lines. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_MASK_LINE_SET_H
#define FIBRAD_MASK_LINE_SET_H

#include "scene/scene.h"

struct fibrad_line_set {
    uint32_t n;
    double (*line)[3];  /* [n] as in the table */
    double (*frame)[9]; /* [n] two unit vectors across each line, then its vector */
    uint32_t chords;    /* that suit so many lines; 0: exact areas */
    uint32_t *word;     /* [n][chords] the points of open windows, masks of one word a chord */
    uint32_t *points;   /* [n] their number */
};

/* Chords for which the noise of points is about half of the error of n lines. 0: exact areas are better. Measured:
 * docs/accuracy.md. */
uint32_t fibrad_chords_for(uint32_t n);

/* The words of each chord of masks for the sphere at a position. 0: its areas must be exact. */
uint32_t fibrad_mask_words(const fibrad_scene *scene, uint32_t place);

#endif
