/* bench_scale.c - seconds and bytes per sphere against the number of spheres and threads. SPDX-License-Identifier: MIT
 *
 *     bench_scale [quick | SPHERES...]      default 1000 10000 100000
 *
 * The bench writes CSV to standard output. The beds are periodic random beds, radii 0.8-1.2, solid fraction 0.55. Above
 * 10,000 spheres a bed consists of copies of one of 10,000, side by side. One thread and two threads take turns. From
 * half a million spheres on there are two threads only. All rows are computed along 55 lines.
 * `seconds` is elapsed time. `processor_us` is the processor time of all threads per circle (sphere and line), which
 * others on the machine disturb less. `bytes` is the largest memory that the process has ever had, so the numbers of
 * spheres must rise. */
#include <errno.h>
#include <sys/resource.h>

#include "bed/packing.h"
#include "../tests/copies.h"
#include "bench_bed.h"
#include "cli/message.h"

enum { LINES = 55, TILE = 10000, MILLION = 1000000 };

static double peak_bytes(void) {
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return 1024.0 * (double)usage.ru_maxrss;
}

/* The bed of n spheres, or of the next larger number that is a whole number of copies. */
static int make_bed(struct bed *bed, uint32_t n) {
    *bed = bed_empty();
    if (n <= TILE) return bed_make_packing(bed, n, 0.8, 1.2, 0.55, 1);
    struct bed tile = bed_empty();
    uint32_t copies[3] = {1, 1, 1};
    for (int axis = 0; (uint64_t)copies[0] * copies[1] * copies[2] * TILE < n; axis = (axis + 1) % 3) copies[axis]++;
    int status = bed_make_packing(&tile, TILE, 0.8, 1.2, 0.55, 1);
    if (!status) status = bed_make_copies(bed, &tile, copies);
    bed_free(&tile);
    return status;
}

static int bench(uint32_t n, int threads) {
    struct bed bed;
    int status = make_bed(&bed, n);
    if (status) return status;
    const fibrad_beam_rule rule = {.directions = LINES};
    const clock_t begun = clock();
    fibrad_bed_matrix *factors = bench_factors(&bed, &(fibrad_bed_rule){.beam = &rule}, threads);
    const double processor = (double)(clock() - begun) / CLOCKS_PER_SEC;
    printf("%u,%d,%llu,%.3f,%.2f,%.3f,%.0f,%.1e\n", bed.n, threads, (unsigned long long)factors->matrix.start[bed.n],
           factors->seconds, 1e6 * factors->seconds / bed.n, 1e6 * processor / bed.n / LINES, peak_bytes() / bed.n,
           factors->closure_error);
    fflush(stdout);
    if (!(factors->closure_error < 1e-12 && factors->reciprocity_error < 1e-14))
        status = message(STATUS_INPUT, "bench_scale: the rows are wrong");
    fibrad_bed_matrix_free(factors);
    bed_free(&bed);
    return status;
}

int main(int argc, char **argv) {
    static char *all[] = {"1000", "10000", "100000"}, *quick[] = {"200"};
    const bool is_quick = argc == 2 && strcmp(argv[1], "quick") == 0;
    char **list = is_quick ? quick : argc > 1 ? argv + 1 : all;
    const int count = is_quick ? 1 : argc > 1 ? argc - 1 : 3;
    bench_preamble("bench_scale: periodic random beds, rows along 55 lines", 2);
    puts("spheres,threads,entries,seconds,us_per_sphere,processor_us_per_window,peak_bytes_per_sphere,closure");
    int status = STATUS_OK;
    for (int k = 0; k < count && !status; ++k) {
        char *end;
        errno = 0;
        const unsigned long long n = strtoull(list[k], &end, 10);
        if (errno || *end || n < 1 || n > FIBRAD_SPHERES_MAX / 2)
            return message(STATUS_USAGE, "usage: bench_scale [quick | SPHERES...]");
        for (int threads = n > MILLION / 2 ? 2 : 1; threads <= 2 && !status; ++threads)
            status = bench((uint32_t)n, threads);
    }
    return status;
}
