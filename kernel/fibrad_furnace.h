/* fibrad_furnace.h - radiation in a box filled with a grey medium that absorbs, emits and scatters isotropically,
 * between grey diffuse walls of known temperatures.
 *
 * Index
 *   furnace   fibrad_furnace_size, _init, _fields, _temperature
 *   equations fibrad_furnace_theta, _solve, _balance
 *   bundles   fibrad_furnace_emit, _tally_size, _tally_init, _trace, _tally_add, _estimate, _equilibrium
 *
 * Conventions are those of fibrad.h, but metres, watts and kelvins. The medium takes the temperatures at which every
 * cell emits `source` more than it absorbs; E = sigma T^4 [W/m2]. docs/furnace.md explains the methods.
 *
 * Monte Carlo is a protocol: fibrad_furnace_emit plans bundles of rays; every bundle of the plan is traced exactly
 * once, into tallies; the tallies are added up; fibrad_furnace_estimate or _equilibrium evaluates the sum. Further
 * plans continue in the same tallies until a restart, which requires empty ones. A tally records which bundles it
 * holds: a bundle missing or traced twice, a tally of another furnace or from before a restart is FIBRAD_E_STATE.
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
    double absorption;          /* 1/m; times an edge of a cell from 1e-9 to 1e9; without absorption E is undefined */
    double scattering;          /* 1/m; times an edge of a cell from 0 to 1e9 */
    double source;              /* W/m3 emitted by the medium, net, of either sign, up to 1e30 */
    double wall_temperature[6]; /* K, 1e-3 to 1e9; walls in the order x = 0, x = X, y = 0, y = Y, z = 0, z = Z */
    double wall_emissivity[6];  /* [0, 1], not all 0 */
    uint64_t seed;              /* of the bundles of rays */
} fibrad_furnace_config;

/* The state of one box: temperatures, fluxes, coefficients and the plan of bundles. */
typedef struct fibrad_furnace fibrad_furnace;

/* Bytes that fibrad_furnace_init needs. Errors: 0 if the configuration is NULL or not valid. Cost: O(1). */
size_t fibrad_furnace_size(const fibrad_furnace_config *config);

/* Makes a furnace in `memory` (`size` bytes): E is that of the median wall, weighted by emissivity and area, Theta 2/3.
 * Errors: _ARGUMENT, _SIZE. Cost: O(cells). */
int fibrad_furnace_init(fibrad_furnace **furnace, void *memory, size_t size, const fibrad_furnace_config *config);

/* The arrays of a furnace, x fastest. `cell` arrays have cells[0] cells[1] cells[2] elements, `face` arrays of axis a
 * one layer more along a. Hemisphere 0 points up the axis, 1 down. The caller may write e, flux and theta. */
typedef struct fibrad_furnace_arrays {
    double *e;                /* cell: sigma T^4 [W/m2] */
    double *divergence;       /* cell: net emission [W/m3]; equals the source once solved */
    double *six_flux;         /* cell: sum of the mean fluxes of its faces, both hemispheres of all axes [W/m2] */
    double *flux[3][2];       /* face: q+ and q- of the axis [W/m2], as solved or measured last */
    double *theta[3][2];      /* face: Theta+ and Theta-, as set or measured last */
    double *transverse[3][2]; /* cell: C+ and C-, over the mean flux of the cell's two faces [1/m] */
    double *wall[6];          /* net flux from the wall [W/m2], a layer of cells each */
    double *power;            /* [6] net power that leaves each wall [W] */
} fibrad_furnace_arrays;

/* Copies the addresses of the arrays, which do not change; null pointers: no operation. No errors. */
void fibrad_furnace_fields(fibrad_furnace *furnace, fibrad_furnace_arrays *arrays);

/* Temperature [K] of E [W/m2]; 0 unless E is positive. No errors. Cost: two square roots. */
double fibrad_furnace_temperature(double e);

/* Sets Theta to one constant, (0, 1], and the transverse term to zero: 1 is the heat-flux method (HFM), 2/3 holds for
 * isotropic radiation. Errors: _ARGUMENT. Cost: O(cells). Source: docs/furnace.md. */
int fibrad_furnace_theta(fibrad_furnace *furnace, double theta);

/* The scattering source of the heat-flux equations. */
typedef enum fibrad_furnace_scatter {
    FIBRAD_SCATTER_SIX_FLUX = 0, /* a sixth of the sum of the six fluxes */
    FIBRAD_SCATTER_EXACT = 1     /* E - source/(4 absorption), a quarter of the true incident radiation */
} fibrad_furnace_scatter;

typedef struct fibrad_furnace_report {
    uint32_t sweeps;
    double change; /* largest change of E in the last sweep [W/m2] */
} fibrad_furnace_report;

/* Solves the heat-flux equations for E and the fluxes with the present Theta and transverse term: sweeps along all
 * lines of cells, each solved exactly between its two walls, until no cell changes by more than `tolerance` [W/m2] or
 * sweeps_max is reached (which the report shows; it is no error).
 * Errors: _ARGUMENT, also if a change of E is not finite, because of what the caller has written into the arrays; all
 * fields but Theta are then undefined. Cost: about 60 ns per cell and sweep; tens of sweeps where the medium is thin,
 * more with the square of the optical thickness. Source: Zhao, Li, Wu, Li, Cang, J. Univ. Sci. Technol. Beijing 27
 * (2005) 423, equations 5 to 8. */
int fibrad_furnace_solve(fibrad_furnace *furnace, fibrad_furnace_scatter scatter, double tolerance, uint32_t sweeps_max,
                         fibrad_furnace_report *report);

/* Sets divergence, six_flux, wall and power from the fluxes, which another solver has written.
 * Errors: _ARGUMENT. Cost: O(cells). */
int fibrad_furnace_balance(fibrad_furnace *furnace);

/* What bundles of rays do. */
typedef enum fibrad_furnace_physics {
    FIBRAD_FURNACE_ATTENUATED = 0, /* lose energy to the medium, whose emission follows E: for Theta */
    FIBRAD_FURNACE_EQUILIBRIUM = 1 /* the medium emits again what it absorbs, so that E follows: direct Monte Carlo */
} fibrad_furnace_physics;

/* Plans the bundles to be traced next. Transport is linear and tallies are additive: the first plan takes about
 * `bundles` bundles for the emission of walls and medium above the median wall; each further plan takes only what the
 * change of E since then emits, at the same energy per bundle (FIBRAD_FURNACE_EQUILIBRIUM: nothing). `restart` not 0 or
 * another physics makes a first plan again, for new tallies. Every source has a whole number of bundles, at least one;
 * their sum is written to `planned`, and may be 0. bundles [1, 2^32].
 * Errors: _ARGUMENT, also if E is not finite or its change needs more than 2^33 bundles; in these two cases there is no
 * plan then, and the next is a first one. Cost: O(cells). */
int fibrad_furnace_emit(fibrad_furnace *furnace, fibrad_furnace_physics physics, uint64_t bundles, int restart,
                        uint64_t *planned);

/* Sums over bundles, in whole numbers: any division of the work gives the same bits. */
typedef struct fibrad_furnace_tally fibrad_furnace_tally;

/* Bytes that fibrad_furnace_tally_init needs for a tally of this furnace. Errors: 0 for NULL. Cost: O(1). */
size_t fibrad_furnace_tally_size(const fibrad_furnace *furnace);

/* Makes an empty tally in `memory` (`size` bytes), for one thread at a time.
 * Errors: _ARGUMENT, _SIZE. Cost: O(cells). */
int fibrad_furnace_tally_init(fibrad_furnace_tally **tally, void *memory, size_t size, const fibrad_furnace *furnace);

/* Traces bundles [first, first + count) of the plan into a tally. The furnace is only read: threads may share it.
 * Errors: _ARGUMENT, also if the range extends beyond the plan; _STATE without a plan, or if the tally holds bundles of
 * another furnace or from before the restart, or was made for other cells; the tally is then as before.
 * Cost: about 0.6 (equilibrium) to 1.1 microseconds per bundle in a box of 20 x 20 x 40 cells; it is proportional to
 * the number of events until absorption: the square of the optical thickness in a thick medium, 1/emissivity between
 * walls that hardly absorb. */
int fibrad_furnace_trace(const fibrad_furnace *furnace, fibrad_furnace_tally *tally, uint64_t first, uint64_t count);

/* Adds `from` to `to`, which must be two tallies of one furnace since one restart.
 * Errors: _ARGUMENT, also for a tally and itself; _STATE for tallies that do not belong together; `to` is then as
 * before. Cost: O(cells). */
int fibrad_furnace_tally_add(fibrad_furnace_tally *to, const fibrad_furnace_tally *from);

/* Which ratio of the moments F_n = sum(w cos^n) over the bundles that cross a face is taken for Theta. */
typedef enum fibrad_furnace_estimator {
    FIBRAD_THETA_DEFINITION = 0, /* F1/F0: the ratio of equations 1 and 2; 2/3 for isotropic radiation */
    FIBRAD_THETA_PAPER = 1       /* F2/F1: equation 9 read with bundles of energy; 3/4 for isotropic radiation */
} fibrad_furnace_estimator;

/* Sets flux and Theta from the sum of all tallies since the last restart (FIBRAD_FURNACE_ATTENUATED); with `transverse`
 * not 0 (FIBRAD_THETA_DEFINITION only) also the term of equations 5 and 6 that the paper omits, from the balance of
 * each cell. Results are averages over the symmetries of the box: mirror images and exchanges of axes. Where bundles
 * are so few that a moment is not positive, Theta does not change. May be repeated with the same tally.
 * Errors: _ARGUMENT; _STATE unless the plans since the restart are of this physics and the tally holds every bundle of
 * them exactly once. Cost: O(cells times symmetries). */
int fibrad_furnace_estimate(fibrad_furnace *furnace, const fibrad_furnace_tally *tally,
                            fibrad_furnace_estimator estimator, int transverse, fibrad_furnace_scatter scatter);

/* Sets E, divergence, wall fluxes and powers from the sum of all tallies since the last restart
 * (FIBRAD_FURNACE_EQUILIBRIUM); E is an average over the symmetries of the box. Errors and cost: as above. */
int fibrad_furnace_equilibrium(fibrad_furnace *furnace, const fibrad_furnace_tally *tally);

#ifdef __cplusplus
}
#endif
#endif
