/* pieces_lanes.h - the pieces of a circle on which nothing changes. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SILHOUETTE_PIECES_LANES_H
#define FIBRAD_SILHOUETTE_PIECES_LANES_H

#include "base/lanes/laned.h"
#include "silhouette/circle.h"

/* Divides the stretch into pieces, c->pieces, by the discs of both sides that may be seen. */
void LANED(fibrad_pieces_divide)(fibrad_circles *c);

/* The greatest depth that is met on a side. Infinity: the lines of some piece meet no sphere. */
double LANED(fibrad_pieces_deepest)(const fibrad_circles *c, int side);

/* Adds the areas of all pieces to the sums of near spheres and to a table. */
void LANED(fibrad_pieces_add)(fibrad_circles *c, fibrad_pair_table *table);

#endif
