/* beams.c - beams between the patches of a bed, and solutions by them. SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>

#include "simple/bed.h"

enum { PARTS = 16, TASKS_AT_ONCE = 16 };

static int trace_beams(void *of_bed, int thread, uint32_t task) {
    fibrad_bed *bed = of_bed;
    return fibrad_heat_trace(bed->heat, &bed->team.work[thread], task);
}

/* Makes a heat problem in a block of `at_least` bytes or more. It begins with the last solution. */
static int make_heat(fibrad_bed *bed, size_t at_least) {
    fibrad_heat *heat;
    bed->beams.parts = PARTS;
    size_t size = fibrad_heat_size(&bed->beams, bed->scene);
    if (!size) return FIBRAD_E_ARGUMENT;
    if (size < at_least) size = at_least;
    void *block = malloc(size);
    if (!block) return FIBRAD_E_MEMORY;
    const int status = fibrad_heat_init(&heat, block, size, &bed->beams, bed->scene);
    if (status) {
        free(block);
        return status;
    }
    if (bed->heat) fibrad_heat_resume(heat, bed->heat);
    free(bed->heat_block);
    bed->heat = heat, bed->heat_block = block, bed->heat_size = size;
    bed->traced = false;
    return FIBRAD_OK;
}

/* FIBRAD_E_SIZE: spheres see more others than the block has room for; the block is doubled. */
int fibrad_bed_trace(fibrad_bed *bed) {
    if (bed->traced) return FIBRAD_OK;
    int status = bed->heat ? FIBRAD_OK : make_heat(bed, 0);
    while (!status) {
        const uint32_t tasks = fibrad_heat_tasks(bed->heat);
        status = fibrad_team_run(&bed->team, "beams", tasks, TASKS_AT_ONCE, trace_beams, bed, NULL);
        bed->fault.triangle = bed->team.triangle;
        bed->traced = !status;
        if (status != FIBRAD_E_SIZE) break;
        status = make_heat(bed, 2 * bed->heat_size);
    }
    return status;
}
static int sweep_beams(void *heat, int thread, uint32_t part) {
    (void)thread;
    return fibrad_heat_sweep(heat, part);
}

/* Makes room for contacts at their places, if spheres conduct. In steps in time contacts act on means of surfaces. */
static int make_places(fibrad_bed *bed, fibrad_heat_sources *sources) {
    free(bed->places);
    bed->places = NULL;
    if (sources->contacts == 0 || !sources->conductivity || sources->storage || sources->contact_places)
        return FIBRAD_OK;
    bed->places = malloc((5 * (size_t)sources->contacts + fibrad_heat_patches(bed->heat)) * sizeof *bed->places);
    sources->contact_places = bed->places;
    return bed->places ? FIBRAD_OK : FIBRAD_E_MEMORY;
}

int fibrad_bed_find(fibrad_bed *bed, const fibrad_heat_sources *given) {
    fibrad_heat_sources sources = *given;
    int solved = 0, status = fibrad_bed_trace(bed);
    if (!status) status = fibrad_heat_check(bed->heat, &sources, &bed->fault);
    if (!status) status = make_places(bed, &sources);
    if (!status) status = fibrad_heat_begin(bed->heat, &sources);
    for (uint64_t sweeps = 0; !status && !solved; ++sweeps) {
        if (!sources.storage) status = fibrad_team_report(&bed->team, "sweeps", sweeps, 0); /* steps are shown, too */
        if (!status) status = fibrad_team_run(&bed->team, NULL, PARTS, 1, sweep_beams, bed->heat, NULL);
        if (!status) status = fibrad_heat_step(bed->heat, &solved);
    }
    return status;
}

int fibrad_bed_solve_now(fibrad_bed *bed, const fibrad_heat_sources *sources, fibrad_heat_result *result) {
    const int status = fibrad_bed_find(bed, sources);
    return status ? status : fibrad_heat_read(bed->heat, result);
}

int fibrad_bed_beams(fibrad_bed *bed, const fibrad_heat_config *config) {
    int status = fibrad_bed_begin(bed);
    if (status) return status;
    const fibrad_heat_config last = bed->beams;
    fibrad_heat_config next = config ? *config : (fibrad_heat_config){0};
    next.parts = PARTS;
    if (!bed->heat || memcmp(&next, &last, sizeof next) != 0) {
        bed->beams = next;
        status = make_heat(bed, 0);
        if (status) bed->beams = last;
    }
    return fibrad_bed_end(bed, status ? status : fibrad_bed_trace(bed));
}

int fibrad_bed_sides(const fibrad_bed *bed, double *flux, double *temperature) {
    if (!bed) return FIBRAD_E_ARGUMENT;
    return bed->heat ? fibrad_heat_read_sides(bed->heat, flux, temperature) : FIBRAD_E_STATE;
}
