/* vtk_grid.h - points of a VTK file and the arrays on them that are wanted. SPDX-License-Identifier: MIT */
#ifndef VTK_GRID_H
#define VTK_GRID_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* One value of an array. */
struct vtk_type {
    size_t size;       /* bytes; 0: unknown */
    char kind;         /* f, i (with sign) or u */
    const char *names; /* in legacy and XML files, each with a blank before and behind */
};

/* An array that is wanted. */
struct vtk_wanted {
    const char *const *names; /* in any case, NULL ends them; or one name as it is */
    const char *name;
    bool required;
    double *values; /* [n], NULL: it is not there. To be freed */
};

struct vtk_grid {
    const char *file; /* for messages */
    const char *text; /* the whole file */
    const char *end;
    uint64_t n;
    double *points; /* [3 n] to be freed */
    struct vtk_wanted *wanted;
    size_t count;
};

/* Reads the points and the arrays wanted. Status 0, STATUS_INPUT or STATUS_MEMORY; what is to be freed is so also after
 * an error. Numbers are finite or not. */
int vtk_read_legacy(struct vtk_grid *grid);
int vtk_read_xml(struct vtk_grid *grid);

/* The type of a name, of either kind of file; its size is 0 if there is none. */
struct vtk_type vtk_find_type(const char *name);

/* Where values of an array on points are wanted; NULL: nowhere. */
double **vtk_find_wanted(const struct vtk_grid *grid, const char *name);

/* Values from bytes. */
void vtk_convert(struct vtk_type type, bool big, const void *bytes, uint64_t count, double *values);

/* Values from text; *text is moved behind them. False: there are fewer. */
bool vtk_scan(const char **text, const char *end, uint64_t count, double *values);

/* `fibrad: FILE: what` or `FILE:LINE: what`, the line being that of a place in the file. Status STATUS_INPUT. */
int vtk_fail(const struct vtk_grid *grid, const char *at, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Room for so many values. Status 0 or STATUS_MEMORY. */
int vtk_room(double **values, uint64_t count);

#endif
