/* beam.c - checks a beam rule and hands it to the version for the scene's instruction set. SPDX-License-Identifier: MIT
 */
#include "row/beam.h"
#include "row/beam_lanes.h"
#include "sample/direction.h"

#define DIRECTIONS 233u
#define PILOT      100u /* directions to begin with, if there is a tolerance */

/* In steps of an eighth, each of which takes a sixth off the error, to a little less than is wanted; a fifth more in
 * any case, for rows whose error falls more slowly. */
uint32_t fibrad_directions_for(uint32_t directions, double error, double wanted) {
    double n = directions < FIBRAD_DIRECTIONS_MIN ? FIBRAD_DIRECTIONS_MIN : directions;
    for (; n < FIBRAD_DIRECTIONS_MAX && (error > 0.9 * wanted || n < 1.2 * directions); n *= 1.125) error *= 0.838;
    return n < FIBRAD_DIRECTIONS_MAX ? (uint32_t)n : FIBRAD_DIRECTIONS_MAX;
}

/* Windows of points are turned by five golden angles each, so that the points of one do not lie as those of its
 * neighbours: of what was tried the error is least, half of that without, at 2000 directions of 256 points. */
void fibrad_beam_frame(uint32_t k, uint32_t directions, uint32_t points, double frame[9]) {
    fibrad_polar d = fibrad_direction_polar(k, directions);
    double across[2][3] = {{-d.sin, d.cos, 0}, {-d.z * d.cos, -d.z * d.sin, d.ring}}, cos = 1, sin = 0;
    if (points > 0) fibrad_azimuth(5 * k % FIBRAD_DIRECTIONS_MAX, &cos, &sin);
    for (int axis = 0; axis < 3; axis++) {
        double u = across[0][axis], v = across[1][axis];
        frame[axis] = cos * u + sin * v, frame[3 + axis] = cos * v - sin * u;
    }
    frame[6] = d.ring * d.cos, frame[7] = d.ring * d.sin, frame[8] = d.z;
}

int fibrad_beam_row(const fibrad_scene *scene, fibrad_workspace *work, uint32_t i, const fibrad_beam_rule *rule,
                    fibrad_row *row) {
    if (scene == NULL || work == NULL || row == NULL || i >= scene->facts.spheres) return FIBRAD_E_ARGUMENT;
    if (row->capacity > 0 && (row->col == NULL || row->f == NULL)) return FIBRAD_E_ARGUMENT;
    fibrad_beam_rule r = {0};
    if (rule != NULL) r = *rule;
    if (!(r.error >= 0 && fibrad_finite(r.error))) return FIBRAD_E_ARGUMENT;
    if (r.directions == 0) r.directions = r.error > 0 ? PILOT : DIRECTIONS;
    if (r.directions < FIBRAD_DIRECTIONS_MIN || r.directions > FIBRAD_DIRECTIONS_MAX) return FIBRAD_E_ARGUMENT;
    if (!(r.cutoff >= 0 && fibrad_finite(r.cutoff))) return FIBRAD_E_ARGUMENT;

    fibrad_beam_function *version = fibrad_beam_row_scalar;
    switch (scene->facts.isa) {
#ifdef FIBRAD_WITH_SSE2
    case FIBRAD_ISA_SSE2:
        version = fibrad_beam_row_sse2;
        break;
#endif
#ifdef FIBRAD_WITH_AVX2
    case FIBRAD_ISA_AVX2:
        version = fibrad_beam_row_avx2;
        break;
#endif
#ifdef FIBRAD_WITH_AVX512
    case FIBRAD_ISA_AVX512:
        version = fibrad_beam_row_avx512;
        break;
#endif
    }
    int status = version(scene, work, i, r.directions, r.points, r.cutoff, row);
    while (status == FIBRAD_OK && r.error > 0 && row->error > r.error && r.directions < FIBRAD_DIRECTIONS_MAX) {
        double reach = row->reach; /* what the first rows have met decides about the last */
        r.directions = fibrad_directions_for(r.directions, row->error, r.error);
        status = version(scene, work, i, r.directions, r.points, r.cutoff, row);
        if (status == FIBRAD_OK) row->reach = fibrad_max(row->reach, reach);
    }
    return status;
}
