/* mesh_patch.h - the patches of a mesh. SPDX-License-Identifier: MIT
 *
 * A side that is larger than two patches is halved across its longest edge, and its halves again, so that all its
 * patches are of one area; four that follow each other make up one that is halved twice less. Smaller sides that are
 * near each other in the tree, and face the same way, share a patch. */
#ifndef FIBRAD_MESH_MESH_PATCH_H
#define FIBRAD_MESH_MESH_PATCH_H

#include "mesh/mesh.h"

/* The first patch of a side, and how often it is halved. */
typedef struct fibrad_mesh_cut {
    uint32_t patch; /* UINT32_MAX: the side is nobody's */
    uint32_t halvings;
} fibrad_mesh_cut;

/* Cuts a mesh into patches of about an area [L^2], numbered from `first` on; returns how many. cut: [2 triangles] by
 * the caller's numbers, fronts and backs in turn, so that it holds wherever the triangles move; NULL: only counts. */
uint32_t fibrad_mesh_cut_sides(const fibrad_mesh *mesh, uint32_t number, double area, uint32_t first,
                               fibrad_mesh_cut *cut);

/* What is kept of the cut of a side. */
static inline fibrad_mesh_cut *fibrad_mesh_cut_of(const fibrad_mesh *mesh, fibrad_mesh_cut *cut, uint32_t side) {
    return &cut[2 * (size_t)mesh->number[side / 2] + side % 2];
}

/* The patch at a place [L] on a side of a mesh, or on an image of it. */
uint32_t fibrad_mesh_patch_at(const fibrad_mesh *mesh, const fibrad_mesh_cut *cut, uint32_t side, const double at[3]);

#endif
