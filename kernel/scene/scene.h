/* scene.h - the inside of a scene: spheres in the order of a cell grid. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SCENE_SCENE_H
#define FIBRAD_SCENE_SCENE_H

#include "base/faces.h"
#include "mesh/mesh.h"

/* ---- the slots of what a line can meet besides spheres ----------------------------------------------------------- */

/* Each plane, the cylinder, the surroundings, the unknown, and each mesh have a slot. Results by slot are arrays of
 * FIBRAD_SLOTS elements. Only these lines know how slots are numbered:
 *   0 to 5     planes, in the order of base/faces.h
 *   6          the cylinder
 *   7          the surroundings
 *   8          not known: `beyond` of a row
 *   9 and up   meshes, in the order of the walls of the configuration */
#define FIBRAD_CYLINDER 6u
#define FIBRAD_WALLS    7 /* number of planes and cylinders */
#define FIBRAD_ESCAPED  7
#define FIBRAD_BEYOND   8
#define FIBRAD_MESHES   9u
#define FIBRAD_SLOTS    (FIBRAD_MESHES + FIBRAD_WALLS_MAX)

/* Whether a slot belongs to a wall: a plane, the cylinder or a mesh. */
static inline bool fibrad_slot_of_wall(uint32_t slot) { return slot < FIBRAD_WALLS || slot >= FIBRAD_MESHES; }

static inline bool fibrad_slot_is_plane(uint32_t slot) { return slot < FIBRAD_CYLINDER; }

/* The slot of a mesh, and back. */
static inline uint32_t fibrad_slot_of_mesh(uint32_t mesh) { return FIBRAD_MESHES + mesh; }
static inline bool fibrad_slot_is_mesh(uint32_t slot) { return slot >= FIBRAD_MESHES; }
static inline uint32_t fibrad_slot_mesh(uint32_t slot) { return slot - FIBRAD_MESHES; }

/* ---- the inside of a scene: spheres in the order of a cell grid -------------------------------------------------- */

#define FIBRAD_NONE UINT32_MAX

/* Spheres whose radii differ by less than a factor of two have a level in common. Each level has a grid with cells to
 * the size of its spheres. Hence a search among small spheres does not visit cells as wide as large spheres need. */
#define FIBRAD_LEVELS 32

typedef struct fibrad_level {
    double radius_max;
    double cell[3], inverse[3]; /* L and 1/L: size of a cell and its inverse */
    int32_t cells[3];
    uint32_t first_cell;   /* index of the first cell in scene->start; x runs fastest */
    uint32_t first_sphere; /* position of the first sphere in scene order */
} fibrad_level;

/* Eight spheres as whole numbers, in one cache line. A first comparison with these numbers excludes most spheres. A
 * coordinate is 0 to 65535 over the box of the grid. A radius is rounded up. */
#define FIBRAD_COARSE       8
#define FIBRAD_COARSE_STRAY 65535 /* as a radius: the sphere lies outside the box */
typedef struct fibrad_coarse {
    _Alignas(64) uint16_t number[4 * FIBRAD_COARSE]; /* all x, all y, all z, all radii */
} fibrad_coarse;

/* The convex region inside the planes and the cylinder. */
typedef struct fibrad_container {
    bool walls;             /* whether there is a plane, an opening or a cylinder */
    bool cuts;              /* whether a wall cuts a sphere */
    uint32_t openings;      /* bit k: the plane of slot k is an opening */
    double low[3], high[3]; /* L, of the planes; infinite where there is none */
    double axis[2], radius; /* L, of the cylinder; an infinite radius: there is none */
    uint32_t turn;          /* 0 without a cylinder */
} fibrad_container;

/* Axis a = 0, 1 or 2 of the cylinder: the first two lie across it, the last one along it. They are the axes x, y and z,
 * turned cyclically. */
static inline uint32_t fibrad_cylinder_axis(uint32_t turn, uint32_t a) { return (a + turn) % 3; }

/* Whether a slot is an opening, so that its radiation goes to the surroundings. */
static inline bool fibrad_is_opening(const fibrad_container *container, uint32_t slot) {
    return slot < FIBRAD_WALLS && (container->openings >> slot & 1) != 0;
}

/* A cap of a unit sphere that another sphere hides. */
typedef struct fibrad_cap {
    double axis[3], angle; /* unit vector to its middle; between this and its edge */
    double share;          /* of the sphere's area; 1: all */
} fibrad_cap;

/* A sphere that belongs to the same part of a clump. */
typedef struct fibrad_link {
    uint32_t to;        /* itself: it stands for the part */
    int32_t periods[3]; /* of the image of `to` that belongs to the sphere */
} fibrad_link;

/* What a scene with clumps has. All but `exposed` and `volume` is used while it is made. */
typedef struct fibrad_clumps {
    double *exposed;    /* L^2, [n], in scene order */
    double *volume;     /* L^3, [n], share of the volume of the clump */
    double (*outer)[3]; /* [n], sum of the normals of the exposed part of a unit sphere, times their areas */
    fibrad_link *link;
    fibrad_cap *cap;     /* [n], of one sphere */
    double (*hidden)[2]; /* [n], of one circle */
    uint64_t *key;       /* [2 n] */
} fibrad_clumps;

struct fibrad_scene {
    fibrad_scene_facts facts;
    double period[3], low[3], high[3]; /* L, box of the centres; on a periodic axis high = low + period */
    double box_low[3], box_high[3];    /* L, box of the grid: the same without stray spheres */
    fibrad_container container;
    fibrad_occupancy occupancy;      /* the caller's, or one cell */
    uint32_t slot[FIBRAD_WALLS_MAX]; /* [facts.walls], slot of each wall */
    double wall_area[FIBRAD_SLOTS];  /* L^2, by slot, as fibrad_scene_wall_area; 0: no such wall */
    uint64_t hash;                   /* of all input; 0: the scene is not complete */
    double spacing;                  /* L, cube root of the volume per sphere */
    uint32_t levels;
    fibrad_level level[FIBRAD_LEVELS]; /* by ascending radius, without empty levels */
    double *x, *y, *z, *r;             /* L, [n], in scene order, which is that of the cells */
    fibrad_coarse *coarse;             /* [n / FIBRAD_COARSE, rounded up], the same spheres as whole numbers */
    double coarse_unit[3], coarse_low[3], coarse_radius; /* L, of a coordinate: coarse_low + coarse_unit * number */
    uint32_t *order;                                     /* [n], the caller's index of each sphere in scene order */
    uint32_t *place;                                     /* [n], position of the caller's sphere i in scene order */
    uint32_t *start;                                     /* [cells + 1], position of the first sphere of each cell */
    uint64_t *id;                                        /* [n], by the caller's index; NULL: the index is the id */
    uint32_t *clump;                                     /* [n], in scene order; NULL: no sphere is in a clump */
    fibrad_clumps clumps;                                /* if there are clumps */
    fibrad_mesh mesh;
    unsigned char *cut; /* [n], 1: a wall cuts the sphere, so that a cap of it lies behind the wall */
    float *clear; /* [n], lower bound of the distance to the nearest triangle over the radius; NULL: no triangles */
};

/* The slot of a side of a triangle. FIBRAD_NONE: the side belongs to no wall. */
static inline uint32_t fibrad_scene_slot(const fibrad_scene *scene, uint32_t side) {
    const uint8_t mesh = fibrad_side_mesh(&scene->mesh, side);
    return mesh != FIBRAD_NO_MESH ? fibrad_slot_of_mesh(mesh) : FIBRAD_NONE;
}

/* The slot of a wall, or of an opening with a number by FIBRAD_OPENING. FIBRAD_NONE: there is none. */
static inline uint32_t fibrad_wall_slot(const fibrad_scene *scene, uint32_t wall) {
    if (wall < scene->facts.walls) return scene->slot[wall];
    const uint32_t face = wall - scene->facts.walls;
    return fibrad_is_opening(&scene->container, face) ? face : FIBRAD_NONE;
}

/* Whether a scene exists and is complete. */
static inline bool fibrad_scene_ready(const fibrad_scene *scene) { return scene != NULL && scene->hash != 0; }

/* The id of the caller's sphere i. It seeds random paths. */
static inline uint64_t fibrad_scene_id(const fibrad_scene *scene, uint32_t i) {
    return scene->id != NULL ? scene->id[i] : i;
}

/* The id of the sphere at a position in scene order. Ids decide ties, so that the order of the spheres does not
 * matter. */
static inline uint64_t fibrad_scene_rank(const fibrad_scene *scene, uint32_t place) {
    return fibrad_scene_id(scene, scene->order[place]);
}

/* Whether spheres at two places in scene order are members of one clump. */
static inline bool fibrad_one_clump(const fibrad_scene *scene, uint32_t a, uint32_t b) {
    return scene->clump != NULL && scene->clump[a] != 0 && scene->clump[a] == scene->clump[b];
}

/* Whether sphere a at `at` comes before sphere b at `other` if both are equally far: the lower id comes first. Of two
 * images of one sphere that with the smaller coordinate comes first, the first of `axes` coordinates that differ. */
static inline bool fibrad_scene_tie(const fibrad_scene *scene, uint32_t a, const double *at, uint32_t b,
                                    const double *other, int axes) {
    const uint64_t rank = fibrad_scene_rank(scene, a), second = fibrad_scene_rank(scene, b);
    if (rank != second) return rank < second;
    for (int axis = 0; axis < axes; axis++)
        if (at[axis] != other[axis]) return at[axis] < other[axis];
    return false;
}

#endif
