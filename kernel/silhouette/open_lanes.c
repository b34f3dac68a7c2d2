/* open_lanes.c - what walls get of the directions in which a sphere is open. Compiled once per instruction set.
 * SPDX-License-Identifier: MIT */
#include FIBRAD_LANES_HEADER
#include "base/constants.h"
#include "row/wall_share_lanes.h"
#include "row/window_lanes.h"
#include "silhouette/open_lanes.h"

/* Windows are numbered so that even lines have even numbers: first those along the lines, then those against them. */
static uint32_t against(uint32_t lines) { return (lines + 3) / 4 * 4; }

static void LANED(frame_of_window)(const void *lines, uint32_t k, uint32_t points, double frame[9]) {
    const fibrad_open_lines *open = lines;
    const uint32_t first = against(open->lines), back = k >= first, line = back ? k - first : k;
    (void)points; /* a window is not turned against the others */
    for (int axis = 0; axis < 9; axis++) {
        const double along = line < open->lines ? open->line[line].frame[axis] : 0;
        frame[axis] = back && axis >= 3 ? -along : along;
    }
}

int LANED(fibrad_open_share)(fibrad_workspace *space, const fibrad_scene *scene, uint32_t place,
                             const fibrad_open_lines *open, double parts[2]) {
    const fibrad_window_set set = {.frame = LANED(frame_of_window),
                                   .from = open,
                                   .count = against(open->lines) + open->lines,
                                   .directions = 2 * open->lines,
                                   .turned = true};
    fibrad_points areas = {.count = 0};
    fibrad_wall_sums *sums = &space->walls->sums;
    space->areas.overflow = false;
    fibrad_work_begin(space, scene, place, 0, FIBRAD_BEAM_STRIDE);
    space->walls->view = fibrad_wall_view_of(scene, place, false, space->reach);
    fibrad_zero(sums, sizeof *sums);
    for (uint32_t k = 0; k < set.count; k++)
        if (k % against(open->lines) < open->lines) sums->hidden[k / 64] |= UINT64_C(1) << k % 64;
    for (uint32_t n = 0; n < open->count; n++) {
        const uint32_t which = (uint32_t)open->which[n], k = which / 2 + which % 2 * against(open->lines);
        double frame[9];
        LANED(frame_of_window)(open, k, 0, frame);
        const double rest = LANED(fibrad_beam_window)(space, frame, &areas, k);
        if (space->disc.count > space->disc.capacity || space->areas.overflow) return fibrad_work_discs_missed(space);
        if (rest == 0) continue;
        sums->hidden[k / 64] &= ~(UINT64_C(1) << k % 64);
        LANED(fibrad_walls_share)(space, frame, &areas, k, &set, rest, FIBRAD_PI);
    }
    LANED(fibrad_walls_complete)(space, &set, parts);
    return FIBRAD_OK;
}
