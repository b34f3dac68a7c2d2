/* choices.h - an input of a fuzzer as a stream of choices: numbers, and blocks of memory. SPDX-License-Identifier: MIT
 */
#ifndef TESTS_FUZZ_CHOICES_H
#define TESTS_FUZZ_CHOICES_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fibrad.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* A promise of a header. */
#define REQUIRE(condition)                                                                                             \
    do {                                                                                                               \
        if (!(condition)) {                                                                                            \
            fprintf(stderr, "%s:%d: not so: %s\n", __FILE__, __LINE__, #condition);                                    \
            abort();                                                                                                   \
        }                                                                                                              \
    } while (0)

/* The status of a call, which is counted. The count is printed at the end. */
static uint64_t calls;
#define CALL(call) (calls++, (call))

static inline void print_calls(void) { printf("%llu calls\n", (unsigned long long)calls); }

static inline void count_calls(void) {
    static bool begun;
    if (!begun) atexit(print_calls);
    begun = true;
}

/* ---- numbers ---------------------------------------------------------------------------------------------------- */

static const uint8_t *at, *end;

/* The next byte; 0 behind the last. */
static inline uint8_t byte(void) { return at < end ? *at++ : 0; }

static inline uint32_t number(void) {
    uint32_t n = byte();
    return n < 250 ? n : (uint32_t)byte() << 24 | (uint32_t)byte() << 16 | (uint32_t)byte() << 8 | byte();
}

/* Mostly plain numbers on a coarse grid, which touch and coincide; now and then any bits at all. */
static inline double coordinate(void) {
    static const double special[] = {
        NAN, INFINITY, -INFINITY, -0.0, 1e-300, 1e300, 1e150, 0x1p-1074, 0x1.fffffffffffffp1023};
    uint8_t kind = byte();
    if (kind < 240) return (kind - 120) / 4.0;
    if (kind < 249) return special[kind - 240];
    uint64_t word = 0;
    for (int k = 0; k < 8; k++) word = word << 8 | byte();
    double x;
    memcpy(&x, &word, sizeof x);
    return x;
}

/* From 0 to 1, seldom what is none. */
static inline double share(void) {
    uint8_t b = byte();
    return b < 250 ? .04 * (b % 26) : coordinate();
}

/* ---- memory ----------------------------------------------------------------------------------------------------- */

enum { UNSET = 0xa5 };

/* A block of exactly `size` bytes `shift` bytes after a boundary (the pointer to free is *block). */
static inline void *memory_of(size_t size, size_t shift, void **block) {
    *block = malloc(size + shift > 0 ? size + shift : 1);
    REQUIRE(*block != NULL);
    unsigned char *memory = *block;
    memset(memory, UNSET, size + shift);
    return memory + shift;
}

/* Memory of any alignment, fixed or growing, into another block each time. */
struct supply {
    void *block;  /* to be freed */
    void *memory; /* `shift` bytes behind: what the library has; NULL: none so far */
    size_t shift, size;
    uint32_t left;   /* how often it grows */
    uint32_t refuse; /* a bit for each time it is asked: 1: once, there is nothing */
};

/* The bytes before the memory are as they were. Those behind it are watched by the address sanitizer. */
static inline void check_guard(const struct supply *supply) {
    const unsigned char *block = supply->block;
    for (size_t k = 0; block != NULL && k < supply->shift; k++) REQUIRE(block[k] == UNSET);
}

static inline void supply_end(struct supply *supply) {
    check_guard(supply);
    free(supply->block);
    supply->block = supply->memory = NULL, supply->size = 0;
}

/* Memory of `size` bytes instead, which begins as the old one does. */
static inline void *supply_resize(struct supply *supply, size_t size) {
    struct supply larger = *supply;
    larger.memory = memory_of(size, supply->shift, &larger.block), larger.size = size;
    if (supply->memory != NULL) memcpy(larger.memory, supply->memory, supply->size < size ? supply->size : size);
    supply_end(supply);
    *supply = larger;
    return supply->memory;
}

/* A fibrad_resize. */
static inline void *supply_more(void *context, void *block, size_t size) {
    struct supply *supply = context;
    REQUIRE(block == supply->memory && size > supply->size);
    const bool refused = supply->refuse & 1;
    supply->refuse >>= 1;
    if (refused || supply->left == 0 || size > 1 << 26) return NULL;
    supply->left--;
    return supply_resize(supply, size);
}

/* Fixed or growing; the caller calls supply_end. */
static inline fibrad_memory any_memory(struct supply *supply) {
    const uint8_t kind = byte();
    *supply = (struct supply){.left = kind < 128 ? UINT32_MAX : kind % 8, .shift = kind / 2 % 16};
    if (kind > 96 && kind < 128) supply->refuse = kind & 15;
    fibrad_memory memory = {.resize = supply_more, .context = supply};
    if (kind % 2 == 0) return memory;
    const size_t size = kind == 255 ? 0 : 1 + (kind % 4 == 1 ? number() % 4096 : 64 * (size_t)number() % 40000);
    supply_resize(supply, size);
    return (fibrad_memory){.block = supply->memory, .size = size};
}

/* After a status that asks for more of a fixed memory. True: there is more now. */
static inline bool give_more(fibrad_memory *memory, struct supply *supply) {
    REQUIRE(memory->resize == NULL && memory->needed > memory->size);
    if (memory->needed > 1 << 24) return false;
    memory->block = supply_resize(supply, memory->needed), memory->size = supply->size;
    return true;
}

static inline double *copies(uint32_t n, double (*next)(void)) {
    double *array = malloc(n * sizeof *array + 1);
    REQUIRE(array != NULL);
    for (uint32_t i = 0; i < n; i++) array[i] = next();
    return array;
}

#endif
