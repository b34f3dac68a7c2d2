/* bodies.c - rows of clumps from the rows of their members. SPDX-License-Identifier: MIT
 *
 * Rows of spheres go along whole discs. Of members that overlap, the one before the other is seen. So the discs of a
 * clump are its shadow together, and what its members exchange with other bodies is exact in sum: A_C F_CD is the sum
 * of A_i F_ij. What members exchange with each other holds what passes inside the clump. It is larger by the hidden
 * area than what the clump exchanges with itself, since the factors of each row add up to 1. */
#include "simple/bodies.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#define GAIN_MOST 2 /* the error of a row is at most so many times the difference of its halves */

/* A sphere and its clump. */
struct clumped {
    uint64_t clump; /* a number above all clumps: the sphere is alone */
    uint32_t sphere;
};

static int by_clump(const void *a, const void *b) {
    const struct clumped *x = a, *y = b;
    return x->clump != y->clump ? (x->clump < y->clump ? -1 : 1) : x->sphere < y->sphere ? -1 : x->sphere > y->sphere;
}

int fibrad_bodies_find(const fibrad_scene *scene, const fibrad_spheres *spheres, fibrad_bodies **out) {
    const uint32_t n = spheres->n, *clump = spheres->clump;
    fibrad_scene_facts facts;
    fibrad_scene_describe(scene, &facts);
    *out = NULL;
    if (facts.clumps == 0) return FIBRAD_OK;
    struct clumped *list = malloc(((size_t)n + 1) * sizeof *list);
    fibrad_bodies *bodies = malloc(sizeof *bodies + ((size_t)n + 1) * (sizeof(double) + 3 * sizeof(uint32_t)));
    if (!list || !bodies) {
        free(list);
        free(bodies);
        return FIBRAD_E_MEMORY;
    }
    bodies->area = (double *)(bodies + 1), bodies->body = (uint32_t *)(bodies->area + n + 1);
    bodies->start = bodies->body + n + 1, bodies->member = bodies->start + n + 1, bodies->n = 0;
    for (uint32_t i = 0; i < n; ++i) list[i] = (struct clumped){clump[i] ? clump[i] : UINT32_MAX + (uint64_t)1 + i, i};
    qsort(list, n, sizeof *list, by_clump);
    for (uint32_t k = 0, first = 0; k < n; ++k) { /* for now the first sphere stands for its body */
        if (k == 0 || list[k].clump != list[k - 1].clump) first = list[k].sphere;
        bodies->body[list[k].sphere] = first;
    }
    for (uint32_t i = 0; i < n; ++i)
        bodies->body[i] = bodies->body[i] == i ? bodies->n++ : bodies->body[bodies->body[i]];
    for (uint32_t k = 0; k <= n; ++k) bodies->start[k] = 0, bodies->area[k] = 0;
    for (uint32_t i = 0; i < n; ++i) ++bodies->start[bodies->body[i]];
    for (uint32_t b = 0, end = 0; b <= bodies->n; ++b) end += bodies->start[b], bodies->start[b] = end;
    for (uint32_t i = n; i-- > 0;) bodies->member[--bodies->start[bodies->body[i]]] = i;
    for (uint32_t i = 0; i < n; ++i) bodies->area[bodies->body[i]] += fibrad_scene_exposed_area(scene, i);
    free(list);
    *out = bodies;
    return FIBRAD_OK;
}

/* The row of a body in the making. */
struct merged_row {
    fibrad_row row;
    double *value, *half; /* [bodies]; half infinity: the entry is exact so far */
    unsigned char *met;   /* [bodies] */
    double gain;          /* largest error of a member over what its halves differ by */
};

static int by_column(const void *a, const void *b) {
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return x < y ? -1 : x > y;
}

static double root_of_squares(double a, double b) { return sqrt(a * a + b * b); }

/* By how much the halves of a row differ, what is open included. */
static double halves_apart(const fibrad_row *row) {
    double square = 0, sum = 0;
    for (uint32_t k = 0; k < row->length; ++k)
        if (isfinite(row->half[k])) square += (double)row->half[k] * row->half[k], sum += row->half[k];
    return larger_of(sqrt(square + sum * sum), DBL_MIN);
}

/* Adds the row of a member. share: its area over that of the body. Members err alike in what walls take. */
static void add_member(const fibrad_bodies *bodies, const fibrad_row *member, double share, uint32_t walls,
                       struct merged_row *to) {
    fibrad_row *row = &to->row;
    for (uint32_t k = 0; k < member->length; ++k) {
        const uint32_t b = bodies->body[member->col[k]];
        const double half = member->half ? member->half[k] : 0;
        if (!to->met[b]) row->col[row->length++] = b, to->value[b] = 0, to->half[b] = INFINITY;
        to->met[b] = 1;
        to->value[b] += share * member->f[k];
        if (isfinite(half)) to->half[b] = (isfinite(to->half[b]) ? to->half[b] : 0) + share * half;
    }
    for (uint32_t w = 0; w < walls; ++w) row->wall[w] += share * member->wall[w];
    row->escaped += share * member->escaped, row->beyond += share * member->beyond;
    if (!member->half) row->error = root_of_squares(row->error, share * member->error);
    if (member->half) to->gain = larger_of(to->gain, member->error / halves_apart(member));
    row->shares += share * member->shares;
    row->noise = larger_of(row->noise, member->noise * sqrt(share));
    row->lines = member->lines;
}

/* Ends the row of a body, of whose area `hidden` times is hidden. A body that is nearly convex may miss a little: then
 * it has no factor to itself, and the others are scaled. */
static void end_row(uint32_t body, double hidden, uint32_t walls, struct merged_row *to) {
    fibrad_row *row = &to->row;
    double scale = 1;
    if (hidden > 0 && !to->met[body]) row->col[row->length++] = body, to->value[body] = 0, to->half[body] = 0;
    if (hidden > 0) to->value[body] -= hidden;
    if (hidden > 0 && to->value[body] < 0) scale = 1 / (1 - to->value[body]), to->value[body] = 0;
    qsort(row->col, row->length, sizeof *row->col, by_column);
    for (uint32_t k = 0; k < row->length; ++k) {
        const uint32_t b = row->col[k];
        row->f[k] = scale * to->value[b], row->half[k] = (float)to->half[b];
        to->met[b] = 0;
    }
    for (uint32_t w = 0; w < walls; ++w) row->wall[w] *= scale;
    row->escaped *= scale, row->beyond *= scale;
    if (row->lines > 0) row->error = root_of_squares(smaller_of(to->gain, GAIN_MOST) * halves_apart(row), row->shares);
}

/* Merges all rows into one collection. of [spheres]: rows of spheres; without columns: there is none. */
static int merge_all(const fibrad_bodies *bodies, const fibrad_spheres *spheres, uint32_t walls, const fibrad_row *of,
                     struct merged_row *to, fibrad_rows *rows) {
    int status = FIBRAD_OK;
    for (uint32_t b = 0; b < bodies->n && !status; ++b) {
        double whole = 0;
        to->gain = 0;
        fibrad_row *row = &to->row;
        if (!of[bodies->member[bodies->start[b]]].col) continue;
        *row = (fibrad_row){.col = row->col, .f = row->f, .half = row->half, .wall = row->wall, .sphere = b};
        for (uint32_t w = 0; w < walls; ++w) row->wall[w] = 0;
        for (uint32_t k = bodies->start[b]; k < bodies->start[b + 1]; ++k) {
            const uint32_t i = bodies->member[k];
            const double r = spheres->r[i], share = 4 * M_PI * (r * r) / bodies->area[b];
            add_member(bodies, &of[i], share, walls, to);
            whole += share;
        }
        end_row(b, bodies->start[b + 1] - bodies->start[b] > 1 ? whole - 1 : 0, walls, to);
        status = fibrad_rows_add(rows, row, walls);
    }
    return status;
}

int fibrad_bodies_merge(const fibrad_bodies *bodies, const fibrad_spheres *spheres, uint32_t walls, const char *scratch,
                        fibrad_team *team) {
    const size_t n = bodies->n + (size_t)1;
    fibrad_scratch store;
    int status = fibrad_scratch_open(&store, scratch);
    if (status) return status;
    fibrad_rows rows = {.memory = {.resize = fibrad_scratch_resize, .context = &store}};
    double wall[FIBRAD_WALLS_MAX];
    fibrad_row *of = calloc(spheres->n + (size_t)1, sizeof *of), row;
    double *block = calloc(n, 3 * sizeof *block + sizeof(float) + sizeof(uint32_t) + 1);
    status = of && block ? FIBRAD_OK : FIBRAD_E_MEMORY;
    for (int t = 0; t < team->threads && !status; ++t)
        for (size_t at = 0; fibrad_rows_read(&team->rows[t], &at, &row);) of[row.sphere] = row;
    if (!status) {
        struct merged_row to = {.value = block, .half = block + n};
        to.row.f = to.half + n, to.row.half = (float *)(to.row.f + n);
        to.row.col = (uint32_t *)(to.row.half + n), to.met = (unsigned char *)(to.row.col + n);
        to.row.wall = wall;
        status = merge_all(bodies, spheres, walls, of, &to, &rows);
    }
    free(of);
    free(block);
    if (status) {
        fibrad_scratch_close(&store);
        return status;
    }
    for (int t = 0; t < team->threads; ++t) fibrad_rows_clear(&team->rows[t]);
    fibrad_scratch_close(&team->store[0]);
    team->store[0] = store, team->rows[0] = rows;
    team->rows[0].memory.context = &team->store[0];
    return FIBRAD_OK;
}
