/* bench_mesh.c - time and error of walls of triangles, against planes, a cylinder and closed forms.
 * SPDX-License-Identifier: MIT
 *
 *     bench_mesh [quick | BED]
 *
 * The bench writes CSV to standard output. It runs on one thread, with exact areas where no points are named.
 *
 * Times are those of a bed (20,000 spheres, solid fraction 0.58) between six planes, between the same walls as 100,000
 * triangles, and open. They are processor times of rows of 100 directions: the least of several rounds, in which all
 * take turns. One line has every tenth row. Another line has only those of these rows that see no wall.
 *
 * Errors are root mean squares over rows. A triangle beside a sphere has its solid angle as its true factor. A box of
 * 12 triangles and a cylinder of 2,000 facets are compared with planes and a cylinder in many directions. */
#include "bed/packing.h"
#include "bench_triangles.h"
#include "read/read.h"

enum { CAPACITY = 20000, ROUNDS = 3, WALLS = 6, SETTINGS = 7 };

static const double pi = 3.14159265358979323846;

/* A row with room for factors to walls. */
static fibrad_row row_in(uint32_t capacity) {
    fibrad_row row = bench_arrays(capacity);
    row.wall = bench_array(WALLS, sizeof *row.wall);
    return row;
}

static void free_row(fibrad_row *row) { free(row->col), free(row->f), free(row->wall); }

static void find_ends(const struct bed *bed, double low[3], double high[3]) {
    const double *at[3] = {bed->x, bed->y, bed->z};
    for (int axis = 0; axis < 3; ++axis) {
        low[axis] = INFINITY, high[axis] = -INFINITY;
        for (uint32_t i = 0; i < bed->n; ++i) {
            low[axis] = fmin(low[axis], at[axis][i] - bed->r[i]);
            high[axis] = fmax(high[axis], at[axis][i] + bed->r[i]);
        }
    }
}

/* ---- time -------------------------------------------------------------------------------------------------------- */
enum { OPEN, PLANES, TRIANGLES, SCENES };

/* Lists the rows that see no wall first. Returns their number. */
static uint32_t find_deep(const fibrad_scene *scene, fibrad_work *work, fibrad_row *row, uint32_t n, uint32_t step,
                          uint32_t *list) {
    const fibrad_beam_rule rule = {.directions = 100};
    uint32_t deep = 0;
    for (uint32_t i = 0; i < n; i += step) {
        double walls = 0;
        bench_check("row", fibrad_beam_row(scene, work, i, &rule, row));
        for (int b = 0; b < WALLS; ++b) walls += row->wall[b];
        if (walls == 0) list[deep++] = i;
    }
    return deep;
}

static double rows_seconds(const fibrad_scene *scene, fibrad_work *work, fibrad_row *row, const uint32_t *list,
                           uint32_t count) {
    const fibrad_beam_rule rule = {.directions = 100};
    const double begun = bench_thread_seconds();
    for (uint32_t k = 0; k < count; ++k) bench_check("row", fibrad_beam_row(scene, work, list[k], &rule, row));
    return bench_thread_seconds() - begun;
}

static void time_rows(fibrad_scene *const scene[SCENES], const char *rows, const uint32_t *list, uint32_t count,
                      int rounds) {
    static const char *const names[SCENES] = {"open", "planes", "triangles"};
    double best[SCENES] = {INFINITY, INFINITY, INFINITY};
    fibrad_work work = BENCH_GROWING;
    fibrad_row row = row_in(CAPACITY);
    for (int round = 0; round < rounds; ++round)
        for (int s = 0; s < SCENES; ++s) best[s] = fmin(best[s], rows_seconds(scene[s], &work, &row, list, count));
    for (int s = 0; s < SCENES && count > 0; ++s)
        printf("%s,%u,%s,%.2f,%.3f,%.3f\n", rows, count, names[s], 1e6 * best[s] / count, best[s] / best[PLANES],
               best[s] / best[OPEN]);
    free(work.memory.block);
    free_row(&row);
}

static void bench_time(const struct bed *bed, bool quick) {
    double low[3], high[3];
    fibrad_wall plane[WALLS], mesh[WALLS];
    fibrad_scene *scene[SCENES];
    void *block[SCENES];
    fibrad_work work = BENCH_GROWING;
    fibrad_row row = row_in(CAPACITY);
    const uint32_t cells = quick ? 9 : 91, step = quick ? 5 : 10;
    uint32_t *list = bench_array(bed->n, sizeof *list), count = 0;
    struct bench_triangles triangles = bench_triangles_new(12 * cells * cells);
    find_ends(bed, low, high);
    bench_planes(plane, low, high);
    bench_box(&triangles, low, high, cells);
    for (int b = 0; b < WALLS; ++b) mesh[b] = (fibrad_wall){.kind = FIBRAD_WALL_MESH};
    scene[OPEN] = bench_scene_in(bed, NULL, 0, NULL, &block[OPEN]);
    scene[PLANES] = bench_scene_in(bed, plane, WALLS, NULL, &block[PLANES]);
    const double begun = bench_thread_seconds();
    scene[TRIANGLES] = bench_scene_in(bed, mesh, WALLS, &triangles, &block[TRIANGLES]);
    printf("# %u spheres, %u triangles; their scene: %.3f s\n", bed->n, triangles.list.n,
           bench_thread_seconds() - begun);
    puts("rows,number,walls,us_per_row,over_planes,over_open");
    for (uint32_t i = 0; i < bed->n; i += step) list[count++] = i;
    time_rows(scene, "all", list, count, quick ? 1 : ROUNDS);
    count = find_deep(scene[TRIANGLES], &work, &row, bed->n, step, list);
    time_rows(scene, "no wall seen", list, count, quick ? 1 : ROUNDS);
    for (int s = 0; s < SCENES; ++s) free(block[s]);
    free(work.memory.block);
    free_row(&row);
    free(list);
    bench_triangles_free(&triangles);
}

/* ---- errors ------------------------------------------------------------------------------------------------------ */
static const uint32_t settings[SETTINGS] = {50, 100, 233, 500, 1000, 2000, 4000}, kinds[] = {0, 64, 128, 256};
enum { KINDS = sizeof kinds / sizeof *kinds };

/* The solid angle of a triangle from the origin. Source: A. van Oosterom, J. Strackee, IEEE Trans. Biomed. Eng. 30
 * (1983) 125. */
static double solid_angle(double v[3][3]) {
    double r[3], dot[3], n[3];
    for (int k = 0; k < 3; ++k) {
        const double *a = v[k], *b = v[(k + 1) % 3];
        r[k] = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
        dot[k] = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    }
    for (int a = 0; a < 3; ++a) n[a] = v[1][(a + 1) % 3] * v[2][(a + 2) % 3] - v[1][(a + 2) % 3] * v[2][(a + 1) % 3];
    const double volume = v[0][0] * n[0] + v[0][1] * n[1] + v[0][2] * n[2];
    return 2 * fabs(atan2(volume, r[0] * r[1] * r[2] + dot[0] * r[2] + dot[1] * r[0] + dot[2] * r[1]));
}

/* A random rotation, from a random unit quaternion (Shoemake). */
static void random_rotation(uint64_t seed, double rotation[9]) {
    const double u = bed_make_random(seed, 8), s = 2 * pi * bed_make_random(seed, 9),
                 t = 2 * pi * bed_make_random(seed, 10);
    const double a = sqrt(1 - u) * sin(s), b = sqrt(1 - u) * cos(s), c = sqrt(u) * sin(t), d = sqrt(u) * cos(t);
    const double by_row[9] = {1 - 2 * (c * c + d * d), 2 * (b * c - a * d),     2 * (b * d + a * c),
                              2 * (b * c + a * d),     1 - 2 * (b * b + d * d), 2 * (c * d - a * b),
                              2 * (b * d - a * c),     2 * (c * d + a * b),     1 - 2 * (b * b + c * c)};
    memcpy(rotation, by_row, sizeof by_row);
}

/* Makes a triangle in a plane 1.05 to 30 radii away. Returns its factor. */
static double random_triangle(struct bench_triangles *triangles, uint64_t seed) {
    double rotation[9], v[3][3];
    const double away = 1.05 * pow(30 / 1.05, bed_make_random(seed, 0)),
                 size = 0.3 * pow(100, bed_make_random(seed, 1));
    random_rotation(seed, rotation);
    for (uint64_t k = 0; k < 3; ++k) {
        const double p[3] = {size * (2 * bed_make_random(seed, 2 + k) - 1),
                             size * (2 * bed_make_random(seed, 5 + k) - 1), away};
        for (int axis = 0; axis < 3; ++axis)
            v[k][axis] = rotation[3 * axis] * p[0] + rotation[3 * axis + 1] * p[1] + rotation[3 * axis + 2] * p[2];
        bench_vertex(triangles, v[k][0], v[k][1], v[k][2]);
    }
    bench_triangle(triangles, 0, 1, 2, 0);
    triangles->back[0] = 0;
    return solid_angle(v) / (4 * pi);
}

static void bench_polygons(uint64_t cases, int few) {
    double square[SETTINGS][KINDS] = {{0}}, worst[SETTINGS][KINDS] = {{0}};
    const fibrad_wall mesh = {.kind = FIBRAD_WALL_MESH};
    struct bed bed = bed_empty();
    bench_check("bed", bed_add(&bed, &(struct bed_sphere){.r = 1}) ? FIBRAD_E_MEMORY : FIBRAD_OK);
    fibrad_work work = BENCH_GROWING;
    fibrad_row row = row_in(1);
    for (uint64_t c = 0; c < cases; ++c) {
        struct bench_triangles triangles = bench_triangles_new(1);
        const double exact = random_triangle(&triangles, c + 1);
        void *block;
        fibrad_scene *scene = bench_scene_in(&bed, &mesh, 1, &triangles, &block);
        for (int s = 0; s < few; ++s)
            for (int k = 0; k < KINDS; ++k) {
                const fibrad_beam_rule rule = {.directions = settings[s], .points = kinds[k]};
                bench_check("row", fibrad_beam_row(scene, &work, 0, &rule, &row));
                const double error = fabs(row.wall[0] - exact);
                square[s][k] += error * error / (double)cases, worst[s][k] = fmax(worst[s][k], error);
            }
        free(block);
        bench_triangles_free(&triangles);
    }
    puts("# a sphere and a triangle\ndirections,points,rms,worst");
    for (int s = 0; s < few; ++s)
        for (int k = 0; k < KINDS; ++k)
            printf("%u,%u,%.2g,%.2g\n", settings[s], kinds[k], sqrt(square[s][k]), worst[s][k]);
    free(work.memory.block);
    free_row(&row);
    bed_free(&bed);
}

/* Computes rows in the same container twice: with triangles and few directions, and without triangles and many. */
static void bench_container(const char *name, const struct bed *bed, fibrad_scene *scene, fibrad_scene *smooth,
                            uint32_t number, int few) {
    fibrad_work work = BENCH_GROWING;
    fibrad_row row = row_in(bed->n), *truth = bench_array(bed->n, sizeof *truth);
    for (uint32_t i = 0; i < bed->n; ++i) {
        truth[i] = row_in(bed->n);
        const fibrad_beam_rule rule = {.directions = few < SETTINGS ? 2000 : 10000};
        bench_check("row", fibrad_beam_row(smooth, &work, i, &rule, &truth[i]));
    }
    printf("# %s, %u spheres\ndirections,walls,spheres_rms,bodies_rms,estimate_rms,us_per_window\n", name, bed->n);
    for (int s = 0; s < few; ++s)
        for (int mesh = 0; mesh < 2; ++mesh) {
            const fibrad_beam_rule rule = {.directions = settings[s]};
            double spheres = 0, walls = 0, estimate = 0, seconds = 0;
            for (uint32_t i = 0; i < bed->n; ++i) {
                const double begun = bench_thread_seconds();
                bench_check("row", fibrad_beam_row(mesh ? scene : smooth, &work, i, &rule, &row));
                seconds += bench_thread_seconds() - begun;
                spheres += pow(bench_distance(bench_row_entries(&row), bench_row_entries(&truth[i])), 2);
                for (uint32_t b = 0; b < number; ++b) walls += pow(row.wall[b] - truth[i].wall[b], 2);
                estimate += row.error * row.error;
            }
            printf("%u,%s,%.2g,%.2g,%.2g,%.2f\n", settings[s], mesh ? "triangles" : "smooth", sqrt(spheres / bed->n),
                   sqrt(walls / bed->n), sqrt(estimate / bed->n), 1e6 * seconds / bed->n / settings[s]);
        }
    for (uint32_t i = 0; i < bed->n; ++i) free_row(&truth[i]);
    free(truth);
    free(work.memory.block);
    free_row(&row);
}

static void bench_boxes(const struct bed *bed, int few) {
    double low[3], high[3];
    fibrad_wall plane[WALLS], mesh[WALLS];
    void *block[2];
    struct bench_triangles triangles = bench_triangles_new(12);
    find_ends(bed, low, high);
    bench_planes(plane, low, high);
    bench_box(&triangles, low, high, 1);
    for (int b = 0; b < WALLS; ++b) mesh[b] = (fibrad_wall){.kind = FIBRAD_WALL_MESH};
    fibrad_scene *scene = bench_scene_in(bed, mesh, WALLS, &triangles, &block[0]);
    fibrad_scene *smooth = bench_scene_in(bed, plane, WALLS, NULL, &block[1]);
    bench_container("a box of 12 triangles and of planes", bed, scene, smooth, WALLS, few);
    free(block[0]), free(block[1]);
    bench_triangles_free(&triangles);
}

/* The spheres of a bed that lie within its cylinder. */
static void bench_cylinders(const struct bed *from, int few) {
    enum { FACETS = 1000 };
    double low[3], high[3], middle[2];
    fibrad_wall smooth[3];
    void *block[2];
    struct bed bed = bed_empty();
    struct bench_triangles triangles = bench_triangles_new(2 * FACETS);
    find_ends(from, low, high);
    for (int axis = 0; axis < 2; ++axis) middle[axis] = 0.5 * (low[axis] + high[axis]);
    const double radius = 0.5 * fmin(high[0] - low[0], high[1] - low[1]), ends[2] = {low[2], high[2]};
    for (uint32_t i = 0; i < from->n; ++i)
        if (hypot(from->x[i] - middle[0], from->y[i] - middle[1]) + from->r[i] < 0.9999 * radius &&
            bed_add(&bed, &(struct bed_sphere){.x = from->x[i], .y = from->y[i], .z = from->z[i], .r = from->r[i]}))
            bench_check("bed", FIBRAD_E_MEMORY);
    fibrad_wall plane[WALLS], faceted[3] = {{.kind = FIBRAD_WALL_MESH}};
    bench_planes(plane, low, high);
    faceted[1] = smooth[1] = plane[4], faceted[2] = smooth[2] = plane[5];
    smooth[0] = (fibrad_wall){.kind = FIBRAD_WALL_CYLINDER, .cylinder = {middle[0], middle[1], radius, 2}};
    bench_tube(&triangles, middle, radius, ends, FACETS, 1, false, 0);
    fibrad_scene *scene = bench_scene_in(&bed, faceted, 3, &triangles, &block[0]);
    bench_container("a cylinder of 2,000 triangles and a smooth one, between planes", &bed, scene,
                    bench_scene_in(&bed, smooth, 3, NULL, &block[1]), 3, few);
    free(block[0]), free(block[1]);
    bench_triangles_free(&triangles);
    bed_free(&bed);
}

int main(int argc, char **argv) {
    const bool quick = argc == 2 && strcmp(argv[1], "quick") == 0;
    struct bed bed = bed_empty(), small = bed_empty();
    int status = argc == 2 && !quick ? read_bed(argv[1], &(struct read_options){0}, &bed)
                                     : bed_make_packing(&bed, quick ? 500 : 20000, 0.8, 1.2, 0.58, 1);
    if (!status) status = bed_make_packing(&small, quick ? 60 : 100, 0.8, 1.2, 0.5, 1);
    if (status) return status;
    memset(bed.period, 0, sizeof bed.period);
    memset(small.period, 0, sizeof small.period);
    bench_preamble("bench_mesh: walls of triangles", 1);
    bench_time(&bed, quick);
    bench_polygons(quick ? 10 : 100, quick ? 3 : SETTINGS);
    bench_boxes(&small, quick ? 2 : SETTINGS);
    bench_cylinders(&small, quick ? 2 : SETTINGS);
    bed_free(&bed);
    bed_free(&small);
    return 0;
}
