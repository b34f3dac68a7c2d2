/* test_beam.c - beam rows against exact pairs, against symmetries of the problem, and against themselves under settings
 * that must not matter. SPDX-License-Identifier: MIT */
#include "papers/pair/reference.h"
#include "scenes.h"
#include "suite.h"

static fibrad_row beam(const struct bed *bed, uint32_t i, fibrad_beam_rule rule, int isa) {
    OWNED fibrad_scene *scene = scene_of(bed, isa);
    OWNED_WORK work = work_growing();
    fibrad_row row = row_of(bed->n);
    assert_ok(fibrad_beam_row(scene, &work, i, &rule, &row));
    ck_assert_uint_eq(row.sphere, i);
    return row;
}

/* Computes a row with the least fixed work memory that suffices. Each try asks for more. Returns the size of this
 * memory. */
static size_t beam_in_little(const fibrad_scene *scene, uint32_t i, const fibrad_beam_rule *rule, fibrad_row *row) {
    OWNED_FIXED work = work_fixed(NULL, 0);
    int status = FIBRAD_E_WORK, tries = 0;
    do {
        status = fibrad_beam_row(scene, &work, i, rule, row);
        ck_assert_int_lt(tries++, 40);
    } while (work_again(&work, status));
    assert_ok(status);
    const size_t size = work.memory.size;
    return size;
}

/* Computes the same row with a fixed block of a size that suffices. */
static void beam_in(size_t size, const fibrad_scene *scene, uint32_t i, const fibrad_beam_rule *rule, fibrad_row *row) {
    OWNED void *block = malloc(size);
    ck_assert_ptr_nonnull(block);
    fibrad_work work = work_fixed(block, size);
    assert_ok(fibrad_beam_row(scene, &work, i, rule, row));
}

TEST(two_spheres_match_the_exact_pair) {
    static const double cases[][3] = {{1, 1, 0},   {1, 1, .5}, {1, .3, 0}, {.3, 1, .1},
                                      {1, 3, .01}, {1, 10, 0}, {1, 1, 4}};
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        const double *p = cases[c];
        OWNED_BED bed = BED({0, 0, 0, p[0]}, {.3 * (p[0] + p[1] + p[2]), 0, .4 * (p[0] + p[1] + p[2]), p[1]});
        bed.y[1] = sqrt(.75) * (p[0] + p[1] + p[2]);
        double exact;
        assert_ok(fibrad_pair_exact(p[0], p[1], p[2], &exact));
        OWNED_ROW row = beam(&bed, 0, (fibrad_beam_rule){.directions = 4181}, FIBRAD_ISA_BEST);
        ck_assert_uint_eq(row.length, 1);
        ck_assert_double_eq_tol(row.f[0], exact, 3e-5);
    }
}

/* A sphere lies in line behind a larger one that hides it. It is not seen. */
TEST(hidden_sphere_is_not_seen) {
    OWNED_BED bed = BED({0, 0, 0, 1}, {0, 0, 4, 3}, {0, 0, 9, 1});
    OWNED_ROW row = beam(&bed, 0, (fibrad_beam_rule){.directions = 1000}, FIBRAD_ISA_BEST);
    ck_assert_uint_eq(row.length, 1);
    ck_assert_uint_eq(row.col[0], 1);
    OWNED_ROW hidden = beam(&bed, 2, (fibrad_beam_rule){.directions = 1000}, FIBRAD_ISA_BEST);
    ck_assert_uint_eq(hidden.length, 1);
}

/* Windows with discs far larger than the window are left to the robust method. Windows with hundreds of small discs
 * before a large one are not, nor are windows of beds. */
TEST(fallbacks_are_counted) {
    OWNED_BED bed = BED({0, 0, 0, 4});
    for (uint32_t k = 0; k < 1000; k++) {
        double w[3];
        fibrad_direction(k, 1000, w);
        add_sphere(&bed, 5 * w[0], 5 * w[1], 5 * w[2], .2);
    }
    OWNED_ROW row = beam(&bed, 0, (fibrad_beam_rule){.directions = 55}, FIBRAD_ISA_BEST);
    ck_assert_uint_eq(row.fallbacks, 0);
    ck_assert_double_eq_tol(row_sum(&row) + row.escaped, 1, 1e-12);
    OWNED_BED two = BED({0, 0, 0, 1}, {0, 0, -2002, 2000});
    OWNED_ROW beside_giant = beam(&two, 0, (fibrad_beam_rule){.directions = 55}, FIBRAD_ISA_BEST);
    ck_assert_uint_gt(beside_giant.fallbacks, 20);
    OWNED_ROW by_points = beam(&bed, 0, (fibrad_beam_rule){.directions = 55, .points = 64}, FIBRAD_ISA_BEST);
    ck_assert_uint_eq(by_points.fallbacks, 0);
    OWNED_BED unlike = packing(300, .5, 2, .5, 8, true);
    for (uint32_t i = 0; i < unlike.n; i += 30) {
        OWNED_ROW each = beam(&unlike, i, (fibrad_beam_rule){.directions = 55}, FIBRAD_ISA_BEST);
        ck_assert_uint_eq(each.fallbacks, 0);
    }
}

TEST(raw_rows_close) {
    struct bed beds[] = {packing(300, .8, 1.2, .55, 7, false), packing(300, .5, 2, .5, 8, true), lattice('p', 6),
                         lattice('i', 6), lattice('f', 6)};
    for (size_t b = 0; b < sizeof beds / sizeof *beds; b++) {
        for (uint32_t points = 0; points <= 256; points = points == 0 ? 64 : 2 * points) {
            for (uint32_t i = 0; i < beds[b].n; i += 17) {
                fibrad_beam_rule rule = {.directions = 144, .points = points};
                OWNED_ROW row = beam(&beds[b], i, rule, FIBRAD_ISA_BEST);
                for (uint32_t k = 0; k < row.length; k++) {
                    ck_assert_double_gt(row.f[k], 0);
                    ck_assert(k == 0 || row.col[k] > row.col[k - 1]);
                }
                if (points == 0) {
                    ck_assert_double_eq_tol(row_sum(&row) + row.escaped, 1, 1e-12);
                } else { /* each factor is a whole number of points */
                    double total = 144.0 * points, count = row.escaped * total;
                    for (uint32_t k = 0; k < row.length; k++) count += row.f[k] * total;
                    ck_assert_double_eq_tol(count, total, 1e-7);
                    ck_assert_double_eq_tol(row.f[0] * total, round(row.f[0] * total), 1e-9);
                }
            }
        }
        bed_free(&beds[b]);
    }
}

/* Finds what sphere i sees along w down to the depth `deepest`, by exact slicing of all discs in the order of their
 * depths. Adds the areas to seen[j]. */
static void slice(const struct bed *bed, uint32_t i, const double w[3], double deepest, double *seen) {
    double u[600], v[600], r[600], depth[600], area[600], rest, flat = sqrt(w[0] * w[0] + w[1] * w[1]);
    uint32_t sphere[600], n = 0;
    for (uint32_t j = 0; j < bed->n; j++) {
        double x = (bed->x[j] - bed->x[i]) / bed->r[i], y = (bed->y[j] - bed->y[i]) / bed->r[i];
        double z = (bed->z[j] - bed->z[i]) / bed->r[i], size = bed->r[j] / bed->r[i];
        double ahead = w[0] * x + w[1] * y + w[2] * z, across = (w[0] * y - w[1] * x) / flat;
        double up = flat * z - w[2] * (w[0] * x + w[1] * y) / flat;
        if (!(ahead > 0 && ahead <= deepest && across * across + up * up < (1 + size) * (1 + size))) continue;
        uint32_t to = n++;
        for (; to > 0 && depth[to - 1] > ahead; to--) {
            depth[to] = depth[to - 1], sphere[to] = sphere[to - 1];
            u[to] = u[to - 1], v[to] = v[to - 1], r[to] = r[to - 1];
        }
        depth[to] = ahead, sphere[to] = j, u[to] = across, v[to] = up, r[to] = size;
    }
    if (n == 0) return;
    ck_assert_int_eq(reference_window(n, u, v, r, area, &rest), REFERENCE_OK);
    for (uint32_t k = 0; k < n; k++) seen[sphere[k]] += area[k];
}

/* The rows match also where large spheres become known before small ones that lie in front of them. */
TEST(rows_match_sliced_windows) {
    struct bed beds[] = {packing(200, .05, 2, .05, 40, false),
                         packing(200, .5, 2, .3, 41, false),
                         strewn(600, 42),
                         strewn(600, 43),
                         strewn(600, 44),
                         packing(600, .8, 1.2, .01, 45, false)};
    for (size_t b = 0; b < sizeof beds / sizeof *beds; b++) {
        for (uint32_t i = 0; i < beds[b].n; i += 3) {
            double seen[600] = {0}, w[3];
            for (uint32_t k = 0; k < 34; k++) {
                assert_ok(fibrad_direction(k, 34, w));
                slice(&beds[b], i, w, INFINITY, seen);
            }
            OWNED_ROW row = beam(&beds[b], i, (fibrad_beam_rule){.directions = 34}, FIBRAD_ISA_BEST);
            for (uint32_t j = 0; j < beds[b].n; j++)
                ck_assert_double_eq_tol(row_factor(&row, j), seen[j] / (34 * acos(-1)), 1e-10);
        }
        bed_free(&beds[b]);
    }
}

/* The box of the grid has no extent across a layer of spheres, and strays lie beside it. No near spheres are kept. */
TEST(strays_beside_a_layer) {
    OWNED_BED bed = bed_empty();
    for (int k = 0; k < 49; k++) add_sphere(&bed, 0, 3 * (k % 7) + .1 * (k / 7), 3 * (k / 7), 1);
    add_sphere(&bed, 40, 9, 8, 2);
    add_sphere(&bed, -60, 7, 11, 3);
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    const fibrad_beam_rule rule = {.directions = 2000};
    for (uint32_t i = 3; i < bed.n; i += 4) {
        double seen[600] = {0}, w[3], strays = 0;
        for (uint32_t k = 0; k < rule.directions; k++) {
            assert_ok(fibrad_direction(k, rule.directions, w));
            slice(&bed, i, w, INFINITY, seen);
        }
        OWNED_ROW row = row_of(bed.n);
        beam_in_little(scene, i, &rule, &row);
        for (uint32_t j = 0; j < bed.n; j++)
            ck_assert_double_eq_tol(row_factor(&row, j), seen[j] / (rule.directions * acos(-1)), 1e-10);
        for (uint32_t j = 49; j < bed.n; j++) strays += row_factor(&row, j);
        ck_assert_double_gt(strays, 0);
    }
}

TEST(points_agree_with_areas) {
    OWNED_BED bed = packing(300, .8, 1.2, .55, 7, true);
    double square = 0;
    for (uint32_t i = 0; i < 20; i++) {
        OWNED_ROW exact = beam(&bed, i, (fibrad_beam_rule){.directions = 2000}, FIBRAD_ISA_BEST);
        OWNED_ROW points = beam(&bed, i, (fibrad_beam_rule){.directions = 2000, .points = 256}, FIBRAD_ISA_BEST);
        square += pow(row_distance(&exact, &points), 2);
    }
    ck_assert_double_lt(sqrt(square / 20), 5e-4);
}

/* The order of the spheres changes nothing, although a window that begins with many discs of two sizes has a grid that
 * their mean radius chooses. */
TEST(order_of_spheres_changes_no_bit) {
    OWNED_BED bed = BED({0, 0, 0, 1}), turned = bed_empty();
    for (int k = 0; k < 13 * 13 * 13; k++) {
        double x = .32 * (k % 13 - 6) + .003 * (k % 7), y = .32 * (k / 13 % 13 - 6) + .002 * (k % 11);
        double z = .32 * (k / 169 - 6) + .004 * (k % 5), d = sqrt(x * x + y * y + z * z);
        if (d > 1.2 && d < 1.9) add_sphere(&bed, x, y, z, k % 2 == 0 ? .1 : .15);
    }
    for (uint32_t i = bed.n; i-- > 0;) add_sphere(&turned, bed.x[i], bed.y[i], bed.z[i], bed.r[i]);
    const uint32_t last = bed.n - 1;
    const fibrad_beam_rule rule = {.directions = 200};
    OWNED_ROW row = beam(&bed, 0, rule, FIBRAD_ISA_BEST), other = beam(&turned, last, rule, FIBRAD_ISA_BEST);
    ck_assert_uint_eq(row.length, other.length);
    for (uint32_t k = 0; k < row.length; k++) {
        ck_assert_uint_eq(row.col[k], last - other.col[row.length - 1 - k]);
        ck_assert_double_eq(row.f[k], other.f[row.length - 1 - k]);
    }
}

TEST(scaling_by_powers_of_two_changes_no_bit) {
    OWNED_BED bed = packing(200, .8, 1.2, .5, 5, true), scaled = packing(200, .8, 1.2, .5, 5, true);
    OWNED_ROW row = beam(&bed, 11, (fibrad_beam_rule){.directions = 233, .cutoff = 9}, FIBRAD_ISA_BEST);
    for (int k = -400; k <= 400; k += 100) {
        scale_bed(&scaled, &bed, k);
        OWNED_ROW other =
            beam(&scaled, 11, (fibrad_beam_rule){.directions = 233, .cutoff = ldexp(9, k)}, FIBRAD_ISA_BEST);
        ck_assert(same_bits(&row, &other));
    }
}

/* A translation or a permutation changes nothing but the rounding of the coordinates. A rotation changes how the
 * directions lie. This gives two estimates of the same row, each within the rule's error. */
TEST(moved_beds_have_the_same_rows) {
    OWNED_BED bed = packing(200, .8, 1.2, .5, 5, false), moved = packing(200, .8, 1.2, .5, 5, false);
    fibrad_beam_rule rule = {.directions = 2000};
    uint32_t last = bed.n - 1;
    for (uint32_t i = 0; i <= last; i++)
        moved.x[i] = bed.x[i] + 1000, moved.y[i] = bed.y[i] - 300, moved.z[i] = bed.z[i] + .7;
    OWNED_ROW row = beam(&bed, 42, rule, FIBRAD_ISA_BEST), translated = beam(&moved, 42, rule, FIBRAD_ISA_BEST);
    ck_assert_double_lt(row_distance(&row, &translated), 1e-11);

    for (uint32_t i = 0; i <= last; i++) {
        uint32_t to = last - i;
        moved.x[to] = bed.x[i], moved.y[to] = bed.y[i], moved.z[to] = bed.z[i], moved.r[to] = bed.r[i];
    }
    OWNED_ROW permuted = beam(&moved, last - 42, rule, FIBRAD_ISA_BEST);
    ck_assert_uint_eq(row.length, permuted.length);
    for (uint32_t k = 0; k < row.length; k++)
        ck_assert_double_eq_tol(row.f[k], row_factor(&permuted, last - row.col[k]), 1e-14);

    double c = cos(.6), s = sin(.6);
    for (uint32_t i = 0; i <= last; i++) {
        double x = c * bed.x[i] - s * bed.y[i], y = s * bed.x[i] + c * bed.y[i];
        moved.x[i] = x, moved.y[i] = c * y - s * bed.z[i], moved.z[i] = s * y + c * bed.z[i], moved.r[i] = bed.r[i];
    }
    OWNED_ROW rotated = beam(&moved, 42, rule, FIBRAD_ISA_BEST);
    ck_assert_double_lt(row_distance(&row, &rotated), 3e-4);
}

/* A periodic box gives the same as the box with copies all around. Images of one sphere share its entry. */
TEST(periodic_images_are_copies) {
    OWNED_BED bed = packing(60, .8, 1.2, .5, 9, true), copies = packing(60, .8, 1.2, .5, 9, false);
    double side = bed.period[0];
    uint32_t n = bed.n;
    for (int a = -3; a <= 3; a++)
        for (int b = -3; b <= 3; b++)
            for (int c = -3; c <= 3; c++)
                for (uint32_t i = 0; i < n && (a != 0 || b != 0 || c != 0); i++)
                    add_sphere(&copies, bed.x[i] + a * side, bed.y[i] + b * side, bed.z[i] + c * side, bed.r[i]);
    fibrad_beam_rule rule = {.directions = 233, .cutoff = 2.5 * side};
    for (uint32_t i = 0; i < n; i += 13) {
        OWNED_ROW one = beam(&bed, i, rule, FIBRAD_ISA_BEST), all = beam(&copies, i, rule, FIBRAD_ISA_BEST);
        OWNED double *sum = calloc(n, sizeof *sum);
        for (uint32_t k = 0; k < all.length; k++) sum[all.col[k] % n] += all.f[k];
        for (uint32_t j = 0; j < n; j++) ck_assert_double_eq_tol(row_factor(&one, j), sum[j], 1e-12);
        ck_assert_double_eq_tol(one.escaped, all.escaped, 1e-12);
    }
}

/* A lone sphere in a small periodic box sees only itself. */
TEST(sphere_sees_its_own_images) {
    OWNED_BED bed = BED({.5, .5, .5, 1});
    for (int axis = 0; axis < 3; axis++) bed.period[axis] = 2;
    OWNED_ROW row = beam(&bed, 0, (fibrad_beam_rule){.directions = 500}, FIBRAD_ISA_BEST);
    ck_assert_uint_eq(row.length, 1);
    ck_assert_double_eq_tol(row.f[0] + row.escaped, 1, 1e-12);
    ck_assert_double_gt(row.f[0], .99);
}

TEST(cutoff_takes_out_what_lies_beyond) {
    OWNED_BED bed = lattice('f', 8), within = lattice('f', 4);
    OWNED_ROW cut = beam(&bed, 0, (fibrad_beam_rule){.cutoff = 4}, FIBRAD_ISA_BEST);
    OWNED_ROW row = beam(&within, 0, (fibrad_beam_rule){0}, FIBRAD_ISA_BEST);
    ck_assert_uint_eq(cut.length, row.length);
    ck_assert_double_eq_tol(cut.escaped + cut.beyond, row.escaped, 1e-14);
    ck_assert_double_eq_tol(row_sum(&cut), row_sum(&row), 1e-14);
}

/* The cutoff is kept also where spheres are looked up along each beam, because the near list has no room. */
TEST(cutoff_along_each_beam) {
    OWNED_BED bed = strewn(300, 45), within = bed_empty();
    for (uint32_t j = 0; j < bed.n; j++) {
        double x = bed.x[j] - bed.x[50], y = bed.y[j] - bed.y[50], z = bed.z[j] - bed.z[50];
        if (x * x + y * y + z * z <= .3 * .3) add_sphere(&within, bed.x[j], bed.y[j], bed.z[j], bed.r[j]);
    }
    uint32_t own = 0;
    while (within.x[own] != bed.x[50]) own++;
    OWNED_ROW row = beam(&within, own, (fibrad_beam_rule){.directions = 200}, FIBRAD_ISA_BEST);
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    const fibrad_beam_rule rule = {.directions = 200, .cutoff = .3};
    size_t size = 0;
    for (int room = 0; room < 3; room++) {
        OWNED_ROW cut = row_of(bed.n);
        if (room == 0)
            size = beam_in_little(scene, 50, &rule, &cut);
        else
            beam_in(size * (room == 1 ? 3 : 50), scene, 50, &rule, &cut);
        ck_assert_uint_gt(cut.length, 10);
        ck_assert_uint_eq(cut.length, row.length);
        ck_assert_double_eq_tol(cut.escaped + cut.beyond, row.escaped, 1e-12);
        for (uint32_t k = 0; k < row.length; k++) {
            ck_assert_double_eq(bed.x[cut.col[k]], within.x[row.col[k]]);
            ck_assert_double_eq_tol(cut.f[k], row.f[k], 1e-12);
        }
    }
}

/* If contacts overlap a little, their rows differ little from those of contacts that do not. */
TEST(overlap_changes_rows_continuously) {
    double last = -1;
    for (int step = -20; step <= 20; step++) {
        double gap = step * 1e-4;
        OWNED_BED bed = BED({0, 0, 0, 1}, {0, 0, 2 + gap, 1}, {0, 1.8, 1 + gap, 1});
        OWNED_ROW row = beam(&bed, 0, (fibrad_beam_rule){.directions = 987}, FIBRAD_ISA_BEST);
        double f = row_factor(&row, 1);
        if (last >= 0) ck_assert_double_eq_tol(f, last, 3e-4);
        last = f;
    }
}

/* Two spheres that overlap lie side by side across a beam, to the bit. One of them comes before the other's window and
 * not the other way round, as if it were a hair's breadth ahead. It sees the lens that the two discs have in common. */
TEST(spheres_at_equal_depth_are_seen_once) {
    for (uint32_t k = 4; k < 12; k++) {
        double w[3], sum[3], lens = 0;
        assert_ok(fibrad_direction(k, 34, w));
        for (int side = -1; side <= 1; side++) {
            double ahead = 1e-9 * side, f[2];
            OWNED_BED bed = BED({0, 0, 0, .5}, {w[1] + ahead * w[0], ahead * w[1] - w[0], ahead * w[2], .5});
            for (uint32_t i = 0; i < 2; i++) {
                OWNED_ROW row = beam(&bed, i, (fibrad_beam_rule){.directions = 34}, FIBRAD_ISA_BEST);
                f[i] = row_factor(&row, 1 - i);
            }
            sum[side + 1] = f[0] + f[1];
            lens += side * (f[0] - f[1]) / 2;
        }
        double apart = sqrt(w[0] * w[0] + w[1] * w[1]), area = 2 * acos(apart) - 2 * apart * fabs(w[2]);
        ck_assert_double_eq_tol(lens, area / (34 * acos(-1)), 1e-7);
        ck_assert_double_eq_tol(sum[1], sum[0], 1e-7);
        ck_assert_double_eq_tol(sum[1], sum[2], 1e-7);
    }
}

/* A sphere with six neighbours needs room for six entries. Room for five is too little. */
TEST(a_row_needs_an_entry_for_every_sphere_seen) {
    OWNED_BED bed = lattice('p', 2);
    ck_assert_uint_eq(bed.n, 7);
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    OWNED_WORK work = work_growing();
    for (uint32_t entries = 0; entries <= 7; entries++)
        for (int rays = 0; rays < 2; rays++) {
            OWNED_ROW row = row_of(bed.n);
            for (uint32_t k = 0; k < bed.n; k++) row.col[k] = 99, row.f[k] = -1;
            row.capacity = entries;
            ck_assert_int_eq(rays ? fibrad_cast_row(scene, &work, 0, NULL, &row, NULL)
                                  : fibrad_beam_row(scene, &work, 0, NULL, &row),
                             entries < 6 ? FIBRAD_E_CAPACITY : FIBRAD_OK);
            ck_assert_uint_eq(row.length, 6);
            for (uint32_t k = entries < 6 ? 0 : 6; k < bed.n; k++) ck_assert(row.col[k] == 99 && row.f[k] == -1);
        }
}

/* A sphere far beyond the others is large enough to be seen. Then only its direction and its angle matter, not its
 * distance. A small sphere there changes nothing. */
TEST(strays_are_seen_however_far) {
    OWNED_BED bed = packing(60, .8, 1.2, .5, 3, false);
    fibrad_beam_rule rule = {.directions = 50};
    OWNED_ROW alone = beam(&bed, 7, rule, 0);
    add_sphere(&bed, 0, 0, 0, 1);
    const uint32_t stray = bed.n - 1;
    for (int k = 0; k < 27; k++) {
        double way[3] = {k % 3 - 1, k / 3 % 3 - 1 + .1, k / 9 - 1 + .01}, first = -1;
        for (double far = 1e4; far < 1e13; far *= 1e4) {
            bed.x[stray] = far * way[0], bed.y[stray] = far * way[1], bed.z[stray] = far * way[2];
            bed.r[stray] = far * .05;
            OWNED_ROW seen = beam(&bed, 7, rule, 0);
            if (first < 0) first = row_factor(&seen, stray);
            ck_assert_double_eq_tol(row_factor(&seen, stray), first, 2e-3);
            ck_assert_double_eq_tol(row_sum(&seen) + seen.escaped, 1, 1e-12);
            bed.r[stray] = 1;
            if (far < 1e8) continue;
            OWNED_ROW small = beam(&bed, 7, rule, 0);
            ck_assert(same_bits(&small, &alone));
        }
    }
}

/* Beams meet strays where they walk outside the grid, with and without periods across. */
TEST(strays_are_met_on_the_way) {
    const fibrad_beam_rule rule = {.directions = 2000};
    for (int periods = 0; periods < 3; periods++) {
        OWNED_BED bed = packing(60, .8, 1.2, .5, 3, true);
        const double side = bed.period[0];
        for (int axis = periods; axis < 3; axis++) bed.period[axis] = 0;
        for (int k = 0; k < 4; k++)
            add_sphere(&bed, periods > 0 ? 0 : side * (3 * k - 4), periods > 1 ? side / 2 : side * (5 - 4 * k),
                       side * (k % 2 ? 3 + k : -2 - 2 * k), 1);
        OWNED fibrad_scene *scene = scene_of(&bed, 0);
        OWNED_WORK more = work_growing();
        uint32_t strays_seen = 0;
        for (uint32_t i = 50; i < bed.n; i++) {
            OWNED_ROW a = row_of(bed.n), b = row_of(bed.n);
            beam_in_little(scene, i, &rule, &a);
            assert_ok(fibrad_beam_row(scene, &more, i, &rule, &b));
            ck_assert(same_bits(&a, &b));
            strays_seen += a.length > 0 && a.col[a.length - 1] >= 60;
        }
        ck_assert_uint_gt(strays_seen, 3);
    }
}

/* Beams meet no sphere that is deeper than 100 periods, although they look farther ahead at once. */
TEST(beams_end_after_100_periods) {
    const fibrad_beam_rule rule = {.directions = 4000};
    const double period = 3;
    OWNED_BED bed = BED({0, 0, 0, 1}), copies = bed_empty();
    for (int k = 0; k < 12; k++)
        add_sphere(&bed, .2 * k, (60 + 15 * k) * cos(2.4 * k), (60 + 15 * k) * sin(2.4 * k), 1);
    for (int image = 0; image <= 400; image++) /* the image is 0, -1, 1, -2, 2 ... periods away */
        for (uint32_t j = 0; j < bed.n; j++)
            add_sphere(&copies, bed.x[j] + (image % 2 ? -1 : 1) * ((image + 1) / 2) * period, bed.y[j], bed.z[j], 1);
    double *seen = calloc(copies.n, sizeof *seen), w[3];
    ck_assert_ptr_nonnull(seen);
    for (uint32_t k = 0; k < rule.directions; k++) {
        assert_ok(fibrad_direction(k, rule.directions, w));
        slice(&copies, 0, w, 100 * period / fabs(w[0]), seen);
    }
    for (uint32_t j = bed.n; j < copies.n; j++) seen[j % bed.n] += seen[j];
    bed.period[0] = period;
    OWNED_ROW row = beam(&bed, 0, rule, FIBRAD_ISA_BEST);
    for (uint32_t j = 0; j < bed.n; j++)
        ck_assert_double_eq_tol(row_factor(&row, j), seen[j] / (rule.directions * acos(-1)), 1e-10);
    free(seen);
}

TEST(bad_arguments_are_refused) {
    OWNED_BED bed = lattice('p', 3);
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    OWNED_WORK work = work_growing();
    OWNED_ROW row = row_of(bed.n);
    row.length = 77;
    assert_invalid(fibrad_beam_row(NULL, &work, 0, NULL, &row));
    assert_invalid(fibrad_beam_row(scene, NULL, 0, NULL, &row));
    assert_invalid(fibrad_beam_row(scene, &work, 0, NULL, NULL));
    assert_invalid(fibrad_beam_row(scene, &work, bed.n, NULL, &row));
    assert_invalid(fibrad_beam_row(scene, &work, UINT32_MAX, NULL, &row));
    static const fibrad_beam_rule bad[] = {{.directions = 7}, {.directions = 65537}, {.cutoff = -1},
                                           {.cutoff = NAN},   {.tolerance = -1},     {.tolerance = NAN}};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++)
        assert_invalid(fibrad_beam_row(scene, &work, 0, &bad[k], &row));
    ck_assert_int_eq(fibrad_beam_row(scene, &work, 0, &(fibrad_beam_rule){.points = 100}, &row), FIBRAD_E_TABLE);
    ck_assert_uint_eq(row.length, 77);
    fibrad_row arrays = row;
    arrays.col = NULL;
    assert_invalid(fibrad_beam_row(scene, &work, 0, NULL, &arrays));
    arrays = row, arrays.f = NULL;
    assert_invalid(fibrad_beam_row(scene, &work, 0, NULL, &arrays));
    arrays = row, arrays.wall = NULL; /* there are none */
    assert_ok(fibrad_beam_row(scene, &work, 0, NULL, &arrays));
}
