/* scratch.c - blocks that grow, on the heap or in files. SPDX-License-Identifier: MIT
 *
 * A file is mapped, so that rows and matrices in it are used as those in memory are, and the system writes out what
 * does not fit. Its room on the disk is taken before it is mapped: a full disk is an error, not a signal. */
#include "simple/scratch.h"

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

int fibrad_scratch_open(fibrad_scratch *scratch, const char *folder) {
    static const char name[] = "/fibrad.XXXXXX";
    *scratch = (fibrad_scratch){0};
    if (!folder) return FIBRAD_OK;
    const size_t length = strlen(folder);
    char *path = malloc(length + sizeof name);
    if (!path) return FIBRAD_E_MEMORY;
    memcpy(path, folder, length);
    memcpy(path + length, name, sizeof name);
    scratch->file = mkstemp(path);
    scratch->filed = scratch->file >= 0;
    if (scratch->filed) {
        unlink(path);
        fcntl(scratch->file, F_SETFD, FD_CLOEXEC);
    }
    free(path);
    return scratch->filed ? FIBRAD_OK : FIBRAD_E_ARGUMENT;
}

void fibrad_scratch_close(fibrad_scratch *scratch) {
    if (!scratch->filed) {
        free(scratch->block);
    } else {
        if (scratch->block) munmap(scratch->block, scratch->size);
        close(scratch->file);
    }
    *scratch = (fibrad_scratch){0};
}

/* The larger file; the old mapping stays until the new one is there. */
static void *map_larger(const fibrad_scratch *scratch, size_t size) {
    const off_t length = (off_t)size;
    if (length < 0 || (size_t)length != size || posix_fallocate(scratch->file, 0, length) != 0) return NULL;
    void *block = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_SHARED, scratch->file, 0);
    if (block == MAP_FAILED) return NULL;
    if (scratch->block) munmap(scratch->block, scratch->size);
    return block;
}

void *fibrad_scratch_resize(void *context, void *block, size_t size) {
    fibrad_scratch *scratch = context;
    void *larger = scratch->filed ? map_larger(scratch, size) : fibrad_heap_resize(NULL, block, size);
    if (larger) scratch->block = larger, scratch->size = size;
    return larger;
}
