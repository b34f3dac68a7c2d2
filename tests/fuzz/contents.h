/* contents.h - what a scene of a fuzzer is made of. SPDX-License-Identifier: MIT */
#ifndef TESTS_FUZZ_CONTENTS_H
#define TESTS_FUZZ_CONTENTS_H

#include "fibrad_mesh.h"
#include "choices.h"

enum { SPHERES = 24, PLANES = 7, MESHES = 3, WALLS = PLANES + MESHES, VERTICES = 16, TRIANGLES = 12 };

static bool plain; /* all lengths lie within what a bed can be */
static bool tame;  /* they are far from that, but a row takes far less than a second: no 1e9 radii across a box */

static double shortest; /* period */

static inline double length(void) {
    double c = coordinate();
    tame = tame && fabs(c) < 1e6 && (c == 0 || fabs(c) > 1e-6);
    plain = plain && fabs(c) < 100 && (c == 0 || fabs(c) > 0.1);
    return c;
}

static inline double radius(void) {
    double c = length();
    return c <= 0 && c >= -30 && byte() < 250 ? .25 - c / 8 : c;
}

/* What a scene is made of. */
struct contents {
    uint32_t n;
    double x[SPHERES], y[SPHERES], z[SPHERES], r[SPHERES];
    uint64_t id[SPHERES];
    bool ids;
    fibrad_wall wall[WALLS + 1];
    fibrad_plane opening[PLANES];
    bool occupied;
    fibrad_occupancy occupancy;
    uint64_t mark[8];
    fibrad_scene_config config;
    double vertex[3][VERTICES];
    uint32_t corner[3 * TRIANGLES], front[TRIANGLES], back[TRIANGLES];
    fibrad_triangles triangles;
};

/* An occupancy, or none. */
static inline void any_surroundings(struct contents *c) {
    const uint8_t which = byte();
    c->occupied = which % 4 != 0;
    c->occupancy = (fibrad_occupancy){.cells = {1 + byte() % 8, 1 + byte() % 8, 1 + byte() % 8}};
    for (int axis = 0; axis < 3; axis++) {
        c->occupancy.low[axis] = coordinate();
        c->occupancy.high[axis] = c->occupancy.low[axis] + (byte() < 250 ? 1 + byte() / 4. : coordinate());
        c->occupancy.periodic[axis] = byte() % 2;
    }
    for (int k = 0; k < 8; k++) c->mark[k] = (uint64_t)byte() << 56 | (uint64_t)byte() << 20 | byte();
    if (which == 3) c->occupancy.cells[byte() % 3] = number();
    if (which == 5) c->occupancy.periodic[byte() % 3] = byte();
}

/* Triangles between a few vertices, many of which coincide, and the meshes that have their sides. */
static inline void any_triangles(struct contents *c) {
    fibrad_triangles *t = &c->triangles;
    const uint32_t first = c->config.walls, meshes = 1 + byte() % MESHES;
    t->n = 1 + byte() % TRIANGLES, t->vertices = 3 + byte() % (VERTICES - 3);
    for (uint32_t b = 0; b < meshes; b++) c->wall[c->config.walls++] = (fibrad_wall){.kind = FIBRAD_WALL_MESH};
    for (uint32_t v = 0; v < t->vertices; v++)
        for (int axis = 0; axis < 3; axis++) c->vertex[axis][v] = length();
    for (uint32_t k = 0; k < 3 * t->n; k++) c->corner[k] = byte() % t->vertices;
    for (uint32_t k = 0; k < t->n; k++) {
        c->front[k] = first + byte() % meshes;
        c->back[k] = byte() < 20 ? FIBRAD_NO_WALL : first + byte() % meshes;
    }
    const uint8_t odd = byte();
    if (odd == 1) c->corner[byte() % TRIANGLES] = number();
    if (odd == 2) c->front[byte() % TRIANGLES] = number();
    for (uint32_t axis = 0; odd > 200 && axis < 3; axis++) t->period[axis] = byte() < 128 ? 0 : fabs(length());
}

/* Makes openings of some planes, and puts the planes of each axis on their own sides. */
static inline void any_openings(struct contents *c) {
    uint32_t kept = 0;
    const uint8_t open = byte();
    for (uint32_t b = 0; b < c->config.walls; b++) {
        fibrad_wall wall = c->wall[b];
        wall.plane.at = fabs(wall.plane.at) * (wall.plane.upper ? 1 : -1);
        if (wall.kind == FIBRAD_WALL_PLANE && (open >> b & 1) != 0)
            c->opening[c->config.openings++] = wall.plane;
        else
            c->wall[kept++] = wall;
    }
    c->config.walls = kept;
}

/* How far the centre of sphere i lies within a plane; infinity: the plane is none. */
static inline double depth_within(const struct contents *c, uint32_t i, const fibrad_plane *plane) {
    const double place[3] = {c->x[i], c->y[i], c->z[i]};
    if (plane->axis < 0 || plane->axis > 2) return INFINITY;
    return (place[plane->axis] - plane->at) * (plane->upper ? -1 : 1);
}

/* Whether sphere i may be where it is, beside those before it and within the walls. */
static inline bool fits(const struct contents *c, uint32_t i) {
    bool may = true;
    for (uint32_t j = 0; j < i; j++) {
        const double x = c->x[i] - c->x[j], y = c->y[i] - c->y[j], z = c->z[i] - c->z[j];
        may = may && sqrt(x * x + y * y + z * z) > fmax(c->r[i], c->r[j]);
    }
    for (uint32_t b = 0; b < c->config.walls; b++)
        may = may && (c->wall[b].kind != FIBRAD_WALL_PLANE || depth_within(c, i, &c->wall[b].plane) > 0);
    for (uint32_t k = 0; k < c->config.openings; k++) may = may && depth_within(c, i, &c->opening[k]) > c->r[i];
    return may;
}

/* Leaves out spheres that could not be where they are, so that most scenes can be made. */
static inline void leave_out(struct contents *c) {
    uint32_t n = 0;
    for (uint32_t i = 0; i < c->n; i++) {
        c->x[n] = c->x[i], c->y[n] = c->y[i], c->z[n] = c->z[i], c->r[n] = c->r[i], c->id[n] = c->id[i];
        n += fits(c, n);
    }
    c->n = n;
}

static inline struct contents any_contents(bool walled, bool meshed) {
    struct contents c = {.n = number() % SPHERES};
    c.ids = byte() % 4 == 1, c.config.isa = byte() % 6;
    plain = tame = true;
    shortest = INFINITY;
    for (int axis = 0; axis < 3; axis++) {
        c.config.period[axis] = byte() < 160 ? 0 : fabs(length());
        if (c.config.period[axis] > 0) shortest = fmin(shortest, c.config.period[axis]);
    }
    const uint8_t part = byte();
    if (part == 1 || part > 240) any_surroundings(&c);
    for (uint32_t planes = walled ? byte() : 0, k = 0; k < 6; k++)
        if (planes >> k & 1)
            c.wall[c.config.walls++] =
                (fibrad_wall){.kind = FIBRAD_WALL_PLANE, .plane = {(int)k / 2, k % 2, 8 * length()}};
    if (walled && byte() % 4 == 0)
        c.wall[c.config.walls++] =
            (fibrad_wall){.kind = FIBRAD_WALL_CYLINDER, .cylinder = {length(), length(), 4 * fabs(length()), 2}};
    if (walled && byte() == 1) c.wall[byte() % PLANES].kind = byte();
    if (walled && byte() == 1) c.wall[byte() % PLANES].plane.axis = (int)number();
    if (walled && byte() == 1) c.config.walls = number() % (PLANES + 2);
    if (meshed && c.config.walls <= PLANES) any_openings(&c);
    for (uint32_t i = 0; i < c.n; i++) {
        c.x[i] = length(), c.y[i] = length(), c.z[i] = length(), c.r[i] = radius();
        c.id[i] = c.ids ? number() : i;
    }
    if (meshed && c.config.walls <= PLANES) any_triangles(&c);
    if (meshed && byte() < 250) leave_out(&c);
    return c;
}

/* Sets the pointers of the configuration, which point into the contents themselves. */
static inline void contents_complete(struct contents *c) {
    c->config.wall = c->wall;
    c->config.opening = c->opening;
    fibrad_triangles *t = &c->triangles;
    t->x = c->vertex[0], t->y = c->vertex[1], t->z = c->vertex[2];
    t->corner = c->corner, t->front = c->front, t->back = c->back;
    c->config.triangles = t->n > 0 ? t : NULL;
    c->config.occupancy = c->occupied ? &c->occupancy : NULL;
    const bool small = c->occupancy.cells[0] <= 8 && c->occupancy.cells[1] <= 8 && c->occupancy.cells[2] <= 8;
    c->occupancy.mark = small ? c->mark : NULL;
}

/* Whether triangles reach over many periods. A ray then looks at many images of each. The rays of walls would take
 * minutes. */
static inline bool has_many_images(const struct contents *c) {
    double images = 1;
    for (int axis = 0; axis < 3 && c->triangles.n > 0; axis++) {
        double low = INFINITY, high = -INFINITY;
        for (uint32_t k = 0; k < VERTICES && k < c->triangles.vertices; k++)
            low = fmin(low, c->vertex[axis][k]), high = fmax(high, c->vertex[axis][k]);
        const double period = fmax(c->triangles.period[axis], c->config.period[axis]);
        if (period > 0) images *= 1 + (high - low) / period;
    }
    return !(images < 30);
}

static inline size_t size_of(const struct contents *c) {
    const size_t size = fibrad_scene_size(c->n, c->ids), triangles = fibrad_triangles_size(c->triangles.n, c->n);
    REQUIRE(size > 0 && (c->ids || size <= FIBRAD_SCENE_BYTES(c->n)));
    return size + (c->triangles.n > 0 ? triangles : 0);
}

static inline int build(fibrad_scene **scene, void *memory, size_t size, struct contents *c) {
    fibrad_spheres spheres = {.x = c->x, .y = c->y, .z = c->z, .r = c->r, .n = c->n, .id = c->ids ? c->id : NULL};
    fibrad_fault fault = {0};
    *scene = NULL;
    contents_complete(c);
    const int status = CALL(fibrad_scene_init(scene, memory, size, &c->config, &spheres, &fault));
    REQUIRE((status == FIBRAD_OK) == (*scene != NULL) && fault.first <= c->n && fault.second <= c->n);
    REQUIRE(fault.triangle == UINT32_MAX || fault.triangle < c->triangles.n || status == FIBRAD_OK);
    return status;
}

/* A row that has been computed: points of each window, or rays, or 0 for exact areas. */
static inline void check_row(const fibrad_row *row, const fibrad_scene *scene, uint32_t i, uint32_t points) {
    fibrad_scene_facts facts;
    fibrad_scene_describe(scene, &facts);
    double sum = row->escaped + row->beyond;
    REQUIRE(row->sphere == i && (row->rows != NULL || row->length <= row->capacity));
    for (uint32_t k = 0; k < row->length; k++) {
        REQUIRE(row->col[k] < facts.spheres && (k == 0 || row->col[k] > row->col[k - 1]));
        REQUIRE(row->f[k] > 0 && row->f[k] <= 1 + 1e-9);
        sum += row->f[k];
    }
    for (uint32_t b = 0; b < facts.walls; b++) {
        REQUIRE(row->wall[b] >= 0 && (row->wall[b] == 0 || fibrad_scene_wall_area(scene, b) > 0));
        sum += row->wall[b];
    }
    REQUIRE(row->escaped >= -1e-9 && row->beyond >= -1e-9 && row->error >= 0 && isfinite(row->error));
    REQUIRE(row->symmetric == 0 || row->symmetric == 1);
    if (plain || points > 0) REQUIRE(fabs(sum - 1) < 1e-9);
}

#endif
