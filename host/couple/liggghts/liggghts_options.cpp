/* liggghts_options.cpp - the options of the driver of LIGGGHTS. SPDX-License-Identifier: MIT */
#include "couple/liggghts/liggghts_options.h"
#include "couple/walls/settings.h"

#include <getopt.h>

#include <algorithm>
#include <climits>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sstream>

namespace {

enum { SETTING = 1 }; /* an option of rows, see settings.h */

const struct option names[] = {{"in", required_argument, nullptr, 'i'},
                               {"emissivity", required_argument, nullptr, 'e'},
                               {"solid-conductivity", required_argument, nullptr, 'k'},
                               {"contacts", required_argument, nullptr, 'K'},
                               {"surroundings", required_argument, nullptr, 'T'},
                               {"wall", required_argument, nullptr, 'w'},
                               {"mesh", required_argument, nullptr, 'm'},
                               {"capacity", required_argument, nullptr, 'C'},
                               {"steps", required_argument, nullptr, 's'},
                               {"every", required_argument, nullptr, 'E'},
                               {"rows", required_argument, nullptr, 'R'},
                               {"cutoff", required_argument, nullptr, SETTING},
                               {"gather", required_argument, nullptr, SETTING},
                               {"accuracy", required_argument, nullptr, SETTING},
                               {"tolerance", required_argument, nullptr, SETTING},
                               {"seed", required_argument, nullptr, SETTING},
                               {"write", required_argument, nullptr, 'W'},
                               {"strict", no_argument, nullptr, 'x'},
                               {"help", no_argument, nullptr, 'h'},
                               {nullptr, 0, nullptr, 0}};

/* Reads numbers from low to high with commas in between. */
bool numbers(const char *text, double low, double high, std::vector<double> *values) {
    values->clear();
    for (const char *at = text;; ++at) {
        char *end;
        const double value = std::strtod(at, &end);
        if (end == at || !(value >= low && value <= high)) return false;
        values->push_back(value);
        if (*end == 0) return true;
        if (*end != ',') return false;
        at = end;
    }
}

const char *const sides[] = {"xlo", "xhi", "ylo", "yhi", "zlo", "zhi"};
const char *const cylinders[] = {"xcylinder", "ycylinder", "cylinder"}; /* by fibrad_wall.cylinder.along */

/* Reads SIDE=open or SIDE=open,AT. */
bool opening(const char *text, fibrad_plane *plane) {
    std::vector<double> at = {NAN};
    for (int side = 0; side < 6; ++side) {
        const std::string begin = std::string(sides[side]) + "=open";
        if (begin.compare(0, begin.size(), text, std::min(std::strlen(text), begin.size())) != 0) continue;
        text += begin.size();
        if (*text != 0 &&
            (*text != ',' || !numbers(text + 1, -FIBRAD_LENGTH_MAX, FIBRAD_LENGTH_MAX, &at) || at.size() != 1))
            return false;
        *plane = {side / 2, side % 2, at[0]};
        return true;
    }
    return false;
}

/* Reads SIDE=T,E[,AT], or one of xcylinder=T,E,Y,Z,R, ycylinder=T,E,X,Z,R and cylinder=T,E,X,Y,R. Returns what is
 * wrong. NULL: nothing. */
const char *wall(const char *text, radiant_wall *wall) {
    const char *equals = std::strchr(text, '=');
    std::vector<double> values;
    wall->name.assign(text, equals != nullptr ? equals : text + std::strlen(text));
    const int along = (int)(std::find(cylinders, cylinders + 3, wall->name) - cylinders);
    const int side = (int)(std::find(sides, sides + 6, wall->name) - sides);
    if (along == 3 && side == 6)
        return "is none of SIDE=T,E[,AT], SIDE=open[,AT], cylinder=T,E,X,Y,R, xcylinder=T,E,Y,Z,R and "
               "ycylinder=T,E,X,Z,R, with SIDE from xlo to zhi";
    if (equals == nullptr || !numbers(equals + 1, -FIBRAD_LENGTH_MAX, FIBRAD_LENGTH_MAX, &values))
        return "has neither numbers behind =, with commas in between, nor the word open";
    if (along < 3 && values.size() != 5) return "does not have five numbers: T, E, the position on two axes, and R";
    if (side < 6 && values.size() < 2) return "has too few numbers: a temperature and an emissivity are needed";
    if (side < 6 && values.size() > 3) return "has too many numbers: they are T,E or T,E,AT";
    wall->temperature = values[0];
    wall->emissivity = values[1];
    wall->placed = values.size() > 2;
    wall->wall = fibrad_wall{};
    if (!(wall->temperature >= 0)) return "has a temperature below 0";
    if (!(wall->emissivity >= 0 && wall->emissivity <= 1)) return "has an emissivity that is not within 0 and 1";
    if (side < 6) {
        wall->wall.kind = FIBRAD_WALL_PLANE;
        wall->wall.plane = {side / 2, side % 2, wall->placed ? values[2] : 0};
        return nullptr;
    }
    if (!(values[4] > 0)) return "has a radius that is not above 0";
    wall->wall.kind = FIBRAD_WALL_CYLINDER;
    wall->wall.cylinder = {values[2], values[3], values[4], along};
    return nullptr;
}

/* Reads ID=E or ID=T,E, which :both or :normals may follow. */
bool mesh(const char *text, radiant_mesh *mesh) {
    const char *equals = std::strchr(text, '=');
    std::vector<double> values;
    if (equals == nullptr || equals == text) return false;
    const char *colon = std::strchr(equals, ':');
    const std::string given(equals + 1, colon != nullptr ? colon : equals + std::strlen(equals));
    if (!numbers(given.c_str(), 0, 1e9, &values) || values.size() > 2 || values.back() > 1) return false;
    mesh->id.assign(text, equals);
    mesh->temperature = values.size() == 2 ? values[0] : -1;
    mesh->emissivity = values.back();
    mesh->sides = colon == nullptr ? SIDES_AUTO : std::strcmp(colon, ":both") == 0 ? SIDES_BOTH : SIDES_NORMALS;
    return mesh->sides != SIDES_NORMALS || std::strcmp(colon, ":normals") == 0;
}

/* Reads NAME=C. */
bool capacity(const char *text, wall_capacity *capacity) {
    const char *equals = std::strchr(text, '=');
    if (equals == nullptr || equals == text) return false;
    capacity->name.assign(text, equals);
    return setting_number(equals + 1, 1e-300, 1e300, &capacity->capacity);
}

/* Reads K[,K...] [lens|hertz] [scale S] [gas KG]. */
bool contacts(const char *text, std::vector<double> *solid, fibrad_insitu_contacts *spots) {
    std::istringstream words(text);
    std::string word, value;
    if (!(words >> word) || !numbers(word.c_str(), 1e-300, 1e300, solid)) return false;
    while (words >> word) {
        const contact_setting *setting = contact_named(word);
        if (setting == nullptr) return false;
        if (setting->number == nullptr)
            spots->hertz = setting->hertz;
        else if (!(words >> value) || !setting_number(value, setting->low, setting->high, &(spots->*setting->number)))
            return false;
    }
    return true;
}

/* Takes the argument of an option. Returns what is wrong with the argument. NULL: nothing. */
const char *take(int key, const char *text, liggghts_options *options) {
    radiant_wall one;
    fibrad_plane open;
    radiant_mesh triangles;
    wall_capacity heat;
    switch (key) {
    case 'x':
        options->config.strict = 1;
        return nullptr;
    case 'i':
        options->script = text;
        return nullptr;
    case 'W':
        options->rows_file = text;
        return nullptr;
    case 'e':
        return numbers(text, 0, 1, &options->emissivity) ? nullptr
                                                         : "is not a number from 0 to 1, nor one for each type";
    case 'k':
        return numbers(text, 1e-300, 1e300, &options->solid) ? nullptr
                                                             : "is not a number above 0, nor one for each type";
    case 'K':
        return contacts(text, &options->contact, &options->spots)
                   ? nullptr
                   : "is not K[,K...] [lens|hertz] [scale S] [gas KG], with K above 0";
    case 'T':
        return setting_number(text, 0, 1e9, &options->surroundings) ? nullptr : "is not a temperature";
    case 'w':
        if (opening(text, &open)) {
            options->openings.push_back(open);
            return nullptr;
        }
        if (const char *fault = wall(text, &one)) return fault;
        options->walls.push_back(one);
        return nullptr;
    case 'm':
        if (!mesh(text, &triangles)) return "is neither ID=E nor ID=T,E, which :both or :normals may follow";
        for (const radiant_mesh &other : options->meshes)
            if (other.id == triangles.id) return "is of a mesh that was named already";
        options->meshes.push_back(triangles);
        return nullptr;
    case 'C':
        if (!capacity(text, &heat)) return "is not NAME=C, with a name of a wall or mesh and C above 0";
        options->capacities.push_back(heat);
        return nullptr;
    case 's':
        return setting_whole(text, 0, LONG_MAX, &options->steps) ? nullptr : "is not a number of steps";
    case 'E':
        return setting_whole(text, 1, LONG_MAX, &options->every) ? nullptr : "is not a number of steps above 0";
    case 'R':
        return setting_whole(text, 1, LONG_MAX, &options->rows) ? nullptr : "is not a number of steps above 0";
    default:
        return nullptr;
    }
}

/* Whether a wall or mesh has this name. */
bool named(const liggghts_options *options, const std::string &name) {
    const auto wall = [&name](const radiant_wall &w) { return w.name == name; };
    const auto mesh = [&name](const radiant_mesh &m) { return m.id == name; };
    return std::any_of(options->walls.begin(), options->walls.end(), wall) ||
           std::any_of(options->meshes.begin(), options->meshes.end(), mesh);
}

/* Returns what is missing or contradicts itself. "": nothing. */
std::string check(const liggghts_options *options) {
    if (options->script == nullptr) return "the script is missing: -in FILE";
    if (options->emissivity.empty()) return "--emissivity is missing: one number for all types, or E1,E2... for each";
    if (options->surroundings < 0) return "--surroundings is missing, the temperature of the surroundings";
    if (options->steps < 0) return "--steps is missing, the number of steps with radiation";
    if (options->accuracy && options->config.tolerance > 0) return "--accuracy excludes --tolerance";
    if (!options->contact.empty() && !options->solid.empty()) return "--contacts excludes --solid-conductivity";
    if (options->rows % options->every != 0) return "--rows is not a multiple of --every";
    if (options->walls.size() + options->meshes.size() > FIBRAD_WALLS_MAX) return "there are too many walls and meshes";
    for (const wall_capacity &given : options->capacities)
        if (!named(options, given.name)) return "--capacity " + given.name + ": no --wall or --mesh has this name";
    return "";
}

} // namespace

int liggghts_options_parse(int argc, char **argv, liggghts_options *options, int *rest, std::string *wrong) {
    int key, index = 0;
    opterr = 0;
    while ((key = getopt_long_only(argc, argv, "+:", names, &index)) != -1) {
        if (key == 'h') return OPTIONS_HELP;
        if (key == '?' || key == ':') {
            *wrong = std::string(key == ':' ? "an argument is missing: " : "unknown option: ") + argv[optind - 1];
            return OPTIONS_WRONG;
        }
        const radiation_setting *setting = key == SETTING ? setting_named(names[index].name) : nullptr;
        const char *fault = take(key, optarg, options);
        if (setting != nullptr && !setting_take(*setting, optarg, &options->config)) fault = setting->wanted;
        options->accuracy |= setting != nullptr && std::strcmp(setting->name, "accuracy") == 0;
        if (fault == nullptr) continue;
        *wrong = std::string("--") + names[index].name + ": '" + optarg + "' " + (setting != nullptr ? "is not " : "") +
                 fault;
        return OPTIONS_WRONG;
    }
    if (optind < argc && std::strcmp(argv[optind - 1], "--") != 0) {
        *wrong = std::string("unknown argument: ") + argv[optind];
        return OPTIONS_WRONG;
    }
    *rest = optind;
    *wrong = check(options);
    return wrong->empty() ? OPTIONS_GO : OPTIONS_WRONG;
}

void liggghts_options_help() {
    std::puts(
        "mpirun -np N fibrad_liggghts -in SCRIPT --emissivity E --surroundings T --steps N [options] [-- OPTIONS OF "
        "LIGGGHTS]\n\n"
        "Runs a script of LIGGGHTS that has a fix heat/gran/conduction. Then runs N further steps with radiation\n"
        "between all particles, walls and surroundings. Units are si or cgs. docs/liggghts.md has an example.\n"
        "With --contacts the script has a fix transportequation/scalar instead, and contacts conduct here.\n\n"
        "  -in SCRIPT               the script; a run in the script is without radiation\n"
        "  --steps N                steps to run with radiation\n"
        "  --emissivity E[,E...]    emissivity of all particles, 0 to 1, or of each type\n"
        "  --solid-conductivity K[,K...]  conductivity of the solid of all particles, or of each type, in si\n"
        "                           W/(m K) [infinite: one temperature a particle]\n"
        "  --contacts 'K[,K...] [lens|hertz] [scale S] [gas KG]'  contacts conduct: conductivity K of the solid at\n"
        "                           contacts, in si W/(m K), spots as `fibrad heat --contacts` has them [lens], "
        "factor\n"
        "                           of their radii [1], conductivity of the gas in gaps [no gas]\n"
        "  --surroundings T         temperature [K] of what is seen where there is neither particle nor wall\n"
        "  --wall SIDE=T,E[,AT]     a plane that radiates: side xlo ... zhi, temperature [K], emissivity, place\n"
        "                           [fixed end of the box]\n"
        "  --wall SIDE=open[,AT]    an opening: the container ends there and the surroundings begin [where the\n"
        "                           particles end]\n"
        "  --wall cylinder=T,E,X,Y,R  a cylinder of radius R about the axis along z through X,Y; along the other axes\n"
        "                           xcylinder=T,E,Y,Z,R and ycylinder=T,E,X,Z,R\n"
        "  --mesh ID=[T,]E          the script's fix mesh/surface ID radiates: temperature [K] [the script's],\n"
        "                           emissivity. The sides that particles are on belong to the wall. ID=[T,]E:both\n"
        "                           makes both sides the wall, ID=[T,]E:normals the outer sides of the file\n"
        "  --capacity NAME=C        heat capacity of the --wall or --mesh NAME, in si J/K. Its temperature then\n"
        "                           follows the radiation that it gets [its temperature stays]\n"
        "  --every N                compute powers every N steps [20]\n"
        "  --rows N                 make all rows, the exchange factors, every N steps; N is a multiple of --every\n"
        "                           [1000]\n"
        "  --cutoff R               particles with centres farther apart than R do not see each other [none up\n"
        "                           to --gather particles; then it follows from their number]\n"
        "  --gather N               up to N particles each rank has all while rows are made, so that no cutoff is\n"
        "                           needed [4000000]\n"
        "  --accuracy WORD          low, normal or high: directions and paths of each row, docs/lammps.md [normal]\n"
        "  --tolerance E            error allowed in each row, estimated, 0 to 1 [none]\n"
        "  --seed S                 seed of paths and directions [0]\n"
        "  --strict                 end the run when a centre lies inside another particle or beyond a wall\n"
        "  --write NAME             write the last rows to NAME.RANK.rows, for fibrad join\n");
}
