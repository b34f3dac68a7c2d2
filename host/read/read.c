/* read.c - finds out the format of a file and reads it. SPDX-License-Identifier: MIT */
#include "read/read.h"

#include <stdlib.h>
#include <string.h>

#include "cli/message.h"

static bool begins(const char *text, const char *with) { return strncmp(text, with, strlen(with)) == 0; }

/* Holds the first line that tells the format and returns the reader; NULL at the end of the file. */
static int find_format(struct lines *lines, int (**reader)(struct lines *, const struct read_options *, struct bed *)) {
    bool more;
    int status;
    *reader = NULL;
    while ((status = lines_next(lines, &more)) == STATUS_OK && more) {
        if (lines->number == 1 && begins(lines->text, "\x1f\x8b"))
            return message_at(STATUS_INPUT, lines->name, 0, "compressed; try: zcat FILE | fibrad bed -");
        if (begins(lines->text, "ITEM:"))
            *reader = read_dump;
        else if (begins(lines->text, "#format"))
            *reader = read_yade;
        else if (*lines->text != '#' && !lines_blank(lines))
            *reader = read_csv;
        if (*reader) {
            lines_hold(lines);
            return STATUS_OK;
        }
    }
    return status;
}

struct reader {
    struct lines lines;
    struct read_options options;
    int (*read)(struct lines *, const struct read_options *, struct bed *);
    bool done;
};

int reader_open(struct reader **reader, const char *path, const struct read_options *options) {
    struct reader *r = *reader = calloc(1, sizeof *r);
    if (!r) return message_memory();
    r->options = *options;
    int status = lines_open(&r->lines, path);
    if (!status) status = find_format(&r->lines, &r->read);
    if (!status && !r->read) status = message_at(STATUS_INPUT, r->lines.name, 0, "there are no spheres in it");
    return status;
}

int reader_next(struct reader *r, struct bed *bed, bool *more) {
    *more = !r->done;
    if (r->done) return STATUS_OK;
    r->done = true;
    bed_clear(bed);
    bed->extras = r->options.extras;
    int status = r->read(&r->lines, &r->options, bed);
    if (!status && bed->n == 0) status = message_at(STATUS_INPUT, r->lines.name, 0, "there are no spheres in it");
    return status ? status : bed_sort(bed, r->lines.name);
}

void reader_close(struct reader *reader) {
    if (!reader) return;
    lines_close(&reader->lines);
    free(reader);
}

int read_bed(const char *path, const struct read_options *options, struct bed *bed) {
    struct reader *reader;
    bool more = true;
    bed_init(bed);
    int status = reader_open(&reader, path, options);
    if (!status) status = reader_next(reader, bed, &more);
    if (!status && !more) status = message_at(STATUS_INPUT, path, 0, "there is no such frame");
    reader_close(reader);
    return status;
}
