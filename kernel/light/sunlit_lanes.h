/* sunlit_lanes.h - the window of a sphere towards a light. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_LIGHT_SUNLIT_LANES_H
#define FIBRAD_LIGHT_SUNLIT_LANES_H

#include "base/dispatch.h"
#include "light/unshadowed.h"
#include "window/points.h"
#include "workspace/workspace.h"

#define FIBRAD_SUNLIT_POINTS 256u

/* Resolves the window of the sphere at `place` in one direction, and leaves it in space->areas. points: gets the points
 * of the window that no sphere hides. *open: the open area, in units of the radius
 * squared, whatever triangles hide. unshadowed: gets the part that no triangle hides. Errors: FIBRAD_E_WORK, _TABLE. */
typedef int fibrad_sunlit_function(const fibrad_scene *scene, fibrad_workspace *space, uint32_t place,
                                   const double frame[9], fibrad_points *points, double *open,
                                   fibrad_unshadowed *unshadowed);
FIBRAD_DECLARE_VERSIONS(fibrad_sunlit_function, fibrad_sunlit);

#endif
