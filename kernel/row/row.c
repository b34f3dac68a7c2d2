/* row.c - rows by any method, with memory that grows. SPDX-License-Identifier: MIT */
#include "row/row.h"
#include "store/record.h"

/* Entries for which an empty collection asks for room at first. */
#define FIRST_ENTRIES 256u

void fibrad_row_bodies(const fibrad_scene *scene, const double wall[FIBRAD_SLOTS], fibrad_row *row) {
    for (uint32_t b = 0; b < scene->facts.bodies; b++) row->body[b] = wall[scene->slot[b]];
}

static bool arrays_valid(const fibrad_row *row, uint32_t bodies) {
    if (row->rows != NULL) return true;
    return (row->capacity == 0 || (row->col != NULL && row->f != NULL)) && (bodies == 0 || row->body != NULL);
}

/* Tries once, into the arrays of `row` or into the free space of a collection. */
static int attempt(const fibrad_scene *scene, fibrad_workspace *space, uint32_t i, const fibrad_row_method *method,
                   fibrad_rows *rows, fibrad_row *own) {
    const uint32_t bodies = scene->facts.bodies;
    if (rows != NULL && !fibrad_rows_open(rows, bodies, own)) {
        const int status = fibrad_rows_reserve(rows, rows->memory.resize != NULL ? FIRST_ENTRIES : 0, bodies);
        if (status != FIBRAD_OK) return status;
        fibrad_rows_open(rows, bodies, own);
    }
    return method->compute(scene, space, i, method->rule, own);
}

int fibrad_row_run(const fibrad_scene *scene, fibrad_work *work, uint32_t i, const fibrad_row_method *method,
                   fibrad_row *row) {
    if (scene == NULL || work == NULL || row == NULL) return FIBRAD_E_ARGUMENT;
    if (!fibrad_scene_ready(scene)) return FIBRAD_E_STATE;
    if (i >= scene->facts.spheres || !arrays_valid(row, scene->facts.bodies)) return FIBRAD_E_ARGUMENT;
    fibrad_rows *rows = row->rows;
    fibrad_row own = *row;
    fibrad_workspace *space;
    own.beyond = 0;
    int status = fibrad_work_open(work, scene, method->extra_min, method->extra_best, &space);
    while (status == FIBRAD_OK) {
        status = attempt(scene, space, i, method, rows, &own);
        if (status == FIBRAD_OK) break;
        if (status == FIBRAD_E_WORK)
            status = fibrad_work_grow(work, &space);
        else if (status == FIBRAD_E_CAPACITY && rows != NULL && own.length > own.capacity)
            status = fibrad_rows_reserve(rows, own.length, scene->facts.bodies);
    }
    if (status == FIBRAD_E_CAPACITY && rows == NULL) row->length = own.length;
    if (status == FIBRAD_E_BACK) work->triangle = space->back;
    if (status != FIBRAD_OK) return status;
    own.sphere = i;
    if (rows != NULL) fibrad_rows_commit(rows, scene->hash, scene->facts.bodies, &own);
    own.rows = rows;
    if (rows != NULL) own.col = (uint32_t *)(void *)(own.f + own.length), own.capacity = 0; /* not the caller's */
    *row = own;
    return FIBRAD_OK;
}
