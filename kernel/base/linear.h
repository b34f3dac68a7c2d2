/* linear.h - small systems of linear equations. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_BASE_LINEAR_H
#define FIBRAD_BASE_LINEAR_H

#include <stdint.h>

/* Solves n equations by elimination. row: [n][wide], with the right side of an equation in column n, where the solution
 * is left. Equations that depend linearly on those before are left out. The diagonal outweighs the rest. */
static inline void fibrad_solve_linear(uint32_t n, uint32_t wide, double *row) {
    for (uint32_t k = 0; k < n; k++)
        for (uint32_t m = k + 1; m < n && row[k * wide + k] > 1e-12; m++) {
            const double part = row[m * wide + k] / row[k * wide + k];
            for (uint32_t c = k + 1; c <= n && part != 0; c++) row[m * wide + c] -= part * row[k * wide + c];
        }
    for (uint32_t k = n; k-- > 0;) {
        double *of = row + k * wide;
        for (uint32_t m = k + 1; m < n; m++) of[n] -= of[m] * row[m * wide + n];
        of[n] = of[k] > 1e-12 ? of[n] / of[k] : 0;
    }
}

#endif
