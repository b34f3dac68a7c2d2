/* fibrad.h - view factors for thermal radiation between spheres. No heap, no I/O, no threads, no mutable globals.
 *
 * Index
 *   status    fibrad_status_text, fibrad_version
 *   memory    fibrad_memory: a block of bytes, fixed or growing
 *   isa       fibrad_isa_best, fibrad_isa_name
 *   direction fibrad_direction
 *   pair      fibrad_pair_exact
 *   scene     fibrad_scene_size, FIBRAD_SCENE_BYTES, fibrad_scene_init, _describe, _body_area, _sphere
 *   work      fibrad_work, FIBRAD_WORK_BYTES
 *   row       fibrad_row, fibrad_beam_row, fibrad_directions_for, fibrad_cast_row
 *   rows      fibrad_rows, fibrad_rows_add, _get, _count, _clear
 *   matrix    fibrad_matrix_size, _init, _tasks, _average, _close, _read, _reciprocity
 *   drift     fibrad_drift_row, fibrad_drift_partners
 *   exchange  fibrad_exchange_row, fibrad_exchange_spread
 *   heat      fibrad_heat_size, _init, _move, _tasks, _trace, _sources_init, _begin, _parts, _sweep, _step, _read
 * fibrad_surface.h has the method of Bao, Gao and Tan, fibrad_furnace.h the furnace solver.
 *
 * Typical  All rows of a bed: fibrad_scene_init; per thread a fibrad_work and a fibrad_rows; fibrad_beam_row for every
 *          sphere; fibrad_matrix_init, _close and _read. Heat: fibrad_heat_init; fibrad_heat_trace for every task;
 *          fibrad_heat_begin, _sweep and _step until solved; fibrad_heat_read. docs/embedding.md has complete programs.
 * Units    One length unit L, the caller's choice; angles in radians; factors are dimensionless; temperatures absolute.
 * Memory   The caller owns every block, of any alignment, and keeps it alive and in place while it is used; there is no
 *          free. An `_init` function lays its object out in a block and returns a pointer into it; the twin `_size`
 *          function returns the bytes that takes, and 0 where `_init` would return an error other than FIBRAD_E_SIZE.
 * Threads  Const objects may be shared between threads. A fibrad_work or fibrad_rows belongs to one thread at a time.
 * Errors   Functions that can fail return an int: FIBRAD_OK or a negative fibrad_status. Unless FIBRAD_OK is returned,
 *          outputs are untouched, except where a function says otherwise. Null pointers are FIBRAD_E_ARGUMENT.
 *          A call that comes too early, too often, or for a scene that has changed is FIBRAD_E_STATE, never a number.
 * Zero     Structures zeroed but for the fields named are valid and mean the defaults stated in [brackets].
 * Bits     Results depend on the arguments alone: not on thread, instruction set, compiler or optimisation level.
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

/* ---- status ---------------------------------------------------------------------------------------------------- */

/* The numbers never change their meaning. */
typedef enum fibrad_status {
    FIBRAD_OK = 0,
    FIBRAD_E_ARGUMENT = -1,     /* a null pointer, a value out of its range, NaN or infinity */
    FIBRAD_E_SIZE = -2,         /* the memory block is smaller than the `_size` function asks for */
    FIBRAD_E_ALIGNMENT = -3,    /* reserved; no function asks for alignment */
    FIBRAD_E_CAPACITY = -4,     /* the arrays for a row are too small; the length needed is written */
    FIBRAD_E_TABLE = -5,        /* that number of samples is not built in */
    FIBRAD_E_GEOMETRY = -6,     /* equal centres, or the centre of one sphere inside another */
    FIBRAD_E_WORK = -7,         /* the work memory is too small; the bytes needed are written */
    FIBRAD_E_STATE = -8,        /* a call is missing, too early or repeated, or the scene has changed */
    FIBRAD_E_ISA = -9,          /* this build or this machine lacks that instruction set */
    FIBRAD_E_UNSUPPORTED = -10, /* a valid request that this version does not compute */
    FIBRAD_E_MEMORY = -11,      /* a resize function or the heap had no more memory */
    FIBRAD_E_CANCELLED = -12    /* a progress function asked to stop */
} fibrad_status;

/* One English sentence without a full stop for a status; never NULL, also for numbers that are no status. No errors. */
const char *fibrad_status_text(int status);

/* The version of the library linked in, FIBRAD_VERSION of its header: "major.minor.patch". No errors. */
const char *fibrad_version(void);

/* ---- memory ---------------------------------------------------------------------------------------------------- */

/* Returns a block of `size` bytes that begins with the contents of `block` (NULL at first), as realloc does, or NULL if
 * there is none; `block` then stays valid. */
typedef void *fibrad_resize(void *context, void *block, size_t size);

/* A block that the kernel fills: fixed (block and size set, resize NULL), or growing (resize set). The caller may free
 * the block when it is no longer used; the kernel never does. */
typedef struct fibrad_memory {
    void *block;           /* [size], of any alignment; NULL with size 0: none yet */
    size_t size;           /* bytes */
    fibrad_resize *resize; /* NULL: the block is all there is */
    void *context;         /* handed to resize */
    size_t needed;         /* out: bytes that would have sufficed, after a status that says so */
} fibrad_memory;

/* ---- isa ------------------------------------------------------------------------------------------------------- */

/* Instruction sets the kernel is compiled for. All return the same bits. */
typedef enum fibrad_isa {
    FIBRAD_ISA_BEST = 0, /* the widest the machine offers */
    FIBRAD_ISA_SCALAR = 1,
    FIBRAD_ISA_SSE2 = 2,
    FIBRAD_ISA_AVX2 = 3,
    FIBRAD_ISA_AVX512 = 4
} fibrad_isa;

/* The widest instruction set that both this build and this machine offer. No errors. Cost: microseconds. */
fibrad_isa fibrad_isa_best(void);

/* "scalar", "sse2", "avx2", "avx512"; "best" for FIBRAD_ISA_BEST; "?" for other numbers. No errors. */
const char *fibrad_isa_name(int isa);

/* ---- direction ------------------------------------------------------------------------------------------------- */

#define FIBRAD_DIRECTIONS_MIN 8
#define FIBRAD_DIRECTIONS_MAX 65536

/* Direction k of the spherical Fibonacci set of n directions, a unit vector: z = 1 - (2k+1)/n, azimuth k golden angles.
 * k [0, n), n [FIBRAD_DIRECTIONS_MIN, FIBRAD_DIRECTIONS_MAX].
 * Errors: FIBRAD_E_ARGUMENT. Cost: one square root; no trigonometry.
 * Source: R. Swinbank, R. J. Purser, Q. J. R. Meteorol. Soc. 132 (2006) 1769, with half-integer offset in z. */
int fibrad_direction(uint32_t k, uint32_t n, double direction[3]);

/* ---- pair ------------------------------------------------------------------------------------------------------ */

/* View factor F12 from sphere 1 (radius r1) to sphere 2 (radius r2), nothing in between, at surface distance gap.
 * r1, r2 [L] from 1e-150 to 1e150; gap [L] from -2 min(r1, r2), exclusive, to any finite number; negative: the spheres
 * overlap, and the formula is continued smoothly as docs/methods.md says.
 * Guarantee: relative error at most 1e-14 for r1/r2 in [1e-4, 1e4]; r1^2 F12 and r2^2 F21 agree to the last bits; F is
 * continuous and falls with gap. Errors: FIBRAD_E_ARGUMENT. Cost: about 0.06 microseconds, 0.2 for overlaps.
 * Source: directional form of the exchange area, docs/methods.md section 2. */
int fibrad_pair_exact(double r1, double r2, double gap, double *f12);

/* ---- scene ----------------------------------------------------------------------------------------------------- */

/* Arrays of n spheres: centres and radii [L]. Sphere i has its centre at x[i stride], y[i stride], z[i stride] and its
 * radius at r[i stride_r], so that double at[n][3] is {&at[0][0], &at[0][1], &at[0][2], r, n, .stride = 3}. r from
 * 1e-150 to 1e150, coordinates up to 1e150 and 3e13 times the smallest radius. */
typedef struct fibrad_spheres {
    const double *x, *y, *z, *r; /* may be NULL if n = 0 */
    uint32_t n;                  /* [0, FIBRAD_SPHERES_MAX] */
    uint32_t stride, stride_r;   /* in doubles; 0: 1 */
    const uint64_t *id;          /* [n] number of each sphere's random paths [its index] */
} fibrad_spheres;

#define FIBRAD_SPHERES_MAX 100000000u

/* What a body other than a sphere is. */
typedef enum fibrad_body_kind {
    FIBRAD_BODY_PLANE = 1,    /* a wall across an axis; the scene lies on its inner side */
    FIBRAD_BODY_CYLINDER = 2, /* a wall around the z axis; the scene lies inside */
    FIBRAD_BODY_MESH = 3      /* triangles: FIBRAD_E_UNSUPPORTED */
} fibrad_body_kind;

/* A body that is not a sphere, known by its index in fibrad_scene_config.body. Walls bound a convex container, so that
 * no wall hides one sphere from another: at most two planes an axis, one of them `upper`, none on a periodic axis, the
 * lower below the upper; at most one cylinder, with x and y open and without planes. */
typedef struct fibrad_body {
    int kind; /* a fibrad_body_kind */
    struct {
        int axis, upper; /* 0 x, 1 y, 2 z; 1: the scene lies below the plane, 0: above */
        double at;       /* [L] where on the axis */
    } plane;             /* only with FIBRAD_BODY_PLANE */
    struct {
        double x, y, radius; /* [L] of its axis, parallel to z; > 0 */
    } cylinder;              /* only with FIBRAD_BODY_CYLINDER */
} fibrad_body;

/* What a scene is made for. Zeroed: open on all sides, no bodies but spheres, the best instruction set. */
typedef struct fibrad_scene_config {
    int isa;                 /* a fibrad_isa */
    double period[3];        /* per axis the length of the periodic box [L]; 0: the axis is open */
    const fibrad_body *body; /* [bodies], copied */
    uint32_t bodies;         /* more than 7: FIBRAD_E_UNSUPPORTED */
    double known_low[3];     /* region of which all spheres are here [L], the rest counts as `beyond` of a row; both */
    double known_high[3];    /* zeroed: everywhere; else FIBRAD_E_UNSUPPORTED */
} fibrad_scene_config;

/* A scene: spheres copied in the order of the cells of a grid. Immutable once made; share it between threads. */
typedef struct fibrad_scene fibrad_scene;

/* Where fibrad_scene_init found a fault: indices of the spheres concerned (equal when only one is). */
typedef struct fibrad_fault {
    uint32_t first, second;
} fibrad_fault;

/* Bytes that fibrad_scene_init needs for n spheres (with ids: 1). Errors: 0 if n is above FIBRAD_SPHERES_MAX. */
size_t fibrad_scene_size(uint32_t n, int ids);

/* An upper bound of fibrad_scene_size(n, 0) as a constant expression, for static memory. */
#define FIBRAD_SCENE_BYTES(n) (5248 + (size_t)(n)*64)

/* Makes a scene in `memory` (`size` bytes). Spheres are copied. On periodic axes centres may lie anywhere and are moved
 * into the box. Spheres may overlap each other and the walls (settled beds do), but no centre may lie inside another
 * sphere or beyond a wall. What leaves a sphere outwards beyond a wall meets that wall at once. config: NULL is all
 * defaults. Errors: _ARGUMENT (then `fault`, unless NULL, names the sphere, or n if it is none of them), _SIZE,
 * _GEOMETRY (fault names the pair), _ISA, _UNSUPPORTED. Cost: about 0.5 microseconds per sphere; more where spheres
 * crowd in clusters far apart, at worst O(n^2). Source: docs/methods.md section 6. */
int fibrad_scene_init(fibrad_scene **scene, void *memory, size_t size, const fibrad_scene_config *config,
                      const fibrad_spheres *spheres, fibrad_fault *fault);

/* Facts of a scene. */
typedef struct fibrad_scene_facts {
    uint32_t spheres, bodies;
    int isa;                       /* the instruction set in use */
    uint32_t cells;                /* cells of the grid, all levels */
    double radius_min, radius_max; /* [L]; 0 without spheres */
    double overlap_max;            /* largest overlap of two spheres over the smaller radius, 0 if none overlap */
    uint32_t overlap_pair[2];      /* the spheres of the largest overlap */
} fibrad_scene_facts;

/* Fills in the facts of a scene; null pointers: nothing. No errors. */
void fibrad_scene_describe(const fibrad_scene *scene, fibrad_scene_facts *facts);

/* Area [L^2] of the part of a body inside all others, per period of periodic axes; infinity: unbounded.
 * Errors: NaN (no scene, no such body). */
double fibrad_scene_body_area(const fibrad_scene *scene, uint32_t body);

/* The sphere that comes k-th along the cells of the grid, k < n: a permutation of all, in which neighbours in space are
 * mostly near each other. In large beds rows computed in this order find more of what they need in the cache.
 * Errors: UINT32_MAX (no scene, or no such k). */
uint32_t fibrad_scene_sphere(const fibrad_scene *scene, uint32_t k);

/* ---- work ------------------------------------------------------------------------------------------------------ */

/* Scratch memory of one thread, for any scenes and functions in turn. Set `memory` alone. Without a resize function a
 * call that needs more returns FIBRAD_E_WORK and writes memory.needed: with that many bytes (the block may then be
 * another) the call succeeds, or gets past this need to a next one. */
typedef struct fibrad_work {
    fibrad_memory memory;
    void *inside; /* the kernel's own; NULL at first */
} fibrad_work;

/* Bytes for beam rows with up to `discs` spheres met in one window, hidden ones included (a packed bed: 64), and
 * `entries` spheres seen by one row (200): a constant expression, for static memory. */
#define FIBRAD_WORK_BYTES(discs, entries) (28672 + (size_t)(discs)*768 + (size_t)(entries)*96)

/* ---- row ------------------------------------------------------------------------------------------------------- */

typedef struct fibrad_rows fibrad_rows;

/* One row of a matrix of factors: in the caller's arrays, or appended to a collection of rows. */
typedef struct fibrad_row {
    uint32_t *col;       /* [capacity] out: the spheres seen, ascending */
    double *f;           /* [capacity] out: factor from sphere i to sphere col[.], all > 0 */
    double *body;        /* [bodies of the scene] out: factor to each; may be NULL if there are none */
    uint32_t capacity;   /* in */
    fibrad_rows *rows;   /* in: NULL, or the row is appended to these: then col, f and body are out, where it stands
                            until the next one is appended, and capacity is not used */
    uint32_t sphere;     /* out: i */
    uint32_t length;     /* out: entries; after FIBRAD_E_CAPACITY: the entries there would be */
    double escaped;      /* out: the fraction that meets no sphere and no body, measured */
    double beyond;       /* out: the fraction that leaves the known region; 0 */
    double error;        /* out: estimated Euclidean error of f; twice the true one on the median, seldom less than it;
                            bodies are not counted */
    uint32_t directions; /* out, beams only: how many were taken */
    uint32_t fallbacks;  /* out, beams only: windows whose exact areas the fast method left to the robust one */
    int symmetric;       /* out: 1 if the method makes A_i F_ij = A_j F_ji by itself, so that averaging adds nothing */
} fibrad_row;

/* How a beam row is integrated. Zeroed: 233 directions, exact areas, no cutoff, no tolerance. */
typedef struct fibrad_beam_rule {
    uint32_t directions; /* [FIBRAD_DIRECTIONS_MIN, FIBRAD_DIRECTIONS_MAX] */
    uint32_t points;     /* 0: exact visible areas; 64, 128 or 256: that many points per window */
    double cutoff;       /* spheres whose centres are farther than this (1 + 1e-12) neither receive nor block [L];
                            0: none. A beam ends after 100 periods along any periodic axis */
    double tolerance;    /* 0: none. Else the row is repeated with more directions, from `directions` on [100], until
                            row->error is not above this, or FIBRAD_DIRECTIONS_MAX are taken. Rows of different
                            directions are each closed, but averaging them does not keep their sums below 1 */
} fibrad_beam_rule;

/* Row i of the view factors of a scene, by parallel beams in the directions of the rule: sum of f + sum of body +
 * escaped + beyond = 1, to rounding with exact areas, as exact counts with points. With exact areas the error falls as
 * directions^-1.5, that of the sharing between walls about as directions^-1 (5e-4 each at 233). i [0, spheres); rule
 * NULL: all defaults. Periodic images of one sphere share an entry, and i may see images of itself.
 * Errors: _ARGUMENT, _TABLE (points), _CAPACITY, _WORK, _MEMORY. Cost: some microseconds per direction with ten discs
 * in the window; it grows with the square of their number, which is large for a sphere among much smaller ones. Source:
 * docs/methods.md sections 3 and 4. */
int fibrad_beam_row(const fibrad_scene *scene, fibrad_work *work, uint32_t i, const fibrad_beam_rule *rule,
                    fibrad_row *row);

/* The directions with which to try next, after `directions` have given a row of estimated error `error` > tolerance >
 * 0: by the law directions^-1.5, a fifth more at least, FIBRAD_DIRECTIONS_MAX at most. No errors. Source:
 * docs/methods.md section 3. */
uint32_t fibrad_directions_for(uint32_t directions, double error, double tolerance);

/* How a row is sampled by rays. Zeroed: 20000 quasi-random rays, seed 0, no cutoff. */
typedef struct fibrad_cast_rule {
    uint32_t rays; /* 0: 20000 */
    int random;    /* 0: quasi-random numbers (`cast`); 1: pseudo-random numbers (`mc`) */
    uint64_t seed; /* the random numbers, or the shift of the quasi-random set, come from it and the sphere's id */
    double cutoff; /* as in fibrad_beam_rule */
} fibrad_cast_rule;

/* What else the rays of a row tell, in the caller's arrays; entry k belongs to sphere col[k] of the row. */
typedef struct fibrad_cast_means {
    double *length; /* [row->capacity] out: mean length of the rays [L] */
    double *angle;  /* [row->capacity] out: mean angle between the rays and the line of centres [rad] */
} fibrad_cast_means;

/* Row i of the view factors of a scene, by rays: origins even over the sphere, directions by the cosine law in the
 * local frame, each followed to the first sphere by the distance to its surface. Factors are numbers of rays over all
 * rays; row->error is estimated from every other ray. A ray that starts inside another sphere meets it at once, at
 * length 0, if its centre lies ahead. means: may be NULL; not with row->rows. The error falls as rays^-0.6, with
 * random = 1 as rays^-0.5. i [0, spheres). Errors: as fibrad_beam_row. Cost: about 0.1 microseconds per ray.
 * Source: docs/methods.md section 8; pebble-bed quasi-Monte Carlo with origins and directions as there. */
int fibrad_cast_row(const fibrad_scene *scene, fibrad_work *work, uint32_t i, const fibrad_cast_rule *rule,
                    fibrad_row *row, const fibrad_cast_means *means);

/* ---- rows ------------------------------------------------------------------------------------------------------ */

/* A collection of rows, one per thread or process, in any order. Set `memory` alone. A row that finds no room is
 * FIBRAD_E_CAPACITY and memory.needed is written (the block may then be resized: it keeps its contents and place), or
 * FIBRAD_E_MEMORY if the resize function returned NULL. */
struct fibrad_rows {
    fibrad_memory memory;
    size_t used;      /* bytes that rows take; the kernel's own, 0 at first */
    uint32_t count;   /* rows; the kernel's own, 0 at first */
    uint64_t entries; /* of all of them; the kernel's own, 0 at first */
};

/* Appends a row computed elsewhere, or before: sphere, col, f, length, escaped, beyond, error, symmetric, and `bodies`
 * numbers of row->body. Errors: _ARGUMENT (columns not ascending, f not in (0, 1] but for rounding), _CAPACITY,
 * _MEMORY. */
int fibrad_rows_add(fibrad_rows *rows, const fibrad_row *row, uint32_t bodies);

/* Empties a collection and keeps its memory. NULL: nothing. No errors. */
void fibrad_rows_clear(fibrad_rows *rows);

/* ---- matrix ---------------------------------------------------------------------------------------------------- */

/* What becomes of the rows. Zeroed: view factors, reciprocal and closed. */
typedef struct fibrad_matrix_rule {
    const double *emissivity; /* [spheres] rows are exchange factors, and A_i emissivity_i D_ij is symmetric; NULL: view
                                 factors, and A_i F_ij is */
    int raw;                  /* 1: rows as they are, in order; a row that is missing is empty */
    double drop; /* entries below this (of a reciprocal pair: both) are given back to the others, symmetrically, and
                    to F_ii where there are none; 0: none */
    uint32_t
        tasks; /* into which the averaging is divided, for as many threads: [1, 1024], 0: 1; no bit depends on it */
} fibrad_matrix_rule;

/* A matrix of factors, compressed rows. The arrays are those of the matrix it was read from. */
typedef struct fibrad_factors {
    uint32_t n, bodies;
    const uint64_t *start; /* [n + 1]: row i is [start[i], start[i+1]) */
    const uint32_t *col;   /* [start[n]] ascending within each row */
    const double *f;       /* [start[n]] factor from i to col */
    const double *escaped; /* [n] */
    const double *beyond;  /* [n] */
    const double *error;   /* [n] estimated Euclidean error of each row */
    const double *body;    /* [n][bodies] factors to bodies */
} fibrad_factors;

/* Rows put together into one matrix. */
typedef struct fibrad_matrix fibrad_matrix;

/* Bytes that fibrad_matrix_init needs: 36 per entry and some 100 per sphere; raw: 12 and 60. rule: NULL is all
 * defaults. Errors: 0. */
size_t fibrad_matrix_size(const fibrad_scene *scene, const fibrad_rows *rows, uint32_t count,
                          const fibrad_matrix_rule *rule);

/* Begins a matrix in `memory` (`size` bytes) from all rows of a scene, found in `count` collections, which stay until
 * fibrad_matrix_close. Errors: _ARGUMENT, _SIZE, _STATE: a row is missing or there twice (`sphere`, unless NULL, says
 * which). Cost: O(n + rows). */
int fibrad_matrix_init(fibrad_matrix **matrix, void *memory, size_t size, const fibrad_scene *scene,
                       const fibrad_rows *rows, uint32_t count, const fibrad_matrix_rule *rule, uint32_t *sphere);

/* Averages the rows of task [0, rule->tasks): out_ij = (A_i F_ij + A_j F_ji)/(2 A_i), A = 4 pi r^2 (times emissivity).
 * May be called for each task once, by several threads at once; fibrad_matrix_close does what was left out.
 * Errors: _ARGUMENT, _STATE. Cost: each task reads all entries three times. Source: docs/methods.md section 5. */
int fibrad_matrix_average(fibrad_matrix *matrix, uint32_t task);

/* Ends the matrix. View factors: row sums above 1 are brought down to 1 symmetrically. Exchange factors: row sums are
 * brought to those of the raw rows by D_ij u_i u_j. Then bodies, escaped and beyond are scaled to what the row sums
 * leave of 1; a row that met none of them takes the shares of all spheres together. A_i F_ij = A_j F_ji to the last
 * bits, all sums are 1 to rounding. Errors: _STATE. Cost: O(entries) once for view factors, some 40 times for exchange
 * factors and for `drop`. */
int fibrad_matrix_close(fibrad_matrix *matrix);

/* The matrix, once closed. Errors: _ARGUMENT, _STATE. */
int fibrad_matrix_read(const fibrad_matrix *matrix, fibrad_factors *factors);

/* The largest |A_i F_ij - A_j F_ji| / max(A_i, A_j) over all entries, absent partners taken as 0 (A times emissivity).
 * Errors: _ARGUMENT, _STATE. Cost: O(entries log(row length)). */
int fibrad_matrix_reciprocity(const fibrad_matrix *matrix, double *largest);

/* ---- drift ----------------------------------------------------------------------------------------------------- */

/* Rows of a bed that moves little can be kept for a while: docs/embedding.md has the loop. The two scenes hold the same
 * spheres, in the caller's order, in boxes of the same periods, at two times.
 *
 * How far row i, which was right for `before`, is off for `now`: estimated Euclidean error, twice the root of the sum
 * over the `length` spheres j = col[.] seen of (F delta/w)^2. delta [L]: change of the vector from i to j; F = r_j^2/(4
 * d^2), d the lesser of their distances then and now; w the lesser of r_j and max(d - r_j, r_i). Estimates of
 * successive steps add up to one of all. Bodies and spheres that come into sight are not counted:
 * fibrad_drift_partners. Errors: _ARGUMENT. Cost: about 10 ns per entry. Source: docs/methods.md section 10. */
int fibrad_drift_row(const fibrad_scene *before, const fibrad_scene *now, uint32_t i, const uint32_t *col,
                     uint32_t length, double *error);

/* What the new row of sphere i says about the rows of others: j sees i just as i sees j. Where F_ij has more than
 * doubled from the row before to the row now, as when i has come into sight, adds twice the change of A_i F_ij/A_j to
 * error[j], as root of the sum of squares. error [spheres]; order matters to its last bits.
 * Errors: _ARGUMENT. Cost: about 10 ns per entry. */
int fibrad_drift_partners(const fibrad_scene *now, uint32_t i, const fibrad_row *before, const fibrad_row *row,
                          double *error);

/* ---- exchange -------------------------------------------------------------------------------------------------- */

/* How the exchange of grey diffuse spheres and bodies is followed. Zeroed but for the emissivities: see each. */
typedef struct fibrad_exchange_rule {
    const double *emissivity;      /* [spheres] (0, 1] */
    const double *body_emissivity; /* [bodies] [0, 1]; 0 reflects all. NULL if there are none */
    uint32_t directions; /* of the beam row that the first leg is taken from, by 256 points up to 144 of them, by exact
                            areas above; 0: 50 */
    uint32_t paths;      /* followed for the reflections, up to FIBRAD_PATHS_MAX; 0: 400 */
    uint64_t seed;       /* their numbers come from it and the sphere's id */
    double cutoff;       /* 0: none; else FIBRAD_E_UNSUPPORTED */
    double tolerance;    /* 0: none. Else more directions and paths, from those above on, until row->error is not above
                            this, or there are FIBRAD_DIRECTIONS_MAX or FIBRAD_PATHS_MAX */
} fibrad_exchange_rule;

#define FIBRAD_PATHS_MAX (1u << 28)

/* Row i of the exchange factors of a scene: D_ij is the fraction of what sphere i emits that sphere j absorbs, directly
 * or after any number of diffuse reflections. D in f, what bodies absorb in body, what leaves in escaped; their sum is
 * 1 to rounding. The first leg is that of fibrad_beam_row; reflections are followed from point to point along `paths`
 * paths. row->error falls as directions^-1.5 and paths^-0.5 do. rays, unless NULL: how many were traced.
 * Errors: as fibrad_beam_row (of emissivities, those of sphere i and of bodies are checked), _UNSUPPORTED. Cost: the
 * beam row, and 0.1 to 0.2 microseconds a ray; a path has some 2 rays at emissivity 0.8, 14 at 0.2. Work memory: 3 KB
 * for each of up to 2048 lists of near spheres. Source: docs/heat.md. */
int fibrad_exchange_row(const fibrad_scene *scene, fibrad_work *work, uint32_t i, const fibrad_exchange_rule *rule,
                        fibrad_row *row, uint64_t *rays);

/* How far the emission of a sphere is carried. */
typedef struct fibrad_displacement {
    double square[3]; /* mean square displacement along each axis between the centres of the spheres that emit and
                         absorb, periods counted; what bodies absorb and what escapes counts as 0 [L^2] */
    double error[3];  /* standard errors, estimated [L^2] */
    double absorbed;  /* fraction that spheres absorb */
    uint64_t rays;
} fibrad_displacement;

/* The displacement of what sphere i emits, along rule->paths paths (0: 400); directions and tolerance are not used.
 * Errors: as fibrad_exchange_row. Cost: as its paths. */
int fibrad_exchange_displacement(const fibrad_scene *scene, fibrad_work *work, uint32_t i,
                                 const fibrad_exchange_rule *rule, fibrad_displacement *displacement);

/* ---- heat ------------------------------------------------------------------------------------------------------ */

/* Net radiative power of grey diffuse spheres and bodies of given temperatures. Each surface is cut into patches; beams
 * of points connect the patch they leave with the patch they meet, and serve both ways, so that exchange is symmetric:
 * at equal temperatures nothing flows, and all powers add up to zero. The radiosities J = eps E + (1 - eps) H follow by
 * conjugate gradients, first on coarse patches, four times as large, then on all; the powers of both are extrapolated
 * to patches without size. Source: docs/heat.md. Calls: _init; _trace of every task; then for each solution _begin,
 * rounds of _sweep of every part and one _step until it is solved, _read. */

#define FIBRAD_STEFAN_BOLTZMANN 5.670374419e-8 /* W/(m2 K4) */

typedef struct fibrad_heat_config {
    uint32_t directions; /* of the beams: [FIBRAD_DIRECTIONS_MIN, FIBRAD_DIRECTIONS_MAX], 0: 168 */
    uint32_t points;     /* per direction: 64, 128 or 256; 0: 64 */
    uint32_t patches;    /* of a sphere: 24, 96 or 384; 0: 96 */
    uint32_t parts;      /* into which a sweep is divided, for as many threads: [1, 1024]; 0: 8. The last bits of
                            powers depend on it */
    double cutoff;       /* 0: none; else FIBRAD_E_UNSUPPORTED */
} fibrad_heat_config;

/* Beams, patches and radiosities of a scene. */
typedef struct fibrad_heat fibrad_heat;

/* Bytes that fibrad_heat_init needs for a scene, and fibrad_heat_move for others of as many spheres and the same kinds
 * of bodies. About spheres times (4 directions points + 8 patches (8 + parts)). Errors: 0. */
size_t fibrad_heat_size(const fibrad_heat_config *config, const fibrad_scene *scene);

/* Makes a heat problem in `memory` (`size` bytes); the scene must stay as it is until fibrad_heat_move. Errors:
 * _ARGUMENT, _SIZE, _UNSUPPORTED. Cost: O(directions points). */
int fibrad_heat_init(fibrad_heat **heat, void *memory, size_t size, const fibrad_heat_config *config,
                     const fibrad_scene *scene);

/* Goes on to another scene of as many spheres and the same kinds of bodies, or to the same one rebuilt. All tasks are
 * to be traced again; the next solution starts from the last one. Errors: _ARGUMENT, _SIZE (walls that have moved so
 * far that their patches find no room). Cost: O(spheres patches). */
int fibrad_heat_move(fibrad_heat *heat, const fibrad_scene *scene);

/* How many tasks the beams are divided into: one per sphere, and some for the walls; how many parts a sweep has.
 * NULL: 0. */
uint32_t fibrad_heat_tasks(const fibrad_heat *heat);
uint32_t fibrad_heat_parts(const fibrad_heat *heat);

/* Follows the beams of a task [0, tasks), by several threads at once. Errors: _ARGUMENT, _WORK, _MEMORY (call again),
 * _STATE: traced before, or the scene has changed. Cost: about 1 microsecond per direction of 64 points. */
int fibrad_heat_trace(fibrad_heat *heat, fibrad_work *work, uint32_t task);

/* What radiates. fibrad_heat_sources_init fills in what NaN cannot stand for; NaN and sigma 0 are refused. */
typedef struct fibrad_heat_sources {
    const double *temperature;      /* [spheres] >= 0 */
    const double *emissivity;       /* [spheres] [0, 1] */
    const double *body_temperature; /* [bodies]; NULL if there are none */
    const double *body_emissivity;  /* [bodies] [0, 1]; NULL if there are none */
    double surroundings;            /* temperature of what beams meet that escape; black */
    double sigma;                   /* emission is sigma T^4 */
    double tolerance;               /* residual at which to stop, relative to the differences of emission; 0: 1e-3 */
    uint32_t sweeps_max;            /* 0: 1000 */
    int uniform; /* 1: one radiosity per sphere and wall, no extrapolation; wrong but for emissivities near 1 */
} fibrad_heat_sources;

/* Zeroes the sources but for surroundings, NaN (to be set), and sigma, FIBRAD_STEFAN_BOLTZMANN. NULL: nothing. */
void fibrad_heat_sources_init(fibrad_heat_sources *sources);

/* Begins a solution, from the last one if there is one. Errors: _ARGUMENT, _STATE: a task is not traced, or the scene
 * has changed. Cost: O(spheres patches). */
int fibrad_heat_begin(fibrad_heat *heat, const fibrad_heat_sources *sources);

/* One part [0, parts) of a sweep over all beams; each part once, in any order or by several threads at once. Errors:
 * _ARGUMENT, _STATE: nothing to sweep, or swept before. Cost: about 2 ns per beam. */
int fibrad_heat_sweep(fibrad_heat *heat, uint32_t part);

/* Ends a sweep. *solved: 0: another one is needed; 1: the solution is there, or about sweeps_max were made. Errors:
 * _ARGUMENT, _STATE: a part is not swept. Cost: O(spheres patches parts). */
int fibrad_heat_step(fibrad_heat *heat, int *solved);

/* The powers, positive where heat is gained. */
typedef struct fibrad_heat_result {
    double *power;             /* [spheres] out */
    double *body_power;        /* [bodies] out; NULL if there are none */
    double surroundings_power; /* out */
    double error_patches;      /* out: estimated error of the powers, root mean square over the spheres, that comes
                                  from the size of patches, ... */
    double error_beams;        /* out: ... and from the number of beams: take the root of the sum of squares */
    double residual;           /* out: that of the radiosities, as in `tolerance` */
    uint32_t sweeps;           /* out */
} fibrad_heat_result;

/* Reads the solution; result->power and body_power are the caller's. Errors: _ARGUMENT, _STATE: there is none, or the
 * scene has changed. */
int fibrad_heat_read(const fibrad_heat *heat, fibrad_heat_result *result);

#ifdef __cplusplus
}
#endif
#endif
