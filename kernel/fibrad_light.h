/* fibrad_light.h - light from outside that falls on a bed: sun or lasers.
 *
 * Light of one direction is a bundle of parallel rays. It comes from outside, enters by what is open of the container,
 * and ends on the first sphere or wall that it meets. What a sphere takes of it is the area of its shadow disc that no
 * sphere and no wall hides from the light. These areas are exact.
 *
 * Sequence   1. fibrad_light_empty tells where the light would end if there were no spheres.
 *            2. fibrad_light_spheres tells for ranges of spheres what they take, and from whom.
 *            What ends on a wall, or leaves, is that of step 1 less that of all ranges of step 2.
 *            fibrad_heat_shine does the same, and puts the light on the patches of a heat problem.
 * Units      as in fibrad.h. A power is in units of flux times L^2. With a flux of 1 it is an area.
 * Words      Memory, errors and the layout of comments are as in fibrad.h.
 * Source     docs/methods_heat.md, Light from outside. docs/heat.md says what is assumed.
 *
 * SPDX-License-Identifier: MIT */
#ifndef FIBRAD_LIGHT_H
#define FIBRAD_LIGHT_H

#include "fibrad_heat.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The cross-section of light. */
typedef enum fibrad_light_shape {
    FIBRAD_LIGHT_ALL = 0,  /* what the open faces let in; without walls and periods what meets the box of the spheres */
    FIBRAD_LIGHT_DISC = 1, /* what passes through a disc across the middle direction; fibrad_light.centre, radius */
    FIBRAD_LIGHT_BOX = 2   /* what passes through a rectangle at the end of the bed in z; fibrad_light.low, high */
} fibrad_light_shape;

/* Light from outside. Zero but for direction and flux: parallel light on all that is open.
 *
 * Light with a half-angle has directions that fill a cone evenly. Each direction carries an equal part of the flux. The
 * sun's half-angle is FIBRAD_SUN_HALF_ANGLE.
 *
 * The box of the spheres is that of their centres, wider by the largest radius on all sides. On periodic axes a disc or
 * rectangle is repeated, and must not be wider than a period. Spheres lie behind the disc as seen from the light. */
typedef struct fibrad_light {
    double direction[3];    /* the way that the light goes, of any length above 0 */
    double flux;            /* sigma K^4 (W/m2 if sigma is in W/(m2 K4)), across the direction; 0 to FIBRAD_POWER_MAX */
    double half_angle;      /* rad, of the cone, 0 to FIBRAD_HALF_ANGLE_MAX; 0: parallel */
    uint32_t directions;    /* of the cone, up to FIBRAD_LIGHT_DIRECTIONS_MAX; 0: FIBRAD_LIGHT_DIRECTIONS_DEFAULT */
    int shape;              /* a fibrad_light_shape */
    double centre[3];       /* L, of the disc */
    double radius;          /* L, of the disc, above 0 */
    double low[2], high[2]; /* L, x and y of the rectangle, low below high */
} fibrad_light;

/* Where light ends. */
typedef struct fibrad_light_ends {
    double spheres;                 /* on spheres */
    double through;                 /* leaves without having met anything */
    double body[FIBRAD_BODIES_MAX]; /* on each wall */
} fibrad_light_ends;

/* Where light ends if there are no spheres.
 *   Output   ends: spheres is 0, the others add up to the power of the light
 *            fault: which sphere is at fault, and why; may be NULL
 *   Errors   _ARGUMENT: fault.why is FIBRAD_WHY_LIGHT, a number is out of range; FIBRAD_WHY_DARK, no open face lets the
 *            light in; or FIBRAD_WHY_FOOTPRINT, a sphere lies before the disc
 *            _UNSUPPORTED: triangles or a known region
 *            _WORK, _MEMORY
 *   Cost     as a row of ten directions */
int fibrad_light_empty(const fibrad_scene *scene, fibrad_work *work, const fibrad_light *light, fibrad_light_ends *ends,
                       fibrad_fault *fault);

/* The light that some spheres meet first. Several threads may ask for different spheres at the same time.
 *   Input    from, to: spheres from to to - 1, up to the number of spheres
 *   Output   power[to - from]: what each sphere takes, reflected or absorbed
 *            kept: `spheres` is the sum of them, the others are what they keep from walls and from leaving, and add up
 *            to it
 *   Errors   as fibrad_light_empty
 *   Cost     2 microseconds for each sphere and direction */
int fibrad_light_spheres(const fibrad_scene *scene, fibrad_work *work, const fibrad_light *light, uint32_t from,
                         uint32_t to, double *power, fibrad_light_ends *kept);

/* ---- light on patches --------------------------------------------------------------------------------------------
 * Light is of short wavelength, thermal radiation of long wavelength. A surface absorbs the two with different
 * emissivities, and light does not turn into light of another kind. So light has a solution of its own:
 *   1. fibrad_heat_shine for each task of each light, fibrad_heat_shine_walls for each light. They add to `hits`.
 *   2. fibrad_heat_begin with all temperatures 0, absorptivities in the place of emissivities, and `light` = hits. Its
 *      net powers are what is absorbed of the light. That of the surroundings is what is reflected.
 *   3. What a surface absorbs is added to its power in the solution of thermal radiation. fibrad_heat_keep_light leaves
 *      in `hits` what insulated walls absorb, and that solution has it as `light`. */

/* Number of patches of a heat problem.
 *   Errors   0 if heat is NULL */
uint32_t fibrad_heat_patches(const fibrad_heat *heat);

/* Number of tasks for fibrad_heat_shine.
 *   Errors   0 if heat is NULL */
uint32_t fibrad_heat_shine_tasks(const fibrad_heat *heat);

/* Adds the light that the spheres of a task meet first to their patches. Several threads may do different tasks at the
 * same time.
 *   Input    task: 0 to fibrad_heat_shine_tasks - 1
 *   Output   hits[fibrad_heat_patches]: added to
 *            kept: as fibrad_light_spheres
 *   Errors   as fibrad_light_spheres; _STATE: the scene has changed */
int fibrad_heat_shine(const fibrad_heat *heat, fibrad_work *work, const fibrad_light *light, uint32_t task,
                      double *hits, fibrad_light_ends *kept);

/* Adds to the patches of walls the light that ends on them. Which patches of a wall are lit is known from rays.
 *   Input    ends: of fibrad_light_empty, less `kept` of all tasks
 *   Output   hits[fibrad_heat_patches]: added to
 *   Errors   as fibrad_heat_shine */
int fibrad_heat_shine_walls(const fibrad_heat *heat, fibrad_work *work, const fibrad_light *light,
                            const fibrad_light_ends *ends, double *hits);

/* Sums the light on the patches of each sphere and wall.
 *   Input    hits[fibrad_heat_patches]
 *   Output   power[spheres], body_power[bodies]
 *   Errors   _ARGUMENT */
int fibrad_heat_sum_light(const fibrad_heat *heat, const double *hits, double *power, double *body_power);

/* Replaces hits by what patches of insulated walls absorb in the solution in hand. All others get 0.
 *   Input    insulated[bodies]: not 0: insulated
 *            hits[fibrad_heat_patches]: the `light` of the solution
 *   Errors   _ARGUMENT
 *            _STATE: there is no solution, or the scene has changed */
int fibrad_heat_keep_light(const fibrad_heat *heat, const unsigned char *insulated, double *hits);

#ifdef __cplusplus
}
#endif
#endif
