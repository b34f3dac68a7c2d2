/* fibrad_furnace.h - radiation in a box filled with a grey medium, between grey diffuse walls of given temperatures.
 * The medium absorbs, emits and scatters isotropically.
 *
 * Index
 *   furnace    fibrad_furnace_size, _init, _fields, _temperature
 *   equations  fibrad_furnace_theta, _solve
 *   bundles    fibrad_furnace_emit, _tally_size, _tally_init, _trace, _tally_add, _estimate, _equilibrium
 *
 * Problem    Every cell of the medium emits `source` more than it absorbs. This gives the temperatures of the medium.
 *            E = sigma T^4 [W/m2].
 * Equations  For each axis and hemisphere (up or down the axis) q is the flux [W/m2]. Theta is the integral of I cos^2
 *            over the integral of I cos, I being the intensity. The transverse term C is what the other axes add.
 *            docs/validation.md has the equations.
 * Bundles    1. fibrad_furnace_emit plans bundles of rays.
 *            2. fibrad_furnace_trace traces every bundle of the plan once, into one tally for each thread.
 *            3. fibrad_furnace_tally_add adds the tallies up.
 *            4. fibrad_furnace_estimate or fibrad_furnace_equilibrium evaluates the sum.
 *            Repeat from step 1 with the same tallies. After a restart the tallies must be empty. A tally records which
 *            bundles it holds. A call returns FIBRAD_E_STATE if a bundle is missing or was traced twice, or if a tally
 *            belongs to another furnace or restart.
 * Units      metres, watts and kelvins. Words, memory, errors and the layout of comments are as in fibrad.h.
 * Source     docs/validation.md. "The paper" is L. Zhao and others, J. Univ. Sci. Technol. Beijing 27 (2005) 423.
 *
 * SPDX-License-Identifier: MIT */
#ifndef FIBRAD_FURNACE_H
#define FIBRAD_FURNACE_H

#include "fibrad.h"

#ifdef __cplusplus
extern "C" {
#endif

#define FIBRAD_FURNACE_CELLS_MAX 100000000u

/* A furnace. The six walls are in the order x = 0, x = X, y = 0, y = Y, z = 0, z = Z. */
typedef struct fibrad_furnace_config {
    double size[3];             /* m, edges of the box, 1e-9 to 1e9 */
    uint32_t cells[3];          /* along each axis, at least 1; the product at most FIBRAD_FURNACE_CELLS_MAX */
    double absorption;          /* 1/m; its product with any edge of a cell is 1e-9 to 1e9 */
    double scattering;          /* 1/m; its product with any edge of a cell is 0 to 1e9 */
    double source;              /* W/m3, net emission of the medium, -1e30 to 1e30 */
    double wall_temperature[6]; /* K, 1e-3 to 1e9 */
    double wall_emissivity[6];  /* 0 to 1, not all 0 */
    uint64_t seed;              /* of the bundles of rays */
} fibrad_furnace_config;

/* The state of one box: temperatures, fluxes, coefficients and the plan of bundles. */
typedef struct fibrad_furnace fibrad_furnace;

/* Bytes that fibrad_furnace_init needs.
 *   Errors   0: config is NULL or not valid
 *   Cost     O(1) */
size_t fibrad_furnace_size(const fibrad_furnace_config *config);

/* Makes a furnace. Theta is 2/3. E of every cell is the median of E of the walls. In this median a wall has the weight
 * emissivity times area.
 *   Input    memory[size]
 *            config
 *   Output   furnace: a pointer into memory
 *   Errors   _ARGUMENT, _SIZE
 *   Cost     O(cells) */
int fibrad_furnace_init(fibrad_furnace **furnace, void *memory, size_t size, const fibrad_furnace_config *config);

/* The arrays of a furnace. x runs fastest, then y, then z. The arrays have three shapes:
 *   cell  one element for each cell
 *   face  of axis a: one element for each face across axis a. Along axis a there is one face more than cells.
 *   wall  one element for each face of the wall
 * The second index of flux, theta and transverse is the hemisphere: 0 is up the axis (+), 1 is down (-). The caller may
 * write e, flux and theta. */
typedef struct fibrad_furnace_arrays {
    double *e;                /* W/m2, cell: sigma T^4 */
    double *divergence;       /* W/m3, cell: net emission, equal to the source once solved */
    double *six_flux;         /* W/m2, cell: sum over axes and hemispheres of the mean flux of the cell's faces */
    double *flux[3][2];       /* W/m2, face: q+ and q-, as solved or measured last */
    double *theta[3][2];      /* face: Theta+ and Theta-, as set or measured last */
    double *transverse[3][2]; /* 1/m, cell: C+ and C-, divided by the mean flux of the cell's two faces */
    double *wall[6];          /* W/m2, wall: net flux from the wall */
    double *power;            /* W, [6]: net power that leaves each wall */
} fibrad_furnace_arrays;

/* Reads the addresses of the arrays. The addresses do not change. A null pointer is ignored.
 *   Errors   none */
void fibrad_furnace_fields(fibrad_furnace *furnace, fibrad_furnace_arrays *arrays);

/* Temperature [K] of E.
 *   Input    e: [W/m2]
 *   Output   0 unless e is above 0
 *   Errors   none
 *   Cost     two square roots */
double fibrad_furnace_temperature(double e);

/* Sets Theta to one constant and the transverse term to 0. 1 is the heat-flux method (HFM). 2/3 holds for isotropic
 * radiation.
 *   Input    theta: above 0, at most 1
 *   Errors   _ARGUMENT
 *   Cost     O(cells)
 *   Source   docs/validation.md */
int fibrad_furnace_theta(fibrad_furnace *furnace, double theta);

/* Let G be the incident radiation. The flux equations need scattering G/4. This rule says how G/4 is computed. */
typedef enum fibrad_furnace_scatter {
    FIBRAD_SCATTER_SIX_FLUX = 0, /* a sixth of the sum of the six fluxes, as in the paper */
    FIBRAD_SCATTER_EXACT = 1     /* E - source/(4 absorption), exact in equilibrium */
} fibrad_furnace_scatter;

/* How a solution ended. */
typedef struct fibrad_furnace_report {
    uint32_t sweeps; /* sweeps made */
    double change;   /* W/m2, largest change of E in the last sweep */
} fibrad_furnace_report;

/* Solves the heat-flux equations for E and the fluxes, with the present Theta and transverse term. A sweep solves every
 * line of cells exactly between its two walls. The sweeps end when no cell changes by more than the tolerance.
 *   Input    tolerance: [W/m2], above 0
 *            sweeps_max: sweeps after which to stop. Stopping is no error: the report has the change.
 *   Output   report
 *   Errors   _ARGUMENT: also if a change of E is not finite, because of values that the caller has written into the
 *            arrays. All arrays but theta are then undefined.
 *   Cost     60 ns per cell and sweep; tens of sweeps in a thin medium, more as the square of the optical thickness
 *   Source   the paper, equations 5 to 8 */
int fibrad_furnace_solve(fibrad_furnace *furnace, fibrad_furnace_scatter scatter, double tolerance, uint32_t sweeps_max,
                         fibrad_furnace_report *report);

/* What bundles of rays do. */
typedef enum fibrad_furnace_physics {
    FIBRAD_FURNACE_ATTENUATED = 0, /* The medium absorbs from bundles and emits bundles by E. Bundles give Theta. */
    FIBRAD_FURNACE_EQUILIBRIUM = 1 /* The medium emits again what it absorbs: direct Monte Carlo. Bundles give E. */
} fibrad_furnace_physics;

/* Plans the bundles to be traced next. Transport is linear and tallies are additive. Hence there are two kinds of
 * plans:
 *   first    about `bundles` bundles, for what walls and medium emit more or less than at E of the median wall
 *   further  bundles for the change of E since the last plan, with the same energy per bundle; none with
 *            FIBRAD_FURNACE_EQUILIBRIUM
 * Every source emits a whole number of bundles, at least one.
 *   Input    physics: another one than before makes a first plan
 *            bundles: 1 to 2^32, used by a first plan
 *            restart: not 0 makes a first plan
 *   Output   planned: number of bundles of the plan, may be 0
 *   Errors   _ARGUMENT: also if E is not finite, or if the change of E needs more than 2^33 bundles. In these two cases
 *            there is no plan, and the next plan is a first one.
 *   Cost     O(cells) */
int fibrad_furnace_emit(fibrad_furnace *furnace, fibrad_furnace_physics physics, uint64_t bundles, int restart,
                        uint64_t *planned);

/* Sums over bundles, in whole numbers. Every division of the work gives the same bits. */
typedef struct fibrad_furnace_tally fibrad_furnace_tally;

/* Bytes that fibrad_furnace_tally_init needs.
 *   Errors   0: furnace is NULL
 *   Cost     O(1) */
size_t fibrad_furnace_tally_size(const fibrad_furnace *furnace);

/* Makes an empty tally, for one thread at a time.
 *   Input    memory[size]
 *   Output   tally: a pointer into memory
 *   Errors   _ARGUMENT, _SIZE
 *   Cost     O(cells) */
int fibrad_furnace_tally_init(fibrad_furnace_tally **tally, void *memory, size_t size, const fibrad_furnace *furnace);

/* Traces bundles `first` to `first + count - 1` of the plan into a tally. Threads may share the furnace.
 *   Input    first, count: first + count at most the number of bundles planned
 *   Output   tally: as before after an error
 *   Errors   _ARGUMENT
 *            _STATE: there is no plan, or the tally holds bundles of another furnace or restart, or the tally was made
 *            for other cells
 *   Cost     about 1 microsecond per bundle in 20 x 20 x 40 cells: 0.6 by EQUILIBRIUM, 1.1 by ATTENUATED. The cost
 *            grows as the square of the optical thickness of a thick medium, and as 1/emissivity of the walls. */
int fibrad_furnace_trace(const fibrad_furnace *furnace, fibrad_furnace_tally *tally, uint64_t first, uint64_t count);

/* Adds the tally `from` to the tally `to`.
 *   Output   to: as before after an error
 *   Errors   _ARGUMENT: also if both are the same tally
 *            _STATE: the tallies are not of one furnace and one restart
 *   Cost     O(cells) */
int fibrad_furnace_tally_add(fibrad_furnace_tally *to, const fibrad_furnace_tally *from);

/* Which ratio is taken for Theta. F_n is the sum of w cos^n over the bundles that cross a face. w is their energy. */
typedef enum fibrad_furnace_estimator {
    FIBRAD_THETA_DEFINITION = 0, /* F1/F0, the ratio of equations 1 and 2; 2/3 for isotropic radiation */
    FIBRAD_THETA_PAPER = 1       /* F2/F1, equation 9 read for bundles of energy; 3/4 for isotropic radiation */
} fibrad_furnace_estimator;

/* Sets flux and Theta from the sum of all tallies since the last restart, of bundles with FIBRAD_FURNACE_ATTENUATED.
 * The results are averages over the symmetries of the box, mirror images and exchanges of axes. Where there are so few
 * bundles that a moment is not above 0, Theta does not change. The same tally may be evaluated again.
 *   Input    tally: the sum
 *            transverse: 0 sets the transverse term to 0, as in the paper. Otherwise the transverse term of equations
 *            5 and 6 is set from the balance of each cell. This needs FIBRAD_THETA_DEFINITION.
 *            scatter: used for the transverse term
 *   Errors   _ARGUMENT
 *            _STATE: the plans since the restart had other physics, or the tally does not hold each of their bundles
 *            once
 *   Cost     O(cells times symmetries)
 *   Source   the paper, equation 9; docs/validation.md */
int fibrad_furnace_estimate(fibrad_furnace *furnace, const fibrad_furnace_tally *tally,
                            fibrad_furnace_estimator estimator, int transverse, fibrad_furnace_scatter scatter);

/* Sets E, divergence, wall and power from the sum of all tallies since the last restart, of bundles with
 * FIBRAD_FURNACE_EQUILIBRIUM. E is an average over the symmetries of the box.
 *   Input    tally: the sum
 *   Errors   as fibrad_furnace_estimate
 *   Cost     O(cells times symmetries)
 *   Source   docs/validation.md */
int fibrad_furnace_equilibrium(fibrad_furnace *furnace, const fibrad_furnace_tally *tally);

#ifdef __cplusplus
}
#endif
#endif
