/* test_scene.c - scenes: sizes, faults, and searches in the grid against trying all spheres.
 * SPDX-License-Identifier: MIT */
#include "scene/grid_walk.h"
#include "scenes.h"
#include "suite.h"

/* Sizes hold at each offset of the block: a byte less is too little, nothing is written beside the block, and rows have
 * the same bits. */
TEST(sizes_hold) {
    static unsigned char memory[64 + FIBRAD_SCENE_BYTES(500) + 64];
    for (uint32_t n = 0; n <= 500; n += n < 40 ? 1 : 53) {
        const size_t size = fibrad_scene_size(n, 0), offset = n * 7 % 64;
        ck_assert_uint_gt(size, 0);
        ck_assert_uint_le(size, FIBRAD_SCENE_BYTES(n));
        ck_assert_uint_gt(fibrad_scene_size(n, 1), n == 0 ? 0 : size);
        ck_assert_uint_ge(fibrad_scene_size(n, 1), size);
        OWNED_BED bed = packing(n > 0 ? n : 1, .5, 1, .4, n, false);
        bed.n = n;
        const fibrad_spheres spheres = spheres_of(&bed);
        fibrad_scene *scene = NULL;
        memset(memory, 0xa5, sizeof memory);
        ck_assert_int_eq(fibrad_scene_init(&scene, memory + offset, size - 1, NULL, &spheres, NULL), FIBRAD_E_SIZE);
        ck_assert_int_eq(fibrad_scene_init(&scene, memory + offset, 0, NULL, &spheres, NULL), FIBRAD_E_SIZE);
        ck_assert_ptr_null(scene);
        ck_assert(bytes_are(memory, 0, sizeof memory, 0xa5));
        assert_ok(fibrad_scene_init(&scene, memory + offset, size, NULL, &spheres, NULL));
        ck_assert(bytes_are(memory, 0, offset, 0xa5));
        ck_assert(bytes_are(memory, offset + size, sizeof memory, 0xa5));
    }
    ck_assert_uint_eq(fibrad_scene_size(FIBRAD_SPHERES_MAX + 1, 0), 0);
    ck_assert_uint_eq(fibrad_scene_size(UINT32_MAX, 1), 0);
    if (sizeof(size_t) > 4) ck_assert_uint_gt(fibrad_scene_size(FIBRAD_SPHERES_MAX, 1), FIBRAD_SPHERES_MAX * 52.);
}

/* Against all pairs. Each third sphere has the id of the one before: images of one are no pair. */
TEST(spheres_inside_others_are_found) {
    OWNED_BED bed = packing(400, .5, 1, .4, 7, false);
    uint64_t id[400];
    for (uint32_t i = 0; i < bed.n; i++) id[i] = i - (i % 3 == 2), bed.r[i] *= 1 + 3 * (i % 50 == 0);
    fibrad_spheres spheres = spheres_of(&bed);
    spheres.id = id;
    const size_t size = fibrad_scene_size(bed.n, 1);
    OWNED unsigned char *block = block_of(size);
    double part[400];
    uint32_t other[400], some = 0;
    assert_ok(fibrad_spheres_inside(&spheres, block, size, part, other, NULL));
    for (uint32_t i = 0; i < bed.n; i++) {
        double least = 1;
        for (uint32_t j = 0; j < bed.n; j++)
            if (id[j] != id[i])
                least = fmin(least, hypot(hypot(bed.x[j] - bed.x[i], bed.y[j] - bed.y[i]), bed.z[j] - bed.z[i]) /
                                        fmax(bed.r[i], bed.r[j]));
        ck_assert_double_eq_tol(part[i], least, 2e-9);
        ck_assert((other[i] == bed.n) == (part[i] == 1));
        some += part[i] < 1;
    }
    ck_assert(some > 20 && some < 380);
    fibrad_scene *scene;
    ck_assert_int_eq(fibrad_scene_init(&scene, block, size, NULL, &spheres, NULL), FIBRAD_E_GEOMETRY);
    for (uint32_t i = 0; i < bed.n; i++) bed.r[i] *= part[i];
    assert_ok(fibrad_spheres_inside(&spheres, block, size, part, other, NULL));
    for (uint32_t i = 0; i < bed.n; i++) ck_assert_double_eq_tol(part[i], 1, 1e-8);
    fibrad_fault fault;
    for (uint32_t i = 0; i < bed.n; i++) bed.r[i] = i == 9 ? 1e9 : 1e3;
    ck_assert_int_eq(fibrad_spheres_inside(&spheres, block, size, part, other, &fault), FIBRAD_E_GEOMETRY);
    ck_assert(fault.first < bed.n && fault.second == fault.first);
    part[3] = 7, other[3] = 8; /* other errors leave the outputs as before */
    ck_assert_int_eq(fibrad_spheres_inside(&spheres, block, size - 1, part, other, &fault), FIBRAD_E_SIZE);
    for (int k = 0; k < 3; k++) {
        bed.r[9] = k ? 1 : NAN, bed.x[9] = k == 1 ? NAN : 1e300;
        assert_invalid(fibrad_spheres_inside(&spheres, block, size, part, other, &fault));
        ck_assert(part[3] == 7 && other[3] == 8);
    }
}

/* Places are x[n][3] and radii are every fifth number. They give what arrays of their own give. */
TEST(strides_change_no_bit) {
    OWNED_BED bed = packing(150, .5, 1, .4, 3, false);
    OWNED double(*at)[3] = calloc(bed.n, sizeof *at), *r = calloc((size_t)5 * bed.n, sizeof *r);
    for (uint32_t k = 0; k < 5 * bed.n; k++) r[k] = NAN;
    for (uint32_t i = 0; i < bed.n; i++) at[i][0] = bed.x[i], at[i][1] = bed.y[i], at[i][2] = bed.z[i];
    for (uint32_t i = 0; i < bed.n; i++) r[(size_t)5 * i] = bed.r[i];
    OWNED fibrad_scene *plain = scene_of(&bed, 0);
    const fibrad_spheres strided[] = {
        {&at[0][0], &at[0][1], &at[0][2], r, bed.n, .stride = 3, .stride_r = 5},
        {&at[0][0], &at[0][1], &at[0][2], bed.r, bed.n, .stride = 3},
        {bed.x, bed.y, bed.z, r, bed.n, .stride_r = 5},
        {bed.x, bed.y, bed.z, bed.r, bed.n, .stride = 1, .stride_r = 1},
    };
    OWNED_MATRIX expected = matrix_by_beams(plain, &(fibrad_beam_rule){.directions = 34}, true);
    const size_t size = fibrad_scene_size(bed.n, 0);
    OWNED void *block = block_of(size);
    for (int k = 0; k < 4; k++) {
        fibrad_scene *scene = NULL;
        assert_ok(fibrad_scene_init(&scene, block, size, NULL, &strided[k], NULL));
        OWNED_MATRIX m = matrix_by_beams(scene, &(fibrad_beam_rule){.directions = 34}, true);
        ck_assert(matrix_same_bits(&m.factors, &expected.factors));
        for (uint32_t s = 0; s < bed.n; s++)
            ck_assert_uint_eq(fibrad_scene_sphere(scene, s), fibrad_scene_sphere(plain, s));
    }
}

/* A bed may be empty: this is a scene without rows, and a matrix without rows. */
TEST(a_scene_may_be_empty) {
    static unsigned char memory[FIBRAD_SCENE_BYTES(0)];
    const fibrad_spheres none = {.n = 0};
    const fibrad_wall floor_plane = plane_at(2, 0, 0);
    for (int walls = 0; walls < 2; walls++) {
        const fibrad_scene_config config = {.wall = &floor_plane, .walls = (uint32_t)walls, .period = {3, 0, 0}};
        fibrad_scene *scene = NULL;
        fibrad_scene_facts facts;
        assert_ok(fibrad_scene_init(&scene, memory, sizeof memory, &config, &none, NULL));
        fibrad_scene_describe(scene, &facts);
        ck_assert_uint_eq(facts.spheres, 0);
        ck_assert_uint_eq(facts.walls, (uint32_t)walls);
        ck_assert_uint_eq(facts.cells, 0);
        ck_assert(facts.radius_min == 0 && facts.radius_max == 0 && facts.overlap_max == 0);
        ck_assert_uint_eq(fibrad_scene_sphere(scene, 0), UINT32_MAX);
        OWNED_WORK work = work_growing();
        OWNED_ROW row = row_of(4);
        assert_invalid(fibrad_beam_row(scene, &work, 0, NULL, &row));
        assert_invalid(fibrad_cast_row(scene, &work, 0, NULL, &row, NULL));
        for (int raw = 0; raw < 2; raw++) {
            const fibrad_rows rows = {0};
            OWNED_MATRIX m = matrix_of(scene, &rows, 1, &(fibrad_matrix_rule){.raw = raw}), nothing;
            ck_assert_uint_eq(m.factors.n, 0);
            ck_assert_uint_eq(m.factors.start[0], 0);
            double largest = -1;
            assert_ok(fibrad_matrix_reciprocity(m.matrix, &largest));
            ck_assert_double_eq(largest, 0);
            nothing = matrix_of(scene, NULL, 0, &(fibrad_matrix_rule){.raw = raw, .drop = raw ? 0 : .1, .tasks = 3});
            ck_assert_uint_eq(nothing.factors.n, 0);
        }
    }
}

/* Each sphere comes once along the cells, and most spheres that follow each other are neighbours. On average they are
 * less than 4 radii apart in a cube of 16, where two random spheres are 11 apart. */
TEST(spheres_that_follow_each_other_are_neighbours) {
    OWNED_BED bed = packing(500, 1, 1, .5, 4, false);
    OWNED fibrad_scene *scene = scene_of(&bed, 0);
    OWNED bool *seen = calloc(bed.n, sizeof *seen);
    double sum = 0;
    for (uint32_t k = 0, last = 0; k < bed.n; k++) {
        const uint32_t i = fibrad_scene_sphere(scene, k);
        ck_assert_uint_lt(i, bed.n);
        ck_assert(!seen[i]);
        seen[i] = true;
        if (k > 0) sum += hypot(hypot(bed.x[i] - bed.x[last], bed.y[i] - bed.y[last]), bed.z[i] - bed.z[last]);
        last = i;
    }
    ck_assert_double_lt(sum / bed.n, 4);
    ck_assert_uint_eq(fibrad_scene_sphere(scene, bed.n), UINT32_MAX);
    ck_assert_uint_eq(fibrad_scene_sphere(NULL, 0), UINT32_MAX);
}

TEST(bad_configurations_are_refused) {
    static unsigned char memory[FIBRAD_SCENE_BYTES(1)];
    const double zero = 0, one = 1;
    const fibrad_spheres good = {&zero, &zero, &zero, &one, .n = 1},
                         too_many = {&zero, &zero, &zero, &one, .n = UINT32_MAX};
    fibrad_scene *scene = NULL;
    fibrad_fault fault;
    static const fibrad_scene_config bad[] = {{.isa = 99},
                                              {.isa = -1},
                                              {.isa = FIBRAD_ISA_NEON + 1},
                                              {.period = {0, -1, 0}},
                                              {.period = {0, 0, NAN}},
                                              {.period = {INFINITY, 0, 0}}};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        assert_invalid(fibrad_scene_init(&scene, memory, sizeof memory, &bad[k], &good, &fault));
        ck_assert(fault.first == 1 && fault.second == 1);
    }
    assert_invalid(fibrad_scene_init(&scene, memory, sizeof memory, NULL, &too_many, &fault));
    assert_invalid(fibrad_scene_init(NULL, memory, sizeof memory, NULL, &good, &fault));
    assert_invalid(fibrad_scene_init(&scene, NULL, sizeof memory, NULL, &good, &fault));
    assert_invalid(fibrad_scene_init(&scene, memory, sizeof memory, NULL, NULL, &fault));
    for (int missing = 0; missing < 4; missing++) {
        fibrad_spheres spheres = good;
        *(missing == 0 ? &spheres.x : missing == 1 ? &spheres.y : missing == 2 ? &spheres.z : &spheres.r) = NULL;
        assert_invalid(fibrad_scene_init(&scene, memory, sizeof memory, NULL, &spheres, &fault));
        ck_assert_uint_eq(fault.first, 1);
    }
    ck_assert_ptr_null(scene);
    assert_ok(fibrad_scene_init(&scene, memory, sizeof memory, NULL, &good, NULL));
}

/* If this build or this machine lacks an instruction set, the call says so, with any spheres. */
TEST(missing_instruction_sets_are_reported) {
    OWNED_BED bed = lattice('p', 3);
    const struct isas isas = isas_there();
    bool best = false;
    for (int set = FIBRAD_ISA_SCALAR; set <= FIBRAD_ISA_NEON; set++) {
        bool there = false;
        for (int k = 0; k < isas.count; k++) there |= isas.set[k] == set;
        best |= there && set == (int)fibrad_isa_best();
        if (set > (int)fibrad_isa_best()) ck_assert(!there);
        OWNED fibrad_scene *scene = NULL;
        fibrad_fault fault;
        ck_assert_int_eq(scene_try(&scene, &bed, &(fibrad_scene_config){.isa = set}, &fault),
                         there ? FIBRAD_OK : FIBRAD_E_ISA);
        if (!there) ck_assert_ptr_null(scene);
        if (!there) continue;
        fibrad_scene_facts facts;
        fibrad_scene_describe(scene, &facts);
        ck_assert_int_eq(facts.isa, set);
    }
    ck_assert(best);
}

static int fault_of(const struct bed *bed, fibrad_fault *fault) {
    OWNED fibrad_scene *scene = NULL;
    return scene_try(&scene, bed, NULL, fault);
}

TEST(faults_name_their_spheres) {
    fibrad_fault fault;
    static const double broken[] = {NAN, INFINITY, -INFINITY};
    for (int b = 0; b < 3; b++)
        for (int field = 0; field < 4; field++) {
            OWNED_BED bed = lattice('p', 4);
            double *fields[] = {bed.x, bed.y, bed.z, bed.r};
            fields[field][5] = broken[b];
            assert_invalid(fault_of(&bed, &fault));
            ck_assert_uint_eq(fault.first, 5);
        }
    OWNED_BED bed = lattice('p', 4);
    bed.r[7] = 0;
    assert_invalid(fault_of(&bed, &fault));
    ck_assert_uint_eq(fault.first, 7);
    bed.r[7] = -1;
    assert_invalid(fault_of(&bed, &fault));
    bed.r[7] = 1;
    bed.x[3] = bed.x[9], bed.y[3] = bed.y[9], bed.z[3] = bed.z[9]; /* equal centres */
    ck_assert_int_eq(fault_of(&bed, &fault), FIBRAD_E_GEOMETRY);
    ck_assert_uint_eq(fault.first, 3);
    ck_assert_uint_eq(fault.second, 9);
    bed.x[3] += .5, bed.r[3] = .1; /* one inside another */
    ck_assert_int_eq(fault_of(&bed, &fault), FIBRAD_E_GEOMETRY);
    bed_free(&bed);

    /* these lengths leave no room for squares, these coordinates leave no digits */
    static const double far[][4] = {{8e307, 0, 0, 1e307}, {1e151, 0, 0, 1e150}, {0, 0, 0, 1e-151}, {1e14, 0, 0, 1}};
    for (int k = 0; k < 4; k++) {
        bed = bed_of(1, &far[k]);
        assert_invalid(fault_of(&bed, &fault));
        ck_assert_uint_eq(fault.first, 0);
        bed_free(&bed);
    }
    bed = BED({0, 0, 0, 1}, {9.5, 0, 0, 1}); /* one lies inside the other across the box */
    assert_ok(fault_of(&bed, &fault));
    bed.period[0] = 10;
    ck_assert_int_eq(fault_of(&bed, &fault), FIBRAD_E_GEOMETRY);
    bed.period[0] = .5; /* a sphere is wider than its box */
    ck_assert_int_eq(fault_of(&bed, &fault), FIBRAD_E_GEOMETRY);
}

/* Coordinates lie outside the periodic box. For some of them the quotient by the period rounds up to a whole number. */
TEST(any_image_of_a_centre_will_do) {
    OWNED_BED bed = BED({2.1, 0, 0, .5}, {14.559999999999999, 3, 0, .5});
    for (int axis = 0; axis < 3; axis++) {
        OWNED_BED turned = BED({0, 0, 0, .5}, {3, 3, 3, .5});
        double *c[] = {turned.x, turned.y, turned.z};
        for (int i = 0; i < 2; i++) c[axis][i] = bed.x[i], c[(axis + 1) % 3][i] = bed.y[i];
        turned.period[axis] = 6.2299999999999995;
        free(scene_of(&turned, FIBRAD_ISA_SCALAR));
    }
    for (uint64_t k = 0; k < 20000; k++) {
        double period = 1 + floor(900 * bed_make_random(3, 3 * k)) / 100;
        double x[2] = {floor(1000 * bed_make_random(3, 3 * k + 1)) / 100, 0}, y[2] = {0, .5}, r[2] = {.1, .1};
        x[1] = x[0] + period * (1 + floor(5 * bed_make_random(3, 3 * k + 2)));
        fibrad_scene_config config = {.period = {period, 0, 0}};
        fibrad_spheres spheres = {.x = x, .y = y, .z = y, .r = r, .n = 2};
        static unsigned char memory[FIBRAD_SCENE_BYTES(2)];
        fibrad_scene *scene;
        assert_ok(fibrad_scene_init(&scene, memory, sizeof memory, &config, &spheres, NULL));
    }
}

static void expect_few_in_cells(const fibrad_scene *scene) {
    for (uint32_t c = 0; c < scene->facts.cells; c++) ck_assert_uint_le(scene->start[c + 1] - scene->start[c], 16);
}

/* A particle that a simulation has lost must not put all others into one cell. */
TEST(strays_do_not_spread_the_cells) {
    OWNED_BED bed = packing(4000, .5, .6, .5, 30, false);
    bed.x[17] = 1e6, bed.y[99] = -1e9, bed.z[3000] = 1e12;
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_SCALAR);
    expect_few_in_cells(scene);
}

TEST(overlap_is_reported) {
    OWNED_BED bed = BED({0, 0, 0, 1}, {0, 0, 5, 2}, {0, .98, 2.2, .5});
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    fibrad_scene_facts facts;
    fibrad_scene_describe(scene, &facts);
    ck_assert_double_eq(facts.overlap_max, 0);
    ck_assert_double_eq(facts.radius_min, .5);
    ck_assert_double_eq(facts.radius_max, 2);
    ck_assert_uint_eq(facts.spheres, 3);
    free(scene);
    bed.z[2] = 2.6;
    bed.y[2] = 0;
    scene = scene_of(&bed, FIBRAD_ISA_BEST);
    fibrad_scene_describe(scene, &facts);
    ck_assert_double_eq_tol(facts.overlap_max, .1 / .5, 1e-15);
    ck_assert_uint_eq(facts.overlap_pair[0] + facts.overlap_pair[1], 3);
}

/* In random boxes each sphere comes up whose centre, or an image of whose centre, lies within. None comes up twice. */
TEST(walks_find_what_is_there) {
    struct bed beds[] = {packing(500, .1, 1.6, .4, 21, false), packing(500, .5, .6, .5, 22, true), lattice('p', 5)};
    beds[1].period[1] = 0;
    uint64_t count = 0;
    for (size_t b = 0; b < 3; b++) {
        OWNED fibrad_scene *scene = scene_of(&beds[b], FIBRAD_ISA_SCALAR);
        const double *c[3] = {scene->x, scene->y, scene->z};
        double side = scene->high[0] - scene->low[0];
        for (int round = 0; round < 200; round++) {
            double low[3], high[3];
            for (int axis = 0; axis < 3; axis++) {
                low[axis] = scene->low[axis] + side * (3 * bed_make_random(1, count++) - 1.5);
                high[axis] = low[axis] + side * bed_make_random(1, count++);
            }
            for (uint32_t i = 0; i < beds[b].n; i++) {
                long expected = 1, seen = 0;
                for (int axis = 0; axis < 3; axis++) {
                    double x = c[axis][i], period = scene->period[axis];
                    if (period > 0)
                        expected *= (long)(floor((high[axis] - x) / period) - ceil((low[axis] - x) / period)) + 1;
                    else
                        expected *= x >= low[axis] && x <= high[axis];
                }
                if (i % 50 != 0 || expected == 0) continue;
                for (uint32_t l = 0; l < scene->levels; l++) {
                    fibrad_walk walk;
                    fibrad_walk_begin(&walk, scene, &scene->level[l], low, high);
                    while (fibrad_walk_next(&walk))
                        for (uint32_t j = walk.begin; j < walk.end; j++) {
                            bool in = j == i;
                            for (int axis = 0; axis < 3; axis++) {
                                double x = c[axis][j] + walk.shift[axis];
                                in = in && x >= low[axis] && x <= high[axis];
                            }
                            seen += in;
                        }
                }
                ck_assert_int_eq(seen, expected);
            }
        }
        bed_free(&beds[b]);
    }
}

/* Building takes linear time: there are never many more cells than spheres, and no cell is crowded. */
TEST(cells_follow_the_spheres) {
    static const double spans[][3] = {{1, 1, 1}, {1000, 1, 1}, {1, 1e6, 1e6}, {1e-3, 1, 1e3}};
    for (size_t s = 0; s < sizeof spans / sizeof *spans; s++) {
        OWNED_BED bed = bed_empty();
        for (uint64_t i = 0; i < 4000; i++)
            add_sphere(&bed, spans[s][0] * bed_make_random(5, 3 * i), spans[s][1] * bed_make_random(5, 3 * i + 1),
                       spans[s][2] * bed_make_random(5, 3 * i + 2), 1e-7);
        OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_SCALAR);
        ck_assert_uint_le(scene->facts.cells, 4000 + 8);
        expect_few_in_cells(scene);
    }
}

/* Fuzzing found this: rounding left both coordinates outside the box between them, and the choice of cells had no
 * end. */
TEST(one_stray_beside_equal_coordinates_ends_no_search) {
    OWNED_BED bed = BED({20, 0, 0, 1});
    for (int i = 0; i < 30; i++) add_sphere(&bed, 1.3, 2.5 * i, 0, 1);
    free(scene_of(&bed, FIBRAD_ISA_BEST));
}
