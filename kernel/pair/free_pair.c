/* free_pair.c - finds pairs of spheres that nothing can come between. SPDX-License-Identifier: MIT */
#include "pair/free_pair.h"
#include "base/vector.h"
#include "scene/grid_walk.h"

/* In scenes with up to this many spheres all pairs are tried. */
#define FEW_SPHERES 256u
/* Otherwise a row tries the spheres within this distance, in cube roots of the volume per sphere: about 50. */
#define NEAR_SPACINGS 2.3
/* Spheres may lie closer than the volume tells, as in a thin layer. If so many are near for each window of the row, the
 * tries would cost more than the windows. Then the distance becomes less, by a ratio, until few are near. */
#define MANY_NEAR 1.5
#define FEW_NEAR  0.2
#define CLOSER    0.7
/* A pair is not tried if so many other spheres are expected to reach into its hull. Let r be the radius of equal
 * spheres in random places, and d the distance of the centres. The number is 4 pi r^2 (d + 8 r/3) over the volume per
 * sphere. */
#define MANY_BETWEEN 8.0
/* If a sphere should meet more windows than this, they tell whether something hides it: they see less of it. */
#define SOME_WINDOWS 2.0
/* Rows with fewer entries than this ask all spheres which of them no window has met. */
#define FEW_ENTRIES 16u
/* Spheres that reach into a hull by less than this part of their radius only touch it. */
#define TOUCH 1e-10
/* The part of a row that must be open, so that it can take the difference. Less is rounding in scenes of few spheres.
 * In others it costs more time than it gains. */
#define LEAST_OPEN  1e-9
#define WORTH_WHILE 0.05
/* The triangles near a hull are asked for at most so many times. In the cells about a hull at most so many spheres are
 * compared with it. A pair that asks for more is not taken as free. */
#define HULL_STEPS   64
#define HULL_SPHERES 256u
/* A row asks about so many spheres which of them no window has met. Each of them stands for equally many. */
#define UNSEEN_ASKED 512u

/* If at most MOST_HIDING spheres hide a part of a pair, lines between the two tell how much. They tell it better than
 * windows, of which fewer than FEW_WINDOWS should meet the sphere. The end of line k is point TURN k of LINES.
 * Measured: HIDDEN_ERROR, the error of the part over that of one random line. With clumps other members hide, too. */
#define MOST_HIDING  4u
#define WITH_CLUMPS  16u
#define LINES        128u
#define TURN         11u
#define FEW_WINDOWS  8.0
#define FAR_APART    2.0 /* distance of the centres over the sum of the radii */
#define HIDDEN_ERROR 0.04
/* A scene is dilute if a line across it meets fewer spheres than DILUTE on the mean, and fewer than DILUTE_ALL over the
 * number of spheres. In others lines take longer than a tenth of the windows. */
#define DILUTE     0.5
#define DILUTE_ALL 12.0

/* The square of the error of a sphere that hardly any window should meet, over that of one that many meet, both over
 * the squared difference of halves, minus 1. Measured: docs/accuracy.md. */
#define RARE_ERROR 8.0

#define UNIT        0x1p-60 /* sums of factors are whole numbers of it, so that they do not depend on an order */
#define SQUARE_UNIT 0x1p-62

/* The convex hull of two spheres: the balls of all points between their centres, whose radii change evenly. */
typedef struct pair_hull {
    double from[3], to[3], axis[3], length; /* L, centres; unit vector and distance between them */
    double r[2], most;                      /* L, radii, and the larger one */
    double slope, cosine;                   /* of the radius along the axis, and sqrt(1 - slope^2) */
} pair_hull;

static pair_hull hull_of(const fibrad_scene *scene, uint32_t place, uint32_t other) {
    pair_hull hull = {.from = {scene->x[place], scene->y[place], scene->z[place]},
                      .to = {scene->x[other], scene->y[other], scene->z[other]},
                      .r = {scene->r[place], scene->r[other]},
                      .most = fibrad_max(scene->r[place], scene->r[other])};
    for (int axis = 0; axis < 3; axis++) hull.axis[axis] = hull.to[axis] - hull.from[axis];
    hull.length = fibrad_sqrt(fibrad_dot(hull.axis, hull.axis));
    for (int axis = 0; axis < 3; axis++) hull.axis[axis] /= hull.length;
    hull.slope = (hull.r[1] - hull.r[0]) / hull.length;
    hull.cosine = fibrad_sqrt(fibrad_max(0, 1 - hull.slope * hull.slope));
    return hull;
}

/* Whether a sphere reaches into a hull. The nearest ball of the hull is at an end, or where the line to it is
 * perpendicular to the surface of the hull. */
static bool hull_meets(const pair_hull *hull, const double at[3], double r) {
    const double c[3] = {at[0] - hull->from[0], at[1] - hull->from[1], at[2] - hull->from[2]};
    const double along = fibrad_dot(c, hull->axis), square = fibrad_dot(c, c), wide = hull->most + r;
    const double across_square = fibrad_max(0, square - along * along), beyond = along - hull->length;
    if (across_square >= wide * wide || along <= -wide || beyond >= wide) return false;
    const double across = fibrad_sqrt(across_square), foot = along * hull->cosine + across * hull->slope;
    double distance = across * hull->cosine - along * hull->slope - hull->r[0];
    if (foot <= 0) distance = fibrad_sqrt(square) - hull->r[0];
    if (foot >= hull->length * hull->cosine) distance = fibrad_sqrt(across_square + beyond * beyond) - hull->r[1];
    return distance < r * (1 - TOUCH);
}

/* Counts the spheres other than the two at `place` and `other` that reach into their hull, up to most + 1. The first
 * `most` go to `between`. most + 1, too, if it takes long to find out, as beside a large sphere among many small ones.
 */
static uint32_t spheres_between(const fibrad_scene *scene, const pair_hull *hull, uint32_t place, uint32_t other,
                                uint32_t most, uint32_t *between) {
    uint32_t compared = 0, count = 0;
    for (uint32_t l = 0; l < scene->levels; l++) {
        const double wide = hull->most + scene->level[l].radius_max;
        fibrad_walk walk;
        fibrad_walk_about(&walk, scene, &scene->level[l], hull->from, hull->to, wide);
        while (fibrad_walk_next(&walk)) {
            compared += walk.end - walk.begin;
            if (compared > HULL_SPHERES) return most + 1;
            for (uint32_t j = walk.begin; j < walk.end; j++) {
                const double at[3] = {scene->x[j], scene->y[j], scene->z[j]};
                if (j == place || j == other || !hull_meets(hull, at, scene->r[j])) continue;
                if (count == most) return most + 1;
                between[count++] = j;
            }
        }
    }
    return count;
}

/* Whether a triangle may reach into a hull. Steps along the axis are as long as the nearest triangle allows. */
static bool triangles_between(const fibrad_scene *scene, const pair_hull *hull) {
    double x = 0;
    for (int step = 0; step < HULL_STEPS && x < hull->length; step++) {
        const double at[3] = {hull->from[0] + x * hull->axis[0], hull->from[1] + x * hull->axis[1],
                              hull->from[2] + x * hull->axis[2]};
        const double r = hull->r[0] + hull->slope * x, most = r + 2 * hull->length + scene->mesh.grain;
        const double free = fibrad_mesh_distance(&scene->mesh, at, most) - scene->mesh.grain - r;
        if (!(free > 0)) return true;
        x += free / (1 + hull->slope);
    }
    return x < hull->length || fibrad_mesh_distance(&scene->mesh, hull->to, 2 * hull->r[1]) < hull->r[1];
}

/* The part of the lines between the discs of two far spheres that some spheres between them leave. Of two members of a
 * clump the one that is nearer to the other sphere hides the other member. */
static double part_left(const fibrad_scene *scene, const pair_hull *hull, uint32_t count, const uint32_t *between) {
    fibrad_disc_points points;
    double u[3], v[3];
    bool hidden[LINES] = {false};
    uint32_t open = LINES;
    (void)fibrad_disc_points_get(LINES, &points);
    fibrad_frame_about(hull->axis, u, v);
    for (uint32_t b = 0; b < count; b++) {
        const uint32_t j = between[b];
        const double at[3] = {scene->x[j] - hull->from[0], scene->y[j] - hull->from[1], scene->z[j] - hull->from[2]};
        const double t = fibrad_dot(at, hull->axis) / hull->length, inverse = 1 / scene->r[j];
        const double square = scene->clump != NULL ? fibrad_dot(at, at) / (hull->length * hull->length) : 0;
        if (square >= 1 || square > 2 * t) continue;
        const float x = (float)(fibrad_dot(at, u) * inverse), y = (float)(fibrad_dot(at, v) * inverse);
        const float from = (float)((1 - t) * hull->r[0] * inverse), to = (float)(t * hull->r[1] * inverse);
        for (uint32_t k = 0; k < LINES && t > 0 && t < 1; k++) {
            const uint32_t end = TURN * k % LINES;
            const float p = from * points.x[k] + to * points.x[end] - x;
            const float q = from * points.y[k] + to * points.y[end] - y;
            hidden[k] |= p * p + q * q < 1;
        }
    }
    for (uint32_t k = 0; k < LINES; k++) open -= hidden[k];
    return open / (double)LINES;
}

bool fibrad_free_pair(const fibrad_scene *scene, uint32_t place, uint32_t other, uint32_t most, double *f,
                      double *error) {
    uint32_t between[WITH_CLUMPS];
    const pair_hull hull = hull_of(scene, place, other);
    *error = 0;
    if (scene->cut[other]) return false; /* members of one clump are pairs, too: what passes inside is then exact */
    const uint32_t count = spheres_between(scene, &hull, place, other, most, between);
    if (count > most || (scene->mesh.triangles > 0 && triangles_between(scene, &hull))) return false;
    if (fibrad_pair_exact(hull.r[0], hull.r[1], hull.length - (hull.r[0] + hull.r[1]), f) != FIBRAD_OK) return false;
    if (count == 0) return true;
    const double left = part_left(scene, &hull, count, between);
    *error = *f * HIDDEN_ERROR * fibrad_sqrt(left * (1 - left) + 1.0 / LINES);
    *f *= left;
    return true;
}

static double sum_of_entry(const fibrad_entries *entries, uint32_t entry) {
    const double *part = entries->part[entry];
    return part[0] + part[2] + (part[1] + part[3]);
}

/* The squared distance of the centres of sphere i and of the nearest image of another sphere. */
static double square_between(const fibrad_workspace *work, uint32_t other) {
    const fibrad_scene *scene = work->scene;
    const double *const of_axis[3] = {scene->x, scene->y, scene->z};
    double square = 0;
    for (int axis = 0; axis < 3; axis++) {
        double c = fibrad_abs(of_axis[axis][other] - work->centre[axis]);
        if (scene->period[axis] > 0) c = fibrad_min(c, fibrad_abs(scene->period[axis] - c));
        square += c * work->inverse * (c * work->inverse);
    }
    return square;
}

/* The number of windows of the row that a sphere should meet. */
static double windows_meeting(const fibrad_workspace *work, uint32_t other, double square) {
    const double wide = 1 + work->scene->r[other] * work->inverse;
    return work->windows * (wide * wide / (4 * square));
}

/* A row while its free pairs are searched. */
typedef struct pair_search {
    fibrad_workspace *work;
    double scale, far; /* far: distance of centres up to which pairs are tried, in radii of sphere i */
    int64_t moved;     /* [UNIT] */
    uint64_t unseen;   /* [SQUARE_UNIT] */
    bool all, pairs;   /* all spheres are tried; pairs may be free */
    bool hidden;       /* pairs that few spheres hide in part count, too */
    bool sparse;       /* what no window has met may count; in dense scenes other spheres hide it */
    bool untold;       /* some sphere has been met by no window, and its pair is not free */
} pair_search;

/* About the factor to a free sphere of radius r, at a squared distance. It is a few percent off. */
static double free_factor(double r, double square) {
    return r * r / (2 * square * (1 + fibrad_sqrt(fibrad_max(0, 1 - (1 + r * r) / square))));
}

/* Takes the factor to the sphere at a place if its pair is free, or if few spheres hide a part of it. windows: that
 * should meet it. seen: what they have seen of it. */
static bool take_pair(pair_search *search, uint32_t other, double windows, double square, double seen) {
    const fibrad_workspace *work = search->work;
    const fibrad_scene *scene = work->scene;
    fibrad_entries *entries = &search->work->entries;
    const double at[3] = {scene->x[other], scene->y[other], scene->z[other]}, inverse = work->inverse;
    const double apart = FAR_APART * (1 + scene->r[other] * inverse);
    const bool hidden = search->hidden && windows < FEW_WINDOWS && square > apart * apart;
    double c[3], f, error;
    for (int axis = 0; axis < 3; axis++) c[axis] = (at[axis] - work->centre[axis]) * inverse;
    if (!hidden && FIBRAD_VERSION_OF(fibrad_near_between, scene->facts.isa)(&work->near, c, scene->r[other] * inverse))
        return false;
    const uint32_t most = !hidden ? 0 : scene->clump != NULL ? WITH_CLUMPS : MOST_HIDING;
    if (!fibrad_free_pair(scene, work->place, other, most, &f, &error)) return false;
    search->unseen += (uint64_t)(error * error / SQUARE_UNIT);
    if (f == 0) return true; /* what windows have seen remains */
    const uint32_t entry = fibrad_entries_of(entries, other);
    if (entry == FIBRAD_NONE)
        entries->missed++;
    else
        entries->exact[entry] = f;
    search->moved += (int64_t)((seen - f) / UNIT);
    return true;
}

/* Tries the sphere at a place that some windows should meet (many), or that hardly any should meet. */
static void try_sphere(pair_search *search, uint32_t other, bool many) {
    const fibrad_workspace *work = search->work;
    const double square = square_between(work, other), r = work->scene->r[other] * work->inverse;
    const double windows = windows_meeting(work, other, square), least = r * r / (4 * square);
    if (other == work->place || !(square <= search->far * search->far)) return;
    if (!search->all && many != (windows > SOME_WINDOWS)) return;
    const uint32_t entry = fibrad_entries_find(&work->entries, other);
    const double seen = entry != FIBRAD_NONE ? sum_of_entry(&work->entries, entry) * search->scale : 0;
    const double part = search->all || !many ? 0 : 1 - SOME_WINDOWS / windows; /* of a free factor */
    if (seen < part * least || seen < part * free_factor(r, square)) return;
    if (search->pairs && take_pair(search, other, windows, square, seen)) return;
    if (entry == FIBRAD_NONE) search->untold = true;
    if (entry != FIBRAD_NONE || !search->sparse || 2 * windows >= 1) return;
    const double missed = least * (1 - 2 * windows);
    search->unseen += (uint64_t)(missed * missed / SQUARE_UNIT);
}

/* Tries the spheres within a distance [L] of the centre that hardly any window should meet, or counts them. */
static uint32_t try_near(pair_search *search, double distance, bool count) {
    const fibrad_workspace *work = search->work;
    const fibrad_scene *scene = work->scene;
    const double least = work->unit + scene->facts.radius_min;
    uint32_t near = 0;
    if (work->windows * (least * least) > SOME_WINDOWS * 4 * distance * distance) return 0;
    for (uint32_t l = 0; l < scene->levels; l++) {
        fibrad_walk walk;
        fibrad_walk_about(&walk, scene, &scene->level[l], work->centre, work->centre, distance);
        while (fibrad_walk_next(&walk))
            for (uint32_t j = walk.begin; j < walk.end; j++)
                if (count)
                    near += square_between(work, j) * (work->unit * work->unit) <= distance * distance;
                else
                    try_sphere(search, j, false);
    }
    return near;
}

/* Tries near spheres. */
static void try_nearest(pair_search *search) {
    const fibrad_workspace *work = search->work;
    double distance = fibrad_min(NEAR_SPACINGS * work->scene->spacing, search->far * work->unit);
    const double windows = work->windows;
    uint32_t near = try_near(search, distance, true);
    for (const bool many = near > MANY_NEAR * windows; many && near > FEW_NEAR * windows;)
        near = try_near(search, distance *= CLOSER, true);
    try_near(search, distance, false);
}

/* What the windows have seen besides spheres. */
static double open_of(const fibrad_workspace *work, double scale) {
    const fibrad_entries *entries = &work->entries;
    int64_t units = 0;
    for (uint32_t k = 0; k < entries->length; k++)
        if (entries->sphere[k] < work->scene->facts.spheres)
            units += (int64_t)(sum_of_entry(entries, k) * scale / UNIT);
    return 1 - (double)units * UNIT;
}

static bool is_dilute(const fibrad_scene *scene) {
    const double n = scene->facts.spheres, inverse = 1 / scene->spacing;
    double discs = 0;
    for (uint32_t j = 0; j < n; j++) discs += FIBRAD_PI * (scene->r[j] * inverse) * (scene->r[j] * inverse);
    const double cube = discs * discs * discs / (n * n);
    return cube < DILUTE * DILUTE * DILUTE && n * n * n * cube < DILUTE_ALL * DILUTE_ALL * DILUTE_ALL;
}

fibrad_free_pairs fibrad_free_pairs_find(fibrad_workspace *work, double scale, bool hidden) {
    const fibrad_scene *scene = work->scene;
    fibrad_entries *entries = &work->entries;
    const uint32_t n = scene->facts.spheres, met = entries->length;
    const bool periodic = scene->period[0] > 0 || scene->period[1] > 0 || scene->period[2] > 0;
    fibrad_free_pairs pairs = {.open = open_of(work, scale)};
    if (periodic || !(pairs.open > (n <= FEW_SPHERES ? LEAST_OPEN : WORTH_WHILE))) return pairs;
    pair_search search = {.work = work, .scale = scale, .far = work->reach, .all = n <= FEW_SPHERES};
    const double spacings = scene->spacing * work->inverse, volume = spacings * spacings * spacings;
    if (!search.all)
        search.far = fibrad_min(work->reach, fibrad_max(0, MANY_BETWEEN / (4 * FIBRAD_PI) * volume - 8.0 / 3));
    search.hidden = hidden && search.all && scene->facts.walls == 0 && is_dilute(scene);
    search.sparse = search.all || met < FEW_ENTRIES, search.pairs = !scene->cut[work->place];
    for (uint32_t k = 0; k < met && !search.all; k++)
        if (entries->sphere[k] < n) try_sphere(&search, entries->sphere[k], true);
    if (!search.all) try_nearest(&search);
    search.pairs = search.pairs && search.all;
    const uint32_t step = search.all ? 1 : 1 + n / UNSEEN_ASKED;
    for (uint32_t j = 0; j < n && search.sparse; j += step) try_sphere(&search, j, false);
    const double both = search.hidden ? 2 : 1; /* what is open errs as much */
    pairs.unseen = fibrad_sqrt(both * (double)search.unseen * step * SQUARE_UNIT);
    pairs.moved = (double)search.moved * UNIT;
    pairs.told = search.all && !search.untold;
    if (pairs.open + pairs.moved > 0) return pairs;
    for (uint32_t k = 0; k < entries->length; k++) entries->exact[k] = 0;
    pairs.moved = 0, pairs.told = false;
    return pairs;
}

/* A random point of the unit disc. */
static void point_of_disc(uint64_t *random, double at[2]) {
    do
        for (int k = 0; k < 2; k++) at[k] = 2 * fibrad_fraction(*random = fibrad_mix(*random)) - 1;
    while (at[0] * at[0] + at[1] * at[1] > 1);
}

/* A segment from a random point of the disc across the line of centres to one of the other sphere's disc. */
static fibrad_segment segment_to(const fibrad_workspace *work, uint32_t other, double weight) {
    const fibrad_scene *scene = work->scene;
    const pair_hull hull = hull_of(scene, work->place, other);
    const double *c = hull.axis, r = hull.r[1] * work->inverse, length = hull.length * work->inverse;
    uint64_t random = fibrad_mix(work->segments.shift[0] ^ fibrad_mix(fibrad_scene_rank(scene, other)));
    double p[2], q[2], u[3], v[3], from[3];
    fibrad_segment segment = {.sphere = other, .weight = weight};
    fibrad_frame_about(c, u, v);
    point_of_disc(&random, p);
    point_of_disc(&random, q);
    for (int axis = 0; axis < 3; axis++) {
        from[axis] = p[0] * u[axis] + p[1] * v[axis];
        segment.centre[axis] = length * c[axis];
        segment.w[axis] = segment.centre[axis] + r * (q[0] * u[axis] + q[1] * v[axis]) - from[axis];
    }
    const double inverse = 1 / fibrad_sqrt(fibrad_dot(segment.w, segment.w));
    for (int axis = 0; axis < 3; axis++) segment.w[axis] *= inverse;
    const double along = fibrad_dot(from, segment.w);
    const double out = fibrad_sqrt(fibrad_max(0, along * along + 1 - fibrad_dot(from, from))) - along;
    for (int axis = 0; axis < 3; axis++) segment.n[axis] = from[axis] + out * segment.w[axis];
    return segment;
}

/* The entry of the sphere that a segment meets. FIBRAD_NONE: there is none. */
static uint32_t entry_of_segment(const fibrad_entries *entries, const fibrad_segment *segment) {
    return segment->sphere != FIBRAD_NONE ? fibrad_entries_find(entries, segment->sphere) : FIBRAD_NONE;
}

int fibrad_free_pairs_segments(fibrad_workspace *work, const fibrad_free_pairs *pairs) {
    fibrad_segments *segments = &work->segments;
    const fibrad_entries *entries = &work->entries;
    double *count = entries->lengths; /* segments to each sphere */
    uint32_t more = 0;
    segments->sources = segments->length;
    if (segments->length == 0 || pairs->moved == 0) return FIBRAD_OK;
    for (uint32_t k = 0; k < segments->length; k++) {
        const uint32_t entry = entry_of_segment(entries, &segments->segment[k]);
        if (entry != FIBRAD_NONE) count[entry]++;
    }
    for (uint32_t k = 0; k < segments->length; k++) {
        fibrad_segment *segment = &segments->segment[k];
        const uint32_t entry = entry_of_segment(entries, segment);
        if (segment->sphere == FIBRAD_NONE) segment->weight = 1 + pairs->moved / pairs->open;
        if (entry != FIBRAD_NONE && entries->exact[entry] > 0)
            segment->weight = entries->exact[entry] * segments->length / count[entry];
    }
    for (uint32_t k = 0; k < entries->length; k++) {
        if (!(entries->exact[k] > 0) || count[k] > 0) continue;
        if (segments->length + ++more <= work->plan.segments)
            segments->segment[segments->sources++] =
                segment_to(work, entries->sphere[k], entries->exact[k] * segments->length);
    }
    work->needed.segments = segments->length + more;
    return segments->sources == work->needed.segments ? FIBRAD_OK : FIBRAD_E_WORK;
}

void fibrad_weigh_halves(const fibrad_workspace *work, fibrad_row *row) {
    const fibrad_scene *scene = work->scene;
    const double far = 2 * work->free_path;
    if (work->windows > SOME_WINDOWS * (far * far)) return; /* lines end before they come to such spheres */
    for (uint32_t k = 0; k < row->length; k++) {
        const uint32_t other = scene->place[row->col[k]];
        const double square = square_between(work, other), windows = 2 * windows_meeting(work, other, square);
        row->half[k] *= (float)fibrad_sqrt(1 + RARE_ERROR / (1 + windows * windows));
    }
}

void fibrad_free_pairs_share(const fibrad_free_pairs *pairs, double wall[FIBRAD_SLOTS], fibrad_row *row) {
    const double ratio = 1 + pairs->moved / pairs->open;
    if (pairs->moved == 0) return;
    row->escaped *= ratio, row->beyond *= ratio;
    for (uint32_t slot = 0; slot < FIBRAD_SLOTS; slot++) wall[slot] *= ratio;
}
