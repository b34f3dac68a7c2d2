/* neighbours.c - begins a row, and tells where its beams leave the bed. SPDX-License-Identifier: MIT */
#include "row/work.h"

/* How far along an axis, forwards or backwards, there may be spheres that come before a window. */
static double room(const fibrad_workspace *work, int axis, double sense) {
    const fibrad_scene *scene = work->scene;
    double far = sense > 0 ? scene->high[axis] - work->centre[axis] : work->centre[axis] - scene->low[axis];
    if (scene->period[axis] > 0) far = FIBRAD_PERIODS * scene->period[axis];
    return (far + (work->unit + scene->facts.radius_max)) * work->inverse;
}

void fibrad_work_begin(fibrad_workspace *work, const fibrad_scene *scene, uint32_t place, double cutoff,
                       fibrad_stride stride) {
    for (uint32_t k = 0; k < work->entries.length; k++) work->entries.at[work->entries.slot[k]] = FIBRAD_NONE;
    work->entries.length = work->entries.missed = 0;
    work->entries.end = false;
    fibrad_zero(work->wall, sizeof work->wall);
    work->needed = work->plan;
    work->scene = scene;
    work->place = place;
    work->unit = scene->r[place];
    work->inverse = 1 / work->unit;
    work->centre[0] = scene->x[place], work->centre[1] = scene->y[place], work->centre[2] = scene->z[place];
    work->reach = cutoff > 0 ? cutoff * (1 + 1e-12) * work->inverse : __builtin_inf();
    work->step = stride.first * scene->spacing * work->inverse;
    work->growth = stride.growth;

    double farthest[3];
    for (int axis = 0; axis < 3; axis++)
        farthest[axis] = scene->period[axis] > 0 ? __builtin_inf()
                                                 : fibrad_max(work->centre[axis] - scene->low[axis],
                                                              scene->high[axis] - work->centre[axis]) *
                                                       work->inverse;
    work->farthest = fibrad_min(farthest[0] + farthest[1] + farthest[2], work->reach);
    work->clear = work->farthest;
    for (int axis = 0; axis < 3; axis++)
        for (int sense = -1; sense <= 1; sense += 2) work->clear = fibrad_min(work->clear, room(work, axis, sense));
    work->near.shells = 0;
    work->near.full = false;
    work->near.asked = 0;
}

double fibrad_near_horizon(const fibrad_workspace *work, const double w[3]) {
    double horizon = work->farthest;
    for (int axis = 0; axis < 3; axis++) {
        if (w[axis] != 0) horizon = fibrad_min(horizon, room(work, axis, w[axis]) / fibrad_abs(w[axis]));
    }
    return horizon;
}
