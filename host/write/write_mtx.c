/* write_mtx.c - a matrix in Matrix Market coordinates, rows and columns from 1. SPDX-License-Identifier: MIT */
#include <inttypes.h>

#include "cli/message.h"
#include "text/text.h"
#include "write/write.h"

/* Writes the ids in the order of the rows, as lines of comment. */
static void write_ids(FILE *file, const struct bed *bed) {
    enum { LINE = 100 }; /* about so many characters in a line */
    int used = LINE;
    for (uint32_t i = 0; i < bed->n; ++i) {
        if (used >= LINE) used = fprintf(file, i > 0 ? "\n%% ids:" : "%% ids:");
        used += fprintf(file, " %" PRId64, bed->id[i]);
    }
    if (bed->n > 0) putc('\n', file);
}

int write_mtx(FILE *file, const struct contents *what) {
    const fibrad_factors *matrix = &what->factors->matrix;
    char line[3 * TEXT_NUMBER];
    fputs("%%MatrixMarket matrix coordinate real general\n", file);
    fprintf(file, "%% %s from sphere i to sphere j, fibrad %s\n",
            what->grey ? "Exchange factors D_ij" : "View factors F_ij", fibrad_version());
    if (what->bed->ids) write_ids(file, what->bed);
    fprintf(file, "%" PRIu32 " %" PRIu32 " %" PRIu64 "\n", matrix->n, matrix->n, matrix->start[matrix->n]);
    for (uint32_t i = 0; i < matrix->n; ++i) {
        if (interrupt_status()) return interrupt_status();
        for (uint64_t k = matrix->start[i]; k < matrix->start[i + 1]; ++k) {
            char *at = text_whole(line, (int64_t)i + 1);
            *at++ = ' ';
            at = text_whole(at, (int64_t)matrix->col[k] + 1);
            *at++ = ' ';
            at = text_real(at, matrix->f[k]);
            *at++ = '\n';
            fwrite(line, 1, (size_t)(at - line), file);
        }
    }
    return STATUS_OK;
}
