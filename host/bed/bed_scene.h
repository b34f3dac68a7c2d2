/* bed_scene.h - a bed in the form of the library, and messages for errors of the library.
 * SPDX-License-Identifier: MIT */
#ifndef BED_SCENE_H
#define BED_SCENE_H

#include "bed/wall_option.h"
#include "simple/fibrad_host.h"

/* The spheres of a bed with their ids, and its periods and walls. Both refer to arrays of `bed` and `walls`. walls
 * NULL: none. */
fibrad_spheres bed_spheres(const struct bed *bed);
fibrad_scene_config bed_scene(const struct bed *bed, const struct walls *walls);

/* Returns the exit status for a status of the library. After an error prints a message that names the file and, if
 * `fault` names a sphere, its line. FIBRAD_OK gives STATUS_OK. FIBRAD_E_CANCELLED gives the status of the signal,
 * without a message. */
int bed_status(const struct bed *bed, const char *file, int status, const fibrad_fault *fault);

#endif
