/* test_stored.c - heat that is stored: tables, melting, walls with a capacity, spheres that are held. Against closed
 * forms, quadrature and GSL's differential equations. SPDX-License-Identifier: MIT */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_odeiv2.h>

#include "host_owned.h"
#include "program.h"
#include "scenes.h"

FIXTURE(make_folder, remove_folder)

#define PI    3.14159265358979323846
#define SIGMA FIBRAD_STEFAN_BOLTZMANN

/* What a sphere alone and a floor see needs few beams. */
static const fibrad_heat_config few = {.directions = 24, .points = 64, .patches = 24, .wall_rays = 20000};

static double fourth(double t) { return t * t * t * t; }

/* ---- one sphere ------------------------------------------------------------------------------------------------- */

/* A sphere of radius R in black surroundings, with a power and a film. */
#define R 0.01
struct lump {
    fibrad_store store;
    double mass, emissivity, power, around, film, gas;
};

static double area(void) { return 4 * PI * R * R; }

/* The specific heat, straight from the rows. */
static double specific(const fibrad_store *s, double t) {
    uint32_t k = 1;
    if (s->rows < 2) return s->rows ? s->capacity[0] : 1;
    while (k + 1 < s->rows && s->temperature[k] < t) ++k;
    const double share = (t - s->temperature[k - 1]) / (s->temperature[k] - s->temperature[k - 1]);
    return s->capacity[k - 1] + share * (s->capacity[k] - s->capacity[k - 1]);
}

static double gained(const struct lump *l, double t) {
    return l->power + l->emissivity * SIGMA * area() * (fourth(l->around) - fourth(t)) + l->film * (l->gas - t);
}

/* Seconds for each kelvin. */
static double slowness(double t, void *lump) {
    const struct lump *l = lump;
    const fibrad_store *s = &l->store;
    const bool melts = s->width > 0 && fabs(t - s->melting) < s->width / 2;
    return l->mass * (specific(s, t) + (melts ? s->latent / s->width : 0)) / gained(l, t);
}

/* The time from one temperature to another, without a melting point in between. Rows of the table are ends of parts. */
static double time_of(struct lump *l, double from, double to) {
    static const double parts[] = {0, 400, 600, 900, 990, 999.9995, 1000.0005, 1010, 1400, 5000};
    gsl_integration_workspace *work = gsl_integration_workspace_alloc(1000);
    gsl_function f = {slowness, l};
    const double low = fmin(from, to), high = fmax(from, to);
    double sum = 0, value, error;
    for (int k = 0; k + 1 < (int)(sizeof parts / sizeof *parts); ++k) {
        const double a = fmax(low, parts[k]), b = fmin(high, parts[k + 1]);
        if (!(a < b)) continue;
        gsl_integration_qag(&f, a, b, 0, 1e-12, 1000, GSL_INTEG_GAUSS61, work, &value, &error);
        sum += value;
    }
    gsl_integration_workspace_free(work);
    return from < to ? sum : -sum;
}

/* Advances a sphere in several spans. Energy closes in each one. Returns the steps. */
static uint64_t advance(const struct lump *l, double duration, int spans, double tolerance, double *temperature,
                        double *melted) {
    OWNED_BED bed = BED({0, 0, 0, R});
    const fibrad_spheres spheres = spheres_of(&bed);
    OWNED_MADE *made = NULL;
    uint64_t steps = 0;
    assert_ok(made_with(&made, NULL, &spheres, &few, &(fibrad_run){.threads = 1}));
    fibrad_heat_sources s;
    fibrad_heat_sources_init(&s);
    s.emissivity = &l->emissivity, s.power = &l->power, s.surroundings = l->around, s.film = &l->film, s.gas = &l->gas;
    for (int k = 0; k < spans; ++k) {
        double stored;
        fibrad_span span = {temperature, &l->mass, duration / spans, .tolerance = tolerance, .melted = melted};
        span.store = &l->store, span.stores = 1, span.stored = &stored;
        assert_ok(fibrad_bed_advance(made, &s, &span));
        const double supplied = l->power * span.duration, lost = span.surroundings_energy + span.gas_energy;
        ck_assert_double_le(fabs(supplied - lost - stored), 1e-12 * (fabs(supplied) + fabs(lost)));
        steps += span.steps + span.refused;
    }
    return steps;
}

/* A black sphere at constant power is at the melting point, or within the melting range, for as long as the balance
 * says. What it stores is what its temperatures and its melted part say. */
LOOP_TEST(melting_at_constant_power, 4) {
    static const double width[] = {0, 0, 1e-3, 20}, power[] = {100, -40, 100, 100}, begin[] = {900, 1100, 900, 900};
    const double t[] = {300, 600, 1400}, c[] = {700, 650, 900};
    struct lump l = {.store = {t, c, 3, 1000, 2e5, width[_i]}, .mass = .01, .emissivity = 1, .power = power[_i]};
    l.around = 300;
    const double low = 1000 - width[_i] / 2, high = 1000 + width[_i] / 2, net = gained(&l, 1000);
    const double to_range = time_of(&l, begin[_i], net > 0 ? low : high);
    const double within = width[_i] > 0 ? time_of(&l, low, high) : l.mass * l.store.latent / fabs(net);
    double temperature = begin[_i], melted = NAN, half, last, at_end;
    advance(&l, to_range + within / 2, 3, 1e-8, &temperature, &melted);
    half = melted;
    ck_assert_double_eq_tol(temperature, 1000, width[_i] / 10 + 1e-12);
    ck_assert(half > .45 && half < .55);
    if (width[_i] == 0) ck_assert_double_eq_tol(half, .5, 1e-6);
    /* in the range for the rest of the time, and then on */
    advance(&l, within / 2 * .96, 2, 1e-8, &temperature, &melted);
    last = melted;
    if (width[_i] == 0) assert_near((last - half) * l.mass * l.store.latent / net, .48 * within, 1e-6);
    ck_assert_double_eq_tol(temperature, 1000, width[_i] / 2 + 1e-12);
    advance(&l, within / 2 * .04 + 3, 1, 1e-8, &temperature, &melted);
    ck_assert(melted == (net > 0));
    at_end = time_of(&l, net > 0 ? high : low, temperature);
    ck_assert_double_eq_tol(at_end, 3, 1e-6 * within);
}

/* The default steps are few, and equal steps of any length serve as well. */
TEST(steps_while_melting) {
    const struct lump l = {
        .store = {.latent = 3e5, .melting = 1000, .rows = 1, .temperature = (double[]){1}, .capacity = (double[]){800}},
        .mass = .01,
        .emissivity = 1,
        .power = 100,
        .around = 300};
    double temperature = 900, melted = NAN;
    ck_assert_uint_lt(advance(&l, 200, 1, 0, &temperature, &melted), 90);
    const double expected = temperature;
    for (int k = 0; k < 2; ++k) {
        SUCCEED("heat", write_file("one.csv", "x,y,z,r\n0,0,0,0.01\n"), "--length-unit", "m", "--emissivity", "1",
                "--temperature", "900", "--ambient", "300", "--power", "100", "--until", "200", "--heat-capacity",
                "800", "--density", formatted("%.17g", .01 / (4. / 3 * PI * R * R * R)), "--melting", "1000,3e5",
                "--step", k ? "10" : "1");
        ck_assert_double_eq_tol(value_of("temperature_max_K"), expected, k ? 1 : .1);
    }
    ck_assert(value_of("steps") == 20);
    ck_assert_double_le(fabs(value_of("balance_of_stored")), 1e-12);
}

/* Heated at constant power without radiation, the integral of c(T) is a power times a time. */
TEST(table_at_constant_power) {
    const double t[] = {300, 500, 1500}, c[] = {500, 900, 1100};
    struct lump l = {.store = {t, c, 3, 0, 0, 0}, .mass = .02, .power = 40};
    double temperature = 350;
    advance(&l, 300, 2, 0, &temperature, NULL);
    const double heat = 40 * 300 / .02 - (.5 * (600 + 900) * 150), s = 200. / 1000;
    const double expected = 500 + 2 * heat / (900 + sqrt(900 * 900 + 2 * s * heat));
    assert_near(temperature, expected, 1e-13);
    const char *q = in_folder("q.csv"), *one = write_file("one.csv", "x,y,z,r,type\n0,0,0,0.01,1\n1,0,0,0.01,2\n");
    const char *table = write_file("c.csv", "T [C],c [kJ/(kg K)]\n26.85,0.5\n226.85,0.9\n1226.85,1.1\n");
    SUCCEED("heat", one, "--length-unit", "m", "--emissivity", "0", "--temperature", "350", "--ambient", "300",
            "--power", "40", "--until", "300", "--heat-capacity", formatted("1:@%s,2:800", table), "--density",
            formatted("%.17g", .02 / (4. / 3 * PI * R * R * R)), "-o", q);
    double found[2];
    ck_assert_int_eq(sscanf(read_file(q), "time_s,i,T_K%*[^\n]\n300,0,%lf%*[^\n]\n300,1,%lf", found, found + 1), 2);
    assert_near(found[0], expected, 1e-12);
    assert_near(found[1], 350 + 40 * 300 / (.02 * 800), 1e-12);
    one = write_file("two.csv", "x,y,z,r,c\n0,0,0,0.01,inf\n1,0,0,0.01,800\n");
    SUCCEED("heat", one, "--length-unit", "m", "--emissivity", "0", "--temperature", "350", "--ambient", "300",
            "--power", "40", "--until", "300", "--heat-capacity", "c", "--density",
            formatted("%.17g", .02 / (4. / 3 * PI * R * R * R)), "-o", q);
    ck_assert_int_eq(sscanf(read_file(q), "time_s,i,T_K%*[^\n]\n300,0,%lf%*[^\n]\n300,1,%lf", found, found + 1), 2);
    ck_assert(found[0] == 350 && value_of("held_J") == 12000);
    assert_near(found[1], 350 + 40 * 300 / (.02 * 800), 1e-12);
}

static int cool(double time, const double t[], double slope[], void *lump) {
    (void)time;
    slope[0] = 1 / slowness(t[0], lump);
    return GSL_SUCCESS;
}

/* The value of one equation after a time. */
static double solved(int (*f)(double, const double *, double *, void *), void *context, double from, double duration) {
    gsl_odeiv2_system system = {f, NULL, 1, context};
    gsl_odeiv2_driver *driver = gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk8pd, 1e-3, 1e-12, 1e-13);
    double time = 0;
    ck_assert_int_eq(gsl_odeiv2_driver_apply(driver, &time, duration, &from), GSL_SUCCESS);
    gsl_odeiv2_driver_free(driver);
    return from;
}

/* Cooled by gas, with and without radiation. */
TEST(table_cooled_by_gas) {
    const double t[] = {250, 400, 900, 1300}, c[] = {600, 700, 1000, 800};
    for (int k = 0; k < 2; ++k) {
        struct lump l = {
            .store = {t, c, 4, 0, 0, 0}, .mass = .02, .film = .05, .gas = 290, .around = 500, .emissivity = k};
        double temperature = 1250;
        advance(&l, 400, 2, 1e-8, &temperature, NULL);
        assert_near(temperature, solved(cool, &l, 1250, 400), 1e-7);
    }
}

/* ---- walls and spheres that are held ---------------------------------------------------------------------------- */

/* A wall beside a sphere that is held. Net powers of the wall are linear in fourth powers of temperatures. */
struct held {
    double of[3], temperature, around, capacity, power, film, gas;
};

static int warm(double time, const double t[], double slope[], void *held) {
    const struct held *h = held;
    (void)time;
    slope[0] = (h->power + h->of[0] * fourth(h->temperature) + h->of[1] * fourth(t[0]) + h->of[2] * fourth(h->around) +
                h->film * (h->gas - t[0])) /
               h->capacity;
    return GSL_SUCCESS;
}

/* A floor that stores heat, between a held sphere and the surroundings, with a power and a film of its own. */
LOOP_TEST(wall_stores, by_night(2, 1)) {
    struct held h = {.temperature = 1000, .around = 400, .capacity = 300, .power = 50, .film = 2};
    OWNED_BED bed = BED({0, 0, 0, .1});
    const fibrad_spheres spheres = spheres_of(&bed);
    const fibrad_wall floor = {.kind = FIBRAD_WALL_PLANE, .plane = {2, 0, -.12}};
    const fibrad_plane open[] = {{0, 0, -.2}, {0, 1, .2}, {1, 0, -.2}, {1, 1, .2}, {2, 1, .2}};
    const fibrad_scene_config scene = {.wall = &floor, .walls = 1, .opening = open, .openings = 5};
    const double capacity = INFINITY, emissivity = .8, of_wall = _i ? 0 : .6, gas = 350;
    OWNED_MADE *made = NULL;
    assert_ok(made_with(&made, &scene, &spheres, &few, &(fibrad_run){.threads = 1}));
    fibrad_heat_sources s;
    fibrad_heat_sources_init(&s);
    double temperature, wall, power, wall_power, light = 7;
    s.temperature = &temperature, s.wall_temperature = &wall, s.emissivity = &emissivity, s.wall_emissivity = &of_wall;
    s.tolerance = 1e-11, h.gas = gas;
    for (int k = 0; k < 3; ++k) {
        temperature = k == 0 ? 1000 : 0, wall = k == 1 ? 1000 : 0, s.surroundings = k == 2 ? 1000 : 0;
        assert_ok(fibrad_bed_solve(made, &s, NULL, &(fibrad_heat_result){.power = &power, .wall_power = &wall_power}));
        h.of[k] = wall_power / 1e12;
    }
    double end, energy, stored;
    temperature = 1000, wall = 300, s.surroundings = 400, s.power = &light, s.tolerance = 1e-7;
    s.wall_power = &h.power, s.wall_film = &h.film, s.wall_gas = &gas, s.temperature = NULL;
    fibrad_span span = {&temperature, &capacity, 20, .tolerance = 1e-6, .wall_capacity = &h.capacity, .wall_end = &end};
    span.wall_energy = &energy, span.stored = &stored;
    for (int part = 0; part < 2; ++part) {
        assert_ok(fibrad_bed_advance(made, &s, &span));
        ck_assert(temperature == 1000 && stored == 0);
        assert_near(h.capacity * (end - wall), energy + 20 * h.power, 1e-12);
        const double lost = span.surroundings_energy + energy + span.gas_energy + span.held_energy;
        ck_assert_double_le(fabs(lost - 20 * light), 1e-12 * fabs(span.held_energy));
        assert_near(end, solved(warm, &h, wall, 20), 1e-6);
        wall = end;
    }
}

/* A sphere that was free stays at its temperature from when it is held. The temperatures stay as they are. */
static void assert_held_later(fibrad_bed *made, const fibrad_heat_sources *s, const double *temperature) {
    const double capacity[] = {10, INFINITY, 10};
    double t[] = {temperature[0], temperature[1], temperature[2]};
    fibrad_span span = {t, capacity, .duration = 3};
    assert_ok(fibrad_bed_advance(made, s, &span));
    ck_assert(t[0] != temperature[0] && t[1] == temperature[1]);
}

/* A sphere beside one of infinite capacity is as warm as beside one of a very large one, by factors and by patches. */
TEST(held_beside_free) {
    OWNED_BED bed = BED({0, 0, 0, .01}, {.021, 0, 0, .01}, {0, .021, 0, .01});
    const fibrad_spheres spheres = spheres_of(&bed);
    for (int patches = 0; patches < 2; ++patches) {
        double found[2][3], capacity[] = {INFINITY, 10, 10};
        for (int k = 0; k < 2; ++k) {
            double *t = memcpy(found[k], (double[]){1200, 300, 500}, sizeof *found), film[] = {0, 0, .01},
                   gas[] = {0, 0, 300};
            OWNED_MADE *made = NULL;
            assert_ok(made_with(&made, NULL, &spheres, NULL, NULL));
            fibrad_heat_sources s;
            fibrad_heat_sources_init(&s);
            const double emissivity[] = {.9, .8, .7};
            s.emissivity = emissivity, s.surroundings = 350, s.film = patches ? film : NULL, s.gas = gas;
            if (k) capacity[0] = 1e13;
            fibrad_span span = {t, capacity, 30, .tolerance = 1e-6};
            assert_ok(fibrad_bed_advance(made, &s, &span));
            if (k == 0) ck_assert(t[0] == 1200);
            if (k == 1) assert_held_later(made, &s, t);
            if (k == 0) ck_assert_double_lt(span.held_energy, -100);
        }
        for (int i = 1; i < 3; ++i) assert_near(found[0][i], found[1][i], 1e-8);
    }
}

/* ---- with other things ------------------------------------------------------------------------------------------- */

/* Nine spheres in a pile. */
static const char *pile(void) {
    return write_file("pile.csv", "x,y,z,r,type\n-.01,-.01,.01,.01,1\n.01,-.01,.01,.01,1\n-.01,.01,.01,.01,1\n"
                                  ".01,.01,.01,.01,1\n0,0,.0241,.01,2\n-.01,-.01,.038,.01,1\n.01,-.01,.038,.01,2\n"
                                  "-.01,.01,.038,.01,1\n.01,.01,.038,.01,1\n");
}

#define PILE                                                                                                           \
    "heat", pile(), "--length-unit", "m", "--emissivity", "0.7", "--density", "2500", "--ambient", "400", "-o", q,     \
        "--directions", "60", "--patches", "24", "--threads", "1"
#define MELTS "--heat-capacity", "800", "--melting", "1000,1e5", "--power", "60", "--temperature", "900"
#define SIDES "xmin:at=-.021:insulated,xmax:at=.021:insulated,ymin:at=-.021:insulated,ymax:at=.021:insulated,zmax:open"

static void expect_closed(void) { ck_assert_double_le(fabs(value_of("balance_of_stored")), 1e-12); }

/* What the spheres of a .csv have stored since 900 K: with their temperatures and melted parts in the columns 2 and k.
 */
static double heat_of(const char *file, int k) {
    const double mass = 2500 * 4. / 3 * PI * R * R * R;
    char *line = strchr(read_file(file), '\n') + 1;
    double sum = 0;
    for (int i = 0; i < 9; ++i, line = strchr(line, '\n') + 1) {
        char *at = line;
        double value[20] = {0};
        for (int c = 0; c <= k; ++c, at = strchr(at, ',') + 1) value[c] = strtod(at, NULL);
        ck_assert(value[2] > 900 && value[k] >= 0 && value[k] <= 1);
        sum += mass * (800 * (value[2] - 900) + 1e5 * value[k]);
    }
    return sum;
}

TEST(pairs) {
    const char *q = in_folder("q.csv");
    SUCCEED(PILE, MELTS, "--until", "25", "--contacts", "lens", "--contact-conductivity", "20", "--wall",
            SIDES ",zmin:at=0:temperature=950");
    expect_closed();
    ck_assert(value_of("melted") > .05 && value_of("melted") < .95);
    assert_near(heat_of(q, 8), value_of("stored_J"), 1e-5);
    SUCCEED(PILE, MELTS, "--until", "25", "--convection", "40", "--gas-temperature", "900", "--wall",
            SIDES ",zmin:at=0:temperature=950");
    expect_closed();
    assert_near(heat_of(q, 8), value_of("stored_J"), 1e-5);
    SUCCEED(PILE, MELTS, "--until", "40", "--step", "20"); /* several spheres melt in one step */
    expect_closed();
    assert_near(heat_of(q, 6), value_of("stored_J"), 1e-5);
    SUCCEED(PILE, "--heat-capacity", "800", "--temperature", "900", "--until", "30", "--periodic", "0.042,0.042,0",
            "--wall", "zmin:at=0:capacity=20:temperature=300:convection=20:gas=350,zmax:open");
    expect_closed();
    assert_near(20 * (value_of("wall_zmin_K") - 300), value_of("wall_zmin_J"), 1e-5);
    SUCCEED(PILE, "--heat-capacity", "1:800,2:inf", "--temperature", "900", "--until", "30", "--wall",
            "cylinder:0,0,.03:capacity=40:temperature=300:power=100,zmin:at=0:temperature=500,zmax:open");
    expect_closed();
    assert_near(40 * (value_of("wall_cylinder_K") - 300), value_of("wall_cylinder_J") + 3000, 1e-5);
    ck_assert_double_lt(value_of("held_J"), 0);
    SUCCEED(PILE, "--heat-capacity", "1:800,2:inf", "--temperature", "900", "--until", "30", "--irradiate",
            "0,0,-1:1e6", "--wall",
            "zmin:at=0:capacity=9:temperature=300,zmax:open,xmin:at=-.021:open,xmax:at=.021:open,"
            "ymin:at=-.021:open,ymax:at=.021:open");
    expect_closed();
    ck_assert_double_gt(value_of("held_J"), 0);
}

/* ---- what is refused --------------------------------------------------------------------------------------------- */

TEST(at_fault) {
    const char *one = write_file("one.csv", "x,y,z,r\n0,0,0,0.01\n"), *q = in_folder("q.csv");
    const char *table = formatted("@%s", write_file("c.csv", "T,c\n300,700\n1500,1200\n"));
#define ONE     "heat", one, "--length-unit", "m", "--emissivity", "1", "--ambient", "300", "-o", q
#define IN_TIME ONE, "--density", "2500", "--temperature", "900", "--until", "100"
    FAIL_WITH(3, IN_TIME, "--power", "500", "--heat-capacity", table);
    expect_message(formatted("%s:2: after ", one), "is outside of the table of --heat-capacity, 300 to 1500 K");
    FAIL_WITH(3, ONE, "--density", "2500", "--temperature", "200", "--until", "100", "--heat-capacity", table);
    expect_message(formatted("%s:2: after 0 s", one), "outside of the table");
    static const struct {
        const char *rows, *reason;
    } bad[] = {{"T,c\n300,700\n500,-1\n", "-1"},
               {"T,c\n300,0\n500,10\n", "within 1e-12"},
               {"T,c\n300,700\n300,800\n", "is not above the number before"},
               {"T,c\n600,700\n300,800\n", "is not above the number before"}};
    for (int k = 0; k < 4; ++k) {
        const char *file = write_file("bad.csv", bad[k].rows);
        FAIL_WITH(3, IN_TIME, "--heat-capacity", formatted("@%s", file));
        expect_message(file, bad[k].reason);
    }
    FAIL_WITH(3, "heat", write_file("nan.csv", "x,y,z,r,c\n0,0,0,0.01,nan\n"), "--length-unit", "m", "--emissivity",
              "1", "--ambient", "300", "--density", "2500", "--temperature", "900", "--until", "1", "--heat-capacity",
              "c");
    expect_message("", "the heat capacity is nan");
    static const char *const melting[][2] = {{"1000,-5", "the latent heat, -5 J/kg, is not above 0"},
                                             {"1000", "'1000' is not T,L or T,L,WIDTH"},
                                             {"1000,1,-1", "the width, -1 K, is below 0"},
                                             {"-5,1e5", "is not above absolute zero"}};
    for (int k = 0; k < 4; ++k) {
        FAIL_WITH(2, IN_TIME, "--heat-capacity", "800", formatted("--melting=%s", melting[k][0]));
        expect_message("--melting: ", melting[k][1]);
    }
    FAIL_WITH(2, ONE, "--temperature", "900", "--melting", "1000,1e5");
    expect_message("--melting needs --until", "");
    FAIL_WITH(2, ONE, "--temperature", "900", "--wall", "zmin:at=-.1:temperature=300:capacity=4");
    expect_message("--wall: zmin: capacity needs --until", "");
    static const char *const walls[][2] = {
        {"zmin:at=-.1:temperature=300:capacity=4", "zmin is endless and stores no heat"},
        {"box:temperature=300,zmin:insulated:capacity=4", "zmin is insulated and stores no heat"},
        {"box:temperature=300,zmin:power=3:capacity=4", "zmin has a capacity and needs the temperature at which it"},
        {"box:temperature=300,zmin:temperature=@c.csv:capacity=4", "zmin has a capacity and needs the temperature"},
        {"zmin:temperature=300:power=4", "temperature excludes power, unless the wall has a capacity"},
        {"zmin:temperature=300:capacity=-4", "capacity: -4 is not within"}};
    for (int k = 0; k < 6; ++k) {
        FAIL_WITH(2, IN_TIME, "--heat-capacity", "800", "--wall", walls[k][0]);
        expect_message("--wall: ", walls[k][1]);
    }
    ck_assert_int_ne(access(q, F_OK), 0);
    OWNED_BED bed = BED({0, 0, 0, 1});
    const fibrad_spheres spheres = spheres_of(&bed);
    OWNED_MADE *made = NULL;
    assert_ok(made_with(&made, NULL, &spheres, NULL, NULL));
    fibrad_heat_sources s;
    fibrad_heat_sources_init(&s);
    double e = 1, t = 900, mass = 1e9, rows[] = {300, 600, 1000}, c[] = {1, 2, 3};
    const uint32_t of = 1;
    s.emissivity = &e, s.surroundings = 300;
    const fibrad_store good = {rows, c, 3, 700, 5, 1};
    fibrad_store now = good;
    fibrad_span span = {&t, &mass, 1e-3, .store = &now, .stores = 1};
    assert_ok(fibrad_bed_advance(made, &s, &span));
    double *const fields[] = {&rows[1],    &rows[1],   &rows[0],     &c[1],   &c[1],
                              &now.latent, &now.width, &now.melting, &rows[2]};
    static const double wrong[] = {300, NAN, -1, 0, NAN, -1, -1, .5, 800};
    for (int k = 0; k < 9; ++k) {
        const double kept = *fields[k];
        *fields[k] = wrong[k];
        ck_assert_msg(fibrad_bed_advance(made, &s, &span) == FIBRAD_E_ARGUMENT, "%d", k);
        *fields[k] = kept;
    }
    span.store_of = &of;
    ck_assert_int_eq(fibrad_bed_advance(made, &s, &span), FIBRAD_E_ARGUMENT);
    span.store_of = NULL, span.stores = 0;
    ck_assert_int_eq(fibrad_bed_advance(made, &s, &span), FIBRAD_E_ARGUMENT);
}
