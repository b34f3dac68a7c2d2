/* test_estimate.c - rows are as accurate as they claim, and as accurate as the caller asks.
 * SPDX-License-Identifier: MIT */
#include "bed/bed_scene.h"
#include "host_owned.h"
#include "scenes.h"
#include "suite.h"

enum { ROWS = 16 };

static struct bed random_bed(void) { return packing(200, .8, 1.2, .5, 3, true); }
static struct bed sparse_bed(void) { return packing(100, .8, 1.2, .05, 3, false); }
static struct bed unequal_bed(void) { return packing(200, .25, 1, .45, 4, false); }
static struct bed cubic_bed(void) { return lattice('p', 6); }

static const struct {
    const char *name;
    struct bed (*make)(void);
} beds[] = {{"random", random_bed}, {"sparse", sparse_bed}, {"sizes 1:4", unequal_bed}, {"cubic", cubic_bed}};
enum { BEDS = sizeof beds / sizeof *beds };

static fibrad_bed_matrix *rows(const struct bed *bed, const fibrad_beam_rule *rule, bool raw,
                               const unsigned char *wanted) {
    const fibrad_spheres spheres = bed_spheres(bed);
    const fibrad_scene_config config = bed_scene(bed, NULL);
    const fibrad_bed_rule options = {.beam = rule, .wanted = wanted, .raw = raw};
    fibrad_run run = {.threads = 1};
    fibrad_bed_matrix *factors = NULL;
    assert_ok(fibrad_view_factors(&config, &spheres, &options, &run, &factors));
    return factors;
}

/* Finds ROWS rows of a bed with many directions, and says which they are. */
static fibrad_bed_matrix *truth_of(const struct bed *bed, unsigned char wanted[1000]) {
    ck_assert_uint_lt(bed->n, 1000);
    memset(wanted, 0, 1000);
    for (uint32_t k = 0; k < ROWS; k++) wanted[bed->n * (2 * k + 1) / (2 * ROWS)] = 1;
    return rows(bed, &(fibrad_beam_rule){.directions = 10000}, true, wanted);
}

static double distance_of(const fibrad_bed_matrix *a, const fibrad_bed_matrix *b, uint32_t i) {
    const fibrad_row of_a = matrix_row(&a->matrix, i), of_b = matrix_row(&b->matrix, i);
    return row_distance(&of_a, &of_b);
}

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* All but two of 48 estimates are above the error of a raw row, or nearly so: rows of a lattice err together. Estimates
 * of rows from silhouettes are above half the error. The median estimate is at most 4 times the error. */
LOOP_TEST(estimates_are_honest, BEDS) {
    OWNED_BED bed = beds[_i].make();
    unsigned char wanted[1000];
    OWNED_FACTORS *truth = truth_of(&bed, wanted);
    for (int raw = 0; raw < 2; raw++) {
        double ratio[3 * ROWS];
        uint32_t count = 0;
        for (uint32_t directions = 60; directions <= 540; directions *= 3) {
            OWNED_FACTORS *factors = rows(&bed, &(fibrad_beam_rule){.directions = directions}, raw, NULL);
            for (uint32_t i = 0; i < bed.n; i++) {
                if (!wanted[i]) continue;
                ratio[count] = factors->matrix.error[i] / distance_of(factors, truth, i);
                ck_assert_double_finite(ratio[count++]);
            }
        }
        ck_assert_uint_eq(count, 3 * ROWS);
        qsort(ratio, count, sizeof *ratio, ascending);
        printf("%s, %s: estimate over error %.2f %.2f %.2f\n", beds[_i].name, raw ? "raw" : "averaged", ratio[2],
               ratio[count / 2], ratio[count - 3]);
        ck_assert_double_ge(ratio[2], !raw ? .5 : _i == 3 ? .85 : 1);
        ck_assert_double_lt(ratio[count / 2], 4);
    }
}

/* Estimates of means of two rows, each by windows, are above the error, but for two of 48 at most. The median estimate
 * is at most 4 times the error. The host has such rows only where silhouettes cannot serve: the kernel makes them. */
LOOP_TEST(estimates_of_means_are_honest, BEDS) {
    OWNED_BED bed = beds[_i].make();
    unsigned char wanted[1000];
    OWNED_FACTORS *truth = truth_of(&bed, wanted);
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    double ratio[3 * ROWS];
    uint32_t count = 0;
    for (uint32_t directions = 60; directions <= 540; directions *= 3) {
        OWNED_MATRIX means = matrix_by_beams(scene, &(fibrad_beam_rule){.directions = directions}, false);
        for (uint32_t i = 0; i < bed.n; i++) {
            if (!wanted[i]) continue;
            const fibrad_row mean = matrix_row(&means.factors, i), exact = matrix_row(&truth->matrix, i);
            ratio[count++] = mean.error / row_distance(&mean, &exact);
        }
    }
    qsort(ratio, count, sizeof *ratio, ascending);
    printf("%s, means: estimate over error %.2f %.2f %.2f\n", beds[_i].name, ratio[2], ratio[count / 2],
           ratio[count - 3]);
    ck_assert_double_ge(ratio[2], 1);
    ck_assert_double_lt(ratio[count / 2], 4);
}

/* The rows asked for are that accurate, by the truth and by their own estimates. Averaged rows are closed and
 * reciprocal. */
LOOP_TEST(tolerance_is_met, BEDS) {
    OWNED_BED bed = beds[_i].make();
    unsigned char of_truth[1000];
    OWNED_FACTORS *truth = truth_of(&bed, of_truth);
    const double wanted = _i == 1 ? .1 : 4e-3;
    for (int raw = 0; raw < 2; raw++) {
        OWNED_FACTORS *factors = rows(&bed, &(fibrad_beam_rule){.tolerance = wanted}, raw, NULL);
        uint32_t above = 0;
        double largest = 0;
        for (uint32_t i = 0; i < bed.n; i++) {
            ck_assert_double_le(factors->matrix.error[i], wanted);
            worst_of(&largest, factors->matrix.error[i]);
            if (of_truth[i]) above += !(distance_of(factors, truth, i) <= wanted);
            ck_assert_double_le(matrix_sum(&factors->matrix, i), 1 + 1e-12);
            ck_assert_double_eq_tol(matrix_total(&factors->matrix, i), 1, 1e-12);
        }
        printf("%s, %s: %u directions for %g, estimate %.2g\n", beds[_i].name, raw ? "raw" : "averaged",
               factors->directions, wanted, largest);
        ck_assert_uint_le(above, 1);
        ck_assert_double_gt(largest, wanted / 5);
        ck_assert_double_le(factors->closure_error, 1e-12);
        if (!raw) ck_assert_double_lt(factors->reciprocity_error, 1e-14);
    }
}

/* A single row takes the directions that it needs, whatever room it has. It holds the row of that many directions. */
TEST(a_row_takes_the_directions_it_needs) {
    OWNED_BED bed = random_bed();
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    OWNED_WORK work = work_growing();
    OWNED_ROW row = row_of(bed.n), plain = row_of(bed.n);
    uint32_t before = 0;
    for (double error = 1e-2; error > 1e-4; error /= 3) {
        assert_ok(fibrad_beam_row(scene, &work, 7, &(fibrad_beam_rule){.tolerance = error}, &row));
        ck_assert_double_le(row.error, error);
        ck_assert_uint_ge(row.directions, before);
        before = row.directions;
        assert_ok(fibrad_beam_row(scene, &work, 7, &(fibrad_beam_rule){.directions = before}, &plain));
        ck_assert_double_eq(row_distance(&row, &plain), 0);
        ck_assert_double_eq(row.error, plain.error);
    }
    ck_assert_uint_gt(before, 400);
    const uint32_t room = row.capacity;
    row.capacity = 3;
    ck_assert_int_eq(fibrad_beam_row(scene, &work, 7, &(fibrad_beam_rule){.tolerance = .01}, &row), FIBRAD_E_CAPACITY);
    row.capacity = room;
    assert_invalid(fibrad_beam_row(scene, &work, 7, &(fibrad_beam_rule){.tolerance = -1}, &row));
    assert_invalid(fibrad_beam_row(scene, &work, 7, &(fibrad_beam_rule){.tolerance = NAN}, &row));
}

/* Scenes among walls: the spheres of a packing stand in a box or a cylinder of `room` times their extent. */
static const struct scene_in_walls {
    const char *name;
    uint32_t spheres;
    double low, high, fraction, room;
    bool round;
} scenes_in_walls[] = {{"dense box", 100, .8, 1.2, .5, 1, false},
                       {"dense cylinder", 100, .8, 1.2, .5, 1.5, true},
                       {"dilute box", 60, .8, 1.2, .05, 1, false},
                       {"dilute cylinder", 60, .8, 1.2, .05, 1.5, true},
                       {"large and small in a box", 100, .25, 1, .45, 1, false},
                       {"large and small in a cylinder", 100, .2, 1, .4, 1.5, true},
                       {"a heap in a wide box", 60, .8, 1.2, .5, 6, false},
                       {"a heap in a wide cylinder", 60, .8, 1.2, .5, 8, true},
                       {"few in a box", 6, .5, 1, .2, 1.2, false},
                       {"few in a cylinder", 5, .5, 1, .2, 2, true},
                       {"two in a box", 2, .5, 1, .2, 3, false},
                       {"one in a box", 1, 1, 1, .1, 2, false}};
enum { SCENES = sizeof scenes_in_walls / sizeof *scenes_in_walls };

/* Makes the walls about a bed. */
static uint32_t walls_about(const struct bed *bed, const struct scene_in_walls *of, fibrad_wall wall[6]) {
    double low[3] = {1e9, 1e9, 1e9}, high[3] = {-1e9, -1e9, -1e9};
    for (uint32_t i = 0; i < bed->n; i++)
        for (int axis = 0; axis < 3; axis++) {
            const double c = axis == 0 ? bed->x[i] : axis == 1 ? bed->y[i] : bed->z[i];
            least_of(&low[axis], c - bed->r[i]), worst_of(&high[axis], c + bed->r[i]);
        }
    for (int axis = 0; axis < 3; axis++) high[axis] = low[axis] + of->room * (high[axis] - low[axis]);
    uint32_t walls = 0;
    for (int k = of->round ? 4 : 0; k < 6; k++)
        wall[walls++] = plane_at(k / 2, k % 2, k % 2 ? high[k / 2] : low[k / 2]);
    const double x = (low[0] + high[0]) / 2, y = (low[1] + high[1]) / 2;
    if (of->round) wall[walls++] = cylinder_at(x, y, hypot(high[0] - x, high[1] - y));
    return walls;
}

static double distance_with_walls(const fibrad_row *a, const fibrad_row *b, uint32_t walls) {
    double square = pow(row_distance(a, b), 2);
    for (uint32_t k = 0; k < walls; k++) square += pow(a->wall[k] - b->wall[k], 2);
    return sqrt(square);
}

static fibrad_bed_matrix *rows_among(const struct bed *bed, const fibrad_scene_config *config,
                                     const fibrad_beam_rule *rule, bool raw, const unsigned char *wanted) {
    const fibrad_spheres spheres = bed_spheres(bed);
    const fibrad_bed_rule options = {.beam = rule, .wanted = wanted, .raw = raw};
    fibrad_run run = {.threads = 1};
    fibrad_bed_matrix *factors = NULL;
    assert_ok(fibrad_view_factors(config, &spheres, &options, &run, &factors));
    return factors;
}

/* Estimates count walls. The true error lies above twice the estimate in 5 % of rows at most. The median estimate is
 * not above five times the error. Tolerances are met likewise. */
LOOP_TEST(estimates_count_walls, SCENES) {
    const struct scene_in_walls *of = &scenes_in_walls[_i];
    OWNED_BED bed = packing(of->spheres, of->low, of->high, of->fraction, 5 + (uint64_t)_i, false);
    fibrad_wall wall[6];
    const fibrad_scene_config config = {.wall = wall, .walls = walls_about(&bed, of, wall)};
    unsigned char wanted[1000] = {0};
    for (uint32_t k = 0; k < ROWS; k++) wanted[bed.n * (2 * k + 1) / (2 * ROWS)] = 1;
    OWNED_FACTORS *truth = rows_among(&bed, &config, &(fibrad_beam_rule){.directions = 20000}, true, wanted);
    for (int raw = 0; raw < 2; raw++) {
        double ratio[4 * ROWS];
        uint32_t count = 0, above = 0;
        for (int step = 0; step < 4; step++) {
            const fibrad_beam_rule rule = {.directions = 61u << 2 * step, .tolerance = step == 3 ? 1e-3 : 0};
            const fibrad_beam_rule tolerant = {.tolerance = of->fraction > .1 ? 3e-3 : 1e-2};
            OWNED_FACTORS *factors = rows_among(&bed, &config, step < 3 ? &rule : &tolerant, raw, raw ? wanted : NULL);
            for (uint32_t i = 0; i < bed.n; i++) {
                if (!wanted[i]) continue;
                const fibrad_row here = matrix_row(&factors->matrix, i), there = matrix_row(&truth->matrix, i);
                const double error = distance_with_walls(&here, &there, config.walls);
                if (step == 3) ck_assert_double_le(here.error, tolerant.tolerance);
                if (error < 1e-12 && here.error < 1e-12) continue; /* solid angles alone give this row */
                above += error > 2 * here.error;
                ratio[count++] = here.error / error;
            }
        }
        if (bed.n == 1) ck_assert_uint_eq(count, 0);
        if (count == 0) continue;
        qsort(ratio, count, sizeof *ratio, ascending);
        printf("%s, %s: estimate over error %.2f %.2f %.2f, %u of %u too low\n", of->name, raw ? "raw" : "averaged",
               ratio[count / 20], ratio[count / 2], ratio[count - 1 - count / 20], above, count);
        ck_assert_uint_le(20 * above, count + 19);
        ck_assert_double_le(ratio[count / 2], 5);
    }
}

/* Where no number of directions reaches the tolerance, the row has the largest number. */
TEST(a_tolerance_out_of_reach_ends_at_the_most_directions) {
    OWNED_BED bed = BED({0, 0, 0, 1}, {1, 2, 3, 1});
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    OWNED_WORK work = work_growing();
    OWNED_ROW row = row_of(bed.n);
    assert_ok(fibrad_beam_row(scene, &work, 0, &(fibrad_beam_rule){.tolerance = 1e-15}, &row));
    ck_assert_uint_eq(row.directions, FIBRAD_DIRECTIONS_MAX);
    ck_assert_double_gt(row.error, 1e-15);
    ck_assert_uint_eq(fibrad_directions_for(FIBRAD_DIRECTIONS_MAX, 2, 1), FIBRAD_DIRECTIONS_MAX);
    ck_assert_uint_gt(fibrad_directions_for(100, 1.01, 1), 110);
    ck_assert_uint_lt(fibrad_directions_for(100, 8, 1), 500); /* 400 and some */
}

/* The row has one sphere, so halves of the directions may agree by chance. The true factor is the closed form. */
TEST(one_entry_is_no_luck) {
    OWNED_BED bed = BED({0, 0, 0, .3}, {.33003, 0, 0, .03});
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    OWNED_WORK work = work_growing();
    OWNED_ROW row = row_of(bed.n);
    double truth;
    assert_ok(fibrad_pair_exact(.03, .3, 3e-5, &truth));
    int beyond = 0, rows = 0;
    for (uint32_t directions = 50; directions < 300; directions += 60)
        for (uint64_t turn = 1; turn <= 50; turn++, rows++) {
            const fibrad_beam_rule rule = {.directions = directions, .turn = turn};
            assert_ok(fibrad_beam_row(scene, &work, 1, &rule, &row));
            beyond += fabs(row_factor(&row, 0) - truth) > 2 * row.error;
        }
    ck_assert_int_le(beyond, rows / 20);
}

/* ---- exchange factors ------------------------------------------------------------------------------------------- */

static fibrad_bed_matrix *exchange(const struct bed *bed, const fibrad_exchange_rule *rule, bool raw) {
    const fibrad_spheres spheres = bed_spheres(bed);
    const fibrad_bed_rule options = {.raw = raw};
    fibrad_run run = {.threads = 1};
    fibrad_bed_matrix *factors = NULL;
    assert_ok(exchange_of(NULL, &spheres, rule, &options, &run, &factors));
    return factors;
}

/* A large and a small sphere nearly touch. The true factor comes from paths of others and from a million paths of ours
 * from the small sphere: .1880. */
TEST(small_beside_large_exchange) {
    OWNED_BED bed = BED({0, 0, 0, .3}, {.33003, 0, 0, .03});
    const double emissivity[] = {.6, .6}, truth = .1880;
    double square = 0;
    for (uint64_t seed = 0; seed < 12; seed++) {
        const fibrad_exchange_rule rule = {.emissivity = emissivity, .tolerance = .002, .seed = seed};
        OWNED_FACTORS *f = exchange(&bed, &rule, false);
        const double there = matrix_factor(&f->matrix, 0, 1), back = matrix_factor(&f->matrix, 1, 0);
        ck_assert_double_le(fabs(back - truth), .004);
        assert_near(100 * there, back, 1e-14);
        ck_assert_double_le(f->closure_error, 1e-12);
        ck_assert_double_le(fmax(f->matrix.error[0], f->matrix.error[1]), .002);
        square += (back - truth) * (back - truth) / 12;
    }
    ck_assert_double_le(sqrt(square), .002);
}

/* View factors by rays and by points are averaged. The row of the small sphere is the better one. The true factor is
 * the closed form. */
LOOP_TEST(small_beside_large_sampled, 2) {
    OWNED_BED bed = BED({0, 0, 0, .3}, {.33003, 0, 0, .03});
    const fibrad_spheres spheres = bed_spheres(&bed);
    const fibrad_beam_rule points = {.points = 64};
    const fibrad_cast_rule rays = {.rays = 20000};
    const fibrad_bed_rule options = _i == 0 ? (fibrad_bed_rule){.beam = &points} : (fibrad_bed_rule){.cast = &rays};
    double truth;
    OWNED_FACTORS *f = NULL;
    assert_ok(fibrad_pair_exact(.03, .3, 3e-5, &truth));
    assert_ok(fibrad_view_factors(NULL, &spheres, &options, NULL, &f));
    const double there = matrix_factor(&f->matrix, 0, 1), back = matrix_factor(&f->matrix, 1, 0);
    ck_assert_double_le(fabs(back - truth), .002);
    assert_near(100 * there, back, 1e-14);
    ck_assert_double_le(f->closure_error, 1e-12);
}

/* Beds whose exchange factors have a tolerance. */
static const struct {
    uint32_t n;
    double smallest, fraction, emissivity, tolerance;
    uint64_t seed;
} greys[] = {{30, .2, .3, .3, .01, 2}, {30, .2, .3, .8, .01, 5}, {8, 1, .2, .3, .001, 1}, {8, 1, .2, .8, .001, 1}};

/* All rows reach the tolerance, in truth and as estimated, with four seeds. The true rows are raw rows of ten times as
 * many directions and a hundred times as many paths. */
LOOP_TEST(tolerance_of_exchange_is_met, sizeof greys / sizeof *greys) {
    const double tolerance = greys[_i].tolerance;
    OWNED_BED bed = packing(greys[_i].n, greys[_i].smallest, 1, greys[_i].fraction, greys[_i].seed, false);
    double *e = calloc(bed.n, sizeof *e), worst = 0, square = 0;
    for (uint32_t i = 0; i < bed.n; i++) e[i] = greys[_i].emissivity;
    OWNED_FACTORS *truth =
        exchange(&bed,
                 &(fibrad_exchange_rule){
                     .emissivity = e, .directions = 4000, .paths = (uint32_t)(.3 / tolerance / tolerance), .seed = 9},
                 true);
    for (uint64_t seed = 0; seed < 4; seed++) {
        OWNED_FACTORS *f =
            exchange(&bed, &(fibrad_exchange_rule){.emissivity = e, .tolerance = tolerance, .seed = seed}, false);
        for (uint32_t i = 0; i < bed.n; i++) {
            double distance = 0;
            for (uint32_t j = 0; j < bed.n; j++) {
                const double a_i = bed.r[i] * bed.r[i], a_j = bed.r[j] * bed.r[j];
                const double mean =
                    (matrix_factor(&truth->matrix, i, j) + matrix_factor(&truth->matrix, j, i)) * (a_j / (a_i + a_j));
                distance += pow(matrix_factor(&f->matrix, i, j) - mean, 2);
            }
            worst = fmax(worst, sqrt(distance));
            square += distance / bed.n / 4;
            ck_assert_double_le(f->matrix.error[i], tolerance);
        }
    }
    printf("%u spheres 1:%g, emissivity %g: asked %g, worst %.2g, root mean square %.2g\n", bed.n,
           1 / greys[_i].smallest, e[0], tolerance, worst, sqrt(square));
    ck_assert_double_le(sqrt(square), .7 * tolerance);
    ck_assert_double_le(worst, 1.3 * tolerance);
    free(e);
}
