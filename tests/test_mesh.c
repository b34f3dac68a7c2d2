/* test_mesh.c - triangles in a scene: closed forms, planes and cylinders made of triangles, closure, random triangles.
 * SPDX-License-Identifier: MIT */
#include "base/random.h"
#include "grey_rules.h"
#include "scenes.h"
#include "meshes.h"
#include "sample/direction.h"
#include "suite.h"

static double uniform(double low, double high) { return low + (high - low) * (rand() / (RAND_MAX + 1.0)); }

static fibrad_scene *scene_of_mesh(const struct bed *bed, const struct mesh *mesh, uint32_t walls) {
    return scene_with(bed, &(fibrad_scene_config){.wall = mesh->wall, .walls = walls, .triangles = &mesh->triangles});
}

/* The sum of a row with its walls. */
static double total_of(const fibrad_row *row, uint32_t walls) {
    double sum = row_sum(row) + row->escaped + row->beyond;
    for (uint32_t b = 0; b < walls; b++) sum += row->wall[b];
    return sum;
}

/* ---- closed forms ------------------------------------------------------------------------------------------------ */

/* The solid angle of a triangle from the origin. Source: A. van Oosterom, J. Strackee, IEEE Trans. Biomed. Eng. 30
 * (1983) 125. */
static double solid_angle(double v[3][3]) {
    double r[3], dot[3], n[3];
    for (int k = 0; k < 3; k++) {
        const double *a = v[k], *b = v[(k + 1) % 3];
        r[k] = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
        dot[k] = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    }
    for (int a = 0; a < 3; a++) n[a] = v[1][(a + 1) % 3] * v[2][(a + 2) % 3] - v[1][(a + 2) % 3] * v[2][(a + 1) % 3];
    const double volume = v[0][0] * n[0] + v[0][1] * n[1] + v[0][2] * n[2];
    return 2 * fabs(atan2(volume, r[0] * r[1] * r[2] + dot[0] * r[2] + dot[1] * r[0] + dot[2] * r[1]));
}

/* The mean over turned rows is the solid angle of a square over 4 pi, above its middle and near its edge. */
LOOP_TEST(a_square_below_turned_directions, 2) {
    enum { TURNS = 2000 };
    OWNED_BED bed = BED({_i ? 10 : 0, 0, 6, 1});
    OWNED struct mesh *mesh = mesh_new();
    const double corner[4][2] = {{-12, -12}, {12, -12}, {12, 12}, {-12, 12}};
    double v[4][3], mean = 0, square = 0;
    for (int k = 0; k < 4; k++) {
        mesh_vertex(mesh, corner[k][0], corner[k][1], 0);
        v[k][0] = corner[k][0] - bed.x[0], v[k][1] = corner[k][1], v[k][2] = -6;
    }
    mesh_triangle(mesh, 0, 1, 2, 0, 0);
    mesh_triangle(mesh, 0, 2, 3, 0, 0);
    double half[3][3];
    memcpy(half[0], v[0], sizeof half[0]), memcpy(half[1], v[2], 2 * sizeof half[0]);
    const double exact = (solid_angle(v) + solid_angle(half)) / (4 * PI);
    OWNED fibrad_scene *scene = scene_of_mesh(&bed, mesh, 1);
    OWNED_WORK work = work_growing();
    OWNED_ROW row = row_of(1);
    for (uint64_t turn = 1; turn <= TURNS; turn++) {
        const fibrad_beam_rule rule = {.directions = 144, .points = 256, .turn = turn};
        assert_ok(fibrad_beam_row(scene, &work, 0, &rule, &row));
        mean += row.wall[0] / TURNS, square += pow(row.wall[0] - exact, 2) / TURNS;
    }
    ck_assert_double_eq_tol(mean, exact, 3.5 * sqrt(square / TURNS) + 1e-5);
}

/* A unit quaternion gives a rotation. For a uniform quaternion take a uniform point of the unit ball in four
 * dimensions and divide it by its distance from the centre. Rejection finds such a point in three draws on average.
 * Points near the centre are rejected too, since they have few digits. */
static void random_rotation(uint64_t seed, double rotation[9]) {
    fibrad_random random = fibrad_random_start(seed, 0);
    double q[4], square;
    do {
        square = 0;
        for (int k = 0; k < 4; k++) {
            q[k] = 2 * fibrad_random_next(&random) - 1;
            square += q[k] * q[k];
        }
    } while (!(square <= 1 && square > 1e-4));
    const double s = 2 / square, a = q[0], b = q[1], c = q[2], d = q[3];
    const double by_row[9] = {1 - s * (c * c + d * d), s * (b * c - a * d),     s * (b * d + a * c),
                              s * (b * c + a * d),     1 - s * (b * b + d * d), s * (c * d - a * b),
                              s * (b * d - a * c),     s * (c * d + a * b),     1 - s * (b * b + c * c)};
    memcpy(rotation, by_row, sizeof by_row);
}

/* The plane of a triangle does not cut the sphere. So F is the solid angle of the triangle over 4 pi. */
TEST(a_sphere_and_a_triangle) {
    double square = 0, worst[3] = {0};
    OWNED_BED bed = BED({0, 0, 0, 1});
    enum { CASES = 60 };
    srand(7);
    for (int c = 0; c < CASES; c++) {
        OWNED struct mesh *mesh = mesh_new();
        const double away = exp(uniform(log(1.05), log(30))), size = exp(uniform(log(.3), log(30)));
        double rotation[9], v[3][3];
        random_rotation((uint64_t)c + 1, rotation);
        for (int k = 0; k < 3; k++) {
            v[k][0] = uniform(-size, size), v[k][1] = uniform(-size, size), v[k][2] = away;
            turn_point(rotation, v[k]);
            mesh_vertex(mesh, v[k][0], v[k][1], v[k][2]);
        }
        mesh_triangle(mesh, 0, 1, 2, 0, 0);
        OWNED fibrad_scene *scene = scene_of_mesh(&bed, mesh, 1);
        OWNED_WORK work = work_growing();
        OWNED_ROW row = row_of(1);
        const double exact = solid_angle(v) / (4 * PI);
        const fibrad_beam_rule rules[3] = {
            {.directions = 233}, {.directions = 233, .points = 128}, {.directions = 2000}};
        for (int rule = 0; rule < 3; rule++) {
            assert_ok(fibrad_beam_row(scene, &work, 0, &rules[rule], &row));
            ck_assert_double_eq_tol(total_of(&row, 1), 1, 1e-12);
            const double error = fabs(row.wall[0] - exact);
            worst_of(&worst[rule], error);
            if (rule == 0) square += error * error;
        }
        assert_ok(fibrad_cast_row(scene, &work, 0, &(fibrad_cast_rule){.rays = 100000}, &row, NULL));
        ck_assert_double_eq_tol(row.wall[0], exact, 2e-3);
        const double whole = 4 * PI * exact / fibrad_scene_wall_area(scene, 0); /* the mean of both sides */
        fibrad_side_view view[2];
        uint32_t triangle = 7;
        assert_ok(fibrad_triangle_views(scene, 0, 1 << 16, &triangle, view));
        ck_assert_uint_eq(triangle, 0);
        ck_assert(view[0].spheres * view[1].spheres == 0 && view[0].walls + view[1].walls == 0);
        ck_assert_double_eq_tol((view[0].spheres + view[1].spheres) / 2, whole, 1e-3);
        for (int side = 0; side < 2; side++) ck_assert_double_eq(view[side].spheres + view[side].escaped, 1);
    }
    printf("    triangles: rms %.2g, worst %.2g, points %.2g, 2000 directions %.2g\n", sqrt(square / CASES), worst[0],
           worst[1], worst[2]);
    ck_assert_double_le(sqrt(square / CASES), 1e-3);
    ck_assert_double_le(worst[0], 4e-3);
    ck_assert_double_le(worst[2], 4e-4);
}

/* Spheres behind a large screen are too small for points of the window. What the sphere sees of them goes to the
 * screen. */
TEST(small_spheres_behind) {
    OWNED_BED bed = BED({0, 0, 0, 1});
    OWNED struct mesh *mesh = mesh_new();
    uint32_t v[4];
    srand(5);
    for (int k = 0; k < 300; k++) add_sphere(&bed, uniform(-3, 3), uniform(-3, 3), uniform(1.2, 3), uniform(.01, .05));
    for (int k = 0; k < 4; k++) v[k] = mesh_vertex(mesh, k == 1 || k == 2 ? 500 : -500, k > 1 ? 500 : -500, 1.02);
    mesh_quad(mesh, v, 0, 0);
    OWNED fibrad_scene *scene = scene_of_mesh(&bed, mesh, 1);
    OWNED_WORK work = work_growing();
    OWNED_ROW row = row_of(bed.n);
    assert_ok(fibrad_beam_row(scene, &work, 0, &(fibrad_beam_rule){.directions = 600}, &row));
    const double screen = .5 - 4 * sqrt(2) * 1.02 / 500 / (4 * PI); /* it ends a little above the horizon */
    printf("    behind: %.2g is seen, the screen errs by %.2g\n", row_sum(&row), row.wall[0] - screen);
    ck_assert_double_eq_tol(row.wall[0], screen, 1e-3);
    ck_assert_double_le(row_sum(&row), 1e-5);
    ck_assert_double_eq_tol(total_of(&row, 1), 1, 1e-12);
}

/* ---- containers -------------------------------------------------------------------------------------------------- */

static struct bed crowd(uint32_t n, uint64_t seed) {
    struct bed bed = bed_empty();
    for (uint64_t at = 0; bed.n < n && at < 4000 * (uint64_t)n; at += 4) {
        double c[3], r = .05 + .07 * bed_make_random(seed, at);
        bool fits = true;
        for (uint64_t axis = 0; axis < 3; axis++)
            c[axis] = .98 * r + (1 - 1.96 * r) * bed_make_random(seed, at + 1 + axis);
        for (uint32_t j = 0; j < bed.n && fits; j++)
            fits = hypot(hypot(c[0] - bed.x[j], c[1] - bed.y[j]), c[2] - bed.z[j]) > r + bed.r[j];
        if (fits) add_sphere(&bed, c[0], c[1], c[2], r);
    }
    return bed;
}

/* A box of twelve triangles gives what a box of planes gives. It cuts spheres by 2 %. */
TEST(a_box_of_triangles) {
    static const double low[3] = {0, 0, 0}, high[3] = {1, 1, 1};
    OWNED_BED bed = crowd(60, 3);
    OWNED struct mesh *mesh = mesh_new();
    fibrad_wall plane[6];
    mesh_box(mesh, low, high, 0);
    for (int k = 0; k < 6; k++) plane[k] = plane_at(k / 2, k % 2, k % 2);
    OWNED fibrad_scene *scene = scene_of_mesh(&bed, mesh, 6),
                       *other = scene_with(&bed, &(fibrad_scene_config){.wall = plane, .walls = 6});
    OWNED_WORK work = work_growing();
    OWNED_ROW row = row_of(bed.n), of_planes = row_of(bed.n);
    double spheres = 0, walls = 0, estimate = 0;
    for (int k = 0; k < 6; k++) ck_assert_double_eq_tol(fibrad_scene_wall_area(scene, (uint32_t)k), 1, 1e-15);
    /* this work memory was laid out without triangles, and is laid out anew */
    assert_ok(fibrad_beam_row(other, &work, 0, NULL, &of_planes));
    for (uint32_t points = 0; points <= 256; points += 256)
        for (uint32_t i = 0; i < bed.n; i++) {
            const fibrad_beam_rule rule = {.directions = 600, .points = points};
            assert_ok(fibrad_beam_row(scene, &work, i, &rule, &row));
            assert_ok(fibrad_beam_row(other, &work, i, &rule, &of_planes));
            ck_assert_double_eq_tol(total_of(&row, 6), 1, 1e-12);
            ck_assert(row.escaped == 0 && row.beyond == 0);
            const double distance = row_distance(&row, &of_planes);
            spheres += distance * distance / bed.n;
            estimate += row.error * row.error / bed.n;
            for (int k = 0; k < 6; k++) walls += pow(row.wall[k] - of_planes.wall[k], 2) / bed.n;
        }
    printf("    box: spheres differ by %.2g, walls by %.2g, estimate %.2g\n", sqrt(spheres), sqrt(walls),
           sqrt(estimate));
    ck_assert_double_le(sqrt(spheres), 5e-4);
    ck_assert_double_le(sqrt(walls), 1.2e-3);
}

/* A tube of facets with two lids is nearly a cylinder with two planes, along x as along z. */
TEST(a_drum) {
    OWNED_BED bed = bed_empty();
    srand(11);
    while (bed.n < 40) {
        const double r = uniform(.06, .12), angle = uniform(0, 2 * PI), away = sqrt(uniform(0, 1)) * (.5 - r);
        const double c[3] = {away * cos(angle), away * sin(angle), uniform(r, 1 - r)};
        bool fits = true;
        for (uint32_t j = 0; j < bed.n; j++)
            fits = fits && hypot(hypot(c[0] - bed.x[j], c[1] - bed.y[j]), c[2] - bed.z[j]) > r + bed.r[j];
        if (fits) add_sphere(&bed, c[0], c[1], c[2], r);
    }
    static const double turn[3][9] = {
        {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 1, 1, 0, 0, 0, 1, 0}, {.6, -.8, 0, .8, .6, 0, 0, 0, 1}};
    const fibrad_wall round[3] = {cylinder_at(0, 0, .5), plane_at(2, 0, 0), plane_at(2, 1, 1)};
    OWNED fibrad_scene *scene = scene_with(&bed, &(fibrad_scene_config){.wall = round, .walls = 3});
    OWNED_WORK work = work_growing();
    OWNED_ROW row = row_of(bed.n), exact = row_of(bed.n);
    for (int t = 0; t < 3; t++) {
        OWNED struct mesh *mesh = mesh_new();
        OWNED_BED turned = bed_empty();
        enum { FACETS = 200 };
        double square = 0;
        mesh_tube(mesh, 0, 0, .5, 0, 1, FACETS, 4, false, 0, FIBRAD_NO_WALL);
        for (uint32_t lid = 0; lid < 2; lid++) {
            const uint32_t middle = mesh_vertex(mesh, 0, 0, lid), rim = lid * 4 * FACETS;
            for (uint32_t k = 0; k < FACETS; k++) {
                const uint32_t a = rim + k, b = rim + (k + 1) % FACETS;
                mesh_triangle(mesh, middle, lid ? b : a, lid ? a : b, 1 + lid, FIBRAD_NO_WALL);
            }
        }
        mesh_turn(mesh, turn[t]);
        for (uint32_t i = 0; i < bed.n; i++) {
            double c[3] = {bed.x[i], bed.y[i], bed.z[i]};
            turn_point(turn[t], c);
            add_sphere(&turned, c[0], c[1], c[2], bed.r[i]);
        }
        OWNED fibrad_scene *drum = scene_of_mesh(&turned, mesh, 3);
        for (uint32_t i = 0; i < bed.n; i++) {
            const fibrad_beam_rule rule = {.directions = 600};
            assert_ok(fibrad_beam_row(drum, &work, i, &rule, &row));
            assert_ok(fibrad_beam_row(scene, &work, i, &(fibrad_beam_rule){.directions = 4000}, &exact));
            ck_assert(row.escaped == 0);
            ck_assert_double_eq_tol(total_of(&row, 3), 1, 1e-12);
            for (int k = 0; k < 3; k++) square += pow(row.wall[k] - exact.wall[k], 2) / bed.n;
        }
        printf("    drum %d: walls differ by %.2g\n", t, sqrt(square));
        ck_assert_double_le(sqrt(square), 1.5e-3);
    }
}

/* A plane lies within a box, and tubes of a mesh stand through it. What is beyond the plane plays no part. */
TEST(tubes_through_walls) {
    OWNED_BED bed = BED({.2, .5, .5, .1}, {.75, .5, .4, .12});
    fibrad_scene *scene[2];
    fibrad_row row[2];
    OWNED_WORK work = work_growing();
    for (int k = 0; k < 2; k++) {
        OWNED struct mesh *mesh = mesh_new();
        fibrad_wall wall[7];
        mesh_tube(mesh, .47, .45, .1, k ? -5 : 0, k ? 6 : 1, 24, 1, true, 6, FIBRAD_NO_WALL);
        for (int b = 0; b < 6; b++) wall[b] = plane_at(b / 2, b % 2, b % 2);
        wall[6] = mesh->wall[0];
        scene[k] = scene_with(&bed, &(fibrad_scene_config){.wall = wall, .walls = 7, .triangles = &mesh->triangles});
        row[k] = row_of(2);
        assert_ok(fibrad_beam_row(scene[k], &work, 0, &(fibrad_beam_rule){.directions = 2000}, &row[k]));
        ck_assert_double_eq_tol(total_of(&row[k], 7), 1, 1e-12);
        ck_assert(row[k].escaped == 0);
    }
    for (int b = 0; b < 7; b++) ck_assert_double_eq_tol(row[0].wall[b], row[1].wall[b], 3e-4);
    ck_assert_double_gt(row[0].wall[6], .05);
    OWNED_ROW cast = row_of(2);
    assert_ok(fibrad_cast_row(scene[1], &work, 0, &(fibrad_cast_rule){.rays = 400000}, &cast, NULL));
    for (int b = 0; b < 7; b++) ck_assert_double_eq_tol(row[1].wall[b], cast.wall[b], 1.5e-3);
    ck_assert_double_eq_tol(row_factor(&row[1], 1), row_factor(&cast, 1), 1.5e-3);
    for (int k = 0; k < 2; k++) row_free(&row[k]), free(scene[k]);
}

/* An open mesh lies within planes or a cylinder. Some windows have so little that is open that no point lies there.
 * They give it to what lies behind, so that sums are 1, and walls get what they get by points. */
TEST(open_meshes_within_walls) {
    OWNED_BED bed = crowd(150, 11);
    OWNED struct mesh *mesh = mesh_new();
    for (uint32_t k = 0; k < 3; k++) mesh_vertex(mesh, k == 1 ? .9 : .1, k == 2 ? .8 : .2, .3 + .2 * k);
    mesh_triangle(mesh, 0, 1, 2, 6, 6);
    for (int round = 0; round < 2; round++) {
        fibrad_wall wall[7];
        for (int b = 0; b < 6; b++) wall[b] = plane_at(b / 2, b % 2, b % 2);
        if (round) wall[0] = cylinder_at(.5, .5, .75), wall[1] = wall[4], wall[2] = wall[5];
        const uint32_t walls = round ? 4 : 7, from = walls - 1;
        wall[from] = mesh->wall[0];
        mesh->front[0] = mesh->back[0] = from;
        OWNED fibrad_scene *scene =
            scene_with(&bed, &(fibrad_scene_config){.wall = wall, .walls = walls, .triangles = &mesh->triangles});
        OWNED_WORK work = work_growing();
        OWNED_ROW row = row_of(bed.n), exact = row_of(bed.n), grey = row_of(bed.n);
        double emissivity[150], of_wall[7], square = 0;
        for (uint32_t k = 0; k < 150; k++) emissivity[k] = .8;
        for (uint32_t b = 0; b < 7; b++) of_wall[b] = .5;
        const fibrad_exchange_rule rule = {
            .emissivity = emissivity, .wall_emissivity = of_wall, .directions = 150, .paths = 100};
        for (uint32_t i = 0; i < bed.n; i++) {
            assert_ok(fibrad_beam_row(scene, &work, i, NULL, &exact));
            ck_assert_double_eq_tol(total_of(&exact, walls), 1, 1e-12);
            assert_ok(fibrad_beam_row(scene, &work, i, &(fibrad_beam_rule){.points = 256}, &row));
            ck_assert_double_eq_tol(total_of(&row, walls), 1, 1e-12);
            assert_ok(fibrad_exchange_row(scene, &work, i, &rule, &grey, NULL));
            ck_assert_double_eq_tol(total_of(&grey, walls), 1, 1e-12);
            for (uint32_t b = 0; b < walls; b++) square += pow(row.wall[b] - exact.wall[b], 2) / bed.n;
        }
        printf("    within walls: by points and by areas differ by %.2g\n", sqrt(square));
        ck_assert_double_le(sqrt(square), 1.5e-3);
    }
}

/* ---- sides ------------------------------------------------------------------------------------------------------- */

/* A plate faces a sphere with its back, which belongs to no wall. The row ends, and the fault names the plate. If the
 * back has a wall of its own, this takes its part. */
TEST(sides_of_nobody) {
    OWNED_BED bed = BED({0, 0, 0, 1});
    OWNED struct mesh *mesh = mesh_new();
    OWNED_WORK work = work_growing();
    OWNED_ROW row = row_of(1);
    uint64_t rays;
    const double emissivity = .5, of_wall[2] = {.5, .5};
    fibrad_wall_row wall_row;
    mesh_vertex(mesh, 0, 9, -3), mesh_vertex(mesh, 9, 9, -3), mesh_vertex(mesh, 0, 9, 3); /* seen from the front */
    mesh_vertex(mesh, -4, -4, 2), mesh_vertex(mesh, 4, -4, 2), mesh_vertex(mesh, 0, 5, 2);
    mesh_triangle(mesh, 0, 1, 2, 0, FIBRAD_NO_WALL);
    mesh_triangle(mesh, 3, 4, 5, 1, FIBRAD_NO_WALL); /* its normal is +z, away from the sphere */
    OWNED fibrad_scene *scene = scene_of_mesh(&bed, mesh, 2);
    ck_assert_int_eq(fibrad_beam_row(scene, &work, 0, NULL, &row), FIBRAD_E_BACK);
    ck_assert_uint_eq(work.triangle, 1);
    work.triangle = 77;
    ck_assert_int_eq(fibrad_cast_row(scene, &work, 0, NULL, &row, NULL), FIBRAD_E_BACK);
    ck_assert_uint_eq(work.triangle, 1);
    const fibrad_exchange_rule rule = {.emissivity = &emissivity, .wall_emissivity = of_wall};
    work.triangle = 77;
    ck_assert_int_eq(fibrad_exchange_row(scene, &work, 0, &rule, &row, &rays), FIBRAD_E_BACK);
    ck_assert_uint_eq(work.triangle, 1);
    work.triangle = 77;
    ck_assert_int_eq(wall_of(scene, &work, 0, &rule, 0, &wall_row, NULL), FIBRAD_E_BACK);
    ck_assert_uint_eq(work.triangle, 1);
    fibrad_side_view view[2];
    uint32_t triangle = 0;
    for (uint32_t place = 0; place < 2; place++) { /* the first sphere sees the back of the other plate */
        const int status = fibrad_triangle_views(scene, place, 1000, &triangle, view);
        ck_assert_uint_eq(triangle, 1);
        ck_assert(status == FIBRAD_E_BACK || (status == FIBRAD_OK && isnan(view[1].spheres) && view[0].spheres == 0));
    }
    assert_invalid(fibrad_triangle_views(scene, 2, 10, &triangle, view));
    assert_invalid(fibrad_triangle_views(scene, 0, 0, &triangle, view));
    free(scene);
    mesh->back[1] = 0;
    scene = scene_of_mesh(&bed, mesh, 2);
    assert_ok(fibrad_beam_row(scene, &work, 0, NULL, &row));
    ck_assert_double_gt(row.wall[0], .1);
    ck_assert_double_eq(row.wall[1], 0);
    ck_assert_double_eq_tol(fibrad_scene_wall_area(scene, 0), 27 + 36, 1e-12);
}

TEST(bad_triangles_are_named) {
    OWNED_BED bed = BED({0, 0, 0, 1});
    OWNED struct mesh *mesh = mesh_new();
    const double low[3] = {-2, -2, -2}, high[3] = {2, 2, 2};
    mesh_box(mesh, low, high, 0);
    const fibrad_scene_config config = {.wall = mesh->wall, .walls = 6, .triangles = &mesh->triangles};
    fibrad_scene *scene = NULL;
    fibrad_fault fault;
    mesh->at[3][1] = NAN;
    assert_invalid(scene_try(&scene, &bed, &config, &fault));
    ck_assert_uint_lt(fault.triangle, 12);
    mesh->at[3][1] = 2;
    mesh->corner[7][2] = 8;
    assert_invalid(scene_try(&scene, &bed, &config, &fault));
    ck_assert_uint_eq(fault.triangle, 7);
    mesh->corner[7][2] = 7, mesh->front[5] = 6;
    assert_invalid(scene_try(&scene, &bed, &config, &fault));
    ck_assert_uint_eq(fault.triangle, 5);
    mesh->front[5] = FIBRAD_NO_WALL, mesh->front[4] = FIBRAD_NO_WALL; /* wall 2 has no triangle */
    assert_invalid(scene_try(&scene, &bed, &config, &fault));
    ck_assert_uint_eq(fault.triangle, UINT32_MAX);
}

/* A triangle of some size is at (x, 0, z) about a sphere of radius 1 at the origin. It is repeated with a period along
 * some axes. Returns the status of its scene, and the triangle at fault. */
static int status_of(double size, double x, double z, const double period[3], fibrad_scene **scene,
                     uint32_t *triangle) {
    OWNED_BED bed = BED({0, 0, 0, 1});
    OWNED struct mesh *mesh = mesh_new();
    fibrad_fault fault = {.triangle = 77};
    for (int k = 0; k < 3; k++)
        mesh_vertex(mesh, x + size * ((k == 1) - .3), size * ((k == 2) - .3), z + size * .1 * (k == 2));
    mesh_triangle(mesh, 0, 1, 2, 0, 0);
    for (int axis = 0; axis < 3 && period != NULL; axis++) mesh->triangles.period[axis] = period[axis];
    const fibrad_scene_config config = {.wall = mesh->wall, .walls = 1, .triangles = &mesh->triangles};
    free(*scene);
    *scene = NULL;
    const int status = scene_try(scene, &bed, &config, &fault);
    *triangle = fault.triangle;
    return status;
}

/* Checks that rows of the sphere of a scene by all methods come to an end and add up to one. */
static void expect_rows(const fibrad_scene *scene) {
    OWNED_WORK work = work_growing();
    OWNED_ROW row = row_of(1);
    for (uint32_t points = 0; points <= 128; points += 128) {
        assert_ok(fibrad_beam_row(scene, &work, 0, &(fibrad_beam_rule){.directions = 60, .points = points}, &row));
        ck_assert_double_eq_tol(total_of(&row, 1), 1, 1e-12);
    }
    assert_ok(fibrad_cast_row(scene, &work, 0, &(fibrad_cast_rule){.rays = 300}, &row, NULL));
    ck_assert_double_eq_tol(total_of(&row, 1), 1, 1e-12);
}

/* Triangles have the bounds that spheres have. If they are too small, too far away, or too many at one place, they are
 * refused. At the bounds they are accepted, and rows come to an end. */
TEST(triangles_have_bounds) {
    static const double small[] = {1e-14, 1e-30, 1e-37, 1e-50, 1e-200},
                        short_period[] = {1e-3, 1e-6, 1e-8, 1e-11, 1e-200};
    OWNED fibrad_scene *scene = NULL;
    fibrad_triangle_hit hit;
    uint32_t triangle;
    for (int k = 0; k < 5; k++) {
        assert_invalid(status_of(small[k], k % 2 ? 2 : 0, k % 2 ? 0 : 2, NULL, &scene, &triangle));
        ck_assert_uint_eq(triangle, 0);
        const double period[3] = {short_period[k], short_period[k], 0};
        assert_invalid(status_of(1e-9, 0, 2, period, &scene, &triangle));
        ck_assert_uint_eq(triangle, UINT32_MAX);
    }
    assert_invalid(status_of(1, 1e14, 0, NULL, &scene, &triangle)); /* 3e13 radii away */
    ck_assert_uint_eq(triangle, 0);
    assert_invalid(status_of(2e4, 0, 9, (const double[]){2, 2, 2}, &scene, &triangle));
    ck_assert_uint_eq(triangle, 0);
    assert_invalid(status_of(2e4, 0, 9, (const double[]){2, 0, 0}, &scene, &triangle));
    ck_assert_uint_eq(triangle, 0);
    assert_invalid(status_of(1, 0, 2, (const double[]){1e14, 0, 0}, &scene, &triangle));

    assert_ok(status_of(1e-9, 0, 2, NULL, &scene, &triangle));
    expect_rows(scene);
    assert_ok(fibrad_triangle_ray(scene, (double[]){0, 0, -1e4}, (double[]){0, 0, 1}, INFINITY, &hit));
    ck_assert_double_eq_tol(hit.distance, 1e4 + 2, 1e-6);
    for (double far = 1e15; far < 1e300; far *= 1e35)
        assert_invalid(fibrad_triangle_ray(scene, (double[]){far, 0, 0}, (double[]){-1, 0, 0}, INFINITY, &hit));
    assert_ok(status_of(1e12, 0, 2, NULL, &scene, &triangle));
    expect_rows(scene);
    assert_ok(status_of(1e12, 1e12, 2, NULL, &scene, &triangle));
    expect_rows(scene);
    assert_ok(status_of(.2, 0, 2, (const double[]){.25, .25, 0}, &scene, &triangle));
    expect_rows(scene);
    assert_ok(status_of(2, 0, 1e6, (const double[]){2, 2, 0}, &scene, &triangle)); /* far above */
    expect_rows(scene);
    for (int k = 0; k < 2; k++) { /* far along the open axis */
        assert_ok(status_of(k ? 1e9 : 1e4, 0, 2, (const double[]){0, 0, k ? 1e10 : 9e3}, &scene, &triangle));
        assert_ok(fibrad_triangle_ray(scene, (double[]){0, 0, -9}, (double[]){1, 0, 1e-30}, INFINITY, &hit));
        expect_rows(scene);
    }
}

/* Fins are as tall as they may be. Between them lines go up for ever. */
TEST(tall_fins_are_left) {
    static const double top[] = {1e2, 1e4, 1e6};
    OWNED_BED bed = BED({0, 0, 0, 1});
    for (int k = 0; k < 3; k++) {
        OWNED struct mesh *mesh = mesh_new();
        mesh_vertex(mesh, 0, 1.5, 2), mesh_vertex(mesh, .5, 1.5, 2), mesh_vertex(mesh, 0, 1.5, top[k]);
        mesh_triangle(mesh, 0, 1, 2, 0, 0);
        mesh->triangles.period[0] = 3, mesh->triangles.period[1] = 3;
        OWNED fibrad_scene *scene = scene_of_mesh(&bed, mesh, 1);
        fibrad_triangle_hit hit;
        assert_ok(fibrad_triangle_ray(scene, (double[]){.2, 0, -9}, (double[]){1e-30, 1e-20, 1}, INFINITY, &hit));
        ck_assert_uint_eq(hit.triangle, UINT32_MAX);
        expect_rows(scene);
    }
}

/* ---- rays, periods, bits ------------------------------------------------------------------------------------------
 */

/* The nearest of many triangles is found by the tree and one by one. */
TEST(rays_through_the_tree) {
    OWNED struct mesh *mesh = mesh_new();
    OWNED_BED bed = BED({0, 0, 0, .01});
    srand(5);
    for (uint32_t t = 0; t < 3000; t++) {
        const double size = t % 100 == 0 ? 2 : .1, c[3] = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
        uint32_t v[3];
        for (int k = 0; k < 3; k++)
            v[k] = mesh_vertex(mesh, c[0] + uniform(-size, size), c[1] + uniform(-size, size),
                               c[2] + uniform(-size, size));
        mesh_triangle(mesh, v[0], v[1], v[2], 0, 0);
    }
    OWNED fibrad_scene *scene = scene_of_mesh(&bed, mesh, 1);
    uint32_t met = 0, backs = 0;
    for (int ray = 0; ray < 2000; ray++) {
        double w[3], o[3], nearest = INFINITY;
        uint32_t first = UINT32_MAX;
        fibrad_direction((uint32_t)ray, 2000, w);
        for (int a = 0; a < 3; a++) o[a] = uniform(-2, 2);
        for (uint32_t t = 0; t < mesh->triangles.n; t++) { /* the method of Moeller and Trumbore */
            const double *p = mesh->at[mesh->corner[t][0]], *q = mesh->at[mesh->corner[t][1]],
                         *r = mesh->at[mesh->corner[t][2]];
            double e[3], f[3], s[3], h[3], g[3];
            for (int a = 0; a < 3; a++) e[a] = q[a] - p[a], f[a] = r[a] - p[a], s[a] = o[a] - p[a];
            for (int a = 0; a < 3; a++) {
                h[a] = w[(a + 1) % 3] * f[(a + 2) % 3] - w[(a + 2) % 3] * f[(a + 1) % 3];
                g[a] = s[(a + 1) % 3] * e[(a + 2) % 3] - s[(a + 2) % 3] * e[(a + 1) % 3];
            }
            const double det = e[0] * h[0] + e[1] * h[1] + e[2] * h[2];
            const double u = (s[0] * h[0] + s[1] * h[1] + s[2] * h[2]) / det,
                         v = (w[0] * g[0] + w[1] * g[1] + w[2] * g[2]) / det;
            const double length = (f[0] * g[0] + f[1] * g[1] + f[2] * g[2]) / det;
            if (u >= 0 && v >= 0 && u + v <= 1 && length > 0 && length < nearest) nearest = length, first = t;
        }
        fibrad_triangle_hit hit;
        assert_ok(fibrad_triangle_ray(scene, o, w, INFINITY, &hit));
        ck_assert_uint_eq(hit.triangle, first);
        if (first == UINT32_MAX) continue;
        ck_assert_double_eq_tol(hit.distance, nearest, 1e-9);
        met++, backs += (uint32_t)hit.back;
        assert_ok(fibrad_triangle_ray(scene, o, w, nearest * .999, &hit));
        ck_assert_uint_eq(hit.triangle, UINT32_MAX);
    }
    ck_assert(met > 900 && backs > met / 3 && backs < 2 * met / 3);
}

/* A periodic bed with a tube gives what many copies of both give. */
TEST(periodic_meshes) {
    OWNED_BED bed = BED({.2, .2, .3, .19}, {.25, .75, .7, .2}), many = bed_empty();
    OWNED struct mesh *mesh = mesh_new(), *copies = mesh_new();
    enum { FAR = 6 };
    mesh_tube(mesh, .65 + 3, .5 - 2, .2, 5, 6, 12, 1, true, 0, FIBRAD_NO_WALL); /* wherever it is */
    for (int x = -FAR; x <= FAR; x++)
        for (int y = -FAR; y <= FAR; y++) {
            mesh_tube(copies, x + .65, y + .5, .2, -15, 15, 12, 1, true, 0, FIBRAD_NO_WALL);
            for (int z = -FAR; z <= FAR; z++)
                for (uint32_t i = 0; i < 2; i++) add_sphere(&many, x + bed.x[i], y + bed.y[i], z + bed.z[i], bed.r[i]);
        }
    for (int axis = 0; axis < 3; axis++) bed.period[axis] = 1;
    const uint32_t middle = (FAR * (2 * FAR + 1) * (2 * FAR + 1) + FAR * (2 * FAR + 1) + FAR) * 2;
    OWNED fibrad_scene *scene = scene_of_mesh(&bed, mesh, 1), *other = scene_of_mesh(&many, copies, 1);
    OWNED_WORK work = work_growing();
    OWNED_ROW row = row_of(2), far = row_of(many.n), cast = row_of(2);
    const fibrad_beam_rule rule = {.directions = 3000};
    assert_ok(fibrad_beam_row(scene, &work, 0, &rule, &row));
    assert_ok(fibrad_beam_row(other, &work, middle, &rule, &far));
    ck_assert_double_eq_tol(total_of(&row, 1), 1, 1e-12);
    ck_assert_double_gt(row.wall[0], .2);
    ck_assert_double_eq_tol(row.wall[0] + row.escaped, far.wall[0] + far.escaped, .02); /* but for spheres beyond FAR */
    double of_first = 0;
    for (uint32_t k = 0; k < far.length; k++) of_first += far.col[k] % 2 == 0 ? far.f[k] : 0;
    ck_assert_double_eq_tol(row_factor(&row, 0), of_first, .01);
    assert_ok(fibrad_cast_row(scene, &work, 0, &(fibrad_cast_rule){.rays = 200000}, &cast, NULL));

    ck_assert_double_eq_tol(cast.wall[0], row.wall[0], 3e-3);
    ck_assert_double_eq_tol(row_factor(&cast, 1), row_factor(&row, 1), 3e-3);
}

/* A sphere sees all others, which are as many as work memory begins with, and three meshes besides. So there are more
 * entries than spheres. This works in memory that grows, and in as much as FIBRAD_WORK_BYTES says. */
TEST(more_entries_than_spheres) {
    enum { N = 1024 };
    static unsigned char block[FIBRAD_WORK_BYTES(512, N) + FIBRAD_WORK_TRIANGLES];
    OWNED_BED bed = BED({0, 0, 0, 1});
    OWNED struct mesh *mesh = mesh_new();
    double of_wall[3] = {.5, .5, .5}, emissivity[N];
    for (uint32_t k = 0; k + 1 < N; k++) {
        double w[3];
        fibrad_direction(k, N - 1, w);
        add_sphere(&bed, 5 * w[0], 5 * w[1], 5 * w[2], .1);
    }
    for (uint32_t k = 0; k < N; k++) emissivity[k] = .8;
    mesh_box(mesh, (const double[]){-6, -6, -6}, (const double[]){6, 6, 6}, 0);
    for (uint32_t t = 0; t < mesh->triangles.n; t++) mesh->front[t] %= 3;
    OWNED fibrad_scene *scene = scene_of_mesh(&bed, mesh, 3);
    fibrad_work work[2] = {work_growing(), work_fixed(block, sizeof block)};
    OWNED_ROW row = row_of(N);
    for (int k = 0; k < 2; k++) {
        for (uint32_t points = 0; points <= 256; points += 256) {
            const fibrad_beam_rule rule = {.directions = 1000, .points = points};
            assert_ok(fibrad_beam_row(scene, &work[k], 0, &rule, &row));
            ck_assert_uint_eq(row.length, N - 1);
            for (int b = 0; b < 3; b++) ck_assert_double_gt(row.wall[b], .1);
        }
        assert_ok(fibrad_cast_row(scene, &work[k], 0, &(fibrad_cast_rule){.rays = 50000}, &row, NULL));
    }
    const fibrad_exchange_rule rule = {
        .emissivity = emissivity, .wall_emissivity = of_wall, .directions = 1000, .paths = 100};
    assert_ok(fibrad_exchange_row(scene, &work[0], 0, &rule, &row, NULL));
    work_free(&work[0]);
}

/* Triangles and spheres lie at random, with slivers, doubled and coplanar triangles, and corners on spheres. Sums are
 * 1, beams and rays agree, and bits are the same in each instruction set and for triangles in any order. */
TEST(soups) {
    srand(9);
    const struct isas isas = isas_there();
    for (int soup = 0; soup < 12; soup++) {
        OWNED struct mesh *mesh = mesh_new();
        OWNED_BED bed = crowd(20, 100 + (uint64_t)soup);
        for (uint32_t t = 0; t < 80; t++) {
            uint32_t v[3];
            for (int k = 0; k < 3; k++) v[k] = mesh_vertex(mesh, uniform(0, 1), uniform(0, 1), uniform(0, 1));
            double *a = mesh->at[v[0]], *b = mesh->at[v[1]], *c = mesh->at[v[2]];
            for (int axis = 0; axis < 3; axis++) {
                if (t % 8 == 1) c[axis] = .5 * (a[axis] + b[axis]) + 1e-13 * uniform(-1, 1); /* a sliver */
                if (t % 8 == 2) c[axis] = a[axis];                                           /* no area */
                if (t % 8 == 3)
                    a[axis] = b[axis] + .1 * (a[axis] - b[axis]), c[axis] = b[axis] + .1 * (c[axis] - b[axis]);
            }
            if (t % 8 == 4) a[2] = b[2] = c[2] = .5; /* all in one plane */
            if (t % 8 == 5) a[0] = bed.x[t % 20] + bed.r[t % 20], a[1] = bed.y[t % 20], a[2] = bed.z[t % 20];
            mesh_triangle(mesh, v[0], v[1], v[2], t % 8 == 4 ? 0 : t % 3, t % 8 == 4 ? 0 : (t + 1) % 3);
            if (t % 8 == 6) mesh_triangle(mesh, v[0], v[1], v[2], t % 3, (t + 1) % 3); /* twice */
        }
        OWNED_ROW row = row_of(bed.n), again = row_of(bed.n), cast = row_of(bed.n);
        OWNED_WORK work = work_growing();
        for (int set = 0; set < isas.count; set++) {
            OWNED fibrad_scene *scene = scene_with(
                &bed, &(fibrad_scene_config){
                          .isa = isas.set[set], .wall = mesh->wall, .walls = 3, .triangles = &mesh->triangles});
            for (uint32_t i = 0; i < 4; i++) {
                const fibrad_beam_rule rule = {.directions = 300, .points = soup % 2 ? 128 : 0};
                assert_ok(fibrad_beam_row(scene, &work, i, &rule, &row));
                ck_assert_double_eq_tol(total_of(&row, 3), 1, 1e-12);
                for (uint32_t k = 0; k < row.length; k++) ck_assert(row.f[k] > 0 && row.f[k] <= 1);
                if (i == 3 && set > 0) ck_assert(same_bits_with(&row, &again, 3));
                if (i == 3 && set == 0) {
                    memcpy(again.col, row.col, row.length * sizeof *row.col),
                        memcpy(again.f, row.f, row.length * sizeof *row.f);
                    memcpy(again.wall, row.wall, 3 * sizeof *row.wall);
                    again.length = row.length, again.escaped = row.escaped, again.error = row.error,
                    again.beyond = row.beyond;
                }
                if (set > 0) continue;
                assert_ok(fibrad_cast_row(scene, &work, i, &(fibrad_cast_rule){.rays = 30000}, &cast, NULL));
                ck_assert_double_le(row_distance(&row, &cast), .01);
                for (int b = 0; b < 3; b++) ck_assert_double_eq_tol(row.wall[b], cast.wall[b], .012);
            }
        }
    }
}

/* Exchange in a closed grey box of triangles is that in a box of planes, and so are the rows of meshes. */
TEST(grey_meshes) {
    static const double low[3] = {0, 0, 0}, high[3] = {1, 1, 1}, wall[6] = {.8, .3, .5, 1, .2, .6};
    OWNED_BED bed = crowd(30, 8);
    OWNED struct mesh *mesh = mesh_new();
    fibrad_wall plane[6];
    double emissivity[30];
    mesh_box(mesh, low, high, 0);
    for (int k = 0; k < 6; k++) plane[k] = plane_at(k / 2, k % 2, k % 2);
    for (int i = 0; i < 30; i++) emissivity[i] = .2 + .02 * i;
    fibrad_scene *scene[2] = {scene_of_mesh(&bed, mesh, 6),
                              scene_with(&bed, &(fibrad_scene_config){.wall = plane, .walls = 6})};
    OWNED_WORK work = work_growing();
    fibrad_row row[2] = {row_of(30), row_of(30)};
    fibrad_exchange_rule rule = {.emissivity = emissivity, .wall_emissivity = wall, .directions = 400, .paths = 40000};
    for (uint32_t i = 0; i < 3; i++) {
        for (int k = 0; k < 2; k++) {
            assert_ok(fibrad_exchange_row(scene[k], &work, i, &rule, &row[k], NULL));
            ck_assert_double_eq_tol(total_of(&row[k], 6), 1, 1e-12);
        }
        ck_assert_double_le(row_distance(&row[0], &row[1]), 2e-3);
        for (int b = 0; b < 6; b++) ck_assert_double_eq_tol(row[0].wall[b], row[1].wall[b], 2e-3);
    }
    fibrad_wall_row part[2][FIBRAD_WALL_PARTS], mean[2];
    rule.paths = 80000;
    for (int k = 0; k < 2; k++) {
        for (uint32_t p = 0; p < FIBRAD_WALL_PARTS; p++)
            assert_ok(wall_of(scene[k], &work, 1, &rule, p, &part[k][p], NULL));
        assert_ok(fibrad_exchange_wall_mean(part[k], &mean[k]));
    }
    ck_assert(mean[0].escaped == 0);
    const double error = 5 * (mean[0].error + mean[1].error);
    for (int b = 0; b < 6; b++) ck_assert_double_eq_tol(mean[0].wall[b], mean[1].wall[b], error);
    for (int k = 0; k < 2; k++) free(scene[k]), row_free(&row[k]);
}
