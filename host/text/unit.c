/* unit.c - units of quantities, as names of columns have them. SPDX-License-Identifier: MIT
 *
 * A unit becomes a factor and powers of m, kg, s and K. Units are the same kind of quantity if their powers are equal.
 * Some units can be read in more than one way: mK is a thousandth of a kelvin, but in W/mK it is metre times kelvin.
 * All readings are tried. One of them has the powers of the wanted unit, or none has. */
#include "text/unit.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { METRE, KILOGRAM, SECOND, KELVIN, BASES, NAME_MAX_LENGTH = 60, DEPTH_MAX = 4, POWER_LARGEST = 99 };

struct measure {
    double factor; /* without the power of ten */
    int ten;       /* power of ten */
    int power[BASES];
};

/* How a name is read. */
struct reading {
    bool apart;  /* letters without a separator are several units if possible: mK is m K */
    bool behind; /* all units behind a slash are below it: W/m K is W/(m K) */
};

static const struct symbol {
    const char *name;
    struct measure measure;
} symbols[] = {
    {"m", {1, 0, {1, 0, 0, 0}}},     {"g", {1, -3, {0, 1, 0, 0}}},      {"s", {1, 0, {0, 0, 1, 0}}},
    {"sec", {1, 0, {0, 0, 1, 0}}},   {"second", {1, 0, {0, 0, 1, 0}}},  {"seconds", {1, 0, {0, 0, 1, 0}}},
    {"min", {60, 0, {0, 0, 1, 0}}},  {"minute", {60, 0, {0, 0, 1, 0}}}, {"minutes", {60, 0, {0, 0, 1, 0}}},
    {"h", {3600, 0, {0, 0, 1, 0}}},  {"hour", {3600, 0, {0, 0, 1, 0}}}, {"hours", {3600, 0, {0, 0, 1, 0}}},
    {"d", {86400, 0, {0, 0, 1, 0}}}, {"day", {86400, 0, {0, 0, 1, 0}}}, {"days", {86400, 0, {0, 0, 1, 0}}},
    {"K", {1, 0, {0, 0, 0, 1}}},     {"C", {1, 0, {0, 0, 0, 1}}},       {"degC", {1, 0, {0, 0, 0, 1}}},
    {"W", {1, 0, {2, 1, -3, 0}}},    {"J", {1, 0, {2, 1, -2, 0}}},      {"N", {1, 0, {1, 1, -2, 0}}},
    {"L", {1, -3, {3, 0, 0, 0}}},    {"l", {1, -3, {3, 0, 0, 0}}},      {"1", {1, 0, {0, 0, 0, 0}}},
};

static const struct {
    char name;
    int ten;
} prefixes[] = {{0, 0}, {'k', 3}, {'M', 6}, {'G', 9}, {'c', -2}, {'m', -3}, {'u', -6}, {'n', -9}};

/* Signs of UTF-8, and of Latin-1 behind them, with their plain forms. */
static const struct {
    const char *sign, *plain;
} signs[] = {{"\302\267", "*"},     {"\342\213\205", "*"}, {"\302\262", "2"}, {"\302\263", "3"}, {"\302\271", "1"},
             {"\342\201\273", "-"}, {"\342\210\222", "-"}, {"\302\265", "u"}, {"\316\274", "u"}, {"\302\260", ""},
             {"\302\272", ""},      {"\342\204\203", "C"}, {"\267", "*"},     {"\262", "2"},     {"\263", "3"},
             {"\271", "1"},         {"\265", "u"},         {"\260", ""},      {"\272", ""}};

/* Copies a name with plain signs. False: it is too long. */
static bool make_plain(const char *name, char plain[NAME_MAX_LENGTH]) {
    size_t n = 0;
    while (*name) {
        size_t k = 0;
        while (k < sizeof signs / sizeof *signs && strncmp(name, signs[k].sign, strlen(signs[k].sign)) != 0) ++k;
        const bool known = k < sizeof signs / sizeof *signs;
        if (n + 1 >= NAME_MAX_LENGTH) return false;
        if (!known) plain[n++] = *name;
        if (known && *signs[k].plain) plain[n++] = *signs[k].plain;
        name += known ? strlen(signs[k].sign) : 1;
    }
    plain[n] = 0;
    return true;
}

/* Multiplies a measure by a power of another one. */
static void times_power(struct measure *m, const struct measure *by, int power) {
    m->factor *= pow(by->factor, power);
    m->ten += by->ten * power;
    for (int k = 0; k < BASES; ++k) m->power[k] += by->power[k] * power;
}

/* Finds a unit, with or without a prefix, by its whole name. */
static bool find_symbol(const char *name, size_t length, struct measure *m) {
    for (size_t p = 0; p < sizeof prefixes / sizeof *prefixes; ++p) {
        const size_t skip = prefixes[p].name != 0;
        if (skip && *name != prefixes[p].name) continue;
        for (size_t k = 0; k < sizeof symbols / sizeof *symbols; ++k) {
            if (strlen(symbols[k].name) != length - skip || memcmp(symbols[k].name, name + skip, length - skip) != 0)
                continue;
            *m = symbols[k].measure;
            m->ten += prefixes[p].ten;
            return true;
        }
    }
    return false;
}

/* Reads the power behind a unit: 3, -1, ^3 or **-1. */
static int take_power(const char **text) {
    const char *at = *text;
    char *end;
    if (*at == '^')
        ++at;
    else if (at[0] == '*' && at[1] == '*')
        at += 2;
    if (!isdigit((unsigned char)at[*at == '-'])) return 1;
    const long power = strtol(at, &end, 10);
    *text = end;
    return power > POWER_LARGEST || power < -POWER_LARGEST ? 0 : (int)power;
}

/* Reads a unit and its power. With how->apart, letters such as kgK are two units, of which the first has no power. */
static bool take_unit_power(const char **text, struct reading how, int sign, struct measure *m) {
    struct measure unit, first;
    size_t length = **text == '1';
    while (isalpha((unsigned char)(*text)[length])) ++length;
    const char *name = *text;
    *text += length;
    for (size_t cut = 1; how.apart && cut < length; ++cut) {
        if (!find_symbol(name, cut, &first) || !find_symbol(name + cut, length - cut, &unit)) continue;
        times_power(m, &first, sign);
        times_power(m, &unit, sign * take_power(text));
        return true;
    }
    if (length == 0 || !find_symbol(name, length, &unit)) return false;
    times_power(m, &unit, sign * take_power(text));
    return true;
}

/* Reads a product of units up to the end or to a closing bracket. */
static bool take_product(const char **text, struct reading how, int sign, int depth, struct measure *m) {
    int now = sign;
    for (bool any = false;;) {
        *text += strspn(*text, " \t*._");
        if (**text == 0 || **text == ')') return any;
        if (**text == '/') {
            ++*text;
            now = -sign;
            continue;
        }
        if (**text == '(') {
            ++*text;
            if (depth == DEPTH_MAX || !take_product(text, how, now, depth + 1, m) || *(*text)++ != ')') return false;
        } else if (!take_unit_power(text, how, now, m)) {
            return false;
        }
        any = true;
        if (!how.behind) now = sign;
    }
}

/* Reads a whole name. */
static bool read_measure(const char *name, struct reading how, struct measure *m) {
    *m = (struct measure){.factor = 1};
    return take_product(&name, how, 1, 0, m) && *name == 0;
}

bool unit_behind(const char *name, size_t *bare, const char **unit, size_t *length) {
    const size_t end = strlen(name);
    size_t open = end;
    for (int depth = 1; depth > 0;) {
        if (open-- == 0) return false;
        if (strchr("])", name[open]))
            depth += open < end - 1;
        else if (strchr("[(", name[open]))
            --depth;
        if (open == end - 1 && !strchr("])", name[open])) return false;
    }
    *unit = name + open + 1;
    *length = end - open - 2;
    *bare = open;
    while (*bare > 0 && strchr(" \t_", name[*bare - 1])) --*bare;
    const bool index = *bare == open && open > 0 && strspn(*unit, "0123456789") == *length; /* f_T[1] has no unit */
    return !index;
}

bool unit_is(const char *name, const char *unit) {
    static const struct {
        const char *name, *unit;
    } names[] = {{"C", "C"},      {"degC", "C"},   {"deg C", "C"}, {"Celsius", "C"}, {"celsius", "C"},
                 {"Kelvin", "K"}, {"kelvin", "K"}, {"K", "K"},     {"kelvins", "K"}};
    char plain[NAME_MAX_LENGTH];
    if (!make_plain(name, plain)) return false;
    for (size_t k = 0; k < sizeof names / sizeof *names; ++k)
        if (strcmp(plain, names[k].name) == 0) return strcmp(unit, names[k].unit) == 0;
    return false;
}

bool unit_temperature(const char *name) { return unit_is(name, "K") || unit_is(name, "C"); }

bool unit_none(const char *name) { return !*name || strcmp(name, "-") == 0 || strcmp(name, "1") == 0; }

bool unit_factor(const char *name, const char *wanted, double *factor) {
    char plain[NAME_MAX_LENGTH];
    struct measure from, to;
    *factor = 1;
    if (strcmp(wanted, "K") == 0 || strcmp(wanted, "C") == 0) return unit_is(name, wanted);
    if (!make_plain(name, plain) || !read_measure(wanted, (struct reading){0}, &to)) return false;
    for (int k = 0; k < 4; ++k) {
        const struct reading how = {.apart = k & 1, .behind = k & 2};
        if (!read_measure(plain, how, &from) || memcmp(from.power, to.power, sizeof to.power) != 0) continue;
        *factor = from.factor / to.factor;
        *factor = from.ten < to.ten ? *factor / pow(10, to.ten - from.ten) : *factor * pow(10, from.ten - to.ten);
        return true;
    }
    return false;
}
