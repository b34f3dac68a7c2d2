/* bench_read.c - reading a million spheres from a LAMMPS dump, sorted and not, plain and packed by gzip.
 * SPDX-License-Identifier: MIT
 *
 * In the dump that is not sorted, the order of the ids is fixed, but is neither ascending nor descending. Numbers have
 * the six digits that LAMMPS writes. */
#include <inttypes.h>
#include <unistd.h>
#include <zlib.h>

#include "bench.h"
#include "read/read.h"

enum { REPEATS = 5 };

/* Writes a dump of n spheres. The id of row k is k, or k times a number that has no factor in common with n. */
static void bench_dump(gzFile file, uint32_t n, uint64_t step) {
    gzprintf(file, "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n%u\nITEM: BOX BOUNDS pp pp ff\n0 1\n0 1\n0 1\n", n);
    gzprintf(file, "ITEM: ATOMS id type x y z radius v_T\n");
    for (uint64_t k = 0; k < n; ++k) {
        const uint64_t id = k * step % n;
        gzprintf(file, "%" PRIu64 " 1 %g %g %g %g %g \n", id + 1, (double)(id * 7919 % 99991) / 99991,
                 (double)(id * 7907 % 99989) / 99989, (double)(id * 7901 % 99971) / 99971, 0.0045,
                 300 + (double)(id % 700));
    }
}

static double bench_reading(const char *path, uint32_t n) {
    double best = 1e9;
    for (int k = 0; k < REPEATS; ++k) {
        struct bed bed;
        const double start = bench_thread_seconds();
        if (read_bed(path, &(struct read_options){0}, &bed) != 0 || bed.n != n) exit(1);
        const double seconds = bench_thread_seconds() - start;
        if (seconds < best) best = seconds;
        bed_free(&bed);
    }
    return best;
}

int main(int argc, char **argv) {
    const uint32_t n = argc > 1 && strcmp(argv[1], "quick") == 0 ? 1000 : 1000000;
    static const struct {
        const char *name, *mode;
        uint64_t step;
    } cases[] = {{"sorted", "wT", 1}, {"unsorted", "wT", 7919}, {"unsorted, gzip", "w", 7919}};
    bench_preamble("one frame of a dump, id type x y z radius v_T, best of five, one thread", 1);
    printf("rows,n,seconds\n");
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        char path[] = "/tmp/bench_read_XXXXXX";
        const int file = mkstemp(path);
        gzFile dump = file < 0 ? NULL : gzdopen(file, cases[k].mode);
        if (!dump) bench_check("file", FIBRAD_E_MEMORY);
        bench_dump(dump, n, cases[k].step);
        gzclose(dump);
        printf("\"%s\",%u,%.3f\n", cases[k].name, n, bench_reading(path, n));
        unlink(path);
    }
    return 0;
}
