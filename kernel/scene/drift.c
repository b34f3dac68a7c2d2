/* drift.c - which rows of a bed may be kept when its spheres move. SPDX-License-Identifier: MIT */
#include "scene/grid_walk.h"

/* Seen from sphere i, the edge of sphere j sweeps over FACTOR F delta/width of the row when j moves by delta. The
 * factor bounds what was measured, docs/methods.md section 10. */
#define FACTOR 2.0

/* Rounding of distances, relative. */
#define MARGIN 1e-12

static bool alike(const fibrad_scene *a, const fibrad_scene *b) {
    if (a == NULL || b == NULL || a->facts.spheres != b->facts.spheres) return false;
    for (int axis = 0; axis < 3; axis++)
        if (!(a->period[axis] == b->period[axis])) return false;
    return true;
}

static double square(const double c[3]) { return c[0] * c[0] + c[1] * c[1] + c[2] * c[2]; }

/* 1/period of each axis; 0 if it is open. */
static void inverse_periods(const fibrad_scene *scene, double inverse[3]) {
    for (int axis = 0; axis < 3; axis++) inverse[axis] = scene->period[axis] > 0 ? 1 / scene->period[axis] : 0;
}

/* c less the whole periods that leave it shortest. */
static void shorten(const fibrad_scene *scene, const double inverse[3], double c[3]) {
    for (int axis = 0; axis < 3; axis++) c[axis] -= scene->period[axis] * fibrad_floor(c[axis] * inverse[axis] + 0.5);
}

/* The way between two places of a scene, to the nearest image. */
static void way(const fibrad_scene *scene, const double inverse[3], uint32_t from, uint32_t to, double c[3]) {
    c[0] = scene->x[to] - scene->x[from], c[1] = scene->y[to] - scene->y[from], c[2] = scene->z[to] - scene->z[from];
    shorten(scene, inverse, c);
}
int fibrad_moved_error(const fibrad_scene *before, const fibrad_scene *now, uint32_t i, const fibrad_row *row,
                       double *error) {
    if (!alike(before, now) || row == NULL || error == NULL || i >= now->facts.spheres) return FIBRAD_E_ARGUMENT;
    if (row->length > 0 && row->col == NULL) return FIBRAD_E_ARGUMENT;
    for (uint32_t k = 0; k < row->length; k++)
        if (row->col[k] >= now->facts.spheres) return FIBRAD_E_ARGUMENT;
    uint32_t then_i = before->place[i], now_i = now->place[i];
    double r_i = now->r[now_i], sum = 0, inverse[3];
    inverse_periods(now, inverse);
    for (uint32_t k = 0; k < row->length; k++) {
        uint32_t then_j = before->place[row->col[k]], now_j = now->place[row->col[k]];
        double from[3], to[3], r = now->r[now_j];
        way(before, inverse, then_i, then_j, from);
        way(now, inverse, now_i, now_j, to);
        double nearest = fibrad_min(square(from), square(to));
        if (nearest == 0) continue; /* images of i move as it does */
        for (int axis = 0; axis < 3; axis++) to[axis] -= from[axis];
        shorten(now, inverse, to);
        double width = fibrad_min(r, fibrad_max(fibrad_sqrt(nearest) - r, r_i)), rate = r * r / (4 * nearest * width);
        sum += rate * rate * square(to);
    }
    *error = FACTOR * fibrad_sqrt(sum);
    return FIBRAD_OK;
}

int fibrad_moved_seen(const fibrad_scene *now, uint32_t i, const fibrad_row *before, const fibrad_row *row,
                      double *error) {
    if (now == NULL || before == NULL || row == NULL || error == NULL || i >= now->facts.spheres)
        return FIBRAD_E_ARGUMENT;
    const fibrad_row *rows[2] = {before, row};
    for (int which = 0; which < 2; which++) {
        if (rows[which]->length > 0 && (rows[which]->col == NULL || rows[which]->f == NULL)) return FIBRAD_E_ARGUMENT;
        for (uint32_t k = 0; k < rows[which]->length; k++)
            if (rows[which]->col[k] >= now->facts.spheres) return FIBRAD_E_ARGUMENT;
    }
    double r_i = now->r[now->place[i]];
    for (uint32_t p = 0, q = 0; p < before->length || q < row->length;) {
        uint32_t own = p < before->length ? before->col[p] : UINT32_MAX;
        uint32_t other = q < row->length ? row->col[q] : UINT32_MAX, j = own < other ? own : other;
        double was = own == j ? before->f[p++] : 0, is = other == j ? row->f[q++] : 0;
        if (is <= 2 * was) continue; /* row j had it, and knows */
        double ratio = r_i / now->r[now->place[j]], change = FACTOR * (is - was) * ratio * ratio;
        error[j] = fibrad_sqrt(error[j] * error[j] + change * change);
    }
    return FIBRAD_OK;
}

static bool same_walls(const fibrad_container *a, const fibrad_container *b) {
    for (int axis = 0; axis < 3; axis++)
        if (a->low[axis] != b->low[axis] || a->high[axis] != b->high[axis]) return false;
    return a->axis[0] == b->axis[0] && a->axis[1] == b->axis[1] && a->radius == b->radius;
}

/* Marks the spheres of `scene`, in the order of its cells, that are not where they are in the other, to the bit.
 * Returns whether there are any. */
static bool mark(const fibrad_scene *scene, const fibrad_scene *other, unsigned char *moved) {
    bool any = false;
    for (uint32_t k = 0; k < scene->facts.spheres; k++) {
        uint32_t to = other->place[scene->order[k]];
        moved[k] = !(scene->x[k] == other->x[to] && scene->y[k] == other->y[to] && scene->z[k] == other->z[to] &&
                     scene->r[k] == other->r[to]);
        any |= moved[k];
    }
    return any;
}

/* Whether a sphere that has moved could come before a window of the one at `place`, down to depth `reach`. */
static bool disturbed(const fibrad_scene *scene, const unsigned char *moved, uint32_t place, double reach) {
    double centre[3] = {scene->x[place], scene->y[place], scene->z[place]}, radius = scene->r[place];
    for (uint32_t l = 0; l < scene->levels; l++) {
        double wide = radius + scene->level[l].radius_max, low[3], high[3];
        double ball = fibrad_sqrt(reach * reach + wide * wide) * (1 + MARGIN);
        for (int axis = 0; axis < 3; axis++) low[axis] = centre[axis] - ball, high[axis] = centre[axis] + ball;
        fibrad_walk walk;
        fibrad_walk_begin(&walk, scene, &scene->level[l], low, high);
        while (fibrad_walk_next(&walk))
            for (uint32_t k = walk.begin; k < walk.end; k++) {
                if (!moved[k]) continue;
                double sum = radius + scene->r[k];
                double c[3] = {scene->x[k] - centre[0] + walk.shift[0], scene->y[k] - centre[1] + walk.shift[1],
                               scene->z[k] - centre[2] + walk.shift[2]};
                if (square(c) <= (reach * reach + sum * sum) * (1 + 4 * MARGIN)) return true;
            }
    }
    return false;
}

int fibrad_moved_same(const fibrad_scene *before, const fibrad_scene *now, const double *reach, unsigned char *scratch,
                      unsigned char *same) {
    if (!alike(before, now) || reach == NULL || scratch == NULL || same == NULL) return FIBRAD_E_ARGUMENT;
    uint32_t n = now->facts.spheres;
    for (uint32_t i = 0; i < n; i++)
        if (!(reach[i] >= 0)) return FIBRAD_E_ARGUMENT;
    unsigned char *then_moved = scratch, *now_moved = scratch + n;
    mark(before, now, then_moved);
    bool any = mark(now, before, now_moved), walls = same_walls(&before->container, &now->container);
    for (uint32_t i = 0; i < n; i++) {
        uint32_t then_place = before->place[i], now_place = now->place[i];
        if (!any || !walls)
            same[i] = walls;
        else if (now_moved[now_place] || !fibrad_finite(reach[i]))
            same[i] = 0;
        else
            same[i] =
                !disturbed(before, then_moved, then_place, reach[i]) && !disturbed(now, now_moved, now_place, reach[i]);
    }
    return FIBRAD_OK;
}
