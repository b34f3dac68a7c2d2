/* interrupt.c - Ctrl-C and kill end the program cleanly. SPDX-License-Identifier: MIT */

#include <signal.h>
#include <unistd.h>

#include "cli/message.h"

#define GRACE 2 /* seconds */

enum { FILES = 16 };

static volatile sig_atomic_t caught;
static const char *volatile temporary[FILES];

static void note_signal(int number) {
    if (caught) { /* second signal, or alarm: a single row may take minutes */
        for (int k = 0; k < FILES; ++k)
            if (temporary[k]) unlink(temporary[k]);
        static const char text[] = "fibrad: interrupted\n";
        const ssize_t written = write(STDERR_FILENO, text, sizeof text - 1);
        (void)written; /* an error could not be reported */
        _exit(STATUS_SIGNAL + caught);
    }
    caught = number;
    alarm(GRACE);
}

/* Without SA_RESTART a read that waits for input returns. */
void interrupt_catch(void) {
    struct sigaction action = {.sa_handler = note_signal};
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    sigaction(SIGHUP, &action, NULL);
    sigaction(SIGALRM, &action, NULL);
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);
}

int interrupt_status(void) { return caught ? STATUS_SIGNAL + caught : 0; }

void interrupt_guard(const char *path) {
    for (int k = 0; k < FILES; ++k)
        if (!temporary[k]) {
            temporary[k] = path;
            return;
        }
}

void interrupt_unguard(const char *path) {
    for (int k = 0; k < FILES; ++k)
        if (temporary[k] == path) temporary[k] = NULL;
}
