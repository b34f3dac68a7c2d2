/* units.c - units of length and temperature by name; prefixes of units in pictures. SPDX-License-Identifier: MIT */
#include "bed/units.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"

static const struct {
    const char *name;
    double metres;
} units[] = {{"m", 1},
             {"si", 1},
             {"cm", 1e-2},
             {"cgs", 1e-2},
             {"mm", 1e-3},
             {"um", 1e-6},
             {"micro", 1e-6},
             {"nm", 1e-9},
             {"nano", 1e-9},
             {"angstrom", 1e-10},
             {"real", 1e-10},
             {"metal", 1e-10},
             {"electron", 5.29177210903e-11},
             {"lj", 0}};

bool unit_of_length(const char *name, double *metres) {
    for (size_t k = 0; k < sizeof units / sizeof *units; ++k)
        if (strcmp(name, units[k].name) == 0) {
            *metres = units[k].metres;
            return true;
        }
    return false;
}

const char *temperature_unit(double zero) { return zero > 0 ? "C" : "K"; }

int temperature_unit_option(const char *text, void *zero) {
    if (strcmp(text, "K") != 0 && strcmp(text, "C") != 0)
        return message(STATUS_USAGE, "--temperature-unit: '%.40s' is neither K nor C", text);
    *(double *)zero = *text == 'C' ? KELVIN_OF_0_CELSIUS : 0;
    return STATUS_OK;
}

struct prefixed unit_prefixed(double largest, const char *unit) {
    enum { PREFIXES = 4 }; /* to each side of none */
    static const char *const prefix[] = {"p", "n", "\302\265", "m", "", "k", "M", "G", "T"};
    const bool few_digits = !(largest > 0) || (largest >= 0.1 && largest < 999.5);
    const int thousands = few_digits ? 0 : (int)floor(log10(largest) / 3);
    struct prefixed made = {.scale = pow(1000, thousands)};
    if (*unit && abs(thousands) <= PREFIXES)
        snprintf(made.name, sizeof made.name, "%s%.12s", prefix[PREFIXES + thousands], unit);
    else if (thousands)
        snprintf(made.name, sizeof made.name, "10^{%d}%s%.12s", 3 * thousands, *unit ? " " : "", unit);
    return made;
}

struct prefixed unit_seconds(double largest) {
    static const struct prefixed unit[] = {{86400, "d"}, {3600, "h"}, {60, "min"}};
    for (size_t k = 0; k < sizeof unit / sizeof *unit; ++k)
        if (largest >= 2 * unit[k].scale) return unit[k];
    return unit_prefixed(largest, "s");
}
