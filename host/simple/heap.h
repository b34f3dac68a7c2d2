/* heap.h - the kernel's blocks on the heap. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SIMPLE_HEAP_H
#define FIBRAD_SIMPLE_HEAP_H

#include "fibrad_mesh.h"
#include "simple/fibrad_host.h"

/* Makes a scene in *block, which is to be freed; NULL after an error. Errors: as fibrad_scene_init, _MEMORY. */
int fibrad_heap_scene(fibrad_scene **scene, void **block, const fibrad_scene_config *config,
                      const fibrad_spheres *spheres, fibrad_fault *fault);

/* Copies triangles (NULL: none) into one block, which is to be freed as copy->block; NULL after an error. Errors:
 * _MEMORY. */
struct fibrad_heap_triangles {
    struct fibrad_triangles triangles;
    void *block;
};
int fibrad_heap_copy(struct fibrad_heap_triangles *copy, const struct fibrad_triangles *given);

#endif
