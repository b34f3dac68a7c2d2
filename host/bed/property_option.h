/* property_option.h - radii, emissivities and temperatures of spheres and walls, from options and columns of the file.
 * SPDX-License-Identifier: MIT */
#ifndef PROPERTY_OPTION_H
#define PROPERTY_OPTION_H

#include <stdbool.h>

#include "bed/bed.h"
#include "bed/wall_option.h"
#include "text/report.h"
#include "text/read_curve.h"
#include "fibrad.h"

/* Largest temperature [K]. */
#define TEMPERATURE_MAX 1e9

/* Rows of tables of options, without braces. */
#define OPTION_EMISSIVITY(request, field)                                                                              \
    0, "emissivity", "E", "emissivity of all spheres, 0 to 1, or TYPE:E,..., or a column of the file",                 \
        TO_FUNCTION(emissivity_option, request, field)
#define OPTION_EMISSIVITY_CURVES(request, field)                                                                       \
    0, "emissivity", "E",                                                                                              \
        "emissivity of all spheres, 0 to 1, or @TABLE of temperatures [K] and emissivities, or "                       \
        "TYPE:E,TYPE:@TABLE,..., "                                                                                     \
        "or a column of the file",                                                                                     \
        TO_FUNCTION(emissivity_curves_option, request, field)
#define OPTION_WALL_EMISSIVITY(request, field)                                                                         \
    0, "wall-emissivity", "LIST",                                                                                      \
        "emissivities of walls, 0 to 1, zmin=0.3,0.9 for example; a number without a name is for all others [1]",      \
        TO_TEXT(request, field)

/* A quantity of spheres that an option gives: a number for all spheres, a value for each type, or a column. */
enum { QUANTITY_TYPES_MAX = 64 };
struct quantity {
    bool given;
    bool some;          /* some spheres may have no value: NaN */
    double value;       /* for all spheres, if there is no column */
    const char *column; /* name of the column of values or, if types > 0, of types; NULL: none */
    size_t index;       /* of the column in bed->extra */
    int types;          /* 0: values are not by type */
    double type[QUANTITY_TYPES_MAX], of_type[QUANTITY_TYPES_MAX]; /* [types] types and their values */
    const struct curve_axes *curves;        /* @TABLE is allowed in place of a number; NULL: not */
    struct curve curve[QUANTITY_TYPES_MAX]; /* [types] tables, or [0] for all spheres; n = 0: a number */
};

/* Reads the argument of an option `what`, whose values are from low to high. table_option allows @TABLE of temperatures
 * [K] and values. Status 0, STATUS_USAGE, or as curve_read. */
int quantity_option(const char *what, const char *text, double low, double high, struct quantity *quantity);
int table_option(const char *what, const char *text, const struct curve_axes *axes, double low, double high,
                 struct quantity *quantity);

/* Take the arguments of --emissivity and --temperature into a quantity. */
int emissivity_option(const char *text, void *quantity);
int emissivity_curves_option(const char *text, void *quantity);
int temperature_option(const char *text, void *quantity);

/* How far spheres, or contacts, lie beyond the ends of tables. */
struct table_excess {
    uint32_t number;
    double kelvins; /* largest distance from an end */
};

/* Finds this for the temperatures [bed->n]. Each number of *excess grows to the present one, or stays. */
void quantity_excess(const struct quantity *quantity, const struct bed *bed, const double *temperature,
                     struct table_excess *excess);

/* The same of one table, for temperatures [n]. NaN: not known. */
void curve_excess(const struct curve *curve, uint32_t n, const double *temperature, struct table_excess *excess);

/* Frees the tables of a quantity. */
void quantity_free(struct quantity *quantity);

/* Whether a quantity has tables. */
bool quantity_curves(const struct quantity *quantity);

/* Sets values[i] to that of the table of sphere i at temperature[i]. Spheres without a table or a temperature (NaN)
 * keep their value. */
void quantity_follow(const struct quantity *quantity, const struct bed *bed, const double *temperature, double *values);

/* Finds the values of all spheres, *values [n]. Free *values also after an error. `offset` is added to each value. A
 * value is NaN if the option was not given or, with quantity->some, if it is missing. A table gives one of its values.
 * file, what: names of bed and quantity in messages. Status 0, STATUS_MEMORY, or STATUS_INPUT naming the line of a
 * sphere whose value is not within low and high. */
int quantity_values(const struct quantity *quantity, const struct bed *bed, const char *file, const char *what,
                    double offset, double low, double high, double **values);

/* A list such as zmin=1200,300: values with names of walls, and a number without a name for all other walls. */
struct wall_list {
    bool named[WALLS_MAX];
    double value[WALLS_MAX]; /* if named */
    double others;           /* the number without a name; NaN: none */
};

/* Tables in such a list: NAME=@TABLE over time, and NAME=triangles:FILE, a column of numbers, one per triangle. n = 0:
 * the wall has no table. Set `axes` and `timed` and zero the others; free with wall_tables_free. */
struct wall_tables {
    const struct curve_axes *axes; /* of temperatures over time */
    bool timed;                    /* tables over time are allowed */
    struct curve curve[WALLS_MAX], column[WALLS_MAX];
};
void wall_tables_free(struct wall_tables *tables);

/* Reads such a list of values from low to high. word: a word that is allowed as a value and gives INFINITY; NULL: none.
 * text NULL: no list. tables NULL: tables are not allowed. The value of a wall with a table is that at time 0. With a
 * column it is the first number. Status 0, STATUS_USAGE if there is no wall of a name, or as curve_read. */
int wall_list(const char *option, const char *text, const char *word, double low, double high,
              const struct walls *walls, struct wall_tables *tables, struct wall_list *list);

/* Report a quantity of spheres, if it was given, and values of walls. The key of a wall is wall_NAME with the ending.
 */
void quantity_report(const struct quantity *quantity, const char *key, struct report *report);
void wall_values_report(const struct walls *walls, const double *values, const char *ending, int digits,
                        struct report *report);

/* Reads such a list of values from 0 to 1. A wall without a value has that of `otherwise`. Status 0 or STATUS_USAGE. */
int wall_fractions(const char *option, const char *text, const struct walls *walls, const double otherwise[WALLS_MAX],
                   double values[WALLS_MAX]);

/* The same for --wall-emissivity. text NULL: all walls are black. */
int wall_emissivities(const char *text, const struct walls *walls, double emissivity[WALLS_MAX]);

#endif
