/* interrupt.h - Ctrl-C and kill end the program cleanly. SPDX-License-Identifier: MIT */
#ifndef INTERRUPT_H
#define INTERRUPT_H

/* From now on SIGINT, SIGTERM and SIGHUP are noted, for interrupt_status. Two seconds later, or at the next signal, the
 * process removes its guarded files and ends. A closed pipe and a file that is too large become errors of writing. */
void interrupt_catch(void);

/* Returns 0, or 128 + the number of the signal that has come. Long loops call it and return its value as their status.
 */
int interrupt_status(void);

/* Guards a temporary file, which must not outlive the process, until interrupt_unguard. The caller keeps the string. */
void interrupt_guard(const char *path);
void interrupt_unguard(const char *path);

#endif
