/* wall_rows.c - rows of walls by paths, and what the triangles of walls see. SPDX-License-Identifier: MIT */
#include "simple/rows.h"

#include <math.h>

/* Largest number of paths from each wall. All numbers of paths are powers of two: so many points are spread most evenly
 * and err half as much as a similar number of points. */
#define PATHS_MOST (1u << 24)

/* In large beds the paths from a wall cost about as much as one row in SPHERES_PER_SHARE: all walls take some percent
 * of the work. In small beds a wall has up to FEW_PATHS paths even so. */
#define SPHERES_PER_SHARE 2048u
#define FEW_PATHS         16384u

enum { VIEWS_AT_ONCE = 16 };

/* Walls one behind the other, or one opening. */
struct wall_tasks {
    fibrad_bed *bed;
    fibrad_wall_rule rule;
    double tolerance;                 /* 0: none */
    uint32_t first, walls;            /* number of the first one, and how many */
    uint32_t paths[FIBRAD_WALLS_MAX]; /* from each wall; 0: its row is not computed in this round */
    fibrad_wall_row part[FIBRAD_WALLS_MAX][FIBRAD_WALL_PARTS];
};

static int run_part(void *tasks, int thread, uint32_t task) {
    struct wall_tasks *walls = tasks;
    const uint32_t k = task / FIBRAD_WALL_PARTS, part = task % FIBRAD_WALL_PARTS;
    fibrad_wall_rule rule = walls->rule;
    rule.paths = walls->paths[k];
    if (rule.paths == 0) return FIBRAD_OK;
    return fibrad_exchange_wall(walls->bed->scene, &walls->bed->team.work[thread], walls->first + k, &rule, part,
                                &walls->part[k][part], NULL);
}

/* The next number of paths if the error of `paths` is `ratio` times the tolerance. The error falls about as paths^-0.7:
 * by 1.62 each time the paths are doubled. */
static uint32_t more_paths(uint32_t paths, double ratio) {
    do paths *= 2, ratio /= 1.62;
    while (ratio > 1 && paths < PATHS_MOST);
    return paths;
}

uint32_t fibrad_bed_wall_paths(const fibrad_bed *bed, uint64_t paths) {
    const uint64_t share = paths * bed->facts.spheres / SPHERES_PER_SHARE, few = paths < FEW_PATHS ? paths : FEW_PATHS;
    const uint64_t wanted = share > few ? share : few;
    uint32_t even = FIBRAD_WALL_PARTS;
    while (even < wanted && even < PATHS_MOST) even *= 2;
    return even;
}

/* Follows the paths of all tasks, more and more until each wall has its tolerance. row [walls]: those with paths. */
static int run_rounds(struct wall_tasks *tasks, fibrad_wall_row *row) {
    fibrad_bed *bed = tasks->bed;
    const double tolerance = tasks->tolerance;
    int status = FIBRAD_OK;
    for (bool again = true; again && !status;) {
        status = fibrad_team_run(&bed->team, "walls", tasks->walls * FIBRAD_WALL_PARTS, 1, run_part, tasks, NULL);
        bed->fault.triangle = bed->team.triangle;
        again = false;
        for (uint32_t b = 0; b < tasks->walls && !status; ++b) {
            uint32_t *paths = &tasks->paths[b];
            if (*paths == 0) continue;
            status = fibrad_exchange_wall_mean(tasks->part[b], &row[b]);
            const bool enough = !(tolerance > 0 && row[b].error > tolerance) || *paths >= PATHS_MOST;
            *paths = enough ? 0 : more_paths(*paths, row[b].error / tolerance);
            again = again || !enough;
        }
    }
    return status;
}

int fibrad_bed_wall_rows(fibrad_bed *bed, const fibrad_wall_rule *rule, double tolerance, fibrad_wall_row *row) {
    struct wall_tasks tasks = {.bed = bed, .rule = *rule, .tolerance = tolerance, .walls = bed->facts.walls};
    for (uint32_t b = 0; b < tasks.walls; ++b) {
        row[b] = (fibrad_wall_row){0};
        tasks.paths[b] = isfinite(fibrad_scene_wall_area(bed->scene, b)) ? rule->paths : 0;
    }
    return run_rounds(&tasks, row);
}

int fibrad_bed_wall_row(fibrad_bed *bed, uint32_t wall, const fibrad_wall_rule *rule, double tolerance,
                        fibrad_wall_row *row) {
    if (!rule || !row) return FIBRAD_E_ARGUMENT;
    struct wall_tasks tasks = {.bed = bed, .rule = *rule, .tolerance = tolerance, .first = wall, .walls = 1};
    tasks.paths[0] = rule->paths ? rule->paths : FIBRAD_WALL_PATHS_DEFAULT;
    const int status = fibrad_bed_begin(bed);
    return status ? status : fibrad_bed_end(bed, run_rounds(&tasks, row));
}

struct view_tasks {
    const fibrad_scene *scene;
    fibrad_team *team;
    uint32_t rays;
    fibrad_side_view *view;
};

static int run_view(void *view_tasks, int thread, uint32_t task) {
    const struct view_tasks *tasks = view_tasks;
    fibrad_side_view view[2];
    uint32_t triangle;
    const int status = fibrad_triangle_views(tasks->scene, task, tasks->rays, &triangle, view);
    if (status)
        tasks->team->work[thread].triangle = triangle;
    else
        for (int back = 0; back < 2; ++back) tasks->view[2 * (size_t)triangle + (size_t)back] = view[back];
    return status;
}

int fibrad_bed_views(fibrad_bed *bed, uint32_t rays, fibrad_side_view *view) {
    int status = fibrad_bed_begin(bed);
    if (status) return status;
    struct view_tasks tasks = {bed->scene, &bed->team, rays, view};
    status = fibrad_team_run(&bed->team, "triangles", bed->facts.triangles, VIEWS_AT_ONCE, run_view, &tasks, NULL);
    bed->fault.triangle = bed->team.triangle;
    return fibrad_bed_end(bed, status);
}
