/* reproduce_exchange.c - grey spheres: effective conductivity, and exchange factors against distance.
 * SPDX-License-Identifier: MIT
 *
 * Sources: S. Singh, M. Kaviany, Int. J. Heat Mass Transfer 37 (1994) 2579; E. F. Johnson, I. Tari, D. Baker, Powder
 * Technology (2021). Checks: two independent programs, and rays marched through a cubic lattice cell by cell. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bed/bed_scene.h"
#include "bed/packing.h"
#include "cli/message.h"
#include "cli/progress.h"
#include "reproduce/reproduce.h"

#define PI 3.14159265358979323846

enum { EMISSIVITIES = 5, LATTICES = 3 };
static const double emissivities[EMISSIVITIES] = {.2, .4, .6, .8, 1};

static fibrad_run one_thread(struct progress *bar) {
    return (fibrad_run){.threads = 1, .progress = progress_stage, .context = bar};
}

static double *constant(uint32_t n, double value) {
    double *e = malloc(n * sizeof *e);
    for (uint32_t i = 0; e && i < n; ++i) e[i] = value;
    return e;
}

/* F_E of a periodic bed of unit spheres, as the mean of three axes, with `paths` paths from each sphere. */
static int factor_of(const struct bed *bed, double emissivity, uint32_t paths, double *factor) {
    const fibrad_scene_config box = bed_scene(bed, NULL);
    const fibrad_spheres spheres = bed_spheres(bed);
    struct progress bar = {0};
    fibrad_run run = one_thread(&bar);
    double *e = constant(bed->n, emissivity), square = 0;
    fibrad_displacement *moved = calloc(bed->n, sizeof *moved);
    int status = e && moved ? STATUS_OK : message_memory();
    const fibrad_exchange_rule rule = {.emissivity = e, .paths = paths};
    if (!status) {
        status = fibrad_displacements(&box, &spheres, &rule, NULL, &run, moved, NULL);
        progress_stop(&bar);
        status = bed_status(bed, "bed", status, &run.fault);
    }
    for (uint32_t i = 0; i < bed->n && !status; ++i)
        for (int axis = 0; axis < 3; ++axis) square += moved[i].square[axis] / 3;
    *factor = 4 * PI * emissivity * square / (2 * bed->period[0] * bed->period[1] * bed->period[2] * 2);
    free(moved);
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
                        body[2][3] = {{0}, {.5, .5, .5}};
    static const uint32_t paths[1 + LATTICES] = {300, 400000, 200000, 100000};
    for (int k = 0; k <= LATTICES; ++k) bed_init(&beds[k]);
    int status = bed_make_packing(&beds[0], 2000, 1, 1, .586, 1);
    if (!status) status = lattice_cell(&beds[1], 2, 1, site);
    if (!status) status = lattice_cell(&beds[2], 4 / sqrt(3), 2, body);
    if (!status) status = lattice_cell(&beds[3], 2 * sqrt(2), 4, site);
    for (int k = 0; k <= LATTICES; ++k)
        for (int e = 0; e < EMISSIVITIES && !status; ++e)
            status = factor_of(&beds[k], emissivities[e], paths[k], &factor[k][e]);
    return status;
}

static const char conductivity_script[] =
    "set xlabel 'emissivity'\nset ylabel 'F_E = k/(4 {/Symbol s} T^3 d)'\nset xrange [0:1]\nset yrange [0:1.3]\n"
    "set key top left\n"
    "plot $data using 1:2 title 'random bed, solid fraction 0.586: paths' lw 2 lc 1, \\\n"
    "     $data using 1:6 title 'the same: one radiosity per sphere' dt 2 pt 0 lc 1, \\\n"
    "     $data using 1:3 title 'simple cubic' lc 2, 0.9042 * x + 0.1843 with lines dt 2 lc 2 title \\\n"
    "     'Singh, Kaviany (1994), porosity 0.476', \\\n"
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
        for (int k = 0; k <= LATTICES; ++k) {
            char what[80];
            snprintf(what, sizeof what, "F_E, %s, emissivity %g", name[k], emissivities[e]);
            if (!isnan(check[k][e])) reproduce_compare(reproduce, what, SOURCE_CHECK, "", check[k][e], factor[k][e]);
            if (k == 1)
                reproduce_compare(reproduce, what, SOURCE_PAPER, "", .9042 * emissivities[e] + .1843, factor[k][e]);
        }
    }
    return reproduce_figure(reproduce, "conductivity", conductivity_script);
}

/* Bins of the mean exchange factor of pairs by centre distance. */
#define WIDTH  .1
#define CENTRE 2.0
enum { BINS = 36 };

struct curve {
    double sum[BINS];
    uint64_t pairs[BINS];
};

/* The bin of a distance. Bins are centred on CENTRE plus multiples of WIDTH. The first bin has contacts only. */
static int bin_of(double distance) {
    if (distance < CENTRE + .03) return 0;
    return (int)((distance - CENTRE) / WIDTH + .5);
}

static void add_curve(const struct bed *bed, const fibrad_factors *rows, uint32_t i, struct curve *curve) {
    uint64_t at = rows->start[i];
    const double *place[3] = {bed->x, bed->y, bed->z};
    for (uint32_t j = 0; j < bed->n; ++j) {
        const bool here = at < rows->start[i + 1] && rows->col[at] == j;
        const double d = here ? rows->f[at++] : 0;
        double square = 0;
        for (int axis = 0; axis < 3; ++axis) {
            double e = place[axis][j] - place[axis][i];
            e -= bed->period[axis] * round(e / bed->period[axis]);
            square += e * e;
        }
        const int bin = bin_of(sqrt(square));
        if (j == i || bin >= BINS) continue;
        curve->sum[bin] += d;
        ++curve->pairs[bin];
    }
}

static int measure_curve(double fraction, double emissivity, struct curve *curve) {
    struct progress bar = {0};
    fibrad_run run = one_thread(&bar);
    fibrad_bed_factors *factors = NULL;
    struct bed bed;
    bed_init(&bed);
    int status = bed_make_jammed(&bed, 1500, fraction, 1000, 1);
    double *e = constant(1500, emissivity);
    if (!status && !e) status = message_memory();
    const fibrad_exchange_rule rule = {.emissivity = e, .directions = 144, .paths = 400};
    if (!status) {
        const fibrad_scene_config box = bed_scene(&bed, NULL);
        const fibrad_spheres spheres = bed_spheres(&bed);
        status = fibrad_exchange_factors(&box, &spheres, &rule, NULL, &run, &factors);
        progress_stop(&bar);
        status = bed_status(&bed, "bed", status, &run.fault);
    }
    for (uint32_t i = 0; i < bed.n && !status; ++i) add_curve(&bed, &factors->matrix, i, curve);
    fibrad_bed_free(factors);
    bed_free(&bed);
    free(e);
    return status;
}

static const char exchange_script[] =
    "set xlabel 'centre distance [radii]'\nset ylabel 'exchange factor D'\nset logscale y\nset format y '%g'\n"
    "set xrange [1.9:5.6]\n"
    "plot $data using 1:2 title 'solid fraction 0.55' with lines lc 1, $data using 1:3 title '0.64' with lines lc 2, "
    "\\\n"
    "     $data using 1:4 title 'Johnson, Tari, Baker (2021), 0.55' with points pt 7 lc 1, \\\n"
    "     $data using 1:5 title 'the same, 0.64' with points pt 5 lc 2\n";

int reproduce_exchange(struct reproduce *reproduce) {
    static const double fraction[2] = {.55, .64}, distance[5] = {2, 2.4, 3, 4, 5};
    static const double paper[2][5] = {{.0712, .0458, .0214, .0035, .0009}, {.0696, .0417, .0167, .0009, .0003}};
    struct curve curves[2] = {{{0}, {0}}, {{0}, {0}}};
    for (int k = 0; k < 2; ++k) {
        const int status = measure_curve(fraction[k], .86, &curves[k]);
        if (status) return status;
        for (int d = 0; d < 5; ++d) {
            const int bin = bin_of(distance[d]);
            char what[80];
            snprintf(what, sizeof what, "D, solid fraction %g, emissivity 0.86, centre distance %.1f r", fraction[k],
                     distance[d]);
            reproduce_compare(reproduce, what, SOURCE_PAPER, "", paper[k][d],
                              curves[k].sum[bin] / (double)curves[k].pairs[bin]);
        }
    }
    fputs("distance,D_055,D_064,paper_055,paper_064\n", reproduce->data);
    for (int bin = 0; bin < BINS; ++bin) {
        fprintf(reproduce->data, "%.2f,%.6g,%.6g", CENTRE + WIDTH * bin,
                curves[0].sum[bin] / (double)curves[0].pairs[bin], curves[1].sum[bin] / (double)curves[1].pairs[bin]);
        int published = 4;
        while (published >= 0 && bin_of(distance[published]) != bin) --published;
        if (published >= 0)
            fprintf(reproduce->data, ",%g,%g\n", paper[0][published], paper[1][published]);
        else
            fputs(",,\n", reproduce->data);
    }
    return reproduce_figure(reproduce, "exchange", exchange_script);
}
