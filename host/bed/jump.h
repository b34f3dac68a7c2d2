/* jump.h - conductivity of a periodic bed by contacts, alone and together with radiation.
 * SPDX-License-Identifier: MIT
 *
 * All temperatures rise by the same amount from one period to the next, and each sphere gains nothing. */
#ifndef JUMP_H
#define JUMP_H

#include "bed/bed.h"
#include "bed/wall_option.h"
#include "simple/fibrad_host.h"

/* Contacts between spheres of a bed. The periods of the bed must be longer than twice its longest contact. */
struct jump_contacts {
    uint32_t n;
    const uint32_t *first, *second; /* [n] */
    const double *conductance;      /* [n], as fibrad_heat_sources.conductance, with sigma in W/(m2 K4) */
};

/* Radiation beside contacts. */
struct jump_radiation {
    const double *emissivity;  /* [spheres] */
    const struct walls *sides; /* insulated, in contact with nothing; NULL: none */
    double temperature;        /* [K] */
    double linear;             /* conductivity by radiation if T of the spheres is linear, in the unit of *k */
    uint32_t directions;       /* of heat problems */
};

/* The conductivity of a bed along a periodic axis by contacts alone [W/(m2 K) L]. volume: of the bed [L3]. Status of
 * the library. */
int jump_conductivity(const struct bed *bed, const struct jump_contacts *contacts, int axis, double volume, double *k);

/* The same by contacts and radiation together. contacts->n may be 0. Status of the library. */
int jump_joint(const struct bed *bed, const struct jump_contacts *contacts, const struct jump_radiation *radiation,
               int axis, double volume, fibrad_run *run, double *k);

#endif
