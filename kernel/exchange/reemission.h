/* reemission.h - where a ball that conducts gives off what it absorbs at a point. SPDX-License-Identifier: MIT
 *
 * The ball is steady inside, and its net power is 0. Let e be its emissivity, k* its relative conductivity and
 * a = e/(2 k*). Of what the ball absorbs in a pattern of degree l (spherical harmonics) it gives off a/(a + l) in the
 * same pattern: docs/methods.md section 26. So what is absorbed at one point is given off at the angle g from that
 * point with the density
 *
 *     K(g) = integral over t from 0 to 1 of a t^(a-1) P_t(g),   P_t(g) = (1 - t^2)/(4 pi (1 + t^2 - 2 t cos g)^(3/2)).
 *
 * Let U be an even random number in [0, 1]. Then t = U^(1/a) has the density a t^(a-1). P_t is Poisson's kernel, whose
 * integral has an inverse in closed form.
 *
 * P_t is least opposite the point: 4 pi P_t >= (1 - t)/(1 + t)^2. Let m be the mean of this least value over t. Then
 * K = m/(4 pi) + (1 - m) K'. In K' the density of t is in proportion to t^a (3 + t)/(1 + t)^2. Let the point of
 * absorption be (0, 0, 1), and let (1 + t) s be the distance between (0, 0, t) and the point where heat is given off.
 * An even random number U gives s:
 *
 *     (1 - s)^2 (2 + s)/s = 4 t^2 (3 + t) U/((1 + t)^2 (1 - t)). */
#ifndef FIBRAD_EXCHANGE_REEMISSION_H
#define FIBRAD_EXCHANGE_REEMISSION_H

#include "base/elementary.h"
#include "base/random.h"

/* Below the first value of t all points are equally likely. Above the second the heat stays where it was absorbed. */
#define FIBRAD_REEMITTED_ANYWHERE 1e-9
#define FIBRAD_REEMITTED_NOWHERE  (1 - 1e-12)

/* Random numbers that fibrad_reemit_above may use. They do not suffice once in 10^11 times. */
#define FIBRAD_REEMITTED_DRAWS 127

/* Turns the unit vector n by the angle whose cosine is 1 - x, in the plane of n and of `even`, a random unit vector. */
static inline void fibrad_turn_by(double x, const double even[3], double n[3]) {
    const double along = even[0] * n[0] + even[1] * n[1] + even[2] * n[2];
    const double across[3] = {even[0] - along * n[0], even[1] - along * n[1], even[2] - along * n[2]};
    const double square = across[0] * across[0] + across[1] * across[1] + across[2] * across[2];
    if (square < 1e-24) return;
    const double sine = fibrad_sqrt(fibrad_max(0, x * (2 - x)) / square);
    for (int axis = 0; axis < 3; axis++) n[axis] = (1 - x) * n[axis] + sine * across[axis];
}

/* Turns n, in the plane of n and `even`, to a point of the unit sphere at a given distance from t n. */
static inline void fibrad_turn_to(double distance, double t, const double even[3], double n[3]) {
    const double x = (distance - (1 - t)) * (distance + (1 - t)) / (2 * t);
    fibrad_turn_by(fibrad_min(fibrad_max(x, 0), 2), even, n);
}

/* Moves n from the outward normal where a ball absorbs to the normal where the ball gives the absorbed heat off.
 * exponent: 1/a. If it is infinite, all points are equally likely. u: two even random numbers in [0, 1). even: a random
 * point of the unit sphere. */
static inline void fibrad_reemit(double exponent, const double u[2], const double even[3], double n[3]) {
    const double t = u[0] > 0 ? fibrad_exp(fibrad_max(-800, exponent * fibrad_log(1 - u[0]))) : 1;
    if (t > FIBRAD_REEMITTED_NOWHERE) return;
    if (t < FIBRAD_REEMITTED_ANYWHERE) {
        for (int axis = 0; axis < 3; axis++) n[axis] = even[axis];
        return;
    }
    const double rho = 1 / (1 + t) + 2 * t * u[1] / ((1 - t) * (1 + t));
    fibrad_turn_to(1 / rho, t, even, n);
}

/* Draws t by the density that it has in K'. At least a third of all trials succeed. */
static inline double fibrad_reemitted_depth(double a, fibrad_random random, uint64_t first) {
    double t = 1;
    for (uint64_t k = first; k < first + FIBRAD_REEMITTED_DRAWS - 1; k += 2) {
        const double u = 1 - fibrad_fraction(fibrad_random_ahead(random, k));
        t = fibrad_exp(fibrad_max(-800, fibrad_log(u) / (a + 1)));
        if (3 * (1 + t) * (1 + t) * fibrad_fraction(fibrad_random_ahead(random, k + 1)) < 3 + t) break;
    }
    return t;
}

/* Does what fibrad_reemit does, for K' instead of K. a: e/(2 k*). The function uses the random numbers from `first` to
 * first + FIBRAD_REEMITTED_DRAWS - 1. The equation for s has the form s^3 - p s + 2 = 0. Its root between 0 and 1 is 2
 * sqrt(p/3) sin(q/3) with sin q = (3/p)^(3/2). */
static inline void fibrad_reemit_above(double a, fibrad_random random, uint64_t first, const double even[3],
                                       double n[3]) {
    const double t = fibrad_max(FIBRAD_REEMITTED_ANYWHERE, fibrad_reemitted_depth(a, random, first));
    const double u = fibrad_fraction(fibrad_random_ahead(random, first + FIBRAD_REEMITTED_DRAWS - 1));
    if (t > FIBRAD_REEMITTED_NOWHERE) return;
    const double more = 4 * t * t * (3 + t) * u / ((1 + t) * (1 + t) * (1 - t)), p = 3 + more;
    const double angle =
        fibrad_quarter_angle(fibrad_sqrt(more * (p * p + 3 * p + 9)), 5.196152422706632); /* 27^(1/2) */
    double sine, cosine;
    fibrad_sincos_turn(angle / (6 * FIBRAD_PI), &sine, &cosine);
    fibrad_turn_to(2 * fibrad_sqrt(p / 3) * sine * (1 + t), t, even, n);
}

/* m, the even part of K, 0 to 1. a: e/(2 k*). */
double fibrad_reemitted_evenly(double a);

#endif
