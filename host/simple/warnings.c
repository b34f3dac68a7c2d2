/* warnings.c - what in a bed, its factors and its sources is probably a mistake. SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "simple/bed.h"
#include "simple/cylinder.h"

#define OVERLAP_LARGE 0.05  /* overlap over the smaller radius */
#define CUT_LARGE     0.1   /* depth of a wall in a sphere over the radius */
#define SIZES_APART   200.0 /* ratio of the sizes of mesh and bed; metres for millimetres make 1000 */
#define COLD          150.0 /* [K] a bed is hardly colder everywhere */
#define SPACE         5.0   /* [K] surroundings as cold as space are meant */
#define WARM_CELSIUS  75.0  /* surroundings of 5 to 75 K are more likely of 5 to 75 C */
#define CLOSED        1e-9  /* closed rows of walls add up to 1 within this */
#define APART         0.1   /* sums of rows of walls may differ from 1 so much before closing; few directions: 0.01s */
#define CHANGE_LARGE  1.5   /* change by closing over the error of a row; among thousands of rows chance makes 1 */
#define CHANGE_LEAST  1e-4  /* a change of factors that is felt */
#define STORE_LOW     300.0 /* [J/(m3 K)] a margin of 2 beyond all solids, from aerogel to uranium */
#define STORE_HIGH    3e9

static fibrad_warning *new_warning(fibrad_warning *list, int code, uint32_t first, double value) {
    fibrad_warning *warning = &list[code - 1];
    *warning = (fibrad_warning){.code = code, .first = first, .count = 1, .value = value};
    return warning;
}

static void withdraw(fibrad_bed *bed, int first, int last) {
    for (int code = first; code <= last; ++code) bed->warning[code - 1].code = 0;
}

/* By how much the row of the smaller of two spheres errs that overlap by a share of its radius. Points of its surface
 * within the other sphere see only this sphere. In a row they see what lies beside it as well, in directions away from
 * it. These are the fraction (1 - cos t)/2 of all directions at an angle t from the line of centres. */
static double overlap_error(double r1, double r2, double overlap) {
    const double small = smaller_of(r1, r2), large = larger_of(r1, r2), d = small + large - overlap * small;
    const double rim = 1 - (d * d + small * small - large * large) / (2 * d * small);
    return rim * rim / 8;
}

/* How far sphere i reaches beyond a plane or a cylinder. For a mesh: 0. */
static double reach_beyond(const fibrad_spheres *s, const fibrad_wall *wall, uint32_t i) {
    const double at[3] = {s->x[i], s->y[i], s->z[i]};
    if (wall->kind == FIBRAD_WALL_CYLINDER) return cylinder_distance(wall, at) + s->r[i] - wall->cylinder.radius;
    if (wall->kind != FIBRAD_WALL_PLANE) return 0;
    const double beyond = at[wall->plane.axis] - wall->plane.at;
    return s->r[i] + (wall->plane.upper ? beyond : -beyond);
}

static void warn_of_cuts(const fibrad_bed *bed, fibrad_warning *list) {
    uint32_t count = 0, sphere = 0, wall = 0;
    double worst = 0;
    for (uint32_t b = 0; b < bed->facts.walls; ++b)
        for (uint32_t i = 0; i < bed->facts.spheres; ++i) {
            const double depth = reach_beyond(&bed->spheres, &bed->config.wall[b], i) / bed->spheres.r[i];
            count += depth > CUT_LARGE;
            if (depth > worst) worst = depth, sphere = i, wall = b;
        }
    if (count == 0) return;
    fibrad_warning *warning = new_warning(list, FIBRAD_WARNING_CUT, sphere, worst);
    warning->wall = wall + 1, warning->count = count;
}

/* The ends of spheres, or of the triangles of a wall. */
struct extent {
    double low[3], high[3];
};

static void widen(struct extent *extent, const double at[3], double r) {
    for (int axis = 0; axis < 3; ++axis) {
        extent->low[axis] = smaller_of(extent->low[axis], at[axis] - r);
        extent->high[axis] = larger_of(extent->high[axis], at[axis] + r);
    }
}

static const struct extent nowhere = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

static struct extent extent_of_mesh(const fibrad_triangles *triangles, uint32_t wall) {
    struct extent extent = nowhere;
    for (uint32_t t = 0; t < triangles->n; ++t)
        for (int c = 0; c < 3; ++c) {
            const uint32_t v = triangles->corner[3 * (size_t)t + (size_t)c];
            if (triangles->front[t] == wall || (triangles->back && triangles->back[t] == wall))
                widen(&extent, (const double[]){triangles->x[v], triangles->y[v], triangles->z[v]}, 0);
        }
    return extent;
}

static double longest(const struct extent *extent) {
    double most = 0;
    for (int axis = 0; axis < 3; ++axis) most = larger_of(most, extent->high[axis] - extent->low[axis]);
    return most;
}

/* Meshes of another unit than the bed, or in another place. */
static void warn_of_meshes(const fibrad_bed *bed, fibrad_warning *list) {
    const fibrad_spheres *s = &bed->spheres;
    struct extent all = nowhere;
    double radii = 0;
    for (uint32_t i = 0; i < s->n; ++i)
        widen(&all, (const double[]){s->x[i], s->y[i], s->z[i]}, s->r[i]), radii += s->r[i];
    for (uint32_t b = 0; b < bed->facts.walls && s->n > 0; ++b) {
        if (bed->config.wall[b].kind != FIBRAD_WALL_MESH || !bed->config.triangles) continue;
        const struct extent mesh = extent_of_mesh(bed->config.triangles, b);
        const double ratio = longest(&mesh) / longest(&all), near = 2 * radii / s->n;
        if (ratio > SIZES_APART || (ratio < 1 / SIZES_APART && ratio > 0)) {
            fibrad_warning *warning = new_warning(list, FIBRAD_WARNING_MESH_SIZE, 0, longest(&mesh));
            warning->wall = b + 1, warning->other = longest(&all);
        }
        for (uint32_t axis = 0; axis < 3; ++axis) {
            if (bed->config.period[axis] > 0 ||
                (mesh.low[axis] <= all.high[axis] + near && mesh.high[axis] >= all.low[axis] - near))
                continue;
            fibrad_warning *warning = new_warning(list, FIBRAD_WARNING_MESH_PLACE, axis, mesh.low[axis]);
            warning->wall = b + 1, warning->other = mesh.high[axis];
            break;
        }
    }
}

/* Warnings of positions and walls. They are found when they are asked for: beds that move seldom ask. */
static void warn_of_places(const fibrad_bed *bed, fibrad_warning *list) {
    const uint32_t first = bed->facts.overlap_pair[0], second = bed->facts.overlap_pair[1];
    if (bed->facts.overlap_max > OVERLAP_LARGE) {
        fibrad_warning *warning = new_warning(list, FIBRAD_WARNING_OVERLAP, first, bed->facts.overlap_max);
        warning->second = second;
        warning->other = overlap_error(bed->spheres.r[first], bed->spheres.r[second], bed->facts.overlap_max);
    }
    if (bed->facts.parted > 0) {
        fibrad_warning *warning = new_warning(list, FIBRAD_WARNING_PARTED, bed->facts.parted_pair[0], 0);
        warning->second = bed->facts.parted_pair[1], warning->count = bed->facts.parted;
    }
    if (bed->facts.covered > 0)
        new_warning(list, FIBRAD_WARNING_COVERED, bed->facts.covered_sphere, 0)->count = bed->facts.covered;
    warn_of_cuts(bed, list);
    warn_of_meshes(bed, list);
}

/* Warns of the first surroundings, or the first wall, whose temperature looks like degrees Celsius. */
static void warn_of_celsius(fibrad_bed *bed, const fibrad_heat_sources *s) {
    for (uint32_t b = 0; b <= bed->facts.walls; ++b) {
        const double t = b == 0 ? s->surroundings : s->wall_temperature ? s->wall_temperature[b - 1] : NAN;
        if (!(t > SPACE && t < WARM_CELSIUS)) continue;
        new_warning(bed->warning, FIBRAD_WARNING_AROUND, 0, t)->wall = b;
        return;
    }
}

void fibrad_bed_warn_of_sources(fibrad_bed *bed, const fibrad_heat_sources *s, const double *temperature) {
    uint32_t zeros = 0, first = 0;
    double most = -1;
    withdraw(bed, FIBRAD_WARNING_COLD, FIBRAD_WARNING_STORE);
    for (uint32_t i = 0; i < bed->facts.spheres && temperature; ++i) {
        if (temperature[i] > most) most = temperature[i];
        if (temperature[i] == 0 && zeros++ == 0) first = i;
    }
    if (most > 0 && most < COLD)
        new_warning(bed->warning, FIBRAD_WARNING_COLD, 0, most);
    else
        warn_of_celsius(bed, s);
    if (zeros > 0 && most > 0) new_warning(bed->warning, FIBRAD_WARNING_ZERO, first, most)->count = zeros;
}

void fibrad_bed_warn_of_surfaces(fibrad_bed *bed, const fibrad_heat_result *result) {
    for (uint32_t i = 0; i < bed->facts.spheres && result->least_temperature; ++i) {
        if (!(result->least_temperature[i] < 0)) continue;
        new_warning(bed->warning, FIBRAD_WARNING_SURFACE, i, result->least_temperature[i]);
        return;
    }
}

void fibrad_bed_warn_of_stores(fibrad_bed *bed, const double *capacity) {
    for (uint32_t i = 0; i < bed->facts.spheres; ++i) {
        const double store = capacity[i] / fibrad_scene_volume(bed->scene, i);
        if ((store >= STORE_LOW && store <= STORE_HIGH) || store == INFINITY) continue;
        new_warning(bed->warning, FIBRAD_WARNING_STORE, i, store);
        return;
    }
}

void fibrad_bed_warn_of_rows(fibrad_bed *bed, const fibrad_factors *matrix) {
    const bool walls = matrix->wall_wall != NULL;
    withdraw(bed, FIBRAD_WARNING_OPEN_ROWS, FIBRAD_WARNING_CHANGED_ROW);
    if (walls && matrix->wall_closure > CLOSED)
        new_warning(bed->warning, FIBRAD_WARNING_OPEN_ROWS, 0, matrix->wall_closure);
    else if (walls && matrix->wall_correction > APART)
        new_warning(bed->warning, FIBRAD_WARNING_APART, 0, matrix->wall_correction);
    else if (matrix->changed > CHANGE_LARGE && matrix->changed * matrix->error[matrix->changed_row] > CHANGE_LEAST)
        new_warning(bed->warning, FIBRAD_WARNING_CHANGED_ROW,
                    bed->bodies ? bed->bodies->member[bed->bodies->start[matrix->changed_row]] : matrix->changed_row,
                    matrix->changed);
}

uint32_t fibrad_bed_warnings(const fibrad_bed *bed, fibrad_warning *warning) {
    fibrad_warning list[FIBRAD_WARNINGS_MAX];
    uint32_t count = 0;
    if (!bed) return 0;
    memcpy(list, bed->warning, sizeof list);
    warn_of_places(bed, list);
    for (int k = 0; k < FIBRAD_WARNINGS_MAX; ++k)
        if (list[k].code) warning[count++] = list[k];
    return count;
}
