/* test_sides.c - sides of triangles that have films or powers. SPDX-License-Identifier: MIT */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

#include "host_owned.h"
#include "scenes.h"
#include "meshes.h"
#include "suite.h"

#define SIGMA FIBRAD_STEFAN_BOLTZMANN

static double fourth(double t) { return t * t * t * t; }

/* A box from 0 to 1 of triangles, each face cut into cells of two, and spheres inside. */
enum { MOST = 12, SIDES = 2 * MESH_TRIANGLES };
struct room {
    struct mesh *mesh;
    double at[MOST][3], r[MOST], t[MOST], e[MOST], power[MOST], film[MOST], gas[MOST], solid[MOST];
    uint32_t n, clump[MOST];
    fibrad_scene_config config;
    double wall_t[6], wall_e[6];
    double side_t[SIDES], side_film[SIDES], side_gas[SIDES], side_power[SIDES];
    fibrad_heat_sources sources;
    fibrad_bed *bed;
    /* out */
    double q[MOST], q_error[MOST], found[MOST], wall_q[6], wall_found[6], wall_error[6], wall_t_error[6];
    double flux[SIDES], side_found[SIDES];
    fibrad_heat_result result;
};

static void add_face(struct room *room, uint32_t axis, uint32_t upper, uint32_t cells, uint32_t wall) {
    struct mesh *mesh = room->mesh;
    const uint32_t first = mesh->triangles.vertices, wide = cells + 1;
    const uint32_t u = (axis + 1 + upper) % 3, v = (axis + 2 - upper) % 3;
    for (uint32_t k = 0; k < wide * wide; ++k) {
        double x[3] = {upper, upper, upper};
        x[u] = (double)(k % wide) / cells, x[v] = (double)(k / wide) / cells;
        mesh_vertex(mesh, x[0], x[1], x[2]);
    }
    for (uint32_t k = 0; k < cells * cells; ++k) {
        const uint32_t a = first + k / cells * wide + k % cells;
        mesh_quad(mesh, (const uint32_t[]){a, a + 1, a + wide + 1, a + wide}, wall, FIBRAD_NO_WALL);
    }
}

/* one: all faces are one wall. */
static struct room *room_new(uint32_t cells, bool one) {
    struct room *room = calloc(1, sizeof *room);
    ck_assert_ptr_nonnull(room);
    room->mesh = mesh_new();
    for (uint32_t face = 0; face < 6; ++face) add_face(room, face / 2, face % 2, cells, one ? 0 : face);
    for (int k = 0; k < 6; ++k) room->wall_t[k] = 500 + 40 * k, room->wall_e[k] = .8 - .1 * k;
    for (int k = 0; k < SIDES; ++k) room->side_t[k] = room->side_power[k] = NAN;
    room->config = (fibrad_scene_config){
        .wall = room->mesh->wall, .walls = one ? 1 : 6, .triangles = &room->mesh->triangles};
    for (int i = 0; i < MOST; ++i) room->e[i] = .9 - .05 * i, room->t[i] = NAN, room->clump[i] = (uint32_t)i;
    fibrad_heat_sources *s = &room->sources;
    fibrad_heat_sources_init(s);
    s->surroundings = 0, s->tolerance = 1e-12;
    s->temperature = room->t, s->emissivity = room->e, s->power = room->power;
    s->wall_temperature = room->wall_t, s->wall_emissivity = room->wall_e;
    s->side_temperature = room->side_t, s->side_film = room->side_film, s->side_gas = room->side_gas,
    s->side_power = room->side_power;
    room->result = (fibrad_heat_result){.power = room->q,
                                        .power_error = room->q_error,
                                        .temperature = room->found,
                                        .wall_power = room->wall_q,
                                        .wall_error = room->wall_error,
                                        .wall_temperature = room->wall_found,
                                        .wall_temperature_error = room->wall_t_error};
    return room;
}

static void room_free(struct room **room) {
    fibrad_bed_free((*room)->bed);
    free((*room)->mesh);
    free(*room);
}
#define OWNED_ROOM OWNED_BY(room_free) struct room

static void make_bed(struct room *room, int threads, bool clumps) {
    fibrad_bed_free(room->bed);
    room->bed = NULL;
    const fibrad_spheres spheres = {&room->at[0][0], &room->at[0][1], &room->at[0][2], room->r, room->n,
                                    .stride = 3, .clump = clumps ? room->clump : NULL};
    fibrad_run run = {.threads = threads};
    assert_ok(fibrad_bed_new(&room->bed, &room->config, &spheres, &run));
}

static void solve(struct room *room) {
    assert_ok(fibrad_bed_solve(room->bed, &room->sources, NULL, &room->result));
    assert_ok(fibrad_bed_sides(room->bed, room->flux, room->side_found));
}

/* ---- against the same problem with the temperatures that were found ---- */

enum { SPHERES = 4, CONTACTS = 5 };

/* Four spheres of unknown temperature, and films, powers and temperatures of sides by turns. */
static void fill(struct room *room) {
    static const double at[SPHERES][4] = {{.3, .3, .3, .2}, {.62, .35, .3, .15}, {.35, .7, .6, .18}, {.7, .7, .7, .16}};
    const uint32_t n = room->mesh->triangles.n;
    room->n = SPHERES;
    for (int i = 0; i < SPHERES; ++i) {
        memcpy(room->at[i], at[i], sizeof room->at[i]);
        room->r[i] = at[i][3], room->power[i] = 40. * i - 30;
    }
    for (uint32_t t = 0; t < n; ++t) {
        room->side_film[2 * t] = t % 4 < 2 ? 5. + t % 7 : 0, room->side_gas[2 * t] = 300 + 500. * t / n;
        if (t % 4 == 1 || t % 4 == 2) room->side_power[2 * t] = 30. * (t % 5) - 20;
        if (t % 8 == 3) room->side_t[2 * t] = 350;
    }
}

static double largest(const double *a, const double *b, size_t n, size_t stride) {
    double most = 0;
    for (size_t k = 0; k < n; ++k) worst_of(&most, fabs(a[k * stride] - b[k * stride]));
    return most;
}

static double sum_of_powers(const struct room *room) {
    double sum = room->result.surroundings_power + room->result.gas_power;
    for (uint32_t b = 0; b < room->config.walls; ++b) sum += room->wall_q[b];
    for (uint32_t i = 0; i < room->n; ++i) sum += room->q[i];
    return sum;
}

/* What is missing in the balance of a side. If sides share a patch only their sum vanishes. */
static double missing(const struct room *room, uint32_t t) {
    const uint32_t k = 2 * t;
    return room->flux[k] + room->side_film[k] * (room->side_gas[k] - room->side_found[k]) +
           (isnan(room->side_power[k]) ? 0 : room->side_power[k]);
}

/* The extra of a room: spheres that conduct, contacts, clumps, films of spheres, a stream, an insulated wall, light. */
enum { NOTHING, SOLID, CONTACT, CLUMP, FILM, STREAM, ONE_WALL, FINE, EXTRAS };

struct extra {
    uint32_t first[CONTACTS], second[CONTACTS], slice[SPHERES];
    double conductance[CONTACTS], at, capacity, gas[FIBRAD_STREAM_ROWS * 2];
    fibrad_stream stream;
};

static void add_extra(struct room *room, int extra, struct extra *x) {
    fibrad_heat_sources *s = &room->sources;
    *x = (struct extra){.first = {0, 0, 1, 2, 1}, .second = {1, 2, 3, 3, 2}, .slice = {0, 0, 1, 1}, .at = 300};
    for (int k = 0; k < CONTACTS; ++k) x->conductance[k] = .3 + .1 * k;
    for (int i = 0; i < SPHERES; ++i) room->film[i] = 2 + i, room->gas[i] = 400 + 30 * i, room->solid[i] = 2;
    if (extra == SOLID) s->conductivity = room->solid;
    if (extra == CONTACT)
        s->contacts = CONTACTS, s->contact_first = x->first, s->contact_second = x->second,
        s->conductance = x->conductance;
    if (extra == CLUMP) room->clump[1] = 0, room->at[1][0] = .5;
    if (extra == FILM || extra == STREAM) s->film = room->film, s->gas = room->gas;
    x->capacity = 20, x->stream = (fibrad_stream){x->slice, &x->at, &x->capacity, 2, 1, 450, x->gas};
    if (extra == STREAM) s->stream = &x->stream;
}

LOOP_TEST(temperatures_found_and_given, EXTRAS) {
    OWNED_ROOM *room = room_new(_i == FINE ? 14 : 2, _i == ONE_WALL || _i == FINE);
    const uint32_t n = room->mesh->triangles.n;
    struct extra extra;
    fill(room);
    add_extra(room, _i, &extra);
    if (_i == SOLID || _i == STREAM) room->sources.tolerance = 1e-9;
    make_bed(room, 1, _i == CLUMP);
    solve(room);
    const double scale = fabs(room->wall_q[0]) + 100, within = _i == SOLID || _i == STREAM ? 1e-4 : 1e-8;
    printf("%d sweeps %u sum %g error %g %g\n", _i, room->result.sweeps, sum_of_powers(room), room->wall_error[0], room->wall_t_error[0]);
    ck_assert_double_lt(fabs(sum_of_powers(room)), 1e-11 * scale);
    if (_i != FINE) {
        double worst = 0;
        for (uint32_t t = 0; t < n; ++t)
            if (room->side_film[2 * t] > 0 || !isnan(room->side_power[2 * t])) worst_of(&worst, fabs(missing(room, t)));
        printf("worst %g\n", worst);
        ck_assert_double_lt(worst, within * scale);
    }
    struct room *first = malloc(sizeof *first);
    memcpy(first, room, sizeof *first);
    for (uint32_t t = 0; t < n; ++t) room->side_t[2 * t] = first->side_found[2 * t];
    room->sources.side_film = room->sources.side_power = NULL;
    make_bed(room, 1, _i == CLUMP);
    solve(room);
    printf("given: sweeps %u flux %g T %g q %g T %g w %g wt %g\n", room->result.sweeps, largest(room->flux, first->flux, n, 2), largest(room->side_found, first->side_found, n, 2),
    largest(room->q, first->q, SPHERES, 1), largest(room->found, first->found, SPHERES, 1), largest(room->wall_q, first->wall_q, room->config.walls, 1), largest(room->wall_found, first->wall_found, room->config.walls, 1));
    free(first);
}
