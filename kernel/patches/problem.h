/* problem.h - the inside of a heat problem. SPDX-License-Identifier: MIT
 *
 * Bodies are all surfaces, in this order:
 *   spheres         [spheres], in scene order
 *   walls           [FIBRAD_WALLS], planes and the cylinder by slot, openings included
 *   meshes          [meshes]
 *   beyond          [FIBRAD_WALLS], of each endless wall the part beyond its patches
 *   surroundings    1
 * Body b has the patches first[b] to first[b + 1] - 1. A body that does not exist has none. Four patches at a time (a
 * "four") make up one patch of the coarser level. A body of `beyond` has one patch. */
#ifndef FIBRAD_PATCHES_PROBLEM_H
#define FIBRAD_PATCHES_PROBLEM_H

#include "base/sobol.h"
#include "contact/contact.h"
#include "patches/harmonics.h"
#include "rings/rings.h"
#include "patches/sphere_patch.h"
#include "workspace/workspace.h"

#define FIBRAD_HEAT_TASK 1024u /* rays of walls in one task */

#define FIBRAD_HEAT_FOUR            4u   /* patches of a four */
#define FIBRAD_HEAT_BLOCK           256u /* patches of a wall that may be in one pencil */
#define FIBRAD_HEAT_OTHERS          64u  /* bodies that are not spheres, rounded up */
#define FIBRAD_HEAT_EXTRAPOLATION   0.4  /* extrapolation adds this part of the difference of both levels */
#define FIBRAD_HEAT_FIRST_TOLERANCE 1e-2 /* tolerance of the first temperatures of spheres that conduct */

#define FIBRAD_HEAT_FINE (UINT32_C(1) << 31) /* plus the number of a fine four: a node without children */

/* A pencil has the beams from one row to another row, or to a block of patches of a body that is not a sphere. Some of
 * the beams that were followed are kept. In memory a pencil is followed by
 *   bundles  beams from a four to a four
 *   strands  beams of a bundle from one patch to one patch, a byte each, in the order of the bundles
 *   padding  to a multiple of four bytes */
typedef struct fibrad_heat_pencil {
    uint32_t body; /* the other row, or fibrad_heat_other of the block */
    float weight;  /* beams followed for each beam kept */
    int16_t tilt;  /* 32767 (even - odd)/all, numbers of beams followed by the parity of their directions */
    uint8_t bundles, strands;
} fibrad_heat_pencil;
typedef struct fibrad_heat_bundle {
    uint8_t from, to; /* numbers of the fours: of this row, and of the other row or the block */
    uint8_t count;    /* beams */
} fibrad_heat_bundle;

/* Bits of a strand: FIBRAD_HEAT_LAST in the last strand of a bundle, the patch of the four that the strand leaves and
 * the one that it meets, number of beams - 1. */
#define FIBRAD_HEAT_LAST    0x80u
#define FIBRAD_HEAT_STRAND  8u /* largest number of beams */
#define FIBRAD_HEAT_STRANDS UINT8_MAX

/* Position of the pencils of a row in heat->pencils.pool [bytes]. A link is a pencil that ends on a row of another
 * part. Its position `at` is in units of four bytes after `begin` of the row. */
typedef struct fibrad_heat_row {
    size_t begin, bytes;
    bool complete; /* every sphere that no beam meets has an exact factor */
} fibrad_heat_row;
typedef struct fibrad_heat_link {
    uint32_t sphere, at;
} fibrad_heat_link;

/* A fine four (subdivision.h). The own four of its body is divided into 2^level by 2^level fours; x and y number them.
 * A fibrad_heat_fine is a row of fine fours of one body and one level. */
typedef struct fibrad_heat_four {
    uint32_t body, own, level, x, y, row;
} fibrad_heat_four;
typedef struct fibrad_heat_fine {
    uint32_t body, level, first, count;
} fibrad_heat_fine;

/* The rectangle of a wall that is cut into patches. On a plane across axis a its sides lie along the axes a + 1 and
 * a + 2 modulo 3. On the cylinder they lie around the axis [turns, or quarters of the square around] and along it. */
typedef struct fibrad_heat_wall {
    double low[2], size[2]; /* L, lower ends and lengths of the sides */
    uint32_t squares[2];    /* patches along the sides */
    bool unbounded;         /* the wall is endless */
} fibrad_heat_wall;

/* The rays that a wall sends out. */
typedef struct fibrad_heat_rays {
    double density; /* 1/L^2, rays per area */
    uint32_t first, count;
} fibrad_heat_rays;

/* A ray from a patch of a wall to a patch of a wall or to the surroundings, or from a mesh to a patch of a sphere.
 * `area` [L^2] is the area that the ray stands for. It is 0 if the ray starts outside the container, or if it meets a
 * sphere whose beams alone tell what both exchange (fibrad_heat_sees). */
typedef struct fibrad_heat_ray {
    uint32_t from, to;
    double area;
} fibrad_heat_ray;

/* What the beams of a sphere tell of the error of its power. */
typedef struct fibrad_heat_seen {
    double reflected[2]; /* beams times reflectivity of what they meet: spheres, walls */
    double escaping;     /* power to the surroundings by even directions minus that by odd directions */
    double met;          /* beams that meet spheres */
    double rays;         /* squares of powers by rays of meshes */
    double squares,
        one_parity; /* squares of even minus odd beams to each sphere; those of spheres met by one kind alone */
} fibrad_heat_seen;

typedef enum fibrad_heat_phase {
    FIBRAD_HEAT_IDLE,  /* no solution was begun */
    FIBRAD_HEAT_AREA,  /* this sweep sums the areas of patches */
    FIBRAD_HEAT_FIRST, /* this sweep is of the first radiosities */
    FIBRAD_HEAT_STEPS, /* this sweep is of a search direction */
    FIBRAD_HEAT_CHECK, /* this sweep is of the solution, even and odd directions apart, for the error */
    FIBRAD_HEAT_DONE
} fibrad_heat_phase;

/* Fours that are divided, and the fine fours that they are divided into (subdivision.h). */
typedef struct fibrad_heat_division {
    uint32_t nodes_capacity, nodes, fours; /* room for nodes; nodes in use; number of fine fours */
    uint32_t *root;         /* [spheres + FIBRAD_WALLS], node of the first own four; FIBRAD_NONE: none is divided */
    uint32_t *node;         /* [nodes], first of four children, or FIBRAD_HEAT_FINE + a fine four; 0: not divided */
    uint32_t *first_four;   /* [spheres + FIBRAD_WALLS + 1], first fine four of each body */
    fibrad_heat_four *four; /* [fours] */
    uint16_t *on_patch;     /* [fours], of spheres: own patch on which the four lies */
    fibrad_heat_fine *fine; /* [rows - spheres] */
    /* share of a sphere's beams that leaves each of its own fours, over the share of its area */
    double balance[FIBRAD_HEAT_PATCHES_MAX / FIBRAD_HEAT_FOUR];
} fibrad_heat_division;

/* What rows and bodies exchange. Several threads add to `used` and `links` at the same time. */
typedef struct fibrad_heat_pencils {
    unsigned char *pool; /* [room], pencils of all rows; then, aligned, links by the row they end on */
    size_t room, used;   /* bytes; bytes of pencils */
    fibrad_heat_row *row;
    size_t links;
    fibrad_heat_link *link;
    size_t *first_link; /* [rows + 2] */
} fibrad_heat_pencils;

/* The least and the largest emission on a sphere's surface minus the mean emission, at both levels. */
typedef struct fibrad_heat_span {
    double low, high;                  /* of patches */
    double least, largest;             /* in rings (sphere_conduction.c) */
    bool open_low, open_high;          /* these places do not face a neighbour */
    uint32_t neighbours;               /* number of those that are near */
    double coldest_spot, hottest_spot; /* K, of contacts at their places, minus the mean; 0: none */
} fibrad_heat_span;

/* What is given for a solution. Emissions E are differences from the emission of the surroundings. */
typedef struct fibrad_heat_given {
    double *emissivity, *emission; /* [bodies], eps and E */
    double *given_power,
        *storage; /* [bodies], storage < 0: E is given; else E is unknown, and given_power - storage E given off */
    double *temperature;    /* K, [bodies], given or found; NaN: none */
    double *conductivity;   /* sigma K^3 L, [spheres] */
    double *unevenness;     /* [spheres], 4 r sigma T^3/conductivity; 0: at one temperature (sphere_conduction.c) */
    bool conducts;          /* some sphere has a finite conductivity */
    double first_tolerance; /* tolerance while unevennesses are of temperatures still to be found better */
    double wall_emission[FIBRAD_WALLS]; /* by slot; 0: the wall emits nothing */
    bool insulated[FIBRAD_HEAT_OTHERS]; /* by body, from the first wall on */
    double *excess; /* [patches of all meshes], emission minus that of the body, if sides have temperatures */
    bool has_excess[FIBRAD_WALLS_MAX];  /* [meshes], whether sides of the mesh have temperatures */
    bool has_sides[FIBRAD_WALLS_MAX];   /* [meshes], whether temperatures of sides are to be found */
    bool sides;                         /* some mesh has such sides; the next three are of their search: */
    bool passed, held, below;           /* both levels were searched; some temperature or film is given; T < 0 */
    double changed;                     /* square of what has changed between two searches of the finer level */
    fibrad_heat_sources asked;          /* the caller's, for arrays of sides, contact_temperature, no_errors */
    double of_others[FIBRAD_WALLS_MAX]; /* K, [meshes], of sides that have no temperature of their own */
    double beyond[FIBRAD_WALLS_MAX];    /* [meshes], what fluxes have besides those of patches, if no power is coarse */
    double *still, *answer; /* [patches of all meshes], emission without arriving radiation, and its slope */
    unsigned char *within;  /* [patches of all meshes], 1: of the side of the patch before */
    const double *light;    /* [patches] power that arrives from outside, the caller's; NULL: none */
    const double *absorbed; /* [patches] light that patches have absorbed, the caller's; NULL: none */
    bool free_level;        /* the sources fix differences of emissions, but not their level */
    double sigma, surroundings;
    double tolerance, settled; /* of the residual; of what steps to come would change in powers, over these */
    uint32_t limit;            /* sweeps after which to stop */
} fibrad_heat_given;

/* A solution, by conjugate gradients. */
typedef struct fibrad_heat_solution {
    fibrad_heat_phase phase;
    bool warm;               /* radiosities are those of a solution */
    bool areas;              /* areas are those of the present beams */
    bool sends_back;         /* some patch has a `back` above 0 */
    uint32_t group;          /* patches that have one J: 1, 4, or all of a body */
    uint32_t sweeps;         /* so far */
    double slope;            /* residual times preconditioned residual */
    double along;            /* residual times search direction; the slope, if the problem is linear */
    double curvature;        /* of the last search direction */
    double scale;            /* the slope is compared with this */
    double smallest;         /* a slope below this is rounding error */
    double ratio;            /* how much smaller residuals became in the last step, at most 1 */
    double *area;            /* L^2, [patches], by the beams */
    double *radiosity, *net; /* [patches], J and the net flow N J */
    double *detail;          /* [patches], J minus J of the coarser level */
    double *direction;       /* [patches], search direction */
    double *source;          /* [patches], sent in this sweep */
    double *gathered;        /* [patches], received in this sweep */
    double *brought;         /* [parts][patches that are not of spheres], received from each part */
    double *back;            /* 1/L^2, [patches that are not of spheres], 1/area of those that send back all; or 0 */
    double *coarse, *power;  /* [bodies], net power at the coarser level, and extrapolated */
    double *coarse_emission; /* [bodies], E at the coarser level */
    double *drift, *left;    /* [bodies], change of the power in the last step, and what later steps would change */
    double *unsettled;       /* [bodies], what `left` of both levels makes of the extrapolated power */
    double sent_drift, sent_left, sent_unsettled; /* the same for what all surfaces send out */
    fibrad_heat_span *span;                       /* [spheres] */
    bool steps; /* a step in time, or no errors are wanted: extremes are found when they are asked for */
} fibrad_heat_solution;

/* Contacts that act at their places on spheres that conduct. The arrays are the caller's. */
typedef struct fibrad_heat_spots {
    const double *given;          /* [contacts], conductances between half-spaces */
    double *conductance;          /* [contacts], between the means of both surfaces */
    double *offset, *flow, *next; /* [contacts], flows from first to second: at equal means; so far; found last */
    double *doubt;                /* [contacts], square of the error of a flow from radiation about its spots */
    double *entering;             /* [patches], power that enters at flow; NULL: contacts act on means of surfaces */
} fibrad_heat_spots;

/* A part of a sphere that lies inside another member of its clump: where normals n have n.at > beyond. */
typedef struct fibrad_heat_cap {
    double at[3], beyond;
} fibrad_heat_cap;

/* The clumps of the scene (clump_caps.c). A clump of one sphere is none. */
typedef struct fibrad_heat_clumps {
    bool some;            /* there are clumps; otherwise the arrays are not used */
    uint32_t *leader;     /* [spheres], first body of the clump; FIBRAD_NONE: the sphere is alone */
    size_t *first_cap;    /* [spheres + 1] */
    fibrad_heat_cap *cap; /* [room] */
    size_t room;
} fibrad_heat_clumps;

/* From which errors are estimated. */
typedef struct fibrad_heat_samples {
    double *halves;         /* [bodies], power by even directions minus power by odd directions */
    fibrad_heat_seen *seen; /* [spheres] */
} fibrad_heat_samples;

struct fibrad_heat {
    fibrad_heat_config config;
    const fibrad_scene *scene;
    uint64_t hash; /* of the scene */

    /* bodies and their patches */
    uint32_t spheres, meshes, triangles;          /* numbers of them */
    uint32_t given_walls, slot[FIBRAD_WALLS_MAX]; /* number of walls, and their slots */
    uint32_t openings;                            /* bit k: slot k is an opening */
    uint32_t bodies;                              /* number of bodies, see the top of this file */
    uint32_t patches, patches_capacity;           /* number of patches, and room */
    uint32_t side;                                /* patches of a sphere along an edge of its cube */
    double patch_area;                            /* L^2, about the area of a patch of a wall */
    uint32_t *first;                              /* [bodies + 1], first patch of each body */
    uint32_t *order;                              /* [spheres], the caller's index, a copy of that of the scene */
    fibrad_heat_wall wall[FIBRAD_WALLS];          /* by slot */
    uint32_t of_mesh[FIBRAD_WALLS_MAX];           /* patches of each mesh */
    fibrad_mesh_cut *cut; /* [2 triangles], by the caller's numbers; patches from first_meshed on */
    fibrad_heat_division division;
    fibrad_harmonics harmonics[2]; /* on patches, and on fours for the coarser level */
    fibrad_rings *rings;           /* made if spheres conduct */
    bool ringed;                   /* rings and normal are made */
    fibrad_rings_work *near;       /* [parts] */
    double *normal;                /* [patches of a sphere][4][3], normals at four points of each, made as well */

    /* beams of spheres and rays of walls */
    uint32_t rows;                       /* number of rows: spheres, then rows of fine fours */
    uint32_t beams;                      /* beams of one sphere: directions times points */
    uint32_t thin;                       /* 1: all beams to spheres are kept; 2: every second one */
    uint32_t rays, rays_capacity;        /* number of rays of all walls, and room */
    double *density;                     /* 1/L^2, [rows], beams per area of the surface */
    uint16_t *leave;                     /* [beams], patch that a beam leaves, the same for all spheres */
    fibrad_heat_ray *ray;                /* [rays] */
    uint32_t *met, *first_met;           /* [rays], rays to spheres by part; [parts + 2] */
    fibrad_heat_rays sent[FIBRAD_SLOTS]; /* by slot */
    fibrad_sobol sobol;                  /* of rays from meshes */
    fibrad_heat_pencils pencils;

    /* tasks */
    uint32_t *sequence;    /* [spheres], order of sweeps: by part, neighbours in space together */
    uint16_t *part;        /* [rows], part of each row */
    unsigned char *traced; /* [tasks of rays_capacity], 1: the task is traced */
    unsigned char *swept;  /* [parts], 1: the part is swept */

    fibrad_heat_given sources;
    fibrad_heat_solution solution;
    fibrad_heat_samples samples;
    fibrad_contacts contacts; /* of the solution; nodes are bodies, of a clump its leader; count 0: none */
    uint32_t *end;            /* body by the caller's number of a sphere or wall; without clumps contacts.node */
    double *film, *gas;       /* [bodies], as in contacts, but of each member of a clump; without clumps these */
    fibrad_heat_clumps clumps;
    fibrad_heat_spots spots;
    fibrad_contacts *checked; /* of the sources that were checked last: count, node, kind and anchored */
    uint32_t *checked_node;   /* arrays of `checked` */
    unsigned char *checked_kind;
    fibrad_contact_parts joined; /* of the same */
};

/* The body of a slot, and the body beyond the patches of an endless wall. */
static inline uint32_t fibrad_heat_body(const fibrad_heat *heat, uint32_t slot) {
    return heat->spheres + (slot < FIBRAD_WALLS ? slot : FIBRAD_WALLS + (slot - FIBRAD_MESHES));
}
static inline uint32_t fibrad_heat_beyond(const fibrad_heat *heat, uint32_t wall) {
    return heat->spheres + FIBRAD_WALLS + heat->meshes + wall;
}
/* Whether the temperature of a body is to be found. */
static inline bool fibrad_heat_is_free(const fibrad_heat *heat, uint32_t body) {
    return heat->sources.storage[body] >= 0;
}

/* Whether a point of a sphere, by its normal, lies inside another member of its clump. */
static inline bool fibrad_heat_is_hidden(const fibrad_heat *heat, uint32_t sphere, const double n[3]) {
    bool hidden = false;
    for (size_t k = heat->clumps.first_cap[sphere]; k < heat->clumps.first_cap[sphere + 1] && !hidden; k++) {
        const fibrad_heat_cap *cap = &heat->clumps.cap[k];
        hidden = n[0] * cap->at[0] + n[1] * cap->at[1] + n[2] * cap->at[2] > cap->beyond;
    }
    return hidden;
}

/* Whether a body is a member of a clump, and whether it takes its temperature from the clump's leader. */
static inline bool fibrad_heat_is_member(const fibrad_heat *heat, uint32_t body) {
    return heat->clumps.some && body < heat->spheres && heat->clumps.leader[body] != FIBRAD_NONE;
}
static inline bool fibrad_heat_follows(const fibrad_heat *heat, uint32_t body) {
    return fibrad_heat_is_member(heat, body) && heat->clumps.leader[body] != body;
}

/* The sum of values over the patches of a body. */
static inline double fibrad_heat_sum(const fibrad_heat *heat, uint32_t body, const double *value) {
    double sum = 0;
    for (uint32_t a = heat->first[body]; a < heat->first[body + 1]; a++) sum += value[a];
    return sum;
}

/* The mean by area of values on the patches of a body. */
static inline double fibrad_heat_mean(const fibrad_heat *heat, uint32_t body, const double *value) {
    double sum = 0, area = 0;
    for (uint32_t a = heat->first[body]; a < heat->first[body + 1]; a++)
        sum += heat->solution.area[a] * value[a], area += heat->solution.area[a];
    return area > 0 ? sum / area : 0;
}

/* The first patch of all meshes. */
static inline uint32_t fibrad_heat_first_meshed(const fibrad_heat *heat) {
    return heat->first[fibrad_heat_body(heat, FIBRAD_MESHES)];
}
/* The excess of the patches of a body. NULL: no side has a temperature of its own. */
static inline const double *fibrad_heat_excess(const fibrad_heat *heat, uint32_t body) {
    const uint32_t mesh = body - fibrad_heat_body(heat, FIBRAD_MESHES);
    const bool meshed = body >= fibrad_heat_body(heat, FIBRAD_MESHES) && mesh < heat->meshes;
    return meshed && heat->sources.has_excess[mesh]
               ? heat->sources.excess + (heat->first[body] - fibrad_heat_first_meshed(heat))
               : NULL;
}
/* Whether the temperatures of sides of a body are found in the present search. On the coarser level they are given. */
static inline bool fibrad_heat_finds_sides(const fibrad_heat *heat, uint32_t body) {
    const uint32_t mesh = body - fibrad_heat_body(heat, FIBRAD_MESHES);
    return body >= fibrad_heat_body(heat, FIBRAD_MESHES) && mesh < heat->meshes && heat->sources.has_sides[mesh] &&
           heat->solution.group == 1;
}
/* The first patch that is not of a sphere, and the patch of the surroundings. */
static inline uint32_t fibrad_heat_others(const fibrad_heat *heat) { return heat->first[heat->spheres]; }
static inline uint32_t fibrad_heat_open(const fibrad_heat *heat) { return heat->patches - 1; }

/* The number by which a pencil names the block of a patch that is not of a sphere. The body and the first patch of the
 * block follow from this number. */
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

/* The slot to which wall k reflects beyond its patches: the opposite plane, or itself for an endless cylinder.
 * FIBRAD_WALLS: to the surroundings. Between two walls of emissivity 0, all radiation comes from the surroundings. */
static inline uint32_t fibrad_heat_facing(const fibrad_heat *heat, uint32_t k) {
    const uint32_t other = k == FIBRAD_CYLINDER ? k : fibrad_face_opposite(k);
    const double *emissivity = heat->sources.emissivity + heat->spheres;
    const bool white = emissivity[k] == 0 && emissivity[other] == 0;
    return heat->wall[other].unbounded && !white ? other : FIBRAD_WALLS;
}

/* The fraction of radiation arriving beyond the patches of wall k that wall k absorbs, after any number of reflections.
 * */
static inline double fibrad_heat_taken_beyond(const fibrad_heat *heat, uint32_t k) {
    const uint32_t facing = fibrad_heat_facing(heat, k);
    const double *emissivity = heat->sources.emissivity + heat->spheres;
    const double eps = emissivity[k], other = facing < FIBRAD_WALLS ? emissivity[facing] : 1;
    return eps / (1 - (1 - eps) * (1 - other));
}

/* The fraction of the power of a body that belongs to the surroundings: 1 of the surroundings and of openings, some of
 * the bodies beyond endless walls. */
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

/* Whether a body is a row of the same part as another row. A sweep then serves both ends of a beam. */
static inline bool fibrad_heat_same_part(const fibrad_heat *heat, uint32_t row, uint32_t body) {
    return body < heat->rows && heat->part[row] == heat->part[body];
}

/* The first fine patch of a body, and the first patch of a row. */
static inline uint32_t fibrad_heat_first_fine(const fibrad_heat *heat, uint32_t body) {
    return heat->first[body + 1] -
           FIBRAD_HEAT_FOUR * (heat->division.first_four[body + 1] - heat->division.first_four[body]);
}
static inline uint32_t fibrad_heat_first_of_row(const fibrad_heat *heat, uint32_t row) {
    if (row < heat->spheres) return heat->first[row];
    const fibrad_heat_fine *fine = &heat->division.fine[row - heat->spheres];
    return fibrad_heat_first_fine(heat, fine->body) +
           FIBRAD_HEAT_FOUR * (fine->first - heat->division.first_four[fine->body]);
}
static inline uint32_t fibrad_heat_body_of_row(const fibrad_heat *heat, uint32_t row) {
    return row < heat->spheres ? row : heat->division.fine[row - heat->spheres].body;
}

/* Few beams of a large sphere meet a small mesh. So the rays of the mesh that meet the sphere count as well, if there
 * are enough of them per area. Near a mesh, beams are spread more evenly than rays, so that one is worth EVEN rays.
 * Beams to a mesh farther than this many radii come in bundles of a few directions. */
#define FIBRAD_HEAT_EVEN 16.0
#define FIBRAD_HEAT_FAR  4.0

/* Parts of a sphere behind a mesh exchange with the side of the mesh before them. There rays do not tell what beams
 * do. So rays do not count if the mesh comes this near to the centre, in radii. */
#define FIBRAD_HEAT_PIERCED .99

/* Rays per area of mesh m that tell what it exchanges with a row, as beams of the row do. 0: these alone tell. */
static inline double fibrad_heat_sees(const fibrad_heat *heat, uint32_t m, uint32_t row) {
    const uint32_t owner = fibrad_heat_body_of_row(heat, row);
    const double density = heat->sent[FIBRAD_MESHES + m].density;
    const double clear = owner < heat->spheres ? heat->scene->clear[owner] : 1;
    const double least = clear > FIBRAD_HEAT_FAR ? heat->density[row] : FIBRAD_HEAT_EVEN * heat->density[row];
    return density > least && clear >= FIBRAD_HEAT_PIERCED ? density : 0;
}

/* The same for what the pencils of the row name `other`, which is no row. */
static inline double fibrad_heat_seeing(const fibrad_heat *heat, uint32_t other, uint32_t row) {
    const uint32_t b = (other - heat->rows) % FIBRAD_HEAT_OTHERS;
    return b >= FIBRAD_WALLS && b - FIBRAD_WALLS < heat->meshes ? fibrad_heat_sees(heat, b - FIBRAD_WALLS, row) : 0;
}

/* The number of beams that a pencil stands for. */
static inline double fibrad_heat_beams_of(const fibrad_heat_pencil *pencil) {
    const fibrad_heat_bundle *bundle = fibrad_heat_bundles(pencil);
    uint32_t beams = 0;
    for (uint32_t k = 0; k < pencil->bundles; k++) beams += bundle[k].count;
    return (double)pencil->weight * beams;
}

/* The row of a fine patch by its number among all fine patches. */
static inline uint32_t fibrad_heat_row_of_fine(const fibrad_heat *heat, uint32_t fine) {
    return heat->division.four[fine / FIBRAD_HEAT_FOUR].row;
}

/* The patch of a body at u, v, 0 to 1, of one of its own fours, fine or not. patch: the own patch there. */
static inline uint32_t fibrad_heat_patch_in_four(const fibrad_heat *heat, uint32_t body, uint32_t patch, double u,
                                                 double v) {
    const uint32_t root = heat->division.root[body];
    uint32_t node = root != FIBRAD_NONE ? heat->division.node[root + patch / FIBRAD_HEAT_FOUR] : 0;
    if (node == 0) return heat->first[body] + patch;
    while (node < FIBRAD_HEAT_FINE) {
        const uint32_t right = 2 * u >= 1, up = 2 * v >= 1;
        u = 2 * u - right, v = 2 * v - up;
        node = heat->division.node[node + 2 * right + up];
    }
    return fibrad_heat_first_fine(heat, body) +
           FIBRAD_HEAT_FOUR * (node - FIBRAD_HEAT_FINE - heat->division.first_four[body]) + (2 * u >= 1 ? 2u : 0u) +
           (2 * v >= 1 ? 1u : 0u);
}

/* The patch of a sphere at a place on a face of its cube [squares], fine or not. patch: the own patch there. */
static inline uint32_t fibrad_heat_patch_on_face(const fibrad_heat *heat, uint32_t sphere, uint32_t patch,
                                                 const double at[2]) {
    const double last = heat->side / 2 - 1, u = at[0] / 2, v = at[1] / 2;
    return fibrad_heat_patch_in_four(heat, sphere, patch, u - fibrad_min(fibrad_floor(u), last),
                                     v - fibrad_min(fibrad_floor(v), last));
}

/* The patch of a sphere at a normal. */
static inline uint32_t fibrad_heat_patch_at(const fibrad_heat *heat, uint32_t sphere, const double normal[3]) {
    double at[2];
    const uint32_t face = fibrad_patch_place(normal, heat->side, at);
    return fibrad_heat_patch_on_face(heat, sphere,
                                     fibrad_patch_number(face, (uint32_t)at[0], (uint32_t)at[1], heat->side), at);
}

/* The number of a patch of a body among all fine patches. FIBRAD_NONE: the patch is not fine. */
static inline uint32_t fibrad_heat_fine_number(const fibrad_heat *heat, uint32_t body, uint32_t patch) {
    const uint32_t begin = fibrad_heat_first_fine(heat, body);
    return patch >= begin && patch < heat->first[body + 1]
               ? FIBRAD_HEAT_FOUR * heat->division.first_four[body] + (patch - begin)
               : FIBRAD_NONE;
}

/* Whether an own four of a sphere is divided. */
static inline bool fibrad_heat_is_divided(const fibrad_heat *heat, uint32_t sphere, uint32_t own) {
    return heat->division.root[sphere] != FIBRAD_NONE && heat->division.node[heat->division.root[sphere] + own] != 0;
}

/* The first of n things that belongs to a part. */
static inline uint32_t fibrad_heat_part_begin(const fibrad_heat *heat, uint32_t n, uint32_t part) {
    return (uint32_t)((uint64_t)n * part / heat->config.parts);
}

/* Whether the scene is still the one in which the beams were followed. */
static inline bool fibrad_heat_scene_kept(const fibrad_heat *heat) { return heat->scene->hash == heat->hash; }

#endif
