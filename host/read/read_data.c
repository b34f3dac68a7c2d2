/* read_data.c - beds from data files of LAMMPS and LIGGGHTS. SPDX-License-Identifier: MIT
 *
 * A file has a comment, a header of lines such as `100 atoms` and `0 2 xlo xhi`, and sections. The section
 * `Atoms # sphere` has the spheres. Positions are those within the box; image flags are not used. */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "read/read_format.h"
#include "text/read_number.h"

enum { IMAGE_FLAGS = 3, COLUMNS_MAX = 1000, WORD = 40, STYLE = 80 };

/* The known styles of atoms and their columns. */
static const struct {
    const char *style, *columns;
} styles[] = {
    {"sphere", "id type diameter density x y z"},
    {"granular", "id type diameter density x y z"},
    {"hybrid sphere", "id type x y z diameter density"},
    {"hybrid granular", "id type x y z diameter density"},
    {"hybrid", "id type x y z"},
    {"atomic", "id type x y z"},
    {"charge", "id type q x y z"},
    {"bond", "id molecule type x y z"},
    {"angle", "id molecule type x y z"},
    {"molecular", "id molecule type x y z"},
    {"full", "id molecule type q x y z"},
};

/* Whether one of the first 100 lines is like `100 atoms`. */
static bool is_data(const struct source *source) {
    size_t size;
    const char *text = source_begin(source, &size), *last = text + size;
    for (int line = 0; line < 100; ++line) {
        const char *end = memchr(text, '\n', (size_t)(last - text));
        char copy[WORD], word[WORD];
        int64_t atoms;
        if (!end) return false;
        const size_t length = (size_t)(end - text) < sizeof copy - 1 ? (size_t)(end - text) : sizeof copy - 1;
        memcpy(copy, text, length);
        copy[length] = 0;
        if (line > 0 && sscanf(copy, "%39s %39s", word, copy) == 2 && strcmp(copy, "atoms") == 0 &&
            number_read_whole(word, &atoms))
            return true;
        text = end + 1;
    }
    return false;
}

/* ---- header ----------------------------------------------------------------------------------------------------- */

/* Reads the comment: `LAMMPS data file via write_data, version 2 Aug 2023, timestep = 3, units = si`. In files of
 * LIGGGHTS the style is granular: their section Atoms names no style. */
static void read_comment(const struct lines *lines, char *style, struct bed *bed) {
    char word[WORD];
    const char *units = strstr(lines->text, ", units = "), *step = strstr(lines->text, ", timestep = ");
    if (strstr(lines->text, "write_data, version Version LIGGGHTS")) memcpy(style, "granular", sizeof "granular");
    if (units) (void)sscanf(units, ", units = %15[a-z]", bed->units);
    if (step && sscanf(step, ", timestep = %39[0-9]", word) == 1) (void)number_read_whole(word, &bed->timestep);
}

/* A box of any direction: the lines `ax ay az avec`, bvec, cvec and `ox oy oz abc origin`. */
struct edges {
    double edge[9], origin[3];
    int lines;
};

/* Reads a line of such a box. The last one puts the box into the bed. *taken: it is such a line. */
static int read_edge(struct source *source, struct edges *edges, bool *taken, struct bed *bed) {
    static const char *const name[] = {"avec", "bvec", "cvec", "origin"};
    const struct fields *fields = &source->fields;
    int k = 0, status = STATUS_OK;
    while (k < 4 && (fields->n != (k < 3 ? 4u : 5u) || strcmp(fields->at[fields->n - 1], name[k]) != 0)) ++k;
    *taken = k < 4;
    for (int axis = 0; axis < 3 && *taken && !status; ++axis)
        status = lines_number(&source->lines, name[k], fields->at[axis],
                              k < 3 ? &edges->edge[3 * k + axis] : &edges->origin[axis]);
    if (!*taken || status || ++edges->lines < 4) return status;
    return source_edges(source, "the box is triclinic", edges->edge, edges->origin, (const bool[3]){false}, bed);
}

/* Reads a line of the header, which has been split. */
static int read_header_line(struct source *source, int64_t *atoms, struct edges *edges, struct bed *bed) {
    static const char *const low[] = {"xlo", "ylo", "zlo"}, *const high[] = {"xhi", "yhi", "zhi"};
    const struct fields *fields = &source->fields;
    char **at = fields->at;
    bool taken;
    if (fields->n == 2 && strcmp(at[1], "atoms") == 0) return source_count(source, at[0], atoms);
    int status = read_edge(source, edges, &taken, bed);
    for (int axis = 0; axis < 3 && !status; ++axis) {
        if (fields->n != 4 || strcmp(at[2], low[axis]) != 0 || strcmp(at[3], high[axis]) != 0) continue;
        status = lines_number(&source->lines, low[axis], at[0], &bed->low[axis]);
        if (!status) status = lines_number(&source->lines, high[axis], at[1], &bed->high[axis]);
        if (!status && !(bed->low[axis] < bed->high[axis])) status = source_fail(source, "the box is empty");
    }
    const bool tilt = fields->n == 6 && strcmp(at[3], "xy") == 0;
    for (int k = 0; k < 3 && tilt && !status; ++k) {
        double value;
        status = lines_number(&source->lines, at[3 + k], at[k], &value);
        if (!status && fabs(value) > EDGE_TRACE * (bed->high[0] - bed->low[0]))
            return source_fail(source, "the box is tilted; only boxes with right angles can be read");
    }
    return status;
}

/* Reads up to the section Atoms. style: out: the comment behind Atoms. */
static int read_header(struct source *source, int64_t *atoms, char *style, struct bed *bed) {
    struct lines *lines = &source->lines;
    struct edges edges = {.lines = 0};
    bool more, header = true;
    int status = lines_next(lines, &more);
    if (!status && more) read_comment(lines, style, bed);
    while (!status && !(status = lines_next(lines, &more)) && more) {
        char word[WORD] = "", *comment = strchr(lines->text, '#');
        if (comment) *comment++ = 0;
        sscanf(lines->text, "%39s", word);
        if (strcmp(word, "Atoms") == 0) {
            if (comment && sscanf(comment, " %79[^\r\n]", style) == 1)
                for (size_t end = strlen(style); end > 0 && isspace((unsigned char)style[end - 1]); --end)
                    style[end - 1] = 0;
            return STATUS_OK;
        }
        header = header && !isupper((unsigned char)*word);
        if (!header) continue; /* a line of another section */
        status = fields_split_blanks(&source->fields, lines->text);
        if (!status) status = read_header_line(source, atoms, &edges, bed);
    }
    return status ? status : source_ends(source, "there is no section Atoms in this LAMMPS data file");
}

/* ---- atoms ------------------------------------------------------------------------------------------------------ */

/* Whether a row of spheres may have its diameter and density, and its centre, at these columns. */
static bool row_fits(int n, const double *value, int diameter, int centre, const struct bed *bed) {
    bool good = (n == 7 || n == 7 + IMAGE_FLAGS) && value[diameter] > 0 && value[diameter + 1] > 0;
    for (int axis = 0; axis < 3 && good; ++axis) {
        const double at = value[centre + axis], low = bed->low[axis], high = bed->high[axis];
        good = low == high || (at >= low - value[diameter] && at <= high + value[diameter]);
    }
    return good;
}

/* Guesses the style from the first rows if the file does not name it. Only style atomic has five columns, or eight with
 * image flags. Of spheres the first layout counts in which sizes are above 0 and centres lie in the box. */
static int guess_style(struct source *source, int64_t atoms, char *style, const struct bed *bed) {
    struct lines *lines = &source->lines;
    bool more, atomic = true, sphere = true, hybrid = true;
    int status;
    lines_keep(lines);
    for (int64_t row = 0; row < atoms && row < 100; ++row) {
        double v[7 + IMAGE_FLAGS + 1];
        status = lines_next_text(lines, &more);
        if (status || !more) return status;
        const int n = sscanf(lines->text, "%lf %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf", &v[0], &v[1], &v[2], &v[3],
                             &v[4], &v[5], &v[6], &v[7], &v[8], &v[9], &v[10]);
        atomic = atomic && (n == 5 || n == 5 + IMAGE_FLAGS);
        sphere = sphere && row_fits(n, v, 2, 4, bed);
        hybrid = hybrid && row_fits(n, v, 5, 2, bed);
        if (!atomic && !sphere && !hybrid)
            return source_fail(source, "the style of the atoms is not said, and these columns do not tell it; write "
                                       "`Atoms # sphere` above them if they are id type diameter density x y z");
    }
    lines_return(lines);
    lines_drop(lines);
    snprintf(style, STYLE, "%s", atomic ? "atomic" : sphere ? "sphere" : "hybrid sphere");
    if (atomic) return STATUS_OK;
    return message_at(STATUS_OK, lines->name, lines->number,
                      "warning: the style of the atoms is not said; their columns are taken as %s",
                      sphere ? "id type diameter density x y z" : "id type x y z diameter density");
}

/* Finds the columns of a style. *more: how many unknown columns may follow. */
static int find_style(struct source *source, const char *style, size_t *more, struct bed *bed) {
    const struct lines *lines = &source->lines;
    const bool hybrid = strncmp(style, "hybrid", 6) == 0;
    size_t k = 0;
    *more = hybrid ? COLUMNS_MAX : IMAGE_FLAGS;
    while (k < sizeof styles / sizeof *styles && strcmp(styles[k].style, style) != 0) ++k;
    if (k == sizeof styles / sizeof *styles)
        return lines_fault(
            lines,
            "this is a LAMMPS data file of style %.40s, whose columns are not known; columns of style sphere are known",
            style);
    if (source->options.no_radius || strstr(styles[k].columns, "diameter"))
        return source_columns(source, styles[k].columns, bed);
    if (hybrid)
        return source_fail(source, "this is a LAMMPS data file of style hybrid without its parts; write "
                                   "`Atoms # hybrid sphere` if columns are id type x y z diameter density ...");
    return lines_fault(lines, "this is a LAMMPS data file of style %s: it has no radii; --radius gives them", style);
}

static int read_data(struct source *source, struct bed *bed) {
    size_t more;
    char style[STYLE] = "";
    int64_t atoms = 0;
    bool there;
    int status = read_header(source, &atoms, style, bed);
    if (!status && !*style) status = guess_style(source, atoms, style, bed);
    if (!status) status = find_style(source, style, &more, bed);
    if (!status) status = lines_next_text(&source->lines, &there);
    if (!status && there) lines_hold(&source->lines);
    if (!status) status = source_rows(source, atoms, more, bed);
    if (!status) source_warn_open(source);
    return status;
}

const struct format format_data = {is_data, NULL, read_data};
