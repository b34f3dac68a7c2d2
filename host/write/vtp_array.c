/* vtp_array.c - arrays of VTK's XML files, inline and binary. SPDX-License-Identifier: MIT */
#include "write/vtp_array.h"

#include <inttypes.h>
#include <stdbool.h>

void vtp_head(FILE *file, uint32_t points, const char *kind, uint32_t cells) {
    const uint16_t one = 1;
    const bool little = *(const unsigned char *)&one == 1;
    fprintf(file,
            "<?xml version=\"1.0\"?>\n"
            "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"%sEndian\" header_type=\"UInt64\">\n"
            "<PolyData>\n<Piece NumberOfPoints=\"%" PRIu32 "\" NumberOf%s=\"%" PRIu32 "\">\n",
            little ? "Little" : "Big", points, kind, cells);
}

static void put_sextets(struct base64 *to, int count) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (int k = 0; k < 4; ++k) fputc(k < count ? digits[to->bits >> (18 - 6 * k) & 63] : '=', to->file);
    to->bits = 0;
    to->bytes = 0;
}

void base64_bytes(struct base64 *to, const void *data, size_t size) {
    for (const unsigned char *byte = data; size > 0; ++byte, --size) {
        to->bits |= (uint32_t)*byte << (16 - 8 * to->bytes);
        if (++to->bytes == 3) put_sextets(to, 4);
    }
}

void base64_double(struct base64 *to, double value) { base64_bytes(to, &value, sizeof value); }

void base64_whole(struct base64 *to, int64_t value) { base64_bytes(to, &value, sizeof value); }

struct base64 base64_begin(FILE *file, const char *type, const char *name, int components, uint64_t values) {
    struct base64 to = {.file = file};
    const uint64_t bytes = values * 8;
    fprintf(file, "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" format=\"binary\">\n", type, name,
            components);
    base64_bytes(&to, &bytes, sizeof bytes);
    return to;
}

void base64_end(struct base64 *to) {
    if (to->bytes) put_sextets(to, to->bytes + 1);
    fputs("\n</DataArray>\n", to->file);
}

void vtp_points(FILE *file, const double *x, const double *y, const double *z, size_t stride, uint32_t n) {
    struct base64 to = base64_begin(file, "Float64", "Points", 3, 3 * (uint64_t)n);
    for (size_t at = 0; at < n * stride; at += stride) {
        base64_double(&to, x[at]);
        base64_double(&to, y[at]);
        base64_double(&to, z[at]);
    }
    base64_end(&to);
}

void vtp_ascending(FILE *file, const char *name, uint32_t n, int64_t first, int64_t step) {
    struct base64 to = base64_begin(file, "Int64", name, 1, n);
    for (int64_t i = 0; i < n; ++i) base64_whole(&to, first + i * step);
    base64_end(&to);
}
