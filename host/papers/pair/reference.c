/* reference.c - view factors of blocked scenes by adaptive quadrature, slow and accurate.
 * SPDX-License-Identifier: MIT */
#include "papers/pair/reference.h"

#include <stdlib.h>
#include <string.h>

#include "simple/nearest.h"
#include "text/read_number.h"

/* ---- visible areas in one direction ---------------------------------------------------------------------------- */

/* A shadow disc. Lengths are in radii of sphere i. Disc 0 is the window: centre 0, radius 1. */
struct disc {
    double u, v, r, depth;
    uint32_t sphere;
};

/* The upper (half = 1) or lower (half = -1) half of the circle of a disc, and its y on a line x = constant. */
struct arc {
    uint32_t disc;
    double half;
    double y;
};

/* A part of a line x = constant through the window, between two arcs. */
struct stretch {
    struct arc low, high;
};

/* Discs of a window, and memory for their visible areas. */
struct slicer {
    struct disc *disc;
    uint32_t discs;
    double *area;                             /* [discs] visible areas; area[0]: the open region */
    double *event;                            /* values of x where arcs may change */
    struct stretch *open, *left, *open_block; /* open stretches, those left behind a disc, memory of both */
};

static double square(double x) { return x * x; }

static double ordinate(const struct disc *disc, double x) {
    return sqrt(fmax((disc->r - (x - disc->u)) * (disc->r + (x - disc->u)), 0));
}

/* Area asin q - q sqrt(1 - q^2) between an arc of the unit circle and its chord 2 q. */
static double cap(double q) {
    if (q > 0.03) return asin(fmin(q, 1)) - q * sqrt(fmax(1 - q * q, 0));
    double power = 2 * q * q * q, sum = 0;
    for (int k = 0; sum + power / (2 * k + 3) != sum; k++) {
        sum += power / (2 * k + 3);
        power *= q * q * (2 * k + 1) / (2 * k + 2);
    }
    return sum;
}

/* Integral of the ordinate of an arc from x1 to x2: the trapezium below its chord, and the cap. */
static double below(const struct slicer *s, const struct arc *arc, double x1, double x2) {
    const struct disc *disc = &s->disc[arc->disc];
    const double y1 = ordinate(disc, x1), y2 = ordinate(disc, x2), chord = sqrt(square(x2 - x1) + square(y2 - y1)) / 2;
    return (x2 - x1) * (disc->v + arc->half * (y1 + y2) / 2) + arc->half * square(disc->r) * cap(chord / disc->r);
}

/* Whether the arcs may change at a point. They cannot change if the point lies outside the window, or well inside a
 * disc before `last` other than `own`. */
static bool matters(const struct slicer *s, double x, double y, uint32_t own, uint32_t last) {
    const double room = 1e-9;
    if (x * x + y * y > 1 + room) return false;
    for (uint32_t k = 1; k < last; k++) {
        const struct disc *disc = &s->disc[k];
        if (k != own && square(x - disc->u) + square(y - disc->v) < square(disc->r) * (1 - room)) return false;
    }
    return true;
}

static uint32_t find_events(struct slicer *s) {
    uint32_t n = 0;
    s->event[n++] = -1;
    s->event[n++] = 0;
    s->event[n++] = 1;
    for (uint32_t b = 1; b < s->discs; b++) {
        const struct disc *B = &s->disc[b];
        s->event[n++] = B->u; /* so no arc is longer than a quarter of its circle, and cap() is well-conditioned */
        if (matters(s, B->u - B->r, B->v, b, b)) s->event[n++] = B->u - B->r;
        if (matters(s, B->u + B->r, B->v, b, b)) s->event[n++] = B->u + B->r;
        for (uint32_t a = 0; a < b; a++) {
            const struct disc *A = &s->disc[a];
            const double du = B->u - A->u, dv = B->v - A->v, d2 = du * du + dv * dv;
            const double outer = square(A->r + B->r), within = square(A->r - B->r);
            if (d2 > 0 && fmin(fabs(d2 - outer), fabs(d2 - within)) < 1e-9 * outer) { /* tangent within rounding */
                const double side = fabs(d2 - outer) < fabs(d2 - within) || A->r > B->r ? 1 : -1;
                s->event[n++] = A->u + side * A->r * du / sqrt(d2);
            }
            if (d2 >= outer || d2 <= within) continue;
            const double along = (d2 + (A->r - B->r) * (A->r + B->r)) / (2 * d2);
            const double across = sqrt(fmax(square(A->r) / d2 - along * along, 0));
            for (int side = -1; side <= 1; side += 2) {
                const double x = A->u + along * du - side * across * dv, y = A->v + along * dv + side * across * du;
                if (matters(s, x, y, a, b)) s->event[n++] = x;
            }
        }
    }
    qsort(s->event, n, sizeof *s->event, number_order);
    return n;
}

/* Covers open stretches of the line at x by disc b, and adds to its area from x1 to x2. Returns the number of stretches
 * that are still open. */
static uint32_t take_stretch(struct slicer *s, uint32_t open, uint32_t b, double x, double x1, double x2) {
    const struct disc *disc = &s->disc[b];
    if (fabs(x - disc->u) >= disc->r) return open;
    const double half = ordinate(disc, x);
    const struct arc bottom = {b, -1, disc->v - half}, top = {b, 1, disc->v + half};
    uint32_t left = 0;
    for (uint32_t k = 0; k < open; k++) {
        const struct stretch now = s->open[k];
        const struct stretch seen = {bottom.y > now.low.y ? bottom : now.low, top.y < now.high.y ? top : now.high};
        if (seen.low.y >= seen.high.y) {
            s->left[left++] = now;
            continue;
        }
        s->area[b] += below(s, &seen.high, x1, x2) - below(s, &seen.low, x1, x2);
        if (now.low.y < seen.low.y) s->left[left++] = (struct stretch){now.low, bottom};
        if (seen.high.y < now.high.y) s->left[left++] = (struct stretch){top, now.high};
    }
    struct stretch *swap = s->open;
    s->open = s->left;
    s->left = swap;
    return left;
}

/* Finds the visible areas of discs [1, discs), nearest first, in disc 0. Events are crossings of two circles and
 * extreme points of one circle. Between two neighbouring events the same arcs bound the same stretches of every line x
 * = constant. The middle line tells which arcs, and the areas are elementary. Events that coincide make slabs without
 * width, which add nothing. */
static void visible_areas(struct slicer *s) {
    memset(s->area, 0, s->discs * sizeof *s->area);
    const uint32_t events = find_events(s);
    for (uint32_t k = 1; k < events; k++) {
        const double x1 = s->event[k - 1], x2 = s->event[k], x = x1 + (x2 - x1) / 2;
        if (x1 < -1 || x2 > 1 || x <= x1 || x >= x2) continue;
        const double half = ordinate(&s->disc[0], x);
        s->open[0] = (struct stretch){{0, -1, -half}, {0, 1, half}};
        uint32_t open = 1;
        for (uint32_t b = 1; b < s->discs && open; b++) open = take_stretch(s, open, b, x, x1, x2);
        for (uint32_t m = 0; m < open; m++)
            s->area[0] += below(s, &s->open[m].high, x1, x2) - below(s, &s->open[m].low, x1, x2);
    }
}

/* ---- cubature over directions ---------------------------------------------------------------------------------- */

enum { GAUSS = 3, DEPTH = 26 };
static const double gauss_node[GAUSS] = {-0.77459666924148338, 0, 0.77459666924148338};
static const double gauss_weight[GAUSS] = {5 / 18., 8 / 18., 5 / 18.};

/* Another sphere seen from sphere i. Lengths are in radii of sphere i. */
struct target {
    double c[3], r, distance;
    double cone; /* half angle of the cone of directions in which its disc meets the window */
};

/* A chart of the directions: a face of the cube [-1, 1]^3 seen from its centre, or polar coordinates (theta, phi) about
 * `axis`. In polar coordinates theta goes smoothly from theta[0] to theta[1] while x goes from 0 to 1. */
struct chart {
    bool polar;
    double axis[3], side[3], up[3];
    double theta[2];
};

/* A rectangle of a chart. */
struct cell {
    const struct chart *chart;
    double x, y, dx, dy; /* centre and half widths */
};

struct integral {
    struct target *target;
    uint32_t n, goal; /* goal: the wanted target; n: all targets and, as entry n, the open region */
    uint32_t entries;
    struct slicer slicer;
    double threshold, *sum, *error; /* [entries] sums over accepted cells */
    double *value;                  /* [DEPTH][4][entries] */
    uint32_t *near;                 /* [DEPTH][n] */
    uint64_t evaluations, max_evaluations;
};

/* Two unit vectors across the unit vector w. */
static void across(const double w[3], double side[3], double up[3]) {
    int k = fabs(w[0]) < fabs(w[1]) ? 0 : 1;
    if (fabs(w[2]) < fabs(w[k])) k = 2;
    double axis[3] = {0};
    axis[k] = 1;
    cross(w, axis, side);
    const double length = sqrt(inner(side, side));
    for (k = 0; k < 3; k++) side[k] /= length;
    cross(w, side, up);
}

/* The direction at (x, y) of a chart. Returns the solid angle per dx dy. The integrand behaves like a square root at
 * the ends of theta; x^2 (3 - 2 x) removes that. */
static double direction(const struct chart *chart, double x, double y, double w[3]) {
    double a, b, c, density;
    if (chart->polar) {
        const double span = chart->theta[1] - chart->theta[0], theta = chart->theta[0] + span * x * x * (3 - 2 * x);
        a = cos(theta);
        b = sin(theta) * cos(y);
        c = sin(theta) * sin(y);
        density = sin(theta) * span * 6 * x * (1 - x);
    } else {
        a = 1 / sqrt(1 + x * x + y * y);
        b = a * x;
        c = a * y;
        density = a * a * a;
    }
    for (int k = 0; k < 3; k++) w[k] = a * chart->axis[k] + b * chart->side[k] + c * chart->up[k];
    return density;
}

/* A bound of the angle between the direction of a cell's centre and any other direction of the cell [rad]. */
static double cell_radius(const struct cell *cell) {
    if (!cell->chart->polar) return hypot(cell->dx, cell->dy);
    const double *theta = cell->chart->theta, span = theta[1] - theta[0];
    const double widest = fmin(theta[0] + span * (cell->x + cell->dx), M_PI / 2);
    return 1.5 * span * cell->dx + fmin(sin(widest) * cell->dy, widest);
}

static int by_depth(const void *a, const void *b) {
    const struct disc *x = a, *y = b;
    if (x->depth != y->depth) return x->depth < y->depth ? -1 : 1;
    return (x->sphere > y->sphere) - (x->sphere < y->sphere);
}

/* Puts the discs of the spheres near[count] in the window along w into the slicer, nearest first. Leaves out discs that
 * lie wholly behind a nearer one. Returns the number of discs. */
static uint32_t collect_discs(struct integral *in, const double w[3], const uint32_t *near, uint32_t count) {
    struct disc *disc = in->slicer.disc;
    double side[3], up[3];
    across(w, side, up);
    uint32_t met = 1, kept = 1;
    const double last = in->goal < in->n ? inner(w, in->target[in->goal].c) : INFINITY;
    for (uint32_t k = 0; k < count; k++) {
        const struct target *target = &in->target[near[k]];
        const double depth = inner(w, target->c), u = inner(side, target->c), v = inner(up, target->c);
        if (depth <= 0 || depth > last || u * u + v * v >= square(1 + target->r)) continue;
        disc[met++] = (struct disc){u, v, target->r, depth, near[k]};
    }
    qsort(disc + 1, met - 1, sizeof *disc, by_depth);
    disc[0] = (struct disc){.r = 1, .sphere = in->n};
    for (uint32_t k = 1; k < met; k++) {
        bool hidden = false;
        for (uint32_t m = 1; m < kept && !hidden; m++)
            hidden = disc[m].r >= disc[k].r &&
                     square(disc[m].u - disc[k].u) + square(disc[m].v - disc[k].v) <= square(disc[m].r - disc[k].r);
        if (!hidden) disc[kept++] = disc[k];
    }
    return kept;
}

/* Adds weight times the visible areas along w to value[]. The first few discs cover most windows, so few are tried
 * first. */
static void add_direction(struct integral *in, const double w[3], double weight, const uint32_t *near, uint32_t count,
                          double *value) {
    struct slicer *s = &in->slicer;
    const uint32_t discs = collect_discs(in, w, near, count);
    s->discs = 8;
    do {
        s->discs = 2 * s->discs < discs ? 2 * s->discs : discs;
        visible_areas(s);
    } while (s->discs < discs && s->area[0] > 1e-14);
    in->evaluations++;
    for (uint32_t k = 0; k < s->discs; k++) {
        const uint32_t sphere = s->disc[k].sphere;
        if (in->goal == in->n)
            value[sphere] += weight * s->area[k];
        else if (sphere == in->goal)
            value[0] += weight * s->area[k];
    }
}

/* Lists the spheres of near[count] whose discs may meet the window for a direction of a cell. *coarse: the cell is too
 * wide for the rule to see all discs in it. Returns their number. */
static uint32_t cull(const struct integral *in, const struct cell *cell, const uint32_t *near, uint32_t count,
                     uint32_t *out, bool *coarse) {
    double w[3], smallest = M_PI;
    direction(cell->chart, cell->x, cell->y, w);
    const double radius = cell_radius(cell);
    uint32_t n = 0;
    for (uint32_t k = 0; k < count; k++) {
        const struct target *target = &in->target[near[k]];
        double chord2 = 0;
        for (int m = 0; m < 3; m++) chord2 += square(w[m] - target->c[m] / target->distance);
        if (2 * asin(fmin(sqrt(chord2) / 2, 1)) > radius + target->cone + 1e-12) continue;
        out[n++] = near[k];
        if (target->cone < smallest) smallest = target->cone;
    }
    *coarse = radius > smallest / 2;
    return n;
}

/* Applies the rule to a cell. Values are view factors: the mean over all directions of visible area over pi, the area
 * of the window. */
static void evaluate(struct integral *in, const struct cell *cell, const uint32_t *near, uint32_t count,
                     double *value) {
    memset(value, 0, in->entries * sizeof *value);
    for (int a = 0; a < GAUSS; a++)
        for (int b = 0; b < GAUSS; b++) {
            double w[3];
            const double density =
                direction(cell->chart, cell->x + cell->dx * gauss_node[a], cell->y + cell->dy * gauss_node[b], w);
            const double solid_angle = 4 * cell->dx * cell->dy * gauss_weight[a] * gauss_weight[b] * density;
            add_direction(in, w, solid_angle / (4 * M_PI * M_PI), near, count, value);
        }
}

/* Adds a cell to the sum. `whole` is the value of the cell by one application of the rule. The cell is divided into
 * quarters until whole and quarters agree. Their difference counts as error. The difference is mostly the error of the
 * whole. Agreement may be an accident. So if the parent cell was far off (inherited), this cell is divided once more.
 */
static void refine_cell(struct integral *in, const struct cell *cell, const double *whole, const uint32_t *near,
                        uint32_t count, int depth, double inherited) {
    if (in->evaluations > in->max_evaluations) return;
    double *part = in->value + (size_t)depth * 4 * in->entries;
    uint32_t *own = in->near + (size_t)depth * in->n;
    bool coarse;
    const uint32_t held = cull(in, cell, near, count, own, &coarse);
    struct cell quarter[4];
    for (int k = 0; k < 4; k++) {
        const double dx = cell->dx / 2, dy = cell->dy / 2;
        quarter[k] = (struct cell){cell->chart, cell->x + (k & 1 ? dx : -dx), cell->y + (k & 2 ? dy : -dy), dx, dy};
        evaluate(in, &quarter[k], own, held, part + (size_t)k * in->entries);
    }
    double largest = 0;
    for (uint32_t j = 0; j < in->entries; j++) {
        const double sum = part[j] + part[in->entries + j] + part[2 * in->entries + j] + part[3 * in->entries + j];
        largest = fmax(largest, fabs(sum - whole[j]));
    }
    if ((coarse || largest > in->threshold || inherited > 20 * in->threshold) && depth + 1 < DEPTH) {
        for (int k = 0; k < 4; k++)
            refine_cell(in, &quarter[k], part + (size_t)k * in->entries, own, held, depth + 1, largest);
        return;
    }
    for (uint32_t j = 0; j < in->entries; j++) {
        const double sum = part[j] + part[in->entries + j] + part[2 * in->entries + j] + part[3 * in->entries + j];
        in->sum[j] += sum;
        in->error[j] += fabs(sum - whole[j]);
    }
}

/* Integrates over all charts with one threshold. Returns the largest error. */
static double sweep_charts(struct integral *in, const struct cell *cell, uint32_t cells, uint32_t self) {
    memset(in->sum, 0, in->entries * sizeof *in->sum);
    memset(in->error, 0, in->entries * sizeof *in->error);
    uint32_t *all = in->near, count = 0;
    for (uint32_t k = 0; k < in->n; k++)
        if (k != self) all[count++] = k;
    for (uint32_t k = 0; k < cells; k++) {
        evaluate(in, &cell[k], all, count, in->value);
        refine_cell(in, &cell[k], in->value, all, count, 1, 0);
    }
    double largest = 0;
    for (uint32_t j = 0; j < in->entries; j++) largest = fmax(largest, in->error[j]);
    return largest;
}

/* Integrates with falling thresholds until the estimated error meets the tolerance. The first, coarse pass is always
 * finished. The differences of refine_cell are errors of the coarser values. Where the integrand has a bend, the error
 * per cell is of order h^3.5, and the quarters err five times less; elsewhere they err still less. But cells that miss
 * a narrow gap between discs count too little. So half of the differences is the estimate. */
static int integrate(struct integral *in, const struct cell *cell, uint32_t cells, uint32_t self,
                     const struct reference_rule *rule, double tolerance, double *result,
                     struct reference_report *report) {
    in->threshold = 1e-2 * sqrt(tolerance);
    in->max_evaluations = UINT64_MAX;
    for (;;) {
        const double estimate = sweep_charts(in, cell, cells, self) / 2;
        report->evaluations = in->evaluations;
        if (in->evaluations > in->max_evaluations) return REFERENCE_UNCONVERGED;
        memcpy(result, in->sum, in->entries * sizeof *result);
        report->error = estimate;
        if (estimate <= tolerance) return REFERENCE_OK;
        in->max_evaluations = rule->max_evaluations;
        in->threshold *= fmax(0.7 * pow(tolerance / estimate, 1.4), 1e-3);
    }
}

/* ---- rows and pairs -------------------------------------------------------------------------------------------- */

static void slicer_free(struct slicer *s) {
    free(s->disc);
    free(s->area);
    free(s->event);
    free(s->open_block);
}

/* Allocates room for n discs, the window included. */
static bool slicer_make(struct slicer *s, size_t n) {
    s->disc = malloc(n * sizeof *s->disc);
    s->area = malloc(n * sizeof *s->area);
    s->event = malloc((3 * n * (n + 1) / 2 + 3 * n + 3) * sizeof *s->event);
    s->open_block = malloc(2 * n * sizeof *s->open);
    s->open = s->open_block;
    s->left = s->open_block ? s->open_block + n : NULL;
    return s->disc && s->area && s->event && s->open_block;
}

int reference_window(uint32_t n, const double *u, const double *v, const double *r, double *area, double *rest) {
    struct slicer s;
    const bool room = slicer_make(&s, (size_t)n + 1);
    if (room) {
        s.discs = n + 1;
        s.disc[0] = (struct disc){.r = 1};
        for (uint32_t k = 0; k < n; k++) s.disc[k + 1] = (struct disc){.u = u[k], .v = v[k], .r = r[k]};
        visible_areas(&s);
        memcpy(area, s.area + 1, n * sizeof *area);
        *rest = s.area[0];
    }
    slicer_free(&s);
    return room ? REFERENCE_OK : REFERENCE_MEMORY;
}

static void integral_release(struct integral *in) {
    free(in->target);
    slicer_free(&in->slicer);
    free(in->sum);
    free(in->error);
    free(in->value);
    free(in->near);
}

/* Prepares an integral. Sphere i is at the origin with radius 1. goal: as in struct integral. */
static int integral_prepare(struct integral *in, const fibrad_spheres *spheres, uint32_t i, uint32_t goal) {
    const size_t n = spheres->n;
    *in = (struct integral){.n = spheres->n, .goal = goal, .entries = goal < spheres->n ? 1 : spheres->n + 1};
    in->target = calloc(n, sizeof *in->target);
    const bool room = slicer_make(&in->slicer, n);
    in->sum = malloc(in->entries * sizeof *in->sum);
    in->error = malloc(in->entries * sizeof *in->error);
    in->value = malloc((size_t)DEPTH * 4 * in->entries * sizeof *in->value);
    in->near = malloc(DEPTH * n * sizeof *in->near);
    if (!(room && in->target && in->sum && in->error && in->value && in->near)) return REFERENCE_MEMORY;
    for (uint32_t k = 0; k < spheres->n; k++) {
        const double unit = spheres->r[i];
        struct target *target = &in->target[k];
        target->c[0] = (spheres->x[k] - spheres->x[i]) / unit;
        target->c[1] = (spheres->y[k] - spheres->y[i]) / unit;
        target->c[2] = (spheres->z[k] - spheres->z[i]) / unit;
        target->r = spheres->r[k] / unit;
        target->distance = sqrt(inner(target->c, target->c));
        target->cone = asin(fmin((1 + target->r) / target->distance, 1));
        if (k != i && !(target->distance > 0)) return REFERENCE_ARGUMENT;
    }
    return REFERENCE_OK;
}

int reference_row(const fibrad_spheres *spheres, uint32_t i, const struct reference_rule *rule, double *f,
                  double *escaped, struct reference_report *report) {
    if (i >= spheres->n) return REFERENCE_ARGUMENT;
    struct chart chart[6];
    struct cell cell[6];
    for (int k = 0; k < 6; k++) {
        chart[k] = (struct chart){.polar = false};
        chart[k].axis[k / 2] = k % 2 ? -1 : 1;
        across(chart[k].axis, chart[k].side, chart[k].up);
        cell[k] = (struct cell){&chart[k], 0, 0, 1, 1};
    }
    struct integral in;
    double *row = malloc(((size_t)spheres->n + 1) * sizeof *row);
    int status = integral_prepare(&in, spheres, i, spheres->n);
    if (!row) status = REFERENCE_MEMORY;
    if (!status) {
        status = integrate(&in, cell, 6, i, rule, rule->tolerance, row, report);
        memcpy(f, row, spheres->n * sizeof *f);
        *escaped = row[spheres->n];
    }
    integral_release(&in);
    free(row);
    return status;
}

int reference_pair(const fibrad_spheres *spheres, uint32_t i, uint32_t j, const struct reference_rule *rule, double *f,
                   struct reference_report *report) {
    if (i >= spheres->n || j >= spheres->n || i == j) return REFERENCE_ARGUMENT;
    struct integral in;
    int status = integral_prepare(&in, spheres, i, j);
    const struct target *target = status ? NULL : &in.target[j];
    double unobstructed = 0;
    if (target && fibrad_pair_exact(1, target->r, target->distance - 1 - target->r, &unobstructed))
        status = REFERENCE_ARGUMENT;
    if (!status) {
        /* Below theta[1] one disc lies inside the other. Beyond theta[2] they are apart. */
        const double theta[3] = {0, asin(fmin(fabs(1 - target->r) / target->distance, 1)), target->cone};
        struct chart chart[2];
        struct cell cell[8];
        for (int k = 0; k < 2; k++) {
            chart[k] = (struct chart){.polar = true, .theta = {theta[k], theta[k + 1]}};
            for (int m = 0; m < 3; m++) chart[k].axis[m] = target->c[m] / target->distance;
            across(chart[k].axis, chart[k].side, chart[k].up);
            for (int m = 0; m < 4; m++)
                cell[4 * k + m] = (struct cell){&chart[k], 0.5, (m + 0.5) * M_PI / 2, 0.5, M_PI / 4};
        }
        status = integrate(&in, cell, 8, i, rule, rule->tolerance * unobstructed, f, report);
        report->error /= unobstructed;
    }
    integral_release(&in);
    return status;
}
