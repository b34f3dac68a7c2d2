/* parts.h - which spheres make up the parts of a sweep. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_HEAT_PARTS_H
#define FIBRAD_HEAT_PARTS_H

#include "heat/problem.h"

/* Puts the spheres into the sequence of sweeps, and each into a part. */
void fibrad_heat_divide(fibrad_heat *heat);

#endif
