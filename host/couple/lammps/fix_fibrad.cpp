/* fix_fibrad.cpp - thermal radiation in LAMMPS: reads the command, hands particles to fibrad_insitu, applies powers.
 * SPDX-License-Identifier: MIT. LAMMPS is GPL-2: so are binaries made with its headers. */
#include "fix_fibrad.h"

#include "comm.h"
#include "domain.h"
#include "error.h"
#include "force.h"
#include "group.h"
#include "input.h"
#include "modify.h"
#include "pair.h"
#include "update.h"
#include "variable.h"

extern "C" {
#include "cli/message.h"
}

#include <algorithm>
#include <climits>
#include <cmath>
#include <cstdarg>
#include <cstring>

using namespace LAMMPS_NS;

// Formats a text like printf. The format library of LAMMPS differs from version to version.
__attribute__((format(printf, 1, 2))) static std::string text(const char *format, ...) {
    char buffer[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(buffer, sizeof buffer, format, arguments);
    va_end(arguments);
    return buffer;
}

static bool is_number(const std::string &word) {
    char *end;
    strtod(word.c_str(), &end);
    return !word.empty() && !*end;
}

// ---- the command ------------------------------------------------------------------------------------------------

// A walk along the words of the command behind the style.
class FixFibrad::Words {
  public:
    Words(LAMMPS *lammps, int count, char **word) : lmp(lammps), words(word + 2, word + count) {}
    bool more() const { return at < words.size(); }
    bool next_is(const char *word) const { return more() && words[at] == word; }
    // Whether the next word is this one. If so, moves behind it.
    bool take(const char *word) {
        const bool is = next_is(word);
        at += is;
        return is;
    }
    std::string next() {
        if (!more()) lmp->error->all(FLERR, "fix fibrad: a word is missing after `" + words.back() + "`");
        return words[at++];
    }
    // Takes a number from low to high.
    double number(const std::string &what, double low, double high) {
        double value;
        const std::string before = words[at - 1], word = more() ? next() : std::string();
        if (setting_number(word, low, high, &value)) return value;
        if (word.empty()) lmp->error->all(FLERR, "fix fibrad: " + what + " is missing after `" + before + "`");
        if (!is_number(word))
            lmp->error->all(FLERR,
                            "fix fibrad: " + what + " must be a number, not `" + word + "`: is a value missing?");
        const std::string bounds = low > 0 && high >= 1e300 ? "above 0" : text("in [%g, %g]", low, high);
        lmp->error->all(FLERR, "fix fibrad: " + what + " must be " + bounds + ", not " + word);
        return value;
    }
    std::string peek() const { return more() ? words[at] : ""; }
    bool next_is_number() const { return more() && is_number(words[at]); }
    bool next_begins(const char *with) const { return more() && words[at].compare(0, 2, with) == 0; }
    int count(const char *what, int low) {
        int value;
        const std::string word = next();
        if (!setting_whole(word, low, INT_MAX, &value))
            lmp->error->all(FLERR,
                            text("fix fibrad: %s must be a whole number, at least %d, not `", what, low) + word + "`");
        return value;
    }

    bool yes_or_no() {
        const std::string word = next();
        if (word != "yes" && word != "no") lmp->error->all(FLERR, "fix fibrad: say yes or no, not `" + word + "`");
        return word == "yes";
    }

  private:
    LAMMPS *lmp;
    std::vector<std::string> words;
    size_t at = 1;
};

FixFibrad::FixFibrad(LAMMPS *lammps, int narg, char **arg)
    : Fix(lammps, narg, arg), spots(), temperature(), kept_bit(0), surroundings{-1, ""}, parts(false), errors(false),
      columns(1), moved(0), sampling(false), accuracy(false), sigma(0), initial(0), config(), meshes(), moving(false),
      insitu(nullptr), totals(), conducted(), warned(false), wall_warned(false), told(), set_up(-1), powers_at(0),
      lost(0), restarted(false), begun(0), before(), rows_made(0), rows_followed(0), powers_found(0) {
    const double huge = 1e300;
    Words words(lmp, narg, arg);
    config.seed = 1; // the default of docs/lammps.md
    heat_every = words.count("NEVERY", 0);
    rows_every = words.count("NROWS", 1);
    if (heat_every && rows_every % heat_every)
        error->all(FLERR, std::string("fix fibrad: NROWS must be a multiple of NEVERY"));

    while (words.more()) {
        const std::string key = words.next();
        if (key == "emissivity")
            emissivity = read_property(words, "the emissivity", 0, 1);
        else if (key == "cp")
            cp = read_property(words, "the heat capacity", 1e-300, huge);
        else if (key == "solid")
            solid = read_property(words, "the conductivity of the solid", 1e-300, huge);
        else if (key == "contacts")
            read_contacts(words);
        else if (key == "surroundings")
            surroundings = read_kelvins(words, "the temperature of the surroundings");
        else if (key == "wall")
            read_wall(words);
        else if (key == "temperature")
            read_temperature(words);
        else if (key == "group2")
            read_group(words);
        else if (key == "initial")
            initial = words.number("the initial temperature", 0, huge);
        else if (setting_named(key))
            read_setting(words, *setting_named(key));
        else if (key == "sigma")
            sigma = words.number("sigma", 0, huge);
        else if (key == "rows")
            rows_file = words.next();
        else if (key == "parts")
            parts = words.yes_or_no();
        else if (key == "errors")
            errors = words.yes_or_no();
        else if (key == "moved")
            moved = words.number("the distance that particles may move", 0, huge);
        else if (is_number(key))
            error->all(FLERR, "fix fibrad: `" + key + "` is a number too many, or its keyword is missing");
        else
            error->all(FLERR, "fix fibrad: there is no keyword `" + key + "`");
    }
    if (accuracy && sampling)
        error->all(FLERR, std::string("fix fibrad: `accuracy` excludes `directions`, `paths` and `tolerance`"));
    if (!emissivity.given()) error->all(FLERR, std::string("fix fibrad: `emissivity` is missing"));
    for (const char *word : {solid.given() ? "solid" : "", contact.given() ? "contacts" : "", errors ? "errors" : "",
                             moved > 0 ? "moved" : ""})
        if (*word && !heat_every)
            error->all(FLERR, text("fix fibrad: `%s` needs temperatures: NEVERY must be above 0", word));
    if (solid.given() && contact.given())
        error->all(FLERR,
                   std::string("fix fibrad: `contacts` needs particles of one temperature each, without `solid`"));
    if (!emissivity.table.empty() && !heat_every)
        error->all(FLERR, std::string("fix fibrad: `table` needs temperatures: NEVERY must be above 0"));
    if (heat_every && surroundings.variable.empty() && surroundings.value < 0)
        error->all(
            FLERR,
            std::string("fix fibrad: `surroundings T` is missing, the temperature of what surrounds the particles"));
    if (sigma == 0) {
        if (!strcmp(update->unit_style, "si"))
            sigma = FIBRAD_STEFAN_BOLTZMANN;
        else if (!strcmp(update->unit_style, "cgs"))
            sigma = 1e3 * FIBRAD_STEFAN_BOLTZMANN;
        else if (heat_every)
            error->all(FLERR, std::string("fix fibrad: units ") + update->unit_style +
                                  " need `sigma S`, the Stefan-Boltzmann constant in energy/(time length^2 K^4)");
    }

    columns = 1 + (parts ? 3 + contact.given() : 0) + (errors ? 2 : 0);
    dynamic_group_allow = 1;
    create_attribute = 1;
    nevery = heat_every ? heat_every : rows_every;
    scalar_flag = vector_flag = peratom_flag = 1;
    size_peratom_cols = columns > 1 ? columns : 0;
    size_vector = 5 + (int)walls.size() + 3 + (int)walls.size() + 1 + 2;
    restart_global = wall_heat.any() || moving;
    global_freq = peratom_freq = 1;
    extscalar = extvector = 0;
    maxexchange = columns + 3;
    FixFibrad::grow_arrays(atom->nmax);
    atom->add_callback(Atom::GROW);

    if (fibrad_insitu_new(&insitu, world, &config) != FIBRAD_OK)
        error->all(FLERR,
                   std::string("fix fibrad: no memory, or cutoff, tolerance, directions or paths are out of range"));
}

FixFibrad::~FixFibrad() {
    atom->delete_callback(id, Atom::GROW);
    fibrad_insitu_free(insitu);
    mesh_walls_free(&meshes);
}

// Takes d_NAME or `temperature`. Other words may name data of LAMMPS that are no vector of numbers.
void FixFibrad::read_temperature(Words &words) {
    temperature = words.next();
    if (temperature != "temperature" && temperature.compare(0, 2, "d_") != 0)
        error->all(FLERR, "fix fibrad: `temperature` is followed by d_NAME, not `" + temperature + "`");
}

// Takes the name of a group.
void FixFibrad::read_group(Words &words) {
    const std::string name = words.next();
    const int number = group->find(name);
    if (number < 0) error->all(FLERR, "fix fibrad: there is no group `" + name + "`");
    kept_bit = group->bitmask[number];
}

static const char *const across[] = {"yz", "xz", "xy"}; // the other axes of a cylinder along x, y or z

// wall FACE T e [at POS] [capacity C] | wall FACE open [at POS] | wall xcylinder R T e [at Y Z] [capacity C] |
// wall ycylinder R T e [at X Z] ... | wall zcylinder R T e [at X Y] ... | wall mesh ...
void FixFibrad::read_wall(Words &words) {
    static const char *const faces[] = {"xlo", "xhi",       "ylo",       "yhi",      "zlo",
                                        "zhi", "xcylinder", "ycylinder", "zcylinder"};
    const std::string name = words.next();
    const int face = (int)(std::find(faces, faces + 9, name) - faces);
    const bool round = face >= 6;
    if (face < 6 && words.take("open")) return read_opening(words, face);
    if (walls.size() == FIBRAD_WALLS_MAX)
        error->all(FLERR, text("fix fibrad: there are at most %d walls", FIBRAD_WALLS_MAX));
    if (name == "mesh") return read_mesh(words);
    if (face == 9)
        error->all(FLERR,
                   "fix fibrad: a wall is one of xlo xhi ylo yhi zlo zhi xcylinder ycylinder zcylinder mesh, not `" +
                       name + "`");

    const double huge = 1e300;
    fibrad_wall wall = {};
    if (round) {
        wall.kind = FIBRAD_WALL_CYLINDER;
        wall.cylinder.along = face - 6;
        wall.cylinder.radius = words.number("the cylinder's radius", 0, huge);
    } else {
        wall.kind = FIBRAD_WALL_PLANE;
        wall.plane.axis = face / 2;
        wall.plane.upper = face % 2;
    }
    wall_kelvins.push_back(read_kelvins(words, "a wall's temperature"));
    wall_emissivity.push_back(words.number("a wall's emissivity", 0, 1));
    const bool at = words.take("at");
    if (at) {
        if (round) {
            wall.cylinder.x = words.number(text("%c of the cylinder", across[face - 6][0]), -huge, huge);
            wall.cylinder.y = words.number(text("%c of the cylinder", across[face - 6][1]), -huge, huge);
        } else {
            wall.plane.at = words.number("the place of a wall", -huge, huge);
        }
    }
    wall_heat.capacity.push_back(words.take("capacity") ? read_capacity(words, wall_kelvins.back()) : 0);
    walls.push_back(wall);
    wall_face.push_back(at || round ? -1 : face);
}

// [at POS]; without `at` the opening is where the particles end
void FixFibrad::read_opening(Words &words, int face) {
    const double huge = 1e300;
    fibrad_plane opening = {face / 2, face % 2, NAN};
    if (words.take("at")) opening.at = words.number("the place of an open side", -huge, huge);
    if (words.next_is_number())
        error->all(FLERR, std::string("fix fibrad: an open side has no temperature: it has that of the surroundings; "
                                      "its place follows the word `at`"));
    openings.push_back(opening);
}

// C, the heat capacity of a wall that begins with the temperature t
double FixFibrad::read_capacity(Words &words, const Temperature &t) {
    if (!t.variable.empty())
        error->all(FLERR, "fix fibrad: a wall with a capacity has a temperature of its own, not v_" + t.variable);
    return words.number("a wall's capacity", 1e-300, 1e300);
}

// wall mesh FILE T e [name NAME] [both | normals | auto] [solids] [scale S] [capacity C] [motion]
void FixFibrad::read_mesh(Words &words) {
    const std::string path = words.next();
    const Temperature t = read_kelvins(words, "a wall's temperature");
    const double e = words.number("a wall's emissivity", 0, 1);
    const uint32_t first = (uint32_t)walls.size();
    double capacity = 0;
    std::string name;
    mesh_motion motion = {};
    mesh_file file = {};
    file.path = path.c_str();
    file.scale = 1;
    for (bool more = true; more;) {
        if (words.take("both"))
            file.sides = SIDES_BOTH;
        else if (words.take("normals"))
            file.sides = SIDES_NORMALS;
        else if (words.take("auto"))
            file.sides = SIDES_AUTO;
        else if (words.take("solids"))
            file.solids = true;
        else if (words.take("scale"))
            file.scale = words.number("the scale of a mesh", 1e-12, 1e12);
        else if (words.take("name"))
            name = words.next();
        else if (words.take("capacity"))
            capacity = read_capacity(words, t);
        else
            more = read_motion(words, &motion);
    }
    if (!name.empty()) {
        file.name = name.c_str();
        if (!mesh_name(file.name))
            error->all(FLERR, "fix fibrad: a wall cannot be called `" + name + "`: letters, digits and _, at most 31");
    }
    uint32_t count;
    const int status = mesh_walls_add(&meshes, world, &file, nullptr, first, &count);
    if (status) error->all(FLERR, std::string("fix fibrad: ") + (meshes.messages[0] ? meshes.messages : path.c_str()));
    fibrad_wall wall = {};
    wall.kind = FIBRAD_WALL_MESH;
    walls.insert(walls.end(), count, wall);
    wall_kelvins.insert(wall_kelvins.end(), count, t);
    wall_emissivity.insert(wall_emissivity.end(), count, e);
    wall_heat.capacity.insert(wall_heat.capacity.end(), count, capacity);
    wall_face.insert(wall_face.end(), count, -1);
    motions.push_back(motion);
    if (comm->me == 0) describe_meshes(first, count, path);
}

// rotate AX AY AZ PERIOD [about X Y Z] | velocity VX VY VZ; false: it is another word
bool FixFibrad::read_motion(Words &words, mesh_motion *motion) {
    const auto number = [&words](const char *what) { return words.number(what, -1e100, 1e100); };
    const auto three = [&number](const char *what, double *to) {
        for (int k = 0; k < 3; k++) to[k] = number(what);
    };
    if (words.take("velocity")) {
        three("a mesh's velocity", motion->velocity);
    } else if (words.take("rotate")) {
        double *axis = motion->axis;
        three("a mesh's axis", axis);
        const double length = std::sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
        if (length == 0) error->all(FLERR, std::string("fix fibrad: the axis of a mesh must not be 0 0 0"));
        for (int k = 0; k < 3; k++) axis[k] /= length;
        motion->turn = number("a mesh's period");
        if (motion->turn == 0) error->all(FLERR, std::string("fix fibrad: the period of a mesh must not be 0"));
        if (words.take("about")) three("a point of a mesh's axis", motion->about);
    } else {
        return false;
    }
    return moving = true;
}

// Prints what is said about a file, and the indices of its walls in the output. Only rank 0 has the names of the walls.
void FixFibrad::describe_meshes(uint32_t first, uint32_t count, const std::string &path) {
    if (meshes.messages[0]) say(std::string("fix fibrad: ") + meshes.messages);
    for (uint32_t k = first; k < first + count; k++)
        say(text("fix fibrad: f_%s[%d] is of wall %s, %u triangles of ", id, 6 + (int)k, meshes.meshes.name[k],
                 mesh_triangles(mesh_of_wall(&meshes.meshes, k), k)) +
            path);
}

// T | v_NAME
FixFibrad::Temperature FixFibrad::read_kelvins(Words &words, const char *what) {
    if (words.next_begins("v_")) return {0, words.next().substr(2)};
    return {words.number(what, 0, FIBRAD_TEMPERATURE_MAX), ""};
}

// An option of rows.
void FixFibrad::read_setting(Words &words, const radiation_setting &setting) {
    const std::string name = setting.name, word = words.next();
    if (!setting_take(setting, word, &config))
        error->all(FLERR, "fix fibrad: `" + name + "` is " + setting.wanted + ", not `" + word + "`");
    accuracy |= name == "accuracy";
    sampling |= name == "tolerance" || name == "directions" || name == "paths";
}

// K [lens | hertz] [scale S] [gas KG]
void FixFibrad::read_contacts(Words &words) {
    contact = read_property(words, "the conductivity at contacts", 1e-300, 1e300);
    while (const contact_setting *setting = contact_named(words.peek())) {
        words.next();
        if (setting->number)
            spots.*setting->number = words.number(setting->what, setting->low, setting->high);
        else
            spots.hertz = setting->hertz;
    }
    const double metre = !strcmp(update->unit_style, "si") ? 1 : !strcmp(update->unit_style, "cgs") ? 100 : 0;
    spots.gas_least = FIBRAD_GAS_LEAST_DEFAULT * metre;
}

// VALUE | type VALUE VALUE ... | d_NAME
FixFibrad::Property FixFibrad::read_property(Words &words, const char *what, double low, double high) {
    Property property;
    if (words.next_begins("d_")) { // of fix property/atom
        property.of_atom = words.next();
        return property;
    }
    const size_t types = (size_t)atom->ntypes;
    const bool by_type = words.take("type");
    Table table;
    property.of_type.assign(types + 1, by_type ? 1 : read_value(words, what, low, high, &table)); // types count from 1
    property.table.assign(types + 1, table);
    for (size_t type = 1; by_type && type <= types; type++)
        property.of_type[type] =
            read_value(words, text("%s of type %zu of %zu", what, type, types), low, high, &property.table[type]);
    if (words.next_is_number())
        error->all(FLERR,
                   text("fix fibrad: there are too many values of %s: ", what) +
                       (by_type ? text("atoms have %zu types", types) : "values of types follow the word `type`"));
    const auto given = [](const Table &t) { return t.given(); };
    if (std::none_of(property.table.begin(), property.table.end(), given)) property.table.clear();
    return property;
}

// number | table FILE; returns the number, or the first value of the table
double FixFibrad::read_value(Words &words, const std::string &what, double low, double high, Table *table) {
    if (!words.take("table")) return words.number(what, low, high);
    *table = read_table(words.next(), what.c_str(), low, high);
    return table->value[0];
}

static void keep_line(void *context, const char *line) { *(std::string *)context = line; }

// Rank 0 reads the file and sends the table to the other ranks.
FixFibrad::Table FixFibrad::read_table(const std::string &path, const char *what, double low, double high) {
    curve read = {};
    std::string message;
    int status = 0;
    if (comm->me == 0) {
        message_redirect(keep_line, &message);
        status = curve_read(path.c_str(), what + strlen("the "), &curve_values, low, high, &read);
        message_redirect(nullptr, nullptr);
    }
    int size[] = {status, (int)read.n};
    MPI_Bcast(size, 2, MPI_INT, 0, world);
    Table table;
    table.kelvin.assign(read.x, read.x + read.n);
    table.value.assign(read.y, read.y + read.n);
    curve_free(&read);
    if (size[0]) error->all(FLERR, "fix fibrad: " + message);
    table.kelvin.resize(size[1]);
    table.value.resize(size[1]);
    MPI_Bcast(table.kelvin.data(), size[1], MPI_DOUBLE, 0, world);
    MPI_Bcast(table.value.data(), size[1], MPI_DOUBLE, 0, world);
    return table;
}

// ---- before and after a run ---------------------------------------------------------------------------------------

int FixFibrad::setmask() { return FixConst::POST_FORCE | FixConst::END_OF_STEP | FixConst::POST_RUN; }

void FixFibrad::init() {
    if (!atom->radius) error->all(FLERR, std::string("fix fibrad: particles need radii (atom_style sphere)"));
    if (!atom->tag_enable) error->all(FLERR, std::string("fix fibrad: atoms need ids"));
    if (domain->dimension != 3) error->all(FLERR, std::string("fix fibrad: the dimension must be 3"));
    if (domain->triclinic) error->all(FLERR, std::string("fix fibrad: the box must not be triclinic"));
    if (strstr(update->integrate_style, "respa"))
        error->all(FLERR, std::string("fix fibrad: run_style must be verlet"));
    for (const fibrad_wall &wall : walls) {
        const int along = wall.cylinder.along;
        if (wall.kind == FIBRAD_WALL_CYLINDER &&
            (domain->periodicity[(along + 1) % 3] || domain->periodicity[(along + 2) % 3]))
            error->all(FLERR, text("fix fibrad: wall %ccylinder needs open axes %c and %c: what is in it has no images "
                                   "beyond it",
                                   "xyz"[along], across[along][0], across[along][1]));
    }
    for (const fibrad_plane &opening : openings)
        if (domain->periodicity[opening.axis])
            error->all(FLERR, std::string("fix fibrad: wall ") + "xyz"[opening.axis] + (opening.upper ? "hi" : "lo") +
                                  " open is on a periodic axis");
    for (int face : wall_face) {
        if (face < 0) continue;
        const std::string name = {"xyz"[face / 2], face % 2 ? 'h' : 'l', face % 2 ? 'i' : 'o'};
        if (domain->periodicity[face / 2]) error->all(FLERR, "fix fibrad: wall " + name + " is on a periodic axis");
        if (domain->boundary[face / 2][face % 2] != 1) // fixed
            error->all(FLERR,
                       "fix fibrad: wall " + name + " is on a face that moves with the particles: say where (at POS)");
    }
    if (!emissivity.of_atom.empty()) need(emissivity.of_atom);
    if (!solid.of_atom.empty()) need(solid.of_atom);
    if (!contact.of_atom.empty()) need(contact.of_atom);
    if (contact.given()) refuse_conduction();
    if (!heat_every) return;

    if (temperature.empty()) temperature = known("temperature") && known("heatflow") ? "temperature" : "d_T";
    need(temperature);
    if (temperature != "temperature") {
        if (!cp.given()) error->all(FLERR, std::string("fix fibrad: `cp C`, heat per mass and kelvin, is missing"));
        if (!cp.of_atom.empty()) need(cp.of_atom);
        return;
    }
    bool stepped = false;
    for (int i = 0; i < modify->nfix; i++) stepped = stepped || !strcmp(modify->fix[i]->style, "heat/flow");
    if (!stepped)
        error->all(FLERR, std::string("fix fibrad: nothing steps the temperatures: fix ID all heat/flow constant CP"));
    if (!cp.given()) say("fix fibrad: without `cp` the time step is not checked");
}

// The simulated time, as LAMMPS counts it.
static double clock_of(const Update *update) {
    return update->atime + (double)(update->ntimestep - update->atimestep) * update->dt;
}

// Rows depend on positions and on the last multiple of NROWS. So a restarted run has the same rows.
void FixFibrad::setup(int) {
    begun = MPI_Wtime();
    if (restarted) lost -= clock_of(update), restarted = false; // LAMMPS sets its clock when a run begins
    if (set_up < 0) list_output();
    set_up = update->ntimestep;
    fibrad_insitu_facts_get(insitu, &before);
    refuse_second();
    make_rows();
    if (heat_every) find_powers();

    fibrad_insitu_facts facts;
    fibrad_insitu_facts_get(insitu, &facts);
    double bytes = (double)facts.bytes;
    MPI_Allreduce(MPI_IN_PLACE, &bytes, 1, MPI_DOUBLE, MPI_MAX, world);
    say(text("fix fibrad: %.0f particles, %s, %.0f entries, at most %.1f MB a rank, rows in %.2g s",
             (double)facts.particles, facts.cutoff > 0 ? text("cutoff %g", facts.cutoff).c_str() : "no cutoff",
             (double)facts.entries, bytes / 1e6, facts.seconds_rows - before.seconds_rows));
}

// Says what the elements of the global vector are, and what atoms have.
void FixFibrad::list_output() {
    static const char *const faces[] = {"xlo", "xhi", "ylo", "yhi", "zlo", "zhi"};
    const int count = (int)walls.size();
    std::string names, list = "[1] surroundings", atoms = ": [1] power";
    for (const fibrad_plane &opening : openings)
        list += std::string(" by opening ") + faces[2 * opening.axis + opening.upper];
    list += ", [2] beyond, [3] error, [4] [5] seconds";
    for (int w = 0; w < count; w++) {
        const fibrad_wall &wall = walls[w];
        const std::string name = wall.kind == FIBRAD_WALL_PLANE ? faces[2 * wall.plane.axis + wall.plane.upper]
                                 : wall.kind == FIBRAD_WALL_CYLINDER
                                     ? std::string(1, "xyz"[wall.cylinder.along]) + "cylinder"
                                     : "mesh";
        list += text(", [%d] wall ", 6 + w) + name;
        names += text(", [%d] T of wall ", 9 + count + w) + name;
    }
    list += text(", [%d] outside, [%d] overlapping, [%d] behind", 6 + count, 7 + count, 8 + count) + names;
    list += text(", [%d] gone", 9 + 2 * count);
    if (contact.given()) list += text(", [%d] through contacts, [%d] contacts", 10 + 2 * count, 11 + 2 * count);
    say(text("fix fibrad: f_%s", id) + list);
    if (parts) atoms += ", [2] from particles, [3] from walls, [4] from surroundings";
    if (parts && contact.given()) atoms += ", [5] through contacts";
    if (errors) atoms += text(", [%d] beyond, [%d] error", columns - 1, columns);
    if (columns > 1) say(text("fix fibrad: f_%s of atoms", id) + atoms);
}

void FixFibrad::post_run() {
    follow_heatflow();
    fibrad_insitu_facts facts;
    fibrad_insitu_facts_get(insitu, &facts);
    const double rows = facts.seconds_rows - before.seconds_rows, powers = facts.seconds_powers - before.seconds_powers;
    say(text(
        "fix fibrad: rows made %d times, and of new particles alone %d times, in %.3g s; powers %d times, in %.3g s; "
        "%.0f %% of the run",
        rows_made, rows_followed, rows, powers_found, powers,
        100 * (rows + powers) / std::max(MPI_Wtime() - begun, 1e-9)));
    begun = MPI_Wtime();
    before = facts;
    rows_made = rows_followed = powers_found = 0;
}

void FixFibrad::say(const std::string &sentence) {
    if (comm->me == 0) utils::logmesg(lmp, sentence + "\n");
}

// ---- in a run -----------------------------------------------------------------------------------------------------

// Adds the powers to heatflow if fix heat/flow steps temperatures. fix heat/flow clears heatflow before the forces, and
// steps temperatures after them.
void FixFibrad::post_force(int) {
    if (!heat_every || temperature != "temperature") return;
    double *heatflow = vector("heatflow");
    for (int i = 0; i < atom->nlocal; i++)
        if (atom->mask[i] & groupbit) heatflow[i] += q[i * columns];
}

// A step of rows, of heat, or of both. In a rerun each frame calls setup and then this function for the same step. Its
// powers are there by then, and no time passes.
void FixFibrad::end_of_step() {
    if (update->ntimestep == set_up) {
        if (moving) error->all(FLERR, std::string("fix fibrad: no time passes in a rerun, so meshes cannot move"));
        return;
    }
    if (update->ntimestep % rows_every == 0) make_rows();
    if (!heat_every) return;
    follow_heatflow();
    select();
    if (have_moved()) make_rows(MOVED);
    find_powers();
    if (temperature == "temperature") return;
    heat_walls(heat_every);
    double *t = vector(temperature);
    const std::vector<double> capacity = values(cp);
    for (size_t k = 0; k < member.size(); k++) {
        const int i = member[k];
        if (!(atom->mask[i] & groupbit)) continue;
        const double heat = q[i * columns] * update->dt * heat_every;
        const Table *table = cp.table.empty() ? nullptr : &cp.table[atom->type[i]];
        const curve points = table ? table->points() : curve();
        t[i] = points.n ? curve_advance(&points, t[i], heat / mass(i)) : t[i] + heat / (mass(i) * capacity[k]);
    }
}

void FixFibrad::select() {
    member.clear();
    tags.clear();
    for (int i = 0; i < atom->nlocal; i++)
        if (takes_part(i)) {
            member.push_back(i);
            tags.push_back((uint64_t)atom->tag[i]);
        }
}

// The time that meshes go by.
double FixFibrad::time() const { return restarted ? lost : lost + clock_of(update); }

// Puts meshes where they are now, and finds which sides of them are walls.
void FixFibrad::place_meshes(const fibrad_insitu_bed &bed) {
    if ((moving && mesh_walls_move(&meshes, world, &bed, motions.data(), time())) ||
        mesh_walls_face(&meshes, world, &bed))
        error->all(FLERR, std::string("fix fibrad: out of memory"));
}

// The members and walls at present.
FixFibrad::Bed FixFibrad::present_bed() {
    Bed b = {};
    for (int i : member) {
        b.x.insert(b.x.end(), atom->x[i], atom->x[i] + 3);
        b.radius.push_back(atom->radius[i]);
    }
    b.emissivity = values(emissivity), b.conductivity = conductivities();
    for (size_t w = 0; w < walls.size(); w++)
        if (wall_face[w] >= 0) walls[w].plane.at = (wall_face[w] % 2 ? domain->boxhi : domain->boxlo)[wall_face[w] / 2];

    std::copy_n(domain->boxlo, 3, b.bed.low);
    std::copy_n(domain->boxhi, 3, b.bed.high);
    std::copy_n(domain->periodicity, 3, b.bed.periodic);
    b.bed.wall = walls.data();
    b.bed.wall_emissivity = wall_emissivity.data();
    b.bed.walls = (uint32_t)walls.size();
    b.bed.opening = openings.data();
    b.bed.openings = (uint32_t)openings.size();
    b.bed.triangles = &meshes.meshes.triangles;
    b.bed.n = member.size();
    b.bed.id = tags.data();
    b.bed.x = b.x.data();
    b.bed.radius = b.radius.data();
    b.bed.emissivity = b.emissivity.data();
    b.bed.conductivity = solid.given() ? b.conductivity.data() : nullptr;
    return b;
}

// Whether more than a tenth of all particles have moved by more than `moved` radii since their rows were made. One
// particle that falls makes no new rows.
bool FixFibrad::have_moved() {
    bigint count[] = {0, (bigint)member.size()};
    if (!(moved > 0)) return false;
    for (int i : member) {
        double square = 0;
        for (int axis = 0; axis < 3; axis++) {
            const double d = atom->x[i][axis] - rows_x[3 * i + axis];
            const double away =
                domain->periodicity[axis] ? d - domain->prd[axis] * std::round(d / domain->prd[axis]) : d;
            square += away * away;
        }
        count[0] += square > moved * moved * atom->radius[i] * atom->radius[i];
    }
    MPI_Allreduce(MPI_IN_PLACE, count, 2, MPI_LMP_BIGINT, MPI_SUM, world);
    return 10 * count[0] > count[1];
}

// Makes the rows of all particles, or only those of particles that have come since the last rows.
void FixFibrad::make_rows(int which) {
    const bool follow = which == NEW;
    select();
    for (size_t k = 0; k < member.size() && !follow; k++) std::copy_n(atom->x[member[k]], 3, &rows_x[3 * member[k]]);
    const Bed present = present_bed();
    const bigint number = which == MOVED ? update->ntimestep : update->ntimestep / rows_every * rows_every;
    place_meshes(present.bed);
    const int status = (follow ? fibrad_insitu_follow : fibrad_insitu_rows)(insitu, &present.bed, (uint64_t)number);
    if (status == FIBRAD_E_BACK)
        error->all(FLERR, std::string("fix fibrad: ") + fibrad_insitu_message(insitu) +
                              "; with the word `both` both sides of a mesh are the wall");
    if (status == FIBRAD_E_ENDLESS)
        error->all(FLERR, std::string("fix fibrad: ") + fibrad_insitu_message(insitu) + ", `wall zhi open`");
    check(status);
    (follow ? rows_followed : rows_made)++;
    tell_strays();
    if (!rows_file.empty() && !follow)
        check(fibrad_insitu_write(insitu, (rows_file + "." + std::to_string(update->ntimestep)).c_str()));
}

void FixFibrad::tell_strays() {
    const char *beyond =
        config.cutoff > 0 ? "take a larger `cutoff`, or none" : "with a larger `gather` there is no cutoff";
    for (int kind = 0; kind < FIBRAD_REMARKS; kind++) {
        const char *remark = fibrad_insitu_remark(insitu, kind);
        if (*remark && !told[kind] && comm->me == 0)
            error->warning(FLERR,
                           text("fix fibrad: %s, at step %s; %s", remark, std::to_string(update->ntimestep).c_str(),
                                kind == FIBRAD_REMARK_BEYOND ? beyond : "`strict yes` would end the run"));
        told[kind] = told[kind] || *remark;
    }
}

// If two fixes had a particle in common, it would exchange heat twice. Such fixes are an error. Also prints the number
// of particles that take no part.
void FixFibrad::refuse_second() {
    bigint outside = 0;
    for (int i = 0; i < atom->nlocal; i++) outside += !takes_part(i);
    MPI_Allreduce(MPI_IN_PLACE, &outside, 1, MPI_LMP_BIGINT, MPI_SUM, world);
    if (outside)
        say(text("fix fibrad: %.0f particles outside the groups neither radiate nor are in the way", (double)outside));
    for (int k = 0; k < modify->nfix && heat_every; k++) {
        const FixFibrad *other = dynamic_cast<FixFibrad *>(modify->fix[k]);
        if (!other || other == this || !other->heat_every) continue;
        tagint shared = 0;
        for (int i = 0; i < atom->nlocal; i++)
            if (takes_part(i) && other->takes_part(i)) shared = std::max(shared, atom->tag[i]);
        MPI_Allreduce(MPI_IN_PLACE, &shared, 1, MPI_LMP_TAGINT, MPI_MAX, world);
        if (shared)
            error->all(FLERR, std::string("fix fibrad: the fixes ") + id + " and " + other->id +
                                  " both radiate from atom " + std::to_string(shared));
    }
}

// Whether pair granular has a model of heat. The names of its models are in restart files alone.
static bool has_heat(Pair *pair) {
    char *bytes = nullptr;
    size_t size = 0;
    FILE *file = open_memstream(&bytes, &size);
    if (!file) return false;
    pair->write_restart(file);
    fclose(file);
    const std::string names(bytes, size);
    free(bytes);
    return names.find("area") != std::string::npos || names.find("radius") != std::string::npos;
}

void FixFibrad::refuse_conduction() {
    std::string name;
    for (int k = 0; k < modify->nfix; k++)
        if (!strncmp(modify->fix[k]->style, "heat/gran", 9)) name = std::string("fix ") + modify->fix[k]->style;
    Pair *pair = force->pair_match("granular", 1);
    int heat = comm->me == 0 && pair && has_heat(pair);
    MPI_Bcast(&heat, 1, MPI_INT, 0, world);
    if (heat) name = "the heat model of pair granular";
    if (!name.empty())
        error->all(FLERR, "fix fibrad: " + name + " conducts through contacts already: leave out `contacts`");
}

// Evaluates the variables. A variable may use computes, which are then needed at steps of heat.
void FixFibrad::find_temperatures() {
    const auto kelvins = [this](const Temperature &t) {
        if (t.variable.empty()) return t.value;
        const int k = input->variable->find(t.variable.c_str());
        if (k < 0 || !input->variable->equalstyle(k))
            error->all(FLERR, "fix fibrad: " + (k < 0 ? "there is no equal-style variable `" + t.variable + "`"
                                                      : "the variable `" + t.variable +
                                                            "` is not of equal style; a wall or the surroundings have "
                                                            "one temperature"));
        const double value = input->variable->compute_equal(k);
        if (!(value >= 0 && value < HUGE_VAL))
            error->all(FLERR, text("fix fibrad: the temperature v_%s is %g", t.variable.c_str(), value));
        return value;
    };
    modify->clearstep_compute();
    surroundings.value = kelvins(surroundings);
    for (Temperature &t : wall_kelvins) t.value = kelvins(t);
    modify->addstep_compute(update->ntimestep + heat_every);
}

void FixFibrad::find_powers() {
    find_temperatures();
    select();
    const std::vector<double> t = temperatures(), of_walls = wall_temperatures();
    std::vector<double> power(member.size()), by_contacts(member.size()), conductance(member.size());
    check_values(t);

    fibrad_insitu_state state = {};
    state.sigma = sigma;
    state.surroundings = surroundings.value;
    state.wall_temperature = of_walls.data();
    state.n = member.size();
    state.id = tags.data();
    state.temperature = t.data();
    int status = fibrad_insitu_powers(insitu, &state, power.data(), &totals);
    if (status == FIBRAD_E_STATE) { // particles have come or gone since the rows were made
        make_rows(NEW);
        status = fibrad_insitu_powers(insitu, &state, power.data(), &totals);
    }
    check(status);
    tell_strays();
    if (contact.given()) conduct(state, by_contacts.data(), conductance.data());
    check_step(t, conductance);
    check_walls();
    powers_found++;
    powers_at = update->ntimestep;
    std::fill(q.begin(), q.end(), 0.0);
    for (size_t k = 0; k < member.size(); k++) q[member[k] * columns] = power[k] + by_contacts[k];
    if (parts) find_parts(by_contacts.data());
    if (errors) find_errors();
}

// Finds what members gain through contacts, and adds it to the totals.
void FixFibrad::conduct(const fibrad_insitu_state &state, double *power, double *conductance) {
    const std::vector<double> k = values(contact);
    spots.conductivity = k.data();
    const Bed present = present_bed();
    check(fibrad_insitu_conduct(insitu, &spots, &present.bed, &state, power, conductance, &conducted));
    totals.particles += conducted.particles;
    for (size_t w = 0; w < walls.size(); w++) totals.wall[w] += conducted.wall[w];
}

// Divides each power into what comes by radiation from particles, from walls and from surroundings, and by contacts.
void FixFibrad::find_parts(const double *by_contacts) {
    std::vector<double> part(2 * member.size());
    check(fibrad_insitu_parts(insitu, (double(*)[2])part.data()));
    for (size_t k = 0; k < member.size(); k++) {
        double *of_atom = &q[member[k] * columns];
        of_atom[2] = part[2 * k], of_atom[3] = part[2 * k + 1];
        of_atom[1] = of_atom[0] - of_atom[2] - of_atom[3] - by_contacts[k];
        if (contact.given()) of_atom[4] = by_contacts[k];
    }
}

void FixFibrad::find_errors() {
    std::vector<double> of_rows(2 * member.size());
    check(fibrad_insitu_errors(insitu, (double(*)[2])of_rows.data()));
    for (size_t k = 0; k < member.size(); k++) std::copy_n(&of_rows[2 * k], 2, lines[member[k]] + columns - 2);
}

std::vector<double> FixFibrad::wall_temperatures() const {
    std::vector<double> t;
    for (const Temperature &of_wall : wall_kelvins) t.push_back(of_wall.value);
    return t;
}

// Gives walls the heat that the present powers bring in some steps of the simulation.
void FixFibrad::heat_walls(bigint steps) {
    std::vector<double> t = wall_temperatures();
    wall_heat.step(totals.wall, update->dt * (double)steps, &t);
    for (size_t k = 0; k < t.size(); k++) wall_kelvins[k].value = t[k];
}

// Heats walls as fix heat/flow heats particles: by the present powers, in all steps since the last call.
void FixFibrad::follow_heatflow() {
    if (temperature != "temperature") return;
    heat_walls(update->ntimestep - powers_at);
    powers_at = update->ntimestep;
}

std::vector<double> FixFibrad::temperatures() {
    double *of_atom = vector(temperature);
    std::vector<double> t;
    for (int i : member) {
        if (of_atom[i] == 0) of_atom[i] = initial;
        t.push_back(of_atom[i]);
    }
    return t;
}

// k* at the present temperatures. The rows keep it until they are made again.
std::vector<double> FixFibrad::conductivities() {
    if (!solid.given()) return {};
    std::vector<double> relative = values(solid);
    const std::vector<double> t = temperatures();
    for (size_t k = 0; k < relative.size(); k++)
        relative[k] = fibrad_relative_conductivity(relative[k], atom->radius[member[k]], t[k], sigma);
    return relative;
}

// Checks that temperatures and capacities are above 0. The message has those of one atom.
void FixFibrad::check_values(const std::vector<double> &t) {
    const std::vector<double> capacity = values(cp);
    double at_fault[] = {0, 0, 0}; // id, temperature, cp
    for (size_t k = 0; k < member.size(); k++) {
        const double c = cp.given() && atom->mask[member[k]] & groupbit ? capacity[k] : 1;
        const double tag = (double)atom->tag[member[k]];
        if ((t[k] > 0 && t[k] < HUGE_VAL && c > 0) || tag < at_fault[0]) continue;
        at_fault[0] = tag, at_fault[1] = t[k], at_fault[2] = c;
    }
    struct {
        double id;
        int rank;
    } last = {at_fault[0], comm->me};
    MPI_Allreduce(MPI_IN_PLACE, &last, 1, MPI_DOUBLE_INT, MPI_MAXLOC, world);
    if (!(last.id > 0)) return;
    MPI_Bcast(at_fault, 3, MPI_DOUBLE, last.rank, world);
    const std::string of = text(" of atom %.0f is ", last.id);
    if (at_fault[1] == 0)
        error->all(FLERR, "fix fibrad: the temperature " + temperature + of + "0, so it was not set: `set group all " +
                              temperature + " T`, or `initial T` of the fix");
    if (!(at_fault[1] > 0 && at_fault[1] < HUGE_VAL))
        error->all(FLERR, "fix fibrad: the temperature " + temperature + of + text("%g, not above 0", at_fault[1]));
    error->all(FLERR, "fix fibrad: cp" + of + text("%g, not above 0", at_fault[2]));
}

// Checks that steps of temperatures are stable: (4 sigma T^3 A e + 2 H) dt < m cp, H the sum over contacts. Then no
// particle overshoots its surroundings, and no difference of temperatures changes its sign.
void FixFibrad::check_step(const std::vector<double> &t, const std::vector<double> &conductance) {
    const std::vector<double> e = values(emissivity), capacity = values(cp);
    struct {
        double ratio;
        int rank;
    } worst = {0, comm->me};
    tagint tag = 0;
    for (size_t k = 0; k < member.size() && cp.given(); k++) {
        const int i = member[k];
        const double area = 16 * std::atan(1) * atom->radius[i] * atom->radius[i];
        const double per_kelvin = 4 * sigma * t[k] * t[k] * t[k] * area * e[k] + 2 * conductance[k];
        const double ratio = per_kelvin * update->dt * heat_every / (mass(i) * capacity[k]);
        if (atom->mask[i] & groupbit && ratio > worst.ratio) worst.ratio = ratio, tag = atom->tag[i];
    }
    MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_DOUBLE_INT, MPI_MAXLOC, world);
    if (worst.ratio < 0.5 || (worst.ratio < 1 && warned)) return;
    MPI_Bcast(&tag, 1, MPI_LMP_TAGINT, worst.rank, world);
    judge_step("atom " + std::to_string(tag), worst.ratio, warned);
}

// Ends the run if steps of heat are longer than the longest stable step. Warns once if they are longer than its half.
void FixFibrad::judge_step(const std::string &name, double ratio, bool &already_warned) {
    if (ratio < 0.5 || (ratio < 1 && already_warned)) return;
    const int most = (int)(heat_every / ratio * (1 - 1e-9));
    if (ratio >= 1)
        error->all(FLERR, "fix fibrad: steps of heat are too long for " + name +
                              (most ? ": NEVERY must be at most " + std::to_string(most)
                                    : text(": the time step must be at most %.3g", update->dt * heat_every / ratio)));
    already_warned = true;
    if (comm->me == 0)
        error->warning(FLERR, "fix fibrad: steps of heat are long for " + name +
                                  text(": %.2g times the longest stable step", ratio));
}

// Checks that steps of heat are stable for walls that store heat.
void FixFibrad::check_walls() {
    size_t wall = 0;
    fibrad_insitu_facts facts;
    fibrad_insitu_facts_get(insitu, &facts);
    const double ratio =
        wall_heat.ratio(facts.wall, conducted.conductance, sigma, wall_temperatures(), update->dt * heat_every, &wall);
    judge_step(text("wall %d", (int)wall + 1), ratio, wall_warned);
}

void FixFibrad::check(int status) {
    if (status != FIBRAD_OK) error->all(FLERR, std::string("fix fibrad: ") + fibrad_insitu_message(insitu));
}

// ---- values of atoms ------------------------------------------------------------------------------------------------

// A vector of LAMMPS or of fix property/atom. LAMMPS may move the vector when atoms come. NULL: there is none, or this
// rank has no atoms.
double *FixFibrad::vector(const std::string &name) { return (double *)atom->extract(name.c_str()); }

// Whether some rank has a vector.
bool FixFibrad::known(const std::string &name) {
    int there = vector(name) != nullptr;
    MPI_Allreduce(MPI_IN_PLACE, &there, 1, MPI_INT, MPI_MAX, world);
    return there;
}

void FixFibrad::need(const std::string &name) {
    int there = vector(name) || !atom->nlocal;
    MPI_Allreduce(MPI_IN_PLACE, &there, 1, MPI_INT, MPI_MIN, world);
    if (!there)
        error->all(FLERR, "fix fibrad: atoms have no " + name + ": say fix ID all property/atom " + name + " before");
}

// Values of the members.
std::vector<double> FixFibrad::values(const Property &property) {
    std::vector<double> value;
    if (!property.given()) return value;
    const double *of_atom = property.of_atom.empty() ? nullptr : vector(property.of_atom);
    for (int i : member) value.push_back(of_atom ? of_atom[i] : property.of_type[atom->type[i]]);
    if (property.table.empty()) return value;
    const std::vector<double> t = temperatures();
    for (size_t k = 0; k < member.size(); k++) {
        const curve points = property.table[atom->type[member[k]]].points();
        if (points.n) value[k] = curve_at(&points, t[k]);
    }
    return value;
}

double FixFibrad::mass(int i) const { return atom->rmass ? atom->rmass[i] : atom->mass[atom->type[i]]; }

// ---- output, and powers that move with their atoms ------------------------------------------------------------------

double FixFibrad::compute_scalar() { return totals.particles; }

double FixFibrad::compute_vector(int n) {
    fibrad_insitu_facts facts;
    fibrad_insitu_facts_get(insitu, &facts);
    const double first[] = {totals.surroundings, facts.beyond, facts.error, facts.seconds_rows, facts.seconds_powers};
    const double strays[] = {(double)facts.outside, (double)facts.overlapping, (double)facts.behind};
    const double rest[] = {(double)facts.gone, conducted.particles, conducted.contacts};
    const int last = 5 + (int)walls.size();
    return n < 5                 ? first[n]
           : n < last            ? totals.wall[n - 5]
           : n < last + 3        ? strays[n - last]
           : n < size_vector - 3 ? wall_kelvins[n - last - 3].value
                                 : rest[n - size_vector + 3];
}

double FixFibrad::memory_usage() {
    fibrad_insitu_facts facts;
    fibrad_insitu_facts_get(insitu, &facts);
    return (double)facts.bytes + (double)(q.capacity() * sizeof(double));
}

void FixFibrad::grow_arrays(int nmax) {
    q.resize(nmax * columns);
    rows_x.resize(nmax * 3);
    lines.resize(nmax);
    for (int i = 0; i < nmax; i++) lines[i] = &q[i * columns];
    vector_atom = q.data();
    array_atom = lines.data();
}

void FixFibrad::copy_arrays(int i, int j, int) {
    std::copy_n(lines[i], columns, lines[j]);
    std::copy_n(&rows_x[3 * i], 3, &rows_x[3 * j]);
}

// Sets the values of a new atom. The elements of its index may have values of an atom that is gone.
void FixFibrad::set_arrays(int i) {
    std::fill_n(lines[i], columns, 0.0);
    std::copy_n(atom->x[i], 3, &rows_x[3 * i]);
    if (!takes_part(i)) return;
    if (double *t = temperature.empty() ? nullptr : vector(temperature)) t[i] = initial;
}

int FixFibrad::pack_exchange(int i, double *buffer) {
    std::copy_n(lines[i], columns, buffer);
    std::copy_n(&rows_x[3 * i], 3, buffer + columns);
    return columns + 3;
}

int FixFibrad::unpack_exchange(int i, double *buffer) {
    std::copy_n(buffer, columns, lines[i]);
    std::copy_n(buffer + columns, 3, &rows_x[3 * i]);
    return columns + 3;
}

// ---- restarts: temperatures of walls that store heat, and the time --------------------------------------------------

void FixFibrad::write_restart(FILE *file) {
    if (comm->me) return;
    std::vector<double> kept = wall_temperatures();
    kept.insert(kept.begin(), (double)walls.size());
    kept.push_back(time());
    const int bytes = (int)(kept.size() * sizeof(double));
    fwrite(&bytes, sizeof bytes, 1, file);
    fwrite(kept.data(), sizeof(double), kept.size(), file);
}

void FixFibrad::restart(char *buffer) {
    double there;
    memcpy(&there, buffer, sizeof there);
    if (there != (double)walls.size())
        error->all(FLERR, text("fix fibrad: there are %d walls, but %g in the restart file", (int)walls.size(), there));
    std::vector<double> kept(walls.size() + 1);
    memcpy(kept.data(), buffer + sizeof there, kept.size() * sizeof(double));
    for (size_t k = 0; k < walls.size(); k++)
        if (wall_heat.capacity[k] > 0) wall_kelvins[k].value = kept[k];
    lost = kept.back(), restarted = true;
}

// ---- loading --------------------------------------------------------------------------------------------------------

void *FixFibrad::create(void *lmp, int narg, char **arg) { return new FixFibrad((LAMMPS *)lmp, narg, arg); }

// Makes the fix known to a LAMMPS without `plugin load`. fibrad.lmp calls this function.
extern "C" void fibrad_register(LAMMPS *lmp) {
    (*lmp->modify->fix_map)["fibrad"] = (Modify::FixCreator)&FixFibrad::create;
}
