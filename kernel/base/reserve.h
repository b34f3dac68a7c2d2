/* reserve.h - makes a caller's block of memory large enough. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_BASE_RESERVE_H
#define FIBRAD_BASE_RESERVE_H

#include "fibrad.h"

/* Makes a block of at least `needed` bytes. Its contents stay. A block that grows has twice the size afterwards.
 * Errors: FIBRAD_E_CAPACITY: a fixed block is too small, and memory->needed is set. _MEMORY: the caller has no more
 * memory. */
int fibrad_memory_reserve(fibrad_memory *memory, size_t needed);

#endif
