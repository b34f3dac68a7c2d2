/* spelling.h - what a misspelt name or a text may have meant. SPDX-License-Identifier: MIT */
#ifndef SPELLING_H
#define SPELLING_H

#include <stddef.h>

/* Room for a hint. */
enum { HINT_ROOM = 160 };

/* Writes "; did you mean BEFORE NAME?" with the first name of a list that begins with a misspelt one of `length`
 * characters, or else with the nearest name, or ";" if none is near. Of a near name at most a third of the letters are
 * wrong, missing, too many or exchanged with the next one. Returns `to`. */
const char *name_hint(char to[HINT_ROOM], const char *before, const char *name, size_t length, const char *const *names,
                      size_t n);

/* Writes "; if FILE is a table, write BEFORE@FILE" if a text up to its first comma is the name of a file, or else "".
 * Returns `to`. */
const char *table_hint(char to[HINT_ROOM], const char *before, const char *text);

#endif
