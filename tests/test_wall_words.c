/* test_wall_words.c - walls in words. SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "bed/wall_words.h"
#include "suite.h"

enum { ALL = WALL_NAMES_TOO - 1, MOST = 16 };

static char fault[WALL_FAULT], text[400];

/* Reads the walls of a joined text into `wall`. Returns their number. 0: there is a fault. */
static int walls_of_text(const char *joined, unsigned allowed, struct wall_words wall[MOST]) {
    int n = 0;
    snprintf(text, sizeof text, "%s", joined);
    for (char *at = text; at; ++n) {
        memset(&wall[n], 0, sizeof wall[n]);
        if (!wall_words_take(&wall[n], &at, allowed, fault)) return 0;
    }
    return n;
}

static void same_wall(const struct wall_words *a, const struct wall_words *b) {
    ck_assert(a->shape == b->shape && a->given == b->given && a->wall.kind == b->wall.kind);
    ck_assert(memcmp(&a->wall, &b->wall, sizeof a->wall) == 0);
    ck_assert(memcmp(&a->temperature, &b->temperature, sizeof a->temperature) == 0);
    ck_assert(a->emissivity == b->emissivity && a->capacity == b->capacity && a->mesh.scale == b->mesh.scale);
    ck_assert(a->mesh.solids == b->mesh.solids && a->mesh.sides == b->mesh.sides);
}

TEST(joined_walls) {
    struct wall_words w[MOST];
    ck_assert_int_eq(
        walls_of_text("zmin:temperature=1200:emissivity=0.8,zmax:open:at=-.5,cylinder:0,-1e-1,.48:power=-3,"
                      "mesh:a-b=c.stl:scale=0.001:name=hopper:normals:solids:insulated,box:insulated,auto,"
                      "ylo:temperature=@T.csv:absorptivity=0.2,xcylinder:1,2,3:temperatures=T.txt",
                      ALL, w),
        8);
    ck_assert(w[0].shape == WALL_PLANE && w[0].wall.plane.axis == 2 && !w[0].wall.plane.upper);
    ck_assert(isnan(w[0].wall.plane.at) && w[0].given == (WALL_TEMPERATURE | WALL_EMISSIVITY));
    ck_assert(w[0].temperature == 1200 && w[0].emissivity == .8 && isnan(w[0].power) && isnan(w[0].absorptivity));
    ck_assert(w[1].given == (WALL_OPEN | WALL_AT) && w[1].wall.plane.at == -.5 && w[1].wall.plane.upper);
    ck_assert(w[2].shape == WALL_CYLINDER && w[2].wall.cylinder.y == -.1 && w[2].wall.cylinder.radius == .48);
    ck_assert(w[2].power == -3 && w[2].emissivity == 1 && w[2].capacity == 0);
    ck_assert_str_eq(w[3].mesh.path, "a-b=c.stl");
    ck_assert_str_eq(w[3].mesh.name, "hopper");
    ck_assert(w[3].mesh.solids && w[3].mesh.sides == SIDES_NORMALS && w[3].mesh.scale == .001);
    ck_assert(w[4].shape == WALL_BOX && w[4].given == WALL_INSULATED && w[5].shape == WALL_AUTO && !w[5].given);
    ck_assert(w[6].wall.plane.axis == 1 && isnan(w[6].temperature) && w[6].absorptivity == .2);
    ck_assert_str_eq(w[6].temperature_text, "@T.csv");
    ck_assert_str_eq(w[7].temperatures, "T.txt");
    ck_assert_int_eq(walls_of_text("hopper_lid:insulated", ALL | WALL_NAMES_TOO, w), 1);
    ck_assert(w[0].shape == WALL_NAMED);
    ck_assert_str_eq(w[0].word, "hopper_lid");
}

/* Both forms say the same. Reading ends at the first word of the caller, and may go on behind it. */
TEST(words_apart) {
    static const char *const word[] = {"mesh", "h.stl",       "scale",      "0.5",      "motion", "both",      "solids",
                                       "name", "temperature", "v_T",        "sigma",    "1",      "zhi",       "open",
                                       "at",   "0.25",        "zmin",       "capacity", "3",      "zcylinder", "1",
                                       "2",    "3",           "emissivity", "0"};
    struct wall_words wall = {0}, joined[MOST];
    ck_assert_int_eq(wall_words_read(&wall, word, 12, ALL, fault), 4);
    ck_assert_int_eq(wall_words_read(&wall, word + 5, 7, ALL, fault), 4);
    ck_assert_str_eq(wall.mesh.name, "temperature");
    ck_assert_int_eq(walls_of_text("mesh:h.stl:scale=0.5:both:solids:name=x", ALL, joined), 1);
    same_wall(&wall, joined);
    ck_assert_int_eq(wall_words_read(&wall, word + 8, 4, ALL, fault), 2);
    ck_assert(isnan(wall.temperature) && strcmp(wall.temperature_text, "v_T") == 0);
    ck_assert_int_eq(walls_of_text("zmax:at=0.25:open,zlo:capacity=3,cylinder:1,2,3:emissivity=0", ALL, joined), 3);
    for (int k = 0, at = 12, n; k < 3; ++k, at += n) {
        wall = (struct wall_words){0};
        n = wall_words_read(&wall, word + at, 25 - at, ALL, fault);
        ck_assert_msg(n > 1, "%d: %s", k, fault);
        same_wall(&wall, &joined[k]);
    }
}

static const struct {
    const char *text, *fault;
} wrong[] = {{"zmni", "'zmni' is no wall; did you mean zmin? there are box, auto"},
             {"", "'' is no wall; there are"},
             {"zmin,", "'' is no wall; there are"},
             {"zmin:", "zmin: '' is of no use here; there are at, open"},
             {"zmin:temprature=3",
              "zmin: 'temprature' is of no use here; did you mean temperature? there are at, open, temperatu"},
             {"zmin:temperature", "zmin: temperature needs a value, 1200 for example"},
             {"zmin:temperature=", "zmin: temperature needs a value"},
             {"zmin:emissivity=1.5", "zmin: emissivity: 1.5 is not within 0 and 1"},
             {"zmin:emissivity=nan", "zmin: emissivity: 'nan' is not a number"},
             {"zmin:emissivity=.5x", "zmin: emissivity: '.5x' is not a number"},
             {"zmin:emissivity=.5:emissivity=.5", "zmin: emissivity is given twice"},
             {"zmin:temperature=5:power=5", "zmin: temperature excludes power"},
             {"zmin:temperature=5:open", "zmin: temperature excludes open; an opening is as black and as hot"},
             {"zmin:open:emissivity=1", "zmin: open excludes emissivity; an opening is as black and as hot"},
             {"zmin:insulated=1", "zmin: insulated takes no value, as '1' is"},
             {"zmin:scale=1", "zmin: 'scale' is of no use here; there are at, open"},
             {"box:at=1", "box: 'at' is of no use here; there are temperature"},
             {"mesh", "mesh: a file is missing, mesh:FILE"},
             {"mesh:", "mesh: a file is missing, mesh:FILE"},
             {"mesh:a.stl:bothh", "mesh:a.stl: 'bothh' is of no use here; did you mean both?"},
             {"mesh:a.stl:scale=0", "mesh:a.stl: scale: 0 is not within 1e-12 and 1e+12"},
             {"mesh:a.stl:both:normals", "mesh:a.stl: both excludes normals"},
             {"cylinder", "cylinder: needs X,Y,R, a place and a radius above 0"},
             {"xcylinder:1,2", "xcylinder: needs Y,Z,R"},
             {"ycylinder:1,2,0", "ycylinder: needs X,Z,R"},
             {"cylinder:1,2,3,4", "cylinder: needs X,Y,R"},
             {"cylinder:1,b,3", "cylinder: needs X,Y,R"},
             {"box:open=zmax", "box: 'open' is of no use here"},
             {"zmin=0.1", "zmin=0.1 is not how a wall is written: zmin:at=VALUE:temp"},
             {"tub=mesh:a.stl", "tub=mesh is not how"},
             {"cylinder=600,.9,0,0,1", "cylinder=600,.9,0,0,1 is not how"}};

LOOP_TEST(wrong_walls, sizeof wrong / sizeof *wrong) {
    struct wall_words wall[MOST];
    ck_assert_msg(walls_of_text(wrong[_i].text, ALL, wall) == 0, "%s", wrong[_i].text);
    ck_assert_msg(strstr(fault, wrong[_i].fault) == fault, "%s: %s", wrong[_i].text, fault);
}

TEST(keys_of_no_use) {
    struct wall_words wall[MOST];
    ck_assert_int_eq(walls_of_text("zmin:temperature=3", WALL_GEOMETRY, wall), 0);
    ck_assert_str_eq(fault, "zmin: 'temperature' is of no use here; there are at, open");
    ck_assert_int_eq(walls_of_text("zmin:temperature=3", 0, wall), 0);
    ck_assert_str_eq(fault, "zmin: 'temperature' is of no use here");
    static const char *const old[] = {"zlo", "1000", "0.9"}, *const last[] = {"zlo", "temperature"};
    wall[0] = wall[1] = (struct wall_words){0};
    ck_assert_int_eq(wall_words_read(&wall[0], old, 3, ALL, fault), 0);
    ck_assert_str_eq(fault, "zlo: `1000` needs a word before it, as in `zlo temperature 1200 emissivity 0.8`");
    ck_assert_int_eq(wall_words_read(&wall[1], last, 2, ALL, fault), 0);
    ck_assert_str_eq(fault, "zlo: temperature needs a value, 1200 for example");
}
