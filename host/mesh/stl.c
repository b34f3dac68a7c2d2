/* stl.c - triangles of an STL file, text or binary, which may be packed by gzip. SPDX-License-Identifier: MIT
 *
 * A binary file has 80 bytes, the number of triangles, and 50 bytes per triangle: normal, corners, two bytes without
 * meaning. Its first bytes may be "solid", as in a text file. So the length of the file decides. */
#include "mesh/stl.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "cli/memory.h"
#include "fibrad_mesh.h"
#include "text/read_lines.h"

enum { HEAD = 84, RECORD = 50, NORMAL = 12 };

const char *stl_place(bool text, uint64_t place, char to[STL_PLACE]) {
    snprintf(to, STL_PLACE, "%s %llu", text ? "line" : "triangle", (unsigned long long)place);
    return to;
}

void stl_free(struct stl *stl) {
    free(stl->corner);
    free(stl->place);
    free(stl->solid);
    free(stl->name);
    *stl = (struct stl){0};
}

/* Adds a triangle to the last solid. The caller fills in its corners. */
static int add_triangle(struct stl *stl, const char *file, uint64_t place) {
    if (stl->n == FIBRAD_TRIANGLES_MAX)
        return message_at(STATUS_INPUT, file, 0, "more than %u triangles", FIBRAD_TRIANGLES_MAX);
    bool good = true;
    stl->corner = memory_grown(stl->corner, stl->n, sizeof *stl->corner, &good);
    stl->place = memory_grown(stl->place, stl->n, sizeof *stl->place, &good);
    stl->solid = memory_grown(stl->solid, stl->n, sizeof *stl->solid, &good);
    if (!good) return message_memory();
    stl->place[stl->n] = place;
    stl->solid[stl->n++] = stl->solids - 1;
    return STATUS_OK;
}

static int add_solid(struct stl *stl, const char *name) {
    bool good = true;
    stl->name = memory_grown(stl->name, stl->solids, sizeof *stl->name, &good);
    if (!good) return message_memory();
    snprintf(stl->name[stl->solids++], SOLID_NAME, "%.*s", SOLID_NAME - 1, name);
    return STATUS_OK;
}

/* ---- binary ----------------------------------------------------------------------------------------------------- */

/* A number of four bytes, the lowest first. */
static uint32_t word_of(const char *bytes) {
    const unsigned char *b = (const unsigned char *)bytes;
    return b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

static int read_records(struct stl *stl, const char *file, const char *bytes, uint32_t count) {
    int status = add_solid(stl, "");
    for (uint32_t t = 0; t < count && !status; ++t) {
        status = add_triangle(stl, file, t);
        const char *record = bytes + HEAD + (size_t)t * RECORD + NORMAL;
        for (int k = 0; k < 9 && !status; ++k) {
            const uint32_t bits = word_of(record + 4 * (size_t)k);
            float value;
            memcpy(&value, &bits, sizeof value);
            if (!isfinite(value))
                return message_at(STATUS_INPUT, file, 0, "triangle %u: a coordinate is not finite", t);
            stl->corner[t][k / 3][k % 3] = (double)value;
        }
    }
    return status;
}

/* ---- text ------------------------------------------------------------------------------------------------------- */

/* Words that begin lines: where each word may stand (at), and where the next line then stands (then). */
enum { OUTSIDE, SOLID, FACET, CORNER, CORNERS_DONE = CORNER + 3, LOOP_DONE };
static const struct {
    const char *word;
    int at, then;
} words[] = {{"solid", OUTSIDE, SOLID},
             {"facet", SOLID, FACET},
             {"outer", FACET, CORNER},
             {"vertex", CORNER, CORNER + 1},
             {"vertex", CORNER + 1, CORNER + 2},
             {"vertex", CORNER + 2, CORNERS_DONE},
             {"endloop", CORNERS_DONE, LOOP_DONE},
             {"endfacet", LOOP_DONE, SOLID},
             {"endsolid", SOLID, OUTSIDE}};
enum { WORDS = sizeof words / sizeof *words };

static int read_corner(const struct lines *lines, const struct fields *fields, double corner[3]) {
    if (fields->n != 4) return lines_fault(lines, "a vertex has three coordinates, not %zu", fields->n - 1);
    for (size_t axis = 0; axis < 3; ++axis) {
        const int status = lines_number(lines, "the coordinate", fields->at[axis + 1], &corner[axis]);
        if (status) return status;
        if (fabs(corner[axis]) > FIBRAD_LENGTH_MAX)
            return lines_fault(lines, "the coordinate %g is too large", corner[axis]);
    }
    return STATUS_OK;
}

/* Takes the name behind `solid`: all words of the line, with _ between them. */
static int name_solid(struct stl *stl, const struct fields *fields) {
    char name[SOLID_NAME] = "";
    for (size_t k = 1, used = 0; k < fields->n && used < sizeof name; ++k)
        used += (size_t)snprintf(name + used, sizeof name - used, k > 1 ? "_%s" : "%s", fields->at[k]);
    return add_solid(stl, name);
}

/* Reads a line that is not blank. */
static int read_line(struct stl *stl, const struct lines *lines, const struct fields *fields, int *state) {
    const char *first = fields->at[0];
    bool known = false;
    for (int k = 0; k < WORDS; ++k) {
        if (strcasecmp(first, words[k].word) != 0) continue;
        known = true;
        if (words[k].at != *state) continue;
        const int before = *state;
        *state = words[k].then;
        if (before == OUTSIDE) return name_solid(stl, fields);
        if (*state == FACET) return add_triangle(stl, lines->name, lines->number);
        if (before >= CORNER && before < CORNERS_DONE)
            return read_corner(lines, fields, stl->corner[stl->n - 1][before - CORNER]);
        return STATUS_OK;
    }
    return lines_fault(lines, known ? "'%.40s' is out of place" : "'%.40s' is no word of an STL file", first);
}

static int read_text(struct stl *stl, struct lines *lines) {
    struct fields fields = {0};
    int state = OUTSIDE, status = STATUS_OK;
    for (bool more = true; !status;) {
        status = lines_next(lines, &more);
        if (status || !more) break;
        status = fields_split_blanks(&fields, lines->text);
        if (!status && fields.n > 0) status = read_line(stl, lines, &fields, &state);
    }
    if (!status && (state != OUTSIDE || lines->truncated)) status = lines_fault(lines, "the file ends within a solid");
    free(fields.at);
    return status;
}

/* ---- either ----------------------------------------------------------------------------------------------------- */

/* Whether the bytes can only be text: they begin with "solid", and the first 512 have no 0. */
static bool is_text(const char *bytes, size_t size) {
    const char *begin = bytes + strspn(bytes, " \t\r\n\v\f");
    return strncasecmp(begin, "solid", 5) == 0 && !memchr(bytes, 0, size < 512 ? size : 512);
}

static int read_either(struct stl *stl, struct lines *lines) {
    char *bytes;
    size_t size;
    const int status = lines_rest(lines, &bytes, &size);
    if (status) return status;
    if (size == 0) return message_at(STATUS_INPUT, lines->name, 0, "the file is empty");
    const uint32_t count = size >= HEAD ? word_of(bytes + HEAD - 4) : 0;
    if (size >= HEAD && size - HEAD == (uint64_t)count * RECORD) return read_records(stl, lines->name, bytes, count);
    stl->text = is_text(bytes, size);
    if (stl->text) {
        lines_return(lines);
        lines_drop(lines);
        return read_text(stl, lines);
    }
    if (size < HEAD) return message_at(STATUS_INPUT, lines->name, 0, "this is no STL file");
    return message_at(STATUS_INPUT, lines->name, 0,
                      "the file has %zu bytes; a binary STL file of %u triangles has %llu", size, count,
                      (unsigned long long)HEAD + (unsigned long long)count * RECORD);
}

int stl_read(struct stl *stl, const char *path) {
    struct lines lines;
    *stl = (struct stl){0};
    int status = lines_open(&lines, path);
    if (!status) status = read_either(stl, &lines);
    if (!status && stl->n == 0) status = message_at(STATUS_INPUT, lines.name, 0, "the file has no triangles");
    lines_close(&lines);
    return status;
}
