/* exact_gsl.c - the unobstructed view factor by GSL's adaptive quadrature. SPDX-License-Identifier: MIT */
#include "papers/pair/exact_gsl.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_math.h>

enum { INTERVALS = 500 };

typedef struct pair_geometry {
    double r1, r2, gap, d;
    double from, width; /* range of the cosine in the lens integral */
} pair_geometry;

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
    double sum, error;
    gsl_function function = {.function = lens_integrand, .params = &pair};
    gsl_error_handler_t *handler = gsl_set_error_handler_off();
    gsl_integration_cquad_workspace *work = gsl_integration_cquad_workspace_alloc(INTERVALS);
    int status = work ? gsl_integration_cquad(&function, 0, 1, 0, 1e-14, work, &sum, &error, NULL) : GSL_ENOMEM;
    if (work) gsl_integration_cquad_workspace_free(work);
    gsl_set_error_handler(handler);
    if (status) return status;
    double whole = M_PI * gsl_pow_2((R - r) / pair.d) / (1 + inside), scale = gsl_pow_2(r / r1) / (2 * M_PI);
    *f12 = scale * (whole + pair.width * sum);
    *abserr = scale * pair.width * error;
    return 0;
}
