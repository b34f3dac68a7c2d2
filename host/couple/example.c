/* example.c - radiation in your own code over MPI: a bed between a hot and a cold wall. Run it by mpirun -np 2.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>

#include "couple/fibrad_couple.h"

enum { SIDE = 12, ALL = SIDE * SIDE * SIDE, STEPS = 50 };

static uint64_t id[ALL]; /* particles that this rank owns */
static double x[ALL][3], radius[ALL], emissivity[ALL], temperature[ALL], power[ALL];

/* Makes layers k, k + step, ... of the lattice: particles of radius 1 mm, a little off the sites. Returns their number.
 */
static size_t make_particles(int k, int step) {
    size_t n = 0;
    for (; k < SIDE; k += step)
        for (int i = 0; i < SIDE * SIDE; ++i, ++n) {
            const int place[3] = {i % SIDE, i / SIDE, k};
            id[n] = (uint64_t)(k * SIDE * SIDE + i) + 1;
            for (int a = 0; a < 3; ++a) x[n][a] = 2e-3 * (place[a] + 0.5 + 0.05 * sin((double)id[n] * (a + 1)));
            radius[n] = 1e-3, emissivity[n] = 0.8, temperature[n] = 300;
        }
    return n;
}

int main(int argc, char **argv) {
    const double high = 2e-3 * SIDE, wall_emissivity[] = {0.9, 0.9}, wall_temperature[] = {1000, 300};
    const fibrad_wall wall[] = {{.kind = FIBRAD_WALL_PLANE, .plane = {.axis = 2, .upper = 0, .at = 0}},
                                {.kind = FIBRAD_WALL_PLANE, .plane = {.axis = 2, .upper = 1, .at = high}}};
    const double dt = 0.5, capacity = 4.19e-9 * 7800 * 500; /* [s], [J/K] of one particle */
    double stored = 0, from_walls = 0;
    int rank, ranks, status;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    const size_t n = make_particles(rank, ranks);
    fibrad_insitu_bed bed = {.high = {high, high, high}, .periodic = {1, 1, 0}, .wall = wall, .walls = 2};
    bed.wall_emissivity = wall_emissivity;
    bed.n = n, bed.id = id, bed.x = x[0], bed.radius = radius, bed.emissivity = emissivity;
    const fibrad_insitu_state state = {
        .wall_temperature = wall_temperature, .n = n, .id = id, .temperature = temperature};
    fibrad_insitu *radiation;
    fibrad_insitu_totals totals;
    status = fibrad_insitu_new(&radiation, MPI_COMM_WORLD, NULL);
    for (uint64_t step = 0; step < STEPS && !status; ++step) {
        if (step % 25 == 0)
            status = fibrad_insitu_rows(radiation, &bed, step); /* in a real code the particles have moved */
        if (!status) status = fibrad_insitu_powers(radiation, &state, power, &totals);
        for (size_t i = 0; i < n && !status; ++i) temperature[i] += power[i] * dt / capacity;
        stored += totals.particles * dt, from_walls -= (totals.wall[0] + totals.wall[1]) * dt;
    }
    if (status && rank == 0) fprintf(stderr, "%s\n", fibrad_insitu_message(radiation));
    if (!status && rank == 0) printf("%.9g J stored, %.9g J from the walls\n", stored, from_walls);
    fibrad_insitu_free(radiation);
    MPI_Finalize();
    return status != 0;
}
