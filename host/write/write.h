/* write.h - results to files: complete or not at all. SPDX-License-Identifier: MIT */
#ifndef WRITE_H
#define WRITE_H

#include <stdbool.h>
#include <stdio.h>

#include "bed/bed.h"
#include "bed/wall_option.h"
#include "compute/rows.h"

/* A file that gets its name only when it is complete. */
struct output {
    const char *path;
    char *temporary; /* in the same folder */
    FILE *file;      /* NULL: not open */
};

/* Whether two paths name one existing file, so that writing the one would replace the other. */
bool output_same(const char *a, const char *b);

/* Whether a path has this ending, such as ".csv", and something before it; NULL has none. */
bool output_ends(const char *path, const char *ending);

/* Opens a new file under a temporary name; path NULL: none, which output_close then leaves alone. Status 0, STATUS_FILE
 * or STATUS_MEMORY. */
int output_open(struct output *output, const char *path);

/* Closes the file and gives it its name; after any trouble on the way it is removed instead. `status` is that of what
 * was done so far. Does nothing if the file is not open. Returns status, or STATUS_FILE. */
int output_close(struct output *output, int status);

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
