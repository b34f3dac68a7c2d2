/* output.c - files that get their names when they are complete. SPDX-License-Identifier: MIT */
#define _GNU_SOURCE /* O_TMPFILE; NOLINT(bugprone-reserved-identifier) */
#include "cli/output.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/message.h"

/* Joins the first `length` characters of `before` and all of `after`. False: the path is too long. */
static bool join_path(char path[PATH_MAX], const char *before, int length, const char *after) {
    const int used = snprintf(path, PATH_MAX, "%.*s%s", length, before, after);
    if (used >= PATH_MAX) errno = ENAMETOOLONG;
    return used < PATH_MAX;
}

/* Length of the folder in a path, the slash included. */
static int folder_length(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? (int)(slash - path) + 1 : 0;
}

/* Finds the path of a file without symbolic links. The file itself may be missing. False: errno tells why. */
static bool target_of(const char *path, char target[PATH_MAX]) {
    char folder[PATH_MAX], link[PATH_MAX];
    if (realpath(path, target)) return true;
    if (errno != ENOENT) return false; /* ELOOP: links in a circle */
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

/* A file that this run reads, or the target of an open output. */
struct used {
    char *path;
    bool read;
    struct used *next;
};
static struct used *in_use;

/* Whether this run reads a path (read), or writes it. */
static bool is_in_use(const char *path, bool read) {
    for (const struct used *used = in_use; used; used = used->next)
        if (used->read == read && output_same(used->path, path)) return true;
    return false;
}

static int use(const char *path, bool read) {
    struct used *used = malloc(sizeof *used);
    if (!used) return message_memory();
    used->path = strdup(path), used->read = read, used->next = in_use;
    if (!used->path) {
        free(used);
        return message_memory();
    }
    in_use = used;
    return STATUS_OK;
}

/* Forgets the target of an output. Files that are read stay in the list until the end. */
static void use_no_more(const char *target) {
    for (struct used **at = &in_use; *at; at = &(*at)->next) {
        struct used *used = *at;
        if (used->read || strcmp(used->path, target) != 0) continue;
        *at = used->next;
        free(used->path);
        free(used);
        return;
    }
}

static int refuse_replacing(const char *path) {
    return message_at(STATUS_USAGE, path, 0,
                      "is read in this run and would be replaced; the output needs another name");
}

int output_spare(const char *path) {
    if (strcmp(path, "-") == 0) path = "/dev/stdin"; /* standard input may be a file */
    if (is_in_use(path, false)) return refuse_replacing(path);
    for (const struct used *used = in_use; used; used = used->next)
        if (used->read && strcmp(used->path, path) == 0) return STATUS_OK;
    return use(path, true);
}

enum { LINK_PATH = 32 };

/* The path from which an open file without a name can be linked. */
static void link_path(char path[LINK_PATH], int number) { snprintf(path, LINK_PATH, "/proc/self/fd/%d", number); }

/* Opens a file without a name in the folder of the target. The file is gone however the program ends. -1: the system or
 * the file system has no such files. */
static int open_unnamed(const char *target) {
    int number = -1;
#ifdef O_TMPFILE
    char folder[PATH_MAX], link[LINK_PATH];
    if (!join_path(folder, target, folder_length(target), "")) return -1;
    number = open(folder, O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
    link_path(link, number);
    if (number >= 0 && access(link, F_OK) != 0) close(number), number = -1;
#else
    (void)target;
#endif
    return number;
}

/* Gives an open file (*number >= 0) a new name beside the target, or opens a file of such a name. False: errno tells
 * why. */
static bool name_temporary(struct output *output, int *number) {
    const bool unnamed = *number >= 0;
    char link[LINK_PATH];
    bool named = false;
    link_path(link, *number);
    for (int k = 0; !named && k < 100; ++k) { /* link() never replaces a file */
        snprintf(output->temporary, strlen(output->target) + 64, "%s.%ld-%d.tmp", output->target, (long)getpid(), k);
        if (unnamed)
            named = linkat(AT_FDCWD, link, AT_FDCWD, output->temporary, AT_SYMLINK_FOLLOW) == 0;
        else
            named = (*number = open(output->temporary, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666)) >= 0;
        if (!named && errno != EEXIST) break;
    }
    if (named) interrupt_guard(output->temporary);
    return named;
}

/* Opens the file that will replace the target. False: errno tells why. */
static bool open_temporary(struct output *output) {
    output->temporary = malloc(strlen(output->target) + 64);
    if (!output->temporary) return errno = ENOMEM, false;
    int number = open_unnamed(output->target);
    output->unnamed = number >= 0;
    if (number < 0 && !name_temporary(output, &number)) return false;
    output->file = fdopen(number, "wb");
    return output->file;
}

int output_numbered(const char *pattern, int64_t frame, char path[OUTPUT_PATH]) {
    const char *star = strchr(pattern, '*');
    const int used =
        star ? snprintf(path, OUTPUT_PATH, "%.*s%" PRId64 "%s", (int)(star - pattern), pattern, frame, star + 1)
             : snprintf(path, OUTPUT_PATH, "%s", pattern);
    return used >= OUTPUT_PATH ? message_at(STATUS_USAGE, pattern, 0, "the name is too long") : STATUS_OK;
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
    if (is_in_use(path, true)) return refuse_replacing(path);
    output->target = target_of(path, target) ? strdup(target) : NULL;
    if (output->target && open_temporary(output)) {
        if (exists) fchmod(fileno(output->file), there.st_mode & 07777);
        return use(output->target, false);
    }
    const int status = message_at(STATUS_FILE, path, 0, "%s", strerror(errno));
    free(output->temporary);
    free(output->target);
    *output = (struct output){0};
    return status;
}

/* Gives a complete file its name. Removes the file if status is an error. */
static int end_temporary(struct output *output, int status) {
    if (!status && rename(output->temporary, output->target) != 0)
        status = message_at(STATUS_FILE, output->path, 0, "%s", strerror(errno));
    if (status && !output->unnamed) unlink(output->temporary);
    use_no_more(output->target);
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
    if (!status && output->unnamed) {
        int number = fileno(output->file);
        if (name_temporary(output, &number))
            output->unnamed = false;
        else
            status = cannot_write(output);
    }
    if (output->file != stdout && fclose(output->file) != 0 && !status) status = cannot_write(output);
    if (output->temporary) status = end_temporary(output, status);
    *output = (struct output){0};
    return status;
}
