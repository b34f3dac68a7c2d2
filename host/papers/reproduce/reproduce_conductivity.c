/* reproduce_conductivity.c - the radiative exchange factor F_E of beds, beside correlations.
 * SPDX-License-Identifier: MIT
 *
 * Checks: two independent programs, and rays followed through a cubic lattice cell by cell. */
#include <math.h>
#include <string.h>

#include "bed/packing.h"
#include "cli/message.h"
#include "papers/reproduce/published.h"
#include "papers/reproduce/reproduce.h"

enum { EMISSIVITIES = 5, LATTICES = 3 };
static const double emissivities[EMISSIVITIES] = {.2, .4, .6, .8, 1};

/* Makes a periodic cell of touching unit spheres. */
static int lattice_cell(struct bed *bed, double edge, int sites, const double site[][3]) {
    int status = STATUS_OK;
    for (int k = 0; k < sites && !status; ++k)
        status = bed_add(bed, &(struct bed_sphere){edge * site[k][0], edge * site[k][1], edge * site[k][2], 1, 0, 0});
    for (int axis = 0; axis < 3; ++axis) bed->period[axis] = edge;
    return status;
}

static int conductivities(struct bed beds[1 + LATTICES], double factor[1 + LATTICES][EMISSIVITIES]) {
    static const double site[4][3] = {{0, 0, 0}, {.5, .5, 0}, {0, .5, .5}, {.5, 0, .5}},
                        wall[2][3] = {{0}, {.5, .5, .5}};
    static const uint32_t paths[1 + LATTICES] = {300, 400000, 200000, 100000};
    for (int k = 0; k <= LATTICES; ++k) beds[k] = bed_empty();
    int status = bed_make_packing(&beds[0], 2000, 1, 1, .586, 1);
    if (!status) status = lattice_cell(&beds[1], 2, 1, site);
    if (!status) status = lattice_cell(&beds[2], 4 / sqrt(3), 2, wall);
    if (!status) status = lattice_cell(&beds[3], 2 * sqrt(2), 4, site);
    for (int k = 0; k <= LATTICES; ++k)
        for (int e = 0; e < EMISSIVITIES && !status; ++e)
            status = grey_conduction(&beds[k], emissivities[e], INFINITY, paths[k], &factor[k][e]);
    return status;
}

static const char conductivity_script[] =
    "set xlabel 'emissivity'\nset ylabel 'F_E = k/(4 {/Symbol s} T^3 d)'\nset xrange [0:1]\nset yrange [0:1.3]\n"
    "set key top left\n"
    "plot $data using 1:2 title 'random bed, solid fraction 0.586: paths' lw 2 lc 1, \\\n"
    "     $data using 1:6 title 'the same: one radiosity per sphere' dt 2 pt 0 lc 1, \\\n"
    "     $data using 1:3 title 'simple cubic' lc 2, \\\n"
    "     $data using 1:4 title 'body-centred cubic' lc 3, $data using 1:5 title 'face-centred cubic' lc 4\n";

int reproduce_conductivity(struct reproduce *reproduce) {
    static const char *const name[1 + LATTICES] = {"random, solid fraction 0.586", "simple cubic", "body-centred cubic",
                                                   "face-centred cubic"};
    static const double check[1 + LATTICES][EMISSIVITIES] = {{.276, .433, .610, .815, 1.061},
                                                             {NAN, NAN, NAN, NAN, 1.2005},
                                                             {.196, .336, .498, .688, .916},
                                                             {.162, .299, .458, .646, .875}};
    struct bed beds[1 + LATTICES];
    double factor[1 + LATTICES][EMISSIVITIES];
    const int status = conductivities(beds, factor);
    for (int k = 0; k <= LATTICES; ++k) bed_free(&beds[k]);
    if (status) return status;
    fputs("emissivity,random,simple_cubic,body_centred,face_centred,random_one_radiosity\n", reproduce->data);
    for (int e = 0; e < EMISSIVITIES; ++e) {
        /* one radiosity per sphere gives the F_E of black spheres, docs/heat.md */
        fprintf(reproduce->data, "%g,%.5f,%.5f,%.5f,%.5f,%.5f\n", emissivities[e], factor[0][e], factor[1][e],
                factor[2][e], factor[3][e], factor[0][EMISSIVITIES - 1]);
        for (int k = 0; k <= LATTICES; ++k)
            if (!isnan(check[k][e]))
                reproduce_compare(reproduce, SOURCE_CHECK, "", check[k][e], factor[k][e], "F_E, %s, emissivity %g",
                                  name[k], emissivities[e]);
    }
    return reproduce_figure(reproduce, "conductivity", conductivity_script);
}

/* Correlations for beds without gas, and random beds of several porosities. */
enum { CORRELATIONS = 2, PACKINGS = 4 };
static const struct {
    const char *name;
    exchange_correlation *factor;
} correlations[CORRELATIONS] = {{"Zehner-Bauer-Schluender", correlation_zehner_bauer_schluender},
                                {"Kunii-Smith", correlation_kunii_smith}};

/* F_E of random beds of equal spheres, ours in the last column. */
static int random_beds(const double porosity[PACKINGS], double factor[PACKINGS][EMISSIVITIES]) {
    int status = STATUS_OK;
    for (int k = 0; k < PACKINGS && !status; ++k) {
        struct bed bed = bed_empty();
        status = bed_make_jammed(&bed, 2000, 1 - porosity[k], 1000, 1);
        for (int e = 0; e < EMISSIVITIES && !status; ++e)
            status = grey_conduction(&bed, emissivities[e], INFINITY, 100, &factor[k][e]);
        bed_free(&bed);
    }
    return status;
}

static const char correlations_script[] =
    "set xlabel 'emissivity'\nset ylabel 'F_E of a correlation over that of the bed'\nset xrange [0.15:1.05]\n"
    "set yrange [0:1.6]\nset key top right\n"
    "name = 'Zehner-Bauer-Schluender Kunii-Smith'\n"
    "plot 1 with lines lc 'black' title 'random bed', \\\n"
    "     for [k=1:2] $data using (abs($1-0.4)<1e-9 ? $2 : 1/0):(column(3+k)/$3) title word(name, k).', porosity 0.40' "
    "lw 2 lc k, \\\n"
    "     for [k=1:2] $data using (abs($1-0.5)<1e-9 ? $2 : 1/0):(column(3+k)/$3) notitle dt 2 pt 0 lc k, \\\n"
    "     1/0 with lines dt 2 lc 'black' title 'the same, porosity 0.50'\n";

int reproduce_correlations(struct reproduce *reproduce) {
    static const double porosity[PACKINGS] = {.36, .4, .45, .5};
    double factor[PACKINGS][EMISSIVITIES];
    const int status = random_beds(porosity, factor);
    if (status) return status;
    fputs("porosity,emissivity,random_bed", reproduce->data);
    for (int c = 0; c < CORRELATIONS; ++c) fprintf(reproduce->data, ",%s", correlations[c].name);
    fputc('\n', reproduce->data);
    for (int k = 0; k < PACKINGS; ++k)
        for (int e = 0; e < EMISSIVITIES; ++e) {
            fprintf(reproduce->data, "%g,%g,%.5f", porosity[k], emissivities[e], factor[k][e]);
            for (int c = 0; c < CORRELATIONS; ++c) {
                const double theirs = correlations[c].factor(emissivities[e], porosity[k], INFINITY);
                reproduce_compare(reproduce, SOURCE_PAPER, "", theirs, factor[k][e],
                                  "F_E, %s, porosity %g, emissivity %g", correlations[c].name, porosity[k],
                                  emissivities[e]);
                fprintf(reproduce->data, ",%.5f", theirs);
            }
            fputc('\n', reproduce->data);
        }
    return reproduce_figure(reproduce, "correlations", correlations_script);
}

/* Spheres that conduct: k*, and F_E of the cubic lattice from 1.2e7 rays along its axes and spherical harmonics up to
 * degree 13, an independent program. Right to 0.0005. */
enum { CONDUCTIVITIES = 5, CONDUCTING = 2 };
static const double conducting_emissivity[CONDUCTING] = {1, .6},
                    exact_lattice[CONDUCTIVITIES][1 + CONDUCTING] = {{.1, .3591, .3430},
                                                                     {.3, .5294, .4614},
                                                                     {1, .8006, .5979},
                                                                     {3, 1.0136, .6745},
                                                                     {10, 1.1350, .7099}};

/* F_E of the cubic lattice and of a random bed of porosity RANDOM_POROSITY, for one k*. */
#define RANDOM_POROSITY .414
static int conducting_beds(const struct bed bed[2], double conductivity, double factor[2][CONDUCTING]) {
    static const uint32_t paths[2] = {100000, 40};
    int status = STATUS_OK;
    for (int b = 0; b < 2; ++b)
        for (int e = 0; e < CONDUCTING && !status; ++e)
            status = grey_conduction(&bed[b], conducting_emissivity[e], conductivity, paths[b], &factor[b][e]);
    return status;
}

/* Compares the lattice with the exact values, the random bed with correlations. Writes a line of data. */
static void compare_conducting(struct reproduce *reproduce, const double *exact, double factor[2][CONDUCTING]) {
    const double k = exact[0];
    fprintf(reproduce->data, "%g", k);
    for (int e = 0; e < CONDUCTING; ++e) {
        const double emissivity = conducting_emissivity[e];
        reproduce_compare(reproduce, SOURCE_CHECK, "", exact[1 + e], factor[0][e],
                          "F_E, simple cubic, emissivity %g, k* %g", emissivity, k);
        fprintf(reproduce->data, ",%.5f,%.5f,%.5f", exact[1 + e], factor[0][e], factor[1][e]);
        for (int c = 0; c < CORRELATIONS; ++c) {
            const double theirs = correlations[c].factor(emissivity, RANDOM_POROSITY, k);
            reproduce_compare(reproduce, SOURCE_PAPER, "", theirs, factor[1][e],
                              "F_E, %s, random, emissivity %g, k* %g", correlations[c].name, emissivity, k);
            fprintf(reproduce->data, ",%.5f", theirs);
        }
    }
    fputc('\n', reproduce->data);
}

static const char conducting_script[] =
    "set xlabel 'k* = k_s/(4 {/Symbol s} T^3 d)'\nset ylabel 'F_E'\nset logscale x\nset format x '%g'\n"
    "set yrange [0:1.3]\nset key top left\n"
    "plot $data using 1:2 with points pt 6 ps 1.5 lc 1 title 'cubic lattice, emissivity 1: exact', \\\n"
    "     $data using 1:3 with lines lw 2 lc 1 title 'ours', \\\n"
    "     $data using 1:7 with points pt 4 ps 1.5 lc 2 title 'emissivity 0.6: exact', \\\n"
    "     $data using 1:8 with lines lw 2 lc 2 title 'ours', \\\n"
    "     $data using 1:4 pt 0 lw 2 lc 3 title 'random bed, porosity 0.414, emissivity 1: ours', \\\n"
    "     $data using 1:5 pt 0 dt 3 lc 3 title 'Zehner-Bauer-Schluender', \\\n"
    "     $data using 1:6 pt 0 dt 4 lc 3 title 'Kunii-Smith'\n";

int reproduce_conducting(struct reproduce *reproduce) {
    struct bed bed[2];
    bed[0] = bed_empty();
    bed[1] = bed_empty();
    int status = lattice_cell(&bed[0], 2, 1, (const double[][3]){{0}});
    if (!status) status = bed_make_packing(&bed[1], 2000, 1, 1, 1 - RANDOM_POROSITY, 1);
    fputs("k", reproduce->data);
    for (int e = 0; e < CONDUCTING; ++e) {
        fprintf(reproduce->data, ",e%g_exact,e%g_ours,e%g_random", conducting_emissivity[e], conducting_emissivity[e],
                conducting_emissivity[e]);
        for (int c = 0; c < CORRELATIONS; ++c)
            fprintf(reproduce->data, ",e%g_%s", conducting_emissivity[e], correlations[c].name);
    }
    fputc('\n', reproduce->data);
    for (int k = 0; k < CONDUCTIVITIES && !status; ++k) {
        double factor[2][CONDUCTING];
        status = conducting_beds(bed, exact_lattice[k][0], factor);
        if (!status) compare_conducting(reproduce, exact_lattice[k], factor);
    }
    bed_free(&bed[0]);
    bed_free(&bed[1]);
    return status ? status : reproduce_figure(reproduce, "conducting", conducting_script);
}
