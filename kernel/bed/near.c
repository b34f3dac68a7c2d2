/* near.c - which spheres can come before the windows of a sphere: shells of near ones for all directions, and a march
 * along one direction for what lies beyond. SPDX-License-Identifier: MIT */
#include "bed/work.h"

/* How far along an axis, forwards or backwards, there may be spheres that come before a window. */
static double room(const fibrad_work *work, int axis, double sense) {
    const fibrad_scene *scene = work->scene;
    double far = sense > 0 ? scene->high[axis] - work->centre[axis] : work->centre[axis] - scene->low[axis];
    if (scene->period[axis] > 0) far = FIBRAD_PERIODS * scene->period[axis];
    return (far + (work->unit + scene->facts.radius_max)) * work->inverse;
}

void fibrad_work_begin(fibrad_work *work, const fibrad_scene *scene, uint32_t place, double cutoff,
                       fibrad_stride stride) {
    for (uint32_t k = 0; k < work->entries.length; k++) work->entries.at[work->entries.slot[k]] = FIBRAD_NONE;
    work->entries.length = work->entries.missed = 0;
    work->entries.end = false;
    fibrad_zero(work->wall, sizeof work->wall);
    work->needed = work->config;
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
    work->deepest = 0;
    work->near.shells = 0;
    work->near.full = false;
}

double fibrad_near_horizon(const fibrad_work *work, const double w[3]) {
    double horizon = work->farthest;
    for (int axis = 0; axis < 3; axis++) {
        if (w[axis] != 0) horizon = fibrad_min(horizon, room(work, axis, w[axis]) / fibrad_abs(w[axis]));
    }
    return horizon;
}

/* How far it is from `edge`, a place along an axis, to where the grid begins, or, beyond the grid, for ever: only stray
 * spheres are there. 0 within the grid and on a periodic axis. */
static double outside(const fibrad_work *work, int along, double sense, double edge) {
    const fibrad_scene *scene = work->scene;
    if (scene->period[along] > 0) return 0;
    const double low = (scene->box_low[along] - work->centre[along]) * sense * work->inverse;
    const double high = (scene->box_high[along] - work->centre[along]) * sense * work->inverse;
    if (edge >= fibrad_max(low, high)) return __builtin_inf();
    return fibrad_max(0, fibrad_min(low, high) - edge);
}

/* Spheres of one level, emerging in (from, to], lie in a stretch of the tube of radius 1 + r about the beam, or of
 * radius r about a ray of it. It is cut into layers of cells across the axis the beam is most nearly along, so that the
 * boxes walked hug the tube. Outside the grid layers grow, up to where the tube passes one period of another axis. */
static void march_level(fibrad_work *work, const fibrad_level *level, const double frame[9], const fibrad_tube *tube,
                        double from, double to) {
    const fibrad_scene *scene = work->scene;
    const double *w = frame + 6, radius = level->radius_max * work->inverse;
    double wide = tube->radius + radius, deepest = fibrad_sqrt(to * to + (1 + radius) * (1 + radius)), middle[3];
    for (int axis = 0; axis < 3; axis++) middle[axis] = tube->u * frame[axis] + tube->v * frame[3 + axis];
    int along = 0;
    for (int axis = 1; axis < 3; axis++)
        if (fibrad_abs(w[axis]) > fibrad_abs(w[along])) along = axis;
    double side = wide * fibrad_sqrt(fibrad_max(0, 1 - w[along] * w[along])); /* reach of the tube's cross-section */
    double first = fibrad_max(from, 0) * fibrad_abs(w[along]) - side, last = deepest * fibrad_abs(w[along]) + side;
    double sense = w[along] < 0 ? -1 : 1;
    first += sense * middle[along], last += sense * middle[along];
    double stride = last - first;
    for (int axis = 0; axis < 3; axis++)
        if (axis != along && scene->period[axis] > 0 && w[axis] != 0)
            stride = fibrad_min(stride, scene->period[axis] * work->inverse * fibrad_abs(w[along] / w[axis]));
    stride = fibrad_max(stride, level->cell[along] * work->inverse);
    if (scene->period[along] == 0) { /* nothing beyond the box */
        double start = sense > 0 ? scene->low[along] - work->centre[along] : work->centre[along] - scene->high[along];
        double stop = sense > 0 ? scene->high[along] - work->centre[along] : work->centre[along] - scene->low[along];
        first = fibrad_max(first, start * work->inverse), last = fibrad_min(last, stop * work->inverse);
    }
    /* layers [edge, edge + thick) along that axis, in radii from the centre; they need not match the cells, but then a
     * sphere could be met twice: its own place along the axis decides which layer it belongs to */
    const double cell = level->cell[along] * work->inverse;
    double thick = cell;
    for (double edge = first; edge <= last; edge += thick) {
        double clear = outside(work, along, sense, edge);
        thick = clear > cell ? fibrad_min(fibrad_min(2 * thick, stride), clear) : cell;
        double height = edge - sense * middle[along];
        double near_depth = (height - side) / fibrad_abs(w[along]);
        double far_depth = (height + thick + side) / fibrad_abs(w[along]);
        near_depth = fibrad_max(near_depth, fibrad_max(from, 0)), far_depth = fibrad_min(far_depth, deepest);
        double low[3], high[3];
        for (int axis = 0; axis < 3; axis++) {
            double lateral = wide * fibrad_sqrt(fibrad_max(0, 1 - w[axis] * w[axis]));
            double a = near_depth * w[axis], b = far_depth * w[axis];
            low[axis] = middle[axis] + fibrad_min(a, b) - lateral;
            high[axis] = middle[axis] + fibrad_max(a, b) + lateral;
        }
        low[along] = sense > 0 ? edge : -edge - thick, high[along] = sense > 0 ? edge + thick : -edge;
        for (int axis = 0; axis < 3; axis++) {
            low[axis] = work->centre[axis] + low[axis] * work->unit;
            high[axis] = work->centre[axis] + high[axis] * work->unit;
        }
        fibrad_walk walk;
        fibrad_walk_begin(&walk, scene, level, low, high);
        while (fibrad_walk_next(&walk)) {
            bool image = walk.shift[0] != 0 || walk.shift[1] != 0 || walk.shift[2] != 0;
            for (uint32_t j = walk.begin; j < walk.end; j++) {
                double c[3] = {(scene->x[j] - work->centre[0] + walk.shift[0]) * work->inverse,
                               (scene->y[j] - work->centre[1] + walk.shift[1]) * work->inverse,
                               (scene->z[j] - work->centre[2] + walk.shift[2]) * work->inverse};
                double r = scene->r[j] * work->inverse, place = sense * c[along];
                if (!(place >= edge && place < edge + thick) || (j == work->place && !image)) continue;
                double square = c[0] * c[0] + c[1] * c[1] + c[2] * c[2], e = square - (1 + r) * (1 + r);
                if ((from < 0 || e > from * from) && e <= to * to && square <= work->reach * work->reach)
                    fibrad_work_add_disc(work, frame, c[0], c[1], c[2], r, j);
            }
        }
    }
}

void fibrad_near_march(fibrad_work *work, const double frame[9], const fibrad_tube *tube, double from, double to) {
    for (uint32_t l = 0; l < work->scene->levels; l++) march_level(work, &work->scene->level[l], frame, tube, from, to);
}
