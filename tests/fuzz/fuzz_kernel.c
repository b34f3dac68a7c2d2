/* fuzz_kernel.c - libFuzzer target: any arguments to the functions of fibrad.h. SPDX-License-Identifier: MIT
 *
 * The input is read as a stream of choices. Every block has exactly the size stated to the function, so that the
 * address sanitizer sees a byte too far; everything returned with FIBRAD_OK must be what the header promises. */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fibrad.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

#define REQUIRE(condition)                                                                                             \
    do {                                                                                                               \
        if (!(condition)) {                                                                                            \
            fprintf(stderr, "%s:%d: not so: %s\n", __FILE__, __LINE__, #condition);                                    \
            abort();                                                                                                   \
        }                                                                                                              \
    } while (0)

static const uint8_t *at, *end;

static uint8_t byte(void) { return at < end ? *at++ : 0; }

static uint32_t number(void) {
    uint32_t n = byte();
    return n < 250 ? n : (uint32_t)byte() << 24 | (uint32_t)byte() << 16 | (uint32_t)byte() << 8 | byte();
}

/* Mostly plain numbers on a coarse grid, which touch and coincide; now and then any bits at all. */
static double coordinate(void) {
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

/* A block of exactly `size` bytes; misplaced by `shift` (the pointer to free is *block). */
static void *memory_of(size_t size, size_t shift, void **block) {
    *block = aligned_alloc(64, (size + shift + 63) / 64 * 64);
    REQUIRE(*block != NULL);
    unsigned char *memory = *block;
    memset(memory, 0xa5, size + shift);
    return memory + shift;
}

static double *copies(uint32_t n, double (*next)(void)) {
    double *array = malloc(n * sizeof *array + 1);
    REQUIRE(array != NULL);
    for (uint32_t i = 0; i < n; i++) array[i] = next();
    return array;
}

/* ---- scenes and rows -------------------------------------------------------------------------------------------- */

static bool plain; /* all lengths lie within what a bed can be */
static bool tame;  /* they are far from that, but a row takes far less than a second: no 1e9 radii across a box */

static double shortest; /* period */

static double length(void) {
    double c = coordinate();
    tame = tame && fabs(c) < 1e6 && (c == 0 || fabs(c) > 1e-6);
    plain = plain && fabs(c) < 100 && (c == 0 || fabs(c) > 0.1);
    return c;
}

static double radius(void) {
    double c = length();
    return c <= 0 && c >= -30 && byte() < 250 ? .25 - c / 8 : c;
}

static void check_row(const fibrad_row *row, const fibrad_scene *scene, uint32_t points) {
    fibrad_scene_facts facts;
    fibrad_scene_describe(scene, &facts);
    double sum = row->escaped;
    REQUIRE(row->length <= row->capacity);
    for (uint32_t k = 0; k < row->length; k++) {
        REQUIRE(row->col[k] < facts.spheres && (k == 0 || row->col[k] > row->col[k - 1]));
        REQUIRE(row->f[k] > 0 && row->f[k] <= 1 + 1e-9);
        sum += row->f[k];
    }
    for (int wall = 0; wall < FIBRAD_WALLS; wall++) {
        REQUIRE(row->wall[wall] >= 0 && (row->wall[wall] == 0 || facts.wall_area[wall] > 0));
        sum += row->wall[wall];
    }
    REQUIRE(row->escaped >= -1e-9 && row->error >= 0);
    if (plain || points > 0) REQUIRE(fabs(sum - 1) < 1e-9);
}

static void try_surface_row(const fibrad_scene *scene, fibrad_work *work, uint32_t i, fibrad_row *row) {
    static const uint32_t nodes[] = {0, 8, 13, 21, 34, 9};
    fibrad_surface_rule rule = {.nodes = nodes[byte() % 6], .flags = byte() & 31, .cutoff = coordinate()};
    if (rule.cutoff > 8 * shortest && rule.cutoff < 101 * shortest) return; /* up to 2^28 images: too slow */
    if (fibrad_surface_row(scene, work, i, &rule, row) != FIBRAD_OK) return;
    REQUIRE(row->length <= row->capacity);
    for (uint32_t k = 0; k < row->length; k++) REQUIRE(row->f[k] >= 0 && (k == 0 || row->col[k] > row->col[k - 1]));
}

static void try_cast_row(const fibrad_scene *scene, fibrad_work *work, uint32_t i, fibrad_row *row, bool random) {
    fibrad_cast_rule rule = {.rays = 1 + number() % 300, .random = random, .seed = number(), .cutoff = coordinate()};
    if (byte() < 128) rule.cutoff = 0;
    fibrad_cast_means means = {.length = malloc(row->capacity * sizeof(double) + 1),
                               .angle = malloc(row->capacity * sizeof(double) + 1)};
    REQUIRE(means.length != NULL && means.angle != NULL);
    if (fibrad_cast_row(scene, work, i, &rule, row, &means) == FIBRAD_OK) {
        check_row(row, scene, rule.rays);
        for (uint32_t k = 0; k < row->length; k++)
            REQUIRE(means.length[k] >= 0 && means.angle[k] >= 0 && means.angle[k] < 1.6);
    }
    free(means.length), free(means.angle);
}

/* Where nothing moves, no row is off. */
static void check_unmoved(const fibrad_scene *scene, uint32_t n, uint32_t i, const fibrad_row *row) {
    double *error = calloc(n, sizeof *error), *reach = calloc(n, sizeof *reach), moved;
    unsigned char *same = malloc(n), *scratch = malloc(2 * (size_t)n);
    REQUIRE(error != NULL && reach != NULL && same != NULL && scratch != NULL);
    REQUIRE(row->reach >= 0);
    reach[i] = row->reach;
    REQUIRE(fibrad_moved_error(scene, scene, i, row, &moved) == FIBRAD_OK && moved == 0);
    REQUIRE(fibrad_moved_seen(scene, i, row, row, error) == FIBRAD_OK);
    REQUIRE(fibrad_moved_same(scene, scene, reach, scratch, same) == FIBRAD_OK);
    for (uint32_t j = 0; j < n; j++) REQUIRE(error[j] == 0 && same[j] == 1);
    free(error), free(reach), free(same), free(scratch);
}

static void try_row(const fibrad_scene *scene, uint32_t n) {
    fibrad_work_config config = {number() % 300, number() % 60, number() % 40};
    size_t size = fibrad_work_size(&config);
    REQUIRE(size > 0);
    uint8_t fault = byte();
    fibrad_work *work = NULL;
    void *block, *memory = memory_of(size - (fault == 1 ? 64 : 0), fault == 2 ? 8 : 0, &block);
    int status = fibrad_work_init(&work, memory, size - (fault == 1 ? 64 : 0), &config);
    REQUIRE(status == (fault == 1 ? FIBRAD_E_SIZE : fault == 2 ? FIBRAD_E_ALIGNMENT : FIBRAD_OK));
    if (status == FIBRAD_OK) {
        uint32_t capacity = number() % 64;
        fibrad_row row = {.col = malloc(capacity * sizeof(uint32_t) + 1),
                          .f = malloc(capacity * sizeof(double) + 1),
                          .capacity = capacity};
        REQUIRE(row.col != NULL && row.f != NULL);
        fibrad_beam_rule rule = {.directions = 8 + number() % 64};
        uint8_t which = byte();
        if (which < 100) rule.points = 64u << which % 3;
        if (which == 101) rule.points = number();
        if (which == 102) rule.directions = number() % 8;
        if (which > 200) rule.cutoff = coordinate();
        if (which == 104 || which == 105) try_cast_row(scene, work, number() % (n + 1), &row, which == 105);
        if (which == 103) try_surface_row(scene, work, number() % (n + 1), &row);
        uint32_t i = number() % (n + 1);
        status = fibrad_beam_row(scene, work, i, &rule, &row);
        if (status == FIBRAD_OK) check_row(&row, scene, rule.points);
        if (status == FIBRAD_OK) check_unmoved(scene, n, i, &row);
        if (status == FIBRAD_E_CAPACITY && row.length == 0) {
            fibrad_work_config more;
            fibrad_work_needed(work, &more);
            REQUIRE(more.entries <= (n > config.entries ? n : config.entries) || config.entries == 0);
            REQUIRE(fibrad_work_size(&more) >= size);
        }
        free(row.col), free(row.f);
    }
    free(block);
}

static fibrad_walls any_walls(void) {
    fibrad_walls walls = {.planes = byte() % 68};
    for (int k = 0; k < 6; k++) walls.at[k] = 8 * length();
    if (byte() % 4 == 0) walls.planes &= 112;
    for (int k = 0; k < 3 && (walls.planes & 15) == 0; k++) walls.cylinder[k] = length();
    return walls;
}

static void try_scene(bool walled) {
    uint32_t n = number(), stated = byte() < 250 ? n : number();
    n = n % 24;
    if (stated >= 250)
        stated %= 1u << 20;
    else
        stated %= 24;
    fibrad_scene_config config = {.spheres = stated, .isa = byte() % 6};
    plain = tame = true;
    shortest = INFINITY;
    for (int axis = 0; axis < 3; axis++) {
        config.period[axis] = byte() < 160 ? 0 : fabs(length());
        if (config.period[axis] > 0) shortest = fmin(shortest, config.period[axis]);
    }
    if (walled) config.walls = any_walls();
    size_t size = fibrad_scene_size(&config);
    REQUIRE(size == 0 || stated > 0);
    REQUIRE(size <= FIBRAD_SCENE_BYTES(stated));
    uint8_t fault = byte();
    double *x = copies(n, length), *y = copies(n, length), *z = copies(n, length), *r = copies(n, radius);
    fibrad_spheres spheres = {x, y, z, r, n};
    size_t given = fault == 1 && size > 0 ? size - 1 : size;
    void *block, *memory = memory_of(given, fault == 2 ? 16 : 0, &block);
    fibrad_scene *scene = NULL;
    fibrad_fault where = {0, 0};
    int status = fibrad_scene_init(&scene, memory, given, &config, &spheres, &where);
    if (status == FIBRAD_OK) {
        REQUIRE(scene != NULL && fault != 1 && fault != 2 && stated == n);
        for (int k = byte() % 4; k >= 0 && tame; k--) try_row(scene, n);
    } else {
        REQUIRE(scene == NULL && where.first <= n && where.second <= n);
    }
    free(block), free(x), free(y), free(z), free(r);
}

/* ---- matrices --------------------------------------------------------------------------------------------------- */

static double any_factor(void) {
    uint8_t b = byte();
    return b < 240 ? b / 255.0 : coordinate();
}

static void try_rows(void) {
    uint32_t n = 1 + number() % 8, length = number() % 40;
    bool sound = byte() < 200; /* or starts and columns as they come */
    uint64_t *start = malloc((n + 1) * sizeof *start), *start_out = malloc((n + 1) * sizeof *start_out);
    uint32_t *col = malloc(length * sizeof *col + 1);
    double *f = copies(length, any_factor), *r = copies(n, radius), *scratch = malloc(3 * n * sizeof *scratch);
    REQUIRE(start != NULL && start_out != NULL && col != NULL && scratch != NULL);
    uint32_t used = 0;
    start[0] = sound ? 0 : number() % 3;
    for (uint32_t i = 0; i < n; i++) {
        uint32_t next = 0;
        while (sound && used < length && byte() % 4 != 0 && next < n) next += byte() % n, col[used++] = next++;
        while (used > 0 && sound && col[used - 1] >= n) used--;
        start[i + 1] = sound ? used : number();
        if (sound && start[i + 1] < start[i]) start[i + 1] = used = (uint32_t)start[i];
    }
    if (!sound)
        for (uint32_t k = 0; k < length; k++) col[k] = number() % (n + 1);
    fibrad_rows rows = {.n = n, .capacity = length, .start = start, .col = col, .f = f};

    uint32_t capacity = number() % 80;
    fibrad_rows out = {.n = n, .capacity = capacity, .start = start_out};
    out.col = malloc(capacity * sizeof *out.col + 1), out.f = malloc(capacity * sizeof *out.f + 1);
    REQUIRE(out.col != NULL && out.f != NULL);
    void *col_out = out.col, *f_out = out.f;
    uint8_t shared = byte(); /* arrays of input and output that are one and the same are refused */
    if (shared == 1 && capacity <= length) out.f = rows.f;
    if (shared == 2 && capacity <= length) out.col = rows.col;
    if (shared == 3) out.start = rows.start;
    double largest;
    int reciprocity = fibrad_rows_reciprocity(&rows, r, &largest);
    int status = fibrad_rows_average(&rows, r, &out);
    if (status == FIBRAD_OK) {
        REQUIRE(reciprocity == FIBRAD_OK && out.start[n] <= capacity && (out.f != rows.f || out.start[n] == 0));
        REQUIRE(fibrad_rows_reciprocity(&out, r, &largest) == FIBRAD_OK);
    }
    if (out.start != rows.start) {
        (void)fibrad_rows_limit(&rows, scratch);
        double walls[8][FIBRAD_WALLS] = {{0}}, escaped[8] = {0};
        walls[0][0] = any_factor();
        (void)fibrad_rows_close(&rows, r, walls, escaped);
        status = fibrad_rows_drop(&rows, r, any_factor(), scratch);
        if (status == FIBRAD_OK) REQUIRE(rows.start[n] <= rows.capacity);
    }
    free(start), free(start_out), free(col), free(f), free(r), free(scratch), free(col_out), free(f_out);
}

/* ---- furnace ---------------------------------------------------------------------------------------------------- */

/* From 1e-12 to 1e12, mostly near 1; now and then what is none. */
static double positive(void) {
    uint8_t b = byte();
    return b < 200 ? exp2((b - 100) / 25.0) : b < 245 ? pow(10, b - 222.) : coordinate();
}

static void write_some(double *array, size_t n) {
    for (int k = byte() % 3; k > 0; k--) array[number() % n] = byte() < 128 ? positive() : coordinate();
}

static void try_furnace(void) {
    fibrad_furnace_config config = {.seed = byte()};
    double thickness = 0, reflected = 1;
    for (int a = 0; a < 3; a++) config.size[a] = positive(), config.cells[a] = number() % 4;
    if (byte() == 1) config.cells[byte() % 3] = number();
    config.absorption = positive(), config.scattering = byte() < 128 ? 0 : positive(), config.source = coordinate();
    for (int w = 0; w < 6; w++) {
        config.wall_temperature[w] = 300 * positive();
        config.wall_emissivity[w] = byte() < 250 ? byte() / 255. : coordinate();
        reflected = fmin(reflected, 1 - config.wall_emissivity[w]);
    }
    for (int a = 0; a < 3; a++) thickness += (config.absorption + config.scattering) * config.size[a];
    /* bundles go on for long where little is lost */
    bool quick = thickness < 30 && thickness > .1 && config.scattering < 20 * config.absorption;

    size_t size = fibrad_furnace_size(&config);
    if (size == 0 || size > 1 << 20) return;
    uint8_t fault = byte();
    fibrad_furnace *furnace = NULL;
    void *block, *tally_block, *memory = memory_of(size - (fault == 1), fault == 2 ? 8 : 0, &block);
    int status = fibrad_furnace_init(&furnace, memory, size - (fault == 1), &config);
    REQUIRE(status == (fault == 1 ? FIBRAD_E_SIZE : fault == 2 ? FIBRAD_E_ALIGNMENT : FIBRAD_OK));
    if (status != FIBRAD_OK) {
        free(block);
        return;
    }
    size_t tally_size = fibrad_furnace_tally_size(furnace);
    fibrad_furnace_tally *tally;
    memory = memory_of(tally_size, 0, &tally_block);
    REQUIRE(fibrad_furnace_tally_init(&tally, memory, tally_size, furnace) == FIBRAD_OK);
    fibrad_furnace_arrays arrays;
    fibrad_furnace_fields(furnace, &arrays);
    const size_t cells = (size_t)config.cells[0] * config.cells[1] * config.cells[2];
    for (size_t k = 0; k < cells; k++) REQUIRE(isfinite(arrays.e[k]) && isfinite(arrays.divergence[k]));

    for (int step = byte() % 8; step > 0; step--) {
        fibrad_furnace_scatter scatter = byte() % 2 ? FIBRAD_SCATTER_EXACT : FIBRAD_SCATTER_SIX_FLUX;
        fibrad_furnace_physics physics = byte() % 2 ? FIBRAD_FURNACE_EQUILIBRIUM : FIBRAD_FURNACE_ATTENUATED;
        fibrad_furnace_report report;
        uint64_t planned = 0;
        switch (byte() % 8) {
        case 0:
            (void)fibrad_furnace_theta(furnace, positive());
            break;
        case 1:
            (void)fibrad_furnace_solve(furnace, scatter, positive(), number() % 50, &report);
            break;
        case 2:
            write_some(arrays.e, cells);
            write_some(arrays.theta[byte() % 3][byte() % 2], cells);
            write_some(arrays.flux[byte() % 3][byte() % 2], cells);
            (void)fibrad_furnace_balance(furnace);
            break;
        case 3:
            (void)fibrad_furnace_estimate(furnace, tally, byte() % 2 ? FIBRAD_THETA_PAPER : FIBRAD_THETA_DEFINITION,
                                          byte() % 2, scatter);
            break;
        case 4:
            (void)fibrad_furnace_equilibrium(furnace, tally);
            break;
        default:
            status = fibrad_furnace_emit(furnace, physics, 1 + number() % 500, byte() % 2, &planned);
            if (physics == FIBRAD_FURNACE_EQUILIBRIUM && reflected > .9) break;
            if (status == FIBRAD_OK && quick)
                (void)fibrad_furnace_trace(furnace, tally, planned / 2, planned < 2000 ? planned - planned / 2 : 1000);
        }
    }
    (void)fibrad_furnace_temperature(arrays.e[0]);
    fibrad_furnace_tally_add(tally, tally);
    free(block), free(tally_block);
}

static void try_pair(void) {
    double r1 = coordinate(), r2 = coordinate(), gap = coordinate(), f12 = -1, f21 = -1;
    int status = fibrad_pair_exact(r1, r2, gap, &f12);
    REQUIRE(status == fibrad_pair_exact(r2, r1, gap, &f21));
    if (status == FIBRAD_OK) REQUIRE(f12 >= 0 && f12 <= 1 && f21 >= 0 && f21 <= 1);
    uint32_t n_obstacles = number() % 12, misplaced = byte() == 1;
    double *x = copies(n_obstacles, coordinate), *y = copies(n_obstacles, coordinate);
    double *z = copies(n_obstacles, coordinate), *r = copies(n_obstacles, coordinate);
    fibrad_spheres obstacles = {x, y, z, r, n_obstacles};
    void *block, *scratch = memory_of(FIBRAD_SURFACE_SCRATCH(n_obstacles) * sizeof(double), 8 * misplaced, &block);
    fibrad_surface_rule rule = {.nodes = 8, .flags = byte() & 31, .isa = byte() % 6};
    if (fibrad_isa_best() < (fibrad_isa)rule.isa) rule.isa = FIBRAD_ISA_BEST;
    status = fibrad_surface_pair(r1, r2, gap, &obstacles, &rule, scratch, &f12, NULL);
    if (status == FIBRAD_OK) REQUIRE(f12 >= 0 && f12 < 1.5);
    free(block), free(x), free(y), free(z), free(r);
    double w[3] = {0, 0, 0};
    (void)fibrad_directions_for(number(), coordinate(), coordinate());
    uint32_t k = number(), n = number();
    if (fibrad_direction(k, n, w) == FIBRAD_OK) REQUIRE(fabs(w[0] * w[0] + w[1] * w[1] + w[2] * w[2] - 1) < 1e-15);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    at = data, end = data + size;
    const uint8_t kind = byte() % 8;
    switch (kind) {
    case 0:
        try_pair();
        break;
    case 1:
        try_rows();
        break;
    case 2:
        try_furnace();
        break;
    default:
        try_scene(kind == 7);
    }
    (void)fibrad_status_text((int)number());
    (void)fibrad_isa_name((int)number());
    return 0;
}
