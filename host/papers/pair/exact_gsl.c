/* exact_gsl.c - the unobstructed view factor by GSL's adaptive quadrature, in two ways. SPDX-License-Identifier: MIT */
#include "papers/pair/exact_gsl.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_math.h>
#include <math.h>

enum { INTERVALS = 500 };

typedef struct pair_geometry {
    double r1, r2, gap, d;
    double from, width; /* range of the cosine in the lens integral */
} pair_geometry;

/* Integrates f over [from, to] and adds the result to *sum and its error to *abserr. f may have integrable
 * singularities at the ends. Tolerance: 1e-14 of the larger of *sum and the integral. */
static int add_integral(double (*f)(double, void *), pair_geometry *pair, double from, double to, double *sum,
                        double *abserr) {
    gsl_integration_cquad_workspace *work = gsl_integration_cquad_workspace_alloc(INTERVALS);
    if (!work) return GSL_ENOMEM;
    gsl_function function = {.function = f, .params = pair};
    double value, error;
    int status = gsl_integration_cquad(&function, from, to, 1e-14 * *sum, 1e-14, work, &value, &error, NULL);
    gsl_integration_cquad_workspace_free(work);
    if (status) return status;
    *sum += value;
    *abserr += error;
    return 0;
}

/* The element of sphere 1 at polar angle t lies s = d - d cos t below the pole that faces sphere 2. H is the distance
 * of the element from the centre of sphere 2 over r2. `cosine` is the cosine of the angle between the normal and the
 * direction of that centre; H cosine = 1 + (gap - s)/r2. All terms are formed from gap and s, so that nothing cancels
 * near contact or far away. */
static double square_less_one(const pair_geometry *pair, double s) {
    return (pair->gap * (pair->gap + 2 * pair->r2) + 2 * pair->r1 * s) / gsl_pow_2(pair->r2); /* H^2 - 1 */
}

/* Integrand for elements that see all of sphere 2: s = v gap. */
static double whole_integrand(double v, void *params) {
    const pair_geometry *pair = params;
    double s = v * pair->gap, H2 = 1 + square_less_one(pair, s);
    return pair->gap * (1 + (pair->gap - s) / pair->r2) / (H2 * sqrt(H2));
}

/* Integrand for elements whose horizon cuts sphere 2: s = gap + v r2, v from 0 to 2. */
static double cut_integrand(double v, void *params) {
    const pair_geometry *pair = params;
    double x2 = square_less_one(pair, pair->gap + v * pair->r2), H2 = 1 + x2;
    double cosine = (1 - v) / sqrt(H2), x = sqrt(x2), y = sqrt(v * (2 - v));
    return pair->r2 * ((cosine * atan2(y, -x * cosine) - x * y) / H2 + atan2(y, x)) / M_PI;
}

int exact_gsl_polar(double r1, double r2, double gap, double *f12, double *abserr) {
    if (!(r1 > 0 && r2 > 0 && gap >= 0)) return GSL_EDOM;
    pair_geometry pair = {.r1 = r1, .r2 = r2, .gap = gap, .d = r1 + r2 + gap};
    double sum = 0, error = 0;
    gsl_error_handler_t *handler = gsl_set_error_handler_off();
    int status = gap > 0 ? add_integral(whole_integrand, &pair, 0, 1, &sum, &error) : 0;
    if (!status) status = add_integral(cut_integrand, &pair, 0, 2, &sum, &error);
    gsl_set_error_handler(handler);
    if (status) return status;
    *f12 = sum / (2 * pair.d);
    *abserr = error / (2 * pair.d);
    return 0;
}

/* Area a - sin a cos a of the segment with half angle a in the unit circle. For small a by its series. */
static double segment_area(double a) {
    if (a > 0.5) return a - sin(2 * a) / 2;
    double term = 4 * a * a * a / 6, sum = 0;
    for (int n = 4; sum + term != sum; n += 2) {
        sum += term;
        term *= -4 * a * a / (n * (n + 1));
    }
    return sum;
}

/* Area common to both shadow discs over the squared smaller radius, for directions at the cosine mu = from + width v to
 * the line of centres. outer = (r1 + r2)^2 - s^2 and inner = s^2 - (r1 - r2)^2, where s is the distance of the centres
 * of the discs. */
static double lens_integrand(double v, void *params) {
    const pair_geometry *pair = params;
    double R = GSL_MAX(pair->r1, pair->r2), r = GSL_MIN(pair->r1, pair->r2), d = pair->d;
    double contact = pair->gap * (2 * (R + r) + pair->gap), mu = pair->from + pair->width * v;
    double outer = pair->gap < 0 ? d * d * mu * mu - contact : d * d * pair->width * v * (mu + pair->from);
    double inner = 4 * R * r - outer;
    if (outer <= 0) return 0;
    if (inner <= 0) return M_PI;
    double chord = sqrt(outer * inner), s2 = inner + gsl_pow_2(R - r);
    return gsl_pow_2(R / r) * segment_area(atan2(chord, s2 + (R - r) * (R + r))) +
           segment_area(atan2(chord, s2 - (R - r) * (R + r)));
}

int exact_gsl_lens(double r1, double r2, double gap, double *f12, double *abserr) {
    double R = GSL_MAX(r1, r2), r = GSL_MIN(r1, r2);
    if (!(r > 0 && gap > -2 * r)) return GSL_EDOM;
    pair_geometry pair = {.r1 = r1, .r2 = r2, .gap = gap, .d = R - r + (2 * r + gap)};
    /* The discs touch at the cosine `from`. Beyond from + width the smaller disc lies within the larger one. */
    double inside = sqrt((2 * R + gap) * (2 * r + gap)) / pair.d;
    pair.from = gap < 0 ? 0 : sqrt(gap * (2 * (R + r) + gap)) / pair.d;
    pair.width = gap < 0 ? inside : 4 * R * r / gsl_pow_2(pair.d) / (inside + pair.from);
    double sum = 0, error = 0;
    gsl_error_handler_t *handler = gsl_set_error_handler_off();
    int status = add_integral(lens_integrand, &pair, 0, 1, &sum, &error);
    gsl_set_error_handler(handler);
    if (status) return status;
    double whole = M_PI * gsl_pow_2((R - r) / pair.d) / (1 + inside);
    double scale = gsl_pow_2(r / r1) / (2 * M_PI);
    *f12 = scale * (whole + pair.width * sum);
    *abserr = scale * pair.width * error;
    return 0;
}
