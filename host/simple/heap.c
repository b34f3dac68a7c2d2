/* heap.c - memory of the kernel on the heap or in files, and sizes of public structures.
 * SPDX-License-Identifier: MIT */
#include "simple/heap.h"

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
    const size_t size = of_spheres + of_triangles + (spheres->clump ? fibrad_clumps_size(spheres->n) : 0);
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

typedef struct fibrad_triangles fibrad_triangles;

/* Structures whose sizes other languages may compare. */
#define STRUCTURES                                                                                                     \
    OF(memory), OF(spheres), OF(wall), OF(scene_config), OF(fault), OF(scene_facts), OF(work), OF(row), OF(rows),      \
        OF(beam_rule), OF(cast_rule), OF(cast_means), OF(occupancy), OF(flow), OF(matrix_rule), OF(factors),           \
        OF(exchange_rule), OF(heat_config), OF(stream), OF(heat_sources), OF(heat_result), OF(light), OF(light_ends),  \
        OF(light_ray), OF(light_hits), OF(light_sources), OF(light_result), OF(run), OF(bed_rule), OF(bed_matrix),     \
        OF(warning), OF(law), OF(store), OF(span), OF(wall_row), OF(triangles), OF(triangle_hit), OF(side_view),       \
        OF(plane), OF(cylinder), OF(wall_rule), OF(contact_rule), OF(contact_list), OF(displacement_rule),             \
        OF(displacement)
#define OF(name)                                                                                                       \
    { "fibrad_" #name, sizeof(fibrad_##name) }

size_t fibrad_host_sizeof(const char *name) {
    static const struct {
        char name[32];
        size_t size;
    } structures[] = {STRUCTURES};
    for (size_t k = 0; name && k < sizeof structures / sizeof *structures; ++k)
        if (strcmp(name, structures[k].name) == 0) return structures[k].size;
    return 0;
}
