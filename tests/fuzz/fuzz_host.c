/* fuzz_host.c - libFuzzer target: any arguments to the functions of fibrad_host.h, in any order.
 * SPDX-License-Identifier: MIT
 *
 * The beds are those of fuzz_kernel.c. Everything returned with FIBRAD_OK must be what the header promises, the same
 * to the bit for any number of threads; after an error nothing is left to free. */
#include "simple/fibrad_host.h"
#include "contents.h"

/* A bed and all objects made of it. */
struct session {
    struct contents contents;
    fibrad_spheres spheres;
    fibrad_run run;
    uint32_t reports; /* number of reports until progress asks to stop */
    double emissivity[SPHERES], wall_emissivity[WALLS];
    fibrad_bed *made;
    uint32_t asked; /* number of calls of the law of emissivities */
    uint8_t law;
};

static int progress(void *context, const char *stage, uint64_t done, uint64_t total) {
    struct session *s = context;
    REQUIRE(stage != NULL && (total == 0 || done <= total));
    return s->reports > 0 && --s->reports == 0;
}

static void any_run(struct session *s) {
    const uint8_t kind = byte();
    s->run = (fibrad_run){.threads = 1 + kind % 3, .progress = progress, .context = s};
    s->reports = kind > 200 ? kind - 200 : 0;
    if (kind == 200) s->run.threads = (int)number();
}

/* The spheres of the present contents. */
static const fibrad_spheres *spheres_of(struct session *s) {
    struct contents *c = &s->contents;
    s->spheres = (fibrad_spheres){.x = c->x, .y = c->y, .z = c->z, .r = c->r, .n = c->n, .id = c->ids ? c->id : NULL};
    contents_complete(c);
    return &s->spheres;
}

/* ---- factors ---------------------------------------------------------------------------------------------------- */

/* Whether two matrices are the same to the bit. */
static bool same(const fibrad_factors *a, const fibrad_factors *b) {
    const uint64_t entries = a->start[a->n];
    return memcmp(a->start, b->start, (a->n + 1) * sizeof *a->start) == 0 &&
           memcmp(a->col, b->col, entries * sizeof *a->col) == 0 && memcmp(a->f, b->f, entries * sizeof *a->f) == 0 &&
           memcmp(a->wall, b->wall, (size_t)a->n * a->walls * sizeof *a->wall) == 0 &&
           memcmp(a->escaped, b->escaped, a->n * sizeof *a->escaped) == 0 &&
           memcmp(a->error, b->error, a->n * sizeof *a->error) == 0;
}

/* closed: all rows add up to 1, and pairs are reciprocal. */
static void check_factors(const fibrad_bed_matrix *bed, const struct session *s, bool closed) {
    const fibrad_factors *m = &bed->matrix;
    REQUIRE(m->n == s->contents.n && m->walls == s->contents.config.walls && m->start[0] == 0);
    REQUIRE(!(bed->closure_error > 1e-9) || !plain);
    for (uint32_t i = 0; i < m->n; i++) {
        double sum = m->escaped[i] + m->beyond[i];
        for (uint64_t k = m->start[i]; k < m->start[i + 1]; k++) {
            REQUIRE(m->col[k] < m->n && (k == m->start[i] || m->col[k] > m->col[k - 1]) && m->f[k] >= 0);
            sum += m->f[k];
        }
        for (uint32_t b = 0; b < m->walls; b++) {
            REQUIRE(m->wall[(size_t)i * m->walls + b] >= 0);
            sum += m->wall[(size_t)i * m->walls + b];
        }
        REQUIRE(m->error[i] >= 0);
        if (closed) REQUIRE(fabs(sum - 1) < 1e-9 || m->start[i] == m->start[i + 1]);
    }
    if (closed) REQUIRE(bed->reciprocity_error < 1e-12);
}

static int factors_of(struct session *s, const fibrad_bed_rule *options, fibrad_bed_matrix **bed) {
    const fibrad_spheres *spheres = spheres_of(s);
    const fibrad_scene_config *config = &s->contents.config;
    return CALL(fibrad_view_factors(config, spheres, options, &s->run, bed));
}

static void try_factors(struct session *s) {
    unsigned char wanted[SPHERES];
    const uint8_t method = byte() % 8, which = byte();
    fibrad_beam_rule beam = {.directions = 8 + byte() % 32, .points = method == 1 ? 64 : 0};
    beam.cutoff = which == 1 ? coordinate() : 0, beam.tolerance = which == 2 ? .05 + share() : 0;
    const fibrad_cast_rule cast = {.rays = 1 + number() % 300, .seed = which};
    fibrad_exchange_rule grey = {.emissivity = s->emissivity, .wall_emissivity = s->wall_emissivity};
    grey.directions = beam.directions, grey.paths = 1 + byte() % 32, grey.tolerance = which == 3 ? .2 + share() : 0;
    fibrad_bed_rule options = {.raw = byte() % 4 == 0, .walls = byte() % 2, .drop = which % 8 == 0 ? share() : 0};
    if (method < 4) options.beam = &beam;
    if (method > 5 || which == 5) options.exchange = &grey; /* two, perhaps */
    if (method == 5) options.cast = &cast;
    if (which == 4) options.cast = &cast; /* two, perhaps */
    if (which > 240) options.wanted = wanted;
    if (which == 240) options.scratch = "/tmp";
    if (which == 239) options.scratch = "/nonexistent";
    for (uint32_t i = 0; i < SPHERES; i++) wanted[i] = which >> i % 4 & 1;
    fibrad_bed_matrix *bed = (fibrad_bed_matrix *)s, *again;
    const int status = factors_of(s, &options, &bed);
    REQUIRE((status == FIBRAD_OK) == (bed != NULL));
    if (status != FIBRAD_OK) return;
    const bool closed = plain && !options.raw && options.wanted == NULL && method < 6;
    check_factors(bed, s, closed);
    any_run(s);
    if (s->reports == 0 && factors_of(s, &options, &again) == FIBRAD_OK) {
        REQUIRE(same(&bed->matrix, &again->matrix));
        fibrad_bed_matrix_free(again);
    }
    fibrad_bed_matrix_free(bed);
}

/* ---- heat ------------------------------------------------------------------------------------------------------- */

/* The sources and their arrays. */
struct sources {
    fibrad_heat_sources sources;
    double temperature[SPHERES], power[SPHERES], wall_temperature[WALLS], wall_power[WALLS];
    double side[4][2 * TRIANGLES]; /* temperatures, films, gas, powers */
    unsigned char insulated[WALLS];
    bool usual; /* no number is out of the usual range of a bed */
};

/* known: all temperatures of spheres are given. in_time: powers act beside temperatures. */
static void any_sources(struct session *s, struct sources *all, bool known, bool in_time) {
    fibrad_heat_sources *f = &all->sources;
    const uint8_t which = byte();
    fibrad_heat_sources_init(f);
    f->sweeps_max = 1 + byte() % 40, f->sigma = 1, f->surroundings = which == 1 ? coordinate() : byte() / 16.;
    all->usual = which != 1 && which != 2;
    for (uint32_t i = 0; i < s->contents.n; i++) {
        const uint8_t kind = byte();
        all->temperature[i] = !known && kind % 4 == 0 ? NAN : .1 + kind / 16.;
        all->power[i] = in_time || isnan(all->temperature[i]) ? share() : 0;
        all->usual = all->usual && fabs(all->power[i]) <= 1;
    }
    for (uint32_t b = 0; b < s->contents.config.walls; b++) {
        const uint8_t kind = byte();
        all->wall_temperature[b] = kind % 5 == 0 ? NAN : kind / 16., all->wall_power[b] = kind % 5 == 0 ? kind % 3 : 0;
        all->insulated[b] = kind % 7 == 0;
    }
    for (uint32_t k = 0; k < 2 * s->contents.triangles.n; k++) {
        all->side[0][k] = k % 3 == 0 ? 1 + which / 16. : NAN, all->side[1][k] = k % 3 == 1 ? which / 16. : 0;
        all->side[2][k] = 1 + k % 7, all->side[3][k] = k % 3 == 2 && which % 4 < 2 ? which / 64. - 1 : NAN;
    }
    f->temperature = all->temperature, f->emissivity = s->emissivity, f->power = all->power;
    f->wall_temperature = all->wall_temperature, f->wall_emissivity = s->wall_emissivity;
    f->wall_power = all->wall_power, f->insulated = all->insulated;
    if (which == 2) f->sigma = coordinate();
    if (which == 3) f->temperature = NULL;
    if (which > 200 && s->contents.triangles.n > 0) f->side_temperature = all->side[0];
    if (which % 8 == 5 && s->contents.triangles.n > 0)
        f->side_film = all->side[1], f->side_gas = all->side[2], f->side_power = all->side[3];
}

/* Asserts that powers add up to zero. */
static void check_powers(const struct session *s, const fibrad_heat_result *result) {
    double sum = result->surroundings_power, size = fabs(sum);
    for (uint32_t i = 0; i < s->contents.n; i++) sum += result->power[i], size += fabs(result->power[i]);
    for (uint32_t b = 0; b < s->contents.config.walls; b++)
        sum += result->wall_power[b], size += fabs(result->wall_power[b]);
    REQUIRE(fabs(sum) <= 1e-9 * size + 1e-6);
}

static fibrad_heat_config any_heat_config(void) {
    fibrad_heat_config config = {.directions = 8 + byte() % 8, .patches = 24, .wall_rays = 1 + number() % 300};
    const uint8_t which = byte();
    if (which == 1) config.directions = number();
    if (which == 2) config.points = number();
    if (which == 3) config.patches = number();
    if (which == 4) config.wall_rays = number();
    return config;
}

/* Moves some spheres, seldom to forbidden positions. */
static void move_some(struct session *s) {
    for (int k = byte() % 4; k > 0 && s->contents.n > 0; k--) s->contents.x[number() % s->contents.n] += length() / 64;
}

/* Emissivities that fall with temperature. Seldom, from some call on, values that are no emissivities. */
static void law(void *context, const double *temperature, const double *wall_temperature, double *emissivity,
                double *wall_emissivity) {
    struct session *s = context;
    const bool wrong = s->law % 8 == 1 && ++s->asked > (uint32_t)s->law / 8 % 4;
    REQUIRE(temperature != NULL || s->contents.n == 0);
    for (uint32_t i = 0; i < s->contents.n; i++)
        if (!isnan(temperature[i])) emissivity[i] = wrong ? NAN : .2 + .6 / (1 + fabs(temperature[i]));
    for (uint32_t b = 0; b < s->contents.config.walls; b++)
        if (!isnan(wall_temperature[b])) wall_emissivity[b] = .2 + .6 / (1 + fabs(wall_temperature[b]));
}

static void try_heat(struct session *s) {
    double power[SPHERES], temperature[SPHERES], wall_power[WALLS], wall_temperature[WALLS], flux[2 * TRIANGLES];
    double power_error[SPHERES], emissivity[SPHERES], wall_emissivity[WALLS];
    fibrad_heat_result result = {.power = power, .temperature = temperature, .wall_power = wall_power};
    result.wall_temperature = wall_temperature, result.power_error = power_error;
    fibrad_law follow = {law, s, emissivity, wall_emissivity};
    struct sources all;
    const bool follows = byte() % 4 == 0;
    memcpy(emissivity, s->emissivity, sizeof emissivity);
    memcpy(wall_emissivity, s->wall_emissivity, sizeof wall_emissivity);
    any_sources(s, &all, !follows && byte() % 2, false);
    s->law = byte(), s->asked = 0;
    const int status = CALL(fibrad_bed_solve(s->made, &all.sources, follows ? &follow : NULL, &result));
    if (status != FIBRAD_OK) return;
    if (all.usual) check_powers(s, &result);
    for (uint32_t i = 0; i < s->contents.n; i++)
        REQUIRE(power_error[i] >= 0 && (!follows || (emissivity[i] >= 0 && emissivity[i] <= 1)));
    REQUIRE(fibrad_bed_sides(s->made, flux, NULL) == FIBRAD_OK);
}

/* ---- time ------------------------------------------------------------------------------------------------------- */

static void advance(struct session *s, struct sources *all) {
    double capacity[SPHERES], temperature[SPHERES], power[SPHERES], wall_power[WALLS], wall_energy[WALLS];
    for (uint32_t i = 0; i < s->contents.n; i++) {
        const uint8_t kind = byte();
        temperature[i] = kind == 255 ? coordinate() : .5 + kind / 64.;
        capacity[i] = kind == 254 ? coordinate() : 1 + kind;
    }
    double before[SPHERES];
    memcpy(before, temperature, sizeof before);
    const uint8_t which = byte();
    fibrad_span span = {.temperature = temperature, .capacity = capacity};
    span.duration = which == 1 ? coordinate() : .1 + which / 64., span.step = which == 2 ? coordinate() : 0;
    span.tolerance = 1e-2, span.power = power, span.wall_power = wall_power, span.wall_energy = wall_energy;
    span.context = s;
    fibrad_law follow = {.follow = law, .context = s};
    double side_end[2][2 * TRIANGLES], side_energy[2 * TRIANGLES], side_found[2 * TRIANGLES], convected[SPHERES];
    for (uint32_t k = 0; k < 2 * s->contents.triangles.n; k++)
        side_end[0][k] = all->side[0][k] + 1, side_end[1][k] = all->side[2][k] * 2;
    if (which % 4 == 3) { /* patches serve alone, which takes time */
        span.side_energy = side_energy, span.side_end = side_found, span.convected_energy = convected;
        span.step = span.duration / 2;
    }
    if (which % 8 == 3 && all->sources.side_temperature) span.side_temperature = side_end[0];
    if (which % 8 == 7 && all->sources.side_gas) span.side_gas = side_end[1];
    if (which > 240) span.law = &follow, s->law = which, s->asked = 0;
    if (which == 2 && !(span.step > .01)) span.step = .1;
    all->sources.tolerance = 1e-2, all->sources.sigma *= .01; /* few steps */
    if (which == 1 && span.duration > 10) span.duration = 10;
    const int status = CALL(fibrad_bed_advance(s->made, &all->sources, &span));
    if (status != FIBRAD_OK) REQUIRE(memcmp(before, temperature, s->contents.n * sizeof *before) == 0);
    if (status != FIBRAD_OK) return;
    double stored = 0, given = span.surroundings_energy, size = fabs(given), sources = 0;
    for (uint32_t i = 0; i < s->contents.n; i++) {
        REQUIRE(temperature[i] > 0 && isfinite(temperature[i]));
        stored += capacity[i] * (temperature[i] - before[i]), size += capacity[i] * temperature[i];
        sources += all->power[i] * span.duration;
    }
    for (uint32_t b = 0; b < s->contents.config.walls; b++) given += wall_energy[b], size += fabs(wall_energy[b]);
    for (uint32_t i = 0; i < s->contents.n && span.convected_energy; i++) REQUIRE(convected[i] == 0);
    if (all->usual) REQUIRE(fabs(stored + given - sources) <= 1e-8 * (size + fabs(sources)) + 1e-9);
}

static void try_contacts(struct session *s) {
    const fibrad_contact_rule rule = {.spots = byte() % 4, .scale = byte() % 3, .gas_reach = byte() / 128.};
    const fibrad_contact_list *list;
    const int status = CALL(fibrad_bed_contacts(s->made, &rule, &list));
    REQUIRE((status == FIBRAD_OK) == (list != NULL));
    for (uint32_t k = 0; status == FIBRAD_OK && k < list->n; k++)
        REQUIRE(list->first[k] < s->contents.n && list->second[k] < s->contents.n + s->contents.config.walls);
}

/* Calls of one object, in any order. */
static void try_made(struct session *s) {
    struct sources all;
    if (has_many_images(&s->contents)) return;
    if (s->made == NULL) {
        const int status = CALL(fibrad_bed_new(&s->made, &s->contents.config, spheres_of(s), &s->run));
        REQUIRE((status == FIBRAD_OK) == (s->made != NULL));
        if (status != FIBRAD_OK) return;
    }
    switch (byte() % 6) {
    case 0:
        move_some(s);
        (void)CALL(fibrad_bed_move(s->made, &s->contents.config, spheres_of(s)));
        break;
    case 1: {
        const fibrad_heat_config config = any_heat_config();
        if (config.directions <= 64 && config.points <= 256) (void)CALL(fibrad_bed_beams(s->made, &config));
        break;
    }
    case 2:
        any_sources(s, &all, true, true);
        advance(s, &all);
        break;
    case 3:
        try_contacts(s);
        break;
    default:
        try_heat(s);
    }
    fibrad_scene_facts facts;
    fibrad_fault fault;
    fibrad_warning warning[FIBRAD_WARNINGS_MAX];
    fibrad_bed_describe(s->made, &facts, &fault);
    REQUIRE(fibrad_bed_warnings(s->made, warning) <= FIBRAD_WARNINGS_MAX);
}

/* ---- a bed, and what there is to be done with it ---------------------------------------------------------------- */

static void try_bed(void) {
    const uint8_t kind = byte();
    struct session s = {.contents = any_contents(kind & 1, kind & 2)};
    for (uint32_t i = 0; i < SPHERES; i++) s.emissivity[i] = i % 5 == kind % 5u ? share() : .3 + .05 * (i % 14);
    for (uint32_t b = 0; b < WALLS; b++) s.wall_emissivity[b] = b == kind % 8u ? share() : .2 + .08 * b;
    for (int k = byte() % 12; k > 0 && plain; k--) {
        any_run(&s);
        if (byte() % 4 == 0)
            try_factors(&s);
        else
            try_made(&s);
    }
    fibrad_bed_free(s.made);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    count_calls();
    at = data, end = data + size;
    try_bed();
    char name[32] = "fibrad_";
    for (int k = 7; k < 31; k++) name[k] = (char)byte();
    (void)fibrad_host_sizeof(name);
    void *block = fibrad_heap_resize(NULL, NULL, 1 + number() % 4096);
    REQUIRE(block != NULL);
    free(block);
    return 0;
}
