/* conduction.h - effective radiative conductivity of a bed of grey spheres. SPDX-License-Identifier: MIT
 *
 * In a linear field of temperature with gradient g the spheres of a volume V, each at the temperature of its centre,
 * carry the flux g/(2 V) sum over i, j of 4 sigma T^3 A_i e_i D_ij dz_ij^2 along the gradient, which is k g. */
#ifndef CONDUCTION_H
#define CONDUCTION_H

#include <stdbool.h>

#include "bed/bed.h"
#include "simple/fibrad_host.h"

/* On open axes only spheres emit whose centres are so many mean diameters inside all. */
#define CONDUCTION_MARGIN 4.0

struct conduction_rule {
    const double *emissivity; /* [n] of the spheres */
    int axis;                 /* the only one whose error counts; -1: all three count */
    uint64_t seed;
    uint64_t paths;    /* from each emitter; 0: as many as `error` takes */
    double error;      /* wanted, standard errors over F_E */
    uint64_t max_rays; /* in a search for `error`, which begins with a few paths from each emitter whatever they take */
};

/* The part of the bed that emits, and what comes of it. */
struct conduction {
    double volume, solid_fraction, diameter; /* [L^3] that belongs to the emitters; [L] mean of all spheres */
    uint32_t emitters;
    uint64_t paths; /* from each emitter */
    uint64_t rays;
    double factor[3], error[3];        /* F_E per axis and its standard error */
    double steady[3], steady_error[3]; /* F_E between plates, if the caller knows it; NaN */
    int axis;                          /* the only one wanted; -1: all three */
    double temperature;                /* [K]; NaN: k is not known */
    double k[3], k_error[3];           /* [W/(m K)] */
    double growth[3]; /* of F_E for each factor e in the length of flights allowed, through slabs without spheres */
    double concentration[3]; /* of the variance in few groups of paths, sum of squares over squared sum, beyond what
                                sizes make */
    double escaped;          /* fraction of the emission that no sphere absorbs */
    bool stopped;            /* by max_rays, before the error was reached */
    double seconds;
};

/* Marks the spheres that emit [n], for F_E along `axis`, or all three (-1); across one axis alone a bed may be thin,
 * and then all of it emits. Sets volume, solid_fraction, diameter, emitters and growth. `file` is the bed's name in
 * messages. Status 0; STATUS_INPUT if an open axis is too short; STATUS_MEMORY. */
int conduction_emitters(const struct bed *bed, int axis, const char *file, unsigned char *emits,
                        struct conduction *result);

/* Follows their paths; sets the rest. Status of the library. */
int conduction_follow(const struct bed *bed, const unsigned char *emits, const struct conduction_rule *rule,
                      fibrad_run *run, struct conduction *result);

/* What flights along an axis leave of F_E there and its standard error. */
enum conduction_flights {
    FLIGHTS_SETTLED = 1,
    FLIGHTS_ENDLESS = 2, /* a slab without spheres: no mean square, and so no F_E; it is of flights of 100 periods */
    FLIGHTS_RARE = 4     /* the variance rests on a few flights, as along channels: the error cannot be relied on */
};
enum conduction_flights conduction_flights(const struct conduction *result, int axis);

/* Is the axis one of those wanted? */
bool conduction_wants(const struct conduction *result, int axis);

/* The largest standard error over F_E of the axes that count and have one. */
double conduction_worst(const struct conduction_rule *rule, const struct conduction *result);

/* Sets temperature and k at a temperature [K], the bed's unit of length being so many metres. */
void conduction_at(struct conduction *result, double temperature, double metre);

#endif
