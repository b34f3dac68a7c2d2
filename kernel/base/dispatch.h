/* dispatch.h - the choice of an instruction set. SPDX-License-Identifier: MIT
 *
 * FIBRAD_WITH_SSE2, FIBRAD_WITH_AVX2, FIBRAD_WITH_AVX512 and FIBRAD_WITH_NEON are defined if the laned sources are
 * also compiled for that instruction set. The scalar version always exists. */
#ifndef FIBRAD_BASE_DISPATCH_H
#define FIBRAD_BASE_DISPATCH_H

#include "fibrad.h"

/* The instruction set to use. wish: a fibrad_isa. FIBRAD_ISA_BEST stands for the widest. -1: this build or this
 * machine does not have the set. -2: there is no such set. */
int fibrad_isa_choose(int wish);

/* Whether this build has an instruction set. True for FIBRAD_ISA_BEST. */
int fibrad_isa_built(int isa);

#ifdef FIBRAD_WITH_SSE2
#define FIBRAD_SSE2(name) name##_sse2
#else
#define FIBRAD_SSE2(name) name##_scalar
#endif
#ifdef FIBRAD_WITH_AVX2
#define FIBRAD_AVX2(name) name##_avx2
#else
#define FIBRAD_AVX2(name) name##_scalar
#endif
#ifdef FIBRAD_WITH_AVX512
#define FIBRAD_AVX512(name) name##_avx512
#else
#define FIBRAD_AVX512(name) name##_scalar
#endif
#ifdef FIBRAD_WITH_NEON
#define FIBRAD_NEON(name) name##_neon
#else
#define FIBRAD_NEON(name) name##_scalar
#endif

/* The version of a laned function for an instruction set that fibrad_isa_choose has returned. */
#define FIBRAD_VERSION_OF(name, isa)                                                                                   \
    ((isa) == FIBRAD_ISA_NEON     ? FIBRAD_NEON(name)                                                                  \
     : (isa) == FIBRAD_ISA_AVX512 ? FIBRAD_AVX512(name)                                                                \
     : (isa) == FIBRAD_ISA_AVX2   ? FIBRAD_AVX2(name)                                                                  \
     : (isa) == FIBRAD_ISA_SSE2   ? FIBRAD_SSE2(name)                                                                  \
                                  : name##_scalar)

/* Declares all versions of a laned function. type: the function's type. */
#define FIBRAD_DECLARE_VERSIONS(type, name) type name##_scalar, name##_sse2, name##_avx2, name##_avx512, name##_neon

#endif
