/* memory.h - whether there is memory, or disk, enough, before the work begins. SPDX-License-Identifier: MIT */
#ifndef MEMORY_H
#define MEMORY_H

/* Bytes that this program may still take: what the system has left, within the limit on address space. Infinity where
 * neither is known. */
double memory_left(void);

/* STATUS_OK, or STATUS_MEMORY after a message that says how much is wanted, how much is left, and what would help. */
int memory_check(double bytes, const char *what_would_help);

/* Bytes that the disk of a folder has left. Infinity where that is not known. */
double disk_left(const char *folder);

/* STATUS_OK, or STATUS_FILE after a message that says how much is wanted and how much is left. */
int disk_check(const char *folder, double bytes);

#endif
