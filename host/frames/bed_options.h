/* bed_options.h - options that all commands about beds share, and the loop over all frames of all files.
 * SPDX-License-Identifier: MIT */
#ifndef BED_OPTIONS_H
#define BED_OPTIONS_H

#include "bed/units.h"
#include "cli/progress.h"
#include "frames/column_option.h"
#include "frames/warnings.h"
#include "plot/plot_slice.h"
#include "read/read.h"
#include "write/outputs.h"

/* Rows of tables of options of commands whose request begins with a struct bed_options, without the outermost braces.
 */
#define OPTIONS_INPUT                                                                                                  \
    {0, "", NULL, NULL, TO_REQUEST(bed_files_option)},                                                                 \
        {0, "radius", "R", "radius of all spheres; TYPE:R,... or a column of the file [r or radius]",                  \
         TO_FUNCTION(bed_radius_option, struct bed_options, radius)},                                                  \
        {0, "length-unit", "UNIT",                                                                                     \
         "unit of length of files that name none, mm for example; it is one of " UNITS_LENGTH " [m]",                  \
         TO_FUNCTION(bed_unit_option, struct bed_options, length_unit)},                                               \
        {0, "periodic", "LX,LY,LZ", "lengths of the periodic box, 0 on open axes; or none [as the file says]",         \
         TO_REQUEST(bed_period_option)},                                                                               \
        {0, "frame", "K",                                                                                              \
         "frame of the file, from 0; -1: the last; all; A:B or A:B:STEP: from A on, up to B - 1 [the last]",           \
         TO_REQUEST(bed_frames_option)},                                                                               \
    {                                                                                                                  \
        OPTION_COLUMNS(struct bed_options, columns_of_file)                                                            \
    }
#define OPTIONS_INPUT_RARE                                                                                             \
    OPTIONS_ROWS(struct bed_options, columns_of_file), {                                                               \
        0, "positions", NULL, "name spheres by their positions in the file, from 0 [by ids]",                          \
            TO_FLAG(struct bed_options, positions)                                                                     \
    }
#define OPTION_CLUMP                                                                                                   \
    0, "clump", "COLUMN",                                                                                              \
        "column of the numbers of clumps, id_multisphere, mol or clumpId for example: spheres of one number above 0 "  \
        "are one body and may lie within one another [none]",                                                          \
        TO_FUNCTION(bed_clump_option, struct bed_options, clump)
#define OPTIONS_RUN                                                                                                    \
    {OPTION_THREADS(struct bed_options, threads)},                                                                     \
        {0, "json", "OUT", "write the summary as JSON, with all digits [none]",                                        \
         TO_PATH(struct bed_options, outputs.summary)},                                                                \
        {0, "quiet", NULL, "print no summary and no progress", TO_FLAG(struct bed_options, quiet)}, {                  \
        OPTION_HELP                                                                                                    \
    }
#define OPTION_WALL                                                                                                    \
    0, "wall", "LIST", "walls: box, xmin ... zmax, zmax:open, cylinder:X,Y,R, mesh:FILE [none]",                       \
        TO_FUNCTION(walls_option, struct bed_options, walls)
#define OPTION_WALL_VTP                                                                                                \
    0, "wall-vtp", "OUT", "write the triangles of the walls of mesh:FILE, a .vtp for ParaView [none]",                 \
        TO_REQUEST(bed_meshes_option)

/* Rows without braces: -o with its help, --format, --plot with its help, --slice for pictures that have one, and
 * --scratch for commands that make matrices. */
#define OPTION_BED_OUTPUT(help) OPTION_OUTPUT(help, struct bed_options, outputs)
#define OPTION_BED_FORMAT       OPTION_FORMAT(struct bed_options, outputs)
#define OPTION_PLOT(help)       0, "plot", "OUT", help, TO_PATH(struct bed_options, outputs.picture)
#define OPTION_SLICE                                                                                                   \
    0, "slice", "AXIS=VALUE",                                                                                          \
        "plane of the slice in the picture, x=VALUE, y=VALUE or z=VALUE, or an axis alone for the middle of the "      \
        "spheres; in the file's unit of length [y]",                                                                   \
        TO_FUNCTION(plot_plane_option, struct bed_options, slice)
#define OPTION_SCRATCH                                                                                                 \
    0, "scratch", "FOLDER",                                                                                            \
        "keep rows and matrix in temporary files of this folder, with the same results; for each entry of the raw "    \
        "rows they take 36 to 64 bytes [in memory]",                                                                   \
        TO_FUNCTION(bed_scratch_option, struct bed_options, scratch)

/* A paragraph of --help about the files. */
#define FILES_MORE                                                                                                     \
    "FILE may be a dump or data file of LAMMPS or LIGGGHTS, CSV with a header, extended XYZ, VTK (.vtk,\n"             \
    ".vtp, .vtu, .pvtp, .pvtu), or text of YADE or MercuryDPM. It may be compressed by gzip. - is standard\n"          \
    "input. Several files are one series. Files of a pattern 'bed.*.dump' are read in the order of their\n"            \
    "numbers. A * in OUT stands for the number of the frame, counted through all files from 0. Spheres are\n"          \
    "named by the ids of the file, or by positions from 0 if the file has no ids. A column whose header has a\n"       \
    "unit, P [kW] or k [W/(m K)], is converted. docs/files.md has the details.\n"

enum { BED_COLUMNS_MAX = 8 };

/* Arguments of the options, and the state of the run. Begin with zeroes; bed_options_end frees it. */
struct bed_options {
    char **file; /* [files] "-": standard input */
    size_t files;
    struct frames frames;
    bool range;    /* --frame names a range: there may be several frames per file */
    bool timed;    /* the command computes results at several times from one frame */
    bool periodic; /* --periodic was given */
    double period[3];
    bool positions;
    struct column_options columns_of_file;
    struct quantity radius, clump;
    const char *length_unit;             /* NULL: not given */
    const char *column[BED_COLUMNS_MAX]; /* [columns] columns of the file that options name */
    const char *unit[BED_COLUMNS_MAX];   /* [columns] unit that the file must not contradict; NULL: none */
    bool some[BED_COLUMNS_MAX];          /* [columns] values may be missing */
    size_t columns;
    struct wall_options walls;
    bool wall_vtp;       /* --wall-vtp was given */
    int threads;         /* 0: all cores */
    const char *scratch; /* a folder for rows and matrix; NULL: in memory */
    struct outputs outputs;
    struct output picture; /* of outputs.picture */
    struct plot_plane slice;
    bool quiet;
    struct progress progress;
    /* state of the run */
    const char *command;
    const char *name; /* name of the current file, for messages */
    int64_t frames_done;
    struct warned warned;
    double metres; /* unit of length of the frames so far [m]; 0: not known */
    struct report report;
};

/* Functions of the rows above. Status 0, STATUS_USAGE, STATUS_FILE or STATUS_MEMORY. */
option_take bed_files_option, bed_radius_option, bed_clump_option, bed_unit_option, bed_period_option,
    bed_frames_option, bed_meshes_option, bed_scratch_option;

/* Asks for the column of a quantity, if it has one, and sets quantity->index. unit: expected unit of the values; NULL:
 * none. Quantities without a unit may share a column, such as that of types. */
void bed_options_quantity(struct bed_options *options, struct quantity *quantity, const char *unit);

/* The file's name for the column of a quantity. NULL: it has none. */
const char *bed_options_column(const struct bed_options *options, const struct quantity *quantity);

/* Checks files and outputs when all options have been read. The command writes `content`. Status 0 or STATUS_USAGE. */
int bed_options_check(struct bed_options *options, const char *command, enum content content);

/* Computes, writes and reports one frame. Returns its status. */
typedef int bed_options_frame(void *request, struct bed *bed);

/* Ends a command whose options have been read with `status`. STATUS_HELP prints the help. STATUS_OK reads all frames of
 * all files and hands them one after the other to `frame`; outputs get their names only if no frame fails. In any case
 * the options are freed. Returns the exit status. */
int bed_options_end(struct bed_options *options, int status, int (*help)(void), bed_options_frame *frame,
                    void *request);

/* Threads and progress bar for calls of the library. The bar is part of the options. */
fibrad_run bed_options_run(struct bed_options *options);

/* Ends the bar after a call of the library. Prints a message if the call has failed. Returns the exit status, as
 * bed_status. */
int bed_options_status(struct bed_options *options, const struct bed *bed, int status, const fibrad_fault *fault);

/* The same after a call for a bed of the library, which knows the fault. */
int bed_options_made(struct bed_options *options, const struct bed *bed, const fibrad_bed *made, int status);

/* Makes the bed of the library, and warns if spheres and walls contradict each other. Free *made with
 * fibrad_bed_matrix_free. Returns the exit status, as bed_options_status. */
int bed_options_make(struct bed_options *options, const struct bed *bed, const struct walls *walls, fibrad_bed **made);

/* Computes the factors of a bed. Warns of rows that contradict each other. Refuses a bed whose rows will not fit into
 * memory, or onto the disk of rows->scratch. A few rows are made to estimate the size. Small beds and lists of targets
 * are not checked. Free *factors also after an error. Status 0, STATUS_MEMORY, STATUS_FILE if the disk is too small, or
 * as bed_options_status. */
int bed_options_factors(struct bed_options *options, const struct bed *bed, const struct walls *walls, fibrad_bed *made,
                        fibrad_bed_rule *rows, fibrad_bed_matrix **factors);

/* The unit of length of a bed: that of the file, or else that of --length-unit. NULL: neither names one. */
const char *bed_options_unit(const struct bed_options *options, const struct bed *bed);

/* Makes sure that bed->metres is known. Without a unit takes metres, and warns if radii look too large for metres.
 * needed: what must not do without a unit, "contacts need" for example; NULL: nothing. Status 0, or STATUS_USAGE if a
 * unit is missing, if it has no length in metres (as units lj), or if earlier frames had another one. */
int bed_options_metres(struct bed_options *options, struct bed *bed, const char *needed);

/* Writes the current frame to all outputs. The caller sets `what` but for bed, file and series. */
int bed_options_write(struct bed_options *options, const struct bed *bed, struct contents *what);

/* Places the walls about a bed and finds which sides of meshes are walls. Warns if walls and bed contradict each other.
 * Status as walls_of, or STATUS_MEMORY. */
int bed_options_walls(struct bed_options *options, const struct bed *bed, struct walls *walls);

/* Begins the summary of a frame: file, frame, units, radii, box, walls. facts NULL: no radii. */
void bed_options_report(struct bed_options *options, const struct bed *bed, const struct walls *walls,
                        const fibrad_scene_facts *facts);

#endif
