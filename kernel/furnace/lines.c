/* lines.c - the heat-flux equations, solved along lines of cells. SPDX-License-Identifier: MIT
 *
 * The equation of one hemisphere across a cell of thickness d is d(Theta q)/dx + C = J - beta q with C = chi q. The
 * trapezoidal rule makes q_out an affine function of q_in. So the flux at one end of a line is an affine function of
 * the flux at the other end. With the conditions at the two walls, q leaving = eps E + (1 - eps) q arriving, there
 * are two equations for the two fluxes that start. Then E of all cells is corrected at once: by the excess or
 * deficit of heat of each cell over the derivative of this heat with respect to the cell's own E. The fluxes that
 * enter the cell are held constant for that. */
#include "furnace/furnace.h"

/* The coefficients of a solution. They are the same in all sweeps. */
static void line_set_coefficients(fibrad_furnace *f, fibrad_furnace_scatter scatter) {
    const fibrad_furnace_config *c = &f->config;
    double beta = c->absorption + c->scattering;
    double own = scatter == FIBRAD_SCATTER_EXACT ? beta : c->absorption; /* dJ/dE */
    for (size_t k = 0; k < f->cells; k++) f->response[k] = 0;
    for (int a = 0; a < 3; a++) {
        size_t stride = f->face_stride[a][a], block = stride * c->cells[a];
        double d = f->step[a];
        for (int g = 0; g < 2; g++) {
            const double *theta = f->at.theta[a][g];
            for (size_t k = 0; k < f->cells; k++) {
                size_t low = k + k / block * stride;
                double in = theta[g ? low + stride : low], out = theta[g ? low : low + stride];
                double entry = fibrad_line_entry(beta * d, in), side = f->at.transverse[a][g][k] * d / 2;
                double sum = out + beta * d - entry + side;
                if (sum < 0.01) sum = 0.01; /* smaller values are noise; NaN stays NaN */
                f->gain[a][g][k] = (in - entry - side) / sum;
                f->feed[a][g][k] = d / sum;
                f->response[k] += own / sum;
            }
        }
    }
    for (size_t k = 0; k < f->cells; k++) f->response[k] = 1 / f->response[k];
}

/* The fluxes of the line along axis a that begins at `cell` and `face`. source: J of the cells. */
static void line_solve(fibrad_furnace *f, int a, size_t cell, size_t face, const double *source) {
    size_t n = f->config.cells[a], stride = f->cell_stride[a];
    const double *gain_up = f->gain[a][0] + cell, *feed_up = f->feed[a][0] + cell;
    const double *gain_down = f->gain[a][1] + cell, *feed_down = f->feed[a][1] + cell;
    double *up = f->at.flux[a][0] + face, *down = f->at.flux[a][1] + face;
    source += cell;

    double up_gain = 1, up_rest = 0, down_gain = 1, down_rest = 0;
    for (size_t i = 0, k = 0; i < n; i++, k += stride) {
        up_rest = gain_up[k] * up_rest + feed_up[k] * source[k];
        up_gain *= gain_up[k];
        down_rest +=
            down_gain * feed_down[k] * source[k]; /* from the last cell: sum of the feeds times the gains below */
        down_gain *= gain_down[k];
    }
    double eps0 = f->config.wall_emissivity[2 * a], eps1 = f->config.wall_emissivity[2 * a + 1];
    double own0 = eps0 * f->wall_e[2 * a], own1 = eps1 * f->wall_e[2 * a + 1];
    double start = (own0 + (1 - eps0) * (down_gain * (own1 + (1 - eps1) * up_rest) + down_rest)) /
                   (1 - (1 - eps0) * (1 - eps1) * up_gain * down_gain);

    up[0] = start;
    for (size_t i = 0, k = 0; i < n; i++, k += stride) up[k + stride] = gain_up[k] * up[k] + feed_up[k] * source[k];
    down[n * stride] = own1 + (1 - eps1) * up[n * stride];
    for (size_t i = n, k = n * stride; i > 0; i--, k -= stride)
        down[k - stride] = gain_down[k - stride] * down[k] + feed_down[k - stride] * source[k - stride];
}

static void line_set_sums(fibrad_furnace *f) {
    fibrad_zero(f->at.six_flux, f->cells * sizeof(double));
    fibrad_zero(f->at.divergence, f->cells * sizeof(double));
    for (int a = 0; a < 3; a++) {
        size_t stride = f->face_stride[a][a], block = stride * f->config.cells[a];
        const double *up = f->at.flux[a][0], *down = f->at.flux[a][1];
        double per_length = 1 / f->step[a];
        for (size_t k = 0; k < f->cells; k++) {
            size_t low = k + k / block * stride, high = low + stride;
            f->at.six_flux[k] += (up[low] + up[high] + down[low] + down[high]) / 2;
            f->at.divergence[k] += ((up[high] - down[high]) - (up[low] - down[low])) * per_length;
        }
    }
}

static void line_set_walls(fibrad_furnace *f) {
    for (uint32_t w = 0; w < 6; w++) {
        uint32_t a = fibrad_face_axis(w);
        bool upper = fibrad_face_is_upper(w);
        const double *out = f->at.flux[a][upper], *in = f->at.flux[a][!upper];
        size_t stride = f->face_stride[a][a], last = upper ? stride * f->config.cells[a] : 0;
        double sum = 0;
        for (size_t p = 0; p < f->patches[a]; p++) {
            size_t face = p % stride + p / stride * stride * (f->config.cells[a] + 1) + last;
            f->at.wall[w][p] = out[face] - in[face];
            sum += f->at.wall[w][p];
        }
        f->at.power[w] = sum * fibrad_face_area(f, a);
    }
}

void fibrad_furnace_balance(fibrad_furnace *furnace) {
    line_set_sums(furnace);
    line_set_walls(furnace);
}

/* Solves all lines of all axes for the present E. `divergence` has the source J of the cells before, and the sums
 * after. */
static void line_sweep(fibrad_furnace *f, fibrad_furnace_scatter scatter) {
    double *source = f->at.divergence;
    for (size_t k = 0; k < f->cells; k++) source[k] = fibrad_line_source(f, f->at.e[k], f->at.six_flux[k], scatter);
    for (int a = 0; a < 3; a++) {
        size_t stride = f->cell_stride[a], n = f->config.cells[a];
        for (size_t line = 0; line < f->patches[a]; line++) {
            size_t low = line % stride, high = line / stride;
            line_solve(f, a, low + high * stride * n, low + high * stride * (n + 1), source);
        }
    }
    line_set_sums(f);
}

/* Corrects E of all cells. Returns whether all changes are finite. *largest: out: the largest change [W/m2]. */
static bool line_correct(fibrad_furnace *f, double *largest) {
    bool finite = true;
    *largest = 0;
    for (size_t k = 0; k < f->cells; k++) {
        double change = (f->config.source - f->at.divergence[k]) * f->response[k];
        f->at.e[k] += change;
        finite = finite && fibrad_finite(change); /* the maximum ignores NaN */
        *largest = fibrad_max(*largest, fibrad_abs(change));
    }
    return finite;
}

int fibrad_furnace_solve(fibrad_furnace *furnace, fibrad_furnace_scatter scatter, double tolerance, uint32_t sweeps_max,
                         fibrad_furnace_report *report) {
    fibrad_furnace *f = furnace;
    if (f == NULL || report == NULL || !(tolerance > 0)) return FIBRAD_E_ARGUMENT;
    if (scatter != FIBRAD_SCATTER_SIX_FLUX && scatter != FIBRAD_SCATTER_EXACT) return FIBRAD_E_ARGUMENT;
    line_set_coefficients(f, scatter);
    fibrad_furnace_report result = {0, DBL_MAX};
    while (result.sweeps < sweeps_max && result.change > tolerance) {
        line_sweep(f, scatter);
        if (!line_correct(f, &result.change)) return FIBRAD_E_ARGUMENT;
        result.sweeps++;
    }
    line_set_walls(f);
    *report = result;
    return FIBRAD_OK;
}
