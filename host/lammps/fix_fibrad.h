/* fix_fibrad.h - thermal radiation between the particles of a LAMMPS simulation, walls and surroundings.
 *
 * One source for LAMMPS of 29 Sep 2021 (Debian 12) and newer; docs/lammps.md has the syntax. Temperatures are the
 * atom's own where the atom style has `temperature` and `heatflow`: then `fix heat/flow` steps them. Otherwise they are
 * a vector of `fix property/atom`, which this fix steps itself.
 *
 * SPDX-License-Identifier: MIT. LAMMPS is GPL-2: so are binaries made with its headers. */
#ifndef LMP_FIX_FIBRAD_H
#define LMP_FIX_FIBRAD_H

#include "fix.h"

#include "couple/walls/mesh_walls.h"

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
    static void *create(void *lmp, int narg, char **arg);

  private:
    // a number, a number per type, or a vector of fix property/atom
    struct Property {
        std::vector<double> of_type; // [ntypes + 1]; empty: not given, or of_atom
        std::string of_atom;         // "d_NAME"
        bool given() const { return !of_type.empty() || !of_atom.empty(); }
    };

    class Words;
    void read_wall(Words &);
    void read_opening(Words &, int face);
    void read_mesh(Words &);
    void tell_of_meshes(uint32_t first, uint32_t bodies, const std::string &path);
    void read_temperature(Words &);
    Property read_property(Words &);
    double *vector(const std::string &name);
    bool known(const std::string &name);
    void need(const std::string &name);
    std::vector<double> values(const Property &);
    double mass(int i) const;
    void select();
    void make_rows();
    void find_powers();
    void check_step(const std::vector<double> &temperature);
    void check(int status);
    void say(const std::string &);

    int heat_every, rows_every;
    Property emissivity, cp;
    std::string temperature, rows_file;
    double surroundings, sigma, initial;
    fibrad_insitu_config config;
    std::vector<fibrad_body> walls;
    std::vector<fibrad_plane> openings;
    std::vector<double> wall_temperature, wall_emissivity;
    mesh_walls meshes;
    std::vector<int> wall_face; // 2 axis + upper where the wall is a face of the box, otherwise -1

    fibrad_insitu *insitu;
    fibrad_insitu_totals totals;
    std::vector<double> q;      // [nmax] power of each atom
    std::vector<int> member;    // atoms of the group that this rank owns
    std::vector<uint64_t> tags; // [member]
    bool warned, cut_warned;

    // since the run began
    double begun;
    fibrad_insitu_facts before;
    int rows_made, powers_found;
};

} // namespace LAMMPS_NS

#endif
