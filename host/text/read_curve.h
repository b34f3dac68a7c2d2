/* read_curve.h - curves from tables of two columns. SPDX-License-Identifier: MIT */
#ifndef READ_CURVE_H
#define READ_CURVE_H

#include <stddef.h>

/* y over x, straight between points, constant beyond. */
struct curve {
    double *x, *y; /* [n] x ascending */
    size_t n;      /* 0: there is none */
};

/* Reads a table: x and y in each line, parted by commas, semicolons, tabs or blanks; a header, lines that begin with #
 * and blank ones are skipped. `what` is what y is, in messages. To be freed also after an error. Status 0, STATUS_INPUT
 * naming the line where x does not ascend or y is not in [low, high], or as lines_next. */
int curve_read(const char *path, const char *what, double low, double high, struct curve *curve);

/* The same of one column, y; x is without a meaning. */
int column_read(const char *path, const char *what, double low, double high, struct curve *column);
void curve_free(struct curve *curve);

/* The value at x. */
double curve_at(const struct curve *curve, double x);

#endif
