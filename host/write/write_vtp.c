/* write_vtp.c - row sums, escaped fractions and neighbours of the spheres, for ParaView. SPDX-License-Identifier: MIT
 *
 * Rows that were not computed have NaN. */
#include <stdlib.h>

#include "cli/interrupt.h"
#include "cli/message.h"
#include "write/vtp.h"
#include "write/write.h"

/* One array per wall, wall_zmin and the like. */
static void write_walls(FILE *file, const struct contents *what, double *values) {
    for (uint32_t k = 0; what->walls && k < what->walls->count; ++k) {
        const uint32_t wall = what->walls->wall[k], n = what->bed->n;
        char name[32];
        snprintf(name, sizeof name, "wall_%s", wall_name(wall));
        for (uint32_t i = 0; i < n; ++i) values[i] = what->result->wall[i][wall];
        vtp_doubles(file, name, values, n, what->result->wanted);
    }
}

int write_vtp(FILE *file, const struct contents *what) {
    const struct bed *bed = what->bed;
    const struct result *result = what->result;
    int64_t *count = malloc(bed->n * sizeof *count);
    double *values = malloc(bed->n * sizeof *values);
    if (count && values) {
        for (uint32_t i = 0; i < bed->n; ++i) count[i] = (int64_t)(result->rows.start[i + 1] - result->rows.start[i]);
        vtp_begin(file, bed, "row_sum");
        vtp_doubles(file, "row_sum", result->row_sum, bed->n, result->wanted);
        vtp_doubles(file, "escaped", result->escaped, bed->n, result->wanted);
        write_walls(file, what, values);
        vtp_counts(file, "neighbours", count, bed->n);
        vtp_end(file, bed);
    }
    const int status = count && values ? interrupt_status() : message_memory();
    free(count);
    free(values);
    return status;
}
