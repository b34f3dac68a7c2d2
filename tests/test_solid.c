/* test_solid.c - spheres that conduct: the option --solid-conductivity. SPDX-License-Identifier: MIT */
#include "frames/solid_option.h"
#include "program.h"

/* ---- the option ----------------------------------------------------------------------------------------------------
 */

/* Two spheres of radii 3 and 1 mm, of types 1 and 2. */
static struct bed two_spheres(void) {
    struct bed bed;
    bed_init(&bed);
    bed.extras = 1;
    ck_assert_int_eq(bed_add(&bed, &(struct bed_sphere){.r = 3, .line = 2}), 0);
    ck_assert_int_eq(bed_add(&bed, &(struct bed_sphere){.x = 5, .r = 1, .line = 3}), 0);
    bed.extra[0] = 1, bed.extra[1] = 2;
    return bed;
}

/* Numbers, tables over T and lists of types: k* = k_s/(4 d sigma T^3). */
START_TEST(relative_conductivities) {
    static const double sigma = 5.670374419e-8, temperature[] = {1000, 500};
    char by_type[300];
    snprintf(by_type, sizeof by_type, "1:@%s,2:20", write_file("k.csv", "T,k\n900,3\n1100,5\n"));
    struct bed bed = two_spheres();
    for (int k = 0; k < 2; ++k) {
        struct bed_options options = {.name = "bed", .length_unit = "mm"};
        struct quantity solid;
        double *conductivity, metres, relative[2];
        ck_assert_int_eq(solid_option(k ? by_type : "8", &solid), 0);
        ck_assert_int_eq(solid_values(&options, &bed, &solid, &conductivity, &metres), 0);
        ck_assert_int_eq(solid_relative(&options, &bed, &solid, temperature, metres, conductivity, relative), 0);
        ck_assert_double_eq_tol(relative[0], (k ? 4 : 8) / (4 * .006 * sigma * 1e9), 1e-12);
        ck_assert_double_eq_tol(relative[1] / ((k ? 20 : 8) / (4 * .002 * sigma * 1.25e8)), 1, 1e-14);
        const double extreme[] = {0, NAN};
        ck_assert_int_eq(solid_relative(&options, &bed, &solid, extreme, metres, conductivity, relative), 0);
        ck_assert(isinf(relative[0]) && isnan(relative[1]));
        free(conductivity);
        quantity_free(&solid);
    }
    bed_free(&bed);
}
END_TEST

/* What has no k*. */
START_TEST(no_relative_conductivity) {
    struct bed bed = two_spheres();
    struct bed_options options = {.name = "bed"};
    struct quantity solid;
    double *conductivity, metres, relative[2];
    static const char *const wrong[] = {"0", "-1", "1e13", "1:0", "1:2,1:3", ""};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) ck_assert_int_eq(solid_option(wrong[k], &solid), 2);
    ck_assert_int_eq(solid_option("1:2", &solid), 0);
    ck_assert_int_eq(solid_values(&options, &bed, &solid, &conductivity, &metres), 2); /* no unit */
    options.length_unit = "m";
    ck_assert_int_eq(solid_values(&options, &bed, &solid, &conductivity, &metres), 3); /* no such type */
    free(conductivity);
    ck_assert_int_eq(solid_option("1e-3", &solid), 0);
    ck_assert_int_eq(solid_values(&options, &bed, &solid, &conductivity, &metres), 0);
    const double hot[] = {1000, 1e5};
    ck_assert_int_eq(solid_relative(&options, &bed, &solid, hot, metres, conductivity, relative), 3);
    free(conductivity);
    bed_free(&bed);
}
END_TEST

int main(void) {
    Suite *suite = suite_create("solid");
    TCase *option = suite_case(suite, "option");
    tcase_add_checked_fixture(option, make_folder, remove_folder);
    tcase_add_test(option, relative_conductivities);
    tcase_add_test(option, no_relative_conductivity);
    return suite_run(suite);
}
