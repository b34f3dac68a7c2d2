/* line_set.c - sets of lines for rows of a matrix. SPDX-License-Identifier: MIT */
#include "mask/line_set.h"
#include "base/vector.h"
#include "sample/direction.h"
#include "sample/line.h"
#include "mask/masks.h"

/* Takes the arrays from the arena. The caller copies the object itself to the address returned. */
static fibrad_line_set *line_set_layout(fibrad_arena *arena, uint32_t n, fibrad_line_set *set) {
    fibrad_line_set *place = fibrad_arena_take(arena, 1, sizeof *place);
    set->line = fibrad_arena_take(arena, n, sizeof *set->line);
    set->frame = fibrad_arena_take(arena, n, sizeof *set->frame);
    set->chords = fibrad_chords_for(n);
    set->word = fibrad_arena_take(arena, (size_t)n * set->chords, sizeof *set->word);
    set->points = fibrad_arena_take(arena, n, sizeof *set->points);
    return place;
}

uint32_t fibrad_chords_for(uint32_t n) { return n <= 80 ? 16 : n <= 250 ? 32 : n <= 724 ? 64 : 0; }

uint32_t fibrad_line_set_lines(uint32_t lines) { return fibrad_lines_next(lines); }

size_t fibrad_line_set_size(uint32_t lines) {
    fibrad_arena arena = {0};
    fibrad_line_set fields = {0};
    const uint32_t n = lines >= FIBRAD_DIRECTIONS_MIN ? fibrad_lines_next(lines) : 0;
    if (n == 0) return 0;
    line_set_layout(&arena, n, &fields);
    return fibrad_arena_total(&arena);
}

/* The axes of a window along `line`: the first lies across the next line of the set that is not nearly parallel. So the
 * windows of a set lie differently in their planes. */
static void frame_of_line(uint32_t n, const double (*line)[3], uint32_t k, double frame[9]) {
    const double *w = line[k];
    double u[3] = {0, 0, 0}, square = 0;
    for (uint32_t next = k + 1; square < 0.1; square = fibrad_dot(u, u)) fibrad_cross(w, line[next++ % n], u);
    const double scale = 1 / fibrad_sqrt(square);
    for (int axis = 0; axis < 3; axis++) frame[axis] = u[axis] * scale, frame[6 + axis] = w[axis];
    fibrad_cross(w, frame, frame + 3);
}

int fibrad_line_set_init(fibrad_line_set **made, void *memory, size_t size, uint32_t lines) {
    fibrad_arena arena = {0};
    fibrad_line_set fields = {0};
    if (made == NULL || memory == NULL || lines < FIBRAD_DIRECTIONS_MIN) return FIBRAD_E_ARGUMENT;
    const uint32_t n = fields.n = fibrad_lines_next(lines);
    if (n == 0) return FIBRAD_E_TABLE;
    const int status = fibrad_arena_open(&arena, memory, size, fibrad_line_set_size(n));
    if (status != FIBRAD_OK) return status;
    fibrad_line_set *set = line_set_layout(&arena, n, &fields);
    if (fields.line == NULL || fields.frame == NULL) return FIBRAD_E_SIZE; /* never: for clang-tidy */
    fibrad_lines_read(n, fields.line);
    for (uint32_t k = 0; k < n; k++) {
        frame_of_line(n, (const double(*)[3])fields.line, k, fields.frame[k]);
        if (fields.chords == 0) continue;
        fibrad_masks masks;
        fibrad_masks_open_scalar(&masks, fields.chords, 1, k);
        fibrad_copy(fields.word + (size_t)k * fields.chords, masks.word, fields.chords * sizeof *masks.word);
        fields.points[k] = masks.points;
    }
    *set = fields;
    *made = set;
    return FIBRAD_OK;
}

/* The points of a large sphere are about as dense as those of the smallest one. Beyond this ratio areas are exact. */
#define MASK_RATIO (FIBRAD_MASK_WORDS_MAX + 0.5)

/* Ends of chords in a disc of this many radii are known to a hundredth of a point: discs of masks are floats. */
#define MASK_LARGEST 1e4

uint32_t fibrad_mask_words(const fibrad_scene *scene, uint32_t place) {
    const double r = scene->r[place], ratio = r / scene->facts.radius_min;
    return ratio < MASK_RATIO && scene->facts.radius_max < MASK_LARGEST * r ? (uint32_t)(ratio + 0.5) : 0;
}
