/* host.c - the smoke program on a machine with a C library. SPDX-License-Identifier: MIT */
#include <stdio.h>

#include "smoke.h"

void smoke_write(const char *text) { fputs(text, stdout); }

int main(void) { return smoke(); }
