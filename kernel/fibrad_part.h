/* fibrad_part.h - beds divided over machines, rows divided over threads, and powers from rows.
 *
 * Index
 *   fibrad_occupancy           where a bed has spheres
 *   fibrad_beam_part, _join    one row, computed by several threads
 *   fibrad_flow                emissions and powers
 *   fibrad_rows_flow           powers from rows of exchange factors
 *   fibrad_rows_read           the rows of a collection, one after the other
 *
 * Units, words, errors and the layout of comments are as in fibrad.h.
 *
 * Divided beds. A machine has some spheres of a bed. It computes the rows of its own spheres with a cutoff. Row i
 * depends on the spheres with centres within cutoff + 1.5 R of centre i, R being the largest radius. If no spheres
 * overlap, the distance is cutoff + R. Row i also depends on the walls, the occupancy and the ids. Row i does not
 * depend on any other sphere or on the order of the spheres, not in a single bit.
 *
 * The fraction `beyond`. Row i knows the space within the cutoff of centre i. If the scene has a known region, row i
 * knows only the part within that region. Radiation may leave the known space before it meets anything. Then its way on
 * outside decides.
 *
 *   occupancy  known region  the way on                                     counts as
 *   given      any           passes through no marked cell before its end   the wall at its end, or `escaped`
 *   given      any           passes through a marked cell                   `beyond`
 *   none       none          misses the box of all spheres                  the wall at its end, or `escaped`
 *   none       none          passes through the box of all spheres          `beyond`
 *   none       given         any                                            `beyond`
 *
 * A way that is longer than 100 periods of the occupancy counts as `beyond`. Triangles are walls here.
 *
 * Beams and rays of view factors see the spheres of a scene outside its known region. Reflections do not.
 *
 * SPDX-License-Identifier: MIT */
#ifndef FIBRAD_PART_H
#define FIBRAD_PART_H

#include "fibrad.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Where a bed has spheres: the marked cells of a box. There is no part of any sphere in other cells or outside the box.
 * The occupancy must stay as it is while the scene is used. All machines use the same one.
 *
 * Cell (x, y, z) has the number k = x + cells[0] (y + cells[1] z). It is marked if bit k % 64 of mark[k / 64] is 1. */
typedef struct fibrad_occupancy {
    double low[3], high[3]; /* L, the box, low below high */
    uint32_t cells[3];      /* number of cells along each axis, 1 to 2^20 */
    int periodic[3];        /* 1: the box repeats along this axis without end; 0: it does not */
    const uint64_t *mark;   /* [(number of all cells + 63)/64]; NULL: all cells are marked */
} fibrad_occupancy;

/* What some directions of a beam row give. Set `memory`, and zero the rest. */
typedef struct fibrad_row_part {
    fibrad_memory memory;         /* takes 16 bytes for each sphere that a window sees */
    uint64_t key;                 /* of the library: the row, rule and scene of this part; 0: none */
    size_t count;                 /* of the library: number of terms */
    uint32_t from, to, fallbacks; /* of the library: the directions, and the windows left to the robust method */
} fibrad_row_part;

/* Part of a beam row: what directions `from` to `to` - 1 of the row give. Several threads may compute different parts
 * of one row at the same time.
 *   Input    work: of the calling thread
 *            i: 0 to spheres - 1
 *            rule: as for fibrad_beam_row; NULL for all defaults
 *            from, to: 0 <= from < to <= directions of the rule
 *   Output   part
 *   Errors   _ARGUMENT, _STATE, _TABLE, _WORK, _MEMORY, _BACK
 *            _CAPACITY: fixed part->memory is too small; part->memory.needed is the size that suffices
 *            _UNSUPPORTED: the rule has a tolerance
 *   Cost     that of fibrad_beam_row for as many directions */
int fibrad_beam_part(const fibrad_scene *scene, fibrad_work *work, uint32_t i, const fibrad_beam_rule *rule,
                     uint32_t from, uint32_t to, fibrad_row_part *part);

/* The row that the parts make up, the same to the bit as by fibrad_beam_row.
 *   Input    i, rule: as for the parts
 *            part[parts]: in ascending order of directions, without gaps
 *   Output   row
 *   Errors   as fibrad_beam_row
 *            _STATE: a part is missing, or belongs to another row, rule or scene
 *            _UNSUPPORTED: the rule has a tolerance
 *   Cost     some ns per term */
int fibrad_beam_join(const fibrad_scene *scene, fibrad_work *work, uint32_t i, const fibrad_beam_rule *rule,
                     const fibrad_row_part *part, uint32_t parts, fibrad_row *row);

/* Emissions and powers of spheres, walls and surroundings. Let e be the unit of emission, W/m2 for example. Powers are
 * in e L^2 and above 0 where heat is gained. fibrad_rows_flow adds to the powers: set them to 0 first. */
typedef struct fibrad_flow {
    const double *weight;         /* L^2, [spheres], area times emissivity, 4 pi r^2 eps; read where there is a row */
    const double *emission;       /* e, [spheres], sigma T^4 */
    const double *body_emission;  /* e, [bodies], sigma T^4 of each wall */
    double surroundings_emission; /* e, sigma T^4 of the surroundings */
    double *power;                /* e L^2, [spheres], in and out */
    double *body_power;           /* e L^2, [bodies], in and out */
    double surroundings_power;    /* e L^2, in and out */
} fibrad_flow;

/* Adds the powers that follow from rows of exchange factors. There may be rows for some of the spheres only.
 *
 * An entry D_ij moves the power A_i eps_i D_ij (E_j - E_i)/2 from sphere j to sphere i. The other half comes from row
 * j, on this or on another machine. A factor to a wall or to the surroundings moves the full power, since walls and
 * surroundings have no rows here. All factors of a row are first multiplied by 1/(1 - beyond). What sphere i gains, the
 * others lose to the bit. Nothing flows between equal emissions.
 *   Input    rows: a collection, added in its order
 *            spheres, bodies: lengths of the arrays in `flow`
 *   Output   flow: the powers
 *   Errors   _ARGUMENT: also a sphere or column not below `spheres`, a number of walls other than `bodies`, or a value
 *            that is not finite
 *            _STATE: the block of the collection was moved to another alignment
 *   Cost     2 ns per entry
 *   Source   docs/coupling.md */
int fibrad_rows_flow(const fibrad_rows *rows, uint32_t spheres, uint32_t bodies, fibrad_flow *flow);

/* Reads the next row of a collection. The arrays of `row` lie in the collection, and row->rows is NULL. They are valid
 * until a row is appended. The caller may write the columns, to number the spheres anew. The columns must then ascend.
 *   Input    at: 0 at the first call; each call moves `at` to the next row
 *   Output   row
 *   Errors   none. Returns 1, or 0 after the last row. */
int fibrad_rows_read(fibrad_rows *rows, size_t *at, fibrad_row *row);

#ifdef __cplusplus
}
#endif
#endif
