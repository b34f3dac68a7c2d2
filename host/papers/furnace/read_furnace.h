/* read_furnace.h - boxes from text files of keys and values. SPDX-License-Identifier: MIT */
#ifndef READ_FURNACE_H
#define READ_FURNACE_H

#include "fibrad_furnace.h"

/* Reads a box. Lines may come in any order. # begins a comment.
 *     size 2 2 4            m
 *     cells 20 20 40
 *     absorption 0.5        1/m
 *     scattering 0          1/m, optional
 *     source 5000           W/m3, optional
 *     wall x0 900 0.70      K and emissivity; walls are x0 x1 y0 y1 z0 z1; `sides` means the first four
 * Status 0, STATUS_INPUT naming the line, STATUS_FILE, STATUS_MEMORY, or that of a signal. */
int read_furnace(const char *path, fibrad_furnace_config *config);

#endif
