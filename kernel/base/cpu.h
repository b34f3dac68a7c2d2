/* cpu.h - which instruction sets there are. SPDX-License-Identifier: MIT
 *
 * FIBRAD_WITH_SSE2, FIBRAD_WITH_AVX2, FIBRAD_WITH_AVX512 are defined when the laned sources were also compiled for
 * them; scalar is always there. */
#ifndef FIBRAD_BASE_CPU_H
#define FIBRAD_BASE_CPU_H

#include "fibrad.h"

/* The instruction set to use for a wish (a fibrad_isa): the wish itself or, for FIBRAD_ISA_BEST, the widest; -1 if
 * it is none or this build or this machine lacks it. */
int fibrad_isa_choose(int wish);

#endif
