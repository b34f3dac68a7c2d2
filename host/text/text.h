/* text.h - numbers and strings as text. SPDX-License-Identifier: MIT */
#ifndef TEXT_H
#define TEXT_H

#include <stdint.h>
#include <stdio.h>

/* Room for a number. */
enum { TEXT_NUMBER = 32 };

/* A number as printf has it by %.17g, or by PRId64, in a fraction of the time. Returns the end of the text, where no 0
 * stands. */
char *text_real(char *to, double value);
char *text_whole(char *to, int64_t value);

/* A string of JSON; bytes above 127 go as they are. */
void text_json(FILE *file, const char *text);

/* A number of JSON, null where it is not finite. */
void text_json_real(FILE *file, double value);

#endif
