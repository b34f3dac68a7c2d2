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
static const uint64_t PINNED = 0xc1afced1b836fd1c;

enum { LARGEST = 1024 };
static vector line[LARGEST];

static const uint32_t SETS[] = {8, 11, 16, 23, 32, 45, 55, 64, 91, 100, 128, 181, 233, 256, 362, 512, 724, 1024};
enum { SET_COUNT = sizeof SETS / sizeof SETS[0] };

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

TEST(sets_are_those_that_the_header_names) {
    int next = 0;
    for (uint32_t n = 0; n <= LARGEST; n++) {
        ck_assert_uint_eq(fibrad_lines_next(n), SETS[next]);
        if (n == SETS[next]) next++;
    }
    ck_assert_uint_eq(fibrad_lines_next(LARGEST + 1), 0);
    ck_assert_uint_eq(fibrad_lines_next(UINT32_MAX), 0);
}

/* Discrepancies are 0.568 for the best sets of any size, and 0.580 for tables, whose halves are even, too. They are
 * 0.605 for half a Fibonacci set and 0.814 for a Fibonacci set. */
LOOP_TEST(sets_are_even, SET_COUNT) {
    const uint32_t n = SETS[_i];
    fibrad_lines_read(n, line);
    check_lengths(n);
    const double whole = discrepancy(n, 0, 1), even = discrepancy(n, 0, 2), odd = discrepancy(n, 1, 2);
    take_fibonacci(n, 2 * n);
    ck_assert_double_lt(whole, n < 32 ? 0.61 : 0.585);
    ck_assert_double_lt(fmax(even, odd), n < 32 ? 0.68 : 0.615);
    ck_assert_double_lt(whole, 0.985 * discrepancy(n, 0, 1));
    take_fibonacci(n, n);
    ck_assert_double_lt(whole, 0.8 * discrepancy(n, 0, 1));
}

static const uint32_t SOME[] = {55, 100, 233, 512};

LOOP_TEST(harmonics_are_integrated_better_than_by_directions, 4) {
    const uint32_t n = SOME[_i];
    const int most = (int)(0.7 * sqrt(n));
    fibrad_lines_read(n, line);
    const double lines = harmonics(n, most);
    take_fibonacci(n, n);
    ck_assert_double_lt(lines, 0.55 * harmonics(n, most));
}

LOOP_TEST(shadows_have_less_error, 4) {
    const uint32_t n = SOME[_i];
    fibrad_lines_read(n, line);
    const double whole = shadow_error(n, 0, 1), even = shadow_error(n, 0, 2), odd = shadow_error(n, 1, 2);
    take_fibonacci(n, n);
    ck_assert_double_lt(whole, 0.65 * shadow_error(n, 0, 1));
    ck_assert_double_lt(fmax(even, odd), 0.9 * shadow_error(n, 0, 2));
    take_fibonacci(n, 2 * n);
    ck_assert_double_lt(whole, 0.65 * shadow_error(n, 0, 1));
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
    uint64_t hash = 0xcbf29ce484222325;
    for (int i = 0; i < SET_COUNT; i++) {
        fibrad_lines_read(SETS[i], line);
        hash = hash_of(hash, line[0], 3 * (size_t)SETS[i]);
    }
    ck_assert_msg(hash == PINNED, "hash %#llx", (unsigned long long)hash);
}
