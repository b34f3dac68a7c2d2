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
#include "papers/furnace/furnace.h"
#include "cli/targets.h"
#include "mesh/meshes.h"
#include "text/read_curve.h"
#include "text/unit.h"

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
    static const char *const unit[] = {"K", "W/(m K)"};
    static const struct frames frames[] = {{0, 0, 0}, {0, 9, 1}, {1, 8, 2}, {2, 3, 1}};
    static const struct column_name of_tables[] = {{"x", "1"}, {"y", "2 [mm]"}, {"z", "3"}, {"d", "4"}},
                                    of_codes[] = {{"r", "size"}, {"T", "heat [C]"}, {"id", "tag"}};
    static const struct row_rule rule[] = {{"type", "1", false}, {"mass", "2.0", true}};
    struct read_options options = {.frames = frames[asked % 4], .positions = (asked & 4) != 0, .extra = extra};
    options.extras = asked & 8 ? 1 + (asked >> 4 & 1) : 0, options.unit = asked & 128 ? unit : NULL;
    options.name = asked & 16 ? of_tables : of_codes, options.names = !(asked & 64) ? 0 : asked & 16 ? 4 : 3;
    options.rule = rule, options.rules = (asked & 192) == 128 ? 2 : 0, options.any_unit = (asked & 128) == 0;
    options.no_radius = (asked & 32) != 0;
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

/* As a table of two columns, and of one: x ascends, y is within its bounds. */
static void read_tables(const char *path, uint8_t asked) {
    static const struct curve_axes law = {CURVE_AXIS_KELVINS, {"e k lambda", "W/(m K)"}};
    const struct curve_axes *axes[] = {&curve_kelvins, &curve_celsius, &curve_values, &law};
    struct curve curve;
    for (int one = 0; one < 2; one++) {
        const int status = one ? column_read(path, "T", &axes[asked % 4]->y, -273, 1e9, &curve)
                               : curve_read(path, "T", axes[asked % 4], -273, 1e9, &curve);
        if (status == 0 && curve.n == 0) abort();
        for (size_t k = 0; status == 0 && k < curve.n; k++) {
            if (!(curve.y[k] >= -273 && curve.y[k] <= 1e9) || !isfinite(curve.x[k])) abort();
            if (!one && k > 0 && !(curve.x[k] > curve.x[k - 1])) abort();
        }
        curve_free(&curve);
    }
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
            if (meshes.front[t] == FIBRAD_NO_WALL && meshes.back[t] == FIBRAD_NO_WALL) abort();
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
    read_tables(path, data[0]);

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
    double factor; /* and as a unit */
    if (unit_factor(text, "W/(m K)", &factor) && !isfinite(factor)) abort();
    free(text);
    return 0;
}
