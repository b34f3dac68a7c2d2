/* exact.c - the view factor of two spheres with nothing in between. SPDX-License-Identifier: MIT
 *
 * Lengths are in units of the distance d of the centres. R >= r are the radii and g is the gap. The directional form is
 * the mean
 *
 *     F12 = (r2^2 / 2) < 1 / (1 + sqrt(p + q y)) >,    p = g (2 (R + r) + g) = 1 - (R + r)^2,    q = 4 R r,
 *
 * over y = sin^2 t with density (16/pi) sin^2 t cos^2 t on [0, pi/2]. All terms are positive, p is computed from the
 * gap itself, and the far field, where < > = 1/2, needs no special case. The difficult case is p << q. There
 * sqrt(p + q y) has a bend at y = -p/q, near the end of the range. The density gives this end little weight. The nodes
 * are dense there: t = (pi/2)(e^5u - 1)/(e^5 - 1) at the 28 Gauss-Legendre nodes u of [0, 1]. So they resolve the bend
 * wherever it is. The error of the rule is below 2e-16 for all 0 <= p, q with p + q <= 1.
 * tests/data/generate_pair_exact.c makes the table. */
#include "base/port.h"
#include "fibrad.h"

enum { NODES = 28, LANES = 4 };

static const double node[NODES] = {
    9.061561558843976e-09,  2.5999338648151478e-07, 1.6664356825182266e-06, 6.2603842282500172e-06,
    1.8014418992158647e-05, 4.4442503705241408e-05, 9.9616454100200461e-05, 0.00020978697197019063,
    0.00042377822361722742, 0.00083201685597592221, 0.0016008372927570939,  0.0030329221138800143,
    0.0056702627861520021,  0.010461112618440812,   0.019011265331496852,   0.033918867806896715,
    0.05912555613267355,    0.10007372501474016,    0.16323980913162355,    0.25444226332827773,
    0.37556840587927585,    0.52052118163188235,    0.67310967435096688,    0.81042641651709515,
    0.91225661873019418,    0.97108139112814624,    0.99479342265129677,    0.99980393753337096};

static const double weight[NODES] = {
    1.1317695894190931e-11, 7.8108568132376727e-10, 8.3398583610136069e-09, 4.6433412403163678e-08,
    1.883306542113792e-07,  6.3977641520413765e-07, 1.9536474049056239e-06, 5.5800567369864427e-06,
    1.5261987345223202e-05, 4.0531051154551148e-05, 0.00010530581479345097, 0.00026848445629240237,
    0.00067136545754828907, 0.0016406553932453528,  0.0038930038085054479,  0.0088846020741586738,
    0.019251221987781469,   0.038935677464174473,   0.071910460771171267,   0.11799384500755139,
    0.16635079170396431,    0.19369790800517065,    0.17789548248976863,    0.12191628197717333,
    0.057787721995975301,   0.016594018536865064,   0.0021032672879675493,  3.569535250773377e-05};

/* The sum of LANES interleaved partial sums. All compilers and vector lengths add in the same order. */
static double fold(const double sum[LANES]) { return (sum[0] + sum[2]) + (sum[1] + sum[3]); }

/* < 1 / (1 + sqrt(p + q y)) > */
static double mean_apart(double p, double q) {
    double sum[LANES] = {0};
    for (int k = 0; k < NODES; k += LANES)
        for (int m = 0; m < LANES; m++) sum[m] += weight[k + m] / (1 + fibrad_sqrt(p + q * node[k + m]));
    return fold(sum);
}

/* < sqrt(y + e) / (1 + sqrt(q y)) > */
static double mean_overlapping(double e, double q) {
    double sum[LANES] = {0};
    for (int k = 0; k < NODES; k += LANES)
        for (int m = 0; m < LANES; m++)
            sum[m] += weight[k + m] * fibrad_sqrt(node[k + m] + e) / (1 + fibrad_sqrt(q * node[k + m]));
    return fold(sum);
}

/* Area a - sin a cos a of the segment of the unit circle with half angle a. t = tan(a/2) > 0. For t < 1 it is
 * 2 (atan t - t) + 2 t^3 (3 + t^2)/(1 + t^2)^2 with atan t = 4 atan u, u = tan(a/8) <= 0.2. So no digits cancel in a
 * thin segment. */
static double lens_segment(double t) {
    if (t > 1) return FIBRAD_PI - lens_segment(1 / t);
    double half = t / (1 + fibrad_sqrt(1 + t * t)), u = half / (1 + fibrad_sqrt(1 + half * half));
    double v = u * u, tail = 0; /* atan u = u + u^3 tail */
    for (int n = 25; n >= 3; n -= 2) tail = tail * -v - 1.0 / n;
    double excess = 4 * u * v * (tail - (5 - v) / (1 - v * (6 - v))); /* atan t - t */
    double s = 1 + t * t;
    return 2 * (excess + t * t * t * (2 + s) / (s * s));
}

/* r1^2 F12 / r^2 for spheres that overlap, R >= r, gap in (-2 r, 0). With the area L of the lens at distance d and the
 * chord c,
 *
 *     2 pi r1^2 F12 = L(d) + integral of c(s) (1 - sqrt(1 - s^2/d^2)) ds,    s from R - r to d.
 *
 * In y = (1 - s^2/d^2)/w^2, w^2 = 1 - (R - r)^2/d^2, the integrand is sqrt((1 - y)(y + e))/(1 + w sqrt(y)) with
 * e = -p/w^2. The rule above integrates the part that is odd in sqrt(y). The even part, sqrt((1 - y)(y + e)), is the
 * segment of a circle, as are the two parts of the lens. The arguments of `lens_segment` come from the half-angle
 * formulas of the triangle R, r, d. */
static double exchange_overlapping(double R, double r, double gap) {
    double a = 2 * R + gap, b = 2 * r + gap, c = a + 2 * r, g = -gap; /* all > 0 */
    double d = R - r + b, w2 = a / d * (b / d), w = fibrad_sqrt(w2);
    double lens =
        R / r * (R / r * lens_segment(fibrad_sqrt(g / a * (b / c)))) + lens_segment(fibrad_sqrt(g / b * (a / c)));
    double even = R / d * (R / d) * lens_segment(fibrad_sqrt(a / g * (b / c))), chord = d / r * w2;
    double e = g / a * fibrad_min(c / b, 1e300); /* for larger ratios the chord is 0 */
    double odd = FIBRAD_PI / 16 * chord * chord * w * mean_overlapping(e, w2);
    return (lens + (even - odd)) / (2 * FIBRAD_PI);
}

/* Radii within these bounds leave room for sums and ratios. */
static bool valid_radius(double r) { return r >= FIBRAD_LENGTH_MIN && r <= FIBRAD_LENGTH_MAX; }

int fibrad_pair_exact(double r1, double r2, double gap, double *f12) {
    bool valid = f12 && valid_radius(r1) && valid_radius(r2) && fibrad_finite(gap);
    if (!valid || gap <= -2 * fibrad_min(r1, r2)) return FIBRAD_E_ARGUMENT;
    double R = fibrad_max(r1, r2), r = fibrad_min(r1, r2);
    if (gap < 0) {
        *f12 = r / r1 * (r / r1) * exchange_overlapping(R, r, gap);
        return FIBRAD_OK;
    }
    double d = R + r + gap, p = gap / d * (2 * (R / d + r / d) + gap / d), q = 4 * (R / d) * (r / d);
    *f12 = r2 / d * (r2 / d) / 2 * mean_apart(p, q);
    return FIBRAD_OK;
}
