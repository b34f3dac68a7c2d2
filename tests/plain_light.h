/* plain_light.h - light in a bed by plain rays, which share nothing with the kernel. SPDX-License-Identifier: MIT
 *
 * A ray goes from cell to cell of a grid. Each cell lists the spheres that reach into it. Triangles are tried one by
 * one. The ray ends on the nearest sphere or triangle, on a wall, or outside. Diffuse reflections follow the cosine
 * law. */
#ifndef TESTS_PLAIN_LIGHT_H
#define TESTS_PLAIN_LIGHT_H

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "asserts.h"
#include "bed/bed.h"
#include "fibrad_mesh.h"

enum { PLAIN_SIDES = 6, PLAIN_CYLINDER = 6, PLAIN_OUTSIDE = 7, PLAIN_ENDS = 8 };

/* A bed within planes at low and high, and within a cylinder along z of the radius `round`. Infinite numbers mean that
 * there is no plane or cylinder. */
struct plain_bed {
    const struct bed *bed;
    double low[3], high[3], axis[2], round;
    bool open[PLAIN_SIDES]; /* the plane is an opening */
    int cells[3];
    double from[3], size[3];
    uint32_t *first, *sphere;
    const struct fibrad_triangles *triangles; /* NULL: there are none */
};

/* Where a ray ends: on a sphere if sphere >= 0, on a triangle if triangle >= 0, otherwise at one of PLAIN_ENDS. */
struct plain_end {
    int64_t sphere, triangle;
    int side;
    double at[3], normal[3];
};

static inline int plain_cell(const struct plain_bed *p, int axis, double x) {
    return (int)floor((x - p->from[axis]) / p->size[axis]);
}

static inline int plain_wrap(int k, int n) { return (k % n + n) % n; }

/* Counts the spheres of each cell. With `list` it lists them. */
static inline void plain_fill(struct plain_bed *p, bool list) {
    const struct bed *bed = p->bed;
    const double *place[3] = {bed->x, bed->y, bed->z};
    for (uint32_t i = 0; i < bed->n; i++) {
        int low[3], high[3];
        for (int a = 0; a < 3; a++) {
            low[a] = plain_cell(p, a, place[a][i] - bed->r[i]), high[a] = plain_cell(p, a, place[a][i] + bed->r[i]);
            if (bed->period[a] > 0) continue;
            low[a] = low[a] < 0 ? 0 : low[a], high[a] = high[a] >= p->cells[a] ? p->cells[a] - 1 : high[a];
        }
        for (int u = low[0]; u <= high[0]; u++)
            for (int v = low[1]; v <= high[1]; v++)
                for (int w = low[2]; w <= high[2]; w++) {
                    const int cell =
                        plain_wrap(u, p->cells[0]) +
                        p->cells[0] * (plain_wrap(v, p->cells[1]) + p->cells[1] * plain_wrap(w, p->cells[2]));
                    if (list)
                        p->sphere[p->first[cell]++] = i;
                    else
                        p->first[cell + 1]++;
                }
    }
}

static inline struct plain_bed plain_bed_of(const struct bed *bed) {
    struct plain_bed p = {.bed = bed, .low = {-INFINITY, -INFINITY, -INFINITY}, .high = {INFINITY, INFINITY, INFINITY}};
    p.round = INFINITY;
    const double *place[3] = {bed->x, bed->y, bed->z};
    double cell = 0;
    for (uint32_t i = 0; i < bed->n; i++) cell += 2 * bed->r[i] / bed->n;
    for (int a = 0; a < 3; a++) {
        double low = INFINITY, high = -INFINITY;
        for (uint32_t i = 0; i < bed->n; i++)
            low = fmin(low, place[a][i] - bed->r[i]), high = fmax(high, place[a][i] + bed->r[i]);
        if (bed->period[a] > 0) high = low + bed->period[a];
        p.cells[a] = (int)fmax(1, floor((high - low) / cell));
        p.from[a] = low, p.size[a] = (high - low) / p.cells[a];
    }
    const size_t cells = (size_t)p.cells[0] * (size_t)p.cells[1] * (size_t)p.cells[2];
    p.first = calloc(cells + 2, sizeof *p.first);
    plain_fill(&p, false);
    for (size_t k = 1; k <= cells; k++) p.first[k] += p.first[k - 1];
    p.sphere = malloc((p.first[cells] + 1) * sizeof *p.sphere);
    plain_fill(&p, true);
    for (size_t k = cells; k > 0; k--) p.first[k] = p.first[k - 1];
    p.first[0] = 0;
    return p;
}

static inline void plain_free(struct plain_bed *p) { free(p->first), free(p->sphere); }

/* The length of a ray to a sphere, or infinity. The image nearest to a point on the ray counts. */
static inline double plain_meet(const struct plain_bed *p, uint32_t i, const double at[3], const double w[3],
                                const double near[3], double centre[3]) {
    const double *place[3] = {p->bed->x, p->bed->y, p->bed->z};
    double along = 0, square = 0;
    for (int a = 0; a < 3; a++) {
        const double period = p->bed->period[a];
        centre[a] = place[a][i];
        if (period > 0) centre[a] += period * round((near[a] - centre[a]) / period);
        along += w[a] * (centre[a] - at[a]);
    }
    for (int a = 0; a < 3; a++) square += pow(centre[a] - at[a] - along * w[a], 2);
    const double half = p->bed->r[i] * p->bed->r[i] - square;
    if (half <= 0) return INFINITY;
    const double t = along - sqrt(half);
    return t > 1e-9 ? t : INFINITY;
}

/* The wall through which a ray leaves. */
static inline double plain_leave(const struct plain_bed *p, const double at[3], const double w[3], int *side) {
    double nearest = INFINITY;
    *side = PLAIN_OUTSIDE;
    for (int a = 0; a < 3; a++) {
        const double t = ((w[a] > 0 ? p->high[a] : p->low[a]) - at[a]) / w[a];
        if (w[a] == 0 || !(t < nearest)) continue;
        nearest = t, *side = 2 * a + (w[a] > 0);
    }
    if (p->round < INFINITY) {
        const double x = at[0] - p->axis[0], y = at[1] - p->axis[1], across = w[0] * w[0] + w[1] * w[1];
        const double half = x * w[0] + y * w[1], inside = p->round * p->round - x * x - y * y;
        const double t = across > 0 ? (sqrt(fmax(0, half * half + across * inside)) - half) / across : INFINITY;
        if (t < nearest) nearest = t, *side = PLAIN_CYLINDER;
    }
    if (*side < PLAIN_SIDES && p->open[*side]) *side = PLAIN_OUTSIDE;
    return nearest;
}

/* Moves a point on a line along w to where the line enters by an opening. If nothing is there, moves the point back by
 * 100. False: the line enters by a wall, or not at all. */
static inline bool plain_enter(const struct plain_bed *p, double at[3], const double w[3]) {
    double last = -INFINITY, first = INFINITY;
    bool open = true;
    for (int a = 0; a < 3; a++) {
        const double t = ((w[a] > 0 ? p->low[a] : p->high[a]) - at[a]) / w[a],
                     out = ((w[a] > 0 ? p->high[a] : p->low[a]) - at[a]) / w[a];
        if (w[a] == 0 && (at[a] < p->low[a] || at[a] > p->high[a])) return false;
        if (w[a] == 0) continue;
        first = fmin(first, out);
        if (t > last) last = t, open = p->open[2 * a + !(w[a] > 0)];
    }
    if (p->round < INFINITY) {
        const double x = at[0] - p->axis[0], y = at[1] - p->axis[1], across = w[0] * w[0] + w[1] * w[1];
        const double half = x * w[0] + y * w[1], square = half * half + across * (p->round * p->round - x * x - y * y);
        if (square < 0 || (across == 0 && x * x + y * y > p->round * p->round)) return false;
        if (across > 0 && (-half - sqrt(square)) / across > last) return false;
        if (across > 0) first = fmin(first, (sqrt(square) - half) / across);
    }
    if (!open || last > first) return false;
    for (int a = 0; a < 3; a++) at[a] += (last > -INFINITY ? last + 1e-12 : -100) * w[a];
    return true;
}

static inline void plain_cross(const double a[3], const double b[3], double c[3]) {
    for (int k = 0; k < 3; k++) c[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static inline double plain_product(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The first corner of a triangle, and its edges to the other two. */
static inline void plain_edges(const struct fibrad_triangles *t, uint32_t k, double origin[3], double a[3],
                               double b[3]) {
    const double *place[3] = {t->x, t->y, t->z};
    const uint32_t *corner = t->corner + 3 * (size_t)k;
    for (int axis = 0; axis < 3; axis++) {
        origin[axis] = place[axis][corner[0] * t->stride];
        a[axis] = place[axis][corner[1] * t->stride] - origin[axis];
        b[axis] = place[axis][corner[2] * t->stride] - origin[axis];
    }
}

/* The length of a ray to a triangle, or infinity: Cramer's rule for the length and two coordinates on the triangle. */
static inline double plain_triangle(const struct fibrad_triangles *t, uint32_t k, const double at[3],
                                    const double w[3]) {
    double origin[3], a[3], b[3], from[3], wb[3], fa[3];
    plain_edges(t, k, origin, a, b);
    for (int axis = 0; axis < 3; axis++) from[axis] = at[axis] - origin[axis];
    plain_cross(w, b, wb), plain_cross(from, a, fa);
    const double all = plain_product(a, wb), u = plain_product(from, wb) / all, v = plain_product(w, fa) / all;
    const double length = plain_product(b, fa) / all;
    return u >= 0 && v >= 0 && u + v <= 1 && length > 1e-9 ? length : INFINITY;
}

/* Where a ray meets a triangle, and the normal of the side that it meets. */
static inline void plain_on_triangle(const struct fibrad_triangles *t, uint32_t k, const double at[3],
                                     const double w[3], double length, struct plain_end *end) {
    double origin[3], a[3], b[3];
    plain_edges(t, k, origin, a, b);
    plain_cross(a, b, end->normal);
    const double size = sqrt(plain_product(end->normal, end->normal)) * (plain_product(end->normal, w) > 0 ? -1 : 1);
    for (int c = 0; c < 3; c++) end->normal[c] /= size, end->at[c] = at[c] + length * w[c];
}

static inline struct plain_end plain_trace(const struct plain_bed *p, const double at[3], const double w[3]) {
    struct plain_end end = {.sphere = -1, .triangle = -1};
    double step[3], next[3], t = 0, nearest = INFINITY, enter = 0, leave;
    int cell[3];
    const double wall = plain_leave(p, at, w, &end.side);
    leave = wall;
    for (int a = 0; a < 3; a++) { /* the part of the ray within the grid */
        if (p->bed->period[a] > 0 || w[a] == 0) continue;
        const double low = (p->from[a] - at[a]) / w[a], high = low + p->cells[a] * p->size[a] / w[a];
        enter = fmax(enter, fmin(low, high)), leave = fmin(leave, fmax(low, high));
    }
    t = enter;
    for (int a = 0; a < 3; a++) {
        cell[a] = plain_cell(p, a, at[a] + (t + 1e-12) * w[a]);
        if (!(p->bed->period[a] > 0)) cell[a] = cell[a] < 0 ? 0 : cell[a] >= p->cells[a] ? p->cells[a] - 1 : cell[a];
        step[a] = w[a] != 0 ? p->size[a] / fabs(w[a]) : INFINITY;
        next[a] = w[a] != 0 ? (p->from[a] + p->size[a] * (cell[a] + (w[a] > 0)) - at[a]) / w[a] : INFINITY;
    }
    while (t < leave && t < nearest && t < 1e4) {
        int number = 0;
        double middle[3], centre[3];
        for (int a = 2; a >= 0; a--) {
            number = number * p->cells[a] + plain_wrap(cell[a], p->cells[a]);
            middle[a] = p->from[a] + p->size[a] * (cell[a] + .5);
        }
        for (uint32_t k = p->first[number]; k < p->first[number + 1]; k++) {
            const double length = plain_meet(p, p->sphere[k], at, w, middle, centre);
            if (!(length < nearest) || length > wall) continue;
            nearest = length, end.sphere = p->sphere[k];
            for (int a = 0; a < 3; a++)
                end.at[a] = at[a] + length * w[a], end.normal[a] = (end.at[a] - centre[a]) / p->bed->r[p->sphere[k]];
        }
        int a = next[1] < next[0] ? 1 : 0;
        if (next[2] < next[a]) a = 2;
        t = next[a], next[a] += step[a], cell[a] += w[a] > 0 ? 1 : -1;
    }
    for (uint32_t k = 0; p->triangles && k < p->triangles->n; k++) {
        const double length = plain_triangle(p->triangles, k, at, w);
        if (length < nearest && length < wall) nearest = length, end.sphere = -1, end.triangle = k;
    }
    if (end.triangle >= 0) plain_on_triangle(p->triangles, (uint32_t)end.triangle, at, w, nearest, &end);
    if (end.sphere >= 0 || end.triangle >= 0) return end;
    for (int a = 0; a < 3; a++) {
        end.at[a] = at[a] + wall * w[a];
        end.normal[a] = end.side == 2 * a ? 1 : end.side == 2 * a + 1 ? -1 : 0;
    }
    if (end.side == PLAIN_CYLINDER)
        for (int a = 0; a < 2; a++) end.normal[a] = (p->axis[a] - end.at[a]) / p->round;
    return end;
}

/* A random number in [0, 1): splitmix64. */
static inline double plain_random(uint64_t *state) {
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return (double)((z ^ z >> 31) >> 11) * 0x1p-53;
}

/* A direction by the cosine law about a normal. */
static inline void plain_scatter(const double normal[3], uint64_t *state, double w[3]) {
    const double z = 2 * plain_random(state) - 1, turn = 2 * PI * plain_random(state), ring = sqrt(1 - z * z);
    const double u[3] = {ring * cos(turn), ring * sin(turn), z};
    double size = 0;
    for (int a = 0; a < 3; a++) w[a] = normal[a] + u[a], size += w[a] * w[a];
    for (int a = 0; a < 3; a++) w[a] /= sqrt(size);
}

#endif
