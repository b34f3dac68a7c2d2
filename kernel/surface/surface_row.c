/* surface_row.c - a row of view factors by the surface method. SPDX-License-Identifier: MIT */
#include "surface/surface.h"
#include "row/row.h"
#include "scene/grid_walk.h"

/* Whether the cutoff reaches farther than FIBRAD_PERIODS periods along some axis. */
static bool periods_exceeded(const fibrad_scene *scene, double cutoff) {
    for (int axis = 0; axis < 3; axis++)
        if (scene->period[axis] > 0 && !(cutoff <= FIBRAD_PERIODS * scene->period[axis])) return true;
    return false;
}

/* Lists all spheres within the cutoff of sphere i in work->near, at their places in the scene [L]. Images are
 * included, sphere i itself is not. Spheres beyond the capacity are only counted. If the cube about the cutoff has
 * more than FIBRAD_WORK_MAX spheres, the search ends with a count above this number. */
static uint64_t list_blockers(fibrad_workspace *work) {
    const fibrad_scene *scene = work->scene;
    fibrad_near *near = &work->near;
    const double reach = work->farthest * work->unit * (1 + 1e-9);
    uint64_t count = 0, visited = 0;
    for (uint32_t l = 0; l < scene->levels; l++) {
        fibrad_walk walk;
        fibrad_walk_about(&walk, scene, &scene->level[l], work->centre, work->centre, reach);
        while (fibrad_walk_next(&walk)) {
            visited += walk.end - walk.begin;
            if (visited > FIBRAD_WORK_MAX) return visited;
            for (uint32_t j = walk.begin; j < walk.end; j++) {
                double x = scene->x[j] + walk.shift[0], dx = (x - work->centre[0]) * work->inverse;
                double y = scene->y[j] + walk.shift[1], dy = (y - work->centre[1]) * work->inverse;
                double z = scene->z[j] + walk.shift[2], dz = (z - work->centre[2]) * work->inverse;
                if ((j == work->place && !walk.image) || dx * dx + dy * dy + dz * dz > work->reach * work->reach)
                    continue;
                if (count < near->capacity) {
                    near->x[count] = x, near->y[count] = y, near->z[count] = z, near->r[count] = scene->r[j];
                    near->sphere[count] = j;
                }
                count++;
            }
        }
    }
    return count;
}

/* The frame whose z axis goes from sphere 1 to sphere 2, and the gap between the spheres. The x axis is across the
 * coordinate axis along which w is shortest. */
static double pair_frame(fibrad_surface_frame *frame, const double c1[3], double r1, const double c2[3], double r2) {
    double w[3], u[3], v[3], square = 0;
    const double scale = 1 / (r1 + r2);
    for (int axis = 0; axis < 3; axis++) {
        w[axis] = (c2[axis] - c1[axis]) * scale;
        square += w[axis] * w[axis];
    }
    const double distance = fibrad_sqrt(square);
    for (int axis = 0; axis < 3; axis++) w[axis] /= distance;
    int least = fibrad_abs(w[1]) < fibrad_abs(w[0]) ? 1 : 0;
    if (fibrad_abs(w[2]) < fibrad_abs(w[least])) least = 2;
    const int next = (least + 1) % 3, last = (least + 2) % 3;
    const double ring = fibrad_sqrt(w[next] * w[next] + w[last] * w[last]);
    u[least] = 0, u[next] = -w[last] / ring, u[last] = w[next] / ring;
    v[least] = ring, v[next] = -w[least] * w[next] / ring, v[last] = -w[least] * w[last] / ring;
    frame->scale = 1 / r1;
    for (int axis = 0; axis < 3; axis++) {
        frame->origin[axis] = c1[axis];
        frame->x[axis] = u[axis] * frame->scale;
        frame->y[axis] = v[axis] * frame->scale;
        frame->z[axis] = w[axis] * frame->scale;
    }
    return (distance - 1) * (r1 + r2);
}

/* Bytes of the two lists of obstacles of a pair. */
static size_t lists_bytes(uint64_t count) { return (size_t)(count + 7) / 8 * 8 * 8 * sizeof(double); }

/* List 0 or 1 in the extra bytes of work memory, with room for `count` obstacles. */
static fibrad_obstacles blocker_list(const fibrad_workspace *work, uint64_t count, size_t which) {
    const size_t padded = (size_t)(count + 7) / 8 * 8;
    double *x = (double *)work->extra + 4 * padded * which;
    return (fibrad_obstacles){x, x + padded, x + 2 * padded, x + 3 * padded, 0};
}

/* A completed rule and its nodes. */
typedef struct surface_row_task {
    fibrad_surface_rule rule;
    fibrad_surface_nodes nodes;
} surface_row_task;

/* The view factor from sphere i to near sphere k, and its error. */
static int factor_to(fibrad_surface_task *task, const fibrad_workspace *work, fibrad_surface_lanes lanes, uint32_t i,
                     const fibrad_obstacles *all, uint32_t k, double *f, double *error) {
    const fibrad_near *near = &work->near;
    const double centre[3] = {near->x[k], near->y[k], near->z[k]}, r = near->r[k], unit = work->unit;
    fibrad_surface_frame frame;
    fibrad_surface_facts facts;
    double scale = 1;
    int status;
    if (i <= work->scene->order[near->sphere[k]]) { /* sphere i is sphere 1 */
        const double gap = pair_frame(&frame, work->centre, unit, centre, r);
        status = fibrad_surface_factor(task, lanes, unit, r, gap, &frame, all, k, f, &facts);
    } else {
        const double gap = pair_frame(&frame, centre, r, work->centre, unit), ratio = r * work->inverse;
        status = fibrad_surface_factor(task, lanes, r, unit, gap, &frame, all, k, f, &facts);
        scale = ratio * ratio;
    }
    if (status != FIBRAD_OK) return status;
    *f *= scale;
    *error = facts.error * scale;
    return FIBRAD_OK;
}

static int surface_compute(const fibrad_scene *scene, fibrad_workspace *work, uint32_t i, const void *of,
                           fibrad_row *row) {
    const surface_row_task *given = of;
    fibrad_work_begin(work, scene, scene->place[i], given->rule.cutoff, (fibrad_stride){0});
    const uint64_t count = list_blockers(work);
    if (count > FIBRAD_WORK_MAX) return FIBRAD_E_ARGUMENT;
    if (count > work->near.capacity || lists_bytes(count) > work->plan.extra) {
        work->needed.near = count > work->near.capacity ? (uint32_t)count : work->near.capacity;
        work->needed.extra = lists_bytes(count);
        return FIBRAD_E_WORK;
    }
    work->extra_owner = 0;
    fibrad_surface_task task = {.flags = given->rule.flags, .nodes = given->nodes};
    task.obstacles = blocker_list(work, count, 0), task.of_node = blocker_list(work, count, 1);
    const fibrad_near *near = &work->near;
    const fibrad_obstacles all = {near->x, near->y, near->z, near->r, (uint32_t)count};
    const fibrad_surface_lanes lanes = fibrad_surface_lanes_of(scene->facts.isa);
    double sum = 0, square = 0;
    for (uint32_t k = 0; k < all.n; k++) {
        double f, error;
        const int status = factor_to(&task, work, lanes, i, &all, k, &f, &error);
        if (status != FIBRAD_OK) return status;
        square += error * error;
        if (f == 0) continue;
        sum += f;
        fibrad_entries_add(&work->entries, fibrad_entries_of(&work->entries, near->sphere[k]), 0, f);
    }
    if (work->entries.missed > 0) return fibrad_work_entries_missed(work);
    const int status = fibrad_entries_row(&work->entries, scene, 1, row);
    if (status != FIBRAD_OK) return status;
    row->escaped = 1 - sum;
    row->error = fibrad_sqrt(square);
    row->directions = row->fallbacks = 0;
    row->symmetric = 1;
    return fibrad_row_checked(scene, row);
}

int fibrad_surface_row(const fibrad_scene *scene, fibrad_work *work, uint32_t i, const fibrad_surface_rule *rule,
                       fibrad_row *row) {
    if (scene == NULL) return FIBRAD_E_ARGUMENT;
    surface_row_task task = {0};
    if (rule != NULL) task.rule = *rule;
    const double cutoff = task.rule.cutoff;
    if (!(cutoff >= 0 && fibrad_finite(cutoff))) return FIBRAD_E_ARGUMENT;
    const bool periodic = scene->period[0] > 0 || scene->period[1] > 0 || scene->period[2] > 0;
    if ((periodic && cutoff == 0) || periods_exceeded(scene, cutoff)) return FIBRAD_E_ARGUMENT;
    if (scene->facts.walls > 0 || scene->facts.triangles > 0 || scene->container.walls) return FIBRAD_E_UNSUPPORTED;
    const int status = fibrad_surface_nodes_of(&task.rule, &task.nodes);
    if (status != FIBRAD_OK) return status;
    return fibrad_row_run(scene, work, i, &(fibrad_row_method){surface_compute, &task, 0, lists_bytes(1024)}, row);
}
