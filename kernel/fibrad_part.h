/* fibrad_part.h - beds divided over machines: scenes that know a part of a bed, and powers from the rows of a part.
 *
 * Index: fibrad_occupancy, fibrad_beam_part, fibrad_beam_join, fibrad_flow, fibrad_rows_flow, fibrad_rows_read.
 * Conventions are those of fibrad.h.
 *
 * Beyond   A row with a cutoff knows spheres up to there from its sphere's centre; a scene may have a known region.
 *          What leaves either before it meets a sphere or a body is `beyond`: there may be spheres on its way that the
 *          scene does not have or that the cutoff leaves out. It goes on to a body or escapes if there are none: where
 *          the occupancy says so, or, without one and without a known region, where the box of all spheres ends. Beams
 *          and rays of view factors see spheres of the scene outside a known region as usual; reflections do not.
 * Parts    The row of a sphere depends on spheres with centres within cutoff + 1.5 largest radii of its own (1 where
 * none overlap), on the bodies, on the occupancy and on ids; not on other spheres, nor on their order: not a bit.
 *
 * SPDX-License-Identifier: MIT */
#ifndef FIBRAD_PART_H
#define FIBRAD_PART_H

#include "fibrad.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Where a bed has spheres: cells of a box. In cells that are not marked, and outside of the box, there is no part of
 * any sphere. It stays in place while the scene is used. */
typedef struct fibrad_occupancy {
    double low[3], high[3]; /* [L] the box, low below high */
    uint32_t cells[3];      /* along each axis, [1, 2^20] */
    int periodic[3];        /* 1: it repeats along the axis without end */
    const uint64_t *mark; /* [(cells + 63)/64] cell x + cells[0] (y + cells[1] z) is bit .%64 of word ./64; NULL: all */
} fibrad_occupancy;

/* What some directions of a beam row give. Set `memory` alone. */
typedef struct fibrad_row_part {
    fibrad_memory memory;         /* 16 bytes for each sphere that a window sees */
    uint64_t key;                 /* the kernel's own, as all below: what it is a part of, 0: nothing */
    size_t count;                 /* terms of the row's sums */
    uint32_t from, to, fallbacks; /* its directions */
} fibrad_row_part;

/* A row divided over threads. _part: what directions [from, to) of fibrad_beam_row give, by a rule without a tolerance
 * (else FIBRAD_E_UNSUPPORTED). _join: the row, from parts in order that together have all directions: to the bit the
 * row that fibrad_beam_row returns. Work memory and `row` as there. Errors: as fibrad_beam_row; _STATE: a part is
 * missing or of another row, rule or scene. Cost: together as fibrad_beam_row; _join adds up lists.
 */
int fibrad_beam_part(const fibrad_scene *scene, fibrad_work *work, uint32_t i, const fibrad_beam_rule *rule,
                     uint32_t from, uint32_t to, fibrad_row_part *part);
int fibrad_beam_join(const fibrad_scene *scene, fibrad_work *work, uint32_t i, const fibrad_beam_rule *rule,
                     const fibrad_row_part *part, uint32_t parts, fibrad_row *row);

/* Emission and powers of a part. Power is in the unit of emission L^2, > 0 where heat is gained. */
typedef struct fibrad_flow {
    const double *weight;         /* [spheres] A eps [L^2] = 4 pi r^2 eps, of those whose rows there are */
    const double *emission;       /* [spheres] sigma T^4 */
    const double *body_emission;  /* [bodies] */
    double surroundings_emission; /* of what is met where rows say `escaped` */
    double *power;                /* [spheres] added to */
    double *body_power;           /* [bodies] added to */
    double surroundings_power;    /* added to */
} fibrad_flow;

/* Adds the powers that follow from rows of exchange factors as they are, which need not be square: an entry carries
 * half of what its pair exchanges, f = 1/2 A_i eps_i D_ij (E_j - E_i) from j to i; the other half comes from row j, on
 * the same machine or on another. Bodies and surroundings have no rows, so their entries count in full. What is
 * `beyond` is given back to the row, times 1/(1 - beyond). What i gains j loses, to the bit before they are summed;
 * nothing flows between equal emissions. Rows in the order of the collection. Errors: FIBRAD_E_ARGUMENT: a null
 * pointer, a column or a row beyond `spheres`, rows of another number of bodies, values that are not finite; _STATE:
 * the block was moved to another alignment. Cost: 2 ns per entry. */
int fibrad_rows_flow(const fibrad_rows *rows, uint32_t spheres, uint32_t bodies, fibrad_flow *flow);

/* Rows one after the other: 1 and the row that begins at *at (0 at first, moved behind it), or 0 behind the last. Its
 * arrays are those of the collection, valid until a row is appended; row->rows is NULL. Columns may be written, as long
 * as they ascend: to number the spheres anew. No errors. */
int fibrad_rows_read(fibrad_rows *rows, size_t *at, fibrad_row *row);

#ifdef __cplusplus
}
#endif
#endif
