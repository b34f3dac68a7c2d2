/* read_dump.c - beds from LAMMPS and LIGGGHTS text dumps. SPDX-License-Identifier: MIT
 *
 * A dump is a sequence of frames, and a frame is a sequence of sections. Each section begins with a line `ITEM: NAME
 * ...`, and some files have a % before it. TIMESTEP stands near the beginning of a frame. ATOMS, with the names of the
 * columns, is the last section of a frame. UNITS stands before the first frame only. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "read/read_format.h"

static bool is_dump(const struct source *source) {
    return source_begins(source, "ITEM:") || source_begins(source, "%ITEM:") || source_begins(source, "% ITEM:");
}

/* If the current line begins with `name`: the rest of the line. Else NULL. */
static char *item(const struct source *source, const char *name) {
    char *text = source->lines.text + strspn(source->lines.text, "% ");
    return strncmp(text, name, strlen(name)) == 0 ? text + strlen(name) : NULL;
}

/* Reads the next line of a section. */
static int section_line(struct source *source, bool *more) {
    const int status = lines_next(&source->lines, more);
    if (status || !*more) return status;
    if (item(source, "ITEM:")) return source_fail(source, "a section begins where lines of the one before are missing");
    return STATUS_OK;
}

/* ---- passing over ----------------------------------------------------------------------------------------------- */

static int skip_count(struct source *source, int64_t *atoms, bool *more) {
    const int status = section_line(source, more);
    return status || !*more ? status : source_count_line(source, atoms);
}

/* Skips the lines up to the next ITEM. */
static int skip_section(struct source *source, bool *more) {
    int status;
    while (!(status = lines_next(&source->lines, more)) && *more)
        if (item(source, "ITEM:")) {
            lines_hold(&source->lines);
            break;
        }
    return status;
}

static int skip_dump(struct source *source) {
    int64_t atoms = -1;
    bool more, begun = false;
    int status;
    source->found = FOUND_END;
    while (!(status = lines_next(&source->lines, &more)) && more) {
        if (lines_blank(&source->lines)) continue;
        if (!item(source, "ITEM:"))
            return source_fail(source, "more atoms than declared, or a line that belongs to no section");
        source->found = FOUND_PART;
        snprintf(source->lack, LACK_MAX, "the file ends within a frame");
        if (item(source, "ITEM: ATOMS")) {
            if (atoms < 0) return source_fail(source, "ITEM: ATOMS comes before ITEM: NUMBER OF ATOMS");
            status = source_skip(source, atoms, "atoms", "ITEM:");
            source_skip_end(source);
            return status;
        }
        if (item(source, "ITEM: NUMBER OF ATOMS")) {
            status = skip_count(source, &atoms, &more);
        } else if (item(source, "ITEM: UNITS")) {
            status = section_line(source, &more);
            if (!status && more) source_word(source, source->units, sizeof source->units);
        } else if (item(source, "ITEM: ENTRIES")) {
            return source_fail(source, "this is a LAMMPS dump of local values: it has no atoms");
        } else {
            if (item(source, "ITEM: TIMESTEP") && begun)
                return source_fail(source, "a frame begins where atoms of the one before are missing");
            begun = begun || item(source, "ITEM: TIMESTEP");
            status = skip_section(source, &more);
        }
        if (status) return status;
    }
    return status;
}

/* ---- reading, what skip_dump has found complete ----------------------------------------------------------------- */

static int read_timestep(struct source *source, struct bed *bed) {
    bool more;
    char word[32];
    const int status = section_line(source, &more);
    if (status) return status;
    return lines_whole(&source->lines, "the timestep", source_word(source, word, sizeof word), &bed->timestep);
}

/* Reads the next line of a section as n numbers. */
static int read_numbers(struct source *source, size_t n, const char *const names[], double *value, const char *wanted) {
    bool more;
    int status = section_line(source, &more);
    if (!status) status = fields_split_blanks(&source->fields, source->lines.text);
    if (!status && source->fields.n != n) return source_fail(source, "%s", wanted);
    for (size_t k = 0; k < n && !status; ++k)
        status = lines_number(&source->lines, names[k], source->fields.at[k], &value[k]);
    return status;
}

/* Reads the line `low high` of an axis, with a tilt behind it if the box has tilts. */
static int read_bounds(struct source *source, int axis, bool tilted, bool periodic, struct bed *bed) {
    static const char *const names[] = {"the lower bound", "the upper bound", "the tilt"};
    double bound[3] = {0, 0, 0};
    const int status = read_numbers(source, tilted ? 3 : 2, names, bound, "the two bounds of the box are expected");
    if (status) return status;
    const double length = bound[1] - bound[0];
    if (!(bound[0] < bound[1]))
        return source_fail(source, "the box is empty: its upper bound must be above the lower one");
    if (fabs(bound[2]) > EDGE_TRACE * length)
        return source_fail(source, "the box is tilted; only boxes with right angles can be read");
    bed->low[axis] = bound[0];
    bed->high[axis] = bound[1];
    bed->period[axis] = periodic ? length : 0;
    return STATUS_OK;
}

/* Reads the three lines of a box of any direction: in each an edge and a coordinate of the origin. */
static int read_edges(struct source *source, const bool periodic[3], struct bed *bed) {
    static const char *const names[] = {"an edge of the box", "an edge of the box", "an edge of the box",
                                        "the origin of the box"};
    double line[4], edge[9], origin[3];
    for (int k = 0; k < 3; ++k) {
        const int status =
            read_numbers(source, 4, names, line, "an edge of the box and one coordinate of its origin are expected");
        if (status) return status;
        memcpy(&edge[3 * k], line, 3 * sizeof *line);
        origin[k] = line[3];
    }
    return source_edges(source, "the box is triclinic", edge, origin, periodic, bed);
}

/* Reads `ITEM: BOX BOUNDS pp ff ff` and a line `low high` for each axis. pp marks a periodic axis, other pairs of f, s,
 * m an open one. Old files lack the marks, and some programs write `xx yy zz` in their place. Boxes that may be
 * triclinic have `xy xz yz` before the marks and a tilt behind each pair. Boxes of any direction have `abc origin`. */
static int read_box(struct source *source, char *marks, struct bed *bed) {
    int status = fields_split_blanks(&source->fields, marks);
    if (status) return status;
    char **mark = source->fields.at;
    size_t n = source->fields.n;
    const bool edges = n >= 2 && strcmp(mark[0], "abc") == 0, tilted = n >= 3 && strcmp(mark[0], "xy") == 0;
    const size_t before = edges ? 2 : tilted ? 3 : 0;
    if (before > 0) mark += before, n -= before;
    const bool unmarked =
        n == 3 && strcmp(mark[0], "xx") == 0 && strcmp(mark[1], "yy") == 0 && strcmp(mark[2], "zz") == 0;
    if (unmarked) n = 0;
    if (n != 0 && n != 3) return source_fail(source, "BOX BOUNDS needs three boundary marks, such as pp ff ff");
    bool periodic[3] = {false, false, false};
    for (size_t axis = 0; axis < n; ++axis) {
        periodic[axis] = strcmp(mark[axis], "pp") == 0;
        if (!periodic[axis] && (strlen(mark[axis]) != 2 || strspn(mark[axis], "fsm") != 2))
            return source_fail(source, "unknown boundary mark '%.40s'", mark[axis]);
    }
    if (unmarked) source_warn_open(source);
    if (edges) return read_edges(source, periodic, bed);
    for (int axis = 0; axis < 3 && !status; ++axis) status = read_bounds(source, axis, tilted, periodic[axis], bed);
    return status;
}

static int read_dump(struct source *source, struct bed *bed) {
    int64_t atoms = 0;
    memcpy(bed->units, source->units, sizeof bed->units);
    for (;;) {
        bool more;
        char *rest;
        int status = lines_next(&source->lines, &more);
        if (status) return status;
        if ((rest = item(source, "ITEM: ATOMS"))) {
            status = source_columns(source, rest, bed);
            return status ? status : source_rows(source, atoms, 0, bed);
        }
        if (item(source, "ITEM: NUMBER OF ATOMS")) status = skip_count(source, &atoms, &more);
        if (item(source, "ITEM: TIMESTEP")) status = read_timestep(source, bed);
        if ((rest = item(source, "ITEM: BOX BOUNDS"))) status = read_box(source, rest, bed);
        if (status) return status;
    }
}

const struct format format_dump = {is_dump, skip_dump, read_dump};
