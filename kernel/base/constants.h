/* constants.h - numbers that several files use. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_BASE_CONSTANTS_H
#define FIBRAD_BASE_CONSTANTS_H

#define FIBRAD_PI 3.14159265358979323846

/* The largest coordinate, in smallest radii or half lengths of all meshes together. It leaves room for the digits of a
 * radius. */
#define FIBRAD_COORDINATE_MAX 0x1p45

/* No search goes farther than this many periods along a periodic axis. */
#define FIBRAD_PERIODS 100.0

#endif
