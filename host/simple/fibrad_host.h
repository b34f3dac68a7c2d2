/* fibrad_host.h - fibrad with a heap and OpenMP: whole beds in one call. libfibrad_host.a (with libfibrad.a), or
 * libfibrad.so, which has both.
 *
 * Index
 *   run       fibrad_run: threads, progress, cancelling
 *   factors   fibrad_view_factors, fibrad_exchange_factors, fibrad_bed_free, fibrad_side_views,
 *             fibrad_displacements
 *   heat      fibrad_radiation_new, _move, _solve, _sides, _settle, _describe, _free
 *   time      fibrad_transient_new, _move, _powers, _sides, _advance, _describe, _free
 *   kernel    fibrad_heap_resize, fibrad_host_sizeof
 *
 * Typical  fibrad_bed_factors *bed;
 *          int status = fibrad_view_factors(NULL, &spheres, NULL, NULL, &bed);
 *          ... bed->matrix has the rows; then fibrad_bed_free(bed);
 *
 * Units, numbers, errors and zeroed structures are as in fibrad.h. Every result is the same for any number of threads,
 * and so is every error. Objects belong to one thread at a time; different objects are independent. Besides the codes
 * of the kernel functions: FIBRAD_E_MEMORY, FIBRAD_E_CANCELLED. On any error nothing is left to free and the
 * out-pointer is NULL.
 *
 * Fork     OpenMP's threads do not survive fork(). A process that has called a function of this header with more than
 *          one thread must not call one in a forked child; the child would hang.
 *
 * SPDX-License-Identifier: MIT */
#ifndef FIBRAD_HOST_H
#define FIBRAD_HOST_H

#include "fibrad_heat.h"
#include "fibrad_mesh.h"
#include "fibrad_surface.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- run ------------------------------------------------------------------------------------------------------- */

/* Called by the thread that made the call, at the beginning and the end of each stage ("walls", "rows", "triangles",
 * "beams", "sweeps", "steps") and up to 20 times a second in between: `done` of `total` things are done; total 0:
 * unknown. Not 0: stop, which the call then returns as FIBRAD_E_CANCELLED. */
typedef int fibrad_progress(void *context, const char *stage, uint64_t done, uint64_t total);

/* How a call is run. NULL or zeroed: OpenMP's threads, no progress. */
typedef struct fibrad_run {
    int threads;               /* [0, 1024]; 0: as OpenMP has it: OMP_NUM_THREADS, else all processors; at most 1024 */
    fibrad_progress *progress; /* NULL: none */
    void *context;             /* handed to progress */
    fibrad_fault fault;        /* out, of an error: the spheres concerned, their number n: none of them; the triangle */
} fibrad_run;

/* ---- factors --------------------------------------------------------------------------------------------------- */

/* What of a matrix is wanted, and how. NULL or zeroed: all rows by the default beam rule, reciprocal and closed. */
typedef struct fibrad_bed_options {
    const fibrad_beam_rule *beam;       /* at most one of these three rules is set. Rows that are averaged all get */
    const fibrad_surface_rule *surface; /* one number of directions, as many as beam->tolerance takes for the worst */
    const fibrad_cast_rule *cast;       /* of them; raw rows get what each needs */
    const unsigned char *wanted;        /* [spheres] not 0: this row; sets raw. NULL: all rows */
    int raw;                            /* 1: leave the rows as the method gave them */
    double drop;                        /* as in fibrad_matrix_rule */
    int bodies; /* 1: rows of bodies, too, unless there is a cutoff or only some rows are wanted; what spheres exchange
                   then changes within its error, as all is closed together */
    const char *scratch; /* a folder: rows and matrix are kept in files there, without names, instead of in memory: the
                            same to the bit, at the disk's speed where they are more than memory; 24 to 36 bytes an
                            entry of the raw rows, and 24 of the matrix. NULL: in memory */
} fibrad_bed_options;

/* A matrix, and what else is known of it. */
typedef struct fibrad_bed_factors {
    fibrad_factors matrix; /* rows not wanted are empty */
    fibrad_scene_facts facts;
    const double *body_area;  /* [bodies] [L^2] as fibrad_scene_body_area */
    int threads;              /* used */
    uint32_t directions;      /* the most that a row took; 0: a method without */
    uint64_t fallbacks, rays; /* beams: windows left to the robust method; exchange: rays traced */
    double seconds;           /* of computing, checks left out */
    double closure_error;     /* largest |f + body + escaped + beyond - 1| of the raw rows */
    double reciprocity_error; /* as fibrad_matrix_reciprocity; NaN if rows are missing */
} fibrad_bed_factors;

/* View factors of a whole bed. config: NULL: open on all sides, no bodies. Free the result with fibrad_bed_free.
 * Errors: as fibrad_scene_init, the row functions and fibrad_matrix_init. Cost: a row's times rows over threads; up to
 * 48 bytes an entry. */
int fibrad_view_factors(const fibrad_scene_config *config, const fibrad_spheres *spheres,
                        const fibrad_bed_options *options, fibrad_run *run, fibrad_bed_factors **factors);

/* Exchange factors of a whole bed; rule->tolerance is meant for the rows as they are in the end. The rules in options
 * are to be NULL. Otherwise as fibrad_view_factors. */
int fibrad_exchange_factors(const fibrad_scene_config *config, const fibrad_spheres *spheres,
                            const fibrad_exchange_rule *rule, const fibrad_bed_options *options, fibrad_run *run,
                            fibrad_bed_factors **factors);

/* Frees factors. NULL: nothing. No errors. */
void fibrad_bed_free(fibrad_bed_factors *factors);

/* fibrad_triangle_views of all triangles of a bed, so many rays from each side; view [2 triangles]: fronts and backs in
 * turn. Errors: as fibrad_scene_init, fibrad_triangle_views. */
int fibrad_side_views(const fibrad_scene_config *config, const fibrad_spheres *spheres, uint32_t rays, fibrad_run *run,
                      fibrad_side_view *view);

/* fibrad_exchange_displacement of the spheres wanted ([spheres] not 0; NULL: all) into displacement [spheres], whose
 * other elements are left as they are; facts, unless NULL, of the scene. Errors: as fibrad_exchange_factors; then some
 * elements may have been written. */
int fibrad_displacements(const fibrad_scene_config *config, const fibrad_spheres *spheres,
                         const fibrad_exchange_rule *rule, const unsigned char *wanted, fibrad_run *run,
                         fibrad_displacement *displacement, fibrad_scene_facts *facts);

/* ---- heat ------------------------------------------------------------------------------------------------------ */

/* Radiation in a bed, step after step. */
typedef struct fibrad_radiation fibrad_radiation;

/* Makes the problem for a bed and traces its beams. heat_config: NULL: defaults; its parts are always 16. run: NULL:
 * defaults; threads, progress and context are kept for later calls. Free it with fibrad_radiation_free. Errors: as
 * fibrad_scene_init, fibrad_heat_init, fibrad_heat_trace. Cost: that of the traces, over threads. */
int fibrad_radiation_new(fibrad_radiation **radiation, const fibrad_scene_config *config, const fibrad_spheres *spheres,
                         const fibrad_heat_config *heat_config, fibrad_run *run);

/* Goes on to the same spheres and bodies at other places, and traces the beams anew; the next solution starts from the
 * last one. Errors: as fibrad_radiation_new; _ARGUMENT: another number of spheres or other kinds of bodies. After an
 * error _solve is for the last bed that was traced, or FIBRAD_E_STATE if this call has begun to trace. */
int fibrad_radiation_move(fibrad_radiation *radiation, const fibrad_scene_config *config,
                          const fibrad_spheres *spheres);

/* Net powers for these sources into the caller's result (power [spheres], body_power [bodies]). Errors: as
 * fibrad_heat_begin, fibrad_heat_read. Cost: its sweeps, over threads. */
int fibrad_radiation_solve(fibrad_radiation *radiation, const fibrad_heat_sources *sources, fibrad_heat_result *result);

/* What the last _solve says of the sides of triangles, as fibrad_heat_read_sides; [2 triangles] each, or NULL. Errors:
 * _ARGUMENT; _STATE: no solution of this bed. */
int fibrad_radiation_sides(const fibrad_radiation *radiation, double *flux, double *temperature);

/* Emissivities that follow temperatures: fills emissivity [spheres] and body_emissivity [bodies] for these temperatures
 * (NaN: not known yet, of insulated bodies, or of emissivity 0: leave them); called by the thread that made the call.
 */
typedef void fibrad_emissivity_law(void *context, const double *temperature, const double *body_temperature,
                                   double *emissivity, double *body_emissivity);

/* As fibrad_radiation_solve with emissivities of a law, in the arrays [spheres] and [bodies] of the caller: in, those
 * to begin with where temperatures are unknown; out, those of the solution. Solves again until no emissivity changes by
 * more than 1e-5. result->temperature and, with bodies, ->body_temperature are to be set; emissivities of the sources
 * are not used. Errors: as fibrad_radiation_solve; _UNSOLVABLE also if 100 solutions do not suffice. */
int fibrad_radiation_settle(fibrad_radiation *radiation, const fibrad_heat_sources *sources, fibrad_emissivity_law *law,
                            void *context, double *emissivity, double *body_emissivity, fibrad_heat_result *result);

/* Facts of the scene in use, and the spheres concerned by the last error, as in fibrad_run. Outputs may be NULL;
 * radiation NULL: nothing. No errors. */
void fibrad_radiation_describe(const fibrad_radiation *radiation, fibrad_scene_facts *facts, fibrad_fault *fault);

/* Frees it. NULL: nothing. No errors. */
void fibrad_radiation_free(fibrad_radiation *radiation);

/* ---- time ------------------------------------------------------------------------------------------------------ */

/* A bed whose temperatures change with time: C dT/dt = power + what radiation brings. Source: docs/heat.md. */
typedef struct fibrad_transient fibrad_transient;

typedef enum fibrad_transient_method {
    FIBRAD_TRANSIENT_CORRECTED = 0, /* exchange factors, made by the first step in a place, and what patches add */
    FIBRAD_TRANSIENT_PATCHES = 1,   /* patches for each stage: a step or two in a place, walls of unknown temperature */
    FIBRAD_TRANSIENT_FACTORS = 2    /* exchange factors alone: without beams, powers to some percent */
} fibrad_transient_method;

/* Zeroed: corrected factors, whose rows have errors of 0.03; alone 0.01. */
typedef struct fibrad_transient_config {
    int method;                    /* a fibrad_transient_method */
    fibrad_exchange_rule exchange; /* of factors; its emissivities are not used: those of the sources are */
    fibrad_heat_config heat;       /* of patches, as fibrad_radiation_new has it */
} fibrad_transient_config;

/* Makes it for a bed, which is copied, triangles included. config: NULL: defaults; run as in fibrad_radiation_new. Free
 * it with fibrad_transient_free. Errors: _ARGUMENT; as fibrad_scene_init; of patches as fibrad_radiation_new. */
int fibrad_transient_new(fibrad_transient **transient, const fibrad_scene_config *scene, const fibrad_spheres *spheres,
                         const fibrad_transient_config *config, fibrad_run *run);

/* Goes on to as many spheres and the same kinds of bodies at other places. Errors: as fibrad_transient_new; _ARGUMENT:
 * others. After an error the bed is that of before, or, if tracing its beams has failed, FIBRAD_E_STATE. */
int fibrad_transient_move(fibrad_transient *transient, const fibrad_scene_config *scene, const fibrad_spheres *spheres);

/* Powers at given temperatures of spheres, by patches if there are beams; result as of fibrad_radiation_solve. Errors:
 * as fibrad_transient_advance. */
int fibrad_transient_powers(fibrad_transient *transient, const fibrad_heat_sources *sources,
                            fibrad_heat_result *result);

/* What the last _powers says of the sides of triangles, as fibrad_radiation_sides. Errors: as that; _STATE also by
 * factors alone. */
int fibrad_transient_sides(const fibrad_transient *transient, double *flux, double *temperature);

/* Called after each step with the time since the beginning of the span and the temperatures [spheres] there. */
typedef void fibrad_observe(void *context, double time, const double *temperature);

/* A span of time, in seconds if powers are in watts and capacities in J/K. Zeroed but for the first three. */
typedef struct fibrad_span {
    double *temperature;            /* [spheres] > 0; in: at the beginning; out: at the end */
    const double *capacity;         /* [spheres] > 0, heat that warms a sphere by 1 K */
    double duration;                /* > 0 */
    const double *body_temperature; /* [bodies] at the end, linear in between; NULL: as at the beginning */
    const double *surroundings;     /* likewise, one number */
    double step;                    /* > 0: of this length at most, all alike; 0: automatic, first as proposed last */
    double tolerance;               /* of automatic steps, of a temperature, relative; 0: 1e-4 */
    double *power, *body_power;     /* [spheres], [bodies] out: net radiative powers at the end; may be NULL */
    double surroundings_power;      /* out: likewise */
    double *body_energy;            /* [bodies] out: what radiation has brought; may be NULL */
    double surroundings_energy;     /* out: likewise */
    fibrad_observe *observe;        /* NULL: none */
    fibrad_emissivity_law *law;     /* NULL: emissivities are constant; else by patches alone: asked in each stage */
    void *context;                  /* handed to observe and law */
    double error;                   /* out: the largest estimate of a step, as `tolerance` */
    uint64_t steps, refused;        /* out: taken; tried besides */
    uint64_t sweeps;                /* out: over all beams, or else over all factors */
    uint64_t corrections;           /* out: solutions by patches that correct factors */
} fibrad_span;

/* Advances temperatures by a span: an L-stable scheme of second order, for which small spheres among large ones are no
 * limit. What spheres lose is what bodies and surroundings get, to rounding. Of sources, power, emissivities (where a
 * law leaves them), body_power, insulated and, but by factors alone, side_temperature are used and constant;
 * temperature, hold and reference are not; body_temperature and surroundings are those at the beginning. Only by
 * patches may bodies be of unknown temperature; by factors alone they gain from spheres alone. Errors: _ARGUMENT, with
 * the sphere in fault; as fibrad_exchange_factors or fibrad_radiation_solve; _UNSOLVABLE: a sphere would fall below
 * zero. Then temperatures are as before. Cost: two or three solutions a step, some milliseconds for 1e4 spheres by
 * factors. */
int fibrad_transient_advance(fibrad_transient *transient, const fibrad_heat_sources *sources, fibrad_span *span);

/* As fibrad_radiation_describe, _free. */
void fibrad_transient_describe(const fibrad_transient *transient, fibrad_scene_facts *facts, fibrad_fault *fault);
void fibrad_transient_free(fibrad_transient *transient);

/* ---- kernel ---------------------------------------------------------------------------------------------------- */

/* A fibrad_resize on the heap, for `fibrad_work work = {.memory.resize = fibrad_heap_resize}`; the block is to be freed
 * with free(). context: not used. Errors: NULL. */
void *fibrad_heap_resize(void *context, void *block, size_t size);

/* Bytes of a public structure by its name ("fibrad_row", ...), for bindings that lay them out themselves. A library of
 * the same soname has the same sizes and fields. Errors: 0: no such structure. */
size_t fibrad_host_sizeof(const char *name);

#ifdef __cplusplus
}
#endif
#endif
