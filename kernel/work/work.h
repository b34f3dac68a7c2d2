/* work.h - the inside of the work memory of one thread: near spheres, and the row in hand.
 * SPDX-License-Identifier: MIT
 *
 * All lengths in here are in units of the radius of sphere i, whose row it is, and all places relative to its centre.
 */
#ifndef FIBRAD_WORK_WORK_H
#define FIBRAD_WORK_WORK_H

#include "work/row_sum.h"
#include "sky/wall_sum.h"
#include "scene/surroundings.h"
#include "window/areas.h"
#include "window/discs.h"
#include "window/points.h"

#define FIBRAD_SHELLS 8
/* Near spheres in shells by their minimum depth: the least depth at which a sphere can come before a window, in any
 * direction, e = sqrt(d^2 - (1 + r)^2), d being its centre distance. It does come before the window of direction w just
 * if w.c > e. All spheres with e <= limit[s] are in shells 0 ... s, so that what a window meets down to that depth is
 * known after s + 1 shells. Each shell begins on a whole vector; the gaps are filled with points at the centre, which
 * never lie ahead. */
/* Spheres of the first shell that may come before windows of some directions: for culls, as in fibrad_near. */
typedef struct fibrad_sight {
    float *x, *y, *z, *e; /* [capacity] */
    uint32_t *near;       /* [same] places in the near list */
    uint32_t count;       /* whole vectors */
} fibrad_sight;

typedef struct fibrad_near {
    float *fx, *fy, *fz, *fe; /* [capacity] centre and, a little less than, e: for the first cull, ... */
    float *fq;                /* ... and, a little less than, d^2 + 1 - r^2: for that of rays */
    double *x, *y, *z, *r;    /* [capacity] */
    /* Place capacity + k is for disc k of a window that has found it in the grid. */
    uint32_t *sphere; /* [capacity + discs + FIBRAD_LANES_MAX] place in the scene */
    uint32_t *entry;  /* [same] its entry in the row; FIBRAD_NONE: not seen so far */
    uint32_t capacity, shells;
    uint32_t end[FIBRAD_SHELLS]; /* where each shell ends */
    double limit[FIBRAD_SHELLS]; /* down to which depth windows are known with it */
    bool full;                   /* no room for a further shell: windows walk the grid instead */
    fibrad_sight octant[8];      /* of directions: bit 0, 1, 2 of its number where x, y, z are negative */
    fibrad_sight all;            /* of all directions; its arrays go on with further shells */
    const fibrad_sight *seen[8]; /* from each octant: its own, if that has room for all; NULL: not listed so far */
    uint32_t sights;             /* capacity of each octant's */
    uint32_t asked;              /* how many windows have asked for one more than there are */
} fibrad_near;

/* Some of the triangles that may come before a window, in its frame. Seen along it their corners go round to the left.
 */
#define FIBRAD_FACES      32u
#define FIBRAD_FACES_ROOM (FIBRAD_FACES + FIBRAD_LANES_MAX)
typedef struct fibrad_faces {
    double corner[3][3][FIBRAD_FACES_ROOM];                 /* of each corner u, v and depth */
    double low[FIBRAD_FACES_ROOM], high[FIBRAD_FACES_ROOM]; /* depths */
    double plane[3][FIBRAD_FACES_ROOM];                     /* depth is u plane[0] + v plane[1] + plane[2] */
    double middle[FIBRAD_FACES_ROOM];                       /* about the depth of that in the middle of the window */
    double edge[3][3][FIBRAD_FACES_ROOM];                   /* u edge[k][0] + v edge[k][1] + edge[k][2] >= 0 inside */
    double side[FIBRAD_FACES_ROOM];                         /* of the mesh, that is seen */
    uint32_t triangle[FIBRAD_FACES_ROOM];                   /* place in the mesh */
    uint32_t count;
} fibrad_faces;

/* Lines of a window that look for triangles, one for a point, so ordered that eight by eight they are near each other
 * at one depth. The last eight are filled up with lines that meet nothing. */
#define FIBRAD_MET_POINTS  256
#define FIBRAD_LINE_BLOCK  8
#define FIBRAD_LINE_BLOCKS (FIBRAD_MET_POINTS / FIBRAD_LINE_BLOCK)
#define FIBRAD_PAIRS       64u
#define FIBRAD_PAIRS_ROOM  (FIBRAD_PAIRS + FIBRAD_LINE_BLOCKS + FIBRAD_LANES_MAX)
typedef struct fibrad_lines {
    _Alignas(64) double place[2][FIBRAD_MET_POINTS]; /* u, v where they leave sphere i, ... */
    double exit[FIBRAD_MET_POINTS];                  /* ... and how deep that is */
    double aside[2][FIBRAD_MET_POINTS];              /* of their directions, along u and v; 0 unless spread */
    double depth[FIBRAD_MET_POINTS];                 /* of what they meet, or beyond which they do not look */
    double side[FIBRAD_MET_POINTS];                  /* of the mesh, that they meet; -1: none */
    uint32_t point[FIBRAD_MET_POINTS];
    /* Of each eight: bounds of u, v at depth `at`, and of `aside`; beyond which depth none of them looks. */
    double low[2][FIBRAD_LINE_BLOCKS], high[2][FIBRAD_LINE_BLOCKS];
    double least[2][FIBRAD_LINE_BLOCKS], most[2][FIBRAD_LINE_BLOCKS];
    double last[FIBRAD_LINE_BLOCKS];
    uint32_t count;
    uint32_t parallel; /* they are those of all of so many points; 0: others */
    double at;
    uint32_t pair[FIBRAD_PAIRS_ROOM]; /* face times FIBRAD_LINE_BLOCKS and eight lines that may meet */
    uint32_t pairs;
} fibrad_lines;

/* Points of a window that meet triangles. */
typedef struct fibrad_met {
    fibrad_faces faces;
    double depth[FIBRAD_MET_POINTS];   /* along the line, from the plane through the centre; of points beyond a
                                          triangle that cuts sphere i below -1 */
    double weight[FIBRAD_MET_POINTS];  /* area or number of points that goes to the triangle */
    float aside[2][FIBRAD_MET_POINTS]; /* of the line's direction, along u and v */
    uint32_t side[FIBRAD_MET_POINTS];  /* of the mesh; FIBRAD_NO_SIDE: no triangle */
    fibrad_points points;              /* which they are; of windows by areas also what is open */
    uint32_t deepest;                  /* the side that the deepest line meets */
    bool any;                          /* whether there are such points in the window in hand */
    fibrad_lines lines;
} fibrad_met;

#define FIBRAD_WORK_MAX (1u << 28)

/* What a beam row among walls takes: the walls, what its windows give to them, and the window in hand. */
typedef struct fibrad_wall_room {
    fibrad_wall_view view;
    fibrad_wall_sums sums;
    fibrad_point_sums window;
    fibrad_points points; /* of the window, if the row has none */
} fibrad_wall_room;

/* What work memory is laid out for, or is asked for. */
typedef struct fibrad_work_plan {
    uint32_t walls;   /* 1: rows may be among walls */
    uint32_t met;     /* 1: among triangles */
    uint32_t near;    /* near spheres kept per row for all its directions; a matter of speed alone for beams and rays */
    uint32_t discs;   /* spheres met in one window, hidden ones included */
    uint32_t entries; /* different spheres and slots seen by one row */
    size_t extra;     /* bytes for what other methods keep */
} fibrad_work_plan;

/* The inside of a fibrad_work. Nothing but `extra` outlives a call. */
typedef struct fibrad_workspace {
    uint64_t seal;           /* that it is laid out, and for which block */
    fibrad_work_plan plan;   /* as laid out */
    fibrad_work_plan least;  /* what the call in hand cannot do without */
    fibrad_work_plan needed; /* after FIBRAD_E_WORK inside the kernel: at least this, in what differs from plan */
    fibrad_near near;
    fibrad_discs disc;
    fibrad_areas areas;
    fibrad_entries entries;
    fibrad_met *met;      /* NULL unless plan.met */
    void *extra;          /* [plan.extra] */
    uint64_t extra_owner; /* whose contents `extra` has, 0: nobody's; methods have numbers of their own */
    /* the row in hand */
    const fibrad_scene *scene;
    uint32_t place;            /* of sphere i in the scene */
    double unit, inverse;      /* its radius [L], and 1/radius */
    double centre[3];          /* [L] */
    double reach;              /* the cutoff; infinity if there is none */
    double step, growth;       /* depth of the first shell, and the ratio of each next one to it */
    double free_path;          /* about the mean way of a line to the first sphere, or less */
    double farthest;           /* no sphere is farther from i; infinity with periodic axes */
    double clear;              /* no window has its horizon nearer than this */
    double clear_mesh;         /* no triangle is nearer to the centre than this */
    uint32_t windows;          /* of a beam row */
    uint32_t back;             /* a triangle that was seen from a side that is nobody's; UINT32_MAX: none */
    bool cut;                  /* whether lines are cut: there is a cutoff, or a known region */
    fibrad_wall_room *walls;   /* NULL: there is no room for any */
    double wall[FIBRAD_SLOTS]; /* what meets each wall, escapes, or is beyond: areas, points or rays, then factors */
} fibrad_workspace;

/* Lays work memory out for a scene, or finds it laid out, with `extra_min` extra bytes at least and `extra_best` at
 * best. Errors: FIBRAD_E_ARGUMENT, _WORK (memory.needed is written), _MEMORY. */
int fibrad_work_open(fibrad_work *work, const fibrad_scene *scene, size_t extra_min, size_t extra_best,
                     fibrad_workspace **space);

/* Lays it out anew after the kernel's own FIBRAD_E_WORK, for what (*space)->needed asks. Errors: _WORK, _MEMORY,
 * _UNSUPPORTED (it asks for no more than there is). */
int fibrad_work_grow(fibrad_work *work, fibrad_workspace **space);

/* Notes in space->needed that more entries are needed, and returns FIBRAD_E_WORK, if a row has found no room for all;
 * else FIBRAD_OK. */
int fibrad_work_entries_missed(fibrad_workspace *space);

/* Notes that more discs are needed, by what the window in hand has met, and returns FIBRAD_E_WORK. */
int fibrad_work_discs_missed(fibrad_workspace *space);

/* Depth of the shells: the first one `first` mean spacings, the spacing being the cube root of the volume per
 * sphere, each next one `growth` times as deep. A matter of speed alone. */
typedef struct fibrad_stride {
    double first, growth;
} fibrad_stride;

/* Prepares for row `place` of the scene: no near spheres, no entries. */
void fibrad_work_begin(fibrad_workspace *work, const fibrad_scene *scene, uint32_t place, double cutoff,
                       fibrad_stride stride);

/* Whether a window that needs spheres beyond all shells makes a further shell, which the next windows use too, or walks
 * the grid alone. The first shell is for all; the others have many spheres each, for the few windows that stay open. */
#define FIBRAD_ASKED 8
static inline bool fibrad_near_pays(fibrad_near *near) {
    if (near->full || (near->shells > 0 && near->asked++ < FIBRAD_ASKED)) return false;
    near->asked = 0;
    return true;
}

/* How deep a march goes from where all is known: at least as far as most lines go without a sphere, since each march
 * costs something. */
static inline double fibrad_near_further(const fibrad_workspace *work, double known) {
    if (known < 0) return work->step;
    return fibrad_max(work->growth * known, known + 1.5 * work->free_path);
}

/* What the line from a place along w meets, if it meets no sphere: a slot. */
uint32_t fibrad_work_met(const fibrad_workspace *work, const double from[3], const double w[3]);

/* No sphere comes before the window of direction w deeper than this, or it does not count: along periodic axes beams
 * and rays end after FIBRAD_PERIODS. */
double fibrad_near_horizon(const fibrad_workspace *work, const double w[3]);

/* Whether a sphere comes before the window. At equal depth the lower id is in front, as among discs: of spheres that
 * overlap each other only one is seen by what lies behind, so that no sphere receives more than its own disc. */
static inline bool fibrad_work_ahead(const fibrad_workspace *work, double depth, double u, double v, uint32_t sphere) {
    if (depth != 0) return depth > 0;
    const uint64_t rank = fibrad_scene_rank(work->scene, sphere), own = fibrad_scene_rank(work->scene, work->place);
    if (rank != own) return rank > own;
    return u != 0 ? u > 0 : v > 0; /* images of one sphere */
}

static inline uint32_t fibrad_work_sphere(const fibrad_workspace *work, uint32_t disc) {
    return work->near.sphere[work->disc.near[disc]];
}

/* Adds what window k gives to a slot. */
static inline void fibrad_work_slot(fibrad_workspace *work, uint32_t slot, uint32_t k, double value) {
    if (work->entries.addends != NULL)
        fibrad_addends_put(work->entries.addends, FIBRAD_ADD_SLOT + slot, k, value);
    else
        work->wall[slot] += value;
}

/* Adds what window k sees of a disc. */
static inline void fibrad_work_accumulate(fibrad_workspace *work, uint32_t disc, uint32_t k, double area) {
    uint32_t *entry = &work->near.entry[work->disc.near[disc]];
    if (*entry == FIBRAD_NONE) *entry = fibrad_entries_of(&work->entries, fibrad_work_sphere(work, disc));
    fibrad_entries_add(&work->entries, *entry, k, area);
}

#endif
