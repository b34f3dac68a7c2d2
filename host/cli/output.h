/* output.h - files that get their names when they are complete. SPDX-License-Identifier: MIT */
#ifndef OUTPUT_H
#define OUTPUT_H

#include <stdbool.h>
#include <stdio.h>

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

#endif
