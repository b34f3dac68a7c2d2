/* write_vtp.c - VTK XML polydata for ParaView, with one point and vertex per sphere. SPDX-License-Identifier: MIT
 *
 * Missing values, such as those of rows that were not computed, are NaN. Arrays of text could not hold NaN, so arrays
 * are binary. */
#include <math.h>
#include <stdlib.h>

#include "cli/interrupt.h"
#include "cli/message.h"
#include "write/vtp_array.h"
#include "write/write.h"

/* Writes an array of numbers. valid [n]: 0: the value is missing; valid NULL: none is missing. */
static void vtp_doubles(FILE *file, const char *name, const double *values, uint32_t n, const unsigned char *valid) {
    struct base64 to = base64_begin(file, "Float64", name, 1, n);
    for (uint32_t i = 0; i < n; ++i) base64_double(&to, !valid || valid[i] ? values[i] : NAN);
    base64_end(&to);
}

/* Writes an array of a - b. */
static void vtp_difference(FILE *file, const char *name, const double *a, const double *b, uint32_t n) {
    struct base64 to = base64_begin(file, "Float64", name, 1, n);
    for (uint32_t i = 0; i < n; ++i) base64_double(&to, a[i] - b[i]);
    base64_end(&to);
}

static void write_points(FILE *file, const struct bed *bed) {
    struct base64 to = base64_begin(file, "Float64", "Points", 3, 3 * (uint64_t)bed->n);
    for (uint32_t i = 0; i < bed->n; ++i) {
        base64_double(&to, bed->x[i]);
        base64_double(&to, bed->y[i]);
        base64_double(&to, bed->z[i]);
    }
    base64_end(&to);
}

/* Begins a file of spheres, with radii and ids as its first arrays. scalars: the array that ParaView shows first. Write
 * further arrays of [bed->n] values, then call vtp_end. */
static void vtp_begin(FILE *file, const struct bed *bed, const char *scalars) {
    vtp_head(file, bed->n, "Verts", bed->n);
    fprintf(file, "<PointData Scalars=\"%s\">\n", scalars);
    vtp_doubles(file, "radius", bed->r, bed->n, NULL);
    if (bed->ids) vtp_counts(file, "id", bed->id, bed->n);
}

static void vtp_end(FILE *file, const struct bed *bed) {
    fputs("</PointData>\n<Points>\n", file);
    write_points(file, bed);
    fputs("</Points>\n<Verts>\n", file);
    vtp_ascending(file, "connectivity", bed->n, 0, 1);
    vtp_ascending(file, "offsets", bed->n, 1, 1);
    fputs("</Verts>\n" VTP_END, file);
}

static void vtp_row_sums(FILE *file, const struct contents *what, double *values) {
    for (uint32_t i = 0; i < what->bed->n; ++i) values[i] = summary_row(&what->factors->matrix, i);
    vtp_doubles(file, "row_sum", values, what->bed->n, what->wanted);
}

/* Writes an array per wall, such as wall_zmin. */
static void vtp_walls(FILE *file, const struct contents *what, double *values) {
    const fibrad_factors *matrix = &what->factors->matrix;
    for (uint32_t k = 0; what->walls && k < what->walls->count; ++k) {
        char wall[WALL_NAME], name[WALL_NAME + 8];
        const char *known = contents_wall(what, k, wall);
        snprintf(name, sizeof name, "%s%s", known == wall ? "" : "wall_", known);
        for (uint32_t i = 0; i < matrix->n; ++i) values[i] = matrix->wall[(size_t)i * matrix->walls + k];
        vtp_doubles(file, name, values, matrix->n, what->wanted);
    }
}

int write_vtp(FILE *file, const struct contents *what, bool first) {
    const struct bed *bed = what->bed;
    const fibrad_factors *matrix = &what->factors->matrix;
    int64_t *count = malloc(bed->n * sizeof *count + 1);
    double *values = malloc(bed->n * sizeof *values + 1);
    (void)first;
    if (count && values) {
        for (uint32_t i = 0; i < bed->n; ++i) count[i] = (int64_t)(matrix->start[i + 1] - matrix->start[i]);
        vtp_begin(file, bed, "row_sum");
        vtp_row_sums(file, what, values);
        vtp_doubles(file, "escaped", matrix->escaped, bed->n, what->wanted);
        vtp_doubles(file, "beyond", matrix->beyond, bed->n, what->wanted);
        vtp_doubles(file, "error", matrix->error, bed->n, what->wanted);
        vtp_walls(file, what, values);
        vtp_counts(file, "neighbours", count, bed->n);
        vtp_end(file, bed);
    }
    const int status = count && values ? interrupt_status() : message_memory();
    free(count);
    free(values);
    return status;
}

int write_heat_vtp(FILE *file, const struct contents *what, bool first) {
    const struct bed *bed = what->bed;
    (void)first;
    vtp_begin(file, bed, "power_W");
    vtp_doubles(file, "temperature_K", what->result->temperature, bed->n, NULL);
    vtp_doubles(file, "emissivity", what->sources->emissivity, bed->n, NULL);
    vtp_doubles(file, "power_W", what->result->power, bed->n, NULL);
    if (what->light) vtp_doubles(file, "absorbed_W", what->light->absorbed, bed->n, NULL);
    if (what->result->conducted) {
        vtp_difference(file, "q_radiation_W", what->result->power, what->result->conducted, bed->n);
        vtp_doubles(file, "q_conduction_W", what->result->conducted, bed->n, NULL);
    }
    for (size_t k = 0; k < INSIDE_COLUMNS && what->result->least_temperature; ++k)
        vtp_doubles(file, (const char *[]){INSIDE_NAMES}[k], contents_inside(what, k), bed->n, NULL);
    vtp_end(file, bed);
    return interrupt_status();
}
