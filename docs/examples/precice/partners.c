/* partners.c - two solvers beside the bed: a wall that conducts, and gas in plug flow. SPDX-License-Identifier: MIT
 *
 *     cc partners.c -lprecice -lm -o partners
 *     ./partners Wall temperatures.xml & ./partners Gas temperatures.xml &    the wall gives temperatures, or
 *     ./partners Wall films.xml films & ./partners Gas films.xml films &      films, and the gas reads conductances
 *
 * Each process is a participant of preCICE with one mesh. A solver of your own calls the same functions. */
#include <math.h>
#include <precice/preciceC.h>
#include <stdio.h>
#include <string.h>

enum { ROUND = 16, ALONG = 10, LAYERS = 8, SLICES = 16 };
#define PI     3.14159265358979323846
#define RADIUS .055  /* [m] of the tube */
#define HEIGHT .165  /* [m] */
#define COLD   300.0 /* [K] outside, at the inlet, and at the beginning */

/* A solver: its vertices, the data that it reads and writes there, its state, and how a time window changes them. */
struct solver {
    const char *mesh, *reads[3], *writes[3];
    int n;
    double at[ROUND * ALONG][3], read[3][ROUND * ALONG], value[3][ROUND * ALONG];
    double state[ROUND * ALONG][LAYERS], received, lost, stored;
    void (*advance)(struct solver *s, double dt, double *lost);
};

/* Conduction through the tube in one dimension at each vertex, by implicit Euler. Its inner side gains `power`. At the
 * end of the time window this side has the temperature T = sink + power/(h area). The wall gives T. It also gives h and
 * sink, with which the bed can find T itself. */
static void advance_wall(struct solver *s, double dt, double *lost) {
    const double thick = .005, k = 1.5, heat = 2e6, film = 20, dx = thick / LAYERS, between = k / dx;
    const double outside = 1 / (dx / 2 / k + 1 / film), keeps = heat * dx / dt;
    const double area = 2 * PI * RADIUS * HEIGHT / s->n;
    for (int v = 0; v < s->n; v++) {
        double c[LAYERS], d[LAYERS], unit[LAYERS]; /* Thomas' algorithm; unit: the answer to 1 W/m2 at the inner side */
        for (int i = 0; i < LAYERS; i++) {
            const double in = i > 0 ? between : 0, out = i < LAYERS - 1 ? between : outside;
            const double given = keeps * s->state[v][i] + (i == LAYERS - 1 ? outside * COLD : 0);
            const double left = keeps + in + out - (i > 0 ? in * c[i - 1] : 0);
            c[i] = out / left;
            d[i] = (given + (i > 0 ? in * d[i - 1] : 0)) / left;
            unit[i] = ((i == 0) + (i > 0 ? in * unit[i - 1] : 0)) / left;
        }
        for (int i = LAYERS - 2; i >= 0; i--) d[i] += c[i] * d[i + 1], unit[i] += c[i] * unit[i + 1];
        for (int i = 0; i < LAYERS; i++) s->state[v][i] = d[i] + s->read[0][v] / area * unit[i];
        const double response = unit[0] + dx / 2 / k;
        s->value[0][v] = d[0] + s->read[0][v] / area * response, s->value[1][v] = d[0], s->value[2][v] = 1 / response;
        *lost += area * outside * (s->state[v][LAYERS - 1] - COLD) * dt;
    }
    s->stored = 0;
    for (int v = 0; v < s->n; v++)
        for (int i = 0; i < LAYERS; i++) s->stored += heat * dx * area * (s->state[v][i] - COLD);
}

/* Gas flows upwards through slices, one vertex each. At its temperature T it gains source - conductance T, if it reads
 * conductances, and else `power`. With conductances T is near the final one at once. */
static void advance_gas(struct solver *s, double dt, double *lost) {
    const double flow = 1.5, *power = s->read[0], *conductance = s->read[1], *source = s->read[2]; /* flow [W/K] */
    double up = COLD;
    for (int v = 0; v < s->n; v++) {
        const double gained = conductance[v] > 0 ? source[v] : power[v];
        const double t = (2 * flow * up + gained) / (2 * flow + conductance[v]);
        s->value[0][v] = t, up = 2 * t - up;
    }
    *lost += flow * (up - COLD) * dt;
}

int main(int argc, char **argv) {
    static struct solver wall = {
        .mesh = "Wall-Mesh",
        .reads = {"Power"},
        .writes = {"Temperature", "Sink-Temperature", "Heat-Transfer-Coefficient"},
        .n = ROUND * ALONG,
        .advance = advance_wall,
    };
    static struct solver gas = {.mesh = "Gas-Mesh",
                                .reads = {"Gas-Power", "Gas-Conductance", "Gas-Source"},
                                .writes = {"Gas-Temperature"},
                                .n = SLICES,
                                .advance = advance_gas};
    static int id[ROUND * ALONG];
    static double kept[ROUND * ALONG][LAYERS];
    if (argc != 3 && argc != 4) return 1;
    struct solver *s = strcmp(argv[1], "Gas") == 0 ? &gas : &wall;
    const int films = argc == 4, first = films && s == &wall, last = first ? 3 : 1; /* of `writes`: which are written */
    for (int v = 0; v < s->n; v++) {
        const double angle = 2 * PI * (v % ROUND + .5) / ROUND, r = s == &gas ? 0 : RADIUS;
        s->at[v][0] = r * cos(angle), s->at[v][1] = r * sin(angle);
        s->at[v][2] = s == &gas ? HEIGHT * (v + .5) / SLICES : HEIGHT * (v / ROUND + .5) / ALONG;
        for (int i = 0; i < LAYERS; i++) s->state[v][i] = COLD;
        s->value[0][v] = s->value[1][v] = COLD, s->value[2][v] = 1;
    }
    precicec_createParticipant(argv[1], argv[2], 0, 1);
    precicec_setMeshVertices(s->mesh, s->n, s->at[0], id);
    if (precicec_requiresInitialData())
        for (int k = first; k < last; k++) precicec_writeData(s->mesh, s->writes[k], s->n, id, s->value[k]);
    precicec_initialize();
    while (precicec_isCouplingOngoing()) {
        if (precicec_requiresWritingCheckpoint()) memcpy(kept, s->state, sizeof kept);
        const double dt = precicec_getMaxTimeStepSize();
        double received = 0, lost = 0;
        for (int k = 0; k < (films && s == &gas ? 3 : 1); k++)
            precicec_readData(s->mesh, s->reads[k], s->n, id, dt, s->read[k]);
        s->advance(s, dt, &lost);
        for (int v = 0; v < s->n; v++) received += s->read[0][v] * dt;
        for (int k = first; k < last; k++) precicec_writeData(s->mesh, s->writes[k], s->n, id, s->value[k]);
        precicec_advance(dt);
        if (precicec_requiresReadingCheckpoint())
            memcpy(s->state, kept, sizeof kept);
        else
            s->received += received, s->lost += lost;
    }
    printf("%s: received %.6f J, lost %.6f J, stored %.6f J\n", argv[1], s->received, s->lost, s->stored);
    precicec_finalize();
    return 0;
}
