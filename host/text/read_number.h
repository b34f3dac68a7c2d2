/* read_number.h - numbers from text, with the bits of strtod. SPDX-License-Identifier: MIT */
#ifndef READ_NUMBER_H
#define READ_NUMBER_H

#include <stdbool.h>
#include <stdint.h>

/* The entire text as a number, the bits being those of strtod; false: it is none. */
bool number_read(const char *text, double *value);

/* The entire text as a whole number; false: it is none, or beyond 63 bits. */
bool number_read_whole(const char *text, int64_t *value);

#endif
