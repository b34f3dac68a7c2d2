/* bed_scene.h - a bed as the library takes it, and what the library says of it as messages.
 * SPDX-License-Identifier: MIT */
#ifndef BED_SCENE_H
#define BED_SCENE_H

#include "bed/bed.h"
#include "bed/wall_option.h"
#include "fibrad.h"

/* The spheres of a bed; the box of a bed with walls (NULL: none), which stay the caller's. */
fibrad_spheres bed_spheres(const struct bed *bed);
fibrad_scene_config bed_scene(const struct bed *bed, const struct walls *walls);

/* The exit status for a status of the library, after a message that names the bed's file and, where `fault` names
 * spheres, the line. STATUS_OK for FIBRAD_OK; that of the signal, without a message, for FIBRAD_E_CANCELLED. */
int bed_status(const struct bed *bed, const char *file, int status, const fibrad_fault *fault);

#endif
