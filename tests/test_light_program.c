/* test_light_program.c - what fibrad heat --irradiate reports, writes and refuses. SPDX-License-Identifier: MIT */
#include "program.h"
#include "soups.h"

static const char *bed; /* four spheres of radius 0.5 in a cup of side 2, whose lid is at 2.5 */

/* With words about its sides, and its floor. */
#define CUP_OF(sides, floor)                                                                                           \
    "xmin:at=0" sides ",xmax:at=2" sides ",ymin:at=0" sides ",ymax:at=2" sides ",zmin:at=0" floor ",zmax:open:at=2.5"
#define CUP  CUP_OF(":temperature=300", ":temperature=300")
#define COLD CUP_OF(":temperature=0", ":temperature=0")
#define HEAT "heat", bed, "--length-unit", "m", "--emissivity", "0.8", "--ambient", "300"

static void begin(void) {
    make_folder();
    bed = write_file("bed.csv", "x,y,z,radius\n.5,.5,.5,.5\n1.5,.5,.5,.5\n.5,1.5,.5,.5\n1.5,1.5,1.2,.5\n");
}

FIXTURE(begin, remove_folder)

static double fractions(void) { return value_of("absorbed") + value_of("reflected") + value_of("transmitted"); }

TEST(what_is_absorbed_is_said_and_written) {
    const char *csv = in_folder("q.csv"), *profile = in_folder("p.csv");
    const char *cup = CUP_OF(":temperature=300:absorptivity=0", ":temperature=300:absorptivity=.25");
    FAIL_WITH(2, HEAT, "--temperature", "300", "--wall", cup, "--irradiate", "0,0,-1:1000", "--absorptivity", ".5",
              "-o", csv, "--profile", "z:2:.csv", "--quiet"); /* a profile needs a name */
    SUCCEED(HEAT, "--temperature", "300", "--wall", cup, "--irradiate", "0,0,-1:1000", "--absorptivity", ".5", "-o",
            csv, "--profile", formatted("z:2:%s", profile));
    ck_assert_double_eq_tol(value_of("irradiated_W"), 4000, 1e-9);
    ck_assert_double_eq_tol(value_of("absorbed_first_W"), 1000 * (.5 * PI + .25 * (4 - PI)), .01);
    ck_assert_double_eq_tol(fractions(), 1, .01);
    char *text = read_file(csv);
    assert_begins(text, "i,T_K,q_W,q_error_W,T_error_K,absorbed_first_W,absorbed_W,body\n");
    double sum = 0, all = 0;
    for (const char *line = strchr(text, '\n') + 1; *line; line = strchr(line, '\n') + 1) {
        double q, first, absorbed;
        ck_assert_int_eq(sscanf(line, "%*d,%*f,%lf,%*f,%*f,%lf,%lf", &q, &first, &absorbed), 3);
        sum += q, all += absorbed;
    }
    ck_assert_double_eq_tol(sum, 0, 1e-8);
    ck_assert_double_eq_tol(all, 4000, 1e-8);
    assert_begins(read_file(profile), "z_low,z_high,spheres,T_K,q_W,absorbed_first_W,absorbed_W\n0,0.85,3,300,");
}

TEST(light_heats) {
    SUCCEED("heat", bed, "--length-unit", "m", "--emissivity", "1", "--ambient", "0", "--wall",
            CUP_OF(":insulated", ":insulated"), "--power", "0", "--irradiate", "0,0,-1:1000");
    /* all light is absorbed, and all heat leaves through the lid */
    ck_assert_double_eq_tol(value_of("absorbed"), 1, 1e-6);
    ck_assert_double_eq_tol(value_of("surroundings_W"), 0, 1e-4); /* as much leaves as comes in */
    ck_assert_double_gt(value_of("temperature_min_K"), 300);
    SUCCEED("heat", bed, "--length-unit", "m", "--emissivity", "1", "--ambient", "0", "--wall", COLD, "--temperature",
            "300", "--irradiate", "0,0,-1:1000", "--until", "10", "--heat-capacity", "800", "--density", "2500");
    ck_assert_double_eq_tol(value_of("supplied_J"), 10 * 1000 * PI, 1);
}

/* Spheres that conduct are hotter where they are lit. If they conduct well, nothing changes. Powers add up. */
TEST(lit_sides_are_hotter) {
    const char *csv = in_folder("lit.csv");
    double mean[3], span[3], leaves[3];
    for (int k = 0; k < 3; ++k) {
        const char *solid = k == 0 ? "1e9" : k == 1 ? "1" : "0.1";
        SUCCEED(HEAT, "--power", "0", "--wall", CUP, "--irradiate", "0,0,-1:1e4", "--solid-conductivity", solid, "-o",
                csv);
        mean[k] = value_of("temperature_mean_K"), span[k] = value_of("surface_span_K");
        leaves[k] = value_of("surroundings_W");
        ck_assert_double_le(fabs(value_of("balance_of_emission")), 1e-12);
        ck_assert_double_le(fabs(value_of("balance_of_light")), 1e-12);
    }
    SUCCEED(HEAT, "--power", "0", "--wall", CUP, "--irradiate", "0,0,-1:1e4");
    ck_assert_double_eq_tol(mean[0], value_of("temperature_mean_K"), .02);
    ck_assert_double_eq_tol(leaves[0], value_of("surroundings_W"), 1e-4 * fabs(leaves[0]));
    ck_assert_double_lt(span[0], 1e-3);
    ck_assert(span[1] > 50 && span[2] > span[1]);
    ck_assert_double_gt(leaves[1], leaves[0]); /* lit sides are what the sky sees */
}

/* Spheres that conduct, lit and in time, end where the steady temperatures are, with the same surfaces. The energy is
 * kept. */
TEST(lit_sides_in_time) {
    const char *csv = in_folder("time.csv"), *solid = "--solid-conductivity";
    SUCCEED(HEAT, "--power", "0", "--wall", CUP, "--irradiate", "0,0,-1:1e4", "--directions", "50", solid, "3", "-o",
            csv);
    const double mean = value_of("temperature_mean_K"), hottest = value_of("surface_max_K");
    SUCCEED(HEAT, "--temperature", "400", "--wall", CUP, "--irradiate", "0,0,-1:1e4", "--directions", "50", solid, "3",
            "--until", "4e4", "--heat-capacity", "800", "--density", "100", "-o", csv);
    ck_assert_double_eq_tol(value_of("temperature_mean_K"), mean, .002 * mean);
    ck_assert_double_le(fabs(value_of("balance_of_stored")), 1e-12);
    char *text = read_file(csv);
    double most = 0;
    for (const char *line = strchr(text, '\n') + 1; *line; line = strchr(line, '\n') + 1) {
        double surface; /* the error of T is blank */
        if (sscanf(line, "%*f,%*d,%*f,%*f,%*f,,%*f,%lf", &surface) == 1) most = fmax(most, surface);
    }
    ck_assert_double_eq_tol(most, hottest, .01 * hottest);
}

/* A roof of triangles over half of the cup takes half of the light. Its lower side must not be lit, unless it is a
 * wall. What is absorbed of light adds up to all of it. */
TEST(triangles_throw_shadows) {
    static struct soup roof;
    const double a[] = {0, 0, 2.2}, b[] = {1, 0, 2.2}, c[] = {1, 2, 2.2}, d[] = {0, 2, 2.2};
    roof.n = 0;
    soup_add(&roof, a, b, c), soup_add(&roof, a, c, d);
    const char *wall = formatted(COLD ",mesh:%s:both:name=roof:temperature=0", write_solid("roof.stl", &roof));
    SUCCEED("heat", bed, "--length-unit", "m", "--emissivity", "1", "--ambient", "0", "--temperature", "0", "--wall",
            wall, "--irradiate", "0,0,-1:1000");
    ck_assert_double_eq_tol(value_of("absorbed_first_W"), 4000, .1);
    ck_assert_double_eq_tol(value_of("wall_roof_absorbed_W"), 2000, 2);
    ck_assert_double_eq_tol(fractions(), 1, .01);
    ck_assert_double_le(fabs(value_of("balance_of_light")), 1e-12);
    FAIL_WITH(3, "heat", bed, "--length-unit", "m", "--emissivity", "1", "--ambient", "0", "--temperature", "0",
              "--wall", formatted("mesh:%s:name=roof:normals:temperature=0", in_folder("roof.stl")), "--irradiate",
              "0,0,1:1000");
    assert_has(said, "the back of wall roof is seen");
}

/* Light that nothing absorbs heats nothing. */
TEST(reflected_light_heats_nothing) {
    SUCCEED("heat", bed, "--length-unit", "m", "--emissivity", "0.8", "--ambient", "300", "--power", "0", "--irradiate",
            "0,0,-1:1e5", "--absorptivity", "0", "--solid-conductivity", "10");
    ck_assert_double_eq_tol(value_of("temperature_min_K"), 300, 1e-6);
    ck_assert_double_eq_tol(value_of("surface_max_K"), 300, 1e-6);
}

/* A small sphere near a large one has the large one divided into fine patches. The light of few points falls on these.
 * The surface of the large sphere is about as hot as that of one with nothing near it. */
TEST(fine_patches_are_no_hot_spots) {
    const char *near = write_file("near.csv", "x,y,z,radius\n0,0,0,1\n0,0,1.03,.02\n9,0,0,1\n"),
               *q = in_folder("n.csv");
    double hottest[3];
    SUCCEED("heat", near, "--length-unit", "m", "--emissivity", "0.8", "--ambient", "300", "--power", "0",
            "--irradiate", "0.3,0,-1:1e5", "--solid-conductivity", "50", "-o", q);
    char *text = read_file(q), *line = text;
    for (int i = 0; i < 3; ++i) {
        line = strchr(line, '\n') + 1;
        ck_assert_int_eq(sscanf(line, "%*d,%*f,%*f,%*f,%*f,%*f,%lf", &hottest[i]), 1);
    }
    assert_near(hottest[0], hottest[2], .03);
}

/* An endless floor of equal spheres has an emissivity. A black cavity with an open lid has 1. */
TEST(faces_have_an_emissivity) {
    SUCCEED(HEAT, "--temperature", "300", "--wall", CUP, "--face");
    ck_assert_double_eq_tol(value_of("face_area_m2"), 4, 1e-9);
    ck_assert_double_gt(value_of("face_emissivity"), .9);
    ck_assert_double_lt(value_of("face_emissivity"), 1);
    for (uint64_t k = 0; k < by_night(2, 1); ++k) { /* a floor with next to nothing on it; by 4e6 plain rays */
        const double truth = k ? .39374 : .5;
        SUCCEED("heat", k ? "tests/data/monoper2000.dump" : write_file("mote.csv", "x,y,z,r\n1,1,.5,.05\n"),
                "--length-unit", "cm", "--emissivity", ".2", "--directions", "24", "--temperature", "300", "--ambient",
                "300", "--wall", "zmin:at=-.1:temperature=300:emissivity=.5", "--periodic", "12,12,0", "--face");
        ck_assert_double_eq_tol(value_of("face_emissivity"), truth, .0015 * truth);
        ck_assert_double_eq_tol(value_of("face_emissivity"), truth, 2 * value_of("face_emissivity_error") + 1e-4);
    }
    FAIL_WITH(2, "heat", bed, "--emissivity", ".5", "--temperature", "300", "--ambient", "300", "--face");
    expect_message("--face: an open face has no end", "walls or periods");
    FAIL_WITH(2, HEAT, "--temperature", "300", "--wall", "box:temperature=300", "--face");
    expect_message("--face: the bed has no open face", "");
}

/* Angles are in radians, as in C and in Python, or in a unit that is named. */
TEST(half_angles_have_units) {
    static const char *const same[] = {"0.09", "0.09rad", "90mrad", "5.15662015618deg"};
    double absorbed[5];
    for (int k = 0; k < 5; ++k) {
        const char *json = in_folder("h.json"), *angle = k < 4 ? same[k] : "0.4";
        SUCCEED(HEAT, "--temperature", "300", "--wall", CUP, "--directions", "50", "--json", json, "--irradiate",
                formatted("0,0,-1:1000:half-angle=%s", angle));
        absorbed[k] = json_of(json, "absorbed_first_W");
    }
    for (int k = 1; k < 4; ++k) ck_assert_double_eq_tol(absorbed[k], absorbed[0], 1e-9 * absorbed[0]);
    ck_assert_double_gt(fabs(absorbed[4] - absorbed[0]), 1e-3 * absorbed[0]);
}

TEST(refused_lights_are_named) {
    static const struct {
        const char *light, *wall, *place, *reason;
    } refused[] = {
        {"0,0,0:1000", CUP, "--irradiate: the direction 0,0,0", "leads nowhere"},
        {"0,0,-1", CUP, "--irradiate: '0,0,-1'", "DX,DY,DZ:FLUX"},
        {"0,-1:5", CUP, "--irradiate: '0,-1'", "DX,DY,DZ"},
        {"0,0,-1:-5", CUP, "--irradiate: flux", ""},
        {"0,0,-1:5:width=3", CUP, "--irradiate: 'width=3'", "none of half-angle=, disc= and box="},
        {"0,0,-1:5:half-angle=moon", CUP, "--irradiate: half-angle=moon", "is not an angle from 0 to 0.5 radians"},
        {"0,0,-1:5:half-angle=", CUP, "--irradiate: half-angle= is not", ""},
        {"0,0,-1:5:half-angle=5", CUP, "--irradiate: half-angle=5 is not", "half-angle=5mrad is in milliradians"},
        {"0,0,-1:5:half-angle=-1deg", CUP, "--irradiate: half-angle=-1deg is not", ""},
        {"0,0,-1:5:half-angle=5 mrads", CUP, "--irradiate: half-angle=5 mrads is not", ""},
        {"0,0,-1:5:disc=1,1,3", CUP, "--irradiate: '1,1,3'", "disc=X,Y,Z,R"},
        {"0,0,-1:5:disc=1,1,3,0", CUP, "--irradiate: the radius", "not above 0"},
        {"0,0,-1:5:box=1,0,0,1", CUP, "--irradiate: box=1,0,0,1", "X1 must be below X2"},
        {"1,0,0:5:box=0,1,0,1", CUP, "--irradiate: the box lies across z", ""},
        {"0,0,-1:5:disc=1,1,3,1:box=0,1,0,1", CUP, "--irradiate: a light has one disc or one box", ""},
        {"0,0,1:1000", CUP, "--irradiate: no open face lets light 1 in", "zmax:open:at=H"},
        {"1,0,-1:1000", CUP ",zmax:at=2.5:temperature=300", "--irradiate: no open face lets light 1 in", ""},
        {"0,0,-1:5:disc=1,1,0.6,1", CUP, "--irradiate: the disc of light 1 lies inside the bed", "sphere"},
    };
    for (size_t k = 0; k < sizeof refused / sizeof *refused; ++k) {
        const int status =
            RUN(HEAT, "--temperature", "300", "--wall", refused[k].wall, "--irradiate", refused[k].light);
        ck_assert_msg(status == 2, "%s: exit status %d, '%s'", refused[k].light, status, said);
        assert_has(said, refused[k].place); /* a closed bed gets a warning about --ambient first */
        assert_has(said, refused[k].reason);
    }
    FAIL_WITH(2, HEAT, "--temperature", "300", "--wall", CUP, "--absorptivity", ".5");
    expect_message("--absorptivity needs --irradiate", "");
    FAIL_WITH(2, HEAT, "--temperature", "300", "--wall", CUP, "--irradiate", "0,0,-1:5", "--absorptivity", "1.5");
    expect_message("--absorptivity", "1.5");
    FAIL_WITH(3, HEAT, "--temperature", "300", "--wall", CUP, "--irradiate", "0,0,-1:5", "--absorptivity", "colour");
    FAIL_WITH(2, HEAT, "--temperature", "300", "--wall", CUP, "--wall", "lid:absorptivity=.5", "--irradiate",
              "0,0,-1:5");
    expect_message("--wall: 'lid' is no wall", "zmax");
    FAIL_WITH(2, HEAT, "--temperature", "300", "--wall", CUP, "--wall", "zmin:at=0:temperature=300:absorptivity=.5");
    expect_message("--wall: absorptivity needs --irradiate", "");
    FAIL_WITH(2, HEAT, "--temperature", "300", "--wall", CUP, "--irradiate", "0,0,-1:5", "--profile", "w:p.csv");
    expect_message("--profile: 'w:p.csv'", "AXIS");
    SUCCEED(HEAT, "--temperature", "300", "--wall",
            CUP_OF(":temperature=300:absorptivity=0", ":temperature=300:absorptivity=0"), "--irradiate", "0,0,-1:5",
            "--absorptivity", "0");
}
