/* read.h - beds from files of all formats, frame by frame. SPDX-License-Identifier: MIT */
#ifndef READ_H
#define READ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "bed/bed.h"
#include "read/read_options.h"
#include "text/read_lines.h"

/* A file that is read frame by frame. */
struct reader;

/* Opens a file or, for "-", standard input; what is in it tells the format. Close it also after an error. Status 0,
 * STATUS_INPUT, STATUS_FILE or STATUS_MEMORY. */
int reader_open(struct reader **reader, const char *path, const struct read_options *options);

/* Reads the next frame that is wanted into a bed, whose former contents are lost; spheres with ids come in their order.
 * *more false: there are no further ones. A frame at which the file ends is an error, behind others that were wanted a
 * warning, and so are frames without spheres. Memory stays within a small multiple of a frame. Status 0, STATUS_INPUT
 * naming the line, STATUS_FILE, STATUS_MEMORY or that of a signal. */
int reader_next(struct reader *reader, struct bed *bed, bool *more);

/* Closes it. NULL: nothing. */
void reader_close(struct reader *reader);

/* Reads the first frame wanted. Free the bed also after an error. Status as reader_next. */
int read_bed(const char *path, const struct read_options *options, struct bed *bed);

#endif
