/* bench_triangles.h - boxes and tubes of triangles, and scenes with them. SPDX-License-Identifier: MIT */
#ifndef BENCH_TRIANGLES_H
#define BENCH_TRIANGLES_H

#include "bench_bed.h"
#include "fibrad_mesh.h"

/* Triangles that are added one by one, and the number there is room for. */
struct bench_triangles {
    struct fibrad_triangles list;
    double *at; /* [vertices][3] */
    uint32_t *corner, *front, *back;
};

static inline struct bench_triangles bench_triangles_new(uint32_t most) {
    struct bench_triangles t = {.at = bench_array((size_t)most * 9, sizeof(double)),
                                .corner = bench_array((size_t)most * 3, sizeof(uint32_t)),
                                .front = bench_array(most, sizeof(uint32_t)),
                                .back = bench_array(most, sizeof(uint32_t))};
    t.list = (struct fibrad_triangles){
        .x = t.at, .y = t.at + 1, .z = t.at + 2, .stride = 3, .corner = t.corner, .front = t.front, .back = t.back};
    return t;
}

static inline void bench_triangles_free(struct bench_triangles *t) {
    free(t->at), free(t->corner), free(t->front), free(t->back);
}

static inline uint32_t bench_vertex(struct bench_triangles *t, double x, double y, double z) {
    double *at = t->at + 3 * (size_t)t->list.vertices;
    at[0] = x, at[1] = y, at[2] = z;
    return t->list.vertices++;
}

/* Adds a square. Its corners go counter-clockwise as seen from the front. Nothing may see the back. */
static inline void bench_triangle(struct bench_triangles *t, uint32_t a, uint32_t b, uint32_t c, uint32_t wall) {
    uint32_t *corner = t->corner + 3 * (size_t)t->list.n;
    corner[0] = a, corner[1] = b, corner[2] = c;
    t->front[t->list.n] = wall, t->back[t->list.n] = FIBRAD_NO_WALL;
    t->list.n++;
}

static inline void bench_quad(struct bench_triangles *t, const uint32_t v[4], uint32_t wall) {
    bench_triangle(t, v[0], v[1], v[2], wall);
    bench_triangle(t, v[0], v[2], v[3], wall);
}

/* Adds a box whose fronts are inside. Each face has cells^2 squares of two triangles. The faces are walls 0 to 5, as
 * those of bench_planes. */
static inline void bench_box(struct bench_triangles *t, const double low[3], const double high[3], uint32_t cells) {
    for (uint32_t face = 0; face < 6; ++face) {
        const uint32_t axis = face / 2, upper = face % 2, first = t->list.vertices, row = cells + 1;
        for (uint32_t k = 0; k < row * row; ++k) {
            const uint32_t p = (axis + 1) % 3, q = (axis + 2) % 3, step[2] = {k % row, k / row};
            double at[3];
            at[axis] = upper ? high[axis] : low[axis];
            at[p] = step[0] == cells ? high[p] : low[p] + (high[p] - low[p]) * step[0] / cells;
            at[q] = step[1] == cells ? high[q] : low[q] + (high[q] - low[q]) * step[1] / cells;
            bench_vertex(t, at[0], at[1], at[2]);
        }
        for (uint32_t k = 0; k < cells * cells; ++k) {
            const uint32_t a = first + k / cells * row + k % cells;
            const uint32_t up[4] = {a, a + 1, a + row + 1, a + row}, down[4] = {a, a + row, a + row + 1, a + 1};
            bench_quad(t, upper ? down : up, face);
        }
    }
}

/* Adds a tube about the line (x, y), whose fronts are outside or inside. It has rings of facets of two triangles. */
static inline void bench_tube(struct bench_triangles *t, const double middle[2], double radius, const double ends[2],
                              uint32_t facets, uint32_t rings, bool outside, uint32_t wall) {
    const uint32_t first = t->list.vertices;
    for (uint32_t ring = 0; ring <= rings; ++ring)
        for (uint32_t k = 0; k < facets; ++k) {
            const double angle = 2 * 3.14159265358979323846 * k / facets;
            bench_vertex(t, middle[0] + radius * cos(angle), middle[1] + radius * sin(angle),
                         ends[0] + (ends[1] - ends[0]) * ring / rings);
        }
    for (uint32_t k = 0; k < rings * facets; ++k) {
        const uint32_t a = first + k, b = first + k / facets * facets + (k + 1) % facets;
        const uint32_t out[4] = {a, b, b + facets, a + facets}, in[4] = {a, a + facets, b + facets, b};
        bench_quad(t, outside ? out : in, wall);
    }
}

/* The planes of a box. */
static inline void bench_planes(fibrad_wall wall[6], const double low[3], const double high[3]) {
    for (int k = 0; k < 6; ++k)
        wall[k] = (fibrad_wall){.kind = FIBRAD_WALL_PLANE, .plane = {k / 2, k % 2, (k % 2 ? high : low)[k / 2]}};
}

/* The scene of a bed with walls and triangles (NULL: none) in *block, which the caller frees. */
static inline fibrad_scene *bench_scene_in(const struct bed *bed, const fibrad_wall *wall, uint32_t walls,
                                           const struct bench_triangles *t, void **block) {
    const fibrad_spheres spheres = bench_spheres(bed);
    fibrad_scene_config config = bench_config(bed, FIBRAD_ISA_BEST);
    const size_t size = fibrad_scene_size(bed->n, 0) + (t ? fibrad_triangles_size(t->list.n, bed->n) : 0);
    fibrad_scene *scene = NULL;
    config.wall = wall, config.walls = walls, config.triangles = t ? &t->list : NULL;
    bench_check("scene", (*block = malloc(size)) ? FIBRAD_OK : FIBRAD_E_MEMORY);
    bench_check("scene", fibrad_scene_init(&scene, *block, size, &config, &spheres, NULL));
    return scene;
}

#endif
