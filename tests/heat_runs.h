/* heat_runs.h - the calls of a heat problem in their order, for tests. SPDX-License-Identifier: MIT
 *
 * backwards: tasks and parts from the last to the first. */
#ifndef TESTS_HEAT_RUNS_H
#define TESTS_HEAT_RUNS_H

#include "fibrad_heat.h"
#include "scenes.h"

/* All tasks, as far as they succeed. Returns the status of the last one. */
static inline int heat_trace(fibrad_heat *heat, fibrad_work *work, bool backwards) {
    const uint32_t tasks = fibrad_heat_tasks(heat);
    int status = FIBRAD_OK;
    for (uint32_t k = 0; k < tasks && status == FIBRAD_OK; k++)
        status = fibrad_heat_trace(heat, work, backwards ? tasks - 1 - k : k);
    return status;
}

static inline void heat_sweep(fibrad_heat *heat, bool backwards) {
    const uint32_t parts = fibrad_heat_parts(heat);
    for (uint32_t k = 0; k < parts; k++)
        ck_assert_int_eq(fibrad_heat_sweep(heat, backwards ? parts - 1 - k : k), FIBRAD_OK);
}

/* From fibrad_heat_begin on. */
static inline void heat_solve(fibrad_heat *heat, const fibrad_heat_sources *sources, fibrad_heat_result *result,
                              bool backwards) {
    ck_assert_int_eq(fibrad_heat_begin(heat, sources), FIBRAD_OK);
    for (int solved = 0; !solved;) {
        heat_sweep(heat, backwards);
        ck_assert_int_eq(fibrad_heat_step(heat, &solved), FIBRAD_OK);
    }
    ck_assert_int_eq(fibrad_heat_read(heat, result), FIBRAD_OK);
}

static inline void assert_near(double value, double truth, double tolerance) {
    ck_assert_msg(fabs(value - truth) <= tolerance * fabs(truth), "%.9g instead of %.9g, off by %.3g", value, truth,
                  value / truth - 1);
}

#endif
