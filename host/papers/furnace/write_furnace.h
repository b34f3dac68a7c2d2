/* write_furnace.h - writes the fields of a box. SPDX-License-Identifier: MIT */
#ifndef WRITE_FURNACE_H
#define WRITE_FURNACE_H

#include <stdio.h>

#include "papers/furnace/furnace_run.h"

/* Writes the fields to a file. The caller checks the file for errors. */
typedef void write_furnace_function(FILE *file, const struct furnace_run *run);

/* Write `x,y,z,T,E,divq` of each cell, x fastest; write image data for ParaView with T, E and divq. */
write_furnace_function write_furnace_csv, write_furnace_vti;

/* The writer for the ending of a path. NULL: the ending is neither .csv nor .vti. */
write_furnace_function *write_furnace_find(const char *path);

#endif
