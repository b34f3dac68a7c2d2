/* options.h - command-line options by tables, numbers, help. SPDX-License-Identifier: MIT */
#ifndef OPTIONS_H
#define OPTIONS_H

#include <stdbool.h>
#include <stdint.h>

#include "fibrad.h"
#include "fibrad_surface.h"

/* An option of a command. A table of them ends with a name of NULL. */
struct option {
    int key;              /* above 0; a letter, such as 'o', is also the short form -o */
    const char *name;     /* without the dashes */
    const char *argument; /* name of the argument in the help; NULL: the option takes no argument */
    const char *help;     /* NULL: the help does not show the option */
};

/* Keys that commands share. Keys of one command begin with KEY_OWN. */
enum {
    KEY_HELP = 'h',
    KEY_LONG = 256, /* larger keys have no short form */
    KEY_DIRECTIONS,
    KEY_AREAS,
    KEY_POINTS,
    KEY_METHOD,
    KEY_NF,
    KEY_NO_CORRECTION,
    KEY_RAYS,
    KEY_SEED,
    KEY_ERROR,
    KEY_RAW,
    KEY_EMISSIVITY,
    KEY_SOLID_CONDUCTIVITY,
    KEY_WALL,
    KEY_WALL_VTP,
    KEY_WALL_EMISSIVITY,
    KEY_PERIODIC,
    KEY_FRAME,
    KEY_THREADS,
    KEY_POSITIONS,
    KEY_RADIUS,
    KEY_LENGTH_UNIT,
    KEY_TEMPERATURE_UNIT,
    KEY_JSON,
    KEY_QUIET,
    KEY_FORMAT,
    KEY_PLOT,
    KEY_PROGRESS,
    KEY_SCRATCH,
    KEY_OWN
};

/* The text of a macro that is a number, for help texts. */
#define TEXT_OF(macro)   TEXT_OF_IT(macro)
#define TEXT_OF_IT(text) #text

/* Texts of bounds that several options have. */
#define TEXT_DIRECTIONS TEXT_OF(FIBRAD_DIRECTIONS_MIN) " to " TEXT_OF(FIBRAD_DIRECTIONS_MAX)

/* Rows of tables, without braces. */
#define OPTION_THREADS KEY_THREADS, "threads", "T", "number of threads, 1 to 1024 [all cores]"
#define OPTION_HELP    KEY_HELP, "help", NULL, "this text"

/* Rows of the options that the methods of view factors take, with braces. */
#define OPTIONS_METHODS                                                                                                \
    {KEY_DIRECTIONS, "directions", "N",                                                                                \
     "beam: number of directions, " TEXT_DIRECTIONS                                                                    \
     "; for all rows of a bed number of lines, each followed both ways; the error falls as N^-1.5 [" TEXT_OF(          \
         FIBRAD_DIRECTIONS_DEFAULT) "; lines " TEXT_OF(FIBRAD_LINES_DEFAULT) "]"},                                     \
        {KEY_AREAS, "areas", "KIND",                                                                                   \
         "beam: visible areas, exact or points; points are faster and less accurate [exact]"},                         \
        {KEY_POINTS, "points", "M", "beam: points per window, 64, 128 or 256; implies --areas points [256]"},          \
        {KEY_NF, "nf", "N",                                                                                            \
         "surface: nodes on each sphere, a Fibonacci number from " TEXT_OF(FIBRAD_NODES_MIN) " to " TEXT_OF(           \
             FIBRAD_NODES_MAX) " [" TEXT_OF(FIBRAD_NODES_DEFAULT) "]"},                                                \
        {KEY_NO_CORRECTION, "no-correction", NULL,                                                                     \
         "surface: plain sums [corrected by the exact factor without obstacles]"},                                     \
        {KEY_RAYS, "rays", "N",                                                                                        \
         "cast, mc: rays from a sphere; the error falls as N^-0.6 (cast) or N^-0.5 (mc) [" TEXT_OF(                    \
             FIBRAD_RAYS_DEFAULT) "]"},                                                                                \
    {                                                                                                                  \
        KEY_SEED, "seed", "S", "cast, mc: seed of the rays [0]"                                                        \
    }

/* What options_next returns besides keys. */
enum { OPTIONS_POSITIONAL = 0, OPTIONS_END = -1, OPTIONS_BAD = -2 };

/* A walk along the arguments. Set the first four fields, zero the others. */
struct options {
    const char *command;
    const struct option *table;
    int argc; /* the arguments behind the command's name */
    char **argv;
    int at;
    bool plain;        /* `--` has come: all arguments that follow are positional */
    const char *value; /* out: the option's argument, or the positional argument */
    const char *name;  /* out: the option's name */
};

/* Takes the next argument. Returns a key of the table, OPTIONS_POSITIONAL, OPTIONS_END, or OPTIONS_BAD after a message.
 * An argument that begins like a negative number is positional. */
int options_next(struct options *options);

/* Prints the table, each option with its help. */
void options_print(const struct option *table);

/* Reads a number, or a whole number, from low to high. The whole text must be the number. `what` names the number in
 * messages. Status 0 or STATUS_USAGE. */
int options_number(const char *what, const char *text, double low, double high, double *value);
int options_whole(const char *what, const char *text, uint64_t low, uint64_t high, uint64_t *value);
int options_count(const char *what, const char *text, uint32_t low, uint32_t high, uint32_t *value);

/* Reads up to `capacity` numbers with commas in between. *count: how many. Status 0 or STATUS_USAGE. */
int options_numbers(const char *what, const char *text, int capacity, double *values, int *count);

/* Takes the one FILE of a command. *file: NULL before. Status 0 or STATUS_USAGE. */
int options_file(const char *text, const char **file);

/* Takes the argument of --threads. Status 0 or STATUS_USAGE. */
int options_threads(const char *text, int *threads);

/* Methods by name, in the order of the enum. */
enum method { METHOD_EXACT, METHOD_BEAM, METHOD_SURFACE, METHOD_CAST, METHOD_MC };

/* Reads the name of a method. Status 0 or STATUS_USAGE. */
int options_method(const char *text, enum method *method);

/* Options of a beam rule. 0 or NULL: not given. */
struct beam_options {
    uint32_t directions, points;
    const char *areas;
};

/* Takes KEY_DIRECTIONS, KEY_AREAS or KEY_POINTS. Status 0 or STATUS_USAGE. */
int options_beam(int key, const char *text, struct beam_options *beam);

/* Makes the rule of these options. Status 0, or STATUS_USAGE if they contradict each other. */
int options_beam_rule(const struct beam_options *beam, fibrad_beam_rule *rule);

/* Takes KEY_NF or KEY_NO_CORRECTION. Status 0 or STATUS_USAGE. */
int options_surface(int key, const char *text, fibrad_surface_rule *rule);

/* Takes KEY_RAYS or KEY_SEED. Status 0 or STATUS_USAGE. */
int options_cast(int key, const char *text, fibrad_cast_rule *rule);

#endif
