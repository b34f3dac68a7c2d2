/* message.h - exit statuses and the one line that tells what went wrong. SPDX-License-Identifier: MIT */
#ifndef MESSAGE_H
#define MESSAGE_H

#include <stddef.h>
#include <stdint.h>

/* Host functions that can fail return 0 or one of these, having told why on standard error. */
enum exit_status {
    STATUS_OK = 0,
    STATUS_HELP = 1, /* the help is wanted, which ends the reading of options; the program never exits with it */
    STATUS_USAGE = 2,
    STATUS_INPUT = 3,
    STATUS_FILE = 4,
    STATUS_MEMORY = 5,
    STATUS_SIGNAL = 128 /* plus the signal's number */
};

/* `fibrad: what is wrong`; returns status. With STATUS_OK it is a warning, which begins so and is kept. Control
 * characters, which may come from a file, are printed as '?'. */
int message(int status, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* `fibrad: FILE:LINE: what is wrong`, without LINE if that is 0; returns status. */
int message_at(int status, const char *file, uint64_t line, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* `fibrad: out of memory`; returns STATUS_MEMORY. */
int message_memory(void);

/* A warning that is kept, from 0 on, without `fibrad: `; NULL: there are no more. 32 are. */
const char *message_warning(size_t k);
void message_forget_warnings(void);

/* Gives all further lines, without `fibrad: `, to a function instead of standard error; NULL: no longer. */
void message_redirect(void (*to)(void *context, const char *line), void *context);

#endif
