/* wall_rows.c - rows of walls by paths, and what the triangles of walls see. SPDX-License-Identifier: MIT */
#include "simple/job.h"

#include <math.h>

/* Largest number of paths from each wall. All numbers of paths are powers of two: so many points are spread most evenly
 * and err half as much as a similar number of points. */
#define PATHS_MOST (1u << 24)

/* In large beds the paths from a wall cost about as much as one row in SPHERES_PER_SHARE: all walls take some percent
 * of the work. In small beds a wall has up to FEW_PATHS paths even so. */
#define SPHERES_PER_SHARE 2048u
#define FEW_PATHS         16384u

enum { VIEWS_AT_ONCE = 16 };

struct wall_tasks {
    fibrad_job *job;
    fibrad_exchange_rule rule;
    uint32_t paths[FIBRAD_WALLS_MAX]; /* from each wall; 0: its row is not computed in this round */
    fibrad_wall_row part[FIBRAD_WALLS_MAX][FIBRAD_WALL_PARTS];
};

static int run_part(void *tasks, int thread, uint32_t task) {
    struct wall_tasks *walls = tasks;
    const uint32_t wall = task / FIBRAD_WALL_PARTS, part = task % FIBRAD_WALL_PARTS;
    fibrad_exchange_rule rule = walls->rule;
    rule.paths = walls->paths[wall];
    if (rule.paths == 0) return FIBRAD_OK;
    return fibrad_exchange_wall(walls->job->scene, &walls->job->team.work[thread], wall, &rule, part,
                                &walls->part[wall][part], NULL);
}

/* The next number of paths if the error of `paths` is `ratio` times the tolerance. The error falls about as paths^-0.7:
 * by 1.62 each time the paths are doubled. */
static uint32_t more_paths(uint32_t paths, double ratio) {
    do paths *= 2, ratio /= 1.62;
    while (ratio > 1 && paths < PATHS_MOST);
    return paths;
}

uint32_t fibrad_job_wall_paths(const fibrad_job *job, uint64_t paths) {
    const uint64_t share = paths * job->facts.spheres / SPHERES_PER_SHARE, few = paths < FEW_PATHS ? paths : FEW_PATHS;
    const uint64_t wanted = share > few ? share : few;
    uint32_t even = FIBRAD_WALL_PARTS;
    while (even < wanted && even < PATHS_MOST) even *= 2;
    return even;
}

int fibrad_job_walls(fibrad_job *job, const fibrad_exchange_rule *rule, fibrad_wall_row *row) {
    const uint32_t walls = job->facts.walls;
    struct wall_tasks tasks = {.job = job, .rule = *rule};
    int status = FIBRAD_OK;
    for (uint32_t b = 0; b < walls; ++b) {
        row[b] = (fibrad_wall_row){0};
        tasks.paths[b] = isfinite(fibrad_scene_wall_area(job->scene, b)) ? rule->paths : 0;
    }
    for (bool again = true; again && !status;) {
        status = fibrad_team_run(&job->team, "walls", walls * FIBRAD_WALL_PARTS, 1, run_part, &tasks, NULL);
        if (job->run) job->run->fault.triangle = job->team.triangle;
        again = false;
        for (uint32_t b = 0; b < walls && !status; ++b) {
            if (tasks.paths[b] == 0) continue;
            status = fibrad_exchange_wall_mean(tasks.part[b], &row[b]);
            const bool enough =
                !(rule->tolerance > 0 && row[b].error > rule->tolerance) || tasks.paths[b] == PATHS_MOST;
            tasks.paths[b] = enough ? 0 : more_paths(tasks.paths[b], row[b].error / rule->tolerance);
            again = again || !enough;
        }
    }
    return status;
}

/* The paths of one wall or opening. */
struct wall_paths {
    fibrad_job job;
    uint32_t wall;
    fibrad_exchange_rule rule;
    fibrad_wall_row part[FIBRAD_WALL_PARTS];
};

static int run_paths(void *wall_paths, int thread, uint32_t part) {
    struct wall_paths *w = wall_paths;
    return fibrad_exchange_wall(w->job.scene, &w->job.team.work[thread], w->wall, &w->rule, part, &w->part[part], NULL);
}

int fibrad_exchange_wall_row(const fibrad_scene_config *config, const fibrad_spheres *spheres, uint32_t wall,
                             const fibrad_exchange_rule *rule, fibrad_run *run, fibrad_wall_row *row) {
    if (!rule || !row) return FIBRAD_E_ARGUMENT;
    struct wall_paths w = {.wall = wall, .rule = *rule};
    int status = fibrad_job_open(&w.job, config, spheres, run);
    if (w.rule.paths == 0) w.rule.paths = FIBRAD_WALL_PATHS_DEFAULT;
    for (bool again = true; again && !status;) {
        status = fibrad_team_run(&w.job.team, "walls", FIBRAD_WALL_PARTS, 1, run_paths, &w, NULL);
        if (run && status == FIBRAD_E_BACK) run->fault.triangle = w.job.team.triangle;
        if (!status) status = fibrad_exchange_wall_mean(w.part, row);
        again = !status && rule->tolerance > 0 && row->error > rule->tolerance && w.rule.paths < PATHS_MOST;
        if (again) w.rule.paths = more_paths(w.rule.paths, row->error / rule->tolerance);
    }
    fibrad_job_close(&w.job);
    return status;
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

int fibrad_side_views(const fibrad_scene_config *config, const fibrad_spheres *spheres, uint32_t rays, fibrad_run *run,
                      fibrad_side_view *view) {
    fibrad_job job;
    int status = fibrad_job_open(&job, config, spheres, run);
    if (!status && !view && job.facts.triangles > 0) status = FIBRAD_E_ARGUMENT;
    struct view_tasks tasks = {job.scene, &job.team, rays, view};
    if (!status)
        status = fibrad_team_run(&job.team, "triangles", job.facts.triangles, VIEWS_AT_ONCE, run_view, &tasks, NULL);
    if (run && status == FIBRAD_E_BACK) run->fault.triangle = job.team.triangle;
    fibrad_job_close(&job);
    return status;
}
