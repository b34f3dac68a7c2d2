/* radiation.h - the inside of a heat problem of a bed that may move. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SIMPLE_RADIATION_H
#define FIBRAD_SIMPLE_RADIATION_H

#include "simple/team.h"

struct fibrad_radiation {
    fibrad_team team;
    fibrad_heat_config config;
    fibrad_heat *heat; /* NULL: none yet */
    void *heat_block;
    size_t heat_size; /* bytes of heat_block; 0: none */
    fibrad_scene *scene;
    void *scene_block;
    uint32_t n;
    fibrad_fault fault;
    double *light; /* [patches] of the last fibrad_radiation_shine; NULL: none */
};

#endif
