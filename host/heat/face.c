/* face.c - the hemispherical emissivity of the open face of a bed. SPDX-License-Identifier: MIT */
#include "heat/face.h"

#include <gsl/gsl_math.h>
#include <math.h>

#include "bed/bed_scene.h"
#include "cli/message.h"

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

int face_begin(struct face *face, const struct bed *bed, const struct walls *walls) {
    const struct ends ends = ends_of(bed, walls);
    face->area = 0;
    if (!face->wanted) return STATUS_OK;
    if (walls->meshes && walls->meshes->triangles.n > 0)
        return message(STATUS_USAGE, "--face: the open face must be bounded by planes, a cylinder or periods, not by "
                                     "triangles");
    for (int side = 0; side < 6; ++side) face->area += open_area(&ends, side);
    if (face->area == 0) return message(STATUS_USAGE, "--face: the bed has no open face");
    if (!(face->area < INFINITY))
        return message(STATUS_USAGE, "--face: an open face has no end; walls or periods must stand around it");
    return STATUS_OK;
}

/* The walls, with an opening on each open side. Where there is none, it lies at the end of the spheres. */
static struct walls opened_walls(const struct bed *bed, const struct walls *walls, const struct ends *ends) {
    struct walls all = *walls;
    for (int side = 0; side < 6; ++side) {
        const int axis = side / 2, upper = side % 2;
        if (ends->walled[side] || isfinite(upper ? ends->high[axis] : ends->low[axis])) continue;
        all.opening[all.openings++] = (fibrad_plane){axis, upper, bed_reach(bed, axis, upper)};
    }
    return all;
}

int face_solve(struct face *face, const struct bed *bed, const struct walls *walls, const fibrad_heat_sources *sources,
               fibrad_run *run) {
    if (!face->wanted) return FIBRAD_OK;
    const struct ends ends = ends_of(bed, walls);
    const struct walls all = opened_walls(bed, walls, &ends);
    const fibrad_scene_config scene = bed_scene(bed, &all);
    const fibrad_spheres spheres = bed_spheres(bed);
    double of_walls[WALLS_MAX], mean = 0, sum = 0, square = 0;
    for (uint32_t k = 0; k < walls->count; ++k) of_walls[k] = sources->insulated[k] ? 0 : sources->wall_emissivity[k];
    for (uint32_t i = 0; i < bed->n; ++i) mean += sources->emissivity[i] / bed->n;
    const fibrad_exchange_rule rule = {.emissivity = sources->emissivity,
                                       .wall_emissivity = of_walls,
                                       .paths = FACE_PATHS,
                                       .tolerance = FACE_TOLERANCE * sqrt(fmax(FACE_LEAST, mean))};
    int status = FIBRAD_OK;
    for (int side = 0; side < 6 && !status; ++side) {
        const double area = open_area(&ends, side);
        fibrad_wall_row row;
        if (!(area > 0)) continue;
        status =
            fibrad_exchange_wall_row(&scene, &spheres, FIBRAD_OPENING(all.count, side / 2, side % 2), &rule, run, &row);
        sum += area * (1 - row.escaped), square += gsl_pow_2(area * FACE_ERROR * row.error);
    }
    face->emissivity = sum / face->area, face->error = sqrt(square) / face->area;
    return status;
}

void face_report(const struct face *face, double metres, struct report *report) {
    if (!face->wanted) return;
    report_value(report, "face_area_m2", face->area * metres * metres, 6);
    report_measured(report, "face_emissivity", face->emissivity, face->error);
    report_value(report, "face_emissivity_error", face->error, 2);
}
