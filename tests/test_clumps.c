/* test_clumps.c - clumps: what is exposed of members, view factors of bodies, and the program's words for them.
 * SPDX-License-Identifier: MIT
 *
 * Truth: closed forms of dumbbells, quadrature of exposed areas slice by slice, and own rays on the union. */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <stdbool.h>

#include "host_owned.h"
#include "program.h"

FIXTURE(make_folder, remove_folder)

enum { MOST = 40 };

/* Spheres of which the first `members` are clump 7. */
struct bodies {
    double at[MOST][3], r[MOST];
    uint32_t n, members;
    fibrad_scene_config config;
};

/* The four unequal spheres of which some have centres inside others, and two targets. */
static const struct bodies four = {
    .at = {{0, 0, 0}, {.7, .1, 0}, {.2, .6, .3}, {-.4, -.2, .5}, {2.2, .8, .3}, {-.8, 1.9, .4}},
    .r = {1, .8, .7, .6, .7, .6},
    .n = 6,
    .members = 4};

static struct bodies dumbbell(double d) {
    return (struct bodies){.at = {{0, 0, 0}, {d, 0, 0}, {d / 2, 2.2, 0}}, .r = {1, 1, 1}, .n = 3, .members = 2};
}

static fibrad_spheres spheres_of(const struct bodies *b, uint32_t clump[MOST]) {
    for (uint32_t i = 0; i < b->n; ++i) clump[i] = i < b->members ? 7 : 0;
    return (fibrad_spheres){&b->at[0][0], &b->at[0][1], &b->at[0][2], b->r, b->n, .stride = 3, .clump = clump};
}

static fibrad_bed *made_of(const struct bodies *b) {
    uint32_t clump[MOST];
    const fibrad_spheres spheres = spheres_of(b, clump);
    fibrad_bed *bed;
    assert_ok(fibrad_bed_new(&bed, &b->config, &spheres, NULL));
    return bed;
}

static fibrad_bed_matrix *factors_of(const struct bodies *b, uint32_t directions) {
    OWNED_MADE *bed = made_of(b);
    fibrad_bed_matrix *factors;
    assert_ok(fibrad_bed_factors(
        bed, &(fibrad_bed_rule){.beam = &(fibrad_beam_rule){.directions = directions}, .walls = 1}, &factors));
    return factors;
}

static double factor(const fibrad_bed_matrix *factors, uint32_t i, uint32_t j) {
    const fibrad_factors *m = &factors->matrix;
    for (uint64_t k = m->start[i]; k < m->start[i + 1]; ++k)
        if (m->col[k] == j) return m->f[k];
    return 0;
}

/* Rows add up to 1, A_C F_CD = A_D F_DC, and no factor is negative. */
static void assert_closed(const fibrad_bed_matrix *factors) {
    const fibrad_factors *m = &factors->matrix;
    for (uint32_t i = 0; i < m->n; ++i) {
        double sum = m->escaped[i] + m->beyond[i];
        for (uint32_t w = 0; w < m->walls; ++w) sum += m->wall[i * m->walls + w];
        for (uint64_t k = m->start[i]; k < m->start[i + 1]; ++k) {
            const double there = factors->area[i] * m->f[k],
                         back = factors->area[m->col[k]] * factor(factors, m->col[k], i);
            sum += m->f[k];
            ck_assert(m->f[k] >= 0);
            ck_assert_msg(fabs(there - back) <= 4e-16 * fmax(factors->area[i], factors->area[m->col[k]]), "%g",
                          there - back);
        }
        ck_assert_double_eq_tol(sum, 1, 1e-13);
    }
}

/* ---- exposed areas ---------------------------------------------------------------------------------------------- */

static void exposed(const struct bodies *b, double area[MOST], fibrad_scene_facts *facts) {
    uint32_t clump[MOST];
    const fibrad_spheres spheres = spheres_of(b, clump);
    const size_t size = fibrad_scene_size(b->n, 0) + fibrad_clumps_size(b->n);
    OWNED void *memory = malloc(size);
    fibrad_scene *scene;
    ck_assert_int_eq(fibrad_scene_init(&scene, memory, size - 1, &b->config, &spheres, NULL), FIBRAD_E_SIZE);
    assert_ok(fibrad_scene_init(&scene, memory, size, &b->config, &spheres, NULL));
    for (uint32_t i = 0; i < b->n; ++i) area[i] = fibrad_scene_exposed_area(scene, i);
    ck_assert(isnan(fibrad_scene_exposed_area(scene, b->n)) && isnan(fibrad_scene_exposed_area(NULL, 0)));
    fibrad_scene_describe(scene, facts);
}

static double sum_of(const double *area, uint32_t n) {
    double sum = 0;
    for (uint32_t i = 0; i < n; ++i) sum += area[i];
    return sum;
}

TEST(dumbbells) {
    fibrad_scene_facts facts;
    double area[MOST];
    for (double d = 2; d > 1e-7; d *= .7) {
        const struct bodies b = dumbbell(d);
        exposed(&b, area, &facts);
        assert_near(area[0] + area[1], 2 * PI * (2 + d), 1e-12);
        assert_near(area[0], area[1], 1e-12);
        assert_near(area[2], 4 * PI, 1e-15);
        ck_assert(facts.clumps == 1 && facts.covered == 0 && facts.parted == 0 && facts.overlap_max == 0);
    }
}

/* A sphere of unit radius, and the sphere of radius r at distance d: the cap that it hides. */
static double cap_of(double r, double d) { return 2 * PI * (1 - (1 + d * d - r * r) / (2 * d)); }

TEST(special_places) {
    fibrad_scene_facts facts;
    double area[MOST];
    struct bodies b = {.at = {{0, 0, 0}, {.2, .1, 0}, {0, 0, 0}, {0, 0, 0}}, .r = {1, .5, .3, 1}, .n = 4, .members = 4};
    exposed(&b, area, &facts); /* one within, one in the middle, one twice */
    assert_near(sum_of(area, 4), 4 * PI, 1e-11);
    ck_assert(area[1] == 0 && area[2] == 0 && facts.covered == 2 && facts.covered_sphere == 1);
    /* six caps that touch each other, and a seventh under one of them */
    const double chord = sqrt(2 - sqrt(2));
    b = (struct bodies){.at = {{0}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}, {1.1, 0, 0}},
                        .r = {1, chord, chord, chord, chord, chord, chord, .3},
                        .n = 8,
                        .members = 8};
    exposed(&b, area, &facts);
    assert_near(area[0], 4 * PI - 6 * cap_of(chord, 1), 1e-11);
    /* eight spheres at the corners of a cube: three circles meet in a point, and in the middle all is hidden */
    b = (struct bodies){.n = 8, .members = 8};
    for (int i = 0; i < 8; ++i)
        for (int k = 0; k < 3; ++k) b.at[i][k] = i >> k & 1, b.r[i] = sqrt(.75);
    exposed(&b, area, &facts);
    /* from each corner an eighth of the sphere beyond all three planes, and three parts that one or two others bound */
    const double rim = 1 - .5 / b.r[0], low = area[0];
    ck_assert(low < 4 * PI * .75 * (1 - 3 * rim / 2) + 3 * 4 * PI * .75 * rim * rim && low > 4 * PI * .75 / 8);
    for (int i = 1; i < 8; ++i) assert_near(area[i], low, 1e-11);
    /* three beads on a line whose circles agree: the middle one has no surface */
    b = (struct bodies){.at = {{0, 0, 0}, {.3, .4, .5}, {.6, .8, 1}}, .r = {1, sqrt(.5), 1}, .n = 3, .members = 3};
    exposed(&b, area, &facts);
    assert_near(area[0] + area[2], 2 * PI * (2 + sqrt(2)), 1e-11);
    ck_assert(facts.covered == 1 && area[1] == 0);
    /* nine beads on a skew line, all through one circle: the outermost two have all of the surface */
    b.n = b.members = 9;
    double sum = 0;
    for (int i = 0; i < 9; ++i) {
        const double along = .137 * i * i - 2.1;
        for (int k = 0; k < 3; ++k) b.at[i][k] = 3 + (const double[]){.48, -.6, .64}[k] * along;
        b.r[i] = sqrt(.49 + along * along);
        if (i % 8 == 0) sum += 2 * PI * b.r[i] * (b.r[i] + fabs(along));
    }
    exposed(&b, area, &facts);
    assert_near(sum_of(area, 9), sum, 1e-10);
}

/* A sphere cut into slices: how much of the circle at height z is free. */
struct slices {
    const struct bodies *of;
    uint32_t i;
};

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double free_angle(double z, void *slices) {
    const struct slices *s = slices;
    const struct bodies *b = s->of;
    double hidden[MOST][2], reach = -INFINITY, angle = 0;
    uint32_t n = 0;
    for (uint32_t j = 0; j < b->members; ++j) {
        double c[3], square = 0;
        for (int k = 0; k < 3; ++k) c[k] = (b->at[j][k] - b->at[s->i][k]) / b->r[s->i], square += c[k] * c[k];
        const double r = b->r[j] / b->r[s->i], across = sqrt(fmax(0, 1 - z * z)) * hypot(c[0], c[1]);
        const double from = (1 + square - r * r) / 2 - z * c[2]; /* hidden: across cos(angle) > from */
        if (j == s->i || from >= across) continue;
        if (from <= -across) return 0;
        const double half = acos(from / across), low = atan2(c[1], c[0]) - half;
        hidden[n][0] = low + (low < 0 ? 2 * PI : 0), hidden[n][1] = hidden[n][0] + 2 * half;
        reach = fmax(reach, hidden[n++][1] - 2 * PI);
    }
    if (n == 0) return 2 * PI;
    qsort(hidden, n, sizeof *hidden, ascending);
    for (uint32_t k = 0; k < n; ++k) {
        angle += fmax(0, hidden[k][0] - reach);
        reach = fmax(reach, hidden[k][1]);
    }
    return angle;
}

/* The exposed area of a member by adaptive quadrature. Between the ends of the circles the integrand is smooth but for
 * bends. */
static double by_slices(const struct bodies *b, uint32_t i) {
    enum { PIECES = 50 }; /* so that no bend is overlooked */
    double end[2 * MOST + PIECES + 1], sum = 0, error;
    uint32_t n = 0;
    for (; n <= PIECES; ++n) end[n] = -1 + 2. * n / PIECES;
    for (uint32_t j = 0; j < b->members; ++j) {
        double c[3], square = 0;
        for (int k = 0; k < 3; ++k) c[k] = (b->at[j][k] - b->at[i][k]) / b->r[i], square += c[k] * c[k];
        const double d = sqrt(square), r = b->r[j] / b->r[i], middle = c[2] / d,
                     cosine = (1 + square - r * r) / (2 * d);
        if (j == i || fabs(cosine) >= 1) continue;
        for (int side = -1; side < 2; side += 2)
            end[n++] = middle * cosine + side * sqrt((1 - middle * middle) * (1 - cosine * cosine));
    }
    qsort(end, n, sizeof *end, ascending);
    gsl_integration_workspace *work = gsl_integration_workspace_alloc(4000);
    gsl_set_error_handler_off();
    for (uint32_t k = 1; k < n; ++k) {
        gsl_function f = {free_angle, &(struct slices){b, i}};
        double part = 0;
        if (end[k] > end[k - 1])
            gsl_integration_qag(&f, end[k - 1], end[k], 1e-12, 1e-11, 4000, GSL_INTEG_GAUSS21, work, &part, &error);
        sum += part;
    }
    gsl_integration_workspace_free(work);
    return sum * b->r[i] * b->r[i];
}

TEST(areas_by_slices) {
    fibrad_scene_facts facts;
    double area[MOST];
    uint64_t random = 1;
    exposed(&four, area, &facts);
    for (uint32_t i = 0; i < 4; ++i) ck_assert_double_eq_tol(area[i], by_slices(&four, i), 1e-9);
    for (int t = 0; t < 15; ++t) {
        struct bodies b = {.n = (uint32_t)(3 + 2 * t), .members = (uint32_t)(3 + 2 * t)};
        for (uint32_t i = 0; i < b.n; ++i)
            for (int k = 0; k < 4; ++k) {
                random = random * 6364136223846793005u + 1442695040888963407u;
                *(k < 3 ? &b.at[i][k] : &b.r[i]) = (double)(random >> 11) * 0x1p-53 * (k < 3 ? 1.5 + t % 3 : .7) + .3;
            }
        exposed(&b, area, &facts);
        for (uint32_t i = 0; i < b.n; ++i) ck_assert_double_eq_tol(area[i], by_slices(&b, i), 1e-8);
    }
}

/* ---- view factors ----------------------------------------------------------------------------------------------- */

/* What leaves a dumbbell and does not come back is four shadows over the area. */
static double shadow_lack(double mu, void *distance) {
    const double x = *(double *)distance * sqrt(1 - mu * mu);
    return 2 * PI - (x < 2 ? 2 * acos(x / 2) - x / 2 * sqrt(4 - x * x) : 0);
}

static double self_factor(double d) {
    double shadow, error;
    gsl_integration_workspace *work = gsl_integration_workspace_alloc(1000);
    gsl_integration_qags(&(gsl_function){shadow_lack, &d}, 0, 1, 0, 1e-12, 1000, work, &shadow, &error);
    gsl_integration_workspace_free(work);
    return 1 - 4 * shadow / (2 * PI * (2 + d));
}

/* Own rays, from an even point of the exposed surface by the cosine law. */
struct rays {
    uint64_t random;
    double hits[MOST + 7], n; /* of the clump (0), of each other sphere (1 ...), of walls (MOST ...), out (MOST + 6) */
};

static double fraction(struct rays *rays) {
    rays->random = rays->random * 6364136223846793005u + 1442695040888963407u;
    uint64_t z = rays->random;
    z = (z ^ z >> 32) * 0xd6e8feb86659fd93u, z ^= z >> 32;
    return (double)(z >> 11) * 0x1p-53;
}

static void even(struct rays *rays, double v[3]) {
    const double z = 2 * fraction(rays) - 1, turn = 2 * PI * fraction(rays), ring = sqrt(1 - z * z);
    v[0] = ring * cos(turn), v[1] = ring * sin(turn), v[2] = z;
}

/* The body that a ray from a point of sphere i meets first: 0: the clump; MOST + 6: none. best: its distance. */
static uint32_t first_met(const struct bodies *b, uint32_t i, const double o[3], const double w[3], double *best) {
    uint32_t to = MOST + 6;
    *best = INFINITY;
    for (uint32_t j = 0; j < b->n; ++j) {
        double along = 0, square = -b->r[j] * b->r[j];
        for (int k = 0; k < 3; ++k) along += (o[k] - b->at[j][k]) * w[k], square += pow(o[k] - b->at[j][k], 2);
        const double root = along * along - square;
        if (j == i || along >= 0 || root <= 0 || -along - sqrt(root) >= *best) continue;
        *best = -along - sqrt(root), to = j < b->members ? 0 : j - b->members + 1;
    }
    return to;
}

/* Whether a point of member i lies within another member. */
static bool is_hidden(const struct bodies *b, uint32_t i, const double o[3]) {
    for (uint32_t j = 0; j < b->members && i < b->members; ++j) {
        double square = 0;
        for (int k = 0; k < 3; ++k) square += pow(o[k] - b->at[j][k], 2);
        if (j != i && square < b->r[j] * b->r[j]) return true;
    }
    return false;
}

/* Follows a ray from body `from` (0: the clump), unless the point is hidden. box: of walls; NULL: none. */
static void one_ray(const struct bodies *b, uint32_t from, const double box[2], struct rays *rays) {
    const uint32_t first = from == 0 ? 0 : b->members + from - 1, end = from == 0 ? b->members : first + 1;
    double n[3], u[3], o[3], w[3], length = 0, best, pick = 0;
    uint32_t i = first;
    for (uint32_t j = first; j < end; ++j) pick += b->r[j] * b->r[j];
    pick *= fraction(rays);
    while (i < end - 1 && (pick -= b->r[i] * b->r[i]) >= 0) ++i;
    even(rays, n), even(rays, u);
    for (int k = 0; k < 3; ++k) o[k] = b->at[i][k] + b->r[i] * n[k], w[k] = n[k] + u[k], length += w[k] * w[k];
    for (int k = 0; k < 3; ++k) w[k] /= sqrt(length);
    if (is_hidden(b, i, o)) return;
    uint32_t to = first_met(b, i, o, w, &best);
    for (uint32_t wall = 0; wall < 6 && box; ++wall) {
        const double s = (box[wall % 2] - o[wall / 2]) / w[wall / 2];
        if (s > 0 && s < best) best = s, to = MOST + wall;
    }
    ++rays->n, ++rays->hits[to];
}

static struct rays follow(const struct bodies *b, uint32_t from, const double box[2], int count) {
    struct rays rays = {.random = 12345 + from};
    while (rays.n < count) one_ray(b, from, box, &rays);
    return rays;
}

static void assert_seen(const struct rays *rays, uint32_t to, double value, double error) {
    const double f = rays->hits[to] / rays->n;
    ck_assert_double_eq_tol(value, f, 4 * sqrt(fmax(f, 1 / rays->n) / rays->n) + 2 * error);
}

/* The table of AROUND.md: what a dumbbell sends to itself, and to a third sphere. */
LOOP_TEST(table_of_dumbbells, 6) {
    const double d = (const double[]){1.8, 1.5, 1.2, 1, .8, .5}[_i];
    const struct bodies b = dumbbell(d);
    OWNED_FACTORS *factors = factors_of(&b, 1024);
    const struct rays rays = follow(&b, 1, NULL, 1000000);
    ck_assert_double_eq_tol(factor(factors, 0, 0), self_factor(d), 1e-8);
    assert_seen(&rays, 0, factor(factors, 1, 0), factors->matrix.error[1]);
    assert_near(factors->area[0], 2 * PI * (2 + d), 1e-12);
    ck_assert(factors->matrix.n == 2 && factors->body[0] == 0 && factors->body[1] == 0 && factors->body[2] == 1);
    assert_closed(factors);
    struct bodies alone = b;
    alone.n = 2;
    OWNED_FACTORS *few = factors_of(&alone, 100);
    ck_assert_double_eq_tol(factor(few, 0, 0), self_factor(d), 1e-8);
}

/* Four unequal spheres and two targets, in the open and in a box, by lines and by directions. */
LOOP_TEST(four_spheres, 4) {
    static const double box[2] = {-2.4, 3.1};
    struct bodies b = four;
    fibrad_wall wall[6];
    for (uint32_t k = 0; k < 6; ++k)
        wall[k] = (fibrad_wall){.kind = FIBRAD_WALL_PLANE, .plane = {(int)k / 2, (int)k % 2, box[k % 2]}};
    if (_i % 2) b.config.wall = wall, b.config.walls = 6;
    OWNED_FACTORS *factors = factors_of(&b, _i < 2 ? 512 : 1800);
    assert_closed(factors);
    for (uint32_t from = 0; from < 3; ++from) {
        const struct rays rays = follow(&b, from, _i % 2 ? box : NULL, 300000);
        const double error = factors->matrix.error[from];
        for (uint32_t to = 0; to < 3; ++to) assert_seen(&rays, to, factor(factors, from, to), error);
        for (uint32_t k = 0; k < 6 && _i % 2; ++k)
            assert_seen(&rays, MOST + k, factors->matrix.wall[6 * from + k], error);
        assert_seen(&rays, MOST + 6, factors->matrix.escaped[from], error);
        ck_assert(error < .003);
    }
}

/* A far sphere that few windows meet, half hidden by another one. Own rays go from it to points about the clump. */
TEST(far_spheres) {
    struct bodies b = four;
    const double far[2][3] = {{14, 3, -6}, {7.6, 1.7, -3}}, radius = 2;
    for (int k = 0; k < 6; ++k) b.at[4 + k / 3][k % 3] = far[k / 3][k % 3];
    b.r[4] = .9, b.r[5] = .6;
    OWNED_FACTORS *factors = factors_of(&b, 64);
    struct rays rays = {.random = 5};
    double sum = 0, square = 0;
    enum { RAYS = 1000000 };
    for (int ray = 0; ray < RAYS; ++ray) {
        double n[3], u[3], o[3], w[3], best, length = 0, leaves = 0, arrives = 0;
        even(&rays, n), even(&rays, u);
        for (int k = 0; k < 3; ++k)
            o[k] = far[0][k] + b.r[4] * n[k], w[k] = radius * u[k] - o[k], length += w[k] * w[k];
        for (int k = 0; k < 3; ++k) w[k] /= sqrt(length), leaves += w[k] * n[k], arrives -= w[k] * u[k];
        if (leaves <= 0 || arrives <= 0 || first_met(&b, 4, o, w, &best) != 0) continue;
        const double part = 4 * radius * radius * leaves * arrives / length; /* 4 pi R^2 cos cos/(pi s^2) */
        sum += part / RAYS, square += part * part / RAYS;
    }
    const double error = sqrt((square - sum * sum) / RAYS);
    ck_assert_double_eq_tol(factor(factors, 1, 0), sum, 4 * error + 2 * factors->matrix.error[1]);
    ck_assert(factors->matrix.error[1] < .1 * sum && error < .02 * sum);
}

/* Rays of the library meet the same union. */
LOOP_TEST(rays_of_the_library, 2) {
    OWNED_MADE *bed = made_of(&four);
    OWNED_FACTORS *factors = NULL, *truth = factors_of(&four, 1024);
    const fibrad_cast_rule rule = {.rays = 50000, .random = _i};
    assert_ok(fibrad_bed_factors(bed, &(fibrad_bed_rule){.cast = &rule}, &factors));
    for (uint32_t i = 0; i < 3; ++i)
        for (uint32_t j = 0; j < 3; ++j)
            ck_assert_double_eq_tol(factor(factors, i, j), factor(truth, i, j), 2.5 * factors->matrix.error[i]);
    assert_closed(factors);
}

/* A sphere with another one within is a sphere. So is one of two halves. Nothing comes back, and no factor is negative.
 */
TEST(convex_bodies) {
    struct bodies b = {.at = {{0}, {.3, .2, .1}, {0}, {1e-9, 0, 0}, {0, 2.3, .4}, {2.2, 0, 0}},
                       .r = {1, .5, .2, 1, .8, .9},
                       .n = 6,
                       .members = 4,
                       .config.period = {6, 5, 5}};
    struct bodies plain = {
        .at = {{0}, {0, 2.3, .4}, {2.2, 0, 0}}, .r = {1, .8, .9}, .n = 3, .config.period = {6, 5, 5}};
    uint32_t none[MOST];
    fibrad_spheres spheres = spheres_of(&plain, none);
    OWNED_FACTORS *factors = factors_of(&b, 362), *truth = NULL;
    assert_ok(fibrad_view_factors(&plain.config, &spheres,
                                  &(fibrad_bed_rule){.beam = &(fibrad_beam_rule){.directions = 362}}, NULL, &truth));
    assert_closed(factors);
    for (uint32_t i = 0; i < 3; ++i)
        for (uint32_t j = 0; j < 3; ++j) ck_assert_double_eq_tol(factor(factors, i, j), factor(truth, i, j), 1e-3);
    ck_assert(truth->body == NULL && truth->area == NULL);
}

/* A clump across a period is the same as elsewhere. Its own images are seen. */
TEST(across_a_period) {
    struct bodies b = four;
    for (int k = 0; k < 3; ++k) b.config.period[k] = 5;
    OWNED_FACTORS *here = factors_of(&b, 362);
    for (uint32_t i = 0; i < b.n; ++i)
        for (int k = 0; k < 3; ++k) b.at[i][k] = fmod(b.at[i][k] + 7.3 + k, 5);
    OWNED_FACTORS *there = factors_of(&b, 362);
    assert_closed(there);
    for (uint32_t i = 0; i < 3; ++i)
        for (uint32_t j = 0; j < 3; ++j) ck_assert_double_eq_tol(factor(here, i, j), factor(there, i, j), 1e-11);
    assert_near(here->area[0], there->area[0], 1e-13);
    ck_assert(here->facts.clumps == 1 && there->facts.parted == 0);
    OWNED_MADE *bed = NULL;
    uint32_t clump[MOST];
    fibrad_run run = {0};
    b.n = 4, b.config.period[0] = 2.2;
    const fibrad_spheres spheres = spheres_of(&b, clump);
    ck_assert_int_eq(fibrad_bed_new(&bed, &b.config, &spheres, &run), FIBRAD_E_GEOMETRY);
    ck_assert_int_eq(run.fault.why, FIBRAD_WHY_CLUMP);
}

/* The order of the members does not matter. Rows are raw and of bodies if some are wanted. */
TEST(members_in_any_order) {
    struct bodies b = four;
    OWNED_FACTORS *one = factors_of(&four, 181);
    for (uint32_t i = 0; i < b.n; ++i) {
        memcpy(b.at[i], four.at[b.n - 1 - i], sizeof b.at[i]);
        b.r[i] = four.r[b.n - 1 - i];
    }
    const uint32_t clump[MOST] = {0, 0, 3, 3, 3, 3}, new[] = {2, 1, 0};
    const uint64_t id[MOST] = {5, 4, 3, 2, 1, 0};
    const fibrad_spheres spheres = {&b.at[0][0], &b.at[0][1], &b.at[0][2], b.r, 6, 3, 0, id, clump};
    OWNED_FACTORS *other = NULL, *some = NULL;
    fibrad_bed_rule rule = {.beam = &(fibrad_beam_rule){.directions = 181}};
    assert_ok(fibrad_view_factors(NULL, &spheres, &rule, NULL, &other));
    for (uint32_t i = 0; i < 3; ++i)
        for (uint32_t j = 0; j < 3; ++j)
            ck_assert_double_eq_tol(factor(one, i, j), factor(other, new[i], new[j]), 1e-13);
    rule.wanted = (const unsigned char[]){1, 0, 0, 0, 1, 0};
    assert_ok(fibrad_view_factors(NULL, &spheres, &rule, NULL, &some));
    ck_assert_uint_eq(some->matrix.start[1], some->matrix.start[2]); /* sphere 1 is alone, and not wanted */
    ck_assert_double_eq_tol(factor(some, 2, 2), factor(one, 0, 0), 1e-3);
    rule = (fibrad_bed_rule){.exchange = &(fibrad_exchange_rule){.emissivity = b.r}};
    fibrad_bed_matrix *none = NULL;
    ck_assert_int_eq(fibrad_view_factors(NULL, &spheres, &rule, NULL, &none), FIBRAD_E_UNSUPPORTED);
}

/* ---- the program ------------------------------------------------------------------------------------------------ */

#define CLUMPS "tests/data/clumps2000.dump"

/* A matrix in a .csv: entries by the names of rows and columns, both from 1. Those below 0 are not read. */
static void read_entries(const char *path, long n, double *f, double *sum) {
    char *at = strchr(read_file(path), '\n') + 1;
    for (; *at; at = strchr(at, '\n') + 1) {
        const long i = strtol(at, &at, 10), j = strtol(at + 1, &at, 10);
        const double value = strtod(at + 1, &at);
        if (i < 0) continue;
        sum[i - 1] += value;
        if (j > 0) f[(i - 1) * n + j - 1] = value;
    }
}

/* 2,000 clumps of three, settled in LIGGGHTS. Estimated errors hold against more lines. */
TEST(settled_clumps) {
    enum { N = 2000 };
    OWNED double *f = calloc(2 * N * N, sizeof *f), *sum = calloc(2 * N, sizeof *sum);
    double square = 0;
    for (int k = 0; k < 2; ++k) {
        const char *path = in_folder("f.csv");
        SUCCEED("factors", CLUMPS, "--clump", "id_multisphere", "--wall", "zmin:at=0", "--directions", k ? "60" : "240",
                "-o", path);
        read_entries(path, N, f + k * N * N, sum + k * N);
        ck_assert(value_of("clumps") == N && value_of("spheres") == 3 * N && value_of("closure_max") < 1e-13 &&
                  value_of("reciprocity_max") < 4e-16);
    }
    for (int i = 0; i < N; ++i) {
        ck_assert_double_eq_tol(sum[i], 1, 1e-13);
        ck_assert(f[i * N + i] > .03 && f[i * N + i] < .045);
        for (int j = 0; j < N; ++j) square += pow(f[i * N + j] - f[N * N + i * N + j], 2) / N;
    }
    const double estimate = value_of("error_rms");
    ck_assert_msg(sqrt(square) < 2 * estimate && sqrt(square) > .2 * estimate, "%g of %g", sqrt(square), estimate);
}

static const char *clumps_of(const char *rows) {
    return write_file("clumps.csv", formatted("id,x,y,z,r,mol\n%s", rows));
}

TEST(names_and_outputs) {
    const char *bed = clumps_of("11,0,0,0,1,4\n12,1,0,0,1,4\n13,0,5,0,1,0\n15,5,5,0,1,2\n16,5,5,1.2,1,2\n");
    SUCCEED("factors", bed, "--clump", "mol", "-o", in_folder("f.csv"));
    const char *csv = read_file(in_folder("f.csv"));
    assert_has(csv, "\n4,4,0.0107708");
    assert_has(csv, "\n13,4,");
    assert_has(csv, "\n2,13,");
    assert_lacks(csv, "\n11,");
    SUCCEED("factors", bed, "--clump", "mol", "-o", in_folder("f.json"), "-o", in_folder("f.npz"), "-o",
            in_folder("f.vtp"), "-o", in_folder("f.mtx"), "--raw", "--method", "cast");
    assert_has(read_file(in_folder("f.json")), "\"id\":[4,13,2]");
    /* a number that is an id as well: clumps have the ids of their first members */
    bed = clumps_of("1,0,0,0,1,3\n2,1,0,0,1,3\n3,0,5,0,1,0\n");
    SUCCEED("factors", bed, "--clump", "mol", "-o", in_folder("f.json"));
    assert_has(read_file(in_folder("f.json")), "\"id\":[1,3]");
}

#define REFUSED(status, words, ...)                                                                                    \
    do {                                                                                                               \
        FAIL_WITH(status, __VA_ARGS__);                                                                                \
        assert_has(said, words);                                                                                       \
    } while (0)

TEST(bad_input) {
    const char *bed = clumps_of("1,0,0,0,1,3\n2,1,0,0,1,3\n3,0,5,0,1,0\n4,0,5.5,0,1,0\n");
    REFUSED(3, "sphere 4 and sphere 3 of line 4: the centre of one lies inside the other", "factors", bed, "--clump",
            "mol");
    REFUSED(3, "mol2", "factors", bed, "--clump", "mol2");
    REFUSED(2, "'3' is not the name of a column", "factors", bed, "--clump", "3");
    REFUSED(3, "clumps.csv:3: sphere 2: the clump is -1;", "factors", clumps_of("1,0,0,0,1,3\n2,5,0,0,1,-1\n"),
            "--clump", "mol");
    REFUSED(3, "clumps.csv:2: sphere 1: the clump is 2.5;", "factors", clumps_of("1,0,0,0,1,2.5\n"), "--clump", "mol");
    bed = clumps_of("1,0,0,0,1,3\n2,1.5,0,0,1,3\n3,3,0,0,1,3\n");
    REFUSED(3, "its clump 3 touches its own image, so the periodic box is too small for it", "factors", bed, "--clump",
            "mol", "--periodic", "4.5,0,0");
    REFUSED(2, "exchange factors of clumps are not computed", "factors", bed, "--clump", "mol", "--emissivity", ".5");
    REFUSED(2, "--targets: rows of clumps", "factors", bed, "--clump", "mol", "--targets", "1");
    REFUSED(2, "--members is of fibrad heat", "factors", bed, "--clump", "mol", "--members");
    SUCCEED("factors", clumps_of("1,0,0,0,1,3\n2,2.1,0,0,1,3\n3,0.2,0,0,.5,3\n"), "--clump", "mol");
    assert_has(said,
               "sphere 2 and sphere 1 of line 2 are of one clump, and its parts do not touch (1 such clumps in all)");
    assert_has(said, "sphere 3 lies within other spheres of its clump (1 such spheres in all), so it has no surface");
    /* LIGGGHTS writes -1 for spheres that are alone */
    const char *lone = write_file("lone.csv", "id,x,y,z,r,id_multisphere\n1,0,0,0,1,1\n2,1,0,0,1,1\n3,0,5,0,1,-1\n");
    SUCCEED("factors", lone, "--clump", "id_multisphere");
    ck_assert(value_of("clumps") == 1);
}
