/* conducting.h - where a ball that conducts gives off what it absorbs at a point. SPDX-License-Identifier: MIT
 *
 * The ball is steady inside, and its net power is 0. Let e be its emissivity, k* its relative conductivity and
 * a = e/(2 k*). Of what the ball absorbs in a pattern of degree l (spherical harmonics) it gives off a/(a + l) in the
 * same pattern: docs/methods_heat.md section 14. So what is absorbed at one point is given off at the angle g from that
 * point with the density
 *
 *     K(g) = integral over t from 0 to 1 of a t^(a-1) P_t(g),   P_t(g) = (1 - t^2)/(4 pi (1 + t^2 - 2 t cos g)^(3/2)).
 *
 * Let U be an even random number in [0, 1]. Then t = U^(1/a) has the density a t^(a-1). P_t is Poisson's kernel, whose
 * integral has an inverse in closed form. P_t is least opposite the point: 4 pi P_t >= (1 - t)/(1 + t)^2. */
#ifndef FIBRAD_EXCHANGE_CONDUCTING_H
#define FIBRAD_EXCHANGE_CONDUCTING_H

#include "base/elementary.h"

/* Below the first t all points are equally likely. Above the second t heat is given off where it was absorbed. */
#define FIBRAD_CONDUCTED_ANYWHERE 1e-9
#define FIBRAD_CONDUCTED_NOWHERE  (1 - 1e-12)

/* Moves the unit vector n by the angle whose cosine is 1 - x, towards or away from `even`, a random unit vector. */
static inline void fibrad_turn_by(double x, const double even[3], double n[3]) {
    const double along = even[0] * n[0] + even[1] * n[1] + even[2] * n[2];
    const double across[3] = {even[0] - along * n[0], even[1] - along * n[1], even[2] - along * n[2]};
    const double square = across[0] * across[0] + across[1] * across[1] + across[2] * across[2];
    if (square < 1e-24) return;
    const double sine = fibrad_sqrt(fibrad_max(0, x * (2 - x)) / square);
    for (int axis = 0; axis < 3; axis++) n[axis] = (1 - x) * n[axis] + sine * across[axis];
}

/* Moves n from the outward normal where a ball absorbs to the normal where the ball gives the absorbed heat off.
 * exponent: 1/a. If it is infinite, all points are equally likely. u: two even random numbers in [0, 1). even: a random
 * point of the unit sphere. Returns the fraction of P_t, for the t drawn, that is above its least value, 0 to 1. */
static inline double fibrad_conduct(double exponent, const double u[2], const double even[3], double n[3]) {
    const double t = u[0] > 0 ? fibrad_exp(fibrad_max(-800, exponent * fibrad_log(1 - u[0]))) : 1;
    if (t > FIBRAD_CONDUCTED_NOWHERE) return 1;
    if (t < FIBRAD_CONDUCTED_ANYWHERE) {
        for (int axis = 0; axis < 3; axis++) n[axis] = even[axis];
        return 0;
    }
    const double least = 1 / (1 + t), rho = least + 2 * t * u[1] / ((1 - t) * (1 + t)), distance = 1 / rho;
    const double x = (distance - (1 - t)) * (distance + (1 - t)) / (2 * t), share = least * distance;
    fibrad_turn_by(fibrad_min(fibrad_max(x, 0), 2), even, n);
    return 1 - share * share * share;
}

#endif
