/* fibrad_host.h - fibrad with a heap and OpenMP: whole beds in one call. libfibrad_host.a (with libfibrad.a), or
 * libfibrad.so, which has both.
 *
 * Index
 *   run       fibrad_run: threads, progress, cancelling
 *   factors   fibrad_view_factors, fibrad_exchange_factors, fibrad_displacements, fibrad_bed_free
 *   heat      fibrad_radiation_new, _move, _solve, _free
 *   binding   fibrad_host_sizeof
 *
 * Units, numbers, errors and zeroed structures are as in fibrad.h. Every result is the same for any number of threads.
 * Objects belong to one thread at a time; different objects are independent. Besides the codes of the kernel functions:
 * FIBRAD_E_MEMORY, FIBRAD_E_CANCELLED. On any error nothing is left to free and the out-pointer is NULL.
 *
 * SPDX-License-Identifier: MIT */
#ifndef FIBRAD_HOST_H
#define FIBRAD_HOST_H

#include "fibrad.h"
#include "fibrad_surface.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- run ------------------------------------------------------------------------------------------------------- */

/* Called now and then by the thread that made the call: `done` of `total` things of this stage ("rows", "beams", ...)
 * are done. Not 0: stop, which the call then returns as FIBRAD_E_CANCELLED. */
typedef int fibrad_progress(void *context, const char *stage, uint64_t done, uint64_t total);

/* How a call is run. NULL or zeroed: OpenMP's threads, no progress. */
typedef struct fibrad_run {
    int threads;               /* 0: as OpenMP has it: OMP_NUM_THREADS, else all processors */
    fibrad_progress *progress; /* NULL: none */
    void *context;             /* handed to progress */
    fibrad_fault fault;        /* out, of FIBRAD_E_ARGUMENT and _GEOMETRY: the spheres concerned; n: none of them */
} fibrad_run;

/* ---- factors --------------------------------------------------------------------------------------------------- */

/* What of a matrix is wanted, and how. NULL or zeroed: all rows by the default beam rule, reciprocal and closed. */
typedef struct fibrad_factors_options {
    const fibrad_beam_rule *beam;       /* at most one of these rules is set. With beam->tolerance all rows get the */
    const fibrad_surface_rule *surface; /* same number of directions, as many as the worst error needs */
    const fibrad_cast_rule *cast;
    const unsigned char *wanted; /* [spheres] 1: this row. Sets raw; rows not wanted are empty. NULL: all rows */
    int raw;                     /* 1: leave the rows as the method gave them */
    double drop;                 /* as in fibrad_matrix_rule */
} fibrad_factors_options;

/* A matrix, and what is worth knowing of it. */
typedef struct fibrad_bed_factors {
    fibrad_factors matrix;
    fibrad_scene_facts facts;
    const double *body_area;  /* [bodies] [L^2] as fibrad_scene_body_area */
    int threads;              /* used */
    uint32_t directions;      /* the most that a beam row took; 0: other methods */
    uint64_t fallbacks, rays; /* beams: windows left to the robust method; exchange: rays traced */
    double seconds;           /* of computing */
    double closure_error;     /* largest |sum - 1| of the raw rows */
    double reciprocity_error; /* as fibrad_matrix_reciprocity; NaN if rows are missing */
} fibrad_bed_factors;

/* View factors of a whole bed. config: NULL: open on all sides, no bodies. Free the result with fibrad_bed_free.
 * Errors: as fibrad_scene_init and the row functions. Cost: a row's times rows over threads; 24 to 40 bytes an entry.
 */
int fibrad_view_factors(const fibrad_scene_config *config, const fibrad_spheres *spheres,
                        const fibrad_factors_options *options, fibrad_run *run, fibrad_bed_factors **factors);

/* Exchange factors of a whole bed; rule->tolerance holds for the rows of the matrix as it is in the end. Of options,
 * wanted, raw and drop are used. Otherwise as fibrad_view_factors. */
int fibrad_exchange_factors(const fibrad_scene_config *config, const fibrad_spheres *spheres,
                            const fibrad_exchange_rule *rule, const fibrad_factors_options *options, fibrad_run *run,
                            fibrad_bed_factors **factors);

/* fibrad_exchange_displacement of all spheres, or of those wanted ([spheres] 1; NULL: all), into displacement
 * [spheres]; facts, unless NULL, of the scene. Errors: as fibrad_exchange_factors. */
int fibrad_displacements(const fibrad_scene_config *config, const fibrad_spheres *spheres,
                         const fibrad_exchange_rule *rule, const unsigned char *wanted, fibrad_run *run,
                         fibrad_displacement *displacement, fibrad_scene_facts *facts);

/* Frees a result. NULL: nothing. */
void fibrad_bed_free(fibrad_bed_factors *factors);

/* ---- heat ------------------------------------------------------------------------------------------------------ */

/* Radiation in a bed, step after step. */
typedef struct fibrad_radiation fibrad_radiation;

/* Makes the problem for a bed and follows its beams. Of heat_config (NULL: defaults) parts is fixed to 16. `run` (NULL:
 * defaults) is copied for all later calls. Errors: as fibrad_scene_init, fibrad_heat_init, _trace. Free with
 * fibrad_radiation_free. */
int fibrad_radiation_new(fibrad_radiation **radiation, const fibrad_scene_config *config, const fibrad_spheres *spheres,
                         const fibrad_heat_config *heat_config, fibrad_run *run);

/* Goes on to the same spheres and bodies at other places, and follows the beams anew; the next solution starts from the
 * last one. Errors: as fibrad_radiation_new; _ARGUMENT: another number of spheres or other bodies. After an error the
 * bed is that of the last good call or there is none, and _solve returns FIBRAD_E_STATE. */
int fibrad_radiation_move(fibrad_radiation *radiation, const fibrad_scene_config *config,
                          const fibrad_spheres *spheres);

/* Net powers for these sources into the caller's result (power [spheres], body_power [bodies]). Errors: as
 * fibrad_heat_begin, _read. */
int fibrad_radiation_solve(fibrad_radiation *radiation, const fibrad_heat_sources *sources, fibrad_heat_result *result);

/* Facts of the scene in use; the fault of the last call that failed. */
void fibrad_radiation_describe(const fibrad_radiation *radiation, fibrad_scene_facts *facts, fibrad_fault *fault);

/* Frees it. NULL: nothing. */
void fibrad_radiation_free(fibrad_radiation *radiation);

/* ---- binding --------------------------------------------------------------------------------------------------- */

/* Bytes of a public structure by its name ("fibrad_row", ...), for bindings that lay them out themselves; 0: no such
 * structure. A library of the same soname has the same sizes and fields. */
size_t fibrad_host_sizeof(const char *name);

#ifdef __cplusplus
}
#endif
#endif
