/* read_dump.c - beds from LAMMPS and LIGGGHTS text dumps. SPDX-License-Identifier: MIT
 *
 * A dump is a sequence of frames; a frame is a sequence of sections, each begun by a line `ITEM: NAME ...`: TIMESTEP
 * first, ATOMS with the names of its columns last. Every frame up to the one wanted is read and has to be sound. */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "read/read.h"
#include "read/read_columns.h"

struct dump {
    struct lines *lines;
    const struct read_options *options;
    struct bed *bed;
    struct columns columns;
    struct fields fields;
    int64_t frame;  /* the current one; -1 before the first */
    int64_t atoms;  /* as declared; -1 before that */
    bool box, open; /* the box is known; atoms of the frame are missing */
};

static int fail(const struct dump *dump, const char *what) {
    return message_at(STATUS_INPUT, dump->lines->name, dump->lines->number, "%s", what);
}

/* The rest of an ITEM line if it is the one named, else NULL. */
static char *item(const struct dump *dump, const char *name) {
    char *text = dump->lines->text;
    const size_t length = strlen(name);
    return strncmp(text, name, length) == 0 ? text + length : NULL;
}

/* The next line within a section. */
static int section_line(struct dump *dump) {
    bool more;
    const int status = lines_next(dump->lines, &more);
    if (status) return status;
    if (!more) return fail(dump, "the file ends within a frame");
    if (item(dump, "ITEM:")) return fail(dump, "a section begins where lines of the one before are missing");
    return STATUS_OK;
}

static int read_count(struct dump *dump) {
    int status = section_line(dump);
    if (!status) status = fields_split(&dump->fields, dump->lines->text, " \t");
    if (status) return status;
    if (dump->fields.n != 1) return fail(dump, "the number of atoms is expected");
    status = lines_whole(dump->lines, "the number of atoms", dump->fields.at[0], &dump->atoms);
    if (!status && dump->atoms < 0) status = fail(dump, "the number of atoms is negative");
    return status;
}

/* `ITEM: BOX BOUNDS pp ff ff`: pp marks a periodic axis, other pairs of f, s, m an open one; old files lack the marks.
 * Then `low high` for each axis. Triclinic boxes say `xy xz yz` or `abc origin` before the marks. */
static int read_box(struct dump *dump, char *marks) {
    int status = fields_split(&dump->fields, marks, " \t");
    if (status) return status;
    const size_t n = dump->fields.n;
    if (n > 0 && (strcmp(dump->fields.at[0], "xy") == 0 || strcmp(dump->fields.at[0], "abc") == 0))
        return fail(dump, "the box is triclinic; only boxes with right angles can be read");
    if (n != 0 && n != 3) return fail(dump, "BOX BOUNDS needs three boundary marks, such as pp ff ff");
    bool periodic[3] = {false, false, false};
    for (size_t axis = 0; axis < n; ++axis) {
        const char *mark = dump->fields.at[axis];
        periodic[axis] = strcmp(mark, "pp") == 0;
        if (!periodic[axis] && (strlen(mark) != 2 || strspn(mark, "fsm") != 2))
            return message_at(STATUS_INPUT, dump->lines->name, dump->lines->number, "unknown boundary mark '%.40s'",
                              mark);
    }
    for (int axis = 0; axis < 3; ++axis) {
        double *low = &dump->bed->low[axis], *high = &dump->bed->high[axis];
        status = section_line(dump);
        if (!status) status = fields_split(&dump->fields, dump->lines->text, " \t");
        if (status) return status;
        if (dump->fields.n != 2) return fail(dump, "the two bounds of the box are expected");
        status = lines_number(dump->lines, "the lower bound", dump->fields.at[0], low);
        if (!status) status = lines_number(dump->lines, "the upper bound", dump->fields.at[1], high);
        if (status) return status;
        if (!(*low < *high)) return fail(dump, "the box is empty: its upper bound must be above the lower one");
        dump->bed->period[axis] = periodic[axis] ? *high - *low : 0;
    }
    dump->box = true;
    return STATUS_OK;
}

static int read_atoms(struct dump *dump, char *names) {
    if (dump->atoms < 0) return fail(dump, "ITEM: ATOMS comes before ITEM: NUMBER OF ATOMS");
    int status = fields_split(&dump->fields, names, " \t");
    if (!status) status = columns_find(&dump->columns, dump->lines, &dump->fields, dump->options);
    if (status) return status;
    const bool *scaled = dump->columns.scaled;
    if (!dump->box && (scaled[0] || scaled[1] || scaled[2]))
        return fail(dump, "scaled coordinates need ITEM: BOX BOUNDS before them");
    for (int64_t k = 0; k < dump->atoms; ++k) {
        bool more;
        status = lines_next(dump->lines, &more);
        if (status) return status;
        if (!more || item(dump, "ITEM:"))
            return message_at(STATUS_INPUT, dump->lines->name, dump->lines->number,
                              "the frame ends after %" PRId64 " atoms; %" PRId64 " were declared", k, dump->atoms);
        status = fields_split(&dump->fields, dump->lines->text, " \t");
        if (!status) status = columns_add(&dump->columns, dump->lines, &dump->fields, dump->options, dump->bed);
        if (status) return status;
    }
    dump->open = false;
    return STATUS_OK;
}

/* Skips a section that is of no use here, such as TIME or UNITS. */
static int skip_section(struct dump *dump) {
    for (;;) {
        bool more;
        const int status = lines_next(dump->lines, &more);
        if (status || !more) return status;
        if (item(dump, "ITEM:")) {
            lines_hold(dump->lines);
            return STATUS_OK;
        }
    }
}

static int begin_frame(struct dump *dump) {
    if (dump->open) return fail(dump, "a frame begins where atoms of the one before are missing");
    ++dump->frame;
    dump->atoms = -1;
    dump->box = false;
    dump->open = true;
    bed_clear(dump->bed);
    return section_line(dump);
}

static int read_section(struct dump *dump) {
    char *rest;
    if (item(dump, "ITEM: TIMESTEP")) return begin_frame(dump);
    if (!item(dump, "ITEM:")) return fail(dump, "more atoms than declared, or a line that belongs to no section");
    if (dump->open && item(dump, "ITEM: NUMBER OF ATOMS")) return read_count(dump);
    if (dump->open && (rest = item(dump, "ITEM: BOX BOUNDS"))) return read_box(dump, rest);
    if (dump->open && (rest = item(dump, "ITEM: ATOMS"))) return read_atoms(dump, rest);
    return skip_section(dump);
}

static int read_frames(struct dump *dump) {
    const int64_t wanted = dump->options->frames.end - 1;
    bool more;
    int status;
    while ((status = lines_next(dump->lines, &more)) == STATUS_OK && more) {
        if (lines_blank(dump->lines)) continue;
        status = read_section(dump);
        if (status) return status;
        if (dump->frame == wanted && !dump->open && dump->frame >= 0) return STATUS_OK;
    }
    if (status) return status;
    if (dump->open) return fail(dump, "the file ends within a frame");
    if (dump->frame < 0) return message_at(STATUS_INPUT, dump->lines->name, 0, "there is no frame in this dump");
    if (wanted > dump->frame)
        return message_at(STATUS_INPUT, dump->lines->name, 0, "there is no frame %" PRId64 "; the last is %" PRId64,
                          wanted, dump->frame);
    return STATUS_OK;
}

int read_dump(struct lines *lines, const struct read_options *options, struct bed *bed) {
    struct dump dump = {.lines = lines, .options = options, .bed = bed, .frame = -1};
    const int status = read_frames(&dump);
    free(dump.columns.extra);
    free(dump.fields.at);
    return status;
}
