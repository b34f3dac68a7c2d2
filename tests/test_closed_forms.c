/* test_closed_forms.c - scenes that people ask about, as files for the program, against closed forms.
 * SPDX-License-Identifier: MIT */
#include "program.h"
#include "soups.h"

FIXTURE(make_folder, remove_folder)

#define SIGMA 5.670374419e-8

/* Adds a parallelogram seen from where a to b goes counter-clockwise. */
static void add_sheet(struct soup *soup, const double at[3], const double a[3], const double b[3]) {
    double corner[4][3];
    for (int axis = 0; axis < 3; ++axis) {
        corner[0][axis] = at[axis], corner[1][axis] = at[axis] + a[axis];
        corner[2][axis] = corner[1][axis] + b[axis], corner[3][axis] = at[axis] + b[axis];
    }
    soup_add(soup, corner[0], corner[1], corner[2]);
    soup_add(soup, corner[0], corner[2], corner[3]);
}

/* A bed of one sphere, so small that it plays no part. */
static const char *speck_at(double x, double y, double z) {
    return write_file("speck.csv", formatted("x,y,z,r\n%g,%g,%g,1e-4\n", x, y, z));
}

/* Six sides with the same words, the upper ones at these places. */
#define PLANES(words, wide, high)                                                                                      \
    "xmin:at=0" words ",xmax:at=" wide words ",ymin:at=0" words ",ymax:at=" wide words ",zmin:at=0" words              \
    ",zmax:at=" high words

#define SPECK_HEAT(speck, ...)                                                                                         \
    SUCCEED("heat", speck, "--length-unit", "m", "--emissivity", "1", "--temperature", "0", "--ambient", "0",          \
            __VA_ARGS__)

/* A cube of 0.2 m at 1000 degrees Celsius gives off 35,755.4 W. Nothing comes back to a convex wall. */
TEST(a_hot_cube) {
    static struct soup cube;
    soup_cube(&cube, .1);
    SPECK_HEAT(speck_at(9, 0, 0), "--wall",
               formatted("mesh:%s:normals:temperature=1273.15", write_solid("cube.stl", &cube)));
    ck_assert_double_eq_tol(value_of("wall_cube_W"), -35755.4, .1);
    ck_assert_double_eq_tol(value_of("surroundings_W"), 35755.4, .1);
}

/* Two unit cubes at a distance of 1, in one file, have two faces that see each other. */
TEST(two_cubes_in_one_mesh) {
    static struct soup cubes;
    soup_box(&cubes, (const double[]){0, 0, 0}, (const double[]){1, 1, 1});
    soup_box(&cubes, (const double[]){2, 0, 0}, (const double[]){3, 1, 1});
    SPECK_HEAT(speck_at(9, 0, 9), "--wall",
               formatted("mesh:%s:normals:temperature=1000", write_solid("cubes.stl", &cubes)), "--wall-rays",
               "2000000");
    const double power = (12 - 2 * .1998249) * SIGMA * 1e12;
    ck_assert_double_eq_tol(value_of("wall_cubes_W"), -power, 1e-3 * power);
    ck_assert_double_eq_tol(value_of("wall_cubes_W"), -power, 3 * value_of("wall_cubes_error_W"));
}

/* The view factor of two unit squares at right angles that share an edge is .20004. A gap at the edge changes it by
 * about as much as the gap is wide. */
TEST(floor_and_wall_at_right_angles) {
    static const double gaps[] = {0, 1e-6, 1e-4, 1e-3};
    for (size_t k = 0; k < sizeof gaps / sizeof *gaps; ++k) {
        static struct soup floor, wall;
        floor.n = wall.n = 0;
        add_sheet(&floor, (const double[]){0, 0, 0}, (const double[]){1, 0, 0}, (const double[]){0, 1, 0});
        add_sheet(&wall, (const double[]){-gaps[k], 0, 0}, (const double[]){0, 1, 0}, (const double[]){0, 0, 1});
        SPECK_HEAT(speck_at(.5, .5, .5), "--wall",
                   formatted("mesh:%s:normals:temperature=1000,mesh:%s:normals:temperature=0",
                             write_solid("floor.stl", &floor), write_solid("side.stl", &wall)),
                   "--wall-rays", "1000000");
        const double all = SIGMA * 1e12;
        ck_assert_double_eq_tol(value_of("wall_side_W") / all, .2000438, 2e-4 + gaps[k]);
        ck_assert_double_eq_tol(value_of("wall_floor_W") / all, -1, 1e-4);
    }
}

/* A bowl, a part of a sphere, is grey. Its inner side looks through the opening like a blacker disc, and its outer side
 * sees nothing but the surroundings. */
TEST(a_grey_bowl) {
    enum { RINGS = 20, FACETS = 48 };
    static struct soup bowl;
    const double e = .4, end = 2 * PI / 3;
    double area = 0;
    for (int k = 0; k < RINGS; ++k) {
        const double a = end * (k + 1e-9) / RINGS, b = end * (k + 1) / RINGS;
        soup_cone(&bowl, 0, 0, (const double[]){-cos(a), -cos(b)}, (const double[]){sin(a), sin(b)}, FACETS);
    }
    for (uint32_t t = 0; t < bowl.n; ++t) {
        double u[3], v[3];
        for (int k = 0; k < 3; ++k)
            u[k] = bowl.corner[t][1][k] - bowl.corner[t][0][k], v[k] = bowl.corner[t][2][k] - bowl.corner[t][0][k];
        area += hypot(hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2]), u[0] * v[1] - u[1] * v[0]) / 2;
    }
    const double open = FACETS / 2. * sin(2 * PI / FACETS) * pow(sin(end), 2); /* of the polygon at the rim */
    SPECK_HEAT(speck_at(9, 0, 9), "--wall",
               formatted("mesh:%s:both:temperature=1000:emissivity=0.4", write_solid("bowl.stl", &bowl)), "--wall-rays",
               "1000000");
    const double apparent = 1 / (1 + open / area * (1 / e - 1)), power = (e * area + apparent * open) * SIGMA * 1e12;
    ck_assert_double_eq_tol(value_of("wall_bowl_W"), -power, .003 * power);
}

/* In a flat closed box at one temperature nothing flows. */
TEST(a_flat_box_at_one_temperature) {
    SUCCEED("heat", write_file("flat.csv", "x,y,z,r\n3,4,.005,.004\n"), "--length-unit", "m", "--emissivity", "0.7",
            "--temperature", "500", "--wall", PLANES(":temperature=500:emissivity=.3", "10", ".01"));
    static const char *const sides[] = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"};
    const double one = .7 * 4 * PI * .004 * .004 * SIGMA * pow(500, 4); /* what the sphere emits */
    for (size_t k = 0; k < 6; ++k) ck_assert_double_eq_tol(value_of(formatted("wall_%s_W", sides[k])), 0, 1e-9 * one);
    ck_assert_double_eq_tol(value_of("power_largest_W"), 0, 1e-9 * one);
}

/* A sphere sees a coaxial disc of radius R at the distance a by (1 - 1/sqrt(1 + (R/a)^2))/2, whatever its own radius
 * is.
 */
TEST(a_sphere_and_a_disc) {
    enum { FACETS = 256 };
    static const double radius[] = {.3, 1, 4};
    const double a = 1.5;
    for (size_t k = 0; k < 3; ++k) {
        static struct soup disc;
        const double r = radius[k] * sqrt(2 * PI / FACETS / sin(2 * PI / FACETS)); /* the polygon has the disc's area */
        disc.n = 0;
        for (int f = 0; f < FACETS; ++f) {
            const double from = 2 * PI * f / FACETS, to = 2 * PI * (f + 1) / FACETS;
            soup_add(&disc, (const double[]){0, 0, 0}, (const double[]){r * cos(from), r * sin(from), 0},
                     (const double[]){r * cos(to), r * sin(to), 0});
        }
        for (int size = 0; size < 2; ++size) {
            const char *bed = write_file("one.csv", size ? "x,y,z,r\n0,0,1.5,1.4\n" : "x,y,z,r\n0,0,1.5,.1\n");
            SUCCEED("factors", bed, "--wall", formatted("mesh:%s:both", write_solid("disc.stl", &disc)), "--directions",
                    "4000");
            ck_assert_double_eq_tol(value_of("wall_disc_F"), (1 - 1 / hypot(1, radius[k] / a)) / 2, 1e-3);
        }
    }
}

/* An isothermal room stays so for a million seconds. */
TEST(an_isothermal_room_in_time) {
    const char *bed = write_file("room.csv", "x,y,z,r\n.3,.3,.3,.1\n.7,.4,.5,.2\n.4,.75,.6,.15\n"),
               *csv = in_folder("T.csv");
    SUCCEED("heat", bed, "--length-unit", "m", "--emissivity", "0.6", "--temperature", "600", "--wall",
            PLANES(":temperature=600:emissivity=.5", "1", "1"), "--until", "1e6", "--heat-capacity", "800", "--density",
            "2500", "-o", csv);
    ck_assert_double_eq_tol(value_of("temperature_min_K"), 600, 1e-6);
    ck_assert_double_eq_tol(value_of("temperature_max_K"), 600, 1e-6);
    ck_assert_double_eq_tol(value_of("stored_J"), 0, 1e-3);
}
