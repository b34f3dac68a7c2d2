/* beam_replay.c - adds the terms that parts have listed to the sums of a row. SPDX-License-Identifier: MIT */
#include "row/beam_lanes.h"

static void add_again(fibrad_workspace *work, const fibrad_addend *a, fibrad_beam_sums *beam) {
    fibrad_wall_sums *sums = work->walls != NULL ? &work->walls->sums : NULL;
    if (a->target < FIBRAD_ADD_OPEN)
        fibrad_entries_add(&work->entries, fibrad_entries_of(&work->entries, a->target), a->window, a->value);
    else if (a->target == FIBRAD_ADD_OPEN)
        beam->open[a->window % 2] += a->value;
    else if (a->target == FIBRAD_ADD_WHOLE)
        beam->whole[a->window % 2] += a->value;
    else if (a->target == FIBRAD_ADD_SEEN)
        work->masks.regions += (uint32_t)a->value;
    else if (a->target >= FIBRAD_ADD_SLOT && a->target < FIBRAD_ADD_SLOT + FIBRAD_SLOTS)
        work->wall[a->target - FIBRAD_ADD_SLOT] += a->value;
    else if (sums == NULL) /* without walls there are no other terms */
        return;
    else if (a->target == FIBRAD_ADD_HIDDEN)
        sums->hidden[a->window / 64] |= UINT64_C(1) << a->window % 64;
    else if (a->target < FIBRAD_ADD_SHARE)
        fibrad_wall_add(sums->open[a->target - FIBRAD_ADD_REGION], a->window, work->entries.end, a->value);
    else if (a->target < FIBRAD_ADD_MIXED)
        fibrad_wall_add(sums->all[a->target - FIBRAD_ADD_SHARE], a->window, work->entries.end, a->value);
    else
        sums->mixed[a->target - FIBRAD_ADD_MIXED] += a->value;
}

void fibrad_beam_replay(fibrad_workspace *work, const fibrad_beam_range *range, uint32_t last, fibrad_beam_sums *sums) {
    for (uint32_t p = 0; p < range->parts; p++) {
        const fibrad_row_part *part = &range->part[p];
        for (size_t n = 0; n < part->count; n++) {
            fibrad_addend addend;
            fibrad_copy(&addend, (const unsigned char *)part->memory.block + n * sizeof addend, sizeof addend);
            work->entries.end = last > 0 && (addend.window == 0 || addend.window == last);
            add_again(work, &addend, sums);
        }
        work->areas.fallbacks += part->fallbacks;
    }
}
