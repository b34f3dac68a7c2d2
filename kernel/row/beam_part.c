/* beam_part.c - rows in parts. A part is a range of windows. All parts together make the row.
 * SPDX-License-Identifier: MIT
 *
 * A part keeps what its windows add to the sums of the row. These sums are the same in any order. So the bits of the
 * row are those of a row computed at once. */
#include "base/arena.h"
#include "base/random.h"
#include "row/beam.h"
#include "row/beam_lanes.h"
#include "mask/line_set.h"

/* A key of the row and the rule that a part belongs to. */
static uint64_t key_of(const fibrad_scene *scene, uint32_t i, const fibrad_beam_rule *rule) {
    uint64_t cutoff;
    fibrad_copy(&cutoff, &rule->cutoff, sizeof cutoff);
    const fibrad_line_set *lines = rule->lines;
    const uint64_t number[] = {i, (uint64_t)rule->directions << 32 | rule->points, cutoff, rule->turn,
                               2 * rule->chords + (lines != NULL)};
    uint64_t key = scene->hash;
    for (int k = 0; k < 5; k++) key = fibrad_mix(key ^ fibrad_mix(number[k] + (uint64_t)k));
    return key;
}

typedef struct part_rule {
    fibrad_beam_rule rule;
    fibrad_beam_range range;
} part_rule;

/* The rule of a row in parts. */
static int complete_rule(const fibrad_beam_rule *given, fibrad_beam_rule *rule) {
    const int status = fibrad_beam_complete(given, rule);
    return status == FIBRAD_OK && rule->tolerance > 0 ? FIBRAD_E_UNSUPPORTED : status;
}

static int compute_range(const fibrad_scene *scene, fibrad_workspace *space, uint32_t i, const void *given,
                         fibrad_row *row) {
    const part_rule *part = given;
    return FIBRAD_VERSION_OF(fibrad_beam_lanes, scene->facts.isa)(scene, space, i, &part->rule, &part->range, row);
}

int fibrad_beam_part(const fibrad_scene *scene, fibrad_work *work, uint32_t i, const fibrad_beam_rule *given,
                     uint32_t from, uint32_t to, fibrad_row_part *part) {
    part_rule how;
    double wall[FIBRAD_WALLS_MAX];
    fibrad_row row = {.wall = wall};
    const int checked = complete_rule(given, &how.rule);
    if (checked != FIBRAD_OK) return checked;
    if (part == NULL || !fibrad_memory_valid(&part->memory) || from >= to || to > how.rule.directions)
        return FIBRAD_E_ARGUMENT;
    how.range = (fibrad_beam_range){.from = from, .to = to, .kept = part};
    part->key = 0;
    const int status = fibrad_row_run(scene, work, i, &(fibrad_row_method){compute_range, &how, 0, 0}, &row);
    if (status != FIBRAD_OK) return status;
    part->from = from, part->to = to;
    part->fallbacks = row.fallbacks;
    part->key = key_of(scene, i, &how.rule);
    return FIBRAD_OK;
}

int fibrad_beam_join(const fibrad_scene *scene, fibrad_work *work, uint32_t i, const fibrad_beam_rule *given,
                     const fibrad_row_part *part, uint32_t parts, fibrad_row *row) {
    part_rule how;
    const int checked = complete_rule(given, &how.rule);
    if (checked != FIBRAD_OK) return checked;
    if (scene == NULL || part == NULL) return FIBRAD_E_ARGUMENT;
    const uint64_t key = key_of(scene, i, &how.rule);
    uint32_t to = 0;
    for (uint32_t p = 0; p < parts; to = part[p++].to)
        if (part[p].key != key || part[p].from != to || part[p].used > part[p].memory.size) return FIBRAD_E_STATE;
    if (to != how.rule.directions) return FIBRAD_E_STATE;
    how.range = (fibrad_beam_range){.part = part, .parts = parts, .exact = how.rule.lines != NULL};
    return fibrad_row_run(scene, work, i, &(fibrad_row_method){compute_range, &how, 0, 0}, row);
}
