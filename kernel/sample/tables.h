/* tables.h - Fibonacci samples as constant tables. SPDX-License-Identifier: MIT
 *
 * The tables are written by generate_tables.c into build/tables.c. Every entry is the true value rounded once.
 * A small target limits them when it compiles build/tables.c and the kernel:
 *   -DFIBRAD_TABLE_AZIMUTHS=N  azimuths kept at hand: 0, 256, 1024, 4096 or 10946 (default), 16 N bytes. The others, up
 *                              to FIBRAD_DIRECTIONS_MAX, are summed from 16 KB of angles; the bits are the same.
 *   -DFIBRAD_TABLE_SURFACE=N   largest surface rule: 0 (none), 8, 13, ... 987 (default), about 104 N bytes.
 *   -DFIBRAD_TABLE_LINES=N     largest set of lines: 0 (none), 8, 11, ... 1024 (default), about 31 N bytes.
 */
#ifndef FIBRAD_SAMPLE_TABLES_H
#define FIBRAD_SAMPLE_TABLES_H

#include "fibrad.h"
#include "base/port.h"

#ifndef FIBRAD_TABLE_AZIMUTHS
#define FIBRAD_TABLE_AZIMUTHS 10946
#endif
#ifndef FIBRAD_TABLE_SURFACE
#define FIBRAD_TABLE_SURFACE 987
#endif
#ifndef FIBRAD_TABLE_LINES
#define FIBRAD_TABLE_LINES 1024
#endif

/* Cosine and sine of k golden angles. The golden angle is pi (3 - sqrt 5). */
#if FIBRAD_TABLE_AZIMUTHS > 0
extern const double fibrad_table_azimuth[FIBRAD_TABLE_AZIMUTHS][2];
#endif

/* A cosine and a sine with twice the precision of a double. Each is the sum of two doubles. */
typedef struct fibrad_long_angle {
    double cos, cos_rest, sin, sin_rest;
} fibrad_long_angle;

/* Angle k = FIBRAD_TABLE_STRIDE q + m is the sum of fibrad_table_far[q] and fibrad_table_near[m]. */
#define FIBRAD_TABLE_STRIDE 256
extern const fibrad_long_angle fibrad_table_near[FIBRAD_TABLE_STRIDE];
extern const fibrad_long_angle fibrad_table_far[FIBRAD_DIRECTIONS_MAX / FIBRAD_TABLE_STRIDE];

/* Points in the unit disc. Point k of M has the radius sqrt((k + 1/2)/M) and an azimuth of k golden angles. The sets
 * of 64, 128 and 256 points follow each other, so the set of M begins at M - 64. */
extern const float fibrad_table_disc_x[64 + 128 + 256];
extern const float fibrad_table_disc_y[64 + 128 + 256];

/* A set of points in the unit disc, on 64-byte boundaries. */
typedef struct fibrad_disc_points {
    const float *x, *y; /* [M] */
} fibrad_disc_points;

/* The set of M points. FIBRAD_E_TABLE: M is not 64, 128 or 256. */
static inline int fibrad_disc_points_get(uint32_t m, fibrad_disc_points *points) {
    if (m != 64 && m != 128 && m != 256) return FIBRAD_E_TABLE;
    points->x = fibrad_table_disc_x + (m - 64);
    points->y = fibrad_table_disc_y + (m - 64);
    return FIBRAD_OK;
}

/* Nodes of the surface rules on the unit sphere. The rules of 8, 13, ... nodes follow each other. Each is padded to
 * a multiple of 8 by nodes at the pole with weight 0. */
#if FIBRAD_TABLE_SURFACE > 0
extern const double fibrad_table_surface_z[], fibrad_table_surface_ring[], fibrad_table_surface_cos[],
    fibrad_table_surface_sin[], fibrad_table_surface_weight[];
#endif

/* Sets of 8, 11, ... lines, one after another. An entry is x/(1 + z) and y/(1 + z) in units of 2^-31, z >= 0. The
 * other tables are made when fibrad is built, but this one is the source line_table.c, which generate_lines.c has
 * written. */
#if FIBRAD_TABLE_LINES >= 8
extern const int32_t fibrad_table_lines[][2];
/* Bit k % 32 of word k / 32: line k of the table is to be turned round. */
extern const uint32_t fibrad_table_senses[];
#endif

/* A Fibonacci lattice of N_F nodes about the z axis, on 64-byte boundaries; entry k - 1 is node k = 1 ... N_F. */
typedef struct fibrad_surface_nodes {
    const double *z;      /* tau(z_k), tau(z) = z + sin(pi z)/pi, z_k = -1 + 2 k/N_F */
    const double *ring;   /* sqrt(1 - tau^2), the distance from the axis */
    const double *cos;    /* of the azimuth 2 pi (k N'_F mod N_F)/N_F, where N'_F is the Fibonacci number before N_F */
    const double *sin;    /* of the same azimuth */
    const double *weight; /* tau'(z_k) = 1 + cos(pi z_k); the weights of a rule have the sum N_F */
    uint32_t n;           /* N_F */
} fibrad_surface_nodes;

/* The rule of n nodes. FIBRAD_E_TABLE: n is not a Fibonacci number from 8 to FIBRAD_TABLE_SURFACE. */
static inline int fibrad_surface_nodes_get(uint32_t n, fibrad_surface_nodes *nodes) {
    uint32_t offset = 0, size = 8, next = 13;
    while (size < n && next <= FIBRAD_TABLE_SURFACE) {
        offset += (size + 7) / 8 * 8;
        uint32_t sum = size + next;
        size = next;
        next = sum;
    }
    if (size != n || n > FIBRAD_TABLE_SURFACE) return FIBRAD_E_TABLE;
#if FIBRAD_TABLE_SURFACE > 0
    nodes->z = fibrad_table_surface_z + offset;
    nodes->ring = fibrad_table_surface_ring + offset;
    nodes->cos = fibrad_table_surface_cos + offset;
    nodes->sin = fibrad_table_surface_sin + offset;
    nodes->weight = fibrad_table_surface_weight + offset;
    nodes->n = n;
#else
    (void)nodes;
#endif
    return FIBRAD_OK;
}

#endif
