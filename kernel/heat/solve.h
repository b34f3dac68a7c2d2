/* solve.h - radiosities by conjugate gradients. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_HEAT_SOLVE_H
#define FIBRAD_HEAT_SOLVE_H

#include "heat/problem.h"

/* Makes the next sweep the first one of a solution. */
void fibrad_heat_start(fibrad_heat *heat);

/* The temperature of an emission counted from that of the surroundings; NaN: it would be below zero. */
double fibrad_heat_temperature(const fibrad_heat *heat, double emission);

#endif
