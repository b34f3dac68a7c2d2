/* collective.h - errors that all ranks agree on, and elements for other ranks.
 * SPDX-License-Identifier: MIT */
#ifndef FIBRAD_COUPLE_COLLECTIVE_H
#define FIBRAD_COUPLE_COLLECTIVE_H

#include <mpi.h>

#include "couple/ranks/block.h"

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

#endif
