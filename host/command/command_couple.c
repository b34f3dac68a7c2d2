/* command_couple.c - `fibrad couple`: a bed in time beside another solver. SPDX-License-Identifier: MIT */
#include <string.h>

#include "command/heat_options.h"
#include "partner/partner.h"

struct couple {
    struct heat heat;              /* first, for heat_options */
    const struct partner *partner; /* NULL: not known yet */
    struct exchange exchange;
    double every;
    int ended; /* status with which the partner has ended */
};

static const struct option own_options[] = {
    {0, "precice", "FILE", "couple with preCICE, whose configuration is FILE (.xml)",
     TO_TEXT(struct couple, exchange.file)},
    {0, "participant", "NAME", "the name of this bed in the configuration of preCICE",
     TO_TEXT(struct couple, exchange.participant)},
    {0, "openfoam", "DIR",
     "couple with OpenFOAM, whose case is the folder DIR; DIR may also be the folder commsDir itself",
     TO_TEXT(struct couple, exchange.folder)},
    {0, "window", "S", "with --openfoam: length of a time window, the seconds from one exchange to the next",
     TO_NUMBER(struct couple, exchange.window, 1 / SECONDS_MAX, SECONDS_MAX)},
    {0, "faces", "WALL,...", "with --openfoam: walls whose triangles lie on its faces [all walls of triangles]",
     TO_TEXT(struct couple, exchange.wall_names)},
    {0, "timeout", "S", "longest time to wait for the other solver [600 with --openfoam, no limit with --precice]",
     TO_NUMBER(struct couple, exchange.timeout, 1e-3, SECONDS_MAX)},
    {0, "times", "every:S", "seconds from one output to the next [the end alone]",
     TO_FUNCTION(every_option, struct couple, every)}};

enum { OWN = sizeof own_options / sizeof *own_options, OPTIONS_MOST = 80 };

/* The options of this command: its own, and those of `heat` that have a meaning here. */
static const struct option *couple_options(void) {
    static const char *const left_out[] = {"until", "times", "error", "face", "frame"};
    static struct option table[OPTIONS_MOST];
    size_t n = OWN;
    memcpy(table, own_options, sizeof own_options);
    for (const struct option *option = heat_options; option->name && n < OPTIONS_MOST - 1; ++option) {
        bool left = false;
        for (size_t k = 0; k < sizeof left_out / sizeof *left_out; ++k)
            left = left || strcmp(option->name, left_out[k]) == 0;
        if (!left) table[n++] = *option;
    }
    return table;
}

static int couple_help(void) {
    static const char *more[40] = {
        "preCICE: The configuration says which meshes and data the participant has. The ends of their names, behind\n"
        "- or _, say what they are. Names of meshes end in the name of a wall of triangles, for its faces, or in\n"
        "Particles, for the spheres. Vertices are the centres of triangles or spheres, in metres. Data end in:\n"
        "  faces read        Temperature [K], or Heat-Transfer-Coefficient [W/(m2 K)] and Sink-Temperature [K]\n"
        "  faces write       Power [W], conservative; Heat-Flux [W/m2]; Temperature [K]\n"
        "  particles read    Temperature [K] of the gas; Heat-Transfer-Coefficient [else --convection]\n"
        "  particles write   Power [W] to the gas, conservative; Temperature [K]\n"
        "                    Source [W] and Conductance [W/K], conservative: a gas at T gains Source - Conductance T\n",
        "OpenFOAM: The function object externalCoupled and the boundary condition externalCoupledTemperature write\n"
        "and read the files. Each triangle of --faces lies on a face of the patch.\n\n"
        "The other solver says when the run ends. Powers are means over a time window, so both solvers count the\n"
        "same energy. The summary and --json have the energies of each time window. A wall whose faces are\n"
        "exchanged begins at its :temperature=T.\n"};
    size_t n = 2;
    for (; n < 39 && heat_more[n - 2]; ++n) more[n] = heat_more[n - 2];
    options_help(
        "couple",
        "fibrad couple FILE --precice CONFIG --participant NAME [options of fibrad heat]\n"
        "fibrad couple FILE --openfoam DIR --window S [options of fibrad heat]\n\n"
        "Finds the temperatures of a bed in time. Another solver finds those of its gas, or of what lies behind\n"
        "its walls of triangles.\n",
        couple_options(), more,
        "Examples:\n"
        "  fibrad couple bed.csv --precice precice-config.xml --participant Bed --emissivity 0.8 \\\n"
        "      --temperature 300 --ambient 300 --heat-capacity 800 --density 2500 \\\n"
        "      --wall mesh:Tube.stl:temperature=300:emissivity=0.7 -o 'bed.*.vtp' --times every:60\n");
    return STATUS_OK;
}

/* Checks what this command needs. */
static int check_couple(struct couple *c) {
    struct heat *h = &c->heat;
    struct exchange *e = &c->exchange;
    const char *missing = !e->file && !e->folder          ? "--precice or --openfoam"
                          : e->folder && !(e->window > 0) ? "--window"
                          : !h->given.temperature.given   ? "--temperature"
                          : !h->time.capacity.given       ? "--heat-capacity"
                          : !h->time.density.given        ? "--density"
                                                          : NULL;
    if (missing) return message(STATUS_USAGE, "%s is missing; see fibrad couple --help", missing);
    if (e->file && (e->folder || e->window > 0 || e->wall_names))
        return message(STATUS_USAGE, "--precice: leave out --openfoam, --window and --faces");
    if (h->options.files > 1) return message(STATUS_USAGE, "fibrad couple takes one file: its bed does not move");
    if (e->folder && e->timeout == 0) e->timeout = 600;
    c->partner = e->file ? &partner_precice : &partner_openfoam;
    const int status = c->partner->plan(e);
    if (status) return status;
    if (e->gives_gas && !e->gives_film && !h->film.coefficient.given)
        return message_at(STATUS_USAGE, e->file, 0,
                          "particles read a Temperature but no Heat-Transfer-Coefficient; --convection H gives one");
    if (e->takes_power && !e->gives_gas && !h->film.coefficient.given)
        return message_at(STATUS_USAGE, e->file, 0,
                          "particles write a power, but read no Temperature; --convection and --gas-temperature give a "
                          "gas");
    if (e->gives_film && !e->gives_gas)
        return message_at(STATUS_USAGE, e->file, 0, "particles read a Heat-Transfer-Coefficient but no Temperature");
    if (e->gives_gas && (h->film.gas.given || h->film.flux > 0))
        return message(STATUS_USAGE, "%s gives the temperature of the gas; leave out --gas-temperature and --gas-flow",
                       e->name);
    if (e->gives_gas) h->film.coefficient.given = h->film.gas.given = true, h->film.gas.value = 300 - h->given.zero;
    h->time.until = SECONDS_MAX, h->coupled = true;
    return heat_check(h, "couple");
}

static int couple_frame(void *couple, struct bed *bed) {
    struct couple *c = couple;
    int status = heat_begin(&c->heat, bed);
    if (!status) status = couple_run(&c->heat, c->partner, &c->exchange, c->every, &c->ended);
    heat_end(&c->heat);
    return status;
}

int command_couple(int argc, char **argv) {
    struct couple couple = {.heat.options.walls.keys = HEAT_WALL_KEYS};
    int status = options_read("couple", couple_options(), argc, argv, &couple);
    if (!status) status = check_couple(&couple);
    status = bed_options_end(&couple.heat.options, status, couple_help, couple_frame, &couple);
    heat_free(&couple.heat);
    if (!status) status = couple.ended;
    return couple.partner ? couple.partner->end(&couple.exchange, status) : status;
}
