/* write_mtx.c - view factors in Matrix Market coordinates, rows and columns from 1. SPDX-License-Identifier: MIT */
#include <inttypes.h>

#include "cli/interrupt.h"
#include "cli/message.h"
#include "write/write.h"

int write_mtx(FILE *file, const struct contents *what) {
    const fibrad_factors *matrix = &what->factors->matrix;
    fputs("%%MatrixMarket matrix coordinate real general\n", file);
    fprintf(file, "%% View factors F_ij from sphere i to sphere j, fibrad %s\n", fibrad_version());
    fprintf(file, "%" PRIu32 " %" PRIu32 " %" PRIu64 "\n", matrix->n, matrix->n, matrix->start[matrix->n]);
    for (uint32_t i = 0; i < matrix->n; ++i) {
        if (interrupt_status()) return interrupt_status();
        for (uint64_t k = matrix->start[i]; k < matrix->start[i + 1]; ++k)
            fprintf(file, "%" PRIu32 " %" PRIu32 " %.17g\n", i + 1, matrix->col[k] + 1, matrix->f[k]);
    }
    return STATUS_OK;
}
