/* emissivity.c - emissivities of spheres and walls from options and columns. SPDX-License-Identifier: MIT */
#include "emissivity.h"

#include <ctype.h>
#include <stdlib.h>

#include "message.h"
#include "options.h"

int emissivity_option(const char *text, struct emissivity_option *option) {
    *option = (struct emissivity_option){0};
    if (isalpha((unsigned char)*text) || *text == '_') {
        option->column = text;
        return STATUS_OK;
    }
    const int status = options_number("--emissivity", text, 0, 1, &option->value);
    if (!status && !(option->value > 0))
        return message(STATUS_USAGE, "--emissivity: '%.60s' is neither a number above 0 up to 1 nor a column", text);
    return status;
}

int emissivity_of(const struct emissivity_option *option, const struct bed *bed, const char *file, size_t extra,
                  double **emissivity) {
    double *e = *emissivity = malloc(bed->n * sizeof *e);
    if (!e) return message_memory();
    for (uint32_t i = 0; i < bed->n; ++i) {
        e[i] = option->column ? bed->extra[i * bed->extras + extra] : option->value;
        if (!(e[i] > 0 && e[i] <= 1))
            return message_at(STATUS_INPUT, file, bed->line[i],
                              "the emissivity %.40s is %g; it must be above 0, up to 1", option->column, e[i]);
    }
    return STATUS_OK;
}

int emissivity_walls(const char *text, const struct wall_order *order, double emissivity[FIBRAD_WALLS]) {
    double given[FIBRAD_WALLS] = {1};
    int count = 1;
    for (int wall = 0; wall < FIBRAD_WALLS; ++wall) emissivity[wall] = 1;
    const int status = text ? options_numbers("--wall-emissivity", text, FIBRAD_WALLS, given, &count) : STATUS_OK;
    if (status) return status;
    if (text && (count < 1 || (uint32_t)count > order->count))
        return message(STATUS_USAGE, "--wall-emissivity: %d for %u walls", count, order->count);
    for (int k = 0; k < count; ++k)
        if (!(given[k] >= 0 && given[k] <= 1))
            return message(STATUS_USAGE, "--wall-emissivity: %g is not in 0 to 1", given[k]);
    for (uint32_t k = 0; k < order->count; ++k)
        emissivity[order->wall[k]] = given[k < (uint32_t)count ? k : (uint32_t)count - 1];
    return STATUS_OK;
}
