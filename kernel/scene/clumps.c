/* clumps.c - bodies of spheres: how much of each member is exposed, and what belongs together.
 * SPDX-License-Identifier: MIT
 *
 * Other members hide caps of a sphere. The edge of all caps together is made of arcs of their circles. By Green's
 * theorem the hidden area is a sum over these arcs: of the sectors that they cut from their caps, and of the triangles
 * between their ends and any fixed point P, less those between their ends and the middle of the cap. The sum is known
 * up to whole spheres. By Stokes' theorem the sum of the normals n of the hidden part is half the integral of n x dn
 * over its edge. With these sums Gauss' theorem tells the volume of a clump. docs/methods.md section 5. */
#include "scene/clumps.h"
#include "base/elementary.h"
#include "base/sort.h"
#include "base/vector.h"
#include "scene/grid_walk.h"

#define TOUCH   1e-3  /* members with a smaller gap touch, over the smaller radius: files have few digits */
#define NEAR    1e-10 /* circles closer than this agree or touch [radians]: by rounding they differ */
#define NOTHING 1e-10 /* a part of a sphere that is rounding */

void fibrad_clumps_layout(fibrad_arena *arena, uint32_t n, fibrad_clumps *clumps) {
    clumps->exposed = fibrad_arena_take(arena, n, sizeof *clumps->exposed);
    clumps->volume = fibrad_arena_take(arena, n, sizeof *clumps->volume);
    clumps->outer = fibrad_arena_take(arena, n, sizeof *clumps->outer);
    clumps->link = fibrad_arena_take(arena, n, sizeof *clumps->link);
    clumps->cap = fibrad_arena_take(arena, n, sizeof *clumps->cap);
    clumps->hidden = fibrad_arena_take(arena, n, sizeof *clumps->hidden);
    clumps->key = fibrad_arena_take(arena, 2 * (size_t)n, sizeof *clumps->key);
}

/* The angle of the point (x, y), -pi to pi. */
static double angle_at_point(double x, double y) {
    if (x == 0 && y == 0) return 0;
    const double quarter = fibrad_quarter_angle(fibrad_abs(x), fibrad_abs(y)),
                 half = x < 0 ? FIBRAD_PI - quarter : quarter;
    return y < 0 ? -half : half;
}

/* Sine and cosine of an angle of at most two turns. */
static void sincos_of(double angle, double *sine, double *cosine) {
    const double turns = fibrad_abs(angle) / (2 * FIBRAD_PI);
    fibrad_sincos_turn(turns - fibrad_floor(turns), sine, cosine);
    if (angle < 0) *sine = -*sine;
}

static double sine_of(double angle) {
    double sine, cosine;
    sincos_of(angle, &sine, &cosine);
    return sine;
}

/* An angle in [0, 2 pi). */
static double within_turn(double angle) {
    while (angle < 0) angle += 2 * FIBRAD_PI;
    while (angle >= 2 * FIBRAD_PI) angle -= 2 * FIBRAD_PI;
    return angle;
}

/* The cap that a sphere of radius r at a distance hides of a unit sphere. False: none. */
static bool cap_of(const double c[3], double r, fibrad_cap *cap) {
    const double d = fibrad_sqrt(fibrad_dot(c, c)), in = (d + (r - 1)) * (1 + r - d), out = (d - (r - 1)) * (1 + r + d);
    if (!(in > 0) || d == 0) return false;
    *cap = (fibrad_cap){.axis = {c[0] / d, c[1] / d, c[2] / d}, .angle = FIBRAD_PI, .share = 1};
    if (out > 0) cap->angle = 2 * angle_at_point(fibrad_sqrt(out), fibrad_sqrt(in)), cap->share = in / (in + out);
    return true;
}

/* How two circles lie. */
typedef enum meeting { APART, WITHIN, AROUND, ALL, CUT } meeting;

/* Whether the circle of cap a lies apart from cap b, within it or around it, or covers with it all of the sphere, or
 * cuts it. hidden: out: where b hides the circle of a, as angles about a, if they cut. The two points in which circles
 * cut have the same bits from both sides, so that arcs end where others begin. */
static meeting meet(const fibrad_cap *a, const fibrad_cap *b, double hidden[2]) {
    double sum[3], difference[3], across[3], u[3], v[3];
    for (int k = 0; k < 3; k++) sum[k] = a->axis[k] + b->axis[k], difference[k] = a->axis[k] - b->axis[k];
    const double long_one = fibrad_sqrt(fibrad_dot(sum, sum)),
                 short_one = fibrad_sqrt(fibrad_dot(difference, difference));
    const double between = 2 * angle_at_point(long_one, short_one);
    const double excess[4] = {a->angle + b->angle - between, a->angle + between - b->angle,
                              b->angle + between - a->angle, 2 * FIBRAD_PI - (a->angle + b->angle + between)};
    if (excess[0] <= NEAR) return APART;
    if (excess[1] <= NEAR) return WITHIN;
    if (excess[2] <= NEAR) return AROUND;
    if (excess[3] <= NEAR) return ALL;
    const double square =
        4 * (sine_of(excess[0] / 2) * sine_of(excess[3] / 2)) * (sine_of(excess[1] / 2) * sine_of(excess[2] / 2));
    double half[2], middle[2];
    sincos_of((a->angle + b->angle) / 2, &half[0], &half[1]);
    sincos_of((a->angle - b->angle) / 2, &middle[0], &middle[1]);
    const double x = 2 * half[1] * middle[1] / long_one, y = -2 * half[0] * middle[0] / short_one;
    const double z = 2 * fibrad_sqrt(fibrad_max(0, square)) / (long_one * short_one);
    for (int k = 0; k < 3; k++) sum[k] /= long_one, difference[k] /= short_one;
    fibrad_cross(sum, difference, across);
    fibrad_frame_about(a->axis, u, v);
    for (int end = 0; end < 2; end++) {
        double p[3];
        for (int k = 0; k < 3; k++) p[k] = x * sum[k] + y * difference[k] + (end ? -z : z) * across[k];
        hidden[end] = within_turn(angle_at_point(fibrad_dot(p, u), fibrad_dot(p, v)));
    }
    if (hidden[1] < hidden[0]) hidden[1] += 2 * FIBRAD_PI;
    return CUT;
}

/* The area of a triangle on the unit sphere, up to 4 pi. Above 0 if its corners go round to the left. */
static double triangle(const double a[3], const double b[3], const double c[3]) {
    double normal[3];
    fibrad_cross(b, c, normal);
    return 2 * angle_at_point(1 + fibrad_dot(a, b) + fibrad_dot(b, c) + fibrad_dot(c, a), fibrad_dot(a, normal));
}

/* What an arc from one angle to another about a cap adds to the hidden part of the sphere. */
static double share_of_arc(const fibrad_cap *cap, double from, double to) {
    static const double fixed[3] = {.36351, .48713, 0.7940811312454162}; /* on hardly any edge of a triangle */
    const int pieces = 1 + (int)((to - from) / 2);
    double u[3], v[3], sine, cosine, end[2][3], area = 0, radius, height;
    fibrad_frame_about(cap->axis, u, v);
    sincos_of(cap->angle, &radius, &height);
    for (int piece = 0; piece <= pieces; piece++) {
        sincos_of(from + (to - from) * piece / pieces, &sine, &cosine);
        for (int k = 0; k < 3; k++) end[1][k] = height * cap->axis[k] + radius * (cosine * u[k] + sine * v[k]);
        if (piece > 0) area += triangle(fixed, end[0], end[1]) - triangle(cap->axis, end[0], end[1]);
        fibrad_copy(end[0], end[1], sizeof end[0]);
    }
    return cap->share * ((to - from) / (2 * FIBRAD_PI)) + area / (4 * FIBRAD_PI);
}

/* Takes from `outer` the normals that the same arc bounds. */
static void take_normals(const fibrad_cap *cap, double from, double to, double outer[3]) {
    double u[3], v[3], sine[2], cosine[2], radius, height;
    fibrad_frame_about(cap->axis, u, v);
    sincos_of(cap->angle, &radius, &height);
    sincos_of(from, &sine[0], &cosine[0]);
    sincos_of(to, &sine[1], &cosine[1]);
    for (int k = 0; k < 3; k++)
        outer[k] -= radius / 2 *
                    (height * ((cosine[1] - cosine[0]) * v[k] - (sine[1] - sine[0]) * u[k]) +
                     radius * (to - from) * cap->axis[k]);
}

/* Adds a cap to a list, unless it lies within another one. Takes out those that lie within it. A list of one cap with a
 * share of 1: all is hidden. Returns the new number. */
static uint32_t add_cap(fibrad_cap *list, uint32_t count, const fibrad_cap *cap) {
    double hidden[2];
    bool all = cap->share == 1;
    uint32_t to = 0;
    if (count == 1 && list[0].share == 1) return 1;
    for (uint32_t k = 0; k < count && !all; k++) {
        const meeting how = meet(cap, &list[k], hidden);
        if (how == WITHIN) return count;
        all = how == ALL;
    }
    for (uint32_t k = 0; k < count && !all; k++)
        if (meet(cap, &list[k], hidden) != AROUND) list[to++] = list[k];
    list[to] = *cap;
    if (all) list[to].share = 1;
    return to + 1;
}

/* The hidden part of a sphere under caps of which none lies within another. outer: out: the sum of the normals of the
 * other part, times their areas. */
static double hidden_part(const fibrad_cap *cap, uint32_t count, double (*hidden)[2], double outer[3]) {
    double part = 0, sum = 0, most = 0;
    bool edge = false;
    outer[0] = outer[1] = outer[2] = 0;
    for (uint32_t k = 0; k < count; k++) {
        uint32_t cuts = 0;
        double reach = -__builtin_inf();
        sum += cap[k].share, most = fibrad_max(most, cap[k].share);
        for (uint32_t j = 0; j < count; j++) {
            double by[2];
            if (j == k || meet(&cap[k], &cap[j], by) != CUT) continue;
            uint32_t at = cuts++;
            for (; at > 0 && hidden[at - 1][0] > by[0]; at--) fibrad_copy(hidden[at], hidden[at - 1], sizeof by);
            fibrad_copy(hidden[at], by, sizeof by);
            reach = fibrad_max(reach, by[1] - 2 * FIBRAD_PI);
        }
        if (cuts == 0) part += cap[k].share, edge = true, take_normals(&cap[k], 0, 2 * FIBRAD_PI, outer);
        for (uint32_t at = 0; at < cuts; at++) {
            if (hidden[at][0] > reach)
                part += share_of_arc(&cap[k], reach, hidden[at][0]), edge = true,
                                                                     take_normals(&cap[k], reach, hidden[at][0], outer);
            reach = fibrad_max(reach, hidden[at][1]);
        }
    }
    if (count == 0 || !edge) return count > 0;
    part -= fibrad_floor(part);
    if (part < most / 2) return 1;   /* all but rounding is hidden */
    if (part > sum + 1e-9) part = 0; /* nothing but rounding is hidden */
    return part > 1 - NOTHING ? 1 : part;
}

/* The link that stands for the part to which a sphere belongs. periods: in: of an image of the sphere; out: of that of
 * the link. */
static uint32_t root_of(fibrad_link *link, uint32_t i, int32_t periods[3]) {
    for (; link[i].to != i; i = link[i].to) {
        const fibrad_link next = link[link[i].to];
        for (int axis = 0; axis < 3; axis++) {
            periods[axis] += link[i].periods[axis];
            if (next.to != link[i].to) periods[axis] += next.periods[axis], link[i].periods[axis] += next.periods[axis];
        }
        link[i].to = next.to;
    }
    return i;
}

/* Joins sphere i and an image of sphere j. False: i and another image of j are joined. */
static bool join(fibrad_link *link, uint32_t i, uint32_t j, const int32_t image[3]) {
    int32_t from[3] = {0, 0, 0}, to[3] = {image[0], image[1], image[2]};
    const uint32_t a = root_of(link, i, from), b = root_of(link, j, to);
    bool same = true;
    for (int axis = 0; axis < 3; axis++) {
        if (a != b) link[b].periods[axis] = from[axis] - to[axis];
        same = same && (a != b || from[axis] == to[axis]);
    }
    link[b].to = a;
    return same;
}

/* The search for the members about one member. */
typedef struct member_search {
    fibrad_scene *scene;
    uint32_t place, caps;
    bool apart; /* no image of the clump touches another one */
} member_search;

/* Takes a member at place j, shifted by some periods: joins it if it touches, and notes the cap that it hides. */
static void take_member(member_search *search, uint32_t j, const fibrad_walk *walk) {
    const fibrad_scene *scene = search->scene;
    const uint32_t i = search->place;
    const double r = scene->r[i], other = scene->r[j];
    const double c[3] = {(scene->x[j] - scene->x[i] + walk->shift[0]) / r,
                         (scene->y[j] - scene->y[i] + walk->shift[1]) / r,
                         (scene->z[j] - scene->z[i] + walk->shift[2]) / r};
    const double reach = 1 + other / r + TOUCH * fibrad_min(1, other / r);
    fibrad_cap cap;
    if (fibrad_dot(c, c) > reach * reach) return;
    search->apart = join(scene->clumps.link, i, j, walk->periods) && search->apart;
    if (cap_of(c, other / r, &cap)) search->caps = add_cap(scene->clumps.cap, search->caps, &cap);
}

/* Finds what is exposed of the sphere at a place, and what it touches. False: its clump touches its own image. */
static bool expose(fibrad_scene *scene, uint32_t i) {
    const double centre[3] = {scene->x[i], scene->y[i], scene->z[i]}, r = scene->r[i];
    member_search search = {scene, i, 0, true};
    for (uint32_t l = 0; l < scene->levels && scene->clump[i] != 0; l++) {
        const double largest = scene->level[l].radius_max;
        fibrad_walk walk;
        fibrad_walk_about(&walk, scene, &scene->level[l], centre, centre, r + largest + TOUCH * fibrad_min(r, largest));
        while (fibrad_walk_next(&walk))
            for (uint32_t j = walk.begin; j < walk.end; j++)
                if (scene->clump[j] == scene->clump[i] && (j != i || walk.image)) take_member(&search, j, &walk);
    }
    const double part = 1 - hidden_part(scene->clumps.cap, search.caps, scene->clumps.hidden, scene->clumps.outer[i]);
    scene->clumps.exposed[i] = 4 * FIBRAD_PI * part * (r * r);
    if (part == 0 && scene->facts.covered++ == 0) scene->facts.covered_sphere = scene->order[i];
    return search.apart;
}

/* What the exposed part of the sphere at a place adds to the volume of its clump by Gauss' theorem. */
static double volume_by_surface(const fibrad_scene *scene, uint32_t i) {
    const double r = scene->r[i], at[3] = {scene->x[i], scene->y[i], scene->z[i]};
    int32_t periods[3] = {0, 0, 0};
    const uint32_t root = root_of(scene->clumps.link, i, periods);
    const double from[3] = {scene->x[root], scene->y[root], scene->z[root]};
    double sum = r * scene->clumps.exposed[i];
    for (int axis = 0; axis < 3 && sum > 0; axis++)
        sum += (at[axis] - from[axis] - periods[axis] * scene->period[axis]) * scene->clumps.outer[i][axis] * (r * r);
    return sum / 3;
}

/* Shares out the volumes of clumps by the volumes of their members. key: clumps and members, sorted. */
static void share_volumes(fibrad_scene *scene, const uint64_t *key) {
    const uint32_t n = scene->facts.spheres;
    for (uint32_t k = 0, end; k < n; k = end) {
        double volume = 0, spheres = 0;
        for (end = k; end < n && key[end] >> 32 == key[k] >> 32 && (end == k || key[k] >> 32 > 0); end++) {
            const uint32_t i = scene->place[(uint32_t)key[end]];
            scene->clumps.volume[i] = scene->r[i] * (scene->r[i] * scene->r[i]);
            volume += volume_by_surface(scene, i), spheres += scene->clumps.volume[i];
        }
        for (uint32_t m = k; m < end; m++) scene->clumps.volume[scene->place[(uint32_t)key[m]]] *= volume / spheres;
    }
}

/* Counts clumps, and those in parts that do not touch. */
static void count_clumps(fibrad_scene *scene) {
    fibrad_scene_facts *facts = &scene->facts;
    const uint32_t n = facts->spheres;
    uint64_t *key = scene->clumps.key, largest = 0;
    for (uint32_t i = 0; i < n; i++) { /* members in the order of the caller's spheres */
        const uint64_t clump = scene->clump[scene->place[i]];
        key[i] = clump << 32 | i, largest = clump > largest ? clump : largest;
    }
    key = fibrad_sort_keys(key, key + n, n, 32, largest);
    share_volumes(scene, key);
    bool whole = true;
    for (uint32_t k = 0, first = 0, root = 0; k < n; k++) {
        int32_t periods[3] = {0, 0, 0};
        const uint32_t i = (uint32_t)key[k], own = root_of(scene->clumps.link, scene->place[i], periods);
        if (key[k] >> 32 == 0) continue;
        if (k == 0 || key[k] >> 32 != key[k - 1] >> 32) facts->clumps++, first = i, root = own, whole = true;
        if (own == root || !whole) continue;
        if (facts->parted++ == 0) facts->parted_pair[0] = first, facts->parted_pair[1] = i;
        whole = false;
    }
}

int fibrad_clumps_build(fibrad_scene *scene, uint32_t *sphere) {
    const uint32_t n = scene->facts.spheres;
    for (uint32_t i = 0; i < n; i++) scene->clumps.link[i] = (fibrad_link){i, {0, 0, 0}};
    for (uint32_t i = 0; i < n; i++) {
        *sphere = scene->order[i];
        if (!expose(scene, i)) return FIBRAD_E_GEOMETRY;
    }
    count_clumps(scene);
    return FIBRAD_OK;
}

double fibrad_scene_exposed_area(const fibrad_scene *scene, uint32_t i) {
    if (!fibrad_scene_ready(scene) || i >= scene->facts.spheres) return __builtin_nan("");
    const double r = scene->r[scene->place[i]];
    return scene->clump != NULL ? scene->clumps.exposed[scene->place[i]] : 4 * FIBRAD_PI * (r * r);
}

double fibrad_scene_volume(const fibrad_scene *scene, uint32_t i) {
    if (!fibrad_scene_ready(scene) || i >= scene->facts.spheres) return __builtin_nan("");
    const double r = scene->r[scene->place[i]];
    return scene->clump != NULL ? scene->clumps.volume[scene->place[i]] : 4. / 3 * FIBRAD_PI * (r * r * r);
}
