/* write_vtp.c - VTK XML polydata for ParaView: one point and vertex per sphere. SPDX-License-Identifier: MIT
 *
 * Arrays are inline binary: base64 of their length in bytes (UInt64) followed by the values. Missing values, such as
 * those of rows that were not computed, are NaN, which text arrays cannot hold. */
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#include "cli/interrupt.h"
#include "cli/message.h"
#include "write/write.h"

/* Base64 of a stream of bytes. */
struct base64 {
    FILE *file;
    uint32_t bits;
    int bytes; /* waiting in bits: 0 to 2 */
};

static void put_sextets(struct base64 *to, int count) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (int k = 0; k < 4; ++k) fputc(k < count ? digits[to->bits >> (18 - 6 * k) & 63] : '=', to->file);
    to->bits = 0;
    to->bytes = 0;
}

static void put_bytes(struct base64 *to, const void *data, size_t size) {
    for (const unsigned char *byte = data; size > 0; ++byte, --size) {
        to->bits |= (uint32_t)*byte << (16 - 8 * to->bytes);
        if (++to->bytes == 3) put_sextets(to, 4);
    }
}

static void put_double(struct base64 *to, double value) { put_bytes(to, &value, sizeof value); }

static struct base64 begin_array(FILE *file, const char *type, const char *name, int components, uint64_t values) {
    struct base64 to = {.file = file};
    const uint64_t bytes = values * 8;
    fprintf(file, "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" format=\"binary\">\n", type, name,
            components);
    put_bytes(&to, &bytes, sizeof bytes);
    return to;
}

static void end_array(struct base64 *to) {
    if (to->bytes) put_sextets(to, to->bytes + 1);
    fputs("\n</DataArray>\n", to->file);
}

/* An array of numbers; valid, unless NULL, tells which are there. */
static void vtp_doubles(FILE *file, const char *name, const double *values, uint32_t n, const unsigned char *valid) {
    struct base64 to = begin_array(file, "Float64", name, 1, n);
    for (uint32_t i = 0; i < n; ++i) put_double(&to, !valid || valid[i] ? values[i] : NAN);
    end_array(&to);
}

/* An array of whole numbers. */
static void vtp_counts(FILE *file, const char *name, const int64_t *values, uint32_t n) {
    struct base64 to = begin_array(file, "Int64", name, 1, n);
    for (uint32_t i = 0; i < n; ++i) put_bytes(&to, &values[i], sizeof values[i]);
    end_array(&to);
}

/* Connectivity (first = 0) or offsets (first = 1) of one vertex per point. */
static void write_count(FILE *file, const char *name, uint32_t n, int64_t first) {
    struct base64 to = begin_array(file, "Int64", name, 1, n);
    for (int64_t i = first; i < first + n; ++i) put_bytes(&to, &i, sizeof i);
    end_array(&to);
}

static void write_points(FILE *file, const struct bed *bed) {
    struct base64 to = begin_array(file, "Float64", "Points", 3, 3 * (uint64_t)bed->n);
    for (uint32_t i = 0; i < bed->n; ++i) {
        put_double(&to, bed->x[i]);
        put_double(&to, bed->y[i]);
        put_double(&to, bed->z[i]);
    }
    end_array(&to);
}

/* Begins a file of the spheres; their radii and ids are its first arrays, `scalars` the one that ParaView shows first.
 * Arrays of [bed->n] values follow, then vtp_end. */
static void vtp_begin(FILE *file, const struct bed *bed, const char *scalars) {
    const uint16_t one = 1;
    const bool little = *(const unsigned char *)&one == 1;
    fprintf(file,
            "<?xml version=\"1.0\"?>\n"
            "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"%sEndian\" header_type=\"UInt64\">\n"
            "<PolyData>\n<Piece NumberOfPoints=\"%" PRIu32 "\" NumberOfVerts=\"%" PRIu32 "\">\n"
            "<PointData Scalars=\"%s\">\n",
            little ? "Little" : "Big", bed->n, bed->n, scalars);
    vtp_doubles(file, "radius", bed->r, bed->n, NULL);
    if (bed->ids) vtp_counts(file, "id", bed->id, bed->n);
}

static void vtp_end(FILE *file, const struct bed *bed) {
    fputs("</PointData>\n<Points>\n", file);
    write_points(file, bed);
    fputs("</Points>\n<Verts>\n", file);
    write_count(file, "connectivity", bed->n, 0);
    write_count(file, "offsets", bed->n, 1);
    fputs("</Verts>\n</Piece>\n</PolyData>\n</VTKFile>\n", file);
}

static void vtp_row_sums(FILE *file, const struct contents *what, double *values) {
    for (uint32_t i = 0; i < what->bed->n; ++i) values[i] = summary_row(&what->factors->matrix, i);
    vtp_doubles(file, "row_sum", values, what->bed->n, what->wanted);
}

/* One array per wall, wall_zmin and the like. */
static void vtp_walls(FILE *file, const struct contents *what, double *values) {
    const fibrad_factors *matrix = &what->factors->matrix;
    for (uint32_t k = 0; what->walls && k < what->walls->count; ++k) {
        char body[BODY_NAME], name[BODY_NAME + 8];
        const char *known = contents_body(what, k, body);
        snprintf(name, sizeof name, "%s%s", known == body ? "" : "wall_", known);
        for (uint32_t i = 0; i < matrix->n; ++i) values[i] = matrix->body[(size_t)i * matrix->bodies + k];
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
    vtp_end(file, bed);
    return interrupt_status();
}
