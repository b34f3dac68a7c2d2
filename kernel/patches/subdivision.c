/* subdivision.c - divides patches near small spheres. SPDX-License-Identifier: MIT */
#include "base/elementary.h"
#include "base/vector.h"
#include "patches/subdivision.h"
#include "scene/grid_walk.h"
#include "scene/walls.h"

/* Let the height be the distance of a small sphere's centre from the surface. Fours are divided if the edges of patches
 * exceed FINE_FROM heights. Below the sphere the aim is FINE_EDGE heights. Both storage for FINE_PATCHES patches of a
 * sphere. Two equal spheres that touch have .36. Farther away edges may grow with the square of the distance, since
 * light that comes back falls with its fourth power. */
#define FINE_FROM    .8
#define FINE_EDGE    .36
#define FINE_HEIGHT  6.0 /* largest height, in radii of the small sphere; from farther away little comes back */
#define FINE_LOWEST  .5  /* least height that is used, in radii: spheres may overlap the surface */
#define FINE_REACH   1.5 /* small spheres are searched within this many radii about the centre of a large one */
#define FINE_UNLIKE  .95 /* nothing is divided unless a sphere has less than this part of the largest radius */
#define FINE_WIDE    5   /* below a sphere near a wall, a square of this many fours by this many is looked at */
#define FINE_LEVELS  20u
#define FINE_PATCHES 96.0
#define FINE_RAYS    64u /* rays of a fine four at FINE_BEAMS beams per sphere; in proportion to the beams */
#define FINE_BEAMS   10752.0
#define FINE_DENSER  4.0 /* least number of rays per area, over the beams per area of a sphere */

/* A small sphere near a body. */
struct near_sphere {
    double centre[3]; /* L, relative to the centre of a sphere, or in the scene */
    double height;    /* L, of the centre above the surface */
};

static bool is_sphere(const fibrad_heat *heat, uint32_t body) { return body < heat->spheres; }

/* Own fours along both edges of a face of a sphere's cube, or of a wall. */
static void grid_of(const fibrad_heat *heat, uint32_t body, uint32_t fours[2]) {
    const fibrad_heat_wall *wall = &heat->wall[is_sphere(heat, body) ? 0 : body - heat->spheres];
    fours[0] = (is_sphere(heat, body) ? heat->side : wall->squares[0]) / 2;
    fours[1] = (is_sphere(heat, body) ? heat->side : wall->squares[1]) / 2;
}

static uint32_t fours_of(const fibrad_heat *heat, uint32_t body) {
    uint32_t fours[2];
    grid_of(heat, body, fours);
    return (is_sphere(heat, body) ? 6 : 1) * fours[0] * fours[1];
}

/* The mean area of a body's own fours. */
static double four_area(const fibrad_heat *heat, uint32_t body) {
    const double r = is_sphere(heat, body) ? heat->scene->r[body] : 0;
    const double area =
        is_sphere(heat, body) ? 4 * FIBRAD_PI * r * r : fibrad_heat_wall_area(heat, body - heat->spheres);
    return area / fours_of(heat, body);
}

/* The normal at a, b, each from -1 to 1, on a face of a sphere's cube. Returns the solid angle per area there. */
static double point_on_sphere(uint32_t face, double a, double b, double normal[3]) {
    static const double frame[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    const double s = fibrad_patch_unmapped(a), t = fibrad_patch_unmapped(b),
                 inverse = 1 / fibrad_sqrt(1 + s * s + t * t);
    const uint32_t axis = face / 2;
    double axes[9], n[3];
    n[axis] = face % 2 ? -inverse : inverse, n[axis == 0 ? 1 : 0] = s * inverse, n[axis == 2 ? 1 : 2] = t * inverse;
    fibrad_patch_turn(frame, axes);
    for (int k = 0; k < 3; k++) normal[k] = fibrad_dot(n, axes + 3 * k);
    return 4 / (5 - 3 * s * s) * (4 / (5 - 3 * t * t)) * (inverse * inverse * inverse);
}

/* The point and the normal at shares of the edges of a wall's rectangle. Returns the area on the wall over the area on
 * the rectangle. */
static double point_on_wall(const fibrad_heat *heat, uint32_t wall, const double share[2], double at[3],
                            double normal[3]) {
    const fibrad_container *c = &heat->scene->container;
    double stretched = 1, coordinate[2];
    fibrad_heat_wall_coordinates(heat, wall, share, coordinate);
    if (wall == FIBRAD_CYLINDER) {
        const double turn = 4 * share[0], quarter = fibrad_min(fibrad_floor(turn), 3), t = turn - quarter;
        const double square = (1 - t) * (1 - t) + t * t, r = c->radius / fibrad_sqrt(square);
        const double along = r * (1 - t), across = r * t;
        fibrad_wall_about(c,
                          quarter == 0   ? along
                          : quarter == 1 ? -across
                          : quarter == 2 ? -along
                                         : across,
                          quarter == 0   ? across
                          : quarter == 1 ? along
                          : quarter == 2 ? -across
                                         : -along,
                          at);
        at[fibrad_wall_along(c, wall, 1)] = coordinate[1];
        stretched = 2 / (FIBRAD_PI * square);
    } else {
        fibrad_wall_point(c, wall, coordinate, at);
    }
    fibrad_wall_normal(heat->scene, wall, at, normal);
    return stretched;
}

/* The extent of a four in shares of the edges of its wall's rectangle, or of the face of its sphere's cube. Returns the
 * number of this face. */
static uint32_t extent_of(const fibrad_heat *heat, const fibrad_heat_four *four, double low[2], double size[2]) {
    uint32_t fours[2];
    grid_of(heat, four->body, fours);
    const double part = fibrad_power_of_two(-(int64_t)four->level);
    const uint32_t face = is_sphere(heat, four->body) ? four->own / (fours[0] * fours[1]) : 0;
    const uint32_t on_face = four->own - face * fours[0] * fours[1];
    low[0] = (on_face / fours[1] + four->x * part) / fours[0],
    low[1] = (on_face % fours[1] + four->y * part) / fours[1];
    for (int side = 0; side < 2; side++) size[side] = part / fours[side];
    return face;
}

double fibrad_heat_fine_point(const fibrad_heat *heat, const fibrad_heat_four *four, double u, double v, double at[3],
                              double normal[3]) {
    double low[2], size[2];
    const uint32_t face = extent_of(heat, four, low, size);
    const double share[2] = {low[0] + u * size[0], low[1] + v * size[1]};
    if (!is_sphere(heat, four->body)) {
        const uint32_t wall = four->body - heat->spheres;
        return point_on_wall(heat, wall, share, at, normal) * size[0] * size[1] * fibrad_heat_wall_area(heat, wall);
    }
    const double r = heat->scene->r[four->body];
    const double solid = point_on_sphere(face, 2 * share[0] - 1, 2 * share[1] - 1, normal);
    for (int axis = 0; axis < 3; axis++) at[axis] = r * normal[axis];
    return solid * (2 * r * size[0]) * (2 * r * size[1]);
}

/* The solid angle of the rectangle between the middle of a face of a cube and the point s, t on it. Its sign is that of
 * s t. */
static double solid_angle(double s, double t) {
    const double angle = fibrad_quarter_angle(fibrad_sqrt(1 + s * s + t * t), fibrad_abs(s * t));
    return s * t < 0 ? -angle : angle;
}

/* The angle at a share of the way around a cylinder. */
static double angle_around(double share) {
    const double quarter = fibrad_floor(4 * share), t = 4 * share - quarter;
    return .5 * FIBRAD_PI * quarter + fibrad_quarter_angle(1 - t, t);
}

/* The area of a four [L2]. */
static double area_of(const fibrad_heat *heat, const fibrad_heat_four *four) {
    double low[2], size[2], from[2], to[2];
    extent_of(heat, four, low, size);
    if (!is_sphere(heat, four->body)) {
        const uint32_t wall = four->body - heat->spheres;
        const double area = fibrad_heat_wall_area(heat, wall) * size[1];
        if (wall != FIBRAD_CYLINDER) return area * size[0];
        return area * ((angle_around(low[0] + size[0]) - angle_around(low[0])) / (2 * FIBRAD_PI));
    }
    for (int k = 0; k < 2; k++)
        from[k] = fibrad_patch_unmapped(2 * low[k] - 1), to[k] = fibrad_patch_unmapped(2 * (low[k] + size[k]) - 1);
    const double r = heat->scene->r[four->body];
    return r * r *
           (solid_angle(to[0], to[1]) - solid_angle(from[0], to[1]) - solid_angle(to[0], from[1]) +
            solid_angle(from[0], from[1]));
}

/* Whether a four is too large for a small sphere near it. */
static bool is_too_large(const fibrad_heat *heat, const fibrad_heat_four *four, const struct near_sphere *near) {
    if (four->level >= FINE_LEVELS) return false;
    const double finer = fibrad_sqrt(FINE_PATCHES / heat->config.patches);
    const double edge = .5 * fibrad_sqrt(four_area(heat, four->body)) * fibrad_power_of_two(-(int64_t)four->level);
    double at[3], normal[3], square = 0;
    fibrad_heat_fine_point(heat, four, .5, .5, at, normal);
    for (int axis = 0; axis < 3; axis++) {
        const double period = is_sphere(heat, four->body) ? 0 : heat->scene->period[axis];
        double d = at[axis] - near->centre[axis];
        if (period > 0) d -= period * fibrad_floor(d / period + .5);
        square += d * d;
    }
    const double distance = fibrad_max(near->height, fibrad_sqrt(square) - 1.5 * edge);
    return edge * near->height > FINE_EDGE * finer * distance * distance;
}

static uint32_t add_nodes(fibrad_heat *heat, uint32_t n) {
    const uint32_t begin = heat->division.nodes;
    for (uint32_t k = 0; k < n; k++) heat->division.node[heat->division.nodes++] = 0;
    return begin;
}

/* One of the four fours that a four is divided into. */
static fibrad_heat_four child_of(fibrad_heat_four four, uint32_t k) {
    four.level++, four.x = 2 * four.x + k / 2, four.y = 2 * four.y + k % 2;
    return four;
}

/* A four that waits for its turn, and its node. At most three of four children wait on each level. */
typedef struct fine_wait {
    fibrad_heat_four four;
    uint32_t node;
} fine_wait;
enum { FINE_WAITS = 3 * FINE_LEVELS + 4 };

/* Divides one of a body's own fours for a small sphere, again and again. The node of a four is the index of the node of
 * its first child. 0: the four is not divided. Without an array of nodes the function only counts them. */
static void divide_four(fibrad_heat *heat, uint32_t body, uint32_t own, const struct near_sphere *near) {
    fine_wait wait[FINE_WAITS];
    uint32_t waiting = 1;
    wait[0].four = (fibrad_heat_four){.body = body, .own = own};
    wait[0].node = heat->division.node != NULL ? heat->division.root[body] + own : 0;
    while (waiting > 0) {
        const fibrad_heat_four four = wait[--waiting].four;
        const uint32_t node = wait[waiting].node;
        if (!is_too_large(heat, &four, near)) continue;
        uint32_t children = 0;
        if (heat->division.node == NULL)
            heat->division.nodes += FIBRAD_HEAT_FOUR;
        else if (heat->division.node[node] == 0)
            heat->division.node[node] = add_nodes(heat, FIBRAD_HEAT_FOUR);
        if (heat->division.node != NULL) children = heat->division.node[node];
        for (uint32_t k = 0; k < FIBRAD_HEAT_FOUR; k++) {
            wait[waiting].four = child_of(four, k);
            wait[waiting++].node = children + k;
        }
    }
}

/* Whether a small sphere of radius r needs fine patches on a body. Sets near->height to its least value. */
static bool asks_for_fine(const fibrad_heat *heat, uint32_t body, double r, struct near_sphere *near) {
    const double finer = fibrad_sqrt(FINE_PATCHES / heat->config.patches);
    const double edge = .5 * fibrad_sqrt(four_area(heat, body));
    if (!(near->height <= FINE_HEIGHT * r)) return false;
    near->height = fibrad_max(near->height, FINE_LOWEST * r);
    return edge > FINE_FROM * finer * near->height;
}

/* Adds or counts the nodes of a body's own fours, the first time that it is called for a body. */
static void begin_body(fibrad_heat *heat, uint32_t body, bool *begun) {
    const uint32_t n = fours_of(heat, body);
    if (!*begun && heat->division.node != NULL) heat->division.root[body] = add_nodes(heat, n);
    if (!*begun && heat->division.node == NULL) heat->division.nodes += n;
    *begun = true;
}

/* Divides the fours of a sphere for the smaller spheres near it. */
static void divide_sphere(fibrad_heat *heat, uint32_t body) {
    const fibrad_scene *scene = heat->scene;
    const double r = scene->r[body], reach = r * FINE_REACH,
                 centre[3] = {scene->x[body], scene->y[body], scene->z[body]};
    bool begun = false;
    for (uint32_t l = 0; l < scene->levels; l++) {
        fibrad_walk walk;
        fibrad_walk_about(&walk, scene, &scene->level[l], centre, centre, reach);
        while (fibrad_walk_next(&walk))
            for (uint32_t j = walk.begin; j < walk.end; j++) {
                struct near_sphere near = {{scene->x[j] + walk.shift[0] - centre[0],
                                            scene->y[j] + walk.shift[1] - centre[1],
                                            scene->z[j] + walk.shift[2] - centre[2]},
                                           0};
                near.height = fibrad_sqrt(fibrad_dot(near.centre, near.centre)) - r;
                if (scene->r[j] >= r || fibrad_one_clump(scene, body, j)) continue;
                if (!asks_for_fine(heat, body, scene->r[j], &near)) continue;
                begin_body(heat, body, &begun);
                for (uint32_t own = 0; own < fours_of(heat, body); own++) divide_four(heat, body, own, &near);
            }
    }
}

/* Divides the fours of a wall below a sphere near it. */
static void divide_below(fibrad_heat *heat, uint32_t wall, const struct near_sphere *near) {
    uint32_t fours[2];
    double place[2];
    grid_of(heat, heat->spheres + wall, fours);
    fibrad_heat_wall_place(heat, wall, near->centre, place);
    for (int32_t k = 0; k < FINE_WIDE * FINE_WIDE; k++) {
        int32_t at[2] = {k / FINE_WIDE - FINE_WIDE / 2, k % FINE_WIDE - FINE_WIDE / 2};
        for (uint32_t side = 0; side < 2; side++) {
            const int32_t n = (int32_t)fours[side];
            at[side] += (int32_t)fibrad_max(0, fibrad_min(place[side] / 2, n - 1));
            if (fibrad_heat_wall_wraps(heat, wall, side)) at[side] = (at[side] % n + n) % n;
        }
        if (at[0] >= 0 && at[1] >= 0 && at[0] < (int32_t)fours[0] && at[1] < (int32_t)fours[1])
            divide_four(heat, heat->spheres + wall, (uint32_t)at[0] * fours[1] + (uint32_t)at[1], near);
    }
}

/* Divides the fours of a wall for the spheres near it. */
static void divide_wall(fibrad_heat *heat, uint32_t wall) {
    const fibrad_scene *scene = heat->scene;
    bool begun = false;
    for (uint32_t i = 0; i < heat->spheres; i++) {
        struct near_sphere near = {{scene->x[i], scene->y[i], scene->z[i]}, 0};
        near.height = fibrad_walls_away(&scene->container, wall, near.centre);
        if (!asks_for_fine(heat, heat->spheres + wall, scene->r[i], &near)) continue;
        begin_body(heat, heat->spheres + wall, &begun);
        divide_below(heat, wall, &near);
    }
}

/* Divides the fours of all bodies, or counts the nodes. No four has node 0. */
static void divide_bodies(fibrad_heat *heat) {
    const fibrad_scene *scene = heat->scene;
    heat->division.nodes = 1;
    for (uint32_t b = 0; b < heat->spheres && scene->facts.radius_min < FINE_UNLIKE * scene->facts.radius_max; b++)
        divide_sphere(heat, b);
    for (uint32_t k = 0; k < FIBRAD_WALLS; k++)
        if (scene->wall_area[k] > 0) divide_wall(heat, k);
}

uint64_t fibrad_heat_count_nodes(const fibrad_heat *heat) {
    fibrad_heat fields = *heat;
    fields.division.node = NULL;
    divide_bodies(&fields);
    return fields.division.nodes;
}

/* Lists the fine fours of a body, level by level. */
static void number_fours(fibrad_heat *heat, uint32_t body) {
    fine_wait wait[FINE_WAITS];
    const uint32_t n = heat->division.root[body] != FIBRAD_NONE ? fours_of(heat, body) : 0;
    uint32_t found = 1;
    for (uint32_t level = 1; found > 0 && level <= FINE_LEVELS; level++) {
        found = 0;
        for (uint32_t own = 0; own < n; own++) {
            uint32_t waiting = 1;
            wait[0].four = (fibrad_heat_four){.body = body, .own = own}, wait[0].node = heat->division.root[body] + own;
            while (waiting > 0) {
                fibrad_heat_four four = wait[--waiting].four;
                const uint32_t node = wait[waiting].node, next = heat->division.node[node];
                if (next == 0 && four.level == level) {
                    heat->division.four[heat->division.fours] = four;
                    heat->division.node[node] = FIBRAD_HEAT_FINE + heat->division.fours++;
                }
                if (next == 0 || next >= FIBRAD_HEAT_FINE) continue;
                found++;
                for (uint32_t k = FIBRAD_HEAT_FOUR; k-- > 0;) {
                    wait[waiting].four = child_of(four, k);
                    wait[waiting++].node = next + k;
                }
            }
        }
    }
}

/* About how many rays a fine four sends out: at least a fixed number, and at least as many as the beams or rays that
 * they replace. */
static double rays_of_four(const fibrad_heat *heat, uint32_t body, uint32_t level) {
    const double area = four_area(heat, body) * fibrad_power_of_two(-2 * (int64_t)level);
    const double replaced = is_sphere(heat, body) ? FINE_DENSER * heat->beams / fours_of(heat, body) *
                                                        fibrad_power_of_two(-2 * (int64_t)level)
                                                  : heat->sent[body - heat->spheres].density * area;
    const double least = fibrad_max(FINE_RAYS * (heat->beams / FINE_BEAMS), 16);
    return fibrad_min(fibrad_max(least, replaced), heat->beams / 4);
}

/* Puts fine fours of one body and size into rows. */
static void put_in_rows(fibrad_heat *heat) {
    heat->rows = heat->spheres;
    uint32_t most = 0;
    fibrad_heat_fine *row = NULL;
    for (uint32_t k = 0; k < heat->division.fours; k++) {
        fibrad_heat_four *four = &heat->division.four[k];
        if (row == NULL || row->body != four->body || row->level != four->level || row->count == most) {
            const double rays = rays_of_four(heat, four->body, four->level);
            const double area = four_area(heat, four->body) * fibrad_power_of_two(-2 * (int64_t)four->level);
            row = &heat->division.fine[heat->rows - heat->spheres];
            *row = (fibrad_heat_fine){.body = four->body, .level = four->level, .first = k};
            heat->density[heat->rows++] = FIBRAD_HEAT_RAY * rays / area;
            most = (uint32_t)fibrad_min(FIBRAD_HEAT_PATCHES_MAX / FIBRAD_HEAT_FOUR, heat->beams / (2 * rays));
        }
        four->row = heat->rows - 1, row->count++;
        heat->division.on_patch[k] = (uint16_t)(FIBRAD_HEAT_FOUR * four->own + 2 * (four->x >> (four->level - 1)) +
                                                (four->y >> (four->level - 1)));
    }
}

void fibrad_heat_divide_fours(fibrad_heat *heat) {
    const uint32_t bodies = heat->spheres + FIBRAD_WALLS;
    for (uint32_t b = 0; b < bodies; b++) heat->division.root[b] = FIBRAD_NONE;
    heat->division.node[0] = 0;
    divide_bodies(heat);
    heat->division.fours = 0;
    for (uint32_t b = 0; b <= bodies; b++) {
        heat->division.first_four[b] = heat->division.fours;
        if (b < bodies) number_fours(heat, b);
    }
    put_in_rows(heat);
}

/* Let a sphere be at the height h above a plane. The view factor from a point of the plane, at the distance s from the
 * centre, to the sphere is r^2 h/s^3. Hence r^2/(8 h^2) of the sphere's radiation comes back if the plane reflects
 * all. */
double fibrad_heat_comes_back(const fibrad_heat *heat, uint32_t sphere) {
    if (heat->triangles == 0) return 0;
    const double clear = heat->scene->clear[sphere], height = fibrad_max(clear, FINE_LOWEST);
    const double finer = fibrad_sqrt(FINE_PATCHES / heat->config.patches);
    const bool coarse = fibrad_sqrt(heat->patch_area) > FINE_FROM * finer * height * heat->scene->r[sphere];
    return coarse && clear <= FINE_HEIGHT ? 1 / (8 * fibrad_max(height * height, 1)) : 0;
}

uint32_t fibrad_heat_fine_of(const fibrad_heat *heat, uint32_t patch) {
    uint32_t fine = FIBRAD_NONE;
    for (uint32_t k = 0; k < FIBRAD_WALLS && heat->division.fours > 0 && fine == FIBRAD_NONE; k++)
        fine = fibrad_heat_fine_number(heat, heat->spheres + k, patch);
    return fine;
}

/* The largest result of fibrad_heat_fine_point on a four, of nine points [L^2]. */
static double most_of(const fibrad_heat *heat, const fibrad_heat_four *four) {
    double at[3], normal[3], most = 0;
    for (int k = 0; k < 9; k++)
        most = fibrad_max(most, fibrad_heat_fine_point(heat, four, .5 * (k / 3), .5 * (k % 3), at, normal));
    return most;
}

/* The area of one of a sphere's own fours over the area of the sphere. */
static double share_of(const fibrad_heat *heat, uint32_t own) {
    const fibrad_heat_four four = {.own = own};
    return area_of(heat, &four) / (four_area(heat, 0) * fours_of(heat, 0));
}

/* With this factor the rays of a fine four stand for as much area as the beams that they replace. */
void fibrad_heat_balance(fibrad_heat *heat) {
    if (heat->spheres == 0) return;
    for (uint32_t own = 0; own < fours_of(heat, 0); own++) heat->division.balance[own] = 0;
    for (uint32_t k = 0; k < heat->beams; k++) heat->division.balance[heat->leave[k] / FIBRAD_HEAT_FOUR]++;
    for (uint32_t own = 0; own < fours_of(heat, 0); own++)
        heat->division.balance[own] /= heat->beams * share_of(heat, own);
}

/* The number of the random sequence of a four. */
static uint64_t seed_of(const fibrad_heat *heat, const fibrad_heat_four *four) {
    const uint64_t body = is_sphere(heat, four->body) ? fibrad_mix(fibrad_scene_rank(heat->scene, four->body))
                                                      : four->body - heat->spheres;
    return fibrad_mix(fibrad_mix(body + ((uint64_t)four->own << 32 | four->level)) +
                      ((uint64_t)four->x << 32 | four->y));
}

/* Goes on to the next four of a row that sends out rays. The number of rays is in proportion to the area. What is
 * rounded off is added to the next four. */
static bool next_four(const fibrad_heat *heat, uint32_t row, fibrad_heat_fine_rays *rays) {
    const fibrad_heat_fine *fine = &heat->division.fine[row - heat->spheres];
    while (rays->left == 0 && rays->fours < fine->count) {
        const fibrad_heat_four *four = &heat->division.four[fine->first + rays->fours++];
        const double balance = is_sphere(heat, four->body) ? heat->division.balance[four->own] : 1;
        rays->due += balance * area_of(heat, four) * heat->density[row] / FIBRAD_HEAT_RAY,
            rays->most = most_of(heat, four);
        rays->left = (uint32_t)(rays->due + .5);
        rays->due -= rays->left;
    }
    return rays->left > 0;
}

bool fibrad_heat_fine_ray(const fibrad_heat *heat, uint32_t row, fibrad_heat_fine_rays *rays) {
    if (!next_four(heat, row, rays)) return false;
    const fibrad_heat_four *own =
        &heat->division.four[heat->division.fine[row - heat->spheres].first + rays->fours - 1];
    const uint64_t seed = seed_of(heat, &heat->division.four[heat->division.fine[row - heat->spheres].first]);
    double x[4], area, chance;
    do { /* a point is rejected more often where the four has less area per share of its edges */
        fibrad_heat_ray_coordinates(seed, rays->k, x);
        area = fibrad_heat_fine_point(heat, own, x[0], x[1], rays->at, rays->normal);
        chance = fibrad_fraction(fibrad_mix(seed + FIBRAD_GOLDEN * ++rays->k));
    } while (!(chance * rays->most <= area));
    rays->left--;
    rays->patch = FIBRAD_HEAT_FOUR * (rays->fours - 1) + (2 * x[0] >= 1 ? 2 : 0) + (2 * x[1] >= 1 ? 1 : 0);
    fibrad_heat_direction(x + 2, rays->normal, rays->direction);
    return true;
}
