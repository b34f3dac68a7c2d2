/* reproduce_rows.c - rows of view factors of a bed by any method, on one thread. SPDX-License-Identifier: MIT */
#include <stdlib.h>

#include "bed/bed_scene.h"
#include "cli/message.h"
#include "papers/reproduce/reproduce.h"
#include "simple/heap.h"

int rows_open(struct rows *rows, bool periodic) {
    const fibrad_scene_config box = bed_scene(&rows->bed, NULL);
    const fibrad_spheres spheres = bed_spheres(&rows->bed);
    rows->n = spheres.n, rows->work.memory.resize = fibrad_heap_resize;
    rows->col = malloc(rows->n * sizeof *rows->col);
    rows->f = malloc(rows->n * sizeof *rows->f);
    if (!rows->col || !rows->f) return message_memory();
    const int status = fibrad_heap_scene(&rows->scene, &rows->block, periodic ? &box : NULL, &spheres, NULL);
    return status ? message(STATUS_INPUT, "bed: %s", fibrad_status_text(status)) : STATUS_OK;
}

void rows_close(struct rows *rows) {
    free(rows->block);
    free(rows->work.memory.block);
    free(rows->col);
    free(rows->f);
    bed_free(&rows->bed);
}

int rows_row(struct rows *rows, const struct row_rule *method, uint32_t i, fibrad_row *row) {
    int status;
    *row = (fibrad_row){.col = rows->col, .f = rows->f, .capacity = rows->n};
    if (method->surface)
        status = fibrad_surface_row(rows->scene, &rows->work, i, method->surface, row);
    else if (method->cast)
        status = fibrad_cast_row(rows->scene, &rows->work, i, method->cast, row, NULL);
    else
        status = fibrad_beam_row(rows->scene, &rows->work, i, method->beam, row);
    return status ? message(STATUS_INPUT, "row %u: %s", i, fibrad_status_text(status)) : interrupt_status();
}
