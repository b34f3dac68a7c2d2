/* messages.h - what a rank sends, counted by the profiling interface of MPI: a program that includes this file has
 * counters between itself and MPI. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_BENCH_MESSAGES_H
#define FIBRAD_BENCH_MESSAGES_H

#include <mpi.h>

enum { MESSAGES, BYTES, COLLECTIVES, COUNTERS };

/* Messages to other ranks, bytes in them, and collective calls. */
static double counted[COUNTERS];

/* Persistent requests that send to other ranks. */
static struct sender {
    MPI_Request request;
    double bytes;
} sender[1 << 16];
static int senders;

static double bytes_of(int count, MPI_Datatype type) {
    int size;
    MPI_Type_size(type, &size);
    return (double)count * size;
}

static void count_message(double bytes, int to, MPI_Comm comm) {
    int rank;
    MPI_Comm_rank(comm, &rank);
    if (to != rank) counted[MESSAGES] += 1, counted[BYTES] += bytes;
}

int MPI_Isend(const void *data, int count, MPI_Datatype type, int to, int tag, MPI_Comm comm, MPI_Request *request) {
    count_message(bytes_of(count, type), to, comm);
    return PMPI_Isend(data, count, type, to, tag, comm, request);
}

int MPI_Send_init(const void *data, int count, MPI_Datatype type, int to, int tag, MPI_Comm comm,
                  MPI_Request *request) {
    const int status = PMPI_Send_init(data, count, type, to, tag, comm, request);
    sender[senders++] = (struct sender){*request, bytes_of(count, type)};
    return status;
}

int MPI_Request_free(MPI_Request *request) {
    for (int k = 0; k < senders; ++k)
        if (sender[k].request == *request) sender[k--] = sender[--senders];
    return PMPI_Request_free(request);
}

int MPI_Startall(int count, MPI_Request *request) {
    for (int i = 0; i < count; ++i)
        for (int k = 0; k < senders; ++k)
            if (sender[k].request == request[i]) counted[MESSAGES] += 1, counted[BYTES] += sender[k].bytes;
    return PMPI_Startall(count, request);
}

int MPI_Allreduce(const void *data, void *result, int count, MPI_Datatype type, MPI_Op op, MPI_Comm comm) {
    counted[COLLECTIVES] += 1;
    return PMPI_Allreduce(data, result, count, type, op, comm);
}

int MPI_Allgather(const void *data, int count, MPI_Datatype type, void *result, int got, MPI_Datatype got_type,
                  MPI_Comm comm) {
    counted[COLLECTIVES] += 1;
    return PMPI_Allgather(data, count, type, result, got, got_type, comm);
}

int MPI_Bcast(void *data, int count, MPI_Datatype type, int root, MPI_Comm comm) {
    counted[COLLECTIVES] += 1;
    return PMPI_Bcast(data, count, type, root, comm);
}

int MPI_Alltoall(const void *data, int count, MPI_Datatype type, void *result, int got, MPI_Datatype got_type,
                 MPI_Comm comm) {
    counted[COLLECTIVES] += 1;
    return PMPI_Alltoall(data, count, type, result, got, got_type, comm);
}

#endif
