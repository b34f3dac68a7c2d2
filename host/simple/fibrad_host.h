/* fibrad_host.h - fibrad with a heap and OpenMP: whole beds in one call.
 *
 * Index
 *   run      fibrad_run: threads, progress, cancelling
 *   factors  fibrad_view_factors, fibrad_exchange_factors, fibrad_bed_free, fibrad_exchange_wall_row,
 *            fibrad_side_views, fibrad_displacements
 *   heat     fibrad_radiation_new, _move, _solve, _sides, _settle, _shine, _describe, _free
 *   time     fibrad_transient_new, _move, _powers, _sides, _shine, _advance, _describe, _free
 *   contacts fibrad_contacts_find, _conduct, _free
 *   kernel   fibrad_heap_resize, fibrad_host_sizeof
 *
 * Example   fibrad_bed_factors *bed;
 *           int status = fibrad_view_factors(NULL, &spheres, NULL, NULL, &bed);
 *           if (status == FIBRAD_OK) ... bed->matrix has the rows ...
 *           fibrad_bed_free(bed);
 * Link      with libfibrad_host.a and libfibrad.a, or with libfibrad.so, which has both
 * Words     Units, words, defaults and the layout of comments are as in fibrad.h.
 * Bits      Every result and every error is the same for any number of threads.
 * Threads   An object belongs to one thread at a time. Different objects are independent.
 * Functions of the caller (progress, laws, observe) may call this library, but not for the object whose call runs them.
 *           Such a call returns FIBRAD_E_STATE. The object must not be freed there.
 * Errors    A call returns the errors of the kernel functions that it uses, and FIBRAD_E_MEMORY and FIBRAD_E_CANCELLED.
 *           FIBRAD_E_FILE means that no file can be made in the folder `scratch`. After an error the out-pointer is
 *           NULL, and there is nothing to free. Other outputs are as before, except where a comment says otherwise.
 * Fork      OpenMP's threads do not survive fork(). If a process has used more than one thread in this library, its
 *           forked children must call no function of this header. They would hang.
 *
 * SPDX-License-Identifier: MIT */
#ifndef FIBRAD_HOST_H
#define FIBRAD_HOST_H

#include "fibrad_heat.h"
#include "fibrad_light.h"
#include "fibrad_mesh.h"
#include "fibrad_surface.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- run ------------------------------------------------------------------------------------------------------- */

/* A function of the caller that shows progress. The thread that made the call runs this function at the beginning and
 * the end of each stage, and up to 20 times a second in between.
 *   Input    context: fibrad_run.context
 *            stage: "walls", "rows", "triangles", "beams", "sweeps" or "steps"
 *            done: number of things done
 *            total: number of all things; 0: it cannot be said
 *   Output   0 to go on; else the call stops and returns FIBRAD_E_CANCELLED */
typedef int fibrad_progress(void *context, const char *stage, uint64_t done, uint64_t total);

/* How a call runs. NULL or zeroed: OpenMP's threads, no progress. */
typedef struct fibrad_run {
    int threads;               /* 1 to 1024; 0: OMP_NUM_THREADS, or else all processors, at most 1024 */
    fibrad_progress *progress; /* NULL: none */
    void *context;             /* handed to progress */
    fibrad_fault fault;        /* out: where an error is */
} fibrad_run;

/* ---- factors --------------------------------------------------------------------------------------------------- */

/* Which rows of a bed are computed, and how. NULL or zeroed: all rows, reciprocal and closed. At most one of beam,
 * surface and cast is set.
 *
 * Rows go along lines if all rows are wanted, raw is 0, and the rule is a beam rule or NULL. The number of lines is
 * then beam->directions, at most FIBRAD_LINES_EVEN_MAX. It is raised to the next set. 0 stands for
 * FIBRAD_LINES_DEFAULT, or among walls for FIBRAD_LINES_AMONG_WALLS. Scenes of few spheres have more: 40,000 over the
 * number of spheres. The field `points` then stands for masks: 64, 128 and 256 for 16, 32 and 64 chords. With more than
 * 1,536, and in all other cases, rows go along directions. So they do among triangles if there are more
 * than 171 spheres; masks serve there, too. docs/methods.md, section 12.
 *
 * A tolerance in the beam rule raises the number of lines or directions. If raw is 0, it is the same number for all
 * rows, so that the worst row meets the tolerance. If raw is 1, each row has the number of directions that it needs.
 *
 * Rows of walls are computed if walls is 1, all rows are wanted, and the rule has no cutoff. If raw is 0, the rows of
 * spheres and walls are closed together. This changes the factors between spheres by less than their errors.
 *
 * Raw rows are those before averaging. Files in the scratch folder take bytes for each entry of the raw rows. Rows
 * along lines have 16 for the row and 32 for the matrix. Other rows have 12 and 24. The files of the rows may be up to
 * twice as large. */
typedef struct fibrad_bed_options {
    const fibrad_beam_rule *beam;       /* NULL: the defaults, unless surface or cast is set */
    const fibrad_surface_rule *surface; /* NULL: not by the surface method */
    const fibrad_cast_rule *cast;       /* NULL: not by rays */
    const unsigned char *wanted;        /* [spheres], not 0: compute this row; implies raw; NULL: all rows */
    int raw;                            /* 1: leave the rows as the method gave them */
    double drop;                        /* 0 to 1, as in fibrad_matrix_rule */
    int walls;                          /* 1: rows of walls, too */
    const char *scratch;                /* folder for unnamed files instead of memory, same bits; NULL: memory */
} fibrad_bed_options;

/* A matrix of factors, and facts of its computation. */
typedef struct fibrad_bed_factors {
    fibrad_factors matrix;    /* a row that is not wanted is empty */
    fibrad_scene_facts facts; /* of the scene */
    const double *wall_area;  /* L^2, [walls], as fibrad_scene_wall_area */
    int threads;              /* threads used */
    uint32_t directions;      /* largest number of directions of a row, or lines; 0: the method has none */
    uint64_t fallbacks;       /* windows that took a slower, more robust method */
    uint64_t rays;            /* exchange: rays traced */
    double seconds;           /* s, without the time for closure_error and reciprocity_error */
    double closure_error;     /* largest |sum - 1| of a raw row */
    double reciprocity_error; /* as fibrad_matrix_reciprocity; NaN if rows are missing */
} fibrad_bed_factors;

/* View factors of a whole bed.
 *   Input    config: NULL: open on all sides, no walls
 *            options, run: NULL for all defaults
 *   Output   factors: free with fibrad_bed_free
 *   Errors   as fibrad_scene_init, fibrad_beam_row (_surface_row, _cast_row) and fibrad_matrix_init; _CANCELLED
 *   Cost     that of all rows over the threads; memory up to 64 bytes per entry of the raw rows
 *   Source   docs/methods.md */
int fibrad_view_factors(const fibrad_scene_config *config, const fibrad_spheres *spheres,
                        const fibrad_bed_options *options, fibrad_run *run, fibrad_bed_factors **factors);

/* Exchange factors of a whole bed. rule->tolerance is the error allowed in the final rows.
 *   Input    config: NULL: open on all sides, no walls
 *            rule: needed
 *            options, run: NULL for all defaults; options->beam, surface and cast must be NULL
 *   Output   factors: free with fibrad_bed_free
 *   Errors   as fibrad_scene_init, fibrad_exchange_row and fibrad_matrix_init; _CANCELLED
 *   Cost     as fibrad_view_factors
 *   Source   docs/methods_heat.md sections 2 to 4 */
int fibrad_exchange_factors(const fibrad_scene_config *config, const fibrad_spheres *spheres,
                            const fibrad_exchange_rule *rule, const fibrad_bed_options *options, fibrad_run *run,
                            fibrad_bed_factors **factors);

/* Frees factors. NULL is allowed.
 *   Errors   none */
void fibrad_bed_free(fibrad_bed_factors *factors);

/* The row of one wall or opening: fibrad_exchange_wall and fibrad_exchange_wall_mean. The number of paths is doubled
 * until the error is at most `tolerance`, up to 2^24 paths.
 *   Input    wall: as in fibrad_exchange_wall
 *            rule: needed
 *            tolerance: 0: any error is allowed
 *   Output   row
 *   Errors   as fibrad_scene_init and fibrad_exchange_wall; _CANCELLED
 *   Cost     that of the paths */
int fibrad_exchange_wall_row(const fibrad_scene_config *config, const fibrad_spheres *spheres, uint32_t wall,
                             const fibrad_wall_rule *rule, double tolerance, fibrad_run *run, fibrad_wall_row *row);

/* What all triangles of a bed see: fibrad_triangle_views of each.
 *   Input    rays: from each side, 1 to 2^30
 *   Output   view[2 triangles]: element 2 t is the front and 2 t + 1 the back of the caller's triangle t
 *   Errors   as fibrad_scene_init and fibrad_triangle_views; _CANCELLED. After an error some elements may be written.
 */
int fibrad_side_views(const fibrad_scene_config *config, const fibrad_spheres *spheres, uint32_t rays, fibrad_run *run,
                      fibrad_side_view *view);

/* How far the emission of spheres is carried: fibrad_exchange_displacement of each.
 *   Input    rule: needed
 *            wanted[spheres]: not 0: this sphere is wanted; NULL: all spheres
 *   Output   displacement[spheres]: elements that are not wanted stay as they are
 *            facts: of the scene; may be NULL
 *   Errors   as fibrad_scene_init and fibrad_exchange_displacement; _CANCELLED. After an error some elements may be
 *            written. */
int fibrad_displacements(const fibrad_scene_config *config, const fibrad_spheres *spheres,
                         const fibrad_displacement_rule *rule, const unsigned char *wanted, fibrad_run *run,
                         fibrad_displacement *displacement, fibrad_scene_facts *facts);

/* ---- heat ------------------------------------------------------------------------------------------------------ */

/* A heat problem (fibrad_heat.h) of a bed that may move. */
typedef struct fibrad_radiation fibrad_radiation;

/* Makes the heat problem of a bed and traces its beams.
 *   Input    config: NULL: open on all sides, no walls
 *            heat_config: NULL for all defaults; `parts` is always 16
 *            run: NULL for all defaults; threads, progress and context are kept for later calls
 *   Output   radiation: free with fibrad_radiation_free
 *   Errors   as fibrad_scene_init, fibrad_heat_init and fibrad_heat_trace; _CANCELLED
 *   Cost     that of the traces over the threads
 *   Source   docs/methods_heat.md sections 5 to 9 */
int fibrad_radiation_new(fibrad_radiation **radiation, const fibrad_scene_config *config, const fibrad_spheres *spheres,
                         const fibrad_heat_config *heat_config, fibrad_run *run);

/* Moves spheres and walls of a problem to other positions, and traces the beams again. The next solution begins with
 * the last one.
 *   Input    config, spheres: the same number of spheres, otherwise as for fibrad_heat_move
 *   Errors   as fibrad_radiation_new. A bed that is refused leaves the last bed in use. After an error in a trace,
 *            fibrad_radiation_solve returns FIBRAD_E_STATE until a move succeeds. */
int fibrad_radiation_move(fibrad_radiation *radiation, const fibrad_scene_config *config,
                          const fibrad_spheres *spheres);

/* Net powers and temperatures for these sources.
 *   Input    sources: begin with fibrad_heat_sources_init
 *   Output   result: the caller's arrays, as for fibrad_heat_read
 *   Errors   as fibrad_heat_check, _begin, _step and _read; _CANCELLED
 *   Cost     that of the sweeps over the threads */
int fibrad_radiation_solve(fibrad_radiation *radiation, const fibrad_heat_sources *sources, fibrad_heat_result *result);

/* The last solution on the sides of triangles: fibrad_heat_read_sides.
 *   Output   flux[2 triangles], temperature[2 triangles]: may be NULL
 *   Errors   _ARGUMENT
 *            _STATE: there is no solution of this bed */
int fibrad_radiation_sides(const fibrad_radiation *radiation, double *flux, double *temperature);

/* A function of the caller: emissivities that depend on temperatures. The thread that made the call runs this function.
 * A temperature is NaN if it has not been found yet, if the wall is insulated, or if the emissivity is 0. The function
 * leaves such an emissivity as it is.
 *   Input    temperature[spheres], wall_temperature[walls]: [K]
 *   Output   emissivity[spheres], wall_emissivity[walls]: 0 to 1 */
typedef void fibrad_emissivity_law(void *context, const double *temperature, const double *wall_temperature,
                                   double *emissivity, double *wall_emissivity);

/* Net powers and temperatures with emissivities that follow a law. The call solves again until the emissivities change
 * by at most 1e-5. The law may also change the elements of sources->conductivity and of sources->conductance. The call
 * then goes on until each of these changes by at most 1e-4 of its value.
 *   Input    sources: emissivity and wall_emissivity are not used
 *            context: handed to law
 *            emissivity[spheres], wall_emissivity[walls]: first values, used where temperatures are unknown
 *   Output   emissivity, wall_emissivity: those of the solution
 *            result: temperature, and wall_temperature with walls, must be set
 *   Errors   as fibrad_radiation_solve
 *            _UNSOLVABLE: also if 100 solutions do not suffice
 *            After an error `emissivity` and `wall_emissivity` are as before. Conductivities and conductances are as
 *            the law has left them. */
int fibrad_radiation_settle(fibrad_radiation *radiation, const fibrad_heat_sources *sources, fibrad_emissivity_law *law,
                            void *context, double *emissivity, double *wall_emissivity, fibrad_heat_result *result);

/* Light from outside, and what absorbs it. Set the lights and the absorptivities. */
typedef struct fibrad_light_sources {
    const fibrad_light *light;       /* [lights] */
    uint32_t lights;                 /* number of lights */
    const double *absorptivity;      /* [spheres], 0 to 1, of the light */
    const double *wall_absorptivity; /* [walls], 0 to 1; NULL without walls */
    double tolerance;                /* as in fibrad_heat_sources; 0: 1e-5 */
    int uniform;                     /* as in fibrad_heat_sources */
} fibrad_light_sources;

/* What is absorbed of light from outside. The arrays belong to the caller; those of errors may be NULL. */
typedef struct fibrad_light_result {
    double *absorbed;            /* sigma K^4 L^2, [spheres], out: directly and after reflections */
    double *absorbed_first;      /* sigma K^4 L^2, [spheres], out: of the light that the sphere meets first */
    double *absorbed_error;      /* sigma K^4 L^2, [spheres], out: estimated error of absorbed; may be NULL */
    double *wall_absorbed;       /* sigma K^4 L^2, [walls], out; NULL without walls */
    double *wall_absorbed_first; /* sigma K^4 L^2, [walls], out; NULL without walls */
    double *wall_absorbed_error; /* sigma K^4 L^2, [walls], out; may be NULL */
    double incident;             /* sigma K^4 L^2, out: what all lights bring */
    double transmitted;          /* sigma K^4 L^2, out: light that leaves without having met anything */
    double reflected;            /* sigma K^4 L^2, out: light that leaves after reflections, on any side */
    double error;                /* sigma K^4 L^2, out: estimated error of reflected */
    double error_patches;        /* sigma K^4 L^2, out: part of absorbed_error that more patches make smaller, r.m.s. */
    uint32_t sweeps;             /* out */
    uint32_t lights;             /* out: number of lights taken; after an error, index of the light at fault */
    const double *patches;       /* [patches], out: what fibrad_heat_sources.absorbed takes */
} fibrad_light_result;

/* What a bed absorbs of light from outside. All elements of `absorbed` and `wall_absorbed`, `reflected` and
 * `transmitted` add up to `incident`, to rounding. No surface absorbs less than of the light that it meets first. Where
 * the solution by patches says so, by its error, what surfaces absorb after reflections and what leaves are scaled. The
 * elements of `patches` are not scaled: for each surface they add up to what the solution says.
 *
 * Absorbed light heats a surface. If the temperature of the surface is given, add the absorbed light to the net power
 * in the result of fibrad_radiation_solve. If the temperature is to be found, add it to the power in the sources.
 * Insulated walls have no power in the sources. They give off the absorbed light if sources.absorbed is
 * result->patches. Spheres that conduct need this array as well, to be hotter where they are lit. The array lasts until
 * the next move or shine.
 *   Output   result
 *   Errors   as fibrad_light_empty and fibrad_radiation_solve
 *            _UNSOLVABLE: nothing absorbs the light, and it cannot leave
 *   Cost     that of a solution
 *   Source   docs/methods_heat.md, Light from outside */
int fibrad_radiation_shine(fibrad_radiation *radiation, const fibrad_light_sources *sources,
                           fibrad_light_result *result);

/* Facts of the scene in use, and where the last error was. Either output may be NULL. NULL for radiation is allowed.
 *   Errors   none */
void fibrad_radiation_describe(const fibrad_radiation *radiation, fibrad_scene_facts *facts, fibrad_fault *fault);

/* Frees the problem. NULL is allowed.
 *   Errors   none */
void fibrad_radiation_free(fibrad_radiation *radiation);

/* ---- time ------------------------------------------------------------------------------------------------------ */

/* A bed whose temperatures change with time: C dT/dt = power + net radiative power. C is the heat capacity of a sphere
 * [J/K]. A sphere has one temperature. */
typedef struct fibrad_transient fibrad_transient;

/* How net radiative powers are found.
 *
 *   CORRECTED  by exchange factors, which patches correct from time to time. Powers are as accurate as by patches. Take
 *              this method for many steps at the same positions. The temperatures of walls must be given.
 *   PATCHES    by patches in every stage of a step. Take this method for a step or two at the same positions, and for
 *              walls whose temperatures are found.
 *   FACTORS    by exchange factors alone. Powers are 2 to 5 % off. The method takes little memory. The temperatures of
 *              walls must be given, and walls gain from spheres only.
 *
 * Exchange factors are computed by the first step after a move. */
typedef enum fibrad_transient_method {
    FIBRAD_TRANSIENT_CORRECTED = 0,
    FIBRAD_TRANSIENT_PATCHES = 1,
    FIBRAD_TRANSIENT_FACTORS = 2
} fibrad_transient_method;

/* How a bed is followed in time. Zeroed: CORRECTED. */
typedef struct fibrad_transient_config {
    int method;                    /* a fibrad_transient_method */
    fibrad_exchange_rule exchange; /* for exchange factors; emissivities are those of the sources, not of this rule;
                                      conductivity, node_emissivity and known must be NULL */
    fibrad_heat_config heat;       /* for patches, as for fibrad_radiation_new; points 0: 128 if CORRECTED */
} fibrad_transient_config;

/* Makes a bed that changes with time. The bed is copied, its triangles included. If exchange.directions, paths and
 * tolerance are all 0, tolerance is 0.03, or 0.01 by FACTORS.
 *   Input    scene: NULL: open on all sides, no walls
 *            config: NULL for all defaults
 *            run: as for fibrad_radiation_new
 *   Output   transient: free with fibrad_transient_free
 *   Errors   as fibrad_scene_init; by CORRECTED and PATCHES also as fibrad_radiation_new
 *   Source   docs/methods_heat.md section 11 */
int fibrad_transient_new(fibrad_transient **transient, const fibrad_scene_config *scene, const fibrad_spheres *spheres,
                         const fibrad_transient_config *config, fibrad_run *run);

/* Moves the spheres and walls to other positions.
 *   Input    scene, spheres: as for fibrad_radiation_move
 *   Errors   as fibrad_transient_new. A bed that is refused leaves the last bed in use. After an error in a trace,
 *            later calls return FIBRAD_E_STATE until a move succeeds. */
int fibrad_transient_move(fibrad_transient *transient, const fibrad_scene_config *scene, const fibrad_spheres *spheres);

/* Net radiative powers at given temperatures of spheres. CORRECTED and PATCHES find them by patches, FACTORS by
 * exchange factors.
 *   Input    sources: temperature has no NaN; power is not used
 *   Output   result: as for fibrad_radiation_solve. FACTORS writes power, wall_power, surroundings_power, temperature
 *            and sweeps only.
 *   Errors   as fibrad_transient_advance */
int fibrad_transient_powers(fibrad_transient *transient, const fibrad_heat_sources *sources,
                            fibrad_heat_result *result);

/* The last result of fibrad_transient_powers on the sides of triangles.
 *   Output   as fibrad_radiation_sides
 *   Errors   as fibrad_radiation_sides
 *            _STATE: also by FACTORS */
int fibrad_transient_sides(const fibrad_transient *transient, double *flux, double *temperature);

/* What the bed absorbs of light from outside.
 *   Input    sources: as for fibrad_radiation_shine
 *   Output   result: as for fibrad_radiation_shine; by PATCHES hand result->patches on as sources.absorbed
 *   Errors   as fibrad_radiation_shine
 *            _STATE: also by FACTORS */
int fibrad_transient_shine(fibrad_transient *transient, const fibrad_light_sources *sources,
                           fibrad_light_result *result);

/* A function of the caller that is called after each step.
 *   Input    context: fibrad_span.context
 *            time: [s] since the beginning of the span
 *            temperature[spheres]: [K] at that time */
typedef void fibrad_observe(void *context, double time, const double *temperature);

/* A span of time. Times are in seconds if powers are in watts and capacities in J/K. Set temperature, capacity and
 * duration. The other fields may be zeroed. */
typedef struct fibrad_span {
    double *temperature;    /* K, [spheres], above 0 to FIBRAD_TEMPERATURE_MAX; in: at the beginning; out: at the end */
    const double *capacity; /* J/K, [spheres], above 0 to FIBRAD_CAPACITY_MAX */
    double duration;        /* s, above 0 to FIBRAD_DURATION_MAX */
    const double *wall_temperature; /* K, [walls], at the end, linear in between; NULL: constant */
    const double *surroundings;     /* K, one number, at the end, linear in between; NULL: constant */
    double step;                    /* s; all steps are equal and at most this long; 0: automatic steps */
    double tolerance;               /* of automatic steps, relative error of a temperature, below 1; 0: 1e-4 */
    double *power;                  /* W, [spheres], out: net radiative power at the end; may be NULL */
    double *wall_power;             /* W, [walls], out: net radiative power at the end; may be NULL */
    double surroundings_power;      /* W, out: net radiative power at the end */
    double *wall_energy;            /* J, [walls], out: gained by radiation during the span; may be NULL */
    double surroundings_energy;     /* J, out: gained by radiation during the span */
    fibrad_observe *observe;        /* NULL: none */
    fibrad_emissivity_law *law;     /* called in each stage, by PATCHES only; NULL: emissivities are constant */
    void *context;                  /* handed to observe and law */
    double error;                   /* out: largest estimated relative error of a temperature in one step */
    uint64_t steps;                 /* out: steps taken */
    uint64_t refused;               /* out: steps tried and refused */
    uint64_t sweeps;                /* out: sweeps over all beams (PATCHES) or all factors (CORRECTED, FACTORS) */
    uint64_t corrections;           /* out: solutions by patches that correct factors */
} fibrad_span;

/* Advances the temperatures of spheres by a span of time. The scheme is implicit (SDIRK), of second order and L-stable:
 * small spheres among large ones do not limit the step. The energy that spheres lose by radiation is what walls and
 * surroundings gain, to rounding. The first automatic step of a span is as long as the last span has proposed.
 *
 *   field of sources                 use
 *   temperature, storage, reference     not used
 *   power                            constant
 *   emissivity, wall_emissivity      constant, or where a law begins
 *   wall_temperature, surroundings   at the beginning of the span; NaN (to be found) only by PATCHES
 *   wall_power, insulated            constant; by PATCHES only
 *   side_temperature                 constant; not by FACTORS
 *   conductivity                     by FACTORS it must be NULL
 *   conductance                      constant, or changed by a law; contacts by PATCHES only, on means of surfaces
 *   sigma, sweeps_max                as for fibrad_radiation_solve
 *   tolerance                        residual of a stage by patches; 0: a tenth of the span's tolerance
 *
 *   Input    sources: begin with fibrad_heat_sources_init
 *   Output   span: temperature, and the fields marked "out"
 *   Errors   _ARGUMENT: fibrad_transient_describe has the sphere at fault
 *            _UNSOLVABLE: a sphere would fall below 0 K
 *            as fibrad_exchange_factors or fibrad_radiation_solve
 *   Cost     two or three solutions per step; with factors some milliseconds each for 1e4 spheres
 *   Source   R. Alexander, SIAM J. Numer. Anal. 14 (1977) 1006; docs/methods_heat.md section 11 */
int fibrad_transient_advance(fibrad_transient *transient, const fibrad_heat_sources *sources, fibrad_span *span);

/* Facts of the scene, and where the last error was, as fibrad_radiation_describe.
 *   Errors   none */
void fibrad_transient_describe(const fibrad_transient *transient, fibrad_scene_facts *facts, fibrad_fault *fault);

/* Frees the bed. NULL is allowed.
 *   Errors   none */
void fibrad_transient_free(fibrad_transient *transient);

/* ---- contacts --------------------------------------------------------------------------------------------------- */

/* How large the spot is at which two spheres that overlap, or a sphere and a wall, touch. a is its radius, R the radius
 * of a sphere, D the overlap and x the distance of the centre from the plane of the spot.
 *
 *   LENS    the circle in which the surfaces cut each other: a^2 = R^2 - x^2
 *   HERTZ   that of elastic spheres: a^2 = R_ij D with 1/R_ij = 1/R_i + 1/R_j; for a wall R_ij = R_i
 *
 * The lens of equal spheres is 1.41 times as large as Hertz's spot. */
typedef enum fibrad_spots { FIBRAD_SPOTS_NONE = 0, FIBRAD_SPOTS_LENS = 1, FIBRAD_SPOTS_HERTZ = 2 } fibrad_spots;

/* Which contacts are found, and what they conduct. Zeroed: none. */
typedef struct fibrad_contact_rule {
    int spots;        /* a fibrad_spots */
    double scale;     /* of the radii of spots, above 0; 0: 1 */
    double gas_reach; /* thickness of the gas that conducts about the smaller sphere, in its radii, 0 to 1; 0: no gas */
    double gas_jump;  /* L, is added to gaps, since narrow gaps conduct less; 0 or more */
    double gas_least; /* L, least gap that counts, above 0; 0: 1e-7 of the smaller radius */
    int gas_alone;    /* 1: lines lead through gas alone, not through solid; for spheres that conduct themselves */
} fibrad_contact_rule;

/* Contacts of a bed. A pair that touches across a period, too, has several. Ends are as in fibrad_heat_sources. */
typedef struct fibrad_contact_list {
    uint32_t n;                     /* number of contacts */
    const uint32_t *first, *second; /* [n], a sphere; a sphere, or `spheres` plus a wall */
    const double *distance;         /* L, [n], of the centres, or of centre and wall */
    const double *radius, *other;   /* L, [n], of both ends; infinity: a wall */
    const double *spot;             /* L, [n], radius of the spot, times rule->scale; 0: apart */
} fibrad_contact_list;

/* Finds spheres that touch each other or walls, or that are near enough for gas to conduct. Walls are planes, the
 * cylinder and the fronts and backs of triangles. A sphere touches a wall of triangles once for each place that is
 * nearest to it.
 *   Input    config: NULL: open on all sides, no walls
 *   Output   list: free with fibrad_contacts_free
 *   Errors   _ARGUMENT
 *   Cost     0.5 microseconds for each sphere within reach */
int fibrad_contacts_find(const fibrad_scene_config *config, const fibrad_spheres *spheres,
                         const fibrad_contact_rule *rule, fibrad_contact_list **list);

/* What contacts conduct. A spot of radius a conducts 2 k a between spheres with 2/k = 1/k_i + 1/k_j, and 4 k_i a to a
 * wall. Gas conducts along lines parallel to the line of centres, out to where the surface of one sphere leaves the gas
 * about the other one.
 *   Input    solid[spheres]: conductivities of spheres, above 0; infinity is allowed if rule->spots is 0
 *            gas[n]: conductivities of the gas at each contact; NULL: no gas conducts
 *            Both are in the unit of fibrad_heat_sources.conductivity.
 *   Output   conductance[n]: in the unit of fibrad_heat_sources.conductance
 *   Errors   _ARGUMENT
 *   Cost     1 microsecond for each contact with gas
 *   Source   docs/methods_heat.md, section 16 */
int fibrad_contacts_conduct(const fibrad_contact_list *list, const fibrad_contact_rule *rule, const double *solid,
                            const double *gas, double *conductance);

/* Frees a list. NULL is allowed.
 *   Errors   none */
void fibrad_contacts_free(fibrad_contact_list *list);

/* ---- kernel ---------------------------------------------------------------------------------------------------- */

/* A fibrad_resize on the heap, for fibrad_work work = {.memory.resize = fibrad_heap_resize}. Free the block with
 * free().
 *   Input    context: not used
 *   Output   the block; NULL if there is no memory */
void *fibrad_heap_resize(void *context, void *block, size_t size);

/* Bytes of a public structure, for bindings that lay out structures themselves. Libraries of the same soname have the
 * same sizes and fields.
 *   Input    name: "fibrad_row" for example
 *   Output   0 if there is no such structure */
size_t fibrad_host_sizeof(const char *name);

#ifdef __cplusplus
}
#endif
#endif
