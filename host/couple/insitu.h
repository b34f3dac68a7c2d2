/* insitu.h - what a coupling is made of. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_COUPLE_INSITU_H
#define FIBRAD_COUPLE_INSITU_H

#include "couple/block.h"
#include "couple/collective.h"
#include "couple/fibrad_couple.h"
#include "couple/halo.h"

/* The rows of one step, which stay with the ranks that owned the particles then: their homes. */
typedef struct fibrad_insitu_set {
    fibrad_rows *rows; /* [threads] of the particles [0, own); columns [0, columns) */
    size_t own, columns;
    fibrad_block particle; /* fibrad_particle [own + halo] as they were then, moved into the box */
    fibrad_block id;       /* uint64_t [columns]: own, then those of others that rows see, images one by one */
    fibrad_block weight, emission, power; /* double [columns] A eps [L^2], sigma T^4, and what comes of it */
    uint32_t bodies;
    int emissive;         /* 1: exchange factors, 0: all emissivities are 1 */
    fibrad_link *seen;    /* own particles to columns */
    fibrad_link *present; /* particles of present owners to their homes */
    fibrad_block now;     /* uint64_t [now_n + own] ids of present owners, then those at home */
    size_t now_n;
    fibrad_insitu_facts facts;
} fibrad_insitu_set;

struct fibrad_insitu {
    MPI_Comm comm;
    int rank, ranks;
    fibrad_insitu_config config;
    char message[FIBRAD_MESSAGE];
    fibrad_work *work;                                 /* [threads] */
    fibrad_insitu_set set, next;                       /* the rows there are; memory of those before, and to be */
    int ready;                                         /* there are rows */
    fibrad_block scene, order, emissivity, mark, sent; /* used while rows are made */
    fibrad_block value;                                /* double, of particles of present owners, then at home */
    double seconds_rows, seconds_powers;
};

#endif
