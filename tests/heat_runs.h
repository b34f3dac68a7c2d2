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
    for (uint32_t k = 0; k < parts; k++) assert_ok(fibrad_heat_sweep(heat, backwards ? parts - 1 - k : k));
}

/* From fibrad_heat_begin on. */
static inline void heat_solve(fibrad_heat *heat, const fibrad_heat_sources *sources, fibrad_heat_result *result,
                              bool backwards) {
    assert_ok(fibrad_heat_begin(heat, sources));
    for (int solved = 0; !solved;) {
        heat_sweep(heat, backwards);
        assert_ok(fibrad_heat_step(heat, &solved));
    }
    assert_ok(fibrad_heat_read(heat, result));
}

#endif
