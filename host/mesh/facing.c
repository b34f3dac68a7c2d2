/* facing.c - on which side of a surface spheres lie. SPDX-License-Identifier: MIT
 *
 * The nearest triangle tells the side. If the nearest point lies on an edge or corner of several triangles, all of them
 * have to agree. If it lies on an edge of one triangle alone, the side is unknown. */
#include "mesh/welded.h"

#include <math.h>
#include <stdlib.h>

#include "cli/message.h"
#include "simple/nearest.h"

#define TIED 1e-9 /* relative difference of squared distances that count as equal */
enum { VOTERS_MOST = 1000, VOTERS_LEAST = 50 };
#define VOTES_MOST 2e7 /* distances from a sphere to a triangle, in all */

/* A ball about a triangle. */
struct ball {
    double centre[3], radius;
};

/* The nearest triangles so far. */
struct nearest {
    double square; /* squared distance */
    int side;      /* 1: the point is before them; -1: behind them; 0: they do not agree */
    bool edge;     /* there is one triangle, and the nearest point lies on its edge */
};

static struct ball ball_of(const struct surface *surface, uint32_t triangle) {
    struct ball ball = {.radius = 0};
    for (int k = 0; k < 3; ++k)
        for (int axis = 0; axis < 3; ++axis) ball.centre[axis] += surface_corner(surface, triangle, k)[axis] / 3;
    for (int k = 0; k < 3; ++k)
        ball.radius = fmax(ball.radius, surface_distance(surface_corner(surface, triangle, k), ball.centre));
    return ball;
}

/* Finds squared distance and side of a point and a triangle, and whether the nearest point lies on an edge. False: the
 * triangle has no area. */
static bool to_triangle(const struct surface *surface, uint32_t triangle, const double p[3], struct nearest *found) {
    double normal[3], corner[3][3], to[3];
    bool inside;
    for (int k = 0; k < 3; ++k)
        for (int axis = 0; axis < 3; ++axis) corner[k][axis] = surface_corner(surface, triangle, k)[axis] - p[axis];
    surface_normal(surface, triangle, normal);
    const double distance = nearest_on_triangle(corner, to, &inside), depth = inner(normal, corner[0]);
    *found = (struct nearest){.square = distance * distance, .side = depth < 0 ? 1 : depth > 0 ? -1 : 0};
    found->edge = !inside;
    return inner(normal, normal) > 0;
}

/* Updates the nearest triangles with one more triangle. In a periodic bed the nearest image of the point counts. */
static void try_triangle(const struct surface *surface, uint32_t triangle, const struct ball *ball,
                         const double point[3], const double period[3], struct nearest *best) {
    double p[3], away = 0;
    for (int axis = 0; axis < 3; ++axis) {
        p[axis] = point[axis];
        if (period[axis] > 0) p[axis] -= period[axis] * round((p[axis] - ball->centre[axis]) / period[axis]);
        away += (p[axis] - ball->centre[axis]) * (p[axis] - ball->centre[axis]);
    }
    struct nearest found;
    const double reach = sqrt(best->square) * (1 + TIED) + ball->radius;
    if (away > reach * reach || !to_triangle(surface, triangle, p, &found)) return;
    if (surface->turned[triangle]) found.side = -found.side;
    if (found.square < best->square * (1 - TIED)) {
        *best = found;
    } else if (found.square <= best->square * (1 + TIED)) {
        best->edge = false;
        if (found.side != best->side) best->side = 0;
    }
}

/* Finds the nearest triangles of a component. ball [n]: balls of all triangles; NULL: not known. */
static struct nearest nearest_of(const struct surface *surface, const struct component *component,
                                 const struct ball *ball, const double point[3], const double period[3]) {
    struct nearest best = {.square = INFINITY};
    for (uint32_t k = component->first; k < component->first + component->n; ++k) {
        const uint32_t t = surface->in_components[k];
        const struct ball about = ball ? ball[t] : ball_of(surface, t);
        try_triangle(surface, t, &about, point, period, &best);
    }
    if (best.edge) best.side = 0;
    return best;
}

double facing_distance(const struct surface *surface, const struct component *component, const double point[3],
                       const double period[3], int *side) {
    const struct nearest best = nearest_of(surface, component, NULL, point, period);
    *side = best.side;
    return sqrt(best.square);
}

static uint32_t voters_of(const struct surface *surface, uint32_t spheres) {
    const double voters = fmin(fmax(VOTES_MOST / surface->n, VOTERS_LEAST), VOTERS_MOST);
    return voters < spheres ? (uint32_t)voters : spheres;
}

int facing_votes(const struct surface *surface, const fibrad_spheres *spheres, const double period[3], double *votes) {
    const uint32_t voters = voters_of(surface, spheres->n);
    struct ball *ball = malloc(((size_t)surface->n + 1) * sizeof *ball);
    if (!ball) return message_memory();
    for (uint32_t t = 0; t < surface->n; ++t) ball[t] = ball_of(surface, t);
    for (uint32_t component = 0; component < surface->components; ++component) {
        votes[component] = 0;
        for (uint32_t voter = 0; voter < voters; ++voter) {
            const uint32_t i = (uint32_t)((uint64_t)spheres->n * voter / voters);
            const double centre[3] = {spheres->x[i], spheres->y[i], spheres->z[i]}, r = spheres->r[i];
            const struct nearest best = nearest_of(surface, &surface->component[component], ball, centre, period);
            if (best.side != 0) votes[component] += best.side * fmin(r * r / best.square, 1);
        }
    }
    free(ball);
    return STATUS_OK;
}

double facing_volume(const struct surface *surface, const struct component *component) {
    const double *from = surface_corner(surface, surface->in_components[component->first], 0);
    double volume = 0, normal[3];
    for (uint32_t k = component->first; k < component->first + component->n; ++k) {
        const uint32_t t = surface->in_components[k];
        const double *at = surface_corner(surface, t, 0);
        surface_normal(surface, t, normal);
        const double six = inner(normal, (const double[]){at[0] - from[0], at[1] - from[1], at[2] - from[2]});
        volume += (surface->turned[t] ? -six : six) / 6;
    }
    return volume;
}
