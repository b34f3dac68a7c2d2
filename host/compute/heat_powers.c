/* heat_powers.c - net radiative powers of a whole bed, by OpenMP. SPDX-License-Identifier: MIT
 *
 * The parts of a sweep are always as many, so that the powers do not depend on the threads. */
#include "compute/heat_powers.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>

#include "cli/interrupt.h"
#include "cli/message.h"
#include "cli/progress.h"
#include "compute/rows.h"

enum { PARTS = 16 };

struct tracing {
    fibrad_heat *heat;
    fibrad_work *work;
    void *block; /* of the work */
};

/* Follows the beams of a task; work memory that turns out too small is made larger. */
static int trace(struct tracing *tracing, uint32_t task) {
    if (!tracing->block && !run_work(&tracing->work, &tracing->block, NULL)) return STATUS_MEMORY;
    for (;;) {
        const int status = fibrad_heat_trace(tracing->heat, tracing->work, task);
        if (status == FIBRAD_OK) return STATUS_OK;
        if (status != FIBRAD_E_CAPACITY) return message(STATUS_INPUT, "beams: %s", fibrad_status_text(status));
        fibrad_work_config config;
        fibrad_work_needed(tracing->work, &config);
        if (!run_work(&tracing->work, &tracing->block, &config)) return STATUS_MEMORY;
    }
}

static int trace_all(fibrad_heat *heat, const struct heat_options *options, int threads) {
    const uint32_t tasks = fibrad_heat_tasks(heat);
    struct progress progress;
    uint64_t done = 0;
    int stop = STATUS_OK;
    progress_begin(&progress, options->progress, "beams of spheres and walls", tasks);
#pragma omp parallel num_threads(threads)
    {
        struct tracing tracing = {.heat = heat};
#pragma omp for schedule(dynamic, 16)
        for (uint32_t task = 0; task < tasks; ++task) {
            int stopped;
#pragma omp atomic read
            stopped = stop;
            if (stopped) continue;
            int status = interrupt_status();
            if (!status) status = trace(&tracing, task);
            uint64_t count;
#pragma omp atomic capture
            count = ++done;
            if (omp_get_thread_num() == 0) progress_show(&progress, count);
            if (status) {
#pragma omp atomic write
                stop = status;
            }
        }
        free(tracing.block);
    }
    progress_end(&progress, done);
    return stop == STATUS_MEMORY ? message_memory() : stop;
}

static int solve(fibrad_heat *heat, const struct heat_options *options, struct heat_report *report) {
    const int failed = fibrad_heat_begin(heat, &options->sources);
    if (failed) return message(STATUS_INPUT, "temperatures and emissivities: %s", fibrad_status_text(failed));
    do {
        if (interrupt_status()) return interrupt_status();
#pragma omp parallel for schedule(dynamic, 1) num_threads(report->threads)
        for (uint32_t part = 0; part < PARTS; ++part) fibrad_heat_sweep(heat, part);
    } while (fibrad_heat_step(heat));
    fibrad_heat_read(heat, &report->heat);
    return STATUS_OK;
}

static void summarise(const struct bed *bed, struct heat_report *report) {
    const fibrad_heat_result *heat = &report->heat;
    double square = 0, sum = heat->surroundings_power;
    report->largest = fabs(sum);
    for (int wall = 0; wall < FIBRAD_WALLS; ++wall) {
        sum += heat->wall_power[wall];
        report->largest = fmax(report->largest, fabs(heat->wall_power[wall]));
    }
    for (uint32_t i = 0; i < bed->n; ++i) {
        sum += heat->power[i];
        square += heat->power[i] * heat->power[i];
        report->largest = fmax(report->largest, fabs(heat->power[i]));
    }
    report->mean_square = sqrt(square / bed->n);
    report->balance = report->largest > 0 ? sum / report->largest : 0;
    const double error = hypot(heat->error_patches, heat->error_beams);
    report->error_estimate = report->mean_square > 0 ? error / report->mean_square : 0;
}

static int run_once(const struct bed *bed, const fibrad_scene *scene, const struct heat_options *options,
                    struct heat_report *report) {
    fibrad_heat *heat;
    const size_t size = fibrad_heat_size(&report->config, scene);
    void *block = size ? run_block(size) : NULL;
    if (!block) return message_memory();
    fibrad_heat_init(&heat, block, size, &report->config, scene);
    int status = trace_all(heat, options, report->threads);
    if (!status) status = solve(heat, options, report);
    free(block);
    if (!status) summarise(bed, report);
    return status;
}

/* More of what makes the larger part of the error. False: there is no more. */
static bool refine(struct heat_report *report) {
    fibrad_heat_config *config = &report->config;
    const bool beams = report->heat.error_beams > report->heat.error_patches;
    if ((beams || config->patches == 384) && config->directions <= FIBRAD_DIRECTIONS_MAX / 4)
        config->directions *= 2;
    else if (config->patches < 384)
        config->patches *= 4;
    else
        return false;
    return true;
}

int run_heat(const struct bed *bed, const struct heat_options *options, struct heat_report *report) {
    *report = (struct heat_report){.config = options->config,
                                   .threads = options->threads ? options->threads : omp_get_max_threads()};
    report->config.parts = PARTS;
    const double begun = progress_clock();
    fibrad_scene *scene = NULL;
    void *block = NULL;
    report->heat.power = malloc(bed->n * sizeof *report->heat.power);
    int status = report->heat.power ? STATUS_OK : message_memory();
    if (!status) status = run_scene(bed, &options->walls, options->file, &scene, &block);
    if (!status) fibrad_scene_describe(scene, &report->facts);
    if (!status) status = run_once(bed, scene, options, report);
    while (!status && options->error > 0 && report->error_estimate > options->error && refine(report))
        status = run_once(bed, scene, options, report);
    free(block);
    report->seconds = progress_clock() - begun;
    return status;
}

void heat_report_free(struct heat_report *report) {
    free(report->heat.power);
    report->heat.power = NULL;
}
