/* write_furnace.h - writes the fields of a box. SPDX-License-Identifier: MIT */
#ifndef WRITE_FURNACE_H
#define WRITE_FURNACE_H

#include <stdio.h>

#include "papers/furnace/furnace_run.h"

/* Write `x,y,z,T,E,divq` of each cell, x fastest; image data for ParaView with T, E and divq. The caller checks the
 * file for errors. */
void write_furnace_csv(FILE *file, const struct furnace_run *run);
void write_furnace_vti(FILE *file, const struct furnace_run *run);

#endif
