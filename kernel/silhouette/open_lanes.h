/* open_lanes.h - what walls get of the directions in which a sphere is open. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SILHOUETTE_OPEN_LANES_H
#define FIBRAD_SILHOUETTE_OPEN_LANES_H

#include "base/dispatch.h"
#include "base/lanes/laned.h"
#include "silhouette/circle.h"

/* The lines of a set, and which of them are open for a sphere. */
typedef struct fibrad_open_lines {
    const fibrad_line *line; /* [lines] */
    uint32_t lines;
    const uint64_t *which; /* [count], ascending: 2 line, or 2 line + 1 against it */
    uint32_t count;
} fibrad_open_lines;

/* Resolves the windows of the sphere at `place` along its open lines. Adds to space->wall what walls get of them, in
 * units of the square of its radius. parts: as of fibrad_wall_factors. Errors: FIBRAD_E_WORK. */
typedef int fibrad_open_function(fibrad_workspace *space, const fibrad_scene *scene, uint32_t place,
                                 const fibrad_open_lines *open, double parts[2]);
FIBRAD_DECLARE_VERSIONS(fibrad_open_function, fibrad_open_share);

#endif
