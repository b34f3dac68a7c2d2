/* read_curve.c - curves from tables of two columns. SPDX-License-Identifier: MIT */
#include "text/read_curve.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>

#include "cli/message.h"
#include "text/read_lines.h"

/* Makes room for another point. */
static int curve_grow(struct curve *curve) {
    if (curve->n & (curve->n - 1)) return STATUS_OK; /* room doubles when n is a power of 2 */
    const size_t room = curve->n ? 2 * curve->n : 1;
    double *x = realloc(curve->x, room * sizeof *x);
    if (x) curve->x = x;
    double *y = realloc(curve->y, room * sizeof *y);
    if (y) curve->y = y;
    return x && y ? STATUS_OK : message_memory();
}

static int curve_point(const struct lines *lines, const struct fields *fields, const char *what, double low,
                       double high, struct curve *curve) {
    if (fields->n != 2)
        return message_at(STATUS_INPUT, lines->name, lines->number, "%zu columns instead of 2", fields->n);
    int status = curve_grow(curve);
    if (!status) status = lines_number(lines, "number", fields->at[0], &curve->x[curve->n]);
    if (!status) status = lines_number(lines, what, fields->at[1], &curve->y[curve->n]);
    if (status) return status;
    const double y = curve->y[curve->n];
    if (!(y >= low && y <= high))
        return message_at(STATUS_INPUT, lines->name, lines->number, "the %s is %g; it must be within %g and %g", what,
                          y, low, high);
    if (curve->n > 0 && !(curve->x[curve->n] > curve->x[curve->n - 1]))
        return message_at(STATUS_INPUT, lines->name, lines->number, "%s is not above the number before", fields->at[0]);
    curve->n++;
    return STATUS_OK;
}

/* Takes the number in a line of a column. */
static int column_number(const struct lines *lines, const struct fields *fields, const char *what, double low,
                         double high, struct curve *column) {
    if (fields->n != 1)
        return message_at(STATUS_INPUT, lines->name, lines->number, "%zu columns instead of 1", fields->n);
    int status = curve_grow(column);
    if (!status) status = lines_number(lines, what, fields->at[0], &column->y[column->n]);
    if (status) return status;
    const double y = column->y[column->n++];
    if (y >= low && y <= high) return STATUS_OK;
    return message_at(STATUS_INPUT, lines->name, lines->number, "the %s is %g; it must be within %g and %g", what, y,
                      low, high);
}

/* Takes a line into a curve or a column. */
typedef int take_line(const struct lines *lines, const struct fields *fields, const char *what, double low, double high,
                      struct curve *curve);

static int read_columns_of(const char *path, const char *what, double low, double high, struct curve *curve,
                           take_line *take) {
    struct lines lines;
    struct fields fields = {0};
    *curve = (struct curve){0};
    int status = lines_open(&lines, path);
    if (status) return status;
    for (bool more = true, header = true; !status;) {
        status = lines_next(&lines, &more);
        if (status || !more) break;
        if (lines_blank(&lines) || *lines.text == '#') continue;
        const bool name = header && isalpha((unsigned char)*lines.text);
        header = false;
        if (name) continue;
        status = fields_split(&fields, lines.text, ",; \t\r");
        if (!status) status = take(&lines, &fields, what, low, high, curve);
    }
    if (!status && curve->n == 0) status = message_at(STATUS_INPUT, lines_name(path), 0, "the table has no numbers");
    lines_close(&lines);
    free(fields.at);
    return status;
}

int curve_read(const char *path, const char *what, double low, double high, struct curve *curve) {
    return read_columns_of(path, what, low, high, curve, curve_point);
}

int column_read(const char *path, const char *what, double low, double high, struct curve *column) {
    return read_columns_of(path, what, low, high, column, column_number);
}

void curve_free(struct curve *curve) {
    free(curve->x);
    free(curve->y);
    *curve = (struct curve){0};
}

/* Number of points of a curve up to x. `with`: a point at x is one of them. */
static size_t points_up_to(const struct curve *curve, double x, bool with) {
    size_t low = 0, high = curve->n;
    while (low < high) {
        const size_t k = (low + high) / 2;
        if (curve->x[k] < x || (with && curve->x[k] == x))
            low = k + 1;
        else
            high = k;
    }
    return low;
}

double curve_at(const struct curve *curve, double x) {
    const double *at = curve->x;
    if (!(x > at[0])) return curve->y[0];
    if (x >= at[curve->n - 1]) return curve->y[curve->n - 1];
    const size_t k = points_up_to(curve, x, true) - 1;
    return curve->y[k] + (curve->y[k + 1] - curve->y[k]) * ((x - at[k]) / (at[k + 1] - at[k]));
}

double curve_advance(const struct curve *curve, double x, double area) {
    const bool up = area > 0;
    for (;;) {
        /* y is a straight line until the next point, and does not change outside of all points */
        const size_t k = points_up_to(curve, x, up), n = curve->n;
        const bool inside = k > 0 && k < n;
        const double slope = inside ? (curve->y[k] - curve->y[k - 1]) / (curve->x[k] - curve->x[k - 1]) : 0;
        const double y = curve_at(curve, x);
        const bool last = up ? k == n : k == 0;
        const double end = last ? x : curve->x[up ? k : k - 1];
        const double until = (y + curve_at(curve, end)) / 2 * (end - x);
        if (last || fabs(area) <= fabs(until)) return x + 2 * area / (y + sqrt(fmax(0, y * y + 2 * slope * area)));
        area -= until;
        x = end;
    }
}
