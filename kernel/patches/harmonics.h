/* harmonics.h - spherical harmonics on the patches of a sphere. SPDX-License-Identifier: MIT
 *
 * A pattern over the patches of a sphere is a sum of harmonics. A filter has one number for each degree, and multiplies
 * the harmonics of that degree by it. The filter is symmetric with areas as weights: the sum of A u filter(v) is the
 * sum of A v filter(u). If no number is below 0, that sum is not below 0 for u = v. The areas A are those that beams
 * have measured.
 *
 * Harmonics are x^a y^b z^c times a polynomial in x^2 and y^2, with a, b, c 0 or 1: a "kind". Mirrored at a plane of
 * the cube of patches, a kind keeps its values or changes all signs. So sums over the patches of an octant are enough.
 * Each kind has the degrees a + b + c, a + b + c + 2, and so on. The part of a pattern that the harmonics of a kind
 * leave over is treated as the next degree of the kind. */
#ifndef FIBRAD_PATCHES_HARMONICS_H
#define FIBRAD_PATCHES_HARMONICS_H

#include "fibrad.h"
#include "base/port.h"

/* Bounds: kinds, which are as many as octants; harmonics of a kind; degrees, the next one of each kind included. */
#define FIBRAD_HARMONICS_KINDS   8u
#define FIBRAD_HARMONICS_OF_KIND 10u
#define FIBRAD_HARMONICS_DEGREES 12u

/* The filter's number for what varies within patches of the cube that are divided. */
#define FIBRAD_HARMONICS_WITHIN FIBRAD_HARMONICS_DEGREES

/* Harmonics on the patches of a cube, or on its fours: groups of four patches. */
typedef struct fibrad_harmonics {
    uint32_t side;         /* patches, or fours, along an edge of the cube: even */
    uint32_t each;         /* patches of the cube that make up one of these: 1 or 4 */
    uint32_t orbits;       /* patches of an octant */
    uint32_t shells, many; /* of a kind: degrees and harmonics, which are 1, 2, 3, ... of a degree */
    uint16_t *patch;       /* [octants][orbits], number of the patch */
    double *root;          /* [orbits], square root of the share of the sphere's area */
    double *value;         /* [kinds][orbits][many], orthonormal, times that root */
} fibrad_harmonics;

/* Finds the numbers of patches and harmonics. `side`: patches along an edge of the cube. fours: of fours, if these are
 * two by two at least on a face; else of patches. */
void fibrad_harmonics_size(fibrad_harmonics *harmonics, uint32_t side, bool fours);

/* Finds the harmonics. Their arrays are there. */
void fibrad_harmonics_make(fibrad_harmonics *harmonics);

/* The degree that stands for what varies within patches that are divided. */
double fibrad_harmonics_within(const fibrad_harmonics *harmonics);

/* The patches of one sphere. The first of them are those of the cube. Fours of further ones lie on some of these. */
typedef struct fibrad_harmonics_patches {
    const double *area;   /* L^2, [count] */
    uint32_t cube, count; /* patches of the cube, and of all */
    const uint16_t *own;  /* [(count - cube)/4], patch of the cube on which a further four lies */
} fibrad_harmonics_patches;

/* Filters a pattern [count]. `by`: numbers for degrees from 0 on, and for FIBRAD_HARMONICS_WITHIN. `to` [count] may be
 * NULL. Returns the sum of A times pattern times filtered pattern. Some area must be above 0. */
double fibrad_harmonics_filter(const fibrad_harmonics *harmonics, const fibrad_harmonics_patches *on,
                               const double by[FIBRAD_HARMONICS_WITHIN + 1], const double *pattern, double *to);

#endif
