/* parts.c - which spheres make up the parts of a sweep. SPDX-License-Identifier: MIT
 *
 * The bed is halved across its longest extent again and again: so few beams go from part to part, and spheres that
 * follow each other are near each other. */
#include "heat/sweep.h"

#define FEW_SPHERES 32u /* that need not be near each other in any sequence */
#define HALVES_MAX  64  /* of ranges that wait */

/* Spheres of the sequence, and the parts they are of. */
struct bed_range {
    uint32_t begin, end, first, last;
};

static bool sphere_before(const double *x, uint32_t a, uint32_t b) { return x[a] != x[b] ? x[a] < x[b] : a < b; }

/* Moves the spheres of smaller x before place `cut` of a range. */
static void split_range(uint32_t *sphere, struct bed_range range, uint32_t cut, const double *x) {
    uint32_t begin = range.begin, end = range.end;
    while (end - begin > 1) {
        const uint32_t middle = sphere[begin + (end - begin) / 2];
        uint32_t low = begin, high = end;
        for (;;) {
            while (sphere_before(x, sphere[low], middle)) low++;
            while (sphere_before(x, middle, sphere[high - 1])) high--;
            if (low + 1 >= high) break;
            const uint32_t other = sphere[low];
            sphere[low++] = sphere[--high], sphere[high] = other;
        }
        /* nothing is between them but the middle one */
        if (cut >= low && cut <= high) return;
        if (cut < low)
            end = low;
        else
            begin = high;
    }
}

/* The coordinates along which a range is longest. */
static const double *longest_extent(const fibrad_heat *heat, struct bed_range range) {
    const double *const of[3] = {heat->scene->x, heat->scene->y, heat->scene->z};
    double longest = -1;
    const double *along = of[0];
    for (int axis = 0; axis < 3; axis++) {
        double low = __builtin_inf(), high = -__builtin_inf();
        for (uint32_t k = range.begin; k < range.end; k++) {
            const double x = of[axis][heat->sequence[k]];
            low = fibrad_min(low, x), high = fibrad_max(high, x);
        }
        if (high - low > longest) longest = high - low, along = of[axis];
    }
    return along;
}

/* Rows of fine fours are of the part of their sphere; those of walls go to all parts in turn. */
static void divide_fine_rows(fibrad_heat *heat) {
    for (uint32_t row = heat->spheres; row < heat->rows; row++) {
        const uint32_t body = fibrad_heat_body_of_row(heat, row);
        heat->part[row] = body < heat->spheres ? heat->part[body] : (uint16_t)(row % heat->config.parts);
    }
}

void fibrad_heat_divide(fibrad_heat *heat) {
    const uint32_t n = heat->spheres;
    struct bed_range wait[HALVES_MAX];
    int waiting = 0;
    for (uint32_t k = 0; k < n; k++) heat->sequence[k] = k;
    wait[waiting++] = (struct bed_range){0, n, 0, heat->config.parts};
    while (waiting > 0) {
        const struct bed_range range = wait[--waiting];
        const bool one = range.last - range.first == 1;
        const uint32_t part = range.first + (range.last - range.first) / 2;
        const uint32_t cut = one ? range.begin + (range.end - range.begin) / 2 : fibrad_heat_part_begin(heat, n, part);
        if (one && range.end - range.begin <= FEW_SPHERES) {
            for (uint32_t k = range.begin; k < range.end; k++) heat->part[heat->sequence[k]] = (uint16_t)range.first;
            continue;
        }
        split_range(heat->sequence, range, cut, longest_extent(heat, range));
        wait[waiting++] = (struct bed_range){range.begin, cut, range.first, one ? range.last : part};
        wait[waiting++] = (struct bed_range){cut, range.end, one ? range.first : part, range.last};
    }
    divide_fine_rows(heat);
}
