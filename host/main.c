/* main.c - the program `fibrad`: chooses the command. SPDX-License-Identifier: MIT */
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "cli/message.h"
#include "cli/spelling.h"
#include "command/commands.h"
#include "fibrad.h"

static const struct {
    const char *name, *purpose;
    int (*run)(int argc, char **argv);
} commands[] = {
    {"conductivity", "effective radiative conductivity of a bed of grey spheres", command_conductivity},
    {"couple", "a bed in time beside another solver, by preCICE or OpenFOAM", command_couple},
    {"factors", "view factors or exchange factors of all spheres of a file", command_factors},
    {"furnace", "temperatures in a box with a medium that absorbs, emits and scatters", command_furnace},
    {"heat", "net radiative powers of grey spheres and walls", command_heat},
    {"join", "one matrix of the rows that the ranks of a simulation wrote", command_join},
    {"pair", "view factor between two spheres, with or without others in between", command_pair},
    {"reproduce", "our numbers beside those of the papers", command_reproduce},
};

enum { COMMANDS = sizeof commands / sizeof *commands };

static int main_help(void) {
    printf("fibrad %s - view factors for thermal radiation between spheres\n\nCommands:\n", fibrad_version());
    for (size_t k = 0; k < COMMANDS; ++k) printf("  %-12s %s\n", commands[k].name, commands[k].purpose);
    puts("\nfibrad COMMAND --help   what most people need of a command; --help all: everything\n"
         "fibrad help COMMAND     the same\n"
         "fibrad -V, --version    version and instruction set in use\n\n"
         "Exit status: 0 success, 2 bad usage, 3 bad input, 4 trouble with a file, 5 out of memory, 128 + signal.");
    return STATUS_OK;
}

static int main_version(void) {
    printf("fibrad %s (%s)\n", fibrad_version(), fibrad_isa_name((int)fibrad_isa_best()));
    return STATUS_OK;
}

static int main_unknown(const char *name) {
    const char *names[COMMANDS];
    char hint[HINT_ROOM];
    if (strcmp(name, "bed") == 0) return message(STATUS_USAGE, "fibrad bed is now fibrad factors");
    if (strcmp(name, "exchange") == 0)
        return message(STATUS_USAGE, "fibrad exchange is now fibrad factors, with --emissivity");
    for (size_t k = 0; k < COMMANDS; ++k) names[k] = commands[k].name;
    name_hint(hint, "", name, strlen(name), names, COMMANDS);
    return message(STATUS_USAGE, "unknown %s %.40s%s see fibrad --help", *name == '-' ? "option" : "command", name,
                   hint);
}

static int main_choose(int argc, char **argv) {
    const char *name = argc > 1 ? argv[1] : "";
    if (strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0) return main_help();
    if (strcmp(name, "--version") == 0 || strcmp(name, "-V") == 0) return main_version();
    if (strcmp(name, "help") == 0 && argc == 2) return main_help();
    if (strcmp(name, "help") == 0) { /* `help COMMAND all` is `COMMAND --help all` */
        char help[] = "--help";
        return main_choose(argc > 3 ? 4 : 3, (char *[]){argv[0], argv[2], help, argc > 3 ? argv[3] : NULL, NULL});
    }
    for (size_t k = 0; k < COMMANDS; ++k)
        if (strcmp(name, commands[k].name) == 0) {
            interrupt_catch();
            return commands[k].run(argc - 2, argv + 2);
        }
    if (*name == 0) return message(STATUS_USAGE, "the command is missing; see fibrad --help");
    return main_unknown(name);
}

int main(int argc, char **argv) {
    int status = main_choose(argc, argv);
    if (status > STATUS_SIGNAL) message(status, "interrupted");
    if ((ferror(stdout) || fclose(stdout) != 0) && !status)
        status = message(STATUS_FILE, "standard output: %s", strerror(errno));
    return status;
}
