/* circle.h - the circle in which a sphere appears along a line, and the discs that lie behind and before it.
 * SPDX-License-Identifier: MIT
 *
 * All lines of one direction meet the spheres in the order of the depths of their centres. On the circle of sphere k,
 * let a be the last sphere before the depth of k that covers a point, and b the first one after it. docs/methods.md
 * section 12 has the method.
 *
 * Lengths are in units of a power of two of L, the same for all spheres. For each line, a sphere has one projected
 * centre, the same to the bit for all circles. Hence circles that nearly coincide agree on who covers whom. */
#ifndef FIBRAD_SILHOUETTE_CIRCLE_H
#define FIBRAD_SILHOUETTE_CIRCLE_H

#include "silhouette/pairs.h"
#include "work/work.h"

/* The largest number of discs of one side that a circle, or a stretch of a circle, may have. */
#define FIBRAD_CIRCLE_DISCS 240u
#define FIBRAD_CIRCLE_ROOM  (FIBRAD_CIRCLE_DISCS + 3 * FIBRAD_LANES_MAX)
#define FIBRAD_CIRCLE_ENDS  (4 * FIBRAD_CIRCLE_ROOM)

/* Parts of equal length of a stretch. What discs cover of them is told in bits. */
#define FIBRAD_CIRCLE_SECTORS 30

/* A place on a circle is a number from -1 to 3 for a whole turn. For angles t within a quarter turn of 0 it is
 * tan(t/2). On the other half of the circle it is 2 + tan((t - pi)/2). */
#define FIBRAD_CIRCLE_BEGIN (-1.0)
#define FIBRAD_CIRCLE_END   3.0

/* A line: two unit vectors across it, and its direction. */
typedef struct fibrad_line {
    double frame[9];
} fibrad_line;

/* Discs behind or before a sphere, in any order. Floats give bounds of what they cover. */
typedef struct fibrad_circle_side {
    _Alignas(64) float low[FIBRAD_CIRCLE_ROOM]; /* bounds of the depth away from the sphere, in its radii */
    float high[FIBRAD_CIRCLE_ROOM];
    uint32_t inner[FIBRAD_CIRCLE_ROOM]; /* sectors of the stretch that the disc certainly covers whole, as bits, ... */
    uint32_t outer[FIBRAD_CIRCLE_ROOM]; /* ... and those of which it may cover some; 0: the disc does not count */
    uint32_t slot[FIBRAD_CIRCLE_ROOM];  /* number among the near spheres */
    uint32_t last;                      /* end of the list */
    double known;                       /* all discs down to this depth are found, in radii of the sphere */
    double sense;                       /* 1: before the sphere; -1: behind it */
    bool closed, open;                  /* down to that depth certainly nothing, something, is open */
    uint32_t nothing;                   /* the name of what lies beyond all spheres */
} fibrad_circle_side;

/* The discs of a side that may be seen, in any order. Element `count` stands for what lies beyond all spheres. */
typedef struct fibrad_circle_discs {
    _Alignas(64) double u[FIBRAD_CIRCLE_ROOM]; /* centre relative to that of the sphere */
    double v[FIBRAD_CIRCLE_ROOM], depth[FIBRAD_CIRCLE_ROOM];
    double from[FIBRAD_CIRCLE_ROOM]; /* the arc that the disc covers; ends outside the stretch lie beyond all places */
    double to[FIBRAD_CIRCLE_ROOM];   /* less than `from` if the disc covers the place where the stretch begins */
    double weight[FIBRAD_CIRCLE_ROOM];   /* units per area */
    float key[FIBRAD_CIRCLE_ROOM];       /* the depth, rounded */
    uint32_t rank[FIBRAD_CIRCLE_ROOM];   /* 0 for the nearest disc */
    uint32_t number[FIBRAD_CIRCLE_ROOM]; /* the disc of each rank */
    uint32_t slot[FIBRAD_CIRCLE_ROOM];
    uint32_t count;
} fibrad_circle_discs;

/* Ends of arcs: those of one side, then those of the other. */
typedef struct fibrad_circle_ends {
    _Alignas(64) double at[FIBRAD_CIRCLE_ENDS];
    float key[FIBRAD_CIRCLE_ENDS];       /* the place, rounded */
    uint64_t own[FIBRAD_CIRCLE_ENDS];    /* the bit of the disc to which the end belongs */
    uint64_t nearer[FIBRAD_CIRCLE_ENDS]; /* the bits of the discs of the same side that are nearer */
    uint32_t count;
} fibrad_circle_ends;

/* Pieces of the stretch, in order, on which nothing changes. Each ends where the next one begins. */
typedef struct fibrad_circle_pieces {
    _Alignas(64) double at[FIBRAD_CIRCLE_ENDS];
    double angle[FIBRAD_CIRCLE_ENDS], cosine[FIBRAD_CIRCLE_ENDS], sine[FIBRAD_CIRCLE_ENDS];
    double behind[FIBRAD_CIRCLE_ENDS], ahead[FIBRAD_CIRCLE_ENDS], past[FIBRAD_CIRCLE_ENDS]; /* areas, in units */
    uint32_t first[FIBRAD_CIRCLE_ENDS], next[FIBRAD_CIRCLE_ENDS]; /* numbers of the discs that are met */
    uint32_t count;
} fibrad_circle_pieces;

/* The near spheres of work->near. From element near.capacity on there are those that a walk has found. The last two
 * elements, `nothing` and nothing + 1, stand for what lies beyond all spheres, behind and before. The element before
 * them, `nowhere`, is a sphere so far away that no circle touches it. It fills vectors up. */
typedef struct fibrad_circle_near {
    double (*ball)[4]; /* position and radius */
    float (*seen)[4];  /* position relative to the sphere in hand, and radius, in radii of that sphere */
    double (*away)[4]; /* how many periods away the image is along each axis */
    uint32_t *sphere;
    int64_t *sum[2];                 /* what is exchanged with the sphere in hand, in units, over even and odd lines */
    uint32_t fill[FIBRAD_LANES_MAX]; /* `nowhere` */
    uint32_t nowhere, nothing;
} fibrad_circle_near;

/* A stretch of a circle. The circle of a sphere far larger than its neighbours touches so many discs that it is
 * followed stretch by stretch. */
typedef struct fibrad_circle_stretch {
    double begin, end;   /* places */
    double sectors;      /* FIBRAD_CIRCLE_SECTORS over its length */
    double u, v, radius; /* a disc that contains it, about a point of it; infinity: it is the whole circle */
} fibrad_circle_stretch;

/* What scratch memory holds while circles of one task are followed. */
typedef struct fibrad_circles {
    fibrad_circle_side side[2]; /* 0: behind, 1: before */
    fibrad_circle_discs seen[2];
    fibrad_circle_ends ends;
    fibrad_circle_pieces pieces;
    _Alignas(64) uint32_t rank[FIBRAD_CIRCLE_ENDS];
    uint32_t order[FIBRAD_CIRCLE_ENDS];
    uint64_t key[FIBRAD_CIRCLE_ENDS]; /* discs that cover the pieces; pairs of what is met behind and before */
    fibrad_circle_near near;
    uint32_t homes, walked; /* ends of the lists of near spheres: those of shells, those that walks have found */
    bool images;            /* whether some near spheres are images of others */
    bool apart;             /* what lies beyond all spheres has a different name for each line and sense */
    uint32_t half;          /* whether the line in hand is even, 0, or odd, 1 */
    const fibrad_scene *scene;
    double origin[3]; /* L */
    double scale;     /* 1/L, a power of two */
    double period[3]; /* of the scene, scaled */
    double grid;      /* projected centres are multiples of the ulp of this number */
    /* the sphere in hand, and what is to be followed of its circles */
    double at[3], r;
    double begin, end, step; /* places, and the usual length of a stretch */
    double next;             /* the place from which the line in hand goes on */
    /* the line in hand */
    const double *frame;
    double across[9];   /* the frame, ... */
    double shift[3][3]; /* one period of each axis, projected onto that frame */
    double centre[3];   /* projected */
    double farthest;    /* along periodic axes spheres farther apart than this exchange nothing */
    fibrad_circle_stretch stretch;
} fibrad_circles;

#endif
