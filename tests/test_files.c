/* test_files.c - what users bring and take away: units, ids, frames, walls by name, summaries.
 * SPDX-License-Identifier: MIT */
#include "cli/output.h"
#include "program.h"

FIXTURE(make_folder, remove_folder)

#define ATOMS "ITEM: ATOMS id type x y z radius T\n"

/* Three spheres, in the order of their ids and in another order. */
#define SORTED   "3 1 1 4 4 1 600\n7 2 3.5 4 4 1 300\n20 1 1 6.5 4 0.7 450\n"
#define UNSORTED "20 1 1 6.5 4 0.7 450\n3 1 1 4 4 1 600\n7 2 3.5 4 4 1 300\n"

static char text_of_frame[2000];

/* Writes a frame of a dump. If `units` is NULL, the frame does not say its units. */
static const char *frame(const char *units, const char *step, const char *atoms, const char *rows) {
    snprintf(text_of_frame, sizeof text_of_frame,
             "%s%s%sITEM: TIMESTEP\n%s\nITEM: NUMBER OF ATOMS\n%s\nITEM: BOX BOUNDS ff ff ff\n0 8\n0 8\n0 8\n" ATOMS
             "%s",
             units ? "ITEM: UNITS\n" : "", units ? units : "", units ? "\n" : "", step, atoms, rows);
    return text_of_frame;
}

#define HEAT "heat", "--emissivity", "0.6", "--temperature", "T", "--directions", "21", "--patches", "24"

/* The power of a wall or sphere in a .csv of heat. The beginning or the end of its line tells which. */
static double power_of(const char *path, const char *begin, const char *end) {
    char *text = read_file(path);
    double t, q = NAN;
    for (char *line = text; line && *line; line = strchr(line, '\n'), line += line != NULL) {
        const size_t length = strcspn(line, "\n");
        if (strncmp(line, begin, strlen(begin)) != 0 || strlen(end) > length) continue;
        if (strncmp(line + length - strlen(end), end, strlen(end)) != 0) continue;
        const char *number = line + strlen(begin);
        if (*begin == 0) number = strchr(line, ',') + 1;
        ck_assert_int_eq(sscanf(number, "%lf,%lf", &t, &q), 2);
    }
    ck_assert_msg(!isnan(q), "no line %s ... %s in %s", begin, end, text);
    return q;
}

/* ---- walls and surroundings ------------------------------------------------------------------------------------- */

/* Temperatures belong to the walls by name, whatever the order of the names. */
TEST(wall_temperatures_by_name) {
    const char *bed = write_file("bed.dump", frame(NULL, "0", "3", SORTED)), *out = in_folder("q.csv");
    static const char *const lists[] = {
        "zmin:at=-.001:temperature=1200:emissivity=.5,auto:temperature=700,zmax:temperature=300",
        "zmin:at=-.001,zmax:temperature=300,auto:temperature=700,"
        "zmin:emissivity=.5:temperature=1200:at=-1e-3"};
    char *first = NULL;
    for (int k = 0; k < 2; ++k) {
        SUCCEED(HEAT, bed, "--wall", lists[k], "-o", out);
        ck_assert_double_eq(value_of("wall_zmin_K"), 1200);
        ck_assert_double_eq(value_of("wall_zmax_K"), 300);
        ck_assert_double_eq(value_of("wall_ymax_K"), 700);
        ck_assert_double_eq(value_of("wall_zmin_at"), -.001);
        ck_assert_double_eq(value_of("wall_zmin_emissivity"), .5);
        ck_assert_double_eq(value_of("wall_xmin_emissivity"), 1);
        read_same(out, &first);
        assert_has(first, "\n-2,1200,");
        ck_assert_double_lt(power_of(out, "-2,", ",zmin"), 0); /* the hottest */
    }
}

/* The program makes up no temperature: if something reaches the surroundings, it asks for theirs. */
TEST(surroundings_are_asked_for) {
#define WARM ":temperature=300"
#define TUBE "cylinder:4,4,6" WARM
    const char *bed = write_file("bed.dump", frame(NULL, "0", "3", SORTED));
    static const char *const open[] = {"zmin" WARM, "zmin" WARM ",zmax" WARM, TUBE ",zmin:open,zmax:open",
                                       TUBE ",zmin" WARM ",zmax:open"};
    static const char *const closed[] = {"auto" WARM, TUBE ",zmin" WARM ",zmax" WARM};
    for (int k = 0; k < 4; ++k) {
        FAIL_WITH(2, HEAT, bed, "--wall", open[k]);
        expect_message("", "--ambient is missing: the bed is open");
        SUCCEED(HEAT, bed, "--wall", open[k], "--ambient", "290");
        ck_assert_double_eq(value_of("surroundings_K"), 290);
    }
    for (int k = 0; k < 2; ++k) SUCCEED(HEAT, bed, "--wall", closed[k]);
    SUCCEED(HEAT, bed, "--periodic", "8,8,0", "--wall", "zmin" WARM ",zmax" WARM);
    SUCCEED(HEAT, bed, "--periodic", "8,8,8");
    FAIL_WITH(2, HEAT, bed, "--periodic", "8,8,0");
    expect_message("", "--ambient is missing");
}

/* Some spheres have a temperature and the others have a power. Columns with blanks or nan, a number for the others, and
 * types all give the same bytes. The output repeats what is given. */
TEST(temperatures_and_powers_mixed) {
#define MIXED                                                                                                          \
    "heat", "--emissivity", ".6", "--directions", "21", "--patches", "24", "--length-unit", "m", "--ambient", "300"
    static const char *const words[][4] = {{"--temperature", "2:900", "--power", "1:40"},
                                           {"--temperature", "T", "--power", "P"},
                                           {"--temperature", "T", "--power", "40"},
                                           {"--temperature", "900", "--power", "P"}};
    static const char *const beds[] = {
        "x,y,z,r,type,T,P\n0,0,0,1,1,,40\n3,0,0,1,2,900,\n0,3,0,1,1,,40\n",
        "x;y;z;r;type;P;T\n0;0;0;1;1;40;NaN\n3;0;0;1;2;nan;900\n0;3;0;1;1;40;\n",
        "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n3\nITEM: BOX BOUNDS ff ff ff\n-9 9\n-9 9\n-9 9\n"
        "ITEM: ATOMS x y z radius type T P\n0 0 0 1 1 nan 40\n3 0 0 1 2 900 nan\n0 3 0 1 1 nan 40\n",
        "# vtk DataFile Version 3.0\nbed\nASCII\nDATASET POLYDATA\nPOINTS 3 double\n0 0 0 3 0 0 0 3 0\nPOINT_DATA 3\n"
        "SCALARS radius double\nLOOKUP_TABLE default\n1 1 1\nSCALARS type double\nLOOKUP_TABLE default\n1 2 1\n"
        "SCALARS T double\nLOOKUP_TABLE default\nnan 900 nan\nSCALARS P double\nLOOKUP_TABLE default\n40 nan 40\n"};
    const char *out = in_folder("q.csv");
    char *first = NULL;
    for (int k = 0; k < 16; ++k) {
        const char *const *w = words[k % 4], *bed = write_file("bed", beds[k / 4]);
        SUCCEED(MIXED, bed, w[0], w[1], w[2], w[3], "-o", out);
        read_same(out, &first);
        ck_assert_double_eq(power_of(out, "0,", ","), -40);
        ck_assert_double_lt(power_of(out, "1,", ","), 0);
        assert_has(first, "\n1,900,");
    }
    const char *bed = write_file("bed", beds[0]);
    FAIL_WITH(3, MIXED, bed, "--temperature", "T"); /* only spheres that have a power may have blanks */
    expect_message(bed, "T is not a number: ''");
    FAIL_WITH(2, MIXED, bed, "--temperature", "x", "--power", "40");
    expect_message("", "--power 40 is for no sphere");
    FAIL_WITH(3, MIXED, bed, "--temperature", "T", "--power", "type");
    expect_message(bed, "sphere 1 has both a temperature and a power");
    FAIL_WITH(3, MIXED, bed, "--temperature", "T", "--power", "2:5");
    expect_message(bed, "sphere 0 has neither a temperature nor a power");
    FAIL_WITH(2, MIXED, bed, "--temperature", "600", "--power", "40", "--radius", "T");
    FAIL_WITH(3, "heat", bed, "--emissivity", "T", "--temperature", "600", "--ambient", "300");
    expect_message(bed, "T is not a number: ''");
}

/* ---- units ------------------------------------------------------------------------------------------------------ */

/* The same numbers are in another unit of length. Powers change by its square, and factors do not change. */
TEST(units_of_length) {
    static const struct {
        const char *units, *option;
        double metres;
    } unit[] = {{"si", NULL, 1},        {"cgs", NULL, .01}, {"micro", NULL, 1e-6}, {"nano", NULL, 1e-9},
                {"metal", NULL, 1e-10}, {NULL, "mm", 1e-3}, {NULL, "cm", .01},     {NULL, "cgs", .01},
                {"lj", "mm", 1e-3},     {"cgs", "cm", .01}};
    const char *out = in_folder("q.csv");
    double metres = NAN;
    char *factors = NULL;
    for (size_t k = 0; k < sizeof unit / sizeof *unit; ++k) {
        const char *bed = write_file("bed.dump", frame(unit[k].units, "0", "3", SORTED));
        if (unit[k].option)
            SUCCEED(HEAT, bed, "--ambient", "300", "-o", out, "--length-unit", unit[k].option);
        else
            SUCCEED(HEAT, bed, "--ambient", "300", "-o", out);
        const double q = power_of(out, "3,", ","), square = unit[k].metres * unit[k].metres;
        if (k == 0) metres = q;
        ck_assert_double_eq_tol(q, metres * square, 1e-13 * fabs(metres) * square);
        assert_lacks(said, "taken as metres");
        SUCCEED("factors", bed, "--directions", "21", "-o", out);
        read_same(out, &factors);
    }
    FAIL_WITH(2, HEAT, write_file("lj.dump", frame("lj", "0", "3", SORTED)), "--ambient", "300");
    expect_message(in_folder("lj.dump"), "units lj have no fixed length in metres; --length-unit gives the length");
    const char *cgs = write_file("cgs.dump", frame("cgs", "0", "3", SORTED));
    FAIL_WITH(2, HEAT, cgs, "--ambient", "300", "--length-unit", "mm");
    expect_message(cgs, "its units are cgs");
    const char *bed = write_file("bed.dump", frame(NULL, "0", "3", SORTED)); /* millimetres, to judge by its radii */
    SUCCEED(HEAT, bed, "--ambient", "300");
    expect_message(bed, "warning: radii of 0.9 are taken as metres");
    FAIL_WITH(2, HEAT, bed, cgs, "--ambient", "300", "--length-unit", "mm"); /* a series has one unit */
    expect_message(cgs, "its units are cgs");
    FAIL_WITH(2, HEAT, cgs, write_file("si.dump", frame("si", "0", "3", SORTED)), "--ambient", "300");
    expect_message(in_folder("si.dump"), "the unit of length is 1 m, but that of the files before is 0.01 m");
}

TEST(degrees_celsius) {
    const char *kelvins = write_file("k.csv", "x,y,z,r,T\n0,0,0,.01,600\n.03,0,0,.01,300\n");
    const char *celsius = write_file("c.csv", "x,y,z,r,T\n0,0,0,.01,326.85\n.03,0,0,.01,26.85\n");
    const char *one = in_folder("one.csv"), *two = in_folder("two.csv");
    SUCCEED(HEAT, kelvins, "--ambient", "290", "--wall", "zmin:temperature=500", "-o", one);
    SUCCEED(HEAT, celsius, "--ambient", "16.85", "--wall", "zmin:temperature=226.85", "--temperature-unit", "C", "-o",
            two);
    for (int k = 0; k < 4; ++k) {
        static const char *const begin[] = {"0,", "1,", "-1,", "-2,"};
        const double q = power_of(one, begin[k], "");
        ck_assert_double_eq_tol(power_of(two, begin[k], ""), q, 1e-11 * fabs(q));
    }
}

/* The name of a column may say its unit. Then the user must not give another one. */
TEST(units_of_temperature_columns) {
    const char *kelvins = write_file("k.csv", "x,y,z,r,T [K]\n0,0,0,.01,300\n"), *out = in_folder("q.csv");
    const char *celsius = write_file("c.csv", "x,y,z,r,T [C]\n0,0,0,.01,26.85\n"), *other = in_folder("p.csv");
    FAIL_WITH(3, HEAT, kelvins, "--temperature-unit", "C", "--ambient", "20");
    expect_message(kelvins, ":1: the column T is in [K], but is taken as [C]; see --temperature-unit");
    FAIL_WITH(3, HEAT, celsius, "--ambient", "290");
    expect_message(celsius, ":1: the column T is in [C], but is taken as [K]");
    SUCCEED(HEAT, kelvins, "--ambient", "290", "-o", out);
    SUCCEED(HEAT, celsius, "--ambient", "16.85", "--temperature-unit", "C", "-o", other);
    ck_assert_double_eq_tol(power_of(other, "0,", ""), power_of(out, "0,", ""), 1e-9);
}

/* Columns of other units of the right kind, and the same values in the expected ones, give the same bytes. */
TEST(units_of_columns_of_properties) {
    static const char *const bed[] = {"x [mm],y [mm],z [mm],R [mm],k [W/(m K)],c [J/(kg K)],rho [kg/m3],P "
                                      "[W]\n0,0,0,10,30,800,2500,50\n40,0,0,12,20,900,2600,90\n",
                                      "x [mm],y [mm],z [mm],R [mm],k [W/cm/K],c [kJ/kgK],rho [g/cm3],P "
                                      "[kW]\n0,0,0,10,.3,.8,2.5,.05\n40,0,0,12,.2,.9,2.6,.09\n"};
    char *steady = NULL, *timed = NULL;
    for (int k = 0; k < 2; ++k) {
        const char *file = write_file("bed.csv", bed[k]), *out = in_folder("q.csv");
        SUCCEED("heat", file, "--radius", "R", "--emissivity", ".8", "--solid-conductivity", "k", "--power", "P",
                "--ambient", "300", "--directions", "21", "--patches", "24", "-o", out);
        read_same(out, &steady);
        SUCCEED("heat", file, "--radius", "R", "--emissivity", ".8", "--temperature", "900", "--power", "P",
                "--heat-capacity", "c", "--density", "rho", "--until", "60", "--ambient", "300", "--directions", "21",
                "--patches", "24", "-o", out);
        read_same(out, &timed);
    }
    const char *wrong = write_file("bed.csv", "x,y,z,r,k [W]\n0,0,0,1,3\n");
    FAIL_WITH(3, "heat", wrong, "--length-unit", "m", "--emissivity", ".8", "--temperature", "900", "--ambient", "300",
              "--solid-conductivity", "k");
    expect_message(wrong, ":1: the column k is in [W], but is taken as [W/(m K)]");
}

#define SOLID "--length-unit", "m", "--temperature", "T", "--ambient", "300", "--directions", "21", "--patches", "24"

/* The header of a table says which column is which. Beyond the ends there is a warning. */
TEST(names_and_ends_of_tables) {
    const char *bed = write_file("bed.csv", "x,y,z,r,T\n0,0,0,.01,1200\n.03,0,0,.01,600\n.06,0,0,.01,250\n");
    const char *plain = write_file("Tk.csv", "T,k\n300,2\n1100,4\n"),
               *turned = write_file("kT.csv", "k [mW/(mm K)],T [K]\n2,300\n4,1100\n");
    const char *const tables[] = {formatted("@%s", plain), formatted("@%s", turned)}, *out = in_folder("q.csv");
    char *first = NULL;
    for (int k = 0; k < 2; ++k) {
        SUCCEED("heat", bed, "--emissivity", ".8", "--solid-conductivity", tables[k], SOLID, "-o", out);
        read_same(out, &first);
        expect_message(bed,
                       "warning: --solid-conductivity: 2 spheres have temperatures beyond the table, by up to 100 K");
        SUCCEED("factors", bed, "--emissivity", ".8", "--solid-conductivity", tables[k], "--temperature", "T",
                "--length-unit", "m", "--directions", "21");
        expect_message(bed,
                       "warning: --solid-conductivity: 2 spheres have temperatures beyond the table, by up to 100 K");
    }
    const char *law = formatted("@%s", write_file("e.csv", "T [C],e\n0,.5\n900,.7\n"));
    SUCCEED("heat", bed, "--emissivity", law, SOLID, "--until", "1", "--heat-capacity", "800", "--density", "2500");
    expect_message(bed, "warning: --emissivity: 2 spheres have temperatures beyond the table, by up to ");
    const char *within = formatted("@%s", write_file("e.csv", "T [K],e\n200,.5\n1200,.7\n"));
    SUCCEED("heat", bed, "--emissivity", within, SOLID);
    ck_assert_str_eq(said, "");
}

/* Tables of time may be in minutes, and in the unit of --temperature-unit alone. */
TEST(units_and_ends_of_tables_of_time) {
    const char *bed = write_file("bed.csv", "x,y,z,r\n0,0,0,.01\n.03,0,0,.01\n"), *out = in_folder("q.csv");
    static const char *const rooms[] = {"0,20\n60,500\n", "t [min],T [C]\n0,20\n1,500\n",
                                        "T_C;t [h]\n20;0\n500;0,0166666666666666666\n"};
#define ROOM                                                                                                           \
    "heat", bed, "--length-unit", "m", "--emissivity", ".8", "--temperature", "600", "--heat-capacity", "800",         \
        "--density", "2500", "--directions", "21", "--wall"
    char *first = NULL;
    for (int k = 0; k < 3; ++k) {
        const char *room = formatted("@%s", write_file("room.csv", rooms[k]));
        SUCCEED(ROOM, "zmin:at=-1:temperature=25", "--temperature-unit", "C", "--until", "60", "--ambient", room, "-o",
                out);
        read_same(out, &first);
        ck_assert_str_eq(said, "");
        FAIL_WITH(k > 0 ? 3 : 0, ROOM, "zmin:at=-1:temperature=25", "--until", "30", "--ambient", room);
        if (k > 0) expect_message(in_folder("room.csv"), "in [C], but is taken as [K]; see --temperature-unit");
    }
    const char *lid = formatted("zmin:at=-1:temperature=@%s", write_file("lid.csv", "5 300\n10 400\n"));
    SUCCEED(ROOM, lid, "--until", "30", "--ambient", "300");
    assert_has(said, "warning: the table of zmin begins at 5 s; before, its first temperature is taken");
    assert_has(said, "warning: the table of zmin ends at 10 s; from there to 30 s its last temperature is taken");
}

/* ---- columns and rows ------------------------------------------------------------------------------------------- */

/* A table of another code is the same bed. */
TEST(columns_and_rows_of_another_code) {
    const char *same = write_file("same.csv", "id,x,y,z,r,T\n3,0,0,0,.01,600\n9,.03,0,0,.01,300\n"),
               *out = in_folder("q.csv");
    const char *other = write_file(
        "other.csv", "ID,p_x [m],p_y [m],p_z [m],diameters [m],Temp [K],mat,note\n9,.03,0,0,.02,300,steel,7\n"
                     "3,.5,0,0,.02,300,glass,7\n3,0,0,0,.02,600,steel,7\n3,1,0,0,.02,600,steel,8\n");
#define NAMED "x=p_x,y=p_y [m],z=p_z,d=diameters,T=Temp"
    char *first = NULL;
    SUCCEED(HEAT, same, "--ambient", "300", "--length-unit", "m", "-o", out);
    read_same(out, &first);
    SUCCEED(HEAT, other, "--ambient", "300", "--columns", NAMED, "--only", "mat=steel", "--skip", "note=8.0", "-o",
            out);
    read_same(out, &first);
    const char *bare = write_file("bare.txt", "3 0 0 0 .02 600\n9 .03 0 0 .02 300\n");
    SUCCEED(HEAT, bare, "--ambient", "300", "--columns", "id=1,x=2 [m],y=3 [m],z=4 [m],d=5 [m],T=6", "-o", out);
    read_same(out, &first);
    SUCCEED(HEAT, write_file("c.csv", "x,y,z,r,heat_C\n0,0,0,.01,600\n"), "--ambient", "300", "--columns", "T=heat_C");
    expect_message(in_folder("c.csv"), "warning: the column heat_C is taken as kelvins");
    FAIL_WITH(3, "factors", other, "--columns", NAMED);
    expect_message(other, ":4: the id 3 occurs in line 3, too");
    FAIL_WITH(3, "factors", bare);
    expect_message(bare, ":1: numbers without a header that names their columns, such as x,y,z,r; --columns x=1,y=2");
    static const char *const bad[][3] = {{"--columns", "x", "--columns: 'x' is not x=NAME"},
                                         {"--columns", "x=a,,y=b", "'' is not x=NAME"},
                                         {"--columns", "x=", "'x=' is not"},
                                         {"--columns", "=a", "'=a' is not"},
                                         {"--columns", "x=a,X=b", "x and X are one thing"},
                                         {"--columns", "r=a,d=b", "r and d are one thing"},
                                         {"--only", "mat", "--only: 'mat' is not COLUMN=VALUE"},
                                         {"--skip", "=3", "--skip: '=3' is not"}};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; ++k) {
        FAIL_WITH(2, "factors", other, bad[k][0], bad[k][1]);
        assert_has(said, bad[k][2]);
    }
    FAIL_WITH(2, "factors", other, "--columns", NAMED, "--radius", ".01");
    expect_message("", "--radius and --columns d=diameters both give radii");
    SUCCEED("factors", other, "--emissivity", ".5", "--columns", NAMED, "--only", "mat=steel", "--skip", "note=8");
    SUCCEED("conductivity", PERIODIC, "--emissivity", ".5", "--columns", "x=x", "--skip", "id=1", "--error", ".2");
}

/* ---- names ------------------------------------------------------------------------------------------------------ */

/* The order of a file does not matter: ids tell the spheres. */
TEST(ids_in_any_order) {
    static const char *const rows[] = {SORTED, UNSORTED};
    static const char *const endings[] = {"F.csv", "F.mtx", "F.npz", "F.vtp", "F.json"};
    for (int format = 0; format < 5; ++format) {
        char *first = NULL;
        const char *out = in_folder(endings[format]);
        for (int k = 0; k < 2; ++k) {
            const char *bed = write_file("bed.dump", frame(NULL, "0", "3", rows[k]));
            SUCCEED("factors", bed, "--directions", "21", "-o", out);
            struct stat there;
            ck_assert_int_eq(stat(out, &there), 0);
            char *text = read_file(out);
            if (first) ck_assert_int_eq(memcmp(text, first, (size_t)there.st_size), 0);
            first = text;
        }
    }
    const char *bed = write_file("bed.dump", frame(NULL, "0", "3", UNSORTED)), *out = in_folder("rows.csv");
    SUCCEED("factors", bed, "--targets", "7-19", "-o", out);
    assert_begins(read_file(out), "i,j,F,body\n7,3,");
    SUCCEED("factors", bed, "--targets", "0", "--positions", "-o", out);
    assert_begins(read_file(out), "i,j,F,body\n0,1,");
    FAIL_WITH(2, "factors", bed, "--targets", "8-19");
    expect_message("", "there is no sphere 8 in frame 0 of ");
}

TEST(ambiguous_ids) {
    const char *bed = write_file("bed.dump", frame(NULL, "0", "2", "3 1 1 4 4 1 9\n3 1 4 4 4 1 9\n"));
    FAIL_WITH(3, "factors", bed);
    expect_message(bed, ":11: the id 3 occurs in line 10, too");
    SUCCEED("factors", bed, "--positions");
    bed = write_file("bed.dump", frame(NULL, "0", "2", "3 1 1 4 4 1 9\n-1 1 4 4 4 1 9\n"));
    FAIL_WITH(3, "factors", bed);
    expect_message(bed, ":11: the id -1 is negative");
    SUCCEED("factors", bed, "--positions");
    bed = write_file("bed.dump", frame(NULL, "0", "2", "30 1 1 4 4 1 9\n7 1 1.5 4 4 1 9\n"));
    FAIL_WITH(3, "factors", bed);
    expect_message(bed, "sphere 7"); /* messages, too */
}

TEST(values_by_type) {
    const char *bed = write_file("bed.csv", "x,y,z,type,T\n0,0,0,1,600\n.03,0,0,2,300\n0,.03,0,1,300\n");
    const char *same =
        write_file("same.csv", "x,y,z,r,e,T\n0,0,0,.01,.3,600\n.03,0,0,.015,0,300\n0,.03,0,.01,.3,300\n");
    const char *one = in_folder("one.csv"), *two = in_folder("two.csv");
    SUCCEED("heat", bed, "--radius", "1:.01,2:.015", "--emissivity", "1:.3,2:0", "--temperature", "T", "--ambient",
            "300", "-o", one);
    SUCCEED("heat", same, "--emissivity", "e", "--temperature", "T", "--ambient", "300", "-o", two);
    char *first = read_file(one), *second = read_file(two);
    ck_assert_str_eq(first, second);
    ck_assert_double_le(fabs(power_of(one, "1,", "")), 1e-9 * fabs(power_of(one, "0,", ""))); /* reflects all */
    const char *colons = write_file("colons.csv", "x,y,z,r,velo:0\n0,0,0,.01,300\n");
    SUCCEED("heat", colons, "--emissivity", "1", "--temperature", "velo:0", "--ambient", "300"); /* no list of types */
    FAIL_WITH(3, "factors", bed, "--radius", "1:.01");
    expect_message(bed, ":3: the list of the radius has no type 2");
    SUCCEED("factors", bed, "--radius", ".01");
    ck_assert_double_eq(value_of("radius_max"), .01);
}

/* ---- frames ----------------------------------------------------------------------------------------------------- */

static const char *write_frames(const char *name, int frames) {
    static const char *const rows[] = {SORTED, "20 1 1 6.5 4 0.7 450\n3 1 1 4 4 1 900\n7 2 3.6 4 4 1 300\n",
                                       "7 2 3.7 4 4 1 500\n20 1 1 6.5 4 0.7 250\n3 1 1 4 4 1 900\n"};
    static const char *const steps[] = {"100", "250", "900"};
    const char *path = in_folder(name);
    OWNED_FILE *file = opened(path, "w");
    for (int k = 0; k < frames; ++k) fputs(frame(NULL, steps[k], "3", rows[k]), file);
    return path;
}

/* All frames in one run give the same bits as one run for each frame. */
TEST(all_frames) {
    const char *bed = write_frames("bed.dump", 3), *all = in_folder("all.csv");
    static const char *const number[] = {"0", "1", "2"}, *const begin[] = {"0,100,", "1,250,", "2,900,"};
    SUCCEED(HEAT, bed, "--frame", "all", "--ambient", "300", "-o", all, "-o", in_folder("q.*.vtp"), "-o",
            in_folder("all.json"));
    char *text = read_file(all), *at = strchr(text, '\n') + 1;
    ck_assert_int_eq(strncmp(text, "frame,timestep,i,T_K,q_W,q_error_W,T_error_K,body\n", 30), 0);
    for (int k = 0; k < 3; ++k) {
        const char *one = in_folder("one.csv");
        SUCCEED(HEAT, bed, "--frame", number[k], "--ambient", "300", "-o", one);
        char *expected = read_file(one);
        for (char *line = strchr(expected, '\n') + 1; *line; line = strchr(line, '\n') + 1) {
            assert_begins(at, begin[k]);
            at += strlen(begin[k]);
            const size_t length = strcspn(line, "\n") + 1;
            ck_assert_int_eq(strncmp(at, line, length), 0);
            at += length;
        }
    }
    ck_assert_int_eq(*at, 0);
    for (int k = 0; k < 3; ++k) read_file(formatted("%s/q.%d.vtp", folder, k));
    text = read_file(in_folder("q.pvd")); /* ParaView opens this file: frames by their timesteps */
    assert_has(text, "<DataSet timestep=\"100\" file=\"q.0.vtp\"/>\n<DataSet timestep=\"250\" file="
                     "\"q.1.vtp\"/>\n<DataSet timestep=\"900\" file=\"q.2.vtp\"/>\n");
    ck_assert_int_eq(remove_files(0), 8);
}

TEST(some_frames) {
    const char *bed = write_frames("bed.dump", 3), *out = in_folder("F.csv");
    SUCCEED("factors", bed, "--frame", "0:3:2", "--directions", "8", "-o", out);
    char *text = read_file(out);
    assert_begins(text, "frame,timestep,i,j,F,body\n0,100,3,");
    assert_has(text, "\n2,900,3,");
    assert_lacks(text, "\n1,");
    SUCCEED("factors", bed, "--frame", "-1", "--directions", "8");
    ck_assert_double_eq(value_of("frame"), 2);
    ck_assert_double_eq(value_of("timestep"), 900);
    SUCCEED("factors", bed, "--frame", ":2", "--directions", "8");
    ck_assert_double_eq(value_of("frame"), 1);
    FAIL_WITH(3, "factors", bed, "--frame", "3");
    expect_message(bed, "there is no frame 3; the last is 2");
    FAIL_WITH(2, "factors", bed, "--frame", "99999999999999999999");
    expect_message("--frame", "is none of K");
    FAIL_WITH(2, "factors", bed, "--frame", "all", "-o", in_folder("F.npz"));
    expect_message(in_folder("F.npz"), "holds one frame");
}

/* A series of files, named by a pattern that the shell has left alone, is one run. */
TEST(several_files) {
    const char *first = write_frames("bed.1.dump", 1), *out = in_folder("F.csv"), *names = in_folder("bed.*.dump");
    write_frames("bed.2.dump", 2);
    SUCCEED("factors", names, "--directions", "8", "-o", out, "-o", in_folder("F.*.mtx"));
    char *text = read_file(out);
    assert_begins(text, formatted("file,frame,timestep,i,j,F,body\n%s,0,100,3,", first));
    assert_has(text, "bed.2.dump,1,250,3,7,");
    read_file(in_folder("F.1.mtx"));
    SUCCEED("factors", first, first, "--directions", "8", "-o", in_folder("F.*.json"), "-o", in_folder("F.*.vtp"));
    assert_has(read_file(in_folder("F.1.json")), "\"frame\":1,"); /* frames are counted through all files */
    text = read_file(in_folder("F.pvd")); /* two frames have the same timestep, so their numbers stand for it */
    ck_assert(strstr(text, "timestep=\"0\" file=\"F.0.vtp\"") && strstr(text, "timestep=\"1\" file=\"F.1.vtp\""));
    write_frames("bed.10.dump", 3); /* times are not padded with zeros: 10 comes after 2 */
    SUCCEED("factors", names, "--directions", "8", "-o", out);
    text = read_file(out);
    assert_has(text, "bed.10.dump,2,900,3,7,");
    ck_assert(strstr(text, "bed.10.dump,") > strstr(text, "bed.2.dump,"));
    names = in_folder("none.*.dump");
    FAIL_WITH(4, "factors", names);
    expect_message(names, "no file has such a name");
    SUCCEED("factors", first, write_file("bed.csv", "x,y,z,r\n0,0,0,1\n"), "--directions", "8");
    expect_message(in_folder("bed.csv"),
                   "warning: spheres are named by positions, but those of the frames before by ids");
    FAIL_WITH(2, "factors", "-", first, "-");
    expect_message("standard input", "once only");
}

/* A series may begin before the first sphere is there. */
TEST(empty_files_of_a_series) {
    const char *empty = write_file("0.dump", frame(NULL, "0", "0", "")), *bed = write_frames("1.dump", 1);
    SUCCEED("factors", empty, bed, "--directions", "8");
    expect_message(empty, "warning: frame 0 is empty and is left out");
    ck_assert_double_eq(value_of("timestep"), 100);
    FAIL_WITH(3, "factors", empty);
    FAIL_WITH(3, "factors", empty, empty);
    assert_has(said, "there are no spheres in any of the files");
}

/* A simulation is still writing this file. The program computes the frames before and says so. */
TEST(truncated_last_frame) {
    const char *bed = write_frames("bed.dump", 3);
    struct stat there;
    ck_assert_int_eq(stat(bed, &there), 0);
    ck_assert_int_eq(truncate(bed, there.st_size - 30), 0);
    SUCCEED("factors", bed, "--frame", "all", "--directions", "8");
    expect_message(bed, "warning: ");
    ck_assert_double_eq(value_of("frame"), 1);
    FAIL_WITH(3, "factors", bed, "--directions", "8");
    expect_message(bed, "the last whole frame is 1");
    FAIL_WITH(3, "factors", bed, "--frame", "2", "--directions", "8");
}

/* If radii are given for the first frame, they also serve frames with more spheres. */
TEST(radii_of_growing_frames) {
    static const int counts[] = {2, 300};
    const char *bed = in_folder("bed.dump"), *all = in_folder("all.csv"), *last = in_folder("last.csv");
    FILE *file = opened(bed, "w");
    for (int k = 0; k < 2; ++k) {
        fprintf(file, "ITEM: TIMESTEP\n%d\nITEM: NUMBER OF ATOMS\n%d\nITEM: ATOMS id x y z\n", k, counts[k]);
        for (int i = 0; i < counts[k]; ++i) fprintf(file, "%d %d %d %d\n", i + 1, i % 7, i / 7 % 7, i / 49);
    }
    fclose(file);
    SUCCEED("factors", bed, "--frame", "all", "--radius", ".4", "--directions", "8", "-o", all);
    SUCCEED("factors", bed, "--frame", "1:", "--radius", ".4", "--directions", "8", "-o", last);
    char *text = read_file(all), *expected = read_file(last);
    const char *frame = strstr(text, "\n1,1,1,2,");
    ck_assert_ptr_nonnull(frame);
    ck_assert_str_eq(frame, strchr(expected, '\n'));
}

/* ---- what is said ----------------------------------------------------------------------------------------------- */

TEST(summary_says_what_was_computed) {
    const char *bed = write_file("bed.dump", frame("cgs", "700", "3", SORTED)), *json = in_folder("q.json");
    static const char *const lines[] = {"\nframe 0\n",
                                        "\ntimestep 700\n",
                                        "\nspheres 3\n",
                                        "\nlength_unit cgs\n",
                                        "\nradius_max 1\n",
                                        "\nbox_high 8 8 8\n",
                                        "\nperiods 0 0 0\n",
                                        "\nemissivity 0.6\n",
                                        "\ntemperature_K column T\n",
                                        "\nsurroundings_K 300\n",
                                        "\nwall_zmin_at 0\n",
                                        "\nwall_zmin_K 1200\n",
                                        "\nwall_zmin_emissivity 1\n",
                                        "\nnamed_by ids\n"};
    SUCCEED(HEAT, bed, "--ambient", "300", "--wall", "zmin:temperature=1200", "--json", json);
    for (size_t k = 0; k < sizeof lines / sizeof *lines; ++k) assert_has(printed, lines[k]);
    assert_begins(printed, "file ");
    ck_assert_double_eq(json_of(json, "wall_zmin_K"), 1200);
    const double exact = json_of(json, "wall_zmin_W"), shown = value_of("wall_zmin_W");
    ck_assert_double_eq_tol(shown, exact, 1e-5 * fabs(exact));
    SUCCEED("factors", MONO, "--directions", "21");
    for (const char *line = strtok(printed, "\n"); line; line = strtok(NULL, "\n")) /* no digits without meaning */
        ck_assert_msg(strlen(line) < 60, "%s", line);
}

TEST(quiet_and_streams) {
    const char *bed = write_file("bed.dump", frame(NULL, "0", "3", SORTED));
    SUCCEED("factors", bed, "--quiet", "-o", in_folder("F.csv"));
    ck_assert_str_eq(printed, "");
    ck_assert_str_eq(said, "");
    SUCCEED("factors", bed, "-o", "-", "--format", "csv");
    ck_assert_str_eq(printed, read_file(in_folder("F.csv")));
    assert_has(said, "\nspheres 3\n");
}

/* Before the work begins, the program says what does not fit, and what would help. */
/* No two results of a run go to one place. The summary is one of them. */
TEST(one_place_each) {
    const char *bed = write_frames("bed.dump", 2), *name = in_folder("q.1.json");
    static const char *const more[][4] = {{"-o", "q.1.json"}, {"-o", "q.*.json"}, {"-o", "-", "--format", "json"}};
    for (int k = 0; k < 3; ++k) {
        const int standard = more[k][2] != NULL;
        const char *const to = standard ? "-" : in_folder(more[k][1]);
        FAIL_WITH(2, HEAT, bed, "--ambient", "300", "--frame", "0:2", "--length-unit", "m", "--quiet", "--json",
                  standard ? "-" : name, "-o", to, more[k][2], more[k][3]);
        expect_message(standard ? "-" : name, "is given twice");
        ck_assert_int_eq(access(name, F_OK), -1);
    }
    SUCCEED(HEAT, bed, "--ambient", "300", "--json", "-");
    assert_begins(printed, "{\"fibrad\"");
    assert_lacks(printed, "\nfile");
    assert_has(said, "\nframe 1\n");
}

#define CORNER(x, y) "vertex " x " " y " 0\n"
#define FLOOR                                                                                                          \
    "solid s\nfacet normal 0 0 1\nouter loop\n" CORNER("-9", "-9") CORNER("17", "-9")                                  \
        CORNER("-9", "17") "endloop\nendfacet\nendsolid s\n"

/* No output replaces a file that the run reads, whichever file that is. */
TEST(inputs_stay) {
    static const char *const names[] = {"bed.dump", "floor.0.vtp", "eps.csv", "room.json", "lid.json", "sides.svg"};
    static const char *const contents[] = {NULL,   FLOOR, "300 .5\n900 .6\n", "0 300\n9 310\n", "0 700\n9 710\n",
                                           "650\n"};
    static const char *const outputs[] = {"-o", "--wall-vtp", "-o", "--json", "-o", "--plot"};
    const char *path[6];
    for (int k = 0; k < 6; ++k) path[k] = write_file(names[k], k ? contents[k] : frame(NULL, "0", "3", SORTED));
    const char *wall = formatted("mesh:%s:name=floor:both:temperatures=%s,zmax:at=20:temperature=@%s", path[1], path[5],
                                 path[4]),
               *law = formatted("@%s", path[2]);
    const char *ambient = formatted("@%s", path[3]);
    for (int k = 0; k < 6; ++k) {
        const char *other_name = formatted("%s/./%s", folder, k == 1 ? "floor.*.vtp" : names[k]); /* of the same file */
        FAIL_WITH(2, "heat", path[0], "--temperature", "T", "--emissivity", law, "--wall", wall, "--ambient", ambient,
                  "--until", "5", "--heat-capacity", "800", "--density", "2500", "--directions", "21", "--patches",
                  "24", outputs[k], other_name);
        assert_has(said, "is read in this run and would be replaced");
        ck_assert_str_eq(read_file(path[k]), k ? contents[k] : frame(NULL, "0", "3", SORTED));
    }
    ck_assert_int_eq(remove_files(0), 6);                         /* there is nothing else */
    path[0] = write_file("q.pvd", frame(NULL, "0", "3", SORTED)); /* this is the collection of q.*.vtp */
    FAIL_WITH(2, HEAT, path[0], "--ambient", "300", "--until", "5", "--heat-capacity", "800", "--density", "2500", "-o",
              in_folder("q.*.vtp"));
    ck_assert_str_eq(read_file(path[0]), frame(NULL, "0", "3", SORTED));
    input = path[0] = write_file("bed.csv", "x,y,z,r\n0,0,0,1\n3,0,0,1\n"); /* as standard input */
    FAIL_WITH(2, "factors", "-", "-o", path[0]);
    input = "/dev/null";
}

/* If nothing is emitted, there are no rows, and their figures are 0. */
TEST(summary_of_no_rows) {
    const char *bed = write_file("bed.dump", frame(NULL, "0", "3", SORTED));
    SUCCEED("factors", bed, "--emissivity", "0");
    ck_assert_double_eq(value_of("row_sum_min"), 0);
    ck_assert_double_eq(value_of("row_sum_max"), 0);
    ck_assert_double_eq(value_of("escaped_mean"), 0);
}

/* A million spheres have 1.7e7 beams each. No machine that runs this test has memory for that. */
TEST(too_little_memory) {
    enum { SIDE = 100, LINE = 20 };
    char *text = malloc(SIDE * SIDE * SIDE * LINE), *at = text;
    ck_assert_ptr_nonnull(text);
    at += sprintf(at, "x,y,z,r\n");
    for (int k = 0; k < SIDE * SIDE * SIDE; ++k)
        at += sprintf(at, "%d,%d,%d,.4\n", k % SIDE, k / SIDE % SIDE, k / SIDE / SIDE);
    const char *bed = write_file("many.csv", text);
    free(text);
    FAIL_WITH(5, "heat", bed, "--length-unit", "m", "--emissivity", ".5", "--temperature", "500", "--ambient", "300",
              "--directions", "65536", "--points", "256", "--patches", "384", "-o", in_folder("q.csv"));
    assert_has(said, "out of memory: 1");
    assert_has(said, "fewer --directions");
    ck_assert_int_eq(remove_files(0), 1);
}

/* The summary of a furnace is JSON, its fields go to standard output. */
TEST(furnace_outputs) {
    const char *json = in_folder("s.json"), *csv = in_folder("f.csv");
#define FURNACE "furnace", "--case", "1", "--method", "mc", "--cells", "3,3,6", "--bundles", "20000"
    SUCCEED(FURNACE, "--json", json, "-o", csv);
    ck_assert_ptr_null(strchr(said, '#'));
    ck_assert_double_eq_tol(json_of(json, "T_axis_2.0") / value_of("T_axis_2.0"), 1, 1e-9);
    ck_assert_double_eq(json_of(json, "bundles"), value_of("bundles"));
    char *text = read_file(csv);
    SUCCEED(FURNACE, "-o", "-");
    ck_assert_str_eq(printed, text);
    assert_has(said, "\nT_axis_2.0 ");
    SUCCEED(FURNACE, "--json", "-");
    assert_begins(printed, "{\"fibrad\"");
    FAIL_WITH(2, FURNACE, "-o", csv, "--json", csv);
    expect_message(csv, "is given twice");
}

/* If a run is killed, it leaves nothing behind, on systems where files need no name until they are complete. */
TEST(nothing_is_left_by_what_is_killed) {
    char place[] = "/tmp/fibrad_killed_XXXXXX", path[64];
    ck_assert_ptr_nonnull(mkdtemp(place));
    snprintf(path, sizeof path, "%s/out", place);
    struct output probe;
    ck_assert_int_eq(output_open(&probe, path), 0);
    const bool unnamed = probe.unnamed;
    fputs("complete", probe.file);
    ck_assert_int_eq(output_close(&probe, 0), 0);
    const pid_t child = fork();
    if (child == 0) {
        struct output left;
        if (output_open(&left, path) == 0) fputs("not complete", left.file), fflush(left.file);
        kill(getpid(), SIGKILL);
    }
    ck_assert_int_eq(waitpid(child, NULL, 0), child);
    uint32_t files = 0;
    DIR *entries = opendir(place);
    for (const struct dirent *entry; (entry = readdir(entries));) files += entry->d_name[0] != '.';
    closedir(entries);
    ck_assert_uint_eq(files, unnamed ? 1 : 2);
    char text[16] = "";
    OWNED_FILE *file = opened(path, "r");
    ck_assert_ptr_nonnull(fgets(text, sizeof text, file));
    ck_assert_str_eq(text, "complete");
    char command[80];
    snprintf(command, sizeof command, "rm -r %s", place);
    ck_assert_int_eq(system(command), 0);
}
