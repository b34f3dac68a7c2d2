/* property_option.c - emissivities and temperatures of spheres and walls, from options and columns of the file.
 * SPDX-License-Identifier: MIT */
#include "bed/property_option.h"

#include <ctype.h>
#include <stdlib.h>

#include "cli/message.h"
#include "cli/options.h"

static int take_quantity(const char *what, const char *text, double most, struct quantity *quantity) {
    *quantity = (struct quantity){.given = true};
    if (!isalpha((unsigned char)*text) && *text != '_') return options_number(what, text, 0, most, &quantity->value);
    quantity->column = text;
    return STATUS_OK;
}

int emissivity_option(const char *text, struct quantity *emissivity) {
    const int status = take_quantity("--emissivity", text, 1, emissivity);
    if (!status && !emissivity->column && !(emissivity->value > 0))
        return message(STATUS_USAGE, "--emissivity: '%.60s' is neither a number above 0 up to 1 nor a column", text);
    return status;
}

int temperature_option(const char *text, struct quantity *temperature) {
    return take_quantity("--temperature", text, TEMPERATURE_MAX, temperature);
}

static double *spread_spheres(const struct quantity *quantity, const struct bed *bed) {
    double *values = malloc(bed->n * sizeof *values);
    for (uint32_t i = 0; values && i < bed->n; ++i)
        values[i] = quantity->column ? bed->extra[i * bed->extras + quantity->place] : quantity->value;
    return values;
}

int emissivity_of(const struct quantity *quantity, const struct bed *bed, const char *file, double **emissivity) {
    const double *e = *emissivity = spread_spheres(quantity, bed);
    if (!e) return message_memory();
    for (uint32_t i = 0; i < bed->n; ++i)
        if (!(e[i] > 0 && e[i] <= 1))
            return message_at(STATUS_INPUT, file, bed->line[i],
                              "the emissivity %.40s is %g; it must be above 0, up to 1", quantity->column, e[i]);
    return STATUS_OK;
}

int temperature_of(const struct quantity *quantity, const struct bed *bed, const char *file, double **temperature) {
    const double *t = *temperature = spread_spheres(quantity, bed);
    if (!t) return message_memory();
    for (uint32_t i = 0; i < bed->n; ++i)
        if (!(t[i] >= 0 && t[i] <= TEMPERATURE_MAX))
            return message_at(STATUS_INPUT, file, bed->line[i], "the temperature is %g K", t[i]);
    return STATUS_OK;
}

/* The list over the walls, its last number for all further ones; `otherwise` if there is no list. */
static int spread_walls(const char *what, const char *text, double otherwise, uint32_t walls,
                        double values[WALLS_MAX]) {
    int count = 1;
    values[0] = otherwise;
    const int status = text ? options_numbers(what, text, WALLS_MAX, values, &count) : STATUS_OK;
    if (!status && text && (uint32_t)count > walls)
        return message(STATUS_USAGE, "%s: %d for %u walls", what, count, walls);
    for (int k = count; k < WALLS_MAX && !status; ++k) values[k] = values[count - 1];
    return status;
}

int emissivity_walls(const char *text, uint32_t walls, double e[WALLS_MAX]) {
    const int status = spread_walls("--wall-emissivity", text, 1, walls, e);
    for (uint32_t k = 0; k < walls && !status; ++k)
        if (!(e[k] >= 0 && e[k] <= 1)) return message(STATUS_USAGE, "--wall-emissivity: %g is not in 0 to 1", e[k]);
    return status;
}

int temperature_walls(const char *text, uint32_t walls, double surroundings, double t[WALLS_MAX]) {
    const int status = spread_walls("--wall-temperature", text, surroundings, walls, t);
    for (uint32_t k = 0; k < walls && !status; ++k)
        if (!(t[k] >= 0 && t[k] <= TEMPERATURE_MAX))
            return message(STATUS_USAGE, "--wall-temperature: %g is no temperature", t[k]);
    return status;
}
