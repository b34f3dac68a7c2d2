/* file_arrays.c - beds and meshes of files as arrays, for Python: libfibrad_files.so. SPDX-License-Identifier: MIT */
#include "python/file_arrays.h"

#include <stdlib.h>
#include <string.h>

#include "mesh/meshes.h"
#include "read/read.h"

/* Puts columns of other names, and rules of rows, into the options. Free options->name and options->rule. */
static int take_columns(const struct file_wanted *wanted, struct read_options *options) {
    options->names = wanted->names, options->rules = wanted->onlys + wanted->skips;
    struct column_name *name = malloc((options->names + 1) * sizeof *name);
    struct row_rule *rule = malloc((options->rules + 1) * sizeof *rule);
    options->name = name, options->rule = rule;
    if (!name || !rule) return STATUS_MEMORY;
    for (size_t k = 0; k < options->names; ++k) name[k] = (struct column_name){wanted->name[k][0], wanted->name[k][1]};
    for (size_t k = 0; k < options->rules; ++k) {
        const bool skip = k >= wanted->onlys;
        const char *const *pair = skip ? wanted->skip[k - wanted->onlys] : wanted->only[k];
        rule[k] = (struct row_rule){pair[0], pair[1], skip};
    }
    return STATUS_OK;
}

int fibrad_file_read(const struct file_wanted *wanted, struct file_bed *found, file_report *report, void *context) {
    struct read_options options = {
        .no_radius = wanted->no_radius != 0, .extra = wanted->column, .extras = wanted->columns, .any_unit = true};
    if (wanted->frame >= 0) options.frames = (struct frames){wanted->frame, wanted->frame + 1, 1};
    struct bed *bed = malloc(sizeof *bed);
    *found = (struct file_bed){.bed = bed};
    if (!bed) return STATUS_MEMORY;
    *bed = bed_empty();
    int status = take_columns(wanted, &options);
    message_redirect(report, context);
    if (!status) status = read_bed(wanted->path, &options, bed);
    message_redirect(NULL, NULL);
    free((void *)(uintptr_t)options.name);
    free((void *)(uintptr_t)options.rule);
    if (status) return status;
    found->n = bed->n;
    found->x = bed->x, found->y = bed->y, found->z = bed->z, found->r = bed->r;
    found->id = bed->ids ? bed->id : NULL;
    found->extra = bed->extra;
    memcpy(found->low, bed->low, sizeof bed->low);
    memcpy(found->high, bed->high, sizeof bed->high);
    memcpy(found->period, bed->period, sizeof bed->period);
    found->frame = bed->frame, found->timestep = bed->timestep;
    memcpy(found->units, bed->units, sizeof bed->units);
    return STATUS_OK;
}

void fibrad_file_free(struct file_bed *found) {
    if (found->bed) bed_free(found->bed);
    free(found->bed);
    *found = (struct file_bed){0};
}

/* Reverses the winding of triangles whose back is the wall. Status 0, or STATUS_INPUT. */
static int turn_to_walls(const struct meshes *meshes, struct file_mesh *found) {
    uint32_t both = 0;
    for (uint32_t t = 0; t < found->n; ++t) {
        uint32_t *corner = &found->corner[3 * (size_t)t];
        both += meshes->front[t] != FIBRAD_NO_WALL && meshes->back[t] != FIBRAD_NO_WALL;
        if (meshes->front[t] != FIBRAD_NO_WALL) continue;
        const uint32_t second = corner[1];
        corner[1] = corner[2];
        corner[2] = second;
    }
    found->both = both > 0;
    if (both == 0 || both == found->n) return STATUS_OK;
    return message_at(
        STATUS_INPUT, meshes->mesh[0].file, 0,
        "%u of %u triangles belong to twisted components, both sides of which are the wall; make both sides "
        "of all triangles the wall",
        both, found->n);
}

int fibrad_file_mesh(const char *path, double scale, int sides, const fibrad_spheres *spheres, const double period[3],
                     struct file_mesh *found, file_report *report, void *context) {
    const struct mesh_file file = {.path = path, .name = "mesh", .sides = (enum mesh_sides)sides, .scale = scale};
    struct meshes *meshes = calloc(1, sizeof *meshes);
    *found = (struct file_mesh){.meshes = meshes};
    if (!meshes) return STATUS_MEMORY;
    message_redirect(report, context);
    int status = meshes_add(meshes, &file, 0);
    if (!status) status = meshes_face(meshes, spheres, period);
    if (!status) {
        found->vertex = meshes->vertex, found->corner = meshes->corner;
        found->vertices = meshes->triangles.vertices, found->n = meshes->triangles.n;
        status = turn_to_walls(meshes, found);
    }
    message_redirect(NULL, NULL);
    return status;
}

void fibrad_file_mesh_free(struct file_mesh *found) {
    if (found->meshes) meshes_free(found->meshes);
    free(found->meshes);
    *found = (struct file_mesh){0};
}

size_t fibrad_file_sizeof(const char *name) {
    if (strcmp(name, "file_bed") == 0) return sizeof(struct file_bed);
    if (strcmp(name, "file_wanted") == 0) return sizeof(struct file_wanted);
    return strcmp(name, "file_mesh") == 0 ? sizeof(struct file_mesh) : 0;
}
