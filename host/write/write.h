/* write.h - matrices to files. SPDX-License-Identifier: MIT */
#ifndef WRITE_H
#define WRITE_H

#include <stdbool.h>
#include <stdio.h>

#include "bed/bed.h"
#include "bed/wall_option.h"
#include "compute/rows.h"

/* What is written. */
struct contents {
    const struct bed *bed;
    const struct result *result;
    bool ids;                         /* the file's ids instead of positions */
    const struct wall_order *walls;   /* NULL: neither walls nor surroundings are written; none in it: no walls, and
                                         surroundings only with exchange factors */
    const fibrad_exchange_rule *grey; /* NULL: view factors; else exchange factors by this rule */
};

/* Writes to the file; a failing file is noticed by the caller. Status 0 or that of a signal. */
typedef int write_function(FILE *file, const struct contents *what);

write_function write_csv, write_mtx, write_npz, write_vtp;

/* The writer for the ending of a path, NULL if there is none or no path. `endings`, unless NULL, gets the list of those
 * known. */
write_function *write_find(const char *path, const char **endings);

#endif
