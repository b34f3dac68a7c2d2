/* test_read.c - readers: every format, every fault with its line. SPDX-License-Identifier: MIT */
#include <math.h>
#include <zlib.h>

#include "cli/message.h"
#include "one_file.h"
#include "read/read.h"
#include "text/read_number.h"

static struct bed bed;

static void remove_all(void) {
    remove_file();
    bed_free(&bed);
}

FIXTURE(make_file, remove_all)

/* Reads a text as a file and keeps the messages. */
static int try_options(const char *text, size_t size, const struct read_options *options) {
    write_file(text, size);
    bed_free(&bed);
    begin_catching();
    const int status = read_bed(path, options, &bed);
    end_catching();
    return status;
}

static int try(const char *text) { return try_options(text, strlen(text), &(struct read_options){0}); }

static void expect_sphere(uint32_t i, double x, double y, double z, double r, uint64_t line) {
    ck_assert_uint_lt(i, bed.n);
    ck_assert_double_eq(bed.x[i], x);
    ck_assert_double_eq(bed.y[i], y);
    ck_assert_double_eq(bed.z[i], z);
    ck_assert_double_eq(bed.r[i], r);
    ck_assert_uint_eq(bed.line[i], line);
}

/* Checks that the text is refused in one line that names the file, the line (0: none) and the reason. */
static void expect_refusal(const char *text, size_t size, const struct read_options *options, unsigned line,
                           const char *reason) {
    const int status = try_options(text, size, options);
    ck_assert_msg(status == STATUS_INPUT, "status %d: %s", status, text);
    assert_begins(said, line ? formatted("fibrad: %s:%u: ", path, line) : formatted("fibrad: %s: ", path));
    assert_has(said, reason);
    ck_assert_ptr_eq(strchr(said, '\n'), said + strlen(said) - 1);
}

TEST(csv_columns_may_have_any_order) {
    ck_assert_int_eq(try("name,r,z,y,x\r\n\"a,\"\"b\",0.5, 3 ,\"2\",1\r\n\n# comment\nb , 1e-1,-3,-2,-1"), 0);
    ck_assert_uint_eq(bed.n, 2);
    expect_sphere(0, 1, 2, 3, 0.5, 2);
    expect_sphere(1, -1, -2, -3, 0.1, 5);
    ck_assert(bed.period[0] == 0 && bed.period[1] == 0 && bed.period[2] == 0);
}

TEST(csv_may_follow_a_mark_and_comments) {
    ck_assert_int_eq(try("\xEF\xBB\xBF# made by hand\n\nx,y,z,diameter\n1,2,3,1\n"), 0);
    expect_sphere(0, 1, 2, 3, 0.5, 4);
    ck_assert_int_eq(try("\xEF\xBB\xBFx,y,z,radius\n1,2,3,1\n"), 0);
    expect_sphere(0, 1, 2, 3, 1, 2);
}

TEST(further_columns_are_read_by_name) {
    const char *const names[] = {"emissivity", "T"};
    const char text[] = "T,x,y,z,r,emissivity,id\n300,0,0,0,1,0.8,17\n400,3,0,0,1,0.9,4\n";
    const char *const units[] = {NULL, "K"};
    const struct read_options options = {.extra = names, .unit = units, .extras = 2};
    ck_assert_int_eq(try_options(text, sizeof text - 1, &options), 0);
    ck_assert_double_eq(bed.extra[0], 0.9); /* by id */
    ck_assert_double_eq(bed.extra[1], 400);
    ck_assert_double_eq(bed.extra[2], 0.8);
    ck_assert_double_eq(bed.extra[3], 300);
    ck_assert_int_eq(bed.id[0], 4);
    ck_assert_int_eq(bed.id[1], 17);
    const char bad[] = "x,y,z,r,emissivity,T,id\n0,0,0,1,dark,1,1\n";
    expect_refusal(bad, sizeof bad - 1, &options, 2, "emissivity is not a number: 'dark'");
    const char unit[] = "x,y,z,r,emissivity [-],T [C],id\n0,0,0,1,1,1,1\n";
    expect_refusal(unit, sizeof unit - 1, &options, 1, "the column T is in [C], but is taken as [K]");
    const char kelvins[] = "x,y,z,r,emissivity [-],T (K)\n0,0,0,1,0.5,300\n";
    ck_assert_int_eq(try_options(kelvins, sizeof kelvins - 1, &options), 0);
    const char lacking[] = "x,y,z,r,emissivity,id\n0,0,0,1,1,1\n";
    expect_refusal(lacking, sizeof lacking - 1, &options, 1, "no column T; there are x, y, z, r, emissivity, id");
}

/* The names of columns have units. Options may give either name. */
TEST(names_with_units_may_be_given_either_way) {
    static const char *const wanted[] = {"T", "T [C]", "T (\302\260C)", "T_[C]", "T [K]"};
    static const struct {
        const char *column;
        bool found[sizeof wanted / sizeof *wanted];
    } cases[] = {{"T [C]", {true, true, false, true, false}},
                 {"T (\302\260C)", {true, false, true, false, false}},
                 {"T[degC]", {true, false, false, false, false}},
                 {"T", {true, false, false, false, false}}};
    const char *const unit = "C";
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k)
        for (size_t w = 0; w < sizeof wanted / sizeof *wanted; ++w) {
            const struct read_options options = {.extra = &wanted[w], .unit = &unit, .extras = 1};
            const char *text = formatted("x,y,z,r,%s\n0,0,0,1,20.5\n", cases[k].column);
            const int status = try_options(text, strlen(text), &options);
            ck_assert_msg((status == 0) == cases[k].found[w], "%s as %s: %s", cases[k].column, wanted[w], said);
            if (!status) ck_assert_double_eq(bed.extra[0], 20.5);
        }
}

/* A header has many names. As many are listed as there is room for. */
TEST(as_many_columns_are_listed_as_there_is_room_for) {
    char text[5000] = "x,y,r";
    for (int k = 0; k < 500; ++k) snprintf(text + strlen(text), 20, ",c%d", k);
    strcat(text, "\n");
    expect_refusal(text, strlen(text), &(struct read_options){0}, 1, "no column z; there are x, y, r, c0, c1");
    assert_has(said, " ... (503 in all)");
}

/* Ids tell the spheres. --positions does without ids. */
TEST(ids_name_the_spheres) {
    static const struct {
        const char *id[2], *reason;
        unsigned line;
    } bad[] = {{{"3", "3"}, "the id 3 occurs in line 2, too", 3},
               {{"3", "-4"}, "the id -4 is negative", 3},
               {{"3", "1.5"}, "the id is not a whole number: '1.5'", 3},
               {{"1e-6", "2"}, "the id is not a whole number: '1e-6'", 2},
               {{"1e300", "2"}, "the id is not a whole number: '1e300'", 2},
               {{"7.0", "7"}, "the id 7 occurs in line 2, too", 3},
               {{"9223372036854775808", "2"}, "the id is too large: '9223372036854775808'", 2}};
    const struct read_options positions = {.positions = true};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; ++k) {
        const char *text = formatted("id,x,y,z,r\n%s,1,0,0,1\n%s,5,0,0,1\n", bad[k].id[0], bad[k].id[1]);
        expect_refusal(text, strlen(text), &(struct read_options){0}, bad[k].line, bad[k].reason);
        ck_assert_int_eq(try_options(text, strlen(text), &positions), 0);
        ck_assert(!bed.ids && bed.x[0] == 1 && bed.x[1] == 5);
    }
    ck_assert_int_eq(try("id,x,y,z,r\n9223372036854775807,1,0,0,1\n70000,3,0,0,1\n0,5,0,0,1\n"), 0);
    ck_assert(bed.x[0] == 5 && bed.x[1] == 3 && bed.x[2] == 1);
    ck_assert_int_eq(bed_name(&bed, 2), INT64_MAX);
    ck_assert_int_eq(try("id,x,y,z,r\n7.0,1,0,0,1\n1.000e+00,3,0,0,1\n2e2,5,0,0,1\n"), 0); /* reals */
    ck_assert(bed.id[0] == 1 && bed.id[1] == 7 && bed.id[2] == 200);
}

/* Separators, decimal commas, names in any case, units, headers in comments. */
TEST(tables_have_any_separators_and_units) {
    static const struct {
        const char *text, *units;
    } good[] = {
        {"X;Y;Z;R\n1,5;2;-3,25;0,5\n", ""},
        {"x\ty\tz\tdiameter\n1,5\t2\t-3,25\t1\n", ""},
        {"x y  z r\n1.5 2 -3.25 0.5\n", ""},
        {" x [mm], y [mm] ,z[mm],Radius (mm)\n1.5,2,-3.25,.5\n", "mm"},
        {"x [cm] y [cm] z [cm] d [cm]\n1.5 2 -3.25 1\n", "cm"},
        {"# x,y,z,r\n1.5,2,-3.25,0.5\n", ""},
        {"# x,y,z,r\n0.15D+01,2,-3.25,0.5\n", ""},
        {"information,x,y,z,r\n7,1.5,2,-3.25,0.5\n", ""},
        {"2nd,x,y,z,r\n7,1.5,2,-3.25,0.5\n", ""},
        {"# by hand\n#x y z r\n# more\n1.5 2 -3.25 0.5\n", ""},
        {"# x y z r\n1.5,2,-3.25,0.5\n", ""},
        {"\"r\",\"Points:0\",\"Points:1\",\"Points:2\"\n0.5,1.5,2,-3.25\n", ""},
        {"Points_0,Points_1,Points_2,Points_Magnitude,d\n1.5,2,-3.25,9,1\n", ""},
        {"#format x_y_z_r_attrs\n# x y z r T vx\n1.5\t2\t-3.25\t0.5\t300\t1e-3\n", ""},
        {"#format x_y_z_r_attrs\n1.5\t2\t-3.25\t0.5\t300\t1e-3\n", ""},
        {"# x y z r is what columns are\nx,y,z,R\n1.5,2,-3.25,0.5\n", ""},
    };
    for (size_t k = 0; k < sizeof good / sizeof *good; ++k) {
        ck_assert_msg(try(good[k].text) == 0, "%s%s", good[k].text, said);
        ck_assert_uint_eq(bed.n, 1);
        ck_assert_msg(bed.x[0] == 1.5 && bed.y[0] == 2 && bed.z[0] == -3.25 && bed.r[0] == 0.5, "%s", good[k].text);
        ck_assert_str_eq(bed.units, good[k].units);
    }
    /* a name that is written exactly so comes before names in another case */
    ck_assert_int_eq(try("R,x,y,z,r\n0.3,1,2,3,0.5\n"), 0);
    ck_assert_double_eq(bed.r[0], 0.5);
}

/* LIGGGHTS writes the type twice. */
TEST(equal_columns_of_one_name_are_one) {
    const char *const names[] = {"type"};
    const struct read_options options = {.extra = names, .extras = 1};
    const char text[] = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: ATOMS id type type x y z radius\n"
                        "7 2 2 3 0 0 1\n4 1 1.0 0 0 0 1\n";
    ck_assert_msg(try_options(text, sizeof text - 1, &options) == 0, "%s", said);
    ck_assert(bed.n == 2 && bed.extra[0] == 1 && bed.extra[1] == 2);
    const char other[] = "type,x,y,z,r,type\n2,0,0,0,1,3\n"; /* nothing asks for the type */
    ck_assert_int_eq(try(other), 0);
    expect_refusal(other, sizeof other - 1, &options, 2,
                   "columns 1 and 6 are both named type, and differ: '2' and '3'");
}

#define VTK_HEAD "# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET POLYDATA\nPOINTS 2 float\n1 2 3 4 5 6\n"
#define VTP(array)                                                                                                     \
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" byte_order=\"LittleEndian\">\n<PolyData><Piece "              \
    "NumberOfPoints=\"2\">\n<PointData>" array "</PointData><Points><DataArray type=\"Float32\" Name=\"p\" "           \
    "NumberOfComponents=\"3\" format=\"ascii\">1 2 3 4 5 6</DataArray></Points></Piece></PolyData></VTKFile>\n"
#define ARRAY(name, text) "<DataArray type=\"Float64\" Name=\"" name "\" format=\"ascii\">" text "</DataArray>"

#define VTP_HEAD VTP(ARRAY("radius", "1 1"))

/* Codes have names of their own. */
TEST(columns_may_have_other_names) {
    const char *const wanted[] = {"T"}, *const unit[] = {"K"};
    static const struct {
        const char *text, *units;
        size_t names;
        struct column_name name[5];
    } good[] = {
        {"p_x,p_y,p_z,diameters,Temp\n1,2,3,1,400\n",
         "",
         5,
         {{"x", "p_x"}, {"y", "p_y"}, {"z", "p_z"}, {"d", "diameters"}, {"T", "Temp"}}},
        {"p_x [mm];p_y [mm];p_z [mm];radii [mm];Temp [K]\n1;2;3;0,5;400\n",
         "mm",
         5,
         {{"X", "p_x"}, {"Y", "p_y [mm]"}, {"Z", "p_z"}, {"Radius", "radii"}, {"T", "Temp [K]"}}},
        {"1 2 3 .5 400\n", "cm", 5, {{"x", "1 [cm]"}, {"y", "2 (cm)"}, {"z", "3_[cm]"}, {"r", "4 [cm]"}, {"T", "5"}}},
        {"x,x_p,y,z,r,T\n9,1,2,3,.5,400\n", "", 1, {{"x", "x_p"}}},
        {"ITEM: UNITS\nsi\nITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: ATOMS f_x[1] f_x[2] f_x[3] f_D T\n1 2 3 "
         "1 400\n",
         "si",
         4,
         {{"x", "f_x[1]"}, {"y", "f_x[2]"}, {"z", "f_x[3]"}, {"diameter", "f_D"}}},
        {"1\nProperties=place:R:3:size:R:1:T:R:1\n1 2 3 0.5 400\n",
         "",
         4,
         {{"x", "place:0"}, {"y", "place:1"}, {"z", "place:2"}, {"r", "size"}}},
    };
    for (size_t k = 0; k < sizeof good / sizeof *good; ++k) {
        const struct read_options options = {
            .name = good[k].name, .names = good[k].names, .extra = wanted, .unit = unit, .extras = 1};
        ck_assert_msg(try_options(good[k].text, strlen(good[k].text), &options) == 0, "%zu: %s", k, said);
        ck_assert_msg(bed.n == 1 && bed.x[0] == 1 && bed.y[0] == 2 && bed.z[0] == 3 && bed.r[0] == .5, "%zu", k);
        ck_assert_double_eq(bed.extra[0], 400);
        ck_assert_str_eq(bed.units, good[k].units);
    }
    static const struct {
        const char *text, *reason;
        unsigned line;
        struct column_name name;
    } bad[] = {
        {"x,y,z,r\n0,0,0,1\n", "the header names no column p_x; there are x, y, z, r", 1, {"x", "p_x"}},
        {"x,y,z,r\n0,0,0,1\n", "the header names no column 7", 1, {"T", "7"}},
        {"1 2 3 4\n", "the header names no column y; there are 1, 2, 3, 4", 1, {"x", "1"}},
        {"x [mm],y [mm],z [mm],r [mm]\n0,0,0,1\n", "the header names no column r [m]", 1, {"r", "r [m]"}},
        {"x,y,z,r\n0,0,0,1\n", "lengths of more than one unit: x in [], r in [mm]", 1, {"r", "r [mm]"}},
        {"x,y,z,r,c_r\n0,0,0,1,1\n", "the header names no column c_r[1]", 1, {"r", "c_r[1]"}},
        {VTP_HEAD, "--columns x=p: positions in a VTK file are its points", 0, {"x", "p"}},
        {VTP_HEAD, "there is no array size on the points", 0, {"r", "size"}},
    };
    for (size_t k = 0; k < sizeof bad / sizeof *bad; ++k)
        expect_refusal(bad[k].text, strlen(bad[k].text), &(struct read_options){.name = &bad[k].name, .names = 1},
                       bad[k].line, bad[k].reason);
    const char cgs[] = "ITEM: UNITS\ncgs\nITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: ATOMS x y z r\n0 0 0 1\n";
    const struct column_name in_mm[] = {{"x", "x [mm]"}, {"y", "y [mm]"}, {"z", "z [mm]"}, {"r", "r [mm]"}};
    expect_refusal(cgs, sizeof cgs - 1, &(struct read_options){.name = in_mm, .names = 4}, 7,
                   "--columns says that lengths are in [mm], but the units of the file are cgs");
}

/* Rows by the values of columns, before anything else of a row is read. */
TEST(rows_are_chosen_by_values) {
    const struct row_rule rule[] = {{"mat", "steel", false}, {"phase", "2", false}, {"id", "4", true}};
    const char text[] =
        "id,mat,phase,x,y,z,r\n1,steel,2.0,1,0,0,1\n1,glass,2,2,0,0,1\nnone,steel,1,?,0,0,-1\n4,steel,2,3,0,0,1\n"
        "5,\"steel\",02,5,0,0,1\n";
    struct read_options options = {.rule = rule, .rules = 3};
    ck_assert_msg(try_options(text, sizeof text - 1, &options) == 0, "%s", said);
    ck_assert(bed.n == 2 && bed.id[0] == 1 && bed.id[1] == 5 && bed.x[0] == 1 && bed.x[1] == 5);
    const struct row_rule none = {"mat", "stone", false}, unknown = {"matter", "steel", true};
    options = (struct read_options){.rule = &none, .rules = 1};
    expect_refusal(text, sizeof text - 1, &options, 0, "--only and --skip leave no spheres of the file");
    options.rule = &unknown;
    expect_refusal(text, sizeof text - 1, &options, 1, "the header names no column matter");
    const struct row_rule of_points[] = {{"phase", "1", true}, {"T", "3e2", false}};
    const char vtk[] =
        VTK_HEAD "POINT_DATA 2\nFIELD f 3\nr 1 2 double\n.5 1\nphase 1 2 int\n1 2\nT 1 2 double\n300 300\n";
    options = (struct read_options){.rule = of_points, .rules = 2};
    ck_assert_msg(try_options(vtk, sizeof vtk - 1, &options) == 0, "%s", said);
    ck_assert(bed.n == 1 && bed.r[0] == 1 && bed.x[0] == 4);
}

/* The header's unit of a column may be any of the right kind. Values become those of the expected unit. */
TEST(units_of_columns_are_converted) {
    static const struct {
        const char *column, *expected;
        double value; /* of 7; NaN: refused */
    } cases[] = {
        {"k [W/(m K)]", "W/(m K)", 7},
        {"k (W/(m K))", "W/(m K)", 7},
        {"k [W/mK]", "W/(m K)", 7},
        {"k [W/m/K]", "W/(m K)", 7},
        {"k [W m^-1 K^-1]", "W/(m K)", 7},
        {"k [W\302\267m\342\201\273\302\271\302\267K\342\201\273\302\271]", "W/(m K)", 7},
        {"k [mW/(mm K)]", "W/(m K)", 7},
        {"k [W/(cm K)]", "W/(m K)", 700},
        {"k [W/m\302\260C]", "W/(m K)", 7},
        {"c [J/(kg K)]", "J/(kg K)", 7},
        {"c [kJ/kgK]", "J/(kg K)", 7000},
        {"c [J/g/K]", "J/(kg K)", 7000},
        {"rho [kg/m3]", "kg/m3", 7},
        {"rho [kg/m\302\263]", "kg/m3", 7},
        {"rho [kg m-3]", "kg/m3", 7},
        {"rho [g/cm^3]", "kg/m3", 7000},
        {"rho [kg/L]", "kg/m3", 7000},
        {"P [W]", "W", 7},
        {"P [kW]", "W", 7000},
        {"P [MW]", "W", 7e6},
        {"P [mW]", "W", 7e-3},
        {"P [J/s]", "W", 7},
        {"t [min]", "s", 420},
        {"T [K]", "K", 7},
        {"e [-]", NULL, 7},
        {"e [1]", NULL, 7},
        {"R [mm]", UNIT_OF_LENGTH, 7},
        {"k [W/(m2 K)]", "W/(m K)", NAN},
        {"k [W]", "W/(m K)", NAN},
        {"c [J/kg]", "J/(kg K)", NAN},
        {"P [hp]", "W", NAN},
        {"P [K]", "W", NAN},
        {"T [mK]", "K", NAN},
        {"T [C]", "K", NAN},
        {"T [K]", "C", NAN},
        {"e [W]", NULL, NAN},
        {"R [m]", UNIT_OF_LENGTH, 7000},
        {"P [((((((W))))))]", "W", NAN},
        {"P [W)]", "W", NAN},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        char name[4] = "";
        sscanf(cases[k].column, "%3[^ ]", name);
        const char *const wanted = name;
        const struct read_options options = {.extra = &wanted, .unit = &cases[k].expected, .extras = 1};
        const char *text = formatted("x [mm],y [mm],z [mm],r [mm],%s\n0,0,0,1,7\n", cases[k].column);
        if (isnan(cases[k].value)) {
            expect_refusal(text, strlen(text), &options, 1,
                           strcmp(cases[k].column, "P [W)]") == 0 ? "no column P" : "but is taken as");
            continue;
        }
        ck_assert_msg(try_options(text, strlen(text), &options) == 0, "%s: %s", cases[k].column, said);
        ck_assert_msg(fabs(bed.extra[0] - cases[k].value) <= 1e-15 * cases[k].value, "%s: %.17g", cases[k].column,
                      bed.extra[0]);
        const struct read_options any = {.extra = &wanted, .extras = 1, .any_unit = true};
        ck_assert_int_eq(try_options(text, strlen(text), &any), 0);
        ck_assert_double_eq(bed.extra[0], 7);
    }
    const char *const indexed = "f_T[0]", *const kelvins = "K"; /* an index is no unit */
    const struct read_options of_index = {.extra = &indexed, .unit = &kelvins, .extras = 1};
    static const char *const texts[] = {"x,y,z,r,f_T[0],f_T[1]\n0,0,0,1,7,8\n",
                                        VTP(ARRAY("radius", "1 1") ARRAY("f_T[0]", "7 7") ARRAY("f_T[1]", "8 8"))};
    for (int t = 0; t < 2; ++t) {
        ck_assert_msg(try_options(texts[t], strlen(texts[t]), &of_index) == 0, "%s", said);
        ck_assert_double_eq(bed.extra[0], 7);
    }
    const char *const k = "k", *const conductivity = "W/(m K)"; /* blanks between columns and within a unit */
    const char blanks[] = "x y z r k [W/(m K)]\n0 0 0 1 7\n";
    ck_assert_int_eq(
        try_options(blanks, sizeof blanks - 1, &(struct read_options){.extra = &k, .unit = &conductivity, .extras = 1}),
        0);
    ck_assert_double_eq(bed.extra[0], 7);
}

TEST(beds_may_be_read_without_radii) {
    const char *const names[] = {"type"};
    const struct read_options options = {.no_radius = true, .extra = names, .extras = 1};
    const char text[] = "x,y,z,type\n1,2,3,7\n";
    ck_assert_int_eq(try_options(text, sizeof text - 1, &options), 0);
    ck_assert(isnan(bed.r[0]) && bed.extra[0] == 7);
    const char atomic[] = "c\n\n1 atoms\n0 2 xlo xhi\n0 2 ylo yhi\n0 2 zlo zhi\n\nAtoms\n\n5 7 1 0 0 0 0 0\n";
    ck_assert_int_eq(try_options(atomic, sizeof atomic - 1, &options), 0);
    ck_assert(isnan(bed.r[0]) && bed.extra[0] == 7 && bed.id[0] == 5);
    const char plain[] = "1\nAtoms. Timestep: 70\n7 1 2 3\n";
    ck_assert_int_eq(try_options(plain, sizeof plain - 1, &options), 0);
    ck_assert(isnan(bed.r[0]) && bed.extra[0] == 7 && bed.timestep == 70);
}

/* Numbers have the bits that strtod gives, however they are written. */
TEST(numbers_have_the_bits_of_strtod) {
    static const char *const odd[] = {"0",
                                      "-0",
                                      "+7.",
                                      ".5",
                                      "1e22",
                                      "1e23",
                                      "1e-22",
                                      "1e-23",
                                      "0x1p3",
                                      "0x1D",
                                      "1E+5",
                                      "1e05",
                                      "9007199254740993",
                                      "9007199254740992e22",
                                      "4.9e-324",
                                      "1.7976931348623157e308",
                                      "0.1000000000000000055511151231257827"};
    static const char *const of_fortran[][2] = {
        {"0.5250D-01", "0.5250e-01"},
        {"-1.d+5", "-1e5"},
        {"7D0", "7"},
        {"4.9D-324", "4.9e-324"},
        {"0.1000000000000000055511151231257827D+200", "0.1000000000000000055511151231257827e200"}};
    static const char *const none[] = {"D5", "1D",  "1D+",   "1D5D5", "infD5", "",    "-",    ".",  "e5",
                                       "1e", "1e+", "1.2.3", "1,5",   "1 ",    "--1", "1e5x", "+-1"};
    char text[80];
    double value;
    uint64_t state = 12345;
    for (int k = 0; k < 200000; ++k) {
        state = state * 6364136223846793005U + 1442695040888963407U;
        const double size = ldexp((double)(state >> 11), (int)(state % 120) - 110);
        const char *const format[] = {"%.*g", "%.*e", "%.*f", "-%.*g"};
        snprintf(text, sizeof text, format[k % 4], (int)(state >> 20) % 20, size);
        ck_assert_msg(number_read(text, &value) && value == strtod(text, NULL), "%s", text);
    }
    for (size_t k = 0; k < sizeof odd / sizeof *odd; ++k) {
        const double wanted = strtod(odd[k], NULL);
        ck_assert_msg(number_read(odd[k], &value) && memcmp(&value, &wanted, sizeof value) == 0, "%s", odd[k]);
    }
    for (size_t k = 0; k < sizeof of_fortran / sizeof *of_fortran; ++k)
        ck_assert_msg(number_read(of_fortran[k][0], &value) && value == strtod(of_fortran[k][1], NULL), "%s",
                      of_fortran[k][0]);
    int64_t whole;
    ck_assert(number_read_whole("0.7000D+01", &whole) && whole == 7 && !number_read_whole("0.75D+01", &whole));
    for (size_t k = 0; k < sizeof none / sizeof *none; ++k) ck_assert_msg(!number_read(none[k], &value), "%s", none[k]);
}

#define FRAME(bounds, columns)                                                                                         \
    "ITEM: TIMESTEP\n7\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS" bounds "\n-1 3\n0 10\n0 2e1\nITEM: ATOMS " columns \
    "\n"

TEST(dump_columns_go_by_name) {
    ck_assert_int_eq(try(FRAME(" pp ff mm ", "id type z y x radius ") "9 1 3 2 1 .5 \n4 1 6 5 4 1 \n"), 0);
    ck_assert_uint_eq(bed.n, 2);
    expect_sphere(0, 4, 5, 6, 1, 11); /* by id */
    expect_sphere(1, 1, 2, 3, 0.5, 10);
    ck_assert(bed.period[0] == 4 && bed.period[1] == 0 && bed.period[2] == 0);
    ck_assert(bed.low[0] == -1 && bed.high[2] == 20);
}

TEST(dumps_may_be_scaled_unwrapped_or_have_diameters) {
    ck_assert_int_eq(try(FRAME("", "xs ys zs diameter") "0.25 0.5 1 3\n0 0 0 1\n"), 0);
    expect_sphere(0, 0, 5, 20, 1.5, 10);
    expect_sphere(1, -1, 0, 0, 0.5, 11);
    ck_assert_int_eq(try(FRAME(" pp pp pp", "xu yu zsu radius") "105 -7 0.5 1\n0 0 0 1\n"), 0);
    expect_sphere(0, 105, -7, 10, 1, 10);
    ck_assert(bed.period[0] == 4 && bed.period[1] == 10 && bed.period[2] == 20);
    ck_assert_int_eq(try(FRAME(" pp pp pp", "xs x y z radius") "0.5 1 2 3 1\n0 0 0 0 1\n"), 0);
    expect_sphere(0, 1, 2, 3, 1, 10);
}

#define TWO_FRAMES                                                                                                     \
    FRAME(" pp pp pp", "x y z radius")                                                                                 \
    "0 0 0 1\n3 0 0 1\n"                                                                                               \
    "ITEM: UNITS\nlj\nITEM: TIME\n0.5\nITEM: TIMESTEP\n8\nITEM: NUMBER OF ATOMS\n1\nITEM: ATOMS r z y x\n4 3 2 1\n"

TEST(frames_of_dumps_are_found) {
    struct read_options options = {0};
    for (int k = 0; k < 2; ++k) {
        ck_assert_int_eq(try_options(TWO_FRAMES, strlen(TWO_FRAMES), &options), 0);
        ck_assert_uint_eq(bed.n, 1);
        expect_sphere(0, 1, 2, 3, 4, 21);
        ck_assert(bed.period[0] == 0); /* the second frame has no box */
        ck_assert(bed.frame == 1 && bed.timestep == 8);
        ck_assert_str_eq(bed.units, "lj");
        options.frames = (struct frames){1, 2, 1};
    }
    options.frames = (struct frames){0, 1, 1};
    ck_assert_int_eq(try_options(TWO_FRAMES "ITEM: TIMESTEP\n", strlen(TWO_FRAMES) + 15, &options), 0);
    ck_assert_uint_eq(bed.n, 2);
    expect_sphere(1, 3, 0, 0, 1, 11);
    ck_assert(bed.frame == 0 && bed.timestep == 7);
    options.frames = (struct frames){2, 3, 1};
    expect_refusal(TWO_FRAMES, strlen(TWO_FRAMES), &options, 0, "there is no frame 2; the last is 1");
    const char csv[] = "x,y,z,r\n0,0,0,1\n";
    expect_refusal(csv, sizeof csv - 1, &options, 0, "there is no frame 2");
}

/* Goes through the frames of the file that are wanted. Returns their numbers as digits. */
static const char *frames_of(const char *text, size_t size, struct frames frames, int *status) {
    static char seen[40];
    size_t beds = 0;
    bool more;
    struct reader *reader;
    const struct read_options options = {.frames = frames};
    write_file(text, size);
    begin_catching();
    *status = reader_open(&reader, path, &options);
    while (!*status && !(*status = reader_next(reader, &bed, &more)) && more && beds < sizeof seen - 1)
        seen[beds++] = (char)('0' + bed.frame);
    reader_close(reader);
    end_catching();
    seen[beds] = 0;
    return seen;
}

#define SMALL_FRAME "ITEM: TIMESTEP\n7\nITEM: NUMBER OF ATOMS\n2\nITEM: ATOMS x y z r\n0 0 0 1\n3 0 0 1\n"
#define EMPTY_FRAME "ITEM: TIMESTEP\n7\nITEM: NUMBER OF ATOMS\n0\nITEM: ATOMS x y z r\n"
#define FIVE_FRAMES SMALL_FRAME SMALL_FRAME SMALL_FRAME SMALL_FRAME SMALL_FRAME
#define XYZ_FRAME   "2\nProperties=species:S:1:pos:R:3:radius:R:1\nA 0 0 0 1\nA 3 0 0 1\n"
#define DATA_ROW    " 0 0 0 1 0 0 0 0 0 0 0\n"
#define DATA_FRAME  "2 0.5 0 0 0 1 1 1\n0 0 0" DATA_ROW "3 0 0" DATA_ROW

LOOP_TEST(ranges_of_frames_are_read, 22) {
    static const struct {
        const char *text;
        struct frames frames;
        const char *seen, *said;
        int status;
    } cases[] = {
        {FIVE_FRAMES, {0, 5, 1}, "01234", "", 0},
        {FIVE_FRAMES, {1, 99, 2}, "13", "", 0},
        {FIVE_FRAMES, {0, 0, 0}, "4", "", 0},
        {FIVE_FRAMES "\n \n", {0, 0, 0}, "4", "", 0},
        {FIVE_FRAMES, {7, 9, 1}, "", "there is no frame 7; the last is 4", STATUS_INPUT},
        {FIVE_FRAMES "ITEM: TIMESTEP\n", {0, 9, 1}, "01234", "warning: frame 5 is left out: the file ends within", 0},
        {FIVE_FRAMES "ITEM: TIMESTEP\n", {0, 0, 0}, "", "ends within a frame; the last whole frame is 4", STATUS_INPUT},
        {FIVE_FRAMES "ITEM: TIMESTEP\n", {5, 6, 1}, "", "ends within a frame; the last whole frame is 4", STATUS_INPUT},
        {SMALL_FRAME "ITEM: TIMESTEP\n7\nITEM: NUMBER OF ATOMS\n1\nITEM: ATOMS x y z r\n0 0 0 1.2",
         {0, 2, 1},
         "0",
         "warning: frame 1 is left out: the file ends within a line",
         0},
        {SMALL_FRAME EMPTY_FRAME SMALL_FRAME, {0, 9, 1}, "02", "warning: frame 1 is empty and is left out", 0},
        {SMALL_FRAME EMPTY_FRAME, {0, 0, 0}, "", "there are no spheres", STATUS_INPUT},
        {EMPTY_FRAME EMPTY_FRAME, {0, 9, 1}, "", "there are no spheres", STATUS_INPUT},
        {XYZ_FRAME XYZ_FRAME "\n" XYZ_FRAME, {0, 9, 1}, "012", "", 0},
        {XYZ_FRAME XYZ_FRAME "2\n", {0, 9, 1}, "01", "warning: frame 2 is left out: the frame ends after 0", 0},
        {XYZ_FRAME XYZ_FRAME "2\n\nA 0 0 0 1\n", {2, 3, 1}, "", "after 1 spheres; 2 were declared", STATUS_INPUT},
        {DATA_FRAME DATA_FRAME, {0, 9, 1}, "01", "does not say which axes are periodic", 0},
        {DATA_FRAME "2 0 0 0 0 1 1 1\n0 0 0 1", {0, 9, 1}, "0", "after 1 spheres", 0},
        {"0 0 0 0 0 1 1 1\n0 0.1 0 0 0 0 0 0\n" DATA_FRAME,
         {0, 9, 1},
         "2",
         "warning: frame 1 is empty and is left out",
         0},
        {"0 0 0 0 0 1 1 1\n" DATA_FRAME, {0, 0, 0}, "1", "does not say which axes are periodic", 0},
        {"0\n\n" XYZ_FRAME, {0, 9, 1}, "1", "warning: frame 0 is empty and is left out", 0},
        {"x,y,z,r\n0,0,0,1\n", {0, 9, 1}, "0", "", 0},
        {"x,y,z,r\n0,0,0,1\n", {1, 9, 1}, "", "there is no frame 1; the last is 0", STATUS_INPUT},
    };
    int status;
    const char *seen = frames_of(cases[_i].text, strlen(cases[_i].text), cases[_i].frames, &status);
    ck_assert_msg(status == cases[_i].status, "status %d: %s", status, said);
    ck_assert_str_eq(seen, cases[_i].seen);
    ck_assert_msg(strstr(said, cases[_i].said) && (*said != 0) == (*cases[_i].said != 0), "%s", said);
}

/* Packs a text as gzip does. */
static size_t pack(const char *text, size_t size, char *to, size_t room) {
    z_stream stream = {.next_in = (unsigned char *)(uintptr_t)text, .avail_in = (unsigned)size};
    stream.next_out = (unsigned char *)to, stream.avail_out = (unsigned)room;
    ck_assert_int_eq(deflateInit2(&stream, 6, Z_DEFLATED, 31, 8, Z_DEFAULT_STRATEGY), Z_OK);
    ck_assert_int_eq(deflate(&stream, Z_FINISH), Z_STREAM_END);
    const size_t packed = stream.total_out;
    deflateEnd(&stream);
    return packed;
}

TEST(packed_files_are_read) {
    char text[20000], packed[20000];
    size_t size = 0;
    int status;
    for (int k = 0; k < 40; ++k)
        size += (size_t)snprintf(text + size, sizeof text - size,
                                 "ITEM: TIMESTEP\n%d\nITEM: NUMBER OF ATOMS\n1\nITEM: ATOMS x y z r\n%d %d 1 %d\n", k,
                                 k * 7919 % 104729, k * k * 7907 % 104729, k + 1);
    const size_t bytes = pack(text, size, packed, sizeof packed);
    ck_assert_str_eq(frames_of(packed, bytes, (struct frames){37, 40, 1}, &status), "UVW");
    ck_assert_int_eq(status, 0);
    /* cut off */
    assert_has("0123456789:;<=>?@ABCDEFGHIJKLMNOPQRSTUVW",
               frames_of(packed, bytes / 2, (struct frames){0, 40, 1}, &status));
    ck_assert_int_eq(status, 0);
    ck_assert_msg(strstr(said, "warning: frame ") && strstr(said, "the gzip file is cut off"), "%s", said);
    frames_of(packed, bytes / 2, (struct frames){0, 0, 0}, &status);
    ck_assert_int_eq(status, STATUS_INPUT);
    assert_has(said, "the gzip file is cut off; the last whole frame is ");
    /* damaged */
    packed[bytes / 2] = (char)(packed[bytes / 2] ^ 0x55);
    packed[bytes / 2 + 1] = (char)~packed[bytes / 2 + 1];
    expect_refusal(packed, bytes, &(struct read_options){0}, 0, "the gzip file is damaged");
    /* tables have one frame */
    const char table[] = "x,y,z,r\n0,0,0,1\n5,0,0,1\n";
    const size_t short_bytes = pack(table, sizeof table - 1, packed, sizeof packed);
    ck_assert_int_eq(try_options(packed, short_bytes, &(struct read_options){0}), 0);
    ck_assert_uint_eq(bed.n, 2);
    ck_assert_int_eq(try_options(packed, short_bytes - 9, &(struct read_options){0}), STATUS_INPUT);
    assert_has(said, "the gzip file is cut off");
}

TEST(dumps_need_no_tilt) {
    const char text[] =
        "ITEM: UNITS\ncgs \nITEM: TIME\n0.5\nITEM: TIMESTEP\n 7 \nITEM: NUMBER OF ATOMS\n1 \nITEM: BOX BOUNDS xy xz "
        "yz pp ff pp\n-1 3 0\n0 10 0\n0 20 0.0\nITEM: ATOMS xs y z radius\n0.25 0 0 1\n";
    ck_assert_int_eq(try(text), 0);
    expect_sphere(0, 0, 0, 0, 1, 14);
    ck_assert(bed.period[0] == 4 && bed.period[1] == 0 && bed.period[2] == 20);
    ck_assert_str_eq(bed.units, "cgs");
    ck_assert_int_eq(bed.timestep, 7);
}

#define HEAD_OF_ONE "ITEM: TIMESTEP\n7\nITEM: NUMBER OF ATOMS\n1\n"
#define DATA_HEAD                                                                                                      \
    "LAMMPS data file via write_data, version 2 Aug 2023, timestep = 30, units = si\n\n2 atoms\n2 atom types\n\n"      \
    "-1 3 xlo xhi\n0 10 ylo yhi\n0 2e1 zlo zhi\n"

/* Boxes that may have any direction, but have right angles. */
TEST(boxes_with_right_angles_are_read) {
    static const struct {
        const char *text;
        double period;
    } cases[] = {
        {HEAD_OF_ONE
         "ITEM: BOX BOUNDS abc origin pp ff pp\n4 0 1e-16 -1\n0 10 0 0\n0 0 20 0\nITEM: ATOMS x y z r\n1 2 3 1\n",
         4},
        {HEAD_OF_ONE "ITEM: BOX BOUNDS abc origin\n4 0 0 -1\n0 10 0 0\n0 0 20 0\nITEM: ATOMS x y z r\n1 2 3 1\n", 0},
        {HEAD_OF_ONE "ITEM: BOX BOUNDS xy xz yz xx yy zz\n-1 3 0\n0 10 0\n0 20 0\nITEM: ATOMS x y z r\n1 2 3 1\n", 0},
        {HEAD_OF_ONE "ITEM: BOX BOUNDS xx yy zz\n-1 3\n0 10\n0 20\nITEM: ATOMS x y z r\n1 2 3 1\n", 0},
        {HEAD_OF_ONE "ITEM: BOX BOUNDS xy xz yz pp ff pp\n-1 3 -0\n0 10 1e-17\n0 20 0\nITEM: ATOMS x y z r\n1 2 3 1\n",
         4},
        {"c\n1 atoms\n4 0 0 avec\n0 10 0 bvec\n0 0 20 cvec\n-1 0 0 abc origin\n\nAtoms # sphere\n\n1 1 2 1 1 2 3\n", 0},
        {"1\nProperties=pos:R:3:r:R:1 Lattice=\"4 0 0 1e-16 10 0 0 0 20\" Origin=\"-1 0 0\"\n1 2 3 1\n", 4},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        ck_assert_msg(try(cases[k].text) == 0, "%zu: %s", k, said);
        ck_assert(bed.low[0] == -1 && bed.high[0] == 3 && bed.low[1] == 0 && bed.high[1] == 10 && bed.high[2] == 20);
        ck_assert_msg(bed.period[0] == cases[k].period && bed.x[0] == 1, "%zu", k);
        if (strstr(cases[k].text, "xx yy zz")) assert_has(said, "does not say which axes are periodic");
    }
}

TEST(data_files_of_lammps_are_read) {
    static const char *const good[] = {
        DATA_HEAD
        "0 0 0 xy xz yz\n\nMasses\n\n1 1\n2 1\n\nAtoms # sphere\n\n9 1 1 2500 1 2 3 0 0 0\n4 2 2 2500 4 5 6 1 0 -1\n\n"
        "Velocities\n\n9 0 0 0 0 0 0\n4 0 0 0 0 0 0\n",
        DATA_HEAD "\nAtoms # hybrid sphere\n\n9 1 1 2 3 1 2500 0.5\n4 2 4 5 6 2 2500 0.5\n",
        "LAMMPS data file via write_data, version Version LIGGGHTS-PUBLIC 3.8.0, timestep = 30\n\n2 atoms\n-1 3 xlo "
        "xhi\n"
        "0 10 ylo yhi\n0 20 zlo zhi\nAtoms\n\n9 1 1 2500 1 2 3\n4 2 2 2500 4 5 6\n",
    };
    for (size_t k = 0; k < 3; ++k) {
        ck_assert_msg(try(good[k]) == 0, "%s", said);
        ck_assert_uint_eq(bed.n, 2);
        ck_assert(bed.id[0] == 4 && bed.x[0] == 4 && bed.y[0] == 5 && bed.z[0] == 6 && bed.r[0] == 1);
        ck_assert(bed.id[1] == 9 && bed.x[1] == 1 && bed.y[1] == 2 && bed.z[1] == 3 && bed.r[1] == 0.5);
        ck_assert(bed.low[0] == -1 && bed.high[2] == 20 && bed.period[0] == 0);
        ck_assert_int_eq(bed.timestep, 30);
        ck_assert_str_eq(bed.units, k < 2 ? "si" : "");
        assert_has(said, "warning: the file does not say which axes are periodic");
    }
}

/* The columns of the first rows say which style a file without one has. */
TEST(data_files_need_no_style) {
#define NO_STYLE(atoms) "LIGGGHTS data file\n\n" atoms " atoms\n0 1 xlo xhi\n0 1 ylo yhi\n0 1 zlo zhi\n\nAtoms\n\n"
    static const struct {
        const char *text, *columns;
    } cases[] = {
        {NO_STYLE("2") "1 1 0.2 1000 0.3 0.4 0.5\n2 1 0.2 1000 0.6 0.3 0.3 # last\n\nVelocities\n\n1 0 0 0 0 0 0\n",
         "id type diameter density x y z"},
        {NO_STYLE("2") "1 1 0.2 1000 0.3 0.4 0.5 0 0 -1\n2 1 0.2 1000 0.6 0.3 0.3 0 1 0\n",
         "id type diameter density x y z"},
        {NO_STYLE("2") "1 1 0.3 0.4 0.5 0.2 1000\n2 1 0.6 0.3 0.3 0.2 1000\n", "id type x y z diameter density"},
        {"c\n2 atoms\nAtoms\n1 1 0.2 1000 0.3 0.4 0.5\n2 1 0.2 1000 0.6 0.3 0.3\n", "id type diameter density x y z"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        ck_assert_msg(try(cases[k].text) == 0, "%zu: %s", k, said);
        assert_has(said,
                   formatted("the style of the atoms is not said; their columns are taken as %s", cases[k].columns));
        ck_assert(bed.n == 2 && bed.x[0] == .3 && bed.y[0] == .4 && bed.z[0] == .5 && bed.r[1] == .1 && bed.x[1] == .6);
    }
    static const struct {
        unsigned line;
        const char *text;
    } unknown[] = {
        {11, NO_STYLE("2") "1 1 0.2 1000 0.3 0.3 0.3\n2 1 0.2 -1 0.6 0.3 0.3\n"}, /* no density */
        {10, NO_STYLE("1") "1 1 7 0 0.3 0.3 0.3\n"},                              /* full: molecule, type, charge */
        {10, NO_STYLE("1") "1 1 0.2 1000 0.3 0.3 1.3\n"},                         /* beyond the box */
        {10, NO_STYLE("1") "1 1 0.5 0.3 0.3 0.3\n"},
    };
    for (size_t k = 0; k < sizeof unknown / sizeof *unknown; ++k)
        expect_refusal(unknown[k].text, strlen(unknown[k].text), &(struct read_options){0}, unknown[k].line,
                       "the style of the atoms is not said, and these columns do not tell it");
}

TEST(comments_may_begin_as_in_matlab) {
    ck_assert_msg(try("% x y z r\n0 0 0 1\n%2 0 0 1\n2.5 0 0 1\n") == 0, "%s", said);
    ck_assert(bed.n == 2 && bed.x[1] == 2.5);
    ck_assert_msg(try("% made by hand\nx,y,z,r\n0,0,0,1\n") == 0, "%s", said);
    for (int k = 0; k < 2; ++k) {
        const char *mark = k ? "% " : "%", *frame = formatted("%sITEM: TIMESTEP\n7\n%sITEM: NUMBER OF ATOMS\n1\n"
                                                              "%sITEM: BOX BOUNDS pp ff ff\n0 4\n0 4\n0 4\n"
                                                              "%sITEM: ATOMS x y z radius\n1 2 3 1\n",
                                                              mark, mark, mark, mark);
        ck_assert_msg(try(formatted("%s%s", frame, frame)) == 0, "%s", said);
        ck_assert(bed.n == 1 && bed.timestep == 7 && bed.period[0] == 4 && bed.frame == 1);
    }
    const char *cut = "%ITEM: TIMESTEP\n0\n%ITEM: NUMBER OF ATOMS\n2\n%ITEM: ATOMS x y z r\n0 0 0 1\n%ITEM: TIMESTEP\n";
    expect_refusal(cut, strlen(cut), &(struct read_options){0}, 7, "the frame ends after 1 atoms");
}

TEST(xyz_files_are_read) {
    ck_assert_int_eq(
        try("2\nLattice=\"4 0 0 0 5 0 0 0 6\" Origin=\"-1 0 1\" Properties=species:S:1:id:I:1:pos:R:3:velo:R:3:"
            "Radius:R:1 pbc=\"T F 1\"\nA 9 1 2 3 0 0 0 0.5\nB 4 4 5 6 0 0 0 1\n"),
        0);
    ck_assert(bed.n == 2 && bed.id[0] == 4);
    expect_sphere(0, 4, 5, 6, 1, 4);
    expect_sphere(1, 1, 2, 3, 0.5, 3);
    ck_assert(bed.low[0] == -1 && bed.high[0] == 3 && bed.low[2] == 1 && bed.high[2] == 7);
    ck_assert(bed.period[0] == 4 && bed.period[1] == 0 && bed.period[2] == 6);
    ck_assert_int_eq(try("1\nProperties=pos:R:3:r:R:1 Lattice=\"4 0 0 0 5 0 0 0 6\"\n1 2 3 1"), 0);
    ck_assert(bed.period[0] == 4 && bed.period[1] == 5 && bed.period[2] == 6);
}

TEST(mercury_files_are_read) {
    ck_assert_int_eq(try("2 0.5 0 0 -1 4 5 6 \n1 2 3 0 0 0 0.5 0 0 0 0 0 0 0\n4 5 6 0 0 0 1 0 0 0 0 0 0 1\n"), 0);
    ck_assert_uint_eq(bed.n, 2);
    expect_sphere(1, 4, 5, 6, 1, 3);
    ck_assert(!bed.ids && bed.low[2] == -1 && bed.high[0] == 4 && bed.period[0] == 0);
}

TEST(vtk_files_are_read) {
    static const char *const good[] = {
        VTK_HEAD "VERTICES 2 4\n1 0 1 1\nPOINT_DATA 2\nVECTORS v float\n0 0 0 0 0 0\nSCALARS radius double 1\n"
                 "LOOKUP_TABLE default\n0.5 1\nSCALARS id int\nLOOKUP_TABLE default\n4 9\n",
        VTK_HEAD
        "METADATA\nINFORMATION 0\n\nCELL_DATA 2\nSCALARS radius double\nLOOKUP_TABLE default\n7 7\nPOINT_DATA 2\n"
        "FIELD FieldData 2\nid 1 2 int\n4 9\nMETADATA\nINFORMATION 0\n\nDiameter 1 2 double\n1 2\n",
        VTP(ARRAY("Radius", " 0.5 1 ") ARRAY("id", "4 9")),
        VTP(ARRAY("id", "4 9") "<DataArray type='Float32' Name='Radii' format='binary'>CAAAAAAAAD8AAIA/</DataArray>"),
        VTP(ARRAY("id",
                  "4 9") "<DataArray type='Float32' Name='radii' format='binary'>CAAAAA==AAAAPwAAgD8=</DataArray>"),
    };
    for (size_t k = 0; k < sizeof good / sizeof *good; ++k) {
        ck_assert_msg(try(good[k]) == 0, "%zu: %s", k, said);
        ck_assert(bed.n == 2 && bed.id[0] == 4 && bed.id[1] == 9);
        expect_sphere(0, 1, 2, 3, 0.5, 0);
        expect_sphere(1, 4, 5, 6, 1, 0);
    }
}

/* The arrays are on several pieces, in one file or in several. Pieces may be empty. */
TEST(vtk_pieces_are_joined) {
#define PIECE(points, radii, ids)                                                                                      \
    "<Piece NumberOfPoints='" points "'><PointData>" ARRAY("radius", radii)                                            \
        ARRAY("ID", ids) "</PointData><Points>"                                                                        \
                         "<DataArray type='Float64' NumberOfComponents='3' format='ascii'>"
#define END_OF_PIECE "</DataArray></Points></Piece>"
#define THREE                                                                                                          \
    PIECE("0", "", "")                                                                                                 \
    END_OF_PIECE PIECE("2", "1 .5", "9 2") "1 2 3 4 5 6" END_OF_PIECE PIECE("1", ".25", "4") "7 8 9" END_OF_PIECE
    const char *const whole =
        "<VTKFile type='UnstructuredGrid'><UnstructuredGrid>" THREE "</UnstructuredGrid></VTKFile>";
    for (int k = 0; k < 2; ++k) {
        static const char *const parts[] = {PIECE("0", "", "") END_OF_PIECE,
                                            PIECE("2", "1 .5", "9 2") "1 2 3 4 5 6" END_OF_PIECE,
                                            PIECE("1", ".25", "4") "7 8 9" END_OF_PIECE};
        const char *text = whole, *name = strrchr(path, '/') + 1;
        char piece[3][220];
        for (int p = 0; k == 1 && p < 3; ++p) {
            snprintf(piece[p], sizeof piece[p], "%s_%d.vtp", path, p);
            OWNED_FILE *file = opened(piece[p], "w");
            fprintf(file, "<VTKFile type='PolyData'><PolyData>%s</PolyData></VTKFile>", parts[p]);
        }
        if (k == 1)
            text = formatted("<?xml version='1.0'?><VTKFile type='PPolyData'><PPolyData><PPointData>"
                             "<PDataArray type='Float64' Name='radius'/></PPointData><Piece Source=\"%s_0.vtp\"/>"
                             "<Piece Source=\"./%s_1.vtp\"/><Piece Source=\"%s_2.vtp\"/></PPolyData></VTKFile>",
                             name, name, name);
        ck_assert_msg(try(text) == 0, "%d: %s", k, said);
        for (int p = 0; k == 1 && p < 3; ++p) unlink(piece[p]);
        ck_assert(bed.n == 3 && bed.id[0] == 2 && bed.id[1] == 4 && bed.id[2] == 9);
        expect_sphere(0, 4, 5, 6, .5, 0);
        expect_sphere(1, 7, 8, 9, .25, 0);
        expect_sphere(2, 1, 2, 3, 1, 0);
    }
    const char *itself = formatted("<VTKFile type='PPolyData'><Piece Source='%s'/></VTKFile>", strrchr(path, '/') + 1);
    expect_refusal(itself, strlen(itself), &(struct read_options){0}, 1, "pieces of pieces have no points, but pieces");
    const char ghosts[] = VTP(ARRAY("radius", "1 .5") "<DataArray type='UInt8' Name='vtkGhostType' format='ascii'>1 "
                                                      "0</DataArray>");
    ck_assert_int_eq(try(ghosts), 0);
    ck_assert_uint_eq(bed.n, 1);
    expect_sphere(0, 4, 5, 6, .5, 0);
    const char missing[] = "<VTKFile type='PPolyData'><Piece Source='none.vtp'/></VTKFile>";
    ck_assert_int_eq(try(missing), STATUS_FILE);
    assert_has(said, "none.vtp: No such file");
    const char mixed[] = "<VTKFile type='PolyData'>" PIECE(
        "1", "1", "4") "1 2 3" END_OF_PIECE
                       "<Piece NumberOfPoints='1'><PointData>" ARRAY(
                           "radius",
                           "1") "</PointData><Points>"
                                "<DataArray type='Float64' NumberOfComponents='3' format='ascii'>7 8 9" END_OF_PIECE
                                "</VTKFile>";
    expect_refusal(mixed, sizeof mixed - 1, &(struct read_options){0}, 0, "some pieces have an array of ids");
}

/* Blocks of a .vtm file are pieces. Files of a .pvd file are frames, and those of one time are pieces. */
TEST(vtk_collections_are_read) {
    char piece[4][220];
    const char *name = strrchr(path, '/') + 1;
    for (int p = 0; p < 4; ++p) {
        snprintf(piece[p], sizeof piece[p], "%s_%d.vtp", path, p);
        OWNED_FILE *file = opened(piece[p], "w");
        if (p == 3)
            fprintf(file, "<VTKFile type='PPolyData'><Piece Source='%s_1.vtp'/></VTKFile>", name);
        else
            fprintf(file,
                    "<VTKFile type='PolyData'><PolyData>" PIECE("1", "%d", "%d") "%d 0 0" END_OF_PIECE
                                                                                 "</PolyData></VTKFile>",
                    p + 1, p, 9 * p);
    }
    const char *blocks =
        formatted("<VTKFile type=\"vtkMultiBlockDataSet\"><vtkMultiBlockDataSet><Block index='0'><DataSet index='0' "
                  "file='%s_0.vtp'/><DataSet index='1'/></Block><DataSet index='1' name='b' file='%s_3.vtp'></DataSet>"
                  "</vtkMultiBlockDataSet></VTKFile>",
                  name, name);
    ck_assert_msg(try(blocks) == 0, "%s", said);
    ck_assert(bed.n == 2 && bed.r[0] == 1 && bed.r[1] == 2 && bed.x[1] == 9);
    const char *series =
        formatted("<VTKFile type=\"Collection\">\n<Collection>\n<DataSet timestep='0' part='0' file='%s_0.vtp'/>\n"
                  "<DataSet timestep='0' part='1' file='%s_3.vtp'/>\n<DataSet timestep='.5' file='%s_2.vtp'/>\n"
                  "</Collection>\n</VTKFile>\n",
                  name, name, name);
    ck_assert_msg(try(series) == 0, "%s", said);
    ck_assert(bed.n == 1 && bed.r[0] == 3 && bed.frame == 1);
    const struct read_options first = {.frames = {0, 1, 1}}, third = {.frames = {2, 3, 1}};
    ck_assert_msg(try_options(series, strlen(series), &first) == 0, "%s", said);
    ck_assert(bed.n == 2 && bed.r[1] == 2 && bed.frame == 0);
    expect_refusal(series, strlen(series), &third, 0, "there is no frame 2; the last is 1");
    const char empty[] = "<VTKFile type='Collection'>\n<Collection/>\n</VTKFile>\n";
    expect_refusal(empty, sizeof empty - 1, &(struct read_options){0}, 0, "there is no frame in the file");
    const char joined[] = "<VTKFile type='Collection'><Collection><DataSet file='a.vtp'/><DataSet file='b.vtp'/>";
    expect_refusal(joined, sizeof joined - 1, &(struct read_options){0}, 1,
                   "each DataSet must stand on a line of its own");
    for (int p = 0; p < 4; ++p) unlink(piece[p]);
}

/* One array may be wanted twice, and a name in the same case goes before another one. */
TEST(vtk_arrays_go_by_name) {
    const char *const names[] = {"radius", "id"};
    const char text[] = VTP(ARRAY("RADIUS", "7 7") ARRAY("radius", "0.5 1") ARRAY("Radius", "8 8") ARRAY("id", "4 9"));
    const struct read_options options = {.extra = names, .extras = 2};
    ck_assert_msg(try_options(text, sizeof text - 1, &options) == 0, "%s", said);
    ck_assert(bed.r[0] == .5 && bed.r[1] == 1 && bed.extra[0] == .5 && bed.extra[1] == 4 && bed.extra[3] == 9);
    const struct column_name other[] = {{"d", "size"}, {"ID", "tag"}, {"T", "heat [C]"}};
    const char *const wanted = "T", *const unit = "K", *const celsius = "C";
    const char lethe[] =
        VTP(ARRAY("radius", "7 7") ARRAY("size", "1 2") ARRAY("id", "1 2") ARRAY("tag", "9 4") ARRAY("heat", "20 30"));
    struct read_options named = {.name = other, .names = 3, .extra = &wanted, .unit = &celsius, .extras = 1};
    ck_assert_msg(try_options(lethe, sizeof lethe - 1, &named) == 0, "%s", said);
    ck_assert(bed.id[0] == 4 && bed.r[0] == 1 && bed.extra[0] == 30 && bed.id[1] == 9 && bed.r[1] == .5);
    named.unit = &unit;
    expect_refusal(lethe, sizeof lethe - 1, &named, 0, "the column T is in [C], but is taken as [K]");
}

TEST(yade_files_are_read) {
    ck_assert_int_eq(try("#format x_y_z_r_matId\n# comment\n1\t2\t3\t0.5\t0\n4 5 6 1 0\n"), 0);
    ck_assert_uint_eq(bed.n, 2);
    expect_sphere(0, 1, 2, 3, 0.5, 3);
    expect_sphere(1, 4, 5, 6, 1, 4);
}

TEST(settled_beds_are_read_whole) {
    static const struct {
        const char *file;
        double period, radius_min, radius_max;
    } beds[] = {{"tests/data/mono2000.dump", 0, 0.5, 0.5},
                {"tests/data/poly2000.dump", 0, 0.4, 0.6},
                {"tests/data/monoper2000.dump", 12, 0.5, 0.5}};
    for (size_t k = 0; k < 3; ++k) {
        const char *const names[] = {"v_T"};
        bed_free(&bed);
        ck_assert_int_eq(read_bed(beds[k].file, &(struct read_options){.extra = names, .extras = 1}, &bed), 0);
        ck_assert_uint_eq(bed.n, 2000);
        ck_assert(bed.period[0] == beds[k].period && bed.period[1] == beds[k].period && bed.period[2] == 0);
        for (uint32_t i = 0; i < bed.n; ++i) {
            ck_assert(bed.r[i] >= beds[k].radius_min && bed.r[i] <= beds[k].radius_max);
            ck_assert(bed.extra[i] >= 299 && bed.extra[i] <= 1001);
            ck_assert(bed.id[i] == i + 1 && bed.line[i] >= 10 && bed.line[i] < 2010);
        }
    }
}

/* There are more spheres than the arrays begin with. */
TEST(beds_larger_than_the_first_arrays_are_read) {
    enum { N = 5000 };
    char *text = malloc(64 * N), *end = text;
    ck_assert_ptr_nonnull(text);
    end += sprintf(end, "x,y,z,r,id\n");
    for (int i = 0; i < N; ++i) end += sprintf(end, "%d,%d,%d,1,%d\n", i, 2 * i, 3 * i, N - i);
    ck_assert_int_eq(try_options(text, (size_t)(end - text), &(struct read_options){0}), 0);
    free(text);
    ck_assert_uint_eq(bed.n, N);
    for (uint32_t i = 0; i < N; ++i) {
        const uint32_t k = N - 1 - i;
        expect_sphere(i, k, 2. * k, 3. * k, 1, k + 2);
        ck_assert_int_eq(bed.id[i], i + 1);
    }
}

#define HEAD   "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n"
#define BOX    "ITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\n"
#define ATOMS  "ITEM: ATOMS x y z radius\n"
#define SPHERE "0 0 0 1\n"

static const struct {
    unsigned line;
    const char *text, *reason;
} refused[] = {
    {0, "", "no spheres"},
    {0, "\n\n# nothing\n", "no spheres"},
    {0, "x,y,z,r\n", "no spheres"},
    {1, "x,y,r\n0,0,1\n", "no column z; there are x, y, r"},
    {0, "Number of particles = 3\nA = 1.0 Angstrom\n", "this is an AtomEye .cfg file"},
    {0, "i,j,F,body\n1,2,0.5,\n", "this is view factors, as fibrad factors writes them"},
    {0, "file,frame,timestep,i,j,D,body\na,0,,1,2,0.5,\n", "this is exchange factors, as fibrad factors writes them"},
    {0, "i,T_K,q_W,q_error_W,T_error_K,body\n1,300,1,,,\n", "this is powers, as fibrad heat writes them"},
    {0, "%%MatrixMarket matrix coordinate real general\n", "this is a matrix"},
    {1, "x,y,z\n0,0,1\n", "no column r"},
    {1, "0,0,0,1\n", "numbers without a header that names their columns, such as x,y,z,r"},
    {2, "# made by hand\n0,0,0,1\n", "numbers without a header"},
    {1, "x [mm],y [mm],z [mm],r [m]\n0,0,0,1\n", "lengths of more than one unit: x in [mm], r in [m]"},
    {3, "x;y;z;r\n0,5;0;0;1\n0.5;0;0;1\n", "x is '0.5': decimal commas and decimal points in one file"},
    {2, "x;y;z;r\n1.234,5;0;0;1\n", "x is not a number: '1.234,5'"},
    {1, "xs,ys,zs,r\n0,0,0,1\n", "the scaled coordinate xs needs a box"},
    {2, "x y z r X x\n0 0 0 1 0 3\n", "columns 1 and 6 are both named x, and differ: '0' and '3'"},
    {2, "#format x_y_z_r\n0 0 0 1 1\n", "5 fields"},
    {2, "1\nno properties\nA 0 0 0 1\n",
     "an XYZ file without Properties=species:S:1:pos:R:3:radius:R:1 has no radii; --radius"},
    {2, "1\nProperties=pos:R:3\n0 0 0\n", "no column r"},
    {2, "1\nProperties=pos:R:3:radius:R\n0 0 0 1\n",
     "Properties needs name:type:count for each, such as pos:R:3:radius:R:1"},
    {2, "1\nProperties=pos:R:3:r:R:1 Lattice=\"1 0 0 0 1 0 0.1 0 1\"\n0 0 0 1\n", "the lattice is tilted"},
    {2, "1\nProperties=pos:R:3:r:R:1 Lattice=\"1 0 0 0 1 0 0\"\n0 0 0 1\n",
     "Lattice has 7 numbers; it needs 9 in quotes: Lattice=\"LX 0 0 0 LY 0 0 0 LZ\""},
    {2, "1\nProperties=pos:R:3:r:R:1 Lattice=1 0 0 0 1 0 0 0 1\n0 0 0 1\n",
     "Lattice has 1 number; it needs 9 in quotes"},
    {2, "1\nProperties=pos:R:3:r:R:1 Lattice=\"1 0 0 0 1 0 0 0 1 5\"\n0 0 0 1\n", "Lattice has 10 numbers"},
    {2, "1\nProperties=pos:R:3:r:R:1 Lattice=\"1 0 0 0 1 0 0 0 b\"\n0 0 0 1\n", "Lattice: 'b' is not a number"},
    {2, "1\nProperties=pos:R:3:r:R:1 Lattice=\"1 0 0 0 1 0 0 0 1\" Origin=\"0 0\"\n0 0 0 1\n", "Origin has 2 numbers"},
    {2, "1\nProperties: pos:R:3:r:R:1\n0 0 0 1\n", "an XYZ file without Properties=species:S:1:pos:R:3:radius:R:1 has"},
    {2, "1\nProperties=pos:R:3:r:R:1 Lattice=\"1 0 0 0 0 0 0 0 1\"\n0 0 0 1\n", "the box is empty"},
    {2, "1\nProperties=pos:R:3:r:R:1 Lattice=\"1 0 0 0 1 0 0 0 1\" pbc=\"T F\"\n0 0 0 1\n", "pbc needs three"},
    {3, "1\nProperties=pos:R:3:r:R:1\n0 0 0 1 1\n", "5 fields"},
    {4, "2\nProperties=pos:R:3:r:R:1\n0 0 0 1\nx 0 0 1\n", "x is not a number"},
    {1, "1 0 0 0 1 1\n0 0 0 0 1 0 0 0\n", "MercuryDPM file in two dimensions"},
    {2, "0 0 0 0 1 1\n1 0 0 0 1 1\n0 0 0 0 1 0 0 0\n", "MercuryDPM file in two dimensions"},
    {0, "0 0 0 0 0 1 1 1\n0 1 0 0 0 1 1 1\n", "no spheres"},
    {1, "1 0 0 0 0 1 1 0\n0 0 0 0 0 0 1 0 0 0 0 0 0 0\n", "the box is empty"},
    {2, "1 0 0 0 0 1 1 1\n0 0 0 0 0 0 0 0 0 0 0 0 0 0\n", "the radius is 0"},
    {6, "c\n1 atoms\n0 1 xlo xhi\n0 1 ylo yhi\n0 1 zlo zhi\nAtoms # atomic\n\n1 1 0 0 0\n",
     "this is a LAMMPS data file of style atomic: it has no radii; --radius gives them"},
    {3, "c\n1 atoms\nAtoms\n1 1 0 0 0\n", "style atomic: it has no radii"},
    {3, "c\n1 atoms\nAtoms # hybrid\n1 1 0 0 0 1 1\n", "style hybrid without its parts"},
    {3, "c\n1 atoms\nAtoms # body\n1 1 0 0 0 1 1\n", "style body, whose columns are not known"},
    {3, "c\n1 atoms\n0.1 0 0 xy xz yz\nAtoms # sphere\n1 1 1 1 0 0 0\n", "the box is tilted"},
    {6, "c\n1 atoms\n1 0 0 avec\n0 1 .1 bvec\n0 0 1 cvec\n0 0 0 abc origin\nAtoms # sphere\n1 1 1 1 0 0 0\n",
     "triclinic"},
    {3, "c\n1 atoms\n1 1 xlo xhi\nAtoms # sphere\n1 1 1 1 0 0 0\n", "the box is empty"},
    {3, "c\n1 atoms\n0 1 xlo xhi\n", "there is no section Atoms"},
    {2, "c\nmany atoms\n1 atoms\nAtoms # sphere\n1 1 1 1 0 0 0\n", "the number of atoms is not a whole number"},
    {0, VTK_HEAD, "this VTK file has no array radius or diameter on its points; --radius gives radii"},
    {0, "# vtk DataFile Version 3.0\n\nASCII\nDATASET STRUCTURED_POINTS\n", "another kind than POLYDATA"},
    {3, "# vtk DataFile Version 3.0\n\nText\nDATASET POLYDATA\n", "ASCII or BINARY is expected"},
    {7, VTK_HEAD "POINTS 1 float\n0 0 0\n", "points are given twice"},
    {7, VTK_HEAD "SPHERES 1\n", "the keyword SPHERES is not known"},
    {0, VTK_HEAD "POINT_DATA 2\nSCALARS radius float 1\nLOOKUP_TABLE default\n1 nan\n",
     "the radius of point 1 is not finite"},
    {0, VTK_HEAD "POINT_DATA 2\nVECTORS radius float\n1 1 1 1 1 1\n", "the array radius has 3 components"},
    {9, VTK_HEAD "POINT_DATA 2\nSCALARS radius float 1\nLOOKUP_TABLE default\n1", "the file ends within an array"},
    {10, VTK_HEAD "POINT_DATA 2\nSCALARS radius float 1\nLOOKUP_TABLE default\n1 one\n", "a number is expected"},
    {9, VTK_HEAD "POINT_DATA 2\nSCALARS radius string 1\nLOOKUP_TABLE default\n1 2\n", "arrays of type string"},
    {0,
     "<VTKFile type='PolyData'><Piece NumberOfPoints='0'><PointData>" ARRAY("radius", "") "</PointData><Points>" ARRAY(
         "p", "") "</Points></Piece><Piece NumberOfPoints='2'></Piece></VTKFile>",
     "this VTK file has no points"},
    {0,
     "# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\nPOINT_DATA 0\nSCALARS r float\nPOINTS 2 float\n1 2 3 4 5 "
     "6\n",
     "no array radius"},
    {0, VTP(ARRAY("mass", "1 1")), "no array radius or diameter"},
    {0, VTP(ARRAY("radius", "1 -1")), "the radius is -1; it must be above 0"},
    {0, VTP(ARRAY("radius", "1 1") ARRAY("id", "3 3")), "the id 3 occurs twice"},
    {0, VTP(ARRAY("radius", "1 1") ARRAY("id", "3 3.5")), "the id of point 1 is 3.5"},
    {4, VTP(ARRAY("radius", "1")), "an array is too short"},
    {4, VTP("<DataArray type='Float32' Name='radius' format='binary'>CAAAAAAAAD8AAIA</DataArray>"),
     "an array is damaged"},
    {4, VTP("<DataArray type='Float32' Name='radius' format='appended' offset='0'/>"), "the array has no data"},
    {4, VTP("<DataArray type='String' Name='radius' format='ascii'>a b</DataArray>"), "arrays of type String"},
    {0, "<VTKFile type='ImageData'>\n", "a VTK file of type ImageData: it has no spheres"},
    {0, "<VTKFile type='PImageData'>\n", "a VTK file of type PImageData: it has no spheres"},
    {2, "<VTKFile type='PPolyData'>\n<Piece/>", "a piece has no Source"},
    {0, "<VTKFile type='PPolyData'>\n<Piece Source='.'/>", "is no file"},
    {1, "<VTKFile type='PolyData' compressor='vtkLZ4DataCompressor'>\n", "its arrays are packed by vtkLZ4"},
    {4,
     "<?xml version='1.0'?>\n<!-- <VTKFile --><Piece NumberOfPoints='1'>\n<PointData>\n<DataArray type='Float32' "
     "Name='radius' "
     "format='binary'>\nBAAAAAAAAD\n</DataArray>",
     "an array is damaged"},
    {1, "ITEM: ENTRIES c_1[1]\n1\n", "a LAMMPS dump of local values"},
    {0, "---\ncreator: LAMMPS\ntimestep: 0\nnatoms: 1\n",
     "this is a dump in YAML, as dump yaml of LAMMPS writes it; write a text"},
    {0, "{\"x\": 1}\n", "this is JSON"},
    {0, "<html>\n", "this is XML"},
    {0, "\x89HDF\r\n", "this is an HDF5 file"},
    {0, "\x93NUMPY", "this is a NumPy array"},
    {0, "PK\003\004", "this is a zip archive"},
    {0, "\xff\xfex", "this is text in UTF-16"},
    {0, "LammpS RestartT", "this is a LAMMPS restart file"},
    {0, "BZh91AY", "this is packed by bzip2"},
    {3, "#\nx,y,z,r,x\n0,0,0,1,2\n", "columns 1 and 5 are both named x, and differ: '0' and '2'"},
    {11, HEAD "2\n" BOX "ITEM: ATOMS id radius radius x y z\n1 1 1 0 0 0\n2 1 2 3 0 0\n",
     "columns 2 and 3 are both named radius, and differ: '1' and '2'"},
    {0, VTP(ARRAY("radius", "1 1") ARRAY("radius", "1 2")), "two arrays on the points are named radius, and differ"},
    {3, "x,y,z,r\n0,0,0,1\n3,nan,0,1\n", "y is not finite"},
    {2, "x,y,z,r\n0,0,1\n", "3 fields where the header names 4 columns"},
    {2, "x,y,z,r\n0,0,0,0\n", "the radius is 0; it must be above 0"},
    {2, "x,y,z,r\n0,0,0,-1\n", "the radius is -1"},
    {2, "x,y,z,r\n0,0,0,nan\n", "the radius is not finite"},
    {2, "x,y,z,r\n0,0,\"0,1\n", "a quoted field does not end"},
    {1, "#format x_y_z\n0 0 0\n", "no column r"},
    {4, HEAD "2\n", "the file ends within a frame"},
    {1, "ITEM: TIMESTEP\n", "the file ends within a frame"},
    {4, HEAD "many\n" BOX ATOMS SPHERE, "the number of atoms is not a whole number: 'many'"},
    {4, HEAD "-1\n" BOX ATOMS SPHERE, "the number of atoms is negative"},
    {4, HEAD "99999999999999999999\n" BOX ATOMS SPHERE, "the number of atoms is too large"},
    {4, HEAD BOX ATOMS SPHERE, "a section begins where lines of the one before are missing"},
    {10, HEAD "99999999999\n" BOX ATOMS SPHERE, "the frame ends after 1 atoms; 99999999999 were declared"},
    {11, HEAD "1\n" BOX ATOMS SPHERE SPHERE, "more atoms than declared"},
    {10, HEAD "1\n" BOX ATOMS "0 0 0\n", "3 fields where the header names 4 columns"},
    {10, HEAD "1\n" BOX ATOMS "0 zero 0 1\n", "y is not a number: 'zero'"},
    {11, HEAD "2\n" BOX ATOMS SPHERE "0 0 NaN 1\n", "z is not finite"},
    {9, HEAD "1\n" BOX "ITEM: ATOMS x y z\n0 0 0\n", "no column r"},
    {9, HEAD "1\n" BOX "ITEM: ATOMS xs y radius\n0 0 0\n", "no column z"},
    {5,
     HEAD "1\n"
          "ITEM: ATOMS xs y z r\n0 0 0 1\n",
     "the scaled coordinate xs needs a box"},
    {1, "ITEM: ATOMS x y z r\n0 0 0 1\n", "ITEM: ATOMS comes before ITEM: NUMBER OF ATOMS"},
    {3, "ITEM: TIMESTEP\n0\n" ATOMS SPHERE, "before ITEM: NUMBER OF ATOMS"},
    {7, HEAD "1\nITEM: BOX BOUNDS xy xz yz pp pp pp\n0 1 0\n0 1 0.1\n0 1 0\n" ATOMS SPHERE, "the box is tilted"},
    {8, HEAD "1\nITEM: BOX BOUNDS abc origin pp pp pp\n0 1 0 0\n0 1 0 0\n0 1 0 0\n" ATOMS SPHERE, "triclinic"},
    {8, HEAD "1\nITEM: BOX BOUNDS abc origin pp pp pp\n-1 0 0 0\n0 1 0 0\n0 0 1 0\n" ATOMS SPHERE, "the box is empty"},
    {6, HEAD "1\nITEM: BOX BOUNDS abc origin pp pp pp\n1 0 0\n0 1 0 0\n0 0 1 0\n" ATOMS SPHERE,
     "one coordinate of its origin"},
    {5, HEAD "1\nITEM: BOX BOUNDS pp pq pp\n0 1\n0 1\n0 1\n" ATOMS SPHERE, "unknown boundary mark 'pq'"},
    {7, HEAD "1\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 inf\n0 1\n" ATOMS SPHERE, "the upper bound is not finite"},
    {7, HEAD "1\nITEM: BOX BOUNDS pp pp pp\n0 1\n0\n0 1\n" ATOMS SPHERE, "the two bounds of the box"},
    {0, HEAD "0\n" BOX ATOMS, "no spheres"},
    {5, HEAD "1\n" HEAD "1\n" BOX ATOMS SPHERE, "a frame begins where atoms of the one before are missing"},
};

LOOP_TEST(faults_are_refused_with_line_and_reason, sizeof refused / sizeof *refused) {
    expect_refusal(refused[_i].text, strlen(refused[_i].text), &(struct read_options){0}, refused[_i].line,
                   refused[_i].reason);
}

TEST(binary_data_are_refused) {
    const char zeros[] = "x,y,z,r\n0,0,0,\0001\n";
    expect_refusal(zeros, sizeof zeros - 1, &(struct read_options){0}, 2, "binary data");
    expect_refusal("\x80 \xa4\x01\xb7 x y z\n1 2 3\n", 17, &(struct read_options){0}, 1, "binary data; a text file");
    expect_refusal("\x1f\x8b\x08 gzip", 8, &(struct read_options){0}, 0, "the gzip file is damaged");
    OWNED char *endless = malloc(3 << 20);
    ck_assert_ptr_nonnull(endless);
    memset(endless, '1', 3 << 20);
    expect_refusal(endless, 3 << 20, &(struct read_options){0}, 1, "the line has no end");
}

TEST(unreadable_files_are_refused) {
    static const char *const paths[] = {"no/such/file.csv", "tests"};
    for (size_t k = 0; k < 2; ++k) {
        bed_free(&bed);
        ck_assert_int_eq(read_bed(paths[k], &(struct read_options){0}, &bed), STATUS_FILE);
    }
}
