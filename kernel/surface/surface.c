/* surface.c - view factors by tensor-product Fibonacci integration. SPDX-License-Identifier: MIT */
#include "surface/surface.h"
#include "base/arena.h"

#define ALL_FLAGS                                                                                                      \
    (FIBRAD_SURFACE_NO_CORRECTION | FIBRAD_SURFACE_NO_HORIZON | FIBRAD_SURFACE_NO_REGION | FIBRAD_SURFACE_NO_EXACT |   \
     FIBRAD_SURFACE_NO_HIDDEN)

fibrad_surface_lanes fibrad_surface_lanes_of(int isa) {
    return (fibrad_surface_lanes){FIBRAD_VERSION_OF(fibrad_surface_filter, isa),
                                  FIBRAD_VERSION_OF(fibrad_surface_sum, isa)};
}

int fibrad_surface_nodes_of(const fibrad_surface_rule *rule, fibrad_surface_nodes *nodes) {
    if ((rule->flags & ~(uint32_t)ALL_FLAGS) != 0) return FIBRAD_E_ARGUMENT;
    return fibrad_surface_nodes_get(rule->nodes == 0 ? FIBRAD_NODES_DEFAULT : rule->nodes, nodes);
}

int fibrad_surface_factor(fibrad_surface_task *task, fibrad_surface_lanes lanes, double r1, double r2, double gap,
                          const fibrad_surface_frame *frame, const fibrad_obstacles *all, uint32_t self, double *f12,
                          fibrad_surface_facts *facts) {
    double exact;
    const int status = fibrad_pair_exact(r1, r2, gap, &exact);
    if (status != FIBRAD_OK) return status;
    const bool corrected = (task->flags & FIBRAD_SURFACE_NO_CORRECTION) == 0;
    task->r2 = r2 / r1;
    task->d = 1 + task->r2 + fibrad_max(0, gap) / r1;
    *facts = (fibrad_surface_facts){0};
    const bool hidden = lanes.filter(task, frame, all, self);
    if (hidden && (task->flags & FIBRAD_SURFACE_NO_HIDDEN) == 0) {
        *f12 = 0;
        return FIBRAD_OK;
    }
    if (corrected && task->obstacles.n == 0 && (task->flags & FIBRAD_SURFACE_NO_EXACT) == 0) {
        *f12 = exact;
        return FIBRAD_OK;
    }
    fibrad_surface_sums sums;
    lanes.sum(task, &sums);
    const double n = task->nodes.n, unit = 2 * task->r2 / (n * n);
    const double open = sums.open[0] + sums.open[1], seen = sums.seen[0] + sums.seen[1];
    facts->unblocked = unit * open;
    facts->blocked = unit * seen;
    facts->rays = sums.rays;
    facts->tests = sums.tests;
    if (!corrected) {
        *f12 = facts->blocked;
        facts->error = unit * fibrad_abs(sums.seen[0] - sums.seen[1]);
    } else if (sums.open[0] > 0 && sums.open[1] > 0) {
        *f12 = seen == open ? exact : exact * (seen / open);
        facts->error = 0.5 * exact * fibrad_abs(sums.seen[0] / sums.open[0] - sums.seen[1] / sums.open[1]);
    } else { /* no nodes face each other: the radii are too different for so few nodes */
        *f12 = exact;
        facts->error = exact;
    }
    return FIBRAD_OK;
}

/* List `which` of three lists in `scratch`, with room for n obstacles each: those of the caller, those of the pair,
 * those of a node. */
static fibrad_obstacles list_of(double *scratch, uint32_t n, uint32_t which) {
    const size_t padded = ((size_t)n + 7) / 8 * 8;
    double *x = n == 0 ? NULL : scratch + 4 * padded * which;
    if (n == 0) return (fibrad_obstacles){0};
    return (fibrad_obstacles){x, x + padded, x + 2 * padded, x + 3 * padded, n};
}

int fibrad_surface_pair(double r1, double r2, double gap, const fibrad_spheres *obstacles,
                        const fibrad_surface_rule *given, double *scratch, double *f12, fibrad_surface_facts *facts) {
    fibrad_surface_rule rule = {0};
    if (given != NULL) rule = *given;
    const uint32_t n = obstacles == NULL ? 0 : obstacles->n;
    if (f12 == NULL || n > FIBRAD_SPHERES_MAX) return FIBRAD_E_ARGUMENT;
    if (n > 0 && (scratch == NULL || obstacles->x == NULL || obstacles->y == NULL || obstacles->z == NULL ||
                  obstacles->r == NULL))
        return FIBRAD_E_ARGUMENT;
    const double most = 1e70 * r1; /* room for fourth powers */
    if (!(r2 <= most && gap <= most)) return FIBRAD_E_ARGUMENT;
    const size_t stride = n > 0 && obstacles->stride > 0 ? obstacles->stride : 1;
    const size_t stride_r = n > 0 && obstacles->stride_r > 0 ? obstacles->stride_r : 1;
    for (size_t k = 0; k < n; k++)
        if (!(fibrad_abs(obstacles->x[k * stride]) <= most && fibrad_abs(obstacles->y[k * stride]) <= most &&
              fibrad_abs(obstacles->z[k * stride]) <= most && obstacles->r[k * stride_r] <= most &&
              obstacles->r[k * stride_r] > 0))
            return FIBRAD_E_ARGUMENT;
    if (rule.isa < FIBRAD_ISA_BEST || rule.isa > FIBRAD_ISA_NEON) return FIBRAD_E_ARGUMENT;
    if (!fibrad_isa_built(rule.isa)) return FIBRAD_E_ISA;
    const fibrad_surface_lanes lanes =
        fibrad_surface_lanes_of(rule.isa == FIBRAD_ISA_BEST ? (int)fibrad_isa_best() : rule.isa);
    fibrad_surface_task task = {.flags = rule.flags};
    const int status = fibrad_surface_nodes_of(&rule, &task.nodes);
    if (status != FIBRAD_OK) return status;

    double *aligned = n > 0 ? scratch + fibrad_arena_lead(scratch) / sizeof *scratch : NULL;
    const fibrad_obstacles all = list_of(aligned, n, 0);
    task.obstacles = list_of(aligned, n, 1);
    task.of_node = list_of(aligned, n, 2);
    if (n > 0) fibrad_zero(scratch, FIBRAD_SURFACE_SCRATCH(n) * sizeof *scratch);
    for (size_t k = 0; k < n; k++) {
        all.x[k] = obstacles->x[k * stride];
        all.y[k] = obstacles->y[k * stride];
        all.z[k] = obstacles->z[k * stride];
        all.r[k] = obstacles->r[k * stride_r];
    }
    const double scale = 1 / r1;
    const fibrad_surface_frame frame = {{0}, {scale, 0, 0}, {0, scale, 0}, {0, 0, scale}, scale};
    fibrad_surface_facts found;
    double factor;
    const int failure = fibrad_surface_factor(&task, lanes, r1, r2, gap, &frame, &all, UINT32_MAX, &factor, &found);
    if (failure != FIBRAD_OK) return failure;
    *f12 = factor;
    if (facts != NULL) *facts = found;
    return FIBRAD_OK;
}
