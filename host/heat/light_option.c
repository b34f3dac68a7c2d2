/* light_option.c - light from outside that falls on a bed. SPDX-License-Identifier: MIT */
#include "heat/heat.h"

#include <stdlib.h>
#include <string.h>

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

int absorptivity_option(const char *text, void *absorptivity) {
    return quantity_option("--absorptivity", text, 0, 1, absorptivity);
}

int light_check(struct light_options *options, struct bed_options *bed, const struct quantity *of_emissivity) {
    const char *needs = options->absorptivity.given                   ? "--absorptivity"
                        : walls_keys(&bed->walls) & WALL_ABSORPTIVITY ? "--wall: absorptivity"
                                                                      : NULL;
    if (options->lights == 0) return needs ? message(STATUS_USAGE, "%s needs --irradiate", needs) : STATUS_OK;
    if (!options->absorptivity.given && quantity_curves(of_emissivity))
        return message(STATUS_USAGE, "--irradiate: the emissivity follows the temperature; --absorptivity is missing");
    bed_options_quantity(bed, &options->absorptivity, NULL);
    return STATUS_OK;
}
