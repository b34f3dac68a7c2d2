/* scenes.h - scenes and rows for tests: beds in, matrices out. SPDX-License-Identifier: MIT */
#ifndef TESTS_SCENES_H
#define TESTS_SCENES_H

#include <check.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "asserts.h"
#include "bed/packing.h"
#include "fibrad_mesh.h"
#include "owned.h"
#include "worst.h"

static inline void *block_of(size_t size) {
    void *block = aligned_alloc(64, (size + 63) / 64 * 64);
    ck_assert_ptr_nonnull(block);
    return block;
}

/* Whether bytes [from, to) of a block are all `value`: a guard. */
static inline bool bytes_are(const unsigned char *block, size_t from, size_t to, unsigned char value) {
    bool are = true;
    for (size_t k = from; k < to; k++) are = are && block[k] == value;
    return are;
}

static inline void add_sphere(struct bed *bed, double x, double y, double z, double r) {
    ck_assert_int_eq(bed_add(bed, &(struct bed_sphere){.x = x, .y = y, .z = z, .r = r}), 0);
}

/* A bed of the listed spheres. Each has (x, y, z, r). */
static inline struct bed bed_of(uint32_t n, const double spheres[][4]) {
    struct bed bed = bed_empty();
    for (uint32_t i = 0; i < n; i++) add_sphere(&bed, spheres[i][0], spheres[i][1], spheres[i][2], spheres[i][3]);
    return bed;
}

/* The same, without their number. */
#define BED(...) bed_of(sizeof(double[][4]){__VA_ARGS__} / sizeof(double[4]), (const double[][4]){__VA_ARGS__})

/* A cubic lattice of touching unit spheres about the origin, where the first sphere lies. 'p': simple, 'i':
 * body-centred, 'f': face-centred. Centres are at most `reach` from the origin. */
static inline struct bed lattice(char kind, double reach) {
    static const double basis[4][3] = {{0, 0, 0}, {0, .5, .5}, {.5, 0, .5}, {.5, .5, 0}}, centre[3] = {.5, .5, .5};
    double side = kind == 'p' ? 2 : kind == 'i' ? 4 / sqrt(3) : 2 * sqrt(2);
    int sites = kind == 'p' ? 1 : kind == 'i' ? 2 : 4, span = (int)(reach / side) + 1;
    struct bed bed = bed_empty();
    add_sphere(&bed, 0, 0, 0, 1);
    for (int i = -span; i <= span; i++)
        for (int j = -span; j <= span; j++)
            for (int k = -span; k <= span; k++)
                for (int s = 0; s < sites; s++) {
                    const double *b = kind == 'i' && s == 1 ? centre : basis[s];
                    double x = (i + b[0]) * side, y = (j + b[1]) * side, z = (k + b[2]) * side;
                    double d = sqrt(x * x + y * y + z * z);
                    if (d > 0 && d <= reach * (1 + 1e-12)) add_sphere(&bed, x, y, z, 1);
                }
    return bed;
}

/* A random bed of n spheres with radii in [low, high] and a given solid fraction. The bed is periodic or open. */
static inline struct bed packing(uint32_t n, double low, double high, double fraction, uint64_t seed, bool periodic) {
    struct bed bed = bed_empty();
    ck_assert_int_eq(bed_make_packing(&bed, n, low, high, fraction, seed), 0);
    for (int axis = 0; axis < 3 && !periodic; axis++) bed.period[axis] = 0;
    return bed;
}

/* Makes `to` a bed 2^k times as large as a bed of as many spheres. */
static inline void scale_bed(struct bed *to, const struct bed *bed, int k) {
    for (uint32_t i = 0; i < bed->n; i++) {
        to->x[i] = ldexp(bed->x[i], k), to->y[i] = ldexp(bed->y[i], k), to->z[i] = ldexp(bed->z[i], k);
        to->r[i] = ldexp(bed->r[i], k);
    }
    for (int axis = 0; axis < 3; axis++) to->period[axis] = ldexp(bed->period[axis], k);
}

/* A unit cube with a few large spheres, and with n - 6 small spheres at random about them. */
static inline struct bed strewn(uint32_t n, uint64_t seed) {
    struct bed bed = bed_empty();
    for (uint64_t at = 0; bed.n < n; at += 4) {
        double c[3], r = bed.n < 6 ? .2 : .01 + .01 * bed_make_random(seed, at);
        bool fits = true;
        for (uint64_t axis = 0; axis < 3; axis++) c[axis] = bed_make_random(seed, at + 1 + axis);
        for (uint32_t j = 0; j < bed.n && fits; j++) {
            double x = c[0] - bed.x[j], y = c[1] - bed.y[j], z = c[2] - bed.z[j], sum = r + bed.r[j];
            fits = x * x + y * y + z * z > sum * sum;
        }
        if (fits) add_sphere(&bed, c[0], c[1], c[2], r);
    }
    return bed;
}

/* ---- instruction sets ------------------------------------------------------------------------------------------- */

struct isas {
    int count, set[4];
};

/* The instruction sets that this build and this machine have, scalar first. Prints the others of this kind of machine
 * as skips, which tests/run.sh counts. */
static inline struct isas isas_there(void) {
#ifdef __aarch64__
    static const int of_machine[] = {FIBRAD_ISA_SCALAR, FIBRAD_ISA_NEON};
#else
    static const int of_machine[] = {FIBRAD_ISA_SCALAR, FIBRAD_ISA_SSE2, FIBRAD_ISA_AVX2, FIBRAD_ISA_AVX512};
#endif
    struct isas isas = {0};
    for (size_t k = 0; k < sizeof of_machine / sizeof *of_machine; k++) {
        const int set = of_machine[k];
        static unsigned char memory[FIBRAD_SCENE_BYTES(0)];
        fibrad_scene *scene = NULL;
        const int status = fibrad_scene_init(&scene, memory, sizeof memory, &(fibrad_scene_config){.isa = set},
                                             &(fibrad_spheres){0}, NULL);
        ck_assert(status == FIBRAD_OK || (status == FIBRAD_E_ISA && set != FIBRAD_ISA_SCALAR));
        if (status == FIBRAD_OK)
            isas.set[isas.count++] = set;
        else
            printf("SKIP %s\n", fibrad_isa_name(set));
    }
    return isas;
}

/* ---- scenes ----------------------------------------------------------------------------------------------------- */

static inline fibrad_spheres spheres_of(const struct bed *bed) {
    return (fibrad_spheres){.x = bed->x, .y = bed->y, .z = bed->z, .r = bed->r, .n = bed->n};
}

static inline fibrad_wall plane_at(int axis, int upper, double at) {
    return (fibrad_wall){.kind = FIBRAD_WALL_PLANE, .plane = {axis, upper, at}};
}

static inline fibrad_wall cylinder_at(double x, double y, double radius) {
    return (fibrad_wall){.kind = FIBRAD_WALL_CYLINDER, .cylinder = {x, y, radius, 2}};
}

/* A point whose coordinate on axis a was that on axis a - turn; walls and beds, too. Wall and point stay together. */
static inline void turned_point(const double at[3], int turn, double turned[3]) {
    for (int a = 0; a < 3; a++) turned[(a + turn) % 3] = at[a];
}

/* A cylinder must lie along z. */
static inline fibrad_wall turned_wall(fibrad_wall wall, int turn) {
    const double x = wall.cylinder.x, y = wall.cylinder.y;
    wall.plane.axis = (wall.plane.axis + turn) % 3;
    wall.cylinder.along = (2 + turn) % 3;
    if (turn == 2) wall.cylinder.x = y, wall.cylinder.y = x;
    return wall;
}

static inline void turn_bed(struct bed *bed, int turn) {
    for (uint32_t i = 0; i < bed->n; i++) {
        double at[3];
        turned_point((const double[]){bed->x[i], bed->y[i], bed->z[i]}, turn, at);
        bed->x[i] = at[0], bed->y[i] = at[1], bed->z[i] = at[2];
    }
}

/* A scene of a bed in its periodic box. config: walls and the like, or NULL. The period of config is not used. Returns
 * the status. free(*scene) frees the scene. */
static inline int scene_try(fibrad_scene **scene, const struct bed *bed, const fibrad_scene_config *config,
                            fibrad_fault *fault) {
    fibrad_scene_config whole = config != NULL ? *config : (fibrad_scene_config){0};
    memcpy(whole.period, bed->period, sizeof whole.period);
    const fibrad_spheres spheres = spheres_of(bed);
    size_t size = fibrad_scene_size(bed->n, 0);
    ck_assert_uint_gt(size, 0);
    if (whole.triangles != NULL) size += fibrad_triangles_size(whole.triangles->n, bed->n);
    fibrad_scene *made = NULL;
    void *block = block_of(size);
    const int status = fibrad_scene_init(&made, block, size, &whole, &spheres, fault);
    ck_assert_ptr_eq(made, status == FIBRAD_OK ? block : NULL); /* so that free(scene) frees the block */
    if (status == FIBRAD_OK)
        *scene = made;
    else
        free(block);
    return status;
}

static inline fibrad_scene *scene_with(const struct bed *bed, const fibrad_scene_config *config) {
    fibrad_scene *scene = NULL;
    assert_ok(scene_try(&scene, bed, config, NULL));
    return scene;
}

static inline fibrad_scene *scene_of(const struct bed *bed, int isa) {
    return scene_with(bed, &(fibrad_scene_config){.isa = isa});
}

/* ---- memory ----------------------------------------------------------------------------------------------------- */

static inline void *test_resize(void *context, void *block, size_t size) {
    (void)context;
    return realloc(block, size);
}

/* A source of memory that refuses once, and moves its block to another odd offset each time. */
struct source {
    uint32_t calls, refuse_at; /* 0: never */
    size_t size;
    unsigned char *whole;
};

static inline void *source_resize(void *context, void *block, size_t size) {
    struct source *source = context;
    if (++source->calls == source->refuse_at) return NULL;
    unsigned char *whole = malloc(size + 64), *to = whole + source->calls * 13 % 64;
    ck_assert_ptr_nonnull(whole);
    memset(whole, 0xff, size + 64);
    if (block != NULL) memcpy(to, block, source->size < size ? source->size : size);
    if (source->whole != NULL) memset(source->whole, 0xee, source->size); /* no bytes of the old block are needed */
    free(source->whole);
    source->whole = whole, source->size = size;
    return to;
}

static inline fibrad_memory memory_growing(void) { return (fibrad_memory){.resize = test_resize}; }

static inline fibrad_work work_growing(void) { return (fibrad_work){.memory = {.resize = test_resize}}; }

static inline fibrad_work work_fixed(void *block, size_t size) {
    return (fibrad_work){.memory = {.block = block, .size = size}};
}

/* Frees memory that has grown. A fixed block belongs to the caller. */
static inline void work_free(fibrad_work *work) {
    if (work->memory.resize != NULL) free(work->memory.block);
    *work = (fibrad_work){0};
}

/* For calls with fixed memory from malloc, which is empty at first. If the call asked for more, allocates as much as
 * the kernel asked for. True: repeat the call. */
static inline bool work_again(fibrad_work *work, int status) {
    if (status != FIBRAD_E_WORK) return false;
    ck_assert_uint_gt(work->memory.needed, work->memory.size);
    free(work->memory.block);
    work->memory.size = work->memory.needed;
    work->memory.block = malloc(work->memory.size);
    ck_assert_ptr_nonnull(work->memory.block);
    return true;
}

/* Frees fixed memory from malloc. */
static inline void work_free_fixed(fibrad_work *work) {
    free(work->memory.block);
    *work = (fibrad_work){0};
}

static inline void rows_free(fibrad_rows *rows) {
    if (rows->memory.resize != NULL) free(rows->memory.block);
    *rows = (fibrad_rows){0};
}

/* ---- rows ------------------------------------------------------------------------------------------------------- */

#define WALLS_MOST FIBRAD_WALLS_MAX

static inline fibrad_row row_of(uint32_t capacity) {
    return (fibrad_row){.col = calloc((size_t)capacity + 1, sizeof(uint32_t)),
                        .f = calloc((size_t)capacity + 1, sizeof(double)),
                        .wall = calloc(WALLS_MOST, sizeof(double)),
                        .capacity = capacity};
}

static inline void row_free(fibrad_row *row) {
    free(row->col);
    free(row->f);
    free(row->wall);
}

static inline double row_sum(const fibrad_row *row) {
    double sum = 0;
    for (uint32_t k = 0; k < row->length; k++) sum += row->f[k];
    return sum;
}

static inline double row_factor(const fibrad_row *row, uint32_t j) {
    for (uint32_t k = 0; k < row->length; k++)
        if (row->col[k] == j) return row->f[k];
    return 0;
}

/* Euclidean distance of two rows of a scene of n spheres. */
static inline double row_distance(const fibrad_row *a, const fibrad_row *b) {
    double square = 0;
    uint32_t p = 0, q = 0;
    while (p < a->length || q < b->length) {
        uint32_t i = p < a->length ? a->col[p] : UINT32_MAX, j = q < b->length ? b->col[q] : UINT32_MAX;
        double difference = (i <= j ? a->f[p++] : 0) - (j <= i ? b->f[q++] : 0);
        square += difference * difference;
    }
    return sqrt(square);
}

static inline bool same_bits(const fibrad_row *a, const fibrad_row *b) {
    return a->length == b->length && memcmp(a->col, b->col, a->length * sizeof *a->col) == 0 &&
           memcmp(a->f, b->f, a->length * sizeof *a->f) == 0 &&
           memcmp(&a->escaped, &b->escaped, sizeof a->escaped) == 0 &&
           memcmp(&a->beyond, &b->beyond, sizeof a->beyond) == 0 && memcmp(&a->error, &b->error, sizeof a->error) == 0;
}

/* The same for scenes with walls. */
static inline bool same_bits_with(const fibrad_row *a, const fibrad_row *b, uint32_t walls) {
    return same_bits(a, b) && memcmp(a->wall, b->wall, walls * sizeof *a->wall) == 0;
}

/* A set of lines. free(*set) frees it. */
static inline fibrad_line_set *lines_of(uint32_t lines) {
    const size_t size = fibrad_line_set_size(lines);
    fibrad_line_set *set = NULL;
    void *block = block_of(size);
    assert_ok(fibrad_line_set_init(&set, block, size, lines));
    ck_assert_ptr_eq(set, block);
    return set;
}

/* ---- matrices --------------------------------------------------------------------------------------------------- */

/* The beam rows of all spheres of a scene, in order. rule NULL: all defaults. */
static inline fibrad_rows rows_by_beams(const fibrad_scene *scene, const fibrad_beam_rule *rule) {
    fibrad_scene_facts facts;
    fibrad_scene_describe(scene, &facts);
    OWNED_WORK work = work_growing();
    fibrad_rows rows = {.memory = memory_growing()};
    for (uint32_t i = 0; i < facts.spheres; i++)
        assert_ok(fibrad_beam_row(scene, &work, i, rule, &(fibrad_row){.rows = &rows}));
    ck_assert_uint_eq(rows.count, facts.spheres);
    return rows;
}

/* A matrix that has been read, with the block it is in. */
struct matrix {
    fibrad_matrix *matrix;
    fibrad_factors factors;
};

/* The matrix of `count` collections of rows, averaged and closed. rule NULL: view factors. */
static inline struct matrix matrix_of(const fibrad_scene *scene, const fibrad_rows *rows, uint32_t count,
                                      const fibrad_matrix_rule *rule) {
    struct matrix m = {NULL, {0}};
    const size_t size = fibrad_matrix_size(scene, rows, count, rule);
    ck_assert_uint_gt(size, 0);
    void *block = block_of(size);
    uint32_t sphere = UINT32_MAX;
    const int status = fibrad_matrix_init(&m.matrix, block, size, scene, rows, count, rule, &sphere);
    ck_assert_msg(status == FIBRAD_OK, "%s, sphere %u", fibrad_status_text(status), sphere);
    ck_assert_ptr_eq(m.matrix, block);
    assert_ok(fibrad_matrix_close(m.matrix));
    assert_ok(fibrad_matrix_read(m.matrix, &m.factors));
    return m;
}

/* The view factors of a scene by beams. raw: the rows are not averaged. */
static inline struct matrix matrix_by_beams(const fibrad_scene *scene, const fibrad_beam_rule *beam, bool raw) {
    OWNED_ROWS rows = rows_by_beams(scene, beam);
    const struct matrix m = matrix_of(scene, &rows, 1, &(fibrad_matrix_rule){.raw = raw});
    return m;
}

/* The same along lines. chords: as in fibrad_beam_rule. */
static inline struct matrix matrix_by_lines(const fibrad_scene *scene, uint32_t lines, uint32_t chords, bool raw) {
    OWNED fibrad_line_set *set = lines_of(lines);
    return matrix_by_beams(scene, &(fibrad_beam_rule){.lines = set, .chords = chords}, raw);
}

static inline void matrix_free(struct matrix *m) {
    free(m->matrix);
    *m = (struct matrix){NULL, {0}};
}

/* Row i of a matrix. The caller neither frees nor writes it. */
static inline fibrad_row matrix_row(const fibrad_factors *m, uint32_t i) {
    const uint64_t begin = m->start[i];
    fibrad_row row = {.sphere = i, .length = (uint32_t)(m->start[i + 1] - begin)};
    row.capacity = row.length;
    row.col = (uint32_t *)(uintptr_t)(m->col + begin);
    row.f = (double *)(uintptr_t)(m->f + begin);
    row.wall = (double *)(uintptr_t)(m->wall + (size_t)i * m->walls);
    row.escaped = m->escaped[i], row.beyond = m->beyond[i], row.error = m->error[i];
    return row;
}

static inline double matrix_factor(const fibrad_factors *m, uint32_t i, uint32_t j) {
    const fibrad_row row = matrix_row(m, i);
    return row_factor(&row, j);
}

/* Sum of the factors of row i to spheres. matrix_total also has walls, escaped and beyond. */
static inline double matrix_sum(const fibrad_factors *m, uint32_t i) {
    const fibrad_row row = matrix_row(m, i);
    return row_sum(&row);
}

static inline double matrix_total(const fibrad_factors *m, uint32_t i) {
    double sum = matrix_sum(m, i) + m->escaped[i] + m->beyond[i];
    for (uint32_t b = 0; b < m->walls; b++) sum += m->wall[(size_t)i * m->walls + b];
    return sum;
}

static inline bool matrix_same_bits(const fibrad_factors *a, const fibrad_factors *b) {
    bool same = a->n == b->n && a->walls == b->walls;
    for (uint32_t i = 0; same && i < a->n; i++) {
        const fibrad_row p = matrix_row(a, i), q = matrix_row(b, i);
        same = a->start[i] == b->start[i] && same_bits_with(&p, &q, a->walls);
    }
    return same;
}

#endif
