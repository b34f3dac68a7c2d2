/* laned.h - LANED(name): the name a function has in the instruction set its file is compiled for, name_avx2 say.
 * SPDX-License-Identifier: MIT
 *
 * A laned source begins with `#include FIBRAD_LANES_HEADER` and this header, and is compiled once per instruction set
 * with that macro naming one vec_*.h and FIBRAD_ISA_SUFFIX the ending. */
#ifndef FIBRAD_LANED_H
#define FIBRAD_LANED_H

#define FIBRAD_JOIN_(name, suffix) name##suffix
#define FIBRAD_JOIN(name, suffix)  FIBRAD_JOIN_(name, suffix)
#define LANED(name)                FIBRAD_JOIN(name, FIBRAD_ISA_SUFFIX)

#endif
