/* beam_lanes.c - a row of view factors by parallel beams. Compiled once per instruction set.
 * SPDX-License-Identifier: MIT */
#include FIBRAD_LANES_HEADER
#include "base/constants.h"
#include "sample/direction.h"
#include "row/beam_lanes.h"
#include "work/legs_lanes.h"
#include "row/mesh_share_lanes.h"
#include "row/wall_share_lanes.h"
#include "row/window_lanes.h"
#include "window/clip_lanes.h"

#define FEW_POINTS 64u /* of windows of rows with few windows */

/* The directions of a rule. */
typedef struct beam_frames {
    uint32_t directions;
    bool turned;
    double turn[9];
} beam_frames;

static void LANED(frame_of_beam)(const void *from, uint32_t k, uint32_t points, double frame[9]) {
    const beam_frames *frames = from;
    fibrad_beam_frame(k, frames->directions, points, frame);
    if (frames->turned) fibrad_rotate_axes(frames->turn, frame);
}

int LANED(fibrad_beam_lanes)(const fibrad_scene *scene, fibrad_workspace *work, uint32_t i,
                             const fibrad_beam_rule *rule, const fibrad_beam_range *range, fibrad_row *row) {
    static const double centre[3] = {0, 0, 0};
    const uint32_t directions = rule->directions, points = rule->points;
    fibrad_points window = {.count = points};
    if (points > 0) {
        int built_in = fibrad_disc_points_get(points, &window.set);
        if (built_in != FIBRAD_OK) return built_in;
    }
    work->areas.overflow = false;
    work->areas.fallbacks = 0;
    work->windows = directions;
    fibrad_work_begin(work, scene, scene->place[i], rule->cutoff, FIBRAD_BEAM_STRIDE);
    double open[2] = {0, 0}, parts[2] = {0, 0};
    beam_frames frames = {.directions = directions, .turned = rule->turn != 0};
    /* Rows of 64 points have so few windows that directions of lines would spread widely. The open part of a window
     * does not follow them that far. Factors of walls would be too large by up to 1.5 % at 14 windows. If such rows are
     * turned at random, parallel lines have no bias. */
    work->parallel = frames.turned && points == FEW_POINTS;
    const fibrad_window_set set = {LANED(frame_of_beam), &frames, directions, directions, points, frames.turned};
    if (scene->container.walls) {
        work->walls->view = fibrad_wall_view_of(scene, work->place, work->cut, work->reach);
        fibrad_zero(&work->walls->sums, sizeof work->walls->sums);
        work->walls->sums.addends = range->addends;
    }
    work->entries.addends = range->addends;
    if (range->part != NULL) fibrad_beam_replay(work, range, directions, open);
    if (frames.turned) fibrad_rotation(rule->turn, frames.turn);
    LANED(begin_legs)(&work->legs);
    for (uint32_t k = range->from; k < range->to; k++) {
        double frame[9];
        LANED(frame_of_beam)(&frames, k, points, frame);
        work->entries.end = k == 0 || k == directions - 1;
        double rest = LANED(fibrad_beam_window)(work, frame, &window, k);
        if (work->disc.count > work->disc.capacity || work->areas.overflow) return fibrad_work_discs_missed(work);
        LANED(take_legs)(work, frame, k);
        const bool meets = work->met != NULL && work->met->any;
        if (meets) LANED(fibrad_mesh_count)(work, frame, k);
        if (scene->container.walls)
            LANED(fibrad_walls_share)(work, frame, meets && points == 0 ? &work->met->points : &window, k, &set, rest);
        else if (work->cut && rest != 0 && fibrad_work_met(work, centre, frame + 6) == FIBRAD_BEYOND)
            fibrad_work_slot(work, FIBRAD_BEYOND, k, rest);
        else if (range->addends != NULL)
            fibrad_addends_put(range->addends, FIBRAD_ADD_OPEN, k, rest);
        else
            open[k % 2] += rest;
    }
    if (work->entries.missed > 0) return fibrad_work_entries_missed(work);
    if (work->back != UINT32_MAX) return FIBRAD_E_BACK;
    row->fallbacks = work->areas.fallbacks;
    row->length = 0;
    if (range->addends != NULL) return FIBRAD_OK;
    double scale = points > 0 ? 1.0 / ((double)directions * points) : 1 / (directions * FIBRAD_PI);
    int status = fibrad_entries_row(&work->entries, scene, scale, row);
    if (status != FIBRAD_OK) return status;
    if (scene->container.walls) LANED(fibrad_walls_complete)(work, &set, parts);
    fibrad_entries_slots(&work->entries, scene, work->wall);
    row->escaped = (open[0] + open[1] + work->wall[FIBRAD_ESCAPED]) * scale;
    row->beyond = work->wall[FIBRAD_BEYOND] * scale;
    for (uint32_t slot = 0; slot < FIBRAD_SLOTS; slot++)
        if (fibrad_slot_of_body(slot)) work->wall[slot] = fibrad_max(0, work->wall[slot]) * scale;
    fibrad_row_cut(scene, work->place, work->wall, row);
    fibrad_row_bodies(scene, work->wall, row);
    if (parts[0] > 0) row->error = fibrad_sqrt(row->error * row->error + parts[0] * scale * scale);
    row->error = fibrad_entries_error(&work->entries, parts, row->error, scale);
    row->directions = directions;
    row->symmetric = 0;
    return fibrad_row_checked(scene, row);
}
