/* test_write.c - writers, read back; files that are complete or not there. SPDX-License-Identifier: MIT */
#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/message.h"
#include "cli/output.h"
#include "suite.h"
#include "write/write.h"

/* Three spheres; row 1 was not computed. */
static double x[] = {0, 3, 1.0 / 3}, y[] = {0, 0.1, -7}, z[] = {1e-300, 2, 5}, r[] = {1, 0.5, 2};
static int64_t id[] = {70, -5, 123456789012};
static const struct bed bed = {.n = 3, .x = x, .y = y, .z = z, .r = r, .ids = true, .id = id};

static const struct bed plain = {.n = 3, .x = x, .y = y, .z = z, .r = r};

static uint64_t start[] = {0, 2, 2, 4};
static uint32_t col[] = {1, 2, 0, 2};
static double f[] = {0.1, 1.0 / 3, 5e-324, 0.75586818421612400e-1};
static const unsigned char wanted[] = {1, 0, 1};
static double row_sum[] = {0.1 + 1.0 / 3, 0, 0.0755868184216124}, escaped[] = {0.5, 0, 0.25}, error[] = {0.03, 0, 0.04};
static double wall[3][2] = {{0.0625, 0.25}, {0, 0.125}, {0}}, area[] = {100, INFINITY};
static const fibrad_bed_factors factors = {.matrix = {3, 2, start, col, f, escaped, (double[3]){0}, error, &wall[0][0]},
                                           .body_area = area};
static const struct walls walls = {
    2, {{.kind = FIBRAD_BODY_CYLINDER, .cylinder = {0, 0, 9}}, {.kind = FIBRAD_BODY_PLANE, .plane = {2, 0, -9}}}};

static char text[20000]; /* what a writer wrote */

static const struct walls *order; /* NULL: no walls */

static void write_text(write_function *write, bool ids) {
    FILE *file = tmpfile();
    ck_assert_ptr_nonnull(file);
    ck_assert_int_eq(
        write(file,
              &(struct contents){.bed = ids ? &bed : &plain, .factors = &factors, .wanted = wanted, .walls = order},
              true),
        0);
    rewind(file);
    text[fread(text, 1, sizeof text - 1, file)] = 0;
    fclose(file);
}

START_TEST(csv) {
    for (int ids = 0; ids < 2; ++ids) {
        write_text(write_csv, ids);
        ck_assert_int_eq(strncmp(text, "i,j,F\n", 6), 0);
        char *line = text + 6;
        for (uint32_t i = 0; i < 3; ++i)
            for (uint64_t k = start[i]; k < start[i + 1]; ++k) {
                ck_assert_int_eq(strtoll(line, &line, 10), ids ? id[i] : i);
                ck_assert_int_eq(*line++, ',');
                ck_assert_int_eq(strtoll(line, &line, 10), ids ? id[col[k]] : col[k]);
                ck_assert_int_eq(*line++, ',');
                ck_assert_double_eq(strtod(line, &line), f[k]);
                ck_assert_int_eq(*line++, '\n');
            }
        ck_assert_int_eq(*line, 0);
    }
}
END_TEST

/* After each sphere's row the surroundings, -1, and the walls from -2 on; then the rows of walls of finite area. */
START_TEST(csv_of_walls) {
    order = &walls;
    write_text(write_csv, true);
    order = NULL;
    double back = 4 * acos(-1) * r[0] * r[0] * 0.0625 / 100, found[4] = {0};
    const char *const lines[4] = {"%lld,-1,", "%lld,-2,", "%lld,-3,", "-2,%lld,"};
    for (int k = 0; k < 4; ++k) {
        char begin[40] = "\n";
        snprintf(begin + 1, sizeof begin - 1, lines[k], (long long)id[0]);
        const char *at = strstr(text, begin);
        ck_assert_msg(at != NULL, "no line %s", begin + 1);
        found[k] = strtod(at + strlen(begin), NULL);
    }
    ck_assert(found[0] == 0.5 && found[1] == 0.0625 && found[2] == 0.25);
    ck_assert_double_eq_tol(found[3], back, 1e-15 * back);
    ck_assert_ptr_null(strstr(text, "\n-3,"));
    write_text(write_vtp, false);
    ck_assert_ptr_null(strstr(text, "wall_"));
    order = &walls;
    write_text(write_vtp, false);
    order = NULL;
    ck_assert_ptr_nonnull(strstr(text, "Name=\"wall_cylinder\""));
    ck_assert_ptr_nonnull(strstr(text, "Name=\"wall_zmin\""));
}
END_TEST

START_TEST(matrix_market) {
    write_text(write_mtx, false);
    const char banner[] = "%%MatrixMarket matrix coordinate real general\n";
    ck_assert_int_eq(strncmp(text, banner, strlen(banner)), 0);
    char *line = text;
    while (*line == '%') line = strchr(line, '\n') + 1;
    ck_assert_int_eq(strtol(line, &line, 10), 3);
    ck_assert_int_eq(strtol(line, &line, 10), 3);
    ck_assert_int_eq(strtol(line, &line, 10), 4);
    for (uint32_t i = 0; i < 3; ++i)
        for (uint64_t k = start[i]; k < start[i + 1]; ++k) {
            ck_assert_int_eq(strtol(line, &line, 10), i + 1);
            ck_assert_int_eq(strtol(line, &line, 10), col[k] + 1);
            ck_assert_double_eq(strtod(line, &line), f[k]);
        }
    ck_assert_str_eq(line, "\n");
}
END_TEST

/* Decodes the inline binary array of a name; returns the number of 8-byte values. */
static size_t array(const char *name, void *values, size_t capacity) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    char tag[100];
    unsigned char bytes[1000] = {0};
    size_t n = 0;
    unsigned bits = 0, held = 0;
    snprintf(tag, sizeof tag, "Name=\"%s\"", name);
    const char *from = strstr(text, tag);
    ck_assert_msg(from != NULL, "no array %s", name);
    for (from = strchr(from, '\n') + 1; *from != '\n' && *from != '='; ++from) {
        const char *digit = strchr(digits, *from);
        ck_assert_ptr_nonnull(digit);
        bits = bits << 6 | (unsigned)(digit - digits);
        held += 6;
        if (held < 8) continue;
        held -= 8;
        ck_assert_uint_lt(n, sizeof bytes);
        bytes[n++] = (unsigned char)(bits >> held);
    }
    uint64_t length;
    memcpy(&length, bytes, sizeof length);
    ck_assert_uint_eq(length, n - 8);
    ck_assert_uint_le(length, capacity * 8);
    memcpy(values, bytes + 8, length);
    return length / 8;
}

START_TEST(paraview) {
    double values[9];
    int64_t whole[3];
    write_text(write_vtp, false);
    ck_assert_ptr_nonnull(strstr(text, "NumberOfPoints=\"3\" NumberOfVerts=\"3\""));
    ck_assert_uint_eq(array("Points", values, 9), 9);
    for (int i = 0; i < 3; ++i)
        ck_assert(values[3 * i] == x[i] && values[3 * i + 1] == y[i] && values[3 * i + 2] == z[i]);
    ck_assert_uint_eq(array("radius", values, 3), 3);
    ck_assert_int_eq(memcmp(values, r, sizeof r), 0);
    ck_assert_uint_eq(array("row_sum", values, 3), 3);
    ck_assert(values[0] == row_sum[0] && isnan(values[1]) && values[2] == row_sum[2]);
    ck_assert_uint_eq(array("escaped", values, 3), 3);
    ck_assert(values[0] == 0.5 && isnan(values[1]) && values[2] == 0.25);
    ck_assert_uint_eq(array("neighbours", whole, 3), 3);
    ck_assert(whole[0] == 2 && whole[1] == 0 && whole[2] == 2);
    ck_assert_uint_eq(array("connectivity", whole, 3), 3);
    ck_assert(whole[0] == 0 && whole[1] == 1 && whole[2] == 2);
    ck_assert_uint_eq(array("offsets", whole, 3), 3);
    ck_assert(whole[0] == 1 && whole[1] == 2 && whole[2] == 3);
    const char *end = strstr(text, "</VTKFile>\n");
    ck_assert_ptr_nonnull(end);
    ck_assert_uint_eq(strlen(end), 11);
}
END_TEST

/* Where the data of the next member begin, behind the 128 bytes of its array's header. */
static const char *next_member(const char *at, const char *name, uint64_t bytes) {
    uint64_t size;
    ck_assert_mem_eq(at, "PK\3\4", 4);
    ck_assert_mem_eq(at + 30, name, strlen(name));
    memcpy(&size, at + 30 + strlen(name) + 4, sizeof size);
    ck_assert_uint_eq(size, 128 + bytes);
    const char *array = at + 30 + strlen(name) + 20;
    ck_assert_mem_eq(array, "\x93NUMPY\1\0\x76\0{'descr': '", 21);
    return array + 128;
}

/* tests/check_npz.sh has Python and SciPy open such files. */
START_TEST(numpy) {
    const int64_t shape[] = {3, 3};
    write_text(write_npz, false);
    const char *at = next_member(text, "indices.npy", sizeof col);
    ck_assert_mem_eq(at, col, sizeof col);
    at = next_member(at + sizeof col, "indptr.npy", sizeof start);
    ck_assert_mem_eq(at, start, sizeof start);
    at = next_member(at + sizeof start, "format.npy", 3);
    ck_assert_mem_eq(at, "csr", 3);
    at = next_member(at + 3, "shape.npy", sizeof shape);
    ck_assert_mem_eq(at, shape, sizeof shape);
    at = next_member(at + sizeof shape, "data.npy", sizeof f);
    ck_assert_mem_eq(at, f, sizeof f);
    ck_assert_mem_eq(at + sizeof f, "PK\1\2", 4);
}
END_TEST

/* Over the rows that were computed. */
START_TEST(summaries) {
    struct summary summary;
    summary_make(&summary, &(struct contents){.bed = &bed, .factors = &factors, .wanted = wanted, .walls = &walls});
    ck_assert_double_eq(summary.row_sum_min, row_sum[2]);
    ck_assert_double_eq(summary.row_sum_max, row_sum[0]);
    ck_assert_double_eq(summary.escaped_mean, 0.375);
    ck_assert_double_eq(summary.wall_mean[0], 0.03125);
    ck_assert_double_eq(summary.wall_mean[1], 0.125);
    ck_assert_double_eq(summary.error_max, 0.04);
    ck_assert_double_eq_tol(summary.error_rms, sqrt(0.00125), 1e-17);
    ck_assert_double_eq_tol(summary.closure_max, 1 - 0.25 - row_sum[2], 1e-15);
}
END_TEST

START_TEST(endings) {
    ck_assert(write_find("a.csv", NULL) == write_csv);
    ck_assert(write_find("b/c.d.mtx", NULL) == write_mtx);
    ck_assert(write_find("x.vtp", NULL) == write_vtp);
    ck_assert(write_find("x.npz", NULL) == write_npz);
    static const char *const none[] = {"", "a", ".csv", "a.csv.gz", "acsv", "a.CSV"};
    for (size_t k = 0; k < sizeof none / sizeof *none; ++k) ck_assert(write_find(none[k], NULL) == NULL);
}
END_TEST

static char folder[200], path[220];

static void make_folder(void) {
    const char *build = getenv("BUILD");
    snprintf(folder, sizeof folder, "%.100s/tests/write_XXXXXX", build ? build : "build");
    ck_assert_ptr_nonnull(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/out.csv", folder);
}

static void remove_folder(void) {
    unlink(path);
    ck_assert_int_eq(rmdir(folder), 0); /* nothing else was left there */
}

static int count_files(void) {
    int count = 0;
    DIR *list = opendir(folder);
    ck_assert_ptr_nonnull(list);
    for (struct dirent *entry; (entry = readdir(list));) count += entry->d_name[0] != '.';
    closedir(list);
    return count;
}

static void expect_file(const char *content) {
    FILE *file = fopen(path, "r");
    ck_assert_ptr_nonnull(file);
    text[fread(text, 1, sizeof text - 1, file)] = 0;
    fclose(file);
    ck_assert_str_eq(text, content);
}

START_TEST(complete_or_not_at_all) {
    struct output output;
    umask(027);
    ck_assert_int_eq(output_open(&output, path), 0);
    ck_assert_int_ne(access(path, F_OK), 0);
    fputs("first", output.file);
    ck_assert_int_eq(output_close(&output, STATUS_INPUT), STATUS_INPUT);
    ck_assert_int_eq(count_files(), 0);

    ck_assert_int_eq(output_open(&output, path), 0);
    fputs("second", output.file);
    ck_assert_int_eq(output_close(&output, STATUS_OK), STATUS_OK);
    expect_file("second");
    struct stat there;
    ck_assert_int_eq(stat(path, &there), 0);
    ck_assert_int_eq(there.st_mode & 0777, 0640);

    struct output other;
    ck_assert_int_eq(output_open(&output, path), 0);
    ck_assert_int_eq(output_open(&other, path), 0);
    fputs("third", output.file);
    fputs("fourth", other.file);
    ck_assert_int_eq(output_close(&other, 130), 130);
    expect_file("second");
    ck_assert_int_eq(output_close(&output, STATUS_OK), STATUS_OK);
    expect_file("third");
    ck_assert_int_eq(count_files(), 1);
    ck_assert_int_eq(output_close(&output, STATUS_OK), STATUS_OK);
}
END_TEST

START_TEST(unwritable) {
    struct output output;
    ck_assert_int_eq(output_open(&output, folder), STATUS_FILE);
    ck_assert_int_eq(output_open(&output, "no/such/folder/out.csv"), STATUS_FILE);
    ck_assert_int_eq(output_close(&output, STATUS_FILE), STATUS_FILE);
    ck_assert_int_eq(count_files(), 0);
}
END_TEST

int main(void) {
    Suite *suite = suite_create("write");
    TCase *formats = suite_case(suite, "formats"), *files = suite_case(suite, "files");
    tcase_add_test(formats, csv);
    tcase_add_test(formats, csv_of_walls);
    tcase_add_test(formats, matrix_market);
    tcase_add_test(formats, summaries);
    tcase_add_test(formats, paraview);
    tcase_add_test(formats, numpy);
    tcase_add_test(formats, endings);
    tcase_add_checked_fixture(files, make_folder, remove_folder);
    tcase_add_test(files, complete_or_not_at_all);
    tcase_add_test(files, unwritable);
    return suite_run(suite);
}
