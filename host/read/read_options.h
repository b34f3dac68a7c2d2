/* read_options.h - which frames and columns of a file are read. SPDX-License-Identifier: MIT */
#ifndef READ_OPTIONS_H
#define READ_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Frames that are read, counted from 0: begin, begin + step ... below end. Zeroed: the last frame only. */
struct frames {
    int64_t begin, end, step;
};

/* A column that the file calls otherwise. */
struct column_name {
    const char *known; /* x, r, id, T ...: what the program or an option calls it */
    const char *name;  /* what the file calls it; a unit may stand behind it, as in headers: p_x [mm] */
};

/* Which rows are read: those whose column has the value, or all others. Numbers need not have the same digits. */
struct row_rule {
    const char *column, *value;
    bool skip; /* rows with the value are left out */
};

struct read_options {
    struct frames frames;
    bool positions;           /* ids are not used: spheres are in the order of the file */
    bool periods_given;       /* periods come from --periodic: no warning if the file names none */
    bool no_radius;           /* radii are not read; bed->r is NaN */
    bool series;              /* one of a series of files: a file without spheres is no error */
    const char *const *extra; /* [extras] names of further columns, all of numbers */
    const char *const *unit; /* [extras] expected units, such as "K" or "W", UNIT_OF_LENGTH, or NULL for none. Values of
                              * a column in kW become W. A column whose header names a unit of another kind is refused.
                              * NULL: no column has one */
    const bool
        *some; /* [extras] blank or nan means a missing value, NaN, and values may be infinite; NULL: in no column */
    size_t extras;
    const struct column_name *name; /* [names] the file must have all of these */
    size_t names;
    const struct row_rule *rule; /* [rules] rows must follow all of them */
    size_t rules;
    bool keep;     /* other columns are kept as text: bed->kept */
    bool any_unit; /* further columns may have any unit; values stay as they are */
};

/* Expected unit of a further column of lengths: that of the coordinates. */
#define UNIT_OF_LENGTH "L"

/* The element of read_options.name for a column of the program. NULL: there is none. any_case: x may be called X. */
const struct column_name *read_options_name(const struct read_options *options, const char *known, bool any_case);

/* The name of further column k or, from `extras` on, of the column of a rule. */
const char *read_options_wanted(const struct read_options *options, size_t k);

#endif
