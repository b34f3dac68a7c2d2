/* text.h - numbers and strings as text. SPDX-License-Identifier: MIT */
#ifndef TEXT_H
#define TEXT_H

#include <stdint.h>
#include <stdio.h>

/* Room for a number. */
enum { TEXT_NUMBER = 32 };

/* Write a number, with the fewest of 15 to 17 digits that read back as the same double, or a whole number. The text is
 * that of printf with %.15g to %.17g or PRId64, in a fraction of the time. Return the end of the text, without a 0. */
char *text_real(char *to, double value);
char *text_whole(char *to, int64_t value);

/* Lists names for messages: "a, b, c" or "none". If `to` has no room for all, the list ends with "... (40 in all)".
 * Returns `to`. */
enum { NAMES_LISTED = 400 };
const char *names_list(char to[NAMES_LISTED], const char *const *names, size_t n);

/* Writes a string of JSON. Bytes above 127 are written as they are. */
void text_json(FILE *file, const char *text);

/* Writes a number of JSON, or null if it is not finite. */
void text_json_real(FILE *file, double value);

#endif
