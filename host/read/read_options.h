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

struct read_options {
    struct frames frames;
    bool positions;           /* ids are not used: spheres are in the order of the file */
    bool periods_given;       /* periods come from --periodic: no warning if the file names none */
    bool no_radius;           /* radii are not read; bed->r is NaN */
    bool series;              /* one of a series of files: a file without spheres is no error */
    const char *const *extra; /* [extras] names of further columns, all of numbers */
    const char *const *unit;  /* [extras] expected units, such as "K", or NULL for none; a column whose header names
                               * another unit is refused. NULL: no column has one */
    const bool *some;         /* [extras] blank or nan means a missing value, NaN; NULL: no value may be missing */
    size_t extras;
    bool keep;     /* other columns are kept as text: bed->kept */
    bool any_unit; /* a column that is asked for with its unit, `T [C]`, may have any unit */
};

#endif
