/* face.c - the hemispherical emissivity of the open face of a bed. SPDX-License-Identifier: MIT */
#include <gsl/gsl_math.h>

#include "heat/heat.h"
#include "simple/bed.h"

/* Paths to begin with; the relative error at which to stop; the estimated error over that of a row, which eight batches
 * of paths tell. The emissivity of a face is about the root of that of spheres. */
enum { FACE_PATHS = 65536 };
#define FACE_TOLERANCE 1e-3
#define FACE_LEAST     .05 /* mean emissivity of spheres below which the tolerance stays */
#define FACE_ERROR     1.2

int face_begin(struct heat *h, struct walls *opened) {
    int open = 0, endless = 0; /* bits of axes with open sides, and of those that go on without end */
    if (!h->face.wanted) return STATUS_OK;
    if (h->walls.meshes && h->walls.meshes->triangles.n > 0)
        return message(STATUS_USAGE, "--face: the open face must be bounded by planes, a cylinder or periods, not by "
                                     "triangles");
    for (int side = 0; side < PLANES; ++side) {
        const int axis = side / 2, upper = side % 2;
        bool opening = false;
        if (walls_close(&h->walls, h->bed, side)) continue;
        for (uint32_t k = 0; k < h->walls.openings; ++k)
            opening |= h->walls.opening[k].axis == axis && h->walls.opening[k].upper == upper;
        open |= 1 << axis, endless |= !opening << axis;
        if (!opening) /* at the end of the spheres */
            opened->opening[opened->openings++] = (fibrad_plane){axis, upper, bed_reach(h->bed, axis, upper)};
    }
    if (!open) return message(STATUS_USAGE, "--face: the bed has no open face");
    if (!endless || !(open & (open - 1))) return STATUS_OK;
    return message(STATUS_USAGE, "--face: an open face has no end; walls or periods must stand around it");
}

int face_solve(struct heat *h) {
    const struct bed *bed = h->bed;
    struct face *face = &h->face;
    if (!face->wanted) return STATUS_OK;
    double of_walls[WALLS_MAX], mean = 0, sum = 0, square = 0;
    for (uint32_t k = 0; k < h->walls.count; ++k) of_walls[k] = h->sources.insulated[k] ? 0 : h->wall_emissivity[k];
    for (uint32_t i = 0; i < bed->n; ++i) mean += h->emissivity[i] / bed->n;
    const fibrad_wall_rule rule = {.emissivity = h->emissivity, .wall_emissivity = of_walls, .paths = FACE_PATHS};
    const double tolerance = FACE_TOLERANCE * sqrt(fmax(FACE_LEAST, mean));
    int status = FIBRAD_OK;
    face->area = 0;
    for (int side = 0; side < PLANES && !status; ++side) {
        const uint32_t opening = FIBRAD_OPENING(h->walls.count, side / 2, side % 2);
        const double area = fibrad_scene_wall_area(h->made->scene, opening);
        fibrad_wall_row row;
        if (isnan(area)) continue;
        status = fibrad_bed_wall_row(h->made, opening, &rule, tolerance, &row);
        sum += area * (1 - row.escaped), square += gsl_pow_2(area * FACE_ERROR * row.error), face->area += area;
    }
    face->emissivity = sum / face->area, face->error = sqrt(square) / face->area;
    return bed_options_made(&h->options, bed, h->made, status);
}

void face_report(struct heat *h) {
    const struct face *face = &h->face;
    struct report *report = &h->options.report;
    if (!face->wanted) return;
    report_value(report, "face_area_m2", face->area * h->bed->metres * h->bed->metres, 6);
    report_measured(report, "face_emissivity", face->emissivity, face->error);
    report_value(report, "face_emissivity_error", face->error, 2);
}
