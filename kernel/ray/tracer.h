/* tracer.h - rays from sphere to sphere, each to the first sphere it meets. SPDX-License-Identifier: MIT
 *
 * A ray that leaves a sphere mostly meets one of its nearest neighbours. So each sphere's near ones are listed once, in
 * the order of their clearance, the distance from its centre to their surface; a ray looks at them in that order, and
 * has met its first sphere as soon as all further ones are beyond it. Lists are kept in work memory, each in
 * the slot of its sphere's place modulo their number, and made anew when another sphere has taken the slot. What a list
 * says depends on its sphere alone. Rays that get beyond their list go through the grid on their own. */
#ifndef FIBRAD_RAY_TRACER_H
#define FIBRAD_RAY_TRACER_H

#include "base/dispatch.h"
#include "base/lanes/laned.h"
#include "work/work.h"

#define FIBRAD_NEARBY 96 /* spheres of a list: whole groups */
#define FIBRAD_GROUP  16

/* The spheres near one, places relative to its centre and lengths in units of its radius. Gaps at the end are filled
 * with spheres that no ray meets. */
typedef struct fibrad_nearby {
    _Alignas(64) float x[FIBRAD_NEARBY], y[FIBRAD_NEARBY], z[FIBRAD_NEARBY];
    float q[FIBRAD_NEARBY]; /* a little less than centre distance^2 + 1 - r^2 */
    uint32_t sphere[FIBRAD_NEARBY];
    int8_t periods[FIBRAD_NEARBY][4];               /* which periodic image, per axis */
    double clear[FIBRAD_NEARBY / FIBRAD_GROUP + 1]; /* no ray meets a sphere of this or a later group, or one that is
                                                       not listed, before this length; the last one: not listed */
    uint32_t groups;
    float behind; /* depths in floats are right to this: minus it, of spheres that are not behind */
} fibrad_nearby;

typedef struct fibrad_tracer {
    const fibrad_scene *scene;
    uint32_t lists;        /* a power of two */
    uint32_t *owner;       /* [lists] the place of the sphere whose list is here; FIBRAD_NONE */
    fibrad_nearby *nearby; /* [lists] */
    uint64_t *key[2];      /* [] scratch: clearances and numbers of the spheres that may be listed */
    struct fibrad_candidate *candidate;
} fibrad_tracer;

/* Extra bytes of work memory for a tracer: of the fewest lists, and of as many as there are spheres, or FIBRAD_LISTS.
 */
#define FIBRAD_LISTS 4096u
size_t fibrad_tracer_least(void);
size_t fibrad_tracer_best(const fibrad_scene *scene);

/* The tracer in the extra bytes of work memory, with as many lists as there is room for. Lists of an earlier call are
 * kept if they were made for the same contents of a scene. */
fibrad_tracer *fibrad_tracer_of(fibrad_workspace *space, const fibrad_scene *scene);

/* The first sphere or triangle that a ray meets. What of a sphere lies behind a wall is not met. */
typedef struct fibrad_hit {
    uint32_t side;   /* of the mesh; FIBRAD_NO_SIDE: no triangle */
    uint32_t sphere; /* its place; FIBRAD_NONE: it meets none, and of what follows only a triangle's distance is told */
    double distance; /* [L] at least 0 */
    double centre[3]; /* [L] from where the ray is told from (sphere or point) to the centre of the image met */
    double normal[3]; /* of the sphere where the ray enters it, outwards */
} fibrad_hit;

/* The list of the sphere at `place`, made if it is not there. */
const fibrad_nearby *fibrad_tracer_nearby(fibrad_tracer *tracer, uint32_t place);

/* Follows the ray that leaves the sphere at `place` at its point of outward normal n [unit vector] in direction w [unit
 * vector, n.w >= 0]. Spheres count as for beams: those whose centre lies ahead of this one's and whose disc holds the
 * ray; one that holds its origin is met at distance 0, at the point where the ray, prolonged backwards, enters it. */
typedef void fibrad_trace_function(fibrad_tracer *tracer, uint32_t place, const double n[3], const double w[3],
                                   fibrad_hit *hit);
FIBRAD_DECLARE_VERSIONS(fibrad_trace_function, fibrad_trace);

/* The same without lists, by the grid alone. */
typedef void fibrad_trace_once_function(const fibrad_scene *scene, uint32_t place, const double n[3], const double w[3],
                                        fibrad_hit *hit);
FIBRAD_DECLARE_VERSIONS(fibrad_trace_once_function, fibrad_trace_once);

/* Follows the ray from any point [L] in direction w. A sphere that holds the point is met at distance 0; `except`, a
 * triangle on which it lies, or FIBRAD_NO_SIDE, is not met. */
typedef void fibrad_trace_point_function(const fibrad_scene *scene, const double point[3], const double w[3],
                                         uint32_t except, fibrad_hit *hit);
FIBRAD_DECLARE_VERSIONS(fibrad_trace_point_function, fibrad_trace_point);

#endif
