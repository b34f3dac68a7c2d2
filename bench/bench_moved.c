/* bench_moved.c - what keeping rows of a moving bed saves, and what it costs in accuracy. SPDX-License-Identifier: MIT
 *
 *     bench_moved [quick | BED...]      default: a random periodic bed of 2000
 *
 * CSV on standard output. Per motion, its amplitude per step, number of steps and error allowed: rows computed anew and
 * processor time, per step and as fractions of those of all rows; then, over all rows as they stand after the last step
 * against rows computed anew by the same rule, the largest and root mean square error, the median of estimate over
 * error, the largest excess of an error over its estimate (negative if there is none), and the fraction of rows with
 * one. `inf`: nothing is computed anew. */
#include "bed/packing.h"
#include "bench_bed.h"
#include "bed/moving_rows.h"
#include "read/read.h"

#define PI 3.14159265358979323846

enum { DIRECTIONS = 100 };

enum motion { JITTER, SHEAR, COLUMN, FEW, LOCAL, MOTIONS };
static const char *const names[MOTIONS] = {"jitter", "shear", "column", "few", "local"};

/* Where everything is after `step` steps; amplitudes are per step.
 * jitter: every sphere by at most that many radii along each axis, in a new direction each step;
 * shear: along x, in layers of different y, with at most that much strain;
 * column: spheres at the axis of the bed sink by that many radii, the others the less the farther they are;
 * few: one sphere in hundred moves along x, by that many radii; local: so do all near the middle of the bed. */
static void move(struct bed *to, const struct bed *from, enum motion motion, double amplitude, int step) {
    const double *c[3] = {from->x, from->y, from->z};
    double low[3], high[3], *at[3] = {to->x, to->y, to->z};
    for (int axis = 0; axis < 3; ++axis) {
        low[axis] = high[axis] = c[axis][0];
        for (uint32_t i = 0; i < from->n; ++i)
            low[axis] = fmin(low[axis], c[axis][i]), high[axis] = fmax(high[axis], c[axis][i]);
    }
    const double width = from->period[1] > 0 ? from->period[1] : high[1] - low[1], wave = 2 * PI / width;
    for (uint32_t i = 0; i < from->n; ++i) {
        const double r = from->r[i], way = step * amplitude * r;
        double d[3];
        for (int axis = 0; axis < 3; ++axis) d[axis] = c[axis][i] - (low[axis] + high[axis]) / 2;
        const double across = d[0] * d[0] + d[1] * d[1];
        if (motion == JITTER)
            for (int axis = 0; axis < 3; ++axis)
                at[axis][i] +=
                    amplitude * r * (2 * bed_make_random((uint64_t)step, 3 * (uint64_t)i + (uint64_t)axis) - 1);
        if (motion == SHEAR) at[0][i] = c[0][i] + step * amplitude / wave * sin(wave * d[1]);
        if (motion == COLUMN) at[2][i] = c[2][i] - way * exp(-16 * across / (width * width));
        if (motion == FEW && i % 100 == 0) at[0][i] = c[0][i] + way;
        if (motion == LOCAL && across + d[2] * d[2] < 16 * r * r) at[0][i] = c[0][i] + way;
    }
}

static double processor(void) { return (double)clock() / CLOCKS_PER_SEC; }

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Prints the errors of the rows as they stand. */
static void print_errors(const struct moving *moving, const struct moving *anew) {
    double worst = 0, square = 0, excess = -INFINITY, *ratio = bench_array(moving->n, sizeof *ratio);
    uint32_t above = 0, ratios = 0;
    for (uint32_t i = 0; i < moving->n; ++i) {
        const double e = bench_distance(bench_row_entries(&moving->row[i]), bench_row_entries(&anew->row[i])),
                     estimate = moving->error[i];
        worst = fmax(worst, e);
        square += e * e;
        if (e == 0) continue;
        ratio[ratios++] = estimate / e;
        excess = fmax(excess, e - estimate);
        above += e > estimate;
    }
    if (ratios > 0) qsort(ratio, ratios, sizeof *ratio, ascending);
    printf("%.2g,%.2g,%.2f,%.1e,%.5f\n", worst, sqrt(square / moving->n), ratios > 0 ? ratio[ratios / 2] : 0, excess,
           (double)above / moving->n);
    fflush(stdout);
    free(ratio);
}

static int bench(const char *name, const struct bed *bed, enum motion motion, double amplitude, int steps,
                 double allowed) {
    struct bed now;
    bed_init(&now);
    int status = bed_make_copies(&now, bed, (const uint32_t[3]){1, 1, 1});
    struct moving moving = {0}, anew = {0};
    const fibrad_beam_rule rule = {.directions = DIRECTIONS};
    double full = -processor(), stepping = 0, redone = 0;
    if (!status) status = moving_begin(&moving, bed, &rule, 1);
    full += processor();
    for (int step = 1; step <= steps && !status; ++step) {
        move(&now, bed, motion, amplitude, step);
        stepping -= processor();
        status = moving_step(&moving, &now, allowed);
        stepping += processor();
        redone += moving.redone;
    }
    full -= processor();
    if (!status) status = moving_begin(&anew, &now, &rule, 1);
    full += processor();
    if (!status) {
        printf("%s,%s,%g,%d,%g,%.4f,%.4f,", name, names[motion], amplitude, steps, allowed, redone / steps / bed->n,
               2 * stepping / steps / full);
        print_errors(&moving, &anew);
    }
    moving_end(&moving);
    moving_end(&anew);
    bed_free(&now);
    return status;
}

static int bench_bed(const char *name, const struct bed *bed, bool quick) {
    static const double amplitudes[] = {1e-1, 1e-2, 1e-3, 1e-4}, allowed[] = {1e-3, 3e-3, 1e-2};
    int status = 0;
    for (enum motion motion = JITTER; motion < MOTIONS && !status; ++motion) {
        for (size_t a = quick ? 3 : 0; a < 4 && !status; ++a)
            status = bench(name, bed, motion, amplitudes[a], 1, INFINITY);
        for (size_t a = 1; a < (quick ? 2 : 3); ++a)
            for (size_t e = 0; e < (quick ? 1 : 3) && !status; ++e)
                status = bench(name, bed, motion, amplitudes[a], 10, allowed[e]);
    }
    return status;
}

int main(int argc, char **argv) {
    const bool quick = argc == 2 && strcmp(argv[1], "quick") == 0;
    bench_preamble("bench_moved: 100 directions, exact areas, one thread", 1);
    puts(
        "bed,motion,amplitude,steps,allowed,rows_redone,time,error_max,error_rms,estimate_over_error,excess_max,above");
    struct bed bed;
    int status = 0;
    if (quick || argc == 1) {
        bed_init(&bed);
        status = bed_make_packing(&bed, quick ? 200 : 2000, 0.8, 1.2, 0.55, 1);
        if (!status) status = bench_bed("random", &bed, quick);
        bed_free(&bed);
    }
    for (int k = 1; k < argc && !quick && !status; ++k) {
        status = read_bed(argv[k], &(struct read_options){0}, &bed);
        if (!status) status = bench_bed(argv[k], &bed, false);
        bed_free(&bed);
    }
    return status;
}
