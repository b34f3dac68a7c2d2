/* scene.h - the inside of a scene: spheres in the order of a cell grid. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SCENE_SCENE_H
#define FIBRAD_SCENE_SCENE_H

#include "base/port.h"
#include "fibrad_part.h"
#include "mesh/mesh.h"

#define FIBRAD_NONE UINT32_MAX

/* What a ray meets that meets no sphere has a slot: 0 to 5 are planes across the axes, x low, x high, y low, y high, z
 * low, z high; 6 is the cylinder; 7 is nothing, 8 what is not known; from 9 on come meshes, in the order of bodies. */
#define FIBRAD_WALLS    7
#define FIBRAD_CYLINDER 6u
#define FIBRAD_ESCAPED  7
#define FIBRAD_BEYOND   8
#define FIBRAD_MESHES   9u
#define FIBRAD_SLOTS    (FIBRAD_MESHES + FIBRAD_BODIES_MAX)

/* Whether a slot is that of a wall or a mesh. */
static inline bool fibrad_slot_of_body(uint32_t slot) { return slot < FIBRAD_WALLS || slot >= FIBRAD_MESHES; }

/* Spheres whose radii differ by less than a factor two share a level, a grid of its own with cells to their measure:
 * a small sphere among large ones does not search cells as wide as the large ones need. */
#define FIBRAD_LEVELS 32

/* Nothing is looked for farther than this many periods along any periodic axis. */
#define FIBRAD_PERIODS 100.0

typedef struct fibrad_level {
    double radius_max;
    double cell[3], inverse[3]; /* size of a cell [L] and its inverse */
    int32_t cells[3];
    uint32_t first_cell;   /* where its cells begin in scene->start; x runs fastest */
    uint32_t first_sphere; /* where its spheres begin */
} fibrad_level;

/* Eight spheres as whole numbers, in one line of the cache, to leave most of them out: [0, 65535] over the box of the
 * grid along each axis, and no radius is more than its number says. */
#define FIBRAD_COARSE       8
#define FIBRAD_COARSE_STRAY 65535 /* for a radius: the sphere is outside the box */
typedef struct fibrad_coarse {
    _Alignas(64) uint16_t number[4 * FIBRAD_COARSE]; /* all x, all y, all z, all radii */
} fibrad_coarse;

/* The convex region within the walls. */
typedef struct fibrad_container {
    bool walls;             /* whether there are any */
    bool cuts;              /* whether one cuts a sphere */
    uint32_t openings;      /* bit k: the plane of slot k is an opening */
    double low[3], high[3]; /* of the planes [L]; infinite where there is none */
    double axis[2], radius; /* of the cylinder [L]; radius infinite: none */
} fibrad_container;

/* Whether what meets a slot goes to the surroundings. */
static inline bool fibrad_is_opening(const fibrad_container *container, uint32_t slot) {
    return slot < FIBRAD_WALLS && (container->openings >> slot & 1) != 0;
}

struct fibrad_scene {
    fibrad_scene_facts facts;
    double period[3], low[3], high[3]; /* box of the centres; on a periodic axis high = low + period */
    double box_low[3], box_high[3];    /* box of the grid: the same without stray spheres */
    fibrad_container container;
    bool region;                        /* whether a known region was given */
    double known_low[3], known_high[3]; /* [L] infinite where it is open */
    fibrad_occupancy occupancy;         /* the caller's, or one cell */
    uint32_t slot[FIBRAD_BODIES_MAX];   /* [facts.bodies] of each body */
    double wall_area[FIBRAD_SLOTS];     /* [L^2] by slot, as fibrad_scene_body_area; 0: no such wall */
    uint64_t hash;                      /* of all that was handed over; 0: the scene is not complete */
    double spacing;                     /* cube root of the volume per sphere [L] */
    uint32_t levels;
    fibrad_level level[FIBRAD_LEVELS];                   /* by ascending radius; empty ones left out */
    double *x, *y, *z, *r;                               /* [n] in cell order */
    fibrad_coarse *coarse;                               /* [n / FIBRAD_COARSE, rounded up] the same, in less room */
    double coarse_unit[3], coarse_low[3], coarse_radius; /* [L] a number is so much: coarse_low + unit * number */
    uint32_t *order;                                     /* [n] the caller's index of each */
    uint32_t *place;                                     /* [n] where the caller's sphere i stands */
    uint32_t *start;                                     /* [cells + 1] */
    uint64_t *id;                                        /* [n] by the caller's index; NULL: that is the id */
    fibrad_mesh mesh;
    float *clear; /* [n] distance to the nearest triangle over the radius, or less; NULL: there are no triangles */
};

/* The slot of a side of the mesh; FIBRAD_NONE: it belongs to no body. */
static inline uint32_t fibrad_scene_slot(const fibrad_scene *scene, uint32_t side) {
    const uint8_t mesh = scene->mesh.mesh[side / 2][side % 2];
    return mesh != FIBRAD_NO_MESH ? FIBRAD_MESHES + mesh : FIBRAD_NONE;
}

/* Whether there is a complete scene. */
static inline bool fibrad_scene_ready(const fibrad_scene *scene) { return scene != NULL && scene->hash != 0; }

/* The number of the random paths of the caller's sphere i. */
static inline uint64_t fibrad_scene_id(const fibrad_scene *scene, uint32_t i) {
    return scene->id != NULL ? scene->id[i] : i;
}

/* That of the sphere at a place. It decides among equals, so that the order of spheres does not. */
static inline uint64_t fibrad_scene_rank(const fibrad_scene *scene, uint32_t place) {
    return fibrad_scene_id(scene, scene->order[place]);
}

#endif
