/* constants.h - numbers that have one place. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_BASE_CONSTANTS_H
#define FIBRAD_BASE_CONSTANTS_H

#define FIBRAD_PI 3.14159265358979323846

/* The largest coordinate, in smallest radii or half lengths of all meshes together. It leaves room for the digits of a
 * radius. */
#define FIBRAD_COORDINATE_MAX 0x1p45

#endif
