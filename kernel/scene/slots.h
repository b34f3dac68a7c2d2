/* slots.h - the slots of what a line can meet besides spheres. SPDX-License-Identifier: MIT
 *
 * Each plane, the cylinder, the surroundings, the unknown, and each mesh have a slot. Results by slot are arrays of
 * FIBRAD_SLOTS elements. This header alone knows how slots are numbered. */
#ifndef FIBRAD_SCENE_SLOTS_H
#define FIBRAD_SCENE_SLOTS_H

#include "base/faces.h"
#include "base/port.h"
#include "fibrad.h"

/* Slots:
 *   0 to 5     planes, in the order of base/faces.h
 *   6          the cylinder
 *   7          the surroundings
 *   8          not known: `beyond` of a row
 *   9 and up   meshes, in the order of the walls of the configuration */
#define FIBRAD_CYLINDER 6u
#define FIBRAD_WALLS    7 /* number of planes and cylinders */
#define FIBRAD_ESCAPED  7
#define FIBRAD_BEYOND   8
#define FIBRAD_MESHES   9u
#define FIBRAD_SLOTS    (FIBRAD_MESHES + FIBRAD_WALLS_MAX)

/* Whether a slot belongs to a wall: a plane, the cylinder or a mesh. */
static inline bool fibrad_slot_of_wall(uint32_t slot) { return slot < FIBRAD_WALLS || slot >= FIBRAD_MESHES; }

static inline bool fibrad_slot_is_plane(uint32_t slot) { return slot < FIBRAD_CYLINDER; }

/* The slot of a mesh, and back. */
static inline uint32_t fibrad_slot_of_mesh(uint32_t mesh) { return FIBRAD_MESHES + mesh; }
static inline bool fibrad_slot_is_mesh(uint32_t slot) { return slot >= FIBRAD_MESHES; }
static inline uint32_t fibrad_slot_mesh(uint32_t slot) { return slot - FIBRAD_MESHES; }

#endif
