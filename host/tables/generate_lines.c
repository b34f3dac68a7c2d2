/* generate_lines.c - writes kernel/sample/line_table.c to standard output, in some minutes.
 * SPDX-License-Identifier: MIT
 *
 * Each set is the best of several candidates. A candidate begins with about half a Fibonacci set, which has one
 * direction of each line, but a seam at the equator. Some steps close the seam. Then the lines are divided into halves.
 * Further steps spread both halves and the whole set. Compile this file with direction.c, tables.c and
 * -ffp-contract=off. Then all machines write the same file. */
#include "base/random.h"
#include "base/vector.h"
#include "sample/direction.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* as in kernel/sample/line.c */
static const uint32_t SIZES[] = {8, 11, 16, 23, 32, 45, 55, 64, 91, 100, 128, 181, 233, 256, 362, 512, 724, 1024};
enum { SIZE_COUNT = sizeof SIZES / sizeof SIZES[0], LARGEST = 1024 };

/* the weight of pairs within a half */
static const double HALVES = 0.3;

typedef double vector[3];

/* Steps uphill. Pairs within a half count 1 + halves times. */
typedef struct line_steps {
    uint32_t count;
    double length; /* of a step, in units of the force over n; steps are stable up to 2 (1 + momentum)/(1 + halves/2) */
    double momentum; /* the part of a step that is added to the next one, 0 to 0.9 */
    double halves;   /* >= 0 */
} line_steps;

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

/* Takes steps that increase the sum of |p - q| + |p + q| over pairs. velocity: n vectors, overwritten. */
static void relax_lines(uint32_t n, double (*line)[3], double (*velocity)[3], const line_steps *steps) {
    const double across = steps->length / n, weight[2] = {across * (1 + steps->halves), across};
    fibrad_zero(velocity, n * sizeof *velocity);
    for (uint32_t step = 0; step < steps->count; step++) {
        for (uint32_t i = 0; i < n; i++)
            for (int axis = 0; axis < 3; axis++) velocity[i][axis] *= steps->momentum;
        for (uint32_t i = 0; i < n; i++) add_forces(n, (const double(*)[3])line, i, weight, velocity);
        for (uint32_t i = 0; i < n; i++) move_line(line[i], velocity[i]);
    }
}

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

/* Exchanges even-numbered and odd-numbered lines while this spreads the halves more evenly. field: n doubles,
 * overwritten. */
static void halve_lines(uint32_t n, double (*line)[3], double *field) {
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

/* Chooses senses that make the sum of 1/|p - q| over pairs of vectors small. Pairs within a half count half as much
 * again. Turns lines round if this raises the sum by no more than a threshold, which falls to 0. draw: senses to begin
 * with. field[i]: what the sum gains from turning line i, over -2. Returns the sum, up to a constant of the lines. */
static double orient_lines(uint32_t n, double (*line)[3], double *field, uint64_t draw) {
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

/* The sum that the steps increase. */
static double height(uint32_t n, const vector *line) {
    double sum = 0;
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t j = i + 1; j < n; j++) {
            double t = line[i][0] * line[j][0] + line[i][1] * line[j][1] + line[i][2] * line[j][2];
            sum += ((i ^ j) & 1 ? 1 : 1 + HALVES) * 2 * sqrt(1 + sqrt(fmax(0, 1 - t * t)));
        }
    return sum;
}

/* Candidate c of the sets of n lines. It begins with the first n of 2 n + c directions. */
static void make_candidate(uint32_t n, uint32_t c, vector *line) {
    static vector scratch[LARGEST];
    const line_steps whole = {c % 2 == 0 ? 200 : 50, 1.5, 0.9, 0}, halves = {2000, 1.5, 0.9, HALVES},
                     rest = {100, 1.5, 0.3, HALVES};
    for (uint32_t k = 0; k < n; k++) fibrad_direction(k, 2 * n + c, line[k]);
    relax_lines(n, line, scratch, &whole);
    halve_lines(n, line, scratch[0]);
    relax_lines(n, line, scratch, &halves);
    relax_lines(n, line, scratch, &rest);
}

static void make_set(uint32_t n, vector *best) {
    static vector line[LARGEST];
    const uint32_t candidates = n <= 256 ? 24 : n <= 724 ? 4 : 2;
    double highest = 0;
    for (uint32_t c = 0; c < candidates; c++) {
        make_candidate(n, c, line);
        const double found = height(n, (const vector *)line);
        if (found > highest) highest = found, memcpy(best, line, n * sizeof *best);
    }
}

/* Two coordinates of the projection from the south pole, in units of 2^-31. */
static void write_line(const double p[3]) {
    const double side = p[2] < 0 ? -1 : 1, scale = side * 0x1p31 / (1 + side * p[2]);
    const double u = fmin(fmax(nearbyint(scale * p[0]), -INT32_MAX), INT32_MAX);
    const double v = fmin(fmax(nearbyint(scale * p[1]), -INT32_MAX), INT32_MAX);
    printf("{%" PRId32 ",%" PRId32 "},", (int32_t)u, (int32_t)v);
}

/* Bits of the senses of all lines so far. */
static uint32_t senses[256], lines_so_far;

/* Finds the best senses of several searches and lists them. line: as the table has them. */
static void choose_senses(uint32_t n, const vector *line) {
    static vector turned[LARGEST], best[LARGEST];
    static double field[LARGEST];
    const uint64_t searches = n <= 256 ? 2000 : n <= 724 ? 200 : 32;
    double least = HUGE_VAL;
    for (uint64_t draw = 0; draw < searches; draw++) {
        memcpy(turned, line, n * sizeof *turned);
        const double sum = orient_lines(n, turned, field, draw);
        if (sum < least) least = sum, memcpy(best, turned, n * sizeof *best);
    }
    for (uint32_t k = 0; k < n; k++, lines_so_far++)
        if (best[k][0] * line[k][0] + best[k][1] * line[k][1] + best[k][2] * line[k][2] < 0)
            senses[lines_so_far / 32] |= UINT32_C(1) << lines_so_far % 32;
}

static void write_senses(void) {
    printf("const uint32_t fibrad_table_senses[] = {\n");
    for (uint32_t w = 0; w <= lines_so_far / 32; w++) printf("0x%08" PRIx32 ",%s", senses[w], w % 8 == 7 ? "\n" : "");
    printf("\n};\n");
}

static void write_set(uint32_t n) {
    static vector line[LARGEST];
    make_set(n, line);
    for (uint32_t k = 0; k < n; k++)
        for (int axis = 0; axis < 3 && line[k][2] < 0; axis++) line[k][axis] = -line[k][axis];
    choose_senses(n, (const vector *)line);
    printf("#if FIBRAD_TABLE_LINES >= %" PRIu32 "\n", n);
    for (uint32_t k = 0; k < n; k++) {
        write_line(line[k]);
        if (k % 4 == 3 || k == n - 1) printf("\n");
    }
    printf("#endif\n");
}

int main(void) {
    printf("/* line_table.c - lines spread evenly, written by host/tables/generate_lines.c. "
           "SPDX-License-Identifier: MIT */\n#include \"sample/tables.h\"\n\n/* clang-format off */\n"
           "#if FIBRAD_TABLE_LINES >= 8\n_Alignas(64) const int32_t fibrad_table_lines[][2] = {\n");
    for (int i = 0; i < SIZE_COUNT; i++) write_set(SIZES[i]);
    printf("};\n");
    write_senses();
    printf("#endif\n");
    return fflush(stdout) != 0 || ferror(stdout) != 0;
}
