/* contact_option.c - heat that contacts and gas conduct, from options. SPDX-License-Identifier: MIT */
#include "contact_options/contact_option.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define ROUNDING 1e-12 /* of flows, over the sum of their magnitudes */

int contacts_option(const char *text, void *contact_options) {
    struct contact_options *options = contact_options;
    const int spots = strcmp(text, "lens") == 0    ? FIBRAD_SPOTS_LENS
                      : strcmp(text, "hertz") == 0 ? FIBRAD_SPOTS_HERTZ
                                                   : 0;
    if (spots && options->spots && options->spots != spots)
        return message(STATUS_USAGE, "--contacts: lens and hertz cannot be combined");
    if (spots) {
        options->spots = spots;
        return STATUS_OK;
    }
    if (!strchr(text, '*') && strcmp(text, "-") != 0 && access(text, F_OK) != 0)
        return message(STATUS_FILE, "--contacts: '%.200s' is neither lens nor hertz, nor a file that exists", text);
    if (options->files == CONTACT_FILES_MAX)
        return message(STATUS_USAGE, "--contacts: more than %d files", CONTACT_FILES_MAX);
    options->file[options->files++] = text;
    return STATUS_OK;
}

int contact_conductivity_option(const char *text, void *conductivity) {
    return table_option("--contact-conductivity", text, &solid_axes, SOLID_CONDUCTIVITY_MIN, SOLID_CONDUCTIVITY_MAX,
                        conductivity);
}

bool contacts_given(const struct contact_options *options) {
    return options->spots || options->files > 0 || options->gas;
}

/* Names an option that needs another one. NULL: there is none. */
static const char *idle_option(const struct contact_options *o) {
    if (!contacts_given(o)) {
        if (o->flows) return "--contact-flows needs --contacts or --gas-conductivity";
        if (o->conductivity.given)
            return "--contact-conductivity needs --contacts lens or hertz, or --gas-conductivity";
    }
    if (!o->gas && (o->gap > 0 || o->jump > 0)) return "--gas-gap and --gas-jump need --gas-conductivity";
    if (!o->spots && o->scale > 0) return "--contact-scale needs --contacts lens or hertz";
    return NULL;
}

int contacts_check(struct contact_options *options, struct bed_options *bed, bool solid) {
    const char *idle = idle_option(options);
    if (idle) return message(STATUS_USAGE, "%s", idle);
    if ((options->spots || options->gas) && !options->conductivity.given && !solid)
        return message(STATUS_USAGE, "%s needs --contact-conductivity or --solid-conductivity",
                       options->spots ? "--contacts lens or hertz" : "--gas-conductivity");
    bed_options_quantity(bed, &options->conductivity, SOLID_UNIT);
    if (!options->gas) return STATUS_OK;
    if (*options->gas != '@')
        return options_number("--gas-conductivity", options->gas, SOLID_CONDUCTIVITY_MIN, SOLID_CONDUCTIVITY_MAX,
                              &options->gas_value);
    const int status = curve_read(options->gas + 1, "conductivity", &solid_axes, SOLID_CONDUCTIVITY_MIN,
                                  SOLID_CONDUCTIVITY_MAX, &options->gas_curve);
    if (!status) options->gas_value = options->gas_curve.y[options->gas_curve.n / 2];
    return status;
}

/* Finds contacts of overlaps and gas. */
static int find_contacts(struct contact_state *state, struct bed_options *bed_options, const struct bed *bed,
                         fibrad_bed *made, const struct quantity *solid) {
    const struct contact_options *o = state->options;
    if (!o->spots && !o->gas) return STATUS_OK;
    state->of_solid = o->conductivity.given ? &o->conductivity : solid;
    state->rule = (fibrad_contact_rule){.spots = o->spots, .scale = o->scale, .gas_alone = solid->given};
    if (o->gas) {
        state->rule.gas_reach = o->gap > 0 ? o->gap : FIBRAD_GAS_REACH_DEFAULT;
        state->rule.gas_jump = o->jump / bed->metres, state->rule.gas_least = FIBRAD_GAS_LEAST_DEFAULT / bed->metres;
    }
    int status = solid_values(bed_options, bed, state->of_solid, &state->solid);
    if (status) return status;
    status = fibrad_bed_contacts(made, &state->rule, &state->list);
    return status ? bed_options_status(bed_options, bed, status, &(fibrad_fault){0}) : STATUS_OK;
}

/* Puts the contacts of files and those that were found one behind the other. */
static int join_contacts(struct contact_state *state, uint32_t spheres, struct contact_lines *lines) {
    const uint32_t found = state->list ? state->list->n : 0;
    if (found > UINT32_MAX - lines->n) return message(STATUS_INPUT, "too many contacts");
    const size_t n = (size_t)lines->n + found;
    const int status = contacts_resize(lines, n + 1);
    if (status) return status;
    state->flow = calloc(n + 1, sizeof *state->flow), state->error = calloc(n + 1, sizeof *state->error);
    state->gas = calloc(found + (size_t)1, sizeof *state->gas);
    state->conducted = calloc(spheres + (size_t)1, sizeof *state->conducted);
    if (!state->flow || !state->error || !state->gas || !state->conducted) return message_memory();
    for (uint32_t k = 0; k < lines->n; ++k) lines->conductance[k] *= state->per_watt;
    for (uint32_t k = 0; k < found; ++k)
        lines->first[lines->n + k] = state->list->first[k], lines->second[lines->n + k] = state->list->second[k];
    state->n = (uint32_t)n, state->listed = lines->n;
    return STATUS_OK;
}

int contacts_begin(struct contact_state *state, const struct contact_options *options, struct bed_options *bed_options,
                   const struct bed *bed, fibrad_bed *made, const struct walls *walls, const struct quantity *solid,
                   double per_watt, fibrad_heat_sources *sources) {
    struct contact_lines lines = {0};
    *state = (struct contact_state){.per_watt = per_watt};
    sources->contacts = 0;
    if (!contacts_given(options)) return STATUS_OK;
    state->options = options;
    int status = STATUS_OK;
    for (uint32_t k = 0; k < options->files && !status; ++k)
        status = contacts_read(options->file[k], bed, walls, &lines);
    if (!status) status = find_contacts(state, bed_options, bed, made, solid);
    if (!status) status = join_contacts(state, bed->n, &lines);
    state->first = lines.first, state->second = lines.second, state->conductance = lines.conductance;
    if (status) return status;
    contacts_follow(state, bed, sources->temperature, sources->wall_temperature);
    sources->contact_first = state->first, sources->contact_second = state->second;
    sources->conductance = state->conductance, sources->contacts = state->n;
    return STATUS_OK;
}

void contacts_free(struct contact_state *state) {
    free(state->first);
    free(state->second);
    free(state->conductance);
    free(state->flow);
    free(state->error);
    free(state->gas);
    free(state->solid);
    free(state->conducted);
    free(state->side);
    free(state->temperature);
    *state = (struct contact_state){0};
}

/* The temperature of an end. NaN: not known. */
static double temperature_of_end(const struct bed *bed, const double *temperature, const double *wall_temperature,
                                 uint32_t end) {
    if (end < bed->n) return temperature ? temperature[end] : NAN;
    return wall_temperature ? wall_temperature[end - bed->n] : NAN;
}

/* The mean of the temperatures of both ends of a contact that was found; that of one end if the other's is not known.
 */
static double temperature_of_contact(const struct contact_state *state, const struct bed *bed,
                                     const double *temperature, const double *wall_temperature, uint32_t k) {
    const double i = temperature_of_end(bed, temperature, wall_temperature, state->list->first[k]),
                 j = temperature_of_end(bed, temperature, wall_temperature, state->list->second[k]);
    return isnan(i) ? j : isnan(j) ? i : (i + j) / 2;
}

void contacts_excess(struct contact_state *state, const struct bed *bed, const double *temperature,
                     const double *wall_temperature, struct table_excess excess[2]) {
    const struct contact_options *o = state->options;
    if (!o || !state->list) return;
    if (state->of_solid == &o->conductivity) quantity_excess(state->of_solid, bed, temperature, &excess[0]);
    if (!o->gas || o->gas_curve.n == 0) return;
    for (uint32_t k = 0; k < state->list->n; ++k)
        state->gas[k] = temperature_of_contact(state, bed, temperature, wall_temperature, k);
    curve_excess(&o->gas_curve, state->list->n, state->gas, &excess[1]);
    contacts_follow(state, bed, temperature, wall_temperature);
}

void contacts_warn(struct warned *warned, const struct table_excess excess[2]) {
    warn_table(warned, CONTACT_TABLE, &excess[0]);
    warn_table(warned, GAS_TABLE, &excess[1]);
}

void contacts_follow(struct contact_state *state, const struct bed *bed, const double *temperature,
                     const double *wall_temperature) {
    const struct contact_options *o = state->options;
    if (!o || !state->list) return;
    if (temperature) quantity_follow(state->of_solid, bed, temperature, state->solid);
    for (uint32_t k = 0; k < state->list->n && o->gas; ++k) {
        const double mean = temperature_of_contact(state, bed, temperature, wall_temperature, k);
        state->gas[k] = o->gas_curve.n > 0 && !isnan(mean) ? curve_at(&o->gas_curve, mean) : o->gas_value;
    }
    double *conductance = state->conductance + state->listed;
    fibrad_contacts_conduct(state->list, &state->rule, state->solid, o->gas ? state->gas : NULL, conductance);
    for (uint32_t k = 0; k < state->list->n; ++k) conductance[k] *= bed->metres * state->per_watt;
}

void contacts_result(struct contact_state *state, fibrad_heat_result *result) {
    if (!state->options) return;
    result->conducted = state->conducted, result->wall_conducted = state->wall, result->contact_flow = state->flow;
    result->contact_error = state->error;
}

void contacts_scale(struct contact_state *state, uint32_t spheres, uint32_t walls) {
    if (!state->options) return;
    for (uint32_t i = 0; i < spheres; ++i) state->conducted[i] /= state->per_watt;
    for (uint32_t k = 0; k < walls; ++k) state->wall[k] /= state->per_watt;
    for (uint32_t k = 0; k < state->n; ++k) state->flow[k] /= state->per_watt, state->error[k] /= state->per_watt;
}

double contacts_error(const struct contact_state *state) {
    double flows = 0, errors = 0;
    for (uint32_t k = 0; k < state->n; ++k)
        flows += state->flow[k] * state->flow[k], errors += state->error[k] * state->error[k];
    return flows > 0 ? sqrt(errors / flows) : 0;
}

/* Writes the name of an end. */
static void write_end(FILE *file, const struct bed *bed, const struct walls *walls, uint32_t end) {
    if (end < bed->n)
        fprintf(file, "%lld,", (long long)bed_name(bed, end));
    else
        fprintf(file, "%s,", wall_name(walls, end - bed->n));
}

int contacts_write(const struct contact_state *state, const struct bed *bed, const struct walls *walls) {
    struct output output = {0};
    char path[OUTPUT_PATH];
    if (!state->options || !state->options->flows) return STATUS_OK;
    int status = output_numbered(state->options->flows, bed->frame, path);
    if (!status) status = output_open(&output, path);
    if (status) return status;
    fputs("i,j,W/K,W,error_W\n", output.file);
    for (uint32_t k = 0; k < state->n; ++k) {
        write_end(output.file, bed, walls, state->first[k]);
        write_end(output.file, bed, walls, state->second[k]);
        fprintf(output.file, "%.9g,%.9g,%.3g\n", state->conductance[k] / state->per_watt, state->flow[k],
                state->error[k]);
    }
    return output_close(&output, output_flush(&output));
}

void contacts_report(const struct contact_state *state, const struct bed *bed, const struct walls *walls,
                     struct report *report) {
    double conducted = 0, conductance = 0;
    if (!state->options) return;
    for (uint32_t k = 0; k < state->n; ++k) conducted += fabs(state->flow[k]), conductance += state->conductance[k];
    report_count(report, "contacts", state->n);
    quantity_report(&state->options->conductivity, "contact_conductivity", report);
    if (state->options->gas && state->options->gas_curve.n == 0)
        report_value(report, "gas_conductivity", state->options->gas_value, 6);
    if (state->n > 0) report_value(report, "conductance_mean_W_K", conductance / state->per_watt / state->n, 6);
    if (state->n > 0) report_value(report, "contact_flow_mean_W", conducted / state->n, 6);
    if (state->n > 0) report_value(report, "error_of_flows", contacts_error(state), 2);
    double square = 0, sum = 0;
    for (uint32_t i = 0; i < bed->n; ++i)
        square += state->conducted[i] * state->conducted[i], sum += state->conducted[i];
    report_value(report, "conduction_rms_W", sqrt(square / bed->n), 6);
    report_value(report, "spheres_conduction_W", fabs(sum) > ROUNDING * conducted ? sum : 0, 6);
    wall_values_report(walls, state->wall, "_conduction_W", 6, report);
}

int contacts_refuse(const struct contact_state *state, const struct bed_options *options, const struct bed *bed,
                    const struct walls *walls, int status, const fibrad_fault *fault) {
    if (!state->options || !status) return STATUS_OK;
    if (fault->why == FIBRAD_WHY_TOUCHED)
        return message(
            STATUS_USAGE,
            "wall %s is in contact and needs one temperature, or a power: --wall %s:power=0 if it is insulated",
            wall_name(walls, fault->wall - 1), wall_name(walls, fault->wall - 1));
    if (fault->why == FIBRAD_WHY_REFLECTS && fault->first < bed->n)
        return message_at(STATUS_INPUT, options->name, bed->line[fault->first],
                          "sphere %lld has emissivity 0 and no contact, and cannot give off a power",
                          (long long)bed_name(bed, fault->first));
    if (fault->why == FIBRAD_WHY_ALONE)
        return message_at(STATUS_INPUT, options->name, bed->line[fault->first],
                          "sphere %lld has emissivity 0, and nothing that it touches radiates or has a temperature",
                          (long long)bed_name(bed, fault->first));
    return STATUS_OK;
}
