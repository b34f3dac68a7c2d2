/* moving_rows.c - keeps and renews rows in fixed memory while a sphere passes through a lattice.
 * SPDX-License-Identifier: MIT
 *
 *     cc docs/examples/moving_rows.c -Ikernel build/libfibrad.a -lm -o moving_rows */
#include <stdio.h>
#include "fibrad.h"

enum { SIDE = 8, N = SIDE * SIDE * SIDE, ENTRIES = 300, STEPS = 20 };
static const double allowed = 3e-3; /* Euclidean error of a row, besides that of its directions */

struct stored_row {
    uint32_t col[ENTRIES], length;
    double f[ENTRIES], escaped;
};
static struct stored_row rows[N], fresh[N];
static double x[N], y[N], z[N], r[N];
static double error[N]; /* of each row through motion, since it was computed */
static unsigned char due[N], done[N];
static unsigned char scene_memory[2][FIBRAD_SCENE_BYTES(N)], work_memory[FIBRAD_WORK_BYTES(64, ENTRIES)];
static fibrad_work work = {.memory = {work_memory, sizeof work_memory}};

static fibrad_row view(struct stored_row *row) {
    return (fibrad_row){.col = row->col, .f = row->f, .capacity = ENTRIES, .length = row->length};
}

/* Computes the rows that are due. A new row of i may show that the old row of j is wrong: row j is then due as well. */
static int compute_due(const fibrad_scene *scene, uint32_t *count) {
    const fibrad_beam_rule rule = {.directions = 100, .cutoff = 12};
    for (uint32_t i = 0; i < N; i++) { /* in parallel, with a work per thread */
        fibrad_row row = view(&fresh[i]);
        int status = due[i] ? fibrad_beam_row(scene, &work, i, &rule, &row) : FIBRAD_OK;
        if (status != FIBRAD_OK) return status;
        if (due[i]) fresh[i].length = row.length, fresh[i].escaped = row.escaped;
    }
    for (uint32_t i = 0; i < N; i++) { /* in order */
        if (!due[i]) continue;
        fibrad_row before = view(&rows[i]), now = view(&fresh[i]);
        int status = fibrad_drift_partners(scene, i, &before, &now, error);
        if (status != FIBRAD_OK) return status;
        rows[i] = fresh[i];
        done[i] = 1;
    }
    *count = 0;
    for (uint32_t i = 0; i < N; i++) {
        if (done[i]) error[i] = 0;
        *count += due[i] = error[i] > allowed;
    }
    return FIBRAD_OK;
}

int main(void) {
    const fibrad_spheres spheres = {.x = x, .y = y, .z = z, .r = r, .n = N};
    fibrad_scene *scene, *before = NULL;
    int status = FIBRAD_OK;
    for (uint32_t i = 0; i < N; i++)
        x[i] = 2 * (i % SIDE), y[i] = 2 * (i / SIDE % SIDE), z[i] = 2 * (i / SIDE / SIDE), r[i] = i == 0 ? 0.4 : 0.9;
    x[0] = y[0] = 1;
    for (int step = 0; step <= STEPS && status == FIBRAD_OK; step++, before = scene) {
        z[0] = 0.7 * step;
        status = fibrad_scene_init(&scene, scene_memory[step % 2], sizeof scene_memory[0], NULL, &spheres, NULL);
        uint32_t count = 0, redone = 0;
        for (uint32_t i = 0; i < N && status == FIBRAD_OK; i++) { /* in parallel */
            double drift = 0;
            if (step > 0) status = fibrad_drift_row(before, scene, i, rows[i].col, rows[i].length, &drift);
            error[i] += drift;
            done[i] = 0;
            count += due[i] = step == 0 || error[i] > allowed;
        }
        while (count > 0 && status == FIBRAD_OK) {
            redone += count;
            status = compute_due(scene, &count);
        }
        printf("step %d: %u of %d rows\n", step, (unsigned)redone, N);
        /* rows[] now serves for this step */
    }
    if (status != FIBRAD_OK) fprintf(stderr, "%s\n", fibrad_status_text(status));
    return status != FIBRAD_OK;
}
