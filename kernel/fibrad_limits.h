/* fibrad_limits.h - bounds of arguments, and what an argument of 0 stands for.
 *
 * fibrad.h includes this header. The program's help, the Python package and the Fortran module have the same numbers.
 *
 * SPDX-License-Identifier: MIT */
#ifndef FIBRAD_LIMITS_H
#define FIBRAD_LIMITS_H

/* Scenes */
#define FIBRAD_LENGTH_MIN    1e-150 /* L, of radii and periods */
#define FIBRAD_LENGTH_MAX    1e150  /* L, of radii, periods and coordinates */
#define FIBRAD_SPHERES_MAX   100000000u
#define FIBRAD_TRIANGLES_MAX 100000000u
#define FIBRAD_WALLS_MAX     32

/* Rows by beams */
#define FIBRAD_DIRECTIONS_MIN     8
#define FIBRAD_DIRECTIONS_MAX     65536
#define FIBRAD_DIRECTIONS_DEFAULT 233
#define FIBRAD_DIRECTIONS_FIRST   100 /* with a tolerance: the number to begin with */

/* Rows of a matrix along lines */
#define FIBRAD_LINES_AMONG_WALLS 233  /* spheres far from walls see them in one sense */
#define FIBRAD_LINES_DEFAULT     181  /* without walls */
#define FIBRAD_LINES_EVEN_MAX    1024 /* lines of the largest set */

/* Rows by rays: rays of each sphere */
#define FIBRAD_RAYS_DEFAULT 20000

/* Rows by the surface method: nodes on each sphere, a Fibonacci number */
#define FIBRAD_NODES_MIN     8
#define FIBRAD_NODES_MAX     987
#define FIBRAD_NODES_DEFAULT 55

/* Exchange factors: directions of the first segment, and paths of each sphere and of each wall */
#define FIBRAD_EXCHANGE_DIRECTIONS_DEFAULT 50
#define FIBRAD_PATHS_DEFAULT               400
#define FIBRAD_WALL_PATHS_DEFAULT          8192
#define FIBRAD_PATHS_MAX                   (1u << 28)

/* Spheres that conduct: relative conductivities k* = k_s/(4 d sigma T^3) */
#define FIBRAD_RELATIVE_CONDUCTIVITY_MIN 1e-6
#define FIBRAD_FLIGHTS_DEFAULT           12 /* half of a path, see fibrad_exchange_displacement */
#define FIBRAD_FLIGHTS_MAX               256

/* Heat */
#define FIBRAD_TEMPERATURE_MAX         1e20 /* K; its fourth power is far from overflow */
#define FIBRAD_POWER_MAX               1e100
#define FIBRAD_CONDUCTANCE_MAX         1e60  /* of a contact */
#define FIBRAD_SIGMA_MIN               1e-30 /* of E = sigma T^4 */
#define FIBRAD_SIGMA_MAX               1e30
#define FIBRAD_CAPACITY_MAX            1e300 /* heat capacity of a sphere */
#define FIBRAD_DURATION_MAX            1e300
#define FIBRAD_HEAT_RADIUS_MIN         1e-30 /* L; the largest radius is 1 over it */
#define FIBRAD_HEAT_DIRECTIONS_DEFAULT 168
#define FIBRAD_HEAT_POINTS_DEFAULT     64
#define FIBRAD_HEAT_PATCHES_DEFAULT    96
#define FIBRAD_HEAT_PATCHES_MAX        384
#define FIBRAD_HEAT_PARTS_DEFAULT      8
#define FIBRAD_HEAT_PARTS_MAX          1024
#define FIBRAD_GAS_REACH_DEFAULT       0.65   /* of --gas-gap and of couplings: docs/validation.md */
#define FIBRAD_GAS_LEAST_DEFAULT       4e-10  /* m, least gap with gas that counts: the distance of molecules */
#define FIBRAD_WALL_RAYS_DEFAULT       262144 /* least number of rays from all walls together */
#define FIBRAD_WALL_RAYS_MAX           (1u << 30)

/* Light from outside */
#define FIBRAD_SUN_HALF_ANGLE           4.65e-3 /* rad */
#define FIBRAD_HALF_ANGLE_MAX           0.5     /* rad */
#define FIBRAD_LIGHT_DIRECTIONS_DEFAULT 16      /* of cones to 0.02 rad; wider ones have as many for each solid angle */
#define FIBRAD_LIGHT_DIRECTIONS_MAX     4096

#endif
