/* fix_fibrad.h - thermal radiation between the particles of a LAMMPS simulation, walls and surroundings.
 *
 * One source serves LAMMPS of 29 Sep 2021 (Debian 12) and newer. docs/lammps.md has the syntax.
 *
 * Temperatures are stored in one of two places.
 *   atom style with `temperature` and `heatflow`  This fix adds powers to heatflow. `fix heat/flow` steps temperatures.
 *   other atom styles                             Temperatures are a vector of `fix property/atom`. This fix steps
 *                                                 them.
 *
 * SPDX-License-Identifier: MIT. LAMMPS is GPL-2: so are binaries made with its headers. */
#ifndef LMP_FIX_FIBRAD_H
#define LMP_FIX_FIBRAD_H

#include "atom.h"
#include "fix.h"

#include "couple/simulation/radiation.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

class FixFibrad : public Fix {
  public:
    FixFibrad(LAMMPS *, int, char **);
    ~FixFibrad() override;
    int setmask() override;
    void init() override;
    void setup(int) override;
    void post_force(int) override;
    void end_of_step() override;
    void post_run() override;
    double compute_scalar() override;
    double compute_vector(int) override;
    double memory_usage() override;
    void grow_arrays(int) override;
    void copy_arrays(int, int, int) override;
    void set_arrays(int) override;
    int pack_exchange(int, double *) override;
    int unpack_exchange(int, double *) override;
    void write_restart(FILE *) override;
    void restart(char *) override;
    static void *create(void *lmp, int narg, char **arg);

  private:
    // Values over temperature. Empty: none.
    struct Table {
        std::vector<double> kelvin, value;
        bool given() const { return !value.empty(); }
        curve points() const { return {(double *)kelvin.data(), (double *)value.data(), value.size()}; }
    };

    // A value for each atom. A number or a table serves all atoms or one type, or a vector has a number for each atom.
    struct Property {
        std::vector<double> of_type; // [ntypes + 1], by type; empty: not given, or of_atom is set
        std::vector<Table> table;    // [ntypes + 1], by type; empty: there are no tables
        std::string of_atom;         // "d_NAME", the vector; empty: of_type or variable is set
        std::string variable;        // "v_NAME", of equal or atom style; empty: of_type or of_atom is set
        bool given() const { return !of_type.empty() || !of_atom.empty() || !variable.empty(); }
    };

    // The bed at present, with the arrays to which it points.
    struct Bed {
        std::vector<double> x, radius, emissivity, conductivity;
        fibrad_insitu_bed bed;
    };

    // Reading the words of the command from `at` on.
    enum { KEYS = RADIATION_KEYS | WALL_GEOMETRY };
    bool take(const char *what); // whether the next word is this one; if so, moves behind it
    std::string peek() const;    // the next word; "": there is none
    std::string next();
    double number(const std::string &what, double low, double high);
    int count(const char *what, int low);
    bool yes_or_no();
    void read_wall();
    bool read_motion(mesh_motion *);
    void name_walls();
    void read_surroundings();
    void read_temperature();
    void read_group();
    Property read_property(const char *what, double low, double high, bool number_follows = false);
    double read_value(const std::string &what, double low, double high, Table *);
    Table read_table(const std::string &path, const char *what, double low, double high);
    void read_contacts();
    Property read_film(const char *what, double high, bool number_follows);
    void read_option(const std::string &key);
    void read_clumps();

    // Vectors of atoms, of LAMMPS or of fix property/atom.
    double *vector(const std::string &name);      // NULL: there is no such vector, or this rank has no atoms
    bool known(const std::string &name);          // whether any rank has the vector
    void need(const std::string &name);           // stops with an error if a rank with atoms lacks the vector
    std::vector<double> values(const Property &); // [member]
    std::vector<double> evaluated(const std::string &variable); // [member]
    std::vector<double> temperatures();                         // [member]; sets those of 0 K to `initial` first
    std::vector<double> conductivities();                       // [member], relative; empty: infinite
    double mass(int i) const;

    // Steps of the simulation.
    double kelvins(const std::string &variable);
    void find_temperatures(); // of walls and surroundings, from variables
    bool takes_part(int i) const { return atom->mask[i] & (groupbit | kept_bit); }
    void select(); // finds member and tags
    double time() const;
    void place_meshes();
    void place_walls();
    Bed present_bed();
    bool have_moved();
    uint64_t number_of_rows(bool by_motion) const;
    void make_rows(bool by_motion = false);
    void find_powers();
    void find_errors();
    void step_temperatures(double seconds);
    void follow_heatflow();
    void check_values(const std::vector<double> &temperature); // refuses what is not set
    void list_output();
    fibrad_insitu_facts facts() const;
    [[noreturn]] void stop(const std::string &sentence) const;
    void need_good(bool) const;    // stops with the message of an error
    void say(const std::string &); // a line in the log
    void refuse_second();          // stops if another fix radiates from a particle of this one
    void refuse_conduction();      // stops if LAMMPS conducts through contacts, too

    // Arguments of the fix.
    std::vector<std::string> word;  // behind the style
    size_t at;                      // the next word
    int heat_every, rows_every;     // NEVERY and NROWS; heat_every 0: no steps of heat
    Property emissivity, cp, solid; // solid: conductivity of the solid, energy/(time length K); not given: infinite
    Property contact;               // conductivity of the solid at contacts; not given: contacts do not conduct
    Property film, gas;             // heat transfer coefficient to gas, and its temperature; not given: none
    std::string temperature;        // name of the vector of temperatures
    std::string rows_file;          // first part of the names of the files of rows; empty: none
    int kept_bit;                   // bit of group2, whose temperatures this fix does not step; 0: none
    bool errors;                    // whether atoms have errors of their powers
    int columns;                    // values of each atom
    double moved;                   // rows are made anew if particles have moved by so many radii; 0: never
    double initial;                 // temperature of new atoms
    struct radiation radiation;
    std::string surroundings;           // variable of their temperature; empty: it is a number
    std::vector<std::string> variables; // [walls] the same of walls
    std::vector<mesh_motion> motions;   // [meshes]
    bool moving;                        // whether a mesh moves
    bool clumps;                        // whether molecules are clumps

    // State.
    std::vector<double> q;       // [nmax][columns], power of each atom; then its errors
    std::vector<double *> lines; // [nmax], where each atom's values in q begin
    std::vector<double> rows_x;  // [nmax][3], where each atom was when its row was made
    std::vector<int> member;     // atoms of the group that this rank owns
    std::vector<uint64_t> tags;  // [member], their ids
    std::vector<uint32_t> clump; // [member], their molecules, if these are clumps
    bigint set_up;               // step of the last setup
    bigint powers_at;            // step of the last powers
    double lost;                 // time that LAMMPS' clock does not count, since it began anew after a restart
    bool restarted;              // until the first setup after a restart: lost is the time of the restart file

    // Since the beginning of the run.
    double begun;               // s, time when the run began
    fibrad_insitu_facts before; // facts when the run began
};

} // namespace LAMMPS_NS

#endif
