/* read_mercury.c - beds from the .data files of MercuryDPM. SPDX-License-Identifier: MIT
 *
 * A frame is a line `N time xmin ymin zmin xmax ymax zmax` and N lines of 14 numbers. In two dimensions these lines
 * have 6 and 8 numbers. There are no ids. The file does not say which axes are periodic. */
#include <stdio.h>
#include <string.h>

#include "read/read_format.h"
#include "text/read_number.h"

/* How many numbers a line has, and the first of them. -1: it has something else, or 100 numbers or more. */
static int numbers_of(const char *text, const char *end, double *first) {
    char line[2000], *word, *rest = line;
    double value;
    int n = 0;
    const size_t size = (size_t)(end - text);
    if (size >= sizeof line) return -1;
    memcpy(line, text, size);
    line[size] = 0;
    while ((word = strtok_r(rest, " \t\r", &rest))) {
        if (++n == 100 || !number_read(word, &value)) return -1;
        if (n == 1) *first = value;
    }
    return n;
}

/* Whether the first lines have as many numbers as in such files. Frames without spheres may come first. They are lines
 * alone. */
static bool is_mercury(const struct source *source) {
    size_t size;
    const char *text = source_begin(source, &size), *last = text + size, *end;
    int head = 0;
    for (double spheres = 0, first; (end = memchr(text, '\n', (size_t)(last - text))); text = end + 1) {
        const int numbers = numbers_of(text, end, &first);
        if (head > 0 && spheres > 0) return numbers == (head == 8 ? 14 : 8);
        if (numbers != 8 && numbers != 6 && !(head > 0 && numbers == 0)) return false;
        if (numbers > 0) head = numbers, spheres = first;
    }
    return head > 0;
}

/* Reads the line that begins a frame: number of spheres, time and box. */
static int mercury_head(struct source *source, double head[8]) {
    static const char *const names[] = {
        "the number of atoms", "the time", "xmin", "ymin", "zmin", "xmax", "ymax", "zmax"};
    int status = fields_split_blanks(&source->fields, source->lines.text);
    if (!status && source->fields.n == 6)
        return source_fail(source, "a MercuryDPM file in two dimensions: these are discs");
    if (!status && source->fields.n != 8)
        return source_fail(source, "a line `N time xmin ymin zmin xmax ymax zmax` is expected");
    for (int k = 0; k < 8 && !status; ++k)
        status = lines_number(&source->lines, names[k], source->fields.at[k], &head[k]);
    return status;
}

/* Reads the number of spheres of the next frame. Blank lines are skipped. */
static int mercury_count(struct source *source, int64_t *spheres, bool *more) {
    char word[32] = "";
    const int status = lines_next_text(&source->lines, more);
    if (status || !*more) return status;
    sscanf(source->lines.text, "%31s", word);
    return source_count(source, word, spheres);
}

static int skip_mercury(struct source *source) {
    bool more;
    int64_t spheres;
    source->found = FOUND_END;
    int status = mercury_count(source, &spheres, &more);
    if (status || !more) return status;
    status = source_skip(source, spheres, "spheres", NULL);
    source_skip_end(source);
    return status;
}

static int read_mercury(struct source *source, struct bed *bed) {
    bool more;
    int64_t spheres = 0;
    double head[8] = {0};
    int status = mercury_count(source, &spheres, &more);
    if (!status) status = mercury_head(source, head);
    if (spheres == 0) return status;
    for (int axis = 0; axis < 3 && !status; ++axis) {
        bed->low[axis] = head[2 + axis];
        bed->high[axis] = head[5 + axis];
        if (!(bed->low[axis] < bed->high[axis])) status = source_fail(source, "the box is empty");
    }
    if (!status) status = source_columns(source, "x y z vx vy vz r a b c wx wy wz info", bed);
    if (!status) status = source_rows(source, spheres, 0, bed);
    if (!status) source_warn_open(source);
    return status;
}

const struct format format_mercury = {is_mercury, skip_mercury, read_mercury};
