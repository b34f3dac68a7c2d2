/* row.c - rows by any method, with memory that grows. SPDX-License-Identifier: MIT */
#include "row/row.h"
#include "scene/walls.h"
#include "rows/record.h"

/* Number of entries for which an empty collection first asks for room. */
#define FIRST_ENTRIES 256u

#define SUM_ERROR 1e-9 /* greatest error allowed in the sum of a row; rounding errors are below 1e-13 */

/* The share that each wall has of the lines that leave other surfaces for a sphere, because a cap of the sphere lies
 * behind the wall: f^2 on average for a cap of the fraction f. Returns the rest of these lines. 1: no wall cuts the
 * sphere. */
static double share_of_caps(const fibrad_scene *scene, uint32_t place, double share[FIBRAD_WALLS]) {
    if (!scene->cut[place]) return 1;
    const double centre[3] = {scene->x[place], scene->y[place], scene->z[place]};
    double sum = 0;
    for (uint32_t slot = 0; slot < FIBRAD_WALLS; slot++) {
        const double cap = fibrad_walls_cap(&scene->container, slot, centre, scene->r[place]);
        sum += share[slot] = cap * cap;
    }
    for (uint32_t slot = 0; slot < FIBRAD_WALLS && sum > 1; slot++) share[slot] /= sum;
    return fibrad_max(0, 1 - sum);
}

/* docs/methods.md section 9. What the spheres of the row lose is summed in whole numbers. So the order of columns,
 * which the caller chooses, changes no bit. */
void fibrad_row_cut(const fibrad_scene *scene, uint32_t place, double wall[FIBRAD_SLOTS], fibrad_row *row) {
    double share[FIBRAD_WALLS] = {0};
    int64_t units[FIBRAD_WALLS] = {0};
    if (!scene->container.cuts) return;
    for (uint32_t k = 0; k < row->length; k++) {
        const double left = share_of_caps(scene, scene->place[row->col[k]], share);
        for (uint32_t slot = 0; slot < FIBRAD_WALLS && left < 1; slot++)
            units[slot] += (int64_t)(row->f[k] * share[slot] * 0x1p60);
        row->f[k] *= left;
    }
    for (uint32_t slot = 0; slot < FIBRAD_WALLS; slot++) wall[slot] += (double)units[slot] * 0x1p-60;
    const double left = share_of_caps(scene, place, share);
    if (left == 1) return;
    for (uint32_t k = 0; k < row->length; k++) row->f[k] *= left;
    for (uint32_t slot = 0; slot < FIBRAD_SLOTS; slot++) wall[slot] *= left;
    for (uint32_t slot = 0; slot < FIBRAD_WALLS; slot++) wall[slot] += share[slot];
    row->escaped *= left, row->beyond *= left;
}

void fibrad_row_walls(const fibrad_scene *scene, double wall[FIBRAD_SLOTS], fibrad_row *row) {
    for (uint32_t b = 0; b < scene->facts.walls; b++) row->wall[b] = wall[scene->slot[b]];
    for (uint32_t slot = 0; slot < FIBRAD_WALLS; slot++)
        if (fibrad_is_opening(&scene->container, slot)) row->escaped += wall[slot], wall[slot] = 0;
}

int fibrad_sum_checked(double sum) { return fibrad_abs(sum - 1) <= SUM_ERROR ? FIBRAD_OK : FIBRAD_E_SUM; }

int fibrad_row_checked(const fibrad_scene *scene, const fibrad_row *row) {
    double sum = row->escaped + row->beyond;
    for (uint32_t k = 0; k < row->length; k++) sum += row->f[k];
    for (uint32_t b = 0; b < scene->facts.walls; b++) sum += row->wall[b];
    return fibrad_sum_checked(sum);
}

fibrad_row fibrad_row_scratch(fibrad_workspace *space, double *wall) {
    fibrad_entries *entries = &space->entries;
    return (fibrad_row){
        .col = (uint32_t *)(void *)entries->angles, .f = entries->lengths, .wall = wall, .capacity = entries->capacity};
}

int fibrad_row_give(const fibrad_scene *scene, const fibrad_row *row, fibrad_row *to) {
    fibrad_row given = *row;
    to->length = row->length;
    if (row->length > to->capacity) return FIBRAD_E_CAPACITY;
    for (uint32_t k = 0; k < row->length; k++) to->col[k] = row->col[k], to->f[k] = row->f[k];
    for (uint32_t b = 0; b < scene->facts.walls; b++) to->wall[b] = row->wall[b];
    given.col = to->col, given.f = to->f, given.wall = to->wall, given.half = to->half;
    given.capacity = to->capacity;
    *to = given;
    return FIBRAD_OK;
}

static bool arrays_valid(const fibrad_row *row, uint32_t walls) {
    if (row->rows != NULL) return fibrad_memory_valid(&row->rows->memory);
    return (row->capacity == 0 || (row->col != NULL && row->f != NULL)) && (walls == 0 || row->wall != NULL);
}

/* Computes a row without room for it, to find its length. Status: FIBRAD_E_CAPACITY. */
static int measure_row(const fibrad_scene *scene, fibrad_workspace *space, uint32_t i, const fibrad_row_method *method,
                       fibrad_row *own) {
    double wall[FIBRAD_WALLS_MAX];
    fibrad_row row = {.wall = wall};
    const int status = method->compute(scene, space, i, method->rule, &row);
    own->length = row.length;
    return status == FIBRAD_OK ? FIBRAD_E_CAPACITY : status;
}

/* Makes one attempt, into the arrays of `row` or into the free space of a collection. */
static int attempt(const fibrad_scene *scene, fibrad_workspace *space, uint32_t i, const fibrad_row_method *method,
                   fibrad_rows *rows, fibrad_row *own) {
    const uint32_t walls = scene->facts.walls;
    if (rows != NULL && !fibrad_rows_open(rows, walls, own)) {
        const int status = fibrad_rows_reserve(rows, rows->memory.resize != NULL ? FIRST_ENTRIES : 0, walls);
        if (status == FIBRAD_E_CAPACITY) return measure_row(scene, space, i, method, own);
        if (status != FIBRAD_OK) return status;
        fibrad_rows_open(rows, walls, own);
    }
    return method->compute(scene, space, i, method->rule, own);
}

int fibrad_row_run(const fibrad_scene *scene, fibrad_work *work, uint32_t i, const fibrad_row_method *method,
                   fibrad_row *row) {
    if (scene == NULL || work == NULL || row == NULL) return FIBRAD_E_ARGUMENT;
    if (!fibrad_scene_ready(scene)) return FIBRAD_E_STATE;
    if (i >= scene->facts.spheres || !arrays_valid(row, scene->facts.walls)) return FIBRAD_E_ARGUMENT;
    fibrad_rows *rows = row->rows;
    fibrad_row own = *row;
    fibrad_workspace *space;
    uint32_t least = 0;
    own.beyond = 0, own.length = 0, own.lines = 0;
    int status = fibrad_work_open(work, scene, method->extra_min, method->extra_best, &space);
    while (status == FIBRAD_OK) {
        status = attempt(scene, space, i, method, rows, &own);
        if (status == FIBRAD_OK) break;
        if (status == FIBRAD_E_WORK)
            status = fibrad_work_grow(work, &space);
        else if (status == FIBRAD_E_CAPACITY && rows != NULL && own.length >= least) {
            status = fibrad_rows_reserve(rows, own.length, scene->facts.walls);
            least = own.length + 1; /* without this the call would be repeated for ever */
        }
    }
    if (status == FIBRAD_E_CAPACITY && rows == NULL) row->length = own.length;
    if (status == FIBRAD_E_BACK) work->triangle = space->back;
    if (status != FIBRAD_OK) return status;
    own.sphere = i;
    if (rows != NULL) fibrad_rows_commit(rows, scene->hash, scene->facts.walls, &own);
    own.rows = rows;
    if (rows != NULL)
        own.col = (uint32_t *)(void *)(own.f + own.length), own.capacity = 0; /* these arrays are not the caller's */
    if (rows != NULL) own.half = own.lines > 0 ? (float *)(void *)(own.col + own.length) : NULL;
    *row = own;
    return FIBRAD_OK;
}
