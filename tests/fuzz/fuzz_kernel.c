/* fuzz_kernel.c - libFuzzer target: any arguments to the functions of the public headers, in any order.
 * SPDX-License-Identifier: MIT
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
#include "fibrad_furnace.h"
#include "fibrad_heat.h"
#include "fibrad_part.h"
#include "fibrad_surface.h"

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

/* A block of exactly `size` bytes `shift` bytes after a boundary (the pointer to free is *block). */
static void *memory_of(size_t size, size_t shift, void **block) {
    *block = malloc(size + shift > 0 ? size + shift : 1);
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

/* ---- memory ----------------------------------------------------------------------------------------------------- */

/* Memory that grows, into another block each time, until nothing is left. */
struct supply {
    void *block;
    size_t size;
    uint32_t left; /* how often it grows */
};

static void *supply_more(void *context, void *block, size_t size) {
    struct supply *supply = context;
    REQUIRE(block == supply->block && size > supply->size);
    if (supply->left == 0 || size > 1 << 26) return NULL;
    supply->left--;
    void *larger = malloc(size);
    REQUIRE(larger != NULL);
    memset(larger, 0xa5, size);
    if (block != NULL) memcpy(larger, block, supply->size);
    free(block);
    supply->block = larger, supply->size = size;
    return larger;
}

/* Fixed or growing; the caller frees supply->block. */
static fibrad_memory any_memory(struct supply *supply) {
    const uint8_t kind = byte();
    *supply = (struct supply){.left = kind < 128 ? UINT32_MAX : kind % 8};
    fibrad_memory memory = {.resize = supply_more, .context = supply};
    if (kind % 2 == 0) return memory;
    supply->size = 1 + (kind % 4 == 1 ? number() % 4096 : 64 * (size_t)number() % 40000);
    supply->block = malloc(supply->size);
    REQUIRE(supply->block != NULL);
    memset(supply->block, 0xa5, supply->size);
    memory = (fibrad_memory){.block = supply->block, .size = supply->size};
    return memory;
}

/* After a status that says so: what was asked for. True: there is more now. */
static bool give_more(fibrad_memory *memory, struct supply *supply) {
    REQUIRE(memory->resize == NULL && memory->needed > memory->size);
    if (memory->needed > 1 << 24) return false;
    memory->block = realloc(memory->block, memory->needed);
    REQUIRE(memory->block != NULL);
    memory->size = supply->size = memory->needed;
    supply->block = memory->block;
    return true;
}

/* ---- scenes and rows -------------------------------------------------------------------------------------------- */

enum { SPHERES = 24, BODIES = 7 };

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

/* From 0 to 1, seldom what is none. */
static double share(void) {
    uint8_t b = byte();
    return b < 250 ? .04 * (b % 26) : coordinate();
}

/* What a scene is made of. */
struct contents {
    uint32_t n;
    double x[SPHERES], y[SPHERES], z[SPHERES], r[SPHERES];
    uint64_t id[SPHERES];
    bool ids;
    fibrad_body body[BODIES + 1];
    bool occupied;
    fibrad_occupancy occupancy;
    uint64_t mark[8];
    fibrad_scene_config config;
};

/* Everything about one scene, and about what is made of it. */
struct session {
    struct contents contents;
    void *block, *memory; /* of the scene */
    size_t size;
    fibrad_scene *scene;
    fibrad_work work;
    struct supply supply;
    fibrad_rows rows;
    struct supply rows_supply;
    uint32_t version; /* how often the contents have changed */
    /* heat: what the header says of its state */
    fibrad_heat *heat;
    void *heat_block, *other_block, *other_memory; /* and of a second scene */
    fibrad_heat_config heat_config;
    uint32_t heat_version, tasks, parts;
    unsigned char *traced, swept[16];
    bool begun, solved, of_other;
    bool measured; /* temperatures and sigma are such that powers are compared with rounding */
};

/* A known region, an occupancy, or both. */
static void any_surroundings(struct contents *c) {
    const uint8_t which = byte();
    if (which % 2 == 0) {
        const uint32_t axis = which / 2 % 3;
        c->config.known_high[axis] = length();
        if (which > 128) c->config.known_low[axis] = length();
    }
    c->occupied = which % 4 != 0;
    c->occupancy = (fibrad_occupancy){.cells = {1 + byte() % 8, 1 + byte() % 8, 1 + byte() % 8}};
    for (int axis = 0; axis < 3; axis++) {
        c->occupancy.low[axis] = coordinate();
        c->occupancy.high[axis] = c->occupancy.low[axis] + (byte() < 250 ? 1 + byte() / 4. : coordinate());
        c->occupancy.periodic[axis] = byte() % 2;
    }
    for (int k = 0; k < 8; k++) c->mark[k] = (uint64_t)byte() << 56 | (uint64_t)byte() << 20 | byte();
    if (which == 3) c->occupancy.cells[byte() % 3] = number();
    if (which == 5) c->occupancy.periodic[byte() % 3] = byte();
}

static struct contents any_contents(bool walled) {
    struct contents c = {.n = number() % SPHERES};
    c.ids = byte() % 4 == 1, c.config.isa = byte() % 6;
    plain = tame = true;
    shortest = INFINITY;
    for (int axis = 0; axis < 3; axis++) {
        c.config.period[axis] = byte() < 160 ? 0 : fabs(length());
        if (c.config.period[axis] > 0) shortest = fmin(shortest, c.config.period[axis]);
    }
    const uint8_t part = byte();
    if (part == 1 || part > 240) any_surroundings(&c);
    for (uint32_t planes = walled ? byte() : 0, k = 0; k < 6; k++)
        if (planes >> k & 1)
            c.body[c.config.bodies++] =
                (fibrad_body){.kind = FIBRAD_BODY_PLANE, .plane = {(int)k / 2, k % 2, 8 * length()}};
    if (walled && byte() % 4 == 0)
        c.body[c.config.bodies++] =
            (fibrad_body){.kind = FIBRAD_BODY_CYLINDER, .cylinder = {length(), length(), 4 * fabs(length())}};
    if (walled && byte() == 1) c.body[byte() % BODIES].kind = byte();
    if (walled && byte() == 1) c.body[byte() % BODIES].plane.axis = (int)number();
    if (walled && byte() == 1) c.config.bodies = number() % (BODIES + 2);
    for (uint32_t i = 0; i < c.n; i++) {
        c.x[i] = length(), c.y[i] = length(), c.z[i] = length(), c.r[i] = radius();
        c.id[i] = c.ids ? number() : i;
    }
    return c;
}

static int build(fibrad_scene **scene, void *memory, size_t size, struct contents *c) {
    fibrad_spheres spheres = {.x = c->x, .y = c->y, .z = c->z, .r = c->r, .n = c->n, .id = c->ids ? c->id : NULL};
    fibrad_fault fault = {0, 0};
    *scene = NULL;
    c->config.body = c->body;
    c->config.occupancy = c->occupied ? &c->occupancy : NULL;
    const bool small = c->occupancy.cells[0] <= 8 && c->occupancy.cells[1] <= 8 && c->occupancy.cells[2] <= 8;
    c->occupancy.mark = small ? c->mark : NULL;
    const int status = fibrad_scene_init(scene, memory, size, &c->config, &spheres, &fault);
    REQUIRE((status == FIBRAD_OK) == (*scene != NULL) && fault.first <= c->n && fault.second <= c->n);
    return status;
}

/* A row that has been computed: points of each window, or rays, or 0 for exact areas. */
static void check_row(const fibrad_row *row, const fibrad_scene *scene, uint32_t i, uint32_t points) {
    fibrad_scene_facts facts;
    fibrad_scene_describe(scene, &facts);
    double sum = row->escaped + row->beyond;
    REQUIRE(row->sphere == i && (row->rows != NULL || row->length <= row->capacity));
    for (uint32_t k = 0; k < row->length; k++) {
        REQUIRE(row->col[k] < facts.spheres && (k == 0 || row->col[k] > row->col[k - 1]));
        REQUIRE(row->f[k] > 0 && row->f[k] <= 1 + 1e-9);
        sum += row->f[k];
    }
    for (uint32_t b = 0; b < facts.bodies; b++) {
        REQUIRE(row->body[b] >= 0 && (row->body[b] == 0 || fibrad_scene_body_area(scene, b) > 0));
        sum += row->body[b];
    }
    REQUIRE(row->escaped >= -1e-9 && row->beyond >= -1e-9 && row->error >= 0 && isfinite(row->error));
    REQUIRE(row->symmetric == 0 || row->symmetric == 1);
    if (plain || points > 0) REQUIRE(fabs(sum - 1) < 1e-9);
}

/* Where nothing moves, no row is off. */
static void check_unmoved(const fibrad_scene *scene, uint32_t n, const fibrad_row *row) {
    double error[SPHERES] = {0}, moved;
    REQUIRE(fibrad_drift_row(scene, scene, row->sphere, row->col, row->length, &moved) == FIBRAD_OK && moved == 0);
    REQUIRE(fibrad_drift_partners(scene, row->sphere, row, row, error) == FIBRAD_OK);
    for (uint32_t j = 0; j < n; j++) REQUIRE(error[j] == 0);
}

enum { BEAM, CAST, RAYS, SURFACE, EXCHANGE, METHODS };

/* How the next row is computed. */
struct method {
    int kind;
    fibrad_beam_rule beam;
    fibrad_cast_rule cast;
    fibrad_surface_rule surface;
    fibrad_exchange_rule exchange;
    double emissivity[SPHERES + 1], body_emissivity[BODIES + 1];
};

static void any_method(struct method *m) {
    static const uint32_t nodes[] = {0, 8, 13, 21, 34, 9};
    *m = (struct method){.kind = byte() % METHODS};
    const uint8_t which = byte();
    m->beam.directions = 8 + number() % 64;
    if (which < 100) m->beam.points = 64u << which % 3;
    if (which == 101) m->beam.points = number();
    if (which == 102) m->beam.directions = number() % 8;
    if (which > 200) m->beam.cutoff = coordinate();
    if (which == 103) m->beam.tolerance = .05 + fabs(coordinate());
    m->cast = (fibrad_cast_rule){.rays = 1 + number() % 300, .random = m->kind == RAYS, .seed = number()};
    if (which > 200) m->cast.cutoff = coordinate();
    m->surface = (fibrad_surface_rule){.nodes = nodes[which % 6], .flags = byte() & 31, .cutoff = coordinate()};
    m->exchange.emissivity = m->emissivity, m->exchange.body_emissivity = m->body_emissivity;
    m->exchange.directions = 8 + number() % 64, m->exchange.paths = 1 + number() % 64, m->exchange.seed = number();
    if (which == 104 || (which > 200 && m->kind == EXCHANGE)) m->exchange.cutoff = coordinate();
    if (which > 150 && which <= 200) m->beam.turn = which;
    if (which == 105) m->exchange.tolerance = .1 + fabs(coordinate());
    if (which == 106) m->exchange.paths = FIBRAD_PATHS_MAX + number() % 2;
    /* that of the sphere whose row it is is checked: all the same if it is none */
    const double bad = coordinate();
    for (uint32_t i = 0; i < SPHERES; i++) {
        const uint8_t k = byte() % 32;
        m->emissivity[i] = which == 109 ? bad : k < 26 ? .05 + .037 * k : 0;
    }
    /* where little is absorbed paths go on for long */
    for (uint32_t b = 0; b < BODIES; b++) m->body_emissivity[b] = .2 + .8 * share();
    if (which == 107) m->body_emissivity[byte() % BODIES] = coordinate() + .2;
    if (which == 108) m->exchange.body_emissivity = NULL;
}

/* Whether a row would take too long to try. */
static bool too_long(const struct method *m) {
    if (m->kind == SURFACE) return m->surface.cutoff > 8 * shortest && m->surface.cutoff < 101 * shortest;
    if (m->kind == EXCHANGE) return !plain || m->exchange.paths == FIBRAD_PATHS_MAX;
    return false;
}

static int row_by(const struct session *s, fibrad_work *work, const struct method *m, uint32_t i, fibrad_row *row) {
    switch (m->kind) {
    case BEAM:
        return fibrad_beam_row(s->scene, work, i, &m->beam, row);
    case SURFACE:
        return fibrad_surface_row(s->scene, work, i, &m->surface, row);
    case EXCHANGE:
        return fibrad_exchange_row(s->scene, work, i, &m->exchange, row, NULL);
    default:
        return fibrad_cast_row(s->scene, work, i, &m->cast, row, NULL);
    }
}

/* One row into arrays of just the size stated, or into the collection. */
static void try_row(struct session *s) {
    struct method m;
    any_method(&m);
    if (too_long(&m)) return;
    const uint32_t capacity = number() % 32, bodies = s->contents.config.bodies, i = number() % (s->contents.n + 1);
    const bool append = byte() % 4 == 0;
    void *blocks[5];
    fibrad_row row = {.col = memory_of(capacity * sizeof(uint32_t), 0, &blocks[0]),
                      .f = memory_of(capacity * sizeof(double), 0, &blocks[1]),
                      .body = memory_of(bodies * sizeof(double), 0, &blocks[2]),
                      .capacity = capacity};
    const fibrad_cast_means means = {memory_of(capacity * sizeof(double), 0, &blocks[3]),
                                     memory_of(capacity * sizeof(double), 0, &blocks[4])};
    const uint32_t count = s->rows.count;
    const uint64_t entries = s->rows.entries;
    if (append) row = (fibrad_row){.rows = &s->rows};
    int status;
    for (int k = 0; (status = m.kind == CAST && !append ? fibrad_cast_row(s->scene, &s->work, i, &m.cast, &row, &means)
                                                        : row_by(s, &s->work, &m, i, &row)) == FIBRAD_E_WORK;
         k++) {
        REQUIRE(k < 40 && s->rows.count == count);
        if (!give_more(&s->work.memory, &s->supply)) break;
    }
    if (status == FIBRAD_OK) {
        REQUIRE(i < s->contents.n);
        REQUIRE(s->rows.count == count + append && s->rows.entries == entries + (append ? row.length : 0));
        if (m.kind == SURFACE) {
            REQUIRE(append || row.length <= capacity);
            for (uint32_t k = 0; k < row.length; k++) REQUIRE(row.f[k] >= 0 && (k == 0 || row.col[k] > row.col[k - 1]));
        } else if (m.kind == EXCHANGE && m.emissivity[i] == 0) {
            REQUIRE(row.length == 0 && row.escaped == 0 && row.beyond == 0 && row.error == 0);
            for (uint32_t b = 0; b < bodies; b++) REQUIRE(row.body[b] == 0);
        } else {
            check_row(&row, s->scene, i, m.kind == BEAM ? m.beam.points : m.kind != EXCHANGE);
            check_unmoved(s->scene, s->contents.n, &row);
        }
        for (uint32_t k = 0; m.kind == CAST && !append && k < row.length; k++)
            REQUIRE(means.length[k] >= 0 && means.angle[k] >= 0 && means.angle[k] < 1.6);
    } else {
        REQUIRE(s->rows.count == count && s->rows.entries == entries);
        if (status == FIBRAD_E_CAPACITY && !append) REQUIRE(row.length > capacity && row.length <= s->contents.n);
        if (status == FIBRAD_E_CAPACITY && append) (void)give_more(&s->rows.memory, &s->rows_supply);
    }
    for (int k = 0; k < 5; k++) free(blocks[k]);
}

static void try_displacement(struct session *s) {
    struct method m;
    any_method(&m);
    m.kind = EXCHANGE;
    if (too_long(&m)) return;
    fibrad_displacement d;
    const uint32_t i = number() % (s->contents.n + 1);
    const int status = fibrad_exchange_displacement(s->scene, &s->work, i, &m.exchange, &d);
    if (status != FIBRAD_OK) return;
    /* few paths may absorb more than they carried: some go on for others that ended */
    REQUIRE(d.absorbed >= 0 && isfinite(d.absorbed));
    REQUIRE(m.emissivity[i] > 0 ? d.rays >= m.exchange.paths : d.rays == 0 && d.absorbed == 0);
    for (int axis = 0; axis < 3; axis++) REQUIRE(d.square[axis] >= 0 && d.error[axis] >= 0 && isfinite(d.square[axis]));
}

/* Powers from whatever rows there are: what some gain others lose. */
static void try_flow(struct session *s) {
    double weight[SPHERES], emission[SPHERES], power[SPHERES] = {0}, body_emission[BODIES + 1];
    double body_power[BODIES + 1] = {0}, sum, size;
    const uint32_t n = s->contents.n, bodies = s->contents.config.bodies;
    for (uint32_t i = 0; i < n; i++) weight[i] = share(), emission[i] = byte() < 250 ? share() : coordinate();
    for (uint32_t b = 0; b < bodies; b++) body_emission[b] = share();
    fibrad_flow flow = {.weight = weight,
                        .emission = emission,
                        .power = power,
                        .body_emission = body_emission,
                        .body_power = body_power,
                        .surroundings_emission = share()};
    const int status = fibrad_rows_flow(&s->rows, n, bodies, &flow);
    sum = flow.surroundings_power, size = fabs(sum);
    for (uint32_t i = 0; i < n; i++) sum += power[i], size += fabs(power[i]);
    for (uint32_t b = 0; b < bodies; b++) sum += body_power[b], size += fabs(body_power[b]);
    if (status != FIBRAD_OK) REQUIRE(size == 0);
    if (size < 1e3) REQUIRE(fabs(sum) < 1e-9);
}

/* The same spheres, some of them elsewhere, in a second scene. */
static fibrad_scene *other_scene(struct session *s, struct contents *c) {
    fibrad_scene *other = NULL;
    *c = s->contents;
    for (int k = byte() % 4; k > 0 && c->n > 0; k--) c->x[number() % c->n] += length() / 64;
    free(s->other_block);
    s->other_memory = memory_of(s->size, byte() % 64, &s->other_block);
    return build(&other, s->other_memory, s->size, c) == FIBRAD_OK ? other : NULL;
}

static void try_drift(struct session *s) {
    struct contents moved;
    if (s->of_other) return; /* the heat problem needs it */
    const fibrad_scene *now = other_scene(s, &moved);
    if (now == NULL || s->contents.n == 0) return;
    const uint32_t i = number() % s->contents.n;
    uint32_t col[SPHERES];
    double f[SPHERES], body[BODIES], later_f[SPHERES], error[SPHERES] = {0}, own;
    fibrad_row before = {.col = col, .f = f, .body = body, .capacity = SPHERES}, later = before;
    uint32_t later_col[SPHERES];
    later.col = later_col, later.f = later_f;
    const fibrad_beam_rule rule = {.directions = 8 + byte() % 8, .points = 64};
    if (fibrad_beam_row(s->scene, &s->work, i, &rule, &before) != FIBRAD_OK ||
        fibrad_beam_row(now, &s->work, i, &rule, &later) != FIBRAD_OK)
        return;
    REQUIRE(fibrad_drift_row(s->scene, now, i, col, before.length, &own) == FIBRAD_OK);
    REQUIRE(fibrad_drift_partners(now, i, &before, &later, error) == FIBRAD_OK);
    if (!plain) return;
    REQUIRE(own >= 0 && isfinite(own));
    for (uint32_t j = 0; j < s->contents.n; j++) REQUIRE(error[j] >= 0 && isfinite(error[j]));
}

/* Work memory exchanged for another, or the contents of the scene for others. */
static void exchange_work(struct session *s) {
    free(s->supply.block);
    void *inside = byte() % 2 ? s->work.inside : NULL; /* what it was is no matter */
    s->work = (fibrad_work){.memory = any_memory(&s->supply), .inside = inside};
}

/* In place. False: there is no scene any more. */
static bool rebuild(struct session *s) {
    const uint32_t i = s->contents.n > 0 ? number() % s->contents.n : 0;
    const bool other = byte() % 2;
    if (other && s->contents.n > 0) s->contents.x[i] += .25;
    s->version += other && s->contents.n > 0;
    if (build(&s->scene, s->memory, s->size, &s->contents) != FIBRAD_OK) return false;
    if (other) fibrad_rows_clear(&s->rows);
    return true;
}

/* ---- matrices --------------------------------------------------------------------------------------------------- */

/* Raw rows that add up to 1 at most: with exchange factors, those of the matrix do then, too. */
static bool modest;

/* A closed matrix. */
static void check_matrix(const fibrad_matrix *matrix, const fibrad_matrix_rule *rule) {
    fibrad_factors m;
    double largest;
    REQUIRE(fibrad_matrix_read(matrix, &m) == FIBRAD_OK);
    REQUIRE(fibrad_matrix_reciprocity(matrix, &largest) == FIBRAD_OK);
    if (plain && !rule->raw) REQUIRE(largest < 1e-12);
    REQUIRE(m.start[0] == 0);
    for (uint32_t i = 0; i < m.n; i++) {
        double sum = m.escaped[i] + m.beyond[i];
        REQUIRE(m.start[i + 1] >= m.start[i] && m.error[i] >= 0);
        for (uint64_t k = m.start[i]; k < m.start[i + 1]; k++) {
            REQUIRE(m.col[k] < m.n && (k == m.start[i] || m.col[k] > m.col[k - 1]) && m.f[k] >= 0);
            sum += m.f[k];
        }
        for (uint32_t b = 0; b < m.bodies; b++) {
            REQUIRE(m.body[(size_t)i * m.bodies + b] >= 0);
            sum += m.body[(size_t)i * m.bodies + b];
        }
        if (rule->emissivity != NULL && rule->emissivity[i] == 0)
            REQUIRE(m.start[i + 1] == m.start[i]);
        else if (plain && !rule->raw && (modest || rule->emissivity == NULL))
            REQUIRE(fabs(sum - 1) < 1e-9);
    }
}

/* A matrix of collections: `expected` is the status, or FIBRAD_E_ARGUMENT if anything may come. of_rows: emissivities
 * of exchange rows, or NULL. */
static void try_matrix(const fibrad_scene *scene, const fibrad_rows *rows, uint32_t count, uint32_t n, int expected,
                       const double *of_rows) {
    double emissivity[SPHERES];
    fibrad_matrix_rule rule = {.raw = byte() % 4 == 0, .drop = byte() % 2 ? 0 : share(), .tasks = byte() % 9};
    if (byte() == 1) rule.tasks = number();
    for (uint32_t i = 0; i < n; i++) emissivity[i] = of_rows == NULL ? share() : of_rows[i] > 0 ? .04 + share() : 0;
    if (of_rows != NULL || byte() % 4 == 0) rule.emissivity = emissivity;
    const size_t size = fibrad_matrix_size(scene, rows, count, &rule);
    if (size == 0) return;
    const uint8_t fault = byte();
    void *block, *memory = memory_of(size - (fault == 1), fault % 64, &block);
    fibrad_matrix *matrix = NULL;
    uint32_t sphere = UINT32_MAX;
    const int status = fibrad_matrix_init(&matrix, memory, size - (fault == 1), scene, rows, count, &rule, &sphere);
    REQUIRE((status == FIBRAD_OK) == (matrix != NULL) && (status != FIBRAD_E_STATE || sphere < n));
    if (fault == 1)
        REQUIRE(status == FIBRAD_E_SIZE);
    else if (expected != FIBRAD_E_ARGUMENT && !rule.raw)
        REQUIRE(status == expected);
    bool done[1024] = {0}, closed = false;
    for (int step = matrix != NULL ? byte() % 16 : 0; step > 0; step--) {
        const uint32_t task = number(), tasks = rule.tasks == 0 || rule.raw ? 1 : rule.tasks;
        fibrad_factors factors;
        double largest;
        if (byte() % 8 == 0) {
            REQUIRE(fibrad_matrix_close(matrix) == (closed ? FIBRAD_E_STATE : FIBRAD_OK));
            closed = true;
        } else {
            const int found = fibrad_matrix_average(matrix, task);
            if (task >= tasks)
                REQUIRE(found == FIBRAD_E_ARGUMENT);
            else
                REQUIRE(found == (closed || rule.raw || done[task] ? FIBRAD_E_STATE : FIBRAD_OK));
            if (task < tasks) done[task] = true;
        }
        REQUIRE(fibrad_matrix_read(matrix, &factors) == (closed ? FIBRAD_OK : FIBRAD_E_STATE));
        REQUIRE(fibrad_matrix_reciprocity(matrix, &largest) == (closed ? FIBRAD_OK : FIBRAD_E_STATE));
    }
    if (matrix != NULL) {
        if (!closed) REQUIRE(fibrad_matrix_close(matrix) == FIBRAD_OK);
        check_matrix(matrix, &rule);
    }
    free(block);
}

/* All rows of the scene by one method into two collections, in any order; seldom one too few or too many. */
static void try_bed(struct session *s) {
    struct method m;
    any_method(&m);
    if (too_long(&m) || s->contents.n == 0) return;
    struct supply supply[2];
    fibrad_rows rows[2] = {{.memory = any_memory(&supply[0])}, {.memory = any_memory(&supply[1])}};
    const uint32_t n = s->contents.n, missing = byte() % 16 == 0 ? number() % n : n, first = number() % n;
    const uint32_t twice = byte() % 16 == 0 ? number() % n : n;
    bool complete = true;
    for (uint32_t k = 0; k <= n && complete; k++) {
        const uint32_t i = k == n ? twice : (first + k) % n, which = byte() % 2;
        if (i == missing || i >= n) continue;
        fibrad_row row = {.rows = &rows[which]};
        int status;
        for (int tries = 0;; tries++) {
            status = row_by(s, &s->work, &m, i, &row);
            REQUIRE(tries < 80);
            if (status == FIBRAD_E_WORK && s->work.memory.resize == NULL && give_more(&s->work.memory, &s->supply))
                continue;
            if (status != FIBRAD_E_CAPACITY || !give_more(&rows[which].memory, &supply[which])) break;
        }
        complete = status == FIBRAD_OK;
    }
    if (complete) {
        REQUIRE(rows[0].count + rows[1].count == n - (missing < n) + (twice < n && twice != missing));
        const bool wrong = missing < n || twice < n;
        modest = m.kind != SURFACE;
        try_matrix(s->scene, rows, 2, n, wrong ? FIBRAD_E_STATE : FIBRAD_OK, m.kind == EXCHANGE ? m.emissivity : NULL);
    }
    free(supply[0].block), free(supply[1].block);
}

/* Rows by hand, sound or not. */
static void try_rows(void) {
    struct contents c = {.n = 1 + number() % 8};
    plain = tame = true;
    for (uint32_t i = 0; i < c.n; i++) c.x[i] = 1e4 * (i + 1), c.r[i] = radius();
    void *scene_block, *memory = memory_of(fibrad_scene_size(c.n, 0), 0, &scene_block);
    fibrad_scene *scene;
    struct supply supply;
    fibrad_rows rows = {.memory = any_memory(&supply)};
    if (build(&scene, memory, fibrad_scene_size(c.n, 0), &c) == FIBRAD_OK) {
        uint32_t col[SPHERES];
        double f[SPHERES], body[BODIES] = {0};
        bool all = true;
        modest = true;
        for (uint32_t i = 0; i < c.n; i++) {
            double sum = 0;
            fibrad_row row = {.sphere = byte() < 250 ? i : number(), .col = col, .f = f, .body = body};
            const bool sound = byte() < 240;
            for (uint32_t j = 0; j < c.n; j++) {
                if (byte() % 3 == 0) continue;
                col[row.length] = sound ? j : number() % (c.n + 1);
                f[row.length] = sound ? share() : coordinate();
                sum += f[row.length++];
            }
            row.escaped = share(), row.error = share();
            modest = modest && sum <= 1;
            const uint32_t bodies = byte() < 250 ? 0 : byte() % BODIES;
            const int status = fibrad_rows_add(&rows, &row, bodies);
            if (status == FIBRAD_E_CAPACITY) REQUIRE(rows.memory.needed > rows.memory.size);
            all = all && status == FIBRAD_OK && row.sphere == i && bodies == 0;
        }
        try_matrix(scene, &rows, 1, c.n, all ? FIBRAD_OK : FIBRAD_E_ARGUMENT, NULL);
    }
    free(scene_block), free(supply.block);
}

/* ---- heat ------------------------------------------------------------------------------------------------------- */

static void end_heat(struct session *s) {
    free(s->heat_block), free(s->traced);
    s->heat_block = NULL, s->traced = NULL, s->heat = NULL;
    s->begun = s->solved = s->of_other = false;
}

static void begin_heat(struct session *s) {
    end_heat(s);
    s->heat_config = (fibrad_heat_config){.directions = 8 + byte() % 4, .patches = 24, .parts = 1 + byte() % 8};
    if (byte() == 1) s->heat_config.points = number();
    if (byte() == 1) s->heat_config.parts = number();
    if (byte() == 1) s->heat_config.cutoff = coordinate();
    const size_t size = fibrad_heat_size(&s->heat_config, s->scene);
    if (size == 0 || size > 8 << 20 || !plain || s->heat_config.parts > 16) return;
    /* the rays of walls take a second */
    static int walled;
    if (s->contents.config.bodies > 0 && walled++ >= 40) return;
    const uint8_t fault = byte();
    void *memory = memory_of(size - (fault == 1), fault % 64, &s->heat_block);
    const int status = fibrad_heat_init(&s->heat, memory, size - (fault == 1), &s->heat_config, s->scene);
    REQUIRE(status == (fault == 1 ? FIBRAD_E_SIZE : FIBRAD_OK));
    if (status != FIBRAD_OK) {
        end_heat(s);
        return;
    }
    s->tasks = fibrad_heat_tasks(s->heat), s->parts = fibrad_heat_parts(s->heat);
    s->traced = calloc(s->tasks + 1, 1);
    REQUIRE(s->traced != NULL && s->parts == (s->heat_config.parts ? s->heat_config.parts : 8));
    s->heat_version = s->version;
}

/* Whether the scene of the heat problem is still the same. */
static bool kept(const struct session *s) { return s->of_other || s->heat_version == s->version; }

static void trace_task(struct session *s, uint32_t task) {
    const int status = fibrad_heat_trace(s->heat, &s->work, task);
    if (task >= s->tasks)
        REQUIRE(status == FIBRAD_E_ARGUMENT);
    else if (!kept(s) || s->traced[task])
        REQUIRE(status == FIBRAD_E_STATE);
    else
        REQUIRE(status == FIBRAD_OK || status == FIBRAD_E_WORK || status == FIBRAD_E_MEMORY);
    if (status == FIBRAD_E_WORK) (void)give_more(&s->work.memory, &s->supply);
    if (status == FIBRAD_OK) s->traced[task] = 1;
}

static void begin_solution(struct session *s) {
    double temperature[SPHERES], emissivity[SPHERES], body_temperature[BODIES], body_emissivity[BODIES];
    fibrad_heat_sources sources;
    bool all = true, valid = true;
    fibrad_heat_sources_init(&sources);
    sources.temperature = temperature, sources.emissivity = emissivity;
    sources.body_temperature = body_temperature, sources.body_emissivity = body_emissivity;
    sources.surroundings = byte() == 1 ? coordinate() : byte() / 16.;
    sources.sweeps_max = 1 + byte() % 20, sources.uniform = byte() % 4 == 0;
    if (byte() == 1) sources.sigma = coordinate();
    if (byte() == 1) sources.tolerance = coordinate();
    for (uint32_t i = 0; i < s->contents.n; i++) {
        temperature[i] = byte() < 250 ? byte() / 16. : coordinate(), emissivity[i] = share();
        valid = valid && temperature[i] >= 0 && temperature[i] <= 1e20 && emissivity[i] >= 0 && emissivity[i] <= 1;
    }
    for (uint32_t b = 0; b < s->contents.config.bodies; b++) {
        body_temperature[b] = byte() / 16., body_emissivity[b] = share();
        valid = valid && body_emissivity[b] >= 0 && body_emissivity[b] <= 1;
    }
    valid = valid && sources.surroundings >= 0 && sources.surroundings <= 1e20 && sources.sigma >= 1e-30 &&
            sources.sigma <= 1e30 && sources.tolerance >= 0 && sources.tolerance < 1;
    for (uint32_t k = 0; k < s->tasks; k++) all = all && s->traced[k];
    const int status = fibrad_heat_begin(s->heat, &sources);
    REQUIRE(status == (!valid ? FIBRAD_E_ARGUMENT : !kept(s) || !all ? FIBRAD_E_STATE : FIBRAD_OK));
    if (status != FIBRAD_OK) return;
    s->measured = sources.sigma < 100 && sources.surroundings < 100;
    for (uint32_t i = 0; i < s->contents.n; i++) s->measured = s->measured && temperature[i] < 100;
    s->begun = true, s->solved = false;
    memset(s->swept, 0, sizeof s->swept);
}

static void sweep_part(struct session *s, uint32_t part) {
    if (!kept(s)) return;
    const int status = fibrad_heat_sweep(s->heat, part);
    if (part >= s->parts)
        REQUIRE(status == FIBRAD_E_ARGUMENT);
    else
        REQUIRE(status == (!s->begun || s->swept[part] ? FIBRAD_E_STATE : FIBRAD_OK));
    if (status == FIBRAD_OK) s->swept[part] = 1;
}

static void step(struct session *s) {
    int solved = 77;
    bool all = s->begun && kept(s);
    for (uint32_t k = 0; k < s->parts; k++) all = all && s->swept[k];
    REQUIRE(fibrad_heat_step(s->heat, &solved) == (all ? FIBRAD_OK : FIBRAD_E_STATE));
    REQUIRE(all ? solved == 0 || solved == 1 : solved == 77);
    if (!all) return;
    memset(s->swept, 0, sizeof s->swept);
    s->solved = solved, s->begun = !solved;
}

/* Powers add up to zero, but for rounding of what is emitted. */
static void read_powers(struct session *s) {
    double power[SPHERES], body_power[BODIES];
    fibrad_heat_result result = {.power = power, .body_power = body_power};
    const int status = fibrad_heat_read(s->heat, &result);
    REQUIRE(status == (s->solved && kept(s) ? FIBRAD_OK : FIBRAD_E_STATE));
    if (status != FIBRAD_OK) return;
    double sum = result.surroundings_power, size = fabs(sum);
    for (uint32_t i = 0; i < s->contents.n; i++) sum += power[i], size += fabs(power[i]);
    for (uint32_t b = 0; b < s->contents.config.bodies; b++) sum += body_power[b], size += fabs(body_power[b]);
    if (s->measured) REQUIRE(fabs(sum) <= 1e-9 * size + 1e-6);
    REQUIRE(!(result.error_patches < 0) && !(result.error_beams < 0) && !(result.residual < 0));
}

/* To a second scene, or back to the first. */
static void move_heat(struct session *s) {
    struct contents moved;
    fibrad_scene *to = s->scene;
    const bool other = byte() % 2 && !s->of_other;
    if (other) to = other_scene(s, &moved);
    const int status = fibrad_heat_move(s->heat, to);
    REQUIRE(to != NULL ? status == FIBRAD_OK || status == FIBRAD_E_SIZE : status == FIBRAD_E_ARGUMENT);
    if (status != FIBRAD_OK) return;
    s->of_other = other, s->heat_version = s->version;
    s->begun = s->solved = false;
    s->tasks = fibrad_heat_tasks(s->heat);
    free(s->traced);
    s->traced = calloc(s->tasks + 1, 1);
    REQUIRE(s->traced != NULL);
}

static void try_heat(struct session *s) {
    const uint8_t what = byte() % 12;
    if (s->heat == NULL || what == 0) begin_heat(s);
    if (s->heat == NULL) return;
    switch (what) {
    case 1:
        trace_task(s, number());
        break;
    case 2:
        sweep_part(s, number());
        break;
    case 3:
        step(s);
        break;
    case 4:
        read_powers(s);
        break;
    case 5:
        move_heat(s);
        break;
    case 6:
        begin_solution(s);
        break;
    case 7: /* by the book, as far as it goes */
        for (int k = 0; k < 60 && s->begun && kept(s); k++) {
            for (uint32_t part = 0; part < s->parts; part++)
                if (!s->swept[part]) sweep_part(s, part);
            step(s);
        }
        read_powers(s);
        break;
    default:
        for (uint32_t k = 0; k < s->tasks; k++)
            if (!s->traced[k]) trace_task(s, k);
        begin_solution(s);
    }
}

/* ---- a scene, and what there is to be done with it -------------------------------------------------------------- */

static void try_scene(bool walled) {
    struct session s = {.contents = any_contents(walled)};
    s.size = fibrad_scene_size(s.contents.n, s.contents.ids);
    REQUIRE(s.size > 0 && (s.contents.ids || s.size <= FIBRAD_SCENE_BYTES(s.contents.n)));
    const uint8_t fault = byte();
    s.memory = memory_of(s.size - (fault == 1), fault % 64, &s.block);
    bool there = build(&s.scene, s.memory, s.size - (fault == 1), &s.contents) == FIBRAD_OK;
    REQUIRE(!there || fault != 1);
    s.work.memory = any_memory(&s.supply);
    s.rows.memory = any_memory(&s.rows_supply);
    for (int k = byte() % 24; k > 0 && there && tame; k--) {
        switch (byte() % 12) {
        case 0:
            there = rebuild(&s);
            break;
        case 1:
            exchange_work(&s);
            break;
        case 2:
            try_bed(&s);
            break;
        case 3:
            try_displacement(&s);
            break;
        case 4:
            try_drift(&s);
            break;
        case 5:
        case 6:
        case 7:
        case 8:
            try_heat(&s);
            break;
        case 9:
            modest = false; /* rows by all methods */
            try_matrix(s.scene, &s.rows, 1, s.contents.n, FIBRAD_E_ARGUMENT, NULL);
            try_flow(&s);
            break;
        default:
            try_row(&s);
        }
    }
    end_heat(&s);
    free(s.block), free(s.other_block), free(s.supply.block), free(s.rows_supply.block);
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
    void *block, *tally_block, *memory = memory_of(size - (fault == 1), fault % 64, &block);
    int status = fibrad_furnace_init(&furnace, memory, size - (fault == 1), &config);
    REQUIRE(status == (fault == 1 ? FIBRAD_E_SIZE : FIBRAD_OK));
    if (status != FIBRAD_OK) {
        free(block);
        return;
    }
    size_t tally_size = fibrad_furnace_tally_size(furnace);
    fibrad_furnace_tally *tally;
    memory = memory_of(tally_size, fault / 64, &tally_block);
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
    uint32_t n_obstacles = number() % 12, shift = 8 * (byte() % 8);
    double *x = copies(n_obstacles, coordinate), *y = copies(n_obstacles, coordinate);
    double *z = copies(n_obstacles, coordinate), *r = copies(n_obstacles, coordinate);
    fibrad_spheres obstacles = {.x = x, .y = y, .z = z, .r = r, .n = n_obstacles};
    void *block, *scratch = memory_of(FIBRAD_SURFACE_SCRATCH(n_obstacles) * sizeof(double), shift, &block);
    fibrad_surface_rule rule = {.nodes = 8, .flags = byte() & 31, .isa = byte() % 6};
    if (rule.isa <= FIBRAD_ISA_NEON && (fibrad_isa)rule.isa > fibrad_isa_best()) rule.isa = FIBRAD_ISA_BEST;
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
