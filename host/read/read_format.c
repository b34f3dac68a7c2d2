/* read_format.c - functions for the readers of all formats. SPDX-License-Identifier: MIT */
#include "read/read_format.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *source_begin(const struct source *source, size_t *size) {
    *size = source->lines.end - source->lines.next;
    return source->lines.buffer + source->lines.next;
}

bool source_begins(const struct source *source, const char *text) {
    size_t size;
    const char *begin = source_begin(source, &size);
    return size >= strlen(text) && memcmp(begin, text, strlen(text)) == 0;
}

char *source_word(const struct source *source, char *to, size_t room) {
    static const char blanks[] = " \t\r\v\f";
    const char *text = source->lines.text + strspn(source->lines.text, blanks);
    size_t length = strlen(text);
    while (length > 0 && strchr(blanks, text[length - 1])) --length;
    if (length > room - 1) length = room - 1;
    memcpy(to, text, length);
    to[length] = 0;
    return to;
}

int source_ends(const struct source *source, const char *lack) {
    return source_fail(source, "%s", source->lines.truncated ? "the gzip file is cut off" : lack);
}

void source_warn_open(struct source *source) {
    if (source->warned || source->options.periods_given) return;
    source->warned = true;
    message_at(STATUS_OK, source->lines.name, 0,
               "warning: the file does not say which axes are periodic; all are open unless --periodic says otherwise");
}

int source_columns(struct source *source, const char *names, struct bed *bed) {
    struct fields fields = {0};
    char *text = strdup(names);
    int status = text ? fields_split_blanks(&fields, text) : message_memory();
    if (!status) status = columns_find(source, &fields, NULL, bed);
    free(fields.at);
    free(text);
    return status;
}

int source_edges(const struct source *source, const char *what, const double edge[9], const double origin[3],
                 const bool periodic[3], struct bed *bed) {
    double longest = 0;
    for (int k = 0; k < 9; ++k) longest = fmax(longest, fabs(edge[k]));
    for (int k = 0; k < 9; ++k) {
        if (k % 4 == 0 || fabs(edge[k]) <= EDGE_TRACE * longest) continue;
        return source_fail(source, "%s; only boxes with right angles, whose edges lie along x, y and z, can be read",
                           what);
    }
    for (int axis = 0; axis < 3; ++axis) {
        const double length = edge[4 * axis];
        if (!(length > 0)) return source_fail(source, "the box is empty: its edges must be above 0");
        bed->low[axis] = origin[axis];
        bed->high[axis] = origin[axis] + length;
        bed->period[axis] = periodic[axis] ? length : 0;
    }
    return STATUS_OK;
}

int source_rows(struct source *source, int64_t rows, size_t more, struct bed *bed) {
    struct fields *fields = &source->fields;
    const size_t width = source->columns.width;
    for (int64_t k = 0; k < rows; ++k) {
        bool there;
        int status = lines_next(&source->lines, &there);
        if (!status && !there) return source_ends(source, "the file ends before the last of its spheres");
        if (!status) status = fields_split_blanks(fields, source->lines.text);
        if (fields->n > width && fields->n <= width + more) fields->n = width;
        if (!status) status = columns_add(source, bed);
        if (status) return status;
    }
    return STATUS_OK;
}

int source_skip(struct source *source, int64_t rows, const char *what, const char *stop) {
    source->found = FOUND_FRAME;
    for (int64_t k = 0; k < rows; ++k) {
        bool there;
        const int status = lines_next(&source->lines, &there);
        if (status) return status;
        const bool stopped = there && stop && strstr(source->lines.text, stop);
        if (there && !stopped) continue;
        source->found = FOUND_PART;
        snprintf(source->lack, LACK_MAX, "the frame ends after %" PRId64 " %s; %" PRId64 " were declared", k, what,
                 rows);
        return stopped ? source_fail(source, "%s", source->lack) : STATUS_OK;
    }
    return STATUS_OK;
}

void source_skip_end(struct source *source) {
    if (source->found != FOUND_FRAME || source->lines.ended) return;
    source->found = FOUND_PART;
    snprintf(source->lack, LACK_MAX, "the file ends within a line");
}

int source_count(const struct source *source, const char *text, int64_t *atoms) {
    const int status = lines_whole(&source->lines, "the number of atoms", text, atoms);
    if (!status && *atoms < 0) return source_fail(source, "the number of atoms is negative");
    return status;
}

int source_count_line(const struct source *source, int64_t *atoms) {
    char word[32];
    return source_count(source, source_word(source, word, sizeof word), atoms);
}
