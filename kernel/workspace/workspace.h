/* workspace.h - the inside of the work memory of one thread: what a row is computed with.
 * SPDX-License-Identifier: MIT
 *
 * All lengths are in units of the radius of sphere i, whose row is being computed. All positions are relative to its
 * centre.
 */
#ifndef FIBRAD_WORKSPACE_WORKSPACE_H
#define FIBRAD_WORKSPACE_WORKSPACE_H

#include "sums/row_sum.h"
#include "sums/wall_sum.h"
#include "window/areas.h"
#include "window/discs.h"
#include "mask/masks.h"
#include "workspace/segments.h"
#include "workspace/met.h"
#include "workspace/near_list.h"

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
    uint32_t walls;    /* 1: there may be planes, openings or a cylinder */
    uint32_t met;      /* 1: there may be triangles */
    uint32_t near;     /* near spheres listed for a row; for beams and rays it only changes the speed */
    uint32_t discs;    /* discs of one window, hidden ones included */
    uint32_t entries;  /* different spheres and slots seen by one row */
    size_t extra;      /* bytes for other methods */
    uint32_t segments; /* first segments of paths that a beam row takes */
} fibrad_work_plan;

/* The inside of a fibrad_work. Only `extra` lasts from one call to the next. */
typedef struct fibrad_workspace {
    uint64_t seal;           /* shows that this block is laid out */
    fibrad_work_plan plan;   /* as laid out */
    fibrad_work_plan best;   /* the sizes of growing memory: those of a packed bed, or more if rows have asked for it */
    fibrad_work_plan least;  /* the least that the present call needs */
    fibrad_work_plan needed; /* after FIBRAD_E_WORK inside the kernel: the sizes needed, where they differ from plan */
    fibrad_near near;
    fibrad_discs disc;
    fibrad_areas areas;
    fibrad_masks masks;
    fibrad_entries entries;
    fibrad_segments segments;
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
    bool cut;                  /* whether there is a cutoff */
    double bare;               /* what spheres leave open of the last window, as if there were no triangles */
    double open_error;         /* estimated error of what a row along directions has open */
    bool parallel, turned;     /* whether open lines keep the direction of their window, all or those to triangles */
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

/* The depth to which a window walks through the grid next. It is at least as far as most lines go without a sphere,
 * since every walk has a fixed cost. */
static inline double fibrad_near_further(const fibrad_workspace *work, double known) {
    if (known < 0) return work->step;
    return fibrad_max(work->growth * known, known + 1.5 * work->free_path);
}

/* The slot that the line from a point along w meets, if it meets no sphere within the ball of this radius. */
uint32_t fibrad_work_met(const fibrad_workspace *work, const double from[3], const double w[3], double ball);

/* The greatest depth at which a sphere can come before the window of direction w. Along periodic axes beams and rays
 * end after FIBRAD_PERIODS periods. */
double fibrad_near_horizon(const fibrad_workspace *work, const double w[3]);

/* Whether a sphere comes before the window. At depth 0 the rule for ties decides, as among discs. Hence of two spheres
 * with centres at one depth only one is ahead of the other, and no sphere receives more than its own disc. */
static inline bool fibrad_work_ahead(const fibrad_workspace *work, double depth, double u, double v, uint32_t sphere) {
    static const double middle[2] = {0, 0};
    return depth != 0 ? depth > 0 : fibrad_scene_tie(work->scene, work->place, middle, sphere, (double[]){u, v}, 2);
}

static inline uint32_t fibrad_work_sphere(const fibrad_workspace *work, uint32_t disc) {
    return work->near.sphere[work->disc.near[disc]];
}

/* Adds what a window sees of a slot. */
static inline void fibrad_work_slot(fibrad_workspace *work, uint32_t slot, double value) { work->wall[slot] += value; }

/* Adds the area of a disc that window k sees. */
static inline void fibrad_work_accumulate(fibrad_workspace *work, uint32_t disc, uint32_t k, double area) {
    uint32_t *entry = &work->near.entry[work->disc.near[disc]];
    if (*entry == FIBRAD_NONE) *entry = fibrad_entries_of(&work->entries, fibrad_work_sphere(work, disc));
    fibrad_entries_add(&work->entries, *entry, k, area);
}

#endif
