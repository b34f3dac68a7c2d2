/* beam.c - checks a beam rule and hands it to the version for the scene's instruction set. SPDX-License-Identifier: MIT
 */
#include "row/beam.h"
#include "mask/line_set.h"

/* The number of directions rises in steps of an eighth. Each step takes a sixth off the error. The steps aim a
 * little below the tolerance. The number rises by a fifth at least, for rows whose error falls more slowly. */
uint32_t fibrad_directions_for(uint32_t directions, double error, double tolerance) {
    double n = directions < FIBRAD_DIRECTIONS_MIN ? FIBRAD_DIRECTIONS_MIN : directions;
    for (; n < FIBRAD_DIRECTIONS_MAX && (error > 0.9 * tolerance || n < 1.2 * directions); n *= 1.125) error *= 0.838;
    return n < FIBRAD_DIRECTIONS_MAX ? (uint32_t)n : FIBRAD_DIRECTIONS_MAX;
}

int fibrad_beam_complete(const fibrad_beam_rule *given, fibrad_beam_rule *rule) {
    *rule = given != NULL ? *given : (fibrad_beam_rule){0};
    if (!(rule->tolerance >= 0 && fibrad_finite(rule->tolerance))) return FIBRAD_E_ARGUMENT;
    if (rule->directions == 0)
        rule->directions = rule->tolerance > 0 ? FIBRAD_DIRECTIONS_FIRST : FIBRAD_DIRECTIONS_DEFAULT;
    if (rule->lines != NULL) {
        if ((given->directions | given->points) != 0 || given->turn != 0 || given->tolerance > 0)
            return FIBRAD_E_ARGUMENT;
        rule->directions = rule->lines->n;
    }
    if (rule->chords == FIBRAD_CHORDS_SUITED || (rule->chords == 0 && rule->lines != NULL))
        rule->chords = fibrad_chords_for(rule->directions);
    if (rule->chords == FIBRAD_CHORDS_NONE) rule->chords = 0;
    if (rule->chords != 0 && rule->chords != 16 && rule->chords != 32 && rule->chords != 64) return FIBRAD_E_ARGUMENT;
    if (rule->chords > 0 && rule->points > 0) return FIBRAD_E_ARGUMENT;
    if (rule->directions < FIBRAD_DIRECTIONS_MIN || rule->directions > FIBRAD_DIRECTIONS_MAX) return FIBRAD_E_ARGUMENT;
    return rule->cutoff >= 0 && fibrad_finite(rule->cutoff) ? FIBRAD_OK : FIBRAD_E_ARGUMENT;
}

int fibrad_beam_compute(const fibrad_scene *scene, fibrad_workspace *space, uint32_t i, const fibrad_beam_rule *rule,
                        bool exact, fibrad_row *row) {
    return FIBRAD_VERSION_OF(fibrad_beam_lanes, scene->facts.isa)(scene, space, i, rule, exact, row);
}

/* Repeats the row with more directions until its error is small enough. Only then its length is known. */
static int beam_to_tolerance(const fibrad_scene *scene, fibrad_workspace *space, uint32_t i, const void *given,
                             fibrad_row *row) {
    fibrad_beam_rule rule = *(const fibrad_beam_rule *)given;
    if (rule.tolerance == 0) return fibrad_beam_compute(scene, space, i, &rule, rule.lines != NULL, row);
    double wall[FIBRAD_WALLS_MAX];
    fibrad_row trial = fibrad_row_scratch(space, wall);
    for (;;) {
        const int status = fibrad_beam_compute(scene, space, i, &rule, false, &trial);
        if (status != FIBRAD_OK) return status;
        if (trial.error <= rule.tolerance || rule.directions == FIBRAD_DIRECTIONS_MAX)
            return fibrad_row_give(scene, &trial, row);
        rule.directions = fibrad_directions_for(rule.directions, trial.error, rule.tolerance);
    }
}

int fibrad_beam_row(const fibrad_scene *scene, fibrad_work *work, uint32_t i, const fibrad_beam_rule *given,
                    fibrad_row *row) {
    fibrad_beam_rule rule;
    const int status = fibrad_beam_complete(given, &rule);
    return status != FIBRAD_OK
               ? status
               : fibrad_row_run(scene, work, i, &(fibrad_row_method){beam_to_tolerance, &rule, 0, 0}, row);
}
