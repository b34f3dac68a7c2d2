/* bed_options.h - what all commands about a bed are asked: its file, how to read it, what to compute with, where the
 * result goes. SPDX-License-Identifier: MIT */
#ifndef BED_OPTIONS_H
#define BED_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>

#include "bed/bed.h"
#include "bed/wall_option.h"
#include "cli/options.h"
#include "cli/progress.h"
#include "simple/fibrad_host.h"
#include "write/outputs.h"

/* Rows of a table of options, without braces, besides those of options.h and wall_option.h. */
#define OPTION_PERIODIC                                                                                                \
    KEY_PERIODIC, "periodic", "LX,LY,LZ", "box lengths, 0 for an open axis; or none [as the file says]"
#define OPTION_FRAME    KEY_FRAME, "frame", "K", "frame of a dump, from 0 [the last]"
#define OPTION_IDS      KEY_IDS, "ids", NULL, "in .csv, name spheres by the file's ids [by positions from 0]"
#define OPTION_PROGRESS KEY_PROGRESS, "progress", NULL, "show progress also when standard error is no terminal [off]"

/* What was asked; zeroed to begin with, but for the frame. */
struct bed_options {
    const char *file; /* "-": standard input */
    const char *name; /* of the file, in messages */
    struct outputs outputs;
    bool periodic;    /* --periodic was given */
    double period[3];
    int64_t frame;         /* -1: the last */
    const char *column[2]; /* [columns] read besides */
    size_t columns;
    struct wall_options walls;
    int threads; /* 0: all cores */
    bool ids;
    struct progress progress;
};

/* Takes FILE, -o, --wall and all options of this header and of OPTION_THREADS and OPTION_HELP; a key that it does not
 * know is OPTIONS_BAD. Status 0, STATUS_HELP or STATUS_USAGE. */
int bed_options_take(struct bed_options *asked, const struct options *options, int key);

/* Asks for a column of the file; returns its place in bed->extra. NULL: none. */
size_t bed_options_column(struct bed_options *asked, const char *name);

/* Is there something wrong with the outputs? Status 0 or STATUS_USAGE. */
int bed_options_output(struct bed_options *asked, enum content content);

/* How the library is to be run: threads, and a bar that is kept in `asked`. */
fibrad_run bed_options_run(struct bed_options *asked);

/* The exit status for a status of the library run so, after a message; the bar is ended. As bed_status. */
int bed_options_status(struct bed_options *asked, const struct bed *bed, int status, const fibrad_fault *fault);

/* Reads the bed, with the box that was asked for. Free it also after an error. Status as read_bed. */
int bed_options_read(const struct bed_options *asked, struct bed *bed);

#endif
