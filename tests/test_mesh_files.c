/* test_mesh_files.c - walls of triangles from files: how they are read and welded, which side is the wall, --wall
 * mesh:FILE. SPDX-License-Identifier: MIT */
#include "bed/wall_option.h"
#include "mesh/meshes.h"
#include "plot/plot_slice.h"
#include "soups.h"
#include "vtp_text.h"
#include "read/vtk/vtk_grid.h"

FIXTURE(make_folder, remove_folder)

static struct soup cube(void) {
    struct soup soup = {0};
    soup_cube(&soup, 4);
    return soup;
}

/* ---- files ------------------------------------------------------------------------------------------------------ */

static void assert_cube(const char *path, bool text) {
    const struct soup soup = cube();
    OWNED_BY(stl_free) struct stl stl;
    ck_assert_int_eq(stl_read(&stl, path), 0);
    ck_assert_uint_eq(stl.n, 12);
    ck_assert(stl.text == text && stl.solids == 1);
    for (uint32_t t = 0; t < 12; ++t) {
        ck_assert_uint_eq(stl.place[t], text ? 2 + 7 * t : t);
        for (int k = 0; k < 9; ++k) ck_assert_double_eq(stl.corner[t][k / 3][k % 3], soup.corner[t][k / 3][k % 3]);
    }
}

TEST(the_same_in_every_form) {
    const struct soup soup = cube();
    const char *text = write_solid("a.stl", &soup), *binary = write_binary("b.stl", &soup, "made by a test", 0);
    assert_cube(text, true);
    assert_cube(binary, false);
    assert_cube(write_binary("c.stl", &soup, "solid is how some binary files begin", 0), false);
    assert_cube(pack_file("a.stl.gz", text), true);
    assert_cube(pack_file("b.stl.gz", binary), false);
    FILE *file = fopen(in_folder("d.stl"), "w");
    print_solid(file, "", &soup, "\r\n", 9);
    fclose(file);
    assert_cube(in_folder("d.stl"), true);
}

#define FACET(corners) "solid s\nfacet normal 0 0 1\nouter loop\n" corners "endloop\nendfacet\nendsolid s\n"

static const struct {
    const char *text, *line, *reason;
} broken[] = {{"", "", "is empty"},
              {"solid s\nendsolid s\n", "", "no triangles"},
              {"nothing of the kind\n", "", "this is no STL file and no OBJ file"},
              {"x,y,z,r\n0,0,0,1\n0,0,2,1\n0,0,4,1\n0,0,6,1\n0,0,8,1\n0,0,10,1\n0,0,12,1\n0,0,14,1\n0,0,16,1\n", "",
               "this is no STL file and no OBJ file"},
              {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", ":4", "there is no vertex 4"},
              {"# o\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 -4 2\n", ":5", "there is no vertex -4"},
              {"v 0 0 0\nv 1 0 0\nf 1 2\n", ":3", "a face has three corners or more"},
              {"v 0 0\n", ":1", "three coordinates, not 2"},
              {"o s\nv 0 0 0\n", "", "no triangles"},
              {FACET("vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 nan\n"), ":6", "the coordinate is not finite: 'nan'"},
              {FACET("vertex 0 0 0\nvertex inf 0 0\nvertex 0 1 0\n"), ":5", "the coordinate is not finite: 'inf'"},
              {FACET("vertex 0 0 0\nvertex 1 0 0\nvertex 0 1e200 0\n"), ":6", "too large"},
              {FACET("vertex 0 0 0\nvertex 1 0 x\nvertex 0 1 0\n"), ":5", "the coordinate is not a number: 'x'"},
              {FACET("vertex 0 0 0\nvertex 1 0\nvertex 0 1 0\n"), ":5", "three coordinates, not 2"},
              {FACET("vertex 0 0 0\nvertex 1 0 0\nvortex 0 1 0\n"), ":6", "'vortex' is no word of an STL file"},
              {FACET("vertex 0 0 0\nvertex 1 0 0\n"), ":6", "'endloop' is out of place"},
              {FACET("vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nvertex 1 1 0\n"), ":7", "'vertex' is out of place"},
              {"solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n", ":4", "ends within a solid"},
              {FACET("vertex 0 0 0\nvertex 1 0 0\nvertex 2 0 0\n"), "", "no triangle has an area"},
              {FACET("vertex 0 0 0\nvertex 1 0 0\nvertex 1 0 0\n"), "", "no triangle has an area"}};

static void refuse(const char *path, const char *line, const char *reason) {
    FAIL_WITH(3, "factors", MONO, "--wall", formatted("mesh:%s", path));
    expect_message(formatted("%s%s: ", path, line), reason);
}

LOOP_TEST(broken_text_is_refused, sizeof broken / sizeof *broken) {
    refuse(write_file("x.stl", broken[_i].text), broken[_i].line, broken[_i].reason);
}

TEST(broken_binaries_are_refused) {
    struct soup soup = cube();
    refuse(write_binary("x.stl", &soup, "", 1), "",
           "this is no STL file: a binary one of 12 triangles has 684 bytes, not 685");
    refuse(write_binary("x.stl", &soup, "solid", -50), "", "684 bytes, not 634");
    refuse(write_binary("x.stl", &soup, "", -620), "", "no STL file");
    soup.corner[7][1][2] = NAN;
    refuse(write_binary("x.stl", &soup, "", 0), "", "triangle 7: a coordinate is not finite");
    soup.n = 0;
    refuse(write_binary("x.stl", &soup, "", 0), "", "no triangles");
    FAIL_WITH(4, "factors", MONO, "--wall", "mesh:nothing.stl");
    expect_message("nothing.stl: ", "No such file");
}

/* Comments may stand before the first solid. Faces of OBJ files are polygons. */
TEST(texts_of_other_kinds_are_read) {
    OWNED_BY(stl_free) struct stl stl;
    write_file("x.stl", "# floor\n\n# of a mill\n" FACET("vertex 0 0 0\nvertex 1 0 0\n# a corner\nvertex 0 1 0\n"));
    ck_assert_int_eq(stl_read(&stl, in_folder("x.stl")), 0);
    ck_assert(stl.text && stl.n == 1 && stl.place[0] == 5 && stl.corner[0][2][1] == 1);
    stl_free(&stl);
    write_file("x.obj",
               "# of a modeller\nmtllib a.mtl\no plate\nv 0 0 0\nv 1 0 0 1\nv 1 1 0 .5 .5 .5\nv 0 1 0\nvn 0 0 1\n"
               "s off\nf 1//1 2//1 3//1 4//1\ng\no the lid\nv 0 0 1\nf -1 -2/7 1 # last\n");
    ck_assert_int_eq(stl_read(&stl, in_folder("x.obj")), 0);
    ck_assert(stl.n == 3 && stl.solids == 1 && stl.place[2] == 14);
    const double lid[3][3] = {{0, 0, 1}, {0, 1, 0}, {0, 0, 0}}, second[3][3] = {{0, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    ck_assert_mem_eq(stl.corner[2], lid, sizeof lid);
    ck_assert_mem_eq(stl.corner[1], second, sizeof second);
}

/* ---- surfaces --------------------------------------------------------------------------------------------------- */

static struct surface surface_of(const struct soup *soup, double scale) {
    OWNED_BY(stl_free) struct stl stl;
    struct surface surface;
    ck_assert_int_eq(stl_read(&stl, write_solid("s.stl", soup)), 0);
    ck_assert_int_eq(surface_weld(&surface, &stl, scale), 0);
    ck_assert_int_eq(surface_find_components(&surface), 0);
    return surface;
}

TEST(corners_are_welded) {
    struct soup soup = cube();
    for (int trial = 0; trial < 50; ++trial) {
        for (uint32_t t = 0; t < soup.n && trial > 0; ++t)
            for (int k = 0; k < 9; ++k) {
                double *c = &soup.corner[t][k / 3][k % 3];
                *c = copysign(4 + 1e-6 * (rand() / (double)RAND_MAX), *c);
            }
        OWNED_BY(surface_free) struct surface s = surface_of(&soup, 1000);
        ck_assert_uint_eq(s.vertices, 8);
        ck_assert_uint_eq(s.components, 1);
        ck_assert(s.component[0].closed && !s.component[0].twisted && s.open == 0 && s.crowded == 0);
        ck_assert_uint_eq(s.snapped, trial > 0 ? 28 : 0);
        ck_assert_double_eq_tol(fabs(s.vertex[5][1]), 4000, 2e-3);
    }
}

TEST(what_is_not_sound_is_counted) {
    struct soup soup = cube();
    const double a[3] = {-4, -4, -4}, b[3] = {4, -4, -4}, middle[3] = {0, -4, -4}, far[3] = {0, -9, 0};
    soup_add(&soup, a, b, b);      /* two of its corners are one */
    soup_add(&soup, a, middle, b); /* no area */
    soup_add(&soup, soup.corner[3][1], soup.corner[3][0], soup.corner[3][2]);
    soup_add(&soup, a, b, far); /* a fin at an edge of two triangles */
    OWNED_BY(surface_free) struct surface s = surface_of(&soup, 1);
    ck_assert_uint_eq(s.flat, 2);
    ck_assert_uint_eq(s.twice, 1);
    ck_assert_uint_eq(s.n, 14);
    ck_assert_uint_eq(s.crowded, 1);
    ck_assert_uint_eq(s.open, 4);
}

/* ---- sides ------------------------------------------------------------------------------------------------------ */

/* Makes the meshes of one soup of triangles, with sides for a bed of spheres of radius 0.4. */
static struct meshes faced(const struct soup *soup, enum mesh_sides sides, uint32_t n, double centre[3][8]) {
    static double r[8] = {.4, .4, .4, .4, .4, .4, .4, .4};
    const struct mesh_file file = {.path = write_solid("m.stl", soup), .sides = sides, .scale = 1};
    struct meshes meshes = {0};
    ck_assert_int_eq(meshes_add(&meshes, &file, 0), 0);
    const fibrad_spheres spheres = {.x = centre[0], .y = centre[1], .z = centre[2], .r = r, .n = n};
    ck_assert_int_eq(meshes_face(&meshes, &spheres, (const double[]){0, 0, 0}), 0);
    return meshes;
}

/* Checks that the side of a triangle on which a point lies belongs to the wall, and that the other side belongs to
 * none. */
static void assert_side(const struct meshes *meshes, uint32_t t, const double point[3]) {
    const struct surface *s = &meshes->mesh[0].surface;
    const double *at = surface_corner(s, t, 0);
    double normal[3], height = 0;
    surface_normal(s, t, normal);
    for (int axis = 0; axis < 3; ++axis) height += normal[axis] * (point[axis] - at[axis]);
    ck_assert_uint_eq(meshes->front[t], height > 0 ? 0 : FIBRAD_NO_WALL);
    ck_assert_uint_eq(meshes->back[t], height > 0 ? FIBRAD_NO_WALL : 0);
}

/* The triangles of a cube are wound at random. Spheres lie within it, or around it. */
TEST(sides_of_a_cube) {
    for (int trial = 0; trial < 40; ++trial) {
        struct soup soup = cube();
        if (trial > 0) soup_flip(&soup, trial == 1);
        double inside[3][8], outside[3][8];
        for (int k = 0; k < 24; ++k) inside[k / 8][k % 8] = 7 * (rand() / (double)RAND_MAX) - 3.5;
        for (int k = 0; k < 24; ++k) outside[k / 8][k % 8] = k / 8 == k % 3 ? 5 : inside[k / 8][k % 8];
        OWNED_BY(meshes_free) struct meshes within = faced(&soup, SIDES_AUTO, 8, inside);
        for (uint32_t t = 0; t < 12; ++t) assert_side(&within, t, (const double[]){0, 0, 0});
        ck_assert_uint_eq(within.enclosing, 1);
        ck_assert_ptr_null(meshes_beyond(&within, (const double[]){3.9, 0, 0}, .4, (const double[]){0, 0, 0}));
        ck_assert_ptr_null(meshes_beyond(&within, (const double[]){4.3, 0, 0}, .4, (const double[]){0, 0, 0}));
        ck_assert_str_eq(meshes_beyond(&within, (const double[]){4.5, 0, 0}, .4, (const double[]){0, 0, 0}), "m");
        OWNED_BY(meshes_free) struct meshes about = faced(&soup, SIDES_AUTO, 8, outside);
        for (uint32_t t = 0; t < 12; ++t) {
            const struct surface *s = &about.mesh[0].surface;
            double normal[3], far[3];
            surface_normal(s, t, normal);
            for (int axis = 0; axis < 3; ++axis) {
                const double *c[3] = {surface_corner(s, t, 0), surface_corner(s, t, 1), surface_corner(s, t, 2)};
                far[axis] = (c[0][axis] + c[1][axis] + c[2][axis]) * 10;
            }
            assert_side(&about, t, far);
        }
        ck_assert_uint_eq(about.enclosing, 0);
        ck_assert_str_eq(meshes_beyond(&about, (const double[]){0, 0, 3.5}, .4, (const double[]){0, 0, 0}), "m");
    }
}

TEST(sides_of_a_funnel) {
    for (int trial = 0; trial < 20; ++trial) {
        struct soup soup = {0};
        soup_cone(&soup, 1, 2, (const double[]){0, 5}, (const double[]){1, 4}, 24);
        soup_flip(&soup, 0);
        double centre[3][8] = {{1, 1.5, 3, -1, 1, 1, 1, 2}, {2, 2, 2, 2, 4, 0, 2, 2}, {2, 1, 4, 4, 4, 4, 6, -1}};
        OWNED_BY(meshes_free)
        struct meshes meshes = faced(&soup, SIDES_AUTO, 8, centre); /* one lies above it, one below its end */
        for (uint32_t t = 0; t < soup.n; ++t) assert_side(&meshes, t, (const double[]){1, 2, 2.5});
        ck_assert_uint_eq(meshes.mesh[0].surface.components, 1);
        ck_assert_uint_eq(meshes.mesh[0].surface.open, 48);
    }
}

/* One file has a tube in a box. The outside of the tube and the inside of the box are the wall. */
TEST(sides_of_a_tube_in_a_box) {
    for (int trial = 0; trial < 20; ++trial) {
        struct soup soup = cube();
        soup_cone(&soup, 1, 0, (const double[]){-3.9, 3.9}, (const double[]){.5, .5}, 12);
        soup_flip(&soup, 0);
        double centre[3][8] = {{2, 0, 1, -3, 3, 1, 2, -2}, {0, 0, 1, 3, -3, -1, 2, 0}, {0, 1, 2, 3, -3, -2, -1, 3}};
        OWNED_BY(meshes_free) struct meshes meshes = faced(&soup, SIDES_AUTO, 8, centre);
        const struct surface *s = &meshes.mesh[0].surface;
        ck_assert_uint_eq(s->components, 2);
        for (uint32_t t = 0; t < soup.n; ++t) {
            const double *at = surface_corner(s, t, 0);
            assert_side(&meshes, t,
                        t < 12 ? (const double[]){0, 0, 0}
                               : (const double[]){1 + 9 * (at[0] - 1 + surface_corner(s, t, 1)[0] - 1),
                                                  9 * (at[1] + surface_corner(s, t, 1)[1]), 0});
        }
        ck_assert_uint_eq(meshes.enclosing, 1);
    }
}

TEST(sides_that_are_asked_for) {
    struct soup soup = cube();
    double centre[3][8] = {{0}, {0}, {0}};
    OWNED_BY(meshes_free)
    struct meshes both = faced(&soup, SIDES_BOTH, 1, centre), normals = faced(&soup, SIDES_NORMALS, 1, centre);
    for (uint32_t t = 0; t < 12; ++t) {
        ck_assert(both.front[t] == 0 && both.back[t] == 0);
        ck_assert(normals.front[t] == 0 && normals.back[t] == FIBRAD_NO_WALL);
    }
    ck_assert_uint_eq(both.enclosing + normals.enclosing, 0);
    soup_flip(&soup, 1);
    OWNED_BY(meshes_free) struct meshes turned = faced(&soup, SIDES_NORMALS, 1, centre);
    ck_assert_uint_eq(turned.enclosing, 1);
    soup.n = 0; /* a strip that is twisted once has one side */
    for (int k = 0; k < 20; ++k) {
        double p[4][3];
        for (int c = 0; c < 4; ++c) {
            const double angle = 2 * PI * (k + c % 2) / 20, off = (c / 2 ? .5 : -.5), turn = angle / 2;
            p[c][0] = (3 + off * cos(turn)) * cos(angle), p[c][1] = (3 + off * cos(turn)) * sin(angle);
            p[c][2] = off * sin(turn);
        }
        soup_add(&soup, p[0], p[1], p[3]);
        soup_add(&soup, p[0], p[3], p[2]);
    }
    OWNED_BY(meshes_free) struct meshes strip = faced(&soup, SIDES_AUTO, 1, centre);
    ck_assert_uint_eq(strip.mesh[0].surface.components, 1);
    ck_assert(strip.mesh[0].surface.component[0].twisted);
    for (uint32_t t = 0; t < soup.n; ++t) ck_assert(strip.front[t] == 0 && strip.back[t] == 0);
}

/* ---- the option ------------------------------------------------------------------------------------------------- */

/* Returns "WORD FILE REST" without blanks. */
static const char *wall_of(const char *before, const char *path, const char *after) {
    return formatted("%s%s%s", before, path, after);
}

TEST(names_of_meshes) {
    const struct soup soup = cube();
    const char *path = write_solid("my-box.v2.stl", &soup), *two = in_folder("two.stl");
    FILE *file = fopen(two, "w");
    print_solid(file, "floor no 1", &soup, "\n", 9);
    print_solid(file, "", &soup, "\n", 9);
    print_solid(file, "floor no 2", &soup, "\n", 9);
    print_solid(file, "floor no 1", &soup, "\n", 9);
    fclose(file);
    struct wall_options options = {0};
    ck_assert_int_eq(walls_option(wall_of("zmin:at=-9,mesh:", path, ",zmax"), &options), 0);
    ck_assert_int_eq(walls_option(wall_of("mesh:", path, ":name=tub:both:scale=0.5"), &options), 0);
    ck_assert_int_eq(walls_option(wall_of("mesh:", two, ":solids"), &options), 0);
    ck_assert_int_eq(walls_settle(&options), 0);
    static const char *const names[] = {"zmin",           "my_box", "zmax",           "tub",
                                        "two_floor_no_1", "two_2",  "two_floor_no_2", "two_4"};
    ck_assert_uint_eq(options.walls.count, 8);
    for (uint32_t k = 0; k < 8; ++k) ck_assert_str_eq(wall_name(&options.walls, k), names[k]);
    ck_assert_double_eq(fabs(options.walls.meshes->vertex[3 * 8]), 2); /* the first of the second mesh */
    walls_free(&options);
    static const char *const wrong[][2] = {
        {"mesh:", ":name=zmin"}, {"mesh:", ":name=a-b"}, {"mesh:", ":name="}, {"mesh:", ":name=beyond"},
        {"mesh:", ":bothh"},     {"mesh:", ":scale=0"},  {"mesh:", ":"},      {"tub=mesh:", ""}};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
        OWNED_BY(walls_free) struct wall_options other = {0};
        int status = walls_option(wall_of(wrong[k][0], path, wrong[k][1]), &other);
        if (!status) status = walls_settle(&other);
        ck_assert_msg(status == 2, "%s FILE%s", wrong[k][0], wrong[k][1]);
    }
    ck_assert_int_eq(walls_option("mesh:", &(struct wall_options){0}), 2);
}

static void read_array(const char *path, const char *name, double *values, size_t n) {
    vtp_array(read_file(path), name, values, n);
}

/* The sum of fluxes, or of another quantity per area, over n triangles from `first` on. */
static double gain_of(const char *path, const char *name, size_t first, size_t n) {
    double flux[200], area[200], sum = 0;
    read_array(path, name, flux, first + n);
    read_array(path, "area", area, first + n);
    for (size_t t = first; t < first + n; ++t) sum += flux[t] * area[t];
    return sum;
}

#define BED "x,y,z,r,T\n-1,0,0,1,500\n1.1,0,0,1,600\n0,2,1,.5,700\n"

/* A closed mesh about a bed gets what six planes get. Its triangles are written as ParaView reads them. */
TEST(rows_in_a_closed_mesh) {
    struct soup soup = cube();
    soup_flip(&soup, 0);
    const char *bed = write_file("bed.csv", BED), *box = write_solid("box.stl", &soup), *out = in_folder("w.vtp");
    SUCCEED("factors", bed, "--wall", "xmin:at=-4,xmax:at=4,ymin:at=-4,ymax:at=4,zmin:at=-4,zmax:at=4");
    double planes = 0;
    static const char *const names[] = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"};
    for (int k = 0; k < 6; ++k) planes += value_of(formatted("wall_%s_F", names[k]));
    SUCCEED("factors", bed, "--wall", wall_of("mesh:", box, ":name=tub"), "--wall-vtp", out);
    ck_assert_double_eq_tol(value_of("wall_tub_F"), planes, 1e-3);
    ck_assert_double_eq_tol(value_of("wall_tub_area"), 384, 1e-3);
    ck_assert_double_eq(value_of("wall_tub_triangles"), 12);
    ck_assert_str_eq(said, "");
    /* the mesh sees of spheres what spheres see of it */
    ck_assert_double_eq_tol(gain_of(out, "F_spheres", 0, 12) / 384, 1 - value_of("wall_tub_to_walls"), 1e-3);
    ck_assert_double_eq(gain_of(out, "F_surroundings", 0, 12), 0);

    char *text = read_file(out);
    struct vtk_grid grid = {.file = out, .text = text, .end = text + strlen(text)};
    ck_assert_int_eq(vtk_read_xml(&grid), 0);
    ck_assert_uint_eq(grid.n, 8);
    ck_assert_double_eq(fabs(grid.points[23]), 4);
    assert_has(text, "NumberOfPolys=\"12\"");
    free(grid.points);
    FAIL_WITH(2, "factors", bed, "--wall-vtp", out);
    expect_message("--wall-vtp", "no --wall mesh:FILE");
}

/* A cube in the slice of a picture has its outline there, in pieces that belong to the triangles. */
TEST(slice_through_a_mesh) {
    const struct soup soup = cube();
    OWNED_BY(walls_free) struct wall_options options = {0};
    OWNED_BED bed = bed_empty();
    struct plot_slice slice;
    const double value = 1;
    char line[200];
    double end[2][2], length = 0;
    int pieces = 0, ends = 0;
    ck_assert_int_eq(walls_option(wall_of("mesh:", write_solid("box.stl", &soup), ""), &options), 0);
    ck_assert_int_eq(walls_settle(&options), 0);
    ck_assert_int_eq(bed_add(&bed, &(struct bed_sphere){.x = 1, .y = .3, .r = 3.5}), 0);
    plot_slice_of(&slice, &(struct plot_plane){0}, &bed, &options.walls);
    ck_assert(slice.low[0] == -4 && slice.high[2] == 4);
    OWNED_FILE *script = tmpfile();
    plot_slice_draw(script, &slice, &(struct plot_colours){.value = &value, .unit = 1});
    rewind(script);
    while (fgets(line, sizeof line, script) && strncmp(line, "$walls", 6) != 0) {}
    while (fgets(line, sizeof line, script) && strncmp(line, "END", 3) != 0) {
        const bool found = sscanf(line, "%lf %lf", &end[ends][0], &end[ends][1]) == 2;
        ends = found ? ends + 1 : 0;
        if (ends < 2) continue;
        ends = 0;
        ++pieces;
        length += hypot(end[1][0] - end[0][0], end[1][1] - end[0][1]);
        for (int e = 0; e < 2; ++e) ck_assert_double_eq_tol(fmax(fabs(end[e][0]), fabs(end[e][1])), 4, 1e-6);
    }
    ck_assert_int_eq(pieces, 8);
    ck_assert_double_eq_tol(length, 32, 1e-5);
}

/* The program names backs that are seen, and spheres that lie behind them. */
TEST(backs_of_meshes) {
    struct soup soup = {0};
    soup_box(&soup, (const double[]){-3, -3, -3}, (const double[]){0, 3, 3});
    const char *bed = write_file("bed.csv", BED "5,0,0,1,300\n"), *text = write_solid("half.stl", &soup);
    const char *binary = write_binary("half_b.stl", &soup, "", 0);
    FAIL_WITH(3, "factors", bed, "--wall", wall_of("mesh:", text, ""));
    assert_has(said, "the back of wall half is seen, at line ");
    assert_has(said, "half.stl:both makes both sides the wall");
    assert_has(said, "bed.csv:3: warning: all of sphere 1 lies beyond wall half");
    FAIL_WITH(3, "factors", bed, "--wall", wall_of("mesh:", binary, ""), "--method", "cast", "--threads", "1");
    OWNED char *first = strdup(said);
    assert_has(said, "the back of wall half_b is seen, at triangle ");
    FAIL_WITH(3, "factors", bed, "--wall", wall_of("mesh:", binary, ""), "--method", "cast", "--threads", "2");
    ck_assert_str_eq(said, first);
    SUCCEED("factors", bed, "--wall", wall_of("mesh:", text, ":both")); /* the mesh cuts a sphere, so rows contradict */
    assert_lacks(said, "back of wall");
    assert_lacks(said, "not closed");
    soup.n -= 2;
    SUCCEED("factors", bed, "--wall", wall_of("mesh:", write_solid("half.stl", &soup), ":both"));
    expect_message(
        text, "warning: the mesh is not closed: 4 edges belong to one triangle, 0 to more than two; components: 1");
}

/* Rays of a plane start outside of the tube that stands on it, too. With a disc in place of the plane nothing is seen
 * from outside. */
TEST(a_plane_below_a_tube) {
    struct soup soup = {0};
    const char *bed = write_file("bed.csv", BED);
    soup_cone(&soup, 0, 0, (const double[]){-3, 3}, (const double[]){4, 4}, 24);
    const char *tube = wall_of("mesh:", write_solid("tube.stl", &soup), ":temperature=900");
    FAIL_WITH(3, "heat", bed, "--emissivity", "0.8", "--temperature", "T", "--ambient", "300", "--wall", tube, "--wall",
              "zmin:at=-3:temperature=500");
    assert_has(said, "the back of wall tube is seen, at line ");
    assert_has(said, "; rays of a plane start outside of a tube, too: its floor and lid must be meshes\n");
    soup_cone(&soup, 0, 0, (const double[]){-3, -3}, (const double[]){0, 4}, 24);
    tube = wall_of("mesh:", write_solid("tube.stl", &soup), ":temperature=900");
    SUCCEED("heat", bed, "--emissivity", "0.8", "--temperature", "T", "--ambient", "300", "--wall", tube);
}

/* ---- heat of triangles ------------------------------------------------------------------------------------------ */

/* Writes a file with a line of numbers for each triangle. */
static const char *write_column(const char *name, const char *head, int n, double first, double step) {
    const char *path = in_folder(name);
    OWNED_FILE *file = opened(path, "w");
    fputs(head, file);
    for (int k = 0; k < n; ++k) fprintf(file, "%.17g\n", first + step * k);
    return path;
}

#define STATE  "--emissivity", "0.7", "--temperature", "T", "--wall-vtp"
#define AT_400 ":temperature=400:emissivity=0.6"

/* The gains of triangles add up to the powers of their walls in the summary. */
TEST(heat_of_triangles) {
    const struct soup soup = cube();
    const char *bed = write_file("bed.csv", BED), *box = write_solid("box.stl", &soup), *out = in_folder("q.vtp");
    SUCCEED("heat", bed, "--length-unit", "cm", "--wall", wall_of("mesh:", box, AT_400), STATE, out);
    double kelvins[12], both[12], front[12];
    ck_assert_double_eq_tol(1e-4 * gain_of(out, "flux_W_m2", 0, 12) / value_of("wall_box_W"), 1, 1e-5);
    read_array(out, "temperature_K", kelvins, 12);
    for (int t = 0; t < 12; ++t) ck_assert_double_eq(kelvins[t], 400);
    assert_lacks(read_file(out), "front_W");

    SUCCEED("heat", bed, "--length-unit", "m", "--wall", wall_of("mesh:", box, ":both" AT_400), "--ambient", "300",
            STATE, out);
    ck_assert_double_eq_tol(gain_of(out, "flux_W_m2", 0, 12) / value_of("wall_box_W"), 1, 1e-5);
    const double outside = gain_of(out, "flux_front_W_m2", 0, 12); /* the fronts of the cube face outwards */
    ck_assert_double_eq_tol(outside, .6 * 384 * 5.670374419e-8 * (pow(300, 4) - pow(400, 4)), 1e-3 * fabs(outside));
    read_array(out, "temperature_front_K", front, 12), read_array(out, "temperature_K", both, 12);
    for (int t = 0; t < 12; ++t) ck_assert(front[t] == 400 && both[t] == 400);

    const char *two = in_folder("two.stl");
    struct soup half = soup, rest = soup;
    FILE *file = fopen(two, "w");
    half.n = 4, rest.n = 8;
    memmove(rest.corner, rest.corner + 4, 8 * sizeof *rest.corner);
    print_solid(file, "low", &half, "\n", 17), print_solid(file, "side", &rest, "\n", 17);
    fclose(file);
    SUCCEED("heat", bed, "--length-unit", "m", "--wall",
            wall_of("mesh:", two, ":solids:insulated:emissivity=0.6,two_low:temperature=400"), STATE, out, "--ambient",
            "0");
    ck_assert_double_eq_tol(gain_of(out, "flux_W_m2", 0, 4) / value_of("wall_two_low_W"), 1, 1e-5);
    read_array(out, "temperature_K", kelvins, 12), read_array(out, "flux_W_m2", both, 12);
    for (int t = 4; t < 12; ++t) ck_assert(both[t] == 0 && kelvins[t] > 400 && kelvins[t] < 700);

    SUCCEED("heat", bed, "--length-unit", "m", "--wall", wall_of("mesh:", box, AT_400), STATE, in_folder("t.*.vtp"),
            "--until", "10", "--heat-capacity", "800", "--density", "2500");
    ck_assert_double_gt(gain_of(in_folder("t.0.vtp"), "flux_W_m2", 0, 12), 1);
}

/* Cuts each triangle into four. */
static void quarter(struct soup *soup) {
    static struct soup whole;
    whole = *soup;
    soup->n = 0;
    for (uint32_t t = 0; t < whole.n; ++t) {
        double(*c)[3] = whole.corner[t], middle[3][3];
        for (int k = 0; k < 9; ++k) middle[k / 3][k % 3] = (c[k / 3][k % 3] + c[(k / 3 + 1) % 3][k % 3]) / 2;
        for (int k = 0; k < 3; ++k) soup_add(soup, c[k], middle[k], middle[(k + 2) % 3]);
        soup_add(soup, middle[0], middle[1], middle[2]);
    }
}

/* A cube has one hot side. With more rays the fluxes of its triangles come closer to those of many rays. */
TEST(more_rays_for_triangles) {
    static struct soup soup;
    static double flux[3][768];
    const char *out = in_folder("q.vtp"), *const rays[] = {"1", "1000000", "2000000"}, *column = in_folder("T.csv");
    soup = cube();
    for (int k = 0; k < 3; ++k) quarter(&soup);
    ck_assert_uint_eq(soup.n, 768);
    const char *bed = write_file("mote.csv", "x,y,z,r\n0,0,0,.01\n"), *box = write_solid("box.stl", &soup);
    FILE *file = opened(column, "w");
    for (uint32_t t = 0; t < soup.n; ++t) fputs(t < 128 ? "500\n" : "300\n", file);
    fclose(file);
    for (int run = 0; run < 3; ++run) {
        SUCCEED("heat", bed, "--length-unit", "m", "--wall", formatted("mesh:%s:temperatures=%s", box, column),
                "--emissivity", "0.7", "--temperature", "300", "--wall-vtp", out, "--wall-rays", rays[run]);
        read_array(out, "flux_W_m2", flux[run], 768);
    }
    double off[2] = {0};
    for (int run = 0; run < 2; ++run)
        for (uint32_t t = 128; t < soup.n; ++t) off[run] += pow(flux[run][t] - flux[2][t], 2) / (soup.n - 128);
    printf("    cold triangles are off by %.2g W/m2, with 1e6 rays %.2g\n", sqrt(off[0]), sqrt(off[1]));
    ck_assert_double_lt(sqrt(off[1]), .8 * sqrt(off[0]));
    FAIL_WITH(2, "heat", bed, "--length-unit", "m", "--wall-rays", "0");
    expect_message("--wall-rays", "0");
}

/* A file has the temperatures of triangles, in the order of the mesh, whichever triangles the mesh leaves out. */
TEST(temperatures_of_triangles) {
    struct soup soup = {0};
    const double flat[3] = {0, 0, 0};
    soup_add(&soup, flat, flat, flat);
    soup_cube(&soup, 4);
    const char *bed = write_file("bed.csv", BED), *box = write_solid("box.stl", &soup), *out = in_folder("q.vtp");
    const char *column = write_column("T.csv", "# of a case\nT [C]\n", 13, 100, 10);
    const char *mesh = formatted("mesh:%s:temperatures=%s:emissivity=.6", box, column);
    double kelvins[12];
    SUCCEED("heat", bed, "--length-unit", "m", "--wall", mesh, "--temperature-unit", "C", STATE, out);
    read_array(out, "temperature_K", kelvins, 12);
    double mean = 0;
    for (int t = 0; t < 12; ++t) {
        ck_assert_double_eq_tol(kelvins[t], 373.15 + 10 * (t + 1), 1e-9);
        mean += pow(kelvins[t], 4) / 12;
    }
    ck_assert_double_eq_tol(value_of("wall_box_K"), pow(mean, .25), 1e-3);
    ck_assert_double_eq_tol(gain_of(out, "flux_W_m2", 0, 12) / value_of("wall_box_W"), 1, 1e-5);

    const struct {
        const char *text, *place, *reason;
    } wrong[] = {{"1\n2\n3\n", "--wall: temperatures of box: ", "3 numbers; "},
                 {"1\n-2\n", "T.csv:2: ", "the temperature is -2; it must be within 0 and"},
                 {"1\nnan\n", "T.csv:2: ", "temperature is not finite: 'nan'"},
                 {"1\n2 3\n", "T.csv:2: ", "2 columns instead of 1"},
                 {"T\n", "T.csv: ", "the table has no numbers"}};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
        write_file("T.csv", wrong[k].text);
        FAIL_WITH(3, "heat", bed, "--length-unit", "m", "--wall", mesh, STATE, out);
        assert_has(said, wrong[k].place);
        assert_has(said, wrong[k].reason);
    }
    column = write_column("T.csv", "", 13, 100, 10);
    FAIL_WITH(2, "heat", bed, "--emissivity", "1", "--temperature", "T", "--wall",
              formatted("zmin:at=-5:temperatures=%s", column));
    assert_has(said, "zmin has no triangles");
}
