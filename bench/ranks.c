/* ranks.c - rows and powers over ranks: seconds, entries, halos, memory and messages, for docs/lammps.md.
 * SPDX-License-Identifier: MIT
 *
 * mpirun -np P build/couple/ranks DUMP COPIES EMISSIVITY [CUTOFF [ACCURACY]]: the bed is that of a LAMMPS dump (columns
 * id type x y z radius), repeated COPIES times along each periodic axis. With ACCURACY there is a floor at the low end
 * of z. The bed is divided into bricks, one for each rank; more than one copy is divided along periodic axes alone. The
 * program writes a header and one line of CSV. once_seconds and once_bytes are processor time and memory of a rank when
 * rows have been made once, the most of all ranks. Messages are those of the rank that sends most: in a making of rows,
 * in a step of heat, and in the first step of heat after particles have moved by half a unit of length along all axes.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "couple/fibrad_couple.h"
#include "messages.h"

enum { HEATS = 20 };

/* What a rank owns of a bed. */
struct brick_bed {
    fibrad_insitu_bed bed;
    int copies;
    double moved; /* [L] of all particles along each axis, as far as their owners are concerned */
    uint64_t *id;
    double *x, *radius, *emissivity, *temperature, *power;
};

static void fail(const char *what) {
    fprintf(stderr, "ranks: %s\n", what);
    MPI_Abort(MPI_COMM_WORLD, 1);
}

/* Whether this rank owns a point of the box. */
static int own_place(const struct brick_bed *b, const double x[3]) {
    const fibrad_insitu_bed *bed = &b->bed;
    int ranks, rank, dims[3] = {0}, owner = 0;
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    for (int axis = 0; axis < 3; ++axis) dims[axis] = b->copies > 1 && !bed->periodic[axis];
    MPI_Dims_create(ranks, 3, dims);
    for (int axis = 0; axis < 3; ++axis) {
        const double part = (x[axis] + b->moved - bed->low[axis]) / (bed->high[axis] - bed->low[axis]);
        owner = owner * dims[axis] + (int)fmax(0, fmin(dims[axis] - 1, floor(part * dims[axis])));
    }
    return owner == rank;
}

static void add_copies(struct brick_bed *b, const double at[3], double radius, uint64_t *next, double emissivity) {
    fibrad_insitu_bed *bed = &b->bed;
    double period[3];
    int count[3];
    for (int axis = 0; axis < 3; ++axis) {
        count[axis] = bed->periodic[axis] ? b->copies : 1;
        period[axis] = (bed->high[axis] - bed->low[axis]) / count[axis];
    }
    for (int i = 0; i < count[0]; ++i)
        for (int j = 0; j < count[1]; ++j)
            for (int k = 0; k < count[2]; ++k) {
                const double x[3] = {at[0] + i * period[0], at[1] + j * period[1], at[2] + k * period[2]};
                const uint64_t id = ++*next;
                if (!own_place(b, x)) continue;
                memcpy(b->x + 3 * bed->n, x, sizeof x);
                b->id[bed->n] = id, b->radius[bed->n] = radius, b->emissivity[bed->n] = emissivity;
                b->temperature[bed->n] = 1000 + (double)(id % 100);
                ++bed->n;
            }
}

static void read_bed_of(struct brick_bed *b, const char *path, double emissivity) {
    fibrad_insitu_bed *bed = &b->bed;
    const int copies = b->copies;
    char line[500], ends[3][8];
    size_t n = 0;
    uint64_t next = 0;
    FILE *file = fopen(path, "r");
    if (!file) fail("no such file");
    for (int k = 0; k < 4 && fgets(line, sizeof line, file); ++k)
        if (k == 3) n = (size_t)(strtod(line, NULL) * pow(copies, 3));
    if (fscanf(file, "ITEM: BOX BOUNDS %7s %7s %7s", ends[0], ends[1], ends[2]) != 3) fail("no box");
    for (int axis = 0; axis < 3; ++axis) {
        if (fscanf(file, "%lf %lf", &bed->low[axis], &bed->high[axis]) != 2) fail("no box");
        bed->periodic[axis] = ends[axis][0] == 'p';
        if (bed->periodic[axis]) bed->high[axis] += (copies - 1) * (bed->high[axis] - bed->low[axis]);
    }
    b->id = malloc(n * sizeof *b->id);
    b->x = malloc(7 * n * sizeof *b->x);
    if (!b->id || !b->x) fail("out of memory");
    b->radius = b->x + 3 * n, b->emissivity = b->radius + n, b->temperature = b->emissivity + n;
    b->power = b->temperature + n;
    while (fgets(line, sizeof line, file)) {
        double x[3], radius;
        if (sscanf(line, "%*s %*s %lf %lf %lf %lf", &x[0], &x[1], &x[2], &radius) == 4)
            add_copies(b, x, radius, &next, emissivity);
    }
    fclose(file);
    bed->id = b->id, bed->x = b->x, bed->radius = b->radius, bed->emissivity = b->emissivity;
}

static fibrad_insitu_state state_of(const struct brick_bed *b) {
    static const double floor_temperature = 1500;
    return (fibrad_insitu_state){.surroundings = 300,
                                 .wall_temperature = &floor_temperature,
                                 .n = b->bed.n,
                                 .id = b->id,
                                 .temperature = b->temperature};
}

static double seconds_of(const struct rusage *used) {
    return (double)(used->ru_utime.tv_sec + used->ru_stime.tv_sec) +
           1e-6 * (double)(used->ru_utime.tv_usec + used->ru_stime.tv_usec);
}

/* Prints what this rank has sent in a part of the run, and begins to count anew. */
static void end_part(double *part) {
    memcpy(part, counted, sizeof counted);
    memset(counted, 0, sizeof counted);
}

int main(int argc, char **argv) {
    fibrad_insitu *radiation;
    fibrad_insitu_facts facts;
    int rank, ranks;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    if (argc < 4 || argc > 6) fail("DUMP COPIES EMISSIVITY [CUTOFF [ACCURACY]]");
    struct brick_bed b = {.copies = atoi(argv[2])}, moved = {.copies = b.copies, .moved = .5};
    double part[3 * COUNTERS];
    read_bed_of(&b, argv[1], atof(argv[3]));
    read_bed_of(&moved, argv[1], atof(argv[3]));
    const int accuracy = argc > 5 ? fibrad_accuracy_named(argv[5]) : FIBRAD_ACCURACY_NORMAL;
    const fibrad_insitu_config config = {.cutoff = argc > 4 ? atof(argv[4]) : 0, .accuracy = accuracy};
    const fibrad_wall floor_wall = {.kind = FIBRAD_WALL_PLANE, .plane = {.axis = 2, .at = b.bed.low[2]}};
    const double floor_emissivity = 0.9;
    struct rusage read, once;
    b.bed.wall = &floor_wall, b.bed.wall_emissivity = &floor_emissivity, b.bed.walls = argc > 5;
    const fibrad_insitu_state state = state_of(&b), then = state_of(&moved);
    if (fibrad_insitu_new(&radiation, MPI_COMM_WORLD, &config)) fail("out of memory");
    getrusage(RUSAGE_SELF, &read);
    if (fibrad_insitu_rows(radiation, &b.bed, 1)) fail(fibrad_insitu_message(radiation));
    getrusage(RUSAGE_SELF, &once);
    end_part(part);
    if (fibrad_insitu_rows(radiation, &b.bed, 2))
        fail(fibrad_insitu_message(radiation)); /* memory of both sets of rows */
    end_part(part);
    for (int k = 0; k < HEATS; ++k)
        if (fibrad_insitu_powers(radiation, &state, b.power, NULL)) fail(fibrad_insitu_message(radiation));
    end_part(part + COUNTERS);
    fibrad_insitu_facts_get(radiation, &facts);
    if (fibrad_insitu_powers(radiation, &then, moved.power, NULL)) fail(fibrad_insitu_message(radiation));
    end_part(part + 2 * COUNTERS);
    for (int k = 0; k < COUNTERS; ++k) part[COUNTERS + k] /= HEATS;
    double most[5] = {(double)b.bed.n, (double)facts.halo, (double)facts.bytes, seconds_of(&once) - seconds_of(&read),
                      1024.0 * (double)once.ru_maxrss};
    MPI_Allreduce(MPI_IN_PLACE, most, 5, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    MPI_Allreduce(MPI_IN_PLACE, part, 3 * COUNTERS, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    if (rank == 0) {
        printf("ranks,particles,emissivity,own,halo,entries_a_row,beyond,bytes,once_seconds,once_bytes,seconds_rows,"
               "seconds_powers");
        for (int k = 0; k < 3; ++k)
            for (int c = 0; c < COUNTERS; ++c)
                printf(",%s_%s", (const char *const[]){"rows", "heat", "moved"}[k],
                       (const char *const[]){"messages", "bytes", "collectives"}[c]);
        printf("\n%d,%llu,%s,%.0f,%.0f,%.1f,%.2e,%.0f,%.2f,%.0f,%.4f,%.6f", ranks, (unsigned long long)facts.particles,
               argv[3], most[0], most[1], (double)facts.entries / (double)facts.particles, facts.beyond, most[2],
               most[3], most[4], facts.seconds_rows / 2, facts.seconds_powers / HEATS);
        for (int k = 0; k < 3 * COUNTERS; ++k) printf(",%.0f", part[k]);
        printf("\n");
    }
    fibrad_insitu_free(radiation);
    free(b.id);
    free(b.x);
    free(moved.id);
    free(moved.x);
    MPI_Finalize();
    return 0;
}
