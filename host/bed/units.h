/* units.h - units of length and temperature by name. SPDX-License-Identifier: MIT */
#ifndef UNITS_H
#define UNITS_H

#include <stdbool.h>

/* What --help says of them. */
#define UNITS_LENGTH "m, cm, mm, um, nm, angstrom, or a style of LAMMPS: si, cgs, micro, nano, real, metal, electron"

/* Metres of a unit of length, or of that of a style of LAMMPS; 0 for lj, which has none. False: there is no such unit.
 * Source: LAMMPS, command `units`. */
bool unit_of_length(const char *name, double *metres);

#define KELVIN_OF_0_CELSIUS 273.15

#endif
