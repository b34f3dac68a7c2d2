/* aarch64.c - start of an aarch64 program without a C library; text and exit status by Linux calls, for the user-mode
 * emulator. SPDX-License-Identifier: MIT */
#include "smoke.h"

static long call(long number, long first, const void *second, long third) {
    register long x0 __asm__("x0") = first;
    register const void *x1 __asm__("x1") = second;
    register long x2 __asm__("x2") = third;
    register long x8 __asm__("x8") = number;
    __asm__ volatile("svc #0" : "+r"(x0) : "r"(x1), "r"(x2), "r"(x8) : "memory");
    return x0;
}

#include "linux.h"
