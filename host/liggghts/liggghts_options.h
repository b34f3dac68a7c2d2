/* liggghts_options.h - what the driver of LIGGGHTS is asked. SPDX-License-Identifier: MIT */
#ifndef LIGGGHTS_OPTIONS_H
#define LIGGGHTS_OPTIONS_H

#include <string>
#include <vector>

#include "couple/walls/mesh_walls.h"

/* A wall that radiates. */
struct radiant_wall {
    std::string name; /* xlo ... zhi, cylinder */
    fibrad_body body;
    bool placed; /* false: it stands where the box ends */
    double temperature, emissivity;
};

/* A mesh of the script that radiates. */
struct radiant_mesh {
    std::string id; /* of its fix mesh/surface */
    mesh_sides sides;
    double temperature, emissivity; /* temperature below 0: the script's */
};

struct liggghts_options {
    const char *script = nullptr;
    const char *rows_file = nullptr; /* --write */
    std::vector<double> emissivity;  /* one for all types, or one for each */
    double surroundings = -1;        /* below 0: not given */
    std::vector<radiant_wall> walls;
    std::vector<fibrad_plane> openings; /* at NaN: where the particles end */
    std::vector<radiant_mesh> meshes;
    long every = 20, rows = 1000, steps = -1; /* steps below 0: not given */
    fibrad_insitu_config config{};
};

enum { OPTIONS_GO, OPTIONS_HELP, OPTIONS_WRONG };

/* Takes the arguments up to `--`; *rest gets the index of those behind it. OPTIONS_WRONG: *wrong says why. */
int liggghts_options_parse(int argc, char **argv, liggghts_options *options, int *rest, std::string *wrong);
void liggghts_options_help();

#endif
