/* bench_walls.c - error of net powers of spheres among grey walls, against paths. SPDX-License-Identifier: MIT
 *
 * The arguments are `quick`, or [scenes [paths from each sphere [first scene]]]. Figures of docs/accuracy.md are by
 * bench_walls 16 400000. */
#include "room.h"

static const struct kind kinds[] = {
    {"box", 0, 34, 0, 6, .3, 0, {0, 0}, 0},
    {"box", 0, 34, 0, 6, .3, 0, {0, 0}, 0},
    {"box", 0, 34, 0, 6, .3, 0, {0, 0}, 0},
    {"cylinder", 1, 34, 0, 6, .3, 0, {0, 0}, 0},
    {"box", 0, 34, 0, 6, .3, 0, {0, 0}, 0},
    {"box", 0, 34, 0, 6, .3, 0, {0, 0}, 0},
    {"one", 0, 1, 0, 6, .5, 0, {0, 0}, 0},
    {"cylinder", 1, 34, 0, 6, .3, 0, {0, 0}, 0},
    {"one, far walls", 0, 1, 0, 24, .5, 0, {0, 0}, 0},
    {"one, cylinder", 1, 1, 0, 6, .5, 0, {0, 0}, 0},
    {"three", 0, 3, 0, 5, .5, 0, {0, 0}, 0},
    {"dilute", 0, 34, 0, 24, .3, 0, {0, 0}, 0},
    {"dilute, cylinder", 1, 34, 0, 24, .3, 0, {0, 0}, 0},
    {"dense", 0, 27, 3, 6, .85, 0, {0, 0}, 0},
    {"dense, large", 0, 216, 6, 12, .85, 0, {0, 0}, 0},
    {"white walls", 0, 34, 0, 6, .3, 3, {0, 0}, 0},
};
enum { KINDS = sizeof kinds / sizeof *kinds };

/* ---- comparison -------------------------------------------------------------------------------------------------- */
struct answer {
    double power[BODIES_MAX], error[BODIES_MAX], seconds;
    fibrad_heat_result result;
};

static struct answer solve(const struct room *room, const fibrad_heat_config *config) {
    const fibrad_spheres spheres = {
        .x = room->x, .y = room->y, .z = room->z, .r = room->r, .n = (uint32_t)room->spheres};
    fibrad_wall body[WALLS_MAX] = {{0}};
    for (int wall = 0; wall < room->walls; wall++) {
        const int axis = room->round ? 2 : wall / 2;
        body[wall].kind = FIBRAD_WALL_PLANE;
        body[wall].plane.axis = axis, body[wall].plane.upper = wall % 2;
        body[wall].plane.at = wall % 2 ? room->size[axis] : 0;
    }
    if (room->round)
        body[2].kind = FIBRAD_WALL_CYLINDER, body[2].cylinder = (fibrad_cylinder){.radius = room->size[0], .along = 2};
    const fibrad_scene_config scene = {.wall = body, .walls = (uint32_t)room->walls};
    fibrad_heat_sources sources;
    fibrad_heat_sources_init(&sources);
    sources.temperature = room->temperature, sources.emissivity = room->emissivity;
    sources.wall_temperature = room->temperature + room->spheres;
    sources.wall_emissivity = room->emissivity + room->spheres;
    sources.surroundings = 0, sources.sigma = 1, sources.tolerance = 1e-6;
    fibrad_run run = {.threads = 1};
    fibrad_bed *made;
    struct answer answer = {.seconds = 0};
    const double begun = bench_thread_seconds();
    answer.result.power = answer.power, answer.result.wall_power = answer.power + room->spheres;
    answer.result.power_error = answer.error, answer.result.wall_error = answer.error + room->spheres;
    bench_check("bed", fibrad_bed_new(&made, &scene, &spheres, &run));
    bench_check("beams", fibrad_bed_beams(made, config));
    bench_check("solve", fibrad_bed_solve(made, &sources, NULL, &answer.result));
    fibrad_bed_free(made);
    answer.seconds = bench_thread_seconds() - begun;
    return answer;
}

/* The largest ratio of v[wall] to the larger of the wall's power and 5 % of what the wall absorbs. */
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

/* Collects estimates over true errors of all bodies of a scene. Counts the bodies whose error, less twice the noise of
 * the true power, is more than twice the estimate. */
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
        {168, 64, 96, 0, 0}, {672, 64, 96, 0, 0}, {2688, 64, 384, 0, 0}, {8000, 64, 384, 0, 0}};
    enum { CONFIGS = sizeof configs / sizeof *configs };
    static struct honesty all[CONFIGS];
    const int quick = argc > 1 && strcmp(argv[1], "quick") == 0, given = argc > 1 && !quick;
    const int scenes = quick ? 1 : given ? atoi(argv[1]) : KINDS, first = argc > 3 ? atoi(argv[3]) : 0;
    const long paths = quick ? 20000 : given && argc > 2 ? atol(argv[2]) : 100000;
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
