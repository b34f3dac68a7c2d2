/* paths.h - paths of grey diffuse radiation from a sphere or a wall. SPDX-License-Identifier: MIT
 *
 * A path carries a weight, 1 at first. Every surface that the path meets absorbs a fraction of the weight. The path
 * goes on with the remaining weight, in a random direction by the cosine law. On a sphere that conducts, the path goes
 * on from the point where it arrived, or from a point to which heat is conducted. */
#ifndef FIBRAD_EXCHANGE_PATHS_H
#define FIBRAD_EXCHANGE_PATHS_H

#include "base/elementary.h"
#include "base/sobol.h"
#include "ray/tracer.h"

/* ---- where a ball that conducts gives off what it absorbs at a point --------------------------------------------- */

/* The ball is steady inside, and its net power is 0. Let e be its emissivity, k* its relative conductivity and
 * a = e/(2 k*). Of what the ball absorbs in a pattern of degree l (spherical harmonics) it gives off a/(a + l) in the
 * same pattern: docs/methods.md section 26. What is absorbed at one point is given off elsewhere. At the angle g from
 * that point its density is
 *
 *     K(g) = integral over t from 0 to 1 of a t^(a-1) P_t(g),   P_t(g) = (1 - t^2)/(4 pi (1 + t^2 - 2 t cos g)^(3/2)).
 *
 * Let U be an even random number in [0, 1]. Then t = U^(1/a) has the density a t^(a-1). P_t is Poisson's kernel, whose
 * integral has an inverse in closed form.
 *
 * P_t is least opposite the point: 4 pi P_t >= (1 - t)/(1 + t)^2. Let m be the mean of this least value over t. Then
 * K = m/(4 pi) + (1 - m) K'. In K' the density of t is in proportion to t^a (3 + t)/(1 + t)^2. Let the point of
 * absorption be (0, 0, 1), and let (1 + t) s be the distance between (0, 0, t) and the point where heat is given off.
 * An even random number U gives s:
 *
 *     (1 - s)^2 (2 + s)/s = 4 t^2 (3 + t) U/((1 + t)^2 (1 - t)). */

/* Below the first value of t all points are equally likely. Above the second the heat stays where it was absorbed. */
#define FIBRAD_REEMITTED_ANYWHERE 1e-9
#define FIBRAD_REEMITTED_NOWHERE  (1 - 1e-12)

/* Random numbers that fibrad_reemit_above may use. They do not suffice once in 10^11 times. */
#define FIBRAD_REEMITTED_DRAWS 127

/* Turns the unit vector n by the angle whose cosine is 1 - x, in the plane of n and of `even`, a random unit vector. */
static inline void fibrad_turn_by(double x, const double even[3], double n[3]) {
    const double along = even[0] * n[0] + even[1] * n[1] + even[2] * n[2];
    const double across[3] = {even[0] - along * n[0], even[1] - along * n[1], even[2] - along * n[2]};
    const double square = across[0] * across[0] + across[1] * across[1] + across[2] * across[2];
    if (square < 1e-24) return;
    const double sine = fibrad_sqrt(fibrad_max(0, x * (2 - x)) / square);
    for (int axis = 0; axis < 3; axis++) n[axis] = (1 - x) * n[axis] + sine * across[axis];
}

/* Turns n, in the plane of n and `even`, to a point of the unit sphere at a given distance from t n. */
static inline void fibrad_turn_to(double distance, double t, const double even[3], double n[3]) {
    const double x = (distance - (1 - t)) * (distance + (1 - t)) / (2 * t);
    fibrad_turn_by(fibrad_min(fibrad_max(x, 0), 2), even, n);
}

/* Moves n from the outward normal where a ball absorbs to the normal where the ball gives the absorbed heat off.
 * exponent: 1/a. If it is infinite, all points are equally likely. u: two even random numbers in [0, 1). even: a random
 * point of the unit sphere. */
static inline void fibrad_reemit(double exponent, const double u[2], const double even[3], double n[3]) {
    const double t = u[0] > 0 ? fibrad_exp(fibrad_max(-800, exponent * fibrad_log(1 - u[0]))) : 1;
    if (t > FIBRAD_REEMITTED_NOWHERE) return;
    if (t < FIBRAD_REEMITTED_ANYWHERE) {
        for (int axis = 0; axis < 3; axis++) n[axis] = even[axis];
        return;
    }
    const double rho = 1 / (1 + t) + 2 * t * u[1] / ((1 - t) * (1 + t));
    fibrad_turn_to(1 / rho, t, even, n);
}

/* Draws t by the density that it has in K'. At least a third of all trials succeed. */
static inline double fibrad_reemitted_depth(double a, fibrad_random random, uint64_t first) {
    double t = 1;
    for (uint64_t k = first; k < first + FIBRAD_REEMITTED_DRAWS - 1; k += 2) {
        const double u = 1 - fibrad_fraction(fibrad_random_ahead(random, k));
        t = fibrad_exp(fibrad_max(-800, fibrad_log(u) / (a + 1)));
        if (3 * (1 + t) * (1 + t) * fibrad_fraction(fibrad_random_ahead(random, k + 1)) < 3 + t) break;
    }
    return t;
}

/* Does what fibrad_reemit does, for K' instead of K. a: e/(2 k*). The function uses the random numbers from `first` to
 * first + FIBRAD_REEMITTED_DRAWS - 1. The equation for s has the form s^3 - p s + 2 = 0. Its root between 0 and 1 is 2
 * sqrt(p/3) sin(q/3) with sin q = (3/p)^(3/2). */
static inline void fibrad_reemit_above(double a, fibrad_random random, uint64_t first, const double even[3],
                                       double n[3]) {
    const double t = fibrad_max(FIBRAD_REEMITTED_ANYWHERE, fibrad_reemitted_depth(a, random, first));
    const double u = fibrad_fraction(fibrad_random_ahead(random, first + FIBRAD_REEMITTED_DRAWS - 1));
    if (t > FIBRAD_REEMITTED_NOWHERE) return;
    const double more = 4 * t * t * (3 + t) * u / ((1 + t) * (1 + t) * (1 - t)), p = 3 + more;
    const double angle =
        fibrad_quarter_angle(fibrad_sqrt(more * (p * p + 3 * p + 9)), 5.196152422706632); /* 27^(1/2) */
    double sine, cosine;
    fibrad_sincos_turn(angle / (6 * FIBRAD_PI), &sine, &cosine);
    fibrad_turn_to(2 * fibrad_sqrt(p / 3) * sine * (1 + t), t, even, n);
}

/* m, the even part of K, 0 to 1. a: e/(2 k*). */
double fibrad_reemitted_evenly(double a);

/* ---- paths of grey diffuse radiation from a sphere or a wall ----------------------------------------------------- */

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
