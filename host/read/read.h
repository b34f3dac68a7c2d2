/* read.h - beds from CSV, LAMMPS and LIGGGHTS text dumps, and YADE text. SPDX-License-Identifier: MIT */
#ifndef READ_H
#define READ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "bed/bed.h"
#include "read/read_lines.h"

struct read_options {
    int64_t frame;            /* which frame of a dump, from 0; -1: the last */
    bool ids;                 /* the column id is wanted */
    const char *const *extra; /* [extras] names of further columns wanted, numbers all */
    size_t extras;
};

/* Reads a bed from a file or, for "-", from standard input; what is in it tells the format. Memory stays within a small
 * multiple of the file. Free the bed also after an error.
 * Status 0, STATUS_INPUT naming the line, STATUS_FILE, STATUS_MEMORY or that of a signal. */
int read_bed(const char *path, const struct read_options *options, struct bed *bed);

/* The readers by format; the first line is held. */
int read_csv(struct lines *lines, const struct read_options *options, struct bed *bed);
int read_dump(struct lines *lines, const struct read_options *options, struct bed *bed);
int read_yade(struct lines *lines, const struct read_options *options, struct bed *bed);

#endif
