/* arm.c - start of a Cortex-M7 and semihosting: text and exit status go to the debugger. SPDX-License-Identifier: MIT
 */
#include <stdint.h>

#include "smoke.h"

extern uint32_t stack_top[], data_load[], data_start[], data_end[], bss_start[], bss_end[];

static uint32_t semihosting(uint32_t operation, const void *argument) {
    register uint32_t r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

void smoke_write(const char *text) { semihosting(0x04, text); }

__attribute__((noreturn)) static void leave(uint32_t status) {
    const uint32_t exit_extended[2] = {0x20026, status};
    for (;;) semihosting(0x20, exit_extended);
}

void reset(void);
void fault(void);

void reset(void) {
    *(volatile uint32_t *)0xe000ed88 |= 0xf << 20; /* floating-point unit on */
    __asm__ volatile("dsb\n isb");
    const uint32_t *from = data_load;
    for (uint32_t *to = data_start; to < data_end;) *to++ = *from++;
    for (uint32_t *to = bss_start; to < bss_end;) *to++ = 0;
    leave((uint32_t)smoke());
}

void fault(void) { leave(99); }

__attribute__((section(".vectors"), used)) static const void *const vectors[] = {stack_top, reset, fault, fault,
                                                                                 fault,     fault, fault};
