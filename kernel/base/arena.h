/* arena.h - lays objects out in the caller's memory. SPDX-License-Identifier: MIT
 *
 * Each object has one layout function, which takes its arrays from an arena. If the base of the arena is NULL, the
 * arena only counts bytes: this is the object's `_size`. If the base is the caller's block, the arena returns
 * addresses: this is its `_init`. So the two always agree. */
#ifndef FIBRAD_BASE_ARENA_H
#define FIBRAD_BASE_ARENA_H

#include "fibrad.h"
#include "base/port.h"

/* ---- lays objects out in the caller's memory --------------------------------------------------------------------- */

/* Each array begins at a multiple of this number and is padded to a multiple of it. So an array holds whole vectors. */
#define FIBRAD_ALIGNMENT 64

typedef struct fibrad_arena {
    unsigned char *base; /* on a boundary of FIBRAD_ALIGNMENT; NULL: count only */
    size_t used, size;   /* bytes; used is SIZE_MAX once a sum has overflowed */
} fibrad_arena;

/* Room for `count` items of `bytes` each. NULL: the arena only counts, or the block is too small. `used` grows in
 * both cases. */
static inline void *fibrad_arena_take(fibrad_arena *arena, size_t count, size_t bytes) {
    size_t start = arena->used;
    if (start > SIZE_MAX - FIBRAD_ALIGNMENT || (bytes != 0 && count > (SIZE_MAX - FIBRAD_ALIGNMENT - start) / bytes)) {
        arena->used = SIZE_MAX;
        return NULL;
    }
    size_t padded = (count * bytes + FIBRAD_ALIGNMENT - 1) / FIBRAD_ALIGNMENT * FIBRAD_ALIGNMENT;
    arena->used = start + padded;
    return arena->base != NULL && arena->used <= arena->size ? arena->base + start : NULL;
}

/* Takes `count` numbers for each address of a list that ends with NULL. */
static inline void fibrad_arena_doubles(fibrad_arena *arena, size_t count, double **const list[]) {
    for (; *list != NULL; list++) **list = fibrad_arena_take(arena, count, sizeof ***list);
}

static inline void fibrad_arena_floats(fibrad_arena *arena, size_t count, float **const list[]) {
    for (; *list != NULL; list++) **list = fibrad_arena_take(arena, count, sizeof ***list);
}

static inline void fibrad_arena_words(fibrad_arena *arena, size_t count, uint32_t **const list[]) {
    for (; *list != NULL; list++) **list = fibrad_arena_take(arena, count, sizeof ***list);
}

/* The number of bytes that suffices wherever the block begins: the result of a `_size` function. 0: the number does
 * not fit into a size_t. */
static inline size_t fibrad_arena_total(const fibrad_arena *arena) {
    return arena->used > SIZE_MAX - FIBRAD_ALIGNMENT ? 0 : arena->used + FIBRAD_ALIGNMENT - 1;
}

/* Bytes before the first boundary of a block. */
static inline size_t fibrad_arena_lead(const void *memory) { return (size_t) - (uintptr_t)memory % FIBRAD_ALIGNMENT; }

/* Whether the caller's memory is a block, an empty one, or none yet. */
static inline bool fibrad_memory_valid(const fibrad_memory *memory) {
    return memory->block != NULL || memory->size == 0;
}

/* Checks the caller's block before `_init` lays an object out. needed: the bytes that fibrad_arena_total has
 * counted. Errors: FIBRAD_E_ARGUMENT: the block is NULL, or needed is 0 because the configuration is not valid.
 * _SIZE. */
static inline int fibrad_arena_open(fibrad_arena *arena, void *memory, size_t size, size_t needed) {
    if (memory == NULL || needed == 0) return FIBRAD_E_ARGUMENT;
    if (size < needed) return FIBRAD_E_SIZE;
    const size_t lead = fibrad_arena_lead(memory);
    arena->base = (unsigned char *)memory + lead;
    arena->used = 0;
    arena->size = size - lead;
    return FIBRAD_OK;
}

/* ---- makes a caller's block of memory large enough --------------------------------------------------------------- */

/* Makes a block of at least `needed` bytes. Its contents stay. A block that grows has twice the size afterwards.
 * Errors: FIBRAD_E_CAPACITY: a fixed block is too small, and memory->needed is set. _MEMORY: the caller has no more
 * memory. */
int fibrad_memory_reserve(fibrad_memory *memory, size_t needed);

#endif
