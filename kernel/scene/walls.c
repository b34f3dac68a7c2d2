/* walls.c - the walls of a scene: which of them a ray meets. SPDX-License-Identifier: MIT */
#include "scene/walls.h"

#define PI         3.14159265358979323846
#define INFINITE   __builtin_inf()
#define LENGTH_MAX 1e150

static bool there(const fibrad_walls *walls, uint32_t plane) { return (walls->planes >> plane & 1) != 0; }

bool fibrad_walls_valid(const fibrad_scene_config *config) {
    const fibrad_walls *walls = &config->walls;
    const double *cylinder = walls->cylinder;
    if (walls->planes >= 1u << FIBRAD_CYLINDER) return false;
    for (uint32_t k = 0; k < FIBRAD_CYLINDER; k++) {
        if (!there(walls, k)) continue;
        if (config->period[k / 2] > 0 || !(fibrad_abs(walls->at[k]) <= LENGTH_MAX)) return false;
        if (k % 2 == 1 && there(walls, k - 1) && !(walls->at[k - 1] < walls->at[k])) return false;
    }
    if (cylinder[2] == 0) return true;
    for (int k = 0; k < 3; k++)
        if (!(fibrad_abs(cylinder[k]) <= LENGTH_MAX)) return false;
    return cylinder[2] > 0 && config->period[0] == 0 && config->period[1] == 0 && (walls->planes & 15) == 0;
}

/* How far the container reaches along an axis, per period. */
static double extent(const fibrad_scene *scene, uint32_t axis) {
    const fibrad_container *c = &scene->container;
    return scene->period[axis] > 0 ? scene->period[axis] : c->high[axis] - c->low[axis];
}

void fibrad_walls_build(fibrad_scene *scene, const fibrad_walls *walls) {
    fibrad_container *c = &scene->container;
    const bool cylinder = walls->cylinder[2] > 0;
    c->walls = walls->planes != 0 || cylinder;
    for (uint32_t axis = 0; axis < 3; axis++) {
        c->low[axis] = there(walls, 2 * axis) ? walls->at[2 * axis] : -INFINITE;
        c->high[axis] = there(walls, 2 * axis + 1) ? walls->at[2 * axis + 1] : INFINITE;
    }
    c->axis[0] = cylinder ? walls->cylinder[0] : 0, c->axis[1] = cylinder ? walls->cylinder[1] : 0;
    c->radius = cylinder ? walls->cylinder[2] : INFINITE;
    for (uint32_t k = 0; k < FIBRAD_CYLINDER; k++)
        if (there(walls, k))
            scene->facts.wall_area[k] =
                cylinder ? PI * c->radius * c->radius : extent(scene, (k / 2 + 1) % 3) * extent(scene, (k / 2 + 2) % 3);
    if (cylinder) scene->facts.wall_area[FIBRAD_CYLINDER] = 2 * PI * c->radius * extent(scene, 2);
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
