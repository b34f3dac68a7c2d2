/* test_cli.c - the program on beds. SPDX-License-Identifier: MIT */
#include "fibrad.h"
#include "program.h"

FIXTURE(make_folder, remove_folder)

TEST(tolerance) {
    SUCCEED("factors", POLY, "--error", "0.01");
    ck_assert_double_le(value_of("error_estimate"), .01);
    ck_assert_double_gt(value_of("error_estimate"), .002);
    ck_assert_double_le(value_of("row_sum_max"), 1 + 1e-12);
    const double all = value_of("directions");
    SUCCEED("factors", POLY, "--error", "0.001", "--targets", "3,7,1000-1009");
    ck_assert_double_le(value_of("error_estimate"), .001);
    ck_assert_double_gt(value_of("directions"), all);
    SUCCEED("factors", POLY, "--error", "1e-7", "--targets", "3", "--cutoff", "1.1", "--points", "64");
    ck_assert_double_eq(value_of("directions"), 65536);
    ck_assert_double_gt(value_of("error_estimate"), 1e-7);
    assert_has(said, "warning: --error 1e-07 is not reached");
    ck_assert_double_gt(value_of("error_reached"), 1e-7);
}

TEST(summary) {
    SUCCEED("factors", POLY, "--directions", "34");
    static const char *const keys[] = {"spheres",     "directions",      "threads",        "seconds",
                                       "nonzeros",    "row_sum_min",     "row_sum_max",    "escaped_mean",
                                       "closure_max", "reciprocity_max", "error_estimate", "fallbacks"};
    const char *at = printed;
    for (size_t k = 0; k < sizeof keys / sizeof *keys; ++k) {
        ck_assert_msg((at = strstr(at, keys[k])) != NULL, "%s is missing or out of order", keys[k]);
        value_of(keys[k]);
    }
    ck_assert_double_eq(value_of("spheres"), 2000);
    ck_assert_double_eq(value_of("directions"), fibrad_line_set_lines(34));
    ck_assert_double_le(value_of("row_sum_max"), 1 + 1e-12);
    ck_assert_double_lt(value_of("closure_max"), 1e-12);
    ck_assert_double_lt(value_of("reciprocity_max"), 1e-14);
    ck_assert_double_gt(value_of("overlap_max"), 0);
    ck_assert_str_eq(said, "");
}

/* Points of a sphere within another one see only that. The warning says by how much a row errs: by 4e7 rays from the
 * smaller sphere, which stay within the larger one where they begin there, .0042 and .0072. */
TEST(overlaps_warn_with_their_error) {
    static const double large[2] = {2, 4}, right[2] = {.19185, .26553};
    for (int k = 0; k < 2; ++k) {
        const char *pair = write_file("o.csv", formatted("x,y,z,r\n0,0,0,1\n0,0,%g,%g\n", .7 + large[k], large[k]));
        const char *f = in_folder("of.csv"), *at;
        double factor, error;
        SUCCEED("factors", pair, "--directions", "4000", "-o", f);
        ck_assert_int_eq(sscanf(read_file(f), "%*s 0,1,%lf", &factor), 1);
        ck_assert_ptr_nonnull(at = strstr(said, "their view factors err by about "));
        ck_assert_int_eq(sscanf(at, "their view factors err by about %lf", &error), 1);
        ck_assert_double_eq_tol(right[k] - factor, error, .4 * error);
    }
}

/* The exact factor has no other limit, but beds have. */
TEST(a_centre_within_a_sphere_warns) {
    SUCCEED("pair", "1", "1", "-.9");
    ck_assert_str_eq(said, "");
    SUCCEED("pair", "1", "1", "-1.5");
    assert_has(said, "warning: the centre of one sphere lies inside the other");
}

TEST(same_bytes_for_any_threads) {
    static const char *const threads[] = {"1", "2", "7"};
    char *first = NULL;
    for (int k = 0; k < 3; ++k) {
        const char *out = in_folder("F.csv");
        SUCCEED("factors", POLY, "--directions", "34", "--threads", threads[k], "-o", out);
        ck_assert_double_eq(value_of("threads"), k == 0 ? 1 : k == 1 ? 2 : 7);
        read_same(out, &first);
    }
}

/* In a box the rows add up to 1 with the walls, nothing escapes, and the walls' own rows are reciprocal. */
TEST(walls) {
    enum { SPHERES = 2000, WALLS = 6 };
    static double sum[SPHERES], to[SPHERES][WALLS], wall_sum[WALLS], between[WALLS][WALLS];
    char *first = NULL;
    for (int k = 0; k < 2; ++k) {
        const char *out = in_folder("F.csv");
        SUCCEED("factors", MONO, "--positions", "--directions", "50", "--wall", "auto", "--threads", k == 0 ? "1" : "3",
                "-o", out, "--json", in_folder("F.json"));
        read_same(out, &first);
    }
    ck_assert(value_of("escaped_mean") == 0);
    ck_assert_double_lt(value_of("closure_max"), 1e-13);
    int back = 0;
    for (char *line = strchr(first, '\n') + 1; *line; line = strchr(line, '\n') + 1) {
        const long i = strtol(line, &line, 10), j = strtol(line + 1, &line, 10);
        const double f = strtod(line + 1, &line);
        ck_assert(i < SPHERES && j < SPHERES && i >= -1 - WALLS && j >= -1 - WALLS && f > 0);
        if (i >= 0) sum[i] += f;
        if (i >= 0 && j < -1) to[i][-2 - j] = f;
        const double area = i >= -5 ? 12 * 50 : 12 * 12;
        if (i < -1) wall_sum[-2 - i] += f;
        if (i < -1 && j < -1) between[-2 - i][-2 - j] = f * area;
        if (i < -1 && j >= 0) {
            ck_assert_double_eq_tol(f * area, acos(-1) * to[j][-2 - i], 1e-13);
            ++back;
        }
    }
    ck_assert_int_gt(back, 1000);
    assert_has(first, ",zmin:xmax\n");
    for (int b = 0; b < WALLS; ++b) {
        ck_assert_double_eq_tol(wall_sum[b], 1, 1e-13);
        for (int c = 0; c < WALLS; ++c) ck_assert_double_eq_tol(between[b][c], between[c][b], 1e-13);
    }
    ck_assert_double_gt(between[5][0], 10); /* the lid and a side see each other */
    ck_assert_double_eq_tol(value_of("wall_zmax_to_walls") * 12 * 12,
                            between[5][0] + between[5][1] + between[5][2] + between[5][3] + between[5][4], .1);
    ck_assert_double_lt(value_of("wall_zmax_error"), .01);
    ck_assert_double_lt(value_of("wall_correction"), .01);
    double mean = 0;
    for (int i = 0; i < SPHERES; ++i) {
        ck_assert_double_eq_tol(sum[i], 1, 1e-13);
        mean += to[i][4] / SPHERES;
    }
    ck_assert_double_eq_tol(json_of(in_folder("F.json"), "wall_zmin_F"), mean, 1e-13);
    SUCCEED("factors", PERIODIC, "--directions", "50", "--wall", "auto"); /* a deep bed sees all of an endless wall */
    ck_assert_double_eq_tol(value_of("wall_zmin_F") * SPHERES * acos(-1), 12 * 12, .02);
    ck_assert_double_eq_tol(value_of("wall_zmax_F") * SPHERES * acos(-1), 12 * 12, .02);
    SUCCEED("factors", MONO, "--directions", "13", "--wall", "cylinder:6,6,9,zmin,zmax:open", "--targets", "1-9");
    ck_assert_double_gt(value_of("wall_cylinder_F"), 0);
    static const struct {
        const char *cylinder, *name;
    } along[] = {{"cylinder:6,7,2,zmin:at=3,zmax:at=13", "cylinder"},
                 {"xcylinder:7,8,2,xmin:at=1,xmax:at=11", "xcylinder"},
                 {"ycylinder:6,8,2,ymin:at=2,ymax:at=12", "ycylinder"}};
    const char *sphere = write_file("sphere.csv", "x,y,z,r\n6,7,8,1\n"), *picture = in_folder("sphere.svg");
    for (int k = 0; k < 3; ++k) { /* discs at a distance of 2.5 radii */
        char key[32];
        snprintf(key, sizeof key, "wall_%s_F", along[k].name);
        SUCCEED("factors", sphere, "--wall", along[k].cylinder, "-o", in_folder("F.csv"), "--plot", picture);
        ck_assert_double_eq_tol(value_of(key), 2.5 / hypot(1, 2.5), 2e-6);
        ck_assert_double_eq_tol(value_of("escaped_mean"), 0, 1e-14);
    }
    FAIL_WITH(3, "factors", MONO, "--wall", "zmin:at=2");
    expect_message(MONO ":", "lies beyond the wall zmin");
}

/* Number `column`, counted from 0, of the line of a .csv that has a given end. NAN: there is no such line. */
static double number_of_line(const char *path, const char *end, int column) {
    char *text = read_file(path), *at = strstr(text, end);
    double number = NAN;
    if (at) {
        while (at > text && at[-1] != '\n') --at;
        for (; column > 0; --column) at = strchr(at, ',') + 1;
        number = strtod(at, NULL);
    }
    return number;
}

/* A box without a lid is compared with one whose lid is black and as hot as the surroundings. */
TEST(a_box_without_a_lid) {
    const char *open = in_folder("open.csv"), *closed = in_folder("closed.csv"), *json = in_folder("open.json");
#define STATE "--length-unit=mm", "--emissivity=.6", "--temperature=500", "--ambient=300", "--directions=30"
    const char *walls = "--wall=box:temperature=600:emissivity=.4,zmin:temperature=900:emissivity=.4";
    SUCCEED("heat", MONO, STATE, walls, "--wall=zmax:open", "-o", open, "--json", json, "--plot",
            in_folder("open.svg"));
    const char *lid = formatted("--wall=zmax:at=%.17g:temperature=300", json_of(json, "open_zmax_at"));
    SUCCEED("heat", MONO, STATE, lid, walls, "-o", closed);
#undef STATE
    const char *const lines[] = {",xmin", ",ymax", ",zmin", "\n4,", "\n1000,"};
    for (size_t k = 0; k < sizeof lines / sizeof *lines; ++k)
        ck_assert_double_eq(number_of_line(open, lines[k], 2), number_of_line(closed, lines[k], 2));
    ck_assert_double_gt(number_of_line(open, ",surroundings", 2), 1e-3);
    ck_assert_double_eq(number_of_line(open, ",surroundings", 2), number_of_line(closed, ",zmax", 2));
    ck_assert(isnan(number_of_line(open, ",zmax", 2)));
    FAIL_WITH(3, "factors", MONO, "--wall", "box,zmax:open:at=13");
    expect_message(MONO ":", "reaches beyond an opening");
    SUCCEED("factors", PERIODIC, "--directions=13", "--wall", "zmin,zmax:open");
    ck_assert_double_gt(value_of("escaped_mean"), 0);
}

/* The rows of a target list are those of --raw, and the matrix market file holds the same as the CSV file. */
/* Rays are the same for any number of threads. Other seeds give other rays. */
TEST(rays) {
    static const char *const methods[] = {"cast", "mc"};
    for (int m = 0; m < 2; ++m) {
        char *text[3];
        for (int k = 0; k < 3; ++k) {
            const char *out = in_folder("F.csv");
            SUCCEED("factors", POLY, "--method", methods[m], "--rays", "500", "--threads", k == 1 ? "3" : "1", "--seed",
                    k == 2 ? "1" : "0", "-o", out);
            ck_assert_double_eq(value_of("rays"), 500);
            ck_assert_double_le(value_of("row_sum_max"), 1 + 1e-12);
            ck_assert_double_lt(value_of("closure_max"), 1e-12);
            ck_assert_double_lt(value_of("reciprocity_max"), 1e-14);
            text[k] = read_file(out);
        }
        ck_assert_str_eq(text[0], text[1]);
        ck_assert_str_ne(text[0], text[2]);
    }
}

/* Reads a file of the test's folder, which may have any bytes. */
static char *read_bytes(const char *name, size_t *size) {
    struct stat there;
    ck_assert_int_eq(stat(in_folder(name), &there), 0);
    *size = (size_t)there.st_size;
    return read_file(in_folder(name));
}

/* Rows kept in files are written as rows kept in memory are, and no other file remains. */
TEST(rows_in_files) {
    static const char *const names[2][3] = {{"a.csv", "a.npz", "a.json"}, {"b.csv", "b.npz", "b.json"}};
    const char *scratch = in_folder("scratch");
    ck_assert_int_eq(mkdir(scratch, 0777), 0);
    SUCCEED("factors", PERIODIC, "--emissivity=.5", "--directions=8", "--rays=9", "--wall=zmin:emissivity=.5", "-o",
            in_folder(names[0][0]), "-o", in_folder(names[0][1]), "-o", in_folder(names[0][2]));
    SUCCEED("factors", PERIODIC, "--emissivity=.5", "--directions=8", "--rays=9", "--wall=zmin:emissivity=.5", "-o",
            in_folder(names[1][0]), "-o", in_folder(names[1][1]), "-o", in_folder(names[1][2]), "--scratch", scratch);
    ck_assert_double_lt(value_of("reciprocity_max"), 1e-14);
    for (int k = 0; k < 3; ++k) {
        size_t first, second;
        char *kept = read_bytes(names[0][k], &first), *filed = read_bytes(names[1][k], &second);
        ck_assert_uint_eq(first, second);
        ck_assert_int_eq(memcmp(kept, filed, first), 0);
    }
    ck_assert_int_eq(rmdir(scratch), 0); /* empty */
    remove_files(0);
    FAIL_WITH(4, "factors", MONO, "--scratch", scratch);
    expect_message(scratch, "No such file or directory");
    FAIL_WITH(4, "factors", MONO, "--emissivity=.5", "--scratch", PERIODIC, "-o", in_folder("D.csv"));
    ck_assert_int_eq(remove_files(0), 0);
}

/* A line of this set of directions runs nearly along the layers of the bed. There a circle meets so many images that it
 * is followed in stretches. */
TEST(a_line_along_layers) {
    SUCCEED("factors", PERIODIC, "--directions", "362");
    ck_assert_double_eq(value_of("directions"), 362);
    ck_assert_double_lt(value_of("closure_max"), 1e-13);
    ck_assert_double_lt(value_of("reciprocity_max"), 1e-15);
}

TEST(targets_and_formats) {
    const char *all = in_folder("all.csv"), *some = in_folder("some.csv"), *matrix = in_folder("all.mtx");
    SUCCEED("factors", PERIODIC, "--positions", "--directions", "21", "--raw", "-o", all);
    ck_assert_double_lt(value_of("closure_max"), 1e-12);
    SUCCEED("factors", PERIODIC, "--positions", "--directions", "21", "--raw", "-o", matrix);
    SUCCEED("factors", PERIODIC, "--positions", "--directions", "21", "--targets", "1999,0,7-9,8", "-o", some);
    ck_assert(isnan(value_of("reciprocity_max")));
    char *all_text = read_file(all), *some_text = read_file(some), *matrix_text = read_file(matrix);
    char *row = strchr(some_text, '\n') + 1, *entry = matrix_text;
    for (int k = 0; k < 3; ++k) entry = strchr(entry, '\n') + 1;
    for (char *line = strchr(all_text, '\n') + 1; *line; line = strchr(line, '\n') + 1) {
        char *at = line;
        const long i = strtol(at, &at, 10), j = strtol(at + 1, &at, 10);
        const double f = strtod(at + 1, &at);
        if (j >= 0) {
            ck_assert_int_eq(strtol(entry, &entry, 10), i + 1);
            ck_assert_int_eq(strtol(entry, &entry, 10), j + 1);
            ck_assert_double_eq(strtod(entry, &entry), f);
        }
        if (i != 0 && i != 1999 && (i < 7 || i > 9)) continue;
        at = strchr(at, '\n');
        ck_assert_int_eq(strncmp(line, row, (size_t)(at - line) + 1), 0);
        row += at - line + 1;
    }
    ck_assert_int_eq(*row, 0);
    ck_assert_str_eq(entry, "\n");
}

/* Two spheres are seen through periodic faces and in the open, from a CSV file and from standard input. */
TEST(frames_periods_and_ids) {
    const char *dump = write_file("two.dump", TWO_SPHERES("0", "ff ff ff", "1 1 4 4 70\n1 7 4 4 5\n")
                                                  TWO_SPHERES("1", "pp ff ff", "1 1 4 4 70\n1 7 4 4 5\n"));
    SUCCEED("factors", dump, "--frame", "0");
    ck_assert_double_eq_tol(value_of("row_sum_min"), 0.00704, 1e-3);
    ck_assert_double_eq(value_of("nonzeros"), 2);
    SUCCEED("factors", dump);
    const double across = value_of("row_sum_min");
    ck_assert_double_eq_tol(across, 0.0755868 + 0.0070444, 1e-3); /* seen across the face, and within the box */
    SUCCEED("factors", dump, "--frame", "0", "--periodic", "8,0,0");
    ck_assert_double_eq(value_of("row_sum_min"), across);
    SUCCEED("factors", dump, "--periodic", "none", "--targets", "70", "-o", in_folder("ids.csv"));
    ck_assert_double_lt(value_of("row_sum_min"), 0.01);
    assert_begins(read_file(in_folder("ids.csv")), "i,j,F,body\n70,5,");
    input = dump;
    SUCCEED("factors", "-");
    ck_assert_double_eq(value_of("row_sum_min"), across);
    input = "/dev/null";
}

/* Reads the lines i,T_K,q_W of a file: their number, their sum, the largest q, and the line of one wall. */
static int read_powers(const char *path, double *sum, double *largest, long wanted, double *temperature,
                       double *power) {
    char *text = read_file(path), *line = strchr(text, '\n');
    int count = 0;
    ck_assert_int_eq(strncmp(text, "i,T_K,q_W,q_error_W,T_error_K,body\n", 15), 0);
    for (*sum = *largest = 0; line && line[1]; line = strchr(line + 1, '\n'), count++) {
        long i;
        double t, q;
        ck_assert_int_eq(sscanf(line + 1, "%ld,%lf,%lf", &i, &t, &q), 3);
        *sum += q;
        *largest = fmax(*largest, fabs(q));
        if (i == wanted) *temperature = t, *power = q;
    }
    return count;
}

/* The powers of spheres and walls are given, and their temperatures are found. If there are none, the program says
 * why. */
TEST(temperatures) {
    const char *file = write_file("warm.csv", "x,y,z,r,eps,type\n0,0,0,1,.5,1\n3,0,0,1,.8,2\n0,2.5,0,.7,0,1\n");
    const char *out = in_folder("q.csv");
    double sum, largest, t = 0, q = 0;
    SUCCEED("heat", file, "--emissivity", "eps", "--temperature", "2:900", "--power", "1:0", "--ambient", "300", "-o",
            out);
    ck_assert_int_eq(read_powers(out, &sum, &largest, 0, &t, &q), 4);
    ck_assert(t > 300 && t < 900 && q == 0);
    ck_assert_double_eq(value_of("temperature_mean_K"), value_of("temperature_min_K"));
    read_powers(out, &sum, &largest, 2, &t, &q);
    ck_assert(isnan(t) && q == 0);

    /* in millimetres, areas and the powers in proportion to them are 1e6 times smaller */
    double warm[2];
    for (int k = 0; k < 2; ++k) {
        SUCCEED("heat", file, "--emissivity", ".5", "--power", k ? "4e-3" : "4e3", "--length-unit", k ? "mm" : "m",
                "--wall", "box:insulated:emissivity=.6,zmax:temperature=400:emissivity=.6", "--wall",
                k ? "xmin:power=1e-2:emissivity=.6" : "xmin:power=1e4:emissivity=.6", "-o", out);
        read_powers(out, &sum, &largest, 1, &warm[k], &q);
        ck_assert_double_le(fabs(sum), 1e-12 * largest);
        ck_assert_double_eq_tol(q, k ? -4e-3 : -4e3, 1e-14 * fabs(q));
        ck_assert_double_eq_tol(value_of("wall_xmin_W"), k ? -1e-2 : -1e4, 1e-6 * fabs(q));
        ck_assert_double_gt(value_of("wall_xmin_K"), 400);
        ck_assert_double_gt(value_of("wall_zmin_K"), 400);
    }
    ck_assert_double_eq_tol(warm[0], warm[1], 1e-9 * warm[0]);

    /* emissivities come from a table: at 600 K they are .5, whatever the type */
    const char *table = write_file("eps.csv", "# K\nT_K,emissivity\n500,.6\n\n700;.4\n");
    const char *all = formatted("@%s", table), *const law[] = {".5", all, formatted("1:@%s,2:.5", table)};
    double power[3];
    for (int k = 0; k < 3; ++k) {
        SUCCEED("heat", file, "--length-unit", "m", "--emissivity", law[k], "--temperature", "600", "--ambient", "300",
                "-o", out);
        read_powers(out, &sum, &largest, 0, &t, &power[k]);
    }
    ck_assert(power[0] == power[1] && power[0] == power[2]);
    FAIL_WITH(2, "heat", file, "--emissivity", all, "--ambient", "300");
    write_file("eps.csv", "500,.6\n700,1.4\n");
    FAIL_WITH(3, "heat", file, "--emissivity", all, "--temperature", "600", "--ambient", "300");
    expect_message(table, "the emissivity is 1.4; it must be within 0 and 1");
    write_file("eps.csv", "500,.6\n400,.4\n");
    FAIL_WITH(3, "heat", file, "--emissivity", all, "--temperature", "600", "--ambient", "300");
    expect_message(table, ":2: 400 is not above the number before");

    FAIL_WITH(3, "heat", file, "--length-unit", "m", "--emissivity", ".5", "--power", "4", "--wall", "box:insulated");
    expect_message(file, "its powers add up to 12 W, not to 0");
    FAIL_WITH(3, "heat", file, "--length-unit", "m", "--emissivity", ".5", "--power", "1:4,2:-8", "--wall",
              "box:insulated");
    expect_message(file, "no temperature is given in this closed bed; give one, or --ambient");
    FAIL_WITH(3, "heat", file, "--length-unit", "m", "--emissivity", ".5", "--power", "1:.15,2:-.1", "--wall",
              "box:insulated,xmin:power=-.2");
    expect_message(file, "no temperature is given in this closed bed; give one, or --ambient");
    ck_assert_int_eq(
        RUN("heat", file, "--length-unit", "m", "--emissivity", ".5", "--power", "-1e6", "--ambient", "300"), 3);
    expect_message(file, "sphere 0: no temperature above 0 K gives off -1e+06 W here");
    ck_assert_int_eq(
        RUN("heat", file, "--length-unit", "m", "--emissivity", ".5", "--power", "1:4", "--ambient", "300"), 3);
    expect_message(file, "sphere 1 has neither a temperature nor a power");
    FAIL_WITH(3, "heat", file, "--length-unit", "m", "--emissivity", ".5", "--power", "1:4", "--temperature", "1:4,2:5",
              "--ambient", "300");
    expect_message(file, "sphere 0 has both a temperature and a power");
    FAIL_WITH(3, "heat", file, "--length-unit", "m", "--emissivity", "eps", "--power", "4", "--ambient", "300");
    expect_message(file, "sphere 2 has emissivity 0 and cannot give off 4 W");
}

/* Root mean square difference between T^4 of the spheres of two .csv, over that of the first. */
static double emission_difference(const char *path, const char *other) {
    char *text[2] = {read_file(path), read_file(other)}, *line[2];
    double difference = 0, all = 0;
    for (int k = 0; k < 2; ++k) line[k] = strchr(text[k], '\n') + 1;
    while (*line[0] && *line[1] && *line[0] != '-') {
        double t[2];
        for (int k = 0; k < 2; ++k) {
            ck_assert_int_eq(sscanf(line[k], "%*d,%lf", &t[k]), 1);
            line[k] = strchr(line[k], '\n') + 1;
        }
        difference += pow(pow(t[0], 4) - pow(t[1], 4), 2), all += pow(t[0], 8);
    }
    return sqrt(difference / all);
}

/* --error also holds for temperatures of spheres and walls that are found. */
TEST(temperatures_to_an_error) {
    enum { SIDE = 3 };
    char bed[2000] = "x,y,z,r\n";
    for (int i = 0; i < SIDE * SIDE * SIDE; ++i)
        snprintf(bed + strlen(bed), 60, "%d,%d,%d,%g\n", 2 * (i % 3), 2 * (i / 3 % 3), 2 * (i / 9), .95 - .2 * (i % 4));
    const char *file = write_file("found.csv", bed), *out = in_folder("found.out.csv"), *fine = in_folder("fine.csv");
    double sum, largest, wall[2], q;
#define WALL ":emissivity=.4"
    for (int k = 0; k < 4; ++k) { /* first finely, then to an error; open, then in a box */
        const char *to = k % 2 ? out : fine;
        SUCCEED("heat", file, "--length-unit", "m", "--emissivity", ".4", "--power", "4000", "--ambient=300",
                k % 2 ? "--error=.004" : "--directions=1500", k % 2 ? "--threads=2" : "--patches=384", "-o", to,
                k < 2 ? "--threads=2" : "--wall=box:temperature=400" WALL ",ymax:insulated" WALL,
                k < 2 ? "--threads=2" : "--wall=xmin:power=20000" WALL ",zmin:temperature=900" WALL);
        assert_lacks(said, "is not reached");
        if (k >= 2) read_powers(to, &sum, &largest, -2, &wall[k % 2], &q);
        if (k % 2 == 0) continue;
        ck_assert_double_gt(value_of("directions"), 72);
        ck_assert_double_le(emission_difference(fine, out), .004);
    }
    ck_assert_double_le(4 * fabs(wall[1] / wall[0] - 1), .004);
}

TEST(powers) {
    const char *file = write_file("hot.csv", "x,y,z,r,eps,T\n0,0,0,1,.5,600\n2,0,0,1,.8,300\n0,2.5,0,.7,1,450\n");
    const char *out = in_folder("q.csv");
    double sum, largest, t = 0, q = 0;
    SUCCEED("heat", file, "--emissivity", "eps", "--temperature", "T", "--ambient", "300", "-o", out);
    ck_assert_int_eq(read_powers(out, &sum, &largest, 0, &t, &q), 4);
    ck_assert_double_eq(t, 600);
    ck_assert_double_lt(q, 0);
    ck_assert_double_le(fabs(sum), 1e-12 * largest);
    ck_assert_double_le(fabs(value_of("balance_of_emission")), 1e-12);
    ck_assert_double_eq(value_of("spheres"), 3);

    /* walls are -2, -3 in the order given; the bytes are the same for any number of threads */
    char *text[2];
    for (int k = 0; k < 2; ++k) {
        SUCCEED("heat", file, "--emissivity", "eps", "--temperature", "T", "--wall",
                "zmax:at=3:temperature=700:emissivity=.5,zmin:at=-1:temperature=400,cylinder:0,0,5:temperature=500",
                "--threads", k == 0 ? "1" : "3", "-o", out, "--json", in_folder("q.json"));
        text[k] = read_file(out);
    }
    ck_assert_str_eq(text[0], text[1]);
    assert_lacks(text[0], "surroundings"); /* the room is closed: the surroundings get nothing */
    assert_has(text[0], ",cylinder\n");
    ck_assert_int_eq(read_powers(out, &sum, &largest, -2, &t, &q), 6);
    ck_assert_double_eq(t, 700);
    ck_assert_double_eq(q, json_of(in_folder("q.json"), "wall_zmax_W"));
    ck_assert_double_le(fabs(sum), 1e-12 * largest);
    read_powers(out, &sum, &largest, -4, &t, &q);
    ck_assert_double_eq(t, 500);

    /* all have one temperature: figures are relative to what is emitted */
    SUCCEED("heat", file, "--emissivity", ".3", "--temperature", "500", "--wall", "box:temperature=500:emissivity=.2",
            "-o", out);
    read_powers(out, &sum, &largest, 0, &t, &q);
    ck_assert_double_le(largest, 1e-10 * 5.67e-8 * 500. * 500. * 500. * 500.);
    ck_assert_double_le(fabs(value_of("balance_of_emission")), 1e-12);
    ck_assert_double_le(value_of("error_of_emission"), 1e-9);
    ck_assert_double_eq_tol(value_of("emitted_W"), .3 * 5.670374419e-8 * pow(500, 4) * 4 * acos(-1) * 2.49, 1);
    SUCCEED("heat", file, "--emissivity", ".3", "--temperature", "500", "--wall", "box:temperature=500", "--error",
            ".01", "--length-unit", "m"); /* powers that are nothing but noise reach the error, too */
    ck_assert_str_eq(said, "");

    SUCCEED("heat", file, "--emissivity", ".3", "--temperature", "T", "--ambient", "0", "--error", "0.01", "-o",
            in_folder("q.vtp"));
    ck_assert_double_le(value_of("error_rms_W") / value_of("power_rms_W"), .01);
    char *vtp = read_file(in_folder("q.vtp"));
    ck_assert(strstr(vtp, "Name=\"power_W\"") && strstr(vtp, "Name=\"temperature_K\"") && strstr(vtp, "</VTKFile>"));
    SUCCEED("heat", file, "--emissivity", ".3", "--temperature", "T", "--ambient", "0");
    ck_assert_double_eq(value_of("directions"), 112); /* fewer where errors of patches are larger */
    SUCCEED("heat", file, "--emissivity", ".5", "--temperature", "T", "--ambient", "0");
    ck_assert_double_eq(value_of("directions"), 168);
    FAIL_WITH(3, "heat", file, "--emissivity", "eps", "--temperature", "missing", "--ambient", "0");
    const char *cold = write_file("cold.csv", "x,y,z,r,T\n0,0,0,1,-1\n");
    FAIL_WITH(3, "heat", cold, "--emissivity", "1", "--temperature", "T", "--ambient", "0");
    expect_message(cold, "the temperature in kelvins is -1; it must be within 0 and 1e+09");
}

/* Rows of the .csv close with the surroundings (-1) and walls (-2, -3, ...). They are reciprocal with areas times
 * emissivity. The bytes do not depend on the number of threads. */
TEST(exchange_factors) {
    enum { N = 12 };
    static double d[N][N];
    double sum[N] = {0}, weight[N];
    char bed[2000] = "x,y,z,e,r\n";
    for (int i = 0; i < N; ++i) {
        const double r = .5 + .04 * i, e = .3 + .05 * i;
        snprintf(bed + strlen(bed), 100, "%d,%d,%d,%.17g,%.17g\n", 2 * (i % 3), 2 * (i / 3 % 2), 2 * (i / 6), e, r);
        weight[i] = r * r * e;
    }
    const char *file = write_file("bed.csv", bed), *out = in_folder("D.csv"), *other = in_folder("E.csv");
    SUCCEED("factors", file, "--emissivity", "e", "--rays", "300", "--wall",
            "zmin:at=-1.5:emissivity=.5,zmax:at=4:emissivity=0", "--threads", "1", "-o", out);
    ck_assert_double_lt(value_of("closure_max"), 1e-12);
    ck_assert_double_lt(value_of("reciprocity_max"), 1e-12);
    ck_assert_double_lt(value_of("error_estimate"), .1);
    SUCCEED("factors", file, "--emissivity", "e", "--rays", "300", "--wall",
            "zmin:at=-1.5:emissivity=.5,zmax:at=4:emissivity=0", "--threads", "3", "-o", other);
    char *text = read_file(out), *again = read_file(other);
    ck_assert_str_eq(text, again);
    assert_begins(text, "i,j,D,body\n");
    for (char *line = strchr(text, '\n') + 1; *line; line = strchr(line, '\n') + 1) {
        int i, j;
        double factor;
        ck_assert_int_eq(sscanf(line, "%d,%d,%lg", &i, &j, &factor), 3);
        ck_assert(j != -3 && i >= -3 && j >= -2); /* wall -3 reflects all, so nothing goes to it */
        if (i < 0) continue;
        sum[i] += factor;
        if (j >= 0) d[i][j] = factor;
    }
    for (int i = 0; i < N; ++i) {
        ck_assert_double_eq_tol(sum[i], 1, 1e-12);
        for (int j = 0; j < N; ++j) ck_assert_double_eq_tol(weight[i] * d[i][j], weight[j] * d[j][i], 1e-14);
    }
    SUCCEED("factors", file, "--emissivity", "0.6", "--error", "0.02", "--drop", "0.001", "--threads", "2");
    ck_assert_double_lt(value_of("error_estimate"), .04);
    ck_assert_double_lt(value_of("closure_max"), 1e-12);
    FAIL_WITH(3, "factors", file, "--emissivity", "x");
    expect_message(file, "the emissivity is 2; it must be within 0 and 1");
    FAIL_WITH(3, "factors", file, "--emissivity", "missing");
    FAIL_WITH(2, "factors", file, "--emissivity", "e", "--wall", "emissivity=0.5");
    remove_files(0);
}

TEST(points_and_cutoff) {
    SUCCEED("factors", POLY, "--directions", "34", "--points", "64");
    ck_assert_double_le(value_of("row_sum_max"), 1 + 1e-12);
    ck_assert_double_lt(value_of("reciprocity_max"), 1e-14);
    const double entries = value_of("nonzeros");
    SUCCEED("factors", POLY, "--directions", "34", "--areas", "points", "--cutoff", "1.5");
    ck_assert_double_le(value_of("row_sum_max"), 1 + 1e-12);
    ck_assert_double_lt(value_of("nonzeros"), entries / 2);
    ck_assert_double_gt(value_of("beyond_mean"), .1); /* for the most part on other spheres */
    ck_assert_double_lt(value_of("closure_max"), 1e-12);
}

TEST(paraview_and_picture) {
    const char *points = in_folder("bed.vtp"), *svg = in_folder("bed.svg"), *png = in_folder("bed.png");
    SUCCEED("factors", MONO, "--directions", "21", "-o", points, "--plot", svg);
    char *text = read_file(points);
    assert_has(text, "NumberOfPoints=\"2000\"");
    assert_has(text, "</VTKFile>");
    text = read_file(svg);
    assert_has(text, "<svg");
    assert_has(text, "</svg>");
    SUCCEED("factors", MONO, "--directions", "21", "--targets", "1-99", "--plot", png);
    assert_begins(read_file(png), "\x89PNG");
    ck_assert_int_eq(remove_files(0), 3);
}

TEST(picture_without_gnuplot) {
    OWNED char *path = strdup(getenv("PATH"));
    ck_assert_int_eq(setenv("PATH", folder, 1), 0);
    ck_assert_int_eq(RUN("factors", write_file("a.csv", "x,y,z,r\n0,0,0,1\n"), "--plot", in_folder("a.png"), "-o",
                         in_folder("F.csv")),
                     4);
    ck_assert_int_eq(setenv("PATH", path, 1), 0);
    expect_message("", "gnuplot");
    ck_assert_int_eq(remove_files(0), 1); /* a.csv alone */
}
