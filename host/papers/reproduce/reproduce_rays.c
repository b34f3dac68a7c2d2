/* reproduce_rays.c - the table of the pebble-bed paper by its own method, which is rays.
 * SPDX-License-Identifier: MIT */
#include <math.h>

#include "cli/message.h"
#include "papers/reproduce/reproduce.h"

enum { ORIENTATIONS = 24, RAYS = 200000 };

/* Results for two unit spheres: means over orientations of the pair, each of which has its own rays. */
struct pair_rays {
    double error; /* root mean square relative error of F */
    double f12, length, angle;
};

static int cast_once(struct rows *rows, const fibrad_cast_rule *rule, double exact, struct pair_rays *means) {
    double length[2] = {0}, angle[2] = {0};
    fibrad_row row = {.col = rows->col, .f = rows->f, .capacity = rows->n};
    const int status = fibrad_cast_row(rows->scene, &rows->work, 0, rule, &row,
                                       &(fibrad_cast_means){.length = length, .angle = angle});
    if (status) return message(STATUS_INPUT, "rays: %s", fibrad_status_text(status));
    const double f12 = row.length ? row.f[0] : 0;
    means->error += pow(f12 / exact - 1, 2) / ORIENTATIONS;
    means->f12 += f12 / ORIENTATIONS;
    means->length += length[0] / ORIENTATIONS;
    means->angle += angle[0] * 180 / M_PI / ORIENTATIONS;
    return STATUS_OK;
}

static int cast_pair(double h, fibrad_cast_rule rule, struct pair_rays *means) {
    double exact = 0, w[3] = {0};
    int status = STATUS_OK;
    *means = (struct pair_rays){0};
    fibrad_pair_exact(1, 1, h - 2, &exact);
    for (uint32_t k = 0; k < ORIENTATIONS && !status; ++k) {
        struct rows rows = ROWS_NONE;
        fibrad_direction(k, ORIENTATIONS, w);
        rule.seed = k;
        status = bed_add(&rows.bed, &(struct bed_sphere){.r = 1});
        if (!status)
            status = bed_add(&rows.bed, &(struct bed_sphere){.x = h * w[0], .y = h * w[1], .z = h * w[2], .r = 1});
        if (!status) status = rows_open(&rows, false);
        if (!status) status = cast_once(&rows, &rule, exact, means);
        rows_close(&rows);
    }
    means->error = sqrt(means->error);
    return status;
}

/* Finds the fewest of 1000, 1414, 2000, ... rays whose error is at most 1 %. */
static int rays_for_one_percent(double h, uint32_t *rays) {
    struct pair_rays means = {.error = INFINITY};
    int status = STATUS_OK;
    for (int k = 0; means.error > .01 && k < 30 && !status; ++k) {
        *rays = (uint32_t)(1000 * pow(2, k / 2.));
        status = cast_pair(h, (fibrad_cast_rule){.rays = *rays}, &means);
    }
    return status;
}

int reproduce_pebble_rays(struct reproduce *reproduce) {
    static const struct {
        double h, f12, length, length_check, angle, angle_check; /* check: by another program, over directions */
    } table[] = {{2, 7.573e-2, .358, .3589, 30.05, 30.85},
                 {3, 2.964e-2, 1.494, 1.4922, 18.25, 18.24},
                 {4, 1.605e-2, 2.620, 2.5403, 13.35, 13.34},
                 {5, 1.017e-2, 3.621, 3.5668, 10.51, 10.56},
                 {6, .698e-2, 4.597, 4.5824, 8.73, 8.75}};
    fputs("H,cast_F,cast_error_percent,cast_length,cast_angle_degrees,mc_error_percent,cast_rays_for_1_percent,"
          "mc_rays_for_1_percent\n",
          reproduce->data);
    for (size_t t = 0; t < sizeof table / sizeof *table; ++t) {
        const double h = table[t].h;
        struct pair_rays quasi, random;
        uint32_t needed = 0;
        int status = cast_pair(h, (fibrad_cast_rule){.rays = RAYS}, &quasi);
        if (!status) status = cast_pair(h, (fibrad_cast_rule){.rays = RAYS, .random = 1}, &random);
        if (!status) status = rays_for_one_percent(h, &needed);
        if (status) return status;
        const double random_needed =
            RAYS * pow(100 * random.error, 2); /* the error of random rays falls as rays^-1/2 */
        reproduce_compare(reproduce, SOURCE_PAPER, "", table[t].f12, quasi.f12,
                          "H = %g: F, 200,000 rays, mean of 24 orientations", h);
        reproduce_compare(reproduce, SOURCE_PAPER, "r", table[t].length, quasi.length, "H = %g: mean ray length", h);
        reproduce_compare(reproduce, SOURCE_CHECK, "r", table[t].length_check, quasi.length, "H = %g: mean ray length",
                          h);
        reproduce_compare(reproduce, SOURCE_PAPER, "deg", table[t].angle, quasi.angle, "H = %g: mean angle", h);
        reproduce_compare(reproduce, SOURCE_CHECK, "deg", table[t].angle_check, quasi.angle, "H = %g: mean angle", h);
        reproduce_compare(reproduce, "", "%", NAN, 100 * quasi.error, "H = %g: error of F, 200,000 rays, RMS", h);
        reproduce_compare(reproduce, "", "%", NAN, 100 * random.error, "H = %g: error of F, 200,000 random rays, RMS",
                          h);
        reproduce_compare(reproduce, "", "", NAN, needed, "H = %g: rays for an error of 1 %%", h);
        reproduce_compare(reproduce, "", "", NAN, random_needed, "H = %g: random rays for an error of 1 %%", h);
        fprintf(reproduce->data, "%g,%.6g,%.4f,%.5f,%.4f,%.4f,%u,%.0f\n", h, quasi.f12, 100 * quasi.error, quasi.length,
                quasi.angle, 100 * random.error, needed, random_needed);
    }
    return STATUS_OK;
}
