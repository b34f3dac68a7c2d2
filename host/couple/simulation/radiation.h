/* radiation.h - what the fix of LAMMPS and the driver of LIGGGHTS have in common: options, walls, rows, powers, and
 * sentences about them. SPDX-License-Identifier: MIT
 *
 * Functions return false after an error, and `fault` then has a sentence. All but the readers of words are collective.
 * The header is valid C++. */
#ifndef FIBRAD_COUPLE_RADIATION_H
#define FIBRAD_COUPLE_RADIATION_H

#include "bed/wall_words.h"
#include "couple/simulation/mesh_walls.h"

#ifdef __cplusplus
extern "C" {
#endif

#include "text/read_curve.h"

/* The keys of walls that simulations use. */
enum {
    RADIATION_KEYS =
        WALL_AT | WALL_OPEN | WALL_TEMPERATURE | WALL_INSULATED | WALL_EMISSIVITY | WALL_CAPACITY | WALL_SIDES
};

/* The radiation of a simulation. Begin with zeroes, then radiation_begin; end with radiation_free. */
struct radiation {
    MPI_Comm comm;
    fibrad_insitu *insitu;
    fibrad_insitu_config config;
    bool accuracy;                /* this option was given */
    double sigma;                 /* in units of the simulation */
    double surroundings;          /* K; NaN: not given */
    bool conducts;                /* contacts conduct */
    fibrad_insitu_contacts spots; /* the rest of what contacts are */
    char gas_file[500];           /* a table of the conductivity of the gas; "": it is a number */
    struct curve gas;             /* read from it */

    struct radiation_item {
        struct wall_words words;
        bool of_box; /* a side of `box` or `auto` */
    } item[FIBRAD_WALLS_MAX + 6];
    uint32_t items;
    bool files; /* a mesh is a file; else it has a name in the simulation, which gives its triangles */
    bool heats; /* powers are wanted, so walls need temperatures */

    /* Made of the items by radiation_begin. */
    uint32_t walls, openings;
    fibrad_wall wall[FIBRAD_WALLS_MAX];
    const struct wall_words *words[FIBRAD_WALLS_MAX];
    const char *name[FIBRAD_WALLS_MAX];
    double temperature[FIBRAD_WALLS_MAX]; /* K; NaN: it is no number */
    double emissivity[FIBRAD_WALLS_MAX];
    fibrad_plane opening[6];
    struct mesh_walls meshes;

    fibrad_insitu_totals totals;       /* of the last powers, by radiation */
    fibrad_insitu_conducted conducted; /* of the same, through contacts */
    double convected;                  /* what the gas has brought to particles with them */
    double *area;                      /* L^2, [n], exposed, of beds with clumps; NULL: there are none */
    int rows_made, rows_followed, powers_found;
    bool told[FIBRAD_REMARKS], told_parts;
    char fault[2 * WALL_FAULT];

    /* Set by the simulation: puts meshes where they are, before rows are made; prints a sentence on rank 0. */
    void (*place_meshes)(void *simulation);
    void (*say)(void *simulation, const char *sentence, bool warning);
    void *simulation;
};

/* Reads a number from low to high. The whole word must be the number. */
bool radiation_number(const char *word, double low, double high, double *value);

/* The same for a whole number. */
bool radiation_whole(const char *word, int64_t low, int64_t high, int64_t *value);

/* Takes an option of rows: cutoff, tolerance, accuracy, threads, seed, strict. NULL: taken, or "": there is no such
 * option. Else says what its value is, not beginning with "is". */
const char *radiation_option(struct radiation *r, const char *name, const char *word);

/* Reads [lens | hertz] [scale S] [gas KG | gas @FILE] [wall KW] up to another word. Returns the number of words; -1
 * after an error.
 */
int radiation_contact_words(struct radiation *r, const char *const *word, int count);

/* Sets sigma by the units of the simulation. False, without a sentence: they are neither si nor cgs. */
bool radiation_units(struct radiation *r, const char *style);

/* Adds a wall. A plane or an opening replaces an earlier one on its side. `box` has six planes, and so has `auto`. The
 * texts of the words must last until radiation_begin has ended. */
bool radiation_add_wall(struct radiation *r, const struct wall_words *words);

/* Reads a table of values over temperatures on rank 0, and hands it to all ranks. what: the values, in sentences. */
bool radiation_table(struct radiation *r, const char *path, const char *what, double low, double high,
                     struct curve *curve);

/* Checks the options and makes the walls. Sides of `box` along periodic axes are left out. */
bool radiation_begin(struct radiation *r, MPI_Comm comm, const int periodic[3]);

/* Puts planes and openings at the ends of a box. boundary: as LAMMPS has it, 1: the end is fixed. */
bool radiation_place(struct radiation *r, const double low[3], const double high[3], const int periodic[3],
                     const int boundary[3][2]);

/* A bed with these walls and meshes, in a box, without particles. */
fibrad_insitu_bed radiation_bed(const struct radiation *r, const double low[3], const double high[3],
                                const int periodic[3]);

/* Checks the walls of a bed without particles. */
bool radiation_check(struct radiation *r, const fibrad_insitu_bed *bed);

/* Makes all rows. follow: only those of particles that have come. */
bool radiation_rows(struct radiation *r, const fibrad_insitu_bed *bed, uint64_t step, bool follow);

/* Finds power[n], with what contacts bring, and the conductance[n] of contacts. If particles have come or gone, makes
 * their rows before. solid, capacity: [n], conductivity at contacts and heat capacities, if contacts conduct;
 * seconds: of a step of heat. */
bool radiation_powers(struct radiation *r, const fibrad_insitu_bed *bed, const double *temperature, uint64_t step,
                      const double *solid, const double *capacity, double seconds, double *power, double *conductance);

/* Sums up members of clumps, as fibrad_clump_sums. bed: n, id and clump are used. */
bool radiation_sums(struct radiation *r, const fibrad_insitu_bed *bed, double *value, int width);

/* Refuses a clump whose members have different values. values, as a sentence calls them: "temperatures" */
bool radiation_agree(struct radiation *r, const fibrad_insitu_bed *bed, const double *value, const char *values);

/* Adds to power[n] what gas of the temperatures gas[n] brings, with heat transfer coefficients [n], and to
 * conductance[n] half of what this is for each kelvin: the gas follows no particle. */
bool radiation_convect(struct radiation *r, const fibrad_insitu_bed *bed, const double *temperature,
                       const double *coefficient, const double *gas, double *power, double *conductance);

/* Checks that steps of `seconds` for heat are stable: (4 sigma T^3 A e + 2 H) seconds < C, H the conductance of the
 * contacts and half of that to gas. So no particle and no wall overshoots its surroundings, and no difference of
 * temperatures changes its sign. A clump is one particle. capacity: [n] C of particles; infinite: not checked. every:
 * time steps of a step of heat. */
bool radiation_stable(struct radiation *r, const fibrad_insitu_bed *bed, const double *temperature,
                      const double *capacity, const double *conductance, double seconds, long every);

/* Gives walls that store heat what the last powers bring in `seconds`. Not collective. */
void radiation_heat_walls(struct radiation *r, double seconds);

void radiation_free(struct radiation *r);

#ifdef __cplusplus
}
#endif
#endif
