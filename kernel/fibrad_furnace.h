/* fibrad_furnace.h - radiation in a box full of a grey medium which absorbs, emits and scatters isotropically, between
 * grey diffuse walls of known temperatures.
 *
 * Index: fibrad_furnace_size, _init, _fields, _temperature, _theta, _solve, _balance, _tally_size, _tally_init,
 * _tally_add, _emit, _trace, _estimate, _equilibrium. Conventions are those of fibrad.h, but metres, watts and kelvins.
 * The medium takes the temperatures at which every cell gives off `source`; E = sigma T^4 [W/m2]. docs/furnace.md
 * explains the methods.
 *
 * SPDX-License-Identifier: MIT */
#ifndef FIBRAD_FURNACE_H
#define FIBRAD_FURNACE_H

#include "fibrad.h"

#ifdef __cplusplus
extern "C" {
#endif

#define FIBRAD_FURNACE_CELLS_MAX 100000000u

typedef struct fibrad_furnace_config {
    double size[3];             /* m, from 1e-9 to 1e9 */
    uint32_t cells[3];          /* along x, y, z; the product is at most FIBRAD_FURNACE_CELLS_MAX */
    double absorption;          /* 1/m; times an edge of a cell from 1e-9 to 1e9: unabsorbed there is no temperature */
    double scattering;          /* 1/m; times an edge of a cell from 0 to 1e9 */
    double source;              /* W/m3 given off by the medium, of either sign, up to 1e30 */
    double wall_temperature[6]; /* K, 1e-3 to 1e9; walls in the order x = 0, x = X, y = 0, y = Y, z = 0, z = Z */
    double wall_emissivity[6];  /* [0, 1], not all 0 */
    uint64_t seed;              /* of the bundles of rays */
} fibrad_furnace_config;

/* The state of one box: temperatures, fluxes, coefficients, and which bundles are to be traced next. */
typedef struct fibrad_furnace fibrad_furnace;

/* Bytes that fibrad_furnace_init needs. Errors: 0 if the configuration is NULL or not valid. Cost: tens of
 * nanoseconds. */
size_t fibrad_furnace_size(const fibrad_furnace_config *config);

/* Makes a furnace in `memory` (`size` bytes): E is the mean of the walls, Theta 2/3 everywhere.
 * Errors: _ARGUMENT, _SIZE. Cost: O(cells). */
int fibrad_furnace_init(fibrad_furnace **furnace, void *memory, size_t size, const fibrad_furnace_config *config);

/* The arrays of a furnace, x fastest. `cell` arrays have cells[0] cells[1] cells[2] elements; `face` arrays of axis a
 * one layer more along a; hemisphere 0 goes up the axis, 1 down. The caller may write e, flux and theta. */
typedef struct fibrad_furnace_arrays {
    double *e;                /* cell: sigma T^4 [W/m2] */
    double *divergence;       /* cell: net radiation given off [W/m3]; equals the source once solved */
    double *six_flux;         /* cell: sum of the mean fluxes of its faces, both hemispheres of all axes [W/m2] */
    double *flux[3][2];       /* face: q+ and q- of the axis [W/m2], as solved or measured last */
    double *theta[3][2];      /* face: Theta+ and Theta-, as set or measured last */
    double *transverse[3][2]; /* cell: C+ and C-, over the mean flux of the cell's two faces [1/m] */
    double *wall[6];          /* net flux from the wall [W/m2], a layer of cells each */
    double *power;            /* [6] what each wall gives, net [W] */
} fibrad_furnace_arrays;

/* Tells where the arrays are, which stay there; null pointers: nothing. No errors. Cost: a copy. */
void fibrad_furnace_fields(fibrad_furnace *furnace, fibrad_furnace_arrays *arrays);

/* Temperature [K] of E [W/m2]; 0 unless E is positive. No errors. Cost: two square roots. */
double fibrad_furnace_temperature(double e);

/* Makes Theta the same constant everywhere, (0, 1], without transverse term: 1 for the heat-flux method (HFM), 2/3 for
 * isotropic radiation. Errors: _ARGUMENT. Cost: O(cells). Source: docs/furnace.md. */
int fibrad_furnace_theta(fibrad_furnace *furnace, double theta);

/* What the scattered part of the heat-flux equations is made of. */
typedef enum fibrad_furnace_scatter {
    FIBRAD_SCATTER_SIX_FLUX = 0, /* a sixth of the sum of the six fluxes */
    FIBRAD_SCATTER_EXACT = 1     /* E - source/(4 absorption), a quarter of the true incident radiation */
} fibrad_furnace_scatter;

typedef struct fibrad_furnace_report {
    uint32_t sweeps;
    double change; /* largest change of E in the last sweep [W/m2] */
} fibrad_furnace_report;

/* Solves the heat-flux equations for E and the fluxes, with Theta and the transverse term as they stand: sweeps along
 * all lines of cells, each solved exactly between its two walls, until no cell changes by more than `tolerance`
 * [W/m2] or sweeps_max is reached (which the report shows; it is no error).
 * Errors: _ARGUMENT. Cost: about 60 ns per cell and sweep; tens of sweeps where the medium is thin, more with the
 * square of the optical thickness. Source: Zhao, Li, Wu, Li, Cang, J. Univ. Sci. Technol. Beijing 27 (2005) 423,
 * equations 5 to 8. */
int fibrad_furnace_solve(fibrad_furnace *furnace, fibrad_furnace_scatter scatter, double tolerance, uint32_t sweeps_max,
                         fibrad_furnace_report *report);

/* Sets divergence, six_flux, wall and power from the fluxes, which the caller has written: for other solvers.
 * Errors: _ARGUMENT. Cost: O(cells). */
int fibrad_furnace_balance(fibrad_furnace *furnace);

/* Counts of bundles, in whole numbers: any split of the work adds up to the same bits. */
typedef struct fibrad_furnace_tally fibrad_furnace_tally;

/* Bytes that fibrad_furnace_tally_init needs for a tally of this furnace. Errors: 0 for NULL. Cost: tens of
 * nanoseconds. */
size_t fibrad_furnace_tally_size(const fibrad_furnace *furnace);

/* Makes an empty tally in `memory` (`size` bytes), for one thread at a time.
 * Errors: _ARGUMENT, _SIZE. Cost: O(cells). */
int fibrad_furnace_tally_init(fibrad_furnace_tally **tally, void *memory, size_t size, const fibrad_furnace *furnace);

/* Adds `from` to `to`, tallies of the same furnace (of others, and with null pointers, nothing). Cost: O(cells). */
void fibrad_furnace_tally_add(fibrad_furnace_tally *to, const fibrad_furnace_tally *from);

/* What bundles of rays do. */
typedef enum fibrad_furnace_physics {
    FIBRAD_FURNACE_ATTENUATED = 0, /* lose energy to the medium, whose emission follows E: for Theta */
    FIBRAD_FURNACE_EQUILIBRIUM = 1 /* what is absorbed is given off again, so that E follows: direct Monte Carlo */
} fibrad_furnace_physics;

/* Plans the bundles to be traced next. Transport is linear, and tallies add up: after the first plan, which takes about
 * `bundles` bundles for all that walls and medium emit above the mean of the walls, each further plan carries only what
 * the change of E since then adds, at the same energy per bundle. `restart` makes a first plan again, for new tallies.
 * `planned` gets the number of bundles: every source is given a whole number of them, at least one.
 * bundles [1, 2^32]. Errors: _ARGUMENT, also if E is not finite or its change asks for more than 2^33 bundles; there is
 * no plan then, and the next is a first one. Cost: O(cells). */
int fibrad_furnace_emit(fibrad_furnace *furnace, fibrad_furnace_physics physics, uint64_t bundles, int restart,
                        uint64_t *planned);

/* Traces bundles [first, first + count) of the plan into a tally. The furnace is only read: threads may share it.
 * Errors: _ARGUMENT, also for the tally of a furnace of other cells. Cost: about 0.6 (equilibrium) to 1.1 microseconds
 * per bundle in a box of 20 x 20 x 40 cells; it goes with the number of events until absorption, which in a thick
 * medium is the square of the optical thickness, and between walls that hardly absorb 1/emissivity. */
int fibrad_furnace_trace(const fibrad_furnace *furnace, fibrad_furnace_tally *tally, uint64_t first, uint64_t count);

/* Which ratio of the moments F_n = sum(w cos^n) over the bundles that cross a face is taken for Theta. */
typedef enum fibrad_furnace_estimator {
    FIBRAD_THETA_DEFINITION = 0, /* F1/F0: the ratio of equations 1 and 2; 2/3 for isotropic radiation */
    FIBRAD_THETA_PAPER = 1       /* F2/F1: equation 9 read with bundles of energy; 3/4 for isotropic radiation */
} fibrad_furnace_estimator;

/* Sets flux and Theta from the sum of all tallies since the last restart (FIBRAD_FURNACE_ATTENUATED); with `transverse`
 * not 0 (FIBRAD_THETA_DEFINITION only) also the term of equations 5 and 6 that the paper drops, from the balance of
 * each cell. Mirror images and exchanged axes under which the box stays as it is are averaged over. Where bundles are
 * so few that a moment is not positive, Theta stays as it was. Errors: _ARGUMENT. Cost: O(cells). */
int fibrad_furnace_estimate(fibrad_furnace *furnace, const fibrad_furnace_tally *tally,
                            fibrad_furnace_estimator estimator, int transverse, fibrad_furnace_scatter scatter);

/* Sets E, wall fluxes and powers from the sum of all tallies since the last restart (FIBRAD_FURNACE_EQUILIBRIUM).
 * Errors: _ARGUMENT, also after a plan of the other physics and for the tally of a furnace of other cells. Cost:
 * O(cells times symmetries). */
int fibrad_furnace_equilibrium(fibrad_furnace *furnace, const fibrad_furnace_tally *tally);

#ifdef __cplusplus
}
#endif
#endif
