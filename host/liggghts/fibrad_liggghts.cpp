/* fibrad_liggghts.cpp - LIGGGHTS with radiation beside conduction. SPDX-License-Identifier: MIT
 *
 * LIGGGHTS is under the GNU GPL, version 2 or later, and a binary of this program, linked with it, is, too.
 *
 * A fix external calls radiate() every so many steps, before temperatures are integrated. There each particle's
 * heatSource changes by what its radiative power has changed since, so that a source of the script's own stays. The
 * power in the heatSource is kept in a property of the particle, fibradPower, and goes with it from rank to rank. */
#include <atom.h>
#include <domain.h>
#include <fix.h>
#include <fix_external.h>
#include <lammps.h>
#include <library.h>
#include <modify.h>
#include <mpi.h>
#include <update.h>

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "liggghts/liggghts_options.h"

using LAMMPS_NS::Fix;
using LAMMPS_NS::LAMMPS;

namespace {

enum { WRONG_USE = 2, WRONG_INPUT = 3 };

struct Driver {
    liggghts_options options;
    LAMMPS *lmp;
    fibrad_insitu *radiation;
    double sigma; /* in the script's units */
    std::vector<fibrad_body> body;
    std::vector<double> body_temperature, body_emissivity;
    Fix *temperature, *source, *power, *capacity;                 /* properties of particles; of types */
    std::vector<uint64_t> id;                                     /* [own] */
    std::vector<double> emissivity, gain;                         /* [own] */
    fibrad_insitu_totals totals;                                  /* of the powers in use */
    bool radiates;                                                /* there are such */
    LAMMPS_NS::bigint since;                                      /* first step that they heat */
    double heat, heat_surroundings, heat_body[FIBRAD_BODIES_MAX]; /* what they have brought until then */
};

int rank() {
    int rank;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    return rank;
}

/* Ends the program on all ranks, which all come here, with one message. */
[[noreturn]] void stop(int status, const std::string &message) {
    const bool tells = rank() == 0; /* the others end well: mpirun would end the one that tells before it is heard */
    if (tells) std::fprintf(stderr, "fibrad_liggghts: %s\n", message.c_str());
    MPI_Finalize();
    std::exit(tells ? status : 0);
}

void check(const Driver *driver, int status) {
    if (status == FIBRAD_OK) return;
    const std::string step = std::to_string(driver->lmp->update->ntimestep);
    stop(WRONG_INPUT, "step " + step + ": " + fibrad_insitu_message(driver->radiation));
}

/* ---- set up ----------------------------------------------------------------------------------------------------- */

void command(Driver *driver, const std::string &text) { lammps_command(driver->lmp, text.c_str()); }

/* A property of particles or of types by its name; none: stops, saying what would make it. */
Fix *property(Driver *driver, const char *name, const char *style, const char *kind, const char *maker) {
    Fix *fix = driver->lmp->modify->find_fix_property(name, style, kind, 0, 0, "fibrad_liggghts", false);
    if (fix == nullptr && maker != nullptr)
        stop(WRONG_INPUT, std::string("the script has no ") + maker + ": there is no " + name);
    return fix;
}

void find_properties(Driver *driver) {
    const char *conduction = "fix heat/gran/conduction";
    driver->temperature = property(driver, "Temp", "property/atom", "scalar", conduction);
    driver->source = property(driver, "heatSource", "property/atom", "scalar", conduction);
    driver->capacity = property(driver, "thermalCapacity", "property/global", "peratomtype",
                                "fix property/global thermalCapacity peratomtype");
    if (property(driver, "fibradPower", "property/atom", "scalar", nullptr) == nullptr)
        command(driver, "fix fibradPower all property/atom fibradPower scalar yes no no 0");
    driver->power = property(driver, "fibradPower", "property/atom", "scalar", "fix fibradPower");
}

void find_units(Driver *driver) {
    const char *units = driver->lmp->update->unit_style;
    const bool cgs = std::strcmp(units, "cgs") == 0;
    if (!cgs && std::strcmp(units, "si") != 0) stop(WRONG_INPUT, std::string("units are si or cgs, not ") + units);
    driver->sigma = cgs ? 1e3 * FIBRAD_STEFAN_BOLTZMANN : FIBRAD_STEFAN_BOLTZMANN;
    const size_t types = (size_t)driver->lmp->atom->ntypes, given = driver->options.emissivity.size();
    if (given != 1 && given != types)
        stop(WRONG_INPUT, std::to_string(given) + " emissivities for " + std::to_string(types) + " types");
    driver->options.emissivity.resize(types, driver->options.emissivity[0]);
}

void place_walls(Driver *driver) {
    const LAMMPS_NS::Domain *domain = driver->lmp->domain;
    if (domain->triclinic) stop(WRONG_INPUT, "the box is triclinic");
    for (radiant_wall &wall : driver->options.walls) {
        if (!wall.placed) {
            const int axis = wall.body.plane.axis, upper = wall.body.plane.upper;
            if (domain->boundary[axis][upper] != 1)
                stop(WRONG_INPUT, "--wall " + wall.name + ": the box has no fixed end there; say where: T,E,AT");
            wall.body.plane.at = upper ? domain->boxhi[axis] : domain->boxlo[axis];
        }
        driver->body.push_back(wall.body);
        driver->body_temperature.push_back(wall.temperature);
        driver->body_emissivity.push_back(wall.emissivity);
    }
}

/* ---- while it runs ---------------------------------------------------------------------------------------------- */

/* What this rank owns now. */
void take_particles(Driver *driver) {
    const LAMMPS_NS::Atom *atom = driver->lmp->atom;
    const size_t n = (size_t)atom->nlocal;
    driver->id.resize(n);
    driver->emissivity.resize(n);
    driver->gain.resize(n);
    for (size_t i = 0; i < n; ++i) {
        driver->id[i] = (uint64_t)atom->tag[i];
        driver->emissivity[i] = driver->options.emissivity[(size_t)atom->type[i] - 1];
    }
}

double heat_capacity(const Driver *driver, int i) {
    const LAMMPS_NS::Atom *atom = driver->lmp->atom;
    return atom->rmass[i] * driver->capacity->compute_vector(atom->type[i] - 1);
}

/* Explicit steps are stable while a power lasts less than it takes the particle to cool down by it. */
void check_time_step(const Driver *driver) {
    const LAMMPS_NS::Atom *atom = driver->lmp->atom;
    const double seconds = driver->lmp->update->dt * (double)driver->options.every;
    struct {
        double ratio;
        int id;
    } worst = {0, 0}, all;
    for (int i = 0; i < atom->nlocal; ++i) {
        const double r = atom->radius[i], t = driver->temperature->vector_atom[i];
        const double conductance = 16 * M_PI * r * r * driver->emissivity[(size_t)i] * driver->sigma * t * t * t;
        const double ratio = conductance * seconds / heat_capacity(driver, i);
        if (ratio > worst.ratio) worst = {ratio, atom->tag[i]};
    }
    MPI_Allreduce(&worst, &all, 1, MPI_DOUBLE_INT, MPI_MAXLOC, MPI_COMM_WORLD);
    if (!(all.ratio > 1)) return;
    char text[200];
    std::snprintf(text, sizeof text,
                  "particle %d cools down in %.2g of the time between powers: a smaller --every or time step", all.id,
                  1 / all.ratio);
    stop(WRONG_INPUT, text);
}

void make_rows(Driver *driver) {
    const LAMMPS_NS::Atom *atom = driver->lmp->atom;
    const LAMMPS_NS::Domain *domain = driver->lmp->domain;
    fibrad_insitu_bed bed{};
    for (int axis = 0; axis < 3; ++axis) {
        bed.low[axis] = domain->boxlo[axis];
        bed.high[axis] = domain->boxhi[axis];
        bed.periodic[axis] = domain->periodicity[axis];
    }
    bed.body = driver->body.data();
    bed.body_emissivity = driver->body_emissivity.data();
    bed.bodies = (uint32_t)driver->body.size();
    bed.n = driver->id.size();
    bed.id = driver->id.data();
    bed.x = bed.n > 0 ? atom->x[0] : nullptr;
    bed.radius = atom->radius;
    bed.emissivity = driver->emissivity.data();
    check(driver, fibrad_insitu_rows(driver->radiation, &bed, (uint64_t)driver->lmp->update->ntimestep));
}

/* Powers of the rows there are; of new ones where particles have come or gone since. */
void make_powers(Driver *driver) {
    fibrad_insitu_state state{};
    state.sigma = driver->sigma;
    state.surroundings = driver->options.surroundings;
    state.body_temperature = driver->body_temperature.data();
    state.n = driver->id.size();
    state.id = driver->id.data();
    state.temperature = driver->temperature->vector_atom;
    int status = fibrad_insitu_powers(driver->radiation, &state, driver->gain.data(), &driver->totals);
    if (status == FIBRAD_E_STATE) {
        make_rows(driver);
        status = fibrad_insitu_powers(driver->radiation, &state, driver->gain.data(), &driver->totals);
    }
    check(driver, status);
}

/* Adds up what the powers in use have brought until before step `now`, when they end. */
void count_heat(Driver *driver, LAMMPS_NS::bigint now) {
    if (!driver->radiates) return;
    const double seconds = driver->lmp->update->dt * (double)(now - driver->since);
    driver->heat += seconds * driver->totals.particles;
    driver->heat_surroundings += seconds * driver->totals.surroundings;
    for (size_t k = 0; k < driver->body.size(); ++k) driver->heat_body[k] += seconds * driver->totals.body[k];
}

/* Called by the fix external. Setting up a run does not integrate temperatures. */
void radiate(void *context, LAMMPS_NS::bigint step, int n, int *, double **, double **force) {
    Driver *driver = static_cast<Driver *>(context);
    const LAMMPS_NS::bigint first = step + (driver->lmp->update->setupflag ? 1 : 0);
    for (int i = 0; i < n; ++i) std::fill(force[i], force[i] + 3, 0.0);
    count_heat(driver, first);
    take_particles(driver);
    check_time_step(driver);
    if (!driver->radiates || step % driver->options.rows == 0) make_rows(driver);
    make_powers(driver);
    double *source = driver->source->vector_atom, *power = driver->power->vector_atom;
    for (int i = 0; i < n; ++i) {
        source[i] = source[i] - power[i] + driver->gain[(size_t)i];
        power[i] = driver->gain[(size_t)i];
    }
    driver->radiates = true;
    driver->since = first;
}

/* ---- what it comes to ------------------------------------------------------------------------------------------- */

/* Heat in all particles, the same on all ranks. */
double stored_heat(const Driver *driver) {
    double heat = 0, all;
    for (int i = 0; i < driver->lmp->atom->nlocal; ++i)
        heat += heat_capacity(driver, i) * driver->temperature->vector_atom[i];
    MPI_Allreduce(&heat, &all, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    return all;
}

void print_summary(const Driver *driver, double before, double after, double seconds) {
    fibrad_insitu_facts facts;
    fibrad_insitu_facts_get(driver->radiation, &facts);
    if (rank() != 0) return;
    std::printf("particles %" PRIu64 "\nentries %" PRIu64 "\ncutoff %.17g\n", facts.particles, facts.entries,
                facts.cutoff);
    std::printf("heat_before %.17g\nheat_after %.17g\n", before, after);
    std::printf("radiation_particles %.17g\n", driver->heat);
    std::printf("radiation_surroundings %.17g\n", driver->heat_surroundings);
    for (size_t k = 0; k < driver->body.size(); ++k)
        std::printf("radiation_%s %.17g\n", driver->options.walls[k].name.c_str(), driver->heat_body[k]);
    std::printf("conduction_and_sources %.17g\n", after - before - driver->heat);
    std::printf("beyond_mean %.17g\nerror_rms %.17g\n", facts.beyond, facts.error);
    std::printf("seconds_rows %.17g\nseconds_powers %.17g\nseconds %.17g\n", facts.seconds_rows, facts.seconds_powers,
                seconds);
}

void run_script(Driver *driver) {
    lammps_file(driver->lmp, driver->options.script);
    if (driver->lmp->domain->box_exist == 0) stop(WRONG_INPUT, "the script makes no box");
    find_units(driver);
    find_properties(driver);
    place_walls(driver);
    if (driver->lmp->atom->rmass == nullptr || driver->lmp->atom->radius == nullptr)
        stop(WRONG_INPUT, "the script's particles have no radius: atom_style granular");
    if (fibrad_insitu_new(&driver->radiation, MPI_COMM_WORLD, &driver->options.config) != FIBRAD_OK)
        stop(WRONG_INPUT, "out of memory");
    const std::string every = std::to_string(driver->options.every);
    command(driver, "fix fibrad all external pf/callback " + every + " " + every);
    LAMMPS_NS::Modify *modify = driver->lmp->modify;
    Fix *fix = modify->fix[modify->find_fix("fibrad")];
    static_cast<LAMMPS_NS::FixExternal *>(fix)->set_callback(radiate, driver);
}

void run_steps(Driver *driver) {
    const double before = stored_heat(driver), start = MPI_Wtime();
    command(driver, "run " + std::to_string(driver->options.steps));
    count_heat(driver, driver->lmp->update->ntimestep + 1);
    const double after = stored_heat(driver);
    if (driver->options.rows_file != nullptr)
        check(driver, fibrad_insitu_write(driver->radiation, driver->options.rows_file));
    print_summary(driver, before, after, MPI_Wtime() - start);
}

} // namespace

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    Driver driver{};
    int rest;
    std::string wrong;
    const int parsed = liggghts_options_parse(argc, argv, &driver.options, &rest, &wrong);
    if (parsed == OPTIONS_WRONG) stop(WRONG_USE, wrong + "; see fibrad_liggghts --help");
    if (parsed == OPTIONS_HELP) {
        if (rank() == 0) liggghts_options_help();
        MPI_Finalize();
        return 0;
    }
    argv[rest - 1] = argv[0];
    void *lmp;
    lammps_open(argc - rest + 1, argv + rest - 1, MPI_COMM_WORLD, &lmp);
    driver.lmp = static_cast<LAMMPS *>(lmp);
    run_script(&driver);
    run_steps(&driver);
    fibrad_insitu_free(driver.radiation);
    lammps_close(lmp);
    MPI_Finalize();
    return 0;
}
