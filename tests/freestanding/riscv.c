/* riscv.c - start of a RV64 program without a C library; text and exit status by Linux calls, for the user-mode
 * emulator. SPDX-License-Identifier: MIT */
#include "smoke.h"

static long call(long number, long first, const void *second, long third) {
    register long a0 __asm__("a0") = first;
    register const void *a1 __asm__("a1") = second;
    register long a2 __asm__("a2") = third;
    register long a7 __asm__("a7") = number;
    __asm__ volatile("ecall" : "+r"(a0) : "r"(a1), "r"(a2), "r"(a7) : "memory");
    return a0;
}

#include "linux.h"
