/* jump.c - conductivity of a periodic bed by contacts, alone and together with radiation.
 * SPDX-License-Identifier: MIT
 *
 * Let a sphere at the height h have the temperature h + t, and let b be what it gains if all t are 0. The bed conducts
 * least at the t with which no sphere gains anything: G t = b, where G t is what spheres lose at the temperatures t.
 * With t = 0 the bed of the volume V conducts k_0 = (1/V) sum over contacts of H (h_j - h_i)^2, and radiation beside.
 * Then k = k_0 - (1/V) sum of b t. */
#include "bed/jump.h"

#include <math.h>
#include <stdlib.h>

#include "bed/bed_scene.h"
#include "bed/packing.h"

/* By how much the second end of contact c lies above the first one. */
static double rise_of(const struct bed *bed, const struct jump_contacts *contacts, uint32_t c, int axis) {
    const double *at = bed_centres(bed, axis), period = bed->period[axis];
    const double rise = at[contacts->second[c]] - at[contacts->first[c]];
    return rise - period * round(rise / period);
}

/* Adds what spheres gain through contacts if all t are 0 to `gain`. Returns V k_0 of contacts. */
static double add_linear(const struct bed *bed, const struct jump_contacts *contacts, int axis, double *gain) {
    double sum = 0;
    for (uint32_t c = 0; c < contacts->n; ++c) {
        const double rise = rise_of(bed, contacts, c, axis), flow = contacts->conductance[c] * rise;
        gain[contacts->first[c]] += flow;
        gain[contacts->second[c]] -= flow;
        sum += flow * rise;
    }
    return sum;
}

static double scalar_product(uint32_t n, const double *a, const double *b) {
    double sum = 0;
    for (uint32_t i = 0; i < n; ++i) sum += a[i] * b[i];
    return sum;
}

/* What spheres lose through contacts at the temperatures t. */
static void lose_by_contacts(const struct jump_contacts *contacts, uint32_t n, const double *t, double *loss) {
    for (uint32_t i = 0; i < n; ++i) loss[i] = 0;
    for (uint32_t c = 0; c < contacts->n; ++c) {
        const uint32_t i = contacts->first[c], j = contacts->second[c];
        const double flow = contacts->conductance[c] * (t[i] - t[j]);
        loss[i] += flow;
        loss[j] -= flow;
    }
}

/* Solves G t = b of contacts alone, by conjugate gradients. The level of t is free. `missing` is b on entry. */
static void settle_contacts(const struct jump_contacts *contacts, uint32_t n, double *missing, double *direction,
                            double *loss, double *t) {
    double square = scalar_product(n, missing, missing);
    const double enough = 1e-24 * square;
    for (uint32_t i = 0; i < n; ++i) direction[i] = missing[i];
    for (uint32_t step = 0; step < 10 * n && square > enough; ++step) {
        lose_by_contacts(contacts, n, direction, loss);
        const double length = square / scalar_product(n, direction, loss), before = square;
        for (uint32_t i = 0; i < n; ++i) t[i] += length * direction[i], missing[i] -= length * loss[i];
        square = scalar_product(n, missing, missing);
        for (uint32_t i = 0; i < n; ++i) direction[i] = missing[i] + square / before * direction[i];
    }
}

int jump_conductivity(const struct bed *bed, const struct jump_contacts *contacts, int axis, double volume, double *k) {
    const uint32_t n = bed->n;
    double *room = calloc(5 * ((size_t)n + 1), sizeof *room);
    if (!room) return FIBRAD_E_MEMORY;
    double *gain = room, *missing = room + n, *direction = missing + n, *loss = direction + n, *t = loss + n;
    const double linear = add_linear(bed, contacts, axis, gain);
    for (uint32_t i = 0; i < n; ++i) missing[i] = gain[i];
    settle_contacts(contacts, n, missing, direction, loss, t);
    *k = (linear - scalar_product(n, gain, t)) / volume;
    free(room);
    return FIBRAD_OK;
}

/* ---- together with radiation ------------------------------------------------------------------------------------ */

#define SLOPE 1e-3 /* of temperatures over their mean, along three periods */
enum { COPIES = 3 };

/* Adds the sides to walls, as insulated ones. Their arrays have room for WALLS_MAX walls. */
static void add_sides(const struct walls *sides, struct walls *walls, double *temperature, unsigned char *insulated) {
    for (uint32_t k = 0; sides && k < sides->count && walls->count < WALLS_MAX; ++k) {
        temperature[walls->count] = NAN, insulated[walls->count] = 1;
        walls->wall[walls->count++] = sides->wall[k];
    }
}

/* Solves a heat problem. `sources` has what is given of spheres. power, temperature [spheres]: may be NULL. */
static int solve_once(const struct bed *bed, const struct jump_radiation *radiation, struct walls *walls,
                      double plate[WALLS_MAX], fibrad_heat_sources *sources, fibrad_run *run, double *power,
                      double *temperature) {
    unsigned char insulated[WALLS_MAX] = {0};
    double emissivity[WALLS_MAX], wall_power[WALLS_MAX];
    for (uint32_t k = 0; k < WALLS_MAX; ++k) emissivity[k] = 1;
    add_sides(radiation->sides, walls, plate, insulated);
    sources->wall_temperature = plate, sources->wall_emissivity = emissivity, sources->insulated = insulated;
    sources->surroundings = radiation->temperature, sources->tolerance = 1e-6;
    const fibrad_scene_config scene = bed_scene(bed, walls);
    const fibrad_spheres spheres = bed_spheres(bed);
    const fibrad_heat_config config = {.directions = radiation->directions};
    fibrad_heat_result result = {.power = power, .temperature = temperature, .wall_power = wall_power};
    fibrad_radiation *solver = NULL;
    int status = fibrad_radiation_new(&solver, &scene, &spheres, &config, run);
    if (!status) status = fibrad_radiation_solve(solver, sources, &result);
    fibrad_radiation_describe(solver, NULL, &run->fault);
    fibrad_radiation_free(solver);
    return status;
}

/* What spheres gain by radiation if their temperatures rise along the axis by `slope` times their mean per length.
 * These are the spheres of the middle one of three periods, between plates. */
static int gain_by_radiation(const struct bed *bed, const struct jump_radiation *radiation, int axis, double slope,
                             fibrad_run *run, double *gain) {
    struct bed stack = bed_empty();
    const uint32_t copies[3] = {axis == 0 ? COPIES : 1, axis == 1 ? COPIES : 1, axis == 2 ? COPIES : 1};
    const size_t n = (size_t)COPIES * bed->n;
    double *emissivity = calloc(3 * n + 1, sizeof *emissivity), plate[WALLS_MAX], mean = 0;
    struct walls walls = {.count = 2};
    if (!emissivity) return FIBRAD_E_MEMORY;
    double *at = emissivity + n, *power = at + n;
    int status = bed_make_copies(&stack, bed, copies) ? FIBRAD_E_MEMORY : FIBRAD_OK;
    stack.period[axis] = 0;
    for (uint32_t k = 0; k < 2 && !status; ++k) {
        const double end = bed_reach(&stack, axis, k == 1);
        walls.wall[k] = (fibrad_wall){.kind = FIBRAD_WALL_PLANE, .plane = {axis, (int)k, end}};
        mean += end / 2, plate[k] = end;
    }
    for (int k = 0; k < 2; ++k) plate[k] = radiation->temperature * (1 + slope * (plate[k] - mean));
    for (uint32_t i = 0; i < n && !status; ++i) {
        at[i] = radiation->temperature * (1 + slope * (bed_centres(&stack, axis)[i] - mean));
        emissivity[i] = radiation->emissivity[i / COPIES];
    }
    fibrad_heat_sources sources;
    fibrad_heat_sources_init(&sources);
    sources.temperature = at, sources.emissivity = emissivity;
    if (!status) status = solve_once(&stack, radiation, &walls, plate, &sources, run, power, NULL);
    for (uint32_t i = 0; i < bed->n && !status; ++i) gain[i] = power[COPIES * i + 1];
    free(emissivity);
    bed_free(&stack);
    return status;
}

/* The temperatures at which spheres lose `gain`. One sphere has the mean temperature. The gains must add up to 0, so
 * what is left of their sum, noise of radiation, is taken from those that radiate. */
static int settle_all(const struct bed *bed, const struct jump_contacts *contacts,
                      const struct jump_radiation *radiation, fibrad_run *run, double *gain, double *at) {
    const uint32_t n = bed->n;
    double *given = malloc(3 * ((size_t)n + 1) * sizeof *given), plate[WALLS_MAX], sum = 0, radiating = 0;
    struct walls walls = {.count = 0};
    fibrad_heat_sources sources;
    if (!given) return FIBRAD_E_MEMORY;
    double *found = given + n, *emissivity = found + n;
    for (uint32_t i = 0; i < n; ++i) {
        given[i] = NAN, emissivity[i] = fmax(radiation->emissivity[i], HARDLY_RADIATES);
        sum += gain[i], radiating += emissivity[i] * bed->r[i] * bed->r[i];
    }
    for (uint32_t i = 0; i < n; ++i) gain[i] -= sum / radiating * emissivity[i] * bed->r[i] * bed->r[i];
    const double first = gain[0];
    given[0] = radiation->temperature, gain[0] = 0;
    fibrad_heat_sources_init(&sources);
    sources.temperature = given, sources.power = gain, sources.emissivity = emissivity;
    sources.contact_first = contacts->first, sources.contact_second = contacts->second;
    sources.conductance = contacts->conductance, sources.contacts = contacts->n;
    const int status = solve_once(bed, radiation, &walls, plate, &sources, run, found, at);
    gain[0] = first;
    free(given);
    return status;
}

int jump_joint(const struct bed *bed, const struct jump_contacts *contacts, const struct jump_radiation *radiation,
               int axis, double volume, fibrad_run *run, double *k) {
    double *gain = calloc(2 * ((size_t)bed->n + 1), sizeof *gain);
    if (!gain) return FIBRAD_E_MEMORY;
    double *at = gain + bed->n;
    const double slope = SLOPE / (COPIES * bed->period[axis]), kelvins = slope * radiation->temperature;
    int status = gain_by_radiation(bed, radiation, axis, slope, run, gain);
    for (uint32_t i = 0; i < bed->n; ++i) gain[i] /= kelvins;
    const double linear = add_linear(bed, contacts, axis, gain);
    for (uint32_t i = 0; i < bed->n; ++i) gain[i] *= kelvins;
    if (!status) status = settle_all(bed, contacts, radiation, run, gain, at);
    double less = 0;
    for (uint32_t i = 0; i < bed->n && !status; ++i) less += gain[i] * (at[i] - radiation->temperature);
    *k = radiation->linear + (linear - less / (kelvins * kelvins)) / volume;
    free(gain);
    return status;
}
