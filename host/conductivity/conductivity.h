/* conductivity.h - effective radiative conductivity of a bed of grey spheres. SPDX-License-Identifier: MIT
 *
 * The temperature is linear with gradient g, and each sphere has the temperature at its centre. Then the spheres of a
 * volume V carry along the gradient the flux k g = g/(2 V) sum over i, j of 4 sigma T^3 A_i e_i D_ij dz_ij^2.
 *
 * If spheres conduct, temperatures differ from point to point on each sphere, and the net power of each sphere is 0.
 * The flux is then that of walks, which go on at every sphere: k g = g/(2 V) 4 sigma T^3 A <z^2>. A is the area of all
 * spheres. <z^2> is the mean square displacement of a flight. */
#ifndef CONDUCTIVITY_H
#define CONDUCTIVITY_H

#include "bed/wall_option.h"
#include "simple/fibrad_host.h"

/* Along open axes only inner spheres emit. Their centres lie at least so many mean diameters inside the outermost
 * centres. _WALK: the same for spheres that conduct: walks get farther than the emission of one sphere. */
enum { CONDUCTION_MARGIN = 4, CONDUCTION_MARGIN_WALK = 8 };

/* The relative conductivities k* of the spheres of a bed, fibrad_relative_conductivity. Begin with zeroes. */
struct k_star {
    double sum, least, largest;
    uint32_t spheres; /* whose k* were added; 0: spheres do not conduct */
};

/* Adds k* of a sphere. A sphere without a temperature has NaN and is left out. */
void k_star_add(struct k_star *all, double relative);

/* The mean of all that were added. */
double k_star_mean(const struct k_star *all);

struct conduction_rule {
    const double *emissivity;   /* [n] of the spheres */
    const double *conductivity; /* [n] k* of the spheres; NULL: each sphere has one temperature */
    const struct walls *walls;  /* sides of the bed, which reflect everything diffusely; NULL: none */
    bool isothermal;            /* result->isothermal is wanted */
    int axis;                   /* the axis whose error counts; -1: all three */
    uint64_t seed;
    uint64_t paths; /* from each emitter; 0: as many as `error` needs */
    double error;   /* standard error allowed, over F_E */
    uint64_t
        max_rays; /* largest number of rays of a search for `error`; its first few paths are followed in any case */
};

/* A conductivity and its estimated error [W/(m K)]. */
struct conduction_value {
    double k, error;
};

/* Conductivities of a bed between plates. */
struct conduction_plates {
    struct conduction_value factor;                      /* F_E by radiation */
    struct conduction_value radiation, conduction, both; /* conduction: of the contacts without radiation */
    bool touches;                                        /* with contacts */
    uint32_t contacts;
    uint32_t spheres; /* in the inner half; 0: nothing was computed */
    double seconds;   /* time of computing [s] */
};

/* The emitters, and the results. */
struct conduction {
    double volume;         /* volume of the bed that belongs to the emitters [L^3] */
    double solid_fraction; /* of the core */
    double diameter;       /* mean of all spheres [L] */
    uint32_t emitters;
    uint64_t paths; /* from each emitter */
    uint64_t rays;
    uint32_t flights;                   /* of a path whose displacements are correlated; 0: spheres do not conduct */
    double factor[3], error[3];         /* F_E per axis and its standard error */
    struct conduction_plates plates[3]; /* set by the caller */
    int axis;                           /* the wanted axis; -1: all three */
    double temperature;                 /* [K]; NaN: k is not known */
    double k[3], k_error[3];            /* [W/(m K)] */
    struct k_star k_star;
    double isothermal; /* k_s at which F_E would be 95 % of this one, over T^3 [W/(m K4)]; NaN: not known */
    /* increase of F_E if flights may be e times as long, because of slabs without spheres */
    double growth[3];
    /* concentration of the variance in few groups of paths: sum of squares over squared sum, less the part of sizes */
    double concentration[3];
    double escaped; /* fraction of the emission that no sphere absorbs; of walks: of the paths that leave the bed */
    bool stopped;   /* max_rays has ended the search before the error was reached */
    double seconds; /* time of computing [s] */
};

/* Marks the spheres that emit, emits [n], for F_E along `axis`. axis -1: along all three axes. If one axis is wanted,
 * the bed may be too thin for the margin along another one; then all spheres along that other axis emit. Sets volume,
 * solid_fraction, diameter, emitters and growth. walls: sides, up to which all spheres emit; NULL: none. margin:
 * CONDUCTION_MARGIN or CONDUCTION_MARGIN_WALK. file: name of the bed in messages. Status 0, STATUS_INPUT if the bed is
 * too thin or has too few emitters, or STATUS_MEMORY. */
int conduction_emitters(const struct bed *bed, const struct walls *walls, int axis, double margin, const char *file,
                        unsigned char *emits, struct conduction *result);

/* Whether conductivities with contacts are known along some axis. */
static inline bool conduction_contacts(const struct conduction *result) {
    return result->plates[0].touches || result->plates[1].touches || result->plates[2].touches;
}

/* The width of the bed along an axis: its period, the distance of two walls, or the width of a square as large as a
 * cylinder. NaN: the bed is open along the axis. */
double conduction_width(const struct bed *bed, const struct walls *walls, int axis);

/* Follows the paths of the emitters and sets the other results. Returns a status of the library. */
int conduction_follow(const struct bed *bed, const unsigned char *emits, const struct conduction_rule *rule,
                      fibrad_run *run, struct conduction *result);

/* The emissivity at which a sphere with one temperature reflects patterns of degree 1 as a sphere of relative
 * conductivity k* does: 1/(1/e + 1/(2 k*)). */
double conduction_effective(double emissivity, double relative);

/* How far long flights along an axis, and those that leave the bed, impair F_E and its standard error. */
enum conduction_flights {
    FLIGHTS_SETTLED = 1, /* not at all */
    FLIGHTS_ENDLESS = 2, /* there are slabs without spheres, so F_E does not exist; `factor` is for 100 periods */
    FLIGHTS_RARE = 4,    /* the variance rests on a few flights, as along channels: the error is unreliable */
    FLIGHTS_LEAVING = 8  /* too many leave the bed: F_E is too low, by more than the error says */
};
enum conduction_flights conduction_flights(const struct conduction *result, int axis);

/* Says why F_E along an axis is not reliable, as "what: why". NULL: it is. */
const char *conduction_doubt(const struct conduction *result, int axis);

/* Whether an axis is wanted. */
bool conduction_wants(const struct conduction *result, int axis);

/* The largest standard error over F_E of the axes that count. Axes with endless flights are left out. */
double conduction_worst(const struct conduction_rule *rule, const struct conduction *result);

/* Sets temperature and k at a temperature [K]. */
void conduction_at(struct conduction *result, const struct bed *bed, double temperature);

#endif
