/* rows_file.h - the file of the rows of one rank. SPDX-License-Identifier: MIT
 *
 * The file is little endian and has words of 8 bytes without gaps: this head, then the arrays id[rows], start[rows +
 * 1], col[entries], f[entries], wall[rows][walls], escaped[rows], beyond[rows], error[rows], radius[rows],
 * emissivity[rows], x[rows][3]. Row i has the entries start[i] to start[i + 1] - 1, whose columns are ids. Ids ascend,
 * and so do the columns within each row. Images of one particle share an entry. Entries are raw: to give `beyond` back,
 * multiply the entries of a row by 1/(1 - beyond). The paths of the rows depend on `step`. */
#ifndef FIBRAD_ROWS_FILE_H
#define FIBRAD_ROWS_FILE_H

#include <stdint.h>

#define FIBRAD_ROWS_MAGIC "FIBROWS1"

typedef struct fibrad_rows_head {
    char magic[8];
    uint64_t rank, ranks, step, rows, entries, walls;
    uint64_t emissive; /* 1: exchange factors; 0: view factors, all emissivities 1 */
    double cutoff;     /* [L] */
} fibrad_rows_head;

#endif
