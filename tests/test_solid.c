/* test_solid.c - spheres that conduct: the option --solid-conductivity, where a ball gives off what it absorbs, and the
 * conductivity of beds. SPDX-License-Identifier: MIT
 *
 * They are compared with spherical harmonics. */
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_sf_legendre.h>

#include "conductivity/conductivity.h"
#include "bed/packing.h"
#include "exchange/paths.h"
#include "frames/solid_option.h"
#include "copies.h"
#include "program.h"

FIXTURE(make_folder, remove_folder)

/* ---- the option -------------------------------------------------------------------------------------------------- */

/* Makes two spheres of radii 3 and 1 mm, of types 1 and 2. */
static struct bed two_spheres(void) {
    struct bed bed = bed_empty();
    bed.extras = 1;
    ck_assert_int_eq(bed_add(&bed, &(struct bed_sphere){.r = 3, .line = 2}), 0);
    ck_assert_int_eq(bed_add(&bed, &(struct bed_sphere){.x = 5, .r = 1, .line = 3}), 0);
    bed.extra[0] = 1, bed.extra[1] = 2;
    return bed;
}

/* The option takes numbers, tables over T and lists of types: k* = k_s/(4 d sigma T^3). */
TEST(relative_conductivities) {
    static const double sigma = 5.670374419e-8, temperature[] = {1000, 500};
    const char *by_type = formatted("1:@%s,2:20", write_file("k.csv", "T,k\n900,3\n1100,5\n"));
    OWNED_BED bed = two_spheres();
    struct bed_options options = {.name = "bed"};
    bed.metres = 1e-3;
    for (int k = 0; k < 2; ++k) {
        OWNED_BY(quantity_free) struct quantity solid = {0};
        double relative[2];
        ck_assert_int_eq(solid_option(k ? by_type : "8", &solid), 0);
        ck_assert_int_eq(solid_relative(&options, &bed, &solid, temperature, relative), 0);
        ck_assert_double_eq_tol(relative[0], (k ? 4 : 8) / (4 * .006 * sigma * 1e9), 1e-12);
        ck_assert_double_eq_tol(relative[1] / ((k ? 20 : 8) / (4 * .002 * sigma * 1.25e8)), 1, 1e-14);
        const double extreme[] = {0, NAN};
        ck_assert_int_eq(solid_relative(&options, &bed, &solid, extreme, relative), 0);
        ck_assert(isinf(relative[0]) && isnan(relative[1]));
    }
}

/* What has no k*. */
TEST(no_relative_conductivity) {
    OWNED_BED bed = two_spheres();
    struct bed_options options = {.name = "bed"};
    struct quantity solid = {0};
    double relative[2];
    static const char *const wrong[] = {"0", "-1", "1:0", "1:2,1:3", ""};
    const double hot[] = {1000, 1e5};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) ck_assert_int_eq(solid_option(wrong[k], &solid), 2);
    ck_assert_int_eq(solid_option("1:2", &solid), 0);
    ck_assert_int_eq(bed_options_metres(&options, &bed, SOLID_NEEDS), 2); /* no unit */
    ck_assert_int_eq(bed_options_metres(&options, &bed, NULL), 0);
    ck_assert_double_eq(bed.metres, 1);
    ck_assert_int_eq(solid_relative(&options, &bed, &solid, hot, relative), 3); /* no such type */
    ck_assert_int_eq(solid_option("1e-3", &solid), 0);
    ck_assert_int_eq(solid_relative(&options, &bed, &solid, hot, relative), 3);
}

/* ---- a ball ------------------------------------------------------------------------------------------------------ */

/* draw: number `count` of the random sequence. draw_point: a random point of the unit sphere from the next two
 * numbers. */
static double draw(uint64_t *count) { return bed_make_random(7, (*count)++); }
static void draw_point(uint64_t *count, double point[3]) {
    const double height = 2 * draw(count) - 1, turn = 2 * PI * draw(count), ring = sqrt(1 - height * height);
    point[0] = ring * cos(turn), point[1] = ring * sin(turn), point[2] = height;
}

/* A ball gives off the part a/(a + l) of a pattern of degree l. This part is the mean of Legendre's polynomial of the
 * cosine. */
TEST(patterns_of_a_ball) {
    enum { DRAWS = 200000, DEGREES = 8 };
    static const double a[] = {.001, 1, 100, .1, 5};
    for (uint64_t k = 0; k < by_night(5, 3); ++k) {
        double mean[DEGREES + 1] = {0}, turned[3] = {0};
        uint64_t count = 0;
        for (int n = 0; n < DRAWS; ++n) {
            double from[3], even[3], to[3];
            draw_point(&count, from), draw_point(&count, even);
            const double u[] = {draw(&count), draw(&count)};
            memcpy(to, from, sizeof to);
            fibrad_reemit(1 / a[k], u, even, to);
            ck_assert_double_eq_tol(to[0] * to[0] + to[1] * to[1] + to[2] * to[2], 1, 1e-12);
            const double cosine = fmax(-1, fmin(1, from[0] * to[0] + from[1] * to[1] + from[2] * to[2]));
            double p[DEGREES + 1];
            gsl_sf_legendre_Pl_array(DEGREES, cosine, p);
            for (int l = 0; l <= DEGREES; ++l) mean[l] += p[l] / DRAWS;
            for (int axis = 0; axis < 3; ++axis) turned[axis] += (to[axis] - cosine * from[axis]) / DRAWS;
        }
        for (int l = 0; l <= DEGREES; ++l) ck_assert_double_eq_tol(mean[l], a[k] / (a[k] + l), 4 / sqrt(DRAWS));
        for (int axis = 0; axis < 3; ++axis) ck_assert_double_eq_tol(turned[axis], 0, 4 / sqrt(DRAWS));
    }
}

/* The ends of all ranges give unit vectors. */
TEST(extremes_of_a_ball) {
    static const double u[] = {0, 1e-300, .5, 1 - 0x1p-53}, exponent[] = {0, 1e-12, 1, 1e6, 1e300, INFINITY};
    const double n[] = {0, 0, 1}, even[] = {0, .6, .8};
    for (int k = 0; k < 4 * 4 * 6 * 2; ++k) {
        double to[3];
        const double pair[] = {u[k % 4], u[k / 4 % 4]};
        memcpy(to, n, sizeof to);
        fibrad_reemit(exponent[k / 16 % 6], pair, k / 96 ? n : even, to);
        ck_assert_double_eq_tol(to[0] * to[0] + to[1] * to[1] + to[2] * to[2], 1, 1e-12);
    }
}

/* ---- beds ------------------------------------------------------------------------------------------------------- */

/* F_E of walks. */
static struct conduction walk(const struct bed *bed, const double *emissivity, const double *conductivity,
                              double error) {
    struct conduction result;
    OWNED unsigned char *emits = malloc(bed->n);
    fibrad_run run = {.threads = 1};
    const struct conduction_rule rule = {
        .emissivity = emissivity, .conductivity = conductivity, .axis = -1, .error = error, .max_rays = 100000000};
    ck_assert_ptr_nonnull(emits);
    ck_assert_int_eq(conduction_emitters(bed, NULL, -1, CONDUCTION_MARGIN_WALK, "bed", emits, &result), 0);
    assert_ok(conduction_follow(bed, emits, &rule, &run, &result));
    return result;
}

/* The mean of F_E over the axes. Adds the square of its standard error. */
static double mean_factor(const struct conduction *of, double *square) {
    double mean = 0;
    for (int axis = 0; axis < 3; ++axis) mean += of->factor[axis] / 3, *square += pow(of->error[axis] / 3, 2);
    return mean;
}

/* Spheres touch in a simple cubic lattice. The true values come from harmonics up to degrees 9 and 13 and 1.2e7 rays,
 * and are right to .0005. */
LOOP_TEST(simple_cubic, by_night(14, 8)) {
    static const struct {
        double k_star, factor[2]; /* at emissivities 1 and .6 */
    } known[] = {{.01, {.2376, .2373}}, {.1, {.3591, .3430}},  {.3, {.5294, .4614}},       {1, {.8006, .5979}},
                 {3, {1.0136, .6745}},  {10, {1.1350, .7099}}, {INFINITY, {1.2001, .7270}}};
    OWNED_BED bed = bed_empty();
    ck_assert_int_eq(bed_add(&bed, &(struct bed_sphere){.r = 1}), 0);
    for (int axis = 0; axis < 3; ++axis) bed.period[axis] = 2;
    const double emissivity = _i % 2 ? .6 : 1, truth = known[_i / 2].factor[_i % 2];
    const struct conduction found = walk(&bed, &emissivity, &known[_i / 2].k_star, .03);
    double square = 0;
    const double mean = mean_factor(&found, &square);
    ck_assert_double_le(sqrt(square), .03 * truth);
    ck_assert_double_eq_tol(mean, truth, 3 * sqrt(square) + .01 * truth); /* .01 is for rare flights along channels */
    ck_assert_double_eq(k_star_mean(&found.k_star), known[_i / 2].k_star);
}

/* Solves the problem plainly by harmonics: degrees up to DEGREE of the radiosity J of each sphere. Overlaps come from
 * rays. sigma T^4 rises by `period` along z from one image of the bed to the next. */
enum { SPHERES = 8u, DEGREE = 5, TERMS = (DEGREE + 1) * (DEGREE + 1), UNKNOWN = SPHERES * TERMS, RAYS = 8000 };

/* Real harmonics at a point of the unit sphere, each with the mean square 1. */
static void harmonics(const double n[3], double y[TERMS]) {
    const double turn = atan2(n[1], n[0]), height = fmax(-1, fmin(1, n[2]));
    double all[100];
    ck_assert(gsl_sf_legendre_array_n(DEGREE) <= 100);
    gsl_sf_legendre_array(GSL_SF_LEGENDRE_SPHARM, DEGREE, height, all);
    for (size_t l = 0; l <= DEGREE; ++l)
        for (size_t m = 0; m <= l; ++m) {
            const double p = sqrt((m > 0 ? 2 : 1) * 4 * PI) * all[gsl_sf_legendre_array_index(l, m)];
            y[l * l + l + m] = p * cos((double)m * turn);
            if (m > 0) y[l * l + l - m] = p * sin((double)m * turn);
        }
}

/* Whether a ray meets sphere j, displaced by `image` periods, before the length *least. The ray begins at `at`. */
static bool meets(const struct bed *bed, uint32_t j, const double image[3], const double at[3], const double w[3],
                  double *least, double n[3]) {
    const double c[] = {bed->x[j], bed->y[j], bed->z[j]};
    double e[3], along = 0, square = 0;
    for (int axis = 0; axis < 3; ++axis) {
        e[axis] = c[axis] + image[axis] * bed->period[axis] - at[axis];
        along += e[axis] * w[axis], square += e[axis] * e[axis];
    }
    const double half = bed->r[j] * bed->r[j] - (square - along * along);
    if (!(half > 0 && along > 0 && along - sqrt(half) < *least)) return false;
    *least = along - sqrt(half);
    for (int axis = 0; axis < 3; ++axis) n[axis] = (*least * w[axis] - e[axis]) / bed->r[j];
    return true;
}

/* The first sphere, or image of a sphere, that a ray from sphere i meets. n: out: where the ray meets that sphere.
 * Returns the length. The function tries all images within a period and a half of a point. Then the point moves
 * on by a period. */
static double first_met(const struct bed *bed, uint32_t i, const double from[3], const double w[3], uint32_t *sphere,
                        double n[3], double *images) {
    double least = INFINITY;
    for (int step = 0; !(least <= step * bed->period[0]); ++step)
        for (uint32_t j = 0; j < bed->n; ++j)
            for (int k = 0; k < 27; ++k) {
                const double c[] = {bed->x[j], bed->y[j], bed->z[j]};
                double image[] = {k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
                for (int axis = 0; axis < 3; ++axis)
                    image[axis] += round((from[axis] + step * bed->period[0] * w[axis] - c[axis]) / bed->period[axis]);
                if (j == i && image[0] == 0 && image[1] == 0 && image[2] == 0) continue;
                if (meets(bed, j, image, from, w, &least, n)) *sphere = j, *images = image[2];
            }
    return least;
}

/* What the rays tell. overlap[a][b] is the mean of harmonic a where a ray leaves times harmonic b where it ends.
 * shift[a] is the mean of harmonic a times the rise. Others are sums over rays of lengths along z. */
struct overlaps {
    double overlap[UNKNOWN][UNKNOWN], shift[UNKNOWN], leaving[UNKNOWN], arriving[UNKNOWN], rise;
};

static void trace_overlaps(const struct bed *bed, struct overlaps *o) {
    uint64_t count = 0;
    for (uint32_t i = 0; i < bed->n; ++i) {
        const double area = 4 * PI * bed->r[i] * bed->r[i];
        for (int ray = 0; ray < RAYS; ++ray) {
            double from[3], w[3], to[3], y[TERMS], z[TERMS], at[3], images = 0, norm = 0;
            uint32_t j = 0;
            draw_point(&count, from), draw_point(&count, w);
            for (int axis = 0; axis < 3; ++axis) w[axis] += from[axis], norm += w[axis] * w[axis];
            for (int axis = 0; axis < 3; ++axis) w[axis] /= sqrt(norm);
            const double *const centre[] = {bed->x, bed->y, bed->z};
            for (int axis = 0; axis < 3; ++axis) at[axis] = centre[axis][i] + bed->r[i] * from[axis];
            const double length = first_met(bed, i, at, w, &j, to, &images) * w[2], rise = images * bed->period[2];
            harmonics(from, y), harmonics(to, z);
            for (uint32_t a = 0; a < TERMS; ++a) {
                double *row = &o->overlap[i * TERMS + a][j * TERMS];
                for (int b = 0; b < TERMS; ++b) row[b] += y[a] * z[b] / RAYS;
                o->shift[i * TERMS + a] += y[a] * rise / RAYS;
                o->leaving[i * TERMS + a] += area * y[a] * length / RAYS;
                o->arriving[j * TERMS + a] += area * z[a] * length / RAYS;
            }
            o->rise += area * rise * length / RAYS;
        }
    }
}

/* F_E along z. J_l = (1 - e_l) H_l with 1/e_l = 1/e + 1/(2 k* l). e_0 = 0, since no sphere gains power. */
static double factor_by_harmonics(const struct bed *bed, const double *emissivity, const double *conductivity) {
    OWNED struct overlaps *o = calloc(1, sizeof *o);
    gsl_matrix *matrix = gsl_matrix_calloc(UNKNOWN, UNKNOWN);
    gsl_vector *right = gsl_vector_calloc(UNKNOWN), *j = gsl_vector_calloc(UNKNOWN);
    gsl_permutation *order = gsl_permutation_alloc(UNKNOWN);
    int sign;
    double flux = 0, diameter = 0;
    ck_assert(o && matrix && right && j && order);
    trace_overlaps(bed, o);
    for (size_t a = 0; a < UNKNOWN; ++a) {
        const size_t i = a / TERMS, l = (size_t)sqrt((double)(a % TERMS));
        const double back = l == 0 ? 1 : 1 - 1 / (1 / emissivity[i] + 1 / (2 * conductivity[i] * (double)l));
        for (size_t b = 0; b < UNKNOWN; ++b)
            gsl_matrix_set(matrix, a, b, a == 0 ? b == 0 : (a == b) - back * o->overlap[a][b]);
        gsl_vector_set(right, a, a == 0 ? 0 : back * o->shift[a]);
    }
    ck_assert_int_eq(gsl_linalg_LU_decomp(matrix, order, &sign), 0);
    ck_assert_int_eq(gsl_linalg_LU_solve(matrix, order, right, j), 0);
    for (size_t a = 0; a < UNKNOWN; ++a) flux += (o->leaving[a] - o->arriving[a]) / 2 * gsl_vector_get(j, a);
    flux -= o->rise / 2;
    for (size_t i = 0; i < SPHERES; ++i) { /* the way through the spheres: they give off elsewhere what they absorb */
        const size_t a = i * TERMS + 2;
        double arrives = o->shift[a];
        for (size_t b = 0; b < UNKNOWN; ++b) arrives += o->overlap[a][b] * gsl_vector_get(j, b);
        flux -= 4 * PI * pow(bed->r[i], 3) / sqrt(3) * (arrives - gsl_vector_get(j, a));
        diameter += 2 * bed->r[i] / SPHERES;
    }
    gsl_permutation_free(order), gsl_vector_free(j), gsl_vector_free(right), gsl_matrix_free(matrix);
    return -flux / (bed->period[0] * bed->period[1] * bed->period[2] * diameter);
}

/* Random spheres have many sizes, emissivities and conductivities. */
LOOP_TEST(random_beds, 2) {
    static const double low[] = {1, .7}, fraction[] = {.5, .45};
    double emissivity[SPHERES], conductivity[SPHERES];
    OWNED_BED bed = bed_empty();
    ck_assert_int_eq(bed_make_packing(&bed, SPHERES, low[_i], 2 - low[_i], fraction[_i], 3), 0);
    for (uint32_t i = 0; i < bed.n; ++i) {
        emissivity[i] = _i == 0 ? .8 : .3 + .7 * bed_make_random(1, i);
        conductivity[i] = _i == 0 ? .3 : .1 * pow(30, bed_make_random(2, i));
    }
    const double truth = factor_by_harmonics(&bed, emissivity, conductivity);
    const struct conduction found = walk(&bed, emissivity, conductivity, .007);
    assert_near(found.factor[2], truth, .015);
}

/* A bed has open ends. Its core has F_E of the periodic bed from which it was cut. */
TEST(open_beds) {
    OWNED_BED cell = bed_empty(), bed = bed_empty();
    ck_assert_int_eq(bed_make_packing(&cell, 1000, 1, 1, .55, 1), 0);
    ck_assert_int_eq(bed_make_copies(&bed, &cell, (const uint32_t[]){2, 2, 2}), 0);
    memset(bed.period, 0, sizeof bed.period);
    OWNED double *emissivity = malloc(bed.n * sizeof *emissivity), *conductivity = malloc(bed.n * sizeof *conductivity);
    ck_assert(emissivity && conductivity);
    for (uint32_t i = 0; i < bed.n; ++i) emissivity[i] = .9, conductivity[i] = 2;
    const struct conduction open = walk(&bed, emissivity, conductivity, .01),
                            whole = walk(&cell, emissivity, conductivity, .01);
    double square = 0;
    const double found = mean_factor(&open, &square), truth = mean_factor(&whole, &square);
    ck_assert_double_gt(open.escaped, 0);
    ck_assert_double_eq_tol(found, truth, 3 * sqrt(square) + .01 * truth); /* .01: other spheres */
}

/* With k* of 1e6, F_E is that of spheres with one temperature each. Their temperatures lie on a line, or are those at
 * which no sphere gains power: docs/heat.md gives the difference, .1 %. */
TEST(good_conductors) {
    double emissivity[300], conductivity[300];
    OWNED_BED bed = bed_empty();
    ck_assert_int_eq(bed_make_packing(&bed, 300, .8, 1.2, .55, 1), 0);
    for (uint32_t i = 0; i < bed.n; ++i) emissivity[i] = .8, conductivity[i] = 1e6;
    const struct conduction solid = walk(&bed, emissivity, conductivity, .007),
                            one = walk(&bed, emissivity, NULL, .007);
    double square = 0;
    const double found = mean_factor(&solid, &square), truth = mean_factor(&one, &square);
    ck_assert_double_eq_tol(found, truth, 3 * sqrt(square) + .004 * truth);
    ck_assert(isnan(k_star_mean(&one.k_star)) && solid.k_star.least == 1e6);
}

/* The kernel refuses these. */
TEST(refusals) {
    static _Alignas(64) unsigned char memory[40000], room[2000000];
    const double at[] = {0, 0, 0}, r = 1;
    const fibrad_spheres spheres = {at, at + 1, at + 2, &r, 1, .stride = 3};
    const fibrad_wall floor = {.kind = FIBRAD_WALL_PLANE, .plane = {2, 0, -1}};
    double emissivity = .5, conductivity = 1, grey = .5;
    fibrad_displacement moved;
    for (int k = 0; k < 5; ++k) {
        const fibrad_scene_config config = {.period = {3, 3, 0}, .wall = &floor, .walls = k == 4};
        fibrad_scene *scene;
        fibrad_work work = {.memory = {.block = room, .size = sizeof room}};
        assert_ok(fibrad_scene_init(&scene, memory, sizeof memory, &config, &spheres, NULL));
        fibrad_displacement_rule rule = {
            .emissivity = &emissivity, .conductivity = &conductivity, .wall_emissivity = &grey, .paths = 16};
        conductivity = k == 1 ? NAN : k == 2 ? 0 : 1;
        if (k == 3) rule.flights = FIBRAD_FLIGHTS_MAX + 1;
        const int wanted = k == 0 ? FIBRAD_OK : k < 4 ? FIBRAD_E_ARGUMENT : FIBRAD_E_UNSUPPORTED;
        ck_assert_int_eq(fibrad_exchange_displacement(scene, &work, 0, &rule, &moved), wanted);
    }
}

/* ---- the program ------------------------------------------------------------------------------------------------- */

#define CELL "x,y,z,r,ks,nothing\n0,0,0,30,13.6,\n"
#define OF_CELL                                                                                                        \
    write_file("cell.csv", CELL), "--periodic", "60,60,60", "--emissivity", "1", "--rays", "2000", "--temperature"

/* Writes eight copies of a random bed, one above the other. `period` becomes that of a copy. */
static const char *write_tower(double period[3]) {
    char *text = malloc(40 * 8 * 80), *at = text + sprintf(text, "x,y,z,r\n");
    OWNED_BED bed = bed_empty();
    ck_assert_int_eq(bed_make_packing(&bed, 40, 1, 1, .55, 1), 0);
    for (int copy = 0; copy < 8; ++copy)
        for (uint32_t i = 0; i < bed.n; ++i)
            at += sprintf(at, "%.15g,%.15g,%.15g,%g\n", bed.x[i], bed.y[i], bed.z[i] + copy * bed.period[2], bed.r[i]);
    memcpy(period, bed.period, sizeof bed.period);
    const char *file = write_file("tower.csv", text);
    free(text);
    return file;
}

/* Paths in a periodic bed are compared with patches of the same bed between plates. */
LOOP_TEST(paths_and_patches_of_a_random_bed, by_night(3, 2)) {
    static const double k_star[] = {1, .01, .1}, most[] = {.01, .02, .01};
    double period[3];
    const char *file = write_tower(period), *solid = formatted("%.17g", k_star[_i] * 8e-3 * 5.670374419e-8 * 1e9);
    const char *periods = formatted("%.17g,%.17g,%.17g", period[0], period[1], 8 * period[2]);
    SUCCEED("conductivity", file, "--periodic", periods, "--axis", "z", "--emissivity", "0.8", "--temperature", "1000",
            "--length-unit", "mm", "--error", "0.005", "--steady", "--solid-conductivity", solid);
    ck_assert_double_eq_tol(value_of("F_E_steady_z") / value_of("F_E_z"), 1, most[_i]);
}

/* All spheres of a lattice see the same directions, so errors do not average. The stated error tells it. The truth is
 * that of docs/validation.md. */
LOOP_TEST(errors_of_directions_are_stated, 2) {
    char text[2000] = "x,y,z,r\n", *at = text + strlen(text);
    const double truth = _i ? .8006 : 1.2001;
    for (int i = 0; i < 80; ++i) at += sprintf(at, "%d.5,%d.5,%d.5,.5\n", i % 2, i / 2 % 2, i / 4);
    if (_i)
        SUCCEED("conductivity", write_file("lattice.csv", text), "--periodic", "2,2,20", "--axis", "z", "--emissivity",
                "1", "--temperature", "1000", "--length-unit", "m", "--max-rays", "1e5", "--steady",
                "--solid-conductivity", "226.815");
    else
        SUCCEED("conductivity", write_file("lattice.csv", text), "--periodic", "2,2,20", "--axis", "z", "--emissivity",
                "1", "--max-rays", "1e5", "--steady");
    ck_assert_double_le(fabs(value_of("F_E_steady_z") - truth), 2 * value_of("F_E_steady_z_error"));
    ck_assert_double_le(value_of("F_E_steady_z_error"), .02 * truth);
}

/* k* appears in the summary, the table and the objects. It is the same from a number, a column and a table over T. */
TEST(outputs) {
    const char *csv = in_folder("k.csv"), *json = in_folder("k.json"), *summary = in_folder("s.json");
    const double k_star = 13.6 / (4 * .06 * 5.670374419e-8 * 1e9);
    const char *const solid[] = {"13.6", "ks", formatted("@%s", write_file("table.csv", "500,3.6\n1500,23.6\n"))};
    char *text[3];
    for (int k = 0; k < 3; ++k) {
        SUCCEED("conductivity", OF_CELL, "1000", "--length-unit", "mm", "--solid-conductivity", solid[k], "--threads",
                k ? "3" : "1", "-o", csv, "-o", json, "--json", summary);
        ck_assert_double_eq_tol(json_of(summary, "k_star"), k_star, 1e-12);
        char *object = read_file(json);
        ck_assert_double_eq_tol(strtod(strstr(object, "\"k_star_max\":") + 13, NULL), k_star, 1e-12);
        ck_assert_double_eq_tol(json_of(summary, "k_x_W_mK"), json_of(summary, "F_E_x") * 13.6 / k_star, 1e-9);
        ck_assert(!strstr(printed, "isothermal") && !strstr(printed, "k_star_min"));
        text[k] = read_file(csv);
        assert_has(text[k], formatted(",%.10g", k_star));
        assert_has(text[k], ",1000,\n"); /* T_K, and no warning */
        ck_assert_str_eq(text[k], text[0]);
    }
}

/* One temperature for each sphere is right to 5 % above about k* = 11 in a simple cubic lattice. At 10, F_E is 1.135
 * instead of 1.200. */
TEST(how_isothermal) {
    double above = 0;
    SUCCEED("conductivity", OF_CELL, "1000", "--length-unit", "mm");
    const char *line = strstr(printed, "\nisothermal right to 5 % for k_s above ");
    ck_assert_ptr_nonnull(line);
    ck_assert_int_eq(sscanf(line, "\nisothermal right to 5 %% for k_s above %lf W/(m K)\n", &above), 1);
    ck_assert_double_eq_tol(above, 11 * 4 * .06 * 5.670374419e-8 * 1e9, 25);
    SUCCEED("conductivity", OF_CELL, "1000");
    assert_lacks(printed, "isothermal"); /* no unit */
}

TEST(mistakes) {
    static const struct {
        const char *temperature, *unit, *solid, *more, *message;
        int status;
    } cases[] = {
        {"1000", "mm", "0", NULL, "--solid-conductivity: 0 is not within 1e-06 and inf", 2},
        {"1000", "mm", "-3", NULL, "--solid-conductivity: -3 is not within", 2},
        {"1000", "mm", "nan", NULL, "no column nan", 3},
        {"1000", "mm", "missing", NULL, "missing", 3},
        {"1000", "mm", "1:5", NULL, "type", 3},
        {"1000", "mm", "@none.csv", NULL, "none.csv", 4},
        {"1000", "mm", "1e-6", NULL, "cell.csv:2: sphere 0: k_s/(4 d sigma T^3) is 7.3", 3},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        FAIL_WITH(cases[k].status, "conductivity", OF_CELL, cases[k].temperature, "--length-unit", cases[k].unit,
                  "--solid-conductivity", cases[k].solid, "-o", in_folder("k.csv"), cases[k].more);
        assert_has(said, cases[k].message);
        ck_assert_ptr_eq(strchr(said, '\n') + 1, said + strlen(said));
        ck_assert_int_ne(access(in_folder("k.csv"), F_OK), 0);
    }
    FAIL_WITH(2, "conductivity", OF_CELL, "1000", "--solid-conductivity", "5");
    assert_has(said, "names no unit of length, which --solid-conductivity needs");
    FAIL_WITH(2, "conductivity", MONO, "--emissivity=.5", "--solid-conductivity=5");
    assert_has(said, "--solid-conductivity needs --temperature");
}
