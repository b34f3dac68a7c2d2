/* meshes.h - triangles for tests. SPDX-License-Identifier: MIT */
#ifndef TESTS_MESHES_H
#define TESTS_MESHES_H

#include <math.h>
#include <stdlib.h>

#include "fibrad_mesh.h"

enum { MESH_VERTICES = 40000, MESH_TRIANGLES = 20000 };

/* Triangles that are added one by one. All `walls` are meshes. */
struct mesh {
    double at[MESH_VERTICES][3];
    uint32_t corner[MESH_TRIANGLES][3], front[MESH_TRIANGLES], back[MESH_TRIANGLES];
    struct fibrad_triangles triangles;
    fibrad_wall wall[FIBRAD_WALLS_MAX];
};

static inline struct mesh *mesh_new(void) {
    struct mesh *mesh = calloc(1, sizeof *mesh);
    ck_assert_ptr_nonnull(mesh);
    mesh->triangles = (struct fibrad_triangles){.x = &mesh->at[0][0], .y = &mesh->at[0][1], .z = &mesh->at[0][2]};
    mesh->triangles.stride = 3, mesh->triangles.corner = &mesh->corner[0][0], mesh->triangles.front = mesh->front;
    mesh->triangles.back = mesh->back;
    for (int b = 0; b < FIBRAD_WALLS_MAX; b++) mesh->wall[b].kind = FIBRAD_WALL_MESH;
    return mesh;
}

static inline uint32_t mesh_vertex(struct mesh *mesh, double x, double y, double z) {
    const uint32_t v = mesh->triangles.vertices++;
    ck_assert_uint_lt(v, MESH_VERTICES);
    mesh->at[v][0] = x, mesh->at[v][1] = y, mesh->at[v][2] = z;
    return v;
}

static inline void mesh_triangle(struct mesh *mesh, uint32_t a, uint32_t b, uint32_t c, uint32_t front, uint32_t back) {
    const uint32_t t = mesh->triangles.n++;
    ck_assert_uint_lt(t, MESH_TRIANGLES);
    mesh->corner[t][0] = a, mesh->corner[t][1] = b, mesh->corner[t][2] = c;
    mesh->front[t] = front, mesh->back[t] = back;
}

/* Adds a rectangle of four corners, counter-clockwise as seen from the front. */
static inline void mesh_quad(struct mesh *mesh, const uint32_t v[4], uint32_t front, uint32_t back) {
    mesh_triangle(mesh, v[0], v[1], v[2], front, back);
    mesh_triangle(mesh, v[0], v[2], v[3], front, back);
}

/* Adds a box whose fronts are inside. Side 2 axis + upper is wall `first` + 2 axis + upper. */
static inline void mesh_box(struct mesh *mesh, const double low[3], const double high[3], uint32_t first) {
    uint32_t v[8];
    for (uint32_t k = 0; k < 8; k++)
        v[k] = mesh_vertex(mesh, (k & 1 ? high : low)[0], (k & 2 ? high : low)[1], (k & 4 ? high : low)[2]);
    for (uint32_t axis = 0; axis < 3; axis++)
        for (uint32_t upper = 0; upper < 2; upper++) {
            const uint32_t o = upper << axis, p = 1u << (axis + 1) % 3, q = 1u << (axis + 2) % 3;
            const uint32_t up[4] = {v[o], v[o | p], v[o | p | q], v[o | q]}, down[4] = {up[0], up[3], up[2], up[1]};
            mesh_quad(mesh, upper ? down : up, first + 2 * axis + upper, FIBRAD_NO_WALL);
        }
}

/* Adds a tube of `facets` facets about the line (x, y), from z = low to high. outside: the fronts are outside. */
static inline void mesh_tube(struct mesh *mesh, double x, double y, double radius, double low, double high,
                             uint32_t facets, uint32_t rings, bool outside, uint32_t front, uint32_t back) {
    const uint32_t first = mesh->triangles.vertices;
    for (uint32_t ring = 0; ring <= rings; ring++)
        for (uint32_t k = 0; k < facets; k++) {
            const double angle = 2 * 3.14159265358979323846 * k / facets;
            mesh_vertex(mesh, x + radius * cos(angle), y + radius * sin(angle), low + (high - low) * ring / rings);
        }
    for (uint32_t ring = 0; ring < rings; ring++)
        for (uint32_t k = 0; k < facets; k++) {
            const uint32_t a = first + ring * facets + k, b = first + ring * facets + (k + 1) % facets;
            const uint32_t out[4] = {a, b, b + facets, a + facets}, in[4] = {a, a + facets, b + facets, b};
            mesh_quad(mesh, outside ? out : in, front, back);
        }
}

/* Turns all vertices by the rotation of a seed about the origin. */
static inline void turn_point(const double m[9], double at[3]) {
    const double p[3] = {at[0], at[1], at[2]};
    for (int axis = 0; axis < 3; axis++)
        at[axis] = m[3 * axis] * p[0] + m[3 * axis + 1] * p[1] + m[3 * axis + 2] * p[2];
}

static inline void mesh_turn(struct mesh *mesh, const double m[9]) {
    for (uint32_t v = 0; v < mesh->triangles.vertices; v++) turn_point(m, mesh->at[v]);
}

#endif
