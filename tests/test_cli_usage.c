/* test_cli_usage.c - usage of the program, pairs, faults, rows of ranks. SPDX-License-Identifier: MIT */
#include "program.h"

FIXTURE(make_folder, remove_folder)

#define W(n)                                                                                                           \
    { .whole = (n) }

TEST(help_and_version) {
    SUCCEED("--help");
    ck_assert(strstr(printed, "factors") && strstr(printed, "pair"));
    SUCCEED("help");
    assert_has(printed, "Commands:");
    FAIL_WITH(2, "help", "nothing");
    SUCCEED("--version");
    assert_begins(printed, "fibrad ");
    SUCCEED("-V");
    assert_begins(printed, "fibrad ");
    SUCCEED("factors", "--help", "all");
    static const char *const options[] = {"--method",  "--directions", "--areas",    "--points",         "--cutoff",
                                          "--targets", "--threads",    "--periodic", "--frame",          "--positions",
                                          "--raw",     "--plot",       "-o",         "[233 directions;", "Example"};
    for (size_t k = 0; k < sizeof options / sizeof *options; ++k) assert_has(printed, options[k]);
    ck_assert(strstr(printed, "--emissivity") && strstr(printed, "--rays"));
    SUCCEED("pair", "1", "--help");
    ck_assert(strstr(printed, "--obstacle") && strstr(printed, "--check") && strstr(printed, "--nf"));
    ck_assert_str_eq(said, "");
}

/* The help of a command is one screen; --help all has every option. */
TEST(help_is_short) {
    static const struct {
        const char *command;
        int options, all;
    } commands[] = {{"factors", 28, 45}, {"heat", 31, 52}, {"conductivity", 28, 45},
                    {"join", 28, 45},    {"pair", 28, 45}, {"furnace", 28, 45}};
    for (size_t k = 0; k < sizeof commands / sizeof *commands; ++k)
        for (int all = 0; all < 2; ++all) {
            int lines = 0, options = 0;
            SUCCEED(commands[k].command, "--help", all ? "all" : NULL);
            for (const char *at = printed; (at = strchr(at, '\n')); ++at) {
                ++lines;
                options += strncmp(at, "\n  -", 4) == 0;
            }
            ck_assert_msg(lines <= 50 || all, "%s: %d lines", commands[k].command, lines);
            ck_assert_int_le(options, all ? commands[k].all : commands[k].options);
        }
    SUCCEED("help", "heat", "all");
    assert_has(printed, "--wall-rays");
    SUCCEED("heat", "--help");
    assert_lacks(printed, "--wall-rays");
    assert_has(printed, "fibrad heat --help all");
}

static const struct {
    const char *arguments[9], *reason;
} misuse[] = {
    {{NULL}, "the command is missing"},
    {{"furnish"}, "unknown command furnish; see fibrad --help"},
    {{"haet"}, "unknown command haet; did you mean heat? see fibrad --help"},
    {{"cond"}, "unknown command cond; did you mean conductivity?"},
    {{"heat", MONO, "--tempearture=9"}, "unknown option --tempearture; did you mean --temperature? see fibrad heat"},
    {{"heat", MONO, "--solid_conductivity", "9"}, "did you mean --solid-conductivity?"},
    {{"heat", MONO, "--solid-c", "9"}, "did you mean --solid-conductivity?"},
    {{"heat", MONO, "--wall-temperature", "9"}, "--wall-temperature zmin=1200 is now --wall zmin:temperature=1200"},
    {{"heat", MONO, "--wall-power=zmin=9"}, "--wall-power zmin=500 is now --wall zmin:power=500"},
    {{"heat", MONO, "-emissivity", ".5"}, "did you mean --emissivity?"},
    {{"bed", MONO}, "fibrad bed is now fibrad factors"},
    {{"exchange", MONO, "--emissivity=.5"}, "fibrad exchange is now fibrad factors, with --emissivity"},
    {{"heat", MONO, "--emissivity=1:Makefile", "--temperature=9"},
     "'Makefile' is not a list like 1:0.5,2:0.8; if Makefile is a table, write @Makefile"},
    {{"heat", MONO, "--emissivity=./Makefile", "--temperature=9"}, "if ./Makefile is a table, write @./Makefile"},
    {{"heat", MONO, "--emissivity=.5", "--temperature=@Makefile"}, "--temperature takes no table, as '@Makefile'"},
    {{"heat", MONO, "--emissivity=.5", "--temperature=9", "--ambient=Makefile", "--until=1", "--heat-capacity=1",
      "--density=1"},
     "'Makefile' is not a number; if Makefile is a table, write @Makefile"},
    {{"heat", MONO, "--emissivity=.5", "--temperature=9", "--ambient=@Makefile"},
     "--ambient takes tables with --until"},
    {{"heat", MONO, "--emissivity=.5", "--temperature=9", "--ambient=9", "--wall=zmin:temperature=Makefile"},
     "if Makefile is a table, write @Makefile"},
    {{"heat", MONO, "--emissivity=.5", "--temperature=9", "--ambient=9", "--wall=zmin:temperature=@Makefile"},
     "--wall: zmin: '@Makefile' is a table; walls take tables with --until"},
    {{"heat", MONO, "--emissivity=.5", "--temperature=9", "--ambient=9", "--wall=zmni:temperature=9"},
     "--wall: 'zmni' is no wall; did you mean zmin?"},
    {{"--bad"}, "unknown option --bad; see fibrad --help"},
    {{"factors"}, "FILE is missing"},
    {{"factors", MONO, "--bad=3"}, "unknown option --bad; see fibrad factors --help"},
    {{"factors", MONO, "-x"}, "unknown option -x; see fibrad factors --help"},
    {{"pair", "1", "1", "0", "--raw"}, "unknown option --raw; see fibrad pair --help"},
    {{"factors", MONO, "-o"}, "--output needs an argument"},
    {{"factors", MONO, "--wall", "zmin,top"},
     "--wall: 'top' is no wall; there are box, auto, xmin ... zmax, cylinder:X,Y,R, xcylinder:Y,Z,R, ycylinder:X,Z,R "
     "and mesh:FILE"},
    {{"heat", MONO, "--wall", "zmin:at=0,temperature=1300"},
     "--wall: temperature=1300 is not how a wall is written: zmin:at=VALUE:temperature=T:emissivity=E, "},
    {{"conductivity", MONO, "--emissivity=.5", "--temperature=2000:300:100"}, "is not FROM:TO:STEP, which ascends"},
    {{"factors", MONO, "--wall", "zmin=3"}, "--wall: zmin=3 is not how a wall is written"},
    {{"factors", MONO, "--wall", "zmin:temperature=3"},
     "--wall: zmin: 'temperature' is of no use here; there are at, open"},
    {{"factors", MONO, "--wall", "xmin,xmax,ymin,ymax,zmin"}, "add zmax:open (zmax:open:at=H"},
    {{"factors", MONO, "--wall", "cylinder:6,6,9"}, "add zmin:open,zmax:open"},
    {{"factors", MONO, "--wall", "xcylinder:6,6,19"}, "add xmin:open,xmax:open"},
    {{"factors", MONO, "--wall", "xcylinder:6,6"}, "--wall: xcylinder: needs Y,Z,R, a place and a radius above 0"},
    {{"factors", MONO, "--wall", "ycylinder:6,6,-1"}, "--wall: ycylinder: needs X,Z,R, a place and a radius above 0"},
    {{"factors", MONO, "--wall", "ycylinder:6,6,19,zmin"}, "--wall: zmin cannot be combined with a cylinder along y"},
    {{"factors", MONO, "--wall", "xcylinder:6,6,19,cylinder:6,6,9"},
     "--wall: there can be one cylinder, not xcylinder and cylinder too"},
    {{"factors", PERIODIC, "--wall", "ycylinder:6,6,19"},
     "--wall: a cylinder along y needs x and z axes that are not periodic"},
    {{"heat", MONO, "--wall=box,zmax:open:temperature=600"},
     "--wall: zmax: open excludes temperature; an opening is as"},
    {{"heat", MONO, "--emissivity=.5", "--temperature=9", "--wall=box:temperature=600,zmax:open"},
     "--ambient is missing: the bed is open"},
    {{"factors", MONO, "--method", "surface"}, "'surface' is none of beam, cast and mc; fibrad pair has"},
    {{"factors", MONO, "--wall=auto:emissivity=.5"}, "--wall: emissivity needs --emissivity"},
    {{"factors", MONO, "--solid-conductivity=3"}, "--solid-conductivity needs --emissivity"},
    {{"factors", MONO, "--emissivity=.5", "--cutoff=3"},
     "--method, --areas, --points and --cutoff are for view factors"},
    {{"factors", MONO, "--emissivity=.5", "--error=1e-6"}, "--error: 1e-06 is not within 1e-05 and 1"},
    {{"heat", MONO, "--every=60"}, "--every 60 is now --times every:60"},
    {{"factors", PERIODIC, "--wall", "box"}, "lies across a periodic axis"},
    {{"factors", MONO, "--raw=yes"}, "--raw takes no argument"},
    {{"factors", MONO, "-o", "out.txt"}, "unknown ending; there are .csv, .mtx, .npz, .vtp and .json"},
    {{"factors", MONO, "--plot", "out.pdf"}, "unknown ending; there are .svg and .png"},
    {{"factors", MONO, "--slice=x=3"}, "--slice needs --plot"},
    {{"factors", MONO, "--plot=bed.svg", "--slice=r=3"}, "--slice: 'r=3' is none of x=VALUE, y=VALUE and z=VALUE"},
    {{"factors", MONO, "--plot=bed.svg", "--slice=z=99"}, "--slice: no sphere is at z = 99; spheres are from -0.000"},
    {{"factors", MONO, "--frame", "2:1"}, "--frame: '2:1' is none of K, all, A:B, A:B:STEP, -1"},
    {{"factors", MONO, "--frame", "-2"}, "--frame: '-2' is none of"},
    {{"factors", MONO, "--frame", "0:9:0"}, "--frame: '0:9:0' is none of"},
    {{"factors", MONO, "--frame=all", "--plot", "bed.svg"}, "--plot shows one frame"},
    {{"factors", MONO, "--length-unit", "furlong"}, "--length-unit: 'furlong' is none of m, cm, mm"},
    {{"factors", MONO, "--length-unit", "lj"}, "--length-unit: 'lj' is none of"},
    {{"factors", MONO, "--radius", "0"}, "--radius: 0 is not within"},
    {{"factors", MONO, "--radius", "1:2,1:3"}, "--radius: type 1 is named twice"},
    {{"factors", MONO, "--radius", "1:2,x"}, "is not a list like 1:0.5,2:0.8"},
    {{"factors", MONO, "--raw", "--drop=.1"}, "--drop needs rows that are averaged"},
    {{"pair", "1", "1", "1", "--method", "surface", "--nf", "56"}, "--nf: 56 is not built in; 8, 13, 21"},
    {{"pair", "1", "1", "1", "--nf", "55"}, "are for --method surface"},
    {{"factors", MONO, "--nf", "55"}, "--method surface and --nf are of fibrad pair and fibrad reproduce"},
    {{"factors", MONO, "--method", "magic"}, "'magic' is none of beam, cast and mc"},
    {{"factors", MONO, "--method", "exact"}, "'exact' is none of beam, cast and mc"},
    {{"factors", MONO, "--rays", "100"}, "--rays and --seed are for --method cast and mc"},
    {{"factors", MONO, "--method=cast", "--rays", "0"}, "--rays: '0' is not a whole number from 1 to 4294967295"},
    {{"factors", MONO, "--method=mc", "--seed", "-1"}, "--seed: '-1'"},
    {{"factors", MONO, "--method=cast", "--directions", "100"}, "are for --method beam"},
    {{"factors", MONO, "--emissivity", "-1"}, "--emissivity: -1 is not within"},
    {{"factors", MONO, "--emissivity", "1:2"}, "--emissivity: 2 is not within"},
    {{"factors", MONO, "--emissivity=.5", "--wall=zmin:emissivity=1.5"}, "zmin: emissivity: 1.5 is not within 0 and 1"},
    {{"factors", MONO, "--emissivity=.5", "--wall=zmin:emissivity"}, "zmin: emissivity needs a value"},
    {{"factors", MONO, "--emissivity", "1.5"}, "--emissivity: 1.5 is not within 0 and 1"},
    {{"factors", MONO, "--emissivity=.5", "--error=.1", "--rays=9"}, "leave out --rays"},
    {{"factors", MONO, "--emissivity=.5", "--raw", "--drop=.1"}, "--drop needs rows that are averaged"},
    {{"factors", MONO, "--emissivity=.5", "-o", "D.dump"}, "unknown ending; there are .csv, .mtx, .npz"},
    {{"heat", "--emissivity=.5"}, "FILE is missing"},
    {{"heat", MONO, "--temperature", "v_T"}, "--emissivity is missing"},
    {{"heat", MONO, "--emissivity", ".5"}, "--temperature or --power is missing"},
    {{"heat", MONO, "--emissivity=.5", "--temperature", "-3"}, "--temperature: -3 is below absolute zero"},
    {{"heat", MONO, "--emissivity=.5", "--temperature=9", "--patches=100"}, "--patches: 100 is not built in"},
    {{"heat", MONO, "--model=spheres"}, "--model is not needed any more: powers at one time are by patches"},
    {{"heat", MONO, "--emissivity=.5", "--temperature=9", "--error=.1", "--points=64"}, "leave out --directions"},
    {{"heat", MONO, "--emissivity=.5", "--temperature=9", "--temperature-unit=F"}, "'F' is neither K nor C"},
    {{"heat", MONO, "--emissivity=.5", "--temperature=9", "--ambient=-1"}, "--ambient: -1 is not within"},
    {{"heat", MONO, "--emissivity=.5", "--temperature=9"}, "--ambient is missing: the bed is open"},
    {{"heat", MONO, "--emissivity=.5", "--temperature=9", "--ambient=3", "--wall=zmin"},
     "--wall: zmin has no temperature; give zmin:temperature=NUMBER, zmin:power=NUMBER or zmin:insulated"},
    {{"heat", MONO, "--emissivity=.5", "--temperature=9", "--power=4"}, "a sphere has only one of them"},
    {{"heat", MONO, "--emissivity=.5", "--power=1e40"}, "--power: 1e40 is not within"},
    {{"heat", MONO, "--wall=zmin:power=1:temperature=3"},
     "--wall: zmin: temperature excludes power, unless the wall has a capacity"},
    {{"heat", MONO, "--emissivity=.5", "--power=4", "--ambient=3", "--wall=zmin:power=1"},
     "--wall: zmin is endless and needs a temperature"},
    {{"heat", MONO, "--emissivity=.5", "--power=4", "--ambient=3", "--wall=zmin:temperature=hot"},
     "'hot' is not a number"},
    {{"heat", MONO, "--emissivity=.5", "--temperature=9", "-o", "q.mtx"},
     "unknown ending; there are .csv, .vtp, .json, .dump"},
    {{"conductivity", MONO}, "--emissivity is missing"},
    {{"conductivity", "--emissivity", ".5"}, "FILE is missing"},
    {{"join"}, "FILE is missing"},
    {{"join", MONO, "-o", "D.dump"}, "unknown ending; there are .csv, .mtx, .npz"},
    {{"factors", MONO, "--directions", "7"}, "'7' is not a whole number from 8 to 65536"},
    {{"factors", MONO, "--error", "0"}, "--error: 0 is not within 1e-07 and 1"},
    {{"factors", MONO, "--error", "1e-8"}, "--error: 1e-8 is not within 1e-07 and 1"},
    {{"factors", MONO, "--error", "small"}, "--error: 'small' is not a number"},
    {{"factors", MONO, "--error", "nan"}, "--error: 'nan' is not a number"},
    {{"factors", MONO, "--error", ".01", "--directions", "100"}, "leave out --directions"},
    {{"factors", MONO, "--error", ".01", "--method", "mc"}, "--error is for --method beam"},
    {{"factors", MONO, "--directions", "65537"}, "--directions: '65537'"},
    {{"factors", MONO, "--directions", "1e3"}, "--directions: '1e3'"},
    {{"factors", MONO, "--directions", "-8"}, "--directions: '-8'"},
    {{"factors", MONO, "--directions", ""}, "--directions: ''"},
    {{"factors", MONO, "--points", "100"}, "64, 128 and 256 are"},
    {{"factors", MONO, "--areas", "some"}, "'some' is neither exact nor points"},
    {{"factors", MONO, "--areas", "exact", "--points", "64"}, "--points contradicts --areas exact"},
    {{"factors", MONO, "--cutoff", "far"}, "--cutoff: 'far' is not a number"},
    {{"factors", MONO, "--cutoff", "0"}, "--cutoff: 0 is not within"},
    {{"factors", MONO, "--cutoff", "nan"}, "--cutoff: 'nan' is not a number"},
    {{"factors", MONO, "--threads", "0"}, "--threads: '0'"},
    {{"factors", MONO, "--periodic", "1,2"}, "three lengths LX,LY,LZ"},
    {{"factors", MONO, "--periodic", "1,2,-3"}, "three lengths LX,LY,LZ"},
    {{"factors", MONO, "--periodic", "1,2,3,4"}, "more than 3 numbers"},
    {{"factors", MONO, "--periodic", "1,,3"}, "does not begin with a number"},
    {{"factors", MONO, "--targets", ""}, "is not a list like 3,7,10-19"},
    {{"factors", MONO, "--plot=build/a.svg", "--plot=build/b.svg"}, "--plot is given twice"},
    {{"factors", MONO, "--json=build/a.json", "--json", "build/b.json"}, "--json is given twice"},
    {{"heat", MONO, "--profile=z:build/a.csv", "--profile=z:build/b.csv"}, "--profile is given twice"},
    {{"furnace", "--case=1", "-o", "build/a.csv", "-obuild/b.csv"}, "--output is given twice"},
    {{"factors", MONO, "--targets", "1,,2"}, "is not a list like"},
    {{"factors", MONO, "--targets", "5-3"}, "is not a list like"},
    {{"factors", MONO, "--targets", "3-"}, "is not a list like"},
    {{"factors", MONO, "--targets", "99999999999999999999"}, "is not a list like"},
    {{"factors", MONO, "--targets", "0"},
     "there is no sphere 0 in frame 0 of tests/data/mono2000.dump; its spheres are 1 to 2000"},
    {{"factors", MONO, "--targets=1-2000,7,5000000000"}, "there is no sphere 5000000000"},
    {{"factors", MONO, "--targets", "1990-2001"}, "there is no sphere 2001 in frame 0 of"},
    {{"factors", MONO, "--targets", "0-9"}, "there is no sphere 0 in frame 0 of"},
    {{"factors", MONO, "--positions", "--targets", "0-2000"}, "its spheres are 0 to 1999"},
    {{"pair", "1", "1"}, "R1, R2 and GAP are needed"},
    {{"pair", "1", "1", "0", "0"}, "three lengths are allowed, not also '0'"},
    {{"pair", "1", "-1", "0"}, "R2: -1 is not within"},
    {{"pair", "1", "1", "x"}, "GAP: 'x' is not a number"},
    {{"pair", "1", "1", "-2"}, "one sphere lies inside the other"},
    {{"pair", "1", "1", "0", "--no-correction"}, "are for --method surface"},
    {{"pair", "1", "1", "0", "--obstacle", "1,2,3"}, "is not X,Y,Z,R"},
    {{"pair", "1", "1", "0", "--obstacle", "1,2,3,0"}, "is not X,Y,Z,R"},
    {{"pair", "1", "1", "0", "--method", "beam"}, "'beam' is neither exact nor surface"},
    {{"pair", "1", "1", "0", "--method", "surface", "--check"}, "--check is for the exact factor"},
    {{"pair", "1", "1", "1", "--method", "surface", "--obstacle", "0,0,0.5,1"}, "sphere 1 and obstacle 1"},
    {{"pair", "1", "1", "1", "--obstacle", "0,0,3,1"}, "sphere 2 and obstacle 1"},
};

LOOP_TEST(bad_usage, sizeof misuse / sizeof *misuse) {
    ck_assert_int_eq(finish(start(misuse[_i].arguments)), 2);
    expect_message("", misuse[_i].reason);
    ck_assert_str_eq(printed, "");
}

static double pair(const char *r1, const char *r2, const char *gap) {
    SUCCEED("pair", r1, r2, gap, "--method=exact");
    return value_of("F12");
}

/* A column that is misspelt, and a table without @. */
TEST(columns_meant) {
    FAIL_WITH(3, "heat", MONO, "--emissivity=.5", "--temperature=v_t", "--ambient=9");
    expect_message(MONO ":9: ", "no column v_t; did you mean v_T? there are id, ");
    FAIL_WITH(3, "heat", MONO, "--emissivity=Makefile", "--temperature=9", "--ambient=9");
    assert_has(said, "no column Makefile; there are id, ");
    assert_has(said, "; if Makefile is a table, write @Makefile\n");
}

/* The order of columns in the help is that in the file; .vtp of `exchange`. */
TEST(help_is_true) {
    const char *columns = "i,T_K,q_W,q_error_W,T_error_K,body";
    SUCCEED("heat", "--help", "all");
    assert_has(printed, columns);
    SUCCEED("factors", "--help");
    assert_has(printed, ".vtp)");
    const char *bed = write_file("two.csv", "x,y,z,r\n0,0,1,1\n3,0,1,1\n"), *csv = in_folder("q.csv");
    SUCCEED("heat", bed, "--emissivity=.5", "--temperature=900", "--ambient=300", "--length-unit=m",
            "--wall=zmin:at=0:temperature=400", "-o", csv, "--json", in_folder("q.json"));
    assert_begins(read_file(csv), columns);
    double error;
    ck_assert_int_eq(sscanf(strstr(read_file(csv), "\n-2,"), "\n-2,%*[^,],%*[^,],%lf,,zmin", &error), 1);
    ck_assert_double_eq(json_of(in_folder("q.json"), "wall_zmin_error_W"), error);
    ck_assert_double_eq_tol(value_of("wall_zmin_error_W"), error, .05 * error);
    SUCCEED("factors", bed, "--emissivity=.5", "-o", in_folder("D.vtp"));
}

TEST(exact_pair) {
    ck_assert_double_eq_tol(pair("1", "1", "0"), 0.5 - 4 / (3 * M_PI), 1e-15);
    ck_assert_double_eq_tol(pair("1", "1", "1"), 0.0295903122505504314, 1e-16);
    ck_assert_double_eq_tol(pair("1", "1", "30"), 2.442599800579042e-4, 1e-18);
    ck_assert_double_eq_tol(pair("1", "0.3", ".05"), 0.09 * pair("0.3", "1", ".05"), 1e-16);
    ck_assert_double_gt(pair("1", "1", "-.01"), pair("1", "1", "0"));
}

TEST(exact_pair_checked) {
    SUCCEED("pair", "1", "0.3", "0.05", "--check");
    const double f12 = value_of("F12");
    ck_assert_double_eq(value_of("kernel"), f12);
    ck_assert_double_eq_tol(value_of("gsl_lens") / f12, 1, 1e-12);
    assert_has(printed, "difference");
    const char *last = formatted("\nF12 %.17g\n", f12);
    ck_assert_str_eq(printed + strlen(printed) - strlen(last), last);
    SUCCEED("pair", "1", "0.3", "-0.05", "--check");
    ck_assert_double_eq_tol(value_of("gsl_lens") / value_of("F12"), 1, 1e-12);
}

TEST(blocked_pair) {
    SUCCEED("pair", "1", "1", "2", "--obstacle", "0.5,0,2,0.4");
    const double exact = value_of("F12");
    ck_assert_double_lt(exact, 0.9 * pair("1", "1", "2"));
    SUCCEED("pair", "1", "1", "2", "--obstacle", "0.5,0,2,0.4", "--method", "surface", "--nf", "610");
    ck_assert_double_eq_tol(value_of("F12") / exact, 1, 1e-3);
    SUCCEED("pair", "1", "1", "0", "--method", "surface", "--no-correction");
    ck_assert_double_eq_tol(value_of("F12") / 0.0755868184216124, 1 - .0475649, 1e-6); /* docs/validation.md */
    SUCCEED("pair", "1", "1", "2", "--obstacle", "50,0,2,0.4");
    const double beside = value_of("F12");
    ck_assert_double_eq_tol(beside, pair("1", "1", "2"), 1e-9);
}

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
    {TWO_SPHERES("0", "xy xz yz ff ff ff", "1 1 4 4 70\n1 7 4 4 5\n"), ":6: ", "bounds"},
    {TWO_SPHERES("0", "ff pp ff", "1 4 0 4 70\n1 4 8 4 5\n"), ":11: ", "line 10"}, /* the same place in the box */
};

LOOP_TEST(bad_input, sizeof bad_beds / sizeof *bad_beds) {
    const char *bed = write_file("bad.bed", bad_beds[_i].text);
    FAIL_WITH(3, "factors", bed, "-o", in_folder("out.csv"), "--plot", in_folder("out.svg"));
    expect_message(formatted("%s%s", bed, bad_beds[_i].place), bad_beds[_i].reason);
    ck_assert_str_eq(printed, "");
    ck_assert_int_eq(remove_files(0), 1); /* bad.bed alone */
}

union word {
    uint64_t whole;
    double real;
};

#define R(x)                                                                                                           \
    { .real = (x) }

#define FAR 1099511627781u /* an id of more than 32 bits */

/* The rows of three grey spheres with a wall. Rank 0 has 10 and FAR, rank 1 has 30. Whole numbers are a head of nine
 * words, of which "FIBROWS1" is the first, ids, starts and columns. The others are F, walls, escaped, beyond, errors,
 * radii, emissivities and centres. */
enum { RANKS = 2, WORDS = 42 };
#define CUTOFF_10 0x4024000000000000 /* the bits of 10. */
static const struct {
    size_t wholes, reals;
    uint64_t whole[17];
    double real[21];
} rank_rows[RANKS] = {{17,
                       21,
                       {0x3153574f52424946, 0, 2, 700, 2, 3, 1, 1, CUTOFF_10, 10, FAR, 0, 2, 3, 30, FAR, 10},
                       {.25, .125, .0625, .5, .75, .125, .125, 0, .0625, .01, .02, 1, .5, .5, .5, 0, 0, 0, 3, 0, 0}},
                      {13,
                       10,
                       {0x3153574f52424946, 1, 2, 700, 1, 1, 1, 1, CUTOFF_10, 30, 0, 1, 10},
                       {.375, .5, .125, 0, .01, 1, .75, 0, 2.5, 0}}};
static const char *const rank_names[RANKS] = {"a.0.rows", "a.1.rows"};

static const char *write_words(const char *name, const union word *words, size_t bytes) {
    const char *path = in_folder(name);
    FILE *file = opened(path, "wb");
    ck_assert_uint_eq(fwrite(words, 1, bytes, file), bytes);
    ck_assert_int_eq(fclose(file), 0);
    return path;
}

/* The words of the file of a rank. Returns its bytes. */
static size_t words_of_rank(int k, union word words[WORDS]) {
    const size_t wholes = rank_rows[k].wholes, reals = rank_rows[k].reals;
    memcpy(words, rank_rows[k].whole, 8 * wholes);
    memcpy(words + wholes, rank_rows[k].real, 8 * reals);
    return 8 * (wholes + reals);
}

static const char *write_rank(int k) {
    union word words[WORDS];
    const size_t bytes = words_of_rank(k, words);
    return write_words(rank_names[k], words, bytes);
}

/* The largest number of walls that a scene may have. */
TEST(joined_with_many_walls) {
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

TEST(joined) {
    const char *zero = write_rank(0), *one = write_rank(1), *csv = in_folder("D.csv"), *mtx = in_folder("D.mtx");
    const char *json = in_folder("D.json");
    SUCCEED("join", one, zero, "--raw", "--positions", "-o", csv, "--json", json);
    ck_assert_double_eq(value_of("spheres"), 3);
    ck_assert_double_eq(value_of("nonzeros"), 4);
    ck_assert_double_eq_tol(json_of(json, "beyond_mean"), .0625 / 3, 1e-16);
    ck_assert_double_eq_tol(json_of(json, "wall_1_F"), 1.75 / 3, 1e-15);
    ck_assert_double_eq(value_of("closure_max"), 0);
    ck_assert_double_eq_tol(json_of(json, "reciprocity_max"), (.75 * .375 - .5 * .25) / .75, 1e-15);
    ck_assert_str_eq(read_file(csv),
                     "i,j,D,body\n0,1,0.25,\n0,2,0.125,\n0,-1,0.125,surroundings\n0,-2,0.5,wall_1\n1,0,0.375,\n"
                     "1,-1,0.125,surroundings\n1,-2,0.5,wall_1\n2,0,0.0625,\n2,-1,0.125,surroundings\n"
                     "2,-2,0.75,wall_1\n2,-3,0.0625,beyond\n");
    SUCCEED("join", zero, one, "--raw", "-o", csv);
    assert_has(read_file(csv), "\n10,1099511627781,0.125,\n10,-1,0.125,surroundings\n");
    SUCCEED("join", zero, one, "-o", mtx);
    ck_assert_double_lt(value_of("closure_max"), 1e-14);
    ck_assert_double_lt(value_of("reciprocity_max"), 1e-14);
    assert_has(read_file(mtx), "\n% ids: 10 30 1099511627781\n3 3 4\n1 2 ");
    SUCCEED("join", zero, one, "--raw", "-o", in_folder("D.vtp"), "-o", "-", "--format", "csv");
    ck_assert_str_eq(printed, read_file(csv));
    assert_has(said, "spheres 3\n");
    char *text = read_file(in_folder("D.vtp"));
    ck_assert(strstr(text, "Name=\"wall_1\"") && strstr(text, "Name=\"id\""));
    SUCCEED("join", zero, one, "--quiet");
    ck_assert_str_eq(printed, "");
    FAIL_WITH(2, "join", one, "-o", one);
    expect_message(one, "unknown ending");
    FAIL_WITH(2, "join", zero, csv, "-o", csv);
    expect_message(csv, "is read in this run");
    const char *both = in_folder("both.json");
    FAIL_WITH(2, "join", zero, one, "-o", both, "--json", both); /* one output would replace the other */
    expect_message(both, "is given twice");
    FAIL_WITH(2, "join", zero, one, "--json", one);
    expect_message(one, "is read in this run");
    SUCCEED("join", zero, one, "--json", "-");
    assert_begins(printed, "{\"fibrad\"");
    assert_has(said, "\nspheres 3\n");
    remove_files(0);
}

/* One changed word in the file of one rank. */
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

LOOP_TEST(bad_rows, sizeof damaged_rows / sizeof *damaged_rows) {
    const char *files[RANKS];
    for (int k = 0; k < RANKS; ++k) {
        union word words[WORDS];
        const size_t bytes = words_of_rank(k, words);
        if (k == damaged_rows[_i].rank) words[damaged_rows[_i].word] = damaged_rows[_i].value;
        files[k] = write_words(rank_names[k], words, bytes);
    }
    FAIL_WITH(3, "join", files[0], files[1], "-o", in_folder("D.csv"));
    expect_message(files[damaged_rows[_i].rank], damaged_rows[_i].reason);
    ck_assert_str_eq(printed, "");
    ck_assert_int_eq(remove_files(0), RANKS); /* no D.csv */
}

TEST(missing_rows) {
    const char *zero = write_rank(0), *one = write_rank(1);
    FAIL_WITH(3, "join", zero);
    expect_message(zero, "is one of 2 files; the file of rank 1 is missing");
    FAIL_WITH(3, "join", one);
    expect_message(one, "the file of rank 0 is missing");
    FAIL_WITH(3, "join", zero, one, zero);
    expect_message(zero, "has the rows of rank 0, as");
    FAIL_WITH(4, "join", zero, "no/such.rows");
    expect_message("no/such.rows: ", "No such file");
    union word near[WORDS];
    const size_t bytes = words_of_rank(1, near);
    near[21].real = .5; /* 30 inside 10 */
    FAIL_WITH(3, "join", zero, write_words(rank_names[1], near, bytes));
    expect_message("", "ids 10 and 30: ");
    remove_files(0);
}

TEST(file_trouble) {
    const char *bed = write_file("a.csv", "x,y,z,r\n0,0,0,1\n3,0,0,1\n");
    FAIL_WITH(4, "factors", "no/such.dump");
    expect_message("no/such.dump: ", "No such file");
    FAIL_WITH(4, "factors", folder);
    expect_message(folder, "directory");
    FAIL_WITH(4, "factors", bed, "-o", "no/such/F.csv");
    expect_message("no/such/F.csv: ", "No such file");
    output = "/dev/full";
    FAIL_WITH(4, "factors", bed);
    output = NULL;
    expect_message("standard output", "No space left");
    ck_assert_int_eq(remove_files(0), 1);
}
