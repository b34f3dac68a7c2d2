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
    room->config =
        (fibrad_scene_config){.wall = room->mesh->wall, .walls = one ? 1 : 6, .triangles = &room->mesh->triangles};
    for (int i = 0; i < MOST; ++i) room->e[i] = .9 - .05 * i, room->t[i] = NAN;
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
    const fibrad_spheres spheres = {&room->at[0][0],
                                    &room->at[0][1],
                                    &room->at[0][2],
                                    room->r,
                                    room->n,
                                    .stride = 3,
                                    .clump = clumps ? room->clump : NULL};
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
enum { NOTHING, SOLID, CONTACT, CLUMP, FILM, STREAM, ONE_WALL, FINE, LIT, EXTRAS };

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
    if (extra == CLUMP) room->clump[0] = room->clump[1] = 7, room->at[1][0] = .5;
    if (extra == FILM || extra == STREAM) s->film = room->film, s->gas = room->gas;
    x->capacity = 20, x->stream = (fibrad_stream){x->slice, &x->at, &x->capacity, 2, 1, 450, x->gas};
    if (extra == STREAM) s->stream = &x->stream;
}

/* Sets the temperatures of sides to those that were found, and takes films and powers away. */
static void give_found(struct room *room) {
    for (uint32_t t = 0; t < room->mesh->triangles.n; ++t) room->side_t[2 * t] = room->side_found[2 * t];
    room->sources.side_film = room->sources.side_power = NULL;
}

/* Makes the bed and solves. Light comes from above, where the last wall is taken away. */
static void solve_with(struct room *room, int extra) {
    const fibrad_light light = {.direction = {0, 0, -1}, .flux = 3000};
    double absorbed[SPHERES], first[SPHERES], walls[2][6], absorptivity[6] = {.5, .5, .5, .5, .5, .5};
    const fibrad_light_sources lights = {&light, 1, room->e, absorptivity, 1e-12};
    fibrad_light_result lit = {.absorbed = absorbed, .absorbed_first = first};
    lit.wall_absorbed = walls[0], lit.wall_absorbed_first = walls[1];
    if (extra == LIT && room->config.walls == 6)
        room->config.walls = 5, room->mesh->triangles.n = room->mesh->triangles.n / 6 * 5,
        room->sources.surroundings = 300;
    make_bed(room, 1, extra == CLUMP);
    if (extra == LIT) {
        assert_ok(fibrad_bed_shine(room->bed, &lights, &lit));
        ck_assert_double_gt(walls[0][0], 100);
        room->sources.absorbed = lit.patches;
    }
    solve(room);
}

/* Fluxes, powers and temperatures are those of the temperatures that were found; the balance of each side closes; and
 * all powers add up to 0. Spheres that conduct and streams are found to 1e-3 and 1e-5 only. */
LOOP_TEST(temperatures_found_and_given, EXTRAS) {
    OWNED_ROOM *room = room_new(_i == FINE ? 14 : 2, _i == ONE_WALL || _i == FINE);
    OWNED struct room *first = malloc(sizeof *first);
    struct extra extra;
    fill(room);
    add_extra(room, _i, &extra);
    solve_with(room, _i);
    const uint32_t n = room->mesh->triangles.n;
    const double within = _i == SOLID || _i == STREAM ? .05 : 1e-7;
    ck_assert_double_lt(fabs(sum_of_powers(room)), 1e-10);
    double worst = 0;
    for (uint32_t t = 0; t < n && _i != FINE; ++t)
        if (isnan(room->side_t[2 * t]) && (room->side_film[2 * t] > 0 || !isnan(room->side_power[2 * t])))
            worst_of(&worst, fabs(missing(room, t)));
    ck_assert_double_lt(worst, _i == SOLID || _i == STREAM ? 1e-5 : 1e-8);
    for (uint32_t b = 0; b < room->config.walls; ++b) {
        ck_assert_double_gt(room->wall_error[b], 0);
        ck_assert_double_lt(room->wall_error[b], 5);
        ck_assert_double_gt(room->wall_t_error[b], 0);
        ck_assert_double_lt(room->wall_t_error[b], .5);
    }
    memcpy(first, room, sizeof *first);
    give_found(room);
    solve_with(room, _i);
    ck_assert_double_lt(largest(room->flux, first->flux, n, 2), within);
    ck_assert_double_lt(largest(room->q, first->q, SPHERES, 1), within);
    ck_assert_double_lt(largest(room->wall_q, first->wall_q, room->config.walls, 1), within);
    ck_assert_double_lt(largest(room->found, first->found, SPHERES, 1), within);
    ck_assert_double_lt(largest(room->wall_found, first->wall_found, room->config.walls, 1), within);
    ck_assert_double_lt(largest(room->side_found, first->side_found, n, 2), 1e-10);
    if (_i == FINE) return;
    /* the fluxes are given as powers; one side stays as it is, so that the level of temperatures is given */
    room->sources.side_power = room->side_power;
    for (uint32_t t = 1; t < n; ++t) room->side_t[2 * t] = NAN, room->side_power[2 * t] = -first->flux[2 * t];
    room->side_power[0] = NAN;
    solve_with(room, _i);
    ck_assert_double_lt(largest(room->side_found, first->side_found, n, 2), within);
}

/* A film of 1e9 has the temperature behind it. Films of 0 leave every bit as it is. */
TEST(thick_and_thin_films) {
    OWNED_ROOM *room = room_new(2, false);
    OWNED struct room *first = malloc(sizeof *first);
    const uint32_t n = room->mesh->triangles.n;
    fill(room);
    room->sources.side_power = NULL;
    for (int k = 0; k < 6; ++k) room->wall_e[k] = k % 2 ? 1 : .7;
    for (uint32_t t = 0; t < n; ++t) room->side_film[2 * t] = 1e9, room->side_t[2 * t] = NAN;
    make_bed(room, 1, false);
    solve(room);
    ck_assert_double_lt(largest(room->side_found, room->side_gas, n, 2), 1e-4); /* flux/1e9 */
    memcpy(first, room, sizeof *first);
    room->sources.side_film = NULL, room->sources.side_temperature = room->side_gas;
    solve(room);
    ck_assert_double_lt(largest(room->flux, first->flux, n, 2), 5e-3);
    make_bed(room, 1, false);
    solve(room);
    memcpy(first, room, sizeof *first);
    for (uint32_t t = 0; t < n; ++t) room->side_film[2 * t] = 0;
    room->sources.side_film = room->side_film, room->sources.side_power = room->side_power;
    for (uint32_t t = 0; t < n; ++t) room->side_power[2 * t] = NAN;
    make_bed(room, 1, false);
    solve(room);
    ck_assert_int_eq(memcmp(room->q, first->q, sizeof room->q), 0);
    ck_assert_int_eq(memcmp(room->flux, first->flux, sizeof room->flux), 0);
}

/* The factor between parallel faces of a cube is f, that between faces at an edge (1 - f)/4. The network has one
 * radiosity a face. */
TEST(a_cube_of_films) {
    const double f = 2 / M_PI * (log(sqrt(4. / 3)) + 2 * sqrt(2) * atan(sqrt(.5)) - 2 * atan(1));
    OWNED_ROOM *room = room_new(1, false);
    double t[6], film[6], gas[6], power[6], e[6], j[6] = {0};
    for (int k = 0; k < 6; ++k) {
        film[k] = k == 5 ? 0 : 4. * k, gas[k] = 300 + 150 * k, power[k] = k == 5 ? -200 : k == 0 ? 3000 : 0;
        e[k] = room->wall_e[k], t[k] = 500;
    }
    for (uint32_t s = 0; s < room->mesh->triangles.n; ++s) {
        const uint32_t k = room->mesh->front[s];
        room->side_film[2 * s] = film[k], room->side_gas[2 * s] = gas[k];
        room->side_power[2 * s] = power[k] == 0 ? NAN : power[k];
    }
    make_bed(room, 1, false);
    solve(room);
    for (int round = 0; round < 20000; ++round) /* radiosities and temperatures in turn */
        for (int k = 0; k < 6; ++k) {
            double h = f * j[k ^ 1];
            for (int i = 0; i < 6; ++i) h += i / 2 != k / 2 ? (1 - f) / 4 * j[i] : 0;
            for (int step = 0; step < 3; ++step)
                t[k] += (e[k] * (h - SIGMA * fourth(t[k])) + film[k] * (gas[k] - t[k]) + power[k]) /
                        (4 * e[k] * SIGMA * t[k] * t[k] * t[k] + film[k]);
            j[k] = (1 - e[k]) * h + e[k] * SIGMA * fourth(t[k]);
        }
    for (int k = 0; k < 6; ++k) {
        ck_assert_double_eq_tol(room->wall_found[k], t[k], 4);
        ck_assert_double_eq_tol(room->wall_q[k], film[k] * (t[k] - gas[k]) - power[k], 15);
    }
}

/* A solution that begins with that of other patches, or of other films, is that of a new bed. */
TEST(later_solutions) {
    OWNED_ROOM *room = room_new(2, false);
    OWNED struct room *first = malloc(sizeof *first);
    const uint32_t n = room->mesh->triangles.n;
    const fibrad_heat_config few = {.patches = 24, .directions = 100};
    fill(room);
    make_bed(room, 1, false);
    solve(room);
    assert_ok(fibrad_bed_beams(room->bed, &few));
    for (int round = 0; round < 3; ++round) {
        for (uint32_t t = 0; t < n; ++t) room->side_gas[2 * t] += 200 * round;
        if (round == 2) give_found(room);
        solve(room);
        memcpy(first, room, sizeof *first);
        make_bed(room, 1, false);
        assert_ok(fibrad_bed_beams(room->bed, &few));
        solve(room);
        ck_assert_double_lt(largest(room->flux, first->flux, n, 2), 1e-7);
        ck_assert_double_lt(largest(room->found, first->found, SPHERES, 1), 1e-8);
        ck_assert_double_lt(largest(room->side_found, first->side_found, n, 2), 1e-8);
    }
}

/* Numbers of threads change no bit; the order of the triangles changes rounding, and which rays are sent. */
TEST(threads_and_the_order_of_triangles) {
    OWNED_ROOM *room = room_new(3, true);
    OWNED struct room *first = malloc(sizeof *first);
    fill(room);
    for (int threads = 1; threads <= 3; threads += 2) {
        make_bed(room, threads, false);
        solve(room);
        if (threads == 1) memcpy(first, room, sizeof *first);
    }
    ck_assert_int_eq(memcmp(room->flux, first->flux, sizeof room->flux), 0);
    ck_assert_int_eq(memcmp(room->side_found, first->side_found, sizeof room->side_found), 0);
    const uint32_t n = room->mesh->triangles.n, turn = 17;
    double *const values[] = {room->side_t, room->side_film, room->side_gas, room->side_power};
    uint32_t corner[108][3];
    memcpy(corner, room->mesh->corner, n * sizeof *corner);
    for (uint32_t t = 0; t < n; ++t) memcpy(room->mesh->corner[t], corner[(t + turn) % n], sizeof *corner);
    for (int k = 0; k < 4; ++k) {
        double old[216];
        memcpy(old, values[k], 2 * n * sizeof *old);
        for (uint32_t t = 0; t < n; ++t) values[k][2 * t] = old[2 * ((t + turn) % n)];
    }
    make_bed(room, 1, false);
    solve(room);
    for (uint32_t t = 0; t < n; ++t) /* each side has the noise of its own rays */
        ck_assert_double_eq_tol(room->side_found[2 * t], first->side_found[2 * ((t + turn) % n)], 1.5);
    ck_assert_double_lt(fabs(room->wall_found[0] - first->wall_found[0]), 2 * room->wall_t_error[0]);
    ck_assert_double_lt(fabs(room->wall_q[0] - first->wall_q[0]), 2 * room->wall_error[0]);
}

/* A sphere in the middle of a black cube, whose sides all see the same: two surfaces. */
LOOP_TEST(a_sphere_in_a_cube, 4) {
    OWNED_ROOM *room = room_new(1, true);
    const double area = 4 * M_PI * .16, film = _i == 1 ? 0 : 12, power = _i == 2 ? 0 : 500;
    double t = 500;
    room->n = 1, room->r[0] = .4, room->e[0] = .7, room->t[0] = _i == 3 ? NAN : 900,
    room->power[0] = _i == 3 ? 400 : NAN;
    room->wall_e[0] = 1;
    for (int k = 0; k < 3; ++k) room->at[0][k] = .5;
    for (uint32_t s = 0; s < room->mesh->triangles.n; ++s)
        room->side_film[2 * s] = film, room->side_gas[2 * s] = 350, room->side_power[2 * s] = _i == 2 ? NAN : power;
    make_bed(room, 1, false);
    solve(room);
    for (int step = 0; step < 50 && film > 0; ++step) { /* a black cube: eps A of the sphere counts */
        const double gained = _i == 3 ? 400 : .7 * area * SIGMA * (fourth(900) - fourth(t));
        t += (gained + 6 * (film * (350 - t) + power)) / ((_i == 3 ? 0 : 2.8 * area * SIGMA * t * t * t) + 6 * film);
    }
    if (film == 0) t = pow(fourth(900) + 6 * power / (.7 * area * SIGMA), .25);
    const double due = -6 * (film * (350 - t) + power);
    ck_assert_double_lt(fabs(room->wall_found[0] - t), 2 * room->wall_t_error[0] + 1e-4);
    ck_assert_double_lt(fabs(room->wall_q[0] - due), 2 * room->wall_error[0] + 1e-8);
}

/* What is refused, and what has no solution. */
TEST(sides_that_are_refused) {
    OWNED_ROOM *room = room_new(1, true);
    fibrad_fault fault;
    room->n = 1, room->r[0] = .2, room->t[0] = 900;
    for (int k = 0; k < 3; ++k) room->at[0][k] = .5;
    for (int s = 0; s < 12; ++s) room->side_film[2 * s] = 5, room->side_gas[2 * s] = 400;
    room->side_film[1] = -1; /* belongs to no wall */
    make_bed(room, 1, false);
    solve(room);
    double *const field[] = {room->side_film,  room->side_film, room->side_film, room->side_gas, room->side_gas,
                             room->side_power, room->side_t,    room->wall_t,    room->wall_e};
    const double wrong[] = {-1, NAN, INFINITY, NAN, -1, INFINITY, 500, NAN, 0};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
        double *const at = field[k] + (k < 7 ? 6 : 0), kept = *at;
        *at = wrong[k];
        assert_invalid(fibrad_bed_solve(room->bed, &room->sources, NULL, &room->result));
        fibrad_bed_describe(room->bed, NULL, &fault);
        ck_assert_int_eq(fault.why, k == 7 ? FIBRAD_WHY_NEITHER : FIBRAD_WHY_SIDE);
        ck_assert_uint_eq(fault.wall, 1);
        *at = kept;
    }
    room->sources.side_gas = NULL;
    assert_invalid(fibrad_bed_solve(room->bed, &room->sources, NULL, &room->result));
    room->sources.side_gas = room->side_gas;
    room->sources.insulated = (const unsigned char[]){1};
    assert_invalid(fibrad_bed_solve(room->bed, &room->sources, NULL, &room->result));
    room->sources.insulated = NULL;
    const uint32_t first[] = {0}, second[] = {1};
    const double conductance[] = {1};
    room->sources.contacts = 1, room->sources.contact_first = first, room->sources.contact_second = second;
    room->sources.conductance = conductance;
    assert_invalid(fibrad_bed_solve(room->bed, &room->sources, NULL, &room->result));
    fibrad_bed_describe(room->bed, NULL, &fault);
    ck_assert_int_eq(fault.why, FIBRAD_WHY_TOUCHED);
    /* so a contact needs a temperature of its own, at a wall */
    double place = 700, flow;
    room->sources.contact_temperature = &place, room->result.contact_flow = &flow;
    solve(room);
    assert_near(flow, room->found[0] - place, 1e-12);
    for (int k = 0; k < 2; ++k) {
        if (k == 0)
            place = -1;
        else
            place = 700, room->sources.contact_second = first;
        assert_invalid(fibrad_bed_solve(room->bed, &room->sources, NULL, &room->result));
        fibrad_bed_describe(room->bed, NULL, &fault);
        ck_assert_int_eq(fault.why, k == 0 ? FIBRAD_WHY_TEMPERATURE : FIBRAD_WHY_CONTACT);
    }
    room->sources.contact_temperature = NULL, room->result.contact_flow = NULL;
    room->sources.contacts = 0;
    solve(room);
    /* a side would need a temperature below 0 */
    room->side_film[8] = 0, room->side_power[8] = -4e4;
    ck_assert_int_eq(fibrad_bed_solve(room->bed, &room->sources, NULL, &room->result), FIBRAD_E_UNSOLVABLE);
    assert_ok(fibrad_bed_sides(room->bed, room->flux, room->side_found));
    ck_assert(isnan(room->side_found[8]) && room->side_found[0] > 0);
    ck_assert_double_lt(fabs(room->flux[8] - 4e4), 1e-3);
    ck_assert_double_lt(fabs(sum_of_powers(room)), 1e-7);
    room->side_film[8] = 5, room->side_power[8] = NAN;
    solve(room);
    /* nothing gives the level of temperatures */
    room->t[0] = NAN, room->power[0] = 12;
    for (int s = 0; s < 12; ++s) room->side_film[2 * s] = 0, room->side_power[2 * s] = -2;
    ck_assert_int_eq(fibrad_bed_solve(room->bed, &room->sources, NULL, &room->result), FIBRAD_E_UNSOLVABLE);
    room->side_power[0] = NAN;
    solve(room);
}

/* ---- in time ---- */

/* A grey sphere of one temperature in a black cube, behind whose films the temperature rises. */
struct lump {
    double area, film, begun, rise, capacity, power;
};

static double side_at(const struct lump *l, double t, double time) {
    double side = t;
    for (int step = 0; step < 30; ++step) {
        const double gained = .7 * l->area * SIGMA * (fourth(t) - fourth(side));
        side += (gained + 6 * l->film * (l->begun + l->rise * time - side)) /
                (2.8 * l->area * SIGMA * side * side * side + 6 * l->film);
    }
    return side;
}

static int slope_of(double time, const double *t, double *slope, void *lump) {
    const struct lump *l = lump;
    *slope = (l->power - .7 * l->area * SIGMA * (fourth(*t) - fourth(side_at(l, *t, time)))) / l->capacity;
    return GSL_SUCCESS;
}

/* In one span and in two. Sides have what their wall has gained, and this closes the balance. */
TEST(a_sphere_in_time) {
    OWNED_ROOM *room = room_new(1, true);
    struct lump l = {4 * M_PI * .16, 12, 400, 5, 8000, 50};
    const double seconds = 40;
    double t[1] = {900}, other[1] = {900}, gas[24], energy[24], found[24], wall_energy[1], parts = 0, exact = 900;
    room->n = 1, room->r[0] = .4, room->e[0] = .7, room->wall_e[0] = 1, room->power[0] = l.power;
    for (int k = 0; k < 3; ++k) room->at[0][k] = .5;
    for (int s = 0; s < 24; ++s) room->side_film[s] = l.film, room->side_gas[s] = l.begun;
    for (int s = 0; s < 24; ++s) gas[s] = l.begun + l.rise * seconds;
    make_bed(room, 1, false);
    fibrad_span span = {.temperature = t,
                        .capacity = &l.capacity,
                        .duration = seconds,
                        .step = 2,
                        .side_gas = gas,
                        .side_energy = energy,
                        .side_end = found,
                        .wall_energy = wall_energy};
    assert_ok(fibrad_bed_advance(room->bed, &room->sources, &span));
    gsl_odeiv2_system system = {slope_of, NULL, 1, &l};
    gsl_odeiv2_driver *driver = gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk8pd, .1, 1e-12, 1e-12);
    double time = 0;
    ck_assert_int_eq(gsl_odeiv2_driver_apply(driver, &time, seconds, &exact), GSL_SUCCESS);
    gsl_odeiv2_driver_free(driver);
    ck_assert_double_eq_tol(t[0], exact, 5e-3);
    double sum = 0;
    for (int s = 0; s < 24; s += 2) {
        sum += energy[s];
        ck_assert_double_eq_tol(found[s], side_at(&l, exact, seconds), .5); /* each has the noise of its rays */
        ck_assert(isnan(energy[s + 1]) && isnan(found[s + 1]));
    }
    assert_near(sum, wall_energy[0], 1e-12);
    ck_assert_double_lt(fabs(sum + l.capacity * (t[0] - 900) - l.power * seconds), 1e-12 * sum);
    span.temperature = other, span.duration = seconds / 2;
    for (int half = 0; half < 2; ++half) {
        for (int s = 0; s < 24; ++s)
            room->side_gas[s] = l.begun + l.rise * seconds * half / 2,
            gas[s] = l.begun + l.rise * seconds * (half + 1) / 2;
        assert_ok(fibrad_bed_advance(room->bed, &room->sources, &span));
        for (int s = 0; s < 24; s += 2) parts += energy[s];
    }
    ck_assert_double_eq_tol(other[0], t[0], 1e-3);
    assert_near(parts, sum, 1e-4);
}

/* Films of spheres, a clump, sides of all kinds whose temperatures vary, a law, and a bed that moves: energies add up,
 * and spheres have from the gas what the gas loses. */
static void brighter_if_hot(void *context, const double *t, const double *wall_t, double *e, double *wall_e) {
    (void)context, (void)wall_t, (void)wall_e;
    for (int i = 0; i < SPHERES; ++i)
        if (!isnan(t[i])) e[i] = .3 + 4e-4 * t[i];
}

LOOP_TEST(energies_of_a_span, 2) {
    OWNED_ROOM *room = room_new(2, _i == 1);
    const uint32_t n = room->mesh->triangles.n;
    double t[SPHERES] = {500, 500, 800, 900}, capacity[SPHERES] = {20, 30, 25, 15}, convected[SPHERES];
    double end[96], gas[96], energy[96], found[96], wall_energy[6];
    struct extra extra;
    fill(room);
    add_extra(room, FILM, &extra);
    room->clump[0] = room->clump[1] = 7, room->at[1][0] = .5, room->sources.tolerance = 0;
    for (uint32_t s = 0; s < 2 * n; ++s) end[s] = room->side_t[s] + 50, gas[s] = room->side_gas[s] + 100;
    fibrad_law law = {brighter_if_hot, NULL, NULL, NULL};
    fibrad_span span = {.temperature = t,
                        .capacity = capacity,
                        .duration = 20,
                        .step = 4,
                        .side_temperature = end,
                        .side_gas = gas,
                        .side_energy = energy,
                        .side_end = found,
                        .wall_energy = wall_energy,
                        .convected_energy = convected,

                        .law = _i == 1 ? &law : NULL};
    for (int move = 0; move < 2; ++move) {
        const double before[SPHERES] = {t[0], t[1], t[2], t[3]};
        if (move == 0) make_bed(room, 1, true);
        room->at[3][1] -= .01 * move;
        const fibrad_spheres spheres = {&room->at[0][0], &room->at[0][1], &room->at[0][2],     room->r,
                                        room->n,         .stride = 3,     .clump = room->clump};
        assert_ok(fibrad_bed_move(room->bed, &room->config, &spheres));
        assert_ok(fibrad_bed_advance(room->bed, &room->sources, &span));
        double of_walls[6] = {0}, sum = span.surroundings_energy + span.gas_energy, gained = 0;
        for (int i = 0; i < SPHERES; ++i) {
            sum += capacity[i] * (t[i] - before[i]) - room->power[i] * span.duration;
            gained += convected[i];
        }
        for (uint32_t s = 0; s < 2 * n; s += 2) {
            of_walls[room->mesh->front[s / 2]] += energy[s];
            if (!isnan(room->side_t[s])) ck_assert_double_eq_tol(found[s], end[s], 1e-9);
            ck_assert_double_gt(found[s], 200);
        }
        for (uint32_t b = 0; b < room->config.walls; ++b) {
            sum += wall_energy[b];
            ck_assert_double_lt(fabs(of_walls[b] - wall_energy[b]), 1e-9);
        }
        ck_assert_double_lt(fabs(sum), 1e-8);
        ck_assert_double_lt(fabs(gained + span.gas_energy), 1e-9);
    }
}
