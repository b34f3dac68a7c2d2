/* block.h - memory on the heap that grows and is reused. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_COUPLE_BLOCK_H
#define FIBRAD_COUPLE_BLOCK_H

#include <stdlib.h>

#include "fibrad.h"

/* Memory on the heap. Begin with zeroes; free with fibrad_block_free. */
typedef struct fibrad_block {
    void *at;
    size_t size; /* bytes */
} fibrad_block;

/* Makes room for `count` elements of `size` bytes and keeps the contents. Returns FIBRAD_OK, or _E_MEMORY with the
 * block unchanged. */
static inline int fibrad_block_fit(fibrad_block *block, size_t count, size_t size) {
    const size_t needed = (count + 1) * size; /* never NULL */
    if (needed > block->size) {
        void *at = realloc(block->at, needed + needed / 4);
        if (!at) return FIBRAD_E_MEMORY;
        block->at = at;
        block->size = needed + needed / 4;
    }
    return FIBRAD_OK;
}

/* Gives back the memory that is more than `count` elements of `size` bytes need. */
static inline void fibrad_block_trim(fibrad_block *block, size_t count, size_t size) {
    void *at = realloc(block->at, (count + 1) * size);
    if (!at) return;
    block->at = at;
    block->size = (count + 1) * size;
}

static inline void fibrad_block_free(fibrad_block *block) {
    free(block->at);
    *block = (fibrad_block){0};
}

#endif
