/* test_light_heat.c - light that is reflected and absorbed in a bed. SPDX-License-Identifier: MIT */
#include "host_owned.h"
#include "plain_light.h"
#include "scenes.h"
#include "meshes.h"
#include "suite.h"

/* The bed of a dump with the columns id type x y z radius, periodic along x and y. */
static struct bed read_settled(const char *file) {
    struct bed bed = bed_empty();
    char line[200];
    OWNED_FILE *from = opened(file, "r");
    while (fgets(line, sizeof line, from)) {
        double x, y, z, r;
        if (sscanf(line, "%*d %*d %lf %lf %lf %lf", &x, &y, &z, &r) == 4) add_sphere(&bed, x, y, z, r);
    }
    ck_assert_uint_eq(bed.n, 2000);
    bed.period[0] = bed.period[1] = 12, bed.period[2] = 0;
    return bed;
}

/* What is absorbed, in all arrays that a result may have. */
struct absorbed {
    double *sphere, *first, *error, wall[6], wall_first[6], wall_error[6], wall_eps[6];
    fibrad_light_result result;
};

/* Checks that the fluxes of triangles that are at 0 K add up to the light that their wall absorbs. */
static void check_sides(fibrad_bed *radiation, const fibrad_scene_config *config, const double *eps,
                        const struct absorbed *a) {
    const struct fibrad_triangles *t = config->triangles;
    double flux[2 * 12], cold[100] = {0}, power[100], wall_power[6], sum = 0, all = 0;
    fibrad_heat_sources sources;
    fibrad_heat_result result = {.power = power, .wall_power = wall_power};
    fibrad_heat_sources_init(&sources);
    sources.temperature = cold, sources.wall_temperature = cold, sources.surroundings = 0;
    sources.emissivity = eps, sources.wall_emissivity = a->wall_eps, sources.absorbed = a->result.patches;
    ck_assert_int_eq(fibrad_bed_solve(radiation, &sources, NULL, &result), 0);
    ck_assert_int_eq(fibrad_bed_sides(radiation, flux, NULL), 0);
    for (uint32_t k = 0; k < t->n; k++) {
        double origin[3], u[3], v[3], n[3];
        plain_edges(t, k, origin, u, v), plain_cross(u, v, n);
        for (uint32_t s = 0; s < 2; s++)
            sum += isnan(flux[2 * k + s]) ? 0 : .5 * sqrt(plain_product(n, n)) * flux[2 * k + s];
    }
    for (uint32_t b = 0; b < config->walls; b++) all += a->wall[b];
    ck_assert_double_eq_tol(sum, all, 1e-12 * a->result.incident);
}

static fibrad_bed *traced(const struct bed *bed, const fibrad_scene_config *config) {
    const fibrad_spheres spheres = spheres_of(bed);
    fibrad_bed *radiation;
    assert_ok(made_with(&radiation, config, &spheres, NULL, NULL));
    return radiation;
}

/* radiation: of this bed within these walls. */
static struct absorbed absorb_light(fibrad_bed *radiation, const struct bed *bed, const fibrad_scene_config *config,
                                    const fibrad_light *light, double absorptivity, double of_walls) {
    struct absorbed a = {calloc(bed->n, sizeof(double)),
                         calloc(bed->n, sizeof(double)),
                         calloc(bed->n, sizeof(double)),
                         {0},
                         {0},
                         {0},
                         {0},
                         {0}};
    double *eps = malloc(bed->n * sizeof *eps);
    const fibrad_light_sources sources = {
        .light = light, .lights = 1, .absorptivity = eps, .wall_absorptivity = a.wall_eps};
    for (uint32_t i = 0; i < bed->n; i++) eps[i] = absorptivity;
    for (int b = 0; b < 6; b++) a.wall_eps[b] = of_walls;
    a.result = (fibrad_light_result){.absorbed = a.sphere, .absorbed_first = a.first, .absorbed_error = a.error};
    a.result.wall_absorbed = a.wall, a.result.wall_absorbed_first = a.wall_first,
    a.result.wall_absorbed_error = a.wall_error;
    assert_ok(fibrad_bed_shine(radiation, &sources, &a.result));
    if (config->triangles) check_sides(radiation, config, eps, &a);
    free(eps);
    double sum = a.result.transmitted + a.result.reflected;
    for (uint32_t i = 0; i < bed->n; i++) sum += a.sphere[i];
    for (int b = 0; b < 6; b++) sum += a.wall[b];
    assert_near(sum, a.result.incident, 1e-12);
    return a;
}

static void free_absorbed(struct absorbed *a) { free(a->sphere), free(a->first), free(a->error); }

#define OWNED_ABSORBED OWNED_BY(free_absorbed) struct absorbed

enum { LAYERS = 24 };

/* Does the same by plain rays, in layers of one diameter from the top. Returns the fraction that is absorbed. */
static double absorb_plain(const struct plain_bed *p, const double d[3], double absorptivity, int rays,
                           double layer[LAYERS]) {
    double top = -INFINITY, all = 0;
    for (uint32_t i = 0; i < p->bed->n; i++) top = fmax(top, p->bed->z[i] + p->bed->r[i]);
    for (int k = 0; k < LAYERS; k++) layer[k] = 0;
#pragma omp parallel for schedule(static) reduction(+ : all, layer[:LAYERS])
    for (int k = 0; k < rays; k++)
        for (int m = 0; m < rays; m++) {
            uint64_t state = (uint64_t)k * 1000003u + (uint64_t)m;
            double at[3] = {12 * (k + plain_random(&state)) / rays, 12 * (m + plain_random(&state)) / rays, top + 1};
            double w[3] = {d[0], d[1], d[2]}, weight = 1. / rays / rays;
            for (;;) {
                const struct plain_end end = plain_trace(p, at, w);
                if (end.sphere < 0) break;
                const int depth = (int)(top - p->bed->z[end.sphere]);
                all += weight * absorptivity;
                layer[depth < LAYERS ? depth : LAYERS - 1] += weight * absorptivity;
                weight *= 1 - absorptivity;
                if (weight * rays * rays < .1) {
                    if (plain_random(&state) > .3) break;
                    weight /= .3;
                }
                for (int a = 0; a < 3; a++) at[a] = end.at[a];
                plain_scatter(end.normal, &state, w);
            }
        }
    return all;
}

TEST(a_settled_bed_absorbs_as_plain_rays_say) {
    OWNED_BED bed = read_settled("tests/data/monoper2000.dump");
    OWNED_BY(plain_free) struct plain_bed plain = plain_bed_of(&bed);
    const fibrad_scene_config config = {.period = {12, 12, 0}};
    OWNED_MADE *radiation = traced(&bed, &config);
    double top = -INFINITY;
    for (uint32_t i = 0; i < bed.n; i++) top = fmax(top, bed.z[i] + bed.r[i]);
    for (int k = 1; k < 3; k++) {
        const double absorptivity = k % 2 ? .8 : .4, slant = k < 2 ? 0 : PI / 6, d[3] = {sin(slant), 0, -cos(slant)};
        const fibrad_light light = {.direction = {d[0], d[1], d[2]}, .flux = 1 / (144 * cos(slant))};
        OWNED_ABSORBED a = absorb_light(radiation, &bed, &config, &light, absorptivity, 0);
        double rays[LAYERS], ours[LAYERS] = {0}, sum = 0;
        const double all = absorb_plain(&plain, d, absorptivity, k % 2 ? 300 : 500, rays);
        ck_assert_double_eq_tol(a.result.incident, 1, 1e-12);
        for (uint32_t i = 0; i < bed.n; i++) {
            const int depth = (int)(top - bed.z[i]);
            sum += a.sphere[i], ours[depth < LAYERS ? depth : LAYERS - 1] += a.sphere[i];
        }
        assert_near(sum, all, .003);
        for (int l = 0; l < LAYERS; l++) ck_assert_double_eq_tol(ours[l], rays[l], .01 * fmax(rays[l], .05 * all));
    }
}

/* Light reaches a floor between few spheres. The floor absorbs its share and sends back the rest. */
TEST(a_floor_alone_absorbs_what_it_absorbs) {
    const double far_away[][4] = {{0, 0, 1, .5}};
    OWNED_BED bed = bed_of(1, far_away);
    const fibrad_wall wall = plane_at(2, 0, 0);
    const fibrad_plane top = {2, 1, 2};
    const fibrad_scene_config config = {.period = {4, 4, 0}, .wall = &wall, .walls = 1, .opening = &top, .openings = 1};
    const fibrad_light light = {.direction = {0, 0, -1}, .flux = 1};
    OWNED_MADE *radiation = traced(&bed, &config);
    for (int k = 0; k <= 4; k++) {
        const double share = k / 4.;
        OWNED_ABSORBED a = absorb_light(radiation, &bed, &config, &light, 1, share);
        const double sphere = PI / 4,
                     floor_light = 16 - sphere; /* the light that meets the sphere first, and the floor */
        ck_assert_double_eq_tol(a.first[0], sphere, 1e-12);
        ck_assert_double_eq_tol(a.wall_first[0], share * floor_light, 1e-12);
        ck_assert_double_eq_tol(a.wall[0], share * floor_light, 1e-9); /* no light comes back to the floor */
        ck_assert_double_eq_tol(a.sphere[0] + a.result.reflected, sphere + (1 - share) * floor_light, 1e-9);
        ck_assert_double_eq_tol(a.result.transmitted, 0, 1e-12);
    }
}

/* What spheres and walls of triangles absorb of the light through the square rim of a cup, by plain rays. */
static void absorb_in_cup(const struct plain_bed *p, const double d[3], double wide, int rays, double sum[2]) {
    double spheres = 0, walls = 0;
#pragma omp parallel for schedule(static) reduction(+ : spheres, walls)
    for (int k = 0; k < rays; k++)
        for (int m = 0; m < rays; m++) {
            uint64_t state = (uint64_t)k * 1000003u + (uint64_t)m;
            double at[3] = {wide * (k + plain_random(&state)) / rays, wide * (m + plain_random(&state)) / rays, wide};
            double w[3] = {d[0], d[1], d[2]}, weight = wide * wide * -d[2] / rays / rays;
            for (int hits = 0; hits < 40; hits++) {
                const struct plain_end end = plain_trace(p, at, w);
                if (end.sphere < 0 && end.triangle < 0) break;
                spheres += end.sphere >= 0 ? .5 * weight : 0, walls += end.sphere < 0 ? .3 * weight : 0;
                weight *= end.sphere >= 0 ? .5 : .7;
                for (int a = 0; a < 3; a++) at[a] = end.at[a];
                plain_scatter(end.normal, &state, w);
            }
        }
    sum[0] = spheres, sum[1] = walls;
}

/* A cup of triangles about a bed absorbs as one of planes does. The outer sides of the triangles are a wall of its own.
 * They take the light that does not come through the rim. */
TEST(a_cup_of_triangles_absorbs_as_one_of_planes) {
    OWNED_BED bed = packing(60, .2, .3, .4, 11, true);
    const double side = bed.period[0];
    bed.period[0] = bed.period[1] = bed.period[2] = 0;
    for (uint32_t i = 0; i < bed.n; i++) { /* all spheres lie within the cup */
        double *place[3] = {bed.x, bed.y, bed.z};
        for (int a = 0; a < 3; a++) place[a][i] = .35 + place[a][i];
    }
    const double wide = side + .7;
    fibrad_wall wall[5];
    for (int k = 0; k < 5; k++) wall[k] = plane_at(k / 2, k % 2, k % 2 ? wide : 0);
    OWNED struct mesh *mesh = mesh_new();
    mesh_box(mesh, (const double[]){0, 0, 0}, (const double[]){wide, wide, wide}, 0);
    mesh->triangles.n -= 2; /* without its lid */
    for (uint32_t t = 0; t < mesh->triangles.n; t++) mesh->front[t] = 0, mesh->back[t] = 1;
    const fibrad_plane top = {2, 1, wide};
    const fibrad_scene_config planes = {.wall = wall, .walls = 5, .opening = &top, .openings = 1};
    const fibrad_scene_config triangles = {
        .wall = mesh->wall, .walls = 2, .triangles = &mesh->triangles, .opening = &top, .openings = 1};
    OWNED_MADE *flat = traced(&bed, &planes), *faceted = traced(&bed, &triangles);
    OWNED_BY(plain_free) struct plain_bed plain = plain_bed_of(&bed);
    plain.triangles = &mesh->triangles, plain.high[2] = wide, plain.open[5] = true;
    for (int k = 0; k < 4; k++) {
        const fibrad_light light = {
            .direction = {k % 2 ? .3 : 0, k % 2 ? .2 : 0, -1}, .flux = 1, .half_angle = .1 * (k / 2), .directions = 16};
        struct absorbed a = absorb_light(flat, &bed, &planes, &light, .5, .3),
                        b = absorb_light(faceted, &bed, &triangles, &light, .5, .3);
        double sum[2] = {0}, first = 0;
        for (uint32_t i = 0; i < bed.n; i++) {
            ck_assert_double_eq_tol(a.first[i], b.first[i], 1e-11);
            sum[0] += a.sphere[i], sum[1] += b.sphere[i];
        }
        for (int w = 0; w < 5; w++) first += a.wall_first[w];
        if (k < 2) {
            const double *v = light.direction, size = sqrt(plain_product(v, v)),
                         d[3] = {v[0] / size, v[1] / size, v[2] / size};
            double rays[2];
            absorb_in_cup(&plain, d, wide, 250, rays);
            printf("by rays %.5f %.5f, ours %.5f %.5f\n", rays[0], rays[1], sum[1], b.wall[0]);
            assert_near(sum[1], rays[0], .004);
            ck_assert_double_eq_tol(b.wall[0], rays[1], .004 * rays[0]);
        }
        printf("cup %d: spheres %.5f %.5f, walls %.5f %.5f, outside %.5f\n", k, sum[0], sum[1], first, b.wall_first[0],
               b.wall_first[1]);
        ck_assert_double_eq_tol(sum[0], sum[1], .003 * sum[0]);
        ck_assert_double_eq_tol(first, b.wall_first[0], 1e-3 * a.result.incident);
        free_absorbed(&a), free_absorbed(&b);
    }
}

/* A tilted triangle that is alone in the light takes what its shadow says, by rays. */
TEST(a_tilted_triangle_takes_its_shadow) {
    const double far_away[][4] = {{0, 0, 0, 1}};
    OWNED_BED bed = bed_of(1, far_away);
    OWNED struct mesh *mesh = mesh_new();
    const uint32_t a = mesh_vertex(mesh, 2, -1, 0), b = mesh_vertex(mesh, 4, 0, 1), c = mesh_vertex(mesh, 3, 2, .5);
    mesh_triangle(mesh, a, b, c, 0, 0);
    const fibrad_scene_config config = {.wall = mesh->wall, .walls = 1, .triangles = &mesh->triangles};
    const fibrad_light light = {.direction = {0, 0, -1}, .flux = 1};
    OWNED_MADE *radiation = traced(&bed, &config);
    struct absorbed lit = absorb_light(radiation, &bed, &config, &light, 1, .25);
    ck_assert_double_eq_tol(lit.first[0], PI, 1e-12);
    ck_assert_double_eq_tol(lit.wall_first[0], .25 * 2.5, .25 * 5e-4 * lit.result.incident);
    ck_assert_double_eq_tol(lit.result.transmitted, lit.result.incident - PI - 4 * lit.wall_first[0], 1e-12);
    free_absorbed(&lit);
}

/* Light on a side that belongs to no wall is an error. */
TEST(light_on_a_side_of_no_wall) {
    const double one[][4] = {{0, 0, 0, 1}};
    OWNED_BED bed = bed_of(1, one);
    OWNED struct mesh *mesh = mesh_new();
    const uint32_t a = mesh_vertex(mesh, 2, -1, 3), b = mesh_vertex(mesh, 4, 0, 3), c = mesh_vertex(mesh, 3, 2, 3);
    mesh_triangle(mesh, a, b, c, FIBRAD_NO_WALL, 0);
    const fibrad_scene_config config = {.wall = mesh->wall, .walls = 1, .triangles = &mesh->triangles};
    const fibrad_light light = {.direction = {0, 0, -1}, .flux = 1};
    const double eps = .5;
    double absorbed[2], first[2];
    OWNED_MADE *radiation = traced(&bed, &config);
    const fibrad_light_sources sources = {
        .light = &light, .lights = 1, .absorptivity = &eps, .wall_absorptivity = &eps};
    fibrad_light_result result = {
        .absorbed = absorbed, .absorbed_first = first, .wall_absorbed = absorbed + 1, .wall_absorbed_first = first + 1};
    fibrad_fault fault;
    ck_assert_int_eq(fibrad_bed_shine(radiation, &sources, &result), FIBRAD_E_BACK);
    fibrad_bed_describe(radiation, NULL, &fault);
    ck_assert_uint_eq(fault.triangle, 0);
}

/* A closed cup reflects all. Light in it ends on the sphere or outside, whatever its walls do. */
TEST(white_walls_absorb_nothing) {
    const double one[][4] = {{0, 0, .6, .5}};
    OWNED_BED bed = bed_of(1, one);
    fibrad_wall wall[5];
    for (int side = 0; side < 5; side++) wall[side] = plane_at(side / 2, side % 2, side == 4 ? 0 : side % 2 ? 1 : -1);
    const fibrad_plane top = {2, 1, 1.5};
    const fibrad_scene_config config = {.wall = wall, .walls = 5, .opening = &top, .openings = 1};
    const fibrad_light light = {.direction = {.4, .1, -1}, .flux = 3, .half_angle = .1};
    OWNED_MADE *radiation = traced(&bed, &config);
    OWNED_ABSORBED a = absorb_light(radiation, &bed, &config, &light, .3, 0);
    for (int b = 0; b < 5; b++) ck_assert_double_eq_tol(a.wall[b], 0, 1e-12);
    ck_assert_double_gt(a.sphere[0], 1.5 * a.first[0]);
}

/* By Kirchhoff's law: take the power that a bed of one temperature sends out through its open face, over that of a
 * black face. This is the mean fraction that the bed absorbs of light from all sides, by the cosine law. */
TEST(emissivity_of_a_face_is_its_mean_absorptance) {
    OWNED_BED bed = packing(40, .5, .5, .5, 9, true);
    const double side = bed.period[0], floor_at = -.5;
    bed.period[2] = 0;
    const fibrad_wall wall = plane_at(2, 0, floor_at);
    const fibrad_scene_config config = {.period = {side, side, 0}, .wall = &wall, .walls = 1};
    OWNED_MADE *radiation = traced(&bed, &config);
    enum { RINGS = 4, TURNS = 3 };
    double mean = 0, hot[40], power[40], eps[40], wall_hot = 1000, wall_power, wall_eps = .4;
    for (int k = 0; k < RINGS * TURNS; k++) {
        const double square = (k / TURNS + .5) / RINGS, turn = 2 * PI * (k % TURNS + .3 * (k / TURNS)) / TURNS;
        const double ring = sqrt(square), cosine = sqrt(1 - square);
        const fibrad_light light = {.direction = {ring * cos(turn), ring * sin(turn), -cosine},
                                    .flux = 1 / (side * side * cosine)};
        OWNED_ABSORBED a = absorb_light(radiation, &bed, &config, &light, .4, .4);
        mean += (1 - a.result.reflected) / (RINGS * TURNS);
    }
    fibrad_heat_sources sources;
    fibrad_heat_result result = {.power = power, .wall_power = &wall_power};
    fibrad_heat_sources_init(&sources);
    for (int i = 0; i < 40; i++) hot[i] = 1000, eps[i] = .4;
    sources.temperature = hot, sources.emissivity = eps, sources.surroundings = 0;
    sources.wall_temperature = &wall_hot, sources.wall_emissivity = &wall_eps;
    assert_ok(fibrad_bed_solve(radiation, &sources, NULL, &result));
    const double emissivity = result.surroundings_power / (FIBRAD_STEFAN_BOLTZMANN * 1e12 * side * side);
    printf("face: emissivity %.4f, mean absorptance %.4f\n", emissivity, mean);
    ck_assert_double_eq_tol(emissivity, mean, .01);
}

/* A narrow beam on a cube of spheres above a floor. Most surfaces get next to nothing of it, but none less than that.
 */
TEST(nothing_absorbs_less_than_its_first_light) {
    enum { SIDE = 4, CUBE = SIDE * SIDE * SIDE };
    const fibrad_heat_config coarse = {.directions = 12, .patches = 24};
    const fibrad_wall floor = plane_at(2, 0, -1.1);
    const fibrad_scene_config config = {.wall = &floor, .walls = 1};
    for (int k = 0; k < 6; k++) {
        OWNED_BED bed = bed_empty();
        OWNED_MADE *radiation = NULL;
        double eps[CUBE], absorbed[CUBE], first[CUBE], wall, wall_first, sum = 0;
        const double of_wall = .4;
        for (uint32_t i = 0; i < CUBE; i++) {
            add_sphere(&bed, 2.1 * (i % SIDE), 2.1 * (i / SIDE % SIDE), 2.1 * (i / SIDE / SIDE), .8 + .05 * (i % 4));
            eps[i] = k < 5 ? .1 + .1 * k + .4 * bed_make_random(3, i) : 1;
        }
        const fibrad_spheres spheres = spheres_of(&bed);
        fibrad_light light = {.direction = {0, 0, -1}, .flux = 1, .centre = {.5 * k, .3 * k, 99}};
        light.shape = FIBRAD_LIGHT_DISC, light.radius = .5;
        const fibrad_light_sources sources = {
            .light = &light, .lights = 1, .absorptivity = eps, .wall_absorptivity = &of_wall};
        fibrad_light_result result = {
            .absorbed = absorbed, .absorbed_first = first, .wall_absorbed = &wall, .wall_absorbed_first = &wall_first};
        assert_ok(made_with(&radiation, &config, &spheres, &coarse, NULL));
        assert_ok(fibrad_bed_shine(radiation, &sources, &result));
        for (int i = 0; i < CUBE; i++) {
            ck_assert_double_ge(first[i], 0);
            ck_assert_double_ge(absorbed[i], first[i]);
            sum += absorbed[i];
        }
        ck_assert_double_ge(wall, wall_first);
        ck_assert_double_ge(result.reflected, 0);
        sum += wall + result.reflected + result.transmitted;
        ck_assert_double_eq_tol(sum, result.incident, 1e-12 * result.incident);
    }
}
