/* face.h - the hemispherical emissivity of the open face of a bed. SPDX-License-Identifier: MIT */
#ifndef FACE_H
#define FACE_H

#include "frames/bed_options.h"

/* The emissivity of a bed's face: what spheres and walls of one temperature send out through the open faces, divided by
 * what black faces would send out. */
struct face {
    bool wanted;
    double area; /* of all open faces, in the bed's unit of length squared */
    double emissivity, error;
};

/* Finds the area of the open faces. Status 0, or STATUS_USAGE if there is none or one has no end. */
int face_begin(struct face *face, const struct bed *bed, const struct walls *walls);

/* Finds the emissivity. By Kirchhoff's law it is the fraction of black radiation from outside that spheres and walls
 * absorb: paths from the open faces tell it. Sets run->fault. Returns a status of the library. */
int face_solve(struct face *face, const struct bed *bed, const struct walls *walls, const fibrad_heat_sources *sources,
               fibrad_run *run);

void face_report(const struct face *face, double metres, struct report *report);

#endif
