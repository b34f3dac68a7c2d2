/* furnace_cases.h - the published furnace, its reference values, and values along its axis.
 * SPDX-License-Identifier: MIT */
#ifndef FURNACE_CASES_H
#define FURNACE_CASES_H

#include "papers/furnace/furnace_run.h"

/* Case 1 (absorbs 0.5/m) or 2 (absorbs 0.15/m, scatters 0.35/m) on 20 x 20 x 40 cells.
 * Source: Zhao, Li, Wu, Li, Cang, J. Univ. Sci. Technol. Beijing 27 (2005) 423. */
fibrad_furnace_config furnace_case(int number);

/* Reference temperatures on the axis [K] at furnace_reference_z [m]. They come from Monte Carlo in equilibrium with 3e8
 * bundles and cells of 0.1 m, interpolated as by furnace_axis_temperature. The standard error is at most 0.1 K.
 * docs/validation.md describes how they were made. */
enum { FURNACE_REFERENCES = 21 };
extern const double furnace_reference_z[FURNACE_REFERENCES];
double furnace_reference(int number, int k);

/* Net powers of the walls z = 0, z = Z and of all sides [kW], the same in both cases. */
extern const double furnace_reference_power[3];

/* 1/Theta+ and 1/Theta- of the z axis at z = 0.2 k, k = 0 ... 20, for case 1 and both estimators, from 1e8 bundles. */
extern const double furnace_reference_theta[2][2][FURNACE_REFERENCES];

/* Temperature on the axis x = X/2, y = Y/2, linear between the centres of cells. */
double furnace_axis_temperature(const struct furnace_run *run, double z);

/* Theta of the z axis in hemisphere g, on the axis of the box, linear between faces of cells. */
double furnace_axis_theta(const struct furnace_run *run, int g, double z);

/* Net powers of the wall z = 0, of the wall z = Z and of all sides, and their sum with the source, which should be 0
 * [kW]. */
void furnace_powers(const struct furnace_run *run, double kilowatts[4]);

#endif
