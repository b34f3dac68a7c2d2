/* test_reproduce.c - the experiments give what was published. SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "bed/bed_scene.h"
#include "bed/packing.h"
#include "command/commands.h"
#include "papers/reproduce/reproduce.h"
#include "suite.h"

static char directory[200];

static void name_directory(void) {
    const char *build = getenv("BUILD");
    snprintf(directory, sizeof directory, "%.100s/tests/reproduce", build ? build : "build");
}

FIXTURE(name_directory, NULL)

/* Runs an experiment. The largest |difference| over the lines with this `source`. */
static double largest(char *name, const char *source, int *lines) {
    char *arguments[] = {"--only", name, "-o", directory}, path[240], line[400];
    ck_assert_int_eq(command_reproduce(4, arguments), 0);
    snprintf(path, sizeof path, "%s/comparison.csv", directory);
    OWNED_FILE *file = opened(path, "r");
    double worst = 0;
    *lines = 0;
    while (fgets(line, sizeof line, file)) {
        const char *from = strrchr(line, '"'); /* ",source,unit,theirs,ours,difference */
        if (!from || strncmp(from + 2, source, strlen(source)) != 0) continue;
        worst = fmax(worst, fabs(strtod(strrchr(line, ',') + 1, NULL)));
        ++*lines;
    }
    return worst;
}

TEST(figure_3) {
    int lines;
    ck_assert_double_le(largest("fig3", "check", &lines), .01);
    ck_assert_int_eq(lines, 24);
}

TEST(third_sphere) {
    int lines;
    ck_assert_double_le(largest("fig7-9", "check", &lines), .1);
    ck_assert_int_eq(lines, 8);
}

TEST(pebbles) {
    int lines;
    ck_assert_double_le(largest("pebble-rays", "check", &lines), .2); /* per cent */
    ck_assert_int_eq(lines, 10);
}

TEST(conductivity) {
    int lines;
    ck_assert_double_le(largest("conductivity", "check", &lines), 1.2); /* per cent: the check has other random beds */
    ck_assert_int_eq(lines, 16);
}

/* The distance of the nearest images of two spheres. */
static double apart(const struct bed *bed, uint32_t i, uint32_t j) {
    double square = 0;
    for (int axis = 0; axis < 3; ++axis)
        square += pow(remainder(bed_centres(bed, axis)[i] - bed_centres(bed, axis)[j], bed->period[axis]), 2);
    return sqrt(square);
}

/* Factors of a loose bed against a table that others traced: E. F. Johnson, I. Tari, D. Baker, Powder Technology 380
 * (2021) 164, solid fraction .25, emissivity .86, read in github.com/ef-johnson/Dense-Particle-Heat-Transfer. Distances
 * in radii, and how far off ours may be. Spheres are put one by one where there is room. */
TEST(exchange_factors) {
    static const double published[][3] = {{2.4, 4.5201e-2, .025}, {3, 2.7762e-2, .04}, {5, 5.7881e-3, .05}};
    enum { SPHERES = 1000 };
    OWNED_BED bed = bed_empty();
    double emissivity[SPHERES];
    for (int axis = 0; axis < 3; ++axis) bed.period[axis] = cbrt(SPHERES * 4 * PI / 3 / .25);
    for (uint64_t count = 0; bed.n < SPHERES; count += 3) {
        const double edge = bed.period[0];
        ck_assert_int_eq(bed_add(&bed, &(struct bed_sphere){.x = edge * bed_make_random(1, count),
                                                            .y = edge * bed_make_random(1, count + 1),
                                                            .z = edge * bed_make_random(1, count + 2),
                                                            .r = 1}),
                         0);
        for (uint32_t i = 0; i + 1 < bed.n; ++i) bed.n -= apart(&bed, i, bed.n - 1) < 2;
        emissivity[bed.n - 1] = .86;
    }
    const fibrad_spheres spheres = bed_spheres(&bed);
    const fibrad_scene_config box = bed_scene(&bed, NULL);
    const fibrad_exchange_rule grey = {.emissivity = emissivity, .directions = 144, .paths = 200};
    const fibrad_bed_rule rule = {.exchange = &grey, .raw = 1};
    fibrad_bed_matrix *made;
    assert_ok(fibrad_view_factors(&box, &spheres, &rule, NULL, &made));
    for (int k = 0; k < 3; ++k) {
        double sum = 0, pairs = 0;
        for (uint32_t i = 0; i < bed.n; ++i) {
            const fibrad_factors *rows = &made->matrix;
            uint64_t at = rows->start[i];
            for (uint32_t j = 0; j < bed.n; ++j) {
                const double f = at < rows->start[i + 1] && rows->col[at] == j ? rows->f[at++] : 0;
                if (i != j && fabs(apart(&bed, i, j) - published[k][0]) < .1) sum += f, ++pairs;
            }
        }
        assert_near(sum / pairs, published[k][1], published[k][2]);
    }
    fibrad_bed_matrix_free(made);
}

TEST(formulas) {
    for (double porosity = .3; porosity < .6; porosity += .1)
        ck_assert_double_eq_tol(correlation_zehner_bauer_schluender(.5, porosity) /
                                    correlation_zehner_bauer_schluender(1, porosity),
                                1. / 3, 1e-14); /* as plates of the emissivity */
    ck_assert_double_eq_tol(correlation_zehner_bauer_schluender(1, .5), .5 * (1 - sqrt(.5)) + 1.8 * sqrt(.5), 1e-14);
    ck_assert_double_eq_tol(correlation_kunii_smith(1, .4), .9, 1e-14);
}

TEST(usage) {
    char *unknown[] = {"--only", "fig99"}, *file[] = {"fig3"}, *nowhere[] = {"-o", "/nonexistent/folder"};
    ck_assert_int_eq(command_reproduce(2, unknown), 2);
    ck_assert_int_eq(command_reproduce(1, file), 2);
    ck_assert_int_eq(command_reproduce(2, nowhere), 4);
}
