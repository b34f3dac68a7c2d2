/* test_stream.c - gas that flows through a bed, against Schumann's closed form, balances of slices and correlations.
 * SPDX-License-Identifier: MIT */
#include <gsl/gsl_integration.h>
#include <gsl/gsl_sf_bessel.h>

#include "program.h"

FIXTURE(make_folder, remove_folder)

#define PI 3.14159265358979323846

/* Column k of the last line of a .csv, from 0. */
static double of_gas(const char *file, int k) {
    char *text = read_file(file), *at = text + strlen(text) - 1;
    while (at > text && at[-1] != '\n') --at;
    for (int c = 0; c < k; ++c) ck_assert_ptr_nonnull(at = strchr(at, ',') + 1);
    return strtod(at, NULL);
}

/* Values of column k of a .csv, from its second line on. */
static void values_of(const char *file, int k, int count, double *value) {
    char *at = read_file(file);
    for (int i = 0; i < count; ++i) {
        ck_assert_ptr_nonnull(at = strchr(at, '\n') + 1);
        char *cell = at;
        for (int c = 0; c < k; ++c) ck_assert_ptr_nonnull(cell = strchr(cell, ',') + 1);
        value[i] = strtod(cell, NULL);
    }
}

/* Spheres of radius 1 cm in columns of `high` spheres above each other. */
static const char *columns(int wide, int high) {
    size_t used = 0, room = 100 + 60 * (size_t)(wide * wide * high);
    char *text = malloc(room);
    used += (size_t)snprintf(text, room, "x,y,z,r\n");
    for (int k = 0; k < wide * wide * high; ++k)
        used += (size_t)snprintf(text + used, room - used, "%g,%g,%g,0.01\n", .01 + .02 * (k % wide),
                                 .01 + .02 * (k / wide % wide), .01 + .02 * (k / wide / wide));
    const char *file = write_file("columns.csv", text);
    free(text);
    return file;
}

#define AREA (4 * PI * 1e-4)

/* T. E. W. Schumann, J. Franklin Inst. 208 (1929) 405. Temperatures are over the inlet's, from those at the beginning.
 * Lengths are in transfer units, times in heat capacities over films. The solid has schumann(length, time), the gas 1 -
 * schumann(time, length). */
static double integrand(double s, void *fixed) {
    const double root = 2 * sqrt(*(double *)fixed * s);
    return exp(root - *(double *)fixed - s) * gsl_sf_bessel_I0_scaled(root);
}
static double schumann(double fixed, double end) {
    gsl_integration_workspace *work = gsl_integration_workspace_alloc(1000);
    double value, error;
    gsl_integration_qag(&(gsl_function){integrand, &fixed}, 0, end, 1e-12, 1e-12, 1000, GSL_INTEG_GAUSS61, work, &value,
                        &error);
    gsl_integration_workspace_free(work);
    return value;
}

/* A column of 1,000 spheres that do not radiate: a step of temperature at the inlet passes through it. */
TEST(schumann_column) {
    enum { N = 1000 };
    const char *q = in_folder("q.csv");
    const double h = 10, flow = AREA * h / .01, rate = h * 3 / (.01 * 800 * 2500.); /* 10 transfer units */
    static double t[N];
    for (int k = 0; k < 2; ++k) {
        const double time = (double[]){4, 12}[k];
        SUCCEED("heat", columns(1, N), "--length-unit", "m", "--ambient", "300", "--emissivity", "0", "--temperature",
                "300", "--convection", "10", "--gas-flow", formatted("z:%.17g", flow / 4e-4 / 1000),
                "--gas-heat-capacity", "1000", "--gas-temperature", "500", "--heat-capacity", "800", "--density",
                "2500", "--until", formatted("%.17g", time / rate), "-o", q, "--directions", "24", "--patches", "24");
        values_of(q, 2, N, t);
        for (int i = 0; i < N; i += 111)
            ck_assert_double_eq_tol((t[i] - 300) / 200, schumann(.01 * (i + .5), time), .002);
        ck_assert_double_eq_tol((value_of("gas_outlet_K") - 300) / 200, 1 - schumann(time, 10), .002);
        ck_assert_double_lt(fabs(value_of("balance_of_stored")), 1e-12);
    }
}

enum { WIDE = 3, HIGH = 8, LAYER = WIDE * WIDE, N = LAYER * HIGH };
#define BED      "heat", columns(WIDE, HIGH), "--length-unit", "m", "--ambient", "900"
#define RADIATES BED, "--emissivity", "0.8", "--power", "3", "--convection", "60"
#define AIR      "--gas-temperature", "300", "--gas-flow", "z:0.4", "--gas-heat-capacity"

/* What slices take up is what their spheres lose. With this gas given, the bed has the same temperatures. */
TEST(slices_of_a_bed_that_radiates) {
    static double t[N], lost[N], again[N];
    const char *q = in_folder("q.csv"), *table = write_file("cp.csv", "T,c\n200,900\n1200,1900\n");
    for (int varies = 0; varies < 2; ++varies) {
        char text[N * 80] = "x,y,z,r,g\n", *end = text + strlen(text);
        SUCCEED(RADIATES, AIR, varies ? formatted("@%s", table) : "1100", "--contacts", "hertz", "--gas-conductivity",
                "0.05", "--contact-conductivity", "2", "-o", q);
        ck_assert_double_lt(fabs(value_of("balance_of_emission")), 1e-13);
        values_of(q, 1, N, t);
        values_of(q, 7, N, lost);
        double gas = 300, all = 0;
        for (int k = 0; k < HIGH; ++k) {
            double mean = 0, sum = 0;
            for (int i = LAYER * k; i < LAYER * (k + 1); ++i) mean += t[i] / LAYER, sum -= lost[i];
            const double next = mean - sum / (60 * AREA * LAYER);
            const double capacity = varies ? 900 + ((gas + next) / 2 - 200) : 1100;
            assert_near(.4 * .06 * .06 * capacity * (next - gas), sum, 1e-9);
            gas = next, all += sum;
            for (int i = LAYER * k; i < LAYER * (k + 1); ++i)
                end += sprintf(end, "%g,%g,%g,.01,%.17g\n", .01 + .02 * (i % WIDE), .01 + .02 * (i / WIDE % WIDE),
                               .01 + .02 * (i / LAYER), gas);
        }
        assert_near(of_gas(q, 1), gas, 1e-12);
        assert_near(of_gas(q, 2), all, 1e-12);
        SUCCEED("heat", write_file("given.csv", text), "--length-unit", "m", "--ambient", "900", "--emissivity", "0.8",
                "--power", "3", "--convection", "60", "--gas-temperature", "g", "--contacts", "hertz",
                "--gas-conductivity", "0.05", "--contact-conductivity", "2", "-o", q);
        values_of(q, 1, N, again);
        for (int i = 0; i < N; ++i) ck_assert_double_eq_tol(again[i], t[i], .02);
    }
}

/* A stream along another axis, or the other way, is the same in a bed that is turned. */
TEST(directions_of_a_stream) {
    const char *q = in_folder("q.csv");
    SUCCEED(RADIATES, AIR, "1100", "-o", q);
    const double outlet = of_gas(q, 1);
    SUCCEED(RADIATES, "--gas-temperature", "300", "--gas-flow", "-z:0.4", "--gas-heat-capacity", "1100", "-o", q);
    ck_assert_double_eq_tol(of_gas(q, 1), outlet, .02 * (outlet - 300)); /* the bed is symmetric, its beams are not */
    SUCCEED(RADIATES, "--gas-temperature", "300", "--gas-flow", "x:0.4", "--gas-heat-capacity", "1100", "-o", q);
    ck_assert_uint_eq((unsigned)value_of("gas_slices"), WIDE);
    assert_near(value_of("gas_section_m2"), .06 * .16, 1e-5);
}

/* Beside whatever else a bed has, energy is kept. */
TEST(pairs) {
    static const char *const more[][4] = {{"--solid-conductivity", "0.5"},
                                          {"--irradiate", "1,0,0:20000"},
                                          {"--periodic", "0.06,0.06,0"},
                                          {"--wall", "zmin:open,zmax:open,cylinder:0.03,0.03,0.06:temperature=700"},
                                          {"--wall",
                                           "zmin:open:at=0,zmax:open:at=.16,xmin:at=0:power=4:convection=20:gas=400,"
                                           "xmax:at=.06:insulated,ymin:at=0:temperature=600,ymax:at=.06:"
                                           "temperature=500"}};
    const char *q = in_folder("q.csv");
    for (size_t k = 0; k < sizeof more / sizeof *more; ++k) {
        SUCCEED(RADIATES, AIR, "1100", more[k][0], more[k][1], "-o", q);
        ck_assert_double_lt(fabs(value_of("balance_of_emission")), 1e-12);
        SUCCEED(BED, "--emissivity", "0.8", "--convection", "60", AIR, "1100", more[k][0], more[k][1], "--temperature",
                "400", "--until", "20", "--density", "2500", "--heat-capacity", "800", "-o", q);
        ck_assert_double_lt(fabs(value_of("balance_of_stored")), 1e-12);
    }
}

/* An inlet that follows a table: late in time the bed follows it, and what the gas has lost is stored. */
TEST(inlet_in_time) {
    const char *q = in_folder("q.csv"), *inlet = write_file("inlet.csv", "t,T\n0,300\n600,700\n");
    SUCCEED(BED, "--emissivity", "0", "--temperature", "300", "--convection", "60", "--gas-flow", "z:0.4",
            "--gas-heat-capacity", "1100", "--gas-temperature", formatted("@%s", inlet), "--until", "3600", "--density",
            "2500", "--heat-capacity", "800", "-o", q);
    ck_assert_double_eq_tol(value_of("temperature_min_K"), 700, .1);
    assert_near(value_of("gas_J"), -value_of("stored_J"), 1e-5);
    assert_near(value_of("stored_J"), N * 2500 * 800 * 4. / 3 * PI * 1e-6 * (value_of("temperature_mean_K") - 300),
                1e-5);
}

/* Coefficients of Wakao and Kaguei, and of Gunn: a sphere of given temperature loses h A (T - T_gas). */
TEST(correlations) {
    const char *q = in_folder("q.csv");
    const double re = .5 * .02 / 1.85e-5, pr = 1005 * 1.85e-5 / .026, e = 1 - PI / 6;
    const double expected[2] = {2 + 1.1 * cbrt(pr) * pow(re, .6),
                                (7 - 10 * e + 5 * e * e) * (1 + .7 * pow(re, .2) * cbrt(pr)) +
                                    (1.33 - 2.4 * e + 1.2 * e * e) * pow(re, .7) * cbrt(pr)};
    for (int k = 0; k < 2; ++k) {
        double t, convected;
        SUCCEED(BED, "--emissivity", "0.8", "--temperature", "600", "--convection",
                k ? "gunn:0.026,1.85e-5" : "wakao:0.026,1.85e-5", "--gas-flow", "z:0.5", "--gas-heat-capacity", "1005",
                "--gas-temperature", "300", "-o", q);
        const double h = expected[k] * .026 / .02, flow = .5 * .06 * .06 * 1005 / LAYER;
        values_of(q, 6, 1, &convected);
        t = 300 + 300 * h * AREA / (flow + h * AREA); /* of the first slice */
        assert_near(convected, h * AREA * (t - 600), 1e-9);
        assert_near(value_of("convection_W_m2K"), h, 1e-5);
    }
}

TEST(at_fault) {
#define HOT BED, "--emissivity", "1", "--temperature", "600", "--gas-temperature", "300"
    FAIL_WITH(2, HOT, "--gas-flow", "z:1", "--gas-heat-capacity", "1000");
    expect_message("--gas-flow needs --convection", "");
    FAIL_WITH(2, HOT, "--convection", "9", "--gas-flow", "z:1");
    expect_message("--gas-flow needs --gas-heat-capacity", "");
    FAIL_WITH(2, HOT, "--convection", "9", "--gas-heat-capacity", "1000");
    expect_message("--gas-heat-capacity needs --gas-flow", "");
    FAIL_WITH(2, HOT, "--convection", "wakao:1,1");
    expect_message("--convection wakao needs --gas-flow", "");
    FAIL_WITH(2, HOT, "--convection", "gunn:0.03", "--gas-flow", "z:1", "--gas-heat-capacity", "1000");
    expect_message("--convection: gunn:0.03 is not gunn:K,MU", "");
    FAIL_WITH(2, HOT, "--gas-flow", "w:1");
    expect_message("--gas-flow: w:1 is not AXIS:G", "");
    FAIL_WITH(2, HOT, "--gas-flow", "z:-1");
    expect_message("--gas-flow", "-1");
#define FLOWS HOT, "--convection", "9", "--gas-flow", "z:1", "--gas-heat-capacity", "1000"
    FAIL_WITH(2, FLOWS, "--periodic", "0,0,.16");
    expect_message("--gas-flow: the bed is periodic along z", "");
    FAIL_WITH(2, FLOWS, "--wall", "box:temperature=300,zmax:open");
    expect_message("--gas-flow: a wall closes the bed at zmin; --wall zmin:open lets the gas through", "");
    FAIL_WITH(2, FLOWS, "--wall", "zmin:open,zmax:open,cylinder:.03,.03,.06:convection=5:temperature=400");
    expect_message("--wall: cylinder has convection and needs the temperature of its gas", "");
    FAIL_WITH(3, HOT, "--convection", "wakao:0.026,1.85e-5", "--gas-flow", "z:.001", "--gas-heat-capacity", "1000");
    expect_message(in_folder("columns.csv"),
                   "--convection wakao: is for Reynolds numbers of 15 to 8500, and sphere 0 has 1.08");
    FAIL_WITH(2, BED, "--emissivity", "1", "--temperature", "600", "--gas-temperature", "1:300", "--convection", "9",
              "--gas-flow", "z:1", "--gas-heat-capacity", "1000");
    expect_message("--gas-flow: --gas-temperature is that of the inlet", "");
}
