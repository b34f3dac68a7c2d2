/* reserve.h - makes a caller's block of memory large enough. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_BASE_RESERVE_H
#define FIBRAD_BASE_RESERVE_H

#include "fibrad.h"

/* Makes a block of at least `needed` bytes; what it holds stays. A new block is twice as large, for what comes next.
 * Errors: FIBRAD_E_CAPACITY (a fixed block is too small; memory->needed is set), _MEMORY (the caller has none). */
int fibrad_memory_reserve(fibrad_memory *memory, size_t needed);

#endif
