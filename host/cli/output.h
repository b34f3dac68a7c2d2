/* output.h - files that get their names when they are complete. SPDX-License-Identifier: MIT */
#ifndef OUTPUT_H
#define OUTPUT_H

#include <stdbool.h>
#include <stdio.h>

/* A file that gets its name only when it is complete; or standard output, a pipe or a device, written to at once. */
struct output {
    const char *path;
    char *target;    /* where the path leads to by symbolic links */
    char *temporary; /* in the target's folder; NULL: written at once */
    bool unnamed;    /* it has no name yet: where the system has such files, they get one when they are complete */
    FILE *file;      /* NULL: not open */
};

/* Whether two paths name one file, there or yet to be made, so that writing the one would replace the other; "-" names
 * none. */
bool output_same(const char *a, const char *b);

/* Whether a path has this ending, such as ".csv", and something before it; NULL has none. */
bool output_ends(const char *path, const char *ending);

/* Whether a path is standard output: "-", or another name of it such as /dev/stdout. */
bool output_stdout(const char *path);

/* Says that this run reads a file: from now on no output may replace it. What reads a file calls this first. Status 0,
 * STATUS_USAGE if an output that is open would replace it, or STATUS_MEMORY. */
int output_spare(const char *path);

/* Opens a new file without a name, or under a temporary one; path NULL: none, which output_close then leaves alone. A
 * symbolic link stays, its target is written, which keeps its permissions. Status 0, STATUS_FILE, STATUS_MEMORY, or
 * STATUS_USAGE if the file is one that this run reads. */
int output_open(struct output *output, const char *path);

/* Whether all that was written so far has arrived. Status 0 or STATUS_FILE. */
int output_flush(const struct output *output);

/* Closes the file and gives it its name; after any trouble on the way it is removed instead. `status` is that of what
 * was done so far. Does nothing if the file is not open. Returns status, or STATUS_FILE. */
int output_close(struct output *output, int status);

#endif
