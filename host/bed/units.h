/* units.h - units of length and temperature by name. SPDX-License-Identifier: MIT */
#ifndef UNITS_H
#define UNITS_H

#include <stdbool.h>

/* What --help says of them. */
#define UNITS_LENGTH "m, cm, mm, um, nm, angstrom, or a style of LAMMPS: si, cgs, micro, nano, real, metal, electron"

/* Metres of a unit of length, or of that of a style of LAMMPS; 0 for lj, which has none. False: there is no such unit.
 * Source: LAMMPS, command `units`. */
bool unit_of_length(const char *name, double *metres);

/* Whether a unit that a file says is this one: K, C or another. Those of temperature have several names. */
bool unit_is(const char *said, const char *unit);

#define KELVIN_OF_0_CELSIUS 273.15

/* A row of a table of options, without braces. */
#define OPTION_TEMPERATURE_UNIT                                                                                        \
    KEY_TEMPERATURE_UNIT, "temperature-unit", "UNIT",                                                                  \
        "unit of the temperatures that are given, K or C; results are in K [K]"

/* Takes the argument of --temperature-unit: 0 of that unit in kelvins. Status 0 or STATUS_USAGE. */
int temperature_unit_option(const char *text, double *zero);

#endif
