/* side_arrays.h - values of the sides of triangles as arrays of triangles, to be written. SPDX-License-Identifier: MIT
 */
#ifndef SIDE_ARRAYS_H
#define SIDE_ARRAYS_H

#include <stdbool.h>
#include <stddef.h>

#include "fibrad_mesh.h"

/* One quantity; NaN: a side has none. */
struct side_quantity {
    const char *name[3];                /* of the arrays of triangles, of their fronts, and of their backs */
    double (*join)(double a, double b); /* the value of a triangle whose sides have these */
    double *side;                       /* [2 n] fronts and backs in turn */
    double *shown[3];                   /* [n] of each array */
};

/* Zeroed: none; to be freed by side_arrays_free. */
enum { SIDE_QUANTITIES = 2 };
struct side_arrays {
    uint32_t n;    /* triangles */
    size_t arrays; /* of each quantity: 3 where a triangle has two sides that are a body's, else 1 */
    size_t count;
    struct side_quantity quantity[SIDE_QUANTITIES];
    double *values; /* of all of them */
};

/* Takes arrays for quantities [count] of all triangles. Status 0 or STATUS_MEMORY. */
int side_arrays_begin(struct side_arrays *arrays, const struct fibrad_triangles *triangles,
                      const struct side_quantity *quantity, size_t count);
void side_arrays_free(struct side_arrays *arrays);

/* Fills what is shown after what sides have. */
void side_arrays_show(struct side_arrays *arrays);

#endif
