/* heat_figures.c - the figures of the summary of `fibrad heat`, and the summary. SPDX-License-Identifier: MIT */
#include <gsl/gsl_math.h>
#include <omp.h>

#include "heat/heat.h"

/* The error of the power of the surroundings over the larger of two powers: that of the surroundings, and SMALL_SHARE
 * of all that is exchanged. */
#define SMALL_SHARE .05
static double outside_error(const struct heat *h) {
    const fibrad_heat_result *result = &h->result;
    double sum = fabs(result->surroundings_power);
    for (uint32_t i = 0; i < h->bed->n; ++i) sum += fabs(result->power[i]);
    for (uint32_t k = 0; k < h->walls.count; ++k) sum += fabs(result->wall_power[k]);
    const double error = result->surroundings_error;
    return error > 0 ? error / fmax(fabs(result->surroundings_power), SMALL_SHARE * sum / 2) : 0;
}

/* heat_figures.wall_error. d(T^4)/T^4 = 4 dT/T. What insulated walls send back goes to the surroundings in the end, so
 * that the error of such walls is that of the surroundings, too. */
static double worst_wall(const struct heat *h) {
    const fibrad_heat_result *result = &h->result;
    double worst = heat_insulates(h) ? outside_error(h) : 0;
    for (uint32_t k = 0; k < h->walls.count; ++k) {
        if (result->wall_error[k] > 0)
            worst = fmax(worst, result->wall_error[k] / fmax(fabs(result->wall_power[k]), result->wall_absorbed[k]));
        if (result->wall_temperature_error[k] > 0)
            worst = fmax(worst, 4 * result->wall_temperature_error[k] / result->wall_temperature[k]);
    }
    return worst;
}

void heat_find_figures(struct heat *h) {
    const fibrad_heat_result *result = &h->result;
    struct heat_figures *f = &h->figures;
    const double sphere = 4 * M_PI * FIBRAD_STEFAN_BOLTZMANN * h->bed->metres * h->bed->metres;
    double square = 0, squares = 0, throughput = 0, balance = result->surroundings_power + result->gas_power;
    f->largest = fabs(result->surroundings_power);
    for (uint32_t k = 0; k < h->walls.count; ++k) {
        balance += result->wall_power[k];
        f->largest = fmax(f->largest, fabs(result->wall_power[k]));
    }
    f->emitted = 0;
    for (uint32_t i = 0; i < h->bed->n; ++i) {
        const double power = result->power[i], not_radiated = (result->conducted ? result->conducted[i] : 0) +
                                                              (result->convected ? result->convected[i] : 0);
        const double emissivity = h->emissivity[i], r = h->bed->r[i];
        const double part = h->clumps.area ? h->clumps.area[i] / (4 * M_PI * r * r) : 1;
        const double emitted =
            emissivity > 0 ? part * (sphere * r * r * emissivity * pow(result->temperature[i], 4)) : 0;
        const double through = fmax(emitted, emitted + power - not_radiated);
        f->emitted += emitted;
        balance += power;
        square += power * power;
        squares += through * through;
        throughput += through;
        f->largest = fmax(f->largest, fabs(power));
    }
    f->power_rms = sqrt(square / h->bed->n);
    f->throughput = sqrt(squares / h->bed->n);
    f->balance_of_emission = throughput > 0 ? balance / throughput : 0;
    f->error = hypot(result->error_patches, result->error_beams);
    f->wall_error = worst_wall(h);
    f->flow_error = h->conductivity ? contacts_error(&h->touching) : 0;
}

/* Figures of surfaces and centres of spheres that conduct. */
static void find_surfaces(struct heat *h) {
    const fibrad_heat_result *result = &h->result;
    struct heat_figures *f = &h->figures;
    double square = 0;
    uint32_t n = 0;
    f->surface_min = INFINITY, f->surface_max = f->centre_max = -INFINITY, f->surface_span = 0;
    for (uint32_t i = 0; i < h->bed->n; ++i) {
        const double low = result->least_temperature[i], high = result->largest_temperature[i];
        if (isnan(low)) continue;
        f->surface_min = fmin(f->surface_min, low), f->surface_max = fmax(f->surface_max, high);
        f->surface_span = fmax(f->surface_span, high - low);
        f->centre_max = fmax(f->centre_max, result->centre_temperature[i]);
        square += gsl_pow_2(result->surface_error[i]), ++n;
    }
    f->surface_error = n > 0 ? sqrt(square / n) : 0;
}

void heat_find_temperatures(struct heat *h) {
    const fibrad_heat_result *result = &h->result;
    struct heat_figures *f = &h->figures;
    double sum = 0, square = 0, errors = 0, emissions = 0;
    f->unknown = 0;
    f->coldest = INFINITY, f->hottest = -INFINITY;
    for (uint32_t i = 0; i < h->bed->n; ++i) {
        const double t = result->temperature[i], error = result->temperature_error[i];
        if (!isnan(h->sources.temperature[i]) || isnan(t)) continue;
        f->unknown++;
        sum += t, square += error * error;
        errors += gsl_pow_2(4 * gsl_pow_3(t) * error), emissions += gsl_pow_8(t);
        f->coldest = fmin(f->coldest, t), f->hottest = fmax(f->hottest, t);
    }
    f->temperature_mean = sum / f->unknown;
    f->temperature_error = sqrt(square / f->unknown);
    f->emission_error = emissions > 0 ? sqrt(errors / emissions) : 0;
    if (h->conductivity) find_surfaces(h);
}

/* Reports conductivities of the solid, and extreme temperatures of surfaces and centres. */
static void report_solid(struct heat *h) {
    const struct heat_figures *f = &h->figures;
    struct report *report = &h->options.report;
    struct k_star all = {0};
    for (uint32_t i = 0; i < h->bed->n; ++i) /* a sphere that reflects all has no temperature */
        k_star_add(&all, fibrad_relative_conductivity(h->conductivity[i], h->bed->r[i] * h->bed->metres,
                                                      h->result.temperature[i], FIBRAD_STEFAN_BOLTZMANN));
    if (all.spheres > 0) solid_report(&h->solid, &all, report);
    if (f->surface_max < 0) return; /* all spheres reflect everything */
    report_measured(report, "surface_min_K", f->surface_min, f->surface_error);
    report_measured(report, "surface_max_K", f->surface_max, f->surface_error);
    report_measured(report, "surface_span_K", f->surface_span, f->surface_error);
    report_value(report, "error_surface_rms_K", f->surface_error, 2);
    report_measured(report, "centre_max_K", f->centre_max, f->surface_error);
}

/* Reports powers of walls and surroundings, and temperatures that were found. */
static void report_powers(struct heat *h) {
    const struct heat_figures *f = &h->figures;
    const fibrad_heat_result *result = &h->result;
    struct report *report = &h->options.report;
    report_value(report, "emitted_W", f->emitted, 6);
    report_measured(report, "power_rms_W", f->power_rms, f->error);
    report_measured(report, "power_largest_W", f->largest, f->error);
    if (h->given.ambient) {
        report_measured(report, "surroundings_W", result->surroundings_power, result->surroundings_error);
        report_value(report, "surroundings_error_W", result->surroundings_error, 2);
    }
    wall_values_report(&h->walls, result->wall_power, "_W", 6, report);
    wall_values_report(&h->walls, result->wall_error, "_error_W", 2, report);
    for (uint32_t k = 0; k < h->walls.count; ++k)
        if (wall_endless(&h->walls, h->bed, &h->walls.wall[k]))
            report_value(report, report_key(report, "wall_%s_part_m2", wall_name(&h->walls, k)), result->wall_area[k],
                         6);
    if (f->unknown == 0) return;
    report_measured(report, "temperature_min_K", f->coldest, f->temperature_error);
    report_measured(report, "temperature_mean_K", f->temperature_mean, f->temperature_error);
    report_measured(report, "temperature_max_K", f->hottest, f->temperature_error);
    report_value(report, "error_temperature_rms_K", f->temperature_error, 2);
}

void heat_report(struct heat *h) {
    const struct heat_figures *f = &h->figures;
    struct report *report = &h->options.report;
    bed_options_report(&h->options, h->bed, &h->walls, &h->facts);
    quantity_report(&h->emissivities, "emissivity", report);
    quantity_report(&h->given.temperature, h->given.zero > 0 ? "temperature_C" : "temperature_K", report);
    quantity_report(&h->given.power, "power_W", report);
    if (h->given.ambient) report_value(report, "surroundings_K", h->sources.surroundings, 6);
    wall_values_report(&h->walls, h->result.wall_temperature, "_K", 6, report);
    wall_values_report(&h->walls, h->wall_emissivity, "_emissivity", 6, report);
    report_count(report, "patches", h->used.patches);
    report_count(report, "directions", h->used.directions);
    report_count(report, "points", h->used.points);
    report_count(report, "threads", (uint64_t)(h->options.threads ? h->options.threads : omp_get_max_threads()));
    report_value(report, "seconds", h->seconds, 3);
    report_count(report, "sweeps", h->result.sweeps);
    report_value(report, "residual", h->result.residual, 2);
    report_powers(h);
    face_report(h);
    light_report(h);
    contacts_report(&h->touching, h->bed, &h->walls, report);
    film_report(h);
    if (h->conductivity) report_solid(h);
    report_value(report, "balance_of_emission", f->balance_of_emission, 2);
    report_value(report, "error_of_emission", f->throughput > 0 ? f->error / f->throughput : 0, 2);
    report_value(report, "error_rms_W", f->error, 2);
    if (h->error > 0)
        report_wanted(report, h->options.name, h->error, h->error, h->error_reached,
                      "the powers of spheres, of a wall, of the T^4 that were found or of flows through contacts");
    report_end(report);
}
