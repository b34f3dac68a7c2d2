# _limits.py - bounds of arguments, as in kernel/fibrad_limits.h. SPDX-License-Identifier: MIT
DIRECTIONS = (8, 65536)
NODES = (8, 987)
POINTS = (64, 128, 256)
PATCHES = (24, 96, 384)
LENGTH_MAX = 1e150
TEMPERATURE_MAX = 1e20
POWER_MAX = 1e100
SIGMA = (1e-30, 1e30)
CAPACITY_MAX = 1e300
DURATION_MAX = 1e300
