/* reproduce_rows.c - rows of view factors of a bed by any method, one thread. SPDX-License-Identifier: MIT */
#include <stdlib.h>

#include "cli/interrupt.h"
#include "cli/message.h"
#include "compute/rows.h"
#include "reproduce/reproduce.h"

int rows_open(struct rows *rows, const struct bed *bed, bool periodic) {
    *rows = (struct rows){.n = bed->n};
    fibrad_scene_config config = {.spheres = bed->n};
    for (int axis = 0; axis < 3; ++axis) config.period[axis] = periodic ? bed->period[axis] : 0;
    const fibrad_spheres spheres = {bed->x, bed->y, bed->z, bed->r, bed->n};
    const size_t size = fibrad_scene_size(&config);
    rows->scene_block = run_block(size);
    rows->col = malloc(bed->n * sizeof *rows->col);
    rows->f = malloc(bed->n * sizeof *rows->f);
    if (!rows->scene_block || !rows->col || !rows->f) return message_memory();
    const int status = fibrad_scene_init(&rows->scene, rows->scene_block, size, &config, &spheres, NULL);
    if (status) return message(STATUS_INPUT, "bed: %s", fibrad_status_text(status));
    return run_work(&rows->work, &rows->work_block, NULL) ? STATUS_OK : message_memory();
}

void rows_close(struct rows *rows) {
    free(rows->scene_block);
    free(rows->work_block);
    free(rows->col);
    free(rows->f);
    *rows = (struct rows){0};
}

int rows_row(struct rows *rows, const struct row_method *method, uint32_t i, fibrad_row *row) {
    *row = (fibrad_row){.col = rows->col, .f = rows->f, .capacity = rows->n};
    for (;;) {
        const int status = method->row(rows->scene, rows->work, i, method->rule, row);
        if (status == FIBRAD_OK) return interrupt_status();
        if (status != FIBRAD_E_CAPACITY)
            return message(STATUS_INPUT, "%s: %s", method->name, fibrad_status_text(status));
        fibrad_work_config config;
        fibrad_work_needed(rows->work, &config);
        if (!run_work(&rows->work, &rows->work_block, &config)) return message_memory();
    }
}
