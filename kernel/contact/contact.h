/* contact.h - heat conducted between nodes, each with one temperature. SPDX-License-Identifier: MIT
 *
 * A node is a sphere or a wall. Emissions E are relative: E = sigma (T^4 - zero^4). A node that is free emits, and
 * stores in a step in time, `stiff` times E. It has a supply, the power that it gains at E = 0. Its temperature follows
 * from
 *
 *     supply - stiff E(T) + sum over its contacts of H (T_other - T) = 0.
 *
 * Conduction is linear in T, radiation in E. With given supplies all temperatures follow from a Newton solution in T,
 * whose matrix is symmetric and positive. For radiosities a contact is an exchange area between emissions,
 *
 *     g = H/(sigma (T_i^2 + T_j^2) (T_i + T_j)).
 *
 * A film is a contact with gas of a given temperature, or with a slice of a stream. The stream carries heat one way, so
 * with unknown gas the matrix is not symmetric. Temperatures below zero are allowed on the way: there E = -sigma
 * (T^4 + zero^4). Source: docs/methods.md section 28. */
#ifndef FIBRAD_CONTACT_H
#define FIBRAD_CONTACT_H

#include "fibrad_heat.h"

#include <stdbool.h>

typedef enum fibrad_contact_kind {
    FIBRAD_CONTACT_NONE,   /* the node has no contacts and no film */
    FIBRAD_CONTACT_GIVEN,  /* its temperature is given, or nothing is known of it yet */
    FIBRAD_CONTACT_FREE,   /* its temperature is to be found */
    FIBRAD_CONTACT_FOLLOWS /* it is no node of its own, and has the temperature of a node that is free */
} fibrad_contact_kind;

typedef struct fibrad_contacts {
    uint32_t nodes, count;               /* numbers of nodes and contacts */
    const uint32_t *first, *second;      /* [count], the caller's numbers of the two ends */
    const double *conductance;           /* sigma K^3 L^2, [count], the caller's */
    double *film, *gas;                  /* sigma K^3 L^2 and K, [nodes], of films; 0: the node has none */
    bool joins;                          /* there are contacts or films */
    uint32_t *node;                      /* node by the caller's number */
    unsigned char *kind;                 /* [nodes], a fibrad_contact_kind */
    double sigma, zero;                  /* zero: the temperature at which E is 0 */
    double *temperature;                 /* K, [nodes] */
    double *stiff, *supply;              /* [nodes] */
    double *missing;                     /* [nodes], what is missing in balances */
    double *load, *warming;              /* [nodes], a system that is linear in E, and its solution */
    double *direction;                   /* [nodes], search direction of E */
    double *gain;                        /* sigma K^4 L^2, [nodes], what a node gains through contacts at the end */
    double *error;                       /* K, [nodes], of temperatures at the end; 0 if given */
    double *diagonal, *search, *product; /* [nodes], used within one call */
    double *shadow, *sent;               /* [nodes], the same, with a stream */
    const fibrad_stream *stream;         /* NULL: none */
    uint32_t *slice;                     /* [nodes], of the film; UINT32_MAX: its gas is given */
    const uint32_t *leader;              /* [nodes with slices], the node of a member of a clump; NULL: no clumps */
    double *own_film, *own_gas;          /* film, gas; with clumps those of members */
    bool streaming;                      /* gas of the stream follows temperatures within fibrad_contact_find */
    double least;                        /* K, slopes are those at temperatures of at least this */
    bool anchored;                       /* a given temperature holds, by contacts, what radiates */
    bool afresh;                         /* no earlier solution tells where temperatures are */
    double more;                         /* sigma K^4, arrives at the end besides supplies, per emissivity times area */
} fibrad_contacts;

/* What belongs together, while sources are checked. A component is a set of nodes that exchange heat. Node `nodes`
 * stands for all that radiate. */
typedef struct fibrad_contact_parts {
    uint32_t *root; /* [nodes + 1], a node of the same component; its own number: it stands for the component */
    unsigned char *anchored; /* [nodes + 1], of nodes that stand for components: some temperature is given */
} fibrad_contact_parts;

/* The emission at a temperature, and the temperature of an emission. */
double fibrad_contact_emission(const fibrad_contacts *contacts, double temperature);
double fibrad_contact_temperature(const fibrad_contacts *contacts, double emission);

/* Marks the nodes that have contacts as GIVEN, all others as NONE. Films are not looked at. */
void fibrad_contact_mark(fibrad_contacts *contacts);

/* Joins the components of two nodes. Begin with root[k] = k. */
void fibrad_contact_join(fibrad_contact_parts *parts, uint32_t a, uint32_t b);

/* The node that stands for the component of a node. */
uint32_t fibrad_contact_root(fibrad_contact_parts *parts, uint32_t node);

/* Adds to `to` what nodes gain through contacts and films at temperatures T. */
void fibrad_contact_gains(const fibrad_contacts *contacts, const double *temperature, double *to);

/* The sum over contacts and films of g times the product of the differences of a and b. On nodes that are not free
 * these count 0. */
double fibrad_contact_product(const fibrad_contacts *contacts, const double *a, const double *b);

/* Finds contacts->warming, the change of E of free nodes that takes away contacts->load: (stiff + G) warming = load. */
void fibrad_contact_warm(fibrad_contacts *contacts);

/* Finds contacts->temperature of free nodes from contacts->supply. It goes on until no temperature changes by more than
 * `tolerance` times the highest one. On entry `temperature` has given temperatures and a first guess of the others. */
void fibrad_contact_find(fibrad_contacts *contacts, double tolerance);

/* ---- stream.c ---------------------------------------------------------------------------------------------------- */

/* Finds the temperatures of the gas that flows past nodes at contacts->temperature. */
void fibrad_stream_find(fibrad_contacts *contacts);

/* Takes off `product` what films gain if the temperatures of nodes change by x and the gas follows. x is 0 on nodes of
 * given temperature. */
void fibrad_stream_respond(const fibrad_contacts *contacts, const double *x, double *product);

#endif
