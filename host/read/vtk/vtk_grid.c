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

double **vtk_find_wanted(const struct vtk_grid *grid, const char *name) {
    for (size_t k = 0; k < grid->count; ++k) {
        struct vtk_wanted *wanted = &grid->wanted[k];
        if (wanted->name && strcmp(wanted->name, name) == 0) return &wanted->values;
        for (const char *const *other = wanted->names; other && *other; ++other)
            if (strcasecmp(*other, name) == 0) return &wanted->values;
    }
    return NULL;
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
    if (type.kind == 'i' && bits & sign) return -(double)(sign - (bits & (sign - 1)));
    return (double)bits;
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
