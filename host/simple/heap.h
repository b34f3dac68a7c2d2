/* heap.h - the kernel's blocks on the heap. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SIMPLE_HEAP_H
#define FIBRAD_SIMPLE_HEAP_H

#include "simple/fibrad_host.h"

/* Makes a scene in *block, which is to be freed; NULL after an error. Errors: as fibrad_scene_init, _MEMORY. */
int fibrad_heap_scene(fibrad_scene **scene, void **block, const fibrad_scene_config *config,
                      const fibrad_spheres *spheres, fibrad_fault *fault);

#endif
