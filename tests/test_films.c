/* test_films.c - heat to gas of a given temperature, against closed forms and an own Newton solution.
 * SPDX-License-Identifier: MIT */
#include <gsl/gsl_integration.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_sf_legendre.h>

#include "host_owned.h"
#include "program.h"
#include "scenes.h"

FIXTURE(make_folder, remove_folder)

#define PI    3.14159265358979323846
#define SIGMA FIBRAD_STEFAN_BOLTZMANN

static double fourth(double t) { return t * t * t * t; }

/* Column k of line i of a .csv, both from 0. */
static double column(const char *file, int i, int k) {
    char *at = read_file(file);
    for (int line = 0; line <= i; ++line) ck_assert_ptr_nonnull(at = strchr(at, '\n') + 1);
    for (int c = 0; c < k; ++c) ck_assert_ptr_nonnull(at = strchr(at, ',') + 1);
    return strtod(at, NULL);
}

static const char *ball(void) { return write_file("one.csv", "x,y,z,r\n0,0,0,0.01\n"); }

/* Of 1 cm: its area. */
#define AREA  (4 * PI * 1e-4)
#define GAS   "--convection", "25", "--gas-temperature", "350"
#define ALONE "heat", ball(), "--length-unit", "m", "--ambient", "300"

/* A sphere in black surroundings: all powers are known. */
TEST(one_sphere) {
    const char *q = in_folder("q.csv");
    SUCCEED(ALONE, "--emissivity", "0.7", "--power", "3", GAS, "-o", q);
    const double t = column(q, 0, 1), convected = 25 * AREA * (350 - t);
    assert_near(.7 * SIGMA * AREA * (fourth(t) - fourth(300)) - convected, 3, 1e-9);
    assert_near(column(q, 0, 2), -3, 1e-9);
    assert_near(column(q, 0, 6), convected, 1e-9);
    assert_near(column(q, 2, 2), -convected, 1e-9);
    assert_near(value_of("gas_W"), -convected, 1e-5);
    assert_begins(read_file(q), "i,T_K,q_W,q_error_W,T_error_K,q_radiation_W,q_convection_W,body\n");
    assert_has(read_file(q), ",gas\n");
    SUCCEED(ALONE, "--emissivity", "0.7", "--temperature", "500", GAS, "-o", q);
    assert_near(column(q, 0, 2), .7 * SIGMA * AREA * (fourth(300) - fourth(500)) + 25 * AREA * (350 - 500), 1e-9);
    SUCCEED(ALONE, "--emissivity", "0", "--power", "0", "--temperature-unit", "C", "--convection", "25",
            "--gas-temperature", "26.85", "-o", q);
    assert_near(column(q, 0, 1), 300, 1e-9);
}

/* A chain of spheres that reflect everything, between plates: a ladder of resistances. */
TEST(a_ladder) {
    enum { SPHERES = 7 };
    char text[2000] = "x,y,z,r\n", links[2000] = "i,j,W/K\nzmin,0,0.5\n6,zmax,0.7\n";
    double matrix[SPHERES * SPHERES] = {0}, right[SPHERES];
    const double film = 30 * AREA, to_plate[2] = {.5, .7}, plate[2] = {800, 400}, along = .3;
    for (int i = 0; i < SPHERES; ++i) {
        snprintf(text + strlen(text), 60, "0,0,%g,0.01\n", .01 + .02 * i);
        if (i > 0) snprintf(links + strlen(links), 60, "%d,%d,%g\n", i - 1, i, along);
        matrix[i * SPHERES + i] = film + (i > 0 ? along : to_plate[0]) + (i + 1 < SPHERES ? along : to_plate[1]);
        if (i > 0) matrix[i * SPHERES + i - 1] = matrix[(i - 1) * SPHERES + i] = -along;
        right[i] = film * 350 + (i == 0) * to_plate[0] * plate[0] + (i + 1 == SPHERES) * to_plate[1] * plate[1];
    }
    gsl_matrix_view m = gsl_matrix_view_array(matrix, SPHERES, SPHERES);
    gsl_vector_view b = gsl_vector_view_array(right, SPHERES);
    gsl_linalg_HH_svx(&m.matrix, &b.vector);
    const char *q = in_folder("q.csv");
    SUCCEED("heat", write_file("chain.csv", text), "--length-unit", "m", "--ambient", "300", "--emissivity", "0",
            "--power", "0", "--wall", "zmin:at=0:temperature=800,zmax:at=0.14:temperature=400", "--contacts",
            write_file("links.csv", links), "--convection", "30", "--gas-temperature", "350", "-o", q);
    double sum = 0;
    for (int i = 0; i < SPHERES; ++i) {
        assert_near(column(q, i, 1), right[i], 1e-9);
        sum += film * (right[i] - 350);
    }
    assert_near(column(q, SPHERES + 3, 2), sum, 1e-9);
}

/* Without radiation a sphere follows the gas: at once an exponential, then a ramp. What it loses the gas gains. */
TEST(cooling_and_following) {
    const char *q = in_folder("q.csv");
    const double rate = 25 * AREA / (800 * 2500 * 4. / 3 * PI * 1e-6);
#define STORED "--emissivity", "0", "--heat-capacity", "800", "--density", "2500", "--until", "100", "-o", q
    SUCCEED(ALONE, STORED, "--temperature", "500", GAS);
    ck_assert_double_eq_tol(column(q, 0, 2), 350 + 150 * exp(-rate * 100), .01);
    ck_assert_double_lt(fabs(value_of("balance_of_stored")), 1e-12);
    SUCCEED(ALONE, STORED, "--temperature", "500", GAS, "--step", "0.5");
    ck_assert_double_eq_tol(column(q, 0, 2), 350 + 150 * exp(-rate * 100), 1e-4);
    SUCCEED(ALONE, STORED, "--temperature", "300", "--step", "0.5", "--convection", "25", "--gas-temperature",
            formatted("@%s", write_file("gas.csv", "t,T\n0,300\n100,500\n")));
    ck_assert_double_eq_tol(column(q, 0, 2), 300 + 2 * (100 - (1 - exp(-rate * 100)) / rate), 1e-4);
    ck_assert_double_lt(fabs(value_of("balance_of_stored")), 1e-12);
    assert_near(value_of("gas_J"), -value_of("stored_J"), 1e-5);
}

/* A wall that emits nothing and gives off a power warms the gas alone. Others have no film. */
TEST(walls) {
    const char *q = in_folder("q.csv");
    SUCCEED("heat", ball(), "--length-unit", "m", "--emissivity", "0.5", "--temperature", "400", "--wall",
            "box:temperature=400,xmin:at=-0.02:power=2:emissivity=0:convection=40:gas=310,xmax:at=0.02:temperature=400,"
            "ymin:at=-0.02:temperature=400,ymax:at=0.02:temperature=400,zmin:at=-0.02:temperature=400,zmax:at=0.02:"
            "temperature=400",
            "-o", q);
    assert_near(value_of("wall_xmin_K"), 310 + 2 / (40 * .0016), 1e-9);
    assert_near(value_of("gas_W"), 2, 1e-9);
    assert_near(value_of("wall_xmin_convection_W"), -2, 1e-9);
}

/* Sums of degree l up to 60 for a sphere between black plates of 600 and 1000 K. T: of the mean. Returns the
 * temperature of the pole that faces the hotter plate. */
static double pole(double k, double e, double h, double gas, double *t) {
    const double r = .01;
    gsl_integration_glfixed_table *table = gsl_integration_glfixed_table_alloc(100);
    double mean = 0, top = 0, mu, weight;
    for (int pass = 0; pass < 2; ++pass) {
        for (int l = pass ? 1 : 0; l < (pass ? 60 : 1); ++l) {
            double sum = 0;
            for (size_t p = 0; p < 100; ++p) {
                gsl_integration_glfixed_point(-1, 1, p, &mu, &weight, table);
                sum +=
                    weight * SIGMA * (fourth(1000) * (1 + mu) + fourth(600) * (1 - mu)) / 2 * gsl_sf_legendre_Pl(l, mu);
            }
            const double arrives = (2 * l + 1) / 2. * sum;
            if (pass == 0)
                mean = arrives;
            else
                top += e * arrives / (k * l / r + 4 * e * SIGMA * *t * *t * *t + h);
        }
        for (int step = 0; step < 50 && pass == 0; ++step)
            *t += (e * (mean - SIGMA * fourth(*t)) + h * (gas - *t)) / (4 * e * SIGMA * *t * *t * *t + h);
    }
    gsl_integration_glfixed_table_free(table);
    return *t + top;
}

/* A film evens out the surface of a sphere that conducts, and the centre is P/(8 pi k R) above it. */
TEST(spheres_that_conduct) {
    static const double cases[][2] = {{2, 50}, {.5, 200}, {.5, 1000}, {20, 100}};
    const char *q = in_folder("q.csv");
    for (size_t c = 0; c < 4; ++c) {
        const double k = cases[c][0], h = cases[c][1];
        double t = 800, bare = 800;
        const double top = pole(k, .8, h, 500, &t), without = pole(k, .8, 0, 500, &bare);
        SUCCEED("heat", ball(), "--length-unit", "m", "--ambient", "800", "--emissivity", "0.8", "--power", "0",
                "--wall", "zmin:at=-0.012:temperature=600,zmax:at=0.012:temperature=1000", "--directions", "1000",
                "--solid-conductivity", formatted("%g", k), "--convection", formatted("%g", h), "--gas-temperature",
                "500", "-o", q);
        ck_assert_double_eq_tol(column(q, 0, 1), t, .1);
        ck_assert_double_eq_tol(column(q, 0, 6), top, .04 * (top - t));
        ck_assert_double_lt(fabs(column(q, 0, 6) - top), 2 * column(q, 0, 7));
        ck_assert_double_lt(top - t, without - bare);
    }
    SUCCEED(ALONE, "--emissivity", "0.7", "--power", "30", GAS, "--solid-conductivity", "2", "-o", q);
    assert_near(column(q, 0, 8) - column(q, 0, 1), 30 / (8 * PI * 2 * .01), 1e-9);
}

/* Forty unequal spheres with contacts, gas in gaps, films and powers in a grey box. The own solution takes exchange
 * factors by paths for the radiation, which share nothing with patches. */
enum { N = 40, WALLS = 6 };
TEST(a_room) {
    OWNED_BY(bed_free) struct bed bed = packing(N, .3, 1, .3, 11, false);
    const fibrad_spheres spheres = spheres_of(&bed);
    double emissivity[N], power[N], film[N], gas[N], unknown[N], area[N], solid[N], found[N], error[N], power_out[N],
        t[N];
    double wall_temperature[WALLS], wall_emissivity[WALLS], wall_power[WALLS], convected[N];
    fibrad_wall wall[WALLS];
    for (int k = 0; k < WALLS; ++k) {
        const double *at = k / 2 == 0 ? bed.x : k / 2 == 1 ? bed.y : bed.z;
        double end = at[0];
        for (int i = 0; i < N; ++i) end = k % 2 ? fmax(end, at[i] + bed.r[i]) : fmin(end, at[i] - bed.r[i]);
        wall[k] = (fibrad_wall){.kind = FIBRAD_WALL_PLANE, .plane = {k / 2, k % 2, end}};
        wall_temperature[k] = 500 + 100 * k, wall_emissivity[k] = .4 + .1 * k;
    }
    for (int i = 0; i < N; ++i) {
        emissivity[i] = .3 + .6 * (i * 7 % N) / N, area[i] = 4 * PI * bed.r[i] * bed.r[i];
        power[i] = 3000 * (i % 3), unknown[i] = NAN, solid[i] = 20, t[i] = 700;
        film[i] = i % 4 == 0 ? 0 : 8. * (i % 5) * area[i], gas[i] = 400 + 10 * i;
    }
    const fibrad_scene_config scene = {.wall = wall, .walls = WALLS};
    OWNED_MADE *made = NULL;
    assert_ok(made_with(&made, &scene, &spheres, &(fibrad_heat_config){.directions = 1000}, NULL));
    const fibrad_contact_rule rule = {.spots = FIBRAD_SPOTS_HERTZ, .gas_reach = .5};
    const fibrad_contact_list *list;
    assert_ok(fibrad_bed_contacts(made, &rule, &list));
    double *conductance = malloc((2 * list->n + 1) * sizeof *conductance);
    for (uint32_t k = 0; k < list->n; ++k) conductance[list->n + k] = .5;
    assert_ok(fibrad_contacts_conduct(list, &rule, solid, conductance + list->n, conductance));
    ck_assert_uint_gt(list->n, N);
    fibrad_heat_sources s;
    fibrad_heat_sources_init(&s);
    s.temperature = unknown, s.emissivity = emissivity, s.power = power, s.film = film, s.gas = gas, s.surroundings = 0;
    s.wall_temperature = wall_temperature, s.wall_emissivity = wall_emissivity;
    s.contact_first = list->first, s.contact_second = list->second, s.conductance = conductance, s.contacts = list->n;
    fibrad_heat_result result = {.power = power_out,
                                 .wall_power = wall_power,
                                 .temperature = found,
                                 .temperature_error = error,
                                 .convected = convected};
    assert_ok(fibrad_bed_solve(made, &s, NULL, &result));
    OWNED_FACTORS *d = NULL;
    const fibrad_exchange_rule paths = {
        .emissivity = emissivity, .wall_emissivity = wall_emissivity, .paths = 32768, .directions = 4096};
    assert_ok(exchange_of(&scene, &spheres, &paths, NULL, NULL, &d));
    for (int step = 0; step < 30; ++step) {
        double matrix[N * N] = {0}, right[N];
        for (int i = 0; i < N; ++i) {
            const double a = SIGMA * area[i] * emissivity[i], slope = 4 * t[i] * t[i] * t[i];
            right[i] = power[i] + film[i] * (gas[i] - t[i]), matrix[i * N + i] = film[i];
            for (uint64_t k = d->matrix.start[i]; k < d->matrix.start[i + 1]; ++k) {
                const uint32_t j = d->matrix.col[k];
                right[i] += a * d->matrix.f[k] * (fourth(t[j]) - fourth(t[i]));
                matrix[i * N + i] += a * d->matrix.f[k] * slope;
                matrix[(uint32_t)i * N + j] -= a * d->matrix.f[k] * 4 * t[j] * t[j] * t[j];
            }
            for (int k = 0; k < WALLS; ++k) {
                const double f = a * d->matrix.wall[i * WALLS + k];
                right[i] += f * (fourth(wall_temperature[k]) - fourth(t[i])), matrix[i * N + i] += f * slope;
            }
        }
        for (uint32_t k = 0; k < list->n; ++k) {
            const uint32_t end[2] = {list->first[k], list->second[k]};
            for (int e = 0; e < 2; ++e) {
                const uint32_t i = end[e], j = end[1 - e];
                if (i >= N) continue;
                right[i] += conductance[k] * ((j < N ? t[j] : wall_temperature[j - N]) - t[i]);
                matrix[i * N + i] += conductance[k];
                if (j < N) matrix[i * N + j] -= conductance[k];
            }
        }
        gsl_matrix_view m = gsl_matrix_view_array(matrix, N, N);
        gsl_vector_view b = gsl_vector_view_array(right, N);
        gsl_linalg_HH_svx(&m.matrix, &b.vector);
        for (int i = 0; i < N; ++i) t[i] += right[i];
    }
    free(conductance);
    double sum = result.surroundings_power + result.gas_power, largest = 0;
    for (int i = 0; i < N; ++i) {
        ck_assert_double_lt(fabs(found[i] - t[i]), .2 + 2 * error[i]);
        assert_near(convected[i], film[i] * (gas[i] - found[i]), 1e-9);
        sum += power_out[i], largest = fmax(largest, fabs(power_out[i]));
    }
    for (int k = 0; k < WALLS; ++k) sum += wall_power[k], largest = fmax(largest, fabs(wall_power[k]));
    ck_assert_double_lt(fabs(sum), 1e-12 * largest);
}

/* In closed beds only contacts or films fix the level of temperatures. All that is given off leaves through them. */
TEST(closed_beds_lose_all_powers) {
    const char *q = in_folder("q.csv"),
               *bed = write_file("closed.csv", "x,y,z,r,e,T,P\n0,0,0,.01,.8,,5\n.03,0,0,.01,.7,,0\n"
                                               "0,.03,0,.01,.5,,2\n.03,.03,0,.01,0,600,\n");
#define CLOSED                                                                                                         \
    "heat", bed, "--length-unit", "m", "--emissivity", "e", "--power", "P", "-o", q, "--wall",                         \
        "xmin:at=-.02:insulated,xmax:at=.05:insulated,ymin:at=-.02:insulated,ymax:at=.05:insulated,"                   \
        "zmin:at=-.02:insulated,zmax:at=.02:insulated"
    SUCCEED(CLOSED, "--temperature", "T", "--contacts", write_file("held.csv", "i,j,W/K\n0,3,.1\n1,0,.2\n2,1,.1\n"));
    assert_near(column(q, 0, 1), 600 + 7 / .1, 1e-10);
    assert_near(column(q, 3, 2), 7, 1e-10);
    bed = write_file("free.csv", "x,y,z,r,e,P\n0,0,0,.01,.8,5\n.03,0,0,.01,.7,0\n0,.03,0,.01,.5,2\n");
    SUCCEED(CLOSED, "--convection", "20", "--gas-temperature", "300");
    assert_near(column(q, 9, 2), 7, 1e-10);
    assert_near(column(q, 0, 1) + column(q, 1, 1) + column(q, 2, 1), 900 + 7 / (20 * AREA), 1e-9);
}

TEST(at_fault) {
    FAIL_WITH(2, ALONE, "--emissivity", "1", "--power", "0", "--convection", "5");
    expect_message("--convection needs --gas-temperature", "");
    FAIL_WITH(2, ALONE, "--emissivity", "1", "--power", "0", "--gas-temperature", "500");
    expect_message("--gas-temperature needs --convection", "");
    FAIL_WITH(2, ALONE, "--emissivity", "1", "--power", "0", "--convection", "5", "--gas-temperature", "@gas.csv");
    expect_message("--gas-temperature", "tables are for --until");
    FAIL_WITH(2, ALONE, "--emissivity", "1", "--power", "0", "--convection", "-5", "--gas-temperature", "500");
    expect_message("--convection", "-5");
    FAIL_WITH(2, ALONE, "--emissivity", "1", "--power", "0", GAS, "--wall", "zmin:at=-1:temperature=300:convection=3");
    expect_message("--wall: zmin is endless and has no convection", "");
    FAIL_WITH(2, ALONE, "--emissivity", "1", "--power", "0", "--wall", "zmin:at=-1:temperature=300:gas=3");
    expect_message("--wall: gas needs convection", "");
    FAIL_WITH(2, "heat", ball(), "--emissivity", "1", "--power", "0", "--ambient", "300", GAS);
    expect_message(ball(), "which --convection needs");
    const fibrad_spheres spheres = {
        .x = (double[]){0}, .y = (double[]){0}, .z = (double[]){0}, .r = (double[]){1}, .n = 1};
    OWNED_MADE *made = NULL;
    assert_ok(made_with(&made, NULL, &spheres, NULL, NULL));
    fibrad_heat_sources s;
    fibrad_heat_sources_init(&s);
    double t = NAN, e = 1, p = 0, power;
    s.temperature = &t, s.emissivity = &e, s.power = &p, s.surroundings = 300;
    static const double wrong[][2] = {{-1, 300}, {NAN, 300}, {INFINITY, 300}, {1, -1}, {1, NAN}};
    for (size_t k = 0; k < 5; ++k) {
        fibrad_fault fault;
        s.film = &wrong[k][0], s.gas = &wrong[k][1];
        ck_assert_int_eq(fibrad_bed_solve(made, &s, NULL, &(fibrad_heat_result){.power = &power}), FIBRAD_E_ARGUMENT);
        fibrad_bed_describe(made, NULL, &fault);
        ck_assert_int_eq(fault.why, FIBRAD_WHY_FILM);
        ck_assert_uint_eq(fault.first, 0);
    }
}
