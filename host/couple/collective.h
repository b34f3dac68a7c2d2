/* collective.h - errors agreed by all ranks, and things dealt out to them. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_COUPLE_COLLECTIVE_H
#define FIBRAD_COUPLE_COLLECTIVE_H

#include <mpi.h>

#include "couple/block.h"

#define FIBRAD_MESSAGE 256 /* bytes of a message */

/* Puts a sentence into message[FIBRAD_MESSAGE], as printf does, and returns status. */
int fibrad_refuse(char *message, int status, const char *format, ...);

/* Collective. FIBRAD_OK if all ranks say so; else, on all ranks, the status and the message (may be NULL) of the lowest
 * rank that failed. A message that is empty becomes the text of the status. */
int fibrad_agree(MPI_Comm comm, int status, char *message);

/* Collective. Sends count[ranks] things of `size` bytes to each rank, which follow each other in `send`, and puts those
 * that come, got[ranks] from each, behind the first `at` things of `to`, by rank. Nothing is sent if some rank's
 * `status` is an error, which is returned. Errors: that, _MEMORY; on all ranks. */
int fibrad_deal(MPI_Comm comm, int status, const void *send, const int *count, size_t size, fibrad_block *to, size_t at,
                int *got);

/* Sum of counts; start[ranks]: where the things of each rank begin. */
size_t fibrad_count_sum(const int *count, int ranks);
void fibrad_count_starts(const int *count, int ranks, int *start);

#endif
