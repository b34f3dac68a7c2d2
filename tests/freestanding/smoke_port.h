/* smoke_port.h - a port header for targets without a C library: -DFIBRAD_PORT_HEADER='"smoke_port.h"'.
 * SPDX-License-Identifier: MIT
 *
 * Square roots are computed in integers, bit by bit, so they round correctly on machines without floating-point
 * hardware too. Slow: about a microsecond at 1 GHz. */
#ifndef SMOKE_PORT_H
#define SMOKE_PORT_H

#include <stddef.h>

double smoke_sqrt(double x);
void *memcpy(void *restrict to, const void *restrict from, size_t bytes);
void *memmove(void *to, const void *from, size_t bytes);
void *memset(void *to, int byte, size_t bytes);

#if defined(__ARM_FP) && (__ARM_FP & 8)
static inline double fibrad_sqrt(double x) { return __builtin_sqrt(x); }
#else
static inline double fibrad_sqrt(double x) { return smoke_sqrt(x); }
#endif
static inline void fibrad_copy(void *to, const void *from, size_t bytes) { memcpy(to, from, bytes); }
static inline void fibrad_zero(void *to, size_t bytes) { memset(to, 0, bytes); }

#endif
