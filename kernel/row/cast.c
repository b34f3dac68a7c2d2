/* cast.c - checks a ray rule and hands it to the version for the scene's instruction set. SPDX-License-Identifier: MIT
 */
#include "row/cast_lanes.h"

static int cast_compute(const fibrad_scene *scene, fibrad_workspace *space, uint32_t i, const void *task,
                        fibrad_row *row) {
    return FIBRAD_VERSION_OF(fibrad_cast_lanes, scene->facts.isa)(scene, space, i, task, row);
}

int fibrad_cast_row(const fibrad_scene *scene, fibrad_work *work, uint32_t i, const fibrad_cast_rule *rule,
                    fibrad_row *row, const fibrad_cast_means *means) {
    if (row == NULL) return FIBRAD_E_ARGUMENT;
    if (means != NULL && (row->rows != NULL || (row->capacity > 0 && (means->length == NULL || means->angle == NULL))))
        return FIBRAD_E_ARGUMENT;
    fibrad_cast_task task = {.means = means};
    if (rule != NULL) task.rule = *rule;
    if (task.rule.rays == 0) task.rule.rays = FIBRAD_RAYS_DEFAULT;
    if (task.rule.random != 0 && task.rule.random != 1) return FIBRAD_E_ARGUMENT;
    if (!(task.rule.cutoff >= 0 && fibrad_finite(task.rule.cutoff))) return FIBRAD_E_ARGUMENT;
    return fibrad_row_run(scene, work, i, &(fibrad_row_method){cast_compute, &task, 0, 0}, row);
}
