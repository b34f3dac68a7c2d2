/* sizes.c - what a library says of its structures is what its headers say. SPDX-License-Identifier: MIT */
#include <fibrad_host.h>

#include <stdio.h>

static int faults;

#define CHECK(name)                                                                                                    \
    if (fibrad_host_sizeof(#name) != sizeof(name))                                                                     \
    faults++, printf("%s: %zu instead of %zu bytes\n", #name, fibrad_host_sizeof(#name), sizeof(name))

int main(void) {
#include "structures.inc"
    if (fibrad_host_sizeof("fibrad_scene") || fibrad_host_sizeof("") || fibrad_host_sizeof(NULL)) faults++;
    return faults != 0;
}
