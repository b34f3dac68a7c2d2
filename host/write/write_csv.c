/* write_csv.c - view factors as comma-separated values i,j,F, or exchange factors i,j,D. SPDX-License-Identifier: MIT
 */
#include <gsl/gsl_math.h>
#include <inttypes.h>

#include "cli/interrupt.h"
#include "cli/message.h"
#include "write/write.h"

static int64_t name_of(const struct contents *what, uint32_t i) { return what->ids ? what->bed->id[i] : i; }

static void write_line(FILE *file, int64_t i, int64_t j, double f) {
    if (f > 0) fprintf(file, "%" PRId64 ",%" PRId64 ",%.17g\n", i, j, f);
}

/* From sphere i to the surroundings, j = -1, and to the walls, j = -2, -3 ... in the order given. */
static void write_outside(FILE *file, const struct contents *what, uint32_t i) {
    write_line(file, name_of(what, i), -1, what->result->escaped[i]);
    for (uint32_t k = 0; k < what->walls->count; ++k)
        write_line(file, name_of(what, i), -2 - (int64_t)k, what->result->wall[i][what->walls->wall[k]]);
}

/* From the walls of finite area to the spheres, by reciprocity. */
static int write_walls(FILE *file, const struct contents *what) {
    const struct bed *bed = what->bed;
    for (uint32_t k = 0; k < what->walls->count; ++k) {
        const uint32_t wall = what->walls->wall[k];
        const double area = what->result->facts.wall_area[wall];
        if (interrupt_status()) return interrupt_status();
        const double weight = area * (what->grey ? what->grey->wall_emissivity[wall] : 1);
        if (!(weight > 0 && weight < INFINITY)) continue;
        for (uint32_t j = 0; j < bed->n; ++j)
            write_line(file, -2 - (int64_t)k, name_of(what, j),
                       4 * M_PI * bed->r[j] * bed->r[j] * (what->grey ? what->grey->emissivity[j] : 1) *
                           what->result->wall[j][wall] / weight);
    }
    return STATUS_OK;
}

int write_csv(FILE *file, const struct contents *what) {
    const fibrad_rows *rows = &what->result->rows;
    const bool walls = what->walls && (what->walls->count > 0 || what->grey);
    fputs(what->grey ? "i,j,D\n" : "i,j,F\n", file);
    for (uint32_t i = 0; i < rows->n; ++i) {
        if (interrupt_status()) return interrupt_status();
        for (uint64_t k = rows->start[i]; k < rows->start[i + 1]; ++k)
            write_line(file, name_of(what, i), name_of(what, rows->col[k]), rows->f[k]);
        if (walls) write_outside(file, what, i);
    }
    return walls ? write_walls(file, what) : STATUS_OK;
}
