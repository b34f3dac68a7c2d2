/* fuzz_read.c - libFuzzer target: any bytes as a bed file, in every format. SPDX-License-Identifier: MIT
 *
 * The first byte chooses what is asked of the reader, the others are the file. A bed that is read must be sound. */
#define _GNU_SOURCE
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "read/read.h"
#include "boxes/read_furnace.h"
#include "cli/targets.h"
#include "mesh/meshes.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* A bed that is read must be sound. Packed and binary files may have more spheres than bytes. */
static void check_bed(const struct bed *bed, bool radii) {
    if (bed->n == 0) abort();
    for (uint32_t i = 0; i < bed->n; i++) {
        if (!isfinite(bed->x[i] + bed->y[i] + bed->z[i])) abort();
        if (radii ? !(bed->r[i] > 0 && isfinite(bed->r[i])) : !isnan(bed->r[i])) abort();
        if (bed->ids && (bed->id[i] < 0 || (i > 0 && bed->id[i] <= bed->id[i - 1]))) abort();
    }
    for (size_t k = 0; k < bed->n * bed->extras; k++)
        if (!isfinite(bed->extra[k])) abort();
    for (int axis = 0; axis < 3; axis++)
        if (!(bed->period[axis] >= 0) || !(bed->low[axis] <= bed->high[axis])) abort();
}

/* Reads all frames that an input asks for: the last one, or a range. */
static void read_frames(const char *path, uint8_t asked, size_t size) {
    static const char *const extra[] = {"T", "mass"};
    static const struct frames frames[] = {{0, 0, 0}, {0, 9, 1}, {1, 8, 2}, {2, 3, 1}};
    const struct read_options options = {.frames = frames[asked % 4],
                                         .positions = (asked & 4) != 0,
                                         .extra = extra,
                                         .extras = asked & 8 ? 1 + (asked >> 4 & 1) : 0,
                                         .no_radius = (asked & 32) != 0};
    struct reader *reader;
    struct bed bed = bed_empty();
    bool more = true;
    size_t beds = 0;
    int status = reader_open(&reader, path, &options);
    while (status == 0 && (status = reader_next(reader, &bed, &more)) == 0 && more) {
        check_bed(&bed, !options.no_radius);
        if (++beds > size) abort();
    }
    if (status == 0 && beds == 0) abort();
    reader_close(reader);
    bed_free(&bed);
}

/* As a mesh: corners are there, triangles have three of them, each is in one part. */
static void read_mesh(const char *path, uint8_t asked) {
    static const double at[2] = {0, 1}, r[2] = {1, .5}, period[3] = {0};
    const fibrad_spheres spheres = {.x = at, .y = at, .z = at, .r = r, .n = 2};
    const struct mesh_file file = {
        .path = path, .sides = asked % 3, .solids = (asked & 4) != 0, .scale = asked & 8 ? 1e-3 : 1};
    struct meshes meshes = {0};
    if (meshes_add(&meshes, &file, asked >> 4) == 0) {
        const struct surface *s = &meshes.mesh[0].surface;
        uint32_t listed = 0;
        for (uint32_t t = 0; t < s->n; t++) {
            const uint32_t *c = s->corner[t];
            if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0] || s->component_of[t] >= s->components) abort();
            for (int k = 0; k < 9; k++)
                if (c[k / 3] >= s->vertices || !isfinite(s->vertex[c[k / 3]][k % 3])) abort();
        }
        for (uint32_t p = 0; p < s->components; p++) listed += s->component[p].n;
        if (s->n == 0 || listed != s->n || meshes_face(&meshes, &spheres, period) != 0) abort();
        for (uint32_t t = 0; t < s->n; t++)
            if (meshes.front[t] == FIBRAD_NO_BODY && meshes.back[t] == FIBRAD_NO_BODY) abort();
        (void)meshes_beyond(&meshes, (const double[]){3, 3, 3}, 1, period);
    }
    meshes_free(&meshes);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static int file = -1;
    char path[40];
    if (size == 0) return 0;
    if (file < 0) file = memfd_create("bed", 0);
    if (file < 0 || ftruncate(file, 0) != 0 || pwrite(file, data + 1, size - 1, 0) != (ssize_t)(size - 1)) abort();
    snprintf(path, sizeof path, "/proc/self/fd/%d", file);

    read_frames(path, data[0], size);
    read_mesh(path, data[0]);

    fibrad_furnace_config furnace;
    if (read_furnace(path, &furnace) == 0) {
        size_t bytes = fibrad_furnace_size(&furnace);
        void *memory = bytes > 0 && bytes < 1 << 20 ? malloc(bytes) : NULL;
        fibrad_furnace *box;
        if (memory != NULL && fibrad_furnace_init(&box, memory, bytes, &furnace) != 0) abort();
        free(memory);
    }

    char *text = strndup((const char *)data + 1, size - 1); /* the same as a list of targets */
    unsigned char marks[64] = {0};
    if (text == NULL) abort();
    (void)targets_mark(text, NULL, data[0] & 1 ? 64 : 0, "", marks);
    free(text);
    return 0;
}
