/* output.c - files that get their names when they are complete. SPDX-License-Identifier: MIT */
#include "cli/output.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/interrupt.h"
#include "cli/message.h"

bool output_same(const char *a, const char *b) {
    struct stat first, second;
    return stat(a, &first) == 0 && stat(b, &second) == 0 && first.st_dev == second.st_dev &&
           first.st_ino == second.st_ino;
}

bool output_ends(const char *path, const char *ending) {
    const size_t length = path ? strlen(path) : 0, tail = strlen(ending);
    return length > tail && strcmp(path + length - tail, ending) == 0;
}

int output_open(struct output *output, const char *path) {
    *output = (struct output){.path = path};
    if (!path) return STATUS_OK;
    struct stat there;
    if (stat(path, &there) == 0 && !S_ISREG(there.st_mode))
        return message_at(STATUS_FILE, path, 0, "exists and is not a regular file");
    const size_t room = strlen(path) + 64;
    output->temporary = malloc(room);
    if (!output->temporary) return message_memory();
    int number = -1;
    for (int k = 0; number < 0 && k < 100; ++k) { /* O_EXCL: never someone else's file */
        snprintf(output->temporary, room, "%s.%ld-%d.tmp", path, (long)getpid(), k);
        number = open(output->temporary, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (number < 0 && errno != EEXIST) break;
    }
    output->file = number < 0 ? NULL : fdopen(number, "wb");
    interrupt_guard(output->temporary);
    if (output->file) return STATUS_OK;
    const int status = message_at(STATUS_FILE, path, 0, "%s", strerror(errno));
    interrupt_unguard(output->temporary);
    free(output->temporary);
    return status;
}

int output_close(struct output *output, int status) {
    if (!output->file) return status;
    const bool failed = ferror(output->file) != 0;
    if ((fclose(output->file) != 0 || failed) && !status)
        status = message_at(STATUS_FILE, output->path, 0, "cannot be written: %s", strerror(errno));
    if (!status && rename(output->temporary, output->path) != 0)
        status = message_at(STATUS_FILE, output->path, 0, "%s", strerror(errno));
    if (status) unlink(output->temporary);
    interrupt_unguard(output->temporary);
    free(output->temporary);
    *output = (struct output){0};
    return status;
}
