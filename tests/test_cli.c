/* test_cli.c - the program as its users meet it: exit statuses, messages, files. SPDX-License-Identifier: MIT */
#include <time.h>

#include "program.h"

/* ---- usage ------------------------------------------------------------------------------------------------------ */

START_TEST(help_and_version) {
    SUCCEED("--help");
    ck_assert(strstr(printed, "bed") && strstr(printed, "pair"));
    SUCCEED("--version");
    ck_assert_int_eq(strncmp(printed, "fibrad ", 7), 0);
    SUCCEED("bed", "--help");
    static const char *const options[] = {"--method",  "--directions", "--areas",    "--points", "--cutoff",
                                          "--targets", "--threads",    "--periodic", "--frame",  "--positions",
                                          "--raw",     "--plot",       "-o",         "[233]",    "Example"};
    for (size_t k = 0; k < sizeof options / sizeof *options; ++k) ck_assert(strstr(printed, options[k]) != NULL);
    ck_assert(strstr(printed, "--nf") && strstr(printed, "--rays"));
    SUCCEED("pair", "1", "--help");
    ck_assert(strstr(printed, "--obstacle") && strstr(printed, "--check") && strstr(printed, "--rays"));
    ck_assert_str_eq(said, "");
}
END_TEST

static const struct {
    const char *arguments[9], *reason;
} misuse[] = {
    {{NULL}, "the command is missing"},
    {{"bad"}, "unknown command bad; see fibrad --help"},
    {{"--bad"}, "unknown option --bad; see fibrad --help"},
    {{"bed"}, "FILE is missing"},
    {{"bed", MONO, "--bad=3"}, "unknown option --bad; see fibrad bed --help"},
    {{"bed", MONO, "-x"}, "unknown option -x; see fibrad bed --help"},
    {{"pair", "1", "1", "0", "--raw"}, "unknown option --raw; see fibrad pair --help"},
    {{"bed", MONO, "-o"}, "--output needs an argument"},
    {{"bed", MONO, "--wall", "zmin,top"},
     "--wall: 'top' is none of auto, box, xmin ... zmax, cylinder:X,Y,R, mesh:FILE and NAME=mesh:FILE"},
    {{"bed", MONO, "--wall", "zmin,zmin=3"}, "--wall: zmin is named twice"},
    {{"bed", MONO, "--wall", "xmin,xmax,ymin,ymax,zmin"}, "add zmax=open (zmax=H:open"},
    {{"bed", MONO, "--wall", "cylinder:6,6,9"}, "add zmin=open,zmax=open"},
    {{"bed", PERIODIC, "--wall", "zmin=0,zmin=open"}, "--wall: zmin is named twice"},
    {{"heat", MONO, "--emissivity=.5", "--temperature=9", "--ambient=3", "--wall=box:open=zmax",
      "--wall-temperature=zmax=600"},
     "--wall-temperature: zmax is an opening"},
    {{"exchange", MONO, "--emissivity=.5", "--wall=box:open=zmax", "--wall-emissivity=zmax=.5"},
     "--wall-emissivity: zmax is an opening"},
    {{"heat", MONO, "--emissivity=.5", "--temperature=9", "--wall=box:open=zmax", "--wall-temperature=600"},
     "--ambient is missing: the bed is open"},
    {{"bed", MONO, "--wall", "zmax=open", "--method", "surface"}, "--wall is for the methods beam, cast and mc"},
    {{"bed", MONO, "--wall", "auto", "--method", "surface"}, "--wall is for the methods beam, cast and mc"},
    {{"bed", PERIODIC, "--wall", "box"}, "lies across a periodic axis"},
    {{"bed", MONO, "--raw=yes"}, "--raw takes no argument"},
    {{"bed", MONO, "-o", "out.txt"}, "unknown ending; there are .csv, .mtx, .npz, .vtp and .json"},
    {{"bed", MONO, "--plot", "out.pdf"}, "unknown ending; there are .svg and .png"},
    {{"bed", MONO, "--frame", "2:1"}, "--frame: '2:1' is none of K, all, A:B, A:B:STEP, -1"},
    {{"bed", MONO, "--frame", "-2"}, "--frame: '-2' is none of"},
    {{"bed", MONO, "--frame", "0:9:0"}, "--frame: '0:9:0' is none of"},
    {{"bed", MONO, "--frame=all", "--plot", "bed.svg"}, "--plot shows one frame"},
    {{"bed", MONO, "--length-unit", "furlong"}, "--length-unit: 'furlong' is none of m, cm, mm"},
    {{"bed", MONO, "--length-unit", "lj"}, "--length-unit: 'lj' is none of"},
    {{"bed", MONO, "--radius", "0"}, "--radius: 0 is not within"},
    {{"bed", MONO, "--radius", "1:2,1:3"}, "--radius: type 1 is named twice"},
    {{"bed", MONO, "--radius", "1:2,x"}, "is not a list like 1:0.5,2:0.8"},
    {{"bed", MONO, "--raw", "--drop=.1"}, "--drop needs rows that are averaged"},
    {{"bed", MONO, "--method", "surface", "--nf", "56"}, "--nf: 56 is not built in; 8, 13, 21"},
    {{"bed", MONO, "--nf", "55"}, "are for --method surface"},
    {{"bed", MONO, "--method", "magic"}, "'magic' is not a method"},
    {{"bed", MONO, "--method", "exact"}, "--method exact is for pairs only"},
    {{"bed", MONO, "--rays", "100"}, "--rays and --seed are for --method cast and mc"},
    {{"bed", MONO, "--method=cast", "--rays", "0"}, "--rays: '0' is not a whole number from 1 to 4294967295"},
    {{"bed", MONO, "--method=mc", "--seed", "-1"}, "--seed: '-1'"},
    {{"bed", MONO, "--method=cast", "--directions", "100"}, "are for --method beam"},
    {{"exchange", MONO}, "--emissivity is missing"},
    {{"exchange", MONO, "--emissivity", "-1"}, "--emissivity: -1 is not within"},
    {{"exchange", MONO, "--emissivity", "1:2"}, "--emissivity: 2 is not within"},
    {{"exchange", MONO, "--emissivity=.5", "--wall=zmin", "--wall-emissivity=.5,.6"},
     "--wall-emissivity: two numbers have no name"},
    {{"exchange", MONO, "--emissivity=.5", "--wall=zmin", "--wall-emissivity=zmax=.5"},
     "there is no wall zmax; there are zmin"},
    {{"exchange", MONO, "--emissivity=.5", "--wall=zmin", "--wall-emissivity=zmin=1.5"}, "1.5 is not within"},
    {{"exchange", MONO, "--emissivity=.5", "--wall=zmin", "--wall-emissivity=zmin"},
     "neither NAME=NUMBER nor a number"},
    {{"exchange", MONO, "--emissivity=.5", "--wall-emissivity=.5"}, "--wall-emissivity: there are no walls"},
    {{"exchange", MONO, "--emissivity", "1.5"}, "--emissivity: 1.5 is not within 0 and 1"},
    {{"exchange", MONO, "--emissivity=.5", "--error=.1", "--rays=9"}, "leave out --rays"},
    {{"exchange", MONO, "--emissivity=.5", "--raw", "--drop=.1"}, "--drop needs rows that are averaged"},
    {{"exchange", MONO, "--emissivity=.5", "-o", "D.dump"}, "unknown ending; there are .csv, .mtx, .npz"},
    {{"heat", "--emissivity=.5"}, "FILE is missing"},
    {{"heat", MONO, "--temperature", "v_T"}, "--emissivity is missing"},
    {{"heat", MONO, "--emissivity", ".5"}, "--temperature or --power is missing"},
    {{"heat", MONO, "--emissivity=.5", "--temperature", "-3"}, "--temperature: -3 is below absolute zero"},
    {{"heat", MONO, "--emissivity=.5", "--temperature=9", "--patches=100"}, "--patches: 100 is not built in"},
    {{"heat", MONO, "--emissivity=.5", "--temperature=9", "--model=fine"},
     "'fine' is none of patches, spheres and factors"},
    {{"heat", MONO, "--emissivity=.5", "--temperature=9", "--error=.1", "--points=64"}, "leave out --directions"},
    {{"heat", MONO, "--emissivity=.5", "--temperature=9", "--wall-temperature=3,4"}, "there are no walls"},
    {{"heat", MONO, "--emissivity=.5", "--temperature=9", "--temperature-unit=F"}, "'F' is neither K nor C"},
    {{"heat", MONO, "--emissivity=.5", "--temperature=9", "--ambient=-1"}, "--ambient: -1 is not within"},
    {{"heat", MONO, "--emissivity=.5", "--temperature=9"}, "--ambient is missing: the bed is open"},
    {{"heat", MONO, "--emissivity=.5", "--temperature=9", "--ambient=3", "--wall=auto", "--wall-temperature=300,400"},
     "two numbers have no name; name the walls, xmin=400 for example"},
    {{"heat", MONO, "--emissivity=.5", "--temperature=9", "--ambient=3", "--wall=zmin"},
     "--wall-temperature: zmin has no value; give zmin=NUMBER"},
    {{"heat", MONO, "--emissivity=.5", "--temperature=9", "--power=4"}, "a sphere has one of them only"},
    {{"heat", MONO, "--emissivity=.5", "--power=1e40"}, "--power: 1e40 is not within"},
    {{"heat", MONO, "--emissivity=.5", "--power=4", "--ambient=3", "--wall=zmin", "--wall-power=zmin=1",
      "--wall-temperature=zmin=3"},
     "zmin has both a temperature and a power"},
    {{"heat", MONO, "--emissivity=.5", "--power=4", "--ambient=3", "--wall=zmin", "--wall-power=zmin=1"},
     "zmin is endless and needs a --wall-temperature"},
    {{"heat", MONO, "--emissivity=.5", "--power=4", "--ambient=3", "--wall=zmin", "--wall-temperature=isolated"},
     "'isolated' is neither NAME=NUMBER nor a number"},
    {{"heat", MONO, "--emissivity=.5", "--temperature=9", "-o", "q.mtx"},
     "unknown ending; there are .csv, .vtp, .json, .dump"},
    {{"conductivity", MONO}, "--emissivity is missing"},
    {{"conductivity", "--emissivity", ".5"}, "FILE is missing"},
    {{"join"}, "FILE is missing"},
    {{"join", MONO, "-o", "D.dump"}, "unknown ending; there are .csv, .mtx, .npz"},
    {{"bed", MONO, "--directions", "7"}, "'7' is not a whole number from 8 to 65536"},
    {{"bed", MONO, "--error", "0"}, "--error: 0 is not within 1e-07 and 1"},
    {{"bed", MONO, "--error", "1e-8"}, "--error: 1e-8 is not within 1e-07 and 1"},
    {{"bed", MONO, "--error", "small"}, "--error: 'small' is not a number"},
    {{"bed", MONO, "--error", "nan"}, "--error: 'nan' is not a number"},
    {{"bed", MONO, "--error", ".01", "--directions", "100"}, "leave out --directions"},
    {{"bed", MONO, "--error", ".01", "--method", "mc"}, "--error is for --method beam"},
    {{"bed", MONO, "--directions", "65537"}, "--directions: '65537'"},
    {{"bed", MONO, "--directions", "1e3"}, "--directions: '1e3'"},
    {{"bed", MONO, "--directions", "-8"}, "--directions: '-8'"},
    {{"bed", MONO, "--directions", ""}, "--directions: ''"},
    {{"bed", MONO, "--points", "100"}, "64, 128 and 256 are"},
    {{"bed", MONO, "--areas", "some"}, "'some' is neither exact nor points"},
    {{"bed", MONO, "--areas", "exact", "--points", "64"}, "--points contradicts --areas exact"},
    {{"bed", MONO, "--cutoff", "far"}, "--cutoff: 'far' is not a number"},
    {{"bed", MONO, "--cutoff", "0"}, "--cutoff: 0 is not within"},
    {{"bed", MONO, "--cutoff", "nan"}, "--cutoff: 'nan' is not a number"},
    {{"bed", MONO, "--threads", "0"}, "--threads: '0'"},
    {{"bed", MONO, "--periodic", "1,2"}, "three lengths LX,LY,LZ"},
    {{"bed", MONO, "--periodic", "1,2,-3"}, "three lengths LX,LY,LZ"},
    {{"bed", MONO, "--periodic", "1,2,3,4"}, "more than 3 numbers"},
    {{"bed", MONO, "--periodic", "1,,3"}, "does not begin with a number"},
    {{"bed", MONO, "--targets", ""}, "is not a list like 3,7,10-19"},
    {{"bed", MONO, "--targets", "1,,2"}, "is not a list like"},
    {{"bed", MONO, "--targets", "5-3"}, "is not a list like"},
    {{"bed", MONO, "--targets", "3-"}, "is not a list like"},
    {{"bed", MONO, "--targets", "99999999999999999999"}, "is not a list like"},
    {{"bed", MONO, "--targets", "0"},
     "there is no sphere 0 in frame 0 of tests/data/mono2000.dump; its spheres are 1 to 2000"},
    {{"bed", MONO, "--targets", "1-2000", "--targets=7,5000000000"}, "there is no sphere 5000000000"},
    {{"bed", MONO, "--targets", "1990-2001"}, "there is no sphere 2001 in frame 0 of"},
    {{"bed", MONO, "--targets", "0-9"}, "there is no sphere 0 in frame 0 of"},
    {{"bed", MONO, "--positions", "--targets", "0-2000"}, "its spheres are 0 to 1999"},
    {{"pair", "1", "1"}, "R1, R2 and GAP are needed"},
    {{"pair", "1", "1", "0", "0"}, "three lengths are allowed, not also '0'"},
    {{"pair", "1", "-1", "0"}, "R2: -1 is not within"},
    {{"pair", "1", "1", "x"}, "GAP: 'x' is not a number"},
    {{"pair", "1", "1", "-2"}, "one sphere lies inside the other"},
    {{"pair", "1", "1", "0", "--no-correction"}, "are for --method surface"},
    {{"pair", "1", "1", "0", "--obstacle", "1,2,3"}, "is not X,Y,Z,R"},
    {{"pair", "1", "1", "0", "--obstacle", "1,2,3,0"}, "is not X,Y,Z,R"},
    {{"pair", "1", "1", "0", "--directions", "100"}, "are for --method beam"},
    {{"pair", "1", "1", "0", "--seed", "3"}, "--rays and --seed are for --method cast and mc"},
    {{"pair", "1", "1", "0", "--method", "beam", "--check"}, "--check is for the exact factor"},
    {{"pair", "1", "1", "1", "--method", "beam", "--obstacle", "0,0,0.5,1"}, "sphere 1 and obstacle 1"},
    {{"pair", "1", "1", "1", "--obstacle", "0,0,3,1"}, "sphere 2 and obstacle 1"},
};

START_TEST(bad_usage) {
    ck_assert_int_eq(finish(start(misuse[_i].arguments)), 2);
    expect_message("", misuse[_i].reason);
    ck_assert_str_eq(printed, "");
}
END_TEST

/* ---- pairs ------------------------------------------------------------------------------------------------------ */

static double pair(const char *r1, const char *r2, const char *gap) {
    SUCCEED("pair", r1, r2, gap, "--method=exact");
    return value_of("F12");
}

START_TEST(exact_pair) {
    const double pi = 3.14159265358979323846;
    ck_assert_double_eq_tol(pair("1", "1", "0"), 0.5 - 4 / (3 * pi), 1e-15);
    ck_assert_double_eq_tol(pair("1", "1", "1"), 0.0295903122505504314, 1e-16);
    ck_assert_double_eq_tol(pair("1", "1", "30"), 2.442599800579042e-4, 1e-18);
    ck_assert_double_eq_tol(pair("1", "0.3", ".05"), 0.09 * pair("0.3", "1", ".05"), 1e-16);
    ck_assert_double_gt(pair("1", "1", "-.01"), pair("1", "1", "0"));
}
END_TEST

START_TEST(exact_pair_checked) {
    SUCCEED("pair", "1", "0.3", "0.05", "--check");
    const double f12 = value_of("F12");
    ck_assert_double_eq(value_of("kernel"), f12);
    ck_assert_double_eq_tol(value_of("gsl_polar") / f12, 1, 1e-12);
    ck_assert_double_eq_tol(value_of("gsl_lens") / f12, 1, 1e-12);
    ck_assert_ptr_nonnull(strstr(printed, "difference"));
    char last[60];
    snprintf(last, sizeof last, "\nF12 %.17g\n", f12);
    ck_assert_str_eq(printed + strlen(printed) - strlen(last), last);
    SUCCEED("pair", "1", "0.3", "-0.05", "--check");
    ck_assert_double_eq_tol(value_of("gsl_lens") / value_of("F12"), 1, 1e-12);
}
END_TEST

START_TEST(beam_pair) {
    SUCCEED("pair", "1", "1", "0", "--method", "beam", "--directions", "10000");
    ck_assert_double_eq_tol(value_of("F12"), 0.0755868184216124, 1e-6);
    SUCCEED("pair", "1", "1", "0", "--method", "beam", "--directions", "10000", "--points", "256");
    ck_assert_double_eq_tol(value_of("F12"), 0.0755868184216124, 1e-3);
}
END_TEST

START_TEST(cast_pair) {
    SUCCEED("pair", "1", "1", "0", "--method", "cast", "--rays", "200000");
    ck_assert_double_eq_tol(value_of("F12"), 0.0755868184216124, 5e-4);
    ck_assert_double_eq_tol(value_of("mean_ray_length"), 0.359, 0.005);
    ck_assert_double_eq_tol(value_of("mean_angle") * 57.29578, 30.84, 0.2);
    ck_assert_double_eq(value_of("rays"), 200000);
    SUCCEED("pair", "1", "1", "0", "--method", "mc", "--rays", "200000", "--seed", "3");
    const double one = value_of("F12");
    ck_assert_double_eq_tol(one, 0.0755868184216124, 2.5e-3);
    SUCCEED("pair", "1", "1", "0", "--method", "mc", "--rays", "200000", "--seed", "4");
    ck_assert_double_ne(value_of("F12"), one);
    SUCCEED("pair", "1", "1", "2000", "--method", "cast", "--rays", "10");
    ck_assert_double_eq(value_of("F12"), 0);
}
END_TEST

START_TEST(blocked_pair) {
    SUCCEED("pair", "1", "1", "2", "--obstacle", "0.5,0,2,0.4");
    const double exact = value_of("F12");
    ck_assert_double_lt(exact, 0.9 * pair("1", "1", "2"));
    SUCCEED("pair", "1", "1", "2", "--obstacle", "0.5,0,2,0.4", "--method", "beam", "--directions", "20000");
    ck_assert_double_eq_tol(value_of("F12"), exact, 1e-6);
    SUCCEED("pair", "1", "1", "2", "--obstacle", "0.5,0,2,0.4", "--method", "cast", "--rays", "200000");
    ck_assert_double_eq_tol(value_of("F12"), exact, 4e-4);
    SUCCEED("pair", "1", "1", "2", "--obstacle", "0.5,0,2,0.4", "--method", "surface", "--nf", "610");
    ck_assert_double_eq_tol(value_of("F12") / exact, 1, 1e-3);
    SUCCEED("pair", "1", "1", "0", "--method", "surface", "--no-correction");
    ck_assert_double_eq_tol(value_of("F12") / 0.0755868184216124, 1 - .0475649, 1e-6); /* docs/reproduction.md */
    SUCCEED("pair", "1", "1", "2", "--obstacle", "50,0,2,0.4");
    const double beside = value_of("F12");
    ck_assert_double_eq_tol(beside, pair("1", "1", "2"), 1e-9);
}
END_TEST

/* ---- beds ------------------------------------------------------------------------------------------------------- */

START_TEST(surface_method) {
    SUCCEED("bed", POLY, "--method", "surface", "--cutoff", "3");
    ck_assert_double_eq(value_of("nf"), 55);
    const double sum = value_of("row_sum_max"), error = value_of("error_estimate");
    SUCCEED("bed", POLY, "--cutoff", "3");
    ck_assert_double_eq_tol(value_of("row_sum_max"), sum, 3 * error);
}
END_TEST

START_TEST(tolerance) {
    SUCCEED("bed", POLY, "--error", "0.01");
    ck_assert_double_le(value_of("error_estimate"), .01);
    ck_assert_double_gt(value_of("error_estimate"), .002);
    ck_assert_double_le(value_of("row_sum_max"), 1 + 1e-12);
    const double all = value_of("directions");
    SUCCEED("bed", POLY, "--error", "0.001", "--targets", "3,7,1000-1009");
    ck_assert_double_le(value_of("error_estimate"), .001);
    ck_assert_double_gt(value_of("directions"), all);
    SUCCEED("bed", POLY, "--error", "1e-7", "--targets", "3", "--cutoff", "1.1", "--points", "64");
    ck_assert_double_eq(value_of("directions"), 65536);
    ck_assert_double_gt(value_of("error_estimate"), 1e-7);
    ck_assert(strstr(said, "warning: --error 1e-07 is not reached") != NULL);
    ck_assert_double_gt(value_of("error_reached"), 1e-7);
}
END_TEST

START_TEST(summary) {
    SUCCEED("bed", POLY, "--directions", "34");
    static const char *const keys[] = {"spheres",     "directions",      "threads",        "seconds",
                                       "nonzeros",    "row_sum_min",     "row_sum_max",    "escaped_mean",
                                       "closure_max", "reciprocity_max", "error_estimate", "fallbacks"};
    const char *at = printed;
    for (size_t k = 0; k < sizeof keys / sizeof *keys; ++k) {
        ck_assert_msg((at = strstr(at, keys[k])) != NULL, "%s is missing or out of order", keys[k]);
        value_of(keys[k]);
    }
    ck_assert_double_eq(value_of("spheres"), 2000);
    ck_assert_double_eq(value_of("directions"), 34);
    ck_assert_double_le(value_of("row_sum_max"), 1 + 1e-12);
    ck_assert_double_lt(value_of("closure_max"), 1e-12);
    ck_assert_double_lt(value_of("reciprocity_max"), 1e-14);
    ck_assert_double_gt(value_of("overlap_max"), 0);
    ck_assert_str_eq(said, "");
}
END_TEST

START_TEST(same_bytes_for_any_threads) {
    static const char *const threads[] = {"1", "2", "7"};
    char *first = NULL;
    for (int k = 0; k < 3; ++k) {
        const char *out = in_folder("F.csv");
        SUCCEED("bed", POLY, "--directions", "34", "--threads", threads[k], "-o", out);
        ck_assert_double_eq(value_of("threads"), k == 0 ? 1 : k == 1 ? 2 : 7);
        char *text = read_file(out);
        if (!first)
            first = text;
        else {
            ck_assert_str_eq(text, first);
            free(text);
        }
    }
    free(first);
}
END_TEST

/* In a box rows add up to 1 with the walls, nothing escapes, and the walls' own rows are reciprocal. */
START_TEST(walls) {
    enum { SPHERES = 2000, WALLS = 6 };
    static double sum[SPHERES], to[SPHERES][WALLS], wall_sum[WALLS], between[WALLS][WALLS];
    char *first = NULL;
    for (int k = 0; k < 2; ++k) {
        const char *out = in_folder("F.csv");
        SUCCEED("bed", MONO, "--positions", "--directions", "50", "--wall", "auto", "--threads", k == 0 ? "1" : "3",
                "-o", out, "--json", in_folder("F.json"));
        char *text = read_file(out);
        if (k == 1) ck_assert_str_eq(text, first);
        free(first);
        first = text;
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
    ck_assert_ptr_nonnull(strstr(first, ",zmin:xmax\n"));
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
    free(first);
    SUCCEED("bed", PERIODIC, "--directions", "50", "--wall", "auto"); /* deep beds see all of a wall that has no end */
    ck_assert_double_eq_tol(value_of("wall_zmin_F") * SPHERES * acos(-1), 12 * 12, .02);
    ck_assert_double_eq_tol(value_of("wall_zmax_F") * SPHERES * acos(-1), 12 * 12, .02);
    SUCCEED("bed", MONO, "--directions", "13", "--wall", "cylinder:6,6,9,zmin,zmax=open", "--targets", "1-9");
    ck_assert_double_gt(value_of("wall_cylinder_F"), 0);
    ck_assert_int_eq(RUN("bed", MONO, "--wall", "zmin=2"), 3);
    expect_message(MONO ":", "lies beyond the wall zmin");
}
END_TEST

/* Number `column`, from 0, of the line of a .csv that ends so; NAN: there is none. */
static double number_of_line(const char *path, const char *end, int column) {
    char *text = read_file(path), *at = strstr(text, end);
    double number = NAN;
    if (at) {
        while (at > text && at[-1] != '\n') --at;
        for (; column > 0; --column) at = strchr(at, ',') + 1;
        number = strtod(at, NULL);
    }
    free(text);
    return number;
}

/* A box without a lid against one whose lid is black and as hot as the surroundings. */
START_TEST(a_box_without_a_lid) {
    const char *open = in_folder("open.csv"), *closed = in_folder("closed.csv"), *json = in_folder("open.json");
    char lid[100];
#define STATE "--length-unit=mm", "--emissivity=.6", "--temperature=500", "--ambient=300", "--directions=30"
    SUCCEED("heat", MONO, STATE, "--wall=box:open=zmax", "--wall-temperature=zmin=900,600", "--wall-emissivity=.4",
            "-o", open, "--json", json, "--plot", in_folder("open.svg"));
    snprintf(lid, sizeof lid, "--wall=box,zmax=%.17g", json_of(json, "open_zmax_at"));
    SUCCEED("heat", MONO, STATE, lid, "--wall-temperature=zmin=900,zmax=300,600", "--wall-emissivity=zmax=1,.4", "-o",
            closed);
#undef STATE
    const char *const lines[] = {",xmin", ",ymax", ",zmin", "\n4,", "\n1000,"};
    for (size_t k = 0; k < sizeof lines / sizeof *lines; ++k)
        ck_assert_double_eq(number_of_line(open, lines[k], 2), number_of_line(closed, lines[k], 2));
    ck_assert_double_gt(number_of_line(open, ",surroundings", 2), 1e-3);
    ck_assert_double_eq(number_of_line(open, ",surroundings", 2), number_of_line(closed, ",zmax", 2));
    ck_assert(isnan(number_of_line(open, ",zmax", 2)));
    ck_assert_int_eq(RUN("bed", MONO, "--wall", "box,zmax=13:open"), 3);
    expect_message(MONO ":", "reaches beyond an opening");
    SUCCEED("bed", PERIODIC, "--directions=13", "--wall", "zmin,zmax=open");
    ck_assert_double_gt(value_of("escaped_mean"), 0);
}
END_TEST

/* The rows of a target list are those of --raw, and the matrix market file holds the same as the CSV file. */
/* The same rays whoever follows them; other seeds, other rays. */
START_TEST(rays) {
    static const char *const methods[] = {"cast", "mc"};
    for (int m = 0; m < 2; ++m) {
        char *text[3];
        for (int k = 0; k < 3; ++k) {
            const char *out = in_folder("F.csv");
            SUCCEED("bed", POLY, "--method", methods[m], "--rays", "500", "--threads", k == 1 ? "3" : "1", "--seed",
                    k == 2 ? "1" : "0", "-o", out);
            ck_assert_double_eq(value_of("rays"), 500);
            ck_assert_double_le(value_of("row_sum_max"), 1 + 1e-12);
            ck_assert_double_lt(value_of("closure_max"), 1e-12);
            ck_assert_double_lt(value_of("reciprocity_max"), 1e-14);
            text[k] = read_file(out);
        }
        ck_assert_str_eq(text[0], text[1]);
        ck_assert_str_ne(text[0], text[2]);
        for (int k = 0; k < 3; ++k) free(text[k]);
    }
}
END_TEST

/* A file of the test's folder, whatever its bytes. */
static char *read_bytes(const char *name, size_t *size) {
    struct stat there;
    ck_assert_int_eq(stat(in_folder(name), &there), 0);
    *size = (size_t)there.st_size;
    return read_file(in_folder(name));
}

/* What is kept in files is written as what is kept in memory, and nothing else is left. */
START_TEST(rows_in_files) {
    static const char *const names[2][3] = {{"a.csv", "a.npz", "a.json"}, {"b.csv", "b.npz", "b.json"}};
    const char *scratch = in_folder("scratch");
    ck_assert_int_eq(mkdir(scratch, 0777), 0);
    SUCCEED("exchange", PERIODIC, "--emissivity=.5", "--directions=8", "--rays=9", "--wall=zmin",
            "--wall-emissivity=.5", "-o", in_folder(names[0][0]), "-o", in_folder(names[0][1]), "-o",
            in_folder(names[0][2]));
    SUCCEED("exchange", PERIODIC, "--emissivity=.5", "--directions=8", "--rays=9", "--wall=zmin",
            "--wall-emissivity=.5", "-o", in_folder(names[1][0]), "-o", in_folder(names[1][1]), "-o",
            in_folder(names[1][2]), "--scratch", scratch);
    ck_assert_double_lt(value_of("reciprocity_max"), 1e-14);
    for (int k = 0; k < 3; ++k) {
        size_t first, second;
        char *kept = read_bytes(names[0][k], &first), *filed = read_bytes(names[1][k], &second);
        ck_assert_uint_eq(first, second);
        ck_assert_int_eq(memcmp(kept, filed, first), 0);
        free(kept);
        free(filed);
    }
    ck_assert_int_eq(rmdir(scratch), 0); /* empty */
    remove_files(0);
    ck_assert_int_eq(RUN("bed", MONO, "--scratch", scratch), 4);
    expect_message(scratch, "No such file or directory");
    ck_assert_int_eq(RUN("exchange", MONO, "--emissivity=.5", "--scratch", PERIODIC, "-o", in_folder("D.csv")), 4);
    ck_assert_int_eq(remove_files(0), 0);
}
END_TEST

START_TEST(targets_and_formats) {
    const char *all = in_folder("all.csv"), *some = in_folder("some.csv"), *matrix = in_folder("all.mtx");
    SUCCEED("bed", PERIODIC, "--positions", "--directions", "21", "--raw", "-o", all);
    ck_assert_double_lt(value_of("closure_max"), 1e-12);
    SUCCEED("bed", PERIODIC, "--positions", "--directions", "21", "--raw", "-o", matrix);
    SUCCEED("bed", PERIODIC, "--positions", "--directions", "21", "--targets", "1999,0,7-9,8", "-o", some);
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
    free(all_text);
    free(some_text);
    free(matrix_text);
}
END_TEST

#define FRAME(number, marks, rows)                                                                                     \
    "ITEM: TIMESTEP\n" number "\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS " marks                                    \
    "\n0 8\n0 8\n0 8\nITEM: ATOMS radius x y z id\n" rows

/* Two spheres seen through periodic faces, in the open, from a CSV file and from standard input. */
START_TEST(frames_periods_and_ids) {
    const char *dump = write_file("two.dump", FRAME("0", "ff ff ff", "1 1 4 4 70\n1 7 4 4 5\n")
                                                  FRAME("1", "pp ff ff", "1 1 4 4 70\n1 7 4 4 5\n"));
    SUCCEED("bed", dump, "--frame", "0");
    ck_assert_double_eq_tol(value_of("row_sum_min"), 0.00704, 1e-3);
    ck_assert_double_eq(value_of("nonzeros"), 2);
    SUCCEED("bed", dump);
    const double across = value_of("row_sum_min");
    ck_assert_double_eq_tol(across, 0.0755868 + 0.0070444, 1e-3); /* across the face, and within the box */
    SUCCEED("bed", dump, "--frame", "0", "--periodic", "8,0,0");
    ck_assert_double_eq(value_of("row_sum_min"), across);
    SUCCEED("bed", dump, "--periodic", "none", "--targets", "70", "-o", in_folder("ids.csv"));
    ck_assert_double_lt(value_of("row_sum_min"), 0.01);
    char *text = read_file(in_folder("ids.csv"));
    ck_assert_int_eq(strncmp(text, "i,j,F,body\n70,5,", 16), 0);
    free(text);
    input = dump;
    SUCCEED("bed", "-");
    ck_assert_double_eq(value_of("row_sum_min"), across);
    input = "/dev/null";
}
END_TEST

/* The lines i,T_K,q_W of a file: how many, their sum and the largest q, and one of them. */
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
    free(text);
    return count;
}

/* Temperatures of spheres and walls whose powers are given; why there are none. */
START_TEST(temperatures) {
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

    /* millimetres: areas, and powers with them, are 1e6 times smaller */
    double warm[2];
    for (int k = 0; k < 2; ++k) {
        SUCCEED("heat", file, "--emissivity", ".5", "--power", k ? "4e-3" : "4e3", "--length-unit", k ? "mm" : "m",
                "--wall", "box", "--wall-temperature", "zmax=400,insulated", "--wall-power",
                k ? "xmin=1e-2" : "xmin=1e4", "--wall-emissivity", ".6", "-o", out);
        read_powers(out, &sum, &largest, 1, &warm[k], &q);
        ck_assert_double_le(fabs(sum), 1e-12 * largest);
        ck_assert_double_eq_tol(q, k ? -4e-3 : -4e3, 1e-14 * fabs(q));
        ck_assert_double_eq_tol(value_of("wall_xmin_W"), k ? -1e-2 : -1e4, 1e-6 * fabs(q));
        ck_assert_double_gt(value_of("wall_xmin_K"), 400);
        ck_assert_double_gt(value_of("wall_zmin_K"), 400);
    }
    ck_assert_double_eq_tol(warm[0], warm[1], 1e-9 * warm[0]);

    /* emissivities by table: at 600 K .5, whatever the type */
    const char *table = write_file("eps.csv", "# K\nT_K,emissivity\n500,.6\n\n700;.4\n");
    char by_type[300], all[300];
    snprintf(all, sizeof all, "@%s", table);
    snprintf(by_type, sizeof by_type, "1:@%s,2:.5", table);
    double power[3];
    for (int k = 0; k < 3; ++k) {
        SUCCEED("heat", file, "--length-unit", "m", "--emissivity",
                k == 0   ? ".5"
                : k == 1 ? all
                         : by_type,
                "--temperature", "600", "--ambient", "300", "-o", out);
        read_powers(out, &sum, &largest, 0, &t, &power[k]);
    }
    ck_assert(power[0] == power[1] && power[0] == power[2]);
    ck_assert_int_eq(RUN("heat", file, "--emissivity", all, "--ambient", "300"), 2);
    write_file("eps.csv", "500,.6\n700,1.4\n");
    ck_assert_int_eq(RUN("heat", file, "--emissivity", all, "--temperature", "600", "--ambient", "300"), 3);
    expect_message(table, "the emissivity is 1.4; it must be within 0 and 1");
    write_file("eps.csv", "500,.6\n400,.4\n");
    ck_assert_int_eq(RUN("heat", file, "--emissivity", all, "--temperature", "600", "--ambient", "300"), 3);
    expect_message(table, ":2: 400 is not above the number before");

    ck_assert_int_eq(RUN("heat", file, "--length-unit", "m", "--emissivity", ".5", "--power", "4", "--wall", "box",
                         "--wall-temperature", "insulated"),
                     3);
    expect_message(file, "its powers add up to 12 W, not to 0");
    ck_assert_int_eq(
        RUN("heat", file, "--length-unit", "m", "--emissivity", ".5", "--power", "-1e6", "--ambient", "300"), 3);
    expect_message(file, "sphere 0: no temperature above 0 K gives off -1e+06 W here");
    ck_assert_int_eq(
        RUN("heat", file, "--length-unit", "m", "--emissivity", ".5", "--power", "1:4", "--ambient", "300"), 3);
    expect_message(file, "sphere 1 has neither a temperature nor a power");
    ck_assert_int_eq(RUN("heat", file, "--length-unit", "m", "--emissivity", ".5", "--power", "1:4", "--temperature",
                         "1:4,2:5", "--ambient", "300"),
                     3);
    expect_message(file, "sphere 0 has both a temperature and a power");
    ck_assert_int_eq(RUN("heat", file, "--length-unit", "m", "--emissivity", "eps", "--power", "4", "--ambient", "300"),
                     3);
    expect_message(file, "sphere 2 has emissivity 0 and cannot give off 4 W");
}
END_TEST

/* Root mean square difference of T^4 of the spheres of two .csv, over that of the first. */
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
    free(text[0]), free(text[1]);
    return sqrt(difference / all);
}

/* --error holds for temperatures that are found, too, of spheres and walls. */
START_TEST(temperatures_to_an_error) {
    enum { SIDE = 3 };
    char bed[2000] = "x,y,z,r\n";
    for (int i = 0; i < SIDE * SIDE * SIDE; ++i)
        snprintf(bed + strlen(bed), 60, "%d,%d,%d,%g\n", 2 * (i % 3), 2 * (i / 3 % 3), 2 * (i / 9), .95 - .2 * (i % 4));
    const char *file = write_file("found.csv", bed), *out = in_folder("found.out.csv"), *fine = in_folder("fine.csv");
    double sum, largest, wall[2], q;
    for (int k = 0; k < 4; ++k) { /* finely, then to an error; open, then in a box */
        const char *to = k % 2 ? out : fine;
        SUCCEED("heat", file, "--length-unit", "m", "--emissivity", ".4", "--power", "4000", "--ambient=300",
                k % 2 ? "--error=.002" : "--directions=1500", k % 2 ? "--threads=2" : "--patches=384", "-o", to,
                k < 2 ? "--threads=2" : "--wall=box",
                k < 2 ? "--threads=2" : "--wall-temperature=ymax=insulated,zmin=900,400",
                k < 2 ? "--threads=2" : "--wall-power=xmin=20000", k < 2 ? "--threads=2" : "--wall-emissivity=.4");
        ck_assert_ptr_null(strstr(said, "is not reached"));
        if (k >= 2) read_powers(to, &sum, &largest, -2, &wall[k % 2], &q);
        if (k % 2 == 0) continue;
        ck_assert_double_gt(value_of("directions"), 72);
        ck_assert_double_le(emission_difference(fine, out), .002);
    }
    ck_assert_double_le(4 * fabs(wall[1] / wall[0] - 1), .002);
}
END_TEST

START_TEST(powers) {
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

    /* walls are -2, -3 in the order given; the bytes are the same for any threads */
    char *text[2];
    for (int k = 0; k < 2; ++k) {
        SUCCEED("heat", file, "--emissivity", "eps", "--temperature", "T", "--wall", "zmax=3,zmin=-1,cylinder:0,0,5",
                "--wall-temperature", "zmin=400,zmax=700,500", "--wall-emissivity", "zmax=.5", "--threads",
                k == 0 ? "1" : "3", "-o", out, "--json", in_folder("q.json"));
        text[k] = read_file(out);
    }
    ck_assert_str_eq(text[0], text[1]);
    ck_assert_ptr_null(strstr(text[0], "surroundings")); /* closed: nothing gets there */
    ck_assert_ptr_nonnull(strstr(text[0], ",cylinder\n"));
    ck_assert_int_eq(read_powers(out, &sum, &largest, -2, &t, &q), 6);
    ck_assert_double_eq(t, 700);
    ck_assert_double_eq(q, json_of(in_folder("q.json"), "wall_zmax_W"));
    ck_assert_double_le(fabs(sum), 1e-12 * largest);
    read_powers(out, &sum, &largest, -4, &t, &q);
    ck_assert_double_eq(t, 500);
    free(text[0]), free(text[1]);

    /* all at one temperature: figures are relative to what is emitted */
    SUCCEED("heat", file, "--emissivity", ".3", "--temperature", "500", "--wall", "box", "--wall-temperature", "500",
            "--wall-emissivity", ".2", "-o", out);
    read_powers(out, &sum, &largest, 0, &t, &q);
    ck_assert_double_le(largest, 1e-10 * 5.67e-8 * 500. * 500. * 500. * 500.);
    ck_assert_double_le(fabs(value_of("balance_of_emission")), 1e-12);
    ck_assert_double_le(value_of("error_of_emission"), 1e-9);
    ck_assert_double_eq_tol(value_of("emitted_W"), .3 * 5.670374419e-8 * pow(500, 4) * 4 * acos(-1) * 2.49, 1);
    SUCCEED("heat", file, "--emissivity", ".3", "--temperature", "500", "--wall", "box", "--wall-temperature", "500",
            "--error", ".01", "--length-unit", "m"); /* which powers of nothing but noise do reach */
    ck_assert_str_eq(said, "");

    SUCCEED("heat", file, "--emissivity", ".3", "--temperature", "T", "--ambient", "0", "--error", "0.01", "-o",
            in_folder("q.vtp"));
    ck_assert_double_le(value_of("error_rms_W") / value_of("power_rms_W"), .01);
    char *vtp = read_file(in_folder("q.vtp"));
    ck_assert(strstr(vtp, "Name=\"power_W\"") && strstr(vtp, "Name=\"temperature_K\"") && strstr(vtp, "</VTKFile>"));
    free(vtp);
    SUCCEED("heat", file, "--emissivity", ".3", "--temperature", "T", "--ambient", "0", "--model", "spheres");
    ck_assert_double_eq(value_of("directions"), 112); /* fewer where patches err more */
    SUCCEED("heat", file, "--emissivity", ".5", "--temperature", "T", "--ambient", "0");
    ck_assert_double_eq(value_of("directions"), 168);
    ck_assert_int_eq(RUN("heat", file, "--emissivity", "eps", "--temperature", "missing", "--ambient", "0"), 3);
    const char *cold = write_file("cold.csv", "x,y,z,r,T\n0,0,0,1,-1\n");
    ck_assert_int_eq(RUN("heat", cold, "--emissivity", "1", "--temperature", "T", "--ambient", "0"), 3);
    expect_message(cold, "the temperature in kelvins is -1; it must be within 0 and 1e+09");
}
END_TEST

/* Rows of the .csv close with surroundings (-1) and walls (-2, -3, ...) and are reciprocal with areas times
 * emissivity; the bytes do not depend on the number of threads. */
START_TEST(exchange_factors) {
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
    SUCCEED("exchange", file, "--emissivity", "e", "--rays", "300", "--wall", "zmin=-1.5,zmax=4", "--wall-emissivity",
            "zmin=0.5,zmax=0", "--threads", "1", "-o", out);
    ck_assert_double_lt(value_of("closure_max"), 1e-12);
    ck_assert_double_lt(value_of("reciprocity_max"), 1e-12);
    ck_assert_double_lt(value_of("error_estimate"), .1);
    SUCCEED("exchange", file, "--emissivity", "e", "--rays", "300", "--wall", "zmin=-1.5,zmax=4", "--wall-emissivity",
            "zmin=0.5,zmax=0", "--threads", "3", "-o", other);
    char *text = read_file(out), *again = read_file(other);
    ck_assert_str_eq(text, again);
    ck_assert_int_eq(strncmp(text, "i,j,D,body\n", 11), 0);
    for (char *line = strchr(text, '\n') + 1; *line; line = strchr(line, '\n') + 1) {
        int i, j;
        double factor;
        ck_assert_int_eq(sscanf(line, "%d,%d,%lg", &i, &j, &factor), 3);
        ck_assert(j != -3 && i >= -3 && j >= -2); /* the upper wall takes nothing, but -3 reflects */
        if (i < 0) continue;
        sum[i] += factor;
        if (j >= 0) d[i][j] = factor;
    }
    for (int i = 0; i < N; ++i) {
        ck_assert_double_eq_tol(sum[i], 1, 1e-12);
        for (int j = 0; j < N; ++j) ck_assert_double_eq_tol(weight[i] * d[i][j], weight[j] * d[j][i], 1e-14);
    }
    free(text);
    free(again);
    SUCCEED("exchange", file, "--emissivity", "0.6", "--error", "0.02", "--drop", "0.001", "--threads", "2");
    ck_assert_double_lt(value_of("error_estimate"), .04);
    ck_assert_double_lt(value_of("closure_max"), 1e-12);
    ck_assert_int_eq(RUN("exchange", file, "--emissivity", "x"), 3);
    expect_message(file, "the emissivity is 2; it must be within 0 and 1");
    ck_assert_int_eq(RUN("exchange", file, "--emissivity", "missing"), 3);
    ck_assert_int_eq(RUN("exchange", file, "--emissivity", "e", "--wall-emissivity", "0.5"), 2);
    remove_files(0);
}
END_TEST

/* One sphere a cell: the simple cubic lattice, black; any number of threads. */
START_TEST(conductivity) {
    const char *cell = write_file("cell.csv", "x,y,z,r,eps\n0,0,0,1,1\n");
    SUCCEED("conductivity", cell, "--periodic", "2,2,2", "--emissivity", "eps", "--rays", "40000", "--threads", "1");
    const double first = value_of("F_E_z");
    ck_assert_double_eq_tol(first, 1.2005, .03);
    ck_assert_double_eq_tol(value_of("F_E_x"), 1.2005, .03);
    ck_assert_double_lt(value_of("F_E_y_error"), .03);
    ck_assert_double_gt(value_of("F_E_y_error"), .001);
    SUCCEED("conductivity", cell, "--periodic", "2,2,2", "--emissivity", "1", "--rays", "40000", "--threads", "4");
    ck_assert_double_eq(value_of("F_E_z"), first);
    SUCCEED("conductivity", PERIODIC, "--emissivity", "0.8", "--error", "0.02");
    ck_assert_double_eq_tol(value_of("F_E_x"), .80, .04);
    ck_assert_double_lt(value_of("F_E_x_error") / value_of("F_E_x"), .025);
    ck_assert_double_lt(value_of("emitters"), 1000);
    ck_assert_int_eq(RUN("conductivity", cell, "--periodic", "2,2,0", "--emissivity", "1"), 3);
    expect_message(cell, "too thin along the open axis z");
    remove_files(0);
}
END_TEST

START_TEST(points_and_cutoff) {
    SUCCEED("bed", POLY, "--directions", "34", "--points", "64");
    ck_assert_double_le(value_of("row_sum_max"), 1 + 1e-12);
    ck_assert_double_lt(value_of("reciprocity_max"), 1e-14);
    const double entries = value_of("nonzeros");
    SUCCEED("bed", POLY, "--directions", "34", "--areas", "points", "--cutoff", "1.5");
    ck_assert_double_le(value_of("row_sum_max"), 1 + 1e-12);
    ck_assert_double_lt(value_of("nonzeros"), entries / 2);
    ck_assert_double_gt(value_of("beyond_mean"), .1); /* other spheres, for the most part */
    ck_assert_double_lt(value_of("closure_max"), 1e-12);
}
END_TEST

START_TEST(paraview_and_picture) {
    const char *points = in_folder("bed.vtp"), *svg = in_folder("bed.svg"), *png = in_folder("bed.png");
    SUCCEED("bed", MONO, "--directions", "21", "-o", points, "--plot", svg);
    char *text = read_file(points);
    ck_assert_ptr_nonnull(strstr(text, "NumberOfPoints=\"2000\""));
    ck_assert_ptr_nonnull(strstr(text, "</VTKFile>"));
    free(text);
    text = read_file(svg);
    ck_assert_ptr_nonnull(strstr(text, "<svg"));
    ck_assert_ptr_nonnull(strstr(text, "</svg>"));
    free(text);
    SUCCEED("bed", MONO, "--directions", "21", "--targets", "1-99", "--plot", png);
    text = read_file(png);
    ck_assert_int_eq(strncmp(text, "\x89PNG", 4), 0);
    free(text);
    ck_assert_int_eq(remove_files(0), 3);
}
END_TEST

START_TEST(picture_without_gnuplot) {
    char *path = strdup(getenv("PATH"));
    ck_assert_int_eq(setenv("PATH", folder, 1), 0);
    ck_assert_int_eq(
        RUN("bed", write_file("a.csv", "x,y,z,r\n0,0,0,1\n"), "--plot", in_folder("a.png"), "-o", in_folder("F.csv")),
        4);
    ck_assert_int_eq(setenv("PATH", path, 1), 0);
    free(path);
    expect_message("", "gnuplot");
    ck_assert_int_eq(remove_files(0), 1); /* a.csv alone */
}
END_TEST

START_TEST(progress_when_asked) {
    SUCCEED("bed", MONO, "--directions", "21", "--progress");
    ck_assert_ptr_nonnull(strstr(said, "2000 of 2000 rows"));
    SUCCEED("bed", MONO, "--directions", "21");
    ck_assert_ptr_null(strstr(said, "2000 of 2000 rows"));
}
END_TEST

/* ---- trouble ---------------------------------------------------------------------------------------------------- */

static const struct {
    const char *text, *place, *reason;
} bad_beds[] = {
    {"", ": ", "no spheres"},
    {"x,y,z,r\n0,0,0,1\n3,nan,0,1\n", ":3: ", "y is not finite"},
    {"x,y,z,r\n0,0,foo,1\n", ":2: ", "z is not a number: 'foo'"},
    {"x,y,r\n0,0,1\n", ":1: ", "no column z"},
    {"x,y,z,r\n0,0,0,-1\n", ":2: ", "the radius is -1"},
    {"x,y,z,r\n0,0,0,1\n5,0,0,1\n\n0,0,0,1\n", ":5: ", "sphere 2 has the same centre as sphere 0 of line 2"},
    {"x,y,z,r\n0,0,0,1\n5,0,0,1\n4.5,0,0,2\n", ":4: ", "the centre of one lies inside the other"},
    {"ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n9\nITEM: ATOMS x y z radius\n0 0 0 1\n", ":6: ", "9 were declared"},
    {"# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\nPOINTS 2 float\n1 2 3 1 2 3\nPOINT_DATA 2\nSCALARS r "
     "float\n"
     "LOOKUP_TABLE default\n1 1\n",
     ": sphere", "sphere 0 has the same centre as sphere 1\n"}, /* on no line */
    {FRAME("0", "xy xz yz ff ff ff", "1 1 4 4 70\n1 7 4 4 5\n"), ":6: ", "bounds"},
    {FRAME("0", "ff pp ff", "1 4 0 4 70\n1 4 8 4 5\n"), ":11: ", "line 10"}, /* the same place in the box */
};

START_TEST(bad_input) {
    char place[300];
    const char *bed = write_file("bad.bed", bad_beds[_i].text);
    ck_assert_int_eq(RUN("bed", bed, "-o", in_folder("out.csv"), "--plot", in_folder("out.svg")), 3);
    snprintf(place, sizeof place, "%s%s", bed, bad_beds[_i].place);
    expect_message(place, bad_beds[_i].reason);
    ck_assert_str_eq(printed, "");
    ck_assert_int_eq(remove_files(0), 1); /* bad.bed alone */
}
END_TEST

/* ---- rows of ranks ---------------------------------------------------------------------------------------------- */

union word {
    uint64_t whole;
    double real;
};
#define W(n)                                                                                                           \
    { .whole = (n) }
#define R(x)                                                                                                           \
    { .real = (x) }
#define FAR 1099511627781u /* an id of more than 32 bits */

/* The rows of three grey spheres with a wall, 10 and FAR of rank 0, 30 of rank 1. */
enum { RANKS = 2, WORDS = 42 };
static const union word rank_rows[RANKS][WORDS] = {{W(0x3153574f52424946),
                                                    W(0),
                                                    W(2),
                                                    W(700),
                                                    W(2),
                                                    W(3),
                                                    W(1),
                                                    W(1),
                                                    R(10), /* head; "FIBROWS1" */
                                                    W(10),
                                                    W(FAR),
                                                    W(0),
                                                    W(2),
                                                    W(3),
                                                    W(30),
                                                    W(FAR),
                                                    W(10), /* id, start, col */
                                                    R(.25),
                                                    R(.125),
                                                    R(.0625),
                                                    R(.5),
                                                    R(.75),
                                                    R(.125),
                                                    R(.125), /* f, body, escaped */
                                                    R(0),
                                                    R(.0625),
                                                    R(.01),
                                                    R(.02),
                                                    R(1),
                                                    R(.5),
                                                    R(.5),
                                                    R(.5), /* beyond, error, radius, emissivity */
                                                    R(0),
                                                    R(0),
                                                    R(0),
                                                    R(3),
                                                    R(0),
                                                    R(0)},
                                                   {W(0x3153574f52424946),
                                                    W(1),
                                                    W(2),
                                                    W(700),
                                                    W(1),
                                                    W(1),
                                                    W(1),
                                                    W(1),
                                                    R(10),
                                                    W(30),
                                                    W(0),
                                                    W(1),
                                                    W(10),
                                                    R(.375),
                                                    R(.5),
                                                    R(.125),
                                                    R(0),
                                                    R(.01),
                                                    R(1),
                                                    R(.75),
                                                    R(0),
                                                    R(2.5),
                                                    R(0)}};
static const size_t rank_words[RANKS] = {38, 23};
static const char *const rank_names[RANKS] = {"a.0.rows", "a.1.rows"};

static const char *write_words(const char *name, const union word *words, size_t bytes) {
    const char *path = in_folder(name);
    FILE *file = fopen(path, "wb");
    ck_assert_ptr_nonnull(file);
    ck_assert_uint_eq(fwrite(words, 1, bytes, file), bytes);
    ck_assert_int_eq(fclose(file), 0);
    return path;
}

/* As many walls as a scene may have. */
START_TEST(joined_with_many_walls) {
    enum { WALLS = 32 };
    union word words[9 + 1 + 2 + WALLS + 8];
    const union word head[] = {
        W(0x3153574f52424946), W(0), W(1), W(700), W(1), W(0), W(WALLS), W(0), R(0), W(3), W(0), W(0)};
    memset(words, 0, sizeof words);
    memcpy(words, head, sizeof head);
    for (int k = 0; k < WALLS; k++) words[12 + k].real = 1. / WALLS;
    words[12 + WALLS + 3].real = words[12 + WALLS + 4].real = 1; /* radius, emissivity */
    const char *path = write_words("many.0.rows", words, sizeof words);
    SUCCEED("join", path, "--raw", "-o", in_folder("D.csv"));
}
END_TEST

START_TEST(joined) {
    const char *zero = write_words(rank_names[0], rank_rows[0], 8 * rank_words[0]);
    const char *one = write_words(rank_names[1], rank_rows[1], 8 * rank_words[1]);
    const char *csv = in_folder("D.csv"), *mtx = in_folder("D.mtx");
    const char *json = in_folder("D.json");
    SUCCEED("join", one, zero, "--raw", "--positions", "-o", csv, "--json", json);
    ck_assert_double_eq(value_of("spheres"), 3);
    ck_assert_double_eq(value_of("nonzeros"), 4);
    ck_assert_double_eq_tol(json_of(json, "beyond_mean"), .0625 / 3, 1e-16);
    ck_assert_double_eq_tol(json_of(json, "wall_1_F"), 1.75 / 3, 1e-15);
    ck_assert_double_eq(value_of("closure_max"), 0);
    ck_assert_double_eq_tol(json_of(json, "reciprocity_max"), (.75 * .375 - .5 * .25) / .75, 1e-15);
    char *text = read_file(csv);
    ck_assert_str_eq(text, "i,j,D,body\n0,1,0.25,\n0,2,0.125,\n0,-1,0.125,surroundings\n0,-2,0.5,wall_1\n1,0,0.375,\n"
                           "1,-1,0.125,surroundings\n1,-2,0.5,wall_1\n2,0,0.0625,\n2,-1,0.125,surroundings\n"
                           "2,-2,0.75,wall_1\n2,-3,0.0625,beyond\n");
    free(text);
    SUCCEED("join", zero, one, "--raw", "-o", csv);
    text = read_file(csv);
    ck_assert_ptr_nonnull(strstr(text, "\n10,1099511627781,0.125,\n10,-1,0.125,surroundings\n"));
    free(text);
    SUCCEED("join", zero, one, "-o", mtx);
    ck_assert_double_lt(value_of("closure_max"), 1e-14);
    ck_assert_double_lt(value_of("reciprocity_max"), 1e-14);
    text = read_file(mtx);
    ck_assert_ptr_nonnull(strstr(text, "\n% ids: 10 30 1099511627781\n3 3 4\n1 2 "));
    free(text);
    SUCCEED("join", zero, one, "--raw", "-o", in_folder("D.vtp"), "-o", "-", "--format", "csv");
    text = read_file(csv);
    ck_assert_str_eq(printed, text);
    ck_assert_ptr_nonnull(strstr(said, "spheres 3\n"));
    free(text);
    text = read_file(in_folder("D.vtp"));
    ck_assert(strstr(text, "Name=\"wall_1\"") && strstr(text, "Name=\"id\""));
    free(text);
    SUCCEED("join", zero, one, "--quiet");
    ck_assert_str_eq(printed, "");
    ck_assert_int_eq(RUN("join", one, "-o", one), 2);
    expect_message(one, "unknown ending");
    ck_assert_int_eq(RUN("join", zero, csv, "-o", csv), 2);
    expect_message(csv, "is read in this run");
    const char *both = in_folder("both.json");
    ck_assert_int_eq(RUN("join", zero, one, "-o", both, "--json", both), 2); /* the one would replace the other */
    expect_message(both, "is given twice");
    ck_assert_int_eq(RUN("join", zero, one, "--json", one), 2);
    expect_message(one, "is read in this run");
    SUCCEED("join", zero, one, "--json", "-");
    ck_assert_int_eq(strncmp(printed, "{\"fibrad\"", 9), 0);
    ck_assert_ptr_nonnull(strstr(said, "\nspheres 3\n"));
    remove_files(0);
}
END_TEST

/* One word of one rank's file changed. */
static const struct {
    int rank, word;
    union word value;
    const char *reason;
} damaged_rows[] = {
    {0, 0, W(7), "is no file of rows"},
    {1, 1, W(0), "has the rows of rank 0, as"},
    {1, 2, W(3), "has another number of ranks than"},
    {1, 3, W(701), "has another step than"},
    {1, 4, W(2), "ends too early, after 184 of 272 bytes"},
    {0, 4, W(1), "has 88 bytes too many"},
    {0, 4, W(UINT64_MAX / 2), "ends too early"},
    {0, 5, W(UINT64_MAX / 2), "ends too early"},
    {0, 6, W(UINT64_MAX / 2), "its head is damaged"},
    {1, 7, W(0), "has another kind of factors than"},
    {1, 8, R(9), "has another cutoff than"},
    {1, 8, R(NAN), "its head is damaged"},
    {1, 9, W(10), "id 10 is there twice, also in"},
    {0, 12, W(1), "id 1099511627781: a factor of its row is not within"}, /* FAR, then 10 */
    {0, 12, W(4), "the starts of its rows are damaged"},
    {0, 11, W(1), "the starts of its rows are damaged"},
    {0, 15, W(99), "id 10 has an entry for id 99, which has no row"},
    {0, 17, R(NAN), "id 10: a factor"},
    {0, 20, R(-1), "id 10: a factor"},
    {1, 15, R(INFINITY), "id 30: a factor"},
    {0, 26, R(INFINITY), "id 10: its error is not finite"},
    {0, 28, R(0), "id 10: its radius"},
    {0, 31, R(1.5), "id 1099511627781: its emissivity"},
    {0, 35, R(NAN), "id 1099511627781: its centre"},
};

START_TEST(bad_rows) {
    const char *files[RANKS];
    for (int k = 0; k < RANKS; ++k) {
        union word words[WORDS];
        memcpy(words, rank_rows[k], sizeof words);
        if (k == damaged_rows[_i].rank) words[damaged_rows[_i].word] = damaged_rows[_i].value;
        files[k] = write_words(rank_names[k], words, 8 * rank_words[k]);
    }
    ck_assert_int_eq(RUN("join", files[0], files[1], "-o", in_folder("D.csv")), 3);
    expect_message(files[damaged_rows[_i].rank], damaged_rows[_i].reason);
    ck_assert_str_eq(printed, "");
    ck_assert_int_eq(remove_files(0), RANKS); /* no D.csv */
}
END_TEST

START_TEST(missing_rows) {
    const char *zero = write_words(rank_names[0], rank_rows[0], 8 * rank_words[0]);
    const char *one = write_words(rank_names[1], rank_rows[1], 8 * rank_words[1]);
    ck_assert_int_eq(RUN("join", zero), 3);
    expect_message(zero, "is one of 2 files; the file of rank 1 is missing");
    ck_assert_int_eq(RUN("join", one), 3);
    expect_message(one, "the file of rank 0 is missing");
    ck_assert_int_eq(RUN("join", zero, one, zero), 3);
    expect_message(zero, "has the rows of rank 0, as");
    ck_assert_int_eq(RUN("join", zero, "no/such.rows"), 4);
    expect_message("no/such.rows: ", "No such file");
    union word near[WORDS];
    memcpy(near, rank_rows[1], sizeof near);
    near[21].real = .5; /* 30 inside 10 */
    ck_assert_int_eq(RUN("join", zero, write_words(rank_names[1], near, 8 * rank_words[1])), 3);
    expect_message("", "ids 10 and 30: ");
    remove_files(0);
}
END_TEST

START_TEST(file_trouble) {
    const char *bed = write_file("a.csv", "x,y,z,r\n0,0,0,1\n3,0,0,1\n");
    ck_assert_int_eq(RUN("bed", "no/such.dump"), 4);
    expect_message("no/such.dump: ", "No such file");
    ck_assert_int_eq(RUN("bed", folder), 4);
    expect_message(folder, "directory");
    ck_assert_int_eq(RUN("bed", bed, "-o", "no/such/F.csv"), 4);
    expect_message("no/such/F.csv: ", "No such file");
    output = "/dev/full";
    ck_assert_int_eq(RUN("bed", bed), 4);
    output = NULL;
    expect_message("standard output", "No space left");
    ck_assert_int_eq(remove_files(0), 1);
}
END_TEST

/* A disc that fills up, as far as a limit on the size of files can play it. */
START_TEST(full_disc) {
    struct rlimit before;
    ck_assert_int_eq(getrlimit(RLIMIT_FSIZE, &before), 0);
    const struct rlimit limit = {100000, before.rlim_max};
    ck_assert_int_eq(setrlimit(RLIMIT_FSIZE, &limit), 0);
    ck_assert_int_eq(RUN("bed", MONO, "--directions", "21", "-o", in_folder("F.csv")), 4);
    ck_assert_ptr_nonnull(strstr(said, "F.csv: cannot be written: File too large"));
    ck_assert_int_eq(remove_files(0), 0);
    ck_assert_int_eq(RUN("bed", MONO, "--directions", "8", "--plot", in_folder("F.svg")), 4);
    ck_assert_ptr_nonnull(strstr(said, "F.svg: cannot be written: File too large"));
    ck_assert_int_eq(remove_files(0), 0);
    ck_assert_int_eq(RUN("bed", MONO, "--directions", "8", "--plot", in_folder("F.png")), 4);
    ck_assert_ptr_nonnull(strstr(said, "F.png: cannot be written: File too large"));
    ck_assert_int_eq(remove_files(0), 0);
    ck_assert_int_eq(setrlimit(RLIMIT_FSIZE, &before), 0);
}
END_TEST

/* Whether a process has a file of the test's folder open besides standard output and error. It may have no name. */
static int has_output_open(pid_t process) {
    char files[64], place[400];
    int found = 0;
    snprintf(files, sizeof files, "/proc/%d/fd", (int)process);
    DIR *list = opendir(files);
    for (struct dirent *entry; list && (entry = readdir(list));) {
        char path[400];
        snprintf(path, sizeof path, "%s/%.50s", files, entry->d_name);
        const ssize_t length = readlink(path, place, sizeof place - 1);
        place[length > 0 ? length : 0] = 0;
        const char *in = strstr(place, strrchr(folder, '/'));
        found |= in != NULL && strstr(in, "/std") == NULL;
    }
    if (list) closedir(list);
    return found;
}

/* Far more work than a test has time for, stopped when the program has its output open. */
START_TEST(interrupted) {
    static const int signals[] = {SIGINT, SIGTERM};
    const char *out = in_folder("F.csv");
    const pid_t process = start(LIST("bed", MONO, "--directions", "65536", "-o", out));
    while (!has_output_open(process)) nanosleep(&(struct timespec){0, 10000000}, NULL);
    ck_assert_int_eq(kill(process, signals[_i]), 0);
    ck_assert_int_eq(finish(process), 128 + signals[_i]);
    expect_message("", "interrupted");
    ck_assert_int_eq(remove_files(0), 0);
}
END_TEST

int main(void) {
    Suite *suite = suite_create("cli");
    TCase *usage = suite_case(suite, "usage"), *pairs = suite_case(suite, "pairs"), *beds = suite_case(suite, "beds"),
          *trouble = suite_case(suite, "trouble");
    TCase *const cases[] = {usage, pairs, beds, trouble};
    for (int k = 0; k < 4; ++k) tcase_add_checked_fixture(cases[k], make_folder, remove_folder);
    tcase_add_test(usage, help_and_version);
    tcase_add_loop_test(usage, bad_usage, 0, (int)(sizeof misuse / sizeof *misuse));
    tcase_add_test(pairs, exact_pair);
    tcase_add_test(pairs, exact_pair_checked);
    tcase_add_test(pairs, beam_pair);
    tcase_add_test(pairs, cast_pair);
    tcase_add_test(pairs, blocked_pair);
    tcase_add_test(beds, surface_method);
    tcase_add_test(beds, summary);
    tcase_add_test(beds, tolerance);
    tcase_add_test(beds, same_bytes_for_any_threads);
    tcase_add_test(beds, walls);
    tcase_add_test(beds, a_box_without_a_lid);
    tcase_add_test(beds, rays);
    tcase_add_test(beds, rows_in_files);
    tcase_add_test(beds, targets_and_formats);
    tcase_add_test(beds, frames_periods_and_ids);
    tcase_add_test(beds, exchange_factors);
    tcase_add_test(beds, powers);
    tcase_add_test(beds, temperatures);
    tcase_add_test(beds, temperatures_to_an_error);
    tcase_add_test(beds, conductivity);
    tcase_add_test(beds, points_and_cutoff);
    tcase_add_test(beds, paraview_and_picture);
    tcase_add_test(beds, picture_without_gnuplot);
    tcase_add_test(beds, progress_when_asked);
    tcase_add_loop_test(trouble, bad_input, 0, (int)(sizeof bad_beds / sizeof *bad_beds));
    tcase_add_test(beds, joined);
    tcase_add_test(beds, joined_with_many_walls);
    tcase_add_loop_test(trouble, bad_rows, 0, (int)(sizeof damaged_rows / sizeof *damaged_rows));
    tcase_add_test(trouble, missing_rows);
    tcase_add_test(trouble, file_trouble);
    tcase_add_test(trouble, full_disc);
    tcase_add_loop_test(trouble, interrupted, 0, 2);
    return suite_run(suite);
}
