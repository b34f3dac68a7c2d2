/* output.c - files that get their names when they are complete. SPDX-License-Identifier: MIT */
#include "cli/output.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/interrupt.h"
#include "cli/message.h"

/* "before/after", or what there is of it. */
static bool join_path(char path[PATH_MAX], const char *before, int length, const char *after) {
    const int used = snprintf(path, PATH_MAX, "%.*s%s", length, before, after);
    if (used >= PATH_MAX) errno = ENAMETOOLONG;
    return used < PATH_MAX;
}

/* How much of a path names the folder, slash and all. */
static int folder_length(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? (int)(slash - path) + 1 : 0;
}

/* The one name of a file, which may be missing, with no symbolic link in it. False: errno tells why there is none. */
static bool target_of(const char *path, char target[PATH_MAX]) {
    char folder[PATH_MAX], link[PATH_MAX];
    if (realpath(path, target)) return true;
    if (errno != ENOENT) return false; /* links in a circle are ELOOP */
    const int length = folder_length(path);
    const ssize_t linked = readlink(path, link, sizeof link - 1);
    if (linked >= 0) {
        link[linked] = 0;
        return join_path(folder, path, link[0] == '/' ? 0 : length, link) && target_of(folder, target);
    }
    errno = ENOENT;
    return path[length] && join_path(folder, path, length, ".") && realpath(folder, link) &&
           join_path(folder, "/", 1, path + length) && join_path(target, link, PATH_MAX, folder);
}

static bool same_file(const struct stat *a, const struct stat *b) {
    return a->st_dev == b->st_dev && a->st_ino == b->st_ino;
}

bool output_same(const char *a, const char *b) {
    struct stat first, second;
    char one[PATH_MAX], other[PATH_MAX];
    if (strcmp(a, "-") == 0 || strcmp(b, "-") == 0) return false;
    if (stat(a, &first) == 0 && stat(b, &second) == 0) return same_file(&first, &second);
    return target_of(a, one) && target_of(b, other) && strcmp(one, other) == 0;
}

bool output_ends(const char *path, const char *ending) {
    const size_t length = path ? strlen(path) : 0, tail = strlen(ending);
    return length > tail && strcmp(path + length - tail, ending) == 0;
}

bool output_stdout(const char *path) {
    struct stat there, standard;
    return strcmp(path, "-") == 0 ||
           (stat(path, &there) == 0 && fstat(STDOUT_FILENO, &standard) == 0 && same_file(&there, &standard));
}

/* Opens a file of a name that nobody has, beside the target. False: errno tells why. */
static bool open_temporary(struct output *output) {
    const size_t room = strlen(output->target) + 64;
    int number = -1;
    output->temporary = malloc(room);
    errno = ENOMEM;
    for (int k = 0; output->temporary && number < 0 && k < 100; ++k) { /* O_EXCL: never someone else's file */
        snprintf(output->temporary, room, "%s.%ld-%d.tmp", output->target, (long)getpid(), k);
        number = open(output->temporary, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (number < 0 && errno != EEXIST) break;
    }
    output->file = number < 0 ? NULL : fdopen(number, "wb");
    if (output->file) interrupt_guard(output->temporary);
    return output->file;
}

int output_open(struct output *output, const char *path) {
    char target[PATH_MAX];
    struct stat there;
    *output = (struct output){.path = path};
    if (!path) return STATUS_OK;
    if (output_stdout(path)) {
        output->file = stdout;
        output->path = "standard output";
        return STATUS_OK;
    }
    const bool exists = stat(path, &there) == 0;
    if (exists && !S_ISREG(there.st_mode) && !S_ISCHR(there.st_mode) && !S_ISFIFO(there.st_mode))
        return message_at(STATUS_FILE, path, 0, "exists and is not a regular file");
    if (exists && !S_ISREG(there.st_mode)) {
        output->file = fopen(path, "wb");
        return output->file ? STATUS_OK : message_at(STATUS_FILE, path, 0, "%s", strerror(errno));
    }
    output->target = target_of(path, target) ? strdup(target) : NULL;
    if (output->target && open_temporary(output)) {
        if (exists) fchmod(fileno(output->file), there.st_mode & 07777);
        return STATUS_OK;
    }
    const int status = message_at(STATUS_FILE, path, 0, "%s", strerror(errno));
    free(output->temporary);
    free(output->target);
    *output = (struct output){0};
    return status;
}

/* Gives a complete file its name, else removes it. */
static int end_temporary(struct output *output, int status) {
    if (!status && rename(output->temporary, output->target) != 0)
        status = message_at(STATUS_FILE, output->path, 0, "%s", strerror(errno));
    if (status) unlink(output->temporary);
    interrupt_unguard(output->temporary);
    free(output->temporary);
    free(output->target);
    return status;
}

static int cannot_write(const struct output *output) {
    return message_at(STATUS_FILE, output->path, 0, "cannot be written: %s", strerror(errno));
}

int output_flush(const struct output *output) {
    const bool failed = ferror(output->file) != 0;
    return fflush(output->file) != 0 || failed ? cannot_write(output) : STATUS_OK;
}

int output_close(struct output *output, int status) {
    if (!output->file) return status;
    if (!status) status = output_flush(output);
    if (output->file != stdout && fclose(output->file) != 0 && !status) status = cannot_write(output);
    if (output->temporary) status = end_temporary(output, status);
    *output = (struct output){0};
    return status;
}
