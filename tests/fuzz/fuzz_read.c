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

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static int file = -1;
    char path[40];
    if (size == 0) return 0;
    if (file < 0) file = memfd_create("bed", 0);
    if (file < 0 || ftruncate(file, 0) != 0 || pwrite(file, data + 1, size - 1, 0) != (ssize_t)(size - 1)) abort();
    snprintf(path, sizeof path, "/proc/self/fd/%d", file);

    static const char *const extra[] = {"T", "mass"};
    struct read_options options = {.frames = {.end = data[0] % 4},
                                   .positions = (data[0] & 4) != 0,
                                   .extra = extra,
                                   .extras = data[0] >> 3 & 1 ? 2 : 0};
    struct bed bed;
    if (read_bed(path, &options, &bed) == 0) {
        if (bed.n == 0 || bed.n > size) abort();
        for (uint32_t i = 0; i < bed.n; i++)
            if (!isfinite(bed.x[i] + bed.y[i] + bed.z[i]) || !(bed.r[i] > 0 && isfinite(bed.r[i])) || bed.line[i] == 0)
                abort();
    }
    bed_free(&bed);

    fibrad_furnace_config furnace;
    if (read_furnace(path, &furnace) == 0) {
        size_t bytes = fibrad_furnace_size(&furnace);
        void *memory = bytes > 0 && bytes < 1 << 20 ? aligned_alloc(64, bytes) : NULL;
        fibrad_furnace *box;
        if (memory != NULL && fibrad_furnace_init(&box, memory, bytes, &furnace) != 0) abort();
        free(memory);
    }

    char *text = strndup((const char *)data + 1, size - 1); /* the same as a list of targets */
    unsigned char marks[64] = {0};
    if (text == NULL) abort();
    (void)targets_mark(text, NULL, data[0] & 1 ? 64 : 0, marks);
    free(text);
    return 0;
}
