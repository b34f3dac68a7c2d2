/* liggghts_options.cpp - the options of the driver of LIGGGHTS. SPDX-License-Identifier: MIT */
#include "couple/liggghts/liggghts_options.h"

#include <cctype>
#include <climits>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <set>
#include <sstream>

namespace {

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

/* Reads H[,H...] T[,T...], each of which may be the name of a property. */
bool convection(const char *text, liggghts_options *o) {
    std::istringstream given(text);
    std::string word, rest;
    const auto read = [&](double high, std::vector<double> *values, std::string *property) {
        if (!(given >> word)) return false;
        if (std::isalpha((unsigned char)word[0]) == 0) return numbers(word.c_str(), 0, high, values);
        *property = word;
        return true;
    };
    return read(1e300, &o->film, &o->film_property) && read(FIBRAD_TEMPERATURE_MAX, &o->gas, &o->gas_property) &&
           !(given >> rest);
}

/* Reads K[,K...] [lens|hertz] [scale S] [gas KG] [wall KW]. */
bool contacts(const char *text, std::vector<double> *solid, radiation *r) {
    std::istringstream given(text);
    std::vector<std::string> word;
    for (std::string one; given >> one;) word.push_back(one);
    std::vector<const char *> words;
    for (const std::string &one : word) words.push_back(one.c_str());
    r->conducts = true;
    const int rest = (int)words.size() - 1;
    return rest >= 0 && numbers(words[0], 1e-300, 1e300, solid) &&
           radiation_contact_words(r, words.data() + 1, rest) == rest;
}

/* Adds walls with commas in between. The text is divided. */
const char *walls(char *text, radiation *r) {
    do {
        wall_words wall{};
        if (!wall_words_take(&wall, &text, RADIATION_KEYS, r->fault) || !radiation_add_wall(r, &wall)) return r->fault;
    } while (text != nullptr);
    return nullptr;
}

const char *const old_mesh = "is now --wall mesh:NAME:temperature=T:emissivity=E, with :both, :normals, :capacity=C";

/* Takes an option. Returns what is wrong. NULL: nothing; "": there is no such option. */
const char *take(const std::string &name, char *text, liggghts_options *o, radiation *r) {
    static const char *const steps = "is not a number of steps above 0";
    if (name == "in") return o->script = text, nullptr;
    if (name == "write") return o->rows_file = text, nullptr;
    if (name == "wall") return walls(text, r);
    if (name == "mesh") return old_mesh;
    if (name == "capacity") return "is now a word of the wall: --wall NAME:temperature=T:emissivity=E:capacity=C";
    if (name == "emissivity")
        return numbers(text, 0, 1, &o->emissivity) ? nullptr : "is not a number from 0 to 1, nor one for each type";
    if (name == "solid-conductivity")
        return numbers(text, 1e-300, 1e300, &o->solid) ? nullptr : "is not a number above 0, nor one for each type";
    if (name == "contacts")
        return contacts(text, &o->contact, r)
                   ? nullptr
                   : "is not K[,K...] [lens|hertz] [scale S] [gas KG] [wall KW], with K above 0";
    if (name == "convection")
        return convection(text, o) ? nullptr : "is not H[,H...] T[,T...], of 0 or more, or names of properties";
    if (name == "surroundings")
        return radiation_number(text, 0, FIBRAD_TEMPERATURE_MAX, &r->surroundings) ? nullptr : "is not a temperature";
    if (name == "steps") return radiation_whole(text, 0, INT64_MAX, &o->steps) ? nullptr : "is not a number of steps";
    if (name == "every") return radiation_whole(text, 1, INT_MAX, &o->every) ? nullptr : steps;
    if (name == "rows") return radiation_whole(text, 1, INT64_MAX, &o->rows) ? nullptr : steps;
    const char *wanted = radiation_option(r, name.c_str(), text);
    if (wanted == nullptr || *wanted == 0) return wanted;
    std::snprintf(r->fault, sizeof r->fault, "is not %s", wanted);
    return r->fault;
}

/* Returns what is missing or contradicts itself. "": nothing. */
std::string check(const liggghts_options *options, const radiation *r) {
    if (options->script == nullptr) return "the script is missing: -in FILE";
    if (options->emissivity.empty()) return "--emissivity is missing: one number for all types, or E1,E2... for each";
    if (std::isnan(r->surroundings)) return "--surroundings is missing, the temperature of the surroundings";
    if (options->steps < 0) return "--steps is missing, the number of steps with radiation";
    if (!options->contact.empty() && !options->solid.empty()) return "--contacts excludes --solid-conductivity";
    if (options->rows % options->every != 0) return "--rows is not a multiple of --every";
    return "";
}

} // namespace

int liggghts_options_parse(int argc, char **argv, liggghts_options *options, radiation *radiation, int *rest,
                           std::string *wrong) {
    int k = 1;
    std::set<std::string> known;
    for (; k < argc && std::strcmp(argv[k], "--") != 0; ++k) {
        std::string name = argv[k];
        if (name[0] != '-') return *wrong = "unknown argument: " + name, OPTIONS_WRONG;
        name.erase(0, name[1] == '-' ? 2 : 1);
        if (name == "help") return OPTIONS_HELP;
        static char yes[] = "yes";
        char *equals = std::strchr(argv[k], '=');
        if (equals != nullptr) name.resize(name.find('='));
        if (name != "wall" && !known.insert(name).second)
            return *wrong = "--" + name + " is given twice", OPTIONS_WRONG;
        char *text = name == "strict" ? yes : equals != nullptr ? equals + 1 : k + 1 < argc ? argv[++k] : nullptr;
        if (text == nullptr) return *wrong = "an argument is missing: --" + name, OPTIONS_WRONG;
        const std::string given = text;
        const char *fault = take(name, text, options, radiation);
        if (fault == nullptr) continue;
        *wrong = *fault == 0 ? "unknown option: --" + name
                             : "--" + name + ": " + (name == "wall" ? "" : "'" + given + "' ") + fault;
        return OPTIONS_WRONG;
    }
    *rest = k < argc ? k + 1 : k;
    *wrong = check(options, radiation);
    return wrong->empty() ? OPTIONS_GO : OPTIONS_WRONG;
}

void liggghts_options_help() {
    std::puts(
        "mpirun -np N fibrad_liggghts -in SCRIPT --emissivity E --surroundings T --steps N [options] [-- OPTIONS OF "
        "LIGGGHTS]\n\n"
        "Runs a script of LIGGGHTS that has a fix heat/gran/conduction. Then runs N further steps with radiation\n"
        "between all particles, walls and surroundings. Units are si or cgs. docs/lammps.md has an example.\n"
        "With --contacts the script has a fix transportequation/scalar instead, and contacts conduct here.\n\n"
        "  -in SCRIPT               the script; a run in the script is without radiation\n"
        "  --steps N                steps to run with radiation\n"
        "  --emissivity E[,E...]    emissivity of all particles, 0 to 1, or of each type\n"
        "  --solid-conductivity K[,K...]  conductivity of the solid of all particles, or of each type, in si\n"
        "                           W/(m K) [infinite: one temperature a particle]\n"
        "  --contacts 'K[,K...] [lens|hertz] [scale S] [gas KG] [wall KW]'  contacts conduct: conductivity K of the "
        "solid at\n"
        "                           contacts, in si W/(m K), spots as `fibrad heat --contacts` has them [lens],\n"
        "                           factor of their radii [1], conductivity of the gas in gaps [no gas], of walls\n"
        "                           [infinite]\n"
        "  --convection 'H[,H...] T[,T...]'  heat transfer coefficients to gas, in si W/(m2 K), and temperatures [K] "
        "of\n"
        "                           this gas, of all particles or of each type; or the names of properties of\n"
        "                           particles, made by fix property/atom NAME scalar [no gas]\n"
        "  --surroundings T         temperature [K] of what is seen where there is neither particle nor wall\n"
        "  --wall WALL[,WALL...]    walls, each a shape with keys: zmin:temperature=1200:emissivity=0.9.\n"
        "                           Shapes: xmin ... zmax, a plane at the fixed end of the box or at=POS; box, all\n"
        "                           six; cylinder:X,Y,R, xcylinder:Y,Z,R, ycylinder:X,Z,R; mesh:ID, the script's\n"
        "                           fix mesh/surface ID, with normals or both [sides with particles].\n"
        "                           Keys: open [at=POS, or the fixed end of the box, else where particles end],\n"
        "                           temperature=T [of a mesh: the script's], insulated, emissivity=E [1],\n"
        "                           capacity=C: the temperature follows the heat that the wall gets, C in si J/K\n"
        "  --every N                compute powers every N steps [20]\n"
        "  --rows N                 make all rows, the exchange factors, every N steps; N is a multiple of --every\n"
        "                           [1000]\n"
        "  --cutoff R               particles with centres farther apart than R do not see each other [none up\n"
        "                           to 4e6 particles; then it follows from their number]\n"
        "  --accuracy WORD          low, normal or high: directions and paths of each row, docs/lammps.md [normal]\n"
        "  --tolerance E            error allowed in each row, estimated, 0 to 1 [none]\n"
        "  --seed S                 seed of paths and directions [0]\n"
        "  --threads N              threads of each rank, for the rows [1]\n"
        "  --strict                 end the run when a centre lies inside another particle or beyond a wall\n"
        "  --write NAME             write the last rows to NAME.RANK.rows, for fibrad join\n");
}
