/* test_silhouettes.c - visible areas by another method: silhouettes. SPDX-License-Identifier: MIT
 *
 * All lines parallel to a direction d meet the spheres in the order of the depths of their centres. S(i, j) is the area
 * across d of the lines that leave sphere i and meet sphere j next. The border of that area consists of arcs of the
 * circles in which the spheres appear. On the circle of sphere k, let a be the last sphere before the depth of k that
 * covers a point, and b the first one after the depth of k. Inside the circle a line meets a, k, b. Outside it meets a,
 * b. So by Green's theorem an arc on which a and b do not change adds the integral g of (x dy - y dx)/2 to S(a, k) and
 * to S(k, b), and takes g from S(a, b). The origin of the integral is fixed for each pair: the centre of the smaller
 * sphere.
 *
 * Windows find the same areas by clipping. The two methods share nothing but the scene. The mean of F_ij and F_ji by
 * windows of n directions is the sum of S(i, j) + S(j, i) over the directions, over 2 n pi r_i^2. */
#include "scenes.h"
#include "suite.h"

enum { N_MOST = 80, DISCS_MOST = 20000, NOTHING = N_MOST };

static const double pi = 3.14159265358979323846;

/* A sphere seen from sphere k along d: its centre relative to that of k, across d and along d. */
struct disc {
    double x, y, depth, r;
    double from, to; /* the arc of the circle of k that the disc covers [rad], 0 <= from < 2 pi, from < to */
    uint32_t sphere;
    bool all; /* it covers the whole circle */
};

/* What the lines of all directions exchange, both ways. The last row and column are those of the surroundings. */
static double exchanged[N_MOST + 1][N_MOST + 1];
static struct disc discs[DISCS_MOST];
static double ends[2 * DISCS_MOST + 2];

static int compare_doubles(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Finds the arc of the circle of radius r that a disc covers. False: there is none. Of two circles that coincide, the
 * one farther along d counts as the larger one. */
static bool find_arc(struct disc *m, double r, double rounding) {
    double distance = hypot(m->x, m->y), larger = m->r - r;
    if (distance < rounding) distance = 0;
    if (fabs(larger) < rounding) larger = 0;
    if (distance == 0 && larger == 0) larger = m->depth > 0 ? 1 : -1;
    m->all = larger >= distance;
    if (m->all) return true;
    if (-larger >= distance || distance >= m->r + r) return false;
    const double half =
        2 * atan(sqrt((larger + distance) * (m->r + r - distance) / ((distance - larger) * (distance + m->r + r))));
    const double begin = atan2(m->y, m->x) - half;
    m->from = begin < 0 ? begin + 2 * pi : begin;
    m->to = m->from + 2 * half;
    return true;
}

static bool covers(const struct disc *m, double angle) {
    return m->all || (angle >= m->from && angle <= m->to) || (angle + 2 * pi >= m->from && angle + 2 * pi <= m->to);
}

/* The integral g of an arc of the circle of radius r. The origin lies at (x, y) as seen from the centre. */
static double integral(double r, double from, double to, double x, double y) {
    return r * r * (to - from) / 2 - r / 2 * (x * (sin(to) - sin(from)) - y * (cos(to) - cos(from)));
}

/* Adds an arc to what a sphere or the surroundings exchange with another one. NULL: the surroundings. */
static void exchange(const struct disc *first, const struct disc *next, double sign, double r, double from, double to) {
    if (first == NULL && next == NULL) return;
    const struct disc *origin = first == NULL ? next : next == NULL || first->r <= next->r ? first : next;
    const uint32_t i = first != NULL ? first->sphere : NOTHING, j = next != NULL ? next->sphere : NOTHING;
    const double g = sign * integral(r, from, to, origin->x, origin->y);
    exchanged[i][j] += g, exchanged[j][i] += g;
}

/* Adds the arc of circle k between two angles. */
static void add_arc(const struct disc *k, uint32_t count, double from, double to) {
    const struct disc *a = NULL, *b = NULL;
    for (uint32_t m = 0; m < count; m++) {
        if (!covers(&discs[m], (from + to) / 2)) continue;
        if (discs[m].depth < 0 && (a == NULL || discs[m].depth > a->depth)) a = &discs[m];
        if (discs[m].depth > 0 && (b == NULL || discs[m].depth < b->depth)) b = &discs[m];
    }
    exchange(a, k, 1, k->r, from, to);
    exchange(k, b, 1, k->r, from, to);
    exchange(a, b, -1, k->r, from, to);
}

/* Adds the disc of a sphere at c, relative to sphere k, if it covers some of the circle of k. */
static uint32_t add_disc(uint32_t count, const double c[3], double r, uint32_t sphere, const double frame[9],
                         const struct disc *k, double rounding) {
    struct disc m = {.r = r, .sphere = sphere};
    m.x = c[0] * frame[0] + c[1] * frame[1] + c[2] * frame[2];
    m.y = c[0] * frame[3] + c[1] * frame[4] + c[2] * frame[5];
    m.depth = c[0] * frame[6] + c[1] * frame[7] + c[2] * frame[8];
    if (!find_arc(&m, k->r, rounding)) return count;
    ck_assert_uint_lt(count, DISCS_MOST);
    discs[count] = m;
    return count + 1;
}

/* Follows the circle of sphere k. Along periodic axes `images` periods on both sides count. */
static void follow_circle(const struct bed *bed, uint32_t k, const double frame[9], int images) {
    const struct disc own = {.r = bed->r[k], .sphere = k};
    const double rounding = 1e-13 * (fabs(bed->x[k]) + fabs(bed->y[k]) + fabs(bed->z[k]) + bed->r[k]);
    int most[3];
    uint32_t count = 0, n = 0;
    for (int axis = 0; axis < 3; axis++) most[axis] = bed->period[axis] > 0 ? images : 0;
    for (uint32_t j = 0; j < bed->n; j++)
        for (int p = -most[0]; p <= most[0]; p++)
            for (int q = -most[1]; q <= most[1]; q++)
                for (int s = -most[2]; s <= most[2]; s++) {
                    const double c[3] = {bed->x[j] - bed->x[k] + p * bed->period[0],
                                         bed->y[j] - bed->y[k] + q * bed->period[1],
                                         bed->z[j] - bed->z[k] + s * bed->period[2]};
                    if (j == k && p == 0 && q == 0 && s == 0) continue;
                    count = add_disc(count, c, bed->r[j], j, frame, &own, rounding);
                }
    ends[n++] = 0, ends[n++] = 2 * pi;
    for (uint32_t m = 0; m < count; m++) {
        if (discs[m].all) continue;
        ends[n++] = discs[m].from;
        ends[n++] = discs[m].to >= 2 * pi ? discs[m].to - 2 * pi : discs[m].to;
    }
    qsort(ends, n, sizeof *ends, compare_doubles);
    for (uint32_t e = 0; e + 1 < n; e++)
        if (ends[e] < ends[e + 1]) add_arc(&own, count, ends[e], ends[e + 1]);
}

/* Finds two unit vectors across d, and d itself. */
static void make_frame(const double d[3], double frame[9]) {
    const int least = fabs(d[0]) <= fabs(d[1]) && fabs(d[0]) <= fabs(d[2]) ? 0 : fabs(d[1]) <= fabs(d[2]) ? 1 : 2;
    const double size = sqrt(1 - d[least] * d[least]);
    for (int a = 0; a < 3; a++) frame[a] = ((a == least) - d[least] * d[a]) / size, frame[6 + a] = d[a];
    for (int a = 0; a < 3; a++) {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        frame[3 + a] = d[b] * frame[c] - d[c] * frame[b];
    }
}

static void follow_all_circles(const struct bed *bed, uint32_t directions, int images) {
    memset(exchanged, 0, sizeof exchanged);
    for (uint32_t k = 0; k < directions; k++) {
        double d[3], frame[9];
        assert_ok(fibrad_direction(k, directions, d));
        make_frame(d, frame);
        for (uint32_t i = 0; i < bed->n; i++) follow_circle(bed, i, frame, images);
    }
}

/* Compares rows by windows with silhouettes of the same directions. Rows by silhouettes add up to 1. */
static void compare_methods(struct bed bed, uint32_t directions, int images, const char *what) {
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    OWNED_ROWS rows = rows_by_beams(scene, &(fibrad_beam_rule){.directions = directions});
    static double f[N_MOST][N_MOST];
    ck_assert_uint_le(bed.n, N_MOST);
    OWNED_MATRIX m = matrix_of(scene, &rows, 1, &(fibrad_matrix_rule){.raw = true});
    memset(f, 0, sizeof f);
    for (uint32_t i = 0; i < bed.n; i++)
        for (uint64_t e = m.factors.start[i]; e < m.factors.start[i + 1]; e++) f[i][m.factors.col[e]] = m.factors.f[e];
    follow_all_circles(&bed, directions, images);
    for (uint32_t i = 0; i < bed.n; i++) {
        const double area = bed.r[i] * bed.r[i], scale = 1 / (2 * directions * pi * area);
        double sum = exchanged[i][NOTHING] * scale;
        for (uint32_t j = 0; j < bed.n; j++) {
            const double windows = (f[i][j] + f[j][i] * bed.r[j] * bed.r[j] / area) / 2;
            const double silhouettes = exchanged[i][j] * scale;
            const double smaller = fmin(1, bed.r[j] * bed.r[j] / area);
            sum += silhouettes;
            ck_assert_msg(fabs(windows - silhouettes) <= 1e-12 * smaller, "%s: F_%u,%u %.17g by windows, %.17g", what,
                          i, j, windows, silhouettes);
        }
        ck_assert_msg(fabs(sum - 1) <= 1e-13, "%s: row %u adds up to 1 + %.3g", what, i, sum - 1);
    }
    bed_free(&bed);
}

static void dense_of(const fibrad_scene *scene, fibrad_rows *rows, double f[N_MOST][N_MOST + 1]) {
    OWNED_MATRIX m = matrix_of(scene, rows, 1, &(fibrad_matrix_rule){.raw = true});
    memset(f, 0, N_MOST * sizeof *f);
    for (uint32_t i = 0; i < m.factors.n; i++) {
        for (uint64_t e = m.factors.start[i]; e < m.factors.start[i + 1]; e++) f[i][m.factors.col[e]] = m.factors.f[e];
        f[i][NOTHING] = m.factors.escaped[i];
    }
    rows_free(rows);
}

/* Sets of more than 2,048 lines are sets of directions. Compares the kernel's silhouettes with its averaged windows. */
static void compare_kernel(struct bed bed, const char *what) {
    enum { LINES = 2053 };
    static double windows[N_MOST][N_MOST + 1], silhouettes[N_MOST][N_MOST + 1];
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    fibrad_rows rows = rows_by_beams(scene, &(fibrad_beam_rule){.directions = LINES});
    dense_of(scene, &rows, windows);
    rows = rows_by_silhouettes(scene, LINES);
    dense_of(scene, &rows, silhouettes);
    double worst = 0, closure = 0;
    for (uint32_t i = 0; i < bed.n; i++) {
        double sum = silhouettes[i][NOTHING];
        for (uint32_t j = 0; j < bed.n; j++) {
            const double ratio = bed.r[j] * bed.r[j] / (bed.r[i] * bed.r[i]), smaller = fmin(1, ratio);
            const double mean = (windows[i][j] + windows[j][i] * ratio) / 2;
            sum += silhouettes[i][j];
            worst = fmax(worst, fabs(mean - silhouettes[i][j]) / smaller);
        }
        closure = fmax(closure, fabs(sum - 1));
    }
    ck_assert_msg(worst <= 1e-12, "%s: windows and silhouettes differ by %.3g", what, worst);
    ck_assert_msg(closure <= 1e-13, "%s: a row adds up to 1 + %.3g", what, closure);
    bed_free(&bed);
}

TEST(kernel_agrees_with_windows) {
    for (uint64_t seed = 1; seed <= 3; seed++) {
        compare_kernel(packing(40, .3, 1, .1 * (double)seed, seed, false), "an open bed");
        compare_kernel(strewn(60, seed), "small among large ones");
        compare_kernel(packing(40, .6, 1, .55, seed, true), "a periodic bed");
        struct bed bed = packing(50, .4, 1, .4, seed, false);
        for (uint32_t i = 0; i < bed.n; i++) bed.r[i] *= 1.02 + .05 * (double)seed * bed_make_random(seed, i);
        compare_kernel(bed, "an overlap");
    }
}

TEST(open_beds) {
    for (uint64_t seed = 1; seed <= 6; seed++)
        compare_methods(packing(40, .3, 1, .1 * (double)seed, seed, false), 30, 0, "an open bed");
}

TEST(sizes_far_apart) {
    for (uint64_t seed = 1; seed <= 3; seed++) compare_methods(strewn(60, seed), 30, 0, "small among large ones");
}

/* The period is about four diameters. Three images on either side close all windows. */
TEST(periodic_beds) {
    for (uint64_t seed = 1; seed <= 3; seed++)
        compare_methods(packing(40, .6, 1, .55, seed, true), 12, 3, "a periodic bed");
}

/* A line that begins within another sphere meets it at once if the other's centre lies ahead. */
TEST(spheres_that_overlap) {
    for (uint64_t seed = 1; seed <= 4; seed++) {
        struct bed bed = packing(50, .4, 1, .4, seed, false);
        for (uint32_t i = 0; i < bed.n; i++) bed.r[i] *= 1.02 + .05 * (double)seed * bed_make_random(seed, i);
        compare_methods(bed, 30, 0, "an overlap");
    }
}

/* In some directions circles coincide, or nearly do. */
TEST(lattices) {
    static const double off[] = {0, 1e-16, 1e-14, 1e-12, 1e-10, 1e-8};
    for (const char *kind = "pif"; *kind != '\0'; kind++)
        for (size_t k = 0; k < sizeof off / sizeof *off; k++) {
            struct bed bed = lattice(*kind, 4.1);
            for (uint32_t i = 0; i < bed.n; i++) bed.x[i] += off[k] * bed.z[i], bed.y[i] -= off[k] / 3 * bed.z[i];
            compare_methods(bed, 32, 0, "a lattice");
        }
}
