/* fuzz_kernel.c - libFuzzer target: any arguments to the functions of the kernel's headers, in any order.
 * SPDX-License-Identifier: MIT
 *
 * Every block has exactly the size stated to the function, so that the address sanitizer sees a byte too far.
 * Everything returned with FIBRAD_OK must be what the header promises. */
#include "fibrad_furnace.h"
#include "fibrad_heat.h"
#include "fibrad_surface.h"
#include "contents.h"
#include "../grey_rules.h"

/* ---- scenes and rows -------------------------------------------------------------------------------------------- */

/* A scene and all objects made of it. */
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
    /* the heat problem, and its state by the header */
    fibrad_heat *heat;
    void *heat_block, *other_block, *other_memory; /* and of a second scene */
    fibrad_heat_config heat_config;
    uint32_t heat_version, tasks, parts;
    unsigned char *traced, swept[16];
    bool begun, solved, of_other;
    bool measured;                 /* temperatures and sigma allow powers to be compared with rounding */
    bool unknown;                  /* some temperatures are unknown */
    bool wide;                     /* the input asks for everything: rows of walls, triangles, unknown temperatures */
    double side[4][2 * TRIANGLES]; /* temperatures, films, gas and powers of sides, which stay until the solution */
};

enum { BEAM, CAST, RAYS, SURFACE, EXCHANGE, METHODS };

/* The method of the next row. */
struct method {
    int kind;
    fibrad_beam_rule beam;
    fibrad_cast_rule cast;
    fibrad_surface_rule surface;
    fibrad_exchange_rule exchange;
    double emissivity[SPHERES + 1], wall_emissivity[WALLS + 1], known[WALLS + 1];
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
    m->exchange.emissivity = m->emissivity, m->exchange.wall_emissivity = m->wall_emissivity;
    m->exchange.directions = 8 + number() % 64, m->exchange.paths = 1 + number() % 64, m->exchange.seed = number();
    if (which == 104 || (which > 200 && m->kind == EXCHANGE)) m->exchange.cutoff = coordinate();
    if (which > 150 && which <= 200) m->beam.turn = which;
    if (which == 105) m->exchange.tolerance = .1 + fabs(coordinate());
    if (which == 106) m->exchange.paths = FIBRAD_PATHS_MAX + number() % 2;
    /* the emissivity of the row's own sphere is checked, so all are the same if it is not valid */
    const double bad = coordinate();
    for (uint32_t i = 0; i < SPHERES; i++) {
        const uint8_t k = byte() % 32;
        m->emissivity[i] = which == 109 ? bad : k < 26 ? .05 + .037 * k : 0;
    }
    /* if little is absorbed, paths go on for long */
    for (uint32_t b = 0; b < WALLS; b++) m->wall_emissivity[b] = b < PLANES ? .2 + .8 * share() : .1 * b;
    if (which == 107) m->wall_emissivity[byte() % PLANES] = coordinate() + .2;
    if (which == 108) m->exchange.wall_emissivity = NULL;
    if (which % 4 != 3) return;
    m->exchange.known = m->known;
    m->exchange.known_paths = which == 111 ? coordinate() : number() % 4096;
    for (uint32_t b = 0; b <= WALLS; b++) m->known[b] = byte() % 8 == 0 ? coordinate() : 64 * share();
}

/* Whether a row would take too long to try. */
static bool too_long(const struct method *m) {
    if (m->kind == SURFACE) return m->surface.cutoff > 3 * shortest && m->surface.cutoff < 101 * shortest;
    if (m->kind == EXCHANGE) return !plain || m->exchange.paths == FIBRAD_PATHS_MAX;
    return false;
}

static int row_by(const struct session *s, fibrad_work *work, const struct method *m, uint32_t i, fibrad_row *row) {
    switch (m->kind) {
    case BEAM:
        return CALL(fibrad_beam_row(s->scene, work, i, &m->beam, row));
    case SURFACE:
        return CALL(fibrad_surface_row(s->scene, work, i, &m->surface, row));
    case EXCHANGE:
        return CALL(fibrad_exchange_row(s->scene, work, i, &m->exchange, row, NULL));
    default:
        return CALL(fibrad_cast_row(s->scene, work, i, &m->cast, row, NULL));
    }
}

/* One row into arrays of just the stated size, or into the collection. */
static void try_row(struct session *s) {
    struct method m;
    any_method(&m);
    if (too_long(&m)) return;
    const uint32_t capacity = number() % 32, walls = s->contents.config.walls, i = number() % (s->contents.n + 1);
    const bool append = byte() % 4 == 0;
    void *blocks[5];
    for (uint32_t b = 0; b < walls; b++)
        if (fibrad_scene_wall_area(s->scene, b) == 0) m.known[b] = NAN; /* a wall without triangles absorbs nothing */
    fibrad_row row = {.col = memory_of(capacity * sizeof(uint32_t), 0, &blocks[0]),
                      .f = memory_of(capacity * sizeof(double), 0, &blocks[1]),
                      .wall = memory_of(walls * sizeof(double), 0, &blocks[2]),
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
            for (uint32_t b = 0; b < walls; b++) REQUIRE(row.wall[b] == 0);
        } else {
            check_row(&row, s->scene, i, m.kind == BEAM ? m.beam.points : m.kind != EXCHANGE);
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
    const int status = CALL(displacement_of(s->scene, &s->work, i, &m.exchange, &d));
    if (status != FIBRAD_OK) return;
    /* few paths may absorb more than they carried, since some go on for others that have ended */
    REQUIRE(d.absorbed >= 0 && isfinite(d.absorbed));
    REQUIRE(m.emissivity[i] > 0 ? d.rays >= m.exchange.paths : d.rays == 0 && d.absorbed == 0);
    for (int axis = 0; axis < 3; axis++) REQUIRE(d.square[axis] >= 0 && d.error[axis] >= 0 && isfinite(d.square[axis]));
}

/* Powers from any rows: some gain what others lose. */
static void try_flow(struct session *s) {
    double weight[SPHERES], emission[SPHERES], power[SPHERES] = {0}, wall_emission[WALLS + 1];
    double wall_power[WALLS + 1] = {0}, sum, size;
    const uint32_t n = s->contents.n, walls = s->contents.config.walls;
    for (uint32_t i = 0; i < n; i++) weight[i] = share(), emission[i] = byte() < 250 ? share() : coordinate();
    for (uint32_t b = 0; b < walls; b++) wall_emission[b] = share();
    fibrad_flow flow = {.weight = weight, .emission = emission, .power = power, .wall_emission = wall_emission};
    flow.wall_power = wall_power, flow.surroundings_emission = share();
    const int status = CALL(fibrad_rows_flow(&s->rows, n, walls, &flow));
    sum = flow.surroundings_power, size = fabs(sum);
    for (uint32_t i = 0; i < n; i++) sum += power[i], size += fabs(power[i]);
    for (uint32_t b = 0; b < walls; b++) sum += wall_power[b], size += fabs(wall_power[b]);
    if (status != FIBRAD_OK) REQUIRE(size == 0);
    if (size < 1e3) REQUIRE(fabs(sum) < 1e-9);
}

/* The same spheres in a second scene, some of them at other positions. */
static fibrad_scene *other_scene(struct session *s, struct contents *c) {
    fibrad_scene *other = NULL;
    *c = s->contents;
    for (int k = byte() % 4; k > 0 && c->n > 0; k--) c->x[number() % c->n] += length() / 64;
    free(s->other_block);
    s->other_memory = memory_of(s->size, byte() % 64, &s->other_block);
    return build(&other, s->other_memory, s->size, c) == FIBRAD_OK ? other : NULL;
}

/* Replaces the work memory, or the contents of the scene. */
static void exchange_work(struct session *s) {
    supply_end(&s->supply);
    void *inside = byte() % 2 ? s->work.inside : NULL; /* the former value does not matter */
    s->work = (fibrad_work){.memory = any_memory(&s->supply), .inside = inside};
}

/* Rebuilds the scene in place. False: there is no scene any more. */
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

/* Raw rows that add up to 1 at most. If so, rows of exchange factors in a matrix do so, too. */
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
        for (uint32_t b = 0; b < m.walls; b++) {
            REQUIRE(m.wall[(size_t)i * m.walls + b] >= 0);
            sum += m.wall[(size_t)i * m.walls + b];
        }
        if (rule->emissivity != NULL && rule->emissivity[i] == 0)
            REQUIRE(m.start[i + 1] == m.start[i]);
        else if (plain && !rule->raw && (modest || rule->emissivity == NULL))
            REQUIRE(fabs(sum - 1) < 1e-9);
    }
}

/* A matrix of collections. expected: the status; FIBRAD_E_ARGUMENT: any status is allowed. of_rows: emissivities of
 * exchange rows, or NULL. */
static void try_matrix(const fibrad_scene *scene, const fibrad_rows *rows, uint32_t count, uint32_t n, int expected,
                       const double *of_rows) {
    double emissivity[SPHERES];
    fibrad_matrix_rule rule = {.raw = byte() % 4 == 0, .drop = byte() % 2 ? 0 : share(), .tasks = byte() % 9};
    if (byte() == 1) rule.tasks = number();
    for (uint32_t i = 0; i < n; i++) emissivity[i] = of_rows == NULL ? share() : of_rows[i] > 0 ? .04 + share() : 0;
    if (of_rows != NULL || byte() % 4 == 0) rule.kind = FIBRAD_ROWS_EXCHANGE, rule.emissivity = emissivity;
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
    bool closed = false;
    for (int step = matrix != NULL ? byte() % 16 : 0; step > 0; step--) {
        fibrad_factors factors;
        double largest;
        if (byte() % 8 == 0) {
            REQUIRE(fibrad_matrix_close(matrix) == (closed ? FIBRAD_E_STATE : FIBRAD_OK));
            closed = true;
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

/* All rows of the scene by one method into two collections, in any order. Seldom a row is missing or repeated. */
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
    supply_end(&supply[0]), supply_end(&supply[1]);
}

/* Rows made by hand, valid or not. */
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
        double f[SPHERES], wall[WALLS] = {0};
        bool all = true;
        modest = true;
        for (uint32_t i = 0; i < c.n; i++) {
            double sum = 0;
            fibrad_row row = {.sphere = byte() < 250 ? i : number(), .col = col, .f = f, .wall = wall};
            const bool sound = byte() < 240;
            for (uint32_t j = 0; j < c.n; j++) {
                if (byte() % 3 == 0) continue;
                col[row.length] = sound ? j : number() % (c.n + 1);
                f[row.length] = sound ? share() : coordinate();
                sum += f[row.length++];
            }
            row.escaped = share(), row.error = share();
            modest = modest && sum <= 1;
            const uint32_t walls = byte() < 250 ? 0 : byte() % PLANES;
            const int status = CALL(fibrad_rows_add(&rows, &row, walls));
            if (status == FIBRAD_E_CAPACITY) REQUIRE(rows.memory.needed > rows.memory.size);
            all = all && status == FIBRAD_OK && row.sphere == i && walls == 0;
        }
        try_matrix(scene, &rows, 1, c.n, all ? FIBRAD_OK : FIBRAD_E_ARGUMENT, NULL);
    }
    free(scene_block), supply_end(&supply);
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
    if (s->wide) s->heat_config.wall_rays = 1 + number() % 300;
    const size_t size = fibrad_heat_size(&s->heat_config, s->scene);
    if (size == 0 || size > 8 << 20 || !plain || s->heat_config.parts > 16) return;
    if (has_many_images(&s->contents)) return;
    /* the rays of walls take a second */
    static int walled;
    if (s->contents.config.walls > 0 && !s->wide && walled++ >= 40) return;
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
    const int status = CALL(fibrad_heat_trace(s->heat, &s->work, task));
    if (task >= s->tasks)
        REQUIRE(status == FIBRAD_E_ARGUMENT);
    else if (!kept(s) || s->traced[task])
        REQUIRE(status == FIBRAD_E_STATE);
    else
        REQUIRE(status == FIBRAD_OK || status == FIBRAD_E_WORK || status == FIBRAD_E_MEMORY ||
                s->contents.triangles.n > 0);
    if (status == FIBRAD_E_WORK) (void)give_more(&s->work.memory, &s->supply);
    if (status == FIBRAD_OK) s->traced[task] = 1;
}

/* The powers and other values of walls whose temperatures are unknown. */
struct unknowns {
    double power[SPHERES], storage[SPHERES], reference[SPHERES], wall_power[WALLS];
    unsigned char insulated[WALLS];
};

static void any_unknowns(struct session *s, struct unknowns *u, double *temperature, double *wall_temperature,
                         fibrad_heat_sources *sources) {
    for (uint32_t i = 0; i < s->contents.n; i++) {
        const uint8_t kind = byte();
        if (kind % 2) temperature[i] = NAN;
        u->power[i] = isnan(temperature[i]) ? kind < 240 ? share() : coordinate() : 0;
        u->storage[i] = kind % 3 == 0 ? share() : 0, u->reference[i] = u->storage[i] > 0 ? share() : NAN;
    }
    for (uint32_t b = 0; b < s->contents.config.walls; b++) {
        const uint8_t kind = byte();
        if (kind % 3 == 0) wall_temperature[b] = NAN;
        u->wall_power[b] = isnan(wall_temperature[b]) ? share() : 0, u->insulated[b] = kind % 5 == 0;
    }
    for (uint32_t k = 0; k < 2 * s->contents.triangles.n; k++) s->side[0][k] = byte() % 4 == 0 ? share() : NAN;
    sources->power = u->power, sources->wall_power = u->wall_power, sources->insulated = u->insulated;
    if (byte() % 2) sources->storage = u->storage, sources->reference = u->reference;
    if (s->contents.triangles.n == 0) return;
    if (byte() % 2) sources->side_temperature = s->side[0];
    const uint8_t which = byte();
    for (uint32_t k = 0; k < 2 * s->contents.triangles.n && which % 4 == 1; k++) {
        const uint8_t kind = byte();
        s->side[1][k] = kind % 3 == 0 ? share() : 0, s->side[2][k] = kind < 250 ? kind / 64. : coordinate();
        s->side[3][k] = kind % 4 == 0 ? share() - .5 : NAN;
        if (s->side[1][k] > 0 || kind % 4 == 0) s->side[0][k] = kind < 250 ? NAN : s->side[0][k];
    }
    if (which % 4 == 1)
        sources->side_film = s->side[1], sources->side_gas = s->side[2], sources->side_power = s->side[3];
}

static void begin_solution(struct session *s) {
    double temperature[SPHERES], emissivity[SPHERES], wall_temperature[WALLS], wall_emissivity[WALLS];
    fibrad_heat_sources sources;
    bool all = true, valid = true;
    fibrad_heat_sources_init(&sources);
    sources.temperature = temperature, sources.emissivity = emissivity;
    sources.wall_temperature = wall_temperature, sources.wall_emissivity = wall_emissivity;
    sources.surroundings = byte() == 1 ? coordinate() : byte() / 16.;
    sources.sweeps_max = 1 + byte() % 20;
    if (byte() == 1) sources.sigma = coordinate();
    if (byte() == 1) sources.tolerance = coordinate();
    for (uint32_t i = 0; i < s->contents.n; i++) {
        temperature[i] = byte() < 250 ? byte() / 16. : coordinate(), emissivity[i] = share();
        valid = valid && temperature[i] >= 0 && temperature[i] <= 1e20 && emissivity[i] >= 0 && emissivity[i] <= 1;
    }
    for (uint32_t b = 0; b < s->contents.config.walls; b++) {
        wall_temperature[b] = byte() / 16., wall_emissivity[b] = share();
        valid = valid && wall_emissivity[b] >= 0 && wall_emissivity[b] <= 1;
    }
    valid = valid && sources.surroundings >= 0 && sources.surroundings <= 1e20 && sources.sigma >= 1e-30 &&
            sources.sigma <= 1e30 && sources.tolerance >= 0 && sources.tolerance < 1;
    for (uint32_t k = 0; k < s->tasks; k++) all = all && s->traced[k];
    struct unknowns unknowns;
    s->unknown = s->wide && byte() % 2;
    if (s->unknown) any_unknowns(s, &unknowns, temperature, wall_temperature, &sources);
    const int status = CALL(fibrad_heat_begin(s->heat, &sources));
    if (!s->unknown || status == FIBRAD_OK)
        REQUIRE(status == (!valid ? FIBRAD_E_ARGUMENT : !kept(s) || !all ? FIBRAD_E_STATE : FIBRAD_OK));
    if (status != FIBRAD_OK) return;
    s->measured = sources.sigma < 100 && sources.surroundings < 100;
    for (uint32_t i = 0; i < s->contents.n; i++) s->measured = s->measured && temperature[i] < 100;
    s->begun = true, s->solved = false;
    memset(s->swept, 0, sizeof s->swept);
}

static void sweep_part(struct session *s, uint32_t part) {
    if (!kept(s)) return;
    const int status = CALL(fibrad_heat_sweep(s->heat, part));
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
    const int status = CALL(fibrad_heat_step(s->heat, &solved));
    if (all && (status == FIBRAD_E_UNSETTLED || (s->unknown && status == FIBRAD_E_UNSOLVABLE))) {
        s->begun = s->solved = false;
        return;
    }
    REQUIRE(status == (all ? FIBRAD_OK : FIBRAD_E_STATE));
    REQUIRE(all ? solved == 0 || solved == 1 : solved == 77);
    if (!all) return;
    memset(s->swept, 0, sizeof s->swept);
    s->solved = solved, s->begun = !solved;
}

/* Asserts that powers add up to zero, but for rounding of the emissions. */
static void read_powers(struct session *s) {
    double power[SPHERES], wall_power[WALLS];
    double temperature[SPHERES], error[SPHERES], flux[2 * TRIANGLES], side[2 * TRIANGLES];
    fibrad_heat_result result = {.power = power, .wall_power = wall_power};
    if (s->wide) result.temperature = temperature, result.power_error = error;
    const int status = CALL(fibrad_heat_read(s->heat, &result));
    const bool below_zero = s->unknown && s->solved && status == FIBRAD_E_UNSOLVABLE;
    REQUIRE(below_zero || status == (s->solved && kept(s) ? FIBRAD_OK : FIBRAD_E_STATE));
    if (status != FIBRAD_OK) return;
    for (uint32_t i = 0; i < s->contents.n && s->wide; i++) REQUIRE(error[i] >= 0 && !(temperature[i] < 0));
    if (s->wide) REQUIRE(CALL(fibrad_heat_read_sides(s->heat, flux, side)) == FIBRAD_OK);
    double sum = result.surroundings_power, size = fabs(sum);
    for (uint32_t i = 0; i < s->contents.n; i++) sum += power[i], size += fabs(power[i]);
    for (uint32_t b = 0; b < s->contents.config.walls; b++) sum += wall_power[b], size += fabs(wall_power[b]);
    if (s->measured) REQUIRE(fabs(sum) <= 1e-9 * size + 1e-6);
    REQUIRE(!(result.error_patches < 0) && !(result.error_beams < 0) && !(result.residual < 0));
}

/* Moves to a second scene, or back to the first one. */
static void move_heat(struct session *s) {
    struct contents moved;
    fibrad_scene *to = s->scene;
    const bool other = byte() % 2 && !s->of_other;
    if (other) to = other_scene(s, &moved);
    if (other && has_many_images(&moved)) return;
    const int status = CALL(fibrad_heat_move(s->heat, to));
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
    case 7: /* the calls in the right order, as far as possible */
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

/* ---- what only wide inputs try ---------------------------------------------------------------------------------- */

/* One batch of the row of a wall or an opening. Where all is black, nothing is reflected. */
static int any_batch(struct session *s, const fibrad_wall_rule *rule, uint32_t wall, uint32_t part,
                     fibrad_wall_row *row) {
    const uint32_t n = s->contents.n;
    void *block;
    uint64_t *reflected = memory_of(n * sizeof *reflected, 0, &block);
    int status;
    memset(reflected, 0, n * sizeof *reflected);
    for (int tries = 0;; tries++) {
        status = CALL(fibrad_exchange_wall(s->scene, &s->work, wall, rule, part, row, reflected));
        REQUIRE(tries < 80);
        if (status != FIBRAD_E_WORK || s->work.memory.resize != NULL || !give_more(&s->work.memory, &s->supply)) break;
    }
    for (uint32_t i = 0; i < n && rule->emissivity == NULL && rule->wall_emissivity == NULL; i++)
        REQUIRE(reflected[i] == 0);
    free(block);
    return status;
}

/* The row of a wall or an opening: all that it emits ends somewhere. */
static bool any_wall_row(struct session *s, const fibrad_wall_rule *rule, uint32_t wall, fibrad_wall_row *mean) {
    fibrad_wall_row part[FIBRAD_WALL_PARTS];
    const uint32_t walls = s->contents.config.walls;
    for (uint32_t k = 0; k < FIBRAD_WALL_PARTS; k++) {
        const int status = any_batch(s, rule, wall, k, &part[k]);
        if (isnan(fibrad_scene_wall_area(s->scene, wall))) REQUIRE(status == FIBRAD_E_ARGUMENT);
        if (status != FIBRAD_OK) return false;
    }
    REQUIRE(CALL(fibrad_exchange_wall_mean(part, mean)) == FIBRAD_OK);
    double sum = mean->spheres + mean->escaped;
    for (uint32_t b = 0; b < walls; b++) {
        REQUIRE(mean->wall[b] >= 0);
        sum += mean->wall[b];
    }
    REQUIRE(mean->spheres >= 0 && mean->escaped >= -1e-9 && mean->error >= 0);
    const double *emissivity = rule->wall_emissivity;
    if (plain) REQUIRE(fabs(sum - (emissivity == NULL || wall >= walls || emissivity[wall] > 0)) < 1e-9);
    return true;
}

/* The matrix of all spheres and walls. Rows of spheres are exchange or beam rows, those of walls come from paths. */
static void try_walls(struct session *s) {
    struct method m;
    any_method(&m);
    const uint32_t n = s->contents.n, walls = s->contents.config.walls;
    if (n == 0 || walls == 0 || !plain) return;
    const bool grey = m.kind == EXCHANGE;
    m.kind = grey ? EXCHANGE : BEAM;
    m.exchange.cutoff = m.beam.cutoff = 0, m.exchange.paths = 1 + m.exchange.paths % 64;
    if (too_long(&m)) return;
    fibrad_wall_rule rule = wall_rule(&m.exchange);
    if (!grey) rule.emissivity = rule.wall_emissivity = NULL;
    fibrad_wall_row rows_of_walls[WALLS] = {{{0}, 0, 0, 0, 0, 0}}, of_opening;
    for (uint32_t b = 0; b < walls; b++)
        if (fibrad_scene_wall_area(s->scene, b) < INFINITY && !any_wall_row(s, &rule, b, &rows_of_walls[b])) return;
    (void)any_wall_row(s, &rule, FIBRAD_OPENING(walls, m.exchange.seed % 4, rule.paths % 2), &of_opening);
    struct supply supply = {.left = UINT32_MAX};
    fibrad_rows rows = {.memory = {.resize = supply_more, .context = &supply}};
    bool complete = true;
    for (uint32_t i = 0; i < n && complete; i++) {
        fibrad_row row = {.rows = &rows};
        complete = row_by(s, &s->work, &m, i, &row) == FIBRAD_OK;
    }
    const fibrad_matrix_rule closed = {.kind = grey ? FIBRAD_ROWS_EXCHANGE : FIBRAD_ROWS_AREAS,
                                       .emissivity = grey ? m.emissivity : NULL,
                                       .wall_row = rows_of_walls,
                                       .wall_emissivity = grey ? m.wall_emissivity : NULL};
    const size_t size = complete ? CALL(fibrad_matrix_size(s->scene, &rows, 1, &closed)) : 0;
    void *block = NULL, *memory = size > 0 ? memory_of(size, byte() % 64, &block) : NULL;
    fibrad_matrix *matrix;
    uint32_t sphere;
    if (size > 0 && CALL(fibrad_matrix_init(&matrix, memory, size, s->scene, &rows, 1, &closed, &sphere)) == FIBRAD_OK)
        if (CALL(fibrad_matrix_close(matrix)) == FIBRAD_OK) {
            modest = !grey;
            check_matrix(matrix, &closed);
        }
    free(block), supply_end(&supply);
}

/* Rays against triangles, from any point, and the views of their sides. */
static void try_triangles(struct session *s) {
    const uint32_t n = s->contents.triangles.n;
    double origin[3] = {coordinate(), coordinate(), coordinate()}, w[3] = {0, 0, 1};
    fibrad_triangle_hit hit;
    if (byte() < 250) (void)fibrad_direction(number() % 64, 64, w);
    const double far = byte() < 128 ? 10 : fabs(coordinate());
    if (tame || far <= 1e3) {
        const int status = CALL(fibrad_triangle_ray(s->scene, origin, w, far, &hit));
        if (status == FIBRAD_OK) REQUIRE(hit.triangle == UINT32_MAX || (hit.triangle < n && hit.distance <= far));
    }
    if (!plain) return;
    fibrad_side_view view[2];
    uint32_t triangle = UINT32_MAX;
    const uint32_t place = number() % (n + 1);
    const int status = CALL(fibrad_triangle_views(s->scene, place, 1 + number() % 50, &triangle, view));
    if (place >= n) REQUIRE(status == FIBRAD_E_ARGUMENT);
    if (status != FIBRAD_OK) return;
    REQUIRE(triangle < n);
    for (int side = 0; side < 2; side++) {
        const double sum = view[side].spheres + view[side].walls + view[side].escaped;
        REQUIRE(isnan(sum) || (view[side].spheres >= 0 && view[side].walls >= 0 && fabs(sum - 1) < 1e-12));
    }
}

/* Reads all rows of the collection, one after the other. */
static void read_rows(struct session *s) {
    size_t position = 0;
    uint32_t count = 0;
    fibrad_row row;
    for (uint64_t entries = 0; fibrad_rows_read(&s->rows, &position, &row); count++) {
        entries += row.length;
        REQUIRE(row.rows == NULL && row.sphere < s->contents.n && entries <= s->rows.entries);
        for (uint32_t k = 0; k < row.length; k++) REQUIRE(row.col[k] < s->contents.n && row.f[k] >= 0);
    }
    REQUIRE(count == s->rows.count);
}

static void try_wide(struct session *s) {
    switch (byte() % 3) {
    case 0:
        try_walls(s);
        break;
    case 1:
        try_triangles(s);
        break;
    default:
        read_rows(s);
    }
}

/* ---- a scene, and what there is to be done with it -------------------------------------------------------------- */

static void try_scene(bool walled, bool meshed) {
    struct session s = {.contents = any_contents(walled, meshed), .wide = meshed};
    s.size = size_of(&s.contents);
    const uint8_t fault = byte();
    s.memory = memory_of(s.size - (fault == 1), fault % 64, &s.block);
    bool there = build(&s.scene, s.memory, s.size - (fault == 1), &s.contents) == FIBRAD_OK;
    REQUIRE(!there || fault != 1);
    s.work.memory = any_memory(&s.supply);
    s.rows.memory = any_memory(&s.rows_supply);
    if (there && meshed) try_triangles(&s);
    for (int k = byte() % 24; k > 0 && there && tame; k--) {
        switch (byte() % (meshed ? 16 : 12)) {
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
        case 12:
        case 13:
        case 14:
            try_wide(&s);
            break;
        default:
            try_row(&s);
        }
    }
    end_heat(&s);
    free(s.block), free(s.other_block), supply_end(&s.supply), supply_end(&s.rows_supply);
}

/* ---- furnace ---------------------------------------------------------------------------------------------------- */

/* A number from 1e-12 to 1e12, mostly near 1. Sometimes it is not a positive number. */
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
    /* if little is lost, bundles go on for long */
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
    count_calls();
    at = data, end = data + size;
    const uint8_t kind = byte();
    switch (kind % 8) {
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
        try_scene(kind % 8 == 7, kind >= 160);
    }
    (void)fibrad_status_text((int)number());
    (void)fibrad_isa_name((int)number());
    return 0;
}
