/* weld.c - joins equal corners, leaves out triangles without area and triangles that occur twice.
 * SPDX-License-Identifier: MIT
 *
 * Points lie in cells of a grid, which a hash table finds. Cells are much wider than the distance of points that are
 * joined. So the points near a point lie in one or two cells along each axis. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "mesh/welded.h"

#define NEAR 1e-6  /* distance over the mean edge within which corners are joined */
#define WIDE 1e3   /* width of a cell over that distance */
#define FLAT 1e-14 /* height over length of a triangle without area */
#define NONE UINT32_MAX

/* A hash table of lists: of points by their cells, or of triangles by their corners. */
struct table {
    uint32_t size;  /* a power of 2 */
    uint32_t *head; /* [size] */
    uint32_t *next; /* [things] the next one in the list; NONE ends a list */
};

static int table_open(struct table *table, uint64_t things) {
    *table = (struct table){.size = 64};
    while (table->size < things && table->size < UINT32_C(1) << 31) table->size *= 2;
    table->head = malloc(table->size * sizeof *table->head);
    table->next = malloc((things + 1) * sizeof *table->next);
    if (!table->head || !table->next) return message_memory();
    memset(table->head, 0xff, table->size * sizeof *table->head);
    return STATUS_OK;
}

static void table_close(struct table *table) {
    free(table->head);
    free(table->next);
}

static uint32_t *table_head(const struct table *table, const uint64_t key[3]) {
    uint64_t hash = 0;
    for (int k = 0; k < 3; ++k) {
        hash = (hash ^ key[k]) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 32;
    }
    return &table->head[hash & (table->size - 1)];
}

static void table_put(struct table *table, uint32_t *head, uint32_t thing) {
    table->next[thing] = *head;
    *head = thing;
}

static uint32_t *head_of_cell(const struct table *table, const double cell[3]) {
    uint64_t key[3];
    memcpy(key, cell, sizeof key);
    return table_head(table, key);
}

static bool is_near(const double a[3], const double b[3], double distance) {
    return fabs(a[0] - b[0]) <= distance && fabs(a[1] - b[1]) <= distance && fabs(a[2] - b[2]) <= distance;
}

/* Finds a vertex at a point, or else near the point. NONE: there is none. */
static uint32_t find_near(const struct surface *surface, const struct table *table, const double point[3],
                          double near) {
    double cell[2][3];
    uint32_t found = NONE;
    for (int axis = 0; axis < 3; ++axis) {
        cell[0][axis] = floor((point[axis] - near) / (WIDE * near)) + 0.; /* no -0 */
        cell[1][axis] = floor((point[axis] + near) / (WIDE * near)) + 0.;
    }
    for (int k = 0; k < 8; ++k) {
        const double c[3] = {cell[k & 1][0], cell[k >> 1 & 1][1], cell[k >> 2][2]};
        if ((k & 1 && cell[1][0] == cell[0][0]) || (k & 2 && cell[1][1] == cell[0][1]) ||
            (k & 4 && cell[1][2] == cell[0][2]))
            continue;
        for (uint32_t v = *head_of_cell(table, c); v != NONE; v = table->next[v]) {
            if (is_near(surface->vertex[v], point, 0)) return v;
            if (is_near(surface->vertex[v], point, near)) found = v;
        }
    }
    return found;
}

static uint32_t weld_point(struct surface *surface, struct table *table, const double point[3], double near) {
    const uint32_t found = find_near(surface, table, point, near);
    if (found != NONE) {
        surface->snapped += !is_near(surface->vertex[found], point, 0);
        return found;
    }
    double cell[3];
    for (int axis = 0; axis < 3; ++axis) {
        cell[axis] = floor(point[axis] / (WIDE * near)) + 0.;
        surface->vertex[surface->vertices][axis] = point[axis];
    }
    table_put(table, head_of_cell(table, cell), surface->vertices);
    return surface->vertices++;
}

double surface_distance(const double a[3], const double b[3]) {
    return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

static double mean_edge(const struct stl *stl, double scale) {
    double sum = 0;
    for (uint32_t t = 0; t < stl->n; ++t)
        for (int k = 0; k < 3; ++k) sum += surface_distance(stl->corner[t][k], stl->corner[t][(k + 1) % 3]) * scale / 3;
    return sum / stl->n;
}

static int weld_corners(struct surface *surface, const struct stl *stl, double scale) {
    struct table table;
    const double near = surface->mean_edge > 0 ? NEAR * surface->mean_edge : 1;
    const int status = table_open(&table, 3 * (uint64_t)stl->n);
    for (uint32_t t = 0; t < stl->n && !status; ++t)
        for (int k = 0; k < 3; ++k) {
            const double *c = stl->corner[t][k];
            surface->corner[t][k] =
                weld_point(surface, &table, (const double[]){c[0] * scale, c[1] * scale, c[2] * scale}, near);
        }
    table_close(&table);
    return status;
}

/* The corners in ascending order. */
static void sorted_corners(const uint32_t corner[3], uint64_t key[3]) {
    const uint64_t a = corner[0], b = corner[1], c = corner[2];
    key[0] = a < b ? (a < c ? a : c) : b < c ? b : c;
    key[2] = a > b ? (a > c ? a : c) : b > c ? b : c;
    key[1] = a + b + c - key[0] - key[2];
}

/* Whether a triangle with these corners, of any winding, has been kept. If not, lists it as triangle n. */
static bool is_kept(const struct surface *surface, struct table *table, const uint32_t corner[3]) {
    uint64_t key[3], other[3];
    sorted_corners(corner, key);
    uint32_t *head = table_head(table, key);
    for (uint32_t t = *head; t != NONE; t = table->next[t]) {
        sorted_corners(surface->corner[t], other);
        if (memcmp(key, other, sizeof key) == 0) return true;
    }
    table_put(table, head, surface->n);
    return false;
}

static int keep_triangles(struct surface *surface, const struct stl *stl) {
    struct table table;
    const int status = table_open(&table, stl->n);
    for (uint32_t t = 0; t < stl->n && !status; ++t) {
        const uint32_t corner[3] = {surface->corner[t][0], surface->corner[t][1], surface->corner[t][2]};
        const bool flat = corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0];
        const bool twice = !flat && is_kept(surface, &table, corner);
        surface->flat += flat;
        surface->twice += twice;
        if (flat || twice) continue;
        memcpy(surface->corner[surface->n], corner, sizeof corner);
        surface->place[surface->n] = stl->place[t];
        surface->number[surface->n] = t;
        surface->solid[surface->n++] = stl->solid[t];
    }
    table_close(&table);
    return status;
}

const double *surface_corner(const struct surface *surface, uint32_t triangle, int k) {
    return surface->vertex[surface->corner[triangle][k]];
}

void surface_normal(const struct surface *surface, uint32_t triangle, double normal[3]) {
    const double *a = surface_corner(surface, triangle, 0), *b = surface_corner(surface, triangle, 1),
                 *c = surface_corner(surface, triangle, 2);
    for (int k = 0; k < 3; ++k) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        normal[k] = (b[i] - a[i]) * (c[j] - a[j]) - (b[j] - a[j]) * (c[i] - a[i]);
    }
}

double surface_area(const struct surface *surface, uint32_t triangle) {
    double normal[3];
    surface_normal(surface, triangle, normal);
    return hypot(hypot(normal[0], normal[1]), normal[2]) / 2;
}

/* Whether a triangle of three different corners has no area. */
static bool is_flat(const struct surface *surface, uint32_t triangle) {
    double longest = 0;
    for (int k = 0; k < 3; ++k)
        longest = fmax(longest, surface_distance(surface_corner(surface, triangle, k),
                                                 surface_corner(surface, triangle, (k + 1) % 3)));
    return 2 * surface_area(surface, triangle) <= FLAT * longest * longest;
}

int surface_weld(struct surface *surface, const struct stl *stl, double scale) {
    *surface = (struct surface){.mean_edge = mean_edge(stl, scale), .given = stl->n};
    surface->vertex = malloc(3 * (size_t)stl->n * sizeof *surface->vertex);
    surface->corner = malloc((size_t)stl->n * sizeof *surface->corner);
    surface->place = malloc((size_t)stl->n * sizeof *surface->place);
    surface->solid = malloc((size_t)stl->n * sizeof *surface->solid);
    surface->number = malloc((size_t)stl->n * sizeof *surface->number);
    if (!surface->vertex || !surface->corner || !surface->place || !surface->solid || !surface->number)
        return message_memory();
    int status = weld_corners(surface, stl, scale);
    if (!status) status = keep_triangles(surface, stl);
    for (uint32_t t = 0; t < surface->n && !status; ++t) surface->flat += is_flat(surface, t);
    return status;
}

void surface_free(struct surface *surface) {
    free(surface->vertex);
    free(surface->corner);
    free(surface->place);
    free(surface->solid);
    free(surface->number);
    free(surface->component);
    free(surface->in_components);
    free(surface->component_of);
    free(surface->turned);
    *surface = (struct surface){0};
}
