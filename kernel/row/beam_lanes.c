/* beam_lanes.c - a row of view factors by parallel beams. Compiled once per instruction set. SPDX-License-Identifier:
 * MIT */
#include FIBRAD_LANES_HEADER
#include "row/beam.h"
#include "row/beam_lanes.h"
#include "row/wall_share_lanes.h"
#include "row/window_lanes.h"
#include "window/clip_lanes.h"

#define PI 3.14159265358979323846

/* In a packed bed the first shell has 275 spheres, and two shells fit into the default memory. Of the pairs tried, from
 * (2.4, 1.25) to (5.5, 1.2), this was the fastest at 100 directions, with (4.2, 1.4); by 8 % over (3, 1.4) in points.
 */
#define SHELLS ((fibrad_stride){3.9, 1.5})

/* Notes what discs the row lacked, if it did. */
static bool lacking(fibrad_workspace *work) {
    uint32_t met = work->disc.count, room = work->disc.capacity;
    bool crowded = met > room || work->areas.overflow;
    if (crowded && room > 0) work->needed.discs = met > 2 * room ? met : 2 * room;
    return crowded;
}

int LANED(fibrad_beam_row)(const fibrad_scene *scene, fibrad_workspace *work, uint32_t i, uint32_t directions,
                           uint32_t points, double cutoff, fibrad_row *row) {
    fibrad_points window = {.count = points};
    if (points > 0) {
        int built_in = fibrad_disc_points_get(points, &window.set);
        if (built_in != FIBRAD_OK) return built_in;
    }
    work->areas.overflow = false;
    work->areas.fallbacks = 0;
    fibrad_work_begin(work, scene, scene->place[i], cutoff, SHELLS);
    double open[2] = {0, 0};
    for (uint32_t k = 0; k < directions; k++) {
        double frame[9];
        fibrad_beam_frame(k, directions, points, frame);
        work->entries.end = k == 0 || k == directions - 1;
        double rest = LANED(fibrad_beam_window)(work, frame, &window, k);
        if (lacking(work)) return row->length = 0, FIBRAD_E_CAPACITY;
        if (scene->container.walls)
            LANED(fibrad_walls_share)(work, frame, &window, k, directions, rest);
        else
            open[k % 2] += rest;
    }
    if (work->entries.missed > 0) {
        uint64_t enough = (uint64_t)work->entries.capacity + work->entries.missed;
        work->needed.entries = (uint32_t)(enough < scene->facts.spheres ? enough : scene->facts.spheres);
        return row->length = 0, FIBRAD_E_CAPACITY;
    }
    double scale = points > 0 ? 1.0 / ((double)directions * points) : 1 / (directions * PI);
    int status = fibrad_entries_row(work, scale, row);
    if (status != FIBRAD_OK) return status;
    row->escaped = (open[0] + open[1] + work->wall[FIBRAD_WALLS]) * scale;
    for (int wall = 0; wall < FIBRAD_WALLS; wall++) row->wall[wall] = fibrad_max(0, work->wall[wall]) * scale;
    row->error *= fibrad_entries_gain(&work->entries);
    row->directions = directions;
    row->fallbacks = work->areas.fallbacks;
    row->reach = fibrad_min(work->deepest, work->reach) * work->unit;
    return FIBRAD_OK;
}
