/* solid_option.c - the conductivity of the solid that spheres are made of. SPDX-License-Identifier: MIT */
#include "frames/solid_option.h"

#include <math.h>
#include <stdlib.h>

const struct curve_axes solid_axes = {CURVE_AXIS_KELVINS, {"k lambda conductivity", SOLID_UNIT}};

int solid_option(const char *text, void *solid) {
    struct quantity *quantity = solid;
    const int status = table_option("--solid-conductivity", text, &solid_axes, SOLID_CONDUCTIVITY_MIN,
                                    SOLID_CONDUCTIVITY_MAX, quantity);
    quantity->some = !quantity->types;
    return status;
}

int solid_values(const struct bed_options *options, const struct bed *bed, const struct quantity *solid,
                 double **conductivity) {
    const int status = quantity_values(solid, bed, options->name, "conductivity of the solid", 0,
                                       SOLID_CONDUCTIVITY_MIN, SOLID_CONDUCTIVITY_MAX, conductivity);
    for (uint32_t i = 0; i < bed->n && !status; ++i)
        if (isnan((*conductivity)[i])) (*conductivity)[i] = INFINITY;
    return status;
}

int solid_relative(struct bed_options *options, const struct bed *bed, const struct quantity *solid,
                   const double *temperature, double *relative) {
    struct table_excess excess = {0};
    double *conductivity;
    int status = solid_values(options, bed, solid, &conductivity);
    if (!status) {
        quantity_follow(solid, bed, temperature, conductivity);
        quantity_excess(solid, bed, temperature, &excess);
        warn_table(&options->warned, SOLID_TABLE, &excess);
    }
    for (uint32_t i = 0; i < bed->n && !status; ++i) {
        relative[i] = fibrad_relative_conductivity(conductivity[i], bed->r[i] * bed->metres, temperature[i],
                                                   FIBRAD_STEFAN_BOLTZMANN);
        if (relative[i] < FIBRAD_RELATIVE_CONDUCTIVITY_MIN)
            status = message_at(STATUS_INPUT, options->name, bed->line[i],
                                "sphere %lld: k_s/(4 d sigma T^3) is %g; it must be at least %g",
                                (long long)bed_name(bed, i), relative[i], FIBRAD_RELATIVE_CONDUCTIVITY_MIN);
    }
    free(conductivity);
    return status;
}

void solid_report(const struct quantity *solid, const struct k_star *all, struct report *report) {
    quantity_report(solid, "solid_conductivity", report);
    report_value(report, "k_star", k_star_mean(all), 4);
    if (all->least == all->largest) return;
    report_value(report, "k_star_min", all->least, 4);
    report_value(report, "k_star_max", all->largest, 4);
}
