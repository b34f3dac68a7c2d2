/* heat_given.c - what is given of each sphere and wall: its temperature or its power. SPDX-License-Identifier: MIT */
#include "heat/heat.h"

#include <gsl/gsl_math.h>
#include <stdlib.h>

#define POWER_MAX 1e30 /* [W] largest absolute value of an option; far below FIBRAD_POWER_MAX */

int given_power_option(const char *text, void *power) {
    return quantity_option("--power", text, -POWER_MAX, POWER_MAX, power);
}

/* Tables of temperatures over time are in the unit of the options. */
static const struct curve_axes *given_axes(const struct given_options *options) {
    return options->zero > 0 ? &curve_celsius : &curve_kelvins;
}

/* Finds options->surroundings. */
static int find_surroundings(struct given_options *options) {
    const double low = 0 - options->zero;
    double *ambient = &options->surroundings;
    int status;
    *ambient = NAN;
    if (!options->ambient) return STATUS_OK;
    if (!options->timed && *options->ambient == '@')
        return message(STATUS_USAGE, "--ambient: '%.60s' is a table; --ambient takes tables with --until",
                       options->ambient);
    if (*options->ambient == '@') {
        status = curve_read(options->ambient + 1, "temperature", given_axes(options), low, TEMPERATURE_MAX,
                            &options->ambient_curve);
        if (!status) *ambient = curve_at(&options->ambient_curve, 0);
    } else {
        status = options_number_or_table("--ambient", options->ambient, low, TEMPERATURE_MAX, ambient);
    }
    *ambient += options->zero;
    return status;
}

int given_check(struct given_options *options, struct bed_options *bed) {
    struct quantity *t = &options->temperature, *p = &options->power;
    if (!t->given && !p->given)
        return message(STATUS_USAGE, "--temperature or --power is missing; see fibrad heat --help");
    if (options->timed && !t->given)
        return message(STATUS_USAGE, "--until needs --temperature, the temperatures at the beginning");
    if (!options->timed && t->given && !t->column && p->given && !p->column)
        return message(STATUS_USAGE, "--temperature and --power: a sphere has only one of them; at least one of the "
                                     "options must be a list or a column");
    if (t->value < -options->zero) return message(STATUS_USAGE, "--temperature: %g is below absolute zero", t->value);
    t->some = p->given && !options->timed;
    p->some = true;
    bed_options_quantity(bed, t, temperature_unit(options->zero));
    bed_options_quantity(bed, p, "W");
    return find_surroundings(options);
}

/* Finds the temperature of a wall from its words, in the unit of the options. NaN: it has none. */
static int wall_temperature(const struct given_options *options, const struct wall_words *said, const char *name,
                            struct curve *curve, struct curve *column, double *temperature) {
    const double low = 0 - options->zero;
    const struct curve_axes *axes = given_axes(options);
    const char *text = said->temperature_text;
    int status = STATUS_OK;
    *temperature = said->temperature;
    if (said->temperatures) {
        status = column_read(said->temperatures, "temperature", &axes->y, low, TEMPERATURE_MAX, column);
        if (!status) *temperature = column->y[0];
    } else if (text && *text == '@' && !options->timed) {
        return message(STATUS_USAGE, "--wall: %s: '%.60s' is a table; walls take tables with --until", name, text);
    } else if (text && *text == '@') {
        status = curve_read(text + 1, "temperature", axes, low, TEMPERATURE_MAX, curve);
        if (!status) *temperature = curve_at(curve, 0);
    } else if (text) {
        status = options_number_or_table("--wall: a temperature", text, low, TEMPERATURE_MAX, temperature);
    }
    return status;
}

/* A wall that stores heat ends somewhere, and has one temperature at the beginning. */
static int check_capacity(const struct given_options *options, const struct bed *bed, const struct walls *walls,
                          uint32_t k) {
    const struct wall_words *said = &walls->said[k];
    const char *name = wall_name(walls, k);
    const bool endless = wall_endless(walls, bed, &walls->wall[k]);
    if (!(said->given & WALL_CAPACITY)) return STATUS_OK;
    if (!options->timed) return message(STATUS_USAGE, "--wall: %s: capacity needs --until", name);
    if (endless || said->given & WALL_INSULATED)
        return message(STATUS_USAGE, "--wall: %s is %s and stores no heat", name, endless ? "endless" : "insulated");
    if (said->temperature_text && *said->temperature_text != '@') return STATUS_OK;
    return message(STATUS_USAGE, "--wall: %s has a capacity and needs the temperature at which it begins, %s:%s", name,
                   name, "temperature=300 for example");
}

/* Each wall has a temperature, has a power, or is insulated. */
static int given_walls(const struct given_options *options, const struct bed *bed, const struct walls *walls,
                       struct given *given) {
    int status = STATUS_OK;
    for (uint32_t k = 0; k < walls->count && !status; ++k) {
        const struct wall_words *said = &walls->said[k];
        const char *name = wall_name(walls, k);
        double *temperature = &given->wall_temperature[k];
        if (!(said->given & WALL_HEAT))
            return message(STATUS_USAGE,
                           "--wall: %s has no temperature; give %s:temperature=NUMBER, %s:power=NUMBER or %s:insulated",
                           name, name, name, name);
        given->wall_power[k] = said->power;
        given->insulated[k] = (said->given & WALL_INSULATED) != 0;
        status = check_capacity(options, bed, walls, k);
        if (status) return status;
        status = wall_temperature(options, said, name, &given->curve[k], &given->column[k], temperature);
        *temperature += options->zero;
        if (said->given & WALL_POWER && wall_endless(walls, bed, &walls->wall[k]))
            return message(STATUS_USAGE, "--wall: %s is endless and needs a temperature", name);
    }
    return status;
}

/* Temperatures of the sides of a mesh from a column of numbers. The wall gets the temperature at which it emits as much
 * as its triangles together. */
static int given_triangles(const struct walls *walls, uint32_t wall, const struct curve *column, double zero,
                           struct given *given) {
    const struct mesh *mesh = walls->meshes ? mesh_of_wall(walls->meshes, wall) : NULL;
    const char *name = wall_name(walls, wall);
    double sum = 0, areas = 0;
    if (!mesh) return message(STATUS_USAGE, "--wall: %s has no triangles", name);
    if (column->n != mesh->surface.given)
        return message(STATUS_INPUT, "--wall: temperatures of %s: %zu numbers; %s has %u triangles", name, column->n,
                       mesh->file, mesh->surface.given);
    for (uint32_t t = 0; t < mesh->surface.n; ++t) {
        if (mesh_wall(mesh, t) != wall) continue;
        const double kelvins = column->y[mesh->surface.number[t]] + zero, area = surface_area(&mesh->surface, t);
        double *side = given->side_temperature + 2 * ((size_t)mesh->first + t);
        side[0] = side[1] = kelvins;
        sum += area * gsl_pow_4(kelvins), areas += area;
    }
    given->wall_temperature[wall] = pow(sum / areas, 0.25);
    return STATUS_OK;
}

/* Temperatures of the sides of all meshes that have a column. NaN: the side belongs to a mesh without a column. */
static int given_sides(const struct walls *walls, double zero, struct given *given) {
    int status = STATUS_OK;
    for (uint32_t k = 0; k < walls->count && !status; ++k) {
        const struct curve *column = &given->column[k];
        if (column->n == 0) continue;
        const size_t sides = walls->meshes ? 2 * (size_t)walls->meshes->triangles.n : 0;
        if (!given->side_temperature) {
            given->side_temperature = malloc((sides + 1) * sizeof(double));
            if (!given->side_temperature) return message_memory();
            for (size_t s = 0; s < sides; ++s) given->side_temperature[s] = NAN;
        }
        status = given_triangles(walls, k, column, zero, given);
    }
    return status;
}

/* One quantity, temperature or power, has a column or a list. If the other quantity has one number, the number is for
 * the spheres that the column or list leaves out. */
static int leave_out(const char *option, const struct quantity *number, const double *others, uint32_t n,
                     double *values) {
    bool used = false;
    for (uint32_t i = 0; i < n; ++i)
        if (isnan(others[i]))
            used = true;
        else
            values[i] = NAN;
    if (used) return STATUS_OK;
    return message(
        STATUS_USAGE,
        "%s %g is for no sphere: each sphere has the other quantity; a blank or nan in its column leaves a sphere out",
        option, number->value);
}

static int given_spheres(const struct bed *bed, const char *file, struct given *given) {
    for (uint32_t i = 0; i < bed->n; ++i) {
        const bool t = !isnan(given->temperature[i]);
        if (t == !isnan(given->power[i]))
            return message_at(STATUS_INPUT, file, bed->line[i], "sphere %lld has %s", (long long)bed_name(bed, i),
                              t ? "both a temperature and a power" : "neither a temperature nor a power");
    }
    return STATUS_OK;
}

int given_reflectors(const struct given *given, const double *emissivity, const struct walls *walls,
                     const double *wall_emissivity, const struct bed *bed, const char *file) {
    for (uint32_t k = 0; k < walls->count; ++k)
        if (wall_emissivity[k] == 0 && !isnan(given->wall_power[k]) && given->wall_power[k] != 0)
            return message(STATUS_USAGE, "--wall: %s has emissivity 0 and cannot give off a power",
                           wall_name(walls, k));
    for (uint32_t i = 0; i < bed->n; ++i)
        if (emissivity[i] == 0 && !isnan(given->power[i]) && given->power[i] != 0)
            return message_at(STATUS_INPUT, file, bed->line[i], "sphere %lld has emissivity 0 and cannot give off %g W",
                              (long long)bed_name(bed, i), given->power[i]);
    return STATUS_OK;
}

int given_values(const struct given_options *options, const struct bed *bed, const char *file,
                 const struct walls *walls, struct given *given) {
    *given = (struct given){.temperature = NULL};
    int status = given_walls(options, bed, walls, given);
    if (!status) status = given_sides(walls, options->zero, given);
    if (!status)
        status = quantity_values(&options->temperature, bed, file, "temperature in kelvins", options->zero, 0,
                                 TEMPERATURE_MAX, &given->temperature);
    if (!status) status = quantity_values(&options->power, bed, file, "power", 0, -POWER_MAX, POWER_MAX, &given->power);
    const struct quantity *t = &options->temperature, *p = &options->power;
    if (!status && !options->timed && t->column && p->given && !p->column)
        status = leave_out("--power", p, given->temperature, bed->n, given->power);
    if (!status && !options->timed && p->column && t->given && !t->column)
        status = leave_out("--temperature", t, given->power, bed->n, given->temperature);
    for (uint32_t i = 0; i < bed->n && !status && options->timed; ++i)
        if (isnan(given->power[i])) given->power[i] = 0;
    return status || options->timed ? status : given_spheres(bed, file, given);
}

void given_free(struct given *given) {
    free(given->temperature);
    free(given->power);
    free(given->side_temperature);
    for (int k = 0; k < WALLS_MAX; ++k) curve_free(&given->curve[k]), curve_free(&given->column[k]);
}

void given_heat_sources(struct given *given, uint32_t n, double square_metres, fibrad_heat_sources *sources) {
    for (uint32_t i = 0; i < n; ++i) given->power[i] /= square_metres;
    for (uint32_t k = 0; k < WALLS_MAX; ++k) given->wall_power[k] /= square_metres;
    sources->temperature = given->temperature, sources->power = given->power;
    sources->wall_temperature = given->wall_temperature, sources->wall_power = given->wall_power;
    sources->insulated = given->insulated, sources->side_temperature = given->side_temperature;
}
