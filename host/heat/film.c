/* film.c - convection: heat that spheres and walls exchange with gas of a given temperature.
 * SPDX-License-Identifier: MIT */
#include "heat/heat.h"

#include <gsl/gsl_math.h>
#include <stdlib.h>
#include <string.h>

#include "bed/units.h"
#include "cli/message.h"

#define COEFFICIENT_MAX 1e12 /* [W/(m2 K)] */

int convection_option(const char *text, void *coefficient) {
    return quantity_option("--convection", text, 0, COEFFICIENT_MAX, coefficient);
}

int gas_temperature_option(const char *text, void *film_options) { /* --temperature-unit may follow */
    struct film_options *options = film_options;
    options->gas_table = *text == '@' ? text + 1 : NULL;
    options->gas.given = true;
    if (options->gas_table) return STATUS_OK;
    return quantity_option("--gas-temperature", text, -KELVIN_OF_0_CELSIUS, TEMPERATURE_MAX, &options->gas);
}

bool film_given(const struct film_options *options, const struct wall_options *walls) {
    return options->coefficient.given || walls_keys(walls) & WALL_CONVECTION;
}

int film_check(struct film_options *options, struct bed_options *bed, double zero, bool timed) {
    const bool of_walls = walls_keys(&bed->walls) & WALL_CONVECTION, wall_gas = walls_keys(&bed->walls) & WALL_GAS;
    if (options->coefficient.given && !options->gas.given)
        return message(STATUS_USAGE, "--convection needs --gas-temperature");
    if (options->gas.given && !options->coefficient.given && !of_walls)
        return message(STATUS_USAGE, "--gas-temperature needs --convection, or a wall with :convection=H");
    if (wall_gas && !of_walls) return message(STATUS_USAGE, "--wall: gas needs convection");
    if (options->gas.value < -zero)
        return message(STATUS_USAGE, "--gas-temperature: %g is below absolute zero", options->gas.value);
    bed_options_quantity(bed, &options->coefficient, "W/(m2 K)");
    bed_options_quantity(bed, &options->gas, temperature_unit(zero));
    if (!options->gas_table) return STATUS_OK;
    if (!timed)
        return message(STATUS_USAGE, "--gas-temperature: @%.60s is a table; tables are for --until",
                       options->gas_table);
    return curve_read(options->gas_table, "temperature", zero > 0 ? &curve_celsius : &curve_kelvins, 0 - zero,
                      TEMPERATURE_MAX, &options->gas_curve);
}

/* Films of walls: those with the key `convection`. */
static int find_wall_films(struct film_state *state, const struct film_options *options, const struct bed *bed,
                           const fibrad_bed *made, const struct walls *walls, double zero) {
    const struct quantity *gas = &options->gas;
    for (uint32_t k = 0; k < walls->count; ++k) {
        const struct wall_words *said = &walls->said[k];
        const char *name = wall_name(walls, k);
        if (!(said->given & WALL_CONVECTION)) continue;
        if (wall_endless(walls, bed, &walls->wall[k]))
            return message(STATUS_USAGE, "--wall: %s is endless and has no convection", name);
        if (said->given & WALL_INSULATED)
            return message(STATUS_USAGE,
                           "--wall: %s is insulated and has no convection; power=0 is a wall that "
                           "gives off what it gains",
                           name);
        state->wall_follows[k] = isnan(said->gas);
        if (state->wall_follows[k] && (!gas->given || gas->column || gas->types))
            return message(STATUS_USAGE,
                           "--wall: %s has convection and needs the temperature of its gas, %s:gas=300 "
                           "for example",
                           name, name);
        state->wall_gas[k] = (isnan(said->gas) ? gas->value : said->gas) + zero;
        if (!(state->wall_gas[k] >= 0))
            return message(STATUS_USAGE, "--wall: gas of %s: %g is below absolute zero", name, said->gas);
        const double area = fibrad_bed_wall_area(made, k) * gsl_pow_2(bed->metres);
        state->wall_film[k] = said->convection * area * state->per_watt;
    }
    memcpy(state->wall_end, state->wall_gas, sizeof state->wall_end);
    return STATUS_OK;
}

static int find_sphere_films(struct film_state *state, const struct film_options *options, const char *file,
                             const struct bed *bed, double zero) {
    if (!options->coefficient.given) return STATUS_OK;
    int status = quantity_values(&options->coefficient, bed, file, "heat transfer coefficient", 0, 0, COEFFICIENT_MAX,
                                 &state->film);
    if (!status)
        status = quantity_values(&options->gas, bed, file, "temperature of the gas in kelvins", zero, 0,
                                 TEMPERATURE_MAX, &state->gas);
    for (uint32_t i = 0; i < bed->n && !status; ++i)
        state->film[i] *= 4 * M_PI * gsl_pow_2(bed->r[i] * bed->metres) * state->per_watt;
    for (uint32_t i = 0; i < bed->n && !status; ++i) state->end[i] = state->gas[i];
    return status;
}

int film_begin(struct film_state *state, const struct film_options *options, const char *file, const struct bed *bed,
               const fibrad_bed *made, const struct walls *walls, double zero, double per_watt,
               fibrad_heat_sources *sources, fibrad_heat_result *result) {
    *state = (struct film_state){.any = options->coefficient.given, .per_watt = per_watt};
    for (uint32_t k = 0; k < walls->count; ++k) state->any = state->any || walls->said[k].given & WALL_CONVECTION;
    if (!state->any) return STATUS_OK;
    state->convected = calloc(2 * (size_t)bed->n + 1, sizeof *state->convected);
    if (!state->convected) return message_memory();
    state->end = state->convected + bed->n;
    int status = find_sphere_films(state, options, file, bed, zero);
    if (!status) status = find_wall_films(state, options, bed, made, walls, zero);
    if (status) return status;
    if (options->gas_table) film_at(state, options, bed->n, walls->count, zero, 0, 0);
    sources->film = state->film, sources->gas = state->gas;
    sources->wall_film = state->wall_film, sources->wall_gas = state->wall_gas;
    result->convected = state->convected, result->wall_convected = state->wall;
    return STATUS_OK;
}

void film_free(struct film_state *state) {
    free(state->film);
    free(state->gas);
    free(state->convected);
    *state = (struct film_state){.any = false};
}

void film_at(struct film_state *state, const struct film_options *options, uint32_t spheres, uint32_t walls,
             double zero, double now, double end) {
    if (!state->any || options->gas_curve.n == 0) return;
    const double t[2] = {curve_at(&options->gas_curve, now) + zero, curve_at(&options->gas_curve, end) + zero};
    for (uint32_t i = 0; i < spheres && state->film; ++i) state->gas[i] = t[0], state->end[i] = t[1];
    for (uint32_t k = 0; k < walls; ++k)
        if (state->wall_follows[k]) state->wall_gas[k] = t[0], state->wall_end[k] = t[1];
}

void film_scale(struct film_state *state, uint32_t spheres, uint32_t walls, fibrad_heat_result *result) {
    if (!state->any) return;
    for (uint32_t i = 0; i < spheres; ++i) state->convected[i] /= state->per_watt;
    for (uint32_t k = 0; k < walls; ++k) state->wall[k] /= state->per_watt;
    result->gas_power /= state->per_watt, result->gas_error /= state->per_watt;
}

void film_report(const struct film_state *state, const struct film_options *options, const struct walls *walls,
                 const fibrad_heat_result *result, struct report *report) {
    if (!state->any) return;
    quantity_report(&options->coefficient, "convection_W_m2K", report);
    report_measured(report, "gas_W", result->gas_power, result->gas_error);
    report_value(report, "gas_error_W", result->gas_error, 2);
    for (uint32_t k = 0; k < walls->count; ++k)
        if (state->wall_film[k] > 0)
            report_value(report, report_key(report, "wall_%s_convection_W", wall_name(walls, k)), state->wall[k], 6);
}
