/* heap.c - the kernel's blocks on the heap, and the sizes of its structures. SPDX-License-Identifier: MIT */
#include "simple/heap.h"

#include "fibrad_mesh.h"
#include "fibrad_part.h"

#include <stdlib.h>
#include <string.h>

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

#define STRUCTURE(name)                                                                                                \
    { #name, sizeof(name) }

size_t fibrad_host_sizeof(const char *name) {
    static const struct {
        char name[24];
        size_t size;
    } structures[] = {
        STRUCTURE(fibrad_memory),        STRUCTURE(fibrad_spheres),      STRUCTURE(fibrad_body),
        STRUCTURE(fibrad_scene_config),  STRUCTURE(fibrad_fault),        STRUCTURE(fibrad_scene_facts),
        STRUCTURE(fibrad_work),          STRUCTURE(fibrad_row),          STRUCTURE(fibrad_rows),
        STRUCTURE(fibrad_beam_rule),     STRUCTURE(fibrad_cast_rule),    STRUCTURE(fibrad_cast_means),
        STRUCTURE(fibrad_occupancy),     STRUCTURE(fibrad_flow),         STRUCTURE(fibrad_surface_rule),
        STRUCTURE(fibrad_surface_facts), STRUCTURE(fibrad_matrix_rule),  STRUCTURE(fibrad_factors),
        STRUCTURE(fibrad_exchange_rule), STRUCTURE(fibrad_displacement), STRUCTURE(fibrad_heat_config),
        STRUCTURE(fibrad_heat_sources),  STRUCTURE(fibrad_heat_result),  STRUCTURE(fibrad_run),
        STRUCTURE(fibrad_bed_options),   STRUCTURE(fibrad_bed_factors),  STRUCTURE(fibrad_transient_config),
        STRUCTURE(fibrad_span),          STRUCTURE(fibrad_body_row),
    };
    for (size_t k = 0; name && k < sizeof structures / sizeof *structures; ++k)
        if (strcmp(name, structures[k].name) == 0) return structures[k].size;
    return 0;
}
