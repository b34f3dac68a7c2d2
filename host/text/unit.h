/* unit.h - units of quantities, as names of columns have them. SPDX-License-Identifier: MIT */
#ifndef UNIT_H
#define UNIT_H

#include <stdbool.h>
#include <stddef.h>

/* Finds the factor by which a value in the unit `name` becomes one in the unit `wanted`. kW becomes W by 1000. A unit
 * is a product of m, g, s, K, W, J, N, L, min, h and d with prefixes, such as W/(m K), W/m/K, W m-1 K-1, J/kgK, g/cm3
 * or kg/m^3. K and C are temperatures if they stand alone: no factor leads from one to the other. False: the unit is
 * none of this kind. */
bool unit_factor(const char *name, const char *wanted, double *factor);

/* Finds the unit in brackets at the end of a name of a column, `x [mm]` or `k (W/(m K))`. bare: length of the name
 * before it. unit, length: the text of the unit. False: there is none, as in f_T[1], whose bracket
 * is an index. */
bool unit_behind(const char *name, size_t *bare, const char **unit, size_t *length);

/* Whether a name means K, or C, which have several names. */
bool unit_is(const char *name, const char *unit);

/* Whether a name means K or C. */
bool unit_temperature(const char *name);

/* Whether a name says that there is no unit: "", "-" or "1". */
bool unit_none(const char *name);

#endif
