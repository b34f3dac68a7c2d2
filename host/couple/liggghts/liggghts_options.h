/* liggghts_options.h - the options of the driver of LIGGGHTS. SPDX-License-Identifier: MIT */
#ifndef LIGGGHTS_OPTIONS_H
#define LIGGGHTS_OPTIONS_H

#include <string>
#include <vector>

#include "couple/walls/mesh_walls.h"
#include "couple/walls/wall_heat.h"

/* A wall that radiates. */
struct radiant_wall {
    std::string name; /* xlo ... zhi, cylinder, xcylinder, ycylinder */
    fibrad_wall wall;
    bool placed; /* the option gives the coordinate; else the wall is at the end of the box */
    double temperature, emissivity;
};

/* A mesh of the script that radiates. */
struct radiant_mesh {
    std::string id; /* ID of its fix mesh/surface */
    mesh_sides sides;
    double temperature, emissivity; /* temperature below 0: that of the script */
};

/* The heat capacity of a wall or mesh. */
struct wall_capacity {
    std::string name;
    double capacity;
};

struct liggghts_options {
    const char *script = nullptr;
    const char *rows_file = nullptr; /* --write */
    std::vector<double> emissivity;  /* one for all types, or one per type */
    std::vector<double> solid;       /* the same of the conductivity of the solid; empty: infinite */
    std::vector<double> contact;     /* the same of the solid at contacts; empty: contacts do not conduct */
    fibrad_insitu_contacts spots{};  /* the rest of --contacts */
    double surroundings = -1;        /* below 0: not given */
    std::vector<radiant_wall> walls;
    std::vector<fibrad_plane> openings; /* at NaN: at the end of the particles */
    std::vector<radiant_mesh> meshes;
    std::vector<wall_capacity> capacities;
    bool accuracy = false;                    /* --accuracy is given */
    long every = 20, rows = 1000, steps = -1; /* steps below 0: not given */
    fibrad_insitu_config config{};
};

enum { OPTIONS_GO, OPTIONS_HELP, OPTIONS_WRONG };

/* Reads the arguments up to `--`. *rest: index of the first argument behind `--`. OPTIONS_WRONG: *wrong says why. */
int liggghts_options_parse(int argc, char **argv, liggghts_options *options, int *rest, std::string *wrong);
void liggghts_options_help();

#endif
