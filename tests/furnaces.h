/* furnaces.h - furnaces and their solutions, for tests. SPDX-License-Identifier: MIT */
#ifndef TESTS_FURNACES_H
#define TESTS_FURNACES_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/elementary.h"
#include "papers/furnace/furnace.h"
#include "suite.h"

#define SIGMA FIBRAD_STEFAN_BOLTZMANN

static inline void *allocate(size_t bytes) {
    void *block = malloc(bytes);
    ck_assert_ptr_nonnull(block);
    return block;
}

static inline fibrad_furnace_config coarse_case(int number, uint32_t across) {
    fibrad_furnace_config config = furnace_case(number);
    config.cells[0] = config.cells[1] = across;
    config.cells[2] = 2 * across;
    return config;
}

enum { TALLIES = 4, BOX_CELLS = 4 * 4 * 8 };

/* A small furnace and empty tallies. */
struct box {
    fibrad_furnace_config config;
    fibrad_furnace *furnace;
    fibrad_furnace_arrays at;
    fibrad_furnace_tally *tally[TALLIES];
    unsigned char *block, *tally_block[TALLIES];
    uint64_t planned;
};

static inline void clear_tally(struct box *box, int k) {
    size_t size = fibrad_furnace_tally_size(box->furnace);
    free(box->tally_block[k]);
    box->tally_block[k] = allocate(size + 64);
    memset(box->tally_block[k], 0xa5, size + 64);
    unsigned char *begin = box->tally_block[k] + 3 * k; /* any alignment */
    assert_ok(fibrad_furnace_tally_init(&box->tally[k], begin, size, box->furnace));
}

static inline struct box make_box(const fibrad_furnace_config *config) {
    struct box box = {.config = *config};
    size_t size = fibrad_furnace_size(config);
    box.block = allocate(size + 1);
    assert_ok(fibrad_furnace_init(&box.furnace, box.block + 1, size, config));
    fibrad_furnace_fields(box.furnace, &box.at);
    for (size_t c = 0; c < (size_t)config->cells[0] * config->cells[1] * config->cells[2]; c++)
        box.at.e[c] *= 1 + 0.1 * (double)(c % 7);
    for (int k = 0; k < TALLIES; k++) clear_tally(&box, k);
    return box;
}

static inline void free_box(struct box *box) {
    for (int k = 0; k < TALLIES; k++) free(box->tally_block[k]);
    free(box->block);
}

#define OWNED_BOX OWNED_BY(free_box) struct box

static inline int trace(struct box *box, int tally, uint64_t first, uint64_t count) {
    return fibrad_furnace_trace(box->furnace, box->tally[tally], first, count);
}

static inline int equilibrium(struct box *box, int tally) {
    return fibrad_furnace_equilibrium(box->furnace, box->tally[tally]);
}

#endif
