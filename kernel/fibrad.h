/* fibrad.h - view factors and exchange factors for thermal radiation between spheres, with walls around them.
 *
 * This first page is enough for view factors: rows, and their matrix. The sections below have all the rest.
 *
 * A view factor F_ij is the fraction of the radiation leaving sphere i that reaches sphere j directly. Row i holds all
 * factors from sphere i: to spheres, to walls and to the surroundings. The sum of a row is 1. In a matrix of all rows
 * A_i F_ij = A_j F_ji, with the areas A of the spheres.
 *
 * The calls, in order
 *   rows     1. fibrad_scene_init     a scene from centres and radii, and from walls and periods if there are any
 *            2. fibrad_beam_row       a row of the scene: any sphere, in any order
 *   matrix   3. fibrad_matrix_init    all rows of the scene
 *            4. fibrad_matrix_close   makes them agree
 *            5. fibrad_matrix_read    the matrix in compressed rows
 *   threads  Several threads may call fibrad_beam_row. Each has a fibrad_work and a fibrad_rows of its own. Hand all
 *            collections to fibrad_matrix_init.
 *   accuracy A matrix of rows along lines has about half the error of a matrix of rows along as many directions. Make
 *            one set of lines by fibrad_line_set_init, and set fibrad_beam_rule.lines. All threads share the set.
 *
 * Example: the matrix of n spheres by one thread. docs/embedding.md has complete programs.
 *   static void *resize(void *context, void *block, size_t size) { return (void)context, realloc(block, size); }
 *   ...
 *   const fibrad_spheres spheres = {.x = x, .y = y, .z = z, .r = r, .n = n};
 *   size_t size = fibrad_scene_size(n, 0);
 *   fibrad_scene *scene;
 *   int status = fibrad_scene_init(&scene, malloc(size), size, NULL, &spheres, NULL);
 *
 *   fibrad_work work = {.memory.resize = resize};
 *   fibrad_rows rows = {.memory.resize = resize};
 *   fibrad_row row = {.rows = &rows};
 *   for (uint32_t i = 0; i < n && status == FIBRAD_OK; i++) status = fibrad_beam_row(scene, &work, i, NULL, &row);
 *   if (status != FIBRAD_OK) return puts(fibrad_status_text(status)), 1;
 *
 *   fibrad_matrix *matrix;
 *   fibrad_factors f;
 *   size = fibrad_matrix_size(scene, &rows, 1, NULL);
 *   status = fibrad_matrix_init(&matrix, malloc(size), size, scene, &rows, 1, NULL, NULL);
 *   if (status == FIBRAD_OK) status = fibrad_matrix_close(matrix);
 *   if (status == FIBRAD_OK) status = fibrad_matrix_read(matrix, &f);
 *   The factors from sphere i are f.f[k] to the spheres f.col[k], for k from f.start[i] to f.start[i + 1] - 1.
 *   f.escaped[i] is its factor to the surroundings, f.error[i] its estimated error.
 *
 * Words
 *   wall           A plane, a cylinder or a mesh of triangles. Wall b is element b of fibrad_scene_config.wall.
 *   surroundings   What lies outside the scene, black. Radiation reaches them past everything, or through an opening.
 *   direction      A unit vector. The directions of a row are spread evenly.
 *   line           A direction and its opposite. A row goes along directions or along lines, never along both.
 *   window         The disc as which sphere i is seen along a direction or a line.
 *   entry, column  An entry is one factor of a row. Its column is the index of the sphere that receives.
 *   error of a row The root of the sum of the squared errors of the row's factors.
 *
 * Conventions
 *   Units     All lengths have one unit L, which the caller chooses. Angles are in radians. Factors have no unit.
 *             Temperatures are absolute.
 *   Comments  The comment of a field begins with its unit and its shape. x[n] is an array of n elements. A range
 *             "a to b" includes both ends. "out" marks a field that the function writes.
 *   Memory    The library has no heap. The caller owns every block, and no function frees one. A block may have any
 *             alignment and must stay in place. `X_init` makes an object inside a block and returns a pointer into it.
 *             `X_size` returns the bytes that X_init needs, or 0 if an argument is not valid.
 *   Threads   The library has no threads, no input or output and no mutable global variables. Threads may share const
 *             objects. A fibrad_work or a fibrad_rows belongs to one thread at a time.
 *   Errors    A function that can fail returns FIBRAD_OK or a negative fibrad_status. After an error the outputs are
 *             as before, except where the function's comment says otherwise.
 *   Defaults  Set all fields of a structure to 0. Then set the fields that you need. The comment of a field says what 0
 *             means. "Zeroed" says what a structure of zeros means.
 *   Bits      Results depend on the arguments alone. They are the same to the bit for every number of threads,
 *             instruction set, compiler and optimisation level.
 *
 * Index        what for                                 functions and types
 *   status     what a call returned                     fibrad_status_text, fibrad_version
 *   memory     a block of bytes, fixed or growing       fibrad_memory, fibrad_resize
 *   isa        instruction sets, chosen at run time     fibrad_isa_best, _name
 *   direction  directions spread evenly over a sphere   fibrad_direction
 *   pair       two spheres with nothing in between      fibrad_pair_exact
 *   scene      spheres, walls, divided beds             fibrad_scene_size, _init, _describe, _wall_area, _sphere
 *              centres inside other spheres             fibrad_spheres_inside
 *              clumps: what is exposed of a member      fibrad_clumps_size, _scene_exposed_area, _scene_volume
 *   work       scratch memory of one thread             fibrad_work, FIBRAD_WORK_BYTES
 *   row        one row, by beams or by rays             fibrad_beam_row, fibrad_cast_row, fibrad_directions_for
 *              lines for the rows of a matrix           fibrad_line_set_lines, _size, _init
 *   rows       a collection of rows                     fibrad_rows_add, _clear, _read
 *   matrix     all rows: averaged, reciprocal, closed   fibrad_matrix_size, _init, _close, _read, _reciprocity
 *   exchange   factors after reflections (grey)         fibrad_exchange_row, _wall, _wall_mean, _displacement
 *              spheres that conduct                     fibrad_relative_conductivity, fibrad_node_emissivity
 *              powers from rows                         fibrad_rows_flow, fibrad_flow
 *
 * Other headers: fibrad_limits.h (bounds and defaults), fibrad_heat.h (net powers and temperatures), fibrad_light.h
 * (light from outside), fibrad_mesh.h (walls of triangles), fibrad_surface.h (the method of Bao, Gao and Tan),
 * fibrad_furnace.h (a box with a participating medium).
 *
 * SPDX-License-Identifier: MIT */
#ifndef FIBRAD_H
#define FIBRAD_H

#include <stddef.h>
#include <stdint.h>

#include "fibrad_limits.h"
#ifdef __cplusplus
extern "C" {
#endif

#define FIBRAD_VERSION "0.5.0"

#define FIBRAD_STEFAN_BOLTZMANN 5.670374419e-8 /* W/(m2 K4) */

/* ---- status ---------------------------------------------------------------------------------------------------- */
/* What a call returned. The numbers never change their meaning. The error for a null pointer is FIBRAD_E_ARGUMENT. The
 * error for a scene that is not complete is FIBRAD_E_STATE. A scene is complete once fibrad_scene_init has returned
 * FIBRAD_OK. */
typedef enum fibrad_status {
    FIBRAD_OK = 0,
    FIBRAD_E_ARGUMENT = -1,     /* A pointer is null, or a value is out of its range, NaN or infinite. */
    FIBRAD_E_SIZE = -2,         /* The block is smaller than the `_size` function says. */
    FIBRAD_E_CAPACITY = -4,     /* An output is too small. `length` or memory.needed is the size that suffices. */
    FIBRAD_E_TABLE = -5,        /* There is no set of so many points or lines. */
    FIBRAD_E_GEOMETRY = -6,     /* A centre inside another sphere, a sphere beyond an opening, a period too short */
    FIBRAD_E_WORK = -7,         /* Fixed work memory is too small. work.memory.needed is the size that suffices. */
    FIBRAD_E_STATE = -8,        /* A call is missing, too early or repeated, or another scene has taken its memory. */
    FIBRAD_E_ISA = -9,          /* This build or this machine lacks the instruction set. */
    FIBRAD_E_UNSUPPORTED = -10, /* The request is valid, but this version cannot compute it. */
    FIBRAD_E_MEMORY = -11,      /* A resize function or the heap has no more memory. */
    FIBRAD_E_CANCELLED = -12,   /* A progress function has asked to stop. */
    FIBRAD_E_UNSOLVABLE = -13,  /* No temperatures give the powers that were asked for. */
    FIBRAD_E_BACK = -14,        /* A ray met a side that belongs to no wall. The triangle is written to the output. */
    FIBRAD_E_SUM = -15,         /* A row's sum is not 1 within 1e-9. This is a fault of the library. */
    FIBRAD_E_ENDLESS = -16,     /* The walls form a tube or a corner without end. Add a wall or an opening. */
    FIBRAD_E_FILE = -17,        /* A file cannot be made, written or renamed. Only functions of the host return this. */
    FIBRAD_E_UNSETTLED = -18    /* A search for radiosities and temperatures has not ended after all its sweeps. */
} fibrad_status;

/* The meaning of a status, which may be any number, as one English phrase. Never NULL. */
const char *fibrad_status_text(int status);

/* The FIBRAD_VERSION of the library that the program is linked with. */
const char *fibrad_version(void);

/* ---- memory ---------------------------------------------------------------------------------------------------- */
/* A function of the caller that makes a block larger, as realloc does. block: NULL at the first call. It returns a
 * block of `size` bytes with the contents of the old block, or NULL if there is no memory. Then the old block stays. */
typedef void *fibrad_resize(void *context, void *block, size_t size);

/* A block of memory that the library fills and never frees. There are two kinds.
 *   fixed    Set `block` and `size`.
 *   growing  Set `resize`. The block may be NULL at first. The library calls `resize` whenever it needs more bytes. */
typedef struct fibrad_memory {
    void *block;           /* [size], any alignment; may be NULL if size is 0 */
    size_t size;           /* bytes */
    fibrad_resize *resize; /* NULL: the block is fixed */
    void *context;         /* handed to resize */
    size_t needed;         /* bytes, out: the size that suffices, after FIBRAD_E_WORK and FIBRAD_E_CAPACITY */
} fibrad_memory;

/* ---- isa ------------------------------------------------------------------------------------------------------- */
/* Instruction sets. All of them return the same bits. */
typedef enum fibrad_isa {
    FIBRAD_ISA_BEST = 0, /* the widest that this build and this machine have */
    FIBRAD_ISA_SCALAR = 1,
    FIBRAD_ISA_SSE2 = 2,
    FIBRAD_ISA_AVX2 = 3,
    FIBRAD_ISA_AVX512 = 4,
    FIBRAD_ISA_NEON = 5 /* aarch64 */
} fibrad_isa;

/* The widest instruction set that this build and this machine have. The call takes microseconds. */
fibrad_isa fibrad_isa_best(void);

/* "best", "scalar", "sse2", "avx2", "avx512" or "neon"; "?" for any other number. */
const char *fibrad_isa_name(int isa);

/* ---- direction, pair ------------------------------------------------------------------------------------------- */
/* Direction k of the spherical Fibonacci set of n directions: z = 1 - (2k + 1)/n, azimuth = k golden angles.
 *   Input    n: FIBRAD_DIRECTIONS_MIN to FIBRAD_DIRECTIONS_MAX
 *   Errors   _ARGUMENT
 *   Source   R. Swinbank, R. J. Purser, Q. J. R. Meteorol. Soc. 132 (2006) 1769, with a half-integer offset in z */
int fibrad_direction(uint32_t k, uint32_t n, double direction[3]);

/* View factor F12 from sphere 1 to sphere 2 with nothing in between.
 *   Input    r1, r2: radii [L], FIBRAD_LENGTH_MIN to FIBRAD_LENGTH_MAX
 *            gap: distance of the surfaces [L], above -2 min(r1, r2). A negative gap is an overlap.
 *   Output   f12: relative error at most 1e-14 if r1/r2 is within 1e-4 to 1e4. r1^2 F12 = r2^2 F21 to rounding.
 *   Errors   _ARGUMENT
 *   Cost     0.06 microseconds, 0.2 for overlaps
 *   Source   directional form of the exchange area, docs/methods.md section 2 */
int fibrad_pair_exact(double r1, double r2, double gap, double *f12);

/* ---- scene ----------------------------------------------------------------------------------------------------- */
/* The spheres of a scene. The centre of sphere i is at x[i * stride], y[i * stride], z[i * stride]. The radius of
 * sphere i is r[i * stride_r]. With the smallest radius r_min, |coordinate| <= min(FIBRAD_LENGTH_MAX, 3e13 r_min).
 * Example: if double at[n][3] has the centres, spheres = {&at[0][0], &at[0][1], &at[0][2], r, n, .stride = 3}. */
typedef struct fibrad_spheres {
    const double *x, *y, *z;   /* L, [n], coordinates of the centres; NULL if n = 0 */
    const double *r;           /* L, [n], FIBRAD_LENGTH_MIN to FIBRAD_LENGTH_MAX; NULL if n = 0 */
    uint32_t n;                /* 0 to FIBRAD_SPHERES_MAX */
    uint32_t stride, stride_r; /* number of doubles from one sphere to the next; 0 means 1 */
    const uint64_t *id;        /* [n], ids seed random paths and decide ties; NULL: the index is the id */
    const uint32_t *clump;     /* [n], number of the clump, a body of spheres that may lie within one another; 0: the
                                  sphere is alone; NULL: there are no clumps */
} fibrad_spheres;

typedef enum fibrad_wall_kind {
    FIBRAD_WALL_PLANE = 1,    /* a plane across an axis; the scene lies on one side of the plane */
    FIBRAD_WALL_CYLINDER = 2, /* a cylinder parallel to an axis; the scene lies inside */
    FIBRAD_WALL_MESH = 3      /* the triangles of fibrad_scene_config.triangles that name this wall, at least one */
} fibrad_wall_kind;

/* A plane across an axis. */
typedef struct fibrad_plane {
    int axis;  /* 0: x, 1: y, 2: z */
    int upper; /* 1: the scene lies below the plane, 0: the scene lies above the plane */
    double at; /* L, coordinate of the plane on its axis */
} fibrad_plane;

/* A cylinder along an axis. */
typedef struct fibrad_cylinder {
    double x, y, radius; /* L: x and y of its middle if it lies along z, y and z along x, x and z along y; above 0 */
    int along;           /* 0: x, 1: y, 2: z */
} fibrad_cylinder;

/* A wall. The number of a wall is its index in fibrad_scene_config.wall.
 *
 * Planes and the cylinder bound a convex container. Hence no plane and no cylinder hides one sphere from another.
 *   planes    At most two planes lie across one axis: a lower one and, above it, an upper one. A periodic axis has no
 *             planes.
 *   cylinder  There is at most one. The two axes across it then have no period and no planes.
 *   meshes    Their triangles may hide spheres from each other. fibrad_mesh.h has the rules for triangles.
 *   openings  An opening is a plane where the container ends and the surroundings begin. Radiation that meets an
 *             opening counts as `escaped`. An opening has no index, no temperature and no emissivity.
 *
 * Endless walls. An axis is closed if it has two planes or a period, also that of an occupancy (fibrad_occupancy). If
 * there are planes across two or three axes, all three axes must be closed. If there is a cylinder, its own axis must
 * be closed. Otherwise fibrad_scene_init returns FIBRAD_E_ENDLESS. Planes across one axis alone may be endless: they
 * have an infinite area. */
typedef struct fibrad_wall {
    int kind;                 /* a fibrad_wall_kind */
    fibrad_plane plane;       /* used by FIBRAD_WALL_PLANE */
    fibrad_cylinder cylinder; /* used by FIBRAD_WALL_CYLINDER */
} fibrad_wall;

/* Divided beds. Several machines may divide the spheres of a bed. Each machine computes the rows of its own spheres,
 * with a cutoff. The cutoff is a distance between centres: a row leaves out the spheres that are farther from sphere
 * i. Let R be the largest radius. The scene of a machine needs all spheres whose centres lie within cutoff + 1.5 R of
 * one of its own centres. If no spheres overlap, cutoff + R suffices. No other sphere changes a bit of its rows, and
 * neither does the order of the spheres. Rows also depend on the walls, the occupancy and the ids.
 *
 * The fraction `beyond`. Radiation of sphere i ends at the first sphere within the cutoff that it meets. If it meets
 * none, it ends at the first wall within the ball whose radius is the cutoff. All other radiation leaves the ball. The
 * occupancy (fibrad_occupancy) marks the cells of a box in which the bed may have spheres. If the way from the ball to
 * a wall or to the surroundings passes through no marked cell, the radiation counts there. If it passes through a
 * marked cell, it counts as `beyond`. A scene without an occupancy takes the box of all its spheres as the only marked
 * cell. This is the box of all centres, made larger by the largest radius on every side. Along a periodic axis it
 * repeats without end. A way longer than 100 periods of the occupancy counts as `beyond`. Without a cutoff `beyond` is
 * 0.
 *
 * A periodic scene without a cutoff may have an occupancy of all its spheres. It then serves lines to walls, which
 * spread about the direction of their window: docs/methods.md section 11. */
/* Where a bed has spheres: the marked cells of a box. There is no part of any sphere in other cells or outside the
 * box. The occupancy must stay as it is while the scene is used. All machines use the same occupancy.
 *
 * Cell (x, y, z) has the number k = x + cells[0] (y + cells[1] z). It is marked if bit k % 64 of mark[k / 64] is 1. */
typedef struct fibrad_occupancy {
    double low[3], high[3]; /* L, the box, low below high */
    uint32_t cells[3];      /* number of cells along each axis, 1 to 2^20 */
    int periodic[3];        /* 1: the box repeats along this axis without end; 0: it does not */
    const uint64_t *mark;   /* [(number of all cells + 63)/64]; NULL: all cells are marked */
} fibrad_occupancy;

/* How a scene is made. Zeroed: open on all sides, no walls, the best instruction set.
 *
 * Example: a box that is periodic along x and y, with a floor at z = 0 and an open top at z = 20.
 *   const fibrad_wall floor = {.kind = FIBRAD_WALL_PLANE, .plane = {.axis = 2, .upper = 0, .at = 0}};
 *   const fibrad_plane top = {.axis = 2, .upper = 1, .at = 20};
 *   const fibrad_scene_config config = {
 *       .period = {10, 10, 0}, .wall = &floor, .walls = 1, .opening = &top, .openings = 1}; */
typedef struct fibrad_scene_config {
    int isa;                                  /* a fibrad_isa */
    double period[3];                         /* L, length of the periodic box along each axis; 0: no period */
    const fibrad_wall *wall;                  /* [walls], the walls; copied */
    uint32_t walls;                           /* number of walls, 0 to FIBRAD_WALLS_MAX, else FIBRAD_E_UNSUPPORTED */
    const fibrad_plane *opening;              /* [openings], copied; no sphere may reach beyond an opening */
    uint32_t openings;                        /* 0 to 6 */
    const fibrad_occupancy *occupancy;        /* where the bed has spheres; NULL: none; not copied */
    const struct fibrad_triangles *triangles; /* triangles of all meshes (fibrad_mesh.h); NULL: none; copied */
} fibrad_scene_config;

/* A scene holds a copy of the spheres, sorted by the cells of a grid. A scene never changes once it is made. */
typedef struct fibrad_scene fibrad_scene;

/* The cause of a fault, where a status alone does not say it. The numbers never change their meaning. */
typedef enum fibrad_why {
    FIBRAD_WHY_UNSAID = 0,        /* The status says all. */
    FIBRAD_WHY_PLACE = 1,         /* A coordinate is NaN, infinite or too far away. */
    FIBRAD_WHY_RADIUS = 2,        /* A radius is not above 0, or is out of range. */
    FIBRAD_WHY_BEYOND = 3,        /* A centre lies beyond a wall. */
    FIBRAD_WHY_WALL = 4,          /* A wall is not valid, or contradicts the periods or an earlier wall. */
    FIBRAD_WHY_TEMPERATURE = 5,   /* A temperature is out of range. */
    FIBRAD_WHY_EMISSIVITY = 6,    /* An emissivity is not within 0 to 1. */
    FIBRAD_WHY_POWER = 7,         /* A power is infinite or out of range. */
    FIBRAD_WHY_BOTH = 8,          /* Both a temperature and a power are given. */
    FIBRAD_WHY_NEITHER = 9,       /* Neither a temperature nor a power is given. */
    FIBRAD_WHY_REFLECTS = 10,     /* A surface of emissivity 0 cannot give off a power. */
    FIBRAD_WHY_STORAGE = 11,      /* `storage` or `reference` (fibrad_heat.h) is out of range. */
    FIBRAD_WHY_ENDLESS = 12,      /* The temperature of an endless wall of emissivity above 0 is missing. */
    FIBRAD_WHY_SIDE = 13,         /* The temperature, film or power of a side is out of range, or its wall has no
                                     temperature; or the side has a temperature and one of the others. */
    FIBRAD_WHY_SURROUNDINGS = 14, /* The temperature of the surroundings is missing or out of range. */
    FIBRAD_WHY_SIGMA = 15,        /* sigma is out of range. */
    FIBRAD_WHY_TOLERANCE = 16,    /* A tolerance is out of range. */
    FIBRAD_WHY_MISSING = 17,      /* An array is missing. */
    FIBRAD_WHY_CAPACITY = 18,     /* A heat capacity is not above 0, or is out of range. */
    FIBRAD_WHY_LIGHT = 19,        /* A number of a light is out of range, or its direction is zero. */
    FIBRAD_WHY_DARK = 20,         /* No open face lets a light in. */
    FIBRAD_WHY_FOOTPRINT = 21,    /* A light through a disc (fibrad_light.h) meets a sphere before it meets the disc. */
    FIBRAD_WHY_CONDUCTIVITY = 22, /* A conductivity is not above 0. */
    FIBRAD_WHY_CONTACT = 23,      /* A contact has an end that is neither a sphere nor a wall. */
    FIBRAD_WHY_CONDUCTANCE = 24,  /* A conductance is negative or out of range. */
    FIBRAD_WHY_TOUCHED = 25,      /* A wall with a contact or a film is insulated, or has no single temperature. */
    FIBRAD_WHY_ALONE = 26,        /* A sphere in contact has emissivity 0, and nothing sets its temperature. */
    FIBRAD_WHY_FILM = 27,         /* A film is negative or out of range, or the temperature of its gas is. */
    FIBRAD_WHY_STREAM = 28,       /* A stream has no such slice, or its inlet or capacities are out of range. */
    FIBRAD_WHY_CLUMP = 29,        /* A clump touches its own image in the next period. */
    FIBRAD_WHY_CLUMP_HEAT = 30,   /* Members of a clump differ in temperature, or in what they store. */
    FIBRAD_WHY_CLUMP_SOLID = 31,  /* A member of a clump has a finite conductivity. */
    FIBRAD_WHY_CLUMP_LIGHT = 32   /* Light on clumps is not computed. */
} fibrad_why;

/* The cause of a fault, which may be any number, as words that continue a sentence: "sphere 3 ..." Never NULL. */
const char *fibrad_why_text(int why);

/* Where a fault is. */
typedef struct fibrad_fault {
    uint32_t first, second; /* the spheres at fault; equal: one sphere; both n: no sphere */
    uint32_t triangle;      /* the triangle at fault; UINT32_MAX: none */
    uint32_t wall;          /* 1 + the index of the wall at fault; 0: none */
    int why;                /* a fibrad_why */
} fibrad_fault;

/* Bytes that fibrad_scene_init needs for n spheres: 5 KB, 53 per sphere, and 8 more per sphere if ids is 1, for
 * fibrad_spheres.id. Triangles need more: fibrad_triangles_size. Clumps need more: fibrad_clumps_size. 0: n is above
 * FIBRAD_SPHERES_MAX. */
size_t fibrad_scene_size(uint32_t n, int ids);

/* Bytes that fibrad_spheres.clump adds to a scene of n spheres. 0: n is above FIBRAD_SPHERES_MAX. */
size_t fibrad_clumps_size(uint32_t n);

/* An upper bound of fibrad_scene_size(n, 0), for static memory. */
#define FIBRAD_SCENE_BYTES(n) (5632 + (size_t)(n)*64)

/* Makes a scene.
 *
 * Centres on a periodic axis are moved into the box. The box begins at the least coordinate of all centres. Spheres
 * may overlap each other and the walls, as they do in settled beds. No centre may lie beyond a wall, or inside another
 * sphere that is not of the same clump. A part of a sphere may lie beyond a wall. Whatever leaves this part meets the
 * wall at once. Members of a clump whose centres agree are moved apart by 1e-12 radii.
 *   Input    memory[size]: at least fibrad_scene_size(n, ids) bytes, and fibrad_triangles_size(triangles, n) and
 *            fibrad_clumps_size(n) if there are triangles and clumps
 *            config: NULL for all defaults
 *            spheres
 *   Output   scene: a pointer into memory
 *            fault: where an error is; may be NULL. After FIBRAD_OK `fault` is as before.
 *   Errors   _ARGUMENT, _SIZE, _ISA, _ENDLESS, _UNSUPPORTED (more than FIBRAD_WALLS_MAX walls)
 *            _GEOMETRY: a centre lies inside another sphere, a sphere reaches beyond an opening, a period is less than
 *            the largest radius, or a clump touches its own image
 *            After an error an earlier scene in the same memory may be lost.
 *   Cost     0.5 microseconds per sphere. Clusters that lie far apart take longer, O(n^2) at worst.
 *   Source   docs/methods.md section 6 */
int fibrad_scene_init(fibrad_scene **scene, void *memory, size_t size, const fibrad_scene_config *config,
                      const fibrad_spheres *spheres, fibrad_fault *fault);

/* Finds spheres whose centres lie inside others, so that no scene has them, and how much smaller they must be.
 *   Input    spheres: two spheres of one id are images of one, and are no pair, nor are members of one clump
 *            memory[size]: at least fibrad_scene_size(n, ids) bytes, and fibrad_clumps_size(n) if there are clumps; a
 *            scene in this memory is lost
 *   Output   part[n]: 1, or the least d/max(r_i, r_j) of all spheres j at a distance d < max(r_i, r_j), less 1e-9 of
 *            it for rounding. With the radii r_i part[i] each centre lies outside of the other sphere.
 *            other[n]: this sphere j; n: there is none
 *            fault: where an error is; may be NULL
 *   Errors   _ARGUMENT, _SIZE
 *            _GEOMETRY: there are more than 64 n pairs; fault->first is a large sphere; part and other are not valid
 *   Cost     as fibrad_scene_init
 *   Source   docs/lammps.md */
int fibrad_spheres_inside(const fibrad_spheres *spheres, void *memory, size_t size, double *part, uint32_t *other,
                          fibrad_fault *fault);

/* Facts of a scene. */
typedef struct fibrad_scene_facts {
    uint32_t spheres, walls;       /* numbers of spheres and of walls */
    int isa;                       /* the fibrad_isa in use */
    uint32_t cells;                /* cells of the grid, all levels together */
    double radius_min, radius_max; /* L; 0 without spheres */
    double overlap_max;            /* largest overlap of two spheres, divided by the smaller radius; 0: none overlap */
    uint32_t overlap_pair[2];      /* the two spheres of the largest overlap */
    uint32_t triangles;            /* number of triangles */
    uint32_t clumps;               /* number of clumps */
    uint32_t covered;              /* number of members without a surface: they lie within other members */
    uint32_t covered_sphere;       /* one of them */
    uint32_t parted;               /* number of clumps in parts that do not touch, with gaps above .001 radii */
    uint32_t parted_pair[2];       /* two members of such a clump, of different parts */
} fibrad_scene_facts;

/* Reads the facts of a scene. A null pointer, or a scene that is not complete, leaves `facts` as they are. */
void fibrad_scene_describe(const fibrad_scene *scene, fibrad_scene_facts *facts);

/* Exposed area of a sphere [L^2]: the part of its surface that no other member of its clump hides. It is exact to
 * rounding, or to 1e-9 r^2 if circles in which members cut each other nearly agree. Walls and other spheres hide
 * nothing of it. For a sphere that is alone this is 4 pi r^2.
 *   Input    i: 0 to spheres - 1
 *   Output   NaN: i is out of range, or the scene is not complete
 *   Source   docs/methods.md section 5 */
double fibrad_scene_exposed_area(const fibrad_scene *scene, uint32_t i);

/* Volume of a sphere [L^3]. In the volume of a clump, what members share counts once. Each member has a part of this
 * volume, in proportion to r^3.
 *   Input    i: 0 to spheres - 1
 *   Output   NaN: i is out of range, or the scene is not complete */
double fibrad_scene_volume(const fibrad_scene *scene, uint32_t i);

/* Area of a wall or an opening [L^2]: the part that bounds the container, in one period. For a mesh this is the sum
 * over all sides that belong to the wall.
 *   Input    wall: 0 to walls - 1, or FIBRAD_OPENING(walls, axis, upper)
 *   Output   infinity: the wall or opening is endless. NaN: there is none, or the scene is not complete. */
double fibrad_scene_wall_area(const fibrad_scene *scene, uint32_t wall);

/* The number of an opening, for functions that take a wall or an opening. upper: 0 or 1, as in fibrad_plane */
#define FIBRAD_OPENING(walls, axis, upper) ((uint32_t)(walls) + 2 * (uint32_t)(axis) + (uint32_t)(upper))

/* Sphere k, 0 to n - 1, in the order of the grid's cells. Each sphere occurs once. Compute the rows of a large bed in
 * this order: rows are faster if their data are still in the cache. UINT32_MAX: k is out of range, or the scene is not
 * complete. */
uint32_t fibrad_scene_sphere(const fibrad_scene *scene, uint32_t k);

/* ---- work ------------------------------------------------------------------------------------------------------ */
/* Scratch memory of one thread. Set `memory`, and zero the rest. One fibrad_work serves any scenes and functions in
 * turn. After FIBRAD_E_WORK, call again with a block of memory.needed bytes. One row may ask more than once. */
typedef struct fibrad_work {
    fibrad_memory memory;
    void *inside;      /* of the library; NULL at first */
    uint32_t triangle; /* out: after FIBRAD_E_BACK, the triangle whose side was seen */
} fibrad_work;

/* Bytes of fixed work memory for beam rows, as a constant expression.
 *   Input    discs: largest number of spheres in the way of one window, hidden ones included; 64 in a packed bed
 *            entries: largest number of spheres that one row sees; 200 in a packed bed
 *   Scenes with walls take FIBRAD_WORK_WALLS more. Scenes with triangles take FIBRAD_WORK_TRIANGLES more. */
#define FIBRAD_WORK_BYTES(discs, entries) (34816 + (size_t)(discs)*776 + (size_t)(entries)*104)
#define FIBRAD_WORK_WALLS                 29760
#define FIBRAD_WORK_TRIANGLES             26784

/* ---- row ------------------------------------------------------------------------------------------------------- */
typedef struct fibrad_rows fibrad_rows; /* a collection of rows, see below */

/* One row of factors. The caller chooses where the entries go.
 *
 *               into arrays of the caller          into a collection
 *   before        Set col, f, wall and capacity.     Set rows.
 *   after         The arrays have the row.           The row is appended. col, f and wall point into the collection
 *                                                    until the next row is appended.
 *   no room       FIBRAD_E_CAPACITY. `length` is     FIBRAD_E_CAPACITY. rows->memory.needed is the size that
 *                 the capacity that suffices.        suffices.
 *
 * The entries, the factors to walls, `escaped` and `beyond` add up to 1, to rounding. Rows of exchange factors of a
 * sphere of emissivity 0 are empty and add up to 0. After an error the elements of the caller's arrays are undefined.
 */
typedef struct fibrad_row {
    uint32_t *col;       /* [capacity], out: the spheres that receive, ascending */
    double *f;           /* [capacity], out: factor from sphere i to sphere col[k], above 0 */
    double *wall;        /* [walls], out: factor to each wall; may be NULL if there are no walls */
    uint32_t capacity;   /* in: elements of col and f; out: 0 if the row was appended to `rows`, else as before */
    fibrad_rows *rows;   /* in: NULL, or the collection; then capacity is not used */
    uint32_t sphere;     /* out: i */
    uint32_t length;     /* out: number of entries */
    double escaped;      /* out: fraction that reaches the surroundings, through an opening or past everything */
    double beyond;       /* out: fraction that leaves the cutoff, and whose end is not computed */
    double error;        /* out: estimated error of the row, not a bound: docs/trust.md */
    uint32_t directions; /* out: number of directions of a row along directions, else 0 */
    uint32_t fallbacks;  /* out: windows that needed a slower, more robust method; rows by rays: 0 */
    int symmetric;       /* out: 1 if A_i F_ij = A_j F_ji holds without averaging */
    uint32_t lines;      /* out: number of lines of a row along lines, else 0; with clumps that of directions, too */
    float *half;         /* [capacity], out, of a row along lines: half the difference of the factors by even and by odd
                            lines; infinity: the factor is exact, since nothing can come between both spheres. May be
                            NULL. Rows in a collection keep it. */
    double noise;        /* out, of a row along lines: part of `error`, from the points of windows */
    double shares;       /* out, of a row along lines: part of `error`, from the factors of walls and surroundings */
} fibrad_row;

/* ---- lines ----------------------------------------------------------------------------------------------------- */
/* A set of lines, for the rows of a matrix. A row looks along one of the two directions of each line. These are spread
 * evenly, as the lines are. The factor between two spheres is the mean of both of their rows. So it counts both
 * directions of each line. Walls and surroundings are seen along one direction of each line. If the scene has planes,
 * openings or a cylinder and no triangles, spheres near these or near the border of the bed look along both. */
typedef struct fibrad_line_set fibrad_line_set;

/* The number of lines of the smallest set with at least `lines` lines. 0: there is none. There are sets of 8, 11, 16,
 * 23, 32, 45, 55, 64, 91, 100, 128, 181, 233, 256, 362, 512, 724 and 1024 lines. */
uint32_t fibrad_line_set_lines(uint32_t lines);

/* Bytes that fibrad_line_set_init needs. 0: there is no set of so many lines. */
size_t fibrad_line_set_size(uint32_t lines);

/* Makes a set of fibrad_line_set_lines(lines) lines. Threads may share the set.
 *   Input    memory[size]
 *            lines: FIBRAD_DIRECTIONS_MIN to FIBRAD_LINES_EVEN_MAX
 *   Output   set: a pointer into memory
 *   Errors   _ARGUMENT, _SIZE, _TABLE
 *   Cost     microseconds
 *   Source   docs/methods.md section 12 */
int fibrad_line_set_init(fibrad_line_set **set, void *memory, size_t size, uint32_t lines);

/* For fibrad_beam_rule.chords. NONE: exact areas. SUITED: the number of chords that suits the number of lines or
 * directions: 16 up to 80, 32 up to 250, 64 up to 724, exact areas beyond. */
#define FIBRAD_CHORDS_NONE   1
#define FIBRAD_CHORDS_SUITED 2

/* How a beam row is computed. Zeroed: FIBRAD_DIRECTIONS_DEFAULT directions, exact areas, no cutoff, no tolerance. */
typedef struct fibrad_beam_rule {
    uint32_t directions; /* FIBRAD_DIRECTIONS_MIN to FIBRAD_DIRECTIONS_MAX; 0: _DEFAULT, with a tolerance _FIRST */
    uint32_t points;     /* 64, 128 or 256: so many points in each window, not masks; 0: see chords */
    double cutoff;       /* L; spheres are left out if their centre is farther than (1 + 1e-12) cutoff; 0: no cutoff */
    double tolerance;    /* the error allowed; directions are added until it is met; 0: no tolerance */
    uint64_t turn;       /* seed of a random turn of all directions about z, or about the only axis with walls; each
                            direction also moves along this axis, at most half way to the next one; 0: no turn */
    const fibrad_line_set *lines; /* lines to take; directions, turn, tolerance and points must be 0; NULL: none */
    uint32_t chords; /* 16, 32 or 64: each window has 32 points on each of so many chords (masks); FIBRAD_CHORDS_NONE;
                        FIBRAD_CHORDS_SUITED; 0: SUITED along lines, NONE along directions */
} fibrad_beam_rule;

/* Row i of the view factors of a scene, by parallel beams. A beam is all parallel rays from sphere i through one
 * window. There is one beam for each direction or line of the rule. Sphere j is visible in a fraction of each window.
 * The factor to sphere j is the mean of this fraction over all windows.
 *   exact areas  The fraction is a visible area over the area of the window. The error of the entries falls as
 *                directions^-1.5, that of factors to walls a little more slowly. If sphere i sees no other sphere and
 *                cuts no wall, and there is no cutoff, factors to walls are exact: in a cylinder to 4e-7, which `error`
 *                leaves out, else to rounding.
 *   points       Each point of the window is one ray. The fraction is that of the points that meet sphere j.
 *
 * In a periodic scene, all images of one sphere have one entry together. Sphere i may see its own images. A beam meets
 * no sphere farther away than 100 periods. A row never has more than FIBRAD_DIRECTIONS_MAX directions. If these do not
 * meet the tolerance, row->error is above it.
 *   Input    i: 0 to spheres - 1
 *            rule: NULL for all defaults
 *   Output   row
 *   Errors   _ARGUMENT, _STATE, _TABLE (points), _CAPACITY, _WORK, _MEMORY, _BACK, _SUM
 *   Cost     some microseconds per direction with ten discs in a window, more with more discs
 *   Source   docs/methods.md sections 3 and 4 */
int fibrad_beam_row(const fibrad_scene *scene, fibrad_work *work, uint32_t i, const fibrad_beam_rule *rule,
                    fibrad_row *row);

/* The number of directions to try next when a row of so many directions has an error above the tolerance, by the law
 * directions^-1.5. At least 6/5 of `directions`, at most FIBRAD_DIRECTIONS_MAX. Source: docs/methods.md section 3. */
uint32_t fibrad_directions_for(uint32_t directions, double error, double tolerance);

/* How a row is sampled by rays. Zeroed: FIBRAD_RAYS_DEFAULT quasi-random rays, seed 0, no cutoff. */
typedef struct fibrad_cast_rule {
    uint32_t rays; /* 0: FIBRAD_RAYS_DEFAULT */
    int random;    /* 0: quasi-random numbers (method `cast`); 1: pseudo-random numbers (method `mc`) */
    uint64_t seed; /* of the random numbers, together with the id of the sphere */
    double cutoff; /* L, as in fibrad_beam_rule */
} fibrad_cast_rule;

/* Means over the rays that sphere i sends to sphere col[k]. After an error the elements are undefined. */
typedef struct fibrad_cast_means {
    double *length; /* L, [row->capacity], out: mean length of the rays */
    double *angle;  /* radians, [row->capacity], out: mean angle between the rays and the line of centres */
} fibrad_cast_means;

/* Row i of the view factors of a scene, by rays. The origins are spread evenly over the sphere. The directions follow
 * the cosine law. Each ray ends at the first surface that it meets. A factor is the fraction of all rays that end on a
 * surface. The error falls as rays^-0.6 with quasi-random numbers and as rays^-0.5 with pseudo-random numbers.
 *
 * A ray may start inside another sphere j that overlaps sphere i. Let c be the vector from centre i to centre j, and w
 * the direction of the ray. If c.w > 0, the ray meets sphere j at length 0. Otherwise the ray passes through sphere j.
 *   Input    i: 0 to spheres - 1
 *            rule: NULL for all defaults
 *   Output   row
 *            means: may be NULL; must be NULL if row->rows is set
 *   Errors   _ARGUMENT, _STATE, _CAPACITY, _WORK, _MEMORY, _BACK, _SUM
 *   Cost     0.1 microseconds per ray
 *   Source   docs/methods.md section 8 */
int fibrad_cast_row(const fibrad_scene *scene, fibrad_work *work, uint32_t i, const fibrad_cast_rule *rule,
                    fibrad_row *row, const fibrad_cast_means *means);

/* ---- rows ------------------------------------------------------------------------------------------------------ */
/* A collection of rows of one thread or process, in any order. Set `memory`, and zero the rest. If fixed memory has no
 * room for a row, the error is FIBRAD_E_CAPACITY. Then give a larger block with the same contents, and call again. */
struct fibrad_rows {
    fibrad_memory memory;
    size_t used, lead; /* bytes, of the library: bytes of all rows, and bytes in front of the first row */
    uint32_t count;    /* out: number of rows */
    uint32_t serial;   /* of the library: number of changes so far */
    uint64_t entries;  /* out: entries of all rows */
};

/* Appends a row that was computed elsewhere, on another machine for example. A matrix takes it for a row of its own
 * scene. If the row is of another scene, no call notices.
 *   Input    row: sphere, col, f, length, wall, escaped, beyond, error, symmetric. row->rows must be NULL. The columns
 *            ascend. Each factor is 0 to 1.01. Of a row along lines also lines, half, noise and shares.
 *            walls: elements of row->wall
 *   Errors   _ARGUMENT, _CAPACITY, _MEMORY */
int fibrad_rows_add(fibrad_rows *rows, const fibrad_row *row, uint32_t walls);

/* Removes all rows and keeps the memory. NULL is allowed. */
void fibrad_rows_clear(fibrad_rows *rows);

/* Reads the next row of a collection, and returns 1, or 0 after the last row. The arrays of `row` lie in the collection
 * until a row is appended, and row->rows is NULL. The caller may write the columns, ascending, to number spheres anew.
 *   Input    at: 0 at the first call; each call moves `at` to the next row
 *   Output   row */
int fibrad_rows_read(fibrad_rows *rows, size_t *at, fibrad_row *row);

/* ---- matrix ---------------------------------------------------------------------------------------------------- */
/* The row of a wall: one batch of fibrad_exchange_wall, or the mean by fibrad_exchange_wall_mean. Its factors add up to
 * 1. If the emissivity of the wall is 0, all are 0. Paths among surfaces that absorb little end after many rays. The
 * fraction lost is what they still carry then. */
typedef struct fibrad_wall_row {
    double wall[FIBRAD_WALLS_MAX]; /* factor to each wall; a batch may have a factor a little below 0, by chance */
    double spheres;                /* factor to all spheres together */
    double escaped;                /* factor to the surroundings */
    double error;                  /* of the mean: the estimated error; of a batch: the fraction lost, see above */
    uint64_t rays;                 /* rays traced */
    uint64_t paths;                /* paths followed; of the mean: those of all batches */
} fibrad_wall_row;

/* Does piece k of a job. The library hands this function to fibrad_parallel. */
typedef void fibrad_piece(void *job, uint32_t k);

/* A function of the caller that uses the caller's threads. It calls piece(job, k) once for each k from 0 to pieces -
 * 1, in any order or at the same time. It returns when all pieces are done. */
typedef void fibrad_parallel(void *context, uint32_t pieces, fibrad_piece *piece, void *job);

/* What the rows of a matrix hold. */
typedef enum fibrad_rows_kind {
    FIBRAD_ROWS_AREAS = 0,   /* view factors along lines, or by exact areas */
    FIBRAD_ROWS_SAMPLED = 1, /* view factors by rays, or by points of directions */
    FIBRAD_ROWS_EXCHANGE = 2 /* exchange factors */
} fibrad_rows_kind;

/* How rows become a matrix. Zeroed: view factors along lines or by exact areas, made reciprocal and closed; walls have
 * no rows. */
typedef struct fibrad_matrix_rule {
    int kind;                        /* a fibrad_rows_kind */
    int raw;                         /* 1: leave the rows as they are; a missing row is empty */
    const double *emissivity;        /* [spheres], 0 to 1, needed with FIBRAD_ROWS_EXCHANGE; else NULL */
    double drop;                     /* 0 to 1: pairs of entries are dropped if both are below `drop`; 0: keep all */
    uint32_t tasks;                  /* into how many tasks `parallel` divides, 1 to 1024; changes no bit; 0: 1 */
    const fibrad_wall_row *wall_row; /* [walls], copied; rows of endless walls are not read; NULL: no rows of walls */
    const double *wall_emissivity;   /* [walls], 0 to 1, read if wall_row is set; NULL: 1 */
    uint32_t bodies;                 /* number of bodies, such as clumps; rows and columns are bodies; 0: spheres */
    const double *area;              /* L^2, [bodies], of their surfaces, above 0 */
    fibrad_parallel *parallel;       /* used by all calls for this matrix; NULL: the calling thread does all */
    void *context;                   /* handed to parallel */
} fibrad_matrix_rule;

/* A matrix of factors in compressed rows. The arrays belong to the matrix that they were read from. wall_wall,
 * wall_escaped and wall_error are NULL if walls have no rows. Their elements for an endless wall are NaN.
 *
 * `changed` shows whether the raw rows agree with each other. The matrix changes what raw row i gives to walls, to the
 * surroundings and to `beyond`. The change of row i is the root of the sum of the squared differences. `changed` is
 * the largest ratio of a row's change to its error. For rows along lines this error is at least 5 times that of the
 * raw row. A value well above 1 means that the raw rows contradict each other by more than their errors. */
typedef struct fibrad_factors {
    uint32_t n, walls;          /* numbers of spheres and of walls */
    const uint64_t *start;      /* [n + 1], row i is elements start[i] to start[i + 1] - 1 of col and f */
    const uint32_t *col;        /* [start[n]], columns, ascending within each row */
    const double *f;            /* [start[n]], factor from i to col */
    const double *escaped;      /* [n], factor to the surroundings */
    const double *beyond;       /* [n], fraction that leaves the cutoff, as in fibrad_row */
    const double *error;        /* [n], estimated error of each row */
    const double *wall;         /* [n][walls], factors to walls */
    const double *wall_wall;    /* [walls][walls], factors from wall to wall */
    const double *wall_escaped; /* [walls], factors from walls to the surroundings */
    const double *wall_error;   /* [walls], estimated error of each wall's factors to walls and surroundings */
    double wall_correction;     /* largest |sum - 1| of a wall's row before closing */
    double wall_closure;        /* largest |sum - 1| of a wall's row after closing; see fibrad_matrix_close */
    double changed;             /* largest change of a row over its error, see above; raw: 0 */
    uint32_t changed_row;       /* the row of that change */
} fibrad_factors;

typedef struct fibrad_matrix fibrad_matrix; /* a matrix in the making */

/* Bytes that fibrad_matrix_init needs: 24 for each entry of the rows, or 32 if all rows are along lines, and 104 + 8 b
 * for each sphere, b being the number of walls. With `raw` 12 for each entry, 56 + 8 b for each sphere. 0: error. */
size_t fibrad_matrix_size(const fibrad_scene *scene, const fibrad_rows *rows, uint32_t count,
                          const fibrad_matrix_rule *rule);

/* Begins a matrix from all rows of a scene. Each sphere has one row, in any of the collections.
 *   Input    memory[size]
 *            rows[count]: collections; must not change until fibrad_matrix_close has returned; rows of bodies are
 *            those of fibrad_rows_add
 *            rule: NULL for all defaults
 *   Output   matrix: a pointer into memory
 *            sphere: the sphere whose row is missing or repeated; may be NULL
 *   Errors   _ARGUMENT: also if an entry is from or to a sphere of emissivity 0, or if rule->emissivity does not
 *            suit rule->kind
 *            _SIZE
 *            _STATE: a row is missing, repeated or of another scene, or a collection's block was moved
 *   Cost     O(spheres + entries) */
int fibrad_matrix_init(fibrad_matrix **matrix, void *memory, size_t size, const fibrad_scene *scene,
                       const fibrad_rows *rows, uint32_t count, const fibrad_matrix_rule *rule, uint32_t *sphere);

/* Ends the matrix. In the matrix A_i F_ij = A_j F_ji to rounding, A being the areas of spheres. The sum of every row
 * that is not empty is 1 to rounding. If the rows hold exchange factors, read D_ij for F_ij and A_i e_i for A_i, with
 * the emissivity e_i. With `raw` nothing is changed. Otherwise the steps are
 *   1. The matrix gets a mean of both estimates of A_i F_ij, that of row i and that of row j.
 *   2. F_ij is multiplied by u_i u_j, so that the rows of spheres have the sum 1 together with what they leave for
 *      walls, surroundings and `beyond`. Exact factors (fibrad_row.half) are not multiplied.
 *   3. Factors to walls, `escaped` and `beyond` are scaled so that the sum of each row is 1. If a row has none, it
 *      gets them in proportion to the sums over all rows.
 *   4. If walls have rows, these are made reciprocal and closed together with the rows of spheres. If triangles cut
 *      spheres, that may not be possible: then wall_closure equals wall_correction.
 *   5. If F_ij and F_ji are both below `drop`, both are removed. F_ii stays. The other entries are scaled so that the
 *      sums of the rows stay. The part of a sum that no scaling can restore is added to F_ii.
 *   Errors   _ARGUMENT
 *            _STATE: the matrix is closed already, or the rows have changed
 *   Cost     O(entries), for each of up to 60 passes of step 2, and more of steps 4 and 5
 *   Source   docs/methods.md sections 5, 15 and 16 */
int fibrad_matrix_close(fibrad_matrix *matrix);

/* Reads a matrix.
 *   Errors   _ARGUMENT, _STATE (the matrix is not closed) */
int fibrad_matrix_read(const fibrad_matrix *matrix, fibrad_factors *factors);

/* How far a matrix is from reciprocity: the largest |A_i F_ij - A_j F_ji|/max(A_i, A_j) over all entries. For exchange
 * factors A is area times emissivity. Uses memory of the matrix: one call at a time.
 *   Errors   _ARGUMENT, _STATE (the matrix is not closed) */
int fibrad_matrix_reciprocity(const fibrad_matrix *matrix, double *largest);

/* ---- exchange -------------------------------------------------------------------------------------------------- */
/* How a row of exchange factors is computed. The exchange factor D_ij is the fraction of the emission of sphere i that
 * sphere j absorbs, directly or after diffuse reflections. All surfaces are grey and diffuse.
 *
 * The first segment of all radiation is its way from sphere i to the surface that it meets. This is a beam row: with 64
 * points per window up to 49 directions, with 256 up to 144, with exact areas beyond. Paths follow what is reflected.
 *
 * Further paths may be followed elsewhere, and their results given as `known`. Paths that begin at walls
 * (fibrad_exchange_wall) can take the place of further paths. Let a wall have the area A_b and the emissivity e_b. Let
 * sphere i absorb x of n paths from this wall. They stand for m = n A_i e_i/(A_b e_b) further paths of sphere i, of
 * which the wall absorbs x. If spheres conduct, e_i is node_emissivity. */
typedef struct fibrad_exchange_rule {
    const double *emissivity;      /* [spheres], 0 to 1 */
    const double *wall_emissivity; /* [walls], 0 to 1; NULL without walls */
    uint32_t directions;           /* of the first segment; 0: FIBRAD_EXCHANGE_DIRECTIONS_DEFAULT */
    uint32_t paths;                /* 1 to FIBRAD_PATHS_MAX; 0: FIBRAD_PATHS_DEFAULT */
    uint64_t seed;                 /* of random numbers, with the sphere's id; also the `turn` of the first segment */
    double cutoff;                 /* L, as in fibrad_beam_rule; paths end at this distance from centre i; 0: none */
    double tolerance;              /* the error allowed; directions and paths are added until it is met; 0: none */
    const double *node_emissivity; /* [spheres], fibrad_node_emissivity of each; NULL: spheres have one temperature */
    double open_error; /* the error allowed of what meets no sphere in the first segment; if its estimate is larger,
                          the first segment is computed once more, with more directions of 256 points; 0: any */
    const double *conductivity; /* [spheres], k*, FIBRAD_RELATIVE_CONDUCTIVITY_MIN to INFINITY (one temperature), of
                                   fibrad_relative_conductivity, not k_s; needed with node_emissivity */
    const double *known; /* [walls + 1], how many of the further paths each wall and, last, the surroundings absorb
                            after at least one reflection; NaN: not counted; NULL: there are no further paths. The
                            factor to a wall is the mean over the paths of this call and the further paths. */
    double known_paths;  /* number of the further paths, 0 or more */
} fibrad_exchange_rule;

/* The relative conductivity k* = k_s/(4 d sigma T^3) of a sphere of diameter d. The smaller k* is, the more the
 * temperature differs from point to point on the sphere. Exchange rules take k*. Sources of heat (fibrad_heat.h) take
 * k_s. Neither notices the other number, which may be 1e8 times as large.
 *   Input    conductivity, radius, temperature: of the sphere, in SI units [W/(m K)], [m], [K]
 *            sigma: the Stefan-Boltzmann constant in the same units, in SI units FIBRAD_STEFAN_BOLTZMANN
 *   Output   INFINITY at the temperature 0; NaN if an argument is NaN */
double fibrad_relative_conductivity(double conductivity, double radius, double temperature, double sigma);

/* The emissivity of a node. In rows with rule->node_emissivity a node stands for a sphere that conducts. Let sphere i
 * have the mean temperature T_i, the net power q_i, the area A_i and the emissivity e_i. E_i is sigma T_i^4. Emission
 * is taken to be linear in T about T_i. The node has the emissivity n_i and one value N_i:
 *     q_i = sum over j of A_i n_i D_ij (N_j - N_i),   N_i = E_i - (1/n_i - 1/e_i) q_i/A_i.
 * The rows have the exchange factors D_ij between nodes, and A_i n_i D_ij = A_j n_j D_ji. The sum over j includes
 * walls and surroundings, for which N is E. So the powers follow from a linear system. For the matrix of such rows,
 * set fibrad_matrix_rule.emissivity to the emissivities of the nodes.
 *   Input    emissivity: 0 to 1
 *            conductivity: k*, from FIBRAD_RELATIVE_CONDUCTIVITY_MIN; INFINITY: the result is the emissivity
 *   Output   n, with 0 < n <= emissivity. If the emissivity is 0, n is 0.
 *   Errors   NaN: a number is out of its range
 *   Cost     0.1 microseconds
 *   Source   docs/methods.md section 27 */
double fibrad_node_emissivity(double emissivity, double conductivity);

/* Row i of the exchange factors of a scene. Factors to walls, `escaped` and `beyond` count all reflections, too. The
 * sum of the row is 1 to rounding. The row of a sphere of emissivity 0 is empty, and no other row has an entry for it.
 * The error falls as directions^-1.5 and paths^-0.5.
 *   Input    i: 0 to spheres - 1
 *            rule: needed
 *   Output   row
 *            rays: rays traced; may be NULL
 *   Errors   as fibrad_beam_row. The emissivities of sphere i, of walls, and of spheres that are met are checked.
 *   Cost     the beam row, and 0.1 to 0.2 microseconds per ray. A path has about 2 rays if the emissivity (of nodes)
 *            is 0.8, and 14 if it is 0.2. Work memory that may grow takes up to 6 MB more, for speed.
 *   Source   docs/methods.md section 14 */
int fibrad_exchange_row(const fibrad_scene *scene, fibrad_work *work, uint32_t i, const fibrad_exchange_rule *rule,
                        fibrad_row *row, uint64_t *rays);

/* Batches of paths of the row of a wall. Their spread is the error. */
#define FIBRAD_WALL_PARTS 8

/* How the row of a wall is computed. Zeroed: all surfaces are black. */
typedef struct fibrad_wall_rule {
    const double *emissivity;      /* [spheres], 0 to 1; NULL: all spheres are black */
    const double *wall_emissivity; /* [walls], 0 to 1; NULL: all walls are black */
    const double *node_emissivity; /* [spheres], as in fibrad_exchange_rule; emissivity is then needed, too */
    const double *conductivity;    /* [spheres], as in fibrad_exchange_rule */
    uint32_t paths;                /* in all batches, 1 to FIBRAD_PATHS_MAX; 0: FIBRAD_WALL_PATHS_DEFAULT */
    uint64_t seed;                 /* of random numbers */
} fibrad_wall_rule;

/* One batch of the row of a wall: the fractions of the wall's emission that walls, spheres and surroundings absorb.
 * The area that emits is the one that fibrad_scene_wall_area returns. Factors to single spheres follow from
 * reciprocity, A_b e_b D_bi = A_i e_i D_ib. A batch follows an eighth of rule->paths, and fewer paths if nearly
 * nothing absorbs. The error falls as paths^-0.6, at low emissivities as paths^-0.5. An opening has a row, too. It is
 * black, and emits what the surroundings send through it.
 *   Input    wall: 0 to walls - 1, or FIBRAD_OPENING(walls, axis, upper)
 *            part: number of the batch, 0 to FIBRAD_WALL_PARTS - 1
 *            rule: needed
 *   Output   row
 *            reflected[spheres]: the function adds what each sphere absorbs of the row->paths paths after at least
 *            one reflection, times 2^40; may be NULL
 *   Errors   _ARGUMENT, _STATE, _WORK, _MEMORY, _BACK, _SUM
 *            _UNSUPPORTED: an endless wall or opening
 *   Cost     0.1 to 0.5 microseconds per ray
 *   Source   docs/methods.md section 16 */
int fibrad_exchange_wall(const fibrad_scene *scene, fibrad_work *work, uint32_t wall, const fibrad_wall_rule *rule,
                         uint32_t part, fibrad_wall_row *row, uint64_t *reflected);

/* The mean of all batches of a wall's row. Its error is the standard error of the mean plus the fraction lost
 * (fibrad_wall_row). A mean below 0 becomes 0. Then the other factors are scaled so that their sum is 1.
 *   Errors   _ARGUMENT */
int fibrad_exchange_wall_mean(const fibrad_wall_row part[FIBRAD_WALL_PARTS], fibrad_wall_row *mean);

/* How displacements are computed. */
typedef struct fibrad_displacement_rule {
    const double *emissivity;      /* [spheres], 0 to 1 */
    const double *wall_emissivity; /* [walls], 0 to 1; NULL without walls */
    const double *conductivity;    /* [spheres], as in fibrad_exchange_rule; NULL: spheres have one temperature */
    uint32_t flights;              /* if spheres conduct, 1 to FIBRAD_FLIGHTS_MAX; 0: FIBRAD_FLIGHTS_DEFAULT */
    uint32_t paths;                /* 1 to FIBRAD_PATHS_MAX; 0: FIBRAD_PATHS_DEFAULT */
    uint64_t seed;                 /* of random numbers, with the sphere's id */
} fibrad_displacement_rule;

/* How far the emission of a sphere is carried. */
typedef struct fibrad_displacement {
    double square[3]; /* L^2: mean square displacement along each axis */
    double error[3];  /* L^2: estimated standard error of `square` */
    double absorbed;  /* estimated fraction that spheres absorb, with few paths up to some percent above 1; if spheres
                         conduct, fraction of the paths that did not leave the bed */
    uint64_t rays;    /* rays traced */
} fibrad_displacement;

/* Mean square displacement of the emission of sphere i, from its centre to the centre of the sphere that absorbs.
 * Periods that a path has crossed count. Emission that no sphere absorbs counts as displacement 0.
 *
 * With rule->conductivity spheres conduct, and the net power of every sphere is 0. A path begins with an arrival at
 * sphere i, evenly over its surface. At each sphere the path is reflected, or it is absorbed and given off at another
 * point of the sphere. The way from one arrival to the next is a flight. With n = rule->flights a path has 2 n
 * flights. Let d[k] be the displacement of flight k along an axis. Then `square` is the mean over all paths and over k
 * = 1 to n of
 *   d[k] (d[k] + 2 (d[k+1] + ... + d[k+n-1]) + d[k+n]).
 * This is the mean square displacement of a long path over its number of flights, but for the correlation of flights
 * that are more than n apart. In a cubic lattice of emissivity 1 it is 0.2 % with 12 at k* = 0.1 and 24 at k* = 0.01.
 *   Input    i: 0 to spheres - 1
 *            rule: needed
 *   Output   displacement
 *   Errors   _ARGUMENT, _STATE, _WORK, _MEMORY, _BACK
 *            _UNSUPPORTED: spheres conduct, and the scene has walls or openings
 *   Cost     0.1 to 0.2 microseconds per ray; 2 n rays a path if spheres conduct
 *   Source   docs/methods.md sections 24 and 26 */
int fibrad_exchange_displacement(const fibrad_scene *scene, fibrad_work *work, uint32_t i,
                                 const fibrad_displacement_rule *rule, fibrad_displacement *displacement);

/* Emissions and powers of spheres, walls and surroundings. Let U be the unit of emission, W/m2 for example. Powers are
 * in U L^2. A power above 0 is a gain of heat. fibrad_rows_flow adds to the powers: set them to 0 first. */
typedef struct fibrad_flow {
    const double *weight;         /* L^2, [spheres], area times emissivity, 4 pi r^2 eps; read for spheres with a row */
    const double *emission;       /* U, [spheres], sigma T^4 */
    const double *wall_emission;  /* U, [walls], sigma T^4 of each wall */
    double surroundings_emission; /* U, sigma T^4 of the surroundings */
    double *power;                /* U L^2, [spheres], in and out */
    double *wall_power;           /* U L^2, [walls], in and out */
    double surroundings_power;    /* U L^2, in and out */
    const double *made;           /* [spheres], when the row of each sphere was made; NULL: all at once */
} fibrad_flow;

/* Adds the powers that follow from rows of exchange factors. The collection may have rows of some spheres only. All
 * factors of a row are first multiplied by 1/(1 - beyond). An entry D_ij moves the power A_i eps_i D_ij (E_j - E_i)/2
 * from sphere j to sphere i. The other half comes from row j, on this or on another machine. If flow->made differs for
 * i and j, row i alone moves the full power, since an older row has no factor to a newer sphere. A factor to a wall or
 * to the surroundings moves the full power. Sphere i gains exactly what the others lose, to the bit.
 *   Input    rows: a collection; its rows are taken in their order
 *            spheres, walls: lengths of the arrays in `flow`
 *   Output   flow: the powers
 *   Errors   _ARGUMENT: also a sphere or column not below `spheres`, a number of walls other than `walls`, or a value
 *            that is not finite
 *            _STATE: the block of the collection was moved to another alignment
 *   Cost     2 ns per entry
 *   Source   docs/lammps.md */
int fibrad_rows_flow(const fibrad_rows *rows, uint32_t spheres, uint32_t walls, fibrad_flow *flow);

#ifdef __cplusplus
}
#endif
#endif
