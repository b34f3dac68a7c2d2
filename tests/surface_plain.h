/* surface_plain.h - the surface method as published, ray by ray, without shortcuts, for comparison.
 * SPDX-License-Identifier: MIT */
#ifndef SURFACE_PLAIN_H
#define SURFACE_PLAIN_H

#include <math.h>
#include <stdint.h>

#include "asserts.h"
#include "fibrad.h"

#define NODES_MAX 987

typedef struct point {
    double at[3], normal[3], area;
} point;

static uint32_t plain_nodes(point *p, uint32_t n, double r, double centre_z, double turn) {
    uint32_t before = 5;
    for (uint32_t size = 8; size < n;) {
        const uint32_t next = size + before;
        before = size;
        size = next;
    }
    for (uint32_t k = 1; k <= n; k++) {
        const double phi = 2 * PI * (k * before % n) / n + turn, z = -r + 2 * r * k / n;
        const double tau = z + r * sin(PI * z / r) / PI, ring = sqrt(fmax(0, r * r - tau * tau));
        const double normal[3] = {ring * cos(phi) / r, ring * sin(phi) / r, tau / r};
        for (int c = 0; c < 3; c++) {
            p[k - 1].normal[c] = normal[c];
            p[k - 1].at[c] = r * normal[c] + (c == 2 ? centre_z : 0);
        }
        p[k - 1].area = 4 * PI * r * r / n * (1 + cos(PI * z / r));
    }
    return n;
}

/* Whether the distance of the obstacle's centre from the segment is below the obstacle's radius. */
static int plain_blocked(const double from[3], const double e[3], double ee, const fibrad_spheres *o, uint32_t k) {
    const double c[3] = {o->x[k] - from[0], o->y[k] - from[1], o->z[k] - from[2]};
    const double t = fmin(1, fmax(0, (c[0] * e[0] + c[1] * e[1] + c[2] * e[2]) / ee));
    double dd = 0;
    for (int i = 0; i < 3; i++) dd += (c[i] - t * e[i]) * (c[i] - t * e[i]);
    return dd < o->r[k] * o->r[k];
}

/* F12 in the pair frame, unblocked and blocked, without correction. */
static void surface_plain(double r1, double r2, double gap, const fibrad_spheres *o, uint32_t n, double *unblocked,
                          double *raw) {
    static point first[NODES_MAX], second[2 * NODES_MAX];
    plain_nodes(first, n, r1, 0, 0);
    plain_nodes(second, n, r2, r1 + r2 + gap, 0);
    plain_nodes(second + n, n, r2, r1 + r2 + gap, PI);
    long double open = 0, seen = 0;
    for (uint32_t k = 0; k < n; k++)
        for (uint32_t l = 0; l < 2 * n; l++) {
            const point *a = &first[k], *b = &second[l];
            double e[3], ee = 0, cos1 = 0, cos2 = 0;
            for (int c = 0; c < 3; c++) {
                e[c] = b->at[c] - a->at[c];
                ee += e[c] * e[c];
                cos1 += e[c] * a->normal[c];
                cos2 -= e[c] * b->normal[c];
            }
            if (cos1 <= 0 || cos2 <= 0) continue;
            const double g = cos1 * cos2 / (PI * ee * ee) * a->area * b->area;
            int hidden = 0;
            for (uint32_t m = 0; o != NULL && m < o->n; m++) hidden |= plain_blocked(a->at, e, ee, o, m);
            open += g;
            if (!hidden) seen += g;
        }
    *unblocked = (double)open / (2 * 4 * PI * r1 * r1);
    *raw = (double)seen / (2 * 4 * PI * r1 * r1);
}

#endif
