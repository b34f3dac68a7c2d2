/* vtk_legacy.c - points and arrays of legacy VTK files, text or binary. SPDX-License-Identifier: MIT
 *
 * Four lines name version, title, ASCII or BINARY, and kind of the data set. Keywords follow, most of them with an
 * array. Binary arrays are big-endian. Arrays that are not wanted are skipped. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "read/vtk/vtk_grid.h"

enum { NAME = 80 };

struct legacy {
    struct vtk_grid *grid;
    const char *at;    /* the next byte to be read */
    const char *line;  /* the last line that take_words has read */
    bool binary;       /* false: text */
    bool fifth;        /* version 5.0 or later: cells are offsets and connectivity */
    bool on_points;    /* the arrays that follow are on points, not on cells */
    uint64_t tuples;   /* length of these arrays */
    uint64_t sizes[2]; /* sizes in the last list of cells */
};

#define legacy_fail(legacy, ...) vtk_fail((legacy)->grid, (legacy)->binary ? NULL : (legacy)->line, __VA_ARGS__)

/* Copies the next line and moves behind it. */
static void take_line(struct legacy *legacy, char *line, size_t room) {
    const char *end = memchr(legacy->at, '\n', (size_t)(legacy->grid->end - legacy->at));
    const char *next = end ? end + 1 : legacy->grid->end;
    size_t length = (size_t)((end ? end : next) - legacy->at);
    if (length >= room) length = room - 1;
    memcpy(line, legacy->at, length);
    line[length] = 0;
    legacy->at = next;
}

/* Copies the next line that is not blank. False: the file ends. */
static bool take_words(struct legacy *legacy, char *line, size_t room) {
    while (legacy->at < legacy->grid->end) {
        legacy->line = legacy->at;
        take_line(legacy, line, room);
        if (line[strspn(line, " \t\r")]) return true;
    }
    return false;
}

/* Reads an array of `count` values into *values. values NULL: skips the array. */
static int legacy_array(struct legacy *legacy, const char *type_name, uint64_t count, double **values) {
    const struct vtk_type type = vtk_find_type(type_name);
    const uint64_t left = (uint64_t)(legacy->grid->end - legacy->at);
    if (strcmp(type_name, "bit") != 0 && type.size == 0)
        return legacy_fail(legacy, "arrays of type %.40s cannot be read", type_name);
    const uint64_t size = type.size ? type.size : 1;
    if (count > left || (legacy->binary && count * size > left))
        return legacy_fail(legacy, "the file ends within an array");
    if (values) {
        const int status = vtk_room(values, count);
        if (status) return status;
    }
    if (!legacy->binary) {
        if (vtk_scan(&legacy->at, legacy->grid->end, count, values ? *values : NULL)) return STATUS_OK;
        return vtk_fail(legacy->grid, legacy->at, "a number is expected, or the file ends within an array");
    }
    if (values && type.size) vtk_convert(type, true, legacy->at, count, *values);
    legacy->at += type.size ? count * size : (count + 7) / 8;
    return STATUS_OK;
}

/* Reads an array on points if it is wanted. Skips any other array. */
static int take_data(struct legacy *legacy, const char *name, const char *type, uint64_t components, uint64_t tuples) {
    const bool known = legacy->grid->points && tuples == legacy->grid->n;
    const bool wanted = legacy->on_points && known && vtk_wants(legacy->grid, name);
    double *values = NULL;
    if (wanted && components != 1)
        return vtk_fail(legacy->grid, NULL, "the array %.40s has %" PRIu64 " components; one is expected", name,
                        components);
    if (components > 1 && tuples > UINT64_MAX / components) return legacy_fail(legacy, "an array is too large");
    const int status = legacy_array(legacy, type, components * tuples, wanted ? &values : NULL);
    if (!status && wanted) return vtk_give(legacy->grid, name, values);
    free(values);
    return status;
}

static void skip_metadata(struct legacy *legacy) {
    char line[NAME];
    do take_line(legacy, line, sizeof line);
    while (legacy->at < legacy->grid->end && line[strspn(line, " \t\r")]);
}

static int take_field(struct legacy *legacy, int64_t arrays) {
    for (int64_t k = 0; k < arrays;) {
        char line[400], name[NAME], type[NAME];
        uint64_t components, tuples;
        if (!take_words(legacy, line, sizeof line)) return legacy_fail(legacy, "the file ends within a field");
        if (strncmp(line, "METADATA", 8) == 0) {
            skip_metadata(legacy);
            continue;
        }
        if (sscanf(line, "%79s %" SCNu64 " %" SCNu64 " %79s", name, &components, &tuples, type) != 4)
            return legacy_fail(legacy, "a field needs `name components tuples type`");
        const int status = take_data(legacy, name, type, components, tuples);
        if (status) return status;
        ++k;
    }
    return STATUS_OK;
}

static int take_points(struct legacy *legacy, uint64_t n, const char *type) {
    if (legacy->grid->points) return legacy_fail(legacy, "points are given twice");
    if (n > UINT64_MAX / 24) return legacy_fail(legacy, "an array is too large");
    legacy->grid->n = n;
    return legacy_array(legacy, type, 3 * n, &legacy->grid->points);
}

/* Skips cells: `CELLS n size` and size numbers. From version 5.0 on the line is `CELLS n m`. Arrays of n offsets and of
 * m numbers follow, each with a keyword. */
static int take_cells(struct legacy *legacy, uint64_t n, uint64_t size) {
    legacy->sizes[0] = n;
    legacy->sizes[1] = size;
    return legacy->fifth ? STATUS_OK : legacy_array(legacy, "int", size, NULL);
}

/* Reads `SCALARS name type components`, which a line LOOKUP_TABLE may follow. */
static int take_scalars(struct legacy *legacy, const char *line) {
    char name[NAME], type[NAME], table[NAME];
    uint64_t components = 1;
    if (sscanf(line, "%*s %79s %79s %" SCNu64, name, type, &components) < 2)
        return legacy_fail(legacy, "SCALARS needs a name and a type");
    const char *before = legacy->at;
    if (!take_words(legacy, table, sizeof table) || strncmp(table, "LOOKUP_TABLE", 12) != 0) legacy->at = before;
    return take_data(legacy, name, type, components, legacy->tuples);
}

/* Reads the line of a keyword and what belongs to it. */
static int take_keyword(struct legacy *legacy, const char *line) {
    static const struct {
        const char *keyword;
        uint64_t components;
    } arrays[] = {{"VECTORS", 3},  {"NORMALS", 3},    {"TENSORS", 9},
                  {"TENSORS6", 6}, {"GLOBAL_IDS", 1}, {"PEDIGREE_IDS", 1}};
    static const char lists[] = " VERTICES LINES POLYGONS TRIANGLE_STRIPS CELLS ";
    char word[NAME] = "", marked[NAME + 2], first[NAME] = "", second[NAME] = "";
    uint64_t n = 0, m = 0;
    sscanf(line, "%79s %79s %79s", word, first, second);
    sscanf(first, "%" SCNu64, &n);
    sscanf(second, "%" SCNu64, &m);
    snprintf(marked, sizeof marked, " %s ", word);
    if (strcmp(word, "METADATA") == 0) {
        skip_metadata(legacy);
        return STATUS_OK;
    }
    if (strcmp(word, "POINTS") == 0) return take_points(legacy, n, second);
    if (strstr(lists, marked)) return take_cells(legacy, n, m);
    if (strcmp(word, "OFFSETS") == 0) return legacy_array(legacy, first, legacy->sizes[0], NULL);
    if (strcmp(word, "CONNECTIVITY") == 0) return legacy_array(legacy, first, legacy->sizes[1], NULL);
    if (strcmp(word, "CELL_TYPES") == 0) return legacy_array(legacy, "int", n, NULL);
    if (strcmp(word, "FIELD") == 0) return take_field(legacy, (int64_t)(m <= INT64_MAX ? m : 0));
    if (strcmp(word, "SCALARS") == 0) return take_scalars(legacy, line);
    if (strcmp(word, "POINT_DATA") == 0 || strcmp(word, "CELL_DATA") == 0) {
        legacy->on_points = *word == 'P';
        legacy->tuples = n;
        return STATUS_OK;
    }
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; ++k)
        if (strcmp(word, arrays[k].keyword) == 0)
            return take_data(legacy, first, second, arrays[k].components, legacy->tuples);
    return legacy_fail(legacy, "the keyword %.40s is not known", word);
}

int vtk_read_legacy(struct vtk_grid *grid) {
    struct legacy legacy = {.grid = grid, .at = grid->text};
    char line[400];
    int version = 0;
    take_line(&legacy, line, sizeof line);
    sscanf(line, "# vtk DataFile Version %d", &version);
    legacy.fifth = version >= 5;
    take_line(&legacy, line, sizeof line);
    if (!take_words(&legacy, line, sizeof line)) return legacy_fail(&legacy, "the file ends too early");
    legacy.binary = strncmp(line, "BINARY", 6) == 0;
    if (!legacy.binary && strncmp(line, "ASCII", 5) != 0) return legacy_fail(&legacy, "ASCII or BINARY is expected");
    if (!take_words(&legacy, line, sizeof line)) return legacy_fail(&legacy, "the file ends too early");
    if (strncmp(line, "DATASET POLYDATA", 16) != 0 && strncmp(line, "DATASET UNSTRUCTURED_GRID", 25) != 0)
        return vtk_fail(grid, NULL,
                        "this is a VTK file of another kind than POLYDATA or UNSTRUCTURED_GRID: it has no spheres");
    while (take_words(&legacy, line, sizeof line)) {
        const int status = take_keyword(&legacy, line);
        if (status) return status;
    }
    return vtk_end_piece(grid);
}
