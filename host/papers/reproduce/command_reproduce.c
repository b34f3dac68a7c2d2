/* command_reproduce.c - `fibrad reproduce`: our numbers beside those of the papers. SPDX-License-Identifier: MIT */
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "cli/message.h"
#include "cli/options.h"
#include "cli/progress.h"
#include "command/commands.h"
#include "papers/reproduce/reproduce.h"

static const struct {
    const char *name, *what;
    experiment *run;
} experiments[] = {
    {"fig3", "error of the surface method against the gap, with nothing in between", reproduce_fig3},
    {"fig4", "equal spheres: the exact factor and other formulas", reproduce_fig4},
    {"fig7-9", "two spheres, and a third one that touches both", reproduce_third_sphere},
    {"fig10", "face-centred cubic beds: sum of the factors against distance", reproduce_fig10},
    {"table1", "time for all factors of random beds", reproduce_table1},
    {"pebble-pair", "two pebbles: where the radiation that one receives arrives", reproduce_pebble_pair},
    {"pebble-rays", "two pebbles by rays: factor, ray length, angle, error, and rays for 1 %", reproduce_pebble_rays},
    {"pebble-bed", "random bed of pebbles: factors within 2 and 3 diameters", reproduce_pebble_bed},
    {"conductivity", "grey spheres: exchange factor F_E of a random bed and of lattices", reproduce_conductivity},
    {"correlations", "grey spheres: F_E of random beds beside correlations that reactor codes use",
     reproduce_correlations},
};
enum { EXPERIMENTS = sizeof experiments / sizeof *experiments };

struct reproduce_request {
    const char *directory; /* for files; NULL: no files are written */
    int only;              /* number of the experiment; -1: all */
};

static int take_experiment(const char *name, void *only) {
    int k = EXPERIMENTS - 1;
    while (k >= 0 && strcmp(experiments[k].name, name) != 0) --k;
    *(int *)only = k;
    return k >= 0 ? STATUS_OK : message(STATUS_USAGE, "no experiment %.40s; see fibrad reproduce --help", name);
}

static const struct option reproduce_table[] = {
    {'o', "output", "DIR", "write CSV files into this folder [none]", TO_PATH(struct reproduce_request, directory)},
    {0, "only", "NAME", "run this experiment only [all]", TO_FUNCTION(take_experiment, struct reproduce_request, only)},
    {OPTION_HELP},
    {.name = NULL}};

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

/* Opens NAME.csv in the folder. directory NULL: nothing is kept. */
static int open_csv(struct output *output, char path[PATH_MAX], const char *directory, const char *name) {
    const int length = snprintf(path, PATH_MAX, directory ? "%s/%s.csv" : "/dev/null", directory, name);
    if (length >= PATH_MAX) return message_at(STATUS_FILE, directory, 0, "the name is too long");
    return output_open(output, path);
}

static int run_experiment(struct reproduce *reproduce, int which, const char *directory) {
    const char *name = experiments[which].name;
    struct output data = {0};
    char path[PATH_MAX];
    int status = open_csv(&data, path, directory, name);
    if (status) return status;
    reproduce->experiment = name, reproduce->data = data.file;
    printf("\n%s: %s\n", name, experiments[which].what);
    const double begun = progress_clock();
    status = experiments[which].run(reproduce);
    fflush(stdout); /* so that lines stay whole where both go to one file */
    fprintf(stderr, "%s: %.1f s\n", name, progress_clock() - begun);
    return output_close(&data, status ? status : interrupt_status());
}

int command_reproduce(int argc, char **argv) {
    struct reproduce_request request = {.only = -1};
    int status = options_read("reproduce", reproduce_table, argc, argv, &request);
    if (status) return status == STATUS_HELP ? reproduce_help() : status;
    struct reproduce reproduce = {.data = NULL};
    char path[PATH_MAX];
    if (request.directory && mkdir(request.directory, 0777) != 0 && errno != EEXIST)
        return message_at(STATUS_FILE, request.directory, 0, "%s", strerror(errno));
    status = open_csv(&reproduce.comparison, path, request.directory, "comparison");
    if (status) return status;
    fputs("experiment,what,source,unit,theirs,ours,difference_percent_or_points\n", reproduce.comparison.file);
    printf("%-12s %-70s %-5s %12s %12s     %s\n", "experiment", "what", "from", "theirs", "ours", "difference");
    for (int k = 0; k < EXPERIMENTS && !status; ++k)
        if (request.only < 0 || request.only == k) status = run_experiment(&reproduce, k, request.directory);
    return output_close(&reproduce.comparison, status);
}
