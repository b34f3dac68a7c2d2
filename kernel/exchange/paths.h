/* paths.h - paths of grey diffuse radiation from a sphere or a wall. SPDX-License-Identifier: MIT
 *
 * A path carries a weight, 1 at first. Every surface that the path meets absorbs a fraction of the weight. The path
 * goes on with the remaining weight, in a random direction by the cosine law. On a sphere that conducts, the path goes
 * on from the point where it arrived, or from a point to which heat is conducted. */
#ifndef FIBRAD_EXCHANGE_PATHS_H
#define FIBRAD_EXCHANGE_PATHS_H

#include "base/random.h"
#include "base/sobol.h"
#include "ray/tracer.h"
#include "workspace/workspace.h"

#define FIBRAD_DISPLACEMENT_PARTS 16

typedef struct fibrad_paths {
    fibrad_tracer *tracer;
    uint32_t place; /* position of the sphere that paths leave; FIBRAD_NONE: paths leave a wall, without a cutoff */
    uint32_t from;  /* slot of the wall that paths leave */
    fibrad_segments *segments;       /* NULL, or the first segments of the first paths */
    const fibrad_sobol *sobol;       /* evenly spread points, of paths from a wall */
    double inverse;                  /* 1/L, of the radius of the sphere */
    bool cut;                        /* whether there is a cutoff */
    double cutoff;                   /* from the centre of the sphere, in its radii; infinity: none */
    const double *emissivity;        /* [spheres], by the caller's index: fraction absorbed; NULL: all are black */
    const double *conductivity;      /* [spheres], relative, by the caller's index; NULL: one temperature a sphere */
    const double *surface;           /* [spheres], emissivities of surfaces; with conductivity, `emissivity` has those
                                        of nodes */
    uint32_t flights;                /* above 0: paths are walks, see fibrad_paths_function */
    const double *wall_emissivity;   /* [FIBRAD_SLOTS], by slot */
    bool boxed;                      /* paths leave a side of a closed box, and all surfaces are black */
    double behind[FIBRAD_CYLINDER];  /* out, if boxed: weight on the way to each wall that spheres stop */
    fibrad_random stream;            /* all random numbers of path k follow from stream and k */
    bool first;                      /* whether absorption by the first surface counts */
    fibrad_entries *entries;         /* out: absorbed by each sphere, path k in part k mod 4; NULL: not counted */
    double wall[FIBRAD_SLOTS];       /* out: absorbed by each wall */
    double escaped, beyond;          /* out: to the surroundings; beyond the cutoff */
    double end[FIBRAD_SLOTS + 2][4]; /* out: wall, escaped and beyond, path k in part k mod 4 */
    double absorbed;                 /* out: absorbed by all spheres */
    uint64_t *reflected;             /* [spheres], by the caller's index, added to: absorbed after a reflection, in
                                        paths * 2^40; NULL: not counted */
    bool undo;                       /* subtract from `reflected` what these paths have added */
    double left;                     /* out: weight of paths that are broken off after too many segments */
    /* L^2, out: sum over absorption by spheres times the squared displacement along each axis, path k in part k mod
     * FIBRAD_DISPLACEMENT_PARTS; only without entries. The displacement is between the centres of the two spheres. */
    double square[FIBRAD_DISPLACEMENT_PARTS][3];
    double origins; /* out, of walks: flights that were correlated with those after them */
    double lost;    /* out, of walks: paths that left the bed */
    uint64_t rays;  /* out: rays traced */
    uint32_t back;  /* in: UINT32_MAX; out: a triangle that a path met on a side that belongs to no wall */
} fibrad_paths;

/* Sets emissivities by slot from those by wall. of_wall: NULL: all walls are black. Openings are black. Errors:
 * FIBRAD_E_ARGUMENT. */
static inline int fibrad_paths_emissivities(const fibrad_scene *scene, const double *of_wall,
                                            double wall[FIBRAD_SLOTS]) {
    for (uint32_t slot = 0; slot < FIBRAD_SLOTS; slot++) wall[slot] = fibrad_is_opening(&scene->container, slot);
    for (uint32_t b = 0; b < scene->facts.walls; b++) {
        const double emissivity = of_wall != NULL ? of_wall[b] : 1;
        if (!(emissivity >= 0 && emissivity <= 1)) return FIBRAD_E_ARGUMENT;
        wall[scene->slot[b]] = emissivity;
    }
    return FIBRAD_OK;
}

/* Follows the first segments to where they arrive, and chooses those from which paths go on. A segment is chosen in
 * proportion to what the surface reflects where it arrives. So all paths go on with equal weights. Nothing counts as
 * absorbed. */
typedef void fibrad_paths_arrive_function(fibrad_paths *paths);
FIBRAD_DECLARE_VERSIONS(fibrad_paths_arrive_function, fibrad_paths_arrive);

/* Follows paths begin to end - 1, and adds to the sums.
 *
 * Walks: a path loses no weight. At its start it counts as having just arrived. At each sphere it is reflected, or it
 * is absorbed and given off at another point. A flight is the way from one arrival to the next. A walk has 2 n flights,
 * n being `flights`. Let d_k be the length of flight k along an axis. Each flight k of the first n adds
 * d_k (d_k + 2 (d_k+1 + ... + d_k+n-1) + d_k+n) to square[][axis]. */
typedef void fibrad_paths_function(fibrad_paths *paths, uint64_t begin, uint64_t end);
FIBRAD_DECLARE_VERSIONS(fibrad_paths_function, fibrad_paths_follow);

/* The sum of all that was absorbed, escaped or is beyond. Without Russian roulette and `left` this would be the number
 * of paths. */
double fibrad_paths_sum(const fibrad_paths *paths);

/* Follows the first `count` paths and adds to the sums. Returns the number of paths followed. The number is smaller
 * among mirrors, where a path takes many rays. The number is very small if most of the weight is left when paths are
 * broken off. */
uint64_t fibrad_paths_begin(fibrad_paths *paths, uint64_t count);

#endif
