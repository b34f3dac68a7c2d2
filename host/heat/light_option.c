/* light_option.c - light from outside that falls on a bed. SPDX-License-Identifier: MIT */
#include "heat/light_option.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"

enum { TEXT_MAX = 400 };
#define FLUX_MAX 1e15 /* [W/m2] */

/* Reads exactly `count` numbers. */
static int light_numbers(const char *text, const char *form, int count, double *values) {
    int found = 0;
    const int status = options_numbers("--irradiate", text, count, values, &found);
    if (!status && found != count) return message(STATUS_USAGE, "--irradiate: '%.60s' is not %s", text, form);
    return status;
}

/* Takes an angle in radians, or with one of the units mrad and deg, or the word sun. */
static int take_half_angle(const char *text, fibrad_light *light) {
    static const struct {
        const char *name;
        double radians;
    } units[] = {{"", 1}, {"rad", 1}, {"mrad", 1e-3}, {"deg", 3.14159265358979323846 / 180}};
    char *unit;
    const double angle = strtod(text, &unit);
    light->half_angle = strcmp(text, "sun") == 0 ? FIBRAD_SUN_HALF_ANGLE : -1;
    for (size_t k = 0; k < sizeof units / sizeof *units; ++k)
        if (unit > text && strcmp(unit, units[k].name) == 0) light->half_angle = angle * units[k].radians;
    if (light->half_angle >= 0 && light->half_angle <= FIBRAD_HALF_ANGLE_MAX) return STATUS_OK;
    return message(STATUS_USAGE,
                   "--irradiate: half-angle=%.40s is not an angle from 0 to %g radians; half-angle=5mrad is in "
                   "milliradians, half-angle=0.3deg in degrees",
                   text, FIBRAD_HALF_ANGLE_MAX);
}

static int take_disc(const char *text, fibrad_light *light) {
    double v[4];
    const int status = light_numbers(text, "disc=X,Y,Z,R", 4, v);
    if (status) return status;
    if (!(v[3] > 0)) return message(STATUS_USAGE, "--irradiate: the radius of the disc, %g, is not above 0", v[3]);
    light->shape = FIBRAD_LIGHT_DISC;
    memcpy(light->centre, v, sizeof light->centre);
    light->radius = v[3];
    return STATUS_OK;
}

static int take_rectangle(const char *text, fibrad_light *light) {
    double v[4];
    const int status = light_numbers(text, "box=X1,X2,Y1,Y2", 4, v);
    if (status) return status;
    if (!(v[0] < v[1] && v[2] < v[3]))
        return message(STATUS_USAGE, "--irradiate: box=%.60s: X1 must be below X2, and Y1 below Y2", text);
    light->shape = FIBRAD_LIGHT_BOX;
    light->low[0] = v[0], light->high[0] = v[1], light->low[1] = v[2], light->high[1] = v[3];
    return STATUS_OK;
}

/* Takes one of the parts that follow the flux. */
static int take_part(const char *text, fibrad_light *light) {
    const bool shaped = light->shape != FIBRAD_LIGHT_ALL;
    if (strncmp(text, "half-angle=", 11) == 0) return take_half_angle(text + 11, light);
    if (shaped && (strncmp(text, "disc=", 5) == 0 || strncmp(text, "box=", 4) == 0))
        return message(STATUS_USAGE, "--irradiate: a light has one disc or one box");
    if (strncmp(text, "disc=", 5) == 0) return take_disc(text + 5, light);
    if (strncmp(text, "box=", 4) == 0) return take_rectangle(text + 4, light);
    return message(STATUS_USAGE, "--irradiate: '%.60s' is none of half-angle=, disc= and box=", text);
}

int irradiate_option(const char *text, void *light_options) {
    struct light_options *options = light_options;
    char copy[TEXT_MAX], *rest = copy;
    const size_t length = strlen(text);
    if (length >= sizeof copy) return message(STATUS_USAGE, "--irradiate: the text is too long");
    if (options->lights == LIGHTS_MAX) return message(STATUS_USAGE, "--irradiate: more than %d lights", LIGHTS_MAX);
    memcpy(copy, text, length + 1);
    fibrad_light light = {.flux = 0};
    char *part[8];
    size_t parts = 0;
    while (rest && parts < sizeof part / sizeof *part) {
        char *colon = strchr(rest, ':');
        part[parts++] = rest;
        if (colon) *colon = 0;
        rest = colon ? colon + 1 : NULL;
    }
    if (parts < 2 || rest) return message(STATUS_USAGE, "--irradiate: '%.60s' is not DX,DY,DZ:FLUX", text);
    int status = light_numbers(part[0], "DX,DY,DZ", 3, light.direction);
    if (!status) status = options_number("--irradiate: flux", part[1], 0, FLUX_MAX, &light.flux);
    if (!status && light.direction[0] == 0 && light.direction[1] == 0 && light.direction[2] == 0)
        return message(STATUS_USAGE, "--irradiate: the direction 0,0,0 leads nowhere");
    for (size_t k = 2; k < parts && !status; ++k) status = take_part(part[k], &light);
    if (!status && light.shape == FIBRAD_LIGHT_BOX && light.direction[2] == 0)
        return message(STATUS_USAGE, "--irradiate: the box lies across z; give the direction a DZ other than 0");
    if (!status) options->light[options->lights++] = light;
    return status;
}

int profile_option(const char *text, void *light_options) {
    struct light_options *options = light_options;
    const char *rest = text + 1;
    if (!strchr("xyz", text[0]) || !text[0] || *rest != ':')
        return message(STATUS_USAGE, "--profile: '%.60s' is not AXIS:OUT or AXIS:BINS:OUT", text);
    options->axis = text[0];
    const size_t digits = strspn(++rest, "0123456789");
    if (digits > 0 && rest[digits] == ':') {
        char number[24] = "";
        strncat(number, rest, digits < 20 ? digits : 20);
        const int status = options_count("--profile", number, 1, 100000, &options->bins);
        if (status) return status;
        rest += digits + 1;
    }
    if (options->profile) return message(STATUS_USAGE, "--profile is given twice");
    options->profile = rest;
    if (output_ends(rest, ".csv") || output_ends(rest, ".svg") || output_ends(rest, ".png")) return STATUS_OK;
    return message(STATUS_USAGE, "--profile: '%.60s' ends in none of .csv, .svg and .png", rest);
}

int absorptivity_option(const char *text, void *absorptivity) {
    return quantity_option("--absorptivity", text, 0, 1, absorptivity);
}

int light_check(struct light_options *options, struct bed_options *bed, const struct quantity *of_emissivity) {
    const char *needs = options->absorptivity.given  ? "--absorptivity"
                        : options->wall_absorptivity ? "--wall-absorptivity"
                        : options->profile           ? "--profile"
                                                     : NULL;
    if (options->lights == 0) return needs ? message(STATUS_USAGE, "%s needs --irradiate", needs) : STATUS_OK;
    if (!options->absorptivity.given && quantity_curves(of_emissivity))
        return message(STATUS_USAGE, "--irradiate: the emissivity follows the temperature; --absorptivity is missing");
    bed_options_quantity(bed, &options->absorptivity, NULL);
    return STATUS_OK;
}

/* The absorptivity of each wall, or its emissivity. */
static int take_walls(const char *text, const struct walls *walls, const double *emissivity, double *absorptivity) {
    struct wall_list list;
    const int status = wall_list("--wall-absorptivity", text, NULL, 0, 1, walls, NULL, &list);
    for (uint32_t k = 0; k < walls->count && !status; ++k)
        absorptivity[k] = list.named[k] ? list.value[k] : isnan(list.others) ? emissivity[k] : list.others;
    return status;
}

int light_begin(struct light_state *state, const struct light_options *options, const struct bed *bed, const char *file,
                const struct walls *walls, const double *emissivity, const double *wall_emissivity) {
    *state = (struct light_state){0};
    if (options->lights == 0) return STATUS_OK;
    int status = STATUS_OK;
    if (options->absorptivity.given) {
        status = quantity_values(&options->absorptivity, bed, file, "absorptivity", 0, 0, 1, &state->absorptivity);
    } else {
        state->absorptivity = malloc((bed->n + (size_t)1) * sizeof(double));
        if (state->absorptivity) memcpy(state->absorptivity, emissivity, bed->n * sizeof(double));
    }
    if (!status) status = take_walls(options->wall_absorptivity, walls, wall_emissivity, state->of_walls);
    state->absorbed = calloc(bed->n + (size_t)1, sizeof(double));
    state->first = calloc(bed->n + (size_t)1, sizeof(double));
    state->error = calloc(bed->n + (size_t)1, sizeof(double));
    state->power = calloc(bed->n + (size_t)1, sizeof(double));
    state->options = options;
    if (!status && !(state->absorptivity && state->absorbed && state->first && state->error && state->power))
        return message_memory();
    return status;
}

void light_free(struct light_state *state) {
    free(state->absorptivity);
    free(state->absorbed);
    free(state->first);
    free(state->error);
    free(state->power);
    *state = (struct light_state){0};
}

/* The powers of thermal radiation: what is given, and what is absorbed of the light. */
static void add_absorbed(struct light_state *state, const struct bed *bed, const struct walls *walls,
                         fibrad_heat_sources *sources) {
    for (uint32_t i = 0; i < bed->n; ++i)
        state->power[i] = (sources->power ? sources->power[i] : NAN) + state->absorbed[i];
    for (uint32_t k = 0; k < walls->count; ++k)
        state->wall_power[k] = (sources->wall_power ? sources->wall_power[k] : NAN) + state->wall[k];
    sources->power = state->power, sources->wall_power = state->wall_power;
    sources->absorbed = state->result.patches;
}

int light_absorb(struct light_state *state, const struct lit_bed *lit, fibrad_heat_sources *sources) {
    const struct light_options *options = state->options;
    fibrad_light scaled[LIGHTS_MAX];
    if (!options) return FIBRAD_OK;
    for (uint32_t k = 0; k < options->lights; ++k) scaled[k] = options->light[k], scaled[k].flux *= lit->unit;
    fibrad_light_sources light = {.lights = options->lights,
                                  .light = scaled,
                                  .absorptivity = state->absorptivity,
                                  .wall_absorptivity = state->of_walls,
                                  .uniform = sources->uniform};
    state->result = (fibrad_light_result){.absorbed = state->absorbed,
                                          .absorbed_first = state->first,
                                          .absorbed_error = state->error,
                                          .wall_absorbed = state->wall,
                                          .wall_absorbed_first = state->wall_first,
                                          .wall_absorbed_error = state->wall_error};
    const int status = lit->transient ? fibrad_transient_shine(lit->transient, &light, &state->result)
                                      : fibrad_radiation_shine(lit->radiation, &light, &state->result);
    state->failed = status != FIBRAD_OK;
    if (!status) add_absorbed(state, lit->bed, lit->walls, sources);
    return status;
}

int light_refuse(const struct light_state *state, const struct bed *bed, int status, const fibrad_fault *fault) {
    const uint32_t light = state->result.lights + 1;
    if (!state->failed) return STATUS_OK;
    if (status == FIBRAD_E_UNSOLVABLE)
        return message(STATUS_USAGE, "--irradiate: nothing absorbs the light, and it cannot leave");
    switch (fault->why) {
    case FIBRAD_WHY_DARK:
        return message(STATUS_USAGE,
                       "--irradiate: no open face lets light %u in; it needs an opening where it comes from, such as "
                       "zmax=open, or zmax=H:open at the rim of side walls",
                       light);
    case FIBRAD_WHY_FOOTPRINT:
        return message(STATUS_USAGE,
                       "--irradiate: the disc of light %u lies inside the bed: sphere %lld is before it; move the disc "
                       "against the light",
                       light, (long long)bed_name(bed, fault->first));
    case FIBRAD_WHY_LIGHT:
        return message(STATUS_USAGE,
                       "--irradiate: light %u: a number is out of range, or its beam is wider than a period", light);
    default:
        return STATUS_OK;
    }
}

void light_scale(struct light_state *state, uint32_t spheres, uint32_t walls, double factor) {
    fibrad_light_result *r = &state->result;
    if (!state->options) return;
    for (uint32_t i = 0; i < spheres; ++i)
        state->absorbed[i] *= factor, state->first[i] *= factor, state->error[i] *= factor;
    for (uint32_t k = 0; k < walls; ++k)
        state->wall[k] *= factor, state->wall_first[k] *= factor, state->wall_error[k] *= factor;
    r->incident *= factor, r->transmitted *= factor, r->reflected *= factor, r->error *= factor;
    r->error_patches *= factor;
}

void light_add(const struct light_state *state, const fibrad_heat_sources *sources, uint32_t spheres, uint32_t walls,
               fibrad_heat_result *result) {
    const fibrad_light_result *light = &state->result;
    double square = 0;
    if (!state->options) return;
    for (uint32_t i = 0; i < spheres; ++i) {
        result->power[i] += state->absorbed[i];
        if (isnan(sources->temperature[i])) continue;
        result->power_error[i] = hypot(result->power_error[i], state->error[i]);
        square += state->error[i] * state->error[i];
    }
    square /= spheres > 0 ? spheres : 1;
    const double patches = fmin(light->error_patches, sqrt(square));
    result->error_patches = hypot(result->error_patches, patches);
    result->error_beams = hypot(result->error_beams, sqrt(square - patches * patches));
    for (uint32_t k = 0; k < walls; ++k) {
        if (sources->insulated[k]) continue; /* it gives off what it absorbs */
        result->wall_power[k] += state->wall[k];
        result->wall_absorbed[k] += state->wall[k];
        if (!isnan(sources->wall_temperature[k]))
            result->wall_error[k] = hypot(result->wall_error[k], state->wall_error[k]);
    }
    result->surroundings_power += light->reflected + light->transmitted - light->incident;
    result->surroundings_error = hypot(result->surroundings_error, light->error);
}

void light_report(const struct light_state *state, const struct walls *walls, uint32_t spheres, struct report *report) {
    const fibrad_light_result *light = &state->result;
    const double all = light->incident > 0 ? light->incident : 1;
    double sum = 0, first = 0;
    if (!state->options) return;
    for (uint32_t i = 0; i < spheres; ++i) sum += state->absorbed[i], first += state->first[i];
    for (uint32_t k = 0; k < walls->count; ++k) sum += state->wall[k], first += state->wall_first[k];
    report_value(report, "irradiated_W", light->incident, 6);
    quantity_report(&state->options->absorptivity, "absorptivity", report);
    wall_values_report(walls, state->of_walls, "_absorptivity", 6, report);
    report_value(report, "absorbed_first_W", first, 6);
    report_value(report, "absorbed_W", sum, 6);
    wall_values_report(walls, state->wall, "_absorbed_W", 6, report);
    report_measured(report, "absorbed", sum / all, light->error / all);
    report_measured(report, "reflected", light->reflected / all, light->error / all);
    report_value(report, "transmitted", light->transmitted / all, 6);
    report_value(report, "balance_of_light", (sum + light->reflected + light->transmitted) / all - 1, 2);
}
