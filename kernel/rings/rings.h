/* rings.h - two spheres near each other, in rings about the line of their centres. SPDX-License-Identifier: MIT
 *
 * Where two spheres nearly touch, temperatures differ over lengths much shorter than a patch. Averaged around the line
 * of centres, light and conduction are those of rings. A sphere conducts its average around any axis as it conducts the
 * whole, so the temperature on the axis is exact however the rest of the surface is lit. The rings become narrower
 * towards the axis in geometric progression. */
#ifndef FIBRAD_RINGS_H
#define FIBRAD_RINGS_H

#include "base/port.h"

#define FIBRAD_RINGS 28u

/* The rings of a sphere. Ring 0 is about the point where the axis leaves the sphere. */
typedef struct fibrad_rings {
    double edge[FIBRAD_RINGS + 1]; /* (1 - cosine)/2 of the angle of the edges to the axis: the share within */
    double share[FIBRAD_RINGS];    /* of the sphere's area */
    double cosine[FIBRAD_RINGS], sine[FIBRAD_RINGS]; /* of the angle of the middle by area */
    /* the emission of one ring for a flux that another one conducts inwards, if 1/(2 K) is 1 (heat/sphere_conduction.c)
     */
    double spread[FIBRAD_RINGS][FIBRAD_RINGS];
} fibrad_rings;

void fibrad_rings_make(fibrad_rings *rings);

/* The ring at the cosine of an angle to the axis. */
uint32_t fibrad_rings_at(const fibrad_rings *rings, double cosine);

/* A sphere in rings. Of two spheres the axis of each points to the other. */
typedef struct fibrad_ringed {
    double radius, emissivity;
    double unevenness, emission;   /* as of heat/sphere_conduction.c; the mean emission of the surface */
    double biot;                   /* h R/k of a film */
    double arriving[FIBRAD_RINGS]; /* light per area that does not come from the other sphere */
    double absorbed[FIBRAD_RINGS]; /* light per area that was absorbed besides */
} fibrad_ringed;

/* Memory to work with. */
typedef struct fibrad_rings_work {
    double factor[2][FIBRAD_RINGS][FIBRAD_RINGS]; /* from each ring of a sphere to the rings of the other */
    double facing[2][FIBRAD_RINGS];               /* their sums */
    double row[2 * FIBRAD_RINGS][2 * FIBRAD_RINGS + 1];
    double spread[2][FIBRAD_RINGS][FIBRAD_RINGS]; /* of each sphere, with its film */
} fibrad_rings_work;

/* Finds the view factors between the rings of two spheres of these radii. Their sums are exact. How they are shared out
 * follows from the middles of rings. */
void fibrad_rings_face(const fibrad_rings *rings, const double radius[2], double distance, fibrad_rings_work *work);

/* What a unit of power over area that enters through a spot makes of the emissions of rings, if 1/(2 K) is 1 and
 * nothing is radiated. */
void fibrad_rings_warmth(const fibrad_rings *rings, double size, double warmth[FIBRAD_RINGS]);

/* The view factor to another sphere from a place of a sphere, `cosine` to the axis. */
double fibrad_rings_sees(double radius, double other, double distance, double cosine);

/* A spot of one temperature around the axis through which heat enters a sphere.
 *   Input    size: its radius over that of the sphere
 *            biot: as in fibrad_ringed
 *   Output   response: for one unit of absorbed power over area that is spread in this ring alone, over the share of
 *            the ring: mean emission of the spot, minus that of the sphere
 *            returned: for a unit of power over area that enters through the spot, by how much less the spot emits than
 *            if the sphere did not radiate and had no film */
double fibrad_rings_spot(const fibrad_rings *rings, double size, const double emissivity[FIBRAD_RINGS],
                         double unevenness, double biot, fibrad_rings_work *work, double response[FIBRAD_RINGS]);

/* The emission on the axis minus the mean emission of sphere[0]. count: 1, or 2 if the spheres face each other. */
double fibrad_rings_top(const fibrad_rings *rings, const fibrad_ringed *sphere, uint32_t count,
                        fibrad_rings_work *work);

#endif
