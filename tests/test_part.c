/* test_part.c - parts of beds: rows that do not depend on what is far, what is beyond, occupancy, turned directions,
 * powers from rows. SPDX-License-Identifier: MIT */
#include "base/random.h"
#include "fibrad_heat.h"
#include "scene/surroundings.h"
#include "fibrad_surface.h"
#include "scenes.h"
#include "meshes.h"
#include "suite.h"

/* ---- beds with ids ---------------------------------------------------------------------------------------------- */

/* Spheres with ids below `ids`, and what else a scene has. */
struct part {
    double *x, *y, *z, *r;
    uint64_t *id;
    uint32_t n, ids;
    fibrad_scene_config config;
};

static struct part part_room(const struct part *like, uint32_t n) {
    struct part p = {.ids = like->ids, .config = like->config};
    p.x = calloc(n + 1, sizeof *p.x), p.y = calloc(n + 1, sizeof *p.y), p.z = calloc(n + 1, sizeof *p.z);
    p.r = calloc(n + 1, sizeof *p.r), p.id = calloc(n + 1, sizeof *p.id);
    return p;
}

static void part_add(struct part *p, double x, double y, double z, double r, uint64_t id) {
    p->x[p->n] = x, p->y[p->n] = y, p->z[p->n] = z, p->r[p->n] = r, p->id[p->n++] = id;
}

static void part_free(struct part *p) { free(p->x), free(p->y), free(p->z), free(p->r), free(p->id); }

/* A bed with ids that do not follow its order. */
static struct part part_of(const struct bed *bed, fibrad_scene_config config) {
    struct part p = part_room(&(struct part){.ids = bed->n, .config = config}, bed->n);
    memcpy(p.config.period, bed->period, sizeof bed->period);
    uint32_t step = 7;
    while (bed->n % step == 0) step += 4;
    for (uint32_t i = 0; i < bed->n; i++)
        part_add(&p, bed->x[i], bed->y[i], bed->z[i], bed->r[i], (uint64_t)i * step % bed->n);
    return p;
}

static double radius_most(const struct part *p) {
    double most = 0;
    for (uint32_t i = 0; i < p->n; i++) most = fmax(most, p->r[i]);
    return most;
}

/* The shortest way along an axis. */
static double way_along(const struct part *p, int axis, double from, double to) {
    const double period = p->config.period[axis], way = to - from;
    return period > 0 ? way - period * floor(way / period + .5) : way;
}

static double distance_of(const struct part *p, uint32_t i, uint32_t j) {
    return sqrt(pow(way_along(p, 0, p->x[i], p->x[j]), 2) + pow(way_along(p, 1, p->y[i], p->y[j]), 2) +
                pow(way_along(p, 2, p->z[i], p->z[j]), 2));
}

/* Those within some distance of sphere i, in an order of their own. */
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

static fibrad_spheres part_spheres(const struct part *p) {
    return (fibrad_spheres){.x = p->x, .y = p->y, .z = p->z, .r = p->r, .n = p->n, .id = p->id};
}

static int part_scene_try(const struct part *p, fibrad_scene **scene) {
    const fibrad_spheres spheres = part_spheres(p);
    const struct fibrad_triangles *triangles = p->config.triangles;
    const size_t size = fibrad_scene_size(p->n, 1) + (triangles ? fibrad_triangles_size(triangles->n, p->n) : 0);
    void *block = block_of(size);
    const int status = fibrad_scene_init(scene, block, size, &p->config, &spheres, NULL);
    if (status != FIBRAD_OK) free(block);
    return status;
}

static fibrad_scene *part_scene(const struct part *p) {
    fibrad_scene *scene;
    ck_assert_int_eq(part_scene_try(p, &scene), FIBRAD_OK);
    return scene;
}

/* An occupancy that marks all cells the boxes about spheres reach into. free(mark) frees it. */
static fibrad_occupancy occupancy_of(const struct part *p, const double low[3], const double high[3], uint32_t cells) {
    fibrad_occupancy o = {.cells = {cells, cells, cells}};
    uint64_t *mark = calloc((size_t)cells * cells * cells / 64 + 1, sizeof *mark);
    for (int axis = 0; axis < 3; axis++)
        o.low[axis] = low[axis], o.high[axis] = high[axis], o.periodic[axis] = p->config.period[axis] > 0;
    for (uint32_t i = 0; i < p->n; i++) {
        const double c[3] = {p->x[i], p->y[i], p->z[i]};
        int64_t from[3], to[3], at[3];
        for (int axis = 0; axis < 3; axis++) {
            const double size = (high[axis] - low[axis]) / cells;
            from[axis] = (int64_t)floor((c[axis] - p->r[i] - low[axis]) / size);
            to[axis] = (int64_t)floor((c[axis] + p->r[i] - low[axis]) / size);
        }
        for (at[0] = from[0]; at[0] <= to[0]; at[0]++)
            for (at[1] = from[1]; at[1] <= to[1]; at[1]++)
                for (at[2] = from[2]; at[2] <= to[2]; at[2]++) {
                    uint64_t cell = 0;
                    bool inside = true;
                    for (int axis = 3; axis-- > 0;) {
                        const int64_t in_box = (at[axis] % cells + cells) % cells;
                        inside = inside && (in_box == at[axis] || o.periodic[axis]);
                        cell = cell * cells + (uint64_t)in_box;
                    }
                    if (inside) mark[cell / 64] |= UINT64_C(1) << cell % 64;
                }
    }
    o.mark = mark;
    return o;
}

/* ---- rows by id ------------------------------------------------------------------------------------------------- */

struct named_row {
    fibrad_row row;
    double *by_id; /* [ids] */
    uint64_t rays;
};

static void named_free(struct named_row *n) { row_free(&n->row), free(n->by_id); }

/* Emissivities follow from ids. */
static double *emissivities_of(const struct part *p) {
    double *e = calloc(p->n + 1, sizeof *e);
    for (uint32_t i = 0; i < p->n; i++) e[i] = .3 + .6 * fibrad_fraction(fibrad_mix(p->id[i]));
    return e;
}

/* Methods for rows: beams by areas, by points, turned; cast; exchange, turned, to a tolerance. */
enum { METHODS = 8 };
static const double wall_emissivity[7] = {.4, .9, 0, 1, .6, .3, .5};

static struct named_row row_by(const struct part *p, const fibrad_scene *scene, uint32_t i, int method, double cutoff) {
    struct named_row out = {.row = row_of(p->n), .by_id = calloc(p->ids, sizeof(double))};
    double *e = emissivities_of(p);
    fibrad_work work = work_growing();
    const fibrad_beam_rule beam = {.directions = method == 2 ? 34 : 55,
                                   .points = method == 0   ? 0
                                             : method == 1 ? 64
                                                           : 256,
                                   .cutoff = cutoff,
                                   .turn = method == 2 ? 99 : 0};
    const fibrad_cast_rule cast = {.rays = 600, .seed = 4, .cutoff = cutoff};
    const fibrad_exchange_rule exchange = {.emissivity = e,
                                           .body_emissivity = wall_emissivity,
                                           .directions = method == 5 ? 145 : 0,
                                           .paths = 60,
                                           .seed = method == 6 ? 12345 : 0,
                                           .cutoff = cutoff,
                                           .tolerance = method == 7 ? .03 : 0};
    const int status = method < 3    ? fibrad_beam_row(scene, &work, i, &beam, &out.row)
                       : method == 3 ? fibrad_cast_row(scene, &work, i, &cast, &out.row, NULL)
                                     : fibrad_exchange_row(scene, &work, i, &exchange, &out.row, &out.rays);
    ck_assert_int_eq(status, FIBRAD_OK);
    double sum = out.row.escaped + out.row.beyond;
    for (int b = 0; b < BODIES_MOST; b++) sum += out.row.body[b];
    for (uint32_t k = 0; k < out.row.length; k++) {
        sum += out.row.f[k];
        out.by_id[p->id[out.row.col[k]]] += out.row.f[k];
    }
    ck_assert_double_eq_tol(sum, 1, 1e-12);
    ck_assert(out.row.beyond >= 0 && out.row.escaped >= -1e-15);
    work_free(&work);
    free(e);
    return out;
}

static bool same_double(double a, double b) { return memcmp(&a, &b, sizeof a) == 0; }

static void expect_same_named(const struct named_row *a, const struct named_row *b, uint32_t ids, const char *what) {
    for (uint32_t id = 0; id < ids; id++)
        ck_assert_msg(same_double(a->by_id[id], b->by_id[id]), "%s: id %u: %a, %a", what, id, a->by_id[id],
                      b->by_id[id]);
    for (int body = 0; body < BODIES_MOST; body++)
        ck_assert_msg(same_double(a->row.body[body], b->row.body[body]), "%s: body %d", what, body);
    ck_assert_msg(same_double(a->row.escaped, b->row.escaped), "%s: escaped", what);
    ck_assert_msg(same_double(a->row.beyond, b->row.beyond), "%s: beyond", what);
    ck_assert_msg(same_double(a->row.error, b->row.error), "%s: error %a, %a", what, a->row.error, b->row.error);
    ck_assert_msg(a->row.length == b->row.length && a->rays == b->rays, "%s: length, rays", what);
}

/* Beds of all kinds; the box that they are in. */
struct kind {
    const char *name;
    char lattice;   /* 0: a packing */
    bool across, z; /* periodic across z, along z */
    int walls;      /* 1: planes where an axis is open, 2: a cylinder and planes across z, 3: triangles */
};
static const struct kind kinds[] = {{"open", 0, false, false, 0},
                                    {"box", 0, false, false, 1},
                                    {"can", 0, false, false, 2},
                                    {"slab", 0, true, false, 1},
                                    {"periodic", 0, true, true, 0},
                                    {"lattice", 'p', false, false, 0},
                                    {"close-packed", 'f', false, false, 1},
                                    {"vessel", 0, false, false, 3},
                                    {"layer", 0, true, false, 3}};
enum { KINDS = sizeof kinds / sizeof *kinds, BODIES = 7 };

struct made {
    struct part part;
    fibrad_occupancy occupancy;
    fibrad_body body[BODIES];
    struct mesh *mesh; /* NULL: none */
    double low[3], high[3];
};

/* A tube among the spheres; a high box about them, or, on periodic axes, the floor and the lid of one. */
static void make_mesh(struct made *m, const double period[3], fibrad_scene_config *config) {
    const double wide = period[0] > 0 ? 0 : .5;
    const double low[3] = {m->low[0] - wide, m->low[1] - wide, m->low[2] - .5};
    const double high[3] = {m->high[0] + wide, m->high[1] + wide, m->high[2] + 9};
    m->mesh = mesh_new();
    mesh_box(m->mesh, low, high, 0);
    if (period[0] > 0) { /* without the sides, which come first */
        m->mesh->triangles.n = 4;
        memmove(m->mesh->corner, m->mesh->corner + 8, 4 * sizeof *m->mesh->corner);
        for (uint32_t t = 0; t < 4; t++) m->mesh->front[t] = t;
    }
    const uint32_t tube = period[0] > 0 ? 4 : 6;
    mesh_tube(m->mesh, 3, 4, .75, m->low[2], m->high[2], 12, 1, true, tube, tube);
    memcpy(m->body, m->mesh->body, sizeof m->body);
    config->bodies = tube + 1;
    config->triangles = &m->mesh->triangles;
}

/* The made bed stays where it is: its scene's configuration points into it. */
static void make_kind(struct made *m, const struct kind *k) {
    struct bed bed;
    if (k->lattice != 0) {
        bed = lattice(k->lattice, 7.9);
        for (uint32_t i = 0; i < bed.n; i++) bed.x[i] *= .97, bed.y[i] *= .97, bed.z[i] *= .97; /* overlaps */
    } else {
        bed = packing(700, .6, 1, .5, 11, true);
    }
    double high = 0;
    for (int axis = 0; axis < 3; axis++) {
        const double period = bed.period[axis];
        bed.period[axis] = (axis < 2 ? k->across : k->z) ? period : 0;
        m->low[axis] = k->lattice != 0 ? -9 : 0, m->high[axis] = k->lattice != 0 ? 9 : period;
        high = m->high[axis];
    }
    fibrad_scene_config config = {.body = m->body};
    for (int axis = 0; axis < 3; axis++) {
        if (k->walls == 0 || k->walls == 3 || bed.period[axis] > 0 || (k->walls == 2 && axis < 2)) continue;
        m->body[config.bodies++] = plane_at(axis, 0, m->low[axis]);
        m->body[config.bodies++] = plane_at(axis, 1, m->high[axis]);
    }
    m->mesh = NULL;
    if (k->walls == 3) make_mesh(m, bed.period, &config);
    if (k->walls == 2) m->body[config.bodies++] = cylinder_at(high / 2, high / 2, high);
    m->part = part_of(&bed, config);
    m->occupancy = occupancy_of(&m->part, m->low, m->high, 5);
    m->part.config.occupancy = &m->occupancy;
    bed_free(&bed);
}

static void free_made(struct made *m) {
    part_free(&m->part);
    free((void *)(uintptr_t)m->occupancy.mark);
    free(m->mesh);
}

/* Rows depend on what is near, to the bit, whatever else there is and in whatever order. */
START_TEST(rows_depend_on_what_is_near) {
    struct made m;
    make_kind(&m, &kinds[_i]);
    fibrad_scene *whole = part_scene(&m.part);
    const double cutoffs[] = {2.5, 4.25};
    for (uint32_t i = 0; i < m.part.n; i += m.part.n / (m.mesh ? 2 : 9))
        for (int c = 0; c < 2; c++) {
            const double reach = (cutoffs[c] + radius_most(&m.part)) * (1 + 1e-9);
            uint32_t own = UINT32_MAX, again = UINT32_MAX;
            struct part near = part_near(&m.part, i, reach, &own), far = part_near(&m.part, i, 1.4 * reach, &again);
            ck_assert_uint_lt(near.n, m.part.n);
            fibrad_scene *little = part_scene(&near), *more = part_scene(&far);
            for (int method = 0; method < METHODS; method++) {
                char what[64];
                snprintf(what, sizeof what, "%s, method %d, sphere %u", kinds[_i].name, method, i);
                struct named_row expected = row_by(&m.part, whole, i, method, cutoffs[c]);
                struct named_row found = row_by(&near, little, own, method, cutoffs[c]);
                struct named_row larger = row_by(&far, more, again, method, cutoffs[c]);
                expect_same_named(&expected, &found, m.part.ids, what);
                expect_same_named(&expected, &larger, m.part.ids, what);
                named_free(&expected), named_free(&found), named_free(&larger);
            }
            free(little), free(more);
            part_free(&near), part_free(&far);
        }
    free(whole);
    free_made(&m);
}
END_TEST

/* Displacements likewise. */
START_TEST(displacements_depend_on_what_is_near) {
    struct made m;
    make_kind(&m, &kinds[3]);
    fibrad_scene *whole = part_scene(&m.part);
    double *e = emissivities_of(&m.part), cutoff = 4;
    fibrad_work work = work_growing();
    for (uint32_t i = 0; i < m.part.n; i++) {
        if (m.part.z[i] > 1.2) continue; /* paths go to and fro between spheres and the wall */
        uint32_t own = UINT32_MAX;
        struct part near = part_near(&m.part, i, cutoff + radius_most(&m.part) + 1e-6, &own);
        fibrad_scene *little = part_scene(&near);
        double *of_near = emissivities_of(&near);
        fibrad_exchange_rule rule = {
            .emissivity = e, .body_emissivity = wall_emissivity, .paths = 200, .seed = 3, .cutoff = cutoff};
        fibrad_displacement expected, found;
        ck_assert_int_eq(fibrad_exchange_displacement(whole, &work, i, &rule, &expected), FIBRAD_OK);
        rule.emissivity = of_near;
        ck_assert_int_eq(fibrad_exchange_displacement(little, &work, own, &rule, &found), FIBRAD_OK);
        ck_assert_int_eq(memcmp(&expected, &found, sizeof found), 0);
        for (int axis = 0; axis < 3; axis++) ck_assert_double_lt(expected.square[axis], pow(cutoff + 1, 2));
        free(little), free(of_near);
        part_free(&near);
    }
    work_free(&work);
    free(whole), free(e);
    free_made(&m);
}
END_TEST

/* A periodic bed, and an open one with images of the same ids. Coordinates have few digits, so that images are where
 * they should be to the bit. Factors to all images of a sphere together are those to it: counts of points to the bit,
 * sums of paths to rounding. */
START_TEST(images_are_spheres_of_the_same_id) {
    struct made m;
    make_kind(&m, &kinds[4]);
    struct part *p = &m.part;
    double *const of_axis[3] = {p->x, p->y, p->z};
    for (int axis = 0; axis < 3; axis++) {
        p->config.period[axis] = ldexp(round(ldexp(p->config.period[axis], 10)), -10);
        m.occupancy.high[axis] = p->config.period[axis];
        for (uint32_t i = 0; i < p->n; i++)
            of_axis[axis][i] = fmod(ldexp(round(ldexp(of_axis[axis][i], 20)), -20), p->config.period[axis]);
    }
    fibrad_scene *periodic = part_scene(p);
    const double cutoff = .7 * p->config.period[0], reach = cutoff + radius_most(p) + 1e-6; /* some spheres twice */
    for (uint32_t i = 0; i < p->n; i += 150) {
        struct part images = part_room(p, 27 * p->n);
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
        fibrad_scene *open = part_scene(&images);
        for (int method = 1; method < METHODS; method++) {
            struct named_row expected = row_by(p, periodic, i, method, cutoff);
            struct named_row found = row_by(&images, open, own, method, cutoff);
            const double count = method == 1 ? 55 * 64 : method == 2 ? 34 * 256 : 600;
            for (uint32_t id = 0; id < p->ids; id++) {
                ck_assert_double_eq_tol(expected.by_id[id], found.by_id[id], 2e-15);
                if (method < 4) ck_assert(llround(expected.by_id[id] * count) == llround(found.by_id[id] * count));
            }
            ck_assert(fabs(expected.row.escaped - found.row.escaped) <= (method < 4 ? 0 : 2e-15));
            ck_assert(fabs(expected.row.beyond - found.row.beyond) <= (method < 4 ? 0 : 2e-15));
            if (method != 7) ck_assert_uint_eq(expected.rays, found.rays); /* errors of images are their own */
            named_free(&expected), named_free(&found);
        }
        free(open);
        part_free(&images);
    }
    free(periodic);
    free_made(&m);
}
END_TEST

/* Triangles beyond the cutoff are met where no sphere is on the way. */
START_TEST(far_triangles_are_met) {
    struct bed bed = bed_of(1, (const double[][4]){{0, 0, 0, 1}});
    struct mesh *mesh = mesh_new();
    mesh_box(mesh, (const double[]){-30, -20, -10}, (const double[]){40, 50, 60}, 0);
    const fibrad_scene_config config = {.body = mesh->body, .bodies = 6, .triangles = &mesh->triangles};
    struct part alone = part_of(&bed, config);
    fibrad_scene *scene = part_scene(&alone);
    for (int method = 0; method < METHODS; method++) {
        struct named_row all = row_by(&alone, scene, 0, method, 0), cut = row_by(&alone, scene, 0, method, 3);
        expect_same_named(&all, &cut, 1, "box");
        named_free(&all), named_free(&cut);
    }
    free(scene);
    part_free(&alone);
    free(mesh);
    bed_free(&bed);
}
END_TEST

/* Triangles that repeat where spheres do not are as good as their copies. */
START_TEST(triangles_repeat_alone) {
    struct bed bed = bed_of(1, (const double[][4]){{.3, .4, 0, .45}});
    double seen[2][METHODS];
    enum { FAR = 40 };
    for (int copies = 0; copies < 2; copies++) {
        struct mesh *mesh = mesh_new();
        for (int x = copies ? -FAR : 0; x <= (copies ? FAR : 0); x++)
            for (int y = copies ? -FAR : 0; y <= (copies ? FAR : 0); y++) {
                uint32_t v[4];
                for (int k = 0; k < 4; k++) v[k] = mesh_vertex(mesh, x + (k == 1 || k == 2) * .5, y + (k > 1) * .5, -1);
                mesh_quad(mesh, v, 0, FIBRAD_NO_BODY);
            }
        for (int axis = 0; axis < 2 && !copies; axis++) mesh->triangles.period[axis] = 1;
        struct part p =
            part_of(&bed, (fibrad_scene_config){.body = mesh->body, .bodies = 1, .triangles = &mesh->triangles});
        fibrad_scene *scene = part_scene(&p);
        for (int method = 0; method < METHODS; method++) {
            struct named_row row = row_by(&p, scene, 0, method, 0);
            seen[copies][method] = row.row.body[0];
            named_free(&row);
        }
        free(scene), free(mesh);
        part_free(&p);
    }
    for (int method = 0; method < METHODS; method++) {
        ck_assert_double_gt(seen[0][method], method < 4 ? .1 : .03);
        ck_assert_double_eq_tol(seen[0][method], seen[1][method], .01); /* those farther than FAR */
    }
    bed_free(&bed);
}
END_TEST

/* Lattices have spheres at equal depth and paths that meet two at once. Ids decide, not the order. */
START_TEST(ids_decide_among_equals) {
    static const char lattices[] = {'p', 'i', 'f'};
    struct bed bed = lattice(lattices[_i], 4.1);
    for (uint32_t i = 0; i < bed.n; i++) bed.x[i] *= .9375, bed.y[i] *= .9375, bed.z[i] *= .9375;
    struct part p = part_of(&bed, (fibrad_scene_config){0});
    fibrad_scene *scene = part_scene(&p);
    for (uint32_t i = 0; i < p.n; i += 3) {
        uint32_t own = UINT32_MAX;
        struct part shuffled = part_near(&p, i, 100, &own);
        ck_assert(shuffled.n == p.n && memcmp(shuffled.id, p.id, p.n * sizeof *p.id) != 0);
        fibrad_scene *other = part_scene(&shuffled);
        for (int method = 0; method < METHODS; method++) {
            struct named_row expected = row_by(&p, scene, i, method, 0);
            struct named_row found = row_by(&shuffled, other, own, method, 0);
            expect_same_named(&expected, &found, p.ids, "lattice");
            named_free(&expected), named_free(&found);
        }
        free(other);
        part_free(&shuffled);
    }
    free(scene);
    part_free(&p);
    bed_free(&bed);
}
END_TEST

/* ---- beyond ----------------------------------------------------------------------------------------------------- */

/* A cutoff, or a known region, that holds the whole bed and its walls changes no bit. */
START_TEST(nothing_is_beyond_what_holds_all) {
    struct made m;
    make_kind(&m, &kinds[_i]);
    for (int occupied = 0; occupied < 2; occupied++) {
        m.part.config.occupancy = occupied ? &m.occupancy : NULL;
        fibrad_scene *plain = part_scene(&m.part);
        for (int axis = 0; axis < 3; axis++) m.part.config.known_low[axis] = -99, m.part.config.known_high[axis] = 99;
        fibrad_scene *known = part_scene(&m.part);
        memset(m.part.config.known_low, 0, sizeof m.part.config.known_low);
        memset(m.part.config.known_high, 0, sizeof m.part.config.known_high);
        for (uint32_t i = 3; i < m.part.n; i += 150)
            for (int method = 0; method < METHODS; method++) {
                struct named_row expected = row_by(&m.part, plain, i, method, 0);
                struct named_row cut = row_by(&m.part, plain, i, method, 99);
                ck_assert_double_eq(cut.row.beyond, 0);
                expect_same_named(&expected, &cut, m.part.ids, kinds[_i].name);
                if (m.part.config.bodies > 0 || occupied) { /* all lines end before the region does, or are clear */
                    struct named_row region = row_by(&m.part, known, i, method, 0);
                    ck_assert_double_eq(region.row.beyond, 0);
                    expect_same_named(&expected, &region, m.part.ids, kinds[_i].name);
                    named_free(&region);
                }
                named_free(&expected), named_free(&cut);
            }
        free(plain), free(known);
    }
    free_made(&m);
}
END_TEST

/* Whether the way along w from some length on is clear of marked cells: in steps so small that they miss corners
 * alone. */
static bool clear_by_steps(const fibrad_occupancy *o, const double from[3], const double w[3], double begin,
                           double step) {
    for (double t = begin; t < begin + 700; t += step) {
        uint64_t cell = 0;
        bool inside = true;
        for (int axis = 3; axis-- > 0;) {
            const double size = (o->high[axis] - o->low[axis]) / o->cells[axis];
            const int64_t cells = o->cells[axis];
            const int64_t at = (int64_t)floor((from[axis] + t * w[axis] - o->low[axis]) / size);
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

/* Rays of our own: all spheres tried, cells looked up by small steps. */
START_TEST(beyond_is_what_rays_say) {
    struct made m;
    make_kind(&m, &kinds[_i]); /* open or periodic, without walls */
    struct part *p = &m.part;
    fibrad_scene *scene = part_scene(p);
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
            /* windows go one way each, and 600 rays are few */
            const double tolerance = .015 + 3.5 * sqrt(fmax(expected, .01) / (method == 3 ? 600 : 1000));
            ck_assert_double_eq_tol(found.row.beyond, expected, tolerance);
            ck_assert_double_eq_tol(found.row.escaped, sky, tolerance);
            named_free((struct named_row *)&found);
        }
        largest = fmax(largest, fmin(expected, sky));
    }
    if (_i == 0) ck_assert_double_gt(largest, .02); /* some rows have both */
    free(scene);
    free_made(&m);
}
END_TEST

/* The walk through the cells against small steps, which miss nothing but corners: boxes with few marks, periodic or
 * not, rays from anywhere. */
START_TEST(cells_are_walked_one_by_one) {
    struct bed bed = bed_of(1, (const double[][4]){{0, 0, 0, .1}});
    struct part p = part_of(&bed, (fibrad_scene_config){0});
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
        fibrad_scene *scene = part_scene(&p);
        for (int k = 0; k < 20; k++) {
            double from[3], w[3], distance;
            draw_even(&random, w);
            for (int axis = 0; axis < 3; axis++) {
                from[axis] = 30 * (fibrad_random_next(&random) - .5);
                if (o.periodic[axis] && k % 4 == 0) from[axis] += 1024 * (o.high[axis] - o.low[axis]);
            }
            const double begin = 10 * fibrad_random_next(&random);
            /* it is cut at the ball */
            const uint32_t met = fibrad_surroundings_met(scene, from, w, begin, &distance);
            const bool expected = clear_by_steps(&o, from, w, begin, .003);
            ck_assert(met == FIBRAD_ESCAPED || met == FIBRAD_BEYOND);
            if (!expected) ck_assert_uint_eq(met, FIBRAD_BEYOND);
            missed += expected && met == FIBRAD_BEYOND; /* corners */
            clear += expected, rays++;
        }
        free(scene);
    }
    ck_assert_int_lt(missed, rays / 50);
    ck_assert_int_gt(clear, rays / 4);
    ck_assert_int_lt(clear, 9 * rays / 10);
    /* without any mark: clear where the box ends, not looked at all along where it never does */
    for (int which = 0; which < 8; which++) {
        const fibrad_occupancy none = {.high = {1, 1, 1},
                                       .cells = {2, 2, 2},
                                       .periodic = {which & 1, which >> 1 & 1, which >> 2 & 1},
                                       .mark = (const uint64_t[]){0}};
        p.config.occupancy = &none;
        fibrad_scene *scene = part_scene(&p);
        double distance;
        for (int axis = 0; axis < 3; axis++) {
            const double w[3] = {axis == 0, axis == 1 ? -1 : 0, axis == 2}, from[3] = {.3, .3, .3};
            const uint32_t met = fibrad_surroundings_met(scene, from, w, 0, &distance);
            ck_assert_uint_eq(met, none.periodic[axis] ? FIBRAD_BEYOND : FIBRAD_ESCAPED);
        }
        free(scene);
    }
    part_free(&p);
    bed_free(&bed);
}
END_TEST

/* What is reflected towards a sphere outside the known region is beyond. Beams see it. */
START_TEST(reflections_end_at_the_known_region) {
    struct bed bed = bed_of(3, (const double[][4]){{0, 0, 0, 1}, {0, 0, 2.5, 1}, {2.2, 0, 1.25, 1}});
    struct part p = part_of(&bed, (fibrad_scene_config){.known_low = {-2, 0, 0}, .known_high = {1.1, 0, 0}});
    fibrad_scene *scene = part_scene(&p);
    const fibrad_occupancy none = {.high = {1, 1, 1}, .cells = {1, 1, 1}, .mark = (const uint64_t[]){0}};
    p.config.occupancy = &none;
    fibrad_scene *told = part_scene(&p);
    const double e[] = {.5, 1e-3, .9}; /* the third absorbs what it receives, and receives from the second */
    fibrad_work work = work_growing();
    fibrad_row beam = row_of(3), row = row_of(3), clear = row_of(3);
    const fibrad_exchange_rule rule = {.emissivity = e, .paths = 4000};
    ck_assert_int_eq(fibrad_beam_row(scene, &work, 0, &(fibrad_beam_rule){.directions = 50, .points = 256}, &beam),
                     FIBRAD_OK);
    ck_assert_int_eq(fibrad_exchange_row(scene, &work, 0, &rule, &row, NULL), FIBRAD_OK);
    ck_assert_int_eq(fibrad_exchange_row(told, &work, 0, &rule, &clear, NULL), FIBRAD_OK);
    ck_assert_double_gt(row_factor(&beam, 2), .04);
    ck_assert_double_eq(row_factor(&row, 2), .9 * row_factor(&beam, 2)); /* the first leg alone */
    ck_assert_double_eq(row_factor(&clear, 2), row_factor(&row, 2));
    ck_assert_double_gt(row.beyond, .3);
    ck_assert_double_eq(clear.beyond, 0);
    row_free(&beam), row_free(&row), row_free(&clear);
    work_free(&work);
    free(scene), free(told);
    part_free(&p);
    bed_free(&bed);
}
END_TEST

/* One sphere that flies far above a bed must not hide the sky of those at its top. */
START_TEST(a_flying_sphere_leaves_the_sky) {
    struct bed bed = packing(700, .6, 1, .5, 11, true);
    const double side = bed.period[0];
    bed.period[2] = 0;
    add_sphere(&bed, side / 2, side / 2, 100, 1);
    struct part p = part_of(&bed, (fibrad_scene_config){0});
    const fibrad_occupancy o = occupancy_of(&p, (double[3]){0, 0, -1}, (double[3]){side, side, 101.5}, 128);
    fibrad_scene *told;
    fibrad_scene *untold = part_scene(&p);
    p.config.occupancy = &o;
    told = part_scene(&p);
    uint32_t top = 0;
    for (uint32_t i = 0; i < p.n - 1; i++)
        if (p.z[i] > p.z[top]) top = i;
    for (int method = 0; method < METHODS; method++) {
        struct named_row all = row_by(&p, told, top, method, 0), cut = row_by(&p, told, top, method, 5);
        struct named_row lost = row_by(&p, untold, top, method, 5);
        ck_assert_double_gt(all.row.escaped, .3);
        ck_assert_double_lt(cut.row.escaped, all.row.escaped + .02);
        ck_assert_double_gt(cut.row.escaped, .7 * all.row.escaped); /* not what leaves through cells of the bed */
        ck_assert_double_lt(lost.row.escaped, .05);
        ck_assert_double_gt(lost.row.beyond, .8 * all.row.escaped);
        named_free(&all), named_free(&cut), named_free(&lost);
    }
    free(told), free(untold);
    free((void *)(uintptr_t)o.mark);
    part_free(&p);
    bed_free(&bed);
}
END_TEST

/* The known region ends half way up a can: a lone sphere sends a fraction there that is a solid angle over 4 pi. */
START_TEST(a_known_region_ends_in_a_can) {
    const fibrad_body body[] = {plane_at(2, 0, -40), plane_at(2, 1, 40), cylinder_at(0, 0, 10)};
    struct bed bed = bed_of(2, (const double[][4]){{0, 0, 0, 1}, {0, 0, 35, 1}});
    struct part p = part_of(
        &bed, (fibrad_scene_config){.body = body, .bodies = 3, .known_low = {0, 0, -1000}, .known_high = {0, 0, 20}});
    fibrad_scene *scene = part_scene(&p);
    const double share = .5 * (1 - 20 / sqrt(500)), below = .5 * (1 - 40 / sqrt(1700));
    for (int method = 0; method < METHODS; method++) {
        struct named_row row = row_by(&p, scene, 0, method, 0);
        const double tolerance = method < 3 ? 6e-3 : method == 3 ? .02 : 1; /* of exchange: sums alone */
        ck_assert_double_eq_tol(row.row.beyond, share, tolerance);
        ck_assert_double_eq_tol(row.row.body[0], below, tolerance);
        ck_assert_double_eq(row.row.body[1],
                            0); /* the wall and the sphere above cannot be told from what may be there */
        ck_assert_double_gt(row.row.beyond, share / 2);
        ck_assert_double_eq(row.row.escaped, 0);
        named_free(&row);
    }
    /* an occupancy that says that nothing is there gives the wall back */
    const fibrad_occupancy none = {
        .low = {-20, -20, -60}, .high = {20, 20, 60}, .cells = {1, 1, 1}, .mark = (const uint64_t[]){0}};
    fibrad_scene_config config = p.config;
    p.config.occupancy = &none;
    fibrad_scene *told = part_scene(&p);
    for (int method = 0; method < METHODS; method++) {
        struct named_row row = row_by(&p, told, 0, method, 0);
        ck_assert_double_eq(row.row.beyond, 0);
        ck_assert_double_gt(row.row.body[1], 0);
        named_free(&row);
    }
    /* of a sphere beyond the region, all is beyond that meets no wall on the way out */
    p.config = config;
    struct named_row row = row_by(&p, scene, 1, 0, 0);
    ck_assert_double_gt(row.row.beyond, .9);
    named_free(&row);
    free(scene), free(told);
    part_free(&p);
    bed_free(&bed);
}
END_TEST

/* ---- turned directions ------------------------------------------------------------------------------------------ */

/* Turned rows err in all ways: their mean over many turns comes to the fine row, each is off by what it says. */
START_TEST(turned_rows_average_to_the_fine_one) {
    enum { TURNS = 300 };
    struct bed bed = packing(120, .5, 1, .45, 4, false);
    const fibrad_body floor_below = plane_at(2, 0, -1);
    const fibrad_scene_config config = {.body = &floor_below, .bodies = _i < 2 ? 1 : 0};
    fibrad_scene *scene = scene_with(&bed, &config);
    fibrad_work work = work_growing();
    const uint32_t points = _i % 2 ? 256 : 0;
    for (uint32_t i = 0; i < bed.n; i += 50) {
        fibrad_row fine = row_of(bed.n), row = row_of(bed.n), mean = row_of(bed.n);
        double body = 0, escaped = 0, square = 0, estimate = 0;
        int less = 0;
        ck_assert_int_eq(fibrad_beam_row(scene, &work, i, &(fibrad_beam_rule){.directions = 20000}, &fine), FIBRAD_OK);
        for (uint32_t j = 0; j < bed.n; j++) mean.col[j] = j;
        mean.length = bed.n;
        for (uint64_t turn = 1; turn <= TURNS; turn++) {
            const fibrad_beam_rule rule = {.directions = 50, .points = points, .turn = turn};
            ck_assert_int_eq(fibrad_beam_row(scene, &work, i, &rule, &row), FIBRAD_OK);
            for (uint32_t k = 0; k < row.length; k++) mean.f[row.col[k]] += row.f[k] / TURNS;
            body += row.body[0] / TURNS, escaped += row.escaped / TURNS;
            const double off = row_distance(&row, &fine);
            square += off * off / TURNS, estimate += row.error * row.error / TURNS;
            less += row.error < off;
        }
        const double typical = sqrt(square), ratio = sqrt(estimate) / typical;
        ck_assert_double_lt(row_distance(&mean, &fine), 4 * typical / sqrt(TURNS) + 1e-3);
        ck_assert_double_lt(row_distance(&mean, &fine), .35 * typical);
        ck_assert_double_eq_tol(body, fine.body[0], 5e-3); /* sharing in bands errs by about 1/directions */
        ck_assert_double_eq_tol(escaped, fine.escaped, 5e-3);
        ck_assert_msg(ratio > 1 && ratio < 4, "estimate over error: %g", ratio);
        ck_assert_int_lt(less, TURNS / 10);
        row_free(&fine), row_free(&row), row_free(&mean);
    }
    work_free(&work);
    free(scene);
    bed_free(&bed);
}
END_TEST

/* Turned directions need not pair off; the floor still has half of what a free sphere sends out, cut or not. */
START_TEST(a_floor_below_turned_directions) {
    struct bed bed = bed_of(1, (const double[][4]){{0, 0, 3, 1}});
    const fibrad_body floor_below = plane_at(2, 0, 0);
    fibrad_scene *scene = scene_with(&bed, &(fibrad_scene_config){.body = &floor_below, .bodies = 1});
    fibrad_work work = work_growing();
    fibrad_row row = row_of(1);
    double mean = 0;
    for (uint64_t turn = 1; turn <= 100; turn++) {
        const fibrad_beam_rule rule = {.directions = 233, .turn = turn, .cutoff = _i > 0 ? 5 : 0};
        ck_assert_int_eq(fibrad_beam_row(scene, &work, 0, &rule, &row), FIBRAD_OK);
        ck_assert_double_eq_tol(row.body[0], .5, 1.5e-3);
        mean += row.body[0] / 100;
    }
    ck_assert_double_eq_tol(mean, .5, 1e-4);
    row_free(&row);
    work_free(&work);
    free(scene);
    bed_free(&bed);
}
END_TEST

/* ---- powers ----------------------------------------------------------------------------------------------------- */

struct powers {
    fibrad_flow flow;
    double *weight, *emission, *power, body_emission[BODIES_MOST], body_power[BODIES_MOST];
};

static struct powers powers_of(const struct bed *bed, const double *emissivity) {
    struct powers p = {.weight = calloc(bed->n, sizeof(double)),
                       .emission = calloc(bed->n, sizeof(double)),
                       .power = calloc(bed->n, sizeof(double))};
    fibrad_random random = fibrad_random_start(2, 3);
    for (uint32_t i = 0; i < bed->n; i++) {
        p.weight[i] = 4 * 3.14159265358979323846 * bed->r[i] * bed->r[i] * emissivity[i];
        p.emission[i] = 100 + 900 * fibrad_random_next(&random);
    }
    for (int b = 0; b < BODIES_MOST; b++) p.body_emission[b] = 300 + 100 * b;
    p.flow.surroundings_emission = 77;
    return p;
}

static void powers_point(struct powers *p) {
    p->flow.weight = p->weight, p->flow.emission = p->emission, p->flow.power = p->power;
    p->flow.body_emission = p->body_emission, p->flow.body_power = p->body_power;
}

static void powers_free(struct powers *p) { free(p->weight), free(p->emission), free(p->power); }

static fibrad_rows exchange_rows(const fibrad_scene *scene, uint32_t n, const fibrad_exchange_rule *rule) {
    fibrad_work work = work_growing();
    fibrad_rows rows = {.memory = memory_growing()};
    for (uint32_t i = 0; i < n; i++)
        ck_assert_int_eq(fibrad_exchange_row(scene, &work, i, rule, &(fibrad_row){.rows = &rows}, NULL), FIBRAD_OK);
    work_free(&work);
    return rows;
}

/* Powers add up to zero; nothing flows between equals; a part of the rows gives a part of the powers. */
START_TEST(what_one_gains_others_lose) {
    struct bed bed = packing(60, .6, 1, .5, 9, false);
    const fibrad_body body[] = {plane_at(2, 0, -1), plane_at(0, 0, -1)};
    const fibrad_plane open[] = {{0, 1, 9}, {1, 0, -2}, {1, 1, 9}, {2, 1, 9}};
    fibrad_scene *scene =
        scene_with(&bed, &(fibrad_scene_config){.body = body, .bodies = 2, .opening = open, .openings = 4});
    double e[60];
    for (int i = 0; i < 60; i++) e[i] = .4 + .01 * i;
    fibrad_rows rows = exchange_rows(
        scene, bed.n,
        &(fibrad_exchange_rule){.emissivity = e, .body_emissivity = wall_emissivity, .seed = 5, .cutoff = 3});
    struct powers p = powers_of(&bed, e);
    powers_point(&p);
    ck_assert_int_eq(fibrad_rows_flow(&rows, bed.n, 2, &p.flow), FIBRAD_OK);
    double sum = p.flow.surroundings_power + p.body_power[0] + p.body_power[1], size = fabs(sum);
    for (uint32_t i = 0; i < bed.n; i++) sum += p.power[i], size += fabs(p.power[i]);
    ck_assert_double_eq_tol(sum / size, 0, 1e-14);
    ck_assert(p.power[0] != 0 && p.body_power[0] != 0 && p.body_power[1] != 0 && p.flow.surroundings_power != 0);
    /* twice the same: added to */
    struct powers twice = powers_of(&bed, e);
    powers_point(&twice);
    for (int k = 0; k < 2; k++) ck_assert_int_eq(fibrad_rows_flow(&rows, bed.n, 2, &twice.flow), FIBRAD_OK);
    for (uint32_t i = 0; i < bed.n; i++) ck_assert_double_eq_tol(twice.power[i], 2 * p.power[i], 1e-12 * size);
    /* row by row, by hand */
    double *expected = calloc(bed.n, sizeof *expected);
    const struct matrix raw = matrix_of(scene, &rows, 1, &(fibrad_matrix_rule){.raw = 1});
    for (uint32_t i = 0; i < bed.n; i++) {
        const fibrad_row row = matrix_row(&raw.factors, i);
        ck_assert_double_gt(row.beyond, 0);
        const double weight = p.weight[i] / (1 - row.beyond);
        for (uint32_t k = 0; k < row.length; k++) {
            const double gained = .5 * weight * row.f[k] * (p.emission[row.col[k]] - p.emission[i]);
            expected[i] += gained, expected[row.col[k]] -= gained;
        }
        for (int b = 0; b < 2; b++) expected[i] += weight * row.body[b] * (p.body_emission[b] - p.emission[i]);
        expected[i] += weight * row.escaped * (77 - p.emission[i]);
    }
    for (uint32_t i = 0; i < bed.n; i++) ck_assert_double_eq_tol(p.power[i], expected[i], 1e-13 * size);
    /* equals */
    struct powers same = powers_of(&bed, e);
    powers_point(&same);
    for (uint32_t i = 0; i < bed.n; i++) same.emission[i] = 77;
    for (int b = 0; b < 2; b++) same.body_emission[b] = 77;
    ck_assert_int_eq(fibrad_rows_flow(&rows, bed.n, 2, &same.flow), FIBRAD_OK);
    for (uint32_t i = 0; i < bed.n; i++) ck_assert_double_eq(same.power[i], 0);
    ck_assert(same.body_power[0] == 0 && same.body_power[1] == 0 && same.flow.surroundings_power == 0);
    free(expected), free((void *)(uintptr_t)raw.matrix);
    powers_free(&p), powers_free(&twice), powers_free(&same);
    rows_free(&rows);
    free(scene);
    bed_free(&bed);
}
END_TEST

/* In a closed box of spheres alone the powers are those of the averaged matrix. */
START_TEST(powers_are_those_of_the_averaged_matrix) {
    struct bed bed = packing(80, .7, 1, .5, 3, true);
    fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    double e[80];
    for (int i = 0; i < 80; i++) e[i] = .5 + .005 * i;
    fibrad_rows rows = exchange_rows(scene, bed.n, &(fibrad_exchange_rule){.emissivity = e});
    struct powers p = powers_of(&bed, e);
    powers_point(&p);
    ck_assert_int_eq(fibrad_rows_flow(&rows, bed.n, 0, &p.flow), FIBRAD_OK);
    const struct matrix m = matrix_of(scene, &rows, 1, &(fibrad_matrix_rule){.emissivity = e});
    double largest = 0;
    for (uint32_t i = 0; i < bed.n; i++) largest = fmax(largest, fabs(p.power[i]));
    for (uint32_t i = 0; i < bed.n; i++) {
        const fibrad_row row = matrix_row(&m.factors, i);
        double power = 0;
        for (uint32_t k = 0; k < row.length; k++)
            power += p.weight[i] * row.f[k] * (p.emission[row.col[k]] - p.emission[i]);
        ck_assert_double_eq_tol(p.power[i], power,
                                .02 * largest); /* the matrix brings sums to those of raw rows, too */
    }
    free((void *)(uintptr_t)m.matrix);
    powers_free(&p);
    rows_free(&rows);
    free(scene);
    bed_free(&bed);
}
END_TEST

/* ---- errors ----------------------------------------------------------------------------------------------------- */

START_TEST(bad_regions_and_occupancies_are_refused) {
    struct bed bed = bed_of(2, (const double[][4]){{0, 0, 0, 1}, {0, 0, 3, 1}});
    struct part p = part_of(&bed, (fibrad_scene_config){0});
    const uint64_t mark[1] = {1};
    const fibrad_occupancy good = {.high = {1, 1, 1}, .cells = {4, 4, 4}, .mark = mark};
    fibrad_occupancy o[9];
    for (int k = 0; k < 9; k++) o[k] = good;
    o[1].high[1] = 0, o[2].low[2] = NAN, o[3].high[0] = INFINITY, o[4].cells[0] = 0, o[5].cells[2] = (1 << 20) + 1;
    o[6].periodic[1] = 2, o[7].low[0] = 2, o[8].low[1] = -2e150;
    fibrad_scene *scene;
    for (int k = 0; k < 9; k++) {
        p.config.occupancy = &o[k];
        ck_assert_int_eq(part_scene_try(&p, &scene), k == 0 ? FIBRAD_OK : FIBRAD_E_ARGUMENT);
        if (k == 0) free(scene);
    }
    p.config.occupancy = NULL;
    static const double bad[][2] = {{1, 0}, {NAN, NAN}, {0, NAN}, {NAN, 1}, {-INFINITY, 0}, {0, INFINITY}, {0, 2e150}};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        p.config.known_low[1] = bad[k][0], p.config.known_high[1] = bad[k][1];
        ck_assert_int_eq(part_scene_try(&p, &scene), FIBRAD_E_ARGUMENT);
    }
    p.config.known_low[1] = -5, p.config.known_high[1] = 5;
    ck_assert_int_eq(part_scene_try(&p, &scene), FIBRAD_OK);
    fibrad_work work = work_growing();
    fibrad_row row = row_of(2);
    ck_assert_int_eq(fibrad_surface_row(scene, &work, 0, NULL, &row), FIBRAD_E_UNSUPPORTED);
    ck_assert_uint_eq(fibrad_heat_size(NULL, scene), 0);
    static unsigned char block[1 << 20];
    fibrad_heat *heat;
    ck_assert_int_eq(fibrad_heat_init(&heat, block, sizeof block, NULL, scene), FIBRAD_E_UNSUPPORTED);
    fibrad_scene *plain = scene_of(&bed, FIBRAD_ISA_BEST);
    ck_assert_int_eq(fibrad_heat_init(&heat, block, sizeof block, NULL, plain), FIBRAD_OK);
    ck_assert_int_eq(fibrad_heat_move(heat, scene), FIBRAD_E_UNSUPPORTED);
    free(plain);
    free(scene);
    p.config.period[1] = 50;
    ck_assert_int_eq(part_scene_try(&p, &scene), FIBRAD_E_ARGUMENT);
    row_free(&row);
    work_free(&work);
    part_free(&p);
    bed_free(&bed);
}
END_TEST

/* Whatever a scene is made from tells it from others: rows of the one do not go into a matrix of the other. */
START_TEST(surroundings_tell_scenes_apart) {
    struct bed bed = bed_of(2, (const double[][4]){{0, 0, 0, 1}, {0, 0, 3, 1}});
    struct part p = part_of(&bed, (fibrad_scene_config){0});
    uint64_t mark[2] = {1, 0};
    fibrad_occupancy o = {.high = {1, 1, 1}, .cells = {4, 4, 8}};
    fibrad_scene *scene[7];
    for (int k = 0; k < 7; k++) {
        if (k == 1) p.config.known_high[0] = 50;
        if (k == 2) p.config.known_high[0] = 60;
        if (k == 3) p.config.occupancy = &o;
        if (k == 4) o.mark = mark;
        if (k == 5) mark[1] = 1;
        if (k == 6) o.periodic[2] = 1;
        scene[k] = part_scene(&p);
    }
    for (int k = 0; k < 7; k++) {
        fibrad_rows rows = rows_by_beams(scene[k], &(fibrad_beam_rule){.directions = 8});
        static unsigned char block[1 << 12];
        for (int other = 0; other < 7; other++) {
            fibrad_matrix *matrix;
            ck_assert_int_eq(fibrad_matrix_init(&matrix, block, sizeof block, scene[other], &rows, 1, NULL, NULL),
                             other == k ? FIBRAD_OK : FIBRAD_E_STATE);
        }
        rows_free(&rows);
    }
    for (int k = 0; k < 7; k++) free(scene[k]);
    part_free(&p);
    bed_free(&bed);
}
END_TEST

START_TEST(bad_flows_are_refused) {
    struct bed bed = bed_of(2, (const double[][4]){{0, 0, 0, 1}, {0, 0, 3, 1}});
    uint32_t col[] = {0, 1};
    double f[] = {.1, .2}, body[] = {.3}, e[] = {1, 1};
    fibrad_rows rows = {.memory = memory_growing()};
    fibrad_row row = {.col = col, .f = f, .body = body, .length = 2, .sphere = 1, .escaped = .1, .beyond = .3};
    ck_assert_int_eq(fibrad_rows_add(&rows, &row, 1), FIBRAD_OK);
    struct powers p = powers_of(&bed, e);
    powers_point(&p);
    fibrad_flow flow = p.flow;
    ck_assert_int_eq(fibrad_rows_flow(NULL, 2, 1, &flow), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_rows_flow(&rows, 2, 1, NULL), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_rows_flow(&rows, 1, 1, &flow), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_rows_flow(&rows, 2, 2, &flow), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_rows_flow(&rows, 2, 0, &flow), FIBRAD_E_ARGUMENT);
    double *const nan_of[] = {&p.weight[1], &p.emission[0], &p.body_emission[0], &flow.surroundings_emission};
    for (int k = 0; k < 4; k++)
        for (int infinite = 0; infinite < 2; infinite++) {
            const double before = *nan_of[k];
            *nan_of[k] = infinite ? INFINITY : NAN;
            ck_assert_int_eq(fibrad_rows_flow(&rows, 2, 1, &flow), FIBRAD_E_ARGUMENT);
            *nan_of[k] = before;
        }
    p.weight[0] = NAN; /* of a row that there is none of */
    for (int k = 0; k < 5; k++) {
        fibrad_flow bad = flow;
        if (k == 0) bad.weight = NULL;
        if (k == 1) bad.emission = NULL;
        if (k == 2) bad.power = NULL;
        if (k == 3) bad.body_emission = NULL;
        if (k == 4) bad.body_power = NULL;
        ck_assert_int_eq(fibrad_rows_flow(&rows, 2, 1, &bad), FIBRAD_E_ARGUMENT);
    }
    ck_assert(p.power[0] == 0 && p.power[1] == 0 && flow.surroundings_power == 0 && p.body_power[0] == 0);
    ck_assert_int_eq(fibrad_rows_flow(&rows, 2, 1, &flow), FIBRAD_OK);
    ck_assert(p.power[0] != 0 && isfinite(p.power[0] + p.power[1]));
    /* a row that knows nothing takes part in nothing */
    fibrad_rows_clear(&rows);
    row = (fibrad_row){.sphere = 0, .beyond = 1, .body = (double[]){0}};
    ck_assert_int_eq(fibrad_rows_add(&rows, &row, 1), FIBRAD_OK);
    p.weight[0] = 1, p.power[0] = p.power[1] = 5;
    ck_assert_int_eq(fibrad_rows_flow(&rows, 2, 1, &flow), FIBRAD_OK);
    ck_assert(p.power[0] == 5 && p.power[1] == 5);
    /* no rows, no spheres */
    ck_assert_int_eq(fibrad_rows_flow(&(fibrad_rows){0}, 0, 0, &(fibrad_flow){0}), FIBRAD_OK);
    powers_free(&p);
    rows_free(&rows);
    bed_free(&bed);
}
END_TEST

int main(void) {
    Suite *suite = suite_create("part");
    TCase *near = suite_case(suite, "near"), *beyond = suite_case(suite, "beyond"), *rest = suite_case(suite, "rest");
    tcase_add_loop_test(near, rows_depend_on_what_is_near, 0, KINDS);
    tcase_add_test(near, displacements_depend_on_what_is_near);
    tcase_add_test(near, images_are_spheres_of_the_same_id);
    tcase_add_test(near, far_triangles_are_met);
    tcase_add_test(near, triangles_repeat_alone);
    tcase_add_loop_test(near, ids_decide_among_equals, 0, 3);
    tcase_add_loop_test(beyond, nothing_is_beyond_what_holds_all, 0, 2);
    tcase_add_test(beyond, cells_are_walked_one_by_one);
    tcase_add_test(beyond, reflections_end_at_the_known_region);
    tcase_add_test(beyond, a_flying_sphere_leaves_the_sky);
    tcase_add_loop_test(beyond, beyond_is_what_rays_say, 0, 1);
    tcase_add_test(beyond, a_known_region_ends_in_a_can);
    tcase_add_loop_test(rest, turned_rows_average_to_the_fine_one, 0, 3);
    tcase_add_loop_test(rest, a_floor_below_turned_directions, 0, 2);
    tcase_add_test(rest, what_one_gains_others_lose);
    tcase_add_test(rest, powers_are_those_of_the_averaged_matrix);
    tcase_add_test(rest, bad_regions_and_occupancies_are_refused);
    tcase_add_test(rest, surroundings_tell_scenes_apart);
    tcase_add_test(rest, bad_flows_are_refused);
    return suite_run(suite);
}
