/* bundle_plan.c - how many bundles each source emits. SPDX-License-Identifier: MIT
 *
 * Sources are the cells and the patches of the walls. Each emits a whole number of bundles, which together carry
 * exactly its power. The hash of a plan covers all that its tally depends on. So a tally is valid for furnaces with
 * the same hash and for no others. */
#include "furnace/furnace.h"

#define PLANNED_MAX 0x1p33

/* The hash of a furnace after a number of restarts, before its first plan. */
static uint64_t plan_hash_start(const fibrad_furnace *f) {
    const fibrad_furnace_config *c = &f->config;
    const double medium[] = {c->absorption, c->scattering, c->source, f->bundle_power};
    uint64_t hash = fibrad_hash_word(fibrad_mix(c->seed), f->restarts);
    hash = fibrad_hash_word(hash, (uint64_t)f->physics);
    for (int a = 0; a < 3; a++) hash = fibrad_hash_number(fibrad_hash_word(hash, c->cells[a]), c->size[a]);
    for (uint32_t w = 0; w < 6; w++)
        hash = fibrad_hash_number(fibrad_hash_number(hash, c->wall_temperature[w]), c->wall_emissivity[w]);
    for (int k = 0; k < 4; k++) hash = fibrad_hash_number(hash, medium[k]);
    return hash;
}

/* Sets what each source emits in the next plan, and E as traced. Returns the sum of the absolute values [W]. */
static double plan_powers(fibrad_furnace *f, bool anew) {
    double total = 0, volume = fibrad_cell_volume(f);
    for (size_t k = 0; k < f->cells; k++) {
        double before = anew ? f->reference : f->traced[k];
        if (f->physics == FIBRAD_FURNACE_ATTENUATED)
            f->power[k] = 4 * f->config.absorption * (f->at.e[k] - before) * volume;
        else
            f->power[k] = anew ? f->config.source * volume : 0;
        f->traced[k] = f->at.e[k];
        total += fibrad_abs(f->power[k]);
    }
    for (uint32_t w = 0; w < 6; w++) {
        double power = anew ? fibrad_patch_power(f, w) : 0;
        for (size_t p = 0; p < f->patches[fibrad_face_axis(w)]; p++) f->power[f->wall_source[w] + p] = power;
        total += fibrad_abs(power) * (double)f->patches[fibrad_face_axis(w)];
    }
    return total;
}

/* Numbers the bundles of all sources, and extends the hash of the plan. Returns the number of bundles. */
static uint64_t plan_counts(fibrad_furnace *f) {
    uint64_t sum = 0;
    for (size_t s = 0; s < f->sources; s++) {
        f->first[s] = sum;
        if (f->power[s] != 0) sum += (uint64_t)fibrad_max(fibrad_abs(f->power[s]) / f->bundle_power + 0.5, 1);
        f->plan = fibrad_hash_number(f->plan, f->power[s]);
    }
    f->first[f->sources] = sum;
    return sum;
}

int fibrad_furnace_emit(fibrad_furnace *furnace, fibrad_furnace_physics physics, uint64_t bundles, int restart,
                        uint64_t *planned) {
    fibrad_furnace *f = furnace;
    if (f == NULL || planned == NULL || bundles == 0 || bundles > (uint64_t)1 << 32) return FIBRAD_E_ARGUMENT;
    if (physics != FIBRAD_FURNACE_ATTENUATED && physics != FIBRAD_FURNACE_EQUILIBRIUM) return FIBRAD_E_ARGUMENT;
    bool anew = restart != 0 || f->bundle_power == 0 || physics != f->physics;
    f->physics = physics;
    double total = plan_powers(f, anew);
    if (anew) f->bundle_power = total > 0 ? fibrad_max(total / (double)bundles, DBL_MIN) : 1;
    if (!fibrad_finite(total) || total > f->bundle_power * PLANNED_MAX) {
        f->bundle_power = 0;
        return FIBRAD_E_ARGUMENT;
    }
    if (anew) {
        f->restarts++;
        f->plan = plan_hash_start(f);
        f->mark = 0;
    }
    f->origin = anew ? 0 : f->origin + f->planned;
    f->planned = plan_counts(f);
    if (anew) f->series = f->plan | 1;
    f->mark += fibrad_bundles_mark(f->plan, 0, f->planned);
    *planned = f->planned;
    return FIBRAD_OK;
}
