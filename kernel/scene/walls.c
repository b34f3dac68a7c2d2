/* walls.c - the walls of a scene: which of them a ray meets. SPDX-License-Identifier: MIT */
#include "scene/walls.h"

#include "base/constants.h"

#define INFINITE        __builtin_inf()
#define WALL_LENGTH_MAX 1e150

static bool wall_length_valid(double length) { return fibrad_abs(length) <= WALL_LENGTH_MAX; }

/* The slot of a plane or a cylinder; FIBRAD_WALLS: it is not valid. */
static uint32_t slot_of_body(const fibrad_body *body) {
    if (body->kind == FIBRAD_BODY_CYLINDER) {
        const bool valid = wall_length_valid(body->cylinder.x) && wall_length_valid(body->cylinder.y) &&
                           wall_length_valid(body->cylinder.radius) && body->cylinder.radius > 0;
        return valid ? FIBRAD_CYLINDER : FIBRAD_WALLS;
    }
    const int axis = body->plane.axis, upper = body->plane.upper;
    const bool valid = body->kind == FIBRAD_BODY_PLANE && axis >= 0 && axis < 3 && (upper == 0 || upper == 1) &&
                       wall_length_valid(body->plane.at);
    return valid ? (uint32_t)(2 * axis + upper) : FIBRAD_WALLS;
}

int fibrad_walls_check(const fibrad_scene_config *config) {
    const fibrad_body *found[FIBRAD_WALLS] = {NULL};
    if (config->bodies > 0 && config->body == NULL) return FIBRAD_E_ARGUMENT;
    if (config->bodies > FIBRAD_BODIES_MAX) return FIBRAD_E_UNSUPPORTED;
    for (uint32_t b = 0; b < config->bodies; b++) {
        if (config->body[b].kind == FIBRAD_BODY_MESH) {
            if (config->triangles == NULL || config->triangles->n == 0) return FIBRAD_E_ARGUMENT;
            continue;
        }
        const uint32_t slot = slot_of_body(&config->body[b]);
        if (slot == FIBRAD_WALLS || found[slot] != NULL) return FIBRAD_E_ARGUMENT;
        if (slot < FIBRAD_CYLINDER && config->period[slot / 2] > 0) return FIBRAD_E_ARGUMENT;
        found[slot] = &config->body[b];
    }
    for (uint32_t k = 0; k < FIBRAD_CYLINDER; k += 2)
        if (found[k] != NULL && found[k + 1] != NULL && !(found[k]->plane.at < found[k + 1]->plane.at))
            return FIBRAD_E_ARGUMENT;
    if (found[FIBRAD_CYLINDER] == NULL) return FIBRAD_OK;
    const bool across = found[0] != NULL || found[1] != NULL || found[2] != NULL || found[3] != NULL;
    return across || config->period[0] > 0 || config->period[1] > 0 ? FIBRAD_E_ARGUMENT : FIBRAD_OK;
}

/* How far the container extends along an axis, per period. */
static double container_extent(const fibrad_scene *scene, uint32_t axis) {
    const fibrad_container *c = &scene->container;
    return scene->period[axis] > 0 ? scene->period[axis] : c->high[axis] - c->low[axis];
}

/* Area of the wall of a slot. */
static double wall_area_of(const fibrad_scene *scene, uint32_t slot) {
    const double radius = scene->container.radius;
    if (slot == FIBRAD_CYLINDER) return 2 * FIBRAD_PI * radius * container_extent(scene, 2);
    if (radius < INFINITE) return FIBRAD_PI * radius * radius;
    return container_extent(scene, (slot / 2 + 1) % 3) * container_extent(scene, (slot / 2 + 2) % 3);
}

void fibrad_walls_build(fibrad_scene *scene, const fibrad_body *body, uint32_t bodies) {
    fibrad_container *c = &scene->container;
    for (int axis = 0; axis < 3; axis++) c->low[axis] = -INFINITE, c->high[axis] = INFINITE;
    c->axis[0] = c->axis[1] = 0;
    c->radius = INFINITE;
    uint32_t meshes = 0;
    for (uint32_t b = 0; b < bodies; b++) {
        const bool mesh = body[b].kind == FIBRAD_BODY_MESH;
        const uint32_t slot = scene->slot[b] = mesh ? FIBRAD_MESHES + meshes++ : slot_of_body(&body[b]);
        if (mesh) continue;
        c->walls = true;
        if (slot == FIBRAD_CYLINDER)
            c->axis[0] = body[b].cylinder.x, c->axis[1] = body[b].cylinder.y, c->radius = body[b].cylinder.radius;
        else if (slot % 2 == 0)
            c->low[slot / 2] = body[b].plane.at;
        else
            c->high[slot / 2] = body[b].plane.at;
    }
    for (uint32_t b = 0; b < bodies; b++)
        if (scene->slot[b] < FIBRAD_WALLS) scene->wall_area[scene->slot[b]] = wall_area_of(scene, scene->slot[b]);
}

bool fibrad_walls_hold(const fibrad_container *c, const double at[3]) {
    for (int axis = 0; axis < 3; axis++)
        if (!(at[axis] >= c->low[axis] && at[axis] <= c->high[axis])) return false;
    if (c->radius == INFINITE) return true;
    const double x = (at[0] - c->axis[0]) / c->radius, y = (at[1] - c->axis[1]) / c->radius;
    return x * x + y * y <= 1;
}

double fibrad_walls_reach(const fibrad_container *c) {
    const double at[] = {c->low[0],  c->low[1],  c->low[2],  c->high[0], c->high[1],
                         c->high[2], c->axis[0], c->axis[1], c->radius};
    double largest = 0;
    for (size_t k = 0; k < sizeof at / sizeof *at; k++)
        if (fibrad_finite(at[k])) largest = fibrad_max(largest, fibrad_abs(at[k]));
    return largest;
}

uint32_t fibrad_walls_exit(const fibrad_scene *scene, const double origin[3], const double w[3], double *distance) {
    const fibrad_container *c = &scene->container;
    double least = INFINITE;
    uint32_t wall = FIBRAD_NONE;
    for (uint32_t axis = 0; axis < 3; axis++) {
        if (w[axis] == 0) continue;
        const uint32_t high = w[axis] > 0;
        const double t = ((high ? c->high[axis] : c->low[axis]) - origin[axis]) / w[axis];
        if (t < least) least = t, wall = 2 * axis + high;
    }
    const double across = w[0] * w[0] + w[1] * w[1];
    if (c->radius < INFINITE && across > 0) {
        const double x = origin[0] - c->axis[0], y = origin[1] - c->axis[1];
        const double along = x * w[0] + y * w[1], inside = c->radius * c->radius - (x * x + y * y);
        const double root = fibrad_sqrt(fibrad_max(0, along * along + across * inside));
        const double t = along > 0 ? inside / (along + root) : (root - along) / across; /* without cancellation */
        if (t < least) least = t, wall = FIBRAD_CYLINDER;
    }
    *distance = fibrad_max(0, least);
    return wall;
}

void fibrad_wall_normal(const fibrad_scene *scene, uint32_t wall, const double at[3], double normal[3]) {
    normal[0] = normal[1] = normal[2] = 0;
    if (wall < FIBRAD_CYLINDER) {
        normal[wall / 2] = wall % 2 == 0 ? 1 : -1;
        return;
    }
    const double x = scene->container.axis[0] - at[0], y = scene->container.axis[1] - at[1];
    const double radius = fibrad_sqrt(x * x + y * y);
    normal[0] = x / radius, normal[1] = y / radius;
}
