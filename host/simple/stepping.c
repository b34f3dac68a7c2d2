/* stepping.c - memory of steps in time. SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>

#include "simple/bed.h"

/* Allocates all arrays, in one block. */
static int take_arrays(fibrad_bed *bed) {
    fibrad_stepping *t = &bed->stepping;
    const size_t n = bed->facts.spheres, all = bed->facts.walls;
    double **const of_spheres[] = {
        &t->area,       &t->emissivity, &t->now,        &t->slope,    &t->base,  &t->first,   &t->guess,
        &t->storage,    &t->source,     &t->found,      &t->power,    &t->given, &t->allowed, &t->solution,
        &t->correction, &t->compared,   &t->by_patches, &t->conducts, &t->gas,   &t->heat,    &t->warmth};
    double **const of_walls[] = {&t->wall_emissivity, &t->wall_correction, &t->wall_compared,  &t->wall_power,
                                 &t->wall_gas,        &t->wall_now,        &t->wall_base,      &t->wall_found,
                                 &t->wall_given,      &t->wall_film,       &t->wall_convected, &t->wall_seen,
                                 &t->wall_mixed,      &t->wall_stage}; /* the last one has four per wall */
    const size_t spheres = sizeof of_spheres / sizeof *of_spheres, walls = sizeof of_walls / sizeof *of_walls;
    double *next = calloc(spheres * n + (walls + 3) * all + 1, sizeof *next);
    if (!next) return FIBRAD_E_MEMORY;
    for (size_t k = 0; k < spheres; ++k, next += n) *of_spheres[k] = next;
    for (size_t k = 0; k < walls; ++k, next += all) *of_walls[k] = next;
    return FIBRAD_OK;
}

int fibrad_stepping_make(fibrad_bed *bed) {
    const int status = bed->stepping.area ? FIBRAD_OK : take_arrays(bed);
    for (uint32_t i = 0; i < bed->facts.spheres && !status; ++i)
        bed->stepping.area[i] =
            bed->bodies ? fibrad_scene_exposed_area(bed->scene, i) : 4 * M_PI * bed->spheres.r[i] * bed->spheres.r[i];
    return status;
}

void fibrad_stepping_move(fibrad_bed *bed) {
    fibrad_network_free(bed->stepping.network);
    bed->stepping.network = NULL;
    bed->stepping.steps = 0;
    bed->stepping.corrected = false;
}

void fibrad_stepping_free(fibrad_stepping *stepping) {
    free(stepping->area);
    fibrad_network_free(stepping->network);
}
