/* heap.h - memory of the kernel on the heap or in files; the larger and the smaller of two numbers.
 * SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SIMPLE_HEAP_H
#define FIBRAD_SIMPLE_HEAP_H

#include <stdbool.h>

#include "simple/fibrad_host.h"

/* fmax and fmin would need the library of mathematics. */
static inline double larger_of(double a, double b) { return a > b ? a : b; }
static inline double smaller_of(double a, double b) { return a < b ? a : b; }

/* Makes a scene in *block. The caller frees *block, which is NULL after an error. Errors: as fibrad_scene_init;
 * _MEMORY. */
int fibrad_heap_scene(fibrad_scene **scene, void **block, const fibrad_scene_config *config,
                      const fibrad_spheres *spheres, fibrad_fault *fault);

/* A block that grows. Zeroed: empty, on the heap. */
typedef struct fibrad_scratch {
    bool filed;  /* the block is a mapped file without a name */
    int file;    /* its descriptor, if filed */
    void *block; /* NULL: none yet */
    size_t size;
} fibrad_scratch;

/* Makes an empty block in a file of a folder. folder NULL: on the heap. Close the block also after an error. Errors:
 * _MEMORY; _FILE: no file can be made in the folder. */
int fibrad_scratch_open(fibrad_scratch *scratch, const char *folder);
void fibrad_scratch_close(fibrad_scratch *scratch);

/* A fibrad_resize that enlarges the block of a fibrad_scratch. Returns NULL also if the disk is full. */
void *fibrad_scratch_resize(void *scratch, void *block, size_t size);

#endif
