/* reserve.c - makes a caller's block of memory large enough. SPDX-License-Identifier: MIT */
#include "base/arena.h"

int fibrad_memory_reserve(fibrad_memory *memory, size_t needed) {
    if (needed <= memory->size && memory->block != NULL) return FIBRAD_OK;
    memory->needed = needed;
    if (memory->resize == NULL) return FIBRAD_E_CAPACITY;
    const size_t size = needed < SIZE_MAX / 2 ? 2 * needed : needed;
    void *block = memory->resize(memory->context, memory->block, size);
    if (block == NULL) return FIBRAD_E_MEMORY;
    memory->block = block;
    memory->size = size;
    return FIBRAD_OK;
}
