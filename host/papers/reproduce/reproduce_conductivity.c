/* reproduce_conductivity.c - the radiative exchange factor F_E of beds of grey spheres of one temperature each, beside
 * correlations. SPDX-License-Identifier: MIT
 *
 * Checks: two independent programs, and rays followed through a cubic lattice cell by cell. */
#include <math.h>
#include <stdlib.h>

#include "bed/bed_scene.h"
#include "bed/packing.h"
#include "cli/message.h"
#include "cli/progress.h"
#include "conductivity/conductivity.h"
#include "papers/reproduce/reproduce.h"

enum { EMISSIVITIES = 5, LATTICES = 3 };
static const double emissivities[EMISSIVITIES] = {.2, .4, .6, .8, 1};

/* F_E of a periodic bed of unit spheres, as the mean of three axes, with `paths` paths from each sphere. */
static int grey_conduction(const struct bed *bed, double emissivity, uint32_t paths, double *factor) {
    struct progress bar = {0};
    fibrad_run run = {.threads = 1, .progress = progress_stage, .context = &bar};
    struct conduction result = {0};
    double *e = malloc(bed->n * sizeof *e);
    unsigned char *emits = calloc(bed->n, 1);
    const struct conduction_rule rule = {.emissivity = e, .axis = -1, .paths = paths};
    int status = e && emits ? STATUS_OK : message_memory();
    for (uint32_t i = 0; i < bed->n && !status; ++i) e[i] = emissivity;
    if (!status) status = conduction_emitters(bed, NULL, -1, CONDUCTION_MARGIN, "bed", emits, &result);
    if (!status) {
        status = conduction_follow(bed, emits, &rule, &run, &result);
        progress_stop(&bar);
        status = bed_status(bed, "bed", status, &run.fault);
    }
    *factor = status ? NAN : (result.factor[0] + result.factor[1] + result.factor[2]) / 3;
    free(emits);
    free(e);
    return status;
}

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
            status = grey_conduction(&beds[k], emissivities[e], paths[k], &factor[k][e]);
    return status;
}

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
    return STATUS_OK;
}

/* ---- correlations for beds without gas, and random beds of several porosities ---- */

/* P. Zehner, E. U. Schluender, Chem. Ing. Tech. 44 (1972) 1303; R. Bauer, E. U. Schluender, Int. Chem. Eng. 18 (1978)
 * 181; VDI Heat Atlas, section D6.3. Here in the limit of no gas and no conduction through contacts. Read in
 * github.com/ClaRaLibrary/TransiEnt, VDIHeatAtlas.mo, a second source, with the 1.4 of crushed material. The constant
 * 1.25 of spheres: read in a public program for pebble beds (type ZbsBed), which quotes C. G. van Antwerpen et al.,
 * Nucl. Eng. Des. 240 (2010) 1803. */
double correlation_zehner_bauer_schluender(double emissivity, double porosity) {
    const double plates = 1 / (2 / emissivity - 1), shape = 1.25 * pow((1 - porosity) / porosity, 10. / 9);
    return (1 - sqrt(1 - porosity)) * porosity * plates + sqrt(1 - porosity) * (shape + 1) / shape * plates;
}

/* D. Kunii, J. M. Smith, AIChE J. 6 (1960) 71, with the coefficients of S. Yagi, D. Kunii, AIChE J. 3 (1957) 373. Here
 * without gas. Read in a public program for a thermal store after F. G. Battisti et al., Applied Thermal Engineering
 * 183 (2021) 116032, a second source: beta .9. */
double correlation_kunii_smith(double emissivity, double porosity) {
    const double through_void = 1 / (1 + porosity * (1 - emissivity) / (2 * (1 - porosity) * emissivity));
    return .9 * (porosity * through_void + (1 - porosity) * emissivity / (2 - emissivity));
}

enum { CORRELATIONS = 2, PACKINGS = 4 };
static const struct {
    const char *name;
    double (*factor)(double emissivity, double porosity);
} correlations[CORRELATIONS] = {{"Zehner-Bauer-Schluender", correlation_zehner_bauer_schluender},
                                {"Kunii-Smith", correlation_kunii_smith}};

/* F_E of random beds of equal spheres, ours in the last column. */
static int random_beds(const double porosity[PACKINGS], double factor[PACKINGS][EMISSIVITIES]) {
    int status = STATUS_OK;
    for (int k = 0; k < PACKINGS && !status; ++k) {
        struct bed bed = bed_empty();
        status = bed_make_jammed(&bed, 2000, 1 - porosity[k], 1000, 1);
        for (int e = 0; e < EMISSIVITIES && !status; ++e)
            status = grey_conduction(&bed, emissivities[e], 100, &factor[k][e]);
        bed_free(&bed);
    }
    return status;
}

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
                const double theirs = correlations[c].factor(emissivities[e], porosity[k]);
                reproduce_compare(reproduce, SOURCE_PAPER, "", theirs, factor[k][e],
                                  "F_E, %s, porosity %g, emissivity %g", correlations[c].name, porosity[k],
                                  emissivities[e]);
                fprintf(reproduce->data, ",%.5f", theirs);
            }
            fputc('\n', reproduce->data);
        }
    return STATUS_OK;
}
