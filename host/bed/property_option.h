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

/* The hottest there may be [K]. */
#define TEMPERATURE_MAX 1e9

/* Rows of tables of options, without braces. */
#define OPTION_EMISSIVITY                                                                                              \
    KEY_EMISSIVITY, "emissivity", "E", "emissivity of all spheres, 0 to 1, or TYPE:E,..., or a column of the file"
#define OPTION_EMISSIVITY_CURVES                                                                                       \
    KEY_EMISSIVITY, "emissivity", "E",                                                                                 \
        "emissivity of all spheres, 0 to 1, or @TABLE of temperatures [K] and emissivities, or "                       \
        "TYPE:E,TYPE:@TABLE,..., "                                                                                     \
        "or a column of the file"
#define OPTION_WALL_EMISSIVITY                                                                                         \
    KEY_WALL_EMISSIVITY, "wall-emissivity", "LIST",                                                                    \
        "emissivities of walls, 0 to 1, zmin=0.3,0.9 for example; a number without a name is for all others [1]"

/* What an option says of the spheres: a number for all of them, numbers by type, or the name of a column. */
enum { QUANTITY_TYPES_MAX = 64 };
struct quantity {
    bool given;
    bool some; /* spheres may have none: NaN */
    double value;
    const char *column;                                           /* NULL: value */
    size_t place;                                                 /* of the column in bed->extra */
    int types;                                                    /* not 0: the column is that of types, from 1 on, */
    double type[QUANTITY_TYPES_MAX], of_type[QUANTITY_TYPES_MAX]; /* [types] and these are the values of these */
    bool curves;                                                  /* @TABLE may stand for a value, */
    struct curve curve[QUANTITY_TYPES_MAX];                       /* by type, [0] without types; n = 0: a number */
};

/* Takes the argument of an option whose values are in [low, high]. Status 0, STATUS_USAGE, or as curve_read. */
int quantity_option(const char *what, const char *text, double low, double high, struct quantity *quantity);
int emissivity_option(const char *text, struct quantity *quantity); /* of --emissivity, with tables */

/* Frees its tables. */
void quantity_free(struct quantity *quantity);

/* The table that the value of sphere i comes from; NULL: it is a number. */
const struct curve *quantity_curve(const struct quantity *quantity, const struct bed *bed, uint32_t i);

/* Whether there are any. */
bool quantity_curves(const struct quantity *quantity);

/* The values of all spheres [n], to be freed also after an error; `file` is the bed's name and `what` that of the
 * quantity in messages. offset is added. Status 0, STATUS_INPUT naming the line of one that is not in [low, high], or
 * STATUS_MEMORY. Without the option, and where quantity->some: NaN;
 * from tables: one of their values. */
int quantity_values(const struct quantity *quantity, const struct bed *bed, const char *file, const char *what,
                    double offset, double low, double high, double **values);

/* A list such as zmin=1200,300: values by name, a bare number for all others. */
struct wall_list {
    bool named[WALLS_MAX];
    double value[WALLS_MAX]; /* of those named */
    double others;           /* NaN: there is no bare number */
};

/* What may stand for values: NAME=@TABLE of time, where `timed`, and NAME=triangles:FILE, a column of numbers. Zeroed
 * else; to be freed by wall_tables_free. n = 0: a number. */
struct wall_tables {
    bool timed;
    struct curve curve[WALLS_MAX], column[WALLS_MAX];
};
void wall_tables_free(struct wall_tables *tables);

/* Takes such a list of values in [low, high], or the word (NULL: none), which is INFINITY. text NULL: no list; tables
 * NULL: none may be. The value of a table is that at 0, that of a column its first one. Status 0, STATUS_USAGE naming
 * the wall that is not there, or as curve_read. */
int wall_list(const char *option, const char *text, const char *word, double low, double high,
              const struct walls *walls, struct wall_tables *tables, struct wall_list *list);

/* Reports a quantity of spheres if it was given: its number, its types' numbers or its column; values of walls, each
 * under the key wall_NAME and this ending. */
void quantity_report(const struct quantity *quantity, const char *key, struct report *report);
void wall_values_report(const struct walls *walls, const double *values, const char *ending, int digits,
                        struct report *report);

/* Emissivities of walls; text NULL: black. */
int wall_emissivities(const char *text, const struct walls *walls, double emissivity[WALLS_MAX]);

#endif
