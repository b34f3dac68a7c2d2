/* line.h - lines spread evenly. Each line serves a direction and its opposite. SPDX-License-Identifier: MIT
 *
 * A line is a unit vector p that stands for p and -p. A set is even if its vectors and their opposites together are
 * spread evenly. The measure is the sum of |p - q| + |p + q| over pairs. If this sum is large, the mean square error
 * over spherical caps is small (Stolarsky). The even-numbered lines and the odd-numbered lines are two halves, which
 * are each spread evenly too. The difference between the halves gives an error estimate. A half of a set errs 1.4 to 2
 * times as much as a set of n/2.
 *
 * Each line also has a sense: of p and -p, the vector that is stored. Senses are chosen so that the n vectors alone are
 * spread evenly over the whole sphere, and those of each half, too. */
#ifndef FIBRAD_SAMPLE_LINE_H
#define FIBRAD_SAMPLE_LINE_H

#include "sample/tables.h"

/* The size of the smallest set of at least n lines in the table of this build (FIBRAD_TABLE_LINES). 0: there is none.
 */
uint32_t fibrad_lines_next(uint32_t n);

/* Reads the n unit vectors of a set. n is the size of a set (unchecked). */
void fibrad_lines_read(uint32_t n, double (*line)[3]);

#endif
