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

TEST(explore) {
    for (int c = 0; c < 12; ++c) {
        OWNED_ROOM *room = room_new(c % 2 ? 12 : 2, c % 4 >= 2);
        const uint32_t n = room->mesh->triangles.n;
        room->n = 1, room->at[0][0] = room->at[0][1] = .5, room->at[0][2] = .4, room->r[0] = .2, room->t[0] = c < 4 ? 900 : NAN;
        room->power[0] = c < 4 ? NAN : 30;
        for (uint32_t t = 0; t < n; ++t) {
            room->side_film[2 * t] = t % 3 ? 20. : 0, room->side_gas[2 * t] = 300 + t * 500. / n;
            room->side_power[2*t] = t % 5 == 1 ? 400 : NAN;
            if (c >= 8) room->side_film[2 * t] = 0, room->side_power[2 * t] = t % 7 ? 100 : NAN;
            if (room->side_film[2 * t] == 0 && isnan(room->side_power[2 * t])) room->side_t[2 * t] = 350;
        }
        room->config.wall = room->mesh->wall;
        make_bed(room, 1, false);
        for (int k = 0; k < 5; ++k) {
        room->sources.tolerance = k == 0 ? 1e-3 : k == 1 ? 1e-5 : k == 2 ? 1e-9 : 1e-12;
        make_bed(room, 1, false);
        solve(room);
        if (k == 3) break;
        printf("tol %g sweeps %u; ", room->sources.tolerance, room->result.sweeps);
        }
        double worst = 0, sum = room->q[0] + room->result.surroundings_power, size = 0;
        for (int k = 0; k < 6; ++k) sum += room->wall_q[k], size += fabs(room->wall_q[k]);
        for (uint32_t t = 0; t < n; ++t) {
            const double p = isnan(room->side_power[2 * t]) ? 0 : room->side_power[2 * t];
            if (!isnan(room->side_t[2 * t])) continue;
            worst = fmax(worst, fabs(room->flux[2*t] + room->side_film[2*t] * (room->side_gas[2*t] - room->side_found[2*t]) + p));
        }
        printf("case %d sweeps %u balance %g sum %g of %g error %g %g T %g\n", c, room->result.sweeps, worst, sum, size,room->wall_error[0],room->wall_t_error[0], room->found[0]);
        /* temperatures found are given */
        double *flux = malloc(2 * n * sizeof *flux), wq = room->wall_q[0], q = room->q[0], wt = room->wall_found[0];
        memcpy(flux, room->flux, 2 * n * sizeof *flux);
        for (uint32_t t = 0; t < n; ++t) room->side_t[2 * t] = room->side_found[2 * t];
        room->sources.side_film = NULL, room->sources.side_power = NULL;
        make_bed(room, 1, false);
        solve(room);
        worst = 0;
        for (uint32_t t = 0; t < n; ++t) worst = fmax(worst, fabs(room->flux[2*t] - flux[2*t]));
        printf("   given: sweeps %u flux off %g wall power %g %g sphere %g %g T %g %g\n", room->result.sweeps, worst, wq, room->wall_q[0]-wq, q, room->q[0]-q, wt, room->wall_found[0]-wt);
        free(flux);
    }
}
