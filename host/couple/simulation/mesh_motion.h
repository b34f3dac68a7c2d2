/* mesh_motion.h - where the corners of a mesh are that turns and travels. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_COUPLE_MESH_MOTION_H
#define FIBRAD_COUPLE_MESH_MOTION_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* How a mesh moves. It turns about an axis, and the axis travels with the mesh. Zeroes: the mesh stands still. */
struct mesh_motion {
    double axis[3];     /* a unit vector; seen from its tip, a turn is counter-clockwise */
    double about[3];    /* L, a point of the axis at time 0 */
    double turn;        /* time of one turn; below 0: clockwise; 0: the mesh does not turn */
    double velocity[3]; /* L per time */
};

/* Finds where vertices are at a time. A whole turn brings them back to the bit. What they have travelled is reduced by
 * whole periods, so that a mesh stays within half a period of its place.
 *   Input   period[3]: L; 0: the axis is open
 *           home[n][3]: L, vertices at time 0
 *   Output  at[n][3]: L */
void mesh_motion_place(const struct mesh_motion *motion, double time, const double period[3], uint32_t n,
                       const double (*home)[3], double (*at)[3]);

#ifdef __cplusplus
}
#endif
#endif
