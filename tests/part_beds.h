/* part_beds.h - beds with ids and rows by ids, for tests of divided beds. SPDX-License-Identifier: MIT */
#ifndef TESTS_PART_BEDS_H
#define TESTS_PART_BEDS_H

#include "base/random.h"
#include "fibrad_heat.h"
#include "scene/surroundings.h"
#include "fibrad_surface.h"
#include "scenes.h"
#include "meshes.h"
#include "suite.h"

/* Spheres with ids below `ids`, and the configuration of their scene. */
struct part {
    double *x, *y, *z, *r;
    uint64_t *id;
    uint32_t n, ids;
    fibrad_scene_config config;
};

static inline struct part part_room(const struct part *like, uint32_t n) {
    struct part p = {.ids = like->ids, .config = like->config};
    p.x = calloc(n + 1, sizeof *p.x), p.y = calloc(n + 1, sizeof *p.y), p.z = calloc(n + 1, sizeof *p.z);
    p.r = calloc(n + 1, sizeof *p.r), p.id = calloc(n + 1, sizeof *p.id);
    return p;
}

static inline void part_add(struct part *p, double x, double y, double z, double r, uint64_t id) {
    p->x[p->n] = x, p->y[p->n] = y, p->z[p->n] = z, p->r[p->n] = r, p->id[p->n++] = id;
}

static inline void part_free(struct part *p) { free(p->x), free(p->y), free(p->z), free(p->r), free(p->id); }

/* A bed with ids that do not follow its order. */
static inline struct part part_of(const struct bed *bed, fibrad_scene_config config) {
    struct part p = part_room(&(struct part){.ids = bed->n, .config = config}, bed->n);
    memcpy(p.config.period, bed->period, sizeof bed->period);
    uint32_t step = 7;
    while (bed->n % step == 0) step += 4;
    for (uint32_t i = 0; i < bed->n; i++)
        part_add(&p, bed->x[i], bed->y[i], bed->z[i], bed->r[i], (uint64_t)i * step % bed->n);
    return p;
}

/* The shortest distance along an axis, by way of a period or not. */
static inline double way_along(const struct part *p, int axis, double from, double to) {
    const double period = p->config.period[axis], way = to - from;
    return period > 0 ? way - period * floor(way / period + .5) : way;
}

static inline fibrad_spheres part_spheres(const struct part *p) {
    return (fibrad_spheres){.x = p->x, .y = p->y, .z = p->z, .r = p->r, .n = p->n, .id = p->id};
}

static inline int part_scene_try(const struct part *p, fibrad_scene **scene) {
    const fibrad_spheres spheres = part_spheres(p);
    const struct fibrad_triangles *triangles = p->config.triangles;
    const size_t size = fibrad_scene_size(p->n, 1) + (triangles ? fibrad_triangles_size(triangles->n, p->n) : 0);
    void *block = block_of(size);
    const int status = fibrad_scene_init(scene, block, size, &p->config, &spheres, NULL);
    if (status != FIBRAD_OK) free(block);
    return status;
}

static inline fibrad_scene *part_scene(const struct part *p) {
    fibrad_scene *scene;
    assert_ok(part_scene_try(p, &scene));
    return scene;
}

/* An occupancy that marks all cells that boxes about spheres reach into. free(mark) frees the occupancy. */
static inline fibrad_occupancy occupancy_of(const struct part *p, const double low[3], const double high[3],
                                            uint32_t cells) {
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

struct named_row {
    fibrad_row row;
    double *by_id; /* [ids] */
    uint64_t rays;
};

static inline void named_free(struct named_row *n) { row_free(&n->row), free(n->by_id); }

/* Emissivities follow from ids. */
static inline double *emissivities_of(const struct part *p) {
    double *e = calloc(p->n + 1, sizeof *e);
    for (uint32_t i = 0; i < p->n; i++) e[i] = .3 + .6 * fibrad_fraction(fibrad_mix(p->id[i]));
    return e;
}

/* Methods for rows: beams by areas, by points, and turned; cast; exchange, also turned and to a tolerance. */
enum { METHODS = 8 };

static const double wall_emissivity[7] = {.4, .9, 0, 1, .6, .3, .5};

static inline struct named_row row_by(const struct part *p, const fibrad_scene *scene, uint32_t i, int method,
                                      double cutoff) {
    struct named_row out = {.row = row_of(p->n), .by_id = calloc(p->ids, sizeof(double))};
    OWNED double *e = emissivities_of(p);
    OWNED_WORK work = work_growing();
    fibrad_beam_rule beam = {.directions = method == 2 ? 34 : 55, .points = method == 0 ? 0 : method == 1 ? 64 : 256};
    beam.cutoff = cutoff, beam.turn = method == 2 ? 99 : 0;
    const fibrad_cast_rule cast = {.rays = 600, .seed = 4, .cutoff = cutoff};
    fibrad_exchange_rule exchange = {.emissivity = e, .wall_emissivity = wall_emissivity};
    exchange.directions = method == 5 ? 145 : 0, exchange.paths = 60, exchange.seed = method == 6 ? 12347 : 0;
    exchange.cutoff = cutoff, exchange.tolerance = method == 7 ? .03 : 0;
    const int status = method < 3    ? fibrad_beam_row(scene, &work, i, &beam, &out.row)
                       : method == 3 ? fibrad_cast_row(scene, &work, i, &cast, &out.row, NULL)
                                     : fibrad_exchange_row(scene, &work, i, &exchange, &out.row, &out.rays);
    assert_ok(status);
    double sum = out.row.escaped + out.row.beyond;
    for (int b = 0; b < WALLS_MOST; b++) sum += out.row.wall[b];
    for (uint32_t k = 0; k < out.row.length; k++) {
        sum += out.row.f[k];
        out.by_id[p->id[out.row.col[k]]] += out.row.f[k];
    }
    ck_assert_double_eq_tol(sum, 1, 1e-12);
    ck_assert(out.row.beyond >= 0 && out.row.escaped >= -1e-15);
    return out;
}

static inline bool same_double(double a, double b) { return memcmp(&a, &b, sizeof a) == 0; }

static inline void expect_same_named(const struct named_row *a, const struct named_row *b, uint32_t ids,
                                     const char *what) {
    for (uint32_t id = 0; id < ids; id++)
        ck_assert_msg(same_double(a->by_id[id], b->by_id[id]), "%s: id %u: %a, %a", what, id, a->by_id[id],
                      b->by_id[id]);
    for (int wall = 0; wall < WALLS_MOST; wall++)
        ck_assert_msg(same_double(a->row.wall[wall], b->row.wall[wall]), "%s: wall %d", what, wall);
    ck_assert_msg(same_double(a->row.escaped, b->row.escaped), "%s: escaped", what);
    ck_assert_msg(same_double(a->row.beyond, b->row.beyond), "%s: beyond", what);
    ck_assert_msg(same_double(a->row.error, b->row.error), "%s: error %a, %a", what, a->row.error, b->row.error);
    ck_assert_msg(a->row.length == b->row.length && a->rays == b->rays, "%s: length, rays", what);
}

/* Beds of all kinds, and the box that they are in. */
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

enum { KINDS = sizeof kinds / sizeof *kinds, WALLS = 7 };

struct made {
    struct part part;
    fibrad_occupancy occupancy;
    fibrad_wall wall[WALLS];
    struct mesh *mesh; /* NULL: none */
    double low[3], high[3];
};

/* Adds a tube among the spheres, and a high box about them. On periodic axes the box has only a floor and a lid. */
static inline void make_mesh(struct made *m, const double period[3], fibrad_scene_config *config) {
    const double wide = period[0] > 0 ? 0 : .5, low[3] = {m->low[0] - wide, m->low[1] - wide, m->low[2] - .5};
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
    memcpy(m->wall, m->mesh->wall, sizeof m->wall);
    config->walls = tube + 1;
    config->triangles = &m->mesh->triangles;
}

/* The bed must stay where it is, since the configuration of its scene points into it. */
static inline void make_kind(struct made *m, const struct kind *k) {
    OWNED_BED bed;
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
    fibrad_scene_config config = {.wall = m->wall};
    for (int axis = 0; axis < 3; axis++) {
        if (k->walls == 0 || k->walls == 3 || bed.period[axis] > 0 || (k->walls == 2 && axis < 2)) continue;
        m->wall[config.walls++] = plane_at(axis, 0, m->low[axis]);
        m->wall[config.walls++] = plane_at(axis, 1, m->high[axis]);
    }
    m->mesh = NULL;
    if (k->walls == 3) make_mesh(m, bed.period, &config);
    if (k->walls == 2) m->wall[config.walls++] = cylinder_at(high / 2, high / 2, high);
    m->part = part_of(&bed, config);
    m->occupancy = occupancy_of(&m->part, m->low, m->high, 5);
    m->part.config.occupancy = &m->occupancy;
}

static inline void free_made(struct made *m) {
    part_free(&m->part);
    free((void *)(uintptr_t)m->occupancy.mark);
    free(m->mesh);
}

#define OWNED_MADE OWNED_BY(free_made) struct made

#endif
