/* test_beyond.c - what rows say of radiation if they do not know where it ends. SPDX-License-Identifier: MIT */
#include "part_beds.h"

/* A cutoff that holds the whole bed and its walls changes no bit. */
LOOP_TEST(nothing_is_beyond_what_holds_all, 2) {
    OWNED_MADE m;
    make_kind(&m, &kinds[_i]);
    for (int occupied = 0; occupied < 2; occupied++) {
        m.part.config.occupancy = occupied ? &m.occupancy : NULL;
        OWNED fibrad_scene *plain = part_scene(&m.part);
        for (uint32_t i = 3; i < m.part.n; i += 150)
            for (int method = 0; method < METHODS; method++) {
                OWNED_NAMED expected = row_by(&m.part, plain, i, method, 0);
                OWNED_NAMED cut = row_by(&m.part, plain, i, method, 99);
                ck_assert_double_eq(cut.row.beyond, 0);
                expect_same_named(&expected, &cut, m.part.ids, kinds[_i].name);
            }
    }
}

/* Whether the way along w from some length on is clear of marked cells. The steps are so small that they miss corners
 * alone. */
static bool clear_by_steps(const fibrad_occupancy *o, const double from[3], const double w[3], double begin,
                           double step) {
    for (double t = begin; t < begin + 700; t += step) {
        uint64_t cell = 0;
        bool inside = true;
        for (int axis = 3; axis-- > 0;) {
            const double size = (o->high[axis] - o->low[axis]) / o->cells[axis];
            const int64_t cells = o->cells[axis], at = (int64_t)floor((from[axis] + t * w[axis] - o->low[axis]) / size);
            inside = inside && (o->periodic[axis] || (at >= 0 && at < cells));
            if (!o->periodic[axis] && (w[axis] > 0 ? at >= cells : at < 0)) return true; /* gone */
            cell = cell * (uint64_t)cells + (uint64_t)((at % cells + cells) % cells);
        }
        if (inside && (o->mark[cell / 64] >> cell % 64 & 1) != 0) return false;
    }
    return true;
}

/* A random direction. */
static void draw_even(fibrad_random *random, double w[3]) {
    double square;
    do {
        square = 0;
        for (int axis = 0; axis < 3; axis++) w[axis] = 2 * fibrad_random_next(random) - 1, square += w[axis] * w[axis];
    } while (!(square <= 1 && square > .01));
    for (int axis = 0; axis < 3; axis++) w[axis] /= sqrt(square);
}

/* The test follows rays of its own. It tries all spheres, and looks up cells by small steps. */
LOOP_TEST(beyond_is_what_rays_say, 1) {
    OWNED_MADE m;
    make_kind(&m, &kinds[_i]); /* these beds are open or periodic, and have no walls */
    struct part *p = &m.part;
    OWNED fibrad_scene *scene = part_scene(p);
    const double cutoff = 4;
    double largest = 0;
    for (uint32_t i = 0; i < p->n; i += p->n / 7) {
        enum { RAYS = 4000 };
        const double centre[3] = {p->x[i], p->y[i], p->z[i]};
        uint32_t beyond = 0, escaped = 0;
        fibrad_random random = fibrad_random_start(8, i);
        for (int k = 0; k < RAYS; k++) {
            double n[3], w[3], square = 0;
            draw_even(&random, n);
            draw_even(&random, w);
            for (int axis = 0; axis < 3; axis++) w[axis] += n[axis], square += w[axis] * w[axis];
            double from[3], along = 0;
            for (int axis = 0; axis < 3; axis++) {
                w[axis] /= sqrt(square), from[axis] = centre[axis] + p->r[i] * n[axis];
                along += p->r[i] * n[axis] * w[axis];
            }
            bool hit = false;
            for (uint32_t j = 0; j < p->n && !hit; j++) {
                const double at[3] = {p->x[j], p->y[j], p->z[j]};
                double c[3], depth = 0, far = 0, off = 0;
                for (int axis = 0; axis < 3; axis++) {
                    c[axis] = way_along(p, axis, centre[axis], at[axis]);
                    far += c[axis] * c[axis], depth += c[axis] * w[axis];
                }
                if (j == i || far > cutoff * cutoff || depth <= 0) continue;
                double d = 0;
                for (int axis = 0; axis < 3; axis++) d += (c[axis] - p->r[i] * n[axis]) * w[axis];
                for (int axis = 0; axis < 3; axis++) off += pow(c[axis] - p->r[i] * n[axis] - d * w[axis], 2);
                hit = off < p->r[j] * p->r[j];
            }
            if (hit) continue;
            const double ball = -along + sqrt(along * along + cutoff * cutoff - p->r[i] * p->r[i]);
            const bool clear = clear_by_steps(&m.occupancy, from, w, ball, .02);
            beyond += !clear, escaped += clear;
        }
        const double expected = beyond / (double)RAYS, sky = escaped / (double)RAYS;
        for (int method = 0; method < 4; method++) {
            const struct named_row found = row_by(p, scene, i, method, cutoff);
            /* each window has one direction, and 600 rays are few */
            const double tolerance = .015 + 3.5 * sqrt(fmax(expected, .01) / (method == 3 ? 600 : 1000));
            ck_assert_double_eq_tol(found.row.beyond, expected, tolerance);
            ck_assert_double_eq_tol(found.row.escaped, sky, tolerance);
            named_free((struct named_row *)&found);
        }
        largest = fmax(largest, fmin(expected, sky));
    }
    if (_i == 0) ck_assert_double_gt(largest, .02); /* some rows have both */
}

/* The walk through the cells is compared with small steps, which miss nothing but corners. Boxes have few marks and are
 * periodic or not. Rays begin anywhere. */
TEST(cells_are_walked_one_by_one) {
    OWNED_BED bed = BED({0, 0, 0, .1});
    OWNED_PART p = part_of(&bed, (fibrad_scene_config){0});
    fibrad_random random = fibrad_random_start(6, 1);
    int missed = 0, clear = 0, rays = 0;
    for (int round = 0; round < 150; round++) {
        const uint64_t mark[2] = {UINT64_C(1) << round % 64 | UINT64_C(1) << (round * 37 + 11) % 64,
                                  UINT64_C(1) << round * 5 % 56};
        const fibrad_occupancy o = {.low = {-1, 2, -3},
                                    .high = {3, 4.5, 3},
                                    .cells = {4, 5, 6},
                                    .periodic = {round & 1, round >> 1 & 1, round >> 2 & 1},
                                    .mark = mark};
        p.config.occupancy = &o;
        OWNED fibrad_scene *scene = part_scene(&p);
        for (int k = 0; k < 20; k++) {
            double from[3], w[3], distance;
            draw_even(&random, w);
            for (int axis = 0; axis < 3; axis++) {
                from[axis] = 30 * (fibrad_random_next(&random) - .5);
                if (o.periodic[axis] && k % 4 == 0) from[axis] += 1024 * (o.high[axis] - o.low[axis]);
            }
            const double begin = 10 * fibrad_random_next(&random);
            /* the ray begins at the ball */
            const uint32_t met = fibrad_surroundings_met(scene, from, w, begin, &distance);
            const bool expected = clear_by_steps(&o, from, w, begin, .003);
            ck_assert(met == FIBRAD_ESCAPED || met == FIBRAD_BEYOND);
            if (!expected) ck_assert_uint_eq(met, FIBRAD_BEYOND);
            missed += expected && met == FIBRAD_BEYOND; /* corners */
            clear += expected, rays++;
        }
    }
    ck_assert_int_lt(missed, rays / 50);
    ck_assert_int_gt(clear, rays / 4);
    ck_assert_int_lt(clear, 9 * rays / 10);
    /* no cell is marked: the way is clear where the box ends, and unknown along axes where it never ends */
    for (int which = 0; which < 8; which++) {
        const fibrad_occupancy none = {.high = {1, 1, 1},
                                       .cells = {2, 2, 2},
                                       .periodic = {which & 1, which >> 1 & 1, which >> 2 & 1},
                                       .mark = (const uint64_t[]){0}};
        p.config.occupancy = &none;
        OWNED fibrad_scene *scene = part_scene(&p);
        double distance;
        for (int axis = 0; axis < 3; axis++) {
            const double w[3] = {axis == 0, axis == 1 ? -1 : 0, axis == 2}, from[3] = {.3, .3, .3};
            const uint32_t met = fibrad_surroundings_met(scene, from, w, 0, &distance);
            ck_assert_uint_eq(met, none.periodic[axis] ? FIBRAD_BEYOND : FIBRAD_ESCAPED);
        }
    }
}

/* One sphere that flies far above a bed must not hide the sky from the spheres at the top. */
TEST(a_flying_sphere_leaves_the_sky) {
    OWNED_BED bed = packing(700, .6, 1, .5, 11, true);
    const double side = bed.period[0];
    bed.period[2] = 0;
    add_sphere(&bed, side / 2, side / 2, 100, 1);
    OWNED_PART p = part_of(&bed, (fibrad_scene_config){0});
    const fibrad_occupancy o = occupancy_of(&p, (double[3]){0, 0, -1}, (double[3]){side, side, 101.5}, 128);
    fibrad_scene *told;
    OWNED fibrad_scene *untold = part_scene(&p);
    p.config.occupancy = &o;
    told = part_scene(&p);
    uint32_t top = 0;
    for (uint32_t i = 0; i < p.n - 1; i++)
        if (p.z[i] > p.z[top]) top = i;
    for (int method = 0; method < METHODS; method++) {
        OWNED_NAMED all = row_by(&p, told, top, method, 0), cut = row_by(&p, told, top, method, 5);
        OWNED_NAMED lost = row_by(&p, untold, top, method, 5);
        ck_assert_double_gt(all.row.escaped, .3);
        ck_assert_double_lt(cut.row.escaped, all.row.escaped + .02);
        ck_assert_double_gt(cut.row.escaped, .7 * all.row.escaped); /* it lacks what leaves through cells of the bed */
        ck_assert_double_lt(lost.row.escaped, .05);
        ck_assert_double_gt(lost.row.beyond, .8 * all.row.escaped);
    }
    free(told);
    free((void *)(uintptr_t)o.mark);
}

/* A flat bed above a floor keeps its sky. Lines of windows that look along the bed have directions of their own, of
 * which some pass through nearer spheres into the bed. */
TEST(a_cutoff_leaves_the_sky_of_a_flat_bed) {
    OWNED_BED bed = packing(700, .6, 1, .5, 11, true);
    const double side = bed.period[0];
    bed.period[2] = 0;
    const fibrad_wall floor = plane_at(2, 0, -1);
    OWNED_PART p = part_of(&bed, (fibrad_scene_config){.wall = &floor, .walls = 1});
    const fibrad_occupancy o = occupancy_of(&p, (double[3]){0, 0, -1}, (double[3]){side, side, side + 1}, 128);
    p.config.occupancy = &o;
    fibrad_scene *scene = part_scene(&p);
    double sky[2] = {0}, beyond = 0;
    for (uint32_t i = 0; i < p.n; i++)
        for (int cut = 0; cut < 2; cut++) {
            OWNED_NAMED row = row_by(&p, scene, i, 0, cut ? 20 : 0);
            sky[cut] += row.row.escaped, beyond += row.row.beyond;
        }
    ck_assert_double_eq_tol(sky[1] / sky[0], 1, 3e-3);
    ck_assert_double_lt(beyond / sky[0], 3e-3);
    free(scene);
    free((void *)(uintptr_t)o.mark);
}
