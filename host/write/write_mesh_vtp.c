/* write_mesh_vtp.c - VTK XML polydata for ParaView: the triangles of all meshes. SPDX-License-Identifier: MIT
 *
 * Arrays on triangles: `body`, k of wall -2 - k; `front` and `back`, 1 if this side is a wall; `place`, the line or
 * number in the mesh's file; `area`; arrays of the contents. */
#include "cli/message.h"
#include "write/vtp_array.h"
#include "write/write.h"

static void mesh_corners(FILE *file, const struct fibrad_triangles *all) {
    struct base64 to = base64_begin(file, "Int64", "connectivity", 1, 3 * (uint64_t)all->n);
    for (size_t k = 0; k < 3 * (size_t)all->n; ++k) base64_whole(&to, all->corner[k]);
    base64_end(&to);
    vtp_ascending(file, "offsets", all->n, 3, 3);
}

enum { BODY, FRONT, BACK, PLACE, MESH_COUNTS };

static void mesh_counts(FILE *file, const char *name, const struct meshes *meshes, int which) {
    const struct fibrad_triangles *all = &meshes->triangles;
    struct base64 to = base64_begin(file, "Int64", name, 1, all->n);
    for (uint32_t m = 0; m < meshes->count; ++m)
        for (uint32_t t = 0; t < meshes->mesh[m].surface.n; ++t) {
            const struct mesh *mesh = &meshes->mesh[m];
            const int64_t value[MESH_COUNTS] = {mesh_wall(mesh, t), all->front[mesh->first + t] != FIBRAD_NO_WALL,
                                                all->back[mesh->first + t] != FIBRAD_NO_WALL,
                                                (int64_t)mesh->surface.place[t]};
            base64_bytes(&to, &value[which], sizeof *value);
        }
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

int write_mesh_vtp(FILE *file, const struct contents *what) {
    const struct meshes *meshes = what->walls->meshes;
    const struct fibrad_triangles *all = &meshes->triangles;
    vtp_head(file, all->vertices, "Polys", all->n);
    fputs("<CellData Scalars=\"body\">\n", file);
    mesh_counts(file, "body", meshes, BODY);
    mesh_counts(file, "front", meshes, FRONT);
    mesh_counts(file, "back", meshes, BACK);
    mesh_counts(file, "place", meshes, PLACE);
    mesh_areas(file, meshes);
    for (size_t q = 0; what->of_sides && q < what->of_sides->count; ++q)
        mesh_quantity(file, &what->of_sides->quantity[q], what->of_sides->arrays, all->n);
    fputs("</CellData>\n<Points>\n", file);
    vtp_points(file, all->x, all->y, all->z, all->stride, all->vertices);
    fputs("</Points>\n<Polys>\n", file);
    mesh_corners(file, all);
    fputs("</Polys>\n" VTP_END, file);
    return interrupt_status();
}
