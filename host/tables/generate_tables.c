/* generate_tables.c - writes the kernel's tables of Fibonacci samples to standard output.
 * SPDX-License-Identifier: MIT
 *
 * All numbers are computed in fixed point with 224 binary places, from whole numbers alone: pi by Machin's formula,
 * the golden angle from sqrt 5. Each entry is rounded once at the end. The program uses no inexact floating-point
 * operation and no libm. So all machines and compilers write the same file, and each entry is the true value
 * correctly rounded. With long double, one entry in 2000 would be wrong on some machines, because it would be
 * rounded twice. */
#include "sample/tables.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

/* ---- fixed point ----------------------------------------------------------------------------------------------- */

/* Unsigned, the most significant word first: 32 bits before the binary point, 224 after it. */
enum { WORDS = 8 };
typedef struct fixed {
    uint32_t word[WORDS];
} fixed;

static const fixed ZERO = {{0}}, ONE = {{1}};

static fixed plus(fixed a, fixed b) {
    uint64_t carry = 0;
    for (int i = WORDS - 1; i >= 0; i--) {
        carry += (uint64_t)a.word[i] + b.word[i];
        a.word[i] = (uint32_t)carry;
        carry >>= 32;
    }
    return a;
}

static fixed minus(fixed a, fixed b) {
    uint64_t borrow = 0;
    for (int i = WORDS - 1; i >= 0; i--) {
        uint64_t difference = (uint64_t)a.word[i] - b.word[i] - borrow;
        a.word[i] = (uint32_t)difference;
        borrow = difference >> 63;
    }
    return a;
}

static fixed times_small(fixed a, uint32_t factor) {
    uint64_t carry = 0;
    for (int i = WORDS - 1; i >= 0; i--) {
        carry += (uint64_t)a.word[i] * factor;
        a.word[i] = (uint32_t)carry;
        carry >>= 32;
    }
    return a;
}

static fixed over_small(fixed a, uint32_t divisor) {
    uint64_t rest = 0;
    for (int i = 0; i < WORDS; i++) {
        rest = rest << 32 | a.word[i];
        a.word[i] = (uint32_t)(rest / divisor);
        rest %= divisor;
    }
    return a;
}

static fixed times(fixed a, fixed b) {
    uint32_t product[2 * WORDS] = {0};
    for (int i = WORDS - 1; i >= 0; i--) {
        uint64_t carry = 0;
        for (int j = WORDS - 1; j >= 0; j--) {
            carry += (uint64_t)a.word[i] * b.word[j] + product[i + j + 1];
            product[i + j + 1] = (uint32_t)carry;
            carry >>= 32;
        }
        product[i] = (uint32_t)carry;
    }
    fixed result;
    for (int i = 0; i < WORDS; i++) result.word[i] = product[i + 1];
    return result;
}

static int less(fixed a, fixed b) {
    int i = 0;
    while (i < WORDS - 1 && a.word[i] == b.word[i]) i++;
    return a.word[i] < b.word[i];
}

static int is_zero(fixed a) { return !less(ZERO, a); }

/* Square root of x < 2^31, bit by bit. */
static fixed root(fixed x) {
    fixed result = ZERO;
    if (is_zero(x)) return result; /* the squares of the last 112 places are 0 */
    for (int place = 16; place < 32 * WORDS; place++) {
        fixed trial = result;
        trial.word[place / 32] |= 0x80000000u >> place % 32;
        if (!less(x, times(trial, trial))) result = trial;
    }
    return result;
}

/* ---- trigonometry ---------------------------------------------------------------------------------------------- */

static fixed pi, over_pi, golden; /* golden: the golden angle as a fraction of a turn */

static fixed arctangent_of_inverse(uint32_t n) {
    fixed sum = ZERO, power = over_small(ONE, n);
    for (uint32_t k = 1; !is_zero(power); k += 2) {
        fixed term = over_small(power, k);
        sum = k % 4 == 1 ? plus(sum, term) : minus(sum, term);
        power = over_small(power, n * n);
    }
    return sum;
}

static void prepare(void) {
    pi = times_small(minus(times_small(arctangent_of_inverse(5), 4), arctangent_of_inverse(239)), 4);
    over_pi = over_small(ONE, 3);
    for (int i = 0; i < 8; i++) over_pi = times(over_pi, minus(times_small(ONE, 2), times(pi, over_pi)));
    golden = over_small(minus(times_small(ONE, 3), root(times_small(ONE, 5))), 2);
}

/* A number with a sign. */
typedef struct real {
    fixed size;
    int negative;
} real;

typedef struct angle {
    real cos, sin;
} angle;

/* Cosine and sine of a fraction of a turn. Whole turns make no difference. */
static angle angle_of(fixed turn) {
    fixed quarters = times_small(turn, 4);
    uint32_t quadrant = quarters.word[0] % 4;
    quarters.word[0] = 0;
    fixed x = over_small(times(quarters, pi), 2), term = ONE, sum[2] = {ZERO, ZERO}; /* cosine, sine */
    for (uint32_t k = 0; !is_zero(term); k++) {
        sum[k % 2] = k % 4 < 2 ? plus(sum[k % 2], term) : minus(sum[k % 2], term);
        term = over_small(times(term, x), k + 1);
    }
    return (angle){.cos = {sum[quadrant % 2], quadrant == 1 || quadrant == 2},
                   .sin = {sum[1 - quadrant % 2], quadrant >= 2}};
}

/* The cosine and sine of k golden angles. */
static angle azimuth(uint32_t k) { return angle_of(times_small(golden, k)); }

/* ---- rounding and writing -------------------------------------------------------------------------------------- */

/* x rounded to nearest even with the given number of bits, at most 53. *rest: out: the rest; NULL: not wanted. */
static double rounded(real x, int bits, double *rest) {
    if (rest != NULL) *rest = 0;
    if (is_zero(x.size)) return 0;
    int exponent = 31;
    for (; x.size.word[0] >> 31 == 0; exponent--) x.size = plus(x.size, x.size);
    uint64_t top = (uint64_t)x.size.word[0] << 32 | x.size.word[1], unit = UINT64_C(1) << (64 - bits);
    uint64_t kept = top & ~(unit - 1);
    fixed ulp = {{(uint32_t)(unit >> 32), (uint32_t)unit}}, below = x.size;
    below.word[0] = (uint32_t)((top - kept) >> 32);
    below.word[1] = (uint32_t)(top - kept);
    fixed above = minus(ulp, below);
    int up = less(above, below) || (!less(below, above) && (kept & unit) != 0);
    double sign = x.negative ? -1 : 1;
    if (rest != NULL) {
        real left = {up ? above : below, x.negative != up};
        *rest = ldexp(rounded(left, 53, NULL), exponent - 31);
    }
    return sign * ldexp((double)(kept / unit + (uint64_t)up), exponent + 1 - bits);
}

static double to_double(real x) { return rounded(x, 53, NULL); }
static double to_float(real x) { return rounded(x, 24, NULL); }

static void write_azimuths(void) {
    static const uint32_t sizes[] = {0, 256, 1024, 4096, 10946};
    uint32_t k = 0;
    printf("\n#if FIBRAD_TABLE_AZIMUTHS > 0\n"
           "_Alignas(64) const double fibrad_table_azimuth[FIBRAD_TABLE_AZIMUTHS][2] = {\n");
    for (int i = 1; i < 5; i++) {
        if (i > 1) printf("#if FIBRAD_TABLE_AZIMUTHS > %" PRIu32 "\n", sizes[i - 1]);
        for (; k < sizes[i]; k++) {
            angle a = azimuth(k);
            printf("{%a, %a},\n", to_double(a.cos), to_double(a.sin));
        }
        if (i > 1) printf("#endif\n");
    }
    printf("};\n#endif\n");
}

static void write_long_angles(const char *name, uint32_t count, uint32_t stride) {
    printf("\nconst fibrad_long_angle fibrad_table_%s[%" PRIu32 "] = {\n", name, count);
    for (uint32_t k = 0; k < count; k++) {
        angle a = azimuth(stride * k);
        double cos_rest, sin_rest, cos = rounded(a.cos, 53, &cos_rest), sin = rounded(a.sin, 53, &sin_rest);
        printf("{%a, %a, %a, %a},\n", cos, cos_rest, sin, sin_rest);
    }
    printf("};\n");
}

static void write_disc_points(char axis) {
    printf("\n_Alignas(64) const float fibrad_table_disc_%c[448] = {\n", axis);
    for (uint32_t count = 64; count <= 256; count *= 2) {
        for (uint32_t k = 0; k < count; k++) {
            angle a = azimuth(k);
            real x = axis == 'x' ? a.cos : a.sin;
            x.size = times(x.size, root(over_small(times_small(ONE, 2 * k + 1), 2 * count)));
            printf("%af,\n", to_float(x));
        }
    }
    printf("};\n");
}

typedef struct node {
    double z, ring, cos, sin, weight;
} node;

/* Node k = 1 ... n of the surface rule of n nodes. before: the Fibonacci number before n. */
static node surface_node(uint32_t k, uint32_t n, uint32_t before) {
    int south = 2 * k < n;
    fixed z = over_small(times_small(ONE, south ? n - 2 * k : 2 * k - n), n); /* the absolute value; tau is odd */
    angle polar = angle_of(over_small(z, 2));
    real tau = {plus(z, times(polar.sin.size, over_pi)), south};
    real ring = {root(minus(ONE, times(tau.size, tau.size))), 0};
    real weight = {polar.cos.negative ? minus(ONE, polar.cos.size) : plus(ONE, polar.cos.size), 0};
    angle around = angle_of(over_small(times_small(ONE, k * before % n), n));
    return (node){to_double(tau), to_double(ring), to_double(around.cos), to_double(around.sin), to_double(weight)};
}

static void write_surface(const char *name, int member) {
    printf("\n_Alignas(64) const double fibrad_table_surface_%s[] = {\n", name);
    for (uint32_t before = 5, n = 8, sum; n <= 987; sum = before + n, before = n, n = sum) {
        printf("#if FIBRAD_TABLE_SURFACE >= %" PRIu32 "\n", n);
        for (uint32_t k = 1; k <= (n + 7) / 8 * 8; k++) {
            node p = k <= n ? surface_node(k, n, before) : (node){1, 0, 1, 0, 0};
            const double value[] = {p.z, p.ring, p.cos, p.sin, p.weight};
            printf("%a,\n", value[member]);
        }
        printf("#endif\n");
    }
    printf("};\n");
}

int main(void) {
    prepare();
    printf("/* tables.c - Fibonacci samples, written by host/tables/generate_tables.c; see kernel/sample/tables.h. "
           "SPDX-License-Identifier: MIT */\n#include \"sample/tables.h\"\n");
    printf("\n#if FIBRAD_TABLE_AZIMUTHS != 0 && FIBRAD_TABLE_AZIMUTHS != 256 && FIBRAD_TABLE_AZIMUTHS != 1024 && \\\n"
           "    FIBRAD_TABLE_AZIMUTHS != 4096 && FIBRAD_TABLE_AZIMUTHS != 10946\n"
           "#error \"FIBRAD_TABLE_AZIMUTHS must be 0, 256, 1024, 4096 or 10946\"\n#endif\n");
    write_azimuths();
    write_long_angles("near", FIBRAD_TABLE_STRIDE, 1);
    write_long_angles("far", FIBRAD_DIRECTIONS_MAX / FIBRAD_TABLE_STRIDE, FIBRAD_TABLE_STRIDE);
    write_disc_points('x');
    write_disc_points('y');
    static const char *const members[] = {"z", "ring", "cos", "sin", "weight"};
    printf("\n#if FIBRAD_TABLE_SURFACE > 0\n");
    for (int i = 0; i < 5; i++) write_surface(members[i], i);
    printf("#endif\n");
    return fflush(stdout) != 0 || ferror(stdout) != 0;
}
