/* read_curve.h - curves from tables. SPDX-License-Identifier: MIT */
#ifndef READ_CURVE_H
#define READ_CURVE_H

#include <stddef.h>

/* y over x: linear between points, constant before the first and behind the last one. */
struct curve {
    double *x, *y; /* [n] x ascending */
    size_t n;      /* 0: there is none */
};

/* What a column of a table is. */
struct curve_axis {
    const char *names; /* usual names with blanks in between, in any case but for single letters; T_C is T, too */
    const char *unit;  /* expected unit; "": none; CURVE_ANY_UNIT: values stay as they are */
};
#define CURVE_ANY_UNIT "*"

/* An axis of temperatures [K]. */
#define CURVE_TEMPERATURES "T temp temperature temperatures"
#define CURVE_AXIS_KELVINS                                                                                             \
    { CURVE_TEMPERATURES, "K" }

struct curve_axes {
    struct curve_axis x, y;
};

/* Temperatures [K] over times [s], or [C] over times [s]. */
extern const struct curve_axes curve_kelvins, curve_celsius;

/* Values of any kind and unit over temperatures [K]. */
extern const struct curve_axes curve_values;

/* Reads a table of x and y. Values are separated as in tables of spheres. Lines that begin with # and blank lines are
 * skipped. The header, which may be left out or be a comment, may have units and says which column is which. A table of
 * more than two columns needs a header with usual names. Units become the expected ones: min become s, degrees Celsius
 * of x become K. `what` names y in messages. Free the curve also after an error. Status 0, as lines_next, or
 * STATUS_INPUT naming a line whose unit is of another kind, where x does not ascend or where y is not within low and
 * high. */
int curve_read(const char *path, const char *what, const struct curve_axes *axes, double low, double high,
               struct curve *curve);

/* Reads the column y of a table, which may be its only one. x of the curve has no meaning. Otherwise as curve_read. */
int column_read(const char *path, const char *what, const struct curve_axis *y, double low, double high,
                struct curve *column);

void curve_free(struct curve *curve);

/* The value at x. */
double curve_at(const struct curve *curve, double x);

/* The end of the way from x on which the integral of y is `area`, which may be below 0. y is above 0. With a heat
 * capacity over temperature: the temperature that a heat leads to. */
double curve_advance(const struct curve *curve, double x, double area);

#endif
