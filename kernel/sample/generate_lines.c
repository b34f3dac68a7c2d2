/* generate_lines.c - writes kernel/sample/line_table.c to standard output, in some minutes.
 *
 * Each set is the best of several candidates. A candidate begins with about half a Fibonacci set and takes many
 * steps of kernel/sample/line.c. Sets that are made at run time are made in the same way with fewer steps. Compile
 * this file with line.c, direction.c, tables.c and -ffp-contract=off. Then all machines write the same file. */
#include "sample/direction.h"
#include "sample/line.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const uint32_t SIZES_WRITTEN[] = {8,   11,  16,  23,  32,  45,  55,  64,   91,   100,
                                         128, 181, 233, 256, 362, 512, 724, 1024, 1448, 2048};
enum { WRITTEN = sizeof SIZES_WRITTEN / sizeof SIZES_WRITTEN[0], LARGEST = 2048 };

/* the weight of pairs within a half, as in fibrad_lines_make */
static const double HALVES = 0.3;

typedef double vector[3];

/* The sum that the steps increase. */
static double height(uint32_t n, const vector *line) {
    double sum = 0;
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t j = i + 1; j < n; j++) {
            double t = line[i][0] * line[j][0] + line[i][1] * line[j][1] + line[i][2] * line[j][2];
            sum += ((i ^ j) & 1 ? 1 : 1 + HALVES) * 2 * sqrt(1 + sqrt(fmax(0, 1 - t * t)));
        }
    return sum;
}

/* Candidate c of the sets of n lines. It begins with the first n of 2 n + c directions. */
static void make_candidate(uint32_t n, uint32_t c, vector *line) {
    static vector scratch[LARGEST];
    const fibrad_line_steps whole = {c % 2 == 0 ? 200 : 50, 1.5, 0.9, 0}, halves = {2000, 1.5, 0.9, HALVES},
                            rest = {100, 1.5, 0.3, HALVES};
    for (uint32_t k = 0; k < n; k++) fibrad_direction(k, 2 * n + c, line[k]);
    fibrad_lines_relax(n, line, scratch, &whole);
    fibrad_lines_halve(n, line, scratch[0]);
    fibrad_lines_relax(n, line, scratch, &halves);
    fibrad_lines_relax(n, line, scratch, &rest);
}

static void make_set(uint32_t n, vector *best) {
    static vector line[LARGEST];
    const uint32_t candidates = n <= 256 ? 24 : n <= 724 ? 4 : 2;
    double highest = 0;
    for (uint32_t c = 0; c < candidates; c++) {
        make_candidate(n, c, line);
        const double found = height(n, (const vector *)line);
        if (found > highest) highest = found, memcpy(best, line, n * sizeof *best);
    }
}

/* Two coordinates of the projection from the south pole, in units of 2^-31. */
static void write_line(const double p[3]) {
    const double side = p[2] < 0 ? -1 : 1, scale = side * 0x1p31 / (1 + side * p[2]);
    const double u = fmin(fmax(nearbyint(scale * p[0]), -INT32_MAX), INT32_MAX);
    const double v = fmin(fmax(nearbyint(scale * p[1]), -INT32_MAX), INT32_MAX);
    printf("{%" PRId32 ",%" PRId32 "},", (int32_t)u, (int32_t)v);
}

/* Bits of the senses of all lines so far. */
static uint32_t senses[256], lines_so_far;

/* Finds the best senses of several searches and lists them. line: as the table has them. */
static void choose_senses(uint32_t n, const vector *line) {
    static vector turned[LARGEST], best[LARGEST];
    static double field[LARGEST];
    const uint64_t searches = n <= 256 ? 2000 : n <= 724 ? 200 : 32;
    double least = HUGE_VAL;
    for (uint64_t draw = 0; draw < searches; draw++) {
        memcpy(turned, line, n * sizeof *turned);
        const double sum = fibrad_lines_orient(n, turned, field, draw);
        if (sum < least) least = sum, memcpy(best, turned, n * sizeof *best);
    }
    for (uint32_t k = 0; k < n; k++, lines_so_far++)
        if (best[k][0] * line[k][0] + best[k][1] * line[k][1] + best[k][2] * line[k][2] < 0)
            senses[lines_so_far / 32] |= UINT32_C(1) << lines_so_far % 32;
}

static void write_senses(void) {
    printf("const uint32_t fibrad_table_senses[] = {\n");
    for (uint32_t w = 0; w <= lines_so_far / 32; w++) printf("0x%08" PRIx32 ",%s", senses[w], w % 8 == 7 ? "\n" : "");
    printf("\n};\n");
}

static void write_set(uint32_t n) {
    static vector line[LARGEST];
    make_set(n, line);
    for (uint32_t k = 0; k < n; k++)
        for (int axis = 0; axis < 3 && line[k][2] < 0; axis++) line[k][axis] = -line[k][axis];
    choose_senses(n, (const vector *)line);
    printf("#if FIBRAD_TABLE_LINES >= %" PRIu32 "\n", n);
    for (uint32_t k = 0; k < n; k++) {
        write_line(line[k]);
        if (k % 4 == 3 || k == n - 1) printf("\n");
    }
    printf("#endif\n");
}

int main(void) {
    printf("/* line_table.c - lines spread evenly, written by kernel/sample/generate_lines.c. "
           "SPDX-License-Identifier: MIT */\n#include \"sample/tables.h\"\n\n/* clang-format off */\n"
           "#if FIBRAD_TABLE_LINES >= 8\n_Alignas(64) const int32_t fibrad_table_lines[][2] = {\n");
    for (int i = 0; i < WRITTEN; i++) write_set(SIZES_WRITTEN[i]);
    printf("};\n");
    write_senses();
    printf("#endif\n");
    return fflush(stdout) != 0 || ferror(stdout) != 0;
}
