/* paths.h - paths of grey diffuse radiation from a sphere or a wall, reflection by reflection. SPDX-License-Identifier:
 * MIT
 *
 * A path carries a weight, 1 at first. Every surface that the path meets absorbs a fraction of the weight. The path
 * goes on with the remaining weight, in a random direction by the cosine law. From a sphere that conducts the path goes
 * on either where it arrived, or from the point to which the sphere has conducted it. */
#ifndef FIBRAD_EXCHANGE_PATHS_H
#define FIBRAD_EXCHANGE_PATHS_H

#include "base/random.h"
#include "base/sobol.h"
#include "ray/tracer.h"
#include "work/work.h"

#define FIBRAD_DISPLACEMENT_PARTS 16

typedef struct fibrad_paths {
    fibrad_tracer *tracer;
    uint32_t place; /* position of the sphere that paths leave; FIBRAD_NONE: they leave a wall, without a cutoff */
    uint32_t from;  /* paths from a wall: its slot */
    const fibrad_legs *legs;        /* NULL, or the first legs of the first paths */
    const fibrad_sobol *sobol;      /* paths from a wall: even points */
    double inverse;                 /* 1/L, of the radius of the sphere */
    bool cut;                       /* whether there is a cutoff or a known region */
    double cutoff;                  /* from the centre of the sphere, in its radii; infinity: none */
    const double *emissivity;       /* [spheres], by the caller's index: what is absorbed; NULL: all are black */
    const double *conductivity;     /* [spheres], relative, by the caller's index; NULL: one temperature a sphere */
    const double *surface;          /* [spheres], then: emissivities of the surfaces; emissivity: those of nodes */
    uint32_t flights;               /* above 0: a walk, see below */
    const double *wall_emissivity;  /* [FIBRAD_SLOTS], by slot */
    bool boxed;                     /* paths from a side of a closed box, where all is black */
    double behind[FIBRAD_CYLINDER]; /* out, if boxed: weight that spheres keep from each wall */
    fibrad_random stream;           /* all random numbers of path k follow from stream and k */
    bool first;                     /* whether absorption by the first surface counts */
    fibrad_entries *entries;        /* out: absorbed by each sphere, path k in part k mod 4; NULL: not wanted */
    double wall[FIBRAD_SLOTS];      /* out: absorbed by each wall */
    double escaped, beyond;         /* out: to the surroundings; beyond the cutoff or the known region */
    double absorbed;                /* out: absorbed by all spheres */
    double left;                    /* out: weight of paths that end among mirrors, after too many legs */
    /* L^2, out: sum over absorption by spheres times the squared displacement along each axis, path k in part k mod
     * FIBRAD_DISPLACEMENT_PARTS. The displacement is between the centres of the two spheres. */
    double square[FIBRAD_DISPLACEMENT_PARTS][3];
    double origins; /* out, of a walk: flights that have been correlated */
    double lost;    /* out, of a walk: paths that have left the bed */
    uint64_t rays;  /* out: rays traced */
    uint32_t back;  /* out: a triangle seen from a side that belongs to no wall; set it to UINT32_MAX, none */
} fibrad_paths;

/* Emissivities by slot from those by wall. NULL: all walls are black. Openings are black. Errors: FIBRAD_E_ARGUMENT. */
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

/* Whether emissivities of nodes come with what they follow from. */
static inline bool fibrad_nodes_given(const fibrad_exchange_rule *rule) {
    return rule->node_emissivity == NULL || (rule->emissivity != NULL && rule->conductivity != NULL);
}

/* Follows paths begin to end - 1, and adds to the sums.
 *
 * In a walk no path ends. A path is at its start as if it had just arrived there. At each sphere it is reflected, or it
 * is absorbed and given off at another point. One step is the way from one arrival to the next. There are 2 n steps, n
 * being `flights`. To square[][axis] each of the first n adds its length along the axis times (its length + twice those
 * of the next n - 1 steps + that of the step after these). */
typedef void fibrad_paths_function(fibrad_paths *paths, uint64_t begin, uint64_t end);
FIBRAD_DECLARE_VERSIONS(fibrad_paths_function, fibrad_paths_follow);

/* The sum of all that was absorbed, escaped or is beyond. This is the number of paths, but for Russian roulette and
 * `left`. */
double fibrad_paths_sum(const fibrad_paths *paths);

/* Follows the first `count` paths and adds to the sums. Returns the number of paths followed. Among mirrors, where
 * paths take many rays, they are fewer. They are very few where paths end with most of their weight. */
uint64_t fibrad_paths_begin(fibrad_paths *paths, uint64_t count);

#endif
