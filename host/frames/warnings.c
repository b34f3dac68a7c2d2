/* warnings.c - warnings about beds and options that contradict each other. SPDX-License-Identifier: MIT */
#include "frames/warnings.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/message.h"
#include "contact/cylinder.h"

enum kind {
    OTHER_NAMES,
    OTHER_ORDER,
    OTHER_PERIOD,
    OTHER_UNIT,
    LARGE_OVERLAP,
    CUT_BY_WALL,
    SHRUNK_BOX,
    MESH_SIZE,
    MESH_PLACE,
    CELSIUS,
    ABSOLUTE_ZERO,
    HEAT_CAPACITY,
    DENSITY,
    COLD_SURFACE,
    EMISSIVITY_TABLE,
    SOLID_TABLE,
    CONTACT_TABLE,
    GAS_TABLE,
    CLOSED_BED,
    WALLS_OPEN,
    WALLS_APART,
    CLOSING
};

#define RADIUS_LARGE  0.1   /* [m] particles hardly have a larger mean radius */
#define OVERLAP_LARGE 0.05  /* overlap over the smaller radius */
#define CUT_LARGE     0.1   /* depth of a wall in a sphere over the radius */
#define PERIOD_OFF    1e-3  /* relative: users type boxes with few digits */
#define SIZES_APART   200.0 /* ratio of the sizes of mesh and bed; metres for millimetres make 1000 */
#define COLD          150.0 /* [K] a bed is hardly colder everywhere */
#define SPACE         5.0   /* [K] surroundings as cold as space are meant */
#define WARM_CELSIUS  75.0  /* surroundings of 5 to 75 K are more likely of 5 to 75 C */
#define CLOSED        1e-9  /* closed rows of walls add up to 1 within this */
#define APART         0.1   /* sums of rows of walls may differ from 1 so much before closing; few directions: 0.01s */
#define TIME_LEAST    1e-9  /* relative: times in hours are rounded */
#define CHANGE_LARGE  1.5   /* change by closing over the error of a row; among thousands of rows chance makes 1 */
/* Bounds with a margin of 2 beyond all solids, from aerogel to uranium. */
#define CAPACITY_LOW  30.0 /* [J/(kg K)] */
#define CAPACITY_HIGH 3e4
#define DENSITY_LOW   10.0 /* [kg/m3] */
#define DENSITY_HIGH  1e5

/* Whether a kind of warning is the first of its kind. Marks the kind as printed. */
static bool is_new(struct warned *warned, enum kind kind) {
    const unsigned bit = 1u << kind;
    const bool new = !(warned->kinds & bit);
    warned->kinds |= bit;
    return new;
}

void warn_rows(struct warned *warned, const struct bed *bed, const fibrad_bed_matrix *factors) {
    const fibrad_factors *matrix = &factors->matrix;
    const bool walls = matrix->wall_wall != NULL, meshed = factors->facts.triangles > 0;
    if (walls && matrix->wall_closure > CLOSED && is_new(warned, WALLS_OPEN))
        message_at(STATUS_OK, warned->file, 0,
                   "warning: rows of walls are not closed: their sums are off by %.2g, because they contradict the "
                   "rows of spheres%s",
                   matrix->wall_closure, meshed ? "; do triangles cut spheres?" : "");
    else if (walls && matrix->wall_correction > APART && is_new(warned, WALLS_APART))
        message_at(STATUS_OK, warned->file, 0,
                   "warning: rows of walls and of spheres disagreed by %.2g before they were closed; %s",
                   matrix->wall_correction,
                   meshed ? "do triangles cut spheres? If not, more directions help" : "more directions help");
    else if (matrix->changed > CHANGE_LARGE && is_new(warned, CLOSING))
        message_at(STATUS_OK, warned->file, bed->line[matrix->changed_row],
                   "warning: rows were scaled to add up to 1; this changes what sphere %lld gives to walls and "
                   "surroundings by %.2g times the error of its row; %s",
                   (long long)bed_name(bed, matrix->changed_row), matrix->changed,
                   meshed ? "do triangles cut this sphere? If not, more directions help" : "more directions help");
}

/* ---- frames ----------------------------------------------------------------------------------------------------- */

void warn_frame(struct warned *warned, const struct bed *bed) {
    const bool before = warned->frames > 0;
    if (before && warned->ids != bed->ids &&
        is_new(warned, OTHER_NAMES)) /* nothing in the output would tell ids from positions */
        message_at(STATUS_OK, warned->file, 0,
                   "warning: spheres are named by %s, but those of the frames before by %s; --positions names all by "
                   "positions",
                   bed->ids ? "ids" : "positions", warned->ids ? "ids" : "positions");
    if (before && bed->timestep >= 0 && bed->timestep < warned->timestep && is_new(warned, OTHER_ORDER))
        message_at(STATUS_OK, warned->file, 0,
                   "warning: timestep %lld follows timestep %lld; a pattern in quotes, 'bed.*.dump', gives files in "
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
        message_at(STATUS_OK, warned->file, 0,
                   "warning: --periodic is %g along %c, and the box of the file is %g long; is --periodic in the unit "
                   "of the file?",
                   period[axis], 'x' + axis, length);
    }
}

static double mean_radius(const struct bed *bed) {
    double sum = 0;
    for (uint32_t i = 0; i < bed->n; ++i) sum += bed->r[i];
    return sum / bed->n;
}

void warn_unit(struct warned *warned, const struct bed *bed) {
    if (mean_radius(bed) > RADIUS_LARGE && is_new(warned, OTHER_UNIT))
        message_at(STATUS_OK, warned->file, 0,
                   "warning: radii of %g are taken as metres; --length-unit m, or mm for example, says the unit",
                   mean_radius(bed));
}

/* By how much the row of the smaller of two spheres errs that overlap by a share of its radius. Points of its surface
 * within the other sphere see only this sphere. In a row they see what lies beside it as well, in directions away from
 * it. These are the fraction (1 - cos t)/2 of all directions at an angle t from the line of centres. */
static double overlap_error(const struct bed *bed, uint32_t first, uint32_t second, double overlap) {
    const double small = fmin(bed->r[first], bed->r[second]), large = fmax(bed->r[first], bed->r[second]);
    const double d = small + large - overlap * small;
    const double rim = 1 - (d * d + small * small - large * large) / (2 * d * small);
    return rim * rim / 8;
}

void warn_overlap(struct warned *warned, const struct bed *bed, const fibrad_scene_facts *facts) {
    const uint32_t first = facts->overlap_pair[0], second = facts->overlap_pair[1];
    char place[2][BED_LINE_TEXT];
    if (facts->overlap_max > OVERLAP_LARGE && is_new(warned, LARGE_OVERLAP))
        message_at(STATUS_OK, warned->file, 0,
                   "warning: sphere %lld%s and sphere %lld%s overlap by %.3g of a radius, so their view factors err by "
                   "about %.1g",
                   (long long)bed_name(bed, first), bed_line_text(bed, first, place[0]),
                   (long long)bed_name(bed, second), bed_line_text(bed, second, place[1]), facts->overlap_max,
                   overlap_error(bed, first, second, facts->overlap_max));
}

/* ---- walls ------------------------------------------------------------------------------------------------------ */

/* How far sphere i reaches beyond a plane or a cylinder. For a mesh: 0. */
static double cut(const struct bed *bed, const fibrad_wall *wall, uint32_t i) {
    const double at[3] = {bed->x[i], bed->y[i], bed->z[i]};
    if (wall->kind == FIBRAD_WALL_CYLINDER) return cylinder_distance(wall, at) + bed->r[i] - wall->cylinder.radius;
    if (wall->kind != FIBRAD_WALL_PLANE) return 0;
    const double beyond = at[wall->plane.axis] - wall->plane.at;
    return bed->r[i] + (wall->plane.upper ? beyond : -beyond);
}

static void warn_of_cuts(struct warned *warned, const struct bed *bed, const struct walls *walls) {
    uint32_t count = 0, sphere = 0, wall = 0;
    double worst = 0;
    for (uint32_t k = 0; k < walls->count; ++k)
        for (uint32_t i = 0; i < bed->n; ++i) {
            const double depth = cut(bed, &walls->wall[k], i) / bed->r[i];
            count += depth > CUT_LARGE;
            if (depth > worst) worst = depth, sphere = i, wall = k;
        }
    if (count > 0 && is_new(warned, CUT_BY_WALL))
        message_at(STATUS_OK, warned->file, bed->line[sphere],
                   "warning: sphere %lld reaches through the wall %s by %.2g of its radius (%u such cases in all); is "
                   "the wall in the right place?",
                   (long long)bed_name(bed, sphere), wall_name(walls, wall), worst, count);
}

static double longest(const double low[3], const double high[3]) {
    return fmax(fmax(high[0] - low[0], high[1] - low[1]), high[2] - low[2]);
}

static void warn_of_mesh(struct warned *warned, const struct bed *bed, const struct meshes *meshes, uint32_t wall) {
    const double near = 2 * mean_radius(bed);
    double low[3], high[3], from[3], to[3];
    mesh_extents(meshes, wall, low, high);
    for (int axis = 0; axis < 3; ++axis)
        from[axis] = bed_reach(bed, axis, false), to[axis] = bed_reach(bed, axis, true);
    const double ratio = longest(low, high) / longest(from, to);
    if ((ratio > SIZES_APART || ratio < 1 / SIZES_APART) && is_new(warned, MESH_SIZE))
        message_at(STATUS_OK, warned->file, 0,
                   "warning: the wall %s is %.3g long, the bed %.3g; is the mesh in the unit of the bed? "
                   "mesh:FILE:scale=%g scales the mesh",
                   meshes->name[wall], longest(low, high), longest(from, to), ratio > 1 ? 1e-3 : 1e3);
    for (int axis = 0; axis < 3; ++axis) {
        if (bed->period[axis] > 0 || (low[axis] <= to[axis] + near && high[axis] >= from[axis] - near)) continue;
        if (is_new(warned, MESH_PLACE))
            message_at(STATUS_OK, warned->file, 0,
                       "warning: the wall %s lies from %g to %g along %c, the bed from %g to %g; are both in the same "
                       "place and unit?",
                       meshes->name[wall], low[axis], high[axis], 'x' + axis, from[axis], to[axis]);
    }
}

void warn_walls(struct warned *warned, const struct bed *bed, const struct walls *walls) {
    if (walls->moved && is_new(warned, SHRUNK_BOX))
        message_at(STATUS_OK, warned->file, 0,
                   "warning: the box of the file ends within spheres, as a box around centres does. Walls without a "
                   "coordinate stand where the spheres end. xmin=VALUE gives a coordinate");
    warn_of_cuts(warned, bed, walls);
    for (uint32_t k = 0; k < walls->count; ++k)
        if (walls->wall[k].kind == FIBRAD_WALL_MESH) warn_of_mesh(warned, bed, walls->meshes, k);
}

/* ---- values ----------------------------------------------------------------------------------------------------- */

/* Whether the name of a column says degrees Celsius. */
static bool names_celsius(const char *column) {
    const size_t length = strlen(column);
    return (length > 2 && strcmp(column + length - 2, "_C") == 0) || strstr(column, "elsius");
}

void warn_temperatures(struct warned *warned, const struct bed *bed, const char *column, double zero,
                       const double *kelvins) {
    uint32_t zeros = 0, first = 0;
    double most = -1;
    for (uint32_t i = 0; i < bed->n; ++i) {
        if (kelvins[i] > most) most = kelvins[i];
        if (kelvins[i] == 0 && zeros++ == 0) first = i;
    }
    const bool named = zero == 0 && column && names_celsius(column);
    if (named && is_new(warned, CELSIUS))
        message_at(STATUS_OK, warned->file, 0,
                   "warning: the column %.40s is taken as kelvins; --temperature-unit C is for degrees Celsius",
                   column);
    if (zero == 0 && most > 0 && most < COLD && is_new(warned, CELSIUS))
        message_at(STATUS_OK, warned->file, 0,
                   "warning: no sphere is warmer than %g K; --temperature-unit C is for degrees Celsius", most);
    if (zeros > 0 && most > 0 && is_new(warned, ABSOLUTE_ZERO))
        message_at(STATUS_OK, warned->file, bed->line[first],
                   "warning: sphere %lld has 0 K (%u spheres in all), others have up to %g K; is a value missing? With "
                   "--power, nan stands for an unknown temperature",
                   (long long)bed_name(bed, first), zeros, most);
}

void warn_around(struct warned *warned, const char *what, double kelvins) {
    if (kelvins > SPACE && kelvins < WARM_CELSIUS && is_new(warned, CELSIUS))
        message_at(STATUS_OK, warned->file, 0, "warning: %s is %g K; --temperature-unit C is for degrees Celsius", what,
                   kelvins);
}

void warn_closed(struct warned *warned) {
    if (is_new(warned, CLOSED_BED))
        message_at(STATUS_OK, warned->file, 0,
                   "warning: --ambient has no effect: nothing leaves a bed that walls and periods close");
}

/* The index of the first value outside low to high. n: there is none. */
static uint32_t find_outlier(const double *value, uint32_t n, double low, double high) {
    uint32_t i = 0;
    while (i < n && value[i] >= low && value[i] <= high) ++i;
    return i;
}

void warn_matter(struct warned *warned, const struct bed *bed, const double *capacity, const double *density) {
    const uint32_t c = find_outlier(capacity, bed->n, CAPACITY_LOW, CAPACITY_HIGH);
    const uint32_t rho = find_outlier(density, bed->n, DENSITY_LOW, DENSITY_HIGH);
    if (c < bed->n && is_new(warned, HEAT_CAPACITY))
        message_at(STATUS_OK, warned->file, bed->line[c],
                   "warning: the heat capacity is %g J/(kg K); solids have some 100 to 5000", capacity[c]);
    if (rho < bed->n && is_new(warned, DENSITY))
        message_at(STATUS_OK, warned->file, bed->line[rho],
                   "warning: the density is %g kg/m3; solids have some 100 to 20,000", density[rho]);
}

void warn_table(struct warned *warned, const char *option, const struct table_excess *excess) {
    static const struct {
        const char *option, *what;
        enum kind kind;
    } tables[] = {{"--emissivity", "sphere", EMISSIVITY_TABLE},
                  {"--solid-conductivity", "sphere", SOLID_TABLE},
                  {"--contact-conductivity", "sphere", CONTACT_TABLE},
                  {"--gas-conductivity", "contact", GAS_TABLE}};
    size_t k = 0;
    while (strcmp(option, tables[k].option) != 0) ++k;
    if (excess->number > 0 && is_new(warned, tables[k].kind))
        message_at(STATUS_OK, warned->file, 0,
                   "warning: %s: %u %s%s beyond the table, by up to %.3g K; the value at its end is taken", option,
                   excess->number, tables[k].what, excess->number == 1 ? " has a temperature" : "s have temperatures",
                   excess->kelvins);
}

void warn_times(struct warned *warned, const char *what, const struct curve *curve, double until) {
    if (curve->n == 0) return;
    const double first = curve->x[0], last = curve->x[curve->n - 1];
    if (first > TIME_LEAST * until)
        message_at(STATUS_OK, warned->file, 0,
                   "warning: the table of %s begins at %g s; before, its first temperature is taken", what, first);
    if (last < (1 - TIME_LEAST) * until)
        message_at(STATUS_OK, warned->file, 0,
                   "warning: the table of %s ends at %g s; from there to %g s its last temperature is taken", what,
                   last, until);
}

void warn_surfaces(struct warned *warned, const struct bed *bed, const double *least) {
    uint32_t i = 0;
    while (i < bed->n && !(least[i] < 0)) ++i;
    if (i < bed->n && is_new(warned, COLD_SURFACE))
        message_at(STATUS_OK, warned->file, bed->line[i],
                   "warning: sphere %lld: its surface comes out at %.0f K in one place; --solid-conductivity is for "
                   "surfaces whose temperature differs little from its mean",
                   (long long)bed_name(bed, i), least[i]);
}
