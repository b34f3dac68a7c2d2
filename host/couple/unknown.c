/* unknown.c - what the unknown parts of rows could change in powers. SPDX-License-Identifier: MIT
 *
 * A fraction b of what particle i emits goes beyond the cutoff. Powers are as if b ended where the rest of the row
 * does. It may end instead on what emits most, or on what emits least: let E be the emission of this one. Let W be the
 * area times the emissivity of the particle, and q_i its power as found. The power then changes by
 * b (W (E - E_i) - q_i). */
#include <inttypes.h>
#include <math.h>

#include "couple/insitu.h"

/* The least and the largest emission of all that a ray may meet. Collective. */
static void find_range(const fibrad_insitu *s, double range[2]) {
    const fibrad_insitu_set *set = &s->set;
    const double *emission = set->emission.at, *weight = set->weight.at;
    double most[2] = {-INFINITY, -INFINITY}; /* -least, largest */
    for (uint32_t k = 0; k <= set->walls; ++k) {
        const bool seen = k < set->walls ? set->facts.wall[k] > 0 : set->escapes;
        const double e = k < set->walls ? set->wall_emission[k] : set->surroundings_emission;
        if (seen) most[0] = fmax(most[0], -e), most[1] = fmax(most[1], e);
    }
    for (size_t i = 0; i < set->own; ++i)
        if (weight[i] > 0) most[0] = fmax(most[0], -emission[i]), most[1] = fmax(most[1], emission[i]);
    MPI_Allreduce(MPI_IN_PLACE, most, 2, MPI_DOUBLE, MPI_MAX, s->comm);
    range[0] = -most[0], range[1] = most[1];
}

/* What the unknown part of a row could change in the power of particle i at home. A row that sees a back is unknown as
 * a whole: FIBRAD_REMARK_BACK tells of it. */
static double doubt(const fibrad_insitu_set *set, size_t i, const double range[2]) {
    const double unknown = ((const double *)set->unknown.at)[i], weight = ((const double *)set->weight.at)[i];
    const double own = ((const double *)set->emission.at)[i], power = ((const double *)set->power.at)[i];
    if (unknown == 1 && set->facts.behind) return 0;
    return unknown * fmax(weight * (range[1] - own) - power, power - weight * (range[0] - own));
}

void fibrad_unknown_tell(fibrad_insitu *s, double unit) {
    fibrad_insitu_set *set = &s->set;
    char *message = set->remark[FIBRAD_REMARK_BEYOND].message;
    struct {
        double doubt;
        int rank;
    } worst = {0, s->rank};
    double range[2];
    uint64_t count = 0;
    size_t whose = 0;
    message[0] = 0;
    if (!(set->facts.cutoff > 0 && set->facts.beyond > 0)) return;
    find_range(s, range);
    for (size_t i = 0; i < set->own; ++i) {
        const double change = doubt(set, i, range);
        count += change > FIBRAD_BEYOND_MUCH * unit;
        if (change > worst.doubt) worst.doubt = change, whose = i;
    }
    MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_DOUBLE_INT, MPI_MAXLOC, s->comm);
    if (!(worst.doubt > FIBRAD_BEYOND_MUCH * unit)) return;
    MPI_Allreduce(MPI_IN_PLACE, &count, 1, MPI_UINT64_T, MPI_SUM, s->comm);
    if (worst.rank == s->rank) {
        const fibrad_particle *p = (const fibrad_particle *)set->particle.at + whose;
        fibrad_refuse(message, 0,
                      "what lies beyond the cutoff %g could change the power of %" PRIu64
                      " particle%s by more than %g %% "
                      "of the root mean square of all powers, that of particle %" PRIu64 " at (%.6g, %.6g, %.6g) by "
                      "%.3g %%",
                      set->facts.cutoff, count, count > 1 ? "s" : "", 100 * FIBRAD_BEYOND_MUCH, p->id, p->x[0], p->x[1],
                      p->x[2], 100 * worst.doubt / unit);
    }
    MPI_Bcast(message, FIBRAD_MESSAGE, MPI_CHAR, worst.rank, s->comm);
}
