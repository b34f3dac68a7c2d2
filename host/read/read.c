/* read.c - finds out the format of a file and reads it. SPDX-License-Identifier: MIT */
#include "read/read.h"

#include <inttypes.h>
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

int read_bed(const char *path, const struct read_options *options, struct bed *bed) {
    struct lines lines;
    bed_init(bed, options->ids, options->extras);
    int status = lines_open(&lines, path);
    if (status) return status;
    int (*reader)(struct lines *, const struct read_options *, struct bed *);
    status = find_format(&lines, &reader);
    if (!status && !reader) status = message_at(STATUS_INPUT, lines.name, 0, "there are no spheres in it");
    if (!status && reader != read_dump && options->frame > 0)
        status = message_at(STATUS_INPUT, lines.name, 0, "there is no frame %" PRId64 ": this format holds one",
                            options->frame);
    if (!status) status = reader(&lines, options, bed);
    if (!status && bed->n == 0) status = message_at(STATUS_INPUT, lines.name, 0, "there are no spheres in it");
    lines_close(&lines);
    return status;
}
