/* bench.h - what all benches print first, clocks, memory, and the end of a bench after an error.
 * SPDX-License-Identifier: MIT */
#ifndef BENCH_H
#define BENCH_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "simple/fibrad_host.h"

/* Processor time of this thread [s]. Other work on the machine disturbs processor time least. */
static inline double bench_thread_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Ends the program, with a message, unless the status is FIBRAD_OK. */
static inline void bench_check(const char *what, int status) {
    if (status == FIBRAD_OK) return;
    fprintf(stderr, "bench: %s: %s\n", what, fibrad_status_text(status));
    exit(1);
}

/* A zeroed array. Ends the program if there is no memory. */
static inline void *bench_array(size_t count, size_t size) {
    void *array = calloc(count > 0 ? count : 1, size);
    if (!array) bench_check("array", FIBRAD_E_MEMORY);
    return array;
}

/* Empty work memory or rows that grow on the heap. The caller frees memory.block. */
#define BENCH_GROWING                                                                                                  \
    {                                                                                                                  \
        .memory = {.resize = fibrad_heap_resize }                                                                      \
    }

/* Prints a line `# key: value` for each fact of the run. `make bench` sets commit and flags in the environment. */
static inline void bench_preamble(const char *what, int threads) {
    const char *commit = getenv("BENCH_COMMIT"), *flags = getenv("BENCH_FLAGS");
    char cpu[200] = "unknown\n", line[200];
    FILE *file = fopen("/proc/cpuinfo", "r");
    while (file && fgets(line, sizeof line, file))
        if (strncmp(line, "model name", 10) == 0 && strchr(line, ':')) {
            snprintf(cpu, sizeof cpu, "%.190s", strchr(line, ':') + 2);
            break;
        }
    if (file) fclose(file);
    printf("# %s\n# commit: %s, fibrad %s\n# CPU: %s", what, commit ? commit : "unknown", fibrad_version(), cpu);
    printf("# compiler: %s\n# flags: %s\n# threads: %d\n# ISA: %s\n", __VERSION__, flags ? flags : "unknown", threads,
           fibrad_isa_name((int)fibrad_isa_best()));
}

#endif
