/* test_plot.c - pictures: they show all that they should, and nothing lies outside. SPDX-License-Identifier: MIT */
#include <unistd.h>

#include "cli/message.h"
#include "plot/plot_bed.h"
#include "plot/plot_heat.h"
#include "host_owned.h"
#include "scenes.h"
#include "suite.h"

#define FOLDER "/tmp/fibrad_plot_XXXXXX"
static char folder[] = FOLDER, path[sizeof folder + 8];
static struct plot_plane plane; /* of pictures of factors */

/* Each test has a folder of its own, also if all tests run in one process. */
static void make_folder(void) {
    memcpy(folder, FOLDER, sizeof folder);
    ck_assert_ptr_nonnull(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/a.svg", folder);
}

static void remove_folder(void) {
    plane = (struct plot_plane){0};
    remove(path);
    rmdir(folder);
}

FIXTURE(make_folder, remove_folder)

/* Has a function draw its data, and returns the picture, which the caller frees. */
typedef int draw_function(const struct output *output, const void *what);

static char *drawn(draw_function *draw, const void *what) {
    struct output output = {0};
    ck_assert_int_eq(output_open(&output, path), 0);
    ck_assert_int_eq(output_close(&output, draw(&output, what)), 0);
    OWNED_FILE *file = opened(path, "rb");
    fseek(file, 0, SEEK_END);
    const long size = ftell(file);
    char *text = calloc(1, (size_t)size + 1);
    rewind(file);
    ck_assert_uint_eq(fread(text, 1, (size_t)size, file), (size_t)size);
    return text;
}

/* A text of a picture. Letters count as half as wide as high, which is a little less than they are. */
struct text {
    double left, right, y;
    const char *at;
};

/* Reads the text of a <g>. An aslant text has no width. */
static struct text text_of(const char *g) {
    double x, y, size;
    ck_assert_int_eq(sscanf(g, "<g transform=\"translate(%lf,%lf)", &x, &y), 2);
    const char *first = strstr(g, "<tspan"), *end = strstr(first, "</tspan>");
    first = strchr(first, '>') + 1 + strspn(strchr(first, '>') + 1, " ");
    ck_assert_int_eq(sscanf(strstr(g, "font-size="), "font-size=\"%lf", &size), 1);
    const char *anchor = strstr(g, "text-anchor=\"");
    const double width = strncmp(strchr(g, ')'), ") rotate", 8) == 0 ? 0 : .5 * size * (double)(end - first);
    const double before = anchor[13] == 'e' ? 1 : anchor[13] == 'm' ? .5 : 0;
    return (struct text){x - before * width, x + (1 - before) * width, y, first};
}

/* Checks that all texts lie within the picture, none at its very edge, and that no two of one line overlap. */
static void assert_texts_inside(const char *svg, double high) {
    struct text text[400];
    int texts = 0;
    for (const char *g = svg; (g = strstr(g, "<g transform=\"translate(")) != NULL; ++g) {
        const struct text t = text[texts++] = text_of(g);
        ck_assert_msg(t.left > 12 && t.right < 1488 && t.y > 12 && t.y < high - 12, "%.90s", g);
        ck_assert_int_lt(texts, 400);
        for (int k = 0; k + 1 < texts; ++k)
            ck_assert_msg(fabs(text[k].y - t.y) > 1 || text[k].right <= t.left || t.right <= text[k].left,
                          "%.20s over %.20s", text[k].at, t.at);
    }
    ck_assert_int_gt(texts, 20);
}

/* ---- beds -------------------------------------------------------------------------------------------------------- */

static int draw_bed(const struct output *output, const void *what) {
    return plot_bed(output, "folder/bed.csv", what, &plane);
}

/* Makes a picture of a bed of this size, with or without walls. */
static char *picture_of_bed(double size, bool walled) {
    OWNED_BED bed = packing(60, .4 * size, .6 * size, .4, 3, false);
    struct walls walls = {.count = walled ? 1 : 0, .wall = {plane_at(2, 0, -2 * size)}};
    const fibrad_scene_config config = {.wall = walls.wall, .walls = walls.count};
    const fibrad_spheres spheres = spheres_of(&bed);
    OWNED_FACTORS *factors;
    assert_ok(fibrad_view_factors(&config, &spheres, NULL, NULL, &factors));
    const struct contents what = {.bed = &bed, .factors = factors, .walls = &walls};
    char *svg = drawn(draw_bed, &what);
    return svg;
}

/* Beds in metres with grains of any size have axes with short numbers and fitting units. */
LOOP_TEST(small_and_large_beds, 4) {
    static const struct {
        double size;
        const char *power;
    } cases[] = {{1, NULL}, {1e-3, "-3"}, {1e-5, "-6"}, {1e5, "3"}};
    OWNED char *svg = picture_of_bed(cases[_i].size, false);
    assert_texts_inside(svg, 1240);
    assert_has(svg, "bed.csv");
    assert_has(svg, "Escaped fraction");
    assert_lacks(svg, "folder");
    const char *word = formatted(">%s</tspan>", cases[_i].power ? cases[_i].power : "none");
    ck_assert_int_eq(strstr(svg, word) != NULL, cases[_i].power != NULL);
}

TEST(a_bed_between_walls) {
    OWNED char *svg = picture_of_bed(1, true);
    assert_texts_inside(svg, 1240);
    assert_has(svg, "Fraction to walls and out of the bed");
    assert_has(svg, "goes to walls");
    assert_has(svg, "stroke='rgb(140, 140, 140)'"); /* the wall */
}

/* ---- heat -------------------------------------------------------------------------------------------------------- */

struct heat_shown {
    const struct bed *bed;
    const struct walls *walls;
    const double *temperature, *power, *wall_temperature;
    const double *absorbed;  /* NULL: there is no light */
    const double *conducted; /* NULL: there are no contacts */
    struct plot_plane plane;
};

static int draw_heat(const struct output *output, const void *heat_shown) {
    const struct heat_shown *shown = heat_shown;
    fibrad_heat_result result = {.temperature = (double *)shown->temperature, .power = (double *)shown->power};
    result.conducted = (double *)shown->conducted, result.wall_temperature = (double *)shown->wall_temperature;
    const fibrad_light_result light = {.absorbed = (double *)shown->absorbed};
    const struct contents what = {
        .bed = shown->bed, .walls = shown->walls, .result = &result, .light = shown->absorbed ? &light : NULL};
    return plot_heat(output, "bed's.dump", &what, &shown->plane);
}

/* Three spheres have lengths in millimetres. */
TEST(slices_of_heat) {
    OWNED_BED bed = BED({0, 0, 0, 1e-3}, {.003, 0, 0, 1e-3}, {0, 0, .004, 1e-3});
    bed.metres = 1;
    const double temperature[] = {300, 1200.5, 777}, power[] = {1.5, -4.25, .25}, wall_temperature[] = {412, 900};
    const struct walls walls = {.count = 2, .wall = {plane_at(2, 0, -.001), cylinder_at(0, 0, .0044)}};
    struct heat_shown what = {
        .bed = &bed, .walls = &walls, .temperature = temperature, .power = power, .wall_temperature = wall_temperature};
    OWNED char *svg = drawn(draw_heat, &what);
    assert_texts_inside(svg, 700);
    static const char *const told[] = {"bed's.dump", "3 spheres of 300 to 1200.5 K lose 2.5 W",
                                       "Temperature [K], slice at y = 0 mm", "Net power [W], slice at y = 0 mm",
                                       "x [mm]"};
    for (size_t k = 0; k < sizeof told / sizeof *told; ++k) assert_has(svg, told[k]);
    free(svg);
    bed.metres = 1e-3; /* the same lengths, from a file in millimetres */
    svg = drawn(draw_heat, &what);
    assert_has(svg, "x [\302\265m]");
    free(svg);

    const double conducted[] = {.5, -2.25, .25};
    what.conducted = conducted;
    svg = drawn(draw_heat, &what);
    assert_texts_inside(svg, 700);
    assert_has(svg, "lose 2.5 W: 1 W by radiation, 1.5 W by conduction");
    free(svg);

    /* there are no walls, and nothing flows */
    const double none[] = {0, 0, 0};
    what = (struct heat_shown){.bed = &bed, .walls = &(struct walls){0}, .temperature = temperature, .power = none};
    svg = drawn(draw_heat, &what);
    assert_texts_inside(svg, 700);
    assert_has(svg, "gain 0 W");
}

/* Tics and titles of a tall bed, of a flat one and across z do not overlap, and lie within the picture. */
LOOP_TEST(tall_and_flat_beds, 3) {
    enum { N = 30 };
    OWNED_BED bed = bed_empty();
    bed.metres = 1;
    double temperature[N], power[N];
    for (int i = 0; i < N; ++i) {
        const double place = .06 * i;
        ck_assert_int_eq(bed_add(&bed, &(struct bed_sphere){_i == 1 ? place : 0, 0, _i == 1 ? 0 : place, .03, 0, 0}),
                         0);
        temperature[i] = 500 + i, power[i] = i - 1e-3;
    }
    struct heat_shown what = {.bed = &bed, .walls = &(struct walls){0}, .plane = {.axis = _i == 2 ? 'z' : 0}};
    what.temperature = temperature, what.power = power;
    OWNED char *svg = drawn(draw_heat, &what);
    assert_texts_inside(svg, 700);
    assert_has(svg, _i == 2 ? ">y [mm]<" : ">z [m]<");
    assert_has(svg, _i == 2 ? ", slice at z = " : ", slice at y = 0 m");
}

/* Powers have prefixes. */
TEST(prefixes_of_powers) {
    OWNED_BED bed = BED({0, 0, 0, 1}, {3, 0, 0, 1}, {0, 0, 4, 1});
    bed.metres = 1;
    const double temperature[] = {300, 1200, 777}, power[] = {125e3, 50e3, -0.}, small[] = {3e-6, -2e-6, 1e-6};
    struct heat_shown what = {.bed = &bed, .walls = &(struct walls){0}, .temperature = temperature, .power = power};
    OWNED char *svg = drawn(draw_heat, &what);
    assert_has(svg, "gain 175 kW");
    assert_has(svg, "Net power [kW], slice");
    assert_lacks(svg, "e+0");
    free(svg);
    what.power = small;
    svg = drawn(draw_heat, &what);
    assert_has(svg, "Net power [\302\265W], slice");
    assert_has(svg, "gain 2 \302\265W");
}

/* What is the same for all spheres does not fill a slice: a second plane or absorbed light takes its place. */
TEST(no_slice_of_one_colour) {
    OWNED_BED bed = BED({0, 0, 0, 1}, {3, 0, 0, 1}, {0, 0, 4, 1});
    bed.metres = 1;
    const double temperature[] = {300, 1200, 777}, same[] = {-40, -40, -40}, light[] = {1, 2, 5};
    struct heat_shown what = {.bed = &bed, .walls = &(struct walls){0}, .temperature = temperature, .power = same};
    OWNED char *svg = drawn(draw_heat, &what);
    assert_lacks(svg, "Net power [W], slice");
    assert_has(svg, "Temperature [K], slice at y = 0 m");
    assert_has(svg, "Temperature [K], slice at x = ");
    free(svg);
    what.absorbed = light;
    svg = drawn(draw_heat, &what);
    assert_has(svg, "they absorb 8 W of light");
    assert_has(svg, "Absorbed light [W], slice at y = 0 m");
    free(svg);
    what.absorbed = NULL, what.temperature = same, what.power = temperature;
    svg = drawn(draw_heat, &what);
    assert_has(svg, "Net power [W], slice at y");
    assert_has(svg, "Net power [W], slice at x");
    assert_lacks(svg, "Temperature [K], slice");
}

/* The plane of a slice is where it was put. A plane without spheres, and what is no plane, are refused. */
TEST(planes_of_slices) {
    OWNED_BED bed = BED({0, 0, 0, 1}, {3, 0, 0, 1}, {0, 0, 4, 1});
    ck_assert_int_eq(plot_plane_option("z=4.5", &plane), 0);
    ck_assert(plane.axis == 'z' && plane.placed && plane.at == 4.5);
    ck_assert_int_eq(plot_plane_check(&plane, &bed), 0);
    struct plot_slice slice;
    bed.metres = 1e-3;
    plot_slice_of(&slice, &plane, &bed, NULL);
    ck_assert_str_eq(slice.place, "z = 4.5 mm");
    plane.at = 2;
    ck_assert_int_eq(plot_plane_check(&plane, &bed), STATUS_USAGE);
    static const char *const wrong[] = {"u=3", "z=", "zz", "x=a", "", "x=1e300"};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k)
        ck_assert_int_eq(plot_plane_option(wrong[k], &plane), STATUS_USAGE);
    ck_assert_int_eq(plot_plane_option("x", &plane), 0);
    bed.metres = 0;
    plot_slice_of(&slice, &plane, &bed, NULL);
    ck_assert_str_eq(slice.place, "x = 0");
}

/* ---- exchange --------------------------------------------------------------------------------------------------- */

TEST(exchange_factors_shown) {
    OWNED_BED bed = packing(60, .4, .6, .4, 3, false);
    const fibrad_spheres spheres = spheres_of(&bed);
    double emissivity[60];
    for (int i = 0; i < 60; ++i) emissivity[i] = .5;
    const fibrad_exchange_rule rule = {.emissivity = emissivity};
    OWNED_FACTORS *factors;
    assert_ok(exchange_of(NULL, &spheres, &rule, NULL, NULL, &factors));
    const struct contents what = {.bed = &bed, .factors = factors, .walls = &(struct walls){0}, .grey = &rule};
    OWNED char *svg = drawn(draw_bed, &what);
    assert_texts_inside(svg, 1240);
    assert_has(svg, "exchange factors; row sums");
    assert_has(svg, "Exchange factor against distance");
    assert_lacks(svg, "View factor");
    assert_lacks(svg, "nothing between");
}
