/* insitu.h - the fields of fibrad_insitu. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_COUPLE_INSITU_H
#define FIBRAD_COUPLE_INSITU_H

#include <math.h>

#include "couple/ranks/ranks.h"
#include "couple/fibrad_couple.h"
#include "simple/team.h"

#define FIBRAD_OPENINGS_MAX 6   /* one a side */
#define FIBRAD_GATHER_MOST  4e6 /* particles up to which each rank has all while rows are made */

/* What walls exchange with each other and with the surroundings: areas times emissivities times factors [L^2]. */
typedef struct fibrad_wall_exchange {
    double wall[FIBRAD_WALLS_MAX][FIBRAD_WALLS_MAX]; /* of two walls; 0 for a wall and itself */
    double surroundings[FIBRAD_WALLS_MAX];
} fibrad_wall_exchange;

/* The rows of one step. The home of a particle is the rank that owned it when its row was made. The row stays there.
 * The columns of the rows on a rank are numbered 0 to columns - 1: first the particles of which the rank is the home,
 * then the others that its rows see. Each periodic image has a column of its own. */
typedef struct fibrad_insitu_set {
    fibrad_rows *rows;     /* [threads], of particles 0 to own - 1 */
    size_t own, columns;   /* numbers of rows and of columns */
    fibrad_block particle; /* fibrad_particle [own + halo], when the rows were made, moved into the box */
    fibrad_block id;       /* uint64_t [columns] */
    fibrad_block weight;   /* L^2, double [columns], area times emissivity of the node */
    fibrad_block unknown;  /* double [own], what of each row was beyond when it was made */
    fibrad_block made;     /* double [columns], makings when the row of each was made, as in fibrad_flow */
    fibrad_block root;     /* 1/L, double [own], square root of (1/n - 1/e)/A, see powers.c; unused unless conducts */
    fibrad_block emission; /* double [columns], sigma T^4 */
    fibrad_block power;    /* double [columns], net power by the rows on this rank */
    uint32_t walls;        /* number of walls */
    int conducts;          /* 1: some particles have a finite k* */
    int emissive;          /* 1: exchange factors; 0: all emissivities are 1 */
    fibrad_link *seen;     /* connects home particles with columns */
    fibrad_link *present;  /* connects particles of present owners with home particles */
    fibrad_block now;      /* uint64_t [now_n + own], ids of the present owner, then those at home */
    size_t now_n;          /* number of particles of the present owner */
    uint64_t all;          /* number of particles of all ranks, with those left out */
    uint64_t hash;         /* sum of the hashes of their ids */
    uint64_t changed;      /* number of particles that have come or gone since all rows were made */
    fibrad_wall_exchange wall_exchange;
    double wall_emission[FIBRAD_WALLS_MAX], surroundings_emission; /* sigma T^4 of the last powers */
    int flows;                                                     /* 1: there were powers since rows were made */
    int escapes;                                                   /* 1: some particles see the surroundings */
    fibrad_insitu_facts facts;
    fibrad_remark remark[FIBRAD_REMARKS];
} fibrad_insitu_set;

struct fibrad_insitu {
    MPI_Comm comm;
    int rank, ranks;
    fibrad_insitu_config config;
    uint32_t paths_alone; /* paths of a row that does not know all sources */
    double open_error;    /* as in fibrad_exchange_rule */
    double source_paths;  /* paths of all sources over those of all particles, at most */
    double gather;        /* FIBRAD_GATHER_MOST; tests take less */
    char message[FIBRAD_MESSAGE];
    fibrad_team team;       /* the threads, and their work memory */
    fibrad_insitu_set set;  /* the rows in use */
    fibrad_insitu_set next; /* rows that are being made, in the memory of older rows */
    int ready;              /* 1: there are rows */
    uint64_t makings;       /* number of times that rows were made */
    fibrad_block scene, order, emissivity, clump, mark, sent; /* scratch while rows are made */
    fibrad_block known;  /* double [own][walls + 1], the same: as fibrad_exchange_rule.known of own particles */
    fibrad_block solver; /* double [4 own], where particles conduct: see powers.c */
    fibrad_block value;  /* double, of present owners' particles, then of home particles */
    double seconds_rows, seconds_powers; /* s, so far */
};

/* A row's area times emissivity, scaled so that the known factors add up to 1; 0 if nothing is known. weight: of its
 * particle. */
static inline double fibrad_row_weight(const fibrad_row *row, double weight) {
    return row->beyond < 1 ? weight / (1 - row->beyond) : 0;
}

/* A particle's area times the emissivity of its node. */
static inline double fibrad_particle_weight(const fibrad_particle *p) {
    return 4 * acos(-1) * p->radius * p->radius * p->node;
}

/* Rows that are made only for particles that have come. Begin with zeroes; free with fibrad_follow_free. */
typedef struct fibrad_follow {
    unsigned char *there;   /* [columns of the old set] whether the particle is still there */
    unsigned char *has;     /* [particles of the new scene] whether it has a row already */
    uint64_t came, gone;    /* numbers of particles, on all ranks */
    size_t kept, kept_seen; /* numbers of old particles at home here, and of other old columns, that are still there */
} fibrad_follow;

/* The making of rows. */
typedef struct fibrad_insitu_build {
    fibrad_insitu *s;
    fibrad_insitu_set *to;
    const fibrad_insitu_bed *bed;
    uint64_t step;
    double period[3], cutoff, radius_max, radius_mean, reach;
    size_t own, halo; /* particles of the scene: of this rank, and others behind them */
    bool repeats;     /* some axis is periodic */
    bool whole;       /* the others are all particles of other ranks, and there is no cutoff */
    size_t lower;     /* if so: number of particles of lower ranks */
    size_t fresh;     /* the first of them get rows */
    bool follows;     /* old rows are kept */
    fibrad_follow follow;
    double ends[2][3]; /* L, low and high ends of all particles */
    fibrad_plane opening[FIBRAD_OPENINGS_MAX];
    uint32_t openings; /* of the next scene */
    bool knows;        /* rows know what paths from sources have found */
    bool knows_all;    /* all walls that emit are sources, and surroundings are, if there are any */
    double density;    /* 1/L^2, paths from sources for each area times emissivity */
    fibrad_occupancy map;
    fibrad_scene *scene;
    fibrad_remark remark[FIBRAD_REMARKS];
} fibrad_insitu_build;

/* Checks what is given with powers. Not collective. Errors: _ARGUMENT, _STATE. */
int fibrad_insitu_check_state(fibrad_insitu *insitu, const fibrad_insitu_state *state, const double *power);

/* Collective. Sets area[n] of the particles of the last powers that are in clumps to what is exposed of them; 0: they
 * are left out. Errors, on all ranks: _MEMORY. */
int fibrad_insitu_exposed(fibrad_insitu *insitu, const uint32_t *clump, double *area);

/* Collective. Puts together the members of clumps. value[n][width]: in, of each particle; out, the first of them that
 * of the member of the least id, the others the sums over the members, in the order of their ids. So bits do not depend
 * on ranks. Particles of clump 0 keep their values. width: 2 to FIBRAD_CLUMP_WIDTH. Errors, on all ranks: _MEMORY. */
#define FIBRAD_CLUMP_WIDTH 4
int fibrad_clump_sums(MPI_Comm comm, const uint32_t *clump, const uint64_t *id, size_t n, double *value, int width);

/* Collective. Finds what the unknown parts of rows could change in the powers that were found last, and remarks it.
 * unit: the root mean square of these powers */
void fibrad_unknown_tell(fibrad_insitu *insitu, double unit);

/* Collective. Checks the bed, and takes its particles. Errors, on all ranks: as fibrad_insitu_rows. */
int fibrad_insitu_check(fibrad_insitu_build *b);

/* Collective. Finds extents, radii and the cutoff. They must be the same to the bit whoever owns which particle.
 * Errors, on all ranks: as fibrad_insitu_rows. */
int fibrad_insitu_measure(fibrad_insitu_build *b);

/* Collective. Gathers the particles of the scene, if rows are needed, and puts those first that get rows. Makes
 * particles smaller whose centre lies inside another. Errors, on all ranks: as fibrad_insitu_rows. */
int fibrad_insitu_gather(fibrad_insitu_build *b);

/* Says why the spheres of n particles make no scene. Returns status, or FIBRAD_E_ARGUMENT. */
int fibrad_insitu_fault(const fibrad_insitu_build *b, int status, const uint64_t *id, size_t n, fibrad_fault fault);

/* Bytes that clumps add to the scene of n particles. */
static inline size_t fibrad_insitu_clumps(const fibrad_insitu_build *b, size_t n) {
    return b->bed->clump ? fibrad_clumps_size((uint32_t)n) : 0;
}

/* Makes the scene of n particles in b->scene, with the periods of the box. With ids of a bed that is not whole, images
 * are particles of their own, and the coarse map tells where there are others. id[n]: out, may be NULL. Errors: as
 * fibrad_scene_init; _MEMORY. */
int fibrad_insitu_scene(fibrad_insitu_build *b, const fibrad_particle *p, size_t n, uint64_t *id);

/* The rule of rows of the scene of n particles that was made last. It has no cutoff. */
fibrad_exchange_rule fibrad_insitu_rule(const fibrad_insitu_build *b, size_t n);

/* Collective. Makes the rows of the gathered particles and their links. Replaces the scene. Errors, on all ranks: as
 * fibrad_insitu_rows. */
int fibrad_insitu_make(fibrad_insitu_build *b);

/* Collective. Follows paths from walls and surroundings. Finds what these exchange with each other, and what particles
 * exchange with them after a reflection. Replaces the scene. Errors, on all ranks: as fibrad_scene_init and
 * fibrad_exchange_wall; _MEMORY. */
int fibrad_insitu_sources(fibrad_insitu_build *b);

/* Collective. As fibrad_link_new. once: it is known that no id is owned twice, or used twice. An id that its owner uses
 * then takes no message. */
int fibrad_link_find(fibrad_link **link, MPI_Comm comm, const uint64_t *id, size_t own, size_t all, bool once,
                     uint64_t *culprit);

/* Collective. As fibrad_link_new, for values of which the owners are known: place[used]. Errors, on all ranks: _MEMORY.
 */
int fibrad_link_to(fibrad_link **link, MPI_Comm comm, size_t own, const fibrad_place *place, size_t used);

/* Collective. Tells for ids in use whether a rank owns them: known[all - own]. id as for fibrad_link_new. Errors, on
 * all ranks: _MEMORY. */
int fibrad_link_known(MPI_Comm comm, const uint64_t *id, size_t own, size_t all, unsigned char *known);

/* Collective. Finds how many particles have come and gone. All rows are made if they are too many, none if none have
 * come. Errors, on all ranks: _MEMORY. */
int fibrad_follow_changes(fibrad_insitu_build *b);

/* Collective. Puts the particles that need rows first. Errors, on all ranks: _MEMORY. */
int fibrad_follow_choose(fibrad_insitu_build *b);

/* Puts the old rows of particles that are still there behind the new rows, of `fresh` particles, with the columns
 * [fresh][kept][kept seen]. What gone particles would get counts as beyond. Errors: _MEMORY. */
int fibrad_follow_keep(const fibrad_follow *follow, const fibrad_insitu *insitu, fibrad_insitu_set *to, size_t fresh);

void fibrad_follow_free(fibrad_follow *follow);

#endif
