/* vtk_grid.h - points of a VTK file and wanted arrays on the points. SPDX-License-Identifier: MIT */
#ifndef VTK_GRID_H
#define VTK_GRID_H

#include <stddef.h>
#include <stdint.h>

#include "text/xml.h"

/* The type of the values of an array. */
struct vtk_type {
    size_t size;       /* bytes; 0: unknown */
    char kind;         /* f: floating point, i: integer, u: unsigned integer */
    const char *names; /* names in legacy and XML files, each with a blank before and behind */
};

/* A wanted array. Of several arrays that it may be, the one whose name stands first counts, and a name in the same case
 * before all names in another case. */
struct vtk_wanted {
    const char *const *names; /* possible names in any case, ended by NULL; or NULL */
    const char *name;         /* the exact name, behind which a unit may stand that the file leaves out; or NULL */
    int rank;                 /* of the name of the array that was found, from 0 */
    double *values;           /* [n], which the caller frees; NULL: the file does not have the array */
};

struct vtk_grid {
    const char *file; /* for messages */
    const char *text; /* the whole file */
    const char *end;
    uint64_t n;     /* points of a piece */
    double *points; /* [3 n], which the caller frees */
    struct vtk_wanted *wanted;
    size_t count;
    /* Takes the points of a piece, which are forgotten behind it. Status 0, or another one that ends the reading. NULL:
     * the points of the last piece stay. */
    int (*take)(struct vtk_grid *grid, void *context);
    /* Reads a piece that is in another file. NULL: there must be none. */
    int (*open)(const char *source, void *context);
    void *context;
};

/* Read the points and the wanted arrays of each piece and hand them to grid->take. Numbers may be infinite or NaN. Free
 * points and values also after an error. Status 0, STATUS_INPUT, STATUS_MEMORY, or that of a function of the grid. */
int vtk_read_legacy(struct vtk_grid *grid);
int vtk_read_xml(struct vtk_grid *grid);

/* Finds the next DataSet of a text, and moves *text behind it: the file that it names, and the time. False: there is
 * none. */
bool vtk_next_set(const char **text, char time[XML_WORD], char file[XML_WORD]);

/* The type by its name in a legacy or XML file. size 0: there is none. */
struct vtk_type vtk_find_type(const char *name);

/* Whether an array on points is wanted. */
bool vtk_wants(const struct vtk_grid *grid, const char *name);

/* Hands an array on points, which this function frees, to all that want it. Status 0, STATUS_MEMORY, or STATUS_INPUT if
 * there is another array of this name. */
int vtk_give(struct vtk_grid *grid, const char *name, double *values);

/* Hands the points and arrays of a piece to grid->take and forgets them. */
int vtk_end_piece(struct vtk_grid *grid);

/* Converts bytes to values. big: the bytes are big-endian. */
void vtk_convert(struct vtk_type type, bool big, const void *bytes, uint64_t count, double *values);

/* Reads values from text and moves *text behind them. values NULL: skips them. False: there are fewer than `count`. */
bool vtk_scan(const char **text, const char *end, uint64_t count, double *values);

/* Prints an error with the line of `at`, a pointer into the file. at NULL: without a line. Returns STATUS_INPUT. */
int vtk_fail(const struct vtk_grid *grid, const char *at, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Allocates room for `count` values. Frees *values before. Status 0 or STATUS_MEMORY. */
int vtk_room(double **values, uint64_t count);

#endif
