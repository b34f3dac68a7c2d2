/* interrupt.h - Ctrl-C and kill end the program cleanly. SPDX-License-Identifier: MIT */
#ifndef INTERRUPT_H
#define INTERRUPT_H

/* From now on SIGINT, SIGTERM and SIGHUP are noted, and a closed pipe and a file grown too large are write errors. A
 * program that has not ended two seconds after the signal, or by the next one, is ended, and its guarded files go. */
void interrupt_catch(void);

/* 0, or 128 + the number of the signal that came. Loops that may last ask for it and return it as their status. */
int interrupt_status(void);

/* Names a temporary file that must not outlive the program; the string stays the caller's. Until it is unguarded. */
void interrupt_guard(const char *path);
void interrupt_unguard(const char *path);

#endif
