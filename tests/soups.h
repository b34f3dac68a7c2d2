/* soups.h - triangles for tests, and STL files of them. SPDX-License-Identifier: MIT */
#ifndef TESTS_SOUPS_H
#define TESTS_SOUPS_H

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <zlib.h>

#include "program.h"

enum { SOUP_MOST = 4096 };
struct soup {
    uint32_t n;
    double corner[SOUP_MOST][3][3];
};

static inline void soup_add(struct soup *soup, const double a[3], const double b[3], const double c[3]) {
    const double *const corner[3] = {a, b, c};
    ck_assert_uint_lt(soup->n, SOUP_MOST);
    for (int k = 0; k < 3; ++k) memcpy(soup->corner[soup->n][k], corner[k], sizeof soup->corner[0][0]);
    ++soup->n;
}

/* Adds a box whose fronts are outside. */
static inline void soup_box(struct soup *soup, const double low[3], const double high[3]) {
    static const int face[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    double v[8][3];
    for (int k = 0; k < 8; ++k)
        for (int axis = 0; axis < 3; ++axis) v[k][axis] = k >> axis & 1 ? high[axis] : low[axis];
    for (int f = 0; f < 6; ++f) {
        soup_add(soup, v[face[f][0]], v[face[f][1]], v[face[f][2]]);
        soup_add(soup, v[face[f][0]], v[face[f][2]], v[face[f][3]]);
    }
}

static inline void soup_cube(struct soup *soup, double half) {
    soup_box(soup, (const double[]){-half, -half, -half}, (const double[]){half, half, half});
}

/* Adds a cone of n facets about z, open at both ends, whose fronts are outside. */
static inline void soup_cone(struct soup *soup, double x, double y, const double z[2], const double radius[2], int n) {
    for (int k = 0; k < n; ++k) {
        double p[4][3];
        for (int c = 0; c < 4; ++c) {
            const double angle = 2 * PI * (k + c % 2) / n;
            p[c][0] = x + radius[c / 2] * cos(angle), p[c][1] = y + radius[c / 2] * sin(angle), p[c][2] = z[c / 2];
        }
        soup_add(soup, p[0], p[1], p[3]);
        soup_add(soup, p[0], p[3], p[2]);
    }
}

/* Swaps corners of some triangles: half of them, or all. */
static inline void soup_flip(struct soup *soup, int all) {
    for (uint32_t t = 0; t < soup->n; ++t) {
        double kept[3];
        if (!all && rand() % 2) continue;
        memcpy(kept, soup->corner[t][1], sizeof kept);
        memcpy(soup->corner[t][1], soup->corner[t][2], sizeof kept);
        memcpy(soup->corner[t][2], kept, sizeof kept);
    }
}

/* Writes a binary file with `bytes` bytes too many or, if negative, too few. */
static inline const char *write_binary(const char *name, const struct soup *soup, const char *head, long bytes) {
    static unsigned char data[84 + 50 * SOUP_MOST + 100];
    const char *path = in_folder(name);
    memset(data, 0, sizeof data);
    strncpy((char *)data, head, 80);
    for (int k = 0; k < 4; ++k) data[80 + k] = (unsigned char)(soup->n >> 8 * k);
    for (uint32_t t = 0; t < soup->n; ++t)
        for (int k = 0; k < 9; ++k) {
            const float value = (float)soup->corner[t][k / 3][k % 3];
            uint32_t bits;
            memcpy(&bits, &value, sizeof bits);
            for (int b = 0; b < 4; ++b) data[84 + 50 * t + 12 + 4 * (uint32_t)k + (uint32_t)b] = bits >> 8 * b & 255;
        }
    OWNED_FILE *file = opened(path, "wb");
    const size_t size = (size_t)(84 + 50 * (long)soup->n + bytes);
    ck_assert_uint_eq(fwrite(data, 1, size, file), size);
    return path;
}

/* Writes a file of text. `end` ends the lines. Numbers have `digits` digits. */
static inline void print_solid(FILE *file, const char *name, const struct soup *soup, const char *end, int digits) {
    fprintf(file, "solid %s%s", name, end);
    for (uint32_t t = 0; t < soup->n; ++t) {
        fprintf(file, "  facet normal 0 0 0%s    OUTER loop%s", end, end);
        for (int k = 0; k < 3; ++k)
            fprintf(file, "      vertex\t%.*g %.*g  %.*g%s", digits, soup->corner[t][k][0], digits,
                    soup->corner[t][k][1], digits, soup->corner[t][k][2], end);
        fprintf(file, "    endloop%s  endfacet%s", end, end);
    }
    fprintf(file, "endsolid %s%s", name, end);
}

static inline const char *write_solid(const char *name, const struct soup *soup) {
    const char *path = in_folder(name);
    OWNED_FILE *file = opened(path, "w");
    print_solid(file, "part", soup, "\n", 17);
    return path;
}

/* Writes the same bytes, packed by gzip. */
static inline const char *pack_file(const char *name, const char *from) {
    const char *path = in_folder(name);
    char block[4096];
    FILE *in = fopen(from, "rb");
    gzFile out = gzopen(path, "wb");
    ck_assert(in != NULL && out != NULL);
    for (size_t got; (got = fread(block, 1, sizeof block, in)) > 0;)
        ck_assert_int_eq(gzwrite(out, block, (unsigned)got), (int)got);
    fclose(in);
    ck_assert_int_eq(gzclose(out), Z_OK);
    return path;
}

#endif
