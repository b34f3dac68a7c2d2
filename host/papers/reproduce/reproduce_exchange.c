/* reproduce_exchange.c - exchange factors against distance, from sphere to sphere and from sphere to wall, beside the
 * tables of Johnson, Tari, Baker. SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "bed/bed_scene.h"
#include "bed/packing.h"
#include "cli/message.h"
#include "papers/reproduce/published.h"
#include "papers/reproduce/reproduce.h"

/* Loose beds are shaken. The densest is pushed apart. A layer that is pushed apart to LAYER of solid has 0.64 in its
 * middle. */
enum { CELLS = 7, DENSE = 4, SPHERES = 4 * CELLS * CELLS * CELLS, STRIDE = 5, WALL_PATHS = 100 };
#define LAYER .617
static const fibrad_exchange_rule rule = {.directions = 144, .paths = 1600};

static int make_bed(struct bed *bed, int column) {
    *bed = bed_empty();
    return column < DENSE ? bed_make_shaken(bed, CELLS, johnson_fraction[column], 1)
                          : bed_make_jammed(bed, SPHERES, johnson_fraction[DENSE], 1000, 1);
}

static int make_layer(struct bed *bed, int column) {
    *bed = bed_empty();
    return bed_make_layer(bed, SPHERES, column < DENSE ? johnson_fraction[column] : LAYER, 1000, 1);
}

/* A straight line through factors near one distance, by least squares: sums of 1, u, u^2, f and u f. u is the distance
 * less that one distance. At contact all data lie on one side, so a mean over a bin would be wrong there. */
struct line_fit {
    double sum[5];
};

static void fit_add(struct line_fit *fit, double u, double f) {
    const double term[5] = {1, u, u * u, f, u * f};
    for (int k = 0; k < 5; ++k) fit->sum[k] += term[k];
}

static double fit_at(const struct line_fit *fit) {
    const double *s = fit->sum;
    return (s[2] * s[3] - s[1] * s[4]) / (s[0] * s[2] - s[1] * s[1]);
}

/* Adds a factor to the fits of all distances of a table that are near. The rows of a table are 0.2 apart and more. */
static void add_factor(const struct johnson_table *table, struct line_fit fit[JOHNSON_ROWS], double distance,
                       double f) {
    for (int k = 0; k < JOHNSON_ROWS; ++k) {
        const double u = distance - table->row[k][0], reach = table->row[k][0] > 5 ? .2 : .1;
        if (fabs(u) < reach) fit_add(&fit[k], u, f);
    }
}

/* Factors from sphere i to all other spheres of a periodic bed. */
static void add_row_of_spheres(const struct bed *bed, const fibrad_factors *rows, uint32_t i,
                               const struct johnson_table *table, struct line_fit fit[JOHNSON_ROWS]) {
    const double *const place[3] = {bed->x, bed->y, bed->z};
    uint64_t at = rows->start[i];
    for (uint32_t j = 0; j < bed->n; ++j) {
        const bool here = at < rows->start[i + 1] && rows->col[at] == j;
        const double f = here ? rows->f[at++] : 0;
        double square = 0;
        for (int axis = 0; axis < 3; ++axis) {
            double e = place[axis][j] - place[axis][i];
            e -= bed->period[axis] * round(e / bed->period[axis]);
            square += e * e;
        }
        if (j != i) add_factor(table, fit, sqrt(square), f);
    }
}

static int sphere_to_sphere(const struct bed *bed, const struct johnson_table *table,
                            struct line_fit fit[JOHNSON_ROWS]) {
    fibrad_bed_matrix *factors = NULL;
    unsigned char wanted[SPHERES] = {0};
    for (int i = 0; i < SPHERES; i += STRIDE) wanted[i] = 1;
    const fibrad_bed_rule some = {.wanted = wanted, .raw = 1};
    const fibrad_scene_config box = bed_scene(bed, NULL);
    const int status = grey_factors(bed, &box, &rule, table->emissivity, &some, &factors);
    for (uint32_t i = 0; i < SPHERES && !status; i += STRIDE) add_row_of_spheres(bed, &factors->matrix, i, table, fit);
    fibrad_bed_matrix_free(factors);
    return status;
}

/* Both faces of the layer are equal walls, and both count. */
static int sphere_to_wall(const struct bed *layer, const struct johnson_table *table,
                          struct line_fit fit[JOHNSON_ROWS]) {
    const fibrad_wall wall[2] = {{.kind = FIBRAD_WALL_PLANE, .plane = {.axis = 2, .at = 0}},
                                 {.kind = FIBRAD_WALL_PLANE, .plane = {.axis = 2, .upper = 1, .at = layer->high[2]}}};
    const double wall_emissivity[2] = {table->wall_emissivity, table->wall_emissivity};
    const fibrad_bed_rule raw = {.raw = 1};
    fibrad_bed_matrix *factors = NULL;
    fibrad_scene_config scene = bed_scene(layer, NULL);
    fibrad_exchange_rule walled = rule;
    scene.wall = wall;
    scene.walls = 2;
    walled.wall_emissivity = wall_emissivity;
    walled.paths = WALL_PATHS;
    const int status = grey_factors(layer, &scene, &walled, table->emissivity, &raw, &factors);
    for (uint32_t i = 0; i < layer->n && !status; ++i) {
        add_factor(table, fit, layer->z[i], factors->matrix.wall[2 * i]);
        add_factor(table, fit, layer->high[2] - layer->z[i], factors->matrix.wall[2 * i + 1]);
    }
    fibrad_bed_matrix_free(factors);
    return status;
}

/* Computes all columns of two tables and writes them beside the published ones. to_wall: from sphere to wall. */
static int compare_tables(struct reproduce *reproduce, const struct johnson_table table[JOHNSON_TABLES], bool to_wall) {
    static struct line_fit fit[JOHNSON_TABLES][JOHNSON_FRACTIONS][JOHNSON_ROWS];
    memset(fit, 0, sizeof fit);
    for (int c = 0; c < JOHNSON_FRACTIONS; ++c) {
        struct bed bed;
        int status = to_wall ? make_layer(&bed, c) : make_bed(&bed, c);
        for (int t = 0; t < JOHNSON_TABLES && !status; ++t)
            status =
                to_wall ? sphere_to_wall(&bed, &table[t], fit[t][c]) : sphere_to_sphere(&bed, &table[t], fit[t][c]);
        bed_free(&bed);
        if (status) return status;
    }
    fputs("distance", reproduce->data);
    for (int t = 0; t < JOHNSON_TABLES; ++t)
        for (int c = 0; c < JOHNSON_FRACTIONS; ++c)
            fprintf(reproduce->data, ",e%g_%g_paper,e%g_%g_ours", table[t].emissivity, johnson_fraction[c],
                    table[t].emissivity, johnson_fraction[c]);
    fputc('\n', reproduce->data);
    for (int k = 0; k < JOHNSON_ROWS; ++k) {
        fprintf(reproduce->data, "%g", table[0].row[k][0]);
        for (int t = 0; t < JOHNSON_TABLES; ++t)
            for (int c = 0; c < JOHNSON_FRACTIONS; ++c) {
                const double theirs = table[t].row[k][1 + c], ours = fit_at(&fit[t][c][k]);
                if (theirs > 0)
                    reproduce_compare(reproduce, SOURCE_PAPER, "", theirs, ours,
                                      "D to %s at %.1f r, solid fraction %g, emissivity %g",
                                      to_wall ? "a wall" : "a sphere", table[t].row[k][0], johnson_fraction[c],
                                      table[t].emissivity);
                fprintf(reproduce->data, theirs > 0 ? ",%g,%.5g" : ",,%.5g", theirs > 0 ? theirs : ours, ours);
            }
        fputc('\n', reproduce->data);
    }
    return STATUS_OK;
}

#define CURVES                                                                                                         \
    "set logscale y\nset format y '%g'\nset key bottom left\n"                                                         \
    "plot for [k=0:4] $data using 1:(column(13+2*k)) with lines lw 2 lc k+1 title "                                    \
    "word('0.25 0.35 0.45 0.55 0.64', k+1).': ours', \\\n"                                                             \
    "     for [k=0:4] $data using 1:(column(12+2*k)) with points pt 7 ps .7 lc k+1 title "                             \
    "word('0.25 0.35 0.45 0.55 0.64', k+1).': published'\n"

int reproduce_exchange(struct reproduce *reproduce) {
    const int status = compare_tables(reproduce, johnson_spheres, false);
    return status
               ? status
               : reproduce_figure(reproduce, "exchange",
                                  "set xlabel 'distance of the centres [radii]'\n"
                                  "set ylabel 'D from sphere to sphere, emissivity 0.86, by solid fraction'\n" CURVES);
}

int reproduce_exchange_wall(struct reproduce *reproduce) {
    const int status = compare_tables(reproduce, johnson_walls, true);
    return status ? status
                  : reproduce_figure(reproduce, "exchange_wall",
                                     "set xlabel 'distance of the centre from the wall [radii]'\n"
                                     "set ylabel 'D to a wall of emissivity 0.8, spheres 0.86, by solid "
                                     "fraction'\n" CURVES);
}
