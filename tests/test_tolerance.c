/* test_tolerance.c - errors that the user asks for: the program keeps them and does not overdo them. If it does not
 * reach them, it warns. SPDX-License-Identifier: MIT */
#include "program.h"

#include "simple/fibrad_host.h"

FIXTURE(make_folder, remove_folder)

#define SIGMA 5.670374419e-8
#define BOX   "xmin:at=0" WARM ",xmax:at=1" WARM ",ymin:at=0" WARM ",ymax:at=1" WARM ",zmin:at=0" WARM ",zmax:at=1" WARM
#define WARM  ":temperature=887.3643"

/* Two black spheres are in a black box, one as far above its T^4 as the other is below. So each wall absorbs much, but
 * its net power is next to nothing. Powers are those of the closed form of two spheres. */
TEST(walls_by_what_they_absorb) {
    const double t[2] = {1000, 700}, wall = 887.3643 /* as in WARM */, r = .15;
    const double place[2][3] = {{.3, .35, .4}, {.65, .6, .55}};
    double f, distance = 0, square = 0, error = 0;
    for (int a = 0; a < 3; a++) distance += pow(place[1][a] - place[0][a], 2);
    ck_assert_int_eq(fibrad_pair_exact(r, r, sqrt(distance) - 2 * r, &f), 0);
    const char *text = formatted("x,y,z,r,T\n%g,%g,%g,%g,%g\n%g,%g,%g,%g,%g\n", place[0][0], place[0][1], place[0][2],
                                 r, t[0], place[1][0], place[1][1], place[1][2], r, t[1]);
    const char *powers = in_folder("q.csv");
    SUCCEED("heat", write_file("bed.csv", text), "--length-unit", "m", "--emissivity", "1", "--temperature", "T",
            "--wall", BOX, "--error", ".002", "-o", powers);
    ck_assert_str_eq(said, "");
    ck_assert_double_lt(value_of("directions"), 2000);
    ck_assert_double_gt(value_of("error_reached"), 0);
    ck_assert_double_le(value_of("error_reached"), .002);
    char *read = read_file(powers);
    for (int i = 0; i < 2; i++) {
        const double area = 4 * 3.14159265358979 * r * r, own = pow(t[i], 4);
        const double exact = area * SIGMA * (f * (pow(t[1 - i], 4) - own) + (1 - f) * (pow(wall, 4) - own));
        const char *row = formatted("\n%d,", i), *at = strchr(strstr(read, row) + strlen(row), ',') + 1;
        square += exact * exact, error += pow(atof(at) - exact, 2);
    }
    ck_assert_double_lt(sqrt(error / square), .003);
}

/* An obstacle overlaps the two spheres, so that visible areas jump. The default error can still be reached. */
TEST(pair_behind_an_overlapping_obstacle) {
    SUCCEED("pair", "1", "1", ".2", "--obstacle", ".9,0,1.1,.5");
    ck_assert_str_eq(said, "");
    ck_assert_double_lt(value_of("evaluations"), 200000);
    ck_assert_double_le(value_of("error_reached"), value_of("error_wanted"));
    const double f = value_of("F12"), x[] = {0, 0, .9}, y[3] = {0}, z[] = {0, 2.2, 1.1}, r[] = {1, 1, .5};
    const fibrad_spheres spheres = {.x = x, .y = y, .z = z, .r = r, .n = 3};
    const fibrad_beam_rule beam = {.directions = 20000};
    fibrad_bed_matrix *made;
    assert_ok(fibrad_view_factors(NULL, &spheres, &(fibrad_bed_rule){.beam = &beam}, NULL, &made));
    ck_assert_uint_eq(made->matrix.col[0], 1);
    ck_assert_double_eq_tol(made->matrix.f[0], f, 1e-5);
    fibrad_bed_matrix_free(made);
}

/* These commands are asked for an error that they cannot reach. */
static const char *const unreached[][16] = {
    {"factors", "--error", "1e-7", "--points", "64"},
    {"heat", "--length-unit", "m", "--emissivity", ".9", "--temperature", "T", "--ambient", "300", "--error", "1e-5"}};

LOOP_TEST(a_warning_where_it_is_not_reached, sizeof unreached / sizeof *unreached) {
    const char *arguments[40] = {0}, *json = in_folder("run.json");
    int count = 0;
    for (; unreached[_i][count]; ++count) arguments[count] = unreached[_i][count];
    arguments[count++] =
        write_file("three.csv", "x,y,z,r,T\n.3,.35,.4,.2,1000\n.65,.6,.55,.2,700\n1.02,.83,.7,.2,400\n");
    arguments[count++] = "--json", arguments[count] = json;
    ck_assert_msg(finish(start(arguments)) == 0, "%s", said);
    char *text = read_file(json);
    ck_assert_double_gt(value_of("error_reached"), value_of("error_wanted"));
    assert_has(said, "is not reached");
    assert_has(text, "is not reached");
}
