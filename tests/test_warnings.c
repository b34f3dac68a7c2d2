/* test_warnings.c - input that contradicts itself gives one warning, status 0, and the likely remedy.
 * SPDX-License-Identifier: MIT */
#include "program.h"

FIXTURE(make_folder, remove_folder)

#define BOX(kind, low, high) "ITEM: BOX BOUNDS " kind "\n" low " " high "\n" low " " high "\n" low " " high "\n"
#define FRAME(step, box, columns, rows)                                                                                \
    "ITEM: TIMESTEP\n" step "\nITEM: NUMBER OF ATOMS\n3\n" box "ITEM: ATOMS id x y z radius" columns "\n" rows
#define ROWS(a, b, c)                                                                                                  \
    "1 .02 .02 .02 .01" a "\n2 .05 .05 .05 .01" b "\n3 .08 .08 .08 .01" c "\n" /* from .01 to .09 along each axis */
#define OPEN   BOX("ff ff ff", "0", ".1")
#define SHRUNK BOX("ss ss ss", ".02", ".08")
#define PLAIN  FRAME("0", OPEN, " T", ROWS(" 600", " 700", " 800"))

#define FACET(a, b, c) "facet normal 0 0 0\nouter loop\nvertex " a "\nvertex " b "\nvertex " c "\nendloop\nendfacet\n"
/* A closed mesh with a corner at the origin. All spheres of PLAIN lie within a mesh with edges of .3. */
#define CORNER(edge)                                                                                                   \
    "solid s\n" FACET("0 0 0", edge " 0 0", "0 " edge " 0") FACET("0 0 0", "0 " edge " 0", "0 0 " edge)                \
        FACET("0 0 0", "0 0 " edge, edge " 0 0") FACET(edge " 0 0", "0 0 " edge, "0 " edge " 0") "endsolid s\n"
/* This mesh lies within the first sphere. */
#define WITHIN   "solid s\n" FACET(".018 .018 .021", ".022 .018 .021", ".02 .022 .021") "endsolid s\n"
#define FAR_AWAY "solid s\n" FACET("5 0 0", "5.1 0 0", "5 .1 0") "endsolid s\n"

#define HEAT_AT(ambient) "heat", "--emissivity", ".6", "--directions", "21", "--patches", "24", "--ambient", ambient
#define HEAT             HEAT_AT("300")
#define TIME             "--until", "1"

static const struct {
    const char *words[20], *bed, *more, *reason; /* more: a further frame; reason: NULL if there is no warning */
} said_of[] = {
    {{HEAT, "--temperature", "T"}, PLAIN, NULL, NULL},
    {{HEAT, "--temperature", "T", "--wall", "box:temperature=500,zmax:open"}, PLAIN, NULL, NULL},
    {{HEAT, "--temperature", "T", "--wall", "box:temperature=500"},
     PLAIN,
     NULL,
     "--ambient has no effect: nothing leaves a bed"},
    {{HEAT, "--temperature", "T", "--wall", "zmin:temperature=30"}, PLAIN, NULL, "zmin is 30 K; --temperature-unit C"},
    {{HEAT, "--temperature", "T", "--periodic", ".1,.1,0"}, PLAIN, NULL, NULL},
    {{HEAT, "--temperature", "T", "--periodic", ".1,.2,0"},
     PLAIN,
     NULL,
     "--periodic is 0.2 along y, and the box of the file is 0.1 long"},
    {{HEAT, "--temperature", "T", "--wall", "zmin:at=.012:temperature=500,zmax:at=.1:temperature=500"},
     PLAIN,
     NULL,
     "sphere 1 reaches through the wall zmin by 0.2 of its radius (1 such cases in all)"},
    {{HEAT, "--temperature", "T", "--wall", "zmin:at=.0105:temperature=500"}, PLAIN, NULL, NULL},
    {{HEAT, "--temperature", "T", "--wall",
      "cylinder:.05,.05,.05:temperature=500,zmin:at=0:temperature=500,zmax:open:at=.1"},
     PLAIN,
     NULL,
     "through the wall cylinder by 0.24 of its radius (2 such cases in all)"},
    {{"factors", "--wall", "auto"}, FRAME("0", SHRUNK, "", ROWS("", "", "")), NULL, "stand where the spheres end"},
    {{"factors", "--wall", "zmin"}, FRAME("0", SHRUNK, "", ROWS("", "", "")), NULL, "stand where the spheres end"},
    {{"factors", "--wall", "mesh:m.stl"}, PLAIN, CORNER(".3"), NULL},
    {{"factors", "--wall", "mesh:m.stl"},
     PLAIN,
     CORNER("300"),
     "the wall m is 300 long, the bed 0.08; is the mesh in the unit of the bed? mesh:FILE:scale=0.001 scales the mesh"},
    {{"factors", "--wall", "mesh:m.stl:scale=1e-3"}, PLAIN, CORNER("300"), NULL},
    {{"factors", "--wall", "mesh:m.stl:both"}, PLAIN, CORNER("3e-4"), "mesh:FILE:scale=1000 scales the mesh"},
    {{"factors", "--wall", "mesh:m.stl:both"},
     PLAIN,
     FAR_AWAY,
     "the wall m lies from 5 to 5.1 along x, the bed from 0.01"},
    {{"factors", "--wall", "mesh:m.stl:both"}, PLAIN, WITHIN, "do triangles cut spheres?"},
    {{"factors", "--emissivity", ".5", "--wall", "mesh:m.stl:both:emissivity=.5"},
     PLAIN,
     WITHIN,
     "do triangles cut spheres?"},
    {{HEAT, "--temperature", "T_C"},
     FRAME("0", OPEN, " T_C", ROWS(" 600", " 700", " 800")),
     NULL,
     "the column T_C is taken as kelvins; --temperature-unit C"},
    {{HEAT, "--temperature", "T_C", "--temperature-unit", "C"},
     FRAME("0", OPEN, " T_C", ROWS(" 600", " 700", " 20")),
     NULL,
     NULL},
    {{HEAT_AT("25"), "--temperature", "T"}, PLAIN, NULL, "--ambient is 25 K; --temperature-unit C"},
    {{HEAT_AT("25"), "--temperature", "T", "--temperature-unit", "C"}, PLAIN, NULL, NULL},
    {{HEAT_AT("4"), "--temperature", "T"}, PLAIN, NULL, NULL},
    {{HEAT, "--temperature", "T"},
     FRAME("0", OPEN, " T", ROWS(" 20", " 90", " 140")),
     NULL,
     "no sphere is warmer than 140 K; --temperature-unit C"},
    {{HEAT, "--temperature", "T"},
     FRAME("0", OPEN, " T", ROWS(" 600", " 0", " 700")),
     NULL,
     "sphere 2 has 0 K (1 spheres in all), others have up to 700 K"},
    {{HEAT, "--temperature", "0"}, PLAIN, NULL, NULL},
    {{HEAT, "--temperature", "T", TIME, "--heat-capacity", "800", "--density", "2500"}, PLAIN, NULL, NULL},
    {{HEAT, "--temperature", "T", TIME, "--heat-capacity", ".8", "--density", "2500"},
     PLAIN,
     NULL,
     "the heat capacity is 0.8 J/(kg K); solids have"},
    {{HEAT, "--temperature", "T", TIME, "--heat-capacity", "800", "--density", "2.5"},
     PLAIN,
     NULL,
     "the density is 2.5 kg/m3; solids have"},
    {{HEAT, "--temperature", "T", "--frame", "all"},
     FRAME("100", OPEN, " T", ROWS(" 600", " 0", " 700")), /* once for all frames */
     FRAME("200", OPEN, " T", ROWS(" 600", " 0", " 700")),
     "has 0 K"},
    {{HEAT, "--temperature", "T"},
     "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\n" OPEN "ITEM: ATOMS x y z r T\n0 0 0 6e-6 500\n1e-4 0 0 7e-6 800\n",
     NULL,
     "sphere 0 (one of 1) has a radius of 6e-06 m. Radiation of 800 K has wavelengths of 3.6e-06 m"},
    {{HEAT, "--temperature", "T"},
     "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\n" OPEN "ITEM: ATOMS x y z r T\n0 0 0 7e-6 500\n1e-4 0 0 7e-6 800\n",
     NULL,
     NULL},
    {{"factors", "--frame", "all"}, PLAIN, PLAIN, NULL},
    {{"factors", "--frame", "all"},
     FRAME("1000", OPEN, "", ROWS("", "", "")),
     FRAME("200", OPEN, "", ROWS("", "", "")),
     "timestep 200 follows timestep 1000; a pattern in quotes"}};

/* Counts how often a text contains another one. */
static int count_of(const char *text, const char *what) {
    int count = 0;
    for (; (text = strstr(text, what)); text += strlen(what)) ++count;
    return count;
}

LOOP_TEST(one_warning_each, sizeof said_of / sizeof *said_of) {
    const char *const *words = said_of[_i].words, *more = said_of[_i].more, *reason = said_of[_i].reason;
    const char *arguments[40] = {0}, *json = in_folder("summary.json");
    const int mesh = more && strncmp(more, "solid", 5) == 0;
    int count = 0;
    write_file("bed.dump", said_of[_i].bed);
    if (mesh) write_file("m.stl", more);
    if (more && !mesh) {
        OWNED_FILE *file = opened(in_folder("bed.dump"), "a");
        fputs(more, file);
    }
    for (; words[count]; ++count) {
        const char *path = mesh ? strstr(words[count], "m.stl") : NULL;
        arguments[count] = path ? formatted("mesh:%s/%s", folder, path) : words[count];
    }
    const char *const rest[] = {in_folder("bed.dump"), "--length-unit", "m", "--json", json};
    for (int k = 0; k < 5; ++k) arguments[count++] = rest[k];
    ck_assert_msg(finish(start(arguments)) == 0, "%s", said);
    const char *text = read_file(json);
    int others = count_of(said, "the mesh is not closed"); /* of the file itself */
    ck_assert_msg(count_of(said, "warning: ") == (reason != NULL) + others, "%s", said);
    ck_assert_int_eq(count_of(text, "warning: "), (reason != NULL) + others);
    if (reason) ck_assert_msg(strstr(said, reason) && strstr(text, reason), "'%s' lacks '%s'", said, reason);
    ck_assert_int_eq(count_of(text, "\"warnings\": ["), said_of[_i].more && !mesh ? 2 : 1);
}

/* Walls about a box of centres stand at the surfaces of the spheres. Walls about a real box stand where it ends. If a
 * sphere has left a real box, it is refused as before. */
TEST(walls_at_surfaces) {
    const char *bed = write_file("bed.dump", FRAME("0", SHRUNK, "", ROWS("", "", "")));
    static const char *const names[] = {"xmin", "ymin", "zmin", "xmax", "ymax", "zmax"};
    SUCCEED("factors", bed, "--wall", "auto");
    for (int k = 0; k < 6; ++k) {
        ck_assert_double_eq_tol(value_of(formatted("wall_%s_at", names[k])), k < 3 ? .01 : .09, 1e-9);
        ck_assert_double_eq_tol(value_of(formatted("wall_%s_area", names[k])), .08 * .08, 1e-8);
    }
    SUCCEED("factors", bed, "--wall", "zmin:at=.015");
    ck_assert_double_eq(value_of("wall_zmin_at"), .015);
    SUCCEED("factors", write_file("bed.dump", PLAIN), "--wall", "auto");
    ck_assert_double_eq_tol(value_of("wall_zmax_at"), .1, 1e-12);
    FAIL_WITH(3, "factors", write_file("bed.dump", FRAME("0", BOX("ff ff ff", "0", ".06"), "", ROWS("", "", ""))),
              "--wall", "auto");
    assert_has(said, "the centre of sphere 3 lies beyond the wall xmax");
}

/* The summary has the ends of a mesh. */
/* A plate goes through a bed. Closing takes something from the spheres that the plate cuts, of which rows know nothing.
 * Raw rows all add up to one. */
TEST(closing_that_changes_much) {
    const char *wall = formatted("auto,mesh:%s:both",
                                 write_file("m.stl", "solid s\n" FACET("1 2 3", "11 3 9", "4 11 15") "endsolid s\n"));
    SUCCEED("factors", "tests/data/mono2000.dump", "--cutoff", "3", "--wall", wall);
    assert_has(said, "this changes what sphere");
    SUCCEED("factors", "tests/data/mono2000.dump", "--raw", "--wall", wall);
    assert_lacks(said, "this changes what sphere");
    const char *closure = strstr(printed, "\nclosure_max ");
    ck_assert(closure != NULL && strtod(closure + 13, NULL) < 1e-12);
}

TEST(mesh_extents_are_said) {
    const char *json = in_folder("summary.json");
    const char *wall = formatted("mesh:%s:scale=2", write_file("m.stl", CORNER(".3")));
    SUCCEED("factors", write_file("bed.dump", PLAIN), "--wall", wall, "--json", json);
    assert_has(printed, "\nwall_m_low 0 0 0\nwall_m_high 0.6 0.6 0.6\n");
    assert_has(read_file(json), "\"warnings\": []}");
}
