/* fibrad_heat.h - net radiative powers and temperatures of grey diffuse spheres and bodies.
 *
 * Each body has a given temperature, or gives off a given power and has the temperature that follows. Surfaces are cut
 * into patches; beams of points connect the patch they leave with the patch they meet, and serve both ways: at equal
 * temperatures nothing flows, and all powers add up to zero. The radiosities J = eps E + (1 - eps) H, E = sigma T^4,
 * follow by conjugate gradients, first on patches four times as large; what both give is extrapolated to patches
 * without size. Source: docs/heat.md.
 *
 * Typical   fibrad_heat_init; _trace every task; _begin; _sweep every part and _step until solved; _read.
 * Units, errors and memory as in fibrad.h; powers in sigma K^4 L^2, watts if L is the metre.
 *
 * SPDX-License-Identifier: MIT */
#ifndef FIBRAD_HEAT_H
#define FIBRAD_HEAT_H

#include "fibrad.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct fibrad_heat_config {
    uint32_t directions; /* [FIBRAD_DIRECTIONS_MIN, FIBRAD_DIRECTIONS_MAX] of the beams; 0: 168 */
    uint32_t points;     /* per direction: 64, 128 or 256; 0: 64 */
    uint32_t patches;    /* of a sphere: 24, 96 or 384; 0: 96 */
    uint32_t parts;      /* [1, 1024] of a sweep, for as many threads; last bits depend on it; 0: 8 */
    double cutoff;       /* 0: none; else, as with a known region, FIBRAD_E_UNSUPPORTED */
    uint32_t wall_rays;  /* from all walls and meshes at the least, up to 2^30; 0: 262144, 6 directions points, or 8
                          * for each patch of a wall, whichever is most */
} fibrad_heat_config;

typedef struct fibrad_heat fibrad_heat; /* beams, patches and radiosities of a scene */

/* Makes a heat problem in memory[size]. The scene stays as it is until fibrad_heat_move. config: NULL is all defaults.
 * Bytes: about spheres times (directions points + 60 patches + 6000), with room for what most beds take; a larger size
 * is all room for beams. Errors: _ARGUMENT, _SIZE, _UNSUPPORTED. */
size_t fibrad_heat_size(const fibrad_heat_config *config, const fibrad_scene *scene);
int fibrad_heat_init(fibrad_heat **heat, void *memory, size_t size, const fibrad_heat_config *config,
                     const fibrad_scene *scene);

/* Changes to another scene of as many spheres, the same kinds of bodies and the same triangles, each of its bodies, or
 * the same one rebuilt in place. All tasks are traced again; the next solution starts from the last one. Errors:
 * _ARGUMENT, _SIZE (walls have grown). */
int fibrad_heat_move(fibrad_heat *heat, const fibrad_scene *scene);

/* Tasks that the beams are divided into, one per sphere and some for the walls; parts of a sweep (NULL: 0). _trace: the
 * beams of a task [0, tasks), each task once, by several threads at once. Errors: _ARGUMENT, _WORK, _MEMORY (then call
 * again), _STATE, _BACK (work->triangle has a side that is seen and nobody's), _SIZE: spheres see so many others that
 * the room for beams is too small; give _init twice the size.
 * Cost: about 1 microsecond per direction of 64 points. */
uint32_t fibrad_heat_tasks(const fibrad_heat *heat);
uint32_t fibrad_heat_parts(const fibrad_heat *heat);
int fibrad_heat_trace(fibrad_heat *heat, fibrad_work *work, uint32_t task);

/* What radiates. Begin with fibrad_heat_sources_init, which zeroes all but sigma, FIBRAD_STEFAN_BOLTZMANN, and
 * surroundings, NaN, which is refused: set it. A body whose temperature is NaN, and whose power is not, has the one at
 * which it gives off power - hold sigma (T^4 - reference^4) from inside; hold is what a store of heat makes of a step
 * in time. Where a temperature is given, power is 0 or NaN, and hold and reference are not used. */
typedef struct fibrad_heat_sources {
    const double *temperature;      /* [spheres] 0 to 1e20; NaN: unknown */
    const double *emissivity;       /* [spheres] [0, 1]; 0: power 0, whatever the temperature */
    const double *power;            /* [spheres] up to 1e100 either way, > 0 gives off; NULL: none is unknown */
    const double *hold;             /* [spheres] [L^2] 0 to 1e60; NULL: 0 */
    const double *reference;        /* [spheres] 0 to 1e20, also where the search begins; NULL, NaN: none, hold is 0 */
    const double *body_temperature; /* [bodies] 0 to 1e20; NaN: unknown, of walls of finite area; NULL if no bodies */
    const double *body_emissivity;  /* [bodies] [0, 1]; NULL if there are none */
    const double *body_power;       /* [bodies] as power */
    const unsigned char *insulated; /* [bodies] not 0: sends back all that arrives, place by place; NULL: none */
    double surroundings;            /* temperature of what beams meet that escape; black */
    double sigma;                   /* emission is sigma T^4; 1e-30 to 1e30 */
    double tolerance;               /* residual at which to stop, relative to the differences of emission; 0: 1e-3, or
                                     * 1e-5 where a temperature is unknown and not held */
    uint32_t sweeps_max;            /* 0: 1000 */
    int uniform; /* 1: one radiosity per sphere and wall, no extrapolation; wrong but for emissivities near 1 */
    const double *side_temperature; /* [2 triangles] by the caller's numbers, fronts and backs in turn: 0 to 1e20, of
                                     * sides of bodies whose temperature is given; NaN: that of the body. NULL: none.
                                     * Sides that share a patch emit the mean of all */
} fibrad_heat_sources;
void fibrad_heat_sources_init(fibrad_heat_sources *sources);

/* Whether _begin would take these sources; fault (may be NULL): which sphere or wall it would not take, and why.
 * Errors: _ARGUMENT, _UNSUPPORTED (fault.why is FIBRAD_WHY_ENDLESS). */
int fibrad_heat_check(const fibrad_heat *heat, const fibrad_heat_sources *sources, fibrad_fault *fault);

/* A solution, which starts from the last one if there is one: _begin; then every part [0, parts) of a _sweep once, by
 * several threads at once, and _step, until *solved is 1 (done, or about sweeps_max sweeps made). Errors: _ARGUMENT
 * (also a power of emissivity 0), _UNSUPPORTED (unknown temperature of an endless wall), _STATE: a task is not traced,
 * a part swept twice or not at all; of _step also _UNSOLVABLE: all temperatures are unknown, nothing escapes, and the
 * powers do not add up to zero. If they do, the mean emission, by emissivity and area, is that of the surroundings.
 * Cost: about 2 ns per beam and sweep; temperatures of deep beds take some sweeps a layer. */
int fibrad_heat_begin(fibrad_heat *heat, const fibrad_heat_sources *sources);
int fibrad_heat_sweep(fibrad_heat *heat, uint32_t part);
int fibrad_heat_step(fibrad_heat *heat, int *solved);

/* The powers, positive where heat is gained (what a body gives off from inside is their negative), and temperatures,
 * those found and those given; NaN: of emissivity 0, or below zero. Of insulated bodies, and those whose sides have
 * temperatures, the mean of T^4 counts. The
 * arrays are the caller's; those that may be NULL are then not written. Errors: _ARGUMENT; _STATE: no solution;
 * _UNSOLVABLE, with all written: a power is drawn that only a temperature below zero would give. */
typedef struct fibrad_heat_result {
    double *power;                          /* [spheres] out */
    double *body_power;                     /* [bodies] out; NULL if there are none */
    double surroundings_power;              /* out */
    double *temperature, *body_temperature; /* [spheres], [bodies] out; may be NULL */
    double *power_error, *body_error;       /* [spheres], [bodies] out: estimated errors of powers; may be NULL */
    double *temperature_error, *body_temperature_error; /* likewise of temperatures, 0 of those given; may be NULL */
    double error_patches;  /* out: estimated error of the powers, root mean square over the spheres, from patches */
    double error_beams;    /* out: ... and from beams: take the root of the sum of squares of both */
    double residual;       /* out: that of the radiosities, as in `tolerance` */
    uint32_t sweeps;       /* out */
    double *body_absorbed; /* [bodies] out: what they take of what arrives, of endless walls near the bed; or NULL */
} fibrad_heat_result;
int fibrad_heat_read(const fibrad_heat *heat, fibrad_heat_result *result);

/* What sides of triangles gain per area, and their temperatures, [2 triangles] by the caller's numbers, fronts and
 * backs in turn: means over the patches of each, or of all that share a patch. NaN: the side is nobody's; fluxes, and
 * temperatures of insulated bodies, also where nothing reaches it. Where no plane or cylinder cuts a mesh, fluxes times
 * areas add up to the power of its body, to rounding. Either may be NULL. Errors: _ARGUMENT; _STATE: no solution.
 */
int fibrad_heat_read_sides(const fibrad_heat *heat, double *flux, double *temperature);

#ifdef __cplusplus
}
#endif
#endif
