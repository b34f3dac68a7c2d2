/* bench_walls.c - error of net powers among spheres and grey walls against paths. SPDX-License-Identifier: MIT
 *
 * Random scenes of unequal grey spheres between six grey walls, or in a cylinder with two ends. The truth follows paths
 * one by one, with geometry and random numbers of its own: from body i, of area A and emissivity e, n_i paths, each
 * surface absorbing its share of their weight. What i and j exchange is what the paths of both bring to the other
 * over n_i/(A_i e_i) + n_j/(A_j e_j); the standard error is that of BATCHES means.
 * Arguments: `quick`, or [scenes [paths from each sphere [first scene]]]. */
#include <math.h>

#include "bench.h"

enum { SPHERES_MAX = 216, WALLS_MAX = 6, BODIES_MAX = SPHERES_MAX + WALLS_MAX, BATCHES = 16, EVEN = 6 };

static const double pi = 3.14159265358979323846;

/* Spheres, then walls: of a box two across each axis, of a cylinder about the z axis two ends and itself. */
struct room {
    double x[SPHERES_MAX], y[SPHERES_MAX], z[SPHERES_MAX], r[SPHERES_MAX];
    double size[3]; /* the box from 0 to size; a cylinder has the radius size[0] and the height size[2] */
    int spheres, walls, round;
    double emissivity[BODIES_MAX], temperature[BODIES_MAX];
};

struct truth {
    double power[BODIES_MAX], noise[BODIES_MAX];
};

/* ---- random numbers: xorshift64*, and Halton's points, shifted at random, for where a path starts and first goes ---
 */
static double draw(uint64_t *state) {
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

static double next(struct numbers *numbers) {
    static const long base[EVEN] = {2, 3, 5, 7, 11, 13};
    const int d = numbers->drawn++;
    if (d >= EVEN) return draw(&numbers->state);
    double x = numbers->shift[d], digit = 1. / (double)base[d];
    for (long k = numbers->path; k > 0; k /= base[d], digit /= (double)base[d]) x += (double)(k % base[d]) * digit;
    return x - floor(x);
}

static uint64_t seed_of(uint64_t a, uint64_t b) {
    uint64_t state = (a * 0x9E3779B97F4A7C15u) ^ (b * 0xBF58476D1CE4E5B9u) ^ 0x94D049BB133111EBu;
    for (int k = 0; k < 16; k++) draw(&state);
    return state;
}

/* ---- scenes ------------------------------------------------------------------------------------------------------ */
static int fits(const struct room *room, int i, double gap) {
    const double r = room->r[i];
    if (room->round && hypot(room->x[i], room->y[i]) + r > room->size[0] - gap) return 0;
    for (int j = 0; j < i; j++) {
        const double dx = room->x[i] - room->x[j], dy = room->y[i] - room->y[j], dz = room->z[i] - room->z[j];
        if (sqrt(dx * dx + dy * dy + dz * dz) < r + room->r[j] + gap) return 0;
    }
    return 1;
}

/* Where sphere i might be along an axis. */
static double place(const struct room *room, int i, int axis, uint64_t *state) {
    const double low = room->round && axis < 2 ? -room->size[0] : 0;
    const double high = room->size[room->round && axis < 2 ? 0 : axis], r = room->r[i];
    return low + r + (high - low - 2 * r) * draw(state);
}

/* Kinds of scenes. Spheres have radii of 1 to `least`, the largest first, so that all find room; in a lattice each has
 * a cube of side 2 to itself, within which it may lie anywhere. */
struct kind {
    const char *name;
    int round, spheres, lattice; /* lattice: spheres along an edge of the box; 0: none */
    double size;                 /* of the box, give or take a sixth; of a cylinder .65 of that is the radius */
    double least;
    int white; /* walls of emissivity 0, from the first on */
};
static const struct kind kinds[] = {
    {"box", 0, 34, 0, 6, .3, 0},
    {"box", 0, 34, 0, 6, .3, 0},
    {"box", 0, 34, 0, 6, .3, 0},
    {"cylinder", 1, 34, 0, 6, .3, 0},
    {"box", 0, 34, 0, 6, .3, 0},
    {"box", 0, 34, 0, 6, .3, 0},
    {"one", 0, 1, 0, 6, .5, 0},
    {"cylinder", 1, 34, 0, 6, .3, 0},
    {"one, far walls", 0, 1, 0, 24, .5, 0},
    {"one, cylinder", 1, 1, 0, 6, .5, 0},
    {"three", 0, 3, 0, 5, .5, 0},
    {"dilute", 0, 34, 0, 24, .3, 0},
    {"dilute, cylinder", 1, 34, 0, 24, .3, 0},
    {"dense", 0, 27, 3, 6, .85, 0},
    {"dense, large", 0, 216, 6, 12, .85, 0},
    {"white walls", 0, 34, 0, 6, .3, 3},
};
enum { KINDS = sizeof kinds / sizeof *kinds };

static double extent_of(const struct kind *kind, int axis, uint64_t *state) {
    if (kind->lattice > 0) return kind->size;
    return kind->size * ((kind->round && axis < 2 ? 3 : 5) + 2 * draw(state)) / 6;
}

static void make_room(struct room *room, const struct kind *kind, uint64_t seed) {
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
        room->emissivity[b] = .15 + .85 * draw(&state);
        room->temperature[b] = .3 + (b < spheres ? .9 : 1.2) * draw(&state);
        if (b >= spheres && b < spheres + kind->white) room->emissivity[b] = 0;
    }
}

static double area_of(const struct room *room, int body) {
    const double *size = room->size;
    const int wall = body - room->spheres;
    if (wall < 0) return 4 * pi * room->r[body] * room->r[body];
    if (!room->round) return size[0] * size[1] * size[2] / size[wall / 2];
    return wall < 2 ? pi * size[0] * size[0] : 2 * pi * size[0] * size[2];
}

/* ---- paths ------------------------------------------------------------------------------------------------------- */
/* A direction of the cosine law about n: n and an even point of the unit sphere. */
static void leave(const double n[3], struct numbers *numbers, double w[3]) {
    double square;
    do {
        const double up = 2 * next(numbers) - 1, turn = 2 * pi * next(numbers), ring = sqrt(1 - up * up);
        w[0] = n[0] + ring * cos(turn), w[1] = n[1] + ring * sin(turn), w[2] = n[2] + up;
        square = w[0] * w[0] + w[1] * w[1] + w[2] * w[2];
    } while (square < 1e-20);
    for (int a = 0; a < 3; a++) w[a] /= sqrt(square);
}

/* An even point on a body, and the normal there. */
static void start(const struct room *room, int body, struct numbers *numbers, double o[3], double n[3]) {
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

/* The wall that a ray from inside meets, and how far away. The wall `from` is not met again, unless it is round. */
static int wall_met(const struct room *room, int from, const double o[3], const double w[3], double *distance) {
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

/* The body that a ray meets; moves o there and sets the normal. */
static int meet(const struct room *room, int from, double o[3], const double w[3], double n[3]) {
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

/* Adds to got[] what the bodies absorb of paths from one of them. */
static void follow(const struct room *room, int body, long paths, uint64_t seed, double *got) {
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

static double emitting(const struct room *room, int body) { return area_of(room, body) * room->emissivity[body]; }

/* Walls exchange much, and their powers may nearly cancel. */
static long paths_of(const struct room *room, int body, long paths) { return body < room->spheres ? paths : 8 * paths; }

static struct truth find_truth(const struct room *room, long paths, uint64_t seed) {
    const int bodies = room->spheres + room->walls;
    struct truth truth = {{0}, {0}};
    double square[BODIES_MAX] = {0};
    for (int batch = 0; batch < BATCHES; batch++) {
        double got[BODIES_MAX][BODIES_MAX] = {{0}};
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

/* ---- comparison -------------------------------------------------------------------------------------------------- */
struct answer {
    double power[BODIES_MAX], error[BODIES_MAX], seconds;
    fibrad_heat_result result;
};

static struct answer solve(const struct room *room, const fibrad_heat_config *config) {
    const fibrad_spheres spheres = {
        .x = room->x, .y = room->y, .z = room->z, .r = room->r, .n = (uint32_t)room->spheres};
    fibrad_body body[WALLS_MAX] = {{0}};
    for (int wall = 0; wall < room->walls; wall++) {
        const int axis = room->round ? 2 : wall / 2;
        body[wall].kind = FIBRAD_BODY_PLANE;
        body[wall].plane.axis = axis, body[wall].plane.upper = wall % 2;
        body[wall].plane.at = wall % 2 ? room->size[axis] : 0;
    }
    if (room->round) body[2].kind = FIBRAD_BODY_CYLINDER, body[2].cylinder.radius = room->size[0];
    const fibrad_scene_config scene = {.body = body, .bodies = (uint32_t)room->walls};
    fibrad_heat_sources sources;
    fibrad_heat_sources_init(&sources);
    sources.temperature = room->temperature, sources.emissivity = room->emissivity;
    sources.body_temperature = room->temperature + room->spheres;
    sources.body_emissivity = room->emissivity + room->spheres;
    sources.surroundings = 0, sources.sigma = 1, sources.tolerance = 1e-6;
    fibrad_run run = {.threads = 1};
    fibrad_radiation *radiation;
    struct answer answer = {.seconds = 0};
    const double begun = bench_thread_seconds();
    answer.result.power = answer.power, answer.result.body_power = answer.power + room->spheres;
    answer.result.power_error = answer.error, answer.result.body_error = answer.error + room->spheres;
    bench_check("radiation", fibrad_radiation_new(&radiation, &scene, &spheres, config, &run));
    bench_check("solve", fibrad_radiation_solve(radiation, &sources, &answer.result));
    fibrad_radiation_free(radiation);
    answer.seconds = bench_thread_seconds() - begun;
    return answer;
}

/* Worst ratio over the walls of v[wall] to the larger of their power and 5 % of what they absorb. */
static double worst_wall(const struct room *room, const struct truth *truth, const double *v) {
    double worst = 0;
    for (int b = room->spheres; b < room->spheres + room->walls; b++) {
        const double emitted = area_of(room, b) * room->emissivity[b] * pow(room->temperature[b], 4);
        worst = fmax(worst, fabs(v[b]) / fmax(fabs(truth->power[b]), .05 * (emitted + truth->power[b])));
    }
    return worst;
}

static double rms(const double *v, int n) {
    double sum = 0;
    for (int i = 0; i < n; i++) sum += v[i] * v[i];
    return sqrt(sum / n);
}

static int in_order(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Estimates over true errors of all bodies of a scene, and how many of those are below one half: too low to be told
 * from noise are errors below twice the truth's. */
struct honesty {
    double ratio[KINDS * BODIES_MAX];
    int bodies, low;
};

static void judge(struct honesty *honesty, const struct answer *answer, const struct truth *truth, int bodies) {
    for (int b = 0; b < bodies; b++) {
        const double error = fabs(answer->power[b] - truth->power[b]), sure = fmax(0, error - 2 * truth->noise[b]);
        if (answer->error[b] == 0 && error <= 2 * truth->noise[b]) continue;
        honesty->low += sure > 2 * answer->error[b];
        honesty->ratio[honesty->bodies++] = answer->error[b] / hypot(error, .1 * truth->noise[b]);
    }
}

static double median(struct honesty *honesty) {
    qsort(honesty->ratio, (size_t)honesty->bodies, sizeof *honesty->ratio, in_order);
    return honesty->bodies > 0 ? honesty->ratio[honesty->bodies / 2] : 0;
}

static void compare(int scene, const struct room *room, const struct truth *truth, const fibrad_heat_config *config,
                    struct honesty *all) {
    const struct answer answer = solve(room, config);
    const int bodies = room->spheres + room->walls;
    const double size = rms(truth->power, room->spheres);
    double error[BODIES_MAX];
    static struct honesty here;
    here.bodies = here.low = 0;
    for (int b = 0; b < bodies; b++) error[b] = answer.power[b] - truth->power[b];
    judge(&here, &answer, truth, bodies);
    judge(all, &answer, truth, bodies);
    printf("%d,%s,%d,%u,%u,%u,%.2e,%.2e,%.2e,%.2e,%.2e,%.2e,%d,%d,%.2f,%.3f\n", scene, kinds[scene % KINDS].name,
           room->spheres, config->directions, config->points, config->patches, rms(error, room->spheres) / size,
           hypot(answer.result.error_patches, answer.result.error_beams) / size,
           rms(truth->noise, room->spheres) / size, worst_wall(room, truth, error),
           worst_wall(room, truth, answer.error), worst_wall(room, truth, truth->noise), here.low, here.bodies,
           median(&here), answer.seconds);
    fflush(stdout);
}

int main(int argc, char **argv) {
    static const fibrad_heat_config configs[] = {
        {168, 64, 96, 0, 0, 0}, {672, 64, 96, 0, 0, 0}, {2688, 64, 384, 0, 0, 0}, {8000, 64, 384, 0, 0, 0}};
    enum { CONFIGS = sizeof configs / sizeof *configs };
    static struct honesty all[CONFIGS];
    const int quick = argc > 1 && strcmp(argv[1], "quick") == 0, given = argc > 1 && !quick;
    const int scenes = quick ? 1 : given ? atoi(argv[1]) : KINDS, first = argc > 3 ? atoi(argv[3]) : 0;
    const long paths = quick ? 20000 : given && argc > 2 ? atol(argv[2]) : 400000;
    bench_preamble(
        "net powers with walls: errors over the spheres' root mean square power, and of the worst wall over "
        "the larger of its power and 5 % of what it absorbs; bodies whose error is above twice its estimate, "
        "and the median of estimate over error; processor seconds of one thread",
        1);
    puts("scene,kind,spheres,directions,points,patches,error,estimate,noise,wall_error,wall_estimate,wall_noise,low,"
         "bodies,median,seconds");
    for (int scene = first; scene < first + scenes; scene++) {
        static struct room room;
        make_room(&room, &kinds[scene % KINDS], (uint64_t)scene);
        const struct truth truth = find_truth(&room, paths, (uint64_t)scene);
        for (int k = 0; k < (quick ? 1 : CONFIGS); k++) compare(scene, &room, &truth, &configs[k], &all[k]);
    }
    for (int k = 0; k < (quick ? 1 : CONFIGS); k++)
        printf(
            "# %u directions, %u patches: %d of %d bodies err by more than twice the estimate; median of estimate over "
            "error %.2f\n",
            configs[k].directions, configs[k].patches, all[k].low, all[k].bodies, median(&all[k]));
    return 0;
}
