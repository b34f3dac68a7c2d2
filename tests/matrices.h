/* matrices.h - rows and matrices, for tests. SPDX-License-Identifier: MIT */
#ifndef TESTS_MATRICES_H
#define TESTS_MATRICES_H

#include "scenes.h"
#include "suite.h"

/* Spheres of these radii, so far apart that the tests can make their rows by hand. */
static inline fibrad_scene *apart(uint32_t n, const double *r) {
    OWNED_BED bed = bed_empty();
    for (uint32_t i = 0; i < n; i++) add_sphere(&bed, 1000. * (i + 1), 0, 0, r[i]);
    return scene_of(&bed, FIBRAD_ISA_BEST);
}

/* Rows by hand, in the arrays of a compressed matrix. open: what a row does not give to
 * spheres goes to the surroundings. */
static inline void add_rows(fibrad_rows *rows, uint32_t n, const uint64_t *start, const uint32_t *col, const double *f,
                            bool open) {
    const fibrad_factors all = {.n = n, .start = start, .col = col, .f = f};
    for (uint32_t i = 0; i < n; i++) {
        const uint64_t begin = all.start[i];
        double sum = 0;
        for (uint64_t k = begin; k < all.start[i + 1]; k++) sum += f[k];
        fibrad_row row = {.sphere = i, .col = (uint32_t *)(uintptr_t)(all.col + begin)};
        row.f = (double *)(uintptr_t)(all.f + begin), row.length = (uint32_t)(all.start[i + 1] - begin);
        row.escaped = open ? 1 - sum : 0;
        assert_ok(fibrad_rows_add(rows, &row, 0));
    }
}

#endif
