/* read_number.c - numbers from text, with the bits of strtod. SPDX-License-Identifier: MIT
 *
 * A mantissa of at most 53 bits and a power of ten up to 10^22 are both exact as doubles. So their product or quotient
 * is rounded once, and correctly (Clinger, How to read floating point numbers accurately, 1990). strtod reads all other
 * numbers. Fortran's exponents begin with D; strtod gets an e in its place. */
#include "text/read_number.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { POWERS = 23, DIGITS = 128 };

#define WHOLE_REAL 0x1p53 /* doubles have all whole numbers up to here */

static bool is_digit(char c) { return c >= '0' && c <= '9'; }

/* Reads digits into a mantissa. False: there may be too many. */
static bool take_digits(const char **text, uint64_t *mantissa, int *digits) {
    for (; is_digit(**text); ++*text, ++*digits) {
        if (*mantissa > UINT64_MAX / 10 - 1) return false;
        *mantissa = 10 * *mantissa + (uint64_t)(**text - '0');
    }
    return true;
}

/* Reads an exponent such as `e-5`, or `D-05` as Fortran writes it. False: it is not valid, or above 99. */
static bool take_exponent(const char **text, int *exponent) {
    const char mark = **text;
    if (mark != 'e' && mark != 'E' && mark != 'd' && mark != 'D') return true;
    const char sign = *++*text;
    uint64_t size = 0;
    int digits = 0;
    if (sign == '-' || sign == '+') ++*text;
    if (!take_digits(text, &size, &digits) || digits == 0 || size > 99) return false;
    *exponent += sign == '-' ? -(int)size : (int)size;
    return true;
}

static bool read_exact(const char *text, double *value) {
    static const double power[POWERS] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                         1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    const char sign = *text;
    uint64_t mantissa = 0;
    int before = 0, behind = 0, exponent = 0;
    if (sign == '-' || sign == '+') ++text;
    if (!take_digits(&text, &mantissa, &before)) return false;
    if (*text == '.') ++text;
    if (!take_digits(&text, &mantissa, &behind) || before + behind == 0) return false;
    if (!take_exponent(&text, &exponent) || *text) return false;
    exponent -= behind;
    if (mantissa > UINT64_C(1) << 53 || abs(exponent) >= POWERS) return false;
    const double size = exponent < 0 ? (double)mantissa / power[-exponent] : (double)mantissa * power[exponent];
    *value = sign == '-' ? -size : size;
    return true;
}

bool number_read(const char *text, double *value) {
    if ((FLT_EVAL_METHOD == 0 || FLT_EVAL_METHOD == 1) && read_exact(text, value)) return true;
    char *end, plain[DIGITS];
    *value = strtod(text, &end);
    if ((*end != 'd' && *end != 'D') || strlen(text) >= sizeof plain) return end != text && !*end;
    const size_t mantissa = (size_t)(end - text);
    strcpy(plain, text);
    plain[mantissa] = 'e';
    *value = strtod(plain, &end);
    return mantissa > 0 && !*end;
}

bool number_read_whole(const char *text, int64_t *value) {
    char *end;
    double real;
    errno = 0;
    *value = strtoll(text, &end, 10);
    if (end == text || errno) return false;
    if (!*end) return true;
    if (!strchr(".eEdD", *end) || !number_read(text, &real)) return false;
    if (!(fabs(real) <= WHOLE_REAL && real == floor(real))) return false;
    *value = (int64_t)real;
    return true;
}

int number_order(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}
