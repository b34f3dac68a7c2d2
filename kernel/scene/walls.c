/* walls.c - the planes and the cylinder of a scene: checks, hits, normals and areas. SPDX-License-Identifier: MIT */
#include "scene/walls.h"

#include "base/elementary.h"

#define INFINITE   __builtin_inf()
#define BALL_SLACK 1e-12 /* rounding error of a length, relative */
#define CAP_LEAST  1e-9  /* [radii] least depth at which a wall cuts a sphere */

static bool wall_length_valid(double length) { return fibrad_abs(length) <= FIBRAD_LENGTH_MAX; }

/* The slot of a plane. FIBRAD_WALLS: the plane is not valid. */
static uint32_t slot_of_plane(const fibrad_plane *plane) {
    const int axis = plane->axis, upper = plane->upper;
    const bool valid = axis >= 0 && axis < 3 && (upper == 0 || upper == 1) && wall_length_valid(plane->at);
    return valid ? fibrad_face((uint32_t)axis, upper) : FIBRAD_WALLS;
}

static uint32_t slot_of_wall(const fibrad_wall *wall) {
    if (wall->kind == FIBRAD_WALL_PLANE) return slot_of_plane(&wall->plane);
    const bool valid = wall->kind == FIBRAD_WALL_CYLINDER && wall_length_valid(wall->cylinder.x) &&
                       wall_length_valid(wall->cylinder.y) && wall_length_valid(wall->cylinder.radius) &&
                       wall->cylinder.radius > 0 && wall->cylinder.along >= 0 && wall->cylinder.along < 3;
    return valid ? FIBRAD_CYLINDER : FIBRAD_WALLS;
}

/* The planes found so far by slot, openings too, and the cylinder. */
typedef struct found_walls {
    const fibrad_plane *plane[FIBRAD_CYLINDER];
    const fibrad_wall *cylinder;
} found_walls;

/* Notes a plane. FIBRAD_E_ARGUMENT: the plane is not valid, its side has a plane already, or its axis is periodic. */
static int find_plane(const fibrad_scene_config *config, const fibrad_plane *plane, found_walls *found) {
    const uint32_t slot = slot_of_plane(plane);
    if (slot == FIBRAD_WALLS || found->plane[slot] != NULL || config->period[fibrad_face_axis(slot)] > 0)
        return FIBRAD_E_ARGUMENT;
    found->plane[slot] = plane;
    return FIBRAD_OK;
}

static int find_wall(const fibrad_scene_config *config, const fibrad_wall *wall, found_walls *found) {
    if (wall->kind == FIBRAD_WALL_PLANE) return find_plane(config, &wall->plane, found);
    if (wall->kind == FIBRAD_WALL_MESH)
        return config->triangles == NULL || config->triangles->n == 0 ? FIBRAD_E_ARGUMENT : FIBRAD_OK;
    if (slot_of_wall(wall) == FIBRAD_WALLS || found->cylinder != NULL) return FIBRAD_E_ARGUMENT;
    found->cylinder = wall;
    return FIBRAD_OK;
}

/* Whether an axis lies across the cylinder. */
static bool is_across(const found_walls *found, uint32_t axis) {
    return found->cylinder != NULL && (int)axis != found->cylinder->cylinder.along;
}

/* Whether an axis is bounded on both sides or periodic. */
static bool axis_is_closed(const fibrad_scene_config *config, const found_walls *found, uint32_t axis) {
    const bool periodic = config->period[axis] > 0 || (config->occupancy != NULL && config->occupancy->periodic[axis]);
    return periodic ||
           (found->plane[fibrad_face(axis, false)] != NULL && found->plane[fibrad_face(axis, true)] != NULL) ||
           is_across(found, axis);
}

int fibrad_walls_check(const fibrad_scene_config *config) {
    found_walls found = {0};
    if ((config->walls > 0 && config->wall == NULL) || (config->openings > 0 && config->opening == NULL))
        return FIBRAD_E_ARGUMENT;
    if (config->walls > FIBRAD_WALLS_MAX) return FIBRAD_E_UNSUPPORTED;
    int status = FIBRAD_OK;
    for (uint32_t b = 0; b < config->walls && status == FIBRAD_OK; b++)
        status = find_wall(config, &config->wall[b], &found);
    for (uint32_t k = 0; k < config->openings && status == FIBRAD_OK; k++)
        status = find_plane(config, &config->opening[k], &found);
    if (status != FIBRAD_OK) return status;
    bool closed = true, across = false;
    uint32_t walled = 0;
    for (uint32_t axis = 0; axis < 3; axis++) {
        const fibrad_plane *low = found.plane[fibrad_face(axis, false)], *high = found.plane[fibrad_face(axis, true)];
        if (low != NULL && high != NULL && !(low->at < high->at)) return FIBRAD_E_ARGUMENT;
        walled += low != NULL || high != NULL;
        across = across || (is_across(&found, axis) && (low != NULL || high != NULL || config->period[axis] > 0));
        closed = closed && axis_is_closed(config, &found, axis);
    }
    if (across) return FIBRAD_E_ARGUMENT;
    return (found.cylinder != NULL || walled > 1) && !closed ? FIBRAD_E_ENDLESS : FIBRAD_OK;
}

/* The length of the container along an axis. On a periodic axis this is the period. */
static double container_extent(const fibrad_scene *scene, uint32_t axis) {
    const fibrad_container *c = &scene->container;
    return scene->period[axis] > 0 ? scene->period[axis] : c->high[axis] - c->low[axis];
}

/* Area of the wall of a slot. */
static double wall_area_of(const fibrad_scene *scene, uint32_t slot) {
    const double radius = scene->container.radius;
    if (slot == FIBRAD_CYLINDER)
        return 2 * FIBRAD_PI * radius * container_extent(scene, fibrad_cylinder_axis(scene->container.turn, 2));
    if (radius < INFINITE) return FIBRAD_PI * radius * radius;
    return container_extent(scene, fibrad_face_along(slot, 0)) * container_extent(scene, fibrad_face_along(slot, 1));
}

static void set_plane(fibrad_container *c, const fibrad_plane *plane) {
    (plane->upper ? c->high : c->low)[plane->axis] = plane->at;
}

/* The position is given in the order x, y, z. Of a cylinder along y, the first axis across it is z. */
static void set_cylinder(fibrad_container *c, const fibrad_wall *wall) {
    const double at[2] = {wall->cylinder.x, wall->cylinder.y};
    c->turn = (uint32_t)(wall->cylinder.along + 1) % 3;
    c->axis[0] = at[c->turn == 2], c->axis[1] = at[c->turn != 2], c->radius = wall->cylinder.radius;
}

/* A vector across the cylinder, from its axis to a point [L]. */
static void from_axis(const fibrad_container *c, const double at[3], double across[2]) {
    for (uint32_t a = 0; a < 2; a++) across[a] = at[fibrad_cylinder_axis(c->turn, a)] - c->axis[a];
}

/* Where a plane crosses its axis [L]. */
static double end_of_axis(const fibrad_container *c, uint32_t slot) {
    return (fibrad_face_is_upper(slot) ? c->high : c->low)[fibrad_face_axis(slot)];
}

void fibrad_walls_build(fibrad_scene *scene, const fibrad_scene_config *config) {
    fibrad_container *c = &scene->container;
    const fibrad_wall *wall = config->wall;
    for (int axis = 0; axis < 3; axis++) c->low[axis] = -INFINITE, c->high[axis] = INFINITE;
    c->axis[0] = c->axis[1] = 0;
    c->radius = INFINITE, c->turn = 0;
    uint32_t meshes = 0, walls = 0;
    for (uint32_t b = 0; b < config->walls; b++) {
        const bool mesh = wall[b].kind == FIBRAD_WALL_MESH;
        const uint32_t slot = scene->slot[b] = mesh ? fibrad_slot_of_mesh(meshes++) : slot_of_wall(&wall[b]);
        if (mesh) continue;
        walls |= 1u << slot;
        if (slot == FIBRAD_CYLINDER)
            set_cylinder(c, &wall[b]);
        else
            set_plane(c, &wall[b].plane);
    }
    for (uint32_t k = 0; k < config->openings; k++) {
        set_plane(c, &config->opening[k]);
        c->openings |= 1u << slot_of_plane(&config->opening[k]);
    }
    walls |= c->openings;
    c->walls = walls != 0;
    for (uint32_t slot = 0; slot < FIBRAD_WALLS; slot++)
        if (walls >> slot & 1) scene->wall_area[slot] = wall_area_of(scene, slot);
}

bool fibrad_walls_hold(const fibrad_container *c, const double at[3]) {
    for (int axis = 0; axis < 3; axis++)
        if (!(at[axis] >= c->low[axis] && at[axis] <= c->high[axis])) return false;
    if (c->radius == INFINITE) return true;
    double across[2];
    from_axis(c, at, across);
    const double x = across[0] / c->radius, y = across[1] / c->radius;
    return x * x + y * y <= 1;
}

double fibrad_walls_away(const fibrad_container *c, uint32_t slot, const double at[3]) {
    const uint32_t axis = fibrad_face_axis(slot);
    if (fibrad_slot_is_plane(slot))
        return fibrad_face_is_upper(slot) ? c->high[axis] - at[axis] : at[axis] - c->low[axis];
    double across[2];
    from_axis(c, at, across);
    return c->radius - fibrad_sqrt(across[0] * across[0] + across[1] * across[1]);
}

bool fibrad_walls_hold_ball(const fibrad_container *c, const double centre[3], double radius) {
    for (uint32_t slot = 0; slot < FIBRAD_CYLINDER; slot++)
        if (fibrad_is_opening(c, slot) && !(radius - fibrad_walls_away(c, slot, centre) <=
                                            BALL_SLACK * (radius + fibrad_abs(centre[fibrad_face_axis(slot)]))))
            return false;
    return true;
}

bool fibrad_walls_cut(const fibrad_container *c, const double centre[3], double radius) {
    const double clear = radius * (1 - CAP_LEAST);
    bool cut = c->radius < INFINITE && fibrad_walls_away(c, FIBRAD_CYLINDER, centre) < clear;
    for (int axis = 0; axis < 3; axis++)
        cut |= (centre[axis] - c->low[axis] < clear) | (c->high[axis] - centre[axis] < clear);
    return cut;
}

double fibrad_walls_cap(const fibrad_container *c, uint32_t slot, const double centre[3], double radius) {
    const double away = fibrad_max(0, fibrad_walls_away(c, slot, centre));
    return away < radius * (1 - CAP_LEAST) ? (radius - away) / (2 * radius) : 0;
}

uint32_t fibrad_walls_behind(const fibrad_scene *scene, uint32_t place, const double n[3], double at[3]) {
    if (!scene->cut[place]) return FIBRAD_NONE;
    const double centre[3] = {scene->x[place], scene->y[place], scene->z[place]};
    double distance;
    const uint32_t wall = fibrad_walls_exit(scene, centre, n, &distance);
    if (!(distance < scene->r[place])) return FIBRAD_NONE;
    for (int axis = 0; axis < 3; axis++) at[axis] = centre[axis] + distance * n[axis];
    return wall;
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
        const bool high = w[axis] > 0;
        const double t = ((high ? c->high[axis] : c->low[axis]) - origin[axis]) / w[axis];
        if (t < least) least = t, wall = fibrad_face(axis, high);
    }
    const double u = w[fibrad_cylinder_axis(c->turn, 0)], v = w[fibrad_cylinder_axis(c->turn, 1)];
    const double across = u * u + v * v;
    if (c->radius < INFINITE && across > 0) {
        double from[2];
        from_axis(c, origin, from);
        const double x = from[0], y = from[1], along = x * u + y * v, inside = c->radius * c->radius - (x * x + y * y);
        const double root = fibrad_sqrt(fibrad_max(0, along * along + across * inside));
        const double t = along > 0 ? inside / (along + root) : (root - along) / across; /* without cancellation */
        if (t < least) least = t, wall = FIBRAD_CYLINDER;
    }
    *distance = fibrad_max(0, least);
    return wall;
}

void fibrad_wall_normal(const fibrad_scene *scene, uint32_t wall, const double at[3], double normal[3]) {
    normal[0] = normal[1] = normal[2] = 0;
    if (fibrad_slot_is_plane(wall)) {
        normal[fibrad_face_axis(wall)] = fibrad_face_is_upper(wall) ? -1 : 1;
        return;
    }
    const fibrad_container *c = &scene->container;
    double from[2];
    from_axis(c, at, from);
    const double radius = fibrad_sqrt(from[0] * from[0] + from[1] * from[1]);
    for (uint32_t a = 0; a < 2; a++) normal[fibrad_cylinder_axis(c->turn, a)] = (0 - from[a]) / radius;
}

void fibrad_wall_about(const fibrad_container *c, double u, double v, double at[3]) {
    at[fibrad_cylinder_axis(c->turn, 0)] = c->axis[0] + u, at[fibrad_cylinder_axis(c->turn, 1)] = c->axis[1] + v;
}

/* Moves a point to a distance [L] and an angle [turns] from the axis of the cylinder, without moving it along. */
static void turn_about_axis(const fibrad_container *c, double radius, double turns, double at[3]) {
    double sine, cosine;
    fibrad_sincos_turn(turns, &sine, &cosine);
    fibrad_wall_about(c, radius * cosine, radius * sine, at);
}

void fibrad_wall_point(const fibrad_container *c, uint32_t wall, const double coordinate[2], double at[3]) {
    if (wall == FIBRAD_CYLINDER) {
        turn_about_axis(c, c->radius, coordinate[0], at);
        at[fibrad_cylinder_axis(c->turn, 2)] = coordinate[1];
        return;
    }
    at[fibrad_face_axis(wall)] = end_of_axis(c, wall);
    for (uint32_t edge = 0; edge < 2; edge++) at[fibrad_face_along(wall, edge)] = coordinate[edge];
}

void fibrad_wall_even_point(const fibrad_scene *scene, uint32_t wall, const double share[2], double at[3]) {
    const fibrad_container *c = &scene->container;
    double coordinate[2] = {share[0], 0};
    if (fibrad_slot_is_plane(wall) && c->radius < INFINITE) {
        at[fibrad_face_axis(wall)] = end_of_axis(c, wall);
        turn_about_axis(c, c->radius * fibrad_sqrt(share[1]), share[0], at);
        return;
    }
    for (uint32_t edge = wall == FIBRAD_CYLINDER; edge < 2; edge++) {
        const uint32_t axis = fibrad_wall_along(c, wall, edge);
        const double low = scene->period[axis] > 0 ? 0 : c->low[axis];
        coordinate[edge] = low + container_extent(scene, axis) * share[edge];
    }
    fibrad_wall_point(c, wall, coordinate, at);
}
