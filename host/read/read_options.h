/* read_options.h - what is wanted of a file. SPDX-License-Identifier: MIT */
#ifndef READ_OPTIONS_H
#define READ_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Which frames of a file are wanted, counted from 0: begin, begin + step ... below end. Zeroed: the last one alone. */
struct frames {
    int64_t begin, end, step;
};

struct read_options {
    struct frames frames;
    bool positions;           /* ids are left alone: spheres stand in the order of the file */
    bool periods_given;       /* besides the file, which need not say them */
    bool no_radius;           /* no radius is looked for; bed->r is NaN */
    bool part;                /* of a series of files: one without spheres is left out with a warning */
    const char *const *extra; /* [extras] names of further columns wanted, numbers all */
    const char *const *unit;  /* [extras] the unit they are taken to have, such as "K", NULL for none; a name with
                                 another one is refused. NULL: none has any */
    const bool *some;         /* [extras] a blank or nan is a value that is missing, NaN; NULL: none may be */
    size_t extras;
    bool keep;     /* all other columns stay as text: bed->kept */
    bool any_unit; /* a column asked for with its unit, `T [C]`, may have any */
};

#endif
