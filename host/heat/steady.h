/* steady.h - effective conductivity of a bed between two plates, whose spheres settle at their own temperatures.
 * SPDX-License-Identifier: MIT */
#ifndef STEADY_H
#define STEADY_H

#include "frames/bed_options.h"

/* F_E along one axis: flux over mean diameter and gradient of sigma T^4, the latter by a straight line through the
 * spheres of the inner half. */
struct steady {
    double factor, error; /* of the line and of the flux, estimated */
    uint32_t spheres;     /* of the inner half */
    double seconds;
};

/* Whether the bed is periodic along both other axes. */
bool steady_possible(const struct bed *bed, int axis);

/* Puts black plates where the spheres end along an axis, which is open then, and solves for temperatures at which no
 * sphere gains anything. emissivity [spheres]. Status 0, STATUS_INPUT if there are less than 40 spheres in the inner
 * half, or as bed_options_status. */
int steady_conduction(struct bed_options *asked, const struct bed *bed, const double *emissivity, int axis,
                      struct steady *steady);

#endif
