/* sunlit_lanes.c - the window of a sphere towards a light. Compiled once per instruction set.
 * SPDX-License-Identifier: MIT
 *
 * For a single window it does not pay to list near spheres. So they are found by a walk through the grid. */
#include FIBRAD_LANES_HEADER
#include "light/light.h"
#include "row/mesh_share_lanes.h"
#include "row/window_lanes.h"
#include "window/points_lanes.h"
#include "facing/faces_lanes.h"

static int find_open_points(const fibrad_workspace *space, fibrad_points *points) {
    const fibrad_discs *disc = &space->disc;
    points->count = points->open = FIBRAD_SUNLIT_POINTS;
    for (uint32_t word = 0; word < FIBRAD_SUNLIT_POINTS / 64; word++) points->seen[word] = UINT64_MAX;
    const int status = fibrad_disc_points_get(FIBRAD_SUNLIT_POINTS, &points->set);
    for (uint32_t k = 0; k < disc->count && points->open > 0 && status == FIBRAD_OK; k++)
        LANED(fibrad_points_disc)(points, disc->u[k], disc->v[k], disc->r[k]);
    return status;
}

/* Finds what triangles leave of the window. */
static int find_unshadowed(fibrad_workspace *space, const double frame[9], fibrad_unshadowed *unshadowed) {
    fibrad_face_search search;
    unshadowed->whole = true, unshadowed->count = 0;
    if (!fibrad_mesh_near(space, __builtin_inf())) return FIBRAD_OK;
    LANED(fibrad_faces_begin)(space, frame, __builtin_inf(), 0, __builtin_inf(), &search);
    for (bool more = true; more && (unshadowed->whole || unshadowed->count > 0);) {
        more = LANED(fibrad_faces_next)(space, &search);
        for (uint32_t k = 0; k < space->met->faces.count; k++)
            if (!fibrad_unshadowed_hide(unshadowed, space, frame, k))
                return fibrad_unshadowed_missed(space, unshadowed);
    }
    return FIBRAD_OK;
}

int LANED(fibrad_sunlit)(const fibrad_scene *scene, fibrad_workspace *space, uint32_t place, const double frame[9],
                         fibrad_points *points, double *open, fibrad_unshadowed *unshadowed) {
    fibrad_points none = {.count = 0};
    space->areas.overflow = false;
    space->areas.fallbacks = 0;
    space->windows = 1;
    fibrad_work_begin(space, scene, place, 0, FIBRAD_BEAM_STRIDE);
    space->near.full = true;
    space->clear_mesh = __builtin_inf(); /* the window is computed as if there were no triangles */
    *open = fibrad_max(0, LANED(fibrad_beam_window)(space, frame, &none, 0));
    if (space->disc.count > space->disc.capacity || space->areas.overflow) return fibrad_work_discs_missed(space);
    if (space->entries.missed > 0) return fibrad_work_entries_missed(space);
    if (!(*open > 0)) return FIBRAD_OK;
    if (find_open_points(space, points) != FIBRAD_OK) return FIBRAD_E_TABLE;
    space->clear_mesh = scene->clear != NULL ? scene->clear[place] : __builtin_inf();
    return find_unshadowed(space, frame, unshadowed);
}
