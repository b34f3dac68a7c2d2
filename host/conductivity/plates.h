/* plates.h - conductivity of a bed between two black plates; no sphere gains or loses heat. SPDX-License-Identifier:
 * MIT
 *
 * The plates stand at both ends of the spheres along an axis. Spheres within a diameter of a plate have its
 * temperature. The gradient is that of a straight line through the temperatures of the spheres in the inner half. */
#ifndef PLATES_H
#define PLATES_H

#include "conductivity/conductivity.h"

struct plates_problem {
    const struct bed *bed;          /* a period along the axis is dropped */
    const struct walls *sides;      /* insulated, in contact with nothing; NULL: none */
    const double *emissivity;       /* [spheres]; NULL: contacts alone */
    const double *relative;         /* [spheres] k* of spheres that conduct; NULL: each sphere has one temperature */
    double temperature;             /* [K] mean of both plates */
    bool touches;                   /* conductivities with contacts are wanted */
    uint32_t contacts;              /* contacts across a period along the axis are left out */
    const uint32_t *first, *second; /* [contacts] as in fibrad_heat_sources */
    const double *conductance;      /* [contacts] likewise, for lengths in the unit of the bed */
};

/* Whether the bed is periodic along both other axes, or ends at walls there. */
bool plates_possible(const struct bed *bed, const struct walls *sides, int axis);

/* The plates across an axis, the lower one first, and then the sides. */
struct walls plates_walls(const struct bed *bed, const struct walls *sides, int axis);

/* Finds the conductivity by radiation, by contacts and by both, in W/(m2 K) times the unit of length. made: the bed of
 * the problem, open along the axis, with the walls of plates_walls. Status of the library. result->spheres is then
 * below PLATES_FITTED if too few spheres lie in the inner half. */
enum { PLATES_FITTED = 40 };
int plates_conduct(const struct plates_problem *problem, fibrad_bed *made, int axis, struct conduction_plates *result);

#endif
