/* gnuplot.c - runs gnuplot, whose picture goes to an output. SPDX-License-Identifier: MIT */
#include "plot/gnuplot.h"

#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cli/message.h"

bool plot_ending(const char *path) { return output_ends(path, ".svg") || output_ends(path, ".png"); }

extern char **environ;

static int gnuplot_spawn(struct gnuplot *gnuplot, int script, int script_end, int picture) {
    char *arguments[] = {"gnuplot", NULL};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, script, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, picture, STDOUT_FILENO);
    posix_spawn_file_actions_addclose(&actions, script);
    posix_spawn_file_actions_addclose(&actions, script_end);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    const int error = posix_spawnp(&gnuplot->process, arguments[0], &actions, NULL, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    return error;
}

int gnuplot_start(struct gnuplot *gnuplot, const struct output *picture) {
    int ends[2];
    if (pipe(ends) != 0) return message(STATUS_FILE, "gnuplot: %s", strerror(errno));
    const int error = gnuplot_spawn(gnuplot, ends[0], ends[1], fileno(picture->file));
    close(ends[0]);
    gnuplot->picture = picture;
    gnuplot->script = error ? NULL : fdopen(ends[1], "w");
    if (gnuplot->script) return STATUS_OK;
    close(ends[1]);
    if (error == ENOENT) return message(STATUS_FILE, "--plot needs the program gnuplot (Debian: gnuplot-nox)");
    return message(STATUS_FILE, "gnuplot: %s", strerror(error ? error : errno));
}

void gnuplot_style(FILE *script, const char *path, int width, int height) {
    const bool png = output_ends(path, ".png");
    fprintf(script,
            "set encoding utf8\n"
            "set terminal %s size %d,%d font 'DejaVu Sans,%d' background '#ffffff'\n"
            "set border 3 lc '#555555'\n"
            "set tics nomirror out scale 0.6 tc '#333333'\n"
            "set grid lc '#e6e6e6' lw 1 lt 1\n",
            png ? "pngcairo" : "svg", width, height, png ? 13 : 15);
}

void gnuplot_name(FILE *script, const char *path) {
    const char *slash = strrchr(path, '/');
    for (const char *c = slash ? slash + 1 : path; *c; ++c) {
        if (*c == '\'') fputc('\'', script);
        fputc((unsigned char)*c < ' ' ? '?' : *c, script);
    }
}

/* Whether the picture is complete, by its last bytes. gnuplot reports no error if the disk is full. */
static bool picture_whole(int picture) {
    char tail[32];
    const off_t size = lseek(picture, 0, SEEK_END);
    if (size < (off_t)sizeof tail || pread(picture, tail, sizeof tail, size - (off_t)sizeof tail) != sizeof tail)
        return false;
    for (size_t k = 0; k + 6 <= sizeof tail; ++k)
        if (memcmp(tail + k, "</svg>", 6) == 0 || memcmp(tail + k, "IEND", 4) == 0) return true;
    return false;
}

/* Prints why the picture failed. To find a full disk, writes more bytes: they fill the room that is left, and then
 * writing fails. */
static int picture_failed(const struct output *picture) {
    static const char more[65536];
    for (int tries = 0; tries < 2; tries++)
        if (write(fileno(picture->file), more, sizeof more) < 0)
            return message_at(STATUS_FILE, picture->path, 0, "cannot be written: %s", strerror(errno));
    return message(STATUS_FILE, "gnuplot failed");
}

int gnuplot_end(struct gnuplot *gnuplot) {
    int end = 0;
    const int closed = fclose(gnuplot->script);
    while (waitpid(gnuplot->process, &end, 0) < 0 && errno == EINTR) {}
    if (interrupt_status()) return interrupt_status();
    const bool content = closed == 0 && WIFEXITED(end) && WEXITSTATUS(end) == 0;
    return content && picture_whole(fileno(gnuplot->picture->file)) ? STATUS_OK : picture_failed(gnuplot->picture);
}
