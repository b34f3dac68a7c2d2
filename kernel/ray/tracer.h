/* tracer.h - rays from sphere to sphere. Each ray ends at the first sphere that it meets.
 * SPDX-License-Identifier: MIT
 *
 * A ray that leaves a sphere mostly meets one of the nearest spheres. So each sphere has a list of its near spheres
 * in the order of their clearance, which is the distance from its centre to their surface. A ray looks at them in
 * this order. It has found its first sphere when all later ones are farther away. Lists are kept in work memory. The
 * list of a sphere is in the slot `place modulo number of lists`. It is made again if another sphere has used the
 * slot. A list depends on its sphere alone. Rays that get beyond their list go through the grid.
 *
 * Rays that leave walls have lists, too. Each list belongs to a cube of space, a cell, in which such rays begin. It is
 * made when a few rays have begun there. */
#ifndef FIBRAD_RAY_TRACER_H
#define FIBRAD_RAY_TRACER_H

#include "base/lanes/laned.h"
#include "workspace/workspace.h"

#define FIBRAD_GROUP  16 /* spheres */
#define FIBRAD_GROUPS 6  /* of a list */
#define FIBRAD_NEARBY (FIBRAD_GROUPS * FIBRAD_GROUP)

/* Spheres that a ray is compared with at once. */
typedef struct fibrad_nearby_group {
    _Alignas(64) float x[FIBRAD_GROUP], y[FIBRAD_GROUP], z[FIBRAD_GROUP];
    float q[FIBRAD_GROUP]; /* a little less than distance of the centres^2 + 1 - r^2 */
    uint32_t sphere[FIBRAD_GROUP];
    int8_t periods[FIBRAD_GROUP][4]; /* periodic image, by axis */
} fibrad_nearby_group;

/* The spheres near one sphere, relative to its centre and in units of its radius; or near the ball about a cell. The
 * last group is filled up with spheres that no ray meets. */
typedef struct fibrad_nearby {
    fibrad_nearby_group group[FIBRAD_GROUPS];
    double clear[FIBRAD_GROUPS + 1]; /* a ray meets no sphere of this group, of later groups, or not listed, before this
                                        length; the last element: not listed */
    uint32_t groups;
    float behind; /* a bound of the rounding errors of depths in floats, negative: the least depth of spheres that are
                     not behind */
} fibrad_nearby;

/* A cell with the edge of the mean spacing. */
typedef struct fibrad_tracer_cell {
    double at[3];   /* its lower corner, in edges */
    uint32_t begun; /* rays that began there without a list; 0: the slot is empty */
    fibrad_nearby *list;
} fibrad_tracer_cell;

/* Scratch: spheres that may be listed, relative to the centre of the ball and in units of its radius. */
#define FIBRAD_CANDIDATES 512
typedef struct fibrad_candidates {
    double *x, *y, *z, *r, *clearance; /* [FIBRAD_CANDIDATES], as all arrays */
    float *fx, *fy, *fz, *fq;          /* as x, y, z, q of fibrad_nearby_group */
    uint32_t *sphere;
    int8_t (*periods)[4];
    uint16_t *order; /* numbers of candidates, by clearance */
    uint8_t *step;   /* the clearance of each in whole steps */
} fibrad_candidates;

typedef struct fibrad_tracer {
    const fibrad_scene *scene;
    uint32_t lists;           /* a power of two */
    uint32_t *owner;          /* [lists] place of the sphere that a list belongs to; FIBRAD_NONE: none */
    fibrad_nearby *nearby;    /* [lists] */
    uint32_t cells;           /* a power of two */
    fibrad_tracer_cell *cell; /* [cells] */
    fibrad_candidates candidates;
} fibrad_tracer;

/* Extra bytes of work memory for a tracer: with the fewest lists, and with the best number: that of the spheres, at
 * most FIBRAD_LISTS. */
#define FIBRAD_LISTS 4096u
size_t fibrad_tracer_least(void);
size_t fibrad_tracer_best(const fibrad_scene *scene);

/* The tracer in the extra bytes of work memory, with as many lists as there is room for. Lists of an earlier call
 * stay if the scene has the same contents. */
fibrad_tracer *fibrad_tracer_of(fibrad_workspace *space, const fibrad_scene *scene);

/* The first sphere or triangle that a ray meets. Parts of spheres behind a wall are not met. */
typedef struct fibrad_hit {
    uint32_t side;    /* of the mesh; FIBRAD_NO_SIDE: no triangle */
    uint32_t sphere;  /* its place; FIBRAD_NONE: no sphere. Then only `side` and the distance of a triangle follow */
    double distance;  /* [L] at least 0 */
    double centre[3]; /* [L] to the centre of the image met, from the sphere or point that the ray leaves */
    double normal[3]; /* outward normal of the sphere where the ray enters it */
} fibrad_hit;

/* The ball that a list belongs to. */
typedef struct fibrad_ball {
    double centre[3], radius; /* L */
    uint32_t place;           /* of the sphere that it is, or FIBRAD_NONE */
} fibrad_ball;

/* Makes the list of a ball. */
typedef void fibrad_nearby_function(const fibrad_tracer *tracer, const fibrad_ball *from, fibrad_nearby *list);
FIBRAD_DECLARE_VERSIONS(fibrad_nearby_function, fibrad_nearby_make);

/* The list of the sphere at `place`. It is made if it does not exist. */
const fibrad_nearby *fibrad_tracer_nearby(fibrad_tracer *tracer, uint32_t place);

/* Fetches the first group of the list of a sphere into the cache, for a ray that leaves the sphere soon. */
FIBRAD_INLINE void fibrad_tracer_expect(const fibrad_tracer *tracer, uint32_t place) {
    const fibrad_nearby *list = &tracer->nearby[place & (tracer->lists - 1)];
    __builtin_prefetch(list->group->x), __builtin_prefetch(list->group->y), __builtin_prefetch(list->group->z);
    __builtin_prefetch(list->group->q), __builtin_prefetch(list->group->sphere), __builtin_prefetch(list->clear);
}

/* The list of the cell in which a ray begins. NULL: hardly any ray has begun there so far. start: out: the point
 * relative to the middle of the cell, in radii of the ball about the cell. radius: out: [L]. */
const fibrad_nearby *fibrad_tracer_cell_of(fibrad_tracer *tracer, const double point[3], double start[3],
                                           double *radius);

/* Follows a ray from the sphere at `place`. It leaves at the point with outward normal n [unit vector] in direction
 * w [unit vector, n.w >= 0]. Spheres count as for beams: a sphere counts if its centre lies ahead of this one's and
 * the ray passes through its disc. A sphere that contains the origin is met at distance 0. Its `normal` is where the
 * line enters it behind the origin. tracer: NULL: there are no lists, and the ray goes through the grid alone. */
typedef void fibrad_trace_function(const fibrad_scene *scene, fibrad_tracer *tracer, uint32_t place, const double n[3],
                                   const double w[3], fibrad_hit *hit);
FIBRAD_DECLARE_VERSIONS(fibrad_trace_function, fibrad_trace);

/* Follows a ray from any point [L] in direction w. A sphere that contains the point is met at distance 0. except: a
 * triangle on which the point lies, which is not met; or FIBRAD_NO_SIDE. tracer: as for fibrad_trace. */
typedef void fibrad_trace_point_function(const fibrad_scene *scene, fibrad_tracer *tracer, const double point[3],
                                         const double w[3], uint32_t except, fibrad_hit *hit);
FIBRAD_DECLARE_VERSIONS(fibrad_trace_point_function, fibrad_trace_point);

#endif
