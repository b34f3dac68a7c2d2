/* units.h - units of length and temperature by name; prefixes of units in pictures. SPDX-License-Identifier: MIT */
#ifndef UNITS_H
#define UNITS_H

#include <stdbool.h>

/* The names in --help. */
#define UNITS_LENGTH "m, cm, mm, um, nm, angstrom, or a style of LAMMPS: si, cgs, micro, nano, real, metal, electron"

/* Finds the length of a unit, or of the unit of length of a LAMMPS style [m]. lj has no length: 0. False: there is no
 * such unit. Source: LAMMPS, command `units`. */
bool unit_of_length(const char *name, double *metres);

#define KELVIN_OF_0_CELSIUS 273.15

/* The unit of temperature, K or C, by its 0 [K]. */
const char *temperature_unit(double zero);

/* A row of a table of options, without braces. The field gets 0 of the unit [K]. */
#define OPTION_TEMPERATURE_UNIT(request, field)                                                                        \
    0, "temperature-unit", "UNIT", "unit of the temperatures that are given, K or C; results are in K [K]",            \
        TO_FUNCTION(temperature_unit_option, request, field)

/* Takes the argument of --temperature-unit into a double. Status 0 or STATUS_USAGE. */
int temperature_unit_option(const char *text, void *zero);

/* A unit: `scale` of the plain one. */
struct prefixed {
    double scale;  /* of a power of 1000; of times also a minute, an hour, a day */
    char name[24]; /* mW, kW, 10^{15} W; "": the plain unit has no name and the scale is 1 */
};

/* The unit in which the largest size of a quantity is from 0.1 to 1000, or the plain unit if the size is 0. unit:
 * name of the plain unit; "": it has none, and the name is a power of ten. */
struct prefixed unit_prefixed(double largest, const char *unit);

/* The unit for times up to this number of seconds: minutes, hours and days from two of them on. */
struct prefixed unit_seconds(double largest);

#endif
