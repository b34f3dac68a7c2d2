/* program.h - runs the program and keeps its exit statuses, messages and files. SPDX-License-Identifier: MIT
 *
 * Runs $BUILD/fibrad (default: build/fibrad) from the project's root. Each test has a folder: make_folder,
 * remove_folder. */
#ifndef TEST_PROGRAM_H
#define TEST_PROGRAM_H

#include <dirent.h>
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "suite.h"

#define MONO     "tests/data/mono2000.dump"
#define POLY     "tests/data/poly2000.dump"
#define PERIODIC "tests/data/monoper2000.dump"

/* A frame of two spheres in a dump. */
#define TWO_SPHERES(number, marks, rows)                                                                               \
    "ITEM: TIMESTEP\n" number "\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS " marks                                    \
    "\n0 8\n0 8\n0 8\nITEM: ATOMS radius x y z id\n" rows

static const char *build; /* folder of the program */
static char folder[200];  /* for the files of a test */
static char stdout_path[220], stderr_path[220];
static char said[8192], printed[65536];
static struct text *texts; /* the files that the test has read */
struct text {
    struct text *before;
    char of_file[];
};

static inline void make_folder(void) {
    build = getenv("BUILD") ? getenv("BUILD") : "build";
    snprintf(folder, sizeof folder, "%.100s/tests/cli_XXXXXX", build);
    ck_assert_ptr_nonnull(mkdtemp(folder));
    snprintf(stdout_path, sizeof stdout_path, "%s/stdout", folder);
    snprintf(stderr_path, sizeof stderr_path, "%s/stderr", folder);
}

/* The path of a file in the test's folder. */
static inline const char *in_folder(const char *name) { return formatted("%s/%s", folder, name); }

/* Removes all files of the folder, also stdout and stderr if asked for. Returns their number. */
static inline int remove_files(int outputs_too) {
    int count = 0;
    DIR *list = opendir(folder);
    ck_assert_ptr_nonnull(list);
    for (struct dirent *entry; (entry = readdir(list));) {
        const int output = strncmp(entry->d_name, "std", 3) == 0;
        if (entry->d_name[0] == '.' || (output && !outputs_too)) continue;
        ck_assert_int_eq(unlink(in_folder(entry->d_name)), 0);
        ++count;
    }
    closedir(list);
    return count;
}

static inline void remove_folder(void) {
    for (struct text *text; (text = texts) != NULL; free(text)) texts = text->before;
    remove_files(1);
    ck_assert_int_eq(rmdir(folder), 0);
}

static inline const char *write_file(const char *name, const char *text) {
    const char *path = in_folder(name);
    FILE *file = opened(path, "w");
    ck_assert_int_ge(fputs(text, file), 0);
    ck_assert_int_eq(fclose(file), 0);
    return path;
}

/* A whole file as a string, which lasts until the folder is removed. */
static char *read_file(const char *path) {
    struct stat there;
    OWNED_FILE *file = opened(path, "r");
    ck_assert_int_eq(fstat(fileno(file), &there), 0);
    struct text *text = calloc(1, sizeof *text + (size_t)there.st_size + 1);
    ck_assert_ptr_nonnull(text);
    ck_assert_uint_eq(fread(text->of_file, 1, (size_t)there.st_size, file), (size_t)there.st_size);
    text->before = texts, texts = text;
    return text->of_file;
}

/* Reads a file into *text. A text that is there from another run must be the same. */
static inline void read_same(const char *path, char **text) {
    char *now = read_file(path);
    if (*text) ck_assert_str_eq(now, *text);
    *text = now;
}

static inline void open_as(int number, const char *path, int flags) {
    const int file = open(path, flags, 0666);
    if (file < 0 || dup2(file, number) < 0) _exit(99);
}

static const char *input = "/dev/null", *output; /* of the program; output NULL: kept in `printed` */

static inline pid_t start(const char *const *arguments) {
    const char *program = formatted("%s/fibrad", build), *argv[40] = {program};
    for (int k = 0; k < 38 && arguments[k]; ++k) argv[k + 1] = arguments[k];
    const char *out = output ? output : stdout_path;
    const pid_t process = fork();
    if (process != 0) return process;
    open_as(0, input, O_RDONLY);
    open_as(1, out, O_WRONLY | O_CREAT | O_TRUNC);
    open_as(2, stderr_path, O_WRONLY | O_CREAT | O_TRUNC);
    execv(program, (char *const *)argv);
    _exit(98);
}

static inline void keep(const char *path, char *text, size_t size) {
    OWNED_FILE *file = opened(path, "r");
    text[fread(text, 1, size - 1, file)] = 0;
}

/* The exit status, or 256 + the signal that killed the program. */
static inline int finish(pid_t process) {
    int end;
    ck_assert_int_eq(waitpid(process, &end, 0), process);
    keep(stdout_path, printed, sizeof printed);
    keep(stderr_path, said, sizeof said);
    return WIFEXITED(end) ? WEXITSTATUS(end) : 256 + WTERMSIG(end);
}

#define LIST(...)              ((const char *const[]){__VA_ARGS__, NULL})
#define RUN(...)               finish(start(LIST(__VA_ARGS__)))
#define FAIL_WITH(status, ...) ck_assert_int_eq(RUN(__VA_ARGS__), status)
#define SUCCEED(...)                                                                                                   \
    do {                                                                                                               \
        const int status_ = RUN(__VA_ARGS__);                                                                          \
        ck_assert_msg(status_ == 0, "exit status %d: %s", status_, said);                                              \
    } while (0)

/* The value of the last line `key value` with that key. */
static inline double value_of(const char *key) {
    double value = NAN;
    int found = 0;
    for (const char *line = printed; line && *line; line = strchr(line, '\n'), line += line != NULL)
        if (strncmp(line, key, strlen(key)) == 0 && line[strlen(key)] == ' ') {
            value = strtod(line + strlen(key), NULL);
            found = 1;
        }
    ck_assert_msg(found, "no line '%s' in: %s", key, printed);
    return value;
}

/* The number of a key in a file of --json, with all digits. The last run in the file counts. */
static inline double json_of(const char *path, const char *key) {
    const char *text = read_file(path), *wanted = formatted("\"%s\": ", key), *at = NULL;
    for (const char *next = text; (next = strstr(next, wanted)); at = next += strlen(wanted)) {}
    ck_assert_msg(at != NULL, "no key '%s' in: %s", key, text);
    return strtod(at, NULL);
}

/* Asserts that standard error has one line: `fibrad: `, the place, and then the reason. */
static inline void expect_message(const char *place, const char *reason) {
    assert_begins(said, formatted("fibrad: %s", place));
    assert_has(said, reason);
    ck_assert_ptr_eq(strchr(said, '\n'), said + strlen(said) - 1);
}

#endif
