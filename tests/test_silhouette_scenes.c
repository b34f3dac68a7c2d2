/* test_silhouette_scenes.c - silhouettes against windows of the same lines, in many small random scenes.
 * SPDX-License-Identifier: MIT
 *
 * Windows find visible areas by clipping, and silhouettes find them by following circles. The two methods share the
 * scene, the lists of near spheres and nothing else. FIBRAD_TEST_SCENES in the environment sets another number of
 * scenes of each kind. */
#include "row/window_lanes.h"
#include "sample/line.h"
#include "scenes.h"
#include "suite.h"
#include "work/work.h"

enum { N_MOST = 160, LINES_MOST = 21, NOTHING = N_MOST };

double fibrad_beam_window_scalar(fibrad_workspace *work, const double frame[9], fibrad_points *points, uint32_t k);

static const double pi = 3.14159265358979323846;
static double windows[N_MOST][N_MOST + 1], silhouettes[N_MOST][N_MOST + 1];

/* ---- chance ----------------------------------------------------------------------------------------------------- */

/* The random numbers of one scene. */
struct chance {
    uint64_t seed, at;
};

static double random_in(struct chance *chance, double low, double high) {
    return low + (high - low) * bed_make_random(chance->seed, chance->at++);
}

static uint32_t random_below(struct chance *chance, uint32_t count) { return (uint32_t)random_in(chance, 0, count); }

/* ---- both methods ----------------------------------------------------------------------------------------------- */

/* Finds the lines of a set, and two unit vectors across each. */
static void frames_of(uint32_t lines, double frame[LINES_MOST][9]) {
    double line[LINES_MOST][3], scratch[3 * LINES_MOST];
    fibrad_lines_make(lines, line, scratch);
    for (uint32_t k = 0; k < lines; k++) {
        const double *d = line[k];
        int least = fabs(d[0]) <= fabs(d[1]) && fabs(d[0]) <= fabs(d[2]) ? 0 : fabs(d[1]) <= fabs(d[2]) ? 1 : 2;
        const double size = sqrt(1 - d[least] * d[least]);
        for (int a = 0; a < 3; a++) frame[k][a] = ((a == least) - d[least] * d[a]) / size, frame[k][6 + a] = d[a];
        for (int a = 0; a < 3; a++) {
            const int b = (a + 1) % 3, c = (a + 2) % 3;
            frame[k][3 + a] = d[b] * frame[k][c] - d[c] * frame[k][b];
        }
    }
}

/* Adds what sphere i sees along and against lines. False: there was no room. */
static bool look_along(const fibrad_scene *scene, fibrad_workspace *space, uint32_t i, uint32_t lines,
                       const double frame[][9], double *row) {
    fibrad_points areas = {.count = 0};
    space->areas.overflow = false;
    space->windows = 2 * lines;
    fibrad_work_begin(space, scene, scene->place[i], 0, FIBRAD_BEAM_STRIDE);
    row[NOTHING] = 0;
    for (uint32_t k = 0; k < 2 * lines; k++) {
        double w[9];
        for (int a = 0; a < 9; a++) w[a] = k % 2 == 1 && a >= 3 ? -frame[k / 2][a] : frame[k / 2][a];
        row[NOTHING] += fibrad_beam_window_scalar(space, w, &areas, k);
        if (space->disc.count > space->disc.capacity || space->areas.overflow) {
            (void)fibrad_work_discs_missed(space);
            return false;
        }
    }
    for (uint32_t e = 0; e < space->entries.length; e++) {
        const double *part = space->entries.part[e];
        row[scene->order[space->entries.sphere[e]]] = part[0] + part[1] + part[2] + part[3];
    }
    return true;
}

/* Finds factors by windows, averaged with their partners. */
static void rows_by_windows(const fibrad_scene *scene, const struct bed *bed, uint32_t lines) {
    double frame[LINES_MOST][9];
    OWNED_WORK work = work_growing();
    fibrad_workspace *space;
    frames_of(lines, frame);
    assert_ok(fibrad_work_open(&work, scene, 0, 0, &space));
    for (uint32_t i = 0; i < bed->n; i++) {
        memset(windows[i], 0, sizeof windows[i]);
        while (!look_along(scene, space, i, lines, (const double(*)[9])frame, windows[i]))
            assert_ok(fibrad_work_grow(&work, &space));
    }
    const double scale = 1 / (2 * lines * pi);
    for (uint32_t i = 0; i < bed->n; i++) {
        windows[i][NOTHING] *= scale;
        for (uint32_t j = 0; j <= i; j++) {
            const double a_i = bed->r[i] * bed->r[i], a_j = bed->r[j] * bed->r[j];
            const double mean = (windows[i][j] * a_i + windows[j][i] * a_j) / 2 * scale;
            windows[i][j] = mean / a_i, windows[j][i] = mean / a_j;
        }
    }
}

static void dense_of_silhouettes(const fibrad_scene *scene, uint32_t lines) {
    OWNED_ROWS rows = rows_by_silhouettes(scene, lines);
    fibrad_row row;
    for (size_t at = 0; fibrad_rows_read(&rows, &at, &row);) {
        double *f = silhouettes[row.sphere];
        memset(f, 0, sizeof silhouettes[0]);
        for (uint32_t k = 0; k < row.length; k++) f[row.col[k]] = row.f[k];
        f[NOTHING] = row.escaped;
    }
}

/* The largest difference of the methods over the smaller area, and the largest difference of a row's sum from 1. */
struct bounds {
    double difference, closure;
};

/* Compares the methods in a scene. If all axes are periodic, both methods give up some lines, each at a length of its
 * own. These are the lines that leave. */
static void compare(const fibrad_scene *scene, const struct bed *bed, uint32_t lines, struct bounds most,
                    const char *what, uint64_t seed) {
    double escaped = 0;
    ck_assert_uint_le(bed->n, N_MOST);
    rows_by_windows(scene, bed, lines);
    dense_of_silhouettes(scene, lines);
    for (uint32_t i = 0; i < bed->n; i++) escaped += fmax(windows[i][NOTHING], silhouettes[i][NOTHING]);
    if (escaped > 0 && bed->period[2] > 0) most.difference = escaped;
    for (uint32_t i = 0; i < bed->n; i++) {
        double sum = silhouettes[i][NOTHING];
        for (uint32_t j = 0; j < bed->n; j++) {
            const double smaller = fmin(1, bed->r[j] * bed->r[j] / (bed->r[i] * bed->r[i]));
            const double difference = fabs(windows[i][j] - silhouettes[i][j]) / smaller;
            sum += silhouettes[i][j];
            ck_assert_msg(difference <= most.difference, "%s %llu: F_%u,%u is %.17g by windows, %.17g by silhouettes",
                          what, (unsigned long long)seed, i, j, windows[i][j], silhouettes[i][j]);
        }
        ck_assert_msg(fabs(sum - 1) <= most.closure, "%s %llu: row %u adds up to 1 + %.3g", what,
                      (unsigned long long)seed, i, sum - 1);
    }
}

/* ---- scenes ----------------------------------------------------------------------------------------------------- */

/* Whether there is place for a sphere at c: it is no deeper in another one than `depth` times the smaller radius. */
static bool fits(const struct bed *bed, const double c[3], double r, double depth) {
    bool fits = true;
    for (uint32_t j = 0; j < bed->n && fits; j++) {
        double square = 0;
        const double at[3] = {bed->x[j], bed->y[j], bed->z[j]};
        for (int axis = 0; axis < 3; axis++) {
            double d = c[axis] - at[axis];
            if (bed->period[axis] > 0) d -= bed->period[axis] * floor(d / bed->period[axis] + .5);
            square += d * d;
        }
        const double least = bed->r[j] + r - depth * fmin(bed->r[j], r);
        fits = square >= least * least;
    }
    return fits;
}

/* Adds spheres at random places of a cube. The logarithms of their radii, from `low` to 1, are spread evenly. */
static void add_at_random(struct chance *chance, uint32_t n, double low, double depth, const double cube[2],
                          struct bed *bed) {
    for (uint32_t tries = 0; bed->n < n && tries < 100; tries++) {
        double c[3], r = pow(low, random_in(chance, 0, 1));
        for (int axis = 0; axis < 3; axis++) c[axis] = random_in(chance, cube[0], cube[1]);
        if (fits(bed, c, r, depth)) add_sphere(bed, c[0], c[1], c[2], r);
    }
}

/* Makes some spheres in a box. */
static struct bed heap(struct chance *chance, double low, double depth, int periods, double side) {
    struct bed bed = bed_empty();
    const uint32_t n = 2 + random_below(chance, 11);
    for (int axis = 0; axis < periods; axis++) bed.period[axis] = side;
    add_at_random(chance, n, low, depth, (const double[]){0, side}, &bed);
    return bed;
}

/* Makes a part of a lattice. One of its axes lies along a line of the set, or within a small angle of it. */
static struct bed lattice_along(struct chance *chance, uint32_t lines) {
    static const double off[] = {0, 1e-16, 1e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8};
    double frame[LINES_MOST][9];
    frames_of(lines, frame);
    const double *f = frame[random_below(chance, lines)], turn = random_in(chance, 0, 2 * pi);
    const double tilt = off[random_below(chance, 10)];
    struct bed bed = lattice("pif"[random_below(chance, 3)], 2.9);
    for (uint32_t i = 0; i < bed.n; i++) {
        const double x = cos(turn) * bed.x[i] + sin(turn) * bed.y[i] + tilt * bed.z[i];
        const double y = cos(turn) * bed.y[i] - sin(turn) * bed.x[i], z = bed.z[i];
        bed.x[i] = x * f[0] + y * f[3] + z * f[6];
        bed.y[i] = x * f[1] + y * f[4] + z * f[7];
        bed.z[i] = x * f[2] + y * f[5] + z * f[8];
    }
    return bed;
}

/* Makes two spheres that overlap, among others. Along a line of the set their depths are nearly equal. */
static struct bed level(struct chance *chance, uint32_t lines) {
    double frame[LINES_MOST][9];
    struct bed bed = BED({0, 0, 0, 1});
    frames_of(lines, frame);
    const double *f = frame[random_below(chance, lines)], turn = random_in(chance, 0, 2 * pi);
    const double r = random_in(chance, .3, 1), across = random_in(chance, 1, 1 + r), side = random_in(chance, 0, 1);
    const double depth = pow(10, random_in(chance, -9, -5)) * (side < .5 ? -1 : 1);
    double c[3];
    for (int axis = 0; axis < 3; axis++)
        c[axis] = across * (cos(turn) * f[axis] + sin(turn) * f[3 + axis]) + depth * f[6 + axis];
    add_sphere(&bed, c[0], c[1], c[2], r);
    add_at_random(chance, 4 + random_below(chance, 9), .3, random_in(chance, 0, .9), (const double[]){-2.5, 2.5}, &bed);
    return bed;
}

/* Makes a sphere of radius 1 and small ones close to its surface. */
static struct bed giant(struct chance *chance, double r, uint32_t n) {
    struct bed bed = BED({0, 0, 0, 1});
    const double aside = random_in(chance, 5 * r, 60 * r), turn = random_in(chance, 0, 2 * pi);
    while (bed.n < n) { /* these lie above a patch of the surface */
        const double u = random_in(chance, -aside, aside), v = random_in(chance, -aside, aside);
        const double d = 1 + r * random_in(chance, 1, 12), size = sqrt(1 + u * u + v * v);
        const double c[3] = {d * (cos(turn) - sin(turn) * u) / size, d * (sin(turn) + cos(turn) * u) / size,
                             d * v / size};
        if (fits(&bed, c, r, 0)) add_sphere(&bed, c[0], c[1], c[2], r);
        if (bed.n < n && random_below(chance, 50) == 0) n--; /* the patch may be full */
    }
    return bed;
}

static uint32_t scenes_of_a_kind(uint32_t usual) {
    const char *given = getenv("FIBRAD_TEST_SCENES");
    return given != NULL ? (uint32_t)strtoul(given, NULL, 10) : usual;
}

/* Compares scenes of a kind. */
static void compare_scenes(const char *what, uint32_t usual, struct bounds most,
                           struct bed make(struct chance *, uint32_t lines)) {
    const uint32_t scenes = scenes_of_a_kind(usual);
    uint32_t compared = 0;
    for (uint64_t seed = 1; seed <= scenes; seed++) {
        struct chance chance = {.seed = seed};
        const uint32_t lines = 8 + random_below(&chance, 14);
        OWNED_BED bed = make(&chance, lines);
        OWNED fibrad_scene *scene = NULL;
        if (scene_try(&scene, &bed, NULL, NULL) == FIBRAD_OK) compare(scene, &bed, lines, most, what, seed), compared++;
    }
    ck_assert_uint_ge(compared, scenes - scenes / 5);
}

static struct bed open_heap(struct chance *chance, uint32_t lines) {
    (void)lines;
    return heap(chance, .3, 0, 0, random_in(chance, 2, 8));
}

static struct bed sizes_apart(struct chance *chance, uint32_t lines) {
    (void)lines;
    return heap(chance, 1e-3, 0, 0, random_in(chance, 2, 4));
}

static struct bed overlaps(struct chance *chance, uint32_t lines) {
    (void)lines;
    return heap(chance, .3, random_in(chance, 0, .9), 0, random_in(chance, 1, 4));
}

static struct bed periods(struct chance *chance, uint32_t lines) {
    (void)lines;
    return heap(chance, .3, 0, 1 + (int)random_below(chance, 3), random_in(chance, 2.5, 5));
}

static struct bed giants(struct chance *chance, uint32_t lines) {
    (void)lines;
    return giant(chance, pow(10, random_in(chance, -3.3, -1)), 3 + random_below(chance, 60));
}

static const struct bounds usual = {1e-12, 1e-13};

TEST(heaps) { compare_scenes("heap", 6000, usual, open_heap); }

/* Radii differ by up to a thousand. Scene 58,122 differs by 2.2e-12. */
TEST(sizes_far_apart) { compare_scenes("sizes", 4000, (struct bounds){2e-12, 1e-13}, sizes_apart); }

TEST(spheres_that_overlap) { compare_scenes("overlap", 4000, usual, overlaps); }

TEST(spheres_at_nearly_one_depth) { compare_scenes("level", 2000, usual, level); }

TEST(periodic_scenes) { compare_scenes("periods", 3000, usual, periods); }

/* Windows find 1e-10 of spheres that can be seen past others because of rounding alone. */
TEST(lattices) { compare_scenes("lattice", 2000, (struct bounds){1e-9, 1e-13}, lattice_along); }

/* Coordinates are of the order of the large sphere's radius. Areas are of the order of the small one's disc.
 * Scene 477,502 differs by 4.1e-11. */
TEST(giants_among_small_ones) { compare_scenes("giant", 1000, (struct bounds){4e-11, 3e-13}, giants); }
