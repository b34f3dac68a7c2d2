/* test_part.c - the rows of divided beds are those of the whole bed. SPDX-License-Identifier: MIT */
#include "part_beds.h"

static double radius_most(const struct part *p) {
    double most = 0;
    for (uint32_t i = 0; i < p->n; i++) most = fmax(most, p->r[i]);
    return most;
}

static double distance_of(const struct part *p, uint32_t i, uint32_t j) {
    return sqrt(pow(way_along(p, 0, p->x[i], p->x[j]), 2) + pow(way_along(p, 1, p->y[i], p->y[j]), 2) +
                pow(way_along(p, 2, p->z[i], p->z[j]), 2));
}

/* Makes a part with the spheres within some distance of sphere i, in an order of its own. */
static struct part part_near(const struct part *p, uint32_t i, double distance, uint32_t *own) {
    struct part near = part_room(p, p->n);
    for (uint32_t pass = 2; pass-- > 0;)
        for (uint32_t j = p->n; j-- > 0;) {
            if (p->id[j] % 2 != pass || distance_of(p, i, j) > distance) continue;
            if (j == i) *own = near.n;
            part_add(&near, p->x[j], p->y[j], p->z[j], p->r[j], p->id[j]);
        }
    return near;
}

/* Rows depend on what is near alone, to the bit, whatever else there is and in whatever order. */
LOOP_TEST(rows_depend_on_what_is_near, KINDS) {
    OWNED_MADE m;
    make_kind(&m, &kinds[_i]);
    OWNED fibrad_scene *whole = part_scene(&m.part);
    const double cutoffs[] = {2.5, 4.25};
    for (uint32_t i = 0; i < m.part.n; i += m.part.n / (m.mesh ? 2 : 5))
        for (int c = 0; c < 2; c++) {
            const double reach = (cutoffs[c] + radius_most(&m.part)) * (1 + 1e-9);
            uint32_t own = UINT32_MAX, again = UINT32_MAX;
            OWNED_PART near = part_near(&m.part, i, reach, &own), far = part_near(&m.part, i, 1.4 * reach, &again);
            ck_assert_uint_lt(near.n, m.part.n);
            OWNED fibrad_scene *little = part_scene(&near), *more = part_scene(&far);
            for (int method = 0; method < METHODS; method++) {
                const char *what = formatted("%s, method %d, sphere %u", kinds[_i].name, method, i);
                OWNED_NAMED expected = row_by(&m.part, whole, i, method, cutoffs[c]);
                OWNED_NAMED found = row_by(&near, little, own, method, cutoffs[c]);
                OWNED_NAMED larger = row_by(&far, more, again, method, cutoffs[c]);
                expect_same_named(&expected, &found, m.part.ids, what);
                expect_same_named(&expected, &larger, m.part.ids, what);
            }
        }
}

/* A periodic bed is compared with an open one that has images of the same ids. Coordinates have few digits, so that
 * images are where they should be to the bit. The sum of the factors to all images of a sphere is the factor to this
 * sphere: counts of points to the bit, sums of paths to rounding. */
TEST(images_are_spheres_of_the_same_id) {
    OWNED_MADE m;
    make_kind(&m, &kinds[4]);
    struct part *p = &m.part;
    double *const of_axis[3] = {p->x, p->y, p->z};
    for (int axis = 0; axis < 3; axis++) {
        p->config.period[axis] = ldexp(round(ldexp(p->config.period[axis], 10)), -10);
        m.occupancy.high[axis] = p->config.period[axis];
        for (uint32_t i = 0; i < p->n; i++)
            of_axis[axis][i] = fmod(ldexp(round(ldexp(of_axis[axis][i], 20)), -20), p->config.period[axis]);
    }
    OWNED fibrad_scene *periodic = part_scene(p);
    const double cutoff = .7 * p->config.period[0], reach = cutoff + radius_most(p) + 1e-6; /* some spheres twice */
    for (uint32_t i = 0; i < p->n; i += 150) {
        OWNED_PART images = part_room(p, 27 * p->n);
        memset(images.config.period, 0, sizeof images.config.period);
        uint32_t own = UINT32_MAX;
        for (uint32_t j = 0; j < p->n; j++)
            for (int k = 26; k >= 0; k--) {
                const double x = p->x[j] + (k % 3 - 1) * p->config.period[0];
                const double y = p->y[j] + (k / 3 % 3 - 1) * p->config.period[1];
                const double z = p->z[j] + (k / 9 - 1) * p->config.period[2];
                if (sqrt(pow(x - p->x[i], 2) + pow(y - p->y[i], 2) + pow(z - p->z[i], 2)) > reach) continue;
                if (j == i && k == 13) own = images.n;
                part_add(&images, x, y, z, p->r[j], p->id[j]);
            }
        OWNED fibrad_scene *open = part_scene(&images);
        for (int method = 1; method < METHODS; method++) {
            OWNED_NAMED expected = row_by(p, periodic, i, method, cutoff);
            OWNED_NAMED found = row_by(&images, open, own, method, cutoff);
            const double count = method == 1 ? 55 * 64 : method == 2 ? 34 * 256 : 600;
            for (uint32_t id = 0; id < p->ids; id++) {
                ck_assert_double_eq_tol(expected.by_id[id], found.by_id[id], 2e-15);
                if (method < 4) ck_assert(llround(expected.by_id[id] * count) == llround(found.by_id[id] * count));
            }
            ck_assert(fabs(expected.row.escaped - found.row.escaped) <= (method < 4 ? 0 : 2e-15));
            ck_assert(fabs(expected.row.beyond - found.row.beyond) <= (method < 4 ? 0 : 2e-15));
            if (method != 7) ck_assert_uint_eq(expected.rays, found.rays); /* errors of images are their own */
        }
    }
}

/* Rays meet triangles beyond the cutoff if no sphere is on the way. */
TEST(far_triangles_are_met) {
    OWNED_BED bed = BED({0, 0, 0, 1});
    OWNED struct mesh *mesh = mesh_new();
    mesh_box(mesh, (const double[]){-30, -20, -10}, (const double[]){40, 50, 60}, 0);
    const fibrad_scene_config config = {.wall = mesh->wall, .walls = 6, .triangles = &mesh->triangles};
    OWNED_PART alone = part_of(&bed, config);
    OWNED fibrad_scene *scene = part_scene(&alone);
    /* the last method takes as many paths as its tolerance needs: some come back from afar, or end beyond the cutoff */
    for (int method = 0; method < METHODS - 1; method++) {
        OWNED_NAMED all = row_by(&alone, scene, 0, method, 0), cut = row_by(&alone, scene, 0, method, 3);
        expect_same_named(&all, &cut, 1, "box");
    }
}

/* Triangles repeat where spheres do not. They give what their copies give. */
TEST(triangles_repeat_alone) {
    OWNED_BED bed = BED({.3, .4, 0, .45});
    double seen[2][METHODS];
    enum { FAR = 40 };
    for (int copies = 0; copies < 2; copies++) {
        OWNED struct mesh *mesh = mesh_new();
        for (int x = copies ? -FAR : 0; x <= (copies ? FAR : 0); x++)
            for (int y = copies ? -FAR : 0; y <= (copies ? FAR : 0); y++) {
                uint32_t v[4];
                for (int k = 0; k < 4; k++) v[k] = mesh_vertex(mesh, x + (k == 1 || k == 2) * .5, y + (k > 1) * .5, -1);
                mesh_quad(mesh, v, 0, FIBRAD_NO_WALL);
            }
        for (int axis = 0; axis < 2 && !copies; axis++) mesh->triangles.period[axis] = 1;
        OWNED_PART p =
            part_of(&bed, (fibrad_scene_config){.wall = mesh->wall, .walls = 1, .triangles = &mesh->triangles});
        OWNED fibrad_scene *scene = part_scene(&p);
        for (int method = 0; method < METHODS; method++) {
            OWNED_NAMED row = row_by(&p, scene, 0, method, 0);
            seen[copies][method] = row.row.wall[0];
        }
    }
    for (int method = 0; method < METHODS; method++) {
        ck_assert_double_gt(seen[0][method], method < 4 ? .1 : .03);
        ck_assert_double_eq_tol(seen[0][method], seen[1][method], .01); /* up to spheres farther away than FAR */
    }
}

/* Lattices have spheres at equal depth, and paths that meet two spheres at once. Ids decide between them, not the
 * order. */
LOOP_TEST(ids_decide_among_equals, 3) {
    static const char lattices[] = {'p', 'i', 'f'};
    OWNED_BED bed = lattice(lattices[_i], 4.1);
    for (uint32_t i = 0; i < bed.n; i++) bed.x[i] *= .9375, bed.y[i] *= .9375, bed.z[i] *= .9375;
    OWNED_PART p = part_of(&bed, (fibrad_scene_config){0});
    OWNED fibrad_scene *scene = part_scene(&p);
    for (uint32_t i = 0; i < p.n; i += 3) {
        uint32_t own = UINT32_MAX;
        OWNED_PART shuffled = part_near(&p, i, 100, &own);
        ck_assert(shuffled.n == p.n && memcmp(shuffled.id, p.id, p.n * sizeof *p.id) != 0);
        OWNED fibrad_scene *other = part_scene(&shuffled);
        for (int method = 0; method < METHODS; method++) {
            OWNED_NAMED expected = row_by(&p, scene, i, method, 0);
            OWNED_NAMED found = row_by(&shuffled, other, own, method, 0);
            expect_same_named(&expected, &found, p.ids, "lattice");
        }
    }
}

/* Turned rows err in all directions. Their mean over many turns comes to the fine row, and each is off by as much as it
 * says. */
LOOP_TEST(turned_rows_average_to_the_fine_one, 3) {
    enum { TURNS = 300 };
    OWNED_BED bed = packing(120, .5, 1, .45, 4, false);
    const fibrad_wall floor_below = plane_at(2, 0, -1);
    const fibrad_scene_config config = {.wall = &floor_below, .walls = _i < 2 ? 1 : 0};
    OWNED fibrad_scene *scene = scene_with(&bed, &config);
    OWNED_WORK work = work_growing();
    const uint32_t points = _i % 2 ? 256 : 0;
    for (uint32_t i = 0; i < bed.n; i += 50) {
        OWNED_ROW fine = row_of(bed.n), row = row_of(bed.n), mean = row_of(bed.n);
        double wall = 0, escaped = 0, square = 0, estimate = 0;
        int less = 0;
        assert_ok(fibrad_beam_row(scene, &work, i, &(fibrad_beam_rule){.directions = 20000}, &fine));
        for (uint32_t j = 0; j < bed.n; j++) mean.col[j] = j;
        mean.length = bed.n;
        for (uint64_t turn = 1; turn <= TURNS; turn++) {
            const fibrad_beam_rule rule = {.directions = 50, .points = points, .turn = turn};
            assert_ok(fibrad_beam_row(scene, &work, i, &rule, &row));
            for (uint32_t k = 0; k < row.length; k++) mean.f[row.col[k]] += row.f[k] / TURNS;
            wall += row.wall[0] / TURNS, escaped += row.escaped / TURNS;
            const double off = row_distance(&row, &fine);
            square += off * off / TURNS, estimate += row.error * row.error / TURNS;
            less += row.error < off;
        }
        const double typical = sqrt(square), ratio = sqrt(estimate) / typical;
        ck_assert_double_lt(row_distance(&mean, &fine), 4 * typical / sqrt(TURNS) + 1e-3);
        ck_assert_double_lt(row_distance(&mean, &fine), .35 * typical);
        ck_assert_double_eq_tol(wall, fine.wall[0], 5e-3); /* sharing in bands has an error of about 1/directions */
        ck_assert_double_eq_tol(escaped, fine.escaped, 5e-3);
        ck_assert_msg(ratio > 1 && ratio < 4, "estimate over error: %g", ratio);
        ck_assert_int_lt(less, TURNS / 10);
    }
}

/* A sphere between a floor and a periodic layer that hides all above. What it sends down reaches the floor, and next to
 * nothing escapes. */
LOOP_TEST(a_sphere_below_a_periodic_layer, 2) {
    OWNED_BED bed = BED({4, 4, 2.5, 1});
    for (int k = 0; k < 32; k++) add_sphere(&bed, 2 * (k % 4) + 1, 2 * (k / 4 % 4) + 1, 9 + 2 * (k / 16), 1.005);
    for (int k = 0; k < 16; k++) add_sphere(&bed, 2 * (k % 4), 2 * (k / 4), 10 - 1e-3, .41);
    const fibrad_wall floor_below = plane_at(2, 0, 0);
    OWNED fibrad_scene *scene =
        scene_with(&bed, &(fibrad_scene_config){.period = {8, 8}, .wall = &floor_below, .walls = 1});
    OWNED_WORK work = work_growing();
    OWNED_ROW fine = row_of(bed.n), row = row_of(bed.n);
    assert_ok(fibrad_beam_row(scene, &work, 0, &(fibrad_beam_rule){.directions = 20000}, &fine));
    double mean = 0, escaped = 0;
    const uint32_t directions = _i ? 144 : 60;
    for (uint64_t turn = 1; turn <= 100; turn++) {
        assert_ok(fibrad_beam_row(scene, &work, 0, &(fibrad_beam_rule){.directions = directions, .turn = turn}, &row));
        ck_assert_double_eq_tol(row.wall[0], fine.wall[0], 6. / directions);
        mean += row.wall[0] / 100, escaped += row.escaped / 100;
    }
    ck_assert_double_eq_tol(mean, fine.wall[0], 3e-3);
    ck_assert_double_eq_tol(escaped, fine.escaped, 1e-3);
}
