/* read_curve.c - curves from tables. SPDX-License-Identifier: MIT */
#include "text/read_curve.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "text/header.h"
#include "text/unit.h"

#define TIMES "t time"

const struct curve_axes curve_kelvins = {{TIMES, "s"}, CURVE_AXIS_KELVINS},
                        curve_celsius = {{TIMES, "s"}, {CURVE_TEMPERATURES, "C"}},
                        curve_values = {
                            CURVE_AXIS_KELVINS,
                            {"e eps epsilon emissivity k lambda conductivity c cp c_p capacity value", CURVE_ANY_UNIT}};

/* A table that is being read. */
struct table {
    struct lines lines;
    struct header header;
    struct fields fields;
    char header_separator, separator; /* of the present row; 0: there is no header, no row so far */
    bool comment;                     /* the header is a comment */
    char mark;                        /* decimal point or comma, the first one in the file; 0: none so far */
    size_t width;
    size_t at[2];                   /* columns of x and y; without x only at[1] has a meaning */
    double factor[2], offset[2];    /* to the expected units */
    const struct curve_axis *x, *y; /* x NULL: only y is wanted */
    const char *what;               /* y in messages */
    double low, high;               /* limits of y */
    struct curve *curve;
};

enum { X, Y };

/* ---- header ----------------------------------------------------------------------------------------------------- */

/* Whether a name of the header is one of the usual ones, up to a _ behind it. */
static bool is_usual(const char *name, const char *usual) {
    for (; *usual; usual += strspn(usual, " ")) {
        const size_t length = strcspn(usual, " ");
        const bool same = (length == 1 ? strncmp : strncasecmp)(name, usual, length) == 0;
        if (same && (name[length] == 0 || name[length] == '_')) return true;
        usual += length;
    }
    return false;
}

/* The unit of a column: that in brackets, or else what stands behind the _ of t_min or T_C. */
static const char *unit_of_column(const struct header *header, size_t k) {
    const char *name = header->names.at[k], *behind = strrchr(name, '_');
    double factor;
    if (*header->unit[k] || !behind) return header->unit[k];
    ++behind;
    const bool time = is_usual(name, TIMES) && unit_factor(behind, "s", &factor);
    return time || (is_usual(name, CURVE_TEMPERATURES) && unit_temperature(behind)) ? behind : "";
}

/* Whether a unit is of the kind that an axis expects. K and C are of one kind. */
static bool is_of_kind(const char *unit, const struct curve_axis *axis) {
    double factor;
    if (unit_temperature(axis->unit)) return unit_temperature(unit);
    return *axis->unit && !unit_none(unit) && unit_factor(unit, axis->unit, &factor);
}

/* The only column that an axis may be, by its name or else by its unit. header->names.n: there is none, or several. */
static size_t find_axis(const struct header *header, const struct curve_axis *axis) {
    const size_t n = header->names.n;
    for (int by_unit = 0; by_unit < 2; ++by_unit) {
        size_t found = n, count = 0;
        for (size_t k = 0; k < n; ++k) {
            const bool is =
                by_unit ? is_of_kind(unit_of_column(header, k), axis) : is_usual(header->names.at[k], axis->names);
            if (is) found = k, ++count;
        }
        if (count == 1) return found;
    }
    return n;
}

/* Finds how the values of a column become those of the expected unit. */
static int take_column_unit(struct table *table, int axis, const struct curve_axis *expected) {
    const char *unit = unit_of_column(&table->header, table->at[axis]);
    if (unit_none(unit) || strcmp(expected->unit, CURVE_ANY_UNIT) == 0) return STATUS_OK;
    if (unit_factor(unit, expected->unit, &table->factor[axis])) return STATUS_OK;
    if (axis == X && unit_is(expected->unit, "K") && unit_is(unit, "C")) {
        table->offset[axis] = 273.15;
        return STATUS_OK;
    }
    return message_at(STATUS_INPUT, table->lines.name, table->header.line,
                      "the column %.40s is in [%.20s], but is taken as [%.20s]%s",
                      table->header.names.at[table->at[axis]], unit, *expected->unit ? expected->unit : "-",
                      unit_temperature(expected->unit) ? "; see --temperature-unit" : "");
}

static int wrong_width(const struct table *table, size_t n, size_t wanted) {
    return lines_fault(&table->lines, "%zu columns instead of %zu", n, wanted);
}

/* Finds out which column is which. Without a header, or with unusual names, x is the first of two columns. Words
 * between blanks may be a title. They are names only if all are known. */
static int find_axes(struct table *table) {
    const struct curve_axis *x = table->x, *y = table->y;
    const size_t n = table->width, wanted = x ? 2 : 1;
    const bool sure = table->header_separator == table->separator && table->separator != ' ';
    bool named = table->header_separator && table->header.names.n == n;
    if (sure && !named && !table->comment) return wrong_width(table, n, table->header.names.n);
    size_t of_y = named ? find_axis(&table->header, y) : n, of_x = named && x ? find_axis(&table->header, x) : n;
    if (of_x == of_y) of_x = of_y = n;
    const bool found = of_y < n && (!x || of_x < n);
    if (n != wanted && !found) return wrong_width(table, n, wanted);
    named = named && (found || n == 1 || sure);
    table->at[X] = 0, table->at[Y] = wanted - 1;
    if (!named) return STATUS_OK;
    if (of_x < n) table->at[X] = of_x, table->at[Y] = of_y < n ? of_y : 1 - of_x;
    if (of_x == n && of_y < n) table->at[X] = x ? 1 - of_y : 0, table->at[Y] = of_y;
    const int status = x ? take_column_unit(table, X, x) : STATUS_OK;
    return status ? status : take_column_unit(table, Y, y);
}

/* Takes a text of the current line as the header. A comment must have a name of a column. */
static int take_names(struct table *table, const char *text) {
    const bool comment = text != table->lines.text;
    struct header header = {0};
    const int status = header_take(&header, &table->lines, text, NULL);
    while (header.names.n > 1 && !*header.names.at[header.names.n - 1]) --header.names.n;
    const size_t n = header.names.n;
    if (status || (comment && (!table->x || find_axis(&header, table->x) == n) && find_axis(&header, table->y) == n)) {
        header_free(&header);
        return status;
    }
    table->header_separator = header_separator(text);
    table->comment = comment;
    header_free(&table->header);
    table->header = header;
    return STATUS_OK;
}

/* ---- rows ------------------------------------------------------------------------------------------------------- */

static int curve_point(struct table *table) {
    struct curve *curve = table->curve;
    double value[2] = {0, 0};
    if (table->fields.n != table->width) return wrong_width(table, table->fields.n, table->width);
    bool good = true;
    curve->x = memory_grown(curve->x, curve->n, sizeof *curve->x, &good);
    curve->y = memory_grown(curve->y, curve->n, sizeof *curve->y, &good);
    int status = good ? STATUS_OK : message_memory();
    for (int k = table->x ? X : Y; k <= Y && !status; ++k) {
        status = lines_decimal(&table->lines, k == X ? "number" : table->what, table->fields.at[table->at[k]],
                               table->separator == ',' ? NULL : &table->mark, &value[k]);
        value[k] = value[k] * table->factor[k] + table->offset[k];
    }
    if (status) return status;
    if (!(value[Y] >= table->low && value[Y] <= table->high))
        return lines_fault(&table->lines, "the %s is %g; it must be within %g and %g", table->what, value[Y],
                           table->low, table->high);
    if (!isfinite(value[X])) return lines_fault(&table->lines, "%s is too large", table->fields.at[table->at[X]]);
    if (table->x && curve->n > 0 && !(value[X] > curve->x[curve->n - 1]))
        return lines_fault(&table->lines, "%s is not above the number before", table->fields.at[table->at[X]]);
    curve->x[curve->n] = value[X];
    curve->y[curve->n++] = value[Y];
    return STATUS_OK;
}

/* Takes a line of the table: a header, a comment that may be one, or a row. */
static int take_table_line(struct table *table, bool *header_may_follow) {
    struct lines *lines = &table->lines;
    if (lines_blank(lines)) return STATUS_OK;
    if (lines_comment(lines)) {
        const char *names = lines->text + strspn(lines->text, "#% \t");
        return *header_may_follow && *names && !strchr(names, '"') ? take_names(table, names) : STATUS_OK;
    }
    if (*header_may_follow && !header_is_row(lines)) {
        *header_may_follow = false;
        return take_names(table, lines->text);
    }
    *header_may_follow = false;
    table->separator = header_separator(lines->text);
    int status = header_split(&table->fields, lines, lines->text, table->separator);
    while (table->fields.n > 1 && !*table->fields.at[table->fields.n - 1]) --table->fields.n; /* a separator ends it */
    if (!status && table->width == 0) {
        table->width = table->fields.n;
        status = find_axes(table);
    }
    return status ? status : curve_point(table);
}

static int table_read(const char *path, struct table *table) {
    *table->curve = (struct curve){0};
    table->factor[X] = table->factor[Y] = 1;
    int status = lines_open(&table->lines, path);
    for (bool more = true, header_may_follow = true; !status;) {
        status = lines_next(&table->lines, &more);
        if (status || !more) break;
        status = take_table_line(table, &header_may_follow);
    }
    if (!status && table->lines.truncated)
        status = message_at(STATUS_INPUT, table->lines.name, 0, "the gzip file is cut off");
    if (!status && table->curve->n == 0)
        status = message_at(STATUS_INPUT, lines_name(path), 0, "the table has no numbers");
    lines_close(&table->lines);
    header_free(&table->header);
    free(table->fields.at);
    return status;
}

int curve_read(const char *path, const char *what, const struct curve_axes *axes, double low, double high,
               struct curve *curve) {
    struct table table = {.x = &axes->x, .y = &axes->y, .what = what, .low = low, .high = high, .curve = curve};
    return table_read(path, &table);
}

int column_read(const char *path, const char *what, const struct curve_axis *y, double low, double high,
                struct curve *column) {
    return table_read(path, &(struct table){.y = y, .what = what, .low = low, .high = high, .curve = column});
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
        const double end = last ? x : curve->x[up ? k : k - 1], until = (y + curve_at(curve, end)) / 2 * (end - x);
        if (last || fabs(area) <= fabs(until)) return x + 2 * area / (y + sqrt(fmax(0, y * y + 2 * slope * area)));
        area -= until;
        x = end;
    }
}
