/* vtp_array.h - arrays of VTK's XML files, inline and binary. SPDX-License-Identifier: MIT
 *
 * An array is the base64 of its length in bytes (UInt64), followed by the values. */
#ifndef VTP_ARRAY_H
#define VTP_ARRAY_H

#include <stdint.h>
#include <stdio.h>

/* Writes the first lines of a file of points and cells. kind: Verts or Polys. VTP_END: the last lines. */
void vtp_head(FILE *file, uint32_t points, const char *kind, uint32_t cells);
#define VTP_END "</Piece>\n</PolyData>\n</VTKFile>\n"

/* A stream of bytes that is written as base64. */
struct base64 {
    FILE *file;
    uint32_t bits; /* bytes that are not written yet */
    int bytes;     /* their number, 0 to 2 */
};

/* Begins an array of `values` values of 8 bytes. Write the values, then call base64_end. */
struct base64 base64_begin(FILE *file, const char *type, const char *name, int components, uint64_t values);
void base64_bytes(struct base64 *to, const void *data, size_t size);
void base64_double(struct base64 *to, double value);
void base64_whole(struct base64 *to, int64_t value);
void base64_end(struct base64 *to);

/* Writes points, whose coordinates lie `stride` apart. */
void vtp_points(FILE *file, const double *x, const double *y, const double *z, size_t stride, uint32_t n);

/* Writes an array of whole numbers: first, first + step ... */
void vtp_ascending(FILE *file, const char *name, uint32_t n, int64_t first, int64_t step);

#endif
