/* bench_moved.c - what keeping rows of a moving bed saves, and what it costs in accuracy. SPDX-License-Identifier: MIT
 *
 *     bench_moved [quick | BED...]      default: a random periodic bed
 *
 * CSV on standard output. Per motion, amplitude of a step (in radii, of the sphere that moves most) and error allowed:
 * the rows computed anew and processor time per step, as fractions of all rows; and the errors of the rows kept,
 * against rows computed anew by the same rule: the largest and the root mean square over all rows of the last step,
 * which must be below `allowed` (see docs/methods.md section 9). */
#include <math.h>
#include <string.h>

#include "bed_make.h"
#include "bench.h"
#include "message.h"
#include "moving_omp.h"
#include "read.h"

enum { STEPS = 10, DIRECTIONS = 100 };

enum motion { JITTER, SHEAR, COLUMN, FEW, MOTIONS };
static const char *const names[MOTIONS] = {"jitter", "shear", "column", "few"};

/* Where everything is after `step` steps.
 * jitter: every sphere on its own, in any direction, each step anew;
 * shear: along x in proportion to y (z stays, as floors and periods are there);
 * column: the spheres near the axis of the bed sink, the others follow the less the farther they are;
 * few: one sphere in hundred moves, along x. */
static void move(struct bed *to, const struct bed *from, enum motion motion, double amplitude, int step) {
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    const double *c[3] = {from->x, from->y, from->z};
    for (int axis = 0; axis < 3; ++axis)
        for (uint32_t i = 0; i < from->n; ++i)
            low[axis] = fmin(low[axis], c[axis][i]), high[axis] = fmax(high[axis], c[axis][i]);
    const double width = high[1] - low[1];
    for (uint32_t i = 0; i < from->n; ++i) {
        const double way = amplitude * from->r[i];
        double dx = from->x[i] - (low[0] + high[0]) / 2, dy = from->y[i] - (low[1] + high[1]) / 2;
        switch (motion) {
        case JITTER:
            for (int axis = 0; axis < 3; ++axis) {
                const uint64_t draw = 3 * (uint64_t)i + (uint64_t)axis;
                double *at = axis == 0 ? to->x : axis == 1 ? to->y : to->z;
                at[i] += way * (2 * bed_make_random((uint64_t)step, draw) - 1);
            }
            break;
        case SHEAR:
            to->x[i] = from->x[i] + step * amplitude * from->r[0] * dy / width * 2;
            break;
        case COLUMN:
            to->z[i] = from->z[i] - step * amplitude * from->r[0] * exp(-16 * (dx * dx + dy * dy) / (width * width));
            break;
        default:
            if (i % 100 == 0) to->x[i] = from->x[i] + step * way;
        }
    }
}

static double row_distance(const fibrad_row *a, const fibrad_row *b) {
    double square = 0;
    for (uint32_t p = 0, q = 0; p < a->length || q < b->length;) {
        const uint32_t i = p < a->length ? a->col[p] : UINT32_MAX, j = q < b->length ? b->col[q] : UINT32_MAX;
        const double difference = (i <= j ? a->f[p++] : 0) - (j <= i ? b->f[q++] : 0);
        square += difference * difference;
    }
    return sqrt(square);
}

static double processor(void) { return (double)clock() / CLOCKS_PER_SEC; }

static int bench(const char *name, const struct bed *bed, enum motion motion, double amplitude, double allowed) {
    struct bed now;
    bed_init(&now, false, 0);
    int status = bed_make_copies(&now, bed, (const uint32_t[3]){1, 1, 1});
    for (int axis = 0; axis < 3; ++axis) now.period[axis] = bed->period[axis];
    struct moving moving = {0}, anew = {0};
    const fibrad_beam_rule rule = {.directions = DIRECTIONS};
    double full = -processor(), stepping = 0, redone = 0, worst = 0, square = 0;
    if (!status) status = moving_begin(&moving, bed, &rule, 1);
    full += processor();
    for (int step = 1; step <= STEPS && !status; ++step) {
        move(&now, bed, motion, amplitude, step);
        stepping -= processor();
        status = moving_step(&moving, &now, allowed);
        stepping += processor();
        redone += moving.redone;
    }
    double again = -processor();
    if (!status) status = moving_begin(&anew, &now, &rule, 1);
    again += processor();
    full = fmin(full, again);
    for (uint32_t i = 0; i < bed->n && !status; ++i) {
        const double e = row_distance(&moving.row[i], &anew.row[i]);
        worst = fmax(worst, e);
        square += e * e;
    }
    if (!status) {
        printf("%s,%s,%g,%g,%.4f,%.4f,%.2g,%.2g\n", name, names[motion], amplitude, allowed, redone / STEPS / bed->n,
               stepping / STEPS / full, worst, sqrt(square / bed->n));
        fflush(stdout);
    }
    moving_end(&moving);
    moving_end(&anew);
    bed_free(&now);
    return status;
}

static int bench_bed(const char *name, const struct bed *bed, bool quick) {
    static const double amplitudes[] = {1e-2, 1e-3, 1e-4}, allowed[] = {0, 1e-3, 3e-3, 1e-2};
    int status = STATUS_OK;
    for (enum motion motion = JITTER; motion < MOTIONS; ++motion)
        for (size_t a = 0; a < (quick ? 1 : sizeof amplitudes / sizeof *amplitudes); ++a)
            for (size_t e = 0; e < (quick ? 2 : sizeof allowed / sizeof *allowed) && !status; ++e)
                status = bench(name, bed, motion, amplitudes[a], allowed[e]);
    return status;
}

int main(int argc, char **argv) {
    const bool quick = argc == 2 && strcmp(argv[1], "quick") == 0;
    bench_preamble("bench_moved: 100 directions, exact areas, 10 steps; fractions of computing all rows", 1);
    puts("bed,motion,amplitude,allowed,rows_redone,time,error_max,error_rms");
    struct bed bed;
    int status = STATUS_OK;
    if (quick || argc == 1) {
        bed_init(&bed, false, 0);
        status = bed_make_packing(&bed, quick ? 200 : 2000, 0.8, 1.2, 0.55, 1);
        if (!status) status = bench_bed("random", &bed, quick);
        bed_free(&bed);
    }
    for (int k = 1; k < argc && !quick && !status; ++k) {
        status = read_bed(argv[k], &(struct read_options){.frame = -1}, &bed);
        if (!status) status = bench_bed(argv[k], &bed, false);
        bed_free(&bed);
    }
    return status;
}
