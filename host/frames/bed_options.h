/* bed_options.h - what all commands about beds are asked: files and how to read them, threads, where results go; and
 * the run over all frames of all files. SPDX-License-Identifier: MIT */
#ifndef BED_OPTIONS_H
#define BED_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>

#include "bed/bed.h"
#include "bed/property_option.h"
#include "bed/units.h"
#include "bed/wall_option.h"
#include "cli/options.h"
#include "cli/output.h"
#include "cli/progress.h"
#include "frames/warnings.h"
#include "text/report.h"
#include "read/read.h"
#include "simple/fibrad_host.h"
#include "write/outputs.h"

/* Rows of a table of options, without the outermost braces: what is read, and what is left of it. */
#define OPTIONS_INPUT                                                                                                  \
    {KEY_RADIUS, "radius", "R", "radius of all spheres, or TYPE:R,..., or a column of the file [r or radius]"},        \
        {KEY_LENGTH_UNIT, "length-unit", "UNIT", "unit of length of files that name none: " UNITS_LENGTH " [m]"},      \
        {KEY_PERIODIC, "periodic", "LX,LY,LZ",                                                                         \
         "lengths of the periodic box, 0 for an open axis, or none [as the file says]"},                               \
        {KEY_FRAME, "frame", "K", "frame of the file, from 0, -1 for the last, all, A:B or A:B:STEP without B [-1]"},  \
    {                                                                                                                  \
        KEY_POSITIONS, "positions", NULL, "name spheres by their positions in the file, from 0 [by ids]"               \
    }
#define OPTIONS_RUN                                                                                                    \
    {OPTION_THREADS}, {KEY_JSON, "json", "OUT", "write the summary as JSON, with all digits [none]"},                  \
        {KEY_QUIET, "quiet", NULL, "print no summary and no progress"},                                                \
        {KEY_PROGRESS, "progress", NULL, "show progress even if standard error is not a terminal [off]"}, {            \
        OPTION_HELP                                                                                                    \
    }

/* Of commands that make matrices. */
#define OPTION_SCRATCH                                                                                                 \
    KEY_SCRATCH, "scratch", "FOLDER",                                                                                  \
        "keep rows and matrix in temporary files of this folder, with the same results [in memory]"

/* What --help says below of the files. */
#define FILES_MORE                                                                                                     \
    "FILE may be a dump or data file of LAMMPS or LIGGGHTS, CSV with a header, extended XYZ, VTK (.vtp,\n"             \
    ".vtk), or text of YADE or MercuryDPM. It may be compressed by gzip. - is standard input. Several files\n"         \
    "are one series. Files of a pattern 'bed.*.dump' are read in the order of their numbers. A * in OUT\n"             \
    "stands for the number of the frame, counted through all files from 0. Spheres are named by the ids of\n"          \
    "the file, or by positions from 0 if the file has no ids. docs/files.md has the details.\n"

enum { BED_COLUMNS_MAX = 8 };

/* What was asked; zeroed to begin with. To be freed with bed_options_free. */
struct bed_options {
    char **file; /* [files] "-": standard input */
    size_t files;
    struct frames frames;
    bool range;    /* of frames: there may be several in a file */
    bool timed;    /* results at several times are made of one frame */
    bool periodic; /* --periodic was given */
    double period[3];
    bool positions;
    struct quantity radius;
    const char *length_unit;             /* NULL: not given */
    const char *column[BED_COLUMNS_MAX]; /* [columns] read besides, */
    const char *unit[BED_COLUMNS_MAX];   /* and their units; NULL: none */
    bool some[BED_COLUMNS_MAX];          /* values may be missing */
    size_t columns;
    struct wall_options walls;
    bool wall_vtp;       /* an output has their triangles */
    int threads;         /* 0: all cores */
    const char *scratch; /* a folder for rows and matrix; NULL: in memory */
    struct outputs outputs;
    bool quiet;
    struct progress progress;
    /* of the run */
    const char *name; /* of the file in hand, in messages */
    int64_t frames_done;
    struct warned warned;
    double metres; /* of the unit of length so far; 0: not known */
    struct report report;
};

/* Takes FILE, -o, --wall, --wall-vtp and all options of this header; a key that it does not know is OPTIONS_BAD. Status
 * 0, STATUS_HELP, STATUS_USAGE or STATUS_MEMORY. */
int bed_options_take(struct bed_options *asked, const struct options *options, int key);

/* Asks for a column of the file, whose unit is to be this one (NULL: it has none); returns its place in bed->extra,
 * one for all that ask for a column without a unit. name NULL: no column. */
size_t bed_options_column(struct bed_options *asked, const char *name, const char *unit);

/* Is a file missing, or is there something wrong with the outputs of this content, or with a picture (NULL: none)?
 * Status 0 or STATUS_USAGE. */
int bed_options_check(struct bed_options *asked, const char *command, enum content content, const char *picture);

/* Computes, writes and reports one frame. Returns its status. */
typedef int bed_options_frame(void *request, struct bed *bed);

/* Opens the outputs, reads all frames of all files, hands them one after the other to `frame`, and closes the outputs,
 * which get their names only if all went well. Status as read_bed, or that of a frame. */
int bed_options_frames(struct bed_options *asked, const char *command, bed_options_frame *frame, void *request);

/* Frees what the options have taken. */
void bed_options_free(struct bed_options *asked);

/* How the library is to be run: threads, and a bar that is kept in `asked`. */
fibrad_run bed_options_run(struct bed_options *asked);

/* The exit status for a status of the library run so, after a message; the bar is ended. As bed_status. */
int bed_options_status(struct bed_options *asked, const struct bed *bed, int status, const fibrad_fault *fault);

/* Computes the factors of a bed as a request says. Returns a status, a message being out. */
typedef int bed_options_compute(void *request, const struct bed *bed, fibrad_bed_factors **factors);

/* Whether all rows will fit into memory, or onto the disk of options->scratch, judged by a few, which `compute` makes
 * with options->wanted. Status 0; STATUS_MEMORY; that of compute. Small beds and lists of targets are not asked. */
int bed_options_memory(const struct bed *bed, fibrad_bed_options *options, bed_options_compute *compute, void *request);

/* Metres of the bed's unit of length, for what comes in watts, with a word where it is assumed and looks wrong. Status
 * 0; STATUS_USAGE if there is none, as in lj, or if frames before had another one. */
int bed_options_metres(struct bed_options *asked, const struct bed *bed, double *metres);

/* Writes the frame in hand to all outputs. what: all but bed, file and series. */
int bed_options_write(struct bed_options *asked, const struct bed *bed, struct contents *what);

/* Places the walls about a bed, finds which sides of meshes are walls, and warns of what does not go together. Status
 * as walls_of, or STATUS_MEMORY. */
int bed_options_walls(struct bed_options *asked, const struct bed *bed, struct walls *walls);

/* Begins the report of a frame: file, frame, box, radii, units, walls. facts NULL: none. */
void bed_options_report(struct bed_options *asked, const struct bed *bed, const struct walls *walls,
                        const fibrad_scene_facts *facts);

#endif
