/* file_arrays.h - beds and meshes of files as arrays, for Python: libfibrad_files.so. SPDX-License-Identifier: MIT
 *
 * One call at a time. What is said on the way, warnings and the reason of an error, goes to `heard`, a line a call. */
#ifndef FILE_ARRAYS_H
#define FILE_ARRAYS_H

#include <stddef.h>
#include <stdint.h>

#include "fibrad.h"

#define FILE_ARRAYS_EXPORT __attribute__((visibility("default")))

typedef void file_heard(void *context, const char *line);

/* Spheres of one frame, in the order of their ids. */
struct file_bed {
    double *x, *y, *z, *r; /* [n] in the file's unit */
    int64_t *id;           /* [n] NULL: they have none */
    double *extra;         /* [n][columns] */
    double low[3], high[3], period[3];
    int64_t frame, timestep; /* -1: the file says none */
    char units[16];          /* of length, "": the file says none */
    void *bed;               /* whose they are */
    uint32_t n;
};

/* What of a file is wanted. */
struct file_wanted {
    const char *path;
    int64_t frame;             /* from 0; -1: the last one */
    const char *const *column; /* [columns] further ones by name, numbers all */
    size_t columns;
    int no_radius; /* not 0: r is NaN */
};

/* Status 0, or one of exit_status. Free the bed also after an error. */
FILE_ARRAYS_EXPORT int fibrad_file_read(const struct file_wanted *wanted, struct file_bed *found, file_heard *heard,
                                        void *context);
FILE_ARRAYS_EXPORT void fibrad_file_free(struct file_bed *found);

/* Triangles whose fronts are the wall, as the program chooses sides; both: backs, too. */
struct file_mesh {
    double *vertex;   /* [vertices][3] */
    uint32_t *corner; /* [n][3] */
    void *meshes;     /* whose they are */
    uint32_t vertices, n;
    int both;
};

/* sides: 0 those that spheres are on, 1 as the file winds its triangles, 2 both. Status as above; STATUS_INPUT, too, if
 * some parts have one side and others both. Free the mesh also after an error. */
FILE_ARRAYS_EXPORT int fibrad_file_mesh(const char *path, double scale, int sides, const fibrad_spheres *spheres,
                                        const double period[3], struct file_mesh *found, file_heard *heard,
                                        void *context);
FILE_ARRAYS_EXPORT void fibrad_file_mesh_free(struct file_mesh *found);

/* Bytes of a structure of this header by its name, 0 if there is none. */
FILE_ARRAYS_EXPORT size_t fibrad_file_sizeof(const char *name);

#endif
