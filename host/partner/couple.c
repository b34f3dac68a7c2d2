/* couple.c - a bed that goes through time together with another solver. SPDX-License-Identifier: MIT */
#include <gsl/gsl_math.h>
#include <stdlib.h>
#include <string.h>

#include "heat/time_run.h"
#include "partner/partner.h"

/* The result of a time window that is repeated must change smoothly with what the partner gives. So repeats have equal
 * steps, as many as the first try took, but at most this many. The residual of powers is smaller then. */
enum { REPEATED_STEPS = 4 };
#define REPEATED_RESIDUAL 1e-9

#define FILM_LEAST 1e-6 /* [W/(m2 K)] stands for 0, which would mean no film: the face is nearly insulated */

struct coupling {
    struct time_run run;
    struct exchange *exchange;
    double *side[6], *saved; /* side[SIDE_...]: [2 triangles] each; saved: [2 spheres] temperatures and melted fractions
                                at the beginning */
    double *gas_begun;       /* [spheres] [K] */
    struct touched *touched; /* [faces] */
    double *contact[3];      /* [contacts] each: temperatures at the end [K], energies [J], flows of the last try [W] */
    double every, written;   /* [s] from one output to the next; time of the last one */
    uint64_t windows, tries; /* tries: of the present time window */
    size_t points;           /* of the picture, at the beginning of that window */
};
enum { CONTACT_END, CONTACT_ENERGY, CONTACT_FLOW };

/* A face, and the contacts that end on it. */
struct touched {
    double begun, behind; /* [K] of the face, and behind its film, at the beginning of the time window */
    double conductance;   /* [W/K] of its contacts */
    double supply;        /* [W] what its contacts would bring to the face at 0 K */
};

enum { SIDE_BEGUN, SIDE_END, SIDE_FILM, BEHIND_BEGUN, BEHIND_END, SIDE_ENERGY };

/* ---- faces and particles ----------------------------------------------------------------------------------------- */

/* Chooses the walls by their names. */
static int choose_walls(struct exchange *e) {
    const struct walls *walls = e->walls;
    for (uint32_t k = 0; k < walls->count; ++k)
        e->exchanged[k] = !e->wall_names && walls->wall[k].kind == FIBRAD_WALL_MESH;
    for (const char *name = e->wall_names; name && *name; name += strcspn(name, ","), name += *name == ',') {
        char one[MESH_NAME];
        snprintf(one, sizeof one, "%.*s", (int)strcspn(name, ","), name);
        const uint32_t k = wall_index(walls, one);
        if (k == WALLS_MAX || walls->wall[k].kind != FIBRAD_WALL_MESH)
            return message(STATUS_USAGE, "--faces: there is no wall of triangles %s", one);
        e->exchanged[k] = true;
    }
    return STATUS_OK;
}

/* A wall whose faces are exchanged has an emissivity above 0, and a temperature at which it begins. */
static int check_walls(const struct heat *h, const struct exchange *e) {
    for (uint32_t k = 0; k < h->walls.count; ++k) {
        const char *name = wall_name(&h->walls, k);
        if (!e->exchanged[k]) continue;
        if (isnan(h->values.wall_temperature[k]) || h->values.insulated[k])
            return message(STATUS_USAGE, "--wall: %s has faces of %s and needs the temperature at which it begins, %s",
                           name, e->name, "temperature=300 for example");
        if (!(h->wall_emissivity[k] > 0))
            return message(STATUS_USAGE, "--wall: %s has faces of %s and needs an emissivity above 0", name, e->name);
        if (h->walls.said[k].given & (WALL_CAPACITY | WALL_CONVECTION))
            return message(STATUS_USAGE,
                           "--wall: %s has faces of %s, which stores and carries away its heat; leave out capacity and "
                           "convection",
                           name, e->name);
    }
    return STATUS_OK;
}

static int make_faces(struct heat *h, struct exchange *e) {
    struct exchange_faces *f = &e->faces;
    const struct meshes *meshes = h->walls.meshes;
    const uint32_t triangles = meshes ? meshes->triangles.n : 0;
    double *block = calloc(9 * (size_t)triangles + 1, sizeof *block);
    f->triangle = calloc(2 * (size_t)triangles + 1, sizeof *f->triangle);
    f->centre = (double(*)[3])block, f->area = block + 3 * (size_t)triangles;
    if (!block || !f->triangle) return message_memory();
    f->of_triangle = f->triangle + triangles;
    for (uint32_t t = 0; t < triangles; ++t) f->of_triangle[t] = NOT_EXCHANGED;
    double **const array[] = {&f->temperature, &f->film, &f->behind, &f->energy, &f->found};
    for (size_t a = 0; a < 5; ++a) *array[a] = f->area + (a + 1) * triangles;
    for (uint32_t t = 0; t < 3 * triangles; ++t) f->temperature[t] = NAN;
    for (uint32_t k = 0; k < h->walls.count; ++k) {
        f->first[k] = f->n;
        for (uint32_t t = 0; t < triangles && e->exchanged[k]; ++t) {
            if (meshes->front[t] != k && meshes->back[t] != k) continue;
            const struct mesh *mesh = mesh_of_triangle(meshes, t);
            const uint32_t own = t - mesh->first;
            for (int c = 0; c < 3; ++c)
                for (int x = 0; x < 3; ++x)
                    f->centre[f->n][x] += surface_corner(&mesh->surface, own, c)[x] / 3 * h->bed->metres;
            f->area[f->n] = surface_area(&mesh->surface, own) * gsl_pow_2(h->bed->metres);
            const double *side = h->values.side_temperature;
            f->found[f->n] = side && !isnan(side[2 * t]) ? side[2 * t] : h->values.wall_temperature[k];
            f->of_triangle[t] = f->n, f->triangle[f->n++] = t;
        }
    }
    for (uint32_t k = h->walls.count; k <= WALLS_MAX; ++k) f->first[k] = f->n;
    return STATUS_OK;
}

static int make_particles(struct heat *h, struct exchange *e) {
    struct exchange_particles *p = &e->particles;
    const struct bed *bed = h->bed;
    double *block = calloc(8 * (size_t)bed->n + 1, sizeof *block);
    p->n = bed->n, p->centre = (double(*)[3])block;
    if (!block) return message_memory();
    p->gas = block + 3 * (size_t)bed->n, p->film = p->gas + bed->n, p->energy = p->film + bed->n;
    p->found = p->energy + bed->n, p->conductance = p->found + bed->n;
    for (uint32_t i = 0; i < bed->n; ++i) {
        for (int axis = 0; axis < 3; ++axis) p->centre[i][axis] = bed_centres(bed, axis)[i] * bed->metres;
        p->found[i] = h->values.temperature[i];
    }
    return STATUS_OK;
}

/* Points the run to the arrays of sides and gas. */
static int make_sides(struct coupling *c) {
    struct time_run *m = &c->run;
    struct heat *h = m->heat;
    const size_t sides = h->walls.meshes ? 2 * (size_t)h->walls.meshes->triangles.n : 0, n = h->bed->n;
    double *block = malloc((7 * sides + 4 * n + 1) * sizeof *block);
    if (!block) return message_memory();
    for (size_t a = 0; a < 6; ++a) c->side[a] = block + a * sides;
    for (size_t s = 0; s < 7 * sides; ++s) block[s] = NAN;
    for (size_t s = 0; s < sides; ++s) c->side[SIDE_FILM][s] = 0;
    if (h->values.side_temperature)
        for (int a = SIDE_BEGUN; a <= SIDE_END; ++a)
            memcpy(c->side[a], h->values.side_temperature, sides * sizeof *block);
    if (c->exchange->faces.n > 0) { /* else exchange factors may serve */
        m->sources.side_temperature = c->side[SIDE_BEGUN], m->span.side_temperature = c->side[SIDE_END];
        m->sources.side_film = c->side[SIDE_FILM];
        m->sources.side_gas = c->side[BEHIND_BEGUN], m->span.side_gas = c->side[BEHIND_END];
        m->span.side_energy = c->side[SIDE_ENERGY], m->span.side_end = block + 6 * sides;
    }
    c->saved = block + 7 * sides, c->gas_begun = c->saved + 2 * n;
    if (h->films.film) m->span.convected_energy = c->gas_begun + n;
    if (c->exchange->gives_gas) m->sources.gas = c->gas_begun, m->span.gas = h->films.end;
    return STATUS_OK;
}

/* ---- contacts that end on faces ---------------------------------------------------------------------------------- */

/* Finds the face that contact k touches. False: there is none. */
static bool find_face(const struct coupling *c, uint32_t k, uint32_t *face) {
    const uint32_t *side = c->run.heat->touching.side;
    *face = !side || side[k] == CONTACT_NO_SIDE ? NOT_EXCHANGED : c->exchange->faces.of_triangle[side[k] / 2];
    return *face != NOT_EXCHANGED;
}

static double conductance_of(const struct contact_state *t, uint32_t k) { return t->conductance[k] / t->per_watt; }

static int make_contacts(struct coupling *c) {
    struct contact_state *t = &c->run.heat->touching;
    const struct exchange *e = c->exchange;
    double *block = calloc(3 * (size_t)t->n + 1, sizeof *block);
    c->contact[0] = block, c->touched = calloc(e->faces.n + (size_t)1, sizeof *c->touched);
    if (!block || !c->touched) return message_memory();
    for (size_t a = 1; a < 3; ++a) c->contact[a] = block + a * t->n;
    for (uint32_t f = 0; f < e->faces.n; ++f) c->touched[f].begun = e->faces.found[f];
    if (!t->temperature) return STATUS_OK;
    c->run.span.contact_temperature = c->contact[CONTACT_END], c->run.span.contact_energy = c->contact[CONTACT_ENERGY];
    for (uint32_t k = 0, f; k < t->n; ++k) {
        if (find_face(c, k, &f)) { /* then the first end is a sphere */
            t->temperature[k] = e->faces.found[f];
            c->contact[CONTACT_FLOW][k] = conductance_of(t, k) * (e->particles.found[t->first[k]] - t->temperature[k]);
        }
        c->contact[CONTACT_END][k] = t->temperature[k];
    }
    return STATUS_OK;
}

/* Contacts act at the temperatures of faces. For a face with a film this is the temperature of the last try. The face
 * takes the flow of that try, or less if it has become hotter by now: contacts are part of its film. */
static void set_contacts(struct coupling *c) {
    struct contact_state *t = &c->run.heat->touching;
    const struct exchange_faces *f = &c->exchange->faces;
    for (uint32_t k = 0; k < f->n; ++k) {
        struct touched *touched = &c->touched[k];
        touched->conductance = touched->supply = 0;
        if (c->windows > 0) continue;
        touched->behind = f->behind[k];
        if (!(f->film[k] >= 0)) touched->begun = f->temperature[k];
    }
    for (uint32_t k = 0, face; k < t->n; ++k) {
        if (!find_face(c, k, &face)) continue;
        struct touched *touched = &c->touched[face];
        const double end = f->film[face] >= 0 ? f->found[face] : f->temperature[face], own = conductance_of(t, k);
        t->temperature[k] = touched->begun, c->contact[CONTACT_END][k] = end;
        touched->conductance += own;
        touched->supply += c->contact[CONTACT_FLOW][k] + own * (touched->begun + end) / 2;
    }
}

/* Adds what contacts bring to faces, and keeps their flows for the next try. */
static void take_contacts(struct coupling *c) {
    const uint32_t n = c->run.heat->touching.n;
    for (uint32_t k = 0, face; k < n; ++k) {
        if (!find_face(c, k, &face)) continue;
        const double energy = c->contact[CONTACT_ENERGY][k];
        c->exchange->faces.energy[face] += energy;
        c->contact[CONTACT_FLOW][k] = energy / c->exchange->length;
    }
}

/* The temperature behind a film of which contacts are a part. film: with this part [W/(m2 K)]. */
static double behind_both(const struct touched *touched, double behind, double film, double area) {
    return behind + (touched->supply - touched->conductance * behind) / (film * area);
}

/* ---- one time window --------------------------------------------------------------------------------------------- */

/* Sets what the partner gives at the end of the time window. In the first one this holds from the beginning on. */
static void set_given(struct coupling *c) {
    struct exchange *e = c->exchange;
    struct heat *h = c->run.heat;
    const struct exchange_faces *f = &e->faces;
    const bool first = c->windows == 0;
    set_contacts(c);
    for (uint32_t k = 0; k < f->n; ++k) {
        const struct touched *touched = &c->touched[k];
        const uint32_t t = f->triangle[k];
        const bool film = f->film[k] >= 0; /* not NaN */
        const double both_films = fmax(f->film[k], FILM_LEAST) + touched->conductance / f->area[k];
        const bool both = h->walls.meshes->front[t] != FIBRAD_NO_WALL && h->walls.meshes->back[t] != FIBRAD_NO_WALL;
        for (size_t s = 2 * (size_t)t; s < 2 * (size_t)t + 2; ++s) { /* both sides share the film of a face */
            c->side[SIDE_FILM][s] = film ? both_films * c->run.square_metres / (both ? 2 : 1) : 0;
            c->side[SIDE_END][s] = film ? NAN : f->temperature[k];
            if (first || film) c->side[SIDE_BEGUN][s] = c->side[SIDE_END][s];
            c->side[BEHIND_BEGUN][s] = behind_both(touched, touched->behind, both_films, f->area[k]);
            c->side[BEHIND_END][s] = behind_both(touched, f->behind[k], both_films, f->area[k]);
        }
    }
    for (uint32_t i = 0; i < e->particles.n && e->gives_gas; ++i) {
        h->films.end[i] = e->particles.gas[i];
        if (first) c->gas_begun[i] = h->films.end[i];
        if (e->gives_film) h->films.film[i] = e->particles.film[i] * heat_area(h, i) * h->films.per_watt;
    }
}

/* [W/K] By how much the mean power to the gas falls if the gas is 1 K hotter at the end of the time window. In the
 * first time window the temperature of the gas is constant, in later ones it changes evenly. A sphere of the capacity
 * [J/K] follows the gas. */
static double mean_conductance(const struct coupling *c, double film, double capacity) {
    const double x = c->run.store ? 0 : film * c->exchange->length / capacity;
    return c->windows > 0 ? film / (2 + x / 1.5) : film / (1 + x / 2);
}

/* Takes what the bed has found at the end of a time window. */
static void take_found(struct coupling *c) {
    struct exchange *e = c->exchange;
    const fibrad_span *span = &c->run.span;
    for (uint32_t k = 0; k < e->faces.n; ++k) {
        const size_t s = 2 * (size_t)e->faces.triangle[k];
        const double energy = side_joined(span->side_energy + s, sum_of_sides);
        e->faces.found[k] = side_joined(span->side_end + s, mean_of_sides);
        e->faces.energy[k] = isnan(energy) ? 0 : energy;
    }
    take_contacts(c);
    const struct film_state *films = &c->run.heat->films;
    for (uint32_t i = 0; i < e->particles.n; ++i) {
        e->particles.found[i] = span->temperature[i];
        if (!films->film) continue;
        e->particles.energy[i] = -span->convected_energy[i];
        e->particles.conductance[i] = mean_conductance(c, films->film[i] / films->per_watt, span->capacity[i]);
    }
}

/* Saves the state at the beginning of a time window, or goes back to it. */
static void keep_state(struct coupling *c, bool back) {
    const fibrad_span *span = &c->run.span;
    const size_t n = c->run.heat->bed->n;
    double *const state[2] = {span->temperature, span->melted};
    for (size_t a = 0; a < 2; ++a)
        if (state[a])
            memcpy(back ? state[a] : c->saved + a * n, back ? c->saved + a * n : state[a], n * sizeof **state);
    *(back ? &c->run.points : &c->points) = back ? c->points : c->run.points;
}

static int try_window(struct coupling *c) {
    struct time_run *m = &c->run;
    struct exchange *e = c->exchange;
    if (c->tries == 0) keep_state(c, false);
    if (c->tries == 1) {
        const double steps = fmin((double)m->span.steps, REPEATED_STEPS);
        m->span.step = m->heat->time.step > 0 ? m->heat->time.step : e->length / steps;
        m->sources.tolerance = REPEATED_RESIDUAL;
    }
    ++c->tries;
    set_given(c);
    const int status = time_try(m, m->now + e->length);
    take_found(c);
    return status;
}

/* Ends a time window: values at its end are those at the beginning of the next one. */
static void end_window(struct coupling *c) {
    struct time_run *m = &c->run;
    struct heat *h = m->heat;
    struct report *report = &h->options.report;
    const struct exchange_faces *f = &c->exchange->faces;
    const size_t sides = h->walls.meshes ? 2 * (size_t)h->walls.meshes->triangles.n : 0;
    double faces = 0, stored = 0;
    time_keep(m);
    m->span.step = h->time.step, m->sources.tolerance = 0;
    for (size_t s = 0; s < sides; ++s)
        c->side[SIDE_BEGUN][s] = c->side[SIDE_END][s], c->side[BEHIND_BEGUN][s] = c->side[BEHIND_END][s];
    if (c->exchange->gives_gas) memcpy(c->gas_begun, h->films.end, h->bed->n * sizeof *c->gas_begun);
    for (uint32_t k = 0; k < f->n; ++k) {
        faces += f->energy[k];
        c->touched[k].begun = f->found[k], c->touched[k].behind = f->behind[k];
    }
    for (uint32_t k = 0, face; k < h->touching.n; ++k)
        if (find_face(c, k, &face)) h->touching.temperature[k] = f->found[face];
    for (uint32_t i = 0; i < h->bed->n; ++i) stored += m->stored[i];
    report_begin(report);
    report_count(report, "window", c->windows++);
    report_value(report, "time_s", m->now, 9);
    report_count(report, "iterations", c->tries);
    report_count(report, "steps", m->span.steps);
    report_value(report, "faces_J", faces, 9);
    report_value(report, "gas_J", m->span.gas_energy, 9);
    wall_values_report(&h->walls, m->wall_energy, "_J", 9, report);
    report_value(report, "surroundings_J", m->span.surroundings_energy, 9);
    report_value(report, "stored_J", stored, 9);
    report_end(report);
    c->tries = 0;
}

/* ---- the run ----------------------------------------------------------------------------------------------------- */

static int write_now(struct coupling *c) {
    c->written = c->run.now;
    return time_write(&c->run);
}

/* Goes through all time windows. Returns the status of the bed. *ended: the status of the partner. */
static int run_windows(struct coupling *c, const struct partner *partner, int *ended) {
    struct exchange *e = c->exchange;
    int status = STATUS_OK;
    for (;;) {
        bool again = false;
        *ended = partner->next(e);
        if (*ended || e->length == 0) return STATUS_OK;
        status = try_window(c);
        if (!status) *ended = partner->give(e, &again);
        if (status || *ended) return status;
        if (again) {
            keep_state(c, true);
            continue;
        }
        end_window(c);
        if (c->every > 0 && c->run.now - c->written >= c->every * (1 - 1e-9)) status = write_now(c);
        if (status) return status;
    }
}

int couple_run(struct heat *h, const struct partner *partner, struct exchange *e, double every, int *ended) {
    struct coupling c = {.run.heat = h, .exchange = e, .every = every};
    e->walls = &h->walls;
    int status = partner->choose ? partner->choose(e) : choose_walls(e);
    if (!status) status = check_walls(h, e);
    if (!status) status = make_faces(h, e);
    if (!status) status = make_particles(h, e);
    if (!status) status = heat_find_places(h, e->exchanged);
    if (!status) status = time_begin(&c.run);
    if (!status) status = make_sides(&c);
    if (!status) status = make_contacts(&c);
    if (!status) status = partner->begin(e);
    if (!status) status = run_windows(&c, partner, ended);
    if (c.tries > 0) keep_state(&c, true); /* the partner has failed within a time window */
    if (!status && c.windows > 0 && c.written < c.run.now) status = write_now(&c);
    if (!status && c.windows > 0) status = time_report(&c.run);
    progress_stop(&h->options.progress);
    time_end(&c.run);
    free(c.side[0]);
    free(c.contact[0]);
    free(c.touched);
    free(e->faces.centre);
    free(e->faces.triangle);
    free(e->particles.centre);
    return status;
}
