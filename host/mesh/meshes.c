/* meshes.c - walls of triangles from files, in the form of the library. SPDX-License-Identifier: MIT */
#include "mesh/meshes.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"

bool mesh_name(const char *name) {
    size_t length = 0;
    while (isalnum((unsigned char)name[length]) || name[length] == '_') ++length;
    return length > 0 && length < MESH_NAME && name[length] == 0;
}

/* Makes a valid name of a path: without folders and endings, with _ for all but letters and digits. */
static void stem_of(const char *path, char name[MESH_NAME]) {
    const char *slash = strrchr(path, '/'), *begin = slash ? slash + 1 : path;
    size_t length = strcspn(begin, ".");
    if (length == 0) begin = "none", length = strlen(begin);
    if (length >= MESH_NAME) length = MESH_NAME - 1;
    for (size_t k = 0; k < length; ++k) name[k] = isalnum((unsigned char)begin[k]) ? begin[k] : '_';
    name[length] = 0;
}

/* Whether one of the walls from `first` to `last` - 1 has this name. */
static bool is_taken(const struct meshes *meshes, uint32_t first, uint32_t last, const char *name) {
    for (uint32_t k = first; k < last; ++k)
        if (strcmp(meshes->name[k], name) == 0) return true;
    return false;
}

/* Names the walls of a file: NAME, or with :solids NAME_SOLID for each. A solid without a name of its own becomes
 * NAME_1, NAME_2 ... by its number. */
static void name_walls(struct meshes *meshes, const struct mesh_file *file, const struct stl *stl, uint32_t wall) {
    char name[MESH_NAME], solid[SOLID_NAME];
    if (file->name)
        snprintf(name, sizeof name, "%s", file->name);
    else
        stem_of(file->path, name);
    for (uint32_t k = 0; k < (file->solids ? stl->solids : 1); ++k) {
        char *to = meshes->name[wall + k];
        stem_of(stl->name[k], solid);
        if (!file->solids)
            memcpy(to, name, sizeof name);
        else
            snprintf(to, MESH_NAME, "%.15s_%.15s", name, solid);
        if (file->solids && (!stl->name[k][0] || is_taken(meshes, wall, wall + k, to)))
            snprintf(to, MESH_NAME, "%.15s_%u", name, k + 1);
    }
}

static void warn_of_surface(const char *file, const struct surface *s) {
    if (s->flat || s->twice || s->snapped)
        message_at(STATUS_OK, file, 0,
                   "warning: the mesh was mended: %u triangles without area, %u triangles that occur twice, %u corners "
                   "closer than 1e-6 of an edge to others",
                   s->flat, s->twice, s->snapped);
    if (s->open || s->crowded)
        message_at(STATUS_OK, file, 0,
                   "warning: the mesh is %s: %u edges belong to one triangle, %u to more than two; components: %u",
                   s->open ? "not closed" : "closed", s->open, s->crowded, s->components);
}

/* Puts the triangles of the last mesh behind those of the others. */
static int append(struct meshes *meshes) {
    struct fibrad_triangles *all = &meshes->triangles;
    const struct mesh *mesh = &meshes->mesh[meshes->count - 1];
    const struct surface *s = &mesh->surface;
    const size_t n = (size_t)all->n + s->n, vertices = (size_t)all->vertices + s->vertices;
    if (n > FIBRAD_TRIANGLES_MAX) return message(STATUS_USAGE, "--wall: more than %u triangles", FIBRAD_TRIANGLES_MAX);
    bool good = true;
    double *vertex = meshes->vertex = memory_resized(meshes->vertex, 3 * vertices * sizeof *vertex, &good);
    uint32_t *corner = meshes->corner = memory_resized(meshes->corner, 3 * n * sizeof *corner, &good);
    meshes->front = memory_resized(meshes->front, n * sizeof *corner, &good);
    meshes->back = memory_resized(meshes->back, n * sizeof *corner, &good);
    if (!good) return message_memory();
    memcpy(vertex + 3 * (size_t)all->vertices, s->vertex, s->vertices * sizeof *s->vertex);
    for (uint32_t t = 0; t < s->n; ++t)
        for (int k = 0; k < 3; ++k) corner[3 * ((size_t)all->n + t) + (size_t)k] = all->vertices + s->corner[t][k];
    *all = (struct fibrad_triangles){.x = vertex, .y = vertex + 1, .z = vertex + 2, .stride = 3, .corner = corner};
    all->vertices = (uint32_t)vertices, all->n = (uint32_t)n, all->front = meshes->front, all->back = meshes->back;
    return STATUS_OK;
}

int meshes_take(struct meshes *meshes, const struct mesh_file *file, const struct stl *stl, uint32_t wall) {
    bool good = true;
    meshes->mesh = memory_grown(meshes->mesh, meshes->count, sizeof *meshes->mesh, &good);
    if (!good) return message_memory();
    struct mesh *mesh = &meshes->mesh[meshes->count++];
    *mesh = (struct mesh){.file = strdup(file->path), .text = stl->text, .sides = file->sides, .wall = wall};
    mesh->walls = file->solids ? stl->solids : 1, mesh->first = meshes->triangles.n;
    if (!mesh->file) return message_memory();
    if (mesh->walls > FIBRAD_WALLS_MAX - wall)
        return message_at(STATUS_USAGE, file->path, 0, "more than %d walls; without :solids the file is one wall",
                          FIBRAD_WALLS_MAX);
    int status = surface_weld(&mesh->surface, stl, file->scale);
    if (!status && mesh->surface.flat + mesh->surface.twice == stl->n)
        status = message_at(STATUS_INPUT, file->path, 0, "no triangle has an area");
    if (!status) status = surface_find_components(&mesh->surface);
    if (!status) {
        warn_of_surface(file->path, &mesh->surface);
        name_walls(meshes, file, stl, wall);
        status = append(meshes);
    }
    return status;
}

int meshes_add(struct meshes *meshes, const struct mesh_file *file, uint32_t wall) {
    struct stl stl;
    int status = stl_read(&stl, file->path);
    if (!status) status = meshes_take(meshes, file, &stl, wall);
    stl_free(&stl);
    return status;
}

uint32_t mesh_wall(const struct mesh *mesh, uint32_t own) {
    return mesh->wall + (mesh->walls > 1 ? mesh->surface.solid[own] : 0);
}

uint32_t mesh_triangles(const struct mesh *mesh, uint32_t wall) {
    uint32_t count = 0;
    for (uint32_t t = 0; t < mesh->surface.n; ++t) count += mesh_wall(mesh, t) == wall;
    return count;
}

void mesh_extents(const struct meshes *meshes, uint32_t wall, double low[3], double high[3]) {
    const struct mesh *mesh = mesh_of_wall(meshes, wall);
    for (int axis = 0; axis < 3; ++axis) low[axis] = INFINITY, high[axis] = -INFINITY;
    for (uint32_t t = 0; t < mesh->surface.n; ++t)
        for (int k = 0; k < 3 && mesh_wall(mesh, t) == wall; ++k)
            for (int axis = 0; axis < 3; ++axis) {
                const double at = surface_corner(&mesh->surface, t, k)[axis];
                low[axis] = fmin(low[axis], at), high[axis] = fmax(high[axis], at);
            }
}

const struct mesh *mesh_of_triangle(const struct meshes *meshes, uint32_t triangle) {
    for (uint32_t m = 0; m < meshes->count; ++m) {
        const struct mesh *mesh = &meshes->mesh[m];
        if (triangle >= mesh->first && triangle - mesh->first < mesh->surface.n) return mesh;
    }
    return NULL;
}

const struct mesh *mesh_of_wall(const struct meshes *meshes, uint32_t wall) {
    for (uint32_t m = 0; m < meshes->count; ++m)
        if (wall >= meshes->mesh[m].wall && wall - meshes->mesh[m].wall < meshes->mesh[m].walls)
            return &meshes->mesh[m];
    return NULL;
}

int meshes_refuse(const struct meshes *meshes, int status, uint32_t triangle, bool planes) {
    const struct mesh *mesh = mesh_of_triangle(meshes, triangle);
    char where[STL_PLACE];
    if (!mesh) return message(STATUS_INPUT, "triangle %u: %s", triangle, fibrad_status_text(status));
    const uint64_t place = mesh->surface.place[triangle - mesh->first];
    const char *name = meshes->name[mesh_wall(mesh, triangle - mesh->first)];
    stl_place(mesh->text, place, where);
    if (status != FIBRAD_E_BACK)
        return message_at(STATUS_INPUT, mesh->file, 0, "%s, wall %s: %s", where, name, fibrad_status_text(status));
    return message_at(STATUS_INPUT, mesh->file, mesh->text ? place : 0,
                      "the back of wall %s is seen, at %s; mesh:%s:both makes both sides the wall%s", name, where,
                      mesh->file,
                      planes ? "; rays of a plane start outside of a tube, too: its floor and lid must be meshes" : "");
}

void meshes_free(struct meshes *meshes) {
    for (uint32_t m = 0; m < meshes->count; ++m) {
        free(meshes->mesh[m].file);
        surface_free(&meshes->mesh[m].surface);
    }
    free(meshes->mesh);
    free(meshes->vertex);
    free(meshes->corner);
    free(meshes->front);
    free(meshes->back);
    *meshes = (struct meshes){0};
}
