/* memory.h - checks, before the work begins, whether memory or disk suffice; arrays that grow.
 * SPDX-License-Identifier: MIT */
#ifndef MEMORY_H
#define MEMORY_H

#include <stdbool.h>
#include <stddef.h>

/* Gives an array another size. Returns the array, which is as it was if there is no memory; *good is false then. */
void *memory_resized(void *array, size_t bytes, bool *good);

/* Makes room for element n of an array that has n elements, and whose room doubles when n is a power of 2. As
 * memory_resized. */
void *memory_grown(void *array, size_t n, size_t size, bool *good);

/* Bytes that this process may still allocate: those that the system has left, within the limit on address space.
 * INFINITY: neither is known. */
double memory_left(void);

/* Returns STATUS_OK, or STATUS_MEMORY after a message with the bytes wanted, the bytes left, and what would help. */
int memory_check(double bytes, const char *what_would_help);

/* Bytes that the disk of a folder has left. INFINITY: not known. */
double disk_left(const char *folder);

/* Returns STATUS_OK, or STATUS_FILE after a message with the bytes wanted and the bytes left. */
int disk_check(const char *folder, double bytes);

#endif
