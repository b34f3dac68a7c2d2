/* write_mtx.c - view factors in Matrix Market coordinates, rows and columns from 1. SPDX-License-Identifier: MIT */
#include <inttypes.h>

#include "cli/interrupt.h"
#include "cli/message.h"
#include "fibrad.h"
#include "write/write.h"

int write_mtx(FILE *file, const struct contents *what) {
    const fibrad_rows *rows = &what->result->rows;
    fputs("%%MatrixMarket matrix coordinate real general\n", file);
    fprintf(file, "%% View factors F_ij from sphere i to sphere j, fibrad %s\n", fibrad_version());
    fprintf(file, "%" PRIu32 " %" PRIu32 " %" PRIu64 "\n", rows->n, rows->n, rows->start[rows->n]);
    for (uint32_t i = 0; i < rows->n; ++i) {
        if (interrupt_status()) return interrupt_status();
        for (uint64_t k = rows->start[i]; k < rows->start[i + 1]; ++k)
            fprintf(file, "%" PRIu32 " %" PRIu32 " %.17g\n", i + 1, rows->col[k] + 1, rows->f[k]);
    }
    return STATUS_OK;
}
