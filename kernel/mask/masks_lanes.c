/* masks_lanes.c - points of a window as bits, which discs hide. Compiled once per instruction set.
 * SPDX-License-Identifier: MIT */
#include FIBRAD_LANES_HEADER
#include "mask/masks_lanes.h"

#define VECTOR_CHORDS 16 /* chords are taken in multiples of the widest vector */

/* Heights of the chords from number `chord` on. */
static inline vf heights(const fibrad_masks *m, uint32_t chord) {
    _Alignas(64) static const float LANE[VECTOR_CHORDS] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    const float first = m->y_first + m->y_step * (float)(chord / VECTOR_CHORDS * VECTOR_CHORDS);
    return vf_set1(first) + vf_set1(m->y_step) * vf_load(LANE + chord % VECTOR_CHORDS);
}

/* A disc in units of points: its middle at the first word, and the factor of half chords. */
typedef struct mask_disc {
    vf middle, scale, v, square;
} mask_disc;

/* The points of one word column within a disc. */
static inline vn mask_within(const mask_disc *disc, vf height, vf word) {
    const vf dy = height - disc->v, square = disc->square - dy * dy;
    const vf half = vf_sqrt(vf_max(square, vf_set1(0))) * disc->scale, middle = disc->middle - word;
    return vn_below(middle + half) & ~vn_below(middle - half);
}

void LANED(fibrad_masks_open)(fibrad_masks *m, uint32_t chords, uint32_t words, uint32_t k) {
    fibrad_masks_place(m, chords, words, k);
    m->points = 0;
    const mask_disc whole = {vf_set1(m->x_zero), vf_set1(m->x_scale), vf_set1(0), vf_set1(1)};
    for (uint32_t word = 0; word < words; word++) {
        for (uint32_t chord = 0; chord < chords; chord += VF_LANES) {
            const vn points = mask_within(&whole, heights(m, chord), vf_set1(32 * (float)word));
            vn_store(m->word + word * chords + chord, points);
            m->points += vn_count_bits(&points, 1);
        }
    }
    m->open = m->points;
}

/* Hides the points of one disc in all words. The number of vectors is known to the compiler. Returns how many it hides.
 * *left: out: whether a point is open. */
FIBRAD_INLINE uint32_t hide_in_few(const mask_disc *disc, const vf *height, uint32_t vectors, vn *open, bool *left) {
    vn all = vn_zero(), hidden[4 * VECTOR_CHORDS / VF_LANES];
#pragma GCC unroll 32
    for (uint32_t n = 0; n < vectors; n++) {
        const vn within = mask_within(disc, height[n], vf_set1(0));
        hidden[n] = open[n] & within;
        open[n] = open[n] & ~within;
        all = all | open[n];
    }
    *left = !vn_none(all);
    return vn_count_bits(hidden, vectors);
}

static inline mask_disc disc_of(const fibrad_masks *m, const fibrad_discs *disc, uint32_t k) {
    const float middle = m->x_zero + m->x_scale * disc->fu[k];
    return (mask_disc){vf_set1(middle), vf_set1(m->x_scale), vf_set1(disc->fv[k]), vf_set1(disc->square[k])};
}

/* One word a chord. The words stay in registers where these suffice. */
FIBRAD_INLINE uint32_t hide_words(fibrad_masks *m, const fibrad_discs *disc, uint32_t from, float depth,
                                  uint32_t vectors) {
    vn open[4 * VECTOR_CHORDS / VF_LANES];
    vf height[4 * VECTOR_CHORDS / VF_LANES];
    bool left = true;
#pragma GCC unroll 32
    for (uint32_t n = 0; n < vectors; n++)
        open[n] = vn_load(m->word + n * VF_LANES), height[n] = heights(m, n * VF_LANES);
    uint32_t d = from, hidden = 0;
    for (; d < disc->count && left; d++) {
        const uint32_t k = disc->order[d];
        if (!(disc->fdepth[k] <= depth)) break;
        const mask_disc one = disc_of(m, disc, k);
        hidden += disc->hidden_points[k] = hide_in_few(&one, height, vectors, open, &left);
    }
#pragma GCC unroll 32
    for (uint32_t n = 0; n < vectors; n++) vn_store(m->word + n * VF_LANES, open[n]);
    m->open -= hidden;
    return d;
}

/* The chords or words [low, high) that an interval touches, as numbers from 0 to `end`. */
static inline void touched(float from, float to, float end, uint32_t *low, uint32_t *high) {
    from = from > 0 ? from < end ? from : end : 0, to = to > -1 ? to < end ? to + 1 : end : 0;
    *low = (uint32_t)from, *high = (uint32_t)to;
}

/* Several words a chord, or many chords: only what the disc touches is looked at. */
static uint32_t hide_in_many(fibrad_masks *m, const fibrad_discs *disc, uint32_t k) {
    const mask_disc one = disc_of(m, disc, k);
    const float r = (float)fibrad_sqrt(disc->square[k]), across = m->x_scale * r + 1;
    const float middle = m->x_zero + m->x_scale * disc->fu[k], per = 0.5f * (float)m->chords;
    const float row = (disc->fv[k] - m->y_first) * per, rows = per * r + 1;
    uint32_t low, high, first, last, hidden = 0;
    touched(row - rows, row + rows, (float)m->chords, &low, &high);
    touched((middle - across) / 32, (middle + across) / 32, (float)m->words, &first, &last);
    low = low / VECTOR_CHORDS * VECTOR_CHORDS;
    for (uint32_t word = first; word < last; word++) {
        const vf shift = vf_set1(32 * (float)word);
        for (uint32_t block = low; block < high; block += VECTOR_CHORDS) {
            vn hides[VECTOR_CHORDS / VF_LANES] = {vn_zero()};
            for (uint32_t chord = block; chord < block + VECTOR_CHORDS; chord += VF_LANES) {
                uint32_t *at = m->word + word * m->chords + chord;
                const vn within = mask_within(&one, heights(m, chord), shift), open = vn_load(at);
                hides[(chord - block) / VF_LANES] = open & within;
                vn_store(at, open & ~within);
            }
            hidden += vn_count_bits(hides, VECTOR_CHORDS / VF_LANES);
        }
    }
    return hidden;
}

uint32_t LANED(fibrad_masks_discs)(fibrad_masks *m, const fibrad_discs *disc, uint32_t from, float depth) {
    if (VF_LANES > 1 && m->words == 1 && m->chords == 16) return hide_words(m, disc, from, depth, 16 / VF_LANES);
    if (VF_LANES > 1 && m->words == 1 && m->chords == 32) return hide_words(m, disc, from, depth, 32 / VF_LANES);
    if (VF_LANES > 1 && m->words == 1 && m->chords == 64) return hide_words(m, disc, from, depth, 64 / VF_LANES);
    uint32_t d = from;
    for (; d < disc->count && m->open > 0; d++) {
        const uint32_t k = disc->order[d];
        if (!(disc->fdepth[k] <= depth)) break;
        disc->hidden_points[k] = hide_in_many(m, disc, k);
        m->open -= disc->hidden_points[k];
    }
    return d;
}

/* Rounds numbers from 0 to 2^22 to whole numbers. */
static inline vf nearest_whole(vf x) { return x + vf_set1(8388608) - vf_set1(8388608); }

/* The chords and the numbers on them of the points of masks next to (x, y). Near the border these may lie outside the
 * disc. Then (x, y) is moved inwards. Returns whether all lie within. */
static inline bool points_next_to(const fibrad_masks *m, vf *x, vf *y, float *chord, float *number) {
    const vf zero = vf_set1(0), last = vf_set1((float)(m->chords - 1)), end = vf_set1((float)(32 * m->words - 1));
    const vf origin = vf_set1(m->x_zero - 0.5f), scale = vf_set1(m->x_scale), first = vf_set1(m->y_first);
    const vf row = nearest_whole(vf_max(zero, vf_min(last, (*y - first) * vf_set1(0.5f * (float)m->chords))));
    const vf point = nearest_whole(vf_max(zero, vf_min(end, origin + scale * *x)));
    const vf u = (point - origin) / scale, v = first + vf_set1(m->y_step) * row, square = u * u + v * v;
    const vf most = vf_set1(0.999f), inwards = vf_set1(0.95f);
    vf_storeu(chord, row), vf_storeu(number, point);
    *x = vf_select(vf_lt(square, most), *x, *x * inwards), *y = vf_select(vf_lt(square, most), *y, *y * inwards);
    return vf_lt_bits(square, most) == (1u << VF_LANES) - 1;
}

uint32_t LANED(fibrad_masks_at)(const fibrad_masks *m, uint32_t count, const float *x, const float *y, uint64_t *bits) {
    uint32_t open = 0;
    for (uint32_t word = 0; word < count / 64; word++) bits[word] = 0;
    for (uint32_t p = 0; p < count; p += VF_LANES) {
        float chord[VF_LANES], number[VF_LANES];
        vf at_x = vf_load(x + p), at_y = vf_load(y + p);
        while (!points_next_to(m, &at_x, &at_y, chord, number)) continue;
        for (uint32_t lane = 0; lane < VF_LANES; lane++) {
            const uint32_t at = (uint32_t)(int32_t)number[lane], word = at / 32 * m->chords;
            const uint64_t bit = m->word[word + (uint32_t)(int32_t)chord[lane]] >> at % 32 & 1;
            bits[p / 64] |= bit << (p + lane) % 64;
            open += (uint32_t)bit;
        }
    }
    return open;
}
