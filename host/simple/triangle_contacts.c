/* triangle_contacts.c - spheres that touch walls of triangles. SPDX-License-Identifier: MIT
 *
 * A sphere touches a wall where a triangle is nearest to its centre. Beside that place other triangles of the same flat
 * or hollow part are within reach, too. They lie in front of the plane through the nearest place no more than by a
 * tenth of the distance, and are not counted. In a corner of a wall there are two such places or three. */
#include <math.h>
#include <stdlib.h>

#include "simple/contact_list.h"
#include "simple/nearest.h"

/* A place of a wall within reach of a sphere. */
struct touch {
    uint32_t sphere, wall;
    double distance, to[3]; /* from the centre to the place */
};

struct touches {
    struct touch *touch;
    size_t n, capacity;
};

static int add_touch(struct touches *all, const struct touch *touch) {
    if (all->n == all->capacity) {
        const size_t capacity = all->capacity ? 2 * all->capacity : 256;
        struct touch *larger = realloc(all->touch, capacity * sizeof *larger);
        if (!larger) return FIBRAD_E_MEMORY;
        all->touch = larger, all->capacity = capacity;
    }
    all->touch[all->n++] = *touch;
    return FIBRAD_OK;
}

/* Looks for spheres within reach of a triangle of one wall. The nearest image counts. */
static int touch_triangle(const struct triangle_search *s, double corner[3][3], uint32_t wall, struct touches *all) {
    double middle[3], wide = 0;
    for (int k = 0; k < 3; ++k) middle[k] = (corner[0][k] + corner[1][k] + corner[2][k]) / 3;
    for (int c = 0; c < 3; ++c)
        wide = larger_of(wide, length_of(corner[c][0] - middle[0], corner[c][1] - middle[1], corner[c][2] - middle[2]));
    for (uint32_t i = 0; i < s->n; ++i) {
        const double reach = s->at[i][3] * (1 + s->gas_reach);
        double from[3][3];
        struct touch touch = {.sphere = i, .wall = wall};
        bool near = true, inside;
        for (int k = 0; k < 3 && near; ++k) {
            const double period = s->period[k], less = middle[k] - s->at[i][k],
                         image = period > 0 ? period * round(less / period) : 0;
            near = fabs(less - image) < wide + reach;
            for (int c = 0; c < 3; ++c) from[c][k] = corner[c][k] - s->at[i][k] - image;
        }
        if (!near) continue;
        touch.distance = nearest_on_triangle(from, touch.to, &inside);
        if (touch.distance < reach && add_touch(all, &touch)) return FIBRAD_E_MEMORY;
    }
    return FIBRAD_OK;
}

static int by_distance(const void *a, const void *b) {
    const struct touch *x = a, *y = b;
    if (x->sphere != y->sphere) return x->sphere < y->sphere ? -1 : 1;
    if (x->wall != y->wall) return x->wall < y->wall ? -1 : 1;
    if (x->distance != y->distance) return x->distance < y->distance ? -1 : 1;
    for (int k = 0; k < 3; ++k)
        if (x->to[k] != y->to[k]) return x->to[k] < y->to[k] ? -1 : 1;
    return 0;
}

/* Whether place k lies beside a nearer one of the same sphere and wall that counts. counts: of the places before k. */
static bool is_beside(const struct touches *all, const bool *counts, size_t k) {
    const struct touch *touch = &all->touch[k];
    for (size_t j = k; j-- > 0 && all->touch[j].sphere == touch->sphere && all->touch[j].wall == touch->wall;)
        if (counts[j] && lies_beside(touch->to, all->touch[j].to)) return true;
    return false;
}

static int keep_touches(const struct triangle_search *s, struct touches *all, struct contact_block *block) {
    bool *counts = malloc(all->n + 1);
    int status = counts ? FIBRAD_OK : FIBRAD_E_MEMORY;
    if (all->n > 0) qsort(all->touch, all->n, sizeof *all->touch, by_distance);
    for (size_t k = 0; k < all->n && !status; ++k) {
        const struct touch *t = &all->touch[k];
        counts[k] = !is_beside(all, counts, k);
        if (counts[k])
            status = fibrad_contact_add(
                block, &(struct contact_found){t->sphere, s->n + t->wall, t->distance, s->at[t->sphere][3], INFINITY});
    }
    free(counts);
    return status;
}

int fibrad_contact_triangles(const struct fibrad_triangles *triangles, const struct triangle_search *search,
                             struct contact_block *block) {
    const size_t stride = triangles->stride ? triangles->stride : 1;
    struct touches all = {NULL, 0, 0};
    int status = FIBRAD_OK;
    for (uint32_t t = 0; t < triangles->n && !status; ++t) {
        double corner[3][3];
        for (int c = 0; c < 3; ++c) {
            const size_t v = triangles->corner[3 * (size_t)t + (size_t)c] * stride;
            corner[c][0] = triangles->x[v], corner[c][1] = triangles->y[v], corner[c][2] = triangles->z[v];
        }
        const uint32_t front = triangles->front[t], back = triangles->back ? triangles->back[t] : FIBRAD_NO_WALL;
        if (front != FIBRAD_NO_WALL) status = touch_triangle(search, corner, front, &all);
        if (!status && back != FIBRAD_NO_WALL && back != front) status = touch_triangle(search, corner, back, &all);
    }
    if (!status) status = keep_touches(search, &all, block);
    free(all.touch);
    return status;
}
