/* contact_option.h - heat that contacts and gas conduct, from options, files of contacts, and overlaps.
 * SPDX-License-Identifier: MIT */
#ifndef CONTACT_OPTION_H
#define CONTACT_OPTION_H

#include "frames/solid_option.h"

enum { CONTACT_FILES_MAX = 8 };

#define CONTACTS_NEED "contacts need" /* for bed_options_metres */

/* Bound of conductances [W/K] of the options. */
#define CONDUCTANCE_MOST 1e12

/* Rows of a table of options, without the outermost braces. */
#define OPTIONS_CONTACTS(request)                                                                                      \
    {0, "contacts", "CONTACTS",                                                                                        \
     "heat through contacts: lens, hertz, or a file of conductances; lens and hertz find spots from overlaps, a file " \
     "has i,j,W/K; may be given several times [none]",                                                                 \
     TO_FUNCTION(contacts_option, request, contacts)},                                                                 \
        {0, "contact-conductivity", "K",                                                                               \
         "conductivity of the solid at contacts [W/(m K)]; as --solid-conductivity, but a sphere has one "             \
         "temperature [--solid-conductivity]",                                                                         \
         TO_FUNCTION(contact_conductivity_option, request, contacts.conductivity)},                                    \
    {                                                                                                                  \
        0, "gas-conductivity", "KG",                                                                                   \
            "thermal conductivity of the gas in narrow gaps [W/(m K)]; or @TABLE of temperatures [K] and "             \
            "conductivities [no gas]",                                                                                 \
            TO_TEXT(request, contacts.gas)                                                                             \
    }
#define OPTIONS_CONTACTS_RARE(request)                                                                                 \
    {0, "contact-scale", "S", "multiplies the radii of spots, since soft particles overlap too much [1]",              \
     TO_NUMBER(request, contacts.scale, 1e-6, 1e6)},                                                                   \
        {0, "gas-gap", "X", "gas conducts out to this distance from the smaller sphere, in its radii, up to 1 [0.65]", \
         TO_NUMBER(request, contacts.gap, 1e-6, 1)},                                                                   \
        {0, "gas-jump", "L", "length added to gaps, since narrow gaps conduct less [m] [0]",                           \
         TO_NUMBER(request, contacts.jump, 0, 1)},                                                                     \
    {                                                                                                                  \
        0, "contact-flows", "OUT",                                                                                     \
            "write what each contact conducts: .csv with i,j,W/K,W,error_W; - for standard output [none]",             \
            TO_TEXT(request, contacts.flows)                                                                           \
    }

/* A paragraph of --help. */
#define CONTACTS_MORE                                                                                                  \
    "--contacts FILE: A header i,j,W/K (or mW/K, kW/K) and a line for each contact. i and j are names of\n"            \
    "spheres or of walls. A * in FILE stands for the number of the frame. Several lines of a pair add up.\n"           \
    "With lens or hertz, spheres and walls that overlap touch at a spot of radius a: the circle in which they\n"       \
    "cut each other, or Hertz's spot, which is 1.41 times smaller. The spot conducts 2 k a, or 4 k a to a\n"           \
    "wall. A contact with a wall of temperatures=FILE acts at the temperature of the triangle that is touched.\n"      \
    "With contacts, outputs have q_radiation_W and q_conduction_W. These are parts of q_W.\n"

/* Arguments of the options. Begin with zeroes. */
struct contact_options {
    int spots; /* a fibrad_spots */
    const char *file[CONTACT_FILES_MAX];
    uint32_t files;
    struct quantity conductivity;
    double scale, gap, jump; /* 0: not given */
    const char *gas;         /* NULL: no gas */
    double gas_value;        /* [W/(m K)] if there is no table */
    struct curve gas_curve;
    const char *flows; /* NULL: not wanted */
};

#define CONTACT_NO_SIDE UINT32_MAX

/* Contacts of one bed. */
struct contact_state {
    const struct contact_options *options; /* NULL: no contacts */
    uint32_t n, listed;                    /* all contacts; those of files, which come first */
    uint32_t *first, *second;              /* [n] as in fibrad_heat_sources */
    double *conductance;                   /* [n] in the unit of the library */
    double *flow, *error;                  /* [n] [W] */
    uint32_t *side; /* [n] the side of a triangle, as in fibrad_heat_sources, or CONTACT_NO_SIDE; NULL: not known */
    double *temperature;             /* [n] contact_temperature of the sources; NULL: none */
    double *conducted;               /* [spheres] [W] */
    double *gas;                     /* [n - listed] conductivities [W/(m K)] */
    double *solid;                   /* [spheres] conductivities [W/(m K)]; NULL: not needed */
    const struct quantity *of_solid; /* their option */
    const fibrad_contact_list *list; /* of the bed of the library: contacts of overlaps and gas; NULL: none */
    fibrad_contact_rule rule;
    double per_watt;        /* conductance over W/K */
    double wall[WALLS_MAX]; /* [W] conducted to walls */
};

option_take contacts_option, contact_conductivity_option;

/* Whether the options ask for contacts. */
bool contacts_given(const struct contact_options *options);

/* Checks the options when all have been read. solid: --solid-conductivity is given. Status 0, STATUS_USAGE, or as
 * curve_read. */
int contacts_check(struct contact_options *options, struct bed_options *bed, bool solid);

/* Reads and finds the contacts of a bed, whose unit of length is known, and points `sources` to them. solid:
 * --solid-conductivity. made: the bed of the library, which keeps the list. per_watt: as in contact_state. Call
 * contacts_free also after an error. Status 0, STATUS_USAGE, STATUS_INPUT, STATUS_FILE or STATUS_MEMORY. */
int contacts_begin(struct contact_state *state, const struct contact_options *options, struct bed_options *bed_options,
                   const struct bed *bed, fibrad_bed *made, const struct walls *walls, const struct quantity *solid,
                   double per_watt, fibrad_heat_sources *sources);
void contacts_free(struct contact_state *state);

/* Sets conductances that depend on temperatures [K], NaN: not known. */
void contacts_follow(struct contact_state *state, const struct bed *bed, const double *temperature,
                     const double *wall_temperature);

/* contact_places.c: finds the sides that spheres touch on the walls that `own` marks, which are meshes. Makes walls the
 * second ends of contacts, and sets state->temperature to NaN. Status 0 or STATUS_MEMORY. */
int contacts_find_places(struct contact_state *state, const struct bed *bed, const struct walls *walls,
                         const bool own[WALLS_MAX]);

/* Sets state->temperature of contacts with these sides: to that of the side, or of its wall if the side has none.
 * side_temperature NULL: no side has one. */
void contacts_place(struct contact_state *state, uint32_t spheres, const double *side_temperature,
                    const double *wall_temperature);

/* Finds how far temperatures are beyond the ends of tables, as quantity_excess: of the solid at spots, and of the gas.
 * Then warns of it. */
void contacts_excess(struct contact_state *state, const struct bed *bed, const double *temperature,
                     const double *wall_temperature, struct table_excess excess[2]);
void contacts_warn(struct warned *warned, const struct table_excess excess[2]);

/* Points a result to the arrays of contacts, and scales them to watts. */
void contacts_result(struct contact_state *state, fibrad_heat_result *result);
void contacts_scale(struct contact_state *state, uint32_t spheres, uint32_t walls);

/* The root mean square error of what contacts conduct, over its root mean square. */
double contacts_error(const struct contact_state *state);

/* Writes --contact-flows of a frame. Status 0, STATUS_FILE, STATUS_USAGE or STATUS_MEMORY. */
int contacts_write(const struct contact_state *state, const struct bed *bed, const struct walls *walls);

/* Reports the contacts and what they conduct. */
void contacts_report(const struct contact_state *state, const struct bed *bed, const struct walls *walls,
                     struct report *report);

/* Where a fault of a contact is, in words. "": the fault is of no contact. */
int contacts_refuse(const struct contact_state *state, const struct bed_options *options, const struct bed *bed,
                    const struct walls *walls, int status, const fibrad_fault *fault);

/* read_contacts.c: contacts of a file. */
struct contact_lines {
    uint32_t n;
    uint32_t *first, *second;
    double *conductance; /* [W/K] */
};

/* Gives the arrays another size. Status 0 or STATUS_MEMORY. */
int contacts_resize(struct contact_lines *to, size_t n);

/* Adds the contacts of a file. `path` may have a *, for the number of the frame. Status as contacts_begin. */
int contacts_read(const char *path, const struct bed *bed, const struct walls *walls, struct contact_lines *to);

#endif
