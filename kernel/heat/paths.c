/* paths.c - chooses the version for an instruction set. SPDX-License-Identifier: MIT */
#include "heat/paths.h"

fibrad_paths_function *fibrad_paths_version(int isa) {
    switch (isa) {
#ifdef FIBRAD_WITH_SSE2
    case FIBRAD_ISA_SSE2:
        return fibrad_paths_follow_sse2;
#endif
#ifdef FIBRAD_WITH_AVX2
    case FIBRAD_ISA_AVX2:
        return fibrad_paths_follow_avx2;
#endif
#ifdef FIBRAD_WITH_AVX512
    case FIBRAD_ISA_AVX512:
        return fibrad_paths_follow_avx512;
#endif
    }
    return fibrad_paths_follow_scalar;
}
