/* heap.c - memory of the kernel on the heap or in files, and sizes of public structures.
 * SPDX-License-Identifier: MIT */
#include "simple/heap.h"

#include "fibrad_mesh.h"

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

void *fibrad_heap_resize(void *context, void *block, size_t size) {
    (void)context;
    return realloc(block, size);
}

int fibrad_heap_scene(fibrad_scene **scene, void **block, const fibrad_scene_config *config,
                      const fibrad_spheres *spheres, fibrad_fault *fault) {
    *block = NULL;
    if (!spheres) return FIBRAD_E_ARGUMENT;
    const uint32_t triangles = config && config->triangles ? config->triangles->n : 0;
    const size_t of_spheres = fibrad_scene_size(spheres->n, spheres->id != NULL);
    const size_t of_triangles = triangles ? fibrad_triangles_size(triangles, spheres->n) : 0;
    if (!of_spheres || (triangles && !of_triangles)) return FIBRAD_E_ARGUMENT;
    const size_t size = of_spheres + of_triangles;
    *block = malloc(size);
    if (!*block) return FIBRAD_E_MEMORY;
    const int status = fibrad_scene_init(scene, *block, size, config, spheres, fault);
    if (!status) return FIBRAD_OK;
    free(*block);
    *block = NULL;
    return status;
}

/* The file is mapped. So rows and matrices in the file are used like those in memory, and the system writes to the disk
 * what does not fit into memory. Disk space is allocated before the file is mapped: else a full disk would end the
 * process by a signal. */
int fibrad_scratch_open(fibrad_scratch *scratch, const char *folder) {
    static const char name[] = "/fibrad.XXXXXX";
    *scratch = (fibrad_scratch){0};
    if (!folder) return FIBRAD_OK;
    const size_t length = strlen(folder);
    char *path = malloc(length + sizeof name);
    if (!path) return FIBRAD_E_MEMORY;
    memcpy(path, folder, length + 1);
    memcpy(path + length, name, sizeof name);
    scratch->file = mkstemp(path);
    scratch->filed = scratch->file >= 0;
    if (scratch->filed) {
        unlink(path);
        fcntl(scratch->file, F_SETFD, FD_CLOEXEC);
    }
    free(path);
    return scratch->filed ? FIBRAD_OK : FIBRAD_E_FILE;
}

void fibrad_scratch_close(fibrad_scratch *scratch) {
    if (!scratch->filed) {
        free(scratch->block);
    } else {
        if (scratch->block) munmap(scratch->block, scratch->size);
        close(scratch->file);
    }
    *scratch = (fibrad_scratch){0};
}

/* Enlarges the file and maps it anew. The old mapping stays if that fails. */
static void *map_larger(const fibrad_scratch *scratch, size_t size) {
    const off_t length = (off_t)size;
    if (length < 0 || (size_t)length != size || posix_fallocate(scratch->file, 0, length) != 0) return NULL;
    void *block = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_SHARED, scratch->file, 0);
    if (block == MAP_FAILED) return NULL;
    if (scratch->block) munmap(scratch->block, scratch->size);
    return block;
}

void *fibrad_scratch_resize(void *context, void *block, size_t size) {
    fibrad_scratch *scratch = context;
    void *larger = scratch->filed ? map_larger(scratch, size) : fibrad_heap_resize(NULL, block, size);
    if (larger) scratch->block = larger, scratch->size = size;
    return larger;
}

int fibrad_heap_triangles(fibrad_triangle_copy *copy, const struct fibrad_triangles *given) {
    *copy = (fibrad_triangle_copy){.block = NULL};
    if (!given || given->n == 0) return FIBRAD_OK;
    const size_t n = given->n, vertices = given->vertices, stride = given->stride ? given->stride : 1;
    const size_t sides = given->back ? 2 : 1;
    copy->block = malloc(3 * vertices * sizeof(double) + (3 + sides) * n * sizeof(uint32_t));
    if (!copy->block) return FIBRAD_E_MEMORY;
    double *x = copy->block;
    uint32_t *corner = (void *)(x + 3 * vertices);
    for (size_t v = 0; v < vertices; ++v)
        x[3 * v] = given->x[v * stride], x[3 * v + 1] = given->y[v * stride], x[3 * v + 2] = given->z[v * stride];
    memcpy(corner, given->corner, 3 * n * sizeof *corner);
    memcpy(corner + 3 * n, given->front, n * sizeof *corner);
    if (given->back) memcpy(corner + 4 * n, given->back, n * sizeof *corner);
    copy->triangles = (struct fibrad_triangles){.x = x,
                                                .y = x + 1,
                                                .z = x + 2,
                                                .stride = 3,
                                                .vertices = given->vertices,
                                                .corner = corner,
                                                .front = corner + 3 * n,
                                                .back = given->back ? corner + 4 * n : NULL,
                                                .n = given->n,
                                                .period = {given->period[0], given->period[1], given->period[2]}};
    return FIBRAD_OK;
}

typedef struct fibrad_triangles fibrad_triangles;

#define STRUCTURE(name)                                                                                                \
    { #name, sizeof(name) }

size_t fibrad_host_sizeof(const char *name) {
    static const struct {
        char name[24];
        size_t size;
    } structures[] = {
        STRUCTURE(fibrad_memory),        STRUCTURE(fibrad_spheres),      STRUCTURE(fibrad_wall),
        STRUCTURE(fibrad_scene_config),  STRUCTURE(fibrad_fault),        STRUCTURE(fibrad_scene_facts),
        STRUCTURE(fibrad_work),          STRUCTURE(fibrad_row),          STRUCTURE(fibrad_rows),
        STRUCTURE(fibrad_beam_rule),     STRUCTURE(fibrad_cast_rule),    STRUCTURE(fibrad_cast_means),
        STRUCTURE(fibrad_occupancy),     STRUCTURE(fibrad_flow),         STRUCTURE(fibrad_surface_rule),
        STRUCTURE(fibrad_surface_facts), STRUCTURE(fibrad_matrix_rule),  STRUCTURE(fibrad_factors),
        STRUCTURE(fibrad_exchange_rule), STRUCTURE(fibrad_displacement), STRUCTURE(fibrad_heat_config),
        STRUCTURE(fibrad_heat_sources),  STRUCTURE(fibrad_heat_result),  STRUCTURE(fibrad_light),
        STRUCTURE(fibrad_light_ends),    STRUCTURE(fibrad_light_ray),    STRUCTURE(fibrad_light_hits),
        STRUCTURE(fibrad_light_sources), STRUCTURE(fibrad_light_result), STRUCTURE(fibrad_run),
        STRUCTURE(fibrad_bed_options),   STRUCTURE(fibrad_bed_factors),  STRUCTURE(fibrad_transient_config),
        STRUCTURE(fibrad_span),          STRUCTURE(fibrad_wall_row),     STRUCTURE(fibrad_triangles),
        STRUCTURE(fibrad_triangle_hit),  STRUCTURE(fibrad_side_view),    STRUCTURE(fibrad_row_part),
        STRUCTURE(fibrad_plane),         STRUCTURE(fibrad_contact_rule), STRUCTURE(fibrad_contact_list),
    };
    for (size_t k = 0; name && k < sizeof structures / sizeof *structures; ++k)
        if (strcmp(name, structures[k].name) == 0) return structures[k].size;
    return 0;
}
