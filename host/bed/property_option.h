/* property_option.h - radii, emissivities and temperatures of spheres and walls, from options and columns of the file.
 * SPDX-License-Identifier: MIT */
#ifndef PROPERTY_OPTION_H
#define PROPERTY_OPTION_H

#include "bed/wall_option.h"
#include "text/report.h"
#include "text/read_curve.h"

/* Largest temperature [K]. */
#define TEMPERATURE_MAX 1e9

/* Rows of tables of options, without braces. */
#define OPTION_EMISSIVITY(request, field)                                                                              \
    0, "emissivity", "E", "emissivity of all spheres, 0 to 1; or TYPE:E,..., or a column of the file",                 \
        TO_FUNCTION(emissivity_option, request, field)
#define OPTION_EMISSIVITY_CURVES(request, field)                                                                       \
    0, "emissivity", "E",                                                                                              \
        "emissivity of all spheres, 0 to 1; or TYPE:E,..., or a column of the file; @TABLE of temperatures [K] and "   \
        "emissivities may stand for a number",                                                                         \
        TO_FUNCTION(emissivity_curves_option, request, field)
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

/* Which item of the list is that of sphere i, and of quantity->curve. 0 if values are not by type. */
int quantity_item(const struct quantity *quantity, const struct bed *bed, uint32_t i);

/* Sets values[i] to that of the table of sphere i at temperature[i]. Spheres without a table or a temperature (NaN)
 * keep their value. */
void quantity_follow(const struct quantity *quantity, const struct bed *bed, const double *temperature, double *values);

/* Finds the values of all spheres, *values [n]. Free *values also after an error. `offset` is added to each value. A
 * value is NaN if the option was not given or, with quantity->some, if it is missing. A table gives one of its values.
 * file, what: names of bed and quantity in messages. Status 0, STATUS_MEMORY, or STATUS_INPUT naming the line of a
 * sphere whose value is not within low and high. */
int quantity_values(const struct quantity *quantity, const struct bed *bed, const char *file, const char *what,
                    double offset, double low, double high, double **values);

/* Report a quantity of spheres, if it was given, and values of walls. The key of a wall is wall_NAME with the ending.
 */
void quantity_report(const struct quantity *quantity, const char *key, struct report *report);
void wall_values_report(const struct walls *walls, const double *values, const char *ending, int digits,
                        struct report *report);

#endif
