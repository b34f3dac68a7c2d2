/* wall_patch.c - the patches of walls and meshes, and the rays that leave them. SPDX-License-Identifier: MIT */
#include "base/elementary.h"
#include "base/vector.h"
#include "patches/subdivision.h"
#include "scene/walls.h"

/* Patches of walls are about as large as those of spheres. Their number is limited: to FEW times the patches of one
 * sphere plus a fourth of the patches of all spheres.
 *
 * Beams of spheres tell what spheres and walls exchange. Rays of walls only tell what walls exchange with each other.
 * Behind a bed that is little. So a few rays of each patch suffice. There are at least `wall_rays` in all. The default
 * is FIBRAD_WALL_RAYS_DEFAULT, or RAYS_PER_BEAM for each beam of one sphere. So more beams make the exchange of walls
 * better, too. */
#define FEW            16.0 /* times the patches of a sphere */
#define OUTSIDE        4.0  /* patches of meshes, also outside the walls, may be this many times the limit */
#define RAYS_PER_PATCH 8.0
#define RAYS_PER_BEAM  6.0
#define SHARE_OF_MESH  4.0 /* a mesh sends at least one ray of so many, if there are not more meshes */

/* The longest finite edge of the container; 1 if there is none. */
static double container_size(const fibrad_scene *scene) {
    double longest = 0;
    for (int axis = 0; axis < 3; axis++) {
        const double length = scene->container.high[axis] - scene->container.low[axis];
        longest = fibrad_max(longest, fibrad_max(scene->period[axis], fibrad_finite(length) ? length : 0));
    }
    if (fibrad_finite(scene->container.radius)) longest = fibrad_max(longest, scene->container.radius);
    return longest > 0 ? longest : 1;
}

/* The interval of a wall along one axis that is cut into patches: all of it, or, if the wall is endless, the bed and as
 * much on either side. Returns whether the wall is endless. */
static bool interval_along(const fibrad_scene *scene, uint32_t axis, double *low, double *size) {
    const fibrad_container *c = &scene->container;
    double wide = 0;
    for (int a = 0; a < 3; a++)
        wide = fibrad_max(wide, scene->box_high[a] - scene->box_low[a] + 2 * scene->facts.radius_max);
    double from = c->low[axis], to = c->high[axis];
    if (scene->period[axis] > 0) from = scene->low[axis], to = scene->low[axis] + scene->period[axis];
    for (uint32_t a = 0; a < 2 && c->radius < __builtin_inf(); a++)
        if (axis == fibrad_cylinder_axis(c->turn, a)) from = c->axis[a] - c->radius, to = c->axis[a] + c->radius;
    double begin = scene->box_low[axis], end = scene->box_high[axis];
    if (scene->facts.spheres == 0) { /* no bed tells where walls are */
        wide = container_size(scene);
        begin = end = fibrad_finite(from) ? from : fibrad_finite(to) ? to : 0;
    }
    *low = fibrad_finite(from) ? from : begin - wide;
    *size = (fibrad_finite(to) ? to : end + wide) - *low;
    return !fibrad_finite(from) || !fibrad_finite(to);
}

double fibrad_heat_wall_area(const fibrad_heat *heat, uint32_t wall) {
    const fibrad_heat_wall *w = &heat->wall[wall];
    double around = wall == FIBRAD_CYLINDER ? 2 * FIBRAD_PI * heat->scene->container.radius : 1;
    return w->size[0] * around * w->size[1];
}

/* An even number of squares, 2 at least. */
static uint32_t squares(double length, double square) {
    return 2 * (uint32_t)fibrad_max(1, fibrad_floor(fibrad_min(length / square, 1e5) / 2 + .5));
}

/* Even and odd rays have a sequence each. The seed is that of the wall. */
void fibrad_heat_ray_coordinates(uint64_t seed, uint32_t k, double x[4]) {
    for (int d = 0; d < 4; d++) x[d] = fibrad_quasirandom(4, d, k / 2, 2 * seed + k % 2);
}

/* Sets the rays of a wall of a given area. They are numbered after those of all walls before it. */
static void send_rays(fibrad_heat *heat, uint32_t slot, double area, double density) {
    fibrad_heat_rays *sent = &heat->sent[slot];
    *sent = (fibrad_heat_rays){.first = heat->rays};
    if (!(area > 0)) return;
    sent->count = (uint32_t)fibrad_min(1 + density * area, 0x1p30);
    sent->density = sent->count / area;
    heat->rays += sent->count;
}

/* The area of a mesh inside the planes and the cylinder, from evenly spread points. */
#define INSIDE_POINTS 1024u
static double area_inside(const fibrad_scene *scene, uint32_t m) {
    const double area = fibrad_mesh_area(&scene->mesh, m);
    uint32_t inside = 0;
    if (!scene->container.walls || area == 0) return area;
    for (uint32_t k = 0; k < INSIDE_POINTS; k++) {
        double x[4], at[3];
        fibrad_heat_ray_coordinates(FIBRAD_MESHES + m, 2 * k, x);
        fibrad_mesh_point(&scene->mesh, m, x, at);
        inside += fibrad_walls_hold(&scene->container, at);
    }
    return area * inside / INSIDE_POINTS;
}

void fibrad_heat_cut_walls(fibrad_heat *heat) {
    const fibrad_scene *scene = heat->scene;
    double area = 0, surface = 0, meshes = 0;
    for (uint32_t k = 0; k < FIBRAD_WALLS; k++) {
        fibrad_heat_wall *wall = &heat->wall[k];
        *wall = (fibrad_heat_wall){0}, heat->sent[k] = (fibrad_heat_rays){0};
        if (!(scene->wall_area[k] > 0)) continue;
        wall->size[0] = 1;
        for (uint32_t side = k == FIBRAD_CYLINDER; side < 2; side++)
            wall->unbounded |= interval_along(scene, fibrad_wall_along(&scene->container, k, side), &wall->low[side],
                                              &wall->size[side]);
        area += fibrad_heat_wall_area(heat, k);
    }
    for (uint32_t m = 0; m < heat->meshes; m++)
        area += area_inside(scene, m), meshes += fibrad_mesh_area(&scene->mesh, m);
    if (area == 0) return;
    for (uint32_t i = 0; i < heat->spheres; i++) surface += 4 * FIBRAD_PI * scene->r[i] * scene->r[i];
    const double of_spheres = (double)heat->spheres * heat->config.patches,
                 most = FEW * heat->config.patches + of_spheres / 4;
    const double square = fibrad_sqrt(fibrad_max(surface / of_spheres, area / most));
    const double rays = heat->config.wall_rays > 0 ? heat->config.wall_rays
                                                   : fibrad_max(FIBRAD_WALL_RAYS_DEFAULT, RAYS_PER_BEAM * heat->beams);
    const double density = fibrad_max(RAYS_PER_PATCH / (square * square), rays / area);
    heat->patch_area = fibrad_max(square * square, meshes / (OUTSIDE * most));
    for (uint32_t k = 0; k < FIBRAD_WALLS; k++) {
        fibrad_heat_wall *wall = &heat->wall[k];
        if (!(scene->wall_area[k] > 0)) continue;
        wall->squares[0] =
            squares(k == FIBRAD_CYLINDER ? 2 * FIBRAD_PI * scene->container.radius : wall->size[0], square);
        wall->squares[1] = squares(wall->size[1], square);
        send_rays(heat, k, fibrad_heat_wall_area(heat, k), density);
    }
    for (uint32_t m = 0; m < heat->meshes; m++) {
        const double own = fibrad_mesh_area(&scene->mesh, m);
        send_rays(heat, FIBRAD_MESHES + m, own,
                  fibrad_max(density, own > 0 ? rays / fibrad_max(SHARE_OF_MESH, heat->meshes) / own : 0));
    }
}

void fibrad_heat_cut_meshes(fibrad_heat *heat) {
    uint32_t first = 0;
    for (uint32_t k = 0; heat->cut != NULL && k < 2 * heat->triangles; k++) heat->cut[k].patch = UINT32_MAX;
    for (uint32_t m = 0; m < heat->meshes; m++) {
        heat->of_mesh[m] = fibrad_mesh_cut_sides(&heat->scene->mesh, m, heat->patch_area, first, heat->cut);
        first += heat->of_mesh[m];
    }
}

uint32_t fibrad_heat_mesh_patch(const fibrad_heat *heat, uint32_t side, const double at[3]) {
    if (fibrad_scene_slot(heat->scene, side) == FIBRAD_NONE) return FIBRAD_NONE;
    return fibrad_heat_first_meshed(heat) + fibrad_mesh_patch_at(&heat->scene->mesh, heat->cut, side, at);
}

/* The position of a direction on the square with the corners (1, 0), (0, 1), (-1, 0) and (0, -1). These corners have
 * the positions 0, 1/4, 1/2 and 3/4. */
static double around(double x, double y) {
    const double t = y / (fibrad_abs(x) + fibrad_abs(y));
    return (x < 0 ? 2 - t : t < 0 ? 4 + t : t) / 4;
}

bool fibrad_heat_wall_wraps(const fibrad_heat *heat, uint32_t wall, uint32_t side) {
    const uint32_t axis = fibrad_wall_along(&heat->scene->container, wall, side);
    return (wall == FIBRAD_CYLINDER && side == 0) || heat->scene->period[axis] > 0;
}

bool fibrad_heat_wall_place(const fibrad_heat *heat, uint32_t wall, const double at[3], double place[2]) {
    const fibrad_heat_wall *w = &heat->wall[wall];
    const fibrad_scene *scene = heat->scene;
    const fibrad_container *c = &scene->container;
    bool inside = true;
    for (uint32_t side = 0; side < 2; side++) {
        const uint32_t axis = fibrad_wall_along(c, wall, side);
        double share = (at[axis] - w->low[side]) / w->size[side];
        if (wall == FIBRAD_CYLINDER && side == 0)
            share = around(at[fibrad_cylinder_axis(c->turn, 0)] - c->axis[0],
                           at[fibrad_cylinder_axis(c->turn, 1)] - c->axis[1]);
        else if (scene->period[axis] > 0)
            share -= fibrad_floor(share);
        else if (w->unbounded && !(share >= 0 && share <= 1))
            inside = false;
        place[side] = fibrad_max(0, fibrad_min(share * w->squares[side], w->squares[side]));
    }
    return inside;
}

uint32_t fibrad_heat_wall_patch(const fibrad_heat *heat, uint32_t wall, const double at[3], bool may_be_fine) {
    const uint32_t *squares = heat->wall[wall].squares, body = fibrad_heat_body(heat, wall);
    double place[2];
    uint32_t cell[2];
    if (!fibrad_heat_wall_place(heat, wall, at, place)) return heat->first[fibrad_heat_beyond(heat, wall)];
    for (int side = 0; side < 2; side++) cell[side] = (uint32_t)fibrad_min(place[side], squares[side] - 1);
    const uint32_t own = (cell[0] >> 1) * (squares[1] >> 1) + (cell[1] >> 1);
    const uint32_t patch = own * FIBRAD_HEAT_FOUR + (cell[0] & 1) * 2 + (cell[1] & 1);
    return may_be_fine ? fibrad_heat_patch_in_four(heat, body, patch, place[0] / 2 - (cell[0] >> 1),
                                                   place[1] / 2 - (cell[1] >> 1))
                       : heat->first[body] + patch;
}

double fibrad_heat_wall_density(const fibrad_heat *heat, uint32_t patch) {
    for (uint32_t slot = 0; slot < FIBRAD_MESHES + heat->meshes; slot++) {
        const uint32_t *first = heat->first + fibrad_heat_body(heat, slot);
        if (fibrad_slot_of_wall(slot) && patch >= first[0] && patch < first[1]) return heat->sent[slot].density;
    }
    return 0;
}

uint32_t fibrad_heat_ends(const fibrad_heat *heat, const double origin[3], const double w[3], uint32_t side,
                          double length) {
    double distance = __builtin_inf(), at[3];
    const uint32_t wall =
        heat->scene->container.walls ? fibrad_walls_exit(heat->scene, origin, w, &distance) : FIBRAD_NONE;
    const bool meshed = side != FIBRAD_NO_SIDE && (wall == FIBRAD_NONE || length < distance);
    if (!meshed && wall == FIBRAD_NONE) return fibrad_heat_open(heat);
    for (int axis = 0; axis < 3; axis++) at[axis] = origin[axis] + (meshed ? length : distance) * w[axis];
    return meshed ? fibrad_heat_mesh_patch(heat, side, at) : fibrad_heat_wall_patch(heat, wall, at, true);
}

/* A direction by the cosine law from two numbers in [0, 1). normal, across, along: orthogonal unit vectors. */
static void cosine_direction(const double x[2], const double normal[3], const double across[3], const double along[3],
                             double w[3]) {
    const double ring = fibrad_sqrt(x[0]), up = fibrad_sqrt(1 - x[0]);
    double sine, cosine;
    fibrad_sincos_turn(x[1], &sine, &cosine);
    for (int a = 0; a < 3; a++) w[a] = ring * (cosine * across[a] + sine * along[a]) + up * normal[a];
}

void fibrad_heat_direction(const double x[2], const double n[3], double w[3]) {
    double across[3], along[3];
    fibrad_frame_about(n, across, along);
    cosine_direction(x, n, across, along, w);
}

void fibrad_heat_even_point(const fibrad_heat *heat, uint64_t seed, uint32_t k, double x[4]) {
    uint32_t point[8] = {0};
    fibrad_sobol_move(&heat->sobol, 0, k, point);
    for (int d = 0; d < 4; d++)
        x[d] = fibrad_fraction(fibrad_mix(seed ^ fibrad_quasirandom_step(4, d)) ^ (uint64_t)point[d] << 32);
}

/* The side that ray k of a mesh leaves, and the four coordinates of the ray. Sides send out their rays one after
 * another, in proportion to their areas. Each side has a sequence of its own: one sequence for the whole mesh has
 * larger errors. */
static uint32_t side_of_ray(const fibrad_heat *heat, uint32_t mesh, uint32_t k, double x[4]) {
    const fibrad_mesh *own = &heat->scene->mesh;
    const double rays = heat->sent[FIBRAD_MESHES + mesh].count, area = fibrad_mesh_area(own, mesh);
    double before;
    const uint32_t side = own->side[fibrad_mesh_side_at(own, mesh, (k + .5) / rays * area, &before)];
    const uint32_t first = (uint32_t)(before / area * rays + .5), number = k > first ? k - first : 0;
    fibrad_heat_even_point(heat, fibrad_mix(2 * fibrad_side_given(own, side) + number % 2), number / 2, x);
    return side;
}

bool fibrad_heat_mesh_ray(const fibrad_heat *heat, uint32_t mesh, uint32_t k, double origin[3], double w[3],
                          uint32_t *side) {
    const fibrad_mesh *own = &heat->scene->mesh;
    double x[4], n[3];
    *side = side_of_ray(heat, mesh, k, x);
    fibrad_mesh_triangle_point(own, fibrad_side_triangle(*side), x, origin);
    if (!fibrad_walls_hold(&heat->scene->container, origin)) return false;
    fibrad_mesh_normal(own, *side, n);
    fibrad_heat_direction(x + 2, n, w);
    return true;
}

bool fibrad_heat_wall_ray(const fibrad_heat *heat, uint32_t wall, uint32_t k, double origin[3], double w[3]) {
    const fibrad_container *c = &heat->scene->container;
    double x[4], normal[3], coordinate[2];
    fibrad_heat_ray_coordinates(wall, k, x);
    fibrad_heat_wall_coordinates(heat, wall, x, coordinate);
    fibrad_wall_point(c, wall, coordinate, origin);
    if (fibrad_slot_is_plane(wall) && !fibrad_walls_hold(c, origin)) return false;
    fibrad_wall_normal(heat->scene, wall, origin, normal);
    double across[3] = {0, 0, 0}, along[3] = {0, 0, 0}; /* along the edges of the wall */
    const uint32_t u = fibrad_cylinder_axis(c->turn, 0), v = fibrad_cylinder_axis(c->turn, 1);
    along[fibrad_wall_along(c, wall, 1)] = 1;
    if (fibrad_slot_is_plane(wall))
        across[fibrad_wall_along(c, wall, 0)] = 1;
    else
        across[u] = -normal[v], across[v] = normal[u];
    cosine_direction(x + 2, normal, across, along, w);
    return true;
}
