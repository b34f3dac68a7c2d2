/* constants.h - numbers that have one place. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_BASE_CONSTANTS_H
#define FIBRAD_BASE_CONSTANTS_H

#define FIBRAD_PI 3.14159265358979323846

#endif
