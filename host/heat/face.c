/* face.c - the hemispherical emissivity of the open face of a bed. SPDX-License-Identifier: MIT */
#include <gsl/gsl_math.h>
#include <math.h>

#include "cli/message.h"
#include "heat/heat.h"

/* Paths to begin with; the relative error at which to stop; the estimated error over that of a row, which eight batches
 * of paths tell. The emissivity of a face is about the root of that of spheres. */
enum { FACE_PATHS = 65536 };
#define FACE_TOLERANCE 1e-3
#define FACE_LEAST     .05 /* mean emissivity of spheres below which the tolerance stays */
#define FACE_ERROR     1.2

/* The ends of a bed: planes, openings and periods. Infinite: there is no end. */
struct ends {
    double low[3], high[3];
    bool walled[6]; /* by side, x low to z high */
    double round;   /* area of the cylinder's circle; 0: there is none */
};

static void end_at(struct ends *ends, const fibrad_plane *plane, bool wall) {
    *(plane->upper ? &ends->high[plane->axis] : &ends->low[plane->axis]) = plane->at;
    ends->walled[2 * plane->axis + plane->upper] = wall;
}

/* The area of the open face on a side, 0 if the side is closed. */
static double open_area(const struct ends *ends, int side) {
    const int u = (side / 2 + 1) % 3, v = (side / 2 + 2) % 3;
    if (ends->walled[side]) return 0;
    return ends->round > 0 ? ends->round : (ends->high[u] - ends->low[u]) * (ends->high[v] - ends->low[v]);
}

static struct ends ends_of(const struct bed *bed, const struct walls *walls) {
    struct ends ends = {.round = 0};
    for (int axis = 0; axis < 3; ++axis) {
        const bool periodic = bed->period[axis] > 0;
        ends.low[axis] = periodic ? 0 : -INFINITY, ends.high[axis] = periodic ? bed->period[axis] : INFINITY;
        ends.walled[2 * axis] = ends.walled[2 * axis + 1] = periodic;
    }
    for (uint32_t k = 0; k < walls->count; ++k) {
        const fibrad_wall *wall = &walls->wall[k];
        if (wall->kind == FIBRAD_WALL_PLANE) end_at(&ends, &wall->plane, true);
        if (wall->kind == FIBRAD_WALL_CYLINDER) {
            ends.round = M_PI * gsl_pow_2(wall->cylinder.radius);
            for (int side = 0; side < 6; ++side) ends.walled[side] |= wall_across(wall, side / 2);
        }
    }
    for (uint32_t k = 0; k < walls->openings; ++k) end_at(&ends, &walls->opening[k], false);
    return ends;
}

/* Adds an opening on each open side. Where there is none, it lies at the end of the spheres. */
static void open_sides(const struct bed *bed, const struct ends *ends, struct walls *opened) {
    for (int side = 0; side < 6; ++side) {
        const int axis = side / 2, upper = side % 2;
        if (ends->walled[side] || isfinite(upper ? ends->high[axis] : ends->low[axis])) continue;
        opened->opening[opened->openings++] = (fibrad_plane){axis, upper, bed_reach(bed, axis, upper)};
    }
}

int face_begin(struct heat *h, struct walls *opened) {
    const struct ends ends = ends_of(h->bed, &h->walls);
    struct face *face = &h->face;
    face->area = 0;
    if (!face->wanted) return STATUS_OK;
    if (h->walls.meshes && h->walls.meshes->triangles.n > 0)
        return message(STATUS_USAGE, "--face: the open face must be bounded by planes, a cylinder or periods, not by "
                                     "triangles");
    for (int side = 0; side < 6; ++side) face->area += open_area(&ends, side);
    if (face->area == 0) return message(STATUS_USAGE, "--face: the bed has no open face");
    if (!(face->area < INFINITY))
        return message(STATUS_USAGE, "--face: an open face has no end; walls or periods must stand around it");
    open_sides(h->bed, &ends, opened);
    return STATUS_OK;
}

int face_solve(struct heat *h) {
    const struct bed *bed = h->bed;
    struct face *face = &h->face;
    if (!face->wanted) return STATUS_OK;
    const struct ends ends = ends_of(bed, &h->walls);
    double of_walls[WALLS_MAX], mean = 0, sum = 0, square = 0;
    for (uint32_t k = 0; k < h->walls.count; ++k) of_walls[k] = h->sources.insulated[k] ? 0 : h->wall_emissivity[k];
    for (uint32_t i = 0; i < bed->n; ++i) mean += h->emissivity[i] / bed->n;
    const fibrad_wall_rule rule = {.emissivity = h->emissivity, .wall_emissivity = of_walls, .paths = FACE_PATHS};
    const double tolerance = FACE_TOLERANCE * sqrt(fmax(FACE_LEAST, mean));
    fibrad_fault fault;
    int status = FIBRAD_OK;
    for (int side = 0; side < 6 && !status; ++side) {
        const double area = open_area(&ends, side);
        fibrad_wall_row row;
        if (!(area > 0)) continue;
        status =
            fibrad_bed_wall_row(h->made, FIBRAD_OPENING(h->walls.count, side / 2, side % 2), &rule, tolerance, &row);
        sum += area * (1 - row.escaped), square += gsl_pow_2(area * FACE_ERROR * row.error);
    }
    face->emissivity = sum / face->area, face->error = sqrt(square) / face->area;
    fibrad_bed_describe(h->made, NULL, &fault);
    return bed_options_status(&h->options, bed, status, &fault);
}

void face_report(struct heat *h) {
    const struct face *face = &h->face;
    struct report *report = &h->options.report;
    if (!face->wanted) return;
    report_value(report, "face_area_m2", face->area * h->bed->metres * h->bed->metres, 6);
    report_measured(report, "face_emissivity", face->emissivity, face->error);
    report_value(report, "face_emissivity_error", face->error, 2);
}
