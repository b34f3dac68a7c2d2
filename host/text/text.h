/* text.h - numbers and strings as text. SPDX-License-Identifier: MIT */
#ifndef TEXT_H
#define TEXT_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* Room for a number. */
enum { TEXT_NUMBER = 32 };

/* A number in the fewest of 15 to 17 digits that read back as the same double, as printf has it by %.15g to %.17g, or a
 * whole one by PRId64, in a fraction of the time. Returns the end of the text, where no 0 stands. */
char *text_real(char *to, double value);
char *text_whole(char *to, int64_t value);

/* The names there are, for messages: "a, b, c", and "... (40 in all)" where there are more than `to` has room for;
 * "none". */
enum { NAMES_LISTED = 400 };
const char *names_list(char to[NAMES_LISTED], const char *const *names, size_t n);

/* A string of JSON; bytes above 127 go as they are. */
void text_json(FILE *file, const char *text);

/* A number of JSON, null where it is not finite. */
void text_json_real(FILE *file, double value);

#endif
