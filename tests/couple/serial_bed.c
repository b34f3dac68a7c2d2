/* serial_bed.c - a frozen bed above a hot floor, on one scene of the kernel: what simulators over ranks must agree
 * with.
 *
 * serial_bed STEPS NROWS DT [CAPACITY] < BED > TEMPERATURES. Lines of BED are `id x y z r T`, of TEMPERATURES
 * `id T`. With a heat capacity [J/K] the temperature of the floor follows what it gets. The last line is `floor T`.
 * Emissivity 0.5 for odd ids and 0.8 for even ones, floor z = 0 of 1000 K and emissivity 0.9, surroundings 300 K,
 * density 2500, 800 J/(kg K); a step of heat of DT seconds in each of STEPS, new rows at multiples of NROWS.
 *
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "fibrad.h"

enum { MOST = 4096 };
static double x[MOST], y[MOST], z[MOST], r[MOST], t[MOST], emissivity[MOST], weight[MOST], emission[MOST], power[MOST];
static uint64_t id[MOST];

static void *grow(void *context, void *block, size_t size) {
    (void)context;
    return realloc(block, size);
}

static void stop_unless(int status) {
    if (status == FIBRAD_OK) return;
    fprintf(stderr, "serial_bed: %s\n", fibrad_status_text(status));
    exit(1);
}

int main(int count, char **argument) {
    if (count != 4 && count != 5) return 2;
    const long steps = atol(argument[1]), every = atol(argument[2]);
    const double dt = atof(argument[3]), pi = 4 * atan(1), sigma = FIBRAD_STEFAN_BOLTZMANN;
    const double floor_emissivity = 0.9, capacity = count == 5 ? atof(argument[4]) : HUGE_VAL;
    double floor_t = 1000;

    uint32_t n = 0;
    unsigned long long number;
    while (n < MOST && scanf("%llu %lf %lf %lf %lf %lf", &number, &x[n], &y[n], &z[n], &r[n], &t[n]) == 6) {
        emissivity[n] = number % 2 ? 0.5 : 0.8;
        weight[n] = 4 * pi * r[n] * r[n] * emissivity[n];
        id[n++] = number;
    }

    const fibrad_wall wall = {.kind = FIBRAD_WALL_PLANE, .plane = {.axis = 2}};
    const fibrad_scene_config config = {.wall = &wall, .walls = 1};
    const fibrad_spheres spheres = {.x = x, .y = y, .z = z, .r = r, .n = n, .id = id};
    const size_t size = fibrad_scene_size(n, 1);
    void *memory = malloc(size);
    fibrad_scene *scene;
    stop_unless(fibrad_scene_init(&scene, memory, size, &config, &spheres, NULL));
    fibrad_work work = {.memory = {.resize = grow}};
    fibrad_rows rows = {.memory = {.resize = grow}};

    for (long step = 0; step <= steps; step++) {
        if (step % every == 0) {
            fibrad_exchange_rule rule = {/* defaults of fibrad_insitu_config */
                                         .emissivity = emissivity,
                                         .wall_emissivity = &floor_emissivity,
                                         .directions = 30,
                                         .paths = 80};
            fibrad_rows_clear(&rows);
            for (uint32_t i = 0; i < n; i++) {
                double to_floor;
                rule.seed = 1 + (uint64_t)step * 0x9e3779b97f4a7c15u + id[i] * 0xd1342543de82ef95u;
                fibrad_row row = {.wall = &to_floor, .rows = &rows};
                stop_unless(fibrad_exchange_row(scene, &work, i, &rule, &row, NULL));
            }
        }
        if (step == 0) continue;
        for (uint32_t i = 0; i < n; i++) {
            emission[i] = sigma * t[i] * t[i] * t[i] * t[i];
            power[i] = 0;
        }
        const double floor_emission = sigma * pow(floor_t, 4);
        double floor_power = 0;
        fibrad_flow flow = {.weight = weight, .emission = emission, .wall_emission = &floor_emission};
        flow.surroundings_emission = sigma * pow(300, 4), flow.power = power, flow.wall_power = &floor_power;
        stop_unless(fibrad_rows_flow(&rows, n, 1, &flow));
        for (uint32_t i = 0; i < n; i++) t[i] += power[i] * dt / (2500 * 4 * pi / 3 * r[i] * r[i] * r[i] * 800);
        floor_t += floor_power * dt / capacity;
    }
    for (uint32_t i = 0; i < n; i++) printf("%llu %.17g\n", (unsigned long long)id[i], t[i]);
    printf("floor %.17g\n", floor_t);
    free(memory);
    free(work.memory.block);
    free(rows.memory.block);
    return 0;
}
