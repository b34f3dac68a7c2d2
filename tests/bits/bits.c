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

/* What bounds a scene: nothing; periods; six planes; a cylinder with a plane at either end; planes at both ends of z
 * and periods across; a plane below, without end. */
enum { OPEN, PERIODIC, BOX, CAN, SLAB, FLOOR };

/* What a scene is made of: sites of a grid, filled in order, moved at random. */
static const struct scene {
    const char *name;
    uint32_t n, side; /* spheres; sites per axis */
    double spacing, jitter, smallest, largest;
    int bounds;
    double cutoff;
} scenes[] = {
    {"random", 300, 7, 2.1, .15, .7, 1.05, OPEN, 0},    {"periodic", 216, 6, 2.05, .1, .8, 1.1, PERIODIC, 0},
    {"lattice", 216, 6, 2, 0, 1, 1, OPEN, 0},           {"torus", 125, 5, 2, 0, 1, 1, PERIODIC, 0},
    {"sizes", 300, 7, 4.2, .3, .05, 2, OPEN, 0},        {"sparse", 100, 5, 9, 3, .1, 1, OPEN, 0},
    {"settled", 300, 7, 1.96, .02, .98, 1.02, OPEN, 0}, {"cutoff", 216, 6, 2.05, .1, .8, 1.1, PERIODIC, 4.5},
};

/* Small ones, for what takes long or needs walls. */
static const struct scene small[] = {
    {"cube", 27, 3, 2.1, .1, .75, 1.1, PERIODIC, 0}, {"box", 27, 3, 2.1, .1, .75, 1.1, BOX, 0},
    {"can", 25, 3, 2.1, .1, .75, 1.1, CAN, 0},       {"slab", 18, 3, 2.1, .1, .75, 1.1, SLAB, 0},
    {"floor", 12, 3, 2.1, .1, .75, 1.1, FLOOR, 0},
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
static double on_wall[SPHERES][FIBRAD_WALLS], escaped[SPHERES];

static void hash_rows(const fibrad_rows *rows) {
    hash_begin();
    for (uint32_t i = 0; i <= rows->n; i++) hash_word(rows->start[i]);
    for (uint64_t k = 0; k < rows->start[rows->n]; k++) hash_word(rows->col[k]), hash_number(rows->f[k]);
}

static void hash_row(const fibrad_row *row) {
    hash_word(row->length);
    for (uint32_t k = 0; k < row->length; k++) hash_word(row->col[k]), hash_number(row->f[k]);
    for (int k = 0; k < FIBRAD_WALLS; k++) hash_number(row->wall[k]);
    hash_number(row->escaped), hash_number(row->error);
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

static fibrad_scene_config config_of(const struct scene *s, int isa) {
    const double low = -.95, high = s->spacing * (s->side - 1) - low, middle = (low + high) / 2;
    const double period = s->spacing * s->side, across = s->bounds == PERIODIC || s->bounds == SLAB ? period : 0;
    fibrad_scene_config config = {.spheres = s->n, .isa = isa};
    config.period[0] = config.period[1] = across;
    config.period[2] = s->bounds == PERIODIC ? period : 0;
    if (s->bounds == OPEN || s->bounds == PERIODIC) return config;
    config.walls.planes = s->bounds == BOX ? 63 : s->bounds == FLOOR ? 16 : 48;
    for (int k = 0; k < 6; k++) config.walls.at[k] = k % 2 ? high : low;
    if (s->bounds == CAN)
        config.walls.cylinder[0] = config.walls.cylinder[1] = middle, config.walls.cylinder[2] = .75 * (high - low);
    return config;
}

static int set_up(const struct scene *s, int isa, fibrad_scene **scene, fibrad_work **work) {
    fibrad_scene_config config = config_of(s, isa);
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

/* ---- heat, exchange, walls, what moves: small scenes ------------------------------------------------------------ */

static double temperature[SPHERES], emissivity[SPHERES], power[SPHERES];

/* Temperatures, and emissivities between two bounds, of all spheres and walls. */
static fibrad_heat_sources sources_of(const struct scene *s, uint64_t seed, double lowest, double highest) {
    fibrad_heat_sources sources = {.temperature = temperature, .emissivity = emissivity, .sigma = 1};
    state = seed;
    for (uint32_t i = 0; i < s->n; i++) temperature[i] = random_in(1, 2), emissivity[i] = random_in(lowest, highest);
    for (int k = 0; k < FIBRAD_WALLS; k++)
        sources.wall_temperature[k] = random_in(1, 2), sources.wall_emissivity[k] = random_in(lowest, highest);
    sources.surroundings = .5;
    return sources;
}

static void hash_result(const struct scene *s, const fibrad_heat_result *result) {
    hash_begin();
    for (uint32_t i = 0; i < s->n; i++) hash_number(result->power[i]);
    for (int k = 0; k < FIBRAD_WALLS; k++) hash_number(result->wall_power[k]);
    hash_number(result->surroundings_power), hash_number(result->error_patches), hash_number(result->error_beams);
    hash_number(result->residual), hash_word(result->sweeps);
}

static void hash_facts(const struct scene *s, const fibrad_scene *scene) {
    fibrad_scene_facts facts;
    fibrad_scene_describe(scene, &facts);
    hash_begin();
    hash_word(facts.spheres), hash_number(facts.radius_min), hash_number(facts.radius_max);
    hash_number(facts.overlap_max), hash_word(facts.overlap_pair[0]), hash_word(facts.overlap_pair[1]);
    for (int k = 0; k < FIBRAD_WALLS; k++) hash_number(facts.wall_area[k]);
    tell(s->name, "facts");
}

/* Rows with what meets walls, and all that is made of them. */
static int hash_closed(const struct scene *s, int isa, uint32_t points) {
    static const char *const names[] = {"areas.walls", "points64.walls", "points128.walls", "", "points256.walls"};
    static double weight[SPHERES], target[SPHERES];
    fibrad_scene *scene;
    fibrad_work *work;
    if (set_up(s, isa, &scene, &work)) return 1;
    if (points == 0) hash_facts(s, scene);
    fibrad_rows raw = {.n = s->n, .capacity = ENTRIES, .start = raw_start, .col = raw_col, .f = raw_f};
    fibrad_rows rows = {.n = s->n, .capacity = ENTRIES, .start = start, .col = col, .f = f};
    fibrad_beam_rule rule = {.points = points};
    hash_begin();
    for (uint32_t i = 0; i < s->n; i++) {
        rule.directions = 34 + 13 * (i % 3);
        fibrad_row row = {.col = raw_col + raw_start[i], .f = raw_f + raw_start[i], .capacity = SPHERES};
        if (fibrad_beam_row(scene, work, i, &rule, &row) != FIBRAD_OK) return 1;
        raw_start[i + 1] = raw_start[i] + row.length;
        hash_row(&row);
        hash_word(row.directions), hash_number(row.reach);
        for (int k = 0; k < FIBRAD_WALLS; k++) on_wall[i][k] = row.wall[k];
        escaped[i] = row.escaped;
        weight[i] = (double)rule.directions * rule.directions * rule.directions;
    }
    tell(s->name, names[points / 64]);
    if (points != 0) return 0;

    if (fibrad_rows_average_part(&raw, r, weight, s->n / 3, s->n / 2, &rows) != FIBRAD_OK) return 1;
    hash_rows(&rows);
    tell(s->name, "areas.part");
    if (fibrad_rows_average_weighted(&raw, r, weight, &rows) != FIBRAD_OK) return 1;
    hash_rows(&rows);
    tell(s->name, "areas.weighted");
    double largest;
    if (fibrad_rows_limit(&rows, scratch) != FIBRAD_OK || fibrad_rows_close(&rows, r, on_wall, escaped) != FIBRAD_OK ||
        fibrad_rows_reciprocity(&rows, r, &largest) != FIBRAD_OK)
        return 1;
    hash_rows(&rows);
    hash_number(largest);
    for (uint32_t i = 0; i < s->n; i++) {
        target[i] = .98 - .01 * (i % 3) - escaped[i];
        for (int k = 0; k < FIBRAD_WALLS; k++) hash_number(on_wall[i][k]), target[i] -= on_wall[i][k];
        hash_number(escaped[i]);
    }
    tell(s->name, "areas.closed");
    fibrad_heat_sources sources = sources_of(s, 5, .2, 1);
    fibrad_heat_result result = {.power = power};
    if (fibrad_radiosity(&rows, r, &sources, scratch, &result) != FIBRAD_OK) return 1;
    hash_result(s, &result);
    tell(s->name, "areas.radiosity");
    if (fibrad_rows_balance(&rows, target, scratch) != FIBRAD_OK) return 1;
    hash_rows(&rows);
    tell(s->name, "areas.balanced");
    return 0;
}

/* Beam rows to a tolerance, by areas and by points, and the directions that would be next. */
static int hash_tolerance(const struct scene *s, int isa) {
    fibrad_scene *scene;
    fibrad_work *work;
    if (set_up(s, isa, &scene, &work)) return 1;
    for (uint32_t points = 0; points <= 256; points += 256) {
        fibrad_beam_rule rule = {.directions = 20, .points = points, .error = .02};
        hash_begin();
        for (uint32_t i = 0; i < s->n; i += 9) {
            fibrad_row row = {.col = col, .f = f, .capacity = SPHERES};
            rule.directions = i == 0 ? 0 : 20;
            if (fibrad_beam_row(scene, work, i, &rule, &row) != FIBRAD_OK) return 1;
            hash_row(&row);
            hash_word(row.directions), hash_word(fibrad_directions_for(row.directions, row.error, 1e-4 * (i + 1)));
        }
        tell(s->name, points ? "points256.tolerance" : "areas.tolerance");
    }
    return 0;
}

/* Exchange rows by a fixed number of paths and to a tolerance, and the spread. */
static int hash_exchange(const struct scene *s, int isa) {
    static _Alignas(64) unsigned char tracer_memory[1 << 18];
    fibrad_scene *scene;
    fibrad_work *work;
    fibrad_tracer *tracer;
    if (set_up(s, isa, &scene, &work) || fibrad_tracer_init(&tracer, tracer_memory, sizeof tracer_memory,
                                                            &(fibrad_tracer_config){.lists = 32}, scene) != FIBRAD_OK)
        return 1;
    fibrad_heat_sources sources = sources_of(s, 9, .2, 1);
    fibrad_exchange_rule rule = {.emissivity = emissivity, .paths = 100, .seed = 3};
    for (int k = 0; k < FIBRAD_WALLS; k++) rule.wall_emissivity[k] = k % 3 ? sources.wall_emissivity[k] : 0;
    if (s->bounds == CAN) rule.wall_emissivity[6] = .4;
    uint64_t rays;
    for (int tolerance = 0; tolerance < 2; tolerance++) {
        rule.error = tolerance ? .03 : 0;
        hash_begin();
        for (uint32_t i = 0; i < s->n; i += tolerance ? 9 : 4) {
            fibrad_row row = {.col = col, .f = f, .capacity = SPHERES};
            rule.directions = i % 8 == 0 ? 160 : 0; /* by areas, by points */
            if (fibrad_exchange_row(tracer, work, i, &rule, &row, &rays) != FIBRAD_OK) return 1;
            hash_row(&row);
            hash_word(rays);
        }
        tell(s->name, tolerance ? "exchange.tolerance" : "exchange");
    }
    hash_begin();
    for (uint32_t i = 0; i < s->n; i += 4) {
        fibrad_spread spread;
        if (fibrad_exchange_spread(tracer, i, &rule, &spread) != FIBRAD_OK) return 1;
        for (int axis = 0; axis < 3; axis++) hash_number(spread.square[axis]), hash_number(spread.error[axis]);
        hash_number(spread.absorbed), hash_word(spread.rays);
    }
    tell(s->name, "spread");
    return 0;
}

/* What rows say of a bed in which a few spheres have moved: some a little, some so far that others come into sight. */
static int hash_moved(const struct scene *s, int isa) {
    static _Alignas(64) unsigned char now_memory[FIBRAD_SCENE_BYTES(SPHERES)];
    static double reach[SPHERES], error[SPHERES], seen[SPHERES];
    static unsigned char bytes[2 * SPHERES], same[SPHERES];
    fibrad_scene *before, *now;
    fibrad_work *work;
    if (set_up(s, isa, &before, &work)) return 1;
    for (uint32_t i = 0; i < s->n; i += 29) x[i] += random_in(-.02, .02), z[i] += i % 2 ? .35 : .01;
    const fibrad_scene_config config = config_of(s, isa);
    if (fibrad_scene_init(&now, now_memory, sizeof now_memory, &config, &(fibrad_spheres){x, y, z, r, s->n}, NULL) !=
        FIBRAD_OK)
        return 1;
    const fibrad_beam_rule rule = {.directions = 20, .points = 64};
    for (uint32_t i = 0; i < s->n; i++) seen[i] = 0;
    for (uint32_t i = 0; i < s->n; i++) {
        fibrad_row old = {.col = raw_col, .f = raw_f, .capacity = SPHERES};
        fibrad_row row = {.col = col, .f = f, .capacity = SPHERES};
        if (fibrad_beam_row(before, work, i, &rule, &old) != FIBRAD_OK ||
            fibrad_beam_row(now, work, i, &rule, &row) != FIBRAD_OK ||
            fibrad_moved_error(before, now, i, &old, &error[i]) != FIBRAD_OK ||
            fibrad_moved_seen(now, i, &old, &row, seen) != FIBRAD_OK)
            return 1;
        reach[i] = i % 5 ? old.reach : 3.5; /* some rows that cannot have changed */
    }
    if (fibrad_moved_same(before, now, reach, bytes, same) != FIBRAD_OK) return 1;
    hash_begin();
    for (uint32_t i = 0; i < s->n; i++) hash_number(error[i]);
    tell(s->name, "moved.error");
    hash_begin();
    for (uint32_t i = 0; i < s->n; i++) hash_number(seen[i]);
    tell(s->name, "moved.seen");
    hash_begin();
    for (uint32_t i = 0; i < s->n; i++) hash_word(same[i]);
    tell(s->name, "moved.same");
    return 0;
}

static _Alignas(64) unsigned char heat_memory[12 << 20];

/* The beams of all surfaces. */
static int heat_trace(const struct scene *s, int isa, const fibrad_heat_config *config, fibrad_heat **heat) {
    fibrad_scene *scene;
    fibrad_work *work;
    if (set_up(s, isa, &scene, &work) ||
        fibrad_heat_init(heat, heat_memory, sizeof heat_memory, config, scene) != FIBRAD_OK)
        return 1;
    for (uint32_t k = fibrad_heat_tasks(*heat); k-- > 0;)
        if (fibrad_heat_trace(*heat, work, k) != FIBRAD_OK) return 1;
    return 0;
}

static int heat_solve(const struct scene *s, fibrad_heat *heat, uint32_t parts, const fibrad_heat_sources *sources,
                      const char *name) {
    fibrad_heat_result result = {.power = power};
    if (fibrad_heat_begin(heat, sources) != FIBRAD_OK) return 1;
    do
        for (uint32_t k = 0; k < parts; k++) fibrad_heat_sweep(heat, k);
    while (fibrad_heat_step(heat));
    if (fibrad_heat_read(heat, &result) != FIBRAD_OK) return 1;
    hash_result(s, &result);
    tell(s->name, name);
    return 0;
}

/* Powers: anew, from the solution before, and from it without coming to an end. */
static int hash_heat(const struct scene *s, int isa) {
    const fibrad_heat_config config = {.directions = 40, .parts = 3};
    fibrad_heat *heat;
    if (heat_trace(s, isa, &config, &heat)) return 1;
    fibrad_heat_sources sources = sources_of(s, 7, .1, .9);
    if (heat_solve(s, heat, config.parts, &sources, "heat")) return 1;
    sources = sources_of(s, 8, .2, 1);
    emissivity[0] = 0, emissivity[1] = 1;
    if (heat_solve(s, heat, config.parts, &sources, "heat.again")) return 1;
    sources = sources_of(s, 7, .1, .9);
    sources.sweeps_max = 4, sources.tolerance = 1e-9;
    return heat_solve(s, heat, config.parts, &sources, "heat.unfinished");
}

/* Powers under other settings, at two emissivities. */
static int hash_heat_settings(const struct scene *s, int isa) {
    static const struct {
        fibrad_heat_config config;
        int uniform;
        const char *name[2];
    } cases[] = {
        {{30, 64, 24, 1}, 0, {"heat.patches24.3", "heat.patches24.8"}},
        {{30, 64, 96, 1}, 0, {"heat.patches96.3", "heat.patches96.8"}},
        {{30, 64, 384, 1}, 0, {"heat.patches384.3", "heat.patches384.8"}},
        {{30, 64, 24, 2}, 0, {"heat.parts2.3", "heat.parts2.8"}},
        {{30, 64, 24, 7}, 0, {"heat.parts7.3", "heat.parts7.8"}},
        {{10, 128, 24, 2}, 0, {"heat.points128.3", "heat.points128.8"}},
        {{10, 256, 24, 2}, 0, {"heat.points256.3", "heat.points256.8"}},
        {{30, 64, 24, 2}, 1, {"heat.uniform.3", "heat.uniform.8"}},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        fibrad_heat *heat;
        if (heat_trace(s, isa, &cases[k].config, &heat)) return 1;
        for (int high = 0; high < 2; high++) {
            fibrad_heat_sources sources = sources_of(s, 7, .1, .9);
            for (uint32_t i = 0; i < s->n; i++) emissivity[i] = high ? .8 : .3;
            sources.uniform = cases[k].uniform;
            if (heat_solve(s, heat, cases[k].config.parts, &sources, cases[k].name[high])) return 1;
        }
    }
    return 0;
}

static int hash_small(const struct scene *s, int isa) {
    int failed = 0;
    for (uint32_t points = 0; points <= 256; points = points == 0 ? 64 : 2 * points)
        failed |= hash_closed(s, isa, points);
    failed |= hash_tolerance(s, isa);
    failed |= hash_exchange(s, isa);
    return s->bounds == SLAB ? failed : failed | hash_heat(s, isa); /* the rays of walls take long */
}

/* ---- furnace ---------------------------------------------------------------------------------------------------- */

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
    make(&scenes[1]);
    failed |= hash_moved(&scenes[1], isa);
    for (size_t k = 0; k < sizeof small / sizeof *small; k++) {
        make(&small[k]);
        failed |= hash_small(&small[k], isa);
    }
    make(&small[0]);
    failed |= hash_heat_settings(&small[0], isa);
    return failed;
}
