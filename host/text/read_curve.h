/* read_curve.h - curves from tables of two columns. SPDX-License-Identifier: MIT */
#ifndef READ_CURVE_H
#define READ_CURVE_H

#include <stddef.h>

/* y over x: linear between points, constant before the first and behind the last one. */
struct curve {
    double *x, *y; /* [n] x ascending */
    size_t n;      /* 0: there is none */
};

/* Reads a table of x and y with commas, semicolons, tabs or blanks in between. A header, lines that begin with # and
 * blank lines are skipped. `what` names y in messages. Free the curve also after an error. Status 0, as lines_next, or
 * STATUS_INPUT naming a line where x does not ascend or y is not within low and high. */
int curve_read(const char *path, const char *what, double low, double high, struct curve *curve);

/* Reads a table of one column, y. x of the curve has no meaning. Otherwise as curve_read. */
int column_read(const char *path, const char *what, double low, double high, struct curve *column);
void curve_free(struct curve *curve);

/* The value at x. */
double curve_at(const struct curve *curve, double x);

/* The end of the way from x on which the integral of y is `area`, which may be below 0. y is above 0. With a heat
 * capacity over temperature: the temperature that a heat leads to. */
double curve_advance(const struct curve *curve, double x, double area);

#endif
