/* test_row_parts.c - rows computed in parts, each a range of directions, have the bits of rows in one.
 * SPDX-License-Identifier: MIT */
#include "fibrad_part.h"
#include "suite.h"
#include "scenes.h"
#include "meshes.h"

enum { PARTS_MOST = 7, SPHERES = 400 };

/* Row i in so many parts of unequal size, computed from the last to the first. */
static int row_in_parts(const fibrad_scene *scene, uint32_t i, const fibrad_beam_rule *rule, uint32_t parts,
                        fibrad_row *row) {
    fibrad_work first = work_growing(), second = work_growing();
    fibrad_row_part part[PARTS_MOST];
    for (uint32_t p = parts; p-- > 0;) {
        part[p] = (fibrad_row_part){.memory = memory_growing()};
        const uint32_t from = rule->directions * p * p / (parts * parts);
        const uint32_t to = rule->directions * (p + 1) * (p + 1) / (parts * parts);
        ck_assert_int_eq(fibrad_beam_part(scene, p % 2 == 0 ? &first : &second, i, rule, from, to, &part[p]),
                         FIBRAD_OK);
    }
    const int status = fibrad_beam_join(scene, &second, i, rule, part, parts, row);
    for (uint32_t p = 0; p < parts; p++) free(part[p].memory.block);
    work_free(&first);
    work_free(&second);
    return status;
}

/* Rows of a large, a small and the last sphere, in one and in parts; adds what spheres get and what bodies get. */
static void compare_rows(const struct bed *bed, const fibrad_scene_config *config, double cutoff, double seen[2]) {
    fibrad_scene *scene = scene_with(bed, config);
    fibrad_work work = work_growing();
    fibrad_row one = row_of(bed->n), joined = row_of(bed->n);
    const uint32_t rows[] = {0, bed->n / 2, bed->n - 1};
    for (int k = 0; k < 18; k++) {
        const uint32_t i = rows[k % 3], parts = 1 + (uint32_t)k % PARTS_MOST;
        const fibrad_beam_rule rule = {
            .directions = 50 + (uint32_t)k, .points = k % 2 == 0 ? 0 : 64, .cutoff = cutoff, .turn = k < 9 ? 0 : 5};
        ck_assert_int_eq(fibrad_beam_row(scene, &work, i, &rule, &one), FIBRAD_OK);
        ck_assert_int_eq(row_in_parts(scene, i, &rule, parts, &joined), FIBRAD_OK);
        ck_assert(same_bits_with(&one, &joined, config->bodies));
        ck_assert_uint_eq(joined.directions, rule.directions);
        ck_assert_uint_eq(joined.fallbacks, one.fallbacks);
        ck_assert_uint_eq(joined.sphere, i);
        seen[0] += row_sum(&one);
        for (uint32_t b = 0; b < config->bodies; b++) seen[1] += one.body[b];
    }
    row_free(&one);
    row_free(&joined);
    work_free(&work);
    free(scene);
}

START_TEST(spheres_alone) {
    struct bed bed = strewn(SPHERES, 3), box = packing(120, .8, 1.2, .55, 4, true);
    double seen[2] = {0, 0};
    compare_rows(&bed, &(fibrad_scene_config){0}, 0, seen);
    compare_rows(&bed, &(fibrad_scene_config){0}, .5, seen);
    compare_rows(&box, &(fibrad_scene_config){0}, 0, seen);
    ck_assert_double_gt(seen[0], 20);
    bed_free(&bed);
    bed_free(&box);
}
END_TEST

START_TEST(among_walls) {
    struct bed bed = strewn(SPHERES, 5);
    const fibrad_body planes[] = {plane_at(0, 0, -.3), plane_at(0, 1, 1.3), plane_at(1, 0, -.3),
                                  plane_at(1, 1, 1.3), plane_at(2, 0, -.3), plane_at(2, 1, 1.3)};
    const fibrad_body tube[] = {cylinder_at(.5, .5, 1.2), plane_at(2, 0, -.3)};
    double seen[2] = {0, 0};
    compare_rows(&bed, &(fibrad_scene_config){.body = planes, .bodies = 6}, 0, seen);
    compare_rows(&bed, &(fibrad_scene_config){.body = planes + 4, .bodies = 2}, 0, seen);
    compare_rows(&bed, &(fibrad_scene_config){.body = planes, .bodies = 6}, .5, seen);
    compare_rows(&bed, &(fibrad_scene_config){.body = tube, .bodies = 2}, 0, seen);
    ck_assert_double_gt(seen[1], 20);
    bed_free(&bed);
}
END_TEST

START_TEST(among_triangles) {
    struct bed bed = strewn(SPHERES, 6);
    struct mesh *mesh = mesh_new();
    double seen[2] = {0, 0};
    mesh_box(mesh, (const double[]){-.3, -.3, -.3}, (const double[]){1.3, 1.3, 1.3}, 0);
    mesh_tube(mesh, .5, .5, .05, -.2, 1.2, 12, 3, true, 6, 6);
    compare_rows(&bed, &(fibrad_scene_config){.body = mesh->body, .bodies = 7, .triangles = &mesh->triangles}, 0, seen);
    ck_assert_double_gt(seen[1], 10);
    free(mesh);
    bed_free(&bed);
}
END_TEST

/* Parts of another row, rule or scene, in another order or not all are told from those that make the row. */
START_TEST(parts_that_do_not_fit) {
    struct bed bed = strewn(50, 7), other_bed = strewn(50, 8);
    fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST), *other = scene_of(&other_bed, FIBRAD_ISA_BEST);
    fibrad_work work = work_growing();
    fibrad_row row = row_of(50);
    const fibrad_beam_rule rule = {.directions = 20}, more = {.directions = 21};
    const fibrad_beam_rule tolerant = {.directions = 20, .tolerance = 1e-3};
    fibrad_row_part part[2] = {{.memory = memory_growing()}, {.memory = memory_growing()}};
    ck_assert_int_eq(fibrad_beam_join(scene, &work, 1, &rule, part, 2, &row), FIBRAD_E_STATE);
    for (uint32_t p = 0; p < 2; p++)
        ck_assert_int_eq(fibrad_beam_part(scene, &work, 1, &rule, 10 * p, 10 * p + 10, &part[p]), FIBRAD_OK);
    ck_assert_int_eq(fibrad_beam_join(scene, &work, 2, &rule, part, 2, &row), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_beam_join(scene, &work, 1, &more, part, 2, &row), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_beam_join(other, &work, 1, &rule, part, 2, &row), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_beam_join(scene, &work, 1, &rule, part, 1, &row), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_beam_join(scene, &work, 1, &rule, part + 1, 1, &row), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_beam_join(scene, &work, 1, &rule, NULL, 2, &row), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_beam_join(NULL, &work, 1, &rule, part, 2, &row), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_beam_join(scene, &work, 1, &tolerant, part, 2, &row), FIBRAD_E_UNSUPPORTED);
    ck_assert_int_eq(fibrad_beam_join(scene, &work, 1, &rule, part, 2, &row), FIBRAD_OK);
    ck_assert_int_eq(fibrad_beam_part(scene, &work, 1, &rule, 5, 5, &part[0]), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_beam_part(scene, &work, 1, &rule, 5, 21, &part[0]), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_beam_part(scene, &work, 50, &rule, 5, 9, &part[0]), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_beam_part(scene, &work, 1, &rule, 5, 9, NULL), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_beam_part(NULL, &work, 1, &rule, 5, 9, &part[0]), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_beam_part(scene, &work, 1, &tolerant, 5, 9, &part[0]), FIBRAD_E_UNSUPPORTED);
    for (int p = 0; p < 2; p++) free(part[p].memory.block);
    work_free(&work);
    row_free(&row);
    free(scene);
    free(other);
    bed_free(&bed);
    bed_free(&other_bed);
}
END_TEST

/* Fixed memory that is too small says how much would do. */
START_TEST(fixed_memory_of_a_part) {
    struct bed bed = strewn(50, 9);
    fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    fibrad_work work = work_growing();
    const fibrad_beam_rule rule = {.directions = 20};
    fibrad_row_part part = {.memory = {.block = malloc(16), .size = 16}};
    ck_assert_int_eq(fibrad_beam_part(scene, &work, 1, &rule, 0, 20, &part), FIBRAD_E_CAPACITY);
    const size_t needed = part.memory.needed;
    ck_assert_uint_gt(needed, 16);
    free(part.memory.block);
    part.memory = (fibrad_memory){.block = malloc(needed), .size = needed};
    ck_assert_int_eq(fibrad_beam_part(scene, &work, 1, &rule, 0, 20, &part), FIBRAD_OK);
    free(part.memory.block);
    work_free(&work);
    free(scene);
    bed_free(&bed);
}
END_TEST

int main(void) {
    Suite *suite = suite_create("row_parts");
    TCase *tcase = suite_case(suite, "row_parts");
    tcase_add_test(tcase, spheres_alone);
    tcase_add_test(tcase, among_walls);
    tcase_add_test(tcase, among_triangles);
    tcase_add_test(tcase, parts_that_do_not_fit);
    tcase_add_test(tcase, fixed_memory_of_a_part);
    return suite_run(suite);
}
