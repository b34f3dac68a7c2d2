/* vtk_grid.c - points of a VTK file and wanted arrays on the points. SPDX-License-Identifier: MIT */
#include "read/vtk/vtk_grid.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "cli/message.h"
#include "text/read_number.h"
#include "text/unit.h"

struct vtk_type vtk_find_type(const char *name) {
    static const struct vtk_type types[] = {
        {4, 'f', " float Float32 "},
        {8, 'f', " double Float64 "},
        {1, 'i', " char Int8 "},
        {1, 'u', " unsigned_char UInt8 "},
        {2, 'i', " short Int16 "},
        {2, 'u', " unsigned_short UInt16 "},
        {4, 'i', " int vtkIdType Int32 "},
        {4, 'u', " unsigned_int UInt32 "},
        {8, 'i', " long vtktypeint64 Int64 "},
        {8, 'u', " unsigned_long vtktypeuint64 UInt64 "},
    };
    char word[40];
    snprintf(word, sizeof word, " %s ", name);
    for (size_t k = 0; k < sizeof types / sizeof *types; ++k)
        if (strstr(types[k].names, word)) return types[k];
    return (struct vtk_type){0};
}

enum { NO_RANK = -1, OTHER_CASE = 1000 };

/* The rank of a name among those of a wanted array. */
static int rank_of(const struct vtk_wanted *wanted, const char *name) {
    size_t bare, length;
    const char *unit;
    if (wanted->name && strcmp(wanted->name, name) == 0) return 0;
    if (wanted->name && unit_behind(wanted->name, &bare, &unit, &length) && strlen(name) == bare &&
        memcmp(wanted->name, name, bare) == 0)
        return 1;
    for (int k = 0; wanted->names && wanted->names[k]; ++k)
        if (strcasecmp(wanted->names[k], name) == 0) return strcmp(wanted->names[k], name) == 0 ? k : OTHER_CASE + k;
    return NO_RANK;
}

bool vtk_wants(const struct vtk_grid *grid, const char *name) {
    for (size_t k = 0; k < grid->count; ++k)
        if (rank_of(&grid->wanted[k], name) != NO_RANK) return true;
    return false;
}

int vtk_give(struct vtk_grid *grid, const char *name, double *values) {
    const size_t bytes = (size_t)grid->n * sizeof *values;
    int status = STATUS_OK;
    for (size_t k = 0; k < grid->count && !status; ++k) {
        struct vtk_wanted *wanted = &grid->wanted[k];
        const int rank = rank_of(wanted, name);
        if (rank == NO_RANK || (wanted->values && rank > wanted->rank)) continue;
        if (wanted->values && rank == wanted->rank) {
            if (memcmp(wanted->values, values, bytes) != 0)
                status = vtk_fail(grid, NULL, "two arrays on the points are named %.40s, and differ", name);
            continue;
        }
        status = vtk_room(&wanted->values, grid->n);
        if (!status) memcpy(wanted->values, values, bytes);
        wanted->rank = rank;
    }
    free(values);
    return status;
}

int vtk_end_piece(struct vtk_grid *grid) {
    if (!grid->take) return STATUS_OK;
    const int status = grid->take(grid, grid->context);
    for (size_t k = 0; k < grid->count; ++k) free(grid->wanted[k].values), grid->wanted[k].values = NULL;
    free(grid->points);
    grid->points = NULL;
    grid->n = 0;
    return status;
}

static double value_of(struct vtk_type type, const unsigned char *bytes, bool big) {
    uint64_t bits = 0;
    for (size_t k = 0; k < type.size; ++k) bits |= (uint64_t)bytes[big ? type.size - 1 - k : k] << 8 * k;
    if (type.kind == 'f' && type.size == 4) {
        const uint32_t half = (uint32_t)bits;
        float value;
        memcpy(&value, &half, sizeof value);
        return (double)value;
    }
    if (type.kind == 'f') {
        double value;
        memcpy(&value, &bits, sizeof value);
        return value;
    }
    const uint64_t sign = UINT64_C(1) << (8 * type.size - 1);
    return type.kind == 'i' && bits & sign ? -(double)(sign - (bits & (sign - 1))) : (double)bits;
}

void vtk_convert(struct vtk_type type, bool big, const void *bytes, uint64_t count, double *values) {
    const unsigned char *at = bytes;
    for (uint64_t k = 0; k < count; ++k) values[k] = value_of(type, at + k * type.size, big);
}

bool vtk_scan(const char **text, const char *end, uint64_t count, double *values) {
    for (uint64_t k = 0; k < count; ++k) {
        char word[64];
        size_t length = 0;
        while (*text < end && isspace((unsigned char)**text)) ++*text;
        while (*text < end && !isspace((unsigned char)**text) && **text != '<' && length < sizeof word - 1)
            word[length++] = *(*text)++;
        word[length] = 0;
        double value;
        if (!number_read(word, &value)) return false;
        if (values) values[k] = value;
    }
    return true;
}

int vtk_fail(const struct vtk_grid *grid, const char *at, const char *format, ...) {
    char what[400];
    uint64_t line = at ? 1 : 0;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    for (const char *c = grid->text; at && c < at; ++c) line += *c == '\n';
    return message_at(STATUS_INPUT, grid->file, line, "%s", what);
}

int vtk_room(double **values, uint64_t count) {
    free(*values);
    *values = count < SIZE_MAX / sizeof **values ? malloc((size_t)(count + 1) * sizeof **values) : NULL;
    return *values ? STATUS_OK : message_memory();
}
