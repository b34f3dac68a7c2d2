/* plot_bed.c - a picture of a bed and its view or exchange factors, by gnuplot. SPDX-License-Identifier: MIT */
#include "plot/plot_bed.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/message.h"
#include "plot/gnuplot.h"
#include "plot/plot_data.h"

static const char *kind_of(const struct contents *what) { return what->grey ? "exchange" : "view"; }

static const char *symbol_of(const struct contents *what) { return what->grey ? "D" : "F"; }

/* Prints how much radiation goes to walls and leaves the bed. */
static void print_losses(FILE *script, const struct contents *what, const struct summary *summary) {
    double walls = 0;
    for (uint32_t k = 0; k < what->factors->matrix.walls; ++k) walls += summary->wall_mean[k];
    if (what->factors->matrix.walls > 0)
        fprintf(script, "%.2f %% of the radiation goes to walls, %.2f %% leaves the bed", 100 * walls,
                100 * summary->escaped_mean);
    else
        fprintf(script, "%.2f %% of the radiation leaves the bed", 100 * summary->escaped_mean);
}

static void print_style(FILE *script, const struct output *output, const char *name, const struct contents *what) {
    gnuplot_style(script, output->path, 1500, 1240);
    fputs(GNUPLOT_PALETTE "set multiplot layout 2,2 margins 0.075,0.89,0.065,0.90 spacing 0.15,0.115\n"
                          "set label 1 '",
          script);
    gnuplot_name(script, name);
    struct summary summary;
    summary_make(&summary, what);
    fprintf(script,
            "' at screen 0.015,0.975 font ',19' tc '#111111' noenhanced\n"
            "set label 2 '%u spheres, %llu %s factors; row sums %.4f to %.4f, ",
            what->bed->n, (unsigned long long)what->factors->matrix.start[what->bed->n], kind_of(what),
            summary.row_sum_min, summary.row_sum_max);
    print_losses(script, what, &summary);
    fputs("' at screen 0.015,0.945 tc '#444444'\n", script);
}

/* Draws the slice, coloured by the fraction of radiation that escapes or goes to walls. */
static int print_slice(FILE *script, const struct contents *what, const struct plot_plane *plane) {
    const fibrad_factors *matrix = &what->factors->matrix;
    struct plot_slice slice;
    double *away = malloc(matrix->n * sizeof *away);
    if (!away) return message_memory();
    for (uint32_t i = 0; i < matrix->n; ++i) {
        away[i] = matrix->escaped[i];
        for (uint32_t k = 0; k < matrix->walls; ++k) away[i] += matrix->wall[(size_t)i * matrix->walls + k];
    }
    plot_slice_of(&slice, plane, what->bed, what->walls);
    fprintf(script, "set title '%s, slice at %s'; set cbrange [0:*]\n",
            matrix->walls > 0 ? "Fraction to walls and out of the bed" : "Escaped fraction", slice.place);
    plot_slice_draw(script, &slice, &(struct plot_colours){.value = away, .unit = 1, .wanted = what->wanted});
    fputs("unset label 1; unset label 2\n", script);
    free(away);
    return STATUS_OK;
}

static void print_pairs(FILE *script, const struct contents *what, const struct plot_data *data) {
    fputs("$pairs << END\n", script);
    for (int d = 0; d < PLOT_DISTANCES; ++d)
        for (int f = 0; f < PLOT_FACTORS; ++f)
            fprintf(script, data->pairs[d][f] > 0 ? "%.6g %.6g %.6g\n" : "%.6g %.6g NaN\n",
                    (d + 0.5) * PLOT_DISTANCE_MAX / PLOT_DISTANCES, PLOT_FACTOR_MIN * (1 - (f + 0.5) / PLOT_FACTORS),
                    log10(data->pairs[d][f]));
    fputs("END\n$free << END\n", script);
    for (int k = 0; k <= 200; ++k) {
        const double apart = 1 + (PLOT_DISTANCE_MAX - 1) * k / 200;
        double f12 = NAN;
        fibrad_pair_exact(1, 1, 2 * (apart - 1), &f12);
        fprintf(script, "%.6g %.6g\n", apart, what->grey ? NAN : log10(f12)); /* for view factors only */
    }
    fprintf(script,
            "END\n"
            "set title '%s'\n"
            "set xlabel 'centre distance / (r_i + r_j)'; set ylabel '%s_{ij} r_i / r_j'\n"
            "set xrange [0.8:%g]; set yrange [%g:-0.8]; set xtics 1\n"
            "set ytics ('10^{-6}' -6, '10^{-5}' -5, '10^{-4}' -4, '10^{-3}' -3, '10^{-2}' -2, '10^{-1}' -1)\n"
            "set cbrange [0:*]; set cblabel 'log_{10} of the number of pairs' offset 1; set grid\n"
            "set key top right\n"
            "plot $pairs using 1:2:3 with image notitle, $free with lines lw 2.5 lc '#d1495b' %s\n"
            "unset colorbox; unset cblabel\n",
            what->grey ? "Exchange factor against distance: how far heat is carried"
                       : "View factor against distance: how far the pairs are seen",
            symbol_of(what), PLOT_DISTANCE_MAX, PLOT_FACTOR_MIN,
            what->grey ? "notitle" : "title 'equal spheres, nothing between'");
}

static void print_within(FILE *script, const struct contents *what, const struct plot_data *data) {
    fputs("$within << END\n", script);
    for (int d = 0; d <= PLOT_DISTANCES; ++d)
        fprintf(script, "%.6g %.6g %.6g %.6g\n", d * PLOT_DISTANCE_MAX / PLOT_DISTANCES, data->within[d][0],
                data->within[d][1], data->within[d][2]);
    fprintf(script,
            "END\n"
            "set title 'Where the radiation ends: sum of %s within a distance'\n"
            "set xlabel 'centre distance / mean diameter'; set ylabel 'sum of %s_{ij}'\n"
            "set xrange [0:%g]; set yrange [0:1.02]; set ytics 0.2; set key bottom right\n"
            "plot $within using 1:2:4 with filledcurves fc '#1fa187' fs transparent solid 0.25 noborder "
            "title '10 %% to 90 %% of the spheres', '' using 1:3 with lines lw 2.5 lc '#277f8e' title 'median'\n",
            symbol_of(what), symbol_of(what), PLOT_DISTANCE_MAX);
}

static void print_factors(FILE *script, const struct contents *what, const struct plot_data *data) {
    fputs("$factors << END\n", script);
    for (int f = 0; f < PLOT_FACTORS; ++f)
        fprintf(script, "%.6g %.6g %.6g\n", PLOT_FACTOR_MIN * (1 - (f + 0.5) / PLOT_FACTORS), 100 * data->entries[f],
                100 * data->carried[f]);
    fprintf(script,
            "END\n"
            "set title 'Sizes of the %s factors, and what they carry'\n"
            "set xlabel '%s_{ij}'; set ylabel 'share [%%]'\n"
            "set xrange [%g:-0.8]; set yrange [0:*]; set ytics auto; set key top left\n"
            "set xtics ('<10^{-6}' -6, '10^{-5}' -5, '10^{-4}' -4, '10^{-3}' -3, '10^{-2}' -2, '10^{-1}' -1)\n"
            "set boxwidth 0.9 relative\n"
            "plot $factors using 1:2 with boxes fc '#365c8d' fs transparent solid 0.55 noborder title 'of the "
            "entries', '' using 1:3 with boxes fc '#e9a23b' fs transparent solid 0.65 noborder title 'of the "
            "radiation'\n"
            "unset multiplot\n",
            kind_of(what), symbol_of(what), PLOT_FACTOR_MIN);
}

int plot_bed(const struct output *output, const char *name, const struct contents *what,
             const struct plot_plane *plane) {
    struct gnuplot gnuplot;
    struct plot_data *data = malloc(sizeof *data);
    int status = data ? plot_data_collect(data, what) : message_memory();
    if (!status) status = gnuplot_start(&gnuplot, output);
    if (!status) {
        print_style(gnuplot.script, output, name, what);
        status = print_slice(gnuplot.script, what, plane);
        print_pairs(gnuplot.script, what, data);
        print_within(gnuplot.script, what, data);
        print_factors(gnuplot.script, what, data);
        const int drawn = gnuplot_end(&gnuplot);
        if (!status) status = drawn;
    }
    free(data);
    return status;
}
