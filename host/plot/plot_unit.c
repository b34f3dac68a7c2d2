/* plot_unit.c - units with prefixes, so that the numbers of a panel have few digits. SPDX-License-Identifier: MIT */
#include "plot/plot_unit.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

struct plot_unit plot_unit_of(double largest, const char *unit) {
    enum { PREFIXES = 4 }; /* to each side of none */
    static const char *const prefix[] = {"p", "n", "\302\265", "m", "", "k", "M", "G", "T"};
    const bool few_digits = !(largest > 0) || (largest >= 0.1 && largest < 999.5);
    const int thousands = few_digits ? 0 : (int)floor(log10(largest) / 3);
    struct plot_unit made = {.scale = pow(1000, thousands)};
    if (*unit && abs(thousands) <= PREFIXES)
        snprintf(made.name, sizeof made.name, "%s%.12s", prefix[PREFIXES + thousands], unit);
    else if (thousands)
        snprintf(made.name, sizeof made.name, "10^{%d}%s%.12s", 3 * thousands, *unit ? " " : "", unit);
    return made;
}
