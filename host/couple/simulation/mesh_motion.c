/* mesh_motion.c - where the corners of a mesh are that turns and travels. SPDX-License-Identifier: MIT */
#include "couple/simulation/mesh_motion.h"

#include <math.h>

/* How far a mesh has turned and travelled. */
struct progress {
    double cosine, sine, shift[3];
};

/* Cosine and sine are exact at quarters of a turn. */
static void find_turn(double turns, struct progress *to) {
    turns -= rint(turns);
    const double quarters = rint(4 * turns), angle = 8 * atan(1) * (turns - quarters / 4);
    const double c = cos(angle), s = sin(angle), of_quarter[] = {c, -s, -c, s};
    const int k = (int)quarters + 4;
    to->cosine = of_quarter[k % 4];
    to->sine = of_quarter[(k + 3) % 4];
}

static double reduced(double shift, double period) {
    return period > 0 ? shift - period * rint(shift / period) : shift;
}

/* Adds to a vertex what it has moved. So a vertex that has not moved keeps its bits. */
static void move_vertex(const struct mesh_motion *motion, const struct progress *by, const double home[3],
                        double at[3]) {
    const double *u = motion->axis;
    double d[3], along = 0;
    for (int k = 0; k < 3; ++k) d[k] = home[k] - motion->about[k], along += d[k] * u[k];
    for (int k = 0; k < 3; ++k) {
        const int next = (k + 1) % 3, last = (k + 2) % 3;
        const double turned =
            (by->cosine - 1) * (d[k] - along * u[k]) + by->sine * (u[next] * d[last] - u[last] * d[next]);
        at[k] = home[k] + turned + by->shift[k];
    }
}

void mesh_motion_place(const struct mesh_motion *motion, double time, const double period[3], uint32_t n,
                       const double (*home)[3], double (*at)[3]) {
    struct progress by;
    find_turn(motion->turn != 0 ? time / motion->turn : 0, &by);
    for (int k = 0; k < 3; ++k) by.shift[k] = reduced(motion->velocity[k] * time, period[k]);
    for (uint32_t v = 0; v < n; ++v) move_vertex(motion, &by, home[v], at[v]);
}
