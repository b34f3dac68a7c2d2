/* rows_file.h - the file of one rank's rows. SPDX-License-Identifier: MIT
 *
 * Little endian, words of 8 bytes without gaps: this head, then the arrays id[rows], start[rows + 1], col[entries],
 * f[entries], body[rows][bodies], escaped[rows], beyond[rows], error[rows], radius[rows], emissivity[rows], x[rows][3].
 * Rows are those of start[i] to start[i + 1]; ids ascend, within each row those of its columns, too; images of one
 * particle share an entry. What is beyond is to be given back: entries times 1/(1 - beyond). step is the number that
 * the rows were made with and that their paths depend on. */
#ifndef FIBRAD_ROWS_FILE_H
#define FIBRAD_ROWS_FILE_H

#include <stdint.h>

#define FIBRAD_ROWS_MAGIC "FIBROWS1"

typedef struct fibrad_rows_head {
    char magic[8];
    uint64_t rank, ranks, step, rows, entries, bodies;
    uint64_t emissive; /* 1: exchange factors; 0: view factors, all emissivities 1 */
    double cutoff;     /* [L] */
} fibrad_rows_head;

#endif
