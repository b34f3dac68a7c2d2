/* work.h - the inside of the work memory of one thread: near spheres, and the row in hand.
 * SPDX-License-Identifier: MIT
 *
 * All lengths are in units of the radius of sphere i, whose row is being computed. All positions are relative to its
 * centre.
 */
#ifndef FIBRAD_WORK_WORK_H
#define FIBRAD_WORK_WORK_H

#include "work/row_sum.h"
#include "work/wall_sum.h"
#include "scene/surroundings.h"
#include "window/areas.h"
#include "window/discs.h"
#include "mask/masks.h"
#include "window/points.h"

#define FIBRAD_SHELLS 8
/* Near spheres are listed in shells by their minimum depth e = sqrt(d^2 - (1 + r)^2), d being the distance of the
 * centres. e is the least depth at which a sphere can come before any window. A sphere with centre c comes before the
 * window of direction w exactly if w.c > e. Shells 0 to s have all spheres with e <= limit[s]. Hence everything that a
 * window meets down to this depth is known after s + 1 shells. Each shell begins on a whole vector. Gaps are filled
 * with points at the centre, which never lie ahead. */
/* The spheres of the first shell that may come before windows of some directions, for culls, as in fibrad_near. */
typedef struct fibrad_sight {
    float *x, *y, *z, *e; /* [capacity] */
    float *square;        /* [capacity], r^2, for masks */
    uint32_t *near;       /* [capacity], positions in the near list */
    uint32_t count;       /* whole vectors */
} fibrad_sight;

typedef struct fibrad_near {
    float *fx, *fy, *fz, *fe; /* [capacity], for culls of beams: centre, and a little less than e */
    float *fq;                /* [capacity], for culls of rays: a little less than d^2 + 1 - r^2 */
    float *fsquare;           /* [capacity], r^2 */
    uint32_t (*count)[2];     /* [capacity], points of masks seen in even and in odd windows */
    double *x, *y, *z, *r;    /* [capacity], centre and radius */
    /* Element capacity + k is for disc k of a window, if the window has found it in the grid. */
    uint32_t *sphere; /* [capacity + discs + FIBRAD_LANES_MAX], position in scene order */
    uint32_t *entry;  /* [same], entry of the sphere in the row; FIBRAD_NONE: none so far */
    uint32_t capacity, shells;
    uint32_t end[FIBRAD_SHELLS]; /* end of each shell in the arrays */
    double limit[FIBRAD_SHELLS]; /* depth down to which windows are known with this shell */
    bool full;                   /* there is no room for another shell; windows walk through the grid */
    fibrad_sight octant[8];      /* of directions; bits 0, 1, 2 of the number: x, y, z are negative */
    fibrad_sight all;            /* of all directions; its arrays continue with the other shells */
    const fibrad_sight *seen[8]; /* list of each octant, its own or `all`; NULL: not listed yet */
    uint32_t sights;             /* capacity of the list of an octant */
    uint32_t asked;              /* number of windows that have asked for another shell */
} fibrad_near;

/* Some of the triangles that may come before a window, in the frame of the window. Seen along the direction of the
 * window, their corners go round to the left. */
#define FIBRAD_FACES      32u
#define FIBRAD_FACES_ROOM (FIBRAD_FACES + FIBRAD_LANES_MAX)
typedef struct fibrad_faces {
    double corner[3][3][FIBRAD_FACES_ROOM];                 /* u, v and depth of each corner */
    double low[FIBRAD_FACES_ROOM], high[FIBRAD_FACES_ROOM]; /* range of depths */
    double plane[3][FIBRAD_FACES_ROOM];                     /* depth = u plane[0] + v plane[1] + plane[2] */
    double middle[FIBRAD_FACES_ROOM];     /* about the depth of the plane at the middle of the window */
    double edge[3][3][FIBRAD_FACES_ROOM]; /* u edge[k][0] + v edge[k][1] + edge[k][2] >= 0 inside */
    double side[FIBRAD_FACES_ROOM];       /* side of the mesh that is seen */
    uint32_t triangle[FIBRAD_FACES_ROOM]; /* triangle of the mesh */
    uint32_t count;
} fibrad_faces;

/* Lines of a window that search for triangles, one for each point. They are sorted so that the eight lines of a block
 * are near each other at the depth `at`. The last block is filled up with lines that meet nothing. */
#define FIBRAD_MET_POINTS  256
#define FIBRAD_LINE_BLOCK  8
#define FIBRAD_LINE_BLOCKS (FIBRAD_MET_POINTS / FIBRAD_LINE_BLOCK)
#define FIBRAD_PAIRS       64u
#define FIBRAD_PAIRS_ROOM  (FIBRAD_PAIRS + FIBRAD_LINE_BLOCKS + FIBRAD_LANES_MAX)
typedef struct fibrad_lines {
    _Alignas(64) double place[2][FIBRAD_MET_POINTS]; /* u, v where the lines leave sphere i */
    double exit[FIBRAD_MET_POINTS];                  /* depth where the lines leave sphere i */
    double aside[2][FIBRAD_MET_POINTS];              /* parts of the directions along u and v; 0 unless spread */
    double depth[FIBRAD_MET_POINTS];                 /* depth of what a line meets, or where its search ends */
    double side[FIBRAD_MET_POINTS];                  /* side of the mesh that a line meets; -1: none */
    uint32_t point[FIBRAD_MET_POINTS];
    /* Of each block: bounds of u and v at depth `at`, bounds of `aside`, and the depth where all searches end. */
    double low[2][FIBRAD_LINE_BLOCKS], high[2][FIBRAD_LINE_BLOCKS];
    double least[2][FIBRAD_LINE_BLOCKS], most[2][FIBRAD_LINE_BLOCKS];
    double last[FIBRAD_LINE_BLOCKS];
    uint32_t count;
    uint32_t parallel; /* number of points if the lines are those of all points and parallel; 0: other lines */
    double at;
    uint32_t pair[FIBRAD_PAIRS_ROOM]; /* FIBRAD_LINE_BLOCKS times a face + a block of lines that may meet it */
    uint32_t pairs;
} fibrad_lines;

/* Points of a window that meet triangles. */
typedef struct fibrad_met {
    fibrad_faces faces;
    double depth[FIBRAD_MET_POINTS];   /* along the line, from the plane through the centre; below -1 for
                                          points beyond a triangle that cuts sphere i */
    double weight[FIBRAD_MET_POINTS];  /* area, or number of points, for the triangle */
    float aside[2][FIBRAD_MET_POINTS]; /* parts of the direction of the line along u and v */
    uint32_t side[FIBRAD_MET_POINTS];  /* side of the mesh; FIBRAD_NO_SIDE: none */
    fibrad_points points;              /* the points; for windows by areas also which are open */
    uint32_t deepest;                  /* side that the deepest line meets */
    bool any;                          /* whether the present window has such points */
    fibrad_lines lines;
} fibrad_met;

#define FIBRAD_NEAR_MOST 1024u /* near spheres of one row, as a packed bed has them, with room to spare */
#define FIBRAD_WORK_MAX  (1u << 28)

/* Work memory of a beam row among walls: the walls, sums over all windows, and sums over the present window. */
typedef struct fibrad_wall_room {
    fibrad_wall_view view;
    fibrad_wall_sums sums;
    fibrad_point_sums window;
    fibrad_points points; /* of the window, if the rule has no points */
} fibrad_wall_room;

/* The sizes for which work memory is laid out, or which a row needs. */
typedef struct fibrad_work_plan {
    uint32_t walls;   /* 1: there may be planes, openings or a cylinder */
    uint32_t met;     /* 1: there may be triangles */
    uint32_t near;    /* near spheres listed for a row; for beams and rays it only changes the speed */
    uint32_t discs;   /* discs of one window, hidden ones included */
    uint32_t entries; /* different spheres and slots seen by one row */
    size_t extra;     /* bytes for other methods */
    uint32_t legs;    /* first legs of paths that a beam row takes */
} fibrad_work_plan;

/* The first leg of a path: a beam of a window. Once paths have arrived (exchange/paths.h), n, w, centre and sphere tell
 * where the leg has ended. */
typedef struct fibrad_leg {
    double n[3];       /* outward normal of sphere i where the beam leaves; later: normal of the surface met */
    double w[3];       /* direction of the beam; later, at a wall: where the leg ends [L] */
    double even[3];    /* an even point of the unit sphere, by which a path goes on */
    double centre[3];  /* of the sphere met, from the centre of sphere i, in its radii; later: centre of the path [L] */
    uint32_t sphere;   /* place of the sphere met; FIBRAD_NONE: not known; later FIBRAD_NONE: a wall is met */
    uint32_t triangle; /* later: the triangle met; FIBRAD_NO_SIDE: none */
    uint32_t chosen;   /* later: the number of the leg from which path k goes on, k being the number of this leg */
    double weight;     /* in legs from each window on the mean; later: what the surface met reflects */
} fibrad_leg;

/* First legs that a beam row takes from its windows, equally many from each. */
typedef struct fibrad_legs {
    uint64_t shift[4];       /* of the four coordinates of each leg */
    uint32_t wanted, length; /* wanted: at most plan.legs; 0: the row takes none */
    uint32_t sources;        /* legs with those beyond `length`, to spheres that no leg of a window meets */
    fibrad_leg *leg;         /* [plan.legs] */
    double share;            /* out, of arrival: mean weight of the legs */
} fibrad_legs;

/* The inside of a fibrad_work. Only `extra` lasts from one call to the next. */
typedef struct fibrad_workspace {
    uint64_t seal;           /* shows that this block is laid out */
    fibrad_work_plan plan;   /* as laid out */
    fibrad_work_plan least;  /* the least that the present call needs */
    fibrad_work_plan needed; /* after FIBRAD_E_WORK inside the kernel: the sizes needed, where they differ from plan */
    fibrad_near near;
    fibrad_discs disc;
    fibrad_areas areas;
    fibrad_masks masks;
    fibrad_entries entries;
    fibrad_legs legs;
    fibrad_met *met;      /* NULL unless plan.met */
    void *extra;          /* [plan.extra] */
    uint64_t extra_owner; /* who wrote the contents of `extra`; 0: nobody; each method has its number */
    /* the present row */
    const fibrad_scene *scene;
    uint32_t place;            /* position of sphere i in scene order */
    double unit, inverse;      /* L, its radius, and 1/radius */
    double centre[3];          /* L */
    double reach;              /* the cutoff; infinity: none */
    double step, growth;       /* depth of the first shell, and the ratio of each next one to it */
    double free_path;          /* about the mean free path of a line, or less */
    double farthest;           /* distance beyond which there is no sphere; infinity with periodic axes */
    double extent[3][2];       /* how far along each axis, down and up, there may be spheres before a window */
    double clear;              /* lower bound of the horizon of all windows */
    double clear_mesh;         /* lower bound of the distance from the centre to a triangle */
    uint32_t windows;          /* number of windows of a beam row */
    uint32_t back;             /* a triangle seen from a side that belongs to no wall; UINT32_MAX: none */
    bool cut;                  /* whether there is a cutoff or a known region */
    bool parallel;             /* whether open lines keep the direction of their window */
    fibrad_wall_room *walls;   /* NULL unless plan.walls */
    double wall[FIBRAD_SLOTS]; /* by slot: areas, points or rays; then factors */
} fibrad_workspace;

/* Lays work memory out for a scene, if it is not laid out yet. extra_min and extra_best [bytes] are the least and the
 * best extra memory. Errors: FIBRAD_E_ARGUMENT, _WORK (memory.needed is written), _MEMORY. */
int fibrad_work_open(fibrad_work *work, const fibrad_scene *scene, size_t extra_min, size_t extra_best,
                     fibrad_workspace **space);

/* Lays work memory out again for (*space)->needed, after FIBRAD_E_WORK inside the kernel. Errors: _WORK, _MEMORY,
 * _UNSUPPORTED (needed is not more than there is). */
int fibrad_work_grow(fibrad_work *work, fibrad_workspace **space);

/* FIBRAD_OK if all entries of a row had room. Otherwise FIBRAD_E_WORK, and space->needed.entries is set. */
int fibrad_work_entries_missed(fibrad_workspace *space);

/* FIBRAD_E_WORK. space->needed.discs is set from the discs of the present window. */
int fibrad_work_discs_missed(fibrad_workspace *space);

/* Depths of the shells. The first is `first` times the cube root of the volume per sphere. Each next one is `growth`
 * times as deep. The depths only change the speed. */
typedef struct fibrad_stride {
    double first, growth;
} fibrad_stride;

/* Prepares for the row of the sphere at position `place`: no near spheres, no entries. */
void fibrad_work_begin(fibrad_workspace *work, const fibrad_scene *scene, uint32_t place, double cutoff,
                       fibrad_stride stride);

/* Whether a window that needs spheres beyond all shells makes another shell, for the next windows, too. If not, it
 * walks through the grid by itself. The first shell always pays. Other shells have many spheres, and few windows need
 * them. */
#define FIBRAD_ASKED 8
static inline bool fibrad_near_pays(fibrad_near *near) {
    if (near->full || (near->shells > 0 && near->asked++ < FIBRAD_ASKED)) return false;
    near->asked = 0;
    return true;
}

/* The depth to which a window walks through the grid next. It is at least as far as most lines go without a sphere,
 * since every walk has a fixed cost. */
static inline double fibrad_near_further(const fibrad_workspace *work, double known) {
    if (known < 0) return work->step;
    return fibrad_max(work->growth * known, known + 1.5 * work->free_path);
}

/* The slot that the line from a point along w meets, if it meets no sphere. */
uint32_t fibrad_work_met(const fibrad_workspace *work, const double from[3], const double w[3]);

/* The greatest depth at which a sphere can come before the window of direction w. Along periodic axes beams and rays
 * end after FIBRAD_PERIODS periods. */
double fibrad_near_horizon(const fibrad_workspace *work, const double w[3]);

/* Whether a sphere comes before the window. At depth 0 the lower id is in front, as among discs. Hence of two spheres
 * with centres at one depth only one is ahead of the other, and no sphere receives more than its own disc. */
static inline bool fibrad_work_ahead(const fibrad_workspace *work, double depth, double u, double v, uint32_t sphere) {
    if (depth != 0) return depth > 0;
    const uint64_t rank = fibrad_scene_rank(work->scene, sphere), own = fibrad_scene_rank(work->scene, work->place);
    if (rank != own) return rank > own;
    return u != 0 ? u > 0 : v > 0; /* images of one sphere */
}

static inline uint32_t fibrad_work_sphere(const fibrad_workspace *work, uint32_t disc) {
    return work->near.sphere[work->disc.near[disc]];
}

/* Adds a value of window k to a slot. */
static inline void fibrad_work_slot(fibrad_workspace *work, uint32_t slot, uint32_t k, double value) {
    if (work->entries.addends != NULL)
        fibrad_addends_put(work->entries.addends, FIBRAD_ADD_SLOT + slot, k, value);
    else
        work->wall[slot] += value;
}

/* Adds the area of a disc that window k sees. */
static inline void fibrad_work_accumulate(fibrad_workspace *work, uint32_t disc, uint32_t k, double area) {
    uint32_t *entry = &work->near.entry[work->disc.near[disc]];
    if (*entry == FIBRAD_NONE) *entry = fibrad_entries_of(&work->entries, fibrad_work_sphere(work, disc));
    fibrad_entries_add(&work->entries, *entry, k, area);
}

#endif
