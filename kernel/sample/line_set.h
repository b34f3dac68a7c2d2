/* line_set.h - the inside of a set of lines. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SAMPLE_LINE_SET_H
#define FIBRAD_SAMPLE_LINE_SET_H

#include "fibrad.h"

struct fibrad_line_set {
    uint32_t n;
    uint64_t turn;
    double (*line)[3];  /* [n] as in the table */
    double (*frame)[9]; /* [n] two unit vectors across each line, then its vector; all turned */
};

#endif
