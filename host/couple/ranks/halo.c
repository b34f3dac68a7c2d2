/* halo.c - particles of other ranks and periodic images near the particles of this rank. SPDX-License-Identifier: MIT
 *
 * All ranks know the boxes of the particles of all ranks. Each rank sends to each box its particles and periodic images
 * within reach of the box. So the receiver needs no periods and makes no images. */
#include "couple/ranks/ranks.h"

#include <math.h>
#include <string.h>

struct range_box {
    double low[3], high[3]; /* without particles low is above high */
};

/* Multiples of the periods, from first to last along each axis. */
struct shift_range {
    int first[3], last[3];
};

static struct range_box box_of_centres(const fibrad_particle *particle, size_t n) {
    struct range_box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (size_t i = 0; i < n; ++i)
        for (int axis = 0; axis < 3; ++axis) {
            box.low[axis] = fmin(box.low[axis], particle[i].x[axis]);
            box.high[axis] = fmax(box.high[axis], particle[i].x[axis]);
        }
    return box;
}

/* Finds the shifts that move a point of `from` into `to` widened by `reach`. False: there are none. */
static bool find_shifts(const struct range_box *from, const struct range_box *to, const double period[3], double reach,
                        struct shift_range *shifts) {
    for (int axis = 0; axis < 3; ++axis) {
        const double least = to->low[axis] - reach - from->high[axis], most = to->high[axis] + reach - from->low[axis];
        if (!(least <= most)) return false; /* a box without particles */
        if (period[axis] > 0) {
            shifts->first[axis] = (int)ceil(least / period[axis]);
            shifts->last[axis] = (int)floor(most / period[axis]);
            if (shifts->first[axis] > shifts->last[axis]) return false;
        } else {
            shifts->first[axis] = shifts->last[axis] = 0;
            if (least > 0 || most < 0) return false;
        }
    }
    return true;
}

static bool within_reach(const double x[3], const struct range_box *box, double reach) {
    double square = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double d = fmax(0, fmax(box->low[axis] - x[axis], x[axis] - box->high[axis]));
        square += d * d;
    }
    return square <= reach * reach;
}

/* Appends a particle and its images, if they lie within reach of a box; once: the particle alone. itself: the particle
 * itself is left out. */
static int add_images(const fibrad_particle *particle, const struct range_box *box, const double period[3],
                      double reach, bool itself, bool once, fibrad_block *sent, size_t *count) {
    const struct range_box point = {{particle->x[0], particle->x[1], particle->x[2]},
                                    {particle->x[0], particle->x[1], particle->x[2]}};
    struct shift_range s;
    if (!find_shifts(&point, box, period, reach, &s)) return FIBRAD_OK;
    for (int i = s.first[0]; i <= s.last[0]; ++i)
        for (int j = s.first[1]; j <= s.last[1]; ++j)
            for (int k = s.first[2]; k <= s.last[2]; ++k) {
                fibrad_particle image = *particle;
                image.x[0] += i * period[0];
                image.x[1] += j * period[1];
                image.x[2] += k * period[2];
                if ((itself && !i && !j && !k) || !within_reach(image.x, box, reach)) continue;
                if (*count == FIBRAD_SPHERES_MAX || fibrad_block_fit(sent, *count + 1, sizeof image))
                    return FIBRAD_E_MEMORY;
                ((fibrad_particle *)sent->at)[(*count)++] = once ? *particle : image;
                if (once) return FIBRAD_OK;
            }
    return FIBRAD_OK;
}

static void set_owner(fibrad_particle *particle, size_t own, int rank) {
    for (size_t i = 0; i < own; ++i) particle[i].owner = (fibrad_place){(uint32_t)rank, (uint32_t)i};
}

/* Lists the particles and images for each rank. count[q]: their number for rank q. */
static int choose_particles(const struct range_box *box, int rank, int ranks, const double period[3], double reach,
                            bool once, fibrad_particle *particle, size_t own, fibrad_block *sent, int *count) {
    size_t sum = 0;
    set_owner(particle, own, rank);
    for (int q = 0; q < ranks; ++q) {
        const size_t before = sum;
        struct shift_range any;
        if (!(once && q == rank) && find_shifts(&box[rank], &box[q], period, reach, &any))
            for (size_t i = 0; i < own; ++i)
                if (add_images(&particle[i], &box[q], period, reach, q == rank, once, sent, &sum))
                    return FIBRAD_E_MEMORY;
        count[q] = (int)(sum - before);
    }
    return FIBRAD_OK;
}

int fibrad_halo(MPI_Comm comm, const double period[3], double reach, bool once, fibrad_block *particle, size_t own,
                fibrad_block *sent, size_t *halo) {
    int rank, ranks;
    MPI_Comm_rank(comm, &rank);
    MPI_Comm_size(comm, &ranks);
    const struct range_box mine = box_of_centres(particle->at, own);
    struct range_box *box = malloc((size_t)ranks * sizeof *box);
    int *count = calloc(2 * (size_t)ranks, sizeof *count);
    int status = fibrad_agree(comm, box && count ? FIBRAD_OK : FIBRAD_E_MEMORY, NULL);
    reach *= 1 + 1e-9; /* includes particles at the edge whatever the rounding */
    if (!status) {
        MPI_Allgather(&mine, 6, MPI_DOUBLE, box, 6, MPI_DOUBLE, comm);
        status = choose_particles(box, rank, ranks, period, reach, once, particle->at, own, sent, count);
        status = fibrad_deal(comm, status, sent->at, count, sizeof(fibrad_particle), particle, own, count + ranks);
    }
    if (!status) *halo = fibrad_count_sum(count + ranks, ranks);
    free(box);
    free(count);
    return status;
}

/* Reverses the order of particles. */
static void turn_round(fibrad_particle *particle, size_t n) {
    for (size_t i = 0; i < n / 2; ++i) {
        const fibrad_particle p = particle[i];
        particle[i] = particle[n - 1 - i], particle[n - 1 - i] = p;
    }
}

/* Gathers all particles in the order of ranks, in place. */
static void gather_in_place(MPI_Comm comm, fibrad_particle *all, size_t own, size_t first, const int *count,
                            const int *start) {
    MPI_Datatype one;
    memmove(all + first, all, own * sizeof *all);
    MPI_Type_contiguous(sizeof *all, MPI_BYTE, &one);
    MPI_Type_commit(&one);
    MPI_Allgatherv(MPI_IN_PLACE, 0, one, all, count, start, one, comm);
    MPI_Type_free(&one);
}

int fibrad_gather(MPI_Comm comm, fibrad_block *particle, size_t own, size_t *others, size_t *first) {
    int rank, ranks;
    const int mine = (int)own;
    MPI_Comm_rank(comm, &rank);
    MPI_Comm_size(comm, &ranks);
    int *count = malloc(2 * (size_t)ranks * sizeof *count);
    int status = fibrad_agree(comm, count ? FIBRAD_OK : FIBRAD_E_MEMORY, NULL);
    if (!status) {
        int *start = count + ranks;
        MPI_Allgather(&mine, 1, MPI_INT, count, 1, MPI_INT, comm);
        fibrad_count_starts(count, ranks, start);
        *first = (size_t)start[rank], *others = fibrad_count_sum(count, ranks) - own;
        status = fibrad_agree(comm, fibrad_block_fit(particle, own + *others, sizeof(fibrad_particle)), NULL);
    }
    if (!status) {
        fibrad_particle *all = particle->at;
        set_owner(all, own, rank);
        gather_in_place(comm, all, own, *first, count, count + ranks);
        turn_round(all, *first); /* own particles and those of lower ranks change places */
        turn_round(all + *first, own);
        turn_round(all, *first + own);
    }
    free(count);
    return status;
}
