/* bench_cutoff.c - what a cutoff does to exchange factors. SPDX-License-Identifier: MIT
 *
 *     bench_cutoff [quick]
 *
 * The bench writes CSV to standard output. The bed is a random periodic bed of equal spheres, solid fraction 0.588.
 * There is a line for each emissivity and cutoff [radii]. All columns but `beyond` are relative to the same rows
 * without a cutoff, from the same paths.
 *   beyond                  the fraction that is cut off
 *   flux_dropped            what a hot sphere loses to cold ones, 1 - D_ii; the fraction that is cut off is dropped
 *   flux                    the same; the fraction that is cut off is given back to the row */
#include "bed/packing.h"
#include "bench_bed.h"

/* Quantities of a row, as means over the spheres i = 0, STEP, 2 STEP ... */
struct means {
    double beyond, flux;
};

static struct means measure(const fibrad_scene *scene, fibrad_work *work, const fibrad_exchange_rule *rule,
                            uint32_t step) {
    struct means sum = {0};
    const uint32_t n = 64 * step;
    fibrad_row row = bench_arrays(n > 20000 ? n : 20000);
    for (uint32_t i = 0; i < n; i += step) {
        double own = 0;
        bench_check("row", fibrad_exchange_row(scene, work, i, rule, &row, NULL));
        for (uint32_t k = 0; k < row.length; ++k)
            if (row.col[k] == i) own = row.f[k];
        sum.beyond += row.beyond / 64;
        sum.flux += (1 - own / (1 - row.beyond)) / 64;
    }
    free(row.col);
    free(row.f);
    return sum;
}

int main(int argc, char **argv) {
    const bool quick = argc > 1 && strcmp(argv[1], "quick") == 0;
    const double emissivities[] = {.3, .8, 1};
    fibrad_work work = BENCH_GROWING;
    struct bed bed = bed_empty();
    void *block;
    const int status = bed_make_packing(&bed, quick ? 640 : 6400, 1, 1, .588, 1);
    if (status) return status;
    const fibrad_scene *scene = bench_scene(&bed, FIBRAD_ISA_BEST, &block);
    double *emissivity = bench_array(bed.n, sizeof *emissivity);
    bench_preamble("what a cutoff does to exchange factors", 1);
    puts("emissivity,cutoff,beyond,flux_dropped,flux");
    for (int e = 0; e < 3; ++e) {
        for (uint32_t i = 0; i < bed.n; ++i) emissivity[i] = emissivities[e];
        fibrad_exchange_rule rule = {
            .emissivity = emissivity, .paths = quick ? 400 : 40000, .directions = quick ? 50 : 400};
        const struct means all = measure(scene, &work, &rule, bed.n / 64);
        for (rule.cutoff = 4; rule.cutoff < 13; rule.cutoff += 2) {
            const struct means cut = measure(scene, &work, &rule, bed.n / 64);
            printf("%.1f,%.0f,%.2e,%.2e,%.2e\n", emissivities[e], rule.cutoff, cut.beyond, -cut.beyond / all.flux,
                   cut.flux / all.flux - 1);
            fflush(stdout);
        }
    }
    free(work.memory.block);
    free(emissivity);
    free(block);
    bed_free(&bed);
    return 0;
}
