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

#include <algorithm>
#include <climits>
#include <cmath>
#include <cstdarg>
#include <cstring>
#include <set>

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

[[noreturn]] void FixFibrad::stop(const std::string &sentence) const {
    error->all(FLERR, "fix fibrad: " + sentence);
    abort(); // old LAMMPS does not say that `all` never returns
}

void FixFibrad::need_good(bool good) const {
    if (!good) stop(radiation.fault);
}

// ---- the command ------------------------------------------------------------------------------------------------

bool FixFibrad::take(const char *what) {
    const bool is = at < word.size() && word[at] == what;
    at += is;
    return is;
}

std::string FixFibrad::peek() const { return at < word.size() ? word[at] : ""; }

std::string FixFibrad::next() {
    if (at == word.size()) stop("a word is missing after `" + word.back() + "`");
    return word[at++];
}

// Takes a number from low to high.
double FixFibrad::number(const std::string &what, double low, double high) {
    double value;
    const std::string behind = word[at - 1], given = at < word.size() ? next() : std::string();
    if (radiation_number(given.c_str(), low, high, &value)) return value;
    if (given.empty()) stop(what + " is missing after `" + behind + "`");
    if (given == "table") stop("a table is now " + what + " @FILE");
    if (!is_number(given)) stop(what + " must be a number, not `" + given + "`: is a value missing?");
    stop(what + " must be " + (low > 0 && high >= 1e300 ? "above 0" : text("in [%g, %g]", low, high)) + ", not " +
         given);
}

int FixFibrad::count(const char *what, int low) {
    int64_t value;
    const std::string given = next();
    if (!radiation_whole(given.c_str(), low, INT_MAX, &value))
        stop(text("%s must be a whole number, at least %d, not `", what, low) + given + "`");
    return (int)value;
}

FixFibrad::FixFibrad(LAMMPS *lammps, int narg, char **arg)
    : Fix(lammps, narg, arg), word(arg + 3, arg + narg), at(0), temperature(), kept_bit(0), errors(false), columns(1),
      moved(0), initial(0), radiation(), moving(false), clumps(false), set_up(-1), powers_at(0), lost(0),
      restarted(false), begun(0), before() {
    const double huge = 1e300;
    radiation.config.seed = 1; // the default of docs/lammps.md
    radiation.surroundings = NAN;
    radiation.files = true;
    radiation.place_meshes = [](void *fix) { ((FixFibrad *)fix)->place_meshes(); };
    radiation.say = [](void *fix, const char *sentence, bool warning) {
        FixFibrad *self = (FixFibrad *)fix;
        const std::string line = std::string("fix fibrad: ") + sentence;
        if (warning && self->comm->me == 0) self->error->warning(FLERR, line);
        if (!warning) self->say(line);
    };
    radiation.simulation = this;
    const bool known_units = radiation_units(&radiation, update->unit_style);
    heat_every = count("NEVERY", 0);
    rows_every = count("NROWS", 1);
    radiation.heats = heat_every > 0;
    if (heat_every && rows_every % heat_every) stop("NROWS must be a multiple of NEVERY");

    std::set<std::string> known;
    while (at < word.size()) {
        const std::string key = next();
        if (key != "wall" && !known.insert(key).second) stop("`" + key + "` is given twice");
        if (key == "emissivity")
            emissivity = read_property("the emissivity", 0, 1);
        else if (key == "cp")
            cp = read_property("the heat capacity", 1e-300, huge);
        else if (key == "solid")
            solid = read_property("the conductivity of the solid", 1e-300, huge);
        else if (key == "contacts")
            read_contacts();
        else if (key == "convection")
            film = read_film("the heat transfer coefficient", huge, true),
            gas = read_film("the temperature of the gas", FIBRAD_TEMPERATURE_MAX, false);
        else if (key == "surroundings")
            read_surroundings();
        else if (key == "wall")
            read_wall();
        else if (key == "temperature")
            read_temperature();
        else if (key == "group2")
            read_group();
        else if (key == "clump")
            read_clumps();
        else if (key == "initial")
            initial = number("the initial temperature", 0, huge);
        else if (key == "sigma")
            radiation.sigma = number("sigma", 1e-300, huge);
        else if (key == "rows")
            rows_file = next();
        else if (key == "errors")
            errors = yes_or_no();
        else if (key == "moved")
            moved = number("the distance that particles may move", 0, huge);
        else
            read_option(key);
    }
    if (!emissivity.given()) stop("`emissivity` is missing");
    for (const char *needs :
         {solid.given() ? "solid" : "", contact.given() ? "contacts" : "", film.given() ? "convection" : "",
          errors ? "errors" : "", moved > 0 ? "moved" : "", emissivity.table.empty() ? "" : "@FILE"})
        if (*needs && !heat_every) stop(text("`%s` needs temperatures: NEVERY must be above 0", needs));
    if (solid.given() && contact.given()) stop("`contacts` needs particles of one temperature each, without `solid`");
    if (clumps && solid.given()) stop("`clump` needs particles of one temperature each, without `solid`");
    if (clumps && contact.given()) stop("`contacts` between clumps are not computed: leave out `contacts`");
    if (!known_units && heat_every && radiation.sigma == 0)
        stop(std::string("units ") + update->unit_style +
             " need `sigma S`, the Stefan-Boltzmann constant in energy/(time length^2 K^4)");
    if (!surroundings.empty()) radiation.surroundings = 0; // until the variable is evaluated
    need_good(radiation_begin(&radiation, world, domain->periodicity));
    name_walls();

    columns = errors ? 3 : 1;
    dynamic_group_allow = 1;
    create_attribute = 1;
    nevery = heat_every ? heat_every : rows_every;
    scalar_flag = vector_flag = peratom_flag = 1;
    size_peratom_cols = columns > 1 ? columns : 0;
    size_vector = 5 + (int)radiation.walls + 3 + (int)radiation.walls + 1 + 2 + 1;
    restart_global = moving;
    for (uint32_t k = 0; k < radiation.walls; k++) restart_global |= radiation.words[k]->capacity > 0;
    global_freq = peratom_freq = 1;
    extscalar = extvector = 0;
    maxexchange = columns + 3;
    FixFibrad::grow_arrays(atom->nmax);
    atom->add_callback(Atom::GROW);
}

FixFibrad::~FixFibrad() {
    atom->delete_callback(id, Atom::GROW);
    radiation_free(&radiation);
}

bool FixFibrad::yes_or_no() {
    const std::string given = next();
    if (given != "yes" && given != "no") stop("say yes or no, not `" + given + "`");
    return given == "yes";
}

// Takes d_NAME or `temperature`. Other words may name data of LAMMPS that are no vector of numbers.
void FixFibrad::read_temperature() {
    temperature = next();
    if (temperature != "temperature" && temperature.compare(0, 2, "d_") != 0)
        stop("`temperature` is followed by d_NAME, not `" + temperature + "`");
}

// Takes the name of a group.
void FixFibrad::read_group() {
    const std::string name = next();
    const int number = group->find(name);
    if (number < 0) stop("there is no group `" + name + "`");
    kept_bit = group->bitmask[number];
}

// mol
void FixFibrad::read_clumps() {
    if (next() != "mol") stop("`clump` is followed by mol, not `" + word[at - 1] + "`");
    clumps = true;
}

// T | v_NAME
void FixFibrad::read_surroundings() {
    if (peek().compare(0, 2, "v_") == 0)
        surroundings = next().substr(2);
    else
        radiation.surroundings = number("the temperature of the surroundings", 0, FIBRAD_TEMPERATURE_MAX);
}

// A wall, and for meshes words of motion in between.
void FixFibrad::read_wall() {
    std::vector<const char *> words;
    for (const std::string &of_command : word) words.push_back(of_command.c_str());
    wall_words wall = {};
    mesh_motion motion = {};
    do {
        const int count = wall_words_read(&wall, words.data() + at, (int)(words.size() - at), KEYS, radiation.fault);
        if (count == 0 && *radiation.fault) stop(std::string("wall ") + radiation.fault);
        at += count;
    } while (wall.shape == WALL_MESH && read_motion(&motion));
    if (wall.shape == WALL_MESH) motions.push_back(motion);
    need_good(radiation_add_wall(&radiation, &wall));
}

// rotate AX AY AZ PERIOD [about X Y Z] | velocity VX VY VZ; false: it is another word
bool FixFibrad::read_motion(mesh_motion *motion) {
    const auto three = [this](const char *what, double *to) {
        for (int k = 0; k < 3; k++) to[k] = number(what, -1e100, 1e100);
    };
    if (take("velocity")) {
        three("a mesh's velocity", motion->velocity);
    } else if (take("rotate")) {
        double *axis = motion->axis;
        three("a mesh's axis", axis);
        const double length = std::sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
        if (length == 0) stop("the axis of a mesh must not be 0 0 0");
        for (int k = 0; k < 3; k++) axis[k] /= length;
        motion->turn = number("a mesh's period", -1e100, 1e100);
        if (motion->turn == 0) stop("the period of a mesh must not be 0");
        if (take("about")) three("a point of a mesh's axis", motion->about);
    } else {
        return false;
    }
    return moving = true;
}

// Keeps variables of temperatures. Prints the indices of walls of triangles in the output.
void FixFibrad::name_walls() {
    for (uint32_t k = 0; k < radiation.walls; k++) {
        const wall_words *wall = radiation.words[k];
        const bool varies = wall->temperature_text && std::isnan(wall->temperature);
        variables.push_back(varies ? wall->temperature_text + 2 : "");
        if (wall->shape == WALL_MESH)
            say(text("fix fibrad: f_%s[%d] is of wall %s, %u triangles of ", id, 6 + (int)k, radiation.name[k],
                     mesh_triangles(mesh_of_wall(&radiation.meshes.meshes, k), k)) +
                wall->mesh.path);
    }
}

// An option of rows.
void FixFibrad::read_option(const std::string &key) {
    const char *wanted = radiation_option(&radiation, key.c_str(), peek().c_str());
    if (wanted && !*wanted)
        stop("`" + key + (is_number(key) ? "` is a number too many, or its keyword is missing" : "` is no keyword"));
    if (wanted) stop("`" + key + "` is " + wanted + ", not `" + peek() + "`");
    at++;
}

// v_NAME, or a property
FixFibrad::Property FixFibrad::read_film(const char *what, double high, bool number_follows) {
    Property property;
    if (peek().compare(0, 2, "v_") != 0) return read_property(what, 0, high, number_follows);
    property.variable = next().substr(2);
    return property;
}

// K [lens | hertz] [scale S] [gas KG | gas @FILE] [wall KW]
void FixFibrad::read_contacts() {
    contact = read_property("the conductivity at contacts", 1e-300, 1e300);
    std::vector<const char *> words;
    for (size_t k = at; k < word.size(); k++) words.push_back(word[k].c_str());
    const int count = radiation_contact_words(&radiation, words.data(), (int)words.size());
    need_good(count >= 0);
    at += count;
    radiation.conducts = true;
}

// VALUE | type VALUE VALUE ... | d_NAME
FixFibrad::Property FixFibrad::read_property(const char *what, double low, double high, bool number_follows) {
    Property property;
    if (peek().compare(0, 2, "d_") == 0) { // of fix property/atom
        property.of_atom = next();
        return property;
    }
    const size_t types = (size_t)atom->ntypes;
    const bool by_type = take("type");
    Table table;
    property.of_type.assign(types + 1, by_type ? 1 : read_value(what, low, high, &table)); // types count from 1
    property.table.assign(types + 1, table);
    for (size_t type = 1; by_type && type <= types; type++)
        property.of_type[type] =
            read_value(text("%s of type %zu of %zu", what, type, types), low, high, &property.table[type]);
    if (!number_follows && is_number(peek()))
        stop(text("there are too many values of %s: ", what) +
             (by_type ? text("atoms have %zu types", types) : "values of types follow the word `type`"));
    const auto given = [](const Table &t) { return t.given(); };
    if (std::none_of(property.table.begin(), property.table.end(), given)) property.table.clear();
    return property;
}

// number | @FILE; returns the number, or the first value of the table
double FixFibrad::read_value(const std::string &what, double low, double high, Table *table) {
    if (peek().compare(0, 1, "@") != 0) return number(what, low, high);
    *table = read_table(next().substr(1), what.c_str(), low, high);
    return table->value[0];
}

// Rank 0 reads the file and sends the table to the other ranks.
FixFibrad::Table FixFibrad::read_table(const std::string &path, const char *what, double low, double high) {
    curve read = {};
    radiation.comm = world;
    need_good(radiation_table(&radiation, path.c_str(), what + strlen("the "), low, high, &read));
    Table table;
    table.kelvin.assign(read.x, read.x + read.n);
    table.value.assign(read.y, read.y + read.n);
    curve_free(&read);
    return table;
}

// ---- before and after a run ---------------------------------------------------------------------------------------

int FixFibrad::setmask() { return FixConst::POST_FORCE | FixConst::END_OF_STEP | FixConst::POST_RUN; }

void FixFibrad::init() {
    const char *shape = atom->body_flag        ? "body"
                        : atom->ellipsoid_flag ? "ellipsoid"
                        : atom->tri_flag       ? "tri"
                                               : nullptr;
    if (shape) stop(std::string("particles must be spheres, and atom_style ") + shape + " has others");
    if (!atom->radius) stop("particles need radii (atom_style sphere)");
    if (!atom->tag_enable) stop("atoms need ids");
    if (clumps && !atom->molecule_flag) stop("`clump mol` needs molecule ids: fix ID all property/atom mol");
    if (domain->dimension != 3) stop("the dimension must be 3");
    if (domain->triclinic) stop("the box must not be triclinic");
    if (strstr(update->integrate_style, "respa")) stop("run_style must be verlet");
    place_walls();
    if (!emissivity.of_atom.empty()) need(emissivity.of_atom);
    if (!solid.of_atom.empty()) need(solid.of_atom);
    for (const Property *property : {&contact, &film, &gas})
        if (!property->of_atom.empty()) need(property->of_atom);
    if (contact.given()) refuse_conduction();
    if (!heat_every) return;

    if (temperature.empty()) temperature = known("temperature") && known("heatflow") ? "temperature" : "d_T";
    need(temperature);
    if (clumps && temperature == "temperature")
        stop("`clump` needs temperatures that this fix steps: fix ID all property/atom d_T, and `temperature d_T`");
    for (size_t type = 1; clumps && type < cp.table.size(); type++)
        if (cp.table[type].kelvin != cp.table[1].kelvin || cp.table[type].value != cp.table[1].value)
            stop("`clump` needs one table of cp for all types");
    if (temperature != "temperature") {
        if (!cp.given()) stop("`cp C`, heat per mass and kelvin, is missing");
        if (!cp.of_atom.empty()) need(cp.of_atom);
        return;
    }
    bool stepped = false;
    for (int i = 0; i < modify->nfix; i++) stepped = stepped || !strcmp(modify->fix[i]->style, "heat/flow");
    if (!stepped) stop("nothing steps the temperatures: fix ID all heat/flow constant CP");
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
    before = facts();
    radiation.rows_made = radiation.rows_followed = radiation.powers_found = 0;
    refuse_second();
    make_rows();
    if (heat_every) find_powers();

    const fibrad_insitu_facts now = facts();
    double bytes = (double)now.bytes;
    MPI_Allreduce(MPI_IN_PLACE, &bytes, 1, MPI_DOUBLE, MPI_MAX, world);
    say(text("fix fibrad: %.0f particles, %s, %.0f entries, at most %.1f MB a rank, rows in %.2g s",
             (double)now.particles, now.cutoff > 0 ? text("cutoff %g", now.cutoff).c_str() : "no cutoff",
             (double)now.entries, bytes / 1e6, now.seconds_rows - before.seconds_rows));
}

fibrad_insitu_facts FixFibrad::facts() const {
    fibrad_insitu_facts now;
    fibrad_insitu_facts_get(radiation.insitu, &now);
    return now;
}

// Says what the elements of the global vector are, and what atoms have.
void FixFibrad::list_output() {
    const int walls = (int)radiation.walls;
    std::string names, list = ": [1] surroundings";
    for (uint32_t k = 0; k < radiation.openings; k++)
        list +=
            std::string(" by opening ") + wall_plane_names[2 * radiation.opening[k].axis + radiation.opening[k].upper];
    list += ", [2] beyond, [3] error, [4] [5] seconds";
    for (int w = 0; w < walls; w++) {
        list += text(", [%d] wall %s", 6 + w, radiation.name[w]);
        names += text(", [%d] T of wall %s", 9 + walls + w, radiation.name[w]);
    }
    list += text(", [%d] outside, [%d] overlapping, [%d] behind", 6 + walls, 7 + walls, 8 + walls) + names;
    list += text(", [%d] gone", 9 + 2 * walls);
    if (contact.given()) list += text(", [%d] through contacts, [%d] contacts", 10 + 2 * walls, 11 + 2 * walls);
    if (film.given()) list += text(", [%d] gas", 12 + 2 * walls);
    say(text("fix fibrad: f_%s", id) + list);
    if (errors) say(text("fix fibrad: f_%s of atoms: [1] power, [2] beyond, [3] error of the power", id));
}

void FixFibrad::post_run() {
    follow_heatflow();
    const fibrad_insitu_facts now = facts();
    const double rows = now.seconds_rows - before.seconds_rows, powers = now.seconds_powers - before.seconds_powers;
    say(text(
        "fix fibrad: rows made %d times, and of new particles alone %d times, in %.3g s; powers %d times, in %.3g s; "
        "%.0f %% of the run",
        radiation.rows_made, radiation.rows_followed, rows, radiation.powers_found, powers,
        100 * (rows + powers) / std::max(MPI_Wtime() - begun, 1e-9)));
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
        if (moving) stop("no time passes in a rerun, so meshes cannot move");
        return;
    }
    if (update->ntimestep % rows_every == 0) make_rows();
    if (!heat_every) return;
    follow_heatflow();
    select();
    if (have_moved()) make_rows(true);
    find_powers();
    if (temperature == "temperature") return;
    radiation_heat_walls(&radiation, update->dt * heat_every);
    step_temperatures(update->dt * heat_every);
}

// Gives atoms, or clumps as a whole, the heat of a step. A clump with an atom that keeps its temperature keeps its own.
void FixFibrad::step_temperatures(double seconds) {
    double *t = vector(temperature);
    const std::vector<double> each = values(cp);
    std::vector<double> step; // temperature, heat, mass, capacity of each member
    for (size_t k = 0; k < member.size(); k++) {
        const int i = member[k];
        const double m = atom->mask[i] & groupbit ? mass(i) : HUGE_VAL;
        step.insert(step.end(), {t[i], q[i * columns] * seconds, m, m * each[k]});
    }
    fibrad_insitu_bed bed = {};
    bed.n = member.size(), bed.id = tags.data(), bed.clump = clump.data();
    if (clumps) need_good(radiation_sums(&radiation, &bed, step.data(), 4));
    for (size_t k = 0; k < member.size(); k++) {
        const int i = member[k];
        const double *of = &step[4 * k];
        if (!(of[2] < HUGE_VAL)) continue;
        const curve points = cp.table.empty() ? curve() : cp.table[atom->type[i]].points();
        t[i] = points.n ? curve_advance(&points, of[0], of[1] / of[2]) : of[0] + of[1] / of[3];
    }
}

void FixFibrad::select() {
    member.clear();
    tags.clear();
    clump.clear();
    clump.reserve(1); // it is not NULL on ranks without atoms
    for (int i = 0; i < atom->nlocal; i++)
        if (takes_part(i)) {
            member.push_back(i);
            tags.push_back((uint64_t)atom->tag[i]);
            if (!clumps) continue;
            const int64_t molecule = atom->molecule[i];
            if (molecule < 0 || molecule > UINT32_MAX)
                error->one(FLERR, text("fix fibrad: the molecule id %lld of atom %lld is not in [0, %u]",
                                       (long long)molecule, (long long)atom->tag[i], UINT32_MAX));
            clump.push_back((uint32_t)molecule);
        }
}

// The time that meshes go by.
double FixFibrad::time() const { return restarted ? lost : lost + clock_of(update); }

// Puts meshes where they are now.
void FixFibrad::place_meshes() {
    double period[3];
    for (int axis = 0; axis < 3; axis++) period[axis] = domain->periodicity[axis] ? domain->prd[axis] : 0;
    if (moving && mesh_walls_move(&radiation.meshes, period, motions.data(), time())) stop("out of memory");
}

void FixFibrad::place_walls() {
    need_good(radiation_place(&radiation, domain->boxlo, domain->boxhi, domain->periodicity, domain->boundary));
}

// The members and walls at present.
FixFibrad::Bed FixFibrad::present_bed() {
    Bed b = {};
    for (int i : member) {
        b.x.insert(b.x.end(), atom->x[i], atom->x[i] + 3);
        b.radius.push_back(atom->radius[i]);
    }
    b.emissivity = values(emissivity), b.conductivity = conductivities();
    place_walls();
    b.bed = radiation_bed(&radiation, domain->boxlo, domain->boxhi, domain->periodicity);
    b.bed.n = member.size();
    b.bed.id = tags.data();
    b.bed.x = b.x.data();
    b.bed.radius = b.radius.data();
    b.bed.emissivity = b.emissivity.data();
    b.bed.clump = clumps ? clump.data() : nullptr;
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

// The number that seeds rows: the present step if they are made since particles have moved, else the last multiple of
// NROWS.
uint64_t FixFibrad::number_of_rows(bool by_motion) const {
    return (uint64_t)(by_motion ? update->ntimestep : update->ntimestep / rows_every * rows_every);
}

// Makes the rows of all particles.
void FixFibrad::make_rows(bool by_motion) {
    select();
    for (int i : member) std::copy_n(atom->x[i], 3, &rows_x[3 * i]);
    const Bed present = present_bed();
    need_good(radiation_rows(&radiation, &present.bed, number_of_rows(by_motion), false));
    if (rows_file.empty()) return;
    const std::string name = rows_file + "." + std::to_string(update->ntimestep);
    if (fibrad_insitu_write(radiation.insitu, name.c_str())) stop(fibrad_insitu_message(radiation.insitu));
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
            stop(std::string("the fixes ") + id + " and " + other->id + " both radiate from atom " +
                 std::to_string(shared));
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
    if (!name.empty()) stop(name + " conducts through contacts already: leave out `contacts`");
}

// Evaluates a variable.
double FixFibrad::kelvins(const std::string &variable) {
    const int k = input->variable->find(variable.c_str());
    if (k < 0) stop("there is no equal-style variable `" + variable + "`");
    if (!input->variable->equalstyle(k))
        stop("the variable `" + variable + "` is not of equal style; a wall or the surroundings have one temperature");
    const double value = input->variable->compute_equal(k);
    if (!(value >= 0 && value < HUGE_VAL)) stop(text("the temperature v_%s is %g", variable.c_str(), value));
    return value;
}

// Evaluates a variable of equal or atom style for all members.
std::vector<double> FixFibrad::evaluated(const std::string &name) {
    const int k = input->variable->find(name.c_str());
    if (k < 0 || !(input->variable->equalstyle(k) || input->variable->atomstyle(k)))
        stop("there is no variable `" + name + "` of equal or atom style");
    if (input->variable->equalstyle(k)) return std::vector<double>(member.size(), input->variable->compute_equal(k));
    std::vector<double> all(atom->nlocal + 1), value;
    input->variable->compute_atom(k, 0, all.data(), 1, 0);
    for (int i : member) value.push_back(all[i]);
    return value;
}

// Evaluates variables of walls and surroundings.
void FixFibrad::find_temperatures() {
    if (!surroundings.empty()) radiation.surroundings = kelvins(surroundings);
    for (uint32_t k = 0; k < radiation.walls; k++)
        if (!variables[k].empty()) radiation.temperature[k] = kelvins(variables[k]);
}

void FixFibrad::find_powers() {
    select();
    modify->clearstep_compute(); // variables may use computes, which are then needed at steps of heat
    find_temperatures();
    const std::vector<double> h = values(film), t_gas = values(gas);
    modify->addstep_compute(update->ntimestep + heat_every);
    const std::vector<double> t = temperatures(), k = values(contact);
    std::vector<double> power(member.size()), conductance(member.size()), capacity = values(cp);
    check_values(t);
    const Bed present = present_bed();
    if (clumps) need_good(radiation_agree(&radiation, &present.bed, t.data(), "temperatures"));
    capacity.resize(member.size(), HUGE_VAL);
    for (size_t m = 0; m < member.size(); m++)
        capacity[m] = atom->mask[member[m]] & groupbit ? capacity[m] * mass(member[m]) : HUGE_VAL;
    const double seconds = update->dt * heat_every;
    need_good(radiation_powers(&radiation, &present.bed, t.data(), number_of_rows(false), k.data(), capacity.data(),
                               seconds, power.data(), conductance.data()));
    if (film.given())
        need_good(radiation_convect(&radiation, &present.bed, t.data(), h.data(), t_gas.data(), power.data(),
                                    conductance.data()));
    need_good(
        radiation_stable(&radiation, &present.bed, t.data(), capacity.data(), conductance.data(), seconds, heat_every));
    powers_at = update->ntimestep;
    std::fill(q.begin(), q.end(), 0.0);
    for (size_t m = 0; m < member.size(); m++) q[member[m] * columns] = power[m];
    if (errors) find_errors();
}

void FixFibrad::find_errors() {
    std::vector<double> of_rows(2 * member.size());
    if (fibrad_insitu_errors(radiation.insitu, (double(*)[2])of_rows.data()))
        stop(fibrad_insitu_message(radiation.insitu));
    for (size_t k = 0; k < member.size(); k++) std::copy_n(&of_rows[2 * k], 2, lines[member[k]] + 1);
}

// Heats walls as fix heat/flow heats particles: by the present powers, in all steps since the last call.
void FixFibrad::follow_heatflow() {
    if (temperature != "temperature") return;
    radiation_heat_walls(&radiation, update->dt * (double)(update->ntimestep - powers_at));
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
        relative[k] = fibrad_relative_conductivity(relative[k], atom->radius[member[k]], t[k], radiation.sigma);
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
        stop("the temperature " + temperature + of + "0, so it was not set: `set group all " + temperature +
             " T`, or `initial T` of the fix");
    if (!(at_fault[1] > 0 && at_fault[1] < HUGE_VAL))
        stop("the temperature " + temperature + of + text("%g, not above 0", at_fault[1]));
    stop("cp" + of + text("%g, not above 0", at_fault[2]));
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
    if (!there) stop("atoms have no " + name + ": say fix ID all property/atom " + name + " before");
}

// Values of the members.
std::vector<double> FixFibrad::values(const Property &property) {
    std::vector<double> value;
    if (!property.given()) return value;
    if (!property.variable.empty()) return evaluated(property.variable);
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

double FixFibrad::compute_scalar() {
    return radiation.totals.particles + radiation.conducted.particles + radiation.convected;
}

double FixFibrad::compute_vector(int n) {
    const fibrad_insitu_facts now = facts();
    const fibrad_insitu_conducted &conducted = radiation.conducted;
    const double first[] = {radiation.totals.surroundings, now.beyond, now.error, now.seconds_rows, now.seconds_powers};
    const double strays[] = {(double)now.outside, (double)now.overlapping, (double)now.behind};
    const double rest[] = {(double)now.gone, conducted.particles, conducted.contacts, -radiation.convected};
    const int last = 5 + (int)radiation.walls;
    return n < 5                 ? first[n]
           : n < last            ? radiation.totals.wall[n - 5] + conducted.wall[n - 5]
           : n < last + 3        ? strays[n - last]
           : n < size_vector - 4 ? radiation.temperature[n - last - 3]
                                 : rest[n - size_vector + 4];
}

double FixFibrad::memory_usage() { return (double)facts().bytes + (double)(q.capacity() * sizeof(double)); }

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
    std::vector<double> kept(radiation.temperature, radiation.temperature + radiation.walls);
    kept.insert(kept.begin(), (double)radiation.walls);
    kept.push_back(time());
    const int bytes = (int)(kept.size() * sizeof(double));
    fwrite(&bytes, sizeof bytes, 1, file);
    fwrite(kept.data(), sizeof(double), kept.size(), file);
}

void FixFibrad::restart(char *buffer) {
    double there;
    memcpy(&there, buffer, sizeof there);
    if (there != (double)radiation.walls)
        stop(text("there are %u walls, but %g in the restart file", radiation.walls, there));
    std::vector<double> kept(radiation.walls + 1);
    memcpy(kept.data(), buffer + sizeof there, kept.size() * sizeof(double));
    for (uint32_t k = 0; k < radiation.walls; k++)
        if (radiation.words[k]->capacity > 0) radiation.temperature[k] = kept[k];
    lost = kept.back(), restarted = true;
}

// ---- loading --------------------------------------------------------------------------------------------------------

void *FixFibrad::create(void *lmp, int narg, char **arg) { return new FixFibrad((LAMMPS *)lmp, narg, arg); }

// Makes the fix known to a LAMMPS without `plugin load`. fibrad.lmp calls this function.
extern "C" void fibrad_register(LAMMPS *lmp) {
    (*lmp->modify->fix_map)["fibrad"] = (Modify::FixCreator)&FixFibrad::create;
}
