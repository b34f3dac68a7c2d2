/* write_furnace.h - the fields of a box to files. SPDX-License-Identifier: MIT */
#ifndef WRITE_FURNACE_H
#define WRITE_FURNACE_H

#include <stdio.h>

#include "boxes/furnace_run.h"

/* Writes to the file; the caller checks it for errors. */
typedef void write_furnace_function(FILE *file, const struct furnace_run *run);

/* `x,y,z,T,E,divq` of each cell, x fastest; and image data for ParaView with the same three fields. */
write_furnace_function write_furnace_csv, write_furnace_vti;

/* The writer for the ending of a path; NULL if it is neither .csv nor .vti. */
write_furnace_function *write_furnace_find(const char *path);

#endif
