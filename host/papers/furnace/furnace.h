/* furnace.h - boxes with a medium: methods, files, pictures, published cases. SPDX-License-Identifier: MIT */
#ifndef FURNACE_H
#define FURNACE_H

#include <stdio.h>

#include "cli/progress.h"
#include "fibrad_furnace.h"
#include "cli/output.h"

/* ---- the methods for a box with a participating medium, by OpenMP ------------------------------------------------ */

enum furnace_method {
    FURNACE_HFM,    /* heat fluxes, Theta = 1 */
    FURNACE_MCHF,   /* heat fluxes, Theta constant or measured by Monte Carlo */
    FURNACE_MCHF_X, /* as FURNACE_MCHF, and the transverse term is measured, too */
    FURNACE_MC      /* Monte Carlo in radiative equilibrium */
};

struct furnace_options {
    enum furnace_method method;
    double theta; /* FURNACE_MCHF: a constant above 0 to 1; 0: measured */
    fibrad_furnace_estimator estimator;
    fibrad_furnace_scatter scatter;
    bool measure;       /* FURNACE_MC: measure Theta afterwards */
    bool quiet;         /* print no outer iterations and no bar on standard error */
    uint64_t bundles;   /* approximate number in the first plan; later plans have as many as the changes of E need */
    int threads;        /* 0: all cores */
    double tolerance;   /* outer iterations end when no cell changes by more than this [K] */
    uint32_t outer_max; /* largest number of outer iterations */
};

struct furnace_run {
    fibrad_furnace_config config;
    fibrad_furnace *furnace;
    fibrad_furnace_arrays at;
    fibrad_furnace_tally **tallies; /* [threads + 1] one per thread, and their sum */
    void *block, **tally_blocks;
    int threads;
    uint32_t outers;  /* outer iterations: bundles, then a solution of the heat-flux equations */
    uint32_t sweeps;  /* of the last solution */
    double change;    /* largest change of T in the last outer iteration [K] */
    uint64_t bundles; /* bundles traced */
    double seconds;   /* time of computing [s] */
    bool cold;        /* some cell has no T > 0: more bundles are needed, or a weaker sink */
    struct progress progress;
};

/* Computes a box. Results do not depend on the number of threads. Free the run also after an error. Status 0,
 * STATUS_INPUT if there is no convergence, STATUS_MEMORY, or that of a signal. */
int furnace_run(const fibrad_furnace_config *config, const struct furnace_options *options, struct furnace_run *run);

void furnace_free(struct furnace_run *run);

/* ---- the published furnace, its reference values, and values along its axis -------------------------------------- */

/* Case 1 (absorbs 0.5/m) or 2 (absorbs 0.15/m, scatters 0.35/m) on 20 x 20 x 40 cells.
 * Source: Zhao, Li, Wu, Li, Cang, J. Univ. Sci. Technol. Beijing 27 (2005) 423. */
fibrad_furnace_config furnace_case(int number);

/* Reference temperatures on the axis [K] at furnace_reference_z [m]. They come from Monte Carlo in equilibrium with 3e8
 * bundles and cells of 0.1 m, interpolated as by furnace_axis_temperature. The standard error is at most 0.1 K.
 * docs/validation.md describes how they were made. */
enum { FURNACE_REFERENCES = 21 };
extern const double furnace_reference_z[FURNACE_REFERENCES];
double furnace_reference(int number, int k);

/* Net powers of the walls z = 0, z = Z and of all sides [kW], the same in both cases. */
extern const double furnace_reference_power[3];

/* 1/Theta+ and 1/Theta- of the z axis at z = 0.2 k, k = 0 ... 20, for case 1 and both estimators, from 1e8 bundles. */
extern const double furnace_reference_theta[2][2][FURNACE_REFERENCES];

/* Temperature on the axis x = X/2, y = Y/2, linear between the centres of cells. */
double furnace_axis_temperature(const struct furnace_run *run, double z);

/* Theta of the z axis in hemisphere g, on the axis of the box, linear between faces of cells. */
double furnace_axis_theta(const struct furnace_run *run, int g, double z);

/* Net powers of the wall z = 0, of the wall z = Z and of all sides, and their sum with the source, which should be 0
 * [kW]. */
void furnace_powers(const struct furnace_run *run, double kilowatts[4]);

/* ---- boxes from text files of keys and values -------------------------------------------------------------------- */

/* Reads a box. Lines may come in any order. # begins a comment.
 *     size 2 2 4            m
 *     cells 20 20 40
 *     absorption 0.5        1/m
 *     scattering 0          1/m, optional
 *     source 5000           W/m3, optional
 *     wall x0 900 0.70      K and emissivity; walls are x0 x1 y0 y1 z0 z1; `sides` means the first four
 * Status 0, STATUS_INPUT naming the line, STATUS_FILE, STATUS_MEMORY, or that of a signal. */
int read_furnace(const char *path, fibrad_furnace_config *config);

/* ---- writes the fields of a box ---------------------------------------------------------------------------------- */

/* Write `x,y,z,T,E,divq` of each cell, x fastest; image data for ParaView with T, E and divq. The caller checks the
 * file for errors. */
void write_furnace_csv(FILE *file, const struct furnace_run *run);
void write_furnace_vti(FILE *file, const struct furnace_run *run);

/* ---- a picture of the fields in the centre plane of a box, by gnuplot -------------------------------------------- */

/* Draws temperature and, if it was measured, 1/Theta in the plane y = Y/2, and the temperature on the axis. number: the
 * published case, whose reference is drawn, too; 0: none. name: a path, whose last part is the title. Status 0,
 * STATUS_FILE, or that of a signal. */
int furnace_plot(const struct output *output, const char *name, const struct furnace_run *run, bool measured,
                 int number);

#endif
