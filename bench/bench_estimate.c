/* bench_estimate.c - whether the estimated error of a row is above its true error. SPDX-License-Identifier: MIT
 *
 *     bench_estimate [quick | BED...]
 *
 * The bench writes CSV to standard output. In several beds, rows of spheres at equal steps of the index are computed
 * with 50 to 6400 directions, raw and averaged. A line compares their estimates with their true Euclidean errors.
 * `honest` is the per cent of true errors below the estimate. `low`, `median` and `high` are quantiles of the estimate
 * over the true error: 5 %, 50 % and 95 % of the rows lie below. The true rows have exact areas and 40000 directions.
 * The beds are those of tests/data, random beds, a lattice, scenes of 3 to 8 spheres, and files named as arguments.
 * `quick` runs these scenes alone. Run the bench from the project's root. */
#include "bed/packing.h"
#include "bench_bed.h"
#include "read/read.h"

enum { ROWS = 64, SCENES = 32, SAMPLES = 512 };

static const uint32_t directions[] = {50, 100, 200, 400, 800, 1600, 6400};
enum {
    STEPS = sizeof directions / sizeof *directions,
    ALL_ROWS = 4
}; /* averaged rows have at most 400 directions, since more take too long */

/* Errors and estimates of rows of one kind. */
struct samples {
    uint32_t count;
    double error[SAMPLES], ratio[SAMPLES];
};

static struct samples kinds[STEPS][2]; /* raw, averaged */

static void note(struct samples *samples, const fibrad_factors *matrix, const fibrad_factors *truth, uint32_t i) {
    if (samples->count == SAMPLES) return;
    const double error = bench_distance(bench_matrix_entries(matrix, i), bench_matrix_entries(truth, i));
    samples->error[samples->count] = error;
    samples->ratio[samples->count++] = error > 0 ? matrix->error[i] / error : 1;
}

static void compare(const struct bed *bed, const fibrad_factors *truth, const unsigned char *wanted, uint32_t step,
                    bool raw) {
    const fibrad_beam_rule rule = {.directions = directions[step]};
    const fibrad_bed_rule options = {.beam = &rule, .raw = raw, .wanted = raw ? wanted : NULL};
    fibrad_bed_matrix *factors = bench_factors(bed, &options, 1);
    for (uint32_t i = 0; i < bed->n; ++i)
        if (wanted[i]) note(&kinds[step][!raw], &factors->matrix, truth, i);
    fibrad_bed_matrix_free(factors);
}

/* Adds the rows of a bed to all kinds. */
static void add(const struct bed *bed) {
    const fibrad_beam_rule rule = {.directions = 40000};
    unsigned char *wanted = bench_array(bed->n, 1);
    const uint32_t rows = bed->n < ROWS ? bed->n : ROWS;
    for (uint32_t k = 0; k < rows; ++k) wanted[(uint64_t)bed->n * (2 * k + 1) / (2 * rows)] = 1;
    fibrad_bed_matrix *truth = bench_factors(bed, &(fibrad_bed_rule){.beam = &rule, .wanted = wanted}, 1);
    for (uint32_t step = 0; step < STEPS; ++step) {
        compare(bed, &truth->matrix, wanted, step, true);
        if (step < ALL_ROWS) compare(bed, &truth->matrix, wanted, step, false);
    }
    fibrad_bed_matrix_free(truth);
    free(wanted);
}

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void print(const char *name) {
    for (uint32_t step = 0; step < STEPS; ++step)
        for (int averaged = 0; averaged < 2; ++averaged) {
            struct samples *s = &kinds[step][averaged];
            uint32_t below = 0;
            if (s->count == 0) continue;
            qsort(s->error, s->count, sizeof *s->error, ascending);
            qsort(s->ratio, s->count, sizeof *s->ratio, ascending);
            while (below < s->count && s->ratio[below] < 1) ++below;
            printf("%s,%u,%d,%u,%.2g,%.1f,%.2f,%.2f,%.2f\n", name, directions[step], averaged, s->count,
                   s->error[s->count / 2], 100.0 * (s->count - below) / s->count, s->ratio[s->count / 20],
                   s->ratio[s->count / 2], s->ratio[s->count * 19 / 20]);
            s->count = 0;
        }
    fflush(stdout);
}

static int finish(int status, struct bed *bed, const char *name) {
    if (!status) add(bed);
    if (!status && name) print(name);
    bed_free(bed);
    return status;
}

static int of_file(const char *path) {
    struct bed bed = {0};
    const int status = read_bed(path, &(struct read_options){0}, &bed);
    return finish(status, &bed, path);
}

static int of_packing(const char *name, uint32_t n, double low, double fraction) {
    struct bed bed = bed_empty();
    const int status = bed_make_packing(&bed, n, low, 1, fraction, 5);
    return finish(status, &bed, name);
}

static int of_lattice(void) {
    struct bed bed = bed_empty();
    int status = 0;
    for (int k = 0; !status && k < 1000; ++k)
        status =
            bed_add(&bed, &(struct bed_sphere){.x = 2 * (k % 10), .y = 2 * (k / 10 % 10), .z = 2 * (k / 100), .r = 1});
    return finish(status, &bed, "simple cubic 10 x 10 x 10");
}

/* Few spheres in an open space. */
static int of_scenes(void) {
    int status = 0;
    for (uint32_t scene = 0; !status && scene < SCENES; ++scene) {
        struct bed bed = bed_empty();
        status = bed_make_packing(&bed, 3 + scene % 6, 0.5, 1, 0.2, scene);
        for (int axis = 0; axis < 3; ++axis) bed.period[axis] = 0;
        status = finish(status, &bed, scene + 1 < SCENES ? NULL : "3 to 8 spheres");
    }
    return status;
}

int main(int argc, char **argv) {
    const bool quick = argc == 2 && strcmp(argv[1], "quick") == 0;
    printf("# fibrad %s; truth n = 40000\n", fibrad_version());
    printf("bed,directions,averaged,rows,median_error,honest,low,median,high\n");
    if (quick) return of_scenes();
    int status = of_file("tests/data/mono2000.dump");
    if (!status) status = of_file("tests/data/poly2000.dump");
    if (!status) status = of_file("tests/data/monoper2000.dump");
    if (!status) status = of_packing("solid fraction 0.01", 1000, 0.8, 0.01);
    if (!status) status = of_packing("sizes 1:4", 2000, 0.25, 0.5);
    if (!status) status = of_lattice();
    if (!status) status = of_scenes();
    for (int k = 1; !status && k < argc; ++k) status = of_file(argv[k]);
    return status;
}
