/* write_mesh_vtp.c - VTK XML polydata for ParaView: the triangles of all meshes. SPDX-License-Identifier: MIT
 *
 * Arrays on triangles: `body`, k of wall -2 - k; `front` and `back`, 1 if this side is a wall; `place`, the line or
 * number in the mesh's file; `area`; arrays of the contents. */
#include <math.h>

#include "cli/interrupt.h"
#include "write/vtp_array.h"
#include "write/write.h"

static void mesh_points(FILE *file, const struct fibrad_triangles *all) {
    struct base64 to = base64_begin(file, "Float64", "Points", 3, 3 * (uint64_t)all->vertices);
    for (size_t v = 0; v < all->vertices; ++v) {
        base64_double(&to, all->x[v * all->stride]);
        base64_double(&to, all->y[v * all->stride]);
        base64_double(&to, all->z[v * all->stride]);
    }
    base64_end(&to);
}

static void mesh_corners(FILE *file, const struct fibrad_triangles *all) {
    struct base64 to = base64_begin(file, "Int64", "connectivity", 1, 3 * (uint64_t)all->n);
    for (size_t k = 0; k < 3 * (size_t)all->n; ++k) base64_whole(&to, all->corner[k]);
    base64_end(&to);
    vtp_ascending(file, "offsets", all->n, 3, 3);
}

/* A whole number of a triangle. */
typedef int64_t mesh_count(const struct mesh *mesh, const struct fibrad_triangles *all, uint32_t own);

static int64_t wall_of(const struct mesh *mesh, const struct fibrad_triangles *all, uint32_t own) {
    (void)all;
    return mesh_wall(mesh, own);
}

static int64_t front_of(const struct mesh *mesh, const struct fibrad_triangles *all, uint32_t own) {
    return all->front[mesh->first + own] != FIBRAD_NO_WALL;
}

static int64_t back_of(const struct mesh *mesh, const struct fibrad_triangles *all, uint32_t own) {
    return all->back[mesh->first + own] != FIBRAD_NO_WALL;
}

static int64_t place_of(const struct mesh *mesh, const struct fibrad_triangles *all, uint32_t own) {
    (void)all;
    return (int64_t)mesh->surface.place[own];
}

static void mesh_counts(FILE *file, const char *name, const struct meshes *meshes, mesh_count *count) {
    struct base64 to = base64_begin(file, "Int64", name, 1, meshes->triangles.n);
    for (uint32_t m = 0; m < meshes->count; ++m)
        for (uint32_t t = 0; t < meshes->mesh[m].surface.n; ++t)
            base64_whole(&to, count(&meshes->mesh[m], &meshes->triangles, t));
    base64_end(&to);
}

static void mesh_areas(FILE *file, const struct meshes *meshes) {
    struct base64 to = base64_begin(file, "Float64", "area", 1, meshes->triangles.n);
    for (uint32_t m = 0; m < meshes->count; ++m)
        for (uint32_t t = 0; t < meshes->mesh[m].surface.n; ++t)
            base64_double(&to, surface_area(&meshes->mesh[m].surface, t));
    base64_end(&to);
}

static void mesh_quantity(FILE *file, const struct side_quantity *quantity, size_t arrays, uint32_t n) {
    for (size_t k = 0; k < arrays; ++k) {
        struct base64 to = base64_begin(file, "Float64", quantity->name[k], 1, n);
        base64_bytes(&to, quantity->shown[k], n * sizeof(double));
        base64_end(&to);
    }
}

int write_mesh_vtp(FILE *file, const struct contents *what, bool first) {
    const struct meshes *meshes = what->walls->meshes;
    const struct fibrad_triangles *all = &meshes->triangles;
    (void)first;
    vtp_head(file, all->vertices, "Polys", all->n);
    fputs("<CellData Scalars=\"body\">\n", file);
    mesh_counts(file, "body", meshes, wall_of);
    mesh_counts(file, "front", meshes, front_of);
    mesh_counts(file, "back", meshes, back_of);
    mesh_counts(file, "place", meshes, place_of);
    mesh_areas(file, meshes);
    for (size_t q = 0; what->of_sides && q < what->of_sides->count; ++q)
        mesh_quantity(file, &what->of_sides->quantity[q], what->of_sides->arrays, all->n);
    fputs("</CellData>\n<Points>\n", file);
    mesh_points(file, all);
    fputs("</Points>\n<Polys>\n", file);
    mesh_corners(file, all);
    fputs("</Polys>\n" VTP_END, file);
    return interrupt_status();
}
