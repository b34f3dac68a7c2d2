/* furnace.h - what the files of the furnace share. SPDX-License-Identifier: MIT
 *
 * Cells are numbered with x fastest. The faces of axis a are numbered likewise; there is one layer more of them
 * along a. The patches of each wall are numbered likewise too. The order of walls is that of base/faces.h. */
#ifndef FIBRAD_FURNACE_FURNACE_H
#define FIBRAD_FURNACE_FURNACE_H

#include "base/faces.h"
#include "base/random.h"
#include "fibrad_furnace.h"

/* A mapping of the box onto itself: axis a becomes axis[a], reversed if flip[a]. */
typedef struct fibrad_symmetry {
    uint8_t axis[3], flip[3];
} fibrad_symmetry;

struct fibrad_furnace {
    fibrad_furnace_config config;
    fibrad_furnace_arrays at;
    double step[3];                           /* edges of a cell [m] */
    double wall_power[6];                     /* net [W] */
    double wall_e[6];                         /* sigma T^4 of the walls [W/m2] */
    size_t cells, faces[3], patches[3];       /* patches: of one wall across the axis */
    size_t cell_stride[3], face_stride[3][3]; /* face_stride[a][b]: of the faces of a, along b */
    size_t wall_source[6];                    /* first source of each wall */
    size_t sources;                           /* cells, then patches */
    uint32_t symmetries;
    fibrad_symmetry symmetry[48];

    /* solver, per cell: q_out = gain q_in + feed J; response: change of E per unit of missing heat */
    double *gain[3][2], *feed[3][2], *response;

    /* plan of bundles */
    double reference;    /* uniform part of E, which needs no bundles [W/m2] */
    double bundle_power; /* W; 0: there is no plan */
    fibrad_furnace_physics physics;
    uint64_t origin, planned; /* bundles before this plan, and bundles of this plan */
    double *traced;           /* cell: E carried by all plans up to this one [W/m2] */
    double *power;            /* source: what this plan carries [W] */
    uint64_t *first;          /* [sources + 1]: first bundle of each source */
    uint64_t restarts;
    uint64_t series; /* hash of the first plan since the restart, not 0 */
    uint64_t plan;   /* hash of all plans since the restart */
    uint64_t mark;   /* mark of a tally that contains each bundle since the restart once */
};

/* The mark of a range of bundles of a plan: the hash of its end minus that of its beginning. Marks are added modulo
 * 2^64 in any order. If ranges cover a plan exactly once, the hashes of all inner ends cancel, and the sum is
 * mark(plan, 0, planned). If a range is missing or repeated, hashes are left over. Their sum is as good as a random
 * number. */
static inline uint64_t fibrad_bundles_mark(uint64_t plan, uint64_t first, uint64_t count) {
    return fibrad_mix(plan + first + count) - fibrad_mix(plan + first);
}

/* Weights are whole multiples of bundle_power / FIBRAD_TALLY_UNIT. So 2^32 crossings of one face fit into 63 bits. */
#define FIBRAD_TALLY_UNIT 0x1p30

/* F0, F1 and F2 of a face are adjacent because a bundle adds to all of them: one cache line instead of three. */
typedef struct fibrad_moments {
    int64_t f[3];
} fibrad_moments;

struct fibrad_furnace_tally {
    uint32_t cells[3];            /* of the furnace that the tally belongs to */
    uint64_t series, mark;        /* of the bundles in the tally; 0: none */
    fibrad_moments *moment[3][2]; /* faces of axis, hemisphere */
    int64_t *path;                /* by cell: weight times length, in diagonals of a cell */
    int64_t *absorbed;            /* by patch */
    int64_t *counts;              /* all arrays above, which are contiguous */
    size_t length;                /* number of counts */
};

/* Sets divergence, six_flux, wall and power from the fluxes. */
void fibrad_furnace_balance(fibrad_furnace *furnace);

static inline bool fibrad_tally_fits(const fibrad_furnace *f, const fibrad_furnace_tally *t) {
    return t->cells[0] == f->config.cells[0] && t->cells[1] == f->config.cells[1] && t->cells[2] == f->config.cells[2];
}

static inline double fibrad_cell_volume(const fibrad_furnace *f) { return f->step[0] * f->step[1] * f->step[2]; }

/* Area of a face across axis a. */
static inline double fibrad_face_area(const fibrad_furnace *f, uint32_t a) {
    return f->step[(a + 1) % 3] * f->step[(a + 2) % 3];
}

/* What a patch of wall w emits above the reference E [W]. */
static inline double fibrad_patch_power(const fibrad_furnace *f, uint32_t w) {
    double net = f->config.wall_emissivity[w] * (f->wall_e[w] - f->reference);
    return net * fibrad_face_area(f, fibrad_face_axis(w));
}

static inline double fibrad_cell_diagonal(const fibrad_furnace *f) {
    return fibrad_sqrt(f->step[0] * f->step[0] + f->step[1] * f->step[1] + f->step[2] * f->step[2]);
}

/* Emission and scattering into a hemisphere, over pi [W/m3]. */
static inline double fibrad_line_source(const fibrad_furnace *f, double e, double six_flux,
                                        fibrad_furnace_scatter scatter) {
    double ka = f->config.absorption, ks = f->config.scattering;
    return ka * e + ks * (scatter == FIBRAD_SCATTER_EXACT ? e - f->config.source / (4 * ka) : six_flux / 6);
}

/* The weight, in the rule for extinction, of the flux that enters a cell: half of the optical thickness by the
 * trapezoidal rule. It is limited so that the flux that leaves cannot be negative. */
static inline double fibrad_line_entry(double thickness, double theta_in) {
    return fibrad_min(thickness / 2, theta_in);
}

#endif
