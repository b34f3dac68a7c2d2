/* column_option.h - options about the columns of a file: --columns, --only, --skip. SPDX-License-Identifier: MIT */
#ifndef COLUMN_OPTION_H
#define COLUMN_OPTION_H

#include "cli/options.h"
#include "read/read_options.h"

/* Arguments of the options. Begin with zeroes; free with column_options_free. */
struct column_options {
    struct column_name *name; /* [names] */
    struct row_rule *rule;    /* [rules] */
    size_t names, rules;
    char **text; /* [texts] what `name` and `rule` point into */
    size_t texts;
};

/* A row of a table of options, without braces, and rows with them. */
#define OPTION_COLUMNS(request, columns)                                                                               \
    0, "columns", "LIST",                                                                                              \
        "names of columns that the file calls otherwise, x=p_x,d=diameters; NAME [UNIT] says its "                     \
        "unit; numbers from 1, x=1,y=2,z=3,r=4, if the file has no header",                                            \
        TO_FUNCTION(columns_option, request, columns)
#define OPTIONS_ROWS(request, columns)                                                                                 \
    {0, "only", "COLUMN=VALUE", "read only rows with this value, a text or a number; several must all hold",           \
     TO_FUNCTION(only_option, request, columns)},                                                                      \
    {                                                                                                                  \
        0, "skip", "COLUMN=VALUE", "leave out rows with this value; may be given several times",                       \
            TO_FUNCTION(skip_option, request, columns)                                                                 \
    }

/* Take the arguments into a struct column_options. Status 0, STATUS_USAGE or STATUS_MEMORY. */
option_take columns_option, only_option, skip_option;

/* Refuses a column of radii beside --radius. Status 0 or STATUS_USAGE. */
int columns_check(const struct column_options *options);

void column_options_free(struct column_options *options);

#endif
