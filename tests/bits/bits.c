/* bits.c - prints a hash of everything the kernel computes for fixed scenes. SPDX-License-Identifier: MIT
 *
 * Usage: bits ISA. Exit status 77 if this build or machine lacks it. One line per method and scene: name, hash. Needs
 * nothing but fibrad.h, stdio and static memory, so that it runs wherever the kernel does; tests/check_bits.sh compares
 * its output with tests/golden/bits.txt on every target. */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "fibrad.h"

#define SPHERES 300
#define ENTRIES (2 * SPHERES * SPHERES)
#define DISCS   2048 /* a perfect lattice is seen through for a hundred periods */

/* ---- FNV-1a ----------------------------------------------------------------------------------------------------- */

static uint64_t hash;

static void hash_word(uint64_t word) {
    for (int byte = 0; byte < 8; byte++) hash = (hash ^ (word >> 8 * byte & 0xff)) * UINT64_C(0x100000001b3);
}

static void hash_number(double x) {
    uint64_t word;
    memcpy(&word, &x, sizeof word);
    hash_word(word);
}

static void hash_begin(void) { hash = UINT64_C(0xcbf29ce484222325); }

static void tell(const char *scene, const char *what) { printf("%s %s %016" PRIx64 "\n", scene, what, hash); }

/* ---- scenes ----------------------------------------------------------------------------------------------------- */

static uint64_t state;

/* Uniform in [low, high): exact arithmetic but for one rounding each. */
static double random_in(double low, double high) {
    state = state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * ((double)(state >> 11) / 9007199254740992.0);
}

static double x[SPHERES], y[SPHERES], z[SPHERES], r[SPHERES];

/* What a scene is made of: sites of a grid, filled in order, moved at random. */
static const struct scene {
    const char *name;
    uint32_t n, side; /* spheres; sites per axis */
    double spacing, jitter, smallest, largest;
    int periodic;
    double cutoff;
} scenes[] = {
    {"random", 300, 7, 2.1, .15, .7, 1.05, 0, 0},    {"periodic", 216, 6, 2.05, .1, .8, 1.1, 1, 0},
    {"lattice", 216, 6, 2, 0, 1, 1, 0, 0},           {"torus", 125, 5, 2, 0, 1, 1, 1, 0},
    {"sizes", 300, 7, 4.2, .3, .05, 2, 0, 0},        {"sparse", 100, 5, 9, 3, .1, 1, 0, 0},
    {"settled", 300, 7, 1.96, .02, .98, 1.02, 0, 0}, {"cutoff", 216, 6, 2.05, .1, .8, 1.1, 1, 4.5},
};

static void make(const struct scene *s) {
    state = s->n * 7919u + s->side;
    for (uint32_t i = 0; i < s->n; i++) {
        x[i] = s->spacing * (i % s->side) + random_in(-s->jitter, s->jitter);
        y[i] = s->spacing * (i / s->side % s->side) + random_in(-s->jitter, s->jitter);
        z[i] = s->spacing * (i / s->side / s->side) + random_in(-s->jitter, s->jitter);
        r[i] = random_in(s->smallest, s->largest);
    }
}

/* ---- what is hashed --------------------------------------------------------------------------------------------- */

static _Alignas(64) unsigned char scene_memory[FIBRAD_SCENE_BYTES(SPHERES)];
static _Alignas(64) unsigned char work_memory[FIBRAD_WORK_BYTES(2048, DISCS, SPHERES)];
static uint64_t raw_start[SPHERES + 1], start[SPHERES + 1];
static uint32_t raw_col[ENTRIES], col[ENTRIES];
static double raw_f[ENTRIES], f[ENTRIES], scratch[3 * SPHERES];

static void hash_rows(const fibrad_rows *rows) {
    hash_begin();
    for (uint32_t i = 0; i <= rows->n; i++) hash_word(rows->start[i]);
    for (uint64_t k = 0; k < rows->start[rows->n]; k++) hash_word(rows->col[k]), hash_number(rows->f[k]);
}

static int hash_pairs(void) {
    hash_begin();
    state = 1;
    for (int k = 0; k < 20000; k++) {
        double r1 = random_in(.01, 1), r2 = random_in(.01, 1), smaller = r1 < r2 ? r1 : r2, f12;
        double gap = k % 2 ? random_in(-1.99, 0) * smaller : random_in(0, 1e-3) * (k % 1000);
        if (fibrad_pair_exact(r1, r2, gap, &f12) != FIBRAD_OK) return 1;
        hash_number(f12);
    }
    tell("pairs", "exact");
    return 0;
}

static int hash_directions(void) {
    hash_begin();
    for (uint32_t k = 0; k < FIBRAD_DIRECTIONS_MAX; k++) {
        double w[3];
        if (fibrad_direction(k, FIBRAD_DIRECTIONS_MAX, w) != FIBRAD_OK) return 1;
        for (int axis = 0; axis < 3; axis++) hash_number(w[axis]);
    }
    tell("directions", "65536");
    return 0;
}

static int set_up(const struct scene *s, int isa, fibrad_scene **scene, fibrad_work **work) {
    double period = s->periodic ? s->spacing * s->side : 0;
    fibrad_scene_config config = {.spheres = s->n, .period = {period, period, period}, .isa = isa};
    return fibrad_scene_init(scene, scene_memory, sizeof scene_memory, &config, &(fibrad_spheres){x, y, z, r, s->n},
                             NULL) != FIBRAD_OK ||
           fibrad_work_init(work, work_memory, sizeof work_memory,
                            &(fibrad_work_config){.near = 2048, .discs = DISCS, .entries = SPHERES}) != FIBRAD_OK;
}

/* All rows of a scene, and what is made of them. */
static int hash_beam(const struct scene *s, int isa, uint32_t points) {
    static const char *const names[] = {"areas", "points64", "points128", "", "points256"};
    fibrad_scene *scene;
    fibrad_work *work;
    if (set_up(s, isa, &scene, &work)) return 1;
    fibrad_rows raw = {.n = s->n, .capacity = ENTRIES, .start = raw_start, .col = raw_col, .f = raw_f};
    fibrad_beam_rule rule = {.directions = 55, .points = points, .cutoff = s->cutoff};
    hash_begin();
    for (uint32_t i = 0; i < s->n; i++) {
        fibrad_row row = {.col = raw_col + raw_start[i], .f = raw_f + raw_start[i], .capacity = SPHERES};
        if (fibrad_beam_row(scene, work, i, &rule, &row) != FIBRAD_OK) return 1;
        raw_start[i + 1] = raw_start[i] + row.length;
        hash_number(row.escaped), hash_number(row.error);
    }
    uint64_t first = hash;
    hash_rows(&raw);
    hash_word(first);
    tell(s->name, names[points / 64]);
    if (points != 0 && points != 64) return 0;

    fibrad_rows rows = {.n = s->n, .capacity = ENTRIES, .start = start, .col = col, .f = f};
    if (fibrad_rows_average(&raw, r, &rows) != FIBRAD_OK || fibrad_rows_limit(&rows, scratch) != FIBRAD_OK) return 1;
    hash_rows(&rows);
    tell(s->name, points == 0 ? "areas.reciprocal" : "points64.reciprocal");
    if (fibrad_rows_drop(&rows, r, 1e-3, scratch) != FIBRAD_OK) return 1;
    hash_rows(&rows);
    tell(s->name, points == 0 ? "areas.dropped" : "points64.dropped");
    return 0;
}

/* Raw rows by the surface method, of every seventh sphere. */
static int hash_surface(const struct scene *s, int isa) {
    fibrad_scene *scene;
    fibrad_work *work;
    if (set_up(s, isa, &scene, &work)) return 1;
    fibrad_surface_rule rule = {.nodes = 13, .cutoff = 5};
    hash_begin();
    for (uint32_t i = 0; i < s->n; i += 7) {
        fibrad_row row = {.col = col, .f = f, .capacity = SPHERES};
        if (fibrad_surface_row(scene, work, i, &rule, &row) != FIBRAD_OK) return 1;
        for (uint32_t k = 0; k < row.length; k++) hash_word(col[k]), hash_number(f[k]);
        hash_number(row.escaped), hash_number(row.error);
    }
    tell(s->name, "surface");
    return 0;
}

/* Raw rows by rays, of every seventh sphere, and their mean lengths and angles. */
static int hash_cast(const struct scene *s, int isa, int random) {
    static double length[SPHERES], angle[SPHERES];
    fibrad_scene *scene;
    fibrad_work *work;
    if (set_up(s, isa, &scene, &work)) return 1;
    fibrad_cast_rule rule = {.rays = 1000, .random = random, .seed = 5, .cutoff = s->cutoff};
    hash_begin();
    for (uint32_t i = 0; i < s->n; i += 7) {
        fibrad_row row = {.col = col, .f = f, .capacity = SPHERES};
        if (fibrad_cast_row(scene, work, i, &rule, &row, &(fibrad_cast_means){length, angle}) != FIBRAD_OK) return 1;
        for (uint32_t k = 0; k < row.length; k++)
            hash_word(col[k]), hash_number(f[k]), hash_number(length[k]), hash_number(angle[k]);
        hash_number(row.escaped), hash_number(row.error);
    }
    tell(s->name, random ? "mc" : "cast");
    return 0;
}

/* Rays, then heat fluxes in a small box. */
static int hash_furnace(void) {
    fibrad_furnace_config config = {.size = {2, 2, 4},
                                    .cells = {3, 3, 5},
                                    .absorption = .5,
                                    .scattering = .2,
                                    .source = 5000,
                                    .wall_temperature = {900, 900, 900, 900, 1200, 400},
                                    .wall_emissivity = {.7, .7, .7, .7, .85, .7},
                                    .seed = 3};
    fibrad_furnace *furnace;
    fibrad_furnace_tally *tally;
    fibrad_furnace_arrays arrays;
    fibrad_furnace_report report;
    uint64_t planned;
    if (fibrad_furnace_init(&furnace, scene_memory, sizeof scene_memory, &config) != FIBRAD_OK ||
        fibrad_furnace_tally_init(&tally, work_memory, sizeof work_memory, furnace) != FIBRAD_OK ||
        fibrad_furnace_emit(furnace, FIBRAD_FURNACE_ATTENUATED, 20000, 1, &planned) != FIBRAD_OK ||
        fibrad_furnace_trace(furnace, tally, 0, planned) != FIBRAD_OK ||
        fibrad_furnace_estimate(furnace, tally, FIBRAD_THETA_DEFINITION, 1, FIBRAD_SCATTER_EXACT) != FIBRAD_OK ||
        fibrad_furnace_solve(furnace, FIBRAD_SCATTER_EXACT, 1e-6, 1000, &report) != FIBRAD_OK)
        return 1;
    fibrad_furnace_fields(furnace, &arrays);
    hash_begin();
    hash_word(planned), hash_word(report.sweeps);
    for (int cell = 0; cell < 45; cell++) hash_number(arrays.e[cell]), hash_number(arrays.divergence[cell]);
    for (int wall = 0; wall < 6; wall++) hash_number(arrays.power[wall]);
    tell("furnace", "temperatures");
    return 0;
}

int main(int argc, char **argv) {
    int isa = FIBRAD_ISA_SCALAR, failed = 0;
    while (isa <= FIBRAD_ISA_AVX512 && (argc < 2 || strcmp(argv[1], fibrad_isa_name(isa)) != 0)) isa++;
    if (fibrad_scene_size(&(fibrad_scene_config){.spheres = 1, .isa = isa}) == 0) return 77;
    failed |= hash_pairs();
    failed |= hash_directions();
    for (size_t k = 0; k < sizeof scenes / sizeof *scenes; k++) {
        make(&scenes[k]);
        for (uint32_t points = 0; points <= 256; points = points == 0 ? 64 : 2 * points)
            failed |= hash_beam(&scenes[k], isa, points);
        failed |= hash_surface(&scenes[k], isa);
        failed |= hash_cast(&scenes[k], isa, 0);
        failed |= hash_cast(&scenes[k], isa, 1);
    }
    failed |= hash_furnace();
    return failed;
}
