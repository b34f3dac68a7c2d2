/* read.c - finds the format of a file and reads the wanted frames. SPDX-License-Identifier: MIT
 *
 * A frame is first skipped and kept in memory. This shows whether the frame is complete, and whether another frame
 * follows. Then the frame is read from memory. So pipes can be read, in which there is no way back. Errors within a
 * frame that is not wanted do not matter. */
#include "read/read.h"

#include <inttypes.h>
#include <stdlib.h>

#include "read/read_format.h"

struct reader {
    struct source source;
    const struct format *format;
    int64_t frame; /* number of the next frame in the file */
    bool found;    /* a wanted frame has been read */
    bool filled;   /* a wanted frame had spheres */
    bool done;     /* no frame follows that is wanted */
};

int reader_open(struct reader **reader, const char *path, const struct read_options *options) {
    static const struct format *const formats[] = {&format_dump,    &format_xyz,        &format_data,
                                                   &format_vtk,     &format_vtk_series, &format_vtk_xml,
                                                   &format_mercury, &format_table,      NULL};
    struct reader *r = *reader = calloc(1, sizeof *r);
    if (!r) return message_memory();
    r->source.options = *options;
    const int status = lines_open(&r->source.lines, path);
    if (status) return status;
    for (size_t k = 0; formats[k] && !r->format; ++k)
        if (formats[k]->is(&r->source)) r->format = formats[k];
    return r->format == &format_table ? source_foreign(&r->source) : STATUS_OK;
}

void reader_close(struct reader *reader) {
    if (!reader) return;
    lines_close(&reader->source.lines);
    free(reader->source.fields.at);
    columns_free(&reader->source.columns);
    free(reader);
}

static bool wants_last(const struct reader *r) { return r->source.options.frames.end == 0; }

static bool wants_frame(const struct reader *r) {
    const struct frames *frames = &r->source.options.frames;
    if (wants_last(r)) return true;
    return r->frame >= frames->begin && r->frame < frames->end &&
           (frames->step <= 1 || (r->frame - frames->begin) % frames->step == 0);
}

/* Whether only blank lines follow. If a gzip file was cut off, this is unknown: *end is false. */
static int at_end(struct lines *lines, bool *end) {
    bool more;
    const int status = lines_next_text(lines, &more);
    *end = !status && !more && !lines->truncated;
    if (!status && more) lines_hold(lines);
    return status;
}

/* Reports, at the end of the file, a missing or incomplete frame. An incomplete frame behind wanted ones is a warning.
 */
static int report_end_of_file(const struct reader *r) {
    const struct source *source = &r->source;
    const bool part = source->found == FOUND_PART || source->lines.truncated;
    const char *why = source->lines.truncated ? "the gzip file is cut off" : source->lack;
    if (part && r->found)
        return message_at(STATUS_OK, source->lines.name, 0, "warning: frame %" PRId64 " is left out: %s", r->frame,
                          why);
    if (part && r->frame > 0) return source_fail(source, "%s; the last whole frame is %" PRId64, why, r->frame - 1);
    if (part) return source_fail(source, "%s", why);
    if (r->found) return STATUS_OK;
    if (r->frame == 0) return message_at(STATUS_INPUT, source->lines.name, 0, "there is no frame in the file");
    return message_at(STATUS_INPUT, source->lines.name, 0, "there is no frame %" PRId64 "; the last is %" PRId64,
                      source->options.frames.begin, r->frame - 1);
}

/* Goes to the beginning of the next wanted frame. *more false: there is none. */
static int find_frame(struct reader *r, bool *more) {
    struct source *source = &r->source;
    for (*more = false; wants_last(r) || r->frame < source->options.frames.end; ++r->frame) {
        bool end = true;
        const bool wanted = wants_frame(r);
        if (wanted) lines_keep(&source->lines);
        int status = r->format->skip(source);
        if (!status && source->found != FOUND_FRAME) return report_end_of_file(r);
        if (!status && wants_last(r)) status = at_end(&source->lines, &end);
        if (status) return status;
        if (wanted && end) {
            lines_return(&source->lines);
            lines_drop(&source->lines);
            *more = true;
            return STATUS_OK;
        }
    }
    return STATUS_OK;
}

/* Finds the frame of a format whose files have one frame. */
static int find_only(struct reader *r, bool *more) {
    *more = r->frame == 0 && wants_frame(r);
    r->frame += !*more && r->frame == 0;
    r->source.found = FOUND_END;
    return *more || r->found ? STATUS_OK : report_end_of_file(r);
}

static int read_frame(struct reader *r, struct bed *bed) {
    struct source *source = &r->source;
    bed_clear(bed);
    bed->extras = source->options.extras;
    bed->frame = r->frame++;
    r->found = true;
    int status = r->format->read(source, bed);
    if (!status && !r->format->skip && source->lines.truncated) status = source_ends(source, "");
    return status ? status : bed_sort(bed, source->lines.name);
}

int reader_next(struct reader *r, struct bed *bed, bool *more) {
    const char *name = r->source.lines.name;
    for (*more = false; !r->done; *more = false) {
        int status = r->format->skip ? find_frame(r, more) : find_only(r, more);
        r->done = !*more || wants_last(r);
        if (!status && *more) status = read_frame(r, bed);
        if (status) return status;
        if (*more && bed->n > 0) {
            r->filled = true;
            return STATUS_OK;
        }
        if (r->done && !r->filled && !r->source.options.series)
            return message_at(STATUS_INPUT, name, 0,
                              r->source.options.rules > 0 ? "--only and --skip leave no spheres of the file"
                                                          : "there are no spheres in the file");
        if (*more) message_at(STATUS_OK, name, 0, "warning: frame %" PRId64 " is empty and is left out", bed->frame);
    }
    return STATUS_OK;
}

int read_bed(const char *path, const struct read_options *options, struct bed *bed) {
    struct reader *reader;
    bool more;
    *bed = bed_empty();
    int status = reader_open(&reader, path, options);
    if (!status) status = reader_next(reader, bed, &more);
    reader_close(reader);
    return status;
}
