/* cast.c - checks a ray rule and hands it to the version for the scene's instruction set. SPDX-License-Identifier: MIT
 */
#include "ray/cast_lanes.h"

#define RAYS 20000u

int fibrad_cast_row(const fibrad_scene *scene, fibrad_workspace *work, uint32_t i, const fibrad_cast_rule *rule,
                    fibrad_row *row, const fibrad_cast_means *means) {
    if (scene == NULL || work == NULL || row == NULL || i >= scene->facts.spheres) return FIBRAD_E_ARGUMENT;
    if (row->capacity > 0 && (row->col == NULL || row->f == NULL)) return FIBRAD_E_ARGUMENT;
    if (row->capacity > 0 && means != NULL && (means->length == NULL || means->angle == NULL)) return FIBRAD_E_ARGUMENT;
    fibrad_cast_rule r = {0};
    if (rule != NULL) r = *rule;
    if (r.rays == 0) r.rays = RAYS;
    if (r.random != 0 && r.random != 1) return FIBRAD_E_ARGUMENT;
    if (!(r.cutoff >= 0 && fibrad_finite(r.cutoff))) return FIBRAD_E_ARGUMENT;

    fibrad_cast_function *version = fibrad_cast_row_scalar;
    switch (scene->facts.isa) {
#ifdef FIBRAD_WITH_SSE2
    case FIBRAD_ISA_SSE2:
        version = fibrad_cast_row_sse2;
        break;
#endif
#ifdef FIBRAD_WITH_AVX2
    case FIBRAD_ISA_AVX2:
        version = fibrad_cast_row_avx2;
        break;
#endif
#ifdef FIBRAD_WITH_AVX512
    case FIBRAD_ISA_AVX512:
        version = fibrad_cast_row_avx512;
        break;
#endif
    }
    return version(scene, work, i, &r, row, means);
}
