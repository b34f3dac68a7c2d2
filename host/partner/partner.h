/* partner.h - the partner of a bed, another solver, and what the two exchange. SPDX-License-Identifier: MIT
 *
 * The run goes from time window to time window. For each one the partner gives temperatures or films of faces, and
 * temperatures of the gas at particles. The bed goes through the time window, and gives back what faces and gas have
 * gained. The partner may ask for the same time window again. A film is a heat transfer coefficient. */
#ifndef PARTNER_H
#define PARTNER_H

#include "heat/heat.h"

#define NOT_EXCHANGED UINT32_MAX

/* What is exchanged at faces. A face is a triangle of a wall that the partner has. Faces are in the order of walls, and
 * those of a wall in the order of triangles. The partner gives a face a temperature, or a film and the temperature
 * behind the film. Arrays of the partner begin as NaN: not given. */
struct exchange_faces {
    uint32_t n;
    uint32_t *triangle;            /* [n] number of the triangle in all meshes together */
    uint32_t *of_triangle;         /* [triangles] the face of each triangle, or NOT_EXCHANGED */
    uint32_t first[WALLS_MAX + 1]; /* faces of wall k: first[k] to first[k + 1] - 1; none if the wall is no mesh */
    double (*centre)[3];           /* [n] [m] */
    double *area;                  /* [n] [m2] */
    /* from the partner, at the end of the time window */
    double *temperature;   /* [n] [K] */
    double *film, *behind; /* [n] [W/(m2 K)] of the film; [K] of what is behind it */
    /* from the bed */
    double *energy; /* [n] [J] gained during the time window */
    double *found;  /* [n] [K] temperature at the end of the time window */
};

/* What is exchanged at the centres of the spheres. */
struct exchange_particles {
    uint32_t n;
    double (*centre)[3]; /* [n] [m] */
    /* from the partner, at the end of the time window */
    double *gas, *film; /* [n] [K], [W/(m2 K)]; NaN: not given */
    /* from the bed */
    double *conductance; /* [n] [W/K] by this the mean power to the gas falls if the gas is 1 K hotter at the end */
    double *energy;      /* [n] [J] gained by the gas during the time window */
    double *found;       /* [n] [K] temperature of the sphere at the end of the time window */
};

struct exchange {
    /* options */
    const char *file, *participant; /* of preCICE; NULL: not given */
    const char *folder;             /* of OpenFOAM; NULL: not given */
    double window;                  /* [s] length of a time window, if the partner does not say it; 0: not given */
    double timeout;                 /* [s] longest time to wait for the partner */
    const char *wall_names;         /* walls whose faces are exchanged, separated by commas; NULL: not given */
    /* of the run */
    const char *name;           /* of the partner: preCICE, OpenFOAM */
    bool gives_gas, gives_film; /* whether the partner gives these at particles */
    bool takes_power;           /* whether the partner takes what the gas gains there */
    const struct walls *walls;
    bool exchanged[WALLS_MAX]; /* the partner has the faces of this wall */
    struct exchange_faces faces;
    struct exchange_particles particles;
    double length; /* [s] of the time window; 0: the partner has ended */
    void *state;   /* of the partner */
};

/* A kind of partner. Functions return a status, and print why they fail. */
struct partner {
    /* Called when all options have been read. Sets name, gives_gas, gives_film and takes_power. */
    int (*plan)(struct exchange *exchange);
    /* Sets `exchanged`. NULL: the walls of wall_names are exchanged, or else all walls that are meshes. */
    int (*choose)(struct exchange *exchange);
    /* Connects to the partner. Centres are set, and `found` has the temperatures at the beginning. */
    int (*begin)(struct exchange *exchange);
    /* Waits for the partner. Sets the length of the next time window, and the values from the partner. */
    int (*next)(struct exchange *exchange);
    /* Gives the partner what the bed has found. *again: it asks for the same time window again. */
    int (*give)(struct exchange *exchange, bool *again);
    /* Ends and frees the state, also after an error of any other function. status: that of the run so far. Returns it,
     * or the status of an error at the end. */
    int (*end)(struct exchange *exchange, int status);
};

extern const struct partner partner_precice, partner_openfoam;

/* couple.c: runs the bed of heat_begin from time window to time window, until the partner ends. Writes outputs about
 * every `every` seconds, at ends of time windows; 0: at the end alone. *ended: the status with which the partner has
 * ended. If the partner has failed, outputs of the time windows before stay. Status as time_begin. */
int couple_run(struct heat *heat, const struct partner *partner, struct exchange *exchange, double every, int *ended);

#endif
