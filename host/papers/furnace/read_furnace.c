/* read_furnace.c - boxes from text files of keys and values. SPDX-License-Identifier: MIT */
#include "papers/furnace/furnace.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "text/read_lines.h"

enum key { KEY_SIZE, KEY_CELLS, KEY_ABSORPTION, KEY_SCATTERING, KEY_SOURCE, KEY_WALL, KEYS };

static const struct {
    const char *name;
    size_t values;
} keys[KEYS] = {{"size", 3}, {"cells", 3}, {"absorption", 1}, {"scattering", 1}, {"source", 1}, {"wall", 3}};

static const char *const walls[6] = {"x0", "x1", "y0", "y1", "z0", "z1"};

/* A file that is being read. */
struct reading {
    struct lines lines;
    struct fields fields;
    fibrad_furnace_config *config;
    uint64_t line_of[KEYS], line_of_wall[6]; /* lines of keys and walls; 0: not read yet */
};

/* Reads a number of the line that must be at least `low`, or above `low`. */
static int furnace_read_number(const struct reading *r, const char *what, size_t field, double low, bool above,
                               double *value) {
    int status = lines_number(&r->lines, what, r->fields.at[field], value);
    if (status || *value > low || (!above && *value == low)) return status;
    return lines_fault(&r->lines, "%s must be %s %g, not %s", what, above ? "above" : "at least", low,
                       r->fields.at[field]);
}

static int furnace_read_size(struct reading *r) {
    int status = STATUS_OK;
    for (size_t a = 0; a < 3 && !status; a++)
        status = furnace_read_number(r, "size", 1 + a, 0, true, &r->config->size[a]);
    return status;
}

static int furnace_read_cells(struct reading *r) {
    uint64_t product = 1;
    for (size_t a = 0; a < 3; a++) {
        int64_t count;
        int status = lines_whole(&r->lines, "cells", r->fields.at[1 + a], &count);
        if (status) return status;
        if (count < 1 || (uint64_t)count > FIBRAD_FURNACE_CELLS_MAX / product)
            return lines_fault(&r->lines, "cells must be at least 1 along every axis, and no more than %u together",
                               FIBRAD_FURNACE_CELLS_MAX);
        r->config->cells[a] = (uint32_t)count;
        product *= (uint64_t)count;
    }
    return STATUS_OK;
}

static int furnace_set_wall(struct reading *r, size_t w, double temperature, double emissivity) {
    if (r->line_of_wall[w])
        return lines_fault(&r->lines, "wall %s was given in line %" PRIu64 " already", walls[w], r->line_of_wall[w]);
    r->line_of_wall[w] = r->lines.number;
    r->config->wall_temperature[w] = temperature;
    r->config->wall_emissivity[w] = emissivity;
    return STATUS_OK;
}

static int furnace_read_wall(struct reading *r) {
    const char *name = r->fields.at[1];
    double temperature, emissivity;
    int status = furnace_read_number(r, "wall temperature", 2, 0, true, &temperature);
    if (!status) status = furnace_read_number(r, "emissivity", 3, 0, false, &emissivity);
    if (status) return status;
    if (emissivity > 1) return lines_fault(&r->lines, "emissivity must be at most 1, not %s", r->fields.at[3]);
    if (strcmp(name, "sides") == 0) {
        for (size_t w = 0; w < 4 && !status; w++) status = furnace_set_wall(r, w, temperature, emissivity);
        return status;
    }
    for (size_t w = 0; w < 6; w++)
        if (strcmp(name, walls[w]) == 0) return furnace_set_wall(r, w, temperature, emissivity);
    return lines_fault(&r->lines, "unknown wall '%.40s'; there are x0, x1, y0, y1, z0, z1 and sides", name);
}

static int furnace_read_line(struct reading *r) {
    const char *name = r->fields.at[0];
    size_t k = 0;
    while (k < KEYS && strcmp(name, keys[k].name) != 0) k++;
    if (k == KEYS) return lines_fault(&r->lines, "unknown key '%.40s'", name);
    if (r->fields.n != keys[k].values + 1)
        return lines_fault(&r->lines, "%s takes %zu value%s, not %zu", name, keys[k].values,
                           keys[k].values > 1 ? "s" : "", r->fields.n - 1);
    if (k != KEY_WALL && r->line_of[k])
        return lines_fault(&r->lines, "%s was given in line %" PRIu64 " already", name, r->line_of[k]);
    r->line_of[k] = r->lines.number;
    switch (k) {
    case KEY_SIZE:
        return furnace_read_size(r);
    case KEY_CELLS:
        return furnace_read_cells(r);
    case KEY_ABSORPTION:
        return furnace_read_number(r, name, 1, 0, true, &r->config->absorption);
    case KEY_SCATTERING:
        return furnace_read_number(r, name, 1, 0, false, &r->config->scattering);
    case KEY_SOURCE:
        return lines_number(&r->lines, name, r->fields.at[1], &r->config->source);
    default:
        return furnace_read_wall(r);
    }
}

static int furnace_read_lines(struct reading *r) {
    for (;;) {
        bool more;
        int status = lines_next(&r->lines, &more);
        if (status || !more) return status;
        r->lines.text[strcspn(r->lines.text, "#")] = 0;
        status = fields_split(&r->fields, r->lines.text, " \t\v\f\r");
        if (!status && r->fields.n > 0) status = furnace_read_line(r);
        if (status) return status;
    }
}

static int furnace_check_complete(const struct reading *r) {
    double emissivity = 0;
    for (size_t k = 0; k < KEYS; k++)
        if (!r->line_of[k] && k != KEY_SCATTERING && k != KEY_SOURCE)
            return message_at(STATUS_INPUT, r->lines.name, 0, "%s is missing", keys[k].name);
    for (size_t w = 0; w < 6; w++) {
        if (!r->line_of_wall[w]) return message_at(STATUS_INPUT, r->lines.name, 0, "wall %s is missing", walls[w]);
        emissivity += r->config->wall_emissivity[w];
    }
    if (emissivity == 0)
        return message_at(STATUS_INPUT, r->lines.name, 0, "all walls have emissivity 0: nothing fixes the temperature");
    if (fibrad_furnace_size(r->config) > 0) return STATUS_OK;
    return message_at(STATUS_INPUT, r->lines.name, 0,
                      "sizes, coefficients times the edge of a cell, source or temperatures are out of range");
}

int read_furnace(const char *path, fibrad_furnace_config *config) {
    struct reading r = {.config = config};
    *config = (fibrad_furnace_config){0};
    int status = lines_open(&r.lines, path);
    if (!status) status = furnace_read_lines(&r);
    if (!status) status = furnace_check_complete(&r);
    free(r.fields.at);
    lines_close(&r.lines);
    return status;
}
