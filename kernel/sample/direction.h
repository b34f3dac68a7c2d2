/* direction.h - directions of the spherical Fibonacci set, for the kernel's loops. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SAMPLE_DIRECTION_H
#define FIBRAD_SAMPLE_DIRECTION_H

#include "sample/tables.h"

/* Cosine and sine of k golden angles by addition of angles, k < FIBRAD_DIRECTIONS_MAX. The bits are those of the
 * table. Cost: about 60 operations. */
void fibrad_azimuth_sum(uint32_t k, double *cos, double *sin);

/* Cosine and sine of k golden angles, k < FIBRAD_DIRECTIONS_MAX. Each is the true value rounded once. */
static inline void fibrad_azimuth(uint32_t k, double *cos, double *sin) {
#if FIBRAD_TABLE_AZIMUTHS > 0
    if (k < FIBRAD_TABLE_AZIMUTHS) {
        *cos = fibrad_table_azimuth[k][0];
        *sin = fibrad_table_azimuth[k][1];
        return;
    }
#endif
    fibrad_azimuth_sum(k, cos, sin);
}

/* A direction in cylindrical coordinates: (ring cos, ring sin, z). The vectors (-sin, cos, 0) and (-z cos, -z sin,
 * ring) complete a right-handed frame. */
typedef struct fibrad_polar {
    double z, ring, cos, sin;
} fibrad_polar;

/* Direction k of n as in fibrad_direction, without checks. z is rounded once. The ring is sqrt(1 - z^2) without
 * cancellation, since (2k + 1)(2n - 2k - 1) and n^2 are exact. */
static inline fibrad_polar fibrad_direction_polar(uint32_t k, uint32_t n) {
    uint64_t down = 2 * (uint64_t)k + 1, up = 2 * (uint64_t)n - down;
    fibrad_polar p;
    p.z = ((double)n - (double)down) / (double)n;
    p.ring = fibrad_sqrt((double)(down * up) / ((double)n * (double)n));
    fibrad_azimuth(k, &p.cos, &p.sin);
    return p;
}

/* The axes of window k of a rule: two unit vectors across the direction, then the direction. points: 0 for exact
 * areas. */
void fibrad_beam_frame(uint32_t k, uint32_t directions, uint32_t points, double frame[9]);

/* A random turn of the directions about an axis. Each direction also has a random height within its share of all
 * heights. So the mean over turns has no error, and half of an even number of directions rise along the axis. */
typedef struct fibrad_turning {
    double height, cos, sin; /* height: -1 to 1, times the half height of a share */
    int axis;
} fibrad_turning;

fibrad_turning fibrad_turning_of(uint64_t seed, int axis);

/* As fibrad_beam_frame, for a direction that is turned. */
void fibrad_turned_frame(const fibrad_turning *turn, uint32_t k, uint32_t directions, uint32_t points, double frame[9]);

#endif
