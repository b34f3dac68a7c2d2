/* paths.c - hands paths to the version for the scene's instruction set. SPDX-License-Identifier: MIT */
#include "exchange/paths.h"

void fibrad_paths_follow(fibrad_paths *paths, uint64_t begin, uint64_t end) {
    switch (paths->tracer->scene->facts.isa) {
#ifdef FIBRAD_WITH_SSE2
    case FIBRAD_ISA_SSE2:
        fibrad_paths_follow_sse2(paths, begin, end);
        return;
#endif
#ifdef FIBRAD_WITH_AVX2
    case FIBRAD_ISA_AVX2:
        fibrad_paths_follow_avx2(paths, begin, end);
        return;
#endif
#ifdef FIBRAD_WITH_AVX512
    case FIBRAD_ISA_AVX512:
        fibrad_paths_follow_avx512(paths, begin, end);
        return;
#endif
    }
    fibrad_paths_follow_scalar(paths, begin, end);
}
