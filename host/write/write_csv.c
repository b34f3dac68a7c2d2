/* write_csv.c - view factors as comma-separated values i,j,F, or exchange factors i,j,D. SPDX-License-Identifier: MIT
 */
#include <gsl/gsl_math.h>
#include <inttypes.h>

#include "cli/interrupt.h"
#include "cli/message.h"
#include "write/write.h"

static int64_t csv_name(const struct contents *what, uint32_t i) { return bed_name(what->bed, i); }

static void write_entry(FILE *file, int64_t i, int64_t j, double f) {
    if (f > 0) fprintf(file, "%" PRId64 ",%" PRId64 ",%.17g\n", i, j, f);
}

static double wall_factor(const struct contents *what, uint32_t i, uint32_t wall) {
    return what->factors->matrix.body[(size_t)i * what->walls->count + wall];
}

/* From sphere i to the surroundings, j = -1, to the walls, j = -2, -3 ... in the order given, and beyond a cutoff, the
 * next j. */
static void write_outside(FILE *file, const struct contents *what, uint32_t i) {
    write_entry(file, csv_name(what, i), -1, what->factors->matrix.escaped[i]);
    for (uint32_t k = 0; k < what->walls->count; ++k)
        write_entry(file, csv_name(what, i), -2 - (int64_t)k, wall_factor(what, i, k));
    write_entry(file, csv_name(what, i), -2 - (int64_t)what->walls->count, what->factors->matrix.beyond[i]);
}

/* From the walls of finite area to the spheres, by reciprocity. */
static int write_walls(FILE *file, const struct contents *what) {
    const struct bed *bed = what->bed;
    for (uint32_t k = 0; k < what->walls->count; ++k) {
        if (interrupt_status()) return interrupt_status();
        const double weight = what->factors->body_area[k] * (what->grey ? what->grey->body_emissivity[k] : 1);
        if (!(weight > 0 && weight < INFINITY)) continue;
        for (uint32_t j = 0; j < bed->n; ++j)
            write_entry(file, -2 - (int64_t)k, csv_name(what, j),
                        4 * M_PI * bed->r[j] * bed->r[j] * (what->grey ? what->grey->emissivity[j] : 1) *
                            wall_factor(what, j, k) / weight);
    }
    return STATUS_OK;
}

int write_csv(FILE *file, const struct contents *what) {
    const fibrad_factors *matrix = &what->factors->matrix;
    const bool walls = what->walls && (what->walls->count > 0 || what->grey);
    fputs(what->grey ? "i,j,D\n" : "i,j,F\n", file);
    for (uint32_t i = 0; i < matrix->n; ++i) {
        if (interrupt_status()) return interrupt_status();
        for (uint64_t k = matrix->start[i]; k < matrix->start[i + 1]; ++k)
            write_entry(file, csv_name(what, i), csv_name(what, matrix->col[k]), matrix->f[k]);
        if (walls) write_outside(file, what, i);
    }
    return walls ? write_walls(file, what) : STATUS_OK;
}
