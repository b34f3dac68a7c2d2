/* line.c - lines spread evenly, read from their table. SPDX-License-Identifier: MIT */
#include "sample/line.h"

/* The sizes of the sets in fibrad_table_lines. The sets follow each other in this order. */
static const uint16_t SIZES[] = {8, 11, 16, 23, 32, 45, 55, 64, 91, 100, 128, 181, 233, 256, 362, 512, 724, 1024};
enum { SIZE_COUNT = sizeof SIZES / sizeof SIZES[0] };

uint32_t fibrad_lines_next(uint32_t n) {
    for (int i = 0; i < SIZE_COUNT && SIZES[i] <= FIBRAD_TABLE_LINES; i++)
        if (SIZES[i] >= n) return SIZES[i];
    return 0;
}

#if FIBRAD_TABLE_LINES >= 8
/* Makes a unit vector of an entry: the projection from the south pole, x/(1 + z) and y/(1 + z), in units of 2^-31.
 * sense: 1 or -1. */
static void unfold_line(const int32_t entry[2], double sense, double line[3]) {
    const double u = 0x1p-31 * entry[0], v = 0x1p-31 * entry[1], square = u * u + v * v, scale = sense * (1 + square);
    line[0] = 2 * u / scale;
    line[1] = 2 * v / scale;
    line[2] = (1 - square) / scale;
}

void fibrad_lines_read(uint32_t n, double (*line)[3]) {
    uint32_t first = 0;
    for (int i = 0; SIZES[i] < n; i++) first += SIZES[i];
    for (uint32_t k = first; k < first + n; k++) {
        const bool turned = fibrad_table_senses[k / 32] >> k % 32 & 1;
        unfold_line(fibrad_table_lines[k], turned ? -1 : 1, line[k - first]);
    }
}
#else
void fibrad_lines_read(uint32_t n, double (*line)[3]) { (void)n, (void)line; }
#endif
