/* laned.h - LANED(name): the name of a function in the instruction set of this compilation, for example name_avx2.
 * SPDX-License-Identifier: MIT
 *
 * A laned source begins with `#include FIBRAD_LANES_HEADER` and this header. It is compiled once for each
 * instruction set. FIBRAD_LANES_HEADER then names one vec_*.h, and FIBRAD_ISA_SUFFIX is the ending of names. */
#ifndef FIBRAD_LANED_H
#define FIBRAD_LANED_H

#define FIBRAD_JOIN_(name, suffix) name##suffix
#define FIBRAD_JOIN(name, suffix)  FIBRAD_JOIN_(name, suffix)
#define LANED(name)                FIBRAD_JOIN(name, FIBRAD_ISA_SUFFIX)

#endif
