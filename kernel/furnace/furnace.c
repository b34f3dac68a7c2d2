/* furnace.c - a box and its state: layout, symmetries, plain values. SPDX-License-Identifier: MIT */
#include "furnace/furnace.h"

#include "base/arena.h"

static bool furnace_in_range(double x, double low, double high) { return x >= low && x <= high; }

/* Whether the numbers lie within ranges in which products of a few of them are finite and extinction in a cell is
 * above rounding errors. */
static bool furnace_config_valid(const fibrad_furnace_config *c) {
    if (c == NULL || !furnace_in_range(c->source, -1e30, 1e30)) return false;
    uint64_t cells = 1;
    for (int a = 0; a < 3; a++) {
        if (!furnace_in_range(c->size[a], 1e-9, 1e9) || c->cells[a] == 0) return false;
        if (c->cells[a] > FIBRAD_FURNACE_CELLS_MAX / cells) return false;
        cells *= c->cells[a];
        double step = c->size[a] / c->cells[a];
        if (!furnace_in_range(c->absorption * step, 1e-9, 1e9) || !furnace_in_range(c->scattering * step, 0, 1e9))
            return false;
    }
    double widest = 0;
    for (uint32_t w = 0; w < 6; w++) {
        if (!furnace_in_range(c->wall_temperature[w], 1e-3, 1e9) || !furnace_in_range(c->wall_emissivity[w], 0, 1))
            return false;
        widest = fibrad_max(widest, c->wall_emissivity[w]);
    }
    return widest > 0;
}

/* The layout of fibrad_furnace_size and _init. */
static fibrad_furnace *furnace_lay_out(fibrad_arena *arena, const fibrad_furnace_config *c) {
    fibrad_furnace *furnace = fibrad_arena_take(arena, 1, sizeof *furnace);
    fibrad_furnace count = {0}, *f = furnace != NULL ? furnace : &count;
    f->config = *c;
    f->cells = (size_t)c->cells[0] * c->cells[1] * c->cells[2];
    f->sources = f->cells;
    size_t stride = 1;
    for (int a = 0; a < 3; a++) {
        f->step[a] = c->size[a] / c->cells[a];
        f->cell_stride[a] = stride;
        stride *= c->cells[a];
        f->patches[a] = f->cells / c->cells[a];
        f->faces[a] = f->cells + f->patches[a];
        size_t face_stride = 1;
        for (int b = 0; b < 3; b++) {
            f->face_stride[a][b] = face_stride;
            face_stride *= c->cells[b] + (a == b ? 1u : 0u);
        }
        for (int side = 0; side < 2; side++) {
            f->wall_source[2 * a + side] = f->sources;
            f->sources += f->patches[a];
            f->at.wall[2 * a + side] = fibrad_arena_take(arena, f->patches[a], sizeof(double));
            fibrad_arena_doubles(arena, f->faces[a],
                                 (double **const[]){&f->at.flux[a][side], &f->at.theta[a][side], NULL});
            fibrad_arena_doubles(
                arena, f->cells,
                (double **const[]){&f->at.transverse[a][side], &f->gain[a][side], &f->feed[a][side], NULL});
        }
    }
    f->at.power = f->wall_power;
    fibrad_arena_doubles(
        arena, f->cells,
        (double **const[]){&f->at.e, &f->at.divergence, &f->response, &f->at.six_flux, &f->traced, NULL});
    f->power = fibrad_arena_take(arena, f->sources, sizeof(double));
    f->first = fibrad_arena_take(arena, f->sources + 1, sizeof(uint64_t));
    return furnace;
}

size_t fibrad_furnace_size(const fibrad_furnace_config *config) {
    if (!furnace_config_valid(config)) return 0;
    fibrad_arena arena = {0};
    furnace_lay_out(&arena, config);
    return fibrad_arena_total(&arena);
}

/* The E above and below which the walls emit least: their median, weighted by emissivity and area. */
static double furnace_median_wall(const fibrad_furnace *f) {
    double best = 0, least = DBL_MAX;
    for (int m = 0; m < 6; m++) {
        double sum = 0;
        for (uint32_t w = 0; w < 6; w++) {
            double area = fibrad_face_area(f, fibrad_face_axis(w)) * (double)f->patches[fibrad_face_axis(w)];
            sum += f->config.wall_emissivity[w] * area * fibrad_abs(f->wall_e[w] - f->wall_e[m]);
        }
        if (sum < least) {
            least = sum;
            best = f->wall_e[m];
        }
    }
    return best;
}

static bool furnace_walls_alike(const fibrad_furnace_config *c, int v, int w) {
    return c->wall_temperature[v] == c->wall_temperature[w] && c->wall_emissivity[v] == c->wall_emissivity[w];
}

/* Finds those of the 48 mappings of axes onto axes that change neither the box nor its cells nor its walls. */
static void furnace_find_symmetries(fibrad_furnace *f) {
    const fibrad_furnace_config *c = &f->config;
    f->symmetries = 0;
    for (unsigned code = 0; code < 6 * 8; code++) {
        unsigned order = code / 8, head = order / 2, second = (head + 1 + order % 2) % 3;
        fibrad_symmetry s = {.axis = {(uint8_t)head, (uint8_t)second, (uint8_t)(3 - head - second)},
                             .flip = {code & 1, code >> 1 & 1, code >> 2 & 1}};
        bool same = true;
        for (int a = 0; a < 3; a++) {
            int b = s.axis[a];
            same = same && c->size[a] == c->size[b] && c->cells[a] == c->cells[b];
            for (int side = 0; side < 2; side++)
                same = same && furnace_walls_alike(c, 2 * a + side, 2 * b + (side ^ s.flip[a]));
        }
        if (same) f->symmetry[f->symmetries++] = s;
    }
}

static void furnace_fill(double *array, size_t n, double value) {
    for (size_t k = 0; k < n; k++) array[k] = value;
}

int fibrad_furnace_init(fibrad_furnace **furnace, void *memory, size_t size, const fibrad_furnace_config *config) {
    if (furnace == NULL) return FIBRAD_E_ARGUMENT;
    fibrad_arena arena = {0};
    size_t needed = fibrad_furnace_size(config);
    int status = fibrad_arena_open(&arena, memory, size, needed);
    if (status != FIBRAD_OK) return status;
    fibrad_zero(memory, needed);
    fibrad_furnace *f = furnace_lay_out(&arena, config);
    for (uint32_t w = 0; w < 6; w++) {
        double t2 = config->wall_temperature[w] * config->wall_temperature[w];
        f->wall_e[w] = FIBRAD_STEFAN_BOLTZMANN * t2 * t2;
    }
    f->reference = furnace_median_wall(f);
    furnace_find_symmetries(f);
    furnace_fill(f->at.e, f->cells, f->reference);
    furnace_fill(f->traced, f->cells, f->reference);
    for (int a = 0; a < 3; a++)
        for (int g = 0; g < 2; g++) furnace_fill(f->at.flux[a][g], f->faces[a], f->reference);
    fibrad_furnace_balance(f);
    *furnace = f;
    return fibrad_furnace_theta(f, 2.0 / 3);
}

void fibrad_furnace_fields(fibrad_furnace *furnace, fibrad_furnace_arrays *arrays) {
    if (furnace != NULL && arrays != NULL) *arrays = furnace->at;
}

double fibrad_furnace_temperature(double e) {
    return e > 0 ? fibrad_sqrt(fibrad_sqrt(e / FIBRAD_STEFAN_BOLTZMANN)) : 0;
}

int fibrad_furnace_theta(fibrad_furnace *furnace, double theta) {
    if (furnace == NULL || !(theta > 0) || theta > 1) return FIBRAD_E_ARGUMENT;
    for (int a = 0; a < 3; a++) {
        for (int g = 0; g < 2; g++) {
            furnace_fill(furnace->at.theta[a][g], furnace->faces[a], theta);
            furnace_fill(furnace->at.transverse[a][g], furnace->cells, 0);
        }
    }
    return FIBRAD_OK;
}
