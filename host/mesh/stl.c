/* stl.c - triangles of an STL file, text or binary, or of an OBJ file; may be packed by gzip.
 * SPDX-License-Identifier: MIT
 *
 * A binary file has 80 bytes, the number of triangles, and 50 bytes per triangle: normal, corners, two bytes without
 * meaning. Its first bytes may be "solid", as in a text file. So the length of the file decides. */
#include "mesh/stl.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

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
        if (!status && fields.n > 0 && *fields.at[0] != '#') status = read_line(stl, lines, &fields, &state);
    }
    if (!status && (state != OUTSIDE || lines->truncated)) status = lines_fault(lines, "the file ends within a solid");
    free(fields.at);
    return status;
}

/* ---- OBJ -------------------------------------------------------------------------------------------------------- */

/* Vertices of an OBJ file. */
struct vertices {
    double (*at)[3];
    size_t n;
};

/* Reads the face `f a b c ...`, whose corners may be a/texture/normal, and count from 1 or, below 0, from the last. A
 * polygon becomes triangles about its first corner. */
static int read_face(struct stl *stl, const struct lines *lines, const struct fields *fields,
                     const struct vertices *vertices) {
    const double *corner[3] = {NULL, NULL, NULL};
    int status = fields->n < 4 ? lines_fault(lines, "a face has three corners or more") : STATUS_OK;
    for (size_t k = 1; k < fields->n && !status; ++k) {
        int64_t number;
        fields->at[k][strcspn(fields->at[k], "/")] = 0;
        status = lines_whole(lines, "the corner", fields->at[k], &number);
        if (status) return status;
        if (number < 0) number += (int64_t)vertices->n + 1;
        if (number < 1 || number > (int64_t)vertices->n)
            return lines_fault(lines, "there is no vertex %s", fields->at[k]);
        corner[1] = corner[2], corner[2] = vertices->at[number - 1];
        if (k == 1) corner[0] = corner[2];
        if (k < 3) continue;
        status = add_triangle(stl, lines->name, lines->number);
        for (int c = 0; c < 3 && !status; ++c) memcpy(stl->corner[stl->n - 1][c], corner[c], sizeof **stl->corner);
    }
    return status;
}

/* Reads vertices and faces. Other lines have nothing of the surface. The file is one solid. */
static int read_obj(struct stl *stl, struct lines *lines) {
    struct fields fields = {0};
    struct vertices vertices = {0};
    int status = add_solid(stl, "");
    for (bool more = true, good = true; !status && !(status = lines_next(lines, &more)) && more;) {
        lines->text[strcspn(lines->text, "#")] = 0;
        status = fields_split_blanks(&fields, lines->text);
        const char *first = fields.n > 0 ? fields.at[0] : "";
        if (!status && strcmp(first, "v") == 0) {
            if (fields.n > 4) fields.n = 4; /* behind x y z a weight or a colour may stand */
            vertices.at = memory_grown(vertices.at, vertices.n, sizeof *vertices.at, &good);
            status = good ? read_corner(lines, &fields, vertices.at[vertices.n++]) : message_memory();
        } else if (!status && strcmp(first, "f") == 0) {
            status = read_face(stl, lines, &fields, &vertices);
        }
    }
    free(vertices.at);
    free(fields.at);
    return status;
}

/* ---- either ----------------------------------------------------------------------------------------------------- */

/* Skips blanks and comments. */
static const char *first_word(const char *text) {
    static const char blanks[] = " \t\r\n\v\f";
    for (text += strspn(text, blanks); *text == '#'; text += strspn(text, blanks)) text += strcspn(text, "\r\n");
    return text;
}

static int read_either(struct stl *stl, struct lines *lines) {
    char *bytes;
    size_t size;
    const int status = lines_rest(lines, &bytes, &size);
    if (status) return status;
    if (size == 0) return message_at(STATUS_INPUT, lines->name, 0, "the file is empty");
    const uint32_t count = size >= HEAD ? word_of(bytes + HEAD - 4) : 0;
    if (size >= HEAD && size - HEAD == (uint64_t)count * RECORD) return read_records(stl, lines->name, bytes, count);
    const bool text = size < HEAD || !memchr(bytes, 0, size < 512 ? size : 512);
    const bool solid = strncasecmp(first_word(bytes), "solid", 5) == 0;
    stl->text = text && (solid || strncmp(bytes, "v ", 2) == 0 || strstr(bytes, "\nv "));
    if (stl->text) {
        lines_return(lines);
        lines_drop(lines);
        return solid ? read_text(stl, lines) : read_obj(stl, lines);
    }
    if (text) return message_at(STATUS_INPUT, lines->name, 0, "this is no STL file and no OBJ file");
    return message_at(STATUS_INPUT, lines->name, 0,
                      "this is no STL file: a binary one of %u triangles has %llu bytes, not %zu", count,
                      (unsigned long long)HEAD + (unsigned long long)count * RECORD, size);
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
