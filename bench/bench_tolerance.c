/* bench_tolerance.c - how long `fibrad heat --error` takes among walls, and whether the error is kept.
 * SPDX-License-Identifier: MIT
 *
 * Scenes of 10 to 300 spheres in boxes, cylinders and meshes go to the program as files, with an error. The powers of
 * the program are compared with those by paths. Errors of spheres are root mean squares over the root mean square of
 * their powers. The error of a wall is divided by the larger of its power and what it absorbs. When an error is
 * compared with twice its estimate, twice the noise of the paths is subtracted first.
 *
 * The arguments are `quick`, or [scenes [paths from each sphere [first scene [error]]]]. Figures of docs/trust.md are
 * by bench_tolerance 14 200000. The environment may have FIBRAD, the program [build/fibrad], and TRUTH, a folder that
 * keeps the powers by paths [none]. */
#define _POSIX_C_SOURCE 200809L
#include "room.h"

#include <sys/resource.h>
#include <unistd.h>

static const struct kind kinds[] = {
    {"box", 0, 34, 0, 6, .3, 0, {0, 0}, 0},          {"cylinder", 1, 34, 0, 6, .3, 0, {0, 0}, 0},
    {"few", 0, 10, 0, 6, .5, 0, {0, 0}, 0},          {"few, cylinder", 1, 10, 0, 6, .5, 0, {0, 0}, 0},
    {"dilute", 0, 34, 0, 24, .3, 0, {0, 0}, 0},      {"dilute, dim walls", 0, 300, 0, 40, .3, 0, {.1, .3}, 0},
    {"dense", 0, 27, 3, 6, .85, 0, {0, 0}, 0},       {"dense, large", 0, 216, 6, 12, .85, 0, {0, 0}, 0},
    {"white walls", 0, 34, 0, 6, .3, 3, {0, 0}, 0},  {"large cylinder", 1, 150, 0, 12, .5, 0, {0, 0}, 0},
    {"mesh", 0, 34, 0, 6, .3, 0, {0, 0}, 1},         {"fine mesh", 0, 100, 0, 9, .4, 0, {0, 0}, 10},
    {"few, mesh", 0, 10, 0, 12, .5, 0, {.1, .5}, 3}, {"dim cylinder", 1, 60, 0, 12, .3, 0, {.1, .3}, 0},
};
enum { KINDS = sizeof kinds / sizeof *kinds };

static const char *const box_walls[] = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"};
static const char *const mesh_walls[] = {"west", "east", "south", "north", "bottom", "top"};
static const char *const round_walls[] = {"zmin", "zmax", "cylinder"};

static const char *wall_name_of(const struct room *room, const struct kind *kind, int wall) {
    return room->round ? round_walls[wall] : kind->mesh ? mesh_walls[wall] : box_walls[wall];
}

static FILE *make_file(const char *folder, const char *name, const char *mode) {
    char path[400];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, mode);
    if (!file && *mode == 'w') perror(path), exit(1);
    return file;
}

static void write_spheres(const char *folder, const struct room *room) {
    FILE *file = make_file(folder, "bed.csv", "w");
    fputs("x,y,z,r,e,T\n", file);
    for (int i = 0; i < room->spheres; i++)
        fprintf(file, "%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", room->x[i], room->y[i], room->z[i], room->r[i],
                room->emissivity[i], 1000 * room->temperature[i]);
    fclose(file);
}

/* Writes a wall of a box as squares of two triangles. Their fronts are inside. */
static void write_wall(const char *folder, const struct room *room, const char *name, int wall, int squares) {
    char path[40];
    snprintf(path, sizeof path, "%s.stl", name);
    FILE *file = make_file(folder, path, "w");
    const int axis = wall / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    static const int corner[2][6] = {{0, 1, 3, 0, 3, 2}, {0, 3, 1, 0, 2, 3}};
    fprintf(file, "solid %s\n", name);
    for (int k = 0; k < 6 * squares * squares; k++) {
        const int at = corner[wall % 2][k % 6], square = k / 6;
        double p[3];
        p[axis] = wall % 2 ? room->size[axis] : 0;
        p[u] = room->size[u] * (square % squares + at % 2) / squares;
        p[v] = room->size[v] * (square / squares + at / 2) / squares;
        if (k % 3 == 0) fputs("facet normal 0 0 0\nouter loop\n", file);
        fprintf(file, "vertex %.17g %.17g %.17g\n", p[0], p[1], p[2]);
        if (k % 3 == 2) fputs("endloop\nendfacet\n", file);
    }
    fprintf(file, "endsolid %s\n", name);
    fclose(file);
}

/* What the options say of a wall. */
static void write_place(FILE *command, const struct room *room, const struct kind *kind, int wall, const char *folder) {
    const char *name = wall_name_of(room, kind, wall);
    if (room->round && wall == 2)
        fprintf(command, "cylinder:0,0,%.17g", room->size[0]);
    else if (kind->mesh)
        fprintf(command, "mesh:%s/%s.stl", folder, name);
    else
        fprintf(command, "%s:at=%.17g", name, wall % 2 ? room->size[room->round ? 2 : wall / 2] : 0);
}

static void write_command(char *text, size_t size, const char *folder, const struct room *room, const struct kind *kind,
                          double error) {
    const char *program = getenv("FIBRAD");
    FILE *command = fmemopen(text, size, "w");
    fprintf(
        command,
        "%s heat %s/bed.csv --length-unit m --emissivity e --temperature T --ambient 0 --error %g --json %s/run.json "
        "-o %s/q.csv --wall ",
        program ? program : "build/fibrad", folder, error, folder, folder);
    for (int wall = 0; wall < room->walls; wall++) {
        if (wall > 0) putc(',', command);
        write_place(command, room, kind, wall, folder);
        fprintf(command, ":temperature=%.17g:emissivity=%.17g", 1000 * room->temperature[room->spheres + wall],
                room->emissivity[room->spheres + wall]);
    }
    fprintf(command, " --quiet 2>%s/messages", folder); /* warnings of walls that are open meshes */
    fclose(command);
}

struct answer {
    double power[BODIES_MAX], error[BODIES_MAX], seconds, processor;
    double directions, patches;
};

/* Reads the powers of spheres and walls from the .csv. Walls are i = -2, -3 ... */
static void read_powers(const char *folder, const struct room *room, struct answer *answer) {
    const double unit = FIBRAD_STEFAN_BOLTZMANN * 1e12;
    char line[400];
    FILE *file = make_file(folder, "q.csv", "r");
    while (file && fgets(line, sizeof line, file)) {
        char *at = line, *field[4] = {0};
        for (int k = 0; k < 4 && at; k++) {
            field[k] = at;
            at = strchr(at, ',');
            if (at) *at++ = 0;
        }
        const long i = strtol(line, &at, 10);
        if (at == line || !field[3] || i == -1) continue;
        const long b = i >= 0 ? i : room->spheres - 2 - i;
        answer->power[b] = atof(field[2]) / unit, answer->error[b] = atof(field[3]) / unit;
    }
    if (file) fclose(file);
}

/* A number of the summary. */
static double summary_of(const char *folder, const char *key) {
    char text[20000], quoted[60];
    FILE *file = make_file(folder, "run.json", "r");
    if (!file) return NAN;
    text[fread(text, 1, sizeof text - 1, file)] = 0;
    fclose(file);
    snprintf(quoted, sizeof quoted, "\"%s\": ", key);
    const char *at = strstr(text, quoted);
    return at ? atof(at + strlen(quoted)) : NAN;
}

static double clock_of(clockid_t clock) {
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static double children(void) {
    struct rusage usage;
    getrusage(RUSAGE_CHILDREN, &usage);
    return (double)usage.ru_utime.tv_sec + 1e-6 * (double)usage.ru_utime.tv_usec;
}

static struct answer solve(const struct room *room, const struct kind *kind, double error) {
    static char command[8000];
    char folder[] = "/tmp/tolerance.XXXXXX";
    struct answer answer = {.seconds = 0};
    if (!mkdtemp(folder)) perror(folder), exit(1);
    write_spheres(folder, room);
    for (int wall = 0; kind->mesh && wall < room->walls; wall++)
        write_wall(folder, room, wall_name_of(room, kind, wall), wall, kind->mesh);
    write_command(command, sizeof command, folder, room, kind, error);
    const double begun = clock_of(CLOCK_MONOTONIC), worked = children();
    if (system(command) != 0) fprintf(stderr, "bench: %s\n", command), exit(1);
    answer.seconds = clock_of(CLOCK_MONOTONIC) - begun, answer.processor = children() - worked;
    read_powers(folder, room, &answer);
    answer.directions = summary_of(folder, "directions"), answer.patches = summary_of(folder, "patches");
    snprintf(command, sizeof command, "rm -r %s", folder);
    if (system(command) != 0) exit(1);
    return answer;
}

static double rms(const double *v, int n) {
    double sum = 0;
    for (int i = 0; i < n; i++) sum += v[i] * v[i];
    return sqrt(sum / n);
}

/* The largest ratio of v of a wall to the larger of its power and what it absorbs. */
static double worst_wall(const struct room *room, const struct truth *truth, const double *v) {
    double worst = 0;
    for (int b = room->spheres; b < room->spheres + room->walls; b++) {
        const double emitted = area_of(room, b) * room->emissivity[b] * pow(room->temperature[b], 4);
        const double size = fmax(fabs(truth->power[b]), emitted + truth->power[b]);
        if (size > 0) worst = fmax(worst, fabs(v[b]) / size);
    }
    return worst;
}

/* The number of bodies [from, to) whose errors are more than twice their estimates. */
static int low_estimates(const struct answer *answer, const struct truth *truth, int from, int to) {
    int low = 0;
    for (int b = from; b < to; b++)
        low += fabs(answer->power[b] - truth->power[b]) - 2 * truth->noise[b] > 2 * answer->error[b];
    return low;
}

static struct truth truth_of(const struct room *room, int scene, long paths) {
    const char *folder = getenv("TRUTH");
    char name[60];
    static struct truth truth;
    snprintf(name, sizeof name, "truth-%d-%ld", scene, paths);
    FILE *file = folder ? make_file(folder, name, "r") : NULL;
    if (file && fread(&truth, sizeof truth, 1, file) == 1) return fclose(file), truth;
    truth = find_truth(room, paths, (uint64_t)scene);
    file = folder ? make_file(folder, name, "w") : NULL;
    if (file) fwrite(&truth, sizeof truth, 1, file), fclose(file);
    return truth;
}

static void compare(int scene, const struct room *room, const struct truth *truth, double wanted) {
    const struct kind *kind = &kinds[scene % KINDS];
    const struct answer answer = solve(room, kind, wanted);
    const int spheres = room->spheres, bodies = spheres + room->walls;
    const double size = rms(truth->power, spheres);
    double error[BODIES_MAX];
    for (int b = 0; b < bodies; b++) error[b] = answer.power[b] - truth->power[b];
    const double all = rms(error, spheres) / size, noise = rms(truth->noise, spheres) / size;
    printf("%d,\"%s\",%d,%g,%.0f,%.0f,%.2e,%.2e,%.2e,%.2e,%.2e,%.2e,%d,%d,%.2f,%.2f\n", scene, kind->name, spheres,
           wanted, answer.directions, answer.patches, sqrt(fmax(0, all * all - noise * noise)),
           rms(answer.error, spheres) / size, noise, worst_wall(room, truth, error),
           worst_wall(room, truth, answer.error), worst_wall(room, truth, truth->noise),
           low_estimates(&answer, truth, 0, spheres), low_estimates(&answer, truth, spheres, bodies), answer.seconds,
           answer.processor);
    fflush(stdout);
}

int main(int argc, char **argv) {
    const int quick = argc > 1 && strcmp(argv[1], "quick") == 0, given = argc > 1 && !quick;
    const int scenes = quick ? 1 : given ? atoi(argv[1]) : KINDS, first = argc > 3 ? atoi(argv[3]) : 0;
    const long paths = quick ? 20000 : given && argc > 2 ? atol(argv[2]) : 50000;
    const double wanted = quick ? .02 : argc > 4 ? atof(argv[4]) : .002;
    bench_preamble("fibrad heat --error with walls: errors of spheres over their root mean square power, and of the "
                   "worst wall over the larger of its power and what it absorbs; spheres and walls whose error is "
                   "above twice the estimate; seconds by the clock and of the processor",
                   2);
    puts("scene,kind,spheres,wanted,directions,patches,error,estimate,noise,wall_error,wall_estimate,wall_noise,"
         "low_spheres,low_walls,seconds,processor");
    for (int scene = first; scene < first + scenes; scene++) {
        static struct room room;
        make_room(&room, &kinds[scene % KINDS], (uint64_t)scene);
        const struct truth truth = truth_of(&room, scene, paths);
        compare(scene, &room, &truth, wanted);
    }
    return 0;
}
