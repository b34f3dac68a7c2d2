/* partner.h - another solver beside a bed, and what it and the bed tell each other. SPDX-License-Identifier: MIT
 *
 * Time goes in windows. For each window the partner gives temperatures of faces or films of faces, and gas at
 * particles. The bed goes through the window, and gives back what faces and gas have gained. The partner may ask for
 * the same window again. */
#ifndef PARTNER_H
#define PARTNER_H

#include <stdbool.h>
#include <stdint.h>

#include "heat/heat.h"

/* What is exchanged at the faces, which are the triangles of walls that are meshes, in the order of all meshes. Arrays
 * of the partner begin as NaN: not given. It gives a face a temperature, or a film and the temperature behind it. */
struct exchange_faces {
    uint32_t n;
    uint32_t *triangle;            /* [n] among those of all meshes */
    uint32_t first[WALLS_MAX + 1]; /* faces of wall k: first[k] to first[k + 1] - 1; none if the wall is no mesh */
    double (*centre)[3];           /* [n] [m] */
    double *area;                  /* [n] [m2] */
    /* by the partner, at the end of the window */
    double *temperature;   /* [n] [K] */
    double *film, *behind; /* [n] [W/(m2 K)] from the face to what is behind it, whose temperature is [K] */
    /* by the bed */
    double *energy; /* [n] [J] gained during the window */
    double *found;  /* [n] [K] temperature at the end of the window */
};

/* What is exchanged at the centres of the spheres. */
struct exchange_particles {
    uint32_t n;
    double (*centre)[3]; /* [n] [m] */
    /* by the partner, at the end of the window */
    double *gas, *film; /* [n] [K], [W/(m2 K)]; NaN: not given */
    /* by the bed */
    double *conductance; /* [n] [W/K] of the film: the gas gains less by this, on the mean, if it is 1 K hotter */
    double *energy;      /* [n] [J] that the gas has gained during the window */
    double *found;       /* [n] [K] temperature at the end of the window */
};

struct exchange {
    /* options */
    const char *file, *participant; /* of preCICE; NULL: not given */
    const char *folder;             /* of OpenFOAM; NULL: not given */
    double window;          /* [s] from one exchange to the next, of partners that do not say it; 0: not given */
    double timeout;         /* [s] longest time to wait for the partner */
    const char *wall_names; /* of walls whose faces are exchanged, with commas; NULL: not given */
    /* of the run */
    const char *name;           /* of the partner: preCICE, OpenFOAM */
    bool gives_gas, gives_film; /* at particles */
    const struct walls *walls;
    bool exchanged[WALLS_MAX]; /* the partner has the faces of this wall */
    struct exchange_faces faces;
    struct exchange_particles particles;
    double length; /* [s] of the window; 0: the partner has ended */
    bool implicit; /* windows may be asked for again */
    void *state;   /* of the partner */
};

/* A kind of partner. Functions return a status, and print why they fail. */
struct partner {
    /* Reads what the partner has, when all options have been read: sets name, gives_gas, gives_film. */
    int (*plan)(struct exchange *exchange);
    /* Chooses the walls of exchange->walls that are exchanged. NULL: those of wall_names, or all that are meshes. */
    int (*choose)(struct exchange *exchange);
    /* Connects to the partner. Faces and particles have their places; `found` has the temperatures at the beginning. */
    int (*begin)(struct exchange *exchange);
    /* Waits for the partner. Sets the length of the next window and what the partner gives at its end. */
    int (*next)(struct exchange *exchange);
    /* Gives the partner what the bed has found. *again: the partner asks for the same window again. */
    int (*give)(struct exchange *exchange, bool *again);
    /* Ends, also after an error of any function before. Frees the state. status: that of the run so far. Returns the
     * status. */
    int (*end)(struct exchange *exchange, int status);
};

extern const struct partner partner_precice, partner_openfoam;

/* couple.c: runs the bed of heat_begin window by window, until the partner ends. Outputs are written every `every`
 * seconds, 0: at the end alone. *ended: what the partner has ended with; it may have failed after windows whose outputs
 * stay. Status as time_begin. */
int couple_run(struct heat *heat, const struct partner *partner, struct exchange *exchange, double every, int *ended);

#endif
