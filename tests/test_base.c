/* test_base.c - arena, port header, choice of the instruction set, and the tests' own worst_of.
 * SPDX-License-Identifier: MIT */
#include "base/arena.h"
#include "base/dispatch.h"
#include "base/port.h"
#include "suite.h"
#include "worst.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* An object as the kernel lays it out: a head and two arrays. */
typedef struct object {
    double *a;
    char *b;
} object;

static object layout(fibrad_arena *arena, size_t n, object **head) {
    *head = fibrad_arena_take(arena, 1, sizeof(object));
    object o;
    o.a = fibrad_arena_take(arena, n, sizeof *o.a);
    o.b = fibrad_arena_take(arena, n, sizeof *o.b);
    return o;
}

static size_t size_of(size_t n) {
    fibrad_arena counting = {0};
    object *head;
    layout(&counting, n, &head);
    ck_assert_ptr_null(head);
    return fibrad_arena_total(&counting);
}

TEST(arena_counts_what_it_hands_out) {
    for (size_t n = 0; n < 200; n++) {
        const size_t size = size_of(n), offset = n % FIBRAD_ALIGNMENT; /* every offset from a boundary comes up */
        OWNED unsigned char *whole = aligned_alloc(FIBRAD_ALIGNMENT, (size / FIBRAD_ALIGNMENT + 4) * FIBRAD_ALIGNMENT);
        unsigned char *block = whole + FIBRAD_ALIGNMENT + offset;
        memset(whole, 0x5a, (size / FIBRAD_ALIGNMENT + 4) * FIBRAD_ALIGNMENT);
        fibrad_arena arena;
        object *head;
        assert_ok(fibrad_arena_open(&arena, block, size, size));
        object o = layout(&arena, n, &head);
        ck_assert_uint_le(arena.used, arena.size);
        ck_assert_uint_eq(arena.used + FIBRAD_ALIGNMENT - 1, size);
        ck_assert((unsigned char *)head >= block && (unsigned char *)head < block + FIBRAD_ALIGNMENT);
        ck_assert_uint_eq((uintptr_t)head % FIBRAD_ALIGNMENT, 0);
        ck_assert_uint_eq((uintptr_t)o.a % FIBRAD_ALIGNMENT, 0);
        ck_assert_uint_eq((uintptr_t)o.b % FIBRAD_ALIGNMENT, 0);
        ck_assert((unsigned char *)o.a >= (unsigned char *)(head + 1));
        ck_assert((unsigned char *)o.b >= (unsigned char *)(o.a + n));
        ck_assert((unsigned char *)(o.b + n) <= block + size);
        *head = o;
        memset(o.a, 0, n * sizeof *o.a);
        memset(o.b, 0, n * sizeof *o.b);
        for (size_t i = 0; i < FIBRAD_ALIGNMENT; i++) ck_assert_uint_eq(block[size + i], 0x5a);
        for (size_t i = 0; i < FIBRAD_ALIGNMENT + offset; i++) ck_assert_uint_eq(whole[i], 0x5a);
    }
}

TEST(arena_refuses_what_it_cannot_hold) {
    static _Alignas(FIBRAD_ALIGNMENT) unsigned char block[256];
    fibrad_arena arena = {block, 0, sizeof block};
    ck_assert_ptr_eq(fibrad_arena_take(&arena, 1, 65), block);
    ck_assert_ptr_eq(fibrad_arena_take(&arena, 128, 1), block + 128);
    ck_assert_ptr_null(fibrad_arena_take(&arena, 1, 1));
    ck_assert_uint_eq(fibrad_arena_total(&arena), 320 + 63);
    assert_invalid(fibrad_arena_open(&arena, NULL, 256, 64));
    assert_invalid(fibrad_arena_open(&arena, block, 256, 0));
    ck_assert_int_eq(fibrad_arena_open(&arena, block, 256, 320), FIBRAD_E_SIZE);
    ck_assert_int_eq(fibrad_arena_open(&arena, block, 255, 256), FIBRAD_E_SIZE);
    assert_ok(fibrad_arena_open(&arena, block, 256, 256));
    assert_ok(fibrad_arena_open(&arena, block + 8, 248, 248));
    ck_assert_ptr_eq(fibrad_arena_take(&arena, 1, 1), block + 64);
    ck_assert_ptr_eq(fibrad_arena_take(&arena, 2, 64), block + 128);
    ck_assert_ptr_null(fibrad_arena_take(&arena, 1, 1));
}

TEST(arena_sums_that_overflow_count_as_no_size) {
    static const struct {
        size_t count, bytes;
    } huge[] = {{SIZE_MAX, 1}, {SIZE_MAX, 8},        {SIZE_MAX / 2 + 1, 2}, {SIZE_MAX / 8, 8},   {SIZE_MAX - 63, 1},
                {1, SIZE_MAX}, {SIZE_MAX, SIZE_MAX}, {SIZE_MAX - 100, 1},   {SIZE_MAX - 127, 1}, {2, SIZE_MAX - 63}};
    for (size_t i = 0; i < sizeof huge / sizeof huge[0]; i++) {
        fibrad_arena arena = {0};
        fibrad_arena_take(&arena, 1, 1);
        fibrad_arena_take(&arena, huge[i].count, huge[i].bytes);
        ck_assert_uint_eq(fibrad_arena_total(&arena), 0);
        fibrad_arena_take(&arena, 1, 1);
        ck_assert_uint_eq(fibrad_arena_total(&arena), 0);
    }
}

TEST(floor_agrees_with_the_c_library) {
    static const double values[] = {0,
                                    -0.5,
                                    0.5,
                                    1,
                                    -1,
                                    1.5,
                                    -1.5,
                                    0x1p31,
                                    -0x1p31 - 0.5,
                                    0x1p52,
                                    1e300,
                                    -1e300,
                                    DBL_MAX,
                                    -DBL_MAX,
                                    DBL_MIN,
                                    -DBL_MIN,
                                    0x1p52 - 0.5,
                                    -0x1p52 + 0.5,
                                    0x1p63,
                                    -0x1p63,
                                    5e-324,
                                    -5e-324,
                                    0.99999999999999989,
                                    -0.99999999999999989};
    for (size_t i = 0; i < sizeof values / sizeof values[0]; i++)
        ck_assert_double_eq(fibrad_floor(values[i]), floor(values[i]));
    for (int i = -4000; i < 4000; i++) ck_assert_double_eq(fibrad_floor(i * 0.125), floor(i * 0.125));
    ck_assert_double_nan(fibrad_floor(NAN));
    ck_assert_double_eq(fibrad_floor(INFINITY), INFINITY);
    ck_assert_double_eq(fibrad_floor(-INFINITY), -INFINITY);
}

TEST(port_does_what_it_says) {
    ck_assert(fibrad_finite(0) && fibrad_finite(DBL_MAX) && fibrad_finite(-DBL_MAX) && fibrad_finite(5e-324));
    ck_assert(!fibrad_finite(INFINITY) && !fibrad_finite(-INFINITY) && !fibrad_finite(NAN));
    ck_assert_double_eq(fibrad_abs(-3.5), 3.5);
    ck_assert(!signbit(fibrad_abs(-0.0)));
    ck_assert_double_eq(fibrad_min(1, 2), 1);
    ck_assert_double_eq(fibrad_max(1, 2), 2);
    for (int i = 0; i < 1000; i++) {
        double x = ldexp(1 + i * 1e-3, i - 500);
        ck_assert_double_eq(fibrad_sqrt(x), sqrt(x));
    }
    ck_assert_uint_eq(fibrad_count_bits(0), 0);
    ck_assert_uint_eq(fibrad_count_bits(UINT64_MAX), 64);
    for (uint32_t i = 0; i < 64; i++) {
        ck_assert_uint_eq(fibrad_count_bits(UINT64_C(1) << i), 1);
        ck_assert_uint_eq(fibrad_count_bits((UINT64_C(1) << i) - 1), i);
    }
    char from[] = "abcdef", to[] = "------";
    fibrad_copy(to + 1, from, 3);
    ck_assert_str_eq(to, "-abc--");
    fibrad_zero(to + 2, 4);
    ck_assert_mem_eq(to, "-a\0\0\0\0", 7);
}

/* Whether the operating system says that the processor offers an instruction set. -1: it says nothing. */
static int offered(const char *flag) {
    OWNED_FILE *file = fopen("/proc/cpuinfo", "r");
    char word[64];
    int found = 0, last = 0;
    if (file == NULL) return -1;
    while (!found && !last && fscanf(file, "%63s", word) == 1) {
        found = strcmp(word, flag) == 0;
        last = strcmp(word, "bugs") == 0;
    }
    return found;
}

TEST(best_instruction_set_is_what_the_machine_offers) {
    fibrad_isa best = fibrad_isa_best();
    ck_assert_int_eq(fibrad_isa_choose(FIBRAD_ISA_BEST), (int)best);
    ck_assert_int_eq(fibrad_isa_choose((int)best), (int)best);
    ck_assert_int_eq(fibrad_isa_choose(FIBRAD_ISA_SCALAR), FIBRAD_ISA_SCALAR);
    ck_assert_int_eq(fibrad_isa_choose(-1), -2); /* there is no such instruction set */
    ck_assert_int_eq(fibrad_isa_choose(FIBRAD_ISA_NEON + 1), -2);
    for (int isa = (int)best + 1; isa <= FIBRAD_ISA_NEON; isa++) ck_assert_int_eq(fibrad_isa_choose(isa), -1);
    for (int isa = FIBRAD_ISA_SCALAR; isa <= (int)best; isa++) /* a build may lack one below the best */
        ck_assert(fibrad_isa_choose(isa) == isa || fibrad_isa_choose(isa) == -1);
#ifdef __aarch64__
    ck_assert_int_eq(best, FIBRAD_ISA_NEON); /* all such machines have it, and no others */
#endif
    if (best >= FIBRAD_ISA_AVX2) ck_assert_int_ne(offered("avx2"), 0);
    if (best >= FIBRAD_ISA_AVX512) ck_assert_int_ne(offered("avx512vl"), 0);
}

TEST(worst_keeps_nan) {
    double worst = 0, least = 9;
    worst_of(&worst, 2), worst_of(&worst, 1), least_of(&least, 3), least_of(&least, 4);
    ck_assert_double_eq(worst, 2);
    ck_assert_double_eq(least, 3);
    worst_of(&worst, INFINITY), least_of(&least, -INFINITY);
    ck_assert_double_infinite(worst);
    worst_of(&worst, NAN), least_of(&least, NAN);
    ck_assert_double_nan(worst);
    worst_of(&worst, 1), worst_of(&worst, INFINITY), least_of(&least, 1), least_of(&least, -INFINITY);
    ck_assert_double_nan(worst);
    ck_assert_double_nan(least);
    ck_assert(!(worst <= 1e300) && !(least >= -1e300));
}
