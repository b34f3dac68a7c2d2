/* heat.h - a run of `fibrad heat`: what the options say, the bed in hand, its heat problem and the result.
 * SPDX-License-Identifier: MIT */
#ifndef HEAT_H
#define HEAT_H

#include "contact_options/contact_option.h"

/* ---- what is given of each sphere and wall: its temperature or its power ----------------------------------------- */

/* Arguments of the options. Begin with zeroes. */
struct given_options {
    struct quantity temperature, power;
    const char *ambient; /* NULL: not given */
    double zero;         /* [K] 0 of the unit of temperature */
    /* Temperatures change with time. Then those of the options are initial ones. Each sphere has a temperature and may
     * have a power too. The temperatures of walls and surroundings may be tables over time, @TABLE. */
    bool timed;
    struct curve ambient_curve; /* n = 0: --ambient is a number */
    double surroundings;        /* [K] their temperature, of a table that at 0 s; NaN: not given */
};

/* Temperatures and powers of one bed. NaN: not given. */
struct given {
    double *temperature; /* [spheres] [K] */
    double *power;       /* [spheres] [W] */
    double wall_temperature[WALLS_MAX], wall_power[WALLS_MAX];
    unsigned char insulated[WALLS_MAX];
    /* temperatures of walls from tables, in the unit of the options: over time, or of each triangle; n = 0: none */
    struct curve curve[WALLS_MAX], column[WALLS_MAX];
    double *side_temperature; /* [2 triangles] [K] as in fibrad_heat_sources; NULL: no side has one of its own */
};

/* Takes the argument of --power into a quantity. Status 0 or STATUS_USAGE. */
int given_power_option(const char *text, void *power);

/* Checks the options when all have been read, asks `bed` for the columns they name, and finds options->surroundings.
 * The caller frees options->ambient_curve. Status 0, STATUS_USAGE, or as curve_read. */
int given_check(struct given_options *options, struct bed_options *bed);

/* Finds the temperatures and powers of a bed and its walls. Call given_free also after an error. Status 0, STATUS_USAGE
 * naming a wall, STATUS_MEMORY, or STATUS_INPUT naming the line of a sphere that has both a temperature and a power, or
 * neither. */
int given_values(const struct given_options *options, const struct bed *bed, const char *file,
                 const struct walls *walls, struct given *given);
void given_free(struct given *given);

/* Refuses spheres and walls of emissivity 0 that have a power. Status 0, STATUS_USAGE naming a wall, or STATUS_INPUT
 * naming the line of a sphere. */
int given_reflectors(const struct given *given, const double *emissivity, const struct walls *walls,
                     const double *wall_emissivity, const struct bed *bed, const char *file);

/* Points `sources` to the arrays of a bed of n spheres. Divides powers by the unit of area of the library [m2]. */
void given_heat_sources(struct given *given, uint32_t n, double square_metres, fibrad_heat_sources *sources);

/* ---- light from outside that falls on a bed: options, what is absorbed, and the summary -------------------------- */

enum { LIGHTS_MAX = 32 };

/* Rows of the table of options, for a request with a field `light`: with braces, and without. */
#define OPTIONS_LIGHT(request)                                                                                         \
    {0, "irradiate", "LIGHT",                                                                                          \
     "light from outside, DX,DY,DZ:FLUX; its direction, and its W/m2 across that direction [none]",                    \
     TO_FUNCTION(irradiate_option, request, light)},                                                                   \
    {                                                                                                                  \
        0, "absorptivity", "A",                                                                                        \
            "absorptivity of all spheres for that light; 0 to 1, or TYPE:A,..., or a column of the file [emissivity]", \
            TO_FUNCTION(absorptivity_option, request, light.absorptivity)                                              \
    }

/* A paragraph of --help. */
#define LIGHT_MORE                                                                                                     \
    "--irradiate: several are allowed. LIGHT is DX,DY,DZ:FLUX and may go on with\n"                                    \
    "  :half-angle=RAD        directions fill a cone; 5mrad and 0.3deg are angles, too; sun is 4.65mrad\n"             \
    "  :disc=X,Y,Z,R          a beam through a disc of radius R at right angles to it, before the bed\n"               \
    "  :box=X1,X2,Y1,Y2       a beam through a rectangle across z, at the lit end of the bed\n"                        \
    "Lengths are in the unit of the file. Without disc or box the light falls on all that is open. Between\n"          \
    "side walls the light needs an opening at the height H of their rim (zmax:open:at=H). A surface absorbs the\n"     \
    "fraction --absorptivity of the light, is heated by it, and reflects the rest. q_W is the net power of\n"          \
    "light and thermal radiation together. The .csv has two more columns: absorbed_first_W is what is\n"               \
    "absorbed of light straight from outside, absorbed_W is all light that is absorbed. For the surroundings\n"        \
    "they are the light that leaves without having met anything, and all light that leaves.\n"

/* Arguments of the options. Begin with zeroes. */
struct light_options {
    fibrad_light light[LIGHTS_MAX]; /* [lights] lengths in the bed's unit, flux in W/m2 */
    uint32_t lights;
    struct quantity absorptivity;
};

/* What light does to a bed. */
struct light_state {
    const struct light_options *options;       /* NULL: there is no light */
    double *absorptivity, of_walls[WALLS_MAX]; /* [spheres] */
    double *absorbed, *first, *error;          /* [spheres], with `power` in one block */
    double *power, wall_power[WALLS_MAX];      /* given powers and what is absorbed, for thermal radiation */
    double wall[WALLS_MAX], wall_first[WALLS_MAX], wall_error[WALLS_MAX];
    bool failed;                /* the library has refused the light, or its solution */
    fibrad_light_result result; /* with these arrays; [W] when the bed is solved */
};

/* Functions of the rows above. Status 0 or STATUS_USAGE. */
option_take irradiate_option, absorptivity_option;

/* Checks the options when all have been read. of_emissivity: that of --emissivity. Status 0 or STATUS_USAGE. */
int light_check(struct light_options *options, struct bed_options *bed, const struct quantity *of_emissivity);

/* ---- convection: heat that spheres and walls exchange with gas --------------------------------------------------- */

/* Rows of a table of options, for a request with a field `film`: with braces, and without. */
#define OPTIONS_FILM(request)                                                                                          \
    {0, "convection", "H",                                                                                             \
     "heat transfer coefficient of all spheres to the gas [W/(m2 K)]; a number, TYPE:H,..., a column of the file, or " \
     "a correlation, wakao:K,MU or gunn:K,MU [no gas]",                                                                \
     TO_FUNCTION(convection_option, request, film)},                                                                   \
    {                                                                                                                  \
        0, "gas-temperature", "T",                                                                                     \
            "temperature of this gas; a number, TYPE:T,..., a column of the file, or with --until @TABLE",             \
            TO_FUNCTION(gas_temperature_option, request, film)                                                         \
    }
#define OPTIONS_STREAM(request)                                                                                        \
    {0, "gas-flow", "AXIS:G",                                                                                          \
     "gas flows through the bed along x, y, z, -x, -y or -z, G [kg/(m2 s)] over the empty cross-section; "             \
     "--gas-temperature is that of its inlet [no flow]",                                                               \
     TO_FUNCTION(gas_flow_option, request, film)},                                                                     \
    {                                                                                                                  \
        0, "gas-heat-capacity", "C",                                                                                   \
            "specific heat of this gas [J/(kg K)]; a number, or @TABLE of temperatures [K] and specific heats",        \
            TO_FUNCTION(gas_capacity_option, request, film)                                                            \
    }

/* A paragraph of --help. */
#define FILM_MORE                                                                                                      \
    "--convection H: A sphere gains H times its surface times (gas temperature - T_K). Walls have :convection=H\n"     \
    "and :gas=T; without :gas they have the gas of --gas-temperature, if that is one number or a table. Outputs\n"     \
    "have q_convection_W, which is a part of q_W, and a line for the gas.\n"                                           \
    "--gas-flow: The gas goes through slices of one mean diameter. Each slice has one temperature, which is found.\n"  \
    "The line of the gas has the temperature of the outlet. The cross-section ends at the walls or periods\n"          \
    "beside the flow, else at the spheres. --convection wakao:K,MU takes the coefficient of Wakao and Kaguei,\n"       \
    "gunn:K,MU that of Gunn, for gas of conductivity K [W/(m K)] and viscosity MU [Pa s].\n"

/* Correlations of heat transfer coefficients: stream.c. */
enum correlation { NO_CORRELATION, WAKAO, GUNN };

/* Arguments of the options. Begin with zeroes; free curves and tables of quantities. */
struct film_options {
    struct quantity coefficient;    /* [W/(m2 K)] */
    struct quantity gas;            /* in the unit of temperatures */
    struct curve gas_curve;         /* over time [s]; n = 0: none */
    const char *gas_table;          /* its path; NULL: none */
    enum correlation correlation;   /* in place of the coefficient */
    double conductivity, viscosity; /* of the gas, for it [W/(m K)], [Pa s] */
    double flux;                    /* [kg/(m2 s)] 0: the gas does not flow */
    int axis;                       /* 0 to 2, along which it flows */
    bool down;                      /* to lower coordinates */
    double capacity;                /* [J/(kg K)] 0: not given */
    struct curve capacity_curve;    /* the same over temperature; n = 0: none */
};

option_take convection_option, gas_temperature_option, gas_flow_option, gas_capacity_option;

/* Films of one bed. */
struct film_state {
    bool any;
    double *film, *gas, *end; /* [spheres] in the unit of the library; [K]; [K] at the end of a span of time */
    double *convected;        /* [spheres] [W] */
    double wall_film[WALLS_MAX], wall_gas[WALLS_MAX], wall_end[WALLS_MAX], wall[WALLS_MAX];
    bool wall_follows[WALLS_MAX]; /* its gas is that of the table */
    double per_watt;              /* film over W/K */
    fibrad_stream stream;         /* gas that flows; slices 0: it does not */
    double *memory;               /* of its arrays of numbers */
    double section, inlet_end;    /* [m2] cross-section; [K] temperature of the inlet at the end of a span of time */
};

/* ---- clumps: bodies of several spheres --------------------------------------------------------------------------- */

/* Row of a table of options, for a request with a field `members`, without braces. */
#define OPTION_MEMBERS(request)                                                                                        \
    0, "members", NULL, "with --clump: a line for each sphere in .csv and .json [a line for each clump]",              \
        TO_FLAG(request, members)

/* A paragraph of --help. */
#define CLUMPS_MORE                                                                                                    \
    "--clump: A clump is one body of one temperature. What its members hide of each other is no surface. Either\n"     \
    "all members have the same temperature, or each has a power; their powers add up. A clump stores heat by its\n"    \
    "volume, and gas acts on its exposed area, area_m2. The .csv and .json have a line for each clump, with its\n"     \
    "number as i; .vtp, .dump and --profile have the spheres. Contacts within a clump carry nothing.\n"

/* Clumps of one bed. NULL: there are none. */
struct clump_state {
    uint32_t n;            /* number of bodies */
    uint32_t *body;        /* [spheres] */
    double *area, *volume; /* [spheres] exposed area and share of the volume [L^2, L^3] */
    /* of the outputs */
    struct bed bodies;
    fibrad_heat_result result; /* [n] */
    double *metres;            /* [spheres], then [n]: areas [m2] */
};

/* ---- a run of `fibrad heat`: what the options say, the bed in hand, its heat problem and the result -------------- */

#define SECONDS_MAX 1e15

/* Rows of a table of options, for a request with a field `time`: without the outermost braces, and without braces. */
#define OPTIONS_TIME(request)                                                                                          \
    {0, "until", "S", "follow the temperatures up to S seconds; from those given [powers at one time]",                \
     TO_NUMBER(request, time.until, 1 / SECONDS_MAX, SECONDS_MAX)},                                                    \
        {0, "heat-capacity", "C",                                                                                      \
         "specific heat of the spheres [J/(kg K)]; a number, TYPE:C,..., or a column of the file; @TABLE of "          \
         "temperatures [K] and specific heats may stand for a number; inf: the temperature stays",                     \
         TO_FUNCTION(capacity_option, request, time.capacity)},                                                        \
        {0, "density", "RHO", "density of the spheres [kg/m3]; a number, TYPE:RHO,..., or a column of the file",       \
         TO_FUNCTION(density_option, request, time.density)},                                                          \
    {                                                                                                                  \
        0, "times", "LIST", "times of output in seconds, 0,10,60 for example, or every:60 [the end]",                  \
            TO_TEXT(request, time.times)                                                                               \
    }
#define OPTION_MELTING(request)                                                                                        \
    0, "melting", "T,L[,WIDTH]",                                                                                       \
        "spheres melt at T with the latent heat L [J/kg], or evenly over WIDTH [K] about T [nothing melts]",           \
        TO_FUNCTION(melting_option, request, time)
#define OPTION_STEP(request)                                                                                           \
    0, "step", "S", "longest step in seconds, or auto for steps with errors of 1e-4 [auto]",                           \
        TO_FUNCTION(step_option, request, time.step)

/* Arguments of the options. Begin with zeroes. */
struct time_options {
    double until, step, every; /* [s] 0: not given, automatic, not given */
    struct quantity capacity, density;
    const char *times;
    double melting, latent, width; /* in the unit of temperatures, [J/kg], [K]; latent 0: nothing melts */
};

/* Functions of the rows above. */
option_take capacity_option, density_option, melting_option, step_option;

/* Takes every:S, an argument of --times, into a double. */
option_take every_option;

/* Checks the options when all have been read, and asks `bed` for the columns they name. Without --until the other
 * options are refused. zero: 0 of the unit of temperatures [K]. Status 0 or STATUS_USAGE. */
int time_check(struct time_options *time, double zero, struct bed_options *bed);

/* Row of a table of options, for a request with a field `profile`, without braces. */
#define OPTION_PROFILE(request)                                                                                        \
    0, "profile", "AXIS[:BINS]:OUT",                                                                                   \
        "write temperatures and powers against x, y, z, or r from the axis of a cylinder, to a .csv; a bin is one "    \
        "mean diameter [none]",                                                                                        \
        TO_FUNCTION(profile_option, request, profile)

/* Its argument. Begin with zeroes. */
struct profile {
    char axis;        /* 'x', 'y', 'z' or 'r' */
    uint32_t bins;    /* 0: one mean diameter each */
    const char *path; /* NULL: no profile */
};

option_take profile_option;

/* The emissivity of a bed's open face: what spheres and walls of one temperature send out through the open faces,
 * divided by what black faces would send out. */
struct face {
    bool wanted; /* by the options; the rest is of the bed in hand */
    double area; /* of all open faces [L^2] */
    double emissivity, error;
};

/* Quantities of a triangle: the sum of the fluxes of its two sides, and the temperature whose T^4 is the mean of T^4 of
 * both sides. */
enum { TRIANGLE_FLUX, TRIANGLE_TEMPERATURE, TRIANGLE_QUANTITIES };

/* The figures of the summary. */
struct heat_figures {
    double power_rms;  /* root mean square power of a sphere [W] */
    double largest;    /* largest power of a sphere, a wall or the surroundings [W] */
    double emitted;    /* emitted by all spheres [W] */
    double throughput; /* root mean square over spheres of the larger of emitted and absorbed power [W] */
    double error;      /* root mean square error of a sphere's power [W] */
    /* largest error of a wall: that of its power over the larger of power and absorbed power, or, where the temperature
     * was found, that of sigma T^4, relative */
    double wall_error;
    double balance_of_emission; /* sum of all powers over that of the larger of emitted and absorbed power of spheres */
    uint32_t unknown;           /* spheres whose temperatures were found; the figures below are of these spheres */
    double coldest, hottest, temperature_mean; /* [K] */
    double temperature_error;                  /* root mean square error [K] */
    double emission_error;                     /* root mean square error of sigma T^4 over its root mean square */
    double flow_error; /* the same of what contacts conduct, if spheres conduct inside; else 0 */
    /* of spheres that conduct */
    double surface_min, surface_max; /* [K] least and largest temperature of all surfaces */
    double surface_span;             /* [K] largest difference on the surface of a sphere */
    double surface_error;            /* [K] root mean square error of least and largest temperatures */
    double centre_max;               /* [K] */
};

struct heat {
    /* ---- options; the same for all beds ---- */
    struct bed_options options; /* first, for OPTIONS_INPUT */
    struct given_options given;
    struct time_options time;
    struct light_options light;
    struct contact_options contacts;
    struct film_options film;
    struct face face;
    struct profile profile;
    bool coupled; /* the end of the run, and temperatures of gas and faces, come from another solver */
    bool members; /* outputs have a line for each member of a clump */
    struct quantity emissivities, solid;
    fibrad_heat_config config; /* directions 0: chosen by the emissivities of the bed */
    /* --error: error allowed in powers, and in sigma T^4 of temperatures that are found, over their root mean squares;
     * 0: not given */
    double error;

    /* ---- the bed in hand, whose unit of length is known: what is given ---- */
    const struct bed *bed;
    struct walls walls;
    fibrad_bed *made;    /* the same in the library; with --face it has openings on all open sides */
    struct given values; /* temperatures and powers */
    double *emissivity, wall_emissivity[WALLS_MAX]; /* [spheres] changes where a table over T is given */
    /* [spheres] conductivities of the solid [W/(m K)], which change where a table over T is given, and the same in the
     * unit of sources.conductivity; NULL: spheres have one temperature each */
    double *conductivity, *conductivity_scaled;
    double per_watt;               /* sources.conductivity over conductivity */
    struct clump_state clumps;     /* what of the bed are clumps */
    const fibrad_wall *around;     /* the cylinder whose axis a profile along r is measured from; NULL: none */
    struct light_state lit;        /* light from outside; its options NULL: there is none */
    struct contact_state touching; /* what conducts between spheres; options NULL: nothing does */
    struct film_state films;       /* convection */
    fibrad_heat_sources sources;   /* [K]; surroundings NaN: the bed is closed; powers in watts only in time */

    /* ---- its result ---- */
    fibrad_heat_result result;     /* [W] */
    double of_walls[6][WALLS_MAX]; /* arrays of the result */
    struct side_arrays triangles;  /* if an output has triangles */
    fibrad_heat_config used;       /* the last configuration */
    fibrad_scene_facts facts;
    double seconds;       /* time of computing, without reading and writing [s] */
    double error_reached; /* in the sense of `error` */
    struct heat_figures figures;
};

/* heat_bed.c: the heat problem of a bed. Begins with a bed, with zeroes from heat->bed on. End it also after an error.
 * Status 0, STATUS_USAGE, STATUS_INPUT, STATUS_FILE or STATUS_MEMORY. */
int heat_begin(struct heat *heat, struct bed *bed);
void heat_end(struct heat *heat);

/* Finds where spheres touch walls whose sides have temperatures of their own, and sets sources.contact_temperature.
 * more: whether a wall counts without such sides, too; NULL: none does. Status 0 or STATUS_MEMORY. */
int heat_find_places(struct heat *heat, const bool *more);

/* Whether a wall is insulated. */
bool heat_insulates(const struct heat *heat);

/* A law of the library, whose context is the heat. It sets emissivities and conductivities of spheres and contacts that
 * have tables to those at these temperatures. */
fibrad_emissivity_law heat_follow;

/* Finds how far spheres and contacts are beyond the ends of tables, as quantity_excess, and warns of it. */
enum { TABLES = 4 };
void heat_excess_of(struct heat *heat, const double *temperature, const double *wall_temperature,
                    struct table_excess excess[TABLES]);
void heat_warn_excess(struct heat *heat, const struct table_excess excess[TABLES]);

/* Writes the result: all outputs, and the flows of contacts. `what` has further fields, or zeroes. */
int heat_write(struct heat *heat, const struct bed *bed, struct contents *what);

/* heat_run.c: solves the problem with the configuration heat->used. Status 0, STATUS_INPUT if no temperatures above 0 K
 * have the given powers, STATUS_MEMORY, as bed_options_status, or FIBRAD_E_UNSUPPORTED if there is a solution already
 * and the configuration is too fine for this bed. The solution then stays. */
int heat_solve(struct heat *heat);

/* heat_error.c: solves the problem. With --error, solves again with more beams and patches until the estimated error is
 * small enough. Status as heat_solve. */
int heat_run(struct heat *heat);

/* heat_figures.c: finds the figures of the summary: those of temperatures and surfaces in K as soon as they are known,
 * the others when powers are in watts. Reports the summary. */
void heat_find_temperatures(struct heat *heat);
void heat_find_figures(struct heat *heat);
void heat_report(struct heat *heat);

/* heat_time.c: advances the temperatures in time, writes them at the times of output, draws the picture and prints the
 * summary. Status 0, STATUS_USAGE, STATUS_INPUT naming the line of a sphere, or as bed_options_status. */
int heat_in_time(struct heat *heat);

/* face.c: adds the openings that the bed of the library needs at open faces to `opened`. Status 0, or STATUS_USAGE if
 * there is no open face or one has no end. */
int face_begin(struct heat *heat, struct walls *opened);

/* Finds area and emissivity of the face. By Kirchhoff's law it is the fraction of black radiation from outside that
 * spheres and walls absorb: paths from the open faces tell it. Status 0, or as bed_options_status. */
int face_solve(struct heat *heat);
void face_report(struct heat *heat);

/* lit_bed.c: light that falls on the bed; without light these functions do nothing. Finds absorptivities and allocates
 * arrays. Without --irradiate heat->lit.options is NULL. Free them also after an
 * error. Status 0, STATUS_INPUT, STATUS_USAGE or STATUS_MEMORY. */
int light_begin(struct heat *heat);
void light_free(struct light_state *state);

/* Computes the light that is absorbed, and adds it to the powers of the sources. These are then the sources of thermal
 * radiation. They have pointers into heat->made. unit: of powers, the square of the bed's length [m2] for watts, or 1.
 * Returns a status of the library. */
int light_absorb(struct heat *heat, double unit, fibrad_heat_sources *sources);

/* Says why light_absorb has failed. Returns STATUS_USAGE; 0: nothing is wrong with the light. */
int light_refuse(const struct heat *heat, int status, const fibrad_fault *fault);

/* Multiplies all powers by a number. */
void light_scale(struct heat *heat, double factor);

/* Adds the absorbed light to the net powers of the result, and its errors to theirs. Insulated walls are left out: they
 * give off what they absorb. */
void light_add(struct heat *heat);

/* Reports what is absorbed, reflected and transmitted. */
void light_report(struct heat *heat);

/* film.c: whether the options ask for films. Checks the options when all have been read. Status 0, STATUS_USAGE, or as
 * curve_read. */
bool film_given(const struct heat *heat);
int film_check(struct heat *heat);

/* Finds the films of a bed, and points the sources and the result to them. per_watt: a conductance of the library over
 * W/K. Call film_free also after an error. Status 0, STATUS_USAGE, STATUS_INPUT or STATUS_MEMORY. */
int film_begin(struct heat *heat, double per_watt);
void film_free(struct film_state *state);

/* Sets the temperatures of a table: now, and at the end of a span. */
void film_at(struct heat *heat, double now, double end);

/* Scales results to watts, and reports them. */
void film_scale(struct heat *heat);
void film_report(struct heat *heat);

/* clump_heat.c: finds the clumps of a bed. Without clumps these functions do nothing. Call clumps_free also after an
 * error. Status 0 or STATUS_MEMORY. */
int clumps_begin(struct heat *heat);
void clumps_free(struct clump_state *state);

/* The surface [m2] and the volume [m3] of sphere i. */
double heat_area(const struct heat *heat, uint32_t i);
double heat_volume(const struct heat *heat, uint32_t i);

/* Adds areas to what is written, and without --members the results of bodies. Status 0 or STATUS_MEMORY. */
int clumps_result(struct heat *heat, const struct bed *bed, struct contents *what);

/* stream.c: checks the options of gas that flows. Status 0 or STATUS_USAGE. */
int stream_check(const struct film_options *options);

/* Divides the bed in hand into slices. Status 0, STATUS_USAGE, STATUS_INPUT or STATUS_MEMORY. */
int stream_begin(struct heat *heat);

/* Coefficients of spheres by the correlation [W/(m2 K)], [spheres]. Status 0 or STATUS_USAGE. */
int stream_coefficients(const struct heat *heat, double *coefficient);

/* The temperature of gas at the outlet [K]; NaN: it does not flow. */
double stream_outlet(const struct heat *heat);

void stream_report(struct heat *heat);

/* profile.c: finds the axis of r. Status 0, or STATUS_USAGE if there is none. */
int profile_begin(struct heat *heat);

/* Writes the profile, if one was asked for: of what the outputs have. Status 0, STATUS_USAGE, STATUS_FILE or
 * STATUS_MEMORY. */
int profile_write(const struct heat *heat, const struct contents *what);

#endif
