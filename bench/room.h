/* room.h - unequal grey spheres between grey walls, and their powers by paths. SPDX-License-Identifier: MIT
 *
 * Scenes are random. The walls are six walls of a box, or a cylinder with two ends. The paths are followed one by one,
 * with geometry and random numbers that share nothing with the kernel. From body i, of area A_i and emissivity e_i, n_i
 * paths start. Each surface on a path absorbs its share of the path's weight. The exchange of i and j is the weight
 * that the paths of both bring to the other one, over n_i/(A_i e_i) + n_j/(A_j e_j). The standard error is that of the
 * means of BATCHES batches. */
#ifndef BENCH_ROOM_H
#define BENCH_ROOM_H

#include <math.h>
#include <stdbool.h>

#include "bench.h"

enum { SPHERES_MAX = 300, WALLS_MAX = 6, BODIES_MAX = SPHERES_MAX + WALLS_MAX, BATCHES = 16, EVEN = 6 };

static const double pi = 3.14159265358979323846;

/* Bodies: the spheres, then the walls. A box has two walls across each axis. A cylinder about the z axis has two ends
 * and itself. */
struct room {
    double x[SPHERES_MAX], y[SPHERES_MAX], z[SPHERES_MAX], r[SPHERES_MAX];
    double size[3]; /* the box goes from 0 to size; a cylinder has the radius size[0] and the height size[2] */
    int spheres, walls, round;
    double emissivity[BODIES_MAX], temperature[BODIES_MAX];
};

struct truth {
    double power[BODIES_MAX], noise[BODIES_MAX];
};

/* ---- random numbers: xorshift64*, and Halton's points, shifted at random, for start and first direction of a path ---
 */
static inline double draw(uint64_t *state) {
    *state ^= *state >> 12;
    *state ^= *state << 25;
    *state ^= *state >> 27;
    return (double)((*state * 0x2545F4914F6CDD1Du) >> 11) * 0x1p-53;
}

struct numbers {
    uint64_t state;
    double shift[EVEN];
    long path;
    int drawn; /* in this path */
};

static inline double next(struct numbers *numbers) {
    static const long base[EVEN] = {2, 3, 5, 7, 11, 13};
    const int d = numbers->drawn++;
    if (d >= EVEN) return draw(&numbers->state);
    double x = numbers->shift[d], digit = 1. / (double)base[d];
    for (long k = numbers->path; k > 0; k /= base[d], digit /= (double)base[d]) x += (double)(k % base[d]) * digit;
    return x - floor(x);
}

static inline uint64_t seed_of(uint64_t a, uint64_t b) {
    uint64_t state = (a * 0x9E3779B97F4A7C15u) ^ (b * 0xBF58476D1CE4E5B9u) ^ 0x94D049BB133111EBu;
    for (int k = 0; k < 16; k++) draw(&state);
    return state;
}

/* ---- scenes ------------------------------------------------------------------------------------------------------ */
/* Kinds of scenes. Spheres have radii of 1 to `least`. The largest are put first, so that all find room. In a lattice
 * each sphere lies anywhere within its own cube of side 2. */
struct kind {
    const char *name;
    int round, spheres, lattice; /* lattice: spheres along an edge of the box; 0: none */
    double size;                 /* of the box, changed by up to a sixth; the radius of a cylinder is .65 of it */
    double least;
    int white;     /* number of walls of emissivity 0: the first ones */
    double dim[2]; /* emissivities of walls; 0: .15 to 1, as for spheres */
    int mesh;      /* squares along an edge of a wall that is a mesh; 0: walls are planes and cylinders */
};

static inline int fits(const struct room *room, int i, double gap) {
    const double r = room->r[i];
    if (room->round && hypot(room->x[i], room->y[i]) + r > room->size[0] - gap) return 0;
    for (int j = 0; j < i; j++) {
        const double dx = room->x[i] - room->x[j], dy = room->y[i] - room->y[j], dz = room->z[i] - room->z[j];
        if (sqrt(dx * dx + dy * dy + dz * dz) < r + room->r[j] + gap) return 0;
    }
    return 1;
}

/* A trial coordinate of sphere i along an axis. */
static inline double place(const struct room *room, int i, int axis, uint64_t *state) {
    const double low = room->round && axis < 2 ? -room->size[0] : 0;
    const double high = room->size[room->round && axis < 2 ? 0 : axis], r = room->r[i];
    return low + r + (high - low - 2 * r) * draw(state);
}

static inline double extent_of(const struct kind *kind, int axis, uint64_t *state) {
    if (kind->lattice > 0) return kind->size;
    return kind->size * ((kind->round && axis < 2 ? 3 : 5) + 2 * draw(state)) / 6;
}

static inline void make_room(struct room *room, const struct kind *kind, uint64_t seed) {
    uint64_t state = seed_of(seed, 1);
    const int spheres = kind->spheres;
    *room = (struct room){.spheres = spheres, .walls = kind->round ? 3 : 6, .round = kind->round};
    for (int axis = 0; axis < 3; axis++) room->size[axis] = extent_of(kind, axis, &state);
    for (int i = 0; i < spheres; i++) {
        double *const at[3] = {&room->x[i], &room->y[i], &room->z[i]};
        room->r[i] = 1 - (1 - kind->least) * (i + draw(&state)) / spheres;
        do {
            for (int axis = 0, k = i; axis < 3; axis++) {
                *at[axis] = place(room, i, axis, &state);
                if (kind->lattice == 0) continue;
                *at[axis] = 2 * (k % kind->lattice) + 1 + 2 * (1 - room->r[i]) * (draw(&state) - .5);
                k /= kind->lattice;
            }
        } while (kind->lattice == 0 && !fits(room, i, .01));
    }
    for (int b = 0; b < spheres + room->walls; b++) {
        const bool dim = b >= spheres && kind->dim[1] > 0;
        const double low = dim ? kind->dim[0] : .15, high = dim ? kind->dim[1] : 1;
        room->emissivity[b] = low + (high - low) * draw(&state);
        room->temperature[b] = .3 + (b < spheres ? .9 : 1.2) * draw(&state);
        if (b >= spheres && b < spheres + kind->white) room->emissivity[b] = 0;
    }
}

static inline double area_of(const struct room *room, int body) {
    const double *size = room->size;
    const int wall = body - room->spheres;
    if (wall < 0) return 4 * pi * room->r[body] * room->r[body];
    if (!room->round) return size[0] * size[1] * size[2] / size[wall / 2];
    return wall < 2 ? pi * size[0] * size[0] : 2 * pi * size[0] * size[2];
}

/* ---- paths ------------------------------------------------------------------------------------------------------- */
/* A direction of the cosine law about n: n and an even point of the unit sphere. */
static inline void leave(const double n[3], struct numbers *numbers, double w[3]) {
    double square;
    do {
        const double up = 2 * next(numbers) - 1, turn = 2 * pi * next(numbers), ring = sqrt(1 - up * up);
        w[0] = n[0] + ring * cos(turn), w[1] = n[1] + ring * sin(turn), w[2] = n[2] + up;
        square = w[0] * w[0] + w[1] * w[1] + w[2] * w[2];
    } while (square < 1e-20);
    for (int a = 0; a < 3; a++) w[a] /= sqrt(square);
}

/* A point that is spread evenly over a body, and the normal there. */
static inline void start(const struct room *room, int body, struct numbers *numbers, double o[3], double n[3]) {
    const int wall = body - room->spheres;
    const double turn = 2 * pi * next(numbers), share = next(numbers);
    n[0] = n[1] = n[2] = 0;
    if (wall < 0) {
        const double up = 2 * share - 1, ring = sqrt(1 - up * up), r = room->r[body];
        n[0] = ring * cos(turn), n[1] = ring * sin(turn), n[2] = up;
        o[0] = room->x[body] + r * n[0], o[1] = room->y[body] + r * n[1], o[2] = room->z[body] + r * n[2];
    } else if (room->round) {
        const double radius = wall == 2 ? room->size[0] : room->size[0] * sqrt(share);
        o[0] = radius * cos(turn), o[1] = radius * sin(turn), o[2] = room->size[2] * (wall == 2 ? share : wall);
        if (wall == 2)
            n[0] = -cos(turn), n[1] = -sin(turn);
        else
            n[2] = 1 - 2 * wall;
    } else {
        const int across = (wall / 2 + 1) % 3, along = (wall / 2 + 2) % 3;
        o[across] = room->size[across] * share, o[along] = room->size[along] * (turn / (2 * pi));
        o[wall / 2] = room->size[wall / 2] * (wall % 2);
        n[wall / 2] = 1 - 2 * (wall % 2);
    }
}

/* The wall that a ray from inside meets, and its distance. The wall `from` is not met again, unless it is round. */
static inline int wall_met(const struct room *room, int from, const double o[3], const double w[3], double *distance) {
    int met = -1;
    *distance = INFINITY;
    for (int axis = room->round ? 2 : 0; axis < 3; axis++) {
        const int wall = (room->round ? 0 : 2 * axis) + (w[axis] > 0);
        const double t = ((w[axis] > 0 ? room->size[axis] : 0) - o[axis]) / w[axis];
        if (w[axis] != 0 && room->spheres + wall != from && t < *distance) *distance = t, met = wall;
    }
    if (room->round) {
        const double a = w[0] * w[0] + w[1] * w[1], b = o[0] * w[0] + o[1] * w[1];
        const double c = o[0] * o[0] + o[1] * o[1] - room->size[0] * room->size[0];
        const double t = (sqrt(fmax(0, b * b - a * c)) - b) / a;
        if (a > 0 && t < *distance) *distance = t, met = 2;
    }
    return room->spheres + met;
}

/* The body that a ray meets. Moves o to the point and sets the normal. */
static inline int meet(const struct room *room, int from, double o[3], const double w[3], double n[3]) {
    double nearest;
    int body = wall_met(room, from, o, w, &nearest);
    for (int i = 0; i < room->spheres; i++) {
        const double c[3] = {o[0] - room->x[i], o[1] - room->y[i], o[2] - room->z[i]};
        const double b = c[0] * w[0] + c[1] * w[1] + c[2] * w[2];
        const double d = b * b - (c[0] * c[0] + c[1] * c[1] + c[2] * c[2] - room->r[i] * room->r[i]);
        if (i == from || b >= 0 || d <= 0) continue;
        if (-b - sqrt(d) < nearest) nearest = -b - sqrt(d), body = i;
    }
    const int wall = body - room->spheres;
    for (int a = 0; a < 3; a++) o[a] += nearest * w[a], n[a] = 0;
    if (wall < 0)
        n[0] = (o[0] - room->x[body]) / room->r[body], n[1] = (o[1] - room->y[body]) / room->r[body],
        n[2] = (o[2] - room->z[body]) / room->r[body];
    else if (room->round && wall == 2)
        n[0] = -o[0] / room->size[0], n[1] = -o[1] / room->size[0];
    else
        n[room->round ? 2 : wall / 2] = 1 - 2 * (wall % 2);
    return body;
}

/* Follows paths from one body. Adds to got[] what each body absorbs of them. */
static inline void follow(const struct room *room, int body, long paths, uint64_t seed, double *got) {
    struct numbers numbers = {.state = seed};
    for (int d = 0; d < EVEN; d++) numbers.shift[d] = draw(&numbers.state);
    for (numbers.path = 0; numbers.path < paths; numbers.path++) {
        double o[3], n[3], w[3], weight = 1;
        int at = body;
        numbers.drawn = 0;
        start(room, body, &numbers, o, n);
        while (weight > 0) {
            leave(n, &numbers, w);
            at = meet(room, at, o, w, n);
            got[at] += weight * room->emissivity[at];
            weight *= 1 - room->emissivity[at];
            if (weight < .2) weight = draw(&numbers.state) * .2 < weight ? .2 : 0;
        }
    }
}

static inline double emitting(const struct room *room, int body) {
    return area_of(room, body) * room->emissivity[body];
}

/* Walls exchange much, and their powers may nearly cancel. */
static inline long paths_of(const struct room *room, int body, long paths) {
    return body < room->spheres ? paths : 8 * paths;
}

static inline struct truth find_truth(const struct room *room, long paths, uint64_t seed) {
    const int bodies = room->spheres + room->walls;
    struct truth truth = {{0}, {0}};
    double square[BODIES_MAX] = {0};
    for (int batch = 0; batch < BATCHES; batch++) {
        static double got[BODIES_MAX][BODIES_MAX];
        memset(got, 0, sizeof got);
#pragma omp parallel for schedule(dynamic)
        for (int b = 0; b < bodies; b++)
            follow(room, b, paths_of(room, b, paths) / BATCHES, seed_of(seed, (uint64_t)(100 + batch * BODIES_MAX + b)),
                   got[b]);
        for (int i = 0; i < bodies; i++) {
            double power = 0;
            for (int j = 0; j < bodies; j++) {
                const double rays = (double)(paths_of(room, i, paths) / BATCHES) / emitting(room, i) +
                                    (double)(paths_of(room, j, paths) / BATCHES) / emitting(room, j);
                power += (got[i][j] + got[j][i]) / rays * (pow(room->temperature[j], 4) - pow(room->temperature[i], 4));
            }
            truth.power[i] += power / BATCHES;
            square[i] += power * power / BATCHES;
        }
    }
    for (int i = 0; i < bodies; i++)
        truth.noise[i] = sqrt(fmax(0, square[i] - truth.power[i] * truth.power[i]) / (BATCHES - 1));
    return truth;
}

#endif
