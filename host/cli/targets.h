/* targets.h - lists of spheres such as 3,7,10-19. SPDX-License-Identifier: MIT */
#ifndef TARGETS_H
#define TARGETS_H

#include <stdint.h>

/* Marks the spheres of a list with 1, n being how many there are; marks = NULL: only checks the spelling.
 * Status 0, or STATUS_USAGE if the list is misspelt or goes beyond the bed. */
int targets_mark(const char *list, uint32_t n, unsigned char *marks);

#endif
