/* test_lines.c - lines spread evenly. SPDX-License-Identifier: MIT */
#include "fibrad.h"
#include "sample/line.h"
#include "suite.h"
#include "worst.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef double vector[3];

/* of bits_are_pinned */
static const uint64_t PINNED = 0x58cfb04abfa3fa21;

enum { LARGEST = 2048 };
static vector line[FIBRAD_DIRECTIONS_MAX];
static double scratch[3 * LARGEST];

static const uint32_t TABLED[] = {8,   11,  16,  23,  32,  45,  55,  64,   91,   100,
                                  128, 181, 233, 256, 362, 512, 724, 1024, 1448, 2048};
enum { TABLED_COUNT = sizeof TABLED / sizeof TABLED[0] };

static double cosine(const vector p, const vector q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; }

/* Mean square error of the lines `first`, `first` + `by`, ... and their opposites over spherical caps (Stolarsky),
 * times the number of lines to the power 3/2. The error of the best sets falls with this power. */
static double discrepancy(uint32_t n, uint32_t first, uint32_t by) {
    double sum = 0;
    uint32_t count = 0;
    for (uint32_t i = first; i < n; i += by, count++) {
        sum += 2;
        for (uint32_t j = i + by; j < n; j += by) {
            double t = cosine(line[i], line[j]);
            sum += 4 * sqrt(1 + sqrt(fmax(0, 1 - t * t)));
        }
    }
    return (8.0 / 3 - sum / count / count) * pow(count, 1.5);
}

/* Mean square error over all harmonics of even degree from 2 to `most`. Each harmonic has the mean square 1. */
static double harmonics(uint32_t n, int most) {
    double sum = 0;
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t j = 0; j < n; j++) {
            double t = cosine(line[i], line[j]), before = 1, now = t;
            for (int l = 1; l < most; l++) {
                double next = ((2 * l + 1) * t * now - l * before) / (l + 1);
                before = now, now = next;
                if (l % 2 == 1) sum += (2 * l + 3) * now;
            }
        }
    return sum / n / n;
}

/* Area in which two unit discs overlap. Their centres are x apart. */
static double overlap(double x) { return x >= 2 ? 0 : 2 * acos(x / 2) - x / 2 * sqrt(4 - x * x); }

/* Overlap of the shadows of two unit spheres along direction d. The spheres are 2.5 apart, one behind the other along
 * a. */
static double shadow(const vector a, const vector d) {
    double t = cosine(a, d);
    return overlap(2.5 * sqrt(fmax(0, 1 - t * t)));
}

/* Relative root mean square error of the mean of shadow() over the lines `first`, `first` + `by`, ..., for 1,000
 * axes. */
static double shadow_error(uint32_t n, uint32_t first, uint32_t by) {
    enum { AXES = 1000, STEPS = 100000 };
    double truth = 0, square = 0;
    for (int k = 0; k < STEPS; k++) {
        double z = (k + 0.5) / STEPS;
        truth += overlap(2.5 * sqrt(1 - z * z)) / STEPS;
    }
    for (uint32_t k = 0; k < AXES; k++) {
        vector axis;
        double sum = 0;
        uint32_t count = 0;
        assert_ok(fibrad_direction(k, AXES, axis));
        for (uint32_t i = first; i < n; i += by, count++) sum += shadow(axis, line[i]);
        square += (sum / count / truth - 1) * (sum / count / truth - 1) / AXES;
    }
    return sqrt(square);
}

static void take_fibonacci(uint32_t n, uint32_t of) {
    for (uint32_t k = 0; k < n; k++) assert_ok(fibrad_direction(k, of, line[k]));
}

static void check_lengths(uint32_t n) {
    for (uint32_t k = 0; k < n; k++) ck_assert_double_le(fabs(sqrt(cosine(line[k], line[k])) - 1), 1e-15);
}

TEST(tables_are_those_that_the_header_names) {
    int found = 0;
    for (uint32_t n = 8; n <= FIBRAD_DIRECTIONS_MAX; n++)
        if (fibrad_lines_tabled(n)) ck_assert_uint_eq(TABLED[found++], n);
    ck_assert(found == TABLED_COUNT || TABLED[found] > FIBRAD_TABLE_LINES);
    ck_assert(!fibrad_lines_tabled(0) && !fibrad_lines_tabled(UINT32_MAX));
}

/* Discrepancies are 0.568 for the best sets of any size, and 0.580 for tables, whose halves are even, too. They are
 * 0.605 for half a Fibonacci set and 0.814 for a Fibonacci set. */
LOOP_TEST(tables_are_even, TABLED_COUNT) {
    const uint32_t n = TABLED[_i];
    const bool tabled = n <= FIBRAD_TABLE_LINES;
    fibrad_lines_make(n, line, tabled ? NULL : scratch);
    check_lengths(n);
    const double whole = discrepancy(n, 0, 1), even = discrepancy(n, 0, 2), odd = discrepancy(n, 1, 2);
    take_fibonacci(n, 2 * n);
    ck_assert_double_lt(whole, n < 32 ? 0.61 : tabled ? 0.585 : 0.595);
    ck_assert_double_lt(fmax(even, odd), n < 32 ? 0.68 : tabled ? 0.615 : 0.7);
    ck_assert_double_lt(whole, 0.985 * discrepancy(n, 0, 1));
    take_fibonacci(n, n);
    ck_assert_double_lt(whole, 0.8 * discrepancy(n, 0, 1));
}

TEST(any_number_is_nearly_as_even) {
    for (uint32_t n = 8; n <= 300; n++) {
        fibrad_lines_make(n, line, scratch);
        check_lengths(n);
        ck_assert_double_lt(discrepancy(n, 0, 1), n < 32 ? 0.615 : 0.595);
        ck_assert_double_lt(fmax(discrepancy(n, 0, 2), discrepancy(n, 1, 2)), n < 32 ? 0.72 : 0.68);
    }
}

/* Numbers of lines without a table, beside numbers with one. */
static const uint32_t BETWEEN[] = {55, 56, 99, 100, 233, 300, 511, 600};
enum { BETWEEN_COUNT = sizeof BETWEEN / sizeof BETWEEN[0] };

LOOP_TEST(harmonics_are_integrated_better_than_by_directions, BETWEEN_COUNT) {
    const uint32_t n = BETWEEN[_i];
    const int most = (int)(0.7 * sqrt(n));
    fibrad_lines_make(n, line, scratch);
    const double lines = harmonics(n, most);
    take_fibonacci(n, n);
    ck_assert_double_lt(lines, 0.55 * harmonics(n, most));
}

LOOP_TEST(shadows_have_less_error, BETWEEN_COUNT) {
    const uint32_t n = BETWEEN[_i];
    fibrad_lines_make(n, line, scratch);
    const double whole = shadow_error(n, 0, 1), even = shadow_error(n, 0, 2), odd = shadow_error(n, 1, 2);
    take_fibonacci(n, n);
    ck_assert_double_lt(whole, 0.65 * shadow_error(n, 0, 1));
    ck_assert_double_lt(fmax(even, odd), 0.9 * shadow_error(n, 0, 2));
    take_fibonacci(n, 2 * n);
    ck_assert_double_lt(whole, 0.65 * shadow_error(n, 0, 1));
}

TEST(many_lines_are_directions) {
    const uint32_t sizes[] = {LARGEST + 1, 10000, FIBRAD_DIRECTIONS_MAX};
    for (int i = 0; i < 3; i++) {
        fibrad_lines_make(sizes[i], line, NULL);
        for (uint32_t k = 0; k < sizes[i]; k++) {
            vector d;
            assert_ok(fibrad_direction(k, sizes[i], d));
            ck_assert_mem_eq(d, line[k], sizeof d);
        }
    }
}

/* FNV-1a over the bits of numbers, the lowest byte first. */
static uint64_t hash_of(uint64_t hash, const double *number, size_t count) {
    for (size_t k = 0; k < count; k++) {
        uint64_t bits;
        memcpy(&bits, &number[k], sizeof bits);
        for (int shift = 0; shift < 64; shift += 8) hash = (hash ^ (bits >> shift & 255)) * 0x100000001b3;
    }
    return hash;
}

TEST(bits_are_pinned) {
    const uint32_t sizes[] = {8, 9, 50, 99, 100, 101, 300, 1000, 2048};
    uint64_t hash = 0xcbf29ce484222325;
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        fibrad_lines_make(sizes[i], line, scratch);
        hash = hash_of(hash, line[0], 3 * (size_t)sizes[i]);
    }
    ck_assert_msg(hash == PINNED || FIBRAD_TABLE_LINES < LARGEST, "hash %#llx", (unsigned long long)hash);
}

TEST(exchanges_make_halves_more_even) {
    const uint32_t n = 150;
    const fibrad_line_steps steps = {100, 1.5, 0.8, 0};
    take_fibonacci(n, 2 * n);
    fibrad_lines_relax(n, line, (double(*)[3])scratch, &steps);
    const double whole = discrepancy(n, 0, 1), halves = discrepancy(n, 0, 2) + discrepancy(n, 1, 2);
    fibrad_lines_halve(n, line, scratch);
    ck_assert_double_le(fabs(discrepancy(n, 0, 1) - whole), 1e-9);
    ck_assert_double_lt(discrepancy(n, 0, 2) + discrepancy(n, 1, 2), 0.98 * halves);
}
