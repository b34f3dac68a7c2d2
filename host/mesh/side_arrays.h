/* side_arrays.h - values of the sides of triangles, and arrays over triangles made of them.
 * SPDX-License-Identifier: MIT */
#ifndef SIDE_ARRAYS_H
#define SIDE_ARRAYS_H

#include <stddef.h>

#include "fibrad_mesh.h"

/* One quantity. NaN: the side has no value. */
struct side_quantity {
    const char *name[3];                /* names of the arrays of whole triangles, of fronts and of backs */
    double (*join)(double a, double b); /* makes the value of a triangle of the values of its two sides */
    double *side;                       /* [2 n] in: element 2 t is the front and 2 t + 1 the back of triangle t */
    double *shown[3];                   /* [n] out: the three arrays */
};

/* Begin with zeroes; free with side_arrays_free. */
enum { SIDE_QUANTITIES = 2 };
struct side_arrays {
    uint32_t n;    /* triangles */
    size_t arrays; /* per quantity: 3 if both sides of some triangle are walls, else 1 */
    size_t count;  /* of quantities */
    struct side_quantity quantity[SIDE_QUANTITIES];
    double *values; /* the block of all arrays */
};

/* Allocates the arrays of quantities [count]. Status 0 or STATUS_MEMORY. */
int side_arrays_begin(struct side_arrays *arrays, const struct fibrad_triangles *triangles,
                      const struct side_quantity *quantity, size_t count);
void side_arrays_free(struct side_arrays *arrays);

/* Fills `shown` from `side`. */
void side_arrays_show(struct side_arrays *arrays);

#endif
