/* reproduce_pairs.c - figures 3, 4, 7, 8 and 9 of the surface paper: pairs, without and with a third sphere.
 * SPDX-License-Identifier: MIT */
#include <math.h>

#include "cli/message.h"
#include "papers/pair/reference.h"
#include "papers/reproduce/reproduce.h"

static const double radii[] = {.1, .3, .7, 1};
static const double gaps[] = {0, .01, .02, .05, .1, .5, 1, 2, 4, 6, 8};
enum { RADII = sizeof radii / sizeof *radii, GAPS = sizeof gaps / sizeof *gaps };

/* The factor from a unit sphere by the surface method. obstacle: x, y, z, r; or NULL. All arguments here are valid, so
 * no status is checked. */
static double surface_factor(double r2, double gap, const double *obstacle, uint32_t nodes, uint32_t flags) {
    static double scratch[FIBRAD_SURFACE_SCRATCH(1)];
    const fibrad_surface_rule rule = {.nodes = nodes, .flags = flags};
    fibrad_spheres one = {.n = 0};
    if (obstacle)
        one = (fibrad_spheres){.x = obstacle, .y = obstacle + 1, .z = obstacle + 2, .r = obstacle + 3, .n = 1};
    double f12 = NAN;
    fibrad_surface_pair(1, r2, gap, &one, &rule, scratch, &f12, NULL);
    return f12;
}

static double exact_factor(double r2, double gap) {
    double f12 = NAN;
    fibrad_pair_exact(1, r2, gap, &f12);
    return f12;
}

int reproduce_fig3(struct reproduce *reproduce) {
    static const uint32_t nodes[] = {13, 21, 34, 55, 89, 144, 233, 377, 610};
    static const struct {
        uint32_t nodes;
        double error[RADII]; /* % */
    } check[] = {{34, {-21.78, -16.18, -15.97, -10.05}}, {55, {-2.17, -1.50, -4.62, -4.76}},
                 {89, {12.96, .47, -4.79, -5.40}},       {144, {13.45, -2.82, -3.59, -3.94}},
                 {233, {6.50, -2.21, -1.69, -1.66}},     {610, {-.27, -.05, -.15, -.13}}};
    fputs("p1,nodes,gap,F,exact,error_percent\n", reproduce->data);
    for (int p = 0; p < RADII; ++p)
        for (size_t k = 0; k < sizeof nodes / sizeof *nodes; ++k) {
            double worst = 0;
            for (int g = 0; g < GAPS; ++g) {
                const double f = surface_factor(radii[p], gaps[g], NULL, nodes[k], FIBRAD_SURFACE_NO_CORRECTION);
                const double truth = exact_factor(radii[p], gaps[g]), error = 100 * (f / truth - 1);
                fprintf(reproduce->data, "%g,%u,%g,%.17g,%.17g,%.4f\n", radii[p], nodes[k], gaps[g], f, truth, error);
                if (fabs(error) > fabs(worst)) worst = error;
            }
            double theirs = NAN;
            for (size_t c = 0; c < sizeof check / sizeof *check; ++c)
                if (check[c].nodes == nodes[k]) theirs = check[c].error[p];
            reproduce_compare(reproduce, SOURCE_CHECK, "%", theirs, worst, "largest error, p1 = %g, N_F = %u", radii[p],
                              nodes[k]);
            if (nodes[k] == 55)
                reproduce_compare(reproduce, SOURCE_PAPER, "%", 5, fabs(worst),
                                  "largest |error|, p1 = %g, N_F = 55: at most", radii[p]);
        }
    return STATUS_OK;
}

int reproduce_fig4(struct reproduce *reproduce) {
    /* the pebble-bed paper: factors of equal spheres by rays and by numerical integration */
    static const struct {
        double gap, rays, numerical;
    } pebbles[] = {{0, 7.573e-2, 7.558e-2},
                   {1, 2.964e-2, 2.959e-2},
                   {2, 1.605e-2, 1.615e-2},
                   {3, 1.017e-2, 1.021e-2},
                   {4, .698e-2, .704e-2}};
    reproduce_compare(reproduce, SOURCE_PAPER, "", .5 - 4 / (3 * M_PI), exact_factor(1, 0),
                      "exact, in contact: 1/2 - 4/(3 pi)");
    for (size_t k = 0; k < sizeof pebbles / sizeof *pebbles; ++k) {
        const double gap = pebbles[k].gap;
        reproduce_compare(reproduce, SOURCE_PAPER, "", pebbles[k].numerical,
                          surface_factor(1, gap, NULL, 55, FIBRAD_SURFACE_NO_CORRECTION),
                          "surface, 55 nodes, not corrected, H = %g: numerical", gap + 2);
        reproduce_compare(reproduce, SOURCE_PAPER, "", pebbles[k].rays, exact_factor(1, gap), "exact, H = %g: rays",
                          gap + 2);
    }
    fputs("gap,surface,corrected,exact,point_source,far_field\n", reproduce->data);
    for (int k = 0; k <= 60; ++k) {
        const double gap = 8 * pow(k / 60.0, 2), sine = 1 / (2 + gap);
        fprintf(reproduce->data, "%.6g,%.6g,%.6g,%.6g,%.6g,%.6g\n", gap,
                surface_factor(1, gap, NULL, 55, FIBRAD_SURFACE_NO_CORRECTION), surface_factor(1, gap, NULL, 55, 0),
                exact_factor(1, gap), .5 * (1 - sqrt(1 - sine * sine)), .25 * sine * sine);
    }
    return STATUS_OK;
}

/* The factor with an obstacle by adaptive quadrature, with an error of about 1e-7. */
static int reference_factor(double r2, double gap, const double obstacle[4], double *f12) {
    const double x[3] = {0, 0, obstacle[0]}, y[3] = {0, 0, obstacle[1]}, z[3] = {0, 1 + r2 + gap, obstacle[2]};
    const double r[3] = {1, r2, obstacle[3]};
    const fibrad_spheres spheres = {.x = x, .y = y, .z = z, .r = r, .n = 3};
    const struct reference_rule rule = {.tolerance = 1e-7, .max_evaluations = 3000000};
    struct reference_report report;
    const int status = reference_pair(&spheres, 0, 1, &rule, f12, &report);
    if (status == REFERENCE_MEMORY) return message_memory();
    return status ? message(STATUS_INPUT, "the reference of a blocked pair did not converge") : STATUS_OK;
}

enum { AZIMUTHS = 24 };

/* Relative errors over azimuths of the obstacle [%]. */
struct spread {
    double at_zero, low, high;
};

static void widen(struct spread *spread, int azimuth, double error) {
    if (azimuth == 0) *spread = (struct spread){error, error, error};
    spread->low = fmin(spread->low, error);
    spread->high = fmax(spread->high, error);
}

static double larger(double a, double b) { return fabs(b) > fabs(a) ? b : a; }

/* Largest errors over all gaps [%]. */
struct worst {
    double raw, corrected;             /* 55 nodes against 987 nodes, azimuth 0 */
    double raw_truth, corrected_truth; /* 55 nodes against the reference, all azimuths */
    double raw_987, corrected_987;     /* 987 nodes against the reference */
};

static int third_sphere(struct reproduce *reproduce, double r, double gap, double to_axis, double z,
                        struct worst *worst) {
    const uint32_t plain = FIBRAD_SURFACE_NO_CORRECTION;
    struct spread raw = {0}, corrected = {0};
    const double obstacle[4] = {to_axis, 0, z, r};
    double truth;
    const int status = reference_factor(r, gap, obstacle, &truth);
    if (status) return status;
    for (int a = 0; a < AZIMUTHS; ++a) {
        const double turned[4] = {to_axis * cos(2 * M_PI * a / AZIMUTHS), to_axis * sin(2 * M_PI * a / AZIMUTHS), z, r};
        widen(&raw, a, 100 * (surface_factor(r, gap, turned, 55, plain) / truth - 1));
        widen(&corrected, a, 100 * (surface_factor(r, gap, turned, 55, 0) / truth - 1));
    }
    const double f55 = surface_factor(r, gap, obstacle, 55, plain),
                 f55_corrected = surface_factor(r, gap, obstacle, 55, 0);
    const double f987 = surface_factor(r, gap, obstacle, 987, plain),
                 f987_corrected = surface_factor(r, gap, obstacle, 987, 0);
    fprintf(reproduce->data, "%g,%g,%.10g,%.10g,%.10g,%.10g,%.10g,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f\n", r, gap,
            f55, f55_corrected, f987, f987_corrected, truth, raw.at_zero, raw.low, raw.high, corrected.at_zero,
            corrected.low, corrected.high, 100 * (f987 / truth - 1), 100 * (f987_corrected / truth - 1));
    worst->raw = larger(worst->raw, 100 * (f55 / f987 - 1));
    worst->corrected = larger(worst->corrected, 100 * (f55_corrected / f987 - 1));
    worst->raw_truth = larger(worst->raw_truth, larger(raw.low, raw.high));
    worst->corrected_truth = larger(worst->corrected_truth, larger(corrected.low, corrected.high));
    worst->raw_987 = larger(worst->raw_987, 100 * (f987 / truth - 1));
    worst->corrected_987 = larger(worst->corrected_987, 100 * (f987_corrected / truth - 1));
    return STATUS_OK;
}

static void compare_third(struct reproduce *reproduce, double r, const struct worst *worst, double raw,
                          double corrected) {
    reproduce_compare(reproduce, SOURCE_PAPER, "%", 6, fabs(worst->raw), "p1 = %g: |error| against 987 nodes: under",
                      r);
    reproduce_compare(reproduce, SOURCE_CHECK, "%", raw, fabs(worst->raw), "p1 = %g: |error| against 987 nodes", r);
    reproduce_compare(reproduce, SOURCE_CHECK, "%", corrected, fabs(worst->corrected), "p1 = %g: the same, corrected",
                      r);
    reproduce_compare(reproduce, "", "%", NAN, worst->raw_truth, "p1 = %g: error, truth, any azimuth", r);
    reproduce_compare(reproduce, "", "%", NAN, worst->corrected_truth, "p1 = %g: the same, corrected", r);
    reproduce_compare(reproduce, "", "%", NAN, worst->raw_987, "p1 = %g: error of 987 nodes, truth", r);
    reproduce_compare(reproduce, "", "%", NAN, worst->corrected_987, "p1 = %g: the same, corrected", r);
}

int reproduce_third_sphere(struct reproduce *reproduce) {
    static const double raw[RADII] = {1.8, 1.6, 4.83, 5.14}, corrected[RADII] = {1.8, .7, 1.3, 1.5};
    fputs("p1,gap,raw_55,corrected_55,raw_987,corrected_987,truth,raw_error,raw_low,raw_high,corrected_error,"
          "corrected_low,corrected_high,raw_987_error,corrected_987_error\n",
          reproduce->data);
    for (int p = 0; p < RADII; ++p) {
        struct worst worst = {0};
        const double r = radii[p];
        for (int g = 0; g < GAPS; ++g) {
            /* the third sphere touches both: its centre is 1 + r from the first and 2 r from the second centre */
            const double d = 1 + r + gaps[g], z = ((1 + r) * (1 + r) - 4 * r * r + d * d) / (2 * d);
            if (z >= 1 + r) continue;
            const int status = third_sphere(reproduce, r, gaps[g], sqrt((1 + r) * (1 + r) - z * z), z, &worst);
            if (status) return status;
        }
        compare_third(reproduce, r, &worst, raw[p], corrected[p]);
    }
    return STATUS_OK;
}
