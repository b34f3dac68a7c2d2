/* test_reproduce.c - the experiments come out as published. SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "command/commands.h"
#include "suite.h"

static char directory[200];

/* Runs one experiment and returns the largest |difference| of the lines whose source is `source`. */
static double largest(char *experiment, const char *source, int *lines) {
    char *arguments[] = {"--only", experiment, "--no-plots", "-o", directory};
    ck_assert_int_eq(command_reproduce(5, arguments), 0);
    char path[240], line[400];
    snprintf(path, sizeof path, "%s/comparison.csv", directory);
    FILE *file = fopen(path, "r");
    ck_assert_ptr_nonnull(file);
    double worst = 0;
    *lines = 0;
    while (fgets(line, sizeof line, file)) {
        const char *from = strrchr(line, '"'); /* ",source,unit,theirs,ours,difference */
        if (!from || strncmp(from + 2, source, strlen(source)) != 0) continue;
        worst = fmax(worst, fabs(strtod(strrchr(line, ',') + 1, NULL)));
        ++*lines;
    }
    fclose(file);
    remove(path);
    return worst;
}

START_TEST(figure_3) {
    int lines;
    ck_assert_double_le(largest("fig3", "check", &lines), .01);
    ck_assert_int_eq(lines, 24);
}
END_TEST

START_TEST(third_sphere) {
    int lines;
    ck_assert_double_le(largest("fig7-9", "check", &lines), .1);
    ck_assert_int_eq(lines, 8);
}
END_TEST

START_TEST(pebbles) {
    int lines;
    ck_assert_double_le(largest("pebble-pair", "check", &lines), .05); /* per cent */
    ck_assert_int_eq(lines, 15);
}
END_TEST

START_TEST(pebbles_by_rays) {
    int lines;
    ck_assert_double_le(largest("pebble-rays", "paper", &lines), 3.2); /* per cent; the paper's own error */
    ck_assert_int_eq(lines, 15);
}
END_TEST

START_TEST(conductivity) {
    int lines;
    ck_assert_double_le(largest("conductivity", "check", &lines), 1.2); /* per cent; other random beds */
    ck_assert_int_eq(lines, 16);
}
END_TEST

START_TEST(usage) {
    char *unknown[] = {"--only", "fig99"}, *file[] = {"fig3"}, *nowhere[] = {"-o", "/nonexistent/folder"};
    ck_assert_int_eq(command_reproduce(2, unknown), 2);
    ck_assert_int_eq(command_reproduce(1, file), 2);
    ck_assert_int_eq(command_reproduce(2, nowhere), 4);
}
END_TEST

int main(void) {
    const char *build = getenv("BUILD");
    snprintf(directory, sizeof directory, "%.100s/tests/reproduce", build ? build : "build");
    Suite *suite = suite_create("reproduce");
    TCase *cases = suite_case(suite, "reproduce");
    tcase_add_test(cases, figure_3);
    tcase_add_test(cases, third_sphere);
    tcase_add_test(cases, pebbles);
    tcase_add_test(cases, pebbles_by_rays);
    tcase_add_test(cases, conductivity);
    tcase_add_test(cases, usage);
    return suite_run(suite);
}
