/* light_option.h - light from outside that falls on a bed: options, what is absorbed, and the summary.
 * SPDX-License-Identifier: MIT */
#ifndef LIGHT_OPTION_H
#define LIGHT_OPTION_H

#include "frames/bed_options.h"

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

#endif
