/* addends.h - a list of what the windows of a row add to its sums. SPDX-License-Identifier: MIT
 *
 * A sum in floating point depends on the order of its terms. With such a list, windows may be computed in any order.
 * The terms are added later, in the order of the windows. */
#ifndef FIBRAD_BASE_ADDENDS_H
#define FIBRAD_BASE_ADDENDS_H

#include "fibrad.h"
#include "base/port.h"

/* The sum that a term is added to: a sphere by its place, a slot as FIBRAD_ADD_SLOT + slot, or one of these. */
#define FIBRAD_ADD_OPEN   0xffffff00u /* part of a window that meets nothing */
#define FIBRAD_ADD_HIDDEN 0xffffff01u /* the window is hidden */
#define FIBRAD_ADD_WHOLE  0xffffff02u /* the size of the window, of rows by masks or along lines */
#define FIBRAD_ADD_SEEN   0xffffff03u /* how many spheres the windows of the part have seen, by masks */
#define FIBRAD_ADD_SLOT   0xffffff20u /* + slot */
#define FIBRAD_ADD_REGION 0xffffff80u /* + region of the sky: the open part */
#define FIBRAD_ADD_SHARE  0xffffffa0u /* + region: the share that the region has if nothing is hidden, in windows */
#define FIBRAD_ADD_MIXED  0xffffffc0u /* + region: the open part times the hidden part */

typedef struct fibrad_addend {
    double value;
    uint32_t target, window;
} fibrad_addend;

typedef struct fibrad_addends {
    fibrad_memory *memory;
    size_t count; /* number of all terms, also of those that had no room */
    bool missed;  /* some terms had no room and are not listed */
} fibrad_addends;

static inline void fibrad_addends_put(fibrad_addends *list, uint32_t target, uint32_t window, double value) {
    const fibrad_addend addend = {value, target, window};
    fibrad_memory *memory = list->memory;
    const size_t used = list->count++ * sizeof addend, needed = used + sizeof addend;
    if (list->missed) return;
    if (needed > memory->size) {
        void *block = memory->resize != NULL ? memory->resize(memory->context, memory->block, 2 * needed) : NULL;
        list->missed = block == NULL;
        if (list->missed) return;
        memory->block = block, memory->size = 2 * needed;
    }
    fibrad_copy((unsigned char *)memory->block + used, &addend, sizeof addend);
}

#endif
