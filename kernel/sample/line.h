/* line.h - lines spread evenly. Each line serves a direction and its opposite. SPDX-License-Identifier: MIT
 *
 * A line is a unit vector p that stands for p and -p. A set is even if its vectors and their opposites together are
 * spread evenly. The measure is the sum of |p - q| + |p + q| over pairs. If this sum is large, the mean square error
 * over spherical caps is small (Stolarsky). The even-numbered lines and the odd-numbered lines are two halves, which
 * are each spread evenly too. The difference between the halves gives an error estimate. A half of a tabled set
 * errs 1.4 to 2 times as much as a tabled set of n/2, and a half of another set 1.7 to 3 times.
 *
 * Each line also has a sense: of p and -p, the vector that is stored. Senses are chosen so that the n vectors alone are
 * spread evenly over the whole sphere, and those of each half, too. The bits of a set depend only on n and on whether n
 * is tabled. */
#ifndef FIBRAD_SAMPLE_LINE_H
#define FIBRAD_SAMPLE_LINE_H

#include "sample/tables.h"

/* Sets of up to FIBRAD_LINES_EVEN_MAX lines are spread evenly. Larger sets are Fibonacci sets of directions.
 *
 * Whether the set of n lines is in a table of this build (FIBRAD_TABLE_LINES). A tabled set costs about ten
 * operations a line. Any other set of up to FIBRAD_LINES_EVEN_MAX lines costs about 60 times n^2/2 pairs with two
 * square roots each: 2.4 ms for 100 lines, 0.24 s for 1,000. */
bool fibrad_lines_tabled(uint32_t n);

/* The size of the smallest tabled set of at least n lines. If there is none, n. */
uint32_t fibrad_lines_next(uint32_t n);

/* Fills n unit vectors, FIBRAD_DIRECTIONS_MIN <= n <= FIBRAD_DIRECTIONS_MAX (unchecked). scratch: 3 n doubles. It
 * may be NULL if n is tabled or above FIBRAD_LINES_EVEN_MAX. */
void fibrad_lines_make(uint32_t n, double (*line)[3], double *scratch);

/* Steps that increase the sum of |p - q| + |p + q| over pairs. Pairs within a half count 1 + halves times. */
typedef struct fibrad_line_steps {
    uint32_t count;
    double length; /* of a step, in units of the force over n; steps are stable up to 2 (1 + momentum)/(1 + halves/2) */
    double momentum; /* the part of a step that is added to the next one, 0 to 0.9 */
    double halves;   /* >= 0 */
} fibrad_line_steps;

/* Takes the steps. velocity: n vectors, overwritten. Cost: n^2/2 pairs a step. */
void fibrad_lines_relax(uint32_t n, double (*line)[3], double (*velocity)[3], const fibrad_line_steps *steps);

/* Exchanges even-numbered and odd-numbered lines while this spreads the halves more evenly. field: n doubles,
 * overwritten. Cost: about ten times n^2/2 pairs. */
void fibrad_lines_halve(uint32_t n, double (*line)[3], double *field);

/* Chooses senses that make the sum of 1/|p - q| over pairs of vectors small. Pairs within a half count half as much
 * again. draw: senses to begin with. field: n doubles, overwritten. Returns the sum, up to a constant of the lines.
 * Cost: about as fibrad_lines_halve. */
double fibrad_lines_orient(uint32_t n, double (*line)[3], double *field, uint64_t draw);

#endif
