/* read.h - beds from files of all formats, frame by frame. SPDX-License-Identifier: MIT */
#ifndef READ_H
#define READ_H

#include "bed/bed.h"
#include "read/read_options.h"
#include "text/read_lines.h"

/* A file that is read frame by frame. */
struct reader;

/* Opens a file or, for "-", standard input. Finds the format by the contents. Close the reader also after an error.
 * Status 0, STATUS_INPUT, STATUS_FILE or STATUS_MEMORY. */
int reader_open(struct reader **reader, const char *path, const struct read_options *options);

/* Reads the next wanted frame into a bed, which is cleared before. Spheres with ids are sorted by id. *more false:
 * there are no more frames. An incomplete last frame is an error, or a warning if a wanted frame came before. Frames
 * without spheres are left out with a warning. Memory stays within a small multiple of a frame. Status 0, STATUS_INPUT
 * naming the line, STATUS_FILE, STATUS_MEMORY or that of a signal. */
int reader_next(struct reader *reader, struct bed *bed, bool *more);

/* Closes a reader. NULL is allowed. */
void reader_close(struct reader *reader);

/* Reads the first wanted frame of a file. Free the bed also after an error. Status as reader_next. */
int read_bed(const char *path, const struct read_options *options, struct bed *bed);

#endif
