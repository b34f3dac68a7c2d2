/* vtp.h - VTK XML polydata for ParaView: one point and vertex per sphere. SPDX-License-Identifier: MIT */
#ifndef VTP_H
#define VTP_H

#include <stdint.h>
#include <stdio.h>

#include "bed/bed.h"

/* Begins a file of the spheres; their radii are its first array, `scalars` the one that ParaView shows first. Arrays of
 * [bed->n] values follow, then vtp_end. */
void vtp_begin(FILE *file, const struct bed *bed, const char *scalars);
void vtp_end(FILE *file, const struct bed *bed);

/* An array of numbers; valid, unless NULL, tells which are there. */
void vtp_doubles(FILE *file, const char *name, const double *values, uint32_t n, const unsigned char *valid);

/* An array of whole numbers. */
void vtp_counts(FILE *file, const char *name, const int64_t *values, uint32_t n);

#endif
