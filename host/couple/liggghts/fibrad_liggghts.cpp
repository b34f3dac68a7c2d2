/* fibrad_liggghts.cpp - LIGGGHTS with radiation beside conduction. SPDX-License-Identifier: MIT
 *
 * LIGGGHTS is under the GNU GPL, version 2 or later, and a binary of this program, linked with it, is, too.
 *
 * A fix external calls step() in every step, before temperatures are integrated. step() counts the heat of particles
 * that have come or gone, and calls radiate() every --every steps. radiate() adds to each particle's heatSource the
 * change of its radiative power. So heat sources of the script stay. The property fibradPower
 * of a particle is the radiative power that its heatSource has now. It goes with the particle from rank to rank. The
 * property fibradHeat has its heat at the last step. */
#include <atom.h>
#include <domain.h>
#include <fix.h>
#include <fix_external.h>
#include <fix_mesh_surface.h>
#include <lammps.h>
#include <library.h>
#include <modify.h>
#include <mpi.h>
#include <update.h>

#include <algorithm>
#include <cerrno>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "couple/liggghts/liggghts_options.h"

using LAMMPS_NS::Fix;
using LAMMPS_NS::LAMMPS;

namespace {

enum { WRONG_USE = 2, WRONG_INPUT = 3 };

/* A triangle of a mesh of the script. */
struct script_triangle {
    double corner[3][3];
    int id;
};

struct script_mesh {
    LAMMPS_NS::FixMeshSurface *fix;
    uint32_t wall; /* its index */
};

struct Driver {
    liggghts_options options;
    LAMMPS *lmp;
    struct radiation radiation;
    std::vector<script_mesh> mesh;
    Fix *temperature, *source, *power, *known, *capacity;        /* properties of particles, and of types */
    double came, gone;                                           /* heat of particles that have come or gone, here */
    double seen;                                                 /* number of particles that came to be known here */
    std::vector<uint64_t> id;                                    /* [own] */
    std::vector<double> emissivity, gain, heat_capacity;         /* [own] */
    std::vector<double> conductivity;                            /* [own], k*; empty: infinite */
    std::vector<double> conductance, contact_solid;              /* [own], of contacts: power/K, conductivity */
    Fix *film_property, *gas_property;                           /* NULL: by type, or none */
    std::vector<double> film, gas;                               /* [own], coefficient, K; empty: no convection */
    double by_gas;                                               /* heat by convection before `since` */
    bool counts;                                                 /* the heat of particles that come is counted */
    bool radiates;                                               /* there are powers */
    LAMMPS_NS::bigint since;                                     /* first step in which the current powers heat */
    double heat, heat_surroundings, heat_wall[FIBRAD_WALLS_MAX]; /* heat by radiation before that step */
    double through, through_wall[FIBRAD_WALLS_MAX];              /* the same through contacts */
};

int rank() {
    int rank;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    return rank;
}

/* Ends the program with one message. All ranks call it. */
[[noreturn]] void stop(int status, const std::string &message) {
    const bool prints =
        rank() == 0; /* other ranks end with 0, else mpirun would kill rank 0 before its message is out */
    if (prints) std::fprintf(stderr, "fibrad_liggghts: %s\n", message.c_str());
    MPI_Finalize();
    std::exit(prints ? status : 0);
}

void check(const Driver *driver, bool good) {
    if (!good) stop(WRONG_INPUT, driver->radiation.fault);
}

/* ---- set up ----------------------------------------------------------------------------------------------------- */

void command(Driver *driver, const std::string &text) { lammps_command(driver->lmp, text.c_str()); }

/* Finds a property of particles or of types. Without such a property ends the program and names `maker`, the fix that
 * makes it. maker NULL: returns NULL. */
Fix *property(Driver *driver, const char *name, const char *style, const char *kind, const char *maker) {
    Fix *fix = driver->lmp->modify->find_fix_property(name, style, kind, 0, 0, "fibrad_liggghts", false);
    if (fix == nullptr && maker != nullptr)
        stop(WRONG_INPUT, std::string("the script has no ") + maker + ": there is no " + name);
    return fix;
}

void find_properties(Driver *driver) {
    const bool contacts = !driver->options.contact.empty();
    const LAMMPS_NS::Modify *modify = driver->lmp->modify;
    for (int k = 0; k < modify->nfix && contacts; ++k)
        if (std::strncmp(modify->fix[k]->style, "heat/gran", 9) == 0)
            stop(WRONG_INPUT, std::string("fix ") + modify->fix[k]->style +
                                  " of the script conducts through contacts already: leave out --contacts");
    const char *conduction = contacts ? "fix transportequation/scalar" : "fix heat/gran/conduction";
    driver->temperature = property(driver, "Temp", "property/atom", "scalar", conduction);
    driver->source = property(driver, "heatSource", "property/atom", "scalar", conduction);
    driver->capacity = property(driver, "thermalCapacity", "property/global", "peratomtype",
                                "fix property/global thermalCapacity peratomtype");
    command(driver, "fix fibradHeat all property/atom fibradHeat scalar yes no no -1");
    driver->known = property(driver, "fibradHeat", "property/atom", "scalar", "fix fibradHeat");
    if (property(driver, "fibradPower", "property/atom", "scalar", nullptr) == nullptr)
        command(driver, "fix fibradPower all property/atom fibradPower scalar yes no no 0");
    driver->power = property(driver, "fibradPower", "property/atom", "scalar", "fix fibradPower");
    const auto of_particles = [driver](const std::string &name) {
        const std::string maker = "fix property/atom " + name + " scalar";
        return name.empty() ? nullptr : property(driver, name.c_str(), "property/atom", "scalar", maker.c_str());
    };
    driver->film_property = of_particles(driver->options.film_property);
    driver->gas_property = of_particles(driver->options.gas_property);
}

/* Makes one value for all types a value per type. */
void expand(std::vector<double> *values, int ntypes, const char *what) {
    const size_t types = (size_t)ntypes, given = values->size();
    if (given > 1 && given != types)
        stop(WRONG_INPUT, std::to_string(given) + " " + what + " for " + std::to_string(types) + " types");
    if (given == 1) values->resize(types, values->front());
}

/* Checks the options by what no later command of the script can change, once it has made its box. */
void check_box(Driver *driver) {
    const LAMMPS_NS::Domain *domain = driver->lmp->domain;
    const char *units = driver->lmp->update->unit_style;
    if (!radiation_units(&driver->radiation, units))
        stop(WRONG_INPUT, std::string("units are si or cgs, not ") + units);
    const LAMMPS_NS::Atom *atom = driver->lmp->atom;
    const int types = atom->ntypes;
    expand(&driver->options.emissivity, types, "emissivities");
    expand(&driver->options.solid, types, "conductivities of the solid");
    expand(&driver->options.contact, types, "conductivities at contacts");
    expand(&driver->options.film, types, "heat transfer coefficients");
    expand(&driver->options.gas, types, "temperatures of the gas");
    if (domain->triclinic) stop(WRONG_INPUT, "the box is triclinic");
    if (driver->radiation.insitu == nullptr)
        check(driver, radiation_begin(&driver->radiation, MPI_COMM_WORLD, domain->periodicity));
    check(driver,
          radiation_place(&driver->radiation, domain->boxlo, domain->boxhi, domain->periodicity, domain->boundary));
    const fibrad_insitu_bed empty =
        radiation_bed(&driver->radiation, domain->boxlo, domain->boxhi, domain->periodicity);
    check(driver, radiation_check(&driver->radiation, &empty));
    const std::string shape = atom->superquadric_flag != 0 ? "superquadric"
                              : atom->ellipsoid_flag != 0  ? "ellipsoid"
                              : atom->tri_flag != 0        ? "tri"
                                                           : "";
    if (!shape.empty()) stop(WRONG_INPUT, "particles must be spheres, and atom_style " + shape + " has others");
    if (atom->radius_flag == 0 || atom->rmass_flag == 0)
        stop(WRONG_INPUT, "the script's particles have no radius: atom_style granular");
}

/* Takes the place of LIGGGHTS' Modify, so that options are checked before the first run of the script. */
class FirstRun : public LAMMPS_NS::Modify {
  public:
    FirstRun(const LAMMPS_NS::Modify &of, Driver *whose) : Modify(of), driver(whose) {}
    void init() override {
        if (driver != nullptr) check_box(driver);
        driver = nullptr;
        Modify::init();
    }

  private:
    Driver *driver; /* NULL: it was checked */
};

/* The temperature that the script gives to a mesh. NULL: none. */
LAMMPS_NS::ScalarContainer<double> *mesh_temperature(LAMMPS_NS::FixMeshSurface *fix) {
    return fix->triMesh()->prop().getGlobalProperty<LAMMPS_NS::ScalarContainer<double>>("Temp");
}

void find_meshes(Driver *driver) {
    for (uint32_t wall = 0; wall < driver->radiation.walls; ++wall) {
        const wall_words *words = driver->radiation.words[wall];
        if (words->shape != WALL_MESH) continue;
        const int k = driver->lmp->modify->find_fix(words->mesh.path);
        const std::string name = std::string("wall mesh:") + words->mesh.path;
        Fix *fix = k < 0 ? nullptr : driver->lmp->modify->fix[k];
        if (fix == nullptr || std::strncmp(fix->style, "mesh/surface", 12) != 0)
            stop(WRONG_INPUT, name + ": the script has no such fix mesh/surface");
        script_mesh found{static_cast<LAMMPS_NS::FixMeshSurface *>(fix), wall};
        if (words->temperature_text == nullptr && mesh_temperature(found.fix) == nullptr)
            stop(WRONG_INPUT, name + ": the script gives no temperature: add temperature=T");
        driver->mesh.push_back(found);
    }
}

/* ---- while it runs ---------------------------------------------------------------------------------------------- */

double heat_capacity(const Driver *driver, int i) {
    const LAMMPS_NS::Atom *atom = driver->lmp->atom;
    return atom->rmass[i] * driver->capacity->compute_vector(atom->type[i] - 1);
}

/* Takes what is known of the particles that this rank owns now. */
void take_particles(Driver *driver) {
    const LAMMPS_NS::Atom *atom = driver->lmp->atom;
    const size_t n = (size_t)atom->nlocal;
    driver->id.resize(n);
    driver->emissivity.resize(n);
    driver->gain.resize(n);
    driver->conductance.resize(n);
    driver->heat_capacity.resize(n);
    driver->contact_solid.clear();
    driver->film.clear();
    driver->gas.clear();
    for (size_t i = 0; i < n; ++i) {
        const size_t type = (size_t)atom->type[i] - 1;
        driver->id[i] = (uint64_t)atom->tag[i];
        driver->emissivity[i] = driver->options.emissivity[type];
        driver->heat_capacity[i] = heat_capacity(driver, (int)i);
        if (!driver->options.contact.empty()) driver->contact_solid.push_back(driver->options.contact[type]);
        const auto take = [i, type](Fix *given, const std::vector<double> &of_type, std::vector<double> *values) {
            if (given != nullptr || !of_type.empty())
                values->push_back(given != nullptr ? given->vector_atom[i] : of_type[type]);
        };
        take(driver->film_property, driver->options.film, &driver->film);
        take(driver->gas_property, driver->options.gas, &driver->gas);
    }
}

/* Finds k* at the present temperatures. The rows keep it until they are made again. */
void find_conductivities(Driver *driver) {
    const LAMMPS_NS::Atom *atom = driver->lmp->atom;
    driver->conductivity.clear();
    if (driver->options.solid.empty()) return;
    for (int i = 0; i < atom->nlocal; ++i)
        driver->conductivity.push_back(
            fibrad_relative_conductivity(driver->options.solid[(size_t)atom->type[i] - 1], atom->radius[i],
                                         driver->temperature->vector_atom[i], driver->radiation.sigma));
}

/* Gathers all triangles of a mesh at their present positions on rank 0, in the order of ids. A rank may have some of
 * the triangles, or all triangles of a small mesh. */
std::vector<script_triangle> gather_mesh(LAMMPS_NS::FixMeshSurface *fix) {
    LAMMPS_NS::TriMesh *mesh = fix->triMesh();
    const int own = mesh->sizeLocal();
    int ranks;
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    std::vector<script_triangle> part((size_t)own), all;
    for (int t = 0; t < own; ++t) {
        for (int k = 0; k < 3; ++k) mesh->node(t, k, part[(size_t)t].corner[k]);
        part[(size_t)t].id = mesh->id(t);
    }
    const int size = (int)sizeof(script_triangle), bytes = own * size;
    std::vector<int> got((size_t)ranks), start((size_t)ranks + 1);
    MPI_Gather(&bytes, 1, MPI_INT, got.data(), 1, MPI_INT, 0, MPI_COMM_WORLD);
    for (size_t k = 0; k < got.size(); ++k) start[k + 1] = start[k] + got[k];
    all.resize((size_t)(start.back() / size));
    MPI_Gatherv(part.data(), bytes, MPI_BYTE, all.data(), got.data(), start.data(), MPI_BYTE, 0, MPI_COMM_WORLD);
    const auto before = [](const script_triangle &a, const script_triangle &b) { return a.id < b.id; };
    const auto same = [](const script_triangle &a, const script_triangle &b) { return a.id == b.id; };
    std::sort(all.begin(), all.end(), before);
    all.erase(std::unique(all.begin(), all.end(), same), all.end());
    return all;
}

void say(void *, const char *sentence, bool warning) {
    if (rank() == 0) std::fprintf(stderr, "fibrad_liggghts: %s%s\n", warning ? "warning: " : "", sentence);
}

/* Adds the triangles of one mesh as if they came from a file. */
void take_mesh(Driver *driver, const script_mesh &mesh) {
    const std::vector<script_triangle> triangle = gather_mesh(mesh.fix);
    const size_t n = triangle.size();
    std::vector<double> corner(9 * n);
    std::vector<uint64_t> place(n);
    std::vector<uint32_t> solid(n);
    char name[1][SOLID_NAME] = {""};
    for (size_t t = 0; t < n; ++t) {
        std::memcpy(&corner[9 * t], triangle[t].corner, sizeof triangle[t].corner);
        place[t] = (uint64_t)triangle[t].id;
    }
    struct stl stl {};
    stl.n = (uint32_t)n;
    stl.corner = reinterpret_cast<double(*)[3][3]>(corner.data());
    stl.place = place.data();
    stl.solid = solid.data();
    stl.solids = 1;
    stl.name = name;
    mesh_file file = driver->radiation.words[mesh.wall]->mesh;
    const std::string path = std::string("mesh ") + file.path;
    file.name = file.path;
    file.path = path.c_str();
    mesh_walls *meshes = &driver->radiation.meshes;
    uint32_t walls;
    const int status = mesh_walls_add(meshes, MPI_COMM_WORLD, &file, &stl, mesh.wall, &walls);
    if (status != 0) stop(WRONG_INPUT, meshes->messages);
    if (!driver->radiates && meshes->messages[0] != 0) say(driver, meshes->messages, false);
}

/* Takes all meshes anew. */
void place_meshes(void *context) {
    Driver *driver = static_cast<Driver *>(context);
    mesh_walls_free(&driver->radiation.meshes);
    for (const script_mesh &mesh : driver->mesh) take_mesh(driver, mesh);
}

/* The particles that this rank owns now, and walls. Meshes are where they were at the last rows. */
fibrad_insitu_bed present_bed(Driver *driver) {
    const LAMMPS_NS::Atom *atom = driver->lmp->atom;
    const LAMMPS_NS::Domain *domain = driver->lmp->domain;
    take_particles(driver);
    find_conductivities(driver);
    fibrad_insitu_bed bed = radiation_bed(&driver->radiation, domain->boxlo, domain->boxhi, domain->periodicity);
    bed.n = driver->id.size();
    bed.id = driver->id.data();
    bed.x = bed.n > 0 ? atom->x[0] : nullptr;
    bed.radius = atom->radius;
    bed.emissivity = driver->emissivity.data();
    bed.conductivity = driver->options.solid.empty() ? nullptr : driver->conductivity.data();
    return bed;
}

/* The temperatures of meshes that the script gives. They are taken from the script or, if `give`, given to it. */
void share_temperatures(Driver *driver, bool give) {
    for (const script_mesh &mesh : driver->mesh) {
        if (driver->radiation.words[mesh.wall]->temperature_text != nullptr) continue;
        double &of_script = (*mesh_temperature(mesh.fix))(0), &ours = driver->radiation.temperature[mesh.wall];
        (give ? of_script : ours) = give ? ours : of_script;
    }
}

/* Adds the heat that the current powers have brought in the steps before `now`, also to walls that store it. */
void count_heat(Driver *driver, LAMMPS_NS::bigint now) {
    if (!driver->radiates) return;
    const double seconds = driver->lmp->update->dt * (double)(now - driver->since);
    const struct radiation &r = driver->radiation;
    driver->heat += seconds * r.totals.particles;
    driver->heat_surroundings += seconds * r.totals.surroundings;
    driver->through += seconds * r.conducted.particles;
    driver->by_gas += seconds * r.convected;
    for (uint32_t k = 0; k < r.walls; ++k) {
        driver->heat_wall[k] += seconds * r.totals.wall[k];
        driver->through_wall[k] += seconds * r.conducted.wall[k];
    }
    share_temperatures(driver, false);
    radiation_heat_walls(&driver->radiation, seconds);
    share_temperatures(driver, true);
}

/* Counts the heat of particles that have come since the last call, and of those that have gone. `gone` begins with what
 * all particles had at the last step. What those that are still there had is subtracted. */
void count_particles(Driver *driver) {
    double *known = driver->known->vector_atom, left = driver->gone, all = 0;
    for (int i = 0; i < driver->lmp->atom->nlocal; ++i) {
        const double heat = heat_capacity(driver, i) * driver->temperature->vector_atom[i];
        if (known[i] >= 0)
            left -= known[i];
        else
            driver->seen += 1, driver->came += driver->counts ? heat : 0;
        known[i] = heat, all += heat;
    }
    driver->gone = left + all, driver->counts = true;
}

/* Computes powers and gives them to the particles. In the setup of a run no temperatures are integrated, so powers heat
 * from the next step on. */
void radiate(Driver *driver, LAMMPS_NS::bigint step, int n) {
    const LAMMPS_NS::bigint first = step + (driver->lmp->update->setupflag ? 1 : 0);
    count_heat(driver, first);
    struct radiation *r = &driver->radiation;
    const int64_t number = driver->lmp->update->ntimestep;
    const long every = (long)driver->options.every;
    const double *t = driver->temperature->vector_atom;
    const fibrad_insitu_bed bed = present_bed(driver);
    if (!driver->radiates || number % driver->options.rows == 0)
        check(driver, radiation_rows(r, &bed, (uint64_t)number, false));
    share_temperatures(driver, false);
    const double seconds = driver->lmp->update->dt * (double)every, *capacity = driver->heat_capacity.data();
    check(driver, radiation_powers(r, &bed, t, (uint64_t)number, driver->contact_solid.data(), capacity, seconds,
                                   driver->gain.data(), driver->conductance.data()));
    if (driver->film_property != nullptr || !driver->options.film.empty())
        check(driver, radiation_convect(r, &bed, t, driver->film.data(), driver->gas.data(), driver->gain.data(),
                                        driver->conductance.data()));
    check(driver, radiation_stable(r, &bed, t, capacity, driver->conductance.data(), seconds, every));
    double *source = driver->source->vector_atom, *power = driver->power->vector_atom;
    for (int i = 0; i < n; ++i) {
        const double gain = driver->gain[(size_t)i];
        source[i] = source[i] - power[i] + gain;
        power[i] = gain;
    }
    driver->radiates = true;
    driver->since = first;
}

/* The callback of the fix external. */
void step(void *context, LAMMPS_NS::bigint number, int n, int *, double **, double **force) {
    Driver *driver = static_cast<Driver *>(context);
    for (int i = 0; i < n; ++i) std::fill(force[i], force[i] + 3, 0.0);
    count_particles(driver);
    if (number % driver->options.every == 0) radiate(driver, number, n);
}

/* ---- summary ------------------------------------------------------------------------------------------- */

double sum_of_ranks(double own) {
    double all;
    MPI_Allreduce(&own, &all, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    return all;
}

/* The heat in the particles of this rank. */
double stored_heat(const Driver *driver) {
    double heat = 0;
    for (int i = 0; i < driver->lmp->atom->nlocal; ++i)
        heat += heat_capacity(driver, i) * driver->temperature->vector_atom[i];
    return heat;
}

void print_summary(const Driver *driver, double before, double after, double seconds) {
    const bool left = sum_of_ranks(driver->seen - driver->lmp->atom->nlocal) > 0; /* else rounding alone is gone */
    const double came = sum_of_ranks(driver->came), gone = left ? sum_of_ranks(driver->gone) : 0;
    fibrad_insitu_facts facts;
    fibrad_insitu_facts_get(driver->radiation.insitu, &facts);
    const uint32_t walls = driver->radiation.walls;
    const char *const *name = driver->radiation.name;
    if (rank() != 0) return;
    std::printf("particles %" PRIu64 "\nentries %" PRIu64 "\ncutoff %.17g\n", facts.particles, facts.entries,
                facts.cutoff);
    std::printf("heat_before %.17g\nheat_after %.17g\n", before, after);
    std::printf("radiation_particles %.17g\n", driver->heat);
    std::printf("radiation_surroundings %.17g\n", driver->heat_surroundings);
    for (uint32_t k = 0; k < walls; ++k) std::printf("radiation_%s %.17g\n", name[k], driver->heat_wall[k]);
    if (!driver->options.contact.empty()) std::printf("contacts_particles %.17g\n", driver->through);
    for (uint32_t k = 0; k < walls && !driver->options.contact.empty(); ++k)
        std::printf("contacts_%s %.17g\n", name[k], driver->through_wall[k]);
    if (driver->by_gas != 0) std::printf("convection_particles %.17g\n", driver->by_gas);
    for (uint32_t k = 0; k < walls; ++k)
        std::printf("temperature_%s %.17g\n", name[k], driver->radiation.temperature[k]);
    std::printf("heat_came %.17g\nheat_gone %.17g\n", came, gone);
    std::printf("conduction_and_sources %.17g\n",
                after - before - driver->heat - driver->through - driver->by_gas - came + gone);
    std::printf("outside %" PRIu64 "\noverlapping %" PRIu64 "\nbehind %" PRIu64 "\ngone %" PRIu64 "\n", facts.outside,
                facts.overlapping, facts.behind, facts.gone);
    std::printf("beyond_mean %.17g\nerror_rms %.17g\n", facts.beyond, facts.error);
    std::printf("seconds_rows %.17g\nseconds_powers %.17g\nseconds %.17g\n", facts.seconds_rows, facts.seconds_powers,
                seconds);
}

/* LIGGGHTS would end with lines of MPI alone. */
void check_script(const char *path) {
    int fault = 0;
    if (rank() == 0) {
        FILE *file = std::fopen(path, "r");
        if (file == nullptr)
            fault = errno;
        else
            std::fclose(file);
    }
    MPI_Bcast(&fault, 1, MPI_INT, 0, MPI_COMM_WORLD);
    if (fault != 0) stop(WRONG_INPUT, std::string(path) + ": " + std::strerror(fault));
}

void run_script(Driver *driver) {
    void *first = driver->lmp->modify;
    driver->lmp->modify = new FirstRun(*driver->lmp->modify, driver);
    ::operator delete(first); /* what it has is in use */
    lammps_file(driver->lmp, driver->options.script);
    if (driver->lmp->domain->box_exist == 0) stop(WRONG_INPUT, "the script makes no box");
    check_box(driver);
    find_properties(driver);
    find_meshes(driver);
    command(driver, "fix fibrad all external pf/callback 1 1");
    LAMMPS_NS::Modify *modify = driver->lmp->modify;
    Fix *fix = modify->fix[modify->find_fix("fibrad")];
    static_cast<LAMMPS_NS::FixExternal *>(fix)->set_callback(step, driver);
}

void run_steps(Driver *driver) {
    const double before = sum_of_ranks(stored_heat(driver)), start = MPI_Wtime();
    command(driver, "run " + std::to_string(driver->options.steps));
    count_heat(driver, driver->lmp->update->ntimestep + 1);
    count_particles(driver);
    driver->gone -= stored_heat(driver);
    const double after = sum_of_ranks(stored_heat(driver));
    if (driver->options.rows_file != nullptr &&
        fibrad_insitu_write(driver->radiation.insitu, driver->options.rows_file))
        stop(WRONG_INPUT, fibrad_insitu_message(driver->radiation.insitu));
    print_summary(driver, before, after, MPI_Wtime() - start);
}

} // namespace

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    Driver driver{};
    int rest;
    std::string wrong;
    driver.radiation.surroundings = NAN;
    driver.radiation.heats = true;
    driver.radiation.place_meshes = place_meshes;
    driver.radiation.say = say;
    driver.radiation.simulation = &driver;
    const int parsed = liggghts_options_parse(argc, argv, &driver.options, &driver.radiation, &rest, &wrong);
    if (parsed == OPTIONS_WRONG) stop(WRONG_USE, wrong + "; see fibrad_liggghts --help");
    if (parsed == OPTIONS_HELP) {
        if (rank() == 0) liggghts_options_help();
        MPI_Finalize();
        return 0;
    }
    check_script(driver.options.script);
    argv[rest - 1] = argv[0];
    void *lmp;
    lammps_open(argc - rest + 1, argv + rest - 1, MPI_COMM_WORLD, &lmp);
    driver.lmp = static_cast<LAMMPS *>(lmp);
    run_script(&driver);
    run_steps(&driver);
    radiation_free(&driver.radiation);
    lammps_close(lmp);
    MPI_Finalize();
    return 0;
}
