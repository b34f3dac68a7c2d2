/* contact_places.c - the temperatures at which spheres touch walls of triangles. SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>

#include "contact_options/contact_option.h"
#include "simple/nearest.h"

enum { PLACES_MOST = 3 };

/* A place of a wall. */
struct place {
    uint32_t side;          /* CONTACT_NO_SIDE: there is none */
    double distance, to[3]; /* from the centre of the sphere */
};

/* The place of a wall that is nearest to a sphere, but beside none of n others. */
static struct place nearest_place(const struct bed *bed, const struct meshes *meshes, uint32_t sphere, uint32_t wall,
                                  const struct place *other, int n) {
    const struct mesh *mesh = mesh_of_wall(meshes, wall);
    struct place best = {CONTACT_NO_SIDE, INFINITY, {0}};
    for (uint32_t own = 0; own < mesh->surface.n; ++own) {
        const uint32_t t = mesh->first + own;
        const bool front = meshes->front[t] == wall, back = meshes->back[t] == wall;
        double corner[3][3], normal[3];
        struct place place = {.side = CONTACT_NO_SIDE};
        bool inside;
        if (!front && !back) continue;
        for (int axis = 0; axis < 3; ++axis) {
            const double at = bed_centres(bed, axis)[sphere], period = bed->period[axis];
            double middle = 0;
            for (int c = 0; c < 3; ++c) middle += (surface_corner(&mesh->surface, own, c)[axis] - at) / 3;
            for (int c = 0; c < 3; ++c)
                corner[c][axis] = surface_corner(&mesh->surface, own, c)[axis] - at -
                                  (period > 0 ? period * round(middle / period) : 0);
        }
        place.distance = nearest_on_triangle(corner, place.to, &inside);
        bool beside = place.distance >= best.distance;
        for (int k = 0; k < n; ++k) beside = beside || lies_beside(place.to, other[k].to);
        if (beside) continue;
        for (int c = 1; c < 3; ++c)
            for (int axis = 0; axis < 3; ++axis) corner[c][axis] -= corner[0][axis];
        cross(corner[1], corner[2], normal);
        place.side = 2 * t + (back && (!front || inner(normal, corner[0]) > 0)); /* the side that the centre is on */
        best = place;
    }
    return best;
}

int contacts_find_places(struct contact_state *state, const struct bed *bed, const struct walls *walls,
                         const bool own[WALLS_MAX]) {
    struct place place[PLACES_MOST];
    int n = 0;
    free(state->side);
    free(state->temperature);
    state->side = malloc((state->n + (size_t)1) * sizeof *state->side);
    state->temperature = malloc((state->n + (size_t)1) * sizeof *state->temperature);
    if (!state->side || !state->temperature) return message_memory();
    for (uint32_t k = 0; k < state->n; ++k) {
        if (state->first[k] >= bed->n) { /* walls become second ends */
            const uint32_t wall = state->first[k];
            state->first[k] = state->second[k], state->second[k] = wall;
        }
        const uint32_t i = state->first[k], end = state->second[k];
        state->side[k] = CONTACT_NO_SIDE, state->temperature[k] = NAN;
        if (i >= bed->n || end < bed->n || !own[end - bed->n]) continue;
        const bool again = k > 0 && n < PLACES_MOST && state->first[k - 1] == i && state->second[k - 1] == end;
        n = again ? n : 0;
        place[n] = nearest_place(bed, walls->meshes, i, end - bed->n, place, n);
        if (place[n].side != CONTACT_NO_SIDE) ++n;
        if (n > 0) state->side[k] = place[n - 1].side;
    }
    return STATUS_OK;
}

void contacts_place(struct contact_state *state, uint32_t spheres, const double *side_temperature,
                    const double *wall_temperature) {
    for (uint32_t k = 0; k < state->n; ++k) {
        if (state->side[k] == CONTACT_NO_SIDE) continue;
        const double own = side_temperature ? side_temperature[state->side[k]] : NAN;
        state->temperature[k] = isnan(own) ? wall_temperature[state->second[k] - spheres] : own;
    }
}
