/* drift.c - which rows of a bed may be kept when its spheres move. SPDX-License-Identifier: MIT */
#include "base/vector.h"
#include "scene/grid_walk.h"

/* If sphere j moves by delta, its edge as seen from sphere i sweeps over DRIFT_FACTOR F delta/width of the row. The
 * factor is an upper bound of what was measured, docs/methods.md section 10. */
#define DRIFT_FACTOR 2.0

static bool alike(const fibrad_scene *a, const fibrad_scene *b) {
    if (a == NULL || b == NULL || a->facts.spheres != b->facts.spheres) return false;
    for (int axis = 0; axis < 3; axis++)
        if (!(a->period[axis] == b->period[axis])) return false;
    return true;
}

/* 1/period of each axis; 0 if it is open. */
static void inverse_periods(const fibrad_scene *scene, double inverse[3]) {
    for (int axis = 0; axis < 3; axis++) inverse[axis] = scene->period[axis] > 0 ? 1 / scene->period[axis] : 0;
}

/* c minus the whole periods that leave the shortest vector. */
static void shorten(const fibrad_scene *scene, const double inverse[3], double c[3]) {
    for (int axis = 0; axis < 3; axis++) c[axis] -= scene->period[axis] * fibrad_floor(c[axis] * inverse[axis] + 0.5);
}

/* The vector from one place of a scene to the nearest image of another. */
static void way(const fibrad_scene *scene, const double inverse[3], uint32_t from, uint32_t to, double c[3]) {
    c[0] = scene->x[to] - scene->x[from], c[1] = scene->y[to] - scene->y[from], c[2] = scene->z[to] - scene->z[from];
    shorten(scene, inverse, c);
}

int fibrad_drift_row(const fibrad_scene *before, const fibrad_scene *now, uint32_t i, const uint32_t *col,
                     uint32_t length, double *error) {
    if (!alike(before, now) || error == NULL || i >= now->facts.spheres || (length > 0 && col == NULL))
        return FIBRAD_E_ARGUMENT;
    if (!fibrad_scene_ready(before) || !fibrad_scene_ready(now)) return FIBRAD_E_STATE;
    for (uint32_t k = 0; k < length; k++)
        if (col[k] >= now->facts.spheres) return FIBRAD_E_ARGUMENT;
    uint32_t then_i = before->place[i], now_i = now->place[i];
    double r_i = now->r[now_i], sum = 0, inverse[3];
    inverse_periods(now, inverse);
    for (uint32_t k = 0; k < length; k++) {
        uint32_t then_j = before->place[col[k]], now_j = now->place[col[k]];
        double from[3], to[3], r = now->r[now_j];
        way(before, inverse, then_i, then_j, from);
        way(now, inverse, now_i, now_j, to);
        double nearest = fibrad_min(fibrad_dot(from, from), fibrad_dot(to, to));
        if (nearest == 0) continue; /* images of i move as i does */
        for (int axis = 0; axis < 3; axis++) to[axis] -= from[axis];
        shorten(now, inverse, to);
        double width = fibrad_min(r, fibrad_max(fibrad_sqrt(nearest) - r, r_i)), rate = r * r / (4 * nearest * width);
        sum += rate * rate * fibrad_dot(to, to);
    }
    *error = DRIFT_FACTOR * fibrad_sqrt(sum);
    return FIBRAD_OK;
}

int fibrad_drift_partners(const fibrad_scene *now, uint32_t i, const fibrad_row *before, const fibrad_row *row,
                          double *error) {
    if (now == NULL || before == NULL || row == NULL || error == NULL || i >= now->facts.spheres)
        return FIBRAD_E_ARGUMENT;
    if (!fibrad_scene_ready(now)) return FIBRAD_E_STATE;
    const fibrad_row *rows[2] = {before, row};
    for (int which = 0; which < 2; which++) {
        if (rows[which]->length > 0 && (rows[which]->col == NULL || rows[which]->f == NULL)) return FIBRAD_E_ARGUMENT;
        for (uint32_t k = 0; k < rows[which]->length; k++)
            if (rows[which]->col[k] >= now->facts.spheres || !(rows[which]->f[k] >= 0 && rows[which]->f[k] <= 2))
                return FIBRAD_E_ARGUMENT;
    }
    double r_i = now->r[now->place[i]];
    for (uint32_t p = 0, q = 0; p < before->length || q < row->length;) {
        uint32_t own = p < before->length ? before->col[p] : UINT32_MAX;
        uint32_t other = q < row->length ? row->col[q] : UINT32_MAX, j = own < other ? own : other;
        double was = own == j ? before->f[p++] : 0, is = other == j ? row->f[q++] : 0;
        if (is <= 2 * was) continue; /* row j saw this sphere before, and counts it */
        double ratio = r_i / now->r[now->place[j]], change = DRIFT_FACTOR * (is - was) * ratio * ratio;
        error[j] = fibrad_sqrt(error[j] * error[j] + change * change);
    }
    return FIBRAD_OK;
}
