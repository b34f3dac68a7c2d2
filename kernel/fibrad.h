/* fibrad.h - view factors for thermal radiation between spheres. No heap, no I/O, no threads, no mutable globals.
 *
 * Index        what for                                 functions and types
 *   status     what a call returned                     fibrad_status_text, fibrad_version
 *   memory     a block of bytes, fixed or growing       fibrad_memory, fibrad_resize
 *   isa        instruction sets, chosen at run time     fibrad_isa_best, _name
 *   direction  directions spread evenly over a sphere   fibrad_direction
 *   pair       two spheres, nothing in between          fibrad_pair_exact
 *   scene      spheres and walls                        fibrad_scene_size, _init, _describe, _body_area, _sphere
 *   work       scratch memory of one thread             fibrad_work, FIBRAD_WORK_BYTES
 *   row        view factors from one sphere to all      fibrad_beam_row, fibrad_cast_row, fibrad_directions_for
 *   rows       a collection of rows                     fibrad_rows_add, _clear
 *   matrix     all rows: averaged, reciprocal, closed   fibrad_matrix_size, _init, _average, _close, _read,
 *                                                       _reciprocity
 *   drift      which rows may stay when spheres move    fibrad_drift_row, _partners
 *   exchange   absorbed after reflections (grey)        fibrad_exchange_row, _body, _body_mean, _displacement
 * fibrad_heat.h has net powers and temperatures, fibrad_mesh.h walls of triangles, fibrad_part.h parts of beds,
 * fibrad_surface.h the method of Bao, Gao and Tan, fibrad_furnace.h a furnace.
 *
 * One row   fibrad_scene_init, fibrad_beam_row. All rows: per thread a fibrad_work and a fibrad_rows; fibrad_beam_row
 *           for every sphere; fibrad_matrix_init, _close, _read. docs/embedding.md has complete programs.
 * Units     One length unit L, the caller's choice; angles in radians; factors dimensionless; temperatures absolute.
 *           x[n] is an array of n elements; [a, b) and [a, b] are the range of values.
 * Memory    The caller owns every block, of any alignment, and keeps it in place while it is used; there is no free.
 *           An `_init` function lays its object out in a block and returns a pointer into it; its twin `_size` returns
 *           the bytes that takes, or 0 where `_init` would return an error other than FIBRAD_E_SIZE.
 * Threads   Const objects may be shared between threads. A fibrad_work or fibrad_rows belongs to one thread at a time.
 * Errors    Functions that can fail return FIBRAD_OK or a negative fibrad_status; then outputs are untouched, except
 *           where a comment says otherwise. Null pointers are FIBRAD_E_ARGUMENT; a call too early or repeated, or for
 *           a scene that is not complete or has changed, is FIBRAD_E_STATE.
 * Defaults  Structures may be zeroed but for the fields one needs; comments say what 0 stands for.
 * Bits      Results depend on the arguments alone: not on thread, instruction set, compiler or optimisation level.
 *
 * SPDX-License-Identifier: MIT */
#ifndef FIBRAD_H
#define FIBRAD_H

#include <stddef.h>
#include <stdint.h>
#ifdef __cplusplus
extern "C" {
#endif

#define FIBRAD_VERSION "0.2.0"

#define FIBRAD_STEFAN_BOLTZMANN 5.670374419e-8 /* W/(m2 K4) */

/* ---- status ---------------------------------------------------------------------------------------------------- */
typedef enum fibrad_status {
    FIBRAD_OK = 0,
    FIBRAD_E_ARGUMENT = -1,     /* a null pointer, a value out of its range, NaN or infinity */
    FIBRAD_E_SIZE = -2,         /* the block is smaller than the `_size` function asks for */
    FIBRAD_E_ALIGNMENT = -3,    /* reserved; no function asks for alignment */
    FIBRAD_E_CAPACITY = -4,     /* an output is too small; the length (row) or bytes (rows) needed are written */
    FIBRAD_E_TABLE = -5,        /* that number of samples is not built in */
    FIBRAD_E_GEOMETRY = -6,     /* equal centres, the centre of one sphere inside another, a sphere beyond an opening */
    FIBRAD_E_WORK = -7,         /* fixed work memory is too small; the bytes needed are written */
    FIBRAD_E_STATE = -8,        /* a call is missing, too early or repeated, or the scene has changed */
    FIBRAD_E_ISA = -9,          /* this build or this machine does not have that instruction set */
    FIBRAD_E_UNSUPPORTED = -10, /* a valid request that this version does not compute */
    FIBRAD_E_MEMORY = -11,      /* a resize function or the heap had no more memory */
    FIBRAD_E_CANCELLED = -12,   /* a progress function asked to stop */
    FIBRAD_E_UNSOLVABLE = -13,  /* no temperatures give bodies the powers that were asked for */
    FIBRAD_E_BACK = -14,        /* a side of a triangle was seen that no body has; its number is written */
    FIBRAD_E_SUM = -15,         /* a row did not add up to one within 1e-9: a fault of this library, or of row parts
                                   that were changed */
    FIBRAD_E_ENDLESS = -16      /* walls go on for ever where the bed is not closed: an opening is missing */
} fibrad_status;                /* the numbers never change their meaning */

/* One English sentence for any number, never NULL; FIBRAD_VERSION of the library linked in. No errors. */
const char *fibrad_status_text(int status);
const char *fibrad_version(void);

/* ---- memory ---------------------------------------------------------------------------------------------------- */
/* Returns a block of `size` bytes that begins with the contents of `block` (NULL at first), as realloc does, or NULL if
 * there is none; `block` then stays valid. */
typedef void *fibrad_resize(void *context, void *block, size_t size);

/* A block that the kernel fills and never frees: fixed (block and size set), or growing (resize set). */
typedef struct fibrad_memory {
    void *block;           /* [size] of any alignment; NULL with size 0: none yet, with any other size _ARGUMENT */
    size_t size;           /* bytes; 0 is too small as any other size may be */
    fibrad_resize *resize; /* NULL: the block is all there is */
    void *context;         /* handed to resize */
    size_t needed;         /* out, after FIBRAD_E_WORK and FIBRAD_E_CAPACITY: bytes that would have sufficed */
} fibrad_memory;

/* ---- isa ------------------------------------------------------------------------------------------------------- */
typedef enum fibrad_isa {
    FIBRAD_ISA_BEST = 0, /* the widest the machine offers */
    FIBRAD_ISA_SCALAR = 1,
    FIBRAD_ISA_SSE2 = 2,
    FIBRAD_ISA_AVX2 = 3,
    FIBRAD_ISA_AVX512 = 4,
    FIBRAD_ISA_NEON = 5 /* aarch64 */
} fibrad_isa;

/* All instruction sets return the same bits. The widest that this build and this machine offer (cost: microseconds);
 * "scalar", "sse2", "avx2", "avx512", "neon", "best" for FIBRAD_ISA_BEST, "?" for other numbers. No errors. */
fibrad_isa fibrad_isa_best(void);
const char *fibrad_isa_name(int isa);

/* ---- direction, pair --------------------------------------------------------------------------------------------- */
#define FIBRAD_DIRECTIONS_MIN 8
#define FIBRAD_DIRECTIONS_MAX 65536

/* Direction k of the spherical Fibonacci set of n directions, a unit vector: z = 1 - (2k+1)/n, azimuth k golden angles.
 * k [0, n), n [FIBRAD_DIRECTIONS_MIN, FIBRAD_DIRECTIONS_MAX]. Errors: _ARGUMENT. Cost: one square root.
 * Source: R. Swinbank, R. J. Purser, Q. J. R. Meteorol. Soc. 132 (2006) 1769, with half-integer offset in z. */
int fibrad_direction(uint32_t k, uint32_t n, double direction[3]);

/* View factor F12 from sphere 1 (radius r1) to sphere 2 (radius r2), nothing in between, at surface distance gap.
 * r1, r2 [L] [1e-150, 1e150]; gap [L] above -2 min(r1, r2); negative: the spheres overlap, and the formula is continued
 * smoothly. Relative error at most 1e-14 for r1/r2 [1e-4, 1e4]; r1^2 F12 and r2^2 F21 agree to the last bits; F is
 * continuous and falls with gap. Errors: _ARGUMENT. Cost: about 0.06 microseconds, 0.2 for overlaps.
 * Source: directional form of the exchange area, docs/methods.md section 2. */
int fibrad_pair_exact(double r1, double r2, double gap, double *f12);

/* ---- scene ----------------------------------------------------------------------------------------------------- */
/* Centres and radii [L]. Sphere i has its centre at x[i stride], y[i stride], z[i stride] and its radius at
 * r[i stride_r]: for double at[n][3] that is {&at[0][0], &at[0][1], &at[0][2], r, n, .stride = 3}.
 * r [1e-150, 1e150]; coordinates at most 1e150 and 3e13 times the smallest radius. */
typedef struct fibrad_spheres {
    const double *x, *y, *z, *r; /* may be NULL if n = 0 */
    uint32_t n;                  /* [0, FIBRAD_SPHERES_MAX] */
    uint32_t stride, stride_r;   /* in doubles; 0: 1 */
    const uint64_t *id;          /* [n] seeds of random paths, order among equals; NULL: the index */
} fibrad_spheres;
#define FIBRAD_SPHERES_MAX 100000000u

typedef enum fibrad_body_kind {
    FIBRAD_BODY_PLANE = 1,    /* a wall across an axis; the scene lies on its inner side */
    FIBRAD_BODY_CYLINDER = 2, /* a wall around the z axis; the scene lies inside */
    FIBRAD_BODY_MESH = 3      /* triangles: those of fibrad_scene_config.triangles that name it, one at least */
} fibrad_body_kind;

/* A plane across an axis. */
typedef struct fibrad_plane {
    int axis, upper; /* 0 x, 1 y, 2 z; 1: the scene lies below the plane, 0: above */
    double at;       /* [L] where on the axis */
} fibrad_plane;

/* A body that is not a sphere, known by its index in fibrad_scene_config.body. Planes and the cylinder bound a convex
 * container, so that none hides one sphere from another: at most two planes an axis, one of them `upper`, none on a
 * periodic axis, the lower below the upper; at most one cylinder, with x and y open and without planes across them.
 *
 * An opening is a plane where such a container ends and the surroundings begin: black, and as hot as they are. What
 * meets it is `escaped`. It has no index, temperature or emissivity. All that is said of planes holds for openings.
 *
 * Walls without an end. One plane, and a pair across one axis, may go on for ever. Planes across several axes, or a
 * cylinder, would be a tube that nothing leaves or a corner without bounds: FIBRAD_E_ENDLESS, unless every axis has two
 * planes or a period, or lies across the cylinder. */
typedef struct fibrad_body {
    int kind;           /* a fibrad_body_kind */
    fibrad_plane plane; /* of FIBRAD_BODY_PLANE */
    struct {
        double x, y, radius; /* [L] of its axis, parallel to z; > 0 */
    } cylinder;              /* of FIBRAD_BODY_CYLINDER */
} fibrad_body;

#define FIBRAD_BODIES_MAX 32

/* What a scene is made for. Zeroed: open on all sides, no bodies but spheres, the best instruction set. */
typedef struct fibrad_scene_config {
    int isa;                            /* a fibrad_isa */
    double period[3];                   /* [L] of the periodic box along each axis; 0: the axis is open */
    const fibrad_body *body;            /* [bodies] copied */
    uint32_t bodies;                    /* [0, FIBRAD_BODIES_MAX], else FIBRAD_E_UNSUPPORTED */
    const fibrad_plane *opening;        /* [openings] copied; no sphere may reach beyond one */
    uint32_t openings;                  /* [0, 6] */
    double known_low[3], known_high[3]; /* [L] spheres beyond may be missing; equal (zeroed): none, along the axis */
    const struct fibrad_occupancy *occupancy; /* fibrad_part.h: where such spheres may be; NULL: not told; not copied */
    const struct fibrad_triangles *triangles; /* fibrad_mesh.h; NULL: none */
} fibrad_scene_config;

typedef struct fibrad_scene fibrad_scene; /* spheres copied in the order of cells of a grid; immutable once made */

/* What is wrong with a sphere, a wall or an argument, where a status alone does not say it. */
typedef enum fibrad_why {
    FIBRAD_WHY_UNSAID = 0,
    FIBRAD_WHY_PLACE = 1,         /* a coordinate is NaN, infinite or too far away */
    FIBRAD_WHY_RADIUS = 2,        /* a radius is not above 0, or out of range */
    FIBRAD_WHY_BEYOND = 3,        /* a centre lies beyond a wall */
    FIBRAD_WHY_WALL = 4,          /* a wall does not go with the box or with the walls before it, or is not valid */
    FIBRAD_WHY_TEMPERATURE = 5,   /* a temperature is out of range */
    FIBRAD_WHY_EMISSIVITY = 6,    /* an emissivity is not within 0 and 1 */
    FIBRAD_WHY_POWER = 7,         /* a power is infinite or out of range */
    FIBRAD_WHY_BOTH = 8,          /* both a temperature and a power are given */
    FIBRAD_WHY_NEITHER = 9,       /* neither is */
    FIBRAD_WHY_REFLECTS = 10,     /* of emissivity 0, and to give off a power */
    FIBRAD_WHY_HOLD = 11,         /* hold or reference are out of range */
    FIBRAD_WHY_ENDLESS = 12,      /* a wall that goes on for ever has no temperature */
    FIBRAD_WHY_SIDE = 13,         /* a side of a triangle: its temperature is out of range, or its body has none */
    FIBRAD_WHY_SURROUNDINGS = 14, /* their temperature is missing or out of range */
    FIBRAD_WHY_SIGMA = 15,        /* sigma is out of range */
    FIBRAD_WHY_TOLERANCE = 16,    /* a tolerance is out of range */
    FIBRAD_WHY_MISSING = 17,      /* an array is missing */
    FIBRAD_WHY_CAPACITY = 18      /* a heat capacity is not above 0, or out of range */
} fibrad_why;                     /* the numbers never change their meaning */

/* The same as words that go behind the name of what is concerned, never NULL. No errors. */
const char *fibrad_why_text(int why);

/* Where a fault is: the two spheres concerned, equal if it is one, n if it is none of them. */
typedef struct fibrad_fault {
    uint32_t first, second;
    uint32_t triangle; /* the triangle; UINT32_MAX: none */
    uint32_t wall;     /* 1 + the body; 0: none */
    int why;           /* fibrad_why */
} fibrad_fault;

/* Bytes that fibrad_scene_init needs for n spheres, 52 each and 5 KB (ids: 1 if spheres.id is set, 8 more each).
 * Errors: 0 if n is above FIBRAD_SPHERES_MAX. An upper bound without ids, for static memory: */
size_t fibrad_scene_size(uint32_t n, int ids);
#define FIBRAD_SCENE_BYTES(n) (5632 + (size_t)(n)*64)

/* Makes a scene in memory[size]. config: NULL is all defaults. On periodic axes centres are moved into the box. Spheres
 * may overlap each other and the walls, as in settled beds, but no centre may lie inside another sphere or beyond a
 * wall; what leaves a sphere beyond a wall and goes outwards meets that wall at once; what goes inwards there passes
 * it. Errors, with fault (may be NULL): _ARGUMENT, _SIZE, _GEOMETRY (also a period less than the largest radius, a
 * sphere beyond an opening), _ENDLESS, _ISA, _UNSUPPORTED. Cost: about 0.5 microseconds a sphere; more where spheres
 * crowd in clusters far apart, at worst O(n^2). Source: docs/methods.md section 6. */
int fibrad_scene_init(fibrad_scene **scene, void *memory, size_t size, const fibrad_scene_config *config,
                      const fibrad_spheres *spheres, fibrad_fault *fault);

typedef struct fibrad_scene_facts {
    uint32_t spheres, bodies;
    int isa;                       /* the instruction set in use */
    uint32_t cells;                /* cells of the grid, all levels */
    double radius_min, radius_max; /* [L]; 0 without spheres */
    double overlap_max;            /* largest overlap of two spheres over the smaller radius, 0 if none overlap */
    uint32_t overlap_pair[2];      /* the spheres of the largest overlap */
    uint32_t triangles;
} fibrad_scene_facts;

/* The facts of a scene (null pointers: nothing). Area [L^2] of the part of a body inside all others, per period of
 * periodic axes; infinity: unbounded; NaN: no scene, no such body. No errors. */
void fibrad_scene_describe(const fibrad_scene *scene, fibrad_scene_facts *facts);
double fibrad_scene_body_area(const fibrad_scene *scene, uint32_t body);

/* The sphere that comes k-th along the cells of the grid, k [0, n): a permutation in which neighbours in space are
 * mostly near each other, so that rows of large beds find their data in the cache. Errors: UINT32_MAX. */
uint32_t fibrad_scene_sphere(const fibrad_scene *scene, uint32_t k);

/* ---- work ------------------------------------------------------------------------------------------------------ */
/* Scratch memory of one thread, for any scenes and functions in turn; set `memory` alone. Fixed memory too small:
 * FIBRAD_E_WORK; with any block of memory.needed bytes the call succeeds, or gets past this need to a next one. */
typedef struct fibrad_work {
    fibrad_memory memory;
    void *inside;      /* the kernel's own; NULL at first */
    uint32_t triangle; /* out, after FIBRAD_E_BACK: which one */
} fibrad_work;

/* Bytes for beam rows with up to `discs` spheres met in one window, hidden ones included (a packed bed: 64), and
 * `entries` spheres seen by one row (200): a constant expression, for static memory. In scenes with walls add
 * FIBRAD_WORK_WALLS, in those with triangles FIBRAD_WORK_TRIANGLES. */
#define FIBRAD_WORK_BYTES(discs, entries) (28672 + (size_t)(discs)*768 + (size_t)(entries)*96)
#define FIBRAD_WORK_WALLS                 21504
#define FIBRAD_WORK_TRIANGLES             26784

/* ---- row ------------------------------------------------------------------------------------------------------- */
typedef struct fibrad_rows fibrad_rows; /* a collection of rows, see below */

/* One row of a matrix of factors: in the caller's arrays, or appended to a collection of rows, into which col, f and
 * body then point until the next row is appended. */
typedef struct fibrad_row {
    uint32_t *col;       /* [capacity] out: the spheres seen, ascending */
    double *f;           /* [capacity] out: factor from sphere i to sphere col[.], all > 0 */
    double *body;        /* [bodies of the scene] out: factor to each; may be NULL if there are none */
    uint32_t capacity;   /* in; 0 after a row was appended to `rows` */
    fibrad_rows *rows;   /* in: NULL, or the row is appended to these, and capacity is not used */
    uint32_t sphere;     /* out: i */
    uint32_t length;     /* out: entries; after FIBRAD_E_CAPACITY: those there would be, with which the call succeeds */
    double escaped;      /* out: the fraction that meets no sphere and no body, or an opening; measured */
    double beyond;       /* out: the fraction that leaves what is known, cutoff or region: fibrad_part.h */
    double error;        /* out: Euclidean error of f and body together, estimated: on the median twice the true one */
    uint32_t directions; /* out, beams only: how many were taken */
    uint32_t fallbacks;  /* out, beams only: windows whose exact areas the fast method left to the robust one */
    int symmetric;       /* out: 1 if the method makes A_i F_ij = A_j F_ji by itself, so that averaging adds nothing */
} fibrad_row;

/* How a beam row is integrated. Zeroed: 233 directions, exact areas, no cutoff, no tolerance. */
typedef struct fibrad_beam_rule {
    uint32_t directions; /* [FIBRAD_DIRECTIONS_MIN, FIBRAD_DIRECTIONS_MAX] */
    uint32_t points;     /* 0: exact visible areas; 64, 128 or 256: that many points per window */
    double cutoff;       /* [L] spheres with centres farther than this (1 + 1e-12) neither receive nor block; 0: none */
    double tolerance;    /* more directions, `directions` (0: 100) up to the most, until error <= this; 0: none */
    uint64_t turn;       /* turns all directions together, by a random rotation made from it; 0: not turned */
} fibrad_beam_rule;

/* Row i of the view factors of a scene, by parallel beams in the directions of the rule: sum of f + sum of body +
 * escaped + beyond = 1 to rounding; with points, all but body are exact counts. With exact areas the error of f falls
 * as directions^-1.5, that of body a little slower; where nothing hides a wall, it is its solid angle. rule: NULL is
 * all defaults. Beams end after 100 periods; periodic images of one sphere share an entry, and i may see its own.
 * Errors: _ARGUMENT, _TABLE (points), _CAPACITY, _WORK, _MEMORY. Cost: some microseconds per direction with ten discs
 * in the window; it grows with their number. Source: docs/methods.md sections 3 and 4. */
int fibrad_beam_row(const fibrad_scene *scene, fibrad_work *work, uint32_t i, const fibrad_beam_rule *rule,
                    fibrad_row *row);

/* The directions to try next, after `directions` have given a row of error > tolerance > 0: by the law directions^-1.5,
 * [6/5 directions, FIBRAD_DIRECTIONS_MAX]. No errors. Source: docs/methods.md section 3. */
uint32_t fibrad_directions_for(uint32_t directions, double error, double tolerance);

/* How a row is sampled by rays. Zeroed: 20000 quasi-random rays, seed 0, no cutoff. */
typedef struct fibrad_cast_rule {
    uint32_t rays; /* 0: 20000 */
    int random;    /* 0: quasi-random numbers (`cast`); 1: pseudo-random numbers (`mc`) */
    uint64_t seed; /* the random numbers, or the shift of the quasi-random set, come from it and the sphere's id */
    double cutoff; /* as in fibrad_beam_rule */
} fibrad_cast_rule;

typedef struct fibrad_cast_means {
    double *length; /* [row->capacity] out: mean length [L] of the rays to sphere col[.] */
    double *angle;  /* [row->capacity] out: mean angle between them and the line of centres */
} fibrad_cast_means;

/* Row i of the view factors of a scene, by rays: origins even over the sphere, directions by the cosine law, each
 * followed to the first sphere. Factors are numbers of rays over all rays; their error falls as rays^-0.6, with random
 * as rays^-0.5. A ray that starts inside another sphere meets it at length 0 if its centre lies ahead. means: may be
 * NULL; not with row->rows. Errors: as fibrad_beam_row. Cost: 0.1 microseconds a ray. Source: methods.md section 8. */
int fibrad_cast_row(const fibrad_scene *scene, fibrad_work *work, uint32_t i, const fibrad_cast_rule *rule,
                    fibrad_row *row, const fibrad_cast_means *means);

/* ---- rows ------------------------------------------------------------------------------------------------------ */
/* Rows of one thread or process, in any order. Set `memory` alone. No room for a row: FIBRAD_E_CAPACITY (the block may
 * then be made larger with its contents kept), or FIBRAD_E_MEMORY. */
struct fibrad_rows {
    fibrad_memory memory;
    size_t used, lead;      /* the kernel's own, 0 at first, as all below: bytes that rows take, and before them */
    uint32_t count, serial; /* rows; changes so far */
    uint64_t entries;       /* of all rows */
};

/* _add: appends a row computed elsewhere: sphere, col, f, length, escaped, beyond, error, symmetric, body[bodies].
 * Errors: _ARGUMENT (columns not ascending, factors not in [0, 1] but for rounding), _CAPACITY, _MEMORY.
 * _clear: empties a collection and keeps its memory. NULL: nothing. No errors. */
int fibrad_rows_add(fibrad_rows *rows, const fibrad_row *row, uint32_t bodies);
void fibrad_rows_clear(fibrad_rows *rows);

/* ---- matrix ---------------------------------------------------------------------------------------------------- */
/* The row of a body, of fibrad_exchange_body. */
typedef struct fibrad_body_row {
    double body[FIBRAD_BODIES_MAX]; /* factor to each body; next to 0 it may err to below */
    double spheres, escaped;        /* to all spheres together; to the surroundings: the sum is 1, of emissivity 0 it
                                       is 0 */
    double error;                   /* of one part: what is left of paths among mirrors; of the mean of parts: their
                                       spread, Euclidean, besides */
    uint64_t rays;                  /* traced */
} fibrad_body_row;

/* A function of the caller that has threads: does pieces [0, pieces) of a job by piece(job, k), in any order or at
 * once, and returns when all are done. */
typedef void fibrad_piece(void *job, uint32_t k);
typedef void fibrad_parallel(void *context, uint32_t pieces, fibrad_piece *piece, void *job);

/* What becomes of the rows. Zeroed: view factors, reciprocal and closed. */
typedef struct fibrad_matrix_rule {
    const double *emissivity;        /* [spheres] [0, 1]: the rows are exchange factors; NULL: view factors */
    int raw;                         /* 1: rows as they are, in order; a missing one is empty */
    double drop;                     /* [0, 1] what entries below this carry goes to the others, or to F_ii; 0: none */
    uint32_t tasks;                  /* [1, 1024] for as many threads, 0: 1; no bit depends on it */
    const fibrad_body_row *body_row; /* [bodies] rows of bodies, too, copied; those of bodies without bounds are not
                                        looked at. NULL: spheres alone have rows */
    const double *body_emissivity;   /* [bodies] [0, 1] for these; NULL: 1 */
    fibrad_parallel *parallel; /* does pieces at once, in all calls for the matrix; NULL: the calling thread does */
    void *context;             /* handed to it */
    int sampled;               /* 1: view factors by rays or points, averaged and closed as exchange factors are */
} fibrad_matrix_rule;

/* A matrix of factors, compressed rows. The arrays are those of the matrix it was read from. */
typedef struct fibrad_factors {
    uint32_t n, bodies;
    const uint64_t *start;      /* [n + 1]: row i is [start[i], start[i+1]) */
    const uint32_t *col;        /* [start[n]] ascending within each row */
    const double *f;            /* [start[n]] factor from i to col */
    const double *escaped;      /* [n] */
    const double *beyond;       /* [n] */
    const double *error;        /* [n] estimated Euclidean error of each row */
    const double *body;         /* [n][bodies] factors to bodies */
    const double *body_body;    /* [bodies][bodies] factors between bodies, NaN from those without bounds, 0 from those
                                   of emissivity 0; NULL, as the next two: bodies have no rows */
    const double *body_escaped; /* [bodies] */
    const double *body_error;   /* [bodies] estimated Euclidean error of both */
    double body_correction;     /* the largest |sum - 1| of a row of a body before it was closed: how well rows of
                                   spheres and paths of bodies agree */
    double body_closure;        /* ... of the matrix as it is: rounding, or, where reciprocity and sums contradict each
                                   other, as in some beds cut by triangles, body_correction: then rows of spheres are
                                   closed, and those of bodies are what paths say */
    double changed;       /* the largest change, over the error of the row, that averaging and closing have made in
                             what a row gives to bodies, surroundings and beyond (Euclidean); raw: 0. Well
                             above 1 raw rows contradict each other by more than their errors say, ... */
    uint32_t changed_row; /* ... as this one does */
} fibrad_factors;

typedef struct fibrad_matrix fibrad_matrix; /* rows put together into one matrix */

/* Begins a matrix in memory[size] from all rows of a scene, found in rows[count], which stay until fibrad_matrix_close.
 * rule: NULL: defaults. Bytes: 24 per entry of the rows, 80 + 8 bodies per sphere; raw: 12, 48 + 8 bodies. Errors:
 * _ARGUMENT (entries of emissivity 0), _SIZE, _STATE: row missing or twice (*sphere or NULL). Cost: O(n + entries). */
size_t fibrad_matrix_size(const fibrad_scene *scene, const fibrad_rows *rows, uint32_t count,
                          const fibrad_matrix_rule *rule);
int fibrad_matrix_init(fibrad_matrix **matrix, void *memory, size_t size, const fibrad_scene *scene,
                       const fibrad_rows *rows, uint32_t count, const fibrad_matrix_rule *rule, uint32_t *sphere);

/* Averages the rows of task [0, rule->tasks), several threads at once: (A_i F_ij + A_j F_ji)/(2 A_i), A = 4 pi r^2; of
 * exchange factors by variances, A_i e_i D_ij counting as A_j/(A_i + A_j). Optional: fibrad_matrix_close does what was
 * left out. Errors: _ARGUMENT, _STATE (twice, raw, closed). Cost: each task reads its share of entries three times, and
 * looks for them in all rows. Source: docs/methods.md section 5. */
int fibrad_matrix_average(fibrad_matrix *matrix, uint32_t task);

/* Ends the matrix. View factors: row sums above 1 are brought down to 1 symmetrically. Exchange factors: D_ij u_i u_j
 * and u_i times what raw row i leaves of 1 add up to 1. Then bodies, escaped and beyond are scaled to what the row sums
 * leave of 1; a row that met none of them takes the shares of all spheres together. Rows of bodies, where A_b F_bi =
 * A_i F_ib, are closed with all others by F_pq u_p u_q. A_i F_ij = A_j F_ji to the last bits, sums are 1 to rounding
 * but for empty rows. Errors: _STATE. Cost: O(entries), 40 times for exchange, `drop`, bodies. Source: docs/heat.md. */
int fibrad_matrix_close(fibrad_matrix *matrix);

/* The matrix, once closed; the largest |A_i F_ij - A_j F_ji| / max(A_i, A_j) over all entries, absent partners taken as
 * 0 (A times emissivity). Errors: _ARGUMENT, _STATE. Cost: none; O(entries log(row length)). */
int fibrad_matrix_read(const fibrad_matrix *matrix, fibrad_factors *factors);
int fibrad_matrix_reciprocity(const fibrad_matrix *matrix, double *largest);

/* ---- drift ----------------------------------------------------------------------------------------------------- */
/* How far row i, right for the scene `before`, is off for `now`, the same spheres in boxes of the same periods:
 * Euclidean error, estimated as 2 root(sum over the spheres seen, j = col[length], of (F delta/w)^2). delta [L]: change
 * of the vector from i to j; F, w: docs/methods.md section 10. Estimates of successive steps add up. Bodies and spheres
 * that come into sight are not counted: fibrad_drift_partners. Errors: _ARGUMENT. Cost: about 10 ns per entry. */
int fibrad_drift_row(const fibrad_scene *before, const fibrad_scene *now, uint32_t i, const uint32_t *col,
                     uint32_t length, double *error);

/* What a new row of sphere i says about those of others, since j sees i just as i sees j. Where F_ij has more than
 * doubled from `before` to `row`, adds twice the change of A_i F_ij/A_j to error[j], as root of the sum of squares.
 * error [spheres]; order matters to its last bits. Errors: _ARGUMENT. Cost: about 10 ns per entry. */
int fibrad_drift_partners(const fibrad_scene *now, uint32_t i, const fibrad_row *before, const fibrad_row *row,
                          double *error);

/* ---- exchange -------------------------------------------------------------------------------------------------- */
/* How the exchange of grey diffuse spheres and bodies is followed. */
typedef struct fibrad_exchange_rule {
    const double *emissivity;      /* [spheres] [0, 1]; 0 reflects all: its row and its column are empty */
    const double *body_emissivity; /* [bodies] [0, 1]; 0 reflects all. NULL if there are none */
    uint32_t directions;           /* of the first leg, a beam row by 256 points up to 144, by areas above; 0: 50 */
    uint32_t paths;                /* [1, FIBRAD_PATHS_MAX] for the reflections; 0: 400 */
    uint64_t seed;                 /* of random numbers, with the sphere's id; and `turn` of the first leg */
    double cutoff;                 /* of the first leg; reflections end as far from the centre of sphere i; 0: none */
    double tolerance;              /* more directions and paths until row->error is not above this; 0: none */
} fibrad_exchange_rule;
#define FIBRAD_PATHS_MAX (1u << 28)

/* Row i of the exchange factors of a scene: D_ij, in f, is the fraction of what sphere i emits that sphere j absorbs,
 * directly or after any number of diffuse reflections; body, escaped and beyond likewise; the sum is 1 to rounding, or
 * 0 of emissivity 0. The first leg is that of fibrad_beam_row; reflections go from point to point. Errors fall as
 * directions^-1.5 and paths^-0.5 do. rays (may be NULL): how many were traced. Errors: as fibrad_beam_row (emissivities
 * of sphere i and of bodies are checked). Cost: the beam row, and 0.1 to 0.2 microseconds a ray; a path has some 2 rays
 * at emissivity 0.8, 14 at 0.2. Work memory: up to 6 MB more, for speed. Source: docs/heat.md. */
int fibrad_exchange_row(const fibrad_scene *scene, fibrad_work *work, uint32_t i, const fibrad_exchange_rule *rule,
                        fibrad_row *row, uint64_t *rays);

/* Part `part` [0, FIBRAD_BODY_PARTS) of the row of a body: what the body emits, on its part inside all others, and whom
 * that is absorbed by; to each sphere it is A_i e_i D_ib/(A_b e_b). Each part follows an eighth of rule->paths (0:
 * 8192) from point to point; errors fall as paths^-0.6, or as paths^-0.5 at low emissivities. rule: emissivity and
 * body_emissivity may be NULL: all are black, and D is F; directions and tolerance are not used. _mean: the mean of all
 * parts. Errors: _ARGUMENT, _WORK, _MEMORY, _UNSUPPORTED (a body without bounds, a cutoff, a known region). Cost: 0.1
 * to 0.5 microseconds a ray. Source: docs/heat.md. */
#define FIBRAD_BODY_PARTS 8
int fibrad_exchange_body(const fibrad_scene *scene, fibrad_work *work, uint32_t body, const fibrad_exchange_rule *rule,
                         uint32_t part, fibrad_body_row *row);
int fibrad_exchange_body_mean(const fibrad_body_row part[FIBRAD_BODY_PARTS], fibrad_body_row *mean);

typedef struct fibrad_displacement {
    double square[3]; /* [L^2] mean square displacement along each axis */
    double error[3];  /* [L^2] standard errors, estimated */
    double absorbed;  /* fraction that spheres absorb */
    uint64_t rays;
} fibrad_displacement;

/* How far what sphere i emits is carried, by rule->paths paths, from its centre to that of the sphere that absorbs,
 * periods counted; what bodies absorb, escapes or is beyond counts as 0. Errors and cost: as fibrad_exchange_row. */
int fibrad_exchange_displacement(const fibrad_scene *scene, fibrad_work *work, uint32_t i,
                                 const fibrad_exchange_rule *rule, fibrad_displacement *displacement);

#ifdef __cplusplus
}
#endif
#endif
