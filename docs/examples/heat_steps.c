/* heat_steps.c - net powers of a moving bed in each time step, by the kernel. Without OpenMP this is a serial program.
 * SPDX-License-Identifier: MIT
 *
 *     cc -fopenmp docs/examples/heat_steps.c -Ikernel build/libfibrad.a -lm -o heat_steps */
#include <stdio.h>
#include <stdlib.h>
#include "fibrad_heat.h"

enum { SIDE = 6, N = SIDE * SIDE * SIDE, STEPS = 10 };
static double at[N][3], r[N], temperature[N], emissivity[N], power[N];

static void *resize(void *context, void *block, size_t size) { return (void)context, realloc(block, size); }

/* Traces all beams of a scene. */
static int trace(fibrad_heat *heat) {
    int status = FIBRAD_OK;
#pragma omp parallel reduction(min : status)
    {
        fibrad_work work = {.memory.resize = resize};
#pragma omp for schedule(dynamic, 16)
        for (uint32_t task = 0; task < fibrad_heat_tasks(heat); task++) {
            const int done = fibrad_heat_trace(heat, &work, task);
            status = done < status ? done : status;
        }
        free(work.memory.block);
    }
    return status;
}

/* Sweeps until the solution is there. */
static int solve(fibrad_heat *heat, const fibrad_heat_sources *sources, fibrad_heat_result *result) {
    int status = fibrad_heat_begin(heat, sources), solved = 0;
    while (status == FIBRAD_OK && !solved) {
#pragma omp parallel for schedule(dynamic)
        for (uint32_t part = 0; part < fibrad_heat_parts(heat); part++)
            (void)fibrad_heat_sweep(heat, part); /* after an error here, fibrad_heat_step returns FIBRAD_E_STATE */
        status = fibrad_heat_step(heat, &solved);
    }
    return status == FIBRAD_OK ? fibrad_heat_read(heat, result) : status;
}

int main(void) {
    const fibrad_spheres spheres = {&at[0][0], &at[0][1], &at[0][2], r, N, .stride = 3};
    const double seconds = 1, heat_capacity = 5; /* of a step; of a sphere [J/K] */
    for (int i = 0; i < N; i++) {
        at[i][0] = 0.02 * (i % SIDE), at[i][1] = 0.02 * (i / SIDE % SIDE), at[i][2] = 0.02 * (i / SIDE / SIDE);
        r[i] = 0.009, emissivity[i] = 0.8, temperature[i] = i < N / 2 ? 1200 : 600;
    }

    const size_t scene_size = fibrad_scene_size(N, 0);
    void *scene_memory = malloc(scene_size), *heat_memory = NULL;
    fibrad_scene *scene;
    fibrad_heat *heat = NULL;
    fibrad_heat_result result = {.power = power};
    fibrad_heat_sources sources;
    fibrad_heat_sources_init(&sources);
    sources.temperature = temperature, sources.emissivity = emissivity, sources.surroundings = 300;
    int status = FIBRAD_OK;
    for (int step = 0; step < STEPS && status == FIBRAD_OK; step++) {
        status = fibrad_scene_init(&scene, scene_memory, scene_size, NULL, &spheres, NULL);
        if (status != FIBRAD_OK) break;
        if (heat == NULL) {
            const size_t heat_size = fibrad_heat_size(NULL, scene);
            heat_memory = malloc(heat_size);
            status = fibrad_heat_init(&heat, heat_memory, heat_size, NULL, scene);
        } else {
            status = fibrad_heat_move(heat, scene);
        }
        if (status == FIBRAD_OK) status = trace(heat);
        if (status == FIBRAD_OK) status = solve(heat, &sources, &result);
        for (int i = 0; i < N && status == FIBRAD_OK; i++) temperature[i] += seconds * power[i] / heat_capacity;
        for (int i = 0; i < N; i++) at[i][2] += i < N / 2 ? 0 : 1e-4; /* here your code moves the spheres */
    }
    if (status != FIBRAD_OK) fprintf(stderr, "%s\n", fibrad_status_text(status));
    printf("spheres 0 and %d after %d steps: %.2f K, %.2f K\n", N - 1, STEPS, temperature[0], temperature[N - 1]);
    free(heat_memory), free(scene_memory);
    return status != FIBRAD_OK;
}
