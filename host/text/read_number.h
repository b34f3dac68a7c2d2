/* read_number.h - numbers from text, with the bits of strtod. SPDX-License-Identifier: MIT */
#ifndef READ_NUMBER_H
#define READ_NUMBER_H

#include <stdbool.h>
#include <stdint.h>

/* Reads the whole text as a number, with the bits of strtod. 0.5250D-01 of Fortran is 0.5250e-01. False: the text is no
 * number. */
bool number_read(const char *text, double *value);

/* Reads the whole text as a whole number. Forms such as 7.0 and 7.000e+00, which some programs write, are allowed up to
 * 2^53. False: the text is no whole number, or the number is beyond 63 bits. */
bool number_read_whole(const char *text, int64_t *value);

/* Orders numbers for qsort, or structures that begin with one: doubles, the least first. */
int number_order(const void *a, const void *b);

#endif
