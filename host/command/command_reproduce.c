/* command_reproduce.c - `fibrad reproduce`: our numbers beside those of the papers. SPDX-License-Identifier: MIT */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "cli/interrupt.h"
#include "cli/message.h"
#include "cli/options.h"
#include "cli/progress.h"
#include "command/commands.h"
#include "reproduce/reproduce.h"

enum { KEY_ONLY = KEY_OWN, KEY_NO_PLOTS };

static const struct option reproduce_table[] = {
    {'o', "output", "DIR", "write CSV files and plots into this folder [none]"},
    {KEY_ONLY, "only", "NAME", "run this experiment only [all]"},
    {KEY_NO_PLOTS, "no-plots", NULL, "write CSV files only [off]"},
    {OPTION_HELP},
    {0, NULL, NULL, NULL}};

static const struct {
    const char *name, *what;
    experiment *run;
} experiments[] = {
    {"fig3", "error of the surface method against the gap, with nothing in between", reproduce_fig3},
    {"fig4", "equal spheres: the exact factor and other formulas", reproduce_fig4},
    {"fig7-9", "two spheres, and a third one that touches both", reproduce_third_sphere},
    {"fig10", "face-centred cubic beds: sum of the factors against distance", reproduce_fig10},
    {"table1", "time for all factors of random beds", reproduce_table1},
    {"pebble-pair", "two pebbles: factor, ray length, angle, received radiation", reproduce_pebble_pair},
    {"pebble-rays", "two pebbles by rays: error, and rays for 1 %", reproduce_pebble_rays},
    {"pebble-bed", "random bed of pebbles: factors within 2 and 3 diameters", reproduce_pebble_bed},
    {"conductivity", "grey spheres: exchange factor F_E of a random bed and of lattices", reproduce_conductivity},
    {"correlations", "grey spheres: F_E of random beds beside correlations that reactor codes use",
     reproduce_correlations},
    {"conducting", "spheres that conduct: F_E against k*", reproduce_conducting},
    {"exchange", "grey spheres: exchange factor against the distance of the centres", reproduce_exchange},
    {"exchange-wall", "grey spheres: exchange factor to a wall against distance", reproduce_exchange_wall},
    {"faces", "grey spheres: emissivity and absorptance of the face of a bed", reproduce_faces},
};
enum { EXPERIMENTS = sizeof experiments / sizeof *experiments };

static int reproduce_help(void) {
    puts("fibrad reproduce [options]\n\n"
         "Computes the tables and figures of the papers that the methods come from, on one thread. Prints our numbers\n"
         "beside those that were published (paper) or computed independently by the papers' methods (check).\n");
    options_print(reproduce_table);
    puts("\nExperiments:");
    for (int k = 0; k < EXPERIMENTS; ++k) printf("  %-13s %s\n", experiments[k].name, experiments[k].what);
    puts("\nExamples:\n"
         "  fibrad reproduce\n"
         "  fibrad reproduce --only fig3 -o figures");
    return STATUS_OK;
}

static int run_experiment(struct reproduce *reproduce, int which) {
    reproduce->experiment = experiments[which].name;
    reproduce->data = open_memstream(&reproduce->text, &reproduce->length);
    if (!reproduce->data) return message_memory();
    printf("\n%s: %s\n", experiments[which].name, experiments[which].what);
    const double begun = progress_clock();
    int status = experiments[which].run(reproduce);
    fprintf(stderr, "%s: %.1f s\n", experiments[which].name, progress_clock() - begun);
    fclose(reproduce->data);
    free(reproduce->text);
    return status ? status : interrupt_status();
}

static int open_directory(struct reproduce *reproduce, char **path) {
    if (!reproduce->directory) return STATUS_OK;
    if (mkdir(reproduce->directory, 0777) != 0 && errno != EEXIST)
        return message_at(STATUS_FILE, reproduce->directory, 0, "%s", strerror(errno));
    *path = reproduce_path(reproduce, "comparison", ".csv");
    if (!*path) return message_memory();
    const int status = output_open(&reproduce->comparison, *path);
    if (!status)
        fputs("experiment,what,source,unit,theirs,ours,difference_percent_or_points\n", reproduce->comparison.file);
    return status;
}

int command_reproduce(int argc, char **argv) {
    struct options options = {.command = "reproduce", .table = reproduce_table, .argc = argc, .argv = argv};
    struct reproduce reproduce = {.plots = true};
    int only = -1;
    for (int key; (key = options_next(&options)) != OPTIONS_END;) switch (key) {
        case 'o':
            reproduce.directory = options.value;
            break;
        case KEY_HELP:
            return reproduce_help();
        case KEY_NO_PLOTS:
            reproduce.plots = false;
            break;
        case KEY_ONLY:
            for (only = EXPERIMENTS - 1; only >= 0 && strcmp(experiments[only].name, options.value) != 0;) --only;
            if (only < 0)
                return message(STATUS_USAGE, "no experiment %.40s; see fibrad reproduce --help", options.value);
            break;
        case OPTIONS_BAD:
            return STATUS_USAGE;
        default:
            return message(STATUS_USAGE, "'%.40s': reproduce takes options only", options.value);
        }

    char *path = NULL;
    int status = open_directory(&reproduce, &path);
    if (!status)
        printf("%-12s %-70s %-5s %12s %12s     %s\n", "experiment", "what", "from", "theirs", "ours", "difference");
    for (int k = 0; k < EXPERIMENTS && !status; ++k)
        if (only < 0 || only == k) status = run_experiment(&reproduce, k);
    status = output_close(&reproduce.comparison, status);
    free(path);
    return status;
}
