/* read_npz.c - example: reads a matrix of view factors from .npz and prints it. SPDX-License-Identifier: MIT
 *
 *     cc -std=c11 docs/examples/read_npz.c -o read_npz
 *     build/fibrad factors packing.dump -o F.npz && ./read_npz F.npz
 *
 * Reads what `fibrad factors -o OUT.npz` writes, on a machine of the same byte order: uncompressed members one behind
 * the other, each a NumPy array. Rows and columns go by the spheres' ids. Member sizes are 64-bit numbers in an extra
 * field. Checksums are not looked at. */
#include <inttypes.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void refuse(const char *why) {
    fprintf(stderr, "read_npz: %s\n", why);
    exit(1);
}

static void take(FILE *file, void *to, size_t bytes) {
    if (fread(to, 1, bytes, file) != bytes) refuse("the file ends too early");
}

/* A number of up to 8 bytes, the lowest first. */
static uint64_t number(const unsigned char *from, int bytes) {
    uint64_t value = 0;
    while (bytes-- > 0) value = value << 8 | from[bytes];
    return value;
}

/* The next member: its name, the type of its elements and its data, to be freed; false after the last. */
static int next_member(FILE *file, char name[256], char type[8], void **data, uint64_t *bytes) {
    unsigned char head[30], extra[20], magic[10];
    char text[1024] = "";
    take(file, head, sizeof head);
    if (number(head, 4) != 0x04034b50) return 0; /* the directory begins */
    const size_t name_length = number(head + 26, 2);
    if (number(head + 8, 2) != 0 || name_length > 255 || number(head + 28, 2) != sizeof extra)
        refuse("not written by fibrad");
    take(file, name, name_length);
    name[name_length] = 0;
    take(file, extra, sizeof extra);
    take(file, magic, sizeof magic);
    const size_t text_length = number(magic + 8, 2);
    if (memcmp(magic, "\x93NUMPY\1", 8) != 0 || text_length >= sizeof text) refuse("not a NumPy array");
    take(file, text, text_length);
    const uint64_t size = number(extra + 4, 8);
    if (size < sizeof magic + text_length || sscanf(text, "{'descr': '%7[^']'", type) != 1) refuse("bad array");
    *bytes = size - sizeof magic - text_length;
    *data = *bytes > SIZE_MAX - 1 ? NULL : malloc((size_t)*bytes + 1);
    if (!*data) refuse("out of memory");
    take(file, *data, (size_t)*bytes);
    return 1;
}

int main(int argc, char **argv) {
    FILE *file = argc == 2 ? fopen(argv[1], "rb") : NULL;
    if (!file) refuse("usage: read_npz F.npz");
    int32_t *col = NULL;
    int64_t *start = NULL;
    double *f = NULL;
    uint64_t *ids = NULL;
    uint64_t rows = 0, entries = 0, factors = 0, names = 0;
    char name[256], type[8];
    void *data;
    for (uint64_t bytes; next_member(file, name, type, &data, &bytes);) {
        if (strcmp(name, "indices.npy") == 0 && strcmp(type, "<i4") == 0)
            col = data, entries = bytes / sizeof *col;
        else if (strcmp(name, "indptr.npy") == 0 && strcmp(type, "<i8") == 0 && bytes >= sizeof *start)
            start = data, rows = bytes / sizeof *start - 1;
        else if (strcmp(name, "data.npy") == 0 && strcmp(type, "<f8") == 0)
            f = data, factors = bytes / sizeof *f;
        else if (strcmp(name, "ids.npy") == 0 && (strcmp(type, "<i8") == 0 || strcmp(type, "<u8") == 0))
            ids = data, names = bytes / sizeof *ids;
        else
            free(data);
    }
    fclose(file);
    if (!col || !start || !f || !ids || names != rows || entries != factors || (uint64_t)start[rows] != entries)
        refuse("not a matrix");

    puts("i,j,F");
    for (uint64_t i = 0; i < rows; ++i) {
        if (start[i] < 0 || start[i] > start[i + 1] || (uint64_t)start[i + 1] > entries) refuse("not a matrix");
        for (int64_t k = start[i]; k < start[i + 1]; ++k) {
            if (col[k] < 0 || (uint64_t)col[k] >= rows) refuse("not a matrix");
            printf("%" PRIu64 ",%" PRIu64 ",%.17g\n", ids[i], ids[col[k]], f[k]);
        }
    }
    free(col);
    free(start);
    free(f);
    free(ids);
    return 0;
}
