/* vtp.c - VTK XML polydata: one point and vertex per sphere. SPDX-License-Identifier: MIT
 *
 * Arrays are inline binary: base64 of their length in bytes (UInt64) followed by the values. Missing values are NaN,
 * which text arrays cannot hold. */
#include "write/vtp.h"

#include <inttypes.h>
#include <math.h>
#include <stdbool.h>

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

void vtp_doubles(FILE *file, const char *name, const double *values, uint32_t n, const unsigned char *valid) {
    struct base64 to = begin_array(file, "Float64", name, 1, n);
    for (uint32_t i = 0; i < n; ++i) put_double(&to, !valid || valid[i] ? values[i] : NAN);
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

void vtp_counts(FILE *file, const char *name, const int64_t *values, uint32_t n) {
    struct base64 to = begin_array(file, "Int64", name, 1, n);
    for (uint32_t i = 0; i < n; ++i) put_bytes(&to, &values[i], sizeof values[i]);
    end_array(&to);
}

void vtp_begin(FILE *file, const struct bed *bed, const char *scalars) {
    const uint16_t one = 1;
    const bool little = *(const unsigned char *)&one == 1;
    fprintf(file,
            "<?xml version=\"1.0\"?>\n"
            "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"%sEndian\" header_type=\"UInt64\">\n"
            "<PolyData>\n<Piece NumberOfPoints=\"%" PRIu32 "\" NumberOfVerts=\"%" PRIu32 "\">\n"
            "<PointData Scalars=\"%s\">\n",
            little ? "Little" : "Big", bed->n, bed->n, scalars);
    vtp_doubles(file, "radius", bed->r, bed->n, NULL);
}

void vtp_end(FILE *file, const struct bed *bed) {
    fputs("</PointData>\n<Points>\n", file);
    write_points(file, bed);
    fputs("</Points>\n<Verts>\n", file);
    write_count(file, "connectivity", bed->n, 0);
    write_count(file, "offsets", bed->n, 1);
    fputs("</Verts>\n</Piece>\n</PolyData>\n</VTKFile>\n", file);
}
