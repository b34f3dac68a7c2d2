/* mesh_walls.c - walls of triangles that all ranks of a simulation have. SPDX-License-Identifier: MIT */
#include "couple/simulation/mesh_walls.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "couple/ranks/ranks.h"

enum { VOTERS = 1000 };

/* Keeps a message for the simulation to print, without its word `warning`. It may say that a mesh is not closed, and a
 * floor need not be. */
static void keep_line(void *context, const char *line) {
    struct mesh_walls *walls = context;
    const size_t length = strlen(walls->messages);
    const char *word = strstr(line, "warning: "), *rest = word ? word + strlen("warning: ") : line;
    snprintf(walls->messages + length, sizeof walls->messages - length, "%s%.*s%s", length ? "\n" : "",
             (int)(word ? word - line : 0), line, rest);
}

/* Gives all ranks the triangles of rank 0. status: of rank 0. */
static int share(MPI_Comm comm, int rank, int status, struct stl *stl) {
    uint32_t head[] = {(uint32_t)status, stl->n, stl->solids, stl->text};
    if (!status && (stl->n > INT_MAX / 9 || stl->solids > INT_MAX / SOLID_NAME)) head[0] = STATUS_MEMORY;
    MPI_Bcast(head, 4, MPI_UINT32_T, 0, comm);
    if (head[0]) return (int)head[0];
    const int n = (int)head[1], solids = (int)head[2];
    if (rank > 0) {
        *stl = (struct stl){.n = head[1], .solids = head[2], .text = head[3]};
        stl->corner = malloc((head[1] + (size_t)1) * sizeof *stl->corner);
        stl->place = malloc((head[1] + (size_t)1) * sizeof *stl->place);
        stl->solid = malloc((head[1] + (size_t)1) * sizeof *stl->solid);
        stl->name = malloc((head[2] + (size_t)1) * sizeof *stl->name);
    }
    const bool fits = rank == 0 || (stl->corner && stl->place && stl->solid && stl->name);
    if (fibrad_agree(comm, fits ? FIBRAD_OK : FIBRAD_E_MEMORY, NULL)) return STATUS_MEMORY;
    MPI_Bcast(stl->corner, 9 * n, MPI_DOUBLE, 0, comm);
    MPI_Bcast(stl->place, n, MPI_UINT64_T, 0, comm);
    MPI_Bcast(stl->solid, n, MPI_UINT32_T, 0, comm);
    MPI_Bcast(stl->name, solids * SOLID_NAME, MPI_CHAR, 0, comm);
    return STATUS_OK;
}

int mesh_walls_add(struct mesh_walls *walls, MPI_Comm comm, const struct mesh_file *file, const struct stl *stl,
                   uint32_t first, uint32_t *count) {
    struct stl read = {0}, given = {0};
    int rank, status = STATUS_OK;
    MPI_Comm_rank(comm, &rank);
    walls->messages[0] = 0;
    message_redirect(keep_line, walls);
    if (rank == 0 && !stl) status = stl_read(&read, file->path);
    if (rank == 0 && stl) given = *stl;
    status = share(comm, rank, status, rank == 0 && stl ? &given : &read);
    if (!status) status = meshes_take(&walls->meshes, file, rank == 0 && stl ? stl : &read, first);
    message_redirect(NULL, NULL);
    stl_free(&read);
    status = fibrad_agree(comm, status, NULL);
    *count = status ? 0 : walls->meshes.mesh[walls->meshes.count - 1].walls;
    return status;
}

int mesh_walls_move(struct mesh_walls *walls, const double period[3], const struct mesh_motion *motion, double time) {
    struct meshes *meshes = &walls->meshes;
    const size_t bytes = meshes->triangles.vertices * sizeof *walls->home;
    double *to = meshes->vertex;
    if (!walls->home && (walls->home = malloc(bytes))) memcpy(walls->home, meshes->vertex, bytes);
    if (!walls->home) return STATUS_MEMORY;
    for (uint32_t m = 0; m < meshes->count; ++m) {
        struct surface *surface = &meshes->mesh[m].surface;
        const double(*home)[3] = (const double(*)[3])walls->home + (to - meshes->vertex) / 3;
        mesh_motion_place(&motion[m], time, period, surface->vertices, home, surface->vertex);
        memcpy(to, surface->vertex, surface->vertices * sizeof *surface->vertex);
        to += 3 * (size_t)surface->vertices;
    }
    return STATUS_OK;
}

/* A hash that chooses and orders voters. */
static uint64_t order_of(uint64_t id) {
    id = (id ^ id >> 31) * 0x7fb5d329728ea185u;
    id = (id ^ id >> 27) * 0x81dadef4bc2dd44du;
    return id ^ id >> 33;
}

static int by_order(const void *a, const void *b) {
    const uint64_t first = order_of(((const fibrad_particle *)a)->id),
                   second = order_of(((const fibrad_particle *)b)->id);
    return (first > second) - (first < second);
}

/* Gathers those who vote on all ranks, in the order of their hashes. *n: their number. */
static int gather_voters(MPI_Comm comm, const fibrad_insitu_bed *bed, fibrad_block *voter, size_t *n) {
    uint64_t all = bed->n;
    size_t own = 0, others = 0, first;
    MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_UINT64_T, MPI_SUM, comm);
    const uint64_t most = all > VOTERS ? UINT64_MAX / all * VOTERS : UINT64_MAX;
    int status = fibrad_agree(comm, fibrad_block_fit(voter, bed->n, sizeof(fibrad_particle)), NULL);
    fibrad_particle *p = voter->at;
    for (size_t i = 0; i < bed->n && !status; ++i) {
        if (order_of(bed->id[i]) > most) continue;
        p[own] = (fibrad_particle){.id = bed->id[i], .radius = bed->radius[i]};
        memcpy(p[own++].x, bed->x + 3 * i, sizeof p->x);
    }
    if (!status) status = fibrad_gather(comm, voter, own, &others, &first);
    *n = own + others;
    if (!status) qsort(voter->at, *n, sizeof(fibrad_particle), by_order);
    return status;
}

int mesh_walls_face(struct mesh_walls *walls, MPI_Comm comm, const fibrad_insitu_bed *bed) {
    if (!walls->meshes.triangles.n) return STATUS_OK;
    fibrad_block voter = {0};
    size_t n;
    int status = gather_voters(comm, bed, &voter, &n);
    const fibrad_particle *p = voter.at;
    double *c = status ? NULL : malloc((4 * n + 1) * sizeof *c), period[3]; /* one array for each coordinate */
    for (size_t i = 0; i < n && c; ++i)
        c[i] = p[i].x[0], c[n + i] = p[i].x[1], c[2 * n + i] = p[i].x[2], c[3 * n + i] = p[i].radius;
    for (int axis = 0; axis < 3; ++axis) period[axis] = bed->periodic[axis] ? bed->high[axis] - bed->low[axis] : 0;
    const fibrad_spheres spheres = {.x = c, .y = c + n, .z = c + 2 * n, .r = c + 3 * n, .n = (uint32_t)n};
    walls->messages[0] = 0;
    message_redirect(keep_line, walls);
    status = c ? meshes_face(&walls->meshes, &spheres, period) : STATUS_MEMORY;
    message_redirect(NULL, NULL);
    fibrad_block_free(&voter);
    free(c);
    return fibrad_agree(comm, status, NULL) ? STATUS_MEMORY : STATUS_OK;
}

void mesh_walls_free(struct mesh_walls *walls) {
    meshes_free(&walls->meshes);
    free(walls->home);
    walls->home = NULL;
    walls->messages[0] = 0;
}
