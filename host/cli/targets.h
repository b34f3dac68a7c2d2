/* targets.h - lists of spheres such as 3,7,10-19. SPDX-License-Identifier: MIT */
#ifndef TARGETS_H
#define TARGETS_H

#include <stdint.h>

/* Marks the spheres of a list with 1. id [n]: names of the spheres, ascending; NULL: names are positions from 0. where:
 * names the bed in messages. A range marks all ids in it; both its ends must lie within the ids of the bed. marks NULL:
 * only checks the spelling. Status 0, or STATUS_USAGE if the list is misspelt or names spheres that do not exist. */
int targets_mark(const char *list, const int64_t *id, uint32_t n, const char *where, unsigned char *marks);

/* The first sphere whose name is at least `name`, for ids as above. n: there is none. */
uint32_t targets_first(const int64_t *id, uint32_t n, unsigned long long name);

#endif
