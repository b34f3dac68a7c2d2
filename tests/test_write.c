/* test_write.c - writers, whose files are read back. Files are complete or do not exist.
 * SPDX-License-Identifier: MIT */
#include <dirent.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/message.h"
#include "text/text.h"
#include "read/read.h"
#include "suite.h"
#include "vtp_text.h"
#include "write/outputs.h"

/* Three spheres, of which row 1 was not computed. */
static double x[] = {0, 3, 1.0 / 3}, y[] = {0, 0.1, -7}, z[] = {1e-300, 2, 5}, r[] = {1, 0.5, 2};
static int64_t id[] = {0, 70, 123456789012};
static const struct bed bed = {.n = 3, .x = x, .y = y, .z = z, .r = r, .ids = true, .id = id, .timestep = 1200};

static const struct bed plain = {.n = 3, .x = x, .y = y, .z = z, .r = r, .frame = 7, .timestep = -1};

static uint64_t start[] = {0, 2, 2, 4};
static uint32_t col[] = {1, 2, 0, 2};
static double f[] = {0.1, 1.0 / 3, 5e-324, 0.75586818421612400e-1};
static const unsigned char wanted[] = {1, 0, 1};
static double row_sum[] = {0.1 + 1.0 / 3, 0, 0.0755868184216124}, escaped[] = {0.5, 0, 0.25}, error[] = {0.03, 0, 0.04};
static double wall[3][2] = {{0.0625, 0.25}, {0, 0.125}, {0}}, area[] = {100, INFINITY};
static const fibrad_bed_matrix factors = {.matrix = {.n = 3,
                                                     .walls = 2,
                                                     .start = start,
                                                     .col = col,
                                                     .f = f,
                                                     .escaped = escaped,
                                                     .beyond = (double[3]){0},
                                                     .error = error,
                                                     .wall = &wall[0][0]},
                                          .wall_area = area};
static const struct walls walls = {.count = 2,
                                   .wall = {{.kind = FIBRAD_WALL_CYLINDER, .cylinder = {0, 0, 9, 2}},
                                            {.kind = FIBRAD_WALL_PLANE, .plane = {2, 0, -9}}}};

static char text[20000]; /* what a writer wrote */

static double kelvins[] = {600, 1.0 / 3, 1e-300}, watts[] = {-1e-3, 2.5, 1e300}, wall_kelvins[] = {900, 77},
              wall_watts[] = {-0.1, 1e17};
static fibrad_heat_sources sources = {
    .temperature = kelvins, .emissivity = r, .wall_temperature = wall_kelvins, .surroundings = 300};
static double missed[] = {.25, .5, .75}, wall_missed[] = {2, NAN}, none_missed[] = {0, 1, 0};
static fibrad_heat_result result = {.power = watts,
                                    .wall_power = wall_watts,
                                    .surroundings_power = 0.1,
                                    .surroundings_error = 0.125,
                                    .temperature = kelvins,
                                    .wall_temperature = wall_kelvins,
                                    .power_error = missed,
                                    .wall_error = wall_missed,
                                    .temperature_error = none_missed,
                                    .wall_temperature_error = none_missed};

static void write_text(write_function *write, const struct contents *what, bool first) {
    OWNED_FILE *file = tmpfile();
    ck_assert_ptr_nonnull(file);
    struct contents own = *what;
    own.first = first;
    ck_assert_int_eq(write(file, &own), 0);
    rewind(file);
    text[fread(text, 1, sizeof text - 1, file)] = 0;
}

static void write_matrix(write_function *write, bool ids, const struct walls *walls_or_none) {
    const struct contents what = {
        .bed = ids ? &bed : &plain, .factors = &factors, .wanted = wanted, .walls = walls_or_none};
    write_text(write, &what, true);
}

static void write_heat(write_function *write, const struct contents *more) {
    struct contents what = *more;
    what.sources = &sources;
    what.result = &result;
    write_text(write, &what, true);
}

/* Prints a number as printf does, with the fewest of 15 to 17 digits that give the same number when read. */
static void print_shortest(char *to, size_t room, double value) {
    for (int digits = 15; digits <= 17; ++digits) {
        snprintf(to, room, "%.*g", digits, value);
        if (strtod(to, NULL) == value) return;
    }
}

/* The same text in memory of its own. The last few texts stay valid. */
static const char *shortest(double value) {
    static char texts[8][40];
    static int next;
    next = (next + 1) % 8;
    print_shortest(texts[next], sizeof texts[next], value);
    return texts[next];
}

static void assert_shortest(double value) {
    char ours[TEXT_NUMBER];
    *text_real(ours, value) = 0;
    if (fabs(value) < 1e15 || fabs(value) >= 0x1p50)
        ck_assert_str_eq(ours, shortest(value));
    else /* all digits stand before the point */
        ck_assert_double_eq(strtod(ours, NULL), value);
}

/* Numbers are written as printf writes them, to the last digit. They have all sizes, and some are hard to round. */
TEST(numbers_are_those_of_printf) {
    uint64_t state = 88172645463325252u;
    char ours[2 * TEXT_NUMBER], theirs[2 * TEXT_NUMBER];
    for (uint64_t k = 0; k < by_night(500000, 100000); ++k) {
        state ^= state << 13, state ^= state >> 7, state ^= state << 17;
        double value;
        uint64_t bits = state;
        if (k % 5 == 0) bits = (bits & 0x800fffffffffffff) | (963 + (bits >> 52) % 120) << 52; /* 1e-18 to 1e18 */
        memcpy(&value, &bits, sizeof value);
        if (k % 5 == 1) value = (double)(state % 1000000) / 1e6;
        if (k % 5 == 2) value = (double)(state >> 11) * 0x1p-53;
        if (k % 5 == 3)
            value = (1 + (double)(state >> 60) * 0x1p-52) / pow(10, (double)(state % 17)); /* at powers of 10 */
        if (k % 5 == 4) value = (double)(state % 4096 * 2 + 1) / 64;                       /* ends in 5 */
        assert_shortest(value);
        *text_whole(ours, (int64_t)(bits >> state % 64)) = 0;
        snprintf(theirs, sizeof theirs, "%" PRId64, (int64_t)(bits >> state % 64));
        ck_assert_str_eq(ours, theirs);
    }
    static const double special[] = {0,  -0.0, INFINITY, -INFINITY, 5e-324, 1e17,  1e16,    1e15,      0.1,   1,
                                     -1, 1e-4, 1e-5,     293.15,    1200.1, -1e-9, 0x1p-20, 0x1p-1022, 1 / 3.};
    for (size_t k = 0; k < sizeof special / sizeof *special; ++k) assert_shortest(special[k]);
    *text_whole(ours, INT64_MIN) = 0;
    ck_assert_str_eq(ours, "-9223372036854775808");
    OWNED_FILE *file = tmpfile();
    ck_assert_ptr_nonnull(file);
    text_json_real(file, NAN);
    text_json_real(file, .5);
    rewind(file);
    ck_assert_str_eq(fgets(ours, sizeof ours, file), "null0.5");
}

TEST(csv_has_a_line_for_each_entry) {
    for (int ids = 0; ids < 2; ++ids) {
        write_matrix(write_csv, ids, NULL);
        assert_begins(text, "i,j,F\n");
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

/* After each sphere's row come the surroundings, -1, and the walls from -2 on. Then come the rows of walls of finite
 * area. The column `body` says what they are. */
TEST(csv_has_walls_below_minus_one) {
    char all[1000];
    write_matrix(write_csv, true, &walls);
    snprintf(all, sizeof all,
             "i,j,F,body\n0,70,%s,\n0,123456789012,%s,\n0,-1,0.5,surroundings\n0,-2,0.0625,cylinder\n"
             "0,-3,0.25,zmin\n70,-3,0.125,zmin\n123456789012,0,%s,\n123456789012,123456789012,%s,\n"
             "123456789012,-1,0.25,surroundings\n-2,0,%s,cylinder\n",
             shortest(f[0]), shortest(f[1]), shortest(f[2]), shortest(f[3]),
             shortest(4 * acos(-1) * r[0] * r[0] * 0.0625 / 100));
    ck_assert_str_eq(text, all);
    write_matrix(write_csv, true, &(struct walls){0}); /* surroundings alone */
    snprintf(all, sizeof all,
             "i,j,F,body\n0,70,%s,\n0,123456789012,%s,\n0,-1,0.5,surroundings\n123456789012,0,%s,\n"
             "123456789012,123456789012,%s,\n123456789012,-1,0.25,surroundings\n",
             shortest(f[0]), shortest(f[1]), shortest(f[2]), shortest(f[3]));
    ck_assert_str_eq(text, all);

    /* nothing is known of these walls, and there is a cutoff */
    const double beyond[] = {0.125, 0, 0}, none[] = {INFINITY, INFINITY}, emissivity[] = {1, 1, 1};
    fibrad_bed_matrix cut = factors;
    cut.matrix.beyond = beyond;
    cut.wall_area = none;
    const fibrad_exchange_rule grey = {.emissivity = emissivity, .wall_emissivity = none};
    struct walls nameless = {.count = 2};
    write_text(write_csv, &(struct contents){.bed = &bed, .factors = &cut, .walls = &nameless, .grey = &grey}, true);
    assert_begins(text, "i,j,D,body\n");
    assert_has(text, "\n0,-2,0.0625,wall_1\n0,-3,0.25,wall_2\n0,-4,0.125,beyond\n");
    assert_lacks(text, "\n-2,");
    nameless.count = 0; /* `grey` makes these exchange factors */
    write_text(write_csv, &(struct contents){.bed = &bed, .factors = &cut, .walls = &nameless, .grey = &grey}, true);
    assert_has(text, "\n0,-1,0.5,surroundings\n0,-2,0.125,beyond\n");
}

/* Rows of walls come after what the wall sends to the spheres. Walls without bounds have none, and null in JSON. */
TEST(rows_of_walls_come_after_spheres) {
    static const double between[] = {0.5, 0.25, NAN, NAN}, leaves[] = {0.125, NAN}, off[] = {0.0625, NAN};
    fibrad_bed_matrix whole = factors;
    whole.matrix.wall_wall = between, whole.matrix.wall_escaped = leaves, whole.matrix.wall_error = off;
    const struct contents what = {.bed = &bed, .factors = &whole, .walls = &walls};
    write_text(write_csv, &what, true);
    const char *rows = strstr(text, "\n-2,0,");
    ck_assert_ptr_nonnull(rows);
    ck_assert_str_eq(strchr(rows + 1, '\n'), "\n-2,-2,0.5,cylinder:cylinder\n-2,-3,0.25,cylinder:zmin\n"
                                             "-2,-1,0.125,cylinder:surroundings\n");
    write_text(write_json, &what, true);
    assert_has(text, "\"zmin\":[0.25,0.125,0]},\"wall_rows\":{\"cylinder\":{\"walls\":[0.5,0.25],\"escaped\":0.125,"
                     "\"error\":0.0625},\"zmin\":{\"walls\":[null,null],\"escaped\":null,\"error\":null}}}\n");
}

/* Frames and files are columns. The header comes once. */
TEST(series_have_one_header) {
    struct contents what = {.bed = &bed, .factors = &factors, .series = true};
    write_text(write_csv, &what, true);
    assert_begins(text, "frame,timestep,i,j,F\n0,1200,0,70,");
    what.bed = &plain;
    what.file = "a \"b\", c.dump";
    write_text(write_csv, &what, false);
    assert_begins(text, "\"a \"\"b\"\", c.dump\",7,,0,1,");
    write_text(write_csv, &what, true);
    assert_begins(text, "file,frame,timestep,i,j,F\n");
    write_heat(write_heat_csv, &(struct contents){.bed = &bed, .series = true});
    assert_begins(text, "frame,timestep,i,T_K,q_W,q_error_W,T_error_K,body\n0,1200,0,600,");
}

/* If surroundings have no temperature, they do not appear. */
TEST(heat_leaves_out_surroundings_without_temperature) {
    char all[1000];
    for (int closed = 0; closed < 2; ++closed) {
        sources.surroundings = closed ? NAN : 300;
        write_heat(write_heat_csv, &(struct contents){.bed = &bed, .walls = &walls});
        snprintf(all, sizeof all,
                 "i,T_K,q_W,q_error_W,T_error_K,body\n0,600,-0.001,0.25,0,\n70,%s,2.5,0.5,1,\n"
                 "123456789012,%s,1e+300,0.75,0,\n%s"
                 "-2,900,-0.1,2,0,cylinder\n-3,77,1e+17,,1,zmin\n",
                 shortest(kelvins[1]), shortest(kelvins[2]), closed ? "" : "-1,300,0.1,0.125,0,surroundings\n");
        ck_assert_str_eq(text, all);
        write_heat(write_heat_json, &(struct contents){.bed = &bed, .walls = &walls});
        ck_assert((strstr(text, "surroundings") == NULL) == closed);
    }
    sources.surroundings = 300;
    write_heat(write_heat_csv, &(struct contents){.bed = &plain});
    assert_lacks(text, "\n-1,");
}

/* JSON has no NaN and no control characters. tests/check_written.sh has Python read it. */
TEST(json_has_no_nan) {
    struct contents what = {
        .bed = &bed, .factors = &factors, .wanted = wanted, .walls = &walls, .file = "a\n\"b\\.csv"};
    char all[1000];
    write_text(write_json, &what, true);
    snprintf(all, sizeof all,
             "{\"kind\":\"view factors\",\"file\":\"a\\u000a\\\"b\\\\.csv\",\"frame\":0,\"timestep\":1200,"
             "\"id\":[0,70,123456789012],\"indptr\":[0,2,2,4],\"indices\":[1,2,0,2],"
             "\"data\":[%s,%s,%s,%s],\"escaped\":[0.5,null,0.25],\"beyond\":[0,null,0],"
             "\"error\":[%s,null,%s],\"walls\":{\"cylinder\":[0.0625,null,0],\"zmin\":[0.25,null,0]}}\n",
             shortest(f[0]), shortest(f[1]), shortest(f[2]), shortest(f[3]), shortest(error[0]), shortest(error[2]));
    ck_assert_str_eq(text, all);
    write_heat(write_heat_json, &(struct contents){.bed = &plain});
    snprintf(all, sizeof all,
             "{\"kind\":\"heat\",\"frame\":7,\"timestep\":null,\"id\":[0,1,2],\"T_K\":[600,%s,%s],"
             "\"q_W\":[-0.001,2.5,1e+300],\"q_error_W\":[0.25,0.5,0.75],\"T_error_K\":[0,1,0]}\n",
             shortest(kelvins[1]), shortest(kelvins[2]));
    ck_assert_str_eq(text, all);
}

LOOP_TEST(matrix_market_has_ids_and_entries, 2) {
    write_matrix(write_mtx, _i == 1, NULL);
    const char banner[] = "%%MatrixMarket matrix coordinate real general\n";
    assert_begins(text, banner);
    assert_has(text, "\n% View factors F_ij from");
    ck_assert((strstr(text, "\n% ids: 0 70 123456789012\n3 3 4\n") != NULL) == _i);
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

static void expect_array(const char *name, const void *wanted_values, size_t n) {
    uint64_t values[9];
    ck_assert_uint_eq(vtp_array(text, name, values, n), n);
    ck_assert_msg(memcmp(values, wanted_values, 8 * n) == 0, "%s", name);
}

/* Checks the values of an array of rows. The middle row was not computed. */
static void expect_rows(const char *name, double first, double last) {
    double values[3];
    ck_assert_uint_eq(vtp_array(text, name, values, 3), 3);
    ck_assert_msg(values[0] == first && isnan(values[1]) && values[2] == last, "%s", name);
}

TEST(paraview_files_have_all_arrays) {
    write_matrix(write_vtp, false, NULL);
    assert_has(text, "NumberOfPoints=\"3\" NumberOfVerts=\"3\"");
    expect_array("Points", (double[]){x[0], y[0], z[0], x[1], y[1], z[1], x[2], y[2], z[2]}, 9);
    expect_array("radius", r, 3);
    expect_rows("row_sum", row_sum[0], row_sum[2]);
    expect_rows("escaped", 0.5, 0.25);
    expect_array("neighbours", (int64_t[]){2, 0, 2}, 3);
    expect_array("connectivity", (int64_t[]){0, 1, 2}, 3);
    expect_array("offsets", (int64_t[]){1, 2, 3}, 3);
    const char *end = strstr(text, "</VTKFile>\n");
    ck_assert_ptr_nonnull(end);
    ck_assert_uint_eq(strlen(end), 11);
    assert_lacks(text, "Name=\"id\"");
    assert_lacks(text, "Name=\"wall_");

    write_matrix(write_vtp, true, &walls);
    expect_array("id", id, 3);
    expect_rows("wall_cylinder", 0.0625, 0);
    expect_rows("wall_zmin", 0.25, 0);

    write_heat(write_heat_vtp, &(struct contents){.bed = &bed, .walls = &walls});
    expect_array("id", id, 3);
    expect_array("temperature_K", kelvins, 3);
    expect_array("power_W", watts, 3);
    expect_array("emissivity", r, 3);
}

/* Where the data of the next member begin, after the 128 bytes of its array's header. */
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
TEST(numpy_files_have_all_arrays) {
    const int64_t shape[] = {3, 3};
    const uint64_t large[] = {1, 2, UINT64_MAX}; /* in place of the ids */
    const struct array ids = {"ids.npy", "u8", large, 3, 0};
    struct contents what = {.bed = &bed, .factors = &factors, .wanted = wanted, .walls = &walls};
    for (int own = 0; own < 2; ++own) {
        what.array = &ids;
        what.arrays = (size_t)own;
        write_text(write_npz, &what, true);
        const struct {
            const char *name;
            uint64_t bytes;
            const void *data;
        } members[] = {
            {"indices.npy", sizeof col, col},
            {"indptr.npy", sizeof start, start},
            {"format.npy", 3, "csr"},
            {"shape.npy", sizeof shape, shape},
            {"data.npy", sizeof f, f},
            {"ids.npy", sizeof id, own ? large : (const void *)id},
            {"x.npy", sizeof x + sizeof y + sizeof z, (double[]){x[0], y[0], z[0], x[1], y[1], z[1], x[2], y[2], z[2]}},
            {"radius.npy", sizeof r, r},
            {"length_unit.npy", sizeof bed.units, bed.units},
            {"escaped.npy", sizeof escaped, escaped},
            {"beyond.npy", 3 * sizeof(double), (double[3]){0}},
            {"error.npy", sizeof error, error},
            {"computed.npy", sizeof wanted, wanted},
            {"body.npy", sizeof wall, wall},
            {"wall_names.npy", 16, "cylinderzmin\0\0\0"}};
        const char *at = text;
        for (size_t k = 0; k < sizeof members / sizeof *members; ++k) {
            at = next_member(at, members[k].name, members[k].bytes);
            ck_assert_msg(memcmp(at, members[k].data, members[k].bytes) == 0, "%s", members[k].name);
            at += members[k].bytes;
        }
        ck_assert_mem_eq(at, "PK\1\2", 4);
    }
    fibrad_bed_matrix whole = factors; /* with rows of walls */
    whole.matrix.wall_wall = &wall[0][0], whole.matrix.wall_escaped = wall[1], whole.matrix.wall_error = wall[2];
    what.factors = &whole;
    write_text(write_npz, &what, true);
    const char *at = text;
    while (memcmp(at + 30, "wall_names.npy", 14) != 0) at++;
    at = next_member(at, "wall_names.npy", 16) + 16;
    at = next_member(at, "wall_area.npy", sizeof area) + sizeof area;
    at = next_member(at, "wall_wall.npy", 32);
    ck_assert_mem_eq(at, wall, 32);
    at = next_member(at + 32, "wall_escaped.npy", 16) + 16;
    at = next_member(at, "wall_error.npy", 16) + 16;
    ck_assert_mem_eq(at, "PK\1\2", 4);
}

/* The summary goes over the rows that were computed. */
TEST(summaries_go_over_rows_that_were_computed) {
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

static char folder[200], path[220];

static void make_folder(void) {
    const char *build = getenv("BUILD");
    snprintf(folder, sizeof folder, "%.100s/tests/write_XXXXXX", build ? build : "build");
    ck_assert_ptr_nonnull(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/out.csv", folder);
}

static void remove_folder(void) {
    unlink(path);
    ck_assert_int_eq(rmdir(folder), 0); /* no other file was left there */
}

FIXTURE(make_folder, remove_folder)

static int count_files(void) {
    int count = 0;
    DIR *list = opendir(folder);
    ck_assert_ptr_nonnull(list);
    for (struct dirent *entry; (entry = readdir(list));) count += entry->d_name[0] != '.';
    closedir(list);
    return count;
}

static void expect_file(const char *content) {
    OWNED_FILE *file = opened(path, "r");
    text[fread(text, 1, sizeof text - 1, file)] = 0;
    ck_assert_str_eq(text, content);
}

TEST(files_are_complete_or_not_there) {
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

/* A link stays and leads to the file that was written, which keeps its permissions. The file need not exist before, but
 * links must not lead in a circle. */
TEST(links_stay_and_lead_to_the_file) {
    struct output output;
    struct stat there;
    const char *link_to = formatted("%s/link.csv", folder), *other = formatted("%s/next.csv", folder);
    ck_assert_int_eq(symlink("next.csv", link_to), 0);
    ck_assert_int_eq(symlink("out.csv", other), 0);
    umask(022);
    for (int k = 0; k < 2; ++k) { /* out.csv exists the second time */
        ck_assert_int_eq(output_open(&output, link_to), 0);
        fputs(k ? "second" : "first", output.file);
        ck_assert_int_eq(output_close(&output, STATUS_OK), STATUS_OK);
        expect_file(k ? "second" : "first");
        ck_assert(lstat(link_to, &there) == 0 && S_ISLNK(there.st_mode));
        ck_assert(stat(path, &there) == 0 && (there.st_mode & 0777) == (k ? 0604 : 0644));
        ck_assert_int_eq(chmod(path, 0604), 0);
    }
    ck_assert(output_same(link_to, path) && !output_same(link_to, folder));
    unlink(path);
    ck_assert(output_same(link_to, path) && output_same(other, link_to));
    unlink(other);
    ck_assert_int_eq(symlink("link.csv", other), 0);
    ck_assert_int_eq(output_open(&output, link_to), STATUS_FILE); /* each link leads to the other */
    ck_assert_int_eq(output_close(&output, STATUS_FILE), STATUS_FILE);
    unlink(other);
    unlink(link_to);
}

/* A file that is read stays, under any of its names, whichever of the two files is opened first. */
TEST(inputs_are_never_replaced) {
    struct output output;
    const char *read = formatted("%s/read.csv", folder), *link_to = formatted("%s/link.csv", folder);
    fclose(fopen(read, "w"));
    ck_assert_int_eq(symlink("read.csv", link_to), 0);
    ck_assert_int_eq(output_open(&output, link_to), 0);
    ck_assert_int_eq(output_spare(read), STATUS_USAGE);
    ck_assert_int_eq(output_close(&output, STATUS_USAGE), STATUS_USAGE);
    ck_assert_int_eq(output_spare(read), 0);
    ck_assert_int_eq(output_spare(read), 0);
    ck_assert_int_eq(output_open(&output, link_to), STATUS_USAGE);
    ck_assert_int_eq(output_open(&output, read), STATUS_USAGE);
    unlink(link_to);
    unlink(read);
    ck_assert_int_eq(count_files(), 0);
}

/* The program writes at once to what it cannot replace: standard output by any of its names, pipes, devices. */
TEST(pipes_and_devices_are_written_at_once) {
    struct output output;
    FILE *file = tmpfile();
    const int before = dup(STDOUT_FILENO);
    ck_assert_ptr_nonnull(file);
    ck_assert(!output_stdout(path) && output_stdout("-"));
    fflush(stdout);
    ck_assert_int_ge(dup2(fileno(file), STDOUT_FILENO), 0);
    for (int k = 0; k < 2; ++k) {
        ck_assert_int_eq(output_open(&output, k ? "/dev/stdout" : "-"), 0);
        fputs("x", output.file);
        ck_assert_int_eq(output_close(&output, STATUS_OK), STATUS_OK);
    }
    ck_assert_int_ge(dup2(before, STDOUT_FILENO), 0); /* standard output is still open */
    rewind(file);
    ck_assert_uint_eq(fread(text, 1, 10, file), 2);
    fclose(file);

    ck_assert_int_eq(mkfifo(path, 0600), 0);
    const int end = open(path, O_RDONLY | O_NONBLOCK);
    ck_assert_int_eq(output_open(&output, path), 0);
    fputs("pipe", output.file);
    ck_assert_int_eq(output_close(&output, STATUS_OK), STATUS_OK);
    ck_assert_int_eq(read(end, text, 10), 4);
    close(end);
    ck_assert_int_eq(output_open(&output, "/dev/full"), 0);
    fputs("device", output.file);
    ck_assert_int_eq(output_flush(&output), STATUS_FILE);
    ck_assert_int_eq(output_close(&output, STATUS_FILE), STATUS_FILE);
}

TEST(unwritable_places_are_refused) {
    struct output output;
    ck_assert_int_eq(output_open(&output, folder), STATUS_FILE);
    ck_assert_int_eq(output_open(&output, "no/such/folder/out.csv"), STATUS_FILE);
    ck_assert_int_eq(output_close(&output, STATUS_FILE), STATUS_FILE);
    ck_assert_int_eq(count_files(), 0);
}

/* ---- outputs ---------------------------------------------------------------------------------------------------- */

static char place[5][240]; /* paths in the folder */

static const char *in_place(int k, const char *name) {
    snprintf(place[k], sizeof place[k], "%s/%s", folder, name);
    return place[k];
}

/* -o and --format in the order given, and what they give. */
static const struct {
    const char *word[4];
    enum content content;
    bool series;
    int status;
} asked[] = {{{"a.csv", "b.mtx", "c.npz", "d.vtp"}, CONTENT_MATRIX, false, 0},
             {{"a.json", "--format=csv", "-"}, CONTENT_MATRIX, false, 0},
             {{"--format=npz", "c", "a.b.csv"}, CONTENT_MATRIX, false, 0},
             {{"a.dump", "b.lammpstrj", "c.json", "d.csv"}, CONTENT_HEAT, true, 0},
             {{"a.*.vtp", "*.csv"}, CONTENT_HEAT, true, 0},
             {{"a.txt"}, CONTENT_MATRIX, false, 2},
             {{"a.CSV"}, CONTENT_MATRIX, false, 2},
             {{".csv"}, CONTENT_MATRIX, false, 2},
             {{"a.csv.gz"}, CONTENT_MATRIX, false, 2},
             {{"a.dump"}, CONTENT_MATRIX, false, 2},
             {{"a.mtx"}, CONTENT_HEAT, false, 2},
             {{"a.npz"}, CONTENT_HEAT, false, 2},
             {{"-"}, CONTENT_HEAT, false, 2},
             {{"--format=mtx", "-"}, CONTENT_HEAT, false, 2},
             {{"--format=txt"}, CONTENT_HEAT, false, 2},
             {{"--format=csv", "a.csv"}, CONTENT_HEAT, false, 2},
             {{"--format=csv", "--format=json", "-"}, CONTENT_HEAT, false, 2},
             {{"--format=csv", "-", "-"}, CONTENT_HEAT, false, 2},
             {{"a.csv", "./a.csv"}, CONTENT_HEAT, false, 2},
             {{"a.*.csv", "a.*.csv"}, CONTENT_HEAT, false, 2},
             {{"*.*.csv"}, CONTENT_HEAT, false, 2},
             {{"a.npz"}, CONTENT_MATRIX, true, 2},
             {{"--format=vtp", "-"}, CONTENT_HEAT, true, 2}};

LOOP_TEST(outputs_go_by_their_names, sizeof asked / sizeof *asked) {
    struct outputs outputs = {0};
    int status = 0;
    for (int k = 0; k < 4 && asked[_i].word[k] && !status; ++k) {
        const char *word = asked[_i].word[k];
        if (strncmp(word, "--format=", 9) == 0)
            status = outputs_format(word + 9, &outputs);
        else
            status =
                outputs_add(strcmp(word, "-") == 0 || strcmp(word, ".csv") == 0 ? word : in_place(k, word), &outputs);
    }
    if (!status) status = outputs_check(&outputs, asked[_i].content, asked[_i].series);
    ck_assert_int_eq(status, asked[_i].status);
}

static struct contents frame_of(const struct bed *of) {
    return (struct contents){.bed = of, .sources = &sources, .result = &result, .series = true};
}

/* Three frames go into files of their own, which stay whatever comes later, and into one file, which must be whole. */
TEST(outputs_of_frames_are_written_whole) {
    struct bed numbered[] = {bed, plain, plain};
    numbered[0].frame = -2, numbered[1].frame = 10, numbered[2].frame = 8;
    const struct contents frames[] = {frame_of(&numbered[0]), frame_of(&numbered[1]), frame_of(&numbered[2])};
    for (int failed = 0; failed < 2; ++failed) {
        struct outputs outputs = {0};
        const char *const input = in_place(0, "q.8.csv");
        ck_assert_int_eq(output_spare(input), 0);
        ck_assert_int_eq(outputs_add(in_place(1, "q.*.csv"), &outputs), 0);
        ck_assert_int_eq(outputs_add(path, &outputs), 0);
        ck_assert_int_eq(outputs_check(&outputs, CONTENT_HEAT, true), 0);
        ck_assert(outputs_report(&outputs, false).text == stdout);
        ck_assert_int_eq(outputs_open(&outputs), 0);
        ck_assert_int_le(count_files(), 1); /* one if files need a name before they are complete */
        ck_assert_int_eq(outputs_write(&outputs, &frames[0]), 0);
        ck_assert_int_eq(outputs_write(&outputs, &frames[1]), 0);
        fclose(fopen(input, "w"));
        int status = failed ? outputs_write(&outputs, &frames[2]) : 0; /* the input */
        ck_assert_int_eq(status, failed ? STATUS_USAGE : 0);
        ck_assert_int_eq(outputs_close(&outputs, status), status);
        ck_assert_int_eq(count_files(), failed ? 3 : 4);
        write_heat(write_heat_csv, &frames[1]);
        char *alone = strdup(text), *rest = strchr(alone, '\n') + 1;
        OWNED char *joined = malloc(2 * sizeof text);
        write_heat(write_heat_csv, &frames[0]);
        snprintf(joined, 2 * sizeof text, "%s%s", text, rest);
        if (!failed) expect_file(joined);
        unlink(path);
        snprintf(path, sizeof path, "%s/q.10.csv", folder);
        expect_file(alone);
        unlink(path);
        unlink(in_place(2, "q.-2.csv"));
        unlink(input);
        snprintf(path, sizeof path, "%s/out.csv", folder);
        free(alone);
        ck_assert_int_eq(count_files(), 0);
    }
}

/* Places where nothing can be written are found before the work begins, those of frames, too. */
TEST(unwritable_outputs_are_found_before_the_work) {
    static const char *const names[] = {"no/such.csv", "no/*.csv"};
    for (int k = 0; k < 2; ++k) {
        struct outputs outputs = {0};
        ck_assert_int_eq(outputs_add(path, &outputs), 0);
        ck_assert_int_eq(outputs_add(in_place(0, names[k]), &outputs), 0);
        ck_assert_int_eq(outputs_check(&outputs, CONTENT_HEAT, false), 0);
        ck_assert_int_eq(outputs_open(&outputs), STATUS_FILE);
        ck_assert_int_eq(outputs_close(&outputs, STATUS_FILE), STATUS_FILE);
        ck_assert_int_eq(count_files(), 0);
    }
}

/* Our own reader reads back a dump, two frames of it, with boxes of files, of periods, and of spheres. */
TEST(dumps_are_read_back) {
    static const char *const columns[] = {"T_K", "q_W"};
    struct bed first = bed, second = bed;
    memcpy(first.units, "cgs", 4);
    first.low[2] = -10, first.high[2] = 1.0 / 3;
    first.period[1] = first.high[1] = 9, first.low[1] = 0;
    second.timestep = 1300;
    second.period[0] = 11;
    second.low[2] = 0, second.high[2] = 5, second.period[2] = 7; /* by --periodic */
    FILE *file = opened(path, "w");
    struct contents what = frame_of(&first);
    what.first = true;
    ck_assert_int_eq(write_heat_dump(file, &what), 0);
    what.bed = &second;
    what.first = false;
    ck_assert_int_eq(write_heat_dump(file, &what), 0);
    fclose(file);
    write_heat(write_heat_dump, &(struct contents){.bed = &first});
    assert_begins(text,
                  "ITEM: UNITS\ncgs\nITEM: TIMESTEP\n1200\nITEM: NUMBER OF ATOMS\n3\nITEM: BOX BOUNDS ff pp ff\n");
    write_heat(write_heat_dump, &(struct contents){.bed = &plain});
    assert_begins(text, "ITEM: TIMESTEP\n7\nITEM: NUMBER OF ATOMS\n3\nITEM: BOX BOUNDS ff ff ff\n");
    for (int k = 0; k < 2; ++k) {
        OWNED_BED back;
        const struct read_options options = {.frames = {k, k + 1, 1}, .extra = columns, .extras = 2};
        ck_assert_int_eq(read_bed(path, &options, &back), 0);
        ck_assert(back.n == 3 && back.ids);
        for (uint32_t i = 0; i < 3; ++i) {
            ck_assert(back.x[i] == x[i] && back.y[i] == y[i] && back.z[i] == z[i] && back.r[i] == r[i]);
            ck_assert(back.id[i] == id[i] && back.extra[2 * i] == kelvins[i] && back.extra[2 * i + 1] == watts[i]);
        }
        if (k == 0) {
            ck_assert(back.period[0] == 0 && back.period[1] == 9 && back.period[2] == 0);
            ck_assert(back.low[0] == -5.0 / 3 && back.high[0] == 3.5 && back.low[2] == -10 && back.high[2] == 1.0 / 3);
        } else {
            ck_assert_double_eq_tol(back.period[0], 11, 1e-14);
            ck_assert(back.low[0] == -5.0 / 3 && back.period[1] == 0 && back.period[2] == 7);
        }
    }
}
