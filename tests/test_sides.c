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


TEST(explore_time) {
    for (int c = 0; c < 3; ++c) {
    OWNED_ROOM *room = room_new(2, c == 1);
    const uint32_t n = room->mesh->triangles.n;
    room->n = 2, room->r[0] = .2, room->r[1] = .15;
    for (int k = 0; k < 3; ++k) room->at[0][k] = .35, room->at[1][k] = .7;
    double end[SIDES], gas[SIDES], energy[SIDES], found[SIDES], t[2] = {500, 900}, capacity[2] = {30, 20}, walls[6], convected[2], area[2];
    for (uint32_t k = 0; k < n; ++k) {
        if (c < 2 || k % 3) room->side_film[2 * k] = 15; 
        else room->side_power[2 * k] = 100;
        room->side_gas[2 * k] = 400, gas[2 * k] = 600 + k;
        end[2 * k] = NAN;
        end[2*k+1] = NAN, gas[2*k+1]=NAN, room->side_gas[2*k+1]=NAN;
    }
    for (int i = 0; i < 2; ++i) room->film[i] = 10 * 4 * M_PI * room->r[i] * room->r[i], room->gas[i] = 450, room->power[i] = 10;
    room->sources.film = room->film, room->sources.gas = room->gas;
    room->sources.tolerance = 0;
    make_bed(room, 1, false);
    fibrad_span span={.temperature = t, .capacity = capacity, .duration = 10, .step = 1, .side_temperature = end, .side_gas = gas, .side_energy = energy, .side_end = found, .wall_energy = walls, .convected_energy = convected};
    (void)area;
    if (getenv("PLAIN")) {room->sources.side_film=room->sources.side_power=span.side_gas=span.side_temperature=NULL; for(int b=0;b<6;b++)room->wall_t[b]=500+20*b;}
    assert_ok(fibrad_bed_advance(room->bed, &room->sources, &span));
    double sum = 0, of_walls = 0;
    for (uint32_t k = 0; k < n; ++k) sum += energy[2 * k];
    for (uint32_t b = 0; b < room->config.walls; ++b) of_walls += walls[b];
    printf("T %g %g sides %.15g walls %.15g balance %g convected %.15g %.15g sweeps %lu steps %lu end %g %g\n", t[0], t[1], sum, of_walls, of_walls + span.surroundings_energy + span.gas_energy + 30 * (t[0] - 500) + 20 * (t[1] - 900) - 200, convected[0] + convected[1], -span.gas_energy, span.sweeps, span.steps, found[0], found[22]);
    }
}
