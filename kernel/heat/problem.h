/* problem.h - the inside of a heat problem. SPDX-License-Identifier: MIT
 *
 * Bodies are the spheres in the order of the scene's places, then the walls by number, then the meshes, then what lies
 * beyond the patches of unbounded walls, then the surroundings. Each body has patches [first[b], first[b + 1]): none if
 * it is not there, four at a time making up a patch of the coarser level, and one alone beyond the walls. */
#ifndef FIBRAD_HEAT_PROBLEM_H
#define FIBRAD_HEAT_PROBLEM_H

#include "fibrad_heat.h"
#include "mesh/mesh_patch.h"
#include "scene/scene.h"
#include "work/work.h"

#define FIBRAD_HEAT_PATCHES_MAX 384   /* of a sphere */
#define FIBRAD_HEAT_TASK        1024u /* rays of a wall that are followed at a time */

#define FIBRAD_HEAT_FOUR   4u                  /* patches that make up one of the coarser level */
#define FIBRAD_HEAT_BLOCK  256u                /* patches of a wall that may share a pencil */
#define FIBRAD_HEAT_OTHERS 64u                 /* bodies that are no spheres, rounded up */
#define FIBRAD_HEAT_FINE   (UINT32_C(1) << 31) /* and the number of a fine four: a node */

/* Beams from one sphere to another, or to those of a block of patches that belong to one body, no sphere. Of those
 * followed some are kept; after this follow bundles, beams from four patches that make up one of the coarser level to
 * four, and strands, those of a bundle from one patch to one: a byte each, in the order of their bundles; then padding
 * to whole fours of bytes. */
typedef struct fibrad_heat_pencil {
    uint32_t body; /* the other row, or what fibrad_heat_other says */
    float share;   /* beams followed for each kept one */
    int16_t tilt;  /* 32767 times how many more of them had even directions than odd ones, over all followed */
    uint8_t bundles, strands;
} fibrad_heat_pencil;
typedef struct fibrad_heat_bundle {
    uint8_t from, to; /* fourths of the number of the first patch, the latter counted from the first of the other end */
    uint8_t count;    /* beams */
} fibrad_heat_bundle;

/* Bits of a strand: the last of its bundle; which of its four patches it leaves and meets; its beams less one. */
#define FIBRAD_HEAT_LAST    0x80u
#define FIBRAD_HEAT_STRAND  8u /* beams, the most */
#define FIBRAD_HEAT_STRANDS UINT8_MAX

/* Where the pencils of a row are in heat->pool, and one that ends on a row of another part [fours of bytes after
 * these]. */
typedef struct fibrad_heat_row {
    size_t begin, bytes;
} fibrad_heat_row;
typedef struct fibrad_heat_link {
    uint32_t sphere, at;
} fibrad_heat_link;

/* A fine four (fine.h): of which of the body's own fours it is a part, one of 2^level by 2^level, and in which row it
 * is. A row of fine fours of one body and level. */
typedef struct fibrad_heat_four {
    uint32_t body, own, level, x, y, row;
} fibrad_heat_four;
typedef struct fibrad_heat_fine {
    uint32_t body, level, first, count;
} fibrad_heat_fine;

/* The part of a wall that is cut into patches, a rectangle: of a plane across axis a along the axes a + 1 and a + 2
 * (modulo 3), of the cylinder around [turns, or fourths of the square that goes around] and along z. */
typedef struct fibrad_heat_wall {
    double low[2], size[2]; /* [L] */
    uint32_t squares[2];
    bool unbounded;
} fibrad_heat_wall;

/* The rays that a wall or a mesh sends out. */
typedef struct fibrad_heat_rays {
    double density; /* per area */
    uint32_t first, count;
} fibrad_heat_rays;

/* A ray from one patch of a wall or a mesh to another or the surroundings, and the area it stands for [L2]; 0 if it
 * meets a sphere, or starts outside the container. */
typedef struct fibrad_heat_ray {
    uint32_t from, to;
    double area;
} fibrad_heat_ray;

typedef enum fibrad_heat_phase {
    FIBRAD_HEAT_IDLE,  /* nothing is being solved */
    FIBRAD_HEAT_AREA,  /* the sweep in hand sums the areas of patches */
    FIBRAD_HEAT_FIRST, /* that of the radiosities to begin with */
    FIBRAD_HEAT_STEPS, /* that of a search direction */
    FIBRAD_HEAT_CHECK, /* that of the solution, for its error: even and odd directions apart */
    FIBRAD_HEAT_DONE
} fibrad_heat_phase;

struct fibrad_heat {
    fibrad_heat_config config;
    const fibrad_scene *scene;
    uint64_t hash;                                  /* of its contents */
    uint32_t spheres;                               /* of it */
    uint32_t given_bodies, slot[FIBRAD_BODIES_MAX]; /* of it */
    uint32_t openings;                              /* of it, by slot */
    uint32_t beams;                                 /* of one sphere: directions times points */
    uint32_t thin;                                  /* 2: of those that meet spheres every second one is kept; 1: all */
    uint32_t side;                                  /* patches of a sphere along an edge of its cube */
    uint32_t meshes, triangles;                     /* of it */
    double patch_area;                              /* about that of the patches of walls and meshes [L^2] */
    uint32_t bodies;                                /* spheres, FIBRAD_WALLS, meshes, FIBRAD_WALLS, 1 */
    uint32_t patches;                               /* all of them */
    uint32_t rays;                                  /* of all walls */
    uint32_t patches_capacity, rays_capacity, nodes_capacity;
    uint32_t rows;          /* spheres, and rows of fine fours */
    uint32_t nodes, fours;  /* in use; that are fine */
    uint32_t *root;         /* [spheres + FIBRAD_WALLS] the node of the first own four; FIBRAD_NONE: none is divided */
    uint32_t *node;         /* [nodes] the first of the four that a four is divided into, a fine four; 0: undivided */
    uint32_t *first_four;   /* [spheres + FIBRAD_WALLS + 1] the first fine one of each body */
    fibrad_heat_four *four; /* [fours] */
    fibrad_heat_fine *fine; /* [rows - spheres] */
    double balance[FIBRAD_HEAT_PATCHES_MAX / FIBRAD_HEAT_FOUR]; /* the part of a sphere's beams that leaves each of its
                                                                 * own fours, over that of its area */
    fibrad_heat_wall wall[FIBRAD_WALLS];
    fibrad_heat_rays sent[FIBRAD_SLOTS]; /* by slot */
    uint32_t of_mesh[FIBRAD_BODIES_MAX]; /* patches of each mesh */
    fibrad_mesh_cut *cut; /* [2 triangles] by the caller's numbers; patches counted from the first of all meshes */
    double *lift;         /* [patches of all meshes] emission less that of the body, where sides have temperatures */
    bool lifted[FIBRAD_BODIES_MAX]; /* of each mesh: its sides have */
    uint32_t *first;                /* [bodies + 1] */
    uint32_t *order;                /* [spheres] the caller's index of each, as the scene had it */
    uint32_t *sequence;             /* [spheres] of sweeps: those of each part, near each other */
    uint16_t *part;                 /* [rows] which part each one is of */
    unsigned char *traced;          /* [tasks of rays_capacity] 1: this task is */
    unsigned char *swept;           /* [parts] 1: this part is */
    uint16_t *leave;                /* [beams] which patch of its sphere each beam leaves: the same for all spheres */
    fibrad_heat_ray *ray;           /* [rays] */
    unsigned char *pool;  /* [room] the pencils of all spheres; then, aligned, links by the sphere they end on */
    size_t room;          /* bytes */
    size_t used, links;   /* bytes of pencils, and how many end in other parts; several threads at once add to them */
    fibrad_heat_row *row; /* [rows] */
    fibrad_heat_link *link;
    size_t *first_link; /* [rows + 2] */

    double *density;               /* [rows] beams that its surface sends out, per area */
    double *source;                /* [patches] what they send in the sweep in hand */
    double *gathered;              /* [patches] what beams bring */
    double *brought;               /* [parts][patches that are not of spheres] what those of each part bring */
    double *area;                  /* [patches] as the beams have it [L2] */
    double *radiosity, *net;       /* [patches] J, and the net flow N J */
    double *detail;                /* [patches] J less that of the coarser level */
    double *direction;             /* [patches] of the search */
    double *emissivity, *emission; /* [bodies] eps and E, the latter less that of the surroundings */
    double *drive, *hold;    /* [bodies] of unknown temperature: gives off drive - hold E; hold < 0: it is given */
    double *coarse, *power;  /* [bodies] net power at the coarser level, and extrapolated */
    double *coarse_emission; /* [bodies] E at the coarser level */
    double *temperature;     /* [bodies] given, or found; NaN: none */
    double *halves;          /* [bodies] by how much the power by even directions exceeds that by odd ones */
    double *reflected; /* [spheres][2] of the beams of each, what spheres reflect that they meet, and what walls */
    double *escaping;  /* [spheres] as halves, of what each gives to the surroundings */
    double wall_emissivity[FIBRAD_WALLS], wall_emission[FIBRAD_WALLS]; /* by slot */
    bool insulated[FIBRAD_HEAT_OTHERS];                                /* by body, from the first that is no sphere */

    fibrad_heat_phase phase;
    bool warm;                  /* the radiosities are those of a solution */
    bool areas;                 /* so are the areas, those of the beams as they are */
    bool afloat;                /* nothing says how high emissions are, but how they differ */
    double sigma, surroundings; /* of the sources */
    uint32_t group;             /* patches that share one J, the most: 1, 4, or PATCHES_MAX and more for whole bodies */
    double slope;               /* residual times preconditioned residual */
    double scale;               /* what the slope is compared with */
    double smallest;            /* a slope that is nothing but rounding */
    double tolerance;
    uint32_t sweeps, limit;
};

/* The patches of the wall or mesh of a slot, and what is beyond those of a wall; the first patch that is not of a
 * sphere, and the surroundings. */
static inline uint32_t fibrad_heat_body(const fibrad_heat *heat, uint32_t slot) {
    return heat->spheres + (slot < FIBRAD_WALLS ? slot : FIBRAD_WALLS + (slot - FIBRAD_MESHES));
}
static inline uint32_t fibrad_heat_beyond(const fibrad_heat *heat, uint32_t wall) {
    return heat->spheres + FIBRAD_WALLS + heat->meshes + wall;
}
/* The first patch of all meshes; by how much each patch of a body emits more than the body, NULL: not at all. */
static inline uint32_t fibrad_heat_first_meshed(const fibrad_heat *heat) {
    return heat->first[fibrad_heat_body(heat, FIBRAD_MESHES)];
}
static inline const double *fibrad_heat_lift(const fibrad_heat *heat, uint32_t body) {
    const uint32_t mesh = body - fibrad_heat_body(heat, FIBRAD_MESHES);
    const bool meshed = body >= fibrad_heat_body(heat, FIBRAD_MESHES) && mesh < heat->meshes;
    return meshed && heat->lifted[mesh] ? heat->lift + (heat->first[body] - fibrad_heat_first_meshed(heat)) : NULL;
}
static inline uint32_t fibrad_heat_others(const fibrad_heat *heat) { return heat->first[heat->spheres]; }
static inline uint32_t fibrad_heat_open(const fibrad_heat *heat) { return heat->patches - 1; }

/* The number by which pencils go to a patch that is no sphere's; its body, and the first patch of its block. */
static inline uint32_t fibrad_heat_other(const fibrad_heat *heat, uint32_t patch) {
    uint32_t body = 0;
    while (heat->first[heat->spheres + body + 1] <= patch) body++;
    return heat->rows + (patch - fibrad_heat_others(heat)) / FIBRAD_HEAT_BLOCK * FIBRAD_HEAT_OTHERS + body;
}
static inline uint32_t fibrad_heat_other_body(const fibrad_heat *heat, uint32_t other) {
    return heat->spheres + (other - heat->rows) % FIBRAD_HEAT_OTHERS;
}
static inline size_t fibrad_heat_other_block(const fibrad_heat *heat, uint32_t other) {
    return fibrad_heat_others(heat) + (size_t)(other - heat->rows) / FIBRAD_HEAT_OTHERS * FIBRAD_HEAT_BLOCK;
}

/* What reflects beyond the patches of wall k does so to the plane that faces it, or in an endless cylinder to itself;
 * FIBRAD_WALLS: to the surroundings. Between white walls nothing is emitted, and all comes from the surroundings. */
static inline uint32_t fibrad_heat_facing(const fibrad_heat *heat, uint32_t k) {
    const uint32_t other = k == FIBRAD_CYLINDER ? k : k ^ 1;
    const bool white = heat->wall_emissivity[k] == 0 && heat->wall_emissivity[other] == 0;
    return heat->wall[other].unbounded && !white ? other : FIBRAD_WALLS;
}

/* What wall k takes of the light that arrives there, reflected any number of times. */
static inline double fibrad_heat_taken_beyond(const fibrad_heat *heat, uint32_t k) {
    const uint32_t facing = fibrad_heat_facing(heat, k);
    const double eps = heat->wall_emissivity[k], other = facing < FIBRAD_WALLS ? heat->wall_emissivity[facing] : 1;
    return eps / (1 - (1 - eps) * (1 - other));
}

/* The part of the power of a body that is the surroundings': of themselves, of openings, of what is beyond walls. */
static inline double fibrad_heat_outside(const fibrad_heat *heat, uint32_t body) {
    const uint32_t k = body - heat->spheres, beyond = body - fibrad_heat_beyond(heat, 0);
    if (body < heat->spheres) return 0;
    if (k < FIBRAD_WALLS) return heat->openings >> k & 1;
    if (body < fibrad_heat_beyond(heat, 0)) return 0;
    if (beyond >= FIBRAD_WALLS) return 1;
    return fibrad_heat_facing(heat, beyond) < FIBRAD_WALLS ? 0 : 1 - fibrad_heat_taken_beyond(heat, beyond);
}

static inline const fibrad_heat_pencil *fibrad_heat_pencil_at(const unsigned char *at) { return (const void *)at; }

static inline const fibrad_heat_bundle *fibrad_heat_bundles(const fibrad_heat_pencil *pencil) {
    return (const void *)(pencil + 1);
}
static inline const uint8_t *fibrad_heat_strands(const fibrad_heat_pencil *pencil) {
    return (const void *)(fibrad_heat_bundles(pencil) + pencil->bundles);
}

/* Bytes of a pencil with its beams. */
static inline size_t fibrad_heat_pencil_bytes(const fibrad_heat_pencil *pencil) {
    return (sizeof *pencil + pencil->bundles * sizeof(fibrad_heat_bundle) + pencil->strands + 3) & ~(size_t)3;
}

/* Whether a body is a row of the same part as another one, so that a sweep may bring both ends of a beam. */
static inline bool fibrad_heat_same_part(const fibrad_heat *heat, uint32_t row, uint32_t body) {
    return body < heat->rows && heat->part[row] == heat->part[body];
}

/* The first fine patch of a body, and the first patch of a row. */
static inline uint32_t fibrad_heat_first_fine(const fibrad_heat *heat, uint32_t body) {
    return heat->first[body + 1] - FIBRAD_HEAT_FOUR * (heat->first_four[body + 1] - heat->first_four[body]);
}
static inline uint32_t fibrad_heat_first_of_row(const fibrad_heat *heat, uint32_t row) {
    if (row < heat->spheres) return heat->first[row];
    const fibrad_heat_fine *fine = &heat->fine[row - heat->spheres];
    return fibrad_heat_first_fine(heat, fine->body) + FIBRAD_HEAT_FOUR * (fine->first - heat->first_four[fine->body]);
}
static inline uint32_t fibrad_heat_body_of_row(const fibrad_heat *heat, uint32_t row) {
    return row < heat->spheres ? row : heat->fine[row - heat->spheres].body;
}

/* The number of the fine patch at u, v in [0, 1] of the body's own four; FIBRAD_NONE: that is not divided. */
static inline uint32_t fibrad_heat_fine_patch(const fibrad_heat *heat, uint32_t body, uint32_t own, double u,
                                              double v) {
    if (heat->root[body] == FIBRAD_NONE) return FIBRAD_NONE;
    uint32_t node = heat->node[heat->root[body] + own];
    if (node == 0) return FIBRAD_NONE;
    while (node < FIBRAD_HEAT_FINE) {
        const uint32_t right = 2 * u >= 1, up = 2 * v >= 1;
        u = 2 * u - right, v = 2 * v - up;
        node = heat->node[node + 2 * right + up];
    }
    return FIBRAD_HEAT_FOUR * (node - FIBRAD_HEAT_FINE) + (2 * u >= 1 ? 2u : 0u) + (2 * v >= 1 ? 1u : 0u);
}

/* Whether a sphere's own four is divided. */
static inline bool fibrad_heat_is_divided(const fibrad_heat *heat, uint32_t sphere, uint32_t own) {
    return heat->root[sphere] != FIBRAD_NONE && heat->node[heat->root[sphere] + own] != 0;
}

/* Where a part begins of n things. */
static inline uint32_t fibrad_heat_part_begin(const fibrad_heat *heat, uint32_t n, uint32_t part) {
    return (uint32_t)((uint64_t)n * part / heat->config.parts);
}

/* Whether the scene is still the one the beams were followed in. */
static inline bool fibrad_heat_scene_kept(const fibrad_heat *heat) { return heat->scene->hash == heat->hash; }

/* solve.c: makes the next sweep the first one of a solution. */
void fibrad_heat_start(fibrad_heat *heat);

/* The temperature of an emission counted from that of the surroundings; NaN: it would be below zero. */
double fibrad_heat_temperature(const fibrad_heat *heat, double emission);

#endif
