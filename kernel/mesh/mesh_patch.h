/* mesh_patch.h - the patches of a mesh. SPDX-License-Identifier: MIT
 *
 * A side that is larger than two patches is halved across its longest edge. The halves are halved again, and so on.
 * So all patches of a side have the same area. Four patches in a row form the triangle that the side had two
 * halvings before. Smaller sides share a patch if they are near each other in the tree and face the same way. */
#ifndef FIBRAD_MESH_MESH_PATCH_H
#define FIBRAD_MESH_MESH_PATCH_H

#include "mesh/mesh.h"

/* The first patch of a side, and how many times the side is halved. */
typedef struct fibrad_mesh_cut {
    uint32_t patch; /* UINT32_MAX: the side belongs to no wall */
    uint32_t halvings;
} fibrad_mesh_cut;

/* Cuts a mesh into patches of about an area [L^2]. The patches are numbered from `first` on. Returns the number of
 * patches. cut: [2 triangles], front and back of each triangle in the order of the caller's numbers. So `cut` stays
 * valid when the triangles move. NULL: the function only counts. */
uint32_t fibrad_mesh_cut_sides(const fibrad_mesh *mesh, uint32_t number, double area, uint32_t first,
                               fibrad_mesh_cut *cut);

/* The cut of a side. */
static inline fibrad_mesh_cut *fibrad_mesh_cut_of(const fibrad_mesh *mesh, fibrad_mesh_cut *cut, uint32_t side) {
    return &cut[fibrad_side_given(mesh, side)];
}

/* The patch at a place [L] on a side of a mesh, or on an image of it. */
uint32_t fibrad_mesh_patch_at(const fibrad_mesh *mesh, const fibrad_mesh_cut *cut, uint32_t side, const double at[3]);

#endif
