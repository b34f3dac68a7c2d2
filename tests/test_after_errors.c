/* test_after_errors.c - outputs of the kernel after calls that fail are as before. SPDX-License-Identifier: MIT */
#include "fibrad_mesh.h"
#include "heat_calls.h"
#include "lit.h"

enum { SIDE = 4, CUBE = SIDE * SIDE * SIDE, STEP = 4096, MOST = 1 << 20 };

static bool is_all(const void *bytes, size_t size, unsigned char fill) {
    const unsigned char *p = bytes;
    size_t same = 0;
    while (same < size && p[same] == fill) same++;
    return same == size;
}

/* A cube of spheres, and below it two triangles. The back of the second one belongs to no wall and is seen. */
static fibrad_scene *scene_with_back(void *block, size_t size, double emissivity[CUBE]) {
    static const double at[5][3] = {{-9, -9, 9}, {20, -9, 9}, {-9, 20, 9}, {-9, -9, 12}, {20, -9, 12}};
    static const uint32_t corner[2][3] = {{0, 1, 2}, {0, 4, 3}}, front[2] = {0, FIBRAD_NO_WALL},
                          back[2] = {0, FIBRAD_NO_WALL};
    fibrad_triangles two = {.x = &at[0][0], .y = &at[0][1], .z = &at[0][2], .stride = 3, .vertices = 5};
    two.corner = &corner[0][0], two.front = front, two.back = back, two.n = 2;
    const fibrad_wall mesh = {.kind = FIBRAD_WALL_MESH};
    const fibrad_scene_config config = {.wall = &mesh, .walls = 1, .triangles = &two};
    double x[CUBE], y[CUBE], z[CUBE], r[CUBE];
    for (int i = 0; i < CUBE; i++) {
        x[i] = 2.1 * (i % SIDE), y[i] = 2.1 * (i / SIDE % SIDE), z[i] = 2.1 * (i / SIDE / SIDE), r[i] = 1;
        emissivity[i] = .3;
    }
    const fibrad_spheres spheres = {.x = x, .y = y, .z = z, .r = r, .n = CUBE};
    fibrad_scene *scene;
    assert_ok(fibrad_scene_init(&scene, block, size, &config, &spheres, NULL));
    return scene;
}

TEST(row_of_a_wall_that_sees_a_back) {
    const size_t size = fibrad_scene_size(CUBE, 0) + fibrad_triangles_size(2, CUBE);
    OWNED void *block = block_of(size);
    OWNED_WORK work = work_growing();
    double emissivity[CUBE];
    const double wall = .5;
    const fibrad_scene *scene = scene_with_back(block, size, emissivity);
    const fibrad_wall_rule rule = {.emissivity = emissivity, .wall_emissivity = &wall};
    uint64_t reflected[CUBE], before[CUBE];
    fibrad_wall_row row;
    memset(&row, 0xEE, sizeof row);
    for (uint64_t i = 0; i < CUBE; i++) reflected[i] = before[i] = i << 50 | 12345;
    ck_assert_int_eq(fibrad_exchange_wall(scene, &work, 0, &rule, 0, &row, reflected), FIBRAD_E_BACK);
    ck_assert(is_all(&row, sizeof row, 0xEE));
    ck_assert_mem_eq(reflected, before, sizeof before);
    ck_assert_uint_eq(work.triangle, 1);
}

TEST(views_of_a_triangle_that_sees_a_back) {
    const size_t size = fibrad_scene_size(CUBE, 0) + fibrad_triangles_size(2, CUBE);
    OWNED void *block = block_of(size);
    double emissivity[CUBE];
    const fibrad_scene *scene = scene_with_back(block, size, emissivity);
    int failed = 0;
    for (uint32_t place = 0; place < 2; place++) {
        fibrad_side_view view[2];
        uint32_t triangle;
        memset(view, 0xEE, sizeof view);
        if (fibrad_triangle_views(scene, place, 4096, &triangle, view) == FIBRAD_OK) continue;
        failed++;
        ck_assert_uint_eq(triangle, 1);
        ck_assert(is_all(view, sizeof view, 0xEE));
    }
    ck_assert_int_gt(failed, 0);
}

/* A row of small spheres hides a large one from the light: its window has many discs. */
static fibrad_scene *crowded_scene(void *block, size_t size) {
    double x[CUBE], y[CUBE], z[CUBE], r[CUBE];
    for (int i = 0; i < CUBE; i++) {
        const double turn = 2.399963 * i, away = .11 * sqrt(i);
        x[i] = away * cos(turn), y[i] = away * sin(turn), z[i] = 1.2, r[i] = .06;
    }
    x[CUBE - 1] = y[CUBE - 1] = z[CUBE - 1] = 0, r[CUBE - 1] = 1;
    const fibrad_spheres spheres = {.x = x, .y = y, .z = z, .r = r, .n = CUBE};
    fibrad_scene *scene;
    assert_ok(fibrad_scene_init(&scene, block, size, NULL, &spheres, NULL));
    return scene;
}

/* Whatever the size of work memory, light is known or all is as before. */
TEST(light_in_little_memory) {
    const size_t size = fibrad_scene_size(CUBE, 0);
    OWNED void *block = block_of(size), *small = block_of(MOST);
    const fibrad_light light = {.direction = {.1, .2, -1}, .flux = 1, .half_angle = .1, .directions = 3};
    const fibrad_scene *scene = crowded_scene(block, size);
    const size_t bytes = fibrad_heat_size(&heat_config, scene);
    OWNED void *heat_block = block_of(bytes);
    fibrad_heat *heat;
    assert_ok(fibrad_heat_init(&heat, heat_block, bytes, &heat_config, scene));
    const size_t patches = fibrad_heat_patches(heat) * sizeof(double);
    OWNED double *hits = malloc(patches);
    int failed = 0, status = FIBRAD_E_WORK;
    for (size_t room = STEP; status != FIBRAD_OK && room <= MOST; room += STEP) {
        fibrad_work work = work_fixed(small, room);
        fibrad_light_ends kept;
        memset(&kept, 0xEE, sizeof kept), memset(hits, 0xEE, patches);
        status = fibrad_heat_shine(heat, &work, &light, 0, hits, &kept, NULL);
        if (status == FIBRAD_OK) break;
        ck_assert_int_eq(status, FIBRAD_E_WORK);
        ck_assert(is_all(&kept, sizeof kept, 0xEE) && is_all(hits, patches, 0xEE));
        failed++;
    }
    assert_ok(status);
    ck_assert_int_gt(failed, 1);
}

/* No light comes into a closed box. All calls say so, and write nothing. */
TEST(light_of_a_closed_box) {
    const double x = 0, r = 1;
    const fibrad_spheres spheres = {.x = &x, .y = &x, .z = &x, .r = &r, .n = 1};
    const fibrad_light light = along(0, 0, -1);
    const size_t size = fibrad_scene_size(1, 0);
    OWNED void *block = block_of(size);
    OWNED_WORK work = work_growing();
    fibrad_wall wall[6];
    for (int k = 0; k < 6; k++) wall[k] = plane_at(k / 2, k % 2, k % 2 ? 2 : -2);
    const fibrad_scene_config config = {.wall = wall, .walls = 6};
    fibrad_scene *scene;
    fibrad_heat *heat;
    fibrad_light_ends ends;
    fibrad_fault fault = {0};
    assert_ok(fibrad_scene_init(&scene, block, size, &config, &spheres, NULL));
    memset(&ends, 0xEE, sizeof ends);
    assert_invalid(fibrad_light_empty(scene, &work, &light, &ends, &fault));
    ck_assert_int_eq(fault.why, FIBRAD_WHY_DARK);
    const size_t bytes = fibrad_heat_size(&heat_config, scene);
    OWNED void *heat_block = block_of(bytes);
    assert_ok(fibrad_heat_init(&heat, heat_block, bytes, &heat_config, scene));
    const size_t patches = fibrad_heat_patches(heat);
    OWNED double *hits = calloc(patches, sizeof *hits), *none = calloc(patches, sizeof *hits);
    assert_invalid(fibrad_heat_shine(heat, &work, &light, 0, hits, &ends, NULL));
    ck_assert(is_all(&ends, sizeof ends, 0xEE));
    ends = (fibrad_light_ends){0};
    assert_ok(fibrad_heat_shine_walls(heat, &work, NULL, 0, &ends, hits));
    ck_assert_mem_eq(hits, none, patches * sizeof *hits);
}
