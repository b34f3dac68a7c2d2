/* output.h - files that get their names when they are complete. SPDX-License-Identifier: MIT */
#ifndef OUTPUT_H
#define OUTPUT_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/* An output. A regular file gets its name when it is complete. Standard output, pipes and devices are written at once.
 */
struct output {
    const char *path;
    char *target;    /* the path without symbolic links */
    char *temporary; /* temporary name in the folder of the target; NULL: written at once */
    bool unnamed;    /* the file has no name yet, not even a temporary one; some systems have no such files */
    FILE *file;      /* NULL: not open */
};

/* Whether two paths name one file, which may not exist yet. "-" names no file. */
bool output_same(const char *a, const char *b);

/* Whether a path has this ending, such as ".csv", with something before the ending. path NULL: false. */
bool output_ends(const char *path, const char *ending);

/* Whether a path names standard output: "-", /dev/stdout, or the file to which standard output is redirected. */
bool output_stdout(const char *path);

/* Protects a file that this run reads: from now on no output may replace the file. Call it before reading. Status 0,
 * STATUS_USAGE if an open output would replace the file, or STATUS_MEMORY. */
int output_spare(const char *path);

/* The path of a frame: a * in the pattern becomes its number. Status 0, or STATUS_USAGE if the path is too long. */
enum { OUTPUT_PATH = 4096 };
int output_numbered(const char *pattern, int64_t frame, char path[OUTPUT_PATH]);

/* Opens a new file without a name or with a temporary name. path NULL: opens nothing. If the path is a symbolic link,
 * the link stays and its target is written. An existing file keeps its permissions. Status 0, STATUS_FILE,
 * STATUS_MEMORY, or STATUS_USAGE if this run reads the file. */
int output_open(struct output *output, const char *path);

/* Flushes the file. Status 0, or STATUS_FILE if something could not be written. */
int output_flush(const struct output *output);

/* Closes the file. `status` is that of the work so far. If neither the work nor closing has an error, the file gets its
 * name. Otherwise the file is removed. Does nothing if the file is not open. Returns status, or STATUS_FILE. */
int output_close(struct output *output, int status);

#endif
