/* law.c - solutions whose emissivities follow a law. SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "simple/bed.h"

#define EMISSIVITY_CHANGE   1e-5
#define CONDUCTIVITY_CHANGE 1e-4 /* relative */
enum { SETTLE_MAX = 100 };

/* Whether the sources have the arrays of temperatures that the law reads first. */
static bool temperatures_given(const fibrad_heat_sources *s, const fibrad_scene_facts *facts) {
    return (!facts->spheres || s->temperature) && (!facts->walls || s->wall_temperature);
}

static bool are_emissivities(const double *emissivity, uint32_t n) {
    bool valid = true;
    for (uint32_t i = 0; i < n && valid; ++i) valid = emissivity[i] >= 0 && emissivity[i] <= 1;
    return valid;
}

static double largest_change(const double *before, const double *now, uint32_t n) {
    double largest = 0;
    for (uint32_t i = 0; i < n; ++i) largest = larger_of(fabs(now[i] - before[i]), largest);
    return largest;
}

/* The largest relative change of conductivities above 0, some of which may be infinite. */
static double largest_ratio(const double *before, const double *now, uint32_t n) {
    double largest = 0;
    for (uint32_t i = 0; i < n; ++i) {
        const double change = now[i] == before[i] ? 0 : fabs(now[i] / before[i] - 1);
        if (!(change <= largest)) largest = change;
    }
    return largest;
}

/* The arrays of a problem that follows a law, [spheres] and [walls] each unless said, in one block. */
struct settling {
    double *emissivity, *wall_emissivity, *before, *wall_before, *power, *wall_power, *temperature, *wall_temperature;
    double *conductivity, *conductance; /* [spheres] and [contacts], of the last solution */
};

static void divide_block(double *block, uint32_t n, uint32_t walls, struct settling *s) {
    double **const of_spheres[] = {&s->emissivity, &s->before, &s->power, &s->temperature, &s->conductivity};
    double **const of_walls[] = {&s->wall_emissivity, &s->wall_before, &s->wall_power, &s->wall_temperature};
    for (size_t k = 0; k < sizeof of_spheres / sizeof *of_spheres; ++k, block += n) *of_spheres[k] = n ? block : NULL;
    for (size_t k = 0; k < sizeof of_walls / sizeof *of_walls; ++k, block += walls) *of_walls[k] = walls ? block : NULL;
    s->conductance = block;
}

static void copy_values(double *to, const double *from, uint32_t n) {
    if (n) memcpy(to, from, n * sizeof *to);
}

/* Solves until the emissivities and conductivities that the law gives have settled. Only then is `result` written. */
static int follow_law(fibrad_bed *bed, const fibrad_heat_sources *sources, const fibrad_law *law,
                      const fibrad_scene_facts *facts, const struct settling *s, fibrad_heat_result *result) {
    const uint32_t n = facts->spheres, walls = facts->walls, conducting = sources->conductivity ? n : 0;
    const uint32_t contacts = sources->conductance ? sources->contacts : 0;
    fibrad_heat_result found = {.power = s->power, .wall_power = s->wall_power, .temperature = s->temperature};
    found.wall_temperature = s->wall_temperature;
    fibrad_heat_sources now = *sources;
    now.emissivity = s->emissivity, now.wall_emissivity = s->wall_emissivity;
    if (contacts) now.conductance = s->conductance; /* the law may change those of the caller before they are read */
    law->follow(law->context, sources->temperature, sources->wall_temperature, s->emissivity, s->wall_emissivity);
    for (int k = 0; k < SETTLE_MAX; ++k) {
        copy_values(s->conductance, sources->conductance, contacts);
        int status = fibrad_bed_find(bed, &now);
        if (status) return status;
        status = fibrad_heat_read(bed->heat, &found);
        if (status == FIBRAD_E_UNSOLVABLE) (void)fibrad_heat_read(bed->heat, result); /* a temperature may be missing */
        if (status) return status;
        copy_values(s->before, s->emissivity, n);
        copy_values(s->wall_before, s->wall_emissivity, walls);
        copy_values(s->conductivity, sources->conductivity, conducting);
        law->follow(law->context, s->temperature, s->wall_temperature, s->emissivity, s->wall_emissivity);
        if (!are_emissivities(s->emissivity, n) || !are_emissivities(s->wall_emissivity, walls))
            return FIBRAD_E_ARGUMENT;
        if (largest_change(s->before, s->emissivity, n) + largest_change(s->wall_before, s->wall_emissivity, walls) <=
                EMISSIVITY_CHANGE &&
            largest_ratio(s->conductivity, sources->conductivity, conducting) <= CONDUCTIVITY_CHANGE &&
            largest_ratio(s->conductance, sources->conductance, contacts) <= CONDUCTIVITY_CHANGE)
            return fibrad_heat_read(bed->heat, result);
    }
    return FIBRAD_E_UNSETTLED;
}

static int settle(fibrad_bed *bed, const fibrad_heat_sources *sources, fibrad_law *law, fibrad_heat_result *result) {
    const fibrad_scene_facts *facts = &bed->facts;
    const uint32_t n = facts->spheres, walls = facts->walls;
    if ((n && !(law->emissivity && result->temperature)) ||
        (walls && !(law->wall_emissivity && result->wall_temperature)) || !temperatures_given(sources, facts))
        return FIBRAD_E_ARGUMENT;
    struct settling s;
    const uint32_t contacts = sources->conductance ? sources->contacts : 0;
    double *block = malloc((5 * (size_t)n + 4 * (size_t)walls + contacts + 1) * sizeof *block);
    if (!block) return FIBRAD_E_MEMORY;
    divide_block(block, n, walls, &s);
    copy_values(s.emissivity, law->emissivity, n);
    copy_values(s.wall_emissivity, law->wall_emissivity, walls);
    const int status = follow_law(bed, sources, law, facts, &s, result);
    if (!status) {
        copy_values(law->emissivity, s.emissivity, n);
        copy_values(law->wall_emissivity, s.wall_emissivity, walls);
    }
    free(block);
    return status;
}

int fibrad_bed_solve(fibrad_bed *bed, const fibrad_heat_sources *sources, fibrad_law *law, fibrad_heat_result *result) {
    if (!sources || !result || (law && !law->follow)) return FIBRAD_E_ARGUMENT;
    int status = fibrad_bed_begin(bed);
    if (status) return status;
    fibrad_bed_warn_of_sources(bed, sources, sources->temperature);
    status = law ? settle(bed, sources, law, result) : fibrad_bed_solve_now(bed, sources, result);
    if (!status) fibrad_bed_warn_of_surfaces(bed, result);
    return fibrad_bed_end(bed, status);
}
