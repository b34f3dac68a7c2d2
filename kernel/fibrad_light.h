/* fibrad_light.h - light from outside that falls on a bed: sun or lasers.
 *
 * Light of one direction is a bundle of parallel rays. The rays come from outside and enter through the open faces of
 * the container. Each ray ends on the first sphere or wall that it meets. Seen along the light, a sphere is a disc.
 * Other spheres and walls may hide parts of this disc. The sphere takes the light on the part that is not hidden. The
 * areas of these parts are exact.
 *
 * Sequence   1. fibrad_light_empty finds how much light would end on each wall, and how much would leave the bed, if
 *               there were neither spheres nor triangles.
 *            2. fibrad_heat_shine finds how much light the spheres of a task take, and puts it on their patches.
 *               fibrad_heat_sum_light sums it up by sphere.
 * Walls      Step 2 also gives `kept`: where the light that spheres take would end if there were neither spheres nor
 *            triangles. So the light that ends on wall b is ends.wall[b] of step 1 minus the sum of kept.wall[b] over
 *            all tasks. The light that leaves the bed is ends.through minus the sum of kept.through.
 * Triangles  They take a part of the light on other walls, and of the light that leaves. fibrad_heat_shine_walls finds
 *            these parts.
 * Units      as in fibrad.h. A power is in units of flux times L^2. With a flux of 1 it is an area.
 * Words      Memory, errors and the layout of comments are as in fibrad.h.
 * Source     docs/methods.md section 29. docs/heat.md says what is assumed.
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
    FIBRAD_LIGHT_ALL =
        0, /* all light through open faces; without walls and periods: all that meets the box of the spheres */
    FIBRAD_LIGHT_DISC = 1, /* light that passes a disc at right angles to `direction`; fibrad_light.centre, radius */
    FIBRAD_LIGHT_BOX = 2   /* light that passes a rectangle at the lit end of the bed in z; fibrad_light.low, high */
} fibrad_light_shape;

/* Light from outside. If all fields but direction and flux are zero, the light is parallel and enters through all
 * open faces.
 *
 * Light with a half-angle has directions that fill a cone evenly: its radiance is the same in all of them. Its flux is
 * what a plane at right angles to `direction` receives. The sun's half-angle is FIBRAD_SUN_HALF_ANGLE.
 *
 * The box of the spheres is the box of their centres, wider by the largest radius on all sides. It also holds the
 * corners of triangles, but it ends at planes and periods. On periodic axes a disc or rectangle is repeated, and must
 * not be wider than a period. The light of a disc must not meet a sphere before it passes the disc. */
typedef struct fibrad_light {
    double direction[3];    /* the way that the light goes, of any length above 0 */
    double flux;            /* sigma K^4 (W/m2 if sigma is in W/(m2 K4)), across `direction`; to FIBRAD_POWER_MAX */
    double half_angle;      /* rad, of the cone, 0 to FIBRAD_HALF_ANGLE_MAX; 0: parallel */
    uint32_t directions;    /* of the cone, up to FIBRAD_LIGHT_DIRECTIONS_MAX; 0: FIBRAD_LIGHT_DIRECTIONS_DEFAULT, more
                               for cones wider than 0.02 rad */
    int shape;              /* a fibrad_light_shape */
    double centre[3];       /* L, of the disc */
    double radius;          /* L, of the disc, above 0 */
    double low[2], high[2]; /* L, x and y of the rectangle, low below high */
} fibrad_light;

/* Where light ends. */
typedef struct fibrad_light_ends {
    double spheres;                /* on spheres */
    double through;                /* leaves without having met anything */
    double wall[FIBRAD_WALLS_MAX]; /* on each wall */
} fibrad_light_ends;

/* Where light ends if there are neither spheres nor triangles.
 *   Output   ends: `spheres` is 0. The others add up to the power of the light.
 *            fault: which sphere is at fault, and why; may be NULL
 *   Errors   _ARGUMENT: fault.why is the cause
 *              FIBRAD_WHY_LIGHT: a number is out of range
 *              FIBRAD_WHY_DARK: no open face lets the light in
 *              FIBRAD_WHY_FOOTPRINT: the light meets a sphere before the disc
 *            _UNSUPPORTED: the scene has clumps; fault.why is FIBRAD_WHY_CLUMP_LIGHT
 *            _WORK, _MEMORY
 *   Cost     as fibrad_beam_row with ten directions */
int fibrad_light_empty(const fibrad_scene *scene, fibrad_work *work, const fibrad_light *light, fibrad_light_ends *ends,
                       fibrad_fault *fault);

/* ---- light on patches --------------------------------------------------------------------------------------------
 * A surface absorbs light and thermal radiation with different absorptivities. Reflected light stays light. So light
 * has a solution of its own:
 *   1. For each light, with a zeroed array `hits`: call fibrad_heat_shine for each task. Call fibrad_heat_scatter for
 *      each of its tasks, then fibrad_heat_shine_walls. `hits` then holds the light that comes straight from outside.
 *      Call fibrad_heat_reflect. It adds to `light` and `spots`.
 *   2. Call fibrad_heat_begin with all temperatures 0, absorptivities in the place of emissivities, and `light`. The
 *      net powers of this solution, and absorptivities times `spots`, are the light that is absorbed. The net power of
 *      the surroundings is the light that is reflected.
 *   3. Call fibrad_heat_keep_light. `spots` then holds the light that patches absorb.
 *   4. Call fibrad_heat_begin for thermal radiation, with `absorbed` = spots. To each given power, add the light that
 *      the surface absorbs. Insulated walls have no given power: `absorbed` is enough for them.
 *
 * Light that falls on a part of a patch is reflected from where it falls: rays carry it to the patch where it arrives
 * next. From there on, patches reflect it, or rays if many arrive there. Where rays are few, patches that are lit
 * wholly reflect without rays. */

/* Number of patches of a heat problem.
 *   Errors   0 if heat is NULL */
uint32_t fibrad_heat_patches(const fibrad_heat *heat);

/* Number of tasks for fibrad_heat_shine.
 *   Errors   0 if heat is NULL */
uint32_t fibrad_heat_shine_tasks(const fibrad_heat *heat);

/* The light that comes straight from outside, on the patches of the spheres of one task. Several threads may do
 * different tasks at the same time.
 *   Input    task: 0 to fibrad_heat_shine_tasks - 1
 *   Output   hits[fibrad_heat_patches]: the light is added to it
 *            kept: `spheres` is the light that the spheres of the task take, absorbed or not. `wall` and `through` are
 *            where this light would end if there were neither spheres nor triangles. They add up to `spheres`.
 *            apart[spheres]: light of even directions of a cone minus that of odd ones, for the spheres of the task
 *            alone; may be NULL
 *   Errors   as fibrad_light_empty; _STATE: the scene has changed
 *   Cost     2 microseconds for each sphere and direction; work memory has 8 bytes for each patch of the task */
int fibrad_heat_shine(const fibrad_heat *heat, fibrad_work *work, const fibrad_light *light, uint32_t task,
                      double *hits, fibrad_light_ends *kept, double *apart);

/* Hits of a ray: where it comes from outside, and after up to five reflections. */
#define FIBRAD_LIGHT_HITS 6

/* A ray of light: the patches that it meets one after another, as far as it is followed. UINT32_MAX: no more. Light is
 * followed beyond its first reflection if its cross-section is at most four discs of the largest sphere. */
typedef struct fibrad_light_ray {
    uint32_t patch[FIBRAD_LIGHT_HITS];
    uint32_t slot; /* where it would end if there were neither spheres nor triangles; a number inside the kernel */
} fibrad_light_ray;

/* Number of rays for a light. If each sphere has b beams (directions times points), there are 12 b rays, and b/16 more
 * for each sphere in the light, but 131,072 at least and 2^24 at most.
 *   Input    hits[fibrad_heat_patches]: of fibrad_heat_shine
 *   Errors   0 if an argument is NULL */
uint32_t fibrad_heat_light_rays(const fibrad_heat *heat, const double *hits);

/* Number of tasks for fibrad_heat_scatter. They cover any number of rays. */
uint32_t fibrad_heat_scatter_tasks(uint32_t rays);

/* Follows the rays of one task. Several threads may do different tasks at the same time.
 *   Input    rays: of fibrad_heat_light_rays
 *            task: 0 to fibrad_heat_scatter_tasks - 1
 *   Output   ray[rays]: those of the task are written
 *   Errors   as fibrad_heat_shine; _BACK: work->triangle is written
 *   Cost     2 microseconds for each ray, up to 6 in narrow light */
int fibrad_heat_scatter(const fibrad_heat *heat, fibrad_work *work, const fibrad_light *light, uint32_t rays,
                        uint32_t task, fibrad_light_ray *ray);

/* The light that comes straight from outside, on the patches of walls. Rays find which patches of a wall are lit,
 * and which part of the light ends on triangles.
 *   Input    ray[rays]: of fibrad_heat_scatter
 *            ends: the `ends` of fibrad_light_empty minus the sum of `kept` over all tasks, field by field
 *   Output   hits[fibrad_heat_patches]: the light is added to it
 *            ends: triangles have taken their part from other walls and from `through`
 *   Errors   _ARGUMENT: also if a ray names a patch or a slot that there is not; _STATE, _WORK, _MEMORY */
int fibrad_heat_shine_walls(const fibrad_heat *heat, fibrad_work *work, const fibrad_light_ray *ray, uint32_t rays,
                            fibrad_light_ends *ends, double *hits);

/* Light on its way through a bed. All arrays but `first` are added to. */
typedef struct fibrad_light_hits {
    const double *first; /* [patches], of fibrad_heat_shine and fibrad_heat_shine_walls */
    double *light;       /* [patches], out: what patches reflect; takes the place of fibrad_heat_sources.light */
    double *spots;       /* [patches], out: light that rays have brought and reflected */
    double *squares;     /* [spheres + walls + 2], out: sums of squared powers of rays that arrive on spheres, walls and
                            outside; last: of squared powers of beams that leave the patches where rays have arrived */
} fibrad_light_hits;

/* Carries light that falls on parts of patches to where it arrives next.
 *   Input    absorptivity[spheres], wall_absorptivity[walls]: of the light
 *   Errors   as fibrad_heat_shine_walls */
int fibrad_heat_reflect(const fibrad_heat *heat, fibrad_work *work, const fibrad_light *light,
                        const fibrad_light_ray *ray, uint32_t rays, const double *absorptivity,
                        const double *wall_absorptivity, const fibrad_light_hits *hits);

/* Sums the light on the patches of each sphere and wall.
 *   Input    hits[fibrad_heat_patches]
 *   Output   power[spheres], wall_power[walls]
 *   Errors   _ARGUMENT */
int fibrad_heat_sum_light(const fibrad_heat *heat, const double *hits, double *power, double *wall_power);

/* Replaces `spots` by the light that patches of spheres and walls absorb: of the spots, and in the present solution.
 *   Input    spots[fibrad_heat_patches]: of fibrad_heat_reflect; zeros, if the solution has all first hits as its light
 *   Errors   _ARGUMENT
 *            _STATE: there is no solution, or the scene has changed */
int fibrad_heat_keep_light(const fibrad_heat *heat, double *spots);

#ifdef __cplusplus
}
#endif
#endif
