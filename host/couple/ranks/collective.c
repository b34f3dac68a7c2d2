/* collective.c - errors that all ranks agree on, and elements for other ranks.
 * SPDX-License-Identifier: MIT */
#include "couple/ranks/ranks.h"

#include <inttypes.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>

#define DATA_TAG 12013

int fibrad_refuse(char *message, int status, const char *format, ...) {
    va_list list;
    va_start(list, format);
    vsnprintf(message, FIBRAD_MESSAGE, format, list);
    va_end(list);
    return status;
}

int fibrad_refuse_particle(char *message, uint64_t id, const char *fault) {
    return fibrad_refuse(message, FIBRAD_E_ARGUMENT, "particle %" PRIu64 ": %s", id, fault);
}

int fibrad_agree(MPI_Comm comm, int status, char *message) {
    int rank, ranks, lowest;
    MPI_Comm_rank(comm, &rank);
    MPI_Comm_size(comm, &ranks);
    lowest = status ? rank : ranks;
    MPI_Allreduce(MPI_IN_PLACE, &lowest, 1, MPI_INT, MPI_MIN, comm);
    if (lowest == ranks) return FIBRAD_OK;
    MPI_Bcast(&status, 1, MPI_INT, lowest, comm);
    if (!message) return status;
    if (rank == lowest && !message[0]) fibrad_refuse(message, status, "rank %d: %s", rank, fibrad_status_text(status));
    MPI_Bcast(message, FIBRAD_MESSAGE, MPI_CHAR, lowest, comm);
    return status;
}

size_t fibrad_count_sum(const int *count, int ranks) {
    size_t sum = 0;
    for (int q = 0; q < ranks; ++q) sum += (size_t)count[q];
    return sum;
}

void fibrad_count_starts(const int *count, int ranks, int *start) {
    int sum = 0;
    for (int q = 0; q < ranks; ++q) start[q] = sum, sum += count[q];
}

static void send_elements(MPI_Comm comm, int ranks, const char *send, const int *count, char *to, const int *got,
                          size_t size, MPI_Request *request) {
    int requests = 0;
    MPI_Datatype thing;
    MPI_Type_contiguous((int)size, MPI_BYTE, &thing);
    MPI_Type_commit(&thing);
    for (int q = 0; q < ranks; to += (size_t)got[q] * size, ++q)
        if (got[q]) MPI_Irecv(to, got[q], thing, q, DATA_TAG, comm, &request[requests++]);
    for (int q = 0; q < ranks; send += (size_t)count[q] * size, ++q)
        if (count[q]) MPI_Isend(send, count[q], thing, q, DATA_TAG, comm, &request[requests++]);
    MPI_Waitall(requests, request, MPI_STATUSES_IGNORE);
    MPI_Type_free(&thing);
}

int fibrad_deal(MPI_Comm comm, int status, const void *send, const int *count, size_t size, fibrad_block *to, size_t at,
                int *got) {
    int ranks;
    MPI_Comm_size(comm, &ranks);
    MPI_Request *request = malloc(2 * (size_t)ranks * sizeof(MPI_Request));
    if (!status && (!request || fibrad_count_sum(count, ranks) > INT_MAX)) status = FIBRAD_E_MEMORY;
    status = fibrad_agree(comm, status, NULL);
    if (!status) {
        MPI_Alltoall(count, 1, MPI_INT, got, 1, MPI_INT, comm);
        const size_t sum = fibrad_count_sum(got, ranks);
        status = fibrad_agree(comm, sum > INT_MAX ? FIBRAD_E_MEMORY : fibrad_block_fit(to, at + sum, size), NULL);
    }
    if (!status) send_elements(comm, ranks, send, count, (char *)to->at + at * size, got, size, request);
    free(request);
    return status;
}
