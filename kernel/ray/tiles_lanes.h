/* tiles_lanes.h - rays of the tiles of planes, one version per instruction set. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_RAY_TILES_LANES_H
#define FIBRAD_RAY_TILES_LANES_H

#include "base/dispatch.h"
#include "ray/tracer.h"
#include "work/tiles.h"

/* The ray with which a path goes on that has met a plane. The tile at this point is made if it is not in memory. Its
 * rays depend on the seed, the side, the plane, the position of the tile, and what the rays meet.
 *   Input    plane: its slot
 *            point: [L] where the path has met the plane
 *   Output   point: where the ray begins
 *            w: its direction
 *            hit: the sphere that the ray meets */
typedef void fibrad_tile_function(fibrad_tiles *tiles, const fibrad_scene *scene, uint32_t plane, double point[3],
                                  double w[3], fibrad_hit *hit);
FIBRAD_DECLARE_VERSIONS(fibrad_tile_function, fibrad_tile_ray);

#endif
