/* stream.c - gas that flows through a bed: options, slices, and coefficients of heat transfer by correlations.
 * SPDX-License-Identifier: MIT */
#include <gsl/gsl_math.h>
#include <stdlib.h>

#include "heat/heat.h"

enum { SLICES_MAX = 100000 };

static const struct curve_axes capacity_axes = {CURVE_AXIS_KELVINS, {"c cp capacity heat_capacity", "J/(kg K)"}};

int gas_flow_option(const char *text, void *film_options) {
    struct film_options *options = film_options;
    const char *axis = text + (*text == '-');
    if (*axis < 'x' || *axis > 'z' || axis[1] != ':')
        return message(STATUS_USAGE, "--gas-flow: %.60s is not AXIS:G, z:0.5 or -z:0.5 for example", text);
    options->axis = *axis - 'x', options->down = *text == '-';
    return options_number("--gas-flow", axis + 2, 1e-12, 1e12, &options->flux);
}

int gas_capacity_option(const char *text, void *film_options) {
    struct film_options *options = film_options;
    if (*text != '@') return options_number("--gas-heat-capacity", text, 1e-12, 1e12, &options->capacity);
    const int status = curve_read(text + 1, "heat capacity", &capacity_axes, 1e-12, 1e12, &options->capacity_curve);
    if (!status) options->capacity = options->capacity_curve.y[0];
    return status;
}

int stream_check(const struct film_options *o) {
    if (o->correlation && !(o->flux > 0))
        return message(STATUS_USAGE, "--convection %s needs --gas-flow", o->correlation == WAKAO ? "wakao" : "gunn");
    if (o->capacity > 0 && !(o->flux > 0)) return message(STATUS_USAGE, "--gas-heat-capacity needs --gas-flow");
    if (!(o->flux > 0)) return STATUS_OK;
    if (!o->coefficient.given) return message(STATUS_USAGE, "--gas-flow needs --convection");
    if (!(o->capacity > 0)) return message(STATUS_USAGE, "--gas-flow needs --gas-heat-capacity");
    if (o->gas.column || o->gas.types)
        return message(STATUS_USAGE, "--gas-flow: --gas-temperature is that of the inlet, one number or a table");
    return STATUS_OK;
}

/* The width of the cross-section along an axis beside the flow: between walls, else of the period or the spheres. */
static double width_of(const struct heat *h, int axis) {
    double end[2] = {bed_reach(h->bed, axis, false), bed_reach(h->bed, axis, true)};
    if (h->bed->period[axis] > 0) return h->bed->period[axis];
    for (uint32_t k = 0; k < h->walls.count; ++k)
        if (h->walls.wall[k].kind == FIBRAD_WALL_PLANE && h->walls.wall[k].plane.axis == axis)
            end[h->walls.wall[k].plane.upper != 0] = h->walls.wall[k].plane.at;
    return end[1] - end[0];
}

/* The cross-section that the gas flows through if there are no spheres [m2]. */
static double cross_section(const struct heat *h) {
    const int axis = h->film.axis;
    double section = width_of(h, (axis + 1) % 3) * width_of(h, (axis + 2) % 3);
    for (uint32_t k = 0; k < h->walls.count; ++k) {
        const fibrad_wall *wall = &h->walls.wall[k];
        if (wall->kind == FIBRAD_WALL_CYLINDER && !wall_across(wall, axis))
            section = M_PI * gsl_pow_2(wall->cylinder.radius);
    }
    return section * gsl_pow_2(h->bed->metres);
}

/* Refuses a flow across an axis that a period, a plane or a cylinder closes. */
static int refuse_closed(const struct heat *h) {
    const char axis = (char)('x' + h->film.axis);
    for (int side = 2 * h->film.axis; side < 2 * h->film.axis + 2; ++side) {
        if (!walls_close(&h->walls, h->bed, side)) continue;
        if (h->bed->period[h->film.axis] > 0)
            return message(STATUS_USAGE, "--gas-flow: the bed is periodic along %c, so no gas enters there", axis);
        return message(STATUS_USAGE, "--gas-flow: a wall closes the bed at %c%s; --wall %c%s:open lets the gas through",
                       axis, side % 2 ? "max" : "min", axis, side % 2 ? "max" : "min");
    }
    return STATUS_OK;
}

/* Cuts the bed into slices of one mean diameter, and assigns each sphere to the slice of its centre. */
static void cut_slices(struct heat *h, uint32_t *slice) {
    const struct bed *bed = h->bed;
    const double *at = bed_centres(bed, h->film.axis);
    const double low = bed_reach(bed, h->film.axis, false), high = bed_reach(bed, h->film.axis, true);
    const double length = high - low;
    const uint32_t slices = (uint32_t)fmax(1, fmin(SLICES_MAX, round(length / bed_diameter(bed))));
    for (uint32_t i = 0; i < bed->n; ++i) {
        const double way = h->film.down ? high - at[i] : at[i] - low;
        slice[i] = (uint32_t)fmax(0, fmin(slices - 1.0, floor(way / length * slices)));
    }
    h->films.stream.slice = slice, h->films.stream.slices = slices;
}

int stream_begin(struct heat *h) {
    const struct film_options *o = &h->film;
    struct film_state *films = &h->films;
    const uint32_t points = o->capacity_curve.n > 0 ? (uint32_t)o->capacity_curve.n : 1;
    if (!(o->flux > 0)) return STATUS_OK;
    const int status = refuse_closed(h);
    if (status) return status;
    uint32_t *slice = malloc((h->bed->n + (size_t)1) * sizeof *slice);
    if (slice) cut_slices(h, slice);
    films->memory = calloc(2 * (size_t)points + FIBRAD_STREAM_ROWS * (size_t)films->stream.slices, sizeof(double));
    if (!slice || !films->memory) return message_memory();
    double *at = films->memory, *capacity = at + points;
    films->section = cross_section(h);
    for (uint32_t k = 0; k < points; ++k) {
        at[k] = o->capacity_curve.n > 0 ? o->capacity_curve.x[k] : 1;
        capacity[k] = (o->capacity_curve.n > 0 ? o->capacity_curve.y[k] : o->capacity) * o->flux * films->section *
                      films->per_watt;
    }
    films->stream.at = at, films->stream.capacity = capacity, films->stream.points = points;
    films->stream.gas = capacity + points;
    films->stream.inlet = films->inlet_end = o->gas.value + h->given.zero;
    h->sources.stream = &films->stream;
    return STATUS_OK;
}

/* The fraction of the bed that is void: cross-section times length less the volumes of the spheres. */
static double void_fraction(const struct heat *h) {
    const double length = bed_reach(h->bed, h->film.axis, true) - bed_reach(h->bed, h->film.axis, false);
    double solid = 0;
    for (uint32_t i = 0; i < h->bed->n; ++i) solid += heat_volume(h, i);
    return 1 - solid / (h->films.section * length * h->bed->metres);
}

/* Nusselt numbers of spheres in a bed, with the Reynolds number of the diameter and the superficial velocity.
 * N. Wakao, S. Kaguei, Heat and Mass Transfer in Packed Beds (1982). D. J. Gunn, Int. J. Heat Mass Transfer 21 (1978)
 * 467, for a void fraction e. */
static double nusselt(enum correlation correlation, double re, double pr, double e) {
    const double third = cbrt(pr);
    if (correlation == WAKAO) return 2 + 1.1 * third * pow(re, .6);
    return (7 - 10 * e + 5 * e * e) * (1 + .7 * pow(re, .2) * third) +
           (1.33 - 2.4 * e + 1.2 * e * e) * pow(re, .7) * third;
}

int stream_coefficients(const struct heat *h, double *coefficient) {
    const struct film_options *o = &h->film;
    const struct curve *curve = &o->capacity_curve;
    const double cp = curve->n > 0 ? curve_at(curve, h->films.stream.inlet) : o->capacity;
    const double pr = cp * o->viscosity / o->conductivity, e = void_fraction(h);
    const double low = o->correlation == WAKAO ? 15 : 0, high = o->correlation == WAKAO ? 8500 : 1e5;
    if (o->correlation == GUNN && !(e >= .35 && e <= 1))
        return message(STATUS_USAGE, "--convection gunn: is for void fractions of 0.35 to 1, and the bed has %.3g", e);
    for (uint32_t i = 0; i < h->bed->n; ++i) {
        const double d = 2 * h->bed->r[i] * h->bed->metres, re = o->flux * d / o->viscosity;
        if (!(re >= low && re <= high))
            return message_at(STATUS_INPUT, h->options.name, h->bed->line[i],
                              "--convection %s: is for Reynolds numbers of %g to %g, and sphere %lld has %.3g%s",
                              o->correlation == WAKAO ? "wakao" : "gunn", low, high, (long long)bed_name(h->bed, i), re,
                              re < low ? "; gunn goes down to 0" : "");
        coefficient[i] = nusselt(o->correlation, re, pr, e) * o->conductivity / d;
    }
    return STATUS_OK;
}

double stream_outlet(const struct heat *h) {
    const fibrad_stream *stream = &h->films.stream;
    return stream->slices > 0 ? stream->gas[stream->slices - 1] : NAN;
}

void stream_report(struct heat *h) {
    struct report *report = &h->options.report;
    const struct film_state *films = &h->films;
    double mean = 0, area = 0;
    if (films->stream.slices == 0) return;
    for (uint32_t i = 0; i < h->bed->n && films->film; ++i)
        mean += films->film[i] / films->per_watt, area += heat_area(h, i);
    if (h->film.correlation) report_value(report, "convection_W_m2K", mean / area, 6);
    report_count(report, "gas_slices", films->stream.slices);
    report_value(report, "gas_section_m2", films->section, 6);
    report_value(report, "gas_inlet_K", films->stream.inlet, 6);
    report_value(report, "gas_outlet_K", stream_outlet(h), 6);
}
