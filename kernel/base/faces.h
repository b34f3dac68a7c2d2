/* faces.h - the six faces of a box, in a fixed order. SPDX-License-Identifier: MIT
 *
 * Faces 0 to 5 are x low, x high, y low, y high, z low, z high. Planes of a scene and walls of a furnace are numbered
 * like this. This header alone computes with such numbers. */
#ifndef FIBRAD_BASE_FACES_H
#define FIBRAD_BASE_FACES_H

#include "base/port.h"

static inline uint32_t fibrad_face(uint32_t axis, bool upper) { return 2 * axis + upper; }
static inline uint32_t fibrad_face_axis(uint32_t face) { return face / 2; }
static inline bool fibrad_face_is_upper(uint32_t face) { return face % 2 != 0; }
static inline uint32_t fibrad_face_opposite(uint32_t face) { return face ^ 1; }

/* The axis along edge 0 or edge 1 of a face. Both axes follow the face's own axis, cyclically. */
static inline uint32_t fibrad_face_along(uint32_t face, uint32_t edge) {
    return (fibrad_face_axis(face) + 1 + edge) % 3;
}

#endif
