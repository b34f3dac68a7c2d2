/* heap.h - the kernel's blocks on the heap, or in files. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SIMPLE_HEAP_H
#define FIBRAD_SIMPLE_HEAP_H

#include <stdbool.h>

#include "fibrad_mesh.h"
#include "simple/fibrad_host.h"

/* Makes a scene in *block, which is to be freed; NULL after an error. Errors: as fibrad_scene_init, _MEMORY. */
int fibrad_heap_scene(fibrad_scene **scene, void **block, const fibrad_scene_config *config,
                      const fibrad_spheres *spheres, fibrad_fault *fault);

/* Triangles in a block, which is to be freed. */
typedef struct fibrad_triangle_copy {
    struct fibrad_triangles triangles;
    void *block;
} fibrad_triangle_copy;

/* Copies triangles; NULL: none. The block is NULL then and after an error. Errors: _MEMORY. */
int fibrad_heap_triangles(fibrad_triangle_copy *copy, const struct fibrad_triangles *given);

/* A block; zeroed: empty and on the heap. */
typedef struct fibrad_scratch {
    bool filed; /* in a file, which is part of the address space and has no name */
    int file;
    void *block; /* NULL: none yet */
    size_t size;
} fibrad_scratch;

/* An empty block, in a file of this folder (NULL: on the heap). Close it also after an error. Errors: _MEMORY;
 * _ARGUMENT: no file can be made there. */
int fibrad_scratch_open(fibrad_scratch *scratch, const char *folder);
void fibrad_scratch_close(fibrad_scratch *scratch);

/* Makes the block of a fibrad_scratch, the context, larger; as fibrad_heap_resize. NULL also where a disk is full. */
void *fibrad_scratch_resize(void *scratch, void *block, size_t size);

#endif
