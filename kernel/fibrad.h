/* fibrad.h - view factors for thermal radiation between spheres. No heap, no I/O, no threads, no mutable globals.
 *
 * Index
 *   status   fibrad_status_text, fibrad_version
 *   lanes    fibrad_isa_best, fibrad_isa_name
 *   sample   fibrad_direction
 *   pair     fibrad_pair_exact
 *   scene    fibrad_scene_size, FIBRAD_SCENE_BYTES, fibrad_scene_init, fibrad_scene_describe, fibrad_scene_sphere
 *   work     fibrad_work_size, FIBRAD_WORK_BYTES, fibrad_work_init, fibrad_work_needed
 *   beam     fibrad_beam_row, fibrad_directions_for
 *   surface  fibrad_surface_pair, FIBRAD_SURFACE_SCRATCH, fibrad_surface_row
 *   cast     fibrad_cast_row
 *   moved    fibrad_moved_error, fibrad_moved_seen, fibrad_moved_same
 *   tracer   fibrad_tracer_size, fibrad_tracer_init
 *   exchange fibrad_exchange_row, fibrad_exchange_spread
 *   rows     fibrad_rows_average, fibrad_rows_average_weighted, fibrad_rows_average_part, fibrad_rows_limit,
 *            fibrad_rows_close, fibrad_rows_balance, fibrad_rows_drop, fibrad_rows_reciprocity
 *   heat     fibrad_heat_size, fibrad_heat_init, fibrad_heat_tasks, fibrad_heat_trace, fibrad_heat_begin,
 *            fibrad_heat_sweep, fibrad_heat_step, fibrad_heat_read, fibrad_radiosity
 *   furnace  fibrad_furnace_size, fibrad_furnace_init, fibrad_furnace_fields, fibrad_furnace_temperature,
 *            fibrad_furnace_theta, fibrad_furnace_solve, fibrad_furnace_balance, fibrad_furnace_tally_size,
 *            fibrad_furnace_tally_init, fibrad_furnace_tally_add, fibrad_furnace_emit, fibrad_furnace_trace,
 *            fibrad_furnace_estimate, fibrad_furnace_equilibrium
 *
 * Units    One length unit L, the caller's choice; angles in radians; view factors are dimensionless.
 * Memory   The caller owns every buffer, aligned as stated, and keeps it alive while it is used; there is no free.
 *          An `_init` function lays its object out in the block it is given and returns a pointer into it; the twin
 *          `_size` function tells the bytes that takes. Blocks for scenes and work begin on a 64-byte boundary.
 * Threads  Const objects may be shared between threads. A fibrad_work belongs to one thread at a time.
 * Errors   Functions that can fail return an int: FIBRAD_OK or a negative fibrad_status. Unless FIBRAD_OK is returned,
 *          outputs are untouched, except where a function says otherwise. Null pointers are FIBRAD_E_ARGUMENT.
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

#define FIBRAD_VERSION "0.1.0"

/* ---- status ---------------------------------------------------------------------------------------------------- */

/* The numbers never change their meaning. */
typedef enum fibrad_status {
    FIBRAD_OK = 0,
    FIBRAD_E_ARGUMENT = -1,  /* a null pointer, a value out of its range, NaN or infinity */
    FIBRAD_E_SIZE = -2,      /* the memory block is smaller than the `_size` function asks for */
    FIBRAD_E_ALIGNMENT = -3, /* the memory block does not begin on a 64-byte boundary */
    FIBRAD_E_CAPACITY = -4,  /* an output array or the work memory is too small; the call says what would suffice */
    FIBRAD_E_TABLE = -5,     /* that number of samples is not built in */
    FIBRAD_E_GEOMETRY = -6   /* equal centres, or the centre of one sphere inside another */
} fibrad_status;

/* One English sentence without a full stop for a status; never NULL, also for numbers that are no status. No errors.
 * Cost: a table. */
const char *fibrad_status_text(int status);

/* The version of the library linked in, FIBRAD_VERSION of its header: "major.minor.patch". No errors, no cost. */
const char *fibrad_version(void);

/* ---- lanes ----------------------------------------------------------------------------------------------------- */

/* Instruction sets the kernel is compiled for. All return the same bits. */
typedef enum fibrad_isa {
    FIBRAD_ISA_BEST = 0, /* the widest the machine offers; zeroed configurations mean this */
    FIBRAD_ISA_SCALAR = 1,
    FIBRAD_ISA_SSE2 = 2,
    FIBRAD_ISA_AVX2 = 3,
    FIBRAD_ISA_AVX512 = 4
} fibrad_isa;

/* The widest instruction set that both this build and this machine offer. No errors. Cost: two CPUID instructions,
 * microseconds under a hypervisor. */
fibrad_isa fibrad_isa_best(void);

/* "scalar", "sse2", "avx2", "avx512"; "best" for FIBRAD_ISA_BEST; "?" for other numbers. No errors, no cost. */
const char *fibrad_isa_name(int isa);

/* ---- sample ---------------------------------------------------------------------------------------------------- */

/* Bounds of the number of directions of a beam rule. Any number between them will do: sizes are no property of the
 * method, and one table of azimuths serves them all. */
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
 * Guarantee: relative error at most 1e-14 for r1/r2 in [1e-4, 1e4]; r1^2 F12 and r2^2 F21 agree to the
 * last bits; F is continuous and falls with gap.
 * Errors: FIBRAD_E_ARGUMENT. Cost: about 0.06 microseconds, 0.2 for overlaps; no libm call but sqrt.
 * Source: directional form of the exchange area, docs/methods.md section 2. */
int fibrad_pair_exact(double r1, double r2, double gap, double *f12);

/* ---- scene ----------------------------------------------------------------------------------------------------- */

/* Views of four arrays of length n: centres and radii [L]. r from 1e-150 to 1e150, coordinates up to 1e150 and 3e13
 * times the smallest radius (beyond, too few digits are left). */
typedef struct fibrad_spheres {
    const double *x, *y, *z, *r;
    uint32_t n;
} fibrad_spheres;

/* The largest number of spheres of a scene. */
#define FIBRAD_SPHERES_MAX 100000000u

/* Walls by number: 0 to 5 are planes across the axes, x low, x high, y low, y high, z low, z high; 6 is a cylinder
 * along z. Their inner sides bound a convex container, so that no wall hides one sphere from another. */
#define FIBRAD_WALLS 7

/* The walls of a scene. Zeroed: none. */
typedef struct fibrad_walls {
    uint32_t planes;    /* sum of 1 << k for the planes k there are, none on a periodic axis */
    double at[6];       /* [L] where plane k stands on its axis, low < high; not read if it is not there */
    double cylinder[3]; /* x and y of its axis, and its radius [L]; radius 0: none. With a cylinder x and y are open
                           axes without planes */
} fibrad_walls;

/* What a scene is made for. Zeroed but for `spheres`: open on all sides, no walls, the best instruction set. */
typedef struct fibrad_scene_config {
    uint32_t spheres; /* how many spheres the scene holds: [1, FIBRAD_SPHERES_MAX] */
    int isa;          /* a fibrad_isa; one that the machine lacks is FIBRAD_E_ARGUMENT */
    double period[3]; /* per axis the length of the periodic box [L]; 0: the axis is open */
    fibrad_walls walls;
} fibrad_scene_config;

/* A scene: spheres copied in the order of the cells of a grid. Immutable once made; share it between threads. */
typedef struct fibrad_scene fibrad_scene;

/* Where fibrad_scene_init found a fault: indices of the spheres concerned (equal when only one is). */
typedef struct fibrad_fault {
    uint32_t first, second;
} fibrad_fault;

/* Bytes that fibrad_scene_init needs for this configuration: they depend on the number of spheres alone. Errors: 0 if
 * the configuration is NULL or not valid. Cost: tens of nanoseconds, and that of fibrad_isa_best. */
size_t fibrad_scene_size(const fibrad_scene_config *config);

/* An upper bound of fibrad_scene_size for up to n spheres, as a constant expression, for static memory. */
#define FIBRAD_SCENE_BYTES(n) (5120 + (size_t)(n)*64)

/* Makes a scene in `memory` (`size` bytes on a 64-byte boundary) from config->spheres == spheres->n spheres, which are
 * copied: the arrays may go afterwards. On periodic axes centres may lie anywhere and are taken into the box.
 * Spheres may overlap each other and the walls (settled beds do), but no centre may lie inside another sphere or beyond
 * a wall. What leaves a sphere outwards beyond a wall meets that wall at once.
 * Errors: _ARGUMENT (then `fault`, unless NULL, names the sphere, or n if it is none of them), _SIZE, _ALIGNMENT,
 * _GEOMETRY (fault names the pair). Cost: O(n), about 0.5 microseconds per sphere; more where spheres crowd in clusters
 * far apart, at worst O(n^2). Source: docs/methods.md section 6. */
int fibrad_scene_init(fibrad_scene **scene, void *memory, size_t size, const fibrad_scene_config *config,
                      const fibrad_spheres *spheres, fibrad_fault *fault);

/* What a scene turned out to be. */
typedef struct fibrad_scene_facts {
    uint32_t spheres;
    int isa;                        /* the instruction set in use */
    uint32_t cells;                 /* cells of the grid, all levels */
    double radius_min, radius_max;  /* [L] */
    double overlap_max;             /* largest overlap of two spheres over the smaller radius, 0 if none overlap */
    uint32_t overlap_pair[2];       /* the spheres of the largest overlap */
    double wall_area[FIBRAD_WALLS]; /* [L^2] the part of each wall inside all others, per period of periodic axes;
                                       infinity: unbounded; 0: there is no such wall */
} fibrad_scene_facts;

/* Fills in the facts of a scene; null pointers: nothing. No errors. Cost: a copy. */
void fibrad_scene_describe(const fibrad_scene *scene, fibrad_scene_facts *facts);

/* The sphere that comes k-th along the cells of the grid, k < n: a permutation of all, in which neighbours in space are
 * mostly near each other. In large beds rows computed in this order find more of what they need in the cache.
 * Errors: UINT32_MAX (no scene, or no such k). */
uint32_t fibrad_scene_sphere(const fibrad_scene *scene, uint32_t k);

/* ---- work ------------------------------------------------------------------------------------------------------ */

/* Scratch memory for rows, one per thread. Zero means the default. */
typedef struct fibrad_work_config {
    uint32_t near;    /* near spheres kept per row for all its directions (farther ones are looked up per direction
                         and need no room): default 1024. A matter of speed alone */
    uint32_t discs;   /* spheres met in one window, hidden ones included: default 256 */
    uint32_t entries; /* different spheres seen by one row: default 1024 */
} fibrad_work_config;

typedef struct fibrad_workspace fibrad_workspace;
typedef fibrad_workspace fibrad_work;

/* Bytes that fibrad_work_init needs (NULL: all defaults). Errors: 0 if a number is above 2^28. Cost: tens of
 * nanoseconds. */
size_t fibrad_work_size(const fibrad_work_config *config);

/* An upper bound of fibrad_work_size as a constant expression, for static memory (no zeros here). */
#define FIBRAD_WORK_BYTES(near, discs, entries)                                                                        \
    (24576 + (size_t)(near)*128 + (size_t)(discs)*768 + (size_t)(entries)*96)

/* Makes work memory in `memory` (`size` bytes on a 64-byte boundary). It serves any scene, one row at a time.
 * Errors: _ARGUMENT, _SIZE, _ALIGNMENT. Cost: O(entries). */
int fibrad_work_init(fibrad_work **work, void *memory, size_t size, const fibrad_work_config *config);

/* After FIBRAD_E_CAPACITY from a row: a configuration under which that row gets farther (its `discs` as far as they
 * were met, its `entries` never more than the row can have). Repeat until the row succeeds; entries = number of spheres
 * always suffices. Null pointers: nothing. No errors. Cost: a copy. */
void fibrad_work_needed(const fibrad_work *work, fibrad_work_config *config);

/* ---- beam ------------------------------------------------------------------------------------------------------ */

/* One row of the matrix of view factors, in the caller's arrays. */
typedef struct fibrad_row {
    uint32_t *col;       /* [capacity] out: the spheres seen, ascending */
    double *f;           /* [capacity] out: F from sphere i to sphere col[.], all > 0 */
    uint32_t capacity;   /* in */
    uint32_t length;     /* out: entries; after FIBRAD_E_CAPACITY of these arrays: the entries there would be */
    double escaped;      /* out: the fraction that meets no sphere and no wall, as uncovered area or points */
    double error;        /* out: estimated Euclidean error of the row, from parts of its directions; twice the true one
                            on the median, seldom less than it */
    uint32_t directions; /* out, beam method only: how many were taken */
    uint32_t fallbacks;  /* out, beam method only: windows whose exact areas the fast method left to the robust one */
    double reach;        /* out, beam method only: how deep the windows have looked before they were covered [L];
                            infinity if one stayed open and there is no cutoff. See fibrad_moved_same */
    double wall[FIBRAD_WALLS]; /* out: the fraction that meets each wall, 0 for walls that are not there; `error` does
                                  not count them. The surface method leaves 0 */
} fibrad_row;

/* How a beam row is integrated. Zeroed: 233 directions, exact areas, no cutoff, no tolerance. */
typedef struct fibrad_beam_rule {
    uint32_t directions; /* [FIBRAD_DIRECTIONS_MIN, FIBRAD_DIRECTIONS_MAX] */
    uint32_t points;     /* 0: exact visible areas; 64, 128 or 256: that many points per window */
    double cutoff;       /* spheres whose centres are farther than this (1 + 1e-12) neither receive nor block [L];
                            0: none. A beam ends after 100 periods along any periodic axis */
    double error;        /* 0: none. Else the row is repeated with more directions, from `directions` on [100], until
                            row->error is not above this, or FIBRAD_DIRECTIONS_MAX are taken. Rows of different
                            directions are each closed, but averaging them does not keep their sums below 1 */
} fibrad_beam_rule;

/* Row i of the view factors of a scene, by parallel beams in the directions of the rule: sum of f + sum of wall +
 * escaped = 1, to rounding with exact areas, as exact counts with points. With exact areas the error falls as
 * directions^-1.5, that of the sharing between walls about as directions^-1 (5e-4 each at 233).
 * i [0, spheres); rule NULL: all defaults. Periodic images of one sphere share an entry, and i may see images of
 * itself. Errors: _ARGUMENT, _TABLE (points), _CAPACITY: either row->capacity (row->length then tells) or the work
 * memory (row->length is then 0, and fibrad_work_needed tells). Cost: some microseconds per direction with ten discs in
 * the window; it grows with the square of their number, which is large for a sphere among much smaller ones. Source:
 * docs/methods.md sections 3 and 4. */
int fibrad_beam_row(const fibrad_scene *scene, fibrad_work *work, uint32_t i, const fibrad_beam_rule *rule,
                    fibrad_row *row);

/* The directions with which to try next, after `directions` have given a row of estimated error `error` > wanted > 0
 * (both dimensionless): by the law directions^-1.5, a fifth more at least, FIBRAD_DIRECTIONS_MAX at most. No errors.
 * Cost: under a microsecond. Source: docs/methods.md section 3. */
uint32_t fibrad_directions_for(uint32_t directions, double error, double wanted);

/* ---- surface --------------------------------------------------------------------------------------------------- */

/* The method of Bao, Gao and Tan: a Fibonacci lattice of nodes on either sphere, about the line of centres and
 * clustered at its poles; the sum of cos cos/(pi e^2) over all pairs of nodes, those of sphere 2 once more turned by
 * pi; each ray tested against the obstacles. */

/* What a rule may switch off. All but the first are for proofs: they cost time and change no result. */
typedef enum fibrad_surface_flags {
    FIBRAD_SURFACE_NO_CORRECTION = 1, /* the plain sum, without the factor exact/unblocked */
    FIBRAD_SURFACE_NO_HORIZON = 2,    /* visit nodes that cannot see the other sphere */
    FIBRAD_SURFACE_NO_REGION = 4,     /* test rays against obstacles that they cannot meet */
    FIBRAD_SURFACE_NO_EXACT = 8,      /* sum even if nothing is in between */
    FIBRAD_SURFACE_NO_HIDDEN = 16     /* test every ray even if one obstacle hides the whole sphere */
} fibrad_surface_flags;

/* How a surface factor is integrated. Zeroed: 55 nodes, corrected, no cutoff, the best instruction set. */
typedef struct fibrad_surface_rule {
    uint32_t nodes; /* N_F, a Fibonacci number from 8 to 987; 0: 55 */
    uint32_t flags; /* sum of fibrad_surface_flags */
    double cutoff;  /* rows: spheres whose centres are farther than this (1 + 1e-12) neither receive nor block [L]; 0:
                       none, which is only possible without periodic axes; at most 100 periods of any of those */
    int isa;        /* pairs: a fibrad_isa (rows use that of the scene). FIBRAD_ISA_BEST asks the machine at every call,
                       which under a hypervisor takes longer than the pair; others are used unasked, so take what
                       fibrad_isa_best has returned once */
} fibrad_surface_rule;

/* What else a pair turned out to be. The sums are 0 if they were not needed. */
typedef struct fibrad_surface_facts {
    double unblocked, blocked; /* F12 as summed, without and with the obstacles, not corrected */
    double error;              /* half the difference between the two turns of sphere 2 */
    uint64_t rays, tests;      /* pairs of nodes summed and ray-sphere tests, in whole vectors of the instruction set */
} fibrad_surface_facts;

/* Doubles of scratch memory for n obstacles. */
#define FIBRAD_SURFACE_SCRATCH(n) (12 * (((size_t)(n) + 7) / 8 * 8))

/* View factor F12 from sphere 1 (radius r1, centre at the origin) to sphere 2 (radius r2, centre (0, 0, r1 + r2 + gap))
 * with obstacles in between. r1, r2, gap [L] as in fibrad_pair_exact, but these and the obstacles' coordinates and
 * radii at most 1e70 r1; overlapping spheres are summed as if they touched. The lattices begin at azimuth 0, the x
 * axis, so the result depends a little on the azimuth of an obstacle. A point inside an obstacle sees nothing. Without
 * obstacles in the way the result is fibrad_pair_exact, unless corrections are off. scratch
 * [FIBRAD_SURFACE_SCRATCH(obstacles->n)] on a 64-byte boundary; obstacles (with scratch), rule (all defaults) and facts
 * may be NULL. Errors: _ARGUMENT, _ALIGNMENT, _TABLE (nodes). Cost: about nodes^2/2 divisions and, for each obstacle in
 * the way, as many ray-sphere tests. Source: Y. Bao, Y. Gao, J. Tan (2022), docs/methods.md section 7. */
int fibrad_surface_pair(double r1, double r2, double gap, const fibrad_spheres *obstacles,
                        const fibrad_surface_rule *rule, double *scratch, double *f12, fibrad_surface_facts *facts);

/* Row i of the view factors of a scene by the surface method, pair by pair; blockers are the near spheres within the
 * cutoff, all of which the work memory must hold (fibrad_work_config.near). i [0, spheres). Sphere 1 of a pair is the
 * one of lower index; its frame has the z axis w towards sphere 2 and the x axis along a x w, a being the coordinate
 * axis that w has least of (the first where equal). So rows are reciprocal but for blockers within the
 * cutoff of one of two spheres. row->escaped is 1 - sum of f, as this method does not measure it; row->error is
 * the root of the sum of the pairs' squares. rule: NULL is all defaults; its isa is not used.
 * Errors: _ARGUMENT (included: no cutoff in a periodic scene, more than 2^28 spheres or images in the cube about the
 * cutoff), _TABLE (nodes), _CAPACITY as fibrad_beam_row. Cost: about 5 microseconds per partly hidden sphere within the
 * cutoff at 55 nodes, and 3 nanoseconds per pair of spheres within it. */
int fibrad_surface_row(const fibrad_scene *scene, fibrad_work *work, uint32_t i, const fibrad_surface_rule *rule,
                       fibrad_row *row);

/* ---- cast ------------------------------------------------------------------------------------------------------ */

/* How a row is sampled by rays. Zeroed: 20000 quasi-random rays, seed 0, no cutoff. */
typedef struct fibrad_cast_rule {
    uint32_t rays; /* 0: 20000 */
    int random;    /* 0: quasi-random numbers (`cast`); 1: pseudo-random numbers (`mc`) */
    uint64_t seed; /* what the random numbers, or the shift of the quasi-random set, come from, together with i */
    double cutoff; /* as in fibrad_beam_rule */
} fibrad_cast_rule;

/* What else the rays of a row tell, in the caller's arrays; entry k belongs to sphere col[k] of the row. */
typedef struct fibrad_cast_means {
    double *length; /* [row->capacity] out: mean length of the rays [L] */
    double *angle;  /* [row->capacity] out: mean angle between the rays and the line of centres [rad] */
} fibrad_cast_means;

/* Row i of the view factors of a scene, by rays: origins even over the sphere, directions by the cosine law in the
 * local frame, each followed to the first sphere by the distance to its surface. Factors are numbers of rays over all
 * rays, row->escaped is that of those that meet nothing, and row->error is estimated from every other ray.
 * A ray that starts inside another sphere meets it at once, at length 0, if its centre lies ahead. means: may be NULL.
 * The error falls as rays^-0.6, with random = 1 as rays^-0.5. i [0, spheres).
 * Errors: _ARGUMENT, _CAPACITY as fibrad_beam_row. Cost: about 0.1 microseconds per ray.
 * Source: docs/methods.md section 8; pebble-bed quasi-Monte Carlo with origins and directions as there. */
int fibrad_cast_row(const fibrad_scene *scene, fibrad_work *work, uint32_t i, const fibrad_cast_rule *rule,
                    fibrad_row *row, const fibrad_cast_means *means);

/* ---- moved ----------------------------------------------------------------------------------------------------- */

/* Rows of a bed that moves little can be kept for a while: docs/embedding.md has the loop. The two scenes hold the same
 * spheres, in the caller's order, in boxes of the same periods, at two times. */

/* How far row i, which was right for `before`, is off for `now`: estimated Euclidean error, twice the root of the
 * sum over the spheres j seen of (F delta/w)^2. delta [L]: change of the vector from i to j; F = r_j^2/(4 d^2), d the
 * lesser of their distances then and now; w the lesser of r_j and max(d - r_j, r_i). Estimates of successive steps add
 * up to one of all. Only row->col and ->length are read. No account is taken of walls, nor of spheres that come into
 * sight: fibrad_moved_seen.
 * Errors: _ARGUMENT. Cost: about 10 ns per entry. Source: docs/methods.md section 10. */
int fibrad_moved_error(const fibrad_scene *before, const fibrad_scene *now, uint32_t i, const fibrad_row *row,
                       double *error);

/* What the new row of sphere i tells about the rows of others: j sees i just as i sees j. Where F_ij has more than
 * doubled from the row before to the one now, as when i has come into sight, adds twice the change of A_i F_ij/A_j to
 * error[j], as root of the sum of squares. error [spheres]; order matters to its last bits.
 * Errors: _ARGUMENT. Cost: about 10 ns per entry. */
int fibrad_moved_seen(const fibrad_scene *now, uint32_t i, const fibrad_row *before, const fibrad_row *row,
                      double *error);

/* Which rows have not changed by a single bit: same[i] = 1 if no sphere that the windows of sphere i have met moved,
 * nor any into where they looked, reach[i] being the row->reach of the row in `before`; else 0. A row that sees out of
 * the bed, or a wall, changes with any sphere, and all rows with the walls. reach, same [spheres]; scratch [2 spheres].
 * Errors: _ARGUMENT. Cost: some microseconds per sphere. */
int fibrad_moved_same(const fibrad_scene *before, const fibrad_scene *now, const double *reach, unsigned char *scratch,
                      unsigned char *same);

/* ---- tracer ---------------------------------------------------------------------------------------------------- */

/* Memory for rays that go on from sphere to sphere, one per thread: lists of the spheres near each, made when a ray
 * first leaves it. Zero means the default. */
typedef struct fibrad_tracer_config {
    uint32_t lists; /* how many spheres' lists are kept, up to 2^20, taken up to a power of two; 3 KB each: default
                       2048. A matter of speed alone */
} fibrad_tracer_config;

typedef struct fibrad_tracer fibrad_tracer;

/* Bytes that fibrad_tracer_init needs; 0 if the configuration is not valid (NULL: all defaults). */
size_t fibrad_tracer_size(const fibrad_tracer_config *config);

/* Makes a tracer for one scene in `memory` (`size` bytes on a 64-byte boundary). A scene made anew, even in the same
 * place, needs a tracer made anew. Errors: _ARGUMENT, _SIZE, _ALIGNMENT. */
int fibrad_tracer_init(fibrad_tracer **tracer, void *memory, size_t size, const fibrad_tracer_config *config,
                       const fibrad_scene *scene);

/* ---- exchange -------------------------------------------------------------------------------------------------- */

/* How the exchange of grey diffuse spheres and walls is followed. Zeroed but for `emissivity`: see each. */
typedef struct fibrad_exchange_rule {
    const double *emissivity;             /* [spheres] of each sphere, (0, 1] */
    double wall_emissivity[FIBRAD_WALLS]; /* of each wall there is, [0, 1]; 0 reflects all */
    uint32_t directions; /* of the beam row that the first leg is taken from, by 256 points up to 144 of them, by exact
                            areas above; 0: 50 */
    uint32_t paths;      /* followed for the reflections; 0: 400 */
    uint64_t seed;       /* what their numbers come from, together with i */
    double error;        /* 0: none. Else more directions and paths, from those above on, until row->error is not above
                            this, or there are FIBRAD_DIRECTIONS_MAX of the former or FIBRAD_PATHS_MAX of the latter */
} fibrad_exchange_rule;

#define FIBRAD_PATHS_MAX (1u << 28)

/* Row i of the exchange factors of a scene: D_ij is the fraction of what sphere i emits that sphere j absorbs, directly
 * or after any number of diffuse reflections. Into row: D in f, what walls absorb in wall, what leaves in escaped;
 * their sum is 1 to rounding. The first leg is that of fibrad_beam_row; reflections are followed from point to point
 * along `paths` paths, which are the same whatever else is computed. row->error is the estimated Euclidean error of f;
 * it falls as directions^-1.5 and paths^-0.5 do. rays, unless NULL: how many were traced. The tracer is of the scene
 * concerned. i [0, spheres). Errors: _ARGUMENT (of emissivities, only that of sphere i is looked at), _CAPACITY as
 * fibrad_beam_row. Cost: the beam row, and 0.1 to 0.2 microseconds a ray; a path has some 2 rays at emissivity 0.8, 14
 * at 0.2. Source: docs/heat.md. */
int fibrad_exchange_row(fibrad_tracer *tracer, fibrad_work *work, uint32_t i, const fibrad_exchange_rule *rule,
                        fibrad_row *row, uint64_t *rays);

/* How far what a sphere emits is carried. */
typedef struct fibrad_spread {
    double square[3]; /* mean square of the distance along each axis between the centres of the spheres that emit and
                         absorb, periods counted; what walls absorb and what escapes counts as 0 [L^2] */
    double error[3];  /* standard errors, estimated [L^2] */
    double absorbed;  /* fraction that spheres absorb */
    uint64_t rays;
} fibrad_spread;

/* The spread of what sphere i emits, along rule->paths paths (0: 400); directions and error are not used.
 * i [0, spheres). Errors: _ARGUMENT. Cost: as the paths of fibrad_exchange_row. */
int fibrad_exchange_spread(fibrad_tracer *tracer, uint32_t i, const fibrad_exchange_rule *rule, fibrad_spread *spread);

/* ---- rows ------------------------------------------------------------------------------------------------------ */

/* A sparse matrix of view factors, compressed rows, in the caller's arrays. The functions of this section serve
 * exchange factors too, if for r they are given r sqrt(emissivity): then A is A emissivity. Source: docs/methods.md
 * section 5. */
typedef struct fibrad_rows {
    uint32_t n;        /* rows and columns */
    uint64_t capacity; /* length of col and f */
    uint64_t *start;   /* [n + 1]: row i is [start[i], start[i+1]) */
    uint32_t *col;     /* [capacity] ascending within each row, all < n */
    double *f;         /* [capacity] F from i to col */
} fibrad_rows;

/* Reciprocal view factors: out_ij = (A_i F_ij + A_j F_ji)/(2 A_i), with A = 4 pi r^2 and absent entries taken as 0, so
 * that A_i out_ij = A_j out_ji to rounding. `raw` and `out` share no array; out->n and out->capacity are set by the
 * caller (2 start[n] of raw is always enough, and fastest). All of out->col and out->f may be written. r [n] > 0.
 * Errors: _ARGUMENT (columns not ascending or out of range included), _CAPACITY (out->start[n] is then what is needed).
 * Cost: O(n + entries). */
int fibrad_rows_average(const fibrad_rows *raw, const double *r, fibrad_rows *out);

/* The same where some rows are more accurate than others: S_ij = (w_i A_i F_ij + w_j A_j F_ji)/(w_i + w_j) instead of
 * the plain mean. weight [n], 1e-100 to 1e100: best is 1/variance, for beam rows directions^3; NULL: all the same. Sums
 * of rows may then exceed 1 by their errors: fibrad_rows_limit. */
int fibrad_rows_average_weighted(const fibrad_rows *raw, const double *r, const double *weight, fibrad_rows *out);

/* Rows [begin, end) of that alone, to the bit; the others are left empty. For threads or processes that share the work,
 * each with an `out` of its own: always enough is a capacity of the entries that raw has in these rows and in these
 * columns. Cost: O(n + entries), which are read through three times, and what these rows take. */
int fibrad_rows_average_part(const fibrad_rows *raw, const double *r, const double *weight, uint32_t begin,
                             uint32_t end, fibrad_rows *out);

/* Brings row sums above 1 down to 1 and leaves reciprocity as it is: F_ij times min(s_i, s_j), s = min(1, 1/sum).
 * Rows averaged from exact areas need it only to the last bit. scratch [n].
 * Errors: _ARGUMENT. Cost: O(entries). */
int fibrad_rows_limit(fibrad_rows *rows, double *scratch);

/* Closes rows that were averaged or limited: wall[i] and escaped[i], from the raw row i, are multiplied such that
 * sum of f + sum of wall + escaped = 1. What a row lacks of 1 is as good a measure of what meets no sphere, from the
 * opposite directions, as the raw row's. A row whose raw one met neither wall nor sky takes the shares of all spheres
 * together; if none has any, what is lacking counts as escaped. wall, escaped [n], r [n] > 0.
 * Errors: _ARGUMENT. Cost: O(entries). */
int fibrad_rows_close(const fibrad_rows *rows, const double *r, double (*wall)[FIBRAD_WALLS], double *escaped);

/* Brings the row sums of reciprocal rows to `target` and leaves reciprocity as it is: F_ij u_i u_j with u found so; to
 * 1e-14 where such u exist, as they do if rows have an F_ii or loops of three and are not far off. Else some rows end
 * below their targets, none above. For rows whose errors leave their sums off, as those of exchange factors do.
 * target [n] >= 0, scratch [2 n]. Errors: _ARGUMENT. Cost: O(entries) times some 40. */
int fibrad_rows_balance(fibrad_rows *rows, const double *target, double *scratch);

/* Drops entries below `threshold` (both of a reciprocal pair when both are below) and gives what they carried back to
 * the entries that stay, symmetrically: S_ij u_i u_j with u found so that the row sums are as before; what no such u
 * can place (a sphere that loses all it saw) goes into F_ii. Closure and reciprocity hold to 1e-14 afterwards.
 * `rows` must be reciprocal; they shrink in place, but a row that gets an F_ii of its own needs room for it.
 * scratch [3 n]. Errors: _ARGUMENT; _CAPACITY: no room for all F_ii (start[n] + n always suffices), what could not be
 * placed is then missing. Cost: O(entries) times 60. */
int fibrad_rows_drop(fibrad_rows *rows, const double *r, double threshold, double *scratch);

/* The largest |A_i F_ij - A_j F_ji| / max(A_i, A_j) over all entries, absent partners taken as 0.
 * Errors: _ARGUMENT. Cost: O(entries log(row length)). */
int fibrad_rows_reciprocity(const fibrad_rows *rows, const double *r, double *largest);

/* ---- heat ------------------------------------------------------------------------------------------------------ */

/* Net radiative power of grey diffuse spheres and walls of given temperatures. Each surface is cut into patches; beams
 * of points connect the patch they leave with the patch they meet, and serve both ways, so that exchange is symmetric:
 * at equal temperatures nothing flows, and the powers of all spheres, walls and surroundings add up to zero. The
 * radiosities J = eps E + (1 - eps) H follow by conjugate gradients, first on coarse patches, four times as large,
 * then on all; the powers of both are extrapolated to patches without size. docs/heat.md. */

typedef struct fibrad_heat_config {
    uint32_t directions; /* of the beams: [FIBRAD_DIRECTIONS_MIN, FIBRAD_DIRECTIONS_MAX], 0: 168 */
    uint32_t points;     /* per direction: 64, 128 or 256; 0: 64 */
    uint32_t patches;    /* of a sphere: 24, 96 or 384; 0: 96 */
    uint32_t parts;      /* into which a sweep is divided, for as many threads: [1, 1024]; 0: 8 */
} fibrad_heat_config;

/* Beams, patches and radiosities of a scene. */
typedef struct fibrad_heat fibrad_heat;

/* Bytes that fibrad_heat_init needs for a scene; 0 if the configuration is not valid. About spheres times (4 directions
 * points + 8 patches (8 + parts)). */
size_t fibrad_heat_size(const fibrad_heat_config *config, const fibrad_scene *scene);

/* Makes a heat problem in `memory` (`size` bytes on a 64-byte boundary); the scene must stay as long. Errors:
 * _ARGUMENT, _SIZE, _ALIGNMENT. Cost: O(directions points). */
int fibrad_heat_init(fibrad_heat **heat, void *memory, size_t size, const fibrad_heat_config *config,
                     const fibrad_scene *scene);

/* How many tasks the beams are divided into: one per sphere, and some for the walls. */
uint32_t fibrad_heat_tasks(const fibrad_heat *heat);

/* Follows the beams of a task [0, tasks). To be called for every task before the first solution, in any order and by
 * several threads at once, each with a work memory of its own. Errors: _ARGUMENT, _CAPACITY as fibrad_beam_row.
 * Cost: about 1 microsecond per direction of 64 points. */
int fibrad_heat_trace(fibrad_heat *heat, fibrad_work *work, uint32_t task);

/* What radiates. */
typedef struct fibrad_heat_sources {
    const double *temperature;             /* [spheres] of the caller's spheres, absolute, >= 0 */
    const double *emissivity;              /* [spheres] [0, 1] */
    double wall_temperature[FIBRAD_WALLS]; /* of the walls that are there */
    double wall_emissivity[FIBRAD_WALLS];  /* [0, 1] */
    double surroundings;                   /* temperature of what beams meet that escape; black */
    double sigma;                          /* emission is sigma T^4: FIBRAD_STEFAN_BOLTZMANN in SI units */
    double tolerance;    /* residual at which to stop, relative to the differences of emission: 0: 1e-3 */
    uint32_t sweeps_max; /* 0: 1000 */
    int uniform;         /* 1: one radiosity per sphere and wall, no extrapolation; wrong but for
                            emissivities near 1, docs/heat.md */
} fibrad_heat_sources;

/* Begins a solution; a previous one of this heat problem is where it starts. Errors: _ARGUMENT. Cost: O(spheres
 * patches). */
int fibrad_heat_begin(fibrad_heat *heat, const fibrad_heat_sources *sources);

/* One part [0, parts) of a sweep over all beams. Every part once, in any order or by several threads at once, then
 * fibrad_heat_step:
 *
 *     do
 *         for (uint32_t part = 0; part < parts; part++) fibrad_heat_sweep(heat, part);
 *     while (fibrad_heat_step(heat));
 *
 * Cost: about 2 ns per beam. */
void fibrad_heat_sweep(fibrad_heat *heat, uint32_t part);

/* Ends a sweep. 1: another one is needed; 0: solved, or about sweeps_max made. Cost: O(spheres patches parts). */
int fibrad_heat_step(fibrad_heat *heat);

/* The powers, positive where heat is gained. */
typedef struct fibrad_heat_result {
    double *power;                   /* [spheres] out, of the caller's spheres */
    double wall_power[FIBRAD_WALLS]; /* out */
    double surroundings_power;       /* out */
    double error_patches; /* out: estimated error of the powers, root mean square over the spheres, that comes
                             from the size of patches, ... */
    double error_beams;   /* out: ... and from the number of beams: take the root of the sum of squares */
    double residual;      /* out: that of the radiosities, as in `tolerance` */
    uint32_t sweeps;      /* out */
} fibrad_heat_result;

/* Reads the solution; result->power is the caller's. Errors: _ARGUMENT (unsolved included). */
int fibrad_heat_read(const fibrad_heat *heat, fibrad_heat_result *result);

/* Net powers from view factors with one radiosity per sphere: quick, and exact where all emissivities are 1. Else it is
 * wrong, since light that a sphere reflects comes out on all its sides alike: in packed beds it conducts 1.3 times too
 * much at emissivity 0.8 and 4 times at 0.2, docs/heat.md. `rows` are reciprocal (fibrad_rows_average), r [n] > 0; what
 * a row lacks of 1 goes to the surroundings. Of `sources` walls and `uniform` are not read, tolerance 0 is 1e-6; of
 * `result` walls and errors are 0. scratch [3 n].
 * Errors: _ARGUMENT. Cost: O(entries) for each of about ten sweeps. */
int fibrad_radiosity(const fibrad_rows *rows, const double *r, const fibrad_heat_sources *sources, double *scratch,
                     fibrad_heat_result *result);

/* ---- furnace --------------------------------------------------------------------------------------------------- */

/* Radiation in a box full of a grey medium which absorbs, emits and scatters isotropically, between grey diffuse walls
 * of known temperatures. The medium takes the temperatures at which every cell gives off `source`. Metres, watts and
 * kelvins here; E = sigma T^4 [W/m2]. docs/furnace.md tells the methods. */

#define FIBRAD_STEFAN_BOLTZMANN 5.670374419e-8 /* W/(m2 K4) */

#define FIBRAD_FURNACE_CELLS_MAX 100000000u

typedef struct fibrad_furnace_config {
    double size[3];             /* m, from 1e-9 to 1e9 */
    uint32_t cells[3];          /* along x, y, z; the product is at most FIBRAD_FURNACE_CELLS_MAX */
    double absorption;          /* 1/m; times an edge of a cell from 1e-9 to 1e9: unabsorbed there is no temperature */
    double scattering;          /* 1/m; times an edge of a cell from 0 to 1e9 */
    double source;              /* W/m3 given off by the medium, of either sign, up to 1e30 */
    double wall_temperature[6]; /* K, 1e-3 to 1e9; walls in the order x = 0, x = X, y = 0, y = Y, z = 0, z = Z */
    double wall_emissivity[6];  /* [0, 1], not all 0 */
    uint64_t seed;              /* of the bundles of rays */
} fibrad_furnace_config;

/* The state of one box: temperatures, fluxes, coefficients, and which bundles are to be traced next. */
typedef struct fibrad_furnace fibrad_furnace;

/* Bytes that fibrad_furnace_init needs. Errors: 0 if the configuration is NULL or not valid. Cost: tens of
 * nanoseconds. */
size_t fibrad_furnace_size(const fibrad_furnace_config *config);

/* Makes a furnace in `memory` (`size` bytes on a 64-byte boundary): E is the mean of the walls, Theta 2/3 everywhere.
 * Errors: _ARGUMENT, _SIZE, _ALIGNMENT. Cost: O(cells). */
int fibrad_furnace_init(fibrad_furnace **furnace, void *memory, size_t size, const fibrad_furnace_config *config);

/* The arrays of a furnace, x fastest. `cell` arrays have cells[0] cells[1] cells[2] elements; `face` arrays of axis a
 * one layer more along a; hemisphere 0 goes up the axis, 1 down. The caller may write e, flux and theta. */
typedef struct fibrad_furnace_arrays {
    double *e;                /* cell: sigma T^4 [W/m2] */
    double *divergence;       /* cell: net radiation given off [W/m3]; equals the source once solved */
    double *six_flux;         /* cell: sum of the mean fluxes of its faces, both hemispheres of all axes [W/m2] */
    double *flux[3][2];       /* face: q+ and q- of the axis [W/m2], as solved or measured last */
    double *theta[3][2];      /* face: Theta+ and Theta-, as set or measured last */
    double *transverse[3][2]; /* cell: C+ and C-, over the mean flux of the cell's two faces [1/m] */
    double *wall[6];          /* net flux from the wall [W/m2], a layer of cells each */
    double *power;            /* [6] what each wall gives, net [W] */
} fibrad_furnace_arrays;

/* Tells where the arrays are, which stay there; null pointers: nothing. No errors. Cost: a copy. */
void fibrad_furnace_fields(fibrad_furnace *furnace, fibrad_furnace_arrays *arrays);

/* Temperature [K] of E [W/m2]; 0 unless E is positive. No errors. Cost: two square roots. */
double fibrad_furnace_temperature(double e);

/* Makes Theta the same constant everywhere, (0, 1], without transverse term: 1 for the heat-flux method (HFM), 2/3 for
 * isotropic radiation. Errors: _ARGUMENT. Cost: O(cells). Source: docs/furnace.md. */
int fibrad_furnace_theta(fibrad_furnace *furnace, double theta);

/* What the scattered part of the heat-flux equations is made of. */
typedef enum fibrad_furnace_scatter {
    FIBRAD_SCATTER_SIX_FLUX = 0, /* a sixth of the sum of the six fluxes */
    FIBRAD_SCATTER_EXACT = 1     /* E - source/(4 absorption), a quarter of the true incident radiation */
} fibrad_furnace_scatter;

typedef struct fibrad_furnace_report {
    uint32_t sweeps;
    double change; /* largest change of E in the last sweep [W/m2] */
} fibrad_furnace_report;

/* Solves the heat-flux equations for E and the fluxes, with Theta and the transverse term as they stand: sweeps along
 * all lines of cells, each solved exactly between its two walls, until no cell changes by more than `tolerance`
 * [W/m2] or sweeps_max is reached (which the report shows; it is no error).
 * Errors: _ARGUMENT. Cost: about 60 ns per cell and sweep; tens of sweeps where the medium is thin, more with the
 * square of the optical thickness. Source: Zhao, Li, Wu, Li, Cang, J. Univ. Sci. Technol. Beijing 27 (2005) 423,
 * equations 5 to 8. */
int fibrad_furnace_solve(fibrad_furnace *furnace, fibrad_furnace_scatter scatter, double tolerance, uint32_t sweeps_max,
                         fibrad_furnace_report *report);

/* Sets divergence, six_flux, wall and power from the fluxes, which the caller has written: for other solvers.
 * Errors: _ARGUMENT. Cost: O(cells). */
int fibrad_furnace_balance(fibrad_furnace *furnace);

/* Counts of bundles, in whole numbers: any split of the work adds up to the same bits. */
typedef struct fibrad_furnace_tally fibrad_furnace_tally;

/* Bytes that fibrad_furnace_tally_init needs for a tally of this furnace. Errors: 0 for NULL. Cost: tens of
 * nanoseconds. */
size_t fibrad_furnace_tally_size(const fibrad_furnace *furnace);

/* Makes an empty tally in `memory` (`size` bytes on a 64-byte boundary), for one thread at a time.
 * Errors: _ARGUMENT, _SIZE, _ALIGNMENT. Cost: O(cells). */
int fibrad_furnace_tally_init(fibrad_furnace_tally **tally, void *memory, size_t size, const fibrad_furnace *furnace);

/* Adds `from` to `to`, tallies of the same furnace (of others, and with null pointers, nothing). Cost: O(cells). */
void fibrad_furnace_tally_add(fibrad_furnace_tally *to, const fibrad_furnace_tally *from);

/* What bundles of rays do. */
typedef enum fibrad_furnace_physics {
    FIBRAD_FURNACE_ATTENUATED = 0, /* lose energy to the medium, whose emission follows E: for Theta */
    FIBRAD_FURNACE_EQUILIBRIUM = 1 /* what is absorbed is given off again, so that E follows: direct Monte Carlo */
} fibrad_furnace_physics;

/* Plans the bundles to be traced next. Transport is linear, and tallies add up: after the first plan, which takes about
 * `bundles` bundles for all that walls and medium emit above the mean of the walls, each further plan carries only what
 * the change of E since then adds, at the same energy per bundle. `restart` makes a first plan again, for new tallies.
 * `planned` gets the number of bundles: every source is given a whole number of them, at least one.
 * bundles [1, 2^32]. Errors: _ARGUMENT, also if E is not finite or its change asks for more than 2^33 bundles; there is
 * no plan then, and the next is a first one. Cost: O(cells). */
int fibrad_furnace_emit(fibrad_furnace *furnace, fibrad_furnace_physics physics, uint64_t bundles, int restart,
                        uint64_t *planned);

/* Traces bundles [first, first + count) of the plan into a tally. The furnace is only read: threads may share it.
 * Errors: _ARGUMENT, also for the tally of a furnace of other cells. Cost: about 0.6 (equilibrium) to 1.1 microseconds
 * per bundle in a box of 20 x 20 x 40 cells; it goes with the number of events until absorption, which in a thick
 * medium is the square of the optical thickness, and between walls that hardly absorb 1/emissivity. */
int fibrad_furnace_trace(const fibrad_furnace *furnace, fibrad_furnace_tally *tally, uint64_t first, uint64_t count);

/* Which ratio of the moments F_n = sum(w cos^n) over the bundles that cross a face is taken for Theta. */
typedef enum fibrad_furnace_estimator {
    FIBRAD_THETA_DEFINITION = 0, /* F1/F0: the ratio of equations 1 and 2; 2/3 for isotropic radiation */
    FIBRAD_THETA_PAPER = 1       /* F2/F1: equation 9 read with bundles of energy; 3/4 for isotropic radiation */
} fibrad_furnace_estimator;

/* Sets flux and Theta from the sum of all tallies since the last restart (FIBRAD_FURNACE_ATTENUATED); with `transverse`
 * not 0 (FIBRAD_THETA_DEFINITION only) also the term of equations 5 and 6 that the paper drops, from the balance of
 * each cell. Mirror images and exchanged axes under which the box stays as it is are averaged over. Where bundles are
 * so few that a moment is not positive, Theta stays as it was. Errors: _ARGUMENT. Cost: O(cells). */
int fibrad_furnace_estimate(fibrad_furnace *furnace, const fibrad_furnace_tally *tally,
                            fibrad_furnace_estimator estimator, int transverse, fibrad_furnace_scatter scatter);

/* Sets E, wall fluxes and powers from the sum of all tallies since the last restart (FIBRAD_FURNACE_EQUILIBRIUM).
 * Errors: _ARGUMENT, also after a plan of the other physics and for the tally of a furnace of other cells. Cost:
 * O(cells times symmetries). */
int fibrad_furnace_equilibrium(fibrad_furnace *furnace, const fibrad_furnace_tally *tally);

#ifdef __cplusplus
}
#endif
#endif
