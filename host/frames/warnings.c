/* warnings.c - warnings about beds and options that contradict each other. SPDX-License-Identifier: MIT */
#include "frames/warnings.h"

#include <math.h>
#include <string.h>

#include "cli/message.h"
#include "cli/output.h"

enum kind {
    OTHER_NAMES,
    OTHER_ORDER,
    OTHER_PERIOD,
    OTHER_UNIT,
    SHRUNK_BOX,
    CELSIUS,
    HEAT_CAPACITY,
    DENSITY,
    CLOSED_BED,
    WAVES,
    JOINED_WALL,
    HOT,
    OF_TABLES,                             /* and then an enum warned_table */
    OF_THE_LIBRARY = OF_TABLES + GAS_TABLE /* and then a fibrad_warning_code, from 1 on */
};

#define RADIUS_LARGE 0.1      /* [m] particles hardly have a larger mean radius */
#define PERIOD_OFF   1e-3     /* relative: users type boxes with few digits */
#define WAVES_LEAST  5e-3     /* [m K] radius times temperature: smaller spheres are no larger than wavelengths */
#define WIEN         2.898e-3 /* [m K] */
#define TIME_LEAST   1e-9     /* relative: times in hours are rounded */
/* Bounds with a margin of 2 beyond all solids, from aerogel to uranium. */
#define CAPACITY_LOW  30.0 /* [J/(kg K)] */
#define CAPACITY_HIGH 3e4
#define DENSITY_LOW   10.0 /* [kg/m3] */
#define DENSITY_HIGH  1e5
#define SOLIDS_MELT   4000.0 /* [K] hardly a solid is left */

/* Prints a warning about a line of the file; 0: about no line. */
#define WARN(line, ...) message_at(STATUS_OK, warned->file, line, "warning: " __VA_ARGS__)

/* Whether a kind of warning is the first of its kind. Marks the kind as printed. */
static bool is_new(struct warned *warned, enum kind kind) {
    const uint64_t bit = UINT64_C(1) << kind;
    const bool new = !(warned->kinds & bit);
    warned->kinds |= bit;
    return new;
}

/* Prints what the library warns of, in words of the program. */
static void word_rows(const struct warned *warned, const struct bed *bed, const fibrad_warning *w, bool meshed) {
    const char *more = meshed ? "do triangles cut spheres? If not, more directions help" : "more directions help";
    if (w->code == FIBRAD_WARNING_OPEN_ROWS)
        WARN(0,
             "rows of walls are not closed: their sums are off by %.2g, because they contradict the rows of spheres%s",
             w->value, meshed ? "; do triangles cut spheres?" : "");
    if (w->code == FIBRAD_WARNING_APART)
        WARN(0, "rows of walls and of spheres disagreed by %.2g before they were closed; %s", w->value, more);
    if (w->code == FIBRAD_WARNING_CHANGED_ROW)
        WARN(bed->line[w->first],
             "rows were scaled to add up to 1; this changes what sphere %lld gives to walls and "
             "surroundings by %.2g times the error of its row; %s",
             (long long)bed_name(bed, w->first), w->value, more);
}

static void word_places(const struct warned *warned, const struct bed *bed, const struct walls *walls,
                        const fibrad_warning *w) {
    char place[2][BED_LINE_TEXT];
    const char *wall = w->wall > 0 ? wall_name(walls, w->wall - 1) : "";
    if (w->code == FIBRAD_WARNING_OVERLAP)
        WARN(0, "sphere %lld%s and sphere %lld%s overlap by %.3g of a radius, so their view factors err by about %.1g",
             (long long)bed_name(bed, w->first), bed_line_text(bed, w->first, place[0]),
             (long long)bed_name(bed, w->second), bed_line_text(bed, w->second, place[1]), w->value, w->other);
    if (w->code == FIBRAD_WARNING_PARTED)
        WARN(
            bed->line[w->second],
            "sphere %lld and sphere %lld%s are of one clump, and its parts do not touch (%u such clumps in all); it is "
            "one body all the same",
            (long long)bed_name(bed, w->second), (long long)bed_name(bed, w->first),
            bed_line_text(bed, w->first, place[0]), w->count);
    if (w->code == FIBRAD_WARNING_COVERED)
        WARN(bed->line[w->first],
             "sphere %lld lies within other spheres of its clump (%u such spheres in all), so it has no surface",
             (long long)bed_name(bed, w->first), w->count);
    if (w->code == FIBRAD_WARNING_CUT)
        WARN(bed->line[w->first],
             "sphere %lld reaches through the wall %s by %.2g of its radius (%u such cases in all); is "
             "the wall in the right place?",
             (long long)bed_name(bed, w->first), wall, w->value, w->count);
    if (w->code == FIBRAD_WARNING_MESH_SIZE)
        WARN(0,
             "the wall %s is %.3g long, the bed %.3g; is the mesh in the unit of the bed? "
             "mesh:FILE:scale=%g scales the mesh",
             wall, w->value, w->other, w->value > w->other ? 1e-3 : 1e3);
    if (w->code == FIBRAD_WARNING_MESH_PLACE)
        WARN(0, "the wall %s lies from %g to %g along %c, the bed from %g to %g; are both in the same place and unit?",
             wall, w->value, w->other, 'x' + (int)w->first, bed_reach(bed, (int)w->first, false),
             bed_reach(bed, (int)w->first, true));
}

static void word_temperatures(const struct warned *warned, const struct bed *bed, const struct walls *walls,
                              const fibrad_warning *w) {
    if (w->code == FIBRAD_WARNING_COLD)
        WARN(0, "no sphere is warmer than %g K; --temperature-unit C is for degrees Celsius", w->value);
    if (w->code == FIBRAD_WARNING_AROUND)
        WARN(0, "%s is %g K; --temperature-unit C is for degrees Celsius",
             w->wall > 0 ? wall_name(walls, w->wall - 1) : "--ambient", w->value);
    if (w->code == FIBRAD_WARNING_ZERO)
        WARN(bed->line[w->first],
             "sphere %lld has 0 K (%u spheres in all), others have up to %g K; is a value missing? With "
             "--power, nan stands for an unknown temperature",
             (long long)bed_name(bed, w->first), w->count, w->value);
    if (w->code == FIBRAD_WARNING_SURFACE)
        WARN(bed->line[w->first],
             "sphere %lld: its surface comes out at %.0f K in one place; --solid-conductivity is for "
             "surfaces whose temperature differs little from its mean",
             (long long)bed_name(bed, w->first), w->value);
}

void warn_made(struct warned *warned, const struct bed *bed, const struct walls *walls, const fibrad_bed *made,
               bool kelvins) {
    fibrad_warning warning[FIBRAD_WARNINGS_MAX];
    fibrad_scene_facts facts = {0};
    const uint32_t count = fibrad_bed_warnings(made, warning);
    fibrad_bed_describe(made, &facts, NULL);
    for (uint32_t k = 0; k < count; ++k) {
        const fibrad_warning *w = &warning[k];
        const bool celsius = w->code == FIBRAD_WARNING_COLD || w->code == FIBRAD_WARNING_AROUND;
        if (w->code == FIBRAD_WARNING_STORE || (celsius && !kelvins)) continue; /* STORE: warn_matter says more */
        if (!is_new(warned, celsius ? CELSIUS : (enum kind)(OF_THE_LIBRARY + w->code))) continue;
        word_places(warned, bed, walls, w);
        word_temperatures(warned, bed, walls, w);
        word_rows(warned, bed, w, facts.triangles > 0);
    }
}

void warn_joined(struct warned *warned, const char *wall) {
    if (is_new(warned, JOINED_WALL))
        WARN(0, "the insulated wall %s is in contact, so it has one temperature, as with %s:power=0", wall, wall);
}

void warn_hot(struct warned *warned, double hottest) {
    if (hottest > SOLIDS_MELT && is_new(warned, HOT))
        WARN(0, "temperatures of up to %.0f K come out, at which no solid is left; are powers, light and units right?",
             hottest);
}

/* ---- frames ----------------------------------------------------------------------------------------------------- */

void warn_frame(struct warned *warned, const struct bed *bed) {
    const bool before = warned->frames > 0;
    if (before && warned->ids != bed->ids &&
        is_new(warned, OTHER_NAMES)) /* nothing in the output would tell ids from positions */
        WARN(0, "spheres are named by %s, but those of the frames before by %s; --positions names all by positions",
             bed->ids ? "ids" : "positions", warned->ids ? "ids" : "positions");
    if (before && bed->timestep >= 0 && bed->timestep < warned->timestep && is_new(warned, OTHER_ORDER))
        WARN(0,
             "timestep %lld follows timestep %lld; a pattern in quotes, 'bed.*.dump', gives files in "
             "the order of their numbers",
             (long long)bed->timestep, (long long)warned->timestep);
    ++warned->frames;
    warned->ids = bed->ids;
    warned->timestep = bed->timestep;
}

void warn_periods(struct warned *warned, const struct bed *bed, const double period[3]) {
    for (int axis = 0; axis < 3; ++axis) {
        const double length = bed->high[axis] - bed->low[axis];
        if (!(period[axis] > 0 && length > 0) || fabs(period[axis] - length) <= PERIOD_OFF * length) continue;
        if (!is_new(warned, OTHER_PERIOD)) return;
        WARN(0, "--periodic is %g along %c, and the box of the file is %g long; is --periodic in the unit of the file?",
             period[axis], 'x' + axis, length);
    }
}

void warn_unit(struct warned *warned, const struct bed *bed) {
    const double radius = bed_diameter(bed) / 2;
    if (radius > RADIUS_LARGE && is_new(warned, OTHER_UNIT))
        WARN(0, "radii of %g are taken as metres; --length-unit m, or mm for example, says the unit", radius);
}

void warn_waves(struct warned *warned, const struct bed *bed, double hottest) {
    uint32_t count = 0, first = 0;
    for (uint32_t i = 0; i < bed->n; ++i)
        if (bed->r[i] * bed->metres * hottest < WAVES_LEAST && count++ == 0) first = i;
    if (count > 0 && hottest > 0 && is_new(warned, WAVES))
        WARN(bed->line[first],
             "sphere %lld (one of %u) has a radius of %.2g m. Radiation of %g K has wavelengths of %.2g m: "
             "geometrical optics do not hold for such spheres and gaps",
             (long long)bed_name(bed, first), count, bed->r[first] * bed->metres, hottest, WIEN / hottest);
}

/* ---- walls ------------------------------------------------------------------------------------------------------ */

void warn_box(struct warned *warned, const struct walls *walls) {
    if (walls->moved && is_new(warned, SHRUNK_BOX))
        WARN(0, "the box of the file ends within spheres, as a box around centres does. Walls without a "
                "coordinate stand where the spheres end. xmin=VALUE gives a coordinate");
}

/* ---- values ----------------------------------------------------------------------------------------------------- */

void warn_celsius(struct warned *warned, const char *column) {
    if ((output_ends(column, "_C") || strstr(column, "elsius")) && is_new(warned, CELSIUS))
        WARN(0, "the column %.40s is taken as kelvins; --temperature-unit C is for degrees Celsius", column);
}

void warn_closed(struct warned *warned) {
    if (is_new(warned, CLOSED_BED))
        WARN(0, "--ambient has no effect: nothing leaves a bed that walls and periods close");
}

/* The index of the first value outside low to high. n: there is none. */
static uint32_t find_outlier(const double *value, uint32_t n, double low, double high) {
    uint32_t i = 0;
    while (i < n && ((value[i] >= low && value[i] <= high) || isinf(value[i]))) ++i; /* infinite: held */
    return i;
}

void warn_matter(struct warned *warned, const struct bed *bed, const double *capacity, const double *density) {
    const uint32_t c = find_outlier(capacity, bed->n, CAPACITY_LOW, CAPACITY_HIGH);
    const uint32_t rho = find_outlier(density, bed->n, DENSITY_LOW, DENSITY_HIGH);
    if (c < bed->n && is_new(warned, HEAT_CAPACITY))
        WARN(bed->line[c], "the heat capacity is %g J/(kg K); solids have some 100 to 5000", capacity[c]);
    if (rho < bed->n && is_new(warned, DENSITY))
        WARN(bed->line[rho], "the density is %g kg/m3; solids have some 100 to 20,000", density[rho]);
}

void warn_table(struct warned *warned, enum warned_table table, const struct table_excess *excess) {
    static const char *const option[] = {"emissivity", "solid-conductivity", "contact-conductivity",
                                         "gas-conductivity"};
    if (excess->number > 0 && is_new(warned, (enum kind)(OF_TABLES + table)))
        WARN(0, "--%s: %u %s%s beyond the table, by up to %.3g K; the value at its end is taken", option[table],
             excess->number, table == GAS_TABLE ? "contact" : "sphere",
             excess->number == 1 ? " has a temperature" : "s have temperatures", excess->kelvins);
}

void warn_times(struct warned *warned, const char *what, const struct curve *curve, double until) {
    if (curve->n == 0) return;
    const double first = curve->x[0], last = curve->x[curve->n - 1];
    if (first > TIME_LEAST * until)
        WARN(0, "the table of %s begins at %g s; before, its first temperature is taken", what, first);
    if (last < (1 - TIME_LEAST) * until)
        WARN(0, "the table of %s ends at %g s; from there to %g s its last temperature is taken", what, last, until);
}
