/* mesh_walls.h - walls of triangles that rank 0 reads and all ranks know. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_COUPLE_MESH_WALLS_H
#define FIBRAD_COUPLE_MESH_WALLS_H

#include "couple/fibrad_couple.h"

#ifdef __cplusplus
extern "C" {
#endif

#include "mesh/meshes.h"

enum { MESH_WALLS_TOLD = 2048 };

/* Meshes as of all ranks: rank 0 alone has more than meshes.triangles. Zeroed: none; to be freed by mesh_walls_free. */
struct mesh_walls {
    struct meshes meshes;
    char told[MESH_WALLS_TOLD]; /* rank 0: warnings of the last call, or why it failed, a line each; "": nothing */
};

/* Collective. Rank 0 reads a file, or takes triangles that it has (stl not NULL), and the others get their corners:
 * the file is read once, and need not be there for other ranks. Its bodies are `body` and those behind it. *bodies: how
 * many. Status 0 or, on all ranks, that of meshes_add; STATUS_MEMORY. */
int mesh_walls_add(struct mesh_walls *walls, MPI_Comm comm, const struct mesh_file *file, const struct stl *stl,
                   uint32_t body, uint32_t *bodies);

/* Collective. Finds out which sides the particles of a bed are on: up to 1000 vote, chosen by their ids, whoever owns
 * them. Status 0 or STATUS_MEMORY, on all ranks. */
int mesh_walls_face(struct mesh_walls *walls, MPI_Comm comm, const fibrad_insitu_bed *bed);

void mesh_walls_free(struct mesh_walls *walls);

#ifdef __cplusplus
}
#endif
#endif
