/* write_vtp.c - the bed for ParaView: VTK XML polydata, one point and vertex per sphere. SPDX-License-Identifier: MIT
 *
 * Arrays are inline binary: base64 of their length in bytes (UInt64) followed by the values. Rows that were not
 * computed have NaN, which text arrays cannot hold. */
#include <inttypes.h>
#include <math.h>

#include "interrupt.h"
#include "message.h"
#include "write.h"

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

static void put(struct base64 *to, const void *data, size_t size) {
    for (const unsigned char *byte = data; size > 0; ++byte, --size) {
        to->bits |= (uint32_t)*byte << (16 - 8 * to->bytes);
        if (++to->bytes == 3) put_sextets(to, 4);
    }
}

static void put_double(struct base64 *to, double value) { put(to, &value, sizeof value); }

static struct base64 begin(FILE *file, const char *type, const char *name, int components, uint64_t values) {
    struct base64 to = {.file = file};
    const uint64_t bytes = values * 8;
    fprintf(file, "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" format=\"binary\">\n", type, name,
            components);
    put(&to, &bytes, sizeof bytes);
    return to;
}

static void end(struct base64 *to) {
    if (to->bytes) put_sextets(to, to->bytes + 1);
    fputs("\n</DataArray>\n", to->file);
}

static void write_doubles(FILE *file, const char *name, const double *values, uint32_t n, const bool *valid) {
    struct base64 to = begin(file, "Float64", name, 1, n);
    for (uint32_t i = 0; i < n; ++i) put_double(&to, !valid || valid[i] ? values[i] : NAN);
    end(&to);
}

/* Connectivity (first = 0) or offsets (first = 1) of one vertex per point. */
static void write_count(FILE *file, const char *name, uint32_t n, int64_t first) {
    struct base64 to = begin(file, "Int64", name, 1, n);
    for (int64_t i = first; i < first + n; ++i) put(&to, &i, sizeof i);
    end(&to);
}

static void write_points(FILE *file, const struct bed *bed) {
    struct base64 to = begin(file, "Float64", "Points", 3, 3 * (uint64_t)bed->n);
    for (uint32_t i = 0; i < bed->n; ++i) {
        put_double(&to, bed->x[i]);
        put_double(&to, bed->y[i]);
        put_double(&to, bed->z[i]);
    }
    end(&to);
}

/* One array per wall, wall_zmin and the like. */
static void write_walls(FILE *file, const struct contents *what) {
    for (uint32_t k = 0; what->walls && k < what->walls->count; ++k) {
        const uint32_t wall = what->walls->wall[k], n = what->bed->n;
        char name[32];
        snprintf(name, sizeof name, "wall_%s", wall_name(wall));
        struct base64 to = begin(file, "Float64", name, 1, n);
        for (uint32_t i = 0; i < n; ++i) put_double(&to, what->result->wanted[i] ? what->result->wall[i][wall] : NAN);
        end(&to);
    }
}

static void write_neighbours(FILE *file, const fibrad_rows *rows) {
    struct base64 to = begin(file, "Int64", "neighbours", 1, rows->n);
    for (uint32_t i = 0; i < rows->n; ++i) {
        const int64_t count = (int64_t)(rows->start[i + 1] - rows->start[i]);
        put(&to, &count, sizeof count);
    }
    end(&to);
}

int write_vtp(FILE *file, const struct contents *what) {
    const struct bed *bed = what->bed;
    const struct result *result = what->result;
    const uint16_t one = 1;
    const bool little = *(const unsigned char *)&one == 1;
    fprintf(file,
            "<?xml version=\"1.0\"?>\n"
            "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"%sEndian\" header_type=\"UInt64\">\n"
            "<PolyData>\n<Piece NumberOfPoints=\"%" PRIu32 "\" NumberOfVerts=\"%" PRIu32 "\">\n"
            "<PointData Scalars=\"row_sum\">\n",
            little ? "Little" : "Big", bed->n, bed->n);
    write_doubles(file, "radius", bed->r, bed->n, NULL);
    write_doubles(file, "row_sum", result->row_sum, bed->n, result->wanted);
    write_doubles(file, "escaped", result->escaped, bed->n, result->wanted);
    write_walls(file, what);
    write_neighbours(file, &result->rows);
    fputs("</PointData>\n<Points>\n", file);
    write_points(file, bed);
    fputs("</Points>\n<Verts>\n", file);
    write_count(file, "connectivity", bed->n, 0);
    write_count(file, "offsets", bed->n, 1);
    fputs("</Verts>\n</Piece>\n</PolyData>\n</VTKFile>\n", file);
    return interrupt_status();
}
