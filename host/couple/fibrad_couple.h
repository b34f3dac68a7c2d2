/* fibrad_couple.h - radiation in simulations whose particles are divided over MPI ranks.
 *
 * Index     link     values of particles that other ranks own   fibrad_link_new, _forward, _reverse, _free
 *           insitu   rows and powers while particles move       fibrad_insitu_new, _rows, _powers, _write, _message,
 *                                                               _facts, _free
 *
 * Use       fibrad_insitu_new once; fibrad_insitu_rows every so many steps, with the particles each rank owns then;
 *           fibrad_insitu_powers whenever temperatures have changed, with the particles each rank owns by then.
 *           host/couple/example.c is a complete program.
 * Ids       Particles are known by their ids alone: 64 bits, each id on one rank. Ranks may have none. The order of
 *           particles, which rank has which, and ghosts do not matter; ranks find what they need of each other.
 * Exchange  Rows are those of exchange factors D (of view factors where all emissivities are 1). Each rank computes the
 *           rows of the particles it owns, which stay there until the next rows, wherever the particles go. Half of
 *           each entry between particles carries heat from i to j, so that no heat is lost, whatever the rows' errors;
 *           particles of equal temperatures exchange nothing. docs/coupling.md has the scheme.
 * Bits      Rows do not depend on the number of ranks, on who owns what, or on threads: not a bit.
 * Units     One length unit L; powers in the unit of sigma T^4 L^2; temperatures absolute.
 * Errors    All functions but _free, _message, _facts are collective over the communicator: every rank calls them, and
 *           all return the same fibrad_status. After an error fibrad_insitu_message has a sentence, the same on all
 *           ranks, that names the particles by id; the object is as it was before the call.
 *
 * SPDX-License-Identifier: MIT */
#ifndef FIBRAD_COUPLE_H
#define FIBRAD_COUPLE_H

#include <mpi.h>

#include "fibrad.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- link ------------------------------------------------------------------------------------------------------ */
/* Values of particles, by id: each rank owns some, and uses some that others own, or itself. */
typedef struct fibrad_link fibrad_link;

/* Connects id[own] that this rank owns, each id owned once, with id[own .. all) that it uses, in any order and as often
 * as it likes. Errors: FIBRAD_E_ARGUMENT: an id is owned twice or used and not owned (*culprit, unless NULL: that id,
 * the least one on all ranks); _MEMORY. Cost: four exchanges of all ranks, of one or two words per id. */
int fibrad_link_new(fibrad_link **link, MPI_Comm comm, const uint64_t *id, size_t own, size_t all, uint64_t *culprit);

/* value[all][width], ranks in contact alone exchange messages. _forward: sets the values used to those of their owners.
 * _reverse: adds the values used to those of their owners, in an order that depends on the link alone, and sets the
 * values used to 0. width >= 1, the same on all ranks. Errors: none but those of MPI. Cost: `width` messages to and
 * from each rank in contact, of 8 bytes per particle that both know. */
void fibrad_link_forward(fibrad_link *link, double *value, int width);
void fibrad_link_reverse(fibrad_link *link, double *value, int width);
void fibrad_link_free(fibrad_link *link); /* NULL: nothing. Not collective */

/* ---- insitu ---------------------------------------------------------------------------------------------------- */
typedef struct fibrad_insitu fibrad_insitu;

/* How rows are made; the same on all ranks. Zeroed: all defaults. */
typedef struct fibrad_insitu_config {
    double cutoff;       /* [L] from a particle's centre, beyond which it sees nothing; 0: 8 mean radii (10 if some
                            emissivity is below 0.4) + the largest diameter, which is the least */
    uint32_t directions; /* of the first leg, as in fibrad_exchange_rule; 0: its default */
    uint32_t paths;      /* likewise, for reflections; 0: its default */
    double tolerance;    /* of each row, likewise; 0: none */
    uint64_t seed;       /* paths depend on it, on the step and on the particle's id */
    int threads;         /* per rank; 0: 1 */
} fibrad_insitu_config;

/* The bed when rows are made. Box, periodic and walls are the same on all ranks. */
typedef struct fibrad_insitu_bed {
    double low[3], high[3];        /* [L] of the box; matters along periodic axes alone */
    int periodic[3];               /* 1: the bed repeats along the axis with period high - low */
    const fibrad_body *body;       /* [bodies] walls, as in fibrad_scene_config: every centre inside of them */
    const double *body_emissivity; /* [bodies] [0, 1] */
    uint32_t bodies;
    const fibrad_plane *opening; /* [openings] as in fibrad_scene_config; at NaN: where the particles end */
    uint32_t openings;           /* [0, 6] */
    const struct fibrad_triangles *triangles; /* fibrad_mesh.h: all of bodies that are meshes, the same on all ranks;
                                                 on periodic axes they repeat; NULL: none */
    size_t n;                                 /* particles that this rank owns */
    const uint64_t *id;                       /* [n] */
    const double *x;                          /* [n][3] [L] */
    const double *radius;                     /* [n] [L] */
    const double *emissivity;                 /* [n] [0, 1]; 0 reflects all */
} fibrad_insitu_bed;

/* What radiates when powers are asked for. */
typedef struct fibrad_insitu_state {
    double sigma;                   /* 0: FIBRAD_STEFAN_BOLTZMANN */
    double surroundings;            /* temperature of what is seen where there is neither particle nor wall */
    const double *body_temperature; /* [bodies of the rows] */
    size_t n;                       /* particles that this rank owns now: on all ranks together those of the rows */
    const uint64_t *id;             /* [n] */
    const double *temperature;      /* [n] > 0 */
} fibrad_insitu_state;

/* Sums over all ranks, the same on all; powers > 0 where heat is gained. They add up to 0, to rounding. */
typedef struct fibrad_insitu_totals {
    double particles, surroundings;
    double body[FIBRAD_BODIES_MAX]; /* [bodies of the rows] */
} fibrad_insitu_totals;

/* What the last rows were, over all ranks. */
typedef struct fibrad_insitu_facts {
    uint64_t particles, entries;
    double cutoff;         /* [L] in use */
    double beyond;         /* mean fraction of what particles emit that was cut off; given back to the rows */
    double error;          /* root mean square of the rows' estimated errors */
    double seconds_rows;   /* of the slowest rank, in all calls of fibrad_insitu_rows so far */
    double seconds_powers; /* likewise, of fibrad_insitu_powers */
    uint64_t step;         /* of the rows */
    size_t halo;           /* particles of others that this rank was sent */
    size_t bytes;          /* memory of this rank */
} fibrad_insitu_facts;

/* Begins. comm is duplicated. config: NULL is all defaults. Errors: FIBRAD_E_ARGUMENT, _MEMORY. */
int fibrad_insitu_new(fibrad_insitu **insitu, MPI_Comm comm, const fibrad_insitu_config *config);

/* Makes all rows anew. Errors: FIBRAD_E_ARGUMENT (a value out of its range, an id twice, a centre beyond a wall),
 * _GEOMETRY (a centre inside another particle, a particle beyond an opening), _ENDLESS, _BACK (a side of a triangle is
 * seen that is no body's), _MEMORY. */
int fibrad_insitu_rows(fibrad_insitu *insitu, const fibrad_insitu_bed *bed, uint64_t step);

/* Net radiative power of each particle this rank owns now, power[n], > 0 where heat is gained. totals may be NULL.
 * Errors: FIBRAD_E_ARGUMENT (a temperature that is not above 0 or not finite), FIBRAD_E_STATE (no rows, or other ids
 * than those of the rows). */
int fibrad_insitu_powers(fibrad_insitu *insitu, const fibrad_insitu_state *state, double *power,
                         fibrad_insitu_totals *totals);

/* Writes the rows of each rank to the file `path`.<rank>.rows, for `fibrad join`. Errors: FIBRAD_E_STATE (no rows),
 * _ARGUMENT (a file could not be written: the message has its name; no rank leaves a file behind). */
int fibrad_insitu_write(fibrad_insitu *insitu, const char *path);

const char *fibrad_insitu_message(const fibrad_insitu *insitu); /* never NULL; NULL insitu: "" */
void fibrad_insitu_facts_get(const fibrad_insitu *insitu, fibrad_insitu_facts *facts);
void fibrad_insitu_free(fibrad_insitu *insitu); /* NULL: nothing. Collective: frees the communicator */

#ifdef __cplusplus
}
#endif
#endif
