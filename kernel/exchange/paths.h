/* paths.h - paths of grey diffuse radiation from a sphere or a wall, reflection by reflection. SPDX-License-Identifier:
 * MIT
 *
 * A path carries what is left of a unit of emission. At every surface the part that the surface absorbs is put down,
 * and the rest goes on in a direction drawn by the cosine law. */
#ifndef FIBRAD_EXCHANGE_PATHS_H
#define FIBRAD_EXCHANGE_PATHS_H

#include "base/random.h"
#include "base/sobol.h"
#include "ray/tracer.h"
#include "work/work.h"

#define FIBRAD_DISPLACEMENT_PARTS 16

typedef struct fibrad_paths {
    fibrad_tracer *tracer;
    uint32_t place;            /* of the sphere they leave; FIBRAD_NONE: they leave a wall or a mesh, and are not cut */
    uint32_t from;             /* then: its slot */
    const fibrad_sobol *sobol; /* then: even points */
    double inverse;            /* 1/radius of the sphere */
    bool cut;                  /* whether they end beyond a cutoff or a known region */
    double cutoff;             /* from its centre, in its radii; infinity: none */
    const double *emissivity;  /* [spheres], in the caller's order; NULL: all are black */
    const double *wall_emissivity;  /* [FIBRAD_SLOTS] by slot */
    bool boxed;                     /* black paths from a side of a closed box */
    double behind[FIBRAD_CYLINDER]; /* out, then: what a sphere keeps from each wall; nothing is absorbed yet */
    fibrad_random stream;           /* all numbers of path k come from it and k */
    bool first;                     /* whether what the first surface absorbs counts */
    fibrad_entries *entries;        /* out: what each sphere absorbs, path k in part k mod 4; NULL: not asked for */
    double wall[FIBRAD_SLOTS];      /* out: what each wall absorbs */
    double escaped, beyond;         /* out: what leaves, for good or beyond cutoff or known region */
    double absorbed;                /* out: what all spheres absorb */
    double left;                    /* out: what paths carry that end among mirrors, after too many legs */
    double square[FIBRAD_DISPLACEMENT_PARTS]
                 [3]; /* out: sum over what spheres absorb times the squares of their centre's
 distance along each axis [L^2] from that of the sphere left, path k in part k mod that */
    uint64_t rays;    /* out: traced in all */
    uint32_t back;    /* out: a triangle that was seen from a side that is nobody's; UINT32_MAX: none; set it so */
} fibrad_paths;

/* The emissivities of walls and meshes by slot, from those of bodies (NULL: all are black); openings are black.
 * FIBRAD_E_ARGUMENT: one is not valid. */
static inline int fibrad_paths_emissivities(const fibrad_scene *scene, const double *of_body,
                                            double wall[FIBRAD_SLOTS]) {
    for (uint32_t slot = 0; slot < FIBRAD_SLOTS; slot++) wall[slot] = fibrad_is_opening(&scene->container, slot);
    for (uint32_t b = 0; b < scene->facts.bodies; b++) {
        const double emissivity = of_body != NULL ? of_body[b] : 1;
        if (!(emissivity >= 0 && emissivity <= 1)) return FIBRAD_E_ARGUMENT;
        wall[scene->slot[b]] = emissivity;
    }
    return FIBRAD_OK;
}

/* Adds paths [begin, end). */
typedef void fibrad_paths_function(fibrad_paths *paths, uint64_t begin, uint64_t end);
FIBRAD_DECLARE_VERSIONS(fibrad_paths_function, fibrad_paths_follow);

/* All that the paths have put down: as much as they began with, but for Russian roulette and what is left. */
double fibrad_paths_sum(const fibrad_paths *paths);

/* Adds paths [0, count). Returns how many: among mirrors fewer, by the rays that they take, and only a few where these
 * leave more than they put down. */
uint64_t fibrad_paths_begin(fibrad_paths *paths, uint64_t count);

#endif
