/* film.c - convection: heat that spheres and walls exchange with gas of a given temperature.
 * SPDX-License-Identifier: MIT */
#include "heat/heat.h"

#include <gsl/gsl_math.h>
#include <stdlib.h>
#include <string.h>

#define COEFFICIENT_MAX 1e12 /* [W/(m2 K)] */

int convection_option(const char *text, void *film_options) {
    struct film_options *options = film_options;
    const bool wakao = strncmp(text, "wakao:", 6) == 0;
    double value[2];
    int count = 0;
    if (!wakao && strncmp(text, "gunn:", 5) != 0)
        return quantity_option("--convection", text, 0, COEFFICIENT_MAX, &options->coefficient);
    const int status = options_numbers("--convection", strchr(text, ':') + 1, 2, value, &count);
    if (status) return status;
    if (count != 2 || !(value[0] > 0 && value[0] <= COEFFICIENT_MAX && value[1] > 0 && value[1] <= COEFFICIENT_MAX))
        return message(STATUS_USAGE, "--convection: %.60s is not %s:K,MU, with K [W/(m K)] and MU [Pa s] above 0", text,
                       wakao ? "wakao" : "gunn");
    options->correlation = wakao ? WAKAO : GUNN, options->coefficient.given = true;
    options->conductivity = value[0], options->viscosity = value[1];
    return STATUS_OK;
}

int gas_temperature_option(const char *text, void *film_options) { /* --temperature-unit may follow */
    struct film_options *options = film_options;
    options->gas_table = *text == '@' ? text + 1 : NULL;
    options->gas.given = true;
    if (options->gas_table) return STATUS_OK;
    return quantity_option("--gas-temperature", text, -KELVIN_OF_0_CELSIUS, TEMPERATURE_MAX, &options->gas);
}

bool film_given(const struct heat *h) {
    return h->film.coefficient.given || walls_keys(&h->options.walls) & WALL_CONVECTION;
}

int film_check(struct heat *h) {
    struct film_options *options = &h->film;
    const double zero = h->given.zero;
    const int status = stream_check(options);
    if (status) return status;
    if (options->coefficient.given && !options->gas.given)
        return message(STATUS_USAGE, "--convection needs --gas-temperature");
    if (options->gas.given && !film_given(h))
        return message(STATUS_USAGE, "--gas-temperature needs --convection, or a wall with :convection=H");
    if (walls_keys(&h->options.walls) & WALL_GAS && !(walls_keys(&h->options.walls) & WALL_CONVECTION))
        return message(STATUS_USAGE, "--wall: gas needs convection");
    if (options->gas.value < -zero)
        return message(STATUS_USAGE, "--gas-temperature: %g is below absolute zero", options->gas.value);
    bed_options_quantity(&h->options, &options->coefficient, "W/(m2 K)");
    bed_options_quantity(&h->options, &options->gas, temperature_unit(zero));
    if (!options->gas_table) return STATUS_OK;
    if (!h->given.timed)
        return message(STATUS_USAGE, "--gas-temperature: @%.60s is a table; tables are for --until",
                       options->gas_table);
    return curve_read(options->gas_table, "temperature", zero > 0 ? &curve_celsius : &curve_kelvins, 0 - zero,
                      TEMPERATURE_MAX, &options->gas_curve);
}

/* The film of a wall that has the key `convection`. */
static int find_wall_film(struct heat *h, uint32_t k) {
    struct film_state *films = &h->films;
    const struct quantity *gas = &h->film.gas;
    const struct wall_words *said = &h->walls.said[k];
    const char *name = wall_name(&h->walls, k);
    if (wall_endless(&h->walls, h->bed, &h->walls.wall[k]))
        return message(STATUS_USAGE, "--wall: %s is endless and has no convection", name);
    if (said->given & WALL_INSULATED)
        return message(STATUS_USAGE,
                       "--wall: %s is insulated and has no convection; power=0 is a wall that gives off what it gains",
                       name);
    if (h->values.column[k].n > 0)
        return message(STATUS_USAGE, "--wall: %s has temperatures of its triangles, and no convection", name);
    films->wall_follows[k] = isnan(said->gas);
    if (films->wall_follows[k] && (!gas->given || gas->column || gas->types || h->film.flux > 0))
        return message(STATUS_USAGE,
                       "--wall: %s has convection and needs the temperature of its gas, %s:gas=300 for example", name,
                       name);
    films->wall_gas[k] = (isnan(said->gas) ? gas->value : said->gas) + h->given.zero;
    if (!(films->wall_gas[k] >= 0))
        return message(STATUS_USAGE, "--wall: gas of %s: %g is below absolute zero", name, said->gas);
    films->wall_film[k] =
        said->convection * fibrad_bed_wall_area(h->made, k) * gsl_pow_2(h->bed->metres) * films->per_watt;
    return STATUS_OK;
}

static int find_sphere_films(struct heat *h) {
    struct film_state *films = &h->films;
    const struct bed *bed = h->bed;
    if (!h->film.coefficient.given) return STATUS_OK;
    int status = quantity_values(&h->film.coefficient, bed, h->options.name, "heat transfer coefficient", 0, 0,
                                 COEFFICIENT_MAX, &films->film);
    if (!status)
        status = quantity_values(&h->film.gas, bed, h->options.name, "temperature of the gas in kelvins", h->given.zero,
                                 0, TEMPERATURE_MAX, &films->gas);
    if (!status && h->film.correlation) status = stream_coefficients(h, films->film);
    for (uint32_t i = 0; i < bed->n && !status; ++i) films->film[i] *= heat_area(h, i) * films->per_watt;
    return status;
}

int film_begin(struct heat *h, double per_watt) {
    struct film_state *films = &h->films;
    *films = (struct film_state){.any = film_given(h), .per_watt = per_watt};
    if (!films->any) return STATUS_OK;
    films->convected = calloc(2 * (size_t)h->bed->n + 1, sizeof *films->convected);
    if (!films->convected) return message_memory();
    films->end = films->convected + h->bed->n;
    int status = stream_begin(h);
    if (!status) status = find_sphere_films(h);
    for (uint32_t k = 0; k < h->walls.count && !status; ++k)
        if (h->walls.said[k].given & WALL_CONVECTION) status = find_wall_film(h, k);
    if (status) return status;
    if (films->film) memcpy(films->end, films->gas, h->bed->n * sizeof *films->end);
    memcpy(films->wall_end, films->wall_gas, sizeof films->wall_end);
    film_at(h, 0, 0);
    h->sources.film = films->film, h->sources.gas = films->gas;
    h->sources.wall_film = films->wall_film, h->sources.wall_gas = films->wall_gas;
    h->result.convected = films->convected, h->result.wall_convected = films->wall;
    return STATUS_OK;
}

void film_free(struct film_state *state) {
    free(state->film);
    free(state->gas);
    free(state->convected);
    free((void *)state->stream.slice);
    free(state->memory);
    *state = (struct film_state){.any = false};
}

void film_at(struct heat *h, double now, double end) {
    struct film_state *films = &h->films;
    const struct curve *curve = &h->film.gas_curve;
    if (!films->any || curve->n == 0) return;
    const double t[2] = {curve_at(curve, now) + h->given.zero, curve_at(curve, end) + h->given.zero};
    for (uint32_t i = 0; i < h->bed->n && films->film; ++i) films->gas[i] = t[0], films->end[i] = t[1];
    films->stream.inlet = t[0], films->inlet_end = t[1];
    for (uint32_t k = 0; k < h->walls.count; ++k)
        if (films->wall_follows[k]) films->wall_gas[k] = t[0], films->wall_end[k] = t[1];
}

void film_scale(struct heat *h) {
    struct film_state *films = &h->films;
    if (!films->any) return;
    for (uint32_t i = 0; i < h->bed->n; ++i) films->convected[i] /= films->per_watt;
    for (uint32_t k = 0; k < h->walls.count; ++k) films->wall[k] /= films->per_watt;
    h->result.gas_power /= films->per_watt, h->result.gas_error /= films->per_watt;
}

void film_report(struct heat *h) {
    const struct film_state *films = &h->films;
    struct report *report = &h->options.report;
    if (!films->any) return;
    if (!h->film.correlation) quantity_report(&h->film.coefficient, "convection_W_m2K", report);
    stream_report(h);
    report_measured(report, "gas_W", h->result.gas_power, h->result.gas_error);
    report_value(report, "gas_error_W", h->result.gas_error, 2);
    for (uint32_t k = 0; k < h->walls.count; ++k)
        if (films->wall_film[k] > 0)
            report_value(report, report_key(report, "wall_%s_convection_W", wall_name(&h->walls, k)), films->wall[k],
                         6);
}
