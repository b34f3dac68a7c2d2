/* file_arrays.h - beds and meshes of files as arrays, for Python: libfibrad_files.so. SPDX-License-Identifier: MIT
 *
 * Only one thread may call these functions at a time. `report` is called with each line of warnings and errors. */
#ifndef FILE_ARRAYS_H
#define FILE_ARRAYS_H

#include "fibrad.h"

#define FILE_ARRAYS_EXPORT __attribute__((visibility("default")))

typedef void file_report(void *context, const char *line);

/* The spheres of one frame, in the order of their ids. */
struct file_bed {
    double *x, *y, *z, *r; /* [n] in the file's unit */
    int64_t *id;           /* [n] NULL: there are no ids */
    double *extra;         /* [n][columns] */
    double low[3], high[3], period[3];
    int64_t frame, timestep; /* timestep -1: the file names none */
    char units[16];          /* of length; "": the file names none */
    void *bed;               /* owns the arrays */
    uint32_t n;
};

/* The frame, the columns and the rows to read. */
struct file_wanted {
    const char *path;
    int64_t frame;                /* from 0; -1: the last one */
    const char *const *column;    /* [columns] names of further columns, all of numbers */
    const char *const (*name)[2]; /* [names] columns that the file calls otherwise: x, and its name in the file */
    const char *const (*only)[2]; /* [onlys] columns and values: rows with other values are left out */
    const char *const (*skip)[2]; /* [skips] columns and values: rows with these values are left out */
    size_t columns, names, onlys, skips;
    int no_radius; /* not 0: radii are not read, r is NaN */
};

/* Reads a frame. Free the bed also after an error. Returns 0 or a value of exit_status (cli/message.h). */
FILE_ARRAYS_EXPORT int fibrad_file_read(const struct file_wanted *wanted, struct file_bed *found, file_report *report,
                                        void *context);
FILE_ARRAYS_EXPORT void fibrad_file_free(struct file_bed *found);

/* Triangles whose fronts are the wall. both: their backs are the wall, too. */
struct file_mesh {
    double *vertex;   /* [vertices][3] */
    uint32_t *corner; /* [n][3] */
    void *meshes;     /* owns the arrays */
    uint32_t vertices, n;
    int both;
};

/* Reads a mesh. sides: 0: the sides on which spheres lie are the wall; 1: the fronts by the winding of the file; 2:
 * both sides. Free the mesh also after an error. Status as fibrad_file_read, and STATUS_INPUT if some triangles have
 * one side and others both. */
FILE_ARRAYS_EXPORT int fibrad_file_mesh(const char *path, double scale, int sides, const fibrad_spheres *spheres,
                                        const double period[3], struct file_mesh *found, file_report *report,
                                        void *context);
FILE_ARRAYS_EXPORT void fibrad_file_mesh_free(struct file_mesh *found);

/* Bytes of a structure of this header, by its name. 0: there is none. */
FILE_ARRAYS_EXPORT size_t fibrad_file_sizeof(const char *name);

#endif
