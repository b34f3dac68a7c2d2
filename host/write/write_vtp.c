/* write_vtp.c - row sums, escaped fractions and neighbours of the spheres, for ParaView. SPDX-License-Identifier: MIT
 *
 * Rows that were not computed have NaN. */
#include <stdlib.h>

#include "cli/interrupt.h"
#include "cli/message.h"
#include "write/vtp.h"
#include "write/write.h"

static void vtp_row_sums(FILE *file, const struct contents *what, double *values) {
    for (uint32_t i = 0; i < what->bed->n; ++i) values[i] = summary_row(&what->factors->matrix, i);
    vtp_doubles(file, "row_sum", values, what->bed->n, what->wanted);
}

/* One array per wall, wall_zmin and the like. */
static void vtp_walls(FILE *file, const struct contents *what, double *values) {
    const fibrad_factors *matrix = &what->factors->matrix;
    for (uint32_t k = 0; what->walls && k < what->walls->count; ++k) {
        char name[32];
        snprintf(name, sizeof name, "wall_%s", wall_name(&what->walls->body[k]));
        for (uint32_t i = 0; i < matrix->n; ++i) values[i] = matrix->body[(size_t)i * matrix->bodies + k];
        vtp_doubles(file, name, values, matrix->n, what->wanted);
    }
}

int write_vtp(FILE *file, const struct contents *what) {
    const struct bed *bed = what->bed;
    const fibrad_factors *matrix = &what->factors->matrix;
    int64_t *count = malloc(bed->n * sizeof *count);
    double *values = malloc(bed->n * sizeof *values);
    if (count && values) {
        for (uint32_t i = 0; i < bed->n; ++i) count[i] = (int64_t)(matrix->start[i + 1] - matrix->start[i]);
        vtp_begin(file, bed, "row_sum");
        vtp_row_sums(file, what, values);
        vtp_doubles(file, "escaped", matrix->escaped, bed->n, what->wanted);
        vtp_doubles(file, "beyond", matrix->beyond, bed->n, what->wanted);
        vtp_walls(file, what, values);
        vtp_counts(file, "neighbours", count, bed->n);
        vtp_end(file, bed);
    }
    const int status = count && values ? interrupt_status() : message_memory();
    free(count);
    free(values);
    return status;
}
