/* memory.c - checks, before the work begins, whether memory or disk suffice; arrays that grow.
 * SPDX-License-Identifier: MIT */

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/statvfs.h>

#include "cli/message.h"

void *memory_resized(void *array, size_t bytes, bool *good) {
    void *moved = realloc(array, bytes);
    if (moved) return moved;
    *good = false;
    return array;
}

void *memory_grown(void *array, size_t n, size_t size, bool *good) {
    return n & (n - 1) ? array : memory_resized(array, (n ? 2 * n : 1) * size, good);
}

/* Reads the number of a line `KEY: N kB` in a file of Linux's /proc [bytes]. Without such a line: `otherwise`. */
static double proc_bytes(const char *path, const char *format, double otherwise) {
    char line[256];
    double kilobytes = 0;
    FILE *file = fopen(path, "r");
    while (file && fgets(line, sizeof line, file))
        if (sscanf(line, format, &kilobytes) == 1) otherwise = 1024 * kilobytes;
    if (file) fclose(file);
    return otherwise;
}

double memory_left(void) {
    struct rlimit limit;
    const double left = proc_bytes("/proc/meminfo", "MemAvailable: %lf kB", INFINITY);
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return left;
    return fmax(0, fmin(left, (double)limit.rlim_cur - proc_bytes("/proc/self/status", "VmSize: %lf kB", 0)));
}

int memory_check(double bytes, const char *what_would_help) {
    const double left = memory_left();
    if (bytes <= left) return STATUS_OK;
    return message(STATUS_MEMORY, "out of memory: %.3g GB are needed, %.3g GB are left; %s", bytes / 1e9, left / 1e9,
                   what_would_help);
}

double disk_left(const char *folder) {
    struct statvfs disk;
    return statvfs(folder, &disk) == 0 ? (double)disk.f_bavail * (double)disk.f_frsize : INFINITY;
}

int disk_check(const char *folder, double bytes) {
    const double left = disk_left(folder);
    if (bytes <= left) return STATUS_OK;
    return message_at(STATUS_FILE, folder, 0, "no room on this disk: %.3g GB are needed, %.3g GB are left", bytes / 1e9,
                      left / 1e9);
}
