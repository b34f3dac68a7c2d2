/* enclosing.c - closed parts of meshes, of which one side is a body. SPDX-License-Identifier: MIT */
#include "mesh/facing.h"
#include "mesh/meshes.h"

static int inner_of(const struct meshes *meshes, const struct mesh *mesh, const struct part *part) {
    const struct surface *surface = &mesh->surface;
    int inner = 0;
    if (!part->closed || part->twisted) return 0;
    for (uint32_t k = part->first; k < part->first + part->n; ++k) {
        const uint32_t t = surface->in_parts[k], number = mesh->first + t;
        const bool front = meshes->front[number] != FIBRAD_NO_BODY, back = meshes->back[number] != FIBRAD_NO_BODY;
        const int own = front == back ? 0 : front != surface->turned[t] ? 1 : -1;
        if (own == 0 || (k > part->first && own != inner)) return 0;
        inner = own;
    }
    return inner;
}

uint32_t meshes_enclosing(struct meshes *meshes) {
    uint32_t count = 0;
    for (uint32_t m = 0; m < meshes->count; ++m) {
        const struct surface *surface = &meshes->mesh[m].surface;
        for (uint32_t p = 0; p < surface->parts; ++p) {
            struct part *part = &surface->part[p];
            part->inner = inner_of(meshes, &meshes->mesh[m], part);
            count += part->inner * facing_volume(surface, part) < 0;
        }
    }
    return count;
}

int meshes_side(const struct meshes *meshes, uint32_t triangle, bool back) {
    const struct mesh *mesh = mesh_of_triangle(meshes, triangle);
    if (mesh->surface.part[mesh->surface.part_of[triangle - mesh->first]].inner == 0) return 0;
    return (back ? meshes->back : meshes->front)[triangle] != FIBRAD_NO_BODY ? 1 : -1;
}

const char *meshes_beyond(const struct meshes *meshes, const double centre[3], double r, const double period[3]) {
    for (uint32_t m = 0; m < meshes->count; ++m) {
        const struct mesh *mesh = &meshes->mesh[m];
        const struct surface *surface = &mesh->surface;
        for (uint32_t p = 0; p < surface->parts; ++p) {
            const struct part *part = &surface->part[p];
            int side;
            if (part->inner != 0 && facing_distance(surface, part, centre, period, &side) >= r && side == -part->inner)
                return meshes->name[mesh_body(mesh, surface->in_parts[part->first])];
        }
    }
    return NULL;
}
