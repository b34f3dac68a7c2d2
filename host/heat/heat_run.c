/* heat_run.c - net powers of one bed in watts. SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "heat/heat.h"

/* Says why no temperatures have the given powers if none is given at all. sum: of the powers [W]. magnitude: of their
 * magnitudes. */
static int refuse_level(const char *file, double sum, double magnitude) {
    if (fabs(sum) <= 1e-12 * magnitude)
        return message_at(STATUS_INPUT, file, 0, "no temperature is given in this closed bed; give one, or --ambient");
    return message_at(STATUS_INPUT, file, 0,
                      "no temperature is given in this closed bed, and its powers add up to %g W, not to 0", sum);
}

/* Says why no temperatures have the given powers. */
static int refuse_powers(const struct heat *h) {
    const fibrad_heat_sources *s = &h->sources;
    const char *file = h->options.name;
    const double square_metres = h->bed->metres * h->bed->metres;
    bool given = !isnan(s->surroundings);
    double sum = 0, magnitude = 0;
    for (uint32_t i = 0; i < h->bed->n; ++i) {
        given |= !isnan(s->temperature[i]);
        if (!isnan(s->temperature[i])) continue;
        sum += s->power[i] * square_metres;
        magnitude += fabs(s->power[i]) * square_metres;
    }
    for (uint32_t k = 0; k < h->walls.count; ++k) {
        given |= !isnan(s->wall_temperature[k]);
        if (!isnan(s->wall_temperature[k]) || s->insulated[k]) continue;
        sum += s->wall_power[k] * square_metres;
        magnitude += fabs(s->wall_power[k]) * square_metres;
    }
    if (!given) return refuse_level(file, sum, magnitude);
    for (uint32_t i = 0; i < h->bed->n; ++i)
        if (isnan(s->temperature[i]) && isnan(h->result.temperature[i]) && (s->emissivity[i] > 0 || s->power[i] != 0))
            return message_at(STATUS_INPUT, file, h->bed->line[i],
                              "sphere %lld: no temperature above 0 K gives off %g W here",
                              (long long)bed_name(h->bed, i), s->power[i] * square_metres);
    for (uint32_t k = 0; k < h->walls.count; ++k)
        if (isnan(s->wall_temperature[k]) && !s->insulated[k] && isnan(h->result.wall_temperature[k]))
            return message_at(STATUS_INPUT, file, 0, "wall %s: no temperature above 0 K gives off %g W here",
                              wall_name(&h->walls, k), s->wall_power[k] * square_metres);
    return refuse_level(file, sum, magnitude);
}

/* Powers of the library are per area in the bed's unit of length. In watts they are square_metres times as large. */
static void scale_result(struct heat *h, double square_metres) {
    fibrad_heat_result *result = &h->result;
    if (square_metres == 1) return;
    for (uint32_t i = 0; i < h->bed->n; ++i) result->power[i] *= square_metres, result->power_error[i] *= square_metres;
    for (uint32_t k = 0; k < h->walls.count; ++k) {
        result->wall_power[k] *= square_metres;
        result->wall_error[k] *= square_metres;
        result->wall_absorbed[k] *= square_metres;
        result->wall_area[k] *= square_metres;
    }
    result->surroundings_power *= square_metres, result->surroundings_error *= square_metres;
    result->error_patches *= square_metres;
    result->error_beams *= square_metres;
}

/* All powers add up to 0. So each errs by at most what all others err by together. */
static void bound_by_balance(struct heat *h) {
    fibrad_heat_result *result = &h->result;
    double *of[WALLS_MAX + 1] = {&result->surroundings_error}, all = result->surroundings_error + result->gas_error;
    for (uint32_t i = 0; i < h->bed->n; ++i) /* of clumps of unknown temperatures the sum is given */
        if (!isnan(h->sources.temperature[i])) all += result->power_error[i];
    for (uint32_t k = 0; k < h->walls.count; ++k) of[k + 1] = &result->wall_error[k], all += *of[k + 1];
    for (uint32_t k = 0; k <= h->walls.count; ++k)
        if (*of[k] > all / 2) *of[k] = fmax(all - *of[k], 0), k = h->walls.count; /* only one can be */
}

/* Refuses a problem that will not fit into memory. Source: fibrad_heat_size. */
static int check_memory(const struct heat *h) {
    const fibrad_heat_config *config = &h->used;
    const double beams = (double)config->directions * config->points, patches = config->patches;
    const double kept = fmin(beams, 4 * sqrt(beams / 2 * patches)), number = patches > 96 ? 2 : 1;
    const double others = 4000; /* bytes for the spheres that one sphere sees */
    return memory_check(h->bed->n * (3 * number * kept + 8 * 7 * patches + others),
                        "fewer --directions, --points or --patches take less");
}

/* Tolerance of the radiosities over heat->error: so small that it adds nothing to the error. */
#define SOLVED 5e-3

/* Solves the problem of the library. Returns a status of the library. */
static int solve_made(struct heat *h) {
    fibrad_heat_sources sources = h->sources;
    double wall_emissivity[WALLS_MAX];
    fibrad_law law = {heat_follow, h, h->emissivity, wall_emissivity};
    memcpy(wall_emissivity, h->wall_emissivity, sizeof wall_emissivity);
    if (h->error > 0) sources.tolerance = fmin(1e-5, SOLVED * h->error);
    if (isnan(sources.surroundings)) sources.surroundings = 0; /* closed bed: no radiation reaches the surroundings */
    int status = light_absorb(h, 1, &sources);
    if (!status) status = fibrad_bed_solve(h->made, &sources, &law, &h->result);
    if (status || !h->triangles.count) return status;
    status = fibrad_bed_sides(h->made, h->triangles.quantity[TRIANGLE_FLUX].side,
                              h->triangles.quantity[TRIANGLE_TEMPERATURE].side);
    side_arrays_show(&h->triangles);
    return status;
}

int heat_solve(struct heat *h) {
    const double begun = progress_clock(), square_metres = h->bed->metres * h->bed->metres;
    fibrad_fault fault;
    int status = check_memory(h);
    if (status) return status;
    status = fibrad_bed_beams(h->made, &h->used);
    if (status == FIBRAD_E_UNSUPPORTED && h->seconds > 0) return status;
    if (!status) status = solve_made(h);
    fibrad_bed_describe(h->made, &h->facts, &fault);
    progress_stop(&h->options.progress);
    warn_made(&h->options.warned, h->bed, &h->walls, h->made, h->given.zero == 0);
    if (light_refuse(h, status, &fault)) return STATUS_USAGE;
    const int refused = contacts_refuse(&h->touching, &h->options, h->bed, &h->walls, status, &fault);
    if (refused) return refused;
    if (status == FIBRAD_E_UNSOLVABLE) return refuse_powers(h);
    status = bed_options_status(&h->options, h->bed, status, &fault);
    if (status) return status;
    light_add(h);
    bound_by_balance(h);
    heat_find_temperatures(h);
    warn_hot(&h->options.warned, h->figures.hottest);
    scale_result(h, square_metres);
    contacts_scale(&h->touching, h->bed->n, h->walls.count);
    film_scale(h);
    light_scale(h, square_metres);
    heat_find_figures(h);
    h->seconds = progress_clock() - begun;
    return STATUS_OK;
}
