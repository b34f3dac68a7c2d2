/* test_exchange_solid.c - exchange factors of spheres that conduct. SPDX-License-Identifier: MIT
 *
 * They are compared with quadrature, spherical harmonics, and powers by patches. */
#include <gsl/gsl_integration.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_sf_legendre.h>

#include "exchange/paths.h"
#include "host_owned.h"
#include "program.h"
#include "scenes.h"

FIXTURE(make_folder, remove_folder)

/* ---- a ball ------------------------------------------------------------------------------------------------------ */

/* The least of 4 pi K, with t^a in place of t. */
static double least_share(double power, void *a) {
    const double t = pow(power, 1 / *(double *)a);
    return (1 - t) / ((1 + t) * (1 + t));
}

TEST(emissivities_of_nodes) {
    gsl_integration_workspace *space = gsl_integration_workspace_alloc(1000);
    double a[] = {.01, .1, 1, 7, 23.99, 24, 24.01, 100, 2000, 4e5};
    for (size_t k = 0; k < sizeof a / sizeof *a; ++k) {
        double even, error;
        gsl_function least = {least_share, &a[k]};
        ck_assert_int_eq(gsl_integration_qags(&least, 0, 1, 0, 1e-11, 1000, space, &even, &error), 0);
        assert_near(fibrad_reemitted_evenly(a[k]), even, 1e-10);
        if (a[k] < 4e5) assert_near(fibrad_node_emissivity(.8, .4 / a[k]), .8 * even, 1e-10);
    }
    gsl_integration_workspace_free(space);
    ck_assert_double_eq(fibrad_node_emissivity(.7, INFINITY), .7);
    ck_assert_double_eq(fibrad_node_emissivity(0, 1), 0);
    static const double wrong[][2] = {{-.1, 1}, {1.1, 1}, {NAN, 1}, {.5, 0}, {.5, -1}, {.5, NAN}};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k)
        ck_assert(isnan(fibrad_node_emissivity(wrong[k][0], wrong[k][1])));
}

/* The part a/(a + l) of degree l is given off. All of it comes from what is not given off evenly. */
TEST(patterns_that_are_not_even) {
    enum { DRAWS = 200000, DEGREES = 8 };
    static const double a[] = {1e-6, .5, 100, .04, 4};
    for (uint64_t k = 0; k < by_night(5, 3); ++k) {
        double mean[DEGREES + 1] = {0};
        fibrad_random random = fibrad_random_start(5, k);
        for (uint64_t n = 0; n < DRAWS; ++n) {
            const double height = 2 * fibrad_random_next(&random) - 1, turn = 2 * PI * fibrad_random_next(&random);
            const double even[] = {sqrt(1 - height * height) * cos(turn), sqrt(1 - height * height) * sin(turn),
                                   height};
            double to[] = {0, 0, 1}, p[DEGREES + 1];
            const fibrad_random own = fibrad_random_start(n, k);
            fibrad_reemit_above(a[k], own, 9, even, to);
            ck_assert_double_le(fabs(to[0] * to[0] + to[1] * to[1] + to[2] * to[2] - 1), 1e-12);
            gsl_sf_legendre_Pl_array(DEGREES, fmax(-1, fmin(1, to[2])), p);
            for (int l = 0; l <= DEGREES; ++l) mean[l] += p[l] / DRAWS;
        }
        const double rest = a[k] < 1e-5 ? (1 + log(2)) * a[k] : 1 - fibrad_reemitted_evenly(a[k]);
        for (int l = 1; l <= DEGREES; ++l)
            ck_assert_double_le(fabs(mean[l] - a[k] / (a[k] + l) / rest), 4 / sqrt(DRAWS));
    }
}

/* ---- a ball in a box --------------------------------------------------------------------------------------------- */

enum { RINGS = 20, TURNS = 24, POINTS = RINGS * TURNS, GRID = 160, LAST = 14 };
struct ball_points {
    double n[POINTS][3], weight[POINTS]; /* normals; shares of the area */
    double arrives[2][POINTS];           /* from the walls x = 1 and z = 1 of the box -1 to 1; their emission is 1 */
};

/* The light from the wall at 1 on an axis that arrives at the point with normal n of a ball of radius r. */
static double light_from(int axis, double r, const double n[3]) {
    const int across = (axis + 1) % 3, up = (axis + 2) % 3;
    double sum = 0;
    for (int p = 0; p < GRID * GRID; ++p) {
        double v[3], square = 0, slope = 0;
        v[axis] = 1, v[across] = 2 * (p % GRID + .5) / GRID - 1, v[up] = 2 * (p / GRID + .5) / GRID - 1;
        for (int k = 0; k < 3; ++k) v[k] -= r * n[k], square += v[k] * v[k], slope += v[k] * n[k];
        sum += fmax(0, slope) * v[axis] / (PI * square * square) * 4 / (GRID * GRID);
    }
    return sum;
}

static void light_ball(double r, struct ball_points *ball) {
    gsl_integration_glfixed_table *table = gsl_integration_glfixed_table_alloc(RINGS);
    for (size_t k = 0; k < POINTS; ++k) {
        double z, w;
        gsl_integration_glfixed_point(-1, 1, k / TURNS, &z, &w, table);
        const double turn = 2 * PI * ((double)(k % TURNS) + .5) / TURNS, ring = sqrt(1 - z * z);
        ball->n[k][0] = ring * cos(turn), ball->n[k][1] = ring * sin(turn), ball->n[k][2] = z;
        ball->weight[k] = w / 2 / TURNS;
        for (int wall = 0; wall < 2; ++wall) ball->arrives[wall][k] = light_from(2 * wall, r, ball->n[k]);
    }
    gsl_integration_glfixed_table_free(table);
}

/* The part of the emission of wall z = 1 that the ball sends to wall x = 1 by reflection and conduction. The ball gives
 * off the part a/(a + l) of degree l; of degree 0 the node keeps m. */
static double by_ball(const struct ball_points *ball, double r, double e, double a) {
    double sum = 0, given[LAST + 1], p[LAST + 1];
    for (int l = 0; l <= LAST; ++l)
        given[l] = e * (2 * l + 1) * (l == 0 ? 1 - fibrad_reemitted_evenly(a) : a / (a + l));
    for (size_t i = 0; i < POINTS; ++i) {
        const double *from = ball->n[i], here = ball->weight[i] * ball->arrives[1][i];
        for (size_t k = 0; k < POINTS; ++k) {
            const double *to = ball->n[k], cosine = from[0] * to[0] + from[1] * to[1] + from[2] * to[2];
            double kernel = 0;
            gsl_sf_legendre_Pl_array(LAST, fmax(-1, fmin(1, cosine)), p);
            for (int l = 0; l <= LAST; ++l) kernel += given[l] * p[l];
            sum += here * ball->weight[k] * ball->arrives[0][k] * kernel;
        }
        sum += here * (1 - e) * ball->arrives[0][i];
    }
    return PI * r * r * sum; /* area of the ball, 4 pi r^2, over that of the wall, 4 */
}

/* The factor from wall z = 1 to wall x = 1, both black. */
static double to_side(double r, double e, double relative) {
    OWNED_BED bed = BED({0, 0, 0, r});
    fibrad_wall wall[6];
    for (int k = 0; k < 6; ++k) wall[k] = plane_at(k / 2, k % 2, k % 2 ? 1 : -1);
    const fibrad_scene_config config = {.wall = wall, .walls = 6};
    OWNED fibrad_scene *scene = scene_with(&bed, &config);
    OWNED_WORK work = work_growing();
    const double node = fibrad_node_emissivity(e, relative), black[] = {1, 1, 1, 1, 1, 1};
    fibrad_wall_rule rule = {.emissivity = &e, .wall_emissivity = black, .paths = 1 << 21, .conductivity = &relative};
    rule.node_emissivity = &node;
    fibrad_wall_row part[FIBRAD_WALL_PARTS], mean;
    for (uint32_t k = 0; k < FIBRAD_WALL_PARTS; ++k)
        assert_ok(fibrad_exchange_wall(scene, &work, 5, &rule, k, &part[k], NULL));
    assert_ok(fibrad_exchange_wall_mean(part, &mean));
    return mean.wall[1];
}

/* A ball in a black box conducts heat from one side of the box to another. */
TEST(by_a_ball) {
    static const double relative[] = {.1, .3, 2, .3}, e[] = {1, .8, .5, 1};
    static struct ball_points ball;
    const double r = .8, direct = to_side(r, 1, INFINITY);
    light_ball(r, &ball);
    for (int k = 0; k < 4; ++k) {
        const double truth = by_ball(&ball, r, e[k], e[k] / (2 * relative[k])),
                     found = to_side(r, e[k], relative[k]) - direct;
        assert_near(found, truth, .005);
    }
}

/* ---- beds -------------------------------------------------------------------------------------------------------- */

/* Spheres with temperatures, emissivities and k* of their own. sigma is 1. */
enum { MOST = 300 };
struct hot_bed {
    struct bed bed;
    fibrad_scene_config config;
    double temperature[MOST], emissivity[MOST], relative[MOST], node[MOST], conductivity[MOST];
};

static void hot_bed_free(struct hot_bed *h) { bed_free(&h->bed); }

/* Makes a random bed whose temperature rises along x, and differs from sphere to sphere. If `relative` is 0,
 * emissivities and k* differ, too. */
static struct hot_bed hot_bed(uint32_t n, double emissivity, double relative) {
    struct hot_bed h = {.bed = packing(n, .8, 1.2, .55, 2, false)};
    for (uint32_t i = 0; i < n; ++i) {
        const double t = .95 + .01 * h.bed.x[i] + .03 * bed_make_random(4, i);
        h.temperature[i] = t;
        h.emissivity[i] = relative > 0 ? emissivity : .3 + .7 * bed_make_random(5, i);
        h.relative[i] = relative > 0 ? relative : .1 * pow(100, bed_make_random(6, i));
        h.node[i] = fibrad_node_emissivity(h.emissivity[i], h.relative[i]);
        h.conductivity[i] = h.relative[i] * 8 * h.bed.r[i] * t * t * t;
    }
    return h;
}

static fibrad_bed_matrix *factors_of(const struct hot_bed *h, uint32_t paths, uint64_t seed) {
    const fibrad_spheres spheres = spheres_of(&h->bed);
    fibrad_exchange_rule rule = {.emissivity = h->emissivity, .paths = paths, .directions = 400, .seed = seed};
    rule.conductivity = h->relative, rule.node_emissivity = h->node;
    fibrad_bed_matrix *factors;
    assert_ok(exchange_of(&h->config, &spheres, &rule, NULL, NULL, &factors));
    return factors;
}

/* Finds powers from the factors, by a dense linear system for the values at nodes. Returns the sum of all powers over
 * the sum of their absolute values. Both include the surroundings, whose temperature is 1. */
static double powers_by_rows(const struct hot_bed *h, const fibrad_factors *m, double *power) {
    gsl_matrix *matrix = gsl_matrix_calloc(m->n, m->n);
    gsl_vector *right = gsl_vector_calloc(m->n), *value = gsl_vector_calloc(m->n);
    gsl_permutation *order = gsl_permutation_alloc(m->n);
    double sum = 0, all = 0;
    int sign;
    for (uint32_t i = 0; i < m->n; ++i) {
        const double back = h->node[i] / h->emissivity[i], resistance = 1 - back, own = pow(h->temperature[i], 4);
        gsl_matrix_set(matrix, i, i, 1 - resistance * matrix_total(m, i));
        for (uint64_t k = m->start[i]; k < m->start[i + 1]; ++k)
            *gsl_matrix_ptr(matrix, i, m->col[k]) += resistance * m->f[k];
        gsl_vector_set(right, i, own - resistance * m->escaped[i]);
    }
    ck_assert_int_eq(gsl_linalg_LU_decomp(matrix, order, &sign), 0);
    ck_assert_int_eq(gsl_linalg_LU_solve(matrix, order, right, value), 0);
    for (uint32_t i = 0; i < m->n; ++i) {
        const double own = gsl_vector_get(value, i), weight = 4 * PI * h->bed.r[i] * h->bed.r[i] * h->node[i];
        power[i] = 0;
        for (uint64_t k = m->start[i]; k < m->start[i + 1]; ++k)
            power[i] += weight * m->f[k] * (gsl_vector_get(value, m->col[k]) - own);
        const double escaped = weight * m->escaped[i] * (1 - own);
        power[i] += escaped, sum += power[i] - escaped, all += fabs(power[i]) + fabs(escaped);
    }
    gsl_permutation_free(order), gsl_vector_free(value), gsl_vector_free(right), gsl_matrix_free(matrix);
    return sum / all;
}

static void powers_by_patches(const struct hot_bed *h, double *power) {
    const fibrad_spheres spheres = spheres_of(&h->bed);
    const fibrad_heat_config config = {.directions = 1500, .points = 128};
    fibrad_heat_sources sources;
    OWNED_MADE *radiation = NULL;
    fibrad_heat_result result = {.power = power};
    fibrad_heat_sources_init(&sources);
    sources.temperature = h->temperature, sources.emissivity = h->emissivity, sources.conductivity = h->conductivity;
    sources.surroundings = 1, sources.sigma = 1, sources.tolerance = 1e-6;
    assert_ok(made_with(&radiation, &h->config, &spheres, &config, NULL));
    assert_ok(fibrad_bed_solve(radiation, &sources, NULL, &result));
}

/* Powers by rows are those by patches, but for the noise of paths, which two seeds tell. */
static const double bed_k[] = {.1, .1, 1, 10, 0}, bed_e[] = {.8, 1, .6, .8, 0};
LOOP_TEST(powers_are_those_of_patches, 5) {
    OWNED_BY(hot_bed_free) struct hot_bed h = hot_bed(30, bed_e[_i], bed_k[_i]);
    double truth[MOST], found[2][MOST], mean[MOST];
    powers_by_patches(&h, truth);
    for (uint64_t seed = 0; seed < 2; ++seed) {
        OWNED_FACTORS *factors = factors_of(&h, 4000, seed);
        ck_assert_double_le(factors->reciprocity_error, 1e-12);
        for (uint64_t k = 0; k < factors->matrix.start[h.bed.n]; ++k) ck_assert_double_ge(factors->matrix.f[k], 0);
        ck_assert_double_le(fabs(powers_by_rows(&h, &factors->matrix, found[seed])), 1e-12);
    }
    for (uint32_t i = 0; i < h.bed.n; ++i) mean[i] = (found[0][i] + found[1][i]) / 2;
    const double noise = difference_of(found[0], found[1], h.bed.n) / 2, off = difference_of(mean, truth, h.bed.n);
    ck_assert_double_le(noise, .015);
    ck_assert_double_le(sqrt(fmax(0, off * off - noise * noise)), .01);
}

/* Spheres of one temperature have the same rows as without conduction, to the bit. Spheres of k* = 1e6 have the same
 * powers within the noise. */
TEST(good_conductors) {
    OWNED_BY(hot_bed_free) struct hot_bed h = hot_bed(100, .7, INFINITY);
    double power[2][MOST];
    const fibrad_spheres spheres = spheres_of(&h.bed);
    const fibrad_exchange_rule plain = {.emissivity = h.emissivity, .paths = 2000, .directions = 400, .seed = 1};
    fibrad_bed_matrix *one, *all = factors_of(&h, 2000, 1);
    assert_ok(exchange_of(NULL, &spheres, &plain, NULL, NULL, &one));
    ck_assert(matrix_same_bits(&one->matrix, &all->matrix));
    powers_by_rows(&h, &one->matrix, power[0]);
    fibrad_bed_matrix_free(one);
    fibrad_bed_matrix_free(all);
    for (uint32_t i = 0; i < h.bed.n; ++i) {
        h.relative[i] = 1e6, h.node[i] = fibrad_node_emissivity(.7, 1e6);
        ck_assert_double_lt(h.node[i], .7);
    }
    all = factors_of(&h, 2000, 1);
    powers_by_rows(&h, &all->matrix, power[1]);
    ck_assert_double_le(difference_of(power[1], power[0], h.bed.n), 1e-4);
    fibrad_bed_matrix_free(all);
}

/* Impossible numbers are refused: nodes without conductivities, nodes above the emissivity, k* too small or NaN. Both
 * the sphere itself and one that paths meet have them. */
TEST(refusals) {
    OWNED_BED bed = BED({0, 0, 0, 1}, {0, 0, 2, 1});
    const double black[] = {.5, .5};
    OWNED fibrad_scene *scene = scene_of(&bed, 0);
    OWNED_WORK work = work_growing();
    OWNED_ROW row = row_of(2);
    for (int k = 0; k < 8; ++k) {
        double relative[] = {1, 1}, node[] = {.3, .3};
        if (k < 4) node[k / 2] = k % 2 ? .6 : NAN;
        if (k == 4) relative[1] = 0;
        if (k == 5) relative[1] = NAN;
        const fibrad_exchange_rule rule = {
            .emissivity = black, .conductivity = k == 6 ? NULL : relative, .node_emissivity = node};
        ck_assert_int_eq(fibrad_exchange_row(scene, &work, 0, &rule, &row, NULL),
                         k < 7 ? FIBRAD_E_ARGUMENT : FIBRAD_OK);
        OWNED_FACTORS *factors = NULL;
        const fibrad_spheres spheres = spheres_of(&bed);
        ck_assert_int_eq(exchange_of(NULL, &spheres, &rule, NULL, NULL, &factors),
                         k < 7 ? FIBRAD_E_ARGUMENT : FIBRAD_OK);
    }
}

/* ---- the program ------------------------------------------------------------------------------------------------- */

static const char *pebbles(void) {
    return write_file("bed.csv", "x,y,z,radius,k,T\n0,0,0,30,2,1000\n70,0,0,30,3,1200\n0,70,0,30,4,1500\n");
}

/* Powers by factors of spheres that conduct badly err more than rows: two seeds tell how much. The summary knows, and
 * warns. */
static const double bad_k[] = {.02, .1, 2};
LOOP_TEST(errors_of_powers, 3) {
    OWNED_BY(hot_bed_free) struct hot_bed h = {.bed = packing(24, 1, 1, .4, 3, true)};
    double found[2][MOST];
    char text[24 * 80] = "x,y,z,r\n";
    for (uint32_t i = 0; i < h.bed.n; ++i) {
        h.temperature[i] = .7 + .6 * bed_make_random(4, i), h.emissivity[i] = .8, h.relative[i] = bad_k[_i];
        h.node[i] = fibrad_node_emissivity(.8, bad_k[_i]);
        snprintf(text + strlen(text), 80, "%.17g,%.17g,%.17g,1\n", h.bed.x[i], h.bed.y[i], h.bed.z[i]);
    }
    memcpy(h.config.period, h.bed.period, sizeof h.config.period);
    for (uint64_t seed = 0; seed < 2; ++seed) {
        OWNED_FACTORS *factors = factors_of(&h, 500, seed);
        powers_by_rows(&h, &factors->matrix, found[seed]);
    }
    const double noise = difference_of(found[0], found[1], h.bed.n) / sqrt(2);
    const char *solid = formatted("%.9g", bad_k[_i] * 8 * 5.670374419e-8 * 1e9);
    const char *period = formatted("%.17g,%.17g,%.17g", h.bed.period[0], h.bed.period[1], h.bed.period[2]);
    SUCCEED("factors", write_file("bad.csv", text), "--length-unit", "m", "--emissivity", "0.8", "--periodic", period,
            "--temperature", "1000", "--solid-conductivity", solid, "--rays", "500", "--directions", "400");
    const double error = value_of("error_of_powers");
    ck_assert_msg(error > .4 * noise && error < 3 * noise, "%g for %g", error, noise);
    ck_assert_int_eq(strstr(said, "powers by these factors") != NULL, error > .03);
}

TEST(outputs) {
    const char *json = in_folder("D.json"), *npz = in_folder("D.npz");
    SUCCEED("factors", pebbles(), "--length-unit", "mm", "--emissivity", "0.8", "--solid-conductivity", "k",
            "--temperature", "T", "-o", json, "-o", npz);
    double mean = 0, star = 0;
    for (int i = 0; i < 3; ++i) {
        const double t[] = {1000, 1200, 1500}, k = (2 + i) / (.24 * 5.670374419e-8 * pow(t[i], 3));
        star += k / 3, mean += fibrad_node_emissivity(.8, k) / 3;
    }
    assert_near(value_of("k_star"), star, 1e-3);
    assert_near(value_of("node_emissivity"), mean, 1e-5);
    char *text = read_file(json), *at = strstr(text, "\"node_emissivity\":[");
    ck_assert_ptr_nonnull(at);
    ck_assert_double_le(
        fabs(strtod(strchr(at, '[') + 1, NULL) - fibrad_node_emissivity(.8, 2 / (.24 * 5.670374419e-8 * 1e9))), 1e-12);
    SUCCEED("factors", pebbles(), "--emissivity", "0.8", "-o", json);
    assert_lacks(read_file(json), "node_emissivity");
}

TEST(mistakes) {
    static const struct {
        const char *solid, *temperature, *reason;
        int status;
    } wrong[] = {
        {"0", "900", "--solid-conductivity", 2},
        {"-3", "900", "--solid-conductivity", 2},
        {"nan", "900", "no column nan", 3},
        {"lambda", "900", "no column lambda", 3},
        {"x", "900", "conductivity of the solid", 3},
        {"5", NULL, "--temperature is missing", 2},
        {NULL, "900", "--solid-conductivity is missing", 2},
        {"5", "-900", "--temperature", 2},
        {"5", "hot", "no column hot", 3},
        {"1e-6", "5000", "k_s/(4 d sigma T^3) is", 3},
    };
    const char *file = pebbles();
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
        const char *solid = wrong[k].solid, *kelvins = wrong[k].temperature;
        const int status = solid && kelvins
                               ? RUN("factors", file, "--length-unit", "mm", "--emissivity", "0.8",
                                     "--solid-conductivity", solid, "--temperature", kelvins)
                               : RUN("factors", file, "--length-unit", "mm", "--emissivity", "0.8",
                                     solid ? "--solid-conductivity" : "--temperature", solid ? solid : kelvins);
        ck_assert_msg(status == wrong[k].status && strstr(said, wrong[k].reason), "%zu: %d, %s", k, status, said);
    }
    FAIL_WITH(2, "factors", file, "--emissivity", "0.8", "--solid-conductivity", "5", "--temperature", "900");
    assert_has(said, "--length-unit");
}
