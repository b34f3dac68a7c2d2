/* ranks.h - what ranks of a simulation send each other. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_COUPLE_RANKS_H
#define FIBRAD_COUPLE_RANKS_H

#include <mpi.h>
#include <stdbool.h>
#include <stdlib.h>

#include "fibrad.h"

/* ---- memory on the heap that grows and is reused ----------------------------------------------------------------- */

/* Memory on the heap. Begin with zeroes; free with fibrad_block_free. */
typedef struct fibrad_block {
    void *at;
    size_t size; /* bytes */
} fibrad_block;

/* Gives the block another size. Returns FIBRAD_OK, or _E_MEMORY with the block unchanged. */
static inline int fibrad_block_resize(fibrad_block *block, size_t size) {
    void *at = realloc(block->at, size);
    if (!at) return FIBRAD_E_MEMORY;
    block->at = at, block->size = size;
    return FIBRAD_OK;
}

/* Makes room for `count` elements of `size` bytes and keeps the contents. Errors: as fibrad_block_resize. */
static inline int fibrad_block_fit(fibrad_block *block, size_t count, size_t size) {
    const size_t needed = (count + 1) * size; /* never NULL */
    return needed > block->size ? fibrad_block_resize(block, needed + needed / 4) : FIBRAD_OK;
}

/* Gives back the memory that is more than `count` elements of `size` bytes need. */
static inline void fibrad_block_trim(fibrad_block *block, size_t count, size_t size) {
    (void)fibrad_block_resize(block, (count + 1) * size);
}

static inline void fibrad_block_free(fibrad_block *block) {
    free(block->at);
    *block = (fibrad_block){0};
}

/* ---- errors that all ranks agree on, and elements for other ranks ------------------------------------------------ */

#define FIBRAD_MESSAGE 256 /* bytes of a message */

/* A hash of an id: the same id has the same hash on all ranks. */
static inline uint64_t fibrad_hash_id(uint64_t id) {
    id = (id ^ id >> 30) * 0xbf58476d1ce4e5b9u;
    id = (id ^ id >> 27) * 0x94d049bb133111ebu;
    return id ^ id >> 31;
}

/* The sum of the hashes of ids, whatever their order. */
static inline uint64_t fibrad_hash_ids(const uint64_t *id, size_t n) {
    uint64_t sum = 0;
    for (size_t i = 0; i < n; ++i) sum += fibrad_hash_id(id[i]);
    return sum;
}

/* Prints a sentence into message[FIBRAD_MESSAGE] and returns status. */
int fibrad_refuse(char *message, int status, const char *format, ...);

/* The same for a particle. Returns FIBRAD_E_ARGUMENT. */
int fibrad_refuse_particle(char *message, uint64_t id, const char *fault);

/* Collective. Returns FIBRAD_OK if all ranks pass FIBRAD_OK. Else returns on all ranks the status of the lowest rank
 * that failed, and copies its message. message may be NULL. An empty message becomes the text of the status. */
int fibrad_agree(MPI_Comm comm, int status, char *message);

/* Collective. Sends elements of `size` bytes from `send` to ranks: count[q] elements to rank q, in the order of ranks.
 * The elements that arrive, got[q] from rank q, are put behind the first `at` elements of `to`, in the order of ranks.
 * Ranks that have elements for each other exchange one message. If a rank passes an error as `status`, no elements are
 * sent, and `count` is not read. Errors, on all ranks: that status; _MEMORY. */
int fibrad_deal(MPI_Comm comm, int status, const void *send, const int *count, size_t size, fibrad_block *to, size_t at,
                int *got);

/* The sum of counts; and start[ranks], where the elements of each rank begin. */
size_t fibrad_count_sum(const int *count, int ranks);
void fibrad_count_starts(const int *count, int ranks, int *start);

/* ---- particles of other ranks and periodic images near the particles of this rank -------------------------------- */

/* Where a rank has a particle: the rank, and the index there. */
typedef struct fibrad_place {
    uint32_t rank, index;
} fibrad_place;

/* A particle in a message. It consists of words alone, so that coordinates are doubles with a stride. */
typedef struct fibrad_particle {
    uint64_t id;
    double x[3], radius;             /* [L] */
    double emissivity, conductivity; /* k*; of contacts: power/(L K) */
    union {
        double node;        /* the emissivity of the node, fibrad_node_emissivity */
        double temperature; /* K, of contacts */
    };
    uint64_t clump;     /* 0: it is alone */
    double exposed;     /* L^2, area that no other member of its clump hides, when its row was made */
    fibrad_place owner; /* set by fibrad_halo and fibrad_gather: where its owner has it */
} fibrad_particle;

/* Particles as spheres. id, clump: out, [n]; NULL: they get none */
static inline fibrad_spheres fibrad_particle_spheres(const fibrad_particle *p, size_t n, uint64_t *id,
                                                     uint32_t *clump) {
    const uint32_t stride = sizeof *p / sizeof(double);
    for (size_t i = 0; i < n && id; ++i) id[i] = p[i].id;
    for (size_t i = 0; i < n && clump; ++i) clump[i] = (uint32_t)p[i].clump;
    return (fibrad_spheres){&p->x[0], &p->x[1], &p->x[2], &p->radius, (uint32_t)n, stride, stride, id, clump};
}

/* Collective. Appends to particle[own] the particles of other ranks, and the periodic images of particles of all ranks,
 * within `reach` of the box of the centres of particle[own]. Their order depends on who owns which particle. An image
 * has the coordinates x + s period with integers s, whoever owns the particle. once: no images are appended, but each
 * particle of another rank that is within reach, or has an image there. period 0: the axis is open. sent: scratch.
 * *halo: number appended. Errors, on all ranks: _MEMORY. Cost: own particles times neighbouring ranks. */
int fibrad_halo(MPI_Comm comm, const double period[3], double reach, bool once, fibrad_block *particle, size_t own,
                fibrad_block *sent, size_t *halo);

/* Collective. Appends to particle[own] all particles of other ranks, in the order of ranks. No image is appended.
 * *others: number appended; *first: number of those of lower ranks. Errors, on all ranks: _MEMORY. */
int fibrad_gather(MPI_Comm comm, fibrad_block *particle, size_t own, size_t *others, size_t *first);

/* ---- marks the coarse cells of the whole bed that have particles ------------------------------------------------- */

/* Collective. Makes the occupancy of the bed: marks the cells that particles of any rank may touch. The caller sets
 * low, high and periodic of `map`, the same on all ranks. Cells are about `width` wide. radius: the largest radius.
 * There are at most 2^24 cells. If there were more, the box is first narrowed, which leaves out particles far from all
 * others; then cells are made wider. mark: memory of the map.
 * Errors, on all ranks: _MEMORY. */
int fibrad_coarse_map(MPI_Comm comm, double width, double radius, const fibrad_particle *particle, size_t own,
                      fibrad_block *mark, fibrad_occupancy *map);

/* ---- particles beyond walls, and what is said of particles of which no scene can be made as they are ------------- */

/* The walls and openings around a bed, the same on all ranks. The place of each opening is known. */
typedef struct fibrad_bounds {
    const fibrad_wall *wall;     /* [walls] */
    const fibrad_plane *opening; /* [openings] */
    uint32_t walls, openings;
} fibrad_bounds;

/* What happened to some particles of a bed: their number, and a sentence about the one with the least id. */
typedef struct fibrad_remark {
    uint64_t count, id;
    char message[FIBRAD_MESSAGE];
} fibrad_remark;

/* Whether a particle lies within the bounds: its centre inside all planes and the cylinder, all of it before all
 * openings. If not, message[FIBRAD_MESSAGE] gets a sentence with its id, its place and the wall, and *opening tells
 * whether an opening is at fault. */
bool fibrad_bounds_hold(const fibrad_bounds *bounds, const fibrad_particle *particle, bool *opening, char *message);

/* Counts a particle, and keeps the sentence if no particle of a lower id was counted before. */
void fibrad_remark_add(fibrad_remark *remark, uint64_t id, const char *message);

/* Collective. Makes the remark that of all ranks together. */
void fibrad_remark_agree(MPI_Comm comm, fibrad_remark *remark);

#endif
