/* test_conductivity.c - effective conductivity: gaps, rays, axes, units and files. SPDX-License-Identifier: MIT
 *
 * The results are compared with laws of flights in slabs, closed forms of lattices, and the spread over seeds. */
#include "conductivity/conductivity.h"
#include "bed/packing.h"
#include "copies.h"
#include "program.h"

FIXTURE(make_folder, remove_folder)

/* ---- by the functions -------------------------------------------------------------------------------------------- */

/* Makes a cell with one unit sphere. */
static struct bed cell_of(double a, double b, double c) {
    struct bed bed = bed_empty();
    ck_assert_int_eq(bed_add(&bed, &(struct bed_sphere){.r = 1}), 0);
    bed.period[0] = a, bed.period[1] = b, bed.period[2] = c;
    return bed;
}

static struct bed copy_of(const struct bed *bed) {
    struct bed copy = bed_empty();
    ck_assert_int_eq(bed_make_copies(&copy, bed, (const uint32_t[]){1, 1, 1}), 0);
    return copy;
}

/* Finds F_E and what belongs to it. All spheres have this emissivity. Frees the bed. */
static struct conduction follow(struct bed *bed, double emissivity, struct conduction_rule rule) {
    struct conduction result;
    OWNED double *all = malloc(bed->n * sizeof *all);
    OWNED unsigned char *emits = malloc(bed->n);
    ck_assert(all && emits);
    for (uint32_t i = 0; i < bed->n; ++i) all[i] = emissivity;
    rule.emissivity = all;
    fibrad_run run = {.threads = 1};
    ck_assert_int_eq(conduction_emitters(bed, NULL, -1, CONDUCTION_MARGIN, "bed", emits, &result), 0);
    assert_ok(conduction_follow(bed, emits, &rule, &run, &result));
    bed_free(bed);
    return result;
}

/* Two layers of touching spheres lie in the hollows of each other, beside a gap of 8. Flights along the gap have up to
 * 100 periods. With cells twice as wide, F_E along the gap grows by h^2/(P d) ln 2. Across the gap it does not grow. */
TEST(slab_grows_with_the_logarithm) {
    const double height = 8, period = 2 + sqrt(2) + height, growth = height * height / (period * 2);
    struct conduction narrow, wide;
    struct bed bed = cell_of(2, 2, period), four = bed_empty();
    ck_assert_int_eq(bed_add(&bed, &(struct bed_sphere){1, 1, sqrt(2), 1, 0, 0}), 0);
    ck_assert_int_eq(bed_make_copies(&four, &bed, (const uint32_t[]){2, 2, 1}), 0);
    narrow = follow(&bed, 1, (struct conduction_rule){.axis = -1, .paths = 200000});
    wide = follow(&four, 1, (struct conduction_rule){.axis = -1, .paths = 50000});
    for (int axis = 0; axis < 2; ++axis) {
        const double error = hypot(narrow.error[axis], wide.error[axis]);
        assert_near(narrow.growth[axis], growth, 1e-12);
        ck_assert_double_lt(error, .5);
        ck_assert_double_eq_tol(wide.factor[axis] - narrow.factor[axis], growth * log(2), 4 * error);
        ck_assert_int_eq(conduction_flights(&narrow, axis), FLIGHTS_ENDLESS);
    }
    ck_assert_double_eq(narrow.growth[2], 0);
    ck_assert_int_eq(conduction_flights(&narrow, 2), FLIGHTS_SETTLED);
    ck_assert_double_eq_tol(wide.factor[2], narrow.factor[2], 4 * hypot(narrow.error[2], wide.error[2]));
}

/* Gaps are found wherever they are in the period. There is none where spheres overlap in projection. Slabs across all
 * axes add up. */
TEST(gaps_across_axes) {
    unsigned char emits[2];
    struct conduction result;
    for (int shift = -7; shift <= 7; ++shift) {
        OWNED_BED bed = cell_of(2, 2, 7);
        ck_assert_int_eq(bed_add(&bed, &(struct bed_sphere){.x = 1, .z = 1.9, .r = 1}), 0);
        for (int i = 0; i < 2; ++i) bed.z[i] += shift * .7;
        ck_assert_int_eq(conduction_emitters(&bed, NULL, -1, CONDUCTION_MARGIN, "bed", emits, &result), 0);
        ck_assert_double_eq_tol(result.growth[0], 3.1 * 3.1 / 14, 1e-12);
        ck_assert_double_eq(result.growth[2], 0);
    }
    OWNED_BED loose = cell_of(2.5, 2.2, 2);
    ck_assert_int_eq(conduction_emitters(&loose, NULL, -1, CONDUCTION_MARGIN, "bed", emits, &result), 0);
    ck_assert_double_eq_tol(result.growth[0], .04 / 4.4, 1e-12);
    ck_assert_double_eq_tol(result.growth[1], .25 / 5, 1e-12);
    ck_assert_double_eq_tol(result.growth[2], .04 / 4.4 + .25 / 5, 1e-12);
}

/* Random beds are settled. Over seeds F_E is spread as much as the standard errors say, or less, since paths are
 * quasi-random. */
TEST(errors_are_those_of_seeds) {
    enum { SEEDS = 30 };
    double factor[SEEDS][3], estimate[3] = {0};
    OWNED_BED packing = bed_empty();
    ck_assert_int_eq(bed_make_packing(&packing, 300, 1, 1, .55, 1), 0);
    for (int seed = 0; seed < SEEDS; ++seed) {
        struct bed bed = copy_of(&packing);
        const struct conduction result = follow(
            &bed, .7, (struct conduction_rule){.axis = -1, .seed = (uint64_t)seed, .error = .03, .max_rays = 1000000});
        ck_assert(!result.stopped);
        for (int axis = 0; axis < 3; ++axis) {
            ck_assert_int_eq(conduction_flights(&result, axis), FLIGHTS_SETTLED);
            factor[seed][axis] = result.factor[axis];
            estimate[axis] += pow(result.error[axis], 2) / SEEDS;
        }
    }
    for (int axis = 0; axis < 3; ++axis) {
        double mean = 0, spread = 0;
        for (int seed = 0; seed < SEEDS; ++seed) mean += factor[seed][axis] / SEEDS;
        for (int seed = 0; seed < SEEDS; ++seed) spread += pow(factor[seed][axis] - mean, 2) / (SEEDS - 1);
        ck_assert_double_lt(sqrt(spread / estimate[axis]), 1.4); /* 1 and 3 standard deviations of the ratio */
        ck_assert_double_gt(sqrt(spread / estimate[axis]), .3);
    }
}

/* A wide channel runs along x through a random bed, so that flights have no mean fourth power. The program says so with
 * most seeds along the channel, and never across it. */
TEST(channel_is_told) {
    OWNED_BED packing = bed_empty(), bed = bed_empty();
    ck_assert_int_eq(bed_make_packing(&packing, 300, 1, 1, .5, 1), 0);
    const double edge = packing.period[0];
    for (uint32_t i = 0; i < packing.n; ++i)
        if (hypot(packing.y[i] - edge / 2, packing.z[i] - edge / 2) > 3)
            ck_assert_int_eq(bed_add(&bed, &(struct bed_sphere){packing.x[i], packing.y[i], packing.z[i], 1, 0, 0}), 0);
    memcpy(bed.period, packing.period, sizeof bed.period);
    int told = 0;
    for (uint64_t seed = 0; seed < 8; ++seed) {
        struct bed copy = copy_of(&bed);
        const struct conduction result =
            follow(&copy, .8, (struct conduction_rule){.axis = -1, .seed = seed, .error = .02, .max_rays = 1000000});
        told += conduction_flights(&result, 0) == FLIGHTS_RARE;
        ck_assert_int_eq(conduction_flights(&result, 1), FLIGHTS_SETTLED);
        ck_assert_int_eq(conduction_flights(&result, 2), FLIGHTS_SETTLED);
    }
    ck_assert_int_ge(told, 4); /* on the mean 6 */
}

/* A few large spheres among small ones cause most of the variance. The bed still counts as settled, since this is not
 * due to few flights. */
TEST(mixtures_are_settled) {
    struct bed bed = bed_empty();
    ck_assert_int_eq(bed_make_two_sizes(&bed, 3, 5, .5, 1), 0);
    const struct conduction result =
        follow(&bed, .8, (struct conduction_rule){.axis = -1, .error = .02, .max_rays = 4000000});
    for (int axis = 0; axis < 3; ++axis) ck_assert_int_eq(conduction_flights(&result, axis), FLIGHTS_SETTLED);
}

/* The solid fraction is exact for lattices. For an open bed it is that of the core. */
TEST(solid_fraction) {
    unsigned char emits[16 * 16 * 16];
    struct conduction result;
    OWNED_BED cubic = cell_of(2, 2, 2), centred = cell_of(4 / sqrt(3), 4 / sqrt(3), 4 / sqrt(3)), open = bed_empty();
    ck_assert_int_eq(bed_add(&centred, &(struct bed_sphere){2 / sqrt(3), 2 / sqrt(3), 2 / sqrt(3), 1, 0, 0}), 0);
    ck_assert_int_eq(conduction_emitters(&cubic, NULL, -1, CONDUCTION_MARGIN, "bed", emits, &result), 0);
    ck_assert_double_eq_tol(result.solid_fraction, PI / 6, 1e-14);
    ck_assert_int_eq(conduction_emitters(&centred, NULL, -1, CONDUCTION_MARGIN, "bed", emits, &result), 0);
    ck_assert_double_eq_tol(result.solid_fraction, PI * sqrt(3) / 8, 1e-14);
    ck_assert_int_eq(bed_make_copies(&open, &cubic, (const uint32_t[]){16, 16, 16}), 0);
    memset(open.period, 0, sizeof open.period);
    ck_assert_int_eq(conduction_emitters(&open, NULL, -1, CONDUCTION_MARGIN, "bed", emits, &result), 0);
    ck_assert_double_eq_tol(result.solid_fraction, PI / 6, .02);
}

/* ---- by the program ---------------------------------------------------------------------------------------------- */

#define CONDUCTIVITY(...) SUCCEED("conductivity", __VA_ARGS__)

/* The text after `key ` on a line of the summary. NULL: there is no such line. */
static const char *text_of(const char *key) {
    const char *begin = formatted("\n%s ", key), *line = strstr(printed, begin);
    return line ? line + strlen(begin) : NULL;
}

/* A settled bed stands in a box twice as high as the bed. F_E along the gap does not exist, and no search for its error
 * begins. */
TEST(gap_is_told) {
    CONDUCTIVITY(PERIODIC, "--periodic", "12,12,26.6648", "--emissivity", "0.8", "--error", "0.02");
    assert_has(said, "monoper2000.dump: warning: F_E along xy does not exist");
    assert_begins(text_of("unreliable"), "xy\n");
    ck_assert_double_lt(value_of("rays"), 1e6);
    ck_assert_double_lt(value_of("F_E_z_error") / value_of("F_E_z"), .02);
    CONDUCTIVITY(PERIODIC, "--emissivity", "0.8", "--error", "0.02");
    ck_assert_str_eq(said, "");
    assert_begins(text_of("unreliable"), "none\n");
}

TEST(rays_have_a_ceiling) {
    CONDUCTIVITY(PERIODIC, "--emissivity", "0.8", "--error", "0.0005", "--max-rays", "3e5");
    assert_has(said, "monoper2000.dump: warning: --error 0.0005 is not reached: 0.00");
    ck_assert_double_gt(value_of("error_reached"), .0005);
    ck_assert_double_lt(value_of("rays"), 3.1e5);
    ck_assert_double_gt(value_of("rays"), 2.5e5);
    ck_assert_double_gt(value_of("F_E_x_error") / value_of("F_E_x"), .0005);
    FAIL_WITH(2, "conductivity", PERIODIC, "--emissivity", "0.8", "--rays", "20", "--max-rays", "1e6");
    assert_has(said, "--max-rays is for --error; leave out --rays");
    FAIL_WITH(2, "conductivity", PERIODIC, "--emissivity", "0.8", "--max-rays", "0");
}

/* The bed is periodic across an open axis z. Along z alone F_E is wanted, and its error alone counts. */
TEST(one_axis) {
    CONDUCTIVITY(PERIODIC, "--emissivity", "0.8", "--rays", "50");
    const double factor = value_of("F_E_z");
    CONDUCTIVITY(PERIODIC, "--emissivity", "0.8", "--rays", "50", "--axis", "z");
    ck_assert_double_eq(value_of("F_E_z"), factor);
    ck_assert_ptr_null(text_of("F_E_x"));
    ck_assert_ptr_null(text_of("F_E_y_error"));
    const char *gap = write_file("gap.csv", "x,y,z,r\n0,0,0,1\n1,1,1.4142136,1\n");
    CONDUCTIVITY(gap, "--periodic", "2,2,10", "--emissivity", "1", "--axis", "z", "--error", "0.02");
    ck_assert_str_eq(said, "");
    CONDUCTIVITY(gap, "--periodic", "2,2,10", "--emissivity", "1", "--axis", "y", "--error", "0.1");
    assert_has(said, "F_E along y does not exist");
    assert_begins(text_of("unreliable"), "y\n");
    FAIL_WITH(3, "conductivity", gap, "--periodic", "2,0,10", "--emissivity", "1", "--axis", "y");
    assert_has(said, "too thin along the open axis y, where at least 8 mean diameters are needed\n");
    FAIL_WITH(3, "conductivity", gap, "--periodic", "2,0,10", "--emissivity", "1");
    assert_has(said, "8 mean diameters are needed; --axis computes F_E along another axis");
    FAIL_WITH(2, "conductivity", gap, "--periodic", "2,2,10", "--emissivity", "1", "--axis", "q");
    assert_has(said, "--axis: 'q' is none of x, y and z");
}

#define LAYER 31 /* spheres along an edge, an odd number */

/* A layer of black spheres is thin along an open axis. F_E along x is 2 pi r^2/(V d) times the sum of F x^2, here from
 * view factors of the sphere in the middle of a large layer. */
TEST(across_a_thin_bed) {
    const double pitch = 2.2;
    char *text = calloc(LAYER * LAYER, 40);
    const char *const periods = "15.4,15.4,0", *out = in_folder("F.csv");
    strcpy(text, "x,y,z,r\n");
    for (int k = 0; k < LAYER * LAYER; ++k)
        sprintf(text + strlen(text), "%g,%g,0,1\n", pitch * (k % LAYER), pitch * (k / LAYER));
    const char *layer = write_file("layer.csv", text);
    strcpy(text, "x,y,z,r\n");
    for (int k = 0; k < 49; ++k) sprintf(text + strlen(text), "%g,%g,0,1\n", pitch * (k % 7), pitch * (k / 7));
    const char *cell = write_file("cell.csv", text);
    free(text);
    SUCCEED("factors", layer, "--targets", formatted("%d", LAYER * LAYER / 2), "--directions", "2000", "-o", out);
    double sum = 0;
    for (char *line = strchr(read_file(out), '\n') + 1; *line; line = strchr(line, '\n') + 1) {
        int i, j;
        double f;
        ck_assert_int_eq(sscanf(line, "%d,%d,%lf", &i, &j, &f), 3);
        if (j >= 0) sum += f * pow(pitch * (j % LAYER - LAYER / 2), 2);
    }
    CONDUCTIVITY(cell, "--periodic", periods, "--emissivity", "1", "--axis", "x", "--rays", "4000");
    const double wanted = 2 * PI * sum / (pitch * pitch * 2 * 2);
    ck_assert_double_eq_tol(value_of("F_E_x"), wanted, 3 * value_of("F_E_x_error") + .002 * wanted);
    assert_has(said, "of what the core emits leaves the bed");
}

/* In the summary, the table and the object alike k = F_E 4 sigma T^3 d. */
TEST(watts_and_files) {
    char axis;
    double factor, factor_error, k, k_error;
    const char *cell = write_file("cell.csv", "x,y,z,r\n0,0,0,3\n"), *csv = in_folder("k.csv"),
               *json = in_folder("s.json");
    CONDUCTIVITY(cell, "--length-unit", "mm", "--periodic", "6,6,6", "--emissivity", "1", "--rays", "20000",
                 "--temperature", "726.85", "--temperature-unit", "C", "-o", csv, "--json", json);
    const double scale = 4 * 5.670374419e-8 * 1e9 * .006;
    ck_assert_double_eq_tol(json_of(json, "k_x_W_mK"), json_of(json, "F_E_x") * scale, 1e-12);
    ck_assert_double_eq_tol(json_of(json, "k_z_W_mK_error"), json_of(json, "F_E_z_error") * scale, 1e-12);
    ck_assert_double_eq_tol(json_of(json, "F_E_x"), 1.2005, .05);
    ck_assert_double_eq_tol(json_of(json, "solid_fraction"), PI / 6, 1e-12);
    char *text = read_file(csv);
    const char *head =
        "axis,F_E,F_E_error,k_W_mK,k_W_mK_error,reliable,F_E_steady,F_E_steady_error,k_star,T_K,warning\n";
    assert_begins(text, head);
    ck_assert_int_eq(sscanf(text + strlen(head), "%c,%lf,%lf,%lf,%lf,", &axis, &factor, &factor_error, &k, &k_error),
                     5);
    ck_assert_int_eq(axis, 'x');
    ck_assert_double_eq(factor, json_of(json, "F_E_x"));
    ck_assert_double_eq(factor_error, json_of(json, "F_E_x_error"));
    ck_assert_double_eq(k, json_of(json, "k_x_W_mK"));
    ck_assert_double_eq(k_error, json_of(json, "k_x_W_mK_error"));
    CONDUCTIVITY(cell, "--periodic", "6,6,6", "--emissivity", "1", "--rays", "200", "--axis", "y", "-o", csv);
    ck_assert_str_eq(said, ""); /* if there are no watts, lengths need no unit */
    ck_assert_ptr_null(text_of("k_y_W_mK"));
    text = read_file(csv);
    ck_assert_int_eq(sscanf(text + strlen(head), "y,%lf,%lf,,,", &factor, &factor_error), 2);
    ck_assert_str_eq(strchr(text + strlen(head), '\n') - 4, ",,,,\n");
    CONDUCTIVITY(cell, "--periodic", "6,6,6", "--emissivity", "1", "--rays", "200", "--temperature", "0", "-o",
                 in_folder("k.json"), "--json", json);
    text = read_file(in_folder("k.json"));
    ck_assert(strstr(text, "\"axes\":[") && strstr(text, "{\"axis\":\"z\",") && strstr(text, "\"k_W_mK\":0,"));
    FAIL_WITH(2, "conductivity", cell, "--emissivity", "1", "-o", in_folder("k.txt"));
    assert_has(said, "k.txt: unknown ending; there are .csv and .json");
    const char *mirror = write_file("mirror.csv", "x,y,z,r\n0,0,0,1\n");
    FAIL_WITH(3, "conductivity", mirror, "--periodic", "2,2,2", "--emissivity", "0");
    assert_has(said, "the emissivities are all 0");
}

/* The bytes are the same for any number of threads, although there are batches and rounds. */
TEST(threads_change_nothing) {
    static const char *const threads[] = {"1", "3"};
    char *text[2];
    const char *cell = write_file("cell.csv", "x,y,z,r\n0,0,0,1\n1,1,1,0.5\n"), *out = in_folder("k.csv");
    for (int k = 0; k < 2; ++k) {
        CONDUCTIVITY(cell, "--periodic", "2,2,2", "--emissivity", "0.5", "--error", "0.02", "--threads", threads[k],
                     "-o", out);
        text[k] = read_file(out);
    }
    ck_assert_str_eq(text[0], text[1]);
}

/* Between plates spheres settle at temperatures of their own. The flux is still that of the linear field. Open sides
 * have no flux. */
TEST(between_plates) {
    const char *csv = in_folder("k.csv"), *json = in_folder("k.json");
    SUCCEED("conductivity", PERIODIC, "--periodic", "12,12,0", "--emissivity", "1", "--axis", "z", "--steady", "-o",
            csv, "-o", json);
    double between = 0, off = 0;
    ck_assert_int_eq(sscanf(strchr(read_file(csv), '\n') + 1, "z,%*f,%*f,,,1,%lf,%lf,\n", &between, &off), 2);
    ck_assert_double_eq_tol(between / value_of("F_E_steady_z"), 1, 1e-3);
    ck_assert_double_eq_tol(off / value_of("F_E_steady_z_error"), 1, .05);
    char *text = read_file(json);
    ck_assert_double_eq(strtod(strstr(text, "\"F_E_steady\":") + 13, NULL), between);
    const double linear = value_of("F_E_z"), steady = value_of("F_E_steady_z");
    ck_assert_double_eq_tol(steady, linear, .005 * linear + 2 * value_of("F_E_z_error"));
    ck_assert_double_lt(value_of("F_E_steady_z_error"), .003 * steady);
    FAIL_WITH(2, "conductivity", PERIODIC, "--periodic", "12,12,0", "--emissivity", "1", "--axis", "x", "--error", ".1",
              "--steady");
    expect_message(PERIODIC, "--steady: the two axes across it must be periodic");
}

/* A tube of radius 3.2 with layers of seven unit spheres, each turned. */
static const char *tube_of(int layers) {
    char text[16384] = "x,y,z,r\n";
    for (int k = 0; k < layers; ++k)
        for (int i = 0; i < 7; ++i) {
            const double far = i < 6 ? 2.15 : 0, angle = PI / 3 * i + 2.4 * k;
            sprintf(text + strlen(text), "%.9g,%.9g,%g,1\n", far * cos(angle), far * sin(angle), 1 + 2.02 * k);
        }
    return write_file(formatted("tube%d.csv", layers), text);
}

/* F_E of a bed without the sides of its tube is too low. All outputs say so: summary, table and object. */
TEST(open_sides_are_told) {
    static const char *const doubt = "F_E too low: radiation leaves the bed";
    const char *tube = tube_of(24), *csv = in_folder("k.csv"), *json = in_folder("k.json");
    CONDUCTIVITY(tube, "--emissivity", "0.8", "--axis", "z", "--rays", "64", "-o", csv, "-o", json, "--json",
                 in_folder("s.json"));
    assert_has(said, "of what the core emits leaves the bed; F_E is too low. --wall closes the sides of a container");
    assert_begins(text_of("unreliable"), "z\n");
    assert_has(read_file(in_folder("s.json")), "leaves the bed; F_E is too low");
    assert_has(read_file(csv), formatted(",,,0,,,,,%s\n", doubt));
    assert_has(read_file(json), formatted("\"reliable\":false,\"warning\":\"%s\"", doubt));
}

/* Between insulated sides F_E is that of the flux between two plates. A periodic tube has the F_E of a long one. */
TEST(a_bed_in_a_tube) {
    const char *tube = tube_of(24), *wall = "cylinder:0,0,3.2", *csv = in_folder("k.csv");
    CONDUCTIVITY(tube, "--emissivity", "0.4", "--wall", wall, "--steady", "--error", ".01", "-o", csv);
    const double linear = value_of("F_E_z"), error = value_of("F_E_z_error"), steady = value_of("F_E_steady_z");
    ck_assert_double_eq_tol(linear, steady, .02 * steady + 3 * error);
    assert_lacks(said, "--wall closes"); /* some of the radiation leaves through the ends */
    CONDUCTIVITY(tube, "--emissivity", "0.4", "--axis", "z", "--error", ".01");
    ck_assert_double_lt(value_of("F_E_z"), .8 * linear); /* sides that let radiation out */
    CONDUCTIVITY(tube_of(12), "--periodic", "0,0,24.24", "--emissivity", "0.4", "--wall", wall, "--error", ".01");
    ck_assert_double_eq_tol(value_of("F_E_z"), linear, .02 * linear + 3 * hypot(error, value_of("F_E_z_error")));
    ck_assert_double_eq_tol(value_of("solid_fraction"), 7 * 4 / 3. / (3.2 * 3.2 * 2.02), 1e-4);
    FAIL_WITH(2, "conductivity", tube, "--emissivity", ".8", "--wall", "zmin");
    expect_message("--wall: F_E is along one axis without a wall across it", "give --axis");
    FAIL_WITH(2, "conductivity", tube, "--emissivity", ".8", "--wall", "zmin", "--axis", "z");
    expect_message("--wall: F_E along z has no wall across z", "only the sides can be walls");
    FAIL_WITH(2, "conductivity", tube, "--emissivity", ".8", "--wall", wall, "--length-unit", "m", "--temperature", "9",
              "--solid-conductivity", "3");
    expect_message("--solid-conductivity: paths of spheres that conduct know no walls", "");
}

/* Several temperatures go into one file. */
TEST(many_temperatures) {
    const char *cell = write_file("cell.csv", "x,y,z,r\n0,0,0,3\n"), *csv = in_folder("k.csv"),
               *json = in_folder("s.json");
    const char *const lists[] = {"600,900,1200", "600:1200:300", "326.85:926.85:300"};
    char *text = NULL;
    for (int k = 0; k < 2; ++k) {
        CONDUCTIVITY(cell, "--length-unit", "mm", "--periodic", "6,6,6", "--emissivity", "1", "--rays", "64", "--axis",
                     "x", "--temperature", lists[k], "-o", csv, "--json", json);
        read_same(csv, &text);
    }
    double watts[3], kelvins[3];
    for (int k = 0; k < 3; ++k) {
        text = strchr(text, '\n') + 1;
        ck_assert_int_eq(sscanf(text, "x,%*f,%*f,%lf,%*f,%*d,,,,%lf,", &watts[k], &kelvins[k]), 2);
        ck_assert_double_eq(kelvins[k], 600 + 300 * k);
        ck_assert_double_eq_tol(watts[k], watts[0] * pow(kelvins[k] / kelvins[0], 3), 1e-12 * watts[k]);
    }
    ck_assert_double_eq(json_of(json, "temperature_K"), 1200);
    CONDUCTIVITY(cell, "--length-unit", "mm", "--periodic", "6,6,6", "--emissivity", "1", "--rays", "64",
                 "--temperature", lists[2], "--temperature-unit", "C", "--solid-conductivity", "1", "-o", csv);
    double star[2], factor[2];
    text = strchr(read_file(csv), '\n') + 1;
    for (int k = 0; k < 2; ++k) {
        ck_assert_int_eq(sscanf(text, "x,%lf,%*f,%*f,%*f,%*d,,,%lf,", &factor[k], &star[k]), 2);
        for (int line = 0; line < 3; ++line) text = strchr(text, '\n') + 1;
    }
    ck_assert_double_eq_tol(star[1] / star[0], pow(900. / 600, -3), 1e-9);
    ck_assert_double_lt(factor[1], factor[0]);
    static const char *const wrong[] = {"9:3:1", "1:2:0", "1:2", "1:1e9:1", "-3", "300,", "1:2:3:4", "300,-1"};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
        FAIL_WITH(2, "conductivity", cell, "--periodic", "6,6,6", "--emissivity", "1", "--temperature", wrong[k]);
        expect_message("--temperature: ", "");
    }
    FAIL_WITH(2, "conductivity", cell, "--emissivity", "1", "--temperature", "3,4", "--frame", "all", "-o",
              in_folder("k.*.csv"));
    assert_has(said, "a file for each frame has one temperature");
}
