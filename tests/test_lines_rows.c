/* test_lines_rows.c - rows along lines: exact areas against another method, masks of points against exact areas, bits,
 * closing and estimates. SPDX-License-Identifier: MIT
 *
 * The other method follows the silhouettes of spheres, which are circles. All lines parallel to a direction d meet the
 * spheres in the order of the depths of their centres. S(i, j) is the area across d of the lines that leave sphere i
 * and meet sphere j next. The border of that area consists of arcs of the circles in which the spheres appear. On the
 * circle of sphere k, let a be the last sphere before the depth of k that covers a point, and b the first one after the
 * depth of k. Inside the circle a line meets a, k, b. Outside it meets a, b. So by Green's theorem an arc on which a
 * and b do not change adds the integral g of (x dy - y dx)/2 to S(a, k) and to S(k, b), and takes g from S(a, b). The
 * origin of the integral is fixed for each pair: the centre of the smaller sphere.
 *
 * Windows find the same areas by clipping. The two methods share nothing but the lines. The mean of F_ij and F_ji by
 * windows of n lines, one window for each line, is the sum of S(i, j) + S(j, i) over the lines, over 2 n pi r_i^2. */
#include "mask/line_set.h"
#include "scenes.h"
#include "suite.h"
#include "rows/record.h"

enum { N_MOST = 80, DISCS_MOST = 20000, NOTHING = N_MOST };

/* A sphere seen from sphere k along d: its centre relative to that of k, across d and along d. */
struct disc {
    double x, y, depth, r;
    double from, to; /* the arc of the circle of k that the disc covers [rad], 0 <= from < 2 pi, from < to */
    uint32_t sphere;
    bool all; /* it covers the whole circle */
};

/* What all lines exchange, both ways. The last row and column are those of the surroundings. */
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
    m->from = begin < 0 ? begin + 2 * M_PI : begin;
    m->to = m->from + 2 * half;
    return true;
}

static bool covers(const struct disc *m, double angle) {
    return m->all || (angle >= m->from && angle <= m->to) || (angle + 2 * M_PI >= m->from && angle + 2 * M_PI <= m->to);
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
    ends[n++] = 0, ends[n++] = 2 * M_PI;
    for (uint32_t m = 0; m < count; m++) {
        if (discs[m].all) continue;
        ends[n++] = discs[m].from;
        ends[n++] = discs[m].to >= 2 * M_PI ? discs[m].to - 2 * M_PI : discs[m].to;
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

static void follow_all_circles(const struct bed *bed, const fibrad_line_set *lines, int images) {
    memset(exchanged, 0, sizeof exchanged);
    for (uint32_t k = 0; k < lines->n; k++) {
        double frame[9];
        make_frame(lines->line[k], frame);
        for (uint32_t i = 0; i < bed->n; i++) follow_circle(bed, i, frame, images);
    }
}

/* Rows along lines by exact areas. is_exact: the pair is free and has its closed form in place of windows. */
static double f[N_MOST][N_MOST];
static bool is_exact[N_MOST][N_MOST];

static void find_rows(const fibrad_scene *scene, const fibrad_line_set *lines) {
    OWNED_ROWS all = rows_by_beams(scene, &(fibrad_beam_rule){.lines = lines, .chords = FIBRAD_CHORDS_NONE});
    fibrad_row row;
    memset(f, 0, sizeof f), memset(is_exact, 0, sizeof is_exact);
    for (size_t at = 0; fibrad_rows_read(&all, &at, &row);)
        for (uint32_t k = 0; k < row.length; k++) {
            f[row.sphere][row.col[k]] = row.f[k];
            is_exact[row.sphere][row.col[k]] = row.half[k] == FIBRAD_HALF_EXACT;
        }
}

/* Checks the factor of a free pair, whose closed form counts. */
static void check_free_pair(const struct bed *bed, uint32_t i, uint32_t j, const char *what) {
    const double distance = hypot(hypot(bed->x[i] - bed->x[j], bed->y[i] - bed->y[j]), bed->z[i] - bed->z[j]);
    double closed;
    assert_ok(fibrad_pair_exact(bed->r[i], bed->r[j], distance - bed->r[i] - bed->r[j], &closed));
    ck_assert_msg(fabs(f[i][j] - closed) <= 1e-12 * closed, "%s: F_%u,%u %.17g, in closed form %.17g", what, i, j,
                  f[i][j], closed);
}

/* Compares rows by exact areas with circles along the same lines. Rows by circles add up to 1. Windows do not tell the
 * factors of free pairs. `least` of all pairs that see each other are not free. */
static void compare_methods(struct bed bed, uint32_t lines, int images, double least, const char *what) {
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    OWNED fibrad_line_set *set = lines_of(lines);
    uint32_t seen = 0, by_windows = 0;
    ck_assert_uint_le(bed.n, N_MOST);
    find_rows(scene, set);
    follow_all_circles(&bed, set, images);
    for (uint32_t i = 0; i < bed.n; i++) {
        const double area = bed.r[i] * bed.r[i], scale = 1 / (2 * set->n * M_PI * area);
        double sum = exchanged[i][NOTHING] * scale;
        for (uint32_t j = 0; j < bed.n; j++) {
            const double windows = (f[i][j] + f[j][i] * bed.r[j] * bed.r[j] / area) / 2;
            const double circles = exchanged[i][j] * scale, smaller = fmin(1, bed.r[j] * bed.r[j] / area);
            const bool either = is_exact[i][j] || is_exact[j][i];
            sum += circles, seen += windows > 0, by_windows += windows > 0 && !either;
            if (is_exact[i][j]) check_free_pair(&bed, i, j, what);
            if (either) continue;
            ck_assert_msg(fabs(windows - circles) <= 1e-12 * smaller, "%s: F_%u,%u %.17g by windows, %.17g", what, i, j,
                          windows, circles);
        }
        ck_assert_msg(fabs(sum - 1) <= 1e-13, "%s: row %u adds up to 1 + %.3g", what, i, sum - 1);
    }
    printf("%s: %u of %u pairs by windows\n", what, by_windows, seen);
    ck_assert_double_ge(by_windows, least * seen);
    bed_free(&bed);
}

TEST(open_beds_agree_with_circles) {
    for (uint64_t seed = 1; seed <= 6; seed++)
        compare_methods(packing(40, .3, 1, .1 * (double)seed, seed, false), 30, 0, .5, "an open bed");
}

TEST(sizes_far_apart_agree_with_circles) {
    for (uint64_t seed = 1; seed <= 3; seed++) compare_methods(strewn(60, seed), 30, 0, .1, "small among large ones");
}

/* The period is about four diameters. Three images on either side close all windows. */
TEST(periodic_beds_agree_with_circles) {
    for (uint64_t seed = 1; seed <= 3; seed++)
        compare_methods(packing(40, .6, 1, .55, seed, true), 12, 3, 1, "a periodic bed");
}

static struct bed overlapping(uint64_t seed) {
    struct bed bed = packing(50, .4, 1, .4, seed, false);
    for (uint32_t i = 0; i < bed.n; i++) bed.r[i] *= 1.02 + .05 * (double)seed * bed_make_random(seed, i);
    return bed;
}

/* A line that begins within another sphere meets it at once if the other's centre lies ahead. */
TEST(overlaps_agree_with_circles) {
    for (uint64_t seed = 1; seed <= 4; seed++) compare_methods(overlapping(seed), 30, 0, .5, "an overlap");
}

/* In some directions circles coincide, or nearly do. */
TEST(lattices_agree_with_circles) {
    static const double off[] = {0, 1e-16, 1e-14, 1e-12, 1e-10, 1e-8};
    for (const char *kind = "pif"; *kind != '\0'; kind++)
        for (size_t k = 0; k < sizeof off / sizeof *off; k++) {
            struct bed bed = lattice(*kind, 4.1);
            for (uint32_t i = 0; i < bed.n; i++) bed.x[i] += off[k] * bed.z[i], bed.y[i] -= off[k] / 3 * bed.z[i];
            compare_methods(bed, 32, 0, .5, "a lattice");
        }
}

/* ---- masks ------------------------------------------------------------------------------------------------------ */

static struct bed open_bed(void) { return packing(300, .8, 1.2, .5, 3, false); }
static struct bed periodic_bed(void) { return packing(300, .8, 1.2, .55, 3, true); }
static struct bed unequal_bed(void) { return packing(300, .25, 1, .45, 4, false); }
static struct bed overlapping_bed(void) { return overlapping(1); }
static struct bed cubic_bed(void) { return lattice('p', 6); }

static struct bed (*const beds[])(void) = {open_bed, periodic_bed, unequal_bed, overlapping_bed, cubic_bed};
enum { BEDS = sizeof beds / sizeof *beds };

/* The points of masks make an error about as large as the row says. */
LOOP_TEST(masks_have_the_noise_they_tell, BEDS) {
    OWNED_BED bed = beds[_i]();
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    OWNED fibrad_line_set *lines = lines_of(64);
    OWNED_WORK work = work_growing();
    for (uint32_t chords = 16; chords <= 64; chords *= 2) {
        double square = 0, most = 0;
        for (uint32_t i = 0; i < bed.n; i++) {
            OWNED_ROW exact = row_of(bed.n), masks = row_of(bed.n);
            assert_ok(fibrad_beam_row(scene, &work, i,
                                      &(fibrad_beam_rule){.lines = lines, .chords = FIBRAD_CHORDS_NONE}, &exact));
            assert_ok(fibrad_beam_row(scene, &work, i, &(fibrad_beam_rule){.lines = lines, .chords = chords}, &masks));
            ck_assert(exact.noise == 0 && masks.noise > 0);
            ck_assert_double_eq_tol(row_sum(&masks) + masks.escaped, 1, 1e-13);
            const double ratio = row_distance(&exact, &masks) / masks.noise;
            square += ratio * ratio, most = fmax(most, ratio);
        }
        printf("bed %d, %u chords: noise is %.2f of what rows tell, at most %.2f\n", _i, chords, sqrt(square / bed.n),
               most);
        ck_assert(sqrt(square / bed.n) > .4 && sqrt(square / bed.n) < 1.5 && most < 4);
    }
}

/* ---- bits ------------------------------------------------------------------------------------------------------- */

/* Whether rows i and j of two matrices are the same. place: of each sphere of `a` in `b`. */
static void same_row(const fibrad_factors *a, const fibrad_factors *b, uint32_t i, const uint32_t *place) {
    const fibrad_row here = matrix_row(a, i), there = matrix_row(b, place[i]);
    ck_assert_uint_eq(here.length, there.length);
    ck_assert(here.escaped == there.escaped && here.error == there.error);
    for (uint32_t k = 0; k < here.length; k++) ck_assert(here.f[k] == row_factor(&there, place[here.col[k]]));
}

/* Raw rows along lines have the same bits in every order of the file. */
LOOP_TEST(same_bits_in_any_order, BEDS) {
    static const uint32_t chords[] = {FIBRAD_CHORDS_NONE, 16, 32, 64};
    OWNED_BED bed = beds[_i]();
    OWNED_BED other = bed_empty();
    OWNED uint64_t *id = calloc(bed.n, sizeof *id), *other_id = calloc(bed.n, sizeof *id);
    OWNED uint32_t *place = calloc(bed.n, sizeof *place);
    memcpy(other.period, bed.period, sizeof bed.period);
    for (uint32_t i = 0; i < bed.n; i++) { /* 7 has no factor in common with the number of spheres */
        const uint32_t from = (uint32_t)((7ull * i + 3) % bed.n);
        add_sphere(&other, bed.x[from], bed.y[from], bed.z[from], bed.r[from]);
        place[from] = i, other_id[i] = 1000 - from, id[i] = 1000 - i;
    }
    for (int c = 0; c < 4; c++) {
        OWNED_MATRIX first = {NULL, {0}};
        for (int moved = 0; moved < 2; moved++) {
            fibrad_spheres spheres = spheres_of(moved ? &other : &bed);
            spheres.id = moved ? other_id : id;
            fibrad_scene_config config = {0};
            memcpy(config.period, bed.period, sizeof bed.period);
            const size_t size = fibrad_scene_size(bed.n, 1);
            OWNED void *block = block_of(size);
            fibrad_scene *scene;
            assert_ok(fibrad_scene_init(&scene, block, size, &config, &spheres, NULL));
            OWNED_MATRIX m = matrix_by_lines(scene, 34, chords[c], true);
            if (!moved)
                first = m, m = (struct matrix){NULL, {0}};
            else
                for (uint32_t i = 0; i < bed.n; i++) same_row(&first.factors, &m.factors, i, place);
        }
    }
}

/* The matrix does not depend on the collections that its rows lie in, nor on tasks. Collections keep the halves. */
TEST(collections_change_no_bit) {
    OWNED_BED bed = unequal_bed();
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    OWNED fibrad_line_set *lines = lines_of(50);
    const fibrad_beam_rule rule = {.lines = lines};
    OWNED_ROWS all = rows_by_beams(scene, &rule);
    fibrad_rows spread[3] = {{.memory = memory_growing()}, {.memory = memory_growing()}, {.memory = memory_growing()}};
    OWNED_WORK work = work_growing();
    fibrad_row row;
    OWNED_ROW arrays = row_of(bed.n);
    OWNED float *half = calloc(bed.n, sizeof *half);
    arrays.half = half;
    for (uint32_t i = bed.n; i-- > 0;)
        assert_ok(fibrad_beam_row(scene, &work, i, &rule, &(fibrad_row){.rows = &spread[i % 3]}));
    for (size_t at = 0; fibrad_rows_read(&all, &at, &row);) {
        assert_ok(fibrad_beam_row(scene, &work, row.sphere, &rule, &arrays));
        ck_assert(same_bits(&row, &arrays));
        ck_assert(row.lines == fibrad_line_set_lines(50) && row.noise == arrays.noise && row.shares == arrays.shares);
        ck_assert_mem_eq(row.half, half, row.length * sizeof *half);
    }
    OWNED_MATRIX one = matrix_of(scene, &all, 1, NULL);
    OWNED_MATRIX three = matrix_of(scene, spread, 3, &(fibrad_matrix_rule){.tasks = 5});
    ck_assert(matrix_same_bits(&one.factors, &three.factors));
    for (int c = 0; c < 3; c++) rows_free(&spread[c]);
}

/* ---- matrices --------------------------------------------------------------------------------------------------- */

/* Nothing escapes from a bed that is periodic along all axes. Its matrix is closed and reciprocal, to rounding. */
TEST(nothing_escapes_from_a_bed_periodic_on_all_axes) {
    static const uint32_t chords[] = {FIBRAD_CHORDS_NONE, 16, 32, 64};
    OWNED_BED bed = periodic_bed();
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    for (int c = 0; c < 4; c++) {
        OWNED_MATRIX m = matrix_by_lines(scene, 100, chords[c], false);
        double largest;
        assert_ok(fibrad_matrix_reciprocity(m.matrix, &largest));
        ck_assert_double_le(largest, 1e-16);
        for (uint32_t i = 0; i < bed.n; i++) {
            ck_assert_double_le(m.factors.escaped[i], 1e-13);
            ck_assert_double_eq_tol(matrix_sum(&m.factors, i), 1, 1e-13);
        }
    }
}

/* The true error lies above twice the estimate in 5 % of rows at most. The median estimate is not above four times the
 * error. The truth is 1,024 lines with exact areas. */
LOOP_TEST(estimates_are_honest, BEDS) {
    OWNED_BED bed = beds[_i]();
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    OWNED_MATRIX truth = matrix_by_lines(scene, FIBRAD_LINES_EVEN_MAX, FIBRAD_CHORDS_NONE, false);
    for (uint32_t lines = 50; lines <= 450; lines *= 3) {
        OWNED_MATRIX m = matrix_by_lines(scene, lines, 0, false);
        OWNED double *ratio = calloc(bed.n, sizeof *ratio);
        uint32_t low = 0;
        for (uint32_t i = 0; i < bed.n; i++) {
            const fibrad_row here = matrix_row(&m.factors, i), there = matrix_row(&truth.factors, i);
            ratio[i] = here.error / row_distance(&here, &there);
            low += ratio[i] < .5;
        }
        qsort(ratio, bed.n, sizeof *ratio, compare_doubles);
        printf("bed %d, %u lines: estimate over error %.2f %.2f %.2f, %u of %u too low\n", _i, lines, ratio[bed.n / 20],
               ratio[bed.n / 2], ratio[bed.n - 1 - bed.n / 20], low, bed.n);
        ck_assert_uint_le(20 * low, bed.n);
        ck_assert_double_le(ratio[bed.n / 2], 4);
    }
}

/* ---- rules ------------------------------------------------------------------------------------------------------ */

/* A rule has lines or directions. Masks take the place of points. */
TEST(rules_have_lines_or_directions) {
    OWNED_BED bed = BED({0, 0, 0, 1}, {2.5, 0, 0, 1});
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    OWNED fibrad_line_set *lines = lines_of(30);
    OWNED_WORK work = work_growing();
    OWNED_ROW row = row_of(2);
    const fibrad_beam_rule bad[] = {{.lines = lines, .directions = 30}, {.lines = lines, .points = 64},
                                    {.lines = lines, .turn = 1},        {.lines = lines, .tolerance = .1},
                                    {.lines = lines, .chords = 17},     {.directions = 30, .points = 64, .chords = 16}};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++)
        assert_invalid(fibrad_beam_row(scene, &work, 0, &bad[k], &row));
    assert_ok(fibrad_beam_row(scene, &work, 0, &(fibrad_beam_rule){.lines = lines}, &row));
    ck_assert(row.lines == fibrad_line_set_lines(30) && row.directions == 0);
    assert_ok(fibrad_beam_row(scene, &work, 0, NULL, &row));
    ck_assert(row.lines == 0 && row.noise == 0);
    fibrad_line_set *set = NULL;
    ck_assert_uint_eq(fibrad_line_set_size(FIBRAD_DIRECTIONS_MIN - 1), 0);
    ck_assert_uint_eq(fibrad_line_set_size(FIBRAD_LINES_EVEN_MAX + 1), 0);
    const size_t size = fibrad_line_set_size(30);
    OWNED void *block = block_of(size);
    assert_invalid(fibrad_line_set_init(NULL, block, size, 30));
    assert_invalid(fibrad_line_set_init(&set, NULL, size, 30));
    ck_assert_int_eq(fibrad_line_set_init(&set, block, size, FIBRAD_LINES_EVEN_MAX + 1), FIBRAD_E_TABLE);
    ck_assert_int_eq(fibrad_line_set_init(&set, block, size - 1, 30), FIBRAD_E_SIZE);
    ck_assert_ptr_null(set);
}
