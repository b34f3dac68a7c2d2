/* write_vtp.c - VTK XML polydata for ParaView, with one point and vertex per sphere. SPDX-License-Identifier: MIT
 *
 * Missing values, such as those of rows that were not computed, are NaN. Arrays of text could not hold NaN, so arrays
 * are binary. */
#include <math.h>

#include "cli/message.h"
#include "write/vtp_array.h"
#include "write/write.h"

/* Writes an array of n numbers that lie `stride` apart. valid [n]: 0: the value is missing; NULL: none is missing. */
static void vtp_doubles(FILE *file, const char *name, const double *values, uint32_t n, size_t stride,
                        const unsigned char *valid) {
    struct base64 to = base64_begin(file, "Float64", name, 1, n);
    for (uint32_t i = 0; i < n; ++i) base64_double(&to, !valid || valid[i] ? values[i * stride] : NAN);
    base64_end(&to);
}

/* Begins a file of spheres, with radii and ids as its first arrays. scalars: the array that ParaView shows first. Write
 * further arrays of [bed->n] values, then call vtp_end. */
static void vtp_begin(FILE *file, const struct bed *bed, const char *scalars) {
    vtp_head(file, bed->n, "Verts", bed->n);
    fprintf(file, "<PointData Scalars=\"%s\">\n", scalars);
    vtp_doubles(file, "radius", bed->r, bed->n, 1, NULL);
    if (!bed->ids) return;
    struct base64 to = base64_begin(file, "Int64", "id", 1, bed->n);
    base64_bytes(&to, bed->id, bed->n * sizeof *bed->id);
    base64_end(&to);
}

static void vtp_end(FILE *file, const struct bed *bed) {
    fputs("</PointData>\n<Points>\n", file);
    vtp_points(file, bed->x, bed->y, bed->z, 1, bed->n);
    fputs("</Points>\n<Verts>\n", file);
    vtp_ascending(file, "connectivity", bed->n, 0, 1);
    vtp_ascending(file, "offsets", bed->n, 1, 1);
    fputs("</Verts>\n" VTP_END, file);
}

int write_vtp(FILE *file, const struct contents *what) {
    const struct bed *bed = what->bed;
    const fibrad_factors *matrix = &what->factors->matrix;
    vtp_begin(file, bed, "row_sum");
    struct base64 to = base64_begin(file, "Float64", "row_sum", 1, bed->n);
    for (uint32_t i = 0; i < bed->n; ++i)
        base64_double(&to, !what->wanted || what->wanted[i] ? summary_row(matrix, i) : NAN);
    base64_end(&to);
    vtp_doubles(file, "escaped", matrix->escaped, bed->n, 1, what->wanted);
    vtp_doubles(file, "beyond", matrix->beyond, bed->n, 1, what->wanted);
    vtp_doubles(file, "error", matrix->error, bed->n, 1, what->wanted);
    for (uint32_t k = 0; what->walls && k < what->walls->count; ++k) {
        char wall[WALL_NAME], name[WALL_NAME + 8]; /* such as wall_zmin */
        const char *known = contents_wall(what, k, wall);
        snprintf(name, sizeof name, "%s%s", known == wall ? "" : "wall_", known);
        vtp_doubles(file, name, matrix->wall + k, bed->n, matrix->walls, what->wanted);
    }
    to = base64_begin(file, "Int64", "neighbours", 1, bed->n);
    for (uint32_t i = 0; i < bed->n; ++i) base64_whole(&to, (int64_t)(matrix->start[i + 1] - matrix->start[i]));
    base64_end(&to);
    vtp_end(file, bed);
    return interrupt_status();
}

int write_heat_vtp(FILE *file, const struct contents *what) {
    const struct bed *bed = what->bed;
    struct heat_column column[HEAT_COLUMNS];
    vtp_begin(file, bed, "power_W");
    vtp_doubles(file, "temperature_K", what->result->temperature, bed->n, 1, NULL);
    vtp_doubles(file, "emissivity", what->sources->emissivity, bed->n, 1, NULL);
    vtp_doubles(file, "power_W", what->result->power, bed->n, 1, NULL);
    heat_columns(what, column);
    for (int k = HEAT_INSIDE; k < HEAT_COLUMNS; ++k) {
        if (!column[k].value || k == HEAT_LIGHT) continue;
        struct base64 to = base64_begin(file, "Float64", column[k].name, 1, bed->n);
        for (uint32_t i = 0; i < bed->n; ++i) base64_double(&to, heat_value(&column[k], i));
        base64_end(&to);
    }
    vtp_end(file, bed);
    return interrupt_status();
}
