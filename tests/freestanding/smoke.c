/* smoke.c - a pair and two rows of 100 spheres from static memory, without a C library. SPDX-License-Identifier: MIT
 *
 * The port gives smoke_write; the output is the same on every target. */
#include "smoke.h"

#include "fibrad.h"

#define SPHERES 100
#define DISCS   10
#define SEEN    90

static unsigned char scene_memory[FIBRAD_SCENE_BYTES(SPHERES)];
static unsigned char work_memory[FIBRAD_WORK_BYTES(DISCS, SEEN)];
static double x[SPHERES], y[SPHERES], z[SPHERES], r[SPHERES], f[SEEN];
static uint32_t col[SEEN];

static void write_hex(const char *what, uint64_t word) {
    char line[18];
    for (int digit = 0; digit < 16; digit++) line[digit] = "0123456789abcdef"[word >> 4 * (15 - digit) & 15];
    line[16] = '\n', line[17] = 0;
    smoke_write(what);
    smoke_write(line);
}

static uint64_t bits(double value) {
    union {
        double value;
        uint64_t bits;
    } view = {value};
    return view.bits;
}

static double random_in(double low, double high) {
    static uint64_t state = 42;
    state = state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * ((double)(state >> 11) / 9007199254740992.0);
}

static void write_row(const fibrad_row *row) {
    for (uint32_t k = 0; k < row->length; k++) {
        write_hex("col ", row->col[k]);
        write_hex("f ", bits(row->f[k]));
    }
    write_hex("escaped ", bits(row->escaped));
}

int smoke(void) {
    double f12;
    if (fibrad_pair_exact(1, .5, .25, &f12) != FIBRAD_OK) return 1;
    write_hex("pair ", bits(f12));

    for (int i = 0; i < SPHERES; i++) {
        x[i] = 2.1 * (i % 5) + random_in(-.1, .1), y[i] = 2.1 * (i / 5 % 5) + random_in(-.1, .1);
        z[i] = 2.1 * (i / 25) + random_in(-.1, .1), r[i] = random_in(.8, 1);
    }
    fibrad_scene *scene;
    fibrad_work work = {.memory = {.block = work_memory, .size = sizeof work_memory}};
    const fibrad_spheres spheres = {.x = x, .y = y, .z = z, .r = r, .n = SPHERES};
    if (fibrad_scene_init(&scene, scene_memory, sizeof scene_memory, NULL, &spheres, NULL) != FIBRAD_OK) return 2;
    fibrad_row row = {.col = col, .f = f, .capacity = SEEN};
    if (fibrad_beam_row(scene, &work, 62, &(fibrad_beam_rule){.directions = 100}, &row) != FIBRAD_OK) return 3;
    write_row(&row);
    if (fibrad_cast_row(scene, &work, 62, &(fibrad_cast_rule){.rays = 500}, &row, NULL) != FIBRAD_OK) return 4;
    write_row(&row);
    return 0;
}
