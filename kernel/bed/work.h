/* work.h - the inside of the work memory of one thread: near spheres, the discs of a window, the entries of a row.
 * SPDX-License-Identifier: MIT
 *
 * All lengths in here are in units of the radius of sphere i, whose row it is, and all places relative to its centre.
 */
#ifndef FIBRAD_BED_WORK_H
#define FIBRAD_BED_WORK_H

#include "bed/areas.h"
#include "bed/scene.h"
#include "pair/surface_lanes.h"

#define FIBRAD_SHELLS 8
/* The first shell looks FIRST mean spacings far, the spacing being the cube root of the volume per sphere, each next
 * GROWTH times as far. In a packed bed it has 130 spheres, and three shells fit into the default memory. Of the pairs
 * tried, from (2.3, 1.5) to (4.2, 1.25), this was the fastest: by 10 % over (2.3, 1.5). */
#define FIBRAD_FIRST  3.0
#define FIBRAD_GROWTH 1.4

/* Near spheres in shells by emergence: the least depth at which a sphere can come before a window, in any direction,
 * e = sqrt(d^2 - (1 + r)^2), d being its centre distance. It does come before the window of direction w just if
 * w.c > e. All spheres with e <= limit[s] are in shells 0 ... s, so that what a window meets down to that depth is
 * known after s + 1 shells. Each shell begins on a whole vector; the gaps are filled with points at the centre, which
 * never lie ahead. */
typedef struct fibrad_near {
    float *fx, *fy, *fz, *fe; /* [capacity] centre and, a little less than, e: for the first sieve, ... */
    float *fq;                /* ... and, a little less than, d^2 + 1 - r^2: for that of rays */
    double *x, *y, *z, *r;    /* [capacity] */
    double *sphere;           /* [capacity] place in the scene: a number in lanes like the others */
    uint32_t *found;          /* [capacity] scratch of a sieve */
    uint32_t capacity, shells;
    uint32_t end[FIBRAD_SHELLS]; /* where each shell ends */
    double limit[FIBRAD_SHELLS]; /* down to which depth windows are known with it */
    bool full;                   /* no room for a further shell: windows look farther each on its own */
} fibrad_near;

/* A disc before the window: the shadow of a sphere, v and u being its centre across the direction. */
typedef struct fibrad_disc {
    double depth, u, v, r;
    uint32_t sphere;
} fibrad_disc;

#define FIBRAD_WORK_MAX (1u << 28)

/* A row sees no farther than this many periods along any periodic axis. */
#define FIBRAD_PERIODS 100.0

/* What has been seen of each sphere so far, in the order of first sight; the sum over each fourth direction or ray
 * apart, for the estimate of the error. */
typedef struct fibrad_entries {
    uint32_t *at;      /* [slots] open addressing by sphere: which entry is its; FIBRAD_NONE: free */
    uint32_t *slot;    /* [capacity] where `at` tells of each entry */
    uint32_t *sphere;  /* [capacity] */
    double (*part)[4]; /* [capacity] visible area over all windows k = 0, 1, 2, 3 mod 4, or number of rays */
    double *lengths;   /* [capacity] of the rays, summed [L] */
    double *angles;    /* [capacity] between the rays and the line of centres, summed */
    uint64_t *key[2];  /* [capacity] scratch of the sort by columns */
    uint32_t slots, capacity, length, missed;
    bool end; /* the window in hand is the first or the last: it counts half in differences of even and odd windows */
} fibrad_entries;

struct fibrad_work {
    fibrad_work_config config, needed;
    fibrad_near near;
    fibrad_disc *disc; /* [config.discs] of the window in hand */
    double *depth;     /* [config.discs] of each, -1 once it is settled */
    uint32_t *order;   /* [config.discs] which is the first, the second ... from front to back */
    uint32_t discs;    /* may count on beyond the capacity */
    fibrad_areas areas;
    fibrad_entries entries;
    fibrad_obstacles blockers[2]; /* room for the two lists of the surface method, [near.capacity] */
    /* the row in hand */
    const fibrad_scene *scene;
    uint32_t place;                /* of sphere i in the scene */
    double unit, inverse;          /* its radius [L], and 1/radius */
    double centre[3];              /* [L] */
    double reach;                  /* the cutoff; infinity if there is none */
    double step;                   /* how far the first shell looks */
    double farthest;               /* no sphere is farther from i; infinity with periodic axes */
    double clear;                  /* no window has its horizon nearer than this */
    double wall[FIBRAD_WALLS + 1]; /* what meets each wall, and what meets none: areas, points or rays */
};

/* Prepares for row `place` of the scene: no near spheres, no entries. */
void fibrad_work_begin(fibrad_work *work, const fibrad_scene *scene, uint32_t place, double cutoff);

/* The part of a beam that is asked for: all of it (0, 0, 1), or the ray at place (u, v) of its window (u, v, 0). */
typedef struct fibrad_tube {
    double u, v, radius;
} fibrad_tube;

/* Appends to work->disc the discs before the window of direction w whose emergence lies in (from, to]; from < 0: those
 * in contact too. Discs that do not reach the tube may be left out. frame: two unit vectors across w, and w. */
void fibrad_near_march(fibrad_work *work, const double frame[9], const fibrad_tube *tube, double from, double to);

/* No sphere comes before the window of direction w deeper than this. */
double fibrad_near_horizon(const fibrad_work *work, const double w[3]);

/* Whether a sphere comes before the window. At equal depth the lower place is in front, as among discs: of spheres that
 * overlap each other only one is seen by what lies behind, so that no sphere receives more than its own disc. */
static inline bool fibrad_work_ahead(const fibrad_work *work, double depth, double u, double v, uint32_t sphere) {
    if (depth != 0) return depth > 0;
    if (sphere != work->place) return sphere > work->place;
    return u != 0 ? u > 0 : v > 0;
}

/* Appends a disc if it overlaps the window and lies ahead. */
static inline void fibrad_work_add_disc(fibrad_work *work, const double frame[9], double x, double y, double z,
                                        double r, uint32_t sphere) {
    double depth = frame[6] * x + frame[7] * y + frame[8] * z;
    double u = frame[0] * x + frame[1] * y + frame[2] * z, v = frame[3] * x + frame[4] * y + frame[5] * z;
    bool overlaps = u * u + v * v < (1 + r) * (1 + r); /* hard to predict: no branch */
    if (work->discs < work->config.discs) {
        work->disc[work->discs] = (fibrad_disc){depth, u, v, r, sphere};
        work->depth[work->discs] = depth;
    }
    work->discs += (uint32_t)fibrad_work_ahead(work, depth, u, v, sphere) & (uint32_t)overlaps;
}

/* Adds visible area of a sphere to part k mod 4. Counts in entries.missed what finds no room. */
void fibrad_entries_add(fibrad_entries *entries, uint32_t sphere, uint32_t k, double area);

/* The entry of a sphere; FIBRAD_NONE if it has found no room. */
uint32_t fibrad_entries_find(const fibrad_entries *entries, uint32_t sphere);

/* Writes the row: entries times `scale`, columns ascending, and as its error the distance of the sums over even and odd
 * windows. */
int fibrad_entries_row(const fibrad_work *work, double scale, fibrad_row *row);

/* The error of a beam row over that distance, from how much the sums over every fourth window differ, docs/methods.md
 * section 3. */
double fibrad_entries_gain(const fibrad_entries *entries);

#endif
