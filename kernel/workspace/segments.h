/* segments.h - first segments of paths, which a row takes from its windows. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_WORKSPACE_SEGMENTS_H
#define FIBRAD_WORKSPACE_SEGMENTS_H

#include "base/port.h"

/* The first segment of a path: a beam of a window. Once paths have arrived (exchange/paths.h), n, w, centre and sphere
 * tell where the segment has ended. */
typedef struct fibrad_segment {
    double n[3];       /* outward normal of sphere i where the beam leaves; later: normal of the surface met */
    double w[3];       /* direction of the beam; later, at a wall: where the segment ends [L] */
    double even[3];    /* an even point of the unit sphere, by which a path goes on */
    double centre[3];  /* of the sphere met, from the centre of sphere i, in its radii; later: centre of the path [L] */
    uint32_t sphere;   /* place of the sphere met; FIBRAD_NONE: see open; later FIBRAD_NONE: a wall is met */
    bool open;         /* no sphere is met. If false, and there is no sphere: it is not known what is met */
    uint32_t triangle; /* later: the triangle met; FIBRAD_NO_SIDE: none */
    uint32_t
        chosen;    /* later: the number of the segment from which path k goes on, k being the number of this segment */
    double weight; /* in segments from each window on the mean; later: what the surface met reflects */
} fibrad_segment;

/* First segments that a beam row takes from its windows, equally many from each. */
typedef struct fibrad_segments {
    uint64_t shift[4];       /* of the four coordinates of each segment */
    uint32_t wanted, length; /* wanted: at most plan.segments; 0: the row takes none */
    uint32_t sources;        /* segments with those beyond `length`, to spheres that no segment of a window meets */
    fibrad_segment *segment; /* [plan.segments] */
    double share;            /* out, of arrival: mean weight of the segments */
} fibrad_segments;

#endif
