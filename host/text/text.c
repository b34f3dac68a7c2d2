/* text.c - numbers and strings as text. SPDX-License-Identifier: MIT */
#include "text/text.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { DIGITS = 17 };

#ifdef __SIZEOF_INT128__
__extension__ typedef unsigned __int128 wide;

static wide power_of_5(int exponent) {
    wide power = 1;
    for (wide base = 5; exponent > 0; exponent >>= 1, base *= base)
        if (exponent & 1) power *= base;
    return power;
}

/* The number m 2^e 10^k as m 5^k and a shift, in whole numbers. */
struct scaled {
    wide product, five; /* m 5^k, 5^k */
    int shift;
};

static struct scaled scaled(uint64_t m, int e, int k) {
    const wide five = power_of_5(k);
    return (struct scaled){m * five, five, -(e + k)};
}

/* Rounds to a whole number, halves to even as printf does. */
static uint64_t scaled_rounded(const struct scaled *scaled) {
    const wide half = (wide)1 << (scaled->shift - 1), rest = scaled->product & (2 * half - 1);
    const uint64_t below = (uint64_t)(scaled->product >> scaled->shift);
    return below + (rest > half || (rest == half && below & 1));
}

/* Whether the digits read back as the same double: they are nearer to the number than half the distance to the next
 * double. edge: the number is a power of two, and the next double below is half as far. */
static bool reads_back(const struct scaled *scaled, uint64_t digits, bool edge) {
    const wide theirs = (wide)digits << scaled->shift;
    const wide off = theirs > scaled->product ? theirs - scaled->product : scaled->product - theirs;
    return (edge ? 4 : 2) * off < scaled->five;
}

/* Finds 17 digits of a number above 0, and the power of ten of the first digit. If 15 or 16 digits read back as the
 * same number, the last digits are 0. False: the number is too large or too small, since m 5^k would have more than 128
 * bits, k would be below 0 or no shift would be left. */
static bool digits_of(double value, uint64_t *digits, int *power) {
    int e;
    const uint64_t m = (uint64_t)ldexp(frexp(value, &e), 53);
    if (e < -52 || e > 46) return false;
    uint64_t missing = 100; /* power of ten of the digits that are not tried */
    for (int count = DIGITS - 2;; ++count, missing /= 10) {
        *power = (int)floor((e - 1) * 0.30102999566398120); /* the power, or one less */
        struct scaled all = scaled(m, e - 53, count - 1 - *power);
        if (scaled_rounded(&all) >= 100000000000000000 / missing) all = scaled(m, e - 53, count - 1 - ++*power);
        *digits = scaled_rounded(&all);
        if (count < DIGITS && !reads_back(&all, *digits, m == (uint64_t)1 << 52)) continue;
        *digits *= missing;
        return true;
    }
}
#else
static bool digits_of(double value, uint64_t *digits, int *power) {
    return (void)value, *digits = 0, *power = 0, false;
}
#endif

/* Does the work of text_real by printf, for numbers of any size. */
static int print_real(char *to, double value) {
    int used = 0;
    for (int digits = DIGITS - 2; digits <= DIGITS; ++digits) {
        used = snprintf(to, TEXT_NUMBER - 1, "%.*g", digits, value);
        if (strtod(to, NULL) == value) break;
    }
    return used;
}

/* Writes the last `count` digits of a number, the most significant one first. */
static char *put_digits(char *to, uint64_t number, int count) {
    for (int k = count - 1; k >= 0; --k, number /= 10) to[k] = (char)('0' + number % 10);
    return to + count;
}

char *text_whole(char *to, int64_t value) {
    uint64_t size = value < 0 ? -(uint64_t)value : (uint64_t)value;
    int count = 1;
    for (uint64_t rest = size; rest >= 10; rest /= 10) ++count;
    if (value < 0) *to++ = '-';
    return put_digits(to, size, count);
}

/* Writes digits with the point behind the first `before` ones, without zeros at the end. */
static char *put_point(char *to, const char *digits, int count, int before) {
    while (count > before && digits[count - 1] == '0') --count;
    memcpy(to, digits, (size_t)before);
    to += before;
    if (count == before) return to;
    *to++ = '.';
    memcpy(to, digits + before, (size_t)(count - before));
    return to + count - before;
}

char *text_real(char *to, double value) {
    enum { ZEROS = 4 }; /* largest number of zeros before the digits; smaller numbers have an exponent */
    char text[ZEROS + DIGITS] = "0000";
    uint64_t digits;
    int power;
    if (value < 0) {
        *to++ = '-';
        value = -value;
    }
    if (!(value > 0 && isfinite(value) && digits_of(value, &digits, &power))) return to + print_real(to, value);
    put_digits(text + ZEROS, digits, DIGITS);
    if (power >= 0) return put_point(to, text + ZEROS, DIGITS, power + 1);
    if (power >= -ZEROS) return put_point(to, text + ZEROS + power, DIGITS - power, 1);
    to = put_point(to, text + ZEROS, DIGITS, 1);
    *to++ = 'e';
    *to++ = '-';
    return put_digits(to, (uint64_t)-power, 2);
}

const char *names_list(char to[NAMES_LISTED], const char *const *names, size_t n) {
    enum { MORE = 24 }; /* room for the number of names */
    int used = snprintf(to, NAMES_LISTED, "%s", n > 0 ? "" : "none");
    for (size_t k = 0; k < n; ++k) {
        if (used + (int)strlen(names[k]) + 2 > NAMES_LISTED - MORE) {
            snprintf(to + used, (size_t)(NAMES_LISTED - used), " ... (%zu in all)", n);
            break;
        }
        used += snprintf(to + used, (size_t)(NAMES_LISTED - used), k > 0 ? ", %s" : "%s", names[k]);
    }
    return to;
}

void text_json(FILE *file, const char *text) {
    putc('"', file);
    for (; *text; ++text)
        if (*text == '"' || *text == '\\')
            fprintf(file, "\\%c", *text);
        else if ((unsigned char)*text < ' ')
            fprintf(file, "\\u%04x", (unsigned)*text);
        else
            putc(*text, file);
    putc('"', file);
}

void text_json_real(FILE *file, double value) {
    char text[TEXT_NUMBER] = "null";
    const char *end = isfinite(value) ? text_real(text, value) : text + 4;
    fwrite(text, 1, (size_t)(end - text), file);
}
