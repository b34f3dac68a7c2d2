/* test_surface_row.c - rows by the surface method against ray-by-ray sums and against beams.
 * SPDX-License-Identifier: MIT */
#include "fibrad_mesh.h"
#include "fibrad_surface.h"
#include "scenes.h"
#include "suite.h"
#include "surface_plain.h"

#define CUTOFF 6.0
#define MOST   4096 /* entries of a row, near spheres */

static struct bed bed;
static fibrad_scene *scene;
static fibrad_work work;
static uint32_t col[MOST];
static double f[MOST];

static void make_scene(int isa, bool periodic) {
    struct bed open = bed;
    for (int axis = 0; axis < 3; axis++) open.period[axis] = periodic ? bed.period[axis] : 0;
    free(scene);
    scene = scene_of(&open, isa);
}

/* Makes a random bed of n spheres. */
static void make(uint32_t n, bool periodic) {
    bed_free(&bed);
    bed = packing(n, .8, 1.2, .55, 1, true);
    make_scene(FIBRAD_ISA_BEST, periodic);
    work_free(&work);
    work = work_growing();
}

static fibrad_row surface_row(uint32_t i, const fibrad_surface_rule *rule) {
    fibrad_row row = {.col = col, .f = f, .capacity = MOST};
    assert_ok(fibrad_surface_row(scene, &work, i, rule, &row));
    ck_assert_uint_eq(row.sphere, i);
    ck_assert_int_eq(row.symmetric, 1);
    ck_assert(row.beyond == 0 && row.error >= 0);
    return row;
}

/* F from i to j, each at its own place, ray by ray, in the frame of which fibrad.h tells. */
static double plain(uint32_t i, uint32_t j, uint32_t nodes) {
    const uint32_t one = i < j ? i : j, two = i < j ? j : i;
    const double c1[3] = {bed.x[one], bed.y[one], bed.z[one]};
    double w[3] = {bed.x[two] - c1[0], bed.y[two] - c1[1], bed.z[two] - c1[2]};
    const double d = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    int least = 0;
    for (int axis = 0; axis < 3; axis++) {
        w[axis] /= d;
        if (fabs(w[axis]) < fabs(w[least])) least = axis;
    }
    const double a[3] = {least == 0, least == 1, least == 2};
    double u[3] = {a[1] * w[2] - a[2] * w[1], a[2] * w[0] - a[0] * w[2], a[0] * w[1] - a[1] * w[0]};
    const double ring = sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
    for (int axis = 0; axis < 3; axis++) u[axis] /= ring;
    const double v[3] = {w[1] * u[2] - w[2] * u[1], w[2] * u[0] - w[0] * u[2], w[0] * u[1] - w[1] * u[0]};

    static double x[MOST], y[MOST], z[MOST], r[MOST];
    fibrad_spheres obstacles = {.x = x, .y = y, .z = z, .r = r};
    for (uint32_t k = 0; k < bed.n; k++) {
        const double from_i[3] = {bed.x[k] - bed.x[i], bed.y[k] - bed.y[i], bed.z[k] - bed.z[i]};
        const double e[3] = {bed.x[k] - c1[0], bed.y[k] - c1[1], bed.z[k] - c1[2]};
        if (k == i || k == j) continue;
        if (from_i[0] * from_i[0] + from_i[1] * from_i[1] + from_i[2] * from_i[2] > CUTOFF * CUTOFF) continue;
        const uint32_t n = obstacles.n++;
        x[n] = e[0] * u[0] + e[1] * u[1] + e[2] * u[2];
        y[n] = e[0] * v[0] + e[1] * v[1] + e[2] * v[2];
        z[n] = e[0] * w[0] + e[1] * w[1] + e[2] * w[2];
        r[n] = bed.r[k];
    }
    const double r1 = bed.r[one], r2 = bed.r[two], ratio = one == i ? 1 : r1 * r1 / (r2 * r2);
    double unblocked, blocked, exact;
    surface_plain(r1, r2, d - r1 - r2, &obstacles, nodes, &unblocked, &blocked);
    assert_ok(fibrad_pair_exact(r1, r2, d - r1 - r2, &exact));
    return ratio * (blocked / unblocked * exact);
}

TEST(equals_plain_sums) {
    make(150, false);
    uint32_t entries = 0;
    for (uint32_t i = 0; i < bed.n; i += 10) {
        const fibrad_row row = surface_row(i, &(fibrad_surface_rule){.nodes = 34, .cutoff = CUTOFF});
        for (uint32_t j = 0; j < bed.n; j++) {
            const double e[3] = {bed.x[j] - bed.x[i], bed.y[j] - bed.y[i], bed.z[j] - bed.z[i]};
            const bool within = j != i && e[0] * e[0] + e[1] * e[1] + e[2] * e[2] <= CUTOFF * CUTOFF;
            ck_assert_double_eq_tol(row_factor(&row, j), within ? plain(i, j, 34) : 0, 1e-12);
        }
        entries += row.length;
    }
    ck_assert_uint_gt(entries, 300);
}

TEST(skips_and_instruction_sets_change_no_bit) {
    static uint32_t col_first[MOST];
    static double f_first[MOST];
    const struct isas isas = isas_there();
    for (int periodic = 0; periodic < 2; periodic++) {
        make(200, periodic);
        for (uint32_t i = 0; i < bed.n; i += 20) {
            fibrad_surface_rule rule = {.cutoff = CUTOFF};
            make_scene(FIBRAD_ISA_SCALAR, periodic);
            const fibrad_row first = surface_row(i, &rule);
            memcpy(col_first, col, first.length * sizeof *col);
            memcpy(f_first, f, first.length * sizeof *f);
            for (int set = 0; set < isas.count; set++) {
                make_scene(isas.set[set], periodic);
                for (uint32_t skip = 2; skip <= 32; skip *= 2) {
                    rule.flags = skip < 32 ? skip : 30;
                    const fibrad_row row = surface_row(i, &rule);
                    ck_assert_uint_eq(row.length, first.length);
                    ck_assert(memcmp(col, col_first, row.length * sizeof *col) == 0);
                    ck_assert(memcmp(f, f_first, row.length * sizeof *f) == 0);
                }
            }
        }
    }
}

/* The rows of both methods are as far apart as the estimate of the surface method, the coarser of the two, says. */
TEST(agrees_with_beams) {
    make(300, true);
    static uint32_t beam_col[MOST];
    static double beam_f[MOST];
    double difference = 0, estimate = 0;
    for (uint32_t i = 0; i < bed.n; i += 5) {
        const fibrad_row row = surface_row(i, &(fibrad_surface_rule){.cutoff = CUTOFF});
        fibrad_row beam = {.col = beam_col, .f = beam_f, .capacity = MOST};
        const fibrad_beam_rule rule = {.directions = 2000, .cutoff = CUTOFF};
        assert_ok(fibrad_beam_row(scene, &work, i, &rule, &beam));
        for (uint32_t j = 0; j < bed.n; j++) {
            const double e = row_factor(&row, j) - row_factor(&beam, j);
            difference += e * e;
        }
        estimate += row.error * row.error;
    }
    ck_assert_double_lt(sqrt(difference / estimate), 1.5);
    ck_assert_double_gt(sqrt(difference / estimate), 0.5);
}

TEST(reciprocal_without_cutoff) {
    make(60, false);
    static double all[60][60];
    for (uint32_t i = 0; i < bed.n; i++) {
        const fibrad_row row = surface_row(i, NULL);
        double sum = row.escaped;
        for (uint32_t j = 0; j < bed.n; j++) sum += all[i][j] = row_factor(&row, j);
        ck_assert_double_eq_tol(sum, 1, 1e-14);
    }
    for (uint32_t i = 0; i < bed.n; i++)
        for (uint32_t j = 0; j < i; j++) {
            const double there = all[i][j] * bed.r[i] * bed.r[i], back = all[j][i] * bed.r[j] * bed.r[j];
            ck_assert_double_le(fabs(there - back), 1e-15 * there);
        }
}

/* The rows of a matrix are as they were but for rounding, and as accurate as they say. */
TEST(rows_of_a_matrix) {
    make(60, false);
    OWNED_ROWS rows = {.memory = memory_growing()};
    for (uint32_t i = 0; i < bed.n; i++)
        assert_ok(fibrad_surface_row(scene, &work, i, NULL, &(fibrad_row){.rows = &rows}));
    OWNED_MATRIX raw = matrix_of(scene, &rows, 1, &(fibrad_matrix_rule){.raw = 1});
    OWNED_MATRIX m = matrix_of(scene, &rows, 1, NULL);
    double above = 0, largest;
    for (uint32_t i = 0; i < bed.n; i++) worst_of(&above, matrix_sum(&raw.factors, i) - 1);
    for (uint32_t i = 0; i < bed.n; i++) {
        const fibrad_row before = matrix_row(&raw.factors, i), after = matrix_row(&m.factors, i);
        ck_assert_double_eq(before.error, after.error);
        ck_assert_uint_eq(before.length, after.length);
        ck_assert_double_le(row_distance(&before, &after), 1e-15 + above);
        ck_assert_double_eq_tol(matrix_total(&m.factors, i), 1, 1e-14);
    }
    assert_ok(fibrad_matrix_reciprocity(raw.matrix, &largest));
    ck_assert_double_le(largest, 1e-15);
}

/* With three periods each way there are 7^3 images in the cube. A hundred periods and more are refused, and so is what
 * needs more memory than there can be. */
TEST(bounds_the_search_for_images) {
    make(60, true);
    const double period = bed.period[0];
    fibrad_row row = {.col = col, .f = f, .capacity = MOST};
    static unsigned char block[1 << 18];
    fibrad_work little = work_fixed(block, sizeof block);
    const struct {
        double periods;
        int status;
    } cases[] = {{3, FIBRAD_E_WORK}, {100, FIBRAD_E_ARGUMENT}, {101, FIBRAD_E_ARGUMENT}, {1e9, FIBRAD_E_ARGUMENT}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        ck_assert_int_eq(
            fibrad_surface_row(scene, &little, 0, &(fibrad_surface_rule){.cutoff = cases[k].periods * period}, &row),
            cases[k].status);

    /* one sphere has few enough images even at 100 periods: they need 144 bytes each, and what all rows need */
    bed.n = 1;
    make_scene(FIBRAD_ISA_BEST, true);
    const fibrad_surface_rule most = {.cutoff = 100 * period}, more = {.cutoff = 100.001 * period};
    ck_assert_int_eq(fibrad_surface_row(scene, &little, 0, &most, &row), FIBRAD_E_WORK);
    ck_assert_double_eq_tol((double)little.memory.needed, 4. / 3 * 3.14159265358979 * 1e6 * 144, 3e4 * 144 + 1e6);
    assert_invalid(fibrad_surface_row(scene, &little, 0, &more, &row));
}

TEST(refuses_what_is_wrong) {
    make(20, true);
    fibrad_row row = {.col = col, .f = f, .capacity = MOST, .length = 77};
    const fibrad_surface_rule good = {.cutoff = CUTOFF}, many = {.nodes = 54, .cutoff = CUTOFF},
                              negative = {.cutoff = -1};
    const fibrad_surface_rule flags = {.flags = 64, .cutoff = CUTOFF};
    assert_invalid(fibrad_surface_row(NULL, &work, 0, &good, &row));
    assert_invalid(fibrad_surface_row(scene, NULL, 0, &good, &row));
    assert_invalid(fibrad_surface_row(scene, &work, 20, &good, &row));
    assert_invalid(fibrad_surface_row(scene, &work, 0, &good, NULL));
    assert_invalid(fibrad_surface_row(scene, &work, 0, NULL, &row)); /* periodic, no cutoff */
    assert_invalid(fibrad_surface_row(scene, &work, 0, &negative, &row));
    assert_invalid(fibrad_surface_row(scene, &work, 0, &flags, &row));
    ck_assert_int_eq(fibrad_surface_row(scene, &work, 0, &many, &row), FIBRAD_E_TABLE);
    OWNED_BED one = BED({0, 0, 0, 1});
    const fibrad_wall floor_plane = plane_at(2, 0, -2);
    OWNED fibrad_scene *walled = scene_with(&one, &(fibrad_scene_config){.wall = &floor_plane, .walls = 1});
    double wall = -5;
    row.wall = &wall;
    ck_assert_int_eq(fibrad_surface_row(walled, &work, 0, NULL, &row), FIBRAD_E_UNSUPPORTED);
    ck_assert(wall == -5 && row.length == 77);
    /* a triangle that belongs to no wall */
    const double x[] = {-9, 9, 0}, y[] = {-9, -9, 9}, z[] = {2, 2, 2};
    const uint32_t corner[] = {0, 1, 2}, none = FIBRAD_NO_WALL;
    const fibrad_triangles triangle = {.x = x, .y = y, .z = z, .vertices = 3, .corner = corner, .front = &none, .n = 1};
    OWNED fibrad_scene *cut = scene_with(&one, &(fibrad_scene_config){.triangles = &triangle});
    ck_assert_int_eq(fibrad_surface_row(cut, &work, 0, NULL, &row), FIBRAD_E_UNSUPPORTED);
}
