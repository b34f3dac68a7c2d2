/* near_list.h - the list of the spheres near one sphere. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_WORKSPACE_NEAR_LIST_H
#define FIBRAD_WORKSPACE_NEAR_LIST_H

#include "base/dispatch.h"
#include "base/port.h"

#define FIBRAD_SHELLS 8

/* The spheres of the first shell that may come before windows of some directions, for culls, as in fibrad_near. */
typedef struct fibrad_sight {
    float *x, *y, *z, *e; /* [capacity] */
    float *square;        /* [capacity], r^2, for masks */
    uint32_t *near;       /* [capacity], positions in the near list */
    uint32_t count;       /* whole vectors */
} fibrad_sight;

/* Near spheres are listed in shells by their minimum depth e = sqrt(d^2 - (1 + r)^2), d being the distance of the
 * centres. e is the least depth at which a sphere can come before any window. A sphere with centre c comes before the
 * window of direction w exactly if w.c > e. Shells 0 to s have all spheres with e <= limit[s]. Hence everything that a
 * window meets down to this depth is known after s + 1 shells. Each shell begins on a whole vector. Gaps are filled
 * with points at the centre, which never lie ahead. */
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

/* Whether a window that needs spheres beyond all shells makes another shell, for the next windows, too. If not, it
 * walks through the grid by itself. The first shell always pays. Other shells have many spheres, and few windows need
 * them. */
#define FIBRAD_ASKED 8
static inline bool fibrad_near_pays(fibrad_near *near) {
    if (near->full || (near->shells > 0 && near->asked++ < FIBRAD_ASKED)) return false;
    near->asked = 0;
    return true;
}

/* Whether a listed sphere certainly reaches into the hull of two spheres: that of the row, and one with the centre c
 * and the radius r. False: a sphere may reach into it or not. */
typedef bool fibrad_near_between_function(const fibrad_near *near, const double c[3], double r);
FIBRAD_DECLARE_VERSIONS(fibrad_near_between_function, fibrad_near_between);

#endif
