/* test_light_spots.c - light on spots smaller and larger than patches, by plain rays. SPDX-License-Identifier: MIT */
#include "host_owned.h"
#include "plain_light.h"
#include "scenes.h"
#include "meshes.h"
#include "suite.h"

enum { SPHERES = 60, SCENES = 20, MOST = SPHERES + 1 };

/* A bed, a floor of one of three kinds, and a spot. */
struct spot_scene {
    struct bed bed;
    struct mesh *mesh;
    fibrad_wall floor;
    fibrad_scene_config config;
    struct plain_bed plain;
    fibrad_light light;
    double absorptivity, of_floor;
};

enum floor { NO_FLOOR, PLANE, TRIANGLES, FLOORS };

static void free_scene(struct spot_scene *s) { plain_free(&s->plain), bed_free(&s->bed), free(s->mesh); }

static struct spot_scene lit_scene(int k) {
    struct spot_scene s = {.bed = packing(SPHERES, .8, 1.2, .3, 11 + (uint64_t)k, true),
                           .absorptivity = .3 + .1 * (k % 5)};
    const double side = s.bed.period[0], spot = .1 * pow(30, (double)k / (SCENES - 1));
    for (int a = 0; a < 3; a++) s.bed.period[a] = 0;
    double low = INFINITY, high = -INFINITY;
    for (uint32_t i = 0; i < s.bed.n; i++)
        low = fmin(low, s.bed.z[i] - s.bed.r[i]), high = fmax(high, s.bed.z[i] + s.bed.r[i]);
    const double under = low - .05, wide = 3 * side;
    s.of_floor = .4;
    s.plain = plain_bed_of(&s.bed);
    const int floor = k % FLOORS;
    if (floor == PLANE) {
        s.floor = plane_at(2, 0, under), s.config.walls = 1;
        s.plain.low[2] = under;
    }
    if (floor == TRIANGLES) {
        s.mesh = mesh_new();
        uint32_t v[4];
        for (int c = 0; c < 4; c++)
            v[c] = mesh_vertex(s.mesh, c == 1 || c == 2 ? wide : side - wide, c > 1 ? wide : side - wide, under);
        mesh_quad(s.mesh, v, 0, 0);
        s.config.wall = s.mesh->wall, s.config.walls = 1, s.config.triangles = &s.mesh->triangles;
        s.plain.triangles = &s.mesh->triangles;
    }
    const double slant = .2 * (k % 3);
    s.light = (fibrad_light){.direction = {sin(slant), 0, -cos(slant)}, .flux = 1 / (PI * spot * spot)};
    s.light.shape = FIBRAD_LIGHT_DISC, s.light.radius = spot;
    uint64_t state = 77 + (uint64_t)k;
    const double at[3] = {side * (.3 + .4 * plain_random(&state)), side * (.3 + .4 * plain_random(&state)), under};
    for (int a = 0; a < 3; a++) s.light.centre[a] = at[a] - 3 * side * s.light.direction[a];
    return s;
}

/* Sets pointers into a scene, which has been moved. */
static void settle_scene(struct spot_scene *s) {
    s->plain.bed = &s->bed;
    if (s->config.walls > 0 && s->mesh == NULL) s->config.wall = &s->floor;
}

/* Fractions of the light that spheres, the floor and the surroundings take. */
static void take_plain(const struct spot_scene *s, int rays, double share[MOST + 1]) {
    const double *d = s->light.direction, u[3] = {-d[2], 0, d[0]};
    double all[MOST + 1] = {0};
#pragma omp parallel for schedule(static) reduction(+ : all[:MOST + 1])
    for (int k = 0; k < rays; k++) {
        uint64_t state = (uint64_t)k * 1000003u;
        double at[3], w[3] = {d[0], d[1], d[2]}, weight = 1. / rays;
        const double r = s->light.radius * sqrt((k + plain_random(&state)) / rays),
                     turn = 2 * PI * fmod(k * .6180339887498949, 1);
        for (int a = 0; a < 3; a++) at[a] = s->light.centre[a] + r * cos(turn) * u[a] + (a == 1) * r * sin(turn);
        for (;;) {
            const struct plain_end end = plain_trace(&s->plain, at, w);
            const bool sphere = end.sphere >= 0, floor = end.triangle >= 0 || (!sphere && end.side == 4);
            if (!sphere && !floor) {
                all[MOST] += weight;
                break;
            }
            const double taken = sphere ? s->absorptivity : s->of_floor;
            all[sphere ? end.sphere : SPHERES] += taken * weight, weight *= 1 - taken;
            if (weight * rays < .05) {
                if (plain_random(&state) > .2) break;
                weight /= .2;
            }
            for (int a = 0; a < 3; a++) at[a] = end.at[a];
            plain_scatter(end.normal, &state, w);
        }
    }
    memcpy(share, all, sizeof all);
}

static void take_ours(const struct spot_scene *s, uint32_t patches, double share[MOST + 1], double error[MOST + 1],
                      int threads) {
    fibrad_run run = {.threads = threads};
    const fibrad_heat_config config = {.patches = patches};
    double eps[SPHERES], first[MOST];
    OWNED_MADE *radiation = NULL;
    const fibrad_spheres spheres = spheres_of(&s->bed);
    const fibrad_light_sources sources = {
        .light = &s->light, .lights = 1, .absorptivity = eps, .wall_absorptivity = &s->of_floor};
    fibrad_light_result result = {.absorbed = share, .absorbed_first = first, .absorbed_error = error};
    result.wall_absorbed = share + SPHERES, result.wall_absorbed_first = first + SPHERES;
    result.wall_absorbed_error = error + SPHERES;
    for (int i = 0; i < SPHERES; i++) eps[i] = s->absorptivity;
    for (int i = 0; i <= MOST; i++) share[i] = error[i] = 0;
    assert_ok(made_with(&radiation, &s->config, &spheres, &config, &run));
    assert_ok(fibrad_bed_shine(radiation, &sources, &result));
    share[MOST] = result.reflected + result.transmitted, error[MOST] = result.error;
    assert_near(result.incident, 1, 1e-9);
}

/* Checks what a scene takes against rays. Returns how many values differ by more than twice their estimate. */
static int check_patches(const struct spot_scene *s, uint32_t patches, const double plain[MOST + 1], int rays) {
    double ours[MOST + 1], error[MOST + 1], absorbed = 0, largest = 0, said = 0;
    int beyond = 0;
    take_ours(s, patches, ours, error, 0);
    for (int i = 0; i < MOST; i++) absorbed += plain[i];
    for (int i = 0; i <= MOST; i++) {
        const double off = fabs(ours[i] - plain[i]), noise = sqrt(plain[i] * (1 - plain[i]) / rays);
        if (off > largest) largest = off, said = error[i];
        beyond += off > 2 * sqrt(error[i] * error[i] + noise * noise);
    }
    printf("spot of %.2f, %u patches: absorbed %.4f, largest error %.5f of it, said %.5f\n", s->light.radius, patches,
           absorbed, largest / absorbed, said / absorbed);
    ck_assert_double_le(largest, .005 * absorbed);
    return beyond;
}

static int check_scene(const struct spot_scene *s, int rays, int *values) {
    double plain[MOST + 1];
    take_plain(s, rays, plain);
    *values += 2 * (MOST + 1);
    return check_patches(s, 96, plain, rays) + check_patches(s, 384, plain, rays);
}

/* Spots of .1 to 3 sphere radii, on beds in the open and on floors. All surfaces and the surroundings are right to .5 %
 * of what is absorbed. */
TEST(spots_of_all_sizes) {
    int values = 0, beyond = 0;
    for (int k = 0; k < SCENES; k += (int)by_night(4, 8)) {
        OWNED_BY(free_scene) struct spot_scene s = lit_scene(k);
        settle_scene(&s);
        beyond += check_scene(&s, 300000, &values);
    }
    printf("%d of %d values beyond twice their estimate\n", beyond, values);
    ck_assert_int_le(20 * beyond, values);
}

/* A spot of .05 radii between a sphere and the floor, which are .05 radii apart. The light goes back and forth between
 * both within less than a patch. */
TEST(a_spot_in_a_crevice) {
    int values = 0;
    struct spot_scene s = {.bed = BED({0, 0, 1.05, 1}), .absorptivity = .3, .of_floor = .2};
    s.plain = plain_bed_of(&s.bed), s.plain.low[2] = 0;
    s.floor = plane_at(2, 0, 0), s.config.walls = 1;
    s.light = (fibrad_light){.direction = {-sqrt(.5), 0, -sqrt(.5)}, .centre = {2.6, 0, 2}};
    s.light.flux = 1 / (PI * .05 * .05), s.light.shape = FIBRAD_LIGHT_DISC, s.light.radius = .05;
    settle_scene(&s);
    ck_assert_int_eq(check_scene(&s, 1000000, &values), 0);
    free_scene(&s);
}

/* A spot that falls between four spheres. The numbers are those of plain rays; their noise is .0004. */
TEST(a_spot_between_spheres) {
    enum { FOUR = 4 };
    const double right[FOUR] = {.1027, .7609, .1080, .3936}, all = 1.3652, eps[FOUR] = {.3, .3, .3, .3};
    const double x[FOUR] = {0, 0, .2002, .2002}, y[FOUR] = {0, .2002, 0, .2002}, z[FOUR] = {0},
                 r[FOUR] = {.1, .1, .1, .1};
    const fibrad_spheres spheres = {.x = x, .y = y, .z = z, .r = r, .n = FOUR};
    const fibrad_light light = {
        .direction = {0, 0, -1}, .flux = 1000, .shape = FIBRAD_LIGHT_DISC, .centre = {.09, .13, 1}, .radius = .05};
    const fibrad_light_sources sources = {.light = &light, .lights = 1, .absorptivity = eps};
    const fibrad_heat_config config[3] = {{.patches = 96}, {.patches = 384}, {.patches = 384, .directions = 2000}};
    double absorbed[FOUR], first[FOUR], error[FOUR];
    fibrad_light_result result = {.absorbed = absorbed, .absorbed_first = first, .absorbed_error = error};
    for (int k = 0; k < 3; k++) {
        OWNED_MADE *radiation = NULL;
        assert_ok(made_with(&radiation, NULL, &spheres, &config[k], NULL));
        assert_ok(fibrad_bed_shine(radiation, &sources, &result));
        for (int i = 0; i < FOUR; i++) {
            printf("sphere %d: %.5f, said %.5f, right %.5f\n", i, absorbed[i], error[i], right[i]);
            ck_assert_double_eq_tol(absorbed[i], right[i], .002 * all);
            ck_assert_double_eq_tol(absorbed[i], right[i], 2.5 * hypot(error[i], .0004));
        }
    }
}

/* Tasks cover all rays, whatever their number. Rays that name no patch or slot are refused. */
TEST(rays_of_light) {
    enum { RAYS = 5000 };
    const struct bed one = BED({0, 0, 1, 1});
    OWNED_BED bed = one;
    const fibrad_wall floor = plane_at(2, 0, 0);
    const fibrad_scene_config config = {.wall = &floor, .walls = 1};
    OWNED fibrad_scene *scene = scene_with(&bed, &config);
    const fibrad_heat_config least = {.patches = 24, .directions = FIBRAD_DIRECTIONS_MIN, .points = 64, .parts = 1};
    const size_t bytes = fibrad_heat_size(&least, scene);
    OWNED void *block = block_of(bytes);
    fibrad_heat *heat;
    OWNED_WORK work = work_growing();
    assert_ok(fibrad_heat_init(&heat, block, bytes, &least, scene));
    const size_t patches = fibrad_heat_patches(heat);
    OWNED double *hits = calloc(4 * patches + 4, sizeof *hits);
    OWNED fibrad_light_ray *ray = calloc(RAYS + 1, sizeof *ray);
    const fibrad_light light = {.direction = {0, 0, -1}, .flux = 1};
    const double eps = .5;
    const fibrad_light_hits to = {hits, hits + patches, hits + 2 * patches, hits + 3 * patches};
    fibrad_light_ends ends = {.wall = {1}};
    memset(ray, 0x55, (RAYS + 1) * sizeof *ray);
    ck_assert_uint_eq(fibrad_heat_scatter_tasks(0), 0);
    ck_assert_uint_eq(fibrad_heat_scatter_tasks(1), 1);
    const uint32_t tasks = fibrad_heat_scatter_tasks(RAYS);
    for (uint32_t task = 0; task < tasks; task++) assert_ok(fibrad_heat_scatter(heat, &work, &light, RAYS, task, ray));
    assert_invalid(fibrad_heat_scatter(heat, &work, &light, RAYS, tasks, ray));
    for (int n = 0; n < RAYS; n++) ck_assert(ray[n].patch[0] < patches || ray[n].patch[0] == UINT32_MAX);
    ck_assert_uint_eq(ray[RAYS].slot, 0x55555555u);
    for (int k = 0; k <= FIBRAD_LIGHT_HITS; k++) {
        const fibrad_light_ray kept = ray[7];
        for (int h = 0; h < FIBRAD_LIGHT_HITS; h++) ray[7].patch[h] = h == k ? (uint32_t)patches : 0;
        ray[7].slot = k == FIBRAD_LIGHT_HITS ? 8 : 0;
        assert_invalid(fibrad_heat_shine_walls(heat, &work, ray, RAYS, &ends, hits));
        assert_invalid(fibrad_heat_reflect(heat, &work, &light, ray, RAYS, &eps, &eps, &to));
        ray[7] = kept;
    }
    assert_ok(fibrad_heat_shine_walls(heat, &work, ray, RAYS, &ends, hits));
    assert_ok(fibrad_heat_reflect(heat, &work, &light, ray, RAYS, &eps, &eps, &to));
}

/* The light that is absorbed has the same bits on every instruction set and for any number of threads. */
TEST(same_bits_everywhere) {
    const struct isas isas = isas_there();
    double first[MOST + 1], error[MOST + 1], other[MOST + 1];
    for (int k = 0; k <= isas.count; k++) {
        OWNED_BY(free_scene) struct spot_scene s = lit_scene(11);
        settle_scene(&s);
        s.config.isa = isas.set[k % isas.count];
        take_ours(&s, 96, k == 0 ? first : other, error, 1 + k / isas.count);
        if (k > 0) ck_assert_mem_eq(first, other, sizeof first);
    }
}

/* A spot of .06 radii near the contact of two spheres. The numbers are those of 2e7 plain rays. */
TEST(a_small_spot_near_a_contact) {
    const double eps[2] = {.3, .3}, x[2] = {0, 1.001}, y[2] = {0, 0}, r[2] = {.5, .5}, light_of[2] = {.88482, .17059};
    const fibrad_spheres spheres = {.x = x, .y = y, .z = y, .r = r, .n = 2};
    const fibrad_light light = {
        .direction = {0, 0, -1}, .flux = 1000, .shape = FIBRAD_LIGHT_DISC, .centre = {.4, 0, 1}, .radius = .03};
    const fibrad_light_sources sources = {.light = &light, .lights = 1, .absorptivity = eps};
    double absorbed[2], first[2], error[2];
    fibrad_light_result result = {.absorbed = absorbed, .absorbed_first = first, .absorbed_error = error};
    for (int k = 0; k < 2; k++) {
        OWNED_MADE *radiation = NULL;
        const fibrad_heat_config config = {.patches = k ? 384 : 96};
        assert_ok(made_with(&radiation, NULL, &spheres, &config, NULL));
        assert_ok(fibrad_bed_shine(radiation, &sources, &result));
        for (int i = 0; i < 2; i++) {
            printf("sphere %d: %.5f, said %.5f, right %.5f\n", i, absorbed[i], error[i], light_of[i]);
            ck_assert_double_eq_tol(absorbed[i], light_of[i], (k ? .001 : .003) * 1.0554);
            ck_assert_double_eq_tol(absorbed[i], light_of[i], 2.5 * error[i]);
        }
    }
}

/* Wide light from above on few spheres and an endless floor of absorptivity .1. The floor is lit between shadows, which
 * are smaller than its patches. */
TEST(shadows_on_an_endless_floor) {
    enum { FEW = 25, RAYS = 2500000 };
    OWNED_BED bed = packing(FEW, 1, 1, .08, 3, true);
    for (int a = 0; a < 3; a++) bed.period[a] = 0;
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY}, eps[FEW];
    for (int i = 0; i < FEW; i++) {
        const double at[3] = {bed.x[i], bed.y[i], bed.z[i]};
        for (int a = 0; a < 3; a++) low[a] = fmin(low[a], at[a] - 1), high[a] = fmax(high[a], at[a] + 1);
        eps[i] = .5;
    }
    const double of_floor = .1, area = (high[0] - low[0]) * (high[1] - low[1]);
    const fibrad_wall floor = plane_at(2, 0, low[2] - .02);
    const fibrad_scene_config config = {.wall = &floor, .walls = 1};
    OWNED_BY(plain_free) struct plain_bed plain = plain_bed_of(&bed);
    plain.low[2] = low[2] - .02;
    const fibrad_light light = {.direction = {0, 0, -1}, .flux = 1 / area};
    double absorbed[FEW], first[FEW], error[FEW], wall, wall_first, rays[FEW] = {0};
    OWNED_MADE *radiation = NULL;
    const fibrad_spheres spheres = spheres_of(&bed);
    const fibrad_light_sources sources = {
        .light = &light, .lights = 1, .absorptivity = eps, .wall_absorptivity = &of_floor};
    fibrad_light_result result = {.absorbed = absorbed, .absorbed_first = first, .absorbed_error = error};
    result.wall_absorbed = &wall, result.wall_absorbed_first = &wall_first;
    assert_ok(made_with(&radiation, &config, &spheres, NULL, NULL));
    assert_ok(fibrad_bed_shine(radiation, &sources, &result));
#pragma omp parallel for schedule(static) reduction(+ : rays[:FEW])
    for (int k = 0; k < RAYS; k++) {
        uint64_t state = (uint64_t)k * 1000003u;
        const double x = (k + plain_random(&state)) / RAYS, y = fmod(k * .6180339887498949, 1);
        double at[3] = {low[0] + x * (high[0] - low[0]), low[1] + y * (high[1] - low[1]), high[2] + 1};
        double w[3] = {0, 0, -1}, weight = 1. / RAYS;
        for (int hits = 0; hits < 30; hits++) {
            const struct plain_end end = plain_trace(&plain, at, w);
            if (end.sphere < 0 && end.side != 4) break;
            if (end.sphere >= 0) rays[end.sphere] += eps[end.sphere] * weight;
            weight *= end.sphere >= 0 ? .5 : 1 - of_floor;
            for (int a = 0; a < 3; a++) at[a] = end.at[a];
            plain_scatter(end.normal, &state, w);
        }
    }
    int beyond = 0;
    double squares = 0, all = 0;
    for (int i = 0; i < FEW; i++) {
        const double off = absorbed[i] - rays[i], noise = .5 * sqrt((rays[i] - first[i]) / RAYS);
        beyond += fabs(off) > 2 * sqrt(error[i] * error[i] + noise * noise);
        squares += off * off, all += rays[i] * rays[i];
    }
    printf("floor: error %.5f of rms, %d of %d beyond\n", sqrt(squares / all), beyond, FEW);
    ck_assert_double_le(sqrt(squares / all), .0045);
    ck_assert_int_le(beyond, 1);
}
