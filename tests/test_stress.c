/* test_stress.c - attempts to break the numerics: distance from the origin, contact, ratio of radii, obstacles,
 * random scenes by the million. SPDX-License-Identifier: MIT
 *
 * `make test` runs a part of each attack, and `make stress` (STRESS=1 in the environment) runs all. One line for each
 * attack tells the worst error that was seen and the tolerance. */
#include <stdio.h>

#include "scenes.h"
#include "suite.h"

static bool all(void) { return getenv("STRESS") != NULL; }

static uint64_t rounds(uint64_t some, uint64_t many) { return all() ? many : some; }

static void report(const char *attack, double worst, double bound) {
    printf("%-66s %8.2g  (bound %.2g)\n", attack, worst, bound);
    fflush(stdout);
    ck_assert_msg(worst <= bound, "%s: %g exceeds %g", attack, worst, bound); /* false for NaN */
}

static double random_in(uint64_t seed, double low, double high) {
    static uint64_t count[16];
    return low + (high - low) * bed_make_random(seed, count[seed % 16]++);
}

static double exact(double r1, double r2, double gap) {
    double f = -1;
    assert_ok(fibrad_pair_exact(r1, r2, gap, &f));
    return f;
}

static fibrad_row beam(const struct bed *bed, uint32_t i, uint32_t directions) {
    OWNED fibrad_scene *scene = scene_of(bed, FIBRAD_ISA_BEST);
    OWNED_WORK work = work_growing();
    fibrad_row row = row_of(bed->n);
    assert_ok(fibrad_beam_row(scene, &work, i, &(fibrad_beam_rule){.directions = directions}, &row));
    return row;
}

static double closure(const fibrad_row *row) { return fabs(row_sum(row) + row->escaped - 1); }

static void move(struct bed *to, const struct bed *from, double factor, const double shift[3]) {
    for (uint32_t i = 0; i < from->n; i++) {
        to->x[i] = factor * from->x[i] + shift[0], to->y[i] = factor * from->y[i] + shift[1];
        to->z[i] = factor * from->z[i] + shift[2], to->r[i] = factor * from->r[i];
    }
}

/* ---- scale and place -------------------------------------------------------------------------------------------- */

/* The coordinates of a moved bed are rounded. The rounded bed is moved back without a further rounding. Its row tells
 * how much of the loss is the kernel's own. */
TEST(rows_far_from_the_origin) {
    for (int e = 3; e <= 9; e += 2) {
        double offset = pow(10, e), own = 0, loss = 0, away[3] = {offset, -.7 * offset, .3 * offset};
        double back[3] = {-away[0], -away[1], -away[2]};
        for (uint64_t seed = 0; seed < rounds(2, 20); seed++) {
            OWNED_BED bed = packing(100, .5, 1.5, .5, 30 + seed, false), far = packing(100, .5, 1.5, .5, 1, false);
            OWNED_BED rounded = packing(100, .5, 1.5, .5, 1, false);
            move(&far, &bed, 1, away);
            move(&rounded, &far, 1, back);
            memcpy(rounded.r, bed.r, bed.n * sizeof *bed.r), memcpy(far.r, bed.r, bed.n * sizeof *bed.r);
            OWNED_ROW here = beam(&bed, 7, 100), there = beam(&far, 7, 100), same = beam(&rounded, 7, 100);
            worst_of(&own, row_distance(&there, &same));
            worst_of(&loss, row_distance(&there, &here));
        }
        report(formatted("rows 1e%d radii from the origin: beyond rounding of coordinates", e), own, 1e-14);
        report(formatted("rows 1e%d radii from the origin: in all", e), loss, 4 * 0x1p-52 * offset);
    }
}

/* ---- contact ---------------------------------------------------------------------------------------------------- */

/* The same holds for beams: in each direction the disc moves out as the gap grows. */
TEST(beams_across_contact) {
    double rise = 0, jump = 0;
    for (uint64_t seed = 0; seed < rounds(2, 20); seed++) {
        double r2 = pow(10, random_in(2, -.7, .7)), t = random_in(2, 0, 1), p = random_in(2, 0, 6.28);
        double w[3] = {sqrt(1 - t * t) * cos(p), sqrt(1 - t * t) * sin(p), t}, last = 0, last_gap = 0;
        for (int k = -1000; k <= 1000; k++) {
            double gap = (k < 0 ? -1 : 1) * fmin(1, r2) * .5 * pow(abs(k) / 1000.0, 5), d = 1 + r2 + gap;
            OWNED_BED bed = BED({0, 0, 0, 1}, {d * w[0], d * w[1], d * w[2], r2});
            OWNED_ROW row = beam(&bed, 0, 144);
            double f = row_factor(&row, 1);
            if (k > -1000) {
                worst_of(&rise, f - last);
                worst_of(&jump, last - f - 2 * fmin(1, r2) * (gap - last_gap));
            }
            last = f, last_gap = gap;
        }
    }
    report("beams across contact, overlap .5 to gap .5: F rises by", rise, 1e-15);
    report("beams across contact: F jumps by", jump, 1e-15);
}

TEST(radius_ratios) {
    double reciprocity = 0, from_small = 0, from_large = 0, open = 0;
    for (int e = -60; e <= 60; e += all() ? 1 : 10) {
        double r2 = pow(10, e / 10.0);
        for (int g = -12; g <= 12; g += 3) {
            double gap = pow(10, g), there = exact(1, r2, gap), back = r2 * r2 * exact(r2, 1, gap);
            worst_of(&reciprocity, fabs(there / back - 1));
        }
        double gap = .1 * fmin(1, r2), d = 1 + r2 + gap;
        OWNED_BED bed = BED({0, 0, 0, 1}, {.48 * d, .6 * d, .64 * d, r2});
        double truth = exact(1, r2, gap);
        OWNED_ROW row = beam(&bed, 0, 2000);
        if (r2 >= 1)
            worst_of(&from_small, fabs(row_factor(&row, 1) - truth));
        else
            worst_of(&from_large, fabs(row_factor(&row, 1) - truth));
        worst_of(&open, closure(&row));
    }
    report("radius ratios 1e-6 ... 1e6, pairs: r1^2 F12 / r2^2 F21 - 1", reciprocity, 1e-14);
    report("radius ratios 1 ... 1e6, beams from the smaller sphere: F", from_small, 3e-3);
    report("radius ratios 1 ... 1e6, beams from the larger sphere: F", from_large, 1e-4);
    report("radius ratios 1e-6 ... 1e6: sum + escaped - 1", open, 1e-12);
}

/* ---- obstacles -------------------------------------------------------------------------------------------------- */

/* An obstacle moves across a pair. F is never negative and never above the free F. It changes by no more than the area
 * over which the obstacle's edge sweeps, 2 r/pi per step and unit area. */
TEST(obstacle_across_a_pair) {
    double negative = 0, above = 0, jump = 0, left = 0;
    for (uint64_t seed = 0; seed < rounds(3, 30); seed++) {
        double r2 = random_in(5, .3, 2), gap = random_in(5, 1.2, 3), r = random_in(5, .05, .5),
               y = random_in(5, -.7, .7);
        OWNED_BED pair = BED({0, 0, 0, 1}, {0, 0, 1 + r2 + gap, r2});
        fibrad_row row = beam(&pair, 0, 233);
        double without = row_factor(&row, 1), last = without, step = all() ? 1e-3 : 1e-2;
        row_free(&row);
        for (double x = -6; x <= 6; x += step) {
            OWNED_BED bed = BED({0, 0, 0, 1}, {0, 0, 1 + r2 + gap, r2}, {x, y, 1 + gap / 2, r});
            row = beam(&bed, 0, 233);
            double f = row_factor(&row, 1);
            worst_of(&negative, -f);
            worst_of(&above, f - without);
            worst_of(&jump, fabs(f - last) - 2 * r * step);
            last = f;
            row_free(&row);
        }
        worst_of(&left, fabs(last - without));
    }
    report("obstacle across a pair: F below 0 by", negative, 0);
    report("obstacle across a pair: F above the free F by", above, 1e-14);
    report("obstacle across a pair: F jumps by", jump, 1e-14);
    report("obstacle gone: F differs from the free F by", left, 1e-14);
}

/* ---- random scenes ---------------------------------------------------------------------------------------------- */

struct seen {
    double nonsense, closure, sum, averaged; /* factors that are not positive numbers; the worst of the others */
    double closed, total, reciprocity;       /* of the matrix */
    double other_bits;                       /* rows that depend on how many spheres are kept near */
    uint64_t scenes, refused;
};

static double uniform(void) { return random_in(6, 0, 1); }

/* Computes a row by beams with the least fixed memory so far, which has room for few near spheres. False: the row needs
 * more than this test has. */
static bool in_little(const fibrad_scene *scene, fibrad_work *bare, uint32_t i, const fibrad_beam_rule *rule,
                      fibrad_row *row) {
    for (int tries = 0; tries < 40; tries++) {
        const int status = fibrad_beam_row(scene, bare, i, rule, row);
        if (status == FIBRAD_OK) return true;
        ck_assert_int_eq(status, FIBRAD_E_WORK);
        if (bare->memory.needed > 4u << 20) return false; /* in a periodic box a window may have thousands of discs */
        work_again(bare, status);
    }
    ck_abort_msg("work memory asked for again and again");
    return false;
}

/* Computes a row by beams and one by rays, once with plenty of work memory and once with little. */
static void try_near(struct seen *seen, const fibrad_scene *scene, uint32_t i, uint32_t n, fibrad_work *work,
                     fibrad_work *bare) {
    fibrad_beam_rule rule = {.directions = 13, .points = uniform() < .5 ? 64 : 0};
    fibrad_cast_rule rays = {.rays = 100, .seed = seen->scenes, .random = uniform() < .5};
    uint32_t col[2][9];
    double f[2][9], length[2][9], angle[2][9];
    fibrad_row a = {.col = col[0], .f = f[0], .capacity = n}, b = {.col = col[1], .f = f[1], .capacity = n};
    if (in_little(scene, bare, i, &rule, &b)) {
        assert_ok(fibrad_beam_row(scene, work, i, &rule, &a));
        seen->other_bits += !same_bits(&a, &b);
    }
    assert_ok(fibrad_cast_row(scene, work, i, &rays, &a, &(fibrad_cast_means){length[0], angle[0]}));
    assert_ok(fibrad_cast_row(scene, bare, i, &rays, &b, &(fibrad_cast_means){length[1], angle[1]}));
    seen->other_bits += !same_bits(&a, &b);
    worst_of(&seen->closure, closure(&a));
    for (uint32_t k = 0; k < a.length; k++) {
        seen->nonsense +=
            !(a.f[k] > 0 && a.f[k] <= 1 && length[0][k] >= 0 && angle[0][k] >= 0 && angle[0][k] <= 1.5708);
        seen->other_bits += length[0][k] != length[1][k] || angle[0][k] != angle[1][k];
    }
}

/* Makes two to nine spheres: apart, touching, overlapping, in line, of all sizes, in boxes with some periodic axes. */
static void random_scene(struct seen *seen, void *scene_memory, size_t scene_size, fibrad_work *work,
                         fibrad_work *bare) {
    static unsigned char matrix_memory[16384], rows_memory[16384];
    double x[9], y[9], z[9], r[9], col_f[9], side = 1 + 5 * uniform();
    uint32_t n = 2 + (uint32_t)(8 * uniform()), col[9];
    fibrad_rows rows = {.memory = {.block = rows_memory, .size = sizeof rows_memory}};
    double spread = pow(10, 1.5 * uniform() * uniform());
    bool grid = uniform() < .2;
    for (uint32_t i = 0; i < n; i++) {
        x[i] = side * uniform(), y[i] = side * uniform(), z[i] = side * uniform();
        if (grid) x[i] = floor(x[i]), y[i] = floor(y[i]), z[i] = floor(z[i]);
        r[i] = grid ? .5 : .5 * pow(spread, uniform() - .5);
    }
    if (uniform() < .2) r[0] = pow(10, 6 * uniform() - 3);
    fibrad_scene_config config = {0};
    for (int axis = 0; axis < 3; axis++)
        if (uniform() < .15) config.period[axis] = side;
    fibrad_scene *scene;
    int status = fibrad_scene_init(&scene, scene_memory, scene_size, &config,
                                   &(fibrad_spheres){.x = x, .y = y, .z = z, .r = r, .n = n}, NULL);
    seen->scenes += status == FIBRAD_OK, seen->refused += status != FIBRAD_OK;
    if (status != FIBRAD_OK) {
        ck_assert_int_eq(status, FIBRAD_E_GEOMETRY);
        return;
    }
    try_near(seen, scene, (uint32_t)(n * uniform()), n, work, bare);
    fibrad_beam_rule rule = {.directions = 8 + (uint32_t)(13 * uniform())};
    for (uint32_t i = 0; i < n; i++) {
        fibrad_row row = {.col = col, .f = col_f, .capacity = 9};
        assert_ok(fibrad_beam_row(scene, work, i, &rule, &row));
        assert_ok(fibrad_rows_add(&rows, &row, 0));
        for (uint32_t k = 0; k < row.length; k++) seen->nonsense += !(row.f[k] > 0 && row.f[k] <= 1 + 1e-12);
        seen->nonsense += !(row.escaped >= -1e-15 && row.error >= 0);
        worst_of(&seen->closure, closure(&row));
        worst_of(&seen->sum, row_sum(&row) - 1);
    }
    fibrad_matrix *matrix;
    fibrad_factors raw, closed;
    double largest;
    assert_ok(fibrad_matrix_init(&matrix, matrix_memory, sizeof matrix_memory, scene, &rows, 1,
                                 &(fibrad_matrix_rule){.raw = 1}, NULL));
    assert_ok(fibrad_matrix_close(matrix));
    assert_ok(fibrad_matrix_read(matrix, &raw));
    for (uint32_t i = 0; i < n; i++) { /* the sum of the mean */
        double sum = 0;
        for (uint32_t j = 0; j < n; j++)
            sum += (matrix_factor(&raw, i, j) + r[j] / r[i] * (r[j] / r[i]) * matrix_factor(&raw, j, i)) / 2;
        worst_of(&seen->averaged, sum - 1);
    }
    assert_ok(fibrad_matrix_init(&matrix, matrix_memory, sizeof matrix_memory, scene, &rows, 1, NULL, NULL));
    assert_ok(fibrad_matrix_close(matrix));
    assert_ok(fibrad_matrix_read(matrix, &closed));
    assert_ok(fibrad_matrix_reciprocity(matrix, &largest));
    worst_of(&seen->reciprocity, largest);
    for (uint32_t i = 0; i < n; i++) {
        worst_of(&seen->closed, matrix_sum(&closed, i) - 1);
        worst_of(&seen->total, fabs(matrix_total(&closed, i) - 1));
        for (uint64_t k = closed.start[i]; k < closed.start[i + 1]; k++)
            seen->nonsense += !(closed.f[k] > 0 && closed.f[k] <= 1 + 1e-15);
        seen->nonsense += !(closed.escaped[i] >= 0 && closed.error[i] >= 0);
    }
}

TEST(random_scenes) {
    struct seen seen = {0};
    size_t size = FIBRAD_SCENE_BYTES(9);
    void *memory = block_of(size);
    fibrad_work work = work_growing(), bare = work_fixed(NULL, 0);
    for (uint64_t wanted = rounds(10000, 1000000); seen.scenes < wanted;)
        random_scene(&seen, memory, size, &work, &bare);
    free(memory);
    work_free(&work);
    work_free_fixed(&bare);
    printf("%llu random scenes (and %llu refused)\n", (unsigned long long)seen.scenes,
           (unsigned long long)seen.refused);
    report("random scenes: factors that are negative, NaN or above 1", seen.nonsense, 0);
    report("random scenes: rows that differ with the work memory", seen.other_bits, 0);
    report("random scenes: sum + escaped - 1", seen.closure, 1e-12);
    report("random scenes: raw row sums above 1 by", seen.sum, 1e-12);
    report("random scenes: averaged row sums above 1 by", seen.averaged, 1e-12);
    report("random scenes: closed row sums above 1 by", seen.closed, 1e-14);
    report("random scenes: closed matrices, sum + escaped - 1", seen.total, 1e-14);
    report("random scenes: closed matrices, reciprocity", seen.reciprocity, 1e-14);
}
