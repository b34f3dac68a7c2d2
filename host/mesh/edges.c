/* edges.c - edges of triangles, and connected components with one winding. SPDX-License-Identifier: MIT */
#include <stdlib.h>

#include "cli/message.h"
#include "mesh/welded.h"

#define NONE UINT32_MAX

/* Edge k of triangle t, from corner k to the next corner. half = 3 t + k. */
struct half_edge {
    uint64_t ends; /* 2^32 times the lower vertex, and the higher one */
    uint32_t half;
};

static int compare_edges(const void *a, const void *b) {
    const struct half_edge *one = a, *other = b;
    if (one->ends != other->ends) return one->ends < other->ends ? -1 : 1;
    return one->half < other->half ? -1 : one->half > other->half;
}

static struct half_edge edge_of(const struct surface *surface, uint32_t half) {
    const uint32_t *corner = surface->corner[half / 3];
    const uint64_t a = corner[half % 3], b = corner[(half % 3 + 1) % 3];
    return (struct half_edge){a < b ? a << 32 | b : b << 32 | a, half};
}

/* Whether a half edge goes from its lower vertex to its higher one. */
static bool goes_up(const struct surface *surface, uint32_t half) {
    return surface->corner[half / 3][half % 3] == edge_of(surface, half).ends >> 32;
}

/* partner [3 n]: the other half of an edge of exactly two triangles, else NONE. */
static int find_partners(struct surface *surface, uint32_t *partner) {
    const uint64_t count = 3 * (uint64_t)surface->n;
    struct half_edge *edge = malloc((size_t)count * sizeof *edge);
    if (!edge) return message_memory();
    for (uint32_t half = 0; half < count; ++half) edge[half] = edge_of(surface, half);
    qsort(edge, (size_t)count, sizeof *edge, compare_edges);
    for (uint64_t k = 0, end; k < count; k = end) {
        for (end = k + 1; end < count && edge[end].ends == edge[k].ends;) ++end;
        for (uint64_t e = k; e < end; ++e) partner[edge[e].half] = NONE;
        surface->open += end - k == 1;
        surface->crowded += end - k > 2;
        if (end - k != 2) continue;
        partner[edge[k].half] = edge[k + 1].half;
        partner[edge[k + 1].half] = edge[k].half;
    }
    free(edge);
    return STATUS_OK;
}

/* Gathers the triangles of a component: follows partners from its first triangle and lists the triangles found. */
static void gather_component(struct surface *surface, const uint32_t *partner, bool *met, struct component *component) {
    uint32_t *list = surface->in_components;
    for (uint32_t k = component->first; k < component->first + component->n; ++k) {
        surface->component_of[list[k]] = surface->components - 1;
        for (uint32_t half = 3 * list[k]; half < 3 * list[k] + 3; ++half) {
            const uint32_t other = partner[half];
            if (other == NONE) {
                component->closed = false;
                continue;
            }
            const bool alike = goes_up(surface, half) != goes_up(surface, other);
            const unsigned char turned = surface->turned[list[k]] ^ !alike;
            if (!met[other / 3]) {
                met[other / 3] = true;
                surface->turned[other / 3] = turned;
                list[component->first + component->n++] = other / 3;
            } else if (surface->turned[other / 3] != turned) {
                component->twisted = true;
            }
        }
    }
}

/* Of the two windings in a component, marks as turned the one with the smaller area. */
static void keep_majority(struct surface *surface, const struct component *component) {
    double area[2] = {0, 0};
    for (uint32_t k = component->first; k < component->first + component->n; ++k)
        area[surface->turned[surface->in_components[k]]] += surface_area(surface, surface->in_components[k]);
    for (uint32_t k = component->first; k < component->first + component->n && area[1] > area[0]; ++k)
        surface->turned[surface->in_components[k]] ^= 1;
}

static int gather_all_components(struct surface *surface, const uint32_t *partner, bool *met) {
    bool good = true;
    for (uint32_t t = 0, listed = 0; t < surface->n; ++t) {
        if (met[t]) continue;
        surface->component = memory_grown(surface->component, surface->components, sizeof *surface->component, &good);
        if (!good) return message_memory();
        struct component *component = &surface->component[surface->components++];
        *component = (struct component){.first = listed, .n = 1, .closed = true};
        met[t] = true;
        surface->in_components[listed] = t;
        gather_component(surface, partner, met, component);
        keep_majority(surface, component);
        listed += component->n;
    }
    return STATUS_OK;
}

int surface_find_components(struct surface *surface) {
    uint32_t *partner = malloc((3 * (size_t)surface->n + 1) * sizeof *partner);
    bool *met = calloc((size_t)surface->n + 1, sizeof *met);
    surface->in_components = malloc(((size_t)surface->n + 1) * sizeof *surface->in_components);
    surface->component_of = malloc(((size_t)surface->n + 1) * sizeof *surface->component_of);
    surface->turned = calloc((size_t)surface->n + 1, sizeof *surface->turned);
    const bool room = partner && met && surface->in_components && surface->component_of && surface->turned;
    int status = room ? STATUS_OK : message_memory();
    if (!status) status = find_partners(surface, partner);
    if (!status) status = gather_all_components(surface, partner, met);
    free(partner);
    free(met);
    return status;
}
