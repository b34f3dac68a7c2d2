/* write_csv.c - view factors as comma-separated values i,j,F. SPDX-License-Identifier: MIT */
#include <inttypes.h>

#include "interrupt.h"
#include "message.h"
#include "write.h"

int write_csv(FILE *file, const struct contents *what) {
    const fibrad_rows *rows = &what->result->rows;
    const int64_t *id = what->ids ? what->bed->id : NULL;
    fputs("i,j,F\n", file);
    for (uint32_t i = 0; i < rows->n; ++i) {
        if (interrupt_status()) return interrupt_status();
        for (uint64_t k = rows->start[i]; k < rows->start[i + 1]; ++k) {
            const uint32_t j = rows->col[k];
            fprintf(file, "%" PRId64 ",%" PRId64 ",%.17g\n", id ? id[i] : i, id ? id[j] : j, rows->f[k]);
        }
    }
    return STATUS_OK;
}
