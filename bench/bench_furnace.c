/* bench_furnace.c - the published furnace: time against error of mc, mchf and mchf-x. SPDX-License-Identifier: MIT
 *
 *     bench_furnace [quick | REFERENCE_BUNDLES [LARGEST_BUNDLES [THREADS]]]
 *
 * The bench writes CSV to standard output. Errors are those of temperatures, in per cent. The reference is a Monte
 * Carlo run with REFERENCE_BUNDLES (2e7) bundles and another seed, on the same 20 x 20 x 40 cells. There are three
 * errors: the largest of all cells, the largest in the plane y = 1 m, and the root mean square. The numbers of bundles
 * rise up to LARGEST_BUNDLES (2e6). The table of docs/validation.md is by bench_furnace 100000000 16000000, which takes
 * some minutes. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "papers/furnace/furnace.h"
#include "cli/message.h"

enum { CELLS = 20 * 20 * 40 };

static void print_preamble(int threads, uint64_t reference) {
    char line[200] = "";
    FILE *cpus = fopen("/proc/cpuinfo", "r");
    while (cpus != NULL && fgets(line, sizeof line, cpus) != NULL && strncmp(line, "model name", 10) != 0) {}
    if (cpus != NULL) fclose(cpus);
    const char *model = strchr(line, ':');
    printf("# published furnace, 20 x 20 x 40 cells: time against error of the temperatures\n"
           "# fibrad %s, compiler %s, %d threads, CPU%s"
           "# reference: mc, %llu bundles, seed 1000\n"
           "case,method,bundles,seconds,outer_iterations,max_percent,midplane_percent,rms_percent,wall_z0_kW\n",
           fibrad_version(), __VERSION__, threads, model != NULL ? model : ": unknown\n",
           (unsigned long long)reference);
}

static void print_row(int number, const char *method, const struct furnace_run *run, const double *reference) {
    double all = 0, middle = 0, square = 0, power[4];
    for (size_t k = 0; k < CELLS; k++) {
        double t = fibrad_furnace_temperature(reference[k]);
        double error = fabs(fibrad_furnace_temperature(run->at.e[k]) / t - 1), layer = (double)(k / 20 % 20);
        all = fmax(all, error);
        if (fabs(layer - 9.5) < 1) middle = fmax(middle, error);
        square += error * error;
    }
    furnace_powers(run, power);
    printf("%d,%s,%llu,%.4f,%u,%.4f,%.4f,%.5f,%.3f\n", number, method, (unsigned long long)run->bundles, run->seconds,
           run->outers, 100 * all, 100 * middle, 100 * sqrt(square / CELLS), power[0]);
    fflush(stdout);
}

/* E of case 1. Case 2 has the same incident radiation. */
static int make_reference(double *e, uint64_t bundles, int threads) {
    struct furnace_options options = {.method = FURNACE_MC, .bundles = bundles, .threads = threads};
    struct furnace_run run;
    fibrad_furnace_config config = furnace_case(1);
    config.seed = 1000;
    int status = furnace_run(&config, &options, &run);
    if (!status) memcpy(e, run.at.e, CELLS * sizeof *e);
    furnace_free(&run);
    return status;
}

int main(int argc, char **argv) {
    static const struct {
        const char *name;
        enum furnace_method method;
        fibrad_furnace_estimator estimator;
    } methods[] = {{"mc", FURNACE_MC, FIBRAD_THETA_DEFINITION},
                   {"mchf", FURNACE_MCHF, FIBRAD_THETA_DEFINITION},
                   {"mchf-paper", FURNACE_MCHF, FIBRAD_THETA_PAPER},
                   {"mchf-x", FURNACE_MCHF_X, FIBRAD_THETA_DEFINITION}};
    const bool quick = argc == 2 && strcmp(argv[1], "quick") == 0;
    uint64_t reference_bundles = quick ? 200000 : argc > 1 ? strtoull(argv[1], NULL, 10) : 20000000;
    uint64_t largest = quick ? 62500 : argc > 2 ? strtoull(argv[2], NULL, 10) : 2000000;
    int threads = argc > 3 ? atoi(argv[3]) : 2;
    static double reference[CELLS];
    print_preamble(threads, reference_bundles);
    int status = make_reference(reference, reference_bundles, threads);
    for (int number = 1; number <= 2 && !status; number++) {
        for (size_t k = 0; k < CELLS && number == 2; k++) reference[k] += 5000.0 / 4 * (1 / 0.15 - 1 / 0.5);
        for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
            for (uint64_t bundles = 62500; bundles <= largest && !status; bundles *= 4) {
                struct furnace_options options = {
                    .method = methods[m].method,
                    .estimator = methods[m].estimator,
                    .scatter = methods[m].method == FURNACE_MCHF_X ? FIBRAD_SCATTER_EXACT : FIBRAD_SCATTER_SIX_FLUX,
                    .quiet = true,
                    .bundles = bundles,
                    .threads = threads,
                    .tolerance = 0.1,
                    .outer_max = 50};
                struct furnace_run run;
                fibrad_furnace_config config = furnace_case(number);
                status = furnace_run(&config, &options, &run);
                if (!status && !run.cold) print_row(number, methods[m].name, &run, reference);
                furnace_free(&run);
            }
        }
    }
    return status;
}
