/* method.h - methods by which the kernel computes a row, behind one signature. SPDX-License-Identifier: MIT */
#ifndef METHOD_H
#define METHOD_H

#include <stdbool.h>

#include "fibrad.h"

/* Row i by the rule, a status of the kernel: as fibrad_beam_row has it. */
typedef int row_function(const fibrad_scene *scene, fibrad_work *work, uint32_t i, const void *rule, fibrad_row *row);

/* A method with its rule, which has to stay where it is. */
struct row_method {
    const char *name;
    row_function *row;
    const void *rule;
    bool mirrored;          /* rows i and j hold one and the same S_ij, so that averaging makes it no better */
    const void *large_rule; /* for spheres much larger than the mean, if rows are averaged; NULL: the same */
};

struct row_method method_beam(const fibrad_beam_rule *rule);
struct row_method method_surface(const fibrad_surface_rule *rule);
struct row_method method_cast(const fibrad_cast_rule *rule);

#endif
