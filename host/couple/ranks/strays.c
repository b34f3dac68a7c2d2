/* strays.c - particles beyond walls, and what is said of particles. SPDX-License-Identifier: MIT */
#include "couple/ranks/ranks.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "simple/cylinder.h"

#define OPENING_SLACK 1e-12 /* a particle may reach this much beyond an opening, as in fibrad_scene_init */

/* ---- bounds ---- */

static bool plane_holds(const fibrad_plane *plane, const double x[3]) {
    return plane->upper ? x[plane->axis] <= plane->at : x[plane->axis] >= plane->at;
}

static bool wall_holds(const fibrad_wall *wall, const double x[3]) {
    if (wall->kind == FIBRAD_WALL_PLANE) return plane_holds(&wall->plane, x);
    if (wall->kind != FIBRAD_WALL_CYLINDER) return true;
    const double a = (x[cylinder_across(wall, 0)] - wall->cylinder.x) / wall->cylinder.radius;
    const double b = (x[cylinder_across(wall, 1)] - wall->cylinder.y) / wall->cylinder.radius;
    return a * a + b * b <= 1;
}

static bool opening_holds(const fibrad_plane *plane, const fibrad_particle *p) {
    const double x = p->x[plane->axis], beyond = p->radius - (plane->upper ? plane->at - x : x - plane->at);
    return beyond <= OPENING_SLACK * (p->radius + fabs(x));
}

static void describe(char *message, const fibrad_particle *p, const char *fault, const fibrad_plane *plane) {
    char name[] = "the cylinder";
    if (plane) snprintf(name, sizeof name, "%c%s", "xyz"[plane->axis], plane -> upper ? "max" : "min");
    fibrad_refuse(message, 0, "particle %" PRIu64 " at (%.6g, %.6g, %.6g): %s %s", p->id, p->x[0], p->x[1], p->x[2],
                  fault, name);
}

bool fibrad_bounds_hold(const fibrad_bounds *bounds, const fibrad_particle *p, bool *opening, char *message) {
    *opening = false;
    for (uint32_t k = 0; k < bounds->walls; ++k) {
        const fibrad_wall *wall = &bounds->wall[k];
        if (wall_holds(wall, p->x)) continue;
        char fault[48];
        snprintf(fault, sizeof fault, "its centre lies beyond wall %" PRIu32 ",", k + 1);
        describe(message, p, fault, wall->kind == FIBRAD_WALL_PLANE ? &wall->plane : NULL);
        return false;
    }
    for (uint32_t k = 0; k < bounds->openings; ++k) {
        if (opening_holds(&bounds->opening[k], p)) continue;
        describe(message, p, "it reaches beyond the opening", &bounds->opening[k]);
        *opening = true;
        return false;
    }
    return true;
}

/* ---- remarks ---- */

void fibrad_remark_add(fibrad_remark *remark, uint64_t id, const char *message) {
    if (remark->count++ && id > remark->id) return;
    remark->id = id;
    fibrad_refuse(remark->message, 0, "%s", message);
}

void fibrad_remark_agree(MPI_Comm comm, fibrad_remark *remark) {
    int rank, lowest;
    uint64_t least = remark->count ? remark->id : UINT64_MAX;
    const uint64_t own = least;
    MPI_Allreduce(MPI_IN_PLACE, &remark->count, 1, MPI_UINT64_T, MPI_SUM, comm);
    if (!remark->count) return;
    MPI_Comm_rank(comm, &rank);
    MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPI_UINT64_T, MPI_MIN, comm);
    lowest = own == least ? rank : INT32_MAX;
    MPI_Allreduce(MPI_IN_PLACE, &lowest, 1, MPI_INT, MPI_MIN, comm);
    remark->id = least;
    MPI_Bcast(remark->message, FIBRAD_MESSAGE, MPI_CHAR, lowest, comm);
}
