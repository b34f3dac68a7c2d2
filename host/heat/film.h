/* film.h - convection: heat that spheres and walls exchange with gas of a given temperature.
 * SPDX-License-Identifier: MIT */
#ifndef FILM_H
#define FILM_H

#include "frames/bed_options.h"

/* Rows of a table of options, for a request with a field `film`: with braces, and without. */
#define OPTIONS_FILM(request)                                                                                          \
    {0, "convection", "H",                                                                                             \
     "heat transfer coefficient of all spheres to the gas [W/(m2 K)]; a number, TYPE:H,..., or a column of the file "  \
     "[no gas]",                                                                                                       \
     TO_FUNCTION(convection_option, request, film.coefficient)},                                                       \
    {                                                                                                                  \
        0, "gas-temperature", "T",                                                                                     \
            "temperature of this gas; a number, TYPE:T,..., a column of the file, or with --until @TABLE",             \
            TO_FUNCTION(gas_temperature_option, request, film)                                                         \
    }

/* A paragraph of --help. */
#define FILM_MORE                                                                                                      \
    "--convection H: A sphere gains H times its surface times (gas temperature - T_K). Walls have :convection=H\n"     \
    "and :gas=T; without :gas they have the gas of --gas-temperature, if that is one number or a table. Outputs\n"     \
    "have q_convection_W, which is a part of q_W, and a line for the gas.\n"

/* Arguments of the options. Begin with zeroes; free gas_curve and tables of quantities. */
struct film_options {
    struct quantity coefficient; /* [W/(m2 K)] */
    struct quantity gas;         /* in the unit of temperatures */
    struct curve gas_curve;      /* over time [s]; n = 0: none */
    const char *gas_table;       /* its path; NULL: none */
};

option_take convection_option, gas_temperature_option;

/* Films of one bed. */
struct film_state {
    bool any;
    double *film, *gas, *end; /* [spheres] in the unit of the library; [K]; [K] at the end of a span of time */
    double *convected;        /* [spheres] [W] */
    double wall_film[WALLS_MAX], wall_gas[WALLS_MAX], wall_end[WALLS_MAX], wall[WALLS_MAX];
    bool wall_follows[WALLS_MAX]; /* its gas is that of the table */
    double per_watt;              /* film over W/K */
};

/* Whether the options ask for films. */
bool film_given(const struct film_options *options, const struct wall_options *walls);

/* Checks the options when all have been read. zero: of the unit of temperatures [K]. Status 0, STATUS_USAGE, or as
 * curve_read. */
int film_check(struct film_options *options, struct bed_options *bed, double zero, bool timed);

/* Finds the films of a bed, whose unit of length is known, and points `sources` and `result` to them. Call film_free
 * also after an error. Status 0, STATUS_USAGE, STATUS_INPUT or STATUS_MEMORY. */
int film_begin(struct film_state *state, const struct film_options *options, const char *file, const struct bed *bed,
               const fibrad_bed *made, const struct walls *walls, double zero, double per_watt,
               fibrad_heat_sources *sources, fibrad_heat_result *result);
void film_free(struct film_state *state);

/* Sets the temperatures of a table: now, and at the end of a span. */
void film_at(struct film_state *state, const struct film_options *options, uint32_t spheres, uint32_t walls,
             double zero, double now, double end);

/* Scales results to watts, and reports them. */
void film_scale(struct film_state *state, uint32_t spheres, uint32_t walls, fibrad_heat_result *result);
void film_report(const struct film_state *state, const struct film_options *options, const struct walls *walls,
                 const fibrad_heat_result *result, struct report *report);

#endif
