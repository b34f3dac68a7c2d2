/* collective.c - errors that all ranks agree on, and messages that ranks do not expect.
 * SPDX-License-Identifier: MIT */
#include "couple/ranks/collective.h"

#include <inttypes.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>

#define COUNT_TAG 12013
#define DATA_TAG  12014

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

/* Tells each rank how many elements it will get. A rank does not know how many others will tell it. So it receives
 * until every rank knows that all it told has arrived. The caller must let ranks agree before it calls again. Source:
 * T. Hoefler, C. Siebert, A. Lumsdaine, PPoPP 2010, 159: nonblocking consensus. count: NULL for nothing. */
static void tell_counts(MPI_Comm comm, int ranks, const int *count, int *got, MPI_Request *told) {
    int tellings = 0, arrived, all_arrived = 0, over = 0;
    MPI_Request others = MPI_REQUEST_NULL;
    MPI_Status from;
    for (int q = 0; q < ranks; ++q) {
        got[q] = 0;
        if (count && count[q]) MPI_Issend(&count[q], 1, MPI_INT, q, COUNT_TAG, comm, &told[tellings++]);
    }
    while (!over) {
        MPI_Iprobe(MPI_ANY_SOURCE, COUNT_TAG, comm, &arrived, &from);
        if (arrived) MPI_Recv(&got[from.MPI_SOURCE], 1, MPI_INT, from.MPI_SOURCE, COUNT_TAG, comm, MPI_STATUS_IGNORE);
        if (all_arrived) {
            MPI_Test(&others, &over, MPI_STATUS_IGNORE);
        } else {
            MPI_Testall(tellings, told, &all_arrived, MPI_STATUSES_IGNORE);
            if (all_arrived) MPI_Ibarrier(comm, &others);
        }
    }
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
    tell_counts(comm, ranks, status ? NULL : count, got, request);
    const size_t sum = fibrad_count_sum(got, ranks);
    if (!status) status = sum > INT_MAX ? FIBRAD_E_MEMORY : fibrad_block_fit(to, at + sum, size);
    status = fibrad_agree(comm, status, NULL);
    if (!status) send_elements(comm, ranks, send, count, (char *)to->at + at * size, got, size, request);
    free(request);
    return status;
}
