/* cpu.c - which instruction sets this build and this machine offer. SPDX-License-Identifier: MIT
 *
 * CPUID tells what the processor can do. XGETBV tells which registers the operating system saves. Both must agree.
 * __builtin_cpu_supports is not used: it needs a constructor and a global variable of libgcc. */
#include "base/dispatch.h"

#include <stdbool.h>

#if defined(__x86_64__) || defined(__i386__)
#include <cpuid.h>

enum {
    LEAF1_EDX_SSE2 = 1 << 26,
    LEAF1_ECX_POPCNT = 1 << 23,
    LEAF1_ECX_OSXSAVE = 1 << 27,
    LEAF1_ECX_AVX = 1 << 28,
    LEAF7_EBX_AVX2 = 1 << 5,
    LEAF7_EBX_AVX512F = 1 << 16,
    LEAF7_EBX_AVX512DQ = 1 << 17,
    LEAF7_EBX_AVX512BW = 1 << 30,
    XCR0_YMM = 0x06, /* SSE and AVX state */
    XCR0_ZMM = 0xe6  /* the same and the three states of AVX-512 */
};
#define LEAF7_EBX_AVX512VL 0x80000000u

static bool all_bits(unsigned set, unsigned bits) { return (set & bits) == bits; }

static fibrad_isa isa_of_machine(void) {
    unsigned eax, ebx, ecx, edx, ebx7, ecx7, edx7, xcr0, xcr0_high;
    if (!__get_cpuid(1, &eax, &ebx, &ecx, &edx) || !all_bits(edx, LEAF1_EDX_SSE2)) return FIBRAD_ISA_SCALAR;
    if (!all_bits(ecx, LEAF1_ECX_POPCNT | LEAF1_ECX_OSXSAVE | LEAF1_ECX_AVX)) return FIBRAD_ISA_SSE2;
    __asm__ volatile("xgetbv" : "=a"(xcr0), "=d"(xcr0_high) : "c"(0));
    if (!all_bits(xcr0, XCR0_YMM) || !__get_cpuid_count(7, 0, &eax, &ebx7, &ecx7, &edx7) ||
        !all_bits(ebx7, LEAF7_EBX_AVX2))
        return FIBRAD_ISA_SSE2;
    if (!all_bits(xcr0, XCR0_ZMM) ||
        !all_bits(ebx7, LEAF7_EBX_AVX512F | LEAF7_EBX_AVX512DQ | LEAF7_EBX_AVX512BW | LEAF7_EBX_AVX512VL))
        return FIBRAD_ISA_AVX2;
    return FIBRAD_ISA_AVX512;
}
#elif defined(__aarch64__) /* every such processor has NEON */
static fibrad_isa isa_of_machine(void) { return FIBRAD_ISA_NEON; }
#else
static fibrad_isa isa_of_machine(void) { return FIBRAD_ISA_SCALAR; }
#endif

int fibrad_isa_built(int isa) {
    switch (isa) {
    case FIBRAD_ISA_BEST:
    case FIBRAD_ISA_SCALAR:
        return true;
#ifdef FIBRAD_WITH_SSE2
    case FIBRAD_ISA_SSE2:
        return true;
#endif
#ifdef FIBRAD_WITH_AVX2
    case FIBRAD_ISA_AVX2:
        return true;
#endif
#ifdef FIBRAD_WITH_AVX512
    case FIBRAD_ISA_AVX512:
        return true;
#endif
#ifdef FIBRAD_WITH_NEON
    case FIBRAD_ISA_NEON:
        return true;
#endif
    default:
        return false;
    }
}

fibrad_isa fibrad_isa_best(void) {
    int isa = (int)isa_of_machine();
    while (!fibrad_isa_built(isa)) isa--;
    return (fibrad_isa)isa;
}

int fibrad_isa_choose(int wish) {
    if (wish == FIBRAD_ISA_BEST) return (int)fibrad_isa_best();
    if (wish < FIBRAD_ISA_SCALAR || wish > FIBRAD_ISA_NEON) return -2;
    return fibrad_isa_built(wish) && wish <= (int)isa_of_machine() ? wish : -1;
}

const char *fibrad_isa_name(int isa) {
    static const char name[][8] = {"best", "scalar", "sse2", "avx2", "avx512", "neon"};
    return isa >= FIBRAD_ISA_BEST && isa <= FIBRAD_ISA_NEON ? name[isa] : "?";
}
