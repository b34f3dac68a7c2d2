/* find_contacts.c - spheres that touch each other or walls. SPDX-License-Identifier: MIT
 *
 * Spheres are sorted by classes of radius, each within a factor of two, and each class by the cells of a grid of its
 * own. Each sphere looks for smaller ones. So a large sphere among many small ones costs what its neighbours cost. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "contact/contact_list.h"
#include "contact/cylinder.h"

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
};

/* A bed in which contacts are looked for. */
struct search {
    const fibrad_contact_rule *rule;
    double period[3];
    double low[3], high[3]; /* of all centres */
    double (*at)[4];        /* [spheres], centre, within the period, and radius */
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

static void sort_class(struct search *s, struct size_class *class) {
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
}

/* Sorts spheres into classes and cells. */
static void sort_spheres(struct search *s) {
    double largest = 0;
    for (uint32_t i = 0; i < s->n; ++i) {
        largest = larger_of(largest, s->at[i][3]);
        for (int axis = 0; axis < 3; ++axis) {
            s->low[axis] = i > 0 ? smaller_of(s->low[axis], s->at[i][axis]) : s->at[i][axis];
            s->high[axis] = i > 0 ? larger_of(s->high[axis], s->at[i][axis]) : s->at[i][axis];
        }
    }
    uint32_t to = 0;
    for (uint32_t c = 0; c < CLASSES_MAX && to < s->n; ++c) {
        struct size_class class = {.begin = to};
        for (uint32_t i = 0; i < s->n; ++i) {
            if (class_of(s->at[i][3], largest) != c) continue;
            s->celled[to++].sphere = i;
            class.largest = larger_of(class.largest, s->at[i][3]);
        }
        class.end = to;
        if (class.end == class.begin) continue;
        sort_class(s, &class);
        s->class[s->classes++] = class;
    }
}

/* The first sphere of a class whose cell is at least this one. */
static uint32_t first_in_cell(const struct search *s, const struct size_class *class, uint64_t cell) {
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

/* A function that is called for each sphere of a class whose centre may lie within a box. */
typedef int met_sphere(void *context, const struct search *search, uint32_t sphere);

static int spheres_in_box(const struct search *s, const struct size_class *class, const double low[3],
                          const double high[3], met_sphere *met, void *context) {
    uint32_t from[3], to[3];
    int status = FIBRAD_OK;
    for (int axis = 0; axis < 3; ++axis) {
        if (high[axis] < s->low[axis] || low[axis] > s->high[axis]) return FIBRAD_OK;
        from[axis] = class_cell(s, class, axis, low[axis]), to[axis] = class_cell(s, class, axis, high[axis]);
    }
    for (uint32_t x = from[0]; x <= to[0]; ++x)
        for (uint32_t y = from[1]; y <= to[1] && !status; ++y) {
            const uint64_t last = cell_number(class, (const uint32_t[3]){x, y, to[2]});
            uint32_t k = first_in_cell(s, class, cell_number(class, (const uint32_t[3]){x, y, from[2]}));
            for (; k < class->end && s->celled[k].cell <= last && !status; ++k)
                status = met(context, s, s->celled[k].sphere);
        }
    return status;
}

/* Gas conducts up to this distance of surfaces. */
static double reach_of(const struct search *s, double smaller) { return s->rule->gas_reach * smaller; }

/* One image of a sphere that looks for others. */
struct looking {
    uint32_t sphere;
    double at[3];
};

/* Takes a smaller sphere that is near enough. Of two equal ones the one with the larger number looks for the other. A
 * sphere and its own image conduct nothing. */
static int take_pair(void *context, const struct search *s, uint32_t other) {
    const struct looking *from = context;
    const double r = s->at[from->sphere][3], *o = s->at[other];
    if (o[3] > r || (o[3] == r && other >= from->sphere)) return FIBRAD_OK;
    const double distance = length_of(o[0] - from->at[0], o[1] - from->at[1], o[2] - from->at[2]);
    if (distance >= r + o[3] + reach_of(s, o[3])) return FIBRAD_OK;
    return fibrad_contact_add(s->found, &(struct contact_found){from->sphere, other, distance, r, o[3]});
}

/* Looks for smaller spheres about one image of a sphere. */
static int look_about(const struct search *s, struct looking *from) {
    int status = FIBRAD_OK;
    for (uint32_t c = 0; c < s->classes && !status; ++c) {
        const struct size_class *class = &s->class[c];
        const double reach = s->at[from->sphere][3] + class->largest + reach_of(s, class->largest);
        double low[3], high[3];
        for (int axis = 0; axis < 3; ++axis) low[axis] = from->at[axis] - reach, high[axis] = from->at[axis] + reach;
        status = spheres_in_box(s, class, low, high, take_pair, from);
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
    struct search s = {.rule = rule, .n = spheres->n, .found = &found};
    s.at = malloc((s.n + (size_t)1) * sizeof *s.at), s.celled = malloc((s.n + (size_t)1) * sizeof *s.celled);
    int status = s.at && s.celled ? FIBRAD_OK : FIBRAD_E_MEMORY;
    for (int axis = 0; axis < 3 && config; ++axis) s.period[axis] = config->period[axis];
    if (!status) copy_spheres(&s, spheres);
    if (!status) sort_spheres(&s), status = find_pairs(&s);
    for (uint32_t b = 0; config && b < config->walls && !status; ++b)
        if (config->wall[b].kind != FIBRAD_WALL_MESH) status = find_at_wall(&s, &config->wall[b], b);
    if (!status && config && config->triangles) status = find_at_triangles(&s, config->triangles);
    free(s.at);
    free(s.celled);
    return fibrad_contact_list_of(&found, rule, status, list);
}
