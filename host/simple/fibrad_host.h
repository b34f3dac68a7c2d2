/* fibrad_host.h - fibrad with a heap and OpenMP: a bed, and what is asked of it.
 *
 * Index      what for                                       functions and types
 *   run      threads, progress, cancelling                  fibrad_run
 *   bed      spheres and walls: made, moved, freed          fibrad_bed_new, _move, _free
 *            facts, where an error is, probable mistakes    fibrad_bed_describe, _warnings
 *            clumps; areas and volumes                      fibrad_bed_bodies, _surfaces
 *   factors  view factors and exchange factors of a bed     fibrad_bed_factors, fibrad_bed_matrix_free
 *            area and row of a wall; a bed's factors        fibrad_bed_wall_area, _wall_row, fibrad_view_factors
 *   heat     net powers and temperatures                    fibrad_bed_solve
 *            fluxes and temperatures of triangles           fibrad_bed_sides
 *            numbers of directions, points and patches      fibrad_bed_beams
 *            light from outside, first hits included        fibrad_bed_shine
 *            temperatures and energies in time              fibrad_bed_advance
 *   contacts which spheres touch, and what they conduct     fibrad_bed_contacts, fibrad_contacts_conduct
 *   kernel   memory of the heap, sizes of structures        fibrad_heap_resize, fibrad_host_sizeof
 *
 * Example   fibrad_bed *bed;
 *           fibrad_bed_matrix *factors = NULL;
 *           int status = fibrad_bed_new(&bed, NULL, &spheres, NULL);
 *           if (status == FIBRAD_OK) status = fibrad_bed_factors(bed, NULL, &factors);
 *           if (status == FIBRAD_OK) ... factors->matrix has the rows ...
 *           fibrad_bed_matrix_free(factors);
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

#ifdef __cplusplus
extern "C" {
#endif

/* ---- run ------------------------------------------------------------------------------------------------------- */

/* A function of the caller that shows progress. The thread that made the call runs this function at the beginning and
 * the end of each stage, and up to 20 times a second in between.
 *   Input    context: fibrad_run.context
 *            stage: "walls", "rows", "triangles", "beams", "sweeps", "light", "rays of light" or "steps"
 *            done: number of things done
 *            total: number of all things; 0: it cannot be said
 *   Output   0 to go on; else the call stops and returns FIBRAD_E_CANCELLED */
typedef int fibrad_progress(void *context, const char *stage, uint64_t done, uint64_t total);

/* How the calls of a bed run. NULL or zeroed: OpenMP's threads, no progress. */
typedef struct fibrad_run {
    int threads;               /* 1 to 1024; 0: OMP_NUM_THREADS, or else all processors, at most 1024 */
    fibrad_progress *progress; /* NULL: none */
    void *context;             /* handed to progress */
    fibrad_fault fault;        /* out: where an error of fibrad_bed_new or fibrad_view_factors is */
} fibrad_run;

/* ---- bed ------------------------------------------------------------------------------------------------------- */

/* A bed: spheres, walls, openings and periods. fibrad_bed_new makes its scene. Beams are traced when they are first
 * needed. The bed keeps scene and beams until fibrad_bed_move. */
typedef struct fibrad_bed fibrad_bed;

/* Makes a bed. All is copied but an occupancy (fibrad_scene_config), which must stay as it is.
 *   Input    config: NULL: open on all sides, no walls
 *            run: NULL for all defaults; threads, progress and context are kept for later calls
 *   Output   bed: free with fibrad_bed_free
 *            run->fault: where an error is
 *   Errors   as fibrad_scene_init
 *   Cost     that of fibrad_scene_init */
int fibrad_bed_new(fibrad_bed **bed, const fibrad_scene_config *config, const fibrad_spheres *spheres, fibrad_run *run);

/* Moves spheres and walls to other positions. Beams are traced again when they are next needed. The next solution
 * begins with the last one: it agrees with that of a new bed within the tolerance of the sources, not to the bit.
 * Factors, light and contacts have the bits of a new bed.
 *   Input    config, spheres: the same number of spheres, and otherwise as for fibrad_heat_move
 *   Errors   as fibrad_bed_new, and as fibrad_heat_move. A bed that is refused leaves the last bed in use. */
int fibrad_bed_move(fibrad_bed *bed, const fibrad_scene_config *config, const fibrad_spheres *spheres);

/* Facts of the bed, and where the last error was. Either output may be NULL. NULL for bed is allowed.
 *   Errors   none */
void fibrad_bed_describe(const fibrad_bed *bed, fibrad_scene_facts *facts, fibrad_fault *fault);

/* What in a bed, in its factors or in its sources is probably a mistake. Results are computed all the same. `first`,
 * `second`, `wall`, `count`, `value` and `other` are the fields of fibrad_warning that a code uses. */
typedef enum fibrad_warning_code {
    FIBRAD_WARNING_OVERLAP = 1,    /* Spheres `first` and `second` overlap by `value` smaller radii, above .05. Factors
                                      of the smaller one err by about `other`. */
    FIBRAD_WARNING_CUT = 2,        /* Sphere `first` reaches through `wall`, a plane or cylinder, by `value` radii.
                                      `count` spheres reach through one by more than .1. */
    FIBRAD_WARNING_MESH_SIZE = 3,  /* `wall` has the length `value` and the bed `other`: 200 times more or less. */
    FIBRAD_WARNING_MESH_PLACE = 4, /* `wall` lies from `value` to `other` along axis `first`, away from the bed. */
    FIBRAD_WARNING_COLD = 5,       /* The warmest sphere has `value`, below 150 K: degrees Celsius? */
    FIBRAD_WARNING_ZERO = 6,       /* Sphere `first`, one of `count`, has 0 K. Others have up to `value`. */
    FIBRAD_WARNING_AROUND = 7,     /* `wall`, or the surroundings, have `value`, 5 to 75 K: degrees Celsius? */
    FIBRAD_WARNING_SURFACE = 8,    /* The coldest place of sphere `first` comes out at `value`, below 0 K. */
    FIBRAD_WARNING_STORE = 9,      /* Sphere `first` stores `value` J/(m3 K), if L is the metre: no solid does. */
    FIBRAD_WARNING_OPEN_ROWS = 10, /* Sums of rows of walls differ from 1 by `value`. */
    FIBRAD_WARNING_APART = 11,     /* Sums of rows of walls differed from 1 by `value` before they were closed. */
    FIBRAD_WARNING_CHANGED_ROW = 12, /* Closing has changed the row of sphere `first` by `value` times its error. */
    FIBRAD_WARNING_PARTED = 13, /* Spheres `first` and `second` are members of a clump whose parts do not touch, one
                                   of `count` such clumps. It is one body all the same. */
    FIBRAD_WARNING_COVERED = 14 /* Sphere `first`, one of `count`, lies within other members, so it has no surface. */
} fibrad_warning_code;
#define FIBRAD_WARNINGS_MAX 14

typedef struct fibrad_warning {
    int code;               /* a fibrad_warning_code */
    uint32_t first, second; /* a sphere; another one */
    uint32_t wall;          /* 1 + the index of a wall; 0: the surroundings, or none */
    uint32_t count;         /* number of spheres; the warning is about the worst one */
    double value, other;
} fibrad_warning;

/* Warnings of the bed as it is, of its last factors and of its last sources, at most one of each code.
 *   Output   warning[FIBRAD_WARNINGS_MAX]
 *   Errors   none. Returns the number of warnings. NULL for bed is allowed. */
uint32_t fibrad_bed_warnings(const fibrad_bed *bed, fibrad_warning *warning);

/* The bodies of the bed: clumps, and spheres that are alone, in the order of their first spheres.
 *   Output   body[spheres]: number of the body of each sphere; may be NULL
 *   Errors   none. Returns the number of bodies; 0: bed is NULL. */
uint32_t fibrad_bed_bodies(const fibrad_bed *bed, uint32_t *body);

/* Exposed areas and volumes of spheres: fibrad_scene_exposed_area and fibrad_scene_volume.
 *   Output   area[spheres], volume[spheres]: L^2 and L^3; may be NULL
 *   Errors   _ARGUMENT */
int fibrad_bed_surfaces(const fibrad_bed *bed, double *area, double *volume);

/* Frees a bed. NULL is allowed.
 *   Errors   none */
void fibrad_bed_free(fibrad_bed *bed);

/* ---- factors --------------------------------------------------------------------------------------------------- */

/* Which rows of a bed are computed, and how. NULL or zeroed: view factors, all rows, reciprocal and closed. At most one
 * of beam, cast and exchange is set.
 *
 * Lines or directions. View factors by beams go along lines if all rows are wanted, `raw` and beam->turn are 0, and
 * beam->directions is at most 1,536. Otherwise rows go along directions. So they do among triangles if there are more
 * than 170 spheres. docs/methods.md section 12.
 *
 * Along lines, beam->directions is the number of lines, raised to the next set, at most FIBRAD_LINES_EVEN_MAX. 0 stands
 * for FIBRAD_LINES_DEFAULT, or among walls for FIBRAD_LINES_AMONG_WALLS, or for 40,000 over the number of spheres if
 * this is more. Masks serve up to 724 lines, exact areas beyond. beam->chords chooses otherwise. beam->points of 64,
 * 128 and 256 stand for masks of 16, 32 and 64 chords. Directions among triangles have the same numbers and masks.
 *
 * A tolerance in the beam rule raises the number of lines or directions. If raw is 0, it is the same number for all
 * rows, so that the worst row meets the tolerance. If raw is 1, each row has the number of directions that it needs.
 *
 * Rows of walls are computed if walls is 1, all rows are wanted, and the rule has no cutoff. If raw is 0, the rows of
 * spheres and walls are closed together. This changes the factors between spheres by less than their errors.
 *
 * A clump (fibrad_spheres.clump) is one body with one row and one column. So is a sphere that is alone. Bodies are in
 * the order of their first spheres. A_C F_CD is the sum of A_i F_ij over members, A_i being the whole area of a member
 * and A_C the exposed area of the clump. F_CC is what the row lacks of 1, not below 0. The row of a body is computed if
 * one of its spheres is wanted. Exchange factors of clumps are refused with FIBRAD_E_UNSUPPORTED.
 *
 * Raw rows are those before averaging. Files in the scratch folder take 48 bytes for each entry of raw rows along
 * lines: 16 for the rows and 32 for the matrix. Entries of other rows take 36: 12 and 24. Files of rows may be up to
 * twice as large. */
typedef struct fibrad_bed_rule {
    const fibrad_beam_rule *beam;         /* NULL: the defaults, unless cast or exchange is set */
    const fibrad_cast_rule *cast;         /* NULL: not by rays */
    const fibrad_exchange_rule *exchange; /* exchange factors; NULL: view factors */
    const unsigned char *wanted;          /* [spheres], not 0: compute this row; implies raw; NULL: all rows */
    int raw;                              /* 1: leave the rows as the method gave them */
    double drop;                          /* 0 to 1, as in fibrad_matrix_rule */
    int walls;                            /* 1: rows of walls, too */
    const char *scratch;                  /* folder for unnamed files instead of memory, same bits; NULL: memory */
} fibrad_bed_rule;

/* A matrix of factors, and facts of its computation. */
typedef struct fibrad_bed_matrix {
    fibrad_factors matrix;    /* a row that is not wanted is empty; rows and columns are bodies if there are clumps */
    fibrad_scene_facts facts; /* of the scene */
    const uint32_t *body;     /* [spheres], the row of each sphere; NULL: there are no clumps, row i is of sphere i */
    const double *area;       /* L^2, [matrix.n], exposed area of each row; NULL: there are no clumps, it is 4 pi r^2 */
    const double *wall_area;  /* L^2, [walls], as fibrad_scene_wall_area */
    int threads;              /* threads used */
    uint32_t directions;      /* largest number of directions of a row, or lines; 0: the method has none */
    uint64_t fallbacks;       /* windows that took a slower, more robust method */
    uint64_t rays;            /* exchange: rays traced */
    double seconds;           /* s, without the time for closure_error and reciprocity_error */
    double closure_error;     /* largest |sum - 1| of a raw row */
    double reciprocity_error; /* as fibrad_matrix_reciprocity; NaN if rows are missing */
} fibrad_bed_matrix;

/* Factors of a bed: exchange factors if rule->exchange is set, else view factors. A tolerance in the rule is the error
 * allowed in the final rows.
 *   Input    rule: NULL for all defaults
 *   Output   matrix: free with fibrad_bed_matrix_free; it does not need the bed
 *   Errors   as fibrad_beam_row (_cast_row, _exchange_row) and fibrad_matrix_init; _CANCELLED
 *   Cost     that of all rows over the threads; memory up to 64 bytes per entry of the raw rows
 *   Source   docs/methods.md; of exchange factors its sections 14 to 16 */
int fibrad_bed_factors(fibrad_bed *bed, const fibrad_bed_rule *rule, fibrad_bed_matrix **matrix);

/* Frees factors. NULL is allowed.
 *   Errors   none */
void fibrad_bed_matrix_free(fibrad_bed_matrix *matrix);

/* Factors of a bed in one call: fibrad_bed_new, _factors and _free.
 *   Input    as for these
 *   Output   matrix: free with fibrad_bed_matrix_free
 *   Errors   as these */
int fibrad_view_factors(const fibrad_scene_config *config, const fibrad_spheres *spheres, const fibrad_bed_rule *rule,
                        fibrad_run *run, fibrad_bed_matrix **matrix);

/* The area of a wall: fibrad_scene_wall_area.
 *   Errors   NaN: bed is NULL, or there is no such wall */
double fibrad_bed_wall_area(const fibrad_bed *bed, uint32_t wall);

/* The row of one wall or opening: fibrad_exchange_wall and fibrad_exchange_wall_mean. The number of paths grows until
 * the error is at most `tolerance`, up to 2^24 paths.
 *   Input    wall: as in fibrad_exchange_wall
 *            rule: needed
 *            tolerance: 0: any error is allowed
 *   Output   row
 *   Errors   as fibrad_exchange_wall; _CANCELLED
 *   Cost     that of the paths */
int fibrad_bed_wall_row(fibrad_bed *bed, uint32_t wall, const fibrad_wall_rule *rule, double tolerance,
                        fibrad_wall_row *row);

/* ---- heat ------------------------------------------------------------------------------------------------------ */

/* Sets how finely heat is resolved from now on (fibrad_heat.h), and traces the beams. The next solution begins with the
 * last one. Without this call, the first call that needs beams takes the defaults.
 *   Input    config: NULL for all defaults; `parts` is always 16
 *   Errors   as fibrad_heat_init and fibrad_heat_trace; _CANCELLED
 *   Cost     that of the traces over the threads; none if the beams are there
 *   Source   docs/methods.md sections 17 to 21 */
int fibrad_bed_beams(fibrad_bed *bed, const fibrad_heat_config *config);

/* A function of the caller: emissivities that depend on temperatures. The thread that made the call runs this function.
 * A temperature is NaN if it has not been found yet, or if the surface has none, as at emissivity 0. The function
 * leaves such an emissivity as it is.
 *   Input    temperature[spheres], wall_temperature[walls]: [K]
 *   Output   emissivity[spheres], wall_emissivity[walls]: 0 to 1 */
typedef void fibrad_emissivity_law(void *context, const double *temperature, const double *wall_temperature,
                                   double *emissivity, double *wall_emissivity);

/* A law that emissivities follow. It may also change the elements of sources->conductivity and of sources->conductance.
 */
typedef struct fibrad_law {
    fibrad_emissivity_law *follow;
    void *context;           /* handed to follow */
    double *emissivity;      /* [spheres], in: first values, used where temperatures are unknown; out: at the end */
    double *wall_emissivity; /* [walls], likewise */
} fibrad_law;

/* Net powers and temperatures for these sources. With a law the call solves again until emissivities change by at most
 * 1e-5, and conductivities and conductances by at most 1e-4 of their values.
 *   Input    sources: begin with fibrad_heat_sources_init; with a law, emissivity and wall_emissivity are not used
 *            law: NULL: emissivities are constant
 *   Output   result: the caller's arrays, as for fibrad_heat_read; with a law, temperature, and wall_temperature with
 *            walls, must be set
 *   Errors   as fibrad_bed_beams, fibrad_heat_check, _begin, _step and _read; _CANCELLED
 *            _UNSETTLED: also if 100 solutions do not satisfy the law
 *            After an error the emissivities of the law are as before. Conductivities and conductances are as the law
 *            has left them.
 *   Cost     that of the sweeps over the threads */
int fibrad_bed_solve(fibrad_bed *bed, const fibrad_heat_sources *sources, fibrad_law *law, fibrad_heat_result *result);

/* Fluxes and temperatures of the sides of triangles in the last solution, as fibrad_heat_read_sides gives them.
 *   Output   flux[2 triangles], temperature[2 triangles]: may be NULL
 *   Errors   _ARGUMENT
 *            _STATE: there is no solution of the bed as it is */
int fibrad_bed_sides(const fibrad_bed *bed, double *flux, double *temperature);

/* Light from outside, and what absorbs it. Set the lights and the absorptivities. */
typedef struct fibrad_light_sources {
    const fibrad_light *light;       /* [lights] */
    uint32_t lights;                 /* number of lights */
    const double *absorptivity;      /* [spheres], 0 to 1, of the light */
    const double *wall_absorptivity; /* [walls], 0 to 1; NULL without walls */
    double tolerance;                /* as in fibrad_heat_sources; 0: 1e-5 */
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
 * `transmitted` add up to `incident`, to rounding. By its error, a solution by patches may give a surface less than
 * absorbed_first. The surface then has absorbed_first, and what others absorb after reflections and what leaves are
 * scaled. The elements of `patches` are not scaled: for each surface they add up to what the solution says.
 *
 * Absorbed light heats a surface. If the temperature of the surface is given, add the absorbed light to the net power
 * in the result of fibrad_bed_solve. If the temperature is to be found, add it to the power in the sources.
 * Insulated walls have no power in the sources. They give off the absorbed light if sources.absorbed is
 * result->patches. Spheres that conduct need this array as well, to be hotter where they are lit. The array lasts until
 * the next move or shine.
 *   Output   result
 *   Errors   as fibrad_light_empty and fibrad_bed_solve
 *            _UNSOLVABLE: nothing absorbs the light, and it cannot leave
 *   Cost     that of a solution
 *   Source   docs/methods.md section 29 */
int fibrad_bed_shine(fibrad_bed *bed, const fibrad_light_sources *sources, fibrad_light_result *result);

/* A function of the caller that is called after each step.
 *   Input    context: fibrad_span.context
 *            time: [s] since the beginning of the span
 *            temperature[spheres]: [K] at that time */
typedef void fibrad_observe(void *context, double time, const double *temperature);

/* What a material stores: a heat capacity that follows the temperature, and a latent heat. Zeroed: the heat capacity is
 * 1 at all temperatures, and nothing melts. No temperature may leave the range of a table of several rows. */
typedef struct fibrad_store {
    const double *temperature; /* K, [rows], ascending; NULL if rows is 0 */
    const double *capacity;    /* J/(kg K), [rows], above 0 to FIBRAD_CAPACITY_MAX, linear in between */
    uint32_t rows;             /* 0: the capacity is 1; 1: it is constant */
    double melting;            /* K, above 0, middle of the range in which the material melts */
    double latent;             /* J/kg, above 0 to FIBRAD_CAPACITY_MAX, of the whole range; 0: nothing melts */
    double width;              /* K, of this range; the melted fraction grows evenly in it; 0: all melts at one T */
} fibrad_store;

/* A span of time. Times are in seconds if powers are in watts and capacities in J/K. Set temperature, capacity and
 * duration. The other fields may be zeroed.
 *
 * With `store` the field `capacity` has masses in kg. From one span to the next `melted` then keeps the fraction of
 * each sphere that has melted. A sphere of infinite capacity is held: its temperature stays. held_energy is what held
 * spheres gain, their powers included.
 *
 * The side_energy of all sides of a wall adds up to its wall_energy, without what contacts that have a
 * contact_temperature bring to it. What the wall gains through its other contacts and its film is spread over its sides
 * by area. If sources->absorbed is set, the sum has the light that the wall absorbs, and leaves out all contacts and
 * the film. If no wall has a film, convected_energy adds up to -gas_energy. Both sums are right to rounding.
 *
 * The temperature of a wall with a capacity is found. sources->wall_temperature has its temperature at the beginning.
 * The wall may have a power. It is neither endless nor insulated, and its sides have no temperatures of their own, no
 * films and no powers. */
typedef struct fibrad_span {
    double *temperature;    /* K, [spheres], above 0 to FIBRAD_TEMPERATURE_MAX; in: at the beginning; out: at the end */
    const double *capacity; /* J/K, or kg with `store`, [spheres], above 0 to FIBRAD_CAPACITY_MAX, or infinity */
    double duration;        /* s, above 0 to FIBRAD_DURATION_MAX */
    const fibrad_store *store; /* [stores]; NULL: heat capacities are constant */
    const uint32_t *store_of;  /* [spheres], indices of stores; NULL: all 0 */
    uint32_t stores;           /* number of stores */
    double *melted; /* [spheres], 0 to 1; in: at the beginning, NaN: by the temperature; out: at the end; may be NULL */
    const double *wall_capacity;    /* J/K, [walls], 0 to FIBRAD_CAPACITY_MAX; NULL: all 0, walls store nothing */
    double *wall_end;               /* K, [walls], out: temperatures at the end; may be NULL */
    const double *wall_temperature; /* K, [walls], at the end, linear in between; NULL: constant */
    const double *surroundings;     /* K, one number, at the end, linear in between; NULL: constant */
    const double *gas, *wall_gas; /* K, [spheres] and [walls], of films at the end, linear in between; NULL: constant */
    const double *side_temperature, *side_gas; /* K, [2 triangles], at the end, linear in between; NULL: constant */
    const double *contact_temperature;         /* K, [contacts], at the end, linear in between; NULL: constant */
    const double *inlet;          /* K, one number, inlet of a stream at the end, linear in between; NULL: constant */
    double step;                  /* s; all steps are equal and at most this long; 0: automatic steps */
    double tolerance;             /* of automatic steps, relative error of a temperature, below 1; 0: 1e-4 */
    double *power;                /* W, [spheres], out: net power at the end; may be NULL */
    double *wall_power;           /* W, [walls], out: net power at the end; may be NULL */
    double surroundings_power;    /* W, out: net power at the end */
    double *wall_energy;          /* J, [walls], out: gained during the span; may be NULL */
    double surroundings_energy;   /* J, out: gained during the span */
    double gas_power, gas_energy; /* W and J, out: the same of the gas of all films */
    double held_energy;           /* J, out: gained by held spheres during the span */
    double *convected_energy;     /* J, [spheres], out: gained from gas during the span; may be NULL */
    double *contact_energy;       /* J, [contacts], out: from the first end to the second; may be NULL */
    double *side_energy;          /* J, [2 triangles], out: gained during the span; may be NULL */
    double *side_end;             /* K, [2 triangles], out: temperatures at the end; may be NULL */
    double *stored;               /* J, [spheres], out: heat stored during the span; of held spheres 0; may be NULL */
    fibrad_law *law;              /* called in each stage; NULL: emissivities are constant */
    fibrad_observe *observe;      /* NULL: none */
    void *context;                /* handed to observe */
    double error;                 /* out: largest estimated relative error of a temperature in one step */
    uint64_t steps;               /* out: steps taken */
    uint64_t refused;             /* out: steps tried and refused */
    uint64_t sweeps;              /* out: sweeps over all beams or, where factors serve, over all factors */
    uint64_t corrections;         /* out: solutions by patches that correct factors */
} fibrad_span;

/* Advances the temperatures of spheres by a span of time: dH/dt = power + net power, H being the heat that a sphere
 * stores [J]. The scheme is implicit (SDIRK), of second order and L-stable: small spheres among large ones do not
 * limit the step. The energy that spheres lose is what walls, surroundings, gas and held spheres gain, to rounding. The
 * first automatic step of a span is as long as the last span has proposed.
 *
 * Powers are those of patches. From the third step at the same positions on, exchange factors stand for patches.
 * Solutions by patches correct the powers from time to time. Patches serve alone if there is a law, if spheres conduct,
 * or if there are contacts, films or clumps. They do, too, if the temperature of a wall or of a side is to be found, as
 * that of a wall with a capacity is. They also do if the span has side_temperature, or if convected_energy,
 * contact_energy, side_energy or side_end is wanted.
 *
 * The members of a clump begin at one temperature, equally melted. They have the same store. All or none are held.
 *
 *   field of sources                    use
 *   temperature, storage, reference, no_errors    not used
 *   power                               constant
 *   emissivity, wall_emissivity         constant, or where a law begins
 *   wall_temperature, surroundings, gas, wall_gas    at the beginning of the span; NaN: a wall's is to be found
 *   side_temperature, side_gas, contact_temperature    at the beginning of the span
 *   wall_power, insulated, side_film, side_power    constant
 *   conductivity, conductance, film, wall_film    constant, or changed by a law; contacts act on means of surfaces
 *   stream                              inlet: at the beginning of the span; gas: out, at the end
 *   sigma, sweeps_max                   as for fibrad_bed_solve
 *   tolerance                           residual of a stage by patches; 0: a tenth of the span's tolerance
 *
 *   Input    sources: begin with fibrad_heat_sources_init
 *   Output   span: temperature, and the fields marked "out"
 *   Errors   _ARGUMENT: fibrad_bed_describe has the sphere at fault. With FIBRAD_WHY_TEMPERATURE its temperature is out
 *            of range, or has left the table of its store.
 *            _UNSOLVABLE: a sphere would fall below 0 K
 *            as fibrad_bed_factors or fibrad_bed_solve
 *   Cost     two or three solutions per step; with factors some milliseconds each for 1e4 spheres
 *   Source   R. Alexander, SIAM J. Numer. Anal. 14 (1977) 1006; docs/methods.md section 23 */
int fibrad_bed_advance(fibrad_bed *bed, const fibrad_heat_sources *sources, fibrad_span *span);

/* ---- contacts --------------------------------------------------------------------------------------------------- */

/* Two spheres that overlap, or a sphere and a wall, touch at a spot. This says how large the spot is. Let a be its
 * radius, R the radius of a sphere, D the overlap and x the distance of the centre from the plane of the spot.
 *
 *   LENS    the circle in which the surfaces cut each other: a^2 = R^2 - x^2
 *   HERTZ   that of elastic spheres: a^2 = R_ij D with 1/R_ij = 1/R_i + 1/R_j; for a wall R_ij = R_i
 *
 * The radius of the lens of equal spheres is 1.41 times that of Hertz's spot. */
typedef enum fibrad_spots { FIBRAD_SPOTS_NONE = 0, FIBRAD_SPOTS_LENS = 1, FIBRAD_SPOTS_HERTZ = 2 } fibrad_spots;

/* Which contacts are found, and what they conduct. Zeroed: none. */
typedef struct fibrad_contact_rule {
    int spots;        /* a fibrad_spots */
    double scale;     /* of the radii of spots, above 0; 0: 1 */
    double gas_reach; /* thickness of the gas that conducts about the smaller sphere, in its radii, 0 to 1; 0: no gas */
    double gas_jump;  /* L, is added to gaps, since narrow gaps conduct less; 0 or more */
    double gas_least; /* L, least gap that counts, above 0; 0: 1e-7 of the smaller radius */
    double wall;      /* conductivity of walls at spots, in the unit of that of spheres; 0: infinite */
    int gas_alone;    /* 1: lines lead through gas alone, not through solid; for spheres that conduct themselves */
} fibrad_contact_rule;

/* Contacts of a bed. A pair that also touches across a period has several. Ends are as in fibrad_heat_sources. */
typedef struct fibrad_contact_list {
    uint32_t n;                     /* number of contacts */
    const uint32_t *first, *second; /* [n], a sphere; a sphere, or `spheres` plus a wall */
    const double *distance;         /* L, [n], of the centres, or of centre and wall */
    const double *radius, *other;   /* L, [n], of both ends; infinity: a wall */
    const double *spot;             /* L, [n], radius of the spot, times rule->scale; 0: apart */
} fibrad_contact_list;

/* Finds spheres that touch each other or walls, or that are near enough for gas to conduct. Walls are planes, the
 * cylinder and the fronts and backs of triangles. A sphere touches a wall of triangles at the place that is nearest to
 * its centre. In a corner it touches each face.
 *   Output   list: the bed's, until the next fibrad_bed_contacts, _move or _free
 *   Errors   _ARGUMENT
 *   Cost     0.5 microseconds for each sphere within reach */
int fibrad_bed_contacts(fibrad_bed *bed, const fibrad_contact_rule *rule, const fibrad_contact_list **list);

/* What contacts conduct.
 *
 * A spot of radius a conducts 2 k a, 2/k = 1/k_i + 1/k_j. k_i is the conductivity of the sphere, k_j that of the other
 * sphere or of the wall. To a wall of infinite conductivity the spot conducts 4 k_i a. Gas conducts along lines
 * parallel to the line of centres, out to where the surface of one sphere leaves the gas about the other one.
 *   Input    solid[spheres]: conductivities of spheres, above 0; infinity is allowed if rule->spots is 0
 *            gas[n]: conductivities of the gas at each contact; NULL: no gas conducts
 *            Both are in the unit of fibrad_heat_sources.conductivity.
 *   Output   conductance[n]: in the unit of fibrad_heat_sources.conductance
 *   Errors   _ARGUMENT
 *   Cost     1 microsecond for each contact with gas
 *   Source   docs/methods.md section 28 */
int fibrad_contacts_conduct(const fibrad_contact_list *list, const fibrad_contact_rule *rule, const double *solid,
                            const double *gas, double *conductance);

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
