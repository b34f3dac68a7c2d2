/* command_heat.c - `fibrad heat`: net radiative powers of grey spheres and walls. SPDX-License-Identifier: MIT */

#include "command/heat_options.h"
#include "plot/plot_heat.h"

static int take_patches(const char *text, void *of_sphere) {
    uint32_t *patches = of_sphere;
    const int status = options_count("--patches", text, 1, UINT32_MAX, patches);
    if (!status && *patches != 24 && *patches != 96 && *patches != 384)
        return message(STATUS_USAGE, "--patches: %.40s is not built in; 24, 96 and 384 are", text);
    return status;
}

const struct option heat_options[] = {
    {OPTION_EMISSIVITY_CURVES(struct heat, emissivities)},
    {0, "temperature", "T",
     "temperature of all spheres, or TYPE:T,..., or a column of the file; blank or nan for spheres of --power",
     TO_FUNCTION(temperature_option, struct heat, given.temperature)},
    {0, "power", "W",
     "power that spheres of unknown temperature give off from inside [W]; a number, TYPE:W,..., or a column of the "
     "file, blank or nan for spheres of --temperature",
     TO_FUNCTION(given_power_option, struct heat, given.power)},
    {0, "ambient", "T", "temperature of the black surroundings; needed unless walls and periods close the bed",
     TO_TEXT(struct heat, given.ambient)},
    {OPTION_WALL},
    {OPTION_TEMPERATURE_UNIT(struct heat, given.zero)},
    {0, "error", "E",
     "error allowed in powers, relative to their root mean square; estimated, 1e-5 to 1; directions and patches are "
     "added until it is met [none]",
     TO_NUMBER(struct heat, error, 1e-5, 1)},
    {OPTION_SOLID_CONDUCTIVITY(struct heat, solid)},
    OPTIONS_CONTACTS(struct heat),
    OPTIONS_FILM(struct heat),
    OPTIONS_LIGHT(struct heat),
    {OPTION_CLUMP},
    OPTIONS_TIME(struct heat),
    OPTIONS_INPUT,
    {OPTION_BED_OUTPUT(
        "write the powers: .csv .dump (OVITO) .vtp (ParaView) .json, - for standard output [summary only]")},
    {OPTION_PLOT("draw a picture by gnuplot, .svg or .png [none]")},
    OPTIONS_RUN,
    OPTIONS_RARE,
    {0, "face", NULL, "find the emissivity of the open face of the bed, which has one temperature",
     TO_FLAG(struct heat, face.wanted)},
    OPTIONS_CONTACTS_RARE(struct heat),
    {OPTION_MEMBERS(struct heat)},
    {OPTION_MELTING(struct heat)},
    OPTIONS_STREAM(struct heat),
    {OPTION_PROFILE(struct heat)},
    {OPTION_STEP(struct heat)},
    {0, "patches", "P", "patches of each sphere, 24, 96 or 384 [" TEXT_OF(FIBRAD_HEAT_PATCHES_DEFAULT) "]",
     TO_FUNCTION(take_patches, struct heat, config.patches)},
    {0, "directions", "N",
     "directions of beams, " TEXT_DIRECTIONS
     " [" TEXT_OF(FIBRAD_HEAT_DIRECTIONS_DEFAULT) "; 112 if the mean emissivity is 0.35 or less]",
     TO_COUNT(struct heat, config.directions, FIBRAD_DIRECTIONS_MIN, FIBRAD_DIRECTIONS_MAX)},
    {0, "points", "M", "points of each beam, 64, 128 or 256 [64; with --until 128]",
     TO_FUNCTION(option_points, struct heat, config.points)},
    {0, "wall-rays", "N",
     "least number of rays from all walls, up to 2^30; errors of triangles fall as N^-0.5 [" TEXT_OF(
         FIBRAD_WALL_RAYS_DEFAULT) ", more with many beams or patches, or insulated walls]",
     TO_COUNT(struct heat, config.wall_rays, 1, FIBRAD_WALL_RAYS_MAX)},
    {OPTION_WALL_VTP},
    OPTIONS_INPUT_RARE,
    {OPTION_BED_FORMAT},
    {OPTION_SLICE},
    {.name = NULL}};

const char *const heat_more[] = {
    FILES_MORE,
    WALLS_MORE WALLS_OF_HEAT,
    "Each sphere has a temperature or a power. With both options, each sphere has a value from one of them.\n"
    "Example: --temperature 1:600 --power 2:5 gives 600 K to spheres of type 1, and 5 W to those of type 2.\n"
    "Columns have a blank or nan where the other option counts. A single number beside a list or a column is\n"
    "for the spheres that the list or column leaves out. A power is given off from inside, so the net power\n"
    "is its negative. An insulated wall sends back all that arrives, point by point. A sphere of emissivity 0\n"
    "reflects everything; without contacts and convection it gains nothing and has no temperature.\n",
    "--error E holds for the powers of the spheres together, for each wall, for the surroundings if a wall is\n"
    "insulated, and for T^4 where temperatures are found. Each error is relative to a root mean square. Where\n"
    "powers are below 1e-3 of what spheres emit or absorb, errors are relative to 1e-3 of what they emit or\n"
    "absorb.\n",
    LIGHT_MORE,
    CONTACTS_MORE,
    FILM_MORE,
    CLUMPS_MORE,
    "--until: Each sphere stores specific heat times density times volume. --temperature is that at the\n"
    "beginning, and --power heats the spheres. @TABLE, two columns of seconds and temperatures, may stand for\n"
    "the temperature of a wall (zmin:temperature=@TABLE), of the surroundings or of gas. The .csv then has\n"
    "the time in its first column. A series of .vtp has a .pvd for ParaView.\n"
    "A sphere whose heat capacity is inf keeps its temperature: --heat-capacity 1:800,2:inf holds type 2. The\n"
    "run ends with an error where a temperature leaves the table of --heat-capacity. With --melting outputs\n"
    "have the fraction that has melted.\n",
    "@TABLE: A header has names and units, `t [min],T [C]` or `k [W/(m K)],T [K]`, and says which column is\n"
    "which. Beyond the ends of a table its first or last value is taken, with a warning.\n",
    "--solid-conductivity: Spheres conduct, and T_K is the mean over the surface. A power comes from a source\n"
    "that is spread evenly inside. Outputs have the least and the largest temperature of the surface, the\n"
    "temperature of the centre, and their estimated errors: T_min_K, T_max_K, T_surface_error_K,\n"
    "T_centre_K, T_centre_error_K. The unit of length must be known.\n",
    "The .csv has the columns i,T_K,q_W,q_error_W,T_error_K,body, with estimated errors. The surroundings are\n"
    "i = -1. Walls are i = -2, -3, ... with their names in the column `body`, then gas. All q_W add up to 0.\n",
    "Several frames go into one .csv, .dump or .json with their numbers. If OUT has a *, each frame has a\n"
    "file. Standard output ends with a summary of each frame, one `key value` on a line. Its balance and\n"
    "error are relative to what the spheres emit, or to what they absorb if that is more.\n",
    NULL};

static int heat_help(void) {
    options_help(
        "heat",
        "fibrad heat FILE... --emissivity E --temperature T --ambient T [options]\n\n"
        "Net powers [W] of all spheres of FILE, of walls and of the surroundings, all grey and diffuse.\n"
        "A net power is above 0 where heat is gained. Where a power is given, the temperature is found [K].\n",
        heat_options, heat_more,
        "Examples:\n"
        "  fibrad heat packing.dump --emissivity 0.8 --temperature v_T --ambient 300 -o q.csv\n"
        "  fibrad heat packing.dump --emissivity 0.8 --power 40 --wall box:insulated,zmin:temperature=1200 \\\n"
        "      --error 0.005 -o q.vtp\n"
        "  fibrad heat 'bed.*.dump' --frame all --emissivity 1:0.3,2:0.9 --temperature T --ambient 300 \\\n"
        "      --wall zmin:temperature=1200,zmax:open,cylinder:0,0,0.48:temperature=600:emissivity=0.4 -o q.csv\n"
        "  fibrad heat packing.dump --emissivity 0.8 --temperature 1200 --ambient @room.csv --until 3600 \\\n"
        "      --heat-capacity 800 --density 2500 --times every:60 -o 'cool.*.vtp' --plot cool.png\n");
    return STATUS_OK;
}

int heat_check(struct heat *h, const char *command) {
    h->options.timed = h->given.timed = h->time.until > 0;
    const fibrad_heat_config *config = &h->config;
    const bool counted = config->directions > 0 || config->points > 0 || config->patches > 0 || config->wall_rays > 0;
    int status = bed_options_check(&h->options, command, CONTENT_HEAT);
    if (status) return status;
    if (h->given.timed && h->error > 0)
        return message(STATUS_USAGE, "--error is for powers at one time, not for --until");
    if (h->given.timed && h->face.wanted)
        return message(STATUS_USAGE, "--face is for powers at one time, not for --until");
    if (h->members && !h->options.clump.given) return message(STATUS_USAGE, "--members needs --clump");
    if (h->options.clump.given && (h->solid.given || h->light.lights > 0))
        return message(STATUS_USAGE, "--clump: %s; leave out %s",
                       h->solid.given ? "clumps have one temperature each" : "light on clumps is not computed",
                       h->solid.given ? "--solid-conductivity" : "--irradiate");
    if (!h->emissivities.given) return message(STATUS_USAGE, "--emissivity is missing; see fibrad %s --help", command);
    if (h->error > 0 && counted)
        return message(
            STATUS_USAGE,
            "--error chooses directions and patches; leave out --directions, --points, --patches and --wall-rays");
    if (config->patches == 0) h->config.patches = FIBRAD_HEAT_PATCHES_DEFAULT;
    bed_options_quantity(&h->options, &h->emissivities, NULL);
    bed_options_quantity(&h->options, &h->solid, SOLID_UNIT);
    status = contacts_check(&h->contacts, &h->options, h->solid.given);
    if (!status) status = time_check(&h->time, h->given.zero, &h->options);
    if (!status) status = light_check(&h->light, &h->options, &h->emissivities);
    if (!status) status = film_check(h);
    return status ? status : given_check(&h->given, &h->options);
}

/* Powers and temperatures at one time. */
static int heat_once(struct heat *h) {
    struct contents what = {.time = NULL};
    int status = heat_run(h);
    if (!status) status = heat_write(h, h->bed, &what);
    if (!status && h->options.outputs.picture)
        status = plot_heat(&h->options.picture, h->options.name, &what, &h->options.slice);
    if (!status) heat_report(h);
    return status;
}

static int heat_frame(void *heat, struct bed *bed) {
    struct heat *h = heat;
    int status = heat_begin(h, bed);
    if (!status) status = h->given.timed ? heat_in_time(h) : heat_once(h);
    heat_end(h);
    return status;
}

void heat_free(struct heat *h) {
    quantity_free(&h->emissivities);
    quantity_free(&h->solid);
    quantity_free(&h->time.capacity);
    quantity_free(&h->contacts.conductivity);
    curve_free(&h->contacts.gas_curve);
    curve_free(&h->given.ambient_curve);
    curve_free(&h->film.gas_curve);
    curve_free(&h->film.capacity_curve);
}

int command_heat(int argc, char **argv) {
    struct heat heat = {.options.walls.keys = HEAT_WALL_KEYS};
    int status = options_read("heat", heat_options, argc, argv, &heat);
    if (!status) status = heat_check(&heat, "heat");
    const int ended = bed_options_end(&heat.options, status, heat_help, heat_frame, &heat);
    heat_free(&heat);
    return ended;
}
