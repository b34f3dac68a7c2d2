/* free_pair.h - pairs of spheres that nothing can come between. Their factors are exact. SPDX-License-Identifier: MIT
 *
 * Nothing comes between two spheres if their convex hull meets no other sphere and no triangle. Walls are convex, so
 * they come between no spheres that they do not cut. */
#ifndef FIBRAD_PAIR_FREE_PAIR_H
#define FIBRAD_PAIR_FREE_PAIR_H

#include "workspace/workspace.h"

/* Whether at most so many spheres, up to 4, and no triangle can come between the spheres at two places. f: out: the
 * factor from `place` to `other`. error: out: of it. */
bool fibrad_free_pair(const fibrad_scene *scene, uint32_t place, uint32_t other, uint32_t most, double *f,
                      double *error);

/* What the search for free pairs of a row has found. */
typedef struct fibrad_free_pairs {
    double moved;  /* what windows have seen of the spheres of free pairs, minus the exact factors */
    double open;   /* what windows have seen besides spheres */
    double unseen; /* root of a sum of squares: factors to spheres that no window has met, errors of hidden pairs */
    bool told;     /* all pairs were tried, and each sphere that no window has met is one of a free pair */
} fibrad_free_pairs;

/* Finds the free pairs of the present row, all of whose windows are done. Their exact factors go to entries.exact.
 * In scenes of few spheres all pairs are tried, in others only near ones. Rows of which no
 * window is open have none, since only walls and surroundings can take the difference. scale: factor over the sums of
 * entries. hidden: in dilute scenes of few spheres without walls, far pairs that few spheres hide in part have the
 * factors of lines between them. Entries that find no room are counted in entries.missed. */
fibrad_free_pairs fibrad_free_pairs_find(fibrad_workspace *work, double scale, bool hidden);

/* Gives the segments that meet a sphere of a free pair their share of its factor, and those that meet no sphere their
 * share of the rest. If no segment meets a sphere of a free pair, one more segment does. Error: FIBRAD_E_WORK: there is
 * no room. */
int fibrad_free_pairs_segments(fibrad_workspace *work, const fibrad_free_pairs *pairs);

/* Raises the differences of halves of spheres that few windows should meet. Lines are spread evenly, so that the error
 * of a sphere that many windows meet is less than the difference. Whether a window meets a far sphere is chance. */
void fibrad_weigh_halves(const fibrad_workspace *work, fibrad_row *row);

/* Gives walls and surroundings of a row, in proportion, what free pairs have moved. wall: factors by slot. */
void fibrad_free_pairs_share(const fibrad_free_pairs *pairs, double wall[FIBRAD_SLOTS], fibrad_row *row);

#endif
