/* test_contacts_program.c - contacts and gas of the program: options, files, messages. SPDX-License-Identifier: MIT */
#include "bed/bed.h"
#include "program.h"
#include "scenes.h"

FIXTURE(make_folder, remove_folder)

/* A row of three spheres on a floor, of which the first gives off 40 W. */
static const char *row(void) {
    return write_file("row.csv", "x,y,z,radius,P\n0,0,0.01,0.01,40\n0,0,0.0299,0.01,0\n0,0,0.0502,0.01,0\n");
}
static const char *contacts(const char *text) { return write_file("contacts.csv", text); }

/* Column k of the line of wall i of a .csv, both from 0. */
static double column(const char *file, int i, int k) {
    char *at = read_file(file);
    for (int line = 0; line <= i; ++line) ck_assert_ptr_nonnull(at = strchr(at, '\n') + 1);
    for (int c = 0; c < k; ++c) ck_assert_ptr_nonnull(at = strchr(at, ',') + 1);
    return strtod(at, NULL);
}

#define ROW row(), "--length-unit", "m", "--ambient", "300", "--wall", "zmin:temperature=400", "--power", "P"

/* Without emission the flows are known: all of the power goes to the floor. */
TEST(a_row_conducts) {
    const char *q = in_folder("q.csv"), *flows = in_folder("flows.csv");
    SUCCEED("heat", ROW, "--emissivity", "0", "--contacts",
            contacts("i,j,W/K\n# a remark\n1,0,0.5\n0,zmin,1\n1;2;.2\n"), "-o", q, "--contact-flows", flows);
    for (int i = 0; i < 3; ++i) assert_near(column(q, i, 1), 440, 1e-9);
    assert_near(column(q, 0, 2), -40, 1e-9);
    assert_near(column(q, 0, 6), -40, 1e-9);
    assert_near(column(q, 4, 6), 40, 1e-9);
    assert_near(value_of("wall_zmin_conduction_W"), 40, 1e-9);
    assert_near(value_of("spheres_conduction_W"), -40, 1e-9);
    ck_assert_double_eq(value_of("contacts"), 3);
    char *text = read_file(flows);
    assert_begins(text, "i,j,W/K,W,error_W\n1,0,0.5,");
    assert_has(text, "\n0,zmin,1,40,0\n");
    assert_has(read_file(q), "T_error_K,q_radiation_W,q_conduction_W,body\n");
}

/* A box whose sides have temperatures, each one a wall or all together one wall. Spheres touch all sides. */
LOOP_TEST(places_of_a_wall, 4) {
    static const int quad[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    static const int kelvins[6] = {300, 900, 400, 700, 500, 600};
    static const char *const more[4][8] = {
        {"--power", "0"},
        {"--power", "0", "--gas-conductivity", ".1"},
        {"--power", "0", "--solid-conductivity", "2"},
        {"--temperature", "400", "--until", "3000", "--heat-capacity", "800", "--density", "2500"}};
    const char *arguments[2][40] = {{NULL}};
    double error[2];
    const char *q[2] = {in_folder("0.csv"), in_folder("1.csv")}, *stl[2] = {in_folder("one.stl"), in_folder("w.stl")};
    char text[2][9000] = {"solid one\n", ""}, bed[2000] = "x,y,z,radius\n", list[200] = "T\n", option[6][40];
    for (int side = 0; side < 6; ++side) {
        snprintf(text[1] + strlen(text[1]), 40, "%ssolid %d\n", side > 0 ? "endsolid\n" : "", side);
        snprintf(list + strlen(list), 20, "%d\n%d\n", kelvins[side], kelvins[side]);
        snprintf(option[side], sizeof *option, "w_%d:temperature=%d", side, kelvins[side]);
        for (int c = 0; c < 6; ++c) {
            const int v = quad[side][c % 3 == 0 ? 0 : c % 3 + c / 3];
            for (int k = 0; k < 2; ++k)
                snprintf(text[k] + strlen(text[k]), 99, "%svertex %d %d %d\n%s",
                         c % 3 == 0 ? "facet normal 0 0 0\nouter loop\n" : "", v & 1, v >> 1 & 1, v >> 2,
                         c % 3 == 2 ? "endloop\nendfacet\n" : "");
        }
    }
    for (int k = 0; k < 8; ++k)
        snprintf(bed + strlen(bed), 60, "%g,%g,%g,.2502\n", .25 + .5 * (k & 1), .25 + .5 * (k >> 1 & 1),
                 .25 + .5 * (k >> 2));
    for (int k = 0; k < 2; ++k) write_file(k ? "w.stl" : "one.stl", strcat(text[k], "endsolid\n"));
    write_file("bed.csv", bed), write_file("list.csv", list);
    for (int k = 0; k < 2; ++k) {
        const char **to = arguments[k];
        for (const char *const *from = LIST("heat", in_folder("bed.csv"), "--length-unit", "m", "--emissivity", ".8",
                                            "--contacts", "lens", "--contact-conductivity", "3", "-o", q[k], "--wall");
             *from; ++from)
            *to++ = *from;
        if (k == 0) *to++ = formatted("mesh:%s:emissivity=.9:temperatures=%s", stl[0], in_folder("list.csv"));
        if (k == 1) *to++ = formatted("mesh:%s:solids:emissivity=.9", stl[1]);
        for (int side = 0; side < 6 && k == 1; ++side) *to++ = "--wall", *to++ = option[side];
        for (int m = 0; m < 8 && more[_i][m]; ++m) *to++ = more[_i][m];
        ck_assert_int_eq(finish(start(arguments[k])), 0);
        error[k] = _i < 3 ? value_of("error_temperature_rms_K") : 1;
    }
    const int t = _i == 3 ? 2 : 1;
    for (int i = 0; i < 8; ++i) ck_assert_double_eq_tol(column(q[0], i, t), column(q[1], i, t), 5e-3);
    ck_assert_msg(error[0] > error[1] / 3 && error[0] < 3 * error[1], "%g K, %g K", error[0], error[1]);
}

/* The text after the first `what`. */
static char *after(char *text, const char *what) {
    char *at = strstr(text, what);
    ck_assert_ptr_nonnull(at);
    return at + strlen(what);
}

/* Radiation and conduction are the two parts of the power of each wall. Files and spots may be combined, and each frame
 * may have a file of its own. */
TEST(parts_add_up) {
    const char *q = in_folder("q.csv"), *json = in_folder("q.json"), *dump = in_folder("q.dump"),
               *vtp = in_folder("q.vtp");
    write_file("c.0.csv", "i,j,W/K\n0,2,0.001\n0,2,0.002\n");
    SUCCEED("heat", ROW, "--emissivity", "0.8", "--contacts", in_folder("c.*.csv"), "--contacts", "hertz",
            "--contact-conductivity", "30", "--gas-conductivity", "0.1", "-o", q, "-o", json, "-o", dump, "-o", vtp);
    for (int i = 0; i < 5; ++i)
        ck_assert_double_le(fabs(column(q, i, 2) - column(q, i, 5) - column(q, i, 6)),
                            1e-9 * (1 + fabs(column(q, i, 2))));
    ck_assert_double_eq(value_of("contacts"), 5);
    char *text = read_file(json);
    const double conducted = strtod(after(text, "\"q_conduction_W\":["), NULL),
                 radiated = strtod(after(text, "\"q_radiation_W\":["), NULL);
    assert_near(conducted, column(q, 0, 6), 1e-12);
    assert_near(radiated + conducted, -40, 1e-9);
    assert_near(strtod(after(after(text, "\"zmin\""), "\"q_conduction_W\":"), NULL), column(q, 4, 6), 1e-12);
    text = after(read_file(dump), "T_K q_W q_radiation_W q_conduction_W P\n0 0 0 0.01 0.01 ");
    text = after(text, " -40 ");
    assert_near(strtod(text, &text), radiated, 1e-12);
    assert_near(strtod(text, NULL), conducted, 1e-12);
    assert_has(read_file(vtp), "Name=\"q_radiation_W\"");
    assert_has(read_file(vtp), "Name=\"q_conduction_W\"");
    SUCCEED("heat", ROW, "--emissivity", "0.8", "--contacts", "hertz", "--contact-conductivity", "30", "--until", "60",
            "--heat-capacity", "800", "--density", "2500", "--temperature", "500", "-o", q);
    ck_assert_double_lt(fabs(value_of("balance_of_stored")), 1e-10);
}

/* Bins have the mean of temperatures and the sum of powers that -o has of the same spheres. */
TEST(profiles_are_of_what_is_written) {
    const char *q = in_folder("q.csv"), *p = in_folder("p.csv"),
               *tube = "cylinder:0,0.001,0.02:temperature=350,zmax:open:at=0.07";
    SUCCEED("heat", ROW, "--emissivity", "0.8", "--wall", tube, "--contacts", "hertz", "--contact-conductivity", "30",
            "-o", q, "--profile", formatted("z:3:%s", p));
    assert_begins(read_file(p), "z_low,z_high,spheres,T_K,q_W,q_radiation_W,q_conduction_W\n0,");
    for (int i = 0; i < 3; ++i) {
        assert_near(column(p, i, 1), (i + 1) * .0602 / 3, 1e-8);
        ck_assert_double_eq(column(p, i, 2), 1);
        for (int k = 3; k < 5; ++k) ck_assert_double_eq_tol(column(p, i, k), column(q, i, k - 2), 1e-6);
        for (int k = 5; k < 7; ++k) ck_assert_double_eq_tol(column(p, i, k), column(q, i, k), 1e-6);
    }
    SUCCEED("heat", ROW, "--emissivity", "0.8", "--wall", tube, "-o", q, "--profile", formatted("r:11:%s", p));
    ck_assert_double_eq(column(p, 0, 2), 0);
    ck_assert_double_eq(column(p, 1, 2), 3); /* 1 mm from the axis, in bins of 1 mm */
    assert_near(column(p, 1, 1), .002, 1e-8);
    assert_near(column(p, 1, 3), (column(q, 0, 1) + column(q, 1, 1) + column(q, 2, 1)) / 3, 1e-8);
    assert_near(column(p, 1, 4), column(q, 0, 2) + column(q, 1, 2) + column(q, 2, 2), 1e-7);
    assert_has(read_file(p), "\n0,0.001,0,,\n");
    FAIL_WITH(2, "heat", ROW, "--emissivity", "0.8", "--profile", formatted("r:%s", p));
    expect_message("--profile: r needs a wall that is a cylinder", "");
}

/* A simple cubic lattice of one temperature a sphere conducts 2 k a/d. */
TEST(a_lattice_conducts) {
    char text[12000] = "x,y,z,radius\n", *at = text + strlen(text);
    for (int i = 0; i < 2 * 2 * 24; ++i)
        at += sprintf(at, "%d,%d,%d,1.0005\n", 2 * (i % 2) + 1, 2 * (i / 2 % 2) + 1, 2 * (i / 4) + 1);
    SUCCEED("conductivity", write_file("lattice.csv", text), "--periodic", "4,4,48", "--length-unit", "cm",
            "--emissivity", "0.8", "--temperature", "1000", "--steady", "--axis", "z", "--contacts", "lens",
            "--contact-conductivity", "30", "--rays", "1000");
    const double conduction = value_of("k_conduction_z_W_mK"), radiation = value_of("k_radiation_z_W_mK");
    assert_near(conduction, 2 * 30 * sqrt(1.0005 * 1.0005 - 1) / 2, 1e-6);
    ck_assert_double_le(fabs(value_of("k_total_z_W_mK") - conduction - radiation), 2e-3 * radiation);
    assert_near(radiation, value_of("F_E_steady_z") * 4 * 5.670374419e-8 * 1e9 * 2.001e-2, 2e-2);
}

/* Rows of spheres, each of which conducts to the next one by .5 and .1 W/K in turn: the two are in series. Contacts
 * across the period are left out. */
TEST(contacts_in_series) {
    enum { ROWS = 4, LONG = 32 };
    const char *k = in_folder("k.csv"), *json = in_folder("k.json");
    char text[8000] = "x,y,z,radius\n", *at = text + strlen(text), pairs[4000] = "i,j,W/K\n",
         *to = pairs + strlen(pairs);
    for (int i = 0; i < ROWS * LONG; ++i) {
        at += sprintf(at, "%d,%d,%d,1\n", 2 * (i % 2) + 1, 2 * (i / 2 % 2) + 1, 2 * (i / ROWS) + 1);
        to += sprintf(to, "%d,%d,%s\n", i, (i + ROWS) % (ROWS * LONG), i / ROWS % 2 ? ".5" : ".1");
    }
    SUCCEED("conductivity", write_file("rows.csv", text), "--periodic", "4,4,64", "--length-unit", "m", "--emissivity",
            "0.8", "--temperature", "1000", "--steady", "--axis", "z", "--contacts", contacts(pairs), "--rays", "100",
            "-o", k, "-o", json);
    const double truth = 2 / (1 / .1 + 1 / .5) * 2 / 4, found = value_of("k_conduction_z_W_mK");
    ck_assert_double_le(fabs(found - truth), 2 * value_of("k_conduction_z_W_mK_error"));
    assert_near(found, truth, .02);
    assert_near(column(k, 0, 15), found, 1e-3);
    assert_near(strtod(after(read_file(json), "\"k_conduction_W_mK\":"), NULL), column(k, 0, 15), 1e-12);
    assert_has(read_file(k), "warning,k_total_W_mK,k_total_W_mK_error,k_radiation_W_mK,");

    /* three rows between plates, and two spheres of the fourth one that touch only each other */
    to = pairs + sprintf(pairs, "i,j,W/K\n63,67,.2\n");
    for (int i = 0; i < ROWS * (LONG - 1); ++i)
        if (i % ROWS < 3) to += sprintf(to, "%d,%d,.3\n", i, i + ROWS);
    SUCCEED("conductivity", in_folder("rows.csv"), "--periodic", "4,4,0", "--length-unit", "m", "--emissivity", "0.8",
            "--temperature", "1000", "--steady", "--axis", "z", "--contacts", contacts(pairs), "--rays", "100");
    assert_near(value_of("k_conduction_z_W_mK"), .3 * 2 / 4 * 3 / 4, 1e-5);
}

/* Finds conductivities along z of a periodic random bed of this many spheres. */
static void conduct(uint32_t n, double low, double high, double solid, const char *contact, const char *gas) {
    OWNED_BED bed = packing(n, low, high, solid, 3, true);
    char text[40000] = "x,y,z,radius\n", *at = text + strlen(text);
    for (uint32_t i = 0; i < bed.n; ++i)
        at += sprintf(at, "%.12g,%.12g,%.12g,%.12g\n", bed.x[i], bed.y[i], bed.z[i], bed.r[i]);
    SUCCEED("conductivity", write_file("bed.csv", text), "--periodic",
            formatted("%.17g,%.17g,%.17g", bed.period[0], bed.period[1], bed.period[2]), "--length-unit", "cm",
            "--emissivity", "0.8", "--temperature", "1000", "--steady", "--axis", "z", "--contacts", "lens",
            "--contact-conductivity", contact, "--gas-conductivity", gas, "--error", ".02");
}

/* A random bed conducts more by radiation and contacts together than by both alone. */
TEST(together_exceeds_the_sum) {
    conduct(500, .8, 1.2, .55, "30", ".3");
    const double total = value_of("k_total_z_W_mK");
    ck_assert_double_ge(total, value_of("k_radiation_z_W_mK") + value_of("k_conduction_z_W_mK"));
    ck_assert_double_le(value_of("k_total_z_W_mK_error"), .01 * total);
}

/* Beds with gas, over the gas: k_s/k_gas and what was measured. C. G. van Antwerpen, C. G. du Toit, P. G. Rousseau,
 * Nucl. Eng. Des. 240 (2010) 1803: measurements by many, porosity about .4. */
LOOP_TEST(beds_with_gas_in_gaps, 2) {
    static const double measured[2][2] = {{4.2, 2.3}, {142, 10}};
    conduct(250, 1, 1, .6, formatted("%g", measured[_i][0]), "1");
    assert_near(value_of("k_conduction_z_W_mK"), measured[_i][1], .2);
}

/* Beyond the ends of tables the value at the end is taken, with a warning. */
TEST(tables_end) {
    const char *solid = formatted("@%s", write_file("solid.csv", "T,k\n300,30\n450,20\n")),
               *gas = formatted("@%s", write_file("gas.csv", "T,k\n300,.1\n900,.2\n"));
    SUCCEED("heat", ROW, "--emissivity", "0.8", "--contacts", "hertz", "--contact-conductivity", solid,
            "--gas-conductivity", gas, "-o", in_folder("q.csv"));
    assert_has(said, "--contact-conductivity: 3 spheres have temperatures beyond the table, by up to 3");
    ck_assert_ptr_null(strstr(said, "--gas-conductivity"));
    SUCCEED("heat", row(), "--length-unit", "m", "--ambient", "300", "--temperature", "1100", "--emissivity", "0.8",
            "--contact-conductivity", "30", "--gas-conductivity", gas, "-o", in_folder("q.csv"));
    assert_has(said, "--gas-conductivity: 2 contacts have temperatures beyond the table, by up to 200 K");
}

/* What is wrong with a file of contacts is said with its line. */
LOOP_TEST(files_at_fault, 10) {
    static const struct {
        const char *text, *reason;
        int line;
    } cases[] = {{"i,j,W/K\n0,1,1\n0,7,1\n", "there is no sphere 7", 3},
                 {"i,j,W/K\n0,1,-1\n", "the conductance is -1; it must be within 0 and 1e+12", 2},
                 {"i,j,W/K\n0,1,nan\n", "conductance is not finite: 'nan'", 2},
                 {"i,j,W/K\n1,1,1\n", "1 is in contact with itself", 2},
                 {"i,j,W/K\n1,zmax,1\n", "'zmax' is neither a sphere nor a wall", 2},
                 {"i,j,W/K\n1,2\n", "2 columns instead of i,j,W/K", 2},
                 {"0,1,1\n", "the header is not i,j,W/K", 1},
                 {"", "there is no header i,j,W/K", 0},
                 {"% of a run\n\n", "there is no header i,j,W/K", 0},
                 {"i,j,W/K\n0,1.5,1\n", "'1.5' is neither a sphere nor a wall", 2}};
    const char *file = contacts(cases[_i].text);
    FAIL_WITH(3, "heat", ROW, "--emissivity", "0.8", "--contacts", file);
    assert_has(said,
               formatted("%s%s: %s", file, cases[_i].line ? formatted(":%d", cases[_i].line) : "", cases[_i].reason));
}

/* A sphere of emissivity 0 and a given temperature holds another one. Its power is that of a sphere of emissivity 1e-9:
 * the balance of radiation to 300 K, conduction and 1 W. Sphere 1 sees sphere 0 and sends back a little of its light.
 */
TEST(what_reflects_all_holds_a_sphere) {
    const char *q = in_folder("q.csv"), *pair = contacts("i,j,W/K\n0,1,0.05\n");
    const double area = 4 * PI * 1e-4, sigma = 5.670374419e-8;
    for (int nearly = 0; nearly < 2; ++nearly) {
        const char *hold =
            write_file("hold.csv",
                       formatted("id,x,y,z,r,e,T\n0,0,0,0,0.01,0.8,\n1,0.05,0,0,0.01,%s,600\n", nearly ? "1e-9" : "0"));
        SUCCEED("heat", hold, "--emissivity", "e", "--temperature", "T", "--power", "1", "--ambient", "300",
                "--contacts", pair, "--length-unit", "m", "-o", q);
        const double t = column(q, 0, 1), lost = .8 * area * sigma * (pow(t, 4) - pow(300, 4));
        assert_near(t, 535.5, 1e-4);
        assert_near(1 + .05 * (600 - t), lost, 2e-3);
        ck_assert_double_lt(value_of("sweeps"), 20);
    }
    const char *above = write_file("above.csv", "x,y,z,r\n0,0,0,0.01\n");
    SUCCEED("heat", above, "--emissivity", "0.8", "--power", "1", "--ambient", "300", "--wall",
            "zmin:at=-0.02:temperature=600:emissivity=0", "--contacts", contacts("i,j,W/K\n0,zmin,0.05\n"),
            "--length-unit", "m", "-o", q);
    assert_near(column(q, 0, 1), 536.56, 5e-4);
}

/* Eight spheres in a row, of which only the last one has a temperature, without emission or with some of it. */
TEST(the_far_end_of_a_chain_holds) {
    const char *q = in_folder("q.csv");
    char pairs[300] = "i,j,W/K\n", *to = pairs + strlen(pairs);
    for (int i = 0; i < 7; ++i) to += sprintf(to, "%d,%d,%g\n", i, i + 1, .01 * (i + 1));
    for (int dark = 0; dark < 2; ++dark) {
        char text[600] = "id,x,y,z,r,e,T,P\n", *at = text + strlen(text);
        for (int i = 0; i < 8; ++i)
            at += sprintf(at, "%d,%g,0,0,.01,%g,%s,%s\n", i, .025 * i, dark || i == 7 ? 0 : i % 3 * .4,
                          i == 7 ? "1500" : "", i == 7 ? "" : "0.5");
        SUCCEED("heat", write_file("chain.csv", text), "--length-unit", "m", "--emissivity", "e", "--temperature", "T",
                "--power", "P", "--ambient", "300", "--contacts", contacts(pairs), "-o", q);
        ck_assert_double_lt(value_of("sweeps"), 40);
        for (int i = 0; i < 7 && dark; ++i)
            assert_near(column(q, i, 1) - column(q, i + 1, 1), .5 * (i + 1) / (.01 * (i + 1)), 1e-9);
        ck_assert_double_gt(column(q, 6, 1), dark ? 1549 : 1000);
    }
}

/* The third name of the header is a unit. */
TEST(conductances_have_units) {
    static const char *const unit[] = {"W/K", "mW/K", "kW/K"}, *const wrong[] = {"K/W", "W/m/K", "H", "W"};
    static const double scale[] = {1, 1e-3, 1e3};
    for (int k = 0; k < 3; ++k) {
        SUCCEED("heat", ROW, "--emissivity", "0.8", "--contacts",
                contacts(formatted("i,j,%s\n0,zmin,5\n0,1,5\n", unit[k])));
        assert_near(value_of("conductance_mean_W_K"), 5 * scale[k], 1e-9);
    }
    for (int k = 0; k < 4; ++k) {
        FAIL_WITH(3, "heat", ROW, "--emissivity", "0.8", "--contacts",
                  contacts(formatted("i,j,%s\n0,zmin,5\n", wrong[k])));
        assert_has(said, formatted("contacts.csv:1: the third name of the header is '%s'", wrong[k]));
    }
}

/* An insulated wall in contact has the power 0, and a temperature that is found, in time as well. */
TEST(insulated_walls_in_contact) {
    const char *file = contacts("i,j,W/K\n0,zmin,0.5\n2,zmax,0.5\n"), *of_wall[] = {"zmin:insulated", "zmin:power=0"};
    double found[2], in_time = 0;
    for (int k = 0; k < 2; ++k) {
        SUCCEED("heat", row(), "--length-unit", "m", "--power", "P", "--emissivity", "0.8", "--periodic", ".04,.04,0",
                "--wall", of_wall[k], "--wall", "zmax:at=.0602:temperature=500", "--contacts", file);
        found[k] = value_of("wall_zmin_K");
        if (k == 0) assert_has(said, "the insulated wall zmin is in contact, so it has one temperature");
    }
    ck_assert_double_eq(found[0], found[1]);
    SUCCEED("heat", row(), "--length-unit", "m", "--power", "P", "--emissivity", "0.8", "--periodic", ".04,.04,0",
            "--wall", of_wall[0], "--wall", "zmax:at=.0602:temperature=500", "--contacts", file, "--temperature", "500",
            "--until", "20000", "--times", "100", "--heat-capacity", "800", "--density", "2500", "-o",
            in_folder("t.csv"));
    in_time = value_of("wall_zmin_K");
    assert_near(in_time, found[0], 2e-3);
}

/* Options that need others, or cannot be combined. */
TEST(options_at_fault) {
    const char *file = contacts("i,j,W/K\nzmin,1,1\n");
    FAIL_WITH(2, "heat", ROW, "--emissivity", "0.8", "--contacts", "lens");
    assert_has(said, "--contacts lens or hertz needs --contact-conductivity or --solid-conductivity");
    FAIL_WITH(2, "heat", ROW, "--emissivity", "0.8", "--contacts", "lens", "--contacts", "hertz");
    FAIL_WITH(4, "heat", ROW, "--emissivity", "0.8", "--contacts", "herz");
    assert_has(said, "--contacts: 'herz' is neither lens nor hertz, nor a file that exists");
    FAIL_WITH(2, "heat", ROW, "--emissivity", "0.8", "--gas-conductivity", "0.1");
    FAIL_WITH(2, "heat", ROW, "--emissivity", "0.8", "--contact-flows", in_folder("flows.csv"));
    FAIL_WITH(2, "heat", ROW, "--emissivity", "0.8", "--gas-gap", "0.2");
    FAIL_WITH(2, "heat", row(), "--ambient", "300", "--power", "P", "--emissivity", "0.8", "--contacts", "lens",
              "--contact-conductivity", "3");
    assert_has(said, "the file names no unit of length, which contacts need");
    FAIL_WITH(2, "heat", row(), "--length-unit", "m", "--ambient", "300", "--power", "P", "--emissivity", "0.8",
              "--wall", "zmin:insulated", "--contacts", file);
    assert_has(said,
               "zmin is in contact and needs one temperature, or a power: --wall zmin:power=0 if it is insulated");
    FAIL_WITH(3, "heat", row(), "--length-unit", "m", "--ambient", "300", "--power", "P", "--emissivity", "0",
              "--contacts", contacts("i,j,W/K\n0,1,1\n"));
    assert_has(said, "row.csv:2: sphere 0 has emissivity 0, and nothing that it touches radiates or has a temperature");
    FAIL_WITH(2, "conductivity", row(), "--emissivity", "0.8", "--contacts", "lens", "--contact-conductivity", "3");
    FAIL_WITH(2, "conductivity", row(), "--emissivity", "0.8", "--contacts", "lens", "--contact-conductivity", "3",
              "--steady", "--temperature", "0");
    assert_has(said, "--contacts and --gas-conductivity need a --temperature above 0 K");
}

/* A sphere that conducts inside, between plates: with --error its flows are no worse, and the summary says what they
 * err by. 198.52 and 150.39 W: tests/test_spots.c. */
TEST(errors_of_flows) {
    const char *flows = in_folder("flows.csv"), *errors[] = {"0.01", "0.002"};
    write_file("one.csv", "x,y,z,r\n0,0,.5,.5\n");
    for (int k = 0; k < 2; ++k) {
        SUCCEED("heat", in_folder("one.csv"), "--length-unit", "m", "--emissivity", "0.8", "--power", "0", "--wall",
                "zmin:at=0:temperature=900:emissivity=1", "--wall", "zmax:at=1:temperature=1000:emissivity=1",
                "--ambient", "900", "--solid-conductivity", "100", "--contacts",
                contacts("i,j,W/K\n0,zmin,6\n0,zmax,6\n"), "--contact-flows", flows, "--error", errors[k]);
        assert_near(column(flows, 0, 3), 198.52, .01);
        assert_near(column(flows, 1, 3), -150.39, .01);
        for (int i = 0; i < 2; ++i) ck_assert(column(flows, i, 4) > .1 && column(flows, i, 4) < 3);
        ck_assert_double_le(value_of("error_of_flows"), value_of("error_reached"));
        ck_assert_double_le(.0005, value_of("error_of_flows"));
    }
}
