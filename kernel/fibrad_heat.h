/* fibrad_heat.h - net radiative powers and temperatures of grey diffuse spheres and walls.
 *
 * A surface is a sphere or a wall. Each surface has a given temperature, or it gives off a given power and its
 * temperature is found.
 *
 * Method     Surfaces are cut into patches. A beam connects two patches that see each other, and carries radiation both
 *            ways. Hence nothing flows at equal temperatures, and all powers add up to zero. Each patch has a
 *            radiosity J = eps E + (1 - eps) H. Here E = sigma T^4, and H is the radiation that arrives. Conjugate
 *            gradients find J, first on fours (four patches together), then on the patches themselves. Each step of
 *            this search is a sweep: one pass over all beams, in parts that threads may do at the same time. Powers
 *            and temperatures are extrapolated from both solutions to patches of size 0.
 * Sequence   1. fibrad_heat_init
 *            2. fibrad_heat_trace for every task
 *            3. fibrad_heat_begin
 *            4. fibrad_heat_sweep for every part, then fibrad_heat_step; repeat step 4 until solved is 1
 *            5. fibrad_heat_read
 *            For other sources, go on with step 3. If spheres have moved, call fibrad_heat_move and go on with step 2.
 * Units      as in fibrad.h. Powers are in sigma K^4 L^2. They are watts if L is the metre and sigma is in W/(m2 K4).
 * Words      Memory, errors and the layout of comments are as in fibrad.h.
 * Source     docs/methods.md sections 17 to 21, 25 and 28. docs/heat.md says what is assumed.
 *
 * SPDX-License-Identifier: MIT */
#ifndef FIBRAD_HEAT_H
#define FIBRAD_HEAT_H

#include "fibrad.h"

#ifdef __cplusplus
extern "C" {
#endif

/* How finely the problem is resolved. A field of 0 stands for its default. The default of wall_rays is the largest of
 * three numbers: FIBRAD_WALL_RAYS_DEFAULT, 6 * directions * points, and 8 times the number of patches of all walls.
 * Small meshes send more besides. */
typedef struct fibrad_heat_config {
    uint32_t directions; /* of each sphere, FIBRAD_DIRECTIONS_MIN to _MAX; 0: FIBRAD_HEAT_DIRECTIONS_DEFAULT */
    uint32_t points;     /* of each direction, where beams begin: 64, 128 or 256; 0: FIBRAD_HEAT_POINTS_DEFAULT */
    uint32_t patches;    /* of each sphere: 24, 96 or 384; 0: FIBRAD_HEAT_PATCHES_DEFAULT */
    uint32_t parts;      /* of a sweep, 1 to FIBRAD_HEAT_PARTS_MAX; changes results by rounding; 0: _DEFAULT */
    uint32_t wall_rays;  /* least number of rays from all walls together, at most FIBRAD_WALL_RAYS_MAX; 0: see above */
} fibrad_heat_config;

/* A heat problem: the patches, beams and radiosities of a scene. */
typedef struct fibrad_heat fibrad_heat;

/* Bytes that fibrad_heat_init needs: about spheres * (directions * points + 60 * patches + 6000). This is enough for
 * the beams of most beds. If it is not, fibrad_heat_trace returns _SIZE.
 *   Input    config: NULL for all defaults
 *   Errors   0 */
size_t fibrad_heat_size(const fibrad_heat_config *config, const fibrad_scene *scene);

/* Makes a heat problem. The scene must stay as it is while the problem is used, or until fibrad_heat_move.
 *   Input    memory[size]: at least fibrad_heat_size bytes. Further bytes are used for beams.
 *            config: NULL for all defaults
 *            scene: radii FIBRAD_HEAT_RADIUS_MIN to 1/FIBRAD_HEAT_RADIUS_MIN L
 *   Output   heat: a pointer into memory
 *   Errors   _ARGUMENT, _SIZE, _STATE
 *            _UNSUPPORTED: surfaces are so near each other that more than 2^26 small patches would be needed there */
int fibrad_heat_init(fibrad_heat **heat, void *memory, size_t size, const fibrad_heat_config *config,
                     const fibrad_scene *scene);

/* Goes on with another scene, or with the same scene rebuilt in place. All tasks must be traced again. The next
 * solution starts from the radiosities of the last one.
 *   Input    scene: as many spheres and triangles as before, the same walls in the same order, and the same openings.
 *            Each side of a triangle belongs to the same wall as before. The scene has clumps if the last one had.
 *            Positions and sizes may differ.
 *   Errors   _ARGUMENT, _STATE
 *            _SIZE: walls, or small spheres beside large ones, need more patches than the memory has room for; or
 *            more members of clumps overlap */
int fibrad_heat_move(fibrad_heat *heat, const fibrad_scene *scene);

/* Starts the first solution of a new problem from the last one of another problem of the same scene. A surface that has
 * another number of patches starts from the mean of its radiosities.
 *   Errors   _ARGUMENT
 *            _STATE: `last` has no solution, or is of another scene; the new problem starts anew */
int fibrad_heat_resume(fibrad_heat *heat, const fibrad_heat *last);

/* Number of tasks for fibrad_heat_trace: one for each sphere, and some for the walls and for fine patches.
 *   Errors   0 if heat is NULL */
uint32_t fibrad_heat_tasks(const fibrad_heat *heat);

/* Number of parts for fibrad_heat_sweep: fibrad_heat_config.parts.
 *   Errors   0 if heat is NULL */
uint32_t fibrad_heat_parts(const fibrad_heat *heat);

/* Traces the beams of one task. Each task is traced once. Several threads may trace different tasks at the same time.
 *   Input    work: of the calling thread
 *            task: 0 to fibrad_heat_tasks - 1
 *   Errors   _ARGUMENT
 *            _WORK, _MEMORY: call again for the same task with more memory
 *            _STATE: the task is traced already, or the scene has changed
 *            _BACK: a beam or ray meets a side that belongs to no wall; work->triangle is the number of its triangle
 *            _SIZE: the beams do not fit into the memory; call fibrad_heat_init again with twice the size
 *   Cost     1 microsecond per direction of 64 points */
int fibrad_heat_trace(fibrad_heat *heat, fibrad_work *work, uint32_t task);

/* Gas that flows past the spheres. It goes through slices in turn, and each slice has one temperature:
 *
 *     content that leaves - content that enters = sum over the slice of film (T - T_gas).
 *
 * The content is the integral of `capacity` over T. `capacity` is linear between its points and constant beyond them.
 */
typedef struct fibrad_stream {
    const uint32_t *slice;  /* [spheres], below `slices`; 0: the slice that the gas enters first */
    const double *at;       /* K, [points], ascending */
    const double *capacity; /* sigma K^3 L^2, [points], above 0: mass flow times specific heat, at these temperatures */
    uint32_t slices, points;
    double inlet; /* K, of the gas that enters */
    double *gas;  /* K, [FIBRAD_STREAM_ROWS slices]; first row: in: first guesses, 0 or less: the inlet's temperature;
                   * out: temperatures of the slices; the other rows are memory */
} fibrad_stream;
#define FIBRAD_STREAM_ROWS 4

/* What radiates. Begin with fibrad_heat_sources_init, and set `surroundings`.
 *
 *   a sphere with             temperature  power     storage, reference
 *   a given temperature       T            0 or NaN  not used
 *   a given power P           NaN          P         0, R: a first guess of T, or NaN
 *   a power that varies       NaN          P         h, R: the sphere gives off P - h sigma (T^4 - R^4)
 *   emissivity 0, no contact and no film
 *                             T            0 or NaN  not used
 *                             NaN          0         0, NaN
 *
 * `storage` makes the solution an implicit step in time. A sphere of heat capacity C that has the temperature R at the
 * beginning of a step of length dt has h = C/(4 sigma R^3 dt).
 *
 * Walls have the same choices with wall_temperature and wall_power, but no storage and no reference. An insulated wall
 * sends back all that arrives, point by point. Its temperature, emissivity and power are not used. The sides of a mesh
 * may have temperatures of their own if the wall has a given temperature. An endless wall (fibrad.h) must have a given
 * temperature, unless it reflects everything.
 *
 * The temperature of a sphere with a finite conductivity differs from point to point. `temperature` is then the mean
 * over its surface. Inside, the temperature is taken to be steady, and the power P - h sigma (T^4 - R^4) to be
 * released evenly. Emission is taken to be linear in the difference from the mean (docs/methods.md section 25).
 * `conductivity` is k_s of the solid, not k* of fibrad_relative_conductivity. It is in units of sigma K^3 L. If lengths
 * are in millimetres and sigma is in W/(m2 K4), a solid of 30 W/(m K) has the conductivity 30/0.001.
 *
 * Light has two inputs. Its power (fibrad_heat_sum_light) is added to the given powers. `absorbed` has the light of
 * each patch:
 *   a sphere with a finite conductivity  is hotter at the lit patches
 *   an insulated wall                    sends the light out as thermal radiation, at the same patch; it has no power
 *   a side with a film or a power        gives the light off as well
 *   any other sphere or wall             does not use `absorbed`
 *
 * Contact k conducts heat between contact_first[k] and contact_second[k]: each is an index of a sphere, or `spheres`
 * plus the index of a wall. The heat is conductance[k] times the difference of their temperatures. Several contacts
 * may have the same ends. A contact of a sphere with itself, across a period, carries nothing. A sphere of emissivity
 * 0 that is in contact has a temperature, and may give off a power. `conductance` is in units of sigma K^3 L^2. If
 * lengths are in millimetres and sigma is in W/(m2 K4), 1 W/K is 1e6.
 *
 * contact_temperature is for walls whose temperature differs from place to place: it is the temperature of the wall at
 * the contact. Such a wall is the second end of the contact. It has a given temperature and is not insulated. If its
 * sides have temperatures, films or powers, each of its contacts needs a contact_temperature, and wall_film must be 0.
 *
 * A film exchanges heat with gas: film times the difference of the temperatures of gas and surface. It is the heat
 * transfer coefficient times the area, in the unit of `conductance`. A film acts as a contact does: also on spheres of
 * emissivity 0. On a sphere with a finite conductivity it acts point by point. The temperature of the gas is given by
 * `gas` and `wall_gas`. With a stream, each film of a sphere ends in the gas of the sphere's slice. The temperatures of
 * this gas are found, and `gas` is not used.
 *
 * A clump (fibrad_spheres.clump) has one temperature. Its members have the same given temperature, or none has one.
 * Powers, storages, films and contacts of members add up. Contacts between members carry nothing. Each member has its
 * own emissivity. No member may have a finite conductivity.
 *
 * With `contact_places` the contacts of a sphere with a finite conductivity act where the line to the other centre, or
 * the normal of the plane or cylinder, leaves the sphere. Contacts with meshes act on the mean of the sphere's
 * surface.
 *
 * The residual is the error of the equations for J, relative to what drives the radiation: differences of emission,
 * given powers and light. tolerance = 0 stands for one of three numbers:
 *   1e-12  up to 16 spheres, no contacts and no films
 *   1e-5   else, if a temperature is unknown and its storage is 0
 *   1e-3   else
 * The search also goes on until the power of each wall is settled to the tolerance. The tolerance is here relative to
 * the power, or to 5 % of what the wall absorbs, whichever is more. If a temperature is unknown, the tolerance of
 * these powers is 100 times as large, at most 1e-3.
 *
 * The arrays side_temperature, side_film, side_gas and side_power are in the order of the caller's triangles. If sides
 * share a patch, each side emits the mean of their emissions. If a side has a film or a power, its temperature T is
 * found. H is the radiation that arrives per area:
 *
 *     eps (H - sigma T^4) + side_film (side_gas - T) + side_power = 0.
 *
 * side_film is a heat transfer coefficient, and side_power is a power per area of the side. A side of power 0 sends out
 * all that it takes in. A side with a film or a power must have no side_temperature. Its wall must have an emissivity
 * above 0, and a given temperature, with which the search begins. The net powers of the side and of its wall are what
 * they gain by radiation. If the side absorbs light (`absorbed`), it gives off this light, too. If only a temperature
 * below 0 would balance a side, there is no solution. */
typedef struct fibrad_heat_sources {
    const double *temperature; /* K, [spheres], 0 to FIBRAD_TEMPERATURE_MAX; NaN: unknown */
    const double *emissivity;  /* [spheres], 0 to 1 */
    const double *power;       /* sigma K^4 L^2, [spheres], to FIBRAD_POWER_MAX; above 0: given off; NULL: all NaN */
    const double *storage;     /* L^2, [spheres], 0 to 1e60; NULL: all 0 */
    const double *reference;   /* K, [spheres], as temperature; NULL: all NaN */
    const double *wall_temperature; /* K, [walls], as temperature; NULL without walls */
    const double *wall_emissivity;  /* [walls], 0 to 1; NULL without walls */
    const double *wall_power;       /* sigma K^4 L^2, [walls], as power; NULL: all NaN */
    const unsigned char *insulated; /* [walls], not 0: insulated; NULL: no wall is insulated */
    double surroundings;            /* K, 0 to FIBRAD_TEMPERATURE_MAX, of the black surroundings */
    double sigma;                   /* of E = sigma T^4, FIBRAD_SIGMA_MIN to _MAX */
    double tolerance;               /* residual at which to stop, 0 to below 1; 0: see above */
    uint32_t sweeps_max;            /* sweeps after which to give up, FIBRAD_E_UNSETTLED; 0: 1000 */
    uint32_t no_errors;             /* not 0: no estimated error is written, and a sweep is saved */
    const double *side_temperature; /* K, [2 triangles], fronts and backs in turn; NaN: the wall's; NULL: all NaN */
    const double *side_film;        /* sigma K^3, [2 triangles], 0 to FIBRAD_CONDUCTANCE_MAX; NULL: all 0 */
    const double *side_gas;         /* K, [2 triangles], temperature behind the film; NULL without `side_film` */
    const double *side_power;       /* sigma K^4, [2 triangles], above 0: given off; NaN: not given; NULL: all NaN */
    const double *light; /* sigma K^4 L^2, [fibrad_heat_patches], arrives from outside; NULL: none; fibrad_light.h */
    const double *conductivity; /* sigma K^3 L, [spheres], above 0; infinity: one temperature; NULL: all infinity */
    const double *absorbed;     /* sigma K^4 L^2, [fibrad_heat_patches], light that heats; NULL: none; fibrad_light.h */
    const uint32_t *contact_first;      /* [contacts], a sphere, or spheres + a wall; NULL: no contacts */
    const uint32_t *contact_second;     /* [contacts], the other end */
    const double *conductance;          /* sigma K^3 L^2, [contacts], 0 to FIBRAD_CONDUCTANCE_MAX */
    uint32_t contacts;                  /* number of contacts */
    const double *contact_temperature;  /* K, [contacts], of the second end, a wall; NaN: the wall's; NULL: all NaN */
    const double *film;                 /* sigma K^3 L^2, [spheres], 0 to FIBRAD_CONDUCTANCE_MAX; NULL: all 0 */
    const double *gas;                  /* K, [spheres], temperature of the gas at a film; NULL without `film` */
    const double *wall_film, *wall_gas; /* the same, [walls] */
    const fibrad_stream *stream;        /* gas that flows past the spheres; NULL: none */
    double *contact_places; /* [5 contacts + fibrad_heat_patches], memory: contacts act at their places; or NULL */
} fibrad_heat_sources;

/* Zeroes the sources, sets sigma = FIBRAD_STEFAN_BOLTZMANN, and sets surroundings = NaN. NaN is refused, so that no
 * caller forgets the surroundings.
 *   Errors   none; NULL is allowed */
void fibrad_heat_sources_init(fibrad_heat_sources *sources);

/* Checks sources as fibrad_heat_begin does.
 *   Output   fault: which sphere or wall is at fault, and why; may be NULL
 *   Errors   _ARGUMENT
 *            _UNSUPPORTED: the temperature of an endless wall is unknown, fault.why is FIBRAD_WHY_ENDLESS
 *            _UNSOLVABLE: nothing gives a sphere of emissivity 0 a temperature; fault.why is FIBRAD_WHY_ALONE. Its
 *            contacts, and those of what it touches, lead to no surface that radiates or has a given temperature. */
int fibrad_heat_check(const fibrad_heat *heat, const fibrad_heat_sources *sources, fibrad_fault *fault);

/* Begins a solution. It starts from the radiosities of the last solution. It starts anew if there was none, or if only
 * one of the two solutions has `light`. The arrays `light`, `absorbed`, those of contacts and those of sides must stay
 * until the solution is read. The others are no longer needed after the call.
 *   Errors   as fibrad_heat_check
 *            _STATE: a task is not traced, or the scene has changed
 *   Cost     O(patches) */
int fibrad_heat_begin(fibrad_heat *heat, const fibrad_heat_sources *sources);

/* Does one part of a sweep. Between two steps each part is swept once. Several threads may sweep different parts at
 * the same time.
 *   Input    part: 0 to fibrad_heat_parts - 1
 *   Errors   _ARGUMENT
 *            _STATE: the part was swept already, or no solution was begun
 *   Cost     2 ns per beam. If temperatures are found in a deep bed, a solution takes some sweeps for each layer of
 *            spheres. */
int fibrad_heat_sweep(fibrad_heat *heat, uint32_t part);

/* Ends a sweep.
 *   Output   solved: 1 if the residual is below the tolerance; else 0
 *   Errors   _ARGUMENT
 *            _STATE: a part was not swept, no solution was begun, or the scene has changed
 *            _UNSOLVABLE: all temperatures are unknown, nothing escapes, there is no film, and there are contacts,
 *            clumps or powers of sides, or the powers do not add up to zero
 *            _UNSETTLED: the search has not ended after sweeps_max sweeps; there is no solution
 *   Level    If all temperatures are unknown, nothing escapes and there is no film, any level would do. The mean
 *            emission, weighted by emissivity and area, is then that of the surroundings. */
int fibrad_heat_step(fibrad_heat *heat, int *solved);

/* The solution. The arrays belong to the caller. Where a field may be NULL, NULL means that it is not wanted.
 *
 * A net power is above 0 where a surface gains heat, by radiation, through contacts and through its film. A given power
 * has the other sign: a sphere of power P (and storage 0) has the net power -P. For a clump this holds for the sum over
 * its members. The net power of each member has its own estimated error. Temperatures are written whether they were
 * found or given. A temperature is NaN in two cases: the emissivity is 0 and there is no contact and no film; or only a
 * temperature below zero would give the power.
 *
 * least_temperature, largest_temperature and centre_temperature differ only on spheres with a finite conductivity. For
 * any other sphere all three are its temperature. wall_temperature of an insulated wall is the fourth root of its mean
 * T^4. The same holds for a mesh whose sides have temperatures of their own. The root mean square error of the powers
 * of all spheres is the root of error_patches^2 + error_beams^2. With sources.no_errors the arrays and numbers whose
 * names contain "error" are not written. */
typedef struct fibrad_heat_result {
    double *power;                  /* sigma K^4 L^2, [spheres], out: net power */
    double *wall_power;             /* sigma K^4 L^2, [walls], out: net power; NULL without walls */
    double surroundings_power;      /* sigma K^4 L^2, out: net power */
    double *temperature;            /* K, [spheres], out; may be NULL */
    double *wall_temperature;       /* K, [walls], out; may be NULL */
    double *power_error;            /* sigma K^4 L^2, [spheres], out: estimated error of power; may be NULL */
    double *wall_error;             /* sigma K^4 L^2, [walls], out: estimated error of wall_power; may be NULL */
    double *temperature_error;      /* K, [spheres], out: estimated error, 0 if given; may be NULL */
    double *wall_temperature_error; /* K, [walls], out: estimated error, 0 if given; may be NULL */
    double error_patches;           /* sigma K^4 L^2, out: root mean square error of power from patches */
    double error_beams;             /* sigma K^4 L^2, out: root mean square error of power from beams */
    double residual;                /* out: at the end, to compare with `tolerance` */
    uint32_t sweeps;                /* out */
    double *wall_absorbed;          /* sigma K^4 L^2, [walls], out: eps H, summed over wall_area; may be NULL */
    double surroundings_error;      /* sigma K^4 L^2, out: estimated error of surroundings_power */
    double *wall_area;              /* L^2, [walls], out: area; of an endless wall the part near the bed; may be NULL */
    double *least_temperature;      /* K, [spheres], out: least of the surface; may be NULL */
    double *largest_temperature;    /* K, [spheres], out: largest of the surface; may be NULL */
    double *centre_temperature;     /* K, [spheres], out; may be NULL */
    double *surface_error;          /* K, [spheres], out: estimated error of least and largest; may be NULL */
    double *centre_error;           /* K, [spheres], out: estimated error of centre_temperature; may be NULL */
    double gas_power;               /* sigma K^4 L^2, out: net power of the gas, through films */
    double gas_error;               /* sigma K^4 L^2, out: estimated error of gas_power */
    double *convected;              /* sigma K^4 L^2, [spheres], out: part of power, through films; may be NULL */
    double *wall_convected;         /* sigma K^4 L^2, [walls], out: part of wall_power, through films; may be NULL */
    double *conducted;              /* sigma K^4 L^2, [spheres], out: part of power, through contacts; may be NULL */
    double *wall_conducted;         /* sigma K^4 L^2, [walls], out: part of wall_power, through contacts; may be NULL */
    double *contact_flow;           /* sigma K^4 L^2, [contacts], out: from the first end to the second; may be NULL */
    double *contact_error;          /* sigma K^4 L^2, [contacts], out: estimated error of contact_flow; may be NULL */
} fibrad_heat_result;

/* Reads the solution.
 *   Output   result
 *   Errors   _ARGUMENT
 *            _STATE: there is no solution, or the scene has changed
 *            _UNSOLVABLE: only a temperature below zero would give some power. All results are written. */
int fibrad_heat_read(const fibrad_heat *heat, fibrad_heat_result *result);

/* Reads the solution on the sides of triangles: element 2 t is the front and 2 t + 1 the back of the caller's triangle
 * t. A value is the mean over the patches of the side. Sides that share a patch have equal values. If no plane and no
 * cylinder cuts a mesh, its flux times area, summed over its sides, is wall_power to rounding. If the mesh is not
 * insulated and sources.absorbed is set, this sum is wall_power plus the light that the mesh absorbs.
 *   Output   flux[2 triangles]: net power per area [sigma K^4]; may be NULL. NaN: the side belongs to no wall, or no
 *            beam and no ray reaches it.
 *            temperature[2 triangles]: [K]; may be NULL. NaN: the side belongs to no wall, its wall has no
 *            temperature, or its wall is insulated and no beam and no ray reaches the side.
 *   Errors   _ARGUMENT
 *            _STATE: there is no solution, or the scene has changed */
int fibrad_heat_read_sides(const fibrad_heat *heat, double *flux, double *temperature);

#ifdef __cplusplus
}
#endif
#endif
