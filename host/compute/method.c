/* method.c - methods by which the kernel computes a row, behind one signature. SPDX-License-Identifier: MIT */
#include "compute/method.h"

#include <stddef.h>

static int beam(const fibrad_scene *scene, fibrad_work *work, uint32_t i, const void *rule, fibrad_row *row) {
    return fibrad_beam_row(scene, work, i, rule, row);
}

static int surface(const fibrad_scene *scene, fibrad_work *work, uint32_t i, const void *rule, fibrad_row *row) {
    return fibrad_surface_row(scene, work, i, rule, row);
}

static int cast(const fibrad_scene *scene, fibrad_work *work, uint32_t i, const void *rule, fibrad_row *row) {
    return fibrad_cast_row(scene, work, i, rule, row, NULL);
}

struct row_method method_beam(const fibrad_beam_rule *rule) {
    return (struct row_method){"beam", beam, rule, false, NULL};
}

struct row_method method_surface(const fibrad_surface_rule *rule) {
    return (struct row_method){"surface", surface, rule, true, NULL};
}

struct row_method method_cast(const fibrad_cast_rule *rule) {
    return (struct row_method){rule->random ? "mc" : "cast", cast, rule, false, NULL};
}
