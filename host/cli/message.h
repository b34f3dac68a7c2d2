/* message.h - what every host function may need: exit statuses, messages, signals, memory. SPDX-License-Identifier: MIT
 */
#ifndef MESSAGE_H
#define MESSAGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Host functions that can fail return 0 or one of these. Before they return an error they print one line on standard
 * error. */
enum exit_status {
    STATUS_OK = 0,
    STATUS_HELP = 1, /* an option asks for the help; never an exit status */
    STATUS_USAGE = 2,
    STATUS_INPUT = 3,
    STATUS_FILE = 4,
    STATUS_MEMORY = 5,
    STATUS_SIGNAL = 128 /* plus the signal's number */
};

/* Prints `fibrad: TEXT` and returns status. With STATUS_OK the text is a warning: it begins with "warning: " and is
 * kept. Control characters, which may come from a file, are printed as '?'. */
int message(int status, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Prints `fibrad: FILE:LINE: TEXT` and returns status. line 0: without LINE. */
int message_at(int status, const char *file, uint64_t line, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* Prints `fibrad: out of memory` and returns STATUS_MEMORY. */
int message_memory(void);

/* Warning number k from 0 on, without `fibrad: `. NULL: there are no more. At most 32 are kept. */
const char *message_warning(size_t k);
void message_forget_warnings(void);

/* Hands all further lines, without `fibrad: `, to a function instead of standard error. NULL: to standard error again.
 */
void message_redirect(void (*to)(void *context, const char *line), void *context);

/* From now on SIGINT, SIGTERM and SIGHUP are noted, for interrupt_status. Two seconds later, or at the next signal, the
 * process removes its guarded files and ends. A closed pipe and a file that is too large become errors of writing. */
void interrupt_catch(void);

/* Returns 0, or 128 + the number of the signal that has come. Long loops call it and return its value as their status.
 */
int interrupt_status(void);

/* Guards a temporary file, which must not outlive the process, until interrupt_unguard. The caller keeps the string. */
void interrupt_guard(const char *path);
void interrupt_unguard(const char *path);

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
