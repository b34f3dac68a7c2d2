/* test_trace.c - rays from sphere to sphere against trying all spheres one by one, and in each instruction set.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>

#include "base/dispatch.h"
#include "base/elementary.h"
#include "base/random.h"
#include "ray/tracer.h"
#include "workspace/workspace.h"
#include "scenes.h"
#include "suite.h"

/* Makes a tracer with a few lists, which spheres share, or with one list for each sphere. */
enum { FEW, EACH };

static fibrad_tracer *tracer_of(const fibrad_scene *scene, int lists, fibrad_work *work) {
    fibrad_workspace *space = NULL;
    const size_t extra = lists == FEW ? fibrad_tracer_least() : fibrad_tracer_best(scene);
    *work = work_growing();
    assert_ok(fibrad_work_open(work, scene, extra, extra, &space));
    fibrad_tracer *tracer = fibrad_tracer_of(space, scene);
    if (lists == EACH) ck_assert_uint_ge(tracer->lists, scene->facts.spheres);
    return tracer;
}

static void even(fibrad_random *random, double v[3]) {
    double z = 1 - 2 * fibrad_random_next(random), ring = sqrt(1 - z * z), sine, cosine;
    fibrad_sincos_turn(fibrad_random_next(random), &sine, &cosine);
    v[0] = ring * cosine, v[1] = ring * sine, v[2] = z;
}

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* Finds the first sphere by trying all of them, `images` periods each way. from: the sphere that the ray leaves, or
 * FIBRAD_NONE. The ray has lengths and coordinates of the scene. */
static fibrad_hit try_all(const struct bed *bed, uint32_t from, const double o[3], const double w[3], int images) {
    fibrad_hit hit = {.sphere = FIBRAD_NONE, .distance = INFINITY};
    double least = INFINITY;
    int reach[3];
    for (int axis = 0; axis < 3; axis++) reach[axis] = bed->period[axis] > 0 ? images : 0;
    for (uint32_t j = 0; j < bed->n; j++)
        for (int a = -reach[0]; a <= reach[0]; a++)
            for (int b = -reach[1]; b <= reach[1]; b++)
                for (int c = -reach[2]; c <= reach[2]; c++) {
                    if (j == from && a == 0 && b == 0 && c == 0) continue;
                    double place[3] = {bed->x[j] + a * bed->period[0], bed->y[j] + b * bed->period[1],
                                       bed->z[j] + c * bed->period[2]};
                    double e[3] = {place[0] - o[0], place[1] - o[1], place[2] - o[2]}, along = dot(e, w);
                    double square = bed->r[j] * bed->r[j] - (dot(e, e) - along * along);
                    if (square <= 0) continue;
                    double root = sqrt(square), depth = 1, distance = fmax(0, along - root);
                    if (from != FIBRAD_NONE) {
                        double own[3] = {bed->x[from], bed->y[from], bed->z[from]};
                        depth = dot(place, w) - dot(own, w);
                        if (depth <= 0) continue;
                    } else if (along + root <= 0) {
                        continue;
                    }
                    if (distance > hit.distance || (distance == hit.distance && depth >= least)) continue;
                    least = depth;
                    hit.sphere = j, hit.distance = distance;
                    for (int axis = 0; axis < 3; axis++)
                        hit.normal[axis] = (o[axis] + (along - root) * w[axis] - place[axis]) / bed->r[j];
                }
    return hit;
}

/* Follows paths of `bounces` reflections from some spheres of the bed. Compares each ray with try_all. */
static void follow(const struct bed *bed, int isa, int lists, int images, uint32_t paths, int bounces) {
    OWNED fibrad_scene *scene = scene_of(bed, isa);
    OWNED_WORK work;
    fibrad_tracer *tracer = tracer_of(scene, lists, &work);
    uint32_t met = 0;
    for (uint32_t k = 0; k < paths; k++) {
        fibrad_random random = fibrad_random_start(7, k);
        uint32_t s = k % bed->n;
        double n[3], w[3];
        even(&random, n);
        for (int bounce = 0; bounce < bounces && s != FIBRAD_NONE; bounce++) {
            even(&random, w);
            if (dot(w, n) < 0)
                for (int axis = 0; axis < 3; axis++) w[axis] = -w[axis];
            fibrad_hit hit, truth;
            FIBRAD_VERSION_OF(fibrad_trace, isa)(scene, tracer, scene->place[s], n, w, &hit);
            double o[3] = {bed->x[s] + n[0] * bed->r[s], bed->y[s] + n[1] * bed->r[s], bed->z[s] + n[2] * bed->r[s]};
            truth = try_all(bed, s, o, w, images);
            if (truth.sphere == FIBRAD_NONE && bed->period[0] > 0 && hit.distance > images * bed->period[0]) break;
            uint32_t got = hit.sphere == FIBRAD_NONE ? FIBRAD_NONE : scene->order[hit.sphere];
            ck_assert_msg(got == truth.sphere, "path %u bounce %d from %u: %u, not %u at %g", k, bounce, s, got,
                          truth.sphere, truth.distance);
            s = got;
            if (s == FIBRAD_NONE) break;
            met++;
            ck_assert_double_eq_tol(hit.distance, truth.distance, 1e-9 * (1 + truth.distance));
            ck_assert_double_eq_tol(dot(hit.normal, hit.normal), 1, 1e-11);
            double error = 0;
            for (int axis = 0; axis < 3; axis++) worst_of(&error, fabs(hit.normal[axis] - truth.normal[axis]));
            ck_assert_double_lt(error, 1e-5);
            memcpy(n, hit.normal, sizeof n);
        }
    }
    ck_assert_uint_gt(met, paths / 4);
}

TEST(rays_in_random_beds_meet_the_nearest) {
    const struct isas isas = isas_there();
    for (int kind = 0; kind < 4; kind++) {
        OWNED_BED bed = packing(150, kind == 3 ? .1 : kind == 0 ? 1 : .5, 1, kind == 2 ? .02 : .5, 3, kind != 1);
        for (int k = 0; k < isas.count; k++)
            follow(&bed, isas.set[k], kind == 0 ? FEW : EACH, kind == 2 ? 4 : 2, 150, 4);
    }
}

/* Large spheres, near enough to be listed, stand behind small ones that are not listed. */
TEST(small_spheres_before_large_ones) {
    for (uint64_t seed = 50; seed < 53; seed++) {
        OWNED_BED bed = strewn(600, seed);
        follow(&bed, FIBRAD_ISA_SCALAR, EACH, 0, 3000, 3);
    }
}

/* Spheres overlap by up to a third of a radius. */
TEST(rays_among_overlaps_meet_the_first) {
    OWNED_BED bed = packing(100, .7, 1, .45, 5, true);
    for (uint32_t i = 0; i < bed.n; i++) bed.r[i] *= 1.15;
    follow(&bed, FIBRAD_ISA_SCALAR, FEW, 2, 500, 4);
}

/* One large sphere has thousands of small ones about it, more than a list holds. */
TEST(a_large_sphere_among_small_ones_is_met) {
    OWNED_BED bed = bed_empty();
    add_sphere(&bed, 0, 0, 0, 1);
    for (uint32_t k = 0; k < 1500; k++) {
        double w[3], d = 1.03 + .07 * (k % 4);
        assert_ok(fibrad_direction(k, 1500, w));
        add_sphere(&bed, d * w[0], d * w[1], d * w[2], .02);
    }
    follow(&bed, FIBRAD_ISA_SCALAR, EACH, 0, 1500, 3);
}

/* More small spheres overlap a large one than there is room for. So there is no list at all. */
TEST(a_studded_sphere_needs_no_list) {
    OWNED_BED bed = bed_empty();
    add_sphere(&bed, 0, 0, 0, 1);
    for (uint32_t k = 0; k < 700; k++) {
        double w[3];
        assert_ok(fibrad_direction(k, 700, w));
        add_sphere(&bed, 1.01 * w[0], 1.01 * w[1], 1.01 * w[2], .03);
    }
    follow(&bed, FIBRAD_ISA_SCALAR, EACH, 0, 1400, 3);
}

/* There is one sphere in a period, which sees mostly its own images. Rays along the channels of a lattice meet
 * nothing. */
TEST(one_sphere_meets_its_images) {
    OWNED_BED bed = BED({.3, .4, .5, 1});
    bed.period[0] = 2, bed.period[1] = 2.5, bed.period[2] = 3;
    follow(&bed, FIBRAD_ISA_SCALAR, FEW, 12, 200, 5);
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    fibrad_hit hit;
    fibrad_trace_point_scalar(scene, NULL, (const double[3]){1.3, 1.65, 0}, (const double[3]){0, 0, 1}, FIBRAD_NO_SIDE,
                              &hit);
    ck_assert_uint_eq(hit.sphere, FIBRAD_NONE);
}

/* A stray sphere far away is seen, and sees the others. */
TEST(a_stray_sees_and_is_seen) {
    OWNED_BED bed = packing(200, .5, 1, .3, 9, false);
    add_sphere(&bed, 4e6, 10, 10, 1e5);
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    OWNED_WORK work;
    fibrad_tracer *tracer = tracer_of(scene, EACH, &work);
    fibrad_hit hit;
    const double right[3] = {1, 0, 0}, left[3] = {-1, 0, 0};
    double most = 0;
    uint32_t outer = 0;
    for (uint32_t i = 0; i < 200; i++)
        if (bed.x[i] + bed.r[i] > most) most = bed.x[i] + bed.r[i], outer = i;
    fibrad_trace_scalar(scene, tracer, scene->place[outer], right, right, &hit);
    ck_assert_uint_eq(scene->order[hit.sphere], 200);
    ck_assert_double_eq_tol(hit.distance, 3.9e6, 100);
    uint32_t seen = 0;
    for (uint32_t k = 0; k < 20; k++) {
        double point[3] = {4e6, bed.y[k], bed.z[k]};
        fibrad_trace_point_scalar(scene, NULL, point, left, FIBRAD_NO_SIDE, &hit);
        ck_assert_uint_eq(scene->order[hit.sphere], 200); /* it starts inside */
        point[0] = 3e6;
        fibrad_trace_point_scalar(scene, NULL, point, left, FIBRAD_NO_SIDE, &hit);
        seen += hit.sphere != FIBRAD_NONE;
    }
    ck_assert_uint_eq(seen, 20);
}

TEST(rays_from_any_point_meet_the_nearest) {
    for (int periodic = 0; periodic <= 1; periodic++) {
        OWNED_BED bed = packing(150, .3, 1, .4, 11, periodic);
        OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
        for (uint32_t k = 0; k < 500; k++) {
            fibrad_random random = fibrad_random_start(1, k);
            double w[3], o[3];
            even(&random, w);
            for (int axis = 0; axis < 3; axis++) o[axis] = (fibrad_random_next(&random) * 1.6 - .3) * bed.high[axis];
            fibrad_hit hit, truth = try_all(&bed, FIBRAD_NONE, o, w, 3);
            fibrad_trace_point_scalar(scene, NULL, o, w, FIBRAD_NO_SIDE, &hit);
            ck_assert_int_eq(hit.sphere == FIBRAD_NONE, truth.sphere == FIBRAD_NONE);
            if (hit.sphere == FIBRAD_NONE) continue;
            ck_assert_uint_eq(scene->order[hit.sphere], truth.sphere);
            ck_assert_double_eq_tol(hit.distance, truth.distance, 1e-10);
        }
    }
}

/* Rays that begin in cells with lists meet what rays without lists meet, to the bit. */
LOOP_TEST(rays_from_cells_meet_what_others_meet, 3) {
    OWNED_BED bed = packing(400, _i == 2 ? .05 : .3, 1, .45, 4, _i == 1);
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    const struct isas isas = isas_there();
    OWNED_WORK work;
    fibrad_tracer *tracer = tracer_of(scene, EACH, &work);
    uint32_t listed = 0, met = 0;
    for (uint32_t k = 0; k < 20000; k++) {
        fibrad_random random = fibrad_random_start(6, k);
        double w[3], o[3], start[3], radius;
        even(&random, w);
        for (int axis = 0; axis < 3; axis++) o[axis] = fibrad_random_next(&random) * (axis == 2 ? .01 : bed.high[axis]);
        const fibrad_nearby *list = fibrad_tracer_cell_of(tracer, o, start, &radius);
        ck_assert_double_le(dot(start, start), 1);
        listed += list != NULL;
        fibrad_hit truth = {0};
        fibrad_trace_point_scalar(scene, NULL, o, w, FIBRAD_NO_SIDE, &truth);
        met += truth.sphere != FIBRAD_NONE;
        for (int v = 0; v < isas.count; v++) {
            fibrad_hit hit = {0};
            FIBRAD_VERSION_OF(fibrad_trace_point, isas.set[v])(scene, tracer, o, w, FIBRAD_NO_SIDE, &hit);
            ck_assert_mem_eq(&hit, &truth, sizeof hit);
        }
    }
    ck_assert_uint_gt(listed, 15000);
    ck_assert_uint_gt(met, 5000);
}

/* Follows the ray along x from the first of two spheres. Returns its length. kept: out: whether the list that it uses
 * was there before. */
static double length_along_x(fibrad_tracer *tracer, bool *kept) {
    const uint32_t place = tracer->scene->place[0];
    fibrad_hit hit;
    *kept = tracer->owner[place & (tracer->lists - 1)] == place;
    fibrad_trace_scalar(tracer->scene, tracer, place, (const double[3]){1, 0, 0}, (const double[3]){1, 0, 0}, &hit);
    return hit.distance;
}

/* Lists are kept from call to call, but not for another scene at the same place. */
TEST(lists_belong_to_contents) {
    static unsigned char memory[FIBRAD_SCENE_BYTES(2)];
    OWNED_WORK work = work_growing();
    static const double distances[] = {5, 5, 7, 7, 5};
    for (size_t k = 0; k < sizeof distances / sizeof *distances; k++) {
        OWNED_BED bed = BED({0, 0, 0, 1}, {distances[k], 0, 0, 1});
        const fibrad_spheres spheres = spheres_of(&bed);
        fibrad_scene *scene = NULL;
        fibrad_workspace *space = NULL;
        bool kept;
        assert_ok(fibrad_scene_init(&scene, memory, sizeof memory, NULL, &spheres, NULL));
        const size_t extra = fibrad_tracer_least();
        assert_ok(fibrad_work_open(&work, scene, extra, extra, &space));
        ck_assert_double_eq(length_along_x(fibrad_tracer_of(space, scene), &kept), distances[k] - 2);
        ck_assert_int_eq(kept, k % 2 == 1);
    }
}

/* A ray meets two overlapping spheres at the same length and depth. The lower id is met first, whatever the order.
 * Images of a sphere share its id: then the image at the lower coordinate is met first. */
TEST(ids_decide_what_is_met_first) {
    const double x[] = {3, 3, 0}, y[] = {.5, -.5, 0}, z[] = {0, 0, 0}, r[] = {1, 1, .25}, w[] = {1, 0, 0};
    for (int order = 0; order < 2; order++)
        for (uint64_t lower = 0; lower < 3; lower++) { /* which id is less: upper, lower, neither */
            const double by_order[] = {y[order], y[1 - order], 0};
            const uint64_t of_upper = lower == 1 ? 9 : 4, of_lower = lower == 0 ? 9 : 4;
            const uint64_t id[] = {order ? of_lower : of_upper, order ? of_upper : of_lower, 1};
            fibrad_scene *scene;
            const size_t size = fibrad_scene_size(3, 1);
            OWNED void *block = block_of(size);
            const fibrad_spheres spheres = {.x = x, .y = by_order, .z = z, .r = r, .n = 3, .id = id};
            assert_ok(fibrad_scene_init(&scene, block, size, NULL, &spheres, NULL));
            OWNED_WORK work;
            fibrad_tracer *tracer = tracer_of(scene, EACH, &work);
            const double first = lower == 0 ? .5 : -.5;
            fibrad_hit hit;
            fibrad_trace_scalar(scene, tracer, scene->place[2], w, w, &hit);
            ck_assert_double_eq(hit.centre[1], first);
            fibrad_trace_point_scalar(scene, NULL, (const double[3]){1, 0, 0}, w, FIBRAD_NO_SIDE, &hit);
            ck_assert_double_eq(hit.centre[1], first);
        }
}
