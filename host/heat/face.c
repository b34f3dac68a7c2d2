/* face.c - the hemispherical emissivity of the open face of a bed. SPDX-License-Identifier: MIT */
#include "heat/face.h"

#include <gsl/gsl_math.h>
#include <math.h>
#include <stdlib.h>

#include "cli/message.h"

#define FACE_TEMPERATURE 1000. /* [K] any one */

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

static struct ends ends_of(const struct bed *bed, const struct walls *walls) {
    struct ends ends = {.round = 0};
    for (int axis = 0; axis < 3; ++axis) {
        const bool periodic = bed->period[axis] > 0;
        ends.low[axis] = periodic ? 0 : -INFINITY, ends.high[axis] = periodic ? bed->period[axis] : INFINITY;
        ends.walled[2 * axis] = ends.walled[2 * axis + 1] = periodic;
    }
    for (uint32_t k = 0; k < walls->count; ++k) {
        const fibrad_body *body = &walls->body[k];
        if (body->kind == FIBRAD_BODY_PLANE) end_at(&ends, &body->plane, true);
        if (body->kind == FIBRAD_BODY_CYLINDER) {
            ends.round = M_PI * gsl_pow_2(body->cylinder.radius);
            for (int side = 0; side < 4; ++side) ends.walled[side] = true;
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
    for (int side = 0; side < 6; ++side) {
        const int axis = side / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        if (ends.walled[side]) continue;
        const double across = (ends.high[u] - ends.low[u]) * (ends.high[v] - ends.low[v]);
        face->area += ends.round > 0 ? ends.round : across;
    }
    if (face->area == 0) return message(STATUS_USAGE, "--face: the bed has no open face");
    if (!(face->area < INFINITY))
        return message(STATUS_USAGE, "--face: an open face has no end; walls or periods must stand around it");
    return STATUS_OK;
}

int face_solve(struct face *face, const fibrad_heat_sources *sources, uint32_t spheres, uint32_t walls,
               fibrad_radiation *radiation) {
    if (!face->wanted) return FIBRAD_OK;
    double *power = calloc(spheres + (size_t)1, sizeof *power),
           *temperature = calloc(spheres + (size_t)1, sizeof *power);
    double of_walls[WALLS_MAX] = {0}, wall_temperature[WALLS_MAX];
    fibrad_heat_sources same = *sources;
    fibrad_heat_result result = {.power = power, .body_power = of_walls};
    int status = power && temperature ? FIBRAD_OK : FIBRAD_E_MEMORY;
    for (uint32_t i = 0; i < spheres && !status; ++i) temperature[i] = FACE_TEMPERATURE;
    for (uint32_t k = 0; k < walls; ++k) wall_temperature[k] = FACE_TEMPERATURE;
    same.temperature = temperature, same.body_temperature = wall_temperature, same.surroundings = 0;
    same.power = same.body_power = same.hold = same.reference = same.side_temperature = same.absorbed = NULL;
    same.conductivity = NULL; /* all of a sphere has one temperature */
    if (!status) status = fibrad_radiation_solve(radiation, &same, &result);
    const double black = same.sigma * gsl_pow_4(FACE_TEMPERATURE) * face->area;
    face->emissivity = result.surroundings_power / black, face->error = result.surroundings_error / black;
    free(power);
    free(temperature);
    return status;
}

void face_report(const struct face *face, double metres, struct report *report) {
    if (!face->wanted) return;
    report_value(report, "face_area_m2", face->area * metres * metres, 6);
    report_measured(report, "face_emissivity", face->emissivity, face->error);
}
