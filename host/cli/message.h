/* message.h - exit statuses, error messages and warnings. SPDX-License-Identifier: MIT */
#ifndef MESSAGE_H
#define MESSAGE_H

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

#endif
