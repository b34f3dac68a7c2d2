/* test_walls.c - walls of a scene: what a ray meets, rows that close in containers, the option --wall.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>

#include "scene/walls.h"
#include "scenes.h"
#include "suite.h"
#include "bed/wall_option.h"

#define PI 3.14159265358979323846

static double uniform(double low, double high) { return low + (high - low) * (rand() / (RAND_MAX + 1.0)); }

static int init(fibrad_scene **scene, const struct bed *bed, const fibrad_walls *walls, int isa, fibrad_fault *fault) {
    fibrad_scene_config config = {.spheres = bed->n, .isa = isa, .walls = *walls};
    memcpy(config.period, bed->period, sizeof config.period);
    fibrad_spheres spheres = {bed->x, bed->y, bed->z, bed->r, bed->n};
    size_t size = fibrad_scene_size(&config);
    if (size == 0) return FIBRAD_E_ARGUMENT;
    void *block = block_of(size);
    int status = fibrad_scene_init(scene, block, size, &config, &spheres, fault);
    if (status != FIBRAD_OK) free(block);
    return status;
}

static fibrad_scene *scene_in(const struct bed *bed, const fibrad_walls *walls, int isa) {
    fibrad_scene *scene = NULL;
    ck_assert_int_eq(init(&scene, bed, walls, isa, NULL), FIBRAD_OK);
    return scene;
}

static fibrad_row beam(const struct bed *bed, const fibrad_walls *walls, uint32_t i, uint32_t directions,
                       uint32_t points, int isa) {
    fibrad_scene *scene = scene_in(bed, walls, isa);
    fibrad_work *work = work_of(NULL);
    fibrad_row row = row_of(1024);
    fibrad_beam_rule rule = {.directions = directions, .points = points};
    ck_assert_int_eq(fibrad_beam_row(scene, work, i, &rule, &row), FIBRAD_OK);
    free(work);
    free(scene);
    return row;
}

static fibrad_row lone(double x, double y, double z, double r, const fibrad_walls *walls, uint32_t directions) {
    struct bed bed = bed_of(1, (const double[][4]){{x, y, z, r}});
    fibrad_row row = beam(&bed, walls, 0, directions, 0, FIBRAD_ISA_BEST);
    bed_free(&bed);
    return row;
}

static double wall_sum(const fibrad_row *row) {
    double sum = 0;
    for (int k = 0; k < FIBRAD_WALLS; k++) {
        ck_assert(row->wall[k] >= 0);
        sum += row->wall[k];
    }
    return sum;
}

static void assert_closed(const fibrad_row *row) {
    ck_assert_double_eq_tol(row_sum(row) + wall_sum(row) + row->escaped, 1, 2e-15 * (10 + row->length));
}

/* What a sphere sends to a surface that lies wholly on one side of it depends on its centre alone: an element of the
 * surface sees the whole sphere, of which it receives dA cos r^2/d^2; so F is the solid angle over 4 pi. */
static double to_corner(double a, double b, double d) { return atan(a * b / (d * sqrt(a * a + b * b + d * d))); }

static double to_rectangle(double a0, double a1, double b0, double b1, double d) {
    return (to_corner(a1, b1, d) - to_corner(a0, b1, d) - to_corner(a1, b0, d) + to_corner(a0, b0, d)) / (4 * PI);
}

/* A disc of radius R at distance d, its axis at distance s < R: over the azimuths about the foot of the distance, the
 * rim being rho(phi) away; the trapezium rule of a smooth periodic function. */
static double to_disc(double R, double s, double d) {
    double sum = 0;
    for (int k = 0; k < 2000; k++) {
        double phi = 2 * PI * (k + .5) / 2000, rho = s * cos(phi) + sqrt(R * R - s * s * sin(phi) * sin(phi));
        sum += 1 - d / sqrt(d * d + rho * rho);
    }
    return sum / 2000 / 2;
}

static const fibrad_walls box10 = {.planes = 63, .at = {0, 10, 0, 10, 0, 10}};
static const fibrad_walls can10 = {.planes = 48, .at = {0, 0, 0, 0, 0, 10}, .cylinder = {5, 5, 5}};

START_TEST(bad_walls_are_refused) {
    const double spheres[][4] = {{5, 5, 5, 1}, {2, 5, 5, 1}, {5, 5, 9.5, 1}};
    struct bed bed = bed_of(3, spheres);
    fibrad_scene *scene = NULL;
    fibrad_fault fault;
    ck_assert_int_eq(init(&scene, &bed, &box10, 0, &fault), FIBRAD_OK); /* a sphere may reach through a wall */
    free(scene);
    const fibrad_walls bad[] = {{.planes = 64},
                                {.planes = 3, .at = {6, 6}},
                                {.planes = 1, .at = {NAN}},
                                {.planes = 1, .at = {-INFINITY}},
                                {.planes = 1, .at = {-1e200}},
                                {.cylinder = {0, 0, -1}},
                                {.cylinder = {0, 0, NAN}},
                                {.cylinder = {INFINITY, 0, 1}},
                                {.planes = 1, .at = {0}, .cylinder = {5, 5, 9}},
                                {.planes = 8, .at = {0, 0, 0, 10}, .cylinder = {5, 5, 9}}};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++)
        ck_assert_int_eq(init(&scene, &bed, &bad[k], 0, &fault), FIBRAD_E_ARGUMENT);
    const fibrad_walls beyond[] = {{.planes = 1, .at = {3}},
                                   {.planes = 32, .at = {0, 0, 0, 0, 0, 9.25}},
                                   {.cylinder = {5, 5, 2.5}},
                                   {.planes = 16, .at = {[4] = -1e20}}};
    const uint32_t whose[] = {1, 2, 1, 3};
    for (size_t k = 0; k < 4; k++) {
        fault = (fibrad_fault){9, 9};
        ck_assert_int_eq(init(&scene, &bed, &beyond[k], 0, &fault), FIBRAD_E_ARGUMENT);
        ck_assert_uint_eq(fault.first, whose[k]);
    }
    bed.period[0] = 20;
    ck_assert_int_eq(init(&scene, &bed, &box10, 0, &fault), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(init(&scene, &bed, &can10, 0, &fault), FIBRAD_E_ARGUMENT);
    bed_free(&bed);
}
END_TEST

START_TEST(areas_of_walls) {
    struct bed bed = bed_of(1, (const double[][4]){{5, 5, 5, 1}});
    const fibrad_walls walls[] = {{.planes = 63, .at = {0, 10, 1, 10, 3, 10}},
                                  can10,
                                  {.planes = 16},
                                  {.planes = 48, .at = {[5] = 10}},
                                  {.cylinder = {5, 5, 5}}};
    const double inf = INFINITY, area[][FIBRAD_WALLS] = {{63, 63, 70, 70, 90, 90, 0},
                                                         {0, 0, 0, 0, 25 * PI, 25 * PI, 100 * PI},
                                                         {0, 0, 0, 0, inf, 0, 0},
                                                         {0, 0, 0, 0, 12, 12, 0},
                                                         {0, 0, 0, 0, 0, 0, 70 * PI}};
    for (size_t k = 0; k < 5; k++) {
        bed.period[0] = k == 3 ? 3 : 0, bed.period[1] = k == 3 ? 4 : 0, bed.period[2] = k == 4 ? 7 : 0;
        fibrad_scene *scene = scene_in(&bed, &walls[k], 0);
        fibrad_scene_facts facts;
        fibrad_scene_describe(scene, &facts);
        for (int wall = 0; wall < FIBRAD_WALLS; wall++)
            ck_assert(facts.wall_area[wall] == area[k][wall] || fabs(facts.wall_area[wall] - area[k][wall]) < 1e-12);
        free(scene);
    }
    bed_free(&bed);
}
END_TEST

/* How far a place lies within a wall. */
static double within(const fibrad_walls *walls, uint32_t wall, const double at[3]) {
    if (wall == 6) return walls->cylinder[2] - hypot(at[0] - walls->cylinder[0], at[1] - walls->cylinder[1]);
    return wall % 2 ? walls->at[wall] - at[wall / 2] : at[wall / 2] - walls->at[wall];
}

static bool has(const fibrad_walls *walls, uint32_t wall) {
    return wall == 6 ? walls->cylinder[2] > 0 : walls->planes >> wall & 1;
}

static void assert_exit(const fibrad_scene *scene, const fibrad_walls *walls, const double o[3], const double w[3],
                        uint32_t from) {
    double distance, at[3], normal[3], middle[3];
    uint32_t wall = fibrad_walls_exit(scene, o, w, &distance);
    ck_assert(wall != from);
    for (uint32_t k = 0; k < FIBRAD_WALLS && wall == FIBRAD_NONE; k++) /* then no wall lies ahead */
        if (has(walls, k))
            for (double far = 1; far < 1e9; far *= 1e3)
                ck_assert(within(walls, k, (double[]){o[0] + far * w[0], o[1] + far * w[1], o[2] + far * w[2]}) > 0);
    if (wall == FIBRAD_NONE) {
        ck_assert(distance == INFINITY);
        return;
    }
    for (int axis = 0; axis < 3; axis++) {
        at[axis] = o[axis] + distance * w[axis];
        middle[axis] = o[axis] + .5 * distance * w[axis];
    }
    ck_assert(has(walls, wall) && distance > 0);
    ck_assert_double_eq_tol(within(walls, wall, at), 0, 1e-11);
    for (uint32_t k = 0; k < FIBRAD_WALLS; k++)
        if (has(walls, k)) ck_assert(within(walls, k, at) > -1e-11 && within(walls, k, middle) > -1e-11);
    fibrad_wall_normal(scene, wall, at, normal);
    ck_assert_double_eq_tol(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2], 1, 1e-14);
    ck_assert(normal[0] * w[0] + normal[1] * w[1] + normal[2] * w[2] < 1e-9);
    double inside[3] = {at[0] + .01 * normal[0], at[1] + .01 * normal[1], at[2] + .01 * normal[2]};
    ck_assert_double_eq_tol(within(walls, wall, inside), .01, 1e-11);
}

/* On from the wall it met, a ray comes to another one, or to the same cylinder farther on, and back outwards it is at
 * once at the same; also where rounding or more has put the place beyond the wall. */
START_TEST(a_ray_leaves_through_the_first_wall) {
    const fibrad_walls walls[] = {box10,
                                  can10,
                                  {.planes = 1},
                                  {.planes = 48, .at = {[5] = 10}},
                                  {.cylinder = {5, 5, 5}},
                                  {.planes = 37, .at = {[5] = 10}}};
    struct bed bed = bed_of(1, (const double[][4]){{5, 5, 5, 1}});
    srand(1);
    for (size_t k = 0; k < sizeof walls / sizeof *walls; k++) {
        fibrad_scene *scene = scene_in(&bed, &walls[k], 0);
        for (int ray = 0; ray < 20000; ray++) {
            double o[3], w[3], distance, normal[3], on[3];
            for (int axis = 0; axis < 3; axis++) o[axis] = uniform(1.5, 8.5), w[axis] = uniform(-1, 1);
            if (ray % 4 == 1) w[ray / 4 % 3] = 0;
            if (ray % 4 == 2) w[ray / 4 % 3] = 0, w[(ray / 4 + 1) % 3] = 0;
            assert_exit(scene, &walls[k], o, w, FIBRAD_NONE - 1);
            uint32_t wall = fibrad_walls_exit(scene, o, w, &distance);
            if (wall == FIBRAD_NONE) continue;
            for (int axis = 0; axis < 3; axis++) on[axis] = o[axis] + distance * w[axis];
            fibrad_wall_normal(scene, wall, on, normal);
            double beyond = ray % 3 == 0 ? 0 : ray % 3 == 1 ? 1e-12 : 1e-3, lean = 0;
            for (int axis = 0; axis < 3; axis++) on[axis] -= beyond * normal[axis], w[axis] = uniform(-1, 1);
            for (int axis = 0; axis < 3; axis++) lean += w[axis] * normal[axis];
            if (fabs(lean) < .2) continue;
            for (int axis = 0; axis < 3 && lean > 0; axis++) w[axis] = -w[axis]; /* outwards */
            bool corner = false; /* beyond several walls at once: any of them will do */
            for (uint32_t other = 0; other < FIBRAD_WALLS; other++)
                corner |= other != wall && has(&walls[k], other) && within(&walls[k], other, on) < .05;
            if (corner) continue;
            ck_assert_uint_eq(fibrad_walls_exit(scene, on, w, &distance), wall);
            ck_assert_double_le(distance, 1e-12);
            for (int axis = 0; axis < 3; axis++) w[axis] = -w[axis]; /* inwards */
            assert_exit(scene, &walls[k], on, w, wall == 6 ? FIBRAD_NONE - 1 : wall);
        }
        free(scene);
    }
    bed_free(&bed);
}
END_TEST

/* Across z the directions pair off, and the one between them shares itself out. */
START_TEST(half_of_a_sphere_sees_a_plane) {
    const uint32_t directions[] = {8, 9, 100, 101, 233, 987, 1000};
    for (size_t k = 0; k < sizeof directions / sizeof *directions; k++)
        for (uint32_t wall = 0; wall < 6; wall++) {
            const fibrad_walls plane = {.planes = 1u << wall, .at = {-1, 1, -1, 1, -1, 1}};
            fibrad_row row = lone(0, 0, 0, 1, &plane, directions[k]);
            double tolerance = wall >= 4 ? 1e-14 : .4 / directions[k];
            ck_assert_double_eq_tol(row.wall[wall], .5, tolerance);
            ck_assert_double_eq_tol(row.escaped, .5, tolerance);
            assert_closed(&row);
            row_free(&row);
        }
    const fibrad_walls slit = {.planes = 48, .at = {[4] = -1.5, [5] = 40}};
    fibrad_row row = lone(0, 0, 0, 2, &slit, 101); /* half a radius beyond one of them */
    ck_assert_double_eq_tol(row.wall[4], .5, 1e-14);
    ck_assert_double_eq_tol(row.wall[5], .5, 1e-14);
    ck_assert(row.escaped == 0);
    row_free(&row);
}
END_TEST

/* In boxes of 2.5 to 1000 radii. */
START_TEST(sphere_in_a_box) {
    srand(2);
    double square[3] = {0, 0, 0}, bound[3] = {8e-4, 3e-4, 1.2e-4};
    const uint32_t directions[3] = {233, 987, 4000};
    for (int k = 0; k < 3; k++)
        for (int t = 0; t < 40; t++) {
            double side[3], c[3], r = uniform(.5, 2);
            fibrad_walls box = {.planes = 63};
            for (int axis = 0; axis < 3; axis++) {
                side[axis] = r * 2.5 * pow(400, t / 39.) * uniform(1, 2);
                box.at[2 * axis] = uniform(-9, 9);
                box.at[2 * axis + 1] = box.at[2 * axis] + side[axis];
                c[axis] = uniform(r, side[axis] - r);
            }
            fibrad_row row = lone(box.at[0] + c[0], box.at[2] + c[1], box.at[4] + c[2], r, &box, directions[k]);
            for (uint32_t wall = 0; wall < 6; wall++) {
                uint32_t a = wall / 2, b = (a + 1) % 3, d = (a + 2) % 3;
                double away = wall % 2 ? side[a] - c[a] : c[a];
                double exact = to_rectangle(-c[b], side[b] - c[b], -c[d], side[d] - c[d], away);
                square[k] += (row.wall[wall] - exact) * (row.wall[wall] - exact) / (40 * 6);
            }
            ck_assert(row.escaped == 0);
            assert_closed(&row);
            row_free(&row);
        }
    for (int k = 0; k < 3; k++) ck_assert_msg(sqrt(square[k]) < bound[k], "%g at %u", sqrt(square[k]), directions[k]);
}
END_TEST

START_TEST(sphere_in_a_cylinder) {
    srand(3);
    for (int t = 0; t < 40; t++) {
        double R = 1.5 * pow(200, t / 39.), h = R * uniform(.8, 3) + 2, z = uniform(1, h - 1), s = uniform(0, R - 1);
        double phi = uniform(0, 2 * PI), bottom = to_disc(R, s, z), top = to_disc(R, s, h - z);
        for (uint32_t kind = 0; kind < 3; kind++) { /* closed, open above, open */
            fibrad_walls can = {.planes = kind == 0 ? 48 : kind == 1 ? 16 : 0, .at = {[4] = 2, [5] = 2 + h}};
            can.cylinder[0] = 3, can.cylinder[1] = -4, can.cylinder[2] = R;
            fibrad_row row = lone(3 + s * cos(phi), -4 + s * sin(phi), 2 + z, 1, &can, 987);
            double low = row.wall[4], high = kind == 0 ? row.wall[5] : row.escaped;
            if (kind < 2) {
                ck_assert_double_eq_tol(low, bottom, 1.5e-3);
                ck_assert_double_eq_tol(high, kind == 0 ? top : 0, 1.5e-3);
            }
            ck_assert_double_eq_tol(row.wall[6], 1 - (kind < 2 ? bottom : 0) - (kind < 1 ? top : 0), 3e-3);
            assert_closed(&row);
            row_free(&row);
        }
    }
}
END_TEST

/* Within the walls of a container, slit or cylinder spheres see each other as without, and the walls get the rest. */
START_TEST(walls_take_what_escapes) {
    struct bed bed = packing(150, .8, 1.2, .4, 1, false);
    double low[3] = {1e9, 1e9, 1e9}, high[3] = {-1e9, -1e9, -1e9};
    for (uint32_t i = 0; i < bed.n; i++)
        for (int axis = 0; axis < 3; axis++) {
            double c = axis == 0 ? bed.x[i] : axis == 1 ? bed.y[i] : bed.z[i];
            low[axis] = fmin(low[axis], c - .5), high[axis] = fmax(high[axis], c + bed.r[i]);
        }
    fibrad_walls walls[4] = {{.planes = 63}, {.planes = 48}, {.planes = 48}, {.planes = 29 /* two sides missing */}};
    for (int k = 0; k < 4; k++)
        for (int axis = 0; axis < 3; axis++) walls[k].at[2 * axis] = low[axis], walls[k].at[2 * axis + 1] = high[axis];
    walls[2].cylinder[0] = (low[0] + high[0]) / 2, walls[2].cylinder[1] = (low[1] + high[1]) / 2;
    walls[2].cylinder[2] = hypot(high[0] - low[0], high[1] - low[1]) / 2;
    fibrad_work *work = work_of(NULL);
    fibrad_row rays = row_of(1024);
    double worst = 0;
    for (int k = 0; k < 4; k++) {
        fibrad_scene *scene = scene_in(&bed, &walls[k], 0);
        for (uint32_t i = 0; i < bed.n; i += 11)
            for (uint32_t points = 0; points <= 256; points += 128) {
                fibrad_row free_row = beam(&bed, &(fibrad_walls){0}, i, 610, points, 0);
                fibrad_row row = beam(&bed, &walls[k], i, 610, points, 0);
                ck_assert_uint_eq(row.length, free_row.length);
                ck_assert_mem_eq(row.f, free_row.f, row.length * sizeof *row.f);
                ck_assert_double_eq_tol(wall_sum(&row) + row.escaped, free_row.escaped, 1e-14);
                if (k != 3) ck_assert_int_eq(row.escaped == 0, k == 0 || k == 2 || wall_sum(&row) > 0);
                assert_closed(&row);
                fibrad_cast_rule rule = {.rays = 50000};
                ck_assert_int_eq(fibrad_cast_row(scene, work, i, &rule, &rays, NULL), FIBRAD_OK);
                assert_closed(&rays);
                for (int wall = 0; wall < FIBRAD_WALLS; wall++)
                    worst = fmax(worst, fabs(rays.wall[wall] - row.wall[wall]));
                worst = fmax(worst, fabs(rays.escaped - row.escaped));
                row_free(&row);
                row_free(&free_row);
            }
        free(scene);
    }
    ck_assert_msg(worst < 5e-3, "beams and rays differ by %g", worst);
    row_free(&rays);
    free(work);
    bed_free(&bed);
}
END_TEST

/* Walls on the open axis of a periodic bed. */
START_TEST(walls_of_a_periodic_bed) {
    struct bed bed = packing(120, 1, 1, .3, 2, true);
    bed.period[2] = 0;
    double low = 1e9, high = -1e9;
    for (uint32_t i = 0; i < bed.n; i++) low = fmin(low, bed.z[i] - 1), high = fmax(high, bed.z[i] + 1);
    const fibrad_walls slit = {.planes = 48, .at = {[4] = low, [5] = high}};
    fibrad_scene *scene = scene_in(&bed, &slit, 0);
    fibrad_work *work = work_of(NULL);
    fibrad_row rays = row_of(1024);
    for (uint32_t i = 0; i < bed.n; i += 17) {
        fibrad_row row = beam(&bed, &slit, i, 987, 0, 0);
        fibrad_cast_rule rule = {.rays = 50000};
        ck_assert_int_eq(fibrad_cast_row(scene, work, i, &rule, &rays, NULL), FIBRAD_OK);
        ck_assert(row.escaped == 0 && rays.escaped == 0);
        assert_closed(&row);
        for (int wall = 4; wall < 6; wall++) ck_assert_double_eq_tol(row.wall[wall], rays.wall[wall], 3e-3);
        row_free(&row);
    }
    row_free(&rays);
    free(work);
    free(scene);
    bed_free(&bed);
}
END_TEST

START_TEST(same_bits_in_every_instruction_set) {
    struct bed bed = packing(60, .6, 1.4, .3, 3, false);
    fibrad_walls walls[2] = {{.planes = 63, .at = {-3, 40, -3, 40, -3, 40}}, {.planes = 16, .at = {[4] = -3}}};
    walls[1].cylinder[0] = walls[1].cylinder[1] = 5, walls[1].cylinder[2] = 30;
    for (int k = 0; k < 2; k++)
        for (uint32_t points = 0; points <= 256; points += 64) {
            if (points == 192) continue;
            for (uint32_t i = 0; i < bed.n; i += 13) {
                fibrad_row scalar = beam(&bed, &walls[k], i, 101, points, FIBRAD_ISA_SCALAR);
                for (int isa = FIBRAD_ISA_SSE2; isa <= (int)fibrad_isa_best(); isa++) {
                    fibrad_row row = beam(&bed, &walls[k], i, 101, points, isa);
                    ck_assert_msg(same_bits(&scalar, &row), "row %u differs in %s", i, fibrad_isa_name(isa));
                    ck_assert_mem_eq(row.wall, scalar.wall, sizeof row.wall);
                    row_free(&row);
                }
                row_free(&scalar);
            }
        }
    for (int isa = FIBRAD_ISA_AVX512; isa > (int)fibrad_isa_best(); isa--) printf("SKIP %s\n", fibrad_isa_name(isa));
    bed_free(&bed);
}
END_TEST

/* Another order of the spheres and another unit of length change nothing but rounding; other axes no more than the
 * rule's error. */
START_TEST(order_scale_and_axes) {
    const fibrad_walls box = {.planes = 63, .at = {-2, 14, -3, 16, -4, 15}};
    struct bed bed = packing(50, .8, 1.2, .2, 4, false), other, turned;
    bed_init(&other, false, 0);
    bed_init(&turned, false, 0);
    fibrad_walls scaled = box, cyclic = box;
    for (int k = 0; k < 6; k++) scaled.at[k] *= 4, cyclic.at[(k + 2) % 6] = box.at[k];
    for (uint32_t i = 0; i < bed.n; i++) {
        uint32_t j = bed.n - 1 - i;
        add_sphere(&other, 4 * bed.x[j], 4 * bed.y[j], 4 * bed.z[j], 4 * bed.r[j]);
        add_sphere(&turned, bed.z[i], bed.x[i], bed.y[i], bed.r[i]);
    }
    for (uint32_t i = 0; i < bed.n; i += 7) {
        fibrad_row row = beam(&bed, &box, i, 987, 0, 0), again = beam(&other, &scaled, bed.n - 1 - i, 987, 0, 0);
        fibrad_row round = beam(&turned, &cyclic, i, 987, 0, 0);
        for (int wall = 0; wall < 6; wall++) {
            ck_assert_double_eq_tol(row.wall[wall], again.wall[wall], 1e-12);
            ck_assert_double_eq_tol(row.wall[wall], round.wall[(wall + 2) % 6], 2e-3);
        }
        row_free(&row);
        row_free(&again);
        row_free(&round);
    }
    bed_free(&bed);
    bed_free(&other);
    bed_free(&turned);
}
END_TEST

/* Averaged rows close too, whatever the method's error. */
START_TEST(closing_rows) {
    uint64_t start[] = {0, 1, 3, 4};
    uint32_t col[] = {1, 0, 2, 1};
    double f[] = {.5, .4, .35, .9}, r[] = {1, 1, 2}, escaped[] = {.1, 0, 0};
    double wall[3][FIBRAD_WALLS] = {{.2, .1}, {0}, {[6] = .2}};
    const fibrad_rows rows = {3, 4, start, col, f};
    ck_assert_int_eq(fibrad_rows_close(&rows, r, wall, escaped), FIBRAD_OK);
    ck_assert_double_eq_tol(wall[0][0], .25, 1e-15);
    ck_assert_double_eq_tol(wall[0][1], .125, 1e-15);
    ck_assert_double_eq_tol(escaped[0], .125, 1e-15);
    ck_assert_double_eq_tol(wall[2][6], .1, 1e-15);
    ck_assert(escaped[2] == 0);
    /* the sphere that met nothing outside: .2, .1 and .1 from sphere 0, 4 x .2 from sphere 2, of 1.2 in all */
    ck_assert_double_eq_tol(wall[1][0], .25 * .2 / 1.2, 1e-15);
    ck_assert_double_eq_tol(wall[1][6], .25 * .8 / 1.2, 1e-15);
    ck_assert_double_eq_tol(escaped[1], .25 * .1 / 1.2, 1e-15);
    double none[3][FIBRAD_WALLS] = {{0}}, nothing[3] = {0};
    ck_assert_int_eq(fibrad_rows_close(&rows, r, none, nothing), FIBRAD_OK);
    ck_assert_double_eq_tol(nothing[0], .5, 1e-15);
    ck_assert_int_eq(fibrad_rows_close(&rows, r, NULL, nothing), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_rows_close(&rows, r, none, NULL), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_rows_close(&rows, NULL, none, nothing), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_rows_close(NULL, r, none, nothing), FIBRAD_E_ARGUMENT);
}
END_TEST

static const char *const misspelt[] = {
    "",      "wall",      "zmin,",     "zmin=",           "zmin=a",           "zmin:3",          "zmin,zmin",
    ",zmin", "cylinder",  "cylinder:", "cylinder:1,2",    "cylinder:1,2,0",   "cylinder:1,2,-1", "zmax=inf",
    "autos", "zmin zmax", "box=3",     "cylinder:1,2,3,", "cylinder:1,2,3 4", "cylinder:1;2,3",  "zmin=1=2"};

START_TEST(misspelt_option) {
    struct wall_options options = {0};
    ck_assert_int_eq(walls_option(misspelt[_i], &options), 2);
}
END_TEST

START_TEST(option_places_walls) {
    struct bed bed = bed_of(2, (const double[][4]){{1, 2, 3, 1}, {4, 6, 8, 2}});
    struct wall_options options = {0}, box = {0}, automatic = {0}, clash = {0}, beyond = {0}, mixed = {0};
    fibrad_walls walls;
    struct wall_order order;
    ck_assert_int_eq(walls_option("zmax,cylinder:2.5,4,30,zmin=-4", &options), 0);
    ck_assert_int_eq(walls_of(&options, &bed, "bed", &walls, &order), 0);
    ck_assert_uint_eq(order.count, 3);
    ck_assert(order.wall[0] == 5 && order.wall[1] == 6 && order.wall[2] == 4);
    ck_assert_uint_eq(walls.planes, 48);
    ck_assert(walls.at[4] == -4 && walls.at[5] == 10);
    ck_assert(walls.cylinder[0] == 2.5 && walls.cylinder[1] == 4 && walls.cylinder[2] == 30);
    ck_assert_int_eq(walls_option("xmin", &options), 0); /* a second option adds to the first */
    ck_assert_int_eq(walls_of(&options, &bed, "bed", &walls, &order), 2);

    const double ends[6] = {0, 6, 1, 8, 2, 10}, file[6] = {-1, 7, -2, 9, -3, 12};
    ck_assert_int_eq(walls_option("box", &box), 0);
    ck_assert_int_eq(walls_of(&box, &bed, "bed", &walls, &order), 0);
    ck_assert_uint_eq(walls.planes, 63);
    for (uint32_t k = 0; k < 6; k++) ck_assert(walls.at[k] == ends[k] && order.wall[k] == k);
    ck_assert_int_eq(walls_option("auto", &automatic), 0);
    ck_assert_int_eq(walls_of(&automatic, &bed, "bed", &walls, &order), 2);
    for (int axis = 0; axis < 3; axis++) bed.low[axis] = file[2 * axis], bed.high[axis] = file[2 * axis + 1];
    ck_assert_int_eq(walls_of(&automatic, &bed, "bed", &walls, &order), 0);
    for (int k = 0; k < 6; k++) ck_assert(walls.at[k] == file[k]);
    ck_assert_int_eq(walls_option("box,ymax=9.5,auto", &mixed), 0);
    ck_assert_int_eq(walls_of(&mixed, &bed, "bed", &walls, &order), 0);
    ck_assert(walls.planes == 63 && walls.at[3] == 9.5 && walls.at[2] == -2);
    ck_assert(order.count == 6 && order.wall[0] == 3 && order.wall[1] == 0 && order.wall[3] == 2 && order.wall[4] == 4);
    bed.period[0] = 8;
    ck_assert_int_eq(walls_of(&automatic, &bed, "bed", &walls, &order), 0);
    ck_assert(walls.planes == 60 && order.count == 4 && order.wall[0] == 2);
    ck_assert_int_eq(walls_of(&box, &bed, "bed", &walls, &order), 2);
    ck_assert_int_eq(walls_option("zmin=9,zmax=8", &clash), 0);
    ck_assert_int_eq(walls_of(&clash, &bed, "bed", &walls, &order), 2);
    ck_assert_int_eq(walls_option("zmin=4", &beyond), 0);
    ck_assert_int_eq(walls_of(&beyond, &bed, "bed", &walls, &order), 3);
    ck_assert_int_eq(walls_of(&(struct wall_options){0}, &bed, "bed", &walls, &order), 0);
    ck_assert_uint_eq(order.count, 0);
    bed_free(&bed);
}
END_TEST

int main(void) {
    Suite *suite = suite_create("walls");
    TCase *tests = suite_case(suite, "walls");
    tcase_add_test(tests, bad_walls_are_refused);
    tcase_add_test(tests, areas_of_walls);
    tcase_add_test(tests, a_ray_leaves_through_the_first_wall);
    tcase_add_test(tests, half_of_a_sphere_sees_a_plane);
    tcase_add_test(tests, sphere_in_a_box);
    tcase_add_test(tests, sphere_in_a_cylinder);
    tcase_add_test(tests, walls_take_what_escapes);
    tcase_add_test(tests, walls_of_a_periodic_bed);
    tcase_add_test(tests, same_bits_in_every_instruction_set);
    tcase_add_test(tests, order_scale_and_axes);
    tcase_add_test(tests, closing_rows);
    tcase_add_loop_test(tests, misspelt_option, 0, (int)(sizeof misspelt / sizeof *misspelt));
    tcase_add_test(tests, option_places_walls);
    return suite_run(suite);
}
