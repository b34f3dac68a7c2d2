/* sides.c - which sides of triangles are walls, and closed components with a wall on one side only.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>

#include "cli/message.h"
#include "mesh/meshes.h"

static int inner_of(const struct meshes *meshes, const struct mesh *mesh, const struct component *component) {
    const struct surface *surface = &mesh->surface;
    int inner = 0;
    if (!component->closed || component->twisted) return 0;
    for (uint32_t k = component->first; k < component->first + component->n; ++k) {
        const uint32_t t = surface->in_components[k], number = mesh->first + t;
        const bool front = meshes->front[number] != FIBRAD_NO_WALL, back = meshes->back[number] != FIBRAD_NO_WALL;
        const int own = front == back ? 0 : front != surface->turned[t] ? 1 : -1;
        if (own == 0 || (k > component->first && own != inner)) return 0;
        inner = own;
    }
    return inner;
}

/* Counts closed components whose inner side alone is a wall. Sets `inner` of all components. */
static uint32_t count_enclosing(struct meshes *meshes) {
    uint32_t count = 0;
    for (uint32_t m = 0; m < meshes->count; ++m) {
        const struct surface *surface = &meshes->mesh[m].surface;
        for (uint32_t p = 0; p < surface->components; ++p) {
            struct component *component = &surface->component[p];
            component->inner = inner_of(meshes, &meshes->mesh[m], component);
            count += component->inner * facing_volume(surface, component) < 0;
        }
    }
    return count;
}

/* Gives the front, the back or both sides of a triangle to its wall. */
static void give_sides(struct meshes *meshes, const struct mesh *mesh, uint32_t own, bool front, bool back) {
    const uint32_t wall = mesh_wall(mesh, own);
    meshes->front[mesh->first + own] = front ? wall : FIBRAD_NO_WALL;
    meshes->back[mesh->first + own] = back ? wall : FIBRAD_NO_WALL;
}

static int face_spheres(struct meshes *meshes, const struct mesh *mesh, const fibrad_spheres *spheres,
                        const double period[3]) {
    const struct surface *surface = &mesh->surface;
    double *votes = malloc(surface->components * sizeof *votes);
    const int status = votes ? facing_votes(surface, spheres, period, votes) : message_memory();
    for (uint32_t p = 0; p < surface->components && !status; ++p) {
        const struct component *component = &surface->component[p];
        const bool behind = votes[p] < 0;
        for (uint32_t k = component->first; k < component->first + component->n; ++k) {
            const uint32_t t = surface->in_components[k];
            const bool back = surface->turned[t] != behind;
            give_sides(meshes, mesh, t, !back || component->twisted, back || component->twisted);
        }
    }
    free(votes);
    return status;
}

int meshes_face(struct meshes *meshes, const fibrad_spheres *spheres, const double period[3]) {
    int status = STATUS_OK;
    for (uint32_t m = 0; m < meshes->count && !status; ++m) {
        const struct mesh *mesh = &meshes->mesh[m];
        if (mesh->sides == SIDES_AUTO) status = face_spheres(meshes, mesh, spheres, period);
        for (uint32_t t = 0; t < mesh->surface.n && mesh->sides != SIDES_AUTO; ++t)
            give_sides(meshes, mesh, t, true, mesh->sides == SIDES_BOTH);
    }
    meshes->enclosing = status ? 0 : count_enclosing(meshes);
    return status;
}

int meshes_side(const struct meshes *meshes, uint32_t triangle, bool back) {
    const struct mesh *mesh = mesh_of_triangle(meshes, triangle);
    if (mesh->surface.component[mesh->surface.component_of[triangle - mesh->first]].inner == 0) return 0;
    return (back ? meshes->back : meshes->front)[triangle] != FIBRAD_NO_WALL ? 1 : -1;
}

const char *meshes_beyond(const struct meshes *meshes, const double centre[3], double r, const double period[3]) {
    for (uint32_t m = 0; m < meshes->count; ++m) {
        const struct mesh *mesh = &meshes->mesh[m];
        const struct surface *surface = &mesh->surface;
        for (uint32_t p = 0; p < surface->components; ++p) {
            const struct component *component = &surface->component[p];
            int side;
            if (component->inner != 0 && facing_distance(surface, component, centre, period, &side) >= r &&
                side == -component->inner)
                return meshes->name[mesh_wall(mesh, surface->in_components[component->first])];
        }
    }
    return NULL;
}
