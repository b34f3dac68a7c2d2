/* harmonics.c - spherical harmonics on the patches of a sphere. SPDX-License-Identifier: MIT */
#include "patches/harmonics.h"
#include "patches/sphere_patch.h"

#define OCTANTS FIBRAD_HARMONICS_KINDS
#define MOST    FIBRAD_HARMONICS_OF_KIND
#define FOUR    4u
#define PATCHES FIBRAD_HEAT_PATCHES_MAX

static uint32_t bits_of(uint32_t k) { return (k & 1) + (k >> 1 & 1) + (k >> 2 & 1); }

/* The patch, or four, of an octant: bit k of the octant is set where coordinate k of the cube is below 0. */
static uint32_t patch_in_octant(const fibrad_harmonics *h, uint32_t octant, uint32_t orbit) {
    const uint32_t half = h->side / 2, axis = orbit / (half * half), across = orbit / half % half, along = orbit % half;
    const uint32_t face = 2 * axis + (octant >> axis & 1);
    const uint32_t x = octant >> (axis == 0 ? 1 : 0) & 1 ? half - 1 - across : half + across,
                   y = octant >> (axis == 2 ? 1 : 2) & 1 ? half - 1 - along : half + along;
    if (h->each == 1) return fibrad_patch_number(face, x, y, h->side);
    return fibrad_patch_number(face, 2 * x, 2 * y, 2 * h->side) / h->each;
}

/* A place on a patch of the first octant: u, v in [0, 1] of it. Returns its solid angle if all of it were as here. */
static double place_in_octant(uint32_t side, uint32_t orbit, double u, double v, double n[3]) {
    const uint32_t half = side / 2, axis = orbit / (half * half), on_face = orbit % (half * half);
    const double s = fibrad_patch_unmapped((on_face / half + u) / half),
                 t = fibrad_patch_unmapped((on_face % half + v) / half), inverse = 1 / fibrad_sqrt(1 + s * s + t * t);
    n[axis] = inverse, n[axis == 0 ? 1 : 0] = s * inverse, n[axis == 2 ? 1 : 2] = t * inverse;
    return 16 / ((5 - 3 * s * s) * (5 - 3 * t * t)) * (inverse * inverse * inverse) / (half * half);
}

/* The harmonics of a kind at a place, before they are made orthogonal: degree by degree. */
static void monomials(const double n[3], uint32_t kind, uint32_t each, double value[MOST]) {
    const double factor = (kind & 1 ? n[0] : 1) * (kind & 2 ? n[1] : 1) * (kind & 4 ? n[2] : 1);
    uint32_t count = 0;
    for (uint32_t shell = 0; count < each; shell++)
        for (uint32_t j = 0; j <= shell; j++) {
            double product = factor;
            for (uint32_t k = 0; k < shell; k++) product *= k < j ? n[1] * n[1] : n[0] * n[0];
            value[count++] = product;
        }
}

/* Means of the monomials over a patch of the first octant, and its share of the sphere. Gauss's rule of three points.
 */
static double patch_means(uint32_t side, uint32_t orbit, uint32_t kind, uint32_t each, double mean[MOST]) {
    static const double place[3] = {.11270166537925831, .5, .88729833462074169},
                        weight[3] = {5. / 18, 8. / 18, 5. / 18};
    double angle = 0;
    for (uint32_t q = 0; q < each; q++) mean[q] = 0;
    for (int k = 0; k < 9; k++) {
        double n[3], value[MOST];
        const double w = weight[k / 3] * weight[k % 3] * place_in_octant(side, orbit, place[k / 3], place[k % 3], n);
        monomials(n, kind, each, value);
        angle += w;
        for (uint32_t q = 0; q < each; q++) mean[q] += w * value[q];
    }
    for (uint32_t q = 0; q < each; q++) mean[q] /= angle;
    return angle / (4 * FIBRAD_PI);
}

/* Makes each column of a kind orthonormal to the columns before it. This is done twice, since the first time leaves
 * rounding errors. */
static void orthonormalise(double *value, uint32_t orbits, uint32_t each) {
    for (uint32_t q = 0; q < each; q++)
        for (int time = 0; time < 2; time++) {
            double square = 0;
            for (uint32_t p = 0; p < q; p++) {
                double along = 0;
                for (uint32_t o = 0; o < orbits; o++) along += value[o * each + p] * value[o * each + q];
                for (uint32_t o = 0; o < orbits; o++) value[o * each + q] -= along * value[o * each + p];
            }
            for (uint32_t o = 0; o < orbits; o++) square += value[o * each + q] * value[o * each + q];
            for (uint32_t o = 0; o < orbits; o++) value[o * each + q] /= fibrad_sqrt(square);
        }
}

/* Shares of the patches of an octant, scaled so that those of the sphere add up to 1. */
static void find_roots(fibrad_harmonics *h) {
    double sum = 0, none[MOST];
    for (uint32_t o = 0; o < h->orbits; o++) sum += h->root[o] = patch_means(h->side, o, 0, 0, none);
    for (uint32_t o = 0; o < h->orbits; o++) h->root[o] = fibrad_sqrt(h->root[o] / (OCTANTS * sum));
}

void fibrad_harmonics_size(fibrad_harmonics *h, uint32_t side, bool fours) {
    h->each = fours && side > 2 ? FOUR : 1;
    h->side = h->each > 1 ? side / 2 : side;
    h->orbits = 6 * h->side * h->side / OCTANTS;
    h->shells = 0, h->many = 0;
    while (h->many + h->shells + 1 <= (h->orbits < MOST ? h->orbits : MOST)) h->many += ++h->shells;
}

void fibrad_harmonics_make(fibrad_harmonics *h) {
    find_roots(h);
    for (uint32_t k = 0; k < OCTANTS * h->orbits; k++)
        h->patch[k] = (uint16_t)patch_in_octant(h, k / h->orbits, k % h->orbits);
    for (uint32_t kind = 0; kind < OCTANTS; kind++) {
        double *value = h->value + (size_t)kind * h->orbits * h->many;
        for (uint32_t o = 0; o < h->orbits; o++) {
            patch_means(h->side, o, kind, h->many, value + o * h->many);
            for (uint32_t q = 0; q < h->many; q++) value[o * h->many + q] *= h->root[o];
        }
        orthonormalise(value, h->orbits, h->many);
    }
}

/* The shortest wave on patches goes from one patch to the next and back. Waves within a patch are half as long or
 * shorter. */
double fibrad_harmonics_within(const fibrad_harmonics *h) { return 4 * h->side; }

/* The own patches of a sphere are those that the harmonics have. Their areas, with all further patches that lie on
 * them, and their sums of area times pattern. */
typedef struct own_patches {
    double area[PATCHES], sum[PATCHES];
} own_patches;

/* The own patch on which a patch of a sphere lies. */
static uint32_t own_patch_of(const fibrad_harmonics *h, const fibrad_harmonics_patches *on, uint32_t k) {
    return (k < on->cube ? k : on->own[(k - on->cube) / FOUR]) / h->each;
}

static void gather_own(const fibrad_harmonics *h, const fibrad_harmonics_patches *on, const double *pattern,
                       own_patches *own) {
    fibrad_zero(own->area, OCTANTS * h->orbits * sizeof(double));
    fibrad_zero(own->sum, OCTANTS * h->orbits * sizeof(double));
    for (uint32_t a = 0; a < on->count; a++) {
        const uint32_t k = own_patch_of(h, on, a);
        own->area[k] += on->area[a];
        own->sum[k] += on->area[a] * pattern[a];
    }
}

/* Patterns times roots of areas, by octant. Also the roots of the true shares of the sphere, and of the shares that
 * beams measured. The rotation that takes the measured roots to the true ones takes a pattern with one value everywhere
 * to the harmonic of degree 0. The harmonics stay orthogonal, whatever was measured. */
typedef struct octants {
    double value[PATCHES], area[PATCHES], share[PATCHES], measured[PATCHES];
    uint32_t patches;
    double cosine; /* between the roots of shares */
} octants;

static void to_octants(const fibrad_harmonics *h, const own_patches *own, octants *in) {
    double all = 0;
    in->patches = OCTANTS * h->orbits, in->cosine = 0;
    for (uint32_t k = 0; k < in->patches; k++) all += own->area[k];
    for (uint32_t k = 0; k < in->patches; k++) {
        const uint32_t patch = h->patch[k];
        const double root = fibrad_sqrt(own->area[patch]);
        in->area[k] = own->area[patch];
        in->value[k] = root > 0 ? own->sum[patch] / root : 0;
        in->share[k] = h->root[k % h->orbits], in->measured[k] = root / fibrad_sqrt(all);
        in->cosine += in->share[k] * in->measured[k];
    }
}

/* Turns values in the plane of two unit vectors so that one becomes the other. */
static void rotate(octants *in, const double *from, const double *to) {
    double before = 0, after = 0;
    for (uint32_t k = 0; k < in->patches; k++) before += from[k] * in->value[k], after += to[k] * in->value[k];
    const double both = (before + after) / (1 + in->cosine);
    for (uint32_t k = 0; k < in->patches; k++) in->value[k] += 2 * before * to[k] - both * (from[k] + to[k]);
}

/* From octants to kinds, and back from them: sums and differences across the three planes. */
static void transform(double *value, uint32_t orbits) {
    for (uint32_t step = 1; step < OCTANTS; step *= 2)
        for (uint32_t octant = 0; octant < OCTANTS; octant++) {
            if (octant & step) continue;
            double *a = value + octant * orbits, *b = value + (octant | step) * orbits;
            for (uint32_t o = 0; o < orbits; o++) {
                const double sum = a[o] + b[o];
                b[o] = a[o] - b[o], a[o] = sum;
            }
        }
}

/* Filters one kind. Returns the product of what was and what is. */
static double filter_kind(const fibrad_harmonics *h, uint32_t kind, const double *by, double *value) {
    const double *harmonic = h->value + (size_t)kind * h->orbits * h->many, rest = by[bits_of(kind) + 2 * h->shells];
    double part[MOST] = {0}, product = 0;
    for (uint32_t o = 0; o < h->orbits; o++)
        for (uint32_t q = 0; q < h->many; q++) part[q] += harmonic[o * h->many + q] * value[o];
    for (uint32_t q = 0, shell = 0, left = 1; q < h->many; q++) {
        part[q] *= by[bits_of(kind) + 2 * shell] - rest;
        if (--left == 0) left = ++shell + 1;
    }
    for (uint32_t o = 0; o < h->orbits; o++) {
        double sum = rest * value[o];
        for (uint32_t q = 0; q < h->many; q++) sum += part[q] * harmonic[o * h->many + q];
        product += value[o] * sum;
        value[o] = sum;
    }
    return product;
}

/* Adds to `to` what varies within own patches that are divided, times `by`. Returns the sum of A times pattern times
 * what was added. */
static double filter_within(const fibrad_harmonics *h, const fibrad_harmonics_patches *on, double by,
                            const own_patches *own, const double *pattern, double *to) {
    double product = 0;
    for (uint32_t a = 0; a < on->count && on->count > on->cube; a++) {
        const uint32_t k = own_patch_of(h, on, a);
        if (!(on->area[a] > 0)) continue;
        const double within = pattern[a] - own->sum[k] / own->area[k];
        product += by * on->area[a] * within * within;
        if (to != NULL) to[a] += by * within;
    }
    return product;
}

/* Gives each patch what its own patch has. */
static void spread_octants(const fibrad_harmonics *h, const fibrad_harmonics_patches *on, octants *in, double *to) {
    double own[PATCHES] = {0};
    transform(in->value, h->orbits);
    rotate(in, in->share, in->measured);
    for (uint32_t k = 0; k < in->patches; k++)
        own[h->patch[k]] = in->area[k] > 0 ? in->value[k] / (OCTANTS * fibrad_sqrt(in->area[k])) : 0;
    for (uint32_t a = 0; a < on->count; a++) to[a] = own[own_patch_of(h, on, a)];
}

double fibrad_harmonics_filter(const fibrad_harmonics *h, const fibrad_harmonics_patches *on,
                               const double by[FIBRAD_HARMONICS_WITHIN + 1], const double *pattern, double *to) {
    own_patches own;
    octants in;
    double product = 0;
    gather_own(h, on, pattern, &own);
    to_octants(h, &own, &in);
    rotate(&in, in.measured, in.share);
    transform(in.value, h->orbits);
    for (uint32_t kind = 0; kind < OCTANTS; kind++) product += filter_kind(h, kind, by, in.value + kind * h->orbits);
    if (to != NULL) spread_octants(h, on, &in, to);
    return product / OCTANTS + filter_within(h, on, by[FIBRAD_HARMONICS_WITHIN], &own, pattern, to);
}
