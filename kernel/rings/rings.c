/* rings.c - two spheres near each other, in rings about the line of their centres. SPDX-License-Identifier: MIT
 *
 * With the irradiation H and the emission E of a ring let v = H - E. It absorbs eps v and sends J = E + (1 - eps) v.
 * The flux eps v and light that was absorbed besides are conducted: E = E0 + S (eps v + a), S being `spread` times the
 * unevenness. H is what arrives from elsewhere plus the factors to the rings of the other sphere times their J. This is
 * a linear system in v of both spheres. A film takes away the part B of the flux that E - E0 would have in degree 1, B
 * being h R/k: S (1 + B S)^-1 stands for S. */
#include "base/elementary.h"
#include "base/linear.h"
#include "rings/rings.h"

#define RINGS   FIBRAD_RINGS
#define NARROW  2e-3  /* angle at which the first ring ends */
#define RATIO   1.4   /* of the angles of successive edges */
#define WIDEST  .255  /* largest width of a ring: with it the rings end at half a turn */
#define TERMS   3000u /* degrees of the sum for `spread`: a wave of the last one is as wide as the first ring */
#define TURNS   14    /* places in half a turn around the axis */
#define STRETCH .45   /* they lie in stretches, each of which is this part of the one before */

/* The edges of rings are in geometric progression of the angle, as long as rings are not wider than WIDEST. */
static void find_edges(fibrad_rings *rings) {
    double angle = NARROW;
    rings->edge[0] = 0, rings->edge[RINGS] = 1;
    for (uint32_t k = 1; k < RINGS; k++) {
        double sine, cosine;
        fibrad_sincos_turn(angle / (4 * FIBRAD_PI), &sine, &cosine);
        rings->edge[k] = sine * sine;
        angle += fibrad_min((RATIO - 1) * angle, WIDEST);
    }
    for (uint32_t k = 0; k < RINGS; k++) {
        const double middle = (rings->edge[k] + rings->edge[k + 1]) / 2;
        rings->share[k] = rings->edge[k + 1] - rings->edge[k];
        rings->cosine[k] = 1 - 2 * middle, rings->sine[k] = 2 * fibrad_sqrt(middle * (1 - middle));
    }
}

/* The next Legendre polynomial at the edges, and its means over rings. last, value: of degrees l - 1 and l. */
static void next_degree(const fibrad_rings *rings, uint32_t l, double *last, double *value, double *mean) {
    double before = 0;
    for (uint32_t k = 0; k <= RINGS; k++) {
        const double next = ((2 * l + 1) * (1 - 2 * rings->edge[k]) * value[k] - l * last[k]) / (l + 1);
        const double slope = (next - last[k]) / (2 * l + 1);
        if (k > 0) mean[k - 1] = (before - slope) / (2 * rings->share[k - 1]);
        before = slope, last[k] = value[k], value[k] = next;
    }
}

void fibrad_rings_make(fibrad_rings *rings) {
    double last[RINGS + 1], value[RINGS + 1], mean[RINGS];
    find_edges(rings);
    for (uint32_t k = 0; k <= RINGS; k++) last[k] = 1, value[k] = 1 - 2 * rings->edge[k];
    fibrad_zero(rings->spread, sizeof rings->spread);
    for (uint32_t l = 1; l < TERMS; l++) {
        next_degree(rings, l, last, value, mean);
        for (uint32_t k = 0; k < RINGS; k++)
            for (uint32_t m = 0; m < RINGS; m++)
                rings->spread[k][m] += (2 * l + 1.0) / l * mean[k] * mean[m] * rings->share[m];
    }
}

uint32_t fibrad_rings_at(const fibrad_rings *rings, double cosine) {
    uint32_t low = 0, high = RINGS;
    while (high - low > 1) {
        const uint32_t middle = (low + high) / 2;
        if (2 * rings->edge[middle] <= 1 - cosine)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* The angle whose cosine is given. */
static double angle_at(double cosine) {
    const double c = fibrad_max(-1, fibrad_min(1, cosine)), s = fibrad_sqrt(1 - c * c);
    return c < 0 ? FIBRAD_PI - fibrad_quarter_angle(-c, s) : fibrad_quarter_angle(c, s);
}

/* The view factor from a point to a sphere. far: the distance of the sphere's centre in radii. tilt: the cosine
 * between the normal and the direction to the centre. The horizon may hide a part of the sphere. */
static double factor_of_point(double far, double tilt) {
    if (far * tilt >= 1) return tilt / (far * far);
    if (far * tilt <= -1) return 0;
    const double root = fibrad_sqrt(fibrad_max(0, far * far - 1)), across = fibrad_sqrt(1 - tilt * tilt);
    const double cut = fibrad_sqrt(fibrad_max(0, 1 - far * far * tilt * tilt));
    return (angle_at(root / (far * across)) + (tilt * angle_at(-root * tilt / across) - root * cut) / (far * far)) /
           FIBRAD_PI;
}

/* The middle of a ring, and its normal: across the axis and along it. The axis of the other sphere is the reverse. */
struct ring_place {
    double across, along, sine, cosine;
};

/* Places around the axis: sine and cosine of the turn, and weights that add up to 1. */
struct turns {
    double sine[TURNS], cosine[TURNS], weight[TURNS];
};

/* Gauss's rule of two points in the sine of half the turn, in stretches that become shorter towards 0. */
static void find_turns(struct turns *turns) {
    static const double place[2] = {.2113248654051871, .7886751345948129};
    double high = 1;
    for (int k = 0; k < TURNS; k++) {
        const double low = k + 2 < TURNS ? STRETCH * high : 0, half = low + (high - low) * place[k % 2];
        const double rest = fibrad_sqrt(1 - half * half);
        turns->cosine[k] = 1 - 2 * half * half, turns->sine[k] = 2 * half * rest;
        turns->weight[k] = (high - low) / rest;
        if (k % 2) high = low;
    }
}

/* What a place sees of a ring, and the ring of a place, up to a factor: a mean over half a turn around the axis. */
static double seen_of_ring(const struct turns *turns, const struct ring_place *from, const struct ring_place *to) {
    const double z = to->along - from->along;
    double sum = 0;
    for (int k = 0; k < TURNS; k++) {
        const double x = to->across * turns->cosine[k] - from->across, y = to->across * turns->sine[k];
        const double leaves = fibrad_max(0, x * from->sine + z * from->cosine),
                     meets = fibrad_max(0, z * to->cosine - (x * turns->cosine[k] + y * turns->sine[k]) * to->sine),
                     square = x * x + y * y + z * z;
        sum += turns->weight[k] * leaves * meets / (square * square);
    }
    return sum;
}

/* The sum of the factors from a ring of a sphere to another sphere. */
static double sum_of_factors(const struct ring_place *from, double other, double distance) {
    const double z = distance - from->along, far = fibrad_sqrt(from->across * from->across + z * z);
    return factor_of_point(far / other, (z * from->cosine - from->across * from->sine) / far);
}

/* Scales what the rings of sphere i see, so that the sums of factors are exact. */
static void scale_factors(const fibrad_rings *rings, const double radius[2], double distance, int i,
                          fibrad_rings_work *work) {
    for (uint32_t k = 0; k < RINGS; k++) {
        const struct ring_place from = {radius[i] * rings->sine[k], radius[i] * rings->cosine[k], rings->sine[k],
                                        rings->cosine[k]};
        const double exact = sum_of_factors(&from, radius[1 - i], distance);
        double *factor = work->factor[i][k], sum = 0;
        for (uint32_t m = 0; m < RINGS; m++) sum += factor[m];
        for (uint32_t m = 0; m < RINGS; m++) factor[m] = sum > 0 ? factor[m] * (exact / sum) : 0;
        work->facing[i][k] = sum > 0 ? exact : 0;
    }
}

void fibrad_rings_face(const fibrad_rings *rings, const double radius[2], double distance, fibrad_rings_work *work) {
    struct turns turns;
    find_turns(&turns);
    for (uint32_t k = 0; k < RINGS; k++) {
        const struct ring_place from = {radius[0] * rings->sine[k], radius[0] * rings->cosine[k], rings->sine[k],
                                        rings->cosine[k]};
        for (uint32_t m = 0; m < RINGS; m++) {
            const struct ring_place to = {radius[1] * rings->sine[m], distance - radius[1] * rings->cosine[m],
                                          rings->sine[m], rings->cosine[m]};
            const double seen = seen_of_ring(&turns, &from, &to);
            work->factor[0][k][m] = rings->share[m] * seen, work->factor[1][m][k] = rings->share[k] * seen;
        }
    }
    for (int i = 0; i < 2; i++) scale_factors(rings, radius, distance, i, work);
}

/* Finds work->spread[i] of a sphere with a film, by elimination: (1 + B S)^-1 S. */
static void film_spread(const fibrad_rings *rings, double biot, uint32_t i, fibrad_rings_work *work) {
    fibrad_copy(work->spread[i], rings->spread, sizeof rings->spread);
    if (biot == 0) return;
    for (uint32_t k = 0; k < RINGS; k++)
        for (uint32_t m = 0; m < RINGS; m++) work->row[k][m] = biot * rings->spread[k][m] + (k == m);
    for (uint32_t p = 0; p < RINGS; p++) {
        for (uint32_t k = 0; k < RINGS; k++) {
            const double part = work->row[k][p] / work->row[p][p];
            for (uint32_t m = 0; m < RINGS && k != p; m++) {
                if (m > p) work->row[k][m] -= part * work->row[p][m];
                work->spread[i][k][m] -= part * work->spread[i][p][m];
            }
        }
    }
    for (uint32_t k = 0; k < RINGS; k++)
        for (uint32_t m = 0; m < RINGS; m++) work->spread[i][k][m] /= work->row[k][k];
}

/* What the emission of ring k has of each v of its sphere. Returns the emission that is known. */
static double conducted_at(double spreads[RINGS][RINGS], const fibrad_ringed *sphere, uint32_t k, double more[RINGS]) {
    double known = sphere->emission;
    for (uint32_t m = 0; m < RINGS; m++) {
        const double spread = sphere->unevenness * spreads[k][m];
        more[m] = sphere->emissivity * spread;
        known += spread * sphere->absorbed[m];
    }
    return known;
}

/* The balances of the rings of sphere i: E + v - factors times J of the other sphere = what arrives from elsewhere. */
static void set_rows(const fibrad_ringed *sphere, uint32_t count, uint32_t i, fibrad_rings_work *work) {
    const uint32_t end = count * RINGS, j = count - 1 - i;
    double spread[RINGS];
    for (uint32_t k = 0; k < RINGS; k++) {
        double *row = work->row[i * RINGS + k];
        fibrad_zero(row, (end + 1) * sizeof *row);
        row[end] = sphere[i].arriving[k] - conducted_at(work->spread[i], &sphere[i], k, row + i * RINGS);
        row[i * RINGS + k] += 1;
    }
    for (uint32_t m = 0; m < RINGS && count > 1; m++) {
        const double known = conducted_at(work->spread[j], &sphere[j], m, spread);
        spread[m] += 1 - sphere[j].emissivity;
        for (uint32_t k = 0; k < RINGS; k++) {
            const double factor = work->factor[i][k][m];
            double *row = work->row[i * RINGS + k];
            row[end] += factor * known;
            for (uint32_t n = 0; n < RINGS && factor > 0; n++) row[j * RINGS + n] -= factor * spread[n];
        }
    }
}

double fibrad_rings_top(const fibrad_rings *rings, const fibrad_ringed *sphere, uint32_t count,
                        fibrad_rings_work *work) {
    double spread[RINGS];
    for (uint32_t i = 0; i < count; i++) film_spread(rings, sphere[i].biot, i, work);
    for (uint32_t i = 0; i < count; i++) set_rows(sphere, count, i, work);
    fibrad_solve_linear(count * RINGS, 2 * RINGS + 1, work->row[0]);
    double top = conducted_at(work->spread[0], &sphere[0], 0, spread) - sphere[0].emission;
    for (uint32_t m = 0; m < RINGS; m++) top += spread[m] * work->row[m][count * RINGS];
    return top;
}

/* The share of the flux that enters a spot of one temperature within ring k. The flux is in proportion to
 * 1/sqrt(1 - x), x being the share of the spot's area within. */
static double share_of_spot(const fibrad_rings *rings, double size, uint32_t k) {
    const double low = fibrad_min(1, 4 * rings->edge[k] / (size * size)),
                 high = fibrad_min(1, 4 * rings->edge[k + 1] / (size * size));
    return fibrad_sqrt(1 - low) - fibrad_sqrt(1 - high);
}

/* With the flux p of the spot, (1 + eps u S) z = p. The response is u S z, since S is symmetric with shares as weights.
 */
double fibrad_rings_spot(const fibrad_rings *rings, double size, double emissivity, double unevenness, double biot,
                         fibrad_rings_work *work, double response[RINGS]) {
    double flux[RINGS], less = 0;
    film_spread(rings, biot, 0, work);
    for (uint32_t k = 0; k < RINGS; k++) {
        double *row = work->row[k];
        for (uint32_t m = 0; m < RINGS; m++) row[m] = emissivity * unevenness * work->spread[0][k][m] + (k == m);
        row[RINGS] = flux[k] = share_of_spot(rings, size, k) / rings->share[k];
    }
    fibrad_solve_linear(RINGS, 2 * RINGS + 1, work->row[0]);
    for (uint32_t k = 0; k < RINGS; k++) {
        response[k] = 0;
        for (uint32_t m = 0; m < RINGS; m++) {
            const double spread = unevenness * work->spread[0][k][m], reached = work->row[m][RINGS];
            const double by_film = unevenness * rings->spread[k][m] - spread;
            response[k] += spread * reached;
            less += rings->share[k] * flux[k] * (spread * (flux[m] - reached) + by_film * flux[m]);
        }
    }
    return less;
}
