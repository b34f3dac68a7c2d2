/* plot_unit.h - units with prefixes, so that the numbers of a panel have few digits. SPDX-License-Identifier: MIT */
#ifndef PLOT_UNIT_H
#define PLOT_UNIT_H

/* A unit: `scale` of the plain one. */
struct plot_unit {
    double scale;  /* a power of 1000 */
    char name[24]; /* mW, kW, 10^{15} W; "": the plain unit has no name and the scale is 1 */
};

/* The unit in which the largest size of a quantity is from 0.1 to 1000, or the plain unit if the size is 0. unit:
 * name of the plain unit; "": it has none, and the name is a power of ten. */
struct plot_unit plot_unit_of(double largest, const char *unit);

#endif
