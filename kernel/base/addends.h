/* addends.h - what the windows of a row add to its sums, listed instead of added. SPDX-License-Identifier: MIT
 *
 * Sums in floating point depend on the order of their terms. Windows may be resolved in any order if their terms are
 * listed, and added later in that of the windows. */
#ifndef FIBRAD_BASE_ADDENDS_H
#define FIBRAD_BASE_ADDENDS_H

#include "fibrad.h"
#include "base/port.h"

/* What is added to: the entry of a sphere, by its place, or of a slot, number of spheres + slot; or one of these. */
#define FIBRAD_ADD_OPEN   0xffffff00u /* what meets nothing */
#define FIBRAD_ADD_HIDDEN 0xffffff01u /* that a window is hidden */
#define FIBRAD_ADD_SLOT   0xffffff20u /* + slot */
#define FIBRAD_ADD_REGION 0xffffff80u /* + region of the sky: open, ... */
#define FIBRAD_ADD_SHARE  0xffffffa0u /* ... in windows, ... */
#define FIBRAD_ADD_MIXED  0xffffffc0u /* ... and open times hidden part */

typedef struct fibrad_addend {
    double value;
    uint32_t target, window;
} fibrad_addend;

typedef struct fibrad_addends {
    fibrad_memory *memory;
    size_t count; /* of all terms; those from the first that has found no room on are not listed */
    bool missed;  /* there is one */
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
