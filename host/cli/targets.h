/* targets.h - lists of spheres such as 3,7,10-19. SPDX-License-Identifier: MIT */
#ifndef TARGETS_H
#define TARGETS_H

#include <stdint.h>

/* Marks the spheres of a list with 1: by their ids, [n] ascending, or by positions from 0 on where id is NULL; `where`
 * says in messages whose they are. A range takes the ids there are in it, and may not reach beyond them. marks = NULL:
 * only checks the spelling. Status 0, or STATUS_USAGE if the list is misspelt or names what is not there. */
int targets_mark(const char *list, const int64_t *id, uint32_t n, const char *where, unsigned char *marks);

#endif
