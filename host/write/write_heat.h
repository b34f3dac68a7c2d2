/* write_heat.h - net radiative powers to files. SPDX-License-Identifier: MIT */
#ifndef WRITE_HEAT_H
#define WRITE_HEAT_H

#include <stdbool.h>
#include <stdio.h>

#include "bed/bed.h"
#include "bed/wall_option.h"
#include "fibrad.h"

struct heat_contents {
    const struct bed *bed;
    const struct walls *walls;
    const fibrad_heat_sources *sources;
    const fibrad_heat_result *result;
};

/* Writes to the file; a failing file is noticed by the caller. Status 0 or that of a signal. */
typedef int write_heat_function(FILE *file, const struct heat_contents *what);

/* Values i,T,q: spheres, then the surroundings as -1 and the walls as -2, -3 ... in the order given. */
write_heat_function write_heat_csv;

/* The spheres for ParaView, with temperature, emissivity and power. */
write_heat_function write_heat_vtp;

#endif
