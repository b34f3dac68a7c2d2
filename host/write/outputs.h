/* outputs.h - where the results of a run go: -o, several times, and --format. SPDX-License-Identifier: MIT */
#ifndef OUTPUTS_H
#define OUTPUTS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cli/output.h"
#include "write/write.h"

enum content { CONTENT_MATRIX, CONTENT_HEAT, CONTENT_CONDUCTION, CONTENTS };

/* A format by its name, which is the ending of its files, too. */
struct format {
    const char *name;
    write_function *write[CONTENTS]; /* NULL: it cannot hold that */
    bool frames;                     /* it holds several frames, one after the other */
    bool columns;                    /* it has the columns of the input, too */
};

enum { OUTPUTS_MAX = 8 };

/* A frame that was written, for those files of ParaView that list them. */
struct written {
    int64_t number;
    double time; /* [s], or the timestep */
    bool known;  /* there is one of these */
};

/* Zeroed: none, and the summary only. */
struct outputs {
    size_t count;
    struct {
        const char *path; /* "-": standard output */
        const char *star; /* in the path: one file a frame, with its number there; NULL: one for all */
        const struct format *format;
        struct output file; /* where there is no star */
        bool begun;         /* a frame is in it */
    } to[OUTPUTS_MAX];
    const struct format *format; /* of --format; NULL: it was not given */
    enum content content;
    const char *summary, *picture; /* other files of the run, --json and --plot; NULL: none */
    struct output summary_file;
    struct written *frame; /* [frames] */
    size_t frames, room;
};

/* Rows of a table of options, without braces. */
#define OPTION_FORMAT                                                                                                  \
    KEY_FORMAT, "format", "NAME", "format of each -o without an ending that names one, such as -o - [by the ending]"

/* Takes the argument of -o, --wall-vtp or --format. Status 0 or STATUS_USAGE. */
int outputs_add(struct outputs *outputs, const char *path);
int outputs_add_meshes(struct outputs *outputs, const char *path);
int outputs_format(struct outputs *outputs, const char *name);

/* Can all that be written? series: several frames may come. Status 0 or STATUS_USAGE. */
int outputs_check(struct outputs *outputs, enum content content, bool series);

/* Whether one of them has the columns of the input, too. */
bool outputs_keep(const struct outputs *outputs);

/* Opens them before any work is done; those with `*` are tried. Status 0 or as output_open; then, as after all that
 * follows, outputs_close. */
int outputs_open(struct outputs *outputs);

/* Writes a frame into each, the number of what->bed->frame in the names of those with `*`; a file of its own is
 * complete when this returns. Status 0, that of the writer, of outputs_open or of output_close. */
int outputs_write(struct outputs *outputs, const struct contents *what);

/* Beside series NAME.*.vtp of frames or times writes NAME.pvd, which ParaView opens; gives the files their names, or
 * removes those still open after any trouble; `status` as in output_close. */
int outputs_close(struct outputs *outputs, int status);

/* Where the summary goes, once they are open: its lines to standard output, or to standard error where results go there
 * (quiet: nowhere), and to --json. */
struct report outputs_report(const struct outputs *outputs, bool quiet);

#endif
