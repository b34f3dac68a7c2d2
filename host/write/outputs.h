/* outputs.h - the outputs of a run: -o, --format, --json. SPDX-License-Identifier: MIT */
#ifndef OUTPUTS_H
#define OUTPUTS_H

#include "cli/output.h"
#include "write/write.h"

enum content { CONTENT_MATRIX, CONTENT_HEAT, CONTENT_CONDUCTION, CONTENTS };

/* A format of outputs. */
struct format {
    const char *name;                /* also the ending of its files */
    write_function *write[CONTENTS]; /* NULL: the format cannot hold these contents */
    bool frames;                     /* a file can hold several frames */
    bool columns;                    /* a file has the columns of the input, too */
};

enum { OUTPUTS_MAX = 8 };

/* A frame that was written. The .pvd of a series lists such frames. */
struct written {
    int64_t number;
    double time; /* [s], or the timestep */
    bool known;  /* the frame has a time or a timestep */
};

/* All outputs of a run. Begin with zeroes: the summary only. */
struct outputs {
    size_t count;
    struct {
        const char *path; /* "-": standard output */
        const char *star; /* the * in the path; it means a file for each frame; NULL: one file */
        const struct format *format;
        struct output file; /* without a star */
        bool begun;         /* the file has a frame */
    } to[OUTPUTS_MAX];
    const struct format *format; /* --format; NULL: not given */
    enum content content;
    const char *summary, *picture; /* paths of --json and --plot; NULL: not given */
    struct output summary_file;
    struct written *frame; /* [frames] */
    size_t frames;
};

/* Rows of a table of options, without braces. help: of -o. */
#define OPTION_OUTPUT(help, request, field) 'o', "output", "OUT", help, TO_FUNCTION(outputs_add, request, field)
#define OPTION_FORMAT(request, field)                                                                                  \
    0, "format", "NAME", "format of each -o without an ending that names one, such as -o - [by the ending]",           \
        TO_FUNCTION(outputs_format, request, field)

/* Take the argument of -o, --wall-vtp or --format into the outputs. Status 0 or STATUS_USAGE. */
int outputs_add(const char *path, void *outputs);
int outputs_add_meshes(const char *path, void *outputs);
int outputs_format(const char *name, void *outputs);

/* Checks when all options have been read that the outputs can hold the contents and have different paths. series: there
 * may be several frames. Status 0 or STATUS_USAGE. */
int outputs_check(struct outputs *outputs, enum content content, bool series);

/* Whether an output has the columns of the input, too. */
bool outputs_keep(const struct outputs *outputs);

/* Opens all outputs before any work is done. For a path with `*`, a file is opened as a test and removed. Call
 * outputs_close also after an error. Status as output_open. */
int outputs_open(struct outputs *outputs);

/* Writes a frame to all outputs. A path with `*` gets a file of the number what->bed->frame, which is then complete.
 * Status 0, that of the writer, or as output_open or output_close. */
int outputs_write(struct outputs *outputs, const struct contents *what);

/* Closes all outputs as output_close does, with the status of the work so far. Beside a series NAME.*.vtp writes
 * NAME.pvd for ParaView. */
int outputs_close(struct outputs *outputs, int status);

/* Makes the report of the summary when the outputs are open. Its lines go to standard output, or to standard error if
 * results go to standard output. quiet: no lines. Its JSON goes to --json. */
struct report outputs_report(const struct outputs *outputs, bool quiet);

#endif
