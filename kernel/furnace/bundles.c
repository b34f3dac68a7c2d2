/* bundles.c - bundles of rays through the cells of a box. SPDX-License-Identifier: MIT
 *
 * A bundle carries signed power: only what sources emit above (or below) a reference E, which is in equilibrium with
 * itself and needs no tracing. Each cell and each wall patch sends a whole number of bundles that carry exactly its
 * power. Where they start and whither comes from a sequence that fills the five dimensions evenly; what befalls them
 * later comes from a random stream of each bundle's own.
 *
 * Attenuated bundles lose energy along their way as exp(-absorption length) and give moments of the intensity where
 * they cross faces between cells. Planes of one axis are crossed at even distances, so the three axes are taken one
 * after the other, without sorting the crossings, and the weight falls by the same factor from plane to plane.
 *
 * Equilibrium bundles keep their power. The medium gives off again what it absorbs, isotropically, so that absorption
 * and scattering are both a new direction; walls absorb a bundle whole or reflect it. The incident radiation of a cell
 * follows from the lengths of the paths in it, for which the crossings are put in order. */
#include "furnace/furnace.h"

#include "base/elementary.h"
#include "base/random.h"

#define PLANNED_MAX 0x1p33
#define FAR         1e300 /* m: a plane that is never met */

int fibrad_furnace_emit(fibrad_furnace *furnace, fibrad_furnace_physics physics, uint64_t bundles, int restart,
                        uint64_t *planned) {
    fibrad_furnace *f = furnace;
    if (f == NULL || planned == NULL || bundles == 0 || bundles > (uint64_t)1 << 32) return FIBRAD_E_ARGUMENT;
    if (physics != FIBRAD_FURNACE_ATTENUATED && physics != FIBRAD_FURNACE_EQUILIBRIUM) return FIBRAD_E_ARGUMENT;
    bool anew = restart != 0 || f->bundle_power == 0 || physics != f->physics;
    f->physics = physics;
    f->origin = anew ? 0 : f->origin + f->planned;

    double total = 0, volume = fibrad_cell_volume(f);
    for (size_t k = 0; k < f->cells; k++) {
        double before = anew ? f->reference : f->traced[k];
        if (physics == FIBRAD_FURNACE_ATTENUATED)
            f->power[k] = 4 * f->config.absorption * (f->at.e[k] - before) * volume;
        else
            f->power[k] = anew ? f->config.source * volume : 0;
        f->traced[k] = f->at.e[k];
        total += fibrad_abs(f->power[k]);
    }
    for (int w = 0; w < 6; w++) {
        double net = f->config.wall_emissivity[w] * (f->wall_e[w] - f->reference);
        double power = anew ? net * fibrad_face_area(f, w / 2) : 0;
        for (size_t p = 0; p < f->patches[w / 2]; p++) f->power[f->wall_source[w] + p] = power;
        total += fibrad_abs(power) * (double)f->patches[w / 2];
    }
    if (anew) f->bundle_power = total > 0 ? fibrad_max(total / (double)bundles, DBL_MIN) : 1;
    f->planned = 0;
    if (!fibrad_finite(total) || total > f->bundle_power * PLANNED_MAX) {
        f->bundle_power = 0;
        return FIBRAD_E_ARGUMENT;
    }

    uint64_t sum = 0;
    for (size_t s = 0; s < f->sources; s++) {
        f->first[s] = sum;
        if (f->power[s] != 0) sum += (uint64_t)fibrad_max(fibrad_abs(f->power[s]) / f->bundle_power + 0.5, 1);
    }
    f->first[f->sources] = sum;
    *planned = f->planned = sum;
    return FIBRAD_OK;
}

/* A bundle on its way. Positions are in cells, so that planes lie at whole numbers. */
typedef struct ray {
    double at[3], direction[3];
    double weight; /* in units of the tally */
} ray;

/* Direction from two numbers in [0, 1): isotropic. */
static void isotropic(ray *r, double u, double v) {
    double z = 1 - 2 * u, rho = fibrad_sqrt(fibrad_max(1 - z * z, 0)), sine, cosine;
    fibrad_sincos_turn(v, &sine, &cosine);
    r->direction[0] = rho * cosine;
    r->direction[1] = rho * sine;
    r->direction[2] = z;
}

/* Direction from two numbers in [0, 1): by the cosine law, away from wall w. */
static void leave_wall(ray *r, int w, double u, double v) {
    double rho = fibrad_sqrt(u), z = fibrad_sqrt(1 - u), sine, cosine;
    fibrad_sincos_turn(v, &sine, &cosine);
    int a = w / 2;
    r->direction[a] = w % 2 ? -z : z;
    r->direction[(a + 1) % 3] = rho * cosine;
    r->direction[(a + 2) % 3] = rho * sine;
}

/* The cell, along axis a, at `place` [cells]. */
static size_t cell_at(const fibrad_furnace *f, int a, double place) {
    size_t k = place > 0 ? (size_t)(int64_t)place : 0;
    return k < f->config.cells[a] ? k : f->config.cells[a] - 1;
}

/* Number of the patch of a wall across axis a in which the ray is. */
static size_t patch_at(const fibrad_furnace *f, int a, const ray *r) {
    int b = a == 0 ? 1 : 0, c = a == 2 ? 1 : 2;
    return cell_at(f, b, r->at[b]) + f->config.cells[b] * cell_at(f, c, r->at[c]);
}

/* Puts the ray at the start of bundle number k of the plan, of source s. Returns the wall it leaves, -1 if none. */
static int start(const fibrad_furnace *f, uint64_t k, size_t s, ray *r) {
    double u[5];
    for (int d = 0; d < 5; d++) u[d] = fibrad_quasirandom(f->config.seed, f->origin + k, d);
    r->weight = f->power[s] / ((double)(f->first[s + 1] - f->first[s]) * f->bundle_power) * FIBRAD_TALLY_UNIT;
    if (s < f->cells) {
        for (int a = 0; a < 3; a++) r->at[a] = (double)(s / f->cell_stride[a] % f->config.cells[a]) + u[2 + a];
        isotropic(r, u[0], u[1]);
        return -1;
    }
    int w = 0;
    while (w < 5 && s >= f->wall_source[w + 1]) w++;
    int a = w / 2, b = a == 0 ? 1 : 0, c = a == 2 ? 1 : 2;
    size_t patch = s - f->wall_source[w];
    r->at[a] = w % 2 ? (double)f->config.cells[a] : 0;
    r->at[b] = (double)(patch % f->config.cells[b]) + u[2];
    r->at[c] = (double)(patch / f->config.cells[b]) + u[3];
    leave_wall(r, w, u[0], u[1]);
    return w;
}

/* Cells per metre along the ray, and the distance [m] to the wall it will meet, which is returned. */
static int find_wall(const fibrad_furnace *f, const ray *r, double speed[3], double *distance) {
    int wall = 0;
    *distance = FAR;
    for (int a = 0; a < 3; a++) {
        speed[a] = r->direction[a] / f->step[a];
        double way = speed[a] > 0 ? f->config.cells[a] - r->at[a] : -r->at[a];
        double t = fibrad_abs(speed[a]) * FAR > fibrad_abs(way) ? fibrad_max(way / speed[a], 0) : FAR;
        if (t < *distance) {
            *distance = t;
            wall = 2 * a + (speed[a] > 0);
        }
    }
    return wall;
}

/* Moves the ray on by `distance`, onto wall w unless that is -1. */
static void move(const fibrad_furnace *f, ray *r, const double speed[3], double distance, int w) {
    for (int a = 0; a < 3; a++) {
        double place = r->at[a] + speed[a] * distance;
        r->at[a] = fibrad_min(fibrad_max(place, 0), f->config.cells[a]);
    }
    if (w >= 0) r->at[w / 2] = w % 2 ? f->config.cells[w / 2] : 0;
}

static double free_path(double extinction, fibrad_random *random) {
    return extinction > 0 ? -fibrad_log(1 - fibrad_random_next(random)) / extinction : FAR;
}

/* ---- attenuated ------------------------------------------------------------------------------------------------ */

static void count_moments(fibrad_moments *moments, double f0, double f1, double f2) {
    moments->f[0] += (int64_t)f0;
    moments->f[1] += (int64_t)f1;
    moments->f[2] += (int64_t)f2;
}

/* Counts the faces between cells that the ray crosses on its way from r->at to `end` [cells]. */
static void cross_faces(const fibrad_furnace *f, fibrad_furnace_tally *tally, const ray *r, const double speed[3],
                        const double end[3]) {
    double absorption = f->config.absorption;
    for (int a = 0; a < 3; a++) {
        bool up = speed[a] > 0;
        double from = up ? fibrad_floor(r->at[a]) + 1 : -fibrad_floor(-r->at[a]) - 1; /* first plane ahead */
        double to = up ? fibrad_min(-fibrad_floor(-end[a]), f->config.cells[a]) - 1
                       : fibrad_max(fibrad_floor(end[a]), 0) + 1; /* last one before the end */
        int64_t crossings = (int64_t)(up ? to - from : from - to) + 1;
        if (crossings <= 0) continue;

        int b = (a + 1) % 3, c = (a + 2) % 3;
        double interval = 1 / fibrad_abs(speed[a]), t = (from - r->at[a]) / speed[a];
        double weight = r->weight * fibrad_exp(-absorption * t), decay = fibrad_exp(-absorption * interval);
        double cosine = fibrad_abs(r->direction[a]);
        double at_b = r->at[b] + speed[b] * t, at_c = r->at[c] + speed[c] * t;
        double step_b = speed[b] * interval, step_c = speed[c] * interval;
        const size_t *stride = f->face_stride[a];
        size_t plane = (size_t)(int64_t)from * stride[a];
        for (int64_t k = 0; k < crossings; k++) {
            size_t face = plane + cell_at(f, b, at_b) * stride[b] + cell_at(f, c, at_c) * stride[c];
            count_moments(&tally->moment[a][up ? 0 : 1][face], weight, weight * cosine, weight * cosine * cosine);
            weight *= decay;
            at_b += step_b;
            at_c += step_c;
            plane = up ? plane + stride[a] : plane - stride[a];
        }
    }
}

/* Face of the box at which the ray is, on wall w. */
static size_t wall_face(const fibrad_furnace *f, int w, const ray *r) {
    int a = w / 2, b = (a + 1) % 3, c = (a + 2) % 3;
    size_t last = w % 2 ? f->config.cells[a] * f->face_stride[a][a] : 0;
    return last + cell_at(f, b, r->at[b]) * f->face_stride[a][b] + cell_at(f, c, r->at[c]) * f->face_stride[a][c];
}

/* Diffuse radiation that leaves wall w: its mean moments, not those of the one direction it takes. */
static void count_departure(const fibrad_furnace *f, fibrad_furnace_tally *tally, int w, const ray *r) {
    count_moments(&tally->moment[w / 2][w % 2][wall_face(f, w, r)], r->weight, r->weight * (2.0 / 3), r->weight / 2);
}

static void trace_attenuated(const fibrad_furnace *f, fibrad_furnace_tally *tally, ray *r, int wall,
                             fibrad_random *random) {
    double least = 0.02 * fibrad_abs(r->weight);
    if (wall >= 0) count_departure(f, tally, wall, r);
    for (;;) {
        double speed[3], distance, path = free_path(f->config.scattering, random);
        wall = find_wall(f, r, speed, &distance);
        if (path < distance) {
            distance = path;
            wall = -1;
        }
        ray end = *r;
        move(f, &end, speed, distance, wall);
        cross_faces(f, tally, r, speed, end.at);
        *r = end;
        r->weight *= fibrad_exp(-f->config.absorption * distance);
        if (wall >= 0) {
            double cosine = fibrad_abs(r->direction[wall / 2]), weight = r->weight;
            count_moments(&tally->moment[wall / 2][wall % 2 ? 0 : 1][wall_face(f, wall, r)], weight, weight * cosine,
                          weight * cosine * cosine);
            r->weight *= 1 - f->config.wall_emissivity[wall];
            count_departure(f, tally, wall, r);
        }
        /* Weak bundles end, but one in five goes on for all: an end without survivors would lose energy. */
        if (fibrad_abs(r->weight) < least) {
            if (r->weight == 0 || fibrad_random_next(random) >= 0.2) return;
            r->weight *= 5;
        }
        double u = fibrad_random_next(random), v = fibrad_random_next(random);
        if (wall >= 0)
            leave_wall(r, wall, u, v);
        else
            isotropic(r, u, v);
    }
}

/* ---- equilibrium ----------------------------------------------------------------------------------------------- */

/* Counts the lengths of the ray in the cells it passes over `distance`. */
static void measure_path(const fibrad_furnace *f, fibrad_furnace_tally *tally, const ray *r, const double speed[3],
                         double distance) {
    double next[3], interval[3], weight = r->weight / fibrad_cell_diagonal(f), t = 0;
    size_t left[3], cell = 0, stride[3];
    for (int a = 0; a < 3; a++) {
        bool up = speed[a] > 0;
        size_t here = cell_at(f, a, r->at[a]);
        left[a] = up ? f->config.cells[a] - 1 - here : here; /* planes between the cell and the wall */
        cell += here * f->cell_stride[a];
        stride[a] = up ? f->cell_stride[a] : (size_t)0 - f->cell_stride[a];
        double way = (double)(here + (up ? 1 : 0)) - r->at[a];
        interval[a] = left[a] > 0 && speed[a] != 0 ? fibrad_min(1 / fibrad_abs(speed[a]), FAR) : FAR;
        next[a] = interval[a] < FAR ? way / speed[a] : FAR;
    }
    for (;;) {
        int a = next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
        double to = fibrad_min(next[a], distance);
        tally->path[cell] += (int64_t)(weight * (to - t));
        if (to >= distance) return;
        t = to;
        cell += stride[a];
        next[a] = --left[a] > 0 ? next[a] + interval[a] : FAR;
    }
}

static void trace_equilibrium(const fibrad_furnace *f, fibrad_furnace_tally *tally, ray *r, fibrad_random *random) {
    double extinction = f->config.absorption + f->config.scattering;
    for (;;) {
        double speed[3], distance, path = free_path(extinction, random);
        int wall = find_wall(f, r, speed, &distance);
        if (path < distance) {
            distance = path;
            wall = -1;
        }
        measure_path(f, tally, r, speed, distance);
        move(f, r, speed, distance, wall);
        if (wall >= 0 && fibrad_random_next(random) < f->config.wall_emissivity[wall]) {
            size_t patch = f->wall_source[wall] - f->cells + patch_at(f, wall / 2, r);
            tally->absorbed[patch] += (int64_t)r->weight;
            return;
        }
        double u = fibrad_random_next(random), v = fibrad_random_next(random);
        if (wall >= 0)
            leave_wall(r, wall, u, v);
        else
            isotropic(r, u, v);
    }
}

/* The last source whose first bundle is not after bundle k and which has any. */
static size_t source_of(const fibrad_furnace *f, uint64_t k) {
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
    if (f == NULL || tally == NULL || !fibrad_tally_fits(f, tally)) return FIBRAD_E_ARGUMENT;
    if (first > f->planned || count > f->planned - first) return FIBRAD_E_ARGUMENT;
    size_t s = count > 0 ? source_of(f, first) : 0;
    for (uint64_t k = first; k < first + count; k++) {
        while (f->first[s + 1] <= k) s++;
        ray r;
        int wall = start(f, k, s, &r);
        fibrad_random random = fibrad_random_start(f->config.seed, f->origin + k);
        if (f->physics == FIBRAD_FURNACE_ATTENUATED)
            trace_attenuated(f, tally, &r, wall, &random);
        else
            trace_equilibrium(f, tally, &r, &random);
    }
    return FIBRAD_OK;
}
