/* find_contacts.c - spheres that touch each other or walls. SPDX-License-Identifier: MIT
 *
 * Spheres are sorted by classes of radius, each within a factor of two, and each class by the cells of a grid of its
 * own. Each sphere looks for smaller ones. So a large sphere among many small ones costs what its neighbours cost. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "simple/contact_list.h"
#include "simple/cylinder.h"

enum { CLASSES_MAX = 64 };

/* A sphere in the cell of its class. */
struct celled {
    uint64_t cell;
    uint32_t sphere;
};

/* Spheres of about one radius. */
struct size_class {
    uint32_t begin, end; /* in struct search.celled */
    double largest;      /* radius */
    double edge;         /* of cells */
    uint32_t cells[3];
    uint32_t *start; /* [cells + 1], the first sphere of each; NULL: too many cells for a table */
};

/* A bed in which contacts are looked for. */
struct search {
    const fibrad_contact_rule *rule;
    double period[3];
    double low[3], high[3]; /* of all centres */
    double (*at)[4];        /* [spheres], centre, within the period, and radius */
    double (*sorted)[4];    /* the same in the order of `celled` */
    const uint32_t *clump;  /* [spheres], as in fibrad_spheres; NULL: none */
    uint32_t n;
    struct celled *celled;
    struct size_class class[CLASSES_MAX];
    uint32_t classes;
    struct contact_block *found;
};

static int by_cell(const void *a, const void *b) {
    const struct celled *x = a, *y = b;
    return x->cell != y->cell ? (x->cell < y->cell ? -1 : 1) : x->sphere < y->sphere ? -1 : x->sphere > y->sphere;
}

/* The class of a radius: how often the largest one may be halved before it is smaller. */
static uint32_t class_of(double radius, double largest) {
    uint32_t class = 0;
    while (class + 1 < CLASSES_MAX && radius < largest / 2) largest /= 2, ++class;
    return class;
}

/* The cell of a coordinate, limited to the grid. */
static uint32_t class_cell(const struct search *s, const struct size_class *class, int axis, double at) {
    const double cell = floor((at - s->low[axis]) / class->edge);
    return cell <= 0 ? 0 : cell >= class->cells[axis] - 1 ? class->cells[axis] - 1 : (uint32_t)cell;
}

static uint64_t cell_number(const struct size_class *class, const uint32_t cell[3]) {
    return ((uint64_t)cell[0] * class->cells[1] + cell[1]) * class->cells[2] + cell[2];
}

/* Notes where the spheres of each cell begin. With a sphere far away there may be too many cells for a table. Spheres
 * of a cell are then found by bisection. */
static int note_starts(const struct search *s, struct size_class *class) {
    const uint32_t *cells = class->cells;
    const double count = (double)cells[0] * cells[1] * cells[2];
    uint64_t next = 0;
    if (count > 8. * (class->end - class->begin)) return FIBRAD_OK;
    class->start = malloc(((size_t)count + 1) * sizeof *class->start);
    if (!class->start) return FIBRAD_E_MEMORY;
    for (uint32_t k = class->begin; k < class->end; ++k)
        while (next <= s->celled[k].cell) class->start[next++] = k;
    while (next <= (uint64_t)count) class->start[next++] = class->end;
    return FIBRAD_OK;
}

static int sort_class(struct search *s, struct size_class *class) {
    class->edge = 2 * class->largest * (1 + s->rule->gas_reach);
    for (int axis = 0; axis < 3; ++axis) {
        const double wide = (s->high[axis] - s->low[axis]) / class->edge;
        class->cells[axis] = wide < 1e6 ? (uint32_t)wide + 1 : 1000000;
    }
    for (uint32_t k = class->begin; k < class->end; ++k) {
        const double *at = s->at[s->celled[k].sphere];
        const uint32_t cell[3] = {class_cell(s, class, 0, at[0]), class_cell(s, class, 1, at[1]),
                                  class_cell(s, class, 2, at[2])};
        s->celled[k].cell = cell_number(class, cell);
    }
    qsort(s->celled + class->begin, class->end - class->begin, sizeof *s->celled, by_cell);
    for (uint32_t k = class->begin; k < class->end; ++k)
        memcpy(s->sorted[k], s->at[s->celled[k].sphere], sizeof *s->sorted);
    return note_starts(s, class);
}

/* Sorts spheres into classes and cells. Refuses numbers with which the search would not end. */
static int sort_spheres(struct search *s) {
    double largest = 0;
    for (uint32_t i = 0; i < s->n; ++i) {
        const double *at = s->at[i];
        if (!(fabs(at[0]) + fabs(at[1]) + fabs(at[2]) <= 3 * FIBRAD_LENGTH_MAX && at[3] >= FIBRAD_LENGTH_MIN &&
              at[3] <= FIBRAD_LENGTH_MAX))
            return FIBRAD_E_ARGUMENT;
        largest = larger_of(largest, s->at[i][3]);
        for (int axis = 0; axis < 3; ++axis) {
            s->low[axis] = i > 0 ? smaller_of(s->low[axis], s->at[i][axis]) : s->at[i][axis];
            s->high[axis] = i > 0 ? larger_of(s->high[axis], s->at[i][axis]) : s->at[i][axis];
        }
    }
    for (int axis = 0; axis < 3; ++axis)
        if (s->period[axis] != 0 && !(s->period[axis] >= largest)) return FIBRAD_E_GEOMETRY;
    uint32_t to = 0;
    int status = FIBRAD_OK;
    for (uint32_t c = 0; c < CLASSES_MAX && to < s->n && !status; ++c) {
        struct size_class class = {.begin = to};
        for (uint32_t i = 0; i < s->n; ++i) {
            if (class_of(s->at[i][3], largest) != c) continue;
            s->celled[to++].sphere = i;
            class.largest = larger_of(class.largest, s->at[i][3]);
        }
        class.end = to;
        if (class.end == class.begin) continue;
        status = sort_class(s, &class);
        s->class[s->classes++] = class;
    }
    return status;
}

/* The first sphere of a class whose cell is at least this one. */
static uint32_t first_in_cell(const struct search *s, const struct size_class *class, uint64_t cell) {
    if (class->start) return class->start[cell];
    uint32_t low = class->begin, high = class->end;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (s->celled[middle].cell < cell)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Gas conducts up to this distance of surfaces. */
static double reach_of(const struct search *s, double smaller) { return s->rule->gas_reach * smaller; }

/* One image of a sphere that looks for others. */
struct looking {
    uint32_t sphere;
    double at[3];
};

/* Takes a smaller sphere that is near enough. Of two equal ones the one with the larger number looks for the other. A
 * sphere and its own image conduct nothing, nor do members of one clump. */
static int take_pair(const struct looking *from, const struct search *s, uint32_t k) {
    const uint32_t other = s->celled[k].sphere;
    const double r = s->at[from->sphere][3], *o = s->sorted[k], reach = r + o[3] + reach_of(s, o[3]);
    const double x = o[0] - from->at[0], y = o[1] - from->at[1], z = o[2] - from->at[2];
    /* one jump for all conditions: few are near */
    if ((x * x + y * y + z * z > (1 + 1e-9) * reach * reach) | (o[3] > r) | ((o[3] == r) & (other >= from->sphere)))
        return FIBRAD_OK;
    const double distance = length_of(x, y, z);
    if (distance >= reach) return FIBRAD_OK;
    if (s->clump && s->clump[other] != 0 && s->clump[other] == s->clump[from->sphere]) return FIBRAD_OK;
    return fibrad_contact_add(s->found, &(struct contact_found){from->sphere, other, distance, r, o[3]});
}

/* Takes the spheres of a class that are near enough. */
static int take_in_box(const struct search *s, const struct size_class *class, const double low[3],
                       const double high[3], const struct looking *from) {
    uint32_t first[3], to[3];
    int status = FIBRAD_OK;
    for (int axis = 0; axis < 3; ++axis) {
        if (high[axis] < s->low[axis] || low[axis] > s->high[axis]) return FIBRAD_OK;
        first[axis] = class_cell(s, class, axis, low[axis]), to[axis] = class_cell(s, class, axis, high[axis]);
    }
    for (uint32_t x = first[0]; x <= to[0]; ++x)
        for (uint32_t y = first[1]; y <= to[1] && !status; ++y) {
            const uint64_t last = cell_number(class, (const uint32_t[3]){x, y, to[2]});
            uint32_t k = first_in_cell(s, class, cell_number(class, (const uint32_t[3]){x, y, first[2]}));
            for (; k < class->end && s->celled[k].cell <= last && !status; ++k) status = take_pair(from, s, k);
        }
    return status;
}

/* Looks for smaller spheres about one image of a sphere. */
static int look_about(const struct search *s, struct looking *from) {
    int status = FIBRAD_OK;
    for (uint32_t c = 0; c < s->classes && !status; ++c) {
        const struct size_class *class = &s->class[c];
        const double reach = s->at[from->sphere][3] + class->largest + reach_of(s, class->largest);
        double low[3], high[3];
        for (int axis = 0; axis < 3; ++axis) low[axis] = from->at[axis] - reach, high[axis] = from->at[axis] + reach;
        status = take_in_box(s, class, low, high, from);
    }
    return status;
}

/* Largest number of periods by which a sphere reaches beyond its own. */
static int images_along(const struct search *s, int axis, double r) {
    return s->period[axis] > 0 ? (int)ceil((2 * r + reach_of(s, r)) / s->period[axis]) : 0;
}

static int find_pairs(struct search *s) {
    int status = FIBRAD_OK;
    for (uint32_t i = 0; i < s->n && !status; ++i) {
        const double *at = s->at[i];
        const int images[3] = {images_along(s, 0, at[3]), images_along(s, 1, at[3]), images_along(s, 2, at[3])};
        for (int x = -images[0]; x <= images[0]; ++x)
            for (int y = -images[1]; y <= images[1]; ++y)
                for (int z = -images[2]; z <= images[2] && !status; ++z) {
                    struct looking from = {
                        i, {at[0] + x * s->period[0], at[1] + y * s->period[1], at[2] + z * s->period[2]}};
                    status = look_about(s, &from);
                }
    }
    return status;
}

/* Distances of centres from a plane or the cylinder. */
static int find_at_wall(struct search *s, const fibrad_wall *wall, uint32_t index) {
    int status = FIBRAD_OK;
    for (uint32_t i = 0; i < s->n && !status; ++i) {
        const double *at = s->at[i];
        const double distance =
            wall->kind == FIBRAD_WALL_PLANE
                ? fabs(at[wall->plane.axis] - wall->plane.at)
                : wall->cylinder.radius - length_of(at[cylinder_across(wall, 0)] - wall->cylinder.x,
                                                    at[cylinder_across(wall, 1)] - wall->cylinder.y, 0);
        if (distance < at[3] + reach_of(s, at[3]))
            status = fibrad_contact_add(s->found, &(struct contact_found){i, s->n + index, distance, at[3], INFINITY});
    }
    return status;
}

static int find_at_triangles(struct search *s, const struct fibrad_triangles *triangles) {
    struct triangle_search at = {(const double(*)[4])s->at, s->n, s->rule->gas_reach, {0, 0, 0}};
    for (int axis = 0; axis < 3; ++axis)
        at.period[axis] = s->period[axis] > 0 ? s->period[axis] : triangles->period[axis];
    return fibrad_contact_triangles(triangles, &at, s->found);
}

static void copy_spheres(struct search *s, const fibrad_spheres *given) {
    const size_t stride = given->stride ? given->stride : 1, stride_r = given->stride_r ? given->stride_r : 1;
    const double *const coordinate[3] = {given->x, given->y, given->z};
    for (uint32_t i = 0; i < s->n; ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            const double x = coordinate[axis][i * stride], period = s->period[axis];
            s->at[i][axis] = period > 0 ? x - period * floor(x / period) : x;
        }
        s->at[i][3] = given->r[i * stride_r];
    }
}

static bool rule_valid(const fibrad_contact_rule *rule) {
    return rule->spots >= FIBRAD_SPOTS_NONE && rule->spots <= FIBRAD_SPOTS_HERTZ && rule->scale >= 0 &&
           rule->gas_reach >= 0 && rule->gas_reach <= 1 && rule->gas_jump >= 0 && rule->gas_least >= 0;
}

int fibrad_contacts_find(const fibrad_scene_config *config, const fibrad_spheres *spheres,
                         const fibrad_contact_rule *rule, fibrad_contact_list **list) {
    if (!list) return FIBRAD_E_ARGUMENT;
    *list = NULL;
    if (!spheres || !rule || !rule_valid(rule) ||
        (spheres->n > 0 && !(spheres->x && spheres->y && spheres->z && spheres->r)))
        return FIBRAD_E_ARGUMENT;
    struct contact_block found = {.n = 0};
    struct search s = {.rule = rule, .n = spheres->n, .clump = spheres->clump, .found = &found};
    s.at = malloc(2 * (s.n + (size_t)1) * sizeof *s.at), s.celled = malloc((s.n + (size_t)1) * sizeof *s.celled);
    s.sorted = s.at + s.n;
    int status = s.at && s.celled ? FIBRAD_OK : FIBRAD_E_MEMORY;
    for (int axis = 0; axis < 3 && config; ++axis) s.period[axis] = config->period[axis];
    if (!status) copy_spheres(&s, spheres);
    if (!status) status = sort_spheres(&s);
    if (!status) status = find_pairs(&s);
    for (uint32_t b = 0; config && b < config->walls && !status; ++b)
        if (config->wall[b].kind != FIBRAD_WALL_MESH) status = find_at_wall(&s, &config->wall[b], b);
    if (!status && config && config->triangles) status = find_at_triangles(&s, config->triangles);
    free(s.at);
    free(s.celled);
    for (uint32_t c = 0; c < s.classes; ++c) free(s.class[c].start);
    return fibrad_contact_list_of(&found, rule, status, list);
}
