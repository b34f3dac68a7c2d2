/* bits.c - prints a hash of everything the kernel computes for fixed scenes. SPDX-License-Identifier: MIT
 *
 * Usage: bits ISA. Exit status 77 if this build or machine lacks it. One line per method and scene: name, hash. Needs
 * nothing but the public headers, stdio and static memory, so that it runs wherever the kernel does;
 * tests/check_bits.sh compares its output with tests/golden/bits.txt on every target. */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "fibrad.h"
#include "fibrad_furnace.h"
#include "fibrad_heat.h"
#include "fibrad_surface.h"

#define SPHERES 300
#define WALLS   7
#define DISCS   2048 /* rays look through a perfect lattice for a hundred periods */

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

/* A number that is uniform in [low, high). The arithmetic is exact but for one rounding each. */
static double random_in(double low, double high) {
    state = state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * ((double)(state >> 11) / 9007199254740992.0);
}

static double x[SPHERES], y[SPHERES], z[SPHERES], r[SPHERES];

/* The bounds of a scene: nothing; periods; six planes; a cylinder with a plane at either end; planes at both ends of z
 * with periods across; an endless plane below. */
enum { OPEN, PERIODIC, BOX, CAN, SLAB, FLOOR };

/* The spheres of a scene: sites of a grid, filled in order and moved at random. */
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

/* Small scenes, for methods that take long or need walls. */
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

static unsigned char scene_memory[FIBRAD_SCENE_BYTES(SPHERES)],
    work_memory[FIBRAD_WORK_BYTES(DISCS, SPHERES) + FIBRAD_WORK_WALLS];
static unsigned char rows_memory[SPHERES * (12 * SPHERES + 128)], matrix_memory[SPHERES * (36 * SPHERES + 512)];
static fibrad_work work = {.memory = {.block = work_memory, .size = sizeof work_memory}}; /* of all that follows */
static fibrad_rows rows = {.memory = {.block = rows_memory, .size = sizeof rows_memory}};
static uint32_t col[SPHERES];
static double f[SPHERES], on_wall[WALLS];

static uint32_t walls;
static uint32_t wall_of[WALLS]; /* the wall of each wall: x low, x high, y low, y high, z low, z high or cylinder */

/* A row with room for all spheres and walls. */
static fibrad_row row_here(void) { return (fibrad_row){.col = col, .f = f, .wall = on_wall, .capacity = SPHERES}; }

static void hash_factors(const fibrad_factors *factors) {
    hash_begin();
    for (uint32_t i = 0; i <= factors->n; i++) hash_word(factors->start[i]);
    for (uint64_t k = 0; k < factors->start[factors->n]; k++) hash_word(factors->col[k]), hash_number(factors->f[k]);
}

/* Factors of walls by wall. Walls that do not exist have 0. */
static void hash_walls(const double *of_wall) {
    double wall[WALLS] = {0};
    for (uint32_t b = 0; b < walls; b++) wall[wall_of[b]] = of_wall[b];
    for (int k = 0; k < WALLS; k++) hash_number(wall[k]);
}

static void hash_row(const fibrad_row *row) {
    hash_word(row->length);
    for (uint32_t k = 0; k < row->length; k++) hash_word(row->col[k]), hash_number(row->f[k]);
    hash_walls(row->wall);
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

static void add_wall(fibrad_wall *wall, uint32_t place, fibrad_wall fields) {
    wall_of[walls] = place;
    wall[walls++] = fields;
}

/* Makes the scene. Its walls are in the order of wall_of. part: NULL, or occupancy and ids. */
static int scene_part(void *memory, size_t size, const struct scene *s, int isa, const fibrad_scene_config *part,
                      const uint64_t *id, fibrad_scene **scene) {
    const double low = -.95, high = s->spacing * (s->side - 1) - low, middle = (low + high) / 2;
    const double period = s->spacing * s->side, across = s->bounds == PERIODIC || s->bounds == SLAB ? period : 0;
    const uint32_t planes = s->bounds < BOX ? 0 : s->bounds == BOX ? 63 : s->bounds == FLOOR ? 16 : 48;
    fibrad_wall wall[WALLS];
    walls = 0;
    for (uint32_t k = 0; k < 6; k++)
        if (planes >> k & 1)
            add_wall(wall, k,
                     (fibrad_wall){.kind = FIBRAD_WALL_PLANE, .plane = {(int)k / 2, k % 2, k % 2 ? high : low}});
    if (s->bounds == CAN)
        add_wall(wall, 6,
                 (fibrad_wall){.kind = FIBRAD_WALL_CYLINDER, .cylinder = {middle, middle, .75 * (high - low), 2}});
    fibrad_scene_config config = part != NULL ? *part : (fibrad_scene_config){0};
    config.isa = isa, config.wall = wall, config.walls = walls;
    config.period[0] = config.period[1] = across, config.period[2] = s->bounds == PERIODIC ? period : 0;
    const fibrad_spheres spheres = {.x = x, .y = y, .z = z, .r = r, .n = s->n, .id = id};
    return fibrad_scene_init(scene, memory, size, &config, &spheres, NULL) != FIBRAD_OK;
}

static int scene_at(void *memory, size_t size, const struct scene *s, int isa, fibrad_scene **scene) {
    return scene_part(memory, size, s, isa, NULL, NULL, scene);
}

static int set_up(const struct scene *s, int isa, fibrad_scene **scene) {
    return scene_at(scene_memory, sizeof scene_memory, s, isa, scene);
}

/* Makes a matrix of the rows by a rule. */
static int matrix_of(const fibrad_scene *scene, const fibrad_matrix_rule *rule, fibrad_factors *factors,
                     double *reciprocity) {
    fibrad_matrix *matrix;
    if (fibrad_matrix_init(&matrix, matrix_memory, sizeof matrix_memory, scene, &rows, 1, rule, NULL) != FIBRAD_OK)
        return 1;
    return fibrad_matrix_close(matrix) != FIBRAD_OK || fibrad_matrix_read(matrix, factors) != FIBRAD_OK ||
           fibrad_matrix_reciprocity(matrix, reciprocity) != FIBRAD_OK;
}

/* Hashes all rows of a scene and the matrices made of them. */
static int hash_beam(const struct scene *s, int isa, uint32_t points) {
    static const char *const names[] = {"areas", "points64", "points128", "", "points256"};
    static const fibrad_matrix_rule raw = {.raw = 1}, drop = {.drop = 1e-3, .tasks = 7};
    fibrad_scene *scene;
    fibrad_factors factors;
    double largest;
    if (set_up(s, isa, &scene)) return 1;
    const fibrad_beam_rule rule = {.directions = 55, .points = points, .cutoff = s->cutoff};
    fibrad_rows_clear(&rows);
    hash_begin();
    for (uint32_t i = 0; i < s->n; i++) {
        fibrad_row row = {.rows = &rows};
        if (fibrad_beam_row(scene, &work, i, &rule, &row) != FIBRAD_OK) return 1;
        hash_number(row.escaped), hash_number(row.error);
    }
    uint64_t first = hash;
    if (matrix_of(scene, &raw, &factors, &largest)) return 1;
    hash_factors(&factors);
    hash_word(first);
    tell(s->name, names[points / 64]);
    if (points != 0 && points != 64) return 0;

    if (matrix_of(scene, &(fibrad_matrix_rule){0}, &factors, &largest)) return 1;
    hash_factors(&factors);
    tell(s->name, points == 0 ? "areas.reciprocal" : "points64.reciprocal");
    if (matrix_of(scene, &drop, &factors, &largest)) return 1;
    hash_factors(&factors);
    tell(s->name, points == 0 ? "areas.dropped" : "points64.dropped");
    return 0;
}

/* Hashes all rows along lines, by each kind of window, and their matrices. The sets have an even and an odd number of
 * lines, with a table and without. */
static int hash_lines(const struct scene *s, int isa) {
    static unsigned char object[1 << 16];
    static const struct { uint32_t lines, chords; } kinds[] = {{34, FIBRAD_CHORDS_NONE}, {21, 16}, {34, 32}, {23, 64}};
    fibrad_scene *scene;
    if (set_up(s, isa, &scene)) return 1;
    hash_begin();
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        fibrad_line_set *set;
        fibrad_factors factors;
        double largest;
        if (fibrad_line_set_init(&set, object, sizeof object, kinds[k].lines) != FIBRAD_OK) return 1;
        const fibrad_beam_rule rule = {.lines = set, .chords = kinds[k].chords, .cutoff = s->cutoff};
        fibrad_rows_clear(&rows);
        for (uint32_t i = 0; i < s->n; i++) {
            fibrad_row row = {.rows = &rows};
            if (fibrad_beam_row(scene, &work, i, &rule, &row) != FIBRAD_OK) return 1;
            hash_number(row.escaped), hash_number(row.error), hash_number(row.noise), hash_number(row.shares);
            for (uint32_t e = 0; e < row.length; e++) hash_number((double)row.half[e]);
        }
        if (matrix_of(scene, &(fibrad_matrix_rule){.tasks = 3}, &factors, &largest)) return 1;
        hash_factors(&factors);
        for (uint32_t i = 0; i < s->n; i++) {
            hash_walls(factors.wall + (size_t)i * walls);
            hash_number(factors.escaped[i]), hash_number(factors.error[i]);
        }
    }
    tell(s->name, "lines");
    return 0;
}

/* Hashes raw rows by the surface method, of every seventh sphere. */
static int hash_surface(const struct scene *s, int isa) {
    fibrad_scene *scene;
    if (set_up(s, isa, &scene)) return 1;
    fibrad_surface_rule rule = {.nodes = 13, .cutoff = 5};
    hash_begin();
    for (uint32_t i = 0; i < s->n; i += 7) {
        fibrad_row row = row_here();
        if (fibrad_surface_row(scene, &work, i, &rule, &row) != FIBRAD_OK) return 1;
        for (uint32_t k = 0; k < row.length; k++) hash_word(col[k]), hash_number(f[k]);
        hash_number(row.escaped), hash_number(row.error);
    }
    tell(s->name, "surface");
    return 0;
}

/* Hashes raw rows by rays, of every seventh sphere, with their mean lengths and angles. */
static int hash_cast(const struct scene *s, int isa, int random) {
    static double length[SPHERES], angle[SPHERES];
    fibrad_scene *scene;
    if (set_up(s, isa, &scene)) return 1;
    fibrad_cast_rule rule = {.rays = 1000, .random = random, .seed = 5, .cutoff = s->cutoff};
    hash_begin();
    for (uint32_t i = 0; i < s->n; i += 7) {
        fibrad_row row = row_here();
        if (fibrad_cast_row(scene, &work, i, &rule, &row, &(fibrad_cast_means){length, angle}) != FIBRAD_OK) return 1;
        for (uint32_t k = 0; k < row.length; k++)
            hash_word(col[k]), hash_number(f[k]), hash_number(length[k]), hash_number(angle[k]);
        hash_number(row.escaped), hash_number(row.error);
    }
    tell(s->name, random ? "mc" : "cast");
    return 0;
}

/* ---- heat, exchange, walls, what moves: small scenes ------------------------------------------------------------ */

static double temperature[SPHERES], emissivity[SPHERES], power[SPHERES];
static double wall_temperature[WALLS], wall_emissivity[WALLS]; /* values of all walls, and of the existing walls: */
static double wall_temperature[WALLS], wall_emissivity[WALLS], wall_power[WALLS];

/* Temperatures and emissivities of all spheres and walls, between two bounds. */
static fibrad_heat_sources sources_of(const struct scene *s, uint64_t seed, double lowest, double highest) {
    fibrad_heat_sources sources;
    fibrad_heat_sources_init(&sources);
    sources.temperature = temperature, sources.emissivity = emissivity;
    sources.wall_temperature = wall_temperature, sources.wall_emissivity = wall_emissivity;
    sources.surroundings = .5, sources.sigma = 1;
    state = seed;
    for (uint32_t i = 0; i < s->n; i++) temperature[i] = random_in(1, 2), emissivity[i] = random_in(lowest, highest);
    for (int k = 0; k < WALLS; k++)
        wall_temperature[k] = random_in(1, 2), wall_emissivity[k] = random_in(lowest, highest);
    for (uint32_t b = 0; b < walls; b++)
        wall_temperature[b] = wall_temperature[wall_of[b]], wall_emissivity[b] = wall_emissivity[wall_of[b]];
    return sources;
}

static void hash_result(const struct scene *s, const fibrad_heat_result *result) {
    hash_begin();
    for (uint32_t i = 0; i < s->n; i++) hash_number(result->power[i]);
    hash_walls(result->wall_power);
    hash_number(result->surroundings_power), hash_number(result->error_patches), hash_number(result->error_beams);
    hash_number(result->residual), hash_word(result->sweeps);
}

static void hash_facts(const struct scene *s, const fibrad_scene *scene) {
    fibrad_scene_facts facts;
    fibrad_scene_describe(scene, &facts);
    hash_begin();
    hash_word(facts.spheres), hash_number(facts.radius_min), hash_number(facts.radius_max);
    hash_number(facts.overlap_max), hash_word(facts.overlap_pair[0]), hash_word(facts.overlap_pair[1]);
    double area[WALLS];
    for (uint32_t b = 0; b < walls; b++) area[b] = fibrad_scene_wall_area(scene, b);
    hash_walls(area);
    tell(s->name, "facts");
}

/* The matrix of the rows, closed. */
static int hash_matrix(const struct scene *s, const fibrad_scene *scene, const fibrad_matrix_rule *rule,
                       const char *name) {
    fibrad_factors factors;
    double largest;
    if (matrix_of(scene, rule, &factors, &largest)) return 1;
    hash_factors(&factors);
    hash_number(largest);
    for (uint32_t i = 0; i < s->n; i++) {
        hash_walls(factors.wall + (size_t)i * walls);
        hash_number(factors.escaped[i]), hash_number(factors.error[i]);
    }
    tell(s->name, name);
    return 0;
}

/* Rows with factors to walls, and their matrix. */
static int hash_closed(const struct scene *s, int isa, uint32_t points) {
    static const char *const names[] = {"areas.walls", "points64.walls", "points128.walls", "", "points256.walls"};
    fibrad_scene *scene;
    if (set_up(s, isa, &scene)) return 1;
    if (points == 0) hash_facts(s, scene);
    fibrad_beam_rule rule = {.points = points};
    fibrad_rows_clear(&rows);
    hash_begin();
    for (uint32_t i = 0; i < s->n; i++) {
        rule.directions = 34 + 13 * (i % 3);
        fibrad_row row = row_here();
        if (fibrad_beam_row(scene, &work, i, &rule, &row) != FIBRAD_OK ||
            fibrad_rows_add(&rows, &row, walls) != FIBRAD_OK)
            return 1;
        hash_row(&row);
        hash_word(row.directions);
    }
    tell(s->name, names[points / 64]);
    return points == 0 && hash_matrix(s, scene, &(fibrad_matrix_rule){.tasks = 3}, "areas.closed");
}

/* Beam rows to a tolerance, by areas and by points, and the next number of directions. */
static int hash_tolerance(const struct scene *s, int isa) {
    fibrad_scene *scene;
    if (set_up(s, isa, &scene)) return 1;
    for (uint32_t points = 0; points <= 256; points += 256) {
        fibrad_beam_rule rule = {.directions = 20, .points = points, .tolerance = .02};
        hash_begin();
        for (uint32_t i = 0; i < s->n; i += 9) {
            fibrad_row row = row_here();
            rule.directions = i == 0 ? 0 : 20;
            if (fibrad_beam_row(scene, &work, i, &rule, &row) != FIBRAD_OK) return 1;
            hash_row(&row);
            hash_word(row.directions), hash_word(fibrad_directions_for(row.directions, row.error, 1e-4 * (i + 1)));
        }
        tell(s->name, points ? "points256.tolerance" : "areas.tolerance");
    }
    return 0;
}

static int hash_displacements(const struct scene *s, const fibrad_scene *scene, const fibrad_displacement_rule *rule,
                              const char *what) {
    hash_begin();
    for (uint32_t i = 0; i < s->n; i += 4) {
        fibrad_displacement displacement;
        if (fibrad_exchange_displacement(scene, &work, i, rule, &displacement) != FIBRAD_OK) return 1;
        for (int axis = 0; axis < 3; axis++)
            hash_number(displacement.square[axis]), hash_number(displacement.error[axis]);
        hash_number(displacement.absorbed), hash_word(displacement.rays);
    }
    tell(s->name, what);
    return 0;
}

/* Walks of spheres that conduct. */
static int hash_walk(const struct scene *s, const fibrad_scene *scene, fibrad_displacement_rule rule) {
    static double conductivity[SPHERES];
    for (uint32_t i = 0; i < s->n; i++) conductivity[i] = i % 7 == 0 ? __builtin_inf() : .01 * (1 << i % 11);
    rule.conductivity = conductivity, rule.flights = 5;
    return hash_displacements(s, scene, &rule, "walk");
}

/* Exchange rows by a fixed number of paths and to a tolerance, their matrix, and displacements. */
static int hash_exchange(const struct scene *s, int isa) {
    fibrad_scene *scene;
    if (set_up(s, isa, &scene)) return 1;
    (void)sources_of(s, 9, .2, 1);
    for (uint32_t b = 0; b < walls; b++)
        wall_emissivity[b] = wall_of[b] == 6 ? .4 : wall_of[b] % 3 ? wall_emissivity[wall_of[b]] : 0;
    fibrad_exchange_rule rule = {.emissivity = emissivity, .wall_emissivity = wall_emissivity, .paths = 100, .seed = 3};
    uint64_t rays;
    for (int tolerance = 0; tolerance < 2; tolerance++) {
        rule.tolerance = tolerance ? .03 : 0;
        hash_begin();
        for (uint32_t i = 0; i < s->n; i += tolerance ? 9 : 4) {
            fibrad_row row = row_here();
            rule.directions = i % 8 == 0 ? 160 : 0; /* by areas, by points */
            if (fibrad_exchange_row(scene, &work, i, &rule, &row, &rays) != FIBRAD_OK) return 1;
            hash_row(&row);
            hash_word(rays);
        }
        tell(s->name, tolerance ? "exchange.tolerance" : "exchange");
    }
    rule.tolerance = 0, rule.directions = 0;
    fibrad_rows_clear(&rows);
    for (uint32_t i = s->n; i-- > 0;)
        if (fibrad_exchange_row(scene, &work, i, &rule, &(fibrad_row){.rows = &rows}, NULL) != FIBRAD_OK) return 1;
    if (hash_matrix(s, scene, &(fibrad_matrix_rule){.kind = FIBRAD_ROWS_EXCHANGE, .emissivity = emissivity},
                    "exchange.closed"))
        return 1;
    const fibrad_displacement_rule carried = {
        .emissivity = emissivity, .wall_emissivity = wall_emissivity, .paths = rule.paths, .seed = rule.seed};
    if (hash_displacements(s, scene, &carried, "spread")) return 1;
    return walls == 0 && s->bounds == PERIODIC ? hash_walk(s, scene, carried) : 0;
}

/* Rows of a part of a bed with a cutoff, without and with an occupancy: beams by areas, by points and turned, cast
 * and exchange. The powers that follow from them are hashed, too. */
static int hash_part(const struct scene *s, int isa) {
    static const uint64_t mark[] = {UINT64_C(0x0f3c55aa00ff9981)};
    static uint64_t id[SPHERES];
    const fibrad_occupancy occupancy = {
        .low = {-2, -2, -2}, .high = {7, 8, 9}, .cells = {4, 4, 4}, .periodic = {1, 0, 1}, .mark = mark};
    for (uint32_t i = 0; i < s->n; i++) id[i] = (uint64_t)(s->n - i) << 40;
    (void)sources_of(s, 9, .2, 1);
    for (int occupied = s->bounds == PERIODIC; occupied < 2; occupied++) {
        const fibrad_scene_config config = {.occupancy = occupied ? &occupancy : NULL};
        fibrad_scene *scene;
        if (scene_part(scene_memory, sizeof scene_memory, s, isa, &config, id, &scene)) return 1;
        for (uint32_t b = 0; b < walls; b++) wall_emissivity[b] = wall_emissivity[wall_of[b]];
        const double cutoff = 3.1;
        hash_begin();
        fibrad_rows_clear(&rows);
        for (uint32_t i = 0; i < s->n; i++) {
            const fibrad_beam_rule beam = {
                .directions = 34, .points = i % 2 ? 64 : 0, .cutoff = cutoff, .turn = i % 3 ? i : 0};
            const fibrad_cast_rule cast = {.rays = 200, .cutoff = cutoff};
            fibrad_exchange_rule exchange = {.emissivity = emissivity, .wall_emissivity = wall_emissivity, .paths = 50};
            exchange.seed = i % 2 ? 77 : 0, exchange.cutoff = cutoff;
            for (int method = 0; method < 3; method++) {
                fibrad_row row = row_here();
                const int status = method == 0   ? fibrad_beam_row(scene, &work, i, &beam, &row)
                                   : method == 1 ? fibrad_cast_row(scene, &work, i, &cast, &row, NULL)
                                                 : fibrad_exchange_row(scene, &work, i, &exchange, &row, NULL);
                if (status != FIBRAD_OK) return 1;
                hash_row(&row);
                hash_number(row.beyond);
                if (method == 2 && fibrad_rows_add(&rows, &row, walls) != FIBRAD_OK) return 1;
            }
        }
        for (uint32_t i = 0; i < s->n; i++) power[i] = 0;
        for (uint32_t b = 0; b < walls; b++) wall_power[b] = 0, wall_temperature[b] = wall_temperature[wall_of[b]];
        fibrad_flow flow = {.weight = r, .emission = temperature, .wall_emission = wall_temperature};
        flow.surroundings_emission = 1, flow.power = power, flow.wall_power = wall_power;
        if (fibrad_rows_flow(&rows, s->n, walls, &flow) != FIBRAD_OK) return 1;
        for (uint32_t i = 0; i < s->n; i++) hash_number(power[i]);
        hash_walls(wall_power);
        hash_number(flow.surroundings_power);
        tell(s->name, occupied ? "part" : "cut");
    }
    return 0;
}

static unsigned char heat_memory[12 << 20];

/* Traces the beams of all surfaces. */
static int heat_trace(const struct scene *s, int isa, const fibrad_heat_config *config, fibrad_heat **heat) {
    fibrad_scene *scene;
    if (set_up(s, isa, &scene) || fibrad_heat_init(heat, heat_memory, sizeof heat_memory, config, scene) != FIBRAD_OK)
        return 1;
    for (uint32_t k = fibrad_heat_tasks(*heat); k-- > 0;)
        if (fibrad_heat_trace(*heat, &work, k) != FIBRAD_OK) return 1;
    return 0;
}

static int heat_solve(const struct scene *s, fibrad_heat *heat, const fibrad_heat_sources *sources, const char *name) {
    fibrad_heat_result result = {.power = power, .wall_power = wall_power};
    if (fibrad_heat_begin(heat, sources) != FIBRAD_OK) return 1;
    for (int solved = 0; !solved;) {
        for (uint32_t k = 0; k < fibrad_heat_parts(heat); k++)
            if (fibrad_heat_sweep(heat, k) != FIBRAD_OK) return 1;
        if (fibrad_heat_step(heat, &solved) != FIBRAD_OK) return 1;
    }
    if (fibrad_heat_read(heat, &result) != FIBRAD_OK) return 1;
    hash_result(s, &result);
    tell(s->name, name);
    return 0;
}

/* Powers: first from the beginning, then from the last solution, then from it with a large tolerance. */
static int hash_heat(const struct scene *s, int isa) {
    const fibrad_heat_config config = {.directions = 40, .parts = 3};
    fibrad_heat *heat;
    if (heat_trace(s, isa, &config, &heat)) return 1;
    fibrad_heat_sources sources = sources_of(s, 7, .1, .9);
    if (heat_solve(s, heat, &sources, "heat")) return 1;
    sources = sources_of(s, 8, .2, 1);
    emissivity[0] = 0, emissivity[1] = 1;
    if (heat_solve(s, heat, &sources, "heat.again")) return 1;
    sources = sources_of(s, 7, .1, .9);
    sources.tolerance = .1;
    return heat_solve(s, heat, &sources, "heat.rough");
}

/* Powers under other settings, at two emissivities. */
static int hash_heat_settings(const struct scene *s, int isa) {
    static const struct {
        fibrad_heat_config config;
        const char *name[2];
    } cases[] = {
        {{30, 64, 24, 1, 0}, {"heat.patches24.3", "heat.patches24.8"}},
        {{30, 64, 96, 1, 0}, {"heat.patches96.3", "heat.patches96.8"}},
        {{30, 64, 384, 1, 0}, {"heat.patches384.3", "heat.patches384.8"}},
        {{30, 64, 24, 2, 0}, {"heat.parts2.3", "heat.parts2.8"}},
        {{30, 64, 24, 7, 0}, {"heat.parts7.3", "heat.parts7.8"}},
        {{10, 128, 24, 2, 0}, {"heat.points128.3", "heat.points128.8"}},
        {{10, 256, 24, 2, 0}, {"heat.points256.3", "heat.points256.8"}},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        fibrad_heat *heat;
        if (heat_trace(s, isa, &cases[k].config, &heat)) return 1;
        for (int high = 0; high < 2; high++) {
            fibrad_heat_sources sources = sources_of(s, 7, .1, .9);
            for (uint32_t i = 0; i < s->n; i++) emissivity[i] = high ? .8 : .3;
            if (heat_solve(s, heat, &sources, cases[k].name[high])) return 1;
        }
    }
    return 0;
}

static int hash_small(const struct scene *s, int isa) {
    int failed = 0;
    for (uint32_t points = 0; points <= 256; points = points == 0 ? 64 : 2 * points)
        failed |= hash_closed(s, isa, points);
    failed |= hash_lines(s, isa);
    failed |= hash_tolerance(s, isa);
    failed |= hash_exchange(s, isa);
    return s->bounds == SLAB ? failed : failed | hash_heat(s, isa); /* rays of walls take long */
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
    if (fibrad_furnace_init(&furnace, matrix_memory, sizeof matrix_memory, &config) != FIBRAD_OK ||
        fibrad_furnace_tally_init(&tally, rows_memory, sizeof rows_memory, furnace) != FIBRAD_OK ||
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
    while (isa <= FIBRAD_ISA_NEON && (argc < 2 || strcmp(argv[1], fibrad_isa_name(isa)) != 0)) isa++;
    fibrad_scene *empty;
    const int status = fibrad_scene_init(&empty, scene_memory, sizeof scene_memory, &(fibrad_scene_config){.isa = isa},
                                         &(fibrad_spheres){0}, NULL);
    if (status != FIBRAD_OK) return status == FIBRAD_E_ISA ? 77 : 1;
    failed |= hash_pairs();
    failed |= hash_directions();
    for (size_t k = 0; k < sizeof scenes / sizeof *scenes; k++) {
        make(&scenes[k]);
        for (uint32_t points = 0; points <= 256; points = points == 0 ? 64 : 2 * points)
            failed |= hash_beam(&scenes[k], isa, points);
        failed |= hash_lines(&scenes[k], isa);
        failed |= hash_surface(&scenes[k], isa);
        failed |= hash_cast(&scenes[k], isa, 0);
        failed |= hash_cast(&scenes[k], isa, 1);
    }
    failed |= hash_furnace();
    make(&scenes[1]);
    for (size_t k = 0; k < sizeof small / sizeof *small; k++) {
        make(&small[k]);
        failed |= hash_small(&small[k], isa);
        failed |= hash_part(&small[k], isa);
    }
    make(&small[0]);
    failed |= hash_heat_settings(&small[0], isa);
    return failed;
}
