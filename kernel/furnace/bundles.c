/* bundles.c - bundles of rays through the cells of a box. SPDX-License-Identifier: MIT
 *
 * A bundle carries power with a sign. Sources emit bundles only for what they emit above or below a reference E. The
 * reference is in equilibrium with itself and needs no bundles. Start and first direction are a point of a
 * five-dimensional quasirandom sequence. Later events use a random stream of the bundle.
 *
 * Attenuated bundles lose energy along their path as exp(-absorption length). They add moments of the intensity to the
 * faces between cells that they cross. A bundle crosses the planes of one axis at equal distances. So the three axes
 * are taken one after the other, the crossings need not be sorted, and the weight falls by the same factor from plane
 * to plane.
 *
 * Equilibrium bundles keep their power. The medium emits what it absorbs, in all directions alike. So absorption and
 * scattering both are a new direction. Walls absorb a bundle as a whole or reflect it. The incident radiation of a cell
 * follows from the lengths of the paths in it. For these the crossings are taken in order. */
#include "furnace/furnace.h"

#include "base/elementary.h"

#define PLANE_NONE 1e300      /* m: distance of a plane that the bundle never meets */
#define WALL_NONE  UINT32_MAX /* the bundle is on no wall */

/* place in units of cells, so that planes are at whole numbers; direction; weight in units of the tally */
typedef struct furnace_bundle {
    double at[3], direction[3];
    double weight;
} furnace_bundle;

/* A direction from two numbers in [0, 1): by the cosine law if the bundle leaves wall w; any if w is WALL_NONE. */
static void bundle_turn(furnace_bundle *r, uint32_t w, const double u[2]) {
    if (w == WALL_NONE) {
        fibrad_even_direction(u, r->direction);
        return;
    }
    double rho = fibrad_sqrt(u[0]), z = fibrad_sqrt(1 - u[0]), sine, cosine;
    fibrad_sincos_turn(u[1], &sine, &cosine);
    r->direction[fibrad_face_axis(w)] = fibrad_face_is_upper(w) ? -z : z;
    r->direction[fibrad_face_along(w, 0)] = rho * cosine;
    r->direction[fibrad_face_along(w, 1)] = rho * sine;
}

/* The cell along axis a at `place` [cells]. */
static size_t bundle_cell(const fibrad_furnace *f, uint32_t a, double place) {
    size_t k = place > 0 ? (size_t)(int64_t)place : 0;
    return k < f->config.cells[a] ? k : f->config.cells[a] - 1;
}

/* The axes along which the patches of wall w are numbered, the fastest first. */
static void bundle_axes(uint32_t w, uint32_t *fast, uint32_t *slow) {
    *fast = fibrad_face_axis(w) == 0 ? 1 : 0, *slow = fibrad_face_axis(w) == 2 ? 1 : 2;
}

/* Index of the patch of wall w at the position of the bundle. */
static size_t bundle_patch(const fibrad_furnace *f, uint32_t w, const furnace_bundle *r) {
    uint32_t b, c;
    bundle_axes(w, &b, &c);
    return bundle_cell(f, b, r->at[b]) + f->config.cells[b] * bundle_cell(f, c, r->at[c]);
}

/* Where wall w crosses its axis [cells]. */
static double bundle_wall_at(const fibrad_furnace *f, uint32_t w) {
    return fibrad_face_is_upper(w) ? f->config.cells[fibrad_face_axis(w)] : 0;
}

/* The start of bundle k of the plan, which source s emits. Returns the wall that the bundle leaves, or WALL_NONE. */
static uint32_t bundle_start(const fibrad_furnace *f, uint64_t k, size_t s, furnace_bundle *r) {
    double u[5];
    for (int d = 0; d < 5; d++) u[d] = fibrad_quasirandom(5, d, f->origin + k, f->config.seed);
    r->weight = f->power[s] / ((double)(f->first[s + 1] - f->first[s]) * f->bundle_power) * FIBRAD_TALLY_UNIT;
    if (s < f->cells) {
        for (uint32_t a = 0; a < 3; a++) r->at[a] = (double)(s / f->cell_stride[a] % f->config.cells[a]) + u[2 + a];
        bundle_turn(r, WALL_NONE, u);
        return WALL_NONE;
    }
    uint32_t w = 0, b, c;
    while (w < 5 && s >= f->wall_source[w + 1]) w++;
    bundle_axes(w, &b, &c);
    size_t patch = s - f->wall_source[w];
    r->at[fibrad_face_axis(w)] = bundle_wall_at(f, w);
    r->at[b] = (double)(patch % f->config.cells[b]) + u[2];
    r->at[c] = (double)(patch / f->config.cells[b]) + u[3];
    bundle_turn(r, w, u);
    return w;
}

/* Finds the cells per metre along the direction, and the distance [m] to the next wall. Returns this wall. */
static uint32_t bundle_find_wall(const fibrad_furnace *f, const furnace_bundle *r, double speed[3], double *distance) {
    uint32_t wall = 0;
    *distance = PLANE_NONE;
    for (uint32_t a = 0; a < 3; a++) {
        speed[a] = r->direction[a] / f->step[a];
        double way = speed[a] > 0 ? f->config.cells[a] - r->at[a] : -r->at[a];
        double t = fibrad_abs(speed[a]) * PLANE_NONE > fibrad_abs(way) ? fibrad_max(way / speed[a], 0) : PLANE_NONE;
        if (t < *distance) {
            *distance = t;
            wall = fibrad_face(a, speed[a] > 0);
        }
    }
    return wall;
}

/* Advances the bundle by `distance`. If w is not WALL_NONE, the bundle is then on wall w. */
static void bundle_advance(const fibrad_furnace *f, furnace_bundle *r, const double speed[3], double distance,
                           uint32_t w) {
    for (uint32_t a = 0; a < 3; a++) {
        double place = r->at[a] + speed[a] * distance;
        r->at[a] = fibrad_min(fibrad_max(place, 0), f->config.cells[a]);
    }
    if (w != WALL_NONE) r->at[fibrad_face_axis(w)] = bundle_wall_at(f, w);
}

static double bundle_free_path(double extinction, fibrad_random *random) {
    return extinction > 0 ? -fibrad_log(1 - fibrad_random_next(random)) / extinction : PLANE_NONE;
}

/* ---- attenuated ------------------------------------------------------------------------------------------------ */

static void bundle_add_moments(fibrad_moments *moments, double f0, double f1, double f2) {
    moments->f[0] += (int64_t)f0;
    moments->f[1] += (int64_t)f1;
    moments->f[2] += (int64_t)f2;
}

/* Adds the moments at the faces between cells that are crossed from r->at to `end` [cells]. */
static void bundle_cross_faces(const fibrad_furnace *f, fibrad_furnace_tally *tally, const furnace_bundle *r,
                               const double speed[3], const double end[3]) {
    double absorption = f->config.absorption;
    for (uint32_t a = 0; a < 3; a++) {
        bool up = speed[a] > 0;
        double from = up ? fibrad_floor(r->at[a]) + 1 : -fibrad_floor(-r->at[a]) - 1; /* first plane ahead */
        double to = up ? fibrad_min(-fibrad_floor(-end[a]), f->config.cells[a]) - 1
                       : fibrad_max(fibrad_floor(end[a]), 0) + 1; /* last plane before the end */
        int64_t crossings = (int64_t)(up ? to - from : from - to) + 1;
        if (crossings <= 0) continue;

        uint32_t b = (a + 1) % 3, c = (a + 2) % 3;
        double interval = 1 / fibrad_abs(speed[a]), t = (from - r->at[a]) / speed[a];
        double weight = r->weight * fibrad_exp(-absorption * t), decay = fibrad_exp(-absorption * interval);
        double cosine = fibrad_abs(r->direction[a]), at_b = r->at[b] + speed[b] * t, at_c = r->at[c] + speed[c] * t;
        double step_b = speed[b] * interval, step_c = speed[c] * interval;
        const size_t *stride = f->face_stride[a];
        size_t plane = (size_t)(int64_t)from * stride[a];
        for (int64_t k = 0; k < crossings; k++) {
            size_t face = plane + bundle_cell(f, b, at_b) * stride[b] + bundle_cell(f, c, at_c) * stride[c];
            bundle_add_moments(&tally->moment[a][up ? 0 : 1][face], weight, weight * cosine, weight * cosine * cosine);
            weight *= decay;
            at_b += step_b;
            at_c += step_c;
            plane = up ? plane + stride[a] : plane - stride[a];
        }
    }
}

/* The moments of radiation that leaves wall w, or that arrives there, at the position of the bundle. */
static fibrad_moments *bundle_at_wall(const fibrad_furnace *f, fibrad_furnace_tally *tally, uint32_t w, bool leaves,
                                      const furnace_bundle *r) {
    uint32_t a = fibrad_face_axis(w), b = fibrad_face_along(w, 0), c = fibrad_face_along(w, 1);
    size_t last = fibrad_face_is_upper(w) ? f->config.cells[a] * f->face_stride[a][a] : 0;
    size_t face =
        last + bundle_cell(f, b, r->at[b]) * f->face_stride[a][b] + bundle_cell(f, c, r->at[c]) * f->face_stride[a][c];
    return &tally->moment[a][leaves == fibrad_face_is_upper(w)][face];
}

/* Adds diffuse radiation that leaves wall w by its mean moments. The moments of the one direction sampled would be
 * noisier. */
static void bundle_add_departure(const fibrad_furnace *f, fibrad_furnace_tally *tally, uint32_t w,
                                 const furnace_bundle *r) {
    bundle_add_moments(bundle_at_wall(f, tally, w, true, r), r->weight, r->weight * (2.0 / 3), r->weight / 2);
}

static void bundle_trace_attenuated(const fibrad_furnace *f, fibrad_furnace_tally *tally, furnace_bundle *r,
                                    uint32_t wall, fibrad_random *random) {
    double least = 0.02 * fibrad_abs(r->weight);
    if (wall != WALL_NONE) bundle_add_departure(f, tally, wall, r);
    for (;;) {
        double speed[3], distance, path = bundle_free_path(f->config.scattering, random);
        wall = bundle_find_wall(f, r, speed, &distance);
        if (path < distance) {
            distance = path;
            wall = WALL_NONE;
        }
        furnace_bundle end = *r;
        bundle_advance(f, &end, speed, distance, wall);
        bundle_cross_faces(f, tally, r, speed, end.at);
        *r = end;
        r->weight *= fibrad_exp(-f->config.absorption * distance);
        if (wall != WALL_NONE) {
            double cosine = fibrad_abs(r->direction[fibrad_face_axis(wall)]), weight = r->weight;
            bundle_add_moments(bundle_at_wall(f, tally, wall, false, r), weight, weight * cosine,
                               weight * cosine * cosine);
            r->weight *= 1 - f->config.wall_emissivity[wall];
            bundle_add_departure(f, tally, wall, r);
        }
        /* Russian roulette: of weak bundles one in five continues with five times the weight. */
        if (fibrad_abs(r->weight) < least) {
            if (r->weight == 0 || fibrad_random_next(random) >= 0.2) return;
            r->weight *= 5;
        }
        double u[2];
        for (int d = 0; d < 2; d++) u[d] = fibrad_random_next(random);
        bundle_turn(r, wall, u);
    }
}

/* ---- equilibrium ----------------------------------------------------------------------------------------------- */

/* Adds the lengths of the path in the cells that it passes over `distance`. */
static void bundle_measure_path(const fibrad_furnace *f, fibrad_furnace_tally *tally, const furnace_bundle *r,
                                const double speed[3], double distance) {
    double next[3], interval[3], weight = r->weight / fibrad_cell_diagonal(f), t = 0;
    size_t left[3], cell = 0, stride[3];
    for (uint32_t a = 0; a < 3; a++) {
        bool up = speed[a] > 0;
        size_t here = bundle_cell(f, a, r->at[a]);
        left[a] = up ? f->config.cells[a] - 1 - here : here; /* planes between the cell and the wall */
        cell += here * f->cell_stride[a];
        stride[a] = up ? f->cell_stride[a] : (size_t)0 - f->cell_stride[a];
        double way = (double)(here + (up ? 1 : 0)) - r->at[a];
        interval[a] = left[a] > 0 && speed[a] != 0 ? fibrad_min(1 / fibrad_abs(speed[a]), PLANE_NONE) : PLANE_NONE;
        next[a] = interval[a] < PLANE_NONE ? way / speed[a] : PLANE_NONE;
    }
    for (;;) {
        int a = next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
        double to = fibrad_min(next[a], distance);
        tally->path[cell] += (int64_t)(weight * (to - t));
        if (to >= distance) return;
        t = to;
        cell += stride[a];
        next[a] = --left[a] > 0 ? next[a] + interval[a] : PLANE_NONE;
    }
}

static void bundle_trace_equilibrium(const fibrad_furnace *f, fibrad_furnace_tally *tally, furnace_bundle *r,
                                     fibrad_random *random) {
    double extinction = f->config.absorption + f->config.scattering;
    for (;;) {
        double speed[3], distance, path = bundle_free_path(extinction, random);
        uint32_t wall = bundle_find_wall(f, r, speed, &distance);
        if (path < distance) {
            distance = path;
            wall = WALL_NONE;
        }
        bundle_measure_path(f, tally, r, speed, distance);
        bundle_advance(f, r, speed, distance, wall);
        if (wall != WALL_NONE && fibrad_random_next(random) < f->config.wall_emissivity[wall]) {
            size_t patch = f->wall_source[wall] - f->cells + bundle_patch(f, wall, r);
            tally->absorbed[patch] += (int64_t)r->weight;
            return;
        }
        double u[2];
        for (int d = 0; d < 2; d++) u[d] = fibrad_random_next(random);
        bundle_turn(r, wall, u);
    }
}

/* The last source whose first bundle is at most bundle k. */
static size_t bundle_source(const fibrad_furnace *f, uint64_t k) {
    size_t low = 0, high = f->sources;
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        if (f->first[middle] <= k)
            low = middle;
        else
            high = middle;
    }
    return low;
}

int fibrad_furnace_trace(const fibrad_furnace *furnace, fibrad_furnace_tally *tally, uint64_t first, uint64_t count) {
    const fibrad_furnace *f = furnace;
    if (f == NULL || tally == NULL) return FIBRAD_E_ARGUMENT;
    if (f->bundle_power == 0 || !fibrad_tally_fits(f, tally)) return FIBRAD_E_STATE;
    if (first > f->planned || count > f->planned - first) return FIBRAD_E_ARGUMENT;
    if (tally->series != 0 && tally->series != f->series) return FIBRAD_E_STATE;
    if (count == 0) return FIBRAD_OK;
    tally->series = f->series;
    tally->mark += fibrad_bundles_mark(f->plan, first, count);
    size_t s = bundle_source(f, first);
    for (uint64_t k = first; k < first + count; k++) {
        while (f->first[s + 1] <= k) s++;
        furnace_bundle r;
        uint32_t wall = bundle_start(f, k, s, &r);
        fibrad_random random = fibrad_random_start(f->config.seed, f->origin + k);
        if (f->physics == FIBRAD_FURNACE_ATTENUATED)
            bundle_trace_attenuated(f, tally, &r, wall, &random);
        else
            bundle_trace_equilibrium(f, tally, &r, &random);
    }
    return FIBRAD_OK;
}
