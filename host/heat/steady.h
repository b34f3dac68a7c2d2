/* steady.h - effective conductivity of a bed between two plates; no sphere gains or loses heat.
 * SPDX-License-Identifier: MIT */
#ifndef STEADY_H
#define STEADY_H

#include "frames/bed_options.h"

/* Exchange factor F_E along one axis: flux / (mean diameter x gradient of sigma T^4). The gradient is that of a
 * straight line through the spheres of the inner half. */
struct steady {
    double factor;
    double error;     /* estimated, of the line, of the flux and of the directions together */
    uint32_t spheres; /* in the inner half */
    double seconds;   /* time of computing [s] */
};

/* Whether the bed is periodic along both other axes, or ends at walls there. walls NULL: none. */
bool steady_possible(const struct bed *bed, const struct walls *walls, int axis);

/* Puts black plates at both ends of the bed along an axis, whose period is dropped. Sides (walls) are insulated. Then
 * finds the temperatures at which no sphere gains or loses heat. emissivity [spheres]. relative [spheres]: k* of
 * spheres that conduct, solved by patches; NULL: each sphere has one temperature. Status 0, STATUS_INPUT if fewer than
 * 40 spheres lie in the inner half, or as bed_options_status. */
int steady_conduction(struct bed_options *options, const struct bed *bed, const struct walls *walls,
                      const double *emissivity, const double *relative, int axis, struct steady *steady);

#endif
