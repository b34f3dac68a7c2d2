/* test_heat_solid.c - `heat --solid-conductivity`: the program and its files. SPDX-License-Identifier: MIT */
#include "program.h"

FIXTURE(make_folder, remove_folder)

#define SIGMA 5.670374419e-8

static const char *spheres(void) {
    return write_file("bed.csv",
                      "x,y,z,radius,k,T,P\n0,0,0,0.03,2,1000,\n0.07,0,0,0.03,3,,500\n0,0.07,0,0.03,4,1500,\n");
}

/* The option that names a new table. */
static const char *table(const char *name, const char *text) { return formatted("@%s", write_file(name, text)); }

/* Column k of the line of sphere i in a .csv. Both are counted from 0. */
static double entry(const char *file, int i, int k) {
    char *text = read_file(file), *at = text;
    for (int line = 0; line <= i; ++line) ck_assert_ptr_nonnull(at = strchr(at, '\n') + 1);
    for (int column = 0; column < k; ++column) ck_assert_ptr_nonnull(at = strchr(at, ',') + 1);
    const double value = strtod(at, NULL);
    return value;
}

/* A sphere with a source that is spread evenly, in surroundings of 900 K. Its surface is at one temperature, and its
 * centre is hotter. */
TEST(a_pebble_with_a_source) {
    const double power = 500, r = 30, k = 8, area = 4 * PI * 1e-6 * r * r;
    const char *file = write_file("one.csv", "x,y,z,radius\n0,0,0,30\n"), *q = in_folder("q.csv");
    SUCCEED("heat", file, "--length-unit", "mm", "--emissivity", "0.8", "--power", "500", "--ambient", "900",
            "--solid-conductivity", "8", "-o", q);
    const double t = pow(pow(900, 4) + power / (.8 * SIGMA * area), .25), rise = power / (8 * PI * r * 1e-3 * k);
    assert_near(entry(q, 0, 1), t, 1e-4);
    assert_near(entry(q, 0, 5), t, 1e-3);
    assert_near(entry(q, 0, 6), t, 1e-3);
    assert_near(entry(q, 0, 8) - entry(q, 0, 1), rise, 1e-6);
    assert_near(value_of("centre_max_K"), t + rise, 1e-3);
    assert_near(value_of("k_star"), k / (8 * r * 1e-3 * SIGMA * t * t * t), 1e-3);
}

/* Two pebbles touch at a spot of a twentieth of their radius. Both its sides have one temperature: the largest of the
 * cold pebble, and the least of the hot one. */
TEST(pebbles_touch_at_a_spot) {
    const char *file = write_file("two.csv", "x,y,z,radius,T\n0,0,0,0.03,1000\n0.06,0,0,0.03,1100\n");
    const char *contacts = write_file("contacts.csv", "i,j,W/K\n0,1,0.03\n"), *q = in_folder("q.csv");
    SUCCEED("heat", file, "--length-unit", "m", "--emissivity", "0.8", "--temperature", "T", "--ambient", "1000",
            "--solid-conductivity", "10", "--contacts", contacts, "-o", q);
    ck_assert_double_le(fabs(entry(q, 0, 6) - entry(q, 1, 5)), .1);
    ck_assert_double_gt(entry(q, 0, 6), 1030);
}

/* A sphere that conducts, between two black plates. The flows 198.6 and 150.4 W are those of an independent program.
 * Spheres of one temperature would carry 300 W. The default of 168 directions is left out: it errs by 1.5 % at zmax. */
TEST(flows_at_plates) {
    static const char *const settings[][2] = {{"300", "96"}, {"2000", "96"}, {"1000", "384"}};
    const char *file = write_file("one.csv", "x,y,z,radius\n0,0,0.5,0.5\n"), *flows = in_folder("flows.csv");
    const char *contacts = write_file("contacts.csv", "i,j,W/K\n0,zmin,6\n0,zmax,6\n");
    for (int k = 0; k < 3; ++k) {
        SUCCEED("heat", file, "--length-unit", "m", "--emissivity", "0.8", "--power", "0", "--ambient", "900", "--wall",
                "zmin:at=0:temperature=900", "--wall", "zmax:at=1:temperature=1000", "--solid-conductivity", "100",
                "--contacts", contacts, "--contact-flows", flows, "--directions", settings[k][0], "--patches",
                settings[k][1]);
        assert_near(entry(flows, 0, 3), 198.6, .01);
        assert_near(entry(flows, 1, 3), -150.4, .01);
    }
}

/* All files have all columns. Walls and surroundings have no values in them. */
TEST(files_have_insides) {
    const char *file = spheres(), *q = in_folder("q.csv"), *json = in_folder("q.json"), *vtp = in_folder("q.vtp");
    SUCCEED("heat", file, "--length-unit", "m", "--emissivity", "0.8", "--temperature", "T", "--power", "P",
            "--ambient", "600", "--solid-conductivity", "k", "-o", q, "-o", json, "-o", vtp);
    char *text = read_file(q);
    assert_has(text,
               "i,T_K,q_W,q_error_W,T_error_K,T_min_K,T_max_K,T_surface_error_K,T_centre_K,T_centre_error_K,body\n");
    assert_has(text, ",,,,,,surroundings\n");
    for (int i = 0; i < 3; ++i) {
        ck_assert(entry(q, i, 5) < entry(q, i, 1) && entry(q, i, 1) < entry(q, i, 6));
        ck_assert_double_gt(entry(q, i, 7), 0);
        const double rise = -entry(q, i, 2) / (8 * PI * .03 * (2 + i));
        ck_assert_double_le(fabs(entry(q, i, 8) - entry(q, i, 1) - rise), 1e-9 * fabs(rise));
    }
    text = read_file(json);
    assert_has(text, "\"T_min_K\":[");
    assert_has(text, "\"T_centre_error_K\":[");
    assert_has(read_file(vtp), "Name=\"T_max_K\"");
    SUCCEED("heat", file, "--length-unit", "m", "--emissivity", "0.8", "--temperature", "T", "--power", "P",
            "--ambient", "600", "-o", q);
    assert_lacks(read_file(q), "T_min_K");
}

/* A pebble at 300 K on a floor of 1200 K. If the solid conducts badly, linear emission fails, and a warning says so. */
TEST(surfaces_below_zero_are_named) {
    const char *file = write_file("one.csv", "x,y,z,radius\n0,0,0,30\n"), *conductivity[] = {"2", "200"};
    for (int k = 0; k < 2; ++k) {
        SUCCEED("heat", file, "--length-unit", "mm", "--emissivity", "1", "--temperature", "300", "--ambient", "0",
                "--wall", "zmin:at=-30:temperature=1200", "--solid-conductivity", conductivity[k]);
        ck_assert_int_eq(value_of("surface_min_K") < 0, k == 0);
        ck_assert_int_eq(strstr(said, "one.csv:2: warning: sphere 0: its surface comes out at -") != NULL, k == 0);
    }
}

/* A table over temperature is read at the temperature that is found. */
TEST(conductivity_follows_temperature) {
    const char *file = write_file("one.csv", "x,y,z,radius\n0,0,0,30\n0,0,70,30\n"), *q = in_folder("q.csv");
    SUCCEED("heat", file, "--length-unit", "mm", "--emissivity", "0.8", "--power", "400", "--ambient", "600",
            "--solid-conductivity", table("k.csv", "T,k\n500,10\n1500,2\n"), "-o", q);
    const double t = entry(q, 0, 1), k = 10 - 8 * (t - 500) / 1000;
    assert_near(entry(q, 0, 8) - t, 400 / (8 * PI * .03 * k), 1e-3);
}

/* In time, insides are taken to be steady. A warning says if steps are shorter than the time in which an inside becomes
 * steady. */
TEST(insides_lag_in_time) {
    const char *file = write_file("one.csv", "x,y,z,radius\n0,0,0,0.03\n0.07,0,0,0.03\n"), *q = in_folder("q.csv");
    for (int quick = 0; quick < 2; ++quick) {
        SUCCEED("heat", file, "--length-unit", "m", "--emissivity", "0.8", "--temperature", "1000", "--ambient", "600",
                "--solid-conductivity", "2", "--heat-capacity", "800", "--density", "2000", "--until",
                quick ? "10" : "2000", "--step", quick ? "5" : "100", "-o", q);
        assert_near(value_of("inner_lag_s"), 9e-4 * 1.6e6 / (PI * PI * 2), 1e-2);
        ck_assert_double_le(fabs(value_of("balance_of_stored")), 1e-12);
        if (quick)
            expect_message(file, "insides of spheres are taken to be steady");
        else
            ck_assert_str_eq(said, "");
        ck_assert_double_lt(entry(q, 0, 6), entry(q, 0, 7));
        ck_assert_double_gt(entry(q, 0, 9), entry(q, 0, 2)); /* the sphere cools, so its centre is hotter */
    }
}

/* Infinity and a blank in a column stand for one temperature, which large numbers come near. The power is that of 4000
 * directions and 384 patches. */
TEST(blanks_conduct_well) {
    static const char *const k[] = {"1e7", "1e9", "1e10", "1e12", "inf", "", "nan"};
    const char *q = in_folder("q.csv");
    for (size_t i = 0; i < sizeof k / sizeof *k; ++i) {
        const char *text = formatted("x,y,z,r,T,k,e\n0,0,0,.5,900,3,.6\n0,0,.803,.3,1100,%s,1\n", k[i]);
        SUCCEED("heat", write_file("two.csv", text), "--length-unit", "m", "--emissivity", "e", "--temperature", "T",
                "--ambient", "300", "--solid-conductivity", "k", "-o", q);
        assert_near(entry(q, 0, 2), -62633, 1e-3);
        ck_assert_double_lt(value_of("sweeps"), 30);
    }
}

TEST(what_cannot_be) {
    const char *file = spheres(), *hole = write_file("hole.csv", "x,y,z,radius,k\n0,0,0,1,-inf\n");
    const struct {
        const char *value, *reason;
        int status;
    } wrong[] = {
        {"0", "--solid-conductivity", 2},
        {"-3", "--solid-conductivity", 2},
        {"nan", "no column nan", 3},
        {"lambda", "lambda", 3},
        {"x", "conductivity of the solid", 3},
        {"1:5", "type", 3},
        {table("wrong_k.csv", "300,5\n400,-1\n"), "wrong_k.csv:2: the solid-conductivity is -1; it must be within", 3},
        {table("wrong_order.csv", "300,5\n300,1\n"), "wrong_order.csv:2: 300 is not above the number before", 3},
        {table("wrong_word.csv", "300,x\n"), "wrong_word.csv:1: solid-conductivity is not a number: 'x'", 3},
    };
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
        FAIL_WITH(wrong[k].status, "heat", file, "--length-unit", "m", "--emissivity", "0.8", "--temperature", "900",
                  "--ambient", "600", "--solid-conductivity", wrong[k].value);
        assert_has(said, wrong[k].reason);
    }
    FAIL_WITH(3, "heat", hole, "--length-unit", "m", "--emissivity", "0.8", "--temperature", "900", "--ambient", "600",
              "--solid-conductivity", "k");
    assert_has(said, "hole.csv:2: k is not finite");
    FAIL_WITH(2, "heat", file, "--emissivity", "0.8", "--temperature", "900", "--ambient", "600",
              "--solid-conductivity", "5");
    assert_has(said, "--length-unit");
}
