/* smoke.h - what the smoke program asks of its port, and what it offers. SPDX-License-Identifier: MIT */
#ifndef SMOKE_H
#define SMOKE_H

/* Writes a text. */
void smoke_write(const char *text);

/* Computes and writes; 0 if all went well. */
int smoke(void);

#endif
