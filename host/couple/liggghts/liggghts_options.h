/* liggghts_options.h - the options of the driver of LIGGGHTS. SPDX-License-Identifier: MIT */
#ifndef LIGGGHTS_OPTIONS_H
#define LIGGGHTS_OPTIONS_H

#include <string>
#include <vector>

#include "couple/simulation/radiation.h"

struct liggghts_options {
    const char *script = nullptr;
    const char *rows_file = nullptr;             /* --write */
    std::vector<double> emissivity;              /* one for all types, or one per type */
    std::vector<double> solid;                   /* the same of the conductivity of the solid; empty: infinite */
    std::vector<double> contact;                 /* the same of the solid at contacts; empty: contacts do not conduct */
    std::vector<double> film, gas;               /* likewise of heat transfer coefficients and temperatures of gas */
    std::string film_property, gas_property;     /* names of properties of particles instead; empty: none */
    int64_t every = 20, rows = 1000, steps = -1; /* steps below 0: not given */
};

enum { OPTIONS_GO, OPTIONS_HELP, OPTIONS_WRONG };

/* Reads the arguments up to `--`. *rest: index of the first argument behind `--`. OPTIONS_WRONG: *wrong says why. */
int liggghts_options_parse(int argc, char **argv, liggghts_options *options, radiation *radiation, int *rest,
                           std::string *wrong);
void liggghts_options_help();

#endif
