/* line.c - lines spread evenly. SPDX-License-Identifier: MIT */
#include "base/random.h"
#include "base/vector.h"
#include "sample/line.h"
#include "sample/direction.h"

/* ---- tables ---------------------------------------------------------------------------------------------------- */

/* The sizes of the sets in fibrad_table_lines. The sets follow each other in this order. */
static const uint16_t SIZES[] = {8,   11,  16,  23,  32,  45,  55,  64,   91,   100,
                                 128, 181, 233, 256, 362, 512, 724, 1024, 1448, 2048};
enum { SIZE_COUNT = sizeof SIZES / sizeof SIZES[0] };

/* Index of the first line of the set of n. UINT32_MAX: there is no such set. */
static uint32_t first_of_set(uint32_t n) {
    uint32_t first = 0;
    for (int i = 0; i < SIZE_COUNT && SIZES[i] <= FIBRAD_TABLE_LINES; i++) {
        if (SIZES[i] == n) return first;
        first += SIZES[i];
    }
    return UINT32_MAX;
}

bool fibrad_lines_tabled(uint32_t n) { return first_of_set(n) != UINT32_MAX; }

uint32_t fibrad_lines_next(uint32_t n) {
    for (int i = 0; i < SIZE_COUNT && SIZES[i] <= FIBRAD_TABLE_LINES; i++)
        if (SIZES[i] >= n) return SIZES[i];
    return n;
}

/* Makes a unit vector of an entry: the projection from the south pole, x/(1 + z) and y/(1 + z), in units of 2^-31.
 * sense: 1 or -1. */
static void unfold_line(const int32_t entry[2], double sense, double line[3]) {
    const double u = 0x1p-31 * entry[0], v = 0x1p-31 * entry[1], square = u * u + v * v, scale = sense * (1 + square);
    line[0] = 2 * u / scale;
    line[1] = 2 * v / scale;
    line[2] = (1 - square) / scale;
}

static void unfold_set(uint32_t n, double (*line)[3]) {
#if FIBRAD_TABLE_LINES >= 8
    const uint32_t first = first_of_set(n);
    for (uint32_t k = first; k < first + n; k++) {
        const bool turned = fibrad_table_senses[k / 32] >> k % 32 & 1;
        unfold_line(fibrad_table_lines[k], turned ? -1 : 1, line[k - first]);
    }
#else
    (void)n, (void)line, (void)unfold_line;
#endif
}

/* ---- steps uphill ---------------------------------------------------------------------------------------------- */

/* |p - q| + |p + q| = 2 sqrt(1 + s), where s is the sine of the angle between p and q. */
static double distances(const double p[3], const double q[3]) {
    const double t = fibrad_dot(p, q);
    return 2 * fibrad_sqrt(1 + fibrad_sqrt(fibrad_max(0, 1 - t * t)));
}

/* The derivative of this sum with respect to the cosine of the angle. */
static double slope(const double p[3], const double q[3]) {
    const double t = fibrad_dot(p, q), square = fibrad_max(0x1p-40, 1 - t * t);
    return -t / fibrad_sqrt(square * (1 + fibrad_sqrt(square)));
}

/* Adds the forces between line i and all lines after it. weight: of pairs within a half, and of pairs across. */
static void add_forces(uint32_t n, const double (*line)[3], uint32_t i, const double weight[2], double (*velocity)[3]) {
    const double *p = line[i];
    double sum[3] = {0, 0, 0};
    for (uint32_t j = i + 1; j < n; j++) {
        const double force = weight[(i ^ j) & 1] * slope(p, line[j]);
        for (int axis = 0; axis < 3; axis++) {
            sum[axis] += force * line[j][axis];
            velocity[j][axis] += force * p[axis];
        }
    }
    for (int axis = 0; axis < 3; axis++) velocity[i][axis] += sum[axis];
}

/* Moves p by the tangential component of its velocity, and brings it back onto the sphere. */
static void move_line(double p[3], double velocity[3]) {
    const double along = fibrad_dot(p, velocity);
    for (int axis = 0; axis < 3; axis++) {
        velocity[axis] -= along * p[axis];
        p[axis] += velocity[axis];
    }
    const double length = fibrad_sqrt(fibrad_dot(p, p));
    for (int axis = 0; axis < 3; axis++) p[axis] /= length;
}

void fibrad_lines_relax(uint32_t n, double (*line)[3], double (*velocity)[3], const fibrad_line_steps *steps) {
    const double across = steps->length / n, weight[2] = {across * (1 + steps->halves), across};
    fibrad_zero(velocity, n * sizeof *velocity);
    for (uint32_t step = 0; step < steps->count; step++) {
        for (uint32_t i = 0; i < n; i++)
            for (int axis = 0; axis < 3; axis++) velocity[i][axis] *= steps->momentum;
        for (uint32_t i = 0; i < n; i++) add_forces(n, (const double(*)[3])line, i, weight, velocity);
        for (uint32_t i = 0; i < n; i++) move_line(line[i], velocity[i]);
    }
}

/* ---- halves ---------------------------------------------------------------------------------------------------- */

/* field[i]: the sum of the distances of line i from the other lines of its half, minus those from the other half. */
static void make_field(uint32_t n, const double (*line)[3], double *field) {
    fibrad_zero(field, n * sizeof *field);
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t j = i + 1; j < n; j++) {
            const double distance = distances(line[i], line[j]), add = (i ^ j) & 1 ? -distance : distance;
            field[i] += add;
            field[j] += add;
        }
}

/* The odd-numbered line whose exchange with the even-numbered line i gains most. i: no exchange gains. */
static uint32_t best_exchange(uint32_t n, const double (*line)[3], const double *field, uint32_t i) {
    uint32_t best = i;
    double most = 0x1p-30;
    for (uint32_t j = 1; j < n; j += 2) {
        const double gain = -(field[i] + field[j]) - 2 * distances(line[i], line[j]);
        if (gain > most) most = gain, best = j;
    }
    return best;
}

/* Exchanges the even-numbered line i and the odd-numbered line j. */
static void exchange_lines(uint32_t n, double (*line)[3], double *field, uint32_t i, uint32_t j) {
    for (uint32_t k = 0; k < n; k++) {
        if (k == i || k == j) continue;
        const double change = 2 * (distances(line[k], line[j]) - distances(line[k], line[i]));
        field[k] += k & 1 ? -change : change;
    }
    const double between = 2 * distances(line[i], line[j]), field_i = field[i];
    field[i] = -field[j] - between;
    field[j] = -field_i - between;
    for (int axis = 0; axis < 3; axis++) {
        const double x = line[i][axis];
        line[i][axis] = line[j][axis];
        line[j][axis] = x;
    }
}

void fibrad_lines_halve(uint32_t n, double (*line)[3], double *field) {
    make_field(n, (const double(*)[3])line, field);
    bool more = true;
    for (int sweep = 0; sweep < 16 && more; sweep++) {
        more = false;
        for (uint32_t i = 0; i < n; i += 2) {
            const uint32_t j = best_exchange(n, (const double(*)[3])line, field, i);
            if (j == i) continue;
            exchange_lines(n, line, field, i, j);
            more = true;
        }
    }
}

/* ---- senses ----------------------------------------------------------------------------------------------------- */

#define WITHIN_HALF 1.5

/* What the sum of 1/|p - q| loses if one of two vectors that are nearest as they are turns round. */
static double sense_gain(const double (*line)[3], uint32_t i, uint32_t j) {
    const double t = fibrad_dot(line[i], line[j]), weight = (i ^ j) & 1 ? 1 : WITHIN_HALF;
    return weight * (1 / fibrad_sqrt(fibrad_max(0x1p-40, 2 - 2 * t)) - 1 / fibrad_sqrt(fibrad_max(0x1p-40, 2 + 2 * t)));
}

static void turn_line(uint32_t n, double (*line)[3], double *field, uint32_t i) {
    for (int axis = 0; axis < 3; axis++) line[i][axis] = 0 - line[i][axis];
    field[i] = 0 - field[i];
    for (uint32_t j = 0; j < n; j++)
        if (j != i) field[j] += 2 * sense_gain((const double(*)[3])line, i, j);
}

/* Turns lines round if this raises the sum by no more than a threshold, which falls to 0. So the search leaves poor
 * minima without a random number. field[i]: what the sum gains from turning line i, over -2. */
double fibrad_lines_orient(uint32_t n, double (*line)[3], double *field, uint64_t draw) {
    enum { SWEEPS = 40, TAIL = 8 };
    fibrad_random random = fibrad_random_start(draw, n);
    double sum = 0;
    for (uint32_t i = 0; i < n; i++)
        if (fibrad_random_next(&random) < 0.5)
            for (int axis = 0; axis < 3; axis++) line[i][axis] = 0 - line[i][axis];
    fibrad_zero(field, n * sizeof *field);
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t j = 0; j < n; j++)
            if (j != i) field[i] += sense_gain((const double(*)[3])line, i, j);
    for (int sweep = 0; sweep < SWEEPS + TAIL; sweep++) {
        const double threshold = sweep < SWEEPS ? 2.0 * (SWEEPS - sweep) / SWEEPS : 0;
        for (uint32_t i = 0; i < n; i++)
            if (-field[i] < threshold * fibrad_random_next(&random) - 1e-9) turn_line(n, line, field, i);
    }
    for (uint32_t i = 0; i < n; i++) sum += field[i];
    return sum / 2;
}

/* ---- sets ------------------------------------------------------------------------------------------------------ */

/* Direction k of the Fibonacci set of `of` directions for k < n. */
static void take_directions(uint32_t n, uint32_t of, double (*line)[3]) {
    for (uint32_t k = 0; k < n; k++) {
        const fibrad_polar p = fibrad_direction_polar(k, of);
        line[k][0] = p.ring * p.cos;
        line[k][1] = p.ring * p.sin;
        line[k][2] = p.z;
    }
}

/* Half a Fibonacci set of 2 n has one direction of each line, but a seam at the equator. Some steps close the seam.
 * Then the lines are divided into halves. Further steps spread both halves and the whole set. */
void fibrad_lines_make(uint32_t n, double (*line)[3], double *scratch) {
    static const fibrad_line_steps close = {16, 1.5, 0.8, 0}, spread = {32, 1.5, 0.8, 0.3};
    if (fibrad_lines_tabled(n)) {
        unfold_set(n, line);
    } else if (n > FIBRAD_LINES_EVEN_MAX) {
        take_directions(n, n, line);
    } else {
        take_directions(n, 2 * n, line);
        fibrad_lines_relax(n, line, (double(*)[3])scratch, &close);
        fibrad_lines_halve(n, line, scratch);
        fibrad_lines_relax(n, line, (double(*)[3])scratch, &spread);
        (void)fibrad_lines_orient(n, line, scratch, 0);
    }
}
