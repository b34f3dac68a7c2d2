/* mesh_walls.h - walls of triangles that all ranks of a simulation have. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_COUPLE_MESH_WALLS_H
#define FIBRAD_COUPLE_MESH_WALLS_H

#include "couple/fibrad_couple.h"

#ifdef __cplusplus
extern "C" {
#endif

#include "couple/simulation/mesh_motion.h"
#include "mesh/meshes.h"

enum { MESH_WALLS_MESSAGES = 2048 };

/* The meshes of a simulation, the same on all ranks. Begin with zeroes; free with mesh_walls_free. */
struct mesh_walls {
    struct meshes meshes;
    double (*home)[3];                  /* vertices at time 0; NULL before mesh_walls_move */
    char messages[MESH_WALLS_MESSAGES]; /* lines of warnings of the last call, or of its error; "": none */
};

/* Collective. Adds a mesh. Rank 0 reads the file, or takes the triangles of `stl` if that is not NULL; other ranks need
 * no file. The first wall gets the index `first`. *count: number of walls. Status, the same on all ranks, as
 * meshes_add. */
int mesh_walls_add(struct mesh_walls *walls, MPI_Comm comm, const struct mesh_file *file, const struct stl *stl,
                   uint32_t first, uint32_t *count);

/* Puts the triangles of all meshes where they are at a time. At time 0 they are where mesh_walls_add has put them.
 * motion: [meshes]. period: 0: the axis is open. Call it when all meshes have been added. Status 0 or
 * STATUS_MEMORY. */
int mesh_walls_move(struct mesh_walls *walls, const double period[3], const struct mesh_motion *motion, double time);

/* Collective. Finds which sides of triangles are walls: those on which the particles of a bed lie. About 1000 particles
 * vote. Their ids choose them, so the result does not depend on who owns them. Status, the same on all ranks: 0 or
 * STATUS_MEMORY. */
int mesh_walls_face(struct mesh_walls *walls, MPI_Comm comm, const fibrad_insitu_bed *bed);

void mesh_walls_free(struct mesh_walls *walls);

#ifdef __cplusplus
}
#endif
#endif
