/* mesh_walls.c - walls of triangles, which rank 0 reads and hands to all ranks. SPDX-License-Identifier: MIT */
#include "couple/walls/mesh_walls.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "couple/ranks/collective.h"

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

static void collect_messages(struct mesh_walls *walls) {
    walls->messages[0] = 0;
    message_redirect(keep_line, walls);
}

/* Sends the status of rank 0 to all ranks. */
static int share_status(MPI_Comm comm, int status) {
    MPI_Bcast(&status, 1, MPI_INT, 0, comm);
    return status;
}

static int grow_array(void *array, size_t count, size_t size) {
    void **at = array;
    void *larger = realloc(*at, (count + 1) * size);
    if (larger) *at = larger;
    return larger ? STATUS_OK : STATUS_MEMORY;
}

/* Makes room on the other ranks for the triangles of rank 0. */
static int make_room(struct meshes *meshes, uint32_t vertices, uint32_t n) {
    int status = grow_array(&meshes->vertex, 3 * (size_t)vertices, sizeof *meshes->vertex);
    if (!status) status = grow_array(&meshes->corner, 3 * (size_t)n, sizeof *meshes->corner);
    if (!status) status = grow_array(&meshes->front, n, sizeof *meshes->front);
    if (!status) status = grow_array(&meshes->back, n, sizeof *meshes->back);
    if (status) return status;
    meshes->triangles = (struct fibrad_triangles){.x = meshes->vertex,
                                                  .y = meshes->vertex + 1,
                                                  .z = meshes->vertex + 2,
                                                  .stride = 3,
                                                  .vertices = vertices,
                                                  .corner = meshes->corner,
                                                  .front = meshes->front,
                                                  .back = meshes->back,
                                                  .n = n};
    return STATUS_OK;
}

/* Sends the corners of all triangles and the names of all walls from rank 0 to all ranks. */
static int share_triangles(struct mesh_walls *walls, MPI_Comm comm) {
    struct meshes *meshes = &walls->meshes;
    int rank;
    uint32_t count[2] = {meshes->triangles.vertices, meshes->triangles.n};
    MPI_Comm_rank(comm, &rank);
    MPI_Bcast(count, 2, MPI_UINT32_T, 0, comm);
    int status = rank == 0 ? STATUS_OK : make_room(meshes, count[0], count[1]);
    if (count[0] > INT_MAX / 3 || count[1] > INT_MAX / 3) status = STATUS_MEMORY;
    MPI_Allreduce(MPI_IN_PLACE, &status, 1, MPI_INT, MPI_MAX, comm);
    if (status) return status;
    MPI_Bcast(meshes->vertex, 3 * (int)count[0], MPI_DOUBLE, 0, comm);
    MPI_Bcast(meshes->corner, 3 * (int)count[1], MPI_UINT32_T, 0, comm);
    MPI_Bcast(meshes->name, sizeof meshes->name, MPI_CHAR, 0, comm);
    return STATUS_OK;
}

int mesh_walls_add(struct mesh_walls *walls, MPI_Comm comm, const struct mesh_file *file, const struct stl *stl,
                   uint32_t first, uint32_t *count) {
    int rank, status = STATUS_OK;
    MPI_Comm_rank(comm, &rank);
    *count = 0;
    if (rank == 0) {
        collect_messages(walls);
        status = stl ? meshes_take(&walls->meshes, file, stl, first) : meshes_add(&walls->meshes, file, first);
        message_redirect(NULL, NULL);
        if (!status) *count = walls->meshes.mesh[walls->meshes.count - 1].walls;
    }
    status = share_status(comm, status);
    MPI_Bcast(count, 1, MPI_UINT32_T, 0, comm);
    return status ? status : share_triangles(walls, comm);
}

/* The periods of a bed; 0: the axis is open. */
static void find_periods(const fibrad_insitu_bed *bed, double period[3]) {
    for (int axis = 0; axis < 3; ++axis) period[axis] = bed->periodic[axis] ? bed->high[axis] - bed->low[axis] : 0;
}

/* Keeps the vertices at time 0. */
static int keep_home(struct mesh_walls *walls) {
    const size_t bytes = walls->meshes.triangles.vertices * sizeof *walls->home;
    if (!walls->home && (walls->home = malloc(bytes))) memcpy(walls->home, walls->meshes.vertex, bytes);
    return walls->home ? STATUS_OK : STATUS_MEMORY;
}

int mesh_walls_move(struct mesh_walls *walls, MPI_Comm comm, const fibrad_insitu_bed *bed,
                    const struct mesh_motion *motion, double time) {
    struct meshes *meshes = &walls->meshes;
    int rank;
    double period[3], *to = meshes->vertex;
    MPI_Comm_rank(comm, &rank);
    find_periods(bed, period);
    const int status = share_status(comm, rank == 0 ? keep_home(walls) : STATUS_OK);
    if (status) return status;
    for (uint32_t m = 0; m < meshes->count; ++m) { /* no mesh on ranks but 0 */
        struct surface *surface = &meshes->mesh[m].surface;
        const double(*home)[3] = (const double(*)[3])walls->home + (to - meshes->vertex) / 3;
        mesh_motion_place(&motion[m], time, period, surface->vertices, home, surface->vertex);
        memcpy(to, surface->vertex, surface->vertices * sizeof *surface->vertex);
        to += 3 * (size_t)surface->vertices;
    }
    MPI_Bcast(meshes->vertex, 3 * (int)meshes->triangles.vertices, MPI_DOUBLE, 0, comm);
    return STATUS_OK;
}

/* A particle that votes on which side of a mesh the bed lies. */
struct voter {
    uint64_t order; /* a hash of its id */
    double x[3], radius;
};

static int by_order(const void *a, const void *b) {
    const uint64_t first = ((const struct voter *)a)->order, second = ((const struct voter *)b)->order;
    return (first > second) - (first < second);
}

/* Sorts particles by their hashes. The first VOTERS of them vote. Returns their number. */
static size_t first_voters(struct voter *voter, size_t n) {
    qsort(voter, n, sizeof *voter, by_order);
    return n < VOTERS ? n : VOTERS;
}

/* Gathers the voters of all ranks on rank 0. own: number of voters of this rank. *all: number of voters on rank 0. */
static int gather_voters(MPI_Comm comm, int ranks, struct voter **voter, size_t own, size_t *all) {
    fibrad_block got = {0};
    int *count = calloc(2 * (size_t)ranks, sizeof *count);
    int status = fibrad_agree(comm, count ? FIBRAD_OK : FIBRAD_E_MEMORY, NULL);
    if (!status) {
        count[0] = (int)own;
        status = fibrad_deal(comm, FIBRAD_OK, *voter, count, sizeof **voter, &got, 0, count + ranks);
        if (!status) *all = fibrad_count_sum(count + ranks, ranks);
    }
    free(count);
    free(*voter);
    *voter = got.at;
    return status ? STATUS_MEMORY : STATUS_OK;
}

/* Finds by these voters which sides of triangles are walls. */
static int face_voters(struct mesh_walls *walls, const fibrad_insitu_bed *bed, const struct voter *voter, size_t n) {
    double *c = malloc((4 * n + 1) * sizeof *c), period[3]; /* one array for each coordinate */
    if (!c) return STATUS_MEMORY;
    for (size_t i = 0; i < n; ++i) {
        for (size_t axis = 0; axis < 3; ++axis) c[axis * n + i] = voter[i].x[axis];
        c[3 * n + i] = voter[i].radius;
    }
    find_periods(bed, period);
    const fibrad_spheres spheres = {.x = c, .y = c + n, .z = c + 2 * n, .r = c + 3 * n, .n = (uint32_t)n};
    collect_messages(walls);
    const int status = meshes_face(&walls->meshes, &spheres, period);
    message_redirect(NULL, NULL);
    free(c);
    return status;
}

static uint64_t order_of(uint64_t id) {
    id = (id ^ id >> 31) * 0x7fb5d329728ea185u;
    id = (id ^ id >> 27) * 0x81dadef4bc2dd44du;
    return id ^ id >> 33;
}

int mesh_walls_face(struct mesh_walls *walls, MPI_Comm comm, const fibrad_insitu_bed *bed) {
    struct meshes *meshes = &walls->meshes;
    int rank, ranks, status;
    size_t all = 0;
    MPI_Comm_rank(comm, &rank);
    MPI_Comm_size(comm, &ranks);
    if (!meshes->triangles.n) return STATUS_OK;
    struct voter *voter = malloc((bed->n + 1) * sizeof *voter);
    status = fibrad_agree(comm, voter ? FIBRAD_OK : FIBRAD_E_MEMORY, NULL) ? STATUS_MEMORY : STATUS_OK;
    if (!status) {
        for (size_t i = 0; i < bed->n; ++i)
            voter[i] = (struct voter){
                order_of(bed->id[i]), {bed->x[3 * i], bed->x[3 * i + 1], bed->x[3 * i + 2]}, bed->radius[i]};
        status = gather_voters(comm, ranks, &voter, first_voters(voter, bed->n), &all);
    }
    if (!status && rank == 0) status = face_voters(walls, bed, voter, first_voters(voter, all));
    free(voter);
    status = share_status(comm, status);
    if (status) return status;
    MPI_Bcast(meshes->front, (int)meshes->triangles.n, MPI_UINT32_T, 0, comm);
    MPI_Bcast(meshes->back, (int)meshes->triangles.n, MPI_UINT32_T, 0, comm);
    return STATUS_OK;
}

void mesh_walls_free(struct mesh_walls *walls) {
    meshes_free(&walls->meshes);
    free(walls->home);
    walls->home = NULL;
    walls->messages[0] = 0;
}
