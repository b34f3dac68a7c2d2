/* fibrad_couple.h - radiation in simulations whose particles are divided over MPI ranks.
 *
 * Index
 *   link    values of particles that other ranks own  fibrad_link_new, _forward, _reverse, _free
 *   insitu  rows and powers while particles move      fibrad_insitu_new, _rows, _follow, _powers, _errors, _conduct,
 *                                                     _write, _message, _remark, _facts_get,
 *                                                     _free, fibrad_accuracy_named
 *
 * Use         1. fibrad_insitu_new once.
 *             2. fibrad_insitu_rows every so many steps, with the particles that each rank owns at that time.
 *             3. fibrad_insitu_powers when temperatures have changed, with the particles that each rank owns by then.
 *             host/couple/example.c is a complete program.
 * Particles   A particle is a sphere with an id of 64 bits. One rank owns it. A rank may own none. The order of the
 *             particles does not matter. Ghosts are not needed: the ranks send each other the particles they need.
 * Rows        A row holds exchange factors, or view factors if all emissivities are 1. Each rank computes the rows of
 *             the particles that it owns. The rows stay on this rank until new rows are made, wherever the particles
 *             go.
 * Powers      Two particles exchange the mean of what their two rows say. A row without the other particle says 0. One
 *             particle gains what the other loses. So no heat is lost, whatever the error of the rows. Nothing flows
 *             between particles of equal temperature.
 * Sources     A wall of emissivity above 0 is a source, and so is an opening. Paths begin at particles and at sources.
 *             Paths of sources tell what sources exchange with each other. Totals contain this exchange. Paths of
 *             sources also make rows of particles more accurate. Three kinds of walls have no paths: an endless wall, a
 *             wall from which paths reach a side that belongs to no wall, and any wall of a bed with a cutoff. What
 *             such walls exchange with each other is left out. See docs/lammps.md.
 * Bits        Rows are the same to the bit for every number of ranks and threads, whoever owns which particle.
 * Collective  Every rank must call a collective function, and all ranks get the same status. All functions are
 *             collective over the communicator, except fibrad_link_free, fibrad_insitu_message, fibrad_insitu_remark,
 *             fibrad_insitu_facts_get and fibrad_accuracy_named.
 * Errors      After an error of a function other than fibrad_insitu_new, fibrad_insitu_message has a sentence. It is
 *             the same on all ranks, and names particles by id. The object is as it was before the call.
 * Strays      A stray is a particle beyond a wall or an opening, inside another particle, or in sight of a side of a
 *             triangle that belongs to no wall. With config.strict a stray is an error. Otherwise rows are made, and
 *             fibrad_insitu_remark says what was done (docs/lammps.md has more):
 *               left out  The centre of the particle lies beyond a plane or the cylinder, or the particle reaches
 *                         beyond an opening. It exchanges nothing and hides nothing.
 *               smaller   The centre of one particle lies inside another. The rows take smaller radii for both.
 *               no row    The particle sees a side of a triangle that belongs to no wall.
 * Units       One length unit L, which the caller chooses. Powers are in sigma K^4 L^2.
 * Words       Words and the layout of comments are as in fibrad.h.
 * Source      docs/lammps.md
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
/* Connects the values that a rank owns with the same values on the ranks that use them. */
typedef struct fibrad_link fibrad_link;

/* Makes a link.
 *   Input    id[all]: first the `own` ids that this rank owns, then the ids that this rank uses. One rank owns an id.
 *            Any rank may use the id, the owner too, in any order and any number of times.
 *   Output   link: free with fibrad_link_free
 *            culprit: the least id at fault on all ranks; may be NULL
 *   Errors   _ARGUMENT: an id is owned twice, or used and not owned
 *            _MEMORY
 *   Cost     For each id one rank knows its owner. The number of this rank follows from the id. The rank gets 16 bytes
 *            per own id. 8 bytes per used id go there and back. 4 bytes per different used id go to its owner. */
int fibrad_link_new(fibrad_link **link, MPI_Comm comm, const uint64_t *id, size_t own, size_t all, uint64_t *culprit);

/* Copies the values of the owners to the ranks that use these ids. Only ranks that share particles exchange messages.
 *   Input    value[all][width]: in the order of the ids; the first `own` are read
 *            width: at least 1, the same on all ranks
 *   Output   value[all][width]: the others are set
 *   Errors   none but those of MPI
 *   Cost     `width` messages to and from each rank in contact, 8 bytes for each particle that both ranks have */
void fibrad_link_forward(fibrad_link *link, double *value, int width);

/* The way back: adds the values on the ranks that use an id to the value of the owner, and sets the added values to 0.
 * The order of the sums depends on the link alone.
 *   Input    value[all][width], width: as for fibrad_link_forward
 *   Output   value[all][width]
 *   Errors   none but those of MPI
 *   Cost     as fibrad_link_forward */
void fibrad_link_reverse(fibrad_link *link, double *value, int width);

/* Frees a link. NULL is allowed. Not collective.
 *   Errors   none */
void fibrad_link_free(fibrad_link *link);

/* ---- insitu ---------------------------------------------------------------------------------------------------- */
/* The rows of a bed, and what is needed to make them. */
typedef struct fibrad_insitu fibrad_insitu;

/* Directions and paths of each row. If a wall or the surroundings have no paths, a row has the second number of paths.
 * docs/lammps.md has errors and times. */
typedef enum fibrad_accuracy {
    FIBRAD_ACCURACY_NORMAL = 0, /* 30 directions; 24 paths, or 80 */
    FIBRAD_ACCURACY_LOW = 1,    /* 16 directions; 8 paths, or 34 */
    FIBRAD_ACCURACY_HIGH = 2    /* 144 directions, or more for an open_error of 7e-4 (fibrad_exchange_rule); 800 paths,
                                   or 1,600 */
} fibrad_accuracy;

/* The fibrad_accuracy of the name low, normal or high. Not collective.
 *   Output   -1: there is no such name
 *   Errors   none */
int fibrad_accuracy_named(const char *name);

/* How rows are made. The same on all ranks. Zeroed: all defaults.
 *
 * Up to 4e6 particles there is no cutoff by default, and each rank has all particles while rows are made. With more
 * particles the default cutoff follows from their number, so that ranks do not send each other too many: see
 * docs/lammps.md. A cutoff saves memory on many ranks. But then walls and the surroundings have no paths, since these
 * need all particles. Rows take about as long with any cutoff. A bed without periods that is shorter than the cutoff
 * is not cut. */
typedef struct fibrad_insitu_config {
    double cutoff;       /* L, as in fibrad_exchange_rule, at least the largest diameter; 0: see above */
    uint32_t directions; /* as in fibrad_exchange_rule, for all rows; 0: those of `accuracy` */
    uint32_t paths;      /* of particles, as in fibrad_exchange_rule; 0: those of `accuracy` */
    double tolerance;    /* as in fibrad_exchange_rule; 0: none */
    uint64_t seed;       /* of random numbers, together with the step and the id of the particle */
    int threads;         /* of each rank, 1 to 1024; 0: 1 */
    int strict;          /* 1: strays are errors; 0: they are left out, or smaller, see above */
    int accuracy;        /* a fibrad_accuracy */
} fibrad_insitu_config;

/* The bed for which rows are made. Box, walls, openings and triangles are the same on all ranks. */
typedef struct fibrad_insitu_bed {
    double low[3], high[3];                   /* L, the box, used along periodic axes and for openings */
    int periodic[3];                          /* 1: the bed repeats along the axis with the period high - low */
    const fibrad_wall *wall;                  /* [walls], walls; a particle beyond one is a stray, see above */
    const double *wall_emissivity;            /* [walls], 0 to 1 */
    uint32_t walls;                           /* number of walls, 0 to FIBRAD_WALLS_MAX */
    const fibrad_plane *opening;              /* [openings]; `at` NaN: where the particles end; infinite: at the end of
                                                 the box, or where the particles end if that is farther out */
    uint32_t openings;                        /* 0 to 6 */
    const struct fibrad_triangles *triangles; /* of all meshes, repeated along periodic axes; NULL: none */
    size_t n;                                 /* number of particles that this rank owns */
    const uint64_t *id;                       /* [n] */
    const double *x;                          /* L, [n][3], centres */
    const double *radius;                     /* L, [n] */
    const double *emissivity;                 /* [n], 0 to 1; 0 reflects everything */
    /* [n], number of the clump of each, a body of particles that may lie within one another, as in fibrad_spheres; 0:
     * alone; NULL on all ranks: no clumps. Members must have one emissivity and get one temperature: then the sum of
     * their powers is that of the clump. Not beside `conductivity` or fibrad_insitu_conduct. */
    const uint32_t *clump;
    /* [n], k* as in fibrad_exchange_rule, at the temperatures of this call; NULL: infinite, one temperature each */
    const double *conductivity;
} fibrad_insitu_bed;

/* Temperatures for which powers are computed. All ranks together must have the particles for which rows were
 * made. */
typedef struct fibrad_insitu_state {
    double sigma;                   /* of E = sigma T^4, at most FIBRAD_SIGMA_MAX; 0: FIBRAD_STEFAN_BOLTZMANN */
    double surroundings;            /* K, 0 to FIBRAD_TEMPERATURE_MAX */
    const double *wall_temperature; /* K, [walls of the rows], 0 to FIBRAD_TEMPERATURE_MAX */
    size_t n;                       /* number of particles that this rank owns now */
    const uint64_t *id;             /* [n] */
    const double *temperature;      /* K, [n], above 0 to FIBRAD_TEMPERATURE_MAX */
} fibrad_insitu_state;

/* Net powers summed over all ranks, the same on all ranks. A power is above 0 where heat is gained. All of them add up
 * to 0, to rounding. */
typedef struct fibrad_insitu_totals {
    double particles;              /* sigma K^4 L^2 */
    double surroundings;           /* sigma K^4 L^2 */
    double wall[FIBRAD_WALLS_MAX]; /* sigma K^4 L^2, [walls of the rows] */
} fibrad_insitu_totals;

/* What a particle emits beyond the cutoff may end on what emits most or least. If its power could change so by more
 * than this part of the root mean square of all powers, fibrad_insitu_remark tells of the particle. */
#define FIBRAD_BEYOND_MUCH 0.01

/* Facts of the last rows, of all ranks together except halo and bytes. */
typedef struct fibrad_insitu_facts {
    uint64_t particles, entries; /* numbers of particles that take part and of entries of rows */
    uint64_t outside;            /* number of particles that are left out */
    uint64_t overlapping;        /* number of particles that are smaller, since a centre lies inside another particle */
    uint64_t gone;               /* number of particles that have gone since all rows were made */
    uint64_t behind;             /* number of particles without a row, since they see a side that belongs to no wall */
    double cutoff;               /* L, in use; 0: none, each rank has all particles */
    double beyond;               /* mean fraction of the emission of particles that passes the cutoff; a particle that
                                    has no row counts as 1. The other targets share this fraction in proportion. */
    double error;                /* root mean square of the rows' estimated errors */
    double seconds_rows;         /* s, of the slowest rank, in all calls of fibrad_insitu_rows and _follow so far */
    double seconds_powers;       /* s, of the slowest rank, in all calls of fibrad_insitu_powers and _conduct so far */
    uint64_t step;               /* of the rows */
    size_t halo;                 /* particles of other ranks, and periodic images, that this rank was sent */
    size_t bytes;                /* bytes, memory of this rank */

    /* L^2, [walls], what a wall emits and others absorb, divided by its sigma T^4 */
    double wall[FIBRAD_WALLS_MAX];
} fibrad_insitu_facts;

/* Makes an object without rows. The communicator is duplicated.
 *   Input    config: NULL for all defaults
 *   Output   insitu: free with fibrad_insitu_free; NULL after an error
 *   Errors   _ARGUMENT, _MEMORY */
int fibrad_insitu_new(fibrad_insitu **insitu, MPI_Comm comm, const fibrad_insitu_config *config);

/* Makes all rows again.
 *   Input    bed: not needed after the call
 *            step: any number, seeds the random numbers
 *   Errors   _ARGUMENT: a value is out of its range, an id occurs twice, or the cutoff is less than the largest
 *            diameter or more than 100 periods
 *            _GEOMETRY: a centre lies inside an image of its own particle; radii seem to have another unit than
 *            positions, since the largest is more than a period, or particles have more than 64 centres of others
 *            inside, on the mean; a wall seems to be in a wrong place, since more than a tenth of all particles would
 *            be left out of the first rows
 *            _ENDLESS: walls, as for fibrad_scene_init
 *            _BACK: more than a tenth of all particles see a side of a triangle that belongs to no wall
 *            _MEMORY
 *            With config.strict also
 *            _ARGUMENT: a centre lies beyond a wall
 *            _GEOMETRY: a centre lies inside another particle, or a particle reaches beyond an opening
 *            _BACK: one particle sees a side of a triangle that belongs to no wall
 *   Cost     that of fibrad_exchange_row for each particle, and of the paths of sources: docs/lammps.md */
int fibrad_insitu_rows(fibrad_insitu *insitu, const fibrad_insitu_bed *bed, uint64_t step);

/* Makes rows of those particles alone that have come since the last rows, and keeps the other rows. The row of an
 * old particle has no factor to a new one: what the two exchange follows from the row of the new particle alone. If a
 * particle has gone, the factor of each old row to it counts as beyond. In three cases all rows are made: there are
 * none, the number of walls has changed, or more than a tenth of all particles have come or gone since all were made.
 *   Input    as fibrad_insitu_rows
 *   Errors   as fibrad_insitu_rows
 *   Cost     about 2 microseconds for each particle and 10 ns for each entry, and the new rows */
int fibrad_insitu_follow(fibrad_insitu *insitu, const fibrad_insitu_bed *bed, uint64_t step);

/* Net radiative power of each particle that this rank owns now. If particles conduct, `temperature` is the mean of each
 * particle.
 *   Output   power[state->n]: [sigma K^4 L^2], above 0 where heat is gained
 *            totals: may be NULL
 *   Errors   _ARGUMENT: a temperature or sigma is out of its range
 *            _STATE: there are no rows, or the particles of all ranks together are not those of the rows
 *            _MEMORY
 *            _UNSOLVABLE: rows of particles that conduct are too inaccurate for powers
 *   Cost     4 ns per entry, and some messages. If particles conduct, a linear system is solved, which takes 9 to 140
 *            times as long: docs/lammps.md */
int fibrad_insitu_powers(fibrad_insitu *insitu, const fibrad_insitu_state *state, double *power,
                         fibrad_insitu_totals *totals);

/* What is not known of each particle: the part of its row beyond the cutoff, and the error of its power.
 *   Output   error[n][2]: first the fraction of its emission that passed the cutoff when the row was made. Second the
 *            estimated error of its last power [sigma K^4 L^2], from the noise of its row and of rows that have it. n
 *            and the order are those of the state of the last call of fibrad_insitu_powers. The first is 1 for a
 *            particle that has no row. Both are 0 for a particle that is left out.
 *   Errors   _ARGUMENT
 *            _STATE: no powers were computed since rows were made
 *            _MEMORY
 *   Cost     two messages to each rank in contact */
int fibrad_insitu_errors(fibrad_insitu *insitu, double (*error)[2]);

/* Writes the rows of each rank to the file PATH.RANK.rows, for `fibrad join`.
 *   Input    path: PATH
 *   Errors   _ARGUMENT: the path is empty or too long
 *            _STATE: there are no rows, or particles have come or gone since all rows were made
 *            _FILE: a file cannot be written. The message names the file. No rank leaves a file behind. */
int fibrad_insitu_write(fibrad_insitu *insitu, const char *path);

/* What conducts heat where particles overlap each other or walls, by the rules of `fibrad heat --contacts`
 * (docs/heat.md). All but `conductivity` and `capacity` is the same on all ranks. */
typedef struct fibrad_insitu_contacts {
    const double *conductivity; /* power/(L K), [n] of the bed, of the solid at spots, above 0 */
    int hertz;                  /* 1: spots of elastic spheres; 0: the circles in which surfaces cut each other */
    double scale;               /* of the radii of spots; 0: 1 */
    double gas;                 /* power/(L K), conductivity of the gas in narrow gaps; 0: none */
    double gas_least;           /* L, least gap that counts; 0: 1e-7 of the smaller radius */
    double wall;                /* power/(L K), conductivity of walls at spots; 0: infinite */
    /* [gas_rows] K, ascending, and power/(L K): in place of `gas`, a table over the mean temperature of both ends */
    const double *gas_temperature, *gas_conductivity;
    uint32_t gas_rows;      /* 0: there is no table */
    const double *capacity; /* energy/K, heat capacities [n] of the bed, above 0 to INFINITY; NULL: one part */
    double seconds;         /* of the step of heat for which the powers are; unused without capacity */
} fibrad_insitu_contacts;

/* What all contacts conduct, the same on all ranks. Powers of particles and walls add up to 0, to rounding. */
typedef struct fibrad_insitu_conducted {
    double contacts;                      /* their number */
    double particles;                     /* net power */
    double wall[FIBRAD_WALLS_MAX];        /* net powers, [walls] */
    double conductance[FIBRAD_WALLS_MAX]; /* power/K, [walls], of all contacts of a wall */
    double parts;                         /* number of parts of the step of heat */
} fibrad_insitu_conducted;

/* Net power that particles gain through contacts at their present positions and temperatures, beside radiation.
 * Contacts are found anew in each call. Particles beyond walls or openings have no contacts, and openings have none. A
 * wall conducts whatever its emissivity. Steps of time are explicit: for particles, and for walls that store heat, 2
 * times the conductance times the step must be less than the heat capacity. Otherwise differences of temperatures may
 * change their sign in a step. With `capacity` a step in which twice this ratio is above 1 has up to 100 equal parts.
 * Contacts and temperatures of walls stay the same in all of them, and powers are means over the parts.
 *   Input    bed, state: the same particles in the same order. Emissivities must be valid.
 *   Output   power[n]: above 0 where heat is gained, the same bits for every number of ranks
 *            conductance[n]: power/K, of all contacts of a particle, divided by the number of parts
 *            conducted: may be NULL
 *   Errors   _ARGUMENT: as for fibrad_insitu_rows and fibrad_insitu_powers; a conductivity is not above 0
 *            _STATE: there are no rows
 *            _UNSUPPORTED: bed->conductivity is given
 *            _MEMORY
 *   Cost     1 microsecond for each particle; with gas 0.5 more for each pair within reach */
int fibrad_insitu_conduct(fibrad_insitu *insitu, const fibrad_insitu_contacts *contacts, const fibrad_insitu_bed *bed,
                          const fibrad_insitu_state *state, double *power, double *conductance,
                          fibrad_insitu_conducted *conducted);

/* The sentence of the last error. Not collective.
 *   Output   never NULL; "" if there was no error or insitu is NULL
 *   Errors   none */
const char *fibrad_insitu_message(const fibrad_insitu *insitu);

/* What fibrad_insitu_remark tells: what was done with strays, and what a cutoff could change in powers. */
typedef enum fibrad_remark_kind {
    FIBRAD_REMARK_OUTSIDE = 0, /* particles are left out */
    FIBRAD_REMARK_OVERLAP = 1, /* particles are smaller, since a centre lies inside another particle */
    FIBRAD_REMARK_BACK = 2,    /* particles have no row, since they see a side that belongs to no wall */
    FIBRAD_REMARK_BEYOND = 3,  /* some of the last powers could change by more than FIBRAD_BEYOND_MUCH */
    FIBRAD_REMARKS = 4
} fibrad_remark_kind;

/* A sentence on the particles of one kind in the last rows or powers: their number, and the id, place and wall of one.
 * Not collective, the same on all ranks.
 *   Input    kind: a fibrad_remark_kind
 *   Output   never NULL; "" if there are none
 *   Errors   none */
const char *fibrad_insitu_remark(const fibrad_insitu *insitu, int kind);

/* Reads the facts of the last rows. Not collective. NULL is ignored.
 *   Errors   none */
void fibrad_insitu_facts_get(const fibrad_insitu *insitu, fibrad_insitu_facts *facts);

/* Frees the object, its rows and its communicator. NULL is allowed.
 *   Errors   none */
void fibrad_insitu_free(fibrad_insitu *insitu);

#ifdef __cplusplus
}
#endif
#endif
