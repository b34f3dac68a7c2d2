/* furnace_shoot.h - the heat-flux equations by Runge-Kutta and secant shooting. SPDX-License-Identifier: MIT */
#ifndef FURNACE_SHOOT_H
#define FURNACE_SHOOT_H

#include "boxes/furnace_run.h"

/* Solves what fibrad_furnace_solve solves in the way of the paper: each line is integrated from its first wall by the
 * classical Runge-Kutta rule (GSL odeiv2), one step per cell, and the unknown flux there is found by the secant method
 * (GSL roots). It loses digits as exp(thickness/Theta), so it is for lines of optical thickness up to 10 or so.
 * Status 0, STATUS_INPUT if there is no convergence, STATUS_MEMORY, or that of a signal. */
int furnace_shoot(struct furnace_run *run, fibrad_furnace_scatter scatter, double tolerance);

#endif
