/* tally.c - sums over bundles, and the fields that follow from them. SPDX-License-Identifier: MIT */
#include "furnace/furnace.h"

#include "base/arena.h"

/* The layout of fibrad_furnace_tally_size and _init. */
static fibrad_furnace_tally *tally_lay_out(fibrad_arena *arena, const fibrad_furnace *f) {
    fibrad_furnace_tally *tally = fibrad_arena_take(arena, 1, sizeof *tally);
    fibrad_furnace_tally count = {0}, *t = tally != NULL ? tally : &count;
    fibrad_copy(t->cells, f->config.cells, sizeof t->cells);
    size_t head = arena->used;
    for (uint32_t a = 0; a < 3; a++)
        for (int g = 0; g < 2; g++) t->moment[a][g] = fibrad_arena_take(arena, f->faces[a], sizeof *t->moment[a][g]);
    t->path = fibrad_arena_take(arena, f->cells, sizeof *t->path);
    t->absorbed = fibrad_arena_take(arena, f->sources - f->cells, sizeof *t->absorbed);
    t->counts = (int64_t *)(void *)t->moment[0][0];
    t->length = (arena->used - head) / sizeof *t->counts;
    return tally;
}

size_t fibrad_furnace_tally_size(const fibrad_furnace *furnace) {
    if (furnace == NULL) return 0;
    fibrad_arena arena = {0};
    tally_lay_out(&arena, furnace);
    return fibrad_arena_total(&arena);
}

int fibrad_furnace_tally_init(fibrad_furnace_tally **tally, void *memory, size_t size, const fibrad_furnace *furnace) {
    if (tally == NULL) return FIBRAD_E_ARGUMENT;
    fibrad_arena arena = {0};
    int status = fibrad_arena_open(&arena, memory, size, fibrad_furnace_tally_size(furnace));
    if (status != FIBRAD_OK) return status;
    fibrad_furnace_tally *t = tally_lay_out(&arena, furnace);
    t->series = t->mark = 0;
    fibrad_zero(t->counts, t->length * sizeof *t->counts);
    *tally = t;
    return FIBRAD_OK;
}

int fibrad_furnace_tally_add(fibrad_furnace_tally *to, const fibrad_furnace_tally *from) {
    if (to == NULL || from == NULL || to == from) return FIBRAD_E_ARGUMENT;
    for (uint32_t a = 0; a < 3; a++)
        if (to->cells[a] != from->cells[a]) return FIBRAD_E_STATE;
    if (from->series == 0) return FIBRAD_OK;
    if (to->series != 0 && to->series != from->series) return FIBRAD_E_STATE;
    to->series = from->series;
    to->mark += from->mark;
    for (size_t k = 0; k < to->length;
         k++) /* unsigned, so that an overflow is defined; sums of too many tallies are refused later */
        to->counts[k] = (int64_t)((uint64_t)to->counts[k] + (uint64_t)from->counts[k]);
    return FIBRAD_OK;
}

/* Whether the tally contains each bundle of all plans since the restart once, and the bundles have this physics. */
static bool tally_is_complete(const fibrad_furnace *f, const fibrad_furnace_tally *t, fibrad_furnace_physics physics) {
    return f->bundle_power != 0 && f->physics == physics && fibrad_tally_fits(f, t) && t->mark == f->mark;
}

/* The image of index i of n along axis a under a symmetry, for cells or faces. */
static size_t tally_image(const fibrad_symmetry *s, uint32_t a, size_t i, size_t n) {
    return s->flip[a] ? n - 1 - i : i;
}

/* The mean of moment m over the images of face i[] of axis a, hemisphere g, as power per area [W/m2]. */
static double tally_mean_moment(const fibrad_furnace *f, const fibrad_furnace_tally *t, uint32_t a, int g, int m,
                                const size_t i[3]) {
    int64_t sum = 0;
    for (uint32_t k = 0; k < f->symmetries; k++) {
        const fibrad_symmetry *s = &f->symmetry[k];
        const size_t *stride = f->face_stride[s->axis[a]];
        size_t face = 0;
        for (uint32_t b = 0; b < 3; b++)
            face += tally_image(s, b, i[b], f->config.cells[b] + (a == b ? 1 : 0)) * stride[s->axis[b]];
        sum += t->moment[s->axis[a]][g ^ s->flip[a]][face].f[m];
    }
    return (double)sum / f->symmetries * (f->bundle_power / FIBRAD_TALLY_UNIT) / fibrad_face_area(f, a);
}

/* Theta and flux of all faces of axis a, hemisphere g. The reference E adds the moments of isotropic radiation. */
static void tally_set_theta(fibrad_furnace *f, const fibrad_furnace_tally *t, uint32_t a, int g,
                            fibrad_furnace_estimator estimator) {
    static const double isotropic[3] = {1, 2.0 / 3, 0.5};
    size_t n[3], i[3], face = 0;
    for (uint32_t b = 0; b < 3; b++) n[b] = f->config.cells[b] + (a == b ? 1 : 0);
    for (i[2] = 0; i[2] < n[2]; i[2]++) {
        for (i[1] = 0; i[1] < n[1]; i[1]++) {
            for (i[0] = 0; i[0] < n[0]; i[0]++, face++) {
                double moment[3];
                for (int m = 0; m < 3; m++)
                    moment[m] = tally_mean_moment(f, t, a, g, m, i) + isotropic[m] * f->reference;
                f->at.flux[a][g][face] = moment[0];
                double above = moment[estimator == FIBRAD_THETA_PAPER ? 2 : 1];
                double below = moment[estimator == FIBRAD_THETA_PAPER ? 1 : 0];
                if (above > 0 && below > 0) f->at.theta[a][g][face] = fibrad_min(above / below, 1);
            }
        }
    }
}

/* The transverse term of axis a, hemisphere g. It is the residual of the hemisphere's equation in each cell for the
 * fluxes of the bundles and the E that they carried. With this term the heat-flux equations return these fluxes. */
static void tally_set_transverse(fibrad_furnace *f, uint32_t a, int g, fibrad_furnace_scatter scatter) {
    size_t stride = f->face_stride[a][a], block = stride * f->config.cells[a];
    const double *theta = f->at.theta[a][g], *flux = f->at.flux[a][g];
    double d = f->step[a], thickness = (f->config.absorption + f->config.scattering) * d;
    for (size_t k = 0; k < f->cells; k++) {
        size_t low = k + k / block * stride, in = g ? low + stride : low, out = g ? low : low + stride;
        double entry = fibrad_line_entry(thickness, theta[in]);
        double rest = fibrad_line_source(f, f->traced[k], f->at.six_flux[k], scatter) * d - entry * flux[in] -
                      (thickness - entry) * flux[out] - (theta[out] * flux[out] - theta[in] * flux[in]);
        double sum = flux[in] + flux[out];
        f->at.transverse[a][g][k] = sum > 0 ? 2 * rest / (sum * d) : 0;
    }
}

int fibrad_furnace_estimate(fibrad_furnace *furnace, const fibrad_furnace_tally *tally,
                            fibrad_furnace_estimator estimator, int transverse, fibrad_furnace_scatter scatter) {
    fibrad_furnace *f = furnace;
    if (f == NULL || tally == NULL) return FIBRAD_E_ARGUMENT;
    if (estimator != FIBRAD_THETA_DEFINITION && (estimator != FIBRAD_THETA_PAPER || transverse))
        return FIBRAD_E_ARGUMENT;
    if (scatter != FIBRAD_SCATTER_SIX_FLUX && scatter != FIBRAD_SCATTER_EXACT) return FIBRAD_E_ARGUMENT;
    if (!tally_is_complete(f, tally, FIBRAD_FURNACE_ATTENUATED)) return FIBRAD_E_STATE;
    for (uint32_t a = 0; a < 3; a++)
        for (int g = 0; g < 2; g++) tally_set_theta(f, tally, a, g, estimator);
    fibrad_furnace_balance(f);
    for (uint32_t a = 0; a < 3; a++) {
        for (int g = 0; g < 2; g++)
            if (transverse)
                tally_set_transverse(f, a, g, scatter);
            else
                fibrad_zero(f->at.transverse[a][g], f->cells * sizeof(double));
    }
    return FIBRAD_OK;
}

/* Sets E of all cells from the incident radiation in the tally and the source. */
static void tally_set_e(fibrad_furnace *f, const fibrad_furnace_tally *tally, double unit) {
    const uint32_t *n = f->config.cells;
    double own = f->config.source / (4 * f->config.absorption);
    double per_path = unit * fibrad_cell_diagonal(f) / (4 * fibrad_cell_volume(f)) / f->symmetries;
    size_t cell = 0, i[3];
    for (i[2] = 0; i[2] < n[2]; i[2]++) {
        for (i[1] = 0; i[1] < n[1]; i[1]++) {
            for (i[0] = 0; i[0] < n[0]; i[0]++, cell++) {
                int64_t sum = 0;
                for (uint32_t k = 0; k < f->symmetries; k++) {
                    const fibrad_symmetry *s = &f->symmetry[k];
                    size_t to = 0;
                    for (uint32_t b = 0; b < 3; b++) to += tally_image(s, b, i[b], n[b]) * f->cell_stride[s->axis[b]];
                    sum += tally->path[to];
                }
                f->at.e[cell] = f->reference + own + (double)sum * per_path;
                f->at.divergence[cell] = f->config.source;
            }
        }
    }
}

int fibrad_furnace_equilibrium(fibrad_furnace *furnace, const fibrad_furnace_tally *tally) {
    fibrad_furnace *f = furnace;
    if (f == NULL || tally == NULL) return FIBRAD_E_ARGUMENT;
    if (!tally_is_complete(f, tally, FIBRAD_FURNACE_EQUILIBRIUM)) return FIBRAD_E_STATE;
    double unit = f->bundle_power / FIBRAD_TALLY_UNIT;
    tally_set_e(f, tally, unit);
    for (uint32_t w = 0; w < 6; w++) {
        const int64_t *absorbed = tally->absorbed + (f->wall_source[w] - f->cells);
        double area = fibrad_face_area(f, fibrad_face_axis(w)), emitted = fibrad_patch_power(f, w);
        f->at.power[w] = 0;
        for (size_t p = 0; p < f->patches[fibrad_face_axis(w)]; p++) {
            double net = emitted - (double)absorbed[p] * unit;
            f->at.wall[w][p] = net / area;
            f->at.power[w] += net;
        }
    }
    return FIBRAD_OK;
}
