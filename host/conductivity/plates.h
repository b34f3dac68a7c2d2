/* plates.h - conductivity of a bed between two black plates; no sphere gains or loses heat.
 * SPDX-License-Identifier: MIT
 *
 * The plates stand at both ends of the spheres along an axis. Spheres within a diameter of a plate have its
 * temperature. The gradient is that of a straight line through the temperatures of the spheres in the inner half. */
#ifndef PLATES_H
#define PLATES_H

#include "conductivity/conductivity.h"

/* A bed between plates. */
struct plates {
    struct bed bed; /* open along the axis; its arrays are those of another bed */
    double period;  /* along the axis, or 0 */
    int axis;
    struct walls walls; /* the lower plate, the upper plate, and then the sides */
    fibrad_bed *made;
};

/* Whether the bed is periodic along both other axes, or ends at walls there. */
bool plates_possible(const struct bed *bed, const struct walls *sides, int axis);

/* Puts plates at both ends of a bed. sides: insulated; NULL: none. Close the plates also after an error. Status of the
 * library. */
int plates_open(struct plates *plates, const struct bed *bed, const struct walls *sides, int axis, fibrad_run *run);
void plates_close(struct plates *plates);

struct plates_problem {
    const double *emissivity; /* [spheres] */
    const double *relative;   /* [spheres] k* of spheres that conduct; NULL: each sphere has one temperature */
    double temperature;       /* [K] mean of both plates */
    bool touches;             /* conductivities with contacts are wanted */
    /* contacts, as in fibrad_heat_sources; those with sides and across a period along the axis are left out */
    uint32_t contacts;
    const uint32_t *first, *second;
    const double *conductance;
};

/* Finds the conductivity by radiation, by contacts and by both, in W/(m2 K) times the unit of length. If fewer than
 * PLATES_FITTED spheres lie in the inner half, the results are NaN. Status of the library. */
enum { PLATES_FITTED = 40 };
int plates_conduct(const struct plates *plates, const struct plates_problem *problem, struct conduction_plates *result);

#endif
