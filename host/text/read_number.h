/* read_number.h - numbers from text, with the bits of strtod. SPDX-License-Identifier: MIT */
#ifndef READ_NUMBER_H
#define READ_NUMBER_H

#include <stdbool.h>
#include <stdint.h>

/* The entire text as a number, the bits being those of strtod; false: it is none. */
bool number_read(const char *text, double *value);

/* The entire text as a whole number, also as programs write it that know reals alone: 7.0, 7.000e+00; false: it is
 * none, or beyond 63 bits, or such a real beyond 2^53. */
bool number_read_whole(const char *text, int64_t *value);

#endif
