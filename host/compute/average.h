/* average.h - reciprocal rows of a whole bed, by OpenMP. SPDX-License-Identifier: MIT */
#ifndef AVERAGE_H
#define AVERAGE_H

#include "fibrad.h"

/* Makes *mean of the raw rows: fibrad_rows_average_weighted, to the bit, whatever the number of threads. Free it by
 * rows_free, also after an error. Status 0; STATUS_MEMORY; STATUS_INPUT, naming what the kernel refuses. */
int average_rows(const fibrad_rows *raw, const double *r, const double *weight, int threads, fibrad_rows *mean);

void rows_free(fibrad_rows *rows);

#endif
